//! Tests the page of a comparison: its marks, tables and sentences are those of the changes.

use std::num::NonZeroU32;
use std::sync::atomic::AtomicBool;

use sixfold::shapes;
use sixfold_report::{Compared, Figure, ReportPage};
use sixfold_results::{
    BytesChange, Change, Changes, Confidence, Failed, FailureKind, Finding, Measurement, NewWinner,
    Results, SCHEMA, SettingChange, Verdict,
};
use sixfold_study::{Effort, Operation, Settings, StudyMesh, study};

const COMMAND: &str = "sixfold compare a.json b.json --report changes";
const NOISE: f64 = 1.2;
const MARKUP: &str = "<script>alert('a|b')</script>&";

/// Returns a time of 1,000 ns before and `ratio` times this after, with an interval of 10 %.
fn change(operation: &str, backend: &str, ratio: f64) -> Change {
    Change {
        measurement: Measurement {
            mesh: "ball.obj".into(),
            kind: "study",
            case: String::new(),
            operation: operation.into(),
            backend: backend.into(),
        },
        before_ns: 1000.0,
        after_ns: 1000.0 * ratio,
        before_samples: 9,
        after_samples: 8,
        ratio,
        ci_low: Some(ratio * 0.9),
        ci_high: Some(ratio * 1.1),
        detectable: Some(1.08),
        verdict: match ratio {
            r if r > NOISE => Verdict::Slower,
            r if r < NOISE.recip() => Verdict::Faster,
            _ => Verdict::Same,
        },
        other_checksum: false,
    }
}

fn without_interval(change: Change) -> Change {
    Change {
        before_samples: 2,
        ci_low: None,
        ci_high: None,
        ..change
    }
}

fn of_different_work(change: Change) -> Change {
    Change {
        other_checksum: true,
        ..change
    }
}

fn changes(rows: Vec<Change>) -> Changes {
    Changes {
        schema: SCHEMA,
        environment: Vec::new(),
        overall: (!rows.is_empty()).then_some(1.0),
        relative: false,
        noise: NOISE,
        confidence: Confidence::default(),
        rows,
        bytes: Vec::new(),
        winners: Vec::new(),
        only_before: Vec::new(),
        only_after: Vec::new(),
        sentences: vec!["The files have the same counts of bytes.".into()],
    }
}

/// Returns the results of a small study, which say how the times were measured.
fn results() -> Results {
    let study_mesh = StudyMesh::new("ball.obj", shapes::icosahedron());
    let settings = Settings {
        operations: vec![Operation::Boundary],
        effort: Effort::Rounds(NonZeroU32::MIN),
        ..Settings::default()
    };
    let report = study(&study_mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let mut finding: Finding = report.expect("a study").into();
    finding.run_mut().command = Some("sixfold study ball.obj".into());
    finding.into()
}

fn page(changes: &Changes) -> ReportPage {
    let results = results();
    let [before, after] = ["a.json", "b.json"].map(|name| Compared {
        name,
        results: &results,
    });
    ReportPage::from_changes(changes, before, after, COMMAND)
}

fn figure<'p>(page: &'p ReportPage, id: &str) -> &'p Figure {
    let mut figures = page.all_figures();
    let figure = figures.find(|figure| figure.id == id);
    figure.unwrap_or_else(|| panic!("no figure {id}"))
}

/// Returns the number of the attribute `name` of the first element `tag` in `svg`.
fn attribute(svg: &str, tag: &str, name: &str) -> Option<f64> {
    let (_, element) = svg.split_once(&format!("<{tag} "))?;
    let (_, value) = element.split_once(&format!("{name}=\""))?;
    value.split_once('"')?.0.parse().ok()
}

/// A mark of a picture: the text of its title, and its shapes.
fn marks(figure: &Figure) -> Vec<(String, String)> {
    let svg = figure.svg();
    let marks = svg.split("<g><title>").skip(1).map(|mark| {
        let (title, rest) = mark.split_once("</title>").expect("a title");
        let (shapes, _) = rest.split_once("</g>").expect("a group");
        (title.to_owned(), shapes.to_owned())
    });
    marks.collect()
}

