//! Positions as types of the crate `mint`, with the feature of that name.

use sixfold_core::PolygonMesh;

#[test]
fn positions_convert_from_mint_and_back() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
    let points = corners.map(mint::Point3::<f32>::from);
    let vectors = corners.map(mint::Vector3::<f32>::from);
    let from_points = PolygonMesh::new(points, [[0, 1, 2]]).expect("a triangle");
    let from_vectors = PolygonMesh::new(vectors, [[0, 1, 2]]).expect("a triangle");
    assert_eq!(from_points, from_vectors);
    let back = from_points.positions().iter().map(|&p| p.into());
    assert_eq!(back.collect::<Vec<mint::Point3<f32>>>(), points);
}
