//! Repeats one study many times and reports how much the results vary. For each operation, the
//! report counts the studies in which each backend is the fastest or shares the first place. The
//! report counts the 95 % confidence intervals that contain the median of all studies. The report
//! counts how often a study finds a difference of more than 10 %. The report also estimates how
//! much the speed of the machine drifts between studies.
//!
//! ```sh
//! cargo run --release -p sixfold-study --example repeatability_report -- \
//!     reports/repeatability 20 45
//! ```
//!
//! Arguments: the output folder, the number of studies, and the budget of each study in seconds.
//! The mesh is a shuffled torus of 100,352 triangles.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use sixfold::{Relation, shapes};
use sixfold_results::statistics::UNSEEN_DRIFT;
use sixfold_results::{Environment, Report, ResultRow, Run, RunSettings, Standing};
use sixfold_study::{Operation, Settings, StudyMesh, start_run, study};

/// Minimum ratio of two backends whose order should be the same in all studies.
const GAP: f64 = 1.1;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or("reports/repeatability".into());
    let runs: usize = arguments.next().map_or(Ok(20), |text| text.parse())?;
    let seconds: u64 = arguments.next().map_or(Ok(45), |text| text.parse())?;

    let torus = shapes::triangle_torus(224, 224)?;
    let study_mesh = StudyMesh::new(
        "torus of 100,352 triangles, shuffled",
        shapes::shuffled(&torus, 1),
    );
    let now = start_run(RunSettings::default());
    let mut reports = Vec::new();
    let start = Instant::now();
    for run in 0..runs {
        let settings = Settings {
            operations: Relation::ALL.map(Operation::Relation).to_vec(),
            effort: Duration::from_secs(seconds).into(),
            seed: run as u64 + 1,
            ..Settings::default()
        };
        let report = study(&study_mesh, &settings, &AtomicBool::new(false), &mut |_| ())?;
        eprintln!(
            "{} of {runs}, {:.0} s",
            run + 1,
            start.elapsed().as_secs_f64()
        );
        reports.push(report);
    }
    let each = start.elapsed().as_secs_f64() / runs as f64;
    let text = report_text(&reports, &now, seconds, each);
    fs::create_dir_all(&folder)?;
    fs::write(format!("{folder}/output.md"), &text)?;
    print!("{text}");
    Ok(())
}

fn report_text(reports: &[Report], now: &Run, seconds: u64, each: f64) -> String {
    let runs = reports.len();
    let Environment {
        cpu_model,
        cores,
        rustc,
        ..
    } = &now.environment;
    let mut text = format!(
        "# Repeated studies\n\n```sh\n\
         cargo run --release -p sixfold-study --example repeatability_report -- reports/repeatability {runs} {seconds}\n\
         ```\n\n{}, {} cores, load {:.1} at the start; {rustc}; processor time of the thread.\n\n",
        cpu_model.as_deref().unwrap_or("unknown processor"),
        cores.unwrap_or(0),
        now.start.load_average.unwrap_or(f64::NAN),
    );
    let _ = writeln!(
        text,
        "{runs} studies of a shuffled torus of 100,352 triangles ran one after the other. Each study measured all nine\n\
         relations on all structures, with a budget of {seconds} s and a different seed. A study took {each:.0} s on average.\n"
    );
    text += &winners(reports);
    text += &orders(reports);
    text += &differences(reports);
    text += &coverage(reports);
    text += &drift(reports);
    text += &unseen_drift(reports);
    text
}

