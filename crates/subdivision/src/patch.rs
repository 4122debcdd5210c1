//! Tensor-product B-spline patches: curves along the rows and columns of a grid of control points.
//!
//! Catmull & Clark (1978) derive their scheme from bicubic patches. A step of a bicubic patch puts
//! a point on every face, edge and vertex of the grid.
//!
//! ```text
//!   a ─── e ─── b      face point     f   (a + b + c + d)/4
//!   │     │     │      edge point     e   (1, 6, 1) over 16 along each of the two
//!   g ─── f ─── h                         rows of three across it
//!   │     │     │      vertex point   v   (1, 6, 1) × (1, 6, 1) over 64
//!   c ─── i ─── d
//! ```
//!
//! The three rules are products of the two rules of a curve: the midpoint (1, 1)/2 and the strut
//! (1, 6, 1)/8. A step of the patch therefore runs a step of a curve along every row, and then
//! along every column.

use sixfold_core::{FaceList, MAX_ROWS, Point, PolygonError, PolygonMesh, VertexId};

use crate::curve::{Ends, cubic_b_spline_at, cubic_count, cubic_domain, cubic_step, min_points};
use crate::error::CurveError;

/// Control points in rows, and the uniform bicubic B-spline patch that they define.
///
/// With [`Ends::Dropped`] in both directions, m × n control points define (m − 3) × (n − 3) bicubic
/// pieces, and each step shrinks the grid towards these pieces. With [`Ends::Kept`] in both
/// directions, the four corners do not move, and the boundary consists of B-spline curves between
/// the corners. Catmull–Clark with the boundary rule `edge-and-corner` gives the same boundary
/// curves. With [`Ends::Closed`] in one direction, the patch is a tube; with [`Ends::Closed`] in
/// both directions, the patch is a torus.
///
/// # Invariants
///
/// - G1  Every row has the same number of points.
/// - G2  A row or column has at least 2 points if its ends are kept, 3 points if the row or column
///   is closed, and 4 points if its ends are dropped.
///
/// # Examples
///
/// ```
/// use sixfold_core::Point;
/// use sixfold_subdivision::{ControlGrid, Ends};
///
/// let hills = (0..16).map(|i| Point::new((i % 4) as f32, (i / 4) as f32, (i % 3) as f32));
/// let grid = ControlGrid::new(4, hills.collect::<Vec<_>>(), [Ends::Dropped; 2])?;
/// let refined = grid.refined(3)?;
/// assert_eq!([refined.columns(), refined.rows()], [11, 11]);
/// assert!(grid.evaluate(1.5, 1.5).is_some() && grid.evaluate(0.5, 1.5).is_none());
/// # Ok::<(), sixfold_subdivision::CurveError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ControlGrid {
    columns: usize,
    points: Vec<Point>,
    ends: [Ends; 2],
}

