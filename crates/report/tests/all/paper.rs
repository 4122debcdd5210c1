//! Tests the files for a paper: their data are those of the results, and their texts are true for them.

use std::fs;
use std::num::NonZeroU32;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use sixfold::shapes;
use sixfold_report::{PaperFile, ReportPage};
use sixfold_results::{CacheState, Failed, FailureKind, Finding, Report, Results, Standing};
use sixfold_study::{Effort, Operation, Settings, StudyMesh, study};

/// Enough rounds for intervals.
const ROUNDS: NonZeroU32 = NonZeroU32::new(8).expect("above 0");

const SPECIAL_NAME: &str = "a_&%#$b{c}~^\\|.obj";

fn report(mesh: &str) -> Report {
    let study_mesh = StudyMesh::new(mesh, shapes::icosahedron());
    let settings = Settings {
        operations: vec![Operation::Build, Operation::VertexNormal],
        effort: Effort::Rounds(ROUNDS),
        ..Settings::default()
    };
    let report = study(&study_mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let mut report = report.expect("a study");
    // A disturbed sample does not count, and how many are disturbed depends on the machine.
    for row in &mut report.results {
        row.samples = ROUNDS.get() as usize;
    }
    report
}

fn results(meshes: &[&str]) -> Results {
    let mut results = Results::default();
    for mesh in meshes {
        results.add(report(mesh).into());
    }
    results
}

fn paper(results: &Results) -> Vec<PaperFile> {
    let page = ReportPage::new(results, "sixfold study");
    let paper = page.paper(results, None);
    assert_eq!(paper.missing, []);
    paper.files
}

fn bytes<'p>(files: &'p [PaperFile], name: &str) -> &'p [u8] {
    let file = files.iter().find(|file| file.name == name);
    &file.unwrap_or_else(|| panic!("no file {name}")).bytes
}

fn text<'p>(files: &'p [PaperFile], name: &str) -> &'p str {
    std::str::from_utf8(bytes(files, name)).expect("UTF-8")
}

/// Returns the cells of the columns `names`, for each row. The data of these tests need no quotes.
fn columns<const N: usize>(csv: &str, names: [&str; N]) -> Vec<[String; N]> {
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    let places = names.map(|name| {
        let place = header.iter().position(|column| *column == name);
        place.unwrap_or_else(|| panic!("no column {name} in {header:?}"))
    });
    lines
        .map(|line| places.map(|place| line[place].to_owned()))
        .collect()
}

#[test]
fn every_figure_has_four_files() {
    for meshes in [&["ball.obj"][..], &["a.obj", "b.obj"]] {
        let all = results(meshes);
        let page = ReportPage::new(&all, "sixfold study");
        let files = paper(&all);
        for figure in page.all_figures() {
            let id = &figure.id;
            assert!(text(&files, &format!("{id}.svg")).starts_with("<svg"));
            let pdf = bytes(&files, &format!("{id}.pdf"));
            assert!(pdf.starts_with(b"%PDF"), "{id}");
            let font = b"DejaVuSans";
            assert!(pdf.windows(font.len()).any(|part| part == font), "{id}");
            let csv = text(&files, &format!("{id}.csv"));
            assert!(csv.lines().count() > 2, "{id}: {csv}");
            let caption = text(&files, &format!("{id}.txt"));
            for part in [
                &*figure.title,
                &figure.caption,
                &format!("Data: {id}.csv"),
                "8 samples for each time",
                "8 rounds",
                "seed 1",
                "Measured: ",
                "Command: sixfold study",
            ] {
                assert!(caption.contains(part), "{id}: {part}: {caption}");
            }
        }
        assert_eq!(files.len(), 4 * page.all_figures().count() + 3);
    }
}

