//! Selects the figures for each kind of results.

mod audit;
mod break_even;
mod groups;
mod growth;
mod heat_map;
mod memory;
mod orders;
mod ranking;
mod reads;
mod roofline;

use sixfold_study::numbers::{counted, grouped};
use sixfold_study::{Environment, Finding, MeshReport, Pool, Report, Results, Run};

use crate::{Figure, ReportPage, Section};

/// One row of a ranking.
pub(crate) struct Row<'a> {
    pub(crate) backend: &'a str,
    /// Ratio to the fastest backend, with its interval.
    pub(crate) ratio: f64,
    pub(crate) interval: Option<[f64; 2]>,
    /// Whether `ratio` and `ns` are lower bounds, because a run would exceed the budget.
    pub(crate) bound: bool,
    /// Time per element in nanoseconds, if known.
    pub(crate) ns: Option<f64>,
    /// Time per element of the first run, on fresh pages, if it differs from `ns`.
    pub(crate) first_ns: Option<f64>,
    /// A remark, such as `best` or `tied for best`.
    pub(crate) note: String,
}

pub(crate) fn page(results: &Results, command: &str) -> ReportPage {
    let studies: Vec<&Report> = results.studies().collect();
    let single = match (&studies[..], results.planned.len()) {
        ([study], 1) => Some(*study),
        _ => None,
    };
    let labs = labs(results, command);
    let pool = results.pool();
    let title = match (single, &labs[..]) {
        (Some(study), _) => format!("Mesh data structures on {}", study.mesh.name),
        (None, [lab]) if results.planned.is_empty() => lab.title.clone(),
        (None, _) if results.planned.is_empty() => "Mesh data structures".into(),
        (None, _) => {
            let meshes = counted(studies.len(), "mesh", "meshes");
            format!("Mesh data structures on {meshes}")
        }
    };
    // Show the recorded command if all results have the same command.
    let mut commands = runs(results).map(|run| recorded_command(run, command));
    let first = commands.next().unwrap_or(command);
    let command = match commands.all(|other| other == first) {
        true => first,
        false => command,
    };
    let section = |(place, study): (usize, &&Report)| Section {
        title: study.mesh.name.clone(),
        facts: facts(&study.mesh),
        sentences: study.sentences.clone(),
        figures: section_figures(study, place + 1, command),
        tables: Vec::new(),
    };
    ReportPage {
        title,
        command: command.into(),
        machines: machines(results),
        sentences: match single {
            Some(study) => [vec![facts(&study.mesh)], study.sentences.clone()].concat(),
            None => pool.sentences.clone(),
        },
        warnings: {
            let warnings = single.map_or(&pool.warnings, |study| &study.warnings);
            let warnings = warnings.clone();
            let interrupted = results.is_interrupted().then(|| INTERRUPTED.to_owned());
            warnings.into_iter().chain(interrupted).collect()
        },
        figures: match single {
            Some(study) => study_figures(study, command),
            None => pooled_figures(&pool, &studies, command),
        },
        tables: match single {
            Some(_) => Vec::new(),
            None => groups::tables(&pool),
        },
        meshes: match single {
            Some(_) => Vec::new(),
            None => studies.iter().enumerate().map(section).collect(),
        },
        labs,
        failures: results
            .failures
            .iter()
            .map(|failed| (failed.mesh.clone(), failed.reason.clone()))
            .collect(),
        missing: results.missing().map(str::to_owned).collect(),
    }
}

const INTERRUPTED: &str = "Interrupted: some results are incomplete. To complete the report, use \
                           `sixfold study --resume`.";

fn runs(results: &Results) -> impl Iterator<Item = &Run> {
    results.findings.iter().map(Finding::run)
}

/// Returns the recorded command of a run, or `command` if none was recorded.
fn recorded_command<'a>(run: &'a Run, command: &'a str) -> &'a str {
    run.command.as_deref().unwrap_or(command)
}

