//! Detects whether other programs slow the machine down.
//!
//! On a shared machine, another program may run on the same core. A sample (timed series of runs)
//! then takes up to twice as long. Such phases last from milliseconds to seconds.
//!
//! To detect such a phase, a small fixed piece of work is timed before and after each sample. If
//! the fixed work takes too long, the sample is *disturbed*. A disturbed sample is taken again,
//! within limits. A disturbed sample does not count if there are enough undisturbed samples. The
//! fixed work does not depend on the backend, so the method prefers no backend.

use sixfold_results::statistics::DISTURBED;
use std::hint::black_box;

use crate::{Clock, timed};
use sixfold_results::Time;

/// Maximum number of times a sample is taken again.
const MAX_RETAKEN: u32 = 3;
/// Number of words that the fixed work reads: half of a typical first-level cache.
const WORDS: usize = 2048;
/// Number of passes over the words in one reference run. A reference run takes about 10 µs.
const PASSES: usize = 12;
/// The quantile of all reference times that counts as the undisturbed time.
const UNDISTURBED: f64 = 0.05;
/// Maximum wait for an undisturbed moment before a sample, in nanoseconds.
const LONGEST_WAIT_NS: f64 = 10_000_000.0;
/// Part of the budget for waiting and for disturbed samples before the first sample counts.
const FOR_DISTURBED_AT_FIRST: f64 = 0.01;
/// Time for waiting and for disturbed samples, relative to the time of the samples that count. On a
/// machine that is always disturbed, waiting takes at most this time, so that there is time for
/// rounds.
const FOR_DISTURBED: f64 = 0.4;
/// Part of the budget for samples taken again because of page faults.
const FOR_FAULTS: f64 = 0.1;

/// Does a number of passes of the fixed work.
pub type ReferenceWork<'w> = Box<dyn Fn(usize) + 'w>;

pub struct DisturbanceDetector<'w> {
    work: ReferenceWork<'w>,
    /// Times of the reference runs, ascending.
    reference_ns: Vec<f64>,
    /// Time left for waiting and for disturbed samples, in nanoseconds. Grows with the samples that
    /// count.
    disturbed_left_ns: f64,
    /// What `disturbed_left_ns` grows by, relative to the time of a sample.
    earned: f64,
    /// Time left for samples with page faults, in nanoseconds.
    faults_left_ns: f64,
}

impl<'w> DisturbanceDetector<'w> {
    /// Creates a detector that times `work`. `budget_ns` is the time of the whole measurement, in
    /// nanoseconds, of which a part is for waiting and for disturbed samples.
    pub fn new(budget_ns: f64, work: ReferenceWork<'w>) -> Self {
        Self {
            work,
            reference_ns: Vec::new(),
            disturbed_left_ns: FOR_DISTURBED_AT_FIRST * budget_ns,
            earned: FOR_DISTURBED,
            faults_left_ns: FOR_FAULTS * budget_ns,
        }
    }

    /// Creates a detector for a fixed number of samples: it never waits, and takes no sample again
    /// because of other programs, so that the work does not depend on the time.
    pub fn without_waiting(work: ReferenceWork<'w>) -> Self {
        Self {
            faults_left_ns: f64::INFINITY,
            earned: 0.0,
            ..Self::new(0.0, work)
        }
    }

    /// Takes a sample by calling `sample`. Takes the sample again if `verdict` returns
    /// [`Verdict::Again`] or if the machine was disturbed. Repeats this at most three times, and
    /// only while time is left for that reason.
    pub fn take_sample<T>(
        &mut self,
        clock: &dyn Clock,
        mut sample: impl FnMut() -> T,
        verdict: impl Fn(&T) -> Verdict,
    ) -> TakenSample<T> {
        let mut retaken = 0;
        loop {
            let before = self.wait(clock);
            let start = clock.now().wall_ns;
            let value = sample();
            let elapsed_ns = clock.now().wall_ns - start;
            let slowdown = self.slowdown(clock).max(before);
            let disturbed = slowdown > DISTURBED && self.has_time_left();
            let left_ns = match verdict(&value) {
                Verdict::Good if disturbed => Some(&mut self.disturbed_left_ns),
                Verdict::Again => Some(&mut self.faults_left_ns),
                Verdict::Good | Verdict::Final => None,
            };
            let left_ns = left_ns.filter(|left_ns| **left_ns > 0.0 && retaken < MAX_RETAKEN);
            let Some(left_ns) = left_ns else {
                self.disturbed_left_ns += self.earned * elapsed_ns;
                return TakenSample {
                    value,
                    slowdown,
                    retaken,
                    disturbed,
                };
            };
            retaken += 1;
            *left_ns -= elapsed_ns;
        }
    }

    fn has_time_left(&self) -> bool {
        self.disturbed_left_ns > 0.0
    }

