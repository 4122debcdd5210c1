//! Draws the reports of the repository again from their data. A change of a drawing is meant if
//! `reports/draw` writes what it draws now.

use std::fs;
use std::path::Path;

use sixfold_report::ReportPage;
use sixfold_results::Results;

/// Returns the report that the command in its text draws.
fn drawn(folder: &Path, command: &str) -> ReportPage {
    let words = command.split(' ').filter(|word| word.ends_with(".json"));
    let mut files: Vec<_> = words
        .map(|name| folder.join(name))
        .filter(|file| file.exists())
        .collect();
    if files.is_empty() {
        files.push(folder.join("results.json"));
    }
    let mut results = Results::default();
    for file in files {
        let text = fs::read_to_string(file).expect("data");
        let one = Results::read_json(&text).expect("a document");
        results.merge(one).expect("results of one study");
    }
    ReportPage::new(&results, command)
}

#[test]
fn reports_are_drawn_from_their_data() {
    let reports = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports");
    let mut figures = 0;
    for name in ["built-in-mesh", "beside", "growth", "orders", "workloads"] {
        let folder = reports.join(name);
        let committed = |file: &str| fs::read_to_string(folder.join(file)).expect("committed");
        let text = committed("report.md");
        let command = text.lines().find(|line| line.starts_with("sixfold "));
        let page = drawn(&folder, command.expect("a command"));
        for figure in page.all_figures() {
            let file = format!("figures/{}.svg", figure.id);
            let is_same = committed(&file) == figure.svg();
            assert!(is_same, "{name}/{file} is drawn differently");
            figures += 1;
        }
        assert!(page.markdown() == text, "{name}/report.md differs");
    }
    assert!(figures > 20, "{figures} figures");
}
