//! What every format gives back of a mesh that was written to it.

use std::collections::HashMap;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::subsequence;
use sixfold_core::{Creases, Facts, Point, PolygonMesh};
use sixfold_io::{
    FileMesh, Format, Loss, ReadOptions, Welding, WriteError, WriteOptions, read_from, write,
    write_to, write_with,
};

/// Generates any finite `f32`, including those with extreme exponents.
fn coordinate() -> impl Strategy<Value = f32> {
    let any = any::<u32>().prop_map(f32::from_bits);
    prop_oneof![
        any.prop_filter("finite", |x| x.is_finite()),
        (-9_i8..9).prop_map(f32::from),
        Just(-0.0),
    ]
}

/// Generates random polygons over random points, some of which may be equal.
fn mesh() -> impl Strategy<Value = PolygonMesh> {
    let point = [coordinate(), coordinate(), coordinate()].prop_map(Point::from_array);
    vec(point, 3..12).prop_flat_map(|positions| {
        let numbers: Vec<u32> = (0..).take(positions.len()).collect();
        let max_corners = numbers.len();
        let face = subsequence(numbers, 3..=max_corners).prop_shuffle();
        vec(face, 0..12).prop_map(move |faces| {
            PolygonMesh::new(positions.clone(), faces).expect("three corners, each once")
        })
    })
}

fn written(mesh: &PolygonMesh, format: Format) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_to(mesh, format, &WriteOptions::default(), &mut bytes).expect("memory does not fail");
    bytes
}

fn read_again(bytes: &[u8], options: &ReadOptions) -> FileMesh {
    read_from("mesh", bytes, options).unwrap_or_else(|error| panic!("{error}"))
}

fn bits(point: Point) -> [u32; 3] {
    point.to_array().map(f32::to_bits)
}

/// Returns the mesh as a format keeps it that stores only triangles.
fn triangulated(mesh: &PolygonMesh) -> PolygonMesh {
    mesh.triangulated().expect("few corners").polygons
}

/// Returns the positions of the corners of all faces.
fn soup(mesh: &PolygonMesh) -> Vec<[u32; 3]> {
    let corners = mesh.faces().corners().iter();
    corners.map(|&v| bits(mesh.position(v))).collect()
}

/// Checks that `format` gives `mesh` back, except for what it cannot keep.
fn check(mesh: &PolygonMesh, format: Format) -> Result<(), TestCaseError> {
    let mut bytes = Vec::new();
    let losses = write_to(mesh, format, &WriteOptions::default(), &mut bytes).expect("memory");
    let is_stl = matches!(format, Format::Stl | Format::StlAscii);
    if is_stl && mesh.face_count() == 0 {
        prop_assert!(read_from("mesh", bytes.as_slice(), &ReadOptions::default()).is_err());
        return Ok(());
    }
    let as_stored = ReadOptions::default().with_welding(Welding::Nothing);
    let file = read_again(&bytes, &as_stored);
    prop_assert_eq!(file.format, format);
    prop_assert_eq!(&file.notices, &[]);
    prop_assert_eq!(file.welded_vertices, 0);
    prop_assert_eq!(file.narrowing.merged_vertices, 0);
    let (again, left_out) = file.into_polygons();
    prop_assert_eq!(left_out, []);
    let cuts = losses.iter().any(|loss| matches!(loss, Loss::Polygons(_)));
    let expected = if cuts {
        triangulated(mesh)
    } else {
        mesh.clone()
    };
    if is_stl {
        prop_assert_eq!(again.vertex_count(), again.corner_count());
        prop_assert_eq!(soup(&again), soup(&expected));
        check_welded(&bytes, &expected)?;
        if losses.is_empty() {
            // Only the numbers of the vertices differ.
            let back = read_again(&bytes, &ReadOptions::default()).facts();
            prop_assert_eq!(back, Facts::from_polygons(mesh));
        }
        return Ok(());
    }
    prop_assert_eq!(again.faces(), expected.faces());
    prop_assert_eq!(again.vertex_count(), expected.vertex_count());
    for (&found, &expected) in again.positions().iter().zip(expected.positions()) {
        prop_assert_eq!(bits(found), bits(expected));
    }
    Ok(())
}

