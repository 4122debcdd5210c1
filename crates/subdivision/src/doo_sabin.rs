//! Doo–Sabin: every corner of a face becomes a vertex, and every face, inner edge and inner vertex
//! becomes a face. The limit surface is C¹.
//!
//! The scheme is that of Doo & Sabin (1978). The input may have polygons of any degree. After one
//! step, all inner vertices have valence 4, except next to a vertex of valence 2.
//!
//! ```text
//!   ┌───────────┬──            each corner i of a face of degree n moves into the face:
//!   │ •───────• │ •
//!   │ │ face  │e│ │              vᵢ' = Σ aᵢⱼ vⱼ     aᵢᵢ = (n + 5)/(4n)
//!   │ │       │d│ │                                aᵢⱼ = (3 + 2 cos(2π(i − j)/n))/(4n)
//!   │ •───────• │ •
//!   ├──edge─────v──            then faces join them: one in each old face, one (a quad) across each
//!   │ •───────• │ •            inner edge, one around each inner vertex
//! ```
//!
//! Boundary edges and boundary vertices do not become faces, so a mesh with a boundary shrinks. An
//! inner vertex of valence 2 does not become a face; instead, the two quads that replace its edges
//! share an edge. Isolated vertices are removed.
//!
//! # Sizes
//!
//! The mesh has V vertices, of which I are isolated, and T are inner vertices with two faces. The
//! mesh has E edges, of which B are boundary edges. The mesh has F faces with C corners in total. R
//! of the C corners are at boundary vertices. After a step, the sizes are V', E', F', C', B' and
//! R':
//!
//! ```text
//!   V' = C      E' = C + 2(E − B) − T      F' = F + (E − B) + (V − I − B − T)
//!   C' = 2C + 4(E − B) − R − 2T            B' = R      R' = 3R − 2B
//! ```

use std::f64::consts::TAU;

use sixfold_core::{Creases, FaceList, MeshQuery, Point, PolygonMesh, VertexId};

use crate::connectivity::{Connectivity, non_manifold_vertex, vertex_numbers};
use crate::error::SubdivisionError;
use crate::scheme::Scheme;
use crate::step::Step;

/// Number of degrees with precomputed weights.
const PRECOMPUTED: usize = 16;

/// The weights of Doo & Sabin (1978), as three sums for all n corners of a face:
/// vᵢ' = vᵢ/4 + 3/4 · mean + (cos(2πi/n) Σ cos(2πj/n) vⱼ + sin(2πi/n) Σ sin(2πj/n) vⱼ)/(2n).
struct DooSabin {
    /// Cos and sin of 2πi/n, by degree n.
    unit_roots: [Vec<[f32; 2]>; PRECOMPUTED],
}

/// Returns cos and sin of 2πi/n for every i.
fn unit_roots(degree: usize) -> Vec<[f32; 2]> {
    let angles = (0..degree).map(|i| TAU * i as f64 / degree as f64);
    let unit_roots = angles.map(|angle| [angle.cos() as f32, angle.sin() as f32]);
    unit_roots.collect()
}

impl DooSabin {
    fn new() -> Self {
        Self {
            unit_roots: std::array::from_fn(unit_roots),
        }
    }

    /// Appends the points of the corners of a face; O(degree).
    fn face(&self, corners: &[Point], points: &mut Vec<Point>) {
        let computed;
        let unit_roots = match self.unit_roots.get(corners.len()) {
            Some(unit_roots) => unit_roots,
            None => {
                computed = unit_roots(corners.len());
                &computed
            }
        };
        let share = 1.0 / corners.len() as f32;
        let mut sums = [Point::ZERO; 3];
        for (&at, &[cos, sin]) in corners.iter().zip(unit_roots) {
            sums[0] += at;
            sums[1] += at * cos;
            sums[2] += at * sin;
        }
        let [mean, cos_mean, sin_mean] = sums.map(|sum| sum * share);
        points.extend(corners.iter().zip(unit_roots).map(|(&at, &[cos, sin])| {
            at * 0.25 + mean * 0.75 + (cos_mean * cos + sin_mean * sin) * 0.5
        }));
    }
}

/// Runs one step with queries. O(sum of the squares of the degrees) plus the cost of the queries.
pub(crate) fn gather<M: MeshQuery>(mesh: &M) -> Result<Step, SubdivisionError> {
    let connectivity = Connectivity::gathered(mesh, Scheme::DooSabin)?;
    let mut builder = Builder::new(mesh, &connectivity)?;
    builder.add_edge_faces(&connectivity)?;
    let mut first_corners = mesh.face_map(0_u32);
    let mut first = 0;
    mesh.faces().for_each(|f| {
        first_corners[f] = first;
        first += mesh.face_vertices(f).count() as u32;
    });
    let numbers = vertex_numbers(mesh);
    let (mut spokes, mut around) = (Vec::new(), Vec::new());
    for v in mesh.vertices() {
        // The corners at v, each with the neighbour that follows v in the face.
        spokes.clear();
        mesh.vertex_faces(v).for_each(|f| {
            let mut corner = first_corners[f];
            while connectivity.corners[corner as usize] != numbers[v] {
                corner = connectivity.next(corner);
            }
            let [_, next] = connectivity.ends(corner);
            spokes.push((next, corner));
        });
        spokes.sort_unstable();
        let Some(ring) = mesh.one_ring(v) else {
            return Err(non_manifold_vertex(Scheme::DooSabin, numbers[v]));
        };
        around.clear();
        let mut valence = 0;
        ring.for_each(|w| {
            valence += 1;
            let at = spokes.binary_search_by_key(&numbers[w], |&(next, _)| next);
            around.extend(at.ok().map(|at| spokes[at].1));
        });
        if valence == around.len() {
            builder.add_vertex_face(&around)?;
        }
    }
    builder.finish()
}

