//! Studies many meshes, one after the other.

mod draw;
mod folder;
mod labs;
mod merge;
mod meshes;
mod pooled_table;

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use sixfold_study::{
    Collection, Failed, FailureKind, Report, Settings, SharedSettings, StudyError, StudyMesh,
};

use crate::arguments::Study;
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::load;
use crate::outcome::{command_line, studies_exit_code, warn_of_debug_build};
use crate::output::{Output, check_outputs, is_stdout};
use crate::progress::{Bar, interrupt_flag};
use crate::text::{TextOutput, hanging_indent, print_stderr, sanitize};
use sixfold_study::numbers::counted;

pub(crate) use draw::run as draw;
pub(crate) use labs::LabSelection;
pub(crate) use merge::run as merge;
pub(crate) use meshes::Shard;

use folder::{Folder, StudyRecord};
pub(crate) use meshes::{Mesh, find_meshes};

/// The text of [`FailureKind::NoneHolds`].
const NONE_HOLDS: &str = "none of the selected backends can hold the mesh: see `sixfold inspect`, or repair the mesh with \
     `sixfold repair --for NAME`";

/// Studies the selected meshes without a finished study. If a mesh cannot be loaded, lists the mesh
/// and continues.
pub(crate) fn run(arguments: &Study, settings: &Settings) -> Result<ExitCode, Failure> {
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_stderr(note))?;
    let single = meshes.len() == 1;
    check_files(arguments, &meshes)?;
    let selected_labs = labs::selected_labs(arguments.labs.as_ref(), single)?;
    let parts = match single {
        true => 1 + selected_labs.len(),
        false => meshes.len(),
    };
    let settings = &Settings {
        budget: part_of_budget(arguments, parts),
        ..settings.clone()
    };
    let names = meshes.iter().map(|mesh| mesh.name.clone()).collect();
    let mut collection = Collection::new(names, shared_settings(arguments, settings));
    let stop = interrupt_flag(settings.heap);
    let json = Output::open_if(arguments.json.as_ref())?;
    let csv = Output::open_if(arguments.csv.as_ref())?;
    let folder = match &arguments.report {
        Some(path) => Some(Folder::open(
            path,
            arguments.resume,
            &mut collection,
            &meshes,
        )?),
        None => None,
    };
    let selected = unfinished(&meshes, arguments.shard, &collection);
    warn_of_debug_build();
    let mut text = TextOutput::new(!uses_stdout(arguments));
    let loaded = match &meshes[..] {
        [mesh @ Mesh { problem: None, .. }] => Some(load_mesh(mesh, arguments)),
        _ => None,
    };
    if let Some(Ok(study_mesh)) = &loaded {
        print_before_measuring(study_mesh, settings, &mut text);
    }
    let run = Run {
        arguments,
        settings,
        single,
        labs: selected_labs.len(),
        loaded: loaded.as_ref(),
        folder: folder.as_ref(),
        stop: &stop,
    };
    run.study(&selected, &mut collection, &mut text)?;
    if let ([_], Some(Ok(study_mesh)), Some(folder)) = (&collection.studies[..], &loaded, &folder) {
        let runner = labs::LabRunner {
            study_mesh,
            settings,
            folder,
            resumed: selected.is_empty(),
            stop: &stop,
        };
        collection.labs = runner.run(&selected_labs)?;
    }
    let interrupted = stop.load(Ordering::Relaxed);
    let mut written = print_and_write(&collection, single, text, json, csv);
    let none_studied = collection.studies.is_empty() && !interrupted && arguments.shard.is_none();
    let not_measured = |failed: &Failed| failed.kind == FailureKind::NotMeasured;
    if let Some(folder) = &folder {
        // A report on nothing would look like a result.
        match none_studied && collection.failures.iter().all(not_measured) {
            true => folder.remove_failures(),
            false => written = written.and(folder.write_report(&collection, &command_line())),
        }
    }
    if none_studied {
        written?;
        return Err(failure_of_all(&collection.failures));
    }
    let mismatches = collection.labs.mismatches();
    studies_exit_code(written, &collection.studies, mismatches, interrupted)
}

