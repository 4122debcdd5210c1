//! Writes OFF.

use std::io::{self, Write};

use sixfold_core::PolygonMesh;

use super::WriteOptions;

pub(super) fn write(
    polygons: &PolygonMesh,
    options: &WriteOptions<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let (vertices, faces) = (polygons.vertex_count(), polygons.face_count());
    // The third number, of edges, may be 0.
    writeln!(out, "OFF\n{vertices} {faces} 0")?;
    for &point in polygons.positions() {
        writeln!(out, "{}", options.placed(point))?;
    }
    for (_, face) in polygons.faces().iter() {
        write!(out, "{}", face.len())?;
        for v in face {
            write!(out, " {}", v.index())?;
        }
        writeln!(out)?;
    }
    Ok(())
}
