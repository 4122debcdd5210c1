//! An engine that keeps a mesh gives the same responses as `respond` for the whole mesh.

use proptest::prelude::*;
use proptest::sample::select;
use serde_json::{Value, json};
use sixfold_explain::{Engine, respond};

/// The fields of a request that bring a mesh.
fn meshes() -> Vec<Value> {
    let shape = |name: &str| json!({ "shape": { "name": name } });
    let file = |text: &str| json!({ "file": { "name": "a.obj", "text": text } });
    // Three faces on one edge, and a face that is left out with a note.
    let book =
        file("v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 2 1 4\nf 2 1 5\nf 3 3 1\n");
    let gap = json!({
        "positions": [[0, 0, 0], null, [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]],
        "faces": [[0, 2, 3, 4], null],
    });
    vec![
        json!({ "mesh": shape("tetrahedron") }),
        json!({ "mesh": shape("octahedron"), "creases": "edge 0 2 1.5" }),
        json!({ "mesh": shape("cube") }),
        json!({ "mesh": shape("cube"), "triangulate": true }),
        json!({ "mesh": { "shape": { "name": "grid", "parameters": { "m": 2, "n": 2 } } }, "triangulate": false }),
        json!({ "mesh": book }),
        json!({ "mesh": { "polygons": gap } }),
        // These are not read.
        json!({ "mesh": shape("cub") }),
        json!({ "mesh": shape("cube"), "creases": "edge 0 6 1" }),
    ]
}

/// A part of a request: the mesh, and what is done with the edits.
#[derive(Clone, Debug)]
struct Step {
    /// The number of a mesh; the last mesh if missing.
    mesh: Option<usize>,
    change: Change,
    structures: Value,
    ask: Value,
}

/// How the edits of a request differ from those of the request before.
#[derive(Clone, Debug)]
enum Change {
    None,
    /// Adds an edit.
    Add(String),
    /// Adds the edit that was asked for.
    Accept,
    /// Takes back edits from this number on.
    Undo(usize),
    /// Replaces the edit with this number, if there is one.
    Replace(usize, String),
}

fn edits() -> impl Strategy<Value = String> {
    let v = || 0u32..8;
    prop_oneof![
        (v(), v()).prop_map(|(a, b)| format!("flip_edge v{a}-v{b}")),
        (v(), v()).prop_map(|(a, b)| format!("split_edge v{a}-v{b}")),
        (v(), v()).prop_map(|(a, b)| format!("bisect_edge v{a}-v{b} 0,1,-0")),
        (v(), v()).prop_map(|(a, b)| format!("dissolve_edge v{a}-v{b}")),
        (v(), v()).prop_map(|(a, b)| format!("collapse_edge v{a}-v{b} v{a}")),
        (v(), v(), v()).prop_map(|(a, b, c)| format!("split_vertex v{a} v{b} v{c}")),
        (v(), v(), v()).prop_map(|(f, a, b)| format!("split_face f{f} v{a} v{b}")),
        (v(), v(), v()).prop_map(|(a, b, c)| format!("add_face v{a} v{b} v{c}")),
        v().prop_map(|f| format!("poke_face f{f}")),
        v().prop_map(|f| format!("remove_face f{f}")),
        v().prop_map(|v| format!("remove_vertex v{v}")),
        v().prop_map(|v| format!("set_position v{v} 0,0,0")),
        v().prop_map(|v| format!("set_position v{v} 0,-0,0")),
        select(vec![
            "add_vertex 1,2,3",
            "compact",
            "remove_isolated_vertices",
            "flip",
        ])
        .prop_map(String::from),
    ]
}

