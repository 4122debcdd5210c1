//! The umbrella operator: where the neighbours of a vertex pull it.

use glam::DVec3;
use mesh_core::{FaceId, Handle, HandleMap, MeshQuery, VertexMap, row};

use crate::error::SmoothingError;
use crate::smoothing::{Boundary, Weights};

/// What a triangle's height must be to its longest side, at least, for its angles to be known:
/// below it they are the rounding of single coordinates.
const FLAT: f64 = 1e-8;

/// How strongly neighbours pull a vertex, and where to.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pull {
    offset: DVec3,
    weight: f64,
}

impl Pull {
    /// Adds a neighbour `offset` away.
    #[inline(always)]
    fn add(&mut self, weight: f64, offset: DVec3) {
        self.offset += weight * offset;
        self.weight += weight;
    }

    /// The way to the weighted mean of the neighbours; nowhere without neighbours.
    #[inline(always)]
    pub(crate) fn way(self) -> DVec3 {
        if self.weight > 0.0 {
            self.offset / self.weight
        } else {
            DVec3::ZERO
        }
    }
}

/// Who pulls whom, read from a mesh once and walked over at every step.
pub(crate) struct Laplacian<V> {
    springs: Springs<V>,
    rim: Rim<V>,
}

impl<V: Handle> Laplacian<V> {
    /// Reads every face of `mesh`, and every edge; O(corners).
    pub(crate) fn of<M: MeshQuery<Vertex = V>>(
        mesh: &M,
        weights: Weights,
        boundary: Boundary,
    ) -> Result<Self, SmoothingError> {
        Ok(Self {
            springs: match weights {
                Weights::Uniform => {
                    Springs::Edges(mesh.edges().map(|e| mesh.edge_vertices(e)).collect())
                }
                Weights::Cotangent => Springs::Triangles(triangles(mesh)?),
            },
            rim: Rim::of(mesh, boundary),
        })
    }

    /// Adds to `pulls`, which are all none, what pulls each vertex where vertices are `at`.
    pub(crate) fn pull(&self, at: &V::Map<DVec3>, pulls: &mut V::Map<Pull>) {
        match &self.springs {
            Springs::Edges(edges) => pull_ends(edges, at, pulls),
            Springs::Triangles(triangles) => pull_corners(triangles, at, pulls),
        }
        self.rim.pull(at, pulls);
    }
}

/// What lies between vertices that pull each other.
enum Springs<V> {
    /// Edges, all alike.
    Edges(Vec<[V; 2]>),
    /// Triangles, by their angles.
    Triangles(Vec<[V; 3]>),
}

/// Uniform weights (Field 1988): each neighbour pulls as strongly as any other.
///
/// ```text
///      b ─── a                1
///     ╱ ╲   ╱ ╲      L(v) =  ─── Σ (pᵢ − v)     over the n neighbours
///    c ── v ── f              n
///     ╲ ╱   ╲ ╱
///      d ─── e
/// ```
fn pull_ends<V: Handle>(edges: &[[V; 2]], at: &V::Map<DVec3>, pulls: &mut V::Map<Pull>) {
    for &[a, b] in edges {
        let way = at[b] - at[a];
        pulls[a].add(1.0, way);
        pulls[b].add(1.0, -way);
    }
}

