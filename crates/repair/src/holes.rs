//! Filling of boundary holes.

mod cover;
mod minimum_area;

use glam::DVec3;
use rustc_hash::FxHashSet;
use sixfold_core::{
    Capabilities, FaceId, Incidence, Pair, PolygonCutter, PolygonMesh, VertexId, row,
};

use crate::error::RepairError;
use crate::outcome::{Left, Outcome, StepCounts};
use crate::trace::Rebuild;
use cover::{Covered, Patch, Patches, Surface, coincide};
use minimum_area::minimum_area_triangulation;

/// Options of filling holes.
///
/// A hole is a closed chain of boundary edges that visits no vertex twice. Where several holes meet in
/// a vertex, chains continue with the smallest angle. The outer boundary of an open surface is such a
/// chain too: limit the number of edges to keep it open.
///
/// A hole with n edges is filled with n − 2 triangles, without new vertices. No diagonal is used
/// that is already an edge, because that edge would get more than two faces. If this is impossible,
/// the hole remains and is named in the report. So does a hole whose triangles would lie on faces of
/// the mesh: the outer boundary of a flat part is one, and so are the sides of a face that
/// shares no edge, and a hole with another part of the mesh in it. Faces lie on triangles if they are
/// nearly parallel to them, within 0.005 of the mean length of the hole's edges. A hole also remains
/// if this is not known, because very many faces are near its triangles.
///
/// Holes are filled in the order of their area. A hole whose triangles would lie on those of a
/// smaller hole remains; if the triangles of two holes coincide, both remain.
///
/// Besides the time of the method, this takes O((n + f) log f) for n edges of holes and f faces if few
/// faces are near the triangles of holes, and O(n²) more for each hole along which a surface runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FillHoles {
    /// Holes with more edges than this remain; `None` for no limit.
    pub max_edges: Option<usize>,
    /// The method of triangulation.
    pub method: HoleFilling,
}

sixfold_core::named! {
    /// The method by which a hole is triangulated.
    #[derive(Default)]
    pub enum HoleFilling: "hole filling method" {
        /// The triangulation with the smallest area, by dynamic programming in O(n³) time and O(n²)
        /// memory for n edges (Barequet & Sharir 1995, as in the first part of Liepa 2003). Holes
        /// with more than 400 edges are filled by ear clipping.
        #[default]
        MinimumArea = "smallest",
        /// Ear clipping of the projection along the axis nearest to the normal; O(n²) (Meisters
        /// 1975).
        EarClipping = "ears",
    }
}

/// The largest number of edges for [`HoleFilling::MinimumArea`]: some 11 million triangles are
/// compared.
const MINIMUM_AREA_EDGES: usize = 400;

/// Fills holes.
pub(crate) fn fill(polygons: &PolygonMesh, options: &FillHoles) -> Result<Outcome, RepairError> {
    let needed = Capabilities {
        non_manifold_vertices: true,
        ..Capabilities::ORIENTED_MANIFOLDS
    };
    let check = needed.check(polygons);
    check.map_err(RepairError::NotOrientedManifold)?;
    let holes = Holes::new(polygons);
    let loops = holes.loops(polygons);
    if loops.is_empty() {
        return Ok(Outcome::unchanged());
    }
    let mut filling = Filling::new(polygons, options.method, holes, &loops);
    for (number, hole) in loops.iter().enumerate() {
        if options.max_edges.is_some_and(|most| hole.len() > most) {
            filling.leave(number, |vertex, edges| Left::LargeHole { vertex, edges });
        } else {
            filling.propose(number);
        }
    }
    filling.accept();
    let mut rebuild = Rebuild::new(polygons);
    for (f, _) in polygons.faces().iter() {
        rebuild.keep(f, |v, _| v)?;
    }
    let Filling {
        mut accepted,
        mut left,
        ..
    } = filling;
    accepted.sort_unstable_by_key(|proposal| proposal.hole);
    let mut counts = StepCounts::default();
    for triangles in accepted.into_iter().map(|proposal| proposal.triangles) {
        counts.holes_filled += 1;
        counts.faces_added += triangles.len();
        for corners in triangles {
            rebuild.push(None, corners.into_iter().map(|v| (v, None)))?;
        }
    }
    let outcome = match counts.is_change() {
        true => Outcome::changed(rebuild.finish_with_old_vertices()?, counts),
        false => Outcome::unchanged(),
    };
    left.sort_unstable_by_key(|(hole, _)| *hole);
    let left = left.into_iter().map(|(_, left)| left).collect();
    Ok(Outcome { left, ..outcome })
}

