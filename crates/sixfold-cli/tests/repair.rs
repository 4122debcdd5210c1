//! Tests of `sixfold repair`: meshes that no manifold structure holds become meshes that it holds.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

/// Three triangles on one edge.
const BOOK: &str = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 2 1 4\nf 2 1 5\n";

/// Two triangles that should share two vertices.
const UNWELDED: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";

#[test]
fn a_book_is_cut_for_a_structure() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    let arguments = [
        "repair",
        "book.obj",
        "--for",
        "half-edge",
        "-o",
        "cut.obj",
        "--json",
        "r.json",
    ];
    let run = sixfold.run(&arguments);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(
        run.stdout
            .contains("cut into manifolds: vertices added: 2, edges cut: 1\n"),
        "{run:?}"
    );
    assert!(
        run.stdout.ends_with("cut.obj: 7 vertices, 3 faces\n"),
        "{run:?}"
    );
    let report = std::fs::read_to_string(sixfold.folder().join("r.json")).expect("a report");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["before"]["vertices"], 5);
    assert_eq!(report["after"]["vertices"], 7);
    let steps = report["steps"].as_array().expect("steps");
    let cut = steps
        .iter()
        .find(|step| step["step"] == "cut into manifolds");
    assert_eq!(cut.expect("the step")["counts"]["vertices_added"], 2);
    let again = sixfold.run(&["repair", "cut.obj", "--for", "half-edge", "-o", "again.obj"]);
    assert!(
        again.stdout.starts_with("the mesh needs no repair\n"),
        "{again:?}"
    );
    let file = |name| std::fs::read(sixfold.folder().join(name)).expect("a mesh");
    assert_eq!(file("again.obj"), file("cut.obj"));
    assert_eq!(
        sixfold.names(),
        ["again.obj", "book.obj", "cut.obj", "r.json"],
        "no draft is left"
    );
}

#[test]
fn steps_run_in_order() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", UNWELDED);
    for weld in [&["--weld"][..], &["--weld=0"], &["--weld=0.1%"]] {
        let run = sixfold.run(&[&["repair", "a.obj", "-o", "b.obj"], weld].concat());
        assert_eq!(run.code, Some(0), "{run:?}");
        let expected = "weld vertices: vertices merged: 2\nb.obj: 4 vertices, 2 faces\n";
        assert_eq!(run.stdout, expected, "{weld:?}");
    }
    let filled = ["repair", "a.obj", "--weld", "--fill-holes=3", "-o", "-"];
    let run = sixfold.run(&filled);
    assert_eq!(
        run.stdout
            .lines()
            .filter(|line| line.starts_with("f "))
            .count(),
        2,
        "{run:?}"
    );
    let filled = [
        "repair",
        "a.obj",
        "--weld",
        "--fill-holes",
        "--hole-method",
        "ears",
        "-o",
        "-",
    ];
    let run = sixfold.run(&filled);
    // The hole has four edges; one of its diagonals is an edge already.
    assert_eq!(
        run.stdout
            .lines()
            .filter(|line| line.starts_with("f "))
            .count(),
        4,
        "{run:?}"
    );
}

#[test]
fn wrong_use_is_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    for (arguments, message) in [
        (&["-o", "out.obj"][..], "no repair is chosen"),
        (&["--weld=far", "-o", "out.obj"], "write a distance"),
        (
            &["--weld=-1", "-o", "out.obj"],
            "not a finite number of 0 or more",
        ),
        (&["--weld=200%", "-o", "out.obj"], "above 1"),
        (&["--for", "abacus", "-o", "out.obj"], "abacus"),
        (&["--cut", "-o", "book.obj"], "would overwrite the mesh"),
    ] {
        let all = [&["repair", "book.obj"], arguments].concat();
        assert_refused(&sixfold, &all, 2, message);
    }
    let holes = ["repair", "book.obj", "--fill-holes", "-o", "out.obj"];
    assert_refused(&sixfold, &holes, 3, "cut the mesh first");
    assert_eq!(sixfold.names(), ["book.obj"], "nothing is written");
}