/// Refuses outputs that overwrite a mesh. Refuses `--csv` for several meshes.
fn check_files(arguments: &Study, meshes: &[Mesh]) -> Result<(), Failure> {
    let outputs = [
        ("--json", arguments.json.as_ref()),
        ("--csv", arguments.csv.as_ref()),
    ];
    for path in meshes.iter().filter_map(|mesh| mesh.path.as_deref()) {
        check_outputs(Some(path), &outputs)?;
    }
    if arguments.csv.is_some() && meshes.len() != 1 {
        return Err(Failure::usage(
            "--csv is for one mesh: use --report DIR instead, to write the samples of all meshes \
             to results.csv",
        ));
    }
    Ok(())
}

/// Returns the time of one of `parts` equal parts: a mesh or a lab. A shard takes its part of the
/// meshes and of the time.
fn part_of_budget(arguments: &Study, parts: usize) -> Duration {
    match arguments.budget {
        Some(total) => total.div_f64(parts.max(1) as f64),
        None => Settings::default().budget,
    }
}

/// Returns the meshes of the shard without results in `collection`.
fn unfinished<'m>(
    meshes: &'m [Mesh],
    shard: Option<Shard>,
    collection: &Collection,
) -> Vec<&'m Mesh> {
    meshes
        .iter()
        .enumerate()
        .filter(|(i, _)| shard.is_none_or(|shard| shard.contains(*i)))
        .map(|(_, mesh)| mesh)
        .filter(|mesh| collection.missing.contains(&mesh.name))
        .collect()
}

/// Returns whether results are written to standard output. No text is printed in this case.
fn uses_stdout(arguments: &Study) -> bool {
    let data = [&arguments.json, &arguments.csv];
    data.into_iter().flatten().any(|path| is_stdout(path))
}

fn shared_settings(arguments: &Study, settings: &Settings) -> SharedSettings {
    let columns = settings
        .externals
        .iter()
        .map(|external| external.name.clone());
    SharedSettings {
        backends: settings.backends.clone(),
        externals: columns.collect(),
        operations: settings.operations.clone(),
        budget_s: settings.budget.as_secs_f64(),
        seed: settings.seed,
        heap: settings.heap,
        caches: settings.caches,
        triangulate: arguments.triangulate,
        strict: arguments.strict,
    }
}

/// The shared input of all studies.
struct Run<'a> {
    arguments: &'a Study,
    settings: &'a Settings,
    /// Whether only one mesh is studied. No progress line is printed in this case.
    single: bool,
    /// The number of labs after the study.
    labs: usize,
    /// The only mesh, or the reason why it cannot be loaded; `None` for several meshes.
    loaded: Option<&'a Result<StudyMesh, Failure>>,
    /// The folder in which finished studies are saved.
    folder: Option<&'a Folder>,
    stop: &'a AtomicBool,
}

impl Run<'_> {
    /// Studies `meshes` one after the other and adds the results to `collection`. Stops if
    /// interrupted.
    fn study(
        &self,
        meshes: &[&Mesh],
        collection: &mut Collection,
        text: &mut TextOutput,
    ) -> Result<(), Failure> {
        for (done, mesh) in meshes.iter().enumerate() {
            if self.stop.load(Ordering::Relaxed) {
                break;
            }
            let position = format!("{} of {}", done + 1, meshes.len() + self.labs);
            let Some(result) = self.measure_mesh(mesh, &position) else {
                break; // interrupted during this mesh
            };
            if !self.single {
                text.print_line(&progress_line(&position, mesh, &result));
            }
            let record = StudyRecord::new(mesh, &collection.settings, result);
            if let Some(folder) = self.folder {
                // Save between two studies, so that writing does not disturb the measurements.
                folder.save_study(&record)?;
            }
            record.add_to(collection);
        }
        Ok(())
    }

    /// Studies one mesh. Returns `None` if interrupted.
    fn measure_mesh(&self, mesh: &Mesh, position: &str) -> Option<Result<Report, Failed>> {
        let failed = |kind, reason| {
            let mesh = mesh.name.clone();
            Some(Err(Failed { mesh, reason, kind }))
        };
        if let Some(problem) = &mesh.problem {
            return failed(FailureKind::NotMeasured, problem.clone());
        }
        let own;
        let loaded = match self.loaded {
            Some(loaded) => loaded,
            None => {
                own = load_mesh(mesh, self.arguments);
                &own
            }
        };
        let study_mesh = match (loaded, &mesh.path) {
            (Ok(study_mesh), _) => study_mesh,
            (Err(failure), None) => {
                return failed(FailureKind::NotMeasured, failure.message.clone());
            }
            (Err(failure), Some(path)) => {
                let reason = without_path(&failure.message, path);
                return failed(FailureKind::NotMeasured, reason);
            }
        };
        let bar = Bar::new();
        let report = sixfold_study::study(study_mesh, self.settings, self.stop, &mut |at| {
            let stage = format!("{position}, {}: {}", mesh.name, at.stage);
            bar.show(sixfold_study::Progress {
                stage: &stage,
                ..at
            });
        });
        bar.clear();
        match report {
            Ok(report) if report.interrupted => None,
            Ok(mut report) => {
                report.environment.command = Some(command_line());
                Some(Ok(report))
            }
            Err(StudyError::NoneHolds { .. }) => failed(FailureKind::NoneHolds, NONE_HOLDS.into()),
            Err(error) => failed(FailureKind::NotMeasured, error.to_string()),
        }
    }
}

