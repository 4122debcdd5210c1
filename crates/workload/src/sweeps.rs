//! The loops of the operations, generic over the structure.
//!
//! Every loop is compiled separately for each structure. Inner loops use `for_each`: circulators
//! are 5 to 20 % faster with it than with `for` (`vertex_normal`, `face_barycenter`, `edge_edges`
//! on icosphere6, in order and shuffled).
//!
//! The loops over all elements must be fast without inlining, because inlining differs between
//! programs. A closure that changes captured variables and is not inlined keeps these variables in
//! memory, and loads the addresses of all tables again for each element. Therefore the loops pass
//! sums by value with `fold`, or store results with `for`.
//!
//! Operations store their results in [`Outputs`]. Outputs are allocated once per structure, while
//! the clock is stopped. The queue and the depths of `ff_bfs` are allocated while the clock runs.

use std::hash::Hasher;
use std::hint::black_box;

use sixfold::{FaceMap, Handle, MeshQuery, Point, Relation, VertexMap};

use crate::operation::{ElementKind, Operation};

/// The elements that an operation visits.
pub(crate) trait Elements<M: MeshQuery> {
    fn vertices<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Vertex> + 'a;
    fn edges<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Edge> + 'a;
    fn faces<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Face> + 'a;
}

/// All elements, in the order of the structure.
pub(crate) struct All;

impl<M: MeshQuery> Elements<M> for All {
    fn vertices<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Vertex> + 'a {
        mesh.vertices()
    }
    fn edges<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Edge> + 'a {
        mesh.edges()
    }
    fn faces<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Face> + 'a {
        mesh.faces()
    }
}

/// The storage for the results of operations.
pub(crate) struct Outputs<M: MeshQuery> {
    /// Barycentres or normals of the faces.
    pub(crate) faces: FaceMap<M, Point>,
    /// Normals or positions of the vertices.
    pub(crate) vertices: VertexMap<M, Point>,
}

