//! Measures how the time of an operation grows with the size of the mesh.
//!
//! One shape is built with several numbers of faces. The ratio of two successive numbers of faces
//! is constant. At each size, all structures are measured in rounds, as in a study. A straight line
//! is fitted to the logarithms of the number of faces and of the time. The slope of the line is the
//! exponent of the growth. The exponent is 1 if the time per element is constant. The exponent is 2
//! if each element needs a scan of all faces.
//!
//! The time per element also depends on the processor caches. A second line is therefore fitted to
//! the sizes at which the structure fits into the last-level cache. A third line is fitted to the
//! sizes at which the structure is larger than the last-level cache.

mod budgets;
mod fits;
mod sentences;
mod settings;
mod shapes;

use std::cell::Cell;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use sixfold::shapes::Order;
use sixfold::{Facts, PolygonMesh};
use sixfold_core::Counts;

pub use fits::{CacheLimit, Fit};
pub use settings::{GrowthError, GrowthSettings, growth_bytes};
pub use shapes::{SCALABLE_SHAPES, ScalableShape};

use crate::agreement::compare_checksums;
use crate::environment::Environment;
use crate::heap::Memory;
use crate::measure::Progress;
use crate::refusal::Candidate;
use crate::report::{Agreement, Control, Refusal, ResultRow, SCHEMA, write_json};
use crate::study::{StudyError, is_skewed, prepare, refusals, results, scans};
use crate::trial::{Columns, Measured, Trial};
use budgets::SizeBudgets;
use fits::{cache_limits, fits};
use settings::Plan;
use sixfold_workload::{Backend, Draw, MachineClock, TimedBackend};
use sixfold_workload::{Cache, caches, last_level_bytes};

/// The results for one shape in several sizes.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct GrowthReport {
    /// Version of the JSON schema.
    pub schema: u32,
    /// Name of the shape.
    pub shape: String,
    /// Order of the elements in memory.
    pub order: Order,
    /// The names of the measured backends.
    pub backends: Vec<String>,
    /// The backends that cannot hold the shape.
    #[serde(rename = "unheld")]
    pub refused_by: Vec<BackendRefusal>,
    /// The results at each measured size, beginning with the smallest size.
    pub sizes: Vec<SizeReport>,
    /// Approximate numbers of faces of the sizes that were left out because there was too little
    /// time.
    pub left_out: Vec<usize>,
    /// The fitted lines, sorted by operation, then by backend.
    pub fits: Vec<Fit>,
    /// The processor caches of this machine; empty if unknown.
    pub caches: Vec<Cache>,
    /// The number of faces at which each structure becomes larger than each cache. The list is
    /// sorted by cache, then by backend.
    #[serde(rename = "cache_ends")]
    pub cache_limits: Vec<CacheLimit>,
    /// Sentences that describe the results.
    #[serde(rename = "words")]
    pub sentences: Vec<String>,
    /// True if the measurement was stopped early. Some sizes may then be missing.
    pub interrupted: bool,
    /// The machine, the program and the settings.
    pub environment: Environment,
}

/// A backend that cannot hold the shape.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct BackendRefusal {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// Why the backend cannot hold the shape.
    pub reason: String,
}

/// The results at one size of the shape.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct SizeReport {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces.
    pub faces: usize,
    /// Size of each backend in bytes.
    #[serde(rename = "weights")]
    pub backend_bytes: Vec<BackendBytes>,
    /// The times of each operation on each backend.
    pub results: Vec<ResultRow>,
    /// Operations that a backend cannot do.
    pub refusals: Vec<Refusal>,
    /// The comparison of two measurements of one backend, which shows the noise. `None` if no
    /// backend was measured twice.
    pub control: Option<Control>,
}

/// The size of a backend in bytes.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct BackendBytes {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// Allocated bytes, including spare capacity.
    pub bytes: usize,
    /// Smallest level of a cache that can hold these bytes; `None` if no known cache is large
    /// enough.
    pub fits_in: Option<u8>,
}

impl GrowthReport {
    /// Counts the results that differ, for no known reason, from the results of other backends.
    pub fn mismatches(&self) -> usize {
        let rows = self.sizes.iter().flat_map(|size| &size.results);
        rows.filter(|row| row.agreement == Agreement::Mismatch)
            .count()
    }

