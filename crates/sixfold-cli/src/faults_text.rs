//! Text about the faults of a mesh and the commands that repair them.

use std::cmp::Reverse;
use std::path::Path;

use sixfold::io::PolygonPlaces;
use sixfold::repair::{Diagnosis, Fault, FaultKind, Place};
use sixfold::{Capabilities, FaceId, PolygonMesh, structure_infos};
use sixfold_study::numbers::grouped;

use crate::arguments::repair_options;
use crate::text::{hanging_indent, sanitize};

/// Maximum number of places that are listed for a kind of fault.
pub(crate) const SHOWN_PLACES: usize = 3;

/// Width of the labels.
const LABEL: usize = 13;

/// A diagnosed mesh.
pub(crate) struct Diagnosed<'a> {
    pub(crate) polygons: &'a PolygonMesh,
    /// Where the faces are in the file; `None` if they are not the faces of the file.
    pub(crate) places: Option<&'a PolygonPlaces>,
    pub(crate) diagnosis: &'a Diagnosis,
    /// The file, for commands.
    pub(crate) file: &'a Path,
}

impl Diagnosed<'_> {
    /// Returns the list of faults: each with its first places, the structures that refuse the mesh
    /// for it, and the command that repairs it. The last lines are the command that repairs the mesh
    /// for a structure.
    pub(crate) fn text(&self) -> String {
        let mut lines = Vec::new();
        if self.diagnosis.looks_unwelded() {
            let text = format!(
                "the faces do not share vertices ({} vertices at {} positions)",
                grouped(self.diagnosis.vertices),
                grouped(self.diagnosis.positions)
            );
            lines.push(hanging_indent(&label(&lines), &text));
            lines.push(self.command("--weld"));
        }
        let faces = self.first_faces();
        for fault in &self.diagnosis.faults {
            lines.push(hanging_indent(&label(&lines), &self.title(fault, &faces)));
            let refusing = refusing(|own| fault.kind.is_refused_by(own));
            if !refusing.is_empty() {
                let first = format!("{:LABEL$}  refused by ", "");
                lines.push(hanging_indent(&first, &refusing.join(", ")));
            }
            let options = repair_options(&self.diagnosis.repairs(fault.kind));
            match options.is_empty() {
                true => lines.push(format!("{:LABEL$}  correct the coordinates", "")),
                false => lines.push(self.command(&options)),
            }
        }
        if lines.is_empty() {
            lines.push(format!("{:LABEL$}none", "faults"));
        }
        lines.extend(self.repair_for_structure());
        lines.join("\n")
    }

    /// Returns lines with the command that repairs all that a structure refuses, for the structure
    /// that refuses most; none if all structures hold the mesh.
    fn repair_for_structure(&self) -> Vec<String> {
        let refusals = |own: &Capabilities| self.diagnosis.refusals(own).count();
        let mut refusing: Vec<_> = structure_infos()
            .into_iter()
            .filter(|info| refusals(&info.capabilities) > 0)
            .collect();
        refusing.sort_by_key(|info| Reverse(refusals(&info.capabilities)));
        let names: Vec<&str> = refusing.iter().map(|info| info.name).collect();
        let Some((first, others)) = names.split_first() else {
            return Vec::new();
        };
        let others = match others {
            [] => String::new(),
            others => format!(" (or for {})", others.join(", ")),
        };
        let text = format!("all that {first} refuses{others}:");
        let first_line = hanging_indent(&format!("{:LABEL$}", "repair"), &text);
        vec![first_line, self.command(&format!("--for {first}"))]
    }

    /// Returns a line with the command that repairs the file with `options`.
    fn command(&self, options: &str) -> String {
        let file = self.file.display().to_string();
        let file = match shlex::try_quote(&file) {
            Ok(quoted) => sanitize(&quoted),
            Err(_) => sanitize(&file),
        };
        format!(
            "{:LABEL$}  sixfold repair {file} {options} -o repaired.obj",
            ""
        )
    }

    /// Describes a fault: its number, kind and first places.
    fn title(&self, fault: &Fault, faces: &[(Place, FaceId)]) -> String {
        let [one, many] = fault.kind.titles();
        let title = if fault.count == 1 { one } else { many };
        let mut text = format!("{} {title}", grouped(fault.count));
        if may_be_intended(fault.kind) {
            text += " (may be intended)";
        }
        for (i, place) in fault.places.iter().enumerate() {
            text += if i == 0 { ": " } else { ", " };
            text += &place.to_string();
            let face = faces.iter().find(|(other, _)| other == place);
            if let (Some(&(_, face)), Some(places)) = (face, self.places) {
                text += &format!(" ({})", places.place(face, self.polygons));
            }
        }
        if fault.count > fault.places.len() {
            text += ", …";
        }
        text
    }

    /// Returns the first face at each listed place; O(corners).
    fn first_faces(&self) -> Vec<(Place, FaceId)> {
        let faults = self.diagnosis.faults.iter();
        let places: Vec<Place> = faults.flat_map(|fault| fault.places.clone()).collect();
        let mut is_listed = vec![false; self.polygons.vertex_count()];
        for place in &places {
            match *place {
                Place::Vertex(v) => is_listed[v.index()] = true,
                Place::Edge(ends) => is_listed[ends[0].index()] = true,
                Place::Face(_) => {}
            }
        }
        let is_face = |place: &Place| match *place {
            Place::Face(face) => Some((*place, face)),
            _ => None,
        };
        let mut found: Vec<(Place, FaceId)> = places.iter().filter_map(is_face).collect();
        for (face, corners) in self.polygons.faces().iter() {
            if corners.iter().all(|v| !is_listed[v.index()]) {
                continue;
            }
            for (i, &v) in corners.iter().enumerate() {
                let next = corners[(i + 1) % corners.len()];
                for at in [Place::Vertex(v), Place::Edge([v.min(next), v.max(next)])] {
                    if places.contains(&at) && found.iter().all(|(other, _)| *other != at) {
                        found.push((at, face));
                    }
                }
            }
        }
        found
    }
}

/// Returns the label of the next line: the first has the heading.
fn label(lines: &[String]) -> String {
    let heading = if lines.is_empty() { "faults" } else { "" };
    format!("{heading:LABEL$}")
}

/// Returns the names of the structures whose capabilities satisfy `refuses`.
fn refusing(refuses: impl Fn(&Capabilities) -> bool) -> Vec<&'static str> {
    let infos = structure_infos().into_iter();
    let refusing = infos.filter(|info| refuses(&info.capabilities));
    refusing.map(|info| info.name).collect()
}

/// Returns whether good meshes can have the fault.
fn may_be_intended(kind: FaultKind) -> bool {
    matches!(
        kind,
        FaultKind::Polygon
            | FaultKind::CoincidentVertex
            | FaultKind::OppositeFace
            | FaultKind::BoundaryEdge
    )
}
