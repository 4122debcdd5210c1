//! The umbrella operator: the offset from a vertex to the weighted mean of its neighbours.

use glam::DVec3;
use sixfold_core::{FaceId, Handle, HandleMap, MeshQuery, VertexMap, row};

use crate::error::SmoothingError;
use crate::smoothing::{SmoothingBoundary, Weights};

/// Minimum height of a triangle, relative to its longest side, for reliable angles. In flatter
/// triangles, rounding errors dominate the angles.
const MIN_HEIGHT: f64 = 1e-8;

/// The weighted sum of the offsets to the neighbours of a vertex, and the sum of the weights.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WeightedSum {
    offset: DVec3,
    weight: f64,
}

impl WeightedSum {
    #[inline(always)]
    fn add(&mut self, weight: f64, offset: DVec3) {
        self.offset += weight * offset;
        self.weight += weight;
    }

    /// Returns the offset to the weighted mean of the neighbours, or zero if the weights are zero.
    #[inline(always)]
    pub(crate) fn mean(self) -> DVec3 {
        if self.weight > 0.0 {
            self.offset / self.weight
        } else {
            DVec3::ZERO
        }
    }
}

/// The neighbours of each vertex, read once from a mesh.
pub(crate) struct Laplacian<V> {
    elements: Elements<V>,
    boundary: BoundaryCurves<V>,
}

impl<V: Handle> Laplacian<V> {
    /// Reads every face and every edge; O(corners).
    pub(crate) fn new<M: MeshQuery<Vertex = V>>(
        mesh: &M,
        weights: Weights,
        boundary: SmoothingBoundary,
    ) -> Result<Self, SmoothingError> {
        Ok(Self {
            elements: match weights {
                Weights::Uniform => {
                    Elements::Edges(mesh.edges().map(|e| mesh.edge_vertices(e)).collect())
                }
                Weights::Cotangent => Elements::Triangles(triangles(mesh)?),
            },
            boundary: BoundaryCurves::new(mesh, boundary),
        })
    }

    /// Computes the sums of all vertices. `at` has the positions; all `sums` must be zero before
    /// the call.
    pub(crate) fn apply(&self, at: &V::Map<DVec3>, sums: &mut V::Map<WeightedSum>) {
        match &self.elements {
            Elements::Edges(edges) => add_uniform(edges, at, sums),
            Elements::Triangles(triangles) => add_cotangent(triangles, at, sums),
        }
        self.boundary.apply(at, sums);
    }
}

/// The elements that connect a vertex to its neighbours.
enum Elements<V> {
    /// Edges, all with the same weight.
    Edges(Vec<[V; 2]>),
    /// Triangles, weighted by their angles.
    Triangles(Vec<[V; 3]>),
}

/// Adds the neighbours with equal weights (Field 1988).
///
/// ```text
///      b ─── a                1
///     ╱ ╲   ╱ ╲      L(v) =  ─── Σ (pᵢ − v)     over the n neighbours
///    c ── v ── f              n
///     ╲ ╱   ╲ ╱
///      d ─── e
/// ```
fn add_uniform<V: Handle>(edges: &[[V; 2]], at: &V::Map<DVec3>, sums: &mut V::Map<WeightedSum>) {
    for &[a, b] in edges {
        let offset = at[b] - at[a];
        sums[a].add(1.0, offset);
        sums[b].add(1.0, -offset);
    }
}

/// Adds the neighbours with cotangent weights (Pinkall & Polthier 1993).
///
/// ```text
///        k                          Σ wᵢ (pᵢ − v)
///       ╱α╲              L(v) =     ─────────────       wᵢ = (cot αᵢ + cot βᵢ) / 2
///      ╱   ╲                            Σ wᵢ
///     v ─── i
///      ╲   ╱            α and β: the angles opposite to edge v–i. In a plane L is zero for any
///       ╲β╱             neighbours; on a surface it is normal to the surface.
///        l
/// ```
///
/// A triangle adds the weight cot β + cot γ = sin α / (sin β sin γ) > 0 to its corner with angle α.
/// So the sum of the weights of a vertex is never negative. A triangle that is too flat for
/// reliable angles contributes no weight.
fn add_cotangent<V: Handle>(
    triangles: &[[V; 3]],
    at: &V::Map<DVec3>,
    sums: &mut V::Map<WeightedSum>,
) {
    for &[a, b, c] in triangles {
        let (pa, pb, pc) = (at[a], at[b], at[c]);
        let (ab, bc, ca) = (pb - pa, pc - pb, pa - pc);
        let double_area = ab.cross(bc).length();
        let longest = ab
            .length_squared()
            .max(bc.length_squared())
            .max(ca.length_squared());
        let is_reliable = double_area > MIN_HEIGHT * longest;
        if !is_reliable {
            continue;
        }
        let cotangent = |u: DVec3, v: DVec3| -u.dot(v) / double_area;
        let (at_a, at_b, at_c) = (cotangent(ca, ab), cotangent(ab, bc), cotangent(bc, ca));
        let [to_a, to_b, to_c] = [bc * at_a, ca * at_b, ab * at_c];
        // The edge a–b is opposite to c, the edge b–c to a, and the edge c–a to b.
        let mut add = |v: V, offset: DVec3, weight: f64| {
            sums[v].offset += offset;
            sums[v].weight += weight;
        };
        add(a, to_c - to_b, at_c + at_b);
        add(b, to_a - to_c, at_a + at_c);
        add(c, to_b - to_a, at_b + at_a);
    }
}

/// Returns the corners of every face, or an error if a face is not a triangle.
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

/// The boundary of a mesh.
///
/// ```text
///    ──── a ════ v ════ b ────     a curve:  L(v) = (a + b) / 2 − v
///         │      │      │
/// ```
struct BoundaryCurves<V> {
    /// Vertices with a boundary edge.
    vertices: Vec<V>,
    /// The boundary edges, if the boundary is a curve.
    edges: Vec<[V; 2]>,
    /// Boundary vertices that do not have exactly two boundary edges.
    irregular: Vec<V>,
}

impl<V: Handle> BoundaryCurves<V> {
    fn new<M: MeshQuery<Vertex = V>>(mesh: &M, boundary: SmoothingBoundary) -> Self {
        let open = mesh.boundary_edges().into_iter();
        let edges: Vec<[V; 2]> = open.map(|e| mesh.edge_vertices(e)).collect();
        let mut ends: VertexMap<M, usize> = HandleMap::filled(mesh.vertex_rows(), 0);
        let mut vertices = Vec::new();
        for &v in edges.as_flattened() {
            if ends[v] == 0 {
                vertices.push(v);
            }
            ends[v] += 1;
        }
        let irregular = vertices.iter().copied().filter(|&v| ends[v] != 2);
        let (irregular, edges) = match boundary {
            SmoothingBoundary::Fixed => (Vec::new(), Vec::new()),
            SmoothingBoundary::Curve => (irregular.collect(), edges),
        };
        Self {
            vertices,
            edges,
            irregular,
        }
    }

    fn apply(&self, at: &V::Map<DVec3>, sums: &mut V::Map<WeightedSum>) {
        let reset = |vertices: &[V], sums: &mut V::Map<WeightedSum>| {
            vertices
                .iter()
                .for_each(|&v| sums[v] = WeightedSum::default());
        };
        reset(&self.vertices, sums);
        add_uniform(&self.edges, at, sums);
        reset(&self.irregular, sums);
    }
}
