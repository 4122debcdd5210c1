//! Indices of meshes: handles of a structure, faults of positions, threads.

use glam::DVec3;
use sixfold_core::{Point, PolygonMesh, Representation, VertexId};
use sixfold_half_edge::HalfEdgeMesh;
use sixfold_polygon_soup::PolygonSoup;
use sixfold_spatial::{
    Bvh, KdTree, Octree, PointQueries, SearchHint, SpatialError, SpatialIndex, SurfaceQueries,
    face_triangles, polygon_points, polygon_triangles, vertex_points,
};

/// Every corner of every gallery mesh is found at distance 0, by the handles of the structure.
fn corners_are_found<M: Representation>() {
    for mesh in sixfold_conformance::gallery() {
        let Ok(mesh) = M::from_polygons(&mesh.polygons) else {
            continue; // the structure cannot hold it
        };
        let vertices = KdTree::build(vertex_points(&mesh).expect("finite")).expect("finite");
        let surface = Bvh::build(face_triangles(&mesh).expect("finite")).expect("finite");
        let mut hint = SearchHint::default();
        for face in mesh.faces() {
            for v in mesh.face_vertices(face) {
                let at = mesh.position(v);
                let nearest = vertices.nearest(at).expect("it has vertices");
                assert!(nearest.vertex <= v && mesh.position(nearest.vertex) == at);
                let closest = surface
                    .closest_point_from(at, &mut hint)
                    .expect("it has faces");
                assert!(closest.face <= face && closest.distance() == 0.0);
            }
        }
    }
}

#[test]
fn corners_are_found_by_the_handles_of_each_structure() {
    corners_are_found::<HalfEdgeMesh>();
    corners_are_found::<PolygonSoup>();
}

#[test]
fn a_thin_wall_does_not_swap_sides() {
    // Two parallel squares with opposite orientation, 0.1 apart.
    let corner = |x: f32, y: f32, z: f32| Point::new(x, y, z);
    let square = |z| {
        [
            corner(0.0, 0.0, z),
            corner(1.0, 0.0, z),
            corner(1.0, 1.0, z),
            corner(0.0, 1.0, z),
        ]
    };
    let corners = square(0.0).into_iter().chain(square(0.1));
    let wall = PolygonMesh::new(corners, [[3_u32, 2, 1, 0], [4, 5, 6, 7]]).expect("valid");
    let surface = Bvh::build(polygon_triangles(&wall).expect("finite")).expect("finite");
    // Just below the lower square, from a vertex that belongs to the upper one.
    let query = DVec3::new(0.4, 0.3, -0.01);
    assert_eq!(surface.closest_point(query).expect("faces").point.z, 0.0);
    let mut hint = SearchHint::default();
    let up = surface.closest_point_facing(query, DVec3::Z * 7.0, 0.5, &mut hint);
    assert_eq!(up.expect("the upper square").point.z, f64::from(0.1_f32));
    assert_eq!(
        surface.closest_point_facing(query, DVec3::X, 0.5, &mut hint),
        None
    );
    // The hint of the failed search is still that of the upper square, and changes no answer.
    assert_eq!(
        surface
            .closest_point_from(query, &mut hint)
            .expect("faces")
            .point
            .z,
        0.0
    );
}

#[test]
fn a_position_that_is_not_finite_is_named() {
    let mut positions = sixfold_shapes::cube().positions().to_vec();
    positions[5].y = f32::NAN;
    let faces = sixfold_shapes::cube().faces().clone();
    let cube = PolygonMesh::from_faces(positions, faces).expect("valid");
    for error in [
        polygon_points(&cube).unwrap_err(),
        polygon_triangles(&cube).unwrap_err(),
    ] {
        let SpatialError::PositionNotFinite { vertex, position } = error else {
            panic!("{error}")
        };
        assert_eq!(vertex, VertexId::new(5));
        assert!(position[1].is_nan());
    }
    let mesh = HalfEdgeMesh::from_polygons(&cube).expect("connectivity only");
    assert!(matches!(
        vertex_points(&mesh),
        Err(SpatialError::PositionNotFinite { .. })
    ));
    assert!(matches!(
        face_triangles(&mesh),
        Err(SpatialError::PositionNotFinite { .. })
    ));
}

#[test]
fn trees_do_not_depend_on_the_number_of_threads() {
    fn items<T: SpatialIndex<I> + std::fmt::Debug, I: sixfold_spatial::Item>(
        threads: usize,
        items: &[I],
    ) -> String {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let index = pool.expect("threads").install(|| T::build(items.to_vec()));
        format!("{:?}", index.expect("finite"))
    }
    let ball = sixfold_shapes::geodesic(40).expect("a small frequency"); // 32,000 faces
    let triangles = polygon_triangles(&ball).expect("finite");
    assert!(items::<Bvh<_>, _>(1, &triangles) == items::<Bvh<_>, _>(3, &triangles));
    assert!(items::<KdTree<_>, _>(1, &triangles) == items::<KdTree<_>, _>(3, &triangles));
    assert!(items::<Octree<_>, _>(1, &triangles) == items::<Octree<_>, _>(3, &triangles));
}
