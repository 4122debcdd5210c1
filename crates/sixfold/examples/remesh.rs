//! Incremental remeshing with edits. Long edges are cut in the middle, and short edges are
//! collapsed. Each face keeps its material.
//!
//! ```sh
//! cargo run --example remesh -- mesh.obj > remeshed.obj
//! ```

use std::error::Error;

use sixfold::io::{Format, WriteOptions, write_to};
use sixfold::prelude::*;
use sixfold::remeshing::meets_link_condition;

mod common;

/// Cuts edges that are longer than 4/3 of `length`, then collapses edges that are shorter than 4/5
/// of `length` (Botsch and Kobbelt 2004). Returns the number of cut edges and the number of
/// collapsed edges.
///
/// All edges are listed before the edits. An edge that an earlier edit has removed is skipped.
pub fn remesh<M: MeshEdit>(mesh: &mut M, length: f32) -> [usize; 2] {
    let mut cut = 0;
    let edges: Vec<_> = mesh.edges().collect();
    for e in edges {
        if mesh.contains_edge(e) && edge_length(mesh, e) > 4.0 / 3.0 * length {
            let middle = middle(mesh, e);
            cut += usize::from(mesh.bisect_edge(e, middle).is_ok());
        }
    }
    let mut collapsed = 0;
    let edges: Vec<_> = mesh.edges().collect();
    for e in edges {
        // A face-vertex mesh would also make a collapse that does not keep the mesh a manifold.
        if mesh.contains_edge(e)
            && edge_length(mesh, e) < 4.0 / 5.0 * length
            && meets_link_condition(mesh, e)
        {
            let [kept, _] = mesh.edge_vertices(e);
            let middle = middle(mesh, e);
            collapsed += usize::from(mesh.collapse_edge(e, kept, middle).is_ok());
        }
    }
    [cut, collapsed]
}

/// Adds materials to a mesh. A new face gets the material of the face that was cut.
pub fn with_materials<M: MeshEdit>(
    mesh: M,
    material: impl Fn(&M, M::Face) -> u32,
) -> MeshWithData<M, FaceData<M, u32>> {
    let mut materials = FaceData::new(&mesh, 0).with_rule(|materials, new| {
        let parent = new.parents.first();
        parent.map_or(0, |&f| materials[f])
    });
    for f in mesh.faces() {
        materials[f] = material(&mesh, f);
    }
    MeshWithData::new(mesh, materials)
}

fn edge_length<M: MeshQuery>(mesh: &M, e: M::Edge) -> f32 {
    let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
    a.distance(b)
}

fn middle<M: MeshQuery>(mesh: &M, e: M::Edge) -> Point {
    let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
    a.midpoint(b)
}

fn main() -> Result<(), Box<dyn Error>> {
    let polygons = common::mesh_argument(sixfold::shapes::geodesic(4)?)?;
    let mesh = EditableHalfEdgeMesh::from_polygons(&polygons)?;
    let lengths: f32 = mesh.edges().map(|e| edge_length(&mesh, e)).sum();
    let target = 0.7 * lengths / mesh.edge_count() as f32;
    let is_upper = |mesh: &EditableHalfEdgeMesh, f| {
        let corners = mesh.face_vertices(f);
        u32::from(corners.map(|v| mesh.position(v).z).sum::<f32>() > 0.0)
    };
    let mut mesh = with_materials(mesh, is_upper);
    for pass in 1..=3 {
        let [cut, collapsed] = remesh(&mut mesh, target);
        let upper = mesh.faces().filter(|&f| mesh.data()[f] == 1).count();
        eprintln!(
            "pass {pass}: {cut} edges cut, {collapsed} collapsed; {upper} faces of material 1"
        );
    }
    let (mesh, _) = mesh.into_parts();
    let out = std::io::stdout().lock();
    write_to(
        &mesh.to_polygons(),
        Format::Obj,
        &WriteOptions::default(),
        out,
    )?;
    Ok(())
}
