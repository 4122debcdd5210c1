//! Checks of invariants that several structures share. Each check gets the number of the invariant
//! in the structure.

use rustc_hash::FxHashSet;

use crate::handles::iterator_ext::IteratorExt;
use crate::handles::row_id::{FaceId, VertexId};
use crate::polygons::error::InvariantError;
use crate::tables::holes::HoleSet;
use crate::tables::probe::Probe;
use crate::traits::query::MeshQuery;

/// Returns the error for an invariant that fails, with a description of the fault.
///
/// # Errors
///
/// Always returns the error.
pub fn fails<T>(invariant: &'static str, detail: String) -> Result<T, InvariantError> {
    Err(InvariantError::new(invariant, detail))
}

/// Checks that the stored numbers of holes are correct, and that all holes are rows. `tables` has
/// each set of holes together with the number of rows.
///
/// # Errors
///
/// Returns the first fault.
pub fn check_holes<'a, P: Probe + 'a, H: HoleSet<P> + 'a>(
    invariant: &'static str,
    tables: impl IntoIterator<Item = (&'a H, usize)>,
) -> Result<(), InvariantError> {
    let mut tables = tables.into_iter();
    let checked = tables.try_for_each(|(holes, rows)| holes.check(rows));
    checked.or_else(|detail| fails(invariant, detail))
}

/// Checks that the vertices at the corners of a face exist and are distinct.
///
/// # Errors
///
/// Returns the first fault.
pub fn check_corners_of_face(
    invariant: &'static str,
    f: FaceId,
    face: &[VertexId],
    exists: impl Fn(VertexId) -> bool,
) -> Result<(), InvariantError> {
    if let Some(v) = face.iter().find(|&&v| !exists(v)) {
        return fails(
            invariant,
            format!("{f} has vertex {v}, which does not exist"),
        );
    }
    let mut once = face.iter().distinct();
    match face.iter().find(|&v| once.next() != Some(v)) {
        Some(v) => fails(invariant, format!("{f} has vertex {v} twice")),
        None => Ok(()),
    }
}

/// Checks that the walk along each face visits at least three vertices, each once, and that all
/// walks together visit all sides that have a face; `sides` is the number of these sides.
///
/// # Errors
///
/// Returns the first fault.
pub fn check_walks_along_faces<M: MeshQuery>(
    invariant: &'static str,
    mesh: &M,
    sides: usize,
) -> Result<(), InvariantError> {
    let mut along = 0;
    for f in mesh.faces() {
        let corners: Vec<M::Vertex> = mesh.face_vertices(f).collect();
        let distinct: FxHashSet<M::Vertex> = corners.iter().copied().collect();
        if corners.len() < 3 || distinct.len() < corners.len() {
            return fails(invariant, format!("{f:?} has invalid corners: {corners:?}"));
        }
        along += corners.len();
    }
    match along == sides {
        true => Ok(()),
        false => fails(
            invariant,
            format!("{sides} sides have a face, but the walks along faces visit {along}"),
        ),
    }
}

/// Checks that the walk around each vertex visits every item at the vertex: each half-edge, edge or
/// corner, as `items` states. `ends` yields the vertex of each item; `walk` returns the number of
/// items that the walk around a vertex visits.
///
/// # Errors
///
/// Returns the first vertex with more than one fan.
pub fn check_fans<M: MeshQuery<Vertex = VertexId>>(
    invariant: &'static str,
    mesh: &M,
    items: &str,
    ends: impl Iterator<Item = VertexId>,
    walk: impl Fn(VertexId) -> usize,
) -> Result<(), InvariantError> {
    let mut expected = vec![0_usize; mesh.vertex_rows()];
    for v in ends {
        expected[v.index()] += 1;
    }
    for v in mesh.vertices() {
        let (visited, all) = (walk(v), expected[v.index()]);
        if visited != all {
            return fails(
                invariant,
                format!("the walk around {v} visits {visited} of {all} {items}"),
            );
        }
    }
    Ok(())
}

/// Checks that each edge has two different ends, and that no two edges have the same ends.
///
/// # Errors
///
/// Returns the first edge that breaks the rule.
pub fn check_distinct_edges<M: MeshQuery>(
    invariant: &'static str,
    mesh: &M,
) -> Result<(), InvariantError> {
    let mut ends = FxHashSet::default();
    for e in mesh.edges() {
        let [a, b] = mesh.edge_vertices(e);
        if a == b || !ends.insert([a.min(b), a.max(b)]) {
            return fails(
                invariant,
                format!("{e:?} and another edge have the same ends, {a:?} and {b:?}"),
            );
        }
    }
    Ok(())
}
