//! The distance between the input of a decimation and the result, which a collapse must keep small.

use glam::DVec3;
use rustc_hash::FxHashMap;
use sixfold_core::{MeshEdit, Point, row};
use sixfold_spatial::{
    Bvh, FaceTriangle, SearchHint, SpatialIndex, SurfaceQueries, closest_point_on_triangle,
};

use crate::error::RemeshError;
use crate::numbering::{Numbering, corners};
use crate::rules::{HUB, at};

/// Number of faces that a collapse may compare with samples, for each changed face and each sample on one.
/// Without vertices with very many edges, there are always fewer.
const FACES_PER_SAMPLE: usize = 256;

/// Samples of the input (its vertices, the middles of its edges and the centroids of its faces), each
/// assigned to the vertex that its vertex was merged into (after Klein, Liebich & Straßer 1996), and the
/// surface of the input.
///
/// ```text
///        c ───── d         A sample is on one face of its vertex: a face that is near it. A collapse
///       ╱·╲  ·  ╱ ╲        changes the faces at the ends of the edge, and only the samples on these
///      ╱ · a───b · ╲       faces are compared with other faces. So a vertex around the edge may have
///     ╱___╱·╲_╱ ╲___╲      any number of faces: those that do not change are not visited.
/// ```
pub(crate) struct Deviation {
    limit: f64,
    surface: Bvh<FaceTriangle<u32>>,
    /// The first samples are the vertices.
    samples: Vec<Sample>,
    /// By face with samples: one of them, from which the others follow.
    first_on: FxHashMap<FaceKey, u32>,
    /// Where the samples on changed faces are after the collapse that was allowed last.
    places: Vec<Place>,
    /// The faces that this collapse changes, as they were before.
    changed: Vec<FaceKey>,
}

/// The vertices of a face, ascending.
type FaceKey = [u32; 3];

struct Sample {
    at: Point,
    /// The vertex that the sample is assigned to.
    vertex: u32,
    /// The next sample on the same face. The last one is followed by itself.
    next: u32,
}

