//! Curved patches over a net of control points: Bézier patches and uniform B-spline patches.

use sixfold_core::{Point, PolygonMesh};

use crate::error::{MAX_SEGMENTS, ShapeError, check_count, check_value};
use crate::planar::quad_grid;

/// Maximum degree of a curve in a patch.
pub(crate) const MAX_DEGREE: usize = 32;

/// Maximum number of control points along one direction.
pub(crate) const MAX_CONTROL_POINTS: usize = 1024;

/// A grid of control points for a curved patch. The points are stored row by row.
///
/// # Invariants
///
/// - N1  All rows have the same number of points. There are 2 to 1024 rows, and 2 to 1024 columns.
/// - N2  Every coordinate is finite.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlNet {
    columns: usize,
    points: Vec<[f64; 3]>,
}

impl ControlNet {
    /// Builds a net. `points` contains the rows one after the other, and each row has `columns`
    /// points.
    ///
    /// # Errors
    ///
    /// Fails in these cases:
    ///
    /// - The last row has fewer than `columns` points.
    /// - There are fewer than 2 or more than 1024 rows or columns.
    /// - A coordinate is not finite.
    pub fn new(columns: usize, points: &[Point]) -> Result<Self, ShapeError> {
        check_count("columns", columns, 2, MAX_CONTROL_POINTS)?;
        if !points.len().is_multiple_of(columns) {
            let points = points.len();
            return Err(ShapeError::RaggedNet { points, columns });
        }
        check_count("rows", points.len() / columns, 2, MAX_CONTROL_POINTS)?;
        let points: Vec<[f64; 3]> = points
            .iter()
            .map(|point| point.to_array().map(f64::from))
            .collect();
        for &coordinate in points.iter().flatten() {
            check_value(
                "coordinate",
                coordinate,
                f64::from(f32::MIN),
                f64::from(f32::MAX),
            )?;
        }
        Ok(Self { columns, points })
    }

    /// Builds a saddle. The control points are at (x, y, x² − y²), for x and y from −1 to 1.
    ///
    /// # Errors
    ///
    /// Fails if `columns` or `rows` is outside 2 to 1024.
    pub fn saddle(columns: usize, rows: usize) -> Result<Self, ShapeError> {
        Self::over_square(columns, rows, |_, _, x, y| x * x - y * y)
    }

    /// Builds waves, for x and y from −1 to 1. Along the first row, the heights of the control
    /// points repeat 0, 0.5, 0, −0.5. In every second row, the signs are reversed.
    ///
    /// # Errors
    ///
    /// Fails if `columns` or `rows` is outside 2 to 1024.
    pub fn waves(columns: usize, rows: usize) -> Result<Self, ShapeError> {
        const HEIGHTS: [f64; 4] = [0.0, 0.5, 0.0, -0.5];
        Self::over_square(columns, rows, |i, j, _, _| HEIGHTS[(i + 2 * (j % 2)) % 4])
    }

    fn over_square(
        columns: usize,
        rows: usize,
        height: impl Fn(usize, usize, f64, f64) -> f64,
    ) -> Result<Self, ShapeError> {
        check_count("columns", columns, 2, MAX_CONTROL_POINTS)?;
        check_count("rows", rows, 2, MAX_CONTROL_POINTS)?;
        let coordinate = |i: usize, count: usize| 2.0 * i as f64 / (count - 1) as f64 - 1.0;
        let points = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
        let points = points.map(|(i, j)| {
            let (x, y) = (coordinate(i, columns), coordinate(j, rows));
            [x, y, height(i, j, x, y)]
        });
        Ok(Self {
            columns,
            points: points.collect(),
        })
    }

    /// Returns the number of points in a row.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.points.len() / self.columns
    }

    /// Iterates over the points of column `i`, from the first row to the last.
    fn column(&self, i: usize) -> impl Iterator<Item = [f64; 3]> {
        self.points[i..].iter().copied().step_by(self.columns)
    }
}

