//! Writes glTF 2.0: one mesh with one primitive.

use std::io::{self, Write};

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use serde_json::{Value, json};
use sixfold_core::{Point, PolygonMesh, RowId};

use super::{WriteError, WriteOptions};
use crate::format::Format;

/// Codes of glTF.
const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const POINTS: u32 = 0;
const TRIANGLES: u32 = 4;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The place of a `uri` in the JSON text; base64 text takes its place.
const DATA_MARK: &str = "data:application/octet-stream;base64,";

/// Writes a mesh of triangles.
pub(super) fn write(
    triangles: &PolygonMesh,
    options: &WriteOptions<'_>,
    format: Format,
    out: &mut impl Write,
) -> Result<(), WriteError> {
    let normals = options.complete_normals();
    let layout = Layout::new(triangles, options);
    let json = layout.document(triangles, format).to_string();
    if format == Format::Gltf {
        let (before, after) = json.split_once(DATA_MARK).unwrap_or((&json, ""));
        out.write_all(before.as_bytes())?;
        if !after.is_empty() {
            out.write_all(DATA_MARK.as_bytes())?;
            let mut encoder = EncoderWriter::new(&mut *out, &STANDARD);
            write_data(triangles, normals, &mut encoder)?;
            encoder.finish()?;
        }
        out.write_all(after.as_bytes())?;
        return Ok(writeln!(out)?);
    }
    let Glb {
        padding,
        json_length,
        data_length,
        total,
    } = Glb::new(&json, &layout)?;
    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&total.to_le_bytes())?;
    out.write_all(&json_length.to_le_bytes())?;
    out.write_all(b"JSON")?;
    out.write_all(json.as_bytes())?;
    out.write_all(&b"   "[..padding])?;
    if data_length > 0 {
        out.write_all(&data_length.to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        write_data(triangles, normals, out)?;
    }
    Ok(())
}

/// Checks that the lengths of a binary file fit into 32 bits.
pub(super) fn check_size(
    polygons: &PolygonMesh,
    options: &WriteOptions<'_>,
) -> Result<(), WriteError> {
    let layout = Layout::new(polygons, options);
    let json = layout.document(polygons, Format::Glb).to_string();
    Glb::new(&json, &layout).map(|_| ())
}

/// The lengths in a binary file, in bytes. All data is a multiple of four bytes.
struct Glb {
    padding: usize,
    json_length: u32,
    data_length: u32,
    total: u32,
}

impl Glb {
    fn new(json: &str, layout: &Layout) -> Result<Self, WriteError> {
        let padding = json.len().next_multiple_of(4) - json.len();
        let json_length = (json.len() + padding) as u64;
        let data_length = layout.bytes();
        let chunks = if data_length > 0 { 2 } else { 1 };
        let bytes = 12 + 8 * chunks + json_length + data_length;
        let too_large = |_| WriteError::TooLarge {
            format: Format::Glb,
            bytes,
            limit: u64::from(u32::MAX),
        };
        let total = u32::try_from(bytes).map_err(too_large)?;
        Ok(Self {
            padding,
            // Both are smaller than the whole.
            json_length: json_length as u32,
            data_length: data_length as u32,
            total,
        })
    }
}

/// Writes positions, normals and indices.
fn write_data(
    triangles: &PolygonMesh,
    normals: &[Option<Point>],
    out: &mut impl Write,
) -> io::Result<()> {
    for point in triangles.positions().iter().chain(normals.iter().flatten()) {
        for x in point.to_array() {
            out.write_all(&x.to_le_bytes())?;
        }
    }
    let corners = triangles.faces().corners();
    if !has_short_indices(triangles.vertex_count()) {
        return corners
            .iter()
            .try_for_each(|v| out.write_all(&v.row().to_le_bytes()));
    }
    for v in corners {
        // Not more than 65,534.
        out.write_all(&(v.row() as u16).to_le_bytes())?;
    }
    let padding = if corners.len().is_multiple_of(2) {
        0
    } else {
        2
    };
    out.write_all(&[0; 2][..padding])
}

