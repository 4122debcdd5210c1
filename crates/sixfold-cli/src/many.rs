//! Studies many meshes, one after the other.

mod draw;
mod folder;
mod labs;
mod merge;
mod pooled_table;

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use sixfold_results::{Failed, FailureKind, Finding, Report, Results};
use sixfold_study::{Settings, StudyMesh};

use crate::arguments::Study;
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::launches::{Launching, Part};
use crate::listed_folder::ListedFolder;
use crate::load;
use crate::measure::{Session, command_line, measured_code, warn_of_debug_build, with_command};
use crate::mesh_files::shown;
use crate::mesh_picture::with_picture;
use crate::paper;
use crate::progress::Bar;
use crate::study::{finding, measure};
use crate::text::{TextOutput, hanging_indent, print_notice, sanitize, take_notices};
use sixfold_results::numbers::counted;

pub(crate) use draw::run as draw;
pub(crate) use labs::{Lab, LabSelection};
pub(crate) use merge::run as merge;
pub(crate) use sixfold_measure::command::meshes::Shard;

use folder::Folder;
pub(crate) use sixfold_measure::command::meshes::{Mesh, find_mesh, find_meshes};

/// The text of [`FailureKind::NoneHolds`].
const NONE_HOLDS: &str = "none of the selected backends can hold the mesh: see `sixfold inspect`, or repair the mesh with \
     `sixfold repair --for NAME`";

/// Studies the selected meshes without a finished study. If a mesh cannot be loaded, lists the mesh
/// and continues.
pub(crate) fn run(arguments: &Study, settings: &Settings) -> Result<ExitCode, Failure> {
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_notice(note))?;
    let single = meshes.len() == 1;
    let selected_labs = labs::selected_labs(arguments.labs.as_ref(), single)?;
    let parts = match single {
        true => 1 + selected_labs.len(),
        false => meshes.len(),
    };
    let settings = &Settings {
        effort: arguments.effort(parts),
        ..settings.clone()
    };
    let paths = meshes.iter().filter_map(|mesh| mesh.path.as_deref());
    let mut session = Session::open(paths, &arguments.files, settings.heap)?;
    let mut results = Results::new(meshes.iter().map(|mesh| mesh.name.clone()).collect());
    let folder = match &arguments.report {
        Some(path) => Some(Folder::open(
            path,
            arguments,
            settings,
            &meshes,
            &mut results,
        )?),
        None => None,
    };
    let paper = ListedFolder::open_if(arguments.figures.as_ref())?;
    let selected = unfinished(&meshes, arguments.shard, &results);
    warn_of_debug_build();
    results.add_notices(take_notices());
    let loaded = match &meshes[..] {
        [mesh @ Mesh { problem: None, .. }] => Some(load_mesh(mesh, arguments)),
        _ => None,
    };
    if let Some(Ok(study_mesh)) = &loaded {
        print_before_measuring(study_mesh, settings, &mut session.text);
    }
    let stop = Arc::clone(&session.stop);
    let run = FolderRun {
        arguments,
        settings,
        single,
        labs: selected_labs.len(),
        loaded: loaded.as_ref(),
        folder: folder.as_ref(),
        stop: &stop,
    };
    let mut saved = run.study(&selected, &mut results, &mut session.text);
    let none_studied = results.studies().next().is_none();
    if let (false, Some(Ok(study_mesh)), Some(folder)) = (none_studied, &loaded, &folder) {
        let runner = labs::LabRunner {
            study_mesh,
            settings,
            launches: arguments.launching.launches,
            path: meshes[0].path.as_deref(),
            stop: &stop,
        };
        let kept = labs::Kept {
            folder,
            resumed: selected.is_empty(),
            triangulate: arguments.triangulate,
        };
        saved = saved.and(runner.run(&selected_labs, &kept, &mut results));
    }
    let interrupted = stop.load(Ordering::Relaxed);
    print(&results, single, &mut session.text);
    let mut written = session.write(&mut results).and(saved);
    // A report on nothing would look like a result.
    let is_empty = results.findings.is_empty() && arguments.shard.is_none();
    let none_studied = none_studied && !interrupted && arguments.shard.is_none();
    let not_measured = |failed: &Failed| failed.kind == FailureKind::NotMeasured;
    if let Some(folder) = &folder {
        match is_empty && results.failures.iter().all(not_measured) {
            true => folder.remove_if_empty(),
            false => written = written.and(folder.write_report(&results, &command_line())),
        }
    }
    if let Some(paper) = &paper {
        match is_empty {
            true => paper.remove_if_empty(),
            false => {
                written = written.and(paper::write_if(
                    Some(paper),
                    &results,
                    &command_line(),
                    None,
                ))
            }
        }
    }
    if interrupted && let Some(folder) = &arguments.report {
        print_notice(&format!(
            "note: to measure the rest, run the same command with --resume: {} has what is finished",
            shown(folder)
        ));
    }
    if none_studied {
        written?;
        return Err(failure_of_all(&results.failures));
    }
    let keep_going = arguments.launching.keep_going;
    measured_code(written, &results, interrupted, keep_going)
}

