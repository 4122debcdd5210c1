//! Tests the pages of small studies: their marks show the data, and they load no external
//! resources.

use std::num::NonZeroU32;
use std::sync::atomic::AtomicBool;

use sixfold::shapes;
use sixfold_report::{Figure, ReportPage};
use sixfold_study::{
    Effort, Failed, FailureKind, Finding, Operation, Report, Results, Settings, StudyMesh, study,
};

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
    report.expect("a study")
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
    figure.picture.svg().matches("<title>").count()
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
    for operation in operations() {
        let id = format!("ranking-{}", operation.name().replace('_', "-"));
        let ranking = figure_by_id(&page, &id);
        assert_eq!(mark_count(ranking), 6, "{id}");
        let ratios = ranking.table.rows.iter().map(|row| row[1].parse::<f64>());
        let ratios: Vec<f64> = ratios.map(|ratio| ratio.expect("a number")).collect();
        // The ratio of a tied backend can be below 1, because ratios are computed within rounds.
        assert!(
            ratios[0] <= 1.0 && ratios.contains(&1.0),
            "{id}: {ratios:?}"
        );
        assert!(ratios.is_sorted(), "{id}: {ratios:?}");
    }
    let memory = figure_by_id(&page, "memory");
    assert!(memory.table.rows.len() >= 12, "{:?}", memory.table);
    let break_even = figure_by_id(&page, "break-even");
    assert_eq!(break_even.table.rows.len(), 6);
    for figure in page.all_figures() {
        let columns = figure.table.header.len();
        assert!(figure.table.rows.iter().all(|row| row.len() == columns));
        assert!(
            figure.picture.svg().contains("role=\"img\""),
            "{}",
            figure.id
        );
        assert!(figure.picture.svg().contains("prefers-color-scheme:dark"));
        assert_eq!(figure.command, "sixfold study ball.obj");
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
    assert!(
        page.figures
            .iter()
            .any(|figure| figure.id == "ranking-boundary")
    );
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
    assert!(!html.contains("<script"), "a name became code");
    assert!(!html.contains("<b>"), "a command became code");
    assert!(html.contains("&lt;script&gt;"));
    let outside = html.replace("http://www.w3.org/2000/svg", "");
    // A clip path of the same figure is not an external resource.
    let outside = outside.replace("url(#", "");
    for word in ["http:", "https:", "src=", "@import", "url("] {
        assert!(!outside.contains(word), "{word}");
    }
    for figure in page.all_figures() {
        assert!(!figure.picture.svg().contains("<script"), "{}", figure.id);
    }
    assert!(!page.markdown().replace("\\<", "").contains("<script"));
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

/// The page of several meshes has the means of each group.
#[test]
fn groups_of_meshes_have_a_table() {
    let mut all = results(&["a.obj"]);
    let settings = Settings {
        operations: operations(),
        effort: Effort::Rounds(ROUNDS),
        ..Settings::default()
    };
    let grid = StudyMesh::new("b.obj", shapes::triangle_grid(12, 12).expect("small"));
    let grid = study(&grid, &settings, &AtomicBool::new(false), &mut |_| ());
    all.add(grid.expect("a study").into());
    let page = ReportPage::new(&all, "sixfold study");
    let [groups] = &page.tables[..] else {
        panic!("one table: {:?}", page.tables);
    };
    let names: Vec<&str> = groups
        .table
        .rows
        .iter()
        .map(|row| row[0].as_str())
        .collect();
    for name in ["all meshes", "100 to 999 faces", "closed meshes"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert!(page.html().contains("Groups of meshes"));
    assert!(page.markdown().contains("## Groups of meshes"));
    let single = ReportPage::new(&results(&["a.obj"]), "sixfold study");
    assert!(single.tables.is_empty());
    // A mean over meshes is not a ratio of times of the same rounds.
    let ranking = figure_by_id(&page, "ranking-boundary");
    assert!(ranking.caption.contains("geometric mean over the meshes"));
}
