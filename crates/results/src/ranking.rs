//! Ranks backends by their times.

use crate::confidence::Confidence;
use crate::launches::{FEWEST_LAUNCHES, ratio_over_launches, time_over_launches};
use crate::rows::Standing;
use crate::statistics::Median;
use crate::time::Time;

/// Maximum ratio that is never a difference.
pub const NO_DIFFERENCE: f64 = 1.02;

/// Two backends are equally fast if the whole interval of their ratio lies within this ratio and its reciprocal.
pub const EQUAL: f64 = 1.05;

/// Minimum ratio of a clear difference if there are too few samples.
pub const CLEAR_DIFFERENCE: f64 = 2.0;
/// Minimum number of samples of a backend that can be fastest, or tied with the fastest.
pub const FEWEST_OF_A_WINNER: usize = 4;

/// Returns whether a time can be ranked: it is from several launches, or from enough samples of the only launch.
/// `launches` has the time in each launch if there are several.
pub fn has_enough(samples: usize, launches: &[Option<f64>]) -> bool {
    match launches {
        [] => samples >= FEWEST_OF_A_WINNER,
        launches => launches.iter().flatten().count() >= FEWEST_LAUNCHES,
    }
}

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

/// Ranks the backends of one operation in one launch. `samples` are the samples of each backend with the
/// numbers of their rounds, and `times` the [corrected times](crate::corrected_times). A backend without
/// a time has the rank `None`.
///
/// The fastest backend has the smallest corrected time. Its ratio is 1. For the others, see
/// [`Standing`], which follows from the interval at `confidence`: a ratio up to `noise` is not decided.
///
/// If one of the two has fewer than [`FEWEST_OF_A_WINNER`] samples, the other backend is slower if
/// its ratio is at least [`CLEAR_DIFFERENCE`]; otherwise its standing is unknown, and the fastest
/// backend is not known to be the best.
pub fn rank(
    samples: &[Vec<(u32, Time)>],
    times: &[Option<f64>],
    noise: f64,
    confidence: Confidence,
) -> Vec<Option<Rank>> {
    let enough = |b: usize| samples[b].len() >= FEWEST_OF_A_WINNER;
    let rank = |b: usize, best: usize| {
        let (ns, best_ns) = (times[b]?, times[best]?);
        let ratio = quotient([&samples[b], &samples[best]], [ns, best_ns])?;
        Some((time(&samples[b], ns)?, ratio, enough(b) && enough(best)))
    };
    ranks(times, noise, confidence, rank)
}

/// Ranks the backends of one operation over several launches, as [`rank`] does in one launch. `launches` are
/// the times of each backend in each launch, and `times` those [over all launches](crate::launches::times_over_launches).
///
/// Two backends with fewer than two launches in common have too few samples.
pub fn rank_launches(
    launches: &[&[Option<f64>]],
    times: &[Option<f64>],
    noise: f64,
    confidence: Confidence,
) -> Vec<Option<Rank>> {
    let rank = |b: usize, best: usize| {
        let (ns, best_ns) = (times[b]?, times[best]?);
        let time = time_over_launches(ns, launches[b])?;
        if b == best {
            return Some((time, Median::exactly(1.0), time.has_interval()));
        }
        let ratio = ratio_over_launches([ns, best_ns], [launches[b], launches[best]]);
        let ratio = ratio.unwrap_or(Median::without_interval(ns / best_ns));
        Some((time, ratio, ratio.has_interval()))
    };
    ranks(times, noise, confidence, rank)
}

