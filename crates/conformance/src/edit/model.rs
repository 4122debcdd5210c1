//! A mesh as plain lists, with every edit by brute force.

use std::collections::{BTreeMap, BTreeSet};

use sixfold_core::{Capabilities, Edit, MeshEdit, Point, PolygonMesh, Representation};

use super::action::Action;
use crate::weld::position_key;

/// The meshes that a structure can hold, and the edits that it supports.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// Meshes that the structure can hold.
    pub capabilities: Capabilities,
    /// Whether it supports each edit, in the order of [`Edit::ALL`].
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

/// Positions and faces by number; the numbers of removed elements are not reused.
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

    /// Returns the corners of `f`, if it exists.
    pub fn face(&self, f: usize) -> Option<&[usize]> {
        self.faces.get(f)?.as_deref()
    }

    /// Returns the position of `v`, if it exists.
    pub fn position(&self, v: usize) -> Option<Point> {
        *self.positions.get(v)?
    }

    /// Returns each edge with its faces, and whether each face runs along it from the lower end to
    /// the higher.
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

    /// Returns the other ends of the edges at `v`.
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

    /// Converts the model to polygons, without unused numbers.
    ///
    /// # Panics
    ///
    /// Panics if a face uses a removed vertex: then the model itself has a bug.
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

    /// Returns the model after `action`, or `None` if the action is illegal.
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

    /// Returns whether another vertex is at the position where `action` puts a vertex.
    fn is_occupied(&self, action: &Action) -> bool {
        let own = match action {
            Action::SetPosition { v, .. } => [*v; 2],
            Action::CollapseEdge { ends, .. } => *ends,
            _ => [usize::MAX; 2],
        };
        let mut others = self.vertices().filter(|v| !own.contains(v));
        action.position().is_some_and(|at| {
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

    fn add_vertex(&mut self, at: Point) -> usize {
        self.positions.push(Some(at));
        self.positions.len() - 1
    }

    /// Returns the two faces of an edge if they run along it in opposite directions; the one from
    /// `a` to `b` is first.
    fn opposite_faces(&self, [a, b]: [usize; 2]) -> Option<[usize; 2]> {
        let edges = self.edges();
        match *edges.get(&[a.min(b), a.max(b)])?.as_slice() {
            [(f, up), (g, down)] if up != down => Some(if up == (a < b) { [f, g] } else { [g, f] }),
            _ => None,
        }
    }

    fn apply(&mut self, action: &Action, rules: &Rules) -> Option<()> {
        match action {
            Action::SetPosition { v, to } => {
                self.position(*v)?;
                self.positions[*v] = Some(*to);
            }
            Action::AddVertex { at } => {
                self.add_vertex(*at);
            }
            Action::AddFace { corners } => {
                let distinct: BTreeSet<_> = corners.iter().collect();
                if corners.len() < 3 || distinct.len() < corners.len() {
                    return None;
                }
                corners
                    .iter()
                    .try_for_each(|&v| self.position(v).map(|_| ()))?;
                self.faces.push(Some(corners.clone()));
            }
            Action::RemoveFace { f } => {
                self.face(*f)?;
                self.faces[*f] = None;
            }
            Action::RemoveVertex { v } => {
                self.position(*v)?;
                self.positions[*v] = None;
                for face in &mut self.faces {
                    if face.as_ref().is_some_and(|face| face.contains(v)) {
                        *face = None;
                    }
                }
            }
            Action::RemoveIsolatedVertices => self.remove_isolated(),
            Action::SplitEdge { ends, at } => {
                let faces = self.edges().remove(&sorted(*ends))?;
                let m = self.add_vertex(*at);
                for (f, _) in faces {
                    let face = self.faces[f].as_mut()?;
                    let i = position_of_side(face, *ends)?;
                    face.insert(i + 1, m);
                }
            }
            Action::BisectEdge { ends, at } => {
                let faces = self.edges().remove(&sorted(*ends))?;
                let m = self.add_vertex(*at);
                for (f, _) in faces {
                    let face = self.faces[f].clone()?;
                    let i = position_of_side(&face, *ends)?;
                    let [a, b, c] = [0, 1, 2].map(|j| face[(i + j) % face.len()]);
                    (face.len() == 3).then_some(())?;
                    self.faces[f] = Some(vec![a, m, c]);
                    self.faces.push(Some(vec![m, b, c]));
                }
            }
            Action::PokeFace { f, at } => {
                let face = self.face(*f)?.to_vec();
                let m = self.add_vertex(*at);
                self.faces[*f] = None;
                for (a, b) in sides(&face) {
                    self.faces.push(Some(vec![a, b, m]));
                }
            }
            Action::SplitFace { f, ends } => {
                let face = self.face(*f)?.to_vec();
                let [i, j] = ends.map(|v| face.iter().position(|&u| u == v));
                let (i, j) = (i?.min(j?), i?.max(j?));
                if i == j || j == i + 1 || (i == 0 && j + 1 == face.len()) {
                    return None;
                }
                self.faces[*f] = Some(face[i..=j].to_vec());
                self.faces.push(Some([&face[j..], &face[..=i]].concat()));
            }
            Action::DissolveEdge { ends } => {
                let [f, g] = self.opposite_faces(*ends)?;
                let [first, second] = [f, g].map(|f| self.faces[f].clone());
                let (mut first, mut second) = (first?, second?);
                let common = first.iter().filter(|v| second.contains(v)).count();
                if common != 2 {
                    return None;
                }
                // Rotates `first` so that it ends with a, b, and `second` so that it starts with
                // b, a.
                let i = position_of_side(&first, *ends)?;
                let degree = first.len();
                first.rotate_left((i + 2) % degree);
                let j = position_of_side(&second, *ends)?;
                second.rotate_left(j);
                let between = &second[2..];
                let mut merged = first[..first.len() - 1].to_vec();
                merged.extend(between);
                merged.push(*first.last()?);
                self.faces[f] = Some(merged);
                self.faces[g] = None;
            }
            Action::FlipEdge { ends } => self.flip(*ends)?,
            Action::CollapseEdge { ends, to } => self.collapse(*ends, *to, rules)?,
            Action::SplitVertex { v, left, right, at } => {
                self.split_vertex(*v, *left, *right, *at)?;
            }
            Action::Compact => {}
        }
        Some(())
    }

    fn flip(&mut self, [a, b]: [usize; 2]) -> Option<()> {
        let [f, g] = self.opposite_faces([a, b])?;
        let apex = |f: usize| match self.face(f)? {
            [x, y, z] => [*x, *y, *z].into_iter().find(|v| ![a, b].contains(v)),
            _ => None,
        };
        let (c, d) = (apex(f)?, apex(g)?);
        if c == d || self.edges().contains_key(&sorted([c, d])) {
            return None;
        }
        for end in [a, b] {
            let faces = self.faces().filter(|(_, face)| face.contains(&end)).count();
            if faces == 3 && self.neighbours(end).len() == 3 {
                return None;
            }
        }
        self.faces[f] = Some(vec![a, d, c]);
        self.faces[g] = Some(vec![b, c, d]);
        Some(())
    }

    fn is_boundary(&self, v: usize) -> bool {
        self.edges()
            .iter()
            .any(|(ends, faces)| ends.contains(&v) && faces.len() == 1)
    }

    fn collapse(&mut self, [keep, removed]: [usize; 2], to: Point, rules: &Rules) -> Option<()> {
        let along = self.edges().remove(&sorted([keep, removed]))?;
        let triangles = along
            .iter()
            .filter(|(f, _)| self.face(*f).is_some_and(|f| f.len() == 3));
        let apexes = triangles.map(|(f, _)| {
            let corners = self.face(*f).into_iter().flatten();
            corners.copied().find(|v| ![keep, removed].contains(v))
        });
        let apexes: Vec<usize> = apexes.collect::<Option<_>>()?;
        let manifold = !rules.capabilities.non_manifold_edges;
        if manifold {
            let common = &self.neighbours(keep) & &self.neighbours(removed);
            if common.len() != apexes.len() || apexes.iter().any(|c| !common.contains(c)) {
                return None;
            }
            if along.len() == 2 && self.is_boundary(keep) && self.is_boundary(removed) {
                return None;
            }
        }
        for face in &mut self.faces {
            let Some(corners) = face.as_mut().filter(|face| face.contains(&removed)) else {
                continue;
            };
            if corners.contains(&keep) {
                position_of_side(corners, [keep, removed])?;
                corners.retain(|&v| v != removed);
                if corners.len() < 3 {
                    *face = None;
                }
            } else {
                for v in corners.iter_mut().filter(|v| **v == removed) {
                    *v = keep;
                }
            }
        }
        self.positions[removed] = None;
        self.positions[keep] = Some(to);
        let has_face = |v: usize| self.faces().any(|(_, face)| face.contains(&v));
        if !apexes.iter().copied().chain([keep]).all(has_face) {
            return None;
        }
        if manifold {
            let at_keep = self
                .faces()
                .filter(|(_, face)| face.len() == 3 && face.contains(&keep));
            let mut seen = BTreeSet::new();
            for (_, face) in at_keep {
                let corners: BTreeSet<usize> = face.iter().copied().collect();
                if !seen.insert(corners) {
                    return None;
                }
            }
        }
        Some(())
    }

    /// Returns the faces at `v` counter-clockwise, from the boundary if there is one. Each entry
    /// has the corner after `v`, the face, and the corner before `v`. `None` if the faces are not
    /// one oriented fan.
    fn fan(&self, v: usize) -> Option<Vec<(usize, usize, usize)>> {
        let mut left: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
        for (f, face) in self.faces() {
            let Some(i) = face.iter().position(|&u| u == v) else {
                continue;
            };
            let after = face[(i + 1) % face.len()];
            let before = face[(i + face.len() - 1) % face.len()];
            if left.insert(after, (f, before)).is_some() {
                return None;
            }
        }
        let all_before: BTreeSet<usize> = left.values().map(|&(_, before)| before).collect();
        let start = left
            .keys()
            .copied()
            .find(|after| !all_before.contains(after));
        let mut at = start.or_else(|| left.keys().next().copied())?;
        let mut fan = Vec::new();
        while let Some((f, before)) = left.remove(&at) {
            fan.push((at, f, before));
            at = before;
        }
        (left.is_empty() && all_before.len() == fan.len()).then_some(fan)
    }

    fn split_vertex(
        &mut self,
        v: usize,
        left: Option<usize>,
        right: Option<usize>,
        at: Point,
    ) -> Option<()> {
        let fan = self.fan(v)?;
        let (first, last) = (fan[0].0, fan[fan.len() - 1].2);
        let closed = first == last;
        // The sectors between consecutive adjacent vertices; at a boundary, the gap is a sector
        // too.
        let mut ring: Vec<usize> = fan.iter().map(|&(after, ..)| after).collect();
        let mut sectors: Vec<Option<usize>> = fan.iter().map(|&(_, f, _)| Some(f)).collect();
        if !closed {
            ring.push(last);
            sectors.push(None);
        }
        let index_in_ring = |u: usize| ring.iter().position(|&w| w == u);
        // Without `left`, the part ends at the start of the gap. Without `right`, it starts at the
        // end of the gap.
        let (from, to) = match (left, right) {
            (Some(l), Some(r)) if l != r => (index_in_ring(r)?, index_in_ring(l)?),
            (None, Some(r)) if !closed => (index_in_ring(r)?, ring.len() - 1),
            (Some(l), None) if !closed => (0, index_in_ring(l)?),
            _ => return None,
        };
        let n = self.add_vertex(at);
        let mut i = from;
        while i != to {
            if let Some(f) = sectors[i] {
                for u in self.faces[f].iter_mut().flatten().filter(|u| **u == v) {
                    *u = n;
                }
            }
            i = (i + 1) % ring.len();
        }
        if let Some(left) = left {
            self.faces.push(Some(vec![v, n, left]));
        }
        if let Some(right) = right {
            self.faces.push(Some(vec![v, right, n]));
        }
        Some(())
    }
}

/// Iterates over the sides of a face: side `i` joins corners `i` and `i + 1`.
pub(crate) fn sides(face: &[usize]) -> impl Iterator<Item = (usize, usize)> {
    (0..face.len()).map(|i| (face[i], face[(i + 1) % face.len()]))
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// Returns the index of the side of `face` that joins `a` and `b`, in either direction.
fn position_of_side(face: &[usize], [a, b]: [usize; 2]) -> Option<usize> {
    sides(face).position(|side| side == (a, b) || side == (b, a))
}
