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
use sixfold_measure::{ElementKind, LINE_BYTES, MachineClock, MemorySpeed, Operation, StudyMesh};
use sixfold_results::launches::{LaunchRows, pool_rows};
use sixfold_results::statistics::median;
use sixfold_results::{
    Agreement, BackendReport, Bound, BufferSpeed, Confidence, Model, Reads, ResultRow, Samples,
    Timed, Why, WhyRow,
};
use sixfold_workload::{Backend, CACHE_LINES, MAX_READS, REACH, ReadsObserver, SCAN_SAMPLE};

use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::engine::measure::Progress;
use crate::engine::run::start_run;
use crate::engine::warnings::warnings;
use crate::inspect::unbuilt;
use crate::labs::study::sentences::fault;
use crate::labs::study::{Settings, StudyError, study_on};
use crate::refusal::BuildInput;
use sixfold_measure::launches::{pool_runs, pool_timers};
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
    /// How much is measured. A time limit includes the counting, which takes as long as it takes: at least half of the
    /// limit is for the times. Up to half of the rest is for the measurement of the memory.
    pub effort: Effort,
    /// Seed of the random numbers that choose the order of the measurements, and the elements of samples.
    pub seed: u64,
    /// The confidence of all intervals.
    pub confidence: Confidence,
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
    study_settings.effort = Effort::Budget(Duration::ZERO);
    if let Some(timing) = settings.timing {
        (study_settings.effort, study_settings.seed) = (timing.effort, timing.seed);
        study_settings.confidence = timing.confidence;
    }
    let budget = Budget::start(study_settings.effort, machine.clock());
    let mut run = start_run(study_settings.run_settings());
    let (backends, mut rows) = count_all(study_mesh, &study_settings, &relations, stop, progress)?;
    // The sort is stable: the rows of one relation stay in the order of the backends.
    rows.sort_by_key(|row| row.reads.relation);
    // The times get at least half of the time.
    let effort = match (budget.left(), study_settings.effort.part(0.5)) {
        (Effort::Budget(left), Effort::Budget(half)) => Effort::Budget(left.max(half)),
        (rounds, _) => rounds,
    };
    let budget = Budget::start(effort, machine.clock());
    let (mut samples, mut control, mut timer) = (Vec::new(), None, None);
    let memory = settings.timing.and_then(|_| {
        progress(MEASURING_MEMORY);
        let half = effort.part(0.5).budget();
        machine.memory_speed(half.unwrap_or(Duration::MAX), stop)
    });
    if let Some(memory) = &memory
        && !stop.load(Ordering::Relaxed)
    {
        study_settings.effort = budget.left();
        let report = study_on(machine, study_mesh, &study_settings, stop, progress)?;
        compare(&mut rows, &report.results, memory);
        run.environment = report.run.environment;
        (samples, control, timer) = (report.samples, report.control, report.timer);
    }
    let mut why = Why {
        run,
        mesh: study_mesh.report(),
        backends,
        sentences: Vec::new(),
        model: CURRENT_MODEL,
        memory: memory.map(|memory| memory.speeds().to_vec()),
        rows,
        control,
        samples,
        warnings: Vec::new(),
        interrupted: stop.load(Ordering::Relaxed),
        timer,
    };
    conclude(&mut why);
    Ok(why)
}

/// Adds the sentences and the warnings.
fn conclude(why: &mut Why) {
    let holding = why.backends.iter().filter(|backend| backend.holds).count();
    // An interruption may end the counting early.
    why.sentences = match why.rows.len() == holding * why.run.settings.operations.len() {
        true => sentences::sentences(&why.rows),
        false => Vec::new(),
    };
    let results = why.results();
    let rows: Vec<&ResultRow> = results.iter().collect();
    let samples: Vec<&Samples> = why.samples.iter().collect();
    let wrong = results.iter();
    let wrong = wrong.filter(|row| row.agreement == Agreement::Mismatch);
    let mut all: Vec<String> = wrong.map(fault).collect();
    if let Some(timer) = &why.timer {
        let control = why.control.as_ref();
        all.extend(warnings(&why.run, timer, &rows, &samples, control));
        let speeds = why.memory.clone().and_then(MemorySpeed::from_speeds);
        all.extend(speeds.as_ref().and_then(left_out_buffers));
    }
    why.warnings = all;
}

