//! A structure and the model, edited side by side.

use std::any::TypeId;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use mesh_core::{
    Changes, EdgeId, Edit, EditRecord, FaceId, Handle, MeshEdit, MeshQuery, Point, PolygonMesh,
    Refusal, Representation, VertexId,
};

use super::action::Action;
use super::model::{Model, Rules};
use super::relations::relations_hold;
use crate::caught::caught;
use crate::subject::held;
use crate::weld::place;

/// A mesh under edit, the model beside it, and what the structure calls the model's elements.
#[derive(Clone)]
pub struct Trial<M: MeshEdit> {
    /// The mesh.
    pub mesh: M,
    /// What it should be.
    pub model: Model,
    rules: Rules,
    vertices: BTreeMap<usize, M::Vertex>,
    faces: BTreeMap<usize, M::Face>,
    /// Rows of removed elements, which must never name anything again.
    removed: Vec<Removed<M::Vertex, M::Edge, M::Face>>,
}

#[derive(Clone, Copy)]
enum Removed<V, E, F> {
    Vertex(V),
    Edge(E),
    Face(F),
}

impl<M: Representation + MeshEdit + Debug> Trial<M> {
    /// Builds `M` from `polygons`; `None` where its capabilities exclude them.
    ///
    /// # Panics
    ///
    /// If the structure refuses what it declares to hold.
    pub fn of(polygons: &PolygonMesh) -> Option<Self> {
        M::CAPABILITIES.check(polygons).ok()?;
        let input = held::<M>(polygons);
        let mesh = M::from_polygons(&input);
        let mesh = mesh.unwrap_or_else(|e| panic!("{} refuses what it holds: {e}", M::NAME));
        let vertices = input
            .vertices()
            .map(|v| (v.index(), M::vertex_name(&input, v)));
        let faces = input
            .faces()
            .iter()
            .map(|(f, _)| (f.index(), M::face_name(&input, f)));
        Some(Self {
            model: Model::of(&input),
            rules: Rules::of::<M>(),
            vertices: vertices.collect(),
            faces: faces.collect(),
            removed: Vec::new(),
            mesh,
        })
    }

    /// Whether the model says that `action` is legal for this structure.
    pub fn is_legal(&self, action: &Action) -> bool {
        self.model.after(action, &self.rules).is_some()
    }

    /// Does `action` on the mesh and on the model; whether it was accepted.
    ///
    /// # Panics
    ///
    /// If the two depart from each other in anything: verdict, mesh, names, record, invariants.
    pub fn take(&mut self, action: &Action) -> bool {
        let name = M::NAME;
        let expected = self.model.after(action, &self.rules);
        let before = format!("{:?}", self.mesh);
        let names = Names::of(&self.mesh);
        let mut record = EditRecord::new();
        let outcome = self.perform(action, &mut record);
        let (after, made) = match (expected, outcome) {
            (Some(after), Ok(made)) => (after, made),
            (None, Err(_)) => {
                let unchanged = format!("{:?}", self.mesh) == before;
                assert!(
                    unchanged,
                    "{name}: refused {action:?}, but changed its tables"
                );
                let silent = record.vertices.is_empty()
                    && record.edges.is_empty()
                    && record.faces.is_empty();
                assert!(silent, "{name}: refused {action:?}, but told {record:?}");
                return false;
            }
            (Some(_), Err(refusal)) => {
                panic!("{name}: refuses {action:?}, which is legal: {refusal}")
            }
            (None, Ok(_)) => panic!("{name}: accepts {action:?}, which is not legal"),
        };
        if let Err(broken) = self.mesh.validate() {
            panic!("{name}: after {action:?} {broken}");
        }
        names.check(&record, &Names::of(&self.mesh), name, action);
        let before = std::mem::replace(&mut self.model, after);
        self.rename(&record, made, action);
        self.compare(action);
        let manifold = !self.rules.capabilities.non_manifold_edges;
        if let Some(step) = euler_step(action).filter(|_| manifold) {
            let moved = self.model.euler() - before.euler();
            assert_eq!(moved, step, "{name}: χ moves with {action:?}");
        }
        true
    }

