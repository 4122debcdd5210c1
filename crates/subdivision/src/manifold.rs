//! Checks that a mesh is an oriented manifold.

use sixfold_core::{MeshQuery, Refine, map_chunks};

use crate::connectivity::{non_manifold_edge, non_manifold_vertex};
use crate::error::SubdivisionError;
use crate::scheme::Scheme;

/// Returns whether face `f` has the side from `a` to `b`.
pub(crate) fn has_side<M: MeshQuery>(mesh: &M, f: M::Face, [a, b]: [M::Vertex; 2]) -> bool {
    let (mut first, mut last, mut found) = (None, None, false);
    mesh.face_vertices(f).for_each(|v| {
        found |= last == Some(a) && v == b;
        first = first.or(Some(v));
        last = Some(v);
    });
    found || (last == Some(a) && first == Some(b))
}

/// Checks that `e` has one face, or two faces that run along `e` in opposite directions. The error
/// is the number of faces.
fn check_edge<M: MeshQuery>(mesh: &M, e: M::Edge) -> Result<(), usize> {
    let ends = mesh.edge_vertices(e);
    let mut along = [0, 0];
    mesh.edge_faces(e)
        .for_each(|f| along[usize::from(has_side(mesh, f, ends))] += 1);
    if along.iter().all(|&faces| faces <= 1) {
        Ok(())
    } else {
        Err(along[0] + along[1])
    }
}

/// Checks that every edge has one face, or two faces that run along the edge in opposite
/// directions. Also checks that the faces at every vertex are one fan.
///
/// # Errors
///
/// Returns an error for the first invalid edge. If all edges are valid, returns an error for the
/// first invalid vertex.
pub(crate) fn check<M: MeshQuery>(mesh: &M, scheme: Scheme) -> Result<(), SubdivisionError> {
    let number_of = |v: M::Vertex| mesh.vertices().position(|w| w == v).unwrap_or(0) as u32;
    for e in mesh.edges() {
        check_edge(mesh, e).map_err(|faces| {
            let ends = mesh.edge_vertices(e).map(number_of);
            non_manifold_edge(scheme, ends, faces)
        })?;
    }
    for (number, v) in mesh.vertices().enumerate() {
        if mesh.one_ring(v).is_none() {
            return Err(non_manifold_vertex(scheme, number as u32));
        }
    }
    Ok(())
}

/// Returns whether every mesh in a structure of type `M` passes [`check`].
pub(crate) fn is_always_manifold<M: Refine>() -> bool {
    let capabilities = M::CAPABILITIES;
    !(capabilities.non_manifold_edges
        || capabilities.non_manifold_vertices
        || capabilities.inconsistent_orientation)
}

/// Returns the boundary edges in order, each in the direction of its face. Uses several threads.
///
/// # Errors
///
/// Returns an error for the first edge with three faces, or with two faces that run along the edge
/// in the same direction.
pub(crate) fn boundary_edges<M: Refine>(
    mesh: &M,
    numbers: &M::EdgeNumbers,
    scheme: Scheme,
) -> Result<Vec<[u32; 2]>, SubdivisionError> {
    let chunks = mesh.edge_chunks(numbers);
    let is_always_manifold = is_always_manifold::<M>();
    // No value is stored by edge, so the rows take no memory.
    let mut rows = vec![(); chunks.last().copied().unwrap_or(0)];
    let found = map_chunks(&mut rows, &chunks, |chunk, _, _| {
        let mut boundary = Vec::new();
        for e in mesh.edges_of_chunk(numbers, chunk) {
            let (mut face, mut faces) = (None, 0);
            mesh.edge_faces(e).for_each(|f| {
                face = Some(f);
                faces += 1;
            });
            let ends = mesh.edge_vertices(e);
            if let (Some(f), 1) = (face, faces) {
                let [a, b] = ends.map(|v| v.index() as u32);
                boundary.push(if has_side(mesh, f, ends) {
                    [a, b]
                } else {
                    [b, a]
                });
            } else if !is_always_manifold && check_edge(mesh, e).is_err() {
                let ends = ends.map(|v| v.index() as u32);
                return Err(non_manifold_edge(scheme, ends, faces));
            }
        }
        Ok(boundary)
    });
    let mut all = Vec::new();
    for chunk in found {
        all.append(&mut chunk?);
    }
    Ok(all)
}
