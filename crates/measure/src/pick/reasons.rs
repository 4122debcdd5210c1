//! The result of a pick and its reasons, as sentences.

use crate::engine::agreement::is_close;
use crate::engine::warnings::machine_warnings;
use crate::operation::Operation;
use crate::pick::choice::{rule, what_would_change};
use crate::pick::kinds::different_results;
use crate::usage;
use sixfold::Edit;
use sixfold_results::numbers::{counted, duration, figure, grouped, list, rounded};
use sixfold_results::statistics::MIN_SAMPLES;
use sixfold_results::{EQUAL_UP_TO, Need, PartCost, PickReport, ProgramReport, Ranked, Samples};

/// Returns sentences about the fastest backend, the reasons, the and the break-even.
pub(super) fn sentences(report: &PickReport) -> Vec<String> {
    let best = match report.ranking.first() {
        None => return vec!["No backend qualifies.".into()],
        Some(best) if best.estimated => return vec![NOT_MEASURED.into()],
        Some(best) => best,
    };
    let chosen = report.choice.as_ref();
    let used = used(report).unwrap_or(best);
    let mut sentences = vec![fastest(report, best)];
    sentences.extend(not_ranked(report, best));
    sentences.extend(chosen.and_then(|choice| rule(choice, &report.ranking)));
    sentences.extend(
        chosen
            .map(what_would_change)
            .filter(|_| report.ranking.len() > 1 && report.program.is_none()),
    );
    sentences.extend(report.program.as_ref().and_then(asked));
    sentences.extend(dominant_part(report, best));
    sentences.extend(largest_loss(report, best));
    sentences.extend(tables(report, best));
    sentences.extend(refined_form(report));
    sentences.extend(one_use_with_building(report, used));
    sentences
}

/// Returns the chosen backend; without a choice, the fastest.
fn used(report: &PickReport) -> Option<&Ranked> {
    let choice = report.choice.as_ref();
    let chosen = choice.and_then(|c| report.ranking.iter().find(|r| r.backend == c.backend));
    chosen.or(report.ranking.first().filter(|best| !best.estimated))
}

const NOT_MEASURED: &str = "No backend was measured, because a run would exceed the budget: use a \
                            longer --budget.";

/// Names the form of the structures that steps of subdivision refine, if the other operations need the
/// editable form.
fn refined_form(report: &PickReport) -> Option<String> {
    let actions = || report.workload.mix.iter().map(|part| &*part.action);
    let edits = report.needs.contains(&Need::Edit) || actions().any(needs_editable_mesh);
    let mut subdivision = actions().filter(|action| match action.parse::<Operation>() {
        Ok(operation) => operation.subdivides(),
        Err(_) => *action == "subdivide",
    });
    let first = subdivision
        .next()
        .filter(|_| edits && report.program.is_none())?;
    let names = subdivision.fold(format!("`{first}`"), |names, name| {
        format!("{names}, `{name}`")
    });
    Some(format!(
        "The compact form of each structure is refined ({names}); all other operations run on the \
         editable form."
    ))
}

/// Returns whether the action of a mix needs a mesh that can be edited.
fn needs_editable_mesh(action: &str) -> bool {
    action.parse::<Edit>().is_ok()
        || matches!(action.parse::<Operation>(), Ok(Operation::EditPass(_)))
}

