//! A closed surface of any genus.

use sixfold_core::PolygonMesh;

use crate::builder::MeshBuilder;
use crate::error::{MAX_SIDE, ShapeError, check_corners, check_count};

/// Builds the surface of a bar of unit cubes with `g` holes through the bar. The surface is closed,
/// consists of quads, and has genus `g`.
///
/// The mesh has 16(g + 1) vertices, 36g + 28 edges and 18g + 14 faces. The Euler characteristic is
/// 2 − 2g.
///
/// ```text
///   ┌──┬──┬──┬──┬──┐
///   ├──┼──┼──┼──┼──┤      g = 2, seen from above: 2g + 1 cells by 3, one cell thick
///   ├──┤░░├──┤░░├──┤
///   ├──┼──┼──┼──┼──┤
///   └──┴──┴──┴──┴──┘
/// ```
///
/// # Errors
///
/// Fails if `g` is above 2²².
pub fn genus(g: usize) -> Result<PolygonMesh, ShapeError> {
    check_count("g", g, 0, MAX_SIDE)?;
    let corners = check_corners("genus", &[("g", g)], 4 * (18 * g as u64 + 14))?;
    let mut builder = MeshBuilder::with_capacity(16 * (g + 1), corners);
    let (length, width) = (2 * g + 1, 3);
    for x in 0..=length {
        for y in 0..=width {
            for z in 0..2 {
                builder.add_vertex([x as f64, y as f64, z as f64]);
            }
        }
    }
    let solid = |x: usize, y: usize| x < length && y < width && !(x % 2 == 1 && y == 1);
    let at = |x: usize, y: usize, z: usize| ((x * (width + 1) + y) * 2 + z) as u32;
    // Adds the vertical wall above a → b. The wall faces to the right of a → b.
    let wall = |builder: &mut MeshBuilder, [ax, ay]: [usize; 2], [bx, by]: [usize; 2]| {
        builder.add_face([at(ax, ay, 0), at(bx, by, 0), at(bx, by, 1), at(ax, ay, 1)]);
    };
    for x in 0..length {
        for y in (0..width).filter(|&y| solid(x, y)) {
            builder.add_face([
                at(x, y, 1),
                at(x + 1, y, 1),
                at(x + 1, y + 1, 1),
                at(x, y + 1, 1),
            ]);
            builder.add_face([
                at(x, y, 0),
                at(x, y + 1, 0),
                at(x + 1, y + 1, 0),
                at(x + 1, y, 0),
            ]);
            if y == 0 || !solid(x, y - 1) {
                wall(&mut builder, [x, y], [x + 1, y]);
            }
            if !solid(x + 1, y) {
                wall(&mut builder, [x + 1, y], [x + 1, y + 1]);
            }
            if !solid(x, y + 1) {
                wall(&mut builder, [x + 1, y + 1], [x, y + 1]);
            }
            if x == 0 || !solid(x - 1, y) {
                wall(&mut builder, [x, y + 1], [x, y]);
            }
        }
    }
    Ok(builder.build())
}
