//! The fans of all vertices of any list of faces.

use crate::handles::row_id::{FaceId, VertexId};
use crate::polygons::classes::Classes;
use crate::polygons::incidence::Incidence;

/// The fans of all vertices, as classes of corners. Two corners of a vertex are in the same fan if
/// their faces share an edge at the vertex.
///
/// The fans take 4 bytes per corner. Building takes O(n log n) time for n corners.
pub struct Fans<'a> {
    incidence: &'a Incidence<'a>,
    /// By corner: the lowest corner of its fan. A corner of a face without sides in the incidence is
    /// a fan of its own.
    roots: Vec<u32>,
}

impl<'a> Fans<'a> {
    /// Finds the fans of the faces whose sides are in `incidence`.
    pub fn new(incidence: &'a Incidence<'a>) -> Self {
        let mut fans = Classes::new(incidence.faces().corners().len());
        for edge in incidence.edges() {
            let first = incidence.corners_at_ends(edge.first());
            for side in edge.sides().skip(1) {
                let corners = incidence.corners_at_ends(side);
                fans.join(first[0], corners[0]);
                fans.join(first[1], corners[1]);
            }
        }
        let roots = fans.into_roots();
        Self { incidence, roots }
    }

    /// Returns the incidence from which the fans were found.
    pub fn incidence(&self) -> &'a Incidence<'a> {
        self.incidence
    }

    /// Returns the lowest corner of the fan of a corner.
    pub(crate) fn root(&self, corner: usize) -> u32 {
        self.roots[corner]
    }

    /// Returns the number of fans, including the corners of faces without sides.
    pub(crate) fn len(&self) -> usize {
        let roots = self.roots.iter().zip(0..);
        roots.filter(|&(&root, corner)| root == corner).count()
    }

    /// Returns the vertices whose faces form more than one fan, each with two faces at the vertex:
    /// the first face, and the first face that is in another fan. The vertices are in the order of
    /// the second faces. O(corners).
    ///
    /// The incidence must contain the sides of all faces.
    pub fn several(&self) -> Vec<(VertexId, [FaceId; 2])> {
        self.several_of(|_| true)
    }

    /// Like [`several`](Self::several), for the faces that `used` selects: those with sides.
    pub(crate) fn several_of(&self, used: impl Fn(FaceId) -> bool) -> Vec<(VertexId, [FaceId; 2])> {
        let faces = self.incidence.faces();
        // By vertex: the lowest corner of its first fan, and whether another fan was found.
        let mut first: Vec<Option<(u32, bool)>> = vec![None; self.incidence.vertex_count()];
        let mut found = Vec::new();
        for (f, face) in faces.iter().filter(|&(f, _)| used(f)) {
            for (corner, &v) in faces.range(f).zip(face) {
                let fan = self.roots[corner];
                let known = first[v.index()].get_or_insert((fan, false));
                if known.0 != fan && !known.1 {
                    known.1 = true;
                    found.push((v, [self.incidence.face_of(known.0), f]));
                }
            }
        }
        found
    }
}
