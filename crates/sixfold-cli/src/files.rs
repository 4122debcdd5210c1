//! The files of a command that reads one mesh and writes another.

use std::path::Path;

use sixfold::PolygonMesh;

use crate::arguments::{ReadPolygons, WriteFiles};
use crate::failure::Failure;
use crate::load;
use crate::mesh_files::MeshOutput;
use crate::output::check_outputs;
use crate::progress::exit_on_interrupt;

#[derive(Clone, Copy)]
pub(crate) struct Files<'a> {
    pub(crate) from: &'a Path,
    pub(crate) to: &'a Path,
    pub(crate) read: ReadPolygons,
    pub(crate) write: WriteFiles,
}

impl Files<'_> {
    /// Reads the mesh, checks it, and opens the output, so that an unusable path gives an error
    /// before the work.
    pub(crate) fn open(
        &self,
        check: impl FnOnce(&PolygonMesh) -> Result<(), Failure>,
    ) -> Result<(PolygonMesh, MeshOutput), Failure> {
        let Self {
            from,
            to,
            read,
            write,
        } = *self;
        check_outputs(Some(from), &[("--output", Some(&to.to_owned()))])?;
        exit_on_interrupt();
        let polygons = load::without_creases(from, read)?;
        check(&polygons)?;
        Ok((polygons, MeshOutput::open(to, write)?))
    }
}