/// Checks that an STL file is read with one vertex for each position.
fn check_welded(bytes: &[u8], expected: &PolygonMesh) -> Result<(), TestCaseError> {
    let file = read_again(bytes, &ReadOptions::default());
    let corners = expected.faces().corners();
    let mut numbers = HashMap::new();
    let mut faces = Vec::new();
    for &v in corners {
        // −0 and 0 are equal.
        let key = bits(expected.position(v) + Point::ZERO);
        let next = numbers.len();
        faces.push(*numbers.entry(key).or_insert(next));
    }
    prop_assert!(file.faces.corners().iter().map(|v| v.index()).eq(faces));
    prop_assert_eq!(file.positions.len(), numbers.len());
    prop_assert_eq!(file.welded_vertices, corners.len() - numbers.len());
    Ok(())
}

proptest! {
    #[test]
    fn every_format_gives_back_what_it_keeps(mesh in mesh()) {
        for format in Format::ALL {
            check(&mesh, format)?;
        }
    }

    #[test]
    fn moving_the_mesh_does_not_change_it(mesh in mesh()) {
        let bytes = written(&mesh, Format::Ply);
        let file = read_again(&bytes, &ReadOptions::default().recentred());
        prop_assert_eq!(&file.faces, mesh.faces());
        let [x, y, z] = file.origin;
        for (found, old) in file.positions.iter().zip(mesh.positions()) {
            let found = found.as_dvec3() + sixfold_core::glam::DVec3::new(x, y, z);
            let scale = old.as_dvec3().abs().max_element().max(x.abs()).max(y.abs()).max(z.abs());
            let largest = (found - old.as_dvec3()).abs().max_element();
            prop_assert!(largest <= file.narrowing.largest_shift + scale * 1e-15, "{}", largest);
        }
    }
}

/// A mesh that was read with its origin moved is written at its place: in 64 bits where the format
/// can, and otherwise the loss is named.
#[test]
fn a_mesh_that_was_moved_gets_its_place_back() {
    let places = [
        [500_000.001_f64, 4_649_776.225, 100.0625],
        [500_012.5, 4_649_776.3, 99.9],
        [500_001.0, 4_649_790.007, 101.25],
    ];
    let mut text = "OFF\n3 1 0\n".to_owned();
    for [x, y, z] in places {
        text += &format!("{x} {y} {z}\n");
    }
    text += "3 0 1 2\n";
    let recentred = ReadOptions::default().recentred();
    let file = read_again(text.as_bytes(), &recentred);
    let origin = file.origin;
    let (mesh, _) = file.into_polygons();
    for format in Format::ALL {
        let normals = [Some(Point::Z); 3];
        let options = WriteOptions::default()
            .with_origin(origin)
            .with_normals(&normals);
        let mut bytes = Vec::new();
        let losses = write_to(&mesh, format, &options, &mut bytes).expect("memory");
        let is_rounded = losses.iter().any(|loss| match loss {
            Loss::Precision {
                count: 3,
                narrowing,
            } => {
                // At 4,649,776, 32 bits have steps of 1/2.
                let shift = narrowing.largest_shift;
                narrowing.merged_vertices == 0 && (0.2..=0.25).contains(&shift)
            }
            _ => false,
        });
        assert_eq!(is_rounded, format == Format::Stl, "{format}: {losses:?}");
        let again = read_again(&bytes, &ReadOptions::default().with_origin(origin));
        assert_eq!(again.origin, origin, "{format}");
        let precision = if is_rounded { 0.5 } else { 1e-6 };
        for (&found, &expected) in again.positions.iter().zip(mesh.positions()) {
            assert!(
                found.distance(expected) < precision,
                "{format}: {found} {expected}"
            );
        }
        let is_exact = again
            .positions
            .iter()
            .zip(mesh.positions())
            .all(|(a, b)| a.distance(*b) < 1e-6);
        assert_eq!(is_exact, !is_rounded, "{format}");
    }
    let far = WriteOptions::default().with_origin([f64::MAX, 0.0, 0.0]);
    let error = write_to(&mesh, Format::Stl, &far, Vec::new()).expect_err("beyond 32 bits");
    assert!(matches!(error, WriteError::NotFinite { .. }), "{error}");
}