fn winners(reports: &[Report]) -> String {
    let mut text = String::from(
        "## Best backends\n\n| operation | number of studies in which a backend is best or shares the first place |\n|---|---|\n",
    );
    for operation in Relation::ALL.map(Operation::Relation) {
        let mut named: BTreeMap<String, [usize; 2]> = BTreeMap::new();
        for row in reports
            .iter()
            .flat_map(|report| report.rows(operation.name()))
        {
            match row.standing {
                Some(Standing::Best) => named.entry(row.backend.clone()).or_default()[0] += 1,
                Some(Standing::Equal | Standing::Undecided) => {
                    named.entry(row.backend.clone()).or_default()[1] += 1
                }
                _ => {}
            }
        }
        let mut named: Vec<_> = named.into_iter().collect();
        named.sort_by_key(|(_, [best, shared])| std::cmp::Reverse((*best, *shared)));
        let cells: Vec<String> = named
            .into_iter()
            .map(|(backend, [best, shared])| match (best, shared) {
                (best, 0) => format!("{backend} best {best}"),
                (0, shared) => format!("{backend} shared {shared}"),
                (best, shared) => format!("{backend} best {best}, shared {shared}"),
            })
            .collect();
        let _ = writeln!(text, "| {operation} | {} |", cells.join("; "));
    }
    text + "\n"
}

/// Returns the time of one backend in one operation, for each study.
fn series(reports: &[Report], operation: Operation, backend: &str) -> Vec<f64> {
    let of = |report: &Report| {
        let row = report.row(operation.name(), backend)?;
        row.median_ns
    };
    reports.iter().filter_map(of).collect()
}

/// Reports whether pairs that differ by more than 10 % have the same order in all studies.
fn orders(reports: &[Report]) -> String {
    let (mut pairs, mut apart, mut steady) = (0, 0, 0);
    let mut unsteady = String::new();
    let backends: Vec<&str> = reports[0]
        .backends
        .iter()
        .map(|b| b.name.as_str())
        .collect();
    for operation in Relation::ALL.map(Operation::Relation) {
        for (i, a) in backends.iter().enumerate() {
            for b in &backends[i + 1..] {
                let both = series(reports, operation, a)
                    .into_iter()
                    .zip(series(reports, operation, b));
                let ratios: Vec<f64> = both.map(|(a, b)| a / b).collect();
                if ratios.is_empty() {
                    continue;
                }
                pairs += 1;
                let gap = median(&ratios);
                if gap.max(1.0 / gap) <= GAP {
                    continue;
                }
                apart += 1;
                let same = ratios
                    .iter()
                    .filter(|&&ratio| (ratio > 1.0) == (gap > 1.0))
                    .count();
                if 20 * same >= 19 * ratios.len() {
                    steady += 1;
                } else {
                    let apart = 100.0 * (gap.max(1.0 / gap) - 1.0);
                    let (all, operation) = (ratios.len(), operation.to_string());
                    let _ = writeln!(
                        unsteady,
                        "| {operation} | {a} and {b} | {apart:.0} % | {same} of {all} |"
                    );
                }
            }
        }
    }
    let mut text = format!(
        "## Order of pairs\n\nFor each relation, the times of each two structures were compared. In {apart} of the {pairs} comparisons, the medians over\n\
         all studies differ by more than {:.0} %. In {steady} of these comparisons, the same structure is faster in at least 95 % of\n\
         the studies.\n\n",
        100.0 * (GAP - 1.0)
    );
    if !unsteady.is_empty() {
        text += "In the other comparisons, fewer studies have the same order:\n\n| operation | pair | difference | same order in |\n|---|---|---|---|\n";
        text += &unsteady;
        text.push('\n');
    }
    text
}

/// Reports how often a backend that is more than 10 % slower than the best is called slower.
fn differences(reports: &[Report]) -> String {
    let (mut slower, mut all) = (0, 0);
    for operation in Relation::ALL.map(Operation::Relation) {
        for backend in &reports[0].backends {
            let rows: Vec<&ResultRow> = reports
                .iter()
                .filter_map(|report| report.row(operation.name(), &backend.name))
                .collect();
            let ratios: Vec<f64> = rows.iter().filter_map(|row| row.ratio_to_best).collect();
            if ratios.is_empty() || median(&ratios) <= GAP {
                continue;
            }
            let called = |row: &&&ResultRow| row.standing == Some(Standing::Slower);
            slower += rows.iter().filter(called).count();
            all += ratios.len();
        }
    }
    format!(
        "## Differences from the best backend\n\nFor some backends, the ratio to the best backend (median over all studies) is above {GAP}. These\n\
         backends have {all} results in single studies. In {slower} of these results ({:.1} %), the study calls the backend slower.\n\n",
        100.0 * slower as f64 / all as f64
    )
}

