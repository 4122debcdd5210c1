//! Turns the trace of a program into a workload.

use std::sync::atomic::AtomicBool;

use sixfold::{EditableHalfEdgeMesh, FaceVertexMesh};
use sixfold_measure::pages::HeapPolicyConflict;
use sixfold_measure::pick::program_entry;
use sixfold_measure::{
    Contestant, MachineClock, ProgramRefusal, ProgramSettings, StudyMesh, Trace, record_edit_trace,
    record_trace,
};
use sixfold_workload::{Backend, Draw, Recording, Route, Schedule, prepare_mix, suite_of_trace};

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::machine::Machine;
use crate::labs::pick::tasks::mix_entry;

/// The reason why a trace is not turned into a workload.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum TraceWorkloadError {
    /// The trace does not run on the mesh.
    #[error("{program}: the trace does not run on {mesh}: {reason}")]
    Refused {
        program: String,
        mesh: String,
        reason: ProgramRefusal,
    },
    /// The trace has too many calls.
    #[error("{program} has more than 16 million calls on {mesh}: record it on a smaller mesh")]
    TooLong { program: String, mesh: String },
    /// A measurement with another heap policy is active in this process.
    #[error(transparent)]
    HeapPolicy(#[from] HeapPolicyConflict),
}

/// Turns `trace`, which was recorded on `study_mesh`, into a workload.
///
/// The time of the program's own work for each operation is the time of a run of the program, which the trace has,
/// minus the time of the mix. The mix and the trace are measured in turn, on the structure on which the trace was
/// recorded, for the budget of `settings`, and the time of the program is corrected by the speed of the machine then
/// and now. The own time is 0 if the mix takes longer than the program.
///
/// # Errors
///
/// Returns an error if the trace does not run on the mesh, or if it has too many calls. Also returns an error if
/// another heap policy is active in this process.
pub fn workload_of_trace(
    study_mesh: &StudyMesh,
    trace: &Trace,
    settings: &ProgramSettings,
    stop: &AtomicBool,
) -> Result<Recording, TraceWorkloadError> {
    workload_of_trace_on(&MachineClock::start(), study_mesh, trace, settings, stop)
}

