//! A mesh as plain lists, with a brute-force implementation of every edit.

mod edits;

use std::collections::{BTreeMap, BTreeSet};

use sixfold_core::{Capabilities, Edit, MeshEdit, Point, PolygonMesh, Representation};

use super::action::{Action, position};
use crate::weld::position_key;

/// The meshes that a structure can hold, and the edits that it supports.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// The meshes that the structure can hold.
    pub capabilities: Capabilities,
    /// For each edit in the order of [`Edit::ALL`]: true if the structure supports the edit.
    pub supported: [bool; Edit::ALL.len()],
}

impl Rules {
    /// Returns the rules of `M`.
    pub fn new<M: Representation + MeshEdit>() -> Self {
        Self {
            capabilities: M::CAPABILITIES,
            supported: M::EDITS.map(|cost| cost.is_some()),
        }
    }
}

/// A mesh as a list of positions and a list of faces. The numbers of removed elements are not
/// reused.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    positions: Vec<Option<Point>>,
    faces: Vec<Option<Vec<usize>>>,
}

impl Model {
    /// Builds the model of `polygons`.
    pub fn from_polygons(polygons: &PolygonMesh) -> Self {
        let faces = polygons.faces().iter();
        let faces = faces.map(|(_, face)| Some(face.iter().map(|v| v.index()).collect()));
        Self {
            positions: polygons.positions().iter().copied().map(Some).collect(),
            faces: faces.collect(),
        }
    }

    /// Iterates over the existing vertices.
    pub fn vertices(&self) -> impl Iterator<Item = usize> {
        (0..self.positions.len()).filter(|&v| self.positions[v].is_some())
    }

    /// Iterates over the existing faces, with their corners.
    pub fn faces(&self) -> impl Iterator<Item = (usize, &[usize])> {
        let faces = self.faces.iter().enumerate();
        faces.filter_map(|(f, face)| Some((f, face.as_deref()?)))
    }

    /// Returns the corners of face `f`, or `None` if the face does not exist.
    pub fn face(&self, f: usize) -> Option<&[usize]> {
        self.faces.get(f)?.as_deref()
    }

    /// Returns the position of vertex `v`, or `None` if the vertex does not exist.
    pub fn position(&self, v: usize) -> Option<Point> {
        *self.positions.get(v)?
    }

    /// Returns each edge with its faces. The flag of a face is true if the face runs along the edge
    /// from the end with the lower number to the other end.
    pub fn edges(&self) -> BTreeMap<[usize; 2], Vec<(usize, bool)>> {
        let mut edges: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for (f, face) in self.faces() {
            for (a, b) in sides(face) {
                edges
                    .entry([a.min(b), a.max(b)])
                    .or_default()
                    .push((f, a < b));
            }
        }
        edges
    }

    /// Returns the vertices that are joined to `v` by an edge.
    pub fn neighbours(&self, v: usize) -> BTreeSet<usize> {
        let faces = self.faces().filter(|(_, face)| face.contains(&v));
        let sides = faces.flat_map(|(_, face)| sides(face).collect::<Vec<_>>());
        let ends = sides.filter(|&(a, b)| a == v || b == v);
        ends.map(|(a, b)| if a == v { b } else { a }).collect()
    }

    /// Returns χ = V − E + F.
    pub fn euler_characteristic(&self) -> isize {
        let count = |n: usize| n as isize;
        count(self.vertices().count()) - count(self.edges().len()) + count(self.faces().count())
    }

    /// Converts the model to polygons. The remaining vertices are renumbered from 0, in their
    /// order.
    ///
    /// # Panics
    ///
    /// Panics if a face has a removed vertex.
    pub fn to_polygons(&self) -> PolygonMesh {
        let number: BTreeMap<usize, u32> = self.vertices().zip(0..).collect();
        let positions: Vec<Point> = self.positions.iter().copied().flatten().collect();
        let faces = self.faces().map(|(_, face)| {
            let corners = face.iter().map(|v| number[v]);
            corners.collect::<Vec<u32>>()
        });
        PolygonMesh::new(positions, faces)
            .expect("faces of the model use existing, distinct vertices")
    }

    /// Returns the model after `action`, or `None` if the action is not legal under `rules`.
    pub fn after(&self, action: &Action, rules: &Rules) -> Option<Self> {
        if !rules.supported[action.edit() as usize] {
            return None;
        }
        if !rules.capabilities.coincident_vertices && self.is_occupied(action) {
            return None;
        }
        let mut after = self.clone();
        after.apply(action, rules)?;
        if !rules.capabilities.isolated_vertices {
            after.remove_isolated();
        }
        rules.capabilities.check(&after.to_polygons()).ok()?;
        Some(after)
    }

    fn is_occupied(&self, action: &Action) -> bool {
        let own = match action {
            Action::SetPosition { v, .. } => [*v; 2],
            Action::CollapseEdge { e, .. } => *e,
            _ => [usize::MAX; 2],
        };
        let mut others = self.vertices().filter(|v| !own.contains(v));
        position(action).is_some_and(|at| {
            others.any(|v| self.positions[v].map(position_key) == Some(position_key(at)))
        })
    }

    fn remove_isolated(&mut self) {
        let used: BTreeSet<usize> = self.faces().flat_map(|(_, face)| face.to_vec()).collect();
        for (v, position) in self.positions.iter_mut().enumerate() {
            if !used.contains(&v) {
                *position = None;
            }
        }
    }

    /// Returns the two faces of an edge if they run in opposite directions along the edge. The
    /// first face runs from `a` to `b`.
    fn opposite_faces(&self, [a, b]: [usize; 2]) -> Option<[usize; 2]> {
        let edges = self.edges();
        match *edges.get(&[a.min(b), a.max(b)])?.as_slice() {
            [(f, up), (g, down)] if up != down => Some(if up == (a < b) { [f, g] } else { [g, f] }),
            _ => None,
        }
    }

    fn is_boundary(&self, v: usize) -> bool {
        self.edges()
            .iter()
            .any(|(ends, faces)| ends.contains(&v) && faces.len() == 1)
    }
}

/// Iterates over the sides of a face: side `i` joins corners `i` and `i + 1`.
pub(crate) fn sides(face: &[usize]) -> impl Iterator<Item = (usize, usize)> {
    (0..face.len()).map(|i| (face[i], face[(i + 1) % face.len()]))
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

fn position_of_side(face: &[usize], [a, b]: [usize; 2]) -> Option<usize> {
    sides(face).position(|side| side == (a, b) || side == (b, a))
}
