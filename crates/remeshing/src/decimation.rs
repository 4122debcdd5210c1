//! Edge collapse by quadric error (Garland & Heckbert 1997).

use std::ops::ControlFlow;

use glam::DVec3;
use mesh_core::{MeshEdit, Point, Representation, row};

use crate::Stop;
use crate::error::RemeshError;
use crate::numbering::{Numbering, corners};
use crate::quadric::{Packed, Quadric};
use crate::queue::{Entry, Queue};
use crate::rules::{keeps_link, turns_nothing_over};

/// How much more a plane through a boundary edge weighs than a face beside it.
const BOUNDARY_WEIGHT: f64 = 100.0;

/// How many collapses go between two looks of whoever watches.
const WATCHED_EVERY: usize = 1024;

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Down to so many faces, or one fewer: a collapse takes two at a time.
    Faces(usize),
    /// Down to this part of the faces there are; from 0 to 1.
    Ratio(f64),
}

impl Target {
    /// How many faces that is of so many.
    ///
    /// # Errors
    ///
    /// [`RemeshError::BadRatio`] for a ratio that is none.
    pub fn of(self, faces: usize) -> Result<usize, RemeshError> {
        match self {
            Self::Faces(target) => Ok(target),
            Self::Ratio(ratio) if (0.0..=1.0).contains(&ratio) => {
                Ok((faces as f64 * ratio) as usize)
            }
            Self::Ratio(ratio) => Err(RemeshError::BadRatio { ratio }),
        }
    }
}

/// What becomes of vertices on boundary edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// The boundary is simplified as the surface is, and pulled at by planes across it.
    #[default]
    Follow,
    /// Its vertices stay.
    Fixed,
}

/// How to decimate. The default is to half of the faces, the boundary simplified too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decimation {
    /// How far.
    pub target: Target,
    /// What becomes of the boundary.
    pub boundary: Boundary,
}

impl Default for Decimation {
    fn default() -> Self {
        Self {
            target: Target::Ratio(0.5),
            boundary: Boundary::Follow,
        }
    }
}

/// What a decimation came to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Decimated {
    /// The faces that are left.
    pub faces: usize,
    /// How many edges were collapsed.
    pub collapses: usize,
    /// How many collapses were refused: illegal, or turning a face over.
    pub refused: usize,
    /// The greatest quadric error of a collapse: squared distances to the planes of the faces, each
    /// by its area.
    pub worst: f64,
    /// Why it ended.
    pub stop: Stop,
}

/// Collapses edges, the least harmful first, until the target is reached or no collapse is left.
///
/// The error of a vertex is the sum of squared distances to the planes of the faces it stands for,
/// each by the area of the face; the vertex that two become stands where the sum of both errors is
/// least, or at the best of the two and their midpoint where no one place is. Boundary edges bring
/// planes across the surface, so that outlines stay. A collapse that would turn a face over, or
/// break the link condition, is left out, and comes again when something around it has changed.
///
/// Errors that differ by less than an eighth count as the same, and edges of the same error go in
/// rounds, in the order of the mesh. The queue is updated lazily: an entry whose ends have changed
/// since is dropped when it comes.
///
/// # Errors
///
/// [`RemeshError`]: a polygon, a vertex that is nowhere, a ratio that is none. Nothing has changed then.
///
/// # Complexity
///
/// O(edges log edges) and the structure's cost of VF, VV and `collapse_edge` for each collapse: on
/// structures that scan, O(faces) each. Every collapse takes a face away, so there is an end.
pub fn decimate<M: MeshEdit + Representation>(
    mesh: &mut M,
    decimation: &Decimation,
) -> Result<Decimated, RemeshError> {
    decimate_watched(mesh, decimation, &mut |_| ControlFlow::Continue(()))
}

