//! Requests and responses.

use proptest::prelude::*;
use serde_json::{Value, json};
use sixfold::io::parse_creases;
use sixfold::subdivision::{Method, Scheme, Subdivision, subdivide};
use sixfold::{FaceVertexMesh, Relation, shapes};
use sixfold_explain::{Geometry, Structure, respond};

fn ask(request: &Value) -> Value {
    let response = respond(&request.to_string());
    serde_json::from_str(&response).expect("a response is JSON")
}

/// Asks about a shape.
fn ask_shape(name: &str, ask_for: &Value) -> Value {
    ask(&json!({ "mesh": { "shape": { "name": name } }, "ask": ask_for }))
}

fn error(request: &Value) -> String {
    let response = ask(request);
    let error = response["error"].as_str();
    error
        .unwrap_or_else(|| panic!("{request}: {response}"))
        .to_owned()
}

#[test]
fn answers_are_what_the_functions_return() {
    let octahedron = shapes::octahedron();
    let edit = "flip_edge v0-v2";
    for structure in Structure::all() {
        let name = structure.name();
        let one = |ask_for: &Value, edits: &[&str]| {
            let response = ask(&json!({
                "mesh": { "shape": { "name": "octahedron" } },
                "structures": [name],
                "edits": edits,
                "ask": ask_for,
            }));
            assert_eq!(response["refused"], json!([]), "{response}");
            assert_eq!(response["answers"].as_array().map(Vec::len), Some(1));
            response["answers"][0].clone()
        };
        let mut mesh = structure.build(&octahedron).expect("held");
        let flip = mesh.edit(&edit.parse().expect(edit)).expect("an edge");
        assert_eq!(one(&json!({ "edit": edit }), &[]), json!(flip));
        let element = "v3".parse().expect("a name");
        let trace = mesh
            .trace(Relation::VertexFaces, element)
            .expect("a vertex");
        let query = json!({ "relation": "vertex_faces", "element": "v3" });
        assert_eq!(one(&json!({ "trace": query }), &[edit]), json!(trace));
        let expected = json!({ "backend": name, "records": mesh.records(1..3) });
        assert_eq!(
            one(&json!({ "tables": { "rows": [1, 2] } }), &[edit]),
            expected
        );
        let geometry = one(&json!("geometry"), &[edit]);
        assert_eq!(geometry["faces"], json!(mesh.geometry().faces));
        let source = "yield v3";
        let walk = mesh.walk(source, None);
        // A soup has no rows for vertices.
        assert_eq!(walk.is_ok(), name != "polygon-soup", "{name}: {walk:?}");
        if let Ok(walk) = walk {
            assert_eq!(
                one(&json!({ "walk": { "walk": source } }), &[edit]),
                json!(walk)
            );
        }
    }
}

#[test]
fn an_edit_that_is_left_out_is_undone_and_a_refused_one_is_named() {
    let tables = |edits: &[&str]| {
        ask(&json!({
            "mesh": { "shape": { "name": "octahedron" } },
            "edits": edits,
            "ask": { "tables": {} },
        }))
    };
    let before = tables(&["poke_face f1"]);
    let after = tables(&["poke_face f1", "collapse_edge v0-v2 v0"]);
    assert_eq!(before["answers"].as_array().map(Vec::len), Some(6));
    assert_ne!(before, after);
    assert_eq!(before, tables(&["poke_face f1"]));
    let missing = tables(&["flip_edge v0-v2", "flip_edge v0-v2"]);
    let reason = missing["refused"][0]["reason"].as_str().expect("a reason");
    assert!(reason.contains("refuses flip_edge v0-v2: "), "{reason}");
    // A structure that refuses an edit has no tables after it.
    let refused = tables(&["dissolve_edge v0-v2"]);
    assert_eq!(
        refused["answers"].as_array().map(Vec::len),
        Some(5),
        "{refused}"
    );
    let [corner_table] = &refused["refused"].as_array().expect("a list")[..] else {
        panic!("{refused}")
    };
    assert_eq!(corner_table["backend"], "corner-table");
    let reason = corner_table["reason"].as_str().expect("a reason");
    assert!(
        reason.starts_with("corner-table refuses dissolve_edge v0-v2: "),
        "{reason}"
    );
}

