//! `sixfold smooth`, `dual` and `triangulate`: change positions or faces without refinement.

use std::process::ExitCode;

use sixfold::algorithms::{Algorithms, AnyMesh, SmoothError};
use sixfold::io::WriteOptions;
use sixfold::operators::{DualError, Smoothing, SmoothingError};
use sixfold::repair::{Components, FaultKind, Step, diagnose, repair};
use sixfold::{Creases, PolygonMesh};

use crate::arguments::{Dual, MeshInOut, ReadPolygons, Smooth, Triangulate, repair_options};
use crate::failure::Failure;
use crate::mesh_files::shown;
use crate::output::is_stdout;
use crate::progress::Spinner;
use crate::seams::without_seams;
use crate::shape_check::{check_faces, check_shape};
use crate::text::{TextOutput, print_places, sanitize};
use sixfold_results::numbers::counted;

pub(crate) fn smooth(arguments: &Smooth) -> Result<ExitCode, Failure> {
    let smoothing = Smoothing {
        weights: arguments.weights,
        boundary: arguments.boundary,
        step: arguments.step,
        step_back: arguments.step_back,
        iterations: arguments.iterations,
    };
    let mut before = PolygonMesh::default();
    let after = reshape_file(
        &arguments.files,
        arguments.read,
        "smoothed",
        |polygons, creases| {
            let (mesh, files) = (&arguments.files.mesh, arguments.read.files);
            let (joined, creases) = without_seams(mesh, polygons, creases, files);
            before = joined;
            let mut mesh = build(&arguments.backend, &before)?;
            mesh.smooth(&smoothing).map_err(smoothing_failure)?;
            Ok((mesh.to_polygons(), creases))
        },
    )?;
    Ok(check_shape(
        &before,
        &after,
        &arguments.files.output,
        arguments.check,
    ))
}

pub(crate) fn make_dual(arguments: &Dual) -> Result<ExitCode, Failure> {
    let mut before = 0;
    let after = reshape_file(
        &arguments.files,
        arguments.read,
        "the dual",
        |polygons, creases| {
            before = polygons.face_count();
            arguments.files.note_lost(&creases);
            let (mesh, files) = (&arguments.files.mesh, arguments.read.files);
            let (polygons, _) = without_seams(mesh, polygons, Creases::default(), files);
            let mesh = build(&arguments.backend, &polygons)?;
            let dual = mesh
                .dual()
                .map_err(|error| dual_failure(error, &polygons))?;
            Ok((dual, Creases::default()))
        },
    )?;
    Ok(check_faces(before, &after, &arguments.files.output))
}

pub(crate) fn triangulate(arguments: &Triangulate) -> Result<ExitCode, Failure> {
    let read = ReadPolygons {
        triangulate: true,
        files: arguments.read,
    };
    let mut before = 0;
    let after = reshape_file(&arguments.files, read, "triangles", |triangles, creases| {
        before = triangles.face_count();
        let Some(facing) = arguments.orient else {
            return Ok((triangles, creases));
        };
        let orient = Step::Orient {
            facing,
            which: Components::All,
        };
        let repaired = repair(&triangles, &[orient]).map_err(Failure::unsupported)?;
        for report in &repaired.steps {
            let places = report.left.iter().map(ToString::to_string);
            print_places(
                &format!("{}: {}", shown(&arguments.files.mesh), report.step),
                places,
            );
        }
        let (creases, _) = repaired.carried_creases(&creases);
        Ok((repaired.polygons, creases))
    })?;
    Ok(check_faces(before, &after, &arguments.files.output))
}

/// Reads a mesh with its creases, changes both, and writes them. Returns the changed mesh.
fn reshape_file(
    files: &MeshInOut,
    read: ReadPolygons,
    what: &str,
    change: impl FnOnce(PolygonMesh, Creases) -> Result<(PolygonMesh, Creases), Failure>,
) -> Result<PolygonMesh, Failure> {
    let (polygons, creases, output) = files.open(read, |_| Ok(()))?;
    let faces = counted(polygons.face_count(), "face", "faces");
    let spinner = Spinner::start(format!("working on {faces}"));
    let changed = change(polygons, creases);
    spinner.clear();
    let (changed, creases) = changed?;
    output.write(&changed, &WriteOptions::default().with_creases(&creases))?;
    let to = &files.output;
    let mut text = TextOutput::new(!is_stdout(to));
    let place = sanitize(&to.display().to_string());
    let vertices = counted(changed.vertex_count(), "vertex", "vertices");
    let faces = counted(changed.face_count(), "face", "faces");
    text.print_list("", [format!("{place}: {what}, {vertices}, {faces}")]);
    text.finish()?;
    Ok(changed)
}

/// Builds the structure called `backend`.
fn build(backend: &str, polygons: &PolygonMesh) -> Result<Box<dyn AnyMesh>, Failure> {
    Algorithms::find(backend)
        .ok_or_else(|| Failure::no_backend(backend))?
        .build(polygons)
        .map_err(|refusal| {
            let refusal = format!("{backend} cannot hold the mesh: {refusal}");
            Failure::cannot_hold(backend, refusal)
        })
}

fn smoothing_failure(error: SmoothError) -> Failure {
    match error {
        SmoothError::Smoothing(SmoothingError::Step { .. } | SmoothingError::StepBack { .. }) => {
            Failure::usage(error)
        }
        _ => Failure::unsupported(error),
    }
}

fn dual_failure(error: DualError, polygons: &PolygonMesh) -> Failure {
    match error {
        DualError::BoundaryEdge { .. } => {
            let steps = diagnose(polygons, 0).repairs(FaultKind::BoundaryEdge);
            let closes = match repair_options(&steps) {
                none if none.is_empty() => String::new(),
                options => format!(
                    ". `sixfold repair {options}` closes a solid; a surface with a rim, such as a \
                     plane, stays open"
                ),
            };
            Failure::unsupported(format!("{error}{closes}"))
        }
        _ => Failure::unsupported(error),
    }
}
