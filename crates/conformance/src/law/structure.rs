//! Laws about construction, export, moved vertices, validation and probes.

use sixfold_core::{
    EdgeMap, EditRecord, FaceId, Measured, MeshQuery, Point, PolygonMesh, Relation, Representation,
    Traced, VertexId, VertexMap,
};

use super::relations::{check_relation, is_rotation};
use crate::subject::{Subject, stored_mesh};
use crate::weld::position_key;

/// `from_polygons` accepts exactly the meshes that `CAPABILITIES` include. For other meshes,
/// `from_polygons`, `CAPABILITIES.check` and a brute-force check return the same error.
pub fn verdict<M: Representation>(polygons: &PolygonMesh) {
    let built = M::from_polygons(polygons).map(|_| ());
    let declared = M::CAPABILITIES.check(polygons);
    assert_eq!(
        built,
        declared,
        "{}: from_polygons (left) and CAPABILITIES.check (right)",
        M::NAME
    );
    let expected = crate::expected_check(&M::CAPABILITIES, polygons);
    assert_eq!(
        declared,
        expected,
        "{}: CAPABILITIES.check (left) and brute force (right)",
        M::NAME
    );
}

/// `to_polygons` returns the mesh from which the structure was built; each face may start at
/// another corner. The structure can be built again from the returned mesh.
pub fn round_trip<M: Representation>(polygons: &PolygonMesh) {
    let Some(Subject { mesh, input, .. }) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let out = mesh.to_polygons();
    assert_same::<M>("to_polygons", &out, &input);
    match M::from_polygons(&out) {
        Ok(again) => assert_same::<M>("a second to_polygons", &again.to_polygons(), &input),
        Err(e) => panic!(
            "{}: cannot be built from the result of to_polygons: {e}",
            M::NAME
        ),
    }
}

