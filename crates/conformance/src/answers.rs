//! The answers to all queries of a mesh, in a form that is the same for every structure.

use std::collections::BTreeMap;

use sixfold_core::{PolygonMesh, Relation, Representation};

use crate::element::Element;
use crate::subject::Subject;

/// Returns the answers of `M` for every relation of every element, every one-ring and every
/// boundary loop. Returns `None` if `M` cannot hold `polygons`.
///
/// Elements are identified by their numbers in `polygons`. Sets are sorted, and cycles start at
/// their lowest element. The key of a one-ring is, for example, `one_ring v7`. If a vertex has no
/// one-ring, the key of its one-ring is missing. Boundary loops are lists of vertices. The key of a
/// closed loop is for example `boundary_loop 0`, and the key of an open chain is for example
/// `boundary_chain 0`.
pub fn answers<M: Representation>(
    polygons: &PolygonMesh,
) -> Option<BTreeMap<String, Vec<Element>>> {
    let subject = Subject::<M>::from_polygons(polygons)?;
    let mut answers = BTreeMap::new();
    for relation in Relation::ALL {
        for element in subject.oracle.domain(relation) {
            let mut answer = subject.query(relation, element);
            match relation {
                Relation::FaceVertices | Relation::FaceEdges => rotate_to_lowest(&mut answer),
                _ => answer.sort(),
            }
            answers.insert(format!("{relation} {element}"), answer);
        }
    }
    for v in subject.oracle.vertices() {
        if let Some(ring) = subject.handles.ring(&subject.mesh, v) {
            let mut ring: Vec<_> = ring.into_iter().map(Element::Vertex).collect();
            if !subject.oracle.is_boundary(v) {
                rotate_to_lowest(&mut ring);
            }
            answers.insert(format!("one_ring {v}"), ring);
        }
    }
    for (i, chain) in subject.mesh.boundary_loops().into_iter().enumerate() {
        let kind = if chain.is_closed() { "loop" } else { "chain" };
        let vertices = chain.vertices.into_iter();
        let vertices = vertices.map(|v| Element::Vertex(subject.handles.vertex_id(v)));
        answers.insert(format!("boundary_{kind} {i}"), vertices.collect());
    }
    Some(answers)
}

fn rotate_to_lowest(cycle: &mut [Element]) {
    let lowest = (0..cycle.len()).min_by_key(|&i| cycle[i]);
    cycle.rotate_left(lowest.unwrap_or(0));
}
