//! Checks that `clone_from` restores an edited copy to its original mesh without allocating.
//!
//! This is a separate program, because its allocator counts every block.

use std::alloc::System;

use sixfold::{MeshEdit, PolygonMesh, Representation, for_each_editable, shapes};
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

fn check_clone_from<M: Representation + MeshEdit>(polygons: &PolygonMesh) {
    let mesh = M::from_polygons(polygons).expect("a closed triangle mesh");
    let (before, bytes) = (mesh.to_polygons(), mesh.memory().total());
    let mut copy = mesh.clone();
    for round in 0..3 {
        edit(&mut copy);
        assert_ne!(copy.to_polygons(), before, "{}: changed", M::NAME);
        let allocated = HEAP.stats().allocations + HEAP.stats().reallocations;
        copy.clone_from(&mesh);
        let blocks = HEAP.stats().allocations + HEAP.stats().reallocations - allocated;
        assert_eq!(blocks, 0, "{}, round {round}: blocks allocated", M::NAME);
        assert_eq!(copy.to_polygons(), before, "{}: restored", M::NAME);
        copy.validate().expect("every invariant");
    }
    assert!(copy.memory().total() >= bytes, "{}", M::NAME);
    println!("{}: restored without an allocation", M::NAME);
}

/// Pokes and removes faces. Tables become longer and get unused rows.
fn edit<M: MeshEdit>(mesh: &mut M) {
    let faces: Vec<M::Face> = mesh.faces().take(40).collect();
    for (i, face) in faces.into_iter().enumerate() {
        if i % 4 == 0 {
            mesh.remove_face(face).ok();
        } else {
            let mut corners = mesh.face_vertices(face);
            let at = corners.next().map(|v| mesh.position(v) * 1.01);
            drop(corners);
            mesh.poke_face(face, at.expect("three corners")).ok();
        }
    }
}

fn clone_from_does_not_allocate() {
    let polygons = shapes::geodesic(6).expect("720 triangles");
    for_each_editable!(M => { check_clone_from::<M>(&polygons); });
}

sixfold_tests::main_on_one_thread!(clone_from_does_not_allocate);
