//! `sixfold repair`: runs the chosen repairs, and reports what each step did.

use std::path::Path;
use std::process::ExitCode;

use serde::Serialize;
use sixfold::io::{Format, Loss, WriteOptions};
use sixfold::repair::{
    ElementMap, RepairError, Repaired, Step, StepReport, Weld, repair, repair_for,
};
use sixfold::{FaceId, Facts, PolygonMesh, StructureInfo, structure_infos};

use crate::arguments::{ChosenSteps, Repair};
use crate::failure::Failure;
use crate::load::{self, ReadMesh};
use crate::mesh_files::{MeshOutput, shown};
use crate::output::{Output, check_outputs, is_stdout};
use crate::progress::{Spinner, exit_on_interrupt};
use crate::shape_check::check_faces;
use crate::text::{TextOutput, WithNotices, print_notice, print_places, sanitize};
use sixfold_results::numbers::{counted, grouped};

/// The exit code if the written file does not keep the repair.
const NOT_KEPT: u8 = 1;

/// Repairs the mesh and writes it.
pub(crate) fn run(arguments: &Repair) -> Result<ExitCode, Failure> {
    let outputs = [
        ("--output", Some(&arguments.files.output)),
        ("--json", arguments.json.as_ref()),
    ];
    check_outputs(Some(&arguments.files.mesh), &outputs)?;
    let ChosenSteps { steps, structure } = &arguments.steps;
    if steps.is_empty() && structure.is_none() {
        return Err(Failure::usage(
            "no repair is chosen: name a structure with --for, or choose steps such as --weld",
        ));
    }
    exit_on_interrupt();
    let read = load::for_repair(&arguments.files.mesh, arguments.read)?;
    let polygons = &read.polygons;
    // The outputs are opened before the work, so that an unusable place gives an error at once.
    let output = MeshOutput::open(&arguments.files.output, arguments.files.write, read.origin)?;
    let json = Output::open_if(arguments.json.as_ref())?;
    let count = counted(polygons.face_count(), "face", "faces");
    let spinner = Spinner::start(format!("repairing {count}"));
    let done = repair(polygons, steps).and_then(|mut chosen| {
        let sharp = chosen.carried_creases(&read.creases);
        let Some(name) = structure else {
            let faces = vec![chosen.faces.clone()];
            return Ok((chosen, sharp, faces));
        };
        let capabilities = structure_info(name).capabilities;
        let repaired = repair_for(&chosen.polygons, &capabilities)?;
        let (creases, lost) = repaired.carried_creases(&sharp.0);
        let faces = vec![chosen.faces, repaired.faces.clone()];
        chosen.steps.extend(repaired.steps);
        let steps = chosen.steps;
        let repaired = Repaired { steps, ..repaired };
        Ok((repaired, (creases, sharp.1 + lost), faces))
    });
    spinner.clear();
    let (repaired, (creases, lost), faces) = done.map_err(|error| failure(&error))?;
    if lost > 0 {
        let elements = counted(
            lost,
            "sharp edge or vertex is",
            "sharp edges and vertices are",
        );
        let file = shown(&arguments.files.mesh);
        print_notice(&format!(
            "note: {file}: {elements} not in the repaired mesh"
        ));
    }
    let options = WriteOptions::default().with_creases(&creases);
    let format = output.format;
    print_left(&arguments.files.mesh, &read, &repaired.steps);
    let place = |face| place_of(face, &read, &faces, &arguments.files.mesh);
    let losses = output.write_placed(&repaired.polygons, &options, place)?;
    let code = check_result(arguments, format, polygons, &repaired);
    if let Some(json) = json {
        let report = Report::new(&read, &repaired, lost, &losses);
        json.write_json(&WithNotices::new(&report))?;
    }
    let data_on_stdout =
        is_stdout(&arguments.files.output) || arguments.json.as_deref().is_some_and(is_stdout);
    let mut text = TextOutput::new(!data_on_stdout);
    print_reading(&read, &mut text);
    print_steps(&repaired.steps, &mut text);
    let place = sanitize(&arguments.files.output.display().to_string());
    text.print_line(&format!("{place}: {}", repaired.polygons));
    text.finish()?;
    Ok(code)
}

