//! Checks that several structures make before an edit.

use std::fmt::Debug;

use crate::edit::edit_error::EditError;
use crate::edit::mesh_edit::Refusal;
use crate::handles::handle::Handle;
use crate::handles::limits;
use crate::handles::row_id::FaceId;
use crate::polygons::polygon_mesh::repeated;
use crate::traits::query::MeshQuery;

/// Checks that a table has at most `limit` rows, or fewer within `with_lower_limits`. `rows` is the
/// number of rows after the edit.
///
/// # Errors
///
/// [`EditError::TooMany`] if `rows` is above `limit`.
#[inline(always)]
pub fn check_rows<V: Debug, E: Debug, F: Debug>(
    elements: &'static str,
    rows: usize,
    limit: usize,
) -> Result<(), EditError<V, E, F>> {
    let limit = limits::current(limit);
    if rows > limit {
        return Err(EditError::TooMany { elements, limit });
    }
    Ok(())
}

/// Checks the corners of a new face. First, there must be at least three corners; then
/// `check_vertex` must accept each corner; finally, all corners must differ.
///
/// # Errors
///
/// [`EditError::TooFewCorners`], the first error of `check_vertex`, or
/// [`EditError::RepeatedVertex`].
#[inline]
pub fn check_corners<V: Handle, E: Debug, F: Debug>(
    corners: &[V],
    check_vertex: impl Fn(V) -> Result<(), EditError<V, E, F>>,
) -> Result<(), EditError<V, E, F>> {
    if corners.len() < 3 {
        let corners = corners.len();
        return Err(EditError::TooFewCorners { corners });
    }
    corners.iter().try_for_each(|&v| check_vertex(v))?;
    match repeated(corners) {
        Some(vertex) => Err(EditError::RepeatedVertex { vertex }),
        None => Ok(()),
    }
}

/// Returns `faces` sorted, each once. `check_face` must accept each face. O(n log n) for n faces.
///
/// # Errors
///
/// The first error of `check_face`.
pub fn faces_once<F: Handle, E, T>(
    faces: &[F],
    check_face: impl Fn(F) -> Result<T, E>,
) -> Result<Vec<F>, E> {
    for &f in faces {
        check_face(f)?;
    }
    let mut once = faces.to_vec();
    once.sort_unstable();
    once.dedup();
    Ok(once)
}

/// Checks that the faces at each corner of `gone` would form at most one fan without `gone`, which is
/// sorted. In a manifold, an open fan has two boundary edges.
///
/// O(n log n) for n corners of the faces and of the faces at these corners.
///
/// # Errors
///
/// [`EditError::SeveralFans`].
pub fn check_fans_without<M: MeshQuery>(mesh: &M, gone: &[M::Face]) -> Result<(), Refusal<M>> {
    let corners = gone.iter().flat_map(|&f| mesh.face_vertices(f));
    let mut corners: Vec<M::Vertex> = corners.collect();
    corners.sort_unstable();
    corners.dedup();
    for vertex in corners {
        let becomes_boundary = |e: &M::Edge| {
            let kept = mesh
                .edge_faces(*e)
                .filter(|f| gone.binary_search(f).is_err());
            kept.count() == 1
        };
        if mesh.vertex_edges(vertex).filter(becomes_boundary).count() > 2 {
            return Err(EditError::SeveralFans { vertex });
        }
    }
    Ok(())
}

/// Checks that an edge between `ends` can cut a face with the given `corners`; returns the indices
/// of the two ends in `corners`, the lower index first. `is_at` tests whether a vertex is at a
/// corner.
///
/// # Errors
///
/// [`EditError::NotACorner`], or [`EditError::AdjacentCorners`] if the ends are equal or adjacent.
#[inline]
pub fn check_cut<V: Handle, E: Debug, C>(
    face: FaceId,
    corners: &[C],
    ends: [V; 2],
    is_at: impl Fn(V, &C) -> bool,
) -> Result<[usize; 2], EditError<V, E, FaceId>> {
    let mut places = [0; 2];
    for (place, vertex) in places.iter_mut().zip(ends) {
        let found = corners.iter().position(|corner| is_at(vertex, corner));
        *place = found.ok_or(EditError::NotACorner { face, vertex })?;
    }
    places.sort_unstable();
    let between = places[1] - places[0];
    if between < 2 || between + 2 > corners.len() {
        return Err(EditError::AdjacentCorners { face, ends });
    }
    Ok(places)
}
