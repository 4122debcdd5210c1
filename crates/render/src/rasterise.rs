//! Rasterisation: converts polygons into samples (points of the depth buffer).

use std::ops::Range;

use glam::DVec3;

/// A corner of a polygon on the grid of samples.
#[derive(Clone, Copy)]
pub(crate) struct Corner {
    /// Coordinates in samples: right, down, and towards the viewer.
    pub(crate) position: DVec3,
    /// The surface normal at the corner.
    pub(crate) normal: DVec3,
}

/// The samples of one row between two sides of a polygon.
pub(crate) struct Span {
    pub(crate) row: usize,
    pub(crate) columns: Range<usize>,
    /// The points on the sides, from left to right.
    ends: [Corner; 2],
}

impl Span {
    /// Returns the part between the sides where the middle of a column is.
    fn part(&self, column: usize) -> f64 {
        let [left, right] = self.ends.map(|end| end.position.x);
        (column as f64 + 0.5 - left) / (right - left)
    }

    /// Returns the coordinate towards the viewer, in samples.
    pub(crate) fn depth(&self, column: usize) -> f64 {
        let [from, to] = self.ends.map(|end| end.position.z);
        let part = self.part(column);
        from * (1.0 - part) + to * part
    }

    /// Returns the surface normal, of any length.
    pub(crate) fn normal(&self, column: usize) -> DVec3 {
        let [from, to] = self.ends;
        from.normal.lerp(to.normal, self.part(column))
    }
}

/// The point where a side crosses the middle of a row.
#[derive(Clone, Copy)]
struct Crossing {
    row: usize,
    corner: Corner,
}

/// Fills polygons on a grid.
///
/// A point is inside a polygon if a line from the left to the point crosses an odd number of sides.
/// Coordinates and normals are interpolated along sides and then between sides (Bouknight 1970). So
/// polygons that share a side leave no gap, even if the polygons are not planar.
///
/// ```text
///       ╱╲          ╱╲
/// ─────╱──╲────────╱──╲─────  one row: filled from 1 to 2, and from 3 to 4
///     1    2──────3    4
/// ```
pub(crate) struct Rasteriser {
    columns: usize,
    rows: usize,
    crossings: Vec<Crossing>,
}

impl Rasteriser {
    pub(crate) fn new(columns: usize, rows: usize) -> Self {
        Self {
            columns,
            rows,
            crossings: Vec::new(),
        }
    }

    /// Calls `emit` with the samples inside the polygon, row by row; O(crossings · log).
    pub(crate) fn rasterise(&mut self, corners: &[Corner], mut emit: impl FnMut(&Span)) {
        /// Maximum number of crossings in memory, unless one row has more.
        const MAX_CROSSINGS: usize = 1 << 16;
        let heights = corners.iter().map(|corner| corner.position.y);
        let lowest = heights.clone().fold(f64::INFINITY, f64::min);
        let highest = heights.fold(f64::NEG_INFINITY, f64::max);
        let rows = samples_between(lowest, highest, self.rows);
        let batch = (MAX_CROSSINGS / corners.len().max(1)).max(1);
        for start in rows.clone().step_by(batch) {
            let batch = start..(start + batch).min(rows.end);
            self.find_crossings(corners, &batch);
            self.emit_spans(&mut emit);
        }
    }

    /// Finds the points where the sides cross these rows, sorted by row and then from left to
    /// right.
    fn find_crossings(&mut self, corners: &[Corner], rows: &Range<usize>) {
        self.crossings.clear();
        let next = corners.iter().cycle().skip(1);
        for (&a, &b) in corners.iter().zip(next) {
            // Both faces at a side use the same direction, so both have the same rounding.
            let (low, high) = if (a.position.y, a.position.x) <= (b.position.y, b.position.x) {
                (a, b)
            } else {
                (b, a)
            };
            let crossed = samples_between(low.position.y, high.position.y, self.rows);
            let height = high.position.y - low.position.y;
            for row in crossed.start.max(rows.start)..crossed.end.min(rows.end) {
                let t = (row as f64 + 0.5 - low.position.y) / height;
                let corner = low.interpolate(high, t);
                self.crossings.push(Crossing { row, corner });
            }
        }
        self.crossings.sort_by(|a, b| {
            let (x, other) = (a.corner.position.x, b.corner.position.x);
            a.row.cmp(&b.row).then(x.total_cmp(&other))
        });
    }

