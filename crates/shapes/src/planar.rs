//! Flat meshes: grids of quads and triangles with and without holes, and tilings.

use sixfold_core::PolygonMesh;

use crate::builder::MeshBuilder;
use crate::error::{MAX_SIDE, ShapeError, check_corners, check_count};

/// Builds `m` × `n` unit squares: the regular tiling {4, 4}.
///
/// The mesh has (m + 1)(n + 1) vertices, m(n + 1) + n(m + 1) edges and mn faces.
///
/// # Errors
///
/// Fails if `m` or `n` is outside 1 to 2²², or if there are more than 2³¹ − 1 corners.
pub fn grid(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    quad_grid("grid", m, n, |i, j| [i as f64, j as f64, 0.0])
}

/// Builds `m` × `n` quads. The vertex at column `i` and row `j` is at `position(i, j)`.
pub(crate) fn quad_grid(
    shape: &'static str,
    m: usize,
    n: usize,
    position: impl FnMut(usize, usize) -> [f64; 3],
) -> Result<PolygonMesh, ShapeError> {
    let corners = 4 * square_count(m, n)?;
    grid_of_cells(shape, [m, n], corners, position, |_, _| Cell::Quad)
}

/// Builds `m` × `n` unit squares, each cut in two by the diagonal from lower left to upper right.
///
/// The mesh has (m + 1)(n + 1) vertices, 3mn + m + n edges and 2mn faces.
///
/// # Errors
///
/// Fails if `m` or `n` is outside 1 to 2²², or if there are more than 2³¹ − 1 corners.
pub fn triangle_grid(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    let corners = 6 * square_count(m, n)?;
    grid_of_cells(
        "triangle-grid",
        [m, n],
        corners,
        lattice_position,
        |_, _| Cell::Rising,
    )
}

/// Builds `m` × `n` unit squares. Every second square, as on a chess board, is cut into two
/// triangles.
///
/// The number of cut squares is c = ⌊mn/2⌋. The mesh has (m + 1)(n + 1) vertices,
/// m(n + 1) + n(m + 1) + c edges and mn + c faces.
///
/// # Errors
///
/// Fails if `m` or `n` is outside 1 to 2²², or if there are more than 2³¹ − 1 corners.
pub fn mixed_grid(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    let squares = square_count(m, n)?;
    let corners = 4 * squares + 2 * (squares / 2);
    grid_of_cells(
        "mixed-grid",
        [m, n],
        corners,
        lattice_position,
        |i, j| match (i + j) % 2 {
            0 => Cell::Quad,
            _ => Cell::Rising,
        },
    )
}

/// Builds `m` × `n` pairs of equilateral triangles of side 1: the regular tiling {3, 6}.
///
/// The mesh has (m + 1)(n + 1) vertices, 3mn + m + n edges and 2mn faces.
///
/// ```text
///      ╱╲╱╲╱╲╱      every second row of vertices is shifted half a step to the right
///      ╲╱╲╱╲╱╲
/// ```
///
/// # Errors
///
/// Fails if `m` or `n` is outside 1 to 2²², or if there are more than 2³¹ − 1 corners.
pub fn triangle_tiling(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    let corners = 6 * square_count(m, n)?;
    let height = 3.0_f64.sqrt() / 2.0;
    let position = |i: usize, j: usize| {
        let shift = 0.5 * (j % 2) as f64;
        [i as f64 + shift, j as f64 * height, 0.0]
    };
    let cell = |_, j: usize| match j % 2 {
        0 => Cell::Falling,
        _ => Cell::Rising,
    };
    grid_of_cells("triangle-tiling", [m, n], corners, position, cell)
}

/// Builds a frame: `m` × `n` unit squares without the a × b squares in the middle, for a = ⌊m/3⌋
/// and b = ⌊n/3⌋.
///
/// The mesh has (m + 1)(n + 1) − (a − 1)(b − 1) vertices, m(n + 1) + n(m + 1) − a(b − 1) − b(a − 1)
/// edges and mn − ab faces.
///
/// # Errors
///
/// Fails if `m` or `n` is outside 3 to 2²², or if there are more than 2³¹ − 1 corners.
pub fn grid_with_hole(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    check_count("m", m, 3, MAX_SIDE)?;
    check_count("n", n, 3, MAX_SIDE)?;
    let (a, b) = (m / 3, n / 3);
    let corners = 4 * (square_count(m, n)? - square_count(a, b)?);
    let (left, low) = ((m - a) / 2, (n - b) / 2);
    let cell = |i: usize, j: usize| {
        let hole = (left..left + a).contains(&i) && (low..low + b).contains(&j);
        if hole { Cell::Hole } else { Cell::Quad }
    };
    grid_of_cells("grid-with-hole", [m, n], corners, lattice_position, cell)
}

/// Builds `m` × `n` unit squares with `holes` missing squares. No two missing squares touch.
///
/// The mesh has (m + 1)(n + 1) vertices, m(n + 1) + n(m + 1) edges, mn − `holes` faces and 1 +
/// `holes` boundary loops.
///
/// ```text
///   ┌──┬──┬──┬──┬──┐
///   ├──┼──┼──┼──┼──┤      m = 5, n = 3, holes = 2; holes are placed row by row
///   ├──┤  ├──┤  ├──┤
///   ├──┼──┼──┼──┼──┤
///   └──┴──┴──┴──┴──┘
/// ```
///
/// # Errors
///
/// Fails if `m` or `n` is outside 1 to 2²², if `holes` exceeds ⌊(m − 1)/2⌋ · ⌊(n − 1)/2⌋, or if
/// there are more than 2³¹ − 1 corners.
pub fn grid_with_holes(m: usize, n: usize, holes: usize) -> Result<PolygonMesh, ShapeError> {
    let squares = square_count(m, n)?;
    let (max_columns, max_rows) = ((m - 1) / 2, (n - 1) / 2);
    check_count("holes", holes, 0, max_columns.saturating_mul(max_rows))?;
    let corners = 4 * (squares - holes as u64);
    let cell = |i: usize, j: usize| {
        let can_be_hole = i % 2 == 1 && j % 2 == 1 && i + 1 < m && j + 1 < n;
        match can_be_hole && (j / 2) * max_columns + i / 2 < holes {
            true => Cell::Hole,
            false => Cell::Quad,
        }
    };
    grid_of_cells("grid-with-holes", [m, n], corners, lattice_position, cell)
}

