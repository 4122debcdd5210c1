//! Faces as lists of corners, without links from a vertex to its faces.

#[cfg(test)]
mod tests;

use sixfold_core::{
    Compact, Editable, Editing, FACE_HOLES, FaceId, FaceSpans, Handle, HoleSet, IteratorExt,
    NoHoles, Pair, Probe, Table, TableBytes, Untraced, VertexId,
};

use crate::scan::{hits_in, scan};

/// The handle of a vertex in a structure that scans all corners. Each row of the table of corners
/// stores the vertex of one corner as a [`Corner`](Self::Corner).
pub trait ScannedVertex: Handle {
    /// The type of the rows of the table of corners.
    type Corner: Copy;
    /// A set of vertices, to test whether a corner is at a vertex of the set.
    type Set;
    /// A handle that no vertex has. Corners of deleted faces store this handle. No scan searches
    /// for this handle.
    const BLANK: Self;
    /// True if vertices are identified by coordinates. If `IS_POSITION` is true, every vertex has a
    /// face, and no two vertices have the same position.
    const IS_POSITION: bool;

    /// Returns the vertex of a corner.
    fn from_corner(corner: Self::Corner) -> Self;
    /// Returns the row of a corner that is at this vertex.
    fn corner(self) -> Self::Corner;
    /// Returns whether `corner` is at this vertex.
    fn is_at(self, corner: &Self::Corner) -> bool;
    /// Builds a set of vertices.
    fn set(vertices: impl Iterator<Item = Self>) -> Self::Set;
    /// Returns whether `corner` is at one of the vertices of `set`.
    fn is_in(corner: &Self::Corner, set: &Self::Set) -> bool;
}

/// Each row of the table of corners is the handle of the vertex at the corner.
impl ScannedVertex for VertexId {
    type Corner = Self;
    /// A bit for each vertex row, up to the highest row in the set.
    type Set = Vec<u64>;
    const BLANK: Self = Self::new(u32::MAX);
    const IS_POSITION: bool = false;

    #[inline]
    fn from_corner(corner: Self) -> Self {
        corner
    }

    #[inline]
    fn corner(self) -> Self {
        self
    }

    #[inline]
    fn is_at(self, corner: &Self) -> bool {
        *corner == self
    }

    fn set(vertices: impl Iterator<Item = Self>) -> Vec<u64> {
        let mut words = Vec::new();
        for v in vertices {
            let word = v.index() / 64;
            if word >= words.len() {
                words.resize(word + 1, 0);
            }
            words[word] |= 1 << (v.index() % 64);
        }
        words
    }

    #[inline]
    fn is_in(corner: &Self, words: &Vec<u64>) -> bool {
        let word = words.get(corner.index() / 64);
        word.is_some_and(|word| word >> (corner.index() % 64) & 1 == 1)
    }
}

/// The vertices that a scan searches for.
#[derive(Clone, Debug)]
pub enum SearchSet<V, S> {
    /// One vertex.
    One(V),
    /// Two vertices.
    Two([V; 2]),
    /// Three or four vertices. If there are three, the last vertex is stored twice.
    Four([V; 4]),
    /// Any number of vertices.
    Many(S),
}

impl<V: ScannedVertex> SearchSet<V, V::Set> {
    /// Builds the set of `vertices`.
    #[inline]
    pub fn from_vertices(vertices: &[V]) -> Self {
        match *vertices {
            [a] => Self::One(a),
            [a, b] => Self::Two([a, b]),
            [a, b, c] => Self::Four([a, b, c, c]),
            [a, b, c, d] => Self::Four([a, b, c, d]),
            _ => Self::Many(V::set(vertices.iter().copied())),
        }
    }

    /// Builds the set of the first, third, fifth … corner of a face. Every side of the face has an
    /// end in this set.
    pub fn every_second(face: &[V::Corner]) -> Self {
        match *face {
            [a, _, c] | [a, _, c, _] => Self::Two([a, c].map(V::from_corner)),
            [a, _, c, _, e] | [a, _, c, _, e, _] => Self::Four([a, c, e, e].map(V::from_corner)),
            [a, _, c, _, e, _, g] | [a, _, c, _, e, _, g, _] => {
                Self::Four([a, c, e, g].map(V::from_corner))
            }
            _ => Self::Many(V::set(
                face.iter().step_by(2).map(|&corner| V::from_corner(corner)),
            )),
        }
    }

    /// Returns the corners of a block that are at one of the vertices, as bits.
    #[inline]
    fn hits(&self, block: &[V::Corner]) -> u64 {
        match self {
            Self::One(v) => hits_in(block, |c| v.is_at(c)),
            Self::Two([a, b]) => hits_in(block, |c| a.is_at(c) | b.is_at(c)),
            Self::Four([a, b, c, d]) => hits_in(block, |x| {
                (a.is_at(x) | b.is_at(x)) | (c.is_at(x) | d.is_at(x))
            }),
            Self::Many(set) => hits_in(block, |c| V::is_in(c, set)),
        }
    }
}

