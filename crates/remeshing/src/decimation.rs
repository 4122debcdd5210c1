//! Edge collapse by quadric error (Garland & Heckbert 1997).

use std::ops::ControlFlow;

use glam::DVec3;
use sixfold_core::{MeshEdit, Point, row};

use crate::Stop;
use crate::deviation::Deviation;
use crate::error::RemeshError;
use crate::numbering::{Numbering, corners};
use crate::quadric::{Packed, Quadric};
use crate::queue::{Entry, Queue};
use crate::rules::{Curve, HUB, curves, keeps_orientation_at, keeps_topology};

/// Weight of a plane through a boundary edge or an edge with three or more faces, relative to the plane
/// of a face.
const BOUNDARY_WEIGHT: f64 = 100.0;

/// Number of tried edges between two calls of `watch`. An edge at a hub counts as several.
const WATCH_INTERVAL: usize = 1024;

/// Number of edges at hubs that may be visited, for each edge of the mesh, until the other edges have
/// been tried.
const HUB_VISITS: usize = 256;

/// If the distance is limited, a vertex with more edges than this stays in its place, so that the surface
/// is not searched around all of it.
const LARGE_HUB: u32 = 16 * HUB;

/// Visits that the distance around one edge of a hub counts as.
const DISTANCE_VISITS: usize = 16;

/// The edges of a hub are tried again after this part of them has been collapsed.
const HUB_PART: u32 = 16;

/// The target of a decimation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// This number of faces. The result can have fewer faces, because a collapse can remove two faces,
    /// or more at an edge with more faces.
    Faces(usize),
    /// This fraction of the faces of the input, from 0 to 1.
    Ratio(f64),
}

impl Target {
    /// Returns the target number of faces for a mesh with `faces` faces.
    ///
    /// # Errors
    ///
    /// Returns [`RemeshError::BadRatio`] if the ratio is not from 0 to 1.
    pub fn face_count(self, faces: usize) -> Result<usize, RemeshError> {
        match self {
            Self::Faces(target) => Ok(target),
            Self::Ratio(ratio) if (0.0..=1.0).contains(&ratio) => {
                Ok((faces as f64 * ratio) as usize)
            }
            Self::Ratio(ratio) => Err(RemeshError::BadRatio { ratio }),
        }
    }
}

sixfold_core::named! {
    /// The treatment of vertices on boundary edges.
    #[derive(Default)]
    pub enum DecimationBoundary: "boundary rule" {
        /// The boundary is simplified like the surface. Planes perpendicular to the surface
        /// preserve the shape of the boundary.
        #[default]
        Follow = "follow",
        /// Boundary vertices do not move.
        Fixed = "fixed",
    }
}

/// The options of a decimation. By default, half of the faces remain, the boundary is simplified, and
/// the surface may deviate by any distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decimation {
    /// The number of faces to keep.
    pub target: Target,
    /// The treatment of vertices on boundary edges.
    pub boundary: DecimationBoundary,
    /// The largest distance between the input and the result, in units of the coordinates; `None` for
    /// any distance. The distance is checked at the vertices, the middles of the edges and the
    /// centroids of the faces of both: a collapse is refused if one of them would be farther than this
    /// from the other mesh. The time per collapse then grows with the number of vertices that were
    /// merged around the edge.
    pub max_distance: Option<f64>,
}

impl Default for Decimation {
    fn default() -> Self {
        Self {
            target: Target::Ratio(0.5),
            boundary: DecimationBoundary::Follow,
            max_distance: None,
        }
    }
}

/// The result of a decimation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Decimated {
    /// The number of faces that remain.
    pub faces: usize,
    /// The number of collapsed edges.
    pub collapses: usize,
    /// The number of refused collapses. A collapse is refused if the collapse is illegal, would turn a
    /// face over, or would exceed the largest distance.
    pub refused: usize,
    /// A hash of the ends of the refused collapses, in order; 0 if no collapse was refused. Two
    /// decimations of one mesh that refuse different collapses have different hashes.
    pub refused_hash: u64,
    /// The largest error of a collapse. The error is a sum of squared distances to the planes of
    /// faces. Each squared distance is multiplied by the area of its face.
    pub max_error: f64,
    /// The largest distance of a vertex, of the middle of an edge or of the centroid of a face of the
    /// input from the result; `None` if the options have no largest distance.
    pub max_distance: Option<f64>,
    /// The reason why the decimation ended.
    pub stop: Stop,
}