/// Returns the commands of a text, as words. A backslash continues a line, as in a shell.
fn commands(text: &str) -> Vec<Vec<String>> {
    let text = text.replace(" \\\n", " ");
    let lines = text.lines().map(str::trim);
    let commands = lines.filter_map(|line| line.strip_prefix("sixfold "));
    let words = |command| shlex::split(command).expect("words of a shell");
    commands.map(words).collect()
}

#[test]
fn the_commands_that_inspect_prints_repair_the_mesh() {
    let sixfold = Sixfold::new();
    for (name, mesh) in [
        ("book.obj", BOOK),
        ("unwelded.obj", UNWELDED),
        // These names need care in a shell, or would be overwritten.
        ("-dash.obj", BOOK),
        ("my 'best' part.obj", BOOK),
        ("repaired.obj", BOOK),
    ] {
        sixfold.file(name, mesh);
        let inspect = ["inspect", "--json", "i.json", "--", name];
        let inspected = run_ok(&sixfold, &inspect).stdout;
        let text_words: Vec<&str> = inspected.split_whitespace().collect();
        let text_words = text_words.join(" ");
        let mut commands = commands(&inspected);
        assert_eq!(commands.len(), 1, "{name}: {inspected}");
        // The text has the options of each command of the document.
        let json: Value = serde_json::from_str(&text(&sixfold, "i.json")).expect("JSON");
        for fault in json["diagnosis"]["faults"].as_array().expect("faults") {
            let Some(command) = fault["repair"].as_str() else {
                continue;
            };
            let words = shlex::split(command).expect("words of a shell");
            let options = words[3..words.len() - 2].join(" ");
            // On an edge with three faces, two faces always run in the same direction.
            let is_listed = fault["kind"] != "repeated_side" && options != "--weld";
            let shown = text_words.contains(&format!("repair: {options}"));
            assert!(shown || !is_listed, "{command}: {inspected}");
            commands.push(words[1..].to_vec());
        }
        assert!(commands.len() >= 2, "{name}: {inspected}");
        for command in commands {
            let words: Vec<&str> = command.iter().map(String::as_str).collect();
            run_ok(&sixfold, &words);
            let output = words.last().expect("the output");
            assert_ne!(*output, name, "{words:?}");
            let after = run_ok(&sixfold, &["inspect", output]).stdout;
            if words.contains(&"--for") {
                assert!(!after.contains("refuse"), "{words:?}: {after}");
            }
        }
    }
}

#[test]
fn inspect_names_lines_bytes_and_unshared_vertices() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", &format!("f 1 1 2\n{BOOK}"));
    let run = run_ok(&sixfold, &["inspect", "book.obj"]);
    let fault = "1 edge with three or more faces: v0–v1 (line 7)";
    assert!(run.stdout.contains(fault), "{run:?}");
    run_ok(&sixfold, &["triangulate", "book.obj", "-o", "book.stl"]);
    let run = run_ok(&sixfold, &["inspect", "book.stl"]);
    let fault = "1 edge with three or more faces: v0–v1 (byte 84)";
    assert!(run.stdout.contains(fault), "{run:?}");
    sixfold.file("a.obj", TETRAHEDRON);
    run_ok(&sixfold, &["triangulate", "a.obj", "-o", "a.stl"]);
    let run = run_ok(&sixfold, &["inspect", "a.stl", "--as-stored"]);
    let unshared = "the faces do not share vertices (12 vertices at 4 positions)\n";
    assert!(run.stdout.contains(unshared), "{run:?}");
    // The vertices at other vertices are not listed again.
    assert!(!run.stdout.contains("at the position of"), "{run:?}");
    let command = "               sixfold repair a.stl --weld -o repaired.obj\n";
    assert!(run.stdout.ends_with(command), "{run:?}");
}

