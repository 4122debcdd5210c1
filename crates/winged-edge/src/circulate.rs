//! Walks around a vertex and along a face: ordinary iterators that end after one turn.

use std::collections::HashSet;

use mesh_core::{EdgeId, FaceId, Probe, Slot, VertexId};

use crate::edge::Run;
use crate::mesh::WingedEdgeMesh;

impl<P: Probe> WingedEdgeMesh<P> {
    /// Every edge at `v` run away from it, counter-clockwise; from the boundary, if `v` is on one.
    #[inline]
    pub(crate) fn runs_from(&self, v: VertexId) -> RunsFrom<'_, P> {
        let at = self.spoke(v);
        RunsFrom {
            mesh: self,
            v,
            at,
            first: at,
        }
    }

    /// Every edge of `f` run with `f` on its left, counter-clockwise.
    #[inline]
    pub(crate) fn runs_along(&self, f: FaceId) -> RunsAlong<'_, P> {
        let first = self.side(f);
        RunsAlong {
            mesh: self,
            f,
            at: Some(first),
            first,
        }
    }
}

/// The edges at a vertex, each run away from it; each record is all that its step reads.
#[derive(Clone, Debug)]
pub(crate) struct RunsFrom<'a, P: Probe> {
    mesh: &'a WingedEdgeMesh<P>,
    v: VertexId,
    at: Option<EdgeId>,
    first: Option<EdgeId>,
}

impl<'a, P: Probe> Iterator for RunsFrom<'a, P> {
    type Item = (EdgeId, Run<'a>);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let e = self.at?;
        let run = Run::from(self.mesh.edge(e), self.v);
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
            let run = Run::from(self.mesh.edge(e), self.v);
            folded = f(folded, (e, run));
            e = run.ccw();
            if e == first {
                return folded;
            }
        }
    }
}

/// The edges of a face, each run with the face on its left.
#[derive(Clone, Debug)]
pub(crate) struct RunsAlong<'a, P: Probe> {
    mesh: &'a WingedEdgeMesh<P>,
    f: FaceId,
    at: Option<EdgeId>,
    first: EdgeId,
}

impl<'a, P: Probe> Iterator for RunsAlong<'a, P> {
    type Item = (EdgeId, Run<'a>);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let e = self.at?;
        let run = Run::along(self.mesh.edge(e), self.f);
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
            let run = Run::along(self.mesh.edge(e), self.f);
            folded = f(folded, (e, run));
            e = run.next();
            if e == self.first {
                return folded;
            }
        }
    }
}

/// The edges at both ends of an edge, but for itself: two walks that begin and end at it.
#[derive(Clone, Debug)]
pub(crate) struct EdgeEdges<'a, P: Probe> {
    mesh: &'a WingedEdgeMesh<P>,
    e: EdgeId,
    v: VertexId,
    at: EdgeId,
    /// The other end, and the first edge there.
    then: Option<(VertexId, EdgeId)>,
}

impl<'a, P: Probe> EdgeEdges<'a, P> {
    #[inline]
    pub(crate) fn new(mesh: &'a WingedEdgeMesh<P>, e: EdgeId) -> Self {
        // The sides of e itself are known: it leaves its start on the left, its end on the right.
        let edge = mesh.edge(e);
        let ([v, other], [at, there]) = (edge.ends(), edge.prev());
        Self {
            mesh,
            e,
            v,
            at,
            then: Some((other, there)),
        }
    }
}

impl<P: Probe> Iterator for EdgeEdges<'_, P> {
    type Item = EdgeId;

    #[inline]
    fn next(&mut self) -> Option<EdgeId> {
        while self.at == self.e {
            (self.v, self.at) = self.then.take()?;
        }
        let edge = self.at;
        self.at = Run::from(self.mesh.edge(edge), self.v).ccw();
        Some(edge)
    }

    #[inline]
    fn fold<B, F: FnMut(B, EdgeId) -> B>(self, init: B, mut f: F) -> B {
        let Self {
            mesh,
            e,
            mut v,
            mut at,
            mut then,
        } = self;
        let mut folded = init;
        loop {
            while at != e {
                folded = f(folded, at);
                at = Run::from(mesh.edge(at), v).ccw();
            }
            match then.take() {
                Some(other) => (v, at) = other,
                None => return folded,
            }
        }
    }
}

/// How many faces are told apart by walking the face once more before a set takes over.
const FEW: usize = 32;

/// The faces across the sides of a face, each once.
///
/// Two faces may share several sides, so every answer has to be compared with those before it. The
/// last three are at hand, which is all that triangles and quads need; for larger faces the walk is
/// repeated, and beyond 32 neighbours a set keeps the whole linear.
#[derive(Clone, Debug)]
pub(crate) struct FaceFaces<'a, P: Probe> {
    runs: RunsAlong<'a, P>,
    last: [Slot<FaceId>; 3],
    found: usize,
    many: Option<HashSet<FaceId>>,
}

impl<'a, P: Probe> FaceFaces<'a, P> {
    #[inline]
    pub(crate) fn new(mesh: &'a WingedEdgeMesh<P>, f: FaceId) -> Self {
        Self {
            runs: mesh.runs_along(f),
            last: [Slot::NONE; 3],
            found: 0,
            many: None,
        }
    }

