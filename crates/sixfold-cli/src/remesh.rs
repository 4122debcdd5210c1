//! `sixfold decimate` and `remesh`: changes the triangles of a surface by local edits.

use std::ops::ControlFlow;
use std::process::ExitCode;

use sixfold::algorithms::{Algorithms, AnyEditableMesh};
use sixfold::io::WriteOptions;
use sixfold::remeshing::{Decimation, DecimationBoundary, RemeshError, Remeshing, Stop, Target};
use sixfold::repair::measures;
use sixfold::spatial::{DistanceError, Sampling, mesh_distance};
use sixfold::{Creases, Edit, Facts, PolygonMesh, QueryCost, StructureInfo, structure_infos};

use crate::arguments::{Decimate, MeshInOut, ReadPolygons, Remesh, ShapeCheck};
use crate::failure::Failure;
use crate::mesh_files::shown;
use crate::output::is_stdout;
use crate::progress::StepBar;
use crate::seams::without_seams;
use crate::shape_check::check_shape;
use crate::text::{TextOutput, figure, print_notice, sanitize};
use sixfold_results::numbers::{counted, grouped};

/// Minimum number of faces for a note about a structure that scans.
const MIN_WARNED_FACES: usize = 1000;

pub(crate) fn decimate(arguments: &Decimate) -> Result<ExitCode, Failure> {
    let decimation = Decimation {
        target: arguments.goal.target(),
        boundary: arguments.boundary,
        max_distance: arguments.goal.max_error,
    };
    let edit = |before: &PolygonMesh| match arguments.goal.max_error {
        Some(limit) => within(limit, before, &arguments.backend, decimation),
        None => edited_by(&arguments.backend, before, &decimation),
    };
    let (backend, files) = (&arguments.backend, &arguments.files);
    edit_file(backend, files, arguments.read, arguments.check, edit)
}

/// The largest number of decimations until the measured distance is small enough.
const ATTEMPTS: usize = 4;

/// Decimates the mesh until the measured distance of the result is at most `limit`, or says that the last
/// of [`ATTEMPTS`] results is farther away. The decimation itself checks the distance only at some points;
/// if more points show a larger distance, it is repeated with a smaller limit.
fn within(limit: f64, before: &PolygonMesh, backend: &str, mut decimation: Decimation) -> Edited {
    let mut attempt = 1;
    loop {
        let (polygons, mut summary) = edited_by(backend, before, &decimation)?;
        let measured = mesh_distance(before, &polygons, Sampling::default());
        let largest = match measured {
            Ok(distance) => distance.largest(),
            Err(DistanceError::NoFaces { .. }) => return Ok((polygons, summary)),
            Err(error) => return Err(Failure::unsupported(error)),
        };
        summary.edits += &format!(" (largest distance {})", figure(largest));
        if largest <= limit {
            return Ok((polygons, summary));
        }
        if attempt == ATTEMPTS {
            summary.shortfall = Some(format!(
                "the distance is {} instead of at most {}",
                figure(largest),
                figure(limit)
            ));
            return Ok((polygons, summary));
        }
        attempt += 1;
        let smaller = decimation.max_distance.unwrap_or(limit) * 0.9 * limit / largest;
        decimation.max_distance = Some(smaller);
    }
}

pub(crate) fn remesh(arguments: &Remesh) -> Result<ExitCode, Failure> {
    let remeshing = |polygons: &PolygonMesh| {
        let mean = || measures(polygons).edge_lengths.map(|lengths| lengths.mean);
        let edge_length = arguments.edge_length.or_else(mean);
        let edge_length = edge_length.ok_or_else(|| {
            let file = shown(&arguments.files.mesh);
            Failure::usage(format!("{file}: there are no edges to remesh"))
        })?;
        Ok(Remeshing {
            edge_length,
            iterations: arguments.iterations,
            max_faces: arguments.max_faces,
        })
    };
    let edit = |before: &PolygonMesh| edited_by(&arguments.backend, before, &remeshing(before)?);
    let (backend, files) = (&arguments.backend, &arguments.files);
    edit_file(backend, files, arguments.read, arguments.check, edit)
}

