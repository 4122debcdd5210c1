//! The rounds of measurement on one mesh, and the ranking that results.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use sixfold_core::Counts;
use sixfold_workload::{Clock, Operation, Schedule, Series, Start, Time};

use crate::agreement::agree;
use crate::disturbance::{DisturbanceDetector, Verdict, undisturbed};
use crate::heap::Memory;
use crate::inspect::StudyMesh;
use crate::pick::backend::{PassPlan, PickBackend};
use crate::pick::break_even::break_even;
use crate::pick::plan::SamplePlan;
use crate::pick::report::{BreakEven, Excluded, PartCost, Ranked};
use crate::pick::{PickError, PickSettings};
use crate::ranking::{NO_DIFFERENCE, rank, ratio};
use crate::statistics::Median;

/// Maximum number of rounds.
const MAX_ROUNDS: u32 = 200;
/// Minimum number of rounds for a result.
const MIN_ROUNDS: u32 = 3;
/// Number of rounds in which building is timed, if the workload does not rebuild.
const BUILDS: usize = 9;
/// Part of the budget for timing each part alone and for the first builds.
const FOR_PARTS: f64 = 0.15;
/// Part of the budget for building on fresh pages.
const FOR_FIRST_BUILDS: f64 = 0.05;

pub(crate) struct PickMeasurement<'c> {
    pub(crate) study_mesh: &'c StudyMesh,
    pub(crate) settings: &'c PickSettings,
    pub(crate) counts: Counts,
    pub(crate) schedule: &'c Schedule,
    pub(crate) budget: Duration,
    pub(crate) clock: &'c dyn Clock,
    pub(crate) memory: &'c mut Memory,
    pub(crate) stop: &'c AtomicBool,
    pub(crate) progress: &'c mut dyn FnMut(f64, &str),
}

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

