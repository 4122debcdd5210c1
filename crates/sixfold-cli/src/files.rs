//! The files of a command that reads one mesh and writes another.

use sixfold::{Creases, PolygonMesh};

use crate::arguments::{MeshInOut, ReadPolygons};
use crate::failure::Failure;
use crate::load;
use crate::mesh_files::{MeshOutput, shown};
use crate::output::check_outputs;
use crate::progress::exit_on_interrupt;
use crate::text::print_notice;

impl MeshInOut {
    /// Reads the mesh, checks it, and opens the output, so that an unusable path gives an error
    /// before the work.
    pub(crate) fn open(
        &self,
        read: ReadPolygons,
        check: impl FnOnce(&PolygonMesh) -> Result<(), Failure>,
    ) -> Result<(PolygonMesh, Creases, MeshOutput), Failure> {
        check_outputs(Some(&self.mesh), &[("--output", Some(&self.output))])?;
        exit_on_interrupt();
        let (polygons, creases, origin) = load::with_creases(&self.mesh, read)?;
        check(&polygons)?;
        let output = MeshOutput::open(&self.output, self.write, origin)?;
        Ok((polygons, creases, output))
    }

    /// Prints a note if the mesh has creases, and the command makes other edges.
    pub(crate) fn note_lost(&self, creases: &Creases) {
        if !creases.is_empty() {
            let file = shown(&self.mesh);
            print_notice(&format!(
                "note: {file}: the result does not keep sharp edges and vertices"
            ));
        }
    }
}
