//! Medians and means with confidence intervals.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Number of resamples for an interval.
const RESAMPLES: usize = 1000;

/// The median of samples and its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Median {
    pub(crate) value: f64,
    /// The smallest sample.
    pub(crate) least: f64,
    /// The 95 % confidence interval of the median; `None` with fewer than three samples.
    pub(crate) interval: Option<[f64; 2]>,
}

impl Median {
    /// Returns the median of `samples`; `None` if `samples` is empty.
    ///
    /// The interval is the percentile bootstrap of the median (Efron 1979), widened for few samples
    /// (Hesterberg 2015). It makes no assumption about the distribution of the samples. The samples
    /// are drawn [`RESAMPLES`] times with replacement, from a fixed seed. The interval contains the
    /// middle part of the resulting medians.
    ///
    /// With fewer than six samples no method can reach 95 %. The interval then reaches from the
    /// smallest to the largest sample. It contains the true median with a probability of 93.75 %
    /// for five samples, 87.5 % for four samples, and 75 % for three samples.
    pub(crate) fn from_samples(samples: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = samples.into_iter().collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let count = sorted.len();
        let least = *sorted.first()?;
        let interval = match count {
            0..3 => None,
            3..6 => Some([least, sorted[count - 1]]),
            _ => Some(bootstrap_interval(&sorted)),
        };
        Some(Self {
            value: median_of_sorted(&sorted),
            least,
            interval,
        })
    }
}

/// Returns the median of sorted samples. At least one sample is required.
fn median_of_sorted(sorted: &[f64]) -> f64 {
    let count = sorted.len();
    f64::midpoint(sorted[(count - 1) / 2], sorted[count / 2])
}

/// Returns the geometric mean and its 95 % interval. Returns `None` without values. The interval
/// needs at least three values.
pub(crate) fn geometric_mean(values: &[f64]) -> Option<(f64, Option<[f64; 2]>)> {
    let logs: Vec<f64> = values.iter().map(|value| value.ln()).collect();
    let count = logs.len();
    let mean = logs.iter().sum::<f64>() / count as f64;
    if !mean.is_finite() {
        return None;
    }
    let interval = (count >= 3).then(|| {
        let mut random = ChaCha8Rng::seed_from_u64(count as u64);
        resampled_interval(count.max(6), || {
            let sum: f64 = (0..count)
                .map(|_| logs[draw_index(&mut random, count)])
                .sum();
            sum / count as f64
        })
    });
    Some((mean.exp(), interval.map(|ends| ends.map(f64::exp))))
}

fn draw_index(random: &mut ChaCha8Rng, count: usize) -> usize {
    // The high half of the product is uniform, with a bias of at most `count` / 2³².
    ((u64::from(random.next_u32()) * count as u64) >> 32) as usize
}

/// Returns the ratio of the two medians and its 95 % interval. The interval is found by resampling
/// both lists. Returns `None` if a list is empty. The interval needs three samples in each list.
pub(crate) fn quotient(samples: &[f64], others: &[f64]) -> Option<(f64, Option<[f64; 2]>)> {
    let sorted = [samples, others].map(|samples| {
        let mut sorted = samples.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted
    });
    let fewest = samples.len().min(others.len());
    if fewest == 0 {
        return None;
    }
    let [a, b] = [0, 1].map(|i| median_of_sorted(&sorted[i]));
    if !(a / b).is_finite() {
        return None;
    }
    let interval = (fewest >= 3).then(|| {
        let [mut a, mut b] = [0, 1].map(|i| Resampling::new(&sorted[i], i as u64));
        resampled_interval(fewest.max(6), || a.median() / b.median())
    });
    Some((a / b, interval))
}

/// Returns the middle part of the resampled medians; O(resamples · samples).
fn bootstrap_interval(sorted: &[f64]) -> [f64; 2] {
    let mut resampling = Resampling::new(sorted, 0);
    resampled_interval(sorted.len(), || resampling.median())
}

/// Returns the middle part of the values that `figure` returns.
fn resampled_interval(count: usize, mut figure: impl FnMut() -> f64) -> [f64; 2] {
    let mut figures: Vec<f64> = (0..RESAMPLES).map(|_| figure()).collect();
    figures.sort_unstable_by(f64::total_cmp);
    let skipped = (tail_probability(count) * RESAMPLES as f64) as usize;
    [figures[skipped], figures[RESAMPLES - 1 - skipped]]
}

/// Draws sorted samples with replacement, from a fixed seed.
struct Resampling<'s> {
    sorted: &'s [f64],
    random: ChaCha8Rng,
    /// How often each sample was drawn. With these counts a resample need not be sorted.
    drawn: Vec<u32>,
}

impl<'s> Resampling<'s> {
    /// Different values of `stream` give independent sequences.
    fn new(sorted: &'s [f64], stream: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(sorted.len() as u64);
        random.set_stream(stream);
        Self {
            sorted,
            random,
            drawn: vec![0; sorted.len()],
        }
    }

    fn median(&mut self) -> f64 {
        let count = self.sorted.len();
        self.drawn.fill(0);
        for _ in 0..count {
            self.drawn[draw_index(&mut self.random, count)] += 1;
        }
        f64::midpoint(
            self.sorted[index_of_rank(&self.drawn, (count - 1) / 2)],
            self.sorted[index_of_rank(&self.drawn, count / 2)],
        )
    }
}

