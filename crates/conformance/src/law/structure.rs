//! Laws about construction, export, moved vertices, validation and probes.

use sixfold_core::{
    FaceId, Measured, MeshQuery, Point, PolygonMesh, Relation, Representation, Traced, VertexId,
};

use super::relations::{agree, is_rotation};
use crate::subject::{Subject, held};
use crate::weld::place;

/// `from_polygons` accepts exactly the meshes that `CAPABILITIES` include. For all others, it
/// returns the error of `CAPABILITIES.check`, which is also the error found by brute force.
pub fn verdict<M: Representation>(polygons: &PolygonMesh) {
    let built = M::from_polygons(polygons).map(|_| ());
    let declared = M::CAPABILITIES.check(polygons);
    assert_eq!(
        built,
        declared,
        "{}: from_polygons (left) and CAPABILITIES.check (right)",
        M::NAME
    );
    let expected = crate::verdict(&M::CAPABILITIES, polygons);
    assert_eq!(
        declared,
        expected,
        "{}: CAPABILITIES.check (left) and brute force (right)",
        M::NAME
    );
}

/// `to_polygons` returns the mesh from which the structure was built, up to the start of each face.
/// The result can be used to build the structure again.
pub fn round_trip<M: Representation>(polygons: &PolygonMesh) {
    let Some(Subject { mesh, input, .. }) = Subject::<M>::of(polygons) else {
        return;
    };
    let out = mesh.to_polygons();
    is_same::<M>("to_polygons", &out, &input);
    match M::from_polygons(&out) {
        Ok(again) => is_same::<M>("a second to_polygons", &again.to_polygons(), &input),
        Err(e) => panic!("{}: from_polygons of its own to_polygons: {e}", M::NAME),
    }
}

/// `set_positions` moves every vertex, and does not change the connectivity or any answer.
///
/// If vertices are identified by their coordinates, vertices with equal new positions are merged.
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

/// Moves the vertices of `subject` to `places`, and checks every answer.
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

/// Returns a different position for each vertex, far from the positions of the shapes.
fn elsewhere(v: VertexId) -> Point {
    let i = v.index() as f32;
    Point::new(1000.0 + i, -i, (v.index() % 7) as f32)
}

/// Returns two vertices with no face in common.
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
                        "{}: {relation} of {element} is {got:?}, expected {expected:?}",
                        M::NAME
                    );
                }
                _ => agree(subject, relation, element),
            }
        }
    }
}

/// `validate()` returns no error.
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

/// A probed copy gives the same answers in the same order, and its reads are recorded.
pub fn probed<M: Measured>(polygons: &PolygonMesh) {
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
                "{}: {relation} of {element}, probed (left) and not probed (right)",
                M::NAME
            );
        }
    }
    for v in oracle.vertices() {
        let [plain, watched] = [names.ring(&mesh, v), names.ring(&watched, v)];
        assert_eq!(
            watched,
            plain,
            "{}: one_ring of {v}, probed (left) and not probed (right)",
            M::NAME
        );
    }
    assert!(
        watched.vertices().eq(mesh.vertices()),
        "{}: vertices() of the probed copy",
        M::NAME
    );
    assert!(
        watched.edges().eq(mesh.edges()),
        "{}: edges() of the probed copy",
        M::NAME
    );
    assert!(
        watched.faces().eq(mesh.faces()),
        "{}: faces() of the probed copy",
        M::NAME
    );
    let reads = probe.take();
    assert!(
        input.face_count() == 0 || !reads.is_empty(),
        "{}: no table reads were recorded",
        M::NAME
    );
}

/// Checks that positions are equal bit for bit (−0 equals 0), and faces up to their start.
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
            "{}: {f} of {what} is {got:?}, expected {expected:?}",
            M::NAME
        );
    }
}
