//! Medians and means with confidence intervals.
//!
//! # The interval of a median
//!
//! Samples of one study are not independent: the machine has phases in which everything, or only
//! work of one kind, takes a few percent longer. A phase lasts from seconds to minutes. A bootstrap
//! of the samples ignores these phases. The 95 % intervals of a bootstrap contained the median of
//! ten equal studies in only 76 % of the cases. The interval here has two parts.
//!
//! 1. **What the study sees.** The samples, in the order of time, are divided into six
//!    consecutive batches. The medians of the batches vary with the phases. The standard deviation
//!    of the medians and Student's distribution give the first half-width: nonoverlapping batch
//!    means (Schmeiser 1982), here with medians. Few long batches are better than many short ones
//!    if the samples are correlated.
//! 2. **What no study sees.** A phase that is longer than the study shifts all samples of the
//!    study. Only repeated studies show this variance (Kalibera and Jones 2013, Georges et al.
//!    2007). [`UNSEEN_DRIFT`], the standard deviation between studies, gives the second half-width.
//!
//! With several launches, [`launches`](crate::launches) sees more than the samples of one process do.
//!
//! The two parts are independent, so the half-width is the root of the sum of their squares. Both
//! parts are relative: the computation uses the logarithms of the times.

use std::f64::consts::SQRT_2;

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::confidence::Confidence;

/// Number of batches. With fewer samples, each sample is a batch.
const BATCHES: usize = 6;
/// Minimum number of samples for an interval that is not wide because of their number.
pub const MIN_SAMPLES: usize = BATCHES;
/// Minimum number of samples for any interval.
const FEWEST_SAMPLES: usize = 3;
/// Standard deviation of the drift from study to study that the samples of one study do not show,
/// relative to the time. Every confidence interval includes this drift.
///
/// Measured in ten studies of 45 s on a virtual machine: with a drift of 1 %, the intervals of
/// times contained the median of all studies in 91 % of the cases, and the intervals of ratios in
/// 92 %.
pub const UNSEEN_DRIFT: f64 = 0.01;
/// Samples farther from the median count as if they were at this distance. The unit is the standard
/// deviation of a normal distribution with the same median deviation.
const FARTHEST: f64 = 5.0;

/// Maximum slowdown of an undisturbed machine, as a ratio of times. A lower value would also detect
/// changes of the processor frequency. These last longer than a round and affect all backends
/// equally.
pub const DISTURBED: f64 = 1.3;
/// Minimum part of undisturbed samples. If there are fewer, or fewer than [`MIN_SAMPLES`], all
/// samples count. In the first case, the machine is usually in the state that the detector calls
/// disturbed. Leaving out most samples would make the medians less certain without making them more
/// alike.
const MIN_UNDISTURBED: f64 = 0.5;

/// The median of samples and its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Median {
    /// The median.
    pub value: f64,
    /// The smallest sample.
    pub least: f64,
    /// The error of the logarithm of the median; `None` with fewer than three samples.
    pub(crate) error: Option<MeanError>,
    /// The standard deviation of the unseen drift.
    pub(crate) drift: f64,
}

/// The variance of values, or the error of their mean or median.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeanError {
    /// The square of the standard deviation or error.
    pub(crate) squared: f64,
    /// The degrees of freedom of the estimate.
    pub(crate) freedom: f64,
}

impl MeanError {
    /// Returns half the width of the interval of the mean.
    pub(crate) fn half_width(self, confidence: Confidence) -> f64 {
        confidence.student(self.freedom) * self.squared.sqrt()
    }

    /// Returns half the width of the interval of the mean if the unseen drift has the standard deviation `drift`.
    fn half_width_with(self, drift: f64, confidence: Confidence) -> f64 {
        self.half_width(confidence)
            .hypot(confidence.normal() * drift)
    }
}

impl Median {
    /// Returns the median of `samples`, the times of one backend in the order of measurement;
    /// `None` if `samples` is empty. The interval exists only with three samples or more, and if all are positive.
    pub fn from_samples(samples: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::with_drift(samples, UNSEEN_DRIFT)
    }

    /// Returns the median of `ratios` of two backends. Each of the backends has its own drift.
    pub fn from_ratios(ratios: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::with_drift(ratios, SQRT_2 * UNSEEN_DRIFT)
    }

