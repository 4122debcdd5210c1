//! The operations themselves, generic over the structure.
//!
//! Every loop is compiled for each structure, and nothing inside one is chosen at run time. Inner
//! loops are `for_each`: circulators run 5 to 20 % faster so than under `for` (`vertex_normal`,
//! `face_barycenter`, `edge_edges` on icosphere6, in order and shuffled). What an
//! operation stores goes into [`Outputs`], made once per structure: the definition of the workloads
//! keeps outputs outside the timing, but the queue and the depths of `ff_bfs` inside.

use std::hint::black_box;

use sixfold::{FaceMap, Handle, MeshQuery, Point, Relation, VertexMap};

use crate::operation::{Kind, Operation};

/// Which elements an operation goes through.
pub(crate) trait Elements<M: MeshQuery> {
    /// The vertices.
    fn vertices<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Vertex> + 'a;
    /// The edges.
    fn edges<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Edge> + 'a;
    /// The faces.
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

/// Where operations store what they find.
pub(crate) struct Outputs<M: MeshQuery> {
    /// By face: barycentres, or normals.
    pub(crate) faces: FaceMap<M, Point>,
    /// By vertex: normals, or positions.
    pub(crate) vertices: VertexMap<M, Point>,
}

impl<M: MeshQuery> Outputs<M> {
    /// Room for what is found on `mesh`, with a place for every element already made.
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

/// What a loop counted, or added up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tally {
    /// Elements gone through.
    pub(crate) elements: u64,
    /// Handles that relations yielded, or what else the operation counts.
    pub(crate) count: u64,
    /// What the operation sums up.
    pub(crate) sum: f64,
}

impl Tally {
    pub(crate) fn add(&mut self, other: Self) {
        self.elements += other.elements;
        self.count += other.count;
        self.sum += other.sum;
    }
}

/// The checksum of a field of vectors: Σ |x| + 2|y| + 3|z|.
pub fn field_sum(points: impl Iterator<Item = Point>) -> f64 {
    let weigh =
        |p: Point| f64::from(p.x).abs() + 2.0 * f64::from(p.y).abs() + 3.0 * f64::from(p.z).abs();
    points.map(weigh).sum()
}

/// The part of `operation` that goes through elements of `kind`.
#[inline]
pub(crate) fn share<M: MeshQuery, E: Elements<M>>(
    operation: Operation,
    kind: Kind,
    mesh: &M,
    elements: &E,
    outputs: &mut Outputs<M>,
) -> Tally {
    match (operation, kind) {
        (Operation::Relation(relation), _) => ask(relation, mesh, elements),
        (Operation::Circulate, Kind::Vertex) => ask(Relation::VertexFaces, mesh, elements),
        (Operation::Circulate, _) => ask(Relation::FaceVertices, mesh, elements),
        (Operation::FaceBarycenter, _) => face_barycenters(mesh, elements, &mut outputs.faces),
        (Operation::VertexNormal, Kind::Face) => face_normals(mesh, elements, &mut outputs.faces),
        (Operation::VertexNormal, _) => {
            vertex_normals(mesh, elements, &outputs.faces, &mut outputs.vertices)
        }
        (Operation::VvSmooth, _) => neighbour_means(mesh, elements, &mut outputs.vertices),
        (Operation::EdgeLength, _) => edge_lengths(mesh, elements),
        (Operation::Boundary, _) => boundary_edges(mesh, elements),
        (Operation::FfBfs, _) => breadth_first(mesh),
        (Operation::AllQueries, Kind::Vertex) => ask_vertices(mesh, elements),
        (Operation::AllQueries, Kind::Edge) => ask_edges(mesh, elements),
        (Operation::AllQueries, Kind::Face) => ask_faces(mesh, elements),
        // Made by the candidate, not found by queries alone.
        (Operation::Build, _) => Tally::default(),
        (Operation::CatmullClark(_) | Operation::Loop(_) | Operation::Editing(_), _) => {
            Tally::default()
        }
    }
}

/// Counts handles, and adds their tokens up for the sink.
#[derive(Default)]
pub(crate) struct Sink {
    count: u64,
    tokens: u64,
}

impl Sink {
    #[inline(always)]
    pub(crate) fn take<H: Handle>(&mut self, handles: impl IntoIterator<Item = H>) {
        // Added up in registers: a sum behind a reference would be stored for every handle.
        let add = |(count, tokens): (u64, u64), handle: H| {
            (count + 1, tokens.wrapping_add(handle.token()))
        };
        let (count, tokens) = handles.into_iter().fold((0, 0), add);
        self.count += count;
        self.tokens = self.tokens.wrapping_add(tokens);
    }