    /// Fills between each pair of crossings of a row.
    fn emit_spans(&self, emit: &mut impl FnMut(&Span)) {
        for pair in self.crossings.chunks_exact(2) {
            let ends = [pair[0].corner, pair[1].corner];
            let [left, right] = ends.map(|end| end.position.x);
            emit(&Span {
                row: pair[0].row,
                columns: samples_between(left, right, self.columns),
                ends,
            });
        }
    }
}

impl Corner {
    fn interpolate(self, other: Self, t: f64) -> Self {
        Self {
            position: self.position.lerp(other.position, t),
            normal: self.normal.lerp(other.normal, t),
        }
    }
}

/// Returns the samples whose centres are at or after `low` and before `high`.
fn samples_between(low: f64, high: f64, count: usize) -> Range<usize> {
    // First sample whose centre is at or after `x`. The cast turns negative values into 0.
    let first = |x: f64| ((x - 0.5).ceil() as usize).min(count);
    first(low)..first(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns how often each sample was filled.
    fn rasterised(polygons: &[&[(f64, f64)]]) -> Vec<String> {
        let mut rasteriser = Rasteriser::new(8, 6);
        let mut counts = [[0; 8]; 6];
        for polygon in polygons {
            let corners: Vec<Corner> = polygon
                .iter()
                .map(|&(x, y)| Corner {
                    position: DVec3::new(x, y, x + 2.0 * y),
                    normal: DVec3::Z,
                })
                .collect();
            rasteriser.rasterise(&corners, |span| {
                for column in span.columns.clone() {
                    counts[span.row][column] += 1;
                    let (x, y) = (column as f64 + 0.5, span.row as f64 + 0.5);
                    assert!(
                        (span.depth(column) - x - 2.0 * y).abs() < 1e-9,
                        "the depth is interpolated linearly"
                    );
                }
            });
        }
        let digits = |row: [i32; 8]| row.map(|n| n.to_string()).concat().replace('0', ".");
        counts.map(digits).to_vec()
    }

    #[test]
    fn polygons_that_share_sides_fill_each_sample_once() {
        let middle = (3.7, 2.9);
        let (a, b, c, d) = ((-3.0, -1.0), (9.1, -2.0), (8.5, 7.0), (-1.0, 6.5));
        let fan: [&[(f64, f64)]; 4] = [
            &[a, b, middle],
            &[c, middle, b],
            &[middle, c, d],
            &[d, a, middle],
        ];
        assert_eq!(rasterised(&fan), ["11111111"; 6]);
    }

    #[test]
    fn polygons_that_are_not_convex_are_filled() {
        let horseshoe = [
            (1.0, 0.0),
            (7.0, 0.0),
            (7.0, 5.0),
            (5.0, 5.0),
            (5.0, 2.0),
            (3.0, 2.0),
            (3.0, 5.0),
            (1.0, 5.0),
        ];
        let expected = [
            ".111111.", ".111111.", ".11..11.", ".11..11.", ".11..11.", "........",
        ];
        assert_eq!(rasterised(&[&horseshoe]), expected);
        let backwards: Vec<(f64, f64)> = horseshoe.into_iter().rev().collect();
        assert_eq!(rasterised(&[&backwards]), expected);
    }

    #[test]
    fn polygons_outside_or_without_area_fill_nothing() {
        let nothing = ["........"; 6];
        assert_eq!(
            rasterised(&[&[(-9.0, 1.0), (-1.0, 1.0), (-5.0, 4.0)]]),
            nothing
        );
        assert_eq!(
            rasterised(&[&[(1.0, 1.0), (5.0, 1.0), (3.0, 1.0)]]),
            nothing
        );
        assert_eq!(
            rasterised(&[&[(1.0, 1.0), (3.0, 3.0), (5.0, 5.0)]]),
            nothing
        );
    }

    #[test]
    fn many_corners_are_filled_in_batches() {
        let teeth = 40_000;
        let mut comb = vec![(8.0, 6.0), (0.0, 6.0)];
        for tooth in 0..teeth {
            let x = 8.0 * f64::from(tooth) / f64::from(teeth);
            comb.extend([(x, 0.0), (x, 5.0)]);
        }
        let rows = rasterised(&[&comb]);
        assert_eq!(rows[5], "11111111");
    }
}
