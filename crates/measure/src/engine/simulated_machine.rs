//! A machine for tests: its time passes only by simulated work.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use crate::{Clock, Job, MemorySpeed, Operation, Series, Start, Task, TimedBackend, TimedRun};
use sixfold::QueryCost;
use sixfold_core::Counts;
use sixfold_results::{CacheState, Policy, Time};

use crate::engine::disturbance::ReferenceWork;
use crate::engine::heap::Memory;
use crate::engine::machine::Machine;
use crate::pages::HeapPolicyConflict;

/// One run of a task on a whole mesh.
#[derive(Clone, Copy, Debug)]
pub struct Work<'w> {
    pub backend: &'w str,
    pub task: Task,
    pub counts: &'w Counts,
    /// How many backends were hosted before.
    pub place: usize,
}

impl Work<'_> {
    /// Returns whether a query of the operation scans the mesh.
    fn scans(&self) -> bool {
        let infos = sixfold::structure_infos();
        let info = infos.iter().find(|info| info.name == self.backend);
        let (Some(info), Some(operation)) = (info, self.task.operation()) else {
            return false;
        };
        operation.scans(&info.costs).contains(&true)
    }

    /// Returns the time of an operation, as on a machine that visits an element in 10 ns: making an
    /// element takes 500 ns, and a scan visits each face in 1 ns.
    pub fn usual_ns(&self) -> f64 {
        let faces = self.counts.faces as f64;
        let each_ns = match self.task.creates_mesh() {
            true => 500.0,
            false => 10.0,
        };
        match self.scans() {
            true => (each_ns + faces) * faces,
            false => each_ns * faces,
        }
    }
}

/// The time of the clock at the start. It is not 0, so that tests notice code that takes a time of
/// the clock for a duration.
const START_NS: f64 = (1_u64 << 33) as f64;

/// Returns the time of a run on a machine of speed 1 without disturbances, in nanoseconds.
type Costs = dyn Fn(&Work<'_>) -> f64 + Send + Sync;

/// A machine whose time passes only in [`work`](Self::work).
#[derive(Clone)]
pub struct SimulatedMachine {
    state: Arc<Mutex<State>>,
    /// `None` if the backends of a test advance the time themselves.
    costs: Option<Arc<Costs>>,
    speed: f64,
    drifts: bool,
}

#[derive(Default)]
struct State {
    ns: f64,
    /// The number of calls of `work`.
    steps: u64,
    /// The number of hosted backends.
    hosted: usize,
    /// Stalls that come: at which time, and for how long, in nanoseconds.
    stalls: Vec<[f64; 2]>,
}

/// A machine with slow drift (±50 %), jumps (1.8×) and stutters (1.6×).
impl Default for SimulatedMachine {
    fn default() -> Self {
        Self {
            drifts: true,
            ..Self::steady()
        }
    }
}

impl SimulatedMachine {
    /// A machine without disturbances, for backends that advance its time themselves.
    pub fn steady() -> Self {
        Self {
            state: Arc::default(),
            costs: None,
            speed: 1.0,
            drifts: false,
        }
    }

    /// A machine without disturbances, on which a run on a backend takes as long as `costs` says.
    pub fn with_costs(costs: impl Fn(&Work<'_>) -> f64 + Send + Sync + 'static) -> Self {
        Self {
            costs: Some(Arc::new(costs)),
            ..Self::steady()
        }
    }

    /// A machine without disturbances, on which operations take as long as [`Work::usual_ns`] says.
    pub fn usual() -> Self {
        Self::with_costs(|work| work.usual_ns())
    }

    /// A machine without disturbances, on which every run takes 10 µs.
    pub fn equal_costs() -> Self {
        Self::with_costs(|_| 10_000.0)
    }

    /// Makes the machine drift, jump and stutter.
    pub fn drifting(self) -> Self {
        Self {
            drifts: true,
            ..self
        }
    }

    /// Makes the machine `speed` times as fast.
    pub fn at_speed(self, speed: f64) -> Self {
        Self { speed, ..self }
    }

    /// Lets the machine stand still for `ns` nanoseconds when its time reaches `at_ns`.
    pub fn with_stall(self, at_ns: f64, ns: f64) -> Self {
        self.state().stalls.push([at_ns, ns]);
        self
    }

    /// Advances the time by work that takes `ns` nanoseconds on an undisturbed machine of speed 1.
    pub fn work(&self, ns: f64) {
        let state = &mut *self.state();
        state.steps += 1;
        let slowdown = match self.drifts {
            true => disturbance(state.steps),
            false => 1.0,
        };
        state.ns += ns * slowdown / self.speed;
        let now = state.ns;
        state.stalls.retain(|&[at_ns, length_ns]| {
            let comes_later = at_ns > now;
            if !comes_later {
                state.ns += length_ns;
            }
            comes_later
        });
    }

    fn next_place(&self) -> usize {
        let state = &mut *self.state();
        state.hosted += 1;
        state.hosted - 1
    }

    /// Returns the time since the start, in nanoseconds.
    pub fn ns(&self) -> f64 {
        self.state().ns
    }

    fn state(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().expect("no panics")
    }
}

fn disturbance(step: u64) -> f64 {
    let drift = 1.0 + 0.5 * (step as f64 / 900.0).sin();
    let stutter = if step.is_multiple_of(17) { 1.6 } else { 1.0 };
    let jump = if (step / 400).is_multiple_of(2) {
        1.0
    } else {
        1.8
    };
    drift * stutter * jump
}

impl Clock for SimulatedMachine {
    fn now(&self) -> Time {
        Time::from_wall_ns(START_NS + self.ns())
    }
}

impl Machine for SimulatedMachine {
    fn clock(&self) -> &dyn Clock {
        self
    }

    fn host<'b>(
        &self,
        built: Box<dyn TimedBackend + 'b>,
        counts: &Counts,
    ) -> Box<dyn TimedBackend + 'b> {
        let Some(costs) = &self.costs else {
            return built;
        };
        let hosted = SimulatedBackend {
            built,
            machine: self.clone(),
            costs: Arc::clone(costs),
            counts: *counts,
            place: self.next_place(),
            tried: Vec::new(),
        };
        self.work(hosted.cost_ns(Task::Operation(Operation::Build)));
        Box::new(hosted)
    }

    fn start_memory(
        &self,
        _: Policy,
        state: CacheState,
        _: u64,
    ) -> Result<Memory, HeapPolicyConflict> {
        Ok(Memory::simulated(state))
    }

    /// Takes no time, so that no moment counts as disturbed.
    fn reference_work(&self) -> ReferenceWork<'_> {
        Box::new(|_| ())
    }

    /// Measures the smallest buffer. Each reading of the clock takes 1 µs, and the memory no time.
    fn memory_speed(&self, _: Duration, stop: &AtomicBool) -> Option<MemorySpeed> {
        struct SlowReading<'m>(&'m SimulatedMachine);
        impl Clock for SlowReading<'_> {
            fn now(&self) -> Time {
                self.0.work(1000.0);
                self.0.now()
            }
        }
        MemorySpeed::measure(Duration::ZERO, &SlowReading(self), stop)
    }
}