#[test]
fn every_shape_survives_every_format() -> Result<(), TestCaseError> {
    for generator in sixfold_shapes::GENERATORS {
        let mesh = generator.build(&[]).expect("defaults are possible");
        for format in Format::ALL {
            check(&mesh, format)?;
        }
    }
    Ok(())
}

#[test]
fn polygons_with_many_corners_survive() -> Result<(), TestCaseError> {
    let positions = (0..300).map(|i| Point::new(i as f32, 0.5, -1.0));
    let faces = [(0..300).collect::<Vec<u32>>(), vec![0, 1, 2]];
    let mesh = PolygonMesh::new(positions, faces).expect("valid");
    Format::ALL
        .into_iter()
        .try_for_each(|format| check(&mesh, format))
}

#[test]
fn losses_are_counted() {
    let positions = [Point::ZERO, Point::X, Point::ONE, Point::Y, Point::Z];
    let mesh = PolygonMesh::new(positions, [[0, 1, 2, 3]]).expect("valid");
    let some = [Some(Point::Z), None, None, None, None];
    let all = [Some(Point::Z); 5];
    let plain = WriteOptions::default();
    let with_some = plain.with_normals(&some);
    let with_all = plain.with_normals(&all);
    let lost = |format, options| write_to(&mesh, format, options, Vec::new()).expect("memory");
    let stl = [Loss::Polygons(1), Loss::IsolatedVertices(1)];
    for format in [Format::Stl, Format::StlAscii] {
        assert_eq!(lost(format, &plain), stl);
    }
    assert_eq!(lost(Format::Obj, &with_some), []);
    assert_eq!(lost(Format::Ply, &with_some), [Loss::Normals(1)]);
    assert_eq!(lost(Format::Ply, &with_all), []);
    assert_eq!(lost(Format::Off, &with_all), [Loss::Normals(5)]);
    assert_eq!(lost(Format::Glb, &with_all), [Loss::Polygons(1)]);
    let creases = Creases::new(&mesh, [([0, 1], 1.0)], [(4, 2.0)]).expect("valid");
    let sharp = plain.with_creases(&creases);
    assert_eq!(lost(Format::Obj, &sharp), []);
    assert_eq!(lost(Format::Ply, &sharp), [Loss::Creases(2)]);
}

#[test]
fn stl_loses_nothing_of_triangles_at_different_positions() {
    let lost = |mesh: &PolygonMesh| {
        write_to(mesh, Format::Stl, &WriteOptions::default(), Vec::new()).expect("memory")
    };
    let positions = [Point::ZERO, Point::X, Point::Y, Point::ONE];
    let faces = [[2, 0, 1], [1, 3, 2]];
    let mesh = PolygonMesh::new(positions, faces).expect("valid");
    assert_eq!(lost(&mesh), []);
    let positions = [Point::ZERO, Point::X, Point::Y, Point::new(1.0, -0.0, 0.0)];
    let seam = PolygonMesh::new(positions, faces).expect("valid");
    assert_eq!(lost(&seam), [Loss::EqualPositions(1)]);
}

