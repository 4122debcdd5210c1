//! Whole measurements of orders on a simulated machine.

use sixfold::PolygonMesh;
use sixfold::{Facts, shapes};
use sixfold_results::Agreement;

use super::*;
use crate::engine::effort::Effort;
use crate::engine::simulated_machine::{SimulatedMachine, Work};
use sixfold_results::Finding;

/// Returns a mesh of irregular triangles. Different elements then give different sums.
fn blobs() -> PolygonMesh {
    let generator = shapes::generator("blobs").expect("a known shape");
    generator.build(&[("faces", 1500.0)]).expect("a valid size")
}

fn quick(mesh: PolygonMesh, settings: &Settings) -> Result<OrdersReport, StudyError> {
    quick_on(&SimulatedMachine::usual(), mesh, settings)
}

fn quick_on(
    machine: &SimulatedMachine,
    mesh: PolygonMesh,
    settings: &Settings,
) -> Result<OrdersReport, StudyError> {
    let study_mesh = StudyMesh::new("test", mesh);
    let stop = AtomicBool::new(false);
    orders_on(machine, &study_mesh, settings, &stop, &mut |_| ())
}

fn settings(effort: Effort, operations: &[&str]) -> Settings {
    let parsed = operations.iter().map(|name| name.parse().expect("a name"));
    Settings {
        effort,
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
    // On two structures, three operations scan, each in four orders.
    for (effort, sampled, estimated) in [
        (Effort::of_ms(400), 2 * 3 * 4, 0),
        (Effort::of_rounds(1), 2 * 3 * 4, 0),
    ] {
        let report = quick(mesh.clone(), &settings(effort, &names));
        let report = report.expect("all backends hold it");
        assert_eq!(report.results.len(), names.len() * 6 * 4);
        let finding = Finding::from(report.clone());
        assert_eq!(finding.mismatches(), 0, "{:?}", report.sentences);
        let rows = || report.results.iter();
        assert_eq!(
            rows().filter(|row| row.sampled).count(),
            sampled,
            "{effort:?}"
        );
        let estimates = rows().filter(|row| row.estimated_ns.is_some()).count();
        assert_eq!(estimates, estimated, "{effort:?}");
        for row in &report.results {
            let order = &row.case;
            let context = format!("{} on {}, {order}", row.operation, row.backend);
            assert_eq!(row.agreement, Agreement::Same, "{context}: {row:?}");
            let elements = match row.per.as_str() {
                "vertex" => facts.vertices,
                "edge" => facts.edges,
                _ => facts.faces,
            };
            assert_eq!(row.elements, Some(elements as u64), "{context}");
        }
        // The result of `ff_bfs` depends on the first face, so structures are compared for each
        // order.
        let walked = |order: Order| {
            let rows = report.rows(Operation::FfBfs.name());
            let sums = rows
                .filter(|r| r.case == order.name())
                .filter_map(|r| r.checksum);
            let mut sums: Vec<u64> = sums.map(|sum| sum as u64).collect();
            sums.dedup();
            sums
        };
        let walks = Order::ALL.map(walked);
        assert!(walks.iter().all(|sums| sums.len() == 1), "{walks:?}");
        assert_ne!(walks[0], walks[1], "the first faces differ");
    }
}

#[test]
fn a_walk_that_takes_too_long_is_estimated_in_every_order() {
    // A walk on a structure that scans takes 107 ms on this machine, which is more than half of the
    // budget.
    let machine = SimulatedMachine::usual().at_speed(0.02);
    let report = quick_on(
        &machine,
        blobs(),
        &settings(Effort::of_ms(200), &["ff_bfs"]),
    );
    let report = report.expect("all backends hold it");
    for row in &report.results {
        let order = &row.case;
        let scans = ["polygon-soup", "indexed-face-set"].contains(&row.backend.as_str());
        let context = format!("{} in order {order}: {row:?}", row.backend);
        assert_eq!(row.estimated_ns.is_some(), scans, "{context}");
        let agreement = match scans {
            true => Agreement::Unchecked,
            false => Agreement::Same,
        };
        assert_eq!(row.agreement, agreement, "{context}");
    }
}

#[test]
fn orders_are_ranked_within_a_structure_and_compared_between_them() {
    // The structures are placed one after the other, each in all four orders. The last two orders
    // take 1.5 times as long, but only on half-edge.
    let machine = SimulatedMachine::with_costs(|work: &Work<'_>| {
        let slow = work.backend == "half-edge" && work.place % 4 >= 2;
        work.usual_ns() * if slow { 1.5 } else { 1.0 }
    });
    let names = ["vertex_faces", "face_vertices"];
    let report = quick_on(&machine, blobs(), &settings(Effort::of_ms(2000), &names));
    let report = report.expect("all backends hold it");
    assert_eq!(report.orders, Order::ALL.map(Order::name));
    for rows in report
        .results
        .chunk_by(|a, b| a.operation == b.operation && a.backend == b.backend)
    {
        let orders: Vec<&str> = rows.iter().map(|row| row.case.as_str()).collect();
        assert_eq!(orders, Order::ALL.map(Order::name));
        let ratios: Vec<f64> = rows.iter().filter_map(|r| r.ratio_to_best).collect();
        let slow = match rows[0].backend.as_str() {
            "half-edge" => 1.5,
            _ => 1.0,
        };
        for (found, expected) in ratios.iter().zip([1.0, 1.0, slow, slow]) {
            assert!((found - expected).abs() < 1e-6, "{ratios:?}: {rows:?}");
        }
    }
    assert_eq!(report.comparisons.len(), 2);
    let [vertex_faces, face_vertices] = &report.comparisons[..] else {
        panic!("two operations")
    };
    let scanning = |c: &Comparison| c.orders.iter().filter(|o| o.scans).count();
    // Two structures scan all faces around a vertex. No structure scans for the vertices of a face.
    assert_eq!((scanning(vertex_faces), scanning(face_vertices)), (2, 0));
    for comparison in &report.comparisons {
        assert_eq!(comparison.orders.len(), 6);
        assert!(comparison.structures.is_some() && comparison.larger.is_some());
        assert_eq!(comparison.noise, 1.02);
    }
    let sentences = report.sentences.join(" ");
    assert!(
        sentences.contains("in 12 of 12 pairs")
            && sentences.contains("given 0 and 12, ")
            && sentences.contains("up to 1.50 × (")
            && sentences.contains("How sure: two measurements of"),
        "{sentences}"
    );
    assert!(
        report
            .control
            .is_some_and(|control| control.operations.len() == 2)
    );
    // The control is a structure in the given order.
    let second = report.samples.iter().filter(|samples| samples.control);
    let second: Vec<(&str, &str)> = second
        .map(|samples| (samples.backend.as_str(), samples.case.as_str()))
        .collect();
    assert_eq!(second, [("face-vertex", "given"); 2]);
}

#[test]
fn unsuitable_meshes_are_refused() {
    let refusal = |mesh, settings: &Settings| quick(mesh, settings).expect_err("refused");
    let one_round = |names: &[&str]| settings(Effort::of_rounds(1), names);
    let points = PolygonMesh::new([sixfold::Point::ZERO], [[0; 0]; 0]).expect("a point");
    let empty = refusal(points, &one_round(&[]));
    assert_eq!(empty, StudyError::NoFaces);
    let mut triangles_only = one_round(&[]);
    triangles_only.backends = vec!["corner-table".into()];
    let refused = refusal(shapes::cube(), &triangles_only);
    assert!(matches!(refused, StudyError::NoneHolds { .. }));
    let report = quick(shapes::cube(), &one_round(&["face_vertices"])).expect("five hold it");
    assert_eq!(report.results.len(), 5 * 4);
    assert!(
        report
            .backends
            .iter()
            .any(|b| !b.holds && b.name == "corner-table")
    );
}
