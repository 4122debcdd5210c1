//! Laws about edits, which are compared with the model of [`edit`](crate::edit).

use std::cell::{Cell, RefCell};
use std::fmt::Debug;

use sixfold_core::{
    Edit, Measured, MeshEdit, Point, PolygonMesh, QueryCost, Representation, Traced,
};

use super::scripts::on_random_scripts;
use crate::edit::{Action, ModelTest, Step};

/// At least one in this number of steps of each edit must be accepted, because scripts of refused
/// steps do not test much.
const MAX_STEPS_PER_ACCEPTED: usize = 12;

/// Random scripts: after every step, mesh and model are equal, handles and records agree, and the
/// invariants hold. A refused edit changes nothing. After every 16 steps, all relations are
/// checked.
///
/// `PROPTEST_CASES` sets the number of scripts.
pub fn edits<M: Representation + MeshEdit + Debug>() {
    let counts_by_edit = Cell::new([[0_usize; 2]; Edit::ALL.len()]);
    on_random_scripts::<M>("differs from the model", |start, steps, executed| {
        run_script::<M>(start, steps, &counts_by_edit, executed);
    });
    check_acceptance::<M>(&counts_by_edit.get());
}

fn run_script<M: Representation + MeshEdit + Debug>(
    start: &PolygonMesh,
    steps: &[Step],
    counts_by_edit: &Cell<[[usize; 2]; Edit::ALL.len()]>,
    executed: &RefCell<Vec<(Action, bool)>>,
) {
    let Some(mut test) = ModelTest::<M>::from_polygons(start) else {
        return;
    };
    let mut counts = counts_by_edit.get();
    for (number, step) in steps.iter().enumerate() {
        let Some(action) = step.action(&test.model, number) else {
            continue;
        };
        executed.borrow_mut().push((action.clone(), false));
        let accepted = test.apply(&action);
        if let Some(last) = executed.borrow_mut().last_mut() {
            last.1 = accepted;
        }
        counts[action.edit() as usize][usize::from(!accepted)] += 1;
        if number % 16 == 15 {
            test.check_all();
        }
    }
    test.check_all();
    test.apply(&Action::Compact);
    test.check_all();
    counts_by_edit.set(counts);
}

/// Minimum number of steps on meshes that the structure can hold. There are about 1,800 to 3,400
/// steps on a polygon soup, and more on the other structures.
const MIN_STEPS: usize = 1000;

fn check_acceptance<M: MeshEdit + Representation>(counts_by_edit: &[[usize; 2]; Edit::ALL.len()]) {
    let tried: usize = counts_by_edit.iter().flatten().sum();
    let default_cases = std::env::var_os("PROPTEST_CASES").is_none();
    assert!(
        tried > MIN_STEPS || !default_cases,
        "{}: only {tried} steps on meshes that it can hold",
        M::NAME
    );
    for (edit, [accepted, refused]) in Edit::ALL.into_iter().zip(counts_by_edit) {
        let share = 100.0 * *accepted as f64 / (accepted + refused).max(1) as f64;
        println!(
            "{}: {edit} accepted {accepted} of {} ({share:.0} %)",
            M::NAME,
            accepted + refused
        );
        // A small number of scripts may not contain every edit.
        if M::supports(edit) && tried > 2000 {
            assert!(
                accepted * MAX_STEPS_PER_ACCEPTED >= accepted + refused && *accepted > 0,
                "{}: {edit} is accepted only {accepted} times, and refused {refused} times",
                M::NAME
            );
        }
        if !M::supports(edit) {
            assert_eq!(
                *accepted,
                0,
                "{} does not support {edit}, but accepts it",
                M::NAME
            );
        }
    }
}

