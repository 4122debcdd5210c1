//! The answer of a pick as text.

use sixfold_results::numbers::{approximate, duration, figure, grouped, list, rounded_down};
use sixfold_results::{BreakEven, PickReport, Ranked, Standing};

use crate::command::column_table::{Column, column_table};
use crate::command::signs::Signs;
use crate::command::text::{TextOutput, sanitize};
use crate::pick::kinds::different_results;

/// Prints the results of a pick.
pub fn print(report: &PickReport, text: &mut TextOutput) {
    let (answer, reasons) = report.sentences.split_at(report.sentences.len().min(1));
    text.print_answer(answer, &report.warnings);
    if !report.ranking.is_empty() {
        text.print_line(&ranking(report));
        text.print_line("");
    }
    if let Some((on_mesh, kinds)) = different_results(report) {
        if report.meshes.len() > 1 {
            text.print_line(&format!("Results on {}:", sanitize(&on_mesh.mesh.name)));
        }
        text.print_line(&results(&kinds));
        text.print_line("");
    }
    text.print_list("- ", same_result(report));
    text.print_list("- ", reasons);
    // The warnings name the backends on which the program fails.
    let excluded = report.excluded.iter().filter(|excluded| !excluded.failed);
    let excluded = excluded.map(|e| format!("{} is excluded: {}.", e.backend, e.reason));
    text.print_list("- ", excluded);
    if !report.usage.is_empty() {
        text.print_line("\nTo use it in your package:");
        for line in &report.usage {
            text.print_line(&format!("  {line}"));
        }
    }
}

/// Says which result of a program all structures have. If results differ and this is no fault, says why.
fn same_result(report: &PickReport) -> Option<String> {
    if !report.mismatches.is_empty() {
        return None;
    }
    if let Some((_, kinds)) = different_results(report) {
        let others = kinds[1..].iter().flatten();
        let others = list(others.map(|ranked| ranked.backend.clone()));
        return Some(format!(
            "Not compared with the other results, because vertices with equal coordinates are merged: {others}."
        ));
    }
    let results: Vec<f64> = report.ranking.iter().filter_map(|r| r.result).collect();
    let (first, others) = results.split_first()?;
    (!others.is_empty()).then(|| {
        format!(
            "All {} results agree, up to rounding: {first:?}.",
            results.len()
        )
    })
}

/// Returns the table of the results of a program that differ. Results that agree have one letter; the others show the part
/// by which they differ from the first.
fn results(kinds: &[Vec<&Ranked>]) -> String {
    let of_kinds = || kinds.iter().zip('A'..);
    let rows = || of_kinds().flat_map(|(kind, letter)| kind.iter().map(move |&r| (r, letter)));
    let first = kinds[0][0];
    let names = Column::words("", rows().map(|(ranked, _)| ranked.backend.clone()));
    let value = |ranked: &Ranked| ranked.result.map_or("–".into(), |x| format!("{x:?}"));
    let apart = rows().map(|(ranked, letter)| match (ranked.result, first.result) {
        (Some(x), Some(expected)) if letter != 'A' && x != expected => {
            format!("{:.1e}", (x - expected).abs() / expected.abs().max(x.abs()))
        }
        _ => String::new(),
    });
    let mut columns = vec![
        Column::figures("same", rows().map(|(_, letter)| letter.to_string())),
        Column::figures("result", rows().map(|(ranked, _)| value(ranked))),
        Column::figures("differs by", apart),
    ];
    if rows().any(|(ranked, _)| ranked.elements != first.elements) {
        let elements = rows().map(|(ranked, _)| {
            let count = ranked.elements.map(|count| grouped(count as usize));
            count.unwrap_or_default()
        });
        columns.push(Column::figures("elements", elements));
    }
    column_table(&names, &columns)
}