/// Ranks backends. `rank` returns the time of a backend, its ratio to the best, and whether both have
/// enough samples.
fn ranks(
    times: &[Option<f64>],
    noise: f64,
    confidence: Confidence,
    rank: impl Fn(usize, usize) -> Option<(Median, Median, bool)>,
) -> Vec<Option<Rank>> {
    let measured = (0..times.len()).filter_map(|b| Some((b, times[b]?)));
    let Some((best, _)) = measured.min_by(|(_, a), (_, b)| a.total_cmp(b)) else {
        return vec![None; times.len()];
    };
    let mut best_has_enough = false;
    let mut ranks: Vec<Option<Rank>> = (0..times.len())
        .map(|b| {
            let (time, ratio, enough) = rank(b, best)?;
            if b == best {
                best_has_enough = enough;
            }
            Some(Rank {
                time,
                ratio,
                standing: standing(ratio, enough, noise, confidence),
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
        () if has(Some(Standing::Undecided)) => Some(Standing::Undecided),
        () if has(None) && has(Some(Standing::Equal)) => Some(Standing::Undecided),
        () if has(None) || !best_has_enough => None,
        () if has(Some(Standing::Equal)) => Some(Standing::Equal),
        () => Some(Standing::Best),
    };
    if let Some(rank) = &mut ranks[best] {
        rank.standing = standing;
    }
    ranks
}

/// Returns the standing of a backend whose time, divided by that of the fastest, is `ratio`.
fn standing(ratio: Median, enough: bool, noise: f64, confidence: Confidence) -> Option<Standing> {
    if !enough {
        return (ratio.value >= CLEAR_DIFFERENCE).then_some(Standing::Slower);
    }
    let interval = ratio.interval(confidence);
    let [low, high] = interval.unwrap_or([0.0, f64::INFINITY]);
    Some(match () {
        () if noise <= EQUAL && EQUAL.recip() <= low && high <= EQUAL => Standing::Equal,
        () if low <= 1.0 || ratio.value <= noise => Standing::Undecided,
        () => Standing::Slower,
    })
}

/// Returns the corrected time `ns` with the error of its samples.
pub fn time(samples: &[(u32, Time)], ns: f64) -> Option<Median> {
    let raw = Median::from_samples(samples.iter().map(|(_, time)| time.ns()))?;
    Some(raw.moved_to(ns))
}

/// Returns the quotient of two corrected times, with the error of the ratios within rounds.
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
        return Some(Median::exactly(1.0));
    }
    let of_round = |round: u32| best.iter().find(|(r, _)| *r == round);
    let pairs = samples
        .iter()
        .filter_map(|(round, time)| Some(time.ns() / of_round(*round)?.1.ns()));
    Median::from_ratios(pairs.filter(|ratio| ratio.is_finite())).or_else(|| {
        let median =
            |times: &[(u32, Time)]| Median::from_samples(times.iter().map(|(_, t)| t.ns()));
        let value = median(samples)?.value / median(best)?.value;
        value.is_finite().then_some(Median::without_interval(value))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corrected::corrected_times;
    use crate::launches::times_over_launches;

    fn samples(times: &[f64]) -> Vec<(u32, Time)> {
        let time = |&ns: &f64| Time {
            cpu_ns: Some(ns),
            wall_ns: ns,
            faults: None,
        };
        (0..).zip(times.iter().map(time)).collect()
    }

    fn ranked(backends: &[Vec<(u32, Time)>], noise: f64) -> Vec<Option<Rank>> {
        rank(
            backends,
            &corrected_times(backends),
            noise,
            Confidence::default(),
        )
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
        let [low, high] = ratio.interval(Confidence::default()).expect("seven rounds");
        assert!((ratio.value - 1.1).abs() < 1e-9 && low > 1.065 && high < 1.135);
    }

    #[test]
    fn a_difference_within_the_drift_from_study_to_study_is_undecided() {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        // The drift of two times is 2.8 %, so the interval reaches from 0.997 to 1.054.
        let both = [samples(&drift), samples(&drift.map(|t| t * 1.025))];
        assert_eq!(standings(&both), [Some(Standing::Undecided); 2]);
        let both = [samples(&drift), samples(&drift.map(|t| t * 1.02))];
        assert_eq!(standings(&both), [Some(Standing::Equal); 2]);
    }

    #[test]
    fn intervals_that_contain_1_are_undecided_unless_they_are_narrow() {
        let a = samples(&[1.0, 1.2, 0.9, 1.1, 1.3, 0.8, 1.0]);
        let b = samples(&[1.1, 1.0, 1.1, 0.9, 1.4, 1.2, 0.9]);
        let c = samples(&[1.01, 1.212, 0.909, 1.111, 1.313, 0.808, 1.01]);
        // `c` is 1 % slower in every round.
        let expected = [Standing::Undecided, Standing::Undecided, Standing::Equal];
        assert_eq!(standings(&[a, b, c]), expected.map(Some));
    }

    #[test]
    fn ratios_up_to_the_noise_are_undecided() {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let both = [samples(&drift), samples(&drift.map(|t| t * 1.1))];
        let second = |noise| ranked(&both, noise)[1].and_then(|rank| rank.standing);
        assert_eq!(second(1.05), Some(Standing::Slower));
        assert_eq!(second(1.11), Some(Standing::Undecided));
        // Two times within 5 % are not equal if two measurements of one backend differ by more.
        let both = [samples(&drift), samples(&drift.map(|t| t * 1.01))];
        let second = |noise| ranked(&both, noise)[1].and_then(|rank| rank.standing);
        assert_eq!(second(1.05), Some(Standing::Equal));
        assert_eq!(second(1.06), Some(Standing::Undecided));
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
            let [low, high] = rank
                .ratio
                .interval(Confidence::default())
                .expect("three rounds or more");
            assert!(low <= rank.ratio.value && rank.ratio.value <= high);
        }
    }

    #[test]
    fn a_higher_confidence_leaves_more_undecided() {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let both = [samples(&drift), samples(&drift.map(|t| t * 1.04))];
        let standing = |confidence: &str| {
            let confidence = confidence.parse().expect("allowed");
            let ranks = rank(&both, &corrected_times(&both), NO_DIFFERENCE, confidence);
            ranks[1].and_then(|rank| rank.standing)
        };
        let expected = [Standing::Slower, Standing::Undecided].map(Some);
        assert_eq!(["95%", "99.9%"].map(standing), expected);
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
        let expected = [Some(Standing::Undecided), None, Some(Standing::Equal)];
        assert_eq!(found, expected);
        assert_eq!(standings(&[one]), [Some(Standing::Alone)]);
        assert_eq!(standings(&[vec![], vec![]]), [None, None]);
    }

    fn ranked_launches(launches: &[&[f64]]) -> Vec<Option<Standing>> {
        let launches: Vec<Vec<Option<f64>>> = launches
            .iter()
            .map(|times| times.iter().copied().map(Some).collect())
            .collect();
        let launches: Vec<&[Option<f64>]> = launches.iter().map(Vec::as_slice).collect();
        let times = times_over_launches(&launches);
        let ranks =
            rank_launches(&launches, &times, NO_DIFFERENCE, Confidence::default()).into_iter();
        ranks
            .map(|rank| rank.and_then(|rank| rank.standing))
            .collect()
    }

    #[test]
    fn launches_are_compared_in_pairs() {
        let [best, equal, slower] = [Standing::Best, Standing::Equal, Standing::Slower].map(Some);
        let undecided = Some(Standing::Undecided);
        // Every launch has its own speed.
        let fast: &[f64] = &[1.0, 3.0, 2.0];
        assert_eq!(ranked_launches(&[&[1.1, 3.3, 2.2], fast]), [slower, best]);
        assert_eq!(ranked_launches(&[&[1.03, 3.1, 2.07], fast]), [equal; 2]);
        assert_eq!(ranked_launches(&[&[1.0, 3.9, 2.0], fast]), [undecided; 2]);
        // Two launches have a wide interval.
        assert_eq!(ranked_launches(&[&[1.2, 3.4], &[1.0, 3.0]]), [undecided; 2]);
        assert_eq!(ranked_launches(&[&[1.2, 3.6], &[1.0, 3.0]]), [slower, best]);
        assert_eq!(ranked_launches(&[&[1.2], &[1.0]]), [None; 2]);
        assert_eq!(ranked_launches(&[&[2.0], &[1.0]]), [slower, None]);
        assert_eq!(ranked_launches(&[&[2.0, 1.0]]), [Some(Standing::Alone)]);
    }
}
