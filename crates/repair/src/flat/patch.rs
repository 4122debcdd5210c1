//! The faces around faces without area, which change when those are removed.

use std::collections::{BTreeMap, BinaryHeap};

use glam::DVec3;
use rustc_hash::FxHashMap;
use sixfold_core::{FaceId, Pair, Point, PolygonCutter, PolygonMesh, Slot, VertexId, row};

use super::is_without_area;
use crate::error::RepairError;
use crate::holes::is_diagonal;
use crate::outcome::{Left, Outcome, StepCounts};
use crate::trace::{CornerId, Rebuild, VertexTrace, corners_of};

/// A vertex in a piece, and the corner of the mesh that it comes from.
type Corner = (VertexId, Option<CornerId>);

/// A face of the mesh, or a part of one.
struct Piece {
    face: FaceId,
    /// Empty if the piece was removed.
    corners: Vec<Corner>,
}

impl Piece {
    fn names(&self, v: VertexId) -> bool {
        self.corners.iter().any(|&(w, _)| w == v)
    }

    fn sides(&self) -> impl Iterator<Item = Pair<VertexId>> {
        Pair::sides(self.corners.len(), |i| self.corners[i].0)
    }

    fn has_side(&self, edge: Pair<VertexId>) -> bool {
        self.sides().any(|side| side == edge)
    }
}

/// A piece without area in the order of removal: the longest first, then the first piece.
#[derive(PartialEq)]
struct Candidate {
    longest: f64,
    piece: usize,
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_length = self.longest.total_cmp(&other.longest);
        by_length.then(other.piece.cmp(&self.piece))
    }
}

/// What a removal changes about edges.
#[derive(Default)]
struct Change {
    boundary_edges: i32,
    adds_non_manifold: bool,
}

impl Change {
    /// Notes that edges with `before` faces become one edge with `after` faces; 0 faces are no edge.
    /// It may have more than two faces if the edges that it replaces have as many, which is `most`.
    fn note(&mut self, before: &[usize], after: usize, most: usize) {
        for &faces in before {
            self.boundary_edges -= i32::from(faces == 1);
        }
        self.boundary_edges += i32::from(after == 1);
        self.adds_non_manifold |= after > 2 && after > most;
    }

    fn is_allowed(&self) -> bool {
        self.boundary_edges <= 0 && !self.adds_non_manifold
    }
}

/// All faces that name a vertex of a face without area.
///
/// Only edges with an end at such a vertex change, and all faces of these edges are in the patch.
pub(super) struct Patch<'a> {
    polygons: &'a PolygonMesh,
    pieces: Vec<Piece>,
    /// By face: whether it is in the patch.
    is_inside: Vec<bool>,
    /// The pieces at each edge.
    on_edge: FxHashMap<Pair<VertexId>, Vec<usize>>,
    /// The pieces that name a vertex of a face without area, and others that named it before.
    at_vertex: FxHashMap<VertexId, Vec<usize>>,
    /// By vertex that was merged: the vertex that it was merged with.
    merged: FxHashMap<VertexId, VertexId>,
    is_changed: bool,
}

impl<'a> Patch<'a> {
    /// Collects the faces around `flat`.
    pub(super) fn new(polygons: &'a PolygonMesh, flat: &[FaceId]) -> Self {
        let mut is_flat_vertex = vec![false; polygons.vertex_count()];
        for v in flat.iter().flat_map(|&f| polygons.faces().face(f)) {
            is_flat_vertex[v.index()] = true;
        }
        let mut patch = Self {
            polygons,
            pieces: Vec::new(),
            is_inside: vec![false; polygons.face_count()],
            on_edge: FxHashMap::default(),
            at_vertex: FxHashMap::default(),
            merged: FxHashMap::default(),
            is_changed: false,
        };
        for (f, face) in polygons.faces().iter() {
            if face.iter().any(|v| is_flat_vertex[v.index()]) {
                patch.is_inside[f.index()] = true;
                let corners = corners_of(polygons, f).map(|(v, c)| (v, Some(c)));
                patch.add(f, corners.collect());
            }
        }
        patch
    }