/// Returns the function from ratios to places, by the labels of the axis at 1/2 and 2.
fn axis(figure: &Figure) -> impl Fn(f64) -> f64 {
    let svg = figure.svg();
    let place = |label: &str| {
        let (before, _) = svg
            .split_once(&format!(">{label}</text>"))
            .expect("a label");
        let text = before.rfind("<text").expect("a text");
        attribute(&before[text..], "text", "x").expect("a place")
    };
    let [half, two] = [place("0.5"), place("2")];
    assert!(half < two, "{half} {two}");
    move |ratio: f64| (half + two) / 2.0 + ratio.log2() * (two - half) / 2.0
}

/// Returns the ends of the line of a mark.
fn interval(shapes: &str) -> Option<[f64; 2]> {
    let (_, path) = shapes.split_once("<path d=\"M")?;
    let (from, to) = path.split('"').next()?.split_once('L')?;
    let x = |point: &str| point.split(' ').next()?.parse().ok();
    Some([x(from)?, x(to)?])
}

#[test]
fn marks_are_those_of_the_changes_largest_first() {
    let changes = changes(vec![
        change("boundary", "half-edge", 1.5),
        change("boundary", "corner-table", 1.1),
        change("build", "half-edge", 0.25),
        without_interval(change("build", "face-vertex", 2.5)),
    ]);
    let page = page(&changes);
    let figure = figure(&page, "changes");
    let marks = marks(figure);
    let expected = [
        (
            "build on half-edge: 0.250 × (0.225 to 0.275), 1.00 µs → 250 ns; faster; 9 and 8 samples",
            0.25,
        ),
        (
            "build on face-vertex: 2.50 ×, 1.00 µs → 2.50 µs; slower; 2 and 8 samples",
            2.5,
        ),
        (
            "boundary on half-edge: 1.50 × (1.35 to 1.65), 1.00 µs → 1.50 µs; slower; 9 and 8 samples",
            1.5,
        ),
    ];
    assert_eq!(marks.len(), expected.len(), "{marks:?}");
    let place = axis(figure);
    let mut rows = Vec::new();
    for ((title, shapes), (expected, ratio)) in marks.iter().zip(expected) {
        assert_eq!(title, expected);
        let x = attribute(shapes, "circle", "cx").expect("a dot");
        assert!(
            (x - place(ratio)).abs() < 0.1,
            "{title}: {x} {}",
            place(ratio)
        );
        rows.push(attribute(shapes, "circle", "cy").expect("a dot"));
        // A dot without an interval is an open ring.
        let (_, circle) = shapes.split_once("<circle").expect("a dot");
        let is_ring = circle.contains("fill=\"none\"");
        match interval(shapes) {
            Some([low, high]) => {
                assert!((low - place(ratio * 0.9)).abs() < 0.1, "{title}");
                assert!((high - place(ratio * 1.1)).abs() < 0.1, "{title}");
                assert!(!is_ring, "{title}");
            }
            None => assert_eq!((ratio, is_ring), (2.5, true)),
        }
    }
    assert!(rows.is_sorted(), "{rows:?}");
    // The band of ratios that count as equal.
    let svg = figure.svg();
    let bands = svg.split("<rect ").map(|rect| format!("<rect {rect}"));
    let bands =
        bands.filter(|rect| rect.contains("fill=\"#dcdcda\"") && rect.contains("height=\"60\""));
    let bands: Vec<String> = bands.collect();
    let [band] = &bands[..] else {
        panic!("{bands:?}")
    };
    let [x, width] = ["x", "width"].map(|name| attribute(band, "rect", name).expect("a number"));
    assert!((x - place(NOISE.recip())).abs() < 0.1, "{x}");
    assert!((x + width - place(NOISE)).abs() < 0.1, "{width}");
    assert!(svg.contains(">← faster<") && svg.contains(">slower →<"));
    assert!(svg.contains(">0.250 ×, 1.00 µs → 250 ns<"), "{svg}");
    assert!(figure.caption.contains("open ring"), "{}", figure.caption);
    // The data have one row for each mark.
    assert_eq!(figure.csv.lines().count(), 1 + 3);
    let first =
        "ball.obj,study,,build,half-edge,1000.0,250.0,9,8,0.25,0.225,0.275,1.08,faster,false";
    assert_eq!(figure.csv.lines().nth(1), Some(first));
    assert_eq!(
        page.answer,
        [
            "Changes beyond chance: of 4 times, 2 are slower and 1 is faster; 1 is equal and 0 cannot be told.",
            "Largest change: build on half-edge, 0.250 × the time before (1.00 µs → 250 ns).",
            "Overall: 1.00 × the times before (median of all ratios).",
        ]
    );
    assert!(
        page.warnings
            .iter()
            .any(|warning| warning.contains("Few samples: 1 of 4 times"))
    );
}

