//! Ranks the backends for a program: an algorithm of a user, which runs on every structure.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::{
    Contestant, Job, MachineClock, Operation, ProgramRefusal, Series, Suite, SuiteProgram, Task,
    TimedBackend,
};
use sixfold::{QueryCost, UnknownName};
use sixfold_results::{
    Amount, AskedCount, Confidence, Excluded, OwnData, PartCost, PickReport, Policy, ProgramReport,
    RunSettings, Time, WorkloadReport,
};

use crate::engine::bench::Bench;
use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::engine::measure::Entry;
use crate::external::isolated::{ChildTask, Isolated, Isolation};
use crate::external::program::STOPPED;
use crate::pages::HeapPolicyConflict;
use crate::pick::break_even::MeasuredMix;
use crate::pick::measurement::{
    Candidate, MeasuredBackend, MeshOutcome, PickMeasurement, over_memory_limit,
};
use crate::pick::pooled::{Question, pooled};
use crate::pick::tasks::{TaskPlan, program_entry, with_own_time};
use crate::refusal;
use crate::study_mesh::StudyMesh;
use crate::study_mesh::patch;
use sixfold_results::numbers::{counted, duration, grouped};

/// Building is timed in every n-th round.
const BUILDS_EVERY: u32 = 3;

/// The share of the budget of a mesh that one run may take.
const LONGEST_RUN: f64 = 0.1;

/// The number of faces of the smallest patch on which the time of a run is estimated.
const SMALLEST_PATCH: usize = 256;

/// The settings of [`pick_for_programs`].
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramSettings {
    /// The names of the structures. If the list is empty, all structures are compared.
    pub backends: Vec<String>,
    /// The number of runs of the program on one mesh. The time to build a structure is divided by
    /// this number.
    pub runs: u64,
    /// The maximum size of a structure, in bytes; `None` for no limit.
    pub max_memory: Option<u64>,
    /// How much is measured. A time limit is for all programs and meshes together.
    pub effort: Effort,
    /// The confidence of all intervals.
    pub confidence: Confidence,
    /// Seed of the random numbers that choose the order of the measurements.
    pub seed: u64,
    /// What happens to freed memory pages during the measurement.
    pub heap: Policy,
    /// How each structure runs in a child process; `None` if all programs run in this process.
    pub isolation: Option<Isolation>,
}

impl Default for ProgramSettings {
    fn default() -> Self {
        Self {
            backends: Vec::new(),
            runs: 1,
            max_memory: None,
            effort: Effort::Budget(Duration::from_secs(20)),
            confidence: Confidence::default(),
            seed: 1,
            heap: Policy::Kept,
            isolation: None,
        }
    }
}