    /// Removes pieces without area until none can be removed, with at most this many attempts.
    pub(super) fn remove_flat(&mut self, mut attempts: usize) {
        loop {
            let mut heap: BinaryHeap<Candidate> = (0..self.pieces.len())
                .filter_map(|piece| self.candidate(piece))
                .collect();
            let mut is_any_removed = false;
            while let Some(Candidate { piece, .. }) = heap.pop() {
                if attempts == 0 {
                    return;
                }
                attempts -= 1;
                let first_new = self.pieces.len();
                if self.is_flat(piece) && self.try_remove(piece) {
                    (is_any_removed, self.is_changed) = (true, true);
                    heap.extend((first_new..self.pieces.len()).filter_map(|p| self.candidate(p)));
                }
            }
            if !is_any_removed {
                return;
            }
        }
    }

    /// Returns the changed mesh.
    pub(super) fn finish(mut self) -> Result<Outcome, RepairError> {
        let flat = (0..self.pieces.len()).filter(|&piece| self.is_flat(piece));
        let mut flat: Vec<FaceId> = flat.map(|piece| self.pieces[piece].face).collect();
        flat.sort_unstable();
        flat.dedup();
        let left = flat.into_iter().map(|face| Left::FlatFace { face });
        let left = left.collect();
        if !self.is_changed {
            return Ok(Outcome {
                left,
                ..Outcome::unchanged()
            });
        }
        self.pieces.sort_by_key(|piece| piece.face); // stable: the pieces of a face stay in order
        let (vertices, positions) = self.vertices();
        let number = |v: VertexId| vertices.replacements[v.index()].get().expect("it is kept");
        let mut counts = StepCounts {
            vertices_merged: self.merged.len(),
            ..StepCounts::default()
        };
        let mut rebuild = Rebuild::new(self.polygons);
        let mut pieces = self.pieces.iter().peekable();
        for (f, face) in self.polygons.faces().iter() {
            if !self.is_inside[f.index()] {
                rebuild.keep(f, |v, _| number(v))?;
                continue;
            }
            let (mut parts, mut has_old_corners) = (0, false);
            while let Some(piece) = pieces.next_if(|piece| piece.face == f) {
                if piece.corners.is_empty() {
                    continue;
                }
                parts += 1;
                has_old_corners = piece.corners.len() == face.len();
                let corners = piece.corners.iter();
                rebuild.push(Some(f), corners.map(|&(v, corner)| (number(v), corner)))?;
            }
            match parts {
                0 => counts.faces_removed += 1,
                1 => counts.faces_changed += usize::from(!has_old_corners),
                _ => {
                    counts.faces_changed += 1;
                    counts.faces_added += parts - 1;
                }
            }
        }
        let changed = rebuild.finish(positions, vertices)?;
        Ok(Outcome {
            left,
            ..Outcome::changed(changed, counts)
        })
    }

    /// Returns the vertices without those that were merged, and their positions.
    fn vertices(&self) -> (VertexTrace, Vec<Point>) {
        let mut replacements = vec![Slot::NONE; self.polygons.vertex_count()];
        let (mut origins, mut positions) = (Vec::new(), Vec::new());
        for v in self.polygons.vertices() {
            if !self.merged.contains_key(&v) {
                replacements[v.index()] = Slot::some(VertexId::new(row(positions.len())));
                origins.push(Slot::some(v));
                positions.push(self.polygons.position(v));
            }
        }
        for v in self.polygons.vertices() {
            let mut kept = v;
            while let Some(&next) = self.merged.get(&kept) {
                kept = next;
            }
            replacements[v.index()] = replacements[kept.index()];
        }
        let vertices = VertexTrace {
            replacements,
            origins,
        };
        (vertices, positions)
    }

    fn at(&self, v: VertexId) -> DVec3 {
        self.polygons.position(v).as_dvec3()
    }

    fn is_flat(&self, piece: usize) -> bool {
        let corners = &self.pieces[piece].corners;
        !corners.is_empty() && is_without_area(corners.iter().map(|&(v, _)| self.at(v)))
    }

