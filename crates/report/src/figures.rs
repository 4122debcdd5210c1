//! What is drawn of which results.

mod break_even;
mod growth;
mod heat_map;
mod memory;
mod orders;
mod ranking;
mod roofline;

use study::numbers::{counted, grouped};
use study::{Collection, Environment, Labs, MeshReport, Report};

use crate::{Figure, Page, Section};

/// One row of a figure over columns: a structure, or a program of somebody else.
pub(crate) struct Row<'a> {
    pub(crate) backend: &'a str,
    /// The ratio to the best, and its interval.
    pub(crate) ratio: f64,
    pub(crate) interval: Option<[f64; 2]>,
    /// Nanoseconds of an element, where that is known.
    pub(crate) ns: Option<f64>,
    /// The same of the first time, on fresh pages, where that is known and differs.
    pub(crate) first_ns: Option<f64>,
    /// What else there is to say: `best`, `tied`, `on 3 of 4 meshes`.
    pub(crate) note: String,
}

pub(crate) fn page(collection: &Collection, command: &str) -> Page {
    let single = match (&collection.studies[..], collection.meshes.len()) {
        ([study], 1) => Some(study),
        _ => None,
    };
    let labs = labs(&collection.labs, command);
    let title = match (single, &labs[..]) {
        (Some(study), _) => format!("Mesh data structures on {}", study.mesh.name),
        (None, [lab]) if collection.meshes.is_empty() => lab.title.clone(),
        (None, _) if collection.meshes.is_empty() => "Mesh data structures".into(),
        (None, _) => {
            let meshes = counted(collection.studies.len(), "mesh", "meshes");
            format!("Mesh data structures on {meshes}")
        }
    };
    // What was typed for all of it, if that is one command.
    let mut commands = environments(collection).map(|environment| made_by(environment, command));
    let first = commands.next().unwrap_or(command);
    let command = match commands.all(|other| other == first) {
        true => first,
        false => command,
    };
    let mut machines: Vec<String> = Vec::new();
    for environment in environments(collection) {
        let machine = machine(environment);
        if !machines.contains(&machine) {
            machines.push(machine);
        }
    }
    let section = |(place, study): (usize, &Report)| Section {
        title: study.mesh.name.clone(),
        facts: facts(&study.mesh),
        words: study.words.clone(),
        figures: of_one_of_many(study, place + 1, command),
    };
    Page {
        title,
        command: command.into(),
        machines,
        words: match single {
            Some(study) => [vec![facts(&study.mesh)], study.words.clone()].concat(),
            None => collection.words.clone(),
        },
        warnings: {
            let warnings = single.map_or_else(Vec::new, |study| study.warnings.clone());
            let cut = is_cut_short(collection).then(|| CUT_SHORT.to_owned());
            warnings.into_iter().chain(cut).collect()
        },
        figures: match single {
            Some(study) => of_one(study, command),
            None => pooled(collection, command),
        },
        meshes: match single {
            Some(_) => Vec::new(),
            None => collection.studies.iter().enumerate().map(section).collect(),
        },
        labs,
        failures: { collection.failures.iter() }
            .map(|failed| (failed.mesh.clone(), failed.reason.clone()))
            .collect(),
        missing: collection.missing.clone(),
    }
}

/// What is said of results that were told to stop before their end.
const CUT_SHORT: &str = "Interrupted: some of this rests on what was finished by then; `sixfold study --resume` takes a report up again.";

fn is_cut_short(collection: &Collection) -> bool {
    let mut studies = collection.studies.iter();
    studies.any(|study| study.interrupted) || collection.labs.interrupted()
}

/// All environments that figures come from.
fn environments(collection: &Collection) -> impl Iterator<Item = &Environment> {
    let studies = collection.studies.iter().map(|study| &study.environment);
    studies.chain(collection.labs.environments())
}

/// What was typed for these figures, or else for the page.
fn made_by<'a>(environment: &'a Environment, command: &'a str) -> &'a str {
    environment.command.as_deref().unwrap_or(command)
}

