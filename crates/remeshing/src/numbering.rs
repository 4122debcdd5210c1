//! Vertex numbers, in an order that is the same on every structure.

use sixfold_core::{HandleMap, MeshEdit, Point, VertexId, VertexMap, row};

use crate::error::RemeshError;

/// A vertex with more edges than this may have very many.
const FEW_EDGES: usize = 16;

/// The numbers of the vertices, which are updated after every edit.
///
/// Structures list vertices in different orders, but all structures use the same numbers. Vertices
/// are numbered in the order in which the faces list them. Each face is read from the corner with
/// the smallest coordinates.
pub(crate) struct Numbering<M: MeshEdit> {
    handles: Vec<M::Vertex>,
    /// For each number: whether the vertex has been removed. The handle of a removed vertex must
    /// not be used.
    removed: Vec<bool>,
    numbers: VertexMap<M, u32>,
}

impl<M: MeshEdit> Numbering<M> {
    /// Numbers the vertices of a mesh of triangles; O(corners).
    ///
    /// # Errors
    ///
    /// Returns an error for the first face that is not a triangle, or for the first position that
    /// is not finite.
    pub(crate) fn new(mesh: &M) -> Result<Self, RemeshError> {
        for (i, f) in (0..).zip(mesh.faces()) {
            let degree = mesh.face_vertices(f).count();
            if degree != 3 {
                let face = sixfold_core::FaceId::new(i);
                return Err(RemeshError::NotATriangle { face, degree });
            }
        }
        for (i, v) in (0..).zip(mesh.vertices()) {
            let at = mesh.position(v);
            if !at.is_finite() {
                let (vertex, at) = (VertexId::new(i), at.to_array());
                return Err(RemeshError::NotFinite { vertex, at });
            }
        }
        let mut numbering = Self {
            handles: Vec::new(),
            removed: Vec::new(),
            numbers: mesh.vertex_map(u32::MAX),
        };
        for f in mesh.faces() {
            let [a, b, c] = corners(mesh, f);
            // Replaces −0 by 0, because some structures identify a vertex by its coordinates.
            let place = |v| mesh.position(v) + Point::ZERO;
            let bits = |v| place(v).to_array().map(f32::to_bits);
            let least = bits(a).min(bits(b)).min(bits(c));
            let rotated = if least == bits(a) {
                [a, b, c]
            } else if least == bits(b) {
                [b, c, a]
            } else {
                [c, a, b]
            };
            for v in rotated {
                if numbering.numbers[v] == u32::MAX {
                    numbering.push(v);
                }
            }
        }
        Ok(numbering)
    }

    pub(crate) fn push(&mut self, v: M::Vertex) -> u32 {
        let number = row(self.handles.len());
        self.numbers.insert(v, number);
        self.handles.push(v);
        self.removed.push(false);
        number
    }

    #[inline]
    pub(crate) fn remove(&mut self, number: u32) {
        self.removed[number as usize] = true;
    }

    #[inline]
    pub(crate) fn set_handle(&mut self, number: u32, new: M::Vertex) {
        let old = self.handles[number as usize];
        if old != new {
            self.numbers.remove(old);
            self.numbers.insert(new, number);
            self.handles[number as usize] = new;
        }
    }

    /// Moves a vertex to `to`. The vertex does not move if the structure identifies vertices by
    /// coordinates and another vertex is at `to`.
    pub(crate) fn set_position(&mut self, mesh: &mut M, number: u32, to: Point) {
        if let Ok(v) = mesh.set_position(self.handle(number), to) {
            self.set_handle(number, v);
        }
    }

    /// Returns the number of all vertices, including removed vertices.
    pub(crate) fn len(&self) -> usize {
        self.handles.len()
    }

    #[inline]
    pub(crate) fn handle(&self, number: u32) -> M::Vertex {
        self.handles[number as usize]
    }

    #[inline]
    pub(crate) fn number(&self, v: M::Vertex) -> u32 {
        self.numbers[v]
    }

    /// Returns the numbers of the two ends of each edge, sorted. O(edges log edges).
    pub(crate) fn edges(&self, mesh: &M) -> Vec<[u32; 2]> {
        let ends = mesh.edges().map(|e| {
            let [a, b] = mesh.edge_vertices(e).map(|v| self.number(v));
            [a.min(b), a.max(b)]
        });
        let mut edges: Vec<[u32; 2]> = ends.collect();
        edges.sort_unstable();
        edges
    }

