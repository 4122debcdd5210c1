//! Clocks that measure wall time and the processor time of the current thread.

use std::time::Instant;

use sixfold_results::{ClockKind, Time};

use crate::pages;

/// A clock. Tests can implement this trait with chosen times.
///
/// A program must read the clock on the thread that does the timed work.
pub trait Clock: Sync {
    /// Returns the current time.
    fn now(&self) -> Time;

    /// Returns the time that two readings of the clock take. [`timed`] subtracts this time from
    /// every result.
    fn overhead(&self) -> Time {
        Time::default()
    }

    /// Returns the number of page faults of the current thread since its start; `None` if page
    /// faults are not counted.
    fn faults(&self) -> Option<u64> {
        None
    }
}

/// Number of measurements for each value of the clock overhead.
const READINGS: usize = 301;
/// Number of words that the work between two readings reads. They exceed a first-level cache.
const WORDS: usize = 8192;
/// Maximum overhead, relative to readings in a loop without work.
const MAX_OVERHEAD_RATIO: f64 = 3.0;

/// The clocks and the page-fault counter of this machine.
#[derive(Clone, Debug)]
pub struct MachineClock {
    start: Instant,
    overhead: Time,
    counts_faults: bool,
}

impl MachineClock {
    /// Starts a clock, and measures the time for reading the clock. The call takes some
    /// milliseconds.
    pub fn start() -> Self {
        let mut clock = Self {
            start: Instant::now(),
            overhead: Time::default(),
            counts_faults: pages::counts_faults(),
        };
        clock.overhead = clock.cost_of_reading();
        clock
    }

    /// Measures the time that two readings add to the work between them. The result is twice the
    /// time of some work minus the time of twice that work. It is at least the time of two readings
    /// without work.
    fn cost_of_reading(&self) -> Time {
        let words: Vec<u64> = vec![1; WORDS];
        let pass = || std::hint::black_box(std::hint::black_box(&words).iter().sum::<u64>());
        let median = |passes: usize| {
            let mut readings: Vec<Time> = (0..READINGS)
                .map(|_| {
                    let start = self.now();
                    for _ in 0..passes {
                        pass();
                    }
                    self.now() - start
                })
                .collect();
            readings.sort_by(|a, b| a.ns().total_cmp(&b.ns()));
            readings[READINGS / 2]
        };
        let [nothing, once, twice] = [0, 1, 2].map(median);
        let between = |nothing: f64, once: f64, twice: f64| {
            (2.0 * once - twice).clamp(nothing, MAX_OVERHEAD_RATIO * nothing)
        };
        Time {
            cpu_ns: nothing
                .cpu_ns
                .zip(once.cpu_ns)
                .zip(twice.cpu_ns)
                .map(|((nothing, once), twice)| between(nothing, once, twice)),
            wall_ns: between(nothing.wall_ns, once.wall_ns, twice.wall_ns),
            faults: None,
        }
    }

    /// Returns the clock that studies use.
    pub fn kind() -> ClockKind {
        match thread_cpu_ns() {
            Some(_) => ClockKind::ThreadCpu,
            None => ClockKind::Wall,
        }
    }
}

impl Clock for MachineClock {
    #[inline]
    fn now(&self) -> Time {
        Time {
            cpu_ns: thread_cpu_ns(),
            wall_ns: self.start.elapsed().as_nanos() as f64,
            faults: None,
        }
    }

    fn overhead(&self) -> Time {
        self.overhead
    }

    fn faults(&self) -> Option<u64> {
        match self.counts_faults {
            true => pages::faults(),
            false => None,
        }
    }
}

/// Runs `work` and returns its time and page faults, without the cost of reading the clock.
#[inline]
pub fn timed(clock: &dyn Clock, work: impl FnOnce()) -> Time {
    let faults = clock.faults();
    let start = clock.now();
    work();
    let time = clock.now() - start;
    let faults = clock.faults().zip(faults);
    Time {
        faults: faults.map(|(after, before)| after.saturating_sub(before)),
        ..time.without(clock.overhead())
    }
}

#[cfg(any(
    target_os = "linux",
    target_os = "android",
    target_os = "macos",
    target_os = "freebsd"
))]
#[inline]
fn thread_cpu_ns() -> Option<f64> {
    use nix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).ok()?;
    Some(time.tv_sec() as f64 * 1e9 + time.tv_nsec() as f64)
}

#[cfg(not(any(
    target_os = "linux",
    target_os = "android",
    target_os = "macos",
    target_os = "freebsd"
)))]
fn thread_cpu_ns() -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn work_takes_time_on_both_clocks() {
        let mut sum = 0_u64;
        let time = timed(&MachineClock::start(), || {
            for i in 0..100_000_u64 {
                sum = std::hint::black_box(sum.wrapping_mul(31) + i);
            }
        });
        assert!(time.wall_ns > 0.0);
        assert_eq!(
            time.cpu_ns.is_some(),
            MachineClock::kind() == ClockKind::ThreadCpu
        );
        assert!(time.ns() > 0.0);
    }

    #[test]
    fn times_without_processor_time_stay_without_it() {
        let wall = Time::from_wall_ns;
        assert_eq!((wall(5.0) - wall(2.0)).scaled(2.0).ns(), 6.0);
        assert_eq!(Time::zero_like(wall(9.0)).plus(wall(4.0)), wall(4.0));
    }

    /// A clock whose readings take 300 ns, and a counter of page faults.
    struct SlowClock(Mutex<(f64, u64)>);

    impl Clock for SlowClock {
        fn now(&self) -> Time {
            let (ns, _) = &mut *self.0.lock().expect("no panics");
            *ns += 300.0;
            Time {
                cpu_ns: Some(*ns),
                ..Time::from_wall_ns(*ns)
            }
        }

        fn overhead(&self) -> Time {
            Time {
                cpu_ns: Some(300.0),
                ..Time::from_wall_ns(300.0)
            }
        }

        fn faults(&self) -> Option<u64> {
            Some(self.0.lock().expect("no panics").1)
        }
    }

    #[test]
    fn reading_the_clock_is_subtracted_and_faults_are_counted() {
        let clock = SlowClock(Mutex::new((0.0, 10)));
        let work = |ns: f64| {
            timed(&clock, || {
                let (now, faults) = &mut *clock.0.lock().expect("no panics");
                *now += ns;
                *faults += 4;
            })
        };
        let time = work(5000.0);
        assert_eq!((time.cpu_ns, time.wall_ns), (Some(5000.0), 5000.0));
        assert_eq!(time.faults, Some(4));
        assert_eq!(time.plus(work(0.0)).faults, Some(8));
        assert_eq!(time.scaled(0.5).faults, Some(4));
        assert_eq!(work(-100.0).ns(), 20.0, "a tenth of the measured 200 ns");
        assert_eq!(
            Time::zero_like(time).plus(Time::from_wall_ns(1.0)).faults,
            None
        );
    }
}