#[test]
fn inspect_takes_several_meshes_and_folders() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    std::fs::create_dir(sixfold.folder().join("scans")).expect("a folder");
    sixfold.file(
        "scans/quad.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let both = ["inspect", "book.obj", "scans", "--json", "all.json"];
    let run = run_ok(&sixfold, &both);
    assert!(run.stdout.contains("mesh         book.obj\n"), "{run:?}");
    assert!(
        run.stdout.contains("mesh         scans/quad.obj\n"),
        "{run:?}"
    );
    let json = |name: &str| -> Value { serde_json::from_str(&text(&sixfold, name)).expect("JSON") };
    let all = json("all.json");
    assert_eq!(all[1]["mesh"]["name"], "scans/quad.obj");
    let faults = all[0]["diagnosis"]["faults"].as_array().expect("faults");
    assert_eq!(faults[0]["kind"], "non_manifold_edge");
    let place = serde_json::json!({ "edge": [0, 1], "line": 6 });
    assert_eq!(faults[0]["places"][0], place);
    let command = "sixfold repair book.obj --cut -o repaired.obj";
    assert_eq!(faults[0]["repair"], command);
    assert_eq!(faults[0]["refused_by"][0], "winged-edge");

    let cut = ["inspect", "scans", "--triangulate", "--json", "one.json"];
    let run = run_ok(&sixfold, &cut);
    assert!(run.stdout.contains("2 faces"), "{run:?}");
    assert_eq!(json("one.json")["mesh"]["faces"], 2);

    sixfold.file("scans/broken.obj", "v 0 0 0\nf 1 2 3\n");
    let run = sixfold.run(&["inspect", "book.obj", "scans"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    let message = "error: scans/broken.obj:2: face names vertex 2";
    assert!(run.stderr.contains(message), "{run:?}");
    assert!(
        run.stderr
            .contains("error: 1 of 3 meshes could not be read"),
        "{run:?}"
    );
    assert!(
        run.stdout.contains("mesh         scans/quad.obj\n"),
        "{run:?}"
    );
}

#[test]
fn a_refusal_names_the_command_that_repairs() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    let command = ["smooth", "book.obj", "-o", "out.obj"];
    assert_refused(&sixfold, &command, 3, "`sixfold repair --for half-edge`");
}

#[test]
fn sharp_edges_and_vertices_are_carried_or_listed() {
    let sixfold = Sixfold::new();
    // The sharp edge 0–1 gets two copies, the edge 0–4 moves to a copy of vertex 0.
    let tags = "t crease 2/1/0 1 0 2.5\nt crease 2/1/0 0 4 1\nt corner 1/1/0 1 inf\n";
    sixfold.file("book.obj", &format!("{BOOK}{tags}"));
    let cut = ["repair", "book.obj", "--for", "half-edge", "-o", "cut.obj"];
    let run = run_ok(&sixfold, &cut);
    assert_eq!(run.stderr, "");
    let written = text(&sixfold, "cut.obj");
    let written: Vec<&str> = written
        .lines()
        .filter(|line| line.starts_with('t'))
        .collect();
    let count = |tag: &str| written.iter().filter(|line| line.ends_with(tag)).count();
    assert_eq!(
        [count(" 2.5"), count(" 1"), count(" inf")],
        [2, 1, 2],
        "{written:?}"
    );
    // The tags are read again: each names an edge of the mesh.
    run_ok(&sixfold, &["inspect", "cut.obj"]);

    let cut = ["repair", "book.obj", "--cut", "-o", "cut.ply"];
    let run = run_ok(&sixfold, &cut);
    let loss = "note: cut.ply: the sharpness of 5 edges and vertices is left out";
    assert!(run.stderr.contains(loss), "{run:?}");

    // Two components; the sharp edge of the smaller one is removed with it.
    let two = format!("{TETRAHEDRON}v 5 0 0\nv 6 0 0\nv 5 1 0\nf 5 6 7\n");
    sixfold.file(
        "two.obj",
        &format!("{two}t crease 2/1/0 4 5 3\nt crease 2/1/0 0 1 1\n"),
    );
    let one = ["repair", "two.obj", "--components", "3", "-o", "one.obj"];
    let run = run_ok(&sixfold, &one);
    let lost = "note: two.obj: 1 sharp edge or vertex is not in the repaired mesh\n";
    assert_eq!(run.stderr, lost);
    assert!(text(&sixfold, "one.obj").ends_with("t crease 2/1/0 0 1 1\n"));
}

#[test]
fn an_unwelded_mesh_is_welded_first() {
    let sixfold = Sixfold::new();
    // 24 vertices at the 8 corners of a cube.
    let corner = |i: usize| format!("v {} {} {}\n", i & 1, (i >> 1) & 1, i >> 2);
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let mut cube: String = faces.iter().flatten().map(|&i| corner(i)).collect();
    for f in 0..6 {
        cube += &format!(
            "f {} {} {} {}\n",
            4 * f + 1,
            4 * f + 2,
            4 * f + 3,
            4 * f + 4
        );
    }
    sixfold.file("cube.obj", &cube);
    let run = run_ok(&sixfold, &["inspect", "cube.obj", "--json", "cube.json"]);
    let weld = "sixfold repair cube.obj --weld -o repaired.obj";
    assert!(run.stdout.contains("24 vertices at 8 positions"), "{run:?}");
    assert_eq!(run.stdout.matches("sixfold repair").count(), 1, "{run:?}");
    assert!(run.stdout.contains(weld), "{run:?}");
    assert!(!run.stdout.contains("--fill-holes"), "{run:?}");
    let json: Value = serde_json::from_str(&text(&sixfold, "cube.json")).expect("JSON");
    let faults = json["diagnosis"]["faults"].as_array().expect("faults");
    assert!(
        faults.iter().all(|fault| fault["repair"] == weld),
        "{faults:?}"
    );
}

#[test]
fn faces_that_reading_leaves_out_are_counted() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", &format!("{BOOK}f 1 1 2\nf 3 4\n"));
    let run = run_ok(&sixfold, &["inspect", "a.obj", "--json", "a.json"]);
    let row = "2 degenerate faces of the file, left out: line 9: face 1 1 2 names vertex 1 twice";
    let words: Vec<&str> = run.stdout.split_whitespace().collect();
    assert!(words.join(" ").contains(row), "{run:?}");
    let json: Value = serde_json::from_str(&text(&sixfold, "a.json")).expect("JSON");
    let left_out = serde_json::json!({
        "count": 2,
        "places": [{ "vertices": [1, 1, 2], "line": 9 }, { "vertices": [3, 4], "line": 10 }],
        "repair": "sixfold repair a.obj --flat -o repaired.obj",
    });
    assert_eq!(json["diagnosis"]["left_out"], left_out);

    let cut = [
        "repair",
        "a.obj",
        "--for",
        "half-edge",
        "-o",
        "cut.obj",
        "--json",
        "r.json",
    ];
    let run = run_ok(&sixfold, &cut);
    assert!(
        run.stdout.contains("read the file: faces left out: 2\n"),
        "{run:?}"
    );
    let report: Value = serde_json::from_str(&text(&sixfold, "r.json")).expect("JSON");
    assert_eq!(
        report["before"],
        serde_json::json!({ "vertices": 5, "faces": 5 })
    );
    assert_eq!(
        report["reading"],
        serde_json::json!({ "vertices_joined": 0, "faces_left_out": 2 })
    );
    assert_eq!(
        report["after"],
        serde_json::json!({ "vertices": 7, "faces": 3 })
    );

    run_ok(&sixfold, &["triangulate", "a.obj", "-o", "a.stl"]);
    run_ok(
        &sixfold,
        &[
            "repair", "a.stl", "--cut", "-o", "cut.obj", "--json", "r.json",
        ],
    );
    let report: Value = serde_json::from_str(&text(&sixfold, "r.json")).expect("JSON");
    assert_eq!(
        report["before"],
        serde_json::json!({ "vertices": 9, "faces": 3 })
    );
    assert_eq!(report["reading"]["vertices_joined"], 4);
}

