//! Laws about elements, their handles and maps.

use std::collections::BTreeSet;
use std::fmt::Debug;
use std::ops::{Index, IndexMut};

use sixfold_core::{Handle, MeshQuery, Numbers, PolygonMesh, Representation};

use super::relations::is_rotation;
use crate::catch_panic::catch_panic;
use crate::element::Element;
use crate::subject::{Subject, stored_mesh};
use crate::weld::position_key;

/// `vertices`, `edges` and `faces` yield each element once, and `vertex_count`, `edge_count` and
/// `face_count` return the numbers of these elements. Faces are in the order of the input. Vertices
/// are in the order of the input, or in the order in which the faces list them if the structure
/// merges vertices with equal coordinates.
pub fn elements<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let Subject {
        mesh,
        oracle,
        handles,
        ..
    } = &subject;
    let vertices: Vec<_> = oracle.vertices().map(|v| handles.vertex(v)).collect();
    let faces: Vec<_> = oracle.faces().map(|f| handles.face(f)).collect();
    assert!(
        mesh.vertices().eq(vertices.iter().copied()),
        "{}: vertices() is {:?}, expected {vertices:?}",
        M::NAME,
        mesh.vertices().collect::<Vec<_>>()
    );
    assert!(
        mesh.faces().eq(faces.iter().copied()),
        "{}: faces() is {:?}, expected {faces:?}",
        M::NAME,
        mesh.faces().collect::<Vec<_>>()
    );
    let mut ends = BTreeSet::new();
    for e in mesh.edges() {
        let edge = handles.edge_id(e);
        assert!(ends.insert(edge), "{}: edges() has {edge} twice", M::NAME);
    }
    let expected: BTreeSet<Element> = oracle.edges().collect();
    assert_eq!(ends, expected, "{}: edges()", M::NAME);
    for (what, got, expected) in [
        ("vertex_count", mesh.vertex_count(), vertices.len()),
        ("edge_count", mesh.edge_count(), expected.len()),
        ("face_count", mesh.face_count(), faces.len()),
    ] {
        assert_eq!(got, expected, "{}: {what}()", M::NAME);
    }
}

/// `vertex_handle` and `face_handle` return a different handle for each element. The iterators of
/// the mesh yield the same handles.
pub fn names<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let mesh = &subject.mesh;
    for ((_, corners), f) in polygons.faces().iter().zip(mesh.faces()) {
        let named: Vec<_> = corners
            .iter()
            .map(|&v| M::vertex_handle(polygons, v))
            .collect();
        let got: Vec<_> = mesh.face_vertices(f).collect();
        assert!(
            is_rotation(&got, &named),
            "{}: face_vertices of {f:?} is {got:?}, but vertex_handle gives {named:?}",
            M::NAME
        );
    }
    let vertices: BTreeSet<_> = polygons
        .vertices()
        .map(|v| M::vertex_handle(polygons, v))
        .collect();
    assert_eq!(
        vertices.len(),
        stored_mesh::<M>(polygons).vertex_count(),
        "{}: number of different vertex_handles (left) and of vertices (right)",
        M::NAME
    );
    for (f, name) in polygons.faces().iter().map(|(f, _)| f).zip(mesh.faces()) {
        assert_eq!(
            M::face_handle(polygons, f),
            name,
            "{}: face_handle of {f}",
            M::NAME
        );
    }
}

/// `position` is the position in the input, bit for bit, except that −0 may become 0.
pub fn positions<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    for v in subject.oracle.vertices() {
        let got = subject.mesh.position(subject.handles.vertex(v));
        let expected = subject.input.position(v);
        assert_eq!(
            position_key(got),
            position_key(expected),
            "{}: position of {v}",
            M::NAME
        );
    }
}

/// A new map contains the initial value for every handle. After a write to a handle, the map
/// contains the new value for this handle.
pub fn maps<M: Representation>(polygons: &PolygonMesh) {
    let Some(Subject { mesh, .. }) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    check_map::<M, _, _>(mesh.vertices().collect(), mesh.vertex_map(usize::MAX));
    check_map::<M, _, _>(mesh.edges().collect(), mesh.edge_map(usize::MAX));
    check_map::<M, _, _>(mesh.faces().collect(), mesh.face_map(usize::MAX));
}

fn check_map<M: Representation, H, Map>(handles: Vec<H>, mut map: Map)
where
    H: Copy + Debug,
    Map: Index<H, Output = usize> + IndexMut<H>,
{
    for &h in &handles {
        assert_eq!(map[h], usize::MAX, "{}: a new map at {h:?}", M::NAME);
    }
    for (i, &h) in handles.iter().enumerate() {
        map[h] = i;
    }
    for (i, &h) in handles.iter().enumerate() {
        assert_eq!(map[h], i, "{}: a map written at {h:?}", M::NAME);
    }
}

/// `vertex_numbers`, `edge_numbers` and `face_numbers` number the elements from 0, in the order of
/// the iterators.
pub fn numbers<M: Representation>(polygons: &PolygonMesh) {
    if let Some(subject) = Subject::<M>::from_polygons(polygons) {
        check_numbers(&subject.mesh, M::NAME);
    }
}

/// Checks the numbers of all elements of `mesh`.
///
/// # Panics
///
/// Panics if a number or a handle is wrong.
pub(crate) fn check_numbers<M: MeshQuery>(mesh: &M, name: &str) {
    check_kind(name, mesh.vertices().collect(), &mesh.vertex_numbers());
    check_kind(name, mesh.edges().collect(), &mesh.edge_numbers());
    check_kind(name, mesh.faces().collect(), &mesh.face_numbers());
}