fn load_mesh(mesh: &Mesh, arguments: &Study) -> Result<StudyMesh, Failure> {
    match &mesh.path {
        None => Ok(load::built_in()),
        Some(path) => load::for_study(path, arguments.strict, arguments.triangulate),
    }
}

/// Removes the path from a message, because the list already shows the path.
fn without_path(message: &str, path: &Path) -> String {
    let Some(rest) = message.strip_prefix(&path.display().to_string()) else {
        return message.to_owned();
    };
    match rest.strip_prefix(": ") {
        Some(rest) => rest.to_owned(),
        None => format!("line {}", rest.trim_start_matches(':')),
    }
}

fn progress_line(position: &str, mesh: &Mesh, result: &Result<Report, Failed>) -> String {
    let name = sanitize(&mesh.name);
    match result {
        Ok(report) => {
            let faces = counted(report.mesh.facts.faces, "face", "faces");
            let columns = report.backends.iter().filter(|column| column.holds).count();
            let columns = counted(columns, "column", "columns");
            let rows = counted(report.results.len(), "figure", "figures");
            format!("{position}: {name}, {faces}, {columns}, {rows}")
        }
        Err(failed) => hanging_indent(&format!("{position}: {name}: "), &sanitize(&failed.reason)),
    }
}

/// Prints the results and writes them to the open files.
fn print_and_write(
    collection: &Collection,
    single: bool,
    mut text: TextOutput,
    json: Option<Output>,
    csv: Option<Output>,
) -> Result<(), Failure> {
    if let ([study], true) = (&collection.studies[..], single) {
        crate::study::print(study, &mut text);
        labs::print(&collection.labs, &mut text);
        return text
            .finish()
            .and(crate::study::write_files(study, json, csv));
    }
    print(collection, &mut text);
    let mut written = text.finish();
    if let Some(output) = json {
        written = written.and(output.finish(|writer| collection.write_json(writer)));
    }
    written
}

fn print(collection: &Collection, text: &mut TextOutput) {
    let studied = counted(collection.studies.len(), "mesh", "meshes");
    text.print_line("");
    text.print_line(&format!("{studied} of {} studied", collection.meshes.len()));
    for failed in &collection.failures {
        let first = format!("! {}: ", sanitize(&failed.mesh));
        text.print_line(&hanging_indent(&first, &sanitize(&failed.reason)));
    }
    if !collection.missing.is_empty() {
        let missing = counted(collection.missing.len(), "mesh is", "meshes are");
        text.print_line(&format!("! {missing} not studied yet"));
    }
    let pool = collection.pool();
    if !pool.all().is_empty() {
        text.print_line("");
        text.print_line(&pooled_table::pooled_table(&pool, text.bold()));
        text.print_line("");
        for sentence in &pool.sentences {
            text.print_line(&hanging_indent("- ", sentence));
        }
        for warning in &pool.warnings {
            text.print_line(&hanging_indent("! ", &sanitize(warning)));
        }
    }
    for failed in &collection.failures {
        let mesh = &failed.mesh;
        print_stderr(&format!("note: {mesh}: not studied: {}", failed.reason));
    }
}

/// Returns the failure of a run in which no mesh could be studied.
fn failure_of_all(failures: &[Failed]) -> Failure {
    let mut kinds = failures.iter().map(|failed| failed.kind);
    match kinds.all(|kind| kind == FailureKind::NoneHolds) {
        true => Failure::unsupported(
            "all meshes failed, because none of the selected backends can hold them: choose other \
             --backends, or see `sixfold inspect`",
        ),
        false => Failure::usage(
            "none of the meshes could be studied: repair the files that the notes above name",
        ),
    }
}
