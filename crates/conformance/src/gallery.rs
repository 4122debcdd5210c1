//! Small meshes made by hand, one for each corner case.

use sixfold_core::PolygonMesh;

mod lectures;
mod make;

use make::{
    closed_bow_tie, coincident_corners, corner_numbers, disjoint_union, expect_shape, klein_bottle,
    mesh, negative_zero, separate_faces, touching_holes, voxels, with_positions,
};
pub(crate) use make::{distinct_position, double_cone, strip};

/// A mesh of the gallery, with its name.
#[derive(Clone, Debug)]
pub struct GalleryMesh {
    /// A name that describes the mesh.
    pub name: &'static str,
    /// The mesh.
    pub polygons: PolygonMesh,
}

/// Returns all meshes: solids, surfaces of every kind, corner cases of the queries, faulty meshes,
/// and example meshes from lectures on mesh data structures.
pub fn gallery() -> Vec<GalleryMesh> {
    let parts = [
        solids(),
        surfaces(),
        corner_cases(),
        faulty(),
        lectures::fixtures(),
    ];
    let all = parts.into_iter().flatten();
    all.map(|(name, polygons)| GalleryMesh { name, polygons })
        .collect()
}

type Named = (&'static str, PolygonMesh);

fn solids() -> Vec<Named> {
    vec![
        ("tetrahedron", sixfold_shapes::tetrahedron()),
        ("cube", sixfold_shapes::cube()),
        ("octahedron", sixfold_shapes::octahedron()),
        ("dodecahedron", sixfold_shapes::dodecahedron()),
        ("icosahedron", sixfold_shapes::icosahedron()),
        ("pentagonal prism", expect_shape(sixfold_shapes::prism(5))),
        (
            "square antiprism",
            expect_shape(sixfold_shapes::antiprism(4)),
        ),
        (
            "shuffled icosahedron",
            sixfold_shapes::shuffled(&sixfold_shapes::icosahedron(), 7),
        ),
    ]
}

fn surfaces() -> Vec<Named> {
    vec![
        ("grid of quads", expect_shape(sixfold_shapes::grid(3, 4))),
        (
            "grid of triangles",
            expect_shape(sixfold_shapes::triangle_grid(4, 3)),
        ),
        (
            "grid of triangles and quads",
            expect_shape(sixfold_shapes::mixed_grid(4, 4)),
        ),
        (
            "grid with a hole",
            expect_shape(sixfold_shapes::grid_with_hole(4, 5)),
        ),
        ("torus of quads", expect_shape(sixfold_shapes::torus(3, 4))),
        (
            "torus of triangles",
            expect_shape(sixfold_shapes::triangle_torus(4, 3)),
        ),
        ("genus 2", voxels(&[".....", ".o.o.", "....."])),
        ("Möbius strip", expect_shape(sixfold_shapes::moebius(5))),
        ("Klein bottle", klein_bottle(4, 5)),
        ("projective plane", mesh(6, &PROJECTIVE_PLANE)),
        (
            "two cubes and a grid",
            disjoint_union(&[
                sixfold_shapes::cube(),
                expect_shape(sixfold_shapes::grid(2, 2)),
                sixfold_shapes::cube(),
            ]),
        ),
        ("double cone", double_cone(8)),
        ("double cone of valence 200", double_cone(200)),
    ]
}

/// Returns the corner cases of the contract; all are oriented manifolds.
fn corner_cases() -> Vec<Named> {
    let hundred: Vec<u32> = (0..100).collect();
    vec![
        ("empty", PolygonMesh::default()),
        ("points only", mesh::<[u32; 3]>(4, &[])),
        ("single triangle", mesh(3, &[[0, 1, 2]])),
        ("single polygon of 100 corners", mesh(100, &[hundred])),
        ("pillow of two triangles", mesh(3, &[[0, 1, 2], [0, 2, 1]])),
        (
            "pillow of two quads",
            mesh(4, &[[0, 1, 2, 3], [3, 2, 1, 0]]),
        ),
        // v1 has valence 2: the quads share the edges v0–v1 and v1–v2.
        (
            "two quads sharing two edges",
            mesh(5, &[[0, 1, 2, 3], [2, 1, 0, 4]]),
        ),
        (
            "digon neighbours in a closed mesh",
            mesh(
                5,
                &[&[0, 1, 2, 3][..], &[2, 1, 0, 4], &[0, 3, 4], &[2, 4, 3]],
            ),
        ),
        (
            "isolated vertices first, between and last",
            mesh(7, &[[1, 2, 4], [4, 2, 5]]),
        ),
        (
            "mixed degrees, the first a triangle",
            mesh(7, &[&[0, 1, 2][..], &[2, 1, 3, 4], &[4, 3, 5, 6, 2]]),
        ),
        (
            "first mixed by the last face",
            mesh(7, &[&[0, 1, 2][..], &[2, 1, 3], &[2, 3, 4, 5, 6]]),
        ),
        (
            "open fan of three triangles",
            mesh(5, &[[0, 1, 2], [0, 2, 3], [0, 3, 4]]),
        ),
        (
            "cube of loose faces",
            separate_faces(&sixfold_shapes::cube()),
        ),
        ("negative zero equals zero", negative_zero()),
        (
            "one face with two corners at one point",
            coincident_corners(),
        ),
        (
            "two triangles with equal positions",
            with_positions(&mesh(6, &[[0, 1, 2], [3, 4, 5]]), &[0, 1, 2, 0, 1, 2]),
        ),
    ]
}

fn faulty() -> Vec<Named> {
    let mut with_reversed_face = sixfold_shapes::cube()
        .faces()
        .iter()
        .map(|(_, f)| corner_numbers(f))
        .collect::<Vec<_>>();
    with_reversed_face[3].reverse();
    vec![
        ("open bow-tie", mesh(5, &[[0, 1, 2], [0, 3, 4]])),
        ("closed bow-tie", closed_bow_tie()),
        (
            "three faces on an edge",
            mesh(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]),
        ),
        (
            "four faces on an edge, in two pairs",
            mesh(6, &[[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]]),
        ),
        (
            "two tetrahedra sharing an edge",
            mesh(6, &TETRAHEDRA_ON_AN_EDGE),
        ),
        (
            "duplicate face",
            mesh(4, &[[0, 1, 2], [0, 1, 2], [2, 1, 3]]),
        ),
        (
            "one face, three times",
            mesh(3, &[[0, 1, 2], [1, 2, 0], [2, 1, 0]]),
        ),
        ("cube with a face turned over", mesh(8, &with_reversed_face)),
        (
            "two triangles with the same side",
            mesh(4, &[[0, 1, 2], [0, 1, 3]]),
        ),
        (
            "bow-tie of a fan and an umbrella",
            mesh(6, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [0, 4, 5]]),
        ),
        (
            "three fans at a vertex",
            mesh(7, &[[3, 0, 1], [3, 2, 4], [5, 6, 3]]),
        ),
        ("two holes that touch at a vertex", touching_holes()),
        (
            "faults and isolated vertices",
            mesh(8, &[[1, 2, 4], [1, 2, 5], [4, 6, 5]]),
        ),
    ]
}

