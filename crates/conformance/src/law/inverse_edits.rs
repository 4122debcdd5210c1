//! The law that edits undo each other.

use std::fmt::Debug;

use sixfold_core::{Edit, MeshEdit, Point, PolygonMesh, Representation};

use crate::edit::{Action, ModelTest};

/// Position of new vertices, far from all other vertices.
const FAR: Point = Point::new(50.0, 60.0, 70.0);

/// Edits, and a function that executes the first edit at an edge or a face and then undoes it. The
/// function returns whether all edits are accepted. If so, the function checks that the mesh is
/// unchanged.
type Undo<M, At> = (&'static [Edit], fn(&ModelTest<M>, At) -> bool);

/// An edit and then its inverse edit restore the original mesh.
pub fn inverse_edits<M: Representation + MeshEdit + Debug>() {
    let at_edges: [Undo<M, [usize; 2]>; 4] = [
        (&[Edit::SplitEdge], |test, ends| {
            is_undone_by_collapse(test, Action::SplitEdge { e: ends, at: FAR }, ends[0])
        }),
        (&[Edit::BisectEdge], |test, ends| {
            is_undone_by_collapse(test, Action::BisectEdge { e: ends, at: FAR }, ends[0])
        }),
        (&[Edit::FlipEdge], is_flip_undone),
        (&[Edit::SplitVertex], is_collapse_undone),
    ];
    let at_faces: [Undo<M, usize>; 2] = [
        (&[Edit::PokeFace], is_poke_undone),
        (&[Edit::SplitFace, Edit::DissolveEdge], is_face_split_undone),
    ];
    let starts = inverse_starts();
    let tests: Vec<_> = starts
        .iter()
        .filter_map(ModelTest::<M>::from_polygons)
        .collect();
    for (edits, is_undone) in at_edges {
        let undone = tests.iter().map(|test| {
            let edges = test.model.edges();
            edges.keys().filter(|&&ends| is_undone(test, ends)).count()
        });
        check_undo_count::<M>(edits, undone.sum());
    }
    for (edits, is_undone) in at_faces {
        let undone = tests.iter().map(|test| {
            let faces = test.model.faces();
            faces.filter(|&(f, _)| is_undone(test, f)).count()
        });
        check_undo_count::<M>(edits, undone.sum());
    }
}

fn inverse_starts() -> [PolygonMesh; 5] {
    let message = "a shape of this size can be built";
    [
        sixfold_shapes::icosahedron(),
        sixfold_shapes::triangle_torus(5, 4).expect(message),
        sixfold_shapes::triangle_grid(4, 4).expect(message),
        sixfold_shapes::mixed_grid(4, 4).expect(message),
        sixfold_shapes::dodecahedron(),
    ]
}

fn check_undo_count<M: Representation + MeshEdit>(edits: &[Edit], count: usize) {
    let offered = edits.iter().all(|&edit| M::supports(edit));
    assert!(
        !offered || count >= 10,
        "{}: {edits:?} were undone only {count} times",
        M::NAME
    );
}

fn is_undone_by_collapse<M: Representation + MeshEdit + Debug>(
    test: &ModelTest<M>,
    split: Action,
    end: usize,
) -> bool {
    let collapse = Action::CollapseEdge {
        e: [end, new_vertex(test)],
        keep: end,
        to: test.model.position(end).expect("the end exists"),
    };
    is_undone(test, &[split, collapse])
}

fn is_flip_undone<M: Representation + MeshEdit + Debug>(
    test: &ModelTest<M>,
    ends: [usize; 2],
) -> bool {
    let mut flipped = test.clone();
    if !flipped.apply(&Action::FlipEdge { e: ends }) {
        return false;
    }
    let along = test.model.edges().remove(&ends).expect("the edge exists");
    let apexes = along.iter().map(|&(f, _)| {
        let face = test.model.face(f).into_iter().flatten();
        let mut apex = face.copied().filter(|v| !ends.contains(v));
        apex.next().expect("a triangle")
    });
    let apexes: Vec<usize> = apexes.collect();
    flipped.apply(&Action::FlipEdge {
        e: [apexes[0], apexes[1]],
    });
    assert_same(&flipped, test, "flip_edge twice");
    true
}

fn is_collapse_undone<M: Representation + MeshEdit + Debug>(
    test: &ModelTest<M>,
    ends: [usize; 2],
) -> bool {
    let [first, second] = ends.map(|v| test.model.neighbours(v));
    let common: Vec<usize> = (&first & &second).into_iter().collect();
    let [left, right] = common[..] else {
        return false;
    };
    let [keep, removed] = ends.map(|v| test.model.position(v).expect("the end exists"));
    let collapse = Action::CollapseEdge {
        e: ends,
        keep: ends[0],
        to: keep,
    };
    let mut collapsed = test.clone();
    if !collapsed.apply(&collapse) {
        return false;
    }
    let restores = |[left, right]: [usize; 2]| {
        let mut again = collapsed.clone();
        let split = Action::SplitVertex {
            v: ends[0],
            left: Some(left),
            right: Some(right),
            at: removed,
        };
        again.apply(&split) && again.is_same_mesh(test)
    };
    assert!(
        restores([left, right]) || restores([right, left]),
        "{}: split_vertex does not undo {collapse:?}",
        M::NAME
    );
    true
}

fn is_poke_undone<M: Representation + MeshEdit + Debug>(test: &ModelTest<M>, f: usize) -> bool {
    let corners = test.model.face(f).expect("the face exists").to_vec();
    let mut poked = test.clone();
    let v = new_vertex(test);
    if !poked.apply(&Action::PokeFace { f, at: FAR }) || !poked.apply(&Action::RemoveVertex { v }) {
        return false;
    }
    // `remove_vertex` also removes corners without a face, if vertices are identified by
    // coordinates.
    let has_corners = corners.iter().all(|&v| poked.model.position(v).is_some());
    if !has_corners || !poked.apply(&Action::AddFace { corners }) {
        return false;
    }
    assert_same(&poked, test, "poke_face, remove_vertex, add_face");
    true
}

fn is_face_split_undone<M: Representation + MeshEdit + Debug>(
    test: &ModelTest<M>,
    f: usize,
) -> bool {
    let face = test.model.face(f).expect("the face exists");
    if face.len() <= 3 {
        return false;
    }
    let ends = [face[0], face[2]];
    let actions = [
        Action::SplitFace { f, ends },
        Action::DissolveEdge { e: ends },
    ];
    is_undone(test, &actions)
}

/// Returns the vertex that the next edit would add.
fn new_vertex<M: Representation + MeshEdit + Debug>(test: &ModelTest<M>) -> usize {
    test.model.vertices().last().map_or(0, |v| v + 1)
}

/// Executes `actions` and returns whether all are accepted. If so, checks that the mesh is
/// unchanged.
fn is_undone<M: Representation + MeshEdit + Debug>(
    test: &ModelTest<M>,
    actions: &[Action],
) -> bool {
    let mut edited = test.clone();
    if !actions.iter().all(|action| edited.apply(action)) {
        return false;
    }
    assert_same(&edited, test, &format!("{actions:?}"));
    true
}

fn assert_same<M: Representation + MeshEdit + Debug>(
    got: &ModelTest<M>,
    from: &ModelTest<M>,
    did: &str,
) {
    assert!(
        got.is_same_mesh(from),
        "{}: the edits {did} do not restore the mesh",
        M::NAME
    );
}
