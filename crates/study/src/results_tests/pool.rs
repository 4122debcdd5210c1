use std::sync::atomic::AtomicBool;

use sixfold_measure::Operation;

use sixfold::subdivision::Method;
use sixfold::{PolygonMesh, shapes};

use crate::engine::effort::Effort;
use crate::engine::simulated_machine::SimulatedMachine;
use crate::labs::study::study_on;
use crate::{Settings, StudyMesh};
use sixfold_results::{
    Finding, Overall, Pool, Pooled, Purpose, Report, ResultRow, Results, Standing, leaders,
    next_row,
};

const BOUNDARY: Operation = Operation::Boundary;

/// A study of `mesh` in which each backend takes the given time for `boundary`. A negative time is
/// an estimate.
fn study_of(name: &str, mesh: PolygonMesh, times: &[(&str, f64)]) -> Report {
    let settings = Settings {
        operations: vec![BOUNDARY],
        effort: Effort::of_rounds(1),
        ..Settings::default()
    };
    let study_mesh = StudyMesh::new(name, mesh);
    let stop = AtomicBool::new(false);
    let machine = SimulatedMachine::equal_costs();
    let report = study_on(&machine, &study_mesh, &settings, &stop, &mut |_| ());
    let mut report = report.expect("a study");
    let measured = times.iter().map(|(_, ns)| *ns).filter(|ns| *ns > 0.0);
    let least = measured.min_by(f64::total_cmp).expect("a measured time");
    report.warnings.clear();
    report
        .backends
        .retain(|b| times.iter().any(|(name, _)| b.name == *name));
    report.results = times
        .iter()
        .map(|&(backend, ns)| ResultRow {
            elements: Some(10),
            median_ns: (ns > 0.0).then_some(ns),
            estimated_ns: (ns < 0.0).then_some(-ns),
            ratio_to_best: (ns > 0.0).then_some(ns / least),
            standing: (ns > 0.0).then_some(match ns == least {
                true => Standing::Best,
                false => Standing::Slower,
            }),
            ..ResultRow::new(backend, BOUNDARY.name(), BOUNDARY.unit())
        })
        .collect();
    report
}

fn ball(name: &str, times: &[(&str, f64)]) -> Report {
    study_of(name, shapes::icosahedron(), times)
}

fn pool_of(studies: &[Report]) -> Pool {
    let mut results = Results::default();
    results.extend(studies.iter().cloned().map(Finding::from));
    results.pool()
}

fn ratios(rows: &[Pooled]) -> Vec<(&str, usize, usize, f64)> {
    let row = |row: &'_ Pooled| (row.meshes, row.estimated, row.ratio_to_best);
    rows.iter()
        .map(|pooled| {
            let (meshes, estimated, ratio) = row(pooled);
            (
                pooled.backend.as_str(),
                meshes,
                estimated,
                (100.0 * ratio).round() / 100.0,
            )
        })
        .collect()
}

#[test]
fn ratios_are_geometric_means_over_meshes() {
    let studies = [("a", 2.0), ("b", 4.0), ("c", 8.0)].map(|(name, ratio)| {
        ball(
            name,
            &[("half-edge", 1000.0 * ratio), ("corner-table", 1000.0)],
        )
    });
    let pool = pool_of(&studies);
    let found = ratios(pool.all());
    assert_eq!(
        found,
        [("half-edge", 3, 0, 4.0), ("corner-table", 3, 0, 1.0)]
    );
    let half_edge = &pool.all()[0];
    // Student's interval would be from 0.71 to 22.4.
    assert_eq!(half_edge.ci_low.or(half_edge.ci_high), None);
    let overall = &pool.groups[0].overall;
    let slower = overall.iter().find(|row| row.backend == "half-edge");
    let ends = slower.and_then(|row| row.ends()).expect("three meshes");
    assert!(
        (ends[0] - 2.0).abs() < 1e-9 && (ends[1] - 8.0).abs() < 1e-9,
        "{ends:?}"
    );
    assert_eq!(leaders(overall).len(), 1);
    assert_eq!((pool.all()[1].best, half_edge.best), (3, 0));
    let each = half_edge.ns_per_element.expect("measured");
    assert!((each - 4000.0 / 10.0).abs() < 1e-6, "{each}");
}

