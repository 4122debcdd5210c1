//! A whole study: builds the structures, measures them, compares the results, and makes the report.

mod methods;
pub(crate) mod sentences;

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::{QueryCost, Relation, UnknownName};
use sixfold_core::Counts;
use sixfold_measure::{MachineClock, Operation, StudyMesh, TimedBackend, is_skewed};

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::engine::measure::Progress;
use crate::external::{self, EXTERNAL_TIMEOUT, External, MeshFile};
use crate::inspect::{per_vertex, unbuilt};
use crate::labs::orders::prepared_bytes;
use sixfold_results::{
    BackendRefusal, BackendReport, CacheState, Confidence, Policy, Report, ResultRow, RunSettings,
    Samples, sanitize,
};

use crate::engine::warnings::warnings;
use crate::refusal::BuildInput;
use sixfold_measure::pages::HeapPolicyConflict;
use sixfold_workload::{Backend, Draw};

/// The settings of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The names of the backends. If the list is empty, all backends are measured.
    pub backends: Vec<String>,
    /// Additional structures that are not part of Sixfold.
    pub extra: Vec<Backend>,
    /// The external programs to measure.
    pub externals: Vec<External>,
    /// Time limit for one answer of an external program.
    pub external_timeout: Duration,
    /// The operations. If the list is empty, all operations are measured, but the time of a
    /// subdivision that takes a large part of the budget is only estimated.
    pub operations: Vec<Operation>,
    /// How much is measured. If a time limit is too short for an operation, the operation is run on
    /// only some of the elements, its time is estimated, or the operation is left out.
    pub effort: Effort,
    /// If true, every operation is run at least once on every backend, whatever it takes.
    pub force: bool,
    /// The number of untimed runs before each sample. `None` if the study chooses it, so that they fill the caches.
    pub warm_up: Option<u32>,
    /// The confidence of all intervals.
    pub confidence: Confidence,
    /// Seed of the random numbers that choose elements and the order of the measurements. The
    /// number of chosen elements does not depend on the seed.
    pub seed: u64,
    /// What happens to freed memory pages. Keeping the pages needs more memory. If there is too
    /// little memory, [`Policy::System`] is used.
    pub heap: Policy,
    /// The state of the processor caches when a timed series of runs starts.
    pub caches: CacheState,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            backends: Vec::new(),
            extra: Vec::new(),
            externals: Vec::new(),
            external_timeout: EXTERNAL_TIMEOUT,
            operations: Vec::new(),
            effort: Effort::Budget(Duration::from_secs(20)),
            force: false,
            warm_up: None,
            confidence: Confidence::default(),
            seed: 1,
            heap: Policy::Kept,
            caches: CacheState::Warm,
        }
    }
}

/// The reason why a study is not possible.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum StudyError {
    /// No backend has the requested name.
    #[error(transparent)]
    UnknownBackend(#[from] UnknownName),
    /// Two structures have the same name.
    #[error("two backends are called `{name}`: give each backend its own name")]
    RepeatedBackend { name: String },
    /// The mesh has no faces.
    #[error(
        "the mesh has no faces, so there is nothing to study: choose another mesh, or see its \
         facts with `sixfold inspect`"
    )]
    NoFaces,
    /// An external program has the name of a backend or of another external program.
    #[error("two backends or programs are called `{name}`: give each program its own name")]
    RepeatedExternal { name: String },
    /// The mesh file for the external programs cannot be written.
    #[error("the mesh file for the external programs cannot be written: {cause}")]
    NoMeshFile { cause: String },
    /// None of the selected backends can hold the mesh.
    #[error(
        "none of the selected backends can hold the mesh: {}; `sixfold repair --for NAME` makes a \
         mesh that the structure NAME can hold", reasons(.refusals)
    )]
    NoneHolds { refusals: Vec<BackendRefusal> },
    /// A measurement with another heap policy is active in this process.
    #[error(transparent)]
    HeapPolicy(#[from] HeapPolicyConflict),
}

impl StudyError {
    /// Returns the error for a mesh that no backend can hold, with the reasons.
    pub(crate) fn none_holds(backends: impl IntoIterator<Item: Into<BackendRefusal>>) -> Self {
        let refusals = backends.into_iter().map(Into::into);
        Self::NoneHolds {
            refusals: refusals.collect(),
        }
    }
}

fn reasons(refusals: &[BackendRefusal]) -> String {
    let reasons = (refusals.iter()).map(|r| format!("{}: {}", r.backend, r.reason));
    reasons.collect::<Vec<_>>().join("; ")
}

