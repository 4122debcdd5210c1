//! Tests of `sixfold subdivide`, `smooth`, `dual` and `triangulate`.

use crate::bad_input::assert_refused;
use crate::obj::Obj;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
const TRIANGLES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const BOOK: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";

/// Runs `sixfold subdivide` with `arguments` and returns the written mesh.
fn subdivided(sixfold: &Sixfold, arguments: &[&str]) -> Obj {
    run_ok(
        sixfold,
        &[&["subdivide", "-o", "out.obj"], arguments].concat(),
    );
    Obj::parse(&text(sixfold, "out.obj"))
}

#[test]
fn results_have_the_size_of_the_closed_forms() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    // The input has 4 vertices, 6 edges, 4 faces and 12 corners.
    for (scheme, levels, counts) in [
        ("catmull-clark", "1", [14, 12]),
        ("catmull-clark", "2", [50, 48]),
        ("bilinear", "1", [14, 12]),
        ("loop", "1", [10, 16]),
        ("loop", "2", [34, 64]),
        ("midpoint", "1", [10, 16]),
        ("butterfly", "1", [10, 16]),
        ("sqrt3", "1", [8, 12]),
        ("sqrt3", "2", [20, 36]),
        ("doo-sabin", "1", [12, 14]),
        ("doo-sabin", "2", [48, 50]),
    ] {
        let obj = subdivided(&sixfold, &["--scheme", scheme, "--levels", levels, "t.obj"]);
        assert_eq!(obj.counts(), counts, "{scheme}, level {levels}");
        assert_eq!(obj.boundary_edges(), 0, "{scheme}, level {levels}");
    }
    let run = run_ok(
        &sixfold,
        &["subdivide", "--levels", "2", "t.obj", "-o", "out.obj"],
    );
    assert!(
        run.stdout.contains("result: 50 vertices, 48 faces"),
        "{run:?}"
    );
    assert_eq!(run.stderr, "", "progress is for terminals");
    let obj = subdivided(&sixfold, &["--levels", "0", "t.obj"]);
    assert_eq!(obj.positions, Obj::parse(TETRAHEDRON).positions);
    assert_eq!(obj.faces, Obj::parse(TETRAHEDRON).faces);
}

#[test]
fn creases_of_files_and_tags_stay_sharp() {
    let sixfold = Sixfold::new();
    sixfold.file("plain.obj", TETRAHEDRON);
    let tags = "t crease 2/1/0 0 1 inf\nt corner 1/1/0 0 inf\n";
    sixfold.file("tagged.obj", &format!("{TETRAHEDRON}{tags}"));
    sixfold.file("sharp.txt", "# both\r\nedge 1 0 inf\r\ncorner 0 inf\r\n");
    let [plain, tagged] = ["plain.obj", "tagged.obj"].map(|file| subdivided(&sixfold, &[file]));
    let with_file = [
        "--creases",
        "sharp.txt",
        "--creases-left",
        "left.txt",
        "plain.obj",
    ];
    let sharp = subdivided(&sixfold, &with_file);
    let old = Obj::parse(TETRAHEDRON).positions;
    assert_ne!(plain.positions[0], old[0], "a smooth vertex moves");
    assert_eq!(sharp.positions[0], old[0], "a corner stays");
    let middle = [0, 1, 2].map(|i| (old[0][i] + old[1][i]) / 2.0);
    assert!(sharp.positions.contains(&middle), "a crease is halved");
    assert!(!plain.positions.contains(&middle));
    assert_eq!(sharp.positions, tagged.positions);
    let left = text(&sixfold, "left.txt");
    assert_eq!(
        left.matches("inf\n").count(),
        3,
        "two halves and a corner: {left}"
    );
}

/// A cube whose upper face has vertices of its own, and a line that no face can have before it.
const SEAMED: &str = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n\
    v 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n\
    f 1 1 2\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 9 10 11 12\n";