/// The vertex of a sample, and the face of this vertex that the sample is on.
struct Place {
    sample: u32,
    vertex: u32,
    face: FaceKey,
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
        let vertices = row(positions.len());
        let samples = (0..vertices).zip(positions).map(|(v, at)| Sample {
            at,
            vertex: v,
            next: v,
        });
        let mut deviation = Self {
            limit,
            surface: Bvh::build(triangles.collect()).expect("positions are finite, and few enough"),
            samples: samples.collect(),
            first_on: FxHashMap::default(),
            places: Vec::new(),
            changed: Vec::new(),
        };
        let mut face_of_vertex = vec![None; vertices as usize];
        // The ends of a side, and the third corner of its face.
        let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * mesh.face_count());
        for f in mesh.faces() {
            let numbers = corners(mesh, f).map(|v| numbering.number(v));
            let face = face_key(numbers);
            let [a, b, c] = face;
            sides.extend([([a, b], c), ([a, c], b), ([b, c], a)]);
            for v in face {
                face_of_vertex[v as usize] = Some(face);
            }
            let sum: Point = numbers
                .iter()
                .map(|&v| deviation.samples[v as usize].at)
                .sum();
            deviation.add(sum / 3.0, a, face);
        }
        for (sample, face) in (0..vertices).zip(face_of_vertex) {
            let face = face.expect("only vertices of faces have numbers");
            deviation.put(Place {
                sample,
                vertex: sample,
                face,
            });
        }
        sides.sort_unstable();
        sides.dedup_by_key(|&mut (ends, _)| ends);
        for ([a, b], c) in sides {
            let [p, q] = [a, b].map(|v| deviation.samples[v as usize].at);
            deviation.add(p.midpoint(q), a, face_key([a, b, c]));
        }
        Ok(deviation)
    }

    /// Adds a sample on a face of `vertex`.
    fn add(&mut self, at: Point, vertex: u32, face: FaceKey) {
        let sample = row(self.samples.len());
        self.samples.push(Sample {
            at,
            vertex,
            next: sample,
        });
        self.put(Place {
            sample,
            vertex,
            face,
        });
    }

    fn put(
        &mut self,
        Place {
            sample,
            vertex,
            face,
        }: Place,
    ) {
        let next = self.first_on.insert(face, sample).unwrap_or(sample);
        let placed = &mut self.samples[sample as usize];
        (placed.vertex, placed.next) = (vertex, next);
    }

    /// Yields the samples on a face.
    fn on(&self, face: FaceKey) -> impl Iterator<Item = u32> {
        let first = self.first_on.get(&face).copied();
        std::iter::successors(first, |&sample| {
            let next = self.samples[sample as usize].next;
            (next != sample).then_some(next)
        })
    }

    /// Notes the collapse that [`allows`](Self::allows) allowed last.
    pub(crate) fn merge(&mut self) {
        for face in self.changed.drain(..) {
            self.first_on.remove(&face);
        }
        let mut places = std::mem::take(&mut self.places);
        places.drain(..).for_each(|place| self.put(place));
        self.places = places;
    }

    /// Returns whether the distance stays within the limit if the edge between two vertices is
    /// collapsed into the place `to`, and the first of them remains.
    ///
    /// `is_hub` returns whether a vertex has very many edges. The faces at such a vertex that do not change
    /// are not searched for places of samples, and if it moves itself, samples do not go far around it. So a
    /// collapse around a hub is refused a little earlier.
    ///
    /// # Complexity
    ///
    /// O(faces at the ends + samples on them), times the cost of a query of the surface. If the first end
    /// is a hub and at `to` already, only the faces at the other end count.
    pub(crate) fn allows<M: MeshEdit>(
        &mut self,
        mesh: &M,
        numbering: &Numbering<M>,
        ends: [u32; 2],
        to: Point,
        is_hub: impl Fn(u32) -> bool,
    ) -> bool {
        let region = Region::new(mesh, numbering, ends, to, is_hub(ends[0]));
        let mut places = std::mem::take(&mut self.places);
        places.clear();
        let others = |v: u32| match is_hub(v) {
            true => Vec::new(),
            false => region.other_faces_at(mesh, numbering, v),
        };
        let is_allowed = self.is_near_input(&region) && self.covers(&region, &mut places, &others);
        self.places = places;
        self.changed.clear();
        self.changed
            .extend(region.changed.iter().map(|&(face, _)| face));
        is_allowed
    }

    /// Returns whether the new vertex and points of the new faces are near the input.
    fn is_near_input(&self, region: &Region) -> bool {
        let is_near = |p: DVec3| self.surface.is_within(p, self.limit);
        let points = region.star.iter().flat_map(|face| {
            let [a, b, c] = face.corners;
            [(a + b) / 2.0, (a + b + c) / 3.0]
        });
        is_near(region.tip) && points.into_iter().all(is_near)
    }

    /// Returns whether all samples on changed faces are near a face afterwards, and adds their places.
    /// A sample stays at its vertex if it is near a face of this vertex. `other_faces` returns the faces at
    /// a vertex that do not change.
    fn covers(
        &self,
        region: &Region,
        places: &mut Vec<Place>,
        other_faces: &dyn Fn(u32) -> Vec<Face>,
    ) -> bool {
        let [a, b] = region.ends;
        // The unchanged faces at each vertex around the new vertex, when first needed.
        let mut around: Option<Vec<(u32, Vec<Face>)>> = None;
        let mut rest = FACES_PER_SAMPLE * (FACES_PER_SAMPLE + region.changed.len());
        for &(face, successor) in &region.changed {
            let successor = successor.map(|star| &region.star[star]);
            for sample in self.on(face) {
                let Sample { at, vertex, .. } = self.samples[sample as usize];
                let vertex = if vertex == b { a } else { vertex };
                let p = at.as_dvec3();
                let is_near = |face: &&Face| distance(p, face.corners) <= self.limit;
                let mut place = |vertex: u32, face: &Face| {
                    let face = face_key(face.vertices);
                    places.push(Place {
                        sample,
                        vertex,
                        face,
                    });
                };
                if let Some(own) = successor.filter(is_near) {
                    place(vertex, own);
                    continue;
                }
                rest += FACES_PER_SAMPLE;
                let Some(left) = rest.checked_sub(region.targets.len()) else {
                    return false;
                };
                rest = left;
                let targets = region.targets.iter().map(|&face| &region.star[face]);
                let mut own = targets
                    .clone()
                    .filter(|face| face.vertices.contains(&vertex));
                if let Some(own) = own.find(is_near) {
                    place(vertex, own);
                    continue;
                }
                let around = around.get_or_insert_with(|| {
                    let with_faces = |v| (v, other_faces(v));
                    region.vertices().into_iter().map(with_faces).collect()
                });
                let visited: usize = around.iter().map(|(_, faces)| faces.len()).sum();
                let Some(left) = rest.checked_sub(visited) else {
                    return false;
                };
                rest = left;
                let at_vertex = around.binary_search_by_key(&vertex, |&(v, _)| v);
                let mut own = at_vertex.iter().flat_map(|&i| &around[i].1);
                if let Some(own) = own.find(is_near) {
                    place(vertex, own);
                    continue;
                }
                // The lowest vertex with a face that is near.
                let in_star = targets.filter(is_near).filter_map(|face| {
                    let lowest = face.vertices.iter().copied().min()?;
                    Some((lowest, face))
                });
                let in_star = in_star.min_by_key(|&(lowest, _)| lowest);
                let before = around
                    .iter()
                    .take_while(|&&(v, _)| in_star.is_none_or(|(to, _)| v < to));
                let mut before =
                    before.flat_map(|(v, faces)| faces.iter().map(move |face| (*v, face)));
                let Some((to, face)) = before.find(|(_, face)| is_near(face)).or(in_star) else {
                    return false;
                };
                place(to, face);
            }
        }
        true
    }

    /// Returns the largest distance of a sample from the faces around the vertex that it is assigned
    /// to; O(samples log samples).
    pub(crate) fn largest<M: MeshEdit>(&self, mesh: &M, numbering: &Numbering<M>) -> f64 {
        // The distance from one face is a bound, so that most samples need no search.
        let mut samples: Vec<(u32, DVec3, f64)> = Vec::with_capacity(self.samples.len());
        for f in mesh.faces() {
            let Face { vertices, corners } = Face::new(mesh, numbering, f);
            samples.extend(self.on(face_key(vertices)).map(|sample| {
                let Sample { at, vertex, .. } = self.samples[sample as usize];
                let p = at.as_dvec3();
                (vertex, p, distance(p, corners))
            }));
        }
        samples.sort_by_key(|&(vertex, ..)| vertex);
        let mut largest = 0.0_f64;
        for at_vertex in samples.chunk_by(|one, other| one.0 == other.0) {
            let mut fan: Option<Fan> = None;
            for &(vertex, p, bound) in at_vertex {
                if bound > largest {
                    let fan = fan.get_or_insert_with(|| Fan::new(mesh, numbering.handle(vertex)));
                    largest = largest.max(fan.distance(p));
                }
            }
        }
        largest
    }
}

