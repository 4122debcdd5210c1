//! Checks that structures report exactly the bytes that the allocator counts.
//!
//! This is a separate program, because its allocator counts every byte. It runs on one thread.

use std::alloc::System;
use std::path::PathBuf;
use std::{env, fs};

use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use sixfold::remeshing::{Decimation, Target, decimate};
use sixfold::{
    MeshEdit, MeshQuery, Point, PolygonMesh, Representation, for_each_editable, io, shapes,
    structure_infos,
};
use sixfold_core::Measured;
use sixfold_results::Audit;
use sixfold_study::{Backend, Heap, StudyMesh, audit};
use stats_alloc::StatsAlloc;

mod face_and_edge_lists;

use face_and_edge_lists::FaceAndEdgeLists;

static LIVE: StatsAlloc<System> = StatsAlloc::system();

#[global_allocator]
static PEAK: PeakMemAlloc<&StatsAlloc<System>> = PeakMemAlloc::new(&LIVE);

/// Counters of the allocator. The `sixfold` command has its own counters.
struct Counters;

impl Heap for Counters {
    fn live(&self) -> usize {
        let stats = LIVE.stats();
        stats.bytes_allocated - stats.bytes_deallocated
    }

    fn restart_peak(&self) {
        PEAK.reset_peak_memory();
    }

    fn peak(&self) -> usize {
        PEAK.get_peak_memory()
    }
}

sixfold_tests::main_on_one_thread!(
    counters_are_correct,
    reported_bytes_are_right_on_generated_shapes,
    reported_bytes_are_right_on_the_gallery,
    reported_bytes_are_right_on_real_meshes,
    words_per_vertex_equal_the_literature,
    bytes_outside_the_formula_are_found,
    tables_report_all_bytes_after_edits,
);

fn counters_are_correct() {
    let heap = Counters;
    let before = heap.live();
    heap.restart_peak();
    let mut block = Vec::<u8>::with_capacity(12_345);
    drop(vec![0_u8; 1_000]);
    assert_eq!((heap.live() - before, heap.peak()), (12_345, 13_345));
    block.push(1);
    block.shrink_to_fit();
    assert_eq!(heap.live() - before, 1);
}

fn run_audit(name: &str, polygons: PolygonMesh) -> Audit {
    let study_mesh = StudyMesh::new(name, polygons);
    let heap = Counters;
    audit(&study_mesh, &Backend::structures(), &heap, &mut |_| ())
}

/// Checks for each structure that its bytes agree. Returns the number of checked structures.
fn check_audit(name: &str, polygons: &PolygonMesh) -> usize {
    let audit = run_audit(name, polygons.clone());
    assert_eq!(audit.faults(), Vec::<String>::new(), "{name}");
    let mut structures = 0;
    for (row, known) in audit.backends.iter().zip(structure_infos()) {
        let backend = &row.backend.name;
        let holds = known.check(polygons).is_ok();
        assert_eq!(row.backend.holds, holds, "{backend} on {name}");
        assert_eq!(row.agrees, holds.then_some(true), "{backend} on {name}");
        let (Some(counted), Some(peak)) = (row.counted_bytes, row.peak_bytes) else {
            continue;
        };
        structures += 1;
        assert!(peak >= counted, "{backend} on {name}: {peak} < {counted}");
        // Building also needs a copy of the positions, a mark for each vertex, and the sides of all
        // corners, but not a second mesh. On small meshes, another list can be larger.
        let copy = 13 * polygons.vertex_count() + 4 * polygons.corner_count();
        assert!(
            polygons.vertex_count() < 300 || peak <= counted + copy,
            "{backend} on {name}: {peak} bytes to make {counted}"
        );
    }
    structures
}

fn reported_bytes_are_right_on_generated_shapes() {
    for size in [3, 10, 37, 150] {
        let message = "a shape of this size";
        let closed = shapes::geodesic(size).expect(message);
        let open = shapes::triangle_grid(size, size + 1).expect(message);
        let mixed = shapes::mixed_grid(size, size + 1).expect(message);
        let fin = with_fin(&open);
        for (name, polygons, holders) in [
            ("closed", &closed, 6),
            ("open", &open, 6),
            ("quads", &shapes::torus(size, size).expect(message), 5),
            ("mixed degrees", &mixed, 5),
            (
                "a hole",
                &shapes::grid_with_hole(size, size).expect(message),
                5,
            ),
            ("one-sided", &shapes::moebius(size).expect(message), 3),
            ("isolated, closed", &with_isolated(&closed), 5),
            ("isolated, open", &with_isolated(&open), 5),
            ("isolated, mixed", &with_isolated(&mixed), 4),
            ("a non-manifold edge", &fin, 3),
            ("the same, isolated", &with_isolated(&fin), 2),
            ("loose faces", &separate_faces(&open), 6),
        ] {
            let name = format!("{name}, size {size}");
            assert_eq!(check_audit(&name, polygons), holders, "{name}");
        }
    }
}

fn with_isolated(mesh: &PolygonMesh) -> PolygonMesh {
    let far = [1, 2, 3].map(|i| Point::splat(100.0 + i as f32));
    let positions = mesh.positions().iter().copied().chain(far);
    PolygonMesh::from_faces(positions.collect(), mesh.faces().clone()).expect("the same faces")
}

