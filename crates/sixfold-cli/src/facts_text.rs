//! Text about the facts of a mesh and about the backends that can hold the mesh.

use sixfold::repair::Measures;
use sixfold::{Distribution, Facts, structure_infos};
use sixfold_results::{BackendReport, MeshReport};
use sixfold_study::{Settings, StudyMesh};

use crate::text::{TextOutput, coordinate, figure, hanging_indent, sanitize};
use sixfold_results::numbers::{counted, grouped};

/// Width of the labels.
const LABEL: usize = 13;

/// Prints what is known before a measurement: the facts of a mesh, and the backends that can hold
/// it. Prints nothing if none of the named backends can hold the mesh, because an error follows.
/// No names means all backends.
pub(crate) fn print_before_measuring(
    study_mesh: &StudyMesh,
    settings: &Settings,
    text: &mut TextOutput,
) {
    let (Ok(chosen), Ok(())) = (settings.chosen_backends(), settings.check_externals()) else {
        return; // the measurement returns this error
    };
    let polygons = &study_mesh.polygons;
    if !chosen
        .iter()
        .any(|backend| backend.info.check(polygons).is_ok())
    {
        return;
    }
    // Checking takes seconds for large meshes.
    text.print_line(&facts_text(&study_mesh.report()));
    text.print_line("");
    let inspection = sixfold_study::inspect(study_mesh, &chosen);
    text.print_line(&verdicts_text(&inspection.mesh, &inspection.backends));
    let mut refusing = inspection.backends.iter().filter(|b| !b.holds);
    if let Some(BackendReport { name, .. }) =
        refusing.find(|b| structure_infos().iter().any(|info| info.name == b.name))
    {
        let note = format!("`sixfold repair --for {name}` makes a mesh that {name} can hold");
        text.print_line(&hanging_indent("repair       ", &note));
    }
}

/// Returns the facts of a mesh, and the numbers of its faults.
pub(crate) fn facts_text(mesh: &MeshReport) -> String {
    let mut text = topology_text(mesh);
    let defects = mesh_defects(&mesh.facts);
    if !defects.is_empty() {
        text += "\n";
        text += &hanging_indent("also         ", &defects.join(", "));
    }
    text
}

/// Returns the facts of a mesh. The faults that [`facts_text`] adds are left out.
pub(crate) fn topology_text(mesh: &MeshReport) -> String {
    let facts = &mesh.facts;
    let mut lines = vec![hanging_indent("mesh         ", &sanitize(&mesh.name))];
    if !mesh.changes.is_empty() {
        lines.push(hanging_indent("changed      ", &mesh.changes.join(", ")));
    }
    lines.push(hanging_indent("elements     ", &elements(facts)));
    if facts.faces > facts.degenerate_faces || facts.edges > 0 {
        lines.push(hanging_indent("surface      ", &surface(facts)));
        lines.push(hanging_indent("orientation  ", &orientation(facts)));
        lines.push(hanging_indent("manifold     ", &manifold(facts)));
        lines.push(hanging_indent("degrees      ", &degrees(facts)));
    }
    lines.join("\n")
}

/// Returns the size of a mesh, in units of its coordinates; `None` without faces.
pub(crate) fn measures_text(measures: &Measures) -> Option<String> {
    let [low, high] = measures.bounds?;
    let lengths = measures.edge_lengths?;
    let longest = measures.size().into_iter().fold(0.0, f64::max);
    let coordinates = |point: [f64; 3]| point.map(|x| coordinate(x, longest)).join(" ");
    let size = format!(
        "{}, from {} to {}",
        measures.size().map(figure).join(" × "),
        coordinates(low),
        coordinates(high)
    );
    let [least, mean, largest] = [lengths.least, lengths.mean, lengths.largest].map(figure);
    let lengths = format!("from {least} to {largest}, mean {mean}");
    let area = match measures.volume {
        Some(volume) => format!("{}, volume {}", figure(measures.area), figure(volume)),
        None => figure(measures.area),
    };
    let lines = [("size", size), ("edge length", lengths), ("area", area)];
    let lines = lines.map(|(label, text)| hanging_indent(&format!("{label:LABEL$}"), &text));
    Some(lines.join("\n"))
}

fn elements(facts: &Facts) -> String {
    let vertices = counted(facts.vertices, "vertex", "vertices");
    let edges = counted(facts.edges, "edge", "edges");
    let faces = counted(facts.faces, "face", "faces");
    let chi = facts.euler_characteristic;
    format!("{vertices}, {edges}, {faces}; Euler characteristic {chi}")
}