    /// Writes the report as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// Measures a shape in several sizes, within the time budget of `settings`. A size is left out if
/// the structures of this size cannot be built in the remaining time.
///
/// Setting `stop` to true ends the measurement early, with a report of the finished sizes.
///
/// # Errors
///
/// Returns an error if the settings are invalid or if no requested backend can hold the shape.
pub fn growth(
    settings: &GrowthSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<GrowthReport, GrowthError> {
    let plan = settings.plan()?;
    let caches = caches();
    let budget = settings.study.budget;
    let environment = Environment::detect(settings.study.seed, budget.as_secs_f64());
    let mut sweep = Sweep {
        settings,
        plan: &plan,
        caches: &caches,
        stop,
        refused_by: Vec::new(),
        counts: None,
    };
    let study = &settings.study;
    let mut memory = Memory::start(study.heap, study.caches, growth_bytes(settings)?);
    let time = SizeBudgets::new(&plan.sizes, budget);
    let mut sizes: Vec<SizeReport> = Vec::new();
    let mut left_out = Vec::new();
    // Time per face for building everything at the previous size, in seconds.
    let mut building = 0.0;
    for (step, &faces) in plan.sizes.iter().enumerate() {
        if building * faces as f64 > time.left().as_secs_f64() {
            left_out = plan.sizes[step..].to_vec();
            break;
        }
        let start = Instant::now();
        let built = Cell::new(Duration::ZERO);
        let made = plan.shape.make(faces)?;
        let mesh = settings.order.apply(&made, settings.study.seed);
        drop(made);
        let range = time.range(step);
        let budget_left = || {
            built.set(start.elapsed());
            time.budget(step)
        };
        let mut report_progress = |at: Progress<'_>| {
            let stage = format!("{} faces: {}", mesh.face_count(), at.stage);
            progress(Progress {
                done: range[0] + (range[1] - range[0]) * at.done,
                stage: &stage,
                ..at
            });
        };
        match sweep.size(&mesh, step, &budget_left, &mut memory, &mut report_progress)? {
            Some(size) => sizes.push(size),
            None => break,
        }
        building = built.get().as_secs_f64() / faces as f64;
    }
    let interrupted = stop.load(Ordering::Relaxed);
    let backends: Vec<&Backend> = plan
        .backends
        .iter()
        .filter(|b| {
            sweep
                .refused_by
                .iter()
                .all(|other| other.backend != b.name())
        })
        .collect();
    let fits = fits(
        &sizes,
        &backends,
        &plan.operations,
        last_level_bytes(&caches),
    );
    let cache_limits = sweep
        .counts
        .map_or_else(Vec::new, |counts| cache_limits(&backends, &counts, &caches));
    let mut sentences = sentences::sentences(&sizes, &fits, &caches, &cache_limits);
    sentences.extend(sentences::left_out(&left_out));
    Ok(GrowthReport {
        schema: SCHEMA,
        shape: settings.shape.clone(),
        order: settings.order,
        backends: backends.iter().map(|b| b.name().to_owned()).collect(),
        refused_by: sweep.refused_by,
        sizes,
        left_out,
        fits,
        cache_limits,
        caches,
        sentences,
        interrupted,
        environment: environment.with_memory(&memory),
    })
}

struct Sweep<'s> {
    settings: &'s GrowthSettings,
    plan: &'s Plan,
    caches: &'s [Cache],
    stop: &'s AtomicBool,
    refused_by: Vec<BackendRefusal>,
    /// Counts of the largest finished size.
    counts: Option<Counts>,
}

impl Sweep<'_> {
    /// Measures one size. Returns `None` if interrupted.
    fn size(
        &mut self,
        mesh: &PolygonMesh,
        step: usize,
        budget: &dyn Fn() -> Duration,
        memory: &mut Memory,
        progress: &mut dyn FnMut(Progress<'_>),
    ) -> Result<Option<SizeReport>, GrowthError> {
        let Plan {
            backends,
            operations,
            ..
        } = self.plan;
        let stopped = || self.stop.load(Ordering::Relaxed);
        let facts = Facts::from_polygons(mesh);
        let counts = mesh.counts(facts.edges);
        let skewed = is_skewed(&facts);
        let seed = self.settings.study.seed;
        let needs_draw = backends.iter().any(|b| skewed || scans(b, operations));
        let draw = needs_draw.then(|| Draw::new(mesh, seed));
        let candidate = Candidate::with_facts(mesh, &facts);
        let mut subjects: Vec<Box<dyn TimedBackend + '_>> = Vec::new();
        let (mut backend_bytes, mut refused_by) = (Vec::new(), Vec::new());
        for backend in backends {
            if stopped() {
                return Ok(None);
            }
            let (report, subject) = prepare(backend, &candidate, draw.as_ref());
            match subject {
                Some(subject) => {
                    backend_bytes
                        .push(self.bytes_with_cache(report.name, report.bytes.unwrap_or(0)));
                    subjects.push(subject);
                }
                None => refused_by.push(BackendRefusal {
                    backend: report.name,
                    reason: report.reason.unwrap_or_default(),
                }),
            }
        }
        if subjects.is_empty() {
            let refusals = refused_by
                .into_iter()
                .map(|u| (u.backend, u.reason))
                .collect();
            return Err(StudyError::NoneHolds { refusals }.into());
        }
        self.refused_by = refused_by;
        let names: Vec<String> = subjects.iter().map(|s| s.name().to_owned()).collect();
        let mut columns = Columns::new(subjects, Vec::new(), |first| {
            let backend = backends.iter().find(|b| b.name() == names[first])?;
            let (subject, _) = backend.prepare(mesh, draw.as_ref()).ok()?;
            Some(subject)
        });
        let clock = MachineClock::start();
        let mut trial = Trial {
            counts,
            skewed,
            clock: &clock,
            memory,
            budget: budget(),
            named: !self.settings.study.operations.is_empty(),
            seed: seed.wrapping_add(step as u64),
            stop: self.stop,
            progress,
        };
        let entries = columns.entries(operations);
        let Measured {
            entries, control, ..
        } = trial.run(&mut columns, entries);
        let subjects = &mut columns.subjects;
        let agreements = compare_checksums(&entries, subjects, mesh, &clock, self.stop);
        if self.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        self.counts = Some(counts);
        Ok(Some(SizeReport {
            vertices: counts.vertices,
            edges: counts.edges,
            faces: counts.faces,
            backend_bytes,
            results: results(&entries, agreements, subjects, mesh, control.as_ref()),
            refusals: refusals(&entries, subjects),
            control,
        }))
    }

    fn bytes_with_cache(&self, backend: String, bytes: usize) -> BackendBytes {
        let data = self.caches.iter().filter(|cache| cache.holds_data());
        let room = data.filter(|cache| cache.bytes >= bytes as u64);
        BackendBytes {
            backend,
            bytes,
            fits_in: room.map(|cache| cache.level).min(),
        }
    }
}
