//! Faults of a mesh and the commands that repair them, as text and as JSON.

use std::cmp::Reverse;
use std::path::Path;

use sixfold::io::{self, LeftOut, PolygonPlaces};
use sixfold::repair::{Crack, Diagnosis, Fault, FaultKind, Place, Step};
use sixfold::{Capabilities, FaceId, PolygonMesh, structure_infos};
use sixfold_results::numbers::{counted, grouped};

use serde::Serialize;

use crate::arguments::repair_options;
use crate::shell::shell_word;
use crate::text::{hanging_indent, width};

/// Maximum number of places that are listed for a kind of fault.
pub(crate) const SHOWN_PLACES: usize = 3;

/// A space at which no line ends.
pub(crate) const NO_BREAK: &str = "\u{a0}";

/// Width of the labels.
const LABEL: usize = 13;

/// A diagnosed mesh.
pub(crate) struct Diagnosed<'a> {
    pub(crate) polygons: &'a PolygonMesh,
    /// Where the vertices and faces are in the file; `None` if they are not those of the file.
    pub(crate) places: Option<&'a PolygonPlaces>,
    pub(crate) diagnosis: &'a Diagnosis,
    /// The degenerate faces of the file, which the mesh does not have.
    pub(crate) left_out: &'a [LeftOut],
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
    /// Boundaries that nearly meet.
    crack: Option<CrackRecord>,
    left_out: LeftOutRecord,
}

/// Boundaries that nearly meet, and the command that welds them.
#[derive(Serialize)]
struct CrackRecord {
    #[serde(flatten)]
    crack: Crack,
    /// The command; `None` if welding would harm other parts.
    repair: Option<String>,
}

/// The degenerate faces of the file, which the mesh does not have.
#[derive(Serialize)]
struct LeftOutRecord {
    count: usize,
    places: Vec<LeftOutPlace>,
    /// The command; `None` if there are no such faces.
    repair: Option<String>,
}