/// Runs one step with one pass over the faces.
pub(crate) fn scatter<M: MeshQuery>(mesh: &M) -> Result<Step, SubdivisionError> {
    let connectivity = Connectivity::scattered(mesh, Scheme::DooSabin)?;
    let mut builder = Builder::new(mesh, &connectivity)?;
    builder.add_edge_faces(&connectivity)?;
    connectivity.for_each_inner_fan(mesh.vertex_count(), Scheme::DooSabin, |around| {
        builder.add_vertex_face(around)
    })?;
    builder.finish()
}

struct Builder {
    points: Vec<Point>,
    faces: FaceList,
}

impl Builder {
    /// Adds the moved corners of the old faces, and one face for each old face.
    fn new<M: MeshQuery>(mesh: &M, connectivity: &Connectivity) -> Result<Self, SubdivisionError> {
        let scheme = DooSabin::new();
        let mut builder = Self {
            points: Vec::with_capacity(connectivity.corners.len()),
            faces: FaceList::with_capacity(4 * connectivity.corners.len()),
        };
        let mut corners = Vec::new();
        for f in mesh.faces() {
            corners.clear();
            mesh.face_vertices(f)
                .for_each(|v| corners.push(mesh.position(v)));
            let first = builder.points.len() as u32;
            scheme.face(&corners, &mut builder.points);
            builder.push(first..builder.points.len() as u32)?;
        }
        Ok(builder)
    }

    /// Adds a quad across each inner edge.
    ///
    /// ```text
    ///      b             side c runs a → b, d is its twin:
    ///   lb │ rb          (la, ra, rb, lb) = (c, next(d), d, next(c))
    ///   la │ ra
    ///      a
    /// ```
    fn add_edge_faces(&mut self, connectivity: &Connectivity) -> Result<(), SubdivisionError> {
        for edge in connectivity.edges() {
            if let Some(other) = edge.second {
                let [lb, ra] = [edge.first, other].map(|side| connectivity.next(side));
                self.push([edge.first, ra, other, lb])?;
            }
        }
        Ok(())
    }

    /// Adds the face of an inner vertex, unless the vertex has only two corners.
    fn add_vertex_face(&mut self, around: &[u32]) -> Result<(), SubdivisionError> {
        if around.len() > 2 {
            self.push(around.iter().copied())?;
        }
        Ok(())
    }

    fn push(&mut self, corners: impl IntoIterator<Item = u32>) -> Result<(), SubdivisionError> {
        let face = corners.into_iter().map(VertexId::new);
        Ok(self.faces.push(face)?)
    }

