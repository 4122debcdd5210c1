//! What is drawn of which results.

mod break_even;
mod heat_map;
mod memory;
mod ranking;

use study::numbers::{counted, grouped};
use study::{Collection, Environment, Report};

use crate::{Figure, Page, Section};

/// One row of a figure over columns: a structure, or a program of somebody else.
pub(crate) struct Row<'a> {
    pub(crate) backend: &'a str,
    /// The ratio to the best, and its interval.
    pub(crate) ratio: f64,
    pub(crate) interval: Option<[f64; 2]>,
    /// Nanoseconds of an element, where that is known.
    pub(crate) ns: Option<f64>,
    /// What else there is to say: `best`, `tied`, `on 3 of 4 meshes`.
    pub(crate) note: String,
}

pub(crate) fn page(collection: &Collection, command: &str) -> Page {
    let single = match (&collection.studies[..], collection.meshes.len()) {
        ([study], 1) => Some(study),
        _ => None,
    };
    let title = match single {
        Some(study) => format!("Mesh data structures on {}", study.mesh.name),
        None => {
            let meshes = counted(collection.studies.len(), "mesh", "meshes");
            format!("Mesh data structures on {meshes}")
        }
    };
    let mut machines: Vec<String> = Vec::new();
    for study in &collection.studies {
        let machine = machine(&study.environment);
        if !machines.contains(&machine) {
            machines.push(machine);
        }
    }
    let section = |study: &Report| Section {
        mesh: study.mesh.name.clone(),
        facts: facts(study),
        words: study.words.clone(),
        figures: of_one_of_many(study, command),
    };
    Page {
        title,
        command: command.into(),
        machines,
        words: match single {
            Some(study) => [vec![facts(study)], study.words.clone()].concat(),
            None => collection.words.clone(),
        },
        warnings: single.map_or_else(Vec::new, |study| study.warnings.clone()),
        figures: match single {
            Some(study) => of_one(study, command),
            None => pooled(collection, command),
        },
        meshes: match single {
            Some(_) => Vec::new(),
            None => collection.studies.iter().map(section).collect(),
        },
        failures: { collection.failures.iter() }
            .map(|failed| (failed.mesh.clone(), failed.reason.clone()))
            .collect(),
        missing: collection.missing.clone(),
    }
}

/// Everything there is to draw of one study.
fn of_one(study: &Report, command: &str) -> Vec<Figure> {
    let mut figures = Vec::new();
    figures.extend(heat_map::of_study(study, "", command));
    figures.extend(memory::of_study(study, "", command));
    figures.extend(break_even::of_study(study, "", command));
    figures.extend(ranking::of_study(study, command));
    figures
}

/// What is drawn of one of many: their number is what makes a page long.
fn of_one_of_many(study: &Report, command: &str) -> Vec<Figure> {
    let of = format!("{}-", slug(&study.mesh.name));
    let mut figures = Vec::new();
    figures.extend(heat_map::of_study(study, &of, command));
    figures.extend(memory::of_study(study, &of, command));
    figures
}

fn pooled(collection: &Collection, command: &str) -> Vec<Figure> {
    let mut figures = Vec::new();
    figures.extend(heat_map::pooled(collection, command));
    figures.extend(ranking::pooled(collection, command));
    figures
}

/// A name that links and files can have, and no other mesh.
fn slug(mesh: &str) -> String {
    let fine = |c: char| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_lowercase()
        } else {
            '-'
        }
    };
    mesh.chars().map(fine).collect()
}

fn facts(study: &Report) -> String {
    let facts = &study.mesh.facts;
    let vertices = counted(facts.vertices, "vertex", "vertices");
    let faces = counted(facts.faces, "face", "faces");
    let closed = if facts.closed {
        "closed"
    } else {
        "with a boundary"
    };
    let genus = match facts.genus {
        Some(genus) if facts.closed => format!(", genus {genus}"),
        _ => String::new(),
    };
    let changes = match study.mesh.changes.is_empty() {
        true => String::new(),
        false => format!("; {}", study.mesh.changes.join(", ")),
    };
    format!(
        "{vertices}, {} edges, {faces}; {closed}{genus}{changes}.",
        grouped(facts.edges)
    )
}

/// Where it was measured, in a line.
fn machine(environment: &Environment) -> String {
    let Environment {
        cpu_model,
        cores,
        os,
        kernel,
        rustc,
        profile,
        rustflags,
        sixfold,
        commit,
        clock,
        ..
    } = environment;
    let mut parts = Vec::new();
    parts.extend(cpu_model.clone());
    parts.extend(cores.map(|cores| counted(cores, "core", "cores")));
    parts.push(match kernel {
        Some(kernel) => format!("{os} {kernel}"),
        None => os.clone(),
    });
    parts.push(format!(
        "{}, {profile} {rustflags}",
        rustc.split(" (").next().unwrap_or_default()
    ));
    parts.push(match commit {
        Some(commit) => format!("Sixfold {sixfold} ({commit})"),
        None => format!("Sixfold {sixfold}"),
    });
    parts.push(match clock.as_str() {
        "thread-cpu" => "processor time of the thread".into(),
        _ => "wall time".into(),
    });
    let parts: Vec<String> = parts.iter().map(|part| part.trim().to_owned()).collect();
    parts.join("; ")
}