#[test]
fn figures_say_how_both_results_were_measured() {
    let page = page(&changes(vec![
        change("build", "half-edge", 2.0),
        change("build", "face-vertex", 1.0),
    ]));
    assert_eq!(page.title, "What changed: a.json → b.json");
    assert_eq!(page.all_figures().count(), 2);
    for figure in page.all_figures() {
        for part in [
            "a.json: 1 sample for each time",
            "b.json: 1 sample",
            "seed 1",
            " build",
        ] {
            assert!(figure.source.contains(part), "{part}: {}", figure.source);
        }
        let measured = "# a.json: sixfold study ball.obj\n# b.json: sixfold study ball.obj";
        assert_eq!(figure.command, format!("{COMMAND}\n{measured}"));
    }
    assert!(page.facts.contains("are the same"), "{}", page.facts);
}

#[test]
fn nothing_changed_is_said_plainly() {
    let page = page(&changes(vec![
        change("build", "half-edge", 1.1),
        change("build", "face-vertex", 0.9),
        of_different_work(change("boundary", "face-vertex", 3.0)),
    ]));
    assert_eq!(
        page.answer[0],
        "No change found: of 3 times, 2 are equal and 0 cannot be told; 1 is of different work."
    );
    let ids: Vec<&str> = page
        .all_figures()
        .map(|figure| figure.id.as_str())
        .collect();
    assert_eq!(ids, ["ratios"]);
    let marks = marks(figure(&page, "ratios"));
    assert_eq!(marks.len(), 2, "{marks:?}");
    // A comparison of bytes has no times.
    let page = self::page(&changes(Vec::new()));
    assert_eq!(page.answer, ["The files have the same counts of bytes."]);
    assert_eq!(page.all_figures().count(), 0);
    assert_eq!(page.appendix.len(), 0);
}

#[test]
fn times_of_different_work_are_told_apart() {
    let page = page(&changes(vec![
        of_different_work(change("boundary", "face-vertex", 9.0)),
        change("build", "half-edge", 2.0),
    ]));
    let marks = marks(figure(&page, "changes"));
    assert!(marks[0].0.starts_with("build on half-edge"), "{marks:?}");
    assert!(marks[1].0.contains("different work"), "{marks:?}");
    assert!(!marks[1].1.contains("<circle"), "{marks:?}");
    assert!(
        page.answer[0].contains("1 is slower and 0 are faster"),
        "{:?}",
        page.answer
    );
    assert!(
        page.answer[1].contains("build on half-edge"),
        "{:?}",
        page.answer
    );
    assert!(
        page.warnings[0].contains("boundary on face-vertex"),
        "{:?}",
        page.warnings
    );
    let verdicts: Vec<&str> = page.appendix[0]
        .table
        .rows
        .iter()
        .map(|row| &*row[row.len() - 1])
        .collect();
    assert_eq!(verdicts, ["slower", "different work"]);
}

#[test]
fn the_picture_has_forty_rows_and_the_table_has_all() {
    let rows = (0..50).map(|i| change("build", "half-edge", 2.0 + f64::from(i)));
    let page = page(&changes(rows.collect()));
    let figure = figure(&page, "changes");
    assert_eq!(marks(figure).len(), 40);
    assert_eq!(figure.table.rows.len(), 50);
    assert_eq!(figure.csv.lines().count(), 1 + 40);
    assert!(
        figure.caption.contains("the first 40 rows; 10 more"),
        "{}",
        figure.caption
    );
}

#[test]
fn relative_ratios_are_divided_by_the_median() {
    let mut changes = changes(vec![
        change("build", "half-edge", 4.0),
        change("boundary", "half-edge", 2.0),
        change("boundary", "face-vertex", 0.5),
    ]);
    changes.relative = true;
    changes.overall = Some(2.0);
    changes.rows[1].verdict = Verdict::Same;
    let page = page(&changes);
    let figures = figure(&page, "changes");
    let titles: Vec<String> = marks(figures).into_iter().map(|(title, _)| title).collect();
    assert!(
        titles[0].starts_with("boundary on face-vertex: 0.250 × (0.225 to 0.275)"),
        "{titles:?}"
    );
    assert!(
        titles[1].starts_with("build on half-edge: 2.00 × (1.80 to 2.20)"),
        "{titles:?}"
    );
    assert!(
        figures
            .caption
            .contains("the median of all ratios (2.00 ×)")
    );
    let header = &page.appendix[0].table.header;
    assert!(header.contains(&"÷ median".to_owned()), "{header:?}");
    let place = axis(figures);
    let x = attribute(&marks(figures)[1].1, "circle", "cx").expect("a dot");
    assert!((x - place(2.0)).abs() < 0.1);
}