impl PickMeasurement<'_> {
    /// Measures `backends` and ranks them.
    pub(crate) fn run(
        mut self,
        mut backends: Vec<PickBackend<'_>>,
        excluded: Vec<Excluded>,
    ) -> Result<Outcome, PickError> {
        let start = self.now();
        let budget = self.budget.as_nanos() as f64;
        let deadline = start + budget;
        let rounds_end = deadline - FOR_PARTS * budget;
        (self.progress)(0.08, "warming up");
        let plan = self
            .plan_samples(&mut backends)
            .map_err(|reason| PickError::Impossible {
                mesh: self.study_mesh.name.clone(),
                reason,
            })?;
        let slot_ns = (rounds_end - self.now()).max(0.0) / 10.0 / backends.len().max(1) as f64;
        for backend in &mut backends {
            self.plan_passes(backend, slot_ns);
            self.plan_parts(backend, slot_ns);
        }
        self.memory.reserve();
        let mut detector = DisturbanceDetector::new(budget);
        let mut random = ChaCha8Rng::seed_from_u64(self.settings.seed);
        let mut order: Vec<usize> = (0..backends.len()).collect();
        let mut cost = 0.0;
        for round in 0..MAX_ROUNDS {
            let now = self.now();
            // The first round is always run, because it measures the time of a round.
            if self.stopped() || (round > 0 && now + cost > rounds_end) {
                break;
            }
            self.memory.check_free_memory();
            order.shuffle(&mut random);
            for &i in &order {
                if self.stopped() {
                    break;
                }
                let name = backends[i].mixer.name();
                let done = ((now - start) / budget).clamp(0.1, 1.0);
                (self.progress)(done, &format!("round {}, {name}", round + 1));
                self.sample(&mut detector, &mut backends[i], round, plan);
            }
            cost = cost.max(self.now() - now);
        }
        let rounds = backends.iter().map(|b| b.samples.len()).min().unwrap_or(0);
        if rounds < MIN_ROUNDS as usize && !backends.is_empty() && !self.stopped() {
            let preparing = (self.now() - start) - cost * rounds as f64;
            let needed = (preparing + f64::from(MIN_ROUNDS) * cost) / (1.0 - FOR_PARTS);
            return Err(PickError::BudgetTooSmall {
                mesh: self.study_mesh.name.clone(),
                budget: self.budget,
                needed_ms: (1.5 * needed / 1e8).ceil() as u64 * 100,
            });
        }
        for backend in &mut backends {
            backend.samples = undisturbed(&backend.samples, &backend.slowdowns);
        }
        self.time_parts(&mut backends, deadline - FOR_FIRST_BUILDS * budget);
        // First builds come last, because they return pages to the kernel. Other samples would
        // reuse these pages.
        self.time_first_builds(&mut backends, deadline);
        let shortest_ns = backends
            .iter()
            .filter_map(|b| shortest(b, plan, self.schedule));
        let shortest_ns = shortest_ns.min_by(f64::total_cmp);
        Ok(self.outcome(&backends, excluded, shortest_ns))
    }

    pub(crate) fn now(&self) -> f64 {
        self.clock.now().wall_ns
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn sample(
        &self,
        detector: &mut DisturbanceDetector,
        backend: &mut PickBackend<'_>,
        round: u32,
        plan: SamplePlan,
    ) {
        let kept = self.memory.keeps_pages();
        let taken = detector.take_sample(
            self.clock,
            || self.sample_once(backend, round, plan),
            |(time, _)| match self.stopped() {
                true => Verdict::Final,
                false => Verdict::on_faults(*time, kept),
            },
        );
        if !self.stopped() {
            let (time, build) = taken.value;
            backend.builds.extend(build);
            backend.samples.push((round, time));
            backend.slowdowns.push(taken.slowdown);
        }
    }

    fn sample_once(
        &self,
        backend: &mut PickBackend<'_>,
        round: u32,
        plan: SamplePlan,
    ) -> (Time, Option<Time>) {
        let mut total = Time::zero_like(self.clock.now());
        if self.schedule.on_elements > 0.0 {
            total = total.plus(if backend.scans() {
                self.time_part_by_part(backend, round)
            } else {
                self.time_mix(backend, round, plan)
            });
        }
        for part in self.schedule.passes() {
            let share = self.schedule.shares[part];
            total = total.plus(self.time_pass(backend, part).scaled(share));
        }
        let rebuilds = self.settings.workload.rebuilds_per_operation(&self.counts);
        let builds = rebuilds > 0.0 || backend.builds.len() < BUILDS;
        let build = builds.then(|| backend.mixer.build(&Series::once(self.clock)));
        if let Some(time) = build {
            total = total.plus(time.scaled(rebuilds));
        }
        (total, build)
    }

    /// Runs all parts on elements in one loop. Untimed turns come first. They bring the caches and
    /// branch predictors into the state that they have in a program.
    fn time_mix(&self, backend: &mut PickBackend<'_>, round: u32, plan: SamplePlan) -> Time {
        let SamplePlan { turns, copies } = plan;
        let at = u64::from(round) * turns;
        backend.mixer.run(at, turns, copies, self.clock);
        let run = backend.mixer.run(at + turns, turns, copies, self.clock);
        let operations = run.operations.max(1) as f64;
        run.time.scaled(self.schedule.on_elements / operations)
    }

    /// Runs a few operations of each part. A part that scans all faces dominates the time, so the
    /// state of the caches hardly matters.
    fn time_part_by_part(&self, backend: &mut PickBackend<'_>, round: u32) -> Time {
        let mut total = Time::zero_like(self.clock.now());
        for part in self.schedule.elements() {
            let operations = backend.part_operations[part];
            let first = u64::from(round) * operations;
            let run = backend.mixer.run_part(part, first, operations, self.clock);
            let each = run.time.scaled(1.0 / run.operations.max(1) as f64);
            total = total.plus(each.scaled(self.schedule.shares[part]));
        }
        total
    }

    /// Returns the time of the pass `part`. If the plan has an estimate, returns the estimate.
    fn time_pass(&self, backend: &mut PickBackend<'_>, part: usize) -> Time {
        let PassPlan {
            operation,
            runs,
            sample,
            estimate,
        } = backend.passes[part];
        if let Some(estimate) = estimate {
            return estimate;
        }
        let operation = operation.unwrap_or(Operation::Build);
        let untimed = u32::from(runs > 1 || operation.grows_tables());
        let series = Series::with_runs(runs, self.clock).with_untimed(untimed);
        backend.mixer.run_pass(operation, sample, &series).time
    }

    /// Builds every structure on fresh pages, in rounds, while there is time.
    fn time_first_builds(&self, backends: &mut [PickBackend<'_>], deadline: f64) {
        let mut longest = 0.0_f64;
        for _ in 0..BUILDS {
            let now = self.now();
            if self.stopped() || now + longest > deadline {
                return;
            }
            for backend in backends.iter_mut().filter(|b| !b.control) {
                let series = Series {
                    start: Start::FreshPages,
                    ..Series::once(self.clock)
                };
                let first = backend.mixer.build(&series);
                let later = backend
                    .mixer
                    .build(&Series::once(self.clock).with_untimed(1));
                backend.first_builds.push(first.ns() / later.ns().max(1.0));
            }
            longest = longest.max(self.now() - now);
        }
    }

    fn time_parts(&mut self, backends: &mut [PickBackend<'_>], deadline: f64) {
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
            for backend in backends.iter_mut().filter(|b| !b.control) {
                for part in 0..self.schedule.parts.len() {
                    let ns = if self.schedule.parts[part].action.is_pass() {
                        self.time_pass(backend, part).ns()
                    } else {
                        let operations = backend.part_operations[part];
                        let first = u64::from(round) * operations;
                        backend.mixer.run_part(part, first, operations, self.clock);
                        let first = first + operations;
                        let run = backend.mixer.run_part(part, first, operations, self.clock);
                        run.time.ns() / run.operations.max(1) as f64
                    };
                    backend.parts[part].push(ns);
                }
            }
            longest = longest.max(self.now() - now);
        }
    }

    /// Returns the backends whose results differ from the reference. The reference is the first
    /// backend that does not merge vertices.
    fn disagreeing(&self, backends: &[PickBackend<'_>]) -> Vec<String> {
        let keeps_vertices = |b: &&PickBackend<'_>| b.mixer.merged_vertices() == 0;
        let differs = |backend: &&PickBackend<'_>| {
            (0..self.schedule.parts.len()).any(|part| {
                let result = |b: &PickBackend<'_>| b.results[part];
                let reference = backends.iter().filter(keeps_vertices).find_map(result);
                let same = |(a, b): (f64, f64)| match backend.passes[part].operation {
                    Some(operation) => agree(operation, a, b, &self.study_mesh.polygons),
                    None => a == b,
                };
                result(backend)
                    .zip(reference)
                    .is_some_and(|both| !same(both))
            })
        };
        let names = backends.iter().filter(keeps_vertices).filter(differs);
        names.map(|b| b.mixer.name().to_owned()).collect()
    }

    fn outcome(
        &self,
        backends: &[PickBackend<'_>],
        excluded: Vec<Excluded>,
        shortest_ns: Option<f64>,
    ) -> Outcome {
        let control = backends.iter().find(|b| b.control);
        let noise = control.and_then(|control| {
            let same = |b: &&PickBackend<'_>| !b.control && b.mixer.name() == control.mixer.name();
            let original = backends.iter().find(same)?;
            let ratio = ratio(&control.samples, &original.samples)?.value;
            Some(ratio.max(ratio.recip()))
        });
        let ranked: Vec<&PickBackend<'_>> = backends
            .iter()
            .filter(|b| !b.control && !b.samples.is_empty())
            .collect();
        let times: Vec<Vec<(u32, Time)>> = ranked.iter().map(|b| b.samples.clone()).collect();
        let ranks = rank(&times, noise.unwrap_or(1.0).max(NO_DIFFERENCE));
        let rows = ranked.iter().zip(&ranks).filter_map(|(backend, rank)| {
            let rank = (*rank)?;
            let median = Median::from_samples(backend.samples.iter().map(|(_, time)| time.ns()))?;
            let build = Median::from_samples(backend.builds.iter().map(|time| time.ns()))?;
            let bytes = backend.mixer.bytes();
            let name = backend.mixer.name();
            let vertices = self.counts.vertices.max(1) as f64;
            Some(Ranked {
                backend: name.into(),
                made_from: backend.made_from.map(str::to_owned),
                ns_per_operation: median.value,
                ns_ci_low: median.interval.map(|[low, _]| low),
                ns_ci_high: median.interval.map(|[_, high]| high),
                ratio_to_best: rank.ratio.value,
                ci_low: rank.ratio.interval.map(|[low, _]| low),
                ci_high: rank.ratio.interval.map(|[_, high]| high),
                tied_with_best: rank.standing != crate::report::Standing::Slower,
                build_ns: build.value,
                first_build_ns: Median::from_samples(backend.first_builds.iter().copied())
                    .map(|ratio| ratio.value * build.value),
                bytes,
                bytes_per_vertex: bytes as f64 / vertices,
                sampled: backend.scans() || backend.passes.iter().any(|p| p.sample.is_some()),
                estimated: backend.passes.iter().any(|plan| plan.estimate.is_some()),
                parts: self.parts(backend),
                samples: backend.samples.len(),
                faults: backend
                    .samples
                    .iter()
                    .filter_map(|(_, time)| time.faults)
                    .max(),
                crates: backend
                    .mixer
                    .type_paths()
                    .into_iter()
                    .map(package_of)
                    .collect(),
                types: backend
                    .mixer
                    .type_paths()
                    .into_iter()
                    .map(str::to_owned)
                    .collect(),
            })
        });
        let mut ranking: Vec<Ranked> = rows.collect();
        ranking.sort_by(|a, b| a.ns_per_operation.total_cmp(&b.ns_per_operation));
        let operations = self.settings.workload.operations_on(&self.counts);
        Outcome {
            mesh: self.study_mesh.name.clone(),
            break_even: break_even(&ranked, &ranking, operations),
            ranking,
            excluded,
            noise,
            disagreeing: self.disagreeing(backends),
            operations,
            shortest_ns,
        }
    }

    fn parts(&self, backend: &PickBackend<'_>) -> Vec<PartCost> {
        let parts = self.schedule.parts.iter().enumerate();
        let cost = |(part, of): (usize, &sixfold_workload::Part)| PartCost {
            operation: of.action,
            share: self.schedule.shares[part],
            ns: Median::from_samples(backend.parts[part].iter().copied()).map(|m| m.value),
        };
        parts.map(cost).collect()
    }
}

/// Returns the shortest timed sample in nanoseconds; `None` without samples.
fn shortest(backend: &PickBackend<'_>, plan: SamplePlan, schedule: &Schedule) -> Option<f64> {
    if backend.scans() || schedule.on_elements <= 0.0 {
        return None;
    }
    let turns = plan.turns as f64 * plan.copies as f64;
    let operations = schedule.turn_operations * turns / schedule.on_elements;
    let times = backend
        .samples
        .iter()
        .map(|(_, time)| time.ns() * operations);
    times.min_by(f64::total_cmp)
}

/// Returns the package name from the path of a type.
fn package_of(type_path: &str) -> String {
    let (package, _) = type_path.split_once("::").unwrap_or((type_path, ""));
    package.replace('_', "-")
}
