//! The steps that make a mesh fit a structure.

use sixfold_core::{Capabilities, Incidence, PolygonMesh};

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
/// - Duplicate faces are removed before orientation, because both copies run along the same edges. If
///   more edges are open at the end than without this step, it does not run.
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
/// remove duplicate faces (unless this opens more edges than to separate them), triangulate by ear clipping, orient the components that are not
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
    if capabilities.check(polygons).is_ok() {
        return Ok(Run::new(polygons).finish());
    }
    let run = run_planned(polygons, capabilities, |_| true)?;
    if !run
        .steps()
        .iter()
        .any(|report| is_removal(&report.step) && report.counts.is_change())
    {
        return finished(run, capabilities);
    }
    // Copies of a face can be the walls of two solids, one of which faces inward. Then edges open
    // without one of them.
    let keeping = run_planned(polygons, capabilities, |step| !is_removal(step))?;
    let [open, open_keeping] = [&run, &keeping].map(|run| boundary_edges(run.polygons()));
    match open <= open_keeping {
        true => finished(run, capabilities),
        false => finished(keeping, capabilities),
    }
}

fn is_removal(step: &Step) -> bool {
    matches!(step, Step::RemoveDuplicateFaces(_))
}

fn boundary_edges(polygons: &PolygonMesh) -> usize {
    let incidence = Incidence::new(polygons.vertex_count(), polygons.faces(), |_| true);
    incidence.edges().filter(|edge| edge.len() == 1).count()
}

/// Runs the steps that `is_wanted` and that the structure needs.
fn run_planned<'a>(
    polygons: &'a PolygonMesh,
    capabilities: &Capabilities,
    is_wanted: impl Fn(&Step) -> bool,
) -> Result<Run<'a>, RepairError> {
    let mut run = Run::new(polygons);
    for planned in planned()
        .into_iter()
        .filter(|planned| is_wanted(&planned.step))
    {
        let needed = (planned.needed_without)(capabilities);
        if needed.check(run.polygons()).is_err() {
            run.step(planned.step)?;
        }
    }
    Ok(run)
}

fn finished(run: Run<'_>, capabilities: &Capabilities) -> Result<Repaired, RepairError> {
    match capabilities.check(run.polygons()) {
        Ok(()) => Ok(run.finish()),
        Err(fault) => Err(RepairError::NoStep(fault)),
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::Facts;

    use super::*;

    fn mesh(points: usize, faces: &[&[u32]]) -> PolygonMesh {
        // Two unit cubes beside each other: four corners in each plane of constant x.
        let corner = |i: usize| [(i / 4) as f32, (i % 4 / 2) as f32, (i % 2) as f32];
        PolygonMesh::new((0..points).map(corner), faces).expect("valid")
    }

    #[test]
    fn walls_of_two_solids_are_not_copies() {
        let capabilities = Capabilities::ORIENTED_MANIFOLDS;
        let left: [&[u32]; 6] = [
            &[0, 1, 3, 2],
            &[4, 6, 7, 5],
            &[0, 2, 6, 4],
            &[1, 5, 7, 3],
            &[0, 4, 5, 1],
            &[2, 3, 7, 6],
        ];
        // The second cube faces inward, so that its wall runs like that of the first.
        let right: [&[u32]; 6] = [
            &[4, 6, 7, 5],
            &[8, 9, 11, 10],
            &[4, 8, 10, 6],
            &[5, 7, 11, 9],
            &[4, 5, 9, 8],
            &[6, 10, 11, 7],
        ];
        let cubes = mesh(12, &[left, right].concat());
        let repaired = repair_for(&cubes, &capabilities).expect("small");
        let facts = Facts::from_polygons(&repaired.polygons);
        assert_eq!(
            (facts.boundary_edges, facts.faces, facts.components),
            (0, 12, 2)
        );
        // A copy of a face of one cube is removed.
        let twice = mesh(8, &[&left[..], &left[2..3]].concat());
        let repaired = repair_for(&twice, &capabilities).expect("small");
        let facts = Facts::from_polygons(&repaired.polygons);
        assert_eq!(
            (facts.boundary_edges, facts.faces, facts.components),
            (0, 6, 1)
        );
    }
}
