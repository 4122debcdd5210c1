//! Tests of completions and manual pages.

use crate::run::{Sixfold, run_ok};

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