    /// Whether both hold the same mesh: the same vertices in the same places, and the same faces.
    pub fn is_same_mesh(&self, other: &Self) -> bool {
        let [one, two] = [self, other].map(|trial| trial.mesh.to_polygons());
        faces_by_place(&one) == faces_by_place(&two) && places(&one) == places(&two)
    }

    /// Holds the whole mesh, with its holes, to what its faces say.
    ///
    /// # Panics
    ///
    /// If a relation is wrong, or a removed element still answers.
    pub fn inspect(&mut self) {
        relations_hold(&self.mesh, M::NAME);
        self.move_all();
        self.make_whole();
        for &removed in &self.removed {
            let (shown, asked, edited) = match removed {
                Removed::Vertex(v) => (
                    format!("{v:?}"),
                    caught(|| self.mesh.vertex_faces(v).count()),
                    self.mesh.clone().remove_vertex(v, &mut ()).is_ok(),
                ),
                Removed::Edge(e) => (
                    format!("{e:?}"),
                    caught(|| self.mesh.edge_faces(e).count()),
                    self.mesh.clone().flip_edge(e, &mut ()).is_ok(),
                ),
                Removed::Face(f) => (
                    format!("{f:?}"),
                    caught(|| self.mesh.face_vertices(f).count()),
                    self.mesh.clone().remove_face(f, &mut ()).is_ok(),
                ),
            };
            if self.is_used_again(removed) {
                continue;
            }
            let name = M::NAME;
            match asked {
                // What is not there has no neighbours, where its name is made of other things.
                Ok(0) if Self::is_made_of_others(removed) => {}
                Ok(found) => panic!("{name}: {shown} was removed, and has {found} neighbours"),
                Err(caught) => assert!(
                    caught.message.contains(&shown) || self.names_an_end(&caught.message, removed),
                    "{name}: {shown} was removed, and is not named: {}",
                    caught.message
                ),
            }
            assert!(!edited, "{name}: {shown} was removed, and is edited");
        }
    }

    /// Whether the name of a removed element is no row of its own: a pair, coordinates, a corner.
    fn is_made_of_others(removed: Removed<M::Vertex, M::Edge, M::Face>) -> bool {
        match removed {
            Removed::Vertex(_) => !M::CAPABILITIES.coincident_vertices,
            Removed::Edge(_) => TypeId::of::<M::Edge>() != TypeId::of::<EdgeId>(),
            Removed::Face(_) => false,
        }
    }

    /// Whether a message names an end of a removed edge that was the pair of its ends.
    fn names_an_end(&self, message: &str, removed: Removed<M::Vertex, M::Edge, M::Face>) -> bool {
        let Removed::Edge(e) = removed else {
            return false;
        };
        let ends = caught(|| self.mesh.edge_vertices(e));
        ends.is_ok_and(|ends| ends.iter().any(|end| message.contains(&format!("{end:?}"))))
    }

    /// Whether such a name has come to name another element.
    fn is_used_again(&self, removed: Removed<M::Vertex, M::Edge, M::Face>) -> bool {
        Self::is_made_of_others(removed)
            && match removed {
                Removed::Vertex(v) => self.mesh.vertices().any(|known| known == v),
                // A corner names the edge that it faces, if not by the name in use.
                Removed::Edge(e) => caught(|| self.mesh.edge_vertices(e)).is_ok_and(|[a, b]| {
                    caught(|| self.mesh.edge_between(a, b)).is_ok_and(|known| known.is_some())
                }),
                Removed::Face(_) => false,
            }
    }

    /// Without its holes it is the same mesh, and can be edited again.
    fn make_whole(&self) {
        let whole = self.mesh.clone().into_whole();
        assert_eq!(whole.face_rows(), whole.face_count(), "{}: holes", M::NAME);
        let mesh: M = whole.into();
        if let Err(broken) = mesh.validate() {
            panic!("{}: made whole and editable again {broken}", M::NAME);
        }
        let (made, known) = (mesh.to_polygons(), self.mesh.to_polygons());
        let same =
            made.positions() == known.positions() && made.faces().iter().eq(known.faces().iter());
        assert!(same, "{}: made whole it is another mesh", M::NAME);
    }

