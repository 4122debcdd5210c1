//! A clock for tests: a simulated machine whose speed drifts.

use std::sync::{Arc, Mutex};

use sixfold_workload::{Clock, Time};

/// A machine with slow drift (±50 %), jumps (1.8×) and stutters (1.6×). Time advances only in
/// [`work`](Self::work).
#[derive(Clone, Default)]
pub(crate) struct SimulatedMachine {
    /// The time in nanoseconds, and the number of calls of `work`.
    state: Arc<Mutex<(f64, u64)>>,
}

impl SimulatedMachine {
    /// Advances the time by work that takes `ns` nanoseconds on an undisturbed machine.
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

    pub(crate) fn ns(&self) -> f64 {
        self.state.lock().expect("no panics").0
    }
}

impl Clock for SimulatedMachine {
    fn now(&self) -> Time {
        Time::from_wall_ns(self.ns())
    }
}
