//! The steps that make a mesh fit a structure.

use sixfold_core::{Capabilities, PolygonMesh};

use crate::duplicates::OppositeFaces;
use crate::error::RepairError;
use crate::orientation::{Components, Facing};
use crate::report::Repaired;
use crate::step::{Run, Step};
use crate::weld::Weld;

/// A step of [`repair_for`], and the capabilities without which it is needed.
///
/// The step runs if a structure that lacks only these capabilities refuses the mesh.
struct Planned {
    step: Step,
    needed_without: fn(&Capabilities) -> Capabilities,
}

/// All steps of [`repair_for`], in order:
///
/// - Welding comes first, because it can make faces equal.
/// - Duplicate faces are removed before orientation, because both copies run along the same edges.
/// - Polygons are cut before edges, because a diagonal can be an edge elsewhere.
/// - Faces are oriented before edges are cut, so that fewer sides remain open.
/// - Vertices are removed last, because the other steps can take the last face of a vertex.
fn planned() -> [Planned; 6] {
    [
        Planned {
            step: Step::Weld(Weld::default()),
            needed_without: |own| Capabilities {
                coincident_vertices: own.coincident_vertices,
                ..Capabilities::ALL
            },
        },
        Planned {
            step: Step::RemoveDuplicateFaces(OppositeFaces::Keep),
            needed_without: connectivity,
        },
        Planned {
            step: Step::Triangulate,
            needed_without: |own| Capabilities {
                polygons: own.polygons,
                ..Capabilities::ALL
            },
        },
        Planned {
            step: Step::Orient {
                facing: Facing::Outward,
                which: Components::Inconsistent,
            },
            needed_without: |own| Capabilities {
                inconsistent_orientation: own.inconsistent_orientation,
                ..Capabilities::ALL
            },
        },
        Planned {
            step: Step::Cut,
            needed_without: connectivity,
        },
        Planned {
            step: Step::RemoveIsolatedVertices,
            needed_without: |own| Capabilities {
                isolated_vertices: own.isolated_vertices,
                ..Capabilities::ALL
            },
        },
    ]
}

/// Returns all capabilities except those of edges, fans and orientation that `own` lacks.
fn connectivity(own: &Capabilities) -> Capabilities {
    Capabilities {
        non_manifold_edges: own.non_manifold_edges,
        non_manifold_vertices: own.non_manifold_vertices,
        inconsistent_orientation: own.inconsistent_orientation,
        ..Capabilities::ALL
    }
}

/// Returns the mesh with the repairs that a structure with these capabilities needs, and no others.
///
/// The steps are, in this order, each only if the structure refuses the mesh for it: weld exactly,
/// remove duplicate faces, triangulate by ear clipping, orient the components that are not
/// consistent (outward if they are closed), cut into an oriented manifold, and remove isolated
/// vertices. The structure then holds the mesh. A mesh that it holds already is returned unchanged,
/// with no steps.
///
/// # Errors
///
/// [`RepairError::NoStep`] if the mesh has too many elements for the structure, and
/// [`RepairError::TooLarge`] if the repaired mesh would have.
///
/// # Complexity
///
/// O(n log n) for n corners, except for polygons with many corners
/// ([`PolygonMesh::triangulated`]).
///
/// # Examples
///
/// ```
/// use sixfold_core::{MeshQuery, PolygonMesh, Representation};
/// use sixfold_half_edge::HalfEdgeMesh;
/// use sixfold_repair::repair_for;
///
/// // Three triangles on one edge.
/// let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]];
/// let book = PolygonMesh::new(points, [[0, 1, 2], [1, 0, 3], [1, 0, 4]])?;
/// assert!(HalfEdgeMesh::from_polygons(&book).is_err());
/// let repaired = repair_for(&book, &HalfEdgeMesh::CAPABILITIES)?;
/// let mesh = HalfEdgeMesh::from_polygons(&repaired.polygons)?;
/// assert_eq!(mesh.edge_count(), 3 + 3 + 2); // two triangles share an edge, one is separate
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn repair_for(
    polygons: &PolygonMesh,
    capabilities: &Capabilities,
) -> Result<Repaired, RepairError> {
    let mut run = Run::new(polygons);
    if capabilities.check(polygons).is_ok() {
        return Ok(run.finish());
    }
    for planned in planned() {
        let needed = (planned.needed_without)(capabilities);
        if needed.check(run.polygons()).is_err() {
            run.step(planned.step)?;
        }
    }
    match capabilities.check(run.polygons()) {
        Ok(()) => Ok(run.finish()),
        Err(fault) => Err(RepairError::NoStep(fault)),
    }
}