#[test]
fn a_mean_with_an_estimate_is_a_lower_bound() {
    let studies = [
        ball("a", &[("polygon-soup", 10_000.0), ("half-edge", 1000.0)]),
        ball(
            "b",
            &[("polygon-soup", -1_000_000.0), ("half-edge", 1000.0)],
        ),
    ];
    let pool = pool_of(&studies);
    let found = ratios(pool.all());
    // The geometric mean of 10 and 1000.
    assert_eq!(
        found,
        [("polygon-soup", 2, 1, 100.0), ("half-edge", 2, 0, 1.0)]
    );
    assert_eq!(pool.all()[0].ci_low, None);
    let said = pool.sentences.join("\n");
    assert!(
        said.contains("polygon-soup takes ≥ 100 × the time"),
        "{said}"
    );
}

#[test]
fn a_lower_bound_below_a_measured_time_is_not_ranked_before_it() {
    let times = [
        ("polygon-soup", -100.0),
        ("face-vertex", 2000.0),
        ("half-edge", 1000.0),
    ];
    let pool = pool_of(&["a", "b", "c"].map(|name| ball(name, &times)));
    let found = ratios(pool.all());
    let expected = [
        ("polygon-soup", 3, 3, 0.1),
        ("face-vertex", 3, 0, 2.0),
        ("half-edge", 3, 0, 1.0),
    ];
    assert_eq!(found, expected, "relative to the fastest measured time");
    let row = |o: &Overall| {
        (
            o.backend.clone(),
            o.bound,
            (100.0 * o.ratio_to_best).round(),
        )
    };
    let rows: Vec<_> = pool.groups[0].overall.iter().map(row).collect();
    let expected = [
        ("half-edge".to_owned(), false, 100.0),
        ("face-vertex".to_owned(), false, 200.0),
        ("polygon-soup".to_owned(), true, 10.0),
    ];
    assert_eq!(rows, expected);
    let bound = &pool.groups[0].overall[2];
    assert_eq!((bound.ci_low, bound.ci_high), (None, None));
    let said = &pool.sentences[1];
    let expected = "Queries, all meshes: half-edge is fastest on average (geometric mean over 3 meshes); \
                    face-vertex takes 2.00 × the time; not ranked, because a run would exceed the \
                    budget: polygon-soup (≥ 0.100 ×).";
    assert_eq!(said, expected);
}

/// Where a structure was not run that may be the fastest, the mesh decides nothing. The other meshes do.
#[test]
fn a_mesh_with_a_lower_bound_below_the_shortest_time_takes_no_part() {
    let decided = [("half-edge", 1000.0), ("corner-table", 3000.0)];
    let open = [("half-edge", -500.0), ("corner-table", 1000.0)];
    let pool = pool_of(&[
        ball("a", &decided),
        ball("b", &decided),
        ball("open", &open),
    ]);
    let found = ratios(pool.all());
    let expected = [("half-edge", 2, 0, 1.0), ("corner-table", 2, 0, 3.0)];
    assert_eq!(found, expected);
    let overall: Vec<(&str, usize, f64)> = pool.groups[0]
        .overall
        .iter()
        .map(|row| (row.backend.as_str(), row.meshes, row.ratio_to_best))
        .collect();
    let [first, second] = overall[..] else {
        panic!("two backends: {overall:?}");
    };
    assert_eq!(
        (first.0, first.1, second.0),
        ("half-edge", 2, "corner-table")
    );
    assert!((second.2 / first.2 - 3.0).abs() < 1e-9, "{overall:?}");
    // A bound above the shortest time shows that the structure is slower.
    let slow = [("half-edge", 1000.0), ("corner-table", -4000.0)];
    let pool = pool_of(&[ball("a", &decided), ball("slow", &slow)]);
    assert_eq!(pool.groups[0].overall[0].meshes, 2);
    assert_eq!(pool.groups[0].overall[0].undecided, 0);
}