    /// Returns a value whose interval has no width.
    pub(crate) const fn exactly(value: f64) -> Self {
        let error = MeanError {
            squared: 0.0,
            freedom: 1.0,
        };
        Self {
            error: Some(error),
            ..Self::without_interval(value)
        }
    }

    /// Returns a value whose error is not known.
    pub(crate) const fn without_interval(value: f64) -> Self {
        Self {
            value,
            least: value,
            error: None,
            drift: 0.0,
        }
    }

    /// Returns the confidence interval of the median; `None` if there are too few samples.
    pub fn interval(&self, confidence: Confidence) -> Option<[f64; 2]> {
        let half = self.error?.half_width_with(self.drift, confidence);
        Some([-half, half].map(|log| self.value * log.exp()))
    }

    /// Returns whether there are enough samples for an interval.
    pub(crate) fn has_interval(&self) -> bool {
        self.error.is_some()
    }

    /// Returns this median with `value`, and with an interval of the same relative width. The least value is
    /// not above it, also if both differ only by rounding.
    pub fn moved_to(self, value: f64) -> Self {
        Self {
            value,
            least: self.least.min(value),
            error: self.error.filter(|_| (value / self.value).is_finite()),
            ..self
        }
    }

    fn with_drift(samples: impl IntoIterator<Item = f64>, drift: f64) -> Option<Self> {
        let samples: Vec<f64> = samples.into_iter().collect();
        let sorted = sorted(samples.iter().copied())?;
        let logs: Vec<f64> = samples.iter().map(|sample| sample.ln()).collect();
        Some(Self {
            value: median_of_sorted(&sorted),
            least: sorted[0],
            error: error_of_batches(&logs),
            drift,
        })
    }
}

/// Returns the median of the differences in `pairs` of times, the first minus the second time, and its interval. Each
/// of the times has its own drift. Returns `None` if the list is empty. The interval needs three pairs.
pub fn difference(pairs: &[[f64; 2]], confidence: Confidence) -> Option<(f64, Option<[f64; 2]>)> {
    let time = |i: usize| median(pairs.iter().map(|pair| pair[i]).collect());
    let drift = UNSEEN_DRIFT * time(0)?.hypot(time(1)?);
    let differences: Vec<f64> = pairs.iter().map(|[a, b]| a - b).collect();
    let error = error_of_batches(&differences);
    let value = median(differences)?;
    let interval = error.map(|error| {
        let half = error.half_width_with(drift, confidence);
        [value - half, value + half]
    });
    Some((value, interval))
}

/// Returns the error of the median of `samples`, which are in the order of measurement, without the unseen drift.
/// Returns `None` with fewer than three samples, or if a sample is not finite. O(n log n).
fn error_of_batches(samples: &[f64]) -> Option<MeanError> {
    let batches = samples.len().min(BATCHES);
    if batches < FEWEST_SAMPLES {
        return None;
    }
    let samples = match samples.len() > BATCHES {
        true => without_outliers(samples)?,
        false => samples.to_vec(), // too few to distinguish outliers from the usual variation
    };
    let bounds = |i: usize| i * samples.len() / batches;
    let medians = (0..batches).map(|i| sorted(samples[bounds(i)..bounds(i + 1)].iter().copied()));
    let medians: Vec<f64> = medians
        .map(|batch| Some(median_of_sorted(&batch?)))
        .collect::<Option<_>>()?;
    let count = batches as f64;
    let mean = medians.iter().sum::<f64>() / count;
    let squares: f64 = medians.iter().map(|median| (median - mean).powi(2)).sum();
    let squared = squares / (count - 1.0) / count;
    squared.is_finite().then_some(MeanError {
        squared,
        freedom: count - 1.0,
    })
}

/// Moves samples that are far from the median nearer to it. The distance of a few very slow samples
/// does not affect the median. It would affect the medians of small batches (Tukey and McLaughlin
/// 1963). Returns `None` without samples or if a sample is not finite.
fn without_outliers(samples: &[f64]) -> Option<Vec<f64>> {
    if !samples.iter().all(|sample| sample.is_finite()) {
        return None;
    }
    let (middle, deviation) = median_and_deviation(samples)?;
    let farthest = match deviation > 0.0 {
        true => FARTHEST * deviation,
        false => f64::INFINITY, // most samples are equal, so the distance has no scale
    };
    let nearer = |sample: &f64| sample.clamp(middle - farthest, middle + farthest);
    Some(samples.iter().map(nearer).collect())
}

