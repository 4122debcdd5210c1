//! Surfaces that close around an axis: the torus and the Möbius strip.

use sixfold_core::PolygonMesh;

use crate::arithmetic::unit_circle;
use crate::builder::MeshBuilder;
use crate::error::{MAX_SEGMENTS, ShapeError, check_corners, check_count};

/// Radius of the tube of the torus, and half the width of the strip. The radius of the centre
/// circle is 1.
const TUBE: f64 = 0.4;

/// Builds a torus of `m` × `n` quads: `m` quads around the axis, and `n` quads around the tube.
///
/// The mesh has mn vertices, 2mn edges and mn faces. The Euler characteristic is 0.
///
/// # Errors
///
/// Fails if `m` or `n` is outside 3 to 2²⁰, or if there are more than 2³¹ − 1 corners.
pub fn torus(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    build_torus("torus", m, n, 4, |builder, [a, b, c, d]| {
        builder.add_face([a, b, c, d]);
    })
}

/// Builds a torus of `m` × `n` quads, each cut into two triangles. Every vertex has valence 6.
///
/// The mesh has mn vertices, 3mn edges and 2mn faces. The Euler characteristic is 0.
///
/// # Errors
///
/// Fails if `m` or `n` is outside 3 to 2²⁰, or if there are more than 2³¹ − 1 corners.
pub fn triangle_torus(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    build_torus("triangle-torus", m, n, 6, |builder, [a, b, c, d]| {
        builder.add_face([a, b, c]);
        builder.add_face([a, c, d]);
    })
}

/// Builds a torus. `cell` adds the faces of one cell; these faces have `degrees` corners in all.
fn build_torus(
    shape: &'static str,
    m: usize,
    n: usize,
    degrees: u64,
    cell: impl Fn(&mut MeshBuilder, [u32; 4]),
) -> Result<PolygonMesh, ShapeError> {
    check_count("m", m, 3, MAX_SEGMENTS)?;
    check_count("n", n, 3, MAX_SEGMENTS)?;
    let corners = degrees * m as u64 * n as u64;
    let corners = check_corners(shape, &[("m", m), ("n", n)], corners)?;
    let mut builder = MeshBuilder::with_capacity(m * n, corners);
    let tube: Vec<[f64; 2]> = (0..n).map(|j| unit_circle(j, n)).collect();
    for i in 0..m {
        let [x, y] = unit_circle(i, m);
        for [out, up] in &tube {
            let radius = 1.0 + TUBE * out;
            builder.add_vertex([radius * x, radius * y, TUBE * up]);
        }
    }
    let at = |i: usize, j: usize| ((i % m) * n + j % n) as u32;
    for i in 0..m {
        for j in 0..n {
            let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            cell(&mut builder, corners);
        }
    }
    Ok(builder.build())
}

/// Builds a Möbius strip of `n` quads: a one-sided surface with one boundary loop.
///
/// The mesh has 2n vertices, 3n edges and n faces. The Euler characteristic is 0.
///
/// ```text
///   b0 ── b1 ── b2 ··· ── bn = a0      the last rung is the first one, turned over
///   │     │     │         │
///   a0 ── a1 ── a2 ··· ── an = b0
/// ```
///
/// # Errors
///
/// Fails if `n` is outside 3 to 2²⁰.
pub fn moebius(n: usize) -> Result<PolygonMesh, ShapeError> {
    check_count("n", n, 3, MAX_SEGMENTS)?;
    let mut builder = MeshBuilder::with_capacity(2 * n, 4 * n);
    for i in 0..n {
        let [x, y] = unit_circle(i, n);
        // The rung rotates by half a turn while it moves once around the axis.
        let [out, up] = unit_circle(i, 2 * n).map(|x| TUBE * x);
        for side in [-1.0, 1.0] {
            let radius = 1.0 + side * out;
            builder.add_vertex([radius * x, radius * y, side * up]);
        }
    }
    let at = |i: usize, side: usize| {
        let side = if i < n { side } else { 1 - side };
        (2 * (i % n) + side) as u32
    };
    for i in 0..n {
        builder.add_face([at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1)]);
    }
    Ok(builder.build())
}
