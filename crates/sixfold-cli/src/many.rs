//! Studies of many meshes, one after the other; each is saved as soon as it is finished.

mod drawn;
mod folder;
mod labs;
mod merge;
mod meshes;
mod pooled_table;

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use sixfold_study::{Asked, Collection, Report, Settings, Specimen, StudyError};

use crate::arguments::Study;
use crate::failure::Failure;
use crate::load;
use crate::measured::{studies_ended, tell_of_debug_build, typed};
use crate::output::{Output, check_places, is_stdout};
use crate::progress::{Bar, interrupt_flag};
use crate::text::{Text, complain, hanging, tame};
use sixfold_study::numbers::counted;

pub(crate) use drawn::run as draw;
pub(crate) use labs::Chosen;
pub(crate) use merge::run as merge;
pub(crate) use meshes::Shard;

use folder::{Folder, Piece};
use meshes::{Mesh, found};

/// The reason if a mesh loads but cannot be studied.
const NONE_HOLDS: &str = "none of the selected backends can hold it";

/// Studies the selected meshes, except those that are finished already. Lists meshes that do not
/// load, and continues with the rest.
pub(crate) fn run(arguments: &Study, settings: &Settings) -> Result<ExitCode, Failure> {
    let meshes = found(&arguments.meshes)?;
    let outputs = [
        ("--json", arguments.json.as_ref()),
        ("--csv", arguments.csv.as_ref()),
    ];
    for path in meshes.iter().filter_map(|mesh| mesh.path.as_deref()) {
        check_places(Some(path), &outputs)?;
    }
    let single = meshes.len() == 1;
    if arguments.csv.is_some() && !single {
        return Err(Failure::usage(
            "--csv is for one mesh: --report DIR writes the samples of all meshes to results.csv",
        ));
    }
    let wanted = labs::wanted(arguments.labs.as_ref(), single)?;
    let names = meshes.iter().map(|mesh| mesh.name.clone()).collect();
    let mut collection = Collection::new(names, asked(arguments, settings));
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
    let mine: Vec<&Mesh> = { meshes.iter().enumerate() }
        .filter(|(i, _)| arguments.shard.is_none_or(|shard| shard.has(*i)))
        .map(|(_, mesh)| mesh)
        .filter(|mesh| collection.missing.contains(&mesh.name))
        .collect();
    tell_of_debug_build();
    let data = [&arguments.json, &arguments.csv];
    let on_stdout = data.into_iter().flatten().any(|path| is_stdout(path));
    let mut text = Text::shown(!on_stdout);
    let (count, resumed) = (mine.len(), mine.is_empty());
    for (done, mesh) in mine.into_iter().enumerate() {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let place = format!("{} of {count}", done + 1);
        let Some(result) = one(mesh, arguments, settings, &place, &stop) else {
            break; // interrupted during this mesh
        };
        if !single {
            text.say(&line(&place, mesh, &result));
        }
        let piece = Piece::new(mesh, &collection.settings, result);
        if let Some(folder) = &folder {
            // Between two studies, so that writing does not disturb the measurements.
            folder.keep(&piece)?;
        }
        piece.settle(&mut collection);
    }
    if let ([_], [mesh], Some(folder)) = (&collection.studies[..], &meshes[..], &folder) {
        let specimen = specimen(mesh, arguments)?;
        let measuring = labs::Measuring {
            specimen: &specimen,
            settings,
            folder,
            resumed,
            stop: &stop,
        };
        collection.labs = measuring.labs(&wanted)?;
    }
    let interrupted = stop.load(Ordering::Relaxed);
    let mut written;
    match (&collection.studies[..], single) {
        ([study], true) => {
            crate::study::print(study, &mut text);
            labs::print(&collection.labs, &mut text);
            written = text
                .finish()
                .and(crate::study::write_files(study, json, csv));
        }
        _ => {
            print(&collection, &mut text);
            written = text.finish();
            if let Some(output) = json {
                written = written.and(output.finish(|writer| collection.write_json(writer)));
            }
        }
    }
    if let Some(folder) = &folder {
        written = written.and(folder.finish(&collection, &typed()));
    }
    if collection.studies.is_empty() && !interrupted && arguments.shard.is_none() {
        written?;
        let mut reasons = collection.failures.iter().map(|failed| &failed.reason);
        return Err(match reasons.all(|reason| reason == NONE_HOLDS) {
            true => Failure::unsupported(format!("all meshes failed: {NONE_HOLDS}")),
            false => Failure::usage("none of the meshes could be studied"),
        });
    }
    let mismatches = collection.labs.mismatches();
    studies_ended(written, &collection.studies, mismatches, interrupted)
}

