//! The change of times between two studies, from the launches of both.
//!
//! The launches of two studies are not paired. A machine may be slower in all launches of one study, for hours or
//! for a minute, so the times of two studies cannot tell whether the machine or the whole program became slower
//! ([`LASTING_SPEED`]). But what slows the machine down slows all rows down. So a row is compared with the other
//! rows: its change is relative to the median change of all, and its error comes from the launches after their
//! common speed was taken out. Few launches say little about the error of one row, so the variance of a row is
//! averaged with that of a typical row ([`TYPICAL_FREEDOM`]; the moderated t of Smyth 2004). A busy neighbour slows
//! queries of large tables down more than computation. So if the machine became slower, the changes of the rows
//! differ by more than their errors; as much as they do, and at most by half of the median change ([`UNEVEN`]), no
//! single row is found.

use std::array::from_fn;

use super::{LASTING_IN_TIMES, trimmed, trimmed_mean, variance};
use crate::confidence::Confidence;
use crate::statistics::{MeanError, median, median_and_deviation, student_at};

/// Minimum number of rows from which the common speed of a launch is estimated.
const FEWEST_ROWS: usize = 6;

/// The time of one row in two studies: before and after.
#[derive(Clone, Copy, Debug)]
pub struct LaunchPair<'r> {
    /// The time over all launches.
    pub ns: [f64; 2],
    /// The time in each launch.
    pub launches: [&'r [Option<f64>]; 2],
}

/// The factor by which the speed of a whole machine may change between two studies that show no variation.
///
/// The largest change between any two of twenty studies of a minute on a virtual machine with busy neighbours was 1.29.
pub const LASTING_SPEED: f64 = 1.3;

/// The largest part of a common change by which the change of a single row may differ from it.
const UNEVEN: f64 = 0.5;

/// The degrees of freedom that the variance of a typical row has in that of each row. With more, rows that vary more
/// than others are found too often.
const TYPICAL_FREEDOM: f64 = 3.0;

/// The changes of all rows between two studies.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyChanges {
    /// The median ratio of all rows, to which the changes of the rows are relative; `None` with fewer than six rows
    /// with launches.
    pub common: Option<f64>,
    /// The change of each row; `None` if a study has fewer than two launches of it.
    pub rows: Vec<Option<StudyChange>>,
}

/// The change of one time between two studies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StudyChange {
    /// The interval of the ratio of the two times.
    pub interval: [f64; 2],
    /// The logarithm of the ratio of the times, relative to the common ratio if there is one.
    log: f64,
    /// The error of `log`.
    error: MeanError,
    /// The logarithm of the largest factor that could be due to the machine.
    unsure: f64,
    /// The variance from row to row of what is due to the machine; infinite if it is not known.
    uneven: f64,
}

impl StudyChange {
    /// Returns the ratio of the second time to the first, relative to the common ratio, if it is farther from 1 than
    /// chance explains with the probability `level`, and than the factor `least`. `None` otherwise.
    pub fn beyond_chance(&self, level: f64, least: f64) -> Option<f64> {
        let is_found = self.log.abs() > least.ln() && self.log.abs() > self.detectable(level).ln();
        is_found.then_some(self.log.exp())
    }

    /// Returns the smallest ratio that is not due to chance or to the machine.
    pub fn detectable(&self, level: f64) -> f64 {
        let quantile = student_at(1.0 - level, self.error.freedom);
        let chance = |squared: f64| quantile * squared.sqrt();
        let with_rows = chance(self.error.squared + self.uneven);
        with_rows
            .min(chance(self.error.squared) + self.unsure)
            .exp()
    }
}

