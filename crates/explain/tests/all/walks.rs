//! Walks that a reader writes.

use sixfold::{Relation, shapes};
use sixfold_explain::{ElementName, ExplainError, Structure, Walk};

/// A relation, and the walk that answers it in the words of one structure. `V`, `F` and `E` stand for
/// the row of the element.
const WALKS: [(&str, Relation, &str); 14] = [
    (
        "half-edge",
        Relation::VertexVertices,
        "h = leaving(V); repeat { yield target(h); h = next(twin(h)) }",
    ),
    (
        "half-edge",
        Relation::VertexEdges,
        "h = half_edge(V); repeat { yield edge(h); h = twin(prev(h)) }",
    ),
    (
        "half-edge",
        Relation::VertexFaces,
        "h = leaving(V); repeat { if face(h) != none { yield face(h) }; h = next(twin(h)); }",
    ),
    (
        "half-edge",
        Relation::FaceVertices,
        "h = first(F); repeat { yield origin(h); h = next(h) }",
    ),
    (
        "half-edge",
        Relation::FaceEdges,
        "h = first(F); repeat { h = next(h); yield edge(h) }",
    ),
    (
        "half-edge",
        Relation::FaceFaces,
        "h = first(F); repeat { if face(twin(h)) != none { yield face(twin(h)) } h = next(h) }",
    ),
    (
        "winged-edge",
        Relation::VertexVertices,
        "e = spokes(V); repeat { if start(e) = V { yield end(e); e = left_prev(e) } else { yield \
         start(e); e = right_prev(e) } }",
    ),
    (
        "winged-edge",
        Relation::VertexEdges,
        "e = edge(V); repeat { yield e; if start(e) = V { e = left_prev(e) } else { e = \
         right_prev(e) } }",
    ),
    (
        "winged-edge",
        Relation::FaceEdges,
        "e = sides(F); repeat { yield e; if left(e) = F { e = left_next(e) } else { e = \
         right_next(e) } }",
    ),
    (
        "winged-edge",
        Relation::EdgeVertices,
        "yield start(E); yield end(E)",
    ),
    (
        "corner-table",
        Relation::VertexFaces,
        "c = corner(V); repeat { yield triangle(c); c = prev(left(c)) }",
    ),
    (
        "corner-table",
        Relation::VertexVertices,
        "c = corner(V); repeat { yield vertex(next(c)); c = prev(left(c)) }",
    ),
    (
        "corner-table",
        Relation::VertexFaces,
        "c = corner(V); repeat { yield triangle(c); c = swing(c) }",
    ),
    ("face-vertex", Relation::EdgeVertices, "yield v0; yield v2"),
];

fn walk(
    structure: &str,
    walk: &str,
    expected: Option<(Relation, ElementName)>,
) -> Result<Walk, ExplainError> {
    let structure = Structure::find(structure).expect("one of six");
    structure.build(&shapes::octahedron())?.walk(walk, expected)
}

#[test]
fn walks_of_textbooks_answer_the_relations() {
    for (structure, relation, source) in WALKS {
        let elements = match relation.to_string().split('_').next() {
            Some("vertex") => (0..6).map(ElementName::Vertex).collect::<Vec<_>>(),
            Some("face") => (0..8).map(ElementName::Face).collect(),
            _ => vec![ElementName::Edge([0, 2])],
        };
        for name in elements {
            let source = match name {
                ElementName::Vertex(_) => source.replace('V', &name.to_string()),
                ElementName::Face(_) => source.replace('F', &name.to_string()),
                ElementName::Edge(_) => source.replace('E', "e0"),
            };
            let walk = walk(structure, &source, Some((relation, name))).expect(&source);
            assert_eq!(walk.stopped, None, "{structure}: {source}");
            let compared = walk.expected.expect("asked for");
            assert!(compared.is_right(), "{structure}: {source}: {compared:?}");
            assert_eq!(walk.cost.reads > 0, structure != "face-vertex", "{source}");
        }
    }
}

#[test]
fn after_an_edit_a_walk_names_the_elements() {
    let edits = ["bisect_edge v0-v2"].map(|edit| edit.parse().expect("an edit"));
    let mut moved = 0;
    for (structure, relation, source) in WALKS {
        let (letter, names) = match relation.to_string().split('_').next() {
            Some("vertex") => ('V', (0..7).map(ElementName::Vertex).collect::<Vec<_>>()),
            Some("face") => ('F', (0..10).map(ElementName::Face).collect()),
            _ => continue,
        };
        let mesh = Structure::find(structure).expect("one of six");
        let mesh = mesh.build_after(&shapes::octahedron(), &edits);
        let mesh = mesh.expect("the edge exists");
        for name in names {
            let source = source.replace(letter, &name.to_string());
            let walk = mesh.walk(&source, Some((relation, name))).expect(&source);
            let verdict = walk.expected.expect("asked for").verdict;
            assert_eq!(
                verdict,
                format!("Right: the walk yields {relation} of {name}.")
            );
            for [row, element] in walk.moved {
                assert_ne!(row, element);
                moved += 1;
            }
        }
    }
    assert!(moved > 0, "the edit moves a face");
    // A row whose element was removed is not the element.
    let edits = ["remove_vertex v0", "compact"].map(|edit| edit.parse().expect("an edit"));
    let half_edge = Structure::find("half-edge").expect("one of six");
    let mesh = half_edge.build_after(&shapes::octahedron(), &edits);
    let mesh = mesh.expect("the vertex exists");
    let error = mesh.walk("yield leaving(v0)", None).expect_err("removed");
    assert!(error.to_string().contains("no vertex v0"), "{error}");
    let yielded = |source| mesh.walk(source, None).expect("a walk").results;
    let leaving = yielded("h = leaving(v5); yield origin(h)");
    assert_eq!(leaving, ["v5"]);
}