fn labs(results: &Results, command: &str) -> Vec<Section> {
    let mut sections = Vec::new();
    for (i, orders) in results.orders().enumerate() {
        sections.push(Section {
            title: format!("Effect of the order in memory: {}", orders.mesh.name),
            facts: facts(&orders.mesh),
            sentences: [&orders.sentences[..], &orders.warnings].concat(),
            figures: orders::from_orders(
                orders,
                &numbered_id("orders", i),
                recorded_command(&orders.run, command),
            ),
            tables: Vec::new(),
        });
    }
    for (i, growth) in results.growth().enumerate() {
        let ends = growth.sizes.first().zip(growth.sizes.last());
        let sizes = ends.map_or_else(String::new, |(first, last)| {
            let [first, last] = [first.faces, last.faces].map(grouped);
            let sizes = counted(growth.sizes.len(), "size", "sizes");
            format!("{sizes} from {first} to {last} faces.")
        });
        sections.push(Section {
            title: format!("How costs grow: {}, order {}", growth.shape, growth.order),
            facts: sizes,
            sentences: [&growth.sentences[..], &growth.warnings].concat(),
            figures: growth::from_growth(
                growth,
                &numbered_id("growth", i),
                recorded_command(&growth.run, command),
            ),
            tables: Vec::new(),
        });
    }
    for (i, why) in results.why().enumerate() {
        let command = recorded_command(&why.run, command);
        let figure = roofline::from_why(why, &numbered_id("roofline", i), command);
        let title = match figure {
            Some(_) => "Limiting factors of the queries",
            None => "Reads of the queries",
        };
        sections.push(Section {
            title: format!("{title} on {}", why.mesh.name),
            facts: facts(&why.mesh),
            sentences: [&why.sentences[..], &why.warnings].concat(),
            tables: match figure {
                Some(_) => Vec::new(),
                None => vec![reads::table(why)],
            },
            figures: figure.into_iter().collect(),
        });
    }
    for audit in results.memory() {
        sections.push(Section {
            title: format!("Memory: {}", audit.mesh.name),
            facts: facts(&audit.mesh),
            // The sentences name the faults. Older documents have no sentences.
            sentences: match audit.sentences.is_empty() {
                true => audit.faults(),
                false => audit.sentences.clone(),
            },
            figures: Vec::new(),
            tables: audit::tables(audit),
        });
    }
    for (i, neighbours) in results.neighbours().enumerate() {
        let command = recorded_command(&neighbours.run, command);
        let id = numbered_id("neighbours", i);
        sections.push(Section {
            title: format!("Neighbours in space: {}", neighbours.mesh.name),
            facts: facts(&neighbours.mesh),
            sentences: [&neighbours.sentences[..], &neighbours.warnings].concat(),
            figures: ranking::from_neighbours(neighbours, &id, command).collect(),
            tables: Vec::new(),
        });
    }
    for (i, pick) in results.picks().enumerate() {
        let command = recorded_command(&pick.run, command);
        let id = numbered_id("pick", i);
        let ranked = ranking::from_workload(pick, &id, command);
        let curves = break_even::from_workload(pick, &format!("{id}-break-even"), command);
        let names: Vec<&str> = pick.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
        sections.push(Section {
            title: format!("{} on {}", pick.workload.name, names.join(", ")),
            facts: pick.workload.summary.trim().to_owned(),
            sentences: [&pick.sentences[..], &pick.warnings].concat(),
            figures: ranked.into_iter().chain(curves).collect(),
            tables: Vec::new(),
        });
    }
    sections
}

/// Marks a formatted figure as a lower bound if `bound` is set.
pub(crate) fn marked(figure: String, bound: bool) -> String {
    match bound {
        true => format!("≥ {figure}"),
        false => figure,
    }
}

/// Returns `orders` for place 0, `orders-2` for place 1, and so on.
fn numbered_id(name: &str, place: usize) -> String {
    match place {
        0 => name.into(),
        _ => format!("{name}-{}", place + 1),
    }
}

fn study_figures(study: &Report, command: &str) -> Vec<Figure> {
    let command = recorded_command(&study.run, command);
    let mut figures = Vec::new();
    figures.extend(heat_map::from_study(study, "", command));
    figures.extend(memory::from_study(study, "", command));
    figures.extend(break_even::from_study(study, "", command));
    figures.extend(ranking::from_study(study, command));
    figures
}

/// Draws the figures of one of several studies. There are fewer figures than for a single study.
fn section_figures(study: &Report, place: usize, command: &str) -> Vec<Figure> {
    // Different names can have the same slug, so the place is added.
    let id_prefix = format!("mesh-{place}-{}-", slug(&study.mesh.name));
    let command = recorded_command(&study.run, command);
    let mut figures = Vec::new();
    figures.extend(heat_map::from_study(study, &id_prefix, command));
    figures.extend(memory::from_study(study, &id_prefix, command));
    figures
}

fn pooled_figures(pool: &Pool, studies: &[&Report], command: &str) -> Vec<Figure> {
    let runs: Vec<&Run> = studies.iter().map(|study| &study.run).collect();
    let mut figures = Vec::new();
    figures.extend(heat_map::pooled(pool, &runs, command));
    figures.extend(ranking::pooled(pool, &runs, command));
    figures
}

pub(crate) fn per_unit(unit: &str) -> String {
    format!("per {unit}")
}

/// Converts a name for use in links and file names.
fn slug(mesh: &str) -> String {
    let safe = |c: char| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_lowercase()
        } else {
            '-'
        }
    };
    mesh.chars().map(safe).collect()
}

pub(crate) fn facts(mesh: &MeshReport) -> String {
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

/// Describes the machines of the findings. If there are several, each one is preceded by the names
/// of its findings, such as `study of ball.obj, orders`.
fn machines(results: &Results) -> Vec<String> {
    let mut machines: Vec<(String, Vec<String>)> = Vec::new();
    for finding in &results.findings {
        let machine = machine(&finding.run().environment);
        // All meshes of a growth have the same name.
        let meshes = finding.meshes().iter().map(|mesh| mesh.name.as_str());
        let mut meshes: Vec<&str> = meshes.collect();
        meshes.dedup();
        let name = match meshes.is_empty() {
            true => finding.kind().to_owned(),
            false => format!("{} of {}", finding.kind(), meshes.join(", ")),
        };
        match machines.iter_mut().find(|(known, _)| *known == machine) {
            Some((_, names)) if names.contains(&name) => {}
            Some((_, names)) => names.push(name),
            None => machines.push((machine, vec![name])),
        }
    }
    let single = machines.len() == 1;
    let described = machines.into_iter().map(|(machine, names)| match single {
        true => machine,
        false => format!("{}: {machine}", names.join("; ")),
    });
    described.collect()
}

pub(crate) fn machine(environment: &Environment) -> String {
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
