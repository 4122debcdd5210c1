//! A clock for tests: that of a machine whose speed drifts.

use std::sync::{Arc, Mutex};

use workload::{Clock, Time};

/// A machine that slows down by half, jumps, and stutters; time passes only while it works.
#[derive(Clone, Default)]
pub(crate) struct Machine {
    /// The time, and how often it has worked.
    state: Arc<Mutex<(f64, u64)>>,
}

impl Machine {
    /// Works for as long as `ns` would be on a machine at rest.
    pub(crate) fn work(&self, ns: f64) {
        let (time, steps) = &mut *self.state.lock().expect("no panics");
        *steps += 1;
        let drift = 1.0 + 0.5 * (*steps as f64 / 900.0).sin();
        let stutter = if steps.is_multiple_of(17) { 1.6 } else { 1.0 };
        let jump = if (*steps / 400).is_multiple_of(2) {
            1.0
        } else {
            1.8
        };
        *time += ns * drift * stutter * jump;
    }

    /// What time it is.
    pub(crate) fn ns(&self) -> f64 {
        self.state.lock().expect("no panics").0
    }
}

impl Clock for Machine {
    fn now(&self) -> Time {
        Time::of_wall(self.ns())
    }
}
