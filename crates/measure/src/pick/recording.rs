//! Records a program as a trace.

use std::fmt::Display;
use std::sync::atomic::AtomicBool;

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::engine::measure::Entry;
use crate::pages::HeapPolicyConflict;
use crate::pick::programs::ProgramSettings;
use crate::pick::tasks::program_entry;
use crate::study_mesh::StudyMesh;
use crate::trace::Measured;
use crate::{Contestant, MachineClock, SuiteProgram, TapedRun, TimedBackend};

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
    /// The calls, with the own time of the program in the trace.
    pub run: TapedRun,
    /// The time of a run on the structure, without recording, in nanoseconds: a median, corrected for
    /// drift.
    pub run_ns: f64,
}

/// Measures `program` on each structure that holds the mesh and does not scan it. Then records what it
/// asks on the fastest of these structures. A program that edits is recorded on the face-vertex mesh.
///
/// Then measures the program and its trace in rounds, for the rest of the budget of `settings`. The time of the
/// program minus the time of its trace is the program's own time, which is added to all times of the trace. It is 0 if
/// the trace takes longer than the program.
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
pub fn record_program_on(
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
    let structures = structures.filter(|c| c.can_run_again());
    for contestant in structures.filter(|c| settings.chooses(c)) {
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
        let none = || "choose face-vertex with --backends, or all structures".to_owned();
        return Err(refused(first_reason.unwrap_or_else(none)));
    };
    match contestant.record_calls(polygons) {
        None => Err(RecordError::TooLong {
            program: name(),
            mesh: mesh(),
        }),
        Some(Err(refusal)) => Err(refused(refusal.to_string())),
        Some(Ok(mut taped)) => {
            let run_ns = calibrate(
                &mut taped,
                study_mesh,
                (contestant, subject),
                &mut bench,
                &run,
                budget.left(),
                settings.seed,
            );
            Ok(RecordedProgram {
                structure: contestant.name(),
                run: taped,
                run_ns,
            })
        }
    }
}

/// Measures a program and its trace on the structure on which it was recorded. Puts both times and the program's own
/// time into the trace, and returns the time of a run of the program in nanoseconds. `run` makes the entry for a run of
/// a program on a subject.
fn calibrate(
    recorded: &mut TapedRun,
    study_mesh: &StudyMesh,
    (contestant, program): (&Contestant, Box<dyn TimedBackend + '_>),
    bench: &mut Bench<'_>,
    run: &dyn Fn(usize) -> Entry,
    effort: Effort,
    seed: u64,
) -> f64 {
    let polygons = &study_mesh.polygons;
    let counts = polygons.counts(study_mesh.facts.edges);
    let trace = contestant.replay(&recorded.trace, polygons);
    let trace = trace.and_then(Result::ok);
    let trace = trace.map(|trace| bench.machine.host(trace, &counts));
    let subjects: Vec<_> = [program].into_iter().chain(trace).collect();
    let trial = Trial {
        polygons,
        counts,
        skewed: false,
        entries: (0..subjects.len()).map(run).collect(),
        columns: Columns::without_control(subjects),
        effort,
        named: true,
        forced: true,
        untimed: None,
        seed,
    };
    let measured = bench.measure(trial, &mut |_| ());
    // Each subject has one entry.
    let run_ns = measured.times[0].unwrap_or(0.0);
    let replay_ns = measured.times.get(1).copied().flatten();
    if let Some(replay_ns) = replay_ns {
        // Calls that are run from a list can take longer than in the program. Then the own time is too short to be
        // measured.
        recorded.trace.own_ns = (run_ns - replay_ns).max(0.0);
        recorded.trace.measured = Some(Measured {
            structure: contestant.name().to_owned(),
            run_ns,
            replay_ns,
        });
    }
    run_ns
}
