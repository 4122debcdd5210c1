//! The scan of all corners, which answers whatever the tables do not, and the pass over all edges.

use mesh_core::{FaceId, FaceSpans, Pair, Probe, VertexId, row};

use crate::mesh::IndexedFaceSet;

/// How many corners one step of a scan looks at.
const BLOCK: usize = 64;

/// The vertices that a scan looks for.
#[derive(Clone, Debug)]
pub(crate) enum Sought {
    One(VertexId),
    Two([VertexId; 2]),
    /// Up to four, some perhaps repeated.
    Four([VertexId; 4]),
    Many(VertexSet),
}

impl Sought {
    /// Every second corner of a face: all its sides end at one of them.
    pub(crate) fn every_second(corners: &[VertexId], vertices: usize) -> Self {
        match *corners {
            [a, _, c] | [a, _, c, _] => Self::Two([a, c]),
            [a, _, c, _, e] | [a, _, c, _, e, _] => Self::Four([a, c, e, e]),
            [a, _, c, _, e, _, g] | [a, _, c, _, e, _, g, _] => Self::Four([a, c, e, g]),
            _ => Self::Many(VertexSet::of(corners.iter().step_by(2).copied(), vertices)),
        }
    }

    /// Which corners of a block name one of the vertices, as bits.
    #[inline]
    fn hits(&self, block: &[VertexId]) -> u64 {
        match self {
            Self::One(v) => hits(block, |c| c == *v),
            Self::Two([a, b]) => hits(block, |c| (c == *a) | (c == *b)),
            Self::Four([a, b, c, d]) => {
                hits(block, |x| (x == *a) | (x == *b) | (x == *c) | (x == *d))
            }
            Self::Many(set) => bits(block, |c| set.has(c)),
        }
    }
}

/// Which corners of a block are sought, as bits.
///
/// Hardly any block has such a corner. So the first question is whether there is one at all, with
/// no branch inside, which compiles to vector instructions; only then are the corners told apart.
#[inline]
fn hits(block: &[VertexId], sought: impl Fn(VertexId) -> bool) -> u64 {
    if let Ok(block) = <&[VertexId; BLOCK]>::try_from(block)
        && !block.iter().fold(false, |any, &c| any | sought(c))
    {
        return 0;
    }
    bits(block, sought)
}

#[inline]
fn bits(block: &[VertexId], sought: impl Fn(VertexId) -> bool) -> u64 {
    let bits = block
        .iter()
        .zip(0..)
        .map(|(&c, i)| u64::from(sought(c)) << i);
    bits.fold(0, |mask, bit| mask | bit)
}

/// A set of vertices, a bit for each vertex of the mesh.
#[derive(Clone, Debug)]
pub(crate) struct VertexSet(Vec<u64>);

impl VertexSet {
    fn of(members: impl Iterator<Item = VertexId>, vertices: usize) -> Self {
        let mut words = vec![0; vertices.div_ceil(64)];
        for v in members {
            words[v.index() / 64] |= 1 << (v.index() % 64);
        }
        Self(words)
    }

    #[inline]
    fn has(&self, v: VertexId) -> bool {
        self.0[v.index() / 64] >> (v.index() % 64) & 1 == 1
    }
}

/// The corners that name a vertex sought, in order: one pass over the table of corners.
#[derive(Clone, Debug)]
pub(crate) struct Scan<'a, P: Probe> {
    mesh: &'a IndexedFaceSet<P>,
    sought: Sought,
    /// The first corner of the present block.
    block: usize,
    /// The first corner that no block has covered yet.
    next: usize,
    /// The hits in the present block that are still to be yielded.
    hits: u64,
}

impl<P: Probe> Iterator for Scan<'_, P> {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        let corners = &self.mesh.corners;
        while self.hits == 0 {
            if self.next == corners.len() {
                return None;
            }
            self.block = self.next;
            self.next = (self.next + BLOCK).min(corners.len());
            self.hits = self.sought.hits(corners.read_range(self.block..self.next));
        }
        let corner = self.block + self.hits.trailing_zeros() as usize;
        self.hits &= self.hits - 1;
        Some(corner)
    }
}

