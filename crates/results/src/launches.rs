//! Times of several launches: fresh processes that measure the same.
//!
//! What differs from process to process (addresses, memory pages, the neighbours of the hour) is the same
//! for all samples of one process, so the samples of one process cannot show it. The times of a study are
//! therefore compared at the level that varies (Kalibera and Jones 2013, 2020): a launch gives one value for
//! each backend, the [corrected median](crate::corrected_times) of its samples, and the interval comes from
//! the values of the launches. The ratio of two backends is formed within each launch.
//!
//! All computations use the logarithms of the times, and Student's distribution. Two launches have a wide
//! interval: that is what two launches can tell.

mod rows;

use std::f64::consts::SQRT_2;

pub use rows::{LaunchRows, PooledRows, pool_rows};

use crate::statistics::{Median, NORMAL, UNSEEN_DRIFT, student};

/// Minimum number of launches for an interval.
pub const FEWEST_LAUNCHES: usize = 2;
/// Maximum number of passes of the fit.
const MAX_PASSES: usize = 100;
/// Effects that change by less than this, relative to the time, do not change the result.
const NEGLIGIBLE: f64 = 1e-12;

/// Returns the time of each backend over all launches, from its time in each launch; `None` for a backend
/// without a time. `launches` has a list for each backend, with a value for each launch.
///
/// The time is the geometric mean over the launches. If a backend has no time in some launches, the effects
/// of the launches and of the backends are fitted by least squares, so that the ratio of two backends is the
/// quotient of their times, and no backend gains by its absence from a slow launch.
///
/// If a time is not positive, its logarithm does not exist, and the result has arithmetic means.
pub fn times_over_launches(launches: &[&[Option<f64>]]) -> Vec<Option<f64>> {
    let known = |times: &[Option<f64>]| times.iter().copied().flatten().collect::<Vec<f64>>();
    if launches
        .iter()
        .flat_map(|times| known(times))
        .any(|ns| ns <= 0.0)
    {
        return launches.iter().map(|times| mean(known(times))).collect();
    }
    let logs: Vec<Vec<Option<f64>>> = launches
        .iter()
        .map(|times| times.iter().map(|ns| ns.map(f64::ln)).collect())
        .collect();
    let count = logs.iter().map(Vec::len).max().unwrap_or(0);
    let mut of_launch: Vec<f64> = vec![0.0; count];
    let mut of_backend: Vec<Option<f64>> = vec![None; logs.len()];
    for _ in 0..MAX_PASSES {
        let mut moved = 0.0_f64;
        for (effect, logs) in of_backend.iter_mut().zip(&logs) {
            let residuals = logs.iter().zip(&of_launch);
            let fitted = mean(residuals.filter_map(|(log, launch)| Some((*log)? - launch)));
            moved = moved.max((fitted.unwrap_or(0.0) - effect.unwrap_or(0.0)).abs());
            *effect = fitted;
        }
        if moved < NEGLIGIBLE {
            break;
        }
        for (launch, effect) in of_launch.iter_mut().enumerate() {
            let residuals = of_backend.iter().zip(&logs);
            let residuals = residuals.filter_map(|(backend, logs)| {
                let log = logs.get(launch).copied().flatten()?;
                Some(log - (*backend)?)
            });
            *effect = mean(residuals).unwrap_or(0.0);
        }
    }
    let typical = mean(of_launch).unwrap_or(0.0);
    of_backend
        .into_iter()
        .map(|effect| Some((effect? + typical).exp()))
        .collect()
}

/// Returns the time `ns` of a backend over all launches with its interval, from its time in each launch.
/// The interval includes the [drift](UNSEEN_DRIFT) that lasts longer than the study. `None` without launches.
pub fn time_over_launches(ns: f64, launches: &[Option<f64>]) -> Option<Median> {
    let logs: Vec<f64> = launches.iter().flatten().map(|ns| ns.ln()).collect();
    let least = launches.iter().copied().flatten().min_by(f64::total_cmp)?;
    let half_width = half_width(&logs).map(|half| half.hypot(NORMAL * UNSEEN_DRIFT));
    Some(around(ns, least, half_width))
}

/// Returns the ratio of two times over all launches with its interval, from the times in each launch. The
/// interval has no drift, because the drift of the machine changes both times. `None` if the ratio is not
/// finite, or if the backends have no launch in common.
pub fn ratio_over_launches(
    [ns, other_ns]: [f64; 2],
    [launches, others]: [&[Option<f64>]; 2],
) -> Option<Median> {
    let pairs = launches.iter().zip(others);
    let logs: Vec<f64> = pairs
        .filter_map(|(a, b)| Some(((*a)? / (*b)?).ln()))
        .collect();
    let least = logs.iter().copied().min_by(f64::total_cmp)?.exp();
    let ratio = ns / other_ns;
    ratio
        .is_finite()
        .then(|| around(ratio, least.min(ratio), half_width(&logs)))
}

/// Returns the ratio of the times of one backend in two studies with its interval. The launches of two
/// studies are not paired, and each study has its own variance (Welch 1947) and its own drift. `None` if the
/// ratio is not finite.
pub fn ratio_of_studies(
    [ns, other_ns]: [f64; 2],
    [launches, others]: [&[Option<f64>]; 2],
) -> Option<Median> {
    let ratio = ns / other_ns;
    let logs = |times: &[Option<f64>]| times.iter().flatten().map(|ns| ns.ln()).collect();
    let [a, b]: [Vec<f64>; 2] = [logs(launches), logs(others)];
    let errors = squared_error(&a).zip(squared_error(&b));
    let half_width = errors.and_then(|(own, other)| {
        let sum = own + other;
        let part = |error: f64, logs: &[f64]| error * error / (logs.len() as f64 - 1.0);
        let freedom = match sum > 0.0 {
            true => sum * sum / (part(own, &a) + part(other, &b)),
            false => (a.len() + b.len() - 2) as f64,
        };
        let half_width = (student(freedom) * sum.sqrt()).hypot(NORMAL * SQRT_2 * UNSEEN_DRIFT);
        half_width.is_finite().then_some(half_width)
    });
    ratio.is_finite().then(|| around(ratio, ratio, half_width))
}

/// Returns half the width of the 95 % interval of the mean of `logs`. `None` with fewer than two values, or
/// if a value is not finite.
fn half_width(logs: &[f64]) -> Option<f64> {
    let half_width = student(logs.len() as f64 - 1.0) * squared_error(logs)?.sqrt();
    half_width.is_finite().then_some(half_width)
}

/// Returns the square of the standard error of the mean of `logs`; `None` with fewer than two values.
fn squared_error(logs: &[f64]) -> Option<f64> {
    let count = logs.len() as f64;
    if logs.len() < FEWEST_LAUNCHES {
        return None;
    }
    let mean = logs.iter().sum::<f64>() / count;
    let squares: f64 = logs.iter().map(|log| (log - mean).powi(2)).sum();
    Some(squares / (count - 1.0) / count)
}

/// Returns `value` with the interval of `half_width` on the scale of logarithms.
fn around(value: f64, least: f64, half_width: Option<f64>) -> Median {
    Median {
        value,
        least,
        interval: half_width.map(|half| [value * (-half).exp(), value * half.exp()]),
    }
}

fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value;
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}

#[cfg(test)]
mod tests;
