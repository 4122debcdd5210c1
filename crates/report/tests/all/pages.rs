//! Tests the pages of small studies: their marks show the data, and they load no external
//! resources.

use std::num::NonZeroU32;
use std::sync::atomic::AtomicBool;

use sixfold::shapes;
use sixfold_report::{Drawing, Figure, Rank, ReportPage, SummaryFigure, Table};
use sixfold_results::{
    Failed, FailureKind, Finding, Refusal, RefusalKind, Report, ResultRow, Results, Standing,
};
use sixfold_study::{Effort, Operation, Settings, StudyMesh, study};

/// Enough rounds for intervals.
const ROUNDS: NonZeroU32 = NonZeroU32::new(8).expect("above 0");

const NAME_WITH_MARKUP: &str = "<script>alert('a|b')</script>&.obj";

fn report(mesh: &str) -> Report {
    let study_mesh = StudyMesh::new(mesh, shapes::icosahedron());
    let settings = Settings {
        operations: operations(),
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

fn operations() -> Vec<Operation> {
    vec![
        Operation::Build,
        Operation::Boundary,
        Operation::VertexNormal,
    ]
}

fn results(meshes: &[&str]) -> Results {
    let mut results = Results::default();
    for mesh in meshes {
        results.add(report(mesh).into());
    }
    results
}

fn mark_count(figure: &Figure) -> usize {
    figure.svg().matches("<g><title>").count()
}

fn figure_by_id<'p>(page: &'p ReportPage, id: &str) -> &'p Figure {
    let mut figures = page.all_figures();
    figures
        .find(|figure| figure.id == id)
        .unwrap_or_else(|| panic!("no figure {id}"))
}

#[test]
fn every_figure_has_as_many_marks_as_numbers() {
    let page = ReportPage::new(&results(&["ball.obj"]), "sixfold study ball.obj");
    let heat_map = figure_by_id(&page, "heat-map");
    assert_eq!(mark_count(heat_map), 3 * 6);
    assert_eq!(heat_map.table.rows.len(), 3);
    let rankings = figure_by_id(&page, "rankings");
    assert_eq!(mark_count(rankings), 3 * 6);
    for operation in operations() {
        let rows = rankings.table.rows.iter();
        let rows = rows.filter(|row| row[0] == operation.name());
        let ratios: Vec<f64> = rows.map(|row| row[2].parse().expect("a number")).collect();
        // The ratio of a tied backend can be below 1, because ratios are computed within rounds.
        assert!(
            ratios[0] <= 1.0 && ratios.contains(&1.0),
            "{operation}: {ratios:?}"
        );
        assert!(ratios.is_sorted(), "{operation}: {ratios:?}");
    }
    let memory = figure_by_id(&page, "memory");
    assert!(memory.table.rows.len() >= 12, "{:?}", memory.table);
    let break_even = figure_by_id(&page, "break-even");
    assert_eq!(break_even.table.rows.len(), 6);
    for figure in page.all_figures() {
        let columns = figure.table.header.len();
        assert!(figure.table.rows.iter().all(|row| row.len() == columns));
        assert!(figure.svg().contains("role=\"img\""), "{}", figure.id);
        assert!(figure.svg().contains("prefers-color-scheme:dark"));
        assert_eq!(figure.command, "sixfold study ball.obj");
        assert!(
            figure.source.contains("8 samples for each time"),
            "{}",
            figure.source
        );
        assert!(figure.source.contains("seed 1"), "{}", figure.source);
    }
    let mut ids: Vec<&str> = page
        .all_figures()
        .map(|figure| figure.id.as_str())
        .collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
}

#[test]
fn numbers_of_samples_that_differ_are_a_range() {
    let mut study = report("ball.obj");
    study.results[0].samples = 6;
    let page = ReportPage::new(&study.into(), "sixfold study ball.obj");
    let source = &figure_by_id(&page, "heat-map").source;
    assert!(
        source.starts_with("6 to 8 samples for each time · "),
        "{source}"
    );
}

