//! Edge collapse by quadric error (Garland & Heckbert 1997).

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::ControlFlow;

use glam::DVec3;
use mesh_core::{MeshEdit, Representation};

use crate::Stop;
use crate::error::RemeshError;
use crate::numbering::{Numbering, corners};
use crate::quadric::Quadric;
use crate::rules::{at, keeps_link, turns_nothing_over};

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
/// The queue is updated lazily: an entry whose ends have changed since is dropped when it comes.
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
        let Some(Reverse(entry)) = work.queue.pop() else {
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
    // Weights were taken in a box of unit size.
    report.worst *= work.size.powi(4);
    Ok(report)
}

/// An edge by the numbers of its ends, and what its collapse would cost when the entry was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    /// The bits of a float that is not negative: they order as it does.
    cost: u32,
    ends: [u32; 2],
    /// The sum of both ends' versions then: either has changed since if it is another now.
    version: u32,
}

struct Work<M: MeshEdit> {
    numbering: Numbering<M>,
    quadrics: Vec<Quadric>,
    versions: Vec<u32>,
    /// Which vertices stay where they are.
    fixed: Vec<bool>,
    queue: BinaryHeap<Reverse<Entry>>,
    /// The mesh fits a unit box around here, in which quadrics are kept: far from the origin squares
    /// would lose what distances are made of.
    centre: DVec3,
    size: f64,
}

impl<M: MeshEdit + Representation> Work<M> {
    fn of(mesh: &M, boundary: Boundary) -> Result<Self, RemeshError> {
        let numbering = Numbering::of(mesh)?;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for v in mesh.vertices() {
            low = low.min(at(mesh, v));
            high = high.max(at(mesh, v));
        }
        let size = (high - low).max_element();
        let mut work = Self {
            quadrics: vec![Quadric::default(); numbering.len()],
            versions: vec![0; numbering.len()],
            fixed: vec![false; numbering.len()],
            queue: BinaryHeap::new(),
            centre: (low + high) / 2.0,
            size: if size > 0.0 { size } else { 1.0 },
            numbering,
        };
        work.add_planes(mesh, boundary);
        Ok(work)
    }

    /// Gives each vertex the planes of its faces and, where there is a boundary, those across it.
    fn add_planes(&mut self, mesh: &M, boundary: Boundary) {
        // How many faces each edge has, by a pass over the faces: what no structure searches for.
        let mut uses = mesh.edge_map(0_u8);
        for f in mesh.faces() {
            for e in mesh.face_edges(f) {
                uses[e] = uses[e].saturating_add(1);
            }
        }
        let mut across: Vec<([u32; 2], Quadric)> = Vec::new();
        for f in mesh.faces() {
            let mut numbers = corners(mesh, f).map(|v| self.numbering.number(v));
            // From the least number on, so that rounding is the same on every structure.
            let least = (0..3).min_by_key(|&i| numbers[i]).unwrap_or(0);
            numbers.rotate_left(least);
            let [a, b, c] = numbers.map(|n| self.place(mesh, n));
            let cross = (b - a).cross(c - a);
            let Some(normal) = cross.try_normalize() else {
                continue;
            };
            let plane = Quadric::plane(normal, a, cross.length() / 2.0);
            for n in numbers {
                self.quadrics[n as usize] += plane;
            }
            for e in mesh.face_edges(f) {
                let (i, j) = self.ends(mesh, e);
                if uses[e] == 1 {
                    let [p, q] = [i, j].map(|n| self.place(mesh, n));
                    let along = q - p;
                    if let Some(normal) = along.cross(normal).try_normalize() {
                        let weight = BOUNDARY_WEIGHT * along.length_squared();
                        across.push(([i, j], Quadric::plane(normal, p, weight)));
                    }
                    if boundary == Boundary::Fixed {
                        self.fixed[i as usize] = true;
                        self.fixed[j as usize] = true;
                    }
                }
            }
        }
        // The sides of a face come in an order of the structure's own.
        across.sort_by_key(|&(ends, _)| ends);
        for (ends, plane) in across {
            for n in ends {
                self.quadrics[n as usize] += plane;
            }
        }
    }

