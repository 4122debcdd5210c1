//! Scatter: one pass over the faces adds the value of each face to its corners and sides.
//!
//! ```text
//!   each face     adds its value to every corner and every side   FV, FE
//!   each edge     adds its ends to each other                     when it is first found
//! ```
//!
//! Only FV and FE are queried, which no structure has to search for. The time is near-linear on all
//! structures; edges and vertices whose handles are not rows are found in hash maps.

use sixfold_core::{Creases, HandleMap, MeshQuery, Point};

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

/// Marks an edge that has no number yet.
const UNNUMBERED: u32 = u32::MAX;

/// Runs one step of a scheme that splits faces.
///
/// Until the points of the result are placed, they store the old positions and, for each edge, the
/// sum of its face values.
pub(crate) fn step<M: MeshQuery, K: Mask>(
    mesh: &M,
    mask: K,
    creases: &Creases,
    creasing: Creasing,
    corners: usize,
) -> Result<Step, SubdivisionError> {
    let mut builder = StepBuilder::new(K::SPLIT, mesh, corners);
    let mut numbers = mesh.vertex_map(0_u32);
    numbers.reserve(builder.vertices());
    mesh.vertices().for_each(|v| {
        numbers[v] = builder.points.len() as u32;
        builder.points.push(mesh.position(v));
    });
    let vertices = builder.points.len();
    if builder.has_face_points() {
        builder
            .points
            .resize(vertices + mesh.face_count(), Point::ZERO);
    }
    let first_edge = builder.points.len();
    let mut vertex_faces = Vec::new();
    if K::VERTICES_USE_FACES {
        vertex_faces.resize(vertices, Point::ZERO);
    }
    let mut edge_numbers = mesh.edge_map(UNNUMBERED);
    edge_numbers.reserve(builder.expected_edges());
    let mut edges: Vec<EdgeSum> = Vec::with_capacity(builder.expected_edges());
    // For one face: its vertices, and the edge points of the sides that start there.
    let (mut own, mut middles) = (Vec::new(), Vec::new());
    let mut face_point = vertices;
    mesh.faces().for_each(|f| {
        own.clear();
        middles.clear();
        let mut sum = Point::ZERO;
        mesh.face_vertices(f).for_each(|v| {
            let number = numbers[v];
            sum += builder.points[number as usize];
            own.push(number);
        });
        let value = mask.face(sum, own.len());
        let mut corner = 0;
        mesh.face_edges(f).for_each(|e| {
            let number = &mut edge_numbers[e];
            if *number == UNNUMBERED {
                *number = edges.len() as u32;
                let next = if corner + 1 == own.len() {
                    0
                } else {
                    corner + 1
                };
                edges.push(EdgeSum {
                    ends: [own[corner], own[next]],
                    count: 0,
                });
                builder.points.push(Point::ZERO);
            }
            let middle = first_edge + *number as usize;
            builder.points[middle] += value;
            edges[*number as usize].count += 1;
            middles.push(middle as u32);
            corner += 1;
        });
        if K::VERTICES_USE_FACES {
            for &v in &own {
                vertex_faces[v as usize] += value;
            }
        }
        builder.split_face(&own, &middles, face_point as u32);
        if builder.has_face_points() {
            builder.points[face_point] = value;
        }
        face_point += 1;
    });
    let (old, edge_points) = builder.points.split_at_mut(first_edge);
    let mut sums = Vec::new();
    if K::APPROXIMATES {
        sums.resize(vertices, VertexSum::default());
        for edge in &edges {
            let [a, b] = edge.ends.map(|v| v as usize);
            for (v, far) in [(a, b), (b, a)] {
                sums[v].neighbours += old[far];
                sums[v].valence += 1;
            }
        }
    }
    let crease_vertices = CreaseVertices::new(creases, vertices);
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
    for (v, sum) in sums.iter().enumerate().filter(|(_, sum)| sum.valence > 0) {
        let faces = match K::VERTICES_USE_FACES {
            true => vertex_faces[v],
            false => Point::ZERO,
        };
        old[v] = mask.vertex(old[v], sum.valence as usize, sum.neighbours, faces);
    }
    if level.is_empty() {
        return builder.finish(Creases::default());
    }
    let old = positions_by_number(mesh);
    let creases = level.place(old, &mut builder.points, first_edge, creasing);
    builder.finish(creases)
}
