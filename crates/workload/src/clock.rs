//! What time it is: on the wall, and for this thread's processor.

use std::ops::Sub;
use std::time::Instant;

/// A moment, or the time between two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Time {
    /// Processor time of this thread, in nanoseconds; `None` where the platform does not tell.
    pub cpu_ns: Option<f64>,
    /// Wall time, in nanoseconds.
    pub wall_ns: f64,
}

impl Time {
    /// The figure to judge by: processor time where there is one, for a busy machine disturbs it less.
    pub fn ns(self) -> f64 {
        self.cpu_ns.unwrap_or(self.wall_ns)
    }

    /// Both figures times `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            cpu_ns: self.cpu_ns.map(|ns| ns * factor),
            wall_ns: self.wall_ns * factor,
        }
    }

    /// Both figures added up.
    pub fn plus(self, other: Self) -> Self {
        Self {
            cpu_ns: self.cpu_ns.zip(other.cpu_ns).map(|(a, b)| a + b),
            wall_ns: self.wall_ns + other.wall_ns,
        }
    }

    /// No time at all, on both clocks or on the wall alone as `like` has it.
    pub fn none_like(like: Self) -> Self {
        like.scaled(0.0)
    }
}

impl Sub for Time {
    type Output = Self;

    fn sub(self, earlier: Self) -> Self {
        Self {
            cpu_ns: self.cpu_ns.zip(earlier.cpu_ns).map(|(a, b)| a - b),
            wall_ns: self.wall_ns - earlier.wall_ns,
        }
    }
}

/// Something that tells the time; a test can tell it what it likes.
///
/// Work may be done on another thread: it is asked there, and then speaks of that thread.
pub trait Clock: Sync {
    /// The moment.
    fn now(&self) -> Time;
}

/// The clocks of this machine.
#[derive(Clone, Debug)]
pub struct MachineClock {
    start: Instant,
}

impl MachineClock {
    /// A clock that starts now.
    pub fn start() -> Self {
        Self {
            start: Instant::now(),
        }
    }

    /// Which clock the figures of a study are of: `thread-cpu` or `wall`.
    pub fn name() -> &'static str {
        match thread_cpu_ns() {
            Some(_) => "thread-cpu",
            None => "wall",
        }
    }
}

impl Clock for MachineClock {
    #[inline]
    fn now(&self) -> Time {
        Time {
            cpu_ns: thread_cpu_ns(),
            wall_ns: self.start.elapsed().as_nanos() as f64,
        }
    }
}

/// The time that `work` takes.
#[inline]
pub fn timed(clock: &dyn Clock, work: impl FnOnce()) -> Time {
    let start = clock.now();
    work();
    clock.now() - start
}

#[cfg(any(
    target_os = "linux",
    target_os = "android",
    target_os = "macos",
    target_os = "freebsd"
))]
#[inline]
fn thread_cpu_ns() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Some(time.tv_sec as f64 * 1e9 + time.tv_nsec as f64)
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
        assert_eq!(time.cpu_ns.is_some(), MachineClock::name() == "thread-cpu");
        assert!(time.ns() > 0.0);
    }

    #[test]
    fn a_clock_without_processor_time_stays_without() {
        let wall = |wall_ns| Time {
            cpu_ns: None,
            wall_ns,
        };
        assert_eq!((wall(5.0) - wall(2.0)).scaled(2.0).ns(), 6.0);
        assert_eq!(Time::none_like(wall(9.0)).plus(wall(4.0)), wall(4.0));
    }
}