    /// All vertices moved at once come to their places, holes or not, and what was removed stays so.
    fn move_all(&self) {
        let mut mesh = self.mesh.clone();
        // Twice as far out: no two come to one place that were not at one.
        let mut places = mesh.vertex_map(Point::ZERO);
        for v in mesh.vertices() {
            places[v] = 2.0 * mesh.position(v);
        }
        if let Err(refusal) = mesh.set_positions(&places) {
            panic!("{}: its own vertices cannot be moved: {refusal}", M::NAME);
        }
        if let Err(broken) = mesh.validate() {
            panic!("{}: after all vertices moved {broken}", M::NAME);
        }
        let moved = self.mesh.to_polygons();
        let moved = moved.positions().iter().map(|&p| 2.0 * p);
        assert!(
            mesh.to_polygons().positions().iter().copied().eq(moved),
            "{}: places after all vertices moved",
            M::NAME
        );
        for removed in &self.removed {
            if let Removed::Vertex(v) = *removed {
                let answers = caught(|| mesh.position(v)).is_ok();
                let rows = M::CAPABILITIES.coincident_vertices;
                assert!(!(answers && rows), "{}: {v:?} is back", M::NAME);
            }
        }
    }

    fn vertex(&self, v: usize) -> M::Vertex {
        self.vertices[&v]
    }

    fn edge(&self, [a, b]: [usize; 2]) -> M::Edge {
        let [a, b] = [a, b].map(|v| self.vertex(v));
        let edge = self.mesh.edge_between(a, b);
        edge.unwrap_or_else(|| panic!("{}: no edge between {a:?} and {b:?}", M::NAME))
    }

    /// Does `action` on the mesh; the vertex that it made or moved.
    fn perform(
        &mut self,
        action: &Action,
        log: &mut EditRecord<M>,
    ) -> Result<Option<M::Vertex>, Refusal<M>> {
        match action {
            &Action::SetPosition { v, to } => {
                let v = self.vertex(v);
                return self.mesh.set_position(v, to, log).map(Some);
            }
            &Action::AddVertex { at } => return self.mesh.add_vertex(at, log).map(Some),
            Action::AddFace { corners } => {
                let corners: Vec<_> = corners.iter().map(|&v| self.vertex(v)).collect();
                self.mesh.add_face(&corners, log)?;
            }
            Action::RemoveFace { f } => self.mesh.remove_face(self.faces[f], log)?,
            &Action::RemoveVertex { v } => {
                let v = self.vertex(v);
                self.mesh.remove_vertex(v, log)?;
            }
            Action::RemoveIsolatedVertices => {
                let isolated = self.mesh.vertices();
                let isolated = isolated.filter(|&v| self.mesh.vertex_faces(v).next().is_none());
                let isolated = isolated.count();
                assert_eq!(
                    self.mesh.remove_isolated_vertices(log),
                    isolated,
                    "{}",
                    M::NAME
                );
            }
            &Action::SplitEdge { ends, at } => {
                let e = self.edge(ends);
                return self.mesh.split_edge(e, at, log).map(Some);
            }
            &Action::BisectEdge { ends, at } => {
                let e = self.edge(ends);
                return self.mesh.bisect_edge(e, at, log).map(Some);
            }
            &Action::PokeFace { f, at } => {
                return self.mesh.poke_face(self.faces[&f], at, log).map(Some);
            }
            &Action::SplitFace { f, ends } => {
                let ends = ends.map(|v| self.vertex(v));
                let e = self.mesh.split_face(self.faces[&f], ends, log)?;
                assert_eq!(
                    self.mesh.edge_between(ends[0], ends[1]),
                    Some(e),
                    "{}",
                    M::NAME
                );
            }
            &Action::DissolveEdge { ends } => {
                let e = self.edge(ends);
                let faces: Vec<_> = self.mesh.edge_faces(e).collect();
                let f = self.mesh.dissolve_edge(e, log)?;
                assert!(faces.contains(&f), "{}: {f:?} is no face of {e:?}", M::NAME);
            }
            &Action::FlipEdge { ends } => {
                let e = self.edge(ends);
                let e = self.mesh.flip_edge(e, log)?;
                let ends = self.mesh.edge_vertices(e);
                assert_eq!(
                    self.mesh.edge_between(ends[0], ends[1]),
                    Some(e),
                    "{}",
                    M::NAME
                );
            }
            &Action::CollapseEdge { ends, to } => {
                let (e, keep) = (self.edge(ends), self.vertex(ends[0]));
                return self.mesh.collapse_edge(e, keep, to, log).map(Some);
            }
            &Action::SplitVertex { v, left, right, at } => {
                let [left, right] = [left, right].map(|side| side.map(|v| self.vertex(v)));
                let v = self.vertex(v);
                return self.mesh.split_vertex(v, left, right, at, log).map(Some);
            }
            Action::Compact => self.mesh.compact(log),
        }
        Ok(None)
    }

