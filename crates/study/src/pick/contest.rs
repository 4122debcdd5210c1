//! The rounds of measurement on one mesh, and the ranking that results.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use sixfold::subdivision::{Method, Scheme};
use sixfold::{Counts, support};
use sixfold_workload::{
    Action, Clock, Kind, NoPlace, Operation, Run, Sample, Script, Series, Start, Time,
};

use crate::agreement::agree;
use crate::gauge::{Gauge, Verdict, undisturbed};
use crate::heap::Memory;
use crate::inspect::Specimen;
use crate::pick::answer::{BreakEven, Excluded, PartCost, Ranked};
use crate::pick::break_even::break_even;
use crate::pick::entrant::{Entrant, PassPlan};
use crate::pick::{PickError, Question};
use crate::standing::{NO_DIFFERENCE, places, ratio};
use crate::statistics::Median;

/// The largest number of rounds. More rounds hardly narrow the intervals.
const MOST_ROUNDS: u32 = 200;
/// The smallest number of rounds for a result.
const FEWEST_ROUNDS: u32 = 3;
/// The shortest sample of the fastest backend. In shorter ones the resolution of the clock shows.
const SHORTEST_SAMPLE_NS: f64 = 500_000.0;
/// The longest sample of the slowest backend. Longer ones would leave too few rounds.
const LONGEST_SAMPLE_NS: f64 = 20_000_000.0;
/// Number of rounds in which building is timed; all rounds if the workload rebuilds.
const BUILDS: usize = 9;
/// Part of the budget after the rounds, for timing each part alone and for the first builds.
const FOR_PARTS: f64 = 0.15;
/// Part of the budget for building on fresh pages, at the end.
const FOR_FIRST_BUILDS: f64 = 0.05;
/// The largest number of copies in a sample. More do not improve it.
const MOST_COPIES: usize = 10_000;
/// Sizes of the patches, in faces, from which the time of a scanning pass is estimated.
const PATCHES: [usize; 2] = [256, 1024];
/// Number of operations in the first probe of a part.
const FEWEST_ASKED: u64 = 4;

/// The mesh, the question, and the means of measurement.
pub(crate) struct Contest<'c> {
    pub(crate) specimen: &'c Specimen,
    pub(crate) question: &'c Question,
    pub(crate) counts: Counts,
    pub(crate) script: &'c Script,
    pub(crate) budget: Duration,
    pub(crate) clock: &'c dyn Clock,
    pub(crate) memory: &'c mut Memory,
    pub(crate) stop: &'c AtomicBool,
    pub(crate) progress: &'c mut dyn FnMut(f64, &str),
}

/// The result of the measurement on one mesh.
pub(crate) struct Outcome {
    pub(crate) mesh: String,
    pub(crate) ranking: Vec<Ranked>,
    pub(crate) excluded: Vec<Excluded>,
    pub(crate) break_even: Vec<BreakEven>,
    pub(crate) noise: Option<f64>,
    /// Backends whose results differ from the others.
    pub(crate) disagreeing: Vec<String>,
    pub(crate) operations: f64,
    /// The shortest timed sample, in nanoseconds.
    pub(crate) shortest_ns: Option<f64>,
}

/// How the element operations are divided into samples.
#[derive(Clone, Copy, Debug)]
struct Slices {
    /// Number of turns in a sample.
    turns: u64,
    /// Number of copies that a sample runs on, if there are edits.
    copies: usize,
}