fn asked(arguments: &Study, settings: &Settings) -> Asked {
    let columns = settings
        .externals
        .iter()
        .map(|external| external.name.clone());
    Asked {
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

/// Returns the study of one mesh or the reason why it failed; `None` if interrupted.
fn one(
    mesh: &Mesh,
    arguments: &Study,
    settings: &Settings,
    place: &str,
    stop: &AtomicBool,
) -> Option<Result<Report, String>> {
    let specimen = match (specimen(mesh, arguments), &mesh.path) {
        (Ok(specimen), _) => specimen,
        (Err(failure), None) => return Some(Err(failure.message)),
        (Err(failure), Some(path)) => return Some(Err(without_path(&failure.message, path))),
    };
    let bar = Bar::new();
    let report = sixfold_study::study(&specimen, settings, stop, &mut |at| {
        let stage = format!("{place}, {}: {}", mesh.name, at.stage);
        bar.show(sixfold_study::Progress {
            stage: &stage,
            ..at
        });
    });
    bar.clear();
    match report {
        Ok(report) if report.interrupted => None,
        Ok(mut report) => {
            report.environment.command = Some(typed());
            Some(Ok(report))
        }
        Err(StudyError::NoneHolds { .. }) => Some(Err(NONE_HOLDS.into())),
        Err(error) => Some(Err(error.to_string())),
    }
}

/// Loads the mesh.
fn specimen(mesh: &Mesh, arguments: &Study) -> Result<Specimen, Failure> {
    match &mesh.path {
        None => Ok(load::built_in()),
        Some(path) => load::for_study(path, arguments.strict, arguments.triangulate),
    }
}

/// Removes the file name from a message, because the list shows it already.
fn without_path(message: &str, path: &Path) -> String {
    let Some(rest) = message.strip_prefix(&path.display().to_string()) else {
        return message.to_owned();
    };
    match rest.strip_prefix(": ") {
        Some(rest) => rest.to_owned(),
        None => format!("line {}", rest.trim_start_matches(':')),
    }
}

fn line(place: &str, mesh: &Mesh, result: &Result<Report, String>) -> String {
    let name = tame(&mesh.name);
    match result {
        Ok(report) => {
            let faces = counted(report.mesh.facts.faces, "face", "faces");
            let held = report.backends.iter().filter(|column| column.holds).count();
            let columns = counted(held, "column", "columns");
            let rows = counted(report.results.len(), "figure", "figures");
            format!("{place}: {name}, {faces}, {columns}, {rows}")
        }
        Err(reason) => hanging(&format!("{place}: {name}: "), &tame(reason)),
    }
}

/// Prints the results of all meshes together.
fn print(collection: &Collection, text: &mut Text) {
    let studied = counted(collection.studies.len(), "mesh", "meshes");
    text.say("");
    text.say(&format!("{studied} of {} studied", collection.meshes.len()));
    for failed in &collection.failures {
        let first = format!("! {}: ", tame(&failed.mesh));
        text.say(&hanging(&first, &tame(&failed.reason)));
    }
    if !collection.missing.is_empty() {
        let missing = counted(collection.missing.len(), "mesh is", "meshes are");
        text.say(&format!("! {missing} not studied yet"));
    }
    if !collection.pooled.is_empty() {
        text.say("");
        text.say(&pooled_table::pooled_table(collection, text.bold()));
        text.say("");
        for words in &collection.words {
            text.say(&hanging("- ", words));
        }
    }
    for failed in &collection.failures {
        let mesh = &failed.mesh;
        complain(&format!("note: {mesh}: not studied, {}", failed.reason));
    }
}
