//! A trial: several built backends on one mesh, measured together in rounds. One backend takes part
//! twice, which shows the noise.

use std::sync::atomic::{AtomicBool, Ordering};

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use sixfold::QueryCost;
use sixfold_core::Counts;
use sixfold_workload::{Clock, Operation, TimedBackend};

use crate::engine::control::control;
use crate::engine::effort::Effort;
use crate::engine::heap::Memory;
use crate::engine::machine::Machine;
use crate::engine::measure::{Entry, Measurement, Progress, entries_of};
use sixfold_results::{Control, Samples};

/// What a trial measures on: the mesh, the machine and the limits.
pub(crate) struct Trial<'t> {
    pub(crate) counts: Counts,
    /// Whether some valence or degree is so large that walking around it is as slow as a scan.
    pub(crate) skewed: bool,
    pub(crate) machine: &'t dyn Machine,
    /// The heap and the caches.
    pub(crate) memory: &'t mut Memory,
    /// How much is measured.
    pub(crate) effort: Effort,
    /// Whether the operations were requested by name.
    pub(crate) named: bool,
    pub(crate) seed: u64,
    /// Ends the measurement when set.
    pub(crate) stop: &'t AtomicBool,
    pub(crate) progress: &'t mut dyn FnMut(Progress<'_>),
}

/// Built backends that are measured together.
pub(crate) struct Columns<'s> {
    /// The backends; the second copy of the control comes last.
    pub(crate) subjects: Vec<Box<dyn TimedBackend + 's>>,
    /// The indices of a backend and of its second copy.
    pub(crate) control: Option<[usize; 2]>,
}

/// The result of a trial.
pub(crate) struct Measured {
    /// The tasks of all columns except the second copy of the control.
    pub(crate) entries: Vec<Entry>,
    /// The tasks of the second copy.
    pub(crate) second: Vec<Entry>,
    /// The differences between the two copies; `None` without a control.
    pub(crate) control: Option<Control>,
    /// Whether the measurement was stopped early.
    pub(crate) interrupted: bool,
}

impl Measured {
    /// Returns all samples, those of the second copy last.
    pub(crate) fn samples(&self, columns: &Columns<'_>) -> Vec<Samples> {
        let of = |control: bool| {
            move |entry: &Entry| {
                let backend = columns.subjects[entry.subject].name();
                entry.to_samples(backend, control)
            }
        };
        let first = self.entries.iter().filter_map(of(false));
        first
            .chain(self.second.iter().filter_map(of(true)))
            .collect()
    }
}

impl<'s> Columns<'s> {
    /// Makes columns of `subjects`. `build_again` builds the second copy of the subject with the
    /// given index: of the first one that never scans all faces, because scans are slow and steady.
    /// `others` take no part in the choice.
    pub(crate) fn new(
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

    /// Returns an entry for each of `operations` on each column.
    pub(crate) fn entries(&self, operations: &[Operation]) -> Vec<Entry> {
        entries_of(self.subjects.len(), operations)
    }
}

impl<'t> Trial<'t> {
    /// Returns the clock of the machine.
    pub(crate) fn clock(&self) -> &'t dyn Clock {
        self.machine.clock()
    }

    /// Returns the numbers of vertices, edges and faces.
    pub(crate) fn population(&self) -> [usize; 3] {
        let Counts {
            vertices,
            edges,
            faces,
            ..
        } = self.counts;
        [vertices, edges, faces]
    }

    /// Measures `entries`, the tasks of `columns`; those of one task must be adjacent. Returns
    /// early, with the finished part, if `stop` is set.
    pub(crate) fn run(&mut self, columns: &mut Columns<'_>, entries: Vec<Entry>) -> Measured {
        let second = columns.control.map(|[_, second]| second);
        let mut measurement = Measurement {
            random: ChaCha8Rng::seed_from_u64(self.seed),
            trial: self,
            subjects: &mut columns.subjects,
            control: second,
        };
        let entries = measurement.measure(entries);
        let control = columns.control.and_then(|[first, second]| {
            control(&entries, first, second, columns.subjects[first].name())
        });
        let (second, entries) = entries.into_iter().partition(|e| Some(e.subject) == second);
        Measured {
            entries,
            second,
            control,
            interrupted: self.stop.load(Ordering::Relaxed),
        }
    }
}
