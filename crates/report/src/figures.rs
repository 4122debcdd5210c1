//! Selects the figures for each kind of results.

mod audit;
pub(crate) mod break_even;
pub(crate) mod changes;
mod growth;
mod heat_map;
pub(crate) mod history;
mod many;
mod memory;
mod orders;
mod ranking;
mod ratio_axis;
pub(crate) mod ratios;
mod reads;
mod roofline;

use sixfold_results::numbers::{counted, grouped, times};
use sixfold_results::{Environment, Finding, MeshReport, Report, Results, Run};

use crate::data::rows;
use crate::matrix::Matrix;
use crate::papers::methods;
use crate::source;
use crate::summary::{self, Summary};
use crate::{Figure, MeshPicture, ReportPage, Section};

/// The structure of the input mesh. It need not be built.
pub(crate) const INPUT_BACKEND: &str = "indexed-face-set";

pub(crate) fn page(results: &Results, command: &str) -> ReportPage {
    let studies: Vec<&Report> = results.studies().collect();
    let single = match (&studies[..], results.planned.len()) {
        ([study], 1) => Some(*study),
        _ => None,
    };
    // Show the recorded command if all results have the same command.
    let mut commands = runs(results).map(|run| recorded_command(run, command));
    let first = commands.next().unwrap_or(command);
    let command = match commands.all(|other| other == first) {
        true => first,
        false => command,
    };
    let mut page = match single {
        Some(study) => study_page(study, results, command),
        None if results.planned.is_empty() => labs_page(labs(results, command)),
        None => many::page(&studies, results, command),
    };
    set_sources(&mut page, results);
    page.command = command.into();
    page.machines = machines(results);
    page.methods = methods::paragraphs(results);
    if results.is_interrupted() {
        page.warnings.insert(0, INTERRUPTED.to_owned());
    }
    if runs(results).any(|run| run.environment.profile == "debug") {
        page.warnings.insert(0, DEBUG.to_owned());
    }
    page.failures = results
        .failures
        .iter()
        .map(|failed| (failed.mesh.clone(), failed.reason.clone()))
        .collect();
    page.missing = results.missing().map(str::to_owned).collect();
    page
}

/// Says under each figure how it was measured.
fn set_sources(page: &mut ReportPage, results: &Results) {
    let of_kind = |kind: &str| -> Vec<&Finding> {
        let findings = results.findings.iter();
        findings.filter(|finding| finding.kind() == kind).collect()
    };
    let set = |figures: &mut Vec<Figure>, findings: &[&Finding]| {
        let line = source::line(findings);
        for figure in figures {
            figure.source.clone_from(&line);
        }
    };
    let studies = of_kind("study");
    set(&mut page.figures, &studies);
    set(&mut page.folded, &studies);
    if !studies.is_empty() {
        page.measured = source::line(&studies);
    }
    for (section, study) in page.meshes.iter_mut().zip(&studies) {
        set(&mut section.figures, &[study]);
    }
    let labs = LABS.iter().flat_map(|kind| of_kind(kind));
    for (section, lab) in page.labs.iter_mut().zip(labs) {
        set(&mut section.figures, &[lab]);
    }
}

/// Returns the page of one mesh.
fn study_page(study: &Report, results: &Results, command: &str) -> ReportPage {
    let matrix = Matrix::of_study(study);
    let mut answer = summary::fastest_of_study(study);
    answer.extend(summary::how_sure(study));
    ReportPage {
        title: format!("Mesh data structures on {}", file_name(&study.mesh.name)),
        facts: facts(&study.mesh),
        picture: mesh_picture(&study.mesh),
        answer,
        conditions: summary::conditions(study, results),
        summary: Some(Summary::of_study(study, results)),
        sentences: study.notes.clone(),
        warnings: unsteady(study, results)
            .into_iter()
            .chain(study.warnings.iter().cloned())
            .collect(),
        figures: study_figures(study, &matrix, command),
        folded: rankings(study, &matrix, command).into_iter().collect(),
        operations: matrix,
        labs: labs(results, command),
        ..ReportPage::default()
    }
}

/// Two measurements of one time that differ by more than this factor are named.
const UNSTEADY: f64 = 1.3;