/// Builds the Bézier patch of a net as `m` × `n` quads. The patch passes through the four corners
/// of the net.
///
/// The mesh has (m + 1)(n + 1) vertices, m(n + 1) + n(m + 1) edges and mn faces. In each direction,
/// the degree is one less than the number of control points. For some nets, vertices of the patch
/// coincide. Time: O(degree²) per vertex (de Casteljau).
///
/// # Errors
///
/// Fails if the net has more than 33 rows or columns, if `m` or `n` is outside 1 to 2²⁰, or if
/// there are more than 2³¹ − 1 corners.
pub fn bezier_patch(net: &ControlNet, m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    check_count("columns", net.columns(), 2, MAX_DEGREE + 1)?;
    check_count("rows", net.rows(), 2, MAX_DEGREE + 1)?;
    tessellated("bezier-patch", net, [m, n], |points, k, steps| {
        de_casteljau(points, k as f64 / steps as f64)
    })
}

/// Builds the uniform B-spline patch of a net as `m` × `n` quads. The patch has the degree `degree`
/// in both directions.
///
/// The mesh has (m + 1)(n + 1) vertices, m(n + 1) + n(m + 1) edges and mn faces. The patch has
/// (columns − degree) × (rows − degree) pieces. A patch of degree 2 or more usually passes through
/// none of its control points. For some nets, vertices of the patch coincide. Time: O(degree²) per
/// vertex (de Boor).
///
/// # Errors
///
/// Fails in these cases:
///
/// - `degree` is outside 1 to 32, or is not less than the number of rows or of columns.
/// - `m` or `n` is outside 1 to 2²⁰.
/// - There are more than 2³¹ − 1 corners.
pub fn b_spline_patch(
    net: &ControlNet,
    degree: usize,
    m: usize,
    n: usize,
) -> Result<PolygonMesh, ShapeError> {
    let points = net.columns().min(net.rows());
    check_count("degree", degree, 1, MAX_DEGREE.min(points - 1))?;
    tessellated("b-spline-patch", net, [m, n], |points, k, steps| {
        // With integer arithmetic, the ends of the patch are exact.
        let pieces = points.len() - degree;
        let piece = (k * pieces / steps).min(pieces - 1);
        let part = (k * pieces - piece * steps) as f64 / steps as f64;
        de_boor(&mut points[piece..=piece + degree], part)
    })
}

/// Builds the grid of points on a patch. Applies `curve` to every column of the net, then to the
/// resulting row of points. `curve(points, k, steps)` may overwrite the points.
fn tessellated(
    shape: &'static str,
    net: &ControlNet,
    [m, n]: [usize; 2],
    curve: impl Fn(&mut [[f64; 3]], usize, usize) -> [f64; 3],
) -> Result<PolygonMesh, ShapeError> {
    check_count("m", m, 1, MAX_SEGMENTS)?;
    check_count("n", n, 1, MAX_SEGMENTS)?;
    let mut row = vec![[0.0; 3]; net.columns()];
    let mut scratch = Vec::new();
    let mut current_row = None;
    quad_grid(shape, m, n, |i, j| {
        if current_row != Some(j) {
            for (column, point) in row.iter_mut().enumerate() {
                scratch.clear();
                scratch.extend(net.column(column));
                *point = curve(&mut scratch, j, n);
            }
            current_row = Some(j);
        }
        scratch.clear();
        scratch.extend(&row);
        curve(&mut scratch, i, m)
    })
}

/// Returns the point at `t` of the Bézier curve of `points`. Overwrites `points`.
fn de_casteljau(points: &mut [[f64; 3]], t: f64) -> [f64; 3] {
    for last in (1..points.len()).rev() {
        for i in 0..last {
            points[i] = interpolate(points[i], points[i + 1], t);
        }
    }
    points[0]
}

/// Returns the point at `t`, from 0 to 1, on one piece of a uniform B-spline with the control
/// points `points`. Overwrites `points`.
fn de_boor(points: &mut [[f64; 3]], t: f64) -> [f64; 3] {
    let degree = points.len() - 1;
    for round in 1..=degree {
        for i in (round..=degree).rev() {
            let part = (t + (degree - i) as f64) / (degree + 1 - round) as f64;
            points[i] = interpolate(points[i - 1], points[i], part);
        }
    }
    points[degree]
}

/// Interpolates from `a` at `part` = 0 to `b` at `part` = 1. Both ends are exact.
fn interpolate(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    std::array::from_fn(|axis| (1.0 - part) * a[axis] + part * b[axis])
}

