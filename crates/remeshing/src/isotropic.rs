//! Isotropic remeshing: splits long edges, collapses short edges, improves valences by flips, and
//! smooths.

use std::ops::ControlFlow;

use glam::DVec3;
use sixfold_core::{MeshEdit, row};

use crate::Stop;
use crate::error::RemeshError;
use crate::numbering::{Numbering, corners, corners_from};
use crate::rules::{
    Curve, HUB, at, curves, keeps_orientation, keeps_orientation_at, keeps_topology,
};

/// `LONG`: minimum length of edges that are split. `SHORT`: maximum length of edges that are
/// collapsed. Both are multiples of the target length.
const LONG: f64 = 4.0 / 3.0;
const SHORT: f64 = 4.0 / 5.0;

/// Minimum cosine of the turning angle at a vertex of a straight boundary.
const STRAIGHT: f64 = 0.9962; // 5 degrees

/// Number of edges at hubs that the collapses of an iteration may visit, for each edge of the mesh.
const HUB_VISITS: usize = 16;

/// Minimum edge length, in steps between neighbouring f32 coordinates.
const MIN_STEPS: f64 = 4.0;

/// Maximum movement of a vertex that counts as no movement, as a fraction of the target length.
const TOLERANCE: f64 = 1e-3;

/// The options of remeshing. The defaults are at most 10 iterations and at most 10 million faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remeshing {
    /// The target length of edges, in the units of the mesh.
    pub edge_length: f64,
    /// The maximum number of iterations.
    pub iterations: usize,
    /// The maximum number of faces. An edge length that would need more faces is an error.
    pub max_faces: usize,
}

impl Remeshing {
    /// Returns the default options with the target length `edge_length`.
    pub fn with_edge_length(edge_length: f64) -> Self {
        Self {
            edge_length,
            iterations: 10,
            max_faces: 10_000_000,
        }
    }
}

/// The result of remeshing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Remeshed {
    /// The number of faces at the end.
    pub faces: usize,
    /// The number of split edges.
    pub splits: usize,
    /// The number of collapsed edges.
    pub collapses: usize,
    /// The number of flips.
    pub flips: usize,
    /// The number of finished iterations.
    pub iterations: usize,
    /// The reason why remeshing ended.
    pub stop: Stop,
}

/// Makes all edges about `edge_length` long, and brings valences closer to six.
///
/// Each iteration has four passes (Botsch & Kobbelt 2004, but without the projection of the
/// vertices to the original surface):
///
/// 1. Split edges longer than 4/3 of the target length in the middle.
/// 2. Collapse edges shorter than 4/5 of the target length, unless this makes an edge longer than
///    4/3 of the target length.
/// 3. Flip edges if this brings valences closer to six, or to four on a boundary.
/// 4. Move inner vertices within their tangent planes towards the middle of their neighbours.
///
/// Boundary vertices do not move. A boundary vertex is removed only if the boundary is straight at
/// this vertex. No pass turns a face over, and no collapse breaks the link condition. Sharp inner
/// edges become round, and the mesh shrinks at these edges by about the target length.
///
/// Remeshing ends early if an iteration changes almost nothing.
///
/// # Errors
///
/// Returns [`RemeshError`] in these cases:
///
/// - A face is not a triangle.
/// - A position is not finite.
/// - The edge length is not a finite positive number.
/// - The edge length is too short for the precision of the positions.
/// - The edge length needs more faces than the options allow. The number of faces is estimated from
///   the area and from the edges to be split.
///
/// After an error, the mesh is unchanged.
///
/// # Complexity
///
/// Each iteration takes O(edges log edges) time, plus the structure's cost of the queries and of
/// one edit for each edge. The maximum number of faces limits the number of splits. The other
/// passes visit each edge or each vertex once. A collapse at a vertex with more than 64 edges (a hub)
/// visits all of them only if nothing at the other end forbids it. After 16 visited edges for each edge
/// of the mesh, such collapses wait for the next iteration.
pub fn remesh<M: MeshEdit>(mesh: &mut M, remeshing: &Remeshing) -> Result<Remeshed, RemeshError> {
    remesh_watched(mesh, remeshing, &mut |_| ControlFlow::Continue(()))
}