#[test]
fn an_stl_file_that_does_not_keep_the_cut_is_reported() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    for name in ["cut.stl", "ascii.stl"] {
        let mut cut = vec!["repair", "book.obj", "--for", "half-edge", "-o", name];
        if name == "ascii.stl" {
            cut.extend(["--format", "stl-ascii"]);
        }
        let run = sixfold.run(&cut);
        assert_eq!(run.code, Some(1), "{run:?}");
        let loss =
            format!("note: {name}: 2 vertices have positions of others, and readers join them");
        assert!(run.stderr.contains(&loss), "{run:?}");
        let warning = format!(
            "warning: {name}: readers of STL join vertices at equal positions, and half-edge refuses \
             the mesh that results: write PLY or OBJ, which keep the cut\n"
        );
        assert!(run.stderr.ends_with(&warning), "{run:?}");
    }
    run_ok(
        &sixfold,
        &["repair", "book.obj", "--for", "half-edge", "-o", "cut.ply"],
    );
    run_ok(&sixfold, &["smooth", "cut.ply", "-o", "smooth.ply"]);
    // Without a cut, STL keeps the mesh.
    sixfold.file("a.obj", TETRAHEDRON);
    let run = run_ok(
        &sixfold,
        &["repair", "a.obj", "--for", "half-edge", "-o", "a.stl"],
    );
    assert!(!run.stderr.contains("readers join them"), "{run:?}");
}