/// A refusal names the field that has no room, in verdicts and in answers.
#[test]
fn refusals_say_which_field_has_no_room() {
    let points: Vec<[f64; 3]> = (0..6)
        .map(|i| [f64::from(i), f64::from(i * i), 0.0])
        .collect();
    let refusal = |faces: Value, structure: &str| {
        let mesh = json!({ "polygons": { "positions": points, "faces": faces } });
        let query = json!({ "relation": "vertex_faces", "element": "v0" });
        let ask_for = |ask_for: Value| {
            ask(&json!({ "mesh": mesh, "structures": [structure], "ask": ask_for }))
        };
        let verdicts = ask_for(json!("verdicts"));
        let traced = ask_for(json!({ "trace": query }));
        assert_eq!(
            verdicts["verdicts"][0]["reason"],
            traced["refused"][0]["reason"]
        );
        let holds_triangles = traced["holding_triangles"] == json!([structure]);
        let reason = traced["refused"][0]["reason"].as_str().expect("a reason");
        (reason.to_owned(), holds_triangles)
    };
    let book = || json!([[0, 1, 2], [1, 0, 3], [1, 0, 4]]);
    let same = || json!([[0, 1, 2], [0, 1, 3]]);
    let fans = || json!([[0, 1, 2], [0, 3, 4]]);
    for (faces, structure, room) in [
        (
            book(),
            "half-edge",
            "a half-edge has one twin, so the side of f2 has no place",
        ),
        (
            book(),
            "winged-edge",
            "an edge has one face on its left and one on its right, so f2 has no place",
        ),
        (
            book(),
            "corner-table",
            "a corner has one opposite, so the corner of f2 across the edge has no place",
        ),
        (
            same(),
            "half-edge",
            "a half-edge and its twin run in opposite directions, so the side of f1 has no place",
        ),
        (
            same(),
            "winged-edge",
            "f0 and f1 are on the same one, so f1 has no place",
        ),
        (
            same(),
            "corner-table",
            "opposite corners see the edge in opposite directions, so the corner of f1",
        ),
        (
            fans(),
            "half-edge",
            "the one half-edge of v0 around the vertex does not come to f1",
        ),
        (
            fans(),
            "winged-edge",
            "the one edge of v0 around the vertex does not come to f1",
        ),
        (
            fans(),
            "corner-table",
            "the one corner of v0 around the vertex does not come to f1",
        ),
        (
            book(),
            "polygon-soup",
            "vertices are stored in the corners of faces only, so v5 has no place",
        ),
    ] {
        let (reason, holds_triangles) = refusal(faces, structure);
        assert!(reason.contains(room), "{structure}: {reason}");
        assert!(!holds_triangles, "{structure}");
    }
    let (reason, holds_triangles) = refusal(json!([[0, 1, 2, 3]]), "corner-table");
    assert!(
        reason.ends_with("so the fourth corner of f0 has no place"),
        "{reason}"
    );
    assert!(holds_triangles);
    // Cutting these polygons is not enough.
    let (_, holds_triangles) = refusal(json!([[0, 1, 2, 3], [1, 0, 4], [1, 0, 5]]), "corner-table");
    assert!(!holds_triangles);
}

