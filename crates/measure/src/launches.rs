//! Launches: fresh processes that measure the same.

use sixfold_results::{Finding, MergeError, Results, Run, Timer};

use crate::pick::pool_picks;

/// The environment variable that tells a process of the command `sixfold` that it is a launch. External programs,
/// which may be such commands themselves, do not get it.
pub const LAUNCH_VARIABLE: &str = "SIXFOLD_LAUNCH";

/// Returns the run of several launches.
pub fn pool_runs<'r>(runs: impl IntoIterator<Item = &'r Run>) -> Run {
    let mut runs = runs.into_iter();
    let mut pooled = runs.next().cloned().unwrap_or_default();
    runs.for_each(|run| pooled.add_launches(run));
    pooled
}

/// Returns the clock with the largest error.
pub fn pool_timers(timers: impl Iterator<Item = Timer>) -> Option<Timer> {
    let share = |timer: &Timer| timer.largest_share.unwrap_or(0.0);
    timers.max_by(|a, b| share(a).total_cmp(&share(b)))
}

/// Pools documents of programs, one for each launch, as one document.
///
/// # Errors
///
/// Returns an error if a document does not repeat the others, see [`Results::check_repeats`].
pub fn pool_programs(launches: Vec<Results>) -> Result<Results, MergeError> {
    pool(launches, |group| {
        let picks = group
            .into_iter()
            .filter_map(|finding| finding.try_into().ok());
        let picks: Vec<_> = picks.collect();
        (!picks.is_empty()).then(|| pool_picks(picks).into())
    })
}

/// Pools documents of the same work, one for each launch, as one document. `pool_group` pools findings that repeat each
/// other.
///
/// # Errors
///
/// Returns an error if a document does not repeat the others, see [`Results::check_repeats`].
pub fn pool(
    launches: Vec<Results>,
    pool_group: fn(Vec<Finding>) -> Option<Finding>,
) -> Result<Results, MergeError> {
    for (i, launch) in launches.iter().enumerate() {
        launches[..i]
            .iter()
            .try_for_each(|earlier| earlier.check_repeats(launch))?;
    }
    let mut pooled = Results::default();
    let mut groups: Vec<Vec<Finding>> = Vec::new();
    let mut failures = Vec::new();
    for launch in launches {
        pooled.plan(launch.planned);
        pooled.add_notices(launch.notices);
        failures.extend(launch.failures);
        for finding in launch.findings {
            match groups.iter_mut().find(|group| group[0].repeats(&finding)) {
                Some(group) => group.push(finding),
                None => groups.push(vec![finding]),
            }
        }
    }
    pooled.extend(groups.into_iter().filter_map(pool_group));
    pooled.add_failures(failures);
    Ok(pooled)
}