    /// The faces across the three sides, if the walk has not begun and there are three.
    #[inline]
    fn across_triangle(&self) -> Option<[Slot<FaceId>; 3]> {
        let RunsAlong { mesh, f, at, first } = self.runs;
        let a = Run::along(mesh.edge(first), f);
        let b = Run::along(mesh.edge(a.next()), f);
        let c = Run::along(mesh.edge(b.next()), f);
        let whole = at == Some(first) && c.next() == first;
        whole.then_some([a, b, c].map(Run::across))
    }

    /// Whether the face across `e` differs from all that were found before.
    #[inline]
    fn is_new(&mut self, e: EdgeId, face: Slot<FaceId>) -> bool {
        let [a, b, c] = self.last;
        if face == a || face == b || face == c {
            return false;
        }
        if self.found >= self.last.len() {
            // By value, but for the set: the walk itself is to stay in registers.
            let RunsAlong { mesh, f, .. } = self.runs;
            if !is_new_among_many(mesh.runs_along(f), e, face, self.found, &mut self.many) {
                return false;
            }
        }
        self.last = [face, a, b];
        self.found += 1;
        true
    }
}

/// Whether `face`, which is across `e`, differs from those across the sides before `e`.
#[cold]
#[inline(never)]
fn is_new_among_many<P: Probe>(
    runs: RunsAlong<'_, P>,
    e: EdgeId,
    face: Slot<FaceId>,
    found: usize,
    many: &mut Option<HashSet<FaceId>>,
) -> bool {
    let before = runs.take_while(|&(side, _)| side != e);
    let mut before = before.map(|(_, run)| run.across());
    if found < FEW {
        return before.all(|other| other != face);
    }
    let known = || before.filter_map(Slot::get).collect();
    let many = many.get_or_insert_with(known);
    face.get().is_some_and(|face| many.insert(face))
}

impl<P: Probe> Iterator for FaceFaces<'_, P> {
    type Item = FaceId;

    #[inline]
    fn next(&mut self) -> Option<FaceId> {
        loop {
            let (e, run) = self.runs.next()?;
            let across = run.across();
            if let Some(face) = across.get()
                && self.is_new(e, across)
            {
                return Some(face);
            }
        }
    }

    /// The whole answer at once, which for triangles needs three comparisons and no state.
    #[inline]
    fn fold<B, F: FnMut(B, FaceId) -> B>(self, init: B, mut f: F) -> B {
        let mut folded = init;
        if let Some([a, b, c]) = self.across_triangle() {
            if let Some(face) = a.get() {
                folded = f(folded, face);
            }
            if let Some(face) = b.get().filter(|_| b != a) {
                folded = f(folded, face);
            }
            if let Some(face) = c.get().filter(|_| c != a && c != b) {
                folded = f(folded, face);
            }
            return folded;
        }
        for face in self {
            folded = f(folded, face);
        }
        folded
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{MeshQuery, Point, PolygonMesh, Representation};

    use super::*;

    /// A polygon of `3 * petals` sides, and petals that share three sides with it each.
    fn flower(petals: u32) -> WingedEdgeMesh {
        let sides = 3 * petals;
        let corners = vec![Point::ZERO; (sides + petals) as usize];
        let petal = |p: u32| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| (3 * p + i) % sides);
            vec![d, c, b, a, sides + p]
        };
        let faces = std::iter::once((0..sides).collect()).chain((0..petals).map(petal));
        let polygons = PolygonMesh::new(corners, faces).expect("valid");
        WingedEdgeMesh::from_polygons(&polygons).expect("manifold")
    }

    #[test]
    fn a_face_of_very_many_sides_meets_each_neighbour_once() {
        let few = FEW as u32;
        for petals in [2, 3, 4, 5, few - 1, few, few + 1, few + 2, 300] {
            let mesh = flower(petals);
            let middle = FaceId::new(0);
            let expected: Vec<FaceId> = (1..=petals).map(FaceId::new).collect();
            let folded = mesh.face_faces(middle).fold(Vec::new(), |mut faces, f| {
                faces.push(f);
                faces
            });
            assert_eq!(folded, expected);
            // One by one, and the last ones in a fold: an answer may change hands on the way.
            let mut faces = mesh.face_faces(middle);
            let first = faces.next();
            let rest = faces.fold(first.into_iter().collect(), |mut faces: Vec<_>, f| {
                faces.push(f);
                faces
            });
            assert_eq!(rest, expected);
            for petal in expected {
                assert!(mesh.face_faces(petal).eq([middle]), "{petal} of {petals}");
            }
        }
    }

    #[test]
    fn a_walk_taken_up_half_way_ends_where_the_whole_does() {
        let mesh = flower(4);
        for v in mesh.vertices() {
            let whole: Vec<EdgeId> = mesh.vertex_edges(v).collect();
            let mut rest = mesh.vertex_edges(v);
            assert_eq!(rest.next(), whole.first().copied());
            assert_eq!(rest.count(), whole.len() - 1);
        }
        for f in mesh.faces() {
            let whole: Vec<EdgeId> = mesh.face_edges(f).collect();
            let mut rest = mesh.face_edges(f);
            assert_eq!(rest.next(), whole.first().copied());
            assert_eq!(rest.count(), whole.len() - 1);
        }
        for e in mesh.edges() {
            let whole: Vec<EdgeId> = mesh.edge_edges(e).collect();
            for taken in 0..=whole.len() {
                let mut rest = mesh.edge_edges(e);
                let begun: Vec<EdgeId> = rest.by_ref().take(taken).collect();
                assert_eq!(begun, whole[..taken]);
                assert_eq!(rest.count(), whole.len() - taken);
            }
        }
    }
}
