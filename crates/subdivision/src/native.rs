//! The method native: the structure splits its own tables, and the new points are computed with
//! queries.
//!
//! No structure is built from polygons: [`Refine`] defines the row of each new element. Points are
//! computed independently of each other, with the same queries and rules as in the method gather.
//! So the points are the same on any number of threads.

use sixfold_core::{
    CHUNK_ROWS, Creases, FaceId, Point, Refine, RowId, Split, for_each_chunk, map_chunks,
};

use crate::SubdivisionError;
use crate::crease::{SharpEdge, SharpLevel};
use crate::gather::{edge_point, face_value, vertex_point};
use crate::mask::Mask;
use crate::options::Creasing;

/// Runs one step of a scheme that splits faces. Stores the mesh in `child` and returns its creases.
pub(crate) fn step<M: Refine, K: Mask>(
    mesh: &M,
    mask: K,
    creases: &Creases,
    creasing: Creasing,
    numbers: &M::EdgeNumbers,
    child: &mut M,
) -> Result<Creases, SubdivisionError> {
    mesh.split_into(mask.split(), numbers, child)?;
    let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
    let face_points = if mask.split() == Split::Quads {
        faces
    } else {
        0
    };
    let first_edge = vertices + face_points;
    let (old, rest) = child.positions_mut().split_at_mut(vertices);
    let (face_points, edge_points) = rest.split_at_mut(face_points);
    compute_rows(face_points, |f| face_value(mesh, mask, f));
    let face_points = &*face_points;
    let value = |f: FaceId| match mask.split() {
        Split::Quads => face_points[f.index()],
        // Stored face values would be faster, but would need too much memory.
        _ => face_value(mesh, mask, f),
    };
    if K::APPROXIMATES {
        compute_rows(old, |v| vertex_point(mesh, mask, v, value));
    } else {
        copy_rows(old, mesh.position_rows());
    }
    let chunks = mesh.edge_chunks(numbers);
    let sharp = map_chunks(edge_points, &chunks, |chunk, range, points| {
        let mut by_topology = Vec::new();
        let edges = mesh.edges_of_chunk(numbers, chunk);
        // `fold` passes the place by value, so that the place stays in registers.
        let mut rest = edges.fold(range.zip(points), |mut places, e| {
            let (number, point) = places.next().expect("a row for each edge");
            let faces;
            (*point, faces) = edge_point(mesh, mask, e, value);
            if K::APPROXIMATES && faces != 2 {
                let [a, b] = mesh.edge_vertices(e);
                by_topology.push(SharpEdge {
                    edge: number,
                    ends: [a.index() as u32, b.index() as u32],
                    sharpness: f32::INFINITY,
                    by_topology: true,
                });
            }
            places
        });
        debug_assert!(rest.next().is_none(), "an edge for each row");
        by_topology
    });
    let mut level = SharpLevel {
        edges: sharp.concat(),
        corners: creases.corners().to_vec(),
    };
    level.edges.extend(crease_edges(mesh, creases, numbers));
    if level.is_empty() {
        return Ok(Creases::default());
    }
    let old = mesh.position_rows();
    Ok(level.place(old, child.positions_mut(), first_edge, creasing))
}

/// Computes the value of each row, on several threads.
pub(crate) fn compute_rows<H: RowId, T: Send>(rows: &mut [T], value: impl Fn(H) -> T + Sync) {
    for_each_chunk(rows, CHUNK_ROWS, |first, rows| {
        for (row, name) in rows.iter_mut().zip(first as u32..) {
            *row = value(H::from_row(name));
        }
    });
}

/// Copies `old`, on several threads.
pub(crate) fn copy_rows(points: &mut [Point], old: &[Point]) {
    for_each_chunk(points, CHUNK_ROWS, |first, points| {
        points.copy_from_slice(&old[first..first + points.len()]);
    });
}

/// Returns the edges with an entry in `creases` and exactly two faces.
fn crease_edges<M: Refine>(
    mesh: &M,
    creases: &Creases,
    numbers: &M::EdgeNumbers,
) -> impl Iterator<Item = SharpEdge> {
    creases.edges().iter().filter_map(|&(pair, sharpness)| {
        let [a, b] = pair.ends();
        let ends_at_b = |&e: &M::Edge| mesh.edge_vertices(e).contains(&b);
        let e = mesh.vertex_edges(a).find(ends_at_b);
        let e = e.expect("creases are those of the mesh");
        (mesh.edge_faces(e).count() == 2).then(|| SharpEdge {
            edge: mesh.edge_number(numbers, e),
            ends: [a, b].map(|v| v.index() as u32),
            sharpness,
            by_topology: false,
        })
    })
}
