use proptest::prelude::*;
use sixfold_conformance::gallery;
use sixfold_conformance::strategy::{any_capabilities, any_mesh, faulty_mesh};
use sixfold_core::Facts;

use super::*;
use crate::outcome::Left;
use crate::step::repair;

fn count(diagnosis: &Diagnosis, kind: FaultKind) -> usize {
    diagnosis.fault(kind).map_or(0, |fault| fault.count)
}

fn damaged() -> impl Strategy<Value = PolygonMesh> {
    prop_oneof![any_mesh(), faulty_mesh().prop_map(|faulty| faulty.polygons)]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// A structure refuses a mesh exactly if the diagnosis has a refusal for it.
    #[test]
    fn refusals_are_those_of_the_check(polygons in damaged(), capabilities in any_capabilities()) {
        let diagnosis = diagnose(&polygons, 2);
        let refused = diagnosis.refusals(&capabilities).next().is_some();
        prop_assert_eq!(refused, capabilities.check(&polygons).is_err());
        for fault in &diagnosis.faults {
            prop_assert!(fault.count > 0 && fault.places.len() == fault.count.min(2));
        }
    }

    /// A check accepts the meshes that facts show to be good.
    #[test]
    fn facts_show_no_more_than_the_check(polygons in damaged(), capabilities in any_capabilities()) {
        let facts = Facts::from_polygons(&polygons);
        if capabilities.is_satisfied_by(&facts) {
            prop_assert_eq!(capabilities.check(&polygons), Ok(()));
        } else if facts.non_manifold_edges == 0 && capabilities.coincident_vertices {
            prop_assert!(capabilities.check(&polygons).is_err());
        }
    }

    /// The numbers agree with the facts, which are computed independently.
    #[test]
    fn numbers_agree_with_facts(polygons in damaged()) {
        let diagnosis = diagnose(&polygons, 0);
        let facts = Facts::from_polygons(&polygons);
        let count = |kind| count(&diagnosis, kind);
        prop_assert_eq!(count(FaultKind::NonManifoldEdge), facts.non_manifold_edges);
        prop_assert_eq!(count(FaultKind::BoundaryEdge), facts.boundary_edges);
        prop_assert_eq!(count(FaultKind::IsolatedVertex), facts.isolated_vertices);
        prop_assert_eq!(count(FaultKind::NotOrientable) == 0, facts.orientable != Some(false));
        prop_assert!(count(FaultKind::DuplicateFace) <= facts.duplicate_faces);
        prop_assert_eq!(count(FaultKind::RepeatedSide), facts.inconsistent_edges);
    }

    /// Polygons cross themselves exactly if their triangulation says so.
    #[test]
    fn crossing_faces_are_those_of_the_triangulation(polygons in damaged()) {
        let crossing = polygons.triangulated().expect("small").crossing;
        prop_assert_eq!(count(&diagnose(&polygons, 0), FaultKind::CrossingFace), crossing.len());
        prop_assert_eq!(polygons.crossing_faces(), crossing);
    }

    /// Computing facts and diagnosis together does not change them.
    #[test]
    fn both_together_equal_each_alone(polygons in damaged()) {
        let (facts, measured, diagnosis) = examine(&polygons, 3);
        prop_assert_eq!(facts, Facts::from_polygons(&polygons));
        prop_assert_eq!(diagnosis, diagnose(&polygons, 3));
        prop_assert_eq!(measured, crate::measures(&polygons));
    }

    /// The steps that a diagnosis names repair the fault. A hole can remain if no triangles fit, and a
    /// face without area if an edge would open.
    #[test]
    fn the_named_steps_repair_the_fault(polygons in damaged()) {
        let diagnosis = diagnose(&polygons, 1);
        for fault in &diagnosis.faults {
            let repaired = repair(&polygons, &diagnosis.repairs(fault.kind)).expect("small");
            let after = diagnose(&repaired.polygons, 1);
            let remain = repaired.steps.iter().flat_map(|step| &step.left);
            let flat = remain.filter(|left| matches!(left, Left::FlatFace { .. })).count();
            match fault.kind {
                FaultKind::BoundaryEdge => {}
                // Only other corners repair these.
                FaultKind::CrossingFace | FaultKind::TouchingComponent => prop_assert_eq!(&repaired.polygons, &polygons),
                FaultKind::FlatFace => prop_assert_eq!(count(&after, fault.kind), flat),
                _ => prop_assert_eq!(after.fault(fault.kind), None),
            }
        }
    }
}

#[test]
fn the_kinds_are_in_the_order_of_their_numbers() {
    for (i, kind) in FaultKind::ALL.into_iter().enumerate() {
        assert_eq!(kind as usize, i);
    }
}

#[test]
fn a_mesh_without_shared_vertices_looks_unwelded() {
    for entry in gallery() {
        let mesh = entry.polygons;
        let corners = mesh.faces().corners().iter().map(|&v| mesh.position(v));
        let faces = mesh.faces().iter().map(|(f, _)| {
            let range = mesh.faces().range(f);
            (range.start as u32..range.end as u32).collect::<Vec<_>>()
        });
        let separate = PolygonMesh::new(corners, faces).expect("valid");
        let facts = Facts::from_polygons(&mesh);
        let diagnosis = diagnose(&separate, 1);
        if facts.closed && facts.consistently_oriented == Some(true) {
            assert!(diagnosis.looks_unwelded(), "{}", entry.name);
        }
        if facts.faces > 0 && facts.edges == facts.boundary_edges && diagnosis.seam_edges == 0 {
            assert!(!diagnosis.looks_unwelded(), "{}", entry.name);
        }
    }
    assert!(!diagnose(&sixfold_shapes::cube(), 1).looks_unwelded());
    let grid = sixfold_shapes::grid(4, 4).expect("small");
    assert!(!diagnose(&grid, 1).looks_unwelded());
}
