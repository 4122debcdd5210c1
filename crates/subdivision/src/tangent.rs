//! Two tangents of the limit surface of Catmull–Clark and Loop at a vertex.
//!
//! At smooth vertices, the tangents are sums of the neighbours, weighted with cosines and with
//! sines (Halstead, Kass & DeRose 1993; Loop 1987). Next to a crease, the tangents are derived from
//! the step rules of this crate; see [`Sector`]. The tangents of Biermann, Levin & Zorin (2000) do
//! not apply, because those tangents need other step rules.

use std::f64::consts::{PI, TAU};

use sixfold_core::{Handle, MeshQuery, Point};

use crate::options::LoopWeights;

/// Returns the direction perpendicular to both vectors, or `None` if rounding errors of size
/// `rounding` make the direction uncertain.
pub(crate) fn normal([a, b]: [Point; 2], rounding: f32) -> Option<Point> {
    let tilt = rounding / a.length() + rounding / b.length();
    let across = a.try_normalize()?.cross(b.try_normalize()?);
    (across.length() > 8.0 * tilt).then(|| across.normalize())
}

/// Estimates the rounding error of a weighted sum of the points `around`.
pub(crate) fn rounding(at: Point, around: &[Point]) -> f32 {
    let radius = around.iter().map(|p| p.length()).fold(0.0, f32::max);
    // No weight is above six.
    6.0 * f32::EPSILON * around.len() as f32 * (at.length() + radius)
}

/// Returns the neighbour after `v` in `f`. If `f` is a quad, also returns the position of the
/// corner opposite to `v`.
pub(crate) fn far_corner<M: MeshQuery>(
    mesh: &M,
    v: M::Vertex,
    f: M::Face,
) -> Option<(M::Vertex, Point)> {
    let mut corners = mesh.face_vertices(f);
    let quad: [M::Vertex; 4] = [
        corners.next()?,
        corners.next()?,
        corners.next()?,
        corners.next()?,
    ];
    let place = quad.iter().position(|&corner| corner == v)?;
    let far = mesh.position(quad[(place + 2) % 4]);
    corners
        .next()
        .is_none()
        .then_some((quad[(place + 1) % 4], far))
}

/// The faces around a vertex in order, with positions relative to the vertex.
///
/// ```text
///     o₁ ── e₁ ── o₀        e  the neighbours, counter-clockwise
///     │     │     │         o  the far corners of quads: oᵢ between eᵢ and eᵢ₊₁
///     e₂ ── v ─── e₀
/// ```
pub(crate) struct Fan<V> {
    pub(crate) neighbours: Vec<V>,
    pub(crate) is_closed: bool,
    edges: Vec<Point>,
    far: Vec<Point>,
    /// See [`rounding`].
    pub(crate) rounding: f32,
}

impl<V: Handle> Fan<V> {
    /// Builds the fan. Returns `None` if the faces are not one fan, or if `surface` has no mask for
    /// a face.
    pub(crate) fn new<M: MeshQuery<Vertex = V>>(mesh: &M, v: V, surface: Surface) -> Option<Self> {
        let at = mesh.position(v);
        let neighbours: Vec<V> = mesh.one_ring(v)?.collect();
        let faces = mesh.vertex_faces(v);
        let edges = neighbours.iter().map(|&w| mesh.position(w) - at);
        let edges: Vec<Point> = edges.collect();
        let (is_closed, far) = match surface {
            Surface::CatmullClark => {
                let far: Option<Vec<(V, Point)>> = faces.map(|f| far_corner(mesh, v, f)).collect();
                let mut far = far?;
                far.sort_unstable_by_key(|&(after, _)| after);
                let place = |w: &V| far.binary_search_by_key(w, |&(after, _)| after).ok();
                let ordered = neighbours.iter().filter_map(place);
                let ordered = ordered.map(|place| far[place].1 - at).collect();
                (far.len() == neighbours.len(), ordered)
            }
            Surface::Loop(_) => (faces.count() == neighbours.len(), Vec::new()),
        };
        Some(Self {
            neighbours,
            is_closed,
            rounding: rounding(at, &edges),
            edges,
            far,
        })
    }

    /// Returns two tangents of a smooth vertex. The second is counter-clockwise from the first.
    pub(crate) fn tangents(&self, surface: Surface) -> [Point; 2] {
        let n = self.edges.len();
        if !self.is_closed || n < 3 {
            return [Point::ZERO; 2];
        }
        let angle = TAU / n as f64;
        let mode = surface.mode(angle);
        let wave = |wave: fn(f64) -> f64| {
            let at = |i: usize| wave(angle * i as f64);
            mode.sum(&self.edges, &self.far, at)
        };
        [wave(f64::cos), wave(f64::sin)]
    }

