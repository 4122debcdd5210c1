//! The option `--limit`: moves the vertices to their limits for infinitely many levels.

use std::collections::BTreeMap;
use std::path::Path;

use sixfold::io::WriteOptions;
use sixfold::subdivision::{LimitPoint, NoLimit, Step, Subdivision};
use sixfold::{FaceVertexMesh, MeshQuery, Point, PolygonMesh, Representation};

use crate::failure::Failure;
use crate::mesh_files::MeshOutput;
use crate::text::sanitize;
use sixfold_results::numbers::counted;

/// A result with its vertices at their limit positions.
pub(super) struct Limits {
    moved: PolygonMesh,
    normals: Vec<Option<Point>>,
    /// For each reason, the number of vertices without a limit.
    undefined: BTreeMap<&'static str, usize>,
}

impl Limits {
    /// Computes the limit positions and normals of `step`. A vertex without a limit keeps its
    /// position.
    pub(super) fn new(
        subdivision: &Subdivision,
        step: &Step,
        levels: u32,
    ) -> Result<Self, Failure> {
        // A face-vertex mesh can hold every polygon mesh, and keeps the order of the elements.
        let mesh = FaceVertexMesh::from_polygons(&step.polygons).map_err(Failure::unsupported)?;
        let creases = match levels {
            0 => subdivision.control_creases(&mesh, &step.polygons, &step.creases),
            _ => Ok(step.creases.clone()),
        };
        let creases = creases.map_err(Failure::unsupported)?;
        let limits = subdivision
            .limit(&mesh, &creases)
            .map_err(Failure::unsupported)?;
        let mut positions = Vec::new();
        let mut normals = Vec::new();
        let mut undefined = BTreeMap::new();
        for v in mesh.vertices() {
            let limit = limits[v];
            positions.push(limit.position().unwrap_or_else(|| mesh.position(v)));
            normals.push(limit.normal());
            if let LimitPoint::Undefined(reason) = limit {
                *undefined.entry(reason_text(reason)).or_default() += 1;
            }
        }
        let faces = step.polygons.faces().clone();
        let moved = PolygonMesh::from_faces(positions, faces).map_err(Failure::usage)?;
        Ok(Self {
            moved,
            normals,
            undefined,
        })
    }

    /// Writes the limits.
    pub(super) fn write(&self, output: MeshOutput) -> Result<(), Failure> {
        output.write(
            &self.moved,
            &WriteOptions::default().with_normals(&self.normals),
        )?;
        Ok(())
    }

    /// Describes the limits in lines. `path` is the file of the limits.
    pub(super) fn describe(&self, path: &Path) -> Vec<String> {
        let place = sanitize(&path.display().to_string());
        let normals = self.normals.iter().flatten().count();
        let normals = counted(normals, "normal", "normals");
        let mut lines = vec![format!("{place}: limit positions, {normals}")];
        for (reason, &number) in &self.undefined {
            let vertices = counted(number, "vertex keeps", "vertices keep");
            lines.push(format!(
                "{place}: {vertices} the position of the last level, because {reason}"
            ));
        }
        lines
    }
}

fn reason_text(reason: NoLimit) -> &'static str {
    match reason {
        NoLimit::SemiSharp => "the sharpness at the vertex is not yet 0: increase --levels",
        NoLimit::NotAllQuads => "a face at the vertex is not a quad: increase --levels by 1",
        NoLimit::Dart => "a crease ends at the vertex, and the rules have no limit for this case",
        _ => "the rules have no limit at the vertex",
    }
}
