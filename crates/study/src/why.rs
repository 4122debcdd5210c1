//! Explains the times of the relations on a structure by the memory that they read.
//!
//! The counts of reads ([`Reads`]) need no clock and have no noise. A study measures the times of
//! the same relations. [`MemorySpeed`] is the time in which this machine moves bytes or waits for
//! them. [`Bound::from_times`] compares these values.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_with::{KeyValueMap, serde_as};
use sixfold::Relation;
use sixfold_workload::{
    Backend, CACHE_LINES, ElementKind, LINE_BYTES, MAX_READS, MemorySpeed, ReadsObserver,
};
use sixfold_workload::{BufferSpeed, Operation, REACH, Reads, SCAN_SAMPLE};

use crate::environment::Environment;
use crate::inspect::{StudyMesh, unbuilt};
use crate::measure::Progress;
use crate::report::{Agreement, BackendReport, MeshReport, Report, SCHEMA, write_json};
use crate::study::{Settings, StudyError, study};

/// The settings of [`why`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WhySettings {
    /// The names of the backends. If the list is empty, all backends are used.
    pub backends: Vec<String>,
    /// Additional structures that are not part of Sixfold.
    pub extra: Vec<Backend>,
    /// The relations. If the list is empty, all nine relations are used.
    pub relations: Vec<Relation>,
    /// The settings of the measurement. `None` means that reads are only counted.
    pub timing: Option<Timing>,
}

/// The settings of the measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// Time limit of the study.
    pub budget: Duration,
    /// The speed at which this machine reads memory.
    pub memory: MemorySpeed,
}

/// The reads of the structures of a mesh, compared with their times.
#[serde_as]
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Why {
    /// The version of the format.
    pub schema: u32,
    /// Name and topology of the mesh.
    pub mesh: MeshReport,
    /// The backends, in the order of [`Backend::structures`].
    #[serde_as(as = "KeyValueMap<_>")]
    pub backends: Vec<BackendReport>,
    /// The model of memory that the counts use.
    pub model: Model,
    /// The reading speed for buffers of growing size; `None` if nothing was measured.
    pub memory: Option<Vec<BufferSpeed>>,
    /// The rows, by relation, then in the order of [`Backend::structures`].
    pub rows: Vec<WhyRow>,
    /// Whether the command was stopped early. Some rows or times may then be missing.
    pub interrupted: bool,
    /// The machine and the program version; `None` if nothing was measured.
    pub environment: Option<Environment>,
}

/// The model of memory that the counts use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Model {
    /// Size of a cache line, in bytes.
    pub line_bytes: usize,
    /// Number of lines in the modelled cache. A full cache drops the line that came in first.
    pub cache_lines: u64,
    /// Maximum distance of a fetch from a cached line, in lines. A more distant fetch is a jump.
    pub reach: usize,
    /// Number of elements in a sample.
    pub sample: usize,
    /// Maximum mean number of rows per query without sampling.
    pub most_reads: u64,
}

impl Model {
    /// The model that this version uses.
    pub const CURRENT: Self = Self {
        line_bytes: LINE_BYTES,
        cache_lines: CACHE_LINES,
        reach: REACH,
        sample: SCAN_SAMPLE,
        most_reads: MAX_READS,
    };
}

/// One relation on one backend.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct WhyRow {
    /// The backend.
    pub backend: String,
    /// The kind of the elements that are queried: `vertex`, `edge` or `face`.
    pub per: String,
    /// The counts of reads.
    #[serde(flatten)]
    pub reads: Reads,
    /// The time; `None` if it was not measured.
    pub timed: Option<Timed>,
}

/// The time of a sweep over all elements, and the explanation of this time.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Timed {
    /// The median time per element, in nanoseconds.
    pub ns_per_element: f64,
    /// Whether only a sample of the elements was timed.
    pub sampled: bool,
    /// Whether the checksum is the same as for other backends.
    pub agreement: Agreement,
    /// The reading speed for a buffer of the size of the sweep.
    pub speed: BufferSpeed,
    /// The time for moving the bytes of one element, in nanoseconds.
    pub floor_ns: f64,
    /// The time for the jumps of one element, one jump after the other, in nanoseconds.
    pub waits_ns: f64,
    /// The limiting factor.
    pub bound: Bound,
}

/// The limiting factor of the time of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// Moving the bytes.
    Bandwidth,
    /// Waiting for lines that a prefetcher cannot predict.
    Latency,
    /// Computation on data in the cache.
    Work,
}

