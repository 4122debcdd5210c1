//! The best of all triangulations of a small polygon.

use glam::{DVec2, DVec3};

use super::plane::orient2d;

/// Maximum number of corners of a polygon whose triangulations are all compared.
pub(super) const MAX_CORNERS: usize = 256;

/// The cost of a triangulation; the parts are compared in order.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
struct Cost {
    /// Area of the triangles that are turned over.
    turned: f64,
    /// Number of triangles without an area.
    flat: u32,
    /// Number of diagonals that are already edges of the mesh.
    known: u32,
    /// Sum of the squared lengths of the diagonals.
    length: f64,
}

impl Cost {
    fn plus(self, other: Self) -> Self {
        Self {
            turned: self.turned + other.turned,
            flat: self.flat + other.flat,
            known: self.known + other.known,
            length: self.length + other.length,
        }
    }
}

/// Appends the triangles of the cheapest triangulation of the polygon to `triangles`. If there is one
/// in which no triangle is turned over, it is such a one.
///
/// The triangles of such a triangulation cover each point as often as the polygon winds around it,
/// because their sides inside cancel out. So they do not overlap if the polygon winds around no
/// point twice. A polygon that touches itself but does not cross itself is the limit of simple
/// polygons; a triangulation of these is one of the polygon.
///
/// O(n³) time and O(n²) memory, by dynamic programming (Klincsek 1980).
pub(super) fn triangulate(
    points: &[DVec3],
    projected: &[DVec2],
    is_edge: impl Fn(usize, usize) -> bool,
    triangles: &mut Vec<[usize; 3]>,
) {
    let n = projected.len();
    // For the part of the polygon from corner i to corner j: its cost, and the tip of the triangle
    // on the diagonal from j to i.
    let mut best = vec![(Cost::default(), 0); n * n];
    for length in 2..n {
        for i in 0..n - length {
            let j = i + length;
            let diagonal = match length + 1 < n {
                true => Cost {
                    known: u32::from(is_edge(i, j)),
                    length: points[i].distance_squared(points[j]),
                    ..Cost::default()
                },
                false => Cost::default(),
            };
            let mut cheapest: Option<(Cost, usize)> = None;
            for k in i + 1..j {
                let area = orient2d(projected[i], projected[k], projected[j]);
                let (before, after) = (best[i * n + k].0, best[k * n + j].0);
                let mut cost = before.plus(after).plus(diagonal);
                cost.turned += f64::max(0.0, -area);
                cost.flat += u32::from(area == 0.0);
                if cheapest.is_none_or(|(least, _)| cost < least) {
                    cheapest = Some((cost, k));
                }
            }
            best[i * n + j] = cheapest.expect("a corner lies between two that are not adjacent");
        }
    }
    let mut parts = vec![(0, n - 1)];
    while let Some((i, j)) = parts.pop() {
        if j - i > 1 {
            let (_, k) = best[i * n + j];
            triangles.push([i, k, j]);
            parts.extend([(i, k), (k, j)]);
        }
    }
}