/// A corner that a scan found.
#[derive(Clone, Copy, Debug)]
pub struct Hit<V> {
    /// The row of the corner in the table of corners.
    pub corner: usize,
    /// The face of the corner.
    pub face: FaceId,
    /// The vertex before the corner in the face.
    pub before: V,
    /// The vertex of the corner.
    pub at: V,
    /// The vertex after the corner in the face.
    pub after: V,
}

impl<V: Handle> Hit<V> {
    /// Returns whether `v` is the vertex before or after the corner.
    #[inline]
    pub fn is_beside(&self, v: V) -> bool {
        self.before == v || self.after == v
    }

    /// Returns the two edges of the face that have the vertex of the corner as an end.
    #[inline]
    pub fn sides(&self) -> [Pair<V>; 2] {
        [self.before, self.after].map(|end| Pair::new(end, self.at))
    }
}

/// The faces of a structure that stores no connectivity except the corners of each face. The
/// corners of all faces are in one table, face after face.
///
/// Queries and edits scan all corners to find the faces at a vertex or along an edge. When a face
/// is deleted or moved to other rows, its old rows get a value that no vertex has. A row with a
/// value that no vertex has is called blank, and scans do not find blank rows.
#[derive(Debug)]
pub struct ScannedFaces<V: ScannedVertex, P: Probe = Untraced, E: Editing = Compact> {
    /// The corners, face by face.
    pub corners: Table<V::Corner, P>,
    /// The range of the corners of each face, including deleted faces.
    pub spans: FaceSpans<P, E>,
    /// The rows of deleted faces.
    pub holes: E::Holes<P>,
}

sixfold_core::clone_by_field!(ScannedFaces<V: ScannedVertex, P: Probe, E: Editing> { corners, spans, holes });

impl<V: ScannedVertex, E: Editing> ScannedFaces<V, Untraced, E> {
    /// Builds the faces from a table of corners and the ranges of the corners of each face.
    pub fn new(corners: Vec<V::Corner>, spans: FaceSpans) -> Self {
        Self {
            corners: Table::new("corners", "corner", corners),
            spans: E::spans(spans),
            holes: E::no_holes(FACE_HOLES, Untraced),
        }
    }
}

impl<V: ScannedVertex, P: Probe> ScannedFaces<V, P, Editable> {
    /// Converts to the faces of a compact mesh. Returns `None` if, since the last compaction, a
    /// face was deleted or an edit changed the degree of a face.
    pub fn into_compact(self) -> Option<ScannedFaces<V, P>> {
        let spans = self
            .spans
            .into_compact()
            .filter(|_| self.holes.is_empty())?;
        Some(ScannedFaces {
            corners: self.corners,
            spans,
            holes: NoHoles,
        })
    }
}

impl<V: ScannedVertex, P: Probe> From<ScannedFaces<V, P>> for ScannedFaces<V, P, Editable> {
    fn from(faces: ScannedFaces<V, P>) -> Self {
        Self {
            holes: Editable::no_holes(FACE_HOLES, faces.corners.probe()),
            corners: faces.corners,
            spans: faces.spans.into(),
        }
    }
}

impl<V: ScannedVertex, P: Probe, E: Editing> ScannedFaces<V, P, E> {
    /// Returns the same faces in tables that report their reads and writes to `probe`.
    pub fn probed<Q: Probe>(self, probe: Q) -> ScannedFaces<V, Q, E> {
        ScannedFaces {
            corners: self.corners.probed(probe.clone()),
            spans: self.spans.probed(probe.clone()),
            holes: E::probed_holes(self.holes, probe),
        }
    }

    /// Returns the probe of the tables.
    pub fn probe(&self) -> P {
        self.corners.probe()
    }

    /// Returns the number of faces; O(1).
    #[inline]
    pub fn len(&self) -> usize {
        self.spans.len() - self.holes.len()
    }

    /// Returns whether there are no faces; O(1).
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Yields the handle of every face, in order.
    #[inline]
    pub fn handles(&self) -> impl Iterator<Item = FaceId> {
        self.holes.handles(self.spans.len())
    }

    /// Returns whether `f` exists; O(1).
    #[inline]
    pub fn has(&self, f: FaceId) -> bool {
        f.index() < self.spans.len() && !self.holes.has(f.index())
    }

    /// Returns the corners of `f`, in order.
    ///
    /// # Panics
    ///
    /// Panics if `f` does not exist or was deleted.
    #[inline]
    pub fn face(&self, f: FaceId) -> &[V::Corner] {
        let corners = self.corners.read_range(self.spans.range(f));
        // This check is faster than a check for blank corners, because a loop over faces reads the
        // number of holes only once.
        if self.holes.has(f.index()) {
            deleted(f);
        }
        corners
    }

    /// Returns the vertices of `f`, in order.
    #[inline]
    pub fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = V> {
        let corners = self.face(f).iter();
        corners.map_inline(|&corner| V::from_corner(corner))
    }

