//! The files of a command that reads one mesh and writes another.

use sixfold::PolygonMesh;

use crate::arguments::{MeshInOut, ReadPolygons};
use crate::failure::Failure;
use crate::load;
use crate::mesh_files::MeshOutput;
use crate::output::check_outputs;
use crate::progress::exit_on_interrupt;

impl MeshInOut {
    /// Reads the mesh, checks it, and opens the output, so that an unusable path gives an error
    /// before the work.
    pub(crate) fn open(
        &self,
        read: ReadPolygons,
        check: impl FnOnce(&PolygonMesh) -> Result<(), Failure>,
    ) -> Result<(PolygonMesh, MeshOutput), Failure> {
        check_outputs(Some(&self.mesh), &[("--output", Some(&self.output))])?;
        exit_on_interrupt();
        let (polygons, origin) = load::without_creases(&self.mesh, read)?;
        check(&polygons)?;
        let output = MeshOutput::open(&self.output, self.write, origin)?;
        Ok((polygons, output))
    }
}
