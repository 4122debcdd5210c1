//! Pools the picks of several launches.

use sixfold_results::launches::{LaunchRows, PooledRows, pool_rows};
use sixfold_results::statistics::median;
use sixfold_results::{
    Control, ControlRow, Excluded, OnMesh, PartCost, PickReport, Ranked, ResultRow, Standing,
};

use crate::launches::{pool_runs, pool_timers};
use crate::pick::break_even::break_even_over_launches;
use crate::pick::measurement::MeshOutcome;
use crate::pick::pooled::{Question, pooled};

/// Pools picks for the same workload or program on the same meshes, one from each launch. A launch gives one
/// value for each time, see [`pool_rows`](sixfold_results::launches::pool_rows()); the ranking, the choice and the
/// sentences come from the pooled times.
///
/// A mesh that some launches did not reach has the values of the others. A backend is excluded if no launch has a
/// time of it, or if the program failed on it in some launch.
pub fn pool_picks(mut launches: Vec<PickReport>) -> PickReport {
    if launches.len() == 1 {
        return launches.remove(0);
    }
    let most = launches.iter().max_by_key(|launch| launch.meshes.len());
    let meshes = most.map_or(&[][..], |launch| &launch.meshes);
    let excluded = excluded(&launches);
    let outcomes = meshes.iter().map(|mesh| {
        let on_mesh = launches.iter().filter_map(|launch| {
            let mut on_meshes = launch.on_meshes().into_iter();
            Some((launch, on_meshes.find(|on| on.mesh.name == mesh.name)?))
        });
        pool_mesh(&on_mesh.collect::<Vec<_>>(), &excluded)
    });
    let outcomes: Vec<MeshOutcome> = outcomes.flatten().collect();
    let first = &launches[0];
    let run = pool_runs(launches.iter().map(|launch| &launch.run));
    let timer = pool_timers(launches.iter().map(|launch| launch.timer));
    let question = Question {
        workload: first.workload.clone(),
        program: first.program.clone(),
        needs: first.needs.clone(),
        max_memory: first.max_memory,
        excluded,
    };
    let interrupted = launches.iter().any(|launch| launch.interrupted);
    let timer = timer.unwrap_or(first.timer);
    pooled(outcomes, question, timer, run, interrupted)
}

/// Returns the excluded backends of all launches: failures first, and the others only if no launch ranks them.
fn excluded(launches: &[PickReport]) -> Vec<Excluded> {
    let mut excluded: Vec<Excluded> = Vec::new();
    let failed = launches.iter().flat_map(PickReport::failed);
    let ranked = || launches.iter().flat_map(|launch| &launch.ranking);
    let others = launches.iter().flat_map(|launch| &launch.excluded);
    let others = others.filter(|new| ranked().all(|ranked| ranked.backend != new.backend));
    for new in failed.chain(others) {
        if excluded.iter().all(|known| known.backend != new.backend) {
            excluded.push(new.clone());
        }
    }
    excluded
}

