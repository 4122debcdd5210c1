//! Runs the order lab and the growth lab with small budgets, so that scans are sampled.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use sixfold::shapes::{self, Order};
use sixfold::{Facts, PolygonMesh};
use sixfold_study::{
    Agreement, GrowthError, GrowthReport, GrowthSettings, Operation, OrdersError, OrdersReport,
    Settings, StudyError, StudyMesh, growth, orders,
};

/// Returns a mesh of irregular triangles. Different elements then give different sums.
fn blobs() -> PolygonMesh {
    let generator = shapes::generator("blobs").expect("a known shape");
    generator.build(&[("faces", 1500.0)]).expect("a valid size")
}

fn quick_orders(mesh: PolygonMesh, settings: &Settings) -> Result<OrdersReport, OrdersError> {
    let study_mesh = StudyMesh::new("test", mesh);
    orders(&study_mesh, settings, &AtomicBool::new(false), &mut |_| ())
}

fn brief(milliseconds: u64, operations: &[&str]) -> Settings {
    let parsed = operations.iter().map(|name| name.parse().expect("a name"));
    Settings {
        budget: Duration::from_millis(milliseconds),
        operations: parsed.collect(),
        seed: 3,
        ..Settings::default()
    }
}

#[test]
fn every_order_does_the_same_work_on_every_structure() {
    let mesh = blobs();
    let facts = Facts::from_polygons(&mesh);
    let names = [
        "vertex_vertices",
        "edge_faces",
        "vertex_normal",
        "ff_bfs",
        "edge_length",
    ];
    let report = quick_orders(mesh, &brief(400, &names)).expect("all backends hold it");
    assert_eq!(report.results.len(), names.len() * 6 * 4);
    assert_eq!(report.mismatches(), 0, "{:?}", report.sentences);
    let mut sampled = 0;
    for row in &report.results {
        let context = format!(
            "{} on {}, {}",
            row.row.operation, row.row.backend, row.order
        );
        match row.row.estimated_ns {
            Some(_) => assert_eq!(row.row.operation, Operation::FfBfs, "{context}"),
            None => assert_eq!(row.row.agreement, Agreement::Same, "{context}: {row:?}"),
        }
        sampled += usize::from(row.row.sampled);
        let elements = match row.row.per.as_str() {
            "vertex" => facts.vertices,
            "edge" => facts.edges,
            _ => facts.faces,
        };
        assert_eq!(row.row.elements, Some(elements as u64), "{context}");
    }
    assert!(sampled >= 8, "{sampled} sampled");
    // The result of `ff_bfs` depends on the first face, so structures are compared for each order.
    let walked = |order: Order| {
        let rows = report.rows(Operation::FfBfs);
        let sums = rows
            .filter(|r| r.order == order)
            .filter_map(|r| r.row.checksum);
        let mut sums: Vec<u64> = sums.map(|sum| sum as u64).collect();
        sums.dedup();
        sums
    };
    let walks = Order::ALL.map(walked);
    assert!(walks.iter().all(|sums| sums.len() == 1), "{walks:?}");
    assert_ne!(walks[0], walks[1], "the first faces differ");
}

#[test]
fn orders_are_ranked_within_a_structure_and_compared_between_them() {
    let report = quick_orders(blobs(), &brief(400, &["vertex_faces", "face_vertices"]));
    let report = report.expect("all backends hold it");
    assert_eq!(report.orders, Order::ALL);
    for backend_rows in report
        .results
        .chunk_by(|a, b| a.row.operation == b.row.operation && a.row.backend == b.row.backend)
    {
        let backend_rows: Vec<Order> = backend_rows.iter().map(|row| row.order).collect();
        assert_eq!(backend_rows, Order::ALL);
    }
    for pair in report.results.chunks(4) {
        let ratios = pair.iter().filter_map(|r| r.row.ratio_to_best);
        assert_eq!(ratios.reduce(f64::min), Some(1.0), "{pair:?}");
    }
    assert_eq!(report.comparisons.len(), 2);
    let [vertex_faces, face_vertices] = &report.comparisons[..] else {
        panic!("two operations")
    };
    let scanning = |c: &sixfold_study::Comparison| c.orders.iter().filter(|o| o.scans).count();
    // Two structures scan all faces around a vertex. No structure scans for the vertices of a face.
    assert_eq!((scanning(vertex_faces), scanning(face_vertices)), (2, 0));
    for comparison in &report.comparisons {
        assert_eq!(comparison.orders.len(), 6);
        assert!(comparison.structures.is_some() && comparison.larger.is_some());
        assert!(comparison.noise >= 1.02);
    }
    let sentences = report.sentences.join(" ");
    assert!(
        sentences.contains("Of 12 pairs") && sentences.contains("measured twice"),
        "{sentences}"
    );
    assert!(
        report
            .control
            .is_some_and(|control| control.operations.len() == 2)
    );
}

#[test]
fn unsuitable_meshes_are_refused() {
    let refusal = |mesh, settings: &Settings| quick_orders(mesh, settings).expect_err("refused");
    let points = PolygonMesh::new([sixfold::Point::ZERO], [[0; 0]; 0]).expect("a point");
    let empty = refusal(points, &brief(100, &[]));
    assert_eq!(empty, OrdersError::Study(StudyError::NoFaces));
    let mut triangles_only = brief(100, &[]);
    triangles_only.backends = vec!["corner-table".into()];
    let refused = refusal(shapes::cube(), &triangles_only);
    assert!(matches!(
        refused,
        OrdersError::Study(StudyError::NoneHolds { .. })
    ));
    let report =
        quick_orders(shapes::cube(), &brief(100, &["face_vertices"])).expect("five hold it");
    assert_eq!(report.results.len(), 5 * 4);
    assert!(
        report
            .backends
            .iter()
            .any(|b| !b.holds && b.name == "corner-table")
    );
}

