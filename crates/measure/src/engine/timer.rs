//! The cost of reading the clock.

use std::hint::black_box;

use crate::Clock;
use sixfold_results::Timer;

/// Number of readings.
const TRIALS: usize = 1001;

/// Reads `clock` repeatedly, without work between the readings.
pub fn measure(clock: &dyn Clock) -> Timer {
    let runs = black_box(1_u32);
    let empty = || {
        let start = clock.now();
        for run in 0..runs {
            black_box(run);
        }
        (clock.now() - start).ns()
    };
    let mut times: Vec<f64> = (0..TRIALS).map(|_| empty()).collect();
    times.sort_by(f64::total_cmp);
    let (usual, longest) = (times[TRIALS / 2], times[TRIALS * 95 / 100]);
    let overhead_ns = clock.overhead().ns();
    let mut steps = times.iter().copied().filter(|&ns| ns > 0.0);
    let resolution_ns = steps.next().unwrap_or(0.0);
    // The overhead may be as in this empty loop, or a reading may take longer.
    let differences = [
        (overhead_ns - usual).abs(),
        longest - usual,
        resolution_ns - usual,
    ];
    Timer {
        resolution_ns,
        overhead_ns,
        uncertainty_ns: differences.into_iter().fold(0.0, f64::max),
        largest_share: None,
        shortest_ns: None,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use sixfold_results::Time;

    use super::*;

    /// A clock that takes 600 ns for a reading, and shows only whole ticks.
    struct Ticks {
        readings: AtomicU32,
        tick_ns: f64,
    }

    impl Clock for Ticks {
        fn now(&self) -> Time {
            let ns = 600.0 * f64::from(self.readings.fetch_add(1, Ordering::Relaxed));
            Time::from_wall_ns((ns / self.tick_ns).floor() * self.tick_ns)
        }

        fn overhead(&self) -> Time {
            Time::from_wall_ns(600.0)
        }
    }

    #[test]
    fn a_slow_clock_is_exact_but_a_coarse_clock_is_not() {
        let timer = |tick_ns| {
            let readings = AtomicU32::new(0);
            measure(&Ticks { readings, tick_ns }).with_shortest(Some(59_400.0))
        };
        let slow = timer(1.0);
        assert_eq!((slow.resolution_ns, slow.overhead_ns), (600.0, 600.0));
        assert_eq!((slow.uncertainty_ns, slow.largest_share), (0.0, Some(0.0)));
        let coarse = timer(59_400.0);
        assert_eq!(coarse.resolution_ns, 59_400.0);
        assert_eq!(coarse.uncertainty_ns, 59_400.0);
        assert_eq!(coarse.largest_share, Some(1.0));
    }
}
