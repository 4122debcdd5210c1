//! Checks that several structures make before an edit.

use std::fmt::Debug;

use crate::edit::edit_error::EditError;
use crate::handles::handle::Handle;
use crate::handles::limits;
use crate::handles::row_id::FaceId;
use crate::polygons::polygon_mesh::repeated;

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
