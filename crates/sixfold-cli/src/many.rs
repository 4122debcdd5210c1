//! Studies of many meshes: one after the other, each kept as soon as it is finished.

mod folder;
mod merge;
mod meshes;
mod pooled_table;

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use ::study::{Asked, Collection, Report, Settings, StudyError};

use crate::arguments::Study;
use crate::failure::Failure;
use crate::load;
use crate::measured::{ended, tell_of_debug_build};
use crate::numbers::counted;
use crate::output::{Output, check_kept, is_stdout};
use crate::progress::{Bar, interrupt_flag};
use crate::text::{Text, complain, hanging, tame};

pub(crate) use merge::run as merge;
pub(crate) use meshes::Shard;

use folder::{Folder, Piece};
use meshes::{Mesh, found};

/// Studies the meshes that are asked for, but for those that are finished; what does not load is
/// listed, and the rest goes on.
pub(crate) fn run(arguments: &Study, settings: &Settings) -> Result<ExitCode, Failure> {
    let meshes = found(&arguments.meshes)?;
    for mesh in &meshes {
        check_kept("a mesh", &mesh.path, &[("--json", arguments.json.as_ref())])?;
    }
    if arguments.csv.is_some() {
        return Err(Failure::usage(
            "--csv is for one mesh: --report DIR writes the samples of all into results.csv",
        ));
    }
    let names = meshes.iter().map(|mesh| mesh.name.clone()).collect();
    let mut collection = Collection::new(names, asked(arguments, settings));
    let stop = interrupt_flag();
    let json = Output::open_if(arguments.json.as_ref())?;
    let folder = match &arguments.report {
        Some(path) => Some(Folder::open(
            path,
            arguments.resume,
            &mut collection,
            &meshes,
        )?),
        None => None,
    };
    let mine: Vec<(usize, &Mesh)> = { meshes.iter().enumerate() }
        .filter(|(i, _)| arguments.shard.is_none_or(|shard| shard.has(*i)))
        .filter(|(_, mesh)| collection.missing.contains(&mesh.name))
        .collect();
    tell_of_debug_build();
    let on_stdout = arguments.json.as_deref().is_some_and(is_stdout);
    let mut text = Text::shown(!on_stdout);
    let count = mine.len();
    for (done, (number, mesh)) in mine.into_iter().enumerate() {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let place = format!("{} of {count}", done + 1);
        let Some(result) = one(mesh, arguments, settings, &place, &stop) else {
            break; // told to stop in the midst of it
        };
        text.say(&line(&place, mesh, &result));
        let piece = Piece::new(mesh, &collection.settings, result);
        if let Some(folder) = &folder {
            // Between two studies: no writing shows in a figure.
            folder.keep(number, &piece)?;
        }
        piece.settle(&mut collection);
    }
    let interrupted = stop.load(Ordering::Relaxed);
    print(&collection, &mut text);
    let mut written = text.finish();
    if let Some(output) = json {
        written = written.and(output.finish(|writer| collection.write_json(writer)));
    }
    if let Some(folder) = &folder {
        written = written.and(folder.finish(&collection));
    }
    if collection.studies.is_empty() && !interrupted && arguments.shard.is_none() {
        written?;
        return Err(Failure::usage("none of the meshes could be studied"));
    }
    ended(written, collection.mismatches(), interrupted)
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
        triangulate: arguments.triangulate,
        strict: arguments.strict,
    }
}

/// The study of one mesh, or why there is none; `None` if told to stop before its end.
fn one(
    mesh: &Mesh,
    arguments: &Study,
    settings: &Settings,
    place: &str,
    stop: &AtomicBool,
) -> Option<Result<Report, String>> {
    let specimen = match load::for_study(&mesh.path, arguments.strict, arguments.triangulate) {
        Ok(specimen) => specimen,
        Err(failure) => return Some(Err(without_path(&failure.message, &mesh.path))),
    };
    let bar = Bar::new();
    let report = ::study::study(&specimen, settings, stop, &mut |at| {
        let stage = format!("{place}, {}: {}", mesh.name, at.stage);
        bar.show(::study::Progress {
            stage: &stage,
            ..at
        });
    });
    bar.clear();
    match report {
        Ok(report) if report.interrupted => None,
        Ok(report) => Some(Ok(report)),
        Err(StudyError::NoneHolds { .. }) => Some(Err("no backend asked for holds it".into())),
        Err(error) => Some(Err(error.to_string())),
    }
}

/// A message about a file without the file, which the list names anyhow.
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

/// What all of them come to.
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
        text.say(&format!("! {missing} still to be done"));
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