#[test]
fn a_walk_is_counted_like_a_query() {
    let source = "h = leaving(v3); repeat { t = twin(h); yield origin(t); h = next(t) }";
    let walk = walk("half-edge", source, None).expect("a walk");
    // One for the vertex, and one for each of the four neighbours: both fields of a row are one read.
    assert_eq!((walk.cost.reads, walk.results.len()), (5, 4));
    // Both fields are in one row of 12 bytes, and the row of the vertex has 4.
    assert_eq!(walk.cost.bytes, 4 * 12 + 4);
    let searched = "h = prev(h0); yield h";
    let searched = self::walk("half-edge", searched, None).expect("a walk");
    // `prev` is not stored: a walk around the triangle finds it.
    assert!(searched.cost.reads >= 2, "{searched:?}");
    let derived = self::walk("half-edge", "yield twin(h0)", None).expect("a walk");
    assert_eq!(
        (derived.cost.reads, derived.results),
        (0, vec!["h1".to_owned()])
    );
}

#[test]
fn a_wrong_walk_differs_from_the_relation() {
    let vertex = Some((Relation::VertexVertices, ElementName::Vertex(0)));
    let source = "h = leaving(v0); repeat { yield origin(h); h = next(twin(h)) }";
    let compared = walk("half-edge", source, vertex)
        .expect("a walk")
        .expected
        .expect("asked for");
    assert_eq!(compared.missing.len(), 4);
    let (extra, repeated) = (compared.extra.join(" "), compared.repeated.len());
    assert_eq!((extra.as_str(), repeated), ("v0", 0));

    let source = "yield v2; yield v2; yield v2; yield v3; yield v4; yield v5";
    let compared = walk("half-edge", source, vertex).expect("a walk").expected;
    let compared = compared.expect("asked for");
    assert!(!compared.is_right());
    assert_eq!(
        compared.verdict,
        "Not vertex_vertices of v0: the walk repeats v2."
    );
}

#[test]
fn a_step_without_an_answer_ends_the_walk_with_its_element() {
    let square = shapes::triangle_grid(1, 1).expect("a small size");
    let cases = [
        (
            "corner-table",
            "c = corner(v3); repeat { yield triangle(c); c = prev(left(c)) }",
            "line 4: left(c) is none, so there is no prev(left(c))",
        ),
        (
            "half-edge",
            "h = leaving(v0); yield face(h)",
            "line 2: face(h) is none",
        ),
        (
            "half-edge",
            "h = leaving(v0); repeat { h = next(h0) }",
            "line 3: the loop never comes back to h4: it is at h6 for the second time",
        ),
        (
            "half-edge",
            "repeat { f = face(h0) }",
            "line 1: f has no value before the loop",
        ),
    ];
    for (structure, source, message) in cases {
        let known = Structure::find(structure).expect("one of six");
        let built = known.build(&square).expect("a manifold");
        let walk = built.walk(source, None).expect(source);
        let stopped = walk.stopped.unwrap_or_default();
        assert_eq!(stopped, message, "{structure}: {source}");
    }
}

#[test]
fn what_is_no_walk_on_the_structure_is_an_error() {
    let cases = [
        (
            "half-edge",
            "h = nxt(h0)",
            "no field is called `nxt` (did you mean `next`?)",
        ),
        (
            "half-edge",
            "h = opposite(h0)",
            "choose from origin, next, face, twin, prev, edge, target",
        ),
        (
            "half-edge",
            "yield h99",
            "half-edge has no half-edge h99 in this mesh",
        ),
        (
            "half-edge",
            "yield x",
            "x has no value, and half-edge has no row of this name",
        ),
        (
            "corner-table",
            "yield h0",
            "h0 has no value, and corner-table has no row of this name",
        ),
        ("half-edge", "yield position(v0)", "position(v0) is no row"),
    ];
    for (structure, source, message) in cases {
        let error = walk(structure, source, None).expect_err(source).to_string();
        assert!(error.contains(message), "{structure}: {source}: {error}");
    }
}

#[test]
fn a_loop_ends_at_a_boundary() {
    let square = shapes::triangle_grid(1, 1).expect("a small size");
    let corner_table = Structure::find("corner-table").expect("one of six");
    let source = "n = next(corner(v0)); repeat { yield vertex(n); c = n; if opposite(n) = none { n = none } \
                  else { n = prev(opposite(n)) } } if n = none { yield vertex(next(c)) }";
    let expected = Some((Relation::VertexVertices, ElementName::Vertex(0)));
    let corner_table = corner_table.build(&square).expect("a manifold");
    let walk = corner_table.walk(source, expected).expect(source);
    assert_eq!((walk.stopped, walk.results.len()), (None, 3));
    assert!(
        walk.expected
            .is_some_and(|compared| compared.missing.is_empty())
    );
    // A loop that begins at none does nothing.
    let none = corner_table.walk("c = none; repeat { c = next(c) } yield v0", None);
    assert_eq!(none.expect("a walk").results, ["v0"]);
}