/// Edits a mesh with `edit`, which uses `backend`.
fn edit_file(
    backend: &str,
    files: &MeshInOut,
    read: ReadPolygons,
    check: ShapeCheck,
    edit: impl FnOnce(&PolygonMesh) -> Edited,
) -> Result<ExitCode, Failure> {
    // Check here, because the error of a structure would not name the command that helps.
    let (before, creases, output) = files.open(read, check_triangles)?;
    files.note_lost(&creases);
    let (before, _) = without_seams(&files.mesh, before, Creases::default(), read.files);
    let (polygons, EditSummary { edits, shortfall }) = edit(&before)?;
    output.write(&polygons, &WriteOptions::default())?;
    let to = &files.output;
    if let Some(shortfall) = shortfall {
        print_notice(&format!("note: {}: {shortfall}", to.display()));
    }
    if let Some(note) = non_manifold_note(backend, [&before, &polygons]) {
        print_notice(&format!("note: {}: {note}", to.display()));
    }
    let mut text = TextOutput::new(!is_stdout(to));
    let place = sanitize(&to.display().to_string());
    let vertices = counted(polygons.vertex_count(), "vertex", "vertices");
    let faces = counted(polygons.face_count(), "face", "faces");
    text.print_list("", [format!("{place}: {vertices}, {faces}; {edits}")]);
    text.finish()?;
    Ok(check_shape(&before, &polygons, to, check))
}

/// Returns what became of the edges and vertices that are not manifold, if the mesh has such. `backend`
/// holds the meshes before and after the edits.
fn non_manifold_note(backend: &str, [before, after]: [&PolygonMesh; 2]) -> Option<String> {
    let infos = structure_infos();
    let info = infos.iter().find(|info| info.name == backend)?;
    if !info.capabilities.non_manifold_vertices {
        return None;
    }
    let [before, after] = [before, after].map(Facts::from_polygons);
    let (kind, from, to) = match before.non_manifold_edges + after.non_manifold_edges {
        0 => (
            "vertices where parts of the surface only touch",
            before.non_manifold_vertices,
            after.non_manifold_vertices,
        ),
        _ => (
            "edges with three or more faces",
            before.non_manifold_edges,
            after.non_manifold_edges,
        ),
    };
    let [shown_from, shown_to] = [from, to].map(grouped);
    let is_any = from + to > 0;
    is_any.then(|| format!("not a manifold: {kind}: {shown_from} before, {shown_to} after"))
}

/// Explains that `backend` has no edits, and lists the backends with edits.
fn not_editable(backend: &str) -> String {
    let infos = structure_infos().into_iter();
    let editable = infos.filter(|info| info.is_editable());
    let names: Vec<&str> = editable.map(|info| info.name).collect();
    format!(
        "{backend} cannot be edited: choose one of {}",
        names.join(", ")
    )
}

/// Returns an error for the first face that is not a triangle.
fn check_triangles(polygons: &PolygonMesh) -> Result<(), Failure> {
    match polygons.first_polygon() {
        Some((face, degree)) => Err(remesh_failure(RemeshError::NotATriangle { face, degree })),
        None => Ok(()),
    }
}

/// Converts an error and adds the command or the option that helps.
fn remesh_failure(error: RemeshError) -> Failure {
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
                "edges of length {length:?} need {faces} triangles, but only {} are allowed: increase --edge-length or --max-faces",
                grouped(limit)
            ))
        }
        _ => Failure::usage(error),
    }
}

/// Prints a note if edits on the structure scan all faces and the mesh is large.
fn warn_of_scans(backend: &str, faces: usize) {
    let scans = |edits: &[Option<QueryCost>]| {
        [Edit::CollapseEdge, Edit::BisectEdge, Edit::FlipEdge]
            .iter()
            .any(|&edit| edits[edit as usize] == Some(QueryCost::Scan))
    };
    let infos = structure_infos();
    let is_slow = |info: &StructureInfo| info.name == backend && scans(&info.edits);
    if faces < MIN_WARNED_FACES || !infos.iter().any(is_slow) {
        return;
    }
    let others = infos
        .into_iter()
        .filter(|info| info.is_editable() && !scans(&info.edits));
    let others: Vec<&str> = others.map(|info| info.name).collect();
    print_notice(&format!(
        "note: {backend} scans all {} faces for each edit, so this command is slow. Faster choices for \
         --backend: {}",
        grouped(faces),
        others.join(", ")
    ));
}