fn check_kind<H: Handle>(name: &str, handles: Vec<H>, numbers: &Numbers<H>) {
    assert_eq!(numbers.handles(), handles, "{name}: handles of the numbers");
    for (number, h) in (0..).zip(handles) {
        assert_eq!(numbers[h], number, "{name}: number of {h:?}");
    }
}

/// If a handle is a row that does not exist, queries panic with a message that contains the handle.
/// If a handle consists of coordinates that are not in the mesh, the answers of its relations are
/// empty.
///
/// The law uses handles of another mesh: a strip of triangles that has more elements and is far
/// away.
pub fn missing_handles<M: Representation>(polygons: &PolygonMesh) {
    let Some(Subject { mesh, .. }) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let larger =
        M::from_polygons(&distant_strip(polygons)).expect("an oriented manifold of triangles");
    let (v, e, f) = (
        larger
            .vertices()
            .max()
            .expect("the larger mesh has vertices"),
        larger.edges().max().expect("the larger mesh has edges"),
        larger.faces().max().expect("the larger mesh has faces"),
    );
    let rows = Rows {
        vertex: catch_panic(|| mesh.vertex_map(0)[v]).is_err(),
        edge: catch_panic(|| mesh.edge_map(0)[e]).is_err(),
        face: catch_panic(|| mesh.face_map(0)[f]).is_err(),
    };
    check_not_contained(&mesh, v, e, f);
    for (missing, answers) in [
        (rows.for_vertex(), &vertex_answers(&mesh, v)[..]),
        (rows.for_edge(), &edge_answers(&mesh, e)),
        (rows.for_face(), &face_answers(&mesh, f)),
    ] {
        for (query, answer) in answers {
            missing.check(M::NAME, query, answer);
        }
    }
    if rows.vertex {
        let answer = items(|| mesh.position(v).to_array().len());
        Missing::Panics.check(M::NAME, "position", &answer);
    }
    if rows.edge {
        let answer = items(|| mesh.edge_vertices(e).len());
        Missing::Panics.check(M::NAME, "edge_vertices", &answer);
    }
}

fn check_not_contained<M: Representation>(mesh: &M, v: M::Vertex, e: M::Edge, f: M::Face) {
    assert!(
        !mesh.contains_vertex(v),
        "{}: contains_vertex of {v:?}",
        M::NAME
    );
    assert!(
        !mesh.contains_edge(e),
        "{}: contains_edge of {e:?}",
        M::NAME
    );
    assert!(
        !mesh.contains_face(f),
        "{}: contains_face of {f:?}",
        M::NAME
    );
}

/// The name of a query, and its answer.
type Answer = (&'static str, String);

fn vertex_answers<M: Representation>(mesh: &M, v: M::Vertex) -> [Answer; 4] {
    let one_ring = || mesh.one_ring(v).map_or(0, Iterator::count);
    [
        ("vertex_vertices", items(|| mesh.vertex_vertices(v).count())),
        ("vertex_edges", items(|| mesh.vertex_edges(v).count())),
        ("vertex_faces", items(|| mesh.vertex_faces(v).count())),
        ("one_ring", items(one_ring)),
    ]
}

fn edge_answers<M: Representation>(mesh: &M, e: M::Edge) -> [Answer; 2] {
    [
        ("edge_edges", items(|| mesh.edge_edges(e).count())),
        ("edge_faces", items(|| mesh.edge_faces(e).count())),
    ]
}

fn face_answers<M: Representation>(mesh: &M, f: M::Face) -> [Answer; 3] {
    [
        ("face_vertices", items(|| mesh.face_vertices(f).count())),
        ("face_edges", items(|| mesh.face_edges(f).count())),
        ("face_faces", items(|| mesh.face_faces(f).count())),
    ]
}

/// Whether the handles of each kind of element are rows.
struct Rows {
    vertex: bool,
    edge: bool,
    face: bool,
}

impl Rows {
    fn for_vertex(&self) -> Missing {
        if self.vertex {
            Missing::Panics
        } else {
            Missing::Empty
        }
    }

    fn for_edge(&self) -> Missing {
        match (self.edge, self.vertex) {
            (true, _) => Missing::Panics,
            // The handle is a pair of rows that are out of range.
            (false, true) => Missing::Either,
            (false, false) => Missing::Empty,
        }
    }

    fn for_face(&self) -> Missing {
        if self.face {
            Missing::Panics
        } else {
            Missing::Empty
        }
    }
}

/// The required result of a query with a missing handle.
#[derive(Clone, Copy, Debug)]
enum Missing {
    Panics,
    Empty,
    Either,
}

impl Missing {
    fn check(self, structure: &str, query: &str, answer: &str) {
        let names_handle =
            answer.starts_with("no ") && answer.contains(|c: char| c.is_ascii_digit());
        let is_correct = match self {
            Self::Panics => names_handle,
            Self::Empty => answer == NO_ITEMS,
            Self::Either => names_handle || answer == NO_ITEMS,
        };
        assert!(
            is_correct,
            "{structure}: {query} of a missing element must be {self:?}, but is “{answer}”"
        );
    }
}

const NO_ITEMS: &str = "0 items";

fn items(query: impl FnOnce() -> usize) -> String {
    match catch_panic(query) {
        Ok(count) => format!("{count} items"),
        Err(panic) => panic.message,
    }
}

/// Builds a strip of triangles with more elements than `polygons`, at other positions.
pub(super) fn distant_strip(polygons: &PolygonMesh) -> PolygonMesh {
    let finite = polygons.positions().iter().filter(|p| p.is_finite());
    let x = finite.map(|p| p.x.abs()).fold(1.0, f32::max) * 4.0;
    let size = polygons.vertex_count() + polygons.corner_count() + 3;
    crate::gallery::strip(size as u32, x)
}
