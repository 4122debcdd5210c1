//! Ranks backends by their times.

use crate::rows::Standing;
use crate::statistics::Median;
use crate::time::Time;

/// Maximum ratio that always counts as a tie.
pub const NO_DIFFERENCE: f64 = 1.02;

/// Minimum ratio of a clear difference if there are too few samples.
pub const CLEAR_DIFFERENCE: f64 = 2.0;
/// Minimum number of samples of a backend that can be fastest, or tied with the fastest.
pub const FEWEST_OF_A_WINNER: usize = 4;

/// The time of one backend, and its comparison with the fastest backend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rank {
    /// The time, corrected for the drift of the machine.
    pub time: Median,
    /// The time divided by the time of the fastest backend.
    pub ratio: Median,
    /// `None` if there are too few samples.
    pub standing: Option<Standing>,
}

/// Ranks the backends of one operation. `samples` are the samples of each backend with the numbers
/// of their rounds, and `times` the [corrected times](crate::corrected_times). A backend without
/// a time has the rank `None`.
///
/// The fastest backend has the smallest corrected time. Its ratio is 1. Another backend is tied with
/// the fastest if the ratio is at most `noise`, or if the 95 % interval of the ratio includes 1.
///
/// If one of the two has fewer than [`FEWEST_OF_A_WINNER`] samples, the other backend is slower if
/// its ratio is at least [`CLEAR_DIFFERENCE`]; otherwise its standing is unknown, and the fastest
/// backend is not known to be the best.
pub fn rank(samples: &[Vec<(u32, Time)>], times: &[Option<f64>], noise: f64) -> Vec<Option<Rank>> {
    let measured = || (0..times.len()).filter_map(|b| Some((b, times[b]?)));
    let Some((best, best_ns)) = measured().min_by(|(_, a), (_, b)| a.total_cmp(b)) else {
        return vec![None; times.len()];
    };
    let enough = |samples: &[(u32, Time)]| samples.len() >= FEWEST_OF_A_WINNER;
    let mut ranks: Vec<Option<Rank>> = samples
        .iter()
        .zip(times)
        .map(|(own, &ns)| {
            let ratio = quotient([own, &samples[best]], [ns?, best_ns])?;
            let includes_1 = ratio.interval.is_some_and(|[low, _]| low <= 1.0);
            let standing = match enough(own) && enough(&samples[best]) {
                true if ratio.value <= noise || includes_1 => Some(Standing::Tied),
                true => Some(Standing::Slower),
                false if ratio.value >= CLEAR_DIFFERENCE => Some(Standing::Slower),
                false => None,
            };
            Some(Rank {
                time: time(own, ns?)?,
                ratio,
                standing,
            })
        })
        .collect();
    let others = || {
        (0..ranks.len())
            .filter(|&b| b != best)
            .filter_map(|b| ranks[b])
    };
    let has = |standing| others().any(|rank| rank.standing == standing);
    let standing = match () {
        () if others().next().is_none() => Some(Standing::Alone),
        () if has(Some(Standing::Tied)) => Some(Standing::Tied),
        () if has(None) || !enough(&samples[best]) => None,
        () => Some(Standing::Best),
    };
    if let Some(rank) = &mut ranks[best] {
        rank.standing = standing;
    }
    ranks
}

/// Returns the corrected time `ns` with the interval of its samples.
pub fn time(samples: &[(u32, Time)], ns: f64) -> Option<Median> {
    let raw = Median::from_samples(samples.iter().map(|(_, time)| time.ns()))?;
    Some(raw.moved_to(ns))
}

/// Returns the quotient of two corrected times, with the interval of the ratios within rounds.
pub fn quotient([a, b]: [&[(u32, Time)]; 2], [ns, other_ns]: [f64; 2]) -> Option<Median> {
    let within_rounds = ratio(a, b)?;
    let quotient = ns / other_ns;
    // The quotient does not exist if the clock is too coarse.
    let value = if quotient.is_finite() { quotient } else { 1.0 };
    Some(within_rounds.moved_to(value))
}

