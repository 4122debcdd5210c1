//! The handles of one structure for the elements of a route, and the operations on them.

use std::hint::black_box;
use std::ops::Range;

use sixfold::{MeshQuery, Point, PolygonMesh, Relation, Representation, VertexId};

use crate::candidate::edge_name;
use crate::mix::route::Route;
use crate::operation::Kind;
use crate::sweeps::Sink;
use crate::workload::Action;

/// The elements of a route as handles of one structure.
pub(crate) struct Streams<M: MeshQuery> {
    vertices: Vec<M::Vertex>,
    edges: Vec<M::Edge>,
    faces: Vec<M::Face>,
}

impl<M: MeshQuery> Streams<M> {
    /// Lists all elements in the order of the structure.
    pub(crate) fn own(mesh: &M) -> Self {
        Self {
            vertices: mesh.vertices().collect(),
            edges: mesh.edges().collect(),
            faces: mesh.faces().collect(),
        }
    }

    /// Converts the handles to those of another mesh for the same elements.
    pub(crate) fn renamed<N: MeshQuery>(
        self,
        vertex: impl FnMut(M::Vertex) -> N::Vertex,
        edge: impl FnMut(M::Edge) -> N::Edge,
        face: impl FnMut(M::Face) -> N::Face,
    ) -> Streams<N> {
        Streams {
            vertices: self.vertices.into_iter().map(vertex).collect(),
            edges: self.edges.into_iter().map(edge).collect(),
            faces: self.faces.into_iter().map(face).collect(),
        }
    }

    /// Returns the number of elements of `kind`.
    pub(crate) fn len(&self, kind: Kind) -> usize {
        match kind {
            Kind::Vertex => self.vertices.len(),
            Kind::Edge => self.edges.len(),
            Kind::Face => self.faces.len(),
        }
    }

    /// Runs `action` on the elements of the operations `range`. Returns the number of elements that
    /// it yielded, or of positions that it read.
    #[inline(never)]
    pub(crate) fn ask(&self, mesh: &M, action: Action, range: Range<u64>) -> u64 {
        let (v, e, f) = (&self.vertices, &self.edges, &self.faces);
        match action {
            Action::Relation(relation) => match relation {
                Relation::VertexVertices => sink(v, range, |s, v| s.take(mesh.vertex_vertices(v))),
                Relation::VertexEdges => sink(v, range, |s, v| s.take(mesh.vertex_edges(v))),
                Relation::VertexFaces => sink(v, range, |s, v| s.take(mesh.vertex_faces(v))),
                Relation::EdgeVertices => sink(e, range, |s, e| s.take(mesh.edge_vertices(e))),
                Relation::EdgeEdges => sink(e, range, |s, e| s.take(mesh.edge_edges(e))),
                Relation::EdgeFaces => sink(e, range, |s, e| s.take(mesh.edge_faces(e))),
                Relation::FaceVertices => sink(f, range, |s, f| s.take(mesh.face_vertices(f))),
                Relation::FaceEdges => sink(f, range, |s, f| s.take(mesh.face_edges(f))),
                Relation::FaceFaces => sink(f, range, |s, f| s.take(mesh.face_faces(f))),
            },
            Action::Position => sum(v, range, |sum, v| {
                *sum += mesh.position(v);
                1
            }),
            Action::NeighbourPositions => sum(v, range, |sum, v| {
                positions(mesh, mesh.vertex_vertices(v), sum)
            }),
            Action::CornerPositions => sum(f, range, |sum, f| {
                positions(mesh, mesh.face_vertices(f), sum)
            }),
            Action::EndPositions => sum(e, range, |sum, e| {
                positions(mesh, mesh.edge_vertices(e).into_iter(), sum)
            }),
            // The callers run actions that write, and passes.
            Action::SetPosition | Action::Edit(_) | Action::Pass(_) | Action::Subdivide => 0,
        }
    }

    /// Returns the vertices of the operations `range`, as one or more slices.
    pub(crate) fn vertices(&self, range: Range<u64>) -> impl Iterator<Item = &[M::Vertex]> {
        runs(&self.vertices, range)
    }
}

