//! Tests of `sixfold render`.

use std::fs;

use crate::bad_input::assert_refused;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

/// Returns the width and height in the header of a PNG.
fn png_size(bytes: &[u8]) -> [u32; 2] {
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
    [number(16), number(20)]
}

fn read(sixfold: &Sixfold, name: &str) -> Vec<u8> {
    fs::read(sixfold.folder().join(name)).expect("the picture")
}

#[test]
fn pictures_have_the_given_size_and_are_reproducible() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", TETRAHEDRON);
    let run = sixfold.run(&["render", "a.obj", "-o", "a.png", "--edges"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(run.stdout, "a.png: 1 mesh, 4 faces, 480 × 480 pixels\n");
    let first = read(&sixfold, "a.png");
    assert_eq!(png_size(&first), [480, 480]);
    sixfold.run(&["render", "a.obj", "-o", "b.PNG", "--edges"]);
    assert_eq!(first, read(&sixfold, "b.PNG"));
    sixfold.run(&["render", "a.obj", "-o", "c.png"]);
    assert_ne!(first, read(&sixfold, "c.png"), "edges are visible");
    let row = [
        "render", "a.obj", "a.obj", "a.obj", "-o", "row.svg", "--size", "300x90",
    ];
    let run = sixfold.run(&row);
    assert_eq!(
        run.stdout, "row.svg: 3 meshes, 12 faces, 300 × 90 pixels\n",
        "{run:?}"
    );
    let svg = String::from_utf8(read(&sixfold, "row.svg")).expect("UTF-8");
    assert!(
        svg.starts_with("<svg ") && svg.ends_with("</svg>\n"),
        "{svg}"
    );
    assert!(svg.contains("width=\"300\" height=\"90\""), "{svg}");
    for left in [0, 100, 200] {
        assert!(svg.contains(&format!("translate({left})")), "{svg}");
    }
    let names = ["a.obj", "a.png", "b.PNG", "c.png", "row.svg"];
    assert_eq!(sixfold.names(), names, "no draft is left");
}

#[test]
fn creases_come_from_tags_and_from_files() {
    let sixfold = Sixfold::new();
    sixfold.file("plain.obj", TETRAHEDRON);
    sixfold.file(
        "tagged.obj",
        &format!("{TETRAHEDRON}t crease 2/1/0 1 2 3\n"),
    );
    sixfold.file("sharp.txt", "edge 2 1 3 # the same\n");
    let svg = |arguments: &[&str]| {
        let all = [&["render", "-o", "out.svg", "--view", "45,30"], arguments].concat();
        let run = sixfold.run(&all);
        assert_eq!(run.code, Some(0), "{run:?}");
        String::from_utf8(read(&sixfold, "out.svg")).expect("UTF-8")
    };
    let plain = svg(&["plain.obj"]);
    let tagged = svg(&["tagged.obj"]);
    assert_ne!(plain, tagged);
    assert_eq!(tagged, svg(&["plain.obj", "--creases", "sharp.txt"]));
    // The first crease file belongs to the first mesh.
    let of_first = svg(&["plain.obj", "plain.obj", "--creases", "sharp.txt"]);
    assert_eq!(of_first, svg(&["tagged.obj", "plain.obj"]));
    assert_ne!(of_first, svg(&["plain.obj", "tagged.obj"]));
}

#[test]
fn invalid_input_gives_one_error_and_no_picture() {
    let sixfold = Sixfold::new();
    sixfold.file("mesh.obj", TETRAHEDRON);
    sixfold.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    sixfold.file("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
    sixfold.file("bad.creases", "edge 0 1 1\n\nedge 0 9 1\n");
    sixfold.file(
        "tagged.obj",
        &format!("{TETRAHEDRON}t crease 2/1/0 1 9 3\n"),
    );
    for (arguments, message) in [
        (&["mesh.obj", "-o", "out.gif"][..], "OUT.png or OUT.svg"),
        (&["mesh.obj", "-o", "-"], "OUT.png or OUT.svg"),
        (&["mesh.obj"], "--output"),
        (&["-o", "out.png"], "MESH"),
        (
            &["points.obj", "-o", "out.png"],
            "points.obj: the mesh has no faces",
        ),
        (
            &["mesh.obj", "point.obj", "-o", "out.svg"],
            "point.obj: all faces lie in one point",
        ),
        (&["missing.obj", "-o", "out.png"], "missing.obj"),
        (&["mesh.obj", "-o", "no/such/out.png"], "out.png"),
        (&["mesh.obj", "-o", "out.png", "--size", "640"], "640x480"),
        (&["mesh.obj", "-o", "out.png", "--size", "0x0"], "too small"),
        (
            &["mesh.obj", "-o", "out.png", "--size", "100000x100000"],
            "too large",
        ),
        (&["mesh.obj", "-o", "out.png", "--view", "up"], "30,20"),
        (
            &["mesh.obj", "-o", "out.png", "--view", "0,91"],
            "from -90 to 90",
        ),
        (&["mesh.obj", "-o", "out.png", "--view", "nan,0"], "NaN"),
        (&["mesh.obj", "-o", "out.png", "--up", "x"], "y, z"),
        (
            &["mesh.obj", "-o", "out.png", "--shade", "phong"],
            "flat, smooth",
        ),
        (
            &["mesh.obj", "-o", "out.png", "--creases", "bad.creases"],
            "bad.creases:3",
        ),
        (
            &["mesh.obj", "-o", "out.png", "--creases", "missing"],
            "missing",
        ),
        (&["tagged.obj", "-o", "out.png"], "tagged.obj:9"),
        (
            &[
                "mesh.obj",
                "-o",
                "out.png",
                "--creases",
                "a",
                "--creases",
                "b",
            ],
            "2 crease files for 1 mesh",
        ),
    ] {
        assert_refused(&sixfold, &[&["render"], arguments].concat(), 2, message);
    }
    // A picture must not overwrite the mesh.
    sixfold.file("mesh.png", TETRAHEDRON);
    assert_refused(
        &sixfold,
        &["render", "mesh.png", "-o", "./mesh.png"],
        2,
        "would overwrite",
    );
}

#[test]
fn too_many_faces_for_an_svg_are_not_supported() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 180);
    let arguments = ["render", "grid.obj", "--view", "0,0", "-o", "out.svg"];
    let big = [&arguments[..], &["--size", "1200x1200"]].concat();
    assert_refused(&sixfold, &big, 3, "write a PNG");
}

#[test]
fn faults_are_painted_and_elements_named() {
    let sixfold = Sixfold::new();
    let book = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 2 1 4\nf 2 1 5\n";
    sixfold.file("book.obj", book);
    run_ok(&sixfold, &["render", "book.obj", "-o", "plain.svg"]);
    let command = [
        "render",
        "book.obj",
        "-o",
        "faults.svg",
        "--faults",
        "--labels",
    ];
    run_ok(&sixfold, &command);
    let [plain, faults] = ["plain.svg", "faults.svg"].map(|name| text(&sixfold, name));
    // Magenta is the colour of non-manifold edges.
    assert!(faults.contains("#da00") && !plain.contains("#da00"));
    assert!(faults.contains(">v2</text>") && !plain.contains("</text>"));
    sixfold.grid("grid.obj", 40);
    let command = ["render", "grid.obj", "-o", "grid.png", "--labels"];
    assert_refused(&sixfold, &command, 3, "labels are more than 2000");
}
