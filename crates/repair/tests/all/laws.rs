//! Laws of repairs, on random damaged meshes.

use std::collections::{BTreeSet, HashSet};

use proptest::collection;
use proptest::prelude::*;
use sixfold_conformance::strategy::{
    any_capabilities, any_mesh, faulty_mesh, manifold_mesh, touching_polygon,
};
use sixfold_core::glam::DVec3;
use sixfold_core::{
    FaceId, Facts, Incidence, MeshQuery, PolygonCutter, PolygonMesh, Representation, VertexId,
    area_vector,
};
use sixfold_corner_table::CornerTable;
use sixfold_face_vertex::FaceVertexMesh;
use sixfold_half_edge::HalfEdgeMesh;
use sixfold_indexed_face_set::IndexedFaceSet;
use sixfold_polygon_soup::PolygonSoup;
use sixfold_repair::{
    Components, Facing, FillHoles, HoleFilling, Left, OppositeFaces, Repaired, Step, StepCounts,
    Tolerance, Weld, WeldMethod, diagnose, repair, repair_for,
};
use sixfold_winged_edge::WingedEdgeMesh;

/// Generates meshes with faults of many kinds.
fn damaged() -> impl Strategy<Value = PolygonMesh> {
    let mesh = prop_oneof![
        2 => any_mesh(),
        2 => faulty_mesh().prop_map(|faulty| faulty.polygons),
        1 => manifold_mesh(),
    ];
    let damages = collection::vec((0..5_u8, any::<u16>()), 0..4);
    (mesh, damages).prop_map(|(mesh, damages)| {
        damages
            .into_iter()
            .fold(mesh, |mesh, (kind, at)| damage(&mesh, kind, at as usize))
    })
}