    /// What the structure calls the model's elements after an edit.
    fn rename(&mut self, record: &EditRecord<M>, made: Option<M::Vertex>, action: &Action) {
        let moved: BTreeMap<M::Vertex, M::Vertex> = record
            .vertices
            .renamed
            .iter()
            .map(|&[old, new]| (old, new))
            .collect();
        let model = &self.model;
        let (gone, stay): (Vec<_>, Vec<_>) = std::mem::take(&mut self.vertices)
            .into_iter()
            .partition(|&(v, _)| model.position(v).is_none());
        for (_, name) in gone {
            self.removed.push(Removed::Vertex(name));
        }
        let edges = record.edges.removed.iter();
        self.removed.extend(edges.map(|&e| Removed::Edge(e)));
        self.vertices = stay
            .into_iter()
            .map(|(v, name)| (v, moved.get(&name).copied().unwrap_or(name)))
            .collect();
        if let Some(made) = made {
            // The newest vertex of the model, or the one that was moved.
            let v = match action {
                Action::SetPosition { v, .. } => *v,
                Action::CollapseEdge { ends, .. } => ends[0],
                _ => self.model.vertices().last().unwrap_or(0),
            };
            let known = self.vertices.insert(v, made);
            let name = M::NAME;
            assert!(
                known.is_none_or(|known| known == made),
                "{name}: {action:?} returned {made:?}"
            );
        }
        // Faces go by their corners: which part of a cut face keeps the name is the structure's choice.
        let mut by_corners: BTreeMap<Vec<M::Vertex>, Vec<M::Face>> = BTreeMap::new();
        let faces: BTreeSet<M::Face> = self.mesh.faces().collect();
        for &f in &faces {
            let corners = turned(self.mesh.face_vertices(f).collect());
            by_corners.entry(corners).or_default().push(f);
        }
        for (_, f) in std::mem::take(&mut self.faces) {
            if !faces.contains(&f) {
                self.removed.push(Removed::Face(f));
            }
        }
        for (f, face) in self.model.faces() {
            let corners = turned(face.iter().map(|v| self.vertices[v]).collect());
            let found = by_corners.get_mut(&corners).and_then(Vec::pop);
            let name = M::NAME;
            let found =
                found.unwrap_or_else(|| panic!("{name}: after {action:?} no face {corners:?}"));
            self.faces.insert(f, found);
        }
        if let Action::Compact = action {
            self.removed.clear();
        }
    }

