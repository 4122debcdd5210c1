//! `sixfold convert`: writes a mesh in another format.

use std::process::ExitCode;

use sixfold::io::{Loss, WriteOptions};

use crate::arguments::Convert;
use crate::failure::Failure;
use crate::load::{self, ReadMesh};
use crate::mesh_files::{MeshOutput, shown};
use crate::output::{check_outputs, is_stdout};
use crate::progress::exit_on_interrupt;
use crate::shape_check::check_faces;
use crate::text::{TextOutput, sanitize};

pub(crate) fn run(arguments: &Convert) -> Result<ExitCode, Failure> {
    let (from, to) = (&arguments.files.mesh, &arguments.files.output);
    check_outputs(Some(from), &[("--output", Some(to))])?;
    exit_on_interrupt();
    let ReadMesh {
        polygons,
        creases,
        origin,
        places,
        left_out,
        ..
    } = load::for_repair(from, arguments.read)?;
    let output = MeshOutput::open(to, arguments.files.write, origin)?;
    let format = output.format;
    let options = WriteOptions::default().with_creases(&creases);
    let place = |face| {
        let place = places.place(face, &polygons);
        format!("face {face}, from {place} of {}", shown(from))
    };
    let losses = output.write_placed(&polygons, &options, place)?;
    let mut text = TextOutput::new(!is_stdout(to));
    let place = sanitize(&to.display().to_string());
    text.print_line(&format!("{place}: {polygons}, as {format}"));
    text.finish()?;
    // A file of points is converted to points, if the format can hold them.
    let loses = |loss: &Loss| matches!(loss, Loss::IsolatedVertices(_));
    let is_of_points =
        left_out.is_empty() && polygons.vertex_count() > 0 && !losses.iter().any(loses);
    match is_of_points {
        true => Ok(ExitCode::SUCCESS),
        false => Ok(check_faces(left_out.len(), &polygons, to)),
    }
}
