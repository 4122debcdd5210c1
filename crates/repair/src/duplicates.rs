//! Removal of faces that occur more than once.

use rustc_hash::FxHashMap;
use sixfold_core::{FaceId, PolygonMesh, VertexId};

use crate::error::RepairError;
use crate::remove::without;
use crate::step::Outcome;

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

/// The faces of a mesh, grouped by the vertices that they name in cyclic order.
pub(crate) struct Copies {
    /// By face: its group, and whether it runs against the order of the group.
    groups: Vec<(u32, bool)>,
    /// By group: its first face in each of the two directions.
    first: Vec<[Option<FaceId>; 2]>,
}

impl Copies {
    /// Groups the faces; O(corners) expected.
    pub(crate) fn new(polygons: &PolygonMesh) -> Self {
        let faces = polygons.faces();
        let mut canonical = faces.corners().to_vec();
        let mut reversed = Vec::with_capacity(faces.len());
        for (f, _) in faces.iter() {
            reversed.push(make_canonical(&mut canonical[faces.range(f)]));
        }
        let mut numbers = FxHashMap::default();
        let mut first: Vec<[Option<FaceId>; 2]> = Vec::new();
        let mut groups = Vec::with_capacity(faces.len());
        for ((f, _), is_reversed) in faces.iter().zip(reversed) {
            let next = first.len() as u32;
            let group = *numbers.entry(&canonical[faces.range(f)]).or_insert(next);
            if group == next {
                first.push([None; 2]);
            }
            first[group as usize][usize::from(is_reversed)].get_or_insert(f);
            groups.push((group, is_reversed));
        }
        Self { groups, first }
    }

    /// Returns the first face with the same vertices in the same cyclic order as `f`, possibly `f`
    /// itself, and the first face with the same vertices in the opposite order.
    pub(crate) fn first_copies(&self, f: FaceId) -> (FaceId, Option<FaceId>) {
        let (group, is_reversed) = self.groups[f.index()];
        let first = self.first[group as usize];
        let same = first[usize::from(is_reversed)].expect("the face itself");
        (same, first[usize::from(!is_reversed)])
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