/// Compares the times of the study with those of the same operations in the other measurements of the page.
/// Returns a warning if some differ much.
fn unsteady(study: &Report, results: &Results) -> Option<String> {
    let is_same = |mesh: &MeshReport| mesh.sha256 == study.mesh.sha256;
    let orders = results.orders().filter(|orders| is_same(&orders.mesh));
    let given = orders.flat_map(|orders| &orders.results);
    let given = given.filter(|row| row.case == "given").filter_map(|row| {
        Some((
            row.operation.as_str(),
            &row.backend,
            row.median_ns.and(row.ns_per_element)?,
        ))
    });
    let why = results.why().filter(|why| is_same(&why.mesh));
    let timed = why.flat_map(|why| &why.rows);
    let timed = timed.filter_map(|row| {
        let operation = row.reads.relation.name();
        Some((operation, &row.backend, row.timed.as_ref()?.ns_per_element))
    });
    let factors = given.chain(timed).filter_map(|(operation, backend, ns)| {
        let row = study.row(operation, backend)?;
        row.median_ns?;
        let factor = ns / row.ns_per_element?;
        Some((factor.max(factor.recip()), operation, backend))
    });
    let factors: Vec<(f64, &str, &String)> = factors.collect();
    let count = factors
        .iter()
        .filter(|(factor, ..)| *factor > UNSTEADY)
        .count();
    let (worst, operation, backend) = factors.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    (count > 0).then(|| {
        format!(
            "The machine was not steady: {} of {} times differ by more than {:.0} % between the study and the other measurements \
             on this page (at most {}, {operation} on {backend}), which intervals do not show. Measure again on a quiet machine.",
            grouped(count),
            grouped(factors.len()),
            100.0 * (UNSTEADY - 1.0),
            times(*worst)
        )
    })
}

/// Returns the picture of a mesh, with the colours of its faults in the label.
fn mesh_picture(mesh: &MeshReport) -> Option<MeshPicture> {
    let png = mesh.picture.clone()?;
    // Only Base64 goes into the page.
    let is_base64 = |c: u8| c.is_ascii_alphanumeric() || b"+/=".contains(&c);
    let facts = &mesh.facts;
    let faults = [
        (facts.boundary_edges > 0, "boundary edges in orange"),
        (
            facts.non_manifold_edges + facts.non_manifold_vertices > 0,
            "non-manifold edges and vertices in magenta",
        ),
        (facts.inconsistent_edges > 0, "turned faces in yellow"),
    ];
    let faults = faults.into_iter().filter(|(has, _)| *has);
    let faults: Vec<&str> = faults.map(|(_, text)| text).collect();
    let name = file_name(&mesh.name);
    let label = match faults.is_empty() {
        true => name.to_owned(),
        false => format!("{name}: {}", faults.join(", ")),
    };
    png.bytes()
        .all(is_base64)
        .then_some(MeshPicture { png, label })
}

/// Returns the page of labs without a study. If there is only one, its first sentences are the answer.
fn labs_page(mut labs: Vec<Section>) -> ReportPage {
    let [lab] = &mut labs[..] else {
        return ReportPage {
            title: "Mesh data structures".into(),
            labs,
            ..ReportPage::default()
        };
    };
    let rest = lab.sentences.split_off(lab.sentences.len().min(3));
    ReportPage {
        title: lab.title.clone(),
        facts: lab.facts.clone(),
        answer: std::mem::replace(&mut lab.sentences, rest),
        labs,
        ..ReportPage::default()
    }
}

/// Returns the name of a file without its folders.
pub(crate) fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\'])
        .find(|part| !part.is_empty())
        .unwrap_or(path)
}

const DEBUG: &str =
    "Measured by a debug build, whose times are not meaningful: build Sixfold with --release.";

const INTERRUPTED: &str = "Interrupted: some results are incomplete. To complete the report, use \
                           `sixfold study --resume`.";

fn runs(results: &Results) -> impl Iterator<Item = &Run> {
    results.findings.iter().map(Finding::run)
}

/// Returns the recorded command of a run, or `command` if none was recorded.
fn recorded_command<'a>(run: &'a Run, command: &'a str) -> &'a str {
    run.command.as_deref().unwrap_or(command)
}

/// The kinds of labs, in the order of their sections.
const LABS: [&str; 6] = ["orders", "growth", "why", "memory", "neighbours", "pick"];

