//! Repeated runs of a job that give one sample (one measured time), and the preparation of the
//! runs.

use std::hint::black_box;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use crate::caches::{caches, level_bytes};
use crate::clock::{Clock, timed};
use crate::pages;
use sixfold_results::{Time, last_level_bytes};

/// The minimum time between two readings of the clock, in nanoseconds. Shorter runs are timed
/// together, as long as all copies of the mesh that these runs change fit into the cache.
pub const MIN_TIMED_NS: f64 = 60_000.0;
/// Assumed size of the second-level cache in bytes, if unknown.
const USUAL_SECOND_LEVEL: usize = 512 << 10;
/// Assumed size of the last-level cache in bytes, if unknown.
const USUAL_LAST_LEVEL: u64 = 32 << 20;

/// The state of the caches and of the heap when a timed run starts.
#[derive(Clone, Copy, Default)]
pub enum Start<'c> {
    /// The state that the previous runs left: warm caches, and freed pages that stay in the
    /// process.
    #[default]
    Warm,
    /// Cold caches, which hold data other than the mesh.
    Cold(&'c CacheFlusher),
    /// A heap whose freed pages were returned to the kernel.
    FreshPages,
}

/// A buffer that replaces the content of the caches when it is written.
pub struct CacheFlusher {
    words: Mutex<Vec<u64>>,
    level: Option<u8>,
}

impl CacheFlusher {
    /// Allocates a buffer of twice the size of the last-level cache.
    pub fn new() -> Self {
        let caches = caches();
        let bytes = last_level_bytes(&caches).unwrap_or(USUAL_LAST_LEVEL);
        let data = caches.iter().filter(|cache| cache.holds_data());
        Self {
            words: vec![1; 2 * bytes as usize / size_of::<u64>()].into(),
            level: data.map(|cache| cache.level).max(),
        }
    }

    /// Returns the size of the buffer in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&**self.words())
    }

    /// Returns the highest cache level whose content the buffer replaces; `None` if the caches are
    /// unknown.
    pub fn level(&self) -> Option<u8> {
        self.level
    }

    fn words(&self) -> MutexGuard<'_, Vec<u64>> {
        self.words.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes all words, so that the caches hold only this buffer.
    fn flush(&self) {
        let words = &mut *self.words();
        words
            .iter_mut()
            .for_each(|word| *word = word.wrapping_add(1));
        black_box(words);
    }
}

impl Default for CacheFlusher {
    fn default() -> Self {
        Self::new()
    }
}

/// A series of runs of a job. The series gives one sample (one measured time).
#[derive(Clone, Copy)]
pub struct Series<'c> {
    /// The number of untimed runs before the timed runs. The untimed runs warm the caches, enlarge
    /// the tables and load the memory pages that the timed runs use.
    pub untimed: u32,
    /// The number of timed runs; at least 1.
    pub runs: u32,
    /// The state of the caches and of the heap before the timed runs.
    pub start: Start<'c>,
    /// True if the backend must also compute the result of the job.
    pub check: bool,
    /// The clock that times the runs.
    pub clock: &'c dyn Clock,
}

impl<'c> Series<'c> {
    /// Makes a series of one timed run without untimed runs.
    pub fn once(clock: &'c dyn Clock) -> Self {
        Self {
            untimed: 0,
            runs: 1,
            start: Start::Warm,
            check: false,
            clock,
        }
    }

    /// Makes a series of `runs` timed runs without untimed runs.
    pub fn with_runs(runs: u32, clock: &'c dyn Clock) -> Self {
        Self {
            runs,
            ..Self::once(clock)
        }
    }

    /// Returns the series with `check` set, so that the backend also computes the result.
    pub fn with_result(self) -> Self {
        Self {
            check: true,
            ..self
        }
    }

    /// Returns the series with `untimed` untimed runs.
    pub fn with_untimed(self, untimed: u32) -> Self {
        Self { untimed, ..self }
    }

    /// Sets the caches and the heap to the state that the field `start` requires.
    pub fn begin(&self) {
        match self.start {
            Start::Warm => {}
            Start::Cold(flusher) => flusher.flush(),
            Start::FreshPages => pages::release_pages(),
        }
    }

    /// Brings the caches and the heap to the state of the start, and returns the time of `work`.
    pub fn timed(&self, work: impl FnOnce()) -> Time {
        self.begin();
        timed(self.clock, work)
    }

    /// Runs `work` as the series describes, without stopping the clock between timed runs. `work`
    /// must not change its input. Returns the total time of the timed runs.
    pub fn time_together(&self, mut work: impl FnMut()) -> Time {
        for _ in 0..self.untimed {
            work();
        }
        self.timed(|| {
            for _ in 0..self.runs {
                work();
            }
        })
    }
}

/// Copies that runs change. They are reset to the initial state outside the timing.
///
/// Normally there is one copy. If a run is too short for the clock, several copies are used in
/// turn, for about 60 µs of timed work. All copies together fit into half of the second-level
/// cache. The copies and their tables are kept between series.
#[derive(Debug)]
pub struct ReusedCopies<T> {
    copies: Vec<T>,
    /// The time of the last run, in nanoseconds; 0 before the first run.
    last_ns: f64,
}

