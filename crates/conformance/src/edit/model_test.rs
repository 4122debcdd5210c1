//! Applies the same edits to a structure and to the model, and compares them.

use std::any::TypeId;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use sixfold_core::{
    Changes, EdgeId, Edit, EditRecord, FaceId, Handle, MeshEdit, MeshQuery, Point, PolygonMesh,
    Refusal, Representation, VertexId,
};

use super::action::Action;
use super::apply::apply_action;
use super::model::{Model, Rules};
use super::relations::check_relations;
use crate::boundary::check_boundary;
use crate::catch_panic::catch_panic;
use crate::folds::check_folds;
use crate::law::check_numbers;
use crate::subject::stored_mesh;
use crate::weld::position_key;

/// A mesh under test, the model of this mesh, and maps from the elements of the model to the
/// handles of the structure.
#[derive(Clone)]
pub struct ModelTest<M: MeshEdit> {
    /// The mesh under test.
    pub mesh: M,
    /// The model: the expected mesh.
    pub model: Model,
    rules: Rules,
    vertices: BTreeMap<usize, M::Vertex>,
    faces: BTreeMap<usize, M::Face>,
    /// Handles of removed elements. They must not become valid again.
    removed: Vec<Removed<M::Vertex, M::Edge, M::Face>>,
}

#[derive(Clone, Copy)]
enum Removed<V, E, F> {
    Vertex(V),
    Edge(E),
    Face(F),
}

impl<M: Representation + MeshEdit + Debug> ModelTest<M> {
    /// Builds `M` from `polygons`. Returns `None` if the capabilities of `M` exclude this mesh.
    ///
    /// # Panics
    ///
    /// Panics if the structure returns an error for a mesh that its capabilities include.
    pub fn from_polygons(polygons: &PolygonMesh) -> Option<Self> {
        M::CAPABILITIES.check(polygons).ok()?;
        let input = stored_mesh::<M>(polygons);
        let mesh = M::from_polygons(&input);
        let mesh = mesh.unwrap_or_else(|e| panic!("{} refuses a supported mesh: {e}", M::NAME));
        let vertices = input
            .vertices()
            .map(|v| (v.index(), M::vertex_handle(&input, v)));
        let faces = input
            .faces()
            .iter()
            .map(|(f, _)| (f.index(), M::face_handle(&input, f)));
        Some(Self {
            model: Model::from_polygons(&input),
            rules: Rules::new::<M>(),
            vertices: vertices.collect(),
            faces: faces.collect(),
            removed: Vec::new(),
            mesh,
        })
    }

    /// Returns true if `action` is legal for this structure, according to the model.
    pub fn is_legal(&self, action: &Action) -> bool {
        self.model.after(action, &self.rules).is_some()
    }

    /// Applies `action` to the mesh and to the model, and returns true if the action was accepted.
    ///
    /// # Panics
    ///
    /// Panics in these cases: only one of the mesh and the model accepts the action; after the
    /// action, the faces, the positions, the handles or the recorded changes differ from the model;
    /// the action broke an invariant of the mesh; a refused action changed the mesh.
    pub fn apply(&mut self, action: &Action) -> bool {
        let name = M::NAME;
        let expected = self.model.after(action, &self.rules);
        let before = format!("{:?}", self.mesh);
        let handles = Handles::new(&self.mesh);
        let mut record = EditRecord::new();
        let Self {
            mesh,
            vertices,
            faces,
            ..
        } = self;
        let outcome = apply_action(mesh, name, vertices, faces, action, &mut record);
        let (after, made) = match (expected, outcome) {
            (Some(after), Ok(made)) => (after, made),
            (None, Err(_)) => {
                let unchanged = format!("{:?}", self.mesh) == before;
                assert!(
                    unchanged,
                    "{name}: refused {action:?} but changed its tables"
                );
                assert!(
                    record.is_empty(),
                    "{name}: refused {action:?} but recorded {record:?}"
                );
                return false;
            }
            (Some(_), Err(refusal)) => {
                panic!("{name}: refuses the legal {action:?}: {refusal}")
            }
            (None, Ok(_)) => panic!("{name}: accepts the illegal {action:?}"),
        };
        if let Err(broken) = self.mesh.validate() {
            panic!("{name}: after {action:?}: {broken}");
        }
        handles.check(&record, &Handles::new(&self.mesh), name, action);
        let before = std::mem::replace(&mut self.model, after);
        self.update_handles(&record, made, action);
        self.compare(action);
        let manifold = !self.rules.capabilities.non_manifold_edges;
        if let Some(step) = euler_step(action).filter(|_| manifold) {
            let change = self.model.euler_characteristic() - before.euler_characteristic();
            assert_eq!(change, step, "{name}: change of χ by {action:?}");
        }
        true
    }

