//! The distance between the input of a decimation and the result, which a collapse must keep small.

use glam::DVec3;
use sixfold_core::{MeshEdit, Point, row};
use sixfold_spatial::{Bvh, FaceTriangle, SpatialIndex, SurfaceQueries, closest_point_on_triangle};

use crate::error::RemeshError;
use crate::numbering::{Numbering, corners, corners_from};
use crate::rules::at;

/// The vertices of the input, each assigned to the vertex that it was merged into (after Klein, Liebich
/// & Straßer 1996), and the surface of the input.
pub(crate) struct Deviation {
    limit: f64,
    surface: Bvh<FaceTriangle<u32>>,
    /// By vertex of the input.
    positions: Vec<Point>,
    /// By vertex of the input: the next one that was merged into the same vertex; itself if it is the
    /// last.
    next: Vec<u32>,
    /// By vertex: the last vertex of the input that was merged into it. The first one is itself.
    last: Vec<u32>,
}

impl Deviation {
    /// Builds an index of the surface; O(faces log faces). `positions` are by vertex number.
    pub(crate) fn new<M: MeshEdit>(
        mesh: &M,
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
        let numbers: Vec<u32> = (0..row(positions.len())).collect();
        Ok(Self {
            limit,
            surface: Bvh::build(triangles.collect()).expect("positions are finite, and few enough"),
            positions,
            next: numbers.clone(),
            last: numbers,
        })
    }

    /// Notes that vertex `b` was merged into `a`.
    pub(crate) fn merge(&mut self, [a, b]: [u32; 2]) {
        let end = self.last[a as usize];
        self.next[end as usize] = b;
        self.last[a as usize] = self.last[b as usize];
    }

    /// Returns whether the distance stays within the limit if the edge between two vertices is
    /// collapsed into the place `to`.
    pub(crate) fn allows<M: MeshEdit>(
        &self,
        mesh: &M,
        numbering: &Numbering<M>,
        ends: [u32; 2],
        to: Point,
    ) -> bool {
        let star = Star::new(mesh, numbering, ends, to.as_dvec3());
        let is_near = |p: DVec3| {
            self.surface
                .closest_point(p)
                .is_some_and(|c| c.distance() <= self.limit)
        };
        let samples = star
            .faces
            .iter()
            .flat_map(|&(_, [a, b, c])| [(a + b) / 2.0, (a + b + c) / 3.0]);
        if !is_near(star.tip) || !samples.into_iter().all(is_near) {
            return false;
        }
        let in_star = |p: DVec3| {
            star.faces
                .iter()
                .any(|&(_, triangle)| self.reaches(p, triangle))
        };
        if !ends.iter().all(|&end| self.merged(end).all(in_star)) {
            return false;
        }
        let mut ring: Vec<M::Vertex> = star.faces.iter().flat_map(|&(ring, _)| ring).collect();
        ring.sort_unstable();
        ring.dedup();
        ring.into_iter().all(|v| {
            let others = mesh.vertex_faces(v).map(|f| corners(mesh, f));
            let others = others.filter(|corners| !corners.iter().any(|w| star.ends.contains(w)));
            let others: Vec<[DVec3; 3]> =
                others.map(|corners| corners.map(|w| at(mesh, w))).collect();
            let beside = star.faces.iter().filter(|(ring, _)| ring.contains(&v));
            let beside = || beside.clone().map(|&(_, triangle)| triangle);
            self.merged(numbering.number(v)).all(|p| {
                let mut triangles = others.iter().copied().chain(beside());
                triangles.any(|triangle| self.reaches(p, triangle))
            })
        })
    }

    /// Returns the largest distance of a vertex of the input from the faces around the vertex that it
    /// was merged into.
    pub(crate) fn largest<M: MeshEdit>(&self, mesh: &M, numbering: &Numbering<M>) -> f64 {
        let mut largest = 0.0_f64;
        for v in mesh.vertices() {
            let faces = mesh.vertex_faces(v);
            let triangles = faces.map(|f| corners(mesh, f).map(|w| at(mesh, w)));
            let triangles: Vec<[DVec3; 3]> = triangles.collect();
            if triangles.is_empty() {
                continue; // an isolated vertex has no number
            }
            for p in self.merged(numbering.number(v)) {
                let distances = triangles.iter().map(|&triangle| distance(p, triangle));
                largest = largest.max(distances.fold(f64::INFINITY, f64::min));
            }
        }
        largest
    }

    /// Yields the positions of the vertices of the input that were merged into vertex `number`.
    fn merged(&self, number: u32) -> impl Iterator<Item = DVec3> {
        let next = |&v: &u32| {
            let next = self.next[v as usize];
            (next != v).then_some(next)
        };
        let vertices = std::iter::successors(Some(number), next);
        vertices.map(|v| self.positions[v as usize].as_dvec3())
    }

    fn reaches(&self, p: DVec3, triangle: [DVec3; 3]) -> bool {
        distance(p, triangle) <= self.limit
    }
}

fn distance(p: DVec3, triangle: [DVec3; 3]) -> f64 {
    closest_point_on_triangle(p, triangle).distance(p)
}

/// The faces around a vertex after a collapse.
struct Star<M: MeshEdit> {
    ends: [M::Vertex; 2],
    tip: DVec3,
    /// The two vertices of each face besides the tip, and its corners; the first is the tip.
    faces: Vec<([M::Vertex; 2], [DVec3; 3])>,
}

impl<M: MeshEdit> Star<M> {
    fn new(mesh: &M, numbering: &Numbering<M>, ends: [u32; 2], tip: DVec3) -> Self {
        let ends = ends.map(|end| numbering.handle(end));
        let mut faces = Vec::new();
        for end in ends {
            for f in mesh.vertex_faces(end) {
                let [_, p, q] = corners_from(mesh, f, end);
                if !ends.contains(&p) && !ends.contains(&q) {
                    faces.push(([p, q], [tip, at(mesh, p), at(mesh, q)]));
                }
            }
        }
        Self { ends, tip, faces }
    }
}
