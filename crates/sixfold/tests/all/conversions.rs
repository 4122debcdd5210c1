//! Tests `From` and `TryFrom` on all structures and their editable forms.

use sixfold::{
    BuildError, MeshQuery, PolygonMesh, Representation, for_each_editable, for_each_representation,
    shapes,
};

fn converts<M>()
where
    M: Representation + Default + for<'a> TryFrom<&'a PolygonMesh, Error = BuildError>,
    M: TryFrom<PolygonMesh, Error = BuildError>,
{
    let polygons = shapes::octahedron();
    let mesh = M::from_polygons(&polygons).expect("every structure holds an octahedron");
    let expected = mesh.to_polygons();
    assert_eq!(PolygonMesh::from(&mesh), expected, "{}", M::NAME);
    let by_reference = M::try_from(&polygons).expect("as before");
    assert_eq!(by_reference.to_polygons(), expected, "{}", M::NAME);
    let by_value = M::try_from(polygons).expect("as before");
    assert_eq!(by_value.to_polygons(), expected, "{}", M::NAME);

    let empty = M::default();
    let counts = [empty.vertex_count(), empty.edge_count(), empty.face_count()];
    assert_eq!(counts, [0; 3], "{}", M::NAME);
    assert_eq!(empty.validate(), Ok(()), "{}", M::NAME);
}

#[test]
fn every_structure_converts() {
    for_each_representation!(M => { converts::<M>(); });
    for_each_editable!(M => { converts::<M>(); });
}

#[test]
fn a_refused_mesh_returns_the_error_of_the_structure() {
    for_each_representation!(M => {
        let spine = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
        let book = PolygonMesh::new(corners, spine).expect("a valid mesh");
        assert_eq!(M::try_from(&book).err(), M::CAPABILITIES.check(&book).err());
    });
}

/// Compiler messages omit type parameters that have their default values.
#[test]
fn the_names_of_mesh_types_show_no_parameters() {
    for_each_representation!(M => {
        let (package, alias) = M::type_path().split_once("::").expect("a path");
        assert_eq!(std::any::type_name::<M>(), format!("{package}::mesh::{alias}"));
    });
}