/// The triangles for a hole, before it is certain that the hole is filled.
struct Proposal {
    /// The number of the hole.
    hole: usize,
    triangles: Vec<[VertexId; 3]>,
    patch: Patch,
    /// The part of the patch on which faces of the mesh lie.
    covered: Covered,
}

/// The filling of holes: first, every hole gets a patch of triangles by itself; then the smallest
/// patches are accepted first.
struct Filling<'a> {
    polygons: &'a PolygonMesh,
    method: HoleFilling,
    loops: &'a [Vec<VertexId>],
    /// The edges of the mesh and of accepted patches.
    holes: Holes,
    surface: Surface<'a>,
    /// By vertex: a hole in which it is, plus 1, if this was the last one that was marked.
    mark: Vec<u32>,
    proposals: Vec<Proposal>,
    accepted: Vec<Proposal>,
    /// The holes that remain, by number.
    left: Vec<(usize, Left)>,
}

impl<'a> Filling<'a> {
    fn new(
        polygons: &'a PolygonMesh,
        method: HoleFilling,
        holes: Holes,
        loops: &'a [Vec<VertexId>],
    ) -> Self {
        Self {
            polygons,
            method,
            loops,
            holes,
            surface: Surface::new(polygons),
            mark: vec![0; polygons.vertex_count()],
            proposals: Vec::new(),
            accepted: Vec::new(),
            left: Vec::new(),
        }
    }

    fn leave(&mut self, hole: usize, reason: impl FnOnce(VertexId, usize) -> Left) {
        let corners = &self.loops[hole];
        self.left.push((hole, reason(corners[0], corners.len())));
    }

    fn leave_covering(&mut self, hole: usize) {
        self.leave(hole, |vertex, edges| Left::CoveringHole { vertex, edges });
    }

    /// Proposes a patch that is possible beside the accepted ones and does not lie on the mesh;
    /// leaves the hole if there is none.
    fn propose(&mut self, hole: usize) {
        let corners = &self.loops[hole];
        self.mark_hole(hole);
        let face = self.holes.face_beside(corners);
        let face = self.polygons.faces().face(face);
        if face.len() == corners.len() && face.iter().all(|&v| self.is_in_hole(hole, v)) {
            self.leave_covering(hole);
            return;
        }
        let triangles = self.holes.triangulate(self.polygons, corners, self.method);
        let Some(triangles) = triangles else {
            self.leave(hole, |vertex, edges| Left::BlockedHole { vertex, edges });
            return;
        };
        let triangles: Vec<[VertexId; 3]> = triangles
            .into_iter()
            .map(|triangle| triangle.map(|i| corners[i]))
            .collect();
        let patch = Patch::new(self.polygons, corners, &triangles);
        let covered = self.surface.on(&patch, |v| self.is_in_hole(hole, v));
        if patch.is_covered(covered) {
            self.leave_covering(hole);
            return;
        }
        self.proposals.push(Proposal {
            hole,
            triangles,
            patch,
            covered,
        });
    }

    fn mark_hole(&mut self, hole: usize) {
        for v in &self.loops[hole] {
            self.mark[v.index()] = row(hole) + 1;
        }
    }

    /// Returns whether a vertex is in the hole that was marked last.
    fn is_in_hole(&self, hole: usize, v: VertexId) -> bool {
        self.mark[v.index()] == row(hole) + 1
    }