/// A backend that gives the results of a real one, in the time that the machine says.
struct SimulatedBackend<'b> {
    built: Box<dyn TimedBackend + 'b>,
    machine: SimulatedMachine,
    costs: Arc<Costs>,
    counts: Counts,
    place: usize,
    /// The tasks that the real backend did not refuse.
    tried: Vec<Task>,
}

impl SimulatedBackend<'_> {
    /// Returns the time of a run on the whole mesh, in nanoseconds.
    fn cost_ns(&self, task: Task) -> f64 {
        (self.costs)(&Work {
            backend: self.built.name(),
            task,
            counts: &self.counts,
            place: self.place,
        })
    }

    /// Returns the part of the mesh on which `job` runs.
    fn part(&self, job: &Job) -> f64 {
        let Some(sample) = job.sample else { return 1.0 };
        let Counts {
            vertices,
            edges,
            faces,
            ..
        } = self.counts;
        let population = [vertices, edges, faces].into_iter().zip(sample.scanned);
        let scanned = population.filter_map(|(count, scanned)| scanned.then_some(count));
        let all = scanned.max().unwrap_or(faces);
        (sample.size as f64 / all.max(1) as f64).min(1.0)
    }
}

impl TimedBackend for SimulatedBackend<'_> {
    fn name(&self) -> &str {
        self.built.name()
    }

    fn costs(&self) -> [QueryCost; 9] {
        self.built.costs()
    }

    fn merged_vertices(&self) -> usize {
        self.built.merged_vertices()
    }

    fn bytes(&self) -> usize {
        self.built.bytes()
    }

    fn is_external(&self) -> bool {
        self.built.is_external()
    }

    fn can_sample(&self) -> bool {
        self.built.can_sample()
    }

    /// The real structure stays as it is: only its time passes.
    fn rebuild(&mut self) {
        self.machine
            .work(self.cost_ns(Task::Operation(Operation::Build)));
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        let mut outcome = None;
        if series.check || !self.tried.contains(&job.task) {
            let once = Series {
                untimed: 0,
                runs: 1,
                start: Start::Warm,
                ..*series
            };
            let run = self.built.run(job, &once);
            if run.refusal.is_some() {
                return run;
            }
            self.tried.push(job.task);
            outcome = run.outcome;
        }
        let part = self.part(job);
        let each_ns = self.cost_ns(job.task) * part;
        self.machine.work(each_ns * f64::from(series.untimed));
        let start = self.machine.now();
        self.machine.work(each_ns * f64::from(series.runs));
        let time = self.machine.now() - start;
        TimedRun::done(time.scaled(1.0 / (part * f64::from(series.runs))), outcome)
    }
}