#[test]
fn an_interrupted_page_has_a_warning() {
    let mut whole = results(&["ball.obj"]);
    let has_warning = |results: &Results| {
        let page = ReportPage::new(results, "sixfold study ball.obj");
        [page.html(), page.markdown()].map(|text| text.contains("Interrupted: "))
    };
    assert_eq!(has_warning(&whole), [false; 2]);
    if let Finding::Study(study) = &mut whole.findings[0] {
        study.interrupted = true;
    }
    assert_eq!(has_warning(&whole), [true; 2]);
}

#[test]
fn a_page_of_several_meshes_has_pooled_figures_and_one_section_each() {
    let mut both = results(&["a.obj", NAME_WITH_MARKUP]);
    both.add_failure(Failed {
        mesh: "gone.obj".into(),
        reason: "no such file".into(),
        kind: FailureKind::NotMeasured,
    });
    let page = ReportPage::new(&both, "sixfold study a.obj");
    assert_eq!(page.meshes.len(), 2);
    assert!(page.figures.iter().any(|figure| figure.id == "heat-map"));
    assert!(page.folded.iter().any(|figure| figure.id == "rankings"));
    let html = page.html();
    assert_eq!(
        html.matches("data-figure=").count(),
        page.all_figures().count()
    );
    assert!(html.contains("no such file"));
    let markdown = page.markdown();
    for figure in page.all_figures() {
        let link = format!("(figures/{}.svg)", figure.id);
        assert!(markdown.contains(&link), "{link}");
    }
}

#[test]
fn pages_load_nothing_and_names_are_escaped() {
    let page = ReportPage::new(&results(&[NAME_WITH_MARKUP]), "sixfold study '<b>'");
    let html = page.html();
    // The page has one script of its own.
    assert_eq!(html.matches("<script").count(), 1, "a name became code");
    assert!(!html.contains("<script>alert"), "a name became code");
    assert!(!html.contains("study '<b>'"), "a command became code");
    assert!(html.contains("script&gt;&amp;.obj"));
    let outside = html.replace("http://www.w3.org/2000/svg", "");
    // A clip path of the same figure is not an external resource.
    let outside = outside.replace("url(#", "");
    for word in ["http:", "https:", "src=", "@import", "url("] {
        assert!(!outside.contains(word), "{word}");
    }
    for figure in page.all_figures() {
        assert!(!figure.svg().contains("<script"), "{}", figure.id);
    }
    assert!(!page.markdown().replace("\\<", "").contains("<script"));
}