/// If another method of a structure may be faster than its fastest measured one, its time is a lower bound.
#[test]
fn the_fastest_method_is_unknown_if_a_faster_one_may_exist() {
    let time = |method, ns: f64, backend: &str| ResultRow {
        elements: Some(10),
        median_ns: (ns > 0.0).then_some(ns),
        estimated_ns: (ns < 0.0).then_some(-ns),
        ..ResultRow::new(
            backend,
            Operation::Loop(method).name(),
            Operation::Loop(method).unit(),
        )
    };
    let mut study = ball("a", &[("half-edge", 1000.0), ("corner-table", 1000.0)]);
    study.results = vec![
        time(Method::Native, -300.0, "half-edge"),
        time(Method::Gather, 900.0, "half-edge"),
        time(Method::Native, 500.0, "corner-table"),
        time(Method::Gather, 800.0, "corner-table"),
    ];
    let rows = study.overall();
    let found: Vec<(&str, bool, f64)> = rows
        .iter()
        .map(|row| (row.backend.as_str(), row.bound, row.ratio_to_best))
        .map(|(name, bound, ratio)| (name, bound, (1e9 * ratio).round() / 1e9))
        .collect();
    assert_eq!(
        found,
        [("corner-table", false, 1.0), ("half-edge", true, 0.6)]
    );
    // A bound above the measured time says nothing new.
    study.results[0].estimated_ns = Some(2000.0);
    assert!(study.overall().iter().all(|row| !row.bound));
}

#[test]
fn several_lower_bounds_have_no_order() {
    let times = [
        ("polygon-soup", -5000.0),
        ("indexed-face-set", -4000.0),
        ("half-edge", 1000.0),
    ];
    let pool = pool_of(&[ball("a", &times)]);
    let said = &pool.sentences[1];
    assert!(
        said.ends_with("; the others take ≥ 4.00 × the time."),
        "{said}"
    );
    // Without a measured time there is nothing to compare.
    let mut study = ball("a", &times[1..]);
    study.results.pop();
    let pool = pool_of(&[study]);
    assert!(pool.all().is_empty() && pool.groups[0].overall.is_empty());
}

#[test]
fn means_are_over_the_meshes_that_all_compared_backends_hold() {
    let all = [("face-vertex", 2000.0), ("half-edge", 1000.0)];
    let mut refusing = ball("c", &[("face-vertex", 1000.0), ("half-edge", 9000.0)]);
    refusing.backends[1].holds = false;
    refusing.results.pop();
    refusing.results[0].ratio_to_best = Some(1.0);
    let studies = [ball("a", &all), ball("b", &all), refusing];
    let pool = pool_of(&studies);
    assert_eq!(
        ratios(pool.all()),
        [("face-vertex", 2, 0, 2.0), ("half-edge", 2, 0, 1.0)]
    );
    assert_eq!(pool.groups[0].meshes, ["a", "b"]);
    let holding: Vec<usize> = pool.holding.iter().map(|holding| holding.meshes).collect();
    assert_eq!(holding, [3, 2]);
    let first = &pool.sentences[0];
    assert!(
        first.contains("Of 3 studied, half-edge can hold 2"),
        "{first}"
    );
}

#[test]
fn a_backend_without_common_meshes_is_not_compared() {
    let (one, other) = ([("face-vertex", 1000.0), ("half-edge", 1000.0)], 0);
    let mut studies = [ball("a", &one), ball("b", &one), ball("c", &one)];
    studies[0].backends[1].holds = false;
    studies[1].backends[1].holds = false;
    studies[2].backends[other].holds = false;
    let pool = pool_of(&studies);
    assert_eq!(pool.compared, ["face-vertex"]);
    assert_eq!(pool.groups[0].meshes, ["a", "b"]);
    assert_eq!(pool_of(&[]), Pool::default());
}

