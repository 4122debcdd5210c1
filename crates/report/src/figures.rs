//! Selection of the figures for each kind of results.

mod break_even;
mod growth;
mod heat_map;
mod memory;
mod orders;
mod ranking;
mod roofline;

use sixfold_study::numbers::{counted, grouped};
use sixfold_study::{Collection, Environment, Labs, MeshReport, Report};

use crate::{Figure, Page, Section};

/// One row of a ranking: a structure or an external program.
pub(crate) struct Row<'a> {
    pub(crate) backend: &'a str,
    /// Ratio to the best, with its interval.
    pub(crate) ratio: f64,
    pub(crate) interval: Option<[f64; 2]>,
    /// Time per element in nanoseconds, if known.
    pub(crate) ns: Option<f64>,
    /// Time per element of the first run, on fresh pages, if known and different.
    pub(crate) first_ns: Option<f64>,
    /// A remark, such as `best` or `tied for best`.
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
    // The recorded command if all results share one.
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

/// Warning about interrupted results.
const CUT_SHORT: &str = "Interrupted: some results rest only on the finished part; `sixfold study --resume` continues the report.";

fn is_cut_short(collection: &Collection) -> bool {
    let mut studies = collection.studies.iter();
    studies.any(|study| study.interrupted) || collection.labs.interrupted()
}

/// Iterates over the environments of all results.
fn environments(collection: &Collection) -> impl Iterator<Item = &Environment> {
    let studies = collection.studies.iter().map(|study| &study.environment);
    studies.chain(collection.labs.environments())
}

/// Returns the recorded command of these results, or else that of the page.
fn made_by<'a>(environment: &'a Environment, command: &'a str) -> &'a str {
    environment.command.as_deref().unwrap_or(command)
}

/// Returns a section for each result of a lab.
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
            title: format!("What limits queries on {}", why.mesh.name),
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

/// Returns `orders`, `orders-2`, and so on for places 0, 1, …
fn numbered(name: &str, place: usize) -> String {
    match place {
        0 => name.into(),
        _ => format!("{name}-{}", place + 1),
    }
}

/// Draws all figures of a single study.
fn of_one(study: &Report, command: &str) -> Vec<Figure> {
    let command = made_by(&study.environment, command);
    let mut figures = Vec::new();
    figures.extend(heat_map::of_study(study, "", command));
    figures.extend(memory::of_study(study, "", command));
    figures.extend(break_even::of_study(study, "", command));
    figures.extend(ranking::of_study(study, command));
    figures
}

/// Draws the figures of one of many studies: fewer, to keep the page short.
fn of_one_of_many(study: &Report, place: usize, command: &str) -> Vec<Figure> {
    // Different names can have the same slug, so add the place.
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

/// Returns `per vertex`, `per edge`, and so on.
pub(crate) fn one(per: &str) -> String {
    format!("per {per}")
}

/// Converts a name for use in links and file names.
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

/// Describes machine, program and memory settings in one line.
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
