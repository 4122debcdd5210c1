//! The distance between the input of a decimation and the result, which a collapse must keep small.

use glam::DVec3;
use sixfold_core::{MeshEdit, Point, row};
use sixfold_spatial::{Bvh, FaceTriangle, SpatialIndex, SurfaceQueries, closest_point_on_triangle};

use crate::error::RemeshError;
use crate::numbering::{Numbering, corners, corners_from};
use crate::rules::at;

/// Samples of the input (its vertices, the middles of its edges and the centroids of its faces), each
/// assigned to the vertex that its vertex was merged into (after Klein, Liebich & Straßer 1996), and the
/// surface of the input.
pub(crate) struct Deviation {
    limit: f64,
    surface: Bvh<FaceTriangle<u32>>,
    /// By sample: its position. The first samples are the vertices.
    samples: Vec<Point>,
    /// By vertex: the samples that are assigned to it.
    assigned: Vec<Vec<u32>>,
    /// What the collapse that was allowed last changes.
    moves: Vec<Move>,
}

/// A sample that is assigned to another vertex.
struct Move {
    sample: u32,
    from: u32,
    to: u32,
}

impl Deviation {
    /// Collects the samples and builds an index of the surface; O(faces log faces). `positions` are by
    /// vertex number.
    pub(crate) fn new<M: MeshEdit>(
        mesh: &M,
        numbering: &Numbering<M>,
        positions: Vec<Point>,
        limit: f64,
    ) -> Result<Self, RemeshError> {
        if limit.is_nan() || limit < 0.0 {
            return Err(RemeshError::BadDistance { distance: limit });
        }
        let triangles = (0..).zip(mesh.faces()).map(|(face, f)| {
            let corners = corners(mesh, f).map(|v| mesh.position(v));
            FaceTriangle { face, corners }
        });
        let mut deviation = Self {
            limit,
            surface: Bvh::build(triangles.collect()).expect("positions are finite, and few enough"),
            assigned: (0..row(positions.len())).map(|v| vec![v]).collect(),
            samples: positions,
            moves: Vec::new(),
        };
        for [a, b] in numbering.edges(mesh) {
            let [p, q] = [a, b].map(|v| deviation.samples[v as usize]);
            deviation.assign(p.midpoint(q), a);
        }
        for f in mesh.faces() {
            let numbers = corners(mesh, f).map(|v| numbering.number(v));
            let sum: Point = numbers.iter().map(|&v| deviation.samples[v as usize]).sum();
            let [a, b, c] = numbers;
            deviation.assign(sum / 3.0, a.min(b).min(c));
        }
        Ok(deviation)
    }

    /// Adds a sample and assigns it to a vertex.
    fn assign(&mut self, at: Point, vertex: u32) {
        self.assigned[vertex as usize].push(row(self.samples.len()));
        self.samples.push(at);
    }

    /// Notes that vertex `b` was merged into `a`, after [`allows`](Self::allows) allowed it.
    pub(crate) fn merge(&mut self, [a, b]: [u32; 2]) {
        let mut merged = std::mem::take(&mut self.assigned[b as usize]);
        self.assigned[a as usize].append(&mut merged);
        for &Move { sample, from, to } in &self.moves {
            self.assigned[from as usize].retain(|&other| other != sample);
            self.assigned[to as usize].push(sample);
        }
    }

    /// Returns whether the distance stays within the limit if the edge between two vertices is
    /// collapsed into the place `to`.
    pub(crate) fn allows<M: MeshEdit>(
        &mut self,
        mesh: &M,
        numbering: &Numbering<M>,
        ends: [u32; 2],
        to: Point,
    ) -> bool {
        let region = Region::new(mesh, numbering, ends, to.as_dvec3());
        let mut moves = std::mem::take(&mut self.moves);
        moves.clear();
        let is_allowed = self.is_near_input(&region) && self.covers(&region, ends, &mut moves);
        self.moves = moves;
        is_allowed
    }

    /// Returns whether the new vertex and points of the new faces are near the input.
    fn is_near_input(&self, region: &Region) -> bool {
        let is_near = |p: DVec3| {
            let closest = self.surface.closest_point(p);
            closest.is_some_and(|closest| closest.distance() <= self.limit)
        };
        let points = region
            .star
            .iter()
            .flat_map(|&[a, b, c]| [(a + b) / 2.0, (a + b + c) / 3.0]);
        is_near(region.tip) && points.into_iter().all(is_near)
    }

    /// Returns whether all samples of the ends and of the vertices around them are near the new faces.
    /// Adds to `moves` the samples that are no longer near a face of their vertex.
    fn covers(&self, region: &Region, ends: [u32; 2], moves: &mut Vec<Move>) -> bool {
        let [a, b] = ends;
        let mut covered = |number: u32, holder: u32| {
            self.assigned[number as usize].iter().all(|&sample| {
                let p = self.samples[sample as usize].as_dvec3();
                let is_near =
                    |&&(_, triangle): &&(u32, [DVec3; 3])| distance(p, triangle) <= self.limit;
                let own = region.faces_at(holder).any(|face| is_near(&&face));
                own || region.faces.iter().find(is_near).is_some_and(|&(to, _)| {
                    let from = holder;
                    moves.push(Move { sample, from, to });
                    true
                })
            })
        };
        let is_covered = covered(a, a) && covered(b, a);
        is_covered && region.ring.iter().all(|&v| covered(v, v))
    }