#[test]
fn meshes_are_grouped_by_size_and_kind_with_equal_weight() {
    let large = |name: &str| {
        let mesh = shapes::triangle_torus(20, 20).expect("small");
        study_of(
            name,
            mesh,
            &[("face-vertex", 4000.0), ("half-edge", 1000.0)],
        )
    };
    let small = |name: &str| ball(name, &[("face-vertex", 1000.0), ("half-edge", 1000.0)]);
    let grid = study_of(
        "grid",
        shapes::grid(3, 4).expect("small"),
        &[("face-vertex", 1000.0), ("half-edge", 3000.0)],
    );
    let studies = [large("a"), small("b"), small("c"), small("d"), grid];
    let pool = pool_of(&studies);
    let names: Vec<&str> = pool
        .groups
        .iter()
        .map(|group| group.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "all meshes",
            "10 to 99 faces",
            "100 to 999 faces",
            "triangle meshes",
            "meshes with polygons",
            "closed meshes",
            "meshes with boundary",
        ]
    );
    assert_eq!(pool.groups[1].meshes, ["b", "c", "d", "grid"]);
    let face_vertex = |group: usize| {
        let mut rows = pool.groups[group].overall.iter();
        let row = rows
            .find(|row| row.backend == "face-vertex")
            .expect("compared");
        assert_eq!(row.purpose, Purpose::Query);
        row.ratio_to_best
    };
    // 1 on three small meshes and the grid, 4 on the large mesh: both sizes have equal weight. Half-edge is the fastest on
    // average: 1 on all but the grid, where it is 3. The means have three digits.
    let expected = 2.0 / 3_f64.powf(1.0 / 8.0);
    assert!(
        (face_vertex(0) - expected).abs() < 0.01,
        "{}",
        face_vertex(0)
    );
    assert!((face_vertex(2) - 4.0).abs() < 1e-9, "{}", face_vertex(2));
    assert!((face_vertex(4) - 1.0).abs() < 1e-9, "{}", face_vertex(4));
    let sentences = pool.sentences.join("\n");
    assert!(
        sentences.contains(
            "Queries, all meshes: it is undecided which is fastest on average of half-edge and face-vertex \
             (geometric mean over 5 meshes)."
        ),
        "{sentences}"
    );
    assert!(
        sentences.contains(
            "Queries, meshes with polygons: face-vertex is fastest on average (geometric mean over 1 \
             mesh); half-edge takes 3.00 × the time."
        ),
        "{sentences}"
    );
    assert!(
        !sentences.contains("triangle meshes"),
        "the same answer: {sentences}"
    );
}

/// If some backend refuses a mesh, the mean is not over all meshes.
#[test]
fn a_mean_over_fewer_meshes_is_not_called_a_mean_over_all() {
    let both = [("face-vertex", 4000.0), ("half-edge", 1000.0)];
    let mut studies = ["a", "b", "c"].map(|name| ball(name, &both));
    for backend in &mut studies[2].backends {
        backend.holds = backend.name != "half-edge";
    }
    let pool = pool_of(&studies);
    assert_eq!(
        pool.groups[0].name,
        "meshes that all compared backends can hold"
    );
    let sentences = pool.sentences.join("\n");
    assert!(!sentences.contains(", all meshes"), "{sentences}");
    assert!(
        sentences.contains("(geometric mean over 2 meshes)"),
        "{sentences}"
    );
}

#[test]
fn subdivision_is_compared_with_the_fastest_method_of_each_backend() {
    let mut study = ball("a", &[("face-vertex", 1000.0), ("half-edge", 1000.0)]);
    let row = |backend: &str, method, ns| ResultRow {
        median_ns: Some(ns),
        ..ResultRow::new(
            backend,
            Operation::Loop(method).name(),
            Operation::Loop(method).unit(),
        )
    };
    use sixfold::subdivision::Method;
    study.results = vec![
        row("face-vertex", Method::Gather, 900.0),
        row("face-vertex", Method::Scatter, 600.0),
        row("half-edge", Method::Gather, 800.0),
        row("half-edge", Method::Native, 300.0),
    ];
    let pool = pool_of(&[study]);
    let found: Vec<(&str, Purpose, f64)> = pool.groups[0]
        .overall
        .iter()
        .map(|row| (row.backend.as_str(), row.purpose, row.ratio_to_best))
        .collect();
    let subdivide = Purpose::Subdivide;
    assert_eq!(
        found,
        [
            ("half-edge", subdivide, 1.0),
            ("face-vertex", subdivide, 2.0)
        ]
    );
}

