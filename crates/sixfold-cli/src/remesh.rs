//! `sixfold decimate` and `remesh`: other triangles for the same surface, edit by edit.

use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;

use sixfold::mesh_io::write_obj;
use sixfold::remeshing::{
    Boundary, Decimation, RemeshError, Remeshing, Stop, decimate_watched, remesh_watched,
};
use sixfold::{
    Edit, EditVisitor, MeshEdit, PolygonMesh, QueryCost, Representation, roster, visit_editable,
};

use crate::arguments::{Decimate, Remesh};
use crate::failure::Failure;
use crate::load;
use crate::output::{Output, check_places, is_stdout};
use crate::progress::{Steps, end_on_interrupt};
use crate::text::{Text, complain, tame};
use ::study::numbers::{counted, grouped};

/// From so many faces on it is said why a structure that scans takes long.
const LONG_SCAN: usize = 1000;

/// Decimates the mesh and writes it.
pub(crate) fn decimate(arguments: &Decimate) -> Result<ExitCode, Failure> {
    let decimation = Decimation {
        target: arguments.goal.target(),
        boundary: arguments.boundary,
    };
    let place = [arguments.mesh.as_path(), &arguments.output];
    edited(place, &arguments.backend, &decimation)
}

/// Remeshes the mesh and writes it.
pub(crate) fn remesh(arguments: &Remesh) -> Result<ExitCode, Failure> {
    let remeshing = Remeshing {
        edge_length: arguments.edge_length,
        iterations: arguments.iterations,
        most_faces: arguments.max_faces,
    };
    let place = [arguments.mesh.as_path(), &arguments.output];
    edited(place, &arguments.backend, &remeshing)
}