    fn finish(self) -> Result<Step, SubdivisionError> {
        Ok(Step {
            polygons: PolygonMesh::from_faces(self.points, self.faces)?,
            creases: Creases::default(),
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sixfold_core::{Facts, Representation};
    use sixfold_half_edge::HalfEdgeMesh;
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::test_support::{assert_affine, assert_equivalent, assert_near, build};
    use crate::{Method, Subdivision, subdivide};

    fn step_of<M: Representation>(method: Method, polygons: &PolygonMesh) -> PolygonMesh {
        let scheme = Subdivision::new(Scheme::DooSabin);
        let none = Creases::default();
        let step = subdivide::<M>(&scheme, method, polygons, &none, 1);
        step.expect("a manifold").polygons
    }

    #[test]
    fn the_weights_match_the_paper() {
        for degree in [3, 4, 5, 6, 11, 40] {
            let n = degree as f64;
            let mut unit = vec![Point::ZERO; degree];
            unit[1] = Point::X;
            let mut points = Vec::new();
            DooSabin::new().face(&unit, &mut points);
            for (i, point) in points.iter().enumerate() {
                let angle = TAU * (i as f64 - 1.0) / n;
                let weight = match i {
                    1 => (n + 5.0) / (4.0 * n),
                    _ => (3.0 + 2.0 * angle.cos()) / (4.0 * n),
                };
                assert_near(*point, Point::X * weight as f32);
            }
        }
    }

    #[test]
    fn a_cube_matches_the_paper() {
        let cube = sixfold_shapes::cube();
        let centre = cube.positions().iter().sum::<Point>() / 8.0;
        let half = (cube.positions()[0] - centre).abs().x;
        for method in [Method::Gather, Method::Scatter] {
            let step = step_of::<IndexedFaceSet>(method, &cube);
            assert_eq!([step.vertex_count(), step.face_count()], [24, 26]);
            for p in step.positions() {
                let mut sizes = ((*p - centre).abs() / half).to_array();
                sizes.sort_by(f32::total_cmp);
                assert_near(Point::from(sizes), Point::new(0.5, 0.5, 1.0));
            }
            let degrees = |n| {
                step.faces()
                    .iter()
                    .filter(|(_, face)| face.len() == n)
                    .count()
            };
            assert_eq!([degrees(3), degrees(4)], [8, 18]);
            let facts = Facts::from_polygons(&step);
            assert_eq!((facts.genus, facts.edges), (Some(0), 48));
            assert_eq!(facts.valence.map(|v| (v.min, v.max)), Some((4, 4)));
        }
    }

    #[test]
    fn two_triangles_back_to_back_become_a_prism() {
        let corners = [Point::ZERO, Point::X, Point::Y];
        let pillow = PolygonMesh::new(corners, [[0, 1, 2], [0, 2, 1]]).expect("two triangles");
        for method in [Method::Gather, Method::Scatter] {
            let facts = Facts::from_polygons(&step_of::<IndexedFaceSet>(method, &pillow));
            assert_eq!([facts.vertices, facts.edges, facts.faces], [6, 9, 5]);
            assert_eq!(facts.genus, Some(0));
        }
    }

    #[test]
    fn an_open_mesh_shrinks() {
        let grid = sixfold_shapes::grid(3, 2).expect("a small grid");
        for method in [Method::Gather, Method::Scatter] {
            let step = step_of::<IndexedFaceSet>(method, &grid);
            assert_eq!([step.vertex_count(), step.face_count()], [24, 15]);
            let facts = Facts::from_polygons(&step);
            assert_eq!((facts.boundary_loops, facts.boundary_edges), (Some(1), 16));
        }
    }

    #[test]
    fn non_manifold_meshes_return_errors() {
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(Point::splat);
        let error_of = |faces: &[[u32; 3]]| {
            let mesh: IndexedFaceSet = build(&PolygonMesh::new(corners, faces).expect("valid"));
            let errors = [gather(&mesh), scatter(&mesh)].map(|step| step.expect_err("no rule"));
            assert_eq!(errors[0], errors[1]);
            errors[0].clone()
        };
        let scheme = Scheme::DooSabin;
        let edge = |faces| SubdivisionError::NonManifoldEdge {
            scheme,
            ends: [0, 1].map(VertexId::new),
            faces,
        };
        assert_eq!(error_of(&[[0, 1, 2], [1, 0, 3], [1, 0, 4]]), edge(3));
        assert_eq!(error_of(&[[0, 1, 2], [0, 1, 3]]), edge(2));
        let vertex = VertexId::new(0);
        let several = SubdivisionError::NonManifoldVertex { scheme, vertex };
        assert_eq!(error_of(&[[0, 1, 2], [0, 3, 4]]), several);
        let cones = [
            [0, 1, 2],
            [0, 2, 3],
            [0, 3, 1],
            [0, 4, 5],
            [0, 5, 6],
            [0, 6, 4],
        ];
        assert_eq!(error_of(&cones), several);
        assert_eq!(
            error_of(&[cones[0], cones[1], cones[2], [0, 4, 5]]),
            several
        );
    }

    #[test]
    fn a_face_of_large_degree_is_fast_enough() {
        let corners = 30_000;
        let around = (0..corners).map(|i| {
            let angle = TAU * f64::from(i) / f64::from(corners);
            Point::new(angle.cos() as f32, angle.sin() as f32, 0.0)
        });
        let all: Vec<u32> = (0..corners).collect();
        let polygon = PolygonMesh::new(around.collect::<Vec<_>>(), [all]).expect("one face");
        let step = step_of::<IndexedFaceSet>(Method::Scatter, &polygon);
        for (p, old) in step.positions().iter().zip(polygon.positions()) {
            assert!(
                p.distance(*old * 0.5) < 1e-4 || p.distance(*old * 0.75) < 1e-4,
                "{p}"
            );
        }
    }

    proptest! {
        #[test]
        fn all_methods_agree(mesh in sixfold_conformance::strategy::manifold_mesh()) {
            let list = step_of::<IndexedFaceSet>(Method::Gather, &mesh);
            let known = list.vertex_count();
            assert_equivalent(&list, &step_of::<IndexedFaceSet>(Method::Scatter, &mesh), known);
            // A structure may start a face at another corner. Its own faces are the reference here.
            let halves = HalfEdgeMesh::from_polygons(&mesh).expect("a manifold").to_polygons();
            let list = step_of::<IndexedFaceSet>(Method::Gather, &halves);
            for method in [Method::Gather, Method::Scatter] {
                assert_equivalent(&list, &step_of::<HalfEdgeMesh>(method, &mesh), known);
            }
        }

        #[test]
        fn affine_maps_commute(mesh in sixfold_conformance::strategy::manifold_mesh()) {
            assert_affine(Scheme::DooSabin, &mesh, 0);
        }
    }
}