/// The reason why programs are not measured.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeasureError {
    /// The list of meshes is empty.
    #[error("the list of meshes is empty: give at least one mesh")]
    NoMesh,
    /// A mesh has no faces.
    #[error(
        "the mesh has no faces, so there is nothing to measure: choose another mesh, or see its facts with \
         `sixfold inspect`"
    )]
    NoFaces,
    /// The name of a structure is unknown.
    #[error(transparent)]
    UnknownBackend(#[from] UnknownName),
    /// A measurement with another heap policy is active in this process.
    #[error(transparent)]
    HeapPolicy(#[from] HeapPolicyConflict),
}

/// Measures each program of `suite` on each structure and each of `study_meshes`, and ranks the
/// structures. Returns one report for each program.
///
/// A structure on which a program panics, refuses the mesh or has a result that is not a number is
/// excluded, with the reason. A structure whose queries scan the mesh is excluded if one run would
/// take more than a tenth of the budget. Setting `stop` to true ends the measurement after the
/// current sample. `progress` is called with the finished part, from 0 to 1, and the current step.
/// `finished` is called with the report of each program.
///
/// The heap policy of `settings` applies to the whole process until the function returns; see
/// [`pages`](crate::pages#effect-on-the-process).
///
/// # Errors
///
/// Returns an error if `study_meshes` is empty, if a mesh has no faces, if the name of a structure is
/// unknown.
/// Also returns an error if another heap policy is active in this process.
pub fn pick_for_programs(
    study_meshes: &[StudyMesh],
    suite: &Suite,
    settings: &ProgramSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(f64, &str),
    finished: &mut dyn FnMut(&PickReport),
) -> Result<Vec<PickReport>, MeasureError> {
    let machine = MachineClock::start();
    pick_for_programs_on(
        &machine,
        study_meshes,
        suite,
        settings,
        stop,
        progress,
        finished,
    )
}

/// Does what [`pick_for_programs`] does, on `machine`.
pub fn pick_for_programs_on(
    machine: &dyn Machine,
    study_meshes: &[StudyMesh],
    suite: &Suite,
    settings: &ProgramSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(f64, &str),
    finished: &mut dyn FnMut(&PickReport),
) -> Result<Vec<PickReport>, MeasureError> {
    if study_meshes.is_empty() {
        return Err(MeasureError::NoMesh);
    }
    if study_meshes.iter().any(|m| m.polygons.face_count() == 0) {
        return Err(MeasureError::NoFaces);
    }
    settings.check_names(suite)?;
    let clock = machine.clock();
    let budget = Budget::start(settings.effort, clock);
    let programs = suite.programs();
    let steps = (programs.len() * study_meshes.len()).max(1);
    // Not a share of the time that is left: a slow program must not exclude structures of the next.
    let longest_run_ns = LONGEST_RUN * settings.effort.limit_ns() / steps as f64;
    let mut bench = Bench::start(machine, settings.run_settings(), 0, stop)?;
    let mut reports = Vec::new();
    for (i, program) in programs.iter().enumerate() {
        let mut outcomes = Vec::new();
        let mut asked = None;
        for (j, study_mesh) in study_meshes.iter().enumerate() {
            let step = i * study_meshes.len() + j;
            if stop.load(Ordering::Relaxed) && step > 0 {
                break;
            }
            let mesh_budget = Budget::start(budget.share(1.0, (steps - step) as f64), clock);
            let mut progress = |done: f64, what: &str| {
                let what = format!("{}: {what}", program.name());
                progress((step as f64 + done) / steps as f64, &what);
            };
            let isolated = settings
                .isolation
                .as_ref()
                .map(|isolation| (isolation, &*study_mesh.name));
            if isolated.is_none() && asked.is_none() {
                progress(0.0, "counting what it asks");
                asked = record(study_mesh, program, settings);
            }
            let conditions = Conditions {
                qualification: Qualification {
                    refusals: refusal::BuildInput::from_study_mesh(study_mesh),
                    longest_run_ns,
                    machine,
                },
                settings,
                isolated,
                stop,
            };
            outcomes.push(measure_mesh(
                study_mesh,
                program,
                &conditions,
                &mut asked,
                &mut bench,
                mesh_budget,
                &mut progress,
            ));
        }
        if outcomes.is_empty() {
            break;
        }
        let question = Question {
            workload: workload(program, settings.runs),
            program: Some(ProgramReport {
                kind: program.kind().to_owned(),
                asked,
            }),
            needs: Vec::new(),
            max_memory: settings.max_memory,
            excluded: Vec::new(),
        };
        let interrupted = stop.load(Ordering::Relaxed);
        let report = pooled(
            outcomes,
            question,
            bench.timer(None),
            bench.run(),
            interrupted,
        );
        finished(&report);
        reports.push(report);
    }
    Ok(reports)
}

/// Returns the description of the program in the place of a workload.
fn workload(program: &SuiteProgram, runs: u64) -> WorkloadReport {
    WorkloadReport {
        name: program.name().to_owned(),
        summary: format!("A program that {} the mesh.", program.kind()),
        access: "sequential".into(),
        operations: Amount::Number(runs as f64),
        rebuilds: 0,
        own_ns: program.own_ns(),
        own_data: OwnData::default(),
        mix: Vec::new(),
    }
}

impl ProgramSettings {
    pub fn chooses(&self, contestant: &Contestant) -> bool {
        self.backends.is_empty() || self.backends.iter().any(|n| n == contestant.name())
    }

    fn check_names(&self, suite: &Suite) -> Result<(), MeasureError> {
        let contestants = suite.programs().iter().flat_map(SuiteProgram::contestants);
        let known: BTreeSet<&str> = contestants.map(Contestant::name).collect();
        Ok(UnknownName::check("backend", &self.backends, known)?)
    }

    pub fn run_settings(&self) -> RunSettings {
        RunSettings {
            backends: self.backends.clone(),
            confidence: self.confidence,
            seed: self.seed,
            heap: self.heap,
            ..self.effort.run_settings()
        }
    }
}

/// Counts what the program asks, on the first structure that holds the mesh and does not scan it.
fn record(
    study_mesh: &StudyMesh,
    program: &SuiteProgram,
    settings: &ProgramSettings,
) -> Option<Vec<AskedCount>> {
    let contestants = program.contestants().iter();
    let local = contestants.filter(|c| settings.chooses(c) && is_local(c));
    let mut asked = local.filter_map(|c| c.record(&study_mesh.polygons)?.ok());
    Some(asked.next()?.counts())
}

pub fn is_local(contestant: &Contestant) -> bool {
    QueryCost::are_local(&contestant.info().costs)
}

/// Measures one program on one mesh.
fn measure_mesh(
    study_mesh: &StudyMesh,
    program: &SuiteProgram,
    conditions: &Conditions<'_>,
    asked: &mut Option<Vec<AskedCount>>,
    bench: &mut Bench<'_>,
    budget: Budget<'_>,
    progress: &mut dyn FnMut(f64, &str),
) -> MeshOutcome {
    let polygons = &study_mesh.polygons;
    let settings = conditions.settings;
    let chosen = program.contestants().iter().filter(|c| settings.chooses(c));
    let chosen: Vec<&Contestant> = chosen.collect();
    let mut backends = Vec::new();
    let mut excluded = Vec::new();
    let mut control = None;
    for (i, contestant) in chosen.iter().enumerate() {
        let done = 0.1 * i as f64 / chosen.len() as f64;
        progress(done, &format!("building {}", contestant.name()));
        match conditions.prepare(program, contestant, asked) {
            Ok(backend) => {
                if control.is_none() && is_local(contestant) && contestant.made_from().is_none() {
                    control = conditions.prepare(program, contestant, asked).ok();
                }
                backends.push(backend);
            }
            Err(refused) => excluded.push(refused),
        }
    }
    let plan = WholeProgram {
        runs: settings.runs.max(1) as f64,
        changes_mesh: program.changes_mesh(),
        own_ns: program.own_ns(),
    };
    let measurement = PickMeasurement {
        study_mesh,
        plan: &plan,
        seed: settings.seed,
        counts: polygons.counts(study_mesh.facts.edges),
        effort: budget.left(),
        bench,
        progress,
    };
    measurement.run(backends, control, excluded)
}

/// The conditions under which a structure takes part in the measurement on one mesh.
struct Conditions<'e> {
    qualification: Qualification<'e>,
    settings: &'e ProgramSettings,
    /// How programs run in child processes, and the name of the mesh; `None` if all programs run in this process.
    isolated: Option<(&'e Isolation, &'e str)>,
    stop: &'e AtomicBool,
}

