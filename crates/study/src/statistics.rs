//! Medians and how far they can be trusted.

/// The middle of some samples, with an interval that holds the true median 19 times in 20.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Median {
    /// The median.
    pub(crate) value: f64,
    /// The smallest sample.
    pub(crate) least: f64,
    /// The 95 % confidence interval of the median; `None` below three samples.
    pub(crate) interval: Option<[f64; 2]>,
}

impl Median {
    /// The median of `samples`; `None` if there are none.
    ///
    /// The interval runs between two of the sorted samples, chosen by the binomial distribution
    /// (Conover 1999, §3.2), so it assumes nothing about how the samples are spread. Below six
    /// samples 95 % is out of reach: then it runs from the smallest to the largest (93.75 % for
    /// five, 87.5 % for four, 75 % for three).
    pub(crate) fn of(samples: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = samples.into_iter().collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let count = sorted.len();
        let least = *sorted.first()?;
        let value = f64::midpoint(sorted[(count - 1) / 2], sorted[count / 2]);
        let interval = (count >= 3).then(|| {
            let skipped = skipped_ranks(count);
            [sorted[skipped], sorted[count - 1 - skipped]]
        });
        Some(Self {
            value,
            least,
            interval,
        })
    }
}

/// How many samples the 95 % interval of the median leaves out at each end of `count` sorted ones.
fn skipped_ranks(count: usize) -> usize {
    // The interval that skips k at each end misses with probability 2·P(Binomial(n, ½) ≤ k).
    let n = count as f64;
    let mut log_term = -n * std::f64::consts::LN_2; // ln P(Binomial = 0)
    let mut below = 0.0;
    for k in 0..count {
        below += log_term.exp();
        if 2.0 * below > 0.05 {
            return k.saturating_sub(1);
        }
        log_term += ((n - k as f64) / (k as f64 + 1.0)).ln();
    }
    0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The smallest k that may not be skipped, from the tables of the binomial distribution.
    #[test]
    fn ranks_are_those_of_the_tables() {
        // n: the interval runs from the (k + 1)-th smallest to the (k + 1)-th largest.
        for (n, k) in [
            (3, 0),
            (5, 0),
            (6, 0),
            (8, 0),
            (9, 1),
            (10, 1),
            (12, 2),
            (20, 5),
            (50, 17),
            (100, 39),
        ] {
            assert_eq!(skipped_ranks(n), k, "{n} samples");
        }
    }

    #[test]
    fn few_samples_have_no_interval() {
        assert_eq!(Median::of([]), None);
        let two = Median::of([4.0, 2.0]).expect("two samples");
        assert_eq!((two.value, two.least, two.interval), (3.0, 2.0, None));
        let five = Median::of([5.0, 1.0, 4.0, 2.0, 3.0]).expect("five samples");
        assert_eq!((five.value, five.interval), (3.0, Some([1.0, 5.0])));
    }

    #[test]
    fn the_interval_covers_the_median_about_19_times_in_20() {
        use rand_chacha::ChaCha8Rng;
        use rand_chacha::rand_core::{Rng, SeedableRng};
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut covered = 0;
        for _ in 0..2000 {
            // Uniform in [0, 1), squared: skewed, with its median at a quarter.
            let mut draw = || (random.next_u32() as f64 / 2_f64.powi(32)).powi(2);
            let samples: Vec<f64> = (0..25).map(|_| draw()).collect();
            let [low, high] = Median::of(samples)
                .and_then(|m| m.interval)
                .expect("25 samples");
            covered += usize::from(low <= 0.25 && 0.25 <= high);
        }
        assert!((1880..=1980).contains(&covered), "{covered} of 2000");
    }
}