#[test]
fn normals_are_written_and_reported_when_read() {
    let mesh = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]]).expect("valid");
    let normals = [Some(Point::Z); 3];
    let options = WriteOptions::default().with_normals(&normals);
    for format in [
        Format::Obj,
        Format::Ply,
        Format::PlyAscii,
        Format::Gltf,
        Format::Glb,
    ] {
        let mut bytes = Vec::new();
        write_to(&mesh, format, &options, &mut bytes).expect("memory does not fail");
        let file = read_again(&bytes, &ReadOptions::default());
        let notices: Vec<String> = file.notices.iter().map(ToString::to_string).collect();
        assert_eq!(notices.len(), 1, "{format}: {notices:?}");
        assert!(
            notices[0].starts_with("ignored 3 normals (first at "),
            "{format}: {notices:?}"
        );
        assert_eq!(file.into_polygons().0, mesh, "{format}");
    }
    let too_few = WriteOptions::default().with_normals(&normals[1..]);
    let error = write_to(&mesh, Format::Obj, &too_few, Vec::new()).expect_err("one is missing");
    assert_eq!(
        error.to_string(),
        "the number of normals is 2, and that of vertices 3: give one normal for each vertex"
    );
}

#[test]
fn a_mesh_that_is_not_finite_is_not_written() {
    let mesh = PolygonMesh::new([Point::ZERO, Point::NAN], [[0_u32; 0]; 0]).expect("valid");
    for format in Format::ALL {
        let mut bytes = Vec::new();
        let options = WriteOptions::default();
        let error = write_to(&mesh, format, &options, &mut bytes).expect_err("not finite");
        assert!(matches!(error, WriteError::NotFinite { .. }));
        let expected = format!(
            "the position of vertex v1 is not finite, so {format} cannot store it: correct the position"
        );
        assert_eq!(error.to_string(), expected);
        assert!(bytes.is_empty());
    }
}

#[test]
fn the_name_decides_the_format_of_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let mesh = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]]).expect("valid");
    for (name, format) in [
        ("a.stl", Format::Stl),
        ("a.PLY", Format::Ply),
        ("a.off", Format::Off),
        ("a.gltf", Format::Gltf),
        ("a.glb", Format::Glb),
        ("a.obj", Format::Obj),
    ] {
        let lost = write(path(name), &mesh).expect(name);
        assert_eq!(
            lost,
            write_to(&mesh, format, &WriteOptions::default(), Vec::new()).expect("memory"),
            "{name}"
        );
        let file = sixfold_io::read(path(name)).expect(name);
        assert_eq!(
            (file.format, file.into_polygons().0),
            (format, mesh.clone()),
            "{name}"
        );
    }
    let options = WriteOptions::default().with_format(Format::PlyAscii);
    assert_eq!(
        write_with(path("a.mesh"), &mesh, &options).expect("a file"),
        []
    );
    let file = sixfold_io::read(path("a.mesh")).expect("a mesh");
    assert_eq!(file.format, Format::PlyAscii);
}

#[test]
fn a_mesh_that_cannot_be_written_does_not_change_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.obj");
    let mesh = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]]).expect("valid");
    write(&path, &mesh).expect("a file");
    let before = std::fs::read(&path).expect("the file");
    let broken = PolygonMesh::new([Point::ZERO, Point::NAN], [[0_u32; 0]; 0]).expect("valid");
    let error = write(&path, &broken).expect_err("not finite");
    assert!(matches!(error, WriteError::NotFinite { .. }), "{error}");
    let normals = [Some(Point::Z)];
    let options = WriteOptions::default().with_normals(&normals);
    let error = write_with(&path, &mesh, &options).expect_err("one normal");
    assert!(matches!(error, WriteError::NormalCount { .. }), "{error}");
    assert_eq!(std::fs::read(&path).expect("the file"), before);

    for name in [
        "a.3mf", "a.step", "a.obj.gz", "a.objx", "a", "a.", "stl", ".ply",
    ] {
        let path = folder.path().join(name);
        let error = write(&path, &mesh).expect_err(name);
        assert!(matches!(error, WriteError::UnknownEnding { .. }), "{error}");
        let message = "the ending names no format for meshes: use stl, ply, off, gltf, glb or obj, \
                       or set a format";
        assert_eq!(error.to_string(), format!("{}: {message}", path.display()));
        assert!(!path.exists(), "{name}");
    }
    let error = write(folder.path().join("no/folder.ply"), &mesh).expect_err("no folder");
    assert!(error.to_string().contains("folder.ply: "), "{error}");
}