/// Remeshes like [`remesh`], and calls `watch` before each iteration with the number of finished
/// iterations. If `watch` returns `ControlFlow::Break`, the remeshing ends.
///
/// # Errors
///
/// Returns the errors of [`remesh`].
pub fn remesh_watched<M: MeshEdit>(
    mesh: &mut M,
    remeshing: &Remeshing,
    watch: &mut dyn FnMut(usize) -> ControlFlow<()>,
) -> Result<Remeshed, RemeshError> {
    let length = remeshing.edge_length;
    if !(length.is_finite() && length > 0.0) {
        return Err(RemeshError::BadLength { length });
    }
    let numbering = Numbering::new(mesh)?;
    let mut work = Work::new(mesh, numbering, length);
    // Uses the larger of two estimates of the number of faces: the area filled with equilateral
    // triangles, and triangles along the long edges. The second estimate is for faces with almost
    // no area.
    let area: f64 = mesh.faces().map(|f| cross(mesh, f).length() / 2.0).sum();
    let lengths = mesh.edges().map(|e| {
        let [a, b] = mesh.edge_vertices(e).map(|v| at(mesh, v));
        a.distance(b)
    });
    let along: f64 = lengths.filter(|&along| along > LONG * length).sum();
    let over_area = area / (length * length * 3_f64.sqrt() / 4.0);
    let faces = over_area.max(along / length * 2.0 / 3.0);
    let limit = remeshing.max_faces;
    if faces > limit as f64 {
        return Err(RemeshError::TooFine {
            length,
            faces,
            limit,
        });
    }
    check_precision(mesh, length)?;
    let mut report = Remeshed {
        faces: mesh.face_count(),
        splits: 0,
        collapses: 0,
        flips: 0,
        iterations: 0,
        stop: Stop::Done,
    };
    for done in 0..remeshing.iterations {
        if watch(done).is_break() {
            report.stop = Stop::Requested;
            break;
        }
        let (splits, complete) = work.split_long(mesh, limit);
        let collapses = work.collapse_short(mesh);
        let flips = work.equalize_valences(mesh);
        let moved = work.smooth(mesh);
        report.splits += splits;
        report.collapses += collapses;
        report.flips += flips;
        report.iterations += 1;
        report.faces = mesh.face_count();
        report.stop = if complete {
            Stop::Done
        } else {
            Stop::LimitReached
        };
        // A collapse makes room for more splits.
        let converged = splits + collapses + flips == 0 && moved <= TOLERANCE * length;
        if converged || (!complete && collapses == 0) {
            break;
        }
    }
    Ok(report)
}

/// Checks that positions are precise enough for edges of `length`.
fn check_precision<M: MeshEdit>(mesh: &M, length: f64) -> Result<(), RemeshError> {
    let coordinates = mesh
        .vertices()
        .map(|v| mesh.position(v).abs().max_element());
    let largest = coordinates.fold(0.0, f32::max);
    let step = f64::from(largest.next_up()) - f64::from(largest);
    let minimum = MIN_STEPS * step;
    if length < minimum {
        return Err(RemeshError::BelowPrecision {
            length,
            coordinate: f64::from(largest),
            step,
            minimum,
        });
    }
    Ok(())
}

struct Work<M: MeshEdit> {
    numbering: Numbering<M>,
    /// By number: how many edges of the vertex have one face. No edit makes an inner vertex a boundary
    /// vertex.
    boundary_edges: Vec<u32>,
    /// By number: the place on the curves. The edits keep the curves.
    curves: Vec<Curve>,
    /// Squared length above which an edge is split.
    long: f64,
    short: f64,
}

impl<M: MeshEdit> Work<M> {
    fn new(mesh: &M, numbering: Numbering<M>, length: f64) -> Self {
        let face_counts = mesh.edge_face_counts();
        let mut boundary_edges = vec![0; numbering.len()];
        let mut spokes = Vec::new();
        for e in mesh.edges().filter(|&e| face_counts[e] != 2) {
            let faces = match face_counts[e] {
                u8::MAX => mesh.edge_faces(e).count(),
                faces => usize::from(faces),
            };
            let faces = row(faces);
            for n in mesh.edge_vertices(e).map(|v| numbering.number(v)) {
                boundary_edges[n as usize] += u32::from(faces == 1);
                spokes.push([n, faces]);
            }
        }
        Self {
            boundary_edges,
            curves: curves(spokes, numbering.len()),
            numbering,
            long: (LONG * length) * (LONG * length),
            short: (SHORT * length) * (SHORT * length),
        }
    }

