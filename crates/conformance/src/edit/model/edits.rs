//! The edits of the model, by brute force.

use std::collections::{BTreeMap, BTreeSet};

use sixfold_core::Point;

use super::{Model, Rules, position_of_side, sides, sorted};
use crate::edit::action::Action;

/// A method returns `None` if the rules of its edit forbid the edit. The model may then be partly
/// edited.
impl Model {
    pub(super) fn apply(&mut self, action: &Action, rules: &Rules) -> Option<()> {
        match *action {
            Action::SetPosition { v, to } => self.set_position(v, to),
            Action::AddVertex { at } => {
                self.add_vertex(at);
                Some(())
            }
            Action::AddFace { ref corners } => self.add_face(corners),
            Action::RemoveFace { f } => self.remove_face(f),
            Action::RemoveFaces { ref faces } => {
                faces.iter().try_for_each(|&f| self.face(f).map(|_| ()))?;
                faces.iter().for_each(|&f| self.faces[f] = None);
                Some(())
            }
            Action::RemoveVertex { v } => self.remove_vertex(v),
            Action::RemoveIsolatedVertices {} => {
                self.remove_isolated();
                Some(())
            }
            Action::SplitEdge { e, at } => self.split_edge(e, at),
            Action::BisectEdge { e, at } => self.bisect_edge(e, at),
            Action::PokeFace { f, at } => self.poke_face(f, at),
            Action::SplitFace { f, ends } => self.split_face(f, ends),
            Action::DissolveEdge { e } => self.dissolve_edge(e),
            Action::FlipEdge { e } => self.flip_edge(e),
            Action::CollapseEdge { e, keep, to } => {
                let removed = e.into_iter().find(|&end| end != keep)?;
                self.collapse_edge([keep, removed], to, rules)
            }
            Action::SplitVertex { v, left, right, at } => self.split_vertex(v, left, right, at),
            Action::Compact {} => Some(()),
        }
    }

    fn set_position(&mut self, v: usize, to: Point) -> Option<()> {
        self.position(v)?;
        self.positions[v] = Some(to);
        Some(())
    }

    fn add_vertex(&mut self, at: Point) -> usize {
        self.positions.push(Some(at));
        self.positions.len() - 1
    }

    fn add_face(&mut self, corners: &[usize]) -> Option<()> {
        let distinct: BTreeSet<_> = corners.iter().collect();
        if corners.len() < 3 || distinct.len() < corners.len() {
            return None;
        }
        corners
            .iter()
            .try_for_each(|&v| self.position(v).map(|_| ()))?;
        self.faces.push(Some(corners.to_vec()));
        Some(())
    }

    fn remove_face(&mut self, f: usize) -> Option<()> {
        self.face(f)?;
        self.faces[f] = None;
        Some(())
    }

    fn remove_vertex(&mut self, v: usize) -> Option<()> {
        self.position(v)?;
        self.positions[v] = None;
        for face in &mut self.faces {
            if face.as_ref().is_some_and(|face| face.contains(&v)) {
                *face = None;
            }
        }
        Some(())
    }

    fn split_edge(&mut self, ends: [usize; 2], at: Point) -> Option<()> {
        let faces = self.edges().remove(&sorted(ends))?;
        let m = self.add_vertex(at);
        for (f, _) in faces {
            let face = self.faces[f].as_mut()?;
            let i = position_of_side(face, ends)?;
            face.insert(i + 1, m);
        }
        Some(())
    }

    fn bisect_edge(&mut self, ends: [usize; 2], at: Point) -> Option<()> {
        let faces = self.edges().remove(&sorted(ends))?;
        let m = self.add_vertex(at);
        for (f, _) in faces {
            let face = self.faces[f].clone()?;
            let i = position_of_side(&face, ends)?;
            let [a, b, c] = [0, 1, 2].map(|j| face[(i + j) % face.len()]);
            (face.len() == 3).then_some(())?;
            self.faces[f] = Some(vec![a, m, c]);
            self.faces.push(Some(vec![m, b, c]));
        }
        Some(())
    }

    fn poke_face(&mut self, f: usize, at: Point) -> Option<()> {
        let face = self.face(f)?.to_vec();
        let m = self.add_vertex(at);
        self.faces[f] = None;
        for (a, b) in sides(&face) {
            self.faces.push(Some(vec![a, b, m]));
        }
        Some(())
    }

    fn split_face(&mut self, f: usize, ends: [usize; 2]) -> Option<()> {
        let face = self.face(f)?.to_vec();
        let [i, j] = ends.map(|v| face.iter().position(|&u| u == v));
        let (i, j) = (i?.min(j?), i?.max(j?));
        if i == j || j == i + 1 || (i == 0 && j + 1 == face.len()) {
            return None;
        }
        self.faces[f] = Some(face[i..=j].to_vec());
        self.faces.push(Some([&face[j..], &face[..=i]].concat()));
        Some(())
    }

    fn dissolve_edge(&mut self, ends: [usize; 2]) -> Option<()> {
        let [f, g] = self.opposite_faces(ends)?;
        let [first, second] = [f, g].map(|f| self.faces[f].clone());
        let (mut first, mut second) = (first?, second?);
        let common = first.iter().filter(|v| second.contains(v)).count();
        if common != 2 {
            return None;
        }
        // `first` must end with `a`, `b`; `second` must start with `b`, `a`.
        let i = position_of_side(&first, ends)?;
        let degree = first.len();
        first.rotate_left((i + 2) % degree);
        let j = position_of_side(&second, ends)?;
        second.rotate_left(j);
        let between = &second[2..];
        let mut merged = first[..first.len() - 1].to_vec();
        merged.extend(between);
        merged.push(*first.last()?);
        self.faces[f] = Some(merged);
        self.faces[g] = None;
        Some(())
    }

    fn flip_edge(&mut self, [a, b]: [usize; 2]) -> Option<()> {
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

    fn collapse_edge(
        &mut self,
        [keep, removed]: [usize; 2],
        to: Point,
        rules: &Rules,
    ) -> Option<()> {
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

    /// Returns the faces at `v`, counter-clockwise from the boundary. Each entry has the corner
    /// after `v`, the face, and the corner before `v`. Returns `None` if the faces are not one
    /// oriented fan.
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
        // The face between consecutive vertices of the ring; `None` for the gap at a boundary.
        let mut ring: Vec<usize> = fan.iter().map(|&(after, ..)| after).collect();
        let mut sectors: Vec<Option<usize>> = fan.iter().map(|&(_, f, _)| Some(f)).collect();
        if !closed {
            ring.push(last);
            sectors.push(None);
        }
        let index_in_ring = |u: usize| ring.iter().position(|&w| w == u);
        // Without `left`, the moved faces end at the boundary. Without `right`, the moved faces
        // start at the boundary.
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
