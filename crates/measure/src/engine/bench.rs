//! The bench on which every lab measures: the machine, its heap and caches, and what the results tell
//! about these.
//!
//! A lab builds backends, puts them into the columns of a trial, and chooses the tasks (the entries).
//! [`Bench::measure`] measures the trial in rounds, compares the checksums, and judges the samples.
//! One backend takes part twice, which shows the noise. What is left for the lab is its conclusion.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::pages::HeapPolicyConflict;
use crate::{Clock, Operation, TimedBackend};
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use sixfold::{PolygonMesh, QueryCost};
use sixfold_core::Counts;
use sixfold_results::{
    Agreement, Confidence, Control, Refusal, ResultRow, Run, RunSettings, Samples,
};
use sixfold_results::{Timer, corrected_times, noise};

use crate::engine::agreement::compare_checksums;
use crate::engine::control::control;
use crate::engine::effort::Effort;
use crate::engine::heap::Memory;
use crate::engine::machine::Machine;
use crate::engine::measure::{Entry, Measurement, Progress};
use crate::engine::rows::Group;
use crate::engine::run::start_run;
use crate::engine::timer;

/// What a lab measures with.
pub struct Bench<'m> {
    pub machine: &'m dyn Machine,
    /// The heap and the caches.
    pub memory: Memory,
    /// Ends the measurement when set.
    pub stop: &'m AtomicBool,
    run: Run,
    timer: Timer,
}

impl<'m> Bench<'m> {
    /// Starts the heap and the caches as `settings` say. `needed` is the approximate peak memory of the
    /// measurements in bytes.
    ///
    /// # Errors
    ///
    /// Returns an error if another heap policy is active in this process.
    pub fn start(
        machine: &'m dyn Machine,
        settings: RunSettings,
        needed: u64,
        stop: &'m AtomicBool,
    ) -> Result<Self, HeapPolicyConflict> {
        let memory = machine.start_memory(settings.heap, settings.caches, needed)?;
        Ok(Self {
            machine,
            memory,
            stop,
            run: start_run(settings),
            timer: timer::measure(machine.clock()),
        })
    }

    /// Returns the clock of all times.
    pub fn clock(&self) -> &'m dyn Clock {
        self.machine.clock()
    }

    /// Returns the confidence of the intervals.
    pub fn confidence(&self) -> Confidence {
        self.run.settings.confidence
    }

    /// Returns whether the measurement has to end.
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Describes the run, with the heap and the caches that are in force.
    pub fn run(&self) -> Run {
        let mut run = self.run.clone();
        run.environment.heap = Some(self.memory.heap());
        run.environment.cache_state = Some(self.memory.caches());
        run
    }

    /// Describes the clock. `shortest_ns` is the shortest time that it measured.
    pub fn timer(&self, shortest_ns: Option<f64>) -> Timer {
        self.timer.with_shortest(shortest_ns)
    }

    /// Measures a trial. Returns early, with the finished part, if `stop` is set.
    pub fn measure<'s>(
        &mut self,
        trial: Trial<'s>,
        progress: &mut dyn FnMut(Progress<'_>),
    ) -> TrialResult<'s> {
        let Trial {
            polygons,
            counts,
            skewed,
            mut columns,
            entries,
            effort,
            named,
            forced,
            untimed,
            seed,
        } = trial;
        let (stop, clock, confidence) = (self.stop, self.clock(), self.confidence());
        let mut measurement = Measurement {
            machine: self.machine,
            memory: &mut self.memory,
            stop,
            progress,
            counts,
            skewed,
            effort,
            named,
            forced,
            untimed,
            random: ChaCha8Rng::seed_from_u64(seed),
            subjects: &mut columns.subjects,
            control: columns.control.map(|[_, second]| second),
        };
        let entries = measurement.measure(entries);
        let interrupted = self.stopped();
        let control = columns.control.and_then(|[first, second]| {
            let name = columns.subjects[first].name();
            control(&entries, first, second, name, confidence)
        });
        let second = columns.control.map(|[_, second]| second);
        let (second, entries): (Vec<Entry>, Vec<Entry>) =
            entries.into_iter().partition(|e| Some(e.subject) == second);
        let subjects = &mut columns.subjects;
        TrialResult {
            agreements: compare_checksums(&entries, subjects, polygons, clock, stop),
            times: corrected(&entries),
            polygons,
            columns,
            entries,
            second,
            control,
            confidence,
            interrupted,
        }
    }
}

/// What is measured together: backends of one mesh, and the tasks that they run.
pub struct Trial<'s> {
    pub polygons: &'s PolygonMesh,
    pub counts: Counts,
    /// Whether some valence or degree is so large that walking around it is as slow as a scan.
    pub skewed: bool,
    pub columns: Columns<'s>,
    /// The tasks of all columns; those of one task are adjacent.
    pub entries: Vec<Entry>,
    /// How much is measured.
    pub effort: Effort,
    /// Whether the operations were requested by name.
    pub named: bool,
    /// Whether all operations are run at any price.
    pub forced: bool,
    /// The number of untimed runs before each sample; `None` if the measurement chooses it.
    pub untimed: Option<u32>,
    /// Seed of the order of the measurements.
    pub seed: u64,
}