/// A section for each measurement that is no study.
fn labs(labs: &Labs, command: &str) -> Vec<Section> {
    let Labs {
        orders,
        growth,
        why,
        picks,
    } = labs;
    let mut sections = Vec::new();
    for (i, orders) in orders.iter().enumerate() {
        sections.push(Section {
            title: format!("What the order of {} costs", orders.mesh.name),
            facts: facts(&orders.mesh),
            words: orders.words.clone(),
            figures: orders::of_orders(
                orders,
                &numbered("orders", i),
                made_by(&orders.environment, command),
            ),
        });
    }
    for (i, growth) in growth.iter().enumerate() {
        let ends = growth.sizes.first().zip(growth.sizes.last());
        let sizes = ends.map_or_else(String::new, |(first, last)| {
            let [first, last] = [first.faces, last.faces].map(grouped);
            let sizes = counted(growth.sizes.len(), "size", "sizes");
            format!("{sizes} from {first} to {last} faces.")
        });
        sections.push(Section {
            title: format!("How costs grow: {}, {}", growth.shape, growth.order),
            facts: sizes,
            words: growth.words.clone(),
            figures: growth::of_growth(
                growth,
                &numbered("growth", i),
                made_by(&growth.environment, command),
            ),
        });
    }
    for (i, why) in why.iter().enumerate() {
        let environment = why.environment.as_ref();
        let command = environment.map_or(command, |environment| made_by(environment, command));
        let figure = roofline::of_why(why, &numbered("roofline", i), command);
        sections.extend(figure.map(|figure| Section {
            title: format!("What queries on {} wait for", why.mesh.name),
            facts: facts(&why.mesh),
            words: Vec::new(),
            figures: vec![figure],
        }));
    }
    for (i, answer) in picks.iter().enumerate() {
        let command = made_by(&answer.environment, command);
        let id = numbered("pick", i);
        let ranked = ranking::of_workload(answer, &id, command);
        let curves = break_even::of_workload(answer, &format!("{id}-break-even"), command);
        sections.push(Section {
            title: format!("{} on {}", answer.workload.name, answer.meshes.join(", ")),
            facts: answer.workload.summary.trim().to_owned(),
            words: [&answer.words[..], &answer.warnings].concat(),
            figures: ranked.into_iter().chain(curves).collect(),
        });
    }
    sections
}

/// `orders`, `orders-2`, …
fn numbered(name: &str, place: usize) -> String {
    match place {
        0 => name.into(),
        _ => format!("{name}-{}", place + 1),
    }
}

/// Everything there is to draw of one study.
fn of_one(study: &Report, command: &str) -> Vec<Figure> {
    let command = made_by(&study.environment, command);
    let mut figures = Vec::new();
    figures.extend(heat_map::of_study(study, "", command));
    figures.extend(memory::of_study(study, "", command));
    figures.extend(break_even::of_study(study, "", command));
    figures.extend(ranking::of_study(study, command));
    figures
}

/// What is drawn of one of many: their number is what makes a page long.
fn of_one_of_many(study: &Report, place: usize, command: &str) -> Vec<Figure> {
    // Names that differ may come to one slug; their places do not.
    let of = format!("mesh-{place}-{}-", slug(&study.mesh.name));
    let command = made_by(&study.environment, command);
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

/// `a vertex`, `an edge`.
pub(crate) fn one(per: &str) -> String {
    match per.starts_with(['a', 'e', 'i', 'o', 'u']) {
        true => format!("an {per}"),
        false => format!("a {per}"),
    }
}

/// A name as links and files can have it.
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

fn facts(mesh: &MeshReport) -> String {
    let facts = &mesh.facts;
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
    let changes = match mesh.changes.is_empty() {
        true => String::new(),
        false => format!("; {}", mesh.changes.join(", ")),
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
    parts.extend(environment.memory_phrases());
    let parts: Vec<String> = parts.iter().map(|part| part.trim().to_owned()).collect();
    parts.join("; ")
}
