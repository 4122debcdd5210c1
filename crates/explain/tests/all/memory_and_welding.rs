//! The requests `memory` and `weld`.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use sixfold::{MeshQuery, PolygonMesh, Representation, shapes};
use sixfold_core::Measured;
use sixfold_explain::respond;

fn ask(mesh: &PolygonMesh, ask_for: &Value) -> Value {
    let faces: Vec<Vec<usize>> = (mesh.faces().iter())
        .map(|(_, face)| face.iter().map(|v| v.index()).collect())
        .collect();
    let positions = mesh.positions().iter();
    let positions: Vec<[f32; 3]> = positions.map(|position| position.to_array()).collect();
    let mesh = json!({ "polygons": { "positions": positions, "faces": faces } });
    let response = respond(&json!({ "mesh": mesh, "ask": ask_for }).to_string());
    serde_json::from_str(&response).expect("a response is JSON")
}

fn number(value: &Value) -> usize {
    value.as_u64().expect("a number") as usize
}

/// Returns the value of a formula such as `16 V + 12 H + 4`.
fn value(formula: &str, counts: &BTreeMap<&str, usize>) -> usize {
    let terms = formula.split(" + ").map(|term| {
        let (factor, symbol) = term.split_once(' ').unwrap_or((term, ""));
        let factor: usize = factor.parse().expect("a factor");
        factor * counts.get(symbol).copied().unwrap_or(1)
    });
    terms.sum()
}

#[test]
fn the_memory_is_that_of_the_layout_formula() {
    let meshes = [
        shapes::tetrahedron(),
        shapes::cube(),
        // Faces of two degrees have a table of offsets.
        shapes::prism(5).expect("a prism"),
        shapes::grid(4, 3).expect("a grid"),
    ];
    for polygons in &meshes {
        let response = ask(polygons, &json!("memory"));
        let answers = response["answers"].as_array().expect("answers");
        let mut held = 0;
        sixfold::for_each_representation!(M => {
            let answer = answers.iter().find(|answer| answer["backend"] == M::NAME);
            let mesh = M::from_polygons(polygons);
            assert_eq!(mesh.is_ok(), answer.is_some(), "{}", M::NAME);
            if let (Ok(mesh), Some(answer)) = (mesh, answer) {
                held += 1;
                let counts = polygons.counts(mesh.edge_count());
                let bytes = number(&answer["bytes"]);
                assert_eq!(bytes, M::layout_bytes(&counts), "{answer}");
                // Three ways to the same sum.
                let tables = answer["tables"].as_array().expect("tables");
                let sum = |of: &dyn Fn(&Value) -> usize| tables.iter().map(of).sum::<usize>();
                assert_eq!(sum(&|table| number(&table["bytes"])), bytes);
                let product = |table: &Value| number(&table["row_bytes"]) * number(&table["rows"]);
                assert_eq!(sum(&product), bytes);
                let symbols = answer["symbols"].as_array().expect("symbols").iter();
                let symbols: BTreeMap<&str, usize> = symbols
                    .map(|one| (one["symbol"].as_str().expect("text"), number(&one["count"])))
                    .collect();
                assert_eq!(value(answer["formula"].as_str().expect("text"), &symbols), bytes);
                let elements = [
                    ("V", counts.vertices),
                    ("E", counts.edges),
                    ("H", 2 * counts.edges),
                    ("F", counts.faces),
                    ("C", counts.corners),
                ];
                for (symbol, count) in elements {
                    assert!(symbols.get(symbol).is_none_or(|&known| known == count), "{answer}");
                }
            }
        });
        assert_eq!(answers.len(), held);
    }
}

/// A half-edge has its next one, its origin and its face; a vertex a position and a half-edge; a face a half-edge.
#[test]
fn the_formula_names_the_elements() {
    let response = ask(&shapes::cube(), &json!("memory"));
    let answers = response["answers"].as_array().expect("answers");
    let half_edge = answers
        .iter()
        .find(|answer| answer["backend"] == "half-edge");
    let half_edge = half_edge.expect("it holds a cube");
    assert_eq!(half_edge["formula"], "16 V + 12 H + 4 F");
    assert_eq!(half_edge["bytes"], 16 * 8 + 12 * 24 + 4 * 6);
    let halves = half_edge["tables"].as_array().expect("tables").iter();
    let mut halves = halves.filter(|table| table["table"] == "halves");
    assert_eq!(
        halves.next(),
        Some(&json!({
            "table": "halves", "element": "half-edge", "row_bytes": 12, "rows": 24, "rows_formula": "H", "bytes": 288,
        }))
    );
    // Seven faces have eight offsets.
    let response = ask(&shapes::prism(5).expect("a prism"), &json!("memory"));
    let soup = &response["answers"][0];
    assert_eq!(
        (&soup["backend"], &soup["formula"]),
        (&json!("polygon-soup"), &json!("12 C + 4 F + 4"))
    );
    assert_eq!(soup["tables"][1]["rows_formula"], "F + 1");
}