fn labs(results: &Results, command: &str) -> Vec<Section> {
    let mut sections = Vec::new();
    for (i, orders) in results.orders().enumerate() {
        sections.push(Section {
            title: format!(
                "Effect of the order in memory: {}",
                file_name(&orders.mesh.name)
            ),
            facts: facts(&orders.mesh),
            sentences: [&orders.sentences[..], &orders.warnings].concat(),
            figures: orders::from_orders(
                orders,
                &numbered_id("orders", i),
                recorded_command(&orders.run, command),
            )
            .into_iter()
            .collect(),
            ..Section::default()
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
            )
            .into_iter()
            .collect(),
            ..Section::default()
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
            title: format!("{title} on {}", file_name(&why.mesh.name)),
            facts: facts(&why.mesh),
            sentences: [&why.sentences[..], &why.warnings].concat(),
            tables: match figure {
                Some(_) => Vec::new(),
                None => vec![reads::table(why)],
            },
            figures: figure.into_iter().collect(),
            ..Section::default()
        });
    }
    for audit in results.memory() {
        sections.push(Section {
            title: format!("Memory: {}", file_name(&audit.mesh.name)),
            facts: facts(&audit.mesh),
            // The sentences name the faults. Older documents have no sentences.
            sentences: match audit.sentences.is_empty() {
                true => audit.faults(),
                false => audit.sentences.clone(),
            },
            tables: audit::tables(audit),
            ..Section::default()
        });
    }
    for (i, neighbours) in results.neighbours().enumerate() {
        let command = recorded_command(&neighbours.run, command);
        let id = numbered_id("neighbours", i);
        sections.push(Section {
            title: format!("Neighbours in space: {}", file_name(&neighbours.mesh.name)),
            facts: facts(&neighbours.mesh),
            sentences: [&neighbours.sentences[..], &neighbours.warnings].concat(),
            figures: ranking::from_neighbours(neighbours, &id, command)
                .into_iter()
                .collect(),
            ..Section::default()
        });
    }
    for (i, pick) in results.picks().enumerate() {
        let command = recorded_command(&pick.run, command);
        let id = numbered_id("pick", i);
        let ranked = ranking::from_workload(pick, &id, command);
        let curves = break_even::from_workload(pick, &format!("{id}-break-even"), command);
        let names: Vec<&str> = pick
            .meshes
            .iter()
            .map(|mesh| file_name(&mesh.name))
            .collect();
        sections.push(Section {
            title: format!("{} on {}", pick.workload.name, names.join(", ")),
            facts: pick.workload.summary.trim().to_owned(),
            sentences: [&pick.sentences[..], &pick.warnings].concat(),
            code: pick.usage.clone(),
            figures: ranked.into_iter().chain(curves).collect(),
            ..Section::default()
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

fn study_figures(study: &Report, matrix: &Matrix, command: &str) -> Vec<Figure> {
    let command = recorded_command(&study.run, command);
    let figures = [
        heat_map_of(study, matrix, "", command),
        memory::from_study(study, "", command),
        break_even::from_study(study, "", command),
    ];
    figures.into_iter().flatten().collect()
}

fn rankings(study: &Report, matrix: &Matrix, command: &str) -> Option<Figure> {
    let command = recorded_command(&study.run, command);
    let figure = ranking::from_matrix(matrix, "", command)?;
    Some(figure.with_csv(rows::study(study)))
}

fn heat_map_of(study: &Report, matrix: &Matrix, id_prefix: &str, command: &str) -> Option<Figure> {
    let title = format!(
        "Every operation on every structure: {}",
        file_name(&study.mesh.name)
    );
    let figure = heat_map::figure(title, matrix, id_prefix, command)?;
    Some(figure.with_csv(rows::study(study)))
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
    let faults = [
        (
            facts.non_manifold_edges,
            "non-manifold edge",
            "non-manifold edges",
        ),
        (
            facts.non_manifold_vertices,
            "non-manifold vertex",
            "non-manifold vertices",
        ),
    ];
    let faults = faults.into_iter().filter(|(count, ..)| *count > 0);
    let faults: String = faults
        .map(|(count, one, many)| format!(", {}", counted(count, one, many)))
        .collect();
    let changes = match mesh.changes.is_empty() {
        true => String::new(),
        false => format!("; {}", mesh.changes.join(", ")),
    };
    format!(
        "{vertices}, {} edges, {faces}; {closed}{genus}{faults}{changes}.",
        grouped(facts.edges)
    )
}

/// Describes the machines of the findings. If there are several, each one is preceded by the names
/// of its findings, such as `study of ball.obj, orders`.
pub(crate) fn machines(results: &Results) -> Vec<String> {
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

/// Describes the machine and the program of a measurement in one line.
pub fn machine(environment: &Environment) -> String {
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
    parts.push(clock.words().into());
    parts.extend(environment.memory_phrases());
    let parts: Vec<String> = parts.iter().map(|part| part.trim().to_owned()).collect();
    parts.join("; ")
}
