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

/// Text fits into a narrow terminal.
#[test]
fn text_is_not_wider_than_the_terminal() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    sixfold.file("a book with a long name.obj", book);
    let budget = ["--rounds", "2"];
    let study = ["study", "grid.obj"];
    let growth = ["growth", "--to", "2000", "--steps", "2"];
    let pick = ["pick", "grid.obj", "grid.obj"];
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
        let mut command = sixfold.command(&arguments);
        let output = command.env("COLUMNS", "80").output().expect("it runs");
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        let lines = text.lines().filter(|line| line.chars().count() > 80);
        wide.extend(lines.map(|line| format!("{arguments:?}: {line}")));
    }
    assert!(
        wide.is_empty(),
        "wider than 80 columns:\n{}",
        wide.join("\n")
    );
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