#[test]
fn memory_is_not_asked_of_a_mesh_with_edits() {
    let request = json!({
        "mesh": { "shape": { "name": "octahedron" } }, "edits": ["poke_face f0"], "ask": "memory",
    });
    assert!(respond(&request.to_string()).contains("asked of a mesh without edits"));
}

fn weld(mesh: &PolygonMesh, tolerance: f64) -> Value {
    let response = ask(mesh, &json!({ "weld": { "tolerance": tolerance } }));
    assert!(response["weld"].is_object(), "{response}");
    response["weld"].clone()
}

/// Returns the numbers of the corners' vertices in the order of their first corners.
fn numbered<T: PartialEq>(corners: impl Iterator<Item = T>) -> Vec<usize> {
    let mut known: Vec<T> = Vec::new();
    let number = corners.map(|corner| {
        let place = known.iter().position(|other| *other == corner);
        place.unwrap_or_else(|| {
            known.push(corner);
            known.len() - 1
        })
    });
    number.collect()
}

#[test]
fn corners_at_one_position_are_one_vertex() {
    for mesh in [
        shapes::cube(),
        shapes::dodecahedron(),
        shapes::grid(3, 2).expect("a grid"),
    ] {
        let welded = weld(&mesh, 0.0);
        let corners = mesh.faces().corners().iter();
        let map = numbered(corners.map(|v| v.index()));
        assert_eq!(welded["corners"], map.len());
        assert_eq!(welded["vertices"], mesh.vertex_count());
        assert_eq!(welded["map"], json!(map));
        assert_eq!(
            (&welded["faces_changed"], &welded["largest_shift"]),
            (&json!(0), &json!(0.0))
        );
    }
}

/// Two triangles at a gap of a quarter: 0.25 is exact in 32 bits.
#[test]
fn corners_within_the_tolerance_are_one_vertex() {
    let points =
        [[0, 0], [4, 0], [0, 4], [4, 0], [4, 4], [0, 4]].map(|[x, y]| [x as f32, y as f32, 0.0]);
    let mut points = points;
    points[3][0] += 0.25;
    points[5][1] += 0.25;
    let mesh = PolygonMesh::new(points, [[0_u32, 1, 2], [3, 4, 5]]).expect("two triangles");
    let apart = weld(&mesh, 0.0);
    assert_eq!(
        (&apart["vertices"], &apart["map"]),
        (&json!(6), &json!([0, 1, 2, 3, 4, 5]))
    );
    let below = weld(&mesh, 0.2499);
    assert_eq!(below["vertices"], 6);
    let joined = weld(&mesh, 0.25);
    assert_eq!(
        (&joined["vertices"], &joined["map"]),
        (&json!(4), &json!([0, 1, 2, 1, 3, 2]))
    );
    assert_eq!(
        (&joined["largest_shift"], &joined["faces_changed"]),
        (&json!(0.25), &json!(0))
    );
    // All corners are within 8 of the first, so no triangle is left.
    let one = weld(&mesh, 8.0);
    assert_eq!(
        (&one["vertices"], &one["faces_changed"]),
        (&json!(1), &json!(2))
    );
}

/// A vertex without a face has no corner, so it takes no part.
#[test]
fn a_vertex_without_a_face_is_not_welded() {
    let points = [
        [-1.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
    ];
    let mesh = PolygonMesh::new(points, [[1_u32, 2, 3]]).expect("a triangle");
    let welded = weld(&mesh, 1.0);
    assert_eq!(
        (&welded["corners"], &welded["vertices"]),
        (&json!(3), &json!(3))
    );
    assert_eq!(welded["largest_shift"], 0.0);
}

#[test]
fn a_large_mesh_has_the_first_corners_only() {
    let mesh = shapes::grid(40, 40).expect("a grid");
    let welded = weld(&mesh, 0.0);
    assert_eq!(
        (&welded["corners"], &welded["vertices"]),
        (&json!(6_400), &json!(41 * 41))
    );
    assert_eq!(welded["map"].as_array().map(Vec::len), Some(2_000));
}

#[test]
fn a_tolerance_is_a_finite_number_of_0_or_more() {
    let response = ask(&shapes::cube(), &json!({ "weld": { "tolerance": -0.5 } }));
    let error = response["error"].as_str().expect("an error");
    assert!(
        error.starts_with("the tolerance -0.5 is not a finite number of 0 or more"),
        "{error}"
    );
    for tolerance in ["null", "1e999", "\"0\""] {
        let mesh = r#"{"shape": {"name": "cube"}}"#;
        let request =
            format!(r#"{{"mesh": {mesh}, "ask": {{"weld": {{"tolerance": {tolerance}}}}}}}"#);
        let response = respond(&request);
        assert!(
            response.starts_with(r#"{"error":"the request: "#),
            "{response}"
        );
    }
}