    #[inline]
    pub(crate) fn edge(&self, mesh: &M, [a, b]: [u32; 2]) -> Option<M::Edge> {
        if self.removed[a as usize] || self.removed[b as usize] {
            return None;
        }
        let ends = [a, b].map(|number| self.handle(number));
        if M::CAPABILITIES.non_manifold_edges {
            // These structures do not walk around a vertex.
            return mesh.edge_between(ends[0], ends[1]);
        }
        let joins = |&e: &M::Edge| mesh.edge_vertices(e).contains(&ends[1]);
        let mut at_a = mesh.vertex_edges(ends[0]);
        for _ in 0..FEW_EDGES {
            let e = at_a.next()?;
            if joins(&e) {
                return Some(e);
            }
        }
        // One of the ends may have very many edges, so this looks around both by turns.
        let is_back = |&e: &M::Edge| mesh.edge_vertices(e).contains(&ends[0]);
        let mut at_b = mesh.vertex_edges(ends[1]);
        loop {
            let (one, other) = (at_a.next()?, at_b.next()?);
            if joins(&one) {
                return Some(one);
            }
            if is_back(&other) {
                return Some(other);
            }
        }
    }

    /// Returns the number of edges of each vertex, by number; 0 for a removed one. O(vertices), plus the
    /// cost of the query VE.
    pub(crate) fn valences(&self, mesh: &M) -> Vec<u32> {
        let numbers = (0..row(self.len())).zip(&self.removed);
        let valence = |(number, &is_removed): (u32, &bool)| match is_removed {
            true => 0,
            false => row(mesh.vertex_edges(self.handle(number)).count()),
        };
        numbers.map(valence).collect()
    }
}

/// Returns the corners of a triangle. Any corner can be the first.
#[inline]
pub(crate) fn corners<M: MeshEdit>(mesh: &M, f: M::Face) -> [M::Vertex; 3] {
    let mut corners = mesh.face_vertices(f);
    let mut next = || corners.next().expect("every face is a triangle");
    [next(), next(), next()]
}

/// Returns the corners of a triangle, starting at corner `v`.
#[inline]
pub(crate) fn corners_from<M: MeshEdit>(mesh: &M, f: M::Face, v: M::Vertex) -> [M::Vertex; 3] {
    let [a, b, c] = corners(mesh, f);
    if a == v {
        [a, b, c]
    } else if b == v {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use sixfold_core::{MeshQuery, PolygonMesh, Representation};
    use sixfold_half_edge::EditableHalfEdgeMesh;

    use super::*;

    /// Returns two cones over one rim: their tips, which are the last two vertices, have `n` edges.
    pub(crate) fn two_cones(n: u32) -> PolygonMesh {
        let rim = (0..n).map(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / f64::from(n)).sin_cos();
            Point::new(cos as f32, sin as f32, 0.0)
        });
        let tips = [Point::Z, -Point::Z];
        let sides = (0..n).map(|i| [i, (i + 1) % n]);
        let faces = sides.flat_map(|[a, b]| [[a, b, n], [b, a, n + 1]]);
        let points: Vec<Point> = rim.chain(tips).collect();
        PolygonMesh::new(points, faces).expect("two cones")
    }

    #[test]
    fn edges_are_found_around_vertices_with_many_edges() {
        let n = 3 * FEW_EDGES as u32;
        let polygons = two_cones(n);
        let mesh = EditableHalfEdgeMesh::from_polygons(&polygons).expect("a manifold");
        let numbering = Numbering::new(&mesh).expect("triangles");
        let valences = numbering.valences(&mesh);
        for a in 0..n + 2 {
            let v = numbering.handle(a);
            assert_eq!(valences[a as usize] as usize, mesh.vertex_edges(v).count());
            for b in (0..n + 2).filter(|&b| b != a) {
                let expected = mesh.edge_between(v, numbering.handle(b));
                assert_eq!(numbering.edge(&mesh, [a, b]), expected, "{a} {b}");
            }
        }
    }
}