    /// Returns the faces from neighbour `from` to neighbour `to`.
    pub(crate) fn sector(&self, from: usize, to: usize) -> Sector {
        let n = self.edges.len();
        let faces = if to > from { to - from } else { to + n - from };
        let rotated = |points: &[Point], count: usize| {
            let all = points.iter().cycle().skip(from);
            all.take(count).copied().collect()
        };
        Sector {
            edges: rotated(&self.edges, faces + 1),
            far: rotated(&self.far, faces),
        }
    }
}

/// The faces of a vertex between two edges of a crease or boundary.
///
/// With k faces let θ = π/k, and let e₀ … eₖ be the neighbours. The edges to e₀ and eₖ are the
/// crease. The matrix of a step has two parts: the crease, and k − 1 inner modes. The crease is a
/// cubic B-spline with the eigenvalues 1, 1/2 and 1/4. Mode j is sin(ijθ) at the edge to eᵢ; its
/// eigenvalue is smaller for a larger j. There are two tangents. The first is inner mode 1. The
/// second is the crease or mode 2:
///
/// ```text
///   across  Σ a·sin(iθ) eᵢ + Σ b·(sin(iθ) + sin((i + 1)θ)) oᵢ + l (e₀ + eₖ)   mode 1
///   along   e₀ − eₖ                                                          the crease
///      or   the same sums of sin(2iθ) + m (e₀ − eₖ)                          mode 2, if above 1/2
/// ```
///
/// With one face there is no inner mode, and e₀ + eₖ − 2v is the tangent across.
pub(crate) struct Sector {
    /// The neighbours, relative to the vertex.
    edges: Vec<Point>,
    /// The far corners of quads.
    far: Vec<Point>,
}

impl Sector {
    /// Returns the tangent along the crease and the tangent across. The second is counter-clockwise
    /// from the first.
    pub(crate) fn tangents(&self, surface: Surface) -> [Point; 2] {
        let k = self.edges.len() - 1;
        let (first, last) = (self.edges[0], self.edges[k]);
        if k == 1 {
            return [first - last, first + last];
        }
        let angle = PI / k as f64;
        let inside = |mode: Mode, angle: f64| {
            let wave = |i: usize| {
                if i.is_multiple_of(k) {
                    0.0
                } else {
                    (angle * i as f64).sin()
                }
            };
            mode.sum(&self.edges, &self.far, wave)
        };
        // The columns of e₀ and of the vertex give the weight l. All weights add up to zero.
        let mode = surface.mode(angle);
        let ends = (8.0 * mode.neighbour_weight * angle.sin()
            - mode.weight() / (angle / 2.0).tan())
            / (8.0 * mode.value - 2.0);
        let across = inside(mode, angle) + (first + last) * ends as f32;
        let second = surface.mode(2.0 * angle);
        let gap = second.value - 0.5;
        let along = if gap > 1e-9 {
            let ends = second.neighbour_weight * (2.0 * angle).sin() / gap;
            inside(second, 2.0 * angle) + (first - last) * ends as f32
        } else {
            first - last
        };
        [along, across]
    }
}

/// A scheme with limit masks.
#[derive(Clone, Copy)]
pub(crate) enum Surface {
    CatmullClark,
    Loop(LoopWeights),
}

/// An eigenvector of a step: a sine along the edges, except on the crease.
#[derive(Clone, Copy)]
struct Mode {
    /// The eigenvalue.
    value: f64,
    /// The amplitude at edges.
    edge: f64,
    /// The amplitude at far corners, for each of their two edges.
    far: f64,
    /// The weight of an old neighbour in the new points next to it.
    neighbour_weight: f64,
}

impl Surface {
    /// Returns the mode with the larger eigenvalue for neighbours that are `angle` apart.
    fn mode(self, angle: f64) -> Mode {
        let cos = angle.cos();
        match self {
            Self::CatmullClark => {
                // Rounding can make the radicand negative at π.
                let edge = 1.0 + cos + ((cos + 9.0) * (cos + 1.0)).max(0.0).sqrt();
                let value = (edge + 4.0) / 16.0;
                Mode {
                    value,
                    edge,
                    far: 1.0,
                    neighbour_weight: value,
                }
            }
            Self::Loop(_) => Mode {
                value: 0.375 + 0.25 * cos,
                edge: 1.0,
                far: 0.0,
                neighbour_weight: 0.125,
            },
        }
    }
}

impl Mode {
    /// Returns the amplitude of an edge plus its share of the far corners.
    fn weight(self) -> f64 {
        self.edge + 2.0 * self.far
    }

    /// Returns the weighted sum of the edges and the far corners. `wave` is the weight along the
    /// edges.
    fn sum(self, edges: &[Point], far: &[Point], wave: impl Fn(usize) -> f64) -> Point {
        let edges = (0..).zip(edges);
        let edges: Point = edges.map(|(i, &e)| e * (self.edge * wave(i)) as f32).sum();
        let far = (0..).zip(far);
        let far = far.map(|(i, &o)| o * (self.far * (wave(i) + wave(i + 1))) as f32);
        edges + far.sum::<Point>()
    }
}