/// Returns the medians of the times of a backend in all studies, and the variances that the studies
/// show by themselves. Both are of logarithms. Leaves out studies with fewer than six samples.
fn seen_variances(reports: &[Report], operation: Operation, backend: &str) -> Vec<[f64; 2]> {
    /// The 97.5 % quantiles of Student's distribution with 5 degrees of freedom, and of the normal
    /// distribution: a half-width consists of a seen and an unseen part.
    const QUANTILES: [f64; 2] = [2.570_582, 1.959_964];
    let of = |report: &Report| {
        let row = report.row(operation.name(), backend)?;
        let enough = row.samples >= 6 && !row.sampled;
        let half_width = (row.ci_high_ns? / row.ci_low_ns?).ln() / 2.0;
        let seen = half_width.powi(2) - (QUANTILES[1] * UNSEEN_DRIFT).powi(2);
        let median_ns = row.median_ns?;
        enough.then(|| [median_ns.ln(), seen / QUANTILES[0].powi(2)])
    };
    reports.iter().filter_map(of).collect()
}

/// Reports the standard deviation between studies that the samples of one study do not show.
fn unseen_drift(reports: &[Report]) -> String {
    let mut variances = Vec::new();
    for operation in Relation::ALL.map(Operation::Relation) {
        for backend in &reports[0].backends {
            let cells = seen_variances(reports, operation, &backend.name);
            if cells.len() < 3 {
                continue;
            }
            let count = cells.len() as f64;
            let mean = cells.iter().map(|[log, _]| log).sum::<f64>() / count;
            let squares: f64 = cells.iter().map(|[log, _]| (log - mean).powi(2)).sum();
            let seen = cells.iter().map(|[_, seen]| seen).sum::<f64>() / count;
            variances.push(squares / (count - 1.0) - seen);
        }
    }
    if variances.is_empty() {
        return String::new();
    }
    format!(
        "\n## Drift that one study does not show\n\nThe times vary more between studies than the samples of one study show. The variation that no single study\n\
         shows has a standard deviation of {:.1} % (median over all backends and relations, without scans). The intervals\n\
         assume {:.1} %.\n",
        100.0 * median(&variances).max(0.0).sqrt(),
        100.0 * UNSEEN_DRIFT
    )
}