    /// Applies `action` to `mesh`, and reports the changes to `log`. `mesh` must have the same
    /// handles as the mesh under test. Returns the vertex that the action made or moved.
    ///
    /// # Errors
    ///
    /// Returns the error of an action that `mesh` refuses.
    ///
    /// # Panics
    ///
    /// Panics if the result of the edit is not an element of `mesh`.
    pub fn apply_to<N>(
        &self,
        mesh: &mut N,
        action: &Action,
        log: &mut EditRecord<N>,
    ) -> Result<Option<N::Vertex>, Refusal<N>>
    where
        N: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
    {
        apply_action(mesh, M::NAME, &self.vertices, &self.faces, action, log)
    }

    /// Returns the handle of vertex `v` of the model.
    ///
    /// # Panics
    ///
    /// Panics if the model has no vertex `v`.
    pub fn vertex(&self, v: usize) -> M::Vertex {
        self.vertices[&v]
    }

    /// Returns the handle of face `f` of the model.
    ///
    /// # Panics
    ///
    /// Panics if the model has no face `f`.
    pub fn face(&self, f: usize) -> M::Face {
        self.faces[&f]
    }

    /// Returns true if the meshes of `self` and `other` have equal positions and equal faces.
    pub fn is_same_mesh(&self, other: &Self) -> bool {
        let [first, second] = [self, other].map(|test| test.mesh.to_polygons());
        sorted_faces(&first) == sorted_faces(&second)
            && sorted_positions(&first) == sorted_positions(&second)
    }

    /// Checks the answers of all queries of the mesh. Also checks that handles of removed elements
    /// are invalid.
    ///
    /// # Panics
    ///
    /// Panics if a relation is wrong, or if the handle of a removed element is accepted.
    pub fn check_all(&mut self) {
        check_relations(&self.mesh, M::NAME);
        check_boundary(&self.mesh, M::NAME);
        check_folds(&self.mesh, M::NAME);
        check_numbers(&self.mesh, M::NAME);
        self.check_set_positions();
        self.check_into_compact();
        let mesh = &self.mesh;
        let contained = mesh.vertices().all(|v| mesh.contains_vertex(v))
            && mesh.edges().all(|e| mesh.contains_edge(e))
            && mesh.faces().all(|f| mesh.contains_face(f));
        assert!(
            contained,
            "{}: a contains_… method returns false for an element of the mesh",
            M::NAME
        );
        for &removed in &self.removed {
            let (shown, answer, was_edited) = match removed {
                Removed::Vertex(v) => (
                    format!("{v:?}"),
                    catch_panic(|| self.mesh.vertex_faces(v).count()),
                    self.mesh.clone().remove_vertex(v).is_ok(),
                ),
                Removed::Edge(e) => (
                    format!("{e:?}"),
                    catch_panic(|| self.mesh.edge_faces(e).count()),
                    self.mesh.clone().flip_edge(e).is_ok(),
                ),
                Removed::Face(f) => (
                    format!("{f:?}"),
                    catch_panic(|| self.mesh.face_vertices(f).count()),
                    self.mesh.clone().remove_face(f).is_ok(),
                ),
            };
            if self.is_reused(removed) {
                continue;
            }
            let name = M::NAME;
            let contained = catch_panic(|| match removed {
                Removed::Vertex(v) => self.mesh.contains_vertex(v),
                Removed::Edge(e) => self.mesh.contains_edge(e),
                Removed::Face(f) => self.mesh.contains_face(f),
            });
            assert!(
                contained.is_ok_and(|contained| !contained),
                "{name}: {shown} was removed, but contains_… does not return false"
            );
            match answer {
                // If the handle is not a row, a removed element has empty relations.
                Ok(0) if Self::has_derived_handle(removed) => {}
                Ok(found) => panic!("{name}: {shown} was removed but has {found} faces or corners"),
                Err(panic) => assert!(
                    panic.message.contains(&shown) || self.mentions_end(&panic.message, removed),
                    "{name}: {shown} was removed, but the panic message does not name it: {}",
                    panic.message
                ),
            }
            assert!(!was_edited, "{name}: {shown} was removed but can be edited");
        }
    }

    /// Returns whether the handle of a removed element is a pair, coordinates or a corner.
    fn has_derived_handle(removed: Removed<M::Vertex, M::Edge, M::Face>) -> bool {
        match removed {
            Removed::Vertex(_) => !M::CAPABILITIES.coincident_vertices,
            Removed::Edge(_) => TypeId::of::<M::Edge>() != TypeId::of::<EdgeId>(),
            Removed::Face(_) => false,
        }
    }

