//! Notices on standard error are also in the documents of `--json`.

use serde_json::Value;

use crate::json_csv::parsed;
use crate::run::{Sixfold, TETRAHEDRON, text};

/// An ASCII STL file of a tetrahedron, with a normal that is not a number.
fn stl_with_a_bad_normal() -> String {
    let corners = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
    let mut stl = String::from("solid t\n");
    for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        stl += "facet normal nan nan nan\nouter loop\n";
        for corner in face {
            stl += &format!("vertex {}\n", corners[corner]);
        }
        stl += "endloop\nendfacet\n";
    }
    stl + "endsolid t\n"
}

/// Returns the notices of a document, and of each member of a list of documents.
fn notices(document: &Value) -> Vec<String> {
    match document.as_array() {
        Some(list) => list.iter().flat_map(notices).collect(),
        None => {
            let list = document["notices"].as_array().expect("a list");
            let texts = list.iter().map(|notice| notice.as_str().expect("text"));
            texts.map(str::to_owned).collect()
        }
    }
}

/// Returns the notes and warnings that a command printed, each with its places.
fn printed_notices(stderr: &str) -> Vec<String> {
    let mut notices: Vec<String> = Vec::new();
    for line in stderr.lines() {
        match (line.strip_prefix("note:   "), notices.last_mut()) {
            (Some(place), Some(last)) if last.ends_with(':') => *last += &format!(" {place}"),
            (Some(place), Some(last)) => *last += &format!("; {place}"),
            _ if line.starts_with("note:") || line.starts_with("warning:") => {
                notices.push(line.to_owned());
            }
            _ => {}
        }
    }
    notices
}

#[test]
fn every_notice_is_in_the_document() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    sixfold.file("nan.stl", &stl_with_a_bad_normal());
    let repeated = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 2 3 4\nf 4 3 5 6\n";
    sixfold.file("repeated.obj", repeated);
    let line = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n";
    sixfold.file("line.obj", line);
    let bow_tie = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n";
    sixfold.file("bow.obj", bow_tie);
    let far = TETRAHEDRON
        .replace("v 1 0 0", "v 1000001 0 0")
        .replace("v 0 ", "v 1000000 ");
    sixfold.file("far.obj", &far);
    let commands: [&[&str]; 14] = [
        &["inspect", "nan.stl"],
        &["inspect", "repeated.obj"],
        &["inspect", "repeated.obj", "line.obj", "nan.stl"],
        &["inspect", "bow.obj", "--triangulate"],
        &["inspect", "far.obj", "--recentre"],
        &["repair", "line.obj", "--weld", "-o", "out.stl"],
        &["repair", "nan.stl", "--for", "half-edge", "-o", "out.obj"],
        &["distance", "nan.stl", "repeated.obj"],
        &["distance", "t.obj", "bow.obj"],
        &[
            "study",
            "line.obj",
            "--rounds",
            "2",
            "--backends",
            "half-edge",
        ],
        &[
            "study",
            "nan.stl",
            "t.obj",
            "--rounds",
            "2",
            "--backends",
            "half-edge",
        ],
        &["pick", "nan.stl", "missing.obj", "--rounds", "2"],
        &["memory", "nan.stl"],
        &["tables", "nan.stl"],
    ];
    for command in commands {
        let run = sixfold.run(&[command, &["--json", "document.json"]].concat());
        let printed = printed_notices(&run.stderr);
        assert!(!printed.is_empty(), "{command:?}: no notice: {run:?}");
        let document = parsed(&text(&sixfold, "document.json"));
        assert_eq!(notices(&document), printed, "{command:?}");
    }
}

/// A kind of notice with several places is one notice of the document.
#[test]
fn a_kind_of_notice_is_in_the_document_once() {
    let sixfold = Sixfold::new();
    let mut lines = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for _ in 0..7 {
        lines += "f 1 1 2\n";
    }
    sixfold.file("lines.obj", &lines);
    // Six squares in different planes, whose outside is not known, without a common vertex.
    let (mut squares, mut faces) = (String::new(), String::new());
    for i in 0..6 {
        squares += &format!("v 0 0 {i}\nv 1 0 {i}\nv 1 1 {i}\nv 0 1 {i}\n");
        let [a, b, c, d] = [1, 2, 3, 4].map(|corner| 4 * i + corner);
        faces += &format!("f {a} {b} {c} {d}\n");
    }
    sixfold.file("squares.obj", &(squares + &faces));
    let repair = [
        "repair",
        "squares.obj",
        "--orient",
        "outward",
        "-o",
        "out.obj",
    ];
    for (command, begin, end) in [
        (
            &["inspect", "lines.obj"][..],
            "note: lines.obj: left out 7 degenerate faces: line 5: face 1 1 2",
            "; and 2 more",
        ),
        (
            &repair,
            "note: squares.obj: orient faces: the component of face f0 (1 face)",
            "; and 1 more",
        ),
    ] {
        let run = sixfold.run(&[command, &["--json", "document.json"]].concat());
        assert_eq!(run.code, Some(0), "{run:?}");
        let document = notices(&parsed(&text(&sixfold, "document.json")));
        let [notice] = &document[..] else {
            panic!("one notice: {document:?}");
        };
        assert!(
            notice.starts_with(begin) && notice.ends_with(end),
            "{notice}"
        );
        assert_eq!(printed_notices(&run.stderr), document);
    }
}

#[test]
fn merged_documents_keep_their_notices() {
    let sixfold = Sixfold::new();
    sixfold.file("nan.stl", &stl_with_a_bad_normal());
    sixfold.file("t.obj", TETRAHEDRON);
    for (mesh, document) in [("nan.stl", "a.json"), ("t.obj", "b.json")] {
        let run = sixfold.run(&["memory", mesh, "--json", document]);
        assert_eq!(run.code, Some(0), "{run:?}");
    }
    let before = notices(&parsed(&text(&sixfold, "a.json")));
    assert!(!before.is_empty());
    let run = sixfold.run(&["merge", "b.json", "a.json", "--json", "all.json"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(notices(&parsed(&text(&sixfold, "all.json"))), before);
}