#[test]
fn all_ratios_have_a_dot_in_the_line_of_their_backend() {
    let ratios = [0.5, 1.0, 1.0, 2.0];
    let mut rows: Vec<Change> = ratios
        .map(|ratio| change("build", "half-edge", ratio))
        .to_vec();
    rows.push(change("build", "face-vertex", 1.5));
    let dots = page(&changes(rows.clone()));
    let dots = figure(&dots, "ratios");
    let place = axis(dots);
    let places = marks(dots).into_iter().map(|(_, shapes)| {
        ["cx", "cy"].map(|name| attribute(&shapes, "circle", name).expect("a dot"))
    });
    let places: Vec<[f64; 2]> = places.collect();
    assert_eq!(places.len(), 5);
    for ([x, _], ratio) in places.iter().zip([0.5, 1.0, 1.0, 2.0, 1.5]) {
        assert!((x - place(ratio)).abs() < 0.1, "{x} {ratio}");
    }
    // Equal ratios do not cover one another.
    assert_ne!(places[1], places[2]);
    assert_eq!(dots.csv.lines().count(), 1 + 5);
    assert_eq!(
        dots.table.rows[0],
        [
            "half-edge",
            "4",
            "0.500 ×",
            "1.00 ×",
            "1.00 ×",
            "1.00 ×",
            "2.00 ×"
        ]
    );
    // Many ratios are drawn as quartiles.
    while rows.len() < 1000 {
        rows.extend(rows.clone());
    }
    let quartiles = page(&changes(rows));
    assert_eq!(marks(figure(&quartiles, "ratios")).len(), 2);
}

#[test]
fn names_have_only_the_parts_that_differ() {
    let mut rows = vec![
        change("build", "half-edge", 2.0),
        change("build", "half-edge", 3.0),
    ];
    rows[1].measurement.mesh = "scans/bunny.obj".into();
    let page = page(&changes(rows));
    let titles: Vec<String> = marks(figure(&page, "changes"))
        .into_iter()
        .map(|mark| mark.0)
        .collect();
    assert!(
        titles[0].starts_with("build on half-edge (bunny.obj):"),
        "{titles:?}"
    );
    assert_eq!(
        page.appendix[0].table.header[..3],
        ["operation", "backend", "mesh"]
    );
}