impl Bound {
    /// Returns the limiting factor of a sweep of `ns` nanoseconds. `floor_ns` is the time for
    /// moving the bytes. `waits_ns` is the time for all jumps, one after the other.
    ///
    /// - `Bandwidth` if moving the bytes takes at least half of the time.
    /// - `Latency` if moving the bytes takes less, but the jumps take at least half of the time. A
    ///   processor overlaps jumps, so the jumps may take less time than `waits_ns`.
    /// - `Work` in all other cases.
    pub fn from_times(ns: f64, floor_ns: f64, waits_ns: f64) -> Self {
        if 2.0 * floor_ns >= ns {
            Self::Bandwidth
        } else if 2.0 * waits_ns >= ns {
            Self::Latency
        } else {
            Self::Work
        }
    }

    /// Returns the name in files: `bandwidth`, `latency` or `work`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bandwidth => "bandwidth",
            Self::Latency => "latency",
            Self::Work => "work",
        }
    }
}

impl Why {
    /// Returns the number of results that differ between backends without a known reason.
    pub fn mismatches(&self) -> usize {
        let timed = self.rows.iter().filter_map(|row| row.timed);
        timed
            .filter(|timed| timed.agreement == Agreement::Mismatch)
            .count()
    }

    /// Writes the result as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// Counts the reads of relations on the backends that can hold the mesh, and measures the times.
///
/// Setting `stop` ends the measurement early. The result then contains the finished part.
/// `progress` is called with the current step.
///
/// # Errors
///
/// Returns the same errors as [`study`].
pub fn why(
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
    let (backends, mut rows) = count_all(study_mesh, &study_settings, &relations, stop, progress)?;
    // The sort is stable: the rows of one relation stay in the order of the backends.
    rows.sort_by_key(|row| row.reads.relation);
    let mut environment = None;
    if let Some(Timing { budget, memory }) = &settings.timing
        && !stop.load(Ordering::Relaxed)
    {
        study_settings.budget = *budget;
        let report = study(study_mesh, &study_settings, stop, progress)?;
        for row in &mut rows {
            row.timed = timed(row, &report, memory);
        }
        environment = Some(report.environment);
    }
    let memory = settings.timing.as_ref().map(|timing| &timing.memory);
    Ok(Why {
        schema: SCHEMA,
        mesh: study_mesh.report(),
        backends,
        model: Model::CURRENT,
        memory: memory.map(|memory| memory.speeds().to_vec()),
        rows,
        interrupted: stop.load(Ordering::Relaxed),
        environment,
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
    let counts = study_mesh.polygons.counts(study_mesh.facts.edges);
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
        let polygons = &study_mesh.polygons;
        let verdict = backend.count_reads(polygons, relations, stop, &mut counting);
        backends.push(unbuilt(backend, &counts, verdict));
    }
    if backends.iter().all(|backend| !backend.holds) {
        let refusals = backends
            .into_iter()
            .map(|b| (b.name, b.reason.unwrap_or_default()));
        return Err(StudyError::NoneHolds {
            refusals: refusals.collect(),
        });
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
            operation: Operation::Relation(relation),
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

/// Returns the time from the report, compared with the speed of memory.
fn timed(row: &WhyRow, report: &Report, memory: &MemorySpeed) -> Option<Timed> {
    let mut results = report.rows(Operation::Relation(row.reads.relation));
    let result = results.find(|result| result.backend == row.backend)?;
    let ns_per_element = result.ns_per_element?;
    let speed = memory.at(row.reads.sweep_bytes());
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

    use super::*;

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
        assert!(why.memory.is_none() && why.environment.is_none());
    }

    #[test]
    fn a_time_is_compared_with_memory_of_the_size_of_the_sweep() {
        let memory = MemorySpeed::measure(
            &sixfold_workload::MachineClock::start(),
            &AtomicBool::new(false),
        );
        let memory = memory.expect("not stopped");
        let settings = WhySettings {
            backends: vec!["half-edge".into()],
            relations: vec![Relation::VertexFaces],
            timing: Some(Timing {
                budget: Duration::from_millis(20),
                memory: memory.clone(),
            }),
            ..WhySettings::default()
        };
        let why = counted(&settings).expect("it can hold the mesh");
        let [row] = &why.rows[..] else {
            panic!("one row: {:?}", why.rows);
        };
        let timed = row.timed.expect("measured");
        assert_eq!(timed.speed, memory.speeds()[0], "it fits the smallest");
        let floor = row.reads.moved_bytes / timed.speed.gb_per_s;
        assert_eq!(timed.floor_ns, floor);
        assert_eq!(timed.waits_ns, row.reads.jumps * timed.speed.latency_ns);
        assert!(timed.ns_per_element > 0.0 && why.mismatches() == 0);
        assert_eq!(why.memory.as_deref(), Some(memory.speeds()));
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