#[test]
fn verdicts_name_the_faults_and_repairs_mend_them() {
    // Three triangles on one edge, as in a file.
    let text = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 2 1 4\nf 2 1 5\nf 3 3 1\n";
    let mesh = json!({ "file": { "name": "book.obj", "text": text } });
    let response = ask(&json!({ "mesh": mesh, "ask": "verdicts" }));
    let verdict = |name: &str| {
        let verdicts = response["verdicts"].as_array().expect("a list");
        let found = verdicts.iter().find(|verdict| verdict["backend"] == name);
        found.expect("one of six").clone()
    };
    assert_eq!(verdict("indexed-face-set")["holds"], true);
    assert_eq!(verdict("half-edge")["holds"], false);
    assert_eq!(verdict("half-edge")["faults"][0], "non_manifold_edge");
    let fault = &response["faults"][0];
    assert_eq!(fault["places"], json!([{ "edge": [0, 1] }]));
    assert_eq!(fault["title"], "edge with three or more faces", "{fault}");
    assert_eq!(fault["count"], 1);
    assert_eq!(
        response["notes"],
        json!(["left out line 9: face 3 3 1 names vertex 3 twice"])
    );
    let repaired = ask(&json!({ "mesh": mesh, "structures": ["half-edge"], "ask": "repair" }));
    let answer = &repaired["answers"][0];
    let steps = answer["steps"].as_array().expect("a list");
    assert!(
        steps
            .iter()
            .any(|step| step["step"] == "cut into manifolds")
    );
    let polygons = json!({ "positions": answer["vertices"], "faces": answer["faces"] });
    let again = ask(&json!({
        "mesh": { "polygons": polygons },
        "structures": ["half-edge"],
        "ask": "verdicts",
    }));
    assert_eq!(again["verdicts"][0]["holds"], true, "{again}");
    let facts = ask(&json!({ "mesh": { "polygons": polygons }, "ask": "facts" }));
    assert_eq!(facts["facts"]["faces"], 3, "{facts}");
}

#[test]
fn sweeps_count_results_and_structures_agree() {
    let torus = json!({ "shape": { "name": "torus", "parameters": { "m": 5, "n": 4 } } });
    let sweep = |queries: u32| json!({ "mesh": torus, "ask": { "sweep": { "relation": "vertex_faces", "queries": queries } } });
    let response = ask(&sweep(20));
    let answers = response["answers"].as_array().expect("a list");
    assert_eq!(answers.len(), 5, "{response}");
    assert!(
        answers.iter().all(|answer| answer["results"] == 80),
        "{response}"
    );
    assert_eq!(response["refused"][0]["backend"], "corner-table");
    let error = ask(&sweep(10_000_001))["error"].to_string();
    assert!(error.contains("at most 10000000 queries"), "{error}");
}

