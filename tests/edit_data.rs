//! Checks that meshes with data give the same result on every structure, and that the laws for data
//! and names after edits detect faults.

use std::marker::PhantomData;
use std::panic::catch_unwind;

use sixfold::remeshing::{Decimation, Remeshing, Target};
use sixfold::{
    AcceptedEdit, Changes, EdgeData, EdgeMap, EditableCornerTable, EditableHalfEdgeMesh,
    EditableIndexedFaceSet, EditablePolygonSoup, FaceData, FaceMap, FollowEdits, Handle, HandleMap,
    LocalQueries, MeshEdit, MeshMove, MeshQuery, MeshWithData, OrientedWalk, Point, PolygonMesh,
    Representation, SideData, VertexData, VertexMap, for_each_editable,
};
use sixfold_conformance::law::{ElementNumbers, names_follow_edits_by, numbers_follow_edits};
use sixfold_core::FacesBefore;

use crate::remeshing::{Delaunay, Operator, surfaces};

/// The faces of a mesh. Each face has the coordinates and values of its corners, and its own value.
type ValuedFaces = Vec<(Vec<[u32; 4]>, u32)>;

/// Applies `operator` to `polygons` with data. At the start, the value of a vertex is a linear
/// function of x, and the value of a face is its number.
fn run<M: MeshEdit + Representation>(
    operator: &impl Operator,
    polygons: &PolygonMesh,
) -> ValuedFaces {
    let mesh = M::from_polygons(polygons).expect("a manifold of triangles");
    let mut plain = mesh.clone();
    let mut height = VertexData::new(&mesh, 0.0).with_rule(|height, new| {
        let heights = new.parents.iter().map(|&v| height[v]);
        heights.sum::<f32>() / new.parents.len() as f32
    });
    for v in mesh.vertices() {
        height[v] = 3.0 * (mesh.position(v).x + 0.0); // 0 for −0
    }
    let mut origin = FaceData::new(&mesh, u32::MAX)
        .with_rule(|origin, new| new.parents.first().map_or(u32::MAX, |&f| origin[f]));
    for (i, f) in (0..).zip(mesh.faces()) {
        origin[f] = i;
    }
    let mut mesh = MeshWithData::new(mesh, (height, origin));
    operator.run(&mut mesh);
    operator.run(&mut plain);
    mesh.compact();
    plain.compact();

    let (mesh, (height, origin)) = mesh.into_parts();
    let [with_data, without] = [mesh.to_polygons(), plain.to_polygons()];
    let same = with_data.positions() == without.positions()
        && with_data.faces().iter().eq(without.faces().iter());
    assert!(same, "{}: another mesh with data", M::NAME);
    let mut faces: ValuedFaces = Vec::new();
    for f in mesh.faces() {
        let corner = |v| {
            let [x, y, z] = (mesh.position(v) + Point::ZERO).to_array();
            [x, y, z, height[v]].map(f32::to_bits)
        };
        let mut corners: Vec<[u32; 4]> = mesh.face_vertices(f).map(corner).collect();
        corners.sort_unstable();
        faces.push((corners, origin[f]));
    }
    faces.sort_unstable();
    faces
}

fn compare_structures(operator: &impl Operator, polygons: &PolygonMesh) {
    let mut first = None;
    for_each_editable!(M => {
        let faces = run::<M>(operator, polygons);
        let count = polygons.face_count() as u32;
        assert!(faces.iter().all(|&(_, origin)| origin < count), "{}", M::NAME);
        let same = first.get_or_insert_with(|| faces.clone()) == &faces;
        assert!(same, "{} has other data", M::NAME);
    });
}

/// The value of a side is the sum of the numbers of its face and of its ends, weighted.
fn expected_side(numbers: &[usize; 3]) -> u32 {
    numbers[0] as u32 * 10_000 + numbers[1] as u32 * 100 + numbers[2] as u32
}