    /// Returns the sides of `f`, in order.
    #[inline]
    pub fn face_edges(&self, f: FaceId) -> impl Iterator<Item = Pair<V>> + use<'_, V, P, E> {
        let corners = self.face(f);
        Pair::sides(corners.len(), |i| V::from_corner(corners[i]))
    }

    /// Scans all corners, and yields the row of every corner at a vertex in `set`, in order.
    #[inline]
    pub fn scan(
        &self,
        set: SearchSet<V, V::Set>,
    ) -> impl Iterator<Item = usize> + use<'_, V, P, E> {
        scan(&self.corners, move |block| set.hits(block))
    }

    /// Scans like [`scan`](Self::scan), but yields each corner with its face and with the vertices
    /// before and after the corner.
    #[inline]
    pub fn hits(
        &self,
        set: SearchSet<V, V::Set>,
    ) -> impl Iterator<Item = Hit<V>> + use<'_, V, P, E> {
        self.scan(set).map_inline(|corner| {
            let (face, corners) = self.spans.around(corner);
            let [before, at, after] =
                corners.map(|corner| V::from_corner(*self.corners.read(corner)));
            Hit {
                corner,
                face,
                before,
                at,
                after,
            }
        })
    }

    /// VV: yields the vertices adjacent to `v`; one scan of all corners.
    pub fn vertex_vertices(&self, v: V) -> impl Iterator<Item = V> {
        let hits = self.hits(SearchSet::One(v));
        hits.flat_map(|hit| [hit.before, hit.after]).distinct()
    }

    /// VF: yields the faces at `v`; one scan of all corners. A face has at most one corner at `v`,
    /// so no face is yielded twice.
    #[inline]
    pub fn vertex_faces(&self, v: V) -> impl Iterator<Item = FaceId> {
        let corners = self.scan(SearchSet::One(v));
        corners.map_inline(|corner| self.spans.face_of(corner))
    }

    /// EE: yields the edges that share an end with `e`; one scan of all corners. The scan is
    /// complete before the first edge is yielded, because only a complete scan shows whether `e`
    /// exists.
    pub fn edge_edges(&self, e: Pair<V>) -> impl Iterator<Item = Pair<V>> + use<V, P, E> {
        let mut edges = Vec::new();
        if !e.has(V::BLANK) {
            let hits = self.hits(SearchSet::Two(e.ends()));
            edges.extend(hits.flat_map(|hit| hit.sides()).distinct());
        }
        match edges.iter().position(|&edge| edge == e) {
            Some(itself) => drop(edges.swap_remove(itself)),
            None => edges.clear(),
        }
        edges.into_iter()
    }

    /// EF: yields the faces along `e`; one scan of all corners. A face has at most one corner at
    /// the first end of `e`, so no face is yielded twice.
    pub fn edge_faces(&self, e: Pair<V>) -> impl Iterator<Item = FaceId> {
        let [a, b] = e.ends();
        let corners = self.scan(SearchSet::One(a));
        let corners = corners.take_while(move |_| a != V::BLANK);
        corners.filter_map(move |corner| {
            let (face, [before, _, after]) = self.spans.around(corner);
            let is_other = |corner| V::from_corner(*self.corners.read(corner)) == b;
            (is_other(before) || is_other(after)).then_some(face)
        })
    }

    /// FF: yields the faces that share an edge with `f`. One scan searches for every second corner
    /// of `f`, because each side of `f` has an end at one of these corners.
    pub fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        let set = SearchSet::every_second(self.face(f));
        let mut sides: Vec<Pair<V>> = self.face_edges(f).collect();
        sides.sort_unstable();
        let is_side = move |side: Pair<V>| sides.binary_search(&side).is_ok();
        let hits = self.hits(set).filter_map(move |hit| {
            let across = hit.face != f && hit.sides().into_iter().any(&is_side);
            across.then_some(hit.face)
        });
        hits.distinct()
    }

    /// Yields the name and the bytes of each table.
    pub fn bytes(&self) -> impl Iterator<Item = TableBytes> {
        let corners = std::iter::once(self.corners.bytes());
        corners.chain(self.spans.bytes()).chain(self.holes.bytes())
    }

    /// Checks that the deleted faces are rows of `spans`, and that a corner is blank exactly if no
    /// face has the corner. The caller must check `spans` first ([`FaceSpans::check`]).
    ///
    /// # Errors
    ///
    /// Returns a description of the fault.
    pub fn check_holes(&self) -> Result<(), String> {
        self.holes.check(self.spans.len())?;
        let corners = self.corners.rows();
        let mut blank = vec![true; corners.len()];
        for f in self.handles() {
            blank[self.spans.range(f)].fill(false);
        }
        for (row, (corner, blank)) in corners.iter().zip(blank).enumerate() {
            if V::BLANK.is_at(corner) != blank {
                let (is, has) = if blank { ("is not", "no") } else { ("is", "a") };
                return Err(format!("corner {row} {is} blank, but {has} face has it"));
            }
        }
        Ok(())
    }
}

#[cold]
#[inline(never)]
fn deleted(f: FaceId) -> ! {
    panic!("no face {f}: it was deleted")
}
