//! The option `--confidence`: documents keep it, and all intervals and texts have it.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::run::{Run, Sixfold, run_ok, text};

const STUDY: [&str; 8] = [
    "study",
    "grid.obj",
    "--backends",
    "half-edge,corner-table",
    "--operations",
    "vertex_vertices,boundary",
    "--rounds",
    "4",
];

fn grid() -> Sixfold {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    sixfold
}

fn study(sixfold: &Sixfold, more: &[&str]) -> Run {
    run_ok(sixfold, &[&STUDY[..], more].concat())
}

fn json(sixfold: &Sixfold, name: &str) -> Value {
    serde_json::from_str(&text(sixfold, name)).expect("JSON")
}

/// Writes the document `from` as if its intervals had the confidence 0.99.
fn with_99(sixfold: &Sixfold, from: &str, to: &str) {
    let mut document = json(sixfold, from);
    document["runs"][0]["settings"]["confidence"] = 0.99.into();
    sixfold.file(to, &document.to_string());
}

/// Asserts that a text names the confidence 99 %, and no other one.
fn assert_says_99(text: &str) {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("99 %"), "{text}");
    for other in ["95 % interval", "95 % confidence", "| 95 % |", ">95 %<"] {
        assert!(!text.contains(other), "{other} in {text}");
    }
}

#[test]
fn texts_pages_and_documents_have_the_confidence() {
    let sixfold = grid();
    let ordinary = study(&sixfold, &["--json", "a.json"]);
    assert!(ordinary.stdout.contains("95 % interval"), "{ordinary:?}");
    let left_out = &json(&sixfold, "a.json")["runs"][0]["settings"]["confidence"];
    assert_eq!(*left_out, Value::Null);

    let sure = ["--confidence", "99%"];
    let page = ["--labs", "orders", "--report", "out"];
    assert_says_99(&study(&sixfold, &[&sure[..], &["--json", "b.json"]].concat()).stdout);
    study(&sixfold, &[&sure[..], &page].concat());
    for file in ["out/report.html", "out/report.md"] {
        assert_says_99(&text(&sixfold, file));
    }
    for run in json(&sixfold, "out/results.json")["runs"]
        .as_array()
        .expect("a list")
    {
        assert_eq!(run["settings"]["confidence"], 0.99, "{run}");
    }
    run_ok(&sixfold, &["report", "b.json", "--figures", "paper"]);
    for file in ["paper/results.md", "paper/methods.md"] {
        assert_says_99(&text(&sixfold, file));
    }
    let compared = run_ok(&sixfold, &["compare", "b.json", "a.json", "--all"]).stdout;
    assert!(compared.contains("confidence   99 % → 95 %"), "{compared}");
    let header = compared.lines().find(|line| line.contains("before"));
    assert!(
        header.is_some_and(|line| line.contains("99 %")),
        "{compared}"
    );

    let again = run_ok(&sixfold, &["rerun", "b.json", "--json", "c.json"]);
    assert!(again.stdout.contains("--confidence"), "{again:?}");
    assert_eq!(
        json(&sixfold, "c.json")["runs"][0]["settings"]["confidence"],
        0.99
    );
}

#[test]
fn every_measuring_command_has_it() {
    let sixfold = grid();
    let end = [
        "--rounds",
        "2",
        "--confidence",
        "0.99",
        "--json",
        "one.json",
    ];
    let commands: [&[&str]; 5] = [
        &["pick", "grid.obj", "--backends", "half-edge,corner-table"],
        &["orders", "grid.obj", "--backends", "half-edge"],
        &[
            "growth",
            "--to",
            "2000",
            "--steps",
            "2",
            "--backends",
            "half-edge",
        ],
        &[
            "why",
            "grid.obj",
            "--backends",
            "half-edge",
            "--relations",
            "vertex_faces",
        ],
        &["neighbours", "grid.obj", "--indices", "grid"],
    ];
    let has_it = || json(&sixfold, "one.json")["runs"][0]["settings"]["confidence"] == 0.99;
    for command in commands {
        let run = run_ok(&sixfold, &[command, &end].concat());
        assert!(has_it(), "{command:?}");
        if command[0] == "pick" {
            assert_says_99(&run.stdout);
        }
    }
    let programs = [
        "grid.obj",
        "--programs",
        "regions",
        "--backends",
        "half-edge",
    ];
    let run = sixfold.run_programs(&[&programs[..], &end].concat());
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(has_it(), "{run:?}");
}

/// The quantiles of Student's distribution with one degree of freedom are 12.706 for 95 %, and 63.657 for 99 %.
#[test]
fn the_intervals_of_the_same_launches_are_wider() {
    let sixfold = grid();
    for (number, seed) in [("1", "1"), ("2", "2")] {
        study(
            &sixfold,
            &["--seed", seed, "--json", &format!("{number}.json")],
        );
        with_99(
            &sixfold,
            &format!("{number}.json"),
            &format!("sure-{number}.json"),
        );
    }
    let pooled = |files: [&str; 2]| {
        let merge = [
            "merge", "--repeat", files[0], files[1], "--json", "all.json",
        ];
        run_ok(&sixfold, &merge);
        json(&sixfold, "all.json")["findings"][0]["results"].clone()
    };
    let rows = [["1.json", "2.json"], ["sure-1.json", "sure-2.json"]].map(pooled);
    let [usual, sure] = rows.each_ref().map(|rows| rows.as_array().expect("a list"));
    assert_eq!([usual.len(), sure.len()], [4; 2]);
    for (usual, sure) in usual.iter().zip(sure) {
        assert_eq!(usual["median_ns"], sure["median_ns"]);
        for [low, high] in [
            ["ci_low_ns", "ci_high_ns"],
            ["ratio_ci_low", "ratio_ci_high"],
        ] {
            let width = |row: &Value| {
                let end = |name: &str| row[name].as_f64().expect("two launches").ln();
                end(high) - end(low)
            };
            let expected = 63.6567 / 12.7062 * width(usual);
            assert!(
                (width(sure) - expected).abs() <= 1e-4 * expected,
                "{usual} {sure}"
            );
        }
    }
}

#[test]
fn a_confidence_that_is_none_is_refused() {
    let sixfold = grid();
    for wrong in ["0", "1", "95", "100%", "nan", "abc", "-0.95", "0.9999"] {
        let arguments = ["study", "grid.obj", "--confidence", wrong];
        let run = assert_refused(&sixfold, &arguments, 2, "--confidence");
        let words: Vec<&str> = run.stderr.split_whitespace().collect();
        let message =
            "write a part from 0.5 to 0.999 or a percentage from 50% to 99.9%, such as 0.95 or 95%";
        assert!(words.join(" ").contains(message), "{wrong}: {run:?}");
    }
}

#[test]
fn results_of_another_confidence_are_not_continued_or_pooled() {
    let sixfold = grid();
    study(&sixfold, &["--seed", "1", "--json", "a.json"]);
    study(&sixfold, &["--seed", "2", "--json", "b.json"]);
    with_99(&sixfold, "b.json", "sure.json");
    let merge = ["merge", "--repeat", "a.json", "sure.json", "--json", "-"];
    let difference = "the settings differ: --confidence is 99 %, expected 95 %";
    assert_refused(&sixfold, &merge, 2, difference);

    let page = ["--labs", "none", "--report", "out"];
    study(&sixfold, &page);
    let resumed = [&STUDY[..], &page, &["--resume", "--confidence", "0.9"]].concat();
    let difference = "other settings (--confidence was 95 %, and is 90 % now)";
    assert_refused(&sixfold, &resumed, 2, difference);
}