/// A degenerate face: its vertices as the file numbers them, and its place in the file.
#[derive(Serialize)]
struct LeftOutPlace {
    vertices: Vec<u32>,
    #[serde(flatten)]
    place: FilePlace,
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

/// An element, and where the vertex or the first face there is in the file.
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
            crack: self.diagnosis.crack.map(|crack| CrackRecord {
                crack,
                repair: crack
                    .is_safe()
                    .then(|| self.command(&repair_options(&crack.repairs()))),
            }),
            left_out: self.left_out_record(),
        }
    }

    fn left_out_record(&self) -> LeftOutRecord {
        let places = self.left_out.iter().take(SHOWN_PLACES);
        LeftOutRecord {
            count: self.left_out.len(),
            places: places
                .map(|face| LeftOutPlace {
                    vertices: face.vertices.clone(),
                    place: face.place.into(),
                })
                .collect(),
            repair: (!self.left_out.is_empty()).then(|| self.command(self.left_out_options())),
        }
    }

    /// Returns the option of the command that writes the mesh without the degenerate faces of the
    /// file. Reading leaves them out, so that every command does.
    fn left_out_options(&self) -> &'static str {
        match self.diagnosis.looks_unwelded() {
            true => "--weld",
            false => "--flat",
        }
    }

    /// Returns the list of faults: each with its first places, the structures that refuse the mesh
    /// for it, and the options that repair it. The last lines have the command. If the faces do not
    /// share vertices, the only command is the one that joins them, because the other faults can
    /// follow from this one.
    pub(crate) fn text(&self) -> String {
        let mut lines = Vec::new();
        let is_unwelded = self.diagnosis.looks_unwelded();
        if is_unwelded {
            let text = format!(
                "the faces do not share vertices ({} vertices at {} positions)",
                grouped(self.diagnosis.vertices),
                grouped(self.diagnosis.positions)
            );
            lines.push(hanging_indent(&label(&lines), &text));
        }
        // No line ends within an option.
        let note = |text: String| {
            hanging_indent(&format!("{:LABEL$}  ", ""), &text).replace(NO_BREAK, " ")
        };
        if !self.left_out.is_empty() {
            lines.push(hanging_indent(&label(&lines), &self.left_out_title()));
            if !is_unwelded {
                lines.push(note(format!("repair: {}", self.left_out_options())));
            }
        }
        let faces = self.first_faces();
        for fault in &self.diagnosis.faults {
            // The first line of the list has these vertices.
            if fault.kind == FaultKind::CoincidentVertex && is_unwelded {
                continue;
            }
            let mut title = Self::title(fault);
            title += &self.places_text(fault, &faces);
            lines.push(hanging_indent(&label(&lines), &title));
            let mut notes = Vec::new();
            if let (FaultKind::BoundaryEdge, Some(crack)) = (fault.kind, self.diagnosis.crack) {
                notes.push(crack_text(&crack));
            }
            let refusing = refusing(|own| fault.kind.is_refused_by(own));
            if !refusing.is_empty() {
                notes.push(format!("refused by {}", refusing.join(", ")));
            }
            match self.options(fault) {
                none if none.is_empty() => match fault.kind {
                    // Nothing is known that helps.
                    FaultKind::TouchingComponent | FaultKind::BoundaryEdge => {}
                    _ => notes.push("correct the coordinates".to_owned()),
                },
                _ if is_unwelded => {}
                // The text about the crack has the options.
                _ if fault.kind == FaultKind::BoundaryEdge
                    && self.diagnosis.wide_crack().is_some() => {}
                options => {
                    let options = unbroken(&options);
                    notes.push(format!("repair:{NO_BREAK}{options}"));
                }
            }
            if !notes.is_empty() {
                lines.push(note(notes.join("; ")));
            }
        }
        if lines.is_empty() {
            lines.push(format!("{:LABEL$}none", "faults"));
        }
        lines.extend(self.repair_lines());
        lines.join("\n")
    }

    /// Returns lines with one command: the command that repairs all that a structure refuses, for
    /// the structure that refuses most. If all structures hold the mesh, the command repairs the
    /// first fault. No lines if no command repairs a fault.
    fn repair_lines(&self) -> Vec<String> {
        let refusals = |own: &Capabilities| self.diagnosis.refusals(own).count();
        let mut refusing: Vec<_> = structure_infos()
            .into_iter()
            .filter(|info| refusals(&info.capabilities) > 0)
            .collect();
        refusing.sort_by_key(|info| Reverse(refusals(&info.capabilities)));
        let names: Vec<&str> = refusing.iter().map(|info| info.name).collect();
        let left_out = (!self.left_out.is_empty()).then(|| self.left_out_options().to_owned());
        let faults = self
            .diagnosis
            .faults
            .iter()
            .map(|fault| self.options(fault));
        let options = left_out.into_iter().chain(faults).filter(|o| !o.is_empty());
        let options: Vec<String> = options.collect();
        let crack = self.diagnosis.wide_crack();
        let (text, options) = match (names.split_first(), options.first()) {
            (_, Some(options)) if self.diagnosis.looks_unwelded() => {
                let text = "join the vertices, then inspect the result for the other faults:";
                (text.to_owned(), options.clone())
            }
            (_, Some(_)) if crack.is_some() => {
                let text = "close the cracks, then inspect the result for the other faults:";
                let steps: Vec<Step> = crack.iter().flat_map(Crack::repairs).collect();
                (text.to_owned(), repair_options(&steps))
            }
            (Some((first, others)), _) => {
                let others = match others {
                    [] => String::new(),
                    others => format!(" (or for {})", others.join(", ")),
                };
                let one = match options.len() {
                    0 | 1 => "",
                    _ => "; for one kind of fault, write its options instead of --for",
                };
                (
                    format!("all that {first} refuses{others}{one}:"),
                    format!("--for {first}"),
                )
            }
            (None, Some(options)) => {
                let text = "one kind of fault, by its options:";
                (text.to_owned(), options.clone())
            }
            (None, None) => return Vec::new(),
        };
        let first_line = hanging_indent(&format!("{:LABEL$}", "repair"), &text);
        vec![first_line, self.command_line(&options)]
    }

    /// Returns the options of the command that repairs `fault`; empty if no command does. If the
    /// faces do not share vertices, this must be repaired first.
    fn options(&self, fault: &Fault) -> String {
        let steps = self.diagnosis.repairs(fault.kind);
        match self.diagnosis.looks_unwelded() && !steps.is_empty() {
            true => "--weld".to_owned(),
            false => repair_options(&steps),
        }
    }

    /// Describes the degenerate faces of the file: their number and the first ones.
    fn left_out_title(&self) -> String {
        let title = match self.left_out.len() {
            1 => "1 degenerate face of the file, left out".to_owned(),
            n => format!("{} degenerate faces of the file, left out", grouped(n)),
        };
        let shown = self.left_out.iter().take(SHOWN_PLACES);
        let shown: Vec<String> = shown.map(ToString::to_string).collect();
        let more = match self.left_out.len() > SHOWN_PLACES {
            true => ", …",
            false => "",
        };
        format!("{title}: {}{more}", shown.join(", "))
    }

    /// Returns a line with the command that repairs the file with `options`.
    fn command_line(&self, options: &str) -> String {
        command_line(&self.words(options))
    }

    /// Returns the command that repairs the file with `options`.
    fn command(&self, options: &str) -> String {
        self.words(options).join(" ")
    }

    /// Returns the words of the command that repairs the file with `options`.
    fn words(&self, options: &str) -> Vec<String> {
        // The command must not overwrite its input.
        let output = match self.file.file_name() {
            Some(name) if name == "repaired.obj" => "repaired-again.obj",
            _ => "repaired.obj",
        };
        let options = options.split(' ').map(str::to_owned);
        [
            "sixfold".to_owned(),
            "repair".to_owned(),
            shell_word(self.file),
        ]
        .into_iter()
        .chain(options)
        .chain(["-o".to_owned(), output.to_owned()])
        .collect()
    }

    /// Returns where the element at `place` is in the file: the place of a vertex, or that of the
    /// first face there, if `faces` has this face.
    fn file_place(&self, place: &Place, faces: &[(Place, FaceId)]) -> Option<io::Place> {
        let places = self.places?;
        if let Place::Vertex(v) = *place
            && let Some(place) = places.vertex_place(v)
        {
            return Some(place);
        }
        let (_, face) = faces.iter().find(|(other, _)| other == place)?;
        Some(places.place(*face, self.polygons))
    }

    /// Describes a fault: its number and kind.
    fn title(fault: &Fault) -> String {
        let [one, many] = fault.kind.titles();
        let title = if fault.count == 1 { one } else { many };
        let intended = match may_be_intended(fault.kind) {
            true => " (may be intended)",
            false => "",
        };
        format!("{} {title}{intended}", grouped(fault.count))
    }

    /// Lists the first places of a fault, after a colon.
    fn places_text(&self, fault: &Fault, faces: &[(Place, FaceId)]) -> String {
        let mut text = String::new();
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

/// Returns options that are broken into lines only before an option.
fn unbroken(options: &str) -> String {
    options.replace(' ', NO_BREAK).replace("\u{a0}--", " --")
}

/// Describes boundaries that nearly meet, and what welding them would harm.
fn crack_text(crack: &Crack) -> String {
    let edges = grouped(crack.edges);
    let distance = crack.distance;
    if crack.is_safe() {
        let options = unbroken(&repair_options(&crack.repairs()));
        return format!("{edges} of them nearly meet: closed by {options}");
    }
    let faces = counted(crack.collapsed_faces, "face", "faces");
    let bad = counted(
        crack.non_manifold_edges,
        "edge with three or more faces",
        "edges with three or more faces",
    );
    let harm = match [crack.collapsed_faces, crack.non_manifold_edges] {
        [0, _] => format!("make {bad}"),
        [_, 0] => format!("collapse {faces}"),
        [_, _] => format!("collapse {faces} and make {bad}"),
    };
    format!(
        "{edges} of them nearly meet, but --weld={distance}, which closes them, would {harm}: weld \
         these parts alone"
    )
}

/// Returns whether good meshes can have the fault.
fn may_be_intended(kind: FaultKind) -> bool {
    matches!(
        kind,
        FaultKind::Polygon
            | FaultKind::CoincidentVertex
            | FaultKind::OppositeFace
            | FaultKind::TouchingComponent
            | FaultKind::BoundaryEdge
    )
}

/// Returns an indented line with a command. A command that is wider than the terminal continues on
/// the next lines, as a shell reads it.
fn command_line(words: &[String]) -> String {
    let indent = " ".repeat(LABEL + 2);
    let mut lines = vec![format!("{indent}{}", words.join(" "))];
    let is_wide = |line: &String| line.chars().count() > width();
    if is_wide(&lines[0]) {
        lines = vec![format!("{indent}{}", words[0])];
        for word in &words[1..] {
            let last = lines.len() - 1;
            // Two more columns for the character that continues the line.
            match lines[last].chars().count() + 1 + word.chars().count() + 2 <= width() {
                true => lines[last] += &format!(" {word}"),
                false => {
                    lines[last] += " \\";
                    lines.push(format!("{indent}  {word}"));
                }
            }
        }
    }
    lines.join("\n")
}
