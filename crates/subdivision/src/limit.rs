//! Limit positions and normals of the vertices of Catmull–Clark and Loop, after infinitely many
//! levels.
//!
//! A subdivision step multiplies the positions around a vertex by a matrix. The matrix has the same
//! left eigenvectors at every level. The left eigenvector of the eigenvalue 1 gives the limit
//! position. The left eigenvectors of the next two eigenvalues give tangents.
//!
//! ```text
//!   smooth, Catmull–Clark       smooth, Loop          crease            corner
//!
//!      1 ── 4 ── 1               ω ─── ω               1/6
//!      │    │    │              / \   / \               │
//!      4 ── n² ─ 4             ω ── v ── ω             2/3              stays
//!      │    │    │              \ / \ /                 │
//!      1 ── 4 ── 1               ω ─── ω               1/6
//!      over n(n + 5)           1/(n + 3/(8β))
//! ```
//!
//! Positions: Halstead, Kass & DeRose (1993), Loop (1987). Tangents: `tangent.rs`.

use sixfold_core::{Creases, FaceId, MeshQuery, Point, SHARPNESS_INFINITE, VertexId, VertexMap};

use crate::crease::{Rule, is_semi_sharp};
use crate::error::SubdivisionError;
use crate::loop_scheme::beta;
use crate::scheme::Scheme;
use crate::step::CreaseVertices;
use crate::subdivision::Subdivision;
use crate::tangent::{Fan, Surface, far_corner, normal, rounding};

/// The limit position and the limit normal of a vertex after infinitely many levels, or the reason
/// why the crate cannot compute them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitPoint {
    /// The limit position of the vertex, and its limit normal.
    Defined {
        /// The position on the limit surface.
        position: Point,
        /// The normal of the limit surface.
        normal: LimitNormal,
    },
    /// The crate cannot compute the limit of the vertex at this level.
    Undefined(NoLimit),
}

/// The normal of the limit surface at a vertex. A normal has length 1 and points to the side from
/// which the faces run counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitNormal {
    /// The vertex has one normal.
    One(Point),
    /// A crease passes through the vertex, and each side of the crease has its own normal. The
    /// first normal is for the faces that follow counter-clockwise after the crease edge to the
    /// neighbour with the lower number. The second normal is for the other faces.
    TwoSides([Point; 2]),
    /// The crate cannot compute a normal for the vertex. The possible reasons are:
    ///
    /// - The vertex is a corner with several faces.
    /// - An adjacent face is not a quad (Catmull–Clark only).
    /// - The vertex is an inner vertex of valence 2.
    /// - The faces at the vertex do not form one oriented fan.
    /// - The faces at the vertex have no area.
    Undefined,
}

/// The reason why a vertex has no limit at this level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum NoLimit {
    /// The vertex or one of its edges has a finite sharpness above 0. The limit is defined at a
    /// later level.
    SemiSharp,
    /// A face at the vertex is not a quad, and the Catmull–Clark mask needs quads. The limit is
    /// defined after the next step.
    NotAllQuads,
    /// Exactly one crease edge ends at the vertex. The crate has no limit mask for this case.
    Dart,
}

impl LimitPoint {
    /// Returns the limit position, or `None` if the limit is [`Undefined`](Self::Undefined).
    pub fn position(self) -> Option<Point> {
        match self {
            Self::Defined { position, .. } => Some(position),
            Self::Undefined(_) => None,
        }
    }

    /// Returns the limit normal, or `None` if the normal is undefined. On a crease with two
    /// normals, returns a normal with the direction of their mean.
    pub fn normal(self) -> Option<Point> {
        match self {
            Self::Defined { normal, .. } => match normal {
                LimitNormal::One(normal) => Some(normal),
                LimitNormal::TwoSides([a, b]) => {
                    let sum = a + b;
                    // If the normals are opposite, the sum is only rounding error.
                    (sum.length() > 1e-3).then(|| sum.normalize())
                }
                LimitNormal::Undefined => None,
            },
            Self::Undefined(_) => None,
        }
    }
}