/// The first screen has the answer, and a figure for each backend and kind of work.
#[test]
fn the_first_screen_answers() {
    let mut all = results(&["/home/me/ball.obj"]);
    if let Finding::Study(study) = &mut all.findings[0] {
        study.mesh.picture = Some("aGVsbG8=".into());
        study.warnings = vec!["one".into(), "two".into()];
    }
    let page = ReportPage::new(&all, "sixfold study ball.obj");
    assert_eq!(page.title, "Mesh data structures on ball.obj");
    let starts: Vec<&str> = page
        .answer
        .iter()
        .filter_map(|sentence| Some(sentence.split_once(": ")?.0))
        .collect();
    assert_eq!(starts, ["Queries", "Building", "How sure"]);
    // One short sentence for each kind of work, with the interval of the ratio.
    assert!(page.answer[0].contains(" × ("), "{:?}", page.answer);
    assert!(page.answer[..2].iter().all(|s| s.split(' ').count() <= 16));
    assert!(page.measured.contains("samples"), "{}", page.measured);
    let last = page.conditions.last().expect("relation tables");
    assert!(last.contains("`sixfold pick`"), "{last}");
    let summary = page.summary.as_ref().expect("a study");
    let columns: Vec<&str> = summary
        .columns
        .iter()
        .map(|column| column.name.as_str())
        .collect();
    assert_eq!(columns, ["queries", "memory", "build"]);
    let over: Vec<&str> = summary
        .columns
        .iter()
        .map(|column| column.over.as_str())
        .collect();
    assert_eq!(
        over,
        [
            "mean of 2 queries and passes",
            "bytes per vertex",
            "repeated builds"
        ]
    );
    assert_eq!(summary.rows.len(), 6);
    for column in 0..columns.len() {
        let figures = summary
            .rows
            .iter()
            .map(|row| row.figures[column].as_ref().expect("measured"));
        let figures: Vec<&SummaryFigure> = figures.collect();
        let best = |figure: &&&SummaryFigure| matches!(figure.rank, Rank::Best | Rank::Shared);
        // Ratios begin at 1 for the best; bars of memory begin at 0, and end at the largest.
        for figure in &figures {
            match (summary.columns[column].name.as_str(), figure.drawing) {
                ("memory", Drawing::Bar(share)) => {
                    assert!(share > 0.0 && share <= 1.0, "{figure:?}");
                    assert!(share < 1.0 || !best(&figure), "{figures:?}");
                }
                (name, Drawing::Dot { ratio, .. }) if name != "memory" => {
                    assert!(ratio >= 1.0 && (ratio == 1.0 || figure.rank != Rank::Best));
                }
                (name, drawing) => panic!("{name}: {drawing:?}"),
            }
        }
        assert!(figures.iter().any(|figure| best(&figure)), "{figures:?}");
    }
    // The indexed face set of an icosahedron: 12 positions of 12 bytes, 60 corners of 4 bytes.
    let mut rows = summary.rows.iter();
    let faces = rows.find(|row| row.backend == "indexed-face-set");
    let memory = faces.and_then(|row| row.figures[1].as_ref());
    let memory = memory.expect("counted");
    assert_eq!((memory.text.as_str(), memory.rank), ("32.0 B", Rank::Best));
    // 12 vertices and 20 faces.
    assert_eq!(memory.detail.as_deref(), Some("19.2 B per triangle"));
    let html = page.html();
    assert!(html.contains("src=\"data:image/png;base64,aGVsbG8=\" alt=\"The mesh ball.obj\""));
    // One more in a debug build.
    let more = page.warnings.len() - 1;
    assert!(
        page.warnings
            .ends_with(&["one".to_owned(), "two".to_owned()])
    );
    assert!(
        html.contains(&format!("{more} more warning")),
        "warnings are not folded"
    );
    assert!(
        html.contains("in each round, the backends run a task"),
        "no methods"
    );
    for section in [
        "answer",
        "operations",
        "rankings",
        "heat-map",
        "memory",
        "method",
    ] {
        assert!(
            html.contains(&format!("href=\"#{section}\"")),
            "no link to {section}"
        );
        assert!(html.contains(&format!("id=\"{section}\"")), "no {section}");
    }
    // Without standings, nothing is marked as best.
    if let Finding::Study(study) = &mut all.findings[0] {
        for row in &mut study.results {
            row.standing = None;
        }
    }
    let unsure = ReportPage::new(&all, "sixfold study ball.obj");
    assert!(
        unsure.answer[0].starts_with("Queries (provisional"),
        "{:?}",
        unsure.answer
    );
    let summary = unsure.summary.expect("a study");
    let ranks = |column: usize| -> Vec<Rank> {
        let figures = summary
            .rows
            .iter()
            .filter_map(|row| row.figures[column].as_ref());
        figures.map(|figure| figure.rank).collect()
    };
    assert!(
        ranks(2).iter().all(|rank| *rank == Rank::Other),
        "{:?}",
        ranks(2)
    );
    assert!(
        ranks(1).contains(&Rank::Best),
        "memory is counted, not timed"
    );
    // A picture that is not Base64 does not go into the page.
    if let Finding::Study(study) = &mut all.findings[0] {
        study.mesh.picture = Some("\" onload=alert(1)".into());
    }
    let html = ReportPage::new(&all, "sixfold study ball.obj").html();
    assert!(!html.contains("onload"), "a picture became code");
}

