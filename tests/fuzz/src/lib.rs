//! What the fuzz targets check.
//!
//! A reader must return a mesh or an error: no panic, no hang, and no memory that the input does not
//! pay for (libFuzzer limits time and memory). A mesh that was read must survive each format. A
//! repaired mesh must be one that the structure holds.

use sixfold::io::{
    FileMesh, Format, ReadOptions, Welding, WriteOptions, parse_creases, read_from, write_creases,
    write_to,
};
use sixfold::repair::{Step, diagnose, repair, repair_for};
use sixfold::remeshing::{Decimation, Target, decimate};
use sixfold::{
    EditableIndexedFaceSet, MeshQuery, PolygonMesh, Representation, shapes, structure_infos,
};

/// Reads `bytes` with all combinations of options. `name` decides on the format if the content does
/// not.
pub fn read(name: &str, bytes: &[u8]) {
    for options in [
        ReadOptions::default(),
        ReadOptions::default().with_welding(Welding::Nothing),
        ReadOptions::default().recentred(),
    ] {
        match read_from(name, bytes, &options) {
            Ok(mesh) => check_mesh(mesh),
            Err(error) => assert!(error.to_string().starts_with(name), "{error}"),
        }
    }
}

/// Checks that all functions work on a mesh that was read, and that each format keeps it.
fn check_mesh(mesh: FileMesh) {
    let facts = mesh.facts();
    let (_, unused) = mesh.creases();
    let notices = mesh.notices.iter().map(ToString::to_string);
    let notices = notices.chain(unused.iter().map(ToString::to_string));
    assert!(notices.into_iter().all(|text| !text.is_empty()));
    let (polygons, left_out, places) = mesh.into_polygons_with_places();
    assert_eq!(facts.degenerate_faces, left_out.len());
    for (face, _) in polygons.faces().iter() {
        places.place(face, &polygons);
    }
    if polygons.face_count() > 0 && polygons.corner_count() < 10_000 {
        Format::ALL
            .iter()
            .for_each(|&format| round_trip(&polygons, format));
    }
}

/// Writes and reads a mesh, and compares what the writer did not report as lost.
fn round_trip(polygons: &PolygonMesh, format: Format) {
    let options = WriteOptions::default();
    let mut bytes = Vec::new();
    let Ok(losses) = write_to(polygons, format, &options, &mut bytes) else {
        return;
    };
    let as_stored = ReadOptions::default().with_welding(Welding::Nothing);
    let name = format!("a.{}", format.extension());
    let back =
        read_from(&name, bytes.as_slice(), &as_stored).unwrap_or_else(|error| panic!("{error}"));
    if losses.is_empty() {
        let back = back.into_polygons().0;
        assert!(corners(&back) == corners(polygons), "{format}");
        // STL has no vertex numbers.
        if !matches!(format, Format::Stl | Format::StlAscii) {
            assert_eq!(back.faces(), polygons.faces(), "{format}");
            assert!(back.positions() == polygons.positions(), "{format}");
        }
    }
}

/// Returns the positions of the corners of all faces.
fn corners(polygons: &PolygonMesh) -> Vec<[f32; 3]> {
    let corners = polygons.faces().corners().iter();
    corners.map(|&v| polygons.position(v).to_array()).collect()
}

/// Reads `bytes` as a crease file of a cube, and writes the creases again.
pub fn read_creases(bytes: &[u8]) {
    let cube = shapes::cube();
    if let Ok(creases) = parse_creases("a.creases", bytes, &cube) {
        let mut text = Vec::new();
        write_creases(&creases, &mut text).expect("memory has no errors");
        let back = parse_creases("a.creases", text.as_slice(), &cube);
        assert_eq!(back.ok(), Some(creases));
    }
}

/// Builds a mesh of at most 24 vertices from `bytes`, and repairs it in several ways.
pub fn repair_mesh(bytes: &[u8]) {
    let Some(polygons) = mesh(bytes) else {
        return;
    };
    let diagnosis = diagnose(&polygons, 4);
    for fault in &diagnosis.faults {
        let steps = diagnosis.repairs(fault.kind);
        let repaired = repair(&polygons, &steps).unwrap_or_else(|error| panic!("{error}"));
        check_same_places(&polygons, &repaired.polygons, &steps);
    }
    for info in structure_infos() {
        let repaired = repair_for(&polygons, &info.capabilities);
        let repaired = repaired.unwrap_or_else(|error| panic!("{error}")).polygons;
        assert_eq!(info.capabilities.check(&repaired), Ok(()), "{}", info.name);
        let again = repair_for(&repaired, &info.capabilities).expect("it is held");
        assert!(again.steps.is_empty(), "{}", info.name);
        assert_eq!(again.polygons, repaired, "{}", info.name);
    }
    decimate_triangles(&polygons);
}

/// Decimates the triangles of a mesh of any kind, within a distance.
fn decimate_triangles(polygons: &PolygonMesh) {
    let triangles = polygons.triangulated().expect("small").polygons;
    let Ok(mut mesh) = EditableIndexedFaceSet::from_polygons(&triangles) else {
        return;
    };
    let decimation = Decimation {
        target: Target::Faces(0),
        max_distance: Some(0.5),
        ..Decimation::default()
    };
    let report = decimate(&mut mesh, &decimation).unwrap_or_else(|error| panic!("{error}"));
    assert!(report.max_distance.is_some_and(|distance| distance <= 0.500_001));
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!(mesh.face_count(), report.faces);
}

/// Checks that exact steps move no vertex: each new position is an old one.
fn check_same_places(old: &PolygonMesh, new: &PolygonMesh, steps: &[Step]) {
    let is_old = |position| old.positions().contains(position);
    assert!(new.positions().iter().all(is_old), "{steps:?}");
}

/// Builds a mesh: the first byte is the number of vertices, then come their coordinates, three to a
/// byte, and then faces, each a number of corners and the vertices.
fn mesh(bytes: &[u8]) -> Option<PolygonMesh> {
    let (&count, rest) = bytes.split_first()?;
    let count = usize::from(count % 22) + 3;
    let (coordinates, mut rest) = rest.split_at_checked(count)?;
    let positions: Vec<[f32; 3]> = coordinates
        .iter()
        .map(|byte| [byte & 3, byte >> 2 & 3, byte >> 4 & 3].map(f32::from))
        .collect();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    while let Some((&degree, after)) = rest.split_first() {
        let degree = usize::from(degree % 4) + 3;
        let Some((corners, after)) = after.split_at_checked(degree) else {
            break;
        };
        let face: Vec<u32> = corners
            .iter()
            .map(|&v| u32::from(v) % count as u32)
            .collect();
        let is_simple = (0..degree).all(|i| !face[..i].contains(&face[i]));
        if is_simple {
            faces.push(face);
        }
        rest = after;
    }
    PolygonMesh::new(positions, faces).ok()
}