/// Measures one lab of a report, as a launch.
pub(crate) fn run_lab(
    arguments: &Study,
    settings: &Settings,
    lab: Lab,
) -> Result<ExitCode, Failure> {
    let meshes = find_meshes(&arguments.meshes, &mut |_| ())?;
    let path = meshes.first().and_then(|mesh| mesh.path.as_deref());
    let session = Session::open(path, &arguments.files, settings.heap)?;
    let study_mesh = load::mesh_or_built_in(
        path,
        arguments.read,
        arguments.strict,
        arguments.triangulate,
    )?;
    let labs = labs::selected_labs(arguments.labs.as_ref(), true)?;
    let runner = labs::LabRunner {
        study_mesh: &study_mesh,
        settings: &Settings {
            effort: arguments.effort(1 + labs.len()),
            ..settings.clone()
        },
        launches: arguments.launching.launches,
        path,
        stop: &session.stop,
    };
    let measured = runner.measure(lab, &Bar::new())?;
    let measured = measured.map(|finding| with_command(finding, arguments.triangulate));
    let results = measured.map_or_else(Results::default, Results::from);
    session.finish(results, arguments.launching.keep_going)
}

/// Returns the meshes of the shard without a study.
fn unfinished<'m>(meshes: &'m [Mesh], shard: Option<Shard>, results: &Results) -> Vec<&'m Mesh> {
    meshes
        .iter()
        .enumerate()
        .filter(|(i, _)| shard.is_none_or(|shard| shard.contains(*i)))
        .map(|(_, mesh)| mesh)
        .filter(|mesh| !results.is_done(&mesh.name))
        .collect()
}

/// The shared input of all studies.
struct FolderRun<'a> {
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

impl FolderRun<'_> {
    /// Studies `meshes` one after the other and adds the studies to `results`. Stops if
    /// interrupted, and keeps the finished part of the interrupted study. A study that cannot be
    /// saved is still added; the first error of saving is returned at the end.
    fn study(
        &self,
        meshes: &[&Mesh],
        results: &mut Results,
        text: &mut TextOutput,
    ) -> Result<(), Failure> {
        let mut saved = Ok(());
        for (done, mesh) in meshes.iter().enumerate() {
            if self.stop.load(Ordering::Relaxed) {
                break;
            }
            let position = format!("{} of {}", done + 1, meshes.len() + self.labs);
            let Some(result) = self.measure_mesh(mesh, &position) else {
                break; // interrupted before the first result of this mesh
            };
            let notices = take_notices();
            results.add_notices(notices.clone());
            if !self.single {
                text.print_line(&progress_line(&position, mesh, &result));
            }
            match result {
                Ok(report) => {
                    let mut study = Results::from(finding(report, self.arguments));
                    study.notices = notices;
                    // An interrupted study is not saved, so that `--resume` measures the mesh
                    // again. Save between two studies, so that writing does not disturb the
                    // measurements.
                    if let (Some(folder), false) = (self.folder, study.is_interrupted()) {
                        saved = saved.and(folder.save_study(&mesh.name, &study));
                    }
                    study
                        .findings
                        .into_iter()
                        .for_each(|study| results.add(study));
                }
                Err(failed) => results.add_failure(failed),
            }
        }
        saved
    }

    /// Studies one mesh. Returns `None` if interrupted before the first result.
    fn measure_mesh(&self, mesh: &Mesh, position: &str) -> Option<Result<Report, Failed>> {
        let failed = |failure: &Failure| Some(Err(mesh.not_measured(failure)));
        if let Some(problem) = &mesh.problem {
            return failed(&Failure::usage(problem));
        }
        let own;
        let loaded = match self.loaded {
            Some(loaded) => loaded,
            None => {
                own = load_mesh(mesh, self.arguments);
                &own
            }
        };
        let study_mesh = match loaded {
            Ok(study_mesh) => study_mesh,
            Err(failure) => return failed(failure),
        };
        let launching = Launching {
            wanted: self.arguments.launching.launches,
            paths: mesh.path.as_deref().into_iter().collect(),
            part: Some(Part::Mesh(mesh.name.clone())),
            stop: self.stop,
            pool: sixfold_study::pool_launches,
        };
        let bar = Bar::after(&format!("{position}, {}: ", mesh.name));
        match measure(study_mesh, self.settings, &launching, &bar) {
            Ok(report) if report.interrupted && report.results.is_empty() => None,
            Ok(report) => Some(Ok(report)),
            Err(failure) if failure.is_unsupported() => Some(Err(Failed {
                mesh: mesh.name.clone(),
                reason: NONE_HOLDS.into(),
                kind: FailureKind::NoneHolds,
            })),
            Err(_) if self.stop.load(Ordering::Relaxed) => None,
            Err(failure) => failed(&failure),
        }
    }
}