/// Reads a mesh, has it edited on `backend`, and writes what comes of it.
fn edited([from, to]: [&Path; 2], backend: &str, work: &impl Work) -> Result<ExitCode, Failure> {
    check_places(Some(from), &[("--output", Some(&to.to_owned()))])?;
    end_on_interrupt();
    let polygons = load::without_creases(from)?;
    // Before a structure of triangles alone says it in its own words.
    check_triangles(&polygons)?;
    // Opened before the work, so that nobody waits for a failure.
    let output = Output::open(to)?;
    let mut on = On {
        polygons: &polygons,
        work,
    };
    let done = visit_editable(backend, &mut on);
    let (polygons, Told { edits, short }) =
        done.ok_or_else(|| Failure::usage(format!("no backend is called `{backend}`")))??;
    output.finish(|writer| write_obj(&polygons, writer))?;
    if let Some(short) = short {
        complain(&format!("note: {}: {short}", to.display()));
    }
    let mut text = Text::shown(!is_stdout(to));
    let place = tame(&to.display().to_string());
    let vertices = counted(polygons.vertex_count(), "vertex", "vertices");
    let faces = counted(polygons.face_count(), "face", "faces");
    text.say(&format!(
        "{place}: {vertices}, {faces}; {edits} on {backend}"
    ));
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Refuses the first face that is no triangle.
fn check_triangles(polygons: &PolygonMesh) -> Result<(), Failure> {
    match polygons.first_polygon() {
        Some((face, degree)) => Err(refused(RemeshError::NotATriangle { face, degree })),
        None => Ok(()),
    }
}

/// A refusal, with the command or the option that helps.
fn refused(error: RemeshError) -> Failure {
    match error {
        RemeshError::NotATriangle { .. } => {
            Failure::unsupported(format!("{error}, with `sixfold triangulate`"))
        }
        RemeshError::TooFine {
            length,
            faces,
            limit,
        } => {
            let faces = match faces {
                few if few < 1e15 => format!("about {}", grouped(few as usize)),
                many if many.is_finite() => format!("about {many:.0e}"),
                _ => "more than 1e308".to_owned(),
            };
            Failure::unsupported(format!(
                "edges of {length:?} would take {faces} triangles, and {} are allowed: choose a greater --edge-length, or allow more with --max-faces",
                grouped(limit)
            ))
        }
        _ => Failure::usage(error),
    }
}

/// Says beforehand that a structure without a table for what an edit needs takes its time.
fn tell_of_scans<M: MeshEdit + Representation>(faces: usize) {
    let scans = |edits: &[Option<QueryCost>]| {
        [Edit::CollapseEdge, Edit::BisectEdge, Edit::FlipEdge]
            .iter()
            .any(|&edit| edits[edit as usize] == Some(QueryCost::Scan))
    };
    if faces < LONG_SCAN || !scans(&M::EDITS) {
        return;
    }
    let backends = roster();
    let others = backends.iter().filter(|backend| !scans(&backend.edits));
    let others: Vec<&str> = others.map(|backend| backend.name).collect();
    complain(&format!(
        "note: {} looks through all {} faces again and again for each edit, and that takes long: {} look around the edge alone",
        M::NAME,
        grouped(faces),
        others.join(", ")
    ));
}

/// Edits that are done with a structure.
trait Work {
    /// Does them; what there is to say of it.
    fn done<M: MeshEdit + Representation>(&self, mesh: &mut M) -> Result<Told, RemeshError>;
}

/// What was done, in words.
struct Told {
    edits: String,
    /// Why it is not all that was asked for.
    short: Option<String>,
}

impl Work for Decimation {
    fn done<M: MeshEdit + Representation>(&self, mesh: &mut M) -> Result<Told, RemeshError> {
        let before = mesh.face_count();
        let target = self.target.of(before)?;
        let bar = Steps::of(before.saturating_sub(target), "faces taken away");
        let report = decimate_watched(mesh, self, &mut |faces| {
            bar.reached(before.saturating_sub(faces));
            ControlFlow::Continue(())
        });
        bar.clear();
        let report = report?;
        let short = (report.stop != Stop::Done).then(|| {
            let fixed = match self.boundary {
                Boundary::Fixed => "move the boundary, ",
                Boundary::Follow => "",
            };
            format!(
                "the target of {} was not reached: any other collapse would {fixed}turn a face over, or change what is connected",
                counted(target, "face", "faces")
            )
        });
        let edits = counted(report.collapses, "edge", "edges");
        Ok(Told {
            edits: format!("{edits} collapsed"),
            short,
        })
    }
}

impl Work for Remeshing {
    fn done<M: MeshEdit + Representation>(&self, mesh: &mut M) -> Result<Told, RemeshError> {
        let bar = Steps::of(self.iterations, "iterations");
        let report = remesh_watched(mesh, self, &mut |done| {
            bar.reached(done);
            ControlFlow::Continue(())
        });
        bar.clear();
        let report = report?;
        let iterations = counted(report.iterations, "iteration", "iterations");
        let short = (report.stop != Stop::Done).then(|| {
            format!(
                "ended after {iterations}: --max-faces {} left no room to split, so that edges are longer than asked for",
                self.most_faces
            )
        });
        let splits = counted(report.splits, "split", "splits");
        let collapses = counted(report.collapses, "collapse", "collapses");
        let flips = counted(report.flips, "flip", "flips");
        Ok(Told {
            edits: format!("{splits}, {collapses} and {flips} in {iterations}"),
            short,
        })
    }
}

/// Work to be done with a structure that is chosen at run time.
struct On<'a, W> {
    polygons: &'a PolygonMesh,
    work: &'a W,
}

impl<W: Work> EditVisitor for On<'_, W> {
    type Output = Result<(PolygonMesh, Told), Failure>;

    fn visit<M: Representation + MeshEdit + 'static>(&mut self) -> Self::Output {
        let mesh = M::from_polygons(self.polygons);
        let mut mesh = mesh.map_err(|refusal| {
            Failure::not_held(format!("{} cannot hold the mesh: {refusal}", M::NAME))
        })?;
        tell_of_scans::<M>(self.polygons.face_count());
        let told = self.work.done(&mut mesh).map_err(refused)?;
        Ok((mesh.to_polygons(), told))
    }
}