/// Lists of the user have the numbers of the file, also if vertices are joined, or faces left out or cut.
#[test]
fn lists_name_the_elements_of_the_file() {
    let sixfold = Sixfold::new();
    sixfold.file("seamed.obj", SEAMED);
    // Joined first: without the repeated vertices and the degenerate face.
    run_ok(
        &sixfold,
        &["repair", "seamed.obj", "--weld", "-o", "joined.obj"],
    );
    assert_eq!(Obj::parse(&text(&sixfold, "joined.obj")).positions.len(), 8);
    // The same edge by the copies of its ends, and without them.
    sixfold.file("own.txt", "edge 8 9 inf\ncorner 11 inf\n");
    sixfold.file("below.txt", "edge 4 5 inf\ncorner 7 inf\n");
    let refined = |creases, mesh| subdivided(&sixfold, &["--creases", creases, mesh]).positions;
    let expected = refined("below.txt", "joined.obj");
    assert_eq!(refined("own.txt", "seamed.obj"), expected);
    assert_eq!(refined("below.txt", "seamed.obj"), expected);
    let other = subdivided(&sixfold, &["joined.obj"]).positions;
    assert_ne!(other, expected);

    // Face 6 of the file, which names vertices 8 to 11, is cut into two triangles; face 0 is left out.
    sixfold.file("faces.txt", "\u{feff}6 # the upper one\n0\n");
    sixfold.file("joined.txt", "5\n");
    let refine = |faces: &str, mesh| {
        let select = format!("faces:{faces}");
        let part = ["--scheme", "midpoint", "--triangulate", "--select"];
        let rest = [select.as_str(), mesh, "-o", "part.obj"];
        let run = run_ok(&sixfold, &[&["subdivide"], &part[..], &rest[..]].concat());
        (run.stderr, Obj::parse(&text(&sixfold, "part.obj")))
    };
    let (notes, part) = refine("faces.txt", "seamed.obj");
    let note =
        "faces.txt: 1 face is not selected, because it was left out of the mesh: line 2: face 0";
    assert!(notes.contains(note), "{notes}");
    assert_eq!(
        part.positions,
        refine("joined.txt", "joined.obj").1.positions
    );
    assert!(
        part.positions.contains(&[1.0, 0.0, 2.0]),
        "the upper face is refined"
    );
    assert!(!part.positions.contains(&[1.0, 0.0, 0.0]));
    sixfold.file("faces.txt", "7\n");
    let arguments = [
        "subdivide",
        "--scheme",
        "midpoint",
        "--triangulate",
        "--select",
    ];
    let rest = ["faces:faces.txt", "seamed.obj", "-o", "part.obj"];
    let message = "faces.txt:1: face 7 does not exist: the file has 7 faces";
    assert_refused(&sixfold, &[&arguments[..], &rest].concat(), 2, message);
}

/// Faces that share a line of the file are different faces.
#[test]
fn faces_on_one_line_have_numbers_of_their_own() {
    let sixfold = Sixfold::new();
    let facet = |x: u32| {
        let next = x + 1;
        format!(
            "facet normal 0 0 1 outer loop vertex {x} 0 0 vertex {next} 0 0 vertex {x} 1 0 endloop endfacet "
        )
    };
    let facets: Vec<String> = (0..4).map(|i| facet(3 * i)).collect();
    sixfold.file("line.stl", &format!("solid {}endsolid", facets.concat()));
    sixfold.file("third.txt", "2\n");
    let arguments = [
        "--scheme",
        "midpoint",
        "--select",
        "faces:third.txt",
        "line.stl",
    ];
    let part = subdivided(&sixfold, &arguments);
    assert_eq!(part.counts(), [12 + 3, 3 + 4]);
    assert!(part.positions.contains(&[6.5, 0.0, 0.0]));
}

/// Commands that keep the edges keep their sharpness.
#[test]
fn creases_are_kept_where_edges_are() {
    let sixfold = Sixfold::new();
    let tags = "t crease 2/1/0 8 9 2.5\nt corner 1/1/0 11 inf\n";
    sixfold.file("seamed.obj", &format!("{SEAMED}{tags}"));
    let lines = |command: &[&str]| {
        let run = run_ok(
            &sixfold,
            &[command, &["seamed.obj", "-o", "out.obj"]].concat(),
        );
        let out = text(&sixfold, "out.obj");
        let tags = out.lines().filter(|line| line.starts_with("t "));
        (run.stderr, tags.map(str::to_owned).collect::<Vec<_>>())
    };
    let as_stored = ["t crease 2/1/0 8 9 2.5", "t corner 1/1/0 11 inf"];
    assert_eq!(lines(&["triangulate"]).1, as_stored);
    assert_eq!(lines(&["triangulate", "--orient", "outward"]).1, as_stored);
    assert_eq!(lines(&["smooth", "--as-stored"]).1, as_stored);
    assert_eq!(
        lines(&["smooth"]).1,
        ["t crease 2/1/0 4 5 2.5", "t corner 1/1/0 7 inf"]
    );
    for command in [
        &["dual"][..],
        &["decimate", "--triangulate", "--ratio", "0.9"],
    ] {
        let (notes, tags) = lines(command);
        assert!(notes.contains("does not keep sharp edges"), "{notes}");
        assert_eq!(tags, [""; 0]);
    }
}