#[test]
fn values_of_sides_stay_at_their_sides() {
    let polygons = sixfold::shapes::icosahedron();
    for_each_editable!(M => {
        let mesh = M::from_polygons(&polygons).expect("a manifold");
        let (vertices, faces) = (mesh.vertex_numbers(), mesh.face_numbers());
        let mut values = SideData::new(&mesh, 0_u32);
        let sides = |mesh: &M| -> Vec<(<M as MeshQuery>::Face, [<M as MeshQuery>::Vertex; 2])> {
            let of_face = |f| {
                let corners: Vec<_> = mesh.face_vertices(f).collect();
                let next = corners.iter().copied().cycle().skip(1);
                corners.iter().copied().zip(next).map(move |(a, b)| (f, [a, b])).collect::<Vec<_>>()
            };
            mesh.faces().flat_map(of_face).collect()
        };
        let value = |(f, [a, b]): (_, [_; 2])| {
            expected_side(&[faces[f] as usize + 1, vertices[a] as usize, vertices[b] as usize])
        };
        let before = sides(&mesh);
        for &(f, ends) in &before {
            values.set(&mesh, f, ends, value((f, ends)));
        }
        // Not a side: its reverse is.
        values.set(&mesh, before[0].0, [before[0].1[1], before[0].1[0]], 7);
        assert_eq!(*values.get(before[0].0, [before[0].1[1], before[0].1[0]]), 0);
        let edge = mesh.edge_between(before[0].1[0], before[0].1[1]).expect("a side has an edge");
        let mut mesh = MeshWithData::new(mesh, values);
        mesh.flip_edge(edge).expect("two triangles");
        let flipped = sides(mesh.mesh());
        let kept = |side: &&(_, _)| before.contains(side);
        assert_eq!(flipped.iter().filter(kept).count(), 56, "{}: each triangle keeps one side", M::NAME);
        for &(f, ends) in &flipped {
            let expected = if before.contains(&(f, ends)) { value((f, ends)) } else { 0 };
            assert_eq!(*mesh.data().get(f, ends), expected, "{}", M::NAME);
        }
        // A removed face has no values, and compaction renames faces and vertices.
        let (last, _) = flipped[flipped.len() - 1];
        let position = |mesh: &M, v| mesh.position(v).to_array().map(f32::to_bits);
        let named = |mesh: &MeshWithData<M, SideData<M, u32>>| {
            let sides = sides(mesh.mesh()).into_iter();
            let named = sides.map(|(f, ends)| {
                (ends.map(|v| position(mesh.mesh(), v)), *mesh.data().get(f, ends))
            });
            let mut named: Vec<_> = named.collect();
            named.sort_unstable();
            named
        };
        let corner = mesh.face_vertices(last).next().expect("a corner");
        mesh.remove_vertex(corner).expect("a closed fan");
        let values = named(&mesh);
        mesh.compact();
        assert_eq!(named(&mesh), values, "{}", M::NAME);
        assert!(values.iter().filter(|(_, value)| *value > 0).count() > 40);
    });
}

#[test]
fn data_follows_moved_vertices_on_all() {
    let polygons = sixfold::shapes::icosahedron();
    for_each_editable!(M => {
        let mesh = M::from_polygons(&polygons).expect("a manifold of triangles");
        let (mut vertices, mut edges) = (VertexData::new(&mesh, 0), EdgeData::new(&mesh, 0));
        for (i, v) in mesh.vertices().enumerate() {
            vertices[v] = i;
        }
        for (i, e) in mesh.edges().enumerate() {
            edges[e] = i;
        }
        let mut mesh = MeshWithData::new(mesh, (vertices, edges));
        let mut doubled = mesh.vertex_map(Point::ZERO);
        for v in mesh.vertices() {
            doubled[v] = 2.0 * mesh.position(v);
        }
        mesh.set_positions(&doubled).expect("no two vertices meet");
        mesh.validate().expect("every invariant");
        let (vertices, edges) = mesh.data();
        assert!(mesh.vertices().enumerate().all(|(i, v)| vertices[v] == i), "{}", M::NAME);
        assert!(mesh.edges().enumerate().all(|(i, e)| edges[e] == i), "{}", M::NAME);
        let first = mesh.vertices().next().expect("12 vertices");
        assert_eq!(mesh.position(first), 2.0 * polygons.positions()[0], "{}", M::NAME);
    });
}

