//! Passes of edits and single edits do the same work on every structure.

use sixfold::{Edit, shapes};
use sixfold_measure::{EditPass, MachineClock, Series};
use sixfold_workload::{Backend, Edits, SingleEdit};

#[test]
fn every_structure_does_the_same_work() {
    let polygons = shapes::geodesic(3).expect("small");
    for pass in EditPass::ALL {
        let mut results = Vec::new();
        for backend in Backend::structures() {
            let editor = backend.prepare_pass(pass, &polygons);
            let mut editor = editor.expect("all six").expect("triangles");
            let clock = MachineClock::start();
            editor.time(&Series::once(&clock));
            let once = editor.result();
            editor.time(&Series::with_runs(3, &clock).with_untimed(1));
            assert_eq!(editor.result(), once, "{pass} on {}, again", backend.name());
            results.push((backend.name(), once));
        }
        let (_, first) = results[0];
        assert!(first.done > 0 && first.checksum > 0.0);
        for (name, result) in results {
            assert_eq!(
                (result.elements, result.done),
                (first.elements, first.done),
                "{pass} on {name}"
            );
            let error = (result.checksum - first.checksum).abs();
            assert!(
                error < 1e-6 * first.checksum,
                "{pass} on {name}: {result:?}"
            );
        }
    }
}

/// The structures list faces and edges in the same order, so that equal refusals have equal
/// hashes.
#[test]
fn structures_that_refuse_the_same_edits_have_the_same_hash() {
    // Boundary edges and the edges at vertices of valence 3 cannot be flipped.
    let meshes = [
        shapes::tetrahedron(),
        shapes::triangle_grid(5, 4).expect("small"),
    ];
    let manifold = ["corner-table", "half-edge", "winged-edge", "face-vertex"];
    for pass in EditPass::ALL {
        for polygons in &meshes {
            let hashes = manifold.map(|name| {
                let backend = Backend::find(name).expect("one of six");
                let editor = backend.prepare_pass(pass, polygons).expect("has edits");
                let mut editor = editor.expect("triangles");
                editor.time(&Series::once(&MachineClock::start()));
                let Edits {
                    refused,
                    refused_hash,
                    ..
                } = editor.result();
                assert_eq!(refused == 0, refused_hash == 0, "{pass} on {name}");
                refused_hash
            });
            assert!(
                hashes.iter().all(|hash| *hash == hashes[0]),
                "{pass}: {hashes:?}"
            );
        }
    }
}

#[test]
fn polygons_are_refused_with_the_first_such_face() {
    let half_edge = Backend::find("half-edge").expect("one of six");
    let refused = half_edge
        .prepare_pass(EditPass::FlipAll, &shapes::cube())
        .expect("it can be edited");
    let Err(refusal) = refused else {
        panic!("quads were accepted")
    };
    assert!(refusal.contains("face f0 has 4 corners"), "{refusal}");
    assert!(Backend::find("abacus").is_none());
}

#[test]
fn every_edit_is_accepted_at_every_place() {
    let torus = shapes::triangle_torus(40, 40).expect("small");
    for edit in Edit::ALL {
        let job = SingleEdit { edit, places: 20 };
        let mut results = Vec::new();
        for backend in Backend::structures() {
            let is_supported = backend.info.edits[edit as usize].is_some();
            let Some(editor) = job.prepare(&backend, &torus) else {
                assert!(!is_supported, "{edit} on {}", backend.name());
                continue;
            };
            let mut editor = editor.expect("a closed triangle mesh");
            editor.time(&Series::with_runs(2, &MachineClock::start()).with_untimed(1));
            let edits = editor.result();
            let places = if job.is_pass() { 1 } else { 20 };
            assert_eq!(
                (edits.done, edits.refused),
                (places, 0),
                "{edit} on {}",
                backend.name()
            );
            results.push(edits);
        }
        assert!(results.len() >= 5, "{edit}");
        assert!(
            results.iter().all(|r| r.checksum == results[0].checksum),
            "{edit}"
        );
    }
}