#[test]
fn limits_lie_on_the_surface() {
    let sixfold = Sixfold::new();
    sixfold.file("square.obj", SQUARE);
    // Later levels are closer to the boundary curve of the square.
    let arguments = [
        "--levels",
        "2",
        "--boundary",
        "edge-only",
        "--limit",
        "limit.obj",
        "square.obj",
    ];
    let level = subdivided(&sixfold, &arguments);
    let limit_text = text(&sixfold, "limit.obj");
    let limit = Obj::parse(&limit_text);
    assert_eq!(limit.faces, level.faces);
    assert!(
        limit_text.lines().any(|line| line == "vn 0 0 1"),
        "{limit_text}"
    );
    let far = subdivided(
        &sixfold,
        &["--levels", "6", "--boundary", "edge-only", "square.obj"],
    );
    for (v, limit) in limit.positions.iter().enumerate() {
        // Old vertices come first at every level.
        let distance = |p: [f32; 3]| (0..3).map(|i| (p[i] - limit[i]).abs()).fold(0.0, f32::max);
        assert!(distance(far.positions[v]) < 1e-3, "v{v}");
    }
    assert_ne!(limit.positions, level.positions);
    let run = run_ok(
        &sixfold,
        &["subdivide", "square.obj", "-o", "a.obj", "--limit", "-"],
    );
    assert!(
        run.stdout
            .lines()
            .all(|line| line.starts_with(['#', 'v', 'f'])),
        "{run:?}"
    );
}

#[test]
fn a_part_of_a_mesh_is_refined_without_gaps() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    sixfold.file("first.txt", "0 # the first\n");
    // One face is cut into four faces. Each of its three neighbours is cut into two faces.
    let part = ["--scheme", "midpoint", "--select", "faces:first.txt"];
    let one = subdivided(&sixfold, &[&part[..], &["t.obj"]].concat());
    assert_eq!(one.counts(), [4 + 3, 4 + 3 * 2]);
    let deep = subdivided(&sixfold, &[&part[..], &["--levels", "3", "t.obj"]].concat());
    for obj in [one, deep] {
        assert_eq!(obj.boundary_edges(), 0, "a T-junction is a gap");
        // The surface is closed and has genus 0.
        assert_eq!(obj.faces.len(), 2 * obj.positions.len() - 4);
    }
    sixfold.file(
        "tagged.obj",
        &format!("{TETRAHEDRON}t crease 2/1/0 0 1 2\n"),
    );
    sixfold.file("wrong.txt", "0\n4\n");
    sixfold.file("words.txt", "0\nall\n");
    let select = |what| {
        [
            "subdivide",
            "--scheme",
            "midpoint",
            "-o",
            "x.obj",
            "t.obj",
            "--select",
            what,
        ]
    };
    for (what, message) in [
        ("faces:wrong.txt", "wrong.txt:2: face 4 does not exist"),
        ("faces:words.txt", "words.txt:2"),
        ("faces:missing.txt", "missing.txt"),
        ("box:1,0,0,0,1,1", "lower corner of the box first"),
        ("box:0,0,0,nan,1,1", "finite"),
        ("angle:181", "0 to 180"),
        ("all", "box:X0"),
    ] {
        assert_refused(&sixfold, &select(what), 2, message);
    }
    let mut arguments = select("faces:first.txt");
    arguments[4] = "first.txt";
    assert_refused(&sixfold, &arguments, 2, "would overwrite the list of faces");
    arguments = select("angle:1");
    arguments[5] = "tagged.obj";
    assert_refused(
        &sixfold,
        &arguments,
        3,
        "tagged.obj: the file has sharp edges",
    );
    arguments = select("angle:1");
    arguments[2] = "loop";
    assert_refused(&sixfold, &arguments, 3, "--scheme midpoint");
}

#[test]
fn threads_and_standard_output_change_nothing() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let arguments = ["subdivide", "--scheme", "loop", "--levels", "2", "grid.obj"];
    let run = |more: &[&str]| run_ok(&sixfold, &[&arguments[..], more].concat());
    run(&["--threads", "1", "-o", "one.obj"]);
    run(&["--threads", "2", "-o", "two.obj"]);
    let one = text(&sixfold, "one.obj");
    assert_eq!(one, text(&sixfold, "two.obj"));
    let shown = run(&["-o", "-"]);
    assert_eq!(shown.stdout, one);
    assert_eq!(shown.stderr, "");
}

