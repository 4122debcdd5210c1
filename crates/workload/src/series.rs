//! How often a job is run for one sample, and what is done before the clock starts.

use std::hint::black_box;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use crate::caches::{caches, last_level, level_bytes};
use crate::clock::{Clock, Time, timed};
use crate::pages;

/// The clock is stopped after work of at least about this length, where copies that fit the caches allow
/// it.
pub const LONG_ENOUGH_NS: f64 = 60_000.0;
/// The second-level cache where the platform does not tell its size.
const USUAL_SECOND_LEVEL: usize = 512 << 10;
/// The last-level cache where the platform does not tell its size.
const USUAL_LAST_LEVEL: u64 = 32 << 20;

/// What a timed stretch of work finds.
#[derive(Clone, Copy, Default)]
pub enum Start<'c> {
    /// Whatever the runs before have left: warm caches, and pages that stay with the process.
    #[default]
    Warm,
    /// Caches that hold other data.
    Cold(&'c Scrubber),
    /// A heap whose freed pages were returned to the kernel.
    FreshPages,
}

/// Data to fill the caches with.
pub struct Scrubber {
    words: Mutex<Vec<u64>>,
    level: Option<u8>,
}

impl Scrubber {
    /// Twice the size of the last-level cache.
    pub fn new() -> Self {
        let caches = caches();
        let bytes = last_level(&caches).unwrap_or(USUAL_LAST_LEVEL);
        let data = caches.iter().filter(|cache| cache.holds_data());
        Self {
            words: vec![1; 2 * bytes as usize / size_of::<u64>()].into(),
            level: data.map(|cache| cache.level).max(),
        }
    }

    /// How many bytes are written before each sample.
    pub fn bytes(&self) -> usize {
        size_of_val(&**self.words())
    }

    /// The last cache level, whose content is replaced; `None` where the platform does not tell.
    pub fn level(&self) -> Option<u8> {
        self.level
    }

    fn words(&self) -> MutexGuard<'_, Vec<u64>> {
        self.words.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes to all words, so that the caches hold them and nothing else.
    fn scrub(&self) {
        let words = &mut *self.words();
        words
            .iter_mut()
            .for_each(|word| *word = word.wrapping_add(1));
        black_box(words);
    }
}

impl Default for Scrubber {
    fn default() -> Self {
        Self::new()
    }
}

/// How a job is run for one sample.
#[derive(Clone, Copy)]
pub struct Series<'c> {
    /// How often before the timed runs, so that caches, tables and pages are as in the timed ones.
    pub untimed: u32,
    /// How often while the clock runs; at least once.
    pub runs: u32,
    /// What the timed runs find.
    pub start: Start<'c>,
    /// Whether the outcome is asked for.
    pub check: bool,
    /// What the time is taken from.
    pub clock: &'c dyn Clock,
}

impl<'c> Series<'c> {
    /// One timed run, with nothing before it.
    pub fn once(clock: &'c dyn Clock) -> Self {
        Self {
            untimed: 0,
            runs: 1,
            start: Start::Warm,
            check: false,
            clock,
        }
    }

    /// `runs` timed runs, with none before them.
    pub fn of_runs(runs: u32, clock: &'c dyn Clock) -> Self {
        Self {
            runs,
            ..Self::once(clock)
        }
    }

    /// The same, and the outcome is asked for.
    pub fn checked(self) -> Self {
        Self {
            check: true,
            ..self
        }
    }

    /// The same after `untimed` runs.
    pub fn after(self, untimed: u32) -> Self {
        Self { untimed, ..self }
    }

    /// Does what [`Start`] asks for.
    pub fn begin(&self) {
        match self.start {
            Start::Warm => {}
            Start::Cold(scrubber) => scrubber.scrub(),
            Start::FreshPages => pages::give_back(),
        }
    }

    /// The time of `work`, after what [`Start`] asks for.
    pub(crate) fn timed(&self, work: impl FnOnce()) -> Time {
        self.begin();
        timed(self.clock, work)
    }