/// Edits that undo each other give the same mesh again.
pub fn inverse_edits<M: Representation + MeshEdit + Debug>() {
    let message = "a shape of this size can be built";
    let starts = [
        sixfold_shapes::icosahedron(),
        sixfold_shapes::triangle_torus(5, 4).expect(message),
        sixfold_shapes::triangle_grid(4, 4).expect(message),
        sixfold_shapes::mixed_grid(4, 4).expect(message),
        sixfold_shapes::dodecahedron(),
    ];
    let mut undo_counts = [0_usize; 6];
    for start in starts {
        let Some(test) = ModelTest::<M>::from_polygons(&start) else {
            continue;
        };
        let at = Point::new(50.0, 60.0, 70.0);
        for (ends, _) in test.model.edges() {
            let new_vertex = test.model.vertices().last().map_or(0, |v| v + 1);
            let keep = test.model.position(ends[0]).expect("the end exists");
            let inverse = Action::CollapseEdge {
                ends: [ends[0], new_vertex],
                to: keep,
            };
            for (i, edit) in [
                Action::SplitEdge { ends, at },
                Action::BisectEdge { ends, at },
            ]
            .into_iter()
            .enumerate()
            {
                undo_counts[i] += usize::from(is_undone(&test, &[edit, inverse.clone()]));
            }
            let mut flipped = test.clone();
            if flipped.apply(&Action::FlipEdge { ends }) {
                let along = test.model.edges().remove(&ends).expect("the edge exists");
                let apexes = along.iter().map(|&(f, _)| {
                    let face = test.model.face(f).into_iter().flatten();
                    let mut apex = face.copied().filter(|v| !ends.contains(v));
                    apex.next().expect("a triangle")
                });
                let apexes: Vec<usize> = apexes.collect();
                flipped.apply(&Action::FlipEdge {
                    ends: [apexes[0], apexes[1]],
                });
                assert_same(&flipped, &test, "flip_edge twice");
                undo_counts[2] += 1;
            }
            // `split_vertex` needs the vertices that are adjacent to both ends.
            let [first, second] = ends.map(|v| test.model.neighbours(v));
            let common: Vec<usize> = (&first & &second).into_iter().collect();
            if let [left, right] = common[..] {
                let collapse = Action::CollapseEdge { ends, to: keep };
                let removed = test.model.position(ends[1]).expect("the end exists");
                let split = |left, right| Action::SplitVertex {
                    v: ends[0],
                    left: Some(left),
                    right: Some(right),
                    at: removed,
                };
                let mut collapsed = test.clone();
                if collapsed.apply(&collapse) {
                    let splits = [split(left, right), split(right, left)];
                    let same = splits.iter().any(|split| {
                        let mut again = collapsed.clone();
                        again.apply(split) && again.is_same_mesh(&test)
                    });
                    assert!(same, "{}: split_vertex does not undo {collapse:?}", M::NAME);
                    undo_counts[3] += 1;
                }
            }
        }
        for (f, face) in test.model.faces() {
            let new_vertex = test.model.vertices().last().map_or(0, |v| v + 1);
            let mut poked = test.clone();
            if poked.apply(&Action::PokeFace { f, at })
                && poked.apply(&Action::RemoveVertex { v: new_vertex })
                // If a vertex is identified by its coordinates, corners without another face are
                // removed.
                && face.iter().all(|&v| poked.model.position(v).is_some())
                && poked.apply(&Action::AddFace {
                    corners: face.to_vec(),
                })
            {
                assert_same(&poked, &test, "poke_face, remove_vertex, add_face");
                undo_counts[4] += 1;
            }
            if face.len() > 3 {
                let ends = [face[0], face[2]];
                let actions = [Action::SplitFace { f, ends }, Action::DissolveEdge { ends }];
                undo_counts[5] += usize::from(is_undone(&test, &actions));
            }
        }
    }
    let edits_by_test = [
        &[Edit::SplitEdge][..],
        &[Edit::BisectEdge],
        &[Edit::FlipEdge],
        &[Edit::SplitVertex],
        &[Edit::PokeFace],
        &[Edit::SplitFace, Edit::DissolveEdge],
    ];
    for (count, edits) in undo_counts.into_iter().zip(edits_by_test) {
        let offered = edits.iter().all(|&edit| M::supports(edit));
        assert!(
            !offered || count >= 10,
            "{}: {edits:?} undone only {count} times",
            M::NAME
        );
    }
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
        "{}: {did} do not restore the mesh",
        M::NAME
    );
}