    fn faces_on(&self, edge: Pair<VertexId>) -> usize {
        self.on_edge.get(&edge).map_or(0, Vec::len)
    }

    fn candidate(&self, piece: usize) -> Option<Candidate> {
        if !self.is_flat(piece) {
            return None;
        }
        let lengths = self.pieces[piece].sides().map(|side| {
            let [a, b] = side.ends().map(|v| self.at(v));
            a.distance_squared(b)
        });
        let longest = lengths.fold(0.0, f64::max);
        Some(Candidate { longest, piece })
    }

    fn add(&mut self, face: FaceId, corners: Vec<Corner>) {
        let number = self.pieces.len();
        self.pieces.push(Piece { face, corners });
        self.link(number);
    }

    /// Adds a piece to the lists of its edges and vertices.
    fn link(&mut self, piece: usize) {
        for side in self.pieces[piece].sides() {
            self.on_edge.entry(side).or_default().push(piece);
        }
        for &(v, _) in &self.pieces[piece].corners {
            self.at_vertex.entry(v).or_default().push(piece);
        }
    }

    /// Removes a piece from the lists of its edges, and returns its corners.
    fn unlink(&mut self, piece: usize) -> Vec<Corner> {
        for side in self.pieces[piece].sides() {
            if let Some(pieces) = self.on_edge.get_mut(&side) {
                pieces.retain(|&other| other != piece);
            }
        }
        std::mem::take(&mut self.pieces[piece].corners)
    }

    /// Cuts a polygon without area into triangles, unless a diagonal would be an edge already.
    fn try_cut(&mut self, piece: usize) -> bool {
        let Piece { face, corners } = &self.pieces[piece];
        let (face, corners) = (*face, corners.clone());
        let is_edge = |i: usize, j: usize| self.faces_on(Pair::new(corners[i].0, corners[j].0)) > 0;
        let mut cutter = PolygonCutter::default();
        let cut = cutter.cut(corners.iter().map(|&(v, _)| self.at(v)), is_edge);
        // In a triangle, the side from the last corner to the first is a diagonal, except in one.
        let is_blocked =
            |&[a, _, c]: &[usize; 3]| is_diagonal(a, c, corners.len()) && is_edge(a, c);
        if cut.triangles.iter().any(is_blocked) {
            return false;
        }
        let triangles = cut.triangles.iter();
        let triangles: Vec<Vec<Corner>> =
            triangles.map(|t| t.map(|i| corners[i]).to_vec()).collect();
        self.unlink(piece);
        for triangle in triangles {
            self.add(face, triangle);
        }
        true
    }

    /// Removes a triangle without area, or cuts a polygon without area. Returns whether this was done:
    /// the face remains if there would be one more boundary edge or non-manifold edge.
    fn try_remove(&mut self, piece: usize) -> bool {
        let &[(a, _), (b, _), (c, _)] = &self.pieces[piece].corners[..] else {
            return self.try_cut(piece);
        };
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        let same = turns.iter().find(|[a, b, _]| self.at(*a) == self.at(*b));
        if let Some(&[a, b, _]) = same {
            return self.try_merge(a, b);
        }
        let length = |[a, _, c]: &[VertexId; 3]| self.at(*a).distance_squared(self.at(*c));
        let longest = turns.iter().max_by(|s, t| length(s).total_cmp(&length(t)));
        let &[a, b, c] = longest.expect("three sides");
        self.try_split(piece, [a, b, c])
    }

