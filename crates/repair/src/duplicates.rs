//! Removal of faces that occur more than once.

use std::ops::Range;

use rustc_hash::FxHashMap;
use sixfold_core::{FaceId, FacesByLowest, PolygonMesh, VertexId};

use crate::error::RepairError;
use crate::outcome::Outcome;
use crate::remove::without;

/// What happens to two faces that name the same vertices in opposite cyclic order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OppositeFaces {
    /// Both remain. Two such faces alone are a closed manifold, a pillow.
    #[default]
    Keep,
    /// Both are removed, with all their duplicates: a wall of thickness zero inside a solid.
    Remove,
}

/// Removes duplicate faces; O(corners) expected.
pub(crate) fn remove(
    polygons: &PolygonMesh,
    opposite: OppositeFaces,
) -> Result<Outcome, RepairError> {
    let copies = Copies::new(polygons);
    let keeps = |f| match copies.first_copies(f) {
        (first, None) => first == f,
        (first, Some(_)) => first == f && opposite == OppositeFaces::Keep,
    };
    without(polygons, |_| true, keeps)
}

/// The faces that name the same vertices in cyclic order as another face.
pub(crate) struct Copies {
    /// By face, if it has a copy: the first face with the same order, and the first face with the
    /// opposite order.
    first: FxHashMap<FaceId, (FaceId, Option<FaceId>)>,
}

impl Copies {
    /// Finds the copies; O(corners), plus O(n log n) for n faces with the same lowest vertex.
    pub(crate) fn new(polygons: &PolygonMesh) -> Self {
        let faces = polygons.faces();
        let by_lowest = FacesByLowest::new(polygons.vertex_count(), faces, |_| true);
        let mut first = FxHashMap::default();
        // The faces of a vertex, each with its canonical corners, and whether they are reversed.
        let mut corners: Vec<VertexId> = Vec::new();
        let mut listed: Vec<(Range<usize>, FaceId, bool)> = Vec::new();
        for bucket in by_lowest.several() {
            corners.clear();
            listed.clear();
            for &f in bucket {
                let start = corners.len();
                corners.extend_from_slice(faces.face(f));
                let is_reversed = make_canonical(&mut corners[start..]);
                listed.push((start..corners.len(), f, is_reversed));
            }
            listed.sort_unstable_by(|a, b| {
                let by_corners = corners[a.0.clone()].cmp(&corners[b.0.clone()]);
                by_corners.then(a.1.cmp(&b.1))
            });
            let groups = listed.chunk_by(|a, b| corners[a.0.clone()] == corners[b.0.clone()]);
            for group in groups.filter(|group| group.len() > 1) {
                let [forward, backward] = [false, true].map(|direction| {
                    let mut found = group.iter().filter(|(.., reversed)| *reversed == direction);
                    found.next().map(|&(_, f, _)| f)
                });
                for &(_, f, is_reversed) in group {
                    let (same, opposite) = match is_reversed {
                        false => (forward, backward),
                        true => (backward, forward),
                    };
                    first.insert(f, (same.expect("the face itself"), opposite));
                }
            }
        }
        Self { first }
    }

    /// Returns the first face with the same vertices in the same cyclic order as `f`, possibly `f`
    /// itself, and the first face with the same vertices in the opposite order.
    pub(crate) fn first_copies(&self, f: FaceId) -> (FaceId, Option<FaceId>) {
        self.first.get(&f).copied().unwrap_or((f, None))
    }
}

/// Rotates and reverses the corners of a face so that the lowest is the first and its lower
/// neighbour the second; returns whether they were reversed.
fn make_canonical(corners: &mut [VertexId]) -> bool {
    let lowest = (0..corners.len()).min_by_key(|&i| corners[i]).unwrap_or(0);
    corners.rotate_left(lowest);
    let reversed = corners[1] > corners[corners.len() - 1];
    if reversed {
        corners[1..].reverse();
    }
    reversed
}