impl ControlGrid {
    /// Builds a grid from `points`, row after row, with `columns` points in a row. `ends[0]` is the
    /// rule for the ends of the rows, and `ends[1]` is the rule for the ends of the columns.
    ///
    /// # Errors
    ///
    /// Returns an error if the last row is incomplete, or if a row or a column has too few points.
    pub fn new(
        columns: usize,
        points: impl Into<Vec<Point>>,
        ends: [Ends; 2],
    ) -> Result<Self, CurveError> {
        let points = points.into();
        let given = points.len();
        if columns == 0 || !given.is_multiple_of(columns) {
            return Err(CurveError::RaggedGrid { given, columns });
        }
        for (given, ends) in [columns, given / columns].into_iter().zip(ends) {
            let least = min_points(ends);
            if given < least {
                return Err(CurveError::TooFewPoints { given, least });
            }
        }
        Ok(Self {
            columns,
            points,
            ends,
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

    /// Returns two rules: the rule for the ends of the rows, then the rule for the ends of the
    /// columns.
    pub fn ends(&self) -> [Ends; 2] {
        self.ends
    }

    /// Returns the control points, row after row.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Returns the grid after `levels` steps. Takes O(points of the result) time.
    ///
    /// # Errors
    ///
    /// Returns an error if the result has more than [`MAX_ROWS`] points.
    pub fn refined(&self, levels: u32) -> Result<Self, CurveError> {
        let mut sizes = [self.columns, self.rows()];
        // Checked before the first step. Sizes grow with every level (G2), so this loop ends early.
        for _ in 0..levels.min(usize::BITS) {
            let next: [usize; 2] = std::array::from_fn(|direction| {
                cubic_count(sizes[direction], self.ends[direction])
            });
            sizes = next;
            let points = sizes[0].checked_mul(sizes[1]);
            if points.is_none_or(|points| points > MAX_ROWS) {
                return Err(CurveError::TooManyPoints {
                    given: self.points.len(),
                    levels,
                    limit: MAX_ROWS,
                });
            }
        }
        let mut grid = self.clone();
        for _ in 0..levels {
            grid = grid.step();
        }
        Ok(grid)
    }

    /// Runs one step along every row, then along every column.
    fn step(&self) -> Self {
        let [of_rows, of_columns] = self.ends;
        let rows = self.points.chunks(self.columns);
        let across: Vec<Vec<Point>> = rows.map(|row| cubic_step(row, of_rows)).collect();
        let columns = cubic_count(self.columns, of_rows);
        let mut points = vec![Point::ZERO; columns * cubic_count(self.rows(), of_columns)];
        let mut column = Vec::with_capacity(across.len());
        for i in 0..columns {
            column.clear();
            column.extend(across.iter().map(|row| row[i]));
            let places = points[i..].iter_mut().step_by(columns);
            for (place, point) in places.zip(cubic_step(&column, of_columns)) {
                *place = point;
            }
        }
        Self {
            columns,
            points,
            ends: self.ends,
        }
    }

    /// Returns the point of the patch at the parameters (`u`, `v`). The patch is the limit of
    /// [`refined`](Self::refined) after infinitely many levels. The control point in column i of
    /// row j has the parameters (i, j). Takes O(rows) time.
    ///
    /// Returns `None` if a parameter is outside its domain. The domain of a parameter along n
    /// control points is:
    ///
    /// - ends kept: from 0 to n − 1
    /// - ends dropped: from 1 to n − 2
    /// - closed: every parameter, because the patch is periodic
    pub fn evaluate(&self, u: f64, v: f64) -> Option<Point> {
        let [of_rows, of_columns] = self.ends;
        let rows = self.points.chunks(self.columns);
        let column: Option<Vec<Point>> =
            rows.map(|row| cubic_b_spline_at(row, of_rows, u)).collect();
        cubic_b_spline_at(&column?, of_columns, v)
    }

    /// Returns two ranges, each from the lowest to the highest parameter: the range of `u` (along
    /// the rows), then the range of `v` (along the columns).
    pub fn domain(&self) -> [(f64, f64); 2] {
        let sizes = [self.columns, self.rows()];
        std::array::from_fn(|direction| cubic_domain(sizes[direction], self.ends[direction]))
    }

    /// Returns the grid as a mesh of quads. The quads are counter-clockwise if rows run to the
    /// right and columns run up. The point in column i of row j becomes vertex j · `columns` + i.
    /// Takes O(points) time.
    ///
    /// # Errors
    ///
    /// Returns [`PolygonError::TooMany`] if there are more corners than [`MAX_ROWS`].
    pub fn to_polygons(&self) -> Result<PolygonMesh, PolygonError> {
        let sizes = [self.columns, self.rows()];
        let [across, up]: [usize; 2] = std::array::from_fn(|direction| {
            let is_open = self.ends[direction] != Ends::Closed;
            sizes[direction] - usize::from(is_open)
        });
        let limit = MAX_ROWS;
        if across.saturating_mul(up).saturating_mul(4) > limit {
            let elements = "corners";
            return Err(PolygonError::TooMany { elements, limit });
        }
        let at = |i: usize, j: usize| {
            let number = j % sizes[1] * sizes[0] + i % sizes[0];
            VertexId::new(sixfold_core::row(number))
        };
        let quads = (0..up).flat_map(|j| (0..across).map(move |i| (i, j)));
        let corners = quads.flat_map(|(i, j)| {
            [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(right, up)| at(i + right, j + up))
        });
        PolygonMesh::from_faces(
            self.points.clone(),
            FaceList::uniform(4, corners.collect())?,
        )
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sixfold_core::{Creases, Representation};
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::{Scheme, Subdivision};

    const ALL: [Ends; 3] = [Ends::Closed, Ends::Kept, Ends::Dropped];

    fn grid() -> impl Strategy<Value = ControlGrid> {
        let ends = prop::array::uniform2(prop::sample::select(ALL.to_vec()));
        let parts = (4..8_usize, 4..7_usize, ends);
        parts.prop_flat_map(|(columns, rows, ends)| {
            let point = [-4.0_f32..4.0, -4.0_f32..4.0, -4.0_f32..4.0].prop_map(Point::from);
            let points = prop::collection::vec(point, columns * rows);
            points.prop_map(move |points| ControlGrid::new(columns, points, ends).expect("4 × 4"))
        })
    }

    fn sorted(points: impl IntoIterator<Item = Point>) -> Vec<[i64; 3]> {
        // Coordinates of a refined grid of integers are multiples of 1/64.
        let keys = points
            .into_iter()
            .map(|p| p.to_array().map(|x| (f64::from(x) * 1024.0).round() as i64));
        let mut keys: Vec<_> = keys.collect();
        keys.sort_unstable();
        keys
    }

    #[test]
    fn each_invalid_input_returns_its_error() {
        let new = |columns, points: usize, ends| {
            ControlGrid::new(columns, vec![Point::ZERO; points], [ends, Ends::Kept]).unwrap_err()
        };
        let ragged = |given, columns| CurveError::RaggedGrid { given, columns };
        assert_eq!(new(0, 4, Ends::Kept), ragged(4, 0));
        assert_eq!(new(4, 9, Ends::Kept), ragged(9, 4));
        let few = |given, least| CurveError::TooFewPoints { given, least };
        assert_eq!(new(3, 12, Ends::Dropped), few(3, 4));
        assert_eq!(new(2, 12, Ends::Closed), few(2, 3));
        assert_eq!(new(4, 4, Ends::Kept), few(1, 2));
        assert_eq!(new(4, 0, Ends::Kept), few(0, 2));
        for ends in ALL {
            let grid = ControlGrid::new(5, [Point::ZERO; 25], [ends; 2]).expect("5 × 5");
            for levels in [16, 64, u32::MAX] {
                let error = grid.refined(levels).unwrap_err();
                assert!(matches!(error, CurveError::TooManyPoints { .. }));
            }
        }
    }

    #[test]
    fn a_step_equals_that_of_catmull_clark() {
        let points: Vec<Point> = (0..42)
            .map(|i| Point::new((i % 7) as f32, (i / 7) as f32, (i * i % 11) as f32))
            .collect();
        let scheme = Subdivision::new(Scheme::CatmullClark);
        for of_rows in ALL {
            for of_columns in ALL {
                let ends = [of_rows, of_columns];
                let grid = ControlGrid::new(7, points.clone(), ends).expect("7 × 6");
                let polygons = grid.to_polygons().expect("small");
                let mesh = IndexedFaceSet::from_polygons(&polygons).expect("a grid");
                let control = scheme.control_creases(&mesh, &polygons, &Creases::default());
                let step = scheme
                    .gather(&mesh, &control.expect("none"), 0)
                    .expect("quads");
                let all = step.polygons.positions();
                let refined = grid.refined(1).expect("small");
                if ends.contains(&Ends::Dropped) {
                    for &point in refined.points() {
                        assert!(all.iter().any(|p| p.distance(point) < 1e-6), "{point}");
                    }
                } else {
                    assert_eq!(all.len(), refined.points().len());
                    for &point in all {
                        let near = |p: &&Point| p.distance(point) < 1e-6;
                        assert!(refined.points().iter().any(|p| near(&p)), "{point}");
                    }
                    let centres = |mesh: &PolygonMesh| {
                        let centre = |face: &[VertexId]| -> Point {
                            face.iter().map(|&v| mesh.position(v)).sum()
                        };
                        sorted(mesh.faces().iter().map(|(_, face)| centre(face)))
                    };
                    let refined = refined.to_polygons().expect("small");
                    assert_eq!(centres(&step.polygons), centres(&refined));
                }
            }
        }
    }

    #[test]
    fn quads_face_up_and_closed_ends_are_joined() {
        let points: Vec<Point> = (0..16)
            .map(|i| Point::new((i % 4) as f32, (i / 4) as f32, 0.0))
            .collect();
        let faces = |ends| {
            let grid = ControlGrid::new(4, points.clone(), ends).expect("4 × 4");
            grid.to_polygons().expect("small")
        };
        let open = faces([Ends::Kept; 2]);
        assert_eq!(open.face_count(), 9);
        for (_, face) in open.faces().iter() {
            let [a, b, _, d] = [0, 1, 2, 3].map(|corner| open.position(face[corner]));
            assert_eq!((b - a).cross(d - a), Point::Z);
        }
        assert_eq!(faces([Ends::Closed, Ends::Kept]).face_count(), 12);
        let torus = faces([Ends::Closed; 2]);
        assert_eq!(torus.face_count(), 16);
        assert!(!torus.edge_uses().iter().any(|edge| edge.is_boundary()));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn points_approach_the_patch(grid in grid()) {
            let levels = 5;
            let refined = grid.refined(levels).expect("small");
            let step = f64::from(1 << levels).recip();
            let place = |direction: usize, i: usize| {
                let (first, last) = grid.domain()[direction];
                // With dropped ends, one point comes before the first parameter.
                let shift = f64::from(u8::from(grid.ends()[direction] == Ends::Dropped));
                let at = first + (i as f64 - shift) * step;
                (first <= at && at <= last).then_some(at)
            };
            let mut compared = 0;
            for (number, point) in refined.points().iter().enumerate() {
                let (i, j) = (number % refined.columns(), number / refined.columns());
                let (Some(u), Some(v)) = (place(0, i), place(1, j)) else { continue };
                let limit = grid.evaluate(u, v).expect("within the domain");
                prop_assert!(point.distance(limit) < 2e-2, "{} {}: {} {}", u, v, point, limit);
                compared += 1;
            }
            prop_assert!(compared >= (1 << levels) * (1 << levels));
        }

        #[test]
        fn a_step_does_not_change_the_patch(grid in grid(), at in prop::array::uniform2(0.0..1.0)) {
            let refined = grid.refined(1).expect("small");
            let place = |grid: &ControlGrid, direction: usize| {
                let (first, last) = grid.domain()[direction];
                first + at[direction] * (last - first)
            };
            let [before, after] = [&grid, &refined]
                .map(|grid| grid.evaluate(place(grid, 0), place(grid, 1)).expect("within"));
            prop_assert!(before.distance(after) < 1e-4, "{} {}", before, after);
        }
    }
}