/// The fastest methods differ, and each is the fastest of its operation: the error is that of their quotient.
#[test]
fn the_mean_of_two_methods_has_the_interval_of_their_quotient() {
    let mut study = ball("a", &[("face-vertex", 1000.0), ("half-edge", 1000.0)]);
    let row = |backend: &str, method, ns, launches: [f64; 3]| ResultRow {
        median_ns: Some(ns),
        elements: Some(1),
        ns_per_element: Some(ns),
        ratio_to_best: Some(1.0),
        launch_ns: launches.map(|factor| Some(ns * factor)).into(),
        ..ResultRow::new(
            backend,
            Operation::Loop(method).name(),
            Operation::Loop(method).unit(),
        )
    };
    let ends = |study: &Report| {
        let rows = study.overall();
        assert_eq!(rows[1].backend, "face-vertex");
        let [low, high] = rows[1].ends().expect("three launches");
        assert!(low < 2.0 && 2.0 < high, "{low} to {high}");
        (high / low, leaders(&rows).len())
    };
    study.results = vec![
        row("face-vertex", Method::Scatter, 600.0, [1.0, 1.02, 0.98]),
        row("half-edge", Method::Native, 300.0, [1.0; 3]),
    ];
    let (narrow, leading) = ends(&study);
    assert!(1.05 < narrow && narrow < 2.0, "{narrow}");
    assert_eq!(leading, 1);
    study.results[0] = row("face-vertex", Method::Scatter, 600.0, [1.0, 2.0, 0.5]);
    let (wide, leading) = ends(&study);
    assert!(wide > 4.0, "{wide}");
    assert_eq!(leading, 2);
    // Without a launch in common, the errors of both times count.
    study.results[0].launch_ns = vec![None, None, None, Some(600.0)];
    (study.results[0].ci_low_ns, study.results[0].ci_high_ns) = (Some(500.0), Some(720.0));
    (study.results[1].ci_low_ns, study.results[1].ci_high_ns) = (Some(200.0), Some(450.0));
    let (apart, _) = ends(&study);
    let expected = 1.2_f64.ln().hypot(1.5_f64.ln()) * 2.0;
    assert!((apart.ln() - expected).abs() < 1e-9, "{apart}");
}

/// One that is surely slower does not hide a slower one that may be as fast as the first.
#[test]
fn a_backend_leads_by_its_own_interval() {
    let mut study = ball(
        "a",
        &[
            ("half-edge", 100.0),
            ("corner-table", 200.0),
            ("face-vertex", 300.0),
        ],
    );
    for row in &mut study.results {
        let launches = match row.backend.as_str() {
            "face-vertex" => [0.1, 1.0, 10.0],
            _ => [1.0, 1.01, 0.99],
        };
        let ns = row.median_ns.expect("measured");
        row.ns_per_element = Some(ns / 10.0);
        row.launch_ns = launches.map(|factor| Some(ns * factor)).into();
    }
    let rows = study.overall();
    let names: Vec<&str> = leaders(&rows).iter().map(|row| &*row.backend).collect();
    assert_eq!(names, ["half-edge", "face-vertex"]);
    let next = next_row(&rows).expect("a slower one");
    assert_eq!(next.backend, "corner-table");
}

#[test]
fn without_intervals_a_difference_on_one_mesh_is_clear_from_a_ratio_of_2() {
    for (corner_table, leading) in [(190.0, 2), (210.0, 1)] {
        let mut study = ball("a", &[("half-edge", 100.0), ("corner-table", corner_table)]);
        for row in &mut study.results {
            (row.ratio_ci_low, row.ratio_ci_high) = (None, None);
            (row.ci_low_ns, row.ci_high_ns) = (None, None);
        }
        study.samples.clear();
        assert_eq!(leaders(&study.overall()).len(), leading, "{corner_table}");
    }
}

/// Face-vertex is faster than half-edge on one of two meshes, but slower than winged-edge on both.
#[test]
fn the_leaders_of_means_are_not_slower_than_each_other() {
    let times = [("a", [100.0, 142.0, 180.0]), ("b", [100.0, 72.0, 86.0])];
    let studies = times.map(|(name, [half_edge, winged_edge, face_vertex])| {
        ball(
            name,
            &[
                ("half-edge", half_edge),
                ("winged-edge", winged_edge),
                ("face-vertex", face_vertex),
            ],
        )
    });
    let pool = pool_of(&studies);
    let rows = &pool.groups[0].overall;
    let names: Vec<&str> = leaders(rows).iter().map(|row| &*row.backend).collect();
    assert_eq!(names, ["half-edge", "winged-edge"]);
    let ends = rows[2].ends().expect("two meshes");
    assert!(ends[0] < 1.0 && ends[1] > 1.7, "{ends:?}");
}

#[test]
fn warnings_of_one_kind_are_merged_and_the_worst_is_shown() {
    let mut studies = ["a", "b", "c", "d"].map(|name| ball(name, &[("half-edge", 1.0)]));
    studies[0].warnings = vec!["Other.".into()];
    studies[1].warnings = vec!["Times differ by 4 %. Worst: x.".into(), "Load 2.5.".into()];
    studies[2].warnings = vec![
        "Times differ by 13 %. Worst: y.".into(),
        "Load 13.1.".into(),
    ];
    studies[3].warnings = vec!["Times differ by 9 %. Worst: z.".into()];
    assert_eq!(
        pool_of(&studies).warnings,
        [
            "c: Times differ by 13 %. Worst: y. Similar on b and d.",
            "c: Load 13.1. Similar on b.",
            "a: Other."
        ]
    );
}

