//! Reordering of the vertices and faces of a mesh. The shape of the mesh does not change.

use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};
use sixfold_core::{FaceId, FaceList, Point, PolygonMesh, VertexId, row};

sixfold_core::named! {
    /// An order of the vertices and faces of a mesh.
    #[derive(Default)]
    pub enum Order: "order" {
        /// The given order: the mesh is not reordered.
        #[default]
        Given = "given",
        /// Random order. See [`shuffled`].
        Shuffled = "shuffled",
        /// The order of a space-filling curve. See [`morton`].
        Morton = "morton",
        /// The order of a breadth-first walk over the faces. See [`breadth_first`].
        BreadthFirst = "breadth-first",
    }
}

impl Order {
    /// Returns the mesh in this order. Only [`Shuffled`](Self::Shuffled) uses `seed`.
    pub fn apply(self, mesh: &PolygonMesh, seed: u64) -> PolygonMesh {
        self.apply_with_handles(mesh, seed).mesh
    }

    /// Returns the mesh in this order, and the new handle of each vertex and each face.
    pub fn apply_with_handles(self, mesh: &PolygonMesh, seed: u64) -> Reordered {
        match self {
            Self::Given => Reordered {
                mesh: mesh.clone(),
                vertices: mesh.vertices().collect(),
                faces: mesh.faces().iter().map(|(f, _)| f).collect(),
            },
            Self::Shuffled => shuffle(mesh, seed),
            Self::Morton => sort_by_morton_code(mesh),
            Self::BreadthFirst => sort_breadth_first(mesh),
        }
    }
}

/// A reordered mesh, with the new handles of its elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Reordered {
    /// The reordered mesh.
    pub mesh: PolygonMesh,
    /// The new handle of each vertex. Index i is for the vertex with the old number i.
    pub vertices: Vec<VertexId>,
    /// The new handle of each face. Index i is for the face with the old number i.
    pub faces: Vec<FaceId>,
}

/// Returns the mesh with its vertices and faces in random order. Each face starts at a random
/// corner. Time: O(corners).
///
/// The same seed gives the same order on every machine (random generator ChaCha8, shuffle of Fisher
/// and Yates).
pub fn shuffled(mesh: &PolygonMesh, seed: u64) -> PolygonMesh {
    shuffle(mesh, seed).mesh
}

fn shuffle(mesh: &PolygonMesh, seed: u64) -> Reordered {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let vertices = permutation(mesh.vertex_count(), &mut rng);
    let faces = permutation(mesh.face_count(), &mut rng);
    reordered(mesh, &vertices, &faces, |degree| below(degree, &mut rng))
}

/// Returns the mesh in the order of the space-filling curve of Morton (1966). Elements that are
/// near each other in space are then mostly near each other in memory.
///
/// Positions are rounded down to a grid with 2²¹ values along the longest side of the mesh. The
/// code of a position interleaves the bits of its three grid coordinates. Vertices are sorted by
/// their codes, and faces by the codes of their centres. Elements with equal codes keep their
/// order. Time: O(n log n) for n elements.
pub fn morton(mesh: &PolygonMesh) -> PolygonMesh {
    sort_by_morton_code(mesh).mesh
}

fn sort_by_morton_code(mesh: &PolygonMesh) -> Reordered {
    let finite = mesh.positions().iter().filter(|p| p.is_finite());
    let (low, high) = finite.fold((Point::INFINITY, Point::NEG_INFINITY), |(low, high), &p| {
        (low.min(p), high.max(p))
    });
    let low = low.to_array().map(f64::from);
    let longest = (0..3).fold(0.0_f64, |longest, axis| {
        longest.max(f64::from(high[axis]) - low[axis])
    });
    // If the mesh is a single point, the scale is not finite, and all codes are equal.
    let scale = f64::from((1 << 21) - 1) / longest;
    let code = |point: [f64; 3]| {
        let spread = |axis: usize| spread_bits(((point[axis] - low[axis]) * scale) as u32);
        spread(0) | spread(1) << 1 | spread(2) << 2
    };
    let position = |v: VertexId| mesh.position(v).to_array().map(f64::from);
    let mut vertices: Vec<u32> = (0..row(mesh.vertex_count())).collect();
    vertices.sort_by_cached_key(|&v| code(position(VertexId::new(v))));
    let mut faces: Vec<u32> = (0..row(mesh.face_count())).collect();
    faces.sort_by_cached_key(|&f| {
        let corners = mesh.faces().face(FaceId::new(f));
        let sum = corners.iter().fold([0.0; 3], |sum: [f64; 3], &v| {
            let position = position(v);
            std::array::from_fn(|axis| sum[axis] + position[axis])
        });
        code(sum.map(|x| x / corners.len() as f64))
    });
    reordered(mesh, &vertices, &faces, |_| 0)
}

/// Returns the mesh in the order of a breadth-first walk over its faces from vertex 0. Time:
/// O(corners).
///
/// The walk processes the vertices in the order in which it reaches them. At each vertex, the walk
/// appends the unvisited faces around the vertex, and the unreached vertices of these faces. When
/// all reached vertices are processed, the walk continues at the unreached vertex with the lowest
/// number.
pub fn breadth_first(mesh: &PolygonMesh) -> PolygonMesh {
    sort_breadth_first(mesh).mesh
}