/// Returns the median ratio over the rounds that have samples of both. If there are no such rounds,
/// returns the ratio of the medians. The ratio of a series to itself is exactly 1.
pub fn ratio(samples: &[(u32, Time)], best: &[(u32, Time)]) -> Option<Median> {
    if samples == best && !samples.is_empty() {
        return Some(Median {
            value: 1.0,
            least: 1.0,
            interval: Some([1.0; 2]),
        });
    }
    let of_round = |round: u32| best.iter().find(|(r, _)| *r == round);
    let pairs = samples
        .iter()
        .filter_map(|(round, time)| Some(time.ns() / of_round(*round)?.1.ns()));
    Median::from_ratios(pairs.filter(|ratio| ratio.is_finite())).or_else(|| {
        let median =
            |times: &[(u32, Time)]| Median::from_samples(times.iter().map(|(_, t)| t.ns()));
        let value = median(samples)?.value / median(best)?.value;
        value.is_finite().then_some(Median {
            value,
            least: value,
            interval: None,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corrected::corrected_times;

    fn samples(times: &[f64]) -> Vec<(u32, Time)> {
        let time = |&ns: &f64| Time {
            cpu_ns: Some(ns),
            wall_ns: ns,
            faults: None,
        };
        (0..).zip(times.iter().map(time)).collect()
    }

    fn ranked(backends: &[Vec<(u32, Time)>], noise: f64) -> Vec<Option<Rank>> {
        rank(backends, &corrected_times(backends), noise)
    }

    fn standings(backends: &[Vec<(u32, Time)>]) -> Vec<Option<Standing>> {
        let ranks = ranked(backends, NO_DIFFERENCE).into_iter();
        ranks.map(|rank| rank.and_then(|p| p.standing)).collect()
    }

    #[test]
    fn a_clear_difference_has_a_best_backend() {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let fast = samples(&drift);
        let slow = samples(&drift.map(|t| t * 1.1));
        let expected = [Some(Standing::Slower), Some(Standing::Best), None];
        assert_eq!(standings(&[slow.clone(), fast.clone(), vec![]]), expected);
        let ratio = ranked(&[fast, slow], NO_DIFFERENCE)[1];
        let ratio = ratio.expect("measured").ratio;
        let [low, high] = ratio.interval.expect("seven rounds");
        assert!((ratio.value - 1.1).abs() < 1e-9 && low > 1.065 && high < 1.135);
    }

    #[test]
    fn a_difference_within_the_drift_from_study_to_study_is_a_tie() {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let both = [samples(&drift), samples(&drift.map(|t| t * 1.025))];
        assert_eq!(standings(&both), [Some(Standing::Tied); 2]);
    }

    #[test]
    fn noise_and_small_differences_are_ties() {
        let a = samples(&[1.0, 1.2, 0.9, 1.1, 1.3, 0.8, 1.0]);
        let b = samples(&[1.1, 1.0, 1.1, 0.9, 1.4, 1.2, 0.9]);
        let c = samples(&[1.01, 1.212, 0.909, 1.111, 1.313, 0.808, 1.01]);
        assert_eq!(standings(&[a, b, c]), [Some(Standing::Tied); 3]);
    }

    #[test]
    fn ratios_up_to_the_noise_are_ties() {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let both = [samples(&drift), samples(&drift.map(|t| t * 1.1))];
        let tied = |noise| ranked(&both, noise)[1].and_then(|rank| rank.standing);
        assert_eq!(tied(1.05), Some(Standing::Slower));
        assert_eq!(tied(1.11), Some(Standing::Tied));
    }

    #[test]
    fn no_ratio_is_less_than_one() {
        // `b` is 5 % faster in each round that both have, but missed the fast rounds.
        let a = samples(&[1.0, 1.0, 1.0, 1.0, 3.0, 3.0, 3.0]);
        let b: Vec<(u32, Time)> = samples(&[0.95, 0.95, 0.95, 0.95, 2.85, 2.85, 2.85]).split_off(3);
        let ranks = ranked(&[a, b], NO_DIFFERENCE);
        let value = |i: usize| {
            ranks[i]
                .map(|rank: Rank| rank.ratio.value)
                .expect("measured")
        };
        assert!((value(0) - 1.0 / 0.95).abs() < 1e-9, "{}", value(0));
        assert_eq!(value(1), 1.0);
        // Each of three is faster than the next in two of three rounds.
        let circle = [[1.0, 2.0, 3.0], [2.0, 3.0, 1.0], [3.0, 1.0, 2.0]];
        for rank in ranked(&circle.map(|times| samples(&times)), NO_DIFFERENCE) {
            assert!(rank.expect("measured").ratio.value >= 1.0);
        }
    }

    #[test]
    fn quotients_of_times_are_the_ratios_and_drift_does_not_change_them() {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1, 1.0, 4.0];
        let factors = [3.0, 1.0, 2.0, 1.25];
        // The backends take part in every round, or in every second or third round.
        let every = [2, 1, 3, 1];
        let backends: Vec<Vec<(u32, Time)>> = (factors.iter().zip(every))
            .map(|(factor, every)| {
                let times = samples(&drift.map(|slowdown| factor * slowdown));
                times.into_iter().step_by(every).collect()
            })
            .collect();
        for (rank, factor) in ranked(&backends, NO_DIFFERENCE).into_iter().zip(factors) {
            let rank = rank.expect("measured");
            assert!((rank.ratio.value / factor - 1.0).abs() < 1e-9, "{rank:?}");
            // The median slowdown is 2.
            assert!(
                (rank.time.value / (2.0 * factor) - 1.0).abs() < 1e-9,
                "{rank:?}"
            );
            let [low, high] = rank.ratio.interval.expect("three rounds or more");
            assert!(low <= rank.ratio.value && rank.ratio.value <= high);
        }
    }

    #[test]
    fn fewer_than_four_samples_have_no_winner() {
        let [one, more, clear] = [1.0, 1.5, 2.0].map(|ns| samples(&[ns; 3]));
        let slower = Some(Standing::Slower);
        assert_eq!(standings(&[one.clone(), more.clone()]), [None; 2]);
        assert_eq!(standings(&[one.clone(), clear.clone()]), [None, slower]);
        let enough = |ns: f64| samples(&[ns; 4]);
        assert_eq!(standings(&[enough(1.0), more.clone()]), [None; 2]);
        let found = standings(&[enough(1.0), clear, enough(1.5)]);
        assert_eq!(found, [Some(Standing::Best), slower, slower]);
        let found = standings(&[enough(1.0), more, enough(1.0)]);
        assert_eq!(found, [Some(Standing::Tied), None, Some(Standing::Tied)]);
        assert_eq!(standings(&[one]), [Some(Standing::Alone)]);
        assert_eq!(standings(&[vec![], vec![]]), [None, None]);
    }
}