#[test]
fn a_binary_file_is_read_like_a_text() {
    use base64::Engine;
    let mut stl = vec![0; 80];
    stl.extend(1u32.to_le_bytes());
    let corners = [
        [0.0f32, 0.0, 1.0],
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    stl.extend(corners.iter().flatten().flat_map(|x| x.to_le_bytes()));
    stl.extend([0, 0]);
    let base64 = base64::engine::general_purpose::STANDARD.encode(&stl);
    let file = |content: Value| json!({ "mesh": { "file": content }, "ask": "geometry" });
    let response = ask(&file(json!({ "name": "one.stl", "base64": base64 })));
    assert_eq!(
        response["answers"][1]["faces"],
        json!([[0, 1, 2]]),
        "{response}"
    );
    let cut = base64::engine::general_purpose::STANDARD.encode(&stl[..100]);
    let message = error(&file(json!({ "name": "one.stl", "base64": cut })));
    assert!(message.starts_with("one.stl"), "{message}");
    assert!(error(&file(json!({ "name": "a.obj" }))).contains("either a text or base64"));
}

#[test]
fn geometry_after_edits_can_be_sent_back() {
    let edited = ask(&json!({
        "mesh": { "shape": { "name": "cube" } },
        "edits": ["remove_vertex v3"],
        "structures": ["half-edge"],
        "ask": "geometry",
    }));
    let Value::Object(answer) = &edited["answers"][0] else {
        panic!("{edited}")
    };
    let polygons = json!({ "positions": answer["vertices"], "faces": answer["faces"] });
    let facts = ask(&json!({ "mesh": { "polygons": polygons }, "ask": "facts" }));
    assert_eq!(facts["facts"]["vertices"], 7, "{facts}");
    assert_eq!(facts["facts"]["faces"], 3, "{facts}");
    assert_eq!(facts["notes"].as_array().map(Vec::len), Some(2), "{facts}");
    let missing = json!({ "positions": [[0, 0, 0], null, [1, 0, 0]], "faces": [[0, 2, 1]] });
    let message = error(&json!({ "mesh": { "polygons": missing }, "ask": "facts" }));
    assert_eq!(message, "face f0 has the corner v1, which has no position");
}

#[test]
fn positions_that_are_not_finite_are_refused() {
    let triangle = |z: f64| {
        json!({ "polygons": {
            "positions": [[0, 0, z], [1, 0, -z], [0, 1, z]],
            "faces": [[0, 1, 2]],
        } })
    };
    let message = error(&json!({ "mesh": triangle(1e39), "ask": "geometry" }));
    assert!(
        message.starts_with("v0 of the mesh has a coordinate"),
        "{message}"
    );
    let subdivide = json!({ "subdivide": { "scheme": "loop", "levels": 1 } });
    let message = error(&json!({ "mesh": triangle(3e38), "ask": subdivide }));
    assert!(message.contains("of the refined mesh"), "{message}");
}

#[test]
fn creases_of_a_request_are_added_to_those_of_the_file() {
    let request = |creases: &str| {
        json!({
            "mesh": { "shape": { "name": "octahedron" } },
            "creases": creases,
            "ask": { "stencil": { "scheme": "loop", "level": 1, "point": 6 } },
        })
    };
    let parents = |creases: &str| ask(&request(creases))["parents"].as_array().map(Vec::len);
    assert_eq!(parents(""), Some(4));
    assert_eq!(parents("edge 0 2 inf"), Some(2));
    let message = error(&request("edge 0 1 inf"));
    assert!(message.starts_with("creases:1"), "{message}");
}

/// The parents of a point, with their weights.
fn parents(mesh: &Value, scheme: Scheme, level: u32, point: usize) -> Vec<(usize, f64)> {
    let stencil = json!({ "scheme": scheme.to_string(), "level": level, "point": point });
    let response = ask(&json!({ "mesh": mesh, "ask": { "stencil": stencil } }));
    let parents = response["parents"].as_array();
    let parents = parents.unwrap_or_else(|| panic!("{scheme} of {mesh}: {response}"));
    let parent = |parent: &Value| {
        let name = parent["vertex"].as_str().expect("a name");
        let vertex = name[1..].parse().expect("a number");
        (vertex, parent["weight"].as_f64().expect("a number"))
    };
    parents.iter().map(parent).collect()
}

#[test]
fn weights_add_up_to_one_and_give_the_points() {
    let meshes = [
        json!({ "shape": { "name": "octahedron" } }),
        json!({ "shape": { "name": "triangle-grid", "parameters": { "m": 2, "n": 2 } } }),
        json!({ "shape": { "name": "cube" } }),
        json!({ "shape": { "name": "triangle-torus", "parameters": { "m": 5, "n": 4 } } }),
    ];
    for mesh in &meshes {
        for scheme in Scheme::ALL {
            let ask_for = json!({ "subdivide": { "scheme": scheme.to_string(), "levels": 2 } });
            let response = ask(&json!({ "mesh": mesh, "ask": ask_for }));
            let Some(levels) = response["levels"].as_array() else {
                let error = response["error"].as_str().expect("a response");
                assert!(error.contains("face f0 has 4 corners"), "{scheme}: {error}");
                continue;
            };
            assert_eq!(levels.len(), 3);
            for level in 1..3 {
                let points = levels[level]["vertices"].as_array().expect("a list");
                for (number, point) in points.iter().enumerate().step_by(level * 2 - 1) {
                    let parents = parents(mesh, scheme, level as u32, number);
                    let sum: f64 = parents.iter().map(|&(_, weight)| weight).sum();
                    assert!((sum - 1.0).abs() < 1e-5, "{scheme} v{number}: {parents:?}");
                    for axis in 0..3 {
                        let weighted = parents.iter().map(|&(vertex, weight)| {
                            let parent = &levels[level - 1]["vertices"][vertex];
                            weight * parent[axis].as_f64().expect("a number")
                        });
                        let expected = point[axis].as_f64().expect("a number");
                        let difference = (weighted.sum::<f64>() - expected).abs();
                        assert!(difference < 1e-5, "{scheme} v{number}: {parents:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn levels_are_those_of_the_library() {
    let creases = "edge 0 2 1.5\ncorner 4 inf";
    let octahedron = shapes::octahedron();
    for scheme in Scheme::ALL {
        let creases = if scheme.properties().creases {
            creases
        } else {
            ""
        };
        let response = ask(&json!({
            "mesh": { "shape": { "name": "octahedron" } },
            "creases": creases,
            "ask": { "subdivide": { "scheme": scheme.to_string(), "levels": 3 } },
        }));
        let sharp = parse_creases("creases", creases.as_bytes(), &octahedron).expect("creases");
        for level in 0..4 {
            let subdivision = Subdivision::new(scheme);
            let method = Method::Gather;
            let expected =
                subdivide::<FaceVertexMesh>(&subdivision, method, &octahedron, &sharp, level);
            let expected = expected.expect("a closed mesh").polygons;
            let expected = serde_json::to_string(&Geometry::from_polygons(&expected));
            // As text, because a coordinate is written with the digits of 32 bits.
            let expected: Value = serde_json::from_str(&expected.expect("JSON")).expect("JSON");
            let answered = &response["levels"][level as usize];
            assert_eq!(*answered, expected, "{scheme}, level {level}");
        }
    }
}

#[test]
fn weights_are_the_masks_of_the_papers() {
    let octahedron = json!({ "shape": { "name": "octahedron" } });
    // Loop (1987) at valence 4, and on an edge.
    let beta: f64 = (0.625 - (0.375 + 0.25 * (std::f64::consts::TAU / 4.0).cos()).powi(2)) / 4.0;
    let sorted = |mut parents: Vec<(usize, f64)>| {
        parents.sort_by(|a, b| a.1.total_cmp(&b.1));
        parents
            .into_iter()
            .map(|(_, weight)| weight)
            .collect::<Vec<_>>()
    };
    let are_near = |actual: Vec<f64>, expected: &[f64]| {
        assert_eq!(actual.len(), expected.len(), "{actual:?}");
        for (actual, expected) in actual.iter().zip(expected) {
            assert!((actual - expected).abs() < 1e-6, "{actual} {expected}");
        }
    };
    let vertex = sorted(parents(&octahedron, Scheme::Loop, 1, 0));
    are_near(vertex, &[beta, beta, beta, beta, 1.0 - 4.0 * beta]);
    let edge = sorted(parents(&octahedron, Scheme::Loop, 1, 6));
    are_near(edge, &[0.125, 0.125, 0.375, 0.375]);
    let cube = json!({ "shape": { "name": "cube" } });
    let face = sorted(parents(&cube, Scheme::CatmullClark, 1, 8));
    are_near(face, &[0.25; 4]);
    // A crease of the file keeps its edge sharp.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    let sharp = format!("{text}t crease 2/1/0 0 1 inf\n");
    let middle = |text: &str| {
        let mesh = json!({ "file": { "name": "a.obj", "text": text } });
        let count = |point: &usize| parents(&mesh, Scheme::Loop, 1, *point).len() == 2;
        (4..10).filter(count).count()
    };
    assert_eq!((middle(text), middle(&sharp)), (0, 1));
}

#[test]
fn a_wrong_request_says_what_is_wrong() {
    let about = |mesh: Value, ask_for: Value| json!({ "mesh": mesh, "ask": ask_for });
    let cube = json!({ "shape": { "name": "cube" } });
    let stencil = |level: u32, point: usize| json!({ "stencil": { "scheme": "loop", "level": level, "point": point } });
    let octahedron = json!({ "shape": { "name": "octahedron" } });
    let trace = json!({ "trace": { "relation": "vertex_faces", "element": "3" } });
    let cases = [
        (json!({}), "missing field `mesh`"),
        (json!(3), "expected a request"),
        (
            json!({ "mesh": cube, "ask": "fact" }),
            "unknown variant `fact`",
        ),
        (
            json!({ "mesh": cube, "ask": "facts", "edit": [] }),
            "unknown field `edit`",
        ),
        (
            about(json!({ "shape": { "name": "cuba" } }), json!("facts")),
            "no shape is called `cuba`",
        ),
        (
            about(
                json!({ "polygons": { "positions": [[0, 0, 0]], "faces": [[0, 1, 2]] } }),
                json!("facts"),
            ),
            "face f0",
        ),
        (about(cube.clone(), trace), "`3` names no element"),
        (
            about(octahedron.clone(), stencil(0, 0)),
            "level 0 have no parents",
        ),
        (about(octahedron.clone(), stencil(1, 18)), "no v18"),
        (
            about(
                json!({ "polygons": { "positions": [], "faces": [] } }),
                stencil(u32::MAX, 0),
            ),
            "at most 16 levels",
        ),
        (
            about(octahedron.clone(), stencil(16, 0)),
            "a request at most",
        ),
        (
            about(
                octahedron,
                json!({ "subdivide": { "scheme": "lop", "levels": 1 } }),
            ),
            "`lop`",
        ),
        (
            json!({ "mesh": cube, "structures": ["quad-edge"], "ask": "verdicts" }),
            "no structure is called `quad-edge`",
        ),
        (
            json!({ "mesh": cube, "edits": ["compact"], "ask": "facts" }),
            "ask for the geometry after the edits",
        ),
    ];
    let more = [
        (
            about(cube.clone(), json!({ "tables": { "rows": [5, 2] } })),
            "ask for [2, 5]",
        ),
        (
            json!({ "mesh": cube, "edits": ["compact", "flip v0-v1"], "ask": "geometry" }),
            "edits, number 2: ",
        ),
    ];
    for (request, part) in cases.into_iter().chain(more) {
        let message = error(&request);
        assert!(message.contains(part), "{request}: {message}");
    }
    let large = json!({ "shape": { "name": "grid", "parameters": { "m": 400, "n": 400 } } });
    let message = error(&about(large, json!("facts")));
    assert!(message.contains("640000 corners"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// A request in which some characters are replaced is answered or is an error.
    #[test]
    fn a_request_with_faults_is_answered_or_is_an_error(
        which in 0usize..9,
        faults in prop::collection::vec((any::<prop::sample::Index>(), "[ -~]{0,2}"), 0..4),
    ) {
        let asked = [
            json!({ "tables": { "rows": [0, 3] } }),
            json!({ "trace": { "relation": "face_faces", "element": "f1" } }),
            json!({ "edit": "split_vertex v0 v2 v3 0.5,1,0" }),
            json!({ "walk": {
                "walk": "h = leaving(v3); repeat { yield target(h); h = next(twin(h)) }",
                "expect": { "relation": "vertex_vertices", "element": "v3" },
            } }),
            json!("geometry"),
            json!("verdicts"),
            json!("repair"),
            json!({ "subdivide": { "scheme": "loop", "levels": 1 } }),
            json!({ "stencil": { "scheme": "butterfly", "level": 1, "point": 9 } }),
        ];
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
        let request = json!({
            "mesh": { "file": { "name": "a.obj", "text": text } },
            "ask": asked[which],
        });
        let mut request = request.to_string();
        for (place, text) in faults {
            let at = place.index(request.len());
            request.replace_range(at..=at, &text);
        }
        let response: Value = serde_json::from_str(&respond(&request)).expect("JSON");
        prop_assert!(response.is_object());
    }
}

#[test]
fn tables_have_the_first_two_hundred_rows_unless_rows_are_named() {
    let tables = |rows: Value| {
        let mesh = json!({ "shape": { "name": "grid", "parameters": { "m": 20, "n": 20 } } });
        let response = ask(&json!({
            "mesh": mesh,
            "structures": ["indexed-face-set"],
            "ask": { "tables": rows },
        }));
        let rows = response["answers"][0]["records"][0]["rows"].clone();
        let rows = rows.as_array().expect("the vertices").clone();
        let names = [rows.first(), rows.last()].map(|row| row.expect("rows")["name"].clone());
        (rows.len(), names)
    };
    assert_eq!(tables(json!({})), (200, [json!("v0"), json!("v199")]));
    let named = json!({ "rows": [7, 9] });
    assert_eq!(tables(named), (3, [json!("v7"), json!("v9")]));
    let one = json!({ "rows": [7, 7] });
    assert_eq!(tables(one), (1, [json!("v7"), json!("v7")]));
}

#[test]
fn a_shape_of_a_request_has_its_response() {
    let response = ask_shape("cube", &json!("facts"));
    assert_eq!(response["facts"]["vertices"], 8, "{response}");
    assert!(response.get("notes").is_none(), "{response}");
}