#[test]
fn the_data_of_figures_are_those_of_the_results() {
    let all = results(&["ball.obj"]);
    let study = all.studies().next().expect("one study");
    let files = paper(&all);
    for operation in [Operation::Build, Operation::VertexNormal] {
        let names = [
            "backend",
            "operation",
            "median_ns",
            "ratio_to_best",
            "ratio_ci_high",
        ];
        let mut rows = columns(text(&files, "rankings.csv"), names);
        rows.retain(|cells| cells[1] == operation.name());
        let ranked: Vec<_> = study.rows(operation.name()).collect();
        assert_eq!(rows.len(), ranked.len());
        for (cells, row) in rows.iter().zip(ranked) {
            assert_eq!(cells[..2], [row.backend.as_str(), operation.name()]);
            let numbers = cells[2..].iter().map(|cell| cell.parse().ok());
            let numbers: Vec<Option<f64>> = numbers.collect();
            assert_eq!(
                numbers,
                [row.median_ns, row.ratio_to_best, row.ratio_ci_high]
            );
        }
    }
    let bytes = columns(text(&files, "memory.csv"), ["backend", "table", "bytes"]);
    let expected = study.backends.iter().flat_map(|backend| {
        let tables = backend.tables.iter();
        tables.map(|part| {
            [
                backend.name.clone(),
                part.table.to_string(),
                part.bytes.to_string(),
            ]
        })
    });
    assert_eq!(bytes, expected.collect::<Vec<_>>());
    let lines = columns(text(&files, "break-even.csv"), ["backend", "run_ns"]);
    for [backend, ns] in lines {
        let row = study.row(Operation::VertexNormal.name(), &backend);
        let row = row.expect("measured");
        assert_eq!(ns.parse().ok(), row.median_ns);
    }
}

/// Sets the results of one operation, so that the table is known.
fn known_study(mesh: &str) -> Report {
    let mut study = report(mesh);
    for row in &mut study.results {
        row.standing = Some(Standing::Slower);
        row.ratio_to_best = Some(2.0);
        row.ratio_ci_low = Some(1.5);
        row.ratio_ci_high = Some(2.5);
        row.ns_per_element = Some(20.0);
        row.median_ns = Some(20.0);
        match row.backend.as_str() {
            "half-edge" => {
                row.standing = Some(Standing::Best);
                row.ratio_to_best = Some(1.0);
                row.ratio_ci_low = Some(1.0);
                row.ratio_ci_high = Some(1.0);
                row.ns_per_element = Some(10.0);
                row.median_ns = Some(10.0);
            }
            "polygon-soup" => {
                row.median_ns = None;
                row.ns_per_element = None;
                row.ratio_to_best = None;
                row.standing = None;
                row.estimated_ns = Some(1239.9);
            }
            "face-vertex" => {
                row.median_ns = None;
                row.ns_per_element = None;
                row.ratio_to_best = None;
                row.standing = None;
            }
            _ => {}
        }
    }
    study
}

#[test]
fn tables_mark_the_best_and_lower_bounds_and_missing_times() {
    let mut all = Results::default();
    all.add(known_study(SPECIAL_NAME).into());
    let files = paper(&all);
    let tex = text(&files, "results.tex");
    // The order of the backends is that of the study.
    let line = "vertex\\_normal & $\\ge$ 123 & 2.00 & -- & 2.00 & \\textbf{1.00} & 2.00 \\\\*\n";
    assert!(tex.contains(line), "{tex}");
    assert!(tex.contains("{\\scriptsize [1.50--2.50]}"), "{tex}");
    let name = "a\\_\\&\\%\\#\\$b\\{c\\}\\textasciitilde{}\\textasciicircum{}\\textbackslash{}\\textbar{}.obj";
    assert!(tex.contains(name), "{tex}");
    for part in [
        "\\usepackage{booktabs,longtable}",
        "\\toprule",
        "\\midrule",
        "\\bottomrule",
    ] {
        assert!(tex.contains(part), "{part}");
    }
    let [opened, closed] = ["{", "}"].map(|brace| {
        let escaped = format!("\\{brace}");
        tex.matches(brace).count() - tex.matches(&escaped).count()
    });
    assert_eq!(opened, closed);
    let markdown = text(&files, "results.md");
    let line = "| vertex\\_normal | ≥ 123 | 2.00 [1.50, 2.50] | – | 2.00 [1.50, 2.50] | **1.00** | 2.00 [1.50, 2.50] |";
    assert!(markdown.contains(line), "{markdown}");
}

#[test]
fn several_meshes_have_a_table_of_means() {
    let files = paper(&results(&["a.obj", "b.obj"]));
    let tex = text(&files, "results.tex");
    for label in [
        "means", "mesh-1", "mesh-2", "times-1", "times-2", "memory", "meshes",
    ] {
        let label = format!("\\label{{tab:sixfold-{label}}}");
        assert_eq!(tex.matches(&label).count(), 1, "{label}");
    }
    let single = paper(&results(&["a.obj"]));
    assert!(!text(&single, "results.tex").contains("tab:sixfold-means"));
}