#[cfg(test)]
mod tests {
    use super::*;
    use sixfold_core::VertexId;

    fn point(mesh: &PolygonMesh, v: usize) -> Point {
        mesh.position(VertexId::new(v as u32))
    }

    #[test]
    fn a_bezier_patch_meets_the_corners_of_its_net() {
        for (columns, rows) in [(2, 2), (4, 4), (3, 7), (33, 2)] {
            let net = ControlNet::waves(columns, rows).expect("small");
            let (m, n) = (5, 3);
            let mesh = bezier_patch(&net, m, n).expect("small");
            let ends = [
                (0, 0),
                (m, columns - 1),
                (n * (m + 1), columns * (rows - 1)),
                ((n + 1) * (m + 1) - 1, columns * rows - 1),
            ];
            for (vertex, control) in ends {
                let control = net.points[control].map(|x| x as f32);
                assert_eq!(
                    point(&mesh, vertex).to_array(),
                    control,
                    "{columns} × {rows}"
                );
            }
        }
    }

    #[test]
    fn a_bezier_patch_of_degree_two_is_the_polynomial_of_its_saddle() {
        // The control heights 1, 0, 1 give the polynomial (1 + x²) / 2.
        let net = ControlNet::saddle(3, 3).expect("small");
        let mesh = bezier_patch(&net, 8, 8).expect("small");
        for &p in mesh.positions() {
            let height = (p.x * p.x - p.y * p.y) / 2.0;
            assert!((p.z - height).abs() < 1e-6, "{p} is not at {height}");
        }
    }

    #[test]
    fn a_cubic_b_spline_passes_through_the_points_of_its_limit_mask() {
        // The limit mask of the cubic B-spline at a knot: (p0 + 4 p1 + p2) / 6.
        let points: Vec<Point> = [3.0, -1.0, 4.0, 1.0, 5.0]
            .iter()
            .flat_map(|&z| (0..4).map(move |i| Point::new(i as f32, z, z * i as f32)))
            .collect();
        let net = ControlNet::new(4, &points).expect("five rows of four");
        let mesh = b_spline_patch(&net, 3, 1, 2).expect("small");
        for (step, rows) in [[3.0, -1.0, 4.0], [-1.0, 4.0, 1.0], [4.0, 1.0, 5.0]]
            .into_iter()
            .enumerate()
        {
            let y = (rows[0] + 4.0 * rows[1] + rows[2]) / 6.0;
            for (end, x) in [1.0, 2.0].into_iter().enumerate() {
                let expected = Point::new(x, y, y * x);
                let got = point(&mesh, 2 * step + end);
                assert!(got.distance(expected) < 1e-6, "{got} is not {expected}");
            }
        }
    }

    #[test]
    fn a_b_spline_of_degree_one_equals_its_net() {
        let net = ControlNet::waves(4, 6).expect("small");
        let mesh = b_spline_patch(&net, 1, 3, 5).expect("small");
        for (got, control) in mesh.positions().iter().zip(&net.points) {
            assert_eq!(got.to_array(), control.map(|x| x as f32));
        }
    }

    #[test]
    fn faulty_nets_are_refused() {
        let points = [Point::ZERO; 6];
        assert!(ControlNet::new(3, &points).is_ok());
        assert_eq!(
            ControlNet::new(4, &points),
            Err(ShapeError::RaggedNet {
                points: 6,
                columns: 4
            })
        );
        for columns in [0, 1, 6, MAX_CONTROL_POINTS + 1] {
            assert!(
                ControlNet::new(columns, &points).is_err(),
                "{columns} columns"
            );
        }
        for z in [f32::NAN, f32::INFINITY] {
            let mut points = points;
            points[4].z = z;
            assert!(ControlNet::new(3, &points).is_err(), "{z}");
        }
        let net = ControlNet::saddle(4, 3).expect("small");
        for degree in [0, 3, 100] {
            assert!(
                b_spline_patch(&net, degree, 2, 2).is_err(),
                "degree {degree}"
            );
        }
        let net = ControlNet::saddle(34, 2).expect("a valid net with too many columns for Bézier");
        assert!(bezier_patch(&net, 1, 1).is_err());
    }
}