/// Returns the table of backends, the fastest first, and its legend.
fn ranking(report: &PickReport) -> String {
    let pays_after: Vec<String> = report
        .ranking
        .iter()
        .map(|ranked| pays_after(report, ranked))
        .collect();
    // If one operation, or one run, pays for every build that pays, there is nothing to read.
    let pays_at_once = pays_after
        .iter()
        .all(|after| ["1", "–", "never"].contains(&after.as_str()));
    let mut signs = Signs::new(false);
    let has_winner = report
        .ranking
        .iter()
        .all(|ranked| ranked.estimated || ranked.has_enough_samples())
        && report.mismatches.is_empty();
    let tied = || report.ranking[1..].iter().filter(|r| r.tied_with_best);
    let mut times = Vec::new();
    let mut ratios = Vec::new();
    let is_measured = report.ranking.iter().any(|ranked| !ranked.estimated);
    for (place, ranked) in report.ranking.iter().enumerate() {
        let ratio = ranked.shown_ratio(&report.ranking[0]);
        if ranked.estimated {
            let sign = signs.record('≥');
            let ns = rounded_down(ranked.ns_per_operation);
            times.push(format!("{sign}{}", duration(ns)));
            ratios.push(match is_measured {
                true => format!("{sign}{}", figure(rounded_down(ratio))),
                false => "–".into(),
            });
            continue;
        }
        let sign = match ranked.sampled {
            true => signs.record('~').into(),
            false => String::new(),
        };
        times.push(format!("{sign}{}", duration(ranked.ns_per_operation)));
        // The fastest is as sure as those that it shares the first place with.
        let is_equal = match place {
            0 => tied().all(Ranked::is_equal_to_best),
            _ => ranked.is_equal_to_best(),
        };
        let standing = match ranked.tied_with_best && has_winner {
            false => None,
            true if tied().next().is_none() => Some(Standing::Best),
            true if is_equal => Some(Standing::Equal),
            true => Some(Standing::Undecided),
        };
        ratios.push(format!("{}{}", signs.standing(standing), figure(ratio)));
    }
    let of = |figure: &dyn Fn(&Ranked) -> String| -> Vec<String> {
        report.ranking.iter().map(figure).collect()
    };
    let interval = |ranked: &Ranked| {
        let interval = ranked.ci_low.zip(ranked.ci_high);
        interval.map_or("–".into(), |(low, high)| {
            format!("{}–{}", figure(low), figure(high))
        })
    };
    let first_build = |ranked: &Ranked| ranked.first_build_ns.map_or("–".into(), duration);
    let mut columns = vec![
        Column::figures(report.unit(), times),
        Column::figures("ratio", ratios),
        Column::figures("interval", of(&interval)),
        Column::figures("1st build", of(&first_build)),
        Column::figures("rebuild", of(&|ranked| duration(ranked.build_ns))),
        Column::figures(
            "B/vertex",
            of(&|ranked| format!("{:.1}", ranked.bytes_per_vertex)),
        ),
    ];
    if !pays_at_once {
        columns.push(Column::figures("pays", pays_after));
    }
    let names = Column::words("", of(&|ranked| ranked.backend.clone()));
    let table = column_table(&names, &columns);
    let unit = report.unit();
    signs.explain(match report.program {
        None => "operation: mean time of an operation of the mix",
        Some(_) => "run: time of a run of the program",
    });
    let confidence = report.run.settings.confidence;
    signs.explain(&format!(
        "ratio: to the time of the fastest, with its {confidence} interval"
    ));
    signs.explain("1st build: time to build on new memory pages");
    signs.explain("rebuild: on pages that were used before");
    if !pays_at_once {
        signs.explain(&format!(
            "pays: number of {unit}s after which the 1st build and the {unit}s take less time than \
             the {unit}s on an indexed face set that is already built; – for this set"
        ));
    }
    let mut made_from = report
        .ranking
        .iter()
        .filter_map(|ranked| ranked.made_from.as_deref());
    if let Some(over) = made_from.next() {
        signs.explain(&format!(
            "relation-tables: flat tables of only the relations in the mix, made from {over}"
        ));
    }
    format!("{table}\n{}", signs.legend())
}

fn pays_after(report: &PickReport, ranked: &Ranked) -> String {
    let row = |row: &&BreakEven| row.backend == ranked.backend;
    match report.break_even.iter().find(row) {
        None => "–".into(),
        Some(BreakEven {
            operations: None, ..
        }) => "never".into(),
        Some(BreakEven {
            operations: Some(operations),
            ..
        }) if *operations < 1e15 => approximate(operations.max(1.0)),
        Some(_) => "never".into(),
    }
}
