//! Walks around a vertex and along a face, as iterators that end after one turn.

use sixfold_core::{EdgeId, Editing, FaceId, Probe, VertexId};

use crate::edge::Run;
use crate::mesh::WingedEdgeMesh;

impl<P: Probe, E: Editing> WingedEdgeMesh<E, P> {
    /// Iterates over the runs that leave `v`, counter-clockwise. At a boundary vertex, starts on
    /// the boundary.
    #[inline]
    pub(crate) fn runs_from(&self, v: VertexId) -> RunsFrom<'_, P, E> {
        let at = self.spoke(v);
        RunsFrom {
            mesh: self,
            v,
            at,
            first: at,
        }
    }

    /// Iterates over the runs with `f` on their left, counter-clockwise.
    #[inline]
    pub(crate) fn runs_along(&self, f: FaceId) -> RunsAlong<'_, P, E> {
        let first = self.side(f);
        RunsAlong {
            mesh: self,
            f,
            at: Some(first),
            first,
        }
    }
}

/// The runs that leave a vertex, each with its edge. A step reads one record.
#[derive(Clone, Debug)]
pub(crate) struct RunsFrom<'a, P: Probe, E: Editing> {
    mesh: &'a WingedEdgeMesh<E, P>,
    v: VertexId,
    at: Option<EdgeId>,
    first: Option<EdgeId>,
}

impl<'a, P: Probe, E: Editing> Iterator for RunsFrom<'a, P, E> {
    type Item = (EdgeId, Run<'a>);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let e = self.at?;
        let run = Run::from(self.mesh.record(e), self.v);
        let turned = Some(run.ccw());
        self.at = if turned == self.first { None } else { turned };
        Some((e, run))
    }

    #[inline]
    fn fold<B, F: FnMut(B, Self::Item) -> B>(self, init: B, mut f: F) -> B {
        let (Some(mut e), Some(first)) = (self.at, self.first) else {
            return init;
        };
        let mut folded = init;
        loop {
            let run = Run::from(self.mesh.record(e), self.v);
            folded = f(folded, (e, run));
            e = run.ccw();
            if e == first {
                return folded;
            }
        }
    }
}

/// The runs along a face, each with its edge. A step reads one record.
#[derive(Clone, Debug)]
pub(crate) struct RunsAlong<'a, P: Probe, E: Editing> {
    mesh: &'a WingedEdgeMesh<E, P>,
    f: FaceId,
    at: Option<EdgeId>,
    first: EdgeId,
}

impl<'a, P: Probe, E: Editing> Iterator for RunsAlong<'a, P, E> {
    type Item = (EdgeId, Run<'a>);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let e = self.at?;
        let run = Run::along(self.mesh.record(e), self.f);
        self.at = (run.next() != self.first).then_some(run.next());
        Some((e, run))
    }

    #[inline]
    fn fold<B, F: FnMut(B, Self::Item) -> B>(self, init: B, mut f: F) -> B {
        let Some(mut e) = self.at else {
            return init;
        };
        let mut folded = init;
        loop {
            let run = Run::along(self.mesh.record(e), self.f);
            folded = f(folded, (e, run));
            e = run.next();
            if e == self.first {
                return folded;
            }
        }
    }
}

/// The edges at both ends of an edge, except the edge itself. One walk around each end starts and
/// stops at the edge itself.
#[derive(Clone, Debug)]
pub(crate) struct EdgeEdges<'a, P: Probe, E: Editing> {
    mesh: &'a WingedEdgeMesh<E, P>,
    e: EdgeId,
    v: VertexId,
    at: EdgeId,
    /// The other end and its first edge; `None` during the walk around the other end.
    next_walk: Option<(VertexId, EdgeId)>,
}

impl<'a, P: Probe, E: Editing> EdgeEdges<'a, P, E> {
    #[inline]
    pub(crate) fn new(mesh: &'a WingedEdgeMesh<E, P>, e: EdgeId) -> Self {
        // The left run of e leaves the start, and the right run leaves the end.
        let edge = mesh.edge(e);
        let ([v, other], [at, there]) = (edge.ends(), edge.prev());
        Self {
            mesh,
            e,
            v,
            at,
            next_walk: Some((other, there)),
        }
    }
}

impl<P: Probe, E: Editing> Iterator for EdgeEdges<'_, P, E> {
    type Item = EdgeId;

    #[inline]
    fn next(&mut self) -> Option<EdgeId> {
        while self.at == self.e {
            (self.v, self.at) = self.next_walk.take()?;
        }
        let edge = self.at;
        self.at = Run::from(self.mesh.record(edge), self.v).ccw();
        Some(edge)
    }

    #[inline]
    fn fold<B, F: FnMut(B, EdgeId) -> B>(self, init: B, mut f: F) -> B {
        let Self {
            mesh,
            e,
            mut v,
            mut at,
            mut next_walk,
        } = self;
        let mut folded = init;
        loop {
            while at != e {
                folded = f(folded, at);
                at = Run::from(mesh.record(at), v).ccw();
            }
            match next_walk.take() {
                Some(other) => (v, at) = other,
                None => return folded,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation};

    use super::*;
    use crate::WingedEdgeMesh;

    /// Builds a polygon and `count` neighbours. Each neighbour shares three sides with the polygon.
    fn polygon_with_neighbours(count: u32) -> WingedEdgeMesh {
        let sides = 3 * count;
        let corners = vec![Point::ZERO; (sides + count) as usize];
        let neighbour = |n: u32| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| (3 * n + i) % sides);
            vec![d, c, b, a, sides + n]
        };
        let faces = std::iter::once((0..sides).collect()).chain((0..count).map(neighbour));
        let polygons = PolygonMesh::new(corners, faces).expect("valid");
        WingedEdgeMesh::from_polygons(&polygons).expect("manifold")
    }

    #[test]
    fn a_face_with_many_sides_lists_each_neighbour_once() {
        for count in [2, 3, 4, 5, 31, 32, 33, 34, 300] {
            let mesh = polygon_with_neighbours(count);
            let middle = FaceId::new(0);
            let expected: Vec<FaceId> = (1..=count).map(FaceId::new).collect();
            let folded = mesh.face_faces(middle).fold(Vec::new(), |mut faces, f| {
                faces.push(f);
                faces
            });
            assert_eq!(folded, expected);
            // The test calls `next` for the first item and `fold` for all other items.
            let mut faces = mesh.face_faces(middle);
            let first = faces.next();
            let rest = faces.fold(first.into_iter().collect(), |mut faces: Vec<_>, f| {
                faces.push(f);
                faces
            });
            assert_eq!(rest, expected);
            for neighbour in expected {
                let is_only_neighbour = mesh.face_faces(neighbour).eq([middle]);
                assert!(is_only_neighbour, "{neighbour} of {count}");
            }
        }
    }
}