/// Collapses the edges with the lowest error, until the mesh has the target number of faces or no
/// legal collapse is left.
///
/// The error of a vertex is a sum over faces of the input: the faces of the vertex, and the faces
/// of all vertices that were merged into the vertex. Each face contributes the squared distance to
/// its plane, multiplied by the area of the face. The merged vertex is placed where the sum of the
/// errors of both ends is least. If the sum is least at many points, the merged vertex is placed at
/// the best of three points: the two ends and their midpoint. Boundary edges and edges with three or
/// more faces add planes perpendicular to their faces, which preserve the shape of these curves. A
/// collapse is refused if it would turn a face over or break the link condition
/// ([`meets_link_condition`](crate::meets_link_condition)), or if the surface would deviate by more
/// than the largest distance. A refused collapse is tried again after an end of the edge has changed.
///
/// A vertex with more than 64 edges is a hub. The edges of a hub are tried again only after a sixteenth
/// of them has been collapsed. If they took very long already (256 visited edges for each edge of the
/// mesh), they are tried after all other edges, and from then on hubs stay in their place: the attempt
/// takes the time of the other end, and two hubs do not merge. If the distance is limited, a hub with more
/// than 1024 edges stays in its place from the beginning.
///
/// Errors are rounded into buckets, so that the errors in one bucket differ by at most an eighth. A
/// round collapses all edges of the bucket with the lowest errors, in the order of their vertex
/// numbers.
///
/// # Errors
///
/// Returns [`RemeshError`] if a face is not a triangle, if a position is not finite, if the ratio is
/// not from 0 to 1, or if the largest distance is not a number of at least 0. The mesh is then
/// unchanged.
///
/// # Complexity
///
/// O(edges log edges) time, plus the structure's cost of the queries VF and VV and of
/// `collapse_edge` for each collapse. If the structure scans all faces, each collapse takes
/// O(faces) time. The number of collapses is less than the number of faces.
pub fn decimate<M: MeshEdit>(
    mesh: &mut M,
    decimation: &Decimation,
) -> Result<Decimated, RemeshError> {
    decimate_watched(mesh, decimation, &mut |_| ControlFlow::Continue(()))
}

/// Decimates like [`decimate`], and calls `watch` with the current number of faces after every 1024
/// edges that were collapsed or refused, and earlier if these have ends with very many edges. If `watch`
/// returns `ControlFlow::Break`, the decimation ends.
///
/// # Errors
///
/// Returns the errors of [`decimate`].
pub fn decimate_watched<M: MeshEdit>(
    mesh: &mut M,
    decimation: &Decimation,
    watch: &mut dyn FnMut(usize) -> ControlFlow<()>,
) -> Result<Decimated, RemeshError> {
    let target = decimation.target.face_count(mesh.face_count())?;
    let mut work = Work::new(mesh, decimation.boundary)?;
    if let Some(limit) = decimation.max_distance {
        let positions = work.vertices.iter().map(|vertex| vertex.at).collect();
        work.deviation = Some(Deviation::new(mesh, &work.numbering, positions, limit)?);
    }
    let mut report = Decimated {
        faces: mesh.face_count(),
        collapses: 0,
        refused: 0,
        refused_hash: 0,
        max_error: 0.0,
        max_distance: None,
        stop: Stop::Done,
    };
    if report.faces > target {
        work.fill_queue(mesh);
    }
    let mut tried = 0;
    while report.faces > target {
        let Some((entry, valence)) = work.next_entry() else {
            report.stop = Stop::NoLegalEdit;
            break;
        };
        if tried >= WATCH_INTERVAL {
            tried = 0;
            if watch(report.faces).is_break() {
                report.stop = Stop::Requested;
                break;
            }
        }
        tried += 1 + (valence / HUB) as usize;
        let Some(error) = work.collapse(mesh, &entry) else {
            report.refused += 1;
            // A polynomial of the ends, modulo 2⁶⁴. The odd factor mixes the order in.
            let [a, b] = entry.ends.map(u64::from);
            let hash = report.refused_hash.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            report.refused_hash = hash.wrapping_add((a << 32 | b) + 1);
            continue;
        };
        report.max_error = report.max_error.max(error);
        report.faces = mesh.face_count();
        report.collapses += 1;
    }
    // Areas and squared distances were computed in a box of unit size.
    report.max_error *= work.size.powi(4);
    let deviation = work.deviation.as_ref();
    report.max_distance = deviation.map(|deviation| deviation.largest(mesh, &work.numbering));
    Ok(report)
}

