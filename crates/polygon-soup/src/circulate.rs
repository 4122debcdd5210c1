//! The sweep over all corners, which answers whatever the tables do not.

use mesh_core::{FaceId, Pair, Point, Probe};
use rustc_hash::FxHashSet;

use crate::mesh::PolygonSoup;
use crate::vertex::SoupVertex;

/// How many corners one step of a sweep looks at.
const BLOCK: usize = 32;

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
    fn hits(&self, block: &[Point]) -> u32 {
        match self {
            Self::One(v) => hits(block, *v),
            Self::Two([a, b]) => hits(block, *a) | hits(block, *b),
            Self::Many(vertices) => mask(block, |p| vertices.contains(&SoupVertex::at(*p))),
        }
    }
}

/// Which corners of a block are at `v`, as bits.
///
/// Hardly any block has such a corner. So the first question is whether there is one at all, with no
/// branch inside, which compiles to vector instructions; only then are the corners told apart.
#[inline]
fn hits(block: &[Point], v: SoupVertex) -> u32 {
    if let Ok(block) = <&[Point; BLOCK]>::try_from(block) {
        let any = block.iter().fold(false, |any, p| any | v.holds(p));
        if !any {
            return 0;
        }
    }
    mask(block, |p| v.holds(p))
}

#[inline]
fn mask(block: &[Point], holds: impl Fn(&Point) -> bool) -> u32 {
    let bits = block.iter().zip(0..).map(|(p, i)| u32::from(holds(p)) << i);
    bits.fold(0, |mask, bit| mask | bit)
}

/// The corners at the vertices sought, in order: one sweep over the corner table.
#[derive(Clone, Debug)]
pub(crate) struct Sweep<'a, P: Probe> {
    mesh: &'a PolygonSoup<P>,
    sought: Sought,
    /// The first corner that no block has covered yet.
    next: usize,
    /// The first corner of the present block.
    block: usize,
    /// The hits in the present block that are still to be yielded.
    hits: u32,
}

impl<P: Probe> Iterator for Sweep<'_, P> {
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
            let block = corners.read_range(self.block..self.next);
            self.hits = self.sought.hits(block);
        }
        let corner = self.block + self.hits.trailing_zeros() as usize;
        self.hits &= self.hits - 1;
        Some(corner)
    }
}

impl<P: Probe> PolygonSoup<P> {
    /// Sweeps over all corners for those at the vertices sought.
    #[inline]
    pub(crate) fn sweep(&self, sought: Sought) -> Sweep<'_, P> {
        Sweep {
            mesh: self,
            sought,
            next: 0,
            block: 0,
            hits: 0,
        }
    }

    /// The sides that end at the vertices sought, one for each face along them.
    #[inline]
    pub(crate) fn sides_at(&self, sought: Sought) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.sweep(sought).flat_map(|corner| {
            let (_, [before, at, after]) = self.around(corner);
            [Pair::new(before, at), Pair::new(at, after)]
        })
    }

    /// The sides of `f`: side `i` joins corners `i` and `i + 1`.
    #[inline]
    pub(crate) fn sides_of(&self, f: FaceId) -> impl Iterator<Item = Pair<SoupVertex>> {
        let corners = self.face_positions(f);
        let vertex = |i: usize| SoupVertex::at(corners[i]);
        (0..corners.len()).map(move |i| {
            let next = if i + 1 == corners.len() { 0 } else { i + 1 };
            Pair::new(vertex(i), vertex(next))
        })
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