/// Returns the mesh with an additional triangle on an edge that already has two triangles.
fn with_fin(mesh: &PolygonMesh) -> PolygonMesh {
    let sides = |face: &[_]| [[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]];
    let mut all: Vec<[_; 2]> = Vec::new();
    let mut inner = None;
    for (_, face) in mesh.faces().iter() {
        for [a, b] in sides(face) {
            if all.contains(&[b, a]) {
                inner = Some([a, b]);
            }
            all.push([a, b]);
        }
        if inner.is_some() {
            break;
        }
    }
    let [a, b] = inner.expect("an edge of two faces");
    let apex = mesh.vertex_count() as u32;
    let positions = mesh.positions().iter().copied().chain([Point::splat(9.0)]);
    let faces = mesh.faces().iter().map(|(_, face)| face.to_vec());
    let faces: Vec<Vec<u32>> = faces
        .map(|face| face.iter().map(|v| v.index() as u32).collect())
        .chain([vec![a.index() as u32, b.index() as u32, apex]])
        .collect();
    PolygonMesh::new(positions.collect::<Vec<_>>(), &faces).expect("valid")
}

/// Returns the same faces, each with its own vertices.
fn separate_faces(mesh: &PolygonMesh) -> PolygonMesh {
    let corners = mesh.faces().corners().iter();
    let positions: Vec<Point> = corners.map(|&v| mesh.position(v)).collect();
    let triangles = (0..mesh.face_count() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]);
    PolygonMesh::new(positions, triangles.collect::<Vec<_>>()).expect("valid")
}

fn reported_bytes_are_right_on_the_gallery() {
    let mut structures = 0;
    for entry in sixfold_conformance::gallery() {
        structures += check_audit(entry.name, &entry.polygons);
    }
    assert!(
        structures > 150,
        "only {structures} structures were measured"
    );
}

fn reported_bytes_are_right_on_real_meshes() {
    let Some(folder) = env::var_os("SIXFOLD_MESHES").map(PathBuf::from) else {
        return;
    };
    let mut meshes = 0;
    for sub in ["tiny", "fetched", "derived"] {
        for entry in fs::read_dir(folder.join(sub)).expect("a folder of meshes") {
            let file = entry.expect("readable").path();
            if file.extension().is_none_or(|extension| extension != "obj") {
                continue;
            }
            let mesh = io::read(&file).unwrap_or_else(|error| panic!("{error}"));
            let structures = check_audit(&file.display().to_string(), &mesh.into_polygons().0);
            meshes += usize::from(structures > 0);
        }
    }
    assert!(meshes > 50, "only {meshes} meshes");
    println!("{meshes} real meshes");
}

/// Face-vertex stores the start and the length of each list, so each vertex needs one word more
/// than in the literature.
fn words_per_vertex_equal_the_literature() {
    let audit = run_audit("closed", shapes::geodesic(100).expect("200,000 triangles"));
    let words = [18.0, 9.0, 17.0, 30.0, 24.0, 16.0];
    assert_eq!(audit.backends.len(), words.len());
    for (row, words) in audit.backends.iter().zip(words) {
        let name = &row.backend.name;
        assert_eq!(row.closed_triangles_words_per_vertex, words, "{name}");
        let got = row.layout_words_per_vertex.expect("all hold it");
        assert!((got - words).abs() < 0.001, "{name}: {got}");
    }
}

fn bytes_outside_the_formula_are_found() {
    let torus = || StudyMesh::new("torus", shapes::triangle_torus(20, 15).expect("a torus"));
    let seventh = Backend::new::<FaceAndEdgeLists>();
    let heap = Counters;
    let audit_of = |backend: Backend| audit(&torus(), &[backend], &heap, &mut |_| ());
    assert_eq!(audit_of(seventh).faults(), Vec::<String>::new());

    let mut incomplete = seventh;
    incomplete.layout_bytes = |counts| FaceAndEdgeLists::layout_bytes(counts) - 8 * counts.edges;
    let audit = audit_of(incomplete);
    assert_eq!(audit.backends[0].agrees, Some(false));
    // The formula does not contain the ends of the 900 edges.
    let expected =
        "its tables hold 18000 bytes, 7200 bytes more than its layout formula gives (10800 bytes)";
    assert!(
        audit.faults()[0].ends_with(expected),
        "{:?}",
        audit.faults()
    );
}

/// Edits leave spare capacity. The reported tables contain this capacity, but the formula does not.
fn tables_report_all_bytes_after_edits() {
    let polygons = shapes::geodesic(12).expect("2,880 triangles");
    let decimation = Decimation {
        target: Target::Ratio(0.3),
        ..Decimation::default()
    };
    for_each_editable!(M => {
        let before = Counters.live();
        let mut mesh = M::from_polygons(&polygons).expect("closed");
        let counted = || Counters.live() - before;
        assert_eq!(counted(), mesh.memory().total(), "{}, built", M::NAME);
        let faces: Vec<_> = mesh.faces().step_by(2).collect();
        for (i, &f) in faces.iter().enumerate() {
            let at = Point::splat(2.0 + i as f32);
            mesh.poke_face(f, at).expect("no vertex is there");
        }
        drop(faces);
        assert_eq!(counted(), mesh.memory().total(), "{}, poked", M::NAME);
        decimate(&mut mesh, &decimation).expect("triangles");
        assert_eq!(counted(), mesh.memory().total(), "{}, decimated", M::NAME);
        mesh.compact();
        assert_eq!(counted(), mesh.memory().total(), "{}, compact", M::NAME);
    });
}