/// The data of a vertex. It fits in one cache line, because a collapse reads all vertices around an
/// edge.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct Vertex {
    /// The quadric in the unit box; its origin is the vertex itself.
    quadric: Packed,
    at: Point,
    /// Changes when the vertex changes.
    version: u32,
    /// The number of edges when they were last added to the queue.
    valence: u32,
    /// For a hub: the number of collapses until all of its edges are added to the queue again.
    wait: u16,
    /// Whether the vertex must not move.
    fixed: bool,
    /// The place on the curves. A collapse that meets the link condition keeps the curves.
    curve: Curve,
}

impl Vertex {
    fn is_hub(&self) -> bool {
        self.valence > HUB
    }

    fn set_valence(&mut self, valence: u32) {
        self.valence = valence;
        self.wait = u16::try_from(valence / HUB_PART).unwrap_or(u16::MAX);
    }
}

struct Work<M: MeshEdit> {
    numbering: Numbering<M>,
    vertices: Vec<Vertex>,
    queue: Queue,
    /// Edges at hubs that are tried after the other edges.
    last: Vec<Entry>,
    /// The number of edges at hubs that may be visited until `hubs_stay`.
    visits: usize,
    /// Whether `last` is being tried, and hubs do not move.
    hubs_stay: bool,
    /// The distance to the input, if it is limited.
    deviation: Option<Deviation>,
    /// The size of the mesh. Positions are divided by this size.
    size: f64,
}

impl<M: MeshEdit> Work<M> {
    fn new(mesh: &M, boundary: DecimationBoundary) -> Result<Self, RemeshError> {
        let numbering = Numbering::new(mesh)?;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut vertices = Vec::with_capacity(numbering.len());
        for number in 0..row(numbering.len()) {
            let at = mesh.position(numbering.handle(number));
            low = low.min(at.as_dvec3());
            high = high.max(at.as_dvec3());
            vertices.push(Vertex {
                at,
                ..Vertex::default()
            });
        }
        let size = (high - low).max_element();
        let mut work = Self {
            numbering,
            vertices,
            queue: Queue::new(),
            last: Vec::new(),
            visits: 0,
            hubs_stay: false,
            deviation: None,
            size: if size > 0.0 { size } else { 1.0 },
        };
        work.add_planes(mesh, boundary);
        Ok(work)
    }

    /// Adds the planes of the faces, and the planes at the boundary and at edges with three or more
    /// faces, to the quadrics of their vertices. The origin of each quadric is its vertex.
    fn add_planes(&mut self, mesh: &M, boundary: DecimationBoundary) {
        let face_counts = mesh.edge_face_counts();
        let mut quadrics = vec![Quadric::default(); self.vertices.len()];
        let mut boundary_planes: Vec<([u32; 2], Quadric)> = Vec::new();
        let mut curve_sides: Vec<[u32; 2]> = Vec::new();
        for f in mesh.faces() {
            let mut numbers = corners(mesh, f).map(|v| self.numbering.number(v));
            // Starts at the lowest number, so that rounding is the same on every structure.
            let least = (0..3).min_by_key(|&i| numbers[i]).unwrap_or(0);
            numbers.rotate_left(least);
            let [a, b, c] = numbers;
            let cross = self.offset(a, b).cross(self.offset(a, c));
            let normal = cross.try_normalize();
            if let Some(normal) = normal {
                let plane = Quadric::plane(normal, cross.length() / 2.0);
                for n in numbers {
                    quadrics[n as usize] += plane;
                }
            }
            for e in mesh.face_edges(f).filter(|&e| face_counts[e] != 2) {
                let (i, j) = self.ends(mesh, e);
                curve_sides.push([i, j]);
                let Some(normal) = normal else {
                    continue;
                };
                let along = self.offset(i, j);
                if let Some(normal) = along.cross(normal).try_normalize() {
                    let weight = BOUNDARY_WEIGHT * along.length_squared();
                    boundary_planes.push(([i, j], Quadric::plane(normal, weight)));
                }
                if face_counts[e] == 1 && boundary == DecimationBoundary::Fixed {
                    self.vertices[i as usize].fixed = true;
                    self.vertices[j as usize].fixed = true;
                }
            }
        }
        self.set_curves(curve_sides);
        // Sorted, because the order of the edges of a face depends on the structure.
        boundary_planes.sort_by_key(ends_of);
        for (ends, plane) in boundary_planes {
            for n in ends {
                quadrics[n as usize] += plane;
            }
        }
        for (vertex, quadric) in self.vertices.iter_mut().zip(quadrics) {
            vertex.quadric = quadric.into();
        }
    }