trait Work {
    fn run(
        &self,
        mesh: &mut dyn AnyEditableMesh,
        backend: &str,
    ) -> Result<EditSummary, RemeshError>;
}

struct EditSummary {
    edits: String,
    /// Why the target was not reached.
    shortfall: Option<String>,
}

impl Work for Decimation {
    fn run(
        &self,
        mesh: &mut dyn AnyEditableMesh,
        backend: &str,
    ) -> Result<EditSummary, RemeshError> {
        let before = mesh.face_count();
        let target = self.target.face_count(before)?;
        let bar = StepBar::new(before.saturating_sub(target), "faces removed");
        let report = mesh.decimate(self, &mut |faces| {
            bar.set_done(before.saturating_sub(faces));
            ControlFlow::Continue(())
        });
        bar.clear();
        let report = report?;
        // Without a target, the distance ends the decimation.
        let has_target = self.max_distance.is_none() || self.target != Target::Faces(0);
        let shortfall = (report.stop != Stop::Done && has_target).then(|| {
            let fixed = match self.boundary {
                DecimationBoundary::Fixed => "move the boundary, ",
                DecimationBoundary::Follow => "",
            };
            let far = match self.max_distance {
                Some(_) => "exceed the distance, ",
                None => "",
            };
            format!(
                "the target of {} was not reached, because any further collapse would \
                 {far}{fixed}flip a face or change the topology",
                counted(target, "face", "faces")
            )
        });
        let edits = counted(report.collapses, "edge", "edges");
        Ok(EditSummary {
            edits: format!("{edits} collapsed on {backend}"),
            shortfall,
        })
    }
}

impl Work for Remeshing {
    fn run(
        &self,
        mesh: &mut dyn AnyEditableMesh,
        backend: &str,
    ) -> Result<EditSummary, RemeshError> {
        let bar = StepBar::new(self.iterations, "iterations");
        let report = mesh.remesh(self, &mut |done| {
            bar.set_done(done);
            ControlFlow::Continue(())
        });
        bar.clear();
        let report = report?;
        let iterations = counted(report.iterations, "iteration", "iterations");
        let shortfall = (report.stop != Stop::Done).then(|| {
            format!(
                "stopped after {iterations}, because --max-faces {} allows no more splits. Some \
                 edges are longer than --edge-length. For shorter edges, increase --max-faces",
                self.max_faces
            )
        });
        let splits = counted(report.splits, "split", "splits");
        let collapses = counted(report.collapses, "collapse", "collapses");
        let flips = counted(report.flips, "flip", "flips");
        Ok(EditSummary {
            edits: format!(
                "edge length {}: {splits}, {collapses} and {flips} in {iterations} on {backend}",
                figure(self.edge_length)
            ),
            shortfall,
        })
    }
}

/// Does the work on the structure called `backend`.
fn edited_by(backend: &str, polygons: &PolygonMesh, work: &impl Work) -> Edited {
    let mesh = Algorithms::find(backend)
        .ok_or_else(|| Failure::no_backend(backend))?
        .build_editable(polygons);
    let mesh = mesh.ok_or_else(|| Failure::unsupported(not_editable(backend)))?;
    let mut mesh = mesh.map_err(|refusal| {
        let refusal = format!("{backend} cannot hold the mesh: {refusal}");
        Failure::cannot_hold(backend, refusal)
    })?;
    warn_of_scans(backend, polygons.face_count());
    let summary = work.run(&mut *mesh, backend).map_err(remesh_failure)?;
    Ok((mesh.to_polygons(), summary))
}

type Edited = Result<(PolygonMesh, EditSummary), Failure>;