#[test]
fn a_share_is_worse_than_a_smaller_one_of_more() {
    let mut studies = ["a", "b"].map(|name| ball(name, &[("half-edge", 1.0)]));
    studies[0].warnings = vec!["120 of 200 times are wide.".into()];
    studies[1].warnings = vec!["30 of 40 times are wide.".into()];
    assert_eq!(
        pool_of(&studies).warnings,
        ["b: 30 of 40 times are wide. Similar on a."]
    );
}

/// A mean has the number of meshes on which the backend alone is the fastest, or one of several.
#[test]
fn means_count_the_meshes_on_which_each_backend_is_the_fastest() {
    let mesh = |name, half_edge, corner_table, soup| {
        let times = [
            ("half-edge", half_edge),
            ("corner-table", corner_table),
            ("polygon-soup", soup),
        ];
        ball(name, &times)
    };
    let mut studies = [
        mesh("clear", 1000.0, 2000.0, 9000.0),
        mesh("also clear", 1000.0, 1500.0, 9000.0),
        // Two do not differ by more than 5 %.
        mesh("tied", 1030.0, 1000.0, 9000.0),
        mesh("other", 2000.0, 1000.0, 9000.0),
    ];
    for study in &mut studies {
        for row in &mut study.results {
            // Narrow intervals.
            let ratio = row.ratio_to_best.expect("measured");
            (row.ratio_ci_low, row.ratio_ci_high) = (Some(0.999 * ratio), Some(1.001 * ratio));
        }
    }
    let counts = |studies: &[Report]| {
        let pool = pool_of(studies);
        let mut counts: Vec<(String, usize, usize)> = pool.groups[0]
            .overall
            .iter()
            .map(|row| (row.backend.clone(), row.best, row.tied))
            .collect();
        counts.sort();
        counts
    };
    let expected = |counts: [(&str, usize, usize); 3]| {
        counts.map(|(name, best, tied)| (name.to_owned(), best, tied))
    };
    let all = [
        ("corner-table", 1, 1),
        ("half-edge", 2, 1),
        ("polygon-soup", 0, 0),
    ];
    assert_eq!(counts(&studies), expected(all));
    let one = [
        ("corner-table", 0, 0),
        ("half-edge", 1, 0),
        ("polygon-soup", 0, 0),
    ];
    assert_eq!(counts(&studies[..1]), expected(one));
    // Too few samples decide nothing, and a mesh that takes no part is not counted.
    let mut few = studies.clone();
    few[0]
        .results
        .iter_mut()
        .for_each(|row| row.standing = None);
    few[1].results.clear();
    let pool = pool_of(&few);
    for row in &pool.groups[0].overall {
        assert_eq!((row.meshes, row.undecided), (3, 1), "{row:?}");
        assert!(row.best + row.tied <= 2, "{row:?}");
    }
    // The means of some backends are relative to the fastest of these.
    let some = studies[0].overall_of(&["polygon-soup", "corner-table"]);
    let ratios: Vec<(&str, f64)> = some
        .iter()
        .map(|row| (row.backend.as_str(), row.ratio_to_best))
        .collect();
    assert_eq!(ratios, [("corner-table", 1.0), ("polygon-soup", 4.5)]);
}

/// A reader who divides two shown times of one mesh gets its ratio, also that of which means over meshes are made.
#[test]
fn ratios_are_quotients_of_shown_times_per_element() {
    let mut study = ball("a", &[("half-edge", 1000.0), ("corner-table", 4000.0)]);
    for row in &mut study.results {
        row.elements = Some(30);
    }
    let ratio = |rows: &[Overall]| rows[1].ratio_to_best;
    // 133 ns and 33.3 ns.
    assert!((ratio(&study.overall()) - 133.0 / 33.3).abs() < 1e-12);
    let mut other = study.clone();
    other.mesh.name = "b".into();
    let pool = pool_of(&[study, other]);
    let overall = &pool.groups[0].overall;
    assert!((ratio(overall) - 133.0 / 33.3).abs() < 1e-12);
    assert_eq!(overall[1].ends(), Some([133.0 / 33.3; 2]));
}