#[test]
fn invalid_input_is_refused_before_anything_is_written() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    sixfold.file("square.obj", SQUARE);
    sixfold.file(
        "tagged.obj",
        &format!("{TETRAHEDRON}t crease 2/1/0 0 1 2\n"),
    );
    for (file, line, message) in [
        ("missing", "edge 0 9 1", "vertex 9 does not exist"),
        ("negative", "edge 0 1 -1", "from 0 to inf"),
        ("nan", "corner 0 nan", "from 0 to inf"),
        ("short", "edge 0 1", "edge a b sharpness"),
        ("word", "crease 0 1 2", "is not an entry"),
    ] {
        sixfold.file(file, &format!("# creases\n{line}\n"));
        let run = assert_refused(
            &sixfold,
            &["subdivide", "t.obj", "-o", "x.obj", "--creases", file],
            2,
            &format!("{file}:2: "),
        );
        assert!(run.stderr.contains(message), "{run:?}");
    }
    sixfold.file("diagonal", "edge 0 2 1\n");
    for (arguments, code, message) in [
        (
            &["square.obj", "--creases", "diagonal"][..],
            2,
            "diagonal:1: v0 and v2",
        ),
        (&["t.obj", "--creases", "missing"], 2, "missing"),
        (
            &["t.obj", "--creases", "x.obj"],
            2,
            "would overwrite the crease file",
        ),
        (&["t.obj", "--limit", "x.obj"], 2, "two different files"),
        (&["t.obj", "--levels", "40"], 3, "take fewer levels"),
        (&["t.obj", "--levels", "-1"], 2, "from 0 to 1000"),
        (&["t.obj", "--levels", "4000000000"], 2, "from 0 to 1000"),
        (&["t.obj", "--threads", "5000"], 2, "0 to 1024"),
        (
            &["t.obj", "--threads", "2", "--method", "gather"],
            3,
            "one thread",
        ),
        (&["t.obj", "--scheme", "cube"], 2, "doo-sabin"),
        (&["t.obj", "--boundary", "open"], 2, "edge-only"),
        (
            &["t.obj", "--scheme", "sqrt3", "--boundary", "none"],
            3,
            "--boundary",
        ),
        (
            &["t.obj", "--scheme", "sqrt3", "--limit", "y.obj"],
            3,
            "--limit",
        ),
        (&["t.obj", "--loop-weights", "warren"], 3, "choose loop"),
        (
            &["t.obj", "--boundary", "none", "--limit", "y.obj"],
            3,
            "remove one",
        ),
        (
            &["t.obj", "--method", "native", "--backend", "polygon-soup"],
            3,
            "gather or scatter",
        ),
        (
            &["t.obj", "--levels", "2", "--backend", "corner-table"],
            3,
            "another backend",
        ),
        (
            &["tagged.obj", "--scheme", "butterfly"],
            3,
            "tagged.obj: the file has sharp edges",
        ),
        (&["missing.obj"], 2, "missing.obj"),
    ] {
        assert_refused(
            &sixfold,
            &[&["subdivide", "-o", "x.obj"], arguments].concat(),
            code,
            message,
        );
    }
    assert_refused(
        &sixfold,
        &["subdivide", "t.obj", "-o", "./t.obj"],
        2,
        "would overwrite the mesh",
    );
}

#[test]
fn a_mesh_that_the_structure_or_the_scheme_does_not_support_is_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    sixfold.file("square.obj", SQUARE);
    sixfold.file(
        "huge.obj",
        "v 3e38 0 0\nv 3e38 3e38 0\nv 3e38 3e38 3e38\nf 1 2 3\n",
    );
    for (arguments, code, message) in [
        (
            &["book.obj"][..],
            3,
            "half-edge cannot hold level 0: edge v0–v1 has 3 faces",
        ),
        (&["book.obj"], 3, "another --backend"),
        (
            &[
                "book.obj",
                "--scheme",
                "doo-sabin",
                "--backend",
                "face-vertex",
            ],
            3,
            "v0–v1",
        ),
        (
            &["square.obj", "--scheme", "loop"],
            3,
            "face f0 has 4 corners",
        ),
        (
            &[
                "square.obj",
                "--scheme",
                "loop",
                "--levels",
                "0",
                "--limit",
                "y.obj",
            ],
            3,
            "face f0",
        ),
        (&["huge.obj"], 2, "scale the mesh down"),
    ] {
        // The expected size may be printed before the refusal.
        let run = sixfold.run(&[&["subdivide", "-o", "x.obj"], arguments].concat());
        assert_eq!(run.code, Some(code), "{arguments:?}: {run:?}");
        assert_eq!(run.stderr.lines().count(), 1, "{run:?}");
        assert!(run.stderr.contains(message), "{arguments:?}: {run:?}");
        assert_eq!(sixfold.names(), ["book.obj", "huge.obj", "square.obj"]);
    }
    // A face-vertex mesh holds the book. The edge with three faces is treated as a crease.
    let obj = subdivided(&sixfold, &["--backend", "face-vertex", "book.obj"]);
    assert_eq!(obj.counts(), [5 + 7 + 3, 9]);
    assert!(obj.positions.contains(&[0.5, 0.0, 0.0]));
}

