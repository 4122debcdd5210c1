//! Times of several launches: fresh processes that measure the same.
//!
//! What differs from process to process (addresses, memory pages, the neighbours of the hour) is the same
//! for all samples of one process, so the samples of one process cannot show it. The times of a study are
//! therefore compared at the level that varies (Kalibera and Jones 2013, 2020): a launch gives one value for
//! each backend, the [corrected median](crate::corrected_times) of its samples, and the interval comes from
//! the values of the launches. The ratio of two backends is formed within each launch.
//!
//! Two levels of variation are seen: from round to round within a launch, and from launch to launch. Launches that
//! follow each other are alike, so the variance of a mean of n launches is more than s²/n, where s is the standard
//! deviation from launch to launch: it is [`ALIKE`] s²/n. A machine also has slow and fast hours, which no study
//! sees. They change times more than ratios: the squared error of a time has [`LASTING_IN_TIMES`] s² in addition, that
//! of a ratio [`LASTING_IN_RATIOS`] s².
//!
//! A launch may be disturbed as a whole. So ratios are [trimmed](TRIMMED) means over the launches, and their
//! intervals are those of trimmed means (Tukey and McLaughlin 1963).
//!
//! All computations use the logarithms of the times, and Student's distribution. Two launches have a wide
//! interval: that is what two launches can tell.

mod between;
mod rows;

pub use between::{LASTING_SPEED, LaunchPair, StudyChange, StudyChanges, study_changes};
pub use rows::{LaunchRows, PooledRows, pool_rows};

use crate::confidence::Confidence;
use crate::statistics::{MeanError, Median, median};

/// Minimum number of launches for an interval.
pub const FEWEST_LAUNCHES: usize = 2;
/// The part of the launches at each end that a trimmed mean leaves out. With fewer than five launches, it leaves
/// out none.
pub const TRIMMED: f64 = 0.2;
/// The variance of a mean of n launches, divided by s²/n for the standard deviation s from launch to launch.
///
/// Found in fifty studies of a minute on virtual machines with busy neighbours, of 15 and 60 launches: 1.3 to 1.7.
/// `benches/checks/repeat.py` measures how many intervals contain what other studies find.
pub const ALIKE: f64 = 1.5;
/// The variance of a ratio from study to study that no study sees, divided by the variance from launch to launch.
///
/// Twenty studies of sixty launches, in which the machine became 1.4 times faster, had 0.2 to 0.26 for four of ten ratios and
/// at most 1/8 for the others; all other studies hardly had more than 0. It matters for many launches only.
pub const LASTING_IN_RATIOS: f64 = 1.0 / 20.0;
/// The variance of a time from study to study that no study sees, divided by the variance from launch to launch.
///
/// Chosen from the same studies, so that more than nine of ten intervals contain the median of the other studies. On
/// a machine that is equally busy all the time, it is too much.
pub const LASTING_IN_TIMES: f64 = 1.0 / 8.0;
/// Maximum number of passes of the fit.
const MAX_PASSES: usize = 100;
/// Effects that change by less than this, relative to the time, do not change the result.
const NEGLIGIBLE: f64 = 1e-12;

/// Returns the time of each backend over all launches, from its time in each launch; `None` for a backend
/// without a time. `launches` has a list for each backend, with a value for each launch.
///
/// The logarithm of a time is the sum of an effect of the backend and an effect of the launch. The effect of a
/// launch is the median over the backends, that of a backend is the [trimmed](TRIMMED) mean over the launches, and
/// both are fitted in turns. So the ratio of two backends is the quotient of their times, one launch in which a
/// backend was disturbed does not decide, and no backend gains by its absence from a slow launch. Times are those
/// of a launch with the mean effect; the time of a single backend is the geometric mean.
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
            let residuals = residuals.filter_map(|(log, launch)| Some((*log)? - launch));
            let residuals: Vec<f64> = residuals.collect();
            let cut = trimmed(residuals.len());
            let fitted = trimmed_mean(residuals, cut);
            moved = moved.max((fitted.unwrap_or(0.0) - effect.unwrap_or(0.0)).abs());
            *effect = fitted;
        }
        if moved < NEGLIGIBLE {
            break;
        }
        let effects = (0..count).map(|launch| {
            let residuals = of_backend.iter().zip(&logs);
            let residuals = residuals.filter_map(|(backend, logs)| {
                let log = logs.get(launch).copied().flatten()?;
                Some(log - (*backend)?)
            });
            median(residuals.collect())
        });
        let effects: Vec<Option<f64>> = effects.collect();
        // Relative to the mean of the launches that have a time. Otherwise, the effects of launches and backends move
        // against each other, without an end.
        let typical = mean(effects.iter().copied().flatten()).unwrap_or(0.0);
        let centred = effects
            .iter()
            .map(|effect| effect.unwrap_or(typical) - typical);
        of_launch = centred.collect();
    }
    of_backend
        .into_iter()
        .map(|effect| Some(effect?.exp()))
        .collect()
}