/// Cotangent weights (Pinkall & Polthier 1993): the way in which the area shrinks fastest.
///
/// ```text
///        k                          Σ wᵢ (pᵢ − v)
///       ╱α╲              L(v) =     ─────────────       wᵢ = (cot αᵢ + cot βᵢ) / 2
///      ╱   ╲                            Σ wᵢ
///     v ─── i
///      ╲   ╱            The two angles opposite to the edge v–i. In a plane L is zero, however
///       ╲β╱             the neighbours lie; on a surface it is normal to it.
///        l
/// ```
///
/// A triangle gives its corner with angle α the weights cot β + cot γ = sin α / (sin β sin γ) > 0,
/// so a sum of weights is never negative, though one of them may be. A triangle too flat for its
/// angles to be known pulls nobody.
fn pull_corners<V: Handle>(triangles: &[[V; 3]], at: &V::Map<DVec3>, pulls: &mut V::Map<Pull>) {
    for &[a, b, c] in triangles {
        let (pa, pb, pc) = (at[a], at[b], at[c]);
        let (ab, bc, ca) = (pb - pa, pc - pb, pa - pc);
        let double_area = ab.cross(bc).length();
        let longest = ab
            .length_squared()
            .max(bc.length_squared())
            .max(ca.length_squared());
        let known = double_area > FLAT * longest;
        if !known {
            continue;
        }
        let cotangent = |u: DVec3, v: DVec3| -u.dot(v) / double_area;
        let (at_a, at_b, at_c) = (cotangent(ca, ab), cotangent(ab, bc), cotangent(bc, ca));
        let [to_a, to_b, to_c] = [bc * at_a, ca * at_b, ab * at_c];
        // The edge a–b is opposite to c, and so on around.
        let mut give = |v: V, offset: DVec3, weight: f64| {
            pulls[v].offset += offset;
            pulls[v].weight += weight;
        };
        give(a, to_c - to_b, at_c + at_b);
        give(b, to_a - to_c, at_a + at_c);
        give(c, to_b - to_a, at_b + at_a);
    }
}

/// The corners of every face, which must be three.
fn triangles<M: MeshQuery>(mesh: &M) -> Result<Vec<[M::Vertex; 3]>, SmoothingError> {
    let mut triangles = Vec::with_capacity(mesh.face_count());
    for (i, f) in mesh.faces().enumerate() {
        let mut corners = mesh.face_vertices(f);
        match [(); 4].map(|()| corners.next()) {
            [Some(a), Some(b), Some(c), None] => triangles.push([a, b, c]),
            _ => {
                let (face, degree) = (FaceId::new(row(i)), mesh.face_vertices(f).count());
                return Err(SmoothingError::NotATriangle { face, degree });
            }
        }
    }
    Ok(triangles)
}

/// The boundary of a mesh, whose vertices the inside does not pull.
///
/// ```text
///    ──── a ════ v ════ b ────     a curve:  L(v) = (a + b) / 2 − v
///         │      │      │
/// ```
struct Rim<V> {
    /// Vertices with a boundary edge.
    vertices: Vec<V>,
    /// The boundary edges, if the boundary is a curve.
    edges: Vec<[V; 2]>,
    /// Vertices where the curve ends or crosses itself: these have not two boundary edges.
    knots: Vec<V>,
}

impl<V: Handle> Rim<V> {
    /// Counts the faces along every edge, face by face: no structure has to look for them.
    fn of<M: MeshQuery<Vertex = V>>(mesh: &M, boundary: Boundary) -> Self {
        let mut faces = mesh.edge_map(0_u8);
        mesh.faces().for_each(|f| {
            mesh.face_edges(f).for_each(|e| {
                let count = &mut faces[e];
                *count = count.saturating_add(1);
            });
        });
        let open = mesh.edges().filter(|&e| faces[e] == 1);
        let edges: Vec<[V; 2]> = open.map(|e| mesh.edge_vertices(e)).collect();
        let mut ends: VertexMap<M, usize> = HandleMap::filled(mesh.vertex_rows(), 0);
        let mut vertices = Vec::new();
        for &v in edges.as_flattened() {
            if ends[v] == 0 {
                vertices.push(v);
            }
            ends[v] += 1;
        }
        let knots = vertices.iter().copied().filter(|&v| ends[v] != 2);
        let (knots, edges) = match boundary {
            Boundary::Fixed => (Vec::new(), Vec::new()),
            Boundary::Curve => (knots.collect(), edges),
        };
        Self {
            vertices,
            edges,
            knots,
        }
    }

    /// Replaces what pulls the vertices of the boundary.
    fn pull(&self, at: &V::Map<DVec3>, pulls: &mut V::Map<Pull>) {
        let let_go = |vertices: &[V], pulls: &mut V::Map<Pull>| {
            vertices.iter().for_each(|&v| pulls[v] = Pull::default());
        };
        let_go(&self.vertices, pulls);
        pull_ends(&self.edges, at, pulls);
        let_go(&self.knots, pulls);
    }
}