/// Returns whether indices have 16 bits, which is half of the size. The index 65,535 is not allowed there.
fn has_short_indices(vertices: usize) -> bool {
    vertices <= 65_535
}

/// Numbers of elements, and the place of the mesh.
struct Layout {
    vertices: usize,
    has_normals: bool,
    indices: usize,
    /// The place of the node.
    origin: [f64; 3],
}

impl Layout {
    fn new(polygons: &PolygonMesh, options: &WriteOptions<'_>) -> Self {
        Self {
            vertices: polygons.vertex_count(),
            has_normals: !options.complete_normals().is_empty(),
            indices: 3 * triangle_count(polygons),
            origin: options.origin,
        }
    }

    fn point_bytes(&self) -> u64 {
        12 * self.vertices as u64
    }

    fn index_bytes(&self) -> u64 {
        let size = if has_short_indices(self.vertices) {
            2
        } else {
            4
        };
        size * self.indices as u64
    }

    /// Returns the place of the indices.
    fn index_offset(&self) -> u64 {
        let lists = if self.has_normals { 2 } else { 1 };
        lists * self.point_bytes()
    }

    /// Returns the number of bytes of the data, a multiple of four.
    fn bytes(&self) -> u64 {
        self.index_offset() + self.index_bytes().next_multiple_of(4)
    }

    /// Returns the JSON text.
    fn document(&self, polygons: &PolygonMesh, format: Format) -> Value {
        let asset = json!({"version": "2.0", "generator": "Sixfold"});
        if self.vertices == 0 {
            return json!({ "asset": asset });
        }
        let [min, max] = extremes(polygons.positions());
        let mut views = vec![view(0, self.point_bytes(), ARRAY_BUFFER)];
        let mut accessors = vec![json!({
            "bufferView": 0, "componentType": FLOAT, "count": self.vertices, "type": "VEC3",
            "min": min, "max": max,
        })];
        let mut attributes = json!({"POSITION": 0});
        if self.has_normals {
            views.push(view(self.point_bytes(), self.point_bytes(), ARRAY_BUFFER));
            accessors.push(json!({
                "bufferView": 1, "componentType": FLOAT, "count": self.vertices, "type": "VEC3",
            }));
            attributes["NORMAL"] = json!(1);
        }
        let mut primitive = json!({"attributes": attributes, "mode": POINTS});
        if self.indices > 0 {
            primitive["mode"] = json!(TRIANGLES);
            primitive["indices"] = json!(accessors.len());
            let component = match has_short_indices(self.vertices) {
                true => UNSIGNED_SHORT,
                false => UNSIGNED_INT,
            };
            accessors.push(json!({
                "bufferView": views.len(), "componentType": component, "count": self.indices,
                "type": "SCALAR",
            }));
            views.push(view(
                self.index_offset(),
                self.index_bytes(),
                ELEMENT_ARRAY_BUFFER,
            ));
        }
        let mut buffer = json!({"byteLength": self.bytes()});
        if format == Format::Gltf {
            buffer["uri"] = json!(DATA_MARK);
        }
        let mut node = json!({"mesh": 0});
        if self.origin != [0.0; 3] {
            node["translation"] = json!(self.origin);
        }
        json!({
            "asset": asset,
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [node],
            "meshes": [{"primitives": [primitive]}],
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [buffer],
        })
    }
}

fn view(offset: u64, length: u64, target: u32) -> Value {
    json!({"buffer": 0, "byteOffset": offset, "byteLength": length, "target": target})
}

/// Returns the smallest and the largest coordinates; there must be a point.
fn extremes(points: &[Point]) -> [[f32; 3]; 2] {
    let first = points[0];
    let (min, max) = points
        .iter()
        .fold((first, first), |(min, max), &p| (min.min(p), max.max(p)));
    [min.to_array(), max.to_array()]
}

/// Returns the number of triangles of `polygons` after each polygon was cut.
fn triangle_count(polygons: &PolygonMesh) -> usize {
    polygons.corner_count() - 2 * polygons.face_count()
}
