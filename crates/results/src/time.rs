//! A measured time.

use std::ops::Sub;

/// A point in time, or the difference between two points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Time {
    /// Processor time of the current thread, in nanoseconds; `None` if the platform does not report
    /// processor time.
    pub cpu_ns: Option<f64>,
    /// Wall time, in nanoseconds.
    pub wall_ns: f64,
    /// Number of page faults of the current thread; `None` if page faults were not counted.
    pub faults: Option<u64>,
}

impl Time {
    /// Returns the processor time in nanoseconds. If the processor time is unknown, returns the
    /// wall time. Other programs disturb processor time less than wall time.
    pub fn ns(self) -> f64 {
        self.cpu_ns.unwrap_or(self.wall_ns)
    }

    /// Makes a time without processor time.
    pub fn from_wall_ns(wall_ns: f64) -> Self {
        Self {
            wall_ns,
            ..Self::default()
        }
    }

    /// Multiplies processor time and wall time by `factor`. The number of page faults does not
    /// change.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            cpu_ns: self.cpu_ns.map(|ns| ns * factor),
            wall_ns: self.wall_ns * factor,
            faults: self.faults,
        }
    }

    /// Adds processor times, wall times and page faults. If only one of the two numbers of page
    /// faults is known, the result is the known number.
    pub fn plus(self, other: Self) -> Self {
        let known = self.faults.is_some() || other.faults.is_some();
        Self {
            cpu_ns: self.cpu_ns.zip(other.cpu_ns).map(|(a, b)| a + b),
            wall_ns: self.wall_ns + other.wall_ns,
            faults: known.then(|| self.faults.unwrap_or(0) + other.faults.unwrap_or(0)),
        }
    }

    /// Adds `ns` nanoseconds of work to both times. Times stay positive if `ns` is negative.
    pub fn plus_ns(self, ns: f64) -> Self {
        Self {
            cpu_ns: self.cpu_ns.map(|cpu_ns| (cpu_ns + ns).max(1.0)),
            wall_ns: (self.wall_ns + ns).max(1.0),
            ..self
        }
    }

    /// Returns a time of zero. The result contains a processor time if `like` contains a processor
    /// time.
    pub fn zero_like(like: Self) -> Self {
        Self {
            faults: None,
            ..like.scaled(0.0)
        }
    }

    /// Subtracts `overhead` from both times, but leaves at least a tenth of each time.
    pub fn without(self, overhead: Self) -> Self {
        let subtract = |ns: f64, overhead: f64| (ns - overhead).max(0.1 * ns);
        Self {
            cpu_ns: self
                .cpu_ns
                .map(|ns| subtract(ns, overhead.cpu_ns.unwrap_or(0.0))),
            wall_ns: subtract(self.wall_ns, overhead.wall_ns),
            faults: self.faults,
        }
    }
}

impl Sub for Time {
    type Output = Self;

    fn sub(self, earlier: Self) -> Self {
        Self {
            cpu_ns: self.cpu_ns.zip(earlier.cpu_ns).map(|(a, b)| a - b),
            wall_ns: self.wall_ns - earlier.wall_ns,
            faults: None,
        }
    }
}
