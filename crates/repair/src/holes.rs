//! Filling of boundary holes.

mod minimum_area;

use glam::DVec3;
use rustc_hash::FxHashSet;
use sixfold_core::{Capabilities, FaceId, Incidence, Pair, PolygonCutter, PolygonMesh, VertexId};
use sixfold_spatial::{Bvh, FaceTriangle, SpatialIndex, SurfaceQueries, polygon_triangles};

use crate::error::RepairError;
use crate::outcome::{Left, Outcome, StepCounts};
use crate::trace::Rebuild;
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
/// the mesh: the outer boundary of a flat part is one, and so are the three sides of a face that
/// shares no edge.
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

/// A triangle lies on a surface if its centre is nearer to the surface than this part of its height.
const ON_SURFACE: f64 = 0.01;

/// Fills holes.
pub(crate) fn fill(polygons: &PolygonMesh, options: &FillHoles) -> Result<Outcome, RepairError> {
    let needed = Capabilities {
        non_manifold_vertices: true,
        ..Capabilities::ORIENTED_MANIFOLDS
    };
    let check = needed.check(polygons);
    check.map_err(RepairError::NotOrientedManifold)?;
    let mut holes = Holes::new(polygons);
    let loops = holes.loops(polygons);
    if loops.is_empty() {
        return Ok(Outcome::unchanged());
    }
    let mut rebuild = Rebuild::new(polygons);
    for (f, _) in polygons.faces().iter() {
        rebuild.keep(f, |v, _| v)?;
    }
    let mut counts = StepCounts::default();
    let mut left = Vec::new();
    let surface = Surface::new(polygons);
    for hole in loops {
        let (vertex, edges) = (hole[0], hole.len());
        if options.max_edges.is_some_and(|most| edges > most) {
            left.push(Left::LargeHole { vertex, edges });
            continue;
        }
        let Some(triangles) = holes.triangulate(polygons, &hole, options.method) else {
            left.push(Left::BlockedHole { vertex, edges });
            continue;
        };
        if surface.is_covered_by(polygons, triangles.iter().map(|t| t.map(|i| hole[i]))) {
            left.push(Left::CoveringHole { vertex, edges });
            continue;
        }
        counts.holes_filled += 1;
        counts.faces_added += triangles.len();
        for triangle in triangles {
            let corners = triangle.map(|i| hole[i]);
            holes.add_edges(corners);
            rebuild.push(None, corners.into_iter().map(|v| (v, None)))?;
        }
    }
    let outcome = match counts.is_change() {
        true => Outcome::changed(rebuild.finish_with_old_vertices()?, counts),
        false => Outcome::unchanged(),
    };
    Ok(Outcome { left, ..outcome })
}

/// The surface before holes are filled.
struct Surface(Option<Bvh<FaceTriangle<FaceId>>>);

impl Surface {
    fn new(polygons: &PolygonMesh) -> Self {
        // Without an index, because a coordinate is not finite, every hole is filled.
        Self(polygon_triangles(polygons).and_then(Bvh::build).ok())
    }

    /// Returns whether more than half of the area of a patch lies on the surface.
    fn is_covered_by(
        &self,
        polygons: &PolygonMesh,
        patch: impl Iterator<Item = [VertexId; 3]>,
    ) -> bool {
        let Some(index) = &self.0 else { return false };
        let (mut covered, mut all) = (0.0, 0.0);
        for triangle in patch {
            let [a, b, c] = triangle.map(|v| polygons.position(v).as_dvec3());
            let area = (b - a).cross(c - a).length();
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let closest = index.closest_point((a + b + c) / 3.0);
            // The area is twice that of the triangle, so this is its height.
            let near = ON_SURFACE * area / longest;
            let is_near = closest.is_some_and(|point| point.distance() < near);
            covered += if is_near { area } else { 0.0 };
            all += area;
        }
        covered > 0.5 * all
    }
}

/// The boundary of an oriented surface whose edges have at most two faces.
struct Holes {
    /// The boundary edges, each with the hole on its left, sorted.
    sides: Vec<[VertexId; 2]>,
    /// The edges between boundary vertices.
    edges: FxHashSet<Pair<VertexId>>,
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
                sides.push(match side.downward {
                    true => [low, high],
                    false => [high, low],
                });
                edge.ends
                    .iter()
                    .for_each(|v| is_on_boundary[v.index()] = true);
            }
        }
        sides.sort_unstable();
        let ends = incidence.edges().map(|edge| edge.ends);
        let inner = ends.filter(|ends| ends.iter().all(|v| is_on_boundary[v.index()]));
        let edges = inner.map(|[a, b]| Pair::new(a, b)).collect();
        Self { sides, edges }
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

    fn add_edges(&mut self, [a, b, c]: [VertexId; 3]) {
        self.edges
            .extend([Pair::new(a, b), Pair::new(b, c), Pair::new(c, a)]);
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

/// Returns whether corners `i` and `j` of a polygon with `n` corners are not adjacent.
pub(crate) fn is_diagonal(i: usize, j: usize, n: usize) -> bool {
    let apart = i.abs_diff(j);
    apart > 1 && apart < n - 1
}

#[cfg(test)]
mod tests;