/// Returns warnings about noise, few rounds, a busy machine and wrong results.
pub fn warnings(report: &PickReport) -> Vec<String> {
    let by_mesh = report.by_mesh.iter().flat_map(|of_mesh| &of_mesh.samples);
    let samples: Vec<&Samples> = report.samples.iter().chain(by_mesh).collect();
    let failed = report.failed();
    let failed = failed.map(|e| format!("The program fails on {}: {}.", e.backend, e.reason));
    let mut warnings: Vec<String> = failed.collect();
    let program = report.program.as_ref();
    if let Some(program) = program.filter(|_| has_different_results(report)) {
        warnings.extend(kinds_of_results(report));
        warnings.push(why_results_differ(&program.kind));
    }
    warnings.extend(program.and(report.ranking.first()).and_then(too_short));
    warnings.extend(machine_warnings(&report.run, &samples));
    let more = report.run.settings.more_samples();
    if let Some(noise) = report.noise.filter(|&noise| noise > 1.05) {
        warnings.push(format!(
            "Two measurements of one backend differ by {:.0} %: smaller differences between backends are not significant. Measure on a quieter machine, or with {more}.",
            100.0 * (noise - 1.0)
        ));
    }
    let measured = report.ranking.iter().filter(|ranked| !ranked.estimated);
    let fewest = measured.map(|ranked| ranked.samples).min();
    if let Some(fewest) = fewest.filter(|_| report.preliminary) {
        warnings.push(match report.run.settings.launches {
            None => format!(
                "Some times are from only {}, but a narrow interval needs {MIN_SAMPLES} samples: use \
                 {more}.",
                counted(fewest, "sample", "samples")
            ),
            Some(_) => format!("Some times are from only one launch: use {more}."),
        });
    }
    let wrong = report
        .mismatches
        .iter()
        .filter(|_| report.program.is_none());
    warnings.extend(wrong.map(|backend| {
        format!(
            "{backend} gives different results from the other backends. This is a fault in Sixfold: please report it."
        )
    }));
    warnings
}

/// The time of a run below which the call of the program and its place in memory count as much as the structure.
const SHORT_RUN_NS: f64 = 100.0;

/// Warns of a program that does too little to compare structures. `best` is the fastest backend.
fn too_short(best: &Ranked) -> Option<String> {
    (best.ns_per_operation < SHORT_RUN_NS).then(|| {
        format!(
            "A run takes only {}, so the times say more about the call than about the structure: do more in a run.",
            duration(best.ns_per_operation)
        )
    })
}

/// Returns whether a program has different results on some backends, so that its times are not of the same work.
fn has_different_results(report: &PickReport) -> bool {
    report.program.is_some() && !report.mismatches.is_empty()
}

/// Names the backends whose results agree.
fn kinds_of_results(report: &PickReport) -> Option<String> {
    let (on_mesh, kinds) = different_results(report)?;
    let kinds = kinds.iter().map(|kind| {
        let names = list(kind.iter().map(|ranked| ranked.backend.clone()));
        match kind.len() {
            1 => format!("{names} agrees with no other"),
            _ => format!("{names} agree"),
        }
    });
    let kinds: Vec<String> = kinds.collect();
    let checksums = on_mesh.ranking.iter().filter_map(|ranked| ranked.result);
    let checksums: Vec<f64> = checksums.collect();
    let what = match checksums.iter().all(|&one| is_close(one, checksums[0])) {
        true => "numbers of elements",
        false => "results",
    };
    Some(format!(
        "The {what} on {} differ by more than rounding: {}.",
        on_mesh.mesh.name,
        kinds.join("; ")
    ))
}

/// The reasons for different results of a program, the most likely first, each with how to test it.
fn why_results_differ(kind: &str) -> String {
    let order = "a query lists neighbours, edges or faces in another order, and the program takes the first, or the \
                 first of equals: `--order canonical` tells, and sorting them by their positions mends it";
    let renamed = "an edit gives another handle to an element that was collected before it: the documentation of \
                   `MeshEdit` shows a loop with one result on every structure";
    let numbers = "elements are numbered in another order: `--order canonical` tells";
    let refused = "an edit is refused on one structure, as structures of manifolds do: count the refused edits in the \
                   result";
    let moved = "a map was made before a vertex moved: on polygon-soup, whose vertices are their positions, the vertex \
                 then has another handle";
    let rounding = "sums of `f32` in another order: add up in `f64`";
    let reasons = match kind {
        "edits" => vec![order, renamed, moved, numbers, refused, rounding],
        "moves" => vec![order, moved, numbers, rounding],
        _ => vec![order, numbers, rounding],
    };
    let reasons = (1..).zip(reasons).map(|(n, why)| format!("({n}) {why}"));
    let reasons: Vec<String> = reasons.collect();
    format!(
        "Likely reasons for different results, the most likely first: {}.",
        reasons.join("; ")
    )
}

