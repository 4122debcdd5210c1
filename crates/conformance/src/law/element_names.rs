//! The law that names of elements do not depend on the structure.

use std::collections::BTreeMap;
use std::fmt::Debug;

use sixfold_core::{
    Changes, EditRecord, ElementNames, FaceId, FacesBefore, Handle, MeshEdit, PolygonMesh,
    Representation, VertexId,
};

use super::scripts::{Executed, on_random_scripts};
use crate::edit::{
    Action, Model, Rules, Step, apply_action, canonical_rotation, sides, translated,
};
use crate::subject::stored_mesh;
use crate::weld::{position_key, weld_numbers};

/// A name means the same element on the structure and on the model, also after random sequences of
/// edits. The model has other handles than every structure: for example, `poke_face` makes all of
/// its faces anew. Elements are compared by the positions of their vertices.
///
/// The environment variable `PROPTEST_CASES` sets the number of random edit sequences.
pub fn names_follow_edits<M: Representation + MeshEdit + Debug>() {
    names_follow_edits_by::<M>(|names, mesh, record, before| {
        names.follow(mesh, record, before);
    });
}

/// Runs the law [`names_follow_edits`] with names that follow each edit by `follow`.
pub fn names_follow_edits_by<M: Representation + MeshEdit + Debug>(
    follow: impl Fn(&mut Names<M>, &M, &EditRecord<M>, &FacesBefore),
) {
    on_random_scripts::<M>(
        "gives names to other elements than the model",
        |start, steps, executed| run_script(&follow, start, steps, executed),
    );
}

type Names<M> =
    ElementNames<<M as sixfold_core::MeshQuery>::Vertex, <M as sixfold_core::MeshQuery>::Face>;

fn run_script<M: Representation + MeshEdit + Debug>(
    follow: impl Fn(&mut Names<M>, &M, &EditRecord<M>, &FacesBefore),
    start: &PolygonMesh,
    steps: &[Step],
    executed: &Executed,
) {
    if M::CAPABILITIES.check(start).is_err() {
        return;
    }
    let mut mesh = M::from_polygons(start).expect("the capabilities include this mesh");
    let mut names = ElementNames::new::<M>(start);
    let (mut model, rules) = (
        Model::from_polygons(&stored_mesh::<M>(start)),
        Rules::new::<M>(),
    );
    let merged = (!M::CAPABILITIES.coincident_vertices).then(|| weld_numbers(start));
    let number = |v: VertexId| {
        merged
            .as_ref()
            .map_or(v, |merged| VertexId::new(merged[&v]))
    };
    let mut expected = ElementNames::from_handles(start, number, |f| f);
    for (nth, step) in steps.iter().enumerate() {
        let Some(action) = step.action(&model, nth) else {
            continue;
        };
        // The elements of the structure that have the names of the elements of the model.
        let vertices = model.vertices().filter_map(|v| {
            let number = expected.vertex_number(VertexId::new(v as u32))?;
            Some((v, names.vertex(number)?))
        });
        let vertices: BTreeMap<usize, M::Vertex> = vertices.collect();
        let faces = model.faces().filter_map(|(f, _)| {
            let number = expected.face_number(FaceId::new(f as u32))?;
            Some((f, names.face(number)?))
        });
        let faces: BTreeMap<usize, M::Face> = faces.collect();
        let (ends, face) = (action.edge().copied(), action.face().copied());
        let call = translated(&mesh, M::NAME, &vertices, &faces, &action);
        let before = names.faces_before(&mesh, &call);
        let has_ends = |face: &[usize]| ends.is_some_and(|ends| is_side(face, ends));
        let cut = model
            .faces()
            .filter(|&(f, corners)| Some(f) == face || has_ends(corners));
        let cut = cut.map(|(f, _)| FaceId::new(f as u32));
        let expected_before = expected.faces_before_by(cut, |f| corners(&model, f));
        let mut record = EditRecord::new();
        let outcome = apply_action(&mut mesh, M::NAME, &vertices, &faces, &action, &mut record);
        executed
            .borrow_mut()
            .push((action.clone(), outcome.is_ok()));
        let after = model.after(&action, &rules);
        assert_eq!(
            outcome.is_ok(),
            after.is_some(),
            "{}: accepted by the structure (left) and by the model, {action:?}",
            M::NAME
        );
        let Some(after) = after else {
            continue;
        };
        follow(&mut names, &mesh, &record, &before);
        let [old, new] = [&model, &after].map(ids);
        let changed_faces = changes(&old.1, &new.1);
        expected.follow_by(
            &changes(&old.0, &new.0),
            &changed_faces,
            &expected_before,
            |f| corners(&after, f),
        );
        model = after;
        compare(&model, &mesh, &names, &expected, &action);
    }
}