/// The faces around a vertex.
enum Fan {
    Few(Vec<[DVec3; 3]>),
    Hub(Bvh<FaceTriangle<u32>>, SearchHint),
}

impl Fan {
    fn new<M: MeshEdit>(mesh: &M, v: M::Vertex) -> Self {
        let faces = mesh.vertex_faces(v).map(|f| corners(mesh, f));
        let faces: Vec<[Point; 3]> = faces.map(|face| face.map(|w| mesh.position(w))).collect();
        if faces.len() <= HUB as usize {
            let faces = faces.into_iter().map(|face| face.map(|p| p.as_dvec3()));
            return Self::Few(faces.collect());
        }
        let triangles = (0..).zip(faces);
        let triangles = triangles.map(|(face, corners)| FaceTriangle { face, corners });
        let index = Bvh::build(triangles.collect()).expect("positions are finite");
        Self::Hub(index, SearchHint::default())
    }

    fn distance(&mut self, p: DVec3) -> f64 {
        match self {
            Self::Few(faces) => {
                let distances = faces.iter().map(|&face| distance(p, face));
                distances.fold(f64::INFINITY, f64::min)
            }
            Self::Hub(index, hint) => {
                let squared = index.distance_squared_from(p, hint);
                squared.map_or(f64::INFINITY, f64::sqrt)
            }
        }
    }
}

fn distance(p: DVec3, triangle: [DVec3; 3]) -> f64 {
    closest_point_on_triangle(p, triangle).distance(p)
}

fn face_key(mut vertices: [u32; 3]) -> FaceKey {
    vertices.sort_unstable();
    vertices
}

#[derive(Clone, Copy)]
struct Face {
    vertices: [u32; 3],
    corners: [DVec3; 3],
}

impl Face {
    fn new<M: MeshEdit>(mesh: &M, numbering: &Numbering<M>, f: M::Face) -> Self {
        let corners = corners(mesh, f);
        Self {
            vertices: corners.map(|v| numbering.number(v)),
            corners: corners.map(|v| at(mesh, v)),
        }
    }

    /// Turns the face so that `vertex` comes first.
    fn starting_at(mut self, vertex: u32) -> Self {
        let first = self.vertices.iter().position(|&v| v == vertex);
        self.vertices.rotate_left(first.unwrap_or(0));
        self.corners.rotate_left(first.unwrap_or(0));
        self
    }
}

/// The faces that the collapse of an edge changes.
struct Region {
    /// The end that remains, and the one that does not.
    ends: [u32; 2],
    tip: DVec3,
    /// Whether all faces of the first end change, not only those with both ends.
    moves: bool,
    /// The changed faces after the collapse; they start at the tip.
    star: Vec<Face>,
    /// The faces of `star` where samples of other faces may go.
    targets: Vec<usize>,
    /// The changed faces before the collapse, sorted, and where each is in `star`; `None` if it has both
    /// ends.
    changed: Vec<(FaceKey, Option<usize>)>,
}

