//! Why a structure takes the time it takes: what its queries read, beside what reading costs.
//!
//! Counting needs no clock and has no noise ([`Reads`]); a study of the same relations gives the times;
//! and [`MemorySpeed`] says what moving the bytes, or waiting for them, takes on this machine.
//! [`Bound::of`] holds the three against one another.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_with::{KeyValueMap, serde_as};
use sixfold::Relation;
use workload::{Backend, CACHE_LINES, Counted, Kind, LINE_BYTES, MOST_READS, MemorySpeed};
use workload::{Operation, REACH, Reads, Rung, SAMPLE};

use crate::environment::Environment;
use crate::inspect::{Specimen, unbuilt};
use crate::measure::Progress;
use crate::report::{Agreement, BackendReport, MeshReport, Report, SCHEMA, write_json};
use crate::study::{Settings, StudyError, study};

/// What to explain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WhySettings {
    /// Names of backends; empty for all.
    pub backends: Vec<String>,
    /// Representations that take part besides those of the roster.
    pub extra: Vec<Backend>,
    /// Relations; empty for all nine.
    pub relations: Vec<Relation>,
    /// How to measure; `None` to count only.
    pub timing: Option<Timing>,
}

/// How long to measure, and on what.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// How long the study may take.
    pub budget: Duration,
    /// How fast this machine reads memory.
    pub memory: MemorySpeed,
}

/// What a mesh's structures read, and what that has to do with their times.
#[serde_as]
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Why {
    /// The version of the shape.
    pub schema: u32,
    /// What the mesh is.
    pub mesh: MeshReport,
    /// By name, in the order of the roster.
    #[serde_as(as = "KeyValueMap<_>")]
    pub backends: Vec<BackendReport>,
    /// What the counts take memory to be.
    pub model: Model,
    /// How fast buffers of growing size are read; `None` where nothing was measured.
    pub memory: Option<Vec<Rung>>,
    /// Relation by relation, and within each in the order of the roster.
    pub rows: Vec<WhyRow>,
    /// Told to stop before the end: some rows or times are missing.
    pub interrupted: bool,
    /// The machine and the program; `None` where nothing was measured.
    pub environment: Option<Environment>,
}

/// What the counts take memory to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Model {
    /// Bytes of a cache line.
    pub line_bytes: usize,
    /// Lines of the small cache, first in, first out.
    pub cache_lines: u64,
    /// How many lines beside one that is there count as foreseen, on either side.
    pub reach: usize,
    /// Elements that stand for all.
    pub sample: usize,
    /// They do so where a query reads more rows than this on average.
    pub most_reads: u64,
}

impl Model {
    /// The only one there is.
    pub const HERE: Self = Self {
        line_bytes: LINE_BYTES,
        cache_lines: CACHE_LINES,
        reach: REACH,
        sample: SAMPLE,
        most_reads: MOST_READS,
    };
}

/// One relation on one backend.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct WhyRow {
    /// The backend.
    pub backend: String,
    /// What one element is: `vertex`, `edge` or `face`.
    pub per: String,
    /// What it reads.
    #[serde(flatten)]
    pub reads: Reads,
    /// What it takes; `None` where that was not measured.
    pub timed: Option<Timed>,
}

/// The time of a sweep, for each element, and what explains it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Timed {
    /// The median of the study, in nanoseconds.
    pub ns_per_element: f64,
    /// A sample of the elements stands for all.
    pub sampled: bool,
    /// Whether the other backends found the same.
    pub agreement: Agreement,
    /// How fast memory of the size of the sweep is read.
    pub speed: Rung,
    /// Nanoseconds that moving its bytes takes at that speed.
    pub floor_ns: f64,
    /// Nanoseconds that its jumps take at that speed, each waiting for the one before.
    pub waits_ns: f64,
    /// What it is bound by.
    pub bound: Bound,
}

/// What takes the time of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// Moving its bytes.
    Bandwidth,
    /// Waiting for lines that could not be foreseen.
    Latency,
    /// The steps themselves: reading what is near, comparing, branching.
    Work,
}