/// Built backends that are measured together.
pub struct Columns<'s> {
    /// The backends; the second copy of the control comes last.
    pub subjects: Vec<Box<dyn TimedBackend + 's>>,
    /// The indices of a backend and of its second copy.
    pub control: Option<[usize; 2]>,
}

impl<'s> Columns<'s> {
    /// Makes columns of `subjects`. `build_again` builds the second copy of the subject with the
    /// given index: of the first one that never scans all faces, because scans are slow and steady.
    /// `others` take no part in the choice.
    pub fn new(
        mut subjects: Vec<Box<dyn TimedBackend + 's>>,
        others: Vec<Box<dyn TimedBackend + 's>>,
        build_again: impl FnOnce(usize) -> Option<Box<dyn TimedBackend + 's>>,
    ) -> Self {
        let scans = |subject: &dyn TimedBackend| subject.costs().contains(&QueryCost::Scan);
        let first = subjects.iter().position(|subject| !scans(subject.as_ref()));
        let first = first.unwrap_or(0);
        subjects.extend(others);
        let again = build_again(first);
        let control = again.is_some().then_some([first, subjects.len()]);
        subjects.extend(again);
        Self { subjects, control }
    }

    /// Makes columns of `subjects`, without a control.
    pub fn without_control(subjects: Vec<Box<dyn TimedBackend + 's>>) -> Self {
        Self {
            subjects,
            control: None,
        }
    }

    /// Returns an entry for each of `operations` on each column.
    pub fn entries(&self, operations: &[Operation]) -> Vec<Entry> {
        let of_operation =
            |&operation| (0..self.subjects.len()).map(move |s| Entry::new(s, operation));
        operations.iter().flat_map(of_operation).collect()
    }
}

/// The result of a trial.
pub struct TrialResult<'s> {
    polygons: &'s PolygonMesh,
    pub columns: Columns<'s>,
    /// The tasks of all columns except the second copy of the control.
    pub entries: Vec<Entry>,
    /// The tasks of the second copy.
    pub second: Vec<Entry>,
    /// For each of `entries`, the time of a run, corrected for drift; `None` if it was not measured.
    pub times: Vec<Option<f64>>,
    /// For each of `entries`, whether its result is that of the other backends.
    pub agreements: Vec<Agreement>,
    /// The differences between the two copies; `None` without a control.
    pub control: Option<Control>,
    confidence: Confidence,
    /// Whether the measurement was stopped early.
    pub interrupted: bool,
}

impl TrialResult<'_> {
    /// Returns a row for each entry with a time or an estimate. Entries of the same task are compared
    /// with each other.
    pub fn rows(&self) -> Vec<ResultRow> {
        self.rows_by(|_| ())
    }

    /// Returns the same as [`rows`](Self::rows), but only entries with the same `key` are compared with
    /// each other. The entries of a task with the same key must be adjacent.
    pub fn rows_by<K: PartialEq>(&self, key: impl Fn(&Entry) -> K) -> Vec<ResultRow> {
        let mut rows = Vec::new();
        let mut from = 0;
        let same = |a: &Entry, b: &Entry| a.job.task == b.job.task && key(a) == key(b);
        for entries in self.entries.chunk_by(same) {
            let range = from..from + entries.len();
            from = range.end;
            let expected = entries[0].operation();
            let group = Group {
                entries,
                times: &self.times[range.clone()],
                agreements: &self.agreements[range],
                noise: noise(self.control.as_ref(), entries[0].name),
                confidence: self.confidence,
                expected: expected.map(|o| o.estimated_elements(self.polygons) as u64),
            };
            rows.extend(group.rows(&self.columns.subjects));
        }
        rows
    }

    /// Returns all samples, those of the second copy last.
    pub fn samples(&self) -> Vec<Samples> {
        let of = |control: bool| {
            move |entry: &Entry| {
                let backend = self.columns.subjects[entry.subject].name();
                entry.to_samples(backend, control)
            }
        };
        let first = self.entries.iter().filter_map(of(false));
        first
            .chain(self.second.iter().filter_map(of(true)))
            .collect()
    }

    /// Returns the operations that have no result on a backend.
    pub fn refusals(&self) -> Vec<Refusal> {
        let refusal = |entry: &Entry| {
            Some(Refusal {
                reason: entry.refusal.clone()?,
                backend: self.columns.subjects[entry.subject].name().into(),
                operation: entry.operation()?.name().into(),
                kind: entry.refusal_kind,
            })
        };
        self.entries.iter().filter_map(refusal).collect()
    }

    /// Returns the shortest time between two readings of the clock, in nanoseconds.
    pub fn shortest_ns(&self) -> Option<f64> {
        let shortest = self.entries.iter().filter_map(Entry::shortest_sample_ns);
        shortest.min_by(f64::total_cmp)
    }
}

/// Returns the corrected time of each entry. Entries of the same task must be adjacent.
fn corrected(entries: &[Entry]) -> Vec<Option<f64>> {
    let tasks = entries.chunk_by(|a, b| a.job.task == b.job.task);
    let times = tasks.map(|group| group.iter().map(Entry::times).collect::<Vec<_>>());
    times.flat_map(|times| corrected_times(&times)).collect()
}