/// Returns the lines of the table with `label` in `results.tex`.
fn tex_table<'t>(tex: &'t str, label: &str) -> Vec<&'t str> {
    let start = tex.find(&format!("\\label{{tab:sixfold-{label}}}"));
    let table = &tex[start.unwrap_or_else(|| panic!("no table {label}: {tex}"))..];
    let end = table.find("\\bottomrule").expect("an end");
    table[..end].lines().collect()
}

/// Returns the line of an operation in a table.
fn line_of<'t>(lines: &[&'t str], operation: &str) -> &'t str {
    let name = operation.replace('_', "\\_");
    let line = lines.iter().find(|line| line.starts_with(&name));
    line.unwrap_or_else(|| panic!("no line {name}: {lines:?}"))
}

#[test]
fn undecided_times_are_italic_and_nothing_in_their_row_is_bold() {
    let mut study = known_study("a.obj");
    for row in &mut study.results {
        if row.operation == "build" && ["half-edge", "winged-edge"].contains(&&*row.backend) {
            row.standing = Some(Standing::Undecided);
        }
    }
    let mut all = Results::default();
    all.add(study.into());
    let files = paper(&all);
    let tex = text(&files, "results.tex");
    let table = tex_table(tex, "mesh-1");
    let build = line_of(&table, "build");
    assert_eq!(build.matches("\\textit{").count(), 2, "{build}");
    assert!(!build.contains("\\textbf"), "{build}");
    let decided = line_of(&table, "vertex_normal");
    assert!(decided.contains("\\textbf{1.00}"), "{decided}");
    assert!(!decided.contains("\\textit"), "{decided}");
    assert!(!tex.contains("dagger"), "{tex}");
}

#[test]
fn a_row_with_too_few_samples_has_its_mark_and_nothing_bold() {
    let mut study = known_study("a.obj");
    for row in &mut study.results {
        if row.operation == "build" {
            row.standing = None;
            row.samples = 2;
        }
    }
    let mut all = Results::default();
    all.add(study.into());
    let files = paper(&all);
    let tex = text(&files, "results.tex");
    let build = line_of(&tex_table(tex, "mesh-1"), "build");
    assert!(build.starts_with("build\\,$^\\dagger$ & "), "{build}");
    assert!(
        !build.contains("\\textbf") && !build.contains("\\textit"),
        "{build}"
    );
    let other = line_of(&tex_table(tex, "mesh-1"), "vertex_normal");
    assert!(
        !other.contains("dagger") && other.contains("\\textbf{1.00}"),
        "{other}"
    );
    assert!(
        tex.contains("$^\\dagger$: too few samples to name the fastest."),
        "{tex}"
    );
    let markdown = text(&files, "results.md");
    assert!(markdown.contains("| build † | "), "{markdown}");
    assert!(
        markdown.contains(" †: too few samples to name the fastest."),
        "{markdown}"
    );
}

/// Returns studies of meshes on which half-edge is the fastest. Face-vertex takes `twice` or `uneven` times as long, by
/// mesh; the others take 40 times as long.
fn studies_with_known_means(count: usize) -> Results {
    let mut all = Results::default();
    // Fastest on every mesh, but the mean of the quotient can be 1 by chance.
    let uneven = [1.02, 1.02, 9.0, 1.02];
    for (number, uneven) in uneven.into_iter().enumerate().take(count) {
        let mut study = report(&format!("{number}.obj"));
        study.samples.clear();
        for row in &mut study.results {
            let ratio = match (row.backend.as_str(), row.operation.as_str()) {
                ("half-edge", _) => 1.0,
                ("face-vertex", "build") => 2.0,
                ("face-vertex", _) => uneven,
                _ => 40.0,
            };
            row.standing = Some(if ratio == 1.0 {
                Standing::Best
            } else {
                Standing::Slower
            });
            row.ratio_to_best = Some(ratio);
            row.median_ns = Some(100.0 * ratio);
            row.ns_per_element = Some(ratio);
        }
        all.add(study.into());
    }
    all
}