#[test]
fn incomplete_results_are_labelled() {
    let mut interrupted = results();
    interrupted.planned = vec!["ball.obj".into(), "bad.obj".into(), "next.obj".into()];
    interrupted.failures = vec![Failed {
        mesh: "bad.obj".into(),
        reason: "no faces".into(),
        kind: FailureKind::NotMeasured,
    }];
    if let Finding::Study(study) = &mut interrupted.findings[0] {
        study.interrupted = true;
    }
    let mut other = results();
    other.findings[0].run_mut().environment.cpu_model = Some("Other".into());
    let mut mixed = results();
    mixed.findings.extend(other.findings);
    let mut changes = changes(vec![
        change("build", "half-edge", 2.0),
        change("build", "lox", 1.0),
    ]);
    changes.environment = vec![SettingChange {
        what: "compiler".into(),
        before: "rustc 1.94".into(),
        after: "rustc 1.95".into(),
    }];
    changes.only_before = vec![change("boundary", "half-edge", 1.0).measurement];
    changes.bytes = vec![BytesChange {
        mesh: "ball.obj".into(),
        backend: "half-edge".into(),
        operation: None,
        before: 1000,
        after: 2000,
    }];
    changes.winners = vec![NewWinner {
        mesh: "ball.obj".into(),
        operation: "build".into(),
        before: "half-edge".into(),
        after: "lox".into(),
    }];
    let before = Compared {
        name: "a.json",
        results: &interrupted,
    };
    let after = Compared {
        name: "b.json",
        results: &mixed,
    };
    let page = ReportPage::from_changes(&changes, before, after, COMMAND);
    for (place, part) in [
        "a.json was interrupted",
        "a.json is partial: it has no results of bad.obj.",
        "a.json is partial: 1 of 3 meshes not studied yet: next.obj.",
        "b.json is mixed: its results are from 2 machines or programs.",
        "Only a.json has 1 measurement of ball.obj",
    ]
    .into_iter()
    .enumerate()
    {
        assert!(
            page.warnings[place].contains(part),
            "{part}: {:?}",
            page.warnings
        );
    }
    for figure in page.all_figures() {
        let source = &figure.source;
        assert!(
            source.starts_with("a.json (interrupted, partial): "),
            "{source}"
        );
        assert!(source.contains("b.json (mixed): "), "{source}");
    }
    let [differences] = &page.tables[..] else {
        panic!("one table: {:?}", page.tables);
    };
    assert_eq!(
        differences.table.rows,
        [["compiler", "rustc 1.94", "rustc 1.95"]]
    );
    let titles: Vec<&str> = page.appendix.iter().map(|table| &*table.title).collect();
    assert_eq!(
        titles,
        [
            "All compared times",
            "Bytes that differ",
            "New fastest backends",
            "Only in a.json"
        ]
    );
    // The differences come before the figures, and everything else after them.
    for text in [page.html(), page.markdown()] {
        // Without the contents.
        let text = text.split_once("</nav>").map_or(&*text, |(_, rest)| rest);
        let place = |part: &str| {
            text.find(part)
                .unwrap_or_else(|| panic!("{part} in {text}"))
        };
        let places = [
            "What changed:",
            "rustc 1.94",
            "Changes beyond chance, largest first\n",
            "All compared times",
            "Bytes that differ",
            "New fastest backends",
        ];
        let places: Vec<usize> = places.iter().map(|part| place(part.trim_end())).collect();
        assert!(
            places.iter().skip(3).is_sorted() && places[1] < places[3],
            "{places:?}"
        );
        assert!(place("rustc 1.94") < place("in b.json divided by the time in a.json"));
    }
}

/// The other files of this figure and the other figures are complete.
#[test]
fn a_figure_with_letters_that_its_font_lacks_has_no_pdf() {
    let mut row = change("build", "half-edge", 2.0);
    row.measurement.mesh = "文🦀中χ文.obj".into();
    let page = page(&changes(vec![row, change("build", "half-edge", 3.0)]));
    let paper = page.figure_files(None);
    let [missing] = &paper.missing[..] else {
        panic!("{:?}", paper.missing);
    };
    assert_eq!(
        missing.to_string(),
        "changes.pdf is not written: the font of PDF files, DejaVu Sans, has no 中 (U+4E2D), 文 (U+6587), 🦀 (U+1F980); \
         changes.svg has the figure"
    );
    let names: Vec<&str> = paper.files.iter().map(|file| &*file.name).collect();
    assert_eq!(
        names,
        [
            "changes.svg",
            "changes.csv",
            "changes.txt",
            "ratios.svg",
            "ratios.pdf",
            "ratios.csv",
            "ratios.txt"
        ]
    );
}

#[test]
fn pages_load_nothing_and_names_are_escaped() {
    let mut row = change(MARKUP, MARKUP, 2.0);
    row.measurement.mesh = MARKUP.into();
    let rows = vec![row, change("build", "half-edge", 3.0)];
    let results = results();
    let named = Compared {
        name: MARKUP,
        results: &results,
    };
    let mut changes = changes(rows);
    changes.environment = vec![SettingChange {
        what: "flags".into(),
        before: MARKUP.into(),
        after: String::new(),
    }];
    let page = ReportPage::from_changes(&changes, named, named, COMMAND);
    let html = page.html();
    assert!(!html.contains("<script>alert"), "{html}");
    assert!(html.contains("&lt;script&gt;alert"));
    for resource in ["http://", "https://", "src=\"/", "@import", "url("] {
        let html = html.replace("http://www.w3.org/2000/svg", "");
        assert!(!html.contains(resource), "{resource}");
    }
    let markdown = page.markdown();
    assert!(
        !markdown.replace("# <script>alert", "").contains("<script>"),
        "{markdown}"
    );
    for figure in page.all_figures() {
        assert!(!figure.svg().contains("<script>"), "{}", figure.id);
    }
    let names: Vec<String> = page.files().into_iter().map(|file| file.name).collect();
    assert_eq!(
        names,
        [
            "report.html",
            "report.md",
            "figures/changes.svg",
            "figures/ratios.svg"
        ]
    );
}
