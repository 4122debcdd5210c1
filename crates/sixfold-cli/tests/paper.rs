//! Tests of `--figures`: the files for a paper, and which files of a folder are replaced and removed.

use std::fs;

use crate::bad_input::assert_refused;
use crate::run::{Sixfold, run_ok, text};

/// Writes results of `operations` to the file `name`.
fn study(sixfold: &Sixfold, operations: &str, name: &str) {
    let quick = ["study", "grid.obj", "--rounds", "2", "--json", name];
    let backends = ["--backends", "half-edge,corner-table"];
    run_ok(
        sixfold,
        &[&quick[..], &backends, &["--operations", operations]].concat(),
    );
}

fn grid() -> Sixfold {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    sixfold
}

fn exists(sixfold: &Sixfold, name: &str) -> bool {
    sixfold.folder().join(name).exists()
}

#[test]
fn a_study_writes_the_files_for_a_paper() {
    let sixfold = grid();
    sixfold.grid("copy.obj", 12);
    let quick = ["--rounds", "2", "--operations", "boundary"];
    let single = ["study", "grid.obj", "--figures", "one"];
    run_ok(&sixfold, &[&single[..], &quick].concat());
    let several = ["study", "grid.obj", "copy.obj", "--figures", "two"];
    let page = ["--report", "page"];
    run_ok(&sixfold, &[&several[..], &quick, &page].concat());
    for folder in ["one", "two"] {
        for name in [
            "heat-map.svg",
            "heat-map.pdf",
            "heat-map.csv",
            "rankings.txt",
            "results.tex",
            "results.md",
            "methods.md",
        ] {
            assert!(
                exists(&sixfold, &format!("{folder}/{name}")),
                "{folder}/{name}"
            );
        }
        let caption = text(&sixfold, &format!("{folder}/rankings.txt"));
        assert!(
            caption.contains("Command: sixfold study grid.obj"),
            "{caption}"
        );
        let methods = text(&sixfold, &format!("{folder}/methods.md"));
        assert!(
            methods.contains("without a time limit: 2 rounds."),
            "{methods}"
        );
    }
    // The files are those of `report` and `merge` from the same results.
    let csv = text(&sixfold, "two/heat-map.csv");
    run_ok(&sixfold, &["report", "page", "--figures", "again"]);
    run_ok(&sixfold, &["merge", "page", "--figures", "merged"]);
    for folder in ["again", "merged"] {
        assert_eq!(text(&sixfold, &format!("{folder}/heat-map.csv")), csv);
    }
    assert!(!exists(&sixfold, "again/report.html"));
    let narrow = ["report", "page", "--figures", "narrow", "--width", "85mm"];
    let run = run_ok(&sixfold, &narrow);
    // Six columns of numbers are not read in 85 mm, a ranking is.
    assert!(
        run.stderr.contains("note: heat-map is 168 mm wide"),
        "{run:?}"
    );
    let ranking = text(&sixfold, "narrow/rankings.svg");
    assert!(
        ranking.contains(" width=\"240.94pt\""),
        "{}",
        &ranking[..200]
    );
    assert!(!ranking.contains("prefers-color-scheme"));
}

#[test]
fn old_figures_are_removed_and_files_of_others_stay() {
    let sixfold = grid();
    study(&sixfold, "boundary,build,vertex_normal", "both.json");
    study(&sixfold, "boundary", "one.json");
    run_ok(&sixfold, &["report", "both.json", "--figures", "paper"]);
    sixfold.file("paper/notes.txt", "mine");
    sixfold.file("paper/ranking-mine.svg", "mine");
    // A name with a folder is not a file of `--figures`.
    let list = text(&sixfold, "paper/sixfold-files.txt");
    sixfold.file("paper/sixfold-files.txt", &format!("{list}../one.json\n"));
    run_ok(&sixfold, &["report", "one.json", "--figures", "paper"]);
    for ending in ["svg", "pdf", "csv", "txt"] {
        assert!(!exists(&sixfold, &format!("paper/break-even.{ending}")));
        assert!(exists(&sixfold, &format!("paper/rankings.{ending}")));
    }
    for name in ["paper/notes.txt", "paper/ranking-mine.svg"] {
        assert_eq!(text(&sixfold, name), "mine");
    }
    assert!(exists(&sixfold, "one.json"));
    let list = text(&sixfold, "paper/sixfold-files.txt");
    assert!(!list.contains("break-even") && list.contains("rankings.pdf\n"));
}

#[test]
fn figures_replace_no_file_of_others() {
    let sixfold = grid();
    study(&sixfold, "boundary,build,vertex_normal", "both.json");
    study(&sixfold, "boundary", "one.json");
    fs::create_dir(sixfold.folder().join("foreign")).expect("a folder");
    sixfold.file("foreign/heat-map.svg", "mine");
    let refused = |results: &str, folder: &str, message: &str| {
        let arguments = ["report", results, "--figures", folder];
        assert_refused(&sixfold, &arguments, 2, message);
    };
    refused("both.json", "foreign", "has files of others");
    refused("both.json", "grid.obj", "cannot be written");
    let study = ["study", "grid.obj", "--rounds", "2", "--figures", "foreign"];
    assert_refused(&sixfold, &study, 2, "has files of others");
    assert_eq!(text(&sixfold, "foreign/heat-map.svg"), "mine");

    run_ok(&sixfold, &["report", "one.json", "--figures", "paper"]);
    sixfold.file("paper/break-even.csv", "mine");
    refused("both.json", "paper", "break-even.csv exists already");
    assert_eq!(text(&sixfold, "paper/break-even.csv"), "mine");
    assert!(
        !exists(&sixfold, "paper/break-even.svg"),
        "nothing is written"
    );

    let arguments = ["study", "none.obj", "--figures", "new"];
    assert_refused(&sixfold, &arguments, 2, "none.obj");
    assert!(!exists(&sixfold, "new"), "an empty folder is removed");
}

#[test]
fn a_page_loses_the_figures_that_are_no_longer_drawn() {
    let sixfold = grid();
    study(&sixfold, "boundary,build,vertex_normal", "both.json");
    study(&sixfold, "boundary", "one.json");
    run_ok(&sixfold, &["report", "both.json", "--to", "page"]);
    assert!(exists(&sixfold, "page/figures/break-even.svg"));
    sixfold.file("page/figures/mine.svg", "mine");
    run_ok(&sixfold, &["report", "one.json", "--to", "page"]);
    assert!(!exists(&sixfold, "page/figures/break-even.svg"));
    assert!(exists(&sixfold, "page/figures/rankings.svg"));
    assert_eq!(text(&sixfold, "page/figures/mine.svg"), "mine");
}