fn load_mesh(mesh: &Mesh, arguments: &Study) -> Result<StudyMesh, Failure> {
    let study_mesh = load::mesh_or_built_in(
        mesh.path.as_deref(),
        arguments.read,
        arguments.strict,
        arguments.triangulate,
    )?;
    // Reports and documents have pictures of the meshes.
    let wanted = arguments.report.is_some() || arguments.files.json.is_some();
    Ok(match wanted {
        true => with_picture(study_mesh),
        false => study_mesh,
    })
}

fn progress_line(position: &str, mesh: &Mesh, result: &Result<Report, Failed>) -> String {
    let name = sanitize(&mesh.name);
    match result {
        Ok(report) => {
            let faces = counted(report.mesh.facts.faces, "face", "faces");
            let columns = report.backends.iter().filter(|column| column.holds).count();
            let columns = counted(columns, "backend", "backends");
            let rows = counted(report.results.len(), "figure", "figures");
            let end = if report.interrupted {
                ", interrupted"
            } else {
                ""
            };
            format!("{position}: {name}, {faces}, {columns}, {rows}{end}")
        }
        Err(failed) => hanging_indent(&format!("{position}: {name}: "), &sanitize(&failed.reason)),
    }
}

/// Prints the results of one mesh with its labs, or of many meshes.
fn print(results: &Results, single: bool, text: &mut TextOutput) {
    match results.studies().next().filter(|_| single) {
        Some(study) => {
            crate::study::print(study, text);
            labs::print(results, text);
        }
        None => print_all(results, text),
    }
}

fn print_all(results: &Results, text: &mut TextOutput) {
    text.print_line("");
    if !results.planned.is_empty() {
        let studied = counted(results.studies().count(), "mesh", "meshes");
        text.print_line(&format!("{studied} of {} studied", results.planned.len()));
    }
    let others = results.findings.iter().map(Finding::kind);
    let others: Vec<&str> = others.filter(|kind| *kind != "study").collect();
    if !others.is_empty() {
        text.print_list("results of other commands: ", [others.join(", ")]);
    }
    for failed in &results.failures {
        let first = format!("! {}: ", sanitize(&failed.mesh));
        text.print_line(&hanging_indent(&first, &sanitize(&failed.reason)));
    }
    let missing = results.missing().count();
    if missing > 0 {
        let missing = counted(missing, "mesh is", "meshes are");
        text.print_line(&format!("! {missing} not studied yet"));
    }
    let pool = results.pool();
    if !pool.all().is_empty() {
        text.print_line("");
        text.print_answer(&pool.sentences, &pool.warnings);
        text.print_line(&pooled_table::pooled_table(&pool, text.bold()));
        text.print_line("");
        if let Some(groups) = pooled_table::groups_table(&pool, text.bold()) {
            text.print_line(&groups);
            text.print_line("");
        }
    }
    for failed in &results.failures {
        let mesh = &failed.mesh;
        print_notice(&format!("note: {mesh}: not studied: {}", failed.reason));
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
