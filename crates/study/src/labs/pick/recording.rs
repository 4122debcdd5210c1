//! Records a program, as a workload and as a trace.

use std::sync::atomic::{AtomicBool, Ordering};

use sixfold_workload::{
    Backend, Contestant, Draw, Job, MachineClock, Recording, Route, Schedule, Series, Suite,
    SuiteProgram, Task, TimedBackend, prepare_mix,
};

use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::inspect::StudyMesh;
use crate::labs::pick::programs::{ProgramSettings, is_local};
use sixfold_results::statistics::Median;

/// The greatest number of operations of the mix in one timed run.
const MAX_TURNS: f64 = 4096.0;

/// The number of rounds in which a program, its trace and its workload are measured, unless it is
/// given.
const MIN_ROUNDS: usize = 3;
const MAX_ROUNDS: usize = 101;

/// The reason why a program is not recorded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum RecordError {
    /// The kind of program cannot be recorded.
    #[error("{program}: a program that {kind} the mesh cannot be recorded")]
    Kind { program: String, kind: &'static str },
    /// No structure can run the program.
    #[error("{program}: no structure can run it on {mesh}: {reason}")]
    Refused {
        program: String,
        mesh: String,
        reason: String,
    },
    /// The program has too many calls.
    #[error("{program} has more than 16 million calls on {mesh}: record it on a smaller mesh")]
    TooLong { program: String, mesh: String },
}

/// A recorded program.
#[derive(Clone, Debug)]
pub struct RecordedProgram {
    /// The structure on which the program was recorded.
    pub structure: &'static str,
    /// What the program asked, with the own time of the program in the workload and in the trace.
    pub recording: Recording,
    /// The median time of a run on the structure, without recording, in nanoseconds.
    pub run_ns: f64,
}

/// Runs `program` on each structure that holds the mesh and does not scan it. Then records what it
/// asks on the fastest of these structures.
///
/// Then measures the program, its trace and its workload in turns, for a part of the budget of
/// `settings`. The time of the program minus the time of its trace is the program's own time, which
/// is added to all times of the trace, and likewise for the workload.
///
/// # Errors
///
/// Returns an error if no structure can run the program, if the kind of program cannot be recorded,
/// or if the run has too many calls.
pub fn record_program(
    study_mesh: &StudyMesh,
    program: &SuiteProgram,
    settings: &ProgramSettings,
    stop: &AtomicBool,
) -> Result<RecordedProgram, RecordError> {
    record_program_on(&MachineClock::start(), study_mesh, program, settings, stop)
}

/// Does what [`record_program`] does, on `machine`.
pub(crate) fn record_program_on(
    machine: &dyn Machine,
    study_mesh: &StudyMesh,
    program: &SuiteProgram,
    settings: &ProgramSettings,
    stop: &AtomicBool,
) -> Result<RecordedProgram, RecordError> {
    let name = || program.name().to_owned();
    let mesh = || study_mesh.name.clone();
    if matches!(program.kind(), "refines" | "walks") {
        return Err(RecordError::Kind {
            program: name(),
            kind: program.kind(),
        });
    }
    let refused = |reason: String| RecordError::Refused {
        program: name(),
        mesh: mesh(),
        reason,
    };
    let polygons = &study_mesh.polygons;
    let counts = polygons.counts(study_mesh.facts.edges);
    let clock = machine.clock();
    let mut fastest: Option<(f64, &Contestant, Box<dyn TimedBackend + '_>)> = None;
    let mut first_reason = None;
    let contestants = program.contestants().iter();
    let structures = contestants.filter(|c| c.made_from().is_none());
    for contestant in structures.filter(|c| settings.chooses(c) && is_local(c)) {
        let mut prepared = match contestant.prepare(polygons) {
            Ok(prepared) => machine.host(prepared, &counts),
            Err(refusal) => {
                first_reason.get_or_insert(format!("{}: {refusal}", contestant.name()));
                continue;
            }
        };
        let series = Series::once(clock).with_untimed(1);
        let run = prepared.run(&Job::new(Task::Program), &series);
        if let Some(refusal) = run.refusal {
            first_reason.get_or_insert(format!("{}: {refusal}", contestant.name()));
            continue;
        }
        let ns = run.time.ns();
        if fastest.as_ref().is_none_or(|(least, ..)| ns < *least) {
            fastest = Some((ns, contestant, prepared));
        }
    }
    let Some((_, contestant, prepared)) = fastest else {
        let none = || "no structure is left".to_owned();
        return Err(refused(first_reason.unwrap_or_else(none)));
    };
    match contestant.record_calls(polygons) {
        None => Err(RecordError::TooLong {
            program: name(),
            mesh: mesh(),
        }),
        Some(Err(refusal)) => Err(refused(refusal.to_string())),
        Some(Ok(recording)) => {
            let calibration = Calibration {
                study_mesh,
                contestant,
                seed: settings.seed,
                effort: settings.effort,
                machine,
                stop,
            };
            Ok(calibration.measure(prepared, recording))
        }
    }
}

/// Measures a program, its trace and its workload on the structure on which it was recorded.
struct Calibration<'c> {
    study_mesh: &'c StudyMesh,
    contestant: &'c Contestant,
    seed: u64,
    effort: Effort,
    machine: &'c dyn Machine,
    stop: &'c AtomicBool,
}