impl<M: MeshQuery> Outputs<M> {
    pub(crate) fn for_mesh(mesh: &M) -> Self {
        let mut outputs = Self {
            faces: mesh.face_map(Point::ZERO),
            vertices: mesh.vertex_map(Point::ZERO),
        };
        for v in mesh.vertices() {
            outputs.vertices[v] = mesh.position(v);
        }
        for f in mesh.faces() {
            outputs.faces[f] = Point::ZERO;
        }
        outputs
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SweepResult {
    /// Number of visited elements.
    pub(crate) elements: u64,
    /// Number of handles that relations yielded, or another count.
    pub(crate) count: u64,
    pub(crate) sum: f64,
}

impl SweepResult {
    pub(crate) fn add(&mut self, other: Self) {
        self.elements += other.elements;
        self.count += other.count;
        self.sum += other.sum;
    }
}

/// Returns a checksum of vectors: the sum of |x| + 2|y| + 3|z| over all vectors (x, y, z).
pub fn field_sum(points: impl Iterator<Item = Point>) -> f64 {
    let weighted_sum =
        |p: Point| f64::from(p.x).abs() + 2.0 * f64::from(p.y).abs() + 3.0 * f64::from(p.z).abs();
    points.map(weighted_sum).sum()
}

/// Runs the part of `operation` that visits elements of `kind`.
#[inline]
pub(crate) fn sweep_kind<M: MeshQuery, E: Elements<M>>(
    operation: Operation,
    kind: ElementKind,
    mesh: &M,
    elements: &E,
    outputs: &mut Outputs<M>,
) -> SweepResult {
    match (operation, kind) {
        (Operation::Relation(relation), _) => query_relation(relation, mesh, elements),
        (Operation::Circulate, ElementKind::Vertex) => {
            query_relation(Relation::VertexFaces, mesh, elements)
        }
        (Operation::Circulate, _) => query_relation(Relation::FaceVertices, mesh, elements),
        (Operation::FaceBarycenter, _) => face_barycenters(mesh, elements, &mut outputs.faces),
        (Operation::VertexNormal, ElementKind::Face) => {
            face_normals(mesh, elements, &mut outputs.faces)
        }
        (Operation::VertexNormal, _) => {
            vertex_normals(mesh, elements, &outputs.faces, &mut outputs.vertices)
        }
        (Operation::VvSmooth, _) => neighbour_means(mesh, elements, &mut outputs.vertices),
        (Operation::EdgeLength, _) => edge_lengths(mesh, elements),
        (Operation::Boundary, _) => boundary_edges(mesh, elements),
        (Operation::FfBfs, _) => breadth_first(mesh),
        (Operation::AllQueries, ElementKind::Vertex) => query_vertices(mesh, elements),
        (Operation::AllQueries, ElementKind::Edge) => query_edges(mesh, elements),
        (Operation::AllQueries, ElementKind::Face) => query_faces(mesh, elements),
        // `TimedStructure` runs these operations.
        (Operation::Build, _) => SweepResult::default(),
        (Operation::CatmullClark(_) | Operation::Loop(_) | Operation::EditPass(_), _) => {
            SweepResult::default()
        }
    }
}

/// Computes a number from a handle in a few instructions. Equal handles have equal numbers.
#[inline(always)]
fn token<H: Handle>(handle: H) -> u64 {
    /// A hasher that adds the words of a handle, with a rotation before each word.
    struct Words(u64);

    impl Hasher for Words {
        #[inline(always)]
        fn write_u32(&mut self, word: u32) {
            self.write_u64(u64::from(word));
        }

        #[inline(always)]
        fn write_u64(&mut self, word: u64) {
            self.0 = self.0.rotate_left(8).wrapping_add(word);
        }

        #[inline(always)]
        fn write_usize(&mut self, word: usize) {
            self.write_u64(word as u64);
        }

        fn write(&mut self, bytes: &[u8]) {
            for &byte in bytes {
                self.write_u64(u64::from(byte));
            }
        }

        #[inline(always)]
        fn finish(&self) -> u64 {
            self.0
        }
    }

    let mut words = Words(0);
    handle.hash(&mut words);
    words.finish()
}

/// Counts handles and adds their tokens, so that the compiler cannot omit the handles. It is passed by
/// value, so that the sums stay in registers: behind a reference, `vertex_vertices` of a winged-edge mesh
/// took 17 ns for a vertex instead of 7.7.
#[derive(Clone, Copy, Default)]
pub(crate) struct Sink {
    count: u64,
    tokens: u64,
}

impl Sink {
    #[inline(always)]
    pub(crate) fn with<H: Handle>(self, handles: impl IntoIterator<Item = H>) -> Self {
        handles.into_iter().fold(self, |sink, handle| Self {
            count: sink.count + 1,
            tokens: sink.tokens.wrapping_add(token(handle)),
        })
    }

    /// Returns the number of handles. `black_box` makes the compiler compute all handles.
    #[inline(always)]
    pub(crate) fn finish_count(self) -> u64 {
        black_box(self.tokens);
        self.count
    }
}

#[inline(always)]
fn sweep<I: Iterator>(elements: I, query: impl Fn(Sink, I::Item) -> Sink) -> SweepResult {
    let (sink, queried) = elements.fold((Sink::default(), 0), |(sink, queried), element| {
        (query(sink, element), queried + 1)
    });
    black_box(sink.tokens);
    SweepResult {
        elements: queried,
        count: sink.count,
        sum: 0.0,
    }
}

/// Queries `relation` of all elements.
///
/// Each loop is a function of its own, of the shape that programs of users have. In one function with
/// nine loops, the compiler changes the loops: on an Intel Xeon (family 6, model 167), `face_vertices`
/// of a half-edge mesh then took 1.57 ns for a face instead of 1.42. `benches/checks/plain_program.py`
/// compares each loop with a program of a user.
#[inline]
fn query_relation<M: MeshQuery, E: Elements<M>>(
    relation: Relation,
    mesh: &M,
    elements: &E,
) -> SweepResult {
    macro_rules! sweep_relation {
        ($query:ident $list:ident $from:ident $to:ident) => {{
            #[inline(never)]
            fn $query<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
                sweep(elements.$list(mesh), |sink, element| {
                    sink.with(mesh.$query(element))
                })
            }
            $query(mesh, elements)
        }};
    }
    sixfold_core::match_relation!(relation, sweep_relation!)
}

#[inline(never)]
fn query_vertices<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    sweep(elements.vertices(mesh), |sink, v| {
        let sink = sink.with(mesh.vertex_vertices(v));
        let sink = sink.with(mesh.vertex_edges(v));
        sink.with(mesh.vertex_faces(v))
    })
}

#[inline(never)]
fn query_edges<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    sweep(elements.edges(mesh), |sink, e| {
        let sink = sink.with(mesh.edge_vertices(e));
        let sink = sink.with(mesh.edge_edges(e));
        sink.with(mesh.edge_faces(e))
    })
}

#[inline(never)]
fn query_faces<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    sweep(elements.faces(mesh), |sink, f| {
        let sink = sink.with(mesh.face_vertices(f));
        let sink = sink.with(mesh.face_edges(f));
        sink.with(mesh.face_faces(f))
    })
}

/// Calls `store` for each element, and counts the elements.
#[inline(always)]
fn count_each<I: Iterator>(elements: I, mut store: impl FnMut(I::Item)) -> SweepResult {
    let mut count = 0;
    for element in elements {
        count += 1;
        store(element);
    }
    SweepResult {
        elements: count,
        count,
        sum: 0.0,
    }
}