    /// Sets the places of the vertices on curves, from the sides of the faces along curves.
    fn set_curves(&mut self, mut sides: Vec<[u32; 2]>) {
        sides.sort_unstable();
        let edges = sides.chunk_by(|one, other| one == other);
        let spokes = edges.flat_map(|edge| edge[0].map(|n| [n, row(edge.len())]));
        let curves = curves(spokes.collect(), self.vertices.len());
        for (vertex, curve) in self.vertices.iter_mut().zip(curves) {
            vertex.curve = curve;
        }
    }

    /// Returns the vector from one vertex to another, in the unit box.
    #[inline]
    fn offset(&self, a: u32, b: u32) -> DVec3 {
        let [p, q] = [a, b].map(|n| self.vertices[n as usize].at.as_dvec3());
        (q - p) / self.size
    }

    fn ends(&self, mesh: &M, e: M::Edge) -> (u32, u32) {
        let [a, b] = mesh.edge_vertices(e).map(|v| self.numbering.number(v));
        (a.min(b), a.max(b))
    }

    fn fill_queue(&mut self, mesh: &M) {
        let mut valences = vec![0; self.vertices.len()];
        for e in mesh.edges() {
            let (a, b) = self.ends(mesh, e);
            self.push_edge(a, b);
            for n in [a, b] {
                valences[n as usize] += 1;
            }
            self.visits += HUB_VISITS;
        }
        for (vertex, valence) in self.vertices.iter_mut().zip(valences) {
            vertex.set_valence(valence);
        }
    }

    /// Returns the next edge to try and the valence of its ends. The visits of hubs must not take most
    /// of the time. Therefore, edges at hubs wait for the other edges after very many visits, and then hubs
    /// stay in their place, so that they are not visited.
    fn next_entry(&mut self) -> Option<(Entry, u32)> {
        loop {
            let Some(entry) = self.queue.pop() else {
                if self.last.is_empty() {
                    return None;
                }
                self.hubs_stay = true;
                for entry in std::mem::take(&mut self.last) {
                    if self.is_current(&entry) {
                        let [a, b] = entry.ends;
                        self.push_edge(a, b);
                    }
                }
                continue;
            };
            if !self.is_current(&entry) {
                continue;
            }
            let [a, b] = entry.ends.map(|n| self.vertices[n as usize].valence);
            let valence = a.max(b);
            if valence <= HUB || self.hubs_stay {
                return Some((entry, valence));
            }
            match self.visits.checked_sub(valence as usize) {
                Some(rest) => {
                    self.visits = rest;
                    return Some((entry, valence));
                }
                None => self.last.push(entry),
            }
        }
    }

    /// Adds an edge to the queue, unless both ends are fixed.
    #[inline]
    fn push_edge(&mut self, a: u32, b: u32) {
        let ends = [a.min(b), a.max(b)];
        if let Some(Placement { error, .. }) = self.best_placement(ends) {
            let version = self.version(ends);
            self.queue.push(error as f32, Entry { ends, version });
        }
    }

    /// Returns the sum of the versions of both ends.
    #[inline]
    fn version(&self, ends: [u32; 2]) -> u32 {
        let [a, b] = ends.map(|n| self.vertices[n as usize].version);
        a.wrapping_add(b)
    }

    /// Returns whether both ends of `entry` are unchanged.
    fn is_current(&self, entry: &Entry) -> bool {
        self.version(entry.ends) == entry.version
    }

    /// Returns whether a vertex must not move.
    #[inline]
    fn is_fixed(&self, vertex: &Vertex) -> bool {
        let stays = || self.hubs_stay || self.deviation.is_some() && vertex.valence > LARGE_HUB;
        vertex.fixed || vertex.is_hub() && stays()
    }

    /// Returns the best place for the merged vertex, or `None` if both ends are fixed.
    #[inline]
    fn best_placement(&self, [a, b]: [u32; 2]) -> Option<Placement> {
        let [p, q] = [a, b].map(|n| &self.vertices[n as usize]);
        let edge = self.offset(a, b);
        let sum = Quadric::from(p.quadric).plus(&Quadric::from(q.quadric).with_origin(-edge));
        let at = |offset: DVec3| Placement {
            offset,
            error: sum.value(offset),
            sum,
        };
        match [p, q].map(|vertex| self.is_fixed(vertex)) {
            [true, true] => return None,
            [true, false] => return Some(at(DVec3::ZERO)),
            [false, true] => return Some(at(edge)),
            [false, false] => {}
        }
        let middle = edge / 2.0;
        // A place far from the edge is caused by rounding.
        let max_distance_squared = 4.0 * edge.length_squared();
        let minimizer = sum
            .minimizer()
            .filter(|x| x.distance_squared(middle) <= max_distance_squared);
        if let Some(x) = minimizer {
            return Some(at(x));
        }
        // Does not copy `sum`: a processor would stall when it reads such a copy.
        let mut best = (sum.value(middle), middle);
        for offset in [DVec3::ZERO, edge] {
            let error = sum.value(offset);
            if error < best.0 {
                best = (error, offset);
            }
        }
        Some(at(best.1))
    }