impl Settings {
    /// Returns the selected backends: first the structures of Sixfold, then the extra structures.
    ///
    /// # Errors
    ///
    /// Returns [`StudyError::UnknownBackend`] for an unknown name. Returns
    /// [`StudyError::RepeatedBackend`] if an extra backend has the name of another backend.
    pub fn chosen_backends(&self) -> Result<Vec<Backend>, StudyError> {
        let mut all = Backend::structures();
        for &extra in &self.extra {
            if all.contains(&extra) {
                let name = extra.name().to_owned();
                return Err(StudyError::RepeatedBackend { name });
            }
            all.push(extra);
        }
        UnknownName::check("backend", &self.backends, all.iter().map(Backend::name))?;
        let requested = |backend: &Backend| {
            self.backends.is_empty() || self.backends.iter().any(|name| name == backend.name())
        };
        Ok(all.into_iter().filter(requested).collect())
    }

    /// Checks that no external program has the name of a backend or of another external program.
    ///
    /// # Errors
    ///
    /// Returns [`StudyError::RepeatedExternal`] if a name is used twice.
    pub fn check_externals(&self) -> Result<(), StudyError> {
        let ours = Backend::structures()
            .into_iter()
            .chain(self.extra.iter().copied());
        let mut names: Vec<String> = ours.map(|backend| backend.name().to_owned()).collect();
        for External { name, .. } in &self.externals {
            if names.contains(name) {
                return Err(StudyError::RepeatedExternal { name: name.clone() });
            }
            names.push(name.clone());
        }
        Ok(())
    }

    /// Returns the settings that results have. A study does not know how its mesh was read, so
    /// `triangulate` and `strict` are false, and `reading` is empty.
    pub fn run_settings(&self) -> RunSettings {
        let externals = self.externals.iter().map(|other| other.name.clone());
        let operations = self
            .operations
            .iter()
            .map(|operation| operation.name().into());
        RunSettings {
            backends: self.backends.clone(),
            externals: externals.collect(),
            operations: operations.collect(),
            seed: self.seed,
            heap: self.heap,
            caches: self.caches,
            warm_up: self.warm_up,
            confidence: self.confidence,
            ..self.effort.run_settings()
        }
    }

    fn chosen_operations(&self) -> Vec<Operation> {
        let requested = |operation: &Operation| {
            self.operations.is_empty() || self.operations.contains(operation)
        };
        Operation::ALL.into_iter().filter(requested).collect()
    }
}