impl Calibration<'_> {
    fn measure(
        &self,
        mut program: Box<dyn TimedBackend + '_>,
        mut recording: Recording,
    ) -> RecordedProgram {
        let polygons = &self.study_mesh.polygons;
        let clock = self.machine.clock();
        let traced = Suite::new().trace(recording.trace.clone());
        let same = |c: &&Contestant| c.name() == self.contestant.name();
        let trace = traced.programs().iter().flat_map(|p| p.contestants());
        let trace = trace.filter(same).find_map(|c| c.prepare(polygons).ok());
        let counts = polygons.counts(self.study_mesh.facts.edges);
        let mut trace = trace.map(|built| self.machine.host(built, &counts));
        let schedule = Schedule::new(&recording.workload, &counts);
        let route = Route::new(recording.workload.access, polygons, self.seed);
        let draw = Draw::new(polygons, self.seed);
        let backend = Backend::find(self.contestant.name());
        let mix = backend.and_then(|b| prepare_mix(&b, polygons, &draw, &schedule, &route).ok());
        let mix = mix.filter(|_| !recording.workload.mix.is_empty());
        let mut mix = mix.map(|built| self.machine.host(built, &counts));
        let operations = recording.workload.operations_on(&counts);

        let mut times: [Vec<f64>; 3] = Default::default();
        let budget = Budget::start(self.effort, clock);
        let fixed = self.effort.rounds().map(|rounds| rounds.get() as usize);
        let rounds = fixed.unwrap_or(MAX_ROUNDS);
        let mut first = 0;
        while times[0].len() < rounds.min(MIN_ROUNDS)
            || (budget.left().limit_ns() > 0.0 && times[0].len() < rounds)
        {
            let once = Series::once(clock);
            times[0].push(program.run(&Job::new(Task::Program), &once).time.ns());
            if let Some(trace) = &mut trace {
                times[1].push(trace.run(&Job::new(Task::Program), &once).time.ns());
            }
            if let Some(mix) = &mut mix {
                let runs = (operations / 256.0).clamp(1.0, MAX_TURNS) as u32;
                let series = Series::with_runs(runs, clock).with_result();
                let job = Job {
                    first,
                    ..Job::new(Task::Mix)
                };
                let run = mix.run(&job, &series);
                first += u64::from(runs);
                let elements = run.outcome.map_or(1, |outcome| outcome.elements).max(1);
                times[2].push(run.time.ns() / elements as f64);
            }
            if self.stop.load(Ordering::Relaxed) {
                break;
            }
        }
        let [run, trace, operation] = times.map(|times| Some(Median::from_samples(times)?.value));
        let run_ns = run.unwrap_or(0.0);
        recording.trace.own_ns = trace.map_or(0.0, |trace| run_ns - trace);
        recording.workload.own_ns = operation.map_or(0.0, |ns| run_ns / operations - ns);
        RecordedProgram {
            structure: self.contestant.name(),
            recording,
            run_ns,
        }
    }
}
