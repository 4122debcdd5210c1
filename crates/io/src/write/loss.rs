//! What a format cannot keep.

use std::fmt;

use super::MeshWriter;
use crate::format::Format;

/// Something of a mesh that a format cannot keep; printed as `1 polygon is cut into triangles`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Loss {
    /// Which faces share a vertex. A reader can join equal positions, but then vertices that were
    /// different become one, and their numbers change.
    SharedVertices,
    /// This many faces with more than three corners, which are cut into triangles.
    Polygons(usize),
    /// This many vertices without a face.
    IsolatedVertices(usize),
    /// The normals of this many vertices.
    Normals(usize),
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SharedVertices => {
                f.write_str("vertices are not shared: a reader has to join equal positions")
            }
            Self::Polygons(1) => f.write_str("1 polygon is cut into triangles"),
            Self::Polygons(count) => write!(f, "{count} polygons are cut into triangles"),
            Self::IsolatedVertices(1) => f.write_str("1 vertex without a face is left out"),
            Self::IsolatedVertices(count) => {
                write!(f, "{count} vertices without a face are left out")
            }
            Self::Normals(1) => f.write_str("1 normal is left out"),
            Self::Normals(count) => write!(f, "{count} normals are left out"),
        }
    }
}

impl MeshWriter<'_> {
    /// Returns what `format` cannot keep of this mesh; O(corners).
    pub fn losses(&self, format: Format) -> Vec<Loss> {
        let mut losses = Vec::new();
        let is_stl = format.is_stl();
        if is_stl {
            losses.push(Loss::SharedVertices);
        }
        if is_stl || matches!(format, Format::Gltf | Format::Glb) {
            let faces = self.polygons.faces().iter();
            losses.push(Loss::Polygons(
                faces.filter(|(_, face)| face.len() > 3).count(),
            ));
        }
        if is_stl {
            let mut used = vec![false; self.polygons.vertex_count()];
            for v in self.polygons.faces().corners() {
                used[v.index()] = true;
            }
            losses.push(Loss::IsolatedVertices(
                used.iter().filter(|used| !**used).count(),
            ));
        }
        let normals = self.normals.iter().flatten().count();
        let keeps_normals = match format {
            Format::Obj => true,
            Format::Stl | Format::StlAscii | Format::Off => false,
            _ => normals == self.normals.len(),
        };
        if !keeps_normals {
            losses.push(Loss::Normals(normals));
        }
        let is_empty = |loss: &Loss| {
            matches!(
                loss,
                Loss::Polygons(0) | Loss::IsolatedVertices(0) | Loss::Normals(0)
            )
        };
        losses.retain(|loss| !is_empty(loss));
        losses
    }
}
