//! Writes STL.

use std::io::{self, Write};

use sixfold_core::glam::DVec3;
use sixfold_core::{Point, PolygonMesh, row};

use super::{Numbers, triangle_count, triangles};
use crate::format::STL_HEADER;

/// The text at the start of a binary file. It must not begin with `solid`.
const TITLE: &[u8] = b"binary STL";

pub(super) fn write_binary(polygons: &PolygonMesh, out: &mut impl Write) -> io::Result<()> {
    let mut header = [b' '; STL_HEADER];
    header[..TITLE.len()].copy_from_slice(TITLE);
    // There are at least as many corners as triangles, so the number fits 32 bits.
    let count = row(triangle_count(polygons));
    header[STL_HEADER - 4..].copy_from_slice(&count.to_le_bytes());
    out.write_all(&header)?;
    for triangle in triangles(polygons) {
        let corners = triangle.map(|v| polygons.position(v));
        for point in [normal(corners)].into_iter().chain(corners) {
            for x in point.to_array() {
                out.write_all(&x.to_le_bytes())?;
            }
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

pub(super) fn write_ascii(polygons: &PolygonMesh, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "solid mesh")?;
    for triangle in triangles(polygons) {
        let corners = triangle.map(|v| polygons.position(v));
        writeln!(out, "facet normal {}\nouter loop", Numbers(normal(corners)))?;
        for point in corners {
            writeln!(out, "vertex {}", Numbers(point))?;
        }
        writeln!(out, "endloop\nendfacet")?;
    }
    writeln!(out, "endsolid mesh")
}

/// Returns the unit normal of a triangle; zero if the triangle has no area.
fn normal(corners: [Point; 3]) -> Point {
    // The products of 32-bit coordinates may overflow in 32 bits.
    let [a, b, c]: [DVec3; 3] = corners.map(|p| p.as_dvec3());
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}