    /// How many handles it was given; what they are is needed, the compiler has to believe.
    #[inline(always)]
    pub(crate) fn swallow(self) -> u64 {
        black_box(self.tokens);
        self.count
    }
}

/// Asks every element, and gives the sink all that it yields.
#[inline(always)]
fn sweep<I: Iterator>(elements: I, mut ask: impl FnMut(&mut Sink, I::Item)) -> Tally {
    let (mut sink, mut asked) = (Sink::default(), 0);
    elements.for_each(|element| {
        asked += 1;
        ask(&mut sink, element);
    });
    black_box(sink.tokens);
    Tally {
        elements: asked,
        count: sink.count,
        sum: 0.0,
    }
}

#[inline(never)]
fn ask<M: MeshQuery, E: Elements<M>>(relation: Relation, mesh: &M, elements: &E) -> Tally {
    let (vertices, edges, faces) = (
        || elements.vertices(mesh),
        || elements.edges(mesh),
        || elements.faces(mesh),
    );
    match relation {
        Relation::VertexVertices => sweep(vertices(), |sink, v| sink.take(mesh.vertex_vertices(v))),
        Relation::VertexEdges => sweep(vertices(), |sink, v| sink.take(mesh.vertex_edges(v))),
        Relation::VertexFaces => sweep(vertices(), |sink, v| sink.take(mesh.vertex_faces(v))),
        Relation::EdgeVertices => sweep(edges(), |sink, e| sink.take(mesh.edge_vertices(e))),
        Relation::EdgeEdges => sweep(edges(), |sink, e| sink.take(mesh.edge_edges(e))),
        Relation::EdgeFaces => sweep(edges(), |sink, e| sink.take(mesh.edge_faces(e))),
        Relation::FaceVertices => sweep(faces(), |sink, f| sink.take(mesh.face_vertices(f))),
        Relation::FaceEdges => sweep(faces(), |sink, f| sink.take(mesh.face_edges(f))),
        Relation::FaceFaces => sweep(faces(), |sink, f| sink.take(mesh.face_faces(f))),
    }
}

#[inline(never)]
fn ask_vertices<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> Tally {
    sweep(elements.vertices(mesh), |sink, v| {
        sink.take(mesh.vertex_vertices(v));
        sink.take(mesh.vertex_edges(v));
        sink.take(mesh.vertex_faces(v));
    })
}

#[inline(never)]
fn ask_edges<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> Tally {
    sweep(elements.edges(mesh), |sink, e| {
        sink.take(mesh.edge_vertices(e));
        sink.take(mesh.edge_edges(e));
        sink.take(mesh.edge_faces(e));
    })
}

#[inline(never)]
fn ask_faces<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> Tally {
    sweep(elements.faces(mesh), |sink, f| {
        sink.take(mesh.face_vertices(f));
        sink.take(mesh.face_edges(f));
        sink.take(mesh.face_faces(f));
    })
}

/// Does `work` for each element and counts them.
#[inline(always)]
fn each<I: Iterator>(elements: I, mut work: impl FnMut(I::Item)) -> Tally {
    let mut count = 0;
    elements.for_each(|element| {
        count += 1;
        work(element);
    });
    Tally {
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
) -> Tally {
    each(elements.faces(mesh), |f| {
        let (mut sum, mut corners) = (Point::ZERO, 0_u32);
        mesh.face_vertices(f).for_each(|v| {
            sum += mesh.position(v);
            corners += 1;
        });
        barycenters[f] = sum * (1.0 / corners as f32);
    })
}

/// The normal of a face, unnormalised: the cross products of the fan from its first corner.
#[inline(always)]
fn face_normal<M: MeshQuery>(mesh: &M, f: M::Face) -> Point {
    // No `map` to positions first: its `fold` is not inlined everywhere, and a call per face shows.
    let mut corners = mesh.face_vertices(f);
    let (Some(first), Some(second)) = (corners.next(), corners.next()) else {
        return Point::ZERO; // a face has three corners: never, and no panic to compile in
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
) -> Tally {
    each(elements.faces(mesh), |f| normals[f] = face_normal(mesh, f))
}

#[inline(never)]
fn vertex_normals<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    face_normals: &FaceMap<M, Point>,
    normals: &mut VertexMap<M, Point>,
) -> Tally {
    each(elements.vertices(mesh), |v| {
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

/// The mean of each vertex's neighbours; an isolated vertex stays.
#[inline(never)]
fn neighbour_means<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    means: &mut VertexMap<M, Point>,
) -> Tally {
    each(elements.vertices(mesh), |v| {
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
fn edge_lengths<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> Tally {
    let mut sum = 0.0;
    let tally = each(elements.edges(mesh), |e| {
        let [a, b] = mesh.edge_vertices(e);
        sum += f64::from(mesh.position(a).distance(mesh.position(b)));
    });
    Tally { sum, ..tally }
}

#[inline(never)]
fn boundary_edges<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> Tally {
    let mut count = 0;
    let tally = each(elements.edges(mesh), |e| {
        count += u64::from(mesh.edge_faces(e).count() == 1);
    });
    Tally { count, ..tally }
}

/// The sum of all depths; the queue and the depths are made here, once.
///
/// A neighbour is written behind the queue whether it is new or not, and the queue grows by it only
/// if it is: two of three neighbours are known already, in an order that no processor foresees.
/// Measured on half-edge, ns per face with that branch / without it / and with `for_each`: icosphere6
/// 23 / 24 / 19, bunny 21 / 18 / 11, nefertiti 30 / 28 / 20.
#[inline(never)]
fn breadth_first<M: MeshQuery>(mesh: &M) -> Tally {
    const UNSEEN: u32 = u32::MAX;
    let Some(first) = mesh.faces().next() else {
        return Tally::default();
    };
    let mut depths = mesh.face_map(UNSEEN);
    let mut queue = vec![first; mesh.face_count() + 1];
    let (mut head, mut tail, mut sum) = (0, 0, 0_u64);
    for seed in mesh.faces() {
        if depths[seed] != UNSEEN {
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
                let new = *seen == UNSEEN;
                *seen = if new { depth + 1 } else { *seen };
                queue[tail] = neighbour;
                tail += usize::from(new);
            });
        }
    }
    Tally {
        elements: tail as u64,
        count: sum,
        sum: 0.0,
    }
}
