//! In, out, moved, checked and watched.

use mesh_core::{
    FaceId, MeshQuery, Point, PolygonMesh, Relation, Representation, Traced, VertexId,
};

use super::relations::{agree, is_rotation};
use crate::subject::{Subject, held};
use crate::weld::place;

/// `from_polygons` takes exactly what `CAPABILITIES` include, and refuses the rest with the very
/// error that `CAPABILITIES.check` gives and that brute force finds.
pub fn verdict<M: Representation>(polygons: &PolygonMesh) {
    let built = M::from_polygons(polygons).map(|_| ());
    let declared = M::CAPABILITIES.check(polygons);
    assert_eq!(
        built,
        declared,
        "{}: from_polygons, and then CAPABILITIES.check",
        M::NAME
    );
    let expected = crate::verdict(&M::CAPABILITIES, polygons);
    assert_eq!(
        declared,
        expected,
        "{}: CAPABILITIES.check, and then brute force",
        M::NAME
    );
}

/// What comes out is what went in, up to the start of each face, and goes in again.
pub fn round_trip<M: Representation>(polygons: &PolygonMesh) {
    let Some(Subject { mesh, input, .. }) = Subject::<M>::of(polygons) else {
        return;
    };
    let out = mesh.to_polygons();
    is_same::<M>("to_polygons", &out, &input);
    match M::from_polygons(&out) {
        Ok(again) => is_same::<M>("a second to_polygons", &again.to_polygons(), &input),
        Err(e) => panic!("{}: refuses its own to_polygons: {e}", M::NAME),
    }
}

/// `set_positions` moves every vertex and leaves the connectivity, and every answer, as it was.
///
/// Where a vertex is its coordinates, vertices moved to one place become one.
pub fn set_positions<M: Representation>(polygons: &PolygonMesh) {
    let Some(mut subject) = Subject::<M>::of(polygons) else {
        return;
    };
    let input = subject.input.clone();
    let apart = input.vertices().map(elsewhere).collect();
    subject = moved(subject, apart);
    subject = moved(subject, input.positions().to_vec());
    if !M::CAPABILITIES.coincident_vertices
        && let Some([a, b]) = strangers(&subject)
    {
        let mut together: Vec<Point> = input.vertices().map(elsewhere).collect();
        together[b.index()] = together[a.index()];
        moved(subject, together);
    }
}

/// `subject` with its vertices moved to `places`, after every answer has been checked.
fn moved<M: Representation>(subject: Subject<M>, places: Vec<Point>) -> Subject<M> {
    let Subject {
        mut mesh,
        input,
        names,
        ..
    } = subject;
    let mut positions = mesh.vertex_map(Point::ZERO);
    for (v, &place) in input.vertices().zip(&places) {
        positions[names.vertex(v)] = place;
    }
    if let Err(refusal) = mesh.set_positions(&positions) {
        panic!("{}: set_positions: {refusal}", M::NAME);
    }
    let faces = input.faces().clone();
    let input = PolygonMesh::from_faces(places, faces).expect("the faces are those of a mesh");
    is_same::<M>(
        "to_polygons after set_positions",
        &mesh.to_polygons(),
        &held::<M>(&input),
    );
    let subject = Subject::built(mesh, &input);
    for v in subject.oracle.vertices() {
        let got = subject.mesh.position(subject.names.vertex(v));
        assert_eq!(
            place(got),
            place(subject.input.position(v)),
            "{}: position of {v} after set_positions",
            M::NAME
        );
    }
    all_relations(&subject);
    valid(&subject.mesh);
    subject
}

/// A place of its own for each vertex, far from those of the shapes.
fn elsewhere(v: VertexId) -> Point {
    let i = v.index() as f32;
    Point::new(1000.0 + i, -i, (v.index() % 7) as f32)
}

/// Two vertices with no face in common.
fn strangers<M: Representation>(subject: &Subject<M>) -> Option<[VertexId; 2]> {
    let oracle = &subject.oracle;
    let meet = |a, b| {
        let mut faces = oracle.faces();
        faces.any(|f| [a, b].iter().all(|v| oracle.corners(f).contains(v)))
    };
    let a = oracle.vertices().next()?;
    let b = oracle.vertices().find(|&b| !meet(a, b))?;
    Some([a, b])
}

fn all_relations<M: Representation>(subject: &Subject<M>) {
    for relation in Relation::ALL {
        for element in subject.oracle.domain(relation) {
            match relation {
                Relation::FaceVertices | Relation::FaceEdges => {
                    let got = subject.ask(relation, element);
                    let expected = subject.oracle.answer(relation, element);
                    assert!(
                        is_rotation(&got, expected),
                        "{}: {relation} of {element} is {got:?}, not {expected:?}",
                        M::NAME
                    );
                }
                _ => agree(subject, relation, element),
            }
        }
    }
}

/// `validate()` finds every invariant kept.
pub fn invariants<M: Representation>(polygons: &PolygonMesh) {
    if let Some(subject) = Subject::<M>::of(polygons) {
        valid(&subject.mesh);
    }
}

fn valid<M: Representation>(mesh: &M) {
    if let Err(fault) = mesh.validate() {
        panic!("{}: validate: {fault}", M::NAME);
    }
}

/// A watched copy gives the same answers in the same order, and its reads are seen.
pub fn probed<M: Representation>(polygons: &PolygonMesh) {
    let Some(Subject {
        mesh,
        input,
        oracle,
        names,
    }) = Subject::<M>::of(polygons)
    else {
        return;
    };
    let probe = Traced::default();
    let watched = mesh.clone().probed(probe.clone());
    for relation in Relation::ALL {
        for element in oracle.domain(relation) {
            let [plain, watched] = [
                names.ask(&mesh, relation, element),
                names.ask(&watched, relation, element),
            ];
            assert_eq!(
                watched,
                plain,
                "{}: {relation} of {element}, watched and then not",
                M::NAME
            );
        }
    }
    for v in oracle.vertices() {
        let [plain, watched] = [names.ring(&mesh, v), names.ring(&watched, v)];
        assert_eq!(
            watched,
            plain,
            "{}: one_ring of {v}, watched and then not",
            M::NAME
        );
    }
    assert!(
        watched.vertices().eq(mesh.vertices()),
        "{}: vertices(), watched",
        M::NAME
    );
    assert!(
        watched.edges().eq(mesh.edges()),
        "{}: edges(), watched",
        M::NAME
    );
    assert!(
        watched.faces().eq(mesh.faces()),
        "{}: faces(), watched",
        M::NAME
    );
    let reads = probe.take();
    assert!(
        input.face_count() == 0 || !reads.is_empty(),
        "{}: no query reads any table",
        M::NAME
    );
}

/// Positions are the same to the bit (−0 is 0), and faces up to their start.
fn is_same<M: Representation>(what: &str, got: &PolygonMesh, expected: &PolygonMesh) {
    let places = |mesh: &PolygonMesh| {
        mesh.positions()
            .iter()
            .map(|&p| place(p))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        places(got),
        places(expected),
        "{}: positions of {what}",
        M::NAME
    );
    let corners = |mesh: &PolygonMesh, f: FaceId| mesh.faces().face(f).to_vec();
    assert_eq!(
        got.face_count(),
        expected.face_count(),
        "{}: faces of {what}",
        M::NAME
    );
    for (f, _) in expected.faces().iter() {
        let (got, expected) = (corners(got, f), corners(expected, f));
        assert!(
            is_rotation(&got, &expected),
            "{}: {f} of {what} is {got:?}, not {expected:?}",
            M::NAME
        );
    }
}
