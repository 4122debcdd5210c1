//! Simulated machines whose speed drifts, for tests of the intervals with known truth.

use std::f64::consts::TAU;

use rand::Rng;
use rand::rngs::ChaCha8Rng;

/// Number of simulated studies of each machine.
pub(crate) const STUDIES: usize = 400;
/// Number of rounds of a simulated study: as many as a study of 45 s has.
pub(crate) const ROUNDS: usize = 24;
/// Number of rounds between two rebuilds of the structures.
const EPOCH: usize = 4;
/// Correlation of a phase from one round to the next.
const PERSISTENCE: f64 = 0.8;
/// Probability that a simulated machine changes its speed after a round.
const JUMP: f64 = 1.0 / 6.0;
/// Probability and factor of a stutter.
const STUTTER: (f64, f64) = (0.06, 1.6);

/// A simulated machine: standard deviations of the logarithms of times.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Machine {
    /// Independent noise of each sample.
    pub(crate) noise: f64,
    /// Phases: noise that persists over rounds (AR(1), [`PERSISTENCE`]).
    pub(crate) phases: f64,
    /// Half the distance of two speeds between which the machine jumps.
    pub(crate) jumps: f64,
    /// Placement in memory, constant between two rebuilds.
    pub(crate) placement: f64,
    /// Drift from study to study.
    pub(crate) studies: f64,
    pub(crate) stutters: bool,
    /// Difference from launch to launch, for each backend.
    pub(crate) launches: f64,
}

/// A machine with all kinds of drift, on which each process has its own addresses and pages.
pub(crate) const LAUNCHING: Machine = Machine {
    noise: 0.037,
    phases: 0.02,
    jumps: 0.01,
    placement: 0.01,
    studies: 0.0,
    stutters: true,
    launches: 0.03,
};

/// Machines with a single kind of drift each, and one with all of them. The noise is as large as
/// that of the recorded studies.
pub(crate) const MACHINES: [Machine; 7] = [
    STEADY,
    Machine {
        phases: 0.03,
        ..STEADY
    },
    Machine {
        jumps: 0.03,
        ..STEADY
    },
    Machine {
        stutters: true,
        ..STEADY
    },
    Machine {
        placement: 0.02,
        ..STEADY
    },
    Machine {
        studies: 0.01,
        ..STEADY
    },
    Machine {
        noise: 0.037,
        phases: 0.02,
        jumps: 0.01,
        placement: 0.01,
        studies: 0.01,
        stutters: true,
        ..STEADY
    },
];
pub(crate) const STEADY: Machine = Machine {
    noise: 0.037,
    phases: 0.0,
    jumps: 0.0,
    placement: 0.0,
    studies: 0.0,
    stutters: false,
    launches: 0.0,
};

pub(crate) fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (f64::from(random.next_u32()) + 0.5) / 2_f64.powi(32)
}

/// Returns a normal number with the standard deviation `deviation` (Box and Muller 1958).
pub(crate) fn normal(random: &mut ChaCha8Rng, deviation: f64) -> f64 {
    let radius = (-2.0 * uniform(random).ln()).sqrt();
    deviation * radius * (TAU * uniform(random)).cos()
}

impl Machine {
    /// Returns the logarithms of the speed in each round of a study. All backends share them.
    pub(crate) fn common(&self, random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut phase = normal(random, self.phases);
        let innovation = self.phases * (1.0 - PERSISTENCE * PERSISTENCE).sqrt();
        let mut jump = if uniform(random) < 0.5 { 1.0 } else { -1.0 };
        let round = |_| {
            phase = PERSISTENCE * phase + normal(random, innovation);
            jump = if uniform(random) < JUMP { -jump } else { jump };
            phase + jump * self.jumps
        };
        (0..ROUNDS).map(round).collect()
    }

    /// Returns the times of a backend whose true median is near `true_ns`.
    pub(crate) fn times(&self, common: &[f64], true_ns: f64, random: &mut ChaCha8Rng) -> Vec<f64> {
        let study = normal(random, self.studies);
        let mut placement = 0.0;
        let time = |(round, common): (usize, &f64)| {
            if round.is_multiple_of(EPOCH) {
                placement = normal(random, self.placement);
            }
            let stutters = self.stutters && uniform(random) < STUTTER.0;
            let stutter = if stutters { STUTTER.1.ln() } else { 0.0 };
            let own = normal(random, self.noise);
            true_ns * (common + study + placement + stutter + own).exp()
        };
        common.iter().enumerate().map(time).collect()
    }
}
