//! `sixfold convert`: writes a mesh in another format.

use std::process::ExitCode;

use sixfold::io::{Loss, WriteOptions};

use crate::arguments::Convert;
use crate::failure::Failure;
use crate::load::{self, ReadMesh};
use crate::mesh_files::{MeshOutput, shown};
use crate::output::{check_outputs, is_stdout};
use crate::progress::exit_on_interrupt;
use crate::text::{TextOutput, sanitize};
use crate::triangulate::cut_polygons;

pub(crate) fn run(arguments: &Convert) -> Result<ExitCode, Failure> {
    let (from, to) = (&arguments.files.mesh, &arguments.files.output);
    check_outputs(Some(from), &[("--output", Some(to))])?;
    exit_on_interrupt();
    let ReadMesh {
        polygons,
        creases,
        origin,
        places,
        ..
    } = load::for_repair(from, arguments.read)?;
    let output = MeshOutput::open(to, arguments.files.write, origin)?;
    let format = output.format;
    let options = WriteOptions::default().with_creases(&creases);
    let losses = output.write(&polygons, &options)?;
    if losses
        .iter()
        .any(|loss| matches!(loss, Loss::CrossingPolygons { .. }))
    {
        // Prints where the polygons are in the file.
        cut_polygons(&shown(from), &polygons, Some(&places))?;
    }
    let mut text = TextOutput::new(!is_stdout(to));
    let place = sanitize(&to.display().to_string());
    text.print_line(&format!("{place}: {polygons}, as {format}"));
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}