impl Subdivision {
    /// Returns the limit of each vertex of `mesh` after infinitely many levels, for Catmull–Clark
    /// and Loop.
    ///
    /// `creases` are the creases of `mesh.to_polygons()`, from
    /// [`control_creases`](Self::control_creases) or from the step that made the mesh. At a vertex
    /// of a face that is not a quad, Catmull–Clark has limits only on creases and at corners. After
    /// one step, all faces are quads. Each vertex takes O(valence log valence) time, plus the costs
    /// of the queries EF, VV, VF and FV.
    ///
    /// # Errors
    ///
    /// Returns [`SubdivisionError::NoLimit`] for schemes other than Catmull–Clark and Loop. Returns
    /// [`SubdivisionError::NotATriangle`] if the scheme is Loop and a face is not a triangle.
    pub fn limit<M: MeshQuery>(
        &self,
        mesh: &M,
        creases: &Creases,
    ) -> Result<VertexMap<M, LimitPoint>, SubdivisionError> {
        match self.scheme {
            Scheme::CatmullClark => Ok(limits(mesh, creases, Surface::CatmullClark)),
            Scheme::Loop => {
                check_triangles(mesh, self.scheme)?;
                Ok(limits(mesh, creases, Surface::Loop(self.loop_weights)))
            }
            scheme => Err(SubdivisionError::NoLimit { scheme }),
        }
    }
}

fn check_triangles<M: MeshQuery>(mesh: &M, scheme: Scheme) -> Result<(), SubdivisionError> {
    let degrees = mesh.faces().map(|f| mesh.face_vertices(f).count());
    match (0..).zip(degrees).find(|&(_, degree)| degree != 3) {
        Some((face, degree)) => Err(SubdivisionError::NotATriangle {
            scheme,
            face: FaceId::new(face),
            degree,
        }),
        None => Ok(()),
    }
}

/// One end of a sharp edge.
struct Spoke<V> {
    at: u32,
    far: V,
    sharpness: f32,
}

/// Returns the two spokes of every sharp edge, sorted by vertex and then by far end.
fn spokes<M: MeshQuery>(mesh: &M, creases: &Creases) -> Vec<Spoke<M::Vertex>> {
    let numbers = mesh.vertex_numbers();
    let crease_vertices = CreaseVertices::new(creases, mesh.vertex_count());
    let mut spokes = Vec::new();
    for e in mesh.edges() {
        let ends = mesh.edge_vertices(e);
        let by_topology = mesh.edge_faces(e).count() != 2;
        let sharpness = crease_vertices.sharpness(creases, ends.map(|v| numbers[v]), by_topology);
        if sharpness > 0.0 {
            let [a, b] = ends;
            spokes.extend([(a, b), (b, a)].map(|(at, far)| Spoke {
                at: numbers[at],
                far,
                sharpness,
            }));
        }
    }
    spokes.sort_unstable_by_key(|spoke| (spoke.at, numbers[spoke.far]));
    spokes
}

fn limits<M: MeshQuery>(mesh: &M, creases: &Creases, surface: Surface) -> VertexMap<M, LimitPoint> {
    let mut limits = mesh.vertex_map(LimitPoint::Undefined(NoLimit::Dart));
    let all = spokes(mesh, creases);
    let mut rest = all.as_slice();
    for (number, v) in (0..).zip(mesh.vertices()) {
        let around = rest.iter().take_while(|spoke| spoke.at == number).count();
        let (around, after) = rest.split_at(around);
        rest = after;
        let own = creases.corner(VertexId::new(number));
        limits[v] = limit_of(mesh, v, own, around, surface);
    }
    limits
}