/// If the findings come from two machines, each line about a machine names its findings.
#[test]
fn each_machine_names_its_findings() {
    let page = ReportPage::new(&results(&["a.obj", "b.obj"]), "sixfold merge");
    assert_eq!(page.machines.len(), 1);
    assert!(!page.machines[0].contains("a.obj"), "{:?}", page.machines);
    let mut other = report("b.obj");
    other.run.environment.cpu_model = Some("Another processor".into());
    let mut both = results(&["a.obj"]);
    both.add(other.into());
    let machines = ReportPage::new(&both, "sixfold merge").machines;
    assert_eq!(machines.len(), 2);
    assert!(machines[0].starts_with("study of a.obj: "), "{machines:?}");
    assert!(
        machines[1].starts_with("study of b.obj: Another processor"),
        "{machines:?}"
    );
}

/// A page shows the counts of documents without times.
#[test]
fn counts_without_times_are_tables() {
    let mesh = StudyMesh::new("ball.obj", shapes::icosahedron());
    let backends = sixfold_study::Backend::structures();
    let settings = sixfold_study::WhySettings::default();
    let why = sixfold_study::why(&mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let memory = sixfold_study::audit(&mesh, &backends, &NoHeap, &mut |_| ());
    let mut all = results(&["ball.obj"]);
    all.add(why.expect("six hold it").into());
    all.add(memory.into());
    let page = ReportPage::new(&all, "sixfold merge");
    let titles: Vec<&str> = page.labs.iter().map(|lab| lab.title.as_str()).collect();
    assert_eq!(
        titles,
        ["Reads of the queries on ball.obj", "Memory: ball.obj"]
    );
    let rows = |lab: usize| page.labs[lab].tables[0].table.rows.len();
    assert_eq!([rows(0), rows(1)], [9 * 6, 6]);
    // The allocator of this test counts nothing, so the three counts differ.
    let header = &page.labs[1].tables[0].table.header;
    assert_eq!(header[1..4], ["formula", "tables", "counted"]);
    for text in [page.html(), page.markdown()] {
        for part in [
            "Reads of each query",
            "Bytes of each structure",
            "polygon-soup",
        ] {
            assert!(text.contains(part), "{part}");
        }
    }
}

/// An allocator that counts nothing.
struct NoHeap;

impl sixfold_study::Heap for NoHeap {
    fn live(&self) -> usize {
        0
    }

    fn restart_peak(&self) {}

    fn peak(&self) -> usize {
        0
    }
}

/// A study in which each operation takes the given time per element on each structure.
fn timed(mesh: StudyMesh, times: &[(&str, f64)]) -> Report {
    let settings = Settings {
        operations: operations(),
        effort: Effort::Rounds(ROUNDS),
        ..Settings::default()
    };
    let report = study(&mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let mut report = report.expect("a study");
    let least = times
        .iter()
        .map(|(_, ns)| *ns)
        .fold(f64::INFINITY, f64::min);
    report
        .backends
        .retain(|backend| times.iter().any(|(name, _)| backend.name == *name));
    report
        .results
        .retain(|row| times.iter().any(|(name, _)| row.backend == *name));
    for row in &mut report.results {
        let (_, ns) = times
            .iter()
            .find(|(name, _)| row.backend == *name)
            .expect("kept");
        let elements = row.elements.expect("measured") as f64;
        row.ns_per_element = Some(*ns);
        row.median_ns = Some(ns * elements);
        [row.ratio_to_best, row.ratio_ci_low, row.ratio_ci_high] = [Some(ns / least); 3];
        row.standing = Some(if *ns == least {
            Standing::Best
        } else {
            Standing::Slower
        });
    }
    report
}

fn ball(name: &str, half_edge: f64, corner_table: f64) -> Report {
    let times = [("half-edge", half_edge), ("corner-table", corner_table)];
    timed(StudyMesh::new(name, shapes::icosahedron()), &times)
}

/// A mean says "not possible" if no mesh has a time because the backend cannot do the operation, and "not run" if a budget
/// ended on one of them.
#[test]
fn means_say_why_a_backend_has_no_time() {
    let html = |kinds: [RefusalKind; 2]| {
        let mut all = Results::default();
        for (name, kind) in ["a.obj", "b.obj"].into_iter().zip(kinds) {
            let mut study = ball(name, 1.0, 3.0);
            let operation = study.results[0].operation.clone();
            let has_time =
                |row: &ResultRow| (&*row.backend, &row.operation) != ("corner-table", &operation);
            study.results.retain(has_time);
            study.refusals.push(Refusal {
                backend: "corner-table".into(),
                operation,
                kind,
                reason: "none".into(),
            });
            all.add(study.into());
        }
        let html = ReportPage::new(&all, "sixfold study").html();
        let table = html
            .split("<table class=\"operations\">")
            .nth(1)
            .expect("the means");
        table.split("</table>").next().expect("a table").to_owned()
    };
    let (impossible, ended) = (RefusalKind::Impossible, RefusalKind::BudgetEnded);
    let both = html([impossible; 2]);
    assert!(
        both.contains(">not possible<") && !both.contains(">not run<"),
        "{both}"
    );
    let one = html([impossible, ended]);
    assert!(
        one.contains(">not run<") && !one.contains(">not possible<"),
        "{one}"
    );
}

/// The table with this title.
fn table<'p>(page: &'p ReportPage, title: &str) -> &'p Table {
    let mut tables = page.tables.iter();
    let found = tables.find(|table| table.title == title);
    &found.unwrap_or_else(|| panic!("no table {title}")).table
}

