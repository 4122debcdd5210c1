//! What a structure says it weighs is what the allocator counts: to the byte, on every shape.
//!
//! A program of its own, for its allocator counts every byte. It runs on one thread.

use std::cell::Cell;
use std::path::PathBuf;
use std::{env, fs};

use peak_alloc::PeakAlloc;
use sixfold::remeshing::{Boundary, Decimation, Target, decimate};
use sixfold::{
    MeshEdit, MeshQuery, Point, PolygonMesh, Representation, for_each_editable, mesh_io, roster,
    shapes,
};
use study::{Audit, Backend, Heap, Specimen, audit};

#[path = "../crates/conformance/tests/all/face_and_edge_lists.rs"]
mod face_and_edge_lists;

use face_and_edge_lists::FaceAndEdgeLists;

#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;

/// Other counters than those of the command.
#[derive(Default)]
struct Counters {
    before: Cell<usize>,
}

impl Heap for Counters {
    fn live(&self) -> usize {
        HEAP.current_usage()
    }

    fn restart_peak(&self) {
        HEAP.reset_peak_usage();
        self.before.set(HEAP.current_usage());
    }

    fn peak(&self) -> usize {
        HEAP.peak_usage() - self.before.get()
    }
}

fn main() {
    the_counters_count();
    generated_shapes_weigh_what_is_said();
    corner_cases_weigh_what_is_said();
    real_meshes_weigh_what_is_said();
    words_are_those_of_the_literature();
    what_is_not_in_a_table_is_found();
    tables_own_up_to_everything_after_edits();
}

fn the_counters_count() {
    let heap = Counters::default();
    let before = heap.live();
    heap.restart_peak();
    let mut block = Vec::<u8>::with_capacity(12_345);
    drop(vec![0_u8; 1_000]);
    assert_eq!((heap.live() - before, heap.peak()), (12_345, 13_345));
    block.push(1);
    block.shrink_to_fit();
    assert_eq!(heap.live() - before, 1);
}

fn audited(name: &str, polygons: PolygonMesh) -> Audit {
    let specimen = Specimen::new(name, polygons);
    let heap = Counters::default();
    audit(&specimen, &Backend::roster(), &heap, &mut |_| ())
}

/// Whoever can hold the mesh weighs what is said, in three ways; how many can.
fn weighed(name: &str, polygons: &PolygonMesh) -> usize {
    let audit = audited(name, polygons.clone());
    assert_eq!(audit.faults(), Vec::<String>::new(), "{name}");
    let mut held = 0;
    for (one, known) in audit.backends.iter().zip(roster()) {
        let backend = &one.backend.name;
        let holds = known.verdict(polygons).is_ok();
        assert_eq!(one.backend.holds, holds, "{backend} on {name}");
        assert_eq!(one.agrees, holds.then_some(true), "{backend} on {name}");
        let (Some(counted), Some(peak)) = (one.counted_bytes, one.peak_bytes) else {
            continue;
        };
        held += 1;
        assert!(peak >= counted, "{backend} on {name}: {peak} < {counted}");
        // Beside what is left there may be a copy of the positions, marks, and the sides of all
        // corners; never a second mesh. Of small ones a scratch list may be larger.
        let copy = 13 * polygons.vertex_count() + 4 * polygons.corner_count();
        assert!(
            polygons.vertex_count() < 300 || peak <= counted + copy,
            "{backend} on {name}: {peak} bytes to make {counted}"
        );
    }
    held
}

fn generated_shapes_weigh_what_is_said() {
    for size in [3, 10, 37, 150] {
        let made = "a shape of this size";
        let closed = shapes::geodesic(size).expect(made);
        let open = shapes::triangle_grid(size, size + 1).expect(made);
        let mixed = shapes::mixed_grid(size, size + 1).expect(made);
        let fin = with_fin(&open);
        for (name, polygons, holders) in [
            ("closed", &closed, 6),
            ("open", &open, 6),
            ("quads", &shapes::torus(size, size).expect(made), 5),
            ("mixed degrees", &mixed, 5),
            (
                "a hole",
                &shapes::grid_with_hole(size, size).expect(made),
                5,
            ),
            ("one-sided", &shapes::moebius(size).expect(made), 3),
            ("isolated, closed", &with_isolated(&closed), 5),
            ("isolated, open", &with_isolated(&open), 5),
            ("isolated, mixed", &with_isolated(&mixed), 4),
            ("a non-manifold edge", &fin, 3),
            ("the same, isolated", &with_isolated(&fin), 2),
            ("loose faces", &loose(&open), 6),
        ] {
            let name = format!("{name}, size {size}");
            assert_eq!(weighed(&name, polygons), holders, "{name}");
        }
    }
}

/// The mesh and three vertices more that are in no face.
fn with_isolated(mesh: &PolygonMesh) -> PolygonMesh {
    let far = [1, 2, 3].map(|i| Point::splat(100.0 + i as f32));
    let positions = mesh.positions().iter().copied().chain(far);
    PolygonMesh::from_faces(positions.collect(), mesh.faces().clone()).expect("the same faces")
}