fn asks() -> impl Strategy<Value = Value> {
    let relation = select(vec![
        "vertex_vertices",
        "vertex_faces",
        "edge_faces",
        "face_faces",
    ]);
    let element = select(vec!["v0", "v3", "v0-v1", "v1-v2", "f0", "f4"]);
    let trace = (relation, element).prop_map(
        |(relation, element)| json!({ "trace": { "relation": relation, "element": element } }),
    );
    let walk = json!({ "walk": "h = leaving(v3); repeat { yield target(h); h = next(twin(h)) }" });
    let loop_step = json!({ "scheme": "loop", "levels": 1 });
    prop_oneof![
        4 => edits().prop_map(|edit| json!({ "edit": edit })),
        2 => trace,
        2 => select(vec![
            json!({ "tables": {} }),
            json!({ "tables": { "names": ["v2", "h3", "c1", "f0", "v2", "v90", "q0"] } }),
            json!({ "tables": { "names": ["v2"], "rows": [0, 1] } }),
            json!({ "tables": { "rows": [3, 2] } }),
            json!({ "walk": walk }),
            json!("geometry"),
            json!("facts"),
            json!("verdicts"),
            json!("repair"),
            json!({ "subdivide": loop_step }),
            json!({ "stencil": { "scheme": "loop", "level": 1, "point": 6 } }),
        ]),
    ]
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let change = prop_oneof![
        3 => Just(Change::None),
        3 => edits().prop_map(Change::Add),
        3 => Just(Change::Accept),
        1 => (0usize..6).prop_map(Change::Undo),
        1 => (0usize..4, edits()).prop_map(|(place, edit)| Change::Replace(place, edit)),
    ];
    let structures = prop_oneof![
        4 => Just(Value::Null),
        1 => Just(json!(["half-edge", "winged-edge"])),
        1 => Just(json!(["polygon-soup", "corner-table"])),
        1 => Just(json!(["no-structure"])),
    ];
    let mesh = prop_oneof![5 => Just(None), 1 => (0..meshes().len()).prop_map(Some)];
    let step =
        (mesh, change, structures, asks()).prop_map(|(mesh, change, structures, ask)| Step {
            mesh,
            change,
            structures,
            ask,
        });
    // Most sequences begin with a mesh.
    let first = prop_oneof![1 => Just(None), 9 => (0..meshes().len()).prop_map(Some)];
    let steps = prop::collection::vec(step, 1..20);
    (first, steps).prop_map(|(first, mut steps)| {
        steps[0].mesh = first;
        steps
    })
}

/// Changes the edits of the request before, in which `asked` was the question.
fn changed(edits: &mut Vec<String>, asked: &Value, change: &Change) {
    match change {
        Change::None => {}
        Change::Add(edit) => edits.push(edit.clone()),
        Change::Accept => edits.extend(asked["edit"].as_str().map(String::from)),
        Change::Undo(from) => edits.truncate(*from),
        Change::Replace(place, new) => {
            if let Some(edit) = edits.get_mut(*place) {
                edit.clone_from(new);
            }
        }
    }
}

/// Returns a request about a mesh.
fn request(mesh: &Value, edits: &[String], structures: &Value, ask: &Value) -> String {
    let mut request = mesh.clone();
    request["edits"] = json!(edits);
    request["ask"] = ask.clone();
    if !structures.is_null() {
        request["structures"] = structures.clone();
    }
    request.to_string()
}

