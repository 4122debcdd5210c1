//! Scatter: one pass over the faces, each of which gives to its corners and sides what it has.
//!
//! ```text
//!   each face     its value to every corner and every side        FV, FE
//!   each edge     its ends to each other                          met for the first time on the way
//! ```
//!
//! Only FV and FE are asked, which every structure answers at once: near-linear on all of them,
//! where edges and vertices that are no rows are found in hash maps.

use mesh_core::{Creases, MeshQuery, Point};

use crate::SubdivisionError;
use crate::crease::{SharpEdge, SharpLevel};
use crate::mask::{Mask, midpoint};
use crate::options::Creasing;
use crate::step::{Marked, Outline, Step};

/// What a vertex has been given.
#[derive(Clone, Copy, Default)]
struct VertexSum {
    at: Point,
    valence: u32,
    neighbours: Point,
    faces: Point,
}

/// What an edge has been given.
#[derive(Clone, Copy)]
struct EdgeSum {
    ends: [u32; 2],
    faces: Point,
    count: u32,
}

/// No edge has this number yet.
const UNMET: u32 = u32::MAX;

/// One step of a scheme that splits faces.
pub(crate) fn step<M: MeshQuery, K: Mask>(
    mesh: &M,
    mask: K,
    creases: &Creases,
    creasing: Creasing,
) -> Result<Step, SubdivisionError> {
    let mut outline = Outline::of(K::SPLIT, mesh);
    let mut numbers = mesh.vertex_map(0_u32);
    let mut vertices: Vec<VertexSum> = Vec::new();
    mesh.vertices().for_each(|v| {
        numbers[v] = vertices.len() as u32;
        vertices.push(VertexSum {
            at: mesh.position(v),
            ..VertexSum::default()
        });
    });
    let mut edge_numbers = mesh.edge_map(UNMET);
    let mut edges: Vec<EdgeSum> = Vec::with_capacity(mesh.face_count() * 3 / 2);
    // By corner: its vertex, and the edge of the side that starts there; and where faces end.
    let (mut corners, mut sides, mut face_ends) = (Vec::new(), Vec::new(), Vec::new());
    let mut values = Vec::with_capacity(mesh.face_count());
    mesh.faces().for_each(|f| {
        let first = corners.len();
        let mut sum = Point::ZERO;
        mesh.face_vertices(f).for_each(|v| {
            let number = numbers[v];
            sum += vertices[number as usize].at;
            corners.push(number);
        });
        let own = &corners[first..];
        let value = mask.face(sum, own.len());
        let mut corner = 0;
        mesh.face_edges(f).for_each(|e| {
            let number = &mut edge_numbers[e];
            if *number == UNMET {
                *number = edges.len() as u32;
                let next = if corner + 1 == own.len() {
                    0
                } else {
                    corner + 1
                };
                edges.push(EdgeSum {
                    ends: [own[corner], own[next]],
                    faces: Point::ZERO,
                    count: 0,
                });
            }
            let edge = &mut edges[*number as usize];
            edge.faces += value;
            edge.count += 1;
            sides.push(*number);
            corner += 1;
        });
        if K::VERTICES_SEE_FACES {
            for &v in own {
                vertices[v as usize].faces += value;
            }
        }
        values.push(value);
        face_ends.push(corners.len());
    });
    if K::APPROXIMATES {
        for edge in &edges {
            let [a, b] = edge.ends.map(|v| v as usize);
            let ends = [vertices[a].at, vertices[b].at];
            for (v, far) in [(a, ends[1]), (b, ends[0])] {
                vertices[v].neighbours += far;
                vertices[v].valence += 1;
            }
        }
    }
    outline
        .points
        .extend(vertices.iter().map(|v| match v.valence {
            0 => v.at,
            valence => mask.vertex(v.at, valence as usize, v.neighbours, v.faces),
        }));
    if outline.has_face_points() {
        outline.points.extend(&values);
    }
    let first_edge = outline.points.len();
    let marked = Marked::of(creases, vertices.len());
    let mut level = SharpLevel {
        edges: Vec::new(),
        corners: creases.corners().to_vec(),
    };
    for (number, &EdgeSum { ends, faces, count }) in edges.iter().enumerate() {
        let places = ends.map(|v| vertices[v as usize].at);
        outline.points.push(match count {
            2 => mask.edge(places, faces),
            _ => midpoint(places),
        });
        let by_nature = count != 2;
        let sharpness = marked.sharpness(creases, ends, by_nature);
        if K::APPROXIMATES && sharpness > 0.0 {
            level.edges.push(SharpEdge {
                edge: number,
                ends,
                sharpness,
                by_nature,
            });
        }
    }
    for side in &mut sides {
        *side += first_edge as u32;
    }
    let (mut face_point, mut start) = (vertices.len() as u32, 0);
    for end in face_ends {
        outline.split_face(&corners[start..end], &sides[start..end], face_point);
        (start, face_point) = (end, face_point + 1);
    }
    let old = |v: u32| vertices[v as usize].at;
    let creases = level.place(old, &mut outline.points, first_edge, creasing);
    outline.finish(creases)
}