/// Pools what several launches measured on one mesh. Counts are the same in all launches. The speed of a buffer is the
/// median over the launches.
pub(crate) fn pool_why(mut launches: Vec<Why>) -> Why {
    if launches.len() == 1 {
        return launches.remove(0);
    }
    let results: Vec<Vec<ResultRow>> = launches.iter().map(Why::results).collect();
    let rows = launches.iter().zip(&results);
    let rows = rows.map(|(launch, results)| LaunchRows {
        results,
        refusals: &[],
        samples: &launch.samples,
        control: launch.control.as_ref(),
    });
    let rows: Vec<LaunchRows<'_>> = rows.collect();
    let confidence = launches[0].run.settings.confidence;
    let pooled = pool_rows(&rows, confidence, |row| row.operation.clone());
    let memory = MemorySpeed::from_speeds(pool_speeds(&launches));
    // An interrupted launch may lack counts.
    let whole = launches.iter().max_by_key(|launch| launch.rows.len());
    let whole = whole.unwrap_or(&launches[0]);
    let mut why = Why {
        run: pool_runs(launches.iter().map(|launch| &launch.run)),
        timer: pool_timers(launches.iter().filter_map(|launch| launch.timer)),
        interrupted: launches.iter().any(|launch| launch.interrupted),
        memory: memory.as_ref().map(|memory| memory.speeds().to_vec()),
        control: pooled.control,
        samples: pooled.samples,
        ..whole.clone()
    };
    if let Some(memory) = &memory {
        compare(&mut why.rows, &pooled.results, memory);
    }
    conclude(&mut why);
    why
}

