//! The law that data of elements is updated after each edit.

use std::collections::BTreeMap;
use std::fmt::Debug;

use sixfold_core::{
    Changes, EdgeData, EdgeMap, EditRecord, FaceData, FaceMap, FollowEdits, Handle, MeshEdit,
    MeshQuery, MeshWithData, PolygonMesh, Representation, VertexData, VertexMap,
};

use super::scripts::{Executed, on_random_scripts};
use crate::edit::{Action, ModelTest, Step};

/// Data with a number for every vertex, edge and face. New elements get the number 0.
pub trait ElementNumbers<M: MeshQuery>: FollowEdits<M> {
    /// Returns data with the number 0 for all elements of `mesh`.
    fn new(mesh: &M) -> Self;
    /// Returns the number of a vertex, for writing.
    fn vertex(&mut self, v: M::Vertex) -> &mut u32;
    /// Returns the number of an edge, for writing.
    fn edge(&mut self, e: M::Edge) -> &mut u32;
    /// Returns the number of a face, for writing.
    fn face(&mut self, f: M::Face) -> &mut u32;
}

impl<M: MeshQuery> ElementNumbers<M> for Numbers<M, u32> {
    fn new(mesh: &M) -> Self {
        let vertices = VertexData::new(mesh, 0);
        (vertices, EdgeData::new(mesh, 0), FaceData::new(mesh, 0))
    }
    fn vertex(&mut self, v: M::Vertex) -> &mut u32 {
        &mut self.0[v]
    }
    fn edge(&mut self, e: M::Edge) -> &mut u32 {
        &mut self.1[e]
    }
    fn face(&mut self, f: M::Face) -> &mut u32 {
        &mut self.2[f]
    }
}

/// The mesh under test. Every element has a number and a list; the rule for new elements joins the
/// lists of the parents.
type Subject<M, D> = MeshWithData<M, (D, Numbers<M, Vec<u32>>)>;

type Numbers<M, T> = (VertexData<M, T>, EdgeData<M, T>, FaceData<M, T>);

/// Data in a [`MeshWithData`] is updated correctly during random sequences of edits. After every
/// edit, the data equals data that was updated by brute force from the reported changes. The rules
/// for new elements receive the correct parents. At the end of each sequence, `into_compact` and
/// `from_compact` keep the data.
///
/// The environment variable `PROPTEST_CASES` sets the number of random edit sequences.
pub fn data_follows_edits<M: Representation + MeshEdit + Debug>() {
    numbers_follow_edits::<M, Numbers<M, u32>>();
}

/// Runs the law [`data_follows_edits`] with data of type `D`.
pub fn numbers_follow_edits<M, D>()
where
    M: Representation + MeshEdit + Debug,
    D: ElementNumbers<M>,
{
    on_random_scripts::<M>("does not update the data", run_script::<M, D>);
}

fn run_script<M, D>(start: &PolygonMesh, steps: &[Step], executed: &Executed)
where
    M: Representation + MeshEdit + Debug,
    D: ElementNumbers<M>,
{
    let Some(mut test) = ModelTest::<M>::from_polygons(start) else {
        return;
    };
    let mut data_test = DataTest::<M, D>::new(&test.mesh);
    for (number, step) in steps.iter().enumerate() {
        let Some(action) = step.action(&test.model, number) else {
            continue;
        };
        executed.borrow_mut().push((action.clone(), false));
        let accepted = data_test.apply(&test, &action);
        if let Some(last) = executed.borrow_mut().last_mut() {
            last.1 = accepted;
        }
        assert_eq!(
            accepted,
            test.apply(&action),
            "{}: with data (left) and without data (right)",
            M::NAME
        );
    }
    data_test.check_conversion();
}

/// A mesh with data, and the expected numbers of its elements.
struct DataTest<M: MeshEdit, D> {
    mesh: Subject<M, D>,
    vertices: BTreeMap<M::Vertex, u32>,
    edges: BTreeMap<M::Edge, u32>,
    faces: BTreeMap<M::Face, u32>,
    numbers_used: u32,
}