    fn is_boundary(&self, number: u32) -> bool {
        self.boundary_edges[number as usize] > 0
    }

    fn ends(&self, mesh: &M, ends: [u32; 2]) -> [DVec3; 2] {
        ends.map(|n| at(mesh, self.numbering.handle(n)))
    }

    fn length_squared(&self, mesh: &M, ends: [u32; 2]) -> f64 {
        let [a, b] = self.ends(mesh, ends);
        a.distance_squared(b)
    }

    /// Splits long edges, including new long edges. Returns the number of splits, and false if
    /// `max_faces` stopped the splits.
    fn split_long(&mut self, mesh: &mut M, max_faces: usize) -> (usize, bool) {
        let mut queue = self.numbering.edges(mesh);
        queue.retain(|&ends| self.length_squared(mesh, ends) > self.long);
        let mut splits = 0;
        let mut next = 0;
        while let Some(&ends) = queue.get(next) {
            next += 1;
            let Some(e) = self.numbering.edge(mesh, ends) else {
                continue;
            };
            if mesh.face_count() + 2 > max_faces {
                return (splits, false);
            }
            let [a, b] = self.ends(mesh, ends);
            let middle = ((a + b) / 2.0).as_vec3();
            // Because of rounding, a half can be as long as the whole edge.
            let whole = a.distance_squared(b);
            let halves = [a, b].map(|end| end.distance_squared(middle.as_dvec3()));
            if !halves.iter().all(|&half| half < whole && half > 0.0) {
                continue;
            }
            let faces = mesh.edge_faces(e).take(3).count();
            let Ok(m) = mesh.bisect_edge(e, middle) else {
                continue;
            };
            let number = self.numbering.push(m);
            self.boundary_edges.push(if faces == 1 { 2 } else { 0 });
            self.curves.push(match faces {
                2 => Curve::Off,
                _ => Curve::Inside,
            });
            splits += 1;
            let mut spokes: Vec<[u32; 2]> = mesh
                .vertex_vertices(m)
                .map(|v| [self.numbering.number(v), number])
                .collect();
            spokes.sort_unstable();
            spokes.retain(|&ends| self.length_squared(mesh, ends) > self.long);
            queue.extend(spokes);
        }
        (splits, true)
    }

    /// Returns the edges in the order in which they are collapsed. A collapse at a hub may visit all of its
    /// edges, so these come last: collapses around the hub lower its valence first.
    fn collapse_order(&self, mesh: &M, valences: &[u32]) -> Vec<[u32; 2]> {
        let is_at_hub = |ends: &[u32; 2]| ends.iter().any(|&n| valences[n as usize] > HUB);
        let mut edges = self.numbering.edges(mesh);
        edges.sort_by_key(is_at_hub);
        edges
    }

    /// Collapses short edges, unless an edge would become too long. Returns the number of
    /// collapses.
    fn collapse_short(&mut self, mesh: &mut M) -> usize {
        let mut valences = self.numbering.valences(mesh);
        let order = self.collapse_order(mesh, &valences);
        let mut visits = HUB_VISITS.saturating_mul(order.len());
        let mut collapses = 0;
        for ends in order {
            let Some(e) = self.numbering.edge(mesh, ends) else {
                continue;
            };
            if self.length_squared(mesh, ends) >= self.short {
                continue;
            }
            let Some((keep, to)) = self.collapse_target(mesh, e, ends) else {
                continue;
            };
            if !self.may_collapse(mesh, e, ends, to, &valences, &mut visits) {
                continue;
            }
            let place = to.as_vec3();
            if !place.is_finite() {
                continue;
            }
            let mut faces = 0;
            let mut apexes = Vec::with_capacity(2);
            for f in mesh.edge_faces(e) {
                faces += 1;
                let numbers = corners(mesh, f).map(|v| self.numbering.number(v));
                apexes.extend(numbers.into_iter().filter(|n| !ends.contains(n)));
            }
            if let Ok(kept) = mesh.collapse_edge(e, self.numbering.handle(keep), place) {
                self.numbering.set_handle(keep, kept);
                let [a, b] = ends.map(|n| n as usize);
                let keep = keep as usize;
                // An edge on the boundary is gone from both of its ends.
                let removed = if faces == 1 { 2 } else { 0 };
                self.boundary_edges[keep] =
                    (self.boundary_edges[a] + self.boundary_edges[b]).saturating_sub(removed);
                self.curves[keep] = self.curves[a].max(self.curves[b]);
                valences[keep] = (valences[a] + valences[b]).saturating_sub(2 + faces);
                for apex in apexes {
                    valences[apex as usize] = valences[apex as usize].saturating_sub(1);
                }
                self.numbering
                    .remove(if keep == a { ends[1] } else { ends[0] });
                collapses += 1;
            }
        }
        collapses
    }

