//! Records a program, as a workload and as a trace.

use std::fmt::Display;
use std::sync::atomic::AtomicBool;

use sixfold_workload::pages::HeapPolicyConflict;
use sixfold_workload::{
    Backend, Contestant, Draw, MachineClock, Recording, Route, Schedule, Suite, SuiteProgram,
    TimedBackend, prepare_mix,
};

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::engine::measure::Entry;
use crate::inspect::StudyMesh;
use crate::labs::pick::programs::{ProgramSettings, is_local};
use crate::labs::pick::tasks::{mix_entry, program_entry};

/// The time for choosing the structure on which a program is recorded is a part of the budget: one
/// part of so many.
const SELECTION_SHARE: f64 = 4.0;

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
    /// A measurement with another heap policy is active in this process.
    #[error(transparent)]
    HeapPolicy(#[from] HeapPolicyConflict),
}

/// A recorded program.
#[derive(Clone, Debug)]
pub struct RecordedProgram {
    /// The structure on which the program was recorded.
    pub structure: &'static str,
    /// What the program asked, with the own time of the program in the workload and in the trace.
    pub recording: Recording,
    /// The time of a run on the structure, without recording, in nanoseconds: a median, corrected for
    /// drift.
    pub run_ns: f64,
}

/// Measures `program` on each structure that holds the mesh and does not scan it. Then records what it
/// asks on the fastest of these structures.
///
/// Then measures the program, its trace and its workload in rounds, for the rest of the budget of
/// `settings`. The time of the program minus the time of its trace is the program's own time, which
/// is added to all times of the trace, and likewise for the workload. It is 0 if the trace takes longer than
/// the program.
///
/// # Errors
///
/// Returns an error if no structure can run the program, if the kind of program cannot be recorded,
/// or if the run has too many calls. Also returns an error if another heap policy is active in this
/// process.
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
    if !program.can_be_recorded() {
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
    let budget = Budget::start(settings.effort, machine.clock());
    let mut bench = Bench::start(machine, settings.run_settings(), 0, stop)?;
    let mut first_reason = None;
    let mut keep_reason = |contestant: &Contestant, refusal: &dyn Display| {
        first_reason.get_or_insert(format!("{}: {refusal}", contestant.name()));
    };
    let (mut contestants, mut subjects) = (Vec::new(), Vec::new());
    let structures = program.contestants().iter();
    let structures = structures.filter(|c| c.made_from().is_none());
    for contestant in structures.filter(|c| settings.chooses(c) && is_local(c)) {
        match contestant.prepare(polygons) {
            Ok(built) => {
                contestants.push(contestant);
                subjects.push(machine.host(built, &counts));
            }
            Err(refusal) => keep_reason(contestant, &refusal),
        }
    }
    let run = |subject: usize| program_entry(subject, program.changes_mesh());
    let trial = Trial {
        polygons,
        counts,
        skewed: false,
        entries: (0..subjects.len()).map(run).collect(),
        columns: Columns::without_control(subjects),
        effort: budget.share(1.0, SELECTION_SHARE),
        named: true,
        forced: true,
        untimed: None,
        seed: settings.seed,
    };
    let measured = bench.measure(trial, &mut |_| ());
    let times = measured.times.iter();
    let times = times.map(|ns| ns.unwrap_or(f64::INFINITY));
    let runs = contestants.into_iter().zip(&measured.entries);
    let runs = runs.zip(measured.columns.subjects).zip(times);
    let runs = runs.filter_map(
        |(((contestant, entry), subject), ns)| match &entry.refusal {
            None => Some((contestant, subject, ns)),
            Some(refusal) => {
                keep_reason(contestant, refusal);
                None
            }
        },
    );
    let fastest = runs.min_by(|(.., a), (.., b)| a.total_cmp(b));
    let Some((contestant, subject, _)) = fastest else {
        let none = || "no structure is left".to_owned();
        return Err(refused(first_reason.unwrap_or_else(none)));
    };
    match contestant.record_calls(polygons) {
        None => Err(RecordError::TooLong {
            program: name(),
            mesh: mesh(),
        }),
        Some(Err(refusal)) => Err(refused(refusal.to_string())),
        Some(Ok(mut recording)) => {
            let run_ns = calibrate(
                &mut recording,
                study_mesh,
                (contestant, subject),
                &mut bench,
                &run,
                budget.left(),
                settings.seed,
            );
            Ok(RecordedProgram {
                structure: contestant.name(),
                recording,
                run_ns,
            })
        }
    }
}

/// Measures a program, its trace and its workload on the structure on which it was recorded. Puts the
/// program's own time into the trace and the workload, and returns the time of a run of the program in
/// nanoseconds. `run` makes the entry for a run of a program on a subject.
fn calibrate(
    recording: &mut Recording,
    study_mesh: &StudyMesh,
    (contestant, program): (&Contestant, Box<dyn TimedBackend + '_>),
    bench: &mut Bench<'_>,
    run: &dyn Fn(usize) -> Entry,
    effort: Effort,
    seed: u64,
) -> f64 {
    let polygons = &study_mesh.polygons;
    let counts = polygons.counts(study_mesh.facts.edges);
    let traced = Suite::new().trace(recording.trace.clone());
    let same = |c: &&Contestant| c.name() == contestant.name();
    let trace = traced.programs().iter().flat_map(|p| p.contestants());
    let trace = trace.filter(same).find_map(|c| c.prepare(polygons).ok());
    let workload = &recording.workload;
    let schedule = Schedule::new(workload, &counts);
    let route = Route::new(workload.access, polygons, seed);
    let draw = Draw::new(polygons, seed);
    let backend = Backend::find(contestant.name()).filter(|_| !workload.mix.is_empty());
    let mix = backend.and_then(|b| prepare_mix(&b, polygons, &draw, &schedule, &route).ok());
    let operations = workload.operations_on(&counts);

    let mut built = vec![(program, run(0))];
    let trace = trace.map(|trace| {
        let subject = built.len();
        built.push((bench.machine.host(trace, &counts), run(subject)));
        subject
    });
    let mix = mix.map(|mix| {
        let subject = built.len();
        let entry = mix_entry(subject, &schedule);
        built.push((bench.machine.host(mix, &counts), entry));
        subject
    });
    let (subjects, entries) = built.into_iter().unzip();
    let trial = Trial {
        polygons,
        counts,
        skewed: false,
        columns: Columns::without_control(subjects),
        entries,
        effort,
        named: true,
        forced: true,
        untimed: None,
        seed,
    };
    let measured = bench.measure(trial, &mut |_| ());
    // Each subject has one entry.
    let time = |subject: usize| measured.times[subject];
    let run_ns = time(0).unwrap_or(0.0);
    let operation_ns = |mix: usize| {
        let turn = measured.entries[mix].outcome?;
        Some(time(mix)? / turn.elements.max(1) as f64)
    };
    // Calls that are run from a list can take longer than in the program. Then the own time is too short to
    // be measured.
    let rest = |ns: Option<f64>, run_ns: f64| ns.map_or(0.0, |ns| (run_ns - ns).max(0.0));
    recording.trace.own_ns = rest(trace.and_then(time), run_ns);
    recording.workload.own_ns = rest(mix.and_then(operation_ns), run_ns / operations);
    run_ns
}