/// Returns the changes of all rows between two studies. The errors of both studies are added (Welch 1947).
/// `other_machine` tells that the machines differ, so that the common ratio makes no row less sure. `confidence` is
/// that of the intervals, and decides nothing.
///
/// O(rows · launches · log launches).
pub fn study_changes(
    rows: &[LaunchPair<'_>],
    other_machine: bool,
    confidence: Confidence,
) -> StudyChanges {
    let speeds: [Vec<f64>; 2] = from_fn(|study| speeds(rows, study));
    let means: [Vec<Option<LogMean>>; 2] = from_fn(|study| {
        let relative = rows
            .iter()
            .map(|row| LogMean::new(row, study, Some(&speeds[study])));
        moderated(relative.collect())
    });
    let pairs = means[0].iter().zip(&means[1]);
    let relative = pairs.map(|(before, after)| Some(Change::between((*before)?, (*after)?, 0.0)));
    let relative: Vec<Option<Change>> = relative.collect();
    let known: Vec<Change> = relative.iter().copied().flatten().collect();
    let logs: Vec<f64> = known.iter().map(|change| change.log).collect();
    let spread = median_and_deviation(&logs).filter(|_| known.len() >= FEWEST_ROWS);
    let common = spread.map(|(common, _)| common);
    // A machine that became slower does not slow all rows down alike.
    let uneven = match spread {
        Some(_) if other_machine => 0.0,
        Some((common, deviation)) if common.abs() <= LASTING_SPEED.ln() => {
            let errors = known.iter().map(|change| change.error.squared);
            let error = median(errors.collect()).unwrap_or_default();
            (deviation.powi(2) - error).max(0.0)
        }
        // A change as large as this is more than the state of a machine: nothing is known of what it does to a row.
        _ => f64::INFINITY,
    };
    let changes = rows.iter().zip(&relative).map(|(row, relative)| {
        let [before, after] = [0, 1].map(|study| LogMean::new(row, study, None));
        let whole = Change::between(before?, after?, LASTING_IN_TIMES);
        let log = (row.ns[1] / row.ns[0]).ln();
        let half_width = whole.error.half_width(confidence);
        let (log_of_change, error, unsure) = match (common, relative) {
            (Some(common), Some(relative)) => {
                let unsure = UNEVEN * common.abs();
                (relative.log - common, relative.error, unsure)
            }
            _ => (whole.log, whole.error, LASTING_SPEED.ln()),
        };
        (half_width.is_finite() && log.is_finite()).then(|| StudyChange {
            interval: [log - half_width, log + half_width].map(f64::exp),
            log: log_of_change,
            error,
            unsure,
            uneven,
        })
    });
    StudyChanges {
        rows: changes.collect(),
        common: common.map(f64::exp),
    }
}

/// The logarithm of the time of a row in one study.
#[derive(Clone, Copy, Debug)]
struct LogMean {
    mean: f64,
    /// The variance from launch to launch.
    variance: MeanError,
    /// The number of launches.
    count: usize,
}

impl LogMean {
    /// Returns the mean over the launches, relative to their speeds if they are given; `None` with fewer than two
    /// launches.
    fn new(row: &LaunchPair<'_>, study: usize, speeds: Option<&[f64]>) -> Option<Self> {
        let launches = row.launches[study].iter().enumerate();
        let logs = launches.filter_map(|(launch, ns)| {
            let speed = speeds.map_or(0.0, |speeds| speeds[launch]);
            Some((*ns)?.ln() - speed)
        });
        let logs: Vec<f64> = logs.collect();
        let cut = speeds.map_or(0, |_| trimmed(logs.len()));
        Some(Self {
            variance: variance(&logs, cut)?,
            count: logs.len(),
            mean: trimmed_mean(logs, cut)?,
        })
    }
}

/// Averages the variance of each row with that of a typical row, the median of all.
fn moderated(mut rows: Vec<Option<LogMean>>) -> Vec<Option<LogMean>> {
    let variances = rows.iter().flatten().map(|row| row.variance.squared);
    let typical = median(variances.collect()).unwrap_or_default();
    for MeanError { squared, freedom } in rows.iter_mut().flatten().map(|row| &mut row.variance) {
        let sum = *freedom * *squared + TYPICAL_FREEDOM * typical;
        *freedom += TYPICAL_FREEDOM;
        *squared = sum / *freedom;
    }
    rows
}

/// The change of a row on the scale of logarithms, with the errors of both studies.
#[derive(Clone, Copy, Debug)]
struct Change {
    log: f64,
    error: MeanError,
}

impl Change {
    /// Returns the change of a row. `lasting` is as in [`squared_error`](super::squared_error).
    fn between(before: LogMean, after: LogMean, lasting: f64) -> Self {
        let [error, own] = [before, after].map(|row| row.variance.of_mean(row.count, lasting));
        Self {
            log: after.mean - before.mean,
            error: sum(error, own),
        }
    }
}

/// Returns the logarithm of the common slowness of each launch of a study, relative to its rows.
fn speeds(rows: &[LaunchPair<'_>], study: usize) -> Vec<f64> {
    let count = rows.iter().map(|row| row.launches[study].len()).max();
    let logs = rows.iter().map(|row| {
        let logs = row.launches[study].iter().map(|ns| ns.map(f64::ln));
        logs.collect::<Vec<Option<f64>>>()
    });
    let logs: Vec<Vec<Option<f64>>> = logs.collect();
    let typical = logs.iter().map(|row| {
        let known: Vec<f64> = row.iter().copied().flatten().collect();
        let cut = trimmed(known.len());
        trimmed_mean(known, cut)
    });
    let typical: Vec<Option<f64>> = typical.collect();
    let speed = |launch: usize| {
        let of_rows = logs.iter().zip(&typical);
        let residuals = of_rows.filter_map(|(row, typical)| {
            let residual = row.get(launch).copied().flatten()? - (*typical)?;
            residual.is_finite().then_some(residual)
        });
        median(residuals.collect()).unwrap_or(0.0)
    };
    (0..count.unwrap_or(0)).map(speed).collect()
}

/// Returns the error of a sum of two independent parts, with the degrees of freedom of Welch and Satterthwaite.
fn sum(a: MeanError, b: MeanError) -> MeanError {
    let squared = a.squared + b.squared;
    let part = |error: MeanError| error.squared * error.squared / error.freedom;
    MeanError {
        squared,
        freedom: match squared > 0.0 {
            true => squared * squared / (part(a) + part(b)),
            false => a.freedom + b.freedom,
        },
    }
}

#[cfg(test)]
mod tests;