/// Adds one fault to a mesh; `at` chooses the place.
fn damage(mesh: &PolygonMesh, kind: u8, at: usize) -> PolygonMesh {
    let mut points: Vec<[f32; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
    let mut faces: Vec<Vec<u32>> = faces_of(mesh);
    if faces.is_empty() {
        return mesh.clone();
    }
    let f = at % faces.len();
    match kind {
        // A corner gets a vertex of its own, at the same position or nearby.
        0 => {
            let corner = at % faces[f].len();
            let mut point = points[faces[f][corner] as usize];
            point[0] += if at.is_multiple_of(3) { 1e-3 } else { 0.0 };
            faces[f][corner] = points.len() as u32;
            points.push(point);
        }
        // Every corner gets a vertex of its own.
        1 => {
            let corners = faces.iter().flatten().map(|&v| points[v as usize]);
            points = corners.collect();
            let numbers: Vec<u32> = (0..points.len() as u32).collect();
            let mut rest = &numbers[..];
            for face in &mut faces {
                let (own, others) = rest.split_at(face.len());
                (*face, rest) = (own.to_vec(), others);
            }
        }
        2 => faces[f].reverse(),
        // A face that shares the vertices of two faces.
        3 => {
            let other = faces[(f + 1) % faces.len()][0];
            let [a, b] = [faces[f][0], faces[f][1]];
            if ![a, b].contains(&other) {
                faces.push(vec![a, b, other]);
            }
        }
        _ => {
            let mut copy = faces[f].clone();
            if at.is_multiple_of(2) {
                copy.reverse();
            }
            faces.push(copy);
        }
    }
    PolygonMesh::new(points, &faces).expect("no face names a vertex twice")
}

fn faces_of(mesh: &PolygonMesh) -> Vec<Vec<u32>> {
    let faces = mesh.faces().iter();
    faces
        .map(|(_, face)| face.iter().map(|&v| v.into()).collect())
        .collect()
}

fn any_step() -> impl Strategy<Value = Step> {
    let weld = (prop_oneof![Just(0.0), 0.0..0.5_f64], any::<bool>());
    let weld = weld.prop_map(|(tolerance, grid)| Weld {
        tolerance: Tolerance::Absolute(tolerance),
        method: if grid {
            WeldMethod::Grid
        } else {
            WeldMethod::KdTree
        },
    });
    let orient = any::<[bool; 2]>().prop_map(|[outward, all]| Step::Orient {
        facing: if outward {
            Facing::Outward
        } else {
            Facing::Majority
        },
        which: if all {
            Components::All
        } else {
            Components::Inconsistent
        },
    });
    prop_oneof![
        weld.prop_map(Step::Weld),
        Just(Step::RemoveDuplicateFaces(OppositeFaces::Keep)),
        Just(Step::RemoveDuplicateFaces(OppositeFaces::Remove)),
        Just(Step::RemoveFlatFaces),
        orient,
        Just(Step::Cut),
        Just(Step::RemoveIsolatedVertices),
        (0..4_usize).prop_map(|min_faces| Step::RemoveSmallComponents { min_faces }),
        Just(Step::Triangulate),
    ]
}

/// Checks that `M` holds the mesh that is repaired for it, and the whole mesh if it held it before.
fn assert_held<M: Representation>(polygons: &PolygonMesh) -> Result<(), TestCaseError> {
    let repaired = repair_for(polygons, &M::CAPABILITIES).expect("small");
    prop_assert!(M::from_polygons(&repaired.polygons).is_ok(), "{}", M::NAME);
    if M::from_polygons(polygons).is_ok() {
        prop_assert_eq!(&repaired.polygons, polygons);
    }
    Ok(())
}

/// Returns the sum of a count over all steps.
fn sum(repaired: &Repaired, count: impl Fn(&StepCounts) -> usize) -> usize {
    repaired
        .steps
        .iter()
        .map(|report| count(&report.counts))
        .sum()
}

/// Checks that the counts are the true differences, and that the maps show the same.
fn assert_true_counts(old: &PolygonMesh, repaired: &Repaired) -> Result<(), TestCaseError> {
    let new = &repaired.polygons;
    let vertices = old.vertex_count() + sum(repaired, |c| c.vertices_added);
    let lost = sum(repaired, |c| c.vertices_merged + c.vertices_removed);
    prop_assert_eq!(vertices - lost, new.vertex_count());
    let faces = old.face_count() + sum(repaired, |c| c.faces_added);
    prop_assert_eq!(faces - sum(repaired, |c| c.faces_removed), new.face_count());
    prop_assert_eq!(repaired.vertices.old_count(), old.vertex_count());
    prop_assert_eq!(repaired.vertices.new_count(), new.vertex_count());
    prop_assert_eq!(repaired.faces.old_count(), old.face_count());
    prop_assert_eq!(repaired.faces.new_count(), new.face_count());
    if repaired.is_changed() {
        prop_assert!(!repaired.faces.is_identity());
    } else {
        prop_assert_eq!(old, new);
        prop_assert!(repaired.faces.is_identity() && repaired.vertices.is_identity());
    }
    Ok(())
}

/// Checks that both directions of the maps agree, that no vertex moves by more than `tolerance`, and
/// that the corners of each face come from its old face, except for faces that get corners.
fn assert_true_maps(
    old: &PolygonMesh,
    repaired: &Repaired,
    tolerance: f64,
) -> Result<(), TestCaseError> {
    let new = &repaired.polygons;
    for v in old.vertices() {
        for w in repaired.vertices.new_elements(v) {
            prop_assert!(repaired.vertices.old_elements(w).contains(&v));
            let [a, b] = [old.position(v), new.position(w)].map(|p| p.as_dvec3());
            prop_assert!(a.distance(b) <= tolerance * (1.0 + 1e-9));
        }
    }
    for w in new.vertices() {
        let origins = repaired.vertices.old_elements(w);
        prop_assert!(!origins.is_empty(), "{w} comes from no vertex");
        for v in origins {
            prop_assert!(repaired.vertices.new_elements(v).contains(&w));
        }
    }
    // Faces get corners from neighbours without area.
    let has_new_corners = repaired
        .steps
        .iter()
        .any(|step| step.step == Step::RemoveFlatFaces);
    for (g, corners) in new.faces().iter().filter(|_| !has_new_corners) {
        for f in repaired.faces.old_elements(g) {
            let before: BTreeSet<VertexId> = old.faces().face(f).iter().copied().collect();
            for &w in corners {
                let origins = repaired.vertices.old_elements(w);
                prop_assert!(origins.iter().any(|v| before.contains(v)), "{g} at {w}");
            }
        }
    }
    Ok(())
}

/// Returns the number of edges with one face, and of edges with more than two.
fn open_and_non_manifold(mesh: &PolygonMesh) -> [usize; 2] {
    let incidence = Incidence::new(mesh.vertex_count(), mesh.faces(), |_| true);
    let faces = incidence.edges().map(|edge| edge.sides().count());
    let faces: Vec<usize> = faces.collect();
    let count = |is_counted: fn(usize) -> bool| faces.iter().filter(|&&n| is_counted(n)).count();
    [count(|n| n == 1), count(|n| n > 2)]
}

/// Returns the sum of the area vectors of all faces, and the sum of their areas.
fn area_of(mesh: &PolygonMesh) -> (DVec3, f64) {
    let faces = mesh.faces().iter();
    let areas =
        faces.map(|(_, face)| area_vector(face.iter().map(|&v| mesh.position(v).as_dvec3())));
    areas.fold((DVec3::ZERO, 0.0), |(sum, size), area| {
        (sum + area, size + area.length())
    })
}

/// Moves vertices to few places on a grid, so that many faces have no area.
fn crumpled() -> impl Strategy<Value = PolygonMesh> {
    let mesh = prop_oneof![3 => manifold_mesh(), 1 => any_mesh()];
    (
        mesh,
        collection::vec(prop::array::uniform3(0..3_i8), 1..40),
        any::<bool>(),
    )
        .prop_map(|(mesh, places, in_plane)| {
            let place = |v: usize| {
                let [x, y, z] = places[v % places.len()].map(f32::from);
                [x, y, if in_plane { 0.0 } else { z }]
            };
            let points: Vec<[f32; 3]> = (0..mesh.vertex_count()).map(place).collect();
            PolygonMesh::new(points, faces_of(&mesh)).expect("the same faces")
        })
}

/// Returns the number of old faces that have no new face.
fn lost_faces(repaired: &Repaired) -> usize {
    let faces = (0..repaired.faces.old_count() as u32).map(FaceId::new);
    faces
        .filter(|&f| repaired.faces.new_elements(f).is_empty())
        .count()
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        cases: 1000,
        ..ProptestConfig::default()
    })]

    /// Faces without area are removed, or named; no edge opens, and the other faces keep their area.
    #[test]
    fn faces_without_area_leave_no_holes(polygons in crumpled()) {
        let run = |mesh: &PolygonMesh| repair(mesh, &[Step::RemoveFlatFaces]).expect("small");
        let repaired = run(&polygons);
        let new = &repaired.polygons;
        assert_true_counts(&polygons, &repaired)?;
        let [before, after] = [&polygons, new].map(open_and_non_manifold);
        prop_assert!(after[0] <= before[0], "{before:?} {after:?}");
        prop_assert!(after[1] <= before[1] || before[1] > 0, "{before:?} {after:?}");
        let ((sum, size), (new_sum, new_size)) = (area_of(&polygons), area_of(new));
        prop_assert!((sum - new_sum).length() < 1e-9 * size.max(1.0), "{sum} {new_sum}");
        let left = &repaired.steps[0].left;
        if polygons.first_polygon().is_none() {
            prop_assert!((size - new_size).abs() < 1e-9 * size.max(1.0), "{size} {new_size}");
        }
        let is_flat = |face: &[VertexId]| {
            let corners: Vec<DVec3> = face.iter().map(|&v| new.position(v).as_dvec3()).collect();
            let mut cutter = PolygonCutter::default();
            let cut = cutter.cut(corners.iter().copied(), |_, _| false);
            let mut triangles = cut.triangles.iter().map(|t| t.map(|i| corners[i]));
            triangles.all(|triangle| area_vector(triangle) == DVec3::ZERO)
        };
        let flat = new.faces().iter().filter(|(_, face)| is_flat(face));
        let origins = flat.map(|(f, _)| repaired.faces.old_elements(f)[0]);
        let origins: BTreeSet<FaceId> = origins.collect();
        let named = left.iter().filter_map(|left| match left {
            Left::FlatFace { face } => Some(*face),
            _ => None,
        });
        prop_assert_eq!(named.collect::<BTreeSet<FaceId>>(), origins);
        prop_assert_eq!(&run(new).polygons, new);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The result is held by the structure for which it was made, and a mesh that the structure
    /// holds already is not changed.
    #[test]
    fn the_result_is_held(polygons in damaged()) {
        assert_held::<PolygonSoup>(&polygons)?;
        assert_held::<IndexedFaceSet>(&polygons)?;
        assert_held::<FaceVertexMesh>(&polygons)?;
        assert_held::<WingedEdgeMesh>(&polygons)?;
        assert_held::<HalfEdgeMesh>(&polygons)?;
        assert_held::<CornerTable>(&polygons)?;
    }

    /// The same for any capabilities; a second run has nothing to do.
    #[test]
    fn any_capabilities_are_satisfied(
        polygons in damaged(),
        capabilities in any_capabilities(),
    ) {
        let repaired = repair_for(&polygons, &capabilities).expect("small");
        prop_assert_eq!(capabilities.check(&repaired.polygons), Ok(()));
        assert_true_counts(&polygons, &repaired)?;
        assert_true_maps(&polygons, &repaired, 0.0)?;
        let (lost, removed) = (lost_faces(&repaired), sum(&repaired, |c| c.faces_removed));
        prop_assert!(lost <= removed);
        // Without parts of faces, a face is removed only as a whole.
        if sum(&repaired, |c| c.faces_added) == 0 {
            prop_assert_eq!(lost, removed);
        }
        let again = repair_for(&repaired.polygons, &capabilities).expect("small");
        prop_assert!(again.steps.is_empty());
        prop_assert_eq!(&again.polygons, &repaired.polygons);
        if capabilities.check(&polygons).is_ok() {
            prop_assert!(repaired.steps.is_empty());
        }
    }

    /// A second run of a step changes nothing.
    #[test]
    fn steps_are_idempotent(polygons in damaged(), step in any_step()) {
        let once = repair(&polygons, &[step]).expect("small");
        let twice = repair(&once.polygons, &[step]).expect("small");
        prop_assert_eq!(&twice.polygons, &once.polygons);
        prop_assert!(!twice.is_changed());
    }

    /// A good mesh is not changed by steps that repair faults.
    #[test]
    fn good_meshes_are_not_changed(polygons in manifold_mesh()) {
        let steps = [
            Step::Weld(Weld::default()),
            Step::RemoveDuplicateFaces(OppositeFaces::Keep),
            Step::Orient { facing: Facing::Majority, which: Components::All },
            Step::Orient { facing: Facing::Outward, which: Components::Inconsistent },
            Step::Cut,
            Step::RemoveSmallComponents { min_faces: 1 },
        ];
        let repaired = repair(&polygons, &steps).expect("small");
        prop_assert!(!repaired.is_changed());
        assert_true_counts(&polygons, &repaired)?;
        assert_true_maps(&polygons, &repaired, 0.0)?;
    }

    /// Counts, maps and positions are right for any sequence of steps.
    #[test]
    fn reports_and_maps_are_true(
        polygons in damaged(),
        steps in collection::vec(any_step(), 0..5),
    ) {
        let repaired = repair(&polygons, &steps).expect("small");
        assert_true_counts(&polygons, &repaired)?;
        let welds = steps.iter().map(|step| match step {
            Step::Weld(Weld { tolerance: Tolerance::Absolute(tolerance), .. }) => *tolerance,
            _ => 0.0,
        });
        assert_true_maps(&polygons, &repaired, welds.sum())?;
        prop_assert!(lost_faces(&repaired) <= sum(&repaired, |c| c.faces_removed));
    }

    /// Cutting keeps the positions of every face, and counts the edges that it cuts.
    #[test]
    fn cutting_only_separates(polygons in damaged()) {
        let repaired = repair(&polygons, &[Step::Cut]).expect("small");
        let new = &repaired.polygons;
        prop_assert_eq!(new.face_count(), polygons.face_count());
        for (f, face) in polygons.faces().iter() {
            let before = face.iter().map(|&v| polygons.position(v));
            let after = new.faces().face(f).iter().map(|&v| new.position(v));
            prop_assert!(before.eq(after));
        }
        // The edges of the result by the old vertices of their ends.
        let old = |v| repaired.vertices.old_elements(v)[0];
        let mut ends: Vec<[VertexId; 2]> = new.edge_uses().iter().map(|edge| edge.ends.map(old)).collect();
        ends.iter_mut().for_each(|ends| ends.sort());
        ends.sort();
        let edges = ends.len();
        let cut = ends.chunk_by(|a, b| a == b).filter(|copies| copies.len() > 1).count();
        ends.dedup();
        prop_assert_eq!(ends.len(), Facts::from_polygons(&polygons).edges);
        prop_assert!(edges >= ends.len());
        prop_assert_eq!(repaired.steps[0].counts.edges_cut, cut);
    }

    /// Orientable components agree afterwards, and the others are named and unchanged.
    #[test]
    fn orientable_components_agree(polygons in damaged()) {
        let orient = Step::Orient { facing: Facing::Outward, which: Components::All };
        let repaired = repair(&polygons, &[orient]).expect("small");
        let facts = Facts::from_polygons(&repaired.polygons);
        let mut left = repaired.steps[0].left.iter();
        let named = left.any(|left| matches!(left, Left::NotOrientable { .. }));
        prop_assert_eq!(named, facts.orientable == Some(false));
        if !named {
            prop_assert_eq!(facts.inconsistent_edges, 0);
        }
    }

    /// A mesh whose faces share no vertices is welded to the original mesh.
    #[test]
    fn separate_faces_are_welded_again(polygons in manifold_mesh(), grid in any::<bool>()) {
        let method = if grid { WeldMethod::Grid } else { WeldMethod::KdTree };
        let separate = damage(&polygons, 1, 0);
        let steps = [Step::Weld(Weld { method, ..Weld::default() })];
        let welded = repair(&separate, &steps).expect("exact").polygons;
        let expected = sixfold_conformance::welded(&polygons).expect("no two corners at one position");
        prop_assert_eq!(welded, expected);
    }

    /// After a repair for the half-edge mesh, its holes can be filled.
    #[test]
    fn repaired_meshes_can_be_filled(polygons in damaged()) {
        let capabilities = HalfEdgeMesh::CAPABILITIES;
        let mut mesh = repair_for(&polygons, &capabilities).expect("small").polygons;
        for method in [HoleFilling::MinimumArea, HoleFilling::EarClipping] {
            let options = FillHoles { max_edges: None, method };
            let filled = repair(&mesh, &[Step::FillHoles(options)]).expect("a manifold");
            prop_assert_eq!(capabilities.check(&filled.polygons), Ok(()));
            prop_assert!(filled.faces.new_count() >= mesh.face_count());
            mesh = filled.polygons;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Facets whose corners disagree by a little: the distance that a diagnosis names closes them, and
    /// changes the area by no more than the corners move.
    #[test]
    fn cracks_close_at_the_distance_that_is_named(
        frequency in 1..5_usize,
        width in -5.0_f64..-2.3,
        shifts in collection::vec(prop::array::uniform3(-0.5_f64..0.5), 60),
    ) {
        let sphere = sixfold_shapes::geodesic(frequency).expect("small");
        let separate = damage(&sphere, 1, 0);
        // The width of the cracks, as a part of the size of an edge.
        let width = 10.0_f64.powf(width) / (frequency as f64);
        let points = separate.positions().iter().zip(shifts.iter().cycle());
        let points = points.map(|(p, shift)| (p.as_dvec3() + width * DVec3::from(*shift)).as_vec3());
        let cracked = PolygonMesh::from_faces(points.collect(), separate.faces().clone()).expect("valid");
        let crack = diagnose(&cracked, 0).crack.expect("all edges are cracks");
        prop_assert!(crack.distance < 10.0 * width, "{} {}", crack.distance, width);
        let welded = repair(&cracked, &crack.repairs()).expect("valid").polygons;
        let [before, after] = [&cracked, &welded].map(open_and_non_manifold);
        prop_assert_eq!(before[0] - after[0], crack.edges);
        prop_assert_eq!((after, welded.face_count()), ([0, 0], sphere.face_count()));
        let ((_, size), (_, new_size)) = (area_of(&cracked), area_of(&welded));
        prop_assert!((size - new_size).abs() < 40.0 * (frequency as f64) * crack.distance);
    }

    /// Corners of a polygon that touches itself become one vertex, and the area stays.
    #[test]
    fn welding_neither_opens_nor_closes_a_hole(
        polygon in touching_polygon(),
        shifts in collection::vec(prop::array::uniform2(-1.0_f32..1.0), 1..20),
        shift in prop_oneof![Just(0.0_f32), 1e-4..1e-2_f32],
    ) {
        let shifts = shifts.iter().cycle();
        let points = polygon.corners.iter().zip(shifts).map(|(&[x, y], [dx, dy])| {
            [x as f32 + shift * dx, y as f32 + shift * dy, 0.0]
        });
        let face: Vec<u32> = (0..polygon.corners.len() as u32).collect();
        let mesh = PolygonMesh::new(points, [face]).expect("valid");
        let tolerance = Tolerance::Absolute(f64::from(3.0 * shift));
        let weld = Weld { tolerance, ..Weld::default() };
        let welded = repair(&mesh, &[Step::Weld(weld)]).expect("a good tolerance");
        let places: HashSet<[i32; 2]> = polygon.corners.iter().copied().collect();
        prop_assert_eq!(welded.polygons.vertex_count(), places.len());
        // Each corner moves by less than twice the tolerance against its place on the grid.
        let perimeter: f64 = 2.0 * polygon.corners.len() as f64 * 36.0;
        let difference = (area_of(&welded.polygons).1 - f64::from(polygon.area)).abs();
        prop_assert!(difference <= f64::from(6.0 * shift) * perimeter + 1e-6, "{}", difference);
        if shift == 0.0 {
            prop_assert!(welded.steps[0].left.is_empty());
        }
    }
}
