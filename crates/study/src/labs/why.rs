//! Explains the times of queries by the memory that the queries read.
//!
//! The counts of reads ([`Reads`]) need no clock and have no noise. A study measures the times of
//! the same queries. [`MemorySpeed`] is the speed at which this machine reads memory.
//! [`Bound::from_times`] compares the time of a query with the time for reading the same amount of
//! memory.

mod sentences;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use sixfold::Relation;
use sixfold_results::{BackendReport, Bound, Model, Reads, Report, Timed, Why, WhyRow};
use sixfold_workload::{
    Backend, CACHE_LINES, ElementKind, LINE_BYTES, MAX_READS, MachineClock, MemorySpeed,
    ReadsObserver,
};
use sixfold_workload::{Operation, REACH, SCAN_SAMPLE};

use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::engine::measure::Progress;
use crate::engine::run::start_run;
use crate::inspect::{StudyMesh, unbuilt};
use crate::labs::study::{Settings, StudyError, study_on};
use crate::refusal::BuildInput;
use sixfold_results::numbers::bytes;

/// The stage before the times are measured.
const MEASURING_MEMORY: Progress<'_> = Progress {
    done: 0.0,
    stage: "measuring",
    task: "the speed of memory",
    backend: "this machine",
};

/// The settings of [`why`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WhySettings {
    /// The names of the backends. If the list is empty, all backends are used.
    pub backends: Vec<String>,
    /// Additional structures that are not part of Sixfold.
    pub extra: Vec<Backend>,
    /// The relations. If the list is empty, all nine relations are used.
    pub relations: Vec<Relation>,
    /// The settings of the time measurement. If this field is `None`, reads are counted, but times
    /// are not measured.
    pub timing: Option<Timing>,
}

/// The settings of the time measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// How much is measured. Up to half of a time limit is for the measurement of the memory.
    pub effort: Effort,
}

/// The model that this version of Sixfold uses.
const CURRENT_MODEL: Model = Model {
    line_bytes: LINE_BYTES,
    cache_lines: CACHE_LINES,
    reach: REACH,
    sample: SCAN_SAMPLE,
    most_reads: MAX_READS,
};

/// Counts the memory reads of relations on the backends that can hold the mesh. If
/// `settings.timing` is set, also measures the times of the relations.
///
/// Setting `stop` to true ends the measurement early, with a result of the finished part.
/// `progress` is called with the current step.
///
/// # Errors
///
/// Returns the same errors as [`study()`](crate::study()).
pub fn why(
    study_mesh: &StudyMesh,
    settings: &WhySettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<Why, StudyError> {
    why_on(&MachineClock::start(), study_mesh, settings, stop, progress)
}

/// Does what [`why`] does, on `machine`.
pub(crate) fn why_on(
    machine: &dyn Machine,
    study_mesh: &StudyMesh,
    settings: &WhySettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<Why, StudyError> {
    let requested = |relation: &Relation| {
        settings.relations.is_empty() || settings.relations.contains(relation)
    };
    let relations: Vec<Relation> = Relation::ALL.into_iter().filter(requested).collect();
    let mut study_settings = Settings {
        backends: settings.backends.clone(),
        extra: settings.extra.clone(),
        operations: relations.iter().copied().map(Operation::Relation).collect(),
        ..Settings::default()
    };
    if study_mesh.polygons.face_count() == 0 {
        return Err(StudyError::NoFaces);
    }
    // Counting has no time limit.
    let no_time = Effort::Budget(Duration::ZERO);
    study_settings.effort = settings.timing.map_or(no_time, |timing| timing.effort);
    let mut run = start_run(study_settings.run_settings());
    let (backends, mut rows) = count_all(study_mesh, &study_settings, &relations, stop, progress)?;
    // The sort is stable: the rows of one relation stay in the order of the backends.
    rows.sort_by_key(|row| row.reads.relation);
    let (mut samples, mut warnings) = (Vec::new(), Vec::new());
    let budget = Budget::start(study_settings.effort, machine.clock());
    let memory = settings.timing.and_then(|Timing { effort }| {
        progress(MEASURING_MEMORY);
        machine.memory_speed(effort.budget().map_or(Duration::MAX, |all| all / 2), stop)
    });
    if let Some(memory) = &memory
        && !stop.load(Ordering::Relaxed)
    {
        study_settings.effort = budget.left();
        let report = study_on(machine, study_mesh, &study_settings, stop, progress)?;
        for row in &mut rows {
            row.timed = timed(row, &report, memory);
        }
        run.environment = report.run.environment;
        (samples, warnings) = (report.samples, report.warnings);
        warnings.extend(left_out_buffers(memory));
    }
    let holding = backends.iter().filter(|backend| backend.holds).count();
    let sentences = match rows.len() == holding * relations.len() {
        true => sentences::sentences(&rows),
        false => Vec::new(),
    };
    Ok(Why {
        run,
        mesh: study_mesh.report(),
        backends,
        sentences,
        model: CURRENT_MODEL,
        memory: memory.map(|memory| memory.speeds().to_vec()),
        rows,
        samples,
        warnings,
        interrupted: stop.load(Ordering::Relaxed),
    })
}

fn count_all(
    study_mesh: &StudyMesh,
    settings: &Settings,
    relations: &[Relation],
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<(Vec<BackendReport>, Vec<WhyRow>), StudyError> {
    let chosen = settings.chosen_backends()?;
    let input = BuildInput::from_study_mesh(study_mesh);
    let (mut backends, mut rows) = (Vec::new(), Vec::new());
    let all = (chosen.len() * relations.len()) as f64;
    for (i, backend) in chosen.iter().enumerate() {
        let mut counting = RowCollector {
            backend: backend.name(),
            done: (i * relations.len()) as f64 / all,
            step: 1.0 / all,
            rows: &mut rows,
            progress,
        };
        let verdict = backend.count_reads(input.polygons, relations, stop, &mut counting);
        backends.push(unbuilt(backend, &input, verdict));
    }
    if backends.iter().all(|backend| !backend.holds) {
        return Err(StudyError::none_holds(backends));
    }
    Ok((backends, rows))
}

struct RowCollector<'a> {
    backend: &'static str,
    done: f64,
    step: f64,
    rows: &'a mut Vec<WhyRow>,
    progress: &'a mut dyn FnMut(Progress<'_>),
}

impl ReadsObserver for RowCollector<'_> {
    fn relation_started(&mut self, relation: Relation) {
        (self.progress)(Progress {
            done: self.done,
            stage: "counting",
            task: relation.name(),
            backend: self.backend,
        });
        self.done += self.step;
    }

    fn relation_counted(&mut self, reads: Reads) {
        self.rows.push(WhyRow {
            backend: self.backend.to_owned(),
            per: ElementKind::queried_by(reads.relation).name().into(),
            reads,
            timed: None,
        });
    }
}

