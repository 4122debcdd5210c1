//! The method gather: computes every new point with queries of the neighbourhood of the point.
//!
//! ```text
//!   face point    FV                 Each query is made when its point is computed. A structure
//!   edge point    EV, EF             that has to search for EF or VV searches once for each edge
//!   vertex point  VV, VF             and each vertex: O(faces²) on a polygon soup.
//! ```

use sixfold_core::{Creases, FaceMap, HandleMap, MeshQuery, Point};

use crate::SubdivisionError;
use crate::crease::{SharpEdge, SharpLevel};
use crate::mask::{Mask, midpoint};
use crate::options::Creasing;
use crate::step::{CreaseVertices, Step, StepBuilder};

/// Runs one step of a scheme that splits faces.
pub(crate) fn step<M: MeshQuery, K: Mask>(
    mesh: &M,
    mask: K,
    creases: &Creases,
    creasing: Creasing,
    corners: usize,
) -> Result<Step, SubdivisionError> {
    let mut builder = StepBuilder::new(mask.split(), mesh, corners);
    // The map is needed only if face values are used.
    let mut values: FaceMap<M, Point> = HandleMap::filled(0, Point::ZERO);
    if K::EDGES_USE_FACES || K::VERTICES_USE_FACES || builder.has_face_points() {
        values = mesh.face_map(Point::ZERO);
        mesh.faces()
            .for_each(|f| values[f] = face_value(mesh, mask, f));
    }
    let mut numbers = mesh.vertex_map(0_u32);
    numbers.reserve(builder.vertices());
    let mut number = 0;
    mesh.vertices().for_each(|v| {
        numbers[v] = number;
        number += 1;
        builder.points.push(if K::APPROXIMATES {
            vertex_point(mesh, mask, v, |f| values[f])
        } else {
            mesh.position(v)
        });
    });
    if builder.has_face_points() {
        mesh.faces().for_each(|f| builder.points.push(values[f]));
    }
    let first_edge = builder.points.len();
    let crease_vertices = CreaseVertices::new(creases, mesh.vertex_count());
    let mut level = SharpLevel {
        edges: Vec::new(),
        corners: creases.corners().to_vec(),
    };
    let mut edge_points = mesh.edge_map(0_u32);
    edge_points.reserve(builder.expected_edges());
    mesh.edges().for_each(|e| {
        let edge = builder.points.len() - first_edge;
        edge_points[e] = builder.points.len() as u32;
        let [a, b] = mesh.edge_vertices(e);
        let (point, faces) = edge_point(mesh, mask, e, |f| values[f]);
        builder.points.push(point);
        let by_topology = faces != 2;
        let ends = [numbers[a], numbers[b]];
        let sharpness = crease_vertices.sharpness(creases, ends, by_topology);
        if K::APPROXIMATES && sharpness > 0.0 {
            level.edges.push(SharpEdge {
                edge,
                ends,
                sharpness,
                by_topology,
            });
        }
    });
    builder.split_faces(mesh, |v| numbers[v], |e| edge_points[e])?;
    if level.is_empty() {
        return builder.finish(Creases::default());
    }
    let old = positions_by_number(mesh);
    let creases = level.place(&old, &mut builder.points, first_edge, creasing);
    builder.finish(creases)
}

/// Returns the positions of all vertices, in the order of the structure.
pub(crate) fn positions_by_number<M: MeshQuery>(mesh: &M) -> Vec<Point> {
    mesh.vertices().map(|v| mesh.position(v)).collect()
}

#[inline(always)]
pub(crate) fn face_value<M: MeshQuery, K: Mask>(mesh: &M, mask: K, f: M::Face) -> Point {
    let (sum, degree) = corner_sum(mesh, f);
    mask.face(sum, degree)
}

/// Returns the sum of the corners of `f` and the number of corners.
#[inline(always)]
pub(crate) fn corner_sum<M: MeshQuery>(mesh: &M, f: M::Face) -> (Point, usize) {
    let (mut sum, mut degree) = (Point::ZERO, 0);
    mesh.face_vertices(f).for_each(|v| {
        sum += mesh.position(v);
        degree += 1;
    });
    (sum, degree)
}

/// Returns the sum of the neighbours of `v` and the number of neighbours.
#[inline(always)]
pub(crate) fn neighbour_sum<M: MeshQuery>(mesh: &M, v: M::Vertex) -> (Point, usize) {
    let (mut sum, mut valence) = (Point::ZERO, 0);
    mesh.vertex_vertices(v).for_each(|w| {
        sum += mesh.position(w);
        valence += 1;
    });
    (sum, valence)
}

/// Returns the point of edge `e` as if `e` were not sharp, and the number of its faces. If this
/// number is not 2, the point is the midpoint.
#[inline(always)]
pub(crate) fn edge_point<M: MeshQuery, K: Mask>(
    mesh: &M,
    mask: K,
    e: M::Edge,
    face_value: impl Fn(M::Face) -> Point,
) -> (Point, usize) {
    // Not `map`: it is compiled to several functions for each structure and mask.
    let [a, b] = mesh.edge_vertices(e);
    let ends = [mesh.position(a), mesh.position(b)];
    let (mut sum, mut faces) = (Point::ZERO, 0);
    mesh.edge_faces(e).for_each(|f| {
        if K::EDGES_USE_FACES {
            sum += face_value(f);
        }
        faces += 1;
    });
    match faces {
        2 => (mask.edge(ends, sum), 2),
        _ => (midpoint(ends), faces),
    }
}

/// Returns the new position of vertex `v` as if nothing were sharp at `v`. An isolated vertex does
/// not move.
#[inline(always)]
pub(crate) fn vertex_point<M: MeshQuery, K: Mask>(
    mesh: &M,
    mask: K,
    v: M::Vertex,
    face_value: impl Fn(M::Face) -> Point,
) -> Point {
    let at = mesh.position(v);
    let (neighbours, valence) = neighbour_sum(mesh, v);
    if valence == 0 {
        return at;
    }
    let mut faces = Point::ZERO;
    if K::VERTICES_USE_FACES {
        mesh.vertex_faces(v).for_each(|f| faces += face_value(f));
    }
    mask.vertex(at, valence, neighbours, faces)
}