/// Builds `m` × `n` regular hexagons of side 1: the regular tiling {6, 3}. Every second row is
/// shifted half a step to the right.
///
/// The mesh has 2(m + 1)(n + 1) − 2 vertices, 3mn + 2m + 2n − 1 edges and mn faces.
///
/// ```text
///     │   │   │       m = 2, n = 2
///    ╱ ╲ ╱ ╲ ╱        Between two rows of hexagons there is a zigzag of 2m + 2 vertices;
///   │   │   │         the zigzags below the first and above the last row have 2m + 1.
///    ╲ ╱ ╲ ╱
/// ```
///
/// # Errors
///
/// Fails if `m` or `n` is outside 1 to 2²², or if there are more than 2³¹ − 1 corners.
pub fn hexagon_tiling(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    let corners = 6 * square_count(m, n)?;
    let corners = check_corners("hexagon-tiling", &[("m", m), ("n", n)], corners)?;
    let mut builder = MeshBuilder::with_capacity(2 * (m + 1) * (n + 1) - 2, corners);
    let half_width = 3.0_f64.sqrt() / 2.0;
    // Number of a vertex = step along the zigzag + offset of the zigzag.
    let mut offsets = Vec::with_capacity(n + 1);
    let mut count = 0_i64;
    for j in 0..=n {
        let shift = j % 2;
        let steps = match j {
            0 => 0..2 * m + 1,
            _ if j == n => (1 - shift)..2 * m + 2 - shift,
            _ => 0..2 * m + 2,
        };
        offsets.push(count - steps.start as i64);
        count += steps.len() as i64;
        for k in steps {
            let low = (k + shift) % 2 == 1;
            let y = 1.5 * j as f64 - if low { 0.5 } else { 0.0 };
            builder.add_vertex([k as f64 * half_width, y, 0.0]);
        }
    }
    let at = |j: usize, k: usize| (offsets[j] + k as i64) as u32;
    for j in 0..n {
        for i in 0..m {
            let k = 2 * i + j % 2;
            let below = [at(j, k), at(j, k + 1), at(j, k + 2)];
            let above = [at(j + 1, k + 2), at(j + 1, k + 1), at(j + 1, k)];
            builder.add_face(below.into_iter().chain(above));
        }
    }
    Ok(builder.build())
}

/// The faces of one square of a grid.
#[derive(Clone, Copy)]
enum Cell {
    /// A quad.
    Quad,
    /// Two triangles along the diagonal from lower left to upper right.
    Rising,
    /// Two triangles along the diagonal from upper left to lower right.
    Falling,
    /// No face.
    Hole,
}

fn square_count(m: usize, n: usize) -> Result<u64, ShapeError> {
    check_count("m", m, 1, MAX_SIDE)?;
    check_count("n", n, 1, MAX_SIDE)?;
    Ok(m as u64 * n as u64)
}

fn lattice_position(i: usize, j: usize) -> [f64; 3] {
    [i as f64, j as f64, 0.0]
}

/// Builds the faces `cell(i, j)` of `m` × `n` squares, with `corners` corners in all.
fn grid_of_cells(
    shape: &'static str,
    [m, n]: [usize; 2],
    corners: u64,
    mut position: impl FnMut(usize, usize) -> [f64; 3],
    cell: impl Fn(usize, usize) -> Cell,
) -> Result<PolygonMesh, ShapeError> {
    let corners = check_corners(shape, &[("m", m), ("n", n)], corners)?;
    let mut builder = MeshBuilder::with_capacity((m + 1) * (n + 1), corners);
    let hole = |i: usize, j: usize| matches!(cell(i, j), Cell::Hole);
    // The vertices on the lower and on the upper line of the current row of squares.
    let mut below = vec![None; m + 1];
    let mut above = vec![None; m + 1];
    for j in 0..=n {
        for (i, vertex) in above.iter_mut().enumerate() {
            let inner = 0 < i && i < m && 0 < j && j < n;
            let in_hole =
                inner && hole(i - 1, j - 1) && hole(i, j - 1) && hole(i - 1, j) && hole(i, j);
            *vertex = (!in_hole).then(|| builder.add_vertex(position(i, j)));
        }
        for i in (0..m).filter(|_| j > 0) {
            let square = [below[i], below[i + 1], above[i + 1], above[i]];
            let [Some(a), Some(b), Some(c), Some(d)] = square else {
                continue;
            };
            match cell(i, j - 1) {
                Cell::Quad => builder.add_face([a, b, c, d]),
                Cell::Rising => {
                    builder.add_face([a, b, c]);
                    builder.add_face([a, c, d]);
                }
                Cell::Falling => {
                    builder.add_face([a, b, d]);
                    builder.add_face([b, c, d]);
                }
                Cell::Hole => {}
            }
        }
        std::mem::swap(&mut below, &mut above);
    }
    Ok(builder.build())
}