impl<T> Default for ReusedCopies<T> {
    fn default() -> Self {
        Self {
            copies: Vec::new(),
            last_ns: 0.0,
        }
    }
}

impl<T> ReusedCopies<T> {
    /// Runs `run` as `series` describes, on copies that `reset` restores outside the timing. `new`
    /// makes a missing copy of size `bytes`. Returns the total time of the timed runs. If more runs
    /// are needed for the clock, their time is scaled to the requested number.
    pub fn time(
        &mut self,
        series: &Series<'_>,
        bytes: usize,
        new: impl Fn() -> T,
        reset: impl FnMut(&mut T),
        run: impl FnMut(&mut T),
    ) -> Time {
        let Self { copies, last_ns } = self;
        let mut changing = Changing {
            copies,
            new,
            reset,
            run,
        };
        time_changing(&mut changing, last_ns, series, bytes)
    }

    /// Returns a copy in its state after a run; `None` before the first run.
    pub fn used_copy(&self) -> Option<&T> {
        self.copies.first()
    }
}

/// Copies, and what is done with them. The functions are called by their addresses, which takes nothing
/// beside a run, so that the code that times them is compiled once.
trait Change {
    fn count(&self) -> usize;
    fn add(&mut self);
    fn reset(&mut self, nth: usize);
    /// **Timed**: runs on the copy `nth`.
    fn run(&mut self, nth: usize);
}

struct Changing<'c, T, New, Reset, TimedRun> {
    copies: &'c mut Vec<T>,
    new: New,
    reset: Reset,
    run: TimedRun,
}

impl<T, New: Fn() -> T, Reset: FnMut(&mut T), TimedRun: FnMut(&mut T)> Change
    for Changing<'_, T, New, Reset, TimedRun>
{
    fn count(&self) -> usize {
        self.copies.len()
    }

    fn add(&mut self) {
        self.copies.push((self.new)());
    }

    fn reset(&mut self, nth: usize) {
        (self.reset)(&mut self.copies[nth]);
    }

    fn run(&mut self, nth: usize) {
        (self.run)(black_box(&mut self.copies[nth]));
    }
}

/// Returns the time of the runs of `series` on copies of size `bytes`, as [`ReusedCopies::time`].
/// `last_ns` is the time of the last run.
fn time_changing(
    copies: &mut dyn Change,
    last_ns: &mut f64,
    series: &Series<'_>,
    bytes: usize,
) -> Time {
    let untimed = Series {
        start: Start::Warm,
        runs: series.untimed,
        ..*series
    };
    run_all(copies, last_ns, &untimed, bytes);
    let least = match series.start {
        Start::Warm => copy_count(*last_ns, bytes) as u32,
        Start::Cold(_) | Start::FreshPages => 1,
    };
    if 0 < series.untimed && series.untimed < least {
        // Each of the copies needs untimed runs, with the results of the others still held:
        // otherwise a timed run could be the first to touch the pages of its result.
        let all = Series {
            runs: least,
            ..untimed
        };
        run_all(copies, last_ns, &all, bytes);
    }
    let enough = Series {
        runs: series.runs.max(least),
        ..*series
    };
    let time = run_all(copies, last_ns, &enough, bytes);
    time.scaled(f64::from(series.runs) / f64::from(enough.runs))
}

/// Returns the time of the timed runs, on as many copies as [`copy_count`] allows.
fn run_all(copies: &mut dyn Change, last_ns: &mut f64, series: &Series<'_>, bytes: usize) -> Time {
    let fresh = matches!(series.start, Start::FreshPages);
    let mut total = Time::zero_like(series.clock.now());
    let mut left = series.runs as usize;
    while left > 0 {
        let count = copy_count(*last_ns, bytes).min(left);
        // New copies need no reset.
        for nth in 0..copies.count().min(count) {
            copies.reset(nth);
        }
        while copies.count() < count {
            let nth = copies.count();
            copies.add();
            if nth > 0 && !fresh {
                // This untimed run grows the tables of the copy.
                copies.run(nth);
                copies.reset(nth);
            }
        }
        let time = series.timed(|| {
            for nth in 0..count {
                copies.run(nth);
            }
        });
        *last_ns = time.ns() / count as f64;
        total = total.plus(time);
        left -= count;
    }
    total
}

/// Runs `make` as `series` describes. Results have size `bytes` and are dropped outside the timing.
/// Returns the total time of the timed runs, and a result if there was a run.
pub fn time_making<T>(
    series: &Series<'_>,
    bytes: usize,
    make: impl Fn() -> T,
) -> (Time, Option<T>) {
    let mut slots = ReusedCopies::default();
    let time = slots.time(
        series,
        bytes,
        || None,
        |made| *made = None,
        |made| *made = Some(black_box(make())),
    );
    (time, slots.copies.pop().flatten())
}