    /// Accepts the proposals that do not lie on smaller ones that are accepted, and leaves the
    /// others. Of two proposals that coincide, both are left.
    fn accept(&mut self) {
        let proposals = std::mem::take(&mut self.proposals);
        let patches = Patches::new(proposals.iter().map(|proposal| &proposal.patch).collect());
        let mut covers = Vec::with_capacity(proposals.len());
        for (p, proposal) in proposals.iter().enumerate() {
            self.mark_hole(proposal.hole);
            let is_in_hole = |v| self.is_in_hole(proposal.hole, v);
            covers.push(patches.on(p, is_in_hole));
        }
        let mut is_twice = vec![false; proposals.len()];
        for (p, covers) in covers.iter().enumerate() {
            for &(q, covered) in covers.iter().flatten() {
                if coincide(&proposals[p].patch, &proposals[q].patch, covered) {
                    (is_twice[p], is_twice[q]) = (true, true);
                }
            }
        }
        let mut order: Vec<usize> = (0..proposals.len()).collect();
        let area = |p: usize| proposals[p].patch.area();
        order.sort_by(|&p, &q| area(p).total_cmp(&area(q)));
        let mut proposals: Vec<Option<Proposal>> = proposals.into_iter().map(Some).collect();
        let mut is_accepted = vec![false; proposals.len()];
        for p in order {
            let Some(proposal) = proposals[p].take() else {
                continue;
            };
            let below = covers[p].iter().flatten().filter(|(q, _)| is_accepted[*q]);
            let covered = below.fold(proposal.covered, |sum, &(_, covered)| sum.with(covered));
            if is_twice[p] || covers[p].is_none() || proposal.patch.is_covered(covered) {
                self.leave_covering(proposal.hole);
                continue;
            }
            is_accepted[p] = self.accept_one(proposal);
        }
    }

    /// Accepts a proposal, with other triangles if it has a diagonal of an accepted one. Returns
    /// whether there are such triangles.
    fn accept_one(&mut self, proposal: Proposal) -> bool {
        let proposal = match self.holes.has_diagonal(&proposal.triangles) {
            false => Some(proposal),
            true => {
                self.propose(proposal.hole);
                self.proposals.pop()
            }
        };
        let Some(proposal) = proposal else {
            return false;
        };
        for &triangle in &proposal.triangles {
            self.holes.add_triangle(triangle);
        }
        self.accepted.push(proposal);
        true
    }
}

/// The boundary of an oriented surface whose edges have at most two faces.
struct Holes {
    /// The boundary edges, each with the hole on its left, sorted.
    sides: Vec<[VertexId; 2]>,
    /// By side: the face on its right.
    faces: Vec<FaceId>,
    /// The edges between boundary vertices.
    edges: FxHashSet<Pair<VertexId>>,
    /// Those of them that filling added.
    diagonals: FxHashSet<Pair<VertexId>>,
}

impl Holes {
    fn new(polygons: &PolygonMesh) -> Self {
        let faces = polygons.faces();
        let incidence = Incidence::new(polygons.vertex_count(), faces, |_| true);
        let mut is_on_boundary = vec![false; polygons.vertex_count()];
        let mut sides = Vec::new();
        for edge in incidence.edges() {
            if let Some(side) = edge.single() {
                let [low, high] = edge.ends;
                // Against the direction of the face.
                let ends = match side.downward {
                    true => [low, high],
                    false => [high, low],
                };
                sides.push((ends, side.face));
                edge.ends
                    .iter()
                    .for_each(|v| is_on_boundary[v.index()] = true);
            }
        }
        sides.sort_unstable();
        let ends = incidence.edges().map(|edge| edge.ends);
        let inner = ends.filter(|ends| ends.iter().all(|v| is_on_boundary[v.index()]));
        let edges = inner.map(|[a, b]| Pair::new(a, b)).collect();
        let (sides, faces) = sides.into_iter().unzip();
        Self {
            sides,
            faces,
            edges,
            diagonals: FxHashSet::default(),
        }
    }

    /// Returns the vertices of every hole, in the order of its boundary, from its lowest vertex on. No
    /// hole has a vertex twice.
    fn loops(&self, polygons: &PolygonMesh) -> Vec<Vec<VertexId>> {
        let mut is_used = vec![false; self.sides.len()];
        let mut loops = Vec::new();
        // By vertex of the path: its number in the path.
        let mut on_path = vec![None; polygons.vertex_count()];
        for first in 0..self.sides.len() {
            let mut path = vec![self.sides[first][0]];
            let mut side = Some(first).filter(|&side| !is_used[side]);
            while let Some(at) = side {
                is_used[at] = true;
                let [from, to] = self.sides[at];
                on_path[from.index()] = Some(path.len() - 1);
                if let Some(start) = on_path[to.index()] {
                    let mut hole = path.split_off(start);
                    hole.iter().for_each(|v| on_path[v.index()] = None);
                    let lowest = (0..hole.len()).min_by_key(|&i| hole[i]);
                    hole.rotate_left(lowest.unwrap_or(0));
                    loops.push(hole);
                }
                path.push(to);
                side = self.continuation(polygons, at, &is_used);
            }
            path.iter().for_each(|v| on_path[v.index()] = None);
        }
        loops.sort();
        loops
    }