/// `EDITS` are correct, measured in rows read and written.
///
/// - Constant and Local: the number of accesses does not depend on the size of the mesh.
/// - Scan: the number of accesses grows with the mesh. Declaring a scan for a cheaper edit is
///   wrong.
///
/// The meshes are two tori of valence six, one sixteen times the size of the other. The cost of
/// growing a table is not counted, only accesses to rows.
pub fn edit_costs<M>()
where
    M: Measured + MeshEdit,
    M::Probed<Traced>: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
{
    let sizes = [6, 24].map(|side| sixfold_shapes::triangle_torus(side, side).expect("a torus"));
    for (i, edit) in Edit::ALL.into_iter().enumerate() {
        let Some(cost) = M::EDITS[i] else { continue };
        // Compaction changes the whole mesh, and its accesses are not recorded.
        if matches!(edit, Edit::Compact) {
            continue;
        }
        let [few, many] = [0, 1].map(|size| accesses::<M>(&sizes[size], edit));
        let name = M::NAME;
        println!("{name}: {edit} touches {few} rows on 72 faces and {many} on 1152");
        let fits = match cost {
            QueryCost::Scan => many > 4 * few,
            _ => 2 * many <= 3 * few + 16,
        };
        assert!(
            fits,
            "{name}: {edit} is declared {cost:?}; it touches {few} rows on 72 faces and {many} on 1152"
        );
    }
}

/// Returns the maximum number of rows that `edit` accesses, over a few faces of the mesh.
fn accesses<M>(polygons: &PolygonMesh, edit: Edit) -> usize
where
    M: Measured + MeshEdit,
    M::Probed<Traced>: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
{
    let mut mesh =
        M::from_polygons(polygons).expect("every structure holds closed triangle meshes");
    // The first hole allocates one bit for every row. Make a hole now, so that this is not counted.
    let last = mesh.faces().last().expect("a face");
    let n = mesh
        .poke_face(last, Point::splat(500.0))
        .expect("poke_face is always legal");
    let spoke = mesh
        .vertex_edges(n)
        .next()
        .expect("the vertex has three edges");
    let [a, b] = mesh.edge_vertices(spoke);
    let keep = if a == n { b } else { a };
    let at = mesh.position(keep);
    let collapsed = mesh.collapse_edge(spoke, keep, at);
    collapsed.expect("an inner vertex of valence three can be collapsed");
    let at = Point::new(300.0, 301.0, 302.0);
    let mut max = 0;
    for quarter in [0, 1, 2, 3] {
        let mut mesh = mesh.clone();
        let count = mesh.face_count();
        let f = mesh
            .faces()
            .nth((quarter * count / 4).max(2))
            .expect("a face");
        let [a, b, c] = triangle_corners(mesh.face_vertices(f));
        let e = mesh.edge_between(a, b).expect("a side");
        let quad = (edit == Edit::SplitFace).then(|| mesh.dissolve_edge(e).expect("two triangles"));
        if edit == Edit::AddFace {
            mesh.remove_face(f).expect("an inner face");
        }
        let neighbours: Vec<M::Vertex> = mesh.vertex_vertices(a).collect();
        let ends = quad.map(|quad| {
            let corners: Vec<M::Vertex> = mesh.face_vertices(quad).collect();
            [corners[0], corners[2]]
        });
        let probe = Traced::default();
        let mut probed = mesh.probed(probe.clone());
        probe.take();
        let refusal = match edit {
            Edit::SetPosition => probed.set_position(a, at).err(),
            Edit::AddVertex => probed.add_vertex(at).err(),
            Edit::AddFace => probed.add_face(&[a, b, c]).err(),
            Edit::RemoveFace => probed.remove_face(f).err(),
            Edit::RemoveVertex => probed.remove_vertex(a).err(),
            Edit::RemoveIsolatedVertices => {
                probed.remove_isolated_vertices();
                None
            }
            Edit::SplitEdge => probed.split_edge(e, at).err(),
            Edit::BisectEdge => probed.bisect_edge(e, at).err(),
            Edit::PokeFace => probed.poke_face(f, at).err(),
            Edit::SplitFace => {
                let quad = quad.expect("made above");
                probed.split_face(quad, ends.expect("a quad")).err()
            }
            Edit::DissolveEdge => probed.dissolve_edge(e).err(),
            Edit::FlipEdge => probed.flip_edge(e).err(),
            Edit::CollapseEdge => probed.collapse_edge(e, a, at).err(),
            Edit::SplitVertex => {
                let other = neighbours.iter().copied().find(|&v| v != b);
                probed.split_vertex(a, Some(b), other, at).err()
            }
            Edit::Compact => None,
        };
        if let Some(refusal) = refusal {
            panic!("{}: {edit} refused on a torus: {refusal}", M::NAME);
        }
        max = max.max(probe.take().len());
    }
    max
}

fn triangle_corners<V: Copy>(corners: impl Iterator<Item = V>) -> [V; 3] {
    let corners: Vec<V> = corners.collect();
    <[V; 3]>::try_from(corners.as_slice()).expect("a triangle")
}