/// Returns the sum of the values of the faces around the origin of `side`, in order.
fn sum_around<M: OrientedWalk + LocalQueries>(
    mesh: &MeshWithData<M, FaceData<M, u32>>,
    side: M::Side,
) -> u32 {
    let mut sum = 0;
    let mut at = Some(side);
    while let Some(s) = at {
        sum += mesh.data()[mesh.side_face(s)];
        at = mesh.ccw_side(s).filter(|&next| next != side);
    }
    sum
}

#[test]
fn a_mesh_with_data_walks_and_has_local_queries() {
    fn largest_valence<M: LocalQueries>(mesh: &M) -> usize {
        mesh.vertices().map(|v| mesh.valence(v)).max().unwrap_or(0)
    }
    let mesh = EditableHalfEdgeMesh::from_polygons(&sixfold::shapes::icosahedron());
    let mesh = mesh.expect("a closed manifold");
    let mut numbers = FaceData::new(&mesh, 0);
    for (i, f) in (1..).zip(mesh.faces()) {
        numbers[f] = i;
    }
    let mesh = MeshWithData::new(mesh, numbers);
    assert_eq!(largest_valence(&mesh), 5);
    for v in mesh.vertices() {
        let side = mesh.outgoing_sides(v).next().expect("five");
        let expected: u32 = mesh.vertex_faces(v).map(|f| mesh.data()[f]).sum();
        assert_eq!(sum_around(&mesh, side), expected);
    }
    assert_eq!((mesh.side_count(), mesh.sides().count()), (60, 60));
    for s in mesh.sides() {
        assert_eq!(mesh.next_side(mesh.prev_side(s)), s);
        assert_eq!(mesh.twin_side(s).and_then(|t| mesh.twin_side(t)), Some(s));
        let ends = [mesh.side_origin(s), mesh.side_target(s)];
        assert_eq!(mesh.edge_between(ends[0], ends[1]), Some(mesh.side_edge(s)));
        assert_eq!(mesh.cw_side(s).and_then(|c| mesh.ccw_side(c)), Some(s));
        assert!(mesh.face_sides(mesh.side_face(s)).any(|t| t == s));
        assert!(mesh.edge_sides(mesh.side_edge(s)).any(|t| t == s));
    }
    assert_eq!(mesh.side_map(7)[mesh.sides().next().expect("60")], 7);
}

#[test]
fn data_follows_remeshing_in_the_same_way_on_all() {
    let target = Target::Ratio(0.3);
    let decimation = Decimation {
        target,
        ..Decimation::default()
    };
    for (polygons, length) in surfaces().iter().zip([0.2, 0.25, 1.6, 0.9]) {
        // One iteration splits, collapses and flips edges, and moves vertices.
        let remeshing = Remeshing {
            iterations: 1,
            ..Remeshing::with_edge_length(length)
        };
        compare_structures(&remeshing, polygons);
        compare_structures(&decimation, polygons);
        compare_structures(&Delaunay, polygons);
    }
}

/// Numbers of elements with an incorrect update after edits. `F` is the fault.
struct Faulty<M: MeshQuery, F> {
    vertices: VertexMap<M, u32>,
    edges: EdgeMap<M, u32>,
    faces: FaceMap<M, u32>,
    fault: PhantomData<F>,
}

trait Fault {
    fn follow<H: Handle>(changes: &Changes<H>, map: &mut H::Map<u32>);
}