#[test]
fn means_have_the_marks_of_the_page() {
    let all = studies_with_known_means(4);
    let files = paper(&all);
    let [tex, markdown] = ["results.tex", "results.md"].map(|name| text(&files, name));
    let lines = tex_table(tex, "means");
    let [build, normals] = ["build", "vertex_normal"].map(|name| line_of(&lines, name));
    assert_eq!(build.matches("\\textbf{1.00}").count(), 1, "{build}");
    assert!(!build.contains("\\textit"), "{build}");
    assert_eq!(normals.matches("\\textit{").count(), 2, "{normals}");
    assert!(!normals.contains("\\textbf"), "{normals}");
    assert!(!tex.contains("dagger"), "{tex}");

    let page = ReportPage::new(&all, "sixfold study");
    let figure = page.all_figures().find(|figure| figure.id == "heat-map");
    let shown = &figure.expect("the heat map of the means").table;
    let table = markdown.split("\n\n").find(|part| part.starts_with("|  |"));
    let mut rows = table.expect("the means").lines();
    let cells = |line: &str| -> Vec<String> { line.split(" | ").map(str::to_owned).collect() };
    let header = cells(rows.next().expect("a header").trim_end_matches(" |"));
    let mut checked = 0;
    for line in rows.skip(1).map(|line| cells(line.trim_end_matches(" |"))) {
        let name = line[0].trim_start_matches("| ").replace("\\_", "_");
        let row = shown.rows.iter().find(|row| row[0] == name);
        let row = row.unwrap_or_else(|| panic!("no row {name}"));
        for (backend, cell) in header.iter().zip(&line).skip(1) {
            let place = shown.header.iter().position(|column| column == backend);
            let on_page = &row[place.expect("a column")];
            assert_eq!(
                on_page.starts_with('●'),
                cell.starts_with("**"),
                "{on_page} {cell}"
            );
            let is_italic = cell.starts_with('*') && !cell.starts_with("**");
            assert_eq!(on_page.starts_with('◐'), is_italic, "{on_page} {cell}");
            checked += 1;
        }
    }
    assert_eq!(checked, 12);
}

#[test]
fn means_over_two_meshes_are_decided_by_both() {
    let files = paper(&studies_with_known_means(2));
    let tex = text(&files, "results.tex");
    let lines = tex_table(tex, "means");
    let build = line_of(&lines, "build");
    assert_eq!(build.matches("\\textbf{").count(), 1, "{build}");
    assert!(
        tex.contains("slower on every mesh, by more than 5 \\%"),
        "{tex}"
    );
    assert!(
        tex.contains("in brackets the least and the largest on a mesh"),
        "{tex}"
    );
}

/// Over few meshes, one with too few samples is enough; over many, the meshes have an interval unless all have too few.
#[test]
fn a_mean_with_too_few_samples_has_its_mark_and_nothing_bold() {
    for (meshes, open, marked) in [(2, 1, true), (6, 5, false), (6, 6, true)] {
        let mut all = Results::default();
        for number in 0..meshes {
            let mut study = known_study(&format!("{number}.obj"));
            for row in &mut study.results {
                if row.operation == "build" && number < open {
                    row.standing = None;
                    row.samples = 2;
                }
            }
            all.add(study.into());
        }
        let files = paper(&all);
        let tex = text(&files, "results.tex");
        let context = format!("{open} of {meshes}");
        let caption = tex.split("\\label{tab:sixfold-means}").next();
        let has_caption = caption.is_some_and(|text| text.contains("too few samples"));
        assert_eq!(has_caption, marked, "{context}");
        let lines = tex_table(tex, "means");
        let [build, normals] = ["build", "vertex_normal"].map(|name| line_of(&lines, name));
        assert_eq!(build.contains("dagger"), marked, "{context}: {build}");
        assert_eq!(!build.contains("\\textbf"), marked, "{context}: {build}");
        assert!(
            normals.contains("\\textbf{1.00}") && !normals.contains("dagger"),
            "{context}: {normals}"
        );
    }
}

