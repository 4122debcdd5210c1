//! Ranks backends by their times.

use crate::engine::statistics::Median;
use crate::results::rows::Standing;
use sixfold_workload::Time;

/// Maximum ratio that always counts as a tie.
pub(crate) const NO_DIFFERENCE: f64 = 1.02;

/// Minimum ratio of a clear difference if there are too few samples for an interval.
pub(crate) const CLEAR_DIFFERENCE: f64 = 2.0;

/// The comparison of one backend with the fastest backend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rank {
    /// The median ratio to the fastest backend, over the rounds.
    pub(crate) ratio: Median,
    pub(crate) standing: Standing,
}

/// Ranks the backends of one operation by their samples. Each sample has the number of its round. A
/// backend without samples has the rank `None`.
///
/// The fastest backend has the smallest median, unless another backend is faster in most of the
/// rounds. Its ratio is 1, and no ratio is smaller. Another backend is tied with the fastest in
/// three cases:
///
/// - The 95 % interval of the ratio includes 1.
/// - The ratio is at most `noise`.
/// - There are fewer than three samples, so there is no interval, and the ratio is below 2.
pub(crate) fn rank(backends: &[Vec<(u32, Time)>], noise: f64) -> Vec<Option<Rank>> {
    let measured = backends
        .iter()
        .filter(|samples| !samples.is_empty())
        .count();
    let Some(best) = fastest(backends) else {
        return vec![None; backends.len()];
    };
    let mut ranks: Vec<Option<Rank>> = backends
        .iter()
        .map(|samples| {
            let mut ratio = ratio(samples, &backends[best])?;
            ratio.value = ratio.value.max(1.0);
            let tied = match ratio.interval {
                _ if ratio.value <= noise => true,
                Some([low, _]) => low <= 1.0,
                None => ratio.value < CLEAR_DIFFERENCE,
            };
            let standing = if tied {
                Standing::Tied
            } else {
                Standing::Slower
            };
            Some(Rank { ratio, standing })
        })
        .collect();
    let ties = ranks
        .iter()
        .flatten()
        .filter(|p| p.standing == Standing::Tied)
        .count();
    if let Some(rank) = &mut ranks[best] {
        rank.standing = match (measured, ties) {
            (1, _) => Standing::Alone,
            (_, 1) => Standing::Best,
            _ => Standing::Tied,
        };
    }
    ranks
}

/// Returns the index of the fastest backend; `None` if none has samples.
///
/// The search begins with the backend with the smallest median. It goes on to a backend that is
/// faster in most of the rounds that have samples of both. The speed of the machine may change
/// between rounds. This affects the medians over all rounds, but hardly the ratios within rounds.
fn fastest(backends: &[Vec<(u32, Time)>]) -> Option<usize> {
    let median = |samples: &[(u32, Time)]| {
        let median = Median::from_samples(samples.iter().map(|(_, time)| time.ns()));
        median.map_or(f64::INFINITY, |median| median.value)
    };
    let sampled = || (0..backends.len()).filter(|&b| !backends[b].is_empty());
    let mut best =
        sampled().min_by(|&a, &b| median(&backends[a]).total_cmp(&median(&backends[b])))?;
    // The number of steps is limited, because "faster in most rounds" can go round in a circle.
    for _ in 0..backends.len() {
        let faster = sampled().filter_map(|b| {
            let ratio = ratio(&backends[b], &backends[best])?.value;
            (ratio < 1.0).then_some((b, ratio))
        });
        match faster.min_by(|(_, a), (_, b)| a.total_cmp(b)) {
            Some((b, _)) => best = b,
            None => break,
        }
    }
    Some(best)
}

/// Returns the median ratio over the rounds that have samples of both. If there are no such rounds,
/// returns the ratio of the medians. The ratio of a series to itself is exactly 1.
pub(crate) fn ratio(samples: &[(u32, Time)], best: &[(u32, Time)]) -> Option<Median> {
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

    fn samples(times: &[f64]) -> Vec<(u32, Time)> {
        let time = |&ns: &f64| Time {
            cpu_ns: Some(ns),
            wall_ns: ns,
            faults: None,
        };
        (0..).zip(times.iter().map(time)).collect()
    }

    fn standings(backends: &[Vec<(u32, Time)>]) -> Vec<Option<Standing>> {
        let ranks = rank(backends, NO_DIFFERENCE).into_iter();
        ranks.map(|rank| rank.map(|p| p.standing)).collect()
    }

    #[test]
    fn a_clear_difference_has_a_best_backend() {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let fast = samples(&drift);
        let slow = samples(&drift.map(|t| t * 1.1));
        let expected = [Some(Standing::Slower), Some(Standing::Best), None];
        assert_eq!(standings(&[slow.clone(), fast.clone(), vec![]]), expected);
        let ratio = rank(&[fast, slow], NO_DIFFERENCE)[1];
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
        let tied = |noise| rank(&both, noise)[1].map(|rank| rank.standing);
        assert_eq!(tied(1.05), Some(Standing::Slower));
        assert_eq!(tied(1.11), Some(Standing::Tied));
    }

    #[test]
    fn no_ratio_is_less_than_one() {
        // `b` is 5 % faster in each round that both have, but missed the fast rounds.
        let a = samples(&[1.0, 1.0, 1.0, 1.0, 3.0, 3.0, 3.0]);
        let b: Vec<(u32, Time)> = samples(&[0.95, 0.95, 0.95, 0.95, 2.85, 2.85, 2.85]).split_off(3);
        let ranks = rank(&[a, b], NO_DIFFERENCE);
        let value = |i: usize| {
            ranks[i]
                .map(|rank: Rank| rank.ratio.value)
                .expect("measured")
        };
        assert!((value(0) - 1.0 / 0.95).abs() < 1e-9, "{}", value(0));
        assert_eq!(value(1), 1.0);
        // Each of three is faster than the next in two of three rounds.
        let circle = [[1.0, 2.0, 3.0], [2.0, 3.0, 1.0], [3.0, 1.0, 2.0]];
        for rank in rank(&circle.map(|times| samples(&times)), NO_DIFFERENCE) {
            assert!(rank.expect("measured").ratio.value >= 1.0);
        }
    }

    #[test]
    fn too_few_samples_are_ties_below_a_ratio_of_two() {
        let ties = standings(&[samples(&[1.0, 1.0]), samples(&[1.5, 1.5])]);
        assert_eq!(ties, [Some(Standing::Tied); 2]);
        let clear = standings(&[samples(&[1.0, 1.0]), samples(&[9.0, 9.0])]);
        assert_eq!(clear, [Some(Standing::Best), Some(Standing::Slower)]);
        assert_eq!(standings(&[samples(&[1.0])]), [Some(Standing::Alone)]);
        assert_eq!(standings(&[vec![], vec![]]), [None, None]);
    }
}