fn small() -> GrowthSettings {
    GrowthSettings {
        study: brief(2000, &["vertex_vertices", "face_vertices"]),
        shape: "triangle-torus".into(),
        from: 400,
        to: 12_800,
        steps: 4,
        ..GrowthSettings::default()
    }
}

fn quick_growth(settings: &GrowthSettings) -> Result<GrowthReport, GrowthError> {
    growth(settings, &AtomicBool::new(false), &mut |_| ())
}

#[test]
fn scans_grow_quadratically_and_local_queries_linearly() {
    let report = quick_growth(&small()).expect("all backends hold it");
    let faces: Vec<usize> = report.sizes.iter().map(|size| size.faces).collect();
    assert_eq!(faces.len(), 4);
    assert!(faces.is_sorted() && faces[0].abs_diff(400) < 40 && faces[3].abs_diff(12_800) < 1280);
    assert_eq!(report.mismatches(), 0, "{:?}", report.sentences);
    assert_eq!(report.fits.len(), 2 * 6);
    for fit in &report.fits {
        let slope = fit.all.expect("four sizes");
        assert_eq!(slope.sizes, 4);
        let scans = fit.operation.name() == "vertex_vertices"
            && ["polygon-soup", "indexed-face-set"].contains(&fit.backend.as_str());
        assert_eq!(fit.scans, scans, "{fit:?}");
        let expected = if scans { 1.6..2.4 } else { 0.6..1.4 };
        assert!(expected.contains(&slope.exponent), "{fit:?}");
    }
    for size in &report.sizes {
        assert_eq!(size.backend_bytes.len(), 6);
        let (v, f) = (size.vertices as i64, size.faces as i64);
        assert_eq!(v - size.edges as i64 + f, 0, "a torus");
    }
    // Each of the six structures has one row for each data cache.
    let data = report.caches.iter().filter(|cache| cache.holds_data());
    assert_eq!(report.cache_limits.len(), 6 * data.count());
    let sentences = report.sentences.join(" ");
    assert!(
        sentences.contains("face_vertices: ") && sentences.contains("to the power"),
        "{sentences}"
    );
}

#[test]
fn finished_sizes_are_kept_after_a_stop() {
    let stop = AtomicBool::new(false);
    let mut seen: Option<String> = None;
    let report = growth(&small(), &stop, &mut |at| {
        let size = at.stage.split(' ').next().map(str::to_owned);
        if seen.is_some() && seen != size {
            stop.store(true, Ordering::Relaxed); // the second size has begun
        }
        seen = size;
    });
    let report = report.expect("an interruption is not an error");
    assert!(report.interrupted);
    assert_eq!(report.sizes.len(), 1);
    assert!(
        report.fits.iter().all(|fit| fit.all.is_none()),
        "one size gives no line"
    );
    let report = growth(&small(), &AtomicBool::new(true), &mut |_| ()).expect("a report");
    assert!(report.interrupted && report.sizes.is_empty() && report.fits.is_empty());
}

#[test]
fn sizes_beyond_the_budget_are_left_out_and_listed() {
    let mut settings = small();
    settings.study = brief(400, &["face_vertices"]);
    settings.study.backends = vec!["corner-table".into()];
    (settings.from, settings.to) = (400, 40_000_000);
    let start = std::time::Instant::now();
    let report = quick_growth(&settings).expect("it holds triangles");
    // Making the largest mesh takes several seconds.
    assert!(
        start.elapsed() < Duration::from_secs(8),
        "{:?}",
        start.elapsed()
    );
    assert!(!report.interrupted && !report.sizes.is_empty());
    assert_eq!(report.left_out.last(), Some(&40_000_000));
    assert_eq!(report.left_out.len() + report.sizes.len(), 4);
    let sentences = report.sentences.join(" ");
    assert!(
        sentences.contains("too short to measure sizes of about")
            && sentences.contains("40,000,000"),
        "{sentences}"
    );
    let all = quick_growth(&small()).expect("all backends hold it");
    assert!(all.left_out.is_empty(), "{:?}", all.left_out);
}

#[test]
fn growth_of_a_quad_shape_excludes_corner_tables() {
    let mut settings = small();
    settings.shape = "torus".into();
    settings.study.operations.remove(0);
    let report = quick_growth(&settings).expect("five hold quads");
    assert_eq!((report.backends.len(), report.refused_by.len()), (5, 1));
    assert_eq!(report.refused_by[0].backend, "corner-table");
    settings.study.backends = vec!["corner-table".into()];
    let refused = quick_growth(&settings).err();
    assert!(matches!(
        refused,
        Some(GrowthError::Study(StudyError::NoneHolds { .. }))
    ));
    // All sizes between these limits give the same mesh.
    settings = small();
    (settings.from, settings.to) = (400, 401);
    assert_eq!(
        quick_growth(&settings).err(),
        Some(GrowthError::OneSize { from: 400, to: 401 })
    );
}