/// `set_positions` moves every vertex, and does not change the connectivity or the answer of a
/// query.
///
/// If vertices are identified by their coordinates, vertices with equal new positions are merged. A
/// log receives the new handles, so that maps keep the values of all elements that remain.
pub fn set_positions<M: Representation>(polygons: &PolygonMesh) {
    let Some(mut subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let input = subject.input.clone();
    let separate = input.vertices().map(distant_position).collect();
    subject = move_and_check(subject, separate);
    subject = move_and_check(subject, input.positions().to_vec());
    if !M::CAPABILITIES.coincident_vertices
        && let Some([a, b]) = pair_without_common_face(&subject)
    {
        let mut merged: Vec<Point> = input.vertices().map(distant_position).collect();
        merged[b.index()] = merged[a.index()];
        move_and_check(subject, merged);
    }
}

fn move_and_check<M: Representation>(subject: Subject<M>, places: Vec<Point>) -> Subject<M> {
    let Subject {
        mut mesh,
        input,
        handles,
        ..
    } = subject;
    let mut positions = mesh.vertex_map(Point::ZERO);
    for (v, &position) in input.vertices().zip(&places) {
        positions[handles.vertex(v)] = position;
    }
    let numbers = Numbered::new(&mesh);
    let mut record = EditRecord::new();
    if let Err(refusal) = mesh.set_positions_logged(&positions, &mut record) {
        panic!("{}: set_positions: {refusal}", M::NAME);
    }
    numbers.check_after(&mesh, &record);
    let faces = input.faces().clone();
    let input = PolygonMesh::from_faces(places, faces).expect("the faces are those of a mesh");
    assert_same::<M>(
        "to_polygons after set_positions",
        &mesh.to_polygons(),
        &stored_mesh::<M>(&input),
    );
    let subject = Subject::from_mesh(mesh, &input);
    for v in subject.oracle.vertices() {
        let got = subject.mesh.position(subject.handles.vertex(v));
        assert_eq!(
            position_key(got),
            position_key(subject.input.position(v)),
            "{}: position of {v} after set_positions",
            M::NAME
        );
    }
    check_relations(&subject);
    check_invariants(&subject.mesh);
    subject
}

/// The place of each vertex and each edge in the order of the mesh.
struct Numbered<M: MeshQuery> {
    vertices: VertexMap<M, usize>,
    edges: EdgeMap<M, usize>,
    counts: [usize; 2],
}

impl<M: Representation> Numbered<M> {
    fn new(mesh: &M) -> Self {
        let mut numbers = Self {
            vertices: mesh.vertex_map(usize::MAX),
            edges: mesh.edge_map(usize::MAX),
            counts: [mesh.vertex_count(), mesh.edge_count()],
        };
        for (i, v) in mesh.vertices().enumerate() {
            numbers.vertices[v] = i;
        }
        for (i, e) in mesh.edges().enumerate() {
            numbers.edges[e] = i;
        }
        numbers
    }

    /// Checks that the elements of `mesh` after a move have the numbers of the first elements that
    /// became them, and that `record` has no other changes.
    fn check_after(mut self, mesh: &M, record: &EditRecord<M>) {
        record.vertices.apply_to(&mut self.vertices, &usize::MAX);
        record.edges.apply_to(&mut self.edges, &usize::MAX);
        let vertices = mesh.vertices().map(|v| self.vertices[v]).collect();
        let edges = mesh.edges().map(|e| self.edges[e]).collect();
        let removed = [record.vertices.removed.len(), record.edges.removed.len()];
        let kinds = [("vertices", vertices), ("edges", edges)];
        for ((kind, numbers), (count, removed)) in
            kinds.into_iter().zip(self.counts.into_iter().zip(removed))
        {
            let numbers: Vec<usize> = numbers;
            let ascending = numbers.is_sorted_by(|a, b| a < b);
            assert!(
                ascending && numbers.last().is_none_or(|&last| last < count),
                "{}: {kind} by the numbers before set_positions_logged: {numbers:?}",
                M::NAME
            );
            assert_eq!(
                count - removed,
                numbers.len(),
                "{}: {kind} that set_positions_logged leaves (left) and those of the mesh (right)",
                M::NAME
            );
        }
        let created = record.vertices.created.len() + record.edges.created.len();
        assert!(
            created == 0 && record.faces.is_empty(),
            "{}: set_positions_logged reports new elements or changed faces",
            M::NAME
        );
    }
}

fn distant_position(v: VertexId) -> Point {
    let i = v.index() as f32;
    Point::new(1000.0 + i, -i, (v.index() % 7) as f32)
}

fn pair_without_common_face<M: Representation>(subject: &Subject<M>) -> Option<[VertexId; 2]> {
    let oracle = &subject.oracle;
    let share_face = |a, b| {
        let mut faces = oracle.faces();
        faces.any(|f| [a, b].iter().all(|v| oracle.corners(f).contains(v)))
    };
    let a = oracle.vertices().next()?;
    let b = oracle.vertices().find(|&b| !share_face(a, b))?;
    Some([a, b])
}

fn check_relations<M: Representation>(subject: &Subject<M>) {
    for relation in Relation::ALL {
        for element in subject.oracle.domain(relation) {
            match relation {
                Relation::FaceVertices | Relation::FaceEdges => {
                    let got = subject.query(relation, element);
                    let expected = subject.oracle.answer(relation, element);
                    assert!(
                        is_rotation(&got, expected),
                        "{}: {relation} of {element} is {got:?}, expected {expected:?}",
                        M::NAME
                    );
                }
                _ => check_relation(subject, relation, element),
            }
        }
    }
}

/// `validate()` returns no error.
pub fn invariants<M: Representation>(polygons: &PolygonMesh) {
    if let Some(subject) = Subject::<M>::from_polygons(polygons) {
        check_invariants(&subject.mesh);
    }
}

fn check_invariants<M: Representation>(mesh: &M) {
    if let Err(fault) = mesh.validate() {
        panic!("{}: validate: {fault}", M::NAME);
    }
}

/// A copy with a probe gives the same answers in the same order. The probe records the reads of the
/// copy.
pub fn probed<M: Measured>(polygons: &PolygonMesh) {
    let Some(Subject {
        mesh,
        input,
        oracle,
        handles,
    }) = Subject::<M>::from_polygons(polygons)
    else {
        return;
    };
    let probe = Traced::default();
    let probed = mesh.clone().probed(probe.clone());
    for relation in Relation::ALL {
        for element in oracle.domain(relation) {
            let [plain, probed] = [
                handles.query(&mesh, relation, element),
                handles.query(&probed, relation, element),
            ];
            assert_eq!(
                probed,
                plain,
                "{}: {relation} of {element}, probed (left) and not probed (right)",
                M::NAME
            );
        }
    }
    for v in oracle.vertices() {
        let [plain, probed] = [handles.ring(&mesh, v), handles.ring(&probed, v)];
        assert_eq!(
            probed,
            plain,
            "{}: one_ring of {v}, probed (left) and not probed (right)",
            M::NAME
        );
    }
    assert!(
        probed.vertices().eq(mesh.vertices()),
        "{}: vertices() of the probed copy",
        M::NAME
    );
    assert!(
        probed.edges().eq(mesh.edges()),
        "{}: edges() of the probed copy",
        M::NAME
    );
    assert!(
        probed.faces().eq(mesh.faces()),
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

/// Checks that positions are equal bit for bit (−0 equals 0), and that faces are equal up to a
/// rotation.
fn assert_same<M: Representation>(what: &str, got: &PolygonMesh, expected: &PolygonMesh) {
    let keys = |mesh: &PolygonMesh| {
        mesh.positions()
            .iter()
            .map(|&p| position_key(p))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        keys(got),
        keys(expected),
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