    /// Returns the side after `side` along a hole: of those that are not used, the one with the
    /// smallest angle to it. A boundary ends nowhere, so without such a side, the path is closed.
    fn continuation(&self, polygons: &PolygonMesh, side: usize, is_used: &[bool]) -> Option<usize> {
        let [from, at] = self.sides[side];
        let first = self.sides.partition_point(|&[start, _]| start < at);
        let sides = self.sides[first..]
            .iter()
            .take_while(|&&[start, _]| start == at);
        let position = |v: VertexId| polygons.position(v).as_dvec3();
        let back = (position(from) - position(at)).normalize_or_zero();
        let cosine = |side: usize| {
            let [_, to] = self.sides[side];
            back.dot((position(to) - position(at)).normalize_or_zero())
        };
        let free = (first..first + sides.count()).filter(|&side| !is_used[side]);
        // The first of several with the same angle.
        free.rev().max_by(|&a, &b| cosine(a).total_cmp(&cosine(b)))
    }

    /// Returns the face beside the first side of a hole.
    fn face_beside(&self, hole: &[VertexId]) -> FaceId {
        let side = self.sides.binary_search(&[hole[0], hole[1]]);
        self.faces[side.expect("a side of the hole")]
    }

    fn add_triangle(&mut self, triangle: [VertexId; 3]) {
        for side in sides_of(triangle) {
            if self.edges.insert(side) {
                self.diagonals.insert(side);
            }
        }
    }

    /// Returns whether a triangle has a side that filling added.
    fn has_diagonal(&self, triangles: &[[VertexId; 3]]) -> bool {
        let mut sides = triangles.iter().copied().flat_map(sides_of);
        sides.any(|side| self.diagonals.contains(&side))
    }

    /// Returns the triangles of a hole as numbers of its vertices; `None` if no triangulation
    /// without a diagonal that is an edge was found.
    fn triangulate(
        &self,
        polygons: &PolygonMesh,
        hole: &[VertexId],
        method: HoleFilling,
    ) -> Option<Vec<[usize; 3]>> {
        let points: Vec<DVec3> = hole
            .iter()
            .map(|&v| polygons.position(v).as_dvec3())
            .collect();
        let is_edge = |i: usize, j: usize| self.edges.contains(&Pair::new(hole[i], hole[j]));
        let smallest = || match hole.len() {
            ..=MINIMUM_AREA_EDGES => minimum_area_triangulation(&points, is_edge),
            _ => None,
        };
        if method == HoleFilling::MinimumArea && hole.len() <= MINIMUM_AREA_EDGES {
            return smallest();
        }
        let mut cutter = PolygonCutter::default();
        let ears = cutter.cut(points.iter().copied(), is_edge).triangles;
        let is_blocked = |&[a, b, c]: &[usize; 3]| {
            let sides = [[a, b], [b, c], [c, a]];
            sides
                .into_iter()
                .any(|[i, j]| is_diagonal(i, j, hole.len()) && is_edge(i, j))
        };
        if ears.iter().any(is_blocked) {
            return smallest();
        }
        Some(ears.to_vec())
    }
}

fn sides_of([a, b, c]: [VertexId; 3]) -> [Pair<VertexId>; 3] {
    [Pair::new(a, b), Pair::new(b, c), Pair::new(c, a)]
}

/// Returns whether corners `i` and `j` of a polygon with `n` corners are not adjacent.
pub(crate) fn is_diagonal(i: usize, j: usize, n: usize) -> bool {
    let apart = i.abs_diff(j);
    apart > 1 && apart < n - 1
}

#[cfg(test)]
mod tests;