#[test]
fn data_that_repairs_lose_is_listed_once_for_each_kind() {
    let sixfold = Sixfold::new();
    let ply = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n\
               property float z\nproperty float nx\nproperty float ny\nproperty float nz\n\
               property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float s\n\
               property float t\nelement face 3\nproperty list uchar int vertex_indices\n\
               end_header\n0 0 0 0 0 1 1 2 3 0 0\n0 0 1 0 0 1 1 2 3 0 0\n1 0 0 0 0 1 1 2 3 0 0\n\
               0 1 0 0 0 1 1 2 3 0 0\n-1 0 0 0 0 1 1 2 3 0 0\n3 0 1 2\n3 1 0 3\n3 1 0 4\n";
    sixfold.file("a.ply", ply);
    let obj = BOOK.replace("\nf", "\nvt 0 0\nvn 0 0 1\nf");
    sixfold.file("a.obj", &obj.replace("v 0 0 0\n", "v 0 0 0 1 0 0\n"));
    let repairs: [&[&str]; 11] = [
        &["--weld"],
        &["--duplicates"],
        &["--opposite"],
        &["--flat"],
        &["--components=1"],
        &["--triangulate"],
        &["--orient=majority"],
        &["--cut"],
        &["--cut", "--fill-holes"],
        &["--isolated"],
        &["--for", "half-edge"],
    ];
    for repair in repairs {
        for (input, expected) in [
            (
                "a.ply",
                &[("normals", 5), ("colours", 5), ("texture coordinates", 5)][..],
            ),
            (
                "a.obj",
                &[
                    ("vertex weights or colours", 1),
                    ("texture coordinates", 3),
                    ("normals", 3),
                ],
            ),
        ] {
            let command = ["repair", input, "-o", "out.ply", "--json", "r.json"];
            let run = run_ok(&sixfold, &[&command, repair].concat());
            let report: Value = serde_json::from_str(&text(&sixfold, "r.json")).expect("JSON");
            let lost = report["lost"].as_array().expect("a list");
            assert_eq!(lost.len(), expected.len(), "{repair:?}: {lost:?}");
            for (what, count) in expected {
                let entry = serde_json::json!({ "what": what, "count": count });
                assert!(lost.contains(&entry), "{repair:?}: no {entry} in {lost:?}");
                let note = format!("note: {input}: ignored {count} ");
                assert!(run.stderr.contains(&note), "{repair:?}: {run:?}");
            }
            let notes = run.stderr.matches(": ignored ").count();
            assert_eq!(notes, expected.len(), "{repair:?}: {run:?}");
        }
    }
    run_ok(
        &sixfold,
        &[
            "repair", "a.ply", "--weld", "-o", "out.stl", "--json", "r.json",
        ],
    );
    let report: Value = serde_json::from_str(&text(&sixfold, "r.json")).expect("JSON");
    let lost = report["lost"].as_array().expect("a list");
    assert_eq!(lost.len(), 3, "STL keeps triangles: {report}");
}
