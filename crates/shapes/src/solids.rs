//! Solids around an axis: prism, antiprism, and a sphere of meridians and parallels.

use std::f64::consts::FRAC_1_SQRT_2;

use sixfold_core::PolygonMesh;

use crate::arithmetic::unit_circle;
use crate::builder::MeshBuilder;
use crate::error::{MAX_SEGMENTS, ShapeError, check_corners, check_count};

/// Builds a prism: two `n`-gons joined by `n` quads. A prism with `n` = 4 is a cube.
///
/// The mesh has 2n vertices, 3n edges and n + 2 faces.
///
/// # Errors
///
/// Fails if `n` is outside 3 to 2²⁰.
pub fn prism(n: usize) -> Result<PolygonMesh, ShapeError> {
    check_count("n", n, 3, MAX_SEGMENTS)?;
    let mut builder = MeshBuilder::with_capacity(2 * n, 6 * n);
    ring(&mut builder, n, 0, -FRAC_1_SQRT_2);
    ring(&mut builder, n, 0, FRAC_1_SQRT_2);
    let n = n as u32;
    for i in 0..n {
        let j = (i + 1) % n;
        builder.add_face([i, j, n + j, n + i]);
    }
    caps(&mut builder, n);
    Ok(builder.build())
}

/// Builds an antiprism: two `n`-gons, one of them rotated by half a step, joined by `2n` triangles.
/// An antiprism with `n` = 3 is an octahedron.
///
/// The mesh has 2n vertices, 4n edges and 2n + 2 faces.
///
/// # Errors
///
/// Fails if `n` is outside 3 to 2²⁰.
pub fn antiprism(n: usize) -> Result<PolygonMesh, ShapeError> {
    check_count("n", n, 3, MAX_SEGMENTS)?;
    let mut builder = MeshBuilder::with_capacity(2 * n, 8 * n);
    ring(&mut builder, n, 0, -FRAC_1_SQRT_2);
    ring(&mut builder, n, 1, FRAC_1_SQRT_2);
    let n = n as u32;
    for i in 0..n {
        let j = (i + 1) % n;
        builder.add_face([i, j, n + i]);
        builder.add_face([j, n + j, n + i]);
    }
    caps(&mut builder, n);
    Ok(builder.build())
}

/// Builds a sphere of `m` meridians and `n` bands of faces between the poles. The faces are
/// triangles at the poles and quads elsewhere.
///
/// The mesh has m(n − 1) + 2 vertices, m(2n − 1) edges and mn faces.
///
/// # Errors
///
/// Fails if `m` is outside 3 to 2²⁰, if `n` is outside 2 to 2²⁰, or if there are more than
/// 2³¹ − 1 corners.
pub fn uv_sphere(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    check_count("m", m, 3, MAX_SEGMENTS)?;
    check_count("n", n, 2, MAX_SEGMENTS)?;
    let corners = m as u64 * (4 * n as u64 - 2);
    let corners = check_corners("uv-sphere", &[("m", m), ("n", n)], corners)?;
    let mut builder = MeshBuilder::with_capacity(m * (n - 1) + 2, corners);
    let south = builder.add_vertex([0.0, 0.0, -1.0]);
    let circle: Vec<[f64; 2]> = (0..m).map(|i| unit_circle(i, m)).collect();
    for band in 1..n {
        let [z, radius] = unit_circle(n - band, 2 * n);
        for [x, y] in &circle {
            builder.add_vertex([radius * x, radius * y, z]);
        }
    }
    let north = builder.add_vertex([0.0, 0.0, 1.0]);
    let at = |band: usize, i: usize| south + 1 + ((band - 1) * m + i % m) as u32;
    for i in 0..m {
        builder.add_face([south, at(1, i + 1), at(1, i)]);
    }
    for band in 1..n - 1 {
        for i in 0..m {
            builder.add_face([
                at(band, i),
                at(band, i + 1),
                at(band + 1, i + 1),
                at(band + 1, i),
            ]);
        }
    }
    for i in 0..m {
        builder.add_face([at(n - 1, i), at(n - 1, i + 1), north]);
    }
    Ok(builder.build())
}

/// Adds `n` vertices on the unit circle at height `z`, rotated by `half_steps` half steps.
fn ring(builder: &mut MeshBuilder, n: usize, half_steps: usize, z: f64) {
    for i in 0..n {
        let [x, y] = unit_circle(2 * i + half_steps, 2 * n);
        builder.add_vertex([x, y, z]);
    }
}

/// Adds a lower face with the first `n` vertices, and an upper face with the next `n` vertices.
fn caps(builder: &mut MeshBuilder, n: u32) {
    builder.add_face((0..n).rev());
    builder.add_face(n..2 * n);
}
