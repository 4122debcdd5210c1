//! The plan of the samples on one mesh.

use sixfold::subdivision::{Method, Scheme};
use sixfold_workload::{
    Action, Backend, EditPlaceError, ElementKind, ElementSample, Operation, Run, Series,
};

use crate::pick::backend::{PassPlan, PickBackend};
use crate::pick::measurement::PickMeasurement;

/// Minimum time of a sample of the fastest backend. The clock cannot resolve shorter samples well.
const SHORTEST_SAMPLE_NS: f64 = 500_000.0;
/// Maximum time of a sample of the slowest backend. Longer samples would leave too few rounds.
const LONGEST_SAMPLE_NS: f64 = 20_000_000.0;
/// Maximum number of copies in a sample.
const MAX_COPIES: usize = 10_000;
/// Face counts of the patches from which the time of a pass is estimated.
const PATCHES: [usize; 2] = [256, 1024];
/// Number of operations in the first probe of a part.
const FIRST_PROBE_OPERATIONS: u64 = 4;

#[derive(Clone, Copy, Debug)]
pub(crate) struct SamplePlan {
    /// Number of turns in a sample.
    pub(crate) turns: u64,
    /// Number of copies in a sample, if there are edits.
    pub(crate) copies: usize,
}

impl PickMeasurement<'_> {
    /// Plans the number of turns in a sample. There are enough turns for the clock on the fastest
    /// backend, but not too many on the slowest. There are no more turns than places for edits.
    pub(crate) fn plan_samples(
        &self,
        backends: &mut [PickBackend<'_>],
    ) -> Result<SamplePlan, EditPlaceError> {
        let nothing = SamplePlan {
            turns: 0,
            copies: 1,
        };
        if self.schedule.elements().next().is_none() {
            return Ok(nothing);
        }
        let (mut least, mut most) = (f64::INFINITY, 1.0_f64);
        for backend in backends.iter_mut().filter(|b| !b.scans()) {
            backend.mixer.run(0, 1, 1, self.clock);
            let ns = backend.mixer.run(1, 1, 1, self.clock).time.ns().max(1.0);
            (least, most) = (least.min(ns), most.max(ns));
        }
        if !least.is_finite() {
            return Ok(nothing); // all backends scan
        }
        let turns = (SHORTEST_SAMPLE_NS / least).ceil();
        let turns = turns.min(LONGEST_SAMPLE_NS / most).max(1.0) as u64;
        let room = self.schedule.edits().filter_map(|part| {
            let places = backends.iter().map(|b| b.mixer.cycle_length(part)).min()?;
            // Each turn with edits needs places of its own.
            let fits = |turns: &u64| self.schedule.operations_within(part, *turns) <= places;
            (1..=turns).take_while(fits).last().or(Some(0))
        });
        let edits = self.schedule.edits().count();
        match room.min() {
            None => Ok(SamplePlan { turns, copies: 1 }),
            Some(0) => Err(EditPlaceError::TooSmall { edits }),
            Some(in_a_copy) => {
                let copies = turns.div_ceil(in_a_copy) as usize;
                Ok(SamplePlan {
                    turns: in_a_copy.min(turns),
                    copies: copies.clamp(1, MAX_COPIES),
                })
            }
        }
    }

    /// Plans which operation each pass runs on this backend, and how the pass is timed.
    pub(crate) fn plan_passes(&self, backend: &mut PickBackend<'_>, slot_ns: f64) {
        for part in self.schedule.passes() {
            let operation = match self.schedule.parts[part].action {
                Action::Pass(operation) => operation,
                _ => self.subdivision(backend.structure.as_ref()),
            };
            let scans = backend.mixer.scans()[part];
            let scans_kinds = |structure: Backend| operation.scans(&structure.info.costs);
            let scanned = backend.structure.map_or([false; 3], scans_kinds);
            let mut plan = PassPlan {
                operation: Some(operation),
                runs: 1,
                ..PassPlan::default()
            };
            if scans || scanned.contains(&true) {
                self.plan_search(backend, operation, scanned, slot_ns, &mut plan);
            } else {
                let grows = u32::from(operation.grows_tables());
                let series = Series::once(self.clock).with_untimed(grows).with_result();
                let run = backend.mixer.run_pass(operation, None, &series);
                backend.results[part] = run.outcome.map(|outcome| outcome.checksum);
                let ns = run.time.ns().max(1.0);
                plan.runs = (SHORTEST_SAMPLE_NS / ns).ceil().clamp(1.0, 1000.0) as u32;
            }
            backend.passes[part] = plan;
        }
    }

    /// Plans a pass that scans all faces for each element. If possible, the pass is run on a
    /// sample. If not, and if the pass takes too long, its time is estimated from patches.
    fn plan_search(
        &self,
        backend: &mut PickBackend<'_>,
        operation: Operation,
        scanned: [bool; 3],
        slot_ns: f64,
        plan: &mut PassPlan,
    ) {
        let mut run = |operation: Operation, sample: Option<ElementSample>| -> Run {
            let grows = u32::from(operation.grows_tables());
            let series = Series::once(self.clock).with_untimed(grows);
            backend.mixer.run_pass(operation, sample, &series)
        };
        if operation.can_be_sampled() || operation == Operation::FfBfs {
            // A walk over all faces is estimated from the relation that it queries.
            let probed = match operation.relations(ElementKind::Face) {
                &[relation] if !operation.can_be_sampled() => Operation::Relation(relation),
                _ => operation,
            };
            let mut size = FIRST_PROBE_OPERATIONS as usize;
            loop {
                let sample = ElementSample { scanned, size };
                let start = self.now();
                let whole = run(probed, Some(sample)).time;
                let elapsed_ns = self.now() - start;
                if elapsed_ns * 4.0 > slot_ns / 4.0 || size >= self.counts.edges {
                    plan.sample = Some(sample);
                    plan.operation = Some(probed);
                    if probed != operation {
                        plan.estimate = Some(whole);
                    }
                    return;
                }
                size *= 4;
            }
        }
        // The times of the two patches give the power of n with which the time grows.
        let [small, large] = PATCHES.map(|size| {
            let patch = ElementSample {
                scanned: [false; 3],
                size,
            };
            let size = size.min(self.counts.faces) as f64;
            // `run_pass` scales the time of a patch to the whole mesh. The division undoes this.
            run(operation, Some(patch))
                .time
                .scaled(size / self.counts.faces as f64)
        });
        let power = (large.ns() / small.ns()).log(4.0).clamp(1.0, 2.0);
        let growth = (self.counts.faces as f64 / PATCHES[1] as f64)
            .max(1.0)
            .powf(power);
        let whole = large.scaled(growth);
        if whole.ns() > slot_ns {
            plan.estimate = Some(whole);
        }
    }

    /// Returns one subdivision step by the best method of a structure; of relation tables if
    /// `None`.
    fn subdivision(&self, structure: Option<&Backend>) -> Operation {
        let triangles = self.study_mesh.polygons.first_polygon().is_none();
        let scheme = match triangles {
            true => Scheme::Loop,
            false => Scheme::CatmullClark,
        };
        let method = structure.and_then(|s| s.info.support(scheme).default_method());
        let method = method.unwrap_or(Method::Scatter);
        match triangles {
            true => Operation::Loop(method),
            false => Operation::CatmullClark(method),
        }
    }

    /// Plans the number of operations in a sample of each part alone. Also records the results of
    /// the operations on all elements.
    pub(crate) fn plan_parts(&self, backend: &mut PickBackend<'_>, slot_ns: f64) {
        let scans = backend.mixer.scans();
        for part in self.schedule.elements() {
            let cycle = backend.mixer.cycle_length(part).max(1);
            let longest = if scans[part] {
                slot_ns / 8.0
            } else {
                SHORTEST_SAMPLE_NS
            };
            let is_edit = matches!(self.schedule.parts[part].action, Action::Edit(_));
            let mut operations = FIRST_PROBE_OPERATIONS.min(cycle);
            loop {
                let run = backend.mixer.run_part(part, 0, operations, self.clock);
                let enough = run.time.ns() * 4.0 > longest;
                if enough || (is_edit && operations >= cycle) || operations > 1 << 24 {
                    break;
                }
                operations *= 4;
                if is_edit {
                    operations = operations.min(cycle);
                }
            }
            backend.part_operations[part] = operations;
            if !scans[part] && !is_edit {
                let all = backend.mixer.run_part(part, 0, cycle, self.clock);
                backend.results[part] = Some(all.yielded as f64);
            }
        }
    }
}