/// Returns the number of copies of size `bytes` for runs of `ns` nanoseconds.
fn copy_count(ns: f64, bytes: usize) -> usize {
    if ns <= 0.0 || ns >= MIN_TIMED_NS {
        return 1;
    }
    let fit = (second_level_bytes() / 2 / bytes.max(64)).max(1);
    ((MIN_TIMED_NS / ns).ceil() as usize).min(fit)
}

/// Returns true if `bytes` is larger than the second-level cache.
pub fn exceeds_second_level(bytes: usize) -> bool {
    bytes > second_level_bytes()
}

pub(crate) fn second_level_bytes() -> usize {
    static BYTES: OnceLock<usize> = OnceLock::new();
    *BYTES.get_or_init(|| {
        let known = level_bytes(&caches(), 2).and_then(|bytes| usize::try_from(bytes).ok());
        known.unwrap_or(USUAL_SECOND_LEVEL)
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[derive(Default)]
    struct ManualClock(Mutex<f64>);

    impl ManualClock {
        fn advance(&self, ns: f64) {
            *self.0.lock().expect("no panics") += ns;
        }
    }

    impl Clock for ManualClock {
        fn now(&self) -> Time {
            Time::from_wall_ns(*self.0.lock().expect("no panics"))
        }
    }

    #[test]
    fn each_run_gets_a_reset_copy_and_only_runs_are_timed() {
        for ns in [100_000.0, 20_000.0, 1_000.0] {
            let clock = ManualClock::default();
            let mut copies = ReusedCopies::default();
            let bytes = USUAL_SECOND_LEVEL / 16;
            for runs in [1, 50] {
                let series = Series::with_runs(runs, &clock).with_untimed(2);
                let time = copies.time(
                    &series,
                    bytes,
                    || 0, // the initial state
                    |copy| {
                        clock.advance(1e9); // the reset takes long and must not be counted
                        *copy = 0;
                    },
                    |copy| {
                        assert_eq!(*copy, 0, "reset");
                        *copy = 1;
                        clock.advance(ns);
                    },
                );
                assert_eq!(time.wall_ns, ns * f64::from(runs));
                let enough = copy_count(ns, bytes);
                assert_eq!(copies.copies.len(), enough, "{runs} runs of {ns} ns");
            }
            assert_eq!(copies.used_copy(), Some(&1));
        }
    }

    #[test]
    fn all_results_of_a_short_sample_were_held_at_once_before() {
        let clock = ManualClock::default();
        let mut slots = ReusedCopies::default();
        let held = Mutex::new(0);
        let mut held_after_runs = Vec::new();
        let series = Series::once(&clock).with_untimed(1);
        let reset = |made: &mut bool| {
            *held.lock().expect("no panics") -= i32::from(*made);
            *made = false;
        };
        let run = |made: &mut bool| {
            clock.advance(20_000.0);
            *made = true;
            *held.lock().expect("no panics") += 1;
            held_after_runs.push(*held.lock().expect("no panics"));
        };
        slots.time(&series, 64, || false, reset, run);
        let (untimed, timed) = held_after_runs.split_at(held_after_runs.len() - 3);
        assert_eq!(timed, [1, 2, 3]);
        assert_eq!(untimed.iter().max(), Some(&3), "{untimed:?}");
    }

    #[test]
    fn a_cold_start_has_no_more_runs_than_were_asked_for() {
        let clock = ManualClock::default();
        let flusher = CacheFlusher::new();
        let mut copies = ReusedCopies::default();
        let mut count_runs = |start: Start<'_>| {
            let mut runs = 0;
            let series = Series {
                start,
                ..Series::with_runs(2, &clock)
            };
            let run = |_: &mut ()| {
                clock.advance(1_000.0);
                runs += 1;
            };
            let time = copies.time(&series, 64, || (), |_| {}, run);
            assert_eq!(time.wall_ns, 2_000.0);
            runs
        };
        assert_eq!(count_runs(Start::Cold(&flusher)), 2);
        assert_eq!(count_runs(Start::FreshPages), 2);
        // The 58 missing copies need one run each to become equal to the first two copies.
        assert_eq!(count_runs(Start::Warm), 60 + 58);
    }

    #[test]
    fn short_runs_are_timed_together_if_copies_fit_the_cache() {
        assert_eq!(copy_count(0.0, 100), 1, "no time is known yet");
        assert_eq!(copy_count(70_000.0, 100), 1);
        assert_eq!(copy_count(20_000.0, 100), 3);
        assert_eq!(copy_count(20_000.0, 1 << 30), 1, "at least one");
    }

    #[test]
    fn flushing_writes_twice_the_last_level_cache_once() {
        let flusher = CacheFlusher::new();
        let known = last_level_bytes(&caches());
        assert_eq!(
            flusher.bytes() as u64,
            2 * known.unwrap_or(USUAL_LAST_LEVEL)
        );
        let clock = ManualClock::default();
        let series = Series {
            start: Start::Cold(&flusher),
            ..Series::with_runs(3, &clock).with_untimed(1)
        };
        let mut runs = 0;
        let before = flusher.words()[0];
        series.time_together(|| runs += 1);
        assert_eq!((runs, flusher.words()[0]), (4, before + 1));
    }
}