fn sort_breadth_first(mesh: &PolygonMesh) -> Reordered {
    let vertex_faces = VertexFaces::new(mesh);
    let mut vertices = Vec::with_capacity(mesh.vertex_count());
    let mut faces = Vec::with_capacity(mesh.face_count());
    let mut reached = vec![false; mesh.vertex_count()];
    let mut visited = vec![false; mesh.face_count()];
    for start in mesh.vertices() {
        if reached[start.index()] {
            continue;
        }
        reached[start.index()] = true;
        let mut next = vertices.len();
        vertices.push(row(start.index()));
        while let Some(&v) = vertices.get(next) {
            next += 1;
            for &f in vertex_faces.faces_at(v) {
                if std::mem::replace(&mut visited[f as usize], true) {
                    continue;
                }
                faces.push(f);
                for &w in mesh.faces().face(FaceId::new(f)) {
                    if !std::mem::replace(&mut reached[w.index()], true) {
                        vertices.push(row(w.index()));
                    }
                }
            }
        }
    }
    reordered(mesh, &vertices, &faces, |_| 0)
}

/// The faces around every vertex, in ascending order.
struct VertexFaces {
    faces: Vec<u32>,
    /// For each vertex, the end of its range in `faces`.
    ends: Vec<u32>,
}

impl VertexFaces {
    fn new(mesh: &PolygonMesh) -> Self {
        let mut ends = vec![0_u32; mesh.vertex_count()];
        for v in mesh.faces().corners() {
            ends[v.index()] += 1;
        }
        let mut total = 0;
        for end in &mut ends {
            total += std::mem::replace(end, total);
        }
        let mut faces = vec![0; total as usize];
        for (f, corners) in (0..).zip(mesh.faces().iter().map(|(_, corners)| corners)) {
            for v in corners {
                let end = &mut ends[v.index()];
                faces[*end as usize] = f;
                *end += 1;
            }
        }
        Self { faces, ends }
    }

    fn faces_at(&self, v: u32) -> &[u32] {
        let v = v as usize;
        let start = if v == 0 { 0 } else { self.ends[v - 1] };
        &self.faces[start as usize..self.ends[v] as usize]
    }
}

/// Returns the mesh with its `vertices` and `faces` in these orders. A face of degree `d` starts at
/// its corner `start(d)`.
fn reordered(
    mesh: &PolygonMesh,
    vertices: &[u32],
    faces: &[u32],
    mut start: impl FnMut(usize) -> usize,
) -> Reordered {
    let mut new_vertices = vec![VertexId::new(0); vertices.len()];
    for (number, &v) in (0..).zip(vertices) {
        new_vertices[v as usize] = VertexId::new(number);
    }
    let position = |&v: &u32| mesh.position(VertexId::new(v));
    let positions = vertices.iter().map(position).collect();
    let mut list = FaceList::with_capacity(mesh.corner_count());
    let mut new_faces = vec![FaceId::new(0); faces.len()];
    for (number, &face) in (0..).zip(faces) {
        new_faces[face as usize] = FaceId::new(number);
        let corners = mesh.faces().face(FaceId::new(face));
        let (tail, head) = corners.split_at(start(corners.len()));
        let corners = head.iter().chain(tail).map(|v| new_vertices[v.index()]);
        list.push(corners)
            .expect("the number of corners is unchanged");
    }
    Reordered {
        mesh: PolygonMesh::from_faces(positions, list)
            .expect("the faces are those of a valid mesh"),
        vertices: new_vertices,
        faces: new_faces,
    }
}

fn permutation(count: usize, rng: &mut ChaCha8Rng) -> Vec<u32> {
    let mut numbers: Vec<u32> = (0..row(count)).collect();
    for last in (1..count).rev() {
        numbers.swap(last, below(last + 1, rng));
    }
    numbers
}

/// Returns a random number below `bound`: the high half of a product. The bias of this method,
/// bound / 2⁶⁴, is negligible.
fn below(bound: usize, rng: &mut ChaCha8Rng) -> usize {
    ((u128::from(rng.next_u64()) * bound as u128) >> 64) as usize
}

/// Returns the low 21 bits of `x`, each followed by two zero bits.
fn spread_bits(x: u32) -> u64 {
    let mut x = u64::from(x.min((1 << 21) - 1));
    x = (x | x << 32) & 0x001F_0000_0000_FFFF;
    x = (x | x << 16) & 0x001F_0000_FF00_00FF;
    x = (x | x << 8) & 0x100F_00F0_0F00_F00F;
    x = (x | x << 4) & 0x10C3_0C30_C30C_30C3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread_to_every_third_position() {
        for bit in 0..21 {
            assert_eq!(spread_bits(1 << bit), 1 << (3 * bit), "bit {bit}");
        }
        assert_eq!(spread_bits(u32::MAX), 0x1249_2492_4924_9249);
    }

    #[test]
    fn a_permutation_contains_every_number_once() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        for count in [0, 1, 2, 3, 100] {
            let mut numbers = permutation(count, &mut rng);
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(0..count as u32), "{count}");
        }
    }

    #[test]
    fn a_seed_gives_a_fixed_order() {
        // Published results with a seed need these values.
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        assert_eq!(permutation(8, &mut rng), [5, 6, 2, 4, 1, 7, 0, 3]);
    }
}
