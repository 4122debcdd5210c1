//! The method scatter: one pass over the faces adds a value of each face to sums at its vertices
//! and edges.
//!
//! ```text
//!   each face     adds its value to every corner and every side   FV, FE
//!   each edge     adds its ends to each other                     when it is first found
//! ```
//!
//! The method queries only FV and FE, which every structure answers without a search. The time is
//! nearly linear in the number of corners on all structures. If a handle is not a row number, a
//! hash map finds the sum of the handle.

use sixfold_core::{Creases, HandleMap, MeshQuery, Point, VertexMap};

use crate::SubdivisionError;
use crate::crease::{SharpEdge, SharpLevel};
use crate::gather::positions_by_number;
use crate::mask::{Mask, midpoint};
use crate::options::Creasing;
use crate::step::{CreaseVertices, Step, StepBuilder};

/// The sums over the edges of a vertex.
#[derive(Clone, Copy, Default)]
struct VertexSum {
    valence: u32,
    neighbours: Point,
}

/// The ends of an edge, and the number of its faces found so far.
#[derive(Clone, Copy)]
struct EdgeSum {
    ends: [u32; 2],
    count: u32,
}

const UNNUMBERED: u32 = u32::MAX;

/// Runs one step of a scheme that splits faces.
///
/// The points of the result first store old positions, and for each edge the sum of its face
/// values.
pub(crate) fn step<M: MeshQuery, K: Mask>(
    mesh: &M,
    mask: K,
    creases: &Creases,
    creasing: Creasing,
    corners: usize,
) -> Result<Step, SubdivisionError> {
    let mut builder = StepBuilder::new(mask.split(), mesh, corners);
    let numbers = number_vertices(mesh, &mut builder);
    let vertices = builder.points.len();
    if builder.has_face_points() {
        builder
            .points
            .resize(vertices + mesh.face_count(), Point::ZERO);
    }
    let first_edge = builder.points.len();
    let FaceSums {
        edges,
        vertex_faces,
    } = scatter_faces(mesh, mask, &numbers, &mut builder);
    let (old, new) = builder.points.split_at_mut(vertices);
    let edge_points = &mut new[first_edge - vertices..];
    let sums = match K::APPROXIMATES {
        true => neighbour_sums(&edges, old),
        false => Vec::new(),
    };
    let level = place_edge_points(mask, &edges, old, edge_points, creases);
    place_vertex_points(mask, &sums, &vertex_faces, old);
    if level.is_empty() {
        return builder.finish(Creases::default());
    }
    let old = positions_by_number(mesh);
    let creases = level.place(&old, &mut builder.points, first_edge, creasing);
    builder.finish(creases)
}

/// Numbers the vertices in their order, and makes their positions the first points.
#[inline(always)]
fn number_vertices<M: MeshQuery>(mesh: &M, builder: &mut StepBuilder) -> VertexMap<M, u32> {
    let mut numbers = mesh.vertex_map(0_u32);
    numbers.reserve(builder.vertices());
    mesh.vertices().for_each(|v| {
        numbers[v] = builder.points.len() as u32;
        builder.points.push(mesh.position(v));
    });
    numbers
}

struct FaceSums {
    /// The edges in the order in which they are found.
    edges: Vec<EdgeSum>,
    /// The sum of the face values at each vertex. Empty if the scheme does not use this sum.
    vertex_faces: Vec<Point>,
}

/// Adds the value of each face to its corners and sides, adds the edge points, and splits the face.
#[inline(always)]
fn scatter_faces<M: MeshQuery, K: Mask>(
    mesh: &M,
    mask: K,
    numbers: &VertexMap<M, u32>,
    builder: &mut StepBuilder,
) -> FaceSums {
    let mut vertex_faces = Vec::new();
    if K::VERTICES_USE_FACES {
        vertex_faces.resize(builder.vertices(), Point::ZERO);
    }
    let mut edge_numbers = mesh.edge_map(UNNUMBERED);
    edge_numbers.reserve(builder.expected_edges());
    let mut edges: Vec<EdgeSum> = Vec::with_capacity(builder.expected_edges());
    let first_edge = builder.points.len();
    // For one face: its vertices, and the edge points of its sides.
    let (mut own, mut middles) = (Vec::new(), Vec::new());
    for (face_point, f) in (builder.vertices()..).zip(mesh.faces()) {
        own.clear();
        middles.clear();
        let mut sum = Point::ZERO;
        for v in mesh.face_vertices(f) {
            let number = numbers[v];
            sum += builder.points[number as usize];
            own.push(number);
        }
        let value = mask.face(sum, own.len());
        for (corner, e) in mesh.face_edges(f).enumerate() {
            let number = &mut edge_numbers[e];
            if *number == UNNUMBERED {
                *number = edges.len() as u32;
                let ends = side_ends(&own, corner);
                edges.push(EdgeSum { ends, count: 0 });
                builder.points.push(Point::ZERO);
            }
            let middle = first_edge + *number as usize;
            builder.points[middle] += value;
            edges[*number as usize].count += 1;
            middles.push(middle as u32);
        }
        if K::VERTICES_USE_FACES {
            for &v in &own {
                vertex_faces[v as usize] += value;
            }
        }
        builder.split_face(&own, &middles, face_point as u32);
        if builder.has_face_points() {
            builder.points[face_point] = value;
        }
    }
    FaceSums {
        edges,
        vertex_faces,
    }
}

#[inline(always)]
fn side_ends(corners: &[u32], corner: usize) -> [u32; 2] {
    let next = if corner + 1 == corners.len() {
        0
    } else {
        corner + 1
    };
    [corners[corner], corners[next]]
}

fn neighbour_sums(edges: &[EdgeSum], old: &[Point]) -> Vec<VertexSum> {
    let mut sums = vec![VertexSum::default(); old.len()];
    for edge in edges {
        let [a, b] = edge.ends.map(|v| v as usize);
        for (v, far) in [(a, b), (b, a)] {
            sums[v].neighbours += old[far];
            sums[v].valence += 1;
        }
    }
    sums
}

/// Places the edge points as if no edge were sharp. Returns the sharp elements.
#[inline(always)]
fn place_edge_points<K: Mask>(
    mask: K,
    edges: &[EdgeSum],
    old: &[Point],
    edge_points: &mut [Point],
    creases: &Creases,
) -> SharpLevel {
    let crease_vertices = CreaseVertices::new(creases, old.len());
    let mut level = SharpLevel {
        edges: Vec::new(),
        corners: creases.corners().to_vec(),
    };
    for (number, (&EdgeSum { ends, count }, point)) in edges.iter().zip(edge_points).enumerate() {
        let places = ends.map(|v| old[v as usize]);
        *point = match count {
            2 => mask.edge(places, *point),
            _ => midpoint(places),
        };
        let by_topology = count != 2;
        let sharpness = crease_vertices.sharpness(creases, ends, by_topology);
        if K::APPROXIMATES && sharpness > 0.0 {
            level.edges.push(SharpEdge {
                edge: number,
                ends,
                sharpness,
                by_topology,
            });
        }
    }
    level
}

/// Places the vertices that have edges, as if nothing were sharp.
fn place_vertex_points<K: Mask>(
    mask: K,
    sums: &[VertexSum],
    vertex_faces: &[Point],
    old: &mut [Point],
) {
    for (v, sum) in sums.iter().enumerate().filter(|(_, sum)| sum.valence > 0) {
        let faces = match K::VERTICES_USE_FACES {
            true => vertex_faces[v],
            false => Point::ZERO,
        };
        old[v] = mask.vertex(old[v], sum.valence as usize, sum.neighbours, faces);
    }
}
