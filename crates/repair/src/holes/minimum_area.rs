//! The triangulation of a closed chain of points with the smallest area.

use glam::DVec3;

/// A triangle is flat if its height is below this part of its longest side.
const FLAT: f64 = 1e-4;
/// The area by which a triangulation may be larger to have one flat triangle less, as a part of the
/// square of the chain's largest distance from its first point.
const FLAT_AREA: f64 = 1e-6;

/// Returns the triangles with the smallest sum of areas, each as three numbers of points in the
/// order of the chain; `None` if every triangulation needs a diagonal for which `is_edge` is true.
///
/// Dynamic programming over the parts of the chain (Barequet & Sharir 1995): the best triangulation
/// of the part from `i` to `k` has one triangle `i j k` on the side that closes the part. O(n³)
/// time, O(n²) memory. Of nearly equal areas, the one with fewer flat triangles is taken; of two equal
/// ones, the one with the lower `j`. A chain with a coordinate that is not finite has no triangulation.
pub(super) fn minimum_area_triangulation(
    points: &[DVec3],
    is_edge: impl Fn(usize, usize) -> bool,
) -> Option<Vec<[usize; 3]>> {
    let n = points.len();
    if n < 3 {
        return None;
    }
    let at = |i: usize, k: usize| i * n + k;
    let squares = points.iter().map(|p| p.distance_squared(points[0]));
    let flat_cost = 2.0 * FLAT_AREA * squares.fold(0.0, f64::max);
    let mut area = vec![0.0_f64; n * n];
    let mut apex = vec![0_u32; n * n];
    for length in 2..n {
        for i in 0..n - length {
            let k = i + length;
            let mut best = (f64::INFINITY, 0);
            if length == n - 1 || !is_edge(i, k) {
                for j in i + 1..k {
                    let sum = area[at(i, j)] + area[at(j, k)] + cost(points, [i, j, k], flat_cost);
                    if sum < best.0 {
                        best = (sum, j);
                    }
                }
            }
            area[at(i, k)] = best.0;
            apex[at(i, k)] = best.1 as u32;
        }
    }
    if !area[at(0, n - 1)].is_finite() {
        return None;
    }
    let mut triangles = Vec::with_capacity(n - 2);
    let mut parts = vec![(0, n - 1)];
    while let Some((i, k)) = parts.pop() {
        if k - i >= 2 {
            let j = apex[at(i, k)] as usize;
            triangles.push([i, j, k]);
            parts.extend([(j, k), (i, j)]);
        }
    }
    Some(triangles)
}

/// Returns twice the area of a triangle, plus `flat_cost` if it is flat.
fn cost(points: &[DVec3], [i, j, k]: [usize; 3], flat_cost: f64) -> f64 {
    let (a, b) = (points[j] - points[i], points[k] - points[i]);
    let area = a.cross(b).length();
    let longest = a.length_squared().max(b.length_squared());
    let longest = longest.max((a - b).length_squared());
    match area < FLAT * longest {
        true => area + flat_cost,
        false => area,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(points: &[DVec3], triangles: &[[usize; 3]]) -> f64 {
        triangles.iter().map(|&t| cost(points, t, 0.0)).sum()
    }

    /// Calls `visit` with every triangulation of the part of the chain from `i` to `k`.
    fn all(i: usize, k: usize) -> Vec<Vec<[usize; 3]>> {
        if k - i < 2 {
            return vec![Vec::new()];
        }
        let mut found = Vec::new();
        for j in i + 1..k {
            for left in all(i, j) {
                for right in all(j, k) {
                    let parts = [vec![[i, j, k]], left.clone(), right];
                    found.push(parts.concat());
                }
            }
        }
        found
    }

    #[test]
    fn the_area_is_the_smallest_of_all_triangulations() {
        let at = |i: usize| {
            let t = i as f64;
            DVec3::new(t.cos(), t.sin(), (3.7 * t).sin() * 0.8)
        };
        for n in 3..9 {
            let points: Vec<DVec3> = (0..n).map(|i| at(i) * (1.0 + 0.3 * i as f64)).collect();
            let smallest = all(0, n - 1)
                .iter()
                .map(|triangles| total(&points, triangles))
                .fold(f64::INFINITY, f64::min);
            let found = minimum_area_triangulation(&points, |_, _| false).expect("no edge");
            assert_eq!(found.len(), n - 2);
            assert!((total(&points, &found) - smallest).abs() < 1e-12, "{n}");
        }
    }

    /// The number of flat triangles is the smallest of all triangulations with the smallest area: here,
    /// of rectangles with points on their sides, also rotated so that areas are rounded.
    #[test]
    fn triangles_without_area_are_avoided() {
        const SIZES: [[i32; 2]; 6] = [[1, 1], [2, 1], [3, 1], [3, 2], [5, 6], [8, 8]];
        for ([columns, rows], is_turned) in SIZES
            .into_iter()
            .flat_map(|size| [(size, false), (size, true)])
        {
            let (x, y) = (f64::from(columns), f64::from(rows));
            let mut points: Vec<DVec3> = Vec::new();
            let side = |from: DVec3, to: DVec3, count: i32| {
                (0..count).map(move |i| from.lerp(to, f64::from(i) / f64::from(count)))
            };
            let corners = [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]];
            let corners = corners.map(|[x, y]| DVec3::new(x, y, 0.0));
            for (i, count) in [columns, rows, columns, rows].into_iter().enumerate() {
                points.extend(side(corners[i], corners[(i + 1) % 4], count));
            }
            let turn = glam::DQuat::from_rotation_z(0.3) * glam::DQuat::from_rotation_x(0.4);
            // As positions are stored.
            for p in &mut points {
                *p = if is_turned { turn * *p } else { *p }.as_vec3().as_dvec3();
            }
            let found = minimum_area_triangulation(&points, |_, _| false).expect("no edge");
            assert!((total(&points, &found) - 2.0 * x * y).abs() < 1e-4);
            let is_flat = |t: &&[usize; 3]| cost(&points, **t, 0.0) < 1e-5;
            assert_eq!(
                found.iter().filter(is_flat).count(),
                0,
                "{columns} × {rows}"
            );
        }
    }

    #[test]
    fn diagonals_that_are_edges_are_not_used() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let square = square.map(|[x, y]| DVec3::new(x, y, 0.0));
        let blocked = |a: usize, b: usize| move |i: usize, j: usize| [i, j] == [a, b];
        let found = minimum_area_triangulation(&square, blocked(0, 2)).expect("the other one");
        assert_eq!(found, [[0, 1, 3], [1, 2, 3]]);
        assert_eq!(minimum_area_triangulation(&square, |_, _| true), None);
    }
}
