//! Pools the documents of several launches: fresh processes that measured the same.

use sixfold_measure::Operation;
use sixfold_results::launches::{LaunchRows, pool_rows};
use sixfold_results::{BackendReport, Finding, MergeError, Report, ResultRow, Results};
use sixfold_workload::Backend;

use crate::labs::growth::pool_growth;
use crate::labs::neighbours::pool_neighbours;
use crate::labs::orders::pool_orders;
use crate::labs::study::conclude;
use crate::labs::why::pool_why;
use sixfold_measure::launches::{pool_runs, pool_timers};
use sixfold_measure::pick::pool_picks;

/// Pools documents of the same work, one for each launch, as one document. Documents that were pooled before
/// add all of their launches.
///
/// Studies of the same mesh become one study, and picks for the same workload or program one pick; the same holds for
/// the other labs that measure times, see [`pool_rows`](sixfold_results::launches::pool_rows()). A mesh that failed in
/// some launches has a study of the others.
///
/// # Errors
///
/// Returns an error if a document does not repeat the others, see [`Results::check_repeats`].
pub fn pool_launches(launches: Vec<Results>) -> Result<Results, MergeError> {
    sixfold_measure::launches::pool(launches, pool_group)
}

/// Pools findings that repeat each other.
fn pool_group(group: Vec<Finding>) -> Option<Finding> {
    match group.first()? {
        Finding::Study(_) => Some(pool_studies(all(group)).into()),
        Finding::Pick(_) => Some(pool_picks(all(group)).into()),
        Finding::Orders(_) => Some(pool_orders(all(group)).into()),
        Finding::Growth(_) => Some(pool_growth(all(group)).into()),
        Finding::Neighbours(_) => Some(pool_neighbours(all(group)).into()),
        Finding::Why(_) => Some(pool_why(all(group)).into()),
        _ => group.into_iter().next(),
    }
}

/// Returns the findings of one kind.
fn all<T: TryFrom<Finding>>(findings: Vec<Finding>) -> Vec<T> {
    let found = findings.into_iter().map(T::try_from);
    found.filter_map(Result::ok).collect()
}

/// Pools the studies of one mesh.
fn pool_studies(mut launches: Vec<Report>) -> Report {
    if launches.len() == 1 {
        return launches.remove(0);
    }
    let rows: Vec<LaunchRows<'_>> = launches.iter().map(Report::launch_rows).collect();
    let confidence = launches[0].run.settings.confidence;
    let mut pooled = pool_rows(&rows, confidence, |row| row.operation.clone());
    let backends = pool_backends(&launches);
    pooled.results.sort_by_key(|row| place(row, &backends));
    let first = &launches[0];
    let mut report = Report {
        run: pool_runs(launches.iter().map(|launch| &launch.run)),
        mesh: first.mesh.clone(),
        backends,
        results: pooled.results,
        refusals: pooled.refusals,
        samples: pooled.samples,
        control: pooled.control,
        interrupted: launches.iter().any(|launch| launch.interrupted),
        timer: pool_timers(launches.iter().filter_map(|launch| launch.timer)),
        ..Report::default()
    };
    conclude(&mut report, &Backend::structures());
    report
}

/// Returns the place of a row in tables.
fn place(row: &ResultRow, backends: &[BackendReport]) -> (Option<usize>, Option<usize>) {
    let operation = Operation::ALL
        .iter()
        .position(|o| o.name() == row.operation);
    let backend = backends
        .iter()
        .position(|backend| backend.name == row.backend);
    (operation, backend)
}

/// Returns the backends of the first launch in which each was built. An external program has failed if it failed in
/// any launch.
fn pool_backends(launches: &[Report]) -> Vec<BackendReport> {
    let mut pooled = launches[0].backends.clone();
    for backend in &mut pooled {
        let mut others = launches
            .iter()
            .filter_map(|launch| launch.backend(&backend.name));
        if let (None, Some(built)) = (backend.bytes, others.find(|other| other.bytes.is_some())) {
            *backend = built.clone();
        }
        let failed = launches.iter().find_map(|launch| {
            let program = launch.backend(&backend.name)?.external.as_ref()?;
            program.failed.clone()
        });
        if let Some(program) = &mut backend.external {
            program.failed = failed;
        }
    }
    pooled
}
