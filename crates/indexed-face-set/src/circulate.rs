//! The scan of all corners, which answers whatever the tables do not.

use mesh_core::{FaceId, Pair, Probe, VertexId, hits_in};

use crate::mesh::IndexedFaceSet;

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
            Self::One(v) => hits_in(block, |c| c == v),
            Self::Two([a, b]) => hits_in(block, |c| (c == a) | (c == b)),
            Self::Four([a, b, c, d]) => {
                hits_in(block, |x| (x == a) | (x == b) | (x == c) | (x == d))
            }
            Self::Many(set) => hits_in(block, |c| set.has(*c)),
        }
    }
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

impl<P: Probe> IndexedFaceSet<P> {
    /// Scans all corners for those that name a vertex sought, in order.
    #[inline]
    pub(crate) fn scan(&self, sought: Sought) -> impl Iterator<Item = usize> {
        self.corners.scan(move |block| sought.hits(block))
    }

    /// The sides that end at a vertex sought, once for each face along them, or twice.
    #[inline]
    pub(crate) fn sides_at(&self, sought: Sought) -> impl Iterator<Item = Pair<VertexId>> {
        self.scan(sought).flat_map(|corner| {
            let (_, [before, at, after]) = self.around(corner);
            [Pair::new(before, at), Pair::new(at, after)]
        })
    }

    /// The sides of `f`, in order.
    #[inline]
    pub(crate) fn sides_of(&self, f: FaceId) -> impl Iterator<Item = Pair<VertexId>> {
        let corners = self.face(f);
        Pair::sides(corners.len(), |i| corners[i])
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
            let mut sides = Pair::sides(degree, |i| face[i]).map(Pair::ends);
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