/// As [`decimate`]; every thousand collapses `watch` is told the number of faces, and may end it.
///
/// # Errors
///
/// Those of [`decimate`].
pub fn decimate_watched<M: MeshEdit + Representation>(
    mesh: &mut M,
    decimation: &Decimation,
    watch: &mut dyn FnMut(usize) -> ControlFlow<()>,
) -> Result<Decimated, RemeshError> {
    let target = decimation.target.of(mesh.face_count())?;
    let mut work = Work::of(mesh, decimation.boundary)?;
    let mut report = Decimated {
        faces: mesh.face_count(),
        collapses: 0,
        refused: 0,
        worst: 0.0,
        stop: Stop::Done,
    };
    if report.faces > target {
        work.fill_queue(mesh);
    }
    while report.faces > target {
        let Some(entry) = work.queue.pop() else {
            report.stop = Stop::NothingLeft;
            break;
        };
        if !work.is_fresh(&entry) {
            continue;
        }
        let Some(error) = work.collapse(mesh, &entry) else {
            report.refused += 1;
            continue;
        };
        report.worst = report.worst.max(error);
        report.faces = mesh.face_count();
        report.collapses += 1;
        if report.collapses.is_multiple_of(WATCHED_EVERY) && watch(report.faces).is_break() {
            report.stop = Stop::Asked;
            break;
        }
    }
    // Weights and distances were taken in a box of unit size.
    report.worst *= work.size.powi(4);
    Ok(report)
}

/// What there is to know of a vertex: one cache line, for a collapse looks at vertices all around.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct Vertex {
    /// From the vertex itself, in the unit box.
    quadric: Packed,
    at: Point,
    /// Changes when the vertex does.
    version: u32,
    /// Whether it stays where it is.
    fixed: bool,
}

struct Work<M: MeshEdit> {
    numbering: Numbering<M>,
    vertices: Vec<Vertex>,
    queue: Queue,
    /// The mesh fits a unit box once it is divided by this.
    size: f64,
}

impl<M: MeshEdit + Representation> Work<M> {
    fn of(mesh: &M, boundary: Boundary) -> Result<Self, RemeshError> {
        let numbering = Numbering::of(mesh)?;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut vertices = Vec::with_capacity(numbering.len());
        for number in 0..row(numbering.len()) {
            let at = mesh.position(numbering.name(number));
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
            size: if size > 0.0 { size } else { 1.0 },
        };
        work.add_planes(mesh, boundary);
        Ok(work)
    }

    /// Gives each vertex the planes of its faces and, where there is a boundary, those across it. All
    /// go through the vertex, from which its quadric is told.
    fn add_planes(&mut self, mesh: &M, boundary: Boundary) {
        // How many faces each edge has, by a pass over the faces: what no structure searches for.
        let mut uses = mesh.edge_map(0_u8);
        for f in mesh.faces() {
            for e in mesh.face_edges(f) {
                uses[e] = uses[e].saturating_add(1);
            }
        }
        let mut quadrics = vec![Quadric::default(); self.vertices.len()];
        let mut across: Vec<([u32; 2], Quadric)> = Vec::new();
        for f in mesh.faces() {
            let mut numbers = corners(mesh, f).map(|v| self.numbering.number(v));
            // From the least number on, so that rounding is the same on every structure.
            let least = (0..3).min_by_key(|&i| numbers[i]).unwrap_or(0);
            numbers.rotate_left(least);
            let [a, b, c] = numbers;
            let cross = self.way(a, b).cross(self.way(a, c));
            let Some(normal) = cross.try_normalize() else {
                continue;
            };
            let plane = Quadric::plane(normal, cross.length() / 2.0);
            for n in numbers {
                quadrics[n as usize] += plane;
            }
            for e in mesh.face_edges(f) {
                let (i, j) = self.ends(mesh, e);
                if uses[e] == 1 {
                    let along = self.way(i, j);
                    if let Some(normal) = along.cross(normal).try_normalize() {
                        let weight = BOUNDARY_WEIGHT * along.length_squared();
                        across.push(([i, j], Quadric::plane(normal, weight)));
                    }
                    if boundary == Boundary::Fixed {
                        self.vertices[i as usize].fixed = true;
                        self.vertices[j as usize].fixed = true;
                    }
                }
            }
        }
        // The sides of a face come in an order of the structure's own.
        across.sort_by_key(|&(ends, _)| ends);
        for (ends, plane) in across {
            for n in ends {
                quadrics[n as usize] += plane;
            }
        }
        for (vertex, quadric) in self.vertices.iter_mut().zip(quadrics) {
            vertex.quadric = quadric.into();
        }
    }

