//! Values by side that are updated after every edit.

use crate::edit::element_data::FaceData;
use crate::edit::follow_edits::{AcceptedEdit, FollowEdits};
use crate::traits::query::MeshQuery;

/// A value for each side of the faces, such as the texture coordinates of a corner. In a
/// [`MeshWithData`](crate::MeshWithData), every edit updates the values.
///
/// A side is given by its face and its two ends, in the direction of the face; the side that starts at a corner
/// stands for the corner. Only values that were [set](Self::set) are stored. A side has its value as long as its
/// face exists and runs from the one end to the other. Other sides, also those that an edit makes, have the
/// initial value: a flip, for example, moves two sides to the other triangle. If edits take a side away and make it
/// again, it may have its old value again. For a mesh that does not change,
/// [`side_map`](crate::OrientedWalk::side_map) is faster.
///
/// A value is found in O(values of the face). An edit that renames vertices, such as
/// [`compact`](crate::MeshEdit::compact), takes O(corners) time.
///
/// ```
/// use sixfold_core::{MeshEdit, MeshQuery, MeshWithData, OrientedWalk, Refusal, SideData};
///
/// /// Marks the sides along `e`, and flips `other`, an edge of other faces. The sides are still marked.
/// fn marked<M: MeshEdit + OrientedWalk>(mesh: M, e: M::Edge, other: M::Edge) -> Result<bool, Refusal<M>> {
///     let mut seams = SideData::new(&mesh, false);
///     for s in mesh.edge_sides(e) {
///         let ends = [mesh.side_origin(s), mesh.side_target(s)];
///         seams.set(&mesh, mesh.side_face(s), ends, true);
///     }
///     let mut mesh = MeshWithData::new(mesh, seams);
///     mesh.flip_edge(other)?;
///     let [a, b] = mesh.edge_vertices(e);
///     let mut faces = mesh.edge_faces(e);
///     Ok(faces.all(|f| *mesh.data().get(f, [a, b]) || *mesh.data().get(f, [b, a])))
/// }
/// ```
pub struct SideData<M: MeshQuery, T: Clone> {
    sides: FaceData<M, Vec<ValueOfSide<M::Vertex, T>>>,
    initial: T,
}

#[derive(Clone, Debug)]
struct ValueOfSide<V, T> {
    ends: [V; 2],
    value: T,
}

impl<M: MeshQuery, T: Clone> SideData<M, T> {
    /// Returns data in which every side of `mesh`, and every new side, has the value `initial`.
    pub fn new(mesh: &M, initial: T) -> Self {
        Self {
            sides: FaceData::new(mesh, Vec::new()),
            initial,
        }
    }

    /// Returns the value of the side of `face` that runs from the first of `ends` to the second.
    pub fn get(&self, face: M::Face, ends: [M::Vertex; 2]) -> &T {
        let mut sides = self.sides[face].iter();
        sides
            .find(|side| side.ends == ends)
            .map_or(&self.initial, |side| &side.value)
    }

    /// Sets the value of the side of `face` that runs from the first of `ends` to the second. Has no effect if
    /// `face` has no such side in `mesh`. Costs as much as `face_vertices(face)`.
    pub fn set(&mut self, mesh: &M, face: M::Face, ends: [M::Vertex; 2], value: T) {
        let sides = &mut self.sides[face];
        keep_sides_of(sides, mesh, face);
        match sides.iter_mut().find(|side| side.ends == ends) {
            Some(side) => side.value = value,
            None => {
                sides.push(ValueOfSide { ends, value });
                keep_sides_of(sides, mesh, face);
            }
        }
    }
}

/// Drops the values of sides that `face` does not have.
fn keep_sides_of<M: MeshQuery, T>(
    sides: &mut Vec<ValueOfSide<M::Vertex, T>>,
    mesh: &M,
    face: M::Face,
) {
    if !sides.is_empty() {
        let corners: Vec<M::Vertex> = mesh.face_vertices(face).collect();
        let next = corners.iter().cycle().skip(1);
        let is_side = |ends: &[M::Vertex; 2]| {
            let mut pairs = corners.iter().zip(next.clone());
            pairs.any(|(&a, &b)| [a, b] == *ends)
        };
        sides.retain(|side| is_side(&side.ends));
    }
}

impl<M: MeshQuery, T: Clone> FollowEdits<M> for SideData<M, T> {
    fn follow(&mut self, edit: &AcceptedEdit<'_, M>) {
        self.sides.follow(edit);
        let mut renamed = edit.changes.vertices.renamed.clone();
        if renamed.is_empty() {
            return;
        }
        renamed.sort_unstable();
        for f in edit.mesh.faces() {
            let sides = &mut self.sides[f];
            for end in sides.iter_mut().flat_map(|side| &mut side.ends) {
                if let Ok(place) = renamed.binary_search_by_key(end, |[old, _]| *old) {
                    *end = renamed[place][1];
                }
            }
            keep_sides_of(sides, edit.mesh, f);
        }
    }
}

impl<M: MeshQuery, T: Clone> Clone for SideData<M, T> {
    fn clone(&self) -> Self {
        Self {
            sides: self.sides.clone(),
            initial: self.initial.clone(),
        }
    }
}

impl<M: MeshQuery, T: Clone + std::fmt::Debug> std::fmt::Debug for SideData<M, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut data = f.debug_struct("SideData");
        data.field("initial", &self.initial).finish_non_exhaustive()
    }
}
