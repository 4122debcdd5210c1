//! The rules of glTF, and its errors with their messages.

use std::fs;

use serde_json::{Value, json};
use sixfold_core::{Point, PolygonMesh};
use sixfold_io::{
    FileMesh, Format, GltfFault, ReadError, ReadOptions, Scene, WriteOptions, read_from, write_to,
};

/// A document in parts, so that tests can change one of them.
struct Parts {
    document: Value,
    data: Vec<u8>,
}

impl Parts {
    /// Returns a square of two triangles in the plane z = 0.
    fn square() -> Self {
        let positions = [
            [0.0_f32, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        let mut parts = Self {
            document: json!({
                "asset": {"version": "2.0"},
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                "accessors": [], "bufferViews": [], "buffers": [{}],
            }),
            data: Vec::new(),
        };
        let bytes = positions
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        parts.add(
            bytes,
            json!({"componentType": 5126, "count": 4, "type": "VEC3"}),
        );
        let bytes = vec![0, 1, 2, 0, 2, 3];
        parts.add(
            bytes,
            json!({"componentType": 5121, "count": 6, "type": "SCALAR"}),
        );
        parts
    }

    /// Adds data and a view of it.
    fn add_view(&mut self, bytes: Vec<u8>) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.data.len(), "byteLength": bytes.len()});
        self.data.extend(bytes);
        let views = self.document["bufferViews"].as_array_mut().expect("a list");
        views.push(view);
        views.len() - 1
    }

    /// Adds data, a view of it, and an accessor; returns the number of the accessor.
    fn add(&mut self, bytes: Vec<u8>, mut accessor: Value) -> usize {
        accessor["bufferView"] = json!(self.add_view(bytes));
        let accessors = self.document["accessors"].as_array_mut().expect("a list");
        accessors.push(accessor);
        accessors.len() - 1
    }

    /// Returns the file in binary form.
    fn glb(&self) -> Vec<u8> {
        let mut document = self.document.clone();
        document["buffers"][0]["byteLength"] = json!(self.data.len());
        let json = document.to_string();
        let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", &self.data)] {
            bytes.extend((chunk.len() as u32).to_le_bytes());
            bytes.extend(kind);
            bytes.extend(chunk);
        }
        bytes
    }

    fn read(&self) -> FileMesh {
        let bytes = self.glb();
        let mesh = read_from("a.glb", bytes.as_slice(), &ReadOptions::default());
        mesh.unwrap_or_else(|error| panic!("{error}"))
    }

    #[track_caller]
    fn assert_refused(&self, message: &str) {
        let bytes = self.glb();
        let error = read_from("a.glb", bytes.as_slice(), &ReadOptions::default());
        assert_eq!(
            error.expect_err(message).to_string(),
            format!("a.glb: {message}")
        );
    }
}

fn faces(mesh: &FileMesh) -> Vec<Vec<usize>> {
    let faces = mesh.faces.iter();
    faces
        .map(|(_, face)| face.iter().map(|v| v.index()).collect())
        .collect()
}

fn notices(mesh: &FileMesh) -> Vec<String> {
    mesh.notices.iter().map(ToString::to_string).collect()
}