fn name(ranked: &Ranked) -> String {
    match &ranked.made_from {
        Some(made_from) => format!("{} (made from {made_from})", ranked.backend),
        None => ranked.backend.clone(),
    }
}

/// Names the backends whose lower bound does not show that they are slower than the fastest.
fn not_ranked(report: &PickReport, best: &Ranked) -> Option<String> {
    let open = |ranked: &&Ranked| ranked.estimated && ranked.ratio_to_best <= EQUAL_UP_TO;
    let open = report.ranking.iter().filter(open);
    let open: Vec<String> = open
        .map(|ranked| format!("{} ({})", name(ranked), ranked.times(best)))
        .collect();
    (!open.is_empty()).then(|| {
        format!(
            "Not ranked, because a run would exceed the budget: {}. Use a longer --budget.",
            list(open)
        )
    })
}

fn fastest(report: &PickReport, best: &Ranked) -> String {
    let tied = || {
        let others = report.ranking[1..].iter();
        others.filter(|ranked| ranked.tied_with_best)
    };
    let all_equal = tied().all(Ranked::is_equal_to_best);
    let tied: Vec<String> = tied().map(name).collect();
    let each = duration(best.ns_per_operation);
    let workload = &report.workload.name;
    let unit = report.unit();
    let is_slower = |ranked: &&Ranked| match ranked.estimated {
        true => ranked.ratio_to_best > EQUAL_UP_TO,
        false => !ranked.tied_with_best,
    };
    let next = report.ranking[1..].iter().find(is_slower);
    let differ = has_different_results(report);
    let clear = !report.preliminary && !differ && next.is_some_and(|next| next.ci_low.is_some());
    let next = next.map_or(String::new(), |next| {
        let sure = next
            .ci_low
            .zip(next.ci_high)
            .map_or(String::new(), |(low, high)| {
                let confidence = report.run.settings.confidence;
                format!(" ({confidence}: {} to {})", figure(low), figure(high))
            });
        format!(
            "; {} takes {} that time{sure}",
            name(next),
            next.times(best)
        )
    });
    let failed = report.failed().map(|excluded| &excluded.backend);
    let failed: Vec<&String> = failed.collect();
    let answer = match (differ, report.preliminary, &failed[..]) {
        (true, ..) => "The results differ, so the times are not of the same work: for".into(),
        (false, true, []) => "Preliminary answer from too few samples: for".into(),
        (false, _, failed @ [_, ..]) => {
            format!("Without {}, on which the program fails: for", list(failed))
        }
        (false, false, []) => "For".to_owned(),
    };
    let clearly = match clear {
        true => "clearly ",
        false => "",
    };
    match &tied[..] {
        [] => format!(
            "{answer} {workload}, {} is {clearly}fastest: {each} per {unit}{next}.",
            name(best)
        ),
        tied => {
            let names = list(std::iter::once(&name(best)).chain(tied));
            match all_equal {
                true => format!(
                    "{answer} {workload}, {names} are equally fast (within 5 %): {each} per {unit}{next}."
                ),
                false => format!(
                    "{answer} {workload}, it is undecided which is fastest of {names}: {each} per {unit}{next}."
                ),
            }
        }
    }
}

/// Describes what one run of a program asks.
fn asked(program: &ProgramReport) -> Option<String> {
    let counts = program.asked.as_ref().filter(|counts| !counts.is_empty())?;
    let names = counts
        .iter()
        .map(|asked| format!("{} {}", grouped(asked.count as usize), asked.operation));
    Some(format!("One run asks for {}.", list(names)))
}

fn dominant_part(report: &PickReport, best: &Ranked) -> Option<String> {
    let heaviest = best
        .parts
        .iter()
        .max_by(|a, b| a.weighted_ns().total_cmp(&b.weighted_ns()))?;
    let each = duration(heaviest.ns?);
    if report.workload.mix.len() == 1 {
        return None;
    }
    Some(format!(
        "{} takes {:.0} % of the time of the fastest backend ({each} each time).",
        heaviest.operation,
        100.0 * (rounded(heaviest.ns?) * heaviest.share / rounded(best.ns_per_operation)).min(1.0)
    ))
}