    fn mentions_end(&self, message: &str, removed: Removed<M::Vertex, M::Edge, M::Face>) -> bool {
        let Removed::Edge(e) = removed else {
            return false;
        };
        let ends = catch_panic(|| self.mesh.edge_vertices(e));
        ends.is_ok_and(|ends| ends.iter().any(|end| message.contains(&format!("{end:?}"))))
    }

    /// Returns whether another element now has the handle of a removed element.
    fn is_reused(&self, removed: Removed<M::Vertex, M::Edge, M::Face>) -> bool {
        Self::has_derived_handle(removed)
            && match removed {
                Removed::Vertex(v) => self.mesh.vertices().any(|known| known == v),
                // In a corner table, an edge has two opposite corners. Queries accept both as its
                // handle.
                Removed::Edge(e) => {
                    catch_panic(|| self.mesh.edge_vertices(e)).is_ok_and(|[a, b]| {
                        catch_panic(|| self.mesh.edge_between(a, b))
                            .is_ok_and(|known| known.is_some())
                    })
                }
                Removed::Face(_) => false,
            }
    }

    fn check_into_compact(&self) {
        let compact = self.mesh.clone().into_compact();
        assert_eq!(
            compact.face_rows(),
            compact.face_count(),
            "{}: face rows (left) and faces (right) after into_compact",
            M::NAME
        );
        let mesh = M::from_compact(compact);
        if let Err(broken) = mesh.validate() {
            panic!("{}: after into_compact and from_compact: {broken}", M::NAME);
        }
        let (got, expected) = (mesh.to_polygons(), self.mesh.to_polygons());
        let same = got.positions() == expected.positions()
            && got.faces().iter().eq(expected.faces().iter());
        assert!(same, "{}: into_compact changes the mesh", M::NAME);
    }

    fn check_set_positions(&self) {
        let mut mesh = self.mesh.clone();
        let mut positions = mesh.vertex_map(Point::ZERO);
        for v in mesh.vertices() {
            positions[v] = 2.0 * mesh.position(v);
        }
        if let Err(refusal) = mesh.set_positions(&positions) {
            panic!("{}: set_positions fails: {refusal}", M::NAME);
        }
        if let Err(broken) = mesh.validate() {
            panic!("{}: after all vertices moved: {broken}", M::NAME);
        }
        let moved = self.mesh.to_polygons();
        let moved = moved.positions().iter().map(|&p| 2.0 * p);
        assert!(
            mesh.to_polygons().positions().iter().copied().eq(moved),
            "{}: positions after all vertices moved",
            M::NAME
        );
        for removed in &self.removed {
            if let Removed::Vertex(v) = *removed {
                let answers = catch_panic(|| mesh.position(v)).is_ok();
                let rows = M::CAPABILITIES.coincident_vertices;
                assert!(
                    !(answers && rows),
                    "{}: removed {v:?} has a position",
                    M::NAME
                );
            }
        }
    }

    fn update_handles(&mut self, record: &EditRecord<M>, made: Option<M::Vertex>, action: &Action) {
        let renamed: BTreeMap<M::Vertex, M::Vertex> = record
            .vertices
            .renamed
            .iter()
            .map(|&[old, new]| (old, new))
            .collect();
        let model = &self.model;
        let (removed, kept): (Vec<_>, Vec<_>) = std::mem::take(&mut self.vertices)
            .into_iter()
            .partition(|&(v, _)| model.position(v).is_none());
        for (_, handle) in removed {
            self.removed.push(Removed::Vertex(handle));
        }
        let edges = record.edges.removed.iter();
        self.removed.extend(edges.map(|&e| Removed::Edge(e)));
        self.vertices = kept
            .into_iter()
            .map(|(v, handle)| (v, renamed.get(&handle).copied().unwrap_or(handle)))
            .collect();
        if let Some(made) = made {
            let v = match action {
                Action::SetPosition { v, .. } => *v,
                Action::CollapseEdge { keep, .. } => *keep,
                _ => self.model.vertices().last().unwrap_or(0),
            };
            let known = self.vertices.insert(v, made);
            let name = M::NAME;
            assert!(
                known.is_none_or(|known| known == made),
                "{name}: {action:?} returned {made:?}"
            );
        }
        // A structure may choose which part of a split face keeps the handle.
        let mut by_corners: BTreeMap<Vec<M::Vertex>, Vec<M::Face>> = BTreeMap::new();
        let faces: BTreeSet<M::Face> = self.mesh.faces().collect();
        for &f in &faces {
            let corners = canonical_rotation(self.mesh.face_vertices(f).collect());
            by_corners.entry(corners).or_default().push(f);
        }
        for (_, f) in std::mem::take(&mut self.faces) {
            if !faces.contains(&f) {
                self.removed.push(Removed::Face(f));
            }
        }
        for (f, face) in self.model.faces() {
            let corners = canonical_rotation(face.iter().map(|v| self.vertices[v]).collect());
            let found = by_corners.get_mut(&corners).and_then(Vec::pop);
            let name = M::NAME;
            let found =
                found.unwrap_or_else(|| panic!("{name}: no face {corners:?} after {action:?}"));
            self.faces.insert(f, found);
        }
        if action.edit() == Edit::Compact {
            self.removed.clear();
        }
    }