impl Region {
    fn new<M: MeshEdit>(
        mesh: &M,
        numbering: &Numbering<M>,
        ends: [u32; 2],
        to: Point,
        is_hub: bool,
    ) -> Self {
        let [a, b] = ends;
        let mut region = Self {
            ends,
            tip: to.as_dvec3(),
            moves: !is_hub || mesh.position(numbering.handle(a)) != to,
            star: Vec::new(),
            targets: Vec::new(),
            changed: Vec::new(),
        };
        let moving: &[u32] = if region.moves { &[a, b] } else { &[b] };
        for &end in moving {
            for f in mesh.vertex_faces(numbering.handle(end)) {
                let mut face = Face::new(mesh, numbering, f).starting_at(end);
                let key = face_key(face.vertices);
                if ends.iter().all(|end| key.contains(end)) {
                    region.changed.push((key, None));
                    continue;
                }
                region.changed.push((key, Some(region.star.len())));
                (face.vertices[0], face.corners[0]) = (a, region.tip);
                region.star.push(face);
            }
        }
        region.targets = (0..region.star.len()).collect();
        if is_hub {
            // Only those around the other end.
            let at_b = region.changed.iter().filter(|(face, _)| face.contains(&b));
            let mut near: Vec<u32> = at_b.flat_map(|&(face, _)| face).collect();
            near.retain(|&v| v != a);
            near.sort_unstable();
            let is_near = |v| near.binary_search(v).is_ok();
            let star = &region.star;
            let targets = &mut region.targets;
            targets.retain(|&face| star[face].vertices.iter().any(is_near));
        }
        region.changed.sort_unstable();
        // Faces with the same vertices share their samples.
        region.changed.dedup_by_key(|&mut (face, _)| face);
        region
    }

    /// Returns the vertices of the faces where samples may go, and of those that the collapse removes,
    /// ascending.
    fn vertices(&self) -> Vec<u32> {
        let [a, b] = self.ends;
        let removed = self.changed.iter().filter(|(_, star)| star.is_none());
        let removed = removed.flat_map(|&(face, _)| face);
        let targets = self.targets.iter();
        let targets = targets.flat_map(|&face| self.star[face].vertices);
        let mut vertices: Vec<u32> = targets.chain(removed).filter(|&v| v != b).collect();
        vertices.push(a);
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// Returns the faces at a vertex that do not change.
    fn other_faces_at<M: MeshEdit>(
        &self,
        mesh: &M,
        numbering: &Numbering<M>,
        vertex: u32,
    ) -> Vec<Face> {
        let [a, b] = self.ends;
        let faces = mesh.vertex_faces(numbering.handle(vertex));
        let faces = faces.map(|f| Face::new(mesh, numbering, f));
        faces
            .filter(|face| {
                let has = |end| face.vertices.contains(&end);
                !(has(b) || has(a) && self.moves)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshQuery, Representation};
    use sixfold_half_edge::EditableHalfEdgeMesh;

    use super::*;
    use crate::numbering::tests::two_cones;
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
            if !deviation.allows(&mesh, &numbering, ends, to, |_| false)
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
                let p = deviation.samples[sample as usize].at.as_dvec3();
                let mut faces = mesh.vertex_faces(numbering.handle(vertex));
                faces.any(|f| distance(p, corners(&mesh, f).map(|v| at(&mesh, v))) <= limit)
            };
            for &Place { sample, vertex, .. } in &deviation.places {
                let from = match deviation.samples[sample as usize].vertex {
                    from if from == ends[1] => ends[0],
                    from => from,
                };
                assert!(is_near(sample, vertex));
                assert!(from == vertex || !is_near(sample, from));
                moved += usize::from(from != vertex);
            }
            deviation.merge();
        }
        assert!(moved > 0, "{moved}");
    }

    /// At hubs of any size, a collapse changes as many faces, and moves as many samples.
    #[test]
    fn a_collapse_visits_only_the_faces_that_it_changes() {
        for n in [100, 1000] {
            let mesh = EditableHalfEdgeMesh::from_polygons(&two_cones(n)).expect("a manifold");
            let numbering = Numbering::new(&mesh).expect("triangles");
            let position = |number| mesh.position(numbering.handle(number));
            let positions = (0..row(numbering.len())).map(position).collect();
            let mut deviation = Deviation::new(&mesh, &numbering, positions, 0.1).expect("a limit");
            let is_hub = |number| mesh.vertex_edges(numbering.handle(number)).count() > 4;
            let mut hubs = 0;
            for mut ends in numbering.edges(&mesh) {
                if is_hub(ends[1]) {
                    ends.reverse();
                }
                hubs += usize::from(is_hub(ends[0]));
                let to = position(ends[0]);
                if deviation.allows(&mesh, &numbering, ends, to, is_hub) {
                    assert!(!is_hub(ends[0]) && deviation.places.len() < 30, "{ends:?}");
                }
                assert!(deviation.changed.len() <= 6, "{ends:?}");
            }
            assert_eq!(hubs, 2 * n as usize);
        }
    }
}