impl<'e> Conditions<'e> {
    /// Builds a structure and the scratch data; the exclusion if the structure does not qualify. Puts
    /// what the program asks into `asked`, if a child process has to find this.
    fn prepare(
        &self,
        program: &SuiteProgram,
        contestant: &Contestant,
        asked: &mut Option<Vec<AskedCount>>,
    ) -> Result<MeasuredBackend<'e>, Excluded> {
        let backend: Box<dyn TimedBackend + 'e> = match &self.isolated {
            None => self.qualification.prepare(contestant)?,
            Some((isolation, mesh)) => {
                let task = ChildTask {
                    mesh: (*mesh).to_owned(),
                    program: program.name().to_owned(),
                    backend: contestant.name().to_owned(),
                    longest_run_ns: self
                        .qualification
                        .longest_run_ns
                        .is_finite()
                        .then_some(self.qualification.longest_run_ns as u64),
                    heap: self.settings.heap,
                    memory_limit: isolation.memory_limit,
                };
                let mut child = Isolated::start(isolation, &task, contestant, self.stop)?;
                if asked.is_none() && is_local(contestant) {
                    *asked = child.asked();
                }
                Box::new(child)
            }
        };
        let bytes = backend.bytes();
        if let Some(reason) = over_memory_limit(bytes as u64, self.settings.max_memory) {
            return Err(Excluded::new(contestant.name(), reason));
        }
        let candidate = Candidate {
            name: contestant.name().to_owned(),
            info: None,
            made_from: contestant.made_from().map(|structure| structure.name),
            type_paths: contestant.type_paths().to_vec(),
            tabulated: match (contestant.made_from(), backend.tabulated(), asked) {
                // A child process does not tell its tables.
                (Some(_), tabulated, Some(asked)) if tabulated.is_empty() => {
                    let names = asked.iter().map(|count| count.operation.as_str());
                    names.filter_map(|name| name.parse().ok()).collect()
                }
                (_, tabulated, _) => tabulated,
            },
            scans: Vec::new(),
            bytes,
        };
        Ok((candidate, backend))
    }
}