/// Returns the time `ns` of a backend over all launches with its error, from its time in each launch.
/// `None` without launches.
pub fn time_over_launches(ns: f64, launches: &[Option<f64>]) -> Option<Median> {
    let logs: Vec<f64> = launches.iter().flatten().map(|ns| ns.ln()).collect();
    let least = launches.iter().copied().flatten().min_by(f64::total_cmp)?;
    Some(Median {
        value: ns,
        least,
        error: squared_error(&logs, 0, LASTING_IN_TIMES),
        drift: 0.0,
    })
}

/// Returns the ratio of two times over all launches with its error, from the times in each launch. `None` if
/// the ratio is not finite, or if the backends have no launch in common.
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
    ratio.is_finite().then(|| Median {
        value: ratio,
        least: least.min(ratio),
        error: squared_error(&logs, trimmed(logs.len()), LASTING_IN_RATIOS),
        drift: 0.0,
    })
}

/// Returns the difference of two times over all launches with its interval, from the times in each launch.
/// `None` if the backends have no launch in common.
pub fn difference_over_launches(
    [ns, other_ns]: [f64; 2],
    [launches, others]: [&[Option<f64>]; 2],
    confidence: Confidence,
) -> Option<(f64, Option<[f64; 2]>)> {
    let pairs = launches.iter().zip(others);
    let differences: Vec<f64> = pairs.filter_map(|(a, b)| Some((*a)? - (*b)?)).collect();
    differences.first()?;
    let value = ns - other_ns;
    let error = squared_error(&differences, trimmed(differences.len()), LASTING_IN_RATIOS);
    let interval = error.map(|error| {
        let half = error.half_width(confidence);
        [value - half, value + half]
    });
    Some((value, interval))
}

impl MeanError {
    /// Returns the error of a mean of `count` values with this variance, see [`squared_error`].
    pub(crate) fn of_mean(self, count: usize, lasting: f64) -> Self {
        Self {
            squared: self.squared * (ALIKE / count as f64 + lasting),
            ..self
        }
    }
}

/// Returns the error of the mean of `values` without the `trimmed` smallest and largest ones. `lasting` is the
/// variance that the values do not show, relative to that which they show. `None` as from [`variance`].
pub(crate) fn squared_error(values: &[f64], trimmed: usize, lasting: f64) -> Option<MeanError> {
    Some(variance(values, trimmed)?.of_mean(values.len(), lasting))
}

/// Returns the variance of `values` for the mean without the `trimmed` smallest and largest ones, from the values
/// with these replaced by their neighbours (Tukey and McLaughlin 1963). `None` with fewer than [`FEWEST_LAUNCHES`]
/// values that are kept, or if a value is not finite.
pub(crate) fn variance(values: &[f64], trimmed: usize) -> Option<MeanError> {
    let count = values.len();
    let kept = count.checked_sub(2 * trimmed)?;
    if kept < FEWEST_LAUNCHES || !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (least, most) = (sorted[trimmed], sorted[count - 1 - trimmed]);
    let winsorised: Vec<f64> = sorted
        .iter()
        .map(|value| value.clamp(least, most))
        .collect();
    let mean = winsorised.iter().sum::<f64>() / count as f64;
    let squares: f64 = winsorised.iter().map(|value| (value - mean).powi(2)).sum();
    let part_kept = kept as f64 / count as f64;
    Some(MeanError {
        squared: squares / (count - 1) as f64 / part_kept.powi(2),
        freedom: (kept - 1) as f64,
    })
}

/// Returns the number of values that a trimmed mean of `count` values leaves out at each end.
pub(crate) fn trimmed(count: usize) -> usize {
    (TRIMMED * count as f64) as usize
}

/// Returns the mean without the `trimmed` smallest and largest values; `None` without values.
fn trimmed_mean(mut values: Vec<f64>, trimmed: usize) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    mean(values[trimmed..values.len() - trimmed].iter().copied())
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