    /// Waits up to 10 ms for an undisturbed moment. Returns the slowdown after the wait.
    fn wait(&mut self, clock: &dyn Clock) -> f64 {
        let start = clock.now().wall_ns;
        loop {
            let ns = self.time_reference(clock);
            let waited = clock.now().wall_ns - start;
            let disturbed = self.slowdown_at(ns) > DISTURBED;
            if !disturbed || waited > LONGEST_WAIT_NS || !self.has_time_left() {
                self.disturbed_left_ns -= waited;
                // Record only one reference run of a wait. Hundreds of disturbed runs would change
                // the undisturbed time.
                return self.record(ns);
            }
        }
    }

    /// Times the fixed work and returns the slowdown. Returns 1 if the clock does not advance.
    fn slowdown(&mut self, clock: &dyn Clock) -> f64 {
        let ns = self.time_reference(clock);
        self.record(ns)
    }

    fn time_reference(&self, clock: &dyn Clock) -> f64 {
        // The first pass brings the words into the cache.
        (self.work)(1);
        timed(clock, || (self.work)(PASSES)).ns()
    }

    /// Records the time of a reference run and returns the slowdown.
    fn record(&mut self, ns: f64) -> f64 {
        let index = self.reference_ns.partition_point(|&other| other < ns);
        self.reference_ns.insert(index, ns);
        self.slowdown_at(ns)
    }

    /// Returns `ns` divided by the undisturbed time. Returns 1 if a time is zero or unknown.
    fn slowdown_at(&self, ns: f64) -> f64 {
        let undisturbed = (self.reference_ns.len() as f64 * UNDISTURBED) as usize;
        match self.reference_ns.get(undisturbed) {
            Some(&undisturbed) if ns > 0.0 && undisturbed > 0.0 => ns / undisturbed,
            _ => 1.0,
        }
    }
}

/// Returns the fixed work of this machine: it adds up words in the first-level cache.
pub fn reference_work() -> ReferenceWork<'static> {
    let word = |i: u64| i.wrapping_mul(0x9e37_79b9_7f4a_7c15) % WORDS as u64;
    let words: Vec<u64> = (0..WORDS as u64).map(word).collect();
    Box::new(move |passes| {
        for _ in 0..passes {
            black_box(sum(black_box(&words)));
        }
    })
}

/// Adds up four independent sums, which use the whole core. The work then takes longer if another
/// thread shares the core.
fn sum(words: &[u64]) -> u64 {
    let mut sums = [0_u64; 4];
    for four in words.chunks_exact(4) {
        for (sum, &word) in sums.iter_mut().zip(four) {
            *sum = sum.wrapping_add(words[word as usize % WORDS] ^ word);
        }
    }
    sums.iter().fold(0, |all, sum| all.wrapping_add(*sum))
}

/// The decision of [`DisturbanceDetector::take_sample`] about a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Keep the sample, unless the machine was disturbed.
    Good,
    /// Take the sample again because of page faults.
    Again,
    /// Keep the sample in any case, because the run was refused or the study is to stop.
    Final,
}

impl Verdict {
    /// Returns the verdict on a sample of `time`. Page faults matter only if pages are `kept`.
    pub fn on_faults(time: Time, kept: bool) -> Self {
        match kept && time.faults.is_some_and(|faults| faults > 0) {
            true => Self::Again,
            false => Self::Good,
        }
    }
}

pub struct TakenSample<T> {
    pub value: T,
    /// The larger of the slowdowns before and after the sample.
    pub slowdown: f64,
    /// Number of times the sample was taken again.
    pub retaken: u32,
    /// Whether the machine was disturbed and time is left for another sample.
    pub disturbed: bool,
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use sixfold_results::statistics::undisturbed;

    use super::*;

    /// A clock on which each reference run takes the next of the listed times.
    struct Scripted(Mutex<(f64, Vec<f64>, bool)>);

    impl Clock for Scripted {
        fn now(&self) -> Time {
            let (now, script, ends) = &mut *self.0.lock().expect("no panics");
            if *ends {
                *now += if script.len() > 1 {
                    script.remove(0)
                } else {
                    script[0]
                };
            }
            *ends = !*ends;
            Time::from_wall_ns(*now)
        }
    }

    #[test]
    fn the_fixed_work_reads_a_word_at_the_place_that_each_word_names() {
        let words: Vec<u64> = (0..WORDS as u64)
            .map(|i| i * i + 7 * WORDS as u64)
            .collect();
        let read = |&word: &u64| words[(word % WORDS as u64) as usize] ^ word;
        assert_eq!(sum(&words), words.iter().map(read).sum::<u64>());
    }