/// On the built-in mesh, one backend is the fastest in decimation, and two share the first place in remeshing.
#[test]
fn rankings_of_workloads_are_bold_if_they_are_decided() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports/workloads");
    for (name, expected) in [("decimation", [1, 0, 0]), ("remeshing", [0, 2, 0])] {
        let file = folder.join(format!("built-in-{name}.json"));
        let document = fs::read_to_string(file).expect("data");
        let mut all = Results::read_json(&document).expect("a document");
        let marks = |all: &Results| {
            let files = paper(all);
            let rows = tex_table(text(&files, "results.tex"), "workloads").concat();
            ["\\textbf{", "\\textit{", "dagger"].map(|mark| rows.matches(mark).count())
        };
        assert_eq!(marks(&all), expected, "{name}");
        for finding in &mut all.findings {
            if let Finding::Pick(pick) = finding {
                pick.preliminary = true;
            }
        }
        assert_eq!(marks(&all), [0, 0, 1], "{name}");
    }
}

fn methods(results: &Results) -> String {
    text(&paper(results), "methods.md").to_owned()
}

/// Changes the run of the first finding.
fn first_study(results: &mut Results) -> &mut Report {
    match results.findings.first_mut() {
        Some(Finding::Study(study)) => study,
        _ => panic!("a study"),
    }
}

#[test]
fn methods_state_rounds_or_budget() {
    let mut all = results(&["ball.obj"]);
    let text = methods(&all);
    assert!(text.contains("without a time limit: 8 rounds."), "{text}");
    assert!(!text.contains("time budget"), "{text}");
    assert!(text.contains("The seed of the random numbers was 1."));
    first_study(&mut all).run.settings.rounds = None;
    first_study(&mut all).run.settings.budget_s = Some(2.5);
    let text = methods(&all);
    assert!(
        text.contains("a time budget for each measurement: 2.5 s."),
        "{text}"
    );
    assert!(!text.contains("rounds was given"), "{text}");
}

#[test]
fn methods_name_the_launches() {
    let mut all = results(&["ball.obj"]);
    let [launches, batches] = ["ran in several launches", "batch means"];
    let text = methods(&all);
    assert!(text.contains(batches) && !text.contains(launches), "{text}");
    for row in &mut first_study(&mut all).results {
        row.launch_ns = vec![row.median_ns; 2];
    }
    let text = methods(&all);
    assert!(text.contains(launches) && !text.contains(batches), "{text}");
}

#[test]
fn methods_are_true_for_the_results() {
    let mut all = results(&["ball.obj"]);
    let text = methods(&all);
    for absent in [
        "interrupted",
        "cold",
        "machines",
        "was not studied",
        "lower bound",
        "geometric means",
    ] {
        assert!(!text.contains(absent), "{absent}: {text}");
    }
    assert!(text.contains("The mesh: ball.obj (12 vertices, 30 edges, 20 faces; closed, genus 0;"));
    assert!(text.contains("median polish (Tukey 1977)"));
    assert!(text.contains("6 backends were measured: polygon-soup"));

    all.add(report("b.obj").into());
    all.add_failure(Failed {
        mesh: "gone.obj".into(),
        reason: "no such file".into(),
        kind: FailureKind::NotMeasured,
    });
    let study = first_study(&mut all);
    study.interrupted = true;
    study.run.environment.cpu_model = Some("Another processor".into());
    let caches = study.run.environment.cache_state.as_mut();
    let caches = caches.expect("times were measured");
    caches.state = CacheState::Cold;
    caches.written_bytes = 2_000_000;
    let row = &mut study.results[0];
    row.estimated_ns = row.median_ns.take();
    let text = methods(&all);
    for part in [
        "was interrupted",
        "caches were cold: each sample is one run, and before each run 2.00 MB",
        "The results come from 2 machines: Another processor",
        "The mesh gone.obj was not studied: no such file.",
        "1 time is only estimated as a lower bound",
        "geometric means",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

/// Documents that were converted from schema 2 have no corrected times.
#[test]
fn methods_of_uncorrected_times_state_no_correction() {
    let mut all = results(&["ball.obj"]);
    for row in &mut first_study(&mut all).results {
        row.uncorrected_ns = None;
    }
    let text = methods(&all);
    assert!(text.contains("A time is the median of the samples."));
    assert!(!text.contains("Tukey"), "{text}");
}

#[test]
fn results_without_times_have_no_tables() {
    let empty = Results::default();
    let files = paper(&empty);
    assert_eq!(files.len(), 3);
    assert!(text(&files, "methods.md").contains("no measurements"));
    assert!(!text(&files, "results.tex").contains("begin{table}"));
}