impl<M: Representation + MeshEdit + Debug, D: ElementNumbers<M>> DataTest<M, D> {
    fn new(mesh: &M) -> Self {
        let (vertices, edges, faces) = (
            VertexData::new(mesh, vec![]),
            EdgeData::new(mesh, vec![]),
            FaceData::new(mesh, vec![]),
        );
        let ancestors = (
            vertices.with_rule(|numbers: &VertexMap<M, Vec<u32>>, new| {
                let numbers = new.parents.iter().map(|&v| numbers[v].as_slice());
                numbers.collect::<Vec<_>>().concat()
            }),
            edges.with_rule(|numbers: &EdgeMap<M, Vec<u32>>, new| {
                let numbers = new.parents.iter().map(|&e| numbers[e].as_slice());
                numbers.collect::<Vec<_>>().concat()
            }),
            faces.with_rule(|numbers: &FaceMap<M, Vec<u32>>, new| {
                let numbers = new.parents.iter().map(|&f| numbers[f].as_slice());
                numbers.collect::<Vec<_>>().concat()
            }),
        );
        let mut test = Self {
            mesh: MeshWithData::new(mesh.clone(), (D::new(mesh), ancestors)),
            vertices: BTreeMap::new(),
            edges: BTreeMap::new(),
            faces: BTreeMap::new(),
            numbers_used: 0,
        };
        test.number(
            &mesh.vertices().collect::<Vec<_>>(),
            &mesh.edges().collect::<Vec<_>>(),
            &mesh.faces().collect::<Vec<_>>(),
        );
        test
    }

    fn number(&mut self, vertices: &[M::Vertex], edges: &[M::Edge], faces: &[M::Face]) {
        let (numbers, ancestors) = self.mesh.data_mut();
        let mut next = self.numbers_used;
        let mut new_number = || {
            next += 1;
            next
        };
        for &v in vertices {
            let number = new_number();
            *numbers.vertex(v) = number;
            ancestors.0[v] = vec![number];
            self.vertices.insert(v, number);
        }
        for &e in edges {
            let number = new_number();
            *numbers.edge(e) = number;
            ancestors.1[e] = vec![number];
            self.edges.insert(e, number);
        }
        for &f in faces {
            let number = new_number();
            *numbers.face(f) = number;
            ancestors.2[f] = vec![number];
            self.faces.insert(f, number);
        }
        self.numbers_used = next;
    }

    /// Applies `action` with the handles of `test`, checks all numbers, and numbers the new
    /// elements. Returns whether the action was accepted.
    fn apply(&mut self, test: &ModelTest<M>, action: &Action) -> bool {
        let parents = self.parents(test, action);
        let mut record = EditRecord::new();
        let accepted = test.apply_to(&mut self.mesh, action, &mut record).is_ok();
        replay(&mut self.vertices, &record.vertices);
        replay(&mut self.edges, &record.edges);
        replay(&mut self.faces, &record.faces);
        self.check_numbers();
        self.check_parents(&parents, &record);
        self.number(
            &record.vertices.created,
            &record.edges.created,
            &record.faces.created,
        );
        accepted
    }

    fn check_numbers(&mut self) {
        let name = M::NAME;
        let elements = [
            self.mesh.vertex_count(),
            self.mesh.edge_count(),
            self.mesh.face_count(),
        ];
        let expected = [self.vertices.len(), self.edges.len(), self.faces.len()];
        assert_eq!(elements, expected, "{name}: elements (left) and reported");
        let (numbers, _) = self.mesh.data_mut();
        for (&v, expected) in &self.vertices {
            assert_eq!(numbers.vertex(v), expected, "{name}: number of {v:?}");
        }
        for (&e, expected) in &self.edges {
            assert_eq!(numbers.edge(e), expected, "{name}: number of {e:?}");
        }
        for (&f, expected) in &self.faces {
            assert_eq!(numbers.face(f), expected, "{name}: number of {f:?}");
        }
    }

    /// Returns the elements that `action` would split. Call this before the action is applied.
    fn parents(&self, test: &ModelTest<M>, action: &Action) -> Parents<M> {
        let mut parents = Parents {
            vertices: vec![],
            halved: None,
            cut: vec![],
        };
        let vertex = |v: &usize| self.vertices[&test.vertex(*v)];
        let cut = |f: usize| {
            let corners = test.model.face(f).into_iter().flatten();
            let corners = corners.map(|&v| test.vertex(v));
            (self.faces[&test.face(f)], corners.collect())
        };
        match action {
            Action::SplitEdge { e: ends, .. } | Action::BisectEdge { e: ends, .. } => {
                parents.vertices = ends.iter().map(vertex).collect();
                let handles = ends.map(|v| test.vertex(v));
                let e = self.mesh.edge_between(handles[0], handles[1]);
                parents.halved = e.map(|e| (handles, self.edges[&e]));
                let faces = test.model.faces();
                let along = faces.filter(|(_, face)| ends.iter().all(|end| face.contains(end)));
                parents.cut = along.map(|(f, _)| cut(f)).collect();
            }
            Action::PokeFace { f, .. } | Action::SplitFace { f, .. } => {
                let corners = test.model.face(*f).into_iter().flatten();
                parents.vertices = corners.map(vertex).collect();
                parents.cut = vec![cut(*f)];
            }
            Action::SplitVertex { v, .. } => parents.vertices = vec![vertex(v)],
            _ => {}
        }
        parents.vertices.sort_unstable();
        parents
    }

