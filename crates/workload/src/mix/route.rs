//! The order in which a mix visits the elements. In sequential access, each structure uses its own
//! order of the elements. In all other access orders, all structures use the same order.

use std::collections::{HashMap, HashSet};

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
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
            // Refused only if the mesh has too many elements.
            Access::Patches => FaceVertexMesh::from_polygons(polygons)
                .map_or(empty, |mesh| patches(&mesh, polygons, seed)),
            Access::Front => {
                FaceVertexMesh::from_polygons(polygons).map_or(empty, |mesh| front(&mesh, polygons))
            }
            Access::ByFace => by_face(polygons),
            Access::ByEdge => by_edge(polygons),
        }
    }
}

impl Route {
    /// Returns the numbers of the visited vertices, edges and faces. The number of an edge is that
    /// of its first end. In sequential access, edges have the order in which faces name them.
    pub(crate) fn numbers(&self, polygons: &PolygonMesh) -> [Vec<u32>; 3] {
        if self.structure_order {
            let route = by_edge(polygons);
            return [
                (0..polygons.vertex_count() as u32).collect(),
                route.numbers(polygons)[1].clone(),
                (0..polygons.face_count() as u32).collect(),
            ];
        }
        [
            self.vertices.iter().map(|v| v.index() as u32).collect(),
            self.edges
                .iter()
                .map(|side| side.ends[0].index() as u32)
                .collect(),
            self.faces.iter().map(|f| f.index() as u32).collect(),
        ]
    }

    /// Returns the numbers of the visited vertices, edges and faces. Edges are numbered in the order
    /// of their first visit. The lists are empty if each structure uses its own order.
    pub(crate) fn record_numbers(&self) -> [Vec<u32>; 3] {
        let mut known = HashMap::new();
        let edges = self.edges.iter().map(|side| {
            let next = known.len() as u32;
            *known.entry(side.ends).or_insert(next)
        });
        let edges = edges.collect();
        [
            self.vertices.iter().map(|v| v.index() as u32).collect(),
            edges,
            self.faces.iter().map(|f| f.index() as u32).collect(),
        ]
    }
}

/// Returns the sides of `face`, in the order of its corners.
fn sides(polygons: &PolygonMesh, face: FaceId) -> impl Iterator<Item = Side> {
    let corners = polygons.faces().face(face);
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(move |(&v, &next)| Side {
        face,
        ends: [v.min(next), v.max(next)],
    })
}

/// Grows a front from the first face, breadth first. Starts again in each component.
fn front(mesh: &FaceVertexMesh, polygons: &PolygonMesh) -> Route {
    let mut route = Route {
        structure_order: false,
        vertices: Vec::new(),
        edges: Vec::new(),
        faces: Vec::new(),
    };
    let mut face_seen = vec![false; polygons.face_count()];
    let mut vertex_seen = vec![false; polygons.vertex_count()];
    let mut edge_seen = HashSet::new();
    let mut head = 0;
    for (start, _) in polygons.faces().iter() {
        if !std::mem::replace(&mut face_seen[start.index()], true) {
            route.faces.push(start);
        }
        while let Some(&face) = route.faces.get(head) {
            head += 1;
            for side in sides(polygons, face) {
                if edge_seen.insert(side.ends) {
                    route.edges.push(side);
                }
            }
            for &v in polygons.faces().face(face) {
                if !std::mem::replace(&mut vertex_seen[v.index()], true) {
                    route.vertices.push(v);
                }
            }
            for next in mesh.face_faces(face) {
                if !std::mem::replace(&mut face_seen[next.index()], true) {
                    route.faces.push(next);
                }
            }
        }
    }
    route
}

/// Visits the faces, and at each face its vertices and edges.
fn by_face(polygons: &PolygonMesh) -> Route {
    let faces = || polygons.faces().iter();
    Route {
        structure_order: false,
        vertices: faces().flat_map(|(_, corners)| corners.to_vec()).collect(),
        edges: faces().flat_map(|(f, _)| sides(polygons, f)).collect(),
        faces: faces().map(|(f, _)| f).collect(),
    }
}

/// Visits the edges, and at each edge its ends and its faces.
fn by_edge(polygons: &PolygonMesh) -> Route {
    let mut edges: Vec<Side> = Vec::new();
    let mut places: HashMap<[VertexId; 2], usize> = HashMap::new();
    let mut faces: Vec<Vec<FaceId>> = Vec::new();
    for (f, _) in polygons.faces().iter() {
        for side in sides(polygons, f) {
            let place = *places.entry(side.ends).or_insert_with(|| {
                edges.push(side);
                faces.push(Vec::new());
                edges.len() - 1
            });
            faces[place].push(f);
        }
    }
    Route {
        structure_order: false,
        vertices: edges.iter().flat_map(|side| side.ends).collect(),
        edges,
        faces: faces.concat(),
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
    fn a_front_reaches_every_element_once_from_an_earlier_face() {
        let mesh = shapes::triangle_torus(12, 9).expect("small");
        let route = Route::new(Access::Front, &mesh, 3);
        assert_eq!(route.faces.len(), mesh.face_count());
        assert_eq!(route.vertices.len(), mesh.vertex_count());
        assert_eq!(route.edges.len() * 2, mesh.corner_count());
        let built = FaceVertexMesh::from_polygons(&mesh).expect("closed");
        let mut reached = BTreeSet::from([route.faces[0]]);
        for &face in &route.faces[1..] {
            assert!(built.face_faces(face).any(|f| reached.contains(&f)));
            assert!(reached.insert(face));
        }
        let distinct: BTreeSet<_> = route.edges.iter().map(|side| side.ends).collect();
        assert_eq!(distinct.len(), route.edges.len());
        // The front grows in all directions, so it leaves the order of the file.
        assert!(!route.faces.is_sorted());
        let positions: Vec<[f32; 3]> = (0..6_u8).map(|i| [f32::from(i), 0.0, 1.0]).collect();
        let two = PolygonMesh::new(positions, [[0, 1, 2], [3, 4, 5]]).expect("two faces");
        let route = Route::new(Access::Front, &two, 3);
        assert_eq!([route.faces.len(), route.vertices.len()], [2, 6]);
    }

    #[test]
    fn by_face_and_by_edge_visit_the_elements_of_each() {
        let mesh = shapes::tetrahedron();
        let route = Route::new(Access::ByFace, &mesh, 3);
        let corners = mesh
            .faces()
            .iter()
            .flat_map(|(_, corners)| corners.to_vec());
        assert!(route.vertices.iter().copied().eq(corners));
        assert_eq!([route.edges.len(), route.faces.len()], [12, 4]);
        let route = Route::new(Access::ByEdge, &mesh, 3);
        assert_eq!(
            [route.vertices.len(), route.edges.len(), route.faces.len()],
            [12, 6, 12]
        );
        for (i, side) in route.edges.iter().enumerate() {
            assert_eq!(route.vertices[2 * i..][..2], side.ends);
            for &f in &route.faces[2 * i..][..2] {
                let corners = mesh.faces().face(f);
                assert!(side.ends.iter().all(|v| corners.contains(v)));
            }
        }
    }

    #[test]
    fn a_random_route_has_every_element_once() {
        let mesh = shapes::built_in_mesh();
        let route = Route::new(Access::Random, &mesh, 3);
        assert_eq!(route.faces.len(), mesh.face_count());
        assert_eq!(route.edges.len() * 2, mesh.corner_count());
        assert!(Route::new(Access::Sequential, &mesh, 3).structure_order);
    }
}