/// The table of means, which follows the figures.
fn appendix(page: &ReportPage) -> &Table {
    let [means] = &page.appendix[..] else {
        panic!("one table: {:?}", page.appendix);
    };
    assert_eq!(means.title, "Means by size and kind of mesh");
    &means.table
}

/// The page of several meshes says which structure is the fastest on how many meshes, by size and kind.
#[test]
fn the_answer_over_many_meshes_counts_them_by_size_and_kind() {
    let mut all = Results::default();
    for name in ["a.obj", "b.obj", "c.obj"] {
        all.add(ball(name, 1.0, 3.0).into());
    }
    // On the only mesh with a boundary, the other structure is the fastest.
    let grid = StudyMesh::new("d.obj", shapes::triangle_grid(12, 12).expect("small"));
    all.add(timed(grid, &[("half-edge", 2.0), ("corner-table", 1.0)]).into());
    let page = ReportPage::new(&all, "sixfold study");
    let ([fastest, _, meshes], [groups]) = (&page.answer[..], &page.conditions[..]) else {
        panic!("{:?} {:?}", page.answer, page.conditions);
    };
    assert!(
        fastest.starts_with("Queries: half-edge (fastest on 3 of 4)"),
        "{fastest}"
    );
    for part in [
        "on 100 to 999 faces (1 mesh) to build (corner-table) and for queries (corner-table)",
        "; on meshes with boundary (1 mesh)",
    ] {
        assert!(groups.contains(part), "{groups}");
    }
    assert!(meshes.contains("over all 4"), "{meshes}");
    let winners = table(&page, "Fastest by size and kind of mesh");
    let cell = |group: &str| {
        let row = winners.rows.iter().find(|row| row[0] == group);
        row.unwrap_or_else(|| panic!("no group {group}: {winners:?}"))[3].clone()
    };
    assert_eq!(winners.header[3], "for queries");
    assert_eq!(cell("closed meshes"), "half-edge (3 of 3); next 3.00 ×");
    assert_eq!(
        cell("meshes with boundary"),
        "corner-table (1 of 1); next 2.00 ×"
    );
    let means = appendix(&page);
    assert!(
        means.rows.iter().any(|row| row[0] == "10 to 99 faces"),
        "{means:?}"
    );
    assert!(
        page.html()
            .contains("id=\"table-fastest-by-size-and-kind-of-mesh\"")
    );
    assert!(
        page.markdown()
            .contains("## Fastest by size and kind of mesh")
    );
    let single = ReportPage::new(&results(&["a.obj"]), "sixfold study");
    assert!(single.tables.is_empty());
    assert!(single.overview.rows.is_empty());
    // A mean over meshes is not a ratio of times of the same rounds.
    let ranking = figure_by_id(&page, "rankings");
    assert!(
        ranking
            .caption
            .contains("geometric means of the times on the meshes")
    );
}