fn compare<M: Representation + MeshEdit + Debug>(
    model: &Model,
    mesh: &M,
    names: &Names<M>,
    expected: &ElementNames<VertexId, FaceId>,
    action: &Action,
) {
    let name = M::NAME;
    let position = |v: M::Vertex| position_key(mesh.position(v));
    let expected_position = |v: VertexId| {
        let position = model.position(v.index());
        position_key(position.expect("a vertex of the model"))
    };
    let vertices = names.vertices().iter().map(|v| v.map(position));
    let expected_vertices = expected.vertices().iter().map(|v| v.map(expected_position));
    assert_named("v", vertices, expected_vertices, name, action);
    let corners_of = |f| canonical_rotation(mesh.face_vertices(f).map(position).collect());
    let faces = names.faces().iter().map(|f| f.map(corners_of));
    let expected_corners = |f: FaceId| {
        let corners = corners(model, f).into_iter();
        canonical_rotation(corners.map(expected_position).collect())
    };
    let expected_faces = expected.faces().iter().map(|f| f.map(expected_corners));
    assert_named("f", faces, expected_faces, name, action);
    let (vertices, faces) = (mesh.vertices(), mesh.faces());
    for v in vertices {
        let number = names.vertex_number(v);
        let found = number.and_then(|number| names.vertex(number));
        assert_eq!(
            found,
            Some(v),
            "{name}: the vertex with the number of {v:?} after {action:?}"
        );
    }
    for f in faces {
        let number = names.face_number(f);
        let found = number.and_then(|number| names.face(number));
        assert_eq!(
            found,
            Some(f),
            "{name}: the face with the number of {f:?} after {action:?}"
        );
    }
}

/// Checks that each name means an element at the expected positions.
fn assert_named<T: PartialEq + Debug>(
    letter: &str,
    found: impl ExactSizeIterator<Item = T>,
    expected: impl ExactSizeIterator<Item = T>,
    name: &str,
    action: &Action,
) {
    assert_eq!(
        found.len(),
        expected.len(),
        "{name}: names of the structure (left) and of the model, {letter}, after {action:?}"
    );
    for (number, (found, expected)) in found.zip(expected).enumerate() {
        assert_eq!(
            found, expected,
            "{name}: positions of {letter}{number} on the structure (left) and the model after {action:?}"
        );
    }
}

fn is_side(face: &[usize], [a, b]: [usize; 2]) -> bool {
    let mut sides = sides(face);
    sides.any(|side| side == (a, b) || side == (b, a))
}

fn corners(model: &Model, f: FaceId) -> Vec<VertexId> {
    let corners = model.face(f.index()).into_iter().flatten();
    corners.map(|&v| VertexId::new(v as u32)).collect()
}

/// Returns the vertices and the faces of a model.
fn ids(model: &Model) -> (Vec<VertexId>, Vec<FaceId>) {
    let vertices = model.vertices().map(|v| VertexId::new(v as u32));
    let faces = model.faces().map(|(f, _)| FaceId::new(f as u32));
    (vertices.collect(), faces.collect())
}

/// Returns the elements that are only in `new`, and those that are only in `old`.
fn changes<H: Handle>(old: &[H], new: &[H]) -> Changes<H> {
    let only = |one: &[H], other: &[H]| {
        let only = one.iter().filter(|h| !other.contains(h));
        only.copied().collect()
    };
    Changes {
        created: only(new, old),
        removed: only(old, new),
        renamed: Vec::new(),
    }
}