/// Measures the operations on the backends that can hold the mesh.
///
/// Setting `stop` to true ends the study after the current sample, with a report of the finished
/// part. `progress` is called with the current step.
///
/// The heap policy of `settings` applies to the whole process until the function returns; see
/// [`pages`](crate::pages#effect-on-the-process).
///
/// # Errors
///
/// Returns an error if the name of a backend is unknown or not unique, if the mesh has no faces, or
/// if no selected structure can hold the mesh. Also returns an error if the mesh file for external
/// programs cannot be written.
/// Also returns an error if another heap policy is active in this process.
pub fn study(
    study_mesh: &StudyMesh,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<Report, StudyError> {
    study_on(&MachineClock::start(), study_mesh, settings, stop, progress)
}

/// Does what [`study()`] does, on `machine`.
pub(crate) fn study_on(
    machine: &dyn Machine,
    study_mesh: &StudyMesh,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<Report, StudyError> {
    let budget = Budget::start(settings.effort, machine.clock());
    let chosen = settings.chosen_backends()?;
    settings.check_externals()?;
    let operations = settings.chosen_operations();
    let polygons = &study_mesh.polygons;
    if polygons.face_count() == 0 {
        return Err(StudyError::NoFaces);
    }
    let counts = polygons.counts(study_mesh.facts.edges);
    let needed = needed_bytes(&chosen, &operations, &counts);
    let mut bench = Bench::start(machine, settings.run_settings(), needed, stop)?;
    let skewed = is_skewed(&study_mesh.facts);
    let draw = chosen
        .iter()
        .any(|backend| skewed || scans(backend, &operations))
        .then(|| Draw::new(polygons, settings.seed));

    let input = BuildInput::from_study_mesh(study_mesh);
    let mut backends = Vec::new();
    let mut subjects: Vec<Box<dyn TimedBackend + '_>> = Vec::new();
    for backend in &chosen {
        let (report, subject) = prepare(backend, &input, draw.as_ref());
        backends.push(report);
        subjects.extend(subject.map(|built| machine.host(built, &counts)));
    }
    let mesh_file = match settings.externals.is_empty() {
        true => None,
        false => Some(
            MeshFile::write(polygons).map_err(|cause| StudyError::NoMeshFile {
                cause: cause.to_string(),
            })?,
        ),
    };
    let mut programs = Vec::new();
    for (external, mesh) in settings.externals.iter().zip(mesh_file.iter().cycle()) {
        let timeout = settings.external_timeout;
        let (report, subject) =
            external::prepare(external, mesh, &counts, &bench.memory.heap(), timeout, stop);
        backends.push(report);
        programs.extend(subject);
    }
    if subjects.is_empty() {
        return Err(StudyError::none_holds(backends));
    }

    let names: Vec<String> = subjects.iter().map(|s| s.name().to_owned()).collect();
    let columns = Columns::new(subjects, programs, |first| {
        let backend = chosen.iter().find(|b| b.name() == names[first])?;
        let (subject, _) = backend.prepare(polygons, draw.as_ref()).ok()?;
        Some(machine.host(subject, &counts))
    });
    let trial = Trial {
        polygons,
        counts,
        skewed,
        entries: columns.entries(&operations),
        columns,
        effort: budget.left(),
        named: !settings.operations.is_empty(),
        forced: settings.force,
        untimed: settings.warm_up,
        seed: settings.seed,
    };
    let measured = bench.measure(trial, progress);
    // An interrupted study ends its programs itself.
    for subject in measured
        .columns
        .subjects
        .iter()
        .filter(|_| !measured.interrupted)
    {
        let mut external = backends.iter_mut().filter(|b| b.name == subject.name());
        if let Some(external) = external.find_map(|backend| backend.external.as_mut()) {
            external.failed = subject.failure().map(sanitize);
        }
    }
    let results = measured.rows();
    let timer = bench.timer(measured.shortest_ns());
    let mut report = Report {
        run: bench.run(),
        mesh: study_mesh.report(),
        notes: Vec::new(),
        backends,
        results,
        refusals: measured.refusals(),
        samples: measured.samples(),
        control: measured.control,
        sentences: Vec::new(),
        warnings: Vec::new(),
        interrupted: measured.interrupted,
        timer: Some(timer),
    };
    conclude(&mut report, &chosen);
    Ok(report)
}

/// Writes the sentences, notes and warnings of a report. `backends` are the structures of which the costs of
/// queries are known.
pub(crate) fn conclude(report: &mut Report, backends: &[Backend]) {
    let scanning = |backend: &str, relation: Relation| {
        let costs = backends.iter().find(|b| b.name() == backend);
        costs.is_some_and(|b| b.info.costs[relation as usize] == QueryCost::Scan)
    };
    report.notes = sentences::notes(&report.backends, &report.results);
    report.sentences = sentences::answer(report, &scanning);
    report.warnings = sentences::mismatches(report);
    let rows: Vec<&ResultRow> = report.results.iter().collect();
    let samples: Vec<&Samples> = report.samples.iter().collect();
    let measured = report.timer.map(|timer| {
        let control = report.control.as_ref();
        warnings(&report.run, &timer, &rows, &samples, control)
    });
    report.warnings.extend(measured.into_iter().flatten());
}

/// Estimates the peak memory of the measurement in bytes. The sum includes the structures with
/// their outputs, the control, and the largest operation. A refined mesh has four times the faces.
/// It exists as polygons and as a structure.
pub(crate) fn needed_bytes(backends: &[Backend], operations: &[Operation], counts: &Counts) -> u64 {
    let bytes = backends
        .iter()
        .map(|backend| prepared_bytes(backend, counts));
    let (all, most) = bytes.fold((0, 0_u64), |(all, most), one| (all + one, most.max(one)));
    let makes = operations.iter().any(|operation| operation.creates_mesh());
    all + most * if makes { 10 } else { 3 }
}

pub(crate) fn scans(backend: &Backend, operations: &[Operation]) -> bool {
    let costs = &backend.info.costs;
    costs.contains(&QueryCost::Scan)
        && operations
            .iter()
            .any(|operation| operation.scans(costs).contains(&true))
}

pub(crate) fn prepare<'a>(
    backend: &Backend,
    input: &BuildInput<'a>,
    draw: Option<&'a Draw>,
) -> (BackendReport, Option<Box<dyn TimedBackend + 'a>>) {
    match backend.prepare(input.polygons, draw) {
        Err(refusal) => (unbuilt(backend, input, Err(refusal)), None),
        Ok((subject, memory)) => {
            let bytes = memory.total();
            let report = BackendReport {
                bytes: Some(bytes),
                bytes_per_vertex: per_vertex(bytes, &input.counts),
                tables: memory.tables,
                merged_vertices: Some(subject.merged_vertices()),
                ..unbuilt(backend, input, Ok(()))
            };
            (report, Some(subject))
        }
    }
}

#[cfg(test)]
mod tests;
