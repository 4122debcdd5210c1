//! Times of several backends, corrected for the drift of the machine.
//!
//! The speed of the machine changes from round to round, and not every backend takes part in every
//! round. So the median of the samples of one backend depends on the rounds in which it took part,
//! and the quotient of two medians is not the median of the quotients. Here all times of a task come
//! from one model:
//!
//! ```text
//! ln time = round + backend + residual
//! ```
//!
//! Median polish (Tukey 1977) fits the effects of the rounds and of the backends: it subtracts the
//! median of the residuals of each round, then of each backend, until they are 0. Medians ignore
//! single disturbed samples. The time of a backend is the exponential of its effect and of the
//! median effect of the rounds. So the ratio of two backends is the quotient of their times.

use crate::statistics::median;
use crate::time::Time;

/// Maximum number of passes over the rounds and the backends.
const MAX_PASSES: usize = 50;
/// Effects that change by less than this, relative to the time, do not change the result.
const NEGLIGIBLE: f64 = 1e-12;

/// Returns the time of each backend in nanoseconds, corrected for the effects of the rounds; `None`
/// for a backend without samples. Each sample has the number of its round.
///
/// If a sample is not positive, its logarithm does not exist, and the result has the medians of the
/// samples. O(passes · samples · log samples).
pub fn corrected_times(backends: &[Vec<(u32, Time)>]) -> Vec<Option<f64>> {
    let all = || backends.iter().flatten();
    if all().any(|(_, time)| time.ns() <= 0.0 || !time.ns().is_finite()) {
        let times = |samples: &Vec<(u32, Time)>| samples.iter().map(|(_, t)| t.ns()).collect();
        return backends.iter().map(|b| median(times(b))).collect();
    }
    let mut rounds: Vec<u32> = all().map(|&(round, _)| round).collect();
    rounds.sort_unstable();
    rounds.dedup();
    let row = |round: u32| rounds.partition_point(|&known| known < round);
    let logs: Vec<Vec<(usize, f64)>> = backends
        .iter()
        .map(|samples| {
            samples
                .iter()
                .map(|(r, time)| (row(*r), time.ns().ln()))
                .collect()
        })
        .collect();
    let mut of_round = vec![0.0; rounds.len()];
    let mut of_backend: Vec<Option<f64>> = vec![None; backends.len()];
    for _ in 0..MAX_PASSES {
        let mut moved = 0.0_f64;
        for (effect, samples) in of_backend.iter_mut().zip(&logs) {
            let residuals = samples
                .iter()
                .map(|&(row, log)| log - of_round[row])
                .collect();
            let fitted = median(residuals);
            moved = moved.max((fitted.unwrap_or(0.0) - effect.unwrap_or(0.0)).abs());
            *effect = fitted;
        }
        let mut residuals: Vec<Vec<f64>> = vec![Vec::new(); rounds.len()];
        for (effect, samples) in of_backend.iter().zip(&logs) {
            for &(row, log) in samples {
                residuals[row].extend(effect.map(|effect| log - effect));
            }
        }
        for (effect, residuals) in of_round.iter_mut().zip(residuals) {
            *effect = median(residuals).unwrap_or(0.0);
        }
        if moved < NEGLIGIBLE {
            break;
        }
    }
    let typical = median(of_round).unwrap_or(0.0);
    of_backend
        .into_iter()
        .map(|effect| Some((effect? + typical).exp()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn backend(times: &[(u32, f64)]) -> Vec<(u32, Time)> {
        let times = times.iter();
        times
            .map(|&(round, ns)| (round, Time::from_wall_ns(ns)))
            .collect()
    }

    #[test]
    fn times_are_those_of_a_round_of_median_speed() {
        // The second backend takes twice the time of the first, and missed the slow rounds.
        let first = backend(&[(0, 10.0), (1, 10.0), (2, 30.0), (3, 30.0), (4, 30.0)]);
        let second = backend(&[(0, 20.0), (1, 20.0)]);
        let times = corrected_times(&[first, second, Vec::new()]);
        let [Some(a), Some(b), None] = times[..] else {
            panic!("{times:?}")
        };
        assert!(
            (a - 30.0).abs() < 1e-9 && (b - 60.0).abs() < 1e-9,
            "{times:?}"
        );
    }

    #[test]
    fn without_logarithms_times_are_medians() {
        let coarse = backend(&[(0, 0.0), (1, 4.0), (2, 6.0)]);
        let other = backend(&[(0, 1.0), (1, 9.0)]);
        assert_eq!(corrected_times(&[coarse, other]), [Some(4.0), Some(5.0)]);
    }
}