#[test]
fn triangles_strips_and_fans_have_the_same_side() {
    let mut parts = Parts::square();
    let mesh = parts.read();
    assert_eq!(mesh.format, Format::Glb);
    assert_eq!(faces(&mesh), [[0, 1, 2], [0, 2, 3]]);
    let accessor = |count| json!({"componentType": 5123, "count": count, "type": "SCALAR"});
    let strip = [0_u16, 1, 3, 3, 3, 2, 1]
        .iter()
        .flat_map(|i| i.to_le_bytes())
        .collect();
    let strip = parts.add(strip, accessor(7));
    let primitive = &mut parts.document["meshes"][0]["primitives"][0];
    primitive["indices"] = json!(strip);
    primitive["mode"] = json!(5);
    let mesh = parts.read();
    assert_eq!(faces(&mesh), [[0, 1, 3], [3, 2, 1]]);
    assert_eq!(
        notices(&mesh),
        ["ignored 3 joints of triangle strips (first at mesh 0)"]
    );
    let primitive = &mut parts.document["meshes"][0]["primitives"][0];
    primitive["mode"] = json!(6);
    primitive
        .as_object_mut()
        .expect("an object")
        .remove("indices");
    assert_eq!(faces(&parts.read()), [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn nodes_move_and_mirror_their_meshes() {
    let mut parts = Parts::square();
    let document = &mut parts.document;
    document["nodes"] = json!([
        {"children": [1, 2], "translation": [10, 0, 0]},
        {"mesh": 0, "rotation": [0, 0, 0.5_f64.sqrt(), 0.5_f64.sqrt()], "scale": [2, 1, 1]},
        {"mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]},
    ]);
    document["scenes"] = json!([{"nodes": []}, {"nodes": [0]}]);
    document["scene"] = json!(1);
    let mesh = parts.read();
    let expected = [
        [10.0, 0.0, 0.0],
        [10.0, 2.0, 0.0],
        [9.0, 2.0, 0.0],
        [9.0, 0.0, 0.0],
        [10.0, 0.0, 5.0],
        [9.0, 0.0, 5.0],
        [9.0, 1.0, 5.0],
        [10.0, 1.0, 5.0],
    ];
    for (found, expected) in mesh.positions.iter().zip(expected.map(Point::from_array)) {
        assert!((*found - expected).length() < 1e-6, "{found} {expected}");
    }
    assert_eq!(faces(&mesh), [[0, 1, 2], [0, 2, 3], [5, 4, 6], [6, 4, 7]]);
}

/// The weights of a node, or of its mesh, are the pose of the file.
#[test]
fn morph_targets_are_applied_with_the_default_weights() {
    let mut parts = Parts::square();
    // Moves the last vertex by 2 upwards.
    let values = parts.add_view(
        [0.0_f32, 0.0, 2.0]
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect(),
    );
    let indices = parts.add_view(vec![3]);
    let sparse = json!({
        "componentType": 5126, "count": 4, "type": "VEC3",
        "sparse": {
            "count": 1,
            "indices": {"bufferView": indices, "componentType": 5121},
            "values": {"bufferView": values},
        },
    });
    let accessors = parts.document["accessors"].as_array_mut().expect("a list");
    accessors.push(sparse);
    let target = accessors.len() - 1;
    let primitive = &mut parts.document["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{"POSITION": target, "NORMAL": 77}, {"POSITION": target}]);
    let heights = |parts: &Parts| {
        let mesh = parts.read();
        let notices = notices(&mesh);
        let heights: Vec<f32> = mesh.positions.iter().map(|p| p.z).collect();
        (heights, notices)
    };
    let both = "ignored 2 animations and morphs (first at mesh 0)".to_owned();
    assert_eq!(heights(&parts), (vec![0.0; 4], vec![both]));
    parts.document["meshes"][0]["weights"] = json!([1.0]);
    let one = || vec!["ignored 1 animation or morph (mesh 0)".to_owned()];
    assert_eq!(heights(&parts), (vec![0.0, 0.0, 0.0, 2.0], one()));
    parts.document["meshes"][0]["weights"] = json!([0.5, -0.25]);
    assert_eq!(heights(&parts), (vec![0.0, 0.0, 0.0, 0.5], vec![]));
    // A node has weights of its own, and a place.
    parts.document["nodes"] = json!([
        {"mesh": 0, "weights": [0.0, 2.0], "translation": [0, 0, 1]},
        {"mesh": 0},
    ]);
    let expected = vec![1.0, 1.0, 1.0, 5.0, 0.0, 0.0, 0.0, 0.5];
    assert_eq!(heights(&parts), (expected, one()));
    // A primitive with the same positions and other targets has vertices of its own.
    let mut second = parts.document["meshes"][0]["primitives"][0].clone();
    second["targets"] = json!([]);
    let primitives = parts.document["meshes"][0]["primitives"].as_array_mut();
    primitives.expect("a list").push(second);
    parts.document["nodes"] = json!([{"mesh": 0}]);
    assert_eq!(heights(&parts).0, [0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0]);
    parts.document["accessors"][target]["count"] = json!(5);
    parts.assert_refused(&format!(
        "accessor {target}: it has 5 positions, but the positions that it moves are 4: export again"
    ));
}

/// The data of morph targets is needed only where a weight is not 0.
#[test]
fn data_of_targets_without_weight_is_not_read() {
    let mut parts = Parts::square();
    parts.document["buffers"] = json!([{}, {"uri": "missing.bin", "byteLength": 48}]);
    let view = json!({"buffer": 1, "byteLength": 48});
    parts.document["bufferViews"]
        .as_array_mut()
        .expect("a list")
        .push(view);
    let accessor = json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"});
    parts.document["accessors"]
        .as_array_mut()
        .expect("a list")
        .push(accessor);
    parts.document["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 2}]);
    assert_eq!(parts.read().faces.len(), 2);
    parts.document["nodes"] = json!([{"mesh": 0, "weights": [0.0]}]);
    assert_eq!(parts.read().faces.len(), 2);
    parts.document["nodes"] = json!([{"mesh": 0, "weights": [0.5]}]);
    let bytes = parts.glb();
    let error = read_from("a.glb", bytes.as_slice(), &ReadOptions::default());
    let error = error.expect_err("the data is missing").to_string();
    assert!(error.contains("missing.bin"), "{error}");
}

#[test]
fn what_a_scene_or_a_node_leaves_out_is_named() {
    let mut parts = Parts::square();
    let meshes = parts.document["meshes"].as_array_mut().expect("a list");
    for _ in 0..2 {
        meshes.push(meshes[0].clone());
    }
    parts.document["nodes"] = json!([
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1], "scale": [2, 2, 2],
            "translation": [9, 9, 9]},
        {"mesh": 0},
        {"mesh": 1},
    ]);
    parts.document["scenes"] = json!([{"nodes": [0]}]);
    let mesh = parts.read();
    assert_eq!(mesh.positions[0].x, 3.0);
    assert_eq!(
        notices(&mesh),
        [
            "ignored 2 translations, rotations and scales beside a matrix (first at node 0)",
            "ignored 2 nodes with meshes outside the scene (first at node 1)",
            "ignored 1 mesh outside the scene (mesh 2)",
        ]
    );
}

#[test]
fn scenes_are_chosen() {
    let mut parts = Parts::square();
    let meshes = parts.document["meshes"].as_array_mut().expect("a list");
    meshes.push(meshes[0].clone());
    parts.document["nodes"] = json!([
        {"mesh": 0, "translation": [1, 0, 0], "children": [1]},
        {"mesh": 0, "translation": [10, 0, 0]},
        {"mesh": 0, "translation": [100, 0, 0]},
        {"mesh": 0, "translation": [1000, 0, 0]},
    ]);
    // The scenes share node 0, and no scene has node 3.
    parts.document["scenes"] = json!([{"nodes": [0]}, {"nodes": [2, 0]}]);
    parts.document["scene"] = json!(1);
    let bytes = parts.glb();
    let read = |scene| {
        let options = ReadOptions::default().with_scene(scene);
        read_from("a.glb", bytes.as_slice(), &options)
    };
    let places = |scene| {
        let mesh = read(scene).unwrap_or_else(|error| panic!("{error}"));
        let corners = mesh.positions.chunks(4);
        (corners.map(|c| c[0].x).collect::<Vec<_>>(), notices(&mesh))
    };
    let mesh = "ignored 1 mesh outside the scene (mesh 1)".to_owned();
    let node_3 = "ignored 1 node with a mesh outside the scene (node 3)".to_owned();
    let nodes = "ignored 2 nodes with meshes outside the scene (first at node 2)".to_owned();
    assert_eq!(
        places(Scene::Default),
        (vec![100.0, 1.0, 11.0], vec![node_3, mesh.clone()])
    );
    assert_eq!(places(Scene::Number(1)), places(Scene::Default));
    assert_eq!(
        places(Scene::Number(0)),
        (vec![1.0, 11.0], vec![nodes, mesh])
    );
    let all = vec![1.0, 11.0, 100.0, 1000.0, 0.0];
    assert_eq!(places(Scene::All), (all, vec![]));
    let error = read(Scene::Number(2)).expect_err("two scenes").to_string();
    let expected = "a.glb: scene 2: no such scene: the file has 2, and the first is scene 0";
    assert_eq!(error, expected);
}

#[test]
fn rotations_of_any_length_do_not_scale() {
    for (rotation, expected) in [
        ([0.0, 0.0, 1.0, 1.0], [0.0, 1.0]),
        ([0.0, 0.0, 0.71, 0.71], [0.0, 1.0]),
        ([0.0; 4], [1.0, 0.0]),
    ] {
        let mut parts = Parts::square();
        parts.document["nodes"] = json!([{"mesh": 0, "rotation": rotation}]);
        parts.document["scenes"] = json!([{"nodes": [0]}]);
        let [x, y] = expected;
        let found = parts.read().positions[1];
        assert!((found - Point::new(x, y, 0.0)).length() < 1e-6, "{found}");
    }
}

#[test]
fn corners_that_complete_no_triangle_are_counted() {
    let mut parts = Parts::square();
    parts.document["accessors"][1]["count"] = json!(5);
    let mesh = parts.read();
    assert_eq!(faces(&mesh), [[0, 1, 2]]);
    assert_eq!(
        notices(&mesh),
        ["ignored 2 corners of incomplete triangles (first at mesh 0)"]
    );
}

#[test]
fn primitives_with_the_same_positions_share_vertices() {
    let mut parts = Parts::square();
    let primitives = &mut parts.document["meshes"][0]["primitives"];
    let mut points = primitives[0].clone();
    points["mode"] = json!(0);
    points["material"] = json!(0);
    primitives.as_array_mut().expect("a list").push(points);
    let mut meshes = parts.document["meshes"].as_array().expect("a list").clone();
    meshes.push(meshes[0].clone());
    parts.document["meshes"] = json!(meshes);
    parts.document["nodes"] = json!([{"mesh": 0}]);
    let mesh = parts.read();
    assert_eq!((mesh.positions.len(), mesh.faces.len()), (4, 2));
    assert_eq!(
        notices(&mesh),
        [
            "ignored 1 material statement (mesh 0)",
            "ignored 1 primitive of points or lines (mesh 0)",
            "ignored 1 mesh outside the scene (mesh 1)",
        ]
    );
}

#[test]
fn quantised_strided_and_sparse_accessors_are_read() {
    let mut parts = Parts::square();
    let bytes = [
        [0_i8, 0, 0, 9],
        [127, 0, 0, 9],
        [127, 127, 0, 9],
        [-128, 127, 0, 9],
    ];
    let bytes: Vec<u8> = bytes.iter().flatten().map(|&x| x as u8).collect();
    let accessor = json!({"componentType": 5120, "normalized": true, "count": 4, "type": "VEC3"});
    let quantised = parts.add(bytes, accessor);
    let view = parts.document["bufferViews"]
        .as_array_mut()
        .expect("a list")
        .last_mut();
    view.expect("a view")["byteStride"] = json!(4);
    parts.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(quantised);
    parts.document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    assert_eq!(parts.read().positions[3], Point::new(-1.0, 1.0, 0.0));

    let indices = parts.add_view(vec![1, 3]);
    let values = [7_i8, 7, 7, 127, 0, -127].map(|x| x as u8).to_vec();
    let values = parts.add_view(values);
    parts.document["accessors"][quantised]["sparse"] = json!({
        "count": 2,
        "indices": {"bufferView": indices, "componentType": 5121},
        "values": {"bufferView": values},
    });
    let positions = parts.read().positions;
    assert_eq!(positions[1], Point::splat(7.0 / 127.0));
    assert_eq!(
        positions[2..],
        [Point::new(1.0, 1.0, 0.0), Point::new(1.0, 0.0, -1.0)]
    );
    let accessor = parts.document["accessors"][quantised]
        .as_object_mut()
        .expect("an object");
    accessor.remove("bufferView");
    assert_eq!(parts.read().positions[2], Point::ZERO);
    let offset = indices_offset(&parts, indices);
    parts.data[offset] = 4;
    let message = "accessor 2: its sparse index 4 is not above the one before and below 4: export \
                   again";
    parts.assert_refused(message);
}

fn indices_offset(parts: &Parts, view: usize) -> usize {
    let offset = parts.document["bufferViews"][view]["byteOffset"].as_u64();
    offset.expect("a number") as usize
}

#[test]
fn compression_is_refused_by_name() {
    let mut parts = Parts::square();
    let draco = "KHR_draco_mesh_compression";
    parts.document["meshes"][0]["primitives"][0]["extensions"] = json!({draco: {}});
    assert_eq!(parts.read().faces.len(), 2, "the plain data is there, too");
    parts.document["extensionsRequired"] = json!([draco]);
    parts.assert_refused(
        "mesh 0: the mesh is compressed with KHR_draco_mesh_compression, which is not read: export \
         it without compression",
    );
}

#[test]
fn draco_without_plain_data_is_refused_by_name() {
    let draco = "KHR_draco_mesh_compression";
    let message = "mesh 0: the mesh is compressed with KHR_draco_mesh_compression, which is not \
                   read: export it without compression";
    for accessors in [&[0, 1][..], &[0], &[1]] {
        let mut parts = Parts::square();
        parts.document["meshes"][0]["primitives"][0]["extensions"] = json!({draco: {}});
        for &number in accessors {
            let accessor = parts.document["accessors"][number].as_object_mut();
            accessor.expect("an object").remove("bufferView");
        }
        parts.assert_refused(message);
        parts.document["extensionsUsed"] = json!([draco]);
        parts.assert_refused(message);
    }
}

#[test]
fn meshopt_without_plain_data_is_refused_by_name() {
    for meshopt in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let message = format!(
            "bufferView 1: the mesh is compressed with {meshopt}, which is not read: export it \
             without compression"
        );
        let mut parts = Parts::square();
        parts.document["extensionsUsed"] = json!([meshopt]);
        parts.document["bufferViews"][1]["extensions"] = json!({meshopt: {"buffer": 0}});
        assert_eq!(parts.read().faces.len(), 2, "the plain data is there, too");
        let required = |parts: &mut Parts| parts.document["extensionsRequired"] = json!([meshopt]);
        required(&mut parts);
        parts.assert_refused(&message);
        // Buffers for the decompressed data, which are empty in the file.
        for fallback in [
            json!({"byteLength": 6, "extensions": {meshopt: {"fallback": true}}}),
            json!({"byteLength": 0}),
            json!({"byteLength": 6, "uri": "data:;base64,"}),
        ] {
            let mut parts = Parts::square();
            let buffers = parts.document["buffers"].as_array_mut().expect("a list");
            buffers.push(fallback);
            let view = &mut parts.document["bufferViews"][1];
            *view = json!({"buffer": 1, "byteLength": 6, "extensions": {meshopt: {"buffer": 0}}});
            parts.assert_refused(&message);
            required(&mut parts);
            parts.assert_refused(&message);
        }
    }
}

#[test]
fn unknown_required_extensions_are_refused_by_name() {
    let mut parts = Parts::square();
    let harmless = [
        "KHR_materials_unlit",
        "KHR_mesh_quantization",
        "KHR_draco_mesh_compression",
    ];
    parts.document["extensionsRequired"] = json!(harmless);
    assert_eq!(parts.read().faces.len(), 2);
    parts.document["extensionsRequired"] = json!([harmless[0], "EXT_mesh_gpu_instancing"]);
    parts.assert_refused(
        "required extension 1: the file requires the extension EXT_mesh_gpu_instancing, which is \
         not read: export it without this extension",
    );
    let many = vec!["KHR_materials_unlit"; 100_000];
    parts.document["extensionsRequired"] = json!(many);
    parts.document["meshes"] = json!(vec![parts.document["meshes"][0].clone(); 2000]);
    assert_eq!(parts.read().faces.len(), 2 * 2000);
}

/// `benches/checks/reading_growth.py` counts the instructions for such files.
#[test]
fn many_primitives_are_read_and_many_copies_refused() {
    let mut parts = Parts::square();
    let accessor = parts.document["accessors"][0].clone();
    let accessors = parts.document["accessors"].as_array_mut().expect("a list");
    accessors.extend(vec![accessor; 50_000]);
    let primitive = |number: usize| json!({"attributes": {"POSITION": number + 2}, "mode": 0});
    let primitives: Vec<Value> = (0..50_000).map(primitive).collect();
    parts.document["meshes"][0]["primitives"] = json!(primitives);
    assert_eq!(parts.read().positions.len(), 200_000);

    // Every node repeats a mesh of primitives without vertices.
    parts.document["meshes"][0]["primitives"] = json!(vec![json!({"attributes": {}}); 50_000]);
    parts.document["nodes"] = json!(vec![json!({"mesh": 0}); 50_000]);
    let bytes = parts.glb();
    let error = read_from("a.glb", bytes.as_slice(), &ReadOptions::default()).expect_err("large");
    assert!(
        error
            .to_string()
            .contains("vertices, corners and primitives"),
        "{error}"
    );
}

#[test]
fn buffers_in_one_file_share_its_data() {
    let folder = tempfile::tempdir().expect("the temporary folder is writable");
    let mut parts = Parts::square();
    // The first buffer needs a part of the file, the second all of it.
    let length = parts.data.len();
    parts.document["buffers"] = json!([
        {"uri": "a.bin", "byteLength": length - 6}, {"uri": "%61.bin", "byteLength": length},
    ]);
    parts.document["bufferViews"][1]["buffer"] = json!(1);
    let path = folder.path().join("a.gltf");
    fs::write(&path, parts.document.to_string()).expect("writable");
    fs::write(folder.path().join("a.bin"), &parts.data).expect("writable");
    let mesh = sixfold_io::read(&path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(faces(&mesh), [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn wrong_numbers_are_named_with_their_places() {
    let refused = |pointer: &str, value: Value, message: &str| {
        let mut parts = Parts::square();
        parts.document["nodes"] = json!([{"mesh": 0}]);
        parts.document["scenes"] = json!([{"nodes": [0]}]);
        *parts.document.pointer_mut(pointer).expect("a member") = value;
        parts.assert_refused(message);
    };
    let again = "export the file again";
    refused(
        "/meshes/0/primitives/0/attributes/POSITION",
        json!(9),
        &format!("mesh 0: it names accessor 9, but the file has 2 of them: {again}"),
    );
    refused(
        "/nodes/0/mesh",
        json!(1),
        &format!("node 0: it names mesh 1, but the file has 1 of them: {again}"),
    );
    refused(
        "/accessors/0/count",
        json!(5),
        "accessor 0: its data ends at byte 60 of 48: copy the file again, or export it again",
    );
    refused(
        "/accessors/0/count",
        json!(u64::MAX),
        "accessor 0: its data ends at byte 2^64 of 48: copy the file again, or export it again",
    );
    refused(
        "/bufferViews/1/byteOffset",
        json!(49),
        "bufferView 1: its data ends at byte 55 of 54: copy the file again, or export it again",
    );
    refused(
        "/accessors/0/type",
        json!("VEC2"),
        &format!(
            "accessor 0: it has type \"VEC2 of 5126\", but positions need VEC3 of numbers of 8, 16 \
             or 32 bits: {again}"
        ),
    );
    refused(
        "/accessors/1/componentType",
        json!(5126),
        &format!(
            "accessor 1: it has type \"SCALAR of 5126\", but indices need SCALAR of unsigned \
             integers: {again}"
        ),
    );
    refused(
        "/nodes/0",
        json!({"children": [0]}),
        &format!("node 0: it has several parents, or is its own ancestor: {again}"),
    );
}

#[test]
fn other_versions_are_refused() {
    let mut parts = Parts::square();
    parts.document["asset"]["version"] = json!("1.0");
    let bytes = parts.glb();
    let error = read_from("a.glb", bytes.as_slice(), &ReadOptions::default());
    let message = "a.glb:1: the file has glTF version \"1.0\": export it as version 2.0";
    assert_eq!(error.expect_err(message).to_string(), message);
}

#[test]
fn an_index_without_a_vertex_is_refused() {
    let mut parts = Parts::square();
    *parts.data.last_mut().expect("indices") = 4;
    let message = "accessor 1: face names vertex 4, but there are 4 vertices: correct the index";
    parts.assert_refused(message);
}

#[test]
fn scenes_that_repeat_meshes_are_limited() {
    let mut parts = Parts::square();
    let count = 1_u64 << 40;
    let zeros = json!({"componentType": 5126, "count": count, "type": "VEC3"});
    parts.document["accessors"][0] = zeros;
    let bytes = parts.glb();
    let error = read_from("a.glb", bytes.as_slice(), &ReadOptions::default()).expect_err("large");
    assert!(matches!(
        error,
        ReadError::Gltf {
            fault: GltfFault::TooLarge { limit: 1_048_576 },
            ..
        }
    ));
}

#[test]
fn buffers_in_other_files_are_read() {
    let folder = tempfile::tempdir().expect("the temporary folder is writable");
    let mut parts = Parts::square();
    parts.document["buffers"][0] = json!({"uri": "the%20data.bin", "byteLength": parts.data.len()});
    let text = parts.document.to_string();
    let path = folder.path().join("a.gltf");
    fs::write(&path, &text).expect("writable");
    fs::write(folder.path().join("the data.bin"), &parts.data).expect("writable");
    let mesh = sixfold_io::read(&path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((mesh.format, mesh.faces.len()), (Format::Gltf, 2));

    fs::write(folder.path().join("the data.bin"), &parts.data[1..]).expect("writable");
    let error = sixfold_io::read(&path).expect_err("too short").to_string();
    let rest = "buffer 0: it has 53 bytes, expected 54: copy the file again, with its .bin files";
    assert!(error.ends_with(rest), "{error}");
    let error = read_from("-", text.as_bytes(), &ReadOptions::default()).expect_err("no folder");
    let message = "-: buffer 0: its data is in the file \"the%20data.bin\": name the glTF file \
                   instead of passing its content";
    assert_eq!(error.to_string(), message);
}

#[test]
fn containers_are_checked() {
    let glb = Parts::square().glb();
    let refused = |bytes: &[u8], message: &str| {
        let error = read_from("a.glb", bytes, &ReadOptions::default()).expect_err(message);
        assert!(
            error.to_string().starts_with(&format!("a.glb{message}")),
            "{error}"
        );
    };
    refused(
        &glb[..9],
        ": byte 9: the file ends before the length of the file",
    );
    refused(&glb[..15], ": byte 12: the file ends before the JSON chunk");
    refused(&glb[..40], ": byte 40: the file ends before byte ");
    refused(
        b"glTF\x01\0\0\0\0\0\0\0",
        ": byte 4: the file has glTF version \"1\"",
    );
    refused(
        b"{\n\"asset\": 1}",
        ":2: the JSON text is not glTF (invalid type: integer `1`",
    );
    refused(b"{\n\"asset\"", ":2: the JSON text is not glTF (EOF");
    let mut kind = glb.clone();
    kind[16] = b'X';
    refused(&kind, ": byte 16: the first chunk of the file is not JSON");
}

#[test]
fn points_without_faces_are_kept() {
    let mesh = PolygonMesh::new([Point::ONE, Point::X], [[0_u32; 0]; 0]).expect("valid");
    for format in [Format::Gltf, Format::Glb] {
        let mut bytes = Vec::new();
        write_to(&mesh, format, &WriteOptions::default(), &mut bytes)
            .expect("memory does not fail");
        let file = read_from("a", bytes.as_slice(), &ReadOptions::default()).expect("valid");
        assert_eq!(file.into_polygons().0, mesh);
    }
}

/// Returns the square twice: as a mesh with a skin, and below it without one.
fn skinned_square() -> Parts {
    let mut parts = Parts::square();
    parts.document["skins"] = json!([{"joints": [1]}]);
    parts.document["nodes"] = json!([
        {"children": [1, 2], "translation": [10, 0, 0], "scale": [-1, 1, 1]},
        {"translation": [0, 3, 0]},
        {"mesh": 0, "skin": 0, "translation": [0, 0, 7], "children": [3]},
        {"mesh": 0},
    ]);
    parts.document["scenes"] = json!([{"nodes": [0]}]);
    parts
}

#[test]
fn a_mesh_with_a_skin_stays_where_its_positions_are() {
    let mut parts = skinned_square();
    let plain = Parts::square().read();
    let mesh = parts.read();
    // The transform of the node does not move its mesh, but its children.
    assert_eq!(mesh.positions[..4], plain.positions[..]);
    let moved = plain.positions.iter();
    let moved = moved.map(|p| Point::new(10.0 - p.x, p.y, p.z + 7.0));
    assert!(mesh.positions[4..].iter().copied().eq(moved));
    assert_eq!(
        faces(&mesh),
        [[0, 1, 2], [0, 2, 3], [5, 4, 6], [6, 4, 7]],
        "only the second one is mirrored"
    );
    assert_eq!(
        notices(&mesh),
        [
            "ignored 1 skin of a mesh (node 2): vertices stay where they are stored, because joints \
             are not read"
        ]
    );
    parts.document["nodes"][3]["skin"] = json!(0);
    assert_eq!(
        notices(&parts.read()),
        [
            "ignored 2 skins of meshes (first at node 2): vertices stay where they are stored, \
             because joints are not read"
        ]
    );
    parts.document["nodes"][3]["skin"] = json!(1);
    parts.assert_refused(
        "node 3: it names skin 1, but the file has 1 of them: export the file again",
    );
}

#[test]
fn instances_are_reported() {
    let mut parts = Parts::square();
    let instancing = "EXT_mesh_gpu_instancing";
    parts.document["nodes"] =
        json!([{"mesh": 0, "extensions": {instancing: {"attributes": {"TRANSLATION": 0}}}}]);
    let own = "ignored 1 list of instances (node 0): the mesh of a node is read once";
    assert_eq!(notices(&parts.read()), [own]);
    parts.document["extensionsUsed"] = json!([instancing]);
    let listed = format!("ignored 1 extension: {instancing} (extension 0)");
    assert_eq!(notices(&parts.read()), [&listed, own]);
    parts.document["extensionsRequired"] = json!([instancing]);
    parts.assert_refused(&format!(
        "required extension 0: the file requires the extension {instancing}, which is not read: \
         export it without this extension"
    ));
}

#[test]
fn data_in_no_buffer_is_refused_if_the_file_uses_compression() {
    for extension in [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "KHR_meshopt_compression",
    ] {
        let message = format!(
            "mesh 0: the mesh is compressed with {extension}, which is not read: export it without \
             compression"
        );
        let mut parts = Parts::square();
        parts.document["extensionsUsed"] = json!(["KHR_materials_unlit", extension]);
        assert_eq!(parts.read().faces.len(), 2, "the plain data is there");
        for number in [1, 0] {
            let accessor = parts.document["accessors"][number].as_object_mut();
            accessor.expect("an object").remove("bufferView");
            parts.assert_refused(&message);
        }
    }
    let draco = "KHR_draco_mesh_compression";
    let mut parts = Parts::square();
    parts.document["meshes"][0]["primitives"][0] =
        json!({"attributes": {}, "extensions": {draco: {"attributes": {"POSITION": 0}}}});
    parts.assert_refused(&format!(
        "mesh 0: the mesh is compressed with {draco}, which is not read: export it without \
         compression"
    ));
}

#[test]
fn modes_that_do_not_exist_are_refused() {
    for mode in [7_u32, 8, u32::MAX] {
        let mut parts = Parts::square();
        parts.document["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        parts.assert_refused(&format!(
            "mesh 0: a primitive has mode {mode}, but modes are numbers from 0 to 6: export the file \
             again"
        ));
    }
}

#[test]
fn buffers_below_the_folder_are_read() {
    let outer = tempfile::tempdir().expect("the temporary folder is writable");
    let folder = outer.path().join("model");
    fs::create_dir_all(folder.join("sub/deep")).expect("writable");
    let mut parts = Parts::square();
    let data = parts.data.clone();
    for path in ["a.bin", "sub/b.bin", "sub/ä ö.bin", "sub/deep/c.bin"] {
        fs::write(folder.join(path), &data).expect("writable");
    }
    fs::write(outer.path().join("secret.bin"), &data).expect("writable");
    let path = folder.join("a.gltf");
    let mut read = |uri: &str| {
        parts.document["buffers"][0] = json!({"uri": uri, "byteLength": data.len()});
        fs::write(&path, parts.document.to_string()).expect("writable");
        sixfold_io::read(&path).map(|mesh| mesh.faces.len())
    };
    for uri in [
        "a.bin",
        "./a.bin",
        "./sub/b.bin",
        "sub/../a.bin",
        "missing/../a.bin",
        "sub/deep/../../a.bin",
        "sub/%C3%A4%20%C3%B6.bin",
        "sub/ä ö.bin",
        "sub%2Fdeep%2fc.bin",
    ] {
        assert_eq!(read(uri).unwrap_or_else(|e| panic!("{uri}: {e}")), 2);
    }
    let absolute = outer.path().join("secret.bin").display().to_string();
    for uri in [
        "../secret.bin",
        "sub/../../secret.bin",
        "%2e%2e/secret.bin",
        "..%2Fsecret.bin",
        "../model/a.bin",
        &absolute,
        &format!("file://{absolute}"),
        &absolute.replacen('/', "%2f", 1),
    ] {
        let error = read(uri).expect_err(uri).to_string();
        assert!(
            error.ends_with(": only files in the folder of the file, or below it, are read"),
            "{uri}: {error}"
        );
    }
    let error = read("sub").expect_err("a folder").to_string();
    assert!(error.contains("not a regular file"), "{error}");
    let error = read("none.bin").expect_err("missing").to_string();
    assert!(error.contains("its data cannot be read from"), "{error}");
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_refused() {
    use std::os::unix::fs::symlink;
    let outer = tempfile::tempdir().expect("the temporary folder is writable");
    let folder = outer.path().join("model");
    fs::create_dir_all(folder.join("sub")).expect("writable");
    let mut parts = Parts::square();
    let data = parts.data.clone();
    for path in ["secret.bin", "model/a.bin"] {
        fs::write(outer.path().join(path), &data).expect("writable");
    }
    symlink("../secret.bin", folder.join("link.bin")).expect("writable");
    symlink("..", folder.join("up")).expect("writable");
    symlink("../a.bin", folder.join("sub/inside.bin")).expect("writable");
    let path = folder.join("a.gltf");
    let mut read = |uri: &str| {
        parts.document["buffers"][0] = json!({"uri": uri, "byteLength": data.len()});
        fs::write(&path, parts.document.to_string()).expect("writable");
        sixfold_io::read(&path).map(|mesh| mesh.faces.len())
    };
    for uri in ["link.bin", "up/secret.bin", "./sub/../up/secret.bin"] {
        let error = read(uri).expect_err(uri).to_string();
        assert!(error.contains("only files in the folder"), "{uri}: {error}");
    }
    for uri in ["sub/inside.bin", "up/model/a.bin"] {
        assert_eq!(read(uri).unwrap_or_else(|e| panic!("{uri}: {e}")), 2);
    }
    // The folder itself may be a link.
    symlink("model", outer.path().join("other")).expect("writable");
    let mesh = sixfold_io::read(outer.path().join("other/a.gltf"));
    assert_eq!(mesh.expect("below the folder").faces.len(), 2);
}

/// Indices have 16 bits as long as they can, and never the index 65,535.
#[test]
fn written_indices_have_16_bits_if_there_are_few_vertices() {
    for (vertices, faces, component) in [(3, 1, 5123), (65_535, 2, 5123), (65_536, 3, 5125)] {
        let points = (0..vertices).map(|i| Point::new(i as f32, (i % 7) as f32, 0.0));
        let last = vertices - 1;
        let triangles = (0..faces).map(|i| [i, i + 1, last]);
        let mesh = PolygonMesh::new(points, triangles).expect("valid");
        for format in [Format::Glb, Format::Gltf] {
            let mut bytes = Vec::new();
            let options = WriteOptions::default();
            write_to(&mesh, format, &options, &mut bytes).expect("memory");
            let text = String::from_utf8_lossy(&bytes);
            let code = format!("\"componentType\":{component}");
            assert!(text.contains(&code), "{vertices} {format}");
            assert!(format == Format::Gltf || bytes.len().is_multiple_of(4));
            let again = read_from("a.glb", bytes.as_slice(), &ReadOptions::default());
            assert_eq!(
                again.expect("valid").into_polygons().0,
                mesh,
                "{vertices} {format}"
            );
        }
    }
}
