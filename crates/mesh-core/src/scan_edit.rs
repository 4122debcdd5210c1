//! The edits of structures that scan: what is legal, what becomes of the faces, and what is told.
//!
//! Each is given the name of a new vertex beforehand, checks everything, and then changes the faces
//! alone; the table of vertices, where there is one, follows in the structure. What a scan has found
//! is kept for that one edit, and on the stack where it is short.
//!
//! Where nobody listens, an edit of one face looks at that face only: which of its sides and corners
//! others have, too, nobody asks then, and these structures need not know.

mod collapse;
mod edges;
mod faces;
mod split_vertex;

use crate::edit_error::EditError;
use crate::edit_log::EditLog;
use crate::editing::Editable;
use crate::few::Few;
use crate::handle::Pair;
use crate::probe::Probe;
use crate::query::MeshQuery;
use crate::row_id::{FaceId, MAX_ROWS};
use crate::scanned::{Hit, ScannedFaces, ScannedVertex, Sought};

type Refusal<V> = EditError<V, Pair<V>, FaceId>;

/// A mesh that names its elements as [`ScannedFaces`] does.
pub trait ScannedMesh<V>: MeshQuery<Vertex = V, Edge = Pair<V>, Face = FaceId> {}

impl<V, M: MeshQuery<Vertex = V, Edge = Pair<V>, Face = FaceId>> ScannedMesh<V> for M {}

/// Whether anybody hears what `L` is told.
const fn listens<M: MeshQuery, L: EditLog<M>>(_: &L) -> bool {
    L::LISTENS
}

/// The shared steps.
impl<V: ScannedVertex, P: Probe> ScannedFaces<V, P, Editable> {
    /// `f`, if it is there.
    fn existing(&self, f: FaceId) -> Result<FaceId, Refusal<V>> {
        if self.has(f) {
            Ok(f)
        } else {
            Err(EditError::NoSuchFace { face: f })
        }
    }

    fn degree(&self, f: FaceId) -> usize {
        self.spans.range(f).len()
    }

    /// Whether handles can name that many more faces and corners. A face that grows moves, and takes
    /// rows for all its corners.
    fn room(&self, faces: usize, corners: usize) -> Result<(), Refusal<V>> {
        let full = |elements| EditError::TooMany {
            elements,
            limit: MAX_ROWS,
        };
        if self.spans.len() + faces > MAX_ROWS {
            return Err(full("faces"));
        }
        if self.corners.len() + corners > MAX_ROWS {
            return Err(full("corners"));
        }
        Ok(())
    }

    /// Whether `v` is a vertex by being the place of a corner; one scan.
    pub fn has_vertex(&self, v: V) -> bool {
        self.scan(Sought::One(v)).next().is_some()
    }

    /// The corners at `v`. Where a vertex is its coordinates, `m` is a place that must be free; the
    /// same scan sees to it.
    fn around(&self, v: V, m: V) -> Result<Few<Hit<V>>, Refusal<V>> {
        let sought = if V::IS_PLACE {
            Sought::Two([v, m])
        } else {
            Sought::One(v)
        };
        let (mut around, mut occupied) = (Few::new(), false);
        for hit in self.hits(sought) {
            occupied |= hit.at == m;
            if hit.at == v {
                around.push(hit);
            }
        }
        if V::IS_PLACE && around.is_empty() {
            return Err(EditError::NoSuchVertex { vertex: v });
        }
        if occupied {
            return Err(EditError::Occupied { vertex: m });
        }
        Ok(around)
    }

    /// The corners of `f` from `corner` on, all the way round.
    fn corners_from(&self, f: FaceId, corner: usize) -> impl Iterator<Item = V::Corner> {
        let range = self.spans.range(f);
        let round = (corner..range.end).chain(range.start..corner);
        round.map(|corner| *self.corners.read(corner))
    }

    fn push(&mut self, face: &[V::Corner]) -> FaceId {
        self.spans.push(&mut self.corners, face)
    }

    fn push_triangle(&mut self, triangle: [V; 3]) -> FaceId {
        self.push(&triangle.map(V::corner))
    }

    fn rewrite(&mut self, f: FaceId, face: &[V::Corner]) {
        self.spans
            .rewrite(&mut self.corners, f, face, V::BLANK.corner());
    }

    /// Puts one corner at another vertex.
    fn retarget(&mut self, corner: usize, v: V) {
        *self.corners.write(corner) = v.corner();
    }

    fn delete(&mut self, f: FaceId) {
        self.spans.blank(&mut self.corners, f, V::BLANK.corner());
        self.holes.dig(f.index());
    }

    /// Closes up the faces; the structure tells of its vertices and edges. O(corners).
    pub fn compact<M: ScannedMesh<V>>(&mut self, log: &mut impl EditLog<M>) {
        if listens(log) {
            for (new, old) in (0..).map(FaceId::new).zip(self.handles()) {
                if new != old {
                    log.renamed_face(old, new);
                }
            }
        }
        self.spans.compact(&mut self.corners, &self.holes);
        self.holes.fill();
    }
}

/// The first item that the list has a second time; O(n²) while it is short, else O(n log n).
fn repeated<T: Ord + Copy>(items: &[T]) -> Option<T> {
    if items.len() <= 16 {
        let mut later = items.iter().enumerate();
        return later.find_map(|(i, item)| items[..i].contains(item).then_some(*item));
    }
    let mut sorted = items.to_vec();
    sorted.sort_unstable();
    let mut pairs = sorted.windows(2);
    pairs.find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
}

/// The items in order, each once.
fn sorted_once<T: Ord>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut items: Vec<T> = items.collect();
    items.sort_unstable();
    items.dedup();
    items
}