/// Reports how often the interval of one study contains the median of all studies.
fn coverage(reports: &[Report]) -> String {
    let mut text = String::from(
        "## Coverage of the intervals\n\nThe table shows the share of 95 % intervals that contain the median over all studies. The table also shows the\n\
         width of the intervals: the upper end minus the lower end, divided by the median of the study (median over all\n\
         intervals).\n\n\
         | interval of | contain the median of all studies | number of intervals | width |\n|---|---|---|---|\n",
    );
    let of_time = |row: &ResultRow| Some([row.ci_low_ns?, row.median_ns?, row.ci_high_ns?]);
    let of_ratio =
        |row: &ResultRow| Some([row.ratio_ci_low?, row.ratio_to_best?, row.ratio_ci_high?]);
    type Of = dyn Fn(&ResultRow) -> Option<[f64; 3]>;
    let kinds: [(&str, &Of); 2] = [("the time", &of_time), ("the ratio to the best", &of_ratio)];
    for (name, of) in kinds {
        for scanning in [false, true] {
            let (mut covered, mut all, mut widths) = (0, 0, Vec::new());
            for operation in Relation::ALL.map(Operation::Relation) {
                let mut rows: BTreeMap<&str, Vec<[f64; 3]>> = BTreeMap::new();
                // Ratios are comparable only between studies with the same best backend.
                let best = |report: &Report| {
                    let best = report
                        .rows(operation.name())
                        .find(|row| row.ratio_to_best == Some(1.0));
                    best.map(|row| row.backend.clone())
                };
                let usual = reports.iter().filter_map(best).next();
                for report in reports {
                    if best(report) != usual {
                        continue;
                    }
                    for row in report
                        .rows(operation.name())
                        .filter(|row| row.sampled == scanning)
                    {
                        let itself = name != "the time" && Some(&row.backend) == usual.as_ref();
                        if let Some(interval) = of(row).filter(|_| !itself) {
                            rows.entry(&row.backend).or_default().push(interval);
                        }
                    }
                }
                for intervals in rows.into_values() {
                    let middles: Vec<f64> =
                        intervals.iter().map(|[_, middle, _]| *middle).collect();
                    let truth = median(&middles);
                    for [low, middle, high] in intervals {
                        covered += usize::from(low <= truth && truth <= high);
                        all += 1;
                        widths.push((high - low) / middle);
                    }
                }
            }
            if all == 0 {
                continue;
            }
            let what = if scanning { ", scans" } else { "" };
            let share = 100.0 * covered as f64 / all as f64;
            let width = 100.0 * median(&widths);
            let _ = writeln!(
                text,
                "| {name}{what} | {share:.0} % | {all} | {width:.1} % |"
            );
        }
    }
    if text.ends_with("|---|---|---|---|\n") {
        text += "| none: too few samples | – | 0 | – |\n";
    }
    let noises: Vec<f64> = reports
        .iter()
        .filter_map(|report| Some(report.control.as_ref()?.typical))
        .collect();
    if !noises.is_empty() {
        let worst = noises.iter().copied().fold(1.0, f64::max);
        let _ = writeln!(
            text,
            "\nIn each study, one structure is measured twice. The two times of this structure differ by {:.1} % (the median over\n\
             the relations, then over the studies), and by at most {:.1} %.",
            100.0 * (median(&noises) - 1.0),
            100.0 * (worst - 1.0)
        );
    }
    text
}

/// Reports how far a figure varies between studies.
fn drift(reports: &[Report]) -> String {
    let ratios = |operation: Operation, backend: &str| -> Vec<f64> {
        let rows = reports.iter().filter_map(|report| {
            let row = report.row(operation.name(), backend)?;
            row.ratio_to_best
        });
        rows.collect()
    };
    let mut text = String::from(
        "\n## Variation between studies\n\nThe variation of a figure is its standard deviation over all studies, divided by its mean. A figure is the result of\n\
         one structure in one relation.\n\n\
         | figure | median of all | 90 % are below | largest |\n|---|---|---|---|\n",
    );
    type Of<'a> = &'a dyn Fn(Operation, &str) -> Vec<f64>;
    let times = |operation: Operation, backend: &str| series(reports, operation, backend);
    let kinds: [(&str, Of<'_>); 2] = [("time", &times), ("ratio to the best", &ratios)];
    for (name, of) in kinds {
        let mut spreads: Vec<f64> = Vec::new();
        for operation in Relation::ALL.map(Operation::Relation) {
            for backend in &reports[0].backends {
                let values = of(operation, &backend.name);
                if values.len() == reports.len() && values.iter().any(|&value| value != 1.0) {
                    spreads.push(spread(&values));
                }
            }
        }
        spreads.sort_by(f64::total_cmp);
        let most = spreads.last().copied().unwrap_or(f64::NAN);
        let ninth = spreads.get(spreads.len() * 9 / 10).copied().unwrap_or(most);
        let _ = writeln!(
            text,
            "| {name} | {:.1} % | {:.1} % | {:.1} % |",
            100.0 * median(&spreads),
            100.0 * ninth,
            100.0 * most
        );
    }
    text
}

fn spread(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (count - 1.0)).sqrt() / mean
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    f64::midpoint(sorted[(count - 1) / 2], sorted[count / 2])
}
