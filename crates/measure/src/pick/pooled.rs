//! Combines the results of one or several meshes into one report.

use std::collections::BTreeMap;

use crate::pick::choice::choose;
use crate::pick::measurement::MeshOutcome;
use crate::pick::reasons;
use sixfold_results::ranking::NO_DIFFERENCE;
use sixfold_results::statistics::MIN_SAMPLES;
use sixfold_results::{
    BreakEven, Excluded, MeshRanking, Need, PartCost, PickReport, ProgramReport, Ranked, Run,
    Timer, WorkloadReport,
};

/// What is asked of the backends.
pub struct Question {
    pub workload: WorkloadReport,
    /// The program that was run in place of the workload.
    pub program: Option<ProgramReport>,
    pub needs: Vec<Need>,
    pub max_memory: Option<u64>,
    /// Backends that are excluded on all meshes.
    pub excluded: Vec<Excluded>,
}

/// Combines the results of the meshes. A backend must qualify on every mesh to be ranked. Backends
/// are compared by geometric means over the meshes.
pub fn pooled(
    mut outcomes: Vec<MeshOutcome>,
    question: Question,
    timer: Timer,
    run: Run,
    interrupted: bool,
) -> PickReport {
    let several = outcomes.len() > 1;
    let mut excluded = question.excluded;
    for outcome in &mut outcomes {
        for new in outcome.excluded.drain(..) {
            if excluded.iter().any(|known| known.backend == new.backend) {
                continue;
            }
            let reason = match several {
                true => format!("{}: {}", outcome.mesh.name, new.reason),
                false => new.reason,
            };
            excluded.push(Excluded { reason, ..new });
        }
    }
    let noise = outcomes.iter().filter_map(MeshOutcome::noise);
    let noise = noise.reduce(f64::max);
    let ranking = match &outcomes[..] {
        [only] => only.ranking.clone(),
        many => ranked_on_all(many, noise.unwrap_or(1.0).max(NO_DIFFERENCE)),
    };
    let operations = mean(outcomes.iter().map(|o| o.operations)).unwrap_or(0.0);
    let break_even = match &outcomes[..] {
        [only] => only.break_even.clone(),
        many => ranking
            .iter()
            .filter_map(|ranked| break_even_on_all(many, ranked))
            .collect(),
    };
    let shortest = outcomes.iter().filter_map(|o| o.shortest_ns);
    let shortest = shortest.min_by(f64::total_cmp);
    let timer = timer.with_shortest(shortest);
    let mut disagreeing: Vec<String> = outcomes
        .iter()
        .flat_map(|o| o.disagreeing.clone())
        .collect();
    disagreeing.sort();
    disagreeing.dedup();
    let mut report = PickReport {
        run,
        meshes: outcomes.iter().map(|o| o.mesh.clone()).collect(),
        workload: question.workload,
        program: question.program,
        operations,
        needs: question.needs,
        max_memory: question.max_memory,
        choice: choose(&ranking),
        preliminary: ranking
            .iter()
            .any(|ranked| !ranked.estimated && is_preliminary(ranked)),
        ranking,
        excluded,
        break_even,
        noise,
        control_ratios: Vec::new(),
        mismatches: disagreeing,
        sentences: Vec::new(),
        warnings: Vec::new(),
        usage: Vec::new(),
        interrupted,
        timer,
        samples: Vec::new(),
        by_mesh: Vec::new(),
    };
    if several {
        let each = outcomes.into_iter().map(|outcome| MeshRanking {
            noise: outcome.noise(),
            mesh: outcome.mesh.name,
            samples: outcome.samples,
            ranking: outcome.ranking,
            break_even: outcome.break_even,
            control_ratios: outcome.control_ratios,
            operations: outcome.operations,
        });
        report.by_mesh = each.collect();
    } else if let Some(only) = outcomes.pop() {
        report.samples = only.samples;
        report.control_ratios = only.control_ratios;
    }
    report.sentences = reasons::sentences(&report);
    report.usage = reasons::usage(&report);
    report.warnings = reasons::warnings(&report);
    report
}

