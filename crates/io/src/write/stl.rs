//! Writes STL.

use std::io::{self, Write};

use sixfold_core::glam::DVec3;
use sixfold_core::{Point, PolygonMesh, row};

use super::{Numbers, Placed, WriteOptions};
use crate::format::STL_HEADER;

/// The text at the start of a binary file. It must not begin with `solid`.
const TITLE: &[u8] = b"binary STL";

/// Writes a mesh of triangles.
pub(super) fn write_binary(
    triangles: &PolygonMesh,
    options: &WriteOptions<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut header = [b' '; STL_HEADER];
    header[..TITLE.len()].copy_from_slice(TITLE);
    let count = row(triangles.face_count());
    header[STL_HEADER - 4..].copy_from_slice(&count.to_le_bytes());
    out.write_all(&header)?;
    for corners in corners(triangles) {
        let placed = corners.map(|point| match options.placed(point) {
            Placed::Narrow(point) => point,
            Placed::Wide(point) => point.as_vec3(),
        });
        for point in [normal(corners)].into_iter().chain(placed) {
            for x in point.to_array() {
                out.write_all(&x.to_le_bytes())?;
            }
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

/// Writes a mesh of triangles.
pub(super) fn write_ascii(
    triangles: &PolygonMesh,
    options: &WriteOptions<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    writeln!(out, "solid mesh")?;
    for corners in corners(triangles) {
        writeln!(out, "facet normal {}\nouter loop", Numbers(normal(corners)))?;
        for point in corners {
            writeln!(out, "vertex {}", options.placed(point))?;
        }
        writeln!(out, "endloop\nendfacet")?;
    }
    writeln!(out, "endsolid mesh")
}

/// Returns the positions of the corners of each triangle.
fn corners(triangles: &PolygonMesh) -> impl Iterator<Item = [Point; 3]> {
    let all = triangles.faces().corners().as_chunks::<3>().0.iter();
    all.map(|triangle| triangle.map(|v| triangles.position(v)))
}

/// Returns the unit normal of a triangle; zero if the triangle has no area.
fn normal(corners: [Point; 3]) -> Point {
    // The products of 32-bit coordinates may overflow in 32 bits.
    let [a, b, c]: [DVec3; 3] = corners.map(|p| p.as_dvec3());
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}