/// The projective plane with six vertices; all pairs of vertices are adjacent.
const PROJECTIVE_PLANE: [[u32; 3]; 10] = [
    [0, 1, 2],
    [0, 2, 3],
    [0, 3, 4],
    [0, 4, 5],
    [0, 5, 1],
    [1, 2, 4],
    [2, 3, 5],
    [3, 4, 1],
    [4, 5, 2],
    [5, 1, 3],
];

/// Vertices 0 and 1, and the edge between them, belong to both tetrahedra.
const TETRAHEDRA_ON_AN_EDGE: [[u32; 3]; 8] = [
    [0, 2, 1],
    [0, 1, 3],
    [1, 2, 3],
    [2, 0, 3],
    [0, 4, 1],
    [0, 1, 5],
    [1, 4, 5],
    [4, 0, 5],
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use sixfold_core::{Capabilities, Facts};

    use super::*;

    #[test]
    fn names_are_distinct() {
        let names: BTreeSet<&str> = gallery().iter().map(|entry| entry.name).collect();
        assert_eq!(names.len(), gallery().len());
    }

    #[test]
    fn meshes_have_the_properties_of_their_names() {
        for GalleryMesh { name, polygons } in gallery() {
            let facts = Facts::from_polygons(&polygons);
            let (genus, orientable) = (facts.genus, facts.orientable);
            match name {
                "genus 2" => assert_eq!((genus, facts.closed), (Some(2), true)),
                "Möbius strip" => {
                    assert_eq!((orientable, facts.boundary_loops), (Some(false), Some(1)))
                }
                "Klein bottle" => {
                    assert_eq!((orientable, facts.closed), (Some(false), true));
                    assert_eq!(facts.euler_characteristic, 0);
                }
                "projective plane" => {
                    assert_eq!((orientable, facts.closed), (Some(false), true));
                    assert_eq!(facts.euler_characteristic, 1);
                }
                "closed bow-tie" => {
                    assert_eq!((facts.closed, facts.non_manifold_vertices), (true, 1))
                }
                "double cone of valence 200" => assert_eq!(facts.valence.map(|v| v.max), Some(200)),
                "two cubes and a grid" => assert_eq!(facts.components, 3),
                "lecture: half-edge cube" | "lecture: face-vertex box, corrected" => {
                    assert_eq!((genus, facts.closed), (Some(0), true), "{name}");
                }
                _ => {}
            }
        }
    }

    #[test]
    fn exactly_faulty_and_non_orientable_meshes_are_refused() {
        let refused =
            |polygons: &PolygonMesh| Capabilities::ORIENTED_MANIFOLDS.check(polygons).is_err();
        for (name, polygons) in [solids(), surfaces(), corner_cases()].concat() {
            let one_sided = ["Möbius strip", "Klein bottle", "projective plane"].contains(&name);
            assert_eq!(refused(&polygons), one_sided, "{name}");
        }
        for (name, polygons) in faulty() {
            assert!(refused(&polygons), "{name}");
        }
        for (name, polygons) in lectures::fixtures() {
            let faulty = name.contains("reversed") || name.contains("misplaced");
            assert_eq!(refused(&polygons), faulty, "{name}");
        }
    }
}
