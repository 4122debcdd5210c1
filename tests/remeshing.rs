//! Checks that decimation, remeshing and Delaunay flips give bit-identical meshes on every
//! structure.

use sixfold::EditableHalfEdgeMesh;
use sixfold::remeshing::{
    Decimation, DecimationBoundary, Remeshing, Target, decimate, flip_to_delaunay,
    meets_link_condition, remesh,
};
use sixfold::{for_each_editable, shapes};
use sixfold_core::{EditError, MeshEdit, MeshQuery, Point, PolygonMesh, Representation};

/// Returns closed and open surfaces. One surface is rough and has corners.
pub(crate) fn surfaces() -> [PolygonMesh; 4] {
    let message = "a small shape";
    let flat = shapes::triangle_grid(12, 12).expect(message);
    let rough = flat.positions().iter().map(|p| {
        let height = (p.x * p.y) as u32 % 3;
        Point::new(p.x, p.y, height as f32)
    });
    let rough = PolygonMesh::from_faces(rough.collect(), flat.faces().clone());
    [
        shapes::geodesic(4).expect(message),
        shapes::triangle_torus(11, 7).expect(message),
        flat,
        rough.expect("the same faces"),
    ]
}

/// Returns the sorted faces. A face consists of the bits of its corners and starts at its lowest
/// corner.
fn faces(polygons: &PolygonMesh) -> Vec<Vec<[u32; 3]>> {
    let faces = polygons.faces().iter().map(|(_, face)| {
        // Adding zero turns −0 into 0.
        let at = |v| {
            (polygons.position(v) + Point::ZERO)
                .to_array()
                .map(f32::to_bits)
        };
        let mut corners: Vec<[u32; 3]> = face.iter().map(|&v| at(v)).collect();
        let least = (0..corners.len()).min_by_key(|&i| corners[i]).unwrap_or(0);
        corners.rotate_left(least);
        corners
    });
    let mut faces: Vec<_> = faces.collect();
    faces.sort_unstable();
    faces
}

/// An operator that runs on any structure, and on a mesh with data.
pub(crate) trait Operator {
    fn run<M: MeshEdit>(&self, mesh: &mut M);
}

impl Operator for Decimation {
    fn run<M: MeshEdit>(&self, mesh: &mut M) {
        let report = decimate(mesh, self).expect("triangles");
        assert!(report.collapses > 10, "{report:?}");
    }
}

impl Operator for Remeshing {
    fn run<M: MeshEdit>(&self, mesh: &mut M) {
        let report = remesh(mesh, self).expect("triangles");
        assert!(report.splits + report.collapses > 10, "{report:?}");
    }
}

pub(crate) struct Delaunay;

impl Operator for Delaunay {
    fn run<M: MeshEdit>(&self, mesh: &mut M) {
        flip_to_delaunay(mesh).expect("triangles");
    }
}

fn compare_structures(operator: &impl Operator, polygons: &PolygonMesh, what: &str) {
    let mut first: Option<Vec<Vec<[u32; 3]>>> = None;
    for_each_editable!(M => {
        let mut mesh = M::from_polygons(polygons).expect("all hold a triangle manifold");
        operator.run(&mut mesh);
        assert_eq!(mesh.validate(), Ok(()));
        let got = faces(&mesh.to_polygons());
        let same = first.get_or_insert_with(|| got.clone()) == &got;
        assert!(same, "{what} on {} gives another mesh", M::NAME);
    });
}

#[test]
fn decimation_is_the_same_on_all() {
    for (i, polygons) in surfaces().iter().enumerate() {
        for boundary in [DecimationBoundary::Follow, DecimationBoundary::Fixed] {
            for ratio in [0.6, 0.3, 0.1] {
                let target = Target::Ratio(ratio);
                let operator = Decimation {
                    target,
                    boundary,
                    ..Decimation::default()
                };
                compare_structures(&operator, polygons, &format!("{operator:?} of surface {i}"));
            }
        }
    }
}

