//! Solids around an axis: prism, antiprism, and a sphere of meridians and parallels.

use std::f64::consts::FRAC_1_SQRT_2;

use sixfold_core::PolygonMesh;

use crate::arithmetic::turn;
use crate::draft::Draft;
use crate::error::{MAX_AROUND, ShapeError, corners_within, within};

/// Builds two `n`-gons joined by `n` quads; `n = 4` gives a cube.
///
/// V = 2n, E = 3n, F = n + 2.
///
/// # Errors
///
/// Fails if `n` is outside 3 to 2²⁰.
pub fn prism(n: usize) -> Result<PolygonMesh, ShapeError> {
    within("n", n, 3, MAX_AROUND)?;
    let mut draft = Draft::with_capacity(2 * n, 6 * n);
    ring(&mut draft, n, 0, -FRAC_1_SQRT_2);
    ring(&mut draft, n, 0, FRAC_1_SQRT_2);
    let n = n as u32;
    for i in 0..n {
        let j = (i + 1) % n;
        draft.face([i, j, n + j, n + i]);
    }
    caps(&mut draft, n);
    Ok(draft.finish())
}

/// Builds two `n`-gons, one rotated by half a step, joined by `2n` triangles; `n = 3` gives an
/// octahedron.
///
/// V = 2n, E = 4n, F = 2n + 2.
///
/// # Errors
///
/// Fails if `n` is outside 3 to 2²⁰.
pub fn antiprism(n: usize) -> Result<PolygonMesh, ShapeError> {
    within("n", n, 3, MAX_AROUND)?;
    let mut draft = Draft::with_capacity(2 * n, 8 * n);
    ring(&mut draft, n, 0, -FRAC_1_SQRT_2);
    ring(&mut draft, n, 1, FRAC_1_SQRT_2);
    let n = n as u32;
    for i in 0..n {
        let j = (i + 1) % n;
        draft.face([i, j, n + i]);
        draft.face([j, n + j, n + i]);
    }
    caps(&mut draft, n);
    Ok(draft.finish())
}

/// Builds a sphere of `m` meridians and `n` bands between the poles: triangles at the poles, quads
/// elsewhere.
///
/// V = m(n − 1) + 2, E = m(2n − 1), F = mn.
///
/// # Errors
///
/// Fails if `m` is outside 3 to 2²⁰, if `n` is outside 2 to 2²⁰, or if there are more than
/// 2³¹ − 1 corners.
pub fn uv_sphere(m: usize, n: usize) -> Result<PolygonMesh, ShapeError> {
    within("m", m, 3, MAX_AROUND)?;
    within("n", n, 2, MAX_AROUND)?;
    let corners = m as u64 * (4 * n as u64 - 2);
    let corners = corners_within("uv-sphere", &[("m", m), ("n", n)], corners)?;
    let mut draft = Draft::with_capacity(m * (n - 1) + 2, corners);
    let south = draft.vertex([0.0, 0.0, -1.0]);
    let circle: Vec<[f64; 2]> = (0..m).map(|i| turn(i, m)).collect();
    for band in 1..n {
        let [z, radius] = turn(n - band, 2 * n);
        for [x, y] in &circle {
            draft.vertex([radius * x, radius * y, z]);
        }
    }
    let north = draft.vertex([0.0, 0.0, 1.0]);
    let at = |band: usize, i: usize| south + 1 + ((band - 1) * m + i % m) as u32;
    for i in 0..m {
        draft.face([south, at(1, i + 1), at(1, i)]);
    }
    for band in 1..n - 1 {
        for i in 0..m {
            draft.face([
                at(band, i),
                at(band, i + 1),
                at(band + 1, i + 1),
                at(band + 1, i),
            ]);
        }
    }
    for i in 0..m {
        draft.face([at(n - 1, i), at(n - 1, i + 1), north]);
    }
    Ok(draft.finish())
}

/// Adds `n` vertices on the unit circle at height `z`, rotated by `half_steps` half steps.
fn ring(draft: &mut Draft, n: usize, half_steps: usize, z: f64) {
    for i in 0..n {
        let [x, y] = turn(2 * i + half_steps, 2 * n);
        draft.vertex([x, y, z]);
    }
}

/// Adds the first `n` vertices as a face that looks down, and the next `n` as a face that looks up.
fn caps(draft: &mut Draft, n: u32) {
    draft.face((0..n).rev());
    draft.face(n..2 * n);
}