/// Returns the limit of `v` with the sharpness `own` and the sharp edges `around`. Edges that do
/// not end at `v` do not change its limit.
fn limit_of<M: MeshQuery>(
    mesh: &M,
    v: M::Vertex,
    own: f32,
    around: &[Spoke<M::Vertex>],
    surface: Surface,
) -> LimitPoint {
    let at = mesh.position(v);
    let infinite = around
        .iter()
        .filter(|spoke| spoke.sharpness >= SHARPNESS_INFINITE);
    let is_corner = own >= SHARPNESS_INFINITE || infinite.count() > 2;
    let mut sharpness = around.iter().map(|spoke| spoke.sharpness).chain([own]);
    if !is_corner && sharpness.any(is_semi_sharp) {
        return LimitPoint::Undefined(NoLimit::SemiSharp);
    }
    match Rule::new(own, around.len()) {
        Rule::Corner => LimitPoint::Defined {
            position: at,
            normal: corner_normal(mesh, v),
        },
        Rule::Crease => {
            let ends = [around[0].far, around[1].far];
            let [a, b] = ends.map(|end| mesh.position(end));
            LimitPoint::Defined {
                position: (a + at * 4.0 + b) / 6.0,
                normal: crease_normal(mesh, v, ends, surface),
            }
        }
        Rule::Smooth if !around.is_empty() => LimitPoint::Undefined(NoLimit::Dart),
        Rule::Smooth => smooth_limit(mesh, v, surface),
    }
}

/// Returns the normal of a corner. It is defined only if the corner has one face.
fn corner_normal<M: MeshQuery>(mesh: &M, v: M::Vertex) -> LimitNormal {
    let mut faces = mesh.vertex_faces(v);
    let (Some(face), None) = (faces.next(), faces.next()) else {
        return LimitNormal::Undefined;
    };
    let corners: Vec<M::Vertex> = mesh.face_vertices(face).collect();
    let n = corners.len();
    let place = corners.iter().position(|&corner| corner == v);
    let place = place.expect("VF and FV agree");
    let at = mesh.position(v);
    let edges = [1, n - 1].map(|steps| mesh.position(corners[(place + steps) % n]) - at);
    single_normal(normal(edges, rounding(at, &edges)))
}

fn smooth_limit<M: MeshQuery>(mesh: &M, v: M::Vertex, surface: Surface) -> LimitPoint {
    let at = mesh.position(v);
    let (mut neighbours, mut valence) = (Point::ZERO, 0_usize);
    mesh.vertex_vertices(v).for_each(|w| {
        neighbours += mesh.position(w);
        valence += 1;
    });
    if valence == 0 {
        // A step does not move an isolated vertex.
        return LimitPoint::Defined {
            position: at,
            normal: LimitNormal::Undefined,
        };
    }
    let n = valence as f64;
    let position = match surface {
        Surface::CatmullClark => {
            let far = mesh.vertex_faces(v).map(|f| far_corner(mesh, v, f));
            let far: Option<Point> = far.map(|far| Some(far?.1)).sum();
            let Some(far) = far else {
                return LimitPoint::Undefined(NoLimit::NotAllQuads);
            };
            (at * (n * n) as f32 + neighbours * 4.0 + far) / (n * (n + 5.0)) as f32
        }
        Surface::Loop(weights) => {
            let omega = 1.0 / (n + 3.0 / (8.0 * beta(weights, valence)));
            at * (1.0 - n * omega) as f32 + neighbours * omega as f32
        }
    };
    let fan = Fan::new(mesh, v, surface);
    let normal = fan.and_then(|fan| normal(fan.tangents(surface), fan.rounding));
    LimitPoint::Defined {
        position,
        normal: single_normal(normal),
    }
}

fn crease_normal<M: MeshQuery>(
    mesh: &M,
    v: M::Vertex,
    ends: [M::Vertex; 2],
    surface: Surface,
) -> LimitNormal {
    let Some(fan) = Fan::new(mesh, v, surface) else {
        return LimitNormal::Undefined;
    };
    let place = |end: M::Vertex| fan.neighbours.iter().position(|&w| w == end);
    let (Some(first), Some(second)) = (place(ends[0]), place(ends[1])) else {
        return LimitNormal::Undefined;
    };
    let side = |from, to| normal(fan.sector(from, to).tangents(surface), fan.rounding);
    let last = fan.neighbours.len() - 1;
    if [first.min(second), first.max(second)] == [0, last] && !fan.is_closed {
        return single_normal(side(0, last));
    }
    match (side(first, second), side(second, first)) {
        (Some(a), Some(b)) if fan.is_closed => LimitNormal::TwoSides([a, b]),
        _ => LimitNormal::Undefined,
    }
}

fn single_normal(normal: Option<Point>) -> LimitNormal {
    normal.map_or(LimitNormal::Undefined, LimitNormal::One)
}
