//! A random order of the elements of a mesh. The order depends only on the mesh and on a seed.

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use sixfold::{FaceId, PolygonMesh, VertexId};

/// An edge of a face, given by the face and by the two ends of the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    /// The face.
    pub face: FaceId,
    /// The two ends of the edge. The end with the lower number is first.
    pub ends: [VertexId; 2],
}

/// All elements of a mesh in random order. For each kind of element, the first n elements are a
/// uniform random sample of all elements of this kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// All vertices of the mesh in random order.
    pub vertices: Vec<VertexId>,
    /// All edges of the mesh in random order. Each edge is given together with one of its faces.
    pub edges: Vec<Side>,
    /// All faces of the mesh in random order.
    pub faces: Vec<FaceId>,
}

impl Draw {
    /// Shuffles the elements of `polygons` with the random seed `seed`. Takes O(n log n) time for a
    /// mesh with n corners.
    pub fn new(polygons: &PolygonMesh, seed: u64) -> Self {
        let mut draw = Self {
            vertices: polygons.vertices().collect(),
            edges: edges_of(polygons),
            faces: polygons.faces().iter().map(|(f, _)| f).collect(),
        };
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        draw.vertices.shuffle(&mut random);
        draw.edges.shuffle(&mut random);
        draw.faces.shuffle(&mut random);
        draw
    }

    /// Returns the numbers of vertices, edges and faces.
    pub fn population(&self) -> [usize; 3] {
        [self.vertices.len(), self.edges.len(), self.faces.len()]
    }
}

fn edges_of(polygons: &PolygonMesh) -> Vec<Side> {
    let mut sides = Vec::with_capacity(polygons.corner_count());
    for (face, corners) in polygons.faces().iter() {
        let next = corners.iter().cycle().skip(1);
        sides.extend(corners.iter().zip(next).map(|(&a, &b)| Side {
            face,
            ends: [a.min(b), a.max(b)],
        }));
    }
    sides.sort_unstable_by_key(|side| (side.ends, side.face));
    sides.dedup_by_key(|side| side.ends);
    sides
}

#[cfg(test)]
mod tests {
    use super::*;
    use sixfold::shapes;

    #[test]
    fn every_edge_is_drawn_once_as_a_side_of_one_of_its_faces() {
        let mesh = shapes::built_in_mesh();
        let draw = Draw::new(&mesh, 7);
        assert_eq!(draw.edges.len() * 2, mesh.corner_count(), "closed");
        for side in &draw.edges {
            let corners = mesh.faces().face(side.face);
            assert!(side.ends.iter().all(|end| corners.contains(end)));
        }
        let mut edges: Vec<_> = draw.edges.iter().map(|side| side.ends).collect();
        edges.sort_unstable();
        edges.dedup();
        assert_eq!(edges.len(), draw.edges.len());
    }

    #[test]
    fn the_seed_determines_the_order() {
        let mesh = shapes::built_in_mesh();
        assert_eq!(Draw::new(&mesh, 7), Draw::new(&mesh, 7));
        assert_ne!(Draw::new(&mesh, 7), Draw::new(&mesh, 8));
    }
}