fn surface(facts: &Facts) -> String {
    let mut text = counted(facts.components, "component", "components");
    if facts.closed {
        text += ", closed";
    } else {
        let edges = counted(facts.boundary_edges, "boundary edge", "boundary edges");
        text += &format!(", {edges}");
        if let Some(loops) = facts.boundary_loops {
            text += &format!(" in {}", counted(loops, "loop", "loops"));
        }
    }
    match facts.genus {
        Some(genus) => text + &format!(", genus {genus}"),
        None => text + ", genus not defined",
    }
}

fn orientation(facts: &Facts) -> String {
    let edges = counted(facts.inconsistent_edges, "edge", "edges");
    match (facts.consistently_oriented, facts.orientable) {
        (Some(true), Some(true)) if facts.non_manifold_edges == 0 => "consistent".into(),
        (Some(true), Some(true)) => "consistent along edges with two faces".into(),
        (Some(true), _) => "consistent along edges with two faces, but not orientable".into(),
        (_, Some(true)) => {
            format!("orientable, but at {edges} the two faces have opposite orientations")
        }
        _ => format!("not orientable; at {edges} the two faces have opposite orientations"),
    }
}

fn manifold(facts: &Facts) -> String {
    let (edges, vertices) = (facts.non_manifold_edges, facts.non_manifold_vertices);
    let counts = present([
        (edges, "non-manifold edge", "non-manifold edges"),
        (vertices, "non-manifold vertex", "non-manifold vertices"),
    ]);
    match counts.is_empty() {
        true => "yes".into(),
        false => format!("no: {}", counts.join(", ")),
    }
}

fn degrees(facts: &Facts) -> String {
    let range = |spread: &Option<Distribution>| match spread {
        Some(s) if s.min == s.max => s.min.to_string(),
        Some(s) => format!(
            "{} to {} (mean {:.2})",
            grouped(s.min),
            grouped(s.max),
            s.mean
        ),
        None => "none".into(),
    };
    let (valence, degree) = (range(&facts.valence), range(&facts.face_degree));
    format!("valence {valence}; face degree {degree}")
}

fn mesh_defects(facts: &Facts) -> Vec<String> {
    let (isolated, duplicate) = (facts.isolated_vertices, facts.duplicate_faces);
    present([
        (isolated, "isolated vertex", "isolated vertices"),
        (duplicate, "duplicate face", "duplicate faces"),
        (
            facts.degenerate_faces,
            "degenerate face",
            "degenerate faces",
        ),
    ])
}

/// Formats the counts that are not 0, each with its noun in the singular or plural.
fn present<const N: usize>(counts: [(usize, &str, &str); N]) -> Vec<String> {
    let present = counts.into_iter().filter(|&(count, ..)| count > 0);
    present
        .map(|(count, singular, plural)| counted(count, singular, plural))
        .collect()
}

/// Returns the backends that can hold the mesh, and the other backends with their reasons. Backends
/// with the same reason share a line.
pub(crate) fn verdicts_text(mesh: &MeshReport, backends: &[BackendReport]) -> String {
    let names = |of: &dyn Fn(&BackendReport) -> bool| {
        let names = backends.iter().filter(|backend| of(backend));
        names
            .map(|b| b.name.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    };
    let holding = match names(&|backend| backend.holds) {
        none if none.is_empty() => "no backend".to_owned(),
        names => names,
    };
    let mut lines = vec![hanging_indent("held by      ", &holding)];
    let mut reasons: Vec<&Option<String>> = Vec::new();
    for BackendReport { holds, reason, .. } in backends {
        if !holds && !reasons.contains(&reason) {
            reasons.push(reason);
        }
    }
    for reason in &reasons {
        let mut text = names(&|backend| !backend.holds && backend.reason == **reason);
        if let Some(reason) = reason {
            text += &format!(": {reason}");
        }
        lines.push(hanging_indent("refused by   ", &text));
    }
    if !reasons.is_empty() {
        let changed = match mesh.changes.is_empty() {
            true => "",
            false => ", f0 the first face that is left",
        };
        let first = format!("{:<13}", "");
        let note = format!("(counting from 0: v0 is the first vertex of the file{changed})");
        lines.push(hanging_indent(&first, &note));
    }
    lines.join("\n")
}