    /// Returns whether an edge can collapse into the place `to`. The end with fewer edges is checked first.
    /// If the other end is a hub, its edges are visited only if they are not more than `visits`, from which
    /// they are subtracted.
    fn may_collapse(
        &self,
        mesh: &M,
        e: M::Edge,
        mut ends: [u32; 2],
        to: DVec3,
        valences: &[u32],
        visits: &mut usize,
    ) -> bool {
        let valence = |n: u32| valences[n as usize];
        if valence(ends[0]) > valence(ends[1]) {
            ends.reverse();
        }
        let [few, many] = ends.map(|n| self.numbering.handle(n));
        let is_hub = valence(ends[1]) > HUB;
        let stays_short = |end: M::Vertex, other: M::Vertex| {
            mesh.vertex_faces(end).all(|f| {
                let mut around = corners(mesh, f).into_iter();
                around.all(|u| {
                    u == end || u == other || at(mesh, u).distance_squared(to) <= self.long
                })
            })
        };
        let allows =
            |end, other| stays_short(end, other) && keeps_orientation_at(mesh, [end, other], to);
        let curve = |v| self.curves[self.numbering.number(v) as usize];
        if !allows(few, many)
            || M::CAPABILITIES.non_manifold_edges
                && !keeps_topology(mesh, e, [few, many], is_hub, curve)
        {
            return false;
        }
        if is_hub {
            let Some(rest) = visits.checked_sub(valence(ends[1]) as usize) else {
                return false;
            };
            *visits = rest;
        }
        allows(many, few)
    }

    /// Returns the end that remains and its new position, or `None` if the boundary would change
    /// its shape.
    fn collapse_target(&self, mesh: &M, e: M::Edge, ends: [u32; 2]) -> Option<(u32, DVec3)> {
        let [p, q] = self.ends(mesh, ends);
        match ends.map(|n| self.is_boundary(n)) {
            [false, false] => Some((ends[0], (p + q) / 2.0)),
            [true, false] => Some((ends[0], p)),
            [false, true] => Some((ends[1], q)),
            [true, true] if mesh.edge_faces(e).count() == 1 => {
                if self.is_straight(mesh, ends[1]) {
                    Some((ends[0], p))
                } else if self.is_straight(mesh, ends[0]) {
                    Some((ends[1], q))
                } else {
                    None
                }
            }
            [true, true] => None,
        }
    }

    fn is_straight(&self, mesh: &M, number: u32) -> bool {
        if self.boundary_edges[number as usize] != 2 {
            return false;
        }
        let v = self.numbering.handle(number);
        let from = at(mesh, v);
        let spokes = mesh
            .vertex_edges(v)
            .filter(|&e| mesh.edge_faces(e).count() == 1);
        let directions: Vec<DVec3> = spokes
            .map(|e| {
                let [a, b] = mesh.edge_vertices(e);
                (at(mesh, if a == v { b } else { a }) - from).normalize_or_zero()
            })
            .collect();
        matches!(directions[..], [one, other] if one.dot(other) <= -STRAIGHT)
    }