/// Decides whether a structure can hold a mesh and run a program in the available time.
pub struct Qualification<'e> {
    pub refusals: refusal::BuildInput<'e>,
    /// The longest time of one run on a structure that scans the mesh, in nanoseconds; infinity if
    /// there is no time limit.
    pub longest_run_ns: f64,
    pub machine: &'e dyn Machine,
}

impl<'e> Qualification<'e> {
    /// Builds a structure and the scratch data; the exclusion if the structure does not qualify.
    pub fn prepare(&self, contestant: &Contestant) -> Result<Box<dyn TimedBackend + 'e>, Excluded> {
        let name = contestant.name();
        if !is_local(contestant) && self.longest_run_ns.is_finite() {
            let checked = self.check_time(contestant);
            checked.map_err(|reason| Excluded::new(name, reason))?;
        }
        let prepared = contestant.prepare(self.refusals.polygons);
        let prepared = prepared.map(|built| self.machine.host(built, &self.refusals.counts));
        prepared.map_err(|refusal| match refusal {
            ProgramRefusal::Build(refusal) => {
                let capabilities = &contestant.info().capabilities;
                Excluded::new(name, self.refusals.reason(&refusal, capabilities))
            }
            ProgramRefusal::Refused(reason) => Excluded::new(name, reason),
            fault @ (ProgramRefusal::Panicked(_) | ProgramRefusal::NoResult(_)) => {
                Excluded::failed(name, fault.to_string())
            }
        })
    }

    /// Runs the program on patches of growing size; the reason if a run on the whole mesh would take
    /// too long. A query that scans the mesh makes the time grow with the square of the size.
    fn check_time(&self, contestant: &Contestant) -> Result<(), String> {
        let polygons = self.refusals.polygons;
        let faces = polygons.face_count();
        let mut size = SMALLEST_PATCH;
        while size < faces {
            let patch = patch(polygons, size);
            // A program may refuse a patch that it would not refuse as a part of the mesh.
            let Ok(built) = contestant.prepare(&patch) else {
                return Ok(());
            };
            // Almost all edges of a patch have two faces.
            let counts = patch.counts(patch.corner_count() / 2);
            let mut backend = self.machine.host(built, &counts);
            let series = Series::once(self.machine.clock());
            let run = backend.run(&Job::new(Task::Program), &series);
            if run.refusal.is_some() {
                return Ok(());
            }
            let growth = faces as f64 / patch.face_count().max(1) as f64;
            let expected = run.time.wall_ns * growth * growth;
            let longest = self.longest_run_ns;
            if expected <= longest {
                return Ok(());
            }
            // A larger patch gives a better estimate, if there is time for it.
            if 16.0 * run.time.wall_ns > longest {
                return Err(format!(
                    "a run would take about {}, estimated from a run on a patch of {}, but may take only {}: use {} \
                     times the --budget, fewer --launches, or a smaller mesh",
                    duration(expected),
                    counted(patch.face_count(), "face", "faces"),
                    duration(longest),
                    grouped((expected / longest).ceil() as usize),
                ));
            }
            size *= 4;
        }
        Ok(())
    }
}

/// The tasks of a program: building and a run.
struct WholeProgram {
    /// The number of runs in one use of the mesh.
    runs: f64,
    /// Whether a run changes the mesh.
    changes_mesh: bool,
    /// The time of the program's own work in a run.
    own_ns: f64,
}

impl TaskPlan for WholeProgram {
    fn entries(&self, candidates: &[Candidate]) -> Vec<Entry> {
        let columns = || 0..candidates.len();
        let runs = columns().map(|column| program_entry(column, self.changes_mesh));
        let builds = columns().map(|column| Entry {
            least_every: BUILDS_EVERY,
            ..Entry::new(column, Operation::Build)
        });
        runs.chain(builds).collect()
    }

    fn mix_times(
        &self,
        candidate: &Candidate,
        entries: &[&Entry],
    ) -> Result<Vec<(u32, Time)>, Excluded> {
        let Some(run) = entries.iter().find(|e| e.job.task == Task::Program) else {
            return Ok(Vec::new());
        };
        match &run.refusal {
            // The program accepted the mesh when it was set up.
            Some(reason) => Err(Excluded {
                failed: reason != STOPPED,
                ..Excluded::new(&candidate.name, reason.clone())
            }),
            None => Ok(with_own_time(run.times(), self.own_ns)),
        }
    }

    fn parts(&self, _: &MeasuredMix<'_>) -> Vec<PartCost> {
        Vec::new()
    }

    fn operations(&self) -> f64 {
        self.runs
    }
}

#[cfg(test)]
mod tests;