    fn check_parents(&self, expected: &Parents<M>, record: &EditRecord<Subject<M, D>>) {
        let (_, (vertices, edges, faces)) = self.mesh.data();
        let name = M::NAME;
        for &v in &record.vertices.created {
            let mut parents = vertices[v].clone();
            parents.sort_unstable();
            assert_eq!(parents, expected.vertices, "{name}: parents of {v:?}");
        }
        let is_new = |v: &M::Vertex| record.vertices.created.contains(v);
        for &e in &record.edges.created {
            let ends = self.mesh.edge_vertices(e);
            let halved = expected.halved.filter(|(halved, _)| {
                ends.iter().any(is_new) && ends.iter().any(|end| halved.contains(end))
            });
            let parents: Vec<u32> = halved.into_iter().map(|(_, number)| number).collect();
            assert_eq!(edges[e], parents, "{name}: parents of {e:?}");
        }
        for &f in &record.faces.created {
            let corners = self.mesh.face_vertices(f);
            let old: Vec<M::Vertex> = corners.filter(|v| !is_new(v)).collect();
            let cut = expected.cut.iter();
            let parents = cut.filter(|(_, corners)| old.iter().all(|v| corners.contains(v)));
            let parents: Vec<u32> = parents.map(|&(number, _)| number).collect();
            let is_parent = match faces[f][..] {
                [] => parents.is_empty(),
                [parent] => parents.contains(&parent),
                _ => false,
            };
            let found = &faces[f];
            assert!(
                is_parent,
                "{name}: parents {found:?} of {f:?}, expected one of {parents:?}"
            );
        }
    }

    fn check_conversion(self) {
        let before = sorted_numbers(&self.mesh);
        let compact = self.mesh.into_compact();
        let name = M::NAME;
        let after = sorted_numbers(&compact);
        assert_eq!(after, before, "{name}: numbers after into_compact");
        let mesh = Subject::<M, D>::from_compact(compact);
        let after = sorted_numbers(&mesh);
        assert_eq!(after, before, "{name}: numbers after from_compact");
    }
}

/// The numbers of the parents of the elements that an action would make.
struct Parents<M: MeshQuery> {
    /// The parents of a new vertex, sorted.
    vertices: Vec<u32>,
    /// The ends and the number of the edge that is split in two.
    halved: Option<([M::Vertex; 2], u32)>,
    /// The numbers and the corners of the faces that are cut.
    cut: Vec<(u32, Vec<M::Vertex>)>,
}

/// Updates the numbers by the reported changes of an edit.
fn replay<H: Handle>(numbers: &mut BTreeMap<H, u32>, changes: &Changes<H>) {
    for (old, number) in std::mem::take(numbers) {
        if changes.removed.contains(&old) {
            continue;
        }
        let mut renamed = changes.renamed.iter();
        let new = renamed.find(|[from, _]| *from == old);
        numbers.insert(new.map_or(old, |&[_, to]| to), number);
    }
    numbers.extend(changes.created.iter().map(|&new| (new, 0)));
}

/// Returns a sorted list with one entry for each element: the number of a vertex, the numbers of an
/// edge and its ends, or the numbers of a face and its corners.
fn sorted_numbers<N, M, D>(mesh: &MeshWithData<N, (D, Numbers<M, Vec<u32>>)>) -> Vec<Vec<u32>>
where
    M: MeshQuery,
    N: MeshQuery<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
{
    let (_, (vertices, edges, faces)) = mesh.data();
    let with_corners = |own: &[u32], corners: &[M::Vertex]| {
        let mut numbers: Vec<u32> = corners.iter().map(|&v| vertices[v][0]).collect();
        numbers.sort_unstable();
        [own, &numbers].concat()
    };
    let of_vertices = mesh.vertices().map(|v| vertices[v].clone());
    let of_edges = mesh
        .edges()
        .map(|e| with_corners(&edges[e], &mesh.edge_vertices(e)));
    let of_faces = mesh.faces().map(|f| {
        let corners: Vec<M::Vertex> = mesh.face_vertices(f).collect();
        with_corners(&faces[f], &corners)
    });
    let mut numbers: Vec<Vec<u32>> = of_vertices.chain(of_edges).chain(of_faces).collect();
    numbers.sort_unstable();
    numbers
}