    /// Returns the largest distance of a sample from the faces around the vertex that it is assigned
    /// to.
    pub(crate) fn largest<M: MeshEdit>(&self, mesh: &M, numbering: &Numbering<M>) -> f64 {
        let mut largest = 0.0_f64;
        for v in mesh.vertices() {
            let faces = mesh.vertex_faces(v);
            let triangles = faces.map(|f| corners(mesh, f).map(|w| at(mesh, w)));
            let triangles: Vec<[DVec3; 3]> = triangles.collect();
            if triangles.is_empty() {
                continue; // an isolated vertex has no number
            }
            for &sample in &self.assigned[numbering.number(v) as usize] {
                let p = self.samples[sample as usize].as_dvec3();
                let distances = triangles.iter().map(|&triangle| distance(p, triangle));
                largest = largest.max(distances.fold(f64::INFINITY, f64::min));
            }
        }
        largest
    }
}

fn distance(p: DVec3, triangle: [DVec3; 3]) -> f64 {
    closest_point_on_triangle(p, triangle).distance(p)
}

/// The faces around an edge after its collapse.
struct Region {
    tip: DVec3,
    /// The corners of the faces at the new vertex; the first is the tip.
    star: Vec<[DVec3; 3]>,
    /// The vertices around the new vertex, ascending.
    ring: Vec<u32>,
    /// The faces at the new vertex and at the vertices around it, with the number of that vertex. A
    /// face occurs once for each of these vertices.
    faces: Vec<(u32, [DVec3; 3])>,
}

impl Region {
    fn new<M: MeshEdit>(mesh: &M, numbering: &Numbering<M>, numbers: [u32; 2], tip: DVec3) -> Self {
        let ends = numbers.map(|end| numbering.handle(end));
        let mut region = Self {
            tip,
            star: Vec::new(),
            ring: Vec::new(),
            faces: Vec::new(),
        };
        for end in ends {
            for f in mesh.vertex_faces(end) {
                let [_, p, q] = corners_from(mesh, f, end);
                if ends.contains(&p) || ends.contains(&q) {
                    continue;
                }
                let triangle = [tip, at(mesh, p), at(mesh, q)];
                region.star.push(triangle);
                let ring = [p, q].map(|v| numbering.number(v));
                region.ring.extend(ring);
                let [p, q] = ring;
                region
                    .faces
                    .extend([numbers[0], p, q].map(|v| (v, triangle)));
            }
        }
        region.ring.sort_unstable();
        region.ring.dedup();
        for &v in &region.ring {
            for f in mesh.vertex_faces(numbering.handle(v)) {
                let corners = corners(mesh, f);
                if !corners.iter().any(|w| ends.contains(w)) {
                    region.faces.push((v, corners.map(|w| at(mesh, w))));
                }
            }
        }
        region.faces.sort_by_key(vertex_of);
        region
    }

    /// Yields the faces at a vertex.
    fn faces_at(&self, vertex: u32) -> impl Iterator<Item = (u32, [DVec3; 3])> {
        let first = self.faces.partition_point(|&(v, _)| v < vertex);
        let faces = self.faces[first..].iter().copied();
        faces.take_while(move |&(v, _)| v == vertex)
    }
}

/// A function of its own, so that the sort is compiled once for all structures.
fn vertex_of(&(v, _): &(u32, [DVec3; 3])) -> u32 {
    v
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshQuery, Representation};
    use sixfold_half_edge::EditableHalfEdgeMesh;

    use super::*;
    use crate::rules::keeps_orientation;

    /// Each sample that a collapse moves to another vertex is near a face of this one, and near none of the
    /// vertex that it leaves.
    #[test]
    fn samples_stay_at_their_vertex_if_they_can() {
        let grid = sixfold_shapes::triangle_grid(12, 12).expect("small");
        let mut mesh = EditableHalfEdgeMesh::from_polygons(&grid).expect("a manifold");
        let mut numbering = Numbering::new(&mesh).expect("triangles");
        let limit = 1e-4;
        let numbers = 0..row(numbering.len());
        let positions = numbers
            .map(|n| mesh.position(numbering.handle(n)))
            .collect();
        let mut deviation = Deviation::new(&mesh, &numbering, positions, limit).expect("a limit");
        let mut moved = 0;
        for ends in numbering.edges(&mesh) {
            let Some(e) = numbering.edge(&mesh, ends) else {
                continue;
            };
            let handles = ends.map(|end| numbering.handle(end));
            let to = mesh.position(handles[0]);
            if !deviation.allows(&mesh, &numbering, ends, to)
                || !keeps_orientation(&mesh, handles, to.as_dvec3())
            {
                continue;
            }
            let Ok(kept) = mesh.collapse_edge(e, handles[0], to) else {
                continue;
            };
            numbering.set_handle(ends[0], kept);
            numbering.remove(ends[1]);
            let is_near = |sample: u32, vertex: u32| {
                let p = deviation.samples[sample as usize].as_dvec3();
                let mut faces = mesh.vertex_faces(numbering.handle(vertex));
                faces.any(|f| distance(p, corners(&mesh, f).map(|v| at(&mesh, v))) <= limit)
            };
            for &Move { sample, from, to } in &deviation.moves {
                assert!(!is_near(sample, from) && is_near(sample, to));
            }
            moved += deviation.moves.len();
            deviation.merge(ends);
        }
        assert!(moved > 0, "{moved}");
    }
}