/// Ranks the backends with results on all meshes by the geometric mean of their times. A mean with a
/// lower bound is one itself, and comes last.
fn ranked_on_all(outcomes: &[MeshOutcome], noise: f64) -> Vec<Ranked> {
    let mut by_name: BTreeMap<&str, Vec<&Ranked>> = BTreeMap::new();
    for ranked in outcomes.iter().flat_map(|o| &o.ranking) {
        by_name.entry(&ranked.backend).or_default().push(ranked);
    }
    let everywhere = by_name
        .into_values()
        .filter(|rows| rows.len() == outcomes.len());
    let mut everywhere: Vec<Vec<&Ranked>> = everywhere.collect();
    let time = |rows: &Vec<&Ranked>| geometric(rows.iter().map(|r| r.ns_per_operation));
    let is_bound = |rows: &[&Ranked]| rows.iter().any(|r| r.estimated);
    everywhere.sort_by(|a, b| {
        let by_time = time(a).total_cmp(&time(b));
        is_bound(a).cmp(&is_bound(b)).then(by_time)
    });
    let Some(best) = everywhere.first().cloned() else {
        return Vec::new();
    };
    let rows = everywhere.iter().map(|rows| {
        let ratio = geometric(
            rows.iter()
                .zip(&best)
                .map(|(r, b)| r.ratio_to_best / b.ratio_to_best),
        );
        // Meshes are measured independently, so the squared half-widths of the log intervals add
        // up. The interval of the best backend is added as well.
        let squared_widths = |rows: &[&Ranked]| -> f64 {
            let width = |r: &&Ranked| Some((r.ci_high? / r.ci_low?).ln() / 2.0);
            rows.iter()
                .map(|r| width(r).unwrap_or(f64::INFINITY).powi(2))
                .sum()
        };
        let same = rows[0].backend == best[0].backend;
        let half_width = if same {
            0.0
        } else {
            (squared_widths(rows) + squared_widths(&best)).sqrt() / rows.len() as f64
        };
        let estimated = is_bound(rows);
        let known = half_width.is_finite() && !estimated;
        let tied = ratio <= noise || (known && ratio * (-half_width).exp() <= 1.0);
        let bytes = rows.iter().map(|r| r.bytes).max().unwrap_or(0);
        Ranked {
            ns_per_operation: time(rows),
            launch_ns: Vec::new(),
            ns_ci_low: None,
            ns_ci_high: None,
            ratio_to_best: ratio,
            ci_low: known.then(|| ratio * (-half_width).exp()),
            ci_high: known.then(|| ratio * half_width.exp()),
            tied_with_best: tied && !estimated,
            build_ns: geometric(rows.iter().map(|r| r.build_ns)),
            build_launch_ns: Vec::new(),
            first_build_ns: rows
                .iter()
                .map(|r| r.first_build_ns)
                .collect::<Option<Vec<f64>>>()
                .map(|builds| geometric(builds.into_iter())),
            bytes,
            bytes_per_vertex: geometric(rows.iter().map(|r| r.bytes_per_vertex)),
            sampled: rows.iter().any(|r| r.sampled),
            estimated,
            samples: rows.iter().map(|r| r.samples).min().unwrap_or(0),
            parts: parts_on_all(rows),
            ..rows[0].clone()
        }
    });
    rows.collect()
}

/// Returns the mean cost of each part of the mix over all meshes. Every row has the same parts.
fn parts_on_all(rows: &[&Ranked]) -> Vec<PartCost> {
    let parts = rows[0].parts.iter().enumerate().map(|(i, part)| {
        let on_each = || rows.iter().filter_map(|row| row.parts.get(i));
        let times: Option<Vec<f64>> = on_each().map(|part| part.ns).collect();
        PartCost {
            share: mean(on_each().map(|part| part.share)).unwrap_or(part.share),
            ns: times.map(|times| geometric(times.into_iter())),
            launch_ns: Vec::new(),
            estimated: on_each().any(|part| part.estimated),
            operation: part.operation.clone(),
        }
    });
    parts.collect()
}

/// Returns whether a time has too few samples for a narrow interval, or too few launches for any.
fn is_preliminary(ranked: &Ranked) -> bool {
    match ranked.launch_ns.is_empty() {
        true => ranked.samples < MIN_SAMPLES,
        false => !ranked.has_enough_samples(),
    }
}

/// Returns the break-even of `ranked` over all meshes. The number of operations is `None` if
/// building never pays off on some mesh.
fn break_even_on_all(outcomes: &[MeshOutcome], ranked: &Ranked) -> Option<BreakEven> {
    let rows: Option<Vec<&BreakEven>> = outcomes
        .iter()
        .map(|o| {
            o.break_even
                .iter()
                .find(|row| row.backend == ranked.backend)
        })
        .collect();
    let rows = rows?;
    let all = |of: fn(&BreakEven) -> Option<f64>| {
        let values: Option<Vec<f64>> = rows.iter().map(|row| of(row)).collect();
        values.map(|values| geometric(values.into_iter()))
    };
    Some(BreakEven {
        backend: ranked.backend.clone(),
        build_ns: ranked.first_build_ns(),
        saves_ns_per_operation: mean(rows.iter().map(|r| r.saves_ns_per_operation))?,
        operations: all(|row| row.operations),
        ci_low: all(|row| row.ci_low),
        ci_high: all(|row| row.ci_high),
        uses: all(|row| row.uses),
    })
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

fn geometric(values: impl Iterator<Item = f64>) -> f64 {
    mean(values.map(f64::ln)).map_or(f64::NAN, f64::exp)
}