    fn ends(&self, mesh: &M, e: M::Edge) -> (u32, u32) {
        let [a, b] = mesh.edge_vertices(e).map(|v| self.numbering.number(v));
        (a.min(b), a.max(b))
    }

    /// Where a vertex is in the unit box.
    #[inline]
    fn place(&self, mesh: &M, number: u32) -> DVec3 {
        (at(mesh, self.numbering.name(number)) - self.centre) / self.size
    }

    fn fill_queue(&mut self, mesh: &M) {
        let ends: Vec<(u32, u32)> = mesh.edges().map(|e| self.ends(mesh, e)).collect();
        let entries = ends
            .into_iter()
            .filter_map(|(a, b)| self.entry(mesh, [a, b]));
        self.queue = entries.map(Reverse).collect();
    }

    /// What the collapse of an edge would cost; none where both ends are fixed.
    #[inline]
    fn entry(&self, mesh: &M, ends: [u32; 2]) -> Option<Entry> {
        let (_, error) = self.best(mesh, ends)?;
        let [a, b] = ends.map(|n| self.versions[n as usize]);
        Some(Entry {
            cost: (error as f32).to_bits(),
            ends,
            version: a.wrapping_add(b),
        })
    }

    fn is_fresh(&self, entry: &Entry) -> bool {
        let [a, b] = entry.ends.map(|n| self.versions[n as usize]);
        a.wrapping_add(b) == entry.version
    }

    /// Where the two ends should meet, in the unit box, and at what error.
    #[inline]
    fn best(&self, mesh: &M, [a, b]: [u32; 2]) -> Option<(DVec3, f64)> {
        let sum = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        let [p, q] = [a, b].map(|n| self.place(mesh, n));
        match [a, b].map(|n| self.fixed[n as usize]) {
            [true, true] => return None,
            [true, false] => return Some((p, sum.at(p))),
            [false, true] => return Some((q, sum.at(q))),
            [false, false] => {}
        }
        let middle = (p + q) / 2.0;
        // A place far from the edge is a matter of rounding, not of shape.
        let reach = 4.0 * p.distance_squared(q);
        if let Some(x) = sum.least().filter(|x| x.distance_squared(middle) <= reach) {
            return Some((x, sum.at(x)));
        }
        let places = [middle, p, q].map(|x| (x, sum.at(x)));
        places.into_iter().min_by(|x, y| x.1.total_cmp(&y.1))
    }

    /// Collapses the edge of `entry`, if it is there and may go; the error that this makes.
    fn collapse(&mut self, mesh: &mut M, entry: &Entry) -> Option<f64> {
        let [a, b] = entry.ends;
        let e = self.numbering.edge(mesh, entry.ends)?;
        let (to, error) = self.best(mesh, entry.ends)?;
        let ends = [a, b].map(|n| self.numbering.name(n));
        // As the structure will hold it; what is fixed stays to the bit.
        let fixed = [a, b].map(|n| self.fixed[n as usize]);
        let to = match fixed.iter().position(|&fixed| fixed) {
            Some(i) => mesh.position(ends[i]),
            None => (to * self.size + self.centre).as_vec3(),
        };
        if !turns_nothing_over(mesh, ends, to.as_dvec3()) || !keeps_link(mesh, e) {
            return None;
        }
        let kept = mesh.collapse_edge(e, ends[0], to, &mut ()).ok()?;
        self.numbering.renamed(a, kept);
        self.numbering.remove(b);
        let other = self.quadrics[b as usize];
        self.quadrics[a as usize] += other;
        self.fixed[a as usize] |= self.fixed[b as usize];
        self.versions[a as usize] = self.versions[a as usize].wrapping_add(1);
        // No number is used twice, so no entry of the end that is gone is fresh again.
        self.versions[b as usize] = self.versions[b as usize].wrapping_add(1);
        for v in mesh.vertex_vertices(kept) {
            let n = self.numbering.number(v);
            if let Some(entry) = self.entry(mesh, [a.min(n), a.max(n)]) {
                self.queue.push(Reverse(entry));
            }
        }
        Some(error)
    }
}

#[cfg(test)]
mod tests;