#[inline(never)]
fn face_barycenters<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    barycenters: &mut FaceMap<M, Point>,
) -> SweepResult {
    count_each(elements.faces(mesh), |f| {
        let (mut sum, mut corners) = (Point::ZERO, 0_u32);
        mesh.face_vertices(f).for_each(|v| {
            sum += mesh.position(v);
            corners += 1;
        });
        barycenters[f] = sum * (1.0 / corners as f32);
    })
}

/// Returns the unnormalised normal of a face: the sum of the cross products of its fan triangles.
#[inline(always)]
fn face_normal<M: MeshQuery>(mesh: &M, f: M::Face) -> Point {
    // Positions are read without `map`, because the `fold` of `map` is not always inlined.
    let mut corners = mesh.face_vertices(f);
    let (Some(first), Some(second)) = (corners.next(), corners.next()) else {
        return Point::ZERO; // unreachable, as a face has three corners; avoids the code of a panic
    };
    let first = mesh.position(first);
    let (mut spoke, mut normal) = (mesh.position(second) - first, Point::ZERO);
    for corner in corners {
        let next = mesh.position(corner) - first;
        normal += spoke.cross(next);
        spoke = next;
    }
    normal
}

#[inline(never)]
fn face_normals<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    normals: &mut FaceMap<M, Point>,
) -> SweepResult {
    count_each(elements.faces(mesh), |f| normals[f] = face_normal(mesh, f))
}

#[inline(never)]
fn vertex_normals<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    face_normals: &FaceMap<M, Point>,
    normals: &mut VertexMap<M, Point>,
) -> SweepResult {
    count_each(elements.vertices(mesh), |v| {
        let mut sum = Point::ZERO;
        mesh.vertex_faces(v).for_each(|f| sum += face_normals[f]);
        let length = sum.length();
        normals[v] = if length > 0.0 {
            sum * (1.0 / length)
        } else {
            sum
        };
    })
}

/// Computes the mean of the neighbours of each vertex. An isolated vertex keeps its position.
#[inline(never)]
fn neighbour_means<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    means: &mut VertexMap<M, Point>,
) -> SweepResult {
    count_each(elements.vertices(mesh), |v| {
        let (mut sum, mut valence) = (Point::ZERO, 0_u32);
        mesh.vertex_vertices(v).for_each(|neighbour| {
            sum += mesh.position(neighbour);
            valence += 1;
        });
        means[v] = if valence > 0 {
            sum * (1.0 / valence as f32)
        } else {
            mesh.position(v)
        };
    })
}

#[inline(never)]
fn edge_lengths<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    let (count, sum) = elements.edges(mesh).fold((0, 0.0), |(count, sum), e| {
        let [a, b] = mesh.edge_vertices(e);
        let length = mesh.position(a).distance(mesh.position(b));
        (count + 1, sum + f64::from(length))
    });
    SweepResult {
        elements: count,
        count,
        sum,
    }
}

#[inline(never)]
fn boundary_edges<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    let (edges, boundary) = elements.edges(mesh).fold((0, 0), |(edges, boundary), e| {
        let is_boundary = mesh.edge_faces(e).count() == 1;
        (edges + 1, boundary + u64::from(is_boundary))
    });
    SweepResult {
        elements: edges,
        count: boundary,
        sum: 0.0,
    }
}

/// Returns the sum of all depths.
///
/// Every neighbour is written to the end of the queue, but the queue grows only if the neighbour is
/// new. This avoids a branch that a processor cannot predict.
#[inline(never)]
fn breadth_first<M: MeshQuery>(mesh: &M) -> SweepResult {
    const UNVISITED: u32 = u32::MAX;
    let Some(first) = mesh.faces().next() else {
        return SweepResult::default();
    };
    let mut depths = mesh.face_map(UNVISITED);
    let mut queue = vec![first; mesh.face_count() + 1];
    let (mut head, mut tail, mut sum) = (0, 0, 0_u64);
    for seed in mesh.faces() {
        if depths[seed] != UNVISITED {
            continue;
        }
        depths[seed] = 0;
        queue[tail] = seed;
        tail += 1;
        while head < tail {
            let face = queue[head];
            head += 1;
            let depth = depths[face];
            sum += u64::from(depth);
            mesh.face_faces(face).for_each(|neighbour| {
                let seen = &mut depths[neighbour];
                let new = *seen == UNVISITED;
                *seen = if new { depth + 1 } else { *seen };
                queue[tail] = neighbour;
                tail += usize::from(new);
            });
        }
    }
    SweepResult {
        elements: tail as u64,
        count: sum,
        sum: 0.0,
    }
}