/// Prints a warning if the written file does not keep the repair, if merged vertices made edges or
/// vertices non-manifold, or if the result is empty, and returns the exit code.
fn check_result(
    arguments: &Repair,
    format: Format,
    before: &PolygonMesh,
    repaired: &Repaired,
) -> ExitCode {
    let after = &repaired.polygons;
    let file = arguments.files.output.display();
    let refusing = arguments.steps.structure.as_deref();
    if let Some(name) = refusing.filter(|name| undoes_repair(format, after, name)) {
        print_notice(&format!(
            "warning: {file}: readers of STL join vertices at equal positions, and {name} refuses the \
             mesh that results: write PLY or OBJ, which keep the cut"
        ));
        return ExitCode::from(NOT_KEPT);
    }
    let mut counts = repaired.steps.iter().map(|step| step.counts);
    let is_welded = counts.any(|counts| counts.vertices_merged > 0);
    if is_welded {
        for worse in new_faults(before, after) {
            print_notice(&format!("warning: {file}: {worse}"));
        }
    }
    check_faces(before.face_count(), after, &arguments.files.output)
}

/// Describes what a repair made non-manifold.
fn new_faults(before: &PolygonMesh, after: &PolygonMesh) -> Vec<String> {
    let after = Facts::from_polygons(after);
    if after.non_manifold_edges + after.non_manifold_vertices == 0 {
        return Vec::new();
    }
    let before = Facts::from_polygons(before);
    let counts = [
        (
            [
                "edge has three or more faces",
                "edges have three or more faces",
            ],
            [before.non_manifold_edges, after.non_manifold_edges],
        ),
        (
            [
                "vertex has several fans of faces",
                "vertices have several fans of faces",
            ],
            [before.non_manifold_vertices, after.non_manifold_vertices],
        ),
    ];
    let worse = counts
        .into_iter()
        .filter(|(_, [before, after])| after > before);
    let text = |([one, many], [before, after]): ([&str; 2], [usize; 2])| {
        let now = counted(after, one, many);
        format!(
            "{now}, {} before the repair: --cut separates them",
            grouped(before)
        )
    };
    worse.map(text).collect()
}

/// Returns whether the written file is STL, and the structure called `name` refuses the mesh that
/// readers make of it: `polygons` with equal positions joined.
fn undoes_repair(format: Format, polygons: &PolygonMesh, name: &str) -> bool {
    if !matches!(format, Format::Stl | Format::StlAscii) {
        return false;
    }
    // A facet whose corners are joined is left out by readers; welding removes it, too.
    let joined = repair(polygons, &[Step::Weld(Weld::default())]);
    let capabilities = structure_info(name).capabilities;
    joined.is_ok_and(|joined| capabilities.check(&joined.polygons).is_err())
}

/// Returns the structure called `name`.
fn structure_info(name: &str) -> StructureInfo {
    let mut infos = structure_infos().into_iter();
    let info = infos.find(|info| info.name == name);
    info.expect("the arguments accept only names of structures")
}

/// Describes where face `face` of the repaired mesh is in the file, if it comes from one there. `maps` are
/// those of the repairs, in order.
fn place_of(face: FaceId, read: &ReadMesh, maps: &[ElementMap<FaceId>], file: &Path) -> String {
    let before = |new: FaceId, map: &ElementMap<FaceId>| map.old_elements(new).first().copied();
    let old = maps.iter().rev().try_fold(face, before);
    match old {
        Some(old) => {
            let place = read.places.place(old, &read.polygons);
            format!("face {face}, from {place} of {}", shown(file))
        }
        None => format!("face {face}"),
    }
}

/// Prints the first places that each step left, and where they are in the file, if no earlier step has
/// changed the mesh.
fn print_left(mesh: &Path, read: &ReadMesh, steps: &[StepReport]) {
    let mut is_as_read = true;
    for report in steps {
        let step = report.step;
        let places = report.left.iter().map(|left| {
            let face = left.face().filter(|_| is_as_read);
            let place = face.map(|face| format!(" ({})", read.places.place(face, &read.polygons)));
            format!("{left}{}", place.unwrap_or_default())
        });
        print_places(&format!("{}: {step}", shown(mesh)), places);
        is_as_read &= !report.counts.is_change();
    }
}

