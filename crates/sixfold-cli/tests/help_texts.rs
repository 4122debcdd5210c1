//! Tests of completions and manual pages.

use crate::run::{Sixfold, run_ok};

#[test]
fn the_help_of_help_is_the_help() {
    let sixfold = Sixfold::new();
    let help = run_ok(&sixfold, &["--help"]).stdout;
    for arguments in [&["help", "--help"][..], &["help", "-h"], &["help"]] {
        let run = run_ok(&sixfold, arguments);
        assert!(run.stdout.contains("Choose a structure:"), "{run:?}");
        assert_eq!(run.stdout, help, "{arguments:?}");
    }
}

/// Text without a terminal is not wider than 80 columns.
#[test]
fn text_is_not_wider_than_80_columns() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    run_ok(&sixfold, &["generate", "geodesic", "-o", "ball.obj"]);
    let study_of = |document: &str| {
        let study = ["study", "ball.obj", "--rounds", "2", "--json", document];
        run_ok(&sixfold, &study);
    };
    ["a.json", "b.json"].into_iter().for_each(study_of);
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    sixfold.file("a book with a long name.obj", book);
    let budget = ["--rounds", "2"];
    let study = ["study", "grid.obj"];
    let growth = ["growth", "--to", "2000", "--steps", "2"];
    let pick = ["pick", "grid.obj", "grid.obj"];
    let checkout = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let mut commands = vec![
        [&study[..], &budget].concat(),
        [&growth[..], &budget].concat(),
        [&pick[..], &budget].concat(),
        [&["orders", "grid.obj"][..], &budget].concat(),
        [
            &["study", "grid.obj", "a book with a long name.obj"][..],
            &budget,
        ]
        .concat(),
        vec!["inspect", "a book with a long name.obj"],
        vec!["memory", "grid.obj"],
        vec!["why", "grid.obj", "--counts-only"],
        vec!["schemes"],
        vec!["edits"],
        vec!["workloads"],
        vec!["operations"],
        vec!["--help"],
        vec!["help"],
        vec!["remesh", "ball.obj", "-o", "out.obj"],
        vec!["decimate", "ball.obj", "--ratio", "0.5", "-o", "out.obj"],
        vec!["smooth", "ball.obj", "-o", "out.obj"],
        vec!["dual", "ball.obj", "-o", "out.obj"],
        vec!["triangulate", "ball.obj", "-o", "out.obj"],
        vec!["subdivide", "ball.obj", "--levels", "2", "-o", "out.obj"],
        vec![
            "repair",
            "grid.obj",
            "--weld",
            "--fill-holes",
            "--orient=outward",
            "-o",
            "out.obj",
        ],
        vec!["convert", "ball.obj", "-o", "out.stl"],
        vec!["render", "ball.obj", "-o", "out.svg"],
        vec!["distance", "ball.obj", "grid.obj"],
        vec!["neighbours", "ball.obj", "--rounds", "2"],
        vec!["compare", "a.json", "b.json", "--all"],
        vec!["history", "a.json", "b.json", "--all"],
        vec!["merge", "a.json", "--report", "merged"],
        vec!["report", "a.json", "--to", "drawn"],
        vec!["tables"],
        vec![
            "trace",
            "vertex_faces",
            "v3",
            "--backend",
            "half-edge,face-vertex",
        ],
        vec!["trace", "--edit", "poke_face f0"],
        vec!["lessons"],
        vec!["lessons", "flip"],
        vec!["new", "package", "--checkout", checkout],
    ];
    let all = [
        "study",
        "pick",
        "workloads",
        "operations",
        "new",
        "why",
        "tables",
        "trace",
        "lessons",
        "explore",
        "orders",
        "growth",
        "merge",
        "report",
        "compare",
        "history",
        "inspect",
        "convert",
        "distance",
        "neighbours",
        "memory",
        "generate",
        "schemes",
        "subdivide",
        "smooth",
        "dual",
        "triangulate",
        "edits",
        "decimate",
        "remesh",
        "repair",
        "render",
        "completions",
        "manual",
    ];
    commands.extend(all.iter().map(|&command| vec![command, "--help"]));
    let mut wide = Vec::new();
    for arguments in commands {
        let run = run_ok(&sixfold, &arguments);
        wide.extend(wide_lines(&run.stdout).map(|line| format!("{arguments:?}: {line}")));
    }
    let programs = sixfold.run_programs(&["--help"]);
    assert_eq!(programs.code, Some(0), "{programs:?}");
    wide.extend(wide_lines(&programs.stdout).map(|line| format!("programs --help: {line}")));
    assert!(
        wide.is_empty(),
        "wider than 80 columns:\n{}",
        wide.join("\n")
    );
}

fn wide_lines(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| line.chars().count() > 80)
}

#[test]
fn completions_of_each_shell_name_the_commands() {
    let sixfold = Sixfold::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = run_ok(&sixfold, &["completions", shell]).stdout;
        for word in ["subdivide", "budget"] {
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
    let run = sixfold.run(&["completions", "cmd"]);
    assert_eq!(run.code, Some(2), "{run:?}");
}

#[test]
fn the_manual_has_a_page_for_each_command() {
    let sixfold = Sixfold::new();
    let page = run_ok(&sixfold, &["manual"]).stdout;
    assert!(page.contains(".TH sixfold 1"), "{page:.200}");
    assert_eq!(run_ok(&sixfold, &["manual", "--to", "man"]).stdout, "");
    for name in ["sixfold", "sixfold-pick", "sixfold-study", "sixfold-render"] {
        let file = sixfold.folder().join("man").join(format!("{name}.1"));
        let page = std::fs::read_to_string(&file).expect(name);
        assert!(page.contains("SYNOPSIS"), "{name}");
    }
    sixfold.file("taken", "");
    let run = sixfold.run(&["manual", "--to", "taken/man"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(run.stderr.contains("taken/man"), "{run:?}");
}