    /// The work takes the time that the clock of the test says.
    fn no_work() -> ReferenceWork<'static> {
        Box::new(|_| ())
    }

    #[derive(Default)]
    struct Ticking(Mutex<f64>);

    const TICK_NS: f64 = 1e6;

    impl Clock for Ticking {
        fn now(&self) -> Time {
            let now = &mut *self.0.lock().expect("no panics");
            *now += TICK_NS;
            Time::from_wall_ns(*now)
        }
    }

    #[test]
    fn disturbed_moments_are_detected_and_waited_for_while_time_is_left() {
        let clock_of = |script: &[f64]| Scripted(Mutex::new((0.0, script.to_vec(), false)));
        let mut detector = DisturbanceDetector::new(1e9, no_work());
        let clock = clock_of(&[100.0, 101.0, 160.0, 99.0, 106.0, 132.0]);
        let slowdowns: Vec<f64> = (0..6).map(|_| detector.slowdown(&clock)).collect();
        let disturbed: Vec<bool> = slowdowns.iter().map(|s| *s > DISTURBED).collect();
        assert_eq!(disturbed, [false, false, true, false, false, true]);

        assert_eq!(
            DisturbanceDetector::new(1.0, no_work()).slowdown(&clock_of(&[0.0])),
            1.0
        );

        detector.disturbed_left_ns = 0.0;
        let slow = Ticking::default();
        assert!(detector.wait(&slow) > 1.9);
        assert_eq!(
            *slow.0.lock().expect("no panics"),
            4.0 * TICK_NS,
            "one reference run"
        );
    }

    #[test]
    fn samples_are_taken_again_up_to_three_times() {
        let tries = |verdict: Verdict, reference_ns: &[f64], disturbed_left_ns: f64| {
            let mut detector = DisturbanceDetector {
                reference_ns: reference_ns.to_vec(),
                ..DisturbanceDetector::new(1.0, no_work())
            };
            detector.disturbed_left_ns = disturbed_left_ns;
            detector.faults_left_ns = 1e9;
            let mut tries = 0;
            let taken = detector.take_sample(&Ticking::default(), || tries += 1, |()| verdict);
            assert_eq!(taken.retaken + 1, tries);
            (tries, taken.disturbed)
        };
        let (quiet, disturbed) = (&[TICK_NS; 40], &[TICK_NS / 2.0; 400]);
        assert_eq!(tries(Verdict::Good, quiet, 1e9), (1, false));
        assert_eq!(tries(Verdict::Again, quiet, 1e9), (4, false));
        assert_eq!(tries(Verdict::Good, disturbed, 1e9), (4, true));
        assert_eq!(tries(Verdict::Final, disturbed, 1e9), (1, true));
        assert_eq!(tries(Verdict::Good, disturbed, 0.0), (1, false));
        assert_eq!(tries(Verdict::Again, quiet, 0.0), (4, false));
    }

    #[test]
    fn a_machine_that_is_always_disturbed_has_time_for_samples() {
        let mut detector = DisturbanceDetector {
            reference_ns: vec![TICK_NS / 2.0; 40_000],
            ..DisturbanceDetector::new(0.0, no_work())
        };
        let clock = Ticking::default();
        let (mut tries, samples) = (0, 1000);
        for _ in 0..samples {
            let sample = || {
                tries += 1;
                let _ = (0..100).map(|_| clock.now()).last(); // takes 100 ticks
            };
            let taken = detector.take_sample(&clock, sample, |()| Verdict::Good);
            assert!(taken.slowdown > DISTURBED);
        }
        let again = f64::from(tries - samples) / f64::from(samples);
        assert!((0.01..=FOR_DISTURBED).contains(&again), "{again}");
    }

    #[test]
    fn a_fixed_number_of_samples_waits_for_nothing_but_pages() {
        let tries = |verdict: Verdict| {
            let mut detector = DisturbanceDetector {
                reference_ns: vec![TICK_NS / 2.0; 400],
                ..DisturbanceDetector::without_waiting(no_work())
            };
            let mut tries = 0;
            let clock = Ticking::default();
            let taken = detector.take_sample(&clock, || tries += 1, |()| verdict);
            assert!(taken.slowdown > DISTURBED && !taken.disturbed);
            tries
        };
        assert_eq!(tries(Verdict::Good), 1);
        assert_eq!(tries(Verdict::Again), 4);
    }

    #[test]
    fn disturbed_samples_do_not_count_if_enough_others_do() {
        let counted = |slowdowns: &[f64]| -> Vec<usize> {
            let samples: Vec<usize> = (0..slowdowns.len()).collect();
            undisturbed(&samples, slowdowns)
        };
        let six = [1.0, 1.5, 1.0, 1.29, 2.0, 1.0, 1.0, 1.3];
        assert_eq!(counted(&six), [0, 2, 3, 5, 6, 7]);
        let half = [1.0, 1.5, 1.0, 1.5, 1.0, 1.5].repeat(2);
        assert_eq!(counted(&half), [0, 2, 4, 6, 8, 10]);
        let less_than_half = [&half[..], &[1.31]].concat();
        assert_eq!(counted(&less_than_half).len(), 13);
        let too_few_for_an_interval = [1.0, 1.5, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(counted(&too_few_for_an_interval).len(), 6);
        // Results of older versions have no slowdowns.
        assert_eq!(undisturbed(&[0; 6], &[]).len(), 6);
    }
}