/// Sends each request to one engine, and with the whole mesh to `respond`.
fn check(steps: &[Step]) {
    let (meshes, last) = (meshes(), json!({ "mesh": "last" }));
    let mut engine = Engine::new();
    let (mut whole, mut edits, mut asked) = (None, Vec::new(), Value::Null);
    for step in steps {
        let Step {
            change,
            structures,
            ask,
            ..
        } = step;
        changed(&mut edits, &asked, change);
        asked = ask.clone();
        let brought = step.mesh.map(|mesh| &meshes[mesh]);
        let response = engine.respond(&request(brought.unwrap_or(&last), &edits, structures, ask));
        // Without a last mesh, both have none.
        let mesh = brought.or(whole).unwrap_or(&last);
        assert_eq!(
            response,
            respond(&request(mesh, &edits, structures, ask)),
            "{mesh} {edits:?} {ask}"
        );
        if response.starts_with(r#"{"error""#) {
            // A text that is not an edit would make all later requests wrong.
            edits.retain(|edit| edit != "flip");
        } else {
            whole = brought.or(whole);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn an_engine_gives_the_responses_for_the_whole_mesh(steps in steps()) {
        check(&steps);
    }
}

fn step(change: Change, ask: Value) -> Step {
    Step {
        mesh: None,
        change,
        structures: Value::Null,
        ask,
    }
}

#[test]
fn edits_that_are_refused_in_the_middle_leave_the_structures_right() {
    let add = |edit: &str| Change::Add(edit.into());
    let edit = |edit: &str| json!({ "edit": edit });
    // An octahedron has no edge v0-v1.
    check(&[
        Step {
            mesh: Some(1),
            ..step(Change::None, json!("geometry"))
        },
        step(add("poke_face f0"), json!("geometry")),
        step(add("flip_edge v0-v1"), json!("geometry")),
        step(add("poke_face f1"), json!({ "tables": {} })),
        step(Change::Undo(1), json!({ "tables": {} })),
        step(Change::None, edit("flip_edge v0-v1")),
        step(Change::None, edit("collapse_edge v0-v2 v0")),
        step(Change::None, json!("geometry")),
        step(Change::None, edit("split_edge v0-v3")),
        step(Change::Accept, json!({ "tables": {} })),
    ]);
}

#[test]
fn an_edit_to_minus_zero_is_another_edit() {
    let replaced = "set_position v0 0,-0,0".into();
    check(&[
        Step {
            mesh: Some(0),
            ..step(
                Change::Add("set_position v0 0,0,0".into()),
                json!("geometry"),
            )
        },
        step(Change::Replace(0, replaced), json!("geometry")),
    ]);
}

#[test]
fn the_last_mesh_is_that_of_the_latest_request_without_an_error() {
    let mut engine = Engine::new();
    let last = |ask: Value| json!({ "mesh": "last", "ask": ask }).to_string();
    let vertices = |engine: &mut Engine| {
        let response: Value =
            serde_json::from_str(&engine.respond(&last(json!("facts")))).expect("JSON");
        response["facts"]["vertices"].as_u64()
    };
    let missing = engine.respond(&last(json!("facts")));
    assert!(missing.contains("there is no last mesh"), "{missing}");
    let shape =
        |name: &str, ask: Value| json!({ "mesh": { "shape": { "name": name } }, "ask": ask });
    engine.respond(&shape("cube", json!("facts")).to_string());
    assert_eq!(vertices(&mut engine), Some(8));
    // A mesh that cannot be read, a question that cannot be answered, and a text that is not a request.
    engine.respond(&shape("cub", json!("facts")).to_string());
    engine.respond(&shape("octahedron", json!({ "tables": { "rows": [1, 0] } })).to_string());
    engine.respond("{");
    assert_eq!(vertices(&mut engine), Some(8));
    engine.respond(&shape("octahedron", json!("facts")).to_string());
    assert_eq!(vertices(&mut engine), Some(6));
    for (field, value) in [("triangulate", json!(true)), ("creases", json!(""))] {
        let mut request = json!({ "mesh": "last", "ask": "facts" });
        request[field] = value;
        let response = engine.respond(&request.to_string());
        assert!(
            response.contains("the last mesh keeps its own"),
            "{response}"
        );
    }
    assert_eq!(vertices(&mut engine), Some(6));
}

#[test]
fn tables_have_the_named_rows_in_order() {
    let tables = |names: Value| {
        let request = json!({
            "mesh": { "shape": { "name": "cube" } },
            "structures": ["half-edge"],
            "ask": { "tables": { "names": names } },
        });
        serde_json::from_str::<Value>(&respond(&request.to_string())).expect("JSON")
    };
    let response = tables(json!(["h23", "v5", "h3", "h3", "h24", "c1", "v1"]));
    let records = response["answers"][0]["records"].as_array();
    let records = records.unwrap_or_else(|| panic!("{response}"));
    let names = |records: &Value| {
        let rows = records["rows"].as_array().expect("rows");
        let names = rows.iter().map(|row| row["name"].as_str().expect("a name"));
        names.map(String::from).collect::<Vec<_>>().join(" ")
    };
    let shown: Vec<String> = records.iter().map(names).collect();
    assert!(
        shown.contains(&"v1 v5".into()) && shown.contains(&"h3 h23".into()),
        "{shown:?}"
    );
    assert_eq!(records[0]["total"], 8, "{response}");
    assert!(
        tables(json!(["5"]))["error"]
            .as_str()
            .expect("an error")
            .contains("`5` names no row")
    );
    let many: Vec<String> = (0..2_001).map(|row| format!("h{row}")).collect();
    assert!(
        tables(json!(many))["error"]
            .as_str()
            .expect("an error")
            .contains("at most 2000 names")
    );
}
