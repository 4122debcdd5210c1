//! A mesh as lists of faces.

use std::collections::{BTreeMap, BTreeSet};

use sixfold_core::{Point, PolygonMesh};

use crate::gallery::distinct_position;

/// An oriented mesh without positions, which operations change.
#[derive(Clone, Debug)]
pub(super) struct MeshBuilder {
    /// Exclusive upper bound of the vertex numbers in faces.
    pub(super) vertices: u32,
    pub(super) faces: Vec<Vec<u32>>,
    /// Number of isolated vertices to add.
    pub(super) isolated: u32,
    /// Two vertices: the first vertex gets the position of the second vertex.
    pub(super) coincident: Option<[u32; 2]>,
}

impl MeshBuilder {
    pub(super) fn from_meshes(pieces: &[PolygonMesh]) -> Self {
        let mut builder = Self {
            vertices: 0,
            faces: Vec::new(),
            isolated: 0,
            coincident: None,
        };
        for piece in pieces {
            let first = builder.vertices;
            builder.vertices += piece.vertex_count() as u32;
            let corners = piece.faces().iter().map(|(_, corners)| corners);
            let faces = corners.map(|c| c.iter().map(|v| v.index() as u32 + first).collect());
            builder.faces.extend(faces);
        }
        builder
    }

    pub(super) fn add_vertex(&mut self) -> u32 {
        self.vertices += 1;
        self.vertices - 1
    }

    pub(super) fn reverse_faces(&mut self) {
        for face in &mut self.faces {
            face.reverse();
        }
    }

    /// Returns the start, the end and the face of each side.
    pub(super) fn sides(&self) -> Vec<(u32, u32, usize)> {
        let faces = self.faces.iter().enumerate();
        let sides = faces.flat_map(|(f, face)| {
            let next = face.iter().cycle().skip(1);
            face.iter().zip(next).map(move |(&a, &b)| (a, b, f))
        });
        sides.collect()
    }

    /// Returns a map from the start and end of each side to its face; the mesh must be an
    /// oriented manifold.
    pub(super) fn face_by_side(&self) -> BTreeMap<(u32, u32), usize> {
        let sides = self.sides().into_iter();
        sides.map(|(a, b, f)| ((a, b), f)).collect()
    }

    pub(super) fn neighbours(&self, v: u32) -> BTreeSet<u32> {
        let sides = self.sides().into_iter();
        let ends = sides.filter(|&(a, b, _)| a == v || b == v);
        ends.map(|(a, b, _)| if a == v { b } else { a }).collect()
    }

    pub(super) fn used_vertices(&self) -> Vec<u32> {
        let used: BTreeSet<u32> = self.faces.iter().flatten().copied().collect();
        used.into_iter().collect()
    }

    /// Separates the fans of each vertex: one fan keeps the vertex, and every other fan gets a new
    /// vertex.
    pub(super) fn separate_fans(&mut self) {
        for v in self.used_vertices() {
            let mut rest: Vec<usize> = (0..self.faces.len())
                .filter(|&f| self.faces[f].contains(&v))
                .collect();
            self.take_fan(v, &mut rest);
            while !rest.is_empty() {
                let copy = self.add_vertex();
                for f in self.take_fan(v, &mut rest) {
                    let corner = self.faces[f].iter_mut().find(|corner| **corner == v);
                    *corner.expect("the face is at v") = copy;
                }
            }
        }
    }

    /// Removes the faces of one fan at `v` from `rest`, and returns them.
    fn take_fan(&self, v: u32, rest: &mut Vec<usize>) -> Vec<usize> {
        let mut fan: Vec<usize> = rest.pop().into_iter().collect();
        let mut reached: BTreeSet<u32> = fan.iter().flat_map(|&f| self.spokes(f, v)).collect();
        while let Some(next) = rest
            .iter()
            .position(|&f| self.spokes(f, v).iter().any(|end| reached.contains(end)))
        {
            let f = rest.swap_remove(next);
            reached.extend(self.spokes(f, v));
            fan.push(f);
        }
        fan
    }

    fn spokes(&self, f: usize, v: u32) -> [u32; 2] {
        let face = &self.faces[f];
        let at = face.iter().position(|&corner| corner == v);
        let at = at.expect("the face is at v");
        [
            face[(at + face.len() - 1) % face.len()],
            face[(at + 1) % face.len()],
        ]
    }

    /// Builds the mesh without unused vertices, and renumbers it at random by `seed`.
    pub(super) fn build(self, seed: u64) -> PolygonMesh {
        let used = self.used_vertices();
        let position = |v: u32| {
            let pair = self.coincident.filter(|pair| pair[0] == v);
            distinct_position(pair.map_or(v, |pair| pair[1]))
        };
        let mut points: Vec<Point> = used.iter().map(|&v| position(v)).collect();
        points.extend((0..self.isolated).map(|i| distinct_position(self.vertices + i)));
        let numbers: BTreeMap<u32, u32> = used.iter().copied().zip(0..).collect();
        let mut rng = SplitMix64(seed);
        let mut faces: Vec<Vec<u32>> = self
            .faces
            .iter()
            .map(|face| face.iter().map(|v| numbers[v]).collect())
            .collect();
        if seed != 0 {
            rng.shuffle(&mut faces);
            for face in &mut faces {
                let start = rng.below(face.len());
                face.rotate_left(start);
            }
        }
        let mesh = PolygonMesh::new(points, faces)
            .expect("operations keep the corners of a face distinct");
        let mut numbers: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
        if seed != 0 {
            rng.shuffle(&mut numbers);
        }
        mesh.renumbered(&numbers)
    }
}

/// A pseudo-random generator (SplitMix64, Steele et al. 2014).
struct SplitMix64(u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}