impl<M: MeshQuery, F: Fault> FollowEdits<M> for Faulty<M, F> {
    fn follow(&mut self, edit: &AcceptedEdit<'_, M>) {
        F::follow(&edit.changes.vertices, &mut self.vertices);
        F::follow(&edit.changes.edges, &mut self.edges);
        F::follow(&edit.changes.faces, &mut self.faces);
    }
}

impl<M: MeshQuery, F: Fault> ElementNumbers<M> for Faulty<M, F> {
    fn new(mesh: &M) -> Self {
        Self {
            vertices: mesh.vertex_map(0),
            edges: mesh.edge_map(0),
            faces: mesh.face_map(0),
            fault: PhantomData,
        }
    }
    fn vertex(&mut self, v: M::Vertex) -> &mut u32 {
        &mut self.vertices[v]
    }
    fn edge(&mut self, e: M::Edge) -> &mut u32 {
        &mut self.edges[e]
    }
    fn face(&mut self, f: M::Face) -> &mut u32 {
        &mut self.faces[f]
    }
}

/// Renames elements one after the other, which is wrong if elements exchange handles.
struct RenamedOneByOne;

impl Fault for RenamedOneByOne {
    fn follow<H: Handle>(changes: &Changes<H>, map: &mut H::Map<u32>) {
        for &old in &changes.removed {
            map.remove(old);
        }
        for &[old, new] in &changes.renamed {
            map.rename(old, new);
        }
        for &new in &changes.created {
            map.insert(new, 0);
        }
    }
}

struct NotRenamed;

impl Fault for NotRenamed {
    fn follow<H: Handle>(changes: &Changes<H>, map: &mut H::Map<u32>) {
        let changes = Changes {
            renamed: vec![],
            ..changes.clone()
        };
        changes.apply_to(map, &0);
    }
}

struct NewLeftOut;

impl Fault for NewLeftOut {
    fn follow<H: Handle>(changes: &Changes<H>, map: &mut H::Map<u32>) {
        let changes = Changes {
            created: vec![],
            ..changes.clone()
        };
        changes.apply_to(map, &0);
    }
}

/// Checks that the law fails for `M` with this fault. The message must contain `words`.
fn assert_detected<M: Representation + MeshEdit + std::fmt::Debug, F: Fault>(words: &str) {
    let payload = catch_unwind(numbers_follow_edits::<M, Faulty<M, F>>);
    let payload = payload.expect_err("the law passes with the fault");
    let message = payload.downcast_ref::<String>().expect("a message");
    assert!(message.contains(M::NAME), "{message}");
    assert!(message.contains(words), "“{words}” is not in:\n{message}");
}

#[test]
fn elements_renamed_one_by_one_are_detected() {
    assert_detected::<EditableCornerTable, RenamedOneByOne>("number of e");
}

#[test]
fn missing_renames_are_detected() {
    assert_detected::<EditablePolygonSoup, NotRenamed>("number of ");
    assert_detected::<EditableIndexedFaceSet, NotRenamed>("number of ");
    assert_detected::<EditableHalfEdgeMesh, NotRenamed>("number of ");
}

#[test]
fn names_that_follow_the_handles_of_cut_faces_are_detected() {
    let follow_handles = || {
        names_follow_edits_by::<EditableHalfEdgeMesh>(|names, mesh, record, _| {
            names.follow(mesh, record, &FacesBefore::default());
        });
    };
    let payload = catch_unwind(follow_handles).expect_err("the law passes with the fault");
    let message = payload.downcast_ref::<String>().expect("a message");
    let words = "half-edge gives names to other elements than the model";
    assert!(message.contains(words), "{message}");
    assert!(message.contains("positions of f"), "{message}");
}

#[test]
fn missing_values_of_new_elements_are_detected() {
    assert_detected::<EditableHalfEdgeMesh, NewLeftOut>("in this map");
}
