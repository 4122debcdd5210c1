//! Lookups before an edit: handles, faces at an edge, room for new elements.

use sixfold_core::{
    EditError, Editable, FaceId, IteratorExt, MAX_ROWS, Pair, Probe, ShortVec, VertexId, check_rows,
};

use crate::circulate::{has_side_between, neighbours_in};
use crate::mesh::{BLANK_CORNER, BLANK_PLACE, FaceVertexMesh, Fan};

/// The error of an edit, without the type of the probe.
pub(super) type Refused = EditError<VertexId, Pair<VertexId>, FaceId>;

/// Maximum number of places in the pool that an edit may fill. If all fans then move and leave
/// blanks, the pool still has fewer than [`MAX_ROWS`] places.
const MAX_PLACES: usize = MAX_ROWS / 4;

/// Returns a number with bit `i` set for each `i` with `hits[i] == 1`.
#[inline]
pub(super) fn mask<const N: usize>(hits: [u32; N]) -> u32 {
    (0..N).fold(0, |mask, i| mask | hits[i] << i)
}

impl<P: Probe> FaceVertexMesh<Editable, P> {
    #[inline]
    pub(super) fn fan_of(&self, v: VertexId) -> Result<Fan, Refused> {
        if v.index() < self.fans.len() {
            let fan = *self.fans.read(v.index());
            if fan != Fan::DELETED {
                return Ok(fan);
            }
        }
        Err(EditError::NoSuchVertex { vertex: v })
    }

    #[inline]
    pub(super) fn corners_of_face(&self, f: FaceId) -> Result<&[VertexId], Refused> {
        if f.index() < self.spans.len() {
            let face = self.known_face(f);
            if face[0] != BLANK_CORNER {
                return Ok(face);
            }
        }
        Err(EditError::NoSuchFace { face: f })
    }

    /// Visits the faces with corners at both ends of `e`. The two corners need not be adjacent.
    ///
    /// Compares short fans with each other, without reading the corners of a face.
    #[inline]
    fn visit_faces_at_both(&self, e: Pair<VertexId>, mut visit: impl FnMut(FaceId)) {
        let [a, b] = e.ends();
        let ([Ok(at_a), Ok(at_b)], true) = ([a, b].map(|v| self.fan_of(v)), a != b) else {
            return;
        };
        let longer = at_a.len.max(at_b.len);
        let is_done = (longer <= 8 && self.compare_fans::<8>([at_a, at_b], &mut visit))
            || (longer <= 16 && self.compare_fans::<16>([at_a, at_b], &mut visit));
        if !is_done {
            self.search_shorter_fan([(a, at_a), (b, at_b)], &mut visit);
        }
    }

    /// Visits the common faces of two fans of up to `N` faces. Returns false if a fan is longer, or
    /// if fewer than `N` places of the pool follow its start.
    ///
    /// Compares all faces of the two fans, without a branch, because the matches are unpredictable.
    #[inline]
    fn compare_fans<const N: usize>(&self, fans: [Fan; 2], visit: &mut impl FnMut(FaceId)) -> bool {
        let [Some(some), Some(others)] = fans.map(|fan| self.lanes::<N>(fan)) else {
            return false;
        };
        let [len, other_len] = fans.map(|fan| fan.len as usize);
        let mut hits = [0; N];
        for (i, &face) in some.iter().enumerate() {
            let face = if i < len { face } else { BLANK_PLACE };
            for (hit, &other) in hits.iter_mut().zip(&others) {
                *hit |= u32::from(face == other);
            }
        }
        // The mask removes the places after the second fan.
        let mut hits = mask(hits) & ((1 << other_len) - 1);
        while hits != 0 {
            visit(others[hits.trailing_zeros() as usize]);
            hits &= hits - 1;
        }
        true
    }

    /// Visits the same faces as `compare_fans`, but searches the faces of the shorter fan for the
    /// other vertex.
    #[cold]
    #[inline(never)]
    fn search_shorter_fan(&self, ends: [(VertexId, Fan); 2], visit: &mut impl FnMut(FaceId)) {
        let [mut short, mut long] = ends;
        if long.1.len < short.1.len {
            (short, long) = (long, short);
        }
        for &f in self.pool.read_range(short.1.range()) {
            if self.known_face(f).contains(&long.0) {
                visit(f);
            }
        }
    }

