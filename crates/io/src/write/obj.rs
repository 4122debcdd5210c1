//! Writes OBJ files.

use std::fmt;
use std::io::{self, Write};

use sixfold_core::{Creases, PolygonMesh, VertexId};

use super::{Numbers, WriteOptions};

/// Writes the text; a face is written without normals if one of its corners has no normal.
pub(super) fn write_text(
    polygons: &PolygonMesh,
    options: &WriteOptions<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let (positions, normals) = (polygons.positions(), options.normals);
    let (vertices, faces) = (polygons.vertex_count(), polygons.face_count());
    writeln!(out, "# vertices: {vertices}, faces: {faces}")?;
    for &p in positions {
        writeln!(out, "v {}", options.placed(p))?;
    }
    // For each vertex, the number of its normal in the file.
    let mut numbers = Vec::with_capacity(normals.len());
    let mut number = 0;
    for normal in normals {
        numbers.push(normal.map(|_| number + 1));
        if let &Some(n) = normal {
            number += 1;
            writeln!(out, "vn {}", Numbers(n))?;
        }
    }
    let normal = |v: &VertexId| numbers.get(v.index()).copied().flatten();
    for (_, face) in polygons.faces().iter() {
        let has_normals = face.iter().all(|v| normal(v).is_some());
        write!(out, "f")?;
        for v in face {
            write!(out, " {}", v.index() + 1)?;
            if let (true, Some(normal)) = (has_normals, normal(v)) {
                write!(out, "//{normal}")?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Writes a tag for each sharp edge and vertex. The vertices of tags count from 0.
pub(super) fn write_tags(creases: &Creases, out: &mut impl Write) -> io::Result<()> {
    for &(edge, sharpness) in creases.edges() {
        let [a, b] = edge.ends().map(VertexId::index);
        writeln!(out, "t crease 2/1/0 {a} {b} {}", ShortestDecimal(sharpness))?;
    }
    for &(vertex, sharpness) in creases.corners() {
        let (v, sharpness) = (vertex.index(), ShortestDecimal(sharpness));
        writeln!(out, "t corner 1/1/0 {v} {sharpness}")?;
    }
    Ok(())
}

/// A number that is formatted with the fewest digits that read back as the same number. Very small
/// and very large numbers are written with a power of ten.
pub(crate) struct ShortestDecimal(pub(crate) f32);

impl fmt::Display for ShortestDecimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e9).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::Point;

    use super::*;
    use crate::format::Format;
    use crate::write::{WriteError, write_to};

    fn written(mesh: &PolygonMesh, out: impl Write) -> Result<(), WriteError> {
        write_to(mesh, Format::Obj, &WriteOptions::default(), out).map(drop)
    }

    #[test]
    fn normals_are_written_if_all_corners_of_a_face_have_them() {
        let corners = [Point::ZERO, Point::X, Point::Y, Point::ONE];
        let mesh = PolygonMesh::new(corners, [[0, 1, 2], [1, 3, 2]]).expect("valid");
        let normals = [Some(Point::Z), Some(Point::Z), Some(Point::Z), None];
        let mut text = Vec::new();
        let options = WriteOptions::default().with_normals(&normals);
        write_to(&mesh, Format::Obj, &options, &mut text).expect("memory does not fail");
        let text = String::from_utf8(text).expect("ASCII");
        assert!(
            text.ends_with("vn 0 0 1\nf 1//1 2//2 3//3\nf 2 4 3\n"),
            "{text}"
        );
        let too_few = WriteOptions::default().with_normals(&normals[1..]);
        assert!(write_to(&mesh, Format::Obj, &too_few, &mut Vec::new()).is_err());
    }

    #[test]
    fn a_mesh_is_written_with_the_fewest_digits() {
        let positions = [
            Point::new(0.1, -0.0, 100.0),
            Point::new(1e-30, f32::MAX, -f32::from_bits(1)),
            Point::new(0.00001, 999_999_940.0, 1e9),
        ];
        let mesh = PolygonMesh::new(positions, [[2, 1, 0]]).expect("valid");
        let mut text = Vec::new();
        written(&mesh, &mut text).expect("memory does not fail");
        let expected = "# vertices: 3, faces: 1\nv 0.1 -0 100\nv 1e-30 3.4028235e38 -1e-45\n\
                    v 0.00001 999999940 1e9\nf 3 2 1\n";
        assert_eq!(String::from_utf8(text).expect("text"), expected);
    }

    #[test]
    fn a_mesh_that_is_not_finite_is_not_written() {
        for bad in [f32::NAN, f32::INFINITY] {
            let positions = [Point::ZERO, Point::new(0.0, bad, 0.0)];
            let mesh = PolygonMesh::new(positions, [[0_u32; 0]; 0]).expect("valid");
            let mut text = Vec::new();
            let error = written(&mesh, &mut text).expect_err("not finite");
            let message = "the position of vertex v1 is not finite, so OBJ cannot store it: \
                           correct the position";
            assert_eq!(error.to_string(), message);
            assert_eq!(io::Error::from(error).kind(), io::ErrorKind::InvalidInput);
            assert!(text.is_empty());
        }
    }

    #[test]
    fn a_full_disk_is_reported() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let error = written(&PolygonMesh::default(), Full).expect_err("full");
        assert_eq!(io::Error::from(error).kind(), io::ErrorKind::StorageFull);
    }
}