/// Describes the part of the mix in which the second-best backend loses the most time.
fn largest_loss(report: &PickReport, best: &Ranked) -> Option<String> {
    let next = report
        .ranking
        .iter()
        .find(|ranked| !ranked.tied_with_best && !ranked.estimated)?;
    let lost = |(a, b): (&PartCost, &PartCost)| a.weighted_ns() - b.weighted_ns();
    let pairs = || next.parts.iter().zip(&best.parts);
    let (theirs, ours) = pairs().max_by(|&a, &b| lost(a).total_cmp(&lost(b)))?;
    if lost((theirs, ours)) <= 0.0 || report.workload.mix.len() == 1 {
        return None;
    }
    Some(format!(
        "{} is slower mainly in {}: {} each time, compared with {} on {}.",
        name(next),
        theirs.operation,
        duration(theirs.ns?),
        duration(ours.ns?),
        name(best)
    ))
}

/// Describes the time of relation tables. If the tables are the fastest, describes the fastest
/// structure instead.
fn tables(report: &PickReport, best: &Ranked) -> Option<String> {
    let structure = report
        .ranking
        .iter()
        .find(|ranked| ranked.made_from.is_none() && !ranked.estimated)?;
    if best.made_from.is_some() {
        return Some(format!(
            "Without relation tables, {} is fastest: {} per {}.",
            structure.backend,
            duration(structure.ns_per_operation),
            report.unit()
        ));
    }
    let tables = report
        .ranking
        .iter()
        .find(|ranked| ranked.made_from.is_some())?;
    Some(format!(
        "Relation tables take {1} the time of the fastest backend. The tables contain only the \
         queried relations, and are made once from {0}.",
        tables.made_from.as_deref().unwrap_or_default(),
        tables.times(best)
    ))
}

/// Describes the backend with the least time for one use of the mesh, building included. `used` is
/// the choice for many uses.
fn one_use_with_building(report: &PickReport, used: &Ranked) -> Option<String> {
    let operations = report.operations;
    let total = |ranked: &Ranked| {
        // A program already has an indexed face set.
        let build = match ranked.backend.as_str() {
            "indexed-face-set" => 0.0,
            _ => rounded(ranked.first_build_ns()),
        };
        // From the shown times, so that a reader gets the same sum.
        build + operations * rounded(ranked.ns_per_operation)
    };
    let least = report
        .ranking
        .iter()
        .filter(|ranked| !ranked.estimated)
        .min_by(|a, b| total(a).total_cmp(&total(b)))?;
    let unit = report.unit();
    let amount = counted(operations.round() as usize, unit, &format!("{unit}s"));
    // A difference of 5 % is no reason for another structure.
    let is_close = total(used) <= EQUAL_UP_TO * total(least);
    let nearly = match (is_close, least.backend == used.backend) {
        (true, false) => ", within 5 %,",
        _ => "",
    };
    Some(match is_close {
        true => format!(
            "{} also takes the least time{nearly} for one use of the mesh ({amount}), building \
             included: {} in total.",
            name(used),
            duration(total(used)),
        ),
        false => format!(
            "For a single use of the mesh ({amount}), choose {} instead: building included, it takes \
             {} in total, and {} takes {}. The input is already an indexed face set, so the \
             time to build this structure counts as 0.",
            name(least),
            duration(total(least)),
            name(used),
            duration(total(used)),
        ),
    })
}

/// Returns the lines with which a program uses the choice for many uses.
pub(super) fn usage(report: &PickReport) -> Vec<String> {
    let mesh = report.meshes.first().map_or("", |mesh| &mesh.name);
    used(report).map_or(Vec::new(), |used| {
        usage::lines(&used.types, &used.tabulated, mesh)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pick::choice::tests::ranked;

    #[test]
    fn only_a_run_that_hardly_takes_time_is_too_short() {
        let of = |ns: f64| too_short(&ranked("half-edge", 1.0, false, 1, [ns; 2]));
        assert!(of(99.0).is_some_and(|text| text.contains("only 99.0 ns")));
        assert_eq!(of(100.0), None);
    }
}
