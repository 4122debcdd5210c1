//! `sixfold repair`: runs the chosen repairs, and reports what each step did.

use std::process::ExitCode;

use serde::Serialize;
use sixfold::repair::{RepairError, Repaired, StepReport, repair, repair_for};
use sixfold::{PolygonMesh, structure_infos};

use crate::arguments::Repair;
use crate::failure::Failure;
use crate::load;
use crate::mesh_files::write_mesh;
use crate::output::{Output, check_outputs, is_stdout};
use crate::progress::{Spinner, exit_on_interrupt};
use crate::text::{TextOutput, sanitize};
use sixfold_study::numbers::{counted, grouped};

/// Maximum number of places that a step left and that are listed.
const SHOWN: usize = 5;

/// Repairs the mesh and writes it.
pub(crate) fn run(arguments: &Repair) -> Result<ExitCode, Failure> {
    let outputs = [
        ("--output", Some(&arguments.output)),
        ("--json", arguments.json.as_ref()),
    ];
    check_outputs(Some(&arguments.mesh), &outputs)?;
    let steps = arguments.steps();
    if steps.is_empty() && arguments.structure.is_none() {
        return Err(Failure::usage(
            "no repair is chosen: name a structure with --for, or choose steps such as --weld",
        ));
    }
    exit_on_interrupt();
    let polygons = load::without_creases(&arguments.mesh)?;
    // The outputs are opened before the work, so that an unusable place gives an error at once.
    let output = Output::open(&arguments.output)?;
    let json = Output::open_if(arguments.json.as_ref())?;
    let faces = counted(polygons.face_count(), "face", "faces");
    let spinner = Spinner::start(format!("repairing {faces}"));
    let done = repair(&polygons, &steps).and_then(|chosen| match &arguments.structure {
        Some(name) => for_structure(chosen, name),
        None => Ok(chosen),
    });
    spinner.clear();
    let repaired = done.map_err(|error| failure(&error))?;
    write_mesh(output, &arguments.output, &repaired.polygons, &[])?;
    if let Some(json) = json {
        let report = Report::new(&polygons, &repaired);
        json.finish(|writer| {
            serde_json::to_writer_pretty(&mut *writer, &report)?;
            writeln!(writer)
        })?;
    }
    let data_on_stdout =
        is_stdout(&arguments.output) || arguments.json.as_deref().is_some_and(is_stdout);
    let mut text = TextOutput::new(!data_on_stdout);
    print_steps(&repaired.steps, &mut text);
    let place = sanitize(&arguments.output.display().to_string());
    text.print_line(&format!("{place}: {}", repaired.polygons));
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Repairs the mesh further for the structure called `name`.
fn for_structure(chosen: Repaired, name: &str) -> Result<Repaired, RepairError> {
    let infos = structure_infos();
    let info = infos.iter().find(|info| info.name == name);
    let info = info.expect("the arguments accept only names of structures");
    let Repaired {
        polygons,
        mut steps,
        ..
    } = chosen;
    let repaired = repair_for(&polygons, &info.capabilities)?;
    steps.extend(repaired.steps);
    Ok(Repaired { steps, ..repaired })
}

fn failure(error: &RepairError) -> Failure {
    match error {
        RepairError::BadTolerance { .. } | RepairError::RelativeToleranceAboveOne { .. } => {
            Failure::usage(error)
        }
        _ => Failure::unsupported(error),
    }
}

/// Prints a line for each step, and the places that it left.
fn print_steps(steps: &[StepReport], text: &mut TextOutput) {
    if steps.is_empty() {
        text.print_line("the mesh needs no repair");
    }
    for report in steps {
        text.print_line(&format!("{}: {}", report.step, summary(report)));
        for left in report.left.iter().take(SHOWN) {
            text.print_line(&format!("  left: {left}"));
        }
        if report.left.len() > SHOWN {
            text.print_line(&format!("  and {} more", report.left.len() - SHOWN));
        }
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
    before: Size,
    after: Size,
    steps: &'a [StepReport],
}

#[derive(Serialize)]
struct Size {
    vertices: usize,
    faces: usize,
}

impl<'a> Report<'a> {
    fn new(before: &PolygonMesh, repaired: &'a Repaired) -> Self {
        let size = |mesh: &PolygonMesh| Size {
            vertices: mesh.vertex_count(),
            faces: mesh.face_count(),
        };
        Self {
            before: size(before),
            after: size(&repaired.polygons),
            steps: &repaired.steps,
        }
    }
}
