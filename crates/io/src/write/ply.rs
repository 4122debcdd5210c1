//! Writes PLY.

use std::io::{self, Write};

use sixfold_core::{Point, PolygonMesh, RowId};

use super::{Placed, ShortestDecimal, WriteOptions};
use crate::format::Format;
use crate::ply::ByteOrder;

pub(super) fn write(
    polygons: &PolygonMesh,
    options: &WriteOptions<'_>,
    format: Format,
    out: &mut impl Write,
) -> io::Result<()> {
    let faces = polygons.faces().iter();
    let max_degree = faces.map(|(_, face)| face.len()).max().unwrap_or(3);
    let has_short_lists = max_degree <= usize::from(u8::MAX);
    write_header(polygons, options, has_short_lists, format, out)?;
    match format {
        Format::PlyAscii => write_ascii(polygons, options, out),
        Format::PlyBigEndian => {
            write_binary(polygons, options, has_short_lists, ByteOrder::Big, out)
        }
        _ => write_binary(polygons, options, has_short_lists, ByteOrder::Little, out),
    }
}

fn write_header(
    polygons: &PolygonMesh,
    options: &WriteOptions<'_>,
    has_short_lists: bool,
    format: Format,
    out: &mut impl Write,
) -> io::Result<()> {
    let form = match format {
        Format::PlyAscii => "ascii",
        Format::PlyBigEndian => "binary_big_endian",
        _ => "binary_little_endian",
    };
    let (vertices, faces) = (polygons.vertex_count(), polygons.face_count());
    writeln!(out, "ply\nformat {form} 1.0\nelement vertex {vertices}")?;
    let coordinate = match options.placed(Point::ZERO) {
        Placed::Narrow(_) => "float",
        Placed::Wide(_) => "double",
    };
    for name in ["x", "y", "z"] {
        writeln!(out, "property {coordinate} {name}")?;
    }
    if !options.complete_normals().is_empty() {
        for name in ["nx", "ny", "nz"] {
            writeln!(out, "property float {name}")?;
        }
    }
    let length = if has_short_lists { "uchar" } else { "uint" };
    // Some programs read only `int`.
    let item = if i32::try_from(vertices).is_ok() {
        "int"
    } else {
        "uint"
    };
    writeln!(out, "element face {faces}")?;
    writeln!(
        out,
        "property list {length} {item} vertex_indices\nend_header"
    )
}

fn write_ascii(
    polygons: &PolygonMesh,
    options: &WriteOptions<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let normals = options.complete_normals();
    for (number, &point) in polygons.positions().iter().enumerate() {
        write!(out, "{}", options.placed(point))?;
        if let Some(normal) = normals.get(number).copied().flatten() {
            for x in normal.to_array() {
                write!(out, " {}", ShortestDecimal(x))?;
            }
        }
        writeln!(out)?;
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

fn write_binary(
    polygons: &PolygonMesh,
    options: &WriteOptions<'_>,
    has_short_lists: bool,
    order: ByteOrder,
    out: &mut impl Write,
) -> io::Result<()> {
    let normals = options.complete_normals();
    let ordered = |number: u32| match order {
        ByteOrder::Little => number.to_le_bytes(),
        ByteOrder::Big => number.to_be_bytes(),
    };
    for (number, &point) in polygons.positions().iter().enumerate() {
        let narrow = match options.placed(point) {
            Placed::Narrow(point) => Some(point),
            Placed::Wide(point) => {
                for x in point.to_array().map(f64::to_bits) {
                    let halves = [x as u32, (x >> 32) as u32];
                    let [first, second] = match order {
                        ByteOrder::Little => halves,
                        ByteOrder::Big => [halves[1], halves[0]],
                    };
                    out.write_all(&ordered(first))?;
                    out.write_all(&ordered(second))?;
                }
                None
            }
        };
        let normal = normals.get(number).copied().flatten();
        for x in narrow.into_iter().chain(normal).flat_map(|p| p.to_array()) {
            out.write_all(&ordered(x.to_bits()))?;
        }
    }
    for (_, face) in polygons.faces().iter() {
        let degree = sixfold_core::row(face.len());
        match u8::try_from(degree) {
            Ok(degree) if has_short_lists => out.write_all(&[degree])?,
            _ => out.write_all(&ordered(degree))?,
        }
        for v in face {
            out.write_all(&ordered(v.row()))?;
        }
    }
    Ok(())
}