fn failure(error: &RepairError) -> Failure {
    match error {
        RepairError::BadTolerance { .. } | RepairError::RelativeToleranceAboveOne { .. } => {
            Failure::usage(error)
        }
        _ => Failure::unsupported(error),
    }
}

/// Prints a line with what reading changed, unless it is nothing.
fn print_reading(read: &ReadMesh, text: &mut TextOutput) {
    let parts = [
        (read.joined, "vertices joined"),
        (read.left_out.len(), "faces left out"),
    ];
    let present = parts.into_iter().filter(|&(count, _)| count > 0);
    let parts: Vec<String> = present
        .map(|(count, what)| format!("{what}: {}", grouped(count)))
        .collect();
    if !parts.is_empty() {
        text.print_line(&format!("read the file: {}", parts.join(", ")));
    }
}

/// Prints a line for each step.
fn print_steps(steps: &[StepReport], text: &mut TextOutput) {
    if steps.is_empty() {
        text.print_line("the mesh needs no repair");
    }
    for report in steps {
        text.print_list("", [format!("{}: {}", report.step, summary(report))]);
    }
}

/// Returns the counts of a step that are not zero, in words.
fn summary(report: &StepReport) -> String {
    let counts = report.counts;
    let parts = [
        (counts.vertices_merged, "vertices merged"),
        (counts.vertices_added, "vertices added"),
        (counts.vertices_removed, "vertices removed"),
        (counts.edges_cut, "edges cut"),
        (counts.holes_filled, "holes filled"),
        (counts.faces_added, "faces added"),
        (counts.faces_removed, "faces removed"),
        (counts.faces_changed, "faces changed"),
        (counts.faces_reversed, "faces reversed"),
    ];
    let present = parts.into_iter().filter(|&(count, _)| count > 0);
    let mut parts: Vec<String> = present
        .map(|(count, what)| format!("{what}: {}", grouped(count)))
        .collect();
    if counts.largest_shift > 0.0 {
        parts.push(format!("largest shift: {:.3e}", counts.largest_shift));
    }
    match parts.is_empty() {
        true => "nothing to do".into(),
        false => parts.join(", "),
    }
}

/// The report as JSON.
#[derive(Serialize)]
struct Report<'a> {
    /// The file.
    before: Size,
    /// What changed before the first step.
    reading: Reading,
    after: Size,
    steps: &'a [StepReport],
    lost: Vec<Lost>,
}

#[derive(Serialize)]
struct Size {
    vertices: usize,
    faces: usize,
}

#[derive(Serialize)]
struct Reading {
    vertices_joined: usize,
    faces_left_out: usize,
}

/// Contents of the file that are not in the output, one entry for each kind.
#[derive(Serialize)]
struct Lost {
    what: &'static str,
    count: u64,
}

impl<'a> Report<'a> {
    /// Builds the report. `creases` is the number of sharp edges and vertices that the repair lost.
    fn new(read: &ReadMesh, repaired: &'a Repaired, creases: usize, losses: &[Loss]) -> Self {
        let ignored = read.ignored.iter();
        let mut lost: Vec<Lost> = ignored
            .map(|notice| Lost {
                what: notice.kind.title(),
                count: notice.count,
            })
            .collect();
        let creases = (creases > 0).then_some(Loss::Creases(creases));
        for loss in creases.iter().chain(losses) {
            let count = loss.count() as u64;
            match lost.iter_mut().find(|lost| lost.what == loss.title()) {
                Some(lost) => lost.count += count,
                None => lost.push(Lost {
                    what: loss.title(),
                    count,
                }),
            }
        }
        Self {
            before: Size {
                vertices: read.polygons.vertex_count() + read.joined,
                faces: read.polygons.face_count() + read.left_out.len(),
            },
            reading: Reading {
                vertices_joined: read.joined,
                faces_left_out: read.left_out.len(),
            },
            after: Size {
                vertices: repaired.polygons.vertex_count(),
                faces: repaired.polygons.face_count(),
            },
            steps: &repaired.steps,
            lost,
        }
    }
}