/// Returns the median of `values`, and their standard deviation as estimated from the median of the distances
/// to the median (Hampel 1974): outliers hardly change both. `None` without values.
pub fn median_and_deviation(values: &[f64]) -> Option<(f64, f64)> {
    /// The standard deviation of a normal distribution divided by its median deviation.
    const STANDARD_TO_MEDIAN: f64 = 1.4826;
    let middle = median_of_sorted(&sorted(values.iter().copied())?);
    let distances = values.iter().map(|value| (value - middle).abs());
    let typical = median_of_sorted(&sorted(distances)?);
    Some((middle, STANDARD_TO_MEDIAN * typical))
}

/// Returns the median of `samples`; `None` without samples.
pub fn median(samples: Vec<f64>) -> Option<f64> {
    Some(median_of_sorted(&sorted(samples.into_iter())?))
}

/// Returns the samples in ascending order. Returns `None` if there are no samples.
fn sorted(samples: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
    let mut sorted: Vec<f64> = samples.collect();
    sorted.sort_unstable_by(f64::total_cmp);
    (!sorted.is_empty()).then_some(sorted)
}

/// Returns the median of sorted samples. At least one sample is required.
fn median_of_sorted(sorted: &[f64]) -> f64 {
    let count = sorted.len();
    f64::midpoint(sorted[(count - 1) / 2], sorted[count / 2])
}

/// Returns the geometric mean and its interval. Returns `None` without values. The interval
/// needs at least three values. The half-width is that of the mean of the logarithms, from Student's
/// distribution: resampling three values gives intervals that contain the mean in only 76 % of the
/// cases.
pub fn geometric_mean(values: &[f64], confidence: Confidence) -> Option<(f64, Option<[f64; 2]>)> {
    let logs: Vec<f64> = values.iter().map(|value| value.ln()).collect();
    let count = logs.len();
    let mean = logs.iter().sum::<f64>() / count as f64;
    if !mean.is_finite() {
        return None;
    }
    let squares: f64 = logs.iter().map(|log| (log - mean).powi(2)).sum();
    let interval = (count >= FEWEST_SAMPLES).then(|| {
        let freedom = count as f64 - 1.0;
        let squared = squares / freedom / count as f64;
        let half_width = MeanError { squared, freedom }.half_width(confidence);
        [mean - half_width, mean + half_width]
    });
    Some((mean.exp(), interval.map(|ends| ends.map(f64::exp))))
}

/// Returns a quantile, from 0 to 1, of Student's distribution with `freedom` degrees of freedom; infinity for 0
/// degrees.
pub(crate) fn student_at(quantile: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom)
        .map_or(f64::INFINITY, |students| students.inverse_cdf(quantile))
}

/// Returns the ratio of the medians of two series without common rounds, and its interval: the
/// half-widths of the two medians are added as independent parts. Returns `None` if a list is
/// empty. The interval needs three samples in each list.
pub fn quotient(
    samples: &[f64],
    others: &[f64],
    confidence: Confidence,
) -> Option<(f64, Option<[f64; 2]>)> {
    let [a, b] = [samples, others].map(|list| Median::from_samples(list.iter().copied()));
    let (a, b) = (a?, b?);
    let ratio = a.value / b.value;
    if !ratio.is_finite() {
        return None;
    }
    let half_width = |median: Median| {
        let interval = median.interval(confidence);
        interval.map(|[low, high]| (high / low).ln() / 2.0)
    };
    let half_widths = half_width(a).zip(half_width(b));
    let interval = half_widths.map(|(a, b)| {
        let half_width = a.hypot(b);
        [-half_width, half_width].map(|log| ratio * log.exp())
    });
    Some((ratio, interval))
}

/// Returns the samples that count. These are the undisturbed samples if they are at least half of
/// all samples and enough for a narrow interval, else all samples.
pub fn undisturbed<T: Copy>(samples: &[T], slowdowns: &[f64]) -> Vec<T> {
    let quiet = samples.iter().zip(slowdowns);
    let quiet = quiet.filter(|(_, slowdown)| **slowdown <= DISTURBED);
    let quiet: Vec<T> = quiet.map(|(sample, _)| *sample).collect();
    let needed = (MIN_UNDISTURBED * samples.len() as f64).max(MIN_SAMPLES as f64);
    match quiet.len() as f64 >= needed {
        true => quiet,
        false => samples.to_vec(),
    }
}

#[cfg(test)]
mod tests;