impl<P: Probe> IndexedFaceSet<P> {
    /// Scans all corners for those that name a vertex sought.
    #[inline]
    pub(crate) fn scan(&self, sought: Sought) -> Scan<'_, P> {
        Scan {
            mesh: self,
            sought,
            block: 0,
            next: 0,
            hits: 0,
        }
    }

    /// The sides that end at a vertex sought, once for each face along them, or twice.
    #[inline]
    pub(crate) fn sides_at(&self, sought: Sought) -> impl Iterator<Item = Pair<VertexId>> {
        self.scan(sought).flat_map(|corner| {
            let (_, [before, at, after]) = self.around(corner);
            [Pair::new(before, at), Pair::new(at, after)]
        })
    }

    /// The sides of `f`: side `i` joins corners `i` and `i + 1`.
    #[inline]
    pub(crate) fn sides_of(&self, f: FaceId) -> impl Iterator<Item = Pair<VertexId>> {
        sides(self.face(f))
    }

    /// Every edge once, at its lower end.
    ///
    /// The higher ends are put into one bucket for each lower end (a counting sort over all sides);
    /// in a bucket, each is yielded when it is new there. O(corners + vertices).
    pub(crate) fn all_edges(&self) -> impl Iterator<Item = Pair<VertexId>> {
        let vertices = self.positions.len();
        // By vertex: how many sides have it as their lower end, then where its bucket ends.
        let mut ends = vec![0_u32; vertices];
        self.for_each_side(|low, _| ends[low.index()] += 1);
        let mut total = 0;
        for end in &mut ends {
            total += std::mem::replace(end, total);
        }
        let mut higher = vec![VertexId::new(0); total as usize];
        self.for_each_side(|low, high| {
            let end = &mut ends[low.index()];
            higher[*end as usize] = high;
            *end += 1;
        });
        // By higher end: the lower end that met it last. No vertex is lower than itself.
        let mut met: Vec<u32> = (0..row(vertices)).collect();
        let (mut low, mut at) = (0_u32, 0);
        std::iter::from_fn(move || {
            loop {
                let high = *higher.get(at)?;
                while ends[low as usize] as usize == at {
                    low += 1;
                }
                at += 1;
                if std::mem::replace(&mut met[high.index()], low) != low {
                    return Some(Pair::new(VertexId::new(low), high));
                }
            }
        })
    }

    /// Calls `visit` with the lower and the higher end of every side of every face.
    #[inline(always)]
    fn for_each_side(&self, mut visit: impl FnMut(VertexId, VertexId)) {
        let mut visit = |a: VertexId, b: VertexId| visit(a.min(b), a.max(b));
        let corners = || self.corners.read_range(0..self.corners.len());
        match &self.spans {
            FaceSpans::Uniform { degree: 3, .. } => sides_of_uniform::<3>(corners(), visit),
            FaceSpans::Uniform { degree: 4, .. } => sides_of_uniform::<4>(corners(), visit),
            _ => {
                for f in 0..row(self.spans.len()) {
                    for side in self.sides_of(FaceId::new(f)) {
                        let [low, high] = side.ends();
                        visit(low, high);
                    }
                }
            }
        }
    }
}

/// The sides of a face with these corners: side `i` joins corners `i` and `i + 1`.
#[inline]
fn sides(corners: &[VertexId]) -> impl Iterator<Item = Pair<VertexId>> {
    let last = corners.len() - 1;
    corners.iter().enumerate().map(move |(i, &a)| {
        let next = if i == last { 0 } else { i + 1 };
        Pair::new(a, corners[next])
    })
}

/// Visits the sides of faces whose degree the compiler knows: it unrolls the face.
#[inline(always)]
fn sides_of_uniform<const DEGREE: usize>(
    corners: &[VertexId],
    mut visit: impl FnMut(VertexId, VertexId),
) {
    for face in corners.as_chunks::<DEGREE>().0 {
        for i in 0..DEGREE {
            visit(face[i], face[(i + 1) % DEGREE]);
        }
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{MeshQuery, Point, PolygonMesh, Representation};

    use super::*;

    /// A strip of triangles, its corners in as many blocks as may be and one more in part.
    fn strip(faces: u32) -> IndexedFaceSet {
        let corners = vec![Point::ZERO; faces as usize + 2];
        let faces = (0..faces).map(|f| [f, f + 1, f + 2]);
        let polygons = PolygonMesh::new(corners, faces).expect("valid");
        IndexedFaceSet::from_polygons(&polygons).expect("anything is held")
    }

    #[test]
    fn a_scan_finds_what_a_search_finds_at_every_block_boundary() {
        for faces in [1, 20, 21, 22, 42, 43, 64, 65] {
            let mesh = strip(faces);
            let v = |i: u32| VertexId::new(i % (faces + 2));
            for i in 0..faces + 2 {
                let four = [i, i + 7, i + 1, i + 30].map(v);
                for (sought, vertices) in [
                    (Sought::One(v(i)), &four[..1]),
                    (Sought::Two([four[0], four[1]]), &four[..2]),
                    (Sought::Four(four), &four[..]),
                    (
                        Sought::Many(VertexSet::of(four.into_iter(), mesh.vertex_count())),
                        &four[..],
                    ),
                ] {
                    let all = 0..mesh.corners().len();
                    let expected = all.filter(|&c| vertices.contains(&mesh.corners()[c]));
                    assert!(
                        mesh.scan(sought).eq(expected),
                        "{vertices:?} of {faces} faces"
                    );
                }
            }
        }
    }

    #[test]
    fn every_side_ends_at_a_second_corner() {
        let face: Vec<VertexId> = (0..20).map(VertexId::new).collect();
        for degree in 3..=face.len() {
            let face = &face[..degree];
            let sought = Sought::every_second(face, face.len());
            let hits = sought.hits(face);
            let is_hit = |v: VertexId| hits >> v.index() & 1 == 1;
            let mut sides = sides(face).map(Pair::ends);
            assert!(
                sides.all(|[a, b]| is_hit(a) || is_hit(b)),
                "degree {degree}"
            );
            assert_eq!(
                hits.count_ones() as usize,
                degree.div_ceil(2),
                "degree {degree}"
            );
        }
    }

    #[test]
    fn a_vertex_of_very_many_faces_has_each_edge_once() {
        let faces = 1_000;
        let corners = vec![Point::ZERO; faces as usize + 2];
        // All around v0, which is the lower end of every spoke, each of them shared by two faces.
        let fan = (1..=faces).map(|f| [0, f, f + 1]);
        let mesh = PolygonMesh::new(corners, fan).expect("valid");
        let mesh = IndexedFaceSet::from_polygons(&mesh).expect("anything is held");
        assert_eq!(mesh.edge_count(), 2 * faces as usize + 1);
        assert_eq!(
            mesh.vertex_edges(VertexId::new(0)).count(),
            faces as usize + 1
        );
    }
}