/// Returns the median speed of each buffer over the launches that measured it, starting with the smallest buffer.
fn pool_speeds(launches: &[Why]) -> Vec<BufferSpeed> {
    let speeds = || launches.iter().filter_map(|launch| launch.memory.as_ref());
    let mut sizes: Vec<usize> = speeds().flatten().map(|speed| speed.bytes).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let typical = |bytes: usize, value: fn(&BufferSpeed) -> f64| {
        let of_size = speeds().flatten().filter(|speed| speed.bytes == bytes);
        median(of_size.map(value).collect())
    };
    let pooled = sizes.into_iter().filter_map(|bytes| {
        Some(BufferSpeed {
            bytes,
            gb_per_s: typical(bytes, |speed| speed.gb_per_s)?,
            latency_ns: typical(bytes, |speed| speed.latency_ns)?,
        })
    });
    pooled.collect()
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

/// Adds the times `results` to the rows, compared with the speed of memory.
fn compare(rows: &mut [WhyRow], results: &[ResultRow], memory: &MemorySpeed) {
    for row in rows {
        let key = (row.reads.relation.name(), row.backend.as_str());
        let mut results = results.iter();
        let result = results.find(|result| (&*result.operation, &*result.backend) == key);
        row.timed = result.and_then(|result| timed(row, result, memory));
    }
}

/// Returns a time, compared with the speed of memory.
fn timed(row: &WhyRow, result: &ResultRow, memory: &MemorySpeed) -> Option<Timed> {
    let ns_per_element = result.ns_per_element?;
    let elements = result.elements? as f64;
    let each = |ns: f64| ns / elements;
    let launches = result.launch_ns.iter();
    let speed = memory.at(row.reads.sweep_bytes(LINE_BYTES));
    let floor_ns = row.reads.moved_bytes / speed.gb_per_s;
    let waits_ns = row.reads.jumps * speed.latency_ns;
    Some(Timed {
        ns_per_element,
        launch_ns: launches.map(|ns| ns.map(each)).collect(),
        ci_low_ns: result.ci_low_ns.map(each),
        ci_high_ns: result.ci_high_ns.map(each),
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
                seed: 1,
                confidence: Confidence::default(),
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
        let timed = row.timed.as_ref().expect("measured");
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
                seed: 1,
                confidence: Confidence::default(),
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
    fn launches_are_pooled_and_explained_anew() {
        let study_mesh = StudyMesh::new("grid", shapes::triangle_grid(6, 6).expect("a grid"));
        let settings = WhySettings {
            backends: vec!["half-edge".into(), "face-vertex".into()],
            relations: vec![Relation::VertexFaces],
            timing: Some(Timing {
                effort: Effort::of_rounds(2),
                seed: 1,
                confidence: Confidence::default(),
            }),
            ..WhySettings::default()
        };
        let stop = AtomicBool::new(false);
        let machine = SimulatedMachine::equal_costs();
        let first = why_on(&machine, &study_mesh, &settings, &stop, &mut |_| ());
        let first = first.expect("both can hold the mesh");
        let buffer = |bytes, gb_per_s, latency_ns| BufferSpeed {
            bytes,
            gb_per_s,
            latency_ns,
        };
        let small = first.memory.as_ref().expect("measured")[0].bytes;
        // A launch takes `times` the time of the first.
        let launch = |times: f64, memory: Vec<BufferSpeed>| {
            let mut launch = first.clone();
            launch.memory = Some(memory);
            for timed in launch.rows.iter_mut().filter_map(|row| row.timed.as_mut()) {
                timed.ns_per_element *= times;
                timed.bound = Bound::Bandwidth;
            }
            launch
        };
        let pooled = pool_why(vec![
            launch(1.0, vec![buffer(small, 1.0, 3.0)]),
            launch(
                2.0,
                vec![buffer(small, 4.0, 2.0), buffer(4 * small, 0.5, 9.0)],
            ),
            launch(4.0, vec![buffer(small, 9.0, 1.0)]),
        ]);
        let memory = [buffer(small, 4.0, 2.0), buffer(4 * small, 0.5, 9.0)];
        assert_eq!(pooled.memory.as_deref(), Some(&memory[..]));
        assert_eq!(pooled.run.settings.launches, NonZeroU32::new(3));
        assert_eq!(pooled.rows.len(), 2);
        for (row, one) in pooled.rows.iter().zip(&first.rows) {
            let (timed, one_ns) = (row.timed.as_ref().expect("measured"), one.timed.as_ref());
            let one_ns = one_ns.expect("measured").ns_per_element;
            assert_eq!(row.reads, one.reads);
            let close = |ns: f64, factor: f64| (ns / one_ns / factor - 1.0).abs() < 1e-9;
            let launches: Vec<f64> = timed.launch_ns.iter().copied().flatten().collect();
            assert!(
                close(launches[0], 1.0) && close(launches[2], 4.0),
                "{timed:?}"
            );
            assert!(close(timed.ns_per_element, 2.0), "{timed:?}");
            let [low, high] =
                [timed.ci_low_ns, timed.ci_high_ns].map(|ns| ns.expect("an interval"));
            assert!(low < timed.ns_per_element && timed.ns_per_element < high);
            assert_eq!(
                timed.speed, memory[0],
                "the queries touch less than the second buffer"
            );
            assert_eq!(timed.floor_ns, row.reads.moved_bytes / 4.0);
            assert_eq!(timed.waits_ns, 2.0 * row.reads.jumps);
            let bound = Bound::from_times(timed.ns_per_element, timed.floor_ns, timed.waits_ns);
            assert_eq!(
                (timed.bound, bound),
                (Bound::Work, Bound::Work),
                "{timed:?}"
            );
        }
        assert!(
            pooled.sentences[1].contains("work on nearby data in 2"),
            "{pooled:?}"
        );
        let left_out = pooled.warnings.iter();
        let left_out: Vec<_> = left_out
            .filter(|w| w.contains("speed of buffers"))
            .collect();
        assert_eq!(left_out.len(), 1, "{:?}", pooled.warnings);
        assert!(left_out[0].contains(&bytes(16 * small)), "{left_out:?}");
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