/// Describes the buffers that were left out because the budget was too short.
fn left_out_buffers(memory: &MemorySpeed) -> Option<String> {
    let [from, largest] = [memory.left_out_from()?, memory.memory().bytes].map(bytes);
    Some(format!(
        "The budget was too short to measure the speed of buffers of {from} and more. Queries that \
         read more than {largest} are compared with the speed of {largest}, which is too fast for \
         them: use a longer --budget."
    ))
}

/// Returns the time from the report, compared with the speed of memory.
fn timed(row: &WhyRow, report: &Report, memory: &MemorySpeed) -> Option<Timed> {
    let result = report.row(row.reads.relation.name(), &row.backend)?;
    let ns_per_element = result.ns_per_element?;
    let speed = memory.at(row.reads.sweep_bytes(LINE_BYTES));
    let floor_ns = row.reads.moved_bytes / speed.gb_per_s;
    let waits_ns = row.reads.jumps * speed.latency_ns;
    Some(Timed {
        ns_per_element,
        sampled: result.sampled,
        agreement: result.agreement,
        speed,
        floor_ns,
        waits_ns,
        bound: Bound::from_times(ns_per_element, floor_ns, waits_ns),
    })
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;

    use std::num::NonZeroU32;

    use sixfold_results::Counted;

    use super::*;
    use crate::engine::simulated_machine::SimulatedMachine;

    fn counted(settings: &WhySettings) -> Result<Why, StudyError> {
        let grid = shapes::triangle_grid(6, 6).expect("a grid");
        let study_mesh = StudyMesh::new("grid", grid);
        why(&study_mesh, settings, &AtomicBool::new(false), &mut |_| ())
    }

    #[test]
    fn half_of_the_time_determines_the_bound() {
        for (ns, floor, waits, bound) in [
            (10.0, 5.0, 0.0, Bound::Bandwidth),
            (10.0, 5.0, 50.0, Bound::Bandwidth),
            (10.0, 4.9, 5.0, Bound::Latency),
            (10.0, 4.9, 4.9, Bound::Work),
            (2.0, 0.0, 0.0, Bound::Work),
        ] {
            assert_eq!(
                Bound::from_times(ns, floor, waits),
                bound,
                "{ns} {floor} {waits}"
            );
        }
    }

    #[test]
    fn rows_are_sorted_by_relation() {
        let settings = WhySettings {
            backends: vec!["half-edge".into(), "polygon-soup".into()],
            relations: vec![Relation::FaceVertices, Relation::VertexFaces],
            ..WhySettings::default()
        };
        let why = counted(&settings).expect("both can hold the mesh");
        let rows: Vec<_> = why
            .rows
            .iter()
            .map(|row| {
                (
                    row.reads.relation.name(),
                    row.backend.as_str(),
                    row.per.as_str(),
                )
            })
            .collect();
        let expected = [
            ("vertex_faces", "polygon-soup", "vertex"),
            ("vertex_faces", "half-edge", "vertex"),
            ("face_vertices", "polygon-soup", "face"),
            ("face_vertices", "half-edge", "face"),
        ];
        assert_eq!(rows, expected);
        assert!(why.rows.iter().all(|row| row.timed.is_none()));
        assert!(why.memory.is_none() && why.samples.is_empty());
    }

    #[test]
    fn a_time_is_compared_with_memory_of_the_size_of_the_sweep() {
        let grid = shapes::triangle_grid(6, 6).expect("a grid");
        let vertices = grid.vertex_count() as f64;
        let study_mesh = StudyMesh::new("grid", grid);
        let settings = WhySettings {
            backends: vec!["half-edge".into()],
            relations: vec![Relation::VertexFaces],
            timing: Some(Timing {
                effort: Effort::of_ms(20),
            }),
            ..WhySettings::default()
        };
        let stop = AtomicBool::new(false);
        let machine = SimulatedMachine::equal_costs();
        let memory = machine.memory_speed(Duration::MAX, &stop);
        let memory = memory.expect("not stopped");
        let why = why_on(&machine, &study_mesh, &settings, &stop, &mut |_| ());
        let why = why.expect("it can hold the mesh");
        let [row] = &why.rows[..] else {
            panic!("one row: {:?}", why.rows);
        };
        let timed = row.timed.expect("measured");
        assert_eq!(timed.speed, memory.speeds()[0], "it fits the smallest");
        let floor = row.reads.moved_bytes / timed.speed.gb_per_s;
        assert_eq!(timed.floor_ns, floor);
        assert_eq!(timed.waits_ns, row.reads.jumps * timed.speed.latency_ns);
        assert!((timed.ns_per_element - 10_000.0 / vertices).abs() < 1e-6);
        assert_eq!(sixfold_results::Finding::from(why.clone()).mismatches(), 0);
        let [figure] = &why.figures()[..] else {
            panic!("one figure");
        };
        let ns = figure.row.median_ns.expect("measured");
        assert!((ns - 10_000.0).abs() < 1e-6, "the time of a run: {ns}");
        assert_eq!(figure.row.elements, Some(vertices as u64));
        assert_eq!(figure.row.per, "vertex");
        assert_eq!(figure.row.ns_per_element, Some(timed.ns_per_element));
        assert_eq!(figure.row.agreement, timed.agreement);
        assert_eq!(figure.counted, Counted::from(&row.reads));
        assert_eq!(
            figure.row.samples,
            figure.samples.expect("samples").rounds.len()
        );
        assert_eq!(why.memory.as_deref(), Some(memory.speeds()));
        assert_eq!(why.run.settings.budget_s, Some(0.02), "the whole budget");
        // The simulated machine has only the speed of the smallest buffer.
        assert!(memory.left_out_from().is_some());
        let warned = why.warnings.iter().any(|w| w.contains("speed of buffers"));
        assert!(warned, "{:?}", why.warnings);
        let one_round = WhySettings {
            timing: Some(Timing {
                effort: Effort::of_rounds(1),
            }),
            ..settings
        };
        let why = why_on(&machine, &study_mesh, &one_round, &stop, &mut |_| ());
        let why = why.expect("it can hold the mesh");
        let run = &why.run.settings;
        assert_eq!((run.budget_s, run.rounds), (None, NonZeroU32::new(1)));
        assert!(why.samples.iter().all(|samples| samples.rounds == [0]));
    }

    #[test]
    fn refusing_backends_are_listed_and_no_backend_is_an_error() {
        let quads = shapes::torus(4, 4).expect("a torus");
        let study_mesh = StudyMesh::new("quads", quads);
        let stop = AtomicBool::new(false);
        let all = why(&study_mesh, &WhySettings::default(), &stop, &mut |_| ());
        let all = all.expect("five can hold the mesh");
        assert_eq!(all.backends.len(), 6);
        assert_eq!(all.rows.len(), 5 * 9, "a corner table holds triangles");
        let only = WhySettings {
            backends: vec!["corner-table".into()],
            ..WhySettings::default()
        };
        let none = why(&study_mesh, &only, &stop, &mut |_| ());
        assert!(matches!(none, Err(StudyError::NoneHolds { .. })));
    }
}