/// Returns the part of the medians that is left out at each end. It is 2.5 % for many samples, and
/// less for few samples. The value is Φ(−√(n / (n − 1)) · t). Here t is the 97.5 % quantile of
/// Student's distribution with n − 1 degrees of freedom.
fn tail_probability(count: usize) -> f64 {
    let n = count as f64;
    let freedom = n - 1.0;
    // The expansion of Cornish and Fisher about the normal quantile. Its error is below 1 % for 5
    // or more degrees of freedom.
    let z = 1.959_964_f64;
    let t = z
        + (z.powi(3) + z) / (4.0 * freedom)
        + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * freedom.powi(2))
        + (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z)
            / (384.0 * freedom.powi(3));
    let x = (n / freedom).sqrt() * t;
    // The tail of the normal distribution: Abramowitz and Stegun 26.2.17, to seven digits.
    let k = 1.0 / (1.0 + 0.231_641_9 * x);
    let series = [
        1.330_274_429,
        -1.821_255_978,
        1.781_477_937,
        -0.356_563_782,
        0.319_381_530,
    ];
    let sum = series.iter().fold(0.0, |sum, term| (sum + term) * k);
    sum * (-x * x / 2.0).exp() / std::f64::consts::TAU.sqrt()
}

/// Returns the index of the sample that has `rank` in a resample.
fn index_of_rank(drawn: &[u32], rank: usize) -> usize {
    let mut below = 0;
    let at = drawn.iter().position(|&times| {
        below += times as usize;
        below > rank
    });
    at.unwrap_or(drawn.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The exact distribution is known for an odd number of samples. The median is at most the k-th
    /// smallest sample if more than half of the n draws are among the first k samples.
    #[test]
    fn the_interval_agrees_with_the_binomial_distribution() {
        for n in [7_usize, 15, 25, 51] {
            let at_most = |k: usize| {
                let p = k as f64 / n as f64;
                let mut chances = vec![1.0_f64];
                for _ in 0..n {
                    let mut next = vec![0.0; chances.len() + 1];
                    for (hits, chance) in chances.iter().enumerate() {
                        next[hits] += chance * (1.0 - p);
                        next[hits + 1] += chance * p;
                    }
                    chances = next;
                }
                chances[n / 2 + 1..].iter().sum::<f64>()
            };
            let samples = (1..=n).map(|i| i as f64);
            let [low, high] = Median::from_samples(samples)
                .and_then(|m| m.interval)
                .expect("many");
            // The random draws may give a neighbouring rank if a rank is close to the quantile.
            let out = tail_probability(n);
            let (below, above) = (at_most(low as usize - 1), at_most(low as usize));
            assert!(
                below < 1.5 * out && above > out / 1.5,
                "{n}: {below} {above}"
            );
            let (below, above) = (at_most(high as usize - 1), at_most(high as usize));
            let (below, above) = (1.0 - below, 1.0 - above);
            assert!(
                below > out / 1.5 && above < 1.5 * out,
                "{n}: {below} {above}"
            );
        }
    }

    /// The expected values come from tables of Student's distribution and the normal distribution.
    #[test]
    fn few_samples_have_smaller_tails() {
        for (n, percent) in [
            (6, 0.243),
            (10, 0.855),
            (25, 1.758),
            (100, 2.307),
            (100_000, 2.5),
        ] {
            let out = 100.0 * tail_probability(n);
            assert!((out - percent).abs() < 0.02, "{n}: {out} %");
        }
    }

    #[test]
    fn few_samples_have_no_interval() {
        assert_eq!(Median::from_samples([]), None);
        let two = Median::from_samples([4.0, 2.0]).expect("two samples");
        assert_eq!((two.value, two.least, two.interval), (3.0, 2.0, None));
        let five = Median::from_samples([5.0, 1.0, 4.0, 2.0, 3.0]).expect("five samples");
        assert_eq!((five.value, five.interval), (3.0, Some([1.0, 5.0])));
    }

    #[test]
    fn the_interval_of_a_quotient_contains_it_about_19_times_in_20() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let mut covered = 0;
        for _ in 0..1000 {
            let mut draw = |count: usize| -> Vec<f64> {
                let uniform = |_| 1.0 + random.next_u32() as f64 / 2_f64.powi(32);
                (0..count).map(uniform).collect()
            };
            let (a, b) = (draw(25), draw(15));
            let doubled: Vec<f64> = a.iter().map(|a| 2.0 * a).collect();
            let (ratio, interval) = quotient(&doubled, &b).expect("samples");
            let [low, high] = interval.expect("many");
            assert!(low <= ratio && ratio <= high);
            covered += usize::from(low <= 2.0 && 2.0 <= high);
        }
        assert!((930..=995).contains(&covered), "{covered} of 1000");
        assert_eq!(quotient(&[], &[1.0]), None);
        assert_eq!(quotient(&[4.0, 4.0], &[2.0]), Some((2.0, None)));
        assert_eq!(quotient(&[1.0; 5], &[0.0; 5]), None);
    }

    #[test]
    fn the_interval_covers_the_median_about_19_times_in_20() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut covered = 0;
        for _ in 0..2000 {
            // The square of a uniform number in [0, 1): a skewed distribution with median 1/4.
            let mut draw = || (random.next_u32() as f64 / 2_f64.powi(32)).powi(2);
            let samples: Vec<f64> = (0..25).map(|_| draw()).collect();
            let [low, high] = Median::from_samples(samples)
                .and_then(|m| m.interval)
                .expect("25 samples");
            covered += usize::from(low <= 0.25 && 0.25 <= high);
        }
        assert!((1880..=1980).contains(&covered), "{covered} of 2000");
    }
}