    /// Mesh and model have the same vertices in the same places, and the same faces.
    fn compare(&self, action: &Action) {
        let name = M::NAME;
        let listed: BTreeSet<M::Vertex> = self.mesh.vertices().collect();
        let named: BTreeSet<M::Vertex> = self.vertices.values().copied().collect();
        assert_eq!(listed, named, "{name}: vertices after {action:?}");
        for (&v, &known) in &self.vertices {
            let at = self.model.position(v).map(place);
            assert_eq!(
                Some(place(self.mesh.position(known))),
                at,
                "{name}: where {known:?} is"
            );
        }
        assert_eq!(
            self.mesh.face_count(),
            self.faces.len(),
            "{name}: faces after {action:?}"
        );
        // Out as polygons: the same mesh, without the gaps.
        let (out, model) = (self.mesh.to_polygons(), self.model.to_polygons());
        assert_eq!(
            faces_by_place(&out),
            faces_by_place(&model),
            "{name}: out after {action:?}"
        );
        assert_eq!(
            places(&out),
            places(&model),
            "{name}: places out after {action:?}"
        );
    }
}

/// How far an edit moves χ on a manifold, where that does not depend on the mesh.
fn euler_step(action: &Action) -> Option<isize> {
    match action.edit() {
        Edit::AddVertex => Some(1),
        Edit::AddFace | Edit::RemoveFace | Edit::RemoveVertex | Edit::RemoveIsolatedVertices => {
            None
        }
        _ => Some(0),
    }
}

/// Of all starts of a face, the least list: its corners may be several times at one place.
fn turned<T: Ord>(mut corners: Vec<T>) -> Vec<T> {
    let from = |i: usize| corners[i..].iter().chain(&corners[..i]);
    let least = (0..corners.len()).min_by(|&i, &j| from(i).cmp(from(j)));
    corners.rotate_left(least.unwrap_or(0));
    corners
}

/// The places of all vertices, in order.
fn places(polygons: &PolygonMesh) -> Vec<[u32; 3]> {
    let mut places: Vec<_> = polygons.positions().iter().copied().map(place).collect();
    places.sort_unstable();
    places
}

/// The faces as the places of their corners, in order.
fn faces_by_place(polygons: &PolygonMesh) -> Vec<Vec<[u32; 3]>> {
    let at = |v: &VertexId| place(polygons.position(*v));
    let faces = polygons.faces().iter();
    let faces = faces.map(|(_, face): (FaceId, _)| turned(face.iter().map(at).collect()));
    let mut faces: Vec<_> = faces.collect();
    faces.sort_unstable();
    faces
}

/// All names in use.
struct Names<M: MeshEdit> {
    vertices: BTreeSet<M::Vertex>,
    edges: BTreeSet<M::Edge>,
    faces: BTreeSet<M::Face>,
}

impl<M: MeshEdit> Names<M> {
    fn of(mesh: &M) -> Self {
        Self {
            vertices: mesh.vertices().collect(),
            edges: mesh.edges().collect(),
            faces: mesh.faces().collect(),
        }
    }

    /// The record leads from these names to those `after`.
    fn check(&self, record: &EditRecord<M>, after: &Self, name: &str, action: &Action) {
        let told = |what: &str| format!("{name}: {what} after {action:?}, by {record:?}");
        follows(
            &self.vertices,
            &record.vertices,
            &after.vertices,
            &told("vertices"),
        );
        follows(&self.edges, &record.edges, &after.edges, &told("edges"));
        follows(&self.faces, &record.faces, &after.faces, &told("faces"));
    }
}

fn follows<H: Handle>(
    before: &BTreeSet<H>,
    changes: &Changes<H>,
    after: &BTreeSet<H>,
    context: &str,
) {
    let mut names = before.clone();
    for old in &changes.removed {
        assert!(
            names.remove(old),
            "{context}: {old:?} was not there to be removed"
        );
    }
    for [old, new] in &changes.renamed {
        assert!(
            names.remove(old),
            "{context}: {old:?} was not there to be renamed"
        );
        assert_ne!(old, new, "{context}: renamed to what it was called");
    }
    let new_names = changes.renamed.iter().map(|[_, new]| new);
    for new in new_names.chain(&changes.created) {
        assert!(names.insert(*new), "{context}: {new:?} names two elements");
    }
    assert_eq!(&names, after, "{context}");
}
