//! Faults of a mesh and the commands that repair them, as text and as JSON.

use std::cmp::Reverse;
use std::path::Path;

use sixfold::io::{self, PolygonPlaces};
use sixfold::repair::{Diagnosis, Fault, FaultKind, Place};
use sixfold::{Capabilities, FaceId, PolygonMesh, structure_infos};
use sixfold_study::numbers::grouped;

use serde::Serialize;

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

/// The diagnosis of a mesh as JSON: a [`Diagnosis`] with places in the file, the structures that
/// refuse, and commands.
#[derive(Serialize)]
pub(crate) struct DiagnosisRecord {
    faults: Vec<FaultRecord>,
    vertices: usize,
    positions: usize,
    boundary_edges: usize,
    seam_edges: usize,
}

#[derive(Serialize)]
struct FaultRecord {
    kind: FaultKind,
    count: usize,
    places: Vec<PlaceRecord>,
    refused_by: Vec<&'static str>,
    /// The command; `None` if only other coordinates repair the fault.
    repair: Option<String>,
}

/// An element, and where its first face is in the file.
#[derive(Serialize)]
struct PlaceRecord {
    #[serde(flatten)]
    element: Place,
    #[serde(flatten)]
    place: Option<FilePlace>,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum FilePlace {
    Line(u32),
    Byte(u64),
    Item(String),
}

impl From<io::Place> for FilePlace {
    fn from(place: io::Place) -> Self {
        match place {
            io::Place::Line(line) => Self::Line(line),
            io::Place::Byte(byte) => Self::Byte(byte),
            other => Self::Item(other.to_string()),
        }
    }
}

impl Diagnosed<'_> {
    /// Returns the faults for JSON.
    pub(crate) fn record(&self) -> DiagnosisRecord {
        let faces = self.first_faces();
        let faults = self.diagnosis.faults.iter().map(|fault| {
            let places = fault.places.iter().map(|place| PlaceRecord {
                element: *place,
                place: self.file_place(place, &faces).map(FilePlace::from),
            });
            let options = self.options(fault);
            FaultRecord {
                kind: fault.kind,
                count: fault.count,
                places: places.collect(),
                refused_by: refusing(|own| fault.kind.is_refused_by(own)),
                repair: (!options.is_empty()).then(|| self.command(&options)),
            }
        });
        let Diagnosis {
            vertices,
            positions,
            boundary_edges,
            seam_edges,
            ..
        } = *self.diagnosis;
        DiagnosisRecord {
            faults: faults.collect(),
            vertices,
            positions,
            boundary_edges,
            seam_edges,
        }
    }

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
            lines.push(self.command_line("--weld"));
        }
        let faces = self.first_faces();
        for fault in &self.diagnosis.faults {
            lines.push(hanging_indent(&label(&lines), &self.title(fault, &faces)));
            let refusing = refusing(|own| fault.kind.is_refused_by(own));
            if !refusing.is_empty() {
                let first = format!("{:LABEL$}  refused by ", "");
                lines.push(hanging_indent(&first, &refusing.join(", ")));
            }
            let options = self.options(fault);
            match options.is_empty() {
                true => lines.push(format!("{:LABEL$}  correct the coordinates", "")),
                false => lines.push(self.command_line(&options)),
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
        vec![first_line, self.command_line(&format!("--for {first}"))]
    }

    /// Returns the options of the command that repairs `fault`; empty if no command does.
    fn options(&self, fault: &Fault) -> String {
        repair_options(&self.diagnosis.repairs(fault.kind))
    }

    /// Returns a line with the command that repairs the file with `options`.
    fn command_line(&self, options: &str) -> String {
        format!("{:LABEL$}  {}", "", self.command(options))
    }

    /// Returns the command that repairs the file with `options`.
    fn command(&self, options: &str) -> String {
        let file = self.file.display().to_string();
        let file = match shlex::try_quote(&file) {
            Ok(quoted) => sanitize(&quoted),
            Err(_) => sanitize(&file),
        };
        format!("sixfold repair {file} {options} -o repaired.obj")
    }

    /// Returns where the first face at `place` is in the file, if `faces` has this face.
    fn file_place(&self, place: &Place, faces: &[(Place, FaceId)]) -> Option<io::Place> {
        let (_, face) = faces.iter().find(|(other, _)| other == place)?;
        Some(self.places?.place(*face, self.polygons))
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
            if let Some(place) = self.file_place(place, faces) {
                text += &format!(" ({place})");
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