    /// Runs `work` as often as the series says, all timed runs in one stretch: for work that leaves
    /// everything as it was. The time is that of all timed runs together.
    pub(crate) fn time_together(&self, mut work: impl FnMut()) -> Time {
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

/// Copies that runs change, put back in the state before while the clock stands still.
///
/// One copy is used unless a run is too short for the clock; then as many in turn as make a stretch of
/// 60 µs and fit half of the second-level cache together, so that a run finds its copy as warm as if it
/// were alone. The copies stay from one series to the next, and with them the capacity that their tables
/// have grown to.
#[derive(Debug)]
pub(crate) struct KeptCopies<T> {
    copies: Vec<T>,
    /// What the last run took, in nanoseconds; 0 before the first.
    last_ns: f64,
}

impl<T> Default for KeptCopies<T> {
    fn default() -> Self {
        Self {
            copies: Vec::new(),
            last_ns: 0.0,
        }
    }
}

impl<T> KeptCopies<T> {
    /// Runs `run` as often as `series` says, each time on a copy that `put_back` has put back while the
    /// clock stood still; `new` makes a copy where one is missing, and `bytes` is what one holds. The
    /// time is that of all timed runs together.
    pub(crate) fn time(
        &mut self,
        series: &Series<'_>,
        bytes: usize,
        new: impl Fn() -> T,
        mut put_back: impl FnMut(&mut T),
        mut run: impl FnMut(&mut T),
    ) -> Time {
        let untimed = Series {
            start: Start::Warm,
            runs: series.untimed,
            ..*series
        };
        self.run_all(&untimed, bytes, &new, &mut put_back, &mut run);
        self.run_all(series, bytes, &new, &mut put_back, &mut run)
    }

    /// The time of the timed runs of `series`, on as many copies in turn as [`in_turn`] allows.
    fn run_all(
        &mut self,
        series: &Series<'_>,
        bytes: usize,
        new: &impl Fn() -> T,
        put_back: &mut impl FnMut(&mut T),
        run: &mut impl FnMut(&mut T),
    ) -> Time {
        let fresh = matches!(series.start, Start::FreshPages);
        let mut total = Time::none_like(series.clock.now());
        let mut left = series.runs as usize;
        while left > 0 {
            let count = in_turn(self.last_ns, bytes).min(left);
            // Those that are made now need not be put back.
            let used = self.copies.len().min(count);
            self.copies[..used].iter_mut().for_each(&mut *put_back);
            while self.copies.len() < count {
                let mut copy = new();
                if !self.copies.is_empty() && !fresh {
                    // Its tables grow to what a run needs, as those of the first copy have.
                    run(&mut copy);
                    put_back(&mut copy);
                }
                self.copies.push(copy);
            }
            let copies = &mut self.copies[..count];
            let time = series.timed(|| {
                for copy in &mut *copies {
                    run(black_box(copy));
                }
            });
            self.last_ns = time.ns() / count as f64;
            total = total.plus(time);
            left -= count;
        }
        total
    }

    /// A copy as a run has left it, if there was one: all runs do the same.
    pub(crate) fn changed(&self) -> Option<&T> {
        self.copies.first()
    }
}

/// Makes results of `bytes` as often as `series` says, each dropped while the clock stands still. The time
/// is that of all timed runs together; with it comes one of the results, if there was a run.
pub(crate) fn time_making<T>(
    series: &Series<'_>,
    bytes: usize,
    make: impl Fn() -> T,
) -> (Time, Option<T>) {
    let mut places = KeptCopies::default();
    let time = places.time(
        series,
        bytes,
        || None,
        |made| *made = None,
        |made| *made = Some(black_box(make())),
    );
    (time, places.copies.pop().flatten())
}

/// How many copies of `bytes` each are used in turn, for runs of `ns`.
fn in_turn(ns: f64, bytes: usize) -> usize {
    static FITTING: OnceLock<usize> = OnceLock::new();
    let cache = *FITTING.get_or_init(|| {
        let known = level_bytes(&caches(), 2).and_then(|bytes| usize::try_from(bytes).ok());
        known.unwrap_or(USUAL_SECOND_LEVEL) / 2
    });
    if ns <= 0.0 || ns >= LONG_ENOUGH_NS {
        return 1;
    }
    let fit = (cache / bytes.max(64)).max(1);
    ((LONG_ENOUGH_NS / ns).ceil() as usize).min(fit)
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    /// A clock that shows what it is told.
    #[derive(Default)]
    struct Told(Mutex<f64>);

    impl Told {
        fn work(&self, ns: f64) {
            *self.0.lock().expect("no panics") += ns;
        }
    }

    impl Clock for Told {
        fn now(&self) -> Time {
            Time::of_wall(*self.0.lock().expect("no panics"))
        }
    }

    #[test]
    fn each_run_finds_its_copy_put_back_and_only_runs_are_timed() {
        for ns in [100_000.0, 20_000.0, 1_000.0] {
            let clock = Told::default();
            let mut copies = KeptCopies::default();
            let bytes = USUAL_SECOND_LEVEL / 16;
            for runs in [1, 50] {
                let series = Series::of_runs(runs, &clock).after(2);
                let time = copies.time(
                    &series,
                    bytes,
                    || 0, // made as it has to be
                    |copy| {
                        clock.work(1e9); // putting back takes long, and is not counted
                        *copy = 0;
                    },
                    |copy| {
                        assert_eq!(*copy, 0, "put back");
                        *copy = 1;
                        clock.work(ns);
                    },
                );
                assert_eq!(time.wall_ns, ns * f64::from(runs));
            }
            assert_eq!(copies.copies.len(), in_turn(ns, bytes));
            assert_eq!(copies.changed(), Some(&1));
        }
    }

    #[test]
    fn short_runs_share_a_stretch_as_far_as_copies_fit_the_cache() {
        assert_eq!(in_turn(0.0, 100), 1, "nothing is known yet");
        assert_eq!(in_turn(70_000.0, 100), 1);
        assert_eq!(in_turn(20_000.0, 100), 3);
        assert_eq!(in_turn(20_000.0, 1 << 30), 1, "one at least");
    }

    #[test]
    fn scrubbing_replaces_the_last_cache() {
        let scrubber = Scrubber::new();
        let known = last_level(&caches());
        assert_eq!(
            scrubber.bytes() as u64,
            2 * known.unwrap_or(USUAL_LAST_LEVEL)
        );
        let clock = Told::default();
        let series = Series {
            start: Start::Cold(&scrubber),
            ..Series::of_runs(3, &clock).after(1)
        };
        let mut runs = 0;
        let before = scrubber.words()[0];
        series.time_together(|| runs += 1);
        assert_eq!((runs, scrubber.words()[0]), (4, before + 1));
    }
}
