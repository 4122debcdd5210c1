//! `sixfold smooth`, `dual` and `triangulate`: changes positions or faces without refinement.

use std::path::Path;
use std::process::ExitCode;

use sixfold::io::write_obj;
use sixfold::operators::{Smoothing, SmoothingError, dual, oriented, smoothed, triangulated};
use sixfold::{PolygonMesh, Representation, Visitor, visit};

use crate::arguments::{Dual, Smooth, Triangulate};
use crate::failure::Failure;
use crate::load;
use crate::output::{Output, check_places, is_stdout};
use crate::progress::{Waiting, end_on_interrupt};
use crate::text::{Text, tame};
use sixfold_study::numbers::counted;

/// Smooths the mesh and writes it.
pub(crate) fn smooth(arguments: &Smooth) -> Result<ExitCode, Failure> {
    let work = Smoothed(Smoothing {
        weights: arguments.weights,
        boundary: arguments.boundary,
        step: arguments.step,
        step_back: arguments.step_back,
        iterations: arguments.iterations,
    });
    let place = [arguments.mesh.as_path(), &arguments.output];
    reshaped(place, "smoothed", |polygons| {
        on_backend(&arguments.backend, polygons, &work)
    })
}

/// Builds the dual and writes it.
pub(crate) fn make_dual(arguments: &Dual) -> Result<ExitCode, Failure> {
    let place = [arguments.mesh.as_path(), &arguments.output];
    reshaped(place, "the dual", |polygons| {
        on_backend(&arguments.backend, polygons, &Dualised)
    })
}

/// Cuts all polygons and writes the triangles.
pub(crate) fn triangulate(arguments: &Triangulate) -> Result<ExitCode, Failure> {
    let place = [arguments.mesh.as_path(), &arguments.output];
    reshaped(place, "triangles", |polygons| {
        let turned = match arguments.orient {
            Some(facing) => {
                oriented(polygons, facing)
                    .map_err(Failure::unsupported)?
                    .polygons
            }
            None => polygons.clone(),
        };
        triangulated(&turned, arguments.method).map_err(Failure::unsupported)
    })
}

/// Reads a mesh, applies `change`, and writes the result.
fn reshaped(
    [from, to]: [&Path; 2],
    what: &str,
    change: impl FnOnce(&PolygonMesh) -> Result<PolygonMesh, Failure>,
) -> Result<ExitCode, Failure> {
    check_places(Some(from), &[("--output", Some(&to.to_owned()))])?;
    end_on_interrupt();
    let polygons = load::without_creases(from)?;
    // Opened before the work, so that a wrong place fails at once.
    let output = Output::open(to)?;
    let faces = counted(polygons.face_count(), "face", "faces");
    let waiting = Waiting::shown(format!("working on {faces}"));
    let changed = change(&polygons);
    waiting.clear();
    let changed = changed?;
    output.finish(|writer| write_obj(&changed, writer))?;
    let mut text = Text::shown(!is_stdout(to));
    let place = tame(&to.display().to_string());
    let vertices = counted(changed.vertex_count(), "vertex", "vertices");
    let faces = counted(changed.face_count(), "face", "faces");
    text.say(&format!("{place}: {what}, {vertices}, {faces}"));
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Work on a structure.
trait Work {
    fn done<M: Representation>(&self, mesh: M) -> Result<PolygonMesh, Failure>;
}

struct Smoothed(Smoothing);

impl Work for Smoothed {
    fn done<M: Representation>(&self, mut mesh: M) -> Result<PolygonMesh, Failure> {
        let positions = smoothed(&mesh, &self.0).map_err(|error| match error {
            SmoothingError::Step { .. } | SmoothingError::StepBack { .. } => Failure::usage(error),
            _ => Failure::unsupported(error),
        })?;
        mesh.set_positions(&positions)
            .map_err(Failure::unsupported)?;
        Ok(mesh.to_polygons())
    }
}

struct Dualised;

impl Work for Dualised {
    fn done<M: Representation>(&self, mesh: M) -> Result<PolygonMesh, Failure> {
        dual(&mesh).map_err(Failure::unsupported)
    }
}

/// Does `work` on the structure with the name `backend`.
fn on_backend(
    backend: &str,
    polygons: &PolygonMesh,
    work: &impl Work,
) -> Result<PolygonMesh, Failure> {
    struct On<'a, W>(&'a PolygonMesh, &'a W);

    impl<W: Work> Visitor for On<'_, W> {
        type Output = Result<PolygonMesh, Failure>;

        fn visit<M: Representation + 'static>(&mut self) -> Self::Output {
            let mesh = M::from_polygons(self.0);
            let mesh = mesh.map_err(|refusal| {
                Failure::not_held(format!("{} cannot hold the mesh: {refusal}", M::NAME))
            })?;
            self.1.done(mesh)
        }
    }

    match visit(backend, &mut On(polygons, work)) {
        Some(done) => done,
        None => Err(Failure::usage(format!("no backend is called `{backend}`"))),
    }
}
