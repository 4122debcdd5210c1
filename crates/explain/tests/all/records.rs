//! The records of all structures.

use std::collections::{HashMap, HashSet};

use sixfold::{HalfEdgeMesh, PolygonMesh, shapes};
use sixfold_conformance::gallery;
use sixfold_explain::{ExplainError, Records, Structure};

/// A cube as half-edges, as a lecture shows it: the origin, the next, the previous and the opposite
/// half-edge of each half-edge.
const CUBE: [[usize; 4]; 24] = [
    [0, 1, 3, 6],
    [1, 2, 0, 11],
    [2, 3, 1, 15],
    [3, 0, 2, 18],
    [4, 5, 7, 20],
    [5, 6, 4, 8],
    [1, 7, 5, 0],
    [0, 4, 6, 17],
    [1, 9, 11, 5],
    [5, 10, 8, 23],
    [6, 11, 9, 12],
    [2, 8, 10, 1],
    [2, 13, 15, 10],
    [6, 14, 12, 22],
    [7, 15, 13, 19],
    [3, 12, 14, 2],
    [7, 17, 19, 21],
    [4, 18, 16, 7],
    [0, 19, 17, 3],
    [3, 16, 18, 14],
    [5, 21, 23, 4],
    [4, 22, 20, 16],
    [7, 23, 21, 13],
    [6, 20, 22, 9],
];
fn lecture_cube() -> PolygonMesh {
    let all = gallery().into_iter();
    let mut named = all.filter(|mesh| mesh.name == "lecture: half-edge cube");
    named.next().expect("a mesh of the gallery").polygons
}

fn of<'r>(records: &'r [Records], element: &str) -> &'r Records {
    let mut all = records.iter();
    all.find(|records| records.element == element)
        .expect("the structure has these elements")
}

/// Returns the fields of a column, in the order of the rows.
fn column<'r>(records: &'r Records, name: &str) -> Vec<&'r str> {
    let mut columns = records.columns.iter();
    let place = columns.position(|column| column.name == name);
    let place = place.expect("a column of this name");
    records
        .rows
        .iter()
        .map(|row| row.fields[place].as_str())
        .collect()
}

#[test]
fn a_half_edge_cube_is_the_one_of_the_lecture_up_to_numbering() {
    let half_edge = Structure::find("half-edge").expect("one of six");
    let built = half_edge.build(&lecture_cube()).expect("a cube");
    let records = built.records(0..100);
    let halves = of(&records, "half-edge");
    let [origin, next, prev, twin, face] =
        ["origin", "next", "prev", "twin", "face"].map(|name| column(halves, name));
    let index: HashMap<&str, usize> = (halves.rows.iter().enumerate())
        .map(|(i, row)| (row.name.as_str(), i))
        .collect();
    // The half-edge of the lecture with the same ends.
    let ends = |h: usize| [CUBE[h][0], CUBE[CUBE[h][1]][0]];
    let of_lecture = |i: usize| {
        let end = |i: usize| origin[i][1..].parse::<usize>().expect("a vertex");
        let own = [end(i), end(index[next[i]])];
        (0..24)
            .find(|&h| ends(h) == own)
            .expect("an edge of the cube")
    };
    for i in 0..24 {
        let [own_origin, own_next, own_prev, own_opposite] = CUBE[of_lecture(i)];
        assert_eq!(origin[i], format!("v{own_origin}"));
        assert_eq!(of_lecture(index[next[i]]), own_next);
        assert_eq!(of_lecture(index[prev[i]]), own_prev);
        assert_eq!(of_lecture(index[twin[i]]), own_opposite);
    }
    // Each half-edge of the lecture occurs once.
    let mut seen: Vec<usize> = (0..24).map(of_lecture).collect();
    seen.sort_unstable();
    assert!(seen.into_iter().eq(0..24));
    let faces = column(of(&records, "face"), "half-edge");
    for (f, first) in faces.into_iter().enumerate() {
        assert_eq!(face[index[first]], format!("f{f}"));
    }
    let vertices = column(of(&records, "vertex"), "half-edge");
    for (v, leaving) in vertices.into_iter().enumerate() {
        assert_eq!(origin[index[leaving]], format!("v{v}"));
    }
}

#[test]
fn each_field_has_a_column_and_each_named_row_exists() {
    for mesh in gallery() {
        let mesh = mesh.polygons;
        for structure in Structure::all() {
            let Ok(built) = structure.build(&mesh) else {
                // An indexed face set holds every mesh.
                assert_ne!(structure.name(), "indexed-face-set");
                continue;
            };
            let records = built.records(0..usize::MAX);
            let name = structure.name();
            // An edge of the half-edge mesh is two of its rows.
            let faces = (0..mesh.face_count()).map(|f| format!("f{f}"));
            let mut names: HashSet<String> = faces.collect();
            if name == "half-edge" {
                names.extend((0..of(&records, "half-edge").total / 2).map(|e| format!("e{e}")));
            }
            for records in &records {
                assert_eq!(records.rows.len(), records.total, "{name}: all rows");
                names.extend(records.rows.iter().map(|row| row.name.clone()));
            }
            for records in &records {
                for row in &records.rows {
                    assert_eq!(row.fields.len(), records.columns.len(), "{name}: {row:?}");
                    for field in &row.fields {
                        let is_row =
                            field.starts_with(|c: char| c.is_ascii_lowercase()) && field != "none";
                        assert!(!is_row || names.contains(field), "{name}: {row:?}");
                    }
                }
            }
            let corners = mesh.faces().corners().len();
            let totals: Vec<(&str, usize)> = records.iter().map(|r| (r.element, r.total)).collect();
            if let Some((_, total)) = totals.iter().find(|(element, _)| *element == "corner") {
                assert_eq!(*total, corners, "{name}");
            }
            if let Some((_, total)) = totals.iter().find(|(element, _)| *element == "vertex") {
                assert_eq!(*total, mesh.vertex_count(), "{name}");
            }
        }
    }
}

#[test]
fn requested_rows_are_cut_at_the_end_of_the_table() {
    let structure = Structure::new::<HalfEdgeMesh>();
    assert_eq!(structure.name(), "half-edge");
    let names = |rows| {
        let built = structure.build(&shapes::cube()).expect("a cube");
        let records = built.records(rows);
        let faces = of(&records, "face");
        assert_eq!(faces.total, 6);
        faces
            .rows
            .iter()
            .map(|row| row.name.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(names(4..usize::MAX), ["f4", "f5"]);
    assert_eq!(names(0..1), ["f0"]);
    assert_eq!(names(6..9), [""; 0]);
    assert_eq!(names(usize::MAX..usize::MAX), [""; 0]);
}

#[test]
fn a_structure_that_cannot_hold_the_mesh_says_why() {
    let corner_table = Structure::find("corner-table").expect("one of six");
    let error = corner_table.build(&shapes::cube()).err().expect("quads");
    assert!(matches!(error, ExplainError::Refused { .. }));
    let message = error.to_string();
    assert!(
        message.starts_with("corner-table cannot hold the mesh: face f0 has 4 corners"),
        "{message}"
    );
    assert!(Structure::find("quad-edge").is_none());
}