/// The mesh and a triangle more, on an edge that has two already.
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
    let tip = mesh.vertex_count() as u32;
    let positions = mesh.positions().iter().copied().chain([Point::splat(9.0)]);
    let faces = mesh.faces().iter().map(|(_, face)| face.to_vec());
    let faces: Vec<Vec<u32>> = faces
        .map(|face| face.iter().map(|v| v.index() as u32).collect())
        .chain([vec![a.index() as u32, b.index() as u32, tip]])
        .collect();
    PolygonMesh::new(positions.collect::<Vec<_>>(), &faces).expect("valid")
}

/// The same faces with vertices of their own each: a soup merges them, and weighs the same.
fn loose(mesh: &PolygonMesh) -> PolygonMesh {
    let corners = mesh.faces().corners().iter();
    let positions: Vec<Point> = corners.map(|&v| mesh.position(v)).collect();
    let triangles = (0..mesh.face_count() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]);
    PolygonMesh::new(positions, triangles.collect::<Vec<_>>()).expect("valid")
}

fn corner_cases_weigh_what_is_said() {
    let mut held = 0;
    for specimen in conformance::gallery() {
        held += weighed(specimen.name, &specimen.polygons);
    }
    assert!(held > 150, "{held} structures were weighed");
}

/// Those in the folder that `SIXFOLD_MESHES` names, if it is set.
fn real_meshes_weigh_what_is_said() {
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
            let mesh = mesh_io::read_obj(&file).unwrap_or_else(|error| panic!("{error}"));
            let held = weighed(&file.display().to_string(), &mesh.into_polygons().0);
            meshes += usize::from(held > 0);
        }
    }
    assert!(meshes > 50, "only {meshes} meshes");
    println!("{meshes} real meshes");
}

/// Of a large closed mesh of triangles. Face-vertex keeps the length of each list beside its start,
/// and has one word more than books say.
fn words_are_those_of_the_literature() {
    let audit = audited("closed", shapes::geodesic(100).expect("200,000 triangles"));
    let words = [18.0, 9.0, 17.0, 30.0, 24.0, 16.0];
    assert_eq!(audit.backends.len(), words.len());
    for (one, words) in audit.backends.iter().zip(words) {
        let name = &one.backend.name;
        assert_eq!(one.closed_triangles_words_per_vertex, words, "{name}");
        let here = one.layout_words_per_vertex.expect("all hold it");
        assert!((here - words).abs() < 0.001, "{name}: {here}");
    }
}

/// A seventh structure is weighed as well; and one that keeps more than its tables say is caught.
fn what_is_not_in_a_table_is_found() {
    let torus = || Specimen::new("torus", shapes::triangle_torus(20, 15).expect("a torus"));
    let seventh = Backend::of::<FaceAndEdgeLists>();
    let heap = Counters::default();
    let audit_of = |backend: Backend| audit(&torus(), &[backend], &heap, &mut |_| ());
    assert_eq!(audit_of(seventh).faults(), Vec::<String>::new());

    let mut forgetful = seventh;
    forgetful.layout_bytes = |counts| FaceAndEdgeLists::layout_bytes(counts) - 8 * counts.edges;
    let audit = audit_of(forgetful);
    assert_eq!(audit.backends[0].agrees, Some(false));
    // 300 vertices, 900 edges, 600 faces; the ends of the edges are left out.
    let expected =
        "its tables hold 18000 bytes, 7200 bytes more than its layout has by the formula, 10800";
    assert!(
        audit.faults()[0].ends_with(expected),
        "{:?}",
        audit.faults()
    );
}

/// Edits leave room to spare, and the formula says nothing of it; the tables do.
fn tables_own_up_to_everything_after_edits() {
    let polygons = shapes::geodesic(12).expect("2,880 triangles");
    let decimation = Decimation {
        target: Target::Ratio(0.3),
        boundary: Boundary::default(),
    };
    for_each_editable!(M => {
        let before = HEAP.current_usage();
        let mut mesh = M::from_polygons(&polygons).expect("closed");
        let counted = || HEAP.current_usage() - before;
        assert_eq!(counted(), mesh.memory().total(), "{}, built", M::NAME);
        let faces: Vec<_> = mesh.faces().step_by(2).collect();
        for (i, &f) in faces.iter().enumerate() {
            let at = Point::splat(2.0 + i as f32);
            mesh.poke_face(f, at, &mut ()).expect("nothing is there");
        }
        drop(faces);
        assert_eq!(counted(), mesh.memory().total(), "{}, poked", M::NAME);
        decimate(&mut mesh, &decimation).expect("triangles");
        assert_eq!(counted(), mesh.memory().total(), "{}, decimated", M::NAME);
        mesh.compact(&mut ());
        assert_eq!(counted(), mesh.memory().total(), "{}, compact", M::NAME);
    });
}
