//! The handles, in one structure, of the elements that a mix visits.

use std::hint::black_box;
use std::ops::Range;

use sixfold::{MeshQuery, Point, PolygonMesh, Representation, VertexId};

use crate::draw::Side;
use crate::mix::route::Route;
use crate::timed_structure::edge_handles;
use crate::workload::Action;
use sixfold_measure::{ElementKind, HandleLists, Sink};

/// **Timed**: runs `action` for the operations `range`. Returns the number of results or of positions
/// read.
#[inline(never)]
pub(crate) fn run_action<M: MeshQuery>(
    handles: &HandleLists<M>,
    mesh: &M,
    action: Action,
    range: Range<u64>,
) -> u64 {
    let (v, e, f) = (&handles.vertices, &handles.edges, &handles.faces);
    match action {
        Action::Relation(relation) => {
            let all = handles.len(ElementKind::queried_by(relation));
            ranges(all, range)
                .fold(Sink::default(), |sink, range| {
                    handles.query(mesh, relation, range, sink)
                })
                .count()
        }
        Action::Position => sum_positions(v, range, |sum, v| {
            *sum += mesh.position(v);
            1
        }),
        Action::NeighbourPositions => sum_positions(v, range, |sum, v| {
            add_positions(mesh, mesh.vertex_vertices(v), sum)
        }),
        Action::CornerPositions => sum_positions(f, range, |sum, f| {
            add_positions(mesh, mesh.face_vertices(f), sum)
        }),
        Action::EndPositions => sum_positions(e, range, |sum, e| {
            add_positions(mesh, mesh.edge_vertices(e).into_iter(), sum)
        }),
        // Writes and passes run elsewhere.
        Action::SetPosition | Action::Edit(_) | Action::Pass(_) | Action::Subdivide => 0,
    }
}

/// Returns the vertices of the operations `range`, as slices.
pub(crate) fn vertices_of<M: MeshQuery>(
    handles: &HandleLists<M>,
    range: Range<u64>,
) -> impl Iterator<Item = &[M::Vertex]> {
    ranges(handles.vertices.len(), range).map(|range| &handles.vertices[range])
}

/// Looks up the handles of `route` on `mesh`, which was built from `polygons`. Leaves out
/// elements with an `occupied` vertex.
pub(crate) fn from_route<M: Representation>(
    route: &Route,
    mesh: &M,
    polygons: &PolygonMesh,
    occupied: &[bool],
) -> HandleLists<M> {
    let is_free = |v: &VertexId| !occupied.get(v.index()).is_some_and(|&occupied| occupied);
    if route.structure_order && occupied.is_empty() {
        return HandleLists::of_mesh(mesh);
    }
    if route.structure_order {
        // In the order of the structure, without the elements near an edit.
        let mut is_occupied = mesh.vertex_map(false);
        for v in polygons.vertices().filter(|v| !is_free(v)) {
            is_occupied[M::vertex_handle(polygons, v)] = true;
        }
        let mut handles = HandleLists::of_mesh(mesh);
        handles.vertices.retain(|&v| !is_occupied[v]);
        handles
            .edges
            .retain(|&e| !mesh.edge_vertices(e).iter().any(|&v| is_occupied[v]));
        handles
            .faces
            .retain(|&f| !mesh.face_vertices(f).any(|v| is_occupied[v]));
        return handles;
    }
    let vertices = route.vertices.iter().filter(|v| is_free(v));
    let edges = route.edges.iter().copied();
    let edges: Vec<Side> = edges.filter(|side| side.ends.iter().all(is_free)).collect();
    let is_free_face = |f: &&sixfold::FaceId| polygons.faces().face(**f).iter().all(is_free);
    let faces = route.faces.iter().filter(is_free_face);
    HandleLists {
        vertices: vertices.map(|&v| M::vertex_handle(polygons, v)).collect(),
        edges: edge_handles(mesh, polygons, &edges),
        faces: faces.map(|&f| M::face_handle(polygons, f)).collect(),
    }
}

/// Returns the places in a list of `all` handles that the operations `range` visit, as ranges. The
/// first handle follows the last handle.
fn ranges(all: usize, range: Range<u64>) -> impl Iterator<Item = Range<usize>> {
    let all = all as u64;
    let mut left = if all == 0 { 0 } else { range.end - range.start };
    let mut start = if all == 0 { 0 } else { range.start % all };
    std::iter::from_fn(move || {
        if left == 0 {
            return None;
        }
        let end = all.min(start + left);
        let range = start as usize..end as usize;
        left -= end - start;
        start = 0;
        Some(range)
    })
}

#[inline(always)]
fn sum_positions<H: Copy>(
    handles: &[H],
    range: Range<u64>,
    mut add: impl FnMut(&mut Point, H) -> u64,
) -> u64 {
    let (mut sum, mut count) = (Point::ZERO, 0);
    for range in ranges(handles.len(), range) {
        handles[range]
            .iter()
            .for_each(|&handle| count += add(&mut sum, handle));
    }
    black_box(sum);
    count
}

#[inline(always)]
fn add_positions<M: MeshQuery>(
    mesh: &M,
    vertices: impl Iterator<Item = M::Vertex>,
    sum: &mut Point,
) -> u64 {
    let (all, count) = vertices.fold((*sum, 0), |(sum, count), v| {
        (sum + mesh.position(v), count + 1)
    });
    *sum = all;
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_route_starts_again_after_its_last_element() {
        let visited = |range| ranges(5, range).flatten().collect::<Vec<usize>>();
        assert_eq!(visited(3..9), [3, 4, 0, 1, 2, 3]);
        assert_eq!(visited(10..10), [0; 0]);
        assert_eq!(visited(12..14), [2, 3]);
        assert_eq!(ranges(0, 3..9).count(), 0);
    }
}
