//! The order in which a mix visits the elements. In sequential access, each structure uses its own
//! order of the elements. In random access and in patches, all structures use the same order.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use sixfold::{FaceId, FaceVertexMesh, MeshQuery, PolygonMesh, Representation, VertexId};

use crate::draw::{Draw, Side};
use crate::workload::Access;

/// Maximum number of faces of a patch.
const PATCH_FACES: usize = 128;

/// The elements of a mesh, in the order in which a mix visits them.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Whether each structure uses its own order. The lists are then empty.
    pub(crate) structure_order: bool,
    pub(crate) vertices: Vec<VertexId>,
    pub(crate) edges: Vec<Side>,
    pub(crate) faces: Vec<FaceId>,
}

impl Route {
    /// Builds the order in which a mix visits the elements of `polygons`. `seed` is the random
    /// seed. O(corners) expected.
    pub fn new(access: Access, polygons: &PolygonMesh, seed: u64) -> Self {
        let empty = Self {
            structure_order: true,
            vertices: Vec::new(),
            edges: Vec::new(),
            faces: Vec::new(),
        };
        match access {
            Access::Sequential => empty,
            Access::Random => {
                let draw = Draw::new(polygons, seed);
                Self {
                    structure_order: false,
                    vertices: draw.vertices,
                    edges: draw.edges,
                    faces: draw.faces,
                }
            }
            Access::Patches => match FaceVertexMesh::from_polygons(polygons) {
                Ok(mesh) => patches(&mesh, polygons, seed),
                Err(_) => empty, // refused only if the mesh has too many elements
            },
        }
    }
}

/// Builds patches around random faces until they have as many faces as the mesh. Patches contain no
/// isolated vertices.
fn patches(mesh: &FaceVertexMesh, polygons: &PolygonMesh, seed: u64) -> Route {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut route = Route {
        structure_order: false,
        vertices: Vec::new(),
        edges: Vec::new(),
        faces: Vec::new(),
    };
    let count = polygons.face_count();
    // For each element, the last patch that contains it.
    let mut face_seen = vec![0_u32; count];
    let mut vertex_seen = vec![0_u32; polygons.vertex_count()];
    let mut patch = 0;
    while route.faces.len() < count {
        patch += 1;
        let seed = random.random_range(0..count);
        let first = route.faces.len();
        let mut head = first;
        face_seen[seed] = patch;
        route.faces.push(FaceId::new(seed as u32));
        while head < route.faces.len() && head < first + PATCH_FACES {
            let face = route.faces[head];
            head += 1;
            for neighbour in mesh.face_faces(face) {
                if route.faces.len() < first + PATCH_FACES && face_seen[neighbour.index()] != patch
                {
                    face_seen[neighbour.index()] = patch;
                    route.faces.push(neighbour);
                }
            }
        }
        let sides = route.edges.len();
        for &face in &route.faces[first..] {
            let corners = polygons.faces().face(face);
            for (i, &v) in corners.iter().enumerate() {
                if vertex_seen[v.index()] != patch {
                    vertex_seen[v.index()] = patch;
                    route.vertices.push(v);
                }
                let next = corners[(i + 1) % corners.len()];
                let ends = [v.min(next), v.max(next)];
                route.edges.push(Side { face, ends });
            }
        }
        // Two sides of the patch with the same ends are one edge. Keep the first side.
        let mut of_patch = route.edges.split_off(sides);
        let mut order: Vec<usize> = (0..of_patch.len()).collect();
        order.sort_by_key(|&i| (of_patch[i].ends, i));
        let mut is_repeat = vec![false; of_patch.len()];
        for pair in order.windows(2) {
            is_repeat[pair[1]] = of_patch[pair[0]].ends == of_patch[pair[1]].ends;
        }
        let mut is_repeat = is_repeat.iter();
        of_patch.retain(|_| !is_repeat.next().is_some_and(|&repeat| repeat));
        route.edges.append(&mut of_patch);
    }
    route
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use sixfold::shapes;

    use super::*;

    #[test]
    fn a_patch_is_connected_and_contains_each_element_once() {
        let mesh = shapes::triangle_torus(40, 40).expect("small");
        let route = Route::new(Access::Patches, &mesh, 3);
        assert!(route.faces.len() >= mesh.face_count());
        let patch: BTreeSet<FaceId> = route.faces[..PATCH_FACES].iter().copied().collect();
        assert_eq!(patch.len(), PATCH_FACES);
        let built = FaceVertexMesh::from_polygons(&mesh).expect("closed");
        for &face in &route.faces[1..PATCH_FACES] {
            assert!(
                built
                    .face_faces(face)
                    .any(|neighbour| patch.contains(&neighbour))
            );
        }
        // A patch without a hole satisfies V − E + F = 1.
        let corners = |f: &FaceId| mesh.faces().face(*f).to_vec();
        let vertices: BTreeSet<VertexId> = patch.iter().flat_map(corners).collect();
        assert_eq!(
            route.vertices[..vertices.len()]
                .iter()
                .collect::<BTreeSet<_>>(),
            vertices.iter().collect()
        );
        let edges = vertices.len() + PATCH_FACES - 1;
        let ends: BTreeSet<_> = route.edges[..edges].iter().map(|side| side.ends).collect();
        assert_eq!(ends.len(), edges);
        assert_eq!(route, Route::new(Access::Patches, &mesh, 3));
        assert_ne!(route, Route::new(Access::Patches, &mesh, 4));
    }

    #[test]
    fn a_random_route_has_every_element_once() {
        let mesh = shapes::default_study();
        let route = Route::new(Access::Random, &mesh, 3);
        assert_eq!(route.faces.len(), mesh.face_count());
        assert_eq!(route.edges.len() * 2, mesh.corner_count());
        assert!(Route::new(Access::Sequential, &mesh, 3).structure_order);
    }
}