    /// Collapses the edge of `entry` if possible, and returns the error of the collapse.
    fn collapse(&mut self, mesh: &mut M, entry: &Entry) -> Option<f64> {
        let mut ends = entry.ends;
        let [first, second] = ends.map(|n| self.vertices[n as usize].valence);
        // A hub stays, so that its edges do not change.
        if second > first.max(HUB) {
            ends.reverse();
        }
        let [a, b] = ends;
        let [p, q] = ends.map(|n| self.vertices[n as usize]);
        let e = match p.is_hub() {
            true => self.numbering.edge(mesh, [b, a])?,
            false => self.numbering.edge(mesh, [a, b])?,
        };
        let placement = self.best_placement(ends)?;
        // A fixed end keeps its exact position.
        let to = match [&p, &q].map(|vertex| self.is_fixed(vertex)) {
            [true, _] => p.at,
            [_, true] => q.at,
            _ => (p.at.as_dvec3() + placement.offset * self.size).as_vec3(),
        };
        let [kept, gone] = ends.map(|n| self.numbering.handle(n));
        let curve = |v| self.vertices[self.numbering.number(v) as usize].curve;
        let place = to.as_dvec3();
        let moves = to != p.at;
        let is_legal = (!M::CAPABILITIES.non_manifold_edges
            || keeps_topology(mesh, e, [gone, kept], p.is_hub(), curve))
            && keeps_orientation_at(mesh, [gone, kept], place)
            && (!moves || keeps_orientation_at(mesh, [kept, gone], place));
        if !is_legal {
            return None;
        }
        if self.deviation.is_some() && moves && p.is_hub() {
            let visits = DISTANCE_VISITS * p.valence as usize;
            self.visits = self.visits.saturating_sub(visits);
        }
        if let Some(deviation) = &mut self.deviation
            && !deviation.allows(mesh, &self.numbering, ends, to, |n| {
                self.vertices[n as usize].is_hub()
            })
        {
            return None;
        }
        // All edges of a hub are added to the queue rarely, the edges that it receives at once.
        let waits = p.is_hub() && p.wait > 1 && !q.is_hub();
        let received: Vec<u32> = match waits {
            true => mesh
                .vertex_vertices(gone)
                .map(|v| self.numbering.number(v))
                .collect(),
            false => Vec::new(),
        };
        let kept = mesh.collapse_edge(e, kept, to).ok()?;
        if let Some(deviation) = &mut self.deviation {
            deviation.merge();
        }
        self.numbering.set_handle(a, kept);
        self.numbering.remove(b);
        // The position is stored as f32, so it is not exactly the best place.
        let offset = (to.as_dvec3() - p.at.as_dvec3()) / self.size;
        self.vertices[a as usize] = Vertex {
            quadric: placement.sum.with_origin(offset).into(),
            at: to,
            version: p.version.wrapping_add(u32::from(!waits)),
            wait: p.wait.saturating_sub(1),
            fixed: p.fixed || q.fixed,
            curve: p.curve.max(q.curve),
            ..p
        };
        // Outdates all entries with the removed end. Numbers are not reused.
        self.vertices[b as usize].version = q.version.wrapping_add(1);
        if waits {
            for n in received.into_iter().filter(|&n| n != a) {
                self.push_edge(a, n);
            }
        } else {
            let mut valence = 0;
            for v in mesh.vertex_vertices(kept) {
                self.push_edge(a, self.numbering.number(v));
                valence += 1;
            }
            self.vertices[a as usize].set_valence(valence);
        }
        Some(placement.error)
    }
}

/// The best place for a merged vertex.
#[derive(Clone, Copy, Debug)]
struct Placement {
    offset: DVec3,
    error: f64,
    /// The sum of the quadrics of both ends, with its origin at the first end.
    sum: Quadric,
}

/// A function of its own, so that the sort is compiled once for all structures.
fn ends_of(&(ends, _): &([u32; 2], Quadric)) -> [u32; 2] {
    ends
}

#[cfg(test)]
pub(crate) mod tests;