    fn compare(&self, action: &Action) {
        let name = M::NAME;
        let listed: BTreeSet<M::Vertex> = self.mesh.vertices().collect();
        let named: BTreeSet<M::Vertex> = self.vertices.values().copied().collect();
        assert_eq!(listed, named, "{name}: vertices after {action:?}");
        for (&v, &known) in &self.vertices {
            let expected = self.model.position(v).map(position_key);
            assert_eq!(
                Some(position_key(self.mesh.position(known))),
                expected,
                "{name}: position of {known:?}"
            );
        }
        assert_eq!(
            self.mesh.face_count(),
            self.faces.len(),
            "{name}: faces after {action:?}"
        );
        let (out, model) = (self.mesh.to_polygons(), self.model.to_polygons());
        assert_eq!(
            sorted_faces(&out),
            sorted_faces(&model),
            "{name}: faces of to_polygons after {action:?}"
        );
        assert_eq!(
            sorted_positions(&out),
            sorted_positions(&model),
            "{name}: positions of to_polygons after {action:?}"
        );
    }
}

/// Returns the change of χ by an edit on a manifold; `None` if the change depends on the mesh.
fn euler_step(action: &Action) -> Option<isize> {
    match action.edit() {
        Edit::AddVertex => Some(1),
        Edit::AddFace
        | Edit::RemoveFace
        | Edit::RemoveFaces
        | Edit::RemoveVertex
        | Edit::RemoveIsolatedVertices => None,
        _ => Some(0),
    }
}

/// Returns the lexicographically least rotation of a face.
pub(crate) fn canonical_rotation<T: Ord>(mut corners: Vec<T>) -> Vec<T> {
    let from = |i: usize| corners[i..].iter().chain(&corners[..i]);
    let least = (0..corners.len()).min_by(|&i, &j| from(i).cmp(from(j)));
    corners.rotate_left(least.unwrap_or(0));
    corners
}

fn sorted_positions(polygons: &PolygonMesh) -> Vec<[u32; 3]> {
    let mut keys: Vec<_> = polygons
        .positions()
        .iter()
        .copied()
        .map(position_key)
        .collect();
    keys.sort_unstable();
    keys
}

fn sorted_faces(polygons: &PolygonMesh) -> Vec<Vec<[u32; 3]>> {
    let key = |v: &VertexId| position_key(polygons.position(*v));
    let faces = polygons.faces().iter();
    let faces =
        faces.map(|(_, face): (FaceId, _)| canonical_rotation(face.iter().map(key).collect()));
    let mut faces: Vec<_> = faces.collect();
    faces.sort_unstable();
    faces
}

struct Handles<M: MeshEdit> {
    vertices: BTreeSet<M::Vertex>,
    edges: BTreeSet<M::Edge>,
    faces: BTreeSet<M::Face>,
}

impl<M: MeshEdit> Handles<M> {
    fn new(mesh: &M) -> Self {
        Self {
            vertices: mesh.vertices().collect(),
            edges: mesh.edges().collect(),
            faces: mesh.faces().collect(),
        }
    }

    fn check(&self, record: &EditRecord<M>, after: &Self, name: &str, action: &Action) {
        let context =
            |what: &str| format!("{name}: {what} after {action:?}, with record {record:?}");
        check_changes(
            &self.vertices,
            &record.vertices,
            &after.vertices,
            &context("vertices"),
        );
        check_changes(&self.edges, &record.edges, &after.edges, &context("edges"));
        check_changes(&self.faces, &record.faces, &after.faces, &context("faces"));
    }
}

fn check_changes<H: Handle>(
    before: &BTreeSet<H>,
    changes: &Changes<H>,
    after: &BTreeSet<H>,
    context: &str,
) {
    let mut handles = before.clone();
    for old in &changes.removed {
        assert!(
            handles.remove(old),
            "{context}: removes {old:?}, which does not exist"
        );
    }
    for [old, new] in &changes.renamed {
        assert!(
            handles.remove(old),
            "{context}: renames {old:?}, which does not exist"
        );
        assert_ne!(old, new, "{context}: renamed to the same handle");
    }
    let new_handles = changes.renamed.iter().map(|[_, new]| new);
    for new in new_handles.chain(&changes.created) {
        assert!(
            handles.insert(*new),
            "{context}: {new:?} is the handle of two elements"
        );
    }
    assert_eq!(&handles, after, "{context}");
}