    /// Returns the faces with corners at both ends of `e`. The two corners need not be adjacent.
    #[inline]
    pub(super) fn faces_at_both(&self, e: Pair<VertexId>) -> ShortVec<FaceId> {
        let mut both = ShortVec::new();
        self.visit_faces_at_both(e, |f| both.push(f));
        both
    }

    /// Returns `N` places of the pool from the start of a fan. Returns `None` if the fan is longer,
    /// or if fewer than `N` places follow its start.
    #[inline]
    pub(super) fn lanes<const N: usize>(&self, fan: Fan) -> Option<[FaceId; N]> {
        let start = fan.range().start;
        if fan.len as usize > N || start + N > self.pool.len() {
            return None;
        }
        let places = self.pool.read_range(start..start + N);
        places.first_chunk().copied()
    }

    /// Returns whether the ends of `e` are adjacent corners of `f`. `f` has corners at both ends.
    #[inline]
    pub(super) fn has_side(&self, f: FaceId, e: Pair<VertexId>) -> bool {
        let [a, b] = e.ends();
        has_side_between(self.known_face(f), a, b)
    }

    /// Returns the faces at `e`, or an error if `e` is not an edge.
    #[inline]
    pub(super) fn faces_of_edge(&self, e: Pair<VertexId>) -> Result<ShortVec<FaceId>, Refused> {
        let mut along = ShortVec::new();
        self.visit_faces_at_both(e, |f| {
            if self.has_side(f, e) {
                along.push(f);
            }
        });
        if along.is_empty() {
            return Err(EditError::NoSuchEdge { edge: e });
        }
        Ok(along)
    }

    #[inline]
    pub(super) fn has_edge(&self, e: Pair<VertexId>) -> bool {
        let mut has = false;
        self.visit_faces_at_both(e, |f| has |= self.has_side(f, e));
        has
    }

    /// Returns the two faces of `e`. The first face runs along `e` from the lower end.
    #[inline]
    pub(super) fn two_faces(&self, e: Pair<VertexId>) -> Result<[FaceId; 2], Refused> {
        let [low, high] = e.ends();
        let mut found = 0;
        // The last face that runs up, and the last face that runs down.
        let mut along = [BLANK_PLACE; 2];
        self.visit_faces_at_both(e, |f| {
            let [before, after] = neighbours_in(self.known_face(f), low);
            if (after == high) | (before == high) {
                along[usize::from(after != high)] = f;
                found += 1;
            }
        });
        match found {
            0 => Err(EditError::NoSuchEdge { edge: e }),
            2 if along.contains(&BLANK_PLACE) => Err(EditError::SameDirection { edge: e }),
            2 => Ok(along),
            faces => Err(EditError::NotTwoFaces { edge: e, faces }),
        }
    }

    // Always inlined: a call would return a large error in memory.
    #[inline(always)]
    pub(super) fn triangle(&self, f: FaceId) -> Result<[VertexId; 3], Refused> {
        let face = self.known_face(f);
        match *face {
            [a, b, c] => Ok([a, b, c]),
            _ => Err(EditError::NotATriangle {
                face: f,
                degree: face.len(),
            }),
        }
    }

    pub(super) fn valence(&self, v: VertexId) -> usize {
        let ends = self
            .fan(v)
            .iter()
            .flat_map(|&f| neighbours_in(self.known_face(f), v));
        ends.distinct().count()
    }

    /// Checks that handles exist for these numbers of new vertices, faces and corners. Each corner
    /// also needs a place in the pool.
    #[inline]
    pub(super) fn check_room(
        &self,
        vertices: usize,
        faces: usize,
        corners: usize,
    ) -> Result<(), Refused> {
        check_rows("vertices", self.fans.len() + vertices, MAX_ROWS)?;
        check_rows("faces", self.spans.len() + faces, MAX_ROWS)?;
        check_rows("corners", self.corners.len() + corners, MAX_ROWS)?;
        check_rows(
            "entries of the fan pool",
            self.pool.len() + corners,
            MAX_PLACES,
        )
    }
}
