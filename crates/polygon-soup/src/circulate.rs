//! The sweep over all corners, which answers whatever the tables do not.

use mesh_core::{FaceId, Pair, Point, Probe, hits_in};
use rustc_hash::FxHashSet;

use crate::mesh::PolygonSoup;
use crate::vertex::SoupVertex;

/// The vertices that a sweep looks for.
#[derive(Clone, Debug)]
pub(crate) enum Sought {
    One(SoupVertex),
    Two([SoupVertex; 2]),
    Many(FxHashSet<SoupVertex>),
}

impl Sought {
    /// Which corners of a block are at one of the vertices, as bits.
    #[inline]
    fn hits(&self, block: &[Point]) -> u64 {
        match self {
            Self::One(v) => hits_in(block, |p| v.holds(p)),
            Self::Two([a, b]) => hits_in(block, |p| a.holds(p) | b.holds(p)),
            Self::Many(vertices) => hits_in(block, |p| vertices.contains(&SoupVertex::at(*p))),
        }
    }
}

impl<P: Probe> PolygonSoup<P> {
    /// Sweeps over all corners for those at the vertices sought, in order.
    #[inline]
    pub(crate) fn sweep(&self, sought: Sought) -> impl Iterator<Item = usize> {
        self.corners.scan(move |block| sought.hits(block))
    }

    /// The sides that end at the vertices sought, one for each face along them.
    #[inline]
    pub(crate) fn sides_at(&self, sought: Sought) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.sweep(sought).flat_map(|corner| {
            let (_, [before, at, after]) = self.around(corner);
            [Pair::new(before, at), Pair::new(at, after)]
        })
    }

    /// The sides of `f`, in order.
    #[inline]
    pub(crate) fn sides_of(&self, f: FaceId) -> impl Iterator<Item = Pair<SoupVertex>> {
        let corners = self.face_positions(f);
        Pair::sides(corners.len(), |i| SoupVertex::at(corners[i]))
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{MeshQuery, PolygonMesh, Representation, Traced};

    use super::*;

    /// A fan of `sides` triangles around the origin.
    fn fan(sides: u32) -> PolygonSoup {
        let rim = (0..sides).map(|i| Point::new(1.0, i as f32, 0.0));
        let positions: Vec<Point> = std::iter::once(Point::ZERO).chain(rim).collect();
        let faces = (1..sides).map(|i| [i, i + 1, 0]);
        PolygonSoup::from_polygons(&PolygonMesh::new(positions, faces).expect("valid"))
            .expect("held")
    }

    #[test]
    fn a_sweep_finds_the_corners_of_whole_and_of_broken_blocks() {
        for sides in [2, 10, 11, 12, 21, 22, 23, 24, 33, 100] {
            let soup = fan(sides);
            let hub = SoupVertex::at(Point::ZERO);
            let last = SoupVertex::at(Point::new(1.0, (sides - 1) as f32, 0.0));
            let corners: Vec<usize> = soup.sweep(Sought::One(hub)).collect();
            let expected: Vec<usize> = (2..soup.corners.len()).step_by(3).collect();
            assert_eq!(corners, expected, "{sides} sides");
            let either = soup.sweep(Sought::Two([hub, last])).count();
            let many = soup
                .sweep(Sought::Many([hub, last].into_iter().collect()))
                .count();
            assert_eq!((either, many), (expected.len() + 1, expected.len() + 1));
            let nowhere = SoupVertex::at(Point::NEG_ONE);
            assert_eq!(soup.sweep(Sought::One(nowhere)).next(), None);
        }
    }

    #[test]
    fn a_query_reads_every_corner_once_and_looks_around_its_hits() {
        let probe = Traced::default();
        let soup = fan(101);
        let far = SoupVertex::at(Point::new(1.0, 50.0, 0.0));
        let soup = soup.probed(probe.clone());
        assert_eq!(soup.vertex_faces(far).count(), 2);
        assert_eq!(probe.take().len(), 300);
        assert_eq!(soup.vertex_vertices(far).count(), 3);
        assert_eq!(probe.take().len(), 300 + 2 * 3);
    }
}