/// Each mesh has a dot in each line, a row that links to its section, and the sections have no figures if
/// there are many.
#[test]
fn each_of_many_meshes_has_a_dot_and_a_section() {
    let mut all = Results::default();
    for place in 0..9 {
        all.add(ball(&format!("folder/{place}.obj"), 1.0, 2.0).into());
    }
    // The corner table is unusually slow on one mesh, and there is only one of this name.
    all.add(ball("other/odd.obj", 1.0, 16.0).into());
    all.add(ball("other/0.obj", 1.0, 2.0).into());
    let page = ReportPage::new(&all, "sixfold study");
    let spread = figure_by_id(&page, "distribution");
    // Building and queries, two structures.
    assert_eq!(mark_count(spread), 2 * 2 * 11);
    let dot = "<title>odd.obj, corner-table: 16.0 ×</title>";
    assert_eq!(spread.svg().matches(dot).count(), 2);
    let row = &spread.table.rows[1];
    assert_eq!(row[..2], ["building", "corner-table"]);
    // The mean of ten times 2 and once 16.
    assert_eq!((row[2].as_str(), row[3].as_str()), ("2.42 ×", "half-edge"));
    assert_eq!(row[7..], ["2.00 ×", "16.0 ×", "11"]);
    let outliers = table(&page, "Outliers");
    assert_eq!(outliers.rows.len(), 2, "{outliers:?}");
    for (row, link) in outliers.rows.iter().zip(&outliers.links) {
        assert_eq!((row[0].as_str(), link.as_str()), ("odd.obj", "mesh-10"));
        assert_eq!(row[3], "corner-table 16.0 × (2.00 ×)");
    }
    let names: Vec<&str> = page
        .overview
        .rows
        .iter()
        .map(|row| row[0].as_str())
        .collect();
    // Two files have the same name, so their folders are shown.
    assert_eq!(
        (names[0], names[1], names[10]),
        ("folder/0.obj", "1.obj", "other/0.obj")
    );
    assert_eq!(page.overview.links.len(), 11);
    let html = page.html();
    for (place, section) in page.meshes.iter().enumerate() {
        assert!(section.figures.is_empty(), "{}", section.title);
        assert!(
            section.summary.is_some() && !section.tables.is_empty(),
            "{}",
            section.title
        );
        assert!(html.contains(&format!("id=\"mesh-{}\"", place + 1)));
        assert!(html.contains(&format!("href=\"#mesh-{}\"", place + 1)));
    }
    let few = ReportPage::new(&results(&["a.obj", "b.obj"]), "sixfold study");
    assert!(few.meshes.iter().all(|section| section.figures.len() == 2));
}

/// The means are over the meshes that all structures hold; the page names the others.
#[test]
fn meshes_that_not_all_can_hold_are_named() {
    let mut all = Results::default();
    for name in ["a.obj", "b.obj"] {
        all.add(ball(name, 1.0, 2.0).into());
    }
    let mut open = ball("open.obj", 1.0, 2.0);
    let corner = open
        .backends
        .iter_mut()
        .find(|backend| backend.name == "corner-table");
    corner.expect("kept").holds = false;
    open.results.retain(|row| row.backend != "corner-table");
    all.add(open.into());
    let page = ReportPage::new(&all, "sixfold study");
    let meshes = page.answer.last().expect("an answer");
    assert!(meshes.contains("over the 2 of 3"), "{meshes}");
    let holding = table(&page, "Who can hold the meshes");
    assert_eq!(holding.rows[0], ["half-edge", "3 of 3", ""]);
    assert_eq!(holding.rows[1], ["corner-table", "2 of 3", "open.obj"]);
    let spread = figure_by_id(&page, "distribution");
    assert!(
        spread.caption.contains("Rings are meshes"),
        "{}",
        spread.caption
    );
    // Three dots of half-edge, two of the corner table.
    assert_eq!(mark_count(spread), 2 * 5);
}