/// Pools the results on one mesh, each with the pick that it is from, without `excluded` backends. `None` without a
/// result.
fn pool_mesh(launches: &[(&PickReport, OnMesh<'_>)], excluded: &[Excluded]) -> Option<MeshOutcome> {
    let (first, on_first) = launches.first()?;
    let takes_part = |ranked: &&Ranked| excluded.iter().all(|e| e.backend != ranked.backend);
    let rows: Vec<Vec<ResultRow>> = launches
        .iter()
        .map(|(report, on_mesh)| {
            let of_each = on_mesh.ranking.iter().filter(takes_part);
            of_each.flat_map(|ranked| report.rows_of(ranked)).collect()
        })
        .collect();
    let controls = launches
        .iter()
        .map(|(report, on_mesh)| control(report, on_mesh));
    let controls: Vec<Option<Control>> = controls.collect();
    let parts = rows.iter().zip(launches).zip(&controls);
    let of_launches = parts.map(|((results, (_, on_mesh)), control)| LaunchRows {
        results,
        refusals: &[],
        samples: on_mesh.samples,
        control: control.as_ref(),
    });
    let of_launches: Vec<LaunchRows<'_>> = of_launches.collect();
    let confidence = first.run.settings.confidence;
    let pooled = pool_rows(&of_launches, confidence, |row| row.operation.clone());
    let mut ranking: Vec<Ranked> = Vec::new();
    let all = launches.iter().flat_map(|(_, on_mesh)| on_mesh.ranking);
    for ranked in all.filter(takes_part) {
        if ranking.iter().all(|known| known.backend != ranked.backend) {
            let of_each = launches.iter().map(|(_, on_mesh)| on_mesh.ranking);
            let of_each = of_each
                .flatten()
                .filter(|other| other.backend == ranked.backend);
            let of_each: Vec<&Ranked> = of_each.collect();
            ranking.extend(pool_ranked(&of_each, &pooled, first.whole()));
        }
    }
    let best = ranking.iter().filter(|ranked| !ranked.estimated);
    let best = best
        .map(|ranked| ranked.ns_per_operation)
        .min_by(f64::total_cmp);
    for bound in ranking.iter_mut().filter(|ranked| ranked.estimated) {
        bound.ratio_to_best = best.map_or(1.0, |best| bound.ns_per_operation / best);
    }
    ranking.sort_by(Ranked::measured_first);
    let mismatches = launches.iter().flat_map(|(report, _)| &report.mismatches);
    let shortest = launches
        .iter()
        .filter_map(|(report, _)| report.timer.shortest_ns);
    let control = pooled
        .control
        .and_then(|mut control| control.operations.pop());
    Some(MeshOutcome {
        mesh: on_first.mesh.clone(),
        break_even: break_even_over_launches(&ranking, on_first.operations, confidence),
        ranking,
        excluded: Vec::new(),
        control_ratios: control.map_or(Vec::new(), |control| control.launches),
        disagreeing: mismatches.cloned().collect(),
        operations: on_first.operations,
        shortest_ns: shortest.min_by(f64::total_cmp),
        samples: pooled.samples,
    })
}

/// Returns the control of a pick on one mesh as that of a study.
fn control(report: &PickReport, on_mesh: &OnMesh<'_>) -> Option<Control> {
    let ratio = on_mesh.control_ratios.iter().flatten().next()?;
    let row = ControlRow {
        operation: report.whole().to_owned(),
        ratio: *ratio,
        ci_low: None,
        ci_high: None,
        launches: match on_mesh.control_ratios.len() {
            1 => Vec::new(),
            _ => on_mesh.control_ratios.to_vec(),
        },
    };
    Control::new("", vec![row])
}

/// Returns one backend of the ranking. `of_each` has it in each launch that ranks it, and `pooled` its times.
fn pool_ranked(of_each: &[&Ranked], pooled: &PooledRows, whole: &str) -> Option<Ranked> {
    let measured = of_each.iter().find(|ranked| !ranked.estimated);
    let first = measured.or(of_each.first())?;
    let row = |operation: &str| {
        let mut rows = pooled.results.iter();
        rows.find(|row| row.backend == first.backend && row.operation == operation)
    };
    let mix = row(whole)?;
    let build = row("build")?;
    let parts = first.parts.iter().map(|part| {
        let Some(row) = part.ns.and_then(|_| row(&part.operation)) else {
            return part.clone();
        };
        PartCost {
            ns: row.median_ns.or(row.estimated_ns),
            launch_ns: row.launch_ns.clone(),
            estimated: row.median_ns.is_none(),
            ..part.clone()
        }
    });
    let first_builds = of_each.iter().filter_map(|ranked| ranked.first_build_ns);
    let first_builds: Vec<f64> = first_builds.collect();
    Some(Ranked {
        ns_per_operation: mix.median_ns.or(mix.estimated_ns)?,
        launch_ns: mix.launch_ns.clone(),
        ns_ci_low: mix.ci_low_ns,
        ns_ci_high: mix.ci_high_ns,
        ratio_to_best: mix.ratio_to_best.unwrap_or(1.0),
        ci_low: mix.ratio_ci_low,
        ci_high: mix.ratio_ci_high,
        tied_with_best: mix.median_ns.is_some() && mix.standing != Some(Standing::Slower),
        build_ns: build.median_ns?,
        build_launch_ns: build.launch_ns.clone(),
        first_build_ns: median(first_builds),
        sampled: of_each.iter().any(|ranked| ranked.sampled),
        estimated: mix.median_ns.is_none(),
        parts: parts.collect(),
        samples: mix.samples,
        warm_up_only: mix.warm_up_only,
        faults: mix.faults,
        ..(*first).clone()
    })
}
