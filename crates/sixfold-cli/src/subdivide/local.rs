//! `--select`: only some triangles are refined.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use sixfold::mesh_io::write_obj;
use sixfold::subdivision::{LocalError, LocalMesh, Scheme, Selection, refine_locally};
use sixfold::{FaceId, Point, PolygonMesh, Representation, Visitor, visit};

use crate::arguments::{Select, Subdivide};
use crate::failure::Failure;
use crate::load;
use crate::numbers::counted;
use crate::output::{Output, is_stdout};
use crate::text::{Text, tame};

/// Refines the chosen triangles and writes the mesh.
pub(super) fn run(arguments: &Subdivide, select: &Select) -> Result<ExitCode, Failure> {
    check(arguments)?;
    let specimen = load::specimen(&arguments.mesh)?;
    let selection = selection(select)?;
    let output = Output::open(&arguments.output)?;
    let mut work = Locally {
        polygons: &specimen.polygons,
        selection: &selection,
        levels: arguments.levels,
    };
    let refined = visit(&arguments.backend, &mut work);
    let refined = refined
        .ok_or_else(|| Failure::usage(format!("no backend is called `{}`", arguments.backend)))?
        .map_err(|error| match error {
            LocalError::MissingFace { .. } => Failure::usage(error),
            _ => Failure::unsupported(error),
        })?;
    let mesh = refined.polygons();
    output.finish(|writer| write_obj(mesh, writer))?;
    let mut text = Text::shown(!is_stdout(&arguments.output));
    let place = tame(&arguments.output.display().to_string());
    let vertices = counted(mesh.vertex_count(), "vertex", "vertices");
    let faces = counted(mesh.face_count(), "face", "faces");
    let all = mesh.faces().iter();
    let green = all.filter(|&(f, _)| refined.is_green(f)).count();
    text.say(&format!(
        "{place}: {vertices}, {faces}, of which {green} are halves; refined on {}",
        arguments.backend
    ));
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// New points of a part of a mesh are midpoints; nothing else has been asked for.
fn check(arguments: &Subdivide) -> Result<(), Failure> {
    let Subdivide { scheme, .. } = arguments;
    if *scheme != Scheme::Midpoint {
        return Err(Failure::unsupported(format!(
            "{scheme} has no rule for a part of a mesh: choose --scheme midpoint with --select"
        )));
    }
    let others = [
        ("--method", arguments.method.is_some()),
        ("--creases", arguments.creases.is_some()),
        ("--boundary", arguments.boundary.is_some()),
        ("--creasing", arguments.creasing.is_some()),
        ("--limit", arguments.limit.is_some()),
        ("--creases-left", arguments.creases_left.is_some()),
    ];
    match others.into_iter().find(|&(_, asked)| asked) {
        Some((option, _)) => Err(Failure::unsupported(format!(
            "{option} has no meaning beside --select, which puts midpoints in: leave it out"
        ))),
        None => Ok(()),
    }
}

fn selection(select: &Select) -> Result<Selection, Failure> {
    Ok(match select {
        Select::Faces(path) => Selection::Faces(listed(path)?),
        Select::Box(min, max) => Selection::Box {
            min: Point::from_array(*min),
            max: Point::from_array(*max),
        },
        Select::Angle(degrees) => Selection::Angle(*degrees),
    })
}

/// The faces that a file lists: numbers from 0 between blanks, `#` begins a comment.
fn listed(path: &Path) -> Result<Vec<FaceId>, Failure> {
    let shown = path.display();
    let text = fs::read_to_string(path)
        .map_err(|cause| Failure::usage(format!("{shown}: cannot be read ({cause})")))?;
    let mut faces = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let said = line.split('#').next().unwrap_or_default();
        for word in said.split_whitespace() {
            let face: u32 = word.parse().map_err(|_| {
                Failure::usage(format!(
                    "{shown}:{number}: `{word}` is no face: write numbers from 0, one or more a line"
                ))
            })?;
            faces.push(FaceId::new(face));
        }
    }
    Ok(faces)
}

/// Local refinement with a structure that is chosen at run time.
struct Locally<'a> {
    polygons: &'a PolygonMesh,
    selection: &'a Selection,
    levels: u32,
}

impl Visitor for Locally<'_> {
    type Output = Result<LocalMesh, LocalError>;

    fn visit<M: Representation + 'static>(&mut self) -> Self::Output {
        refine_locally::<M>(self.polygons, self.selection, self.levels)
    }
}
