//! Laws that compare the edits of a structure with the model of [`edit`](crate::edit).

use std::cell::{Cell, RefCell};
use std::fmt::Debug;

use sixfold_core::{
    Edit, Measured, MeshEdit, Point, PolygonMesh, QueryCost, Refusal, Representation, Traced,
    edit_at_face,
};

use super::scripts::on_random_scripts;
use crate::edit::{Action, ModelTest, Step};

/// Maximum number of tried steps for each accepted step of an edit.
const MAX_STEPS_PER_ACCEPTED: usize = 12;

/// Random sequences of edits have the same effect on the structure and on the model. After every
/// edit, the mesh equals the model, the handles agree with the reported changes, and the invariants
/// hold. A refused edit does not change the mesh. After every 16 edits, all relations are checked.
///
/// The environment variable `PROPTEST_CASES` sets the number of random edit sequences.
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
    test.apply(&Action::Compact {});
    test.check_all();
    counts_by_edit.set(counts);
}

/// Minimum number of steps on meshes that the structure can hold.
const MIN_STEPS: usize = 1000;

fn check_acceptance<M: MeshEdit + Representation>(counts_by_edit: &[[usize; 2]; Edit::ALL.len()]) {
    let tried: usize = counts_by_edit.iter().flatten().sum();
    let default_cases = std::env::var_os("PROPTEST_CASES").is_none();
    assert!(
        tried > MIN_STEPS || !default_cases,
        "{}: only {tried} steps were on meshes that the structure can hold",
        M::NAME
    );
    for (edit, [accepted, refused]) in Edit::ALL.into_iter().zip(counts_by_edit) {
        let share = 100.0 * *accepted as f64 / (accepted + refused).max(1) as f64;
        println!(
            "{}: {accepted} of {} steps of {edit} were accepted ({share:.0} %)",
            M::NAME,
            accepted + refused
        );
        // A few scripts may not contain every edit.
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

/// The declared costs `EDITS` agree with the measured accesses to table rows.
///
/// - Constant and Local: the number of accesses does not depend on the size of the mesh.
/// - Scan: the number of accesses grows with the mesh. The law fails if a cheaper edit is declared
///   as a scan.
///
/// The meshes are two tori of valence six. The large torus has sixteen times as many faces as the
/// small torus. Only accesses to table rows are counted, not the cost of growing a table.
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

/// Returns the maximum number of rows that `edit` accesses, at a few faces of the mesh.
fn accesses<M>(polygons: &PolygonMesh, edit: Edit) -> usize
where
    M: Measured + MeshEdit,
    M::Probed<Traced>: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
{
    let mut mesh =
        M::from_polygons(polygons).expect("every structure holds closed triangle meshes");
    // The first hole allocates one bit for every row, which must not be counted.
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
        let corners: Vec<M::Vertex> = mesh.face_vertices(f).collect();
        let refused = |refusal: Refusal<M>| -> ! {
            panic!("{}: {edit} refused on a torus: {refusal}", M::NAME)
        };
        let call = edit_at_face(&mut mesh, edit, f, &corners, at);
        let call = call.unwrap_or_else(|refusal| refused(refusal));
        let probe = Traced::default();
        let mut probed = mesh.probed(probe.clone());
        probe.take();
        if let Err(refusal) = call.apply(&mut probed, &mut ()) {
            refused(refusal);
        }
        max = max.max(probe.take().len());
    }
    max
}