/// Does what [`workload_of_trace`] does, on `machine`.
pub(crate) fn workload_of_trace_on(
    machine: &dyn Machine,
    study_mesh: &StudyMesh,
    trace: &Trace,
    settings: &ProgramSettings,
    stop: &AtomicBool,
) -> Result<Recording, TraceWorkloadError> {
    let (program, mesh) = (trace.program.clone(), study_mesh.name.clone());
    let polygons = &study_mesh.polygons;
    let taped = match trace.edits.is_empty() {
        true => record_trace::<FaceVertexMesh>(trace, polygons),
        false => record_edit_trace::<EditableHalfEdgeMesh>(trace, polygons),
    };
    let taped = match taped {
        Ok(Some(taped)) => taped,
        Ok(None) => return Err(TraceWorkloadError::TooLong { program, mesh }),
        Err(reason) => {
            return Err(TraceWorkloadError::Refused {
                program,
                mesh,
                reason,
            });
        }
    };
    let mut recording = Recording::new(taped, polygons);
    let counts = polygons.counts(study_mesh.facts.edges);
    let operations = recording.workload.operations_on(&counts);
    let Some(then) = &trace.measured else {
        recording.workload.own_ns = trace.own_ns / operations;
        return Ok(recording);
    };
    let mut bench = Bench::start(machine, settings.run_settings(), 0, stop)?;
    let traced = suite_of_trace(trace.clone());
    let same = |c: &&Contestant| c.name() == then.structure;
    let replay = traced.programs().iter().flat_map(|p| p.contestants());
    let replay = replay.filter(same).find_map(|c| c.prepare(polygons).ok());
    let workload = &recording.workload;
    let schedule = Schedule::new(workload, &counts);
    let route = Route::new(workload.access, polygons, settings.seed);
    let draw = Draw::new(polygons, settings.seed);
    let backend = Backend::find(&then.structure).filter(|_| !workload.mix.is_empty());
    let mix = backend.and_then(|b| prepare_mix(&b, polygons, &draw, &schedule, &route).ok());
    let (Some(replay), Some(mix)) = (replay, mix) else {
        recording.workload.own_ns = trace.own_ns / operations;
        return Ok(recording);
    };
    let changes_mesh = traced.programs().iter().any(|p| p.changes_mesh());
    let entries = vec![program_entry(0, changes_mesh), mix_entry(1, &schedule)];
    let trial = Trial {
        polygons,
        counts,
        skewed: false,
        columns: Columns::without_control(vec![
            machine.host(replay, &counts),
            machine.host(mix, &counts),
        ]),
        entries,
        effort: settings.effort,
        named: true,
        forced: true,
        untimed: None,
        seed: settings.seed,
    };
    let measured = bench.measure(trial, &mut |_| ());
    let [Some(replay_ns), Some(turn_ns)] = [measured.times[0], measured.times[1]] else {
        return Ok(recording);
    };
    let turn = measured.entries[1]
        .outcome
        .map_or(1, |turn| turn.elements.max(1));
    let speed = match then.replay_ns > 0.0 {
        true => replay_ns / then.replay_ns,
        false => 1.0,
    };
    let own_ns = speed * then.run_ns / operations - turn_ns / turn as f64;
    recording.workload.own_ns = own_ns.max(0.0);
    Ok(recording)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use sixfold::{MeshQuery, Representation, shapes};
    use sixfold_measure::{Effort, Measured, Recorded, Task};

    use super::*;
    use crate::engine::simulated_machine::{SimulatedMachine, Work};

    /// Returns a mesh of 120 vertices, and the trace of a program that queries the neighbours of each.
    fn traced() -> (StudyMesh, Trace) {
        let torus = shapes::triangle_torus(12, 10).expect("a torus");
        let mut mesh = Recorded::<FaceVertexMesh>::from_polygons(&torus).expect("held");
        mesh.start_trace(&torus);
        for v in mesh.vertices() {
            mesh.vertex_vertices(v).count();
        }
        let trace = mesh.trace("neighbours").expect("few calls");
        (StudyMesh::new("torus", torus), trace)
    }

    /// Returns the own time of the workload on a machine that is slower by `factor` than when the trace was recorded.
    fn own_ns(factor: f64, trace: &Trace, study_mesh: &StudyMesh) -> f64 {
        let machine = SimulatedMachine::with_costs(move |work: &Work<'_>| match work.task {
            Task::Program => factor * 42_000.0,
            Task::Mix => factor * 256.0 * 300.0,
            _ => 1000.0,
        });
        let settings = ProgramSettings {
            effort: Effort::Budget(Duration::from_millis(100)),
            ..ProgramSettings::default()
        };
        let stop = AtomicBool::new(false);
        let recording = workload_of_trace_on(&machine, study_mesh, trace, &settings, &stop);
        recording.expect("it runs").workload.own_ns
    }

    #[test]
    fn the_own_time_is_what_the_mix_does_not_take_at_the_speed_of_the_machine_now() {
        let (study_mesh, mut trace) = traced();
        trace.own_ns = 1200.0;
        assert_eq!(
            own_ns(1.0, &trace, &study_mesh),
            10.0,
            "nothing was measured"
        );
        let measured = |run_ns| Measured {
            structure: "winged-edge".into(),
            run_ns,
            replay_ns: 42_000.0,
        };
        trace.measured = Some(measured(50_000.0));
        // 120 vertices are queried in a run of 50 µs: 416.7 ns for each, of which a query takes 300.
        for factor in [1.0, 2.0] {
            let own_ns = own_ns(factor, &trace, &study_mesh) / factor;
            assert!(
                (own_ns - (50_000.0 / 120.0 - 300.0)).abs() < 1e-6,
                "{own_ns}"
            );
        }
        trace.measured = Some(measured(30_000.0));
        assert_eq!(
            own_ns(1.0, &trace, &study_mesh),
            0.0,
            "the mix takes longer"
        );
    }
}
