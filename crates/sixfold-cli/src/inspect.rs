//! `sixfold inspect`: shows facts about meshes, their faults, and the backends that can hold them.

use std::path::Path;
use std::process::ExitCode;

use serde::Serialize;
use sixfold::repair::Measures;
use sixfold_study::{Backend, Inspection, inspect_diagnosed};

use crate::arguments::Inspect;
use crate::facts_text::{measures_text, topology_text, verdicts_text};
use crate::failure::Failure;
use crate::faults_text::{Diagnosed, DiagnosisRecord};
use crate::load::{self, InspectedMesh};
use crate::many::find_meshes;
use crate::output::{Output, check_outputs, is_stdout};
use crate::progress::exit_on_interrupt;
use crate::text::{TextOutput, WithNotices, print_notice, print_stderr};

/// The inspection of a mesh as JSON.
#[derive(Serialize)]
struct Inspected {
    #[serde(flatten)]
    inspection: Inspection,
    measures: Measures,
    diagnosis: DiagnosisRecord,
    narrowing: NarrowingRecord,
}

/// What rounding to 32 bits did to the coordinates.
#[derive(Serialize)]
struct NarrowingRecord {
    merged_vertices: usize,
    largest_shift: f64,
}

/// Inspects the meshes. If there are several, continues after a mesh that cannot be read.
pub(crate) fn run(arguments: &Inspect) -> Result<ExitCode, Failure> {
    exit_on_interrupt();
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_notice(note))?;
    let paths: Vec<&Path> = meshes.iter().filter_map(|m| m.path.as_deref()).collect();
    for path in &paths {
        check_outputs(Some(path), &[("--json", arguments.json.as_ref())])?;
    }
    let json = Output::open_if(arguments.json.as_ref())?;
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    let mut inspected: Vec<WithNotices<Inspected>> = Vec::new();
    let mut failed = 0;
    for mesh in &meshes {
        if let Some(problem) = &mesh.problem {
            failed += 1;
            print_stderr(&format!("error: {}: {problem}", mesh.name));
        }
    }
    for path in &paths {
        if !inspected.is_empty() {
            text.print_line("");
        }
        match inspect(path, arguments, &mut text) {
            Ok(done) => inspected.push(WithNotices::new(done)),
            Err(failure) if paths.len() == 1 => return Err(failure),
            Err(failure) => {
                failed += 1;
                print_stderr(&format!("error: {}", failure.message));
            }
        }
    }
    let code = match &inspected[..] {
        [only] if paths.len() == 1 => text.finish_with_json(json, only)?,
        all => text.finish_with_json(json, &all)?,
    };
    match failed {
        0 => Ok(code),
        _ => Err(Failure::usage(format!(
            "{failed} of {} meshes could not be read: correct the files that the messages above \
             name",
            meshes.len()
        ))),
    }
}

/// Inspects one mesh and prints the text.
fn inspect(path: &Path, arguments: &Inspect, text: &mut TextOutput) -> Result<Inspected, Failure> {
    let InspectedMesh {
        study_mesh,
        measures,
        diagnosis,
        places,
        left_out,
        narrowing,
    } = load::for_inspection(path, arguments.read, arguments.triangulate)?;
    let inspection = inspect_diagnosed(&study_mesh, &diagnosis, &Backend::structures());
    let diagnosed = Diagnosed {
        polygons: &study_mesh.polygons,
        places: places.as_ref(),
        diagnosis: &diagnosis,
        left_out: &left_out,
        file: path,
    };
    text.print_line(&topology_text(&inspection.mesh));
    if let Some(size) = measures_text(&measures) {
        text.print_line(&size);
    }
    text.print_line("");
    // The list of faults has the reasons, except the reason that the mesh is too large.
    let mut verdicts = inspection.backends.clone();
    for backend in &mut verdicts {
        let own = backend.capabilities.as_ref();
        if own.is_some_and(|own| diagnosed.diagnosis.refusals(own).next().is_some()) {
            backend.reason = None;
        }
    }
    text.print_line(&verdicts_text(&inspection.mesh, &verdicts));
    text.print_line("");
    text.print_line(&diagnosed.text());
    let diagnosis = diagnosed.record();
    Ok(Inspected {
        inspection,
        measures,
        diagnosis,
        narrowing: NarrowingRecord {
            merged_vertices: narrowing.merged_vertices,
            largest_shift: narrowing.largest_shift,
        },
    })
}