    /// The way from one vertex to another, in the unit box.
    #[inline]
    fn way(&self, a: u32, b: u32) -> DVec3 {
        let [p, q] = [a, b].map(|n| self.vertices[n as usize].at.as_dvec3());
        (q - p) / self.size
    }

    fn ends(&self, mesh: &M, e: M::Edge) -> (u32, u32) {
        let [a, b] = mesh.edge_vertices(e).map(|v| self.numbering.number(v));
        (a.min(b), a.max(b))
    }

    fn fill_queue(&mut self, mesh: &M) {
        for e in mesh.edges() {
            let (a, b) = self.ends(mesh, e);
            self.put(a, b);
        }
    }

    /// Puts an edge into the queue, unless both ends are fixed.
    #[inline]
    fn put(&mut self, a: u32, b: u32) {
        let ends = [a.min(b), a.max(b)];
        if let Some(Best { error, .. }) = self.best(ends) {
            let version = self.version(ends);
            self.queue.push(error as f32, Entry { ends, version });
        }
    }

    /// The sum of both versions.
    #[inline]
    fn version(&self, ends: [u32; 2]) -> u32 {
        let [a, b] = ends.map(|n| self.vertices[n as usize].version);
        a.wrapping_add(b)
    }

    fn is_fresh(&self, entry: &Entry) -> bool {
        self.version(entry.ends) == entry.version
    }

    /// Where the two ends should meet.
    #[inline]
    fn best(&self, [a, b]: [u32; 2]) -> Option<Best> {
        let [p, q] = [a, b].map(|n| &self.vertices[n as usize]);
        let way = self.way(a, b);
        let sum = Quadric::from(p.quadric).plus(&Quadric::from(q.quadric).seen_from(-way));
        let at = |way: DVec3| Best {
            way,
            error: sum.at(way),
            sum,
        };
        match [p.fixed, q.fixed] {
            [true, true] => return None,
            [true, false] => return Some(at(DVec3::ZERO)),
            [false, true] => return Some(at(way)),
            [false, false] => {}
        }
        let middle = way / 2.0;
        // A place far from the edge is a matter of rounding, not of shape.
        let reach = 4.0 * way.length_squared();
        if let Some(x) = sum.least().filter(|x| x.distance_squared(middle) <= reach) {
            return Some(at(x));
        }
        let places = [middle, DVec3::ZERO, way].map(at);
        places
            .into_iter()
            .min_by(|x, y| x.error.total_cmp(&y.error))
    }

    /// Collapses the edge of `entry`, if it is there and may go; the error that this makes.
    fn collapse(&mut self, mesh: &mut M, entry: &Entry) -> Option<f64> {
        let [a, b] = entry.ends;
        let e = self.numbering.edge(mesh, entry.ends)?;
        let best = self.best(entry.ends)?;
        let [p, q] = [a, b].map(|n| self.vertices[n as usize]);
        // What is fixed stays to the bit.
        let to = match [p.fixed, q.fixed] {
            [true, _] => p.at,
            [_, true] => q.at,
            _ => (p.at.as_dvec3() + best.way * self.size).as_vec3(),
        };
        let ends = [a, b].map(|n| self.numbering.name(n));
        if !turns_nothing_over(mesh, ends, to.as_dvec3()) || !keeps_link(mesh, e) {
            return None;
        }
        let kept = mesh.collapse_edge(e, ends[0], to, &mut ()).ok()?;
        self.numbering.renamed(a, kept);
        self.numbering.remove(b);
        // As the structure holds it: rounded to singles.
        let way = (to.as_dvec3() - p.at.as_dvec3()) / self.size;
        self.vertices[a as usize] = Vertex {
            quadric: best.sum.seen_from(way).into(),
            at: to,
            version: p.version.wrapping_add(1),
            fixed: p.fixed || q.fixed,
        };
        // No number is used twice, so no entry of the end that is gone is fresh again.
        self.vertices[b as usize].version = q.version.wrapping_add(1);
        for v in mesh.vertex_vertices(kept) {
            self.put(a, self.numbering.number(v));
        }
        Some(best.error)
    }
}

/// Where the two ends of an edge should meet, from the first of them in the unit box.
#[derive(Clone, Copy, Debug)]
struct Best {
    way: DVec3,
    error: f64,
    /// Of both, from the first end.
    sum: Quadric,
}

#[cfg(test)]
mod tests;