impl Contest<'_> {
    /// Measures `entrants` and ranks them.
    pub(crate) fn held(
        mut self,
        mut entrants: Vec<Entrant<'_>>,
        excluded: Vec<Excluded>,
    ) -> Result<Outcome, PickError> {
        let start = self.now();
        let budget = self.budget.as_nanos() as f64;
        let deadline = start + budget;
        let rounds_end = deadline - FOR_PARTS * budget;
        (self.progress)(0.08, "warming up");
        let slices = self
            .plan_slices(&mut entrants)
            .map_err(|reason| PickError::Impossible {
                mesh: self.specimen.name.clone(),
                reason,
            })?;
        let share = (rounds_end - self.now()).max(0.0) / 10.0 / entrants.len().max(1) as f64;
        for entrant in &mut entrants {
            self.plan_passes(entrant, share);
            self.plan_parts(entrant, share);
        }
        self.memory.reserve();
        let mut gauge = Gauge::new(budget);
        let mut random = ChaCha8Rng::seed_from_u64(self.question.seed);
        let mut order: Vec<usize> = (0..entrants.len()).collect();
        let mut cost = 0.0;
        for round in 0..MOST_ROUNDS {
            let now = self.now();
            // The first round is always run: it gives the time of a round.
            if self.stopped() || (round > 0 && now + cost > rounds_end) {
                break;
            }
            self.memory.watch();
            order.shuffle(&mut random);
            for &i in &order {
                if self.stopped() {
                    break;
                }
                let label = entrants[i].mixer.name();
                let done = ((now - start) / budget).clamp(0.1, 1.0);
                (self.progress)(done, &format!("round {}, {label}", round + 1));
                self.sample(&mut gauge, &mut entrants[i], round, slices);
            }
            cost = cost.max(self.now() - now);
        }
        let rounds = entrants.iter().map(|e| e.samples.len()).min().unwrap_or(0);
        if rounds < FEWEST_ROUNDS as usize && !entrants.is_empty() && !self.stopped() {
            let preparing = (self.now() - start) - cost * rounds as f64;
            let needed = (preparing + f64::from(FEWEST_ROUNDS) * cost) / (1.0 - FOR_PARTS);
            return Err(PickError::BudgetTooSmall {
                mesh: self.specimen.name.clone(),
                budget: self.budget,
                needed_ms: (1.5 * needed / 1e8).ceil() as u64 * 100,
            });
        }
        for entrant in &mut entrants {
            entrant.samples = undisturbed(&entrant.samples, &entrant.slowdowns);
        }
        self.time_parts(&mut entrants, deadline - FOR_FIRST_BUILDS * budget);
        // Last, because it returns pages to the kernel that later samples would need.
        self.time_first_builds(&mut entrants, deadline);
        let shortest_ns = entrants
            .iter()
            .filter_map(|e| shortest(e, slices, self.script));
        let shortest_ns = shortest_ns.min_by(f64::total_cmp);
        Ok(self.outcome(&entrants, excluded, shortest_ns))
    }

    fn now(&self) -> f64 {
        self.clock.now().wall_ns
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Plans how many turns make a sample: enough for the clock on the fastest backend, not too
    /// many on the slowest, and no more than there are places for edits.
    fn plan_slices(&self, entrants: &mut [Entrant<'_>]) -> Result<Slices, NoPlace> {
        let nothing = Slices {
            turns: 0,
            copies: 1,
        };
        if self.script.elements().next().is_none() {
            return Ok(nothing);
        }
        let (mut least, mut most) = (f64::INFINITY, 1.0_f64);
        for entrant in entrants.iter_mut().filter(|e| !e.scans()) {
            entrant.mixer.run(0, 1, 1, self.clock);
            let ns = entrant.mixer.run(1, 1, 1, self.clock).time.ns().max(1.0);
            (least, most) = (least.min(ns), most.max(ns));
        }
        if !least.is_finite() {
            return Ok(nothing); // all backends scan
        }
        let turns = (SHORTEST_SAMPLE_NS / least).ceil();
        let turns = turns.min(LONGEST_SAMPLE_NS / most).max(1.0) as u64;
        let room = self.script.edits().filter_map(|part| {
            let places = entrants.iter().map(|e| e.mixer.cycle(part)).min()?;
            // More turns would need more places than there are.
            let fits = |turns: &u64| self.script.within(part, *turns) <= places;
            (1..=turns).take_while(fits).last().or(Some(0))
        });
        let edits = self.script.edits().count();
        match room.min() {
            None => Ok(Slices { turns, copies: 1 }),
            Some(0) => Err(NoPlace::TooSmall { edits }),
            Some(in_a_copy) => {
                let copies = turns.div_ceil(in_a_copy) as usize;
                Ok(Slices {
                    turns: in_a_copy.min(turns),
                    copies: copies.clamp(1, MOST_COPIES),
                })
            }
        }
    }

    /// Plans which operation each pass is on this backend, and how it is timed.
    fn plan_passes(&self, entrant: &mut Entrant<'_>, share: f64) {
        for part in self.script.passes() {
            let operation = match self.script.parts[part].action {
                Action::Pass(operation) => operation,
                _ => self.subdivision(entrant.mixer.name()),
            };
            let scans = entrant.mixer.scans()[part];
            let costs = sixfold::roster();
            let costs = costs.iter().find(|row| row.name == entrant.mixer.name());
            let scanned = costs.map_or([false; 3], |row| operation.scans(&row.costs));
            let mut plan = PassPlan {
                operation: Some(operation),
                runs: 1,
                ..PassPlan::default()
            };
            if scans || scanned.contains(&true) {
                self.plan_search(entrant, operation, scanned, share, &mut plan);
            } else {
                let grows = u32::from(operation.grows_tables());
                let series = Series::once(self.clock).after(grows).checked();
                let run = entrant.mixer.run_pass(operation, None, &series);
                entrant.found[part] = run.outcome.map(|outcome| outcome.checksum);
                let ns = run.time.ns().max(1.0);
                plan.runs = (SHORTEST_SAMPLE_NS / ns).ceil().clamp(1.0, 1000.0) as u32;
            }
            entrant.passes[part] = plan;
        }
    }

    /// Plans a pass that scans all faces for each element: on a sample of the elements, or, if it
    /// cannot be sampled and is too long, as an estimate from patches of the mesh.
    fn plan_search(
        &self,
        entrant: &mut Entrant<'_>,
        operation: Operation,
        scanned: [bool; 3],
        share: f64,
        plan: &mut PassPlan,
    ) {
        let mut run = |operation: Operation, sample: Option<Sample>| -> Run {
            let grows = u32::from(operation.grows_tables());
            let series = Series::once(self.clock).after(grows);
            entrant.mixer.run_pass(operation, sample, &series)
        };
        if operation.can_be_sampled() || operation == Operation::FfBfs {
            // A walk over all faces is estimated by the relation that it queries.
            let asked = match operation.relations(Kind::Face) {
                &[relation] if !operation.can_be_sampled() => Operation::Relation(relation),
                _ => operation,
            };
            let mut size = FEWEST_ASKED as usize;
            loop {
                let sample = Sample { scanned, size };
                let start = self.now();
                let whole = run(asked, Some(sample)).time;
                let took = self.now() - start;
                if took * 4.0 > share / 4.0 || size >= self.counts.edges {
                    plan.sample = Some(sample);
                    plan.operation = Some(asked);
                    if asked != operation {
                        plan.estimate = Some(whole);
                    }
                    return;
                }
                size *= 4;
            }
        }
        // The times of the two patches give the power of n with which the time grows.
        let [small, large] = PATCHES.map(|size| {
            let patch = Sample {
                scanned: [false; 3],
                size,
            };
            let size = size.min(self.counts.faces) as f64;
            // `run_pass` scales the time of a patch to the whole mesh; this undoes it.
            run(operation, Some(patch))
                .time
                .scaled(size / self.counts.faces as f64)
        });
        let power = (large.ns() / small.ns()).log(4.0).clamp(1.0, 2.0);
        let growth = (self.counts.faces as f64 / PATCHES[1] as f64)
            .max(1.0)
            .powf(power);
        let whole = large.scaled(growth);
        if whole.ns() > share {
            plan.estimate = Some(whole);
        }
    }

    /// Returns one step of subdivision by the best method of a backend.
    fn subdivision(&self, backend: &str) -> Operation {
        let triangles = self.specimen.polygons.first_polygon().is_none();
        let scheme = match triangles {
            true => Scheme::Loop,
            false => Scheme::CatmullClark,
        };
        let rows = support(scheme);
        let row = rows.iter().find(|row| row.backend == backend);
        let method = row
            .and_then(sixfold::Support::best)
            .unwrap_or(Method::Scatter);
        match triangles {
            true => Operation::Loop(method),
            false => Operation::CatmullClark(method),
        }
    }

    /// Plans how many operations of each part make a sample of that part, and records what they
    /// yield on all elements.
    fn plan_parts(&self, entrant: &mut Entrant<'_>, share: f64) {
        let scans = entrant.mixer.scans();
        for part in self.script.elements() {
            let cycle = entrant.mixer.cycle(part).max(1);
            let longest = if scans[part] {
                share / 8.0
            } else {
                SHORTEST_SAMPLE_NS
            };
            let is_edit = matches!(self.script.parts[part].action, Action::Edit(_));
            let mut operations = FEWEST_ASKED.min(cycle);
            loop {
                let run = entrant.mixer.run_part(part, 0, operations, self.clock);
                let enough = run.time.ns() * 4.0 > longest;
                if enough || (is_edit && operations >= cycle) || operations > 1 << 24 {
                    break;
                }
                operations *= 4;
                if is_edit {
                    operations = operations.min(cycle);
                }
            }
            entrant.part_operations[part] = operations;
            if !scans[part] && !is_edit {
                let all = entrant.mixer.run_part(part, 0, cycle, self.clock);
                entrant.found[part] = Some(all.yielded as f64);
            }
        }
    }

    /// Takes a sample of the whole mix.
    fn sample(&self, gauge: &mut Gauge, entrant: &mut Entrant<'_>, round: u32, slices: Slices) {
        let kept = self.memory.keeps_pages();
        let taken = gauge.take(
            self.clock,
            || self.sample_once(entrant, round, slices),
            |(time, _)| match self.stopped() {
                true => Verdict::Final,
                false => Verdict::on_faults(*time, kept),
            },
        );
        if !self.stopped() {
            let (time, build) = taken.value;
            entrant.builds.extend(build);
            entrant.samples.push((round, time));
            entrant.slowdowns.push(taken.slowdown);
        }
    }

    /// Returns the time of one operation of the mix, and the building time if it was built.
    fn sample_once(
        &self,
        entrant: &mut Entrant<'_>,
        round: u32,
        slices: Slices,
    ) -> (Time, Option<Time>) {
        let mut total = Time::none_like(self.clock.now());
        if self.script.on_elements > 0.0 {
            total = total.plus(if entrant.scans() {
                self.part_by_part(entrant, round)
            } else {
                self.mixed(entrant, round, slices)
            });
        }
        for part in self.script.passes() {
            let share = self.script.shares[part];
            total = total.plus(self.pass(entrant, part).scaled(share));
        }
        let rebuilds = self.question.workload.rebuilds_per_operation(&self.counts);
        let builds = rebuilds > 0.0 || entrant.builds.len() < BUILDS;
        let build = builds.then(|| entrant.mixer.build(&Series::once(self.clock)));
        if let Some(time) = build {
            total = total.plus(time.scaled(rebuilds));
        }
        (total, build)
    }

    /// Runs all parts on elements in one loop. The preceding turns are run first, untimed, so that
    /// the caches are in the same state as in a program.
    fn mixed(&self, entrant: &mut Entrant<'_>, round: u32, slices: Slices) -> Time {
        let Slices { turns, copies } = slices;
        let at = u64::from(round) * turns;
        entrant.mixer.run(at, turns, 1, self.clock);
        let run = entrant.mixer.run(at + turns, turns, copies, self.clock);
        let operations = run.operations.max(1) as f64;
        run.time.scaled(self.script.on_elements / operations)
    }

    /// Runs a few operations of each part. If one part scans all faces, it dominates the others,
    /// and the state of the caches hardly matters.
    fn part_by_part(&self, entrant: &mut Entrant<'_>, round: u32) -> Time {
        let mut total = Time::none_like(self.clock.now());
        for part in self.script.elements() {
            let operations = entrant.part_operations[part];
            let first = u64::from(round) * operations;
            let run = entrant.mixer.run_part(part, first, operations, self.clock);
            let each = run.time.scaled(1.0 / run.operations.max(1) as f64);
            total = total.plus(each.scaled(self.script.shares[part]));
        }
        total
    }

    fn pass(&self, entrant: &mut Entrant<'_>, part: usize) -> Time {
        let PassPlan {
            operation,
            runs,
            sample,
            estimate,
        } = entrant.passes[part];
        if let Some(estimate) = estimate {
            return estimate;
        }
        let operation = operation.unwrap_or(Operation::Build);
        let untimed = u32::from(runs > 1 || operation.grows_tables());
        let series = Series::of_runs(runs, self.clock).after(untimed);
        entrant.mixer.run_pass(operation, sample, &series).time
    }

    /// Builds every structure on fresh pages, in rounds, while there is time.
    fn time_first_builds(&self, entrants: &mut [Entrant<'_>], deadline: f64) {
        let mut longest = 0.0_f64;
        for _ in 0..BUILDS {
            let now = self.now();
            if self.stopped() || now + longest > deadline {
                return;
            }
            for entrant in entrants.iter_mut().filter(|e| !e.control) {
                let series = Series {
                    start: Start::FreshPages,
                    ..Series::once(self.clock)
                };
                let first = entrant.mixer.build(&series);
                let later = entrant.mixer.build(&Series::once(self.clock).after(1));
                entrant.first_builds.push(first.ns() / later.ns().max(1.0));
            }
            longest = longest.max(self.now() - now);
        }
    }

    /// Times each part alone, in rounds, while there is time; at least once.
    fn time_parts(&mut self, entrants: &mut [Entrant<'_>], deadline: f64) {
        let start = self.now();
        let mut longest = 0.0_f64;
        for round in 0..9_u32 {
            let now = self.now();
            if self.stopped() || (round > 0 && now + longest > deadline) {
                return;
            }
            (self.progress)(
                0.9 + 0.1 * ((now - start) / (deadline - start).max(1.0)).clamp(0.0, 1.0),
                "timing each part",
            );
            for entrant in entrants.iter_mut().filter(|e| !e.control) {
                for part in 0..self.script.parts.len() {
                    let ns = if self.script.parts[part].action.is_a_pass() {
                        self.pass(entrant, part).ns()
                    } else {
                        let operations = entrant.part_operations[part];
                        let first = u64::from(round) * operations;
                        entrant.mixer.run_part(part, first, operations, self.clock);
                        let first = first + operations;
                        let run = entrant.mixer.run_part(part, first, operations, self.clock);
                        run.time.ns() / run.operations.max(1) as f64
                    };
                    entrant.parts[part].push(ns);
                }
            }
            longest = longest.max(self.now() - now);
        }
    }

    /// Returns the backends whose results differ from the first backend that does not merge
    /// vertices.
    fn disagreeing(&self, entrants: &[Entrant<'_>]) -> Vec<String> {
        let faithful = |e: &&Entrant<'_>| e.mixer.merged_vertices() == 0;
        let differs = |entrant: &&Entrant<'_>| {
            (0..self.script.parts.len()).any(|part| {
                let found = |e: &Entrant<'_>| e.found[part];
                let reference = entrants.iter().filter(faithful).find_map(found);
                let same = |(a, b): (f64, f64)| match entrant.passes[part].operation {
                    Some(operation) => agree(operation, a, b, &self.specimen.polygons),
                    None => a == b,
                };
                found(entrant)
                    .zip(reference)
                    .is_some_and(|both| !same(both))
            })
        };
        let names = entrants.iter().filter(faithful).filter(differs);
        names.map(|e| e.mixer.name().to_owned()).collect()
    }

    fn outcome(
        &self,
        entrants: &[Entrant<'_>],
        excluded: Vec<Excluded>,
        shortest_ns: Option<f64>,
    ) -> Outcome {
        let control = entrants.iter().find(|e| e.control);
        let noise = control.and_then(|control| {
            let same = |e: &&Entrant<'_>| !e.control && e.mixer.name() == control.mixer.name();
            let twin = entrants.iter().find(same)?;
            let ratio = ratio(&control.samples, &twin.samples)?.value;
            Some(ratio.max(ratio.recip()))
        });
        let ranked: Vec<&Entrant<'_>> = entrants
            .iter()
            .filter(|e| !e.control && !e.samples.is_empty())
            .collect();
        let times: Vec<Vec<(u32, Time)>> = ranked.iter().map(|e| e.samples.clone()).collect();
        let places = places(&times, noise.unwrap_or(1.0).max(NO_DIFFERENCE));
        let rows = ranked.iter().zip(&places).filter_map(|(entrant, place)| {
            let place = (*place)?;
            let median = Median::of(entrant.samples.iter().map(|(_, time)| time.ns()))?;
            let build = Median::of(entrant.builds.iter().map(|time| time.ns()))?;
            let bytes = entrant.mixer.bytes();
            let name = entrant.mixer.name();
            let vertices = self.counts.vertices.max(1) as f64;
            Some(Ranked {
                backend: name.into(),
                over: entrant.over.map(str::to_owned),
                ns_per_operation: median.value,
                ns_ci_low: median.interval.map(|[low, _]| low),
                ns_ci_high: median.interval.map(|[_, high]| high),
                ratio_to_best: place.ratio.value,
                ci_low: place.ratio.interval.map(|[low, _]| low),
                ci_high: place.ratio.interval.map(|[_, high]| high),
                tied_with_best: place.standing != crate::report::Standing::Slower,
                build_ns: build.value,
                first_build_ns: Median::of(entrant.first_builds.iter().copied())
                    .map(|ratio| ratio.value * build.value),
                bytes,
                bytes_per_vertex: bytes as f64 / vertices,
                sampled: entrant.scans() || entrant.passes.iter().any(|p| p.sample.is_some()),
                estimated: entrant.passes.iter().any(|plan| plan.estimate.is_some()),
                parts: self.parts(entrant),
                samples: entrant.samples.len(),
                faults: entrant
                    .samples
                    .iter()
                    .filter_map(|(_, time)| time.faults)
                    .max(),
                crates: entrant
                    .mixer
                    .type_paths()
                    .into_iter()
                    .map(package_of)
                    .collect(),
                types: entrant
                    .mixer
                    .type_paths()
                    .into_iter()
                    .map(str::to_owned)
                    .collect(),
            })
        });
        let mut ranking: Vec<Ranked> = rows.collect();
        ranking.sort_by(|a, b| a.ns_per_operation.total_cmp(&b.ns_per_operation));
        let operations = self.question.workload.operations_on(&self.counts);
        Outcome {
            mesh: self.specimen.name.clone(),
            break_even: break_even(&ranked, &ranking, operations),
            ranking,
            excluded,
            noise,
            disagreeing: self.disagreeing(entrants),
            operations,
            shortest_ns,
        }
    }

    fn parts(&self, entrant: &Entrant<'_>) -> Vec<PartCost> {
        let parts = self.script.parts.iter().enumerate();
        let cost = |(part, of): (usize, &sixfold_workload::Part)| PartCost {
            operation: of.action,
            share: self.script.shares[part],
            ns: Median::of(entrant.parts[part].iter().copied()).map(|m| m.value),
        };
        parts.map(cost).collect()
    }
}

/// Returns the time of the shortest sample of mixed turns, in nanoseconds; `None` without samples.
fn shortest(entrant: &Entrant<'_>, slices: Slices, script: &Script) -> Option<f64> {
    if entrant.scans() || script.on_elements <= 0.0 {
        return None;
    }
    let turns = slices.turns as f64 * slices.copies as f64;
    let operations = script.turn_operations * turns / script.on_elements;
    let times = entrant
        .samples
        .iter()
        .map(|(_, time)| time.ns() * operations);
    times.min_by(f64::total_cmp)
}

/// Returns the package of a type; its path begins with the name of the crate.
fn package_of(type_path: &str) -> String {
    let (package, _) = type_path.split_once("::").unwrap_or((type_path, ""));
    package.replace('_', "-")
}