/// The tips of a double cone have very many edges.
#[test]
fn decimation_at_hubs_is_the_same_on_all() {
    let n = 300;
    let rim = (0..n).map(|i| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / f64::from(n)).sin_cos();
        Point::new(cos as f32, sin as f32, 0.1 * (i % 3) as f32)
    });
    let sides = (0..n).map(|i| [i, (i + 1) % n]);
    let faces = sides.flat_map(|[a, b]| [[a, b, n], [b, a, n + 1]]);
    let points = rim.chain([Point::Z, -Point::Z]);
    let cones = PolygonMesh::new(points, faces).expect("two cones");
    for ratio in [0.6, 0.1, 0.0] {
        let operator = Decimation {
            target: Target::Ratio(ratio),
            ..Decimation::default()
        };
        compare_structures(&operator, &cones, &format!("{operator:?}"));
    }
}

#[test]
fn remeshing_is_the_same_on_all() {
    let lengths = [0.2, 0.25, 1.6, 0.9];
    for (polygons, length) in surfaces().iter().zip(lengths) {
        let iterations = 3;
        let operator = Remeshing {
            iterations,
            ..Remeshing::with_edge_length(length)
        };
        compare_structures(&operator, polygons, &format!("{operator:?}"));
    }
}

#[test]
fn delaunay_flips_are_the_same_on_all() {
    for (i, polygons) in surfaces().iter().enumerate() {
        compare_structures(&Delaunay, polygons, &format!("flips of surface {i}"));
    }
}

/// Returns for each edge, in order of its corners, whether it meets the link condition; `None` if
/// the structure cannot hold the mesh.
fn meeting<M: MeshEdit + Representation>(
    polygons: &PolygonMesh,
) -> Option<Vec<([[u32; 3]; 2], bool)>> {
    let mesh = M::from_polygons(polygons).ok()?;
    let bits = |v| {
        (mesh.position(v) + Point::ZERO)
            .to_array()
            .map(f32::to_bits)
    };
    let edges = mesh.edges().map(|e| {
        let mut ends = mesh.edge_vertices(e).map(bits);
        ends.sort_unstable();
        (ends, meets_link_condition(&mesh, e))
    });
    let mut edges: Vec<_> = edges.collect();
    edges.sort_unstable();
    Some(edges)
}

/// The half-edge mesh refuses exactly the collapses that do not meet the link condition, and every
/// structure gives the same answer for an edge.
#[test]
fn the_link_condition_is_what_the_half_edge_mesh_asks_for() {
    let message = "a small shape";
    let mut shapes = vec![
        shapes::tetrahedron(),
        shapes::cube(),
        shapes::octahedron(),
        shapes::grid(1, 1).expect(message),
        shapes::triangle_grid(1, 2).expect(message),
        shapes::triangle_grid(2, 3).expect(message),
        shapes::mixed_grid(3, 3).expect(message),
        shapes::grid_with_hole(4, 4).expect(message),
        shapes::triangle_torus(3, 3).expect(message),
        shapes::triangle_torus(3, 5).expect(message),
        shapes::torus(3, 4).expect(message),
        shapes::prism(3).expect(message),
    ];
    shapes.extend(surfaces());
    let mut refused = [0, 0];
    for (i, polygons) in shapes.iter().enumerate() {
        let whole = EditableHalfEdgeMesh::from_polygons(polygons).expect("a manifold");
        for e in whole.edges() {
            let mut mesh = whole.clone();
            let [a, b] = mesh.edge_vertices(e);
            let middle = mesh.position(a).midpoint(mesh.position(b));
            let meets = meets_link_condition(&whole, e);
            let result = mesh.collapse_edge(e, a, middle);
            let broken = matches!(
                result,
                Err(EditError::CommonNeighbour { .. }
                    | EditError::SameApex { .. }
                    | EditError::AcrossBoundary { .. }
                    | EditError::Pillow { .. })
            );
            assert_eq!(meets, !broken, "shape {i}, {e:?}: {result:?}");
            refused[usize::from(broken)] += 1;
        }
        let expected = meeting::<EditableHalfEdgeMesh>(polygons);
        for_each_editable!(M => {
            let got = meeting::<M>(polygons);
            assert!(got.is_none() || got == expected, "{} and shape {i}", M::NAME);
        });
    }
    assert!(refused.iter().all(|&n| n > 50), "{refused:?}");
}
