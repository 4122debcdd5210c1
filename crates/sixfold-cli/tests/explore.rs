//! `sixfold explore`. `tests/browser/check_explorer.py` tests the page itself.

use std::fs;

use serde_json::Value;

use crate::run::{Sixfold, TETRAHEDRON, run_ok};

/// Returns the data of a page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"data\">").expect("data");
    let (data, _) = rest.split_once("</script>").expect("an end");
    serde_json::from_str(data).expect("JSON")
}

#[test]
fn a_page_has_the_mesh_and_is_written_where_it_should_be() {
    let sixfold = Sixfold::new();
    sixfold.file("four.obj", TETRAHEDRON);
    let explore = [
        "explore",
        "four.obj",
        "-o",
        "four.html",
        "--no-open",
        "--lesson",
        "flip",
    ];
    let run = run_ok(&sixfold, &explore);
    assert_eq!(run.stdout, "four.html\n");
    let page = fs::read_to_string(sixfold.folder().join("four.html")).expect("a page");
    let situation = &data(&page)["situation"];
    assert_eq!(situation["subject"]["mesh"]["file"]["text"], TETRAHEDRON);
    assert_eq!(
        (&situation["name"], &situation["view"]["lesson"]),
        (&"four.obj".into(), &"flip".into())
    );
    assert_eq!(data(&page)["lessons"].as_array().map(Vec::len), Some(21));

    // Without -o, the page is a temporary file that stays.
    let run = run_ok(&sixfold, &["explore", "--no-open"]);
    let path = run.stdout.trim();
    let page = fs::read_to_string(path).expect("a page");
    assert_eq!(data(&page)["situation"]["name"], "octahedron");
    fs::remove_file(path).expect("a temporary file");
}

#[test]
fn a_mesh_that_the_page_would_refuse_is_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("bad.obj", "v 0 0 0\nf 1 2 3\n");
    sixfold.file(
        "markup.obj",
        "# </script><b>\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    );
    run_ok(
        &sixfold,
        &["generate", "torus", "m=400", "n=300", "-o", "large.obj"],
    );
    for (arguments, code, message) in [
        (&["bad.obj"][..], 2, "bad.obj:2"),
        (&["missing.obj"], 2, "missing.obj"),
        (&["."], 2, "cannot read ."),
        (&["large.obj"], 2, "sixfold decimate"),
        (&["--lesson", "flap"], 2, "flip"),
        (&["-o", "missing/page.html"], 2, "missing/page.html"),
        (&["markup.obj", "-o", "markup.obj"], 2, "would overwrite"),
    ] {
        let run = sixfold.run(&[&["explore", "--no-open"][..], arguments].concat());
        assert_eq!(run.code, Some(code), "{arguments:?}: {run:?}");
        assert!(run.stderr.contains(message), "{arguments:?}: {run:?}");
        assert!(run.stdout.is_empty(), "{arguments:?}: {run:?}");
    }
    // Text of a file does not end the element that holds it.
    run_ok(
        &sixfold,
        &["explore", "markup.obj", "-o", "page.html", "--no-open"],
    );
    let page = fs::read_to_string(sixfold.folder().join("page.html")).expect("a page");
    assert!(!page.contains("</script><b>"));
    let text = data(&page)["situation"]["subject"]["mesh"]["file"]["text"].clone();
    assert!(
        text.as_str()
            .is_some_and(|text| text.starts_with("# </script><b>")),
        "{text}"
    );
}