/// If another measurement on the page has a different time for the same operation, a warning says so.
#[test]
fn an_unsteady_machine_is_warned_of() {
    let settings = Settings {
        operations: vec![Operation::VertexNormal],
        effort: Effort::Rounds(ROUNDS),
        ..Settings::default()
    };
    let mesh = StudyMesh::new("ball.obj", shapes::icosahedron());
    let orders = sixfold_study::orders(&mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let mut orders = orders.expect("orders");
    let warning = |orders: &sixfold_results::OrdersReport, factor: f64| {
        let mut study = report("ball.obj");
        let mut orders = orders.clone();
        for row in &mut study.results {
            row.ns_per_element = row.median_ns.map(|_| 10.0);
        }
        let given = orders.results.iter_mut().filter(|row| row.case == "given");
        for (place, row) in given.enumerate() {
            let factor = if place == 0 { factor } else { 1.2 };
            row.ns_per_element = Some(10.0 * factor);
        }
        let mut all = Results::from(study);
        all.add(orders.into());
        let warnings = ReportPage::new(&all, "sixfold study").warnings;
        warnings
            .into_iter()
            .find(|warning| warning.contains("not steady"))
    };
    assert_eq!(warning(&orders, 1.25), None);
    for factor in [1.9, 1.9_f64.recip()] {
        let said = warning(&orders, factor).expect("a warning");
        let expected = "1 of 6 times differ by more than 30 %";
        assert!(
            said.contains(expected) && said.contains("1.90 ×, vertex_normal on polygon-soup"),
            "{said}"
        );
    }
    // The times of another mesh are not compared.
    orders.mesh.sha256 = "0".repeat(64);
    assert_eq!(warning(&orders, 1.9), None);
}

/// The figure and the answer name the structures with the shortest total time for few and many queries.
#[test]
fn the_structure_with_the_shortest_total_time_depends_on_the_number_of_queries() {
    let mut study = timed(
        StudyMesh::new("ball.obj", shapes::icosahedron()),
        &[
            ("indexed-face-set", 100.0),
            ("face-vertex", 10.0),
            ("half-edge", 5.0),
        ],
    );
    study
        .results
        .retain(|row| row.operation != Operation::Boundary.name());
    for row in &mut study.results {
        match row.operation.as_str() {
            "build" => {
                row.first_ns = None;
                row.median_ns = Some(match row.backend.as_str() {
                    "face-vertex" => 900.0,
                    "half-edge" => 1400.0,
                    _ => 100.0,
                });
            }
            _ => row.operation = "all_queries".into(),
        }
        row.elements = Some(1_000_000);
        (row.ci_low_ns, row.ci_high_ns) = (None, None);
    }
    // 100 n = 900 + 10 n at 10 visits, and 900 + 10 n = 1400 + 5 n at 100 visits.
    let page = ReportPage::new(&study.clone().into(), "sixfold study");
    let caption = &figure_by_id(&page, "break-even").caption;
    let expected =
        "indexed-face-set up to 10 visits, face-vertex up to 100 visits, half-edge beyond";
    assert!(caption.contains(expected), "{caption}");
    assert!(caption.contains("Points and numbers show"), "{caption}");
    let few = "indexed-face-set up to 10 visited elements and face-vertex up to 100 visited elements, then half-edge";
    assert!(
        page.conditions
            .iter()
            .any(|sentence| sentence.contains(few)),
        "{:?}",
        page.conditions
    );
    // The range follows from the intervals: the saved time is 5 ± √(1² + half²).
    for (half, range) in [(1.0, "(78 to 140)"), (5.0, "(from 50, or never)")] {
        for row in &mut study.results {
            let half = if row.backend == "half-edge" {
                half
            } else {
                1.0
            };
            // The times above are those of one visit.
            let part = half / row.ns_per_element.expect("a time");
            row.ci_low_ns = row.median_ns.map(|ns| (1.0 - part) * ns);
            row.ci_high_ns = row.median_ns.map(|ns| (1.0 + part) * ns);
        }
        let page = ReportPage::new(&study.clone().into(), "sixfold study");
        let figure = figure_by_id(&page, "break-even");
        let expected = format!("face-vertex up to 100 visits {range}, half-edge beyond");
        assert!(figure.caption.contains(&expected), "{}", figure.caption);
    }
    // A structure that is the fastest from the start has no steps.
    for row in &mut study.results {
        if row.operation == Operation::Build.name() {
            row.median_ns = Some(0.001);
        }
    }
    let page = ReportPage::new(&study.into(), "sixfold study");
    let caption = &figure_by_id(&page, "break-even").caption;
    assert!(
        caption.contains("half-edge has the shortest total time everywhere"),
        "{caption}"
    );
    assert!(!caption.contains("Points and numbers show"), "{caption}");
}

/// With too few samples, the answer names the option that gives enough.
#[test]
fn a_provisional_answer_says_which_budget_gives_enough_samples() {
    let mut study = report("ball.obj");
    for row in &mut study.results {
        row.standing = None;
        row.samples = 2;
    }
    let said = |study: &Report| {
        let page = ReportPage::new(&study.clone().into(), "sixfold study");
        assert!(page.answer[0].starts_with("Queries (provisional, too few samples):"));
        page.answer.last().expect("how sure").clone()
    };
    assert!(
        said(&study).ends_with("Enough samples need --rounds 4."),
        "{}",
        said(&study)
    );
    // Twice the samples need twice the time, and half as much again.
    study.run.settings.rounds = None;
    study.run.settings.budget_s = Some(10.0);
    let first = said(&study);
    assert!(
        first.contains("Enough samples need 3 times the --budget."),
        "{first}"
    );
    // One of two launches has a time.
    study.run.settings.launches = std::num::NonZeroU32::new(3);
    for row in &mut study.results {
        row.launch_ns = vec![None, row.median_ns, None];
    }
    let first = said(&study);
    assert!(
        first.contains("Enough samples need 3 times the --budget."),
        "{first}"
    );
    // Other reasons than too few samples: nothing is promised.
    for row in &mut study.results {
        row.launch_ns = vec![row.median_ns; 3];
    }
    let first = said(&study);
    assert!(!first.contains("Enough samples"), "{first}");
}

/// The answer names what a smaller structure costs, and the operation in which another one is much faster.
#[test]
fn the_answer_says_what_would_change_it() {
    let times = [
        ("polygon-soup", 900.0),
        ("corner-table", 15.0),
        ("half-edge", 10.0),
    ];
    let mut study = timed(StudyMesh::new("ball.obj", shapes::icosahedron()), &times);
    let said = |study: &Report| {
        let page = ReportPage::new(&study.clone().into(), "sixfold study");
        let mut sentences = page.conditions.into_iter();
        sentences
            .find(|sentence| sentence.starts_with("What would"))
            .unwrap_or_default()
    };
    let memory = |bytes: [f64; 3], study: &mut Report| {
        for (backend, bytes) in study.backends.iter_mut().zip(bytes) {
            backend.bytes_per_vertex = Some(bytes);
        }
    };
    // The soup is the smallest, but 90 times slower, so it is no choice for queries.
    memory([30.0, 100.0, 60.0].map(|b| b + 4.0), &mut study);
    let names: Vec<&str> = study.backends.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["polygon-soup", "half-edge", "corner-table"]);
    let expected =
        "little memory (corner-table: 64.0 bytes per vertex instead of 104, 1.50 × in queries)";
    assert!(said(&study).contains(expected), "{}", said(&study));
    assert!(
        !said(&study).contains("a single operation"),
        "{}",
        said(&study)
    );
    // Equal sizes change nothing.
    memory([100.0; 3], &mut study);
    assert!(!said(&study).contains("little memory"), "{}", said(&study));
    // In one operation, the corner table is much faster.
    for row in &mut study.results {
        if row.operation == Operation::Boundary.name() && row.backend != "polygon-soup" {
            let fast = row.backend == "corner-table";
            let (ns, ratio) = if fast { (10.0, 1.0) } else { (13.0, 1.3) };
            row.ns_per_element = Some(ns);
            row.median_ns = Some(ns * row.elements.expect("measured") as f64);
            row.ratio_to_best = Some(ratio);
            row.standing = Some(if fast {
                Standing::Best
            } else {
                Standing::Slower
            });
        }
    }
    let expected = "a single operation (corner-table in boundary: half-edge takes 1.30 ×)";
    assert!(said(&study).contains(expected), "{}", said(&study));
}