    /// Merges two vertices at one position, which removes the triangles between them.
    fn try_merge(&mut self, a: VertexId, b: VertexId) -> bool {
        let edge = Pair::new(a, b);
        let faces_at = |v: VertexId| self.at_vertex[&v].len();
        let (kept, gone) = match faces_at(a) >= faces_at(b) {
            true => (a, b),
            false => (b, a),
        };
        let mut at_gone: Vec<usize> = self.at_vertex[&gone].clone();
        at_gone.sort_unstable();
        at_gone.dedup();
        at_gone.retain(|&piece| self.pieces[piece].names(gone));
        // By neighbour of `gone`: how many triangles on the edge vanish.
        let mut vanishing: BTreeMap<VertexId, usize> = BTreeMap::new();
        for &piece in &at_gone {
            let piece = &self.pieces[piece];
            let is_on_edge = piece.has_side(edge);
            if piece.names(kept) && !is_on_edge {
                return false; // the face would name the vertex twice
            }
            let vanishes = is_on_edge && piece.corners.len() == 3;
            let others = piece.sides().filter(|&side| side != edge && side.has(gone));
            for side in others {
                let [v, w] = side.ends();
                let neighbour = if v == gone { w } else { v };
                *vanishing.entry(neighbour).or_default() += usize::from(vanishes);
            }
        }
        let mut change = Change::default();
        change.note(&[self.faces_on(edge)], 0, 0);
        for (&neighbour, &vanishing) in &vanishing {
            let before = [kept, gone].map(|end| self.faces_on(Pair::new(end, neighbour)));
            let after = before[0] + before[1] - 2 * vanishing;
            change.note(&before, after, before[0].max(before[1]));
        }
        if !change.is_allowed() {
            return false;
        }
        for piece in at_gone {
            let mut corners = self.unlink(piece);
            if corners.iter().any(|&(v, _)| v == kept) {
                corners.retain(|&(v, _)| v != gone);
            }
            if corners.len() < 3 {
                continue;
            }
            for (v, _) in &mut corners {
                *v = if *v == gone { kept } else { *v };
            }
            self.pieces[piece].corners = corners;
            self.link(piece);
        }
        self.merged.insert(gone, kept);
        true
    }

    /// Removes the triangle `a b c`, in which `b` lies between the others, and adds corner `b` to the
    /// other faces on the edge `a c`.
    fn try_split(&mut self, piece: usize, [a, b, c]: [VertexId; 3]) -> bool {
        let long = Pair::new(a, c);
        let others: Vec<usize> = self.on_edge[&long]
            .iter()
            .copied()
            .filter(|&other| other != piece)
            .collect();
        let (twins, others): (Vec<usize>, Vec<usize>) = others
            .into_iter()
            .partition(|&other| self.pieces[other].names(b));
        let on_long = self.faces_on(long);
        let mut change = Change::default();
        change.note(&[on_long], 0, 0);
        for end in [a, c] {
            let before = self.faces_on(Pair::new(end, b));
            // A triangle on the same three vertices vanishes together with this one.
            let after = (before + others.len()).saturating_sub(1 + twins.len());
            change.note(&[before], after, before.max(on_long));
        }
        let is_triangle = |&other: &usize| self.pieces[other].corners.len() == 3;
        let mut apexes: Vec<VertexId> = Vec::new();
        for other in others.iter().filter(|other| is_triangle(other)) {
            let corners = self.pieces[*other].corners.iter().map(|&(v, _)| v);
            apexes.extend(corners.filter(|&v| !long.has(v)));
        }
        let is_new = |(i, &apex): (usize, &VertexId)| {
            self.faces_on(Pair::new(b, apex)) == 0 && !apexes[..i].contains(&apex)
        };
        let is_possible = change.is_allowed()
            && twins.iter().all(is_triangle)
            && apexes.iter().enumerate().all(is_new)
            && (others.len() == 1 || !others.iter().any(|&other| self.is_flat(other)));
        if !is_possible {
            return false;
        }
        self.unlink(piece);
        for twin in twins {
            self.unlink(twin);
        }
        for other in others {
            self.split(other, long, b);
        }
        true
    }

    /// Adds the corner `b` on a side of a piece. A triangle becomes two.
    fn split(&mut self, piece: usize, side: Pair<VertexId>, b: VertexId) {
        let face = self.pieces[piece].face;
        let at = self.pieces[piece].sides().position(|s| s == side);
        let mut corners = self.unlink(piece);
        corners.rotate_left(at.expect("the piece has the side"));
        match corners[..] {
            [from, to, apex] => {
                self.add(face, vec![from, (b, None), apex]);
                self.add(face, vec![(b, None), to, apex]);
            }
            _ => {
                corners.insert(1, (b, None));
                self.add(face, corners);
            }
        }
    }
}
