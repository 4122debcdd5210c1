//! Laws about the limits of 32-bit handles. Lower limits make small meshes reach them.

use std::any::TypeId;
use std::fmt::Debug;

use sixfold_core::{
    EdgeId, EditError, EditRecord, MAX_CORNERS, MAX_EDGES, MAX_ROWS, MeshEdit, PolygonMesh, Refine,
    RefineError, Representation, Split, with_lower_limits,
};

use super::scripts::on_random_scripts;
use crate::edit::{Action, ModelTest};
use crate::expected_check::sides_by_edge;

/// A mesh with too many corners or edges is refused: `from_polygons` and `CAPABILITIES.check`
/// return the same error. A mesh that just reaches the limits is accepted.
pub fn build_limits<M: Representation>(polygons: &PolygonMesh) {
    let capabilities = &M::CAPABILITIES;
    if capabilities.check(polygons).is_err() {
        return;
    }
    let needed = if pairs_sides::<M>() {
        let edges = sides_by_edge(polygons).len();
        rows_for(polygons.corner_count(), MAX_CORNERS).max(rows_for(edges, MAX_EDGES))
    } else {
        0
    };
    for rows in [0, needed / 2, needed.saturating_sub(1), needed, needed + 1] {
        let (built, declared) = with_lower_limits(rows, || {
            let built = M::from_polygons(polygons).map(|_| ());
            (built, capabilities.check(polygons))
        });
        let name = M::NAME;
        assert_eq!(
            built, declared,
            "{name}: from_polygons (left) and CAPABILITIES.check (right) with at most {rows} rows"
        );
        assert_eq!(
            built.is_ok(),
            rows >= needed,
            "{name}: with at most {rows} rows, from_polygons returns {built:?}"
        );
    }
}

/// Returns whether the limits on edges and corners apply to `M`.
fn pairs_sides<M: Representation>() -> bool {
    !M::CAPABILITIES.can_name_edges(usize::MAX / 2)
}

/// A refined mesh with too many elements is refused; a mesh that just reaches the limits is not.
/// `refined` is the result of `split` on `mesh`.
pub(super) fn check_split_limits<M: Refine>(
    mesh: &M,
    numbers: &M::EdgeNumbers,
    split: Split,
    refined: &M,
) {
    let [most_edges, most_corners] = match pairs_sides::<M>() {
        true => [MAX_EDGES, MAX_CORNERS],
        false => [MAX_ROWS; 2],
    };
    let corners = refined.faces().map(|f| refined.face_vertices(f).count());
    let needed = rows_for(refined.vertex_count(), MAX_ROWS)
        .max(rows_for(refined.edge_count(), most_edges))
        .max(rows_for(corners.sum(), most_corners));
    let with_rows =
        |rows| with_lower_limits(rows, || mesh.split_into(split, numbers, &mut M::empty()));
    let name = M::NAME;
    assert_eq!(
        with_rows(needed),
        Ok(()),
        "{name}: {split} with at most {needed} rows"
    );
    let fewer = needed.saturating_sub(1);
    let refusal = with_rows(fewer);
    assert!(
        needed == 0
            || matches!(refusal, Err(RefineError::TooMany { number, limit, .. }) if number > limit),
        "{name}: {split} with at most {fewer} rows: {refusal:?}"
    );
}

/// Returns the lowest limit on rows for which `limit`, in proportion, allows `number` elements.
fn rows_for(number: usize, limit: usize) -> usize {
    (number as u128 * MAX_ROWS as u128).div_ceil(limit as u128) as usize
}

/// A limit on rows at which no edit of a script is refused.
const AMPLE_ROWS: usize = 1 << 16;

/// An edit that would exceed a limit is refused with [`EditError::TooMany`] and changes nothing.
/// With limits that the result just reaches, the edit has the same effect as without limits.
///
/// The environment variable `PROPTEST_CASES` sets the number of random edit sequences.
pub fn edit_limits<M: Representation + MeshEdit + Debug>() {
    on_random_scripts::<M>("has wrong limits", |start, steps, executed| {
        let Some(mut test) = ModelTest::<M>::from_polygons(start) else {
            return;
        };
        for (number, step) in steps.iter().enumerate() {
            let Some(action) = step.action(&test.model, number) else {
                continue;
            };
            let legal = test.is_legal(&action);
            executed.borrow_mut().push((action.clone(), legal));
            if legal {
                check_edit(&test, &action);
                test.apply(&action);
            }
        }
    });
}

fn check_edit<M: Representation + MeshEdit + Debug>(test: &ModelTest<M>, action: &Action) {
    let name = M::NAME;
    let before = format!("{:?}", test.mesh);
    let with_rows = |rows| {
        let (mut mesh, mut record) = (test.mesh.clone(), EditRecord::new());
        let outcome = with_lower_limits(rows, || test.apply_to(&mut mesh, action, &mut record));
        match outcome {
            Ok(_) => Some(mesh),
            Err(EditError::TooMany { .. }) => {
                assert!(
                    format!("{mesh:?}") == before && record.is_empty(),
                    "{name}: {action:?} exceeds {rows} rows, but changes the mesh"
                );
                None
            }
            Err(other) => panic!("{name}: {action:?} with at most {rows} rows: {other}"),
        }
    };
    let free = with_rows(AMPLE_ROWS).unwrap_or_else(|| panic!("{name}: {action:?} is refused"));
    let (mut too_few, mut enough) = (None, AMPLE_ROWS);
    while too_few.map_or(0, |few| few + 1) < enough {
        let low = too_few.map_or(0, |few| few + 1);
        let middle = low + (enough - low) / 2;
        match with_rows(middle) {
            Some(mesh) => {
                enough = middle;
                assert_eq!(
                    format!("{mesh:?}"),
                    format!("{free:?}"),
                    "{name}: {action:?} with at most {middle} rows (left) and without limits (right)"
                );
            }
            None => too_few = Some(middle),
        }
    }
    let mut tables = vec![
        (
            "vertices",
            test.mesh.vertex_rows(),
            free.vertex_rows(),
            MAX_ROWS,
        ),
        ("faces", test.mesh.face_rows(), free.face_rows(), MAX_ROWS),
    ];
    if TypeId::of::<M::Edge>() == TypeId::of::<EdgeId>() {
        tables.push(("edges", test.mesh.edge_rows(), free.edge_rows(), MAX_EDGES));
    }
    for (elements, old, new, limit) in tables {
        assert!(
            new <= old || enough >= rows_for(new, limit),
            "{name}: {action:?} makes {new} rows of {elements} with at most {enough} rows"
        );
    }
}