    /// Flips edges if this improves the valences. Returns the number of flips.
    fn equalize_valences(&mut self, mesh: &mut M) -> usize {
        let mut flips = 0;
        let mut valences = self.numbering.valences(mesh);
        for ends in self.numbering.edges(mesh) {
            let Some(e) = self.numbering.edge(mesh, ends) else {
                continue;
            };
            let handles = ends.map(|n| self.numbering.handle(n));
            let mut apexes = Vec::with_capacity(2);
            for f in mesh.edge_faces(e) {
                let [x, y, z] = corners(mesh, f);
                apexes.extend([x, y, z].into_iter().find(|v| !handles.contains(v)));
            }
            let &[c, d] = apexes.as_slice() else {
                continue;
            };
            let [a, b] = handles;
            let numbers = [a, b, c, d].map(|v| self.numbering.number(v) as usize);
            let excess = |n: usize| {
                let regular = if self.boundary_edges[n] > 0 { 4 } else { 6 };
                i64::from(valences[n]) - regular
            };
            let [va, vb, vc, vd] = numbers.map(excess);
            let before = va.pow(2) + vb.pow(2) + vc.pow(2) + vd.pow(2);
            let after = (va - 1).pow(2) + (vb - 1).pow(2) + (vc + 1).pow(2) + (vd + 1).pow(2);
            if after < before
                && flip_keeps_orientation(mesh, [a, b, c, d], e)
                && mesh.flip_edge(e).is_ok()
            {
                for (n, change) in numbers.into_iter().zip([-1, -1, 1, 1]) {
                    valences[n] = valences[n].saturating_add_signed(change);
                }
                flips += 1;
            }
        }
        flips
    }

    /// Moves inner vertices within their tangent planes. Returns the longest movement.
    fn smooth(&mut self, mesh: &mut M) -> f64 {
        let mut moves: Vec<(u32, DVec3)> = Vec::new();
        let mut vertices: Vec<u32> = mesh.vertices().map(|v| self.numbering.number(v)).collect();
        vertices.sort_unstable();
        for number in vertices.into_iter().filter(|&n| n != u32::MAX) {
            let v = self.numbering.handle(number);
            if self.is_boundary(number) {
                continue;
            }
            let from = at(mesh, v);
            // Sorted by vertex numbers, so that rounding is the same on every structure.
            let mut fan: Vec<([u32; 2], DVec3, DVec3)> = mesh
                .vertex_faces(v)
                .map(|f| {
                    let [_, p, q] = corners_from(mesh, f, v);
                    let ends = [p, q].map(|u| self.numbering.number(u));
                    let [p, q] = [p, q].map(|u| at(mesh, u));
                    (ends, (p - from).cross(q - from), p)
                })
                .collect();
            fan.sort_unstable_by_key(ends_of);
            let normal: DVec3 = fan.iter().map(|&(_, cross, _)| cross).sum();
            let middle = fan.iter().map(|&(.., p)| p).sum::<DVec3>() / fan.len() as f64;
            let Some(normal) = normal.try_normalize().filter(|_| !fan.is_empty()) else {
                continue;
            };
            let offset = middle - from;
            moves.push((number, from + offset - normal * normal.dot(offset)));
        }
        let mut longest: f64 = 0.0;
        for (number, to) in moves {
            let v = self.numbering.handle(number);
            let place = to.as_vec3();
            if place.is_finite() && keeps_orientation(mesh, [v, v], to) {
                longest = longest.max(at(mesh, v).distance(to));
                self.numbering.set_position(mesh, number, place);
            }
        }
        longest
    }
}

/// A function of its own, so that the sort is compiled once for all structures.
fn ends_of(&(ends, ..): &([u32; 2], DVec3, DVec3)) -> [u32; 2] {
    ends
}

/// Returns the normal of a face; its length is twice the area.
fn cross<M: MeshEdit>(mesh: &M, f: M::Face) -> DVec3 {
    let [a, b, c] = corners(mesh, f).map(|v| at(mesh, v));
    (b - a).cross(c - a)
}

/// Returns whether both triangles of the flipped edge would face in the direction of the old
/// normals.
fn flip_keeps_orientation<M: MeshEdit>(mesh: &M, quad: [M::Vertex; 4], e: M::Edge) -> bool {
    let normal_sum: DVec3 = mesh.edge_faces(e).map(|f| cross(mesh, f)).sum();
    let [a, b, c, d] = quad.map(|v| at(mesh, v));
    // The result is the same if the two new triangles are exchanged.
    let new = [(d - a).cross(c - a), (c - b).cross(d - b)];
    let signs = new.map(|n| n.dot(normal_sum));
    signs.iter().all(|&s| s > 0.0) || signs.iter().all(|&s| s < 0.0)
}

#[cfg(test)]
mod tests;