impl Bound {
    /// What explains a sweep of `ns`, whose bytes take `floor_ns` to move and whose jumps take
    /// `waits_ns`, one after the other.
    ///
    /// - `Bandwidth`, where moving the bytes takes half of the time or more: nothing could make it twice
    ///   as fast but fewer bytes.
    /// - `Latency`, where that is not so, and the jumps one after the other would take half of the time
    ///   or more. A processor has several on the way at once, so they may take less: it says that they
    ///   can be the reason, not that they are all of it.
    /// - `Work`, where neither accounts for half of the time.
    pub fn of(ns: f64, floor_ns: f64, waits_ns: f64) -> Self {
        if 2.0 * floor_ns >= ns {
            Self::Bandwidth
        } else if 2.0 * waits_ns >= ns {
            Self::Latency
        } else {
            Self::Work
        }
    }

    /// What users call it: `bandwidth`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bandwidth => "bandwidth",
            Self::Latency => "latency",
            Self::Work => "work",
        }
    }
}

impl Why {
    /// Times that no difference between the backends explains.
    pub fn mismatches(&self) -> usize {
        let timed = self.rows.iter().filter_map(|row| row.timed);
        timed
            .filter(|timed| timed.agreement == Agreement::Mismatch)
            .count()
    }

    /// Writes it as JSON.
    ///
    /// # Errors
    ///
    /// What `writer` reports.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// Counts what relations read on the backends that can hold the mesh, and measures them.
///
/// `stop` ends it early; what is finished by then is in the result. `progress` hears what is going on.
///
/// # Errors
///
/// As [`study`].
pub fn why(
    specimen: &Specimen,
    settings: &WhySettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<Why, StudyError> {
    let asked = |relation: &Relation| {
        settings.relations.is_empty() || settings.relations.contains(relation)
    };
    let relations: Vec<Relation> = Relation::ALL.into_iter().filter(asked).collect();
    let mut study_settings = Settings {
        backends: settings.backends.clone(),
        extra: settings.extra.clone(),
        operations: relations.iter().copied().map(Operation::Relation).collect(),
        ..Settings::default()
    };
    if specimen.polygons.face_count() == 0 {
        return Err(StudyError::NoFaces);
    }
    let (backends, mut rows) = count_all(specimen, &study_settings, &relations, stop, progress)?;
    // Stable: within a relation they stay in the order of the roster.
    rows.sort_by_key(|row| row.reads.relation);
    let mut environment = None;
    if let Some(Timing { budget, memory }) = &settings.timing
        && !stop.load(Ordering::Relaxed)
    {
        study_settings.budget = *budget;
        let report = study(specimen, &study_settings, stop, progress)?;
        for row in &mut rows {
            row.timed = timed(row, &report, memory);
        }
        environment = Some(report.environment);
    }
    let memory = settings.timing.as_ref().map(|timing| &timing.memory);
    Ok(Why {
        schema: SCHEMA,
        mesh: specimen.report(),
        backends,
        model: Model::HERE,
        memory: memory.map(|memory| memory.rungs().to_vec()),
        rows,
        interrupted: stop.load(Ordering::Relaxed),
        environment,
    })
}

/// Backend by backend: what it says to the mesh, and what it reads.
fn count_all(
    specimen: &Specimen,
    settings: &Settings,
    relations: &[Relation],
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<(Vec<BackendReport>, Vec<WhyRow>), StudyError> {
    let chosen = settings.chosen_backends()?;
    let counts = specimen.polygons.counts(specimen.facts.edges);
    let (mut backends, mut rows) = (Vec::new(), Vec::new());
    let all = (chosen.len() * relations.len()) as f64;
    for (i, backend) in chosen.iter().enumerate() {
        let mut counting = Rows {
            backend: backend.name(),
            done: (i * relations.len()) as f64 / all,
            step: 1.0 / all,
            rows: &mut rows,
            progress,
        };
        let polygons = &specimen.polygons;
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

/// The rows of one backend, as they are counted.
struct Rows<'a> {
    backend: &'static str,
    done: f64,
    step: f64,
    rows: &'a mut Vec<WhyRow>,
    progress: &'a mut dyn FnMut(Progress<'_>),
}

impl Counted for Rows<'_> {
    fn begins(&mut self, relation: Relation) {
        (self.progress)(Progress {
            done: self.done,
            stage: "counting",
            operation: Operation::Relation(relation),
            backend: self.backend,
        });
        self.done += self.step;
    }

    fn ends(&mut self, reads: Reads) {
        self.rows.push(WhyRow {
            backend: self.backend.to_owned(),
            per: Kind::asked(reads.relation).name().into(),
            reads,
            timed: None,
        });
    }
}

/// The time of a row in the report, held against the speed of memory.
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
        bound: Bound::of(ns_per_element, floor_ns, waits_ns),
    })
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;

    use super::*;

    fn counted(settings: &WhySettings) -> Result<Why, StudyError> {
        let grid = shapes::triangle_grid(6, 6).expect("a grid");
        let specimen = Specimen::new("grid", grid);
        why(&specimen, settings, &AtomicBool::new(false), &mut |_| ())
    }

    #[test]
    fn half_of_the_time_decides() {
        for (ns, floor, waits, bound) in [
            (10.0, 5.0, 0.0, Bound::Bandwidth),
            (10.0, 5.0, 50.0, Bound::Bandwidth),
            (10.0, 4.9, 5.0, Bound::Latency),
            (10.0, 4.9, 4.9, Bound::Work),
            (2.0, 0.0, 0.0, Bound::Work),
        ] {
            assert_eq!(Bound::of(ns, floor, waits), bound, "{ns} {floor} {waits}");
        }
    }

    #[test]
    fn rows_come_relation_by_relation_whatever_the_order_asked_for() {
        let asked = WhySettings {
            backends: vec!["half-edge".into(), "polygon-soup".into()],
            relations: vec![Relation::FaceVertices, Relation::VertexFaces],
            ..WhySettings::default()
        };
        let why = counted(&asked).expect("both hold it");
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
    fn a_time_is_held_against_memory_of_the_size_of_the_sweep() {
        let memory =
            MemorySpeed::measure(&workload::MachineClock::start(), &AtomicBool::new(false));
        let memory = memory.expect("nobody stops it");
        let asked = WhySettings {
            backends: vec!["half-edge".into()],
            relations: vec![Relation::VertexFaces],
            timing: Some(Timing {
                budget: Duration::from_millis(20),
                memory: memory.clone(),
            }),
            ..WhySettings::default()
        };
        let why = counted(&asked).expect("it is held");
        let [row] = &why.rows[..] else {
            panic!("one row: {:?}", why.rows);
        };
        let timed = row.timed.expect("measured");
        assert_eq!(timed.speed, memory.rungs()[0], "it fits the smallest");
        let floor = row.reads.moved_bytes / timed.speed.gb_per_s;
        assert_eq!(timed.floor_ns, floor);
        assert_eq!(timed.waits_ns, row.reads.jumps * timed.speed.latency_ns);
        assert!(timed.ns_per_element > 0.0 && why.mismatches() == 0);
        assert_eq!(why.memory.as_deref(), Some(memory.rungs()));
    }

    #[test]
    fn who_refuses_is_named_and_none_is_an_error() {
        let quads = shapes::torus(4, 4).expect("a torus");
        let specimen = Specimen::new("quads", quads);
        let go = AtomicBool::new(false);
        let all = why(&specimen, &WhySettings::default(), &go, &mut |_| ());
        let all = all.expect("most hold it");
        assert_eq!(all.backends.len(), 6);
        assert_eq!(all.rows.len(), 5 * 9, "a corner table holds triangles");
        let only = WhySettings {
            backends: vec!["corner-table".into()],
            ..WhySettings::default()
        };
        let none = why(&specimen, &only, &go, &mut |_| ());
        assert!(matches!(none, Err(StudyError::NoneHolds { .. })));
    }
}