#[test]
fn boundary_none_leaves_out_the_faces_at_the_boundary() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 5);
    let loops = ["--scheme", "loop", "grid.obj", "--boundary"];
    let kept = subdivided(&sixfold, &[&loops[..], &["edge-only"]].concat());
    let fewer = subdivided(&sixfold, &[&loops[..], &["none"]].concat());
    // Of the 32 triangles, 8 have no corner on the boundary.
    assert_eq!(kept.faces.len(), 32 * 4);
    assert_eq!(fewer.faces.len(), 8 * 4);
}

#[test]
fn smooth_dual_and_triangulate_write_meshes_or_refuse() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    sixfold.file("square.obj", SQUARE);
    sixfold.file("triangles.obj", TRIANGLES);
    sixfold.file("book.obj", BOOK);
    sixfold.file("tagged.obj", &format!("{SQUARE}t crease 2/1/0 0 1 2\n"));
    for (arguments, counts) in [
        (&["smooth", "t.obj", "--weights", "cotangent"][..], [4, 4]),
        (&["smooth", "book.obj", "--backend", "face-vertex"], [5, 3]),
        (&["dual", "t.obj"], [4, 4]),
        (&["triangulate", "square.obj"], [4, 2]),
        (
            &["triangulate", "triangles.obj", "--orient", "majority"],
            [4, 2],
        ),
    ] {
        let run = run_ok(&sixfold, &[arguments, &["-o", "out.obj"]].concat());
        // Ten iterations shrink a tetrahedron to a point, and the command says so.
        let shrinks = arguments.contains(&"cotangent");
        let warning = "warning: out.obj: the shape has changed: the area is ";
        assert_eq!(run.stderr.starts_with(warning), shrinks, "{run:?}");
        assert!(shrinks || run.stderr.is_empty(), "{run:?}");
        assert_eq!(
            Obj::parse(&text(&sixfold, "out.obj")).counts(),
            counts,
            "{arguments:?}"
        );
    }
    let run = run_ok(&sixfold, &["triangulate", "tagged.obj", "-o", "-"]);
    assert_eq!(Obj::parse(&run.stdout).counts(), [4, 2]);
    assert!(run.stdout.ends_with("\nt crease 2/1/0 0 1 2\n"), "{run:?}");
    assert_eq!(run.stderr, "");
    for (arguments, code, message) in [
        (&["smooth", "book.obj"][..], 3, "another --backend"),
        (
            &["smooth", "square.obj", "--weights", "cotangent"],
            3,
            "triangulate the mesh",
        ),
        (&["smooth", "t.obj", "--step", "2"], 2, "between 0 and 1"),
        (&["smooth", "t.obj", "--step-back", "nan"], 2, "NaN"),
        (&["smooth", "t.obj", "--iterations", "-1"], 2, "from 0 to"),
        (&["dual", "square.obj"], 3, "only a closed mesh has a dual"),
        (&["dual", "missing.obj"], 2, "missing.obj"),
        (&["triangulate", "t.obj", "--orient", "in"], 2, "outward"),
    ] {
        assert_refused(
            &sixfold,
            &[arguments, &["-o", "x.obj"]].concat(),
            code,
            message,
        );
    }
    assert_refused(
        &sixfold,
        &["dual", "t.obj", "-o", "t.obj"],
        2,
        "would overwrite",
    );
}

#[test]
fn doo_sabin_says_which_vertices_it_leaves_out() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", &format!("{TETRAHEDRON}v 5 5 5\nv 6 6 6\n"));
    for (scheme, note) in [
        (
            "doo-sabin",
            "note: t.obj: 2 vertices without faces are left out\n",
        ),
        ("catmull-clark", ""),
    ] {
        let arguments = ["subdivide", "--scheme", scheme, "t.obj", "-o", "out.obj"];
        assert_eq!(run_ok(&sixfold, &arguments).stderr, note);
    }
}