impl<M: Representation> Streams<M> {
    /// Looks up the handles of `route` on `mesh`, which was built from `polygons`. Leaves out the
    /// vertices that are `taken`, and the edges and faces that have such a vertex.
    pub(crate) fn along(route: &Route, mesh: &M, polygons: &PolygonMesh, taken: &[bool]) -> Self {
        let free = |v: &VertexId| !taken.get(v.index()).is_some_and(|&taken| taken);
        if route.own && taken.is_empty() {
            return Self::own(mesh);
        }
        if route.own {
            // In the order of the structure, without the elements near an edit.
            let mut barred = mesh.vertex_map(false);
            for v in polygons.vertices().filter(|v| !free(v)) {
                barred[M::vertex_name(polygons, v)] = true;
            }
            let mut own = Self::own(mesh);
            own.vertices.retain(|&v| !barred[v]);
            own.edges
                .retain(|&e| !mesh.edge_vertices(e).iter().any(|&v| barred[v]));
            own.faces
                .retain(|&f| !mesh.face_vertices(f).any(|v| barred[v]));
            return own;
        }
        let vertices = route.vertices.iter().filter(|v| free(v));
        let edges = route.edges.iter().filter(|side| side.ends.iter().all(free));
        let free_face = |f: &&sixfold::FaceId| polygons.faces().face(**f).iter().all(free);
        let faces = route.faces.iter().filter(free_face);
        Self {
            vertices: vertices.map(|&v| M::vertex_name(polygons, v)).collect(),
            edges: edges.map(|&side| edge_name(mesh, polygons, side)).collect(),
            faces: faces.map(|&f| M::face_name(polygons, f)).collect(),
        }
    }
}

/// Returns the handles of the operations `range` as one or more slices. After the last handle comes
/// the first again.
fn runs<H>(handles: &[H], range: Range<u64>) -> impl Iterator<Item = &[H]> {
    let all = handles.len() as u64;
    let mut left = if all == 0 { 0 } else { range.end - range.start };
    let mut start = if all == 0 { 0 } else { range.start % all };
    std::iter::from_fn(move || {
        if left == 0 {
            return None;
        }
        let end = all.min(start + left);
        let run = &handles[start as usize..end as usize];
        left -= end - start;
        start = 0;
        Some(run)
    })
}

#[inline(always)]
fn sink<H: Copy>(handles: &[H], range: Range<u64>, mut ask: impl FnMut(&mut Sink, H)) -> u64 {
    let mut sink = Sink::default();
    for run in runs(handles, range) {
        run.iter().for_each(|&handle| ask(&mut sink, handle));
    }
    sink.swallow()
}

#[inline(always)]
fn sum<H: Copy>(
    handles: &[H],
    range: Range<u64>,
    mut add: impl FnMut(&mut Point, H) -> u64,
) -> u64 {
    let (mut sum, mut count) = (Point::ZERO, 0);
    for run in runs(handles, range) {
        run.iter()
            .for_each(|&handle| count += add(&mut sum, handle));
    }
    black_box(sum);
    count
}

#[inline(always)]
fn positions<M: MeshQuery>(
    mesh: &M,
    vertices: impl Iterator<Item = M::Vertex>,
    sum: &mut Point,
) -> u64 {
    let (all, count) = vertices.fold((*sum, 0), |(sum, count), v| {
        (sum + mesh.position(v), count + 1)
    });
    *sum = all;
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_route_starts_again_after_its_last_element() {
        let handles = [0, 1, 2, 3, 4];
        let gone = |range| {
            runs(&handles, range)
                .flatten()
                .copied()
                .collect::<Vec<i32>>()
        };
        assert_eq!(gone(3..9), [3, 4, 0, 1, 2, 3]);
        assert_eq!(gone(10..10), [0; 0]);
        assert_eq!(gone(12..14), [2, 3]);
        assert_eq!(runs(&[0; 0], 3..9).count(), 0);
    }
}
