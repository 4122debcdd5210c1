//! Where the vertices of Catmull–Clark and Loop go in endless levels, and how the surface stands there.
//!
//! A step is a matrix on the neighbourhood of a vertex. Its left eigenvectors do not change from level
//! to level: that of the eigenvalue 1 is the limit position, those of the next two are tangents.
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

use mesh_core::{Creases, FaceId, MeshQuery, Point, SHARP_FOR_EVER, VertexId, VertexMap};

use crate::crease::{Rule, is_semi_sharp};
use crate::error::SubdivisionError;
use crate::loop_scheme::beta;
use crate::scheme::Scheme;
use crate::step::Marked;
use crate::subdivision::Subdivision;
use crate::tangent::{Fan, Surface, far_corner, normal, rounding};

/// What becomes of a vertex in endless levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitPoint {
    /// It comes to a place that its neighbourhood tells at once.
    Defined {
        /// The place on the limit surface.
        position: Point,
        /// How the surface stands there.
        normal: LimitNormal,
    },
    /// No mask tells its place at this level.
    Undefined(NoLimit),
}

/// How the limit surface stands at a vertex; normals have length 1 and point to the side from which
/// faces run counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitNormal {
    /// It has this normal.
    One(Point),
    /// A crease runs through: it has one normal on each side, first that of the faces which come
    /// counter-clockwise after the crease's end with the lower number.
    TwoSides([Point; 2]),
    /// It has none that a mask tells: at corners of several faces, where a face beside it is no quad
    /// (Catmull–Clark), inside at valence 2, where faces are not one oriented fan, and where the
    /// neighbourhood has no area.
    Undefined,
}

/// Why a vertex has no limit at this level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum NoLimit {
    /// It, or an edge there, is sharp for some levels yet: a later level tells.
    SemiSharp,
    /// A face there is no quad, and Catmull–Clark's mask is for quads: the next level tells.
    NotAllQuads,
    /// One crease ends there: the rules of a step have no mask for it.
    Dart,
}

impl LimitPoint {
    /// Where it comes to, if that is defined.
    pub fn position(self) -> Option<Point> {
        match self {
            Self::Defined { position, .. } => Some(position),
            Self::Undefined(_) => None,
        }
    }

    /// Its normal, if that is defined; on a crease the mean of both sides.
    pub fn normal(self) -> Option<Point> {
        match self {
            Self::Defined { normal, .. } => match normal {
                LimitNormal::One(normal) => Some(normal),
                LimitNormal::TwoSides([a, b]) => {
                    let sum = a + b;
                    // Where the sides lie back to back what is left of the sum is rounding.
                    (sum.length() > 1e-3).then(|| sum.normalize())
                }
                LimitNormal::Undefined => None,
            },
            Self::Undefined(_) => None,
        }
    }
}

impl Subdivision {
    /// Where each vertex of `mesh` goes in endless levels, of Catmull–Clark and Loop.
    ///
    /// `creases` are those of `mesh.to_polygons()`, from [`control`](Self::control) or the step that
    /// made it. Of n-gons the limit is defined on creases and at corners, and everywhere after one
    /// step. O(valence log valence) a vertex beyond the costs of EF, VV, VF and FV.
    ///
    /// # Errors
    ///
    /// [`SubdivisionError::NoLimit`] for other schemes, and a face that Loop cannot split.
    pub fn limit<M: MeshQuery>(
        &self,
        mesh: &M,
        creases: &Creases,
    ) -> Result<VertexMap<M, LimitPoint>, SubdivisionError> {
        match self.scheme {
            Scheme::CatmullClark => Ok(limits(mesh, creases, Surface::CatmullClark)),
            Scheme::Loop => {
                all_triangles(mesh, self.scheme)?;
                Ok(limits(mesh, creases, Surface::Loop(self.loop_weights)))
            }
            scheme => Err(SubdivisionError::NoLimit { scheme }),
        }
    }
}

/// That every face has three corners.
fn all_triangles<M: MeshQuery>(mesh: &M, scheme: Scheme) -> Result<(), SubdivisionError> {
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

/// A sharp edge as one of its ends sees it.
struct Spoke<V> {
    at: u32,
    far: V,
    sharpness: f32,
}

/// Both views of every sharp edge, in the order of the vertices, and of the far ends there.
fn spokes<M: MeshQuery>(mesh: &M, creases: &Creases) -> Vec<Spoke<M::Vertex>> {
    let mut numbers = mesh.vertex_map(0_u32);
    for (number, v) in (0..).zip(mesh.vertices()) {
        numbers[v] = number;
    }
    let marked = Marked::of(creases, mesh.vertex_count());
    let mut spokes = Vec::new();
    for e in mesh.edges() {
        let ends = mesh.edge_vertices(e);
        let by_nature = mesh.edge_faces(e).count() != 2;
        let sharpness = marked.sharpness(creases, ends.map(|v| numbers[v]), by_nature);
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

/// The limit of `v`, of the sharpness `own` and with these sharp edges.
///
/// Edges that do not end at `v` do not matter, sharp or not: the next ring around it is made of the
/// points of its own edges and faces.
fn limit_of<M: MeshQuery>(
    mesh: &M,
    v: M::Vertex,
    own: f32,
    around: &[Spoke<M::Vertex>],
    surface: Surface,
) -> LimitPoint {
    let at = mesh.position(v);
    let for_ever = around
        .iter()
        .filter(|spoke| spoke.sharpness >= SHARP_FOR_EVER);
    let is_corner = own >= SHARP_FOR_EVER || for_ever.count() > 2;
    let mut sharpness = around.iter().map(|spoke| spoke.sharpness).chain([own]);
    if !is_corner && sharpness.any(is_semi_sharp) {
        return LimitPoint::Undefined(NoLimit::SemiSharp);
    }
    match Rule::of(own, around.len()) {
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

/// The normal of a vertex with one face: the rules keep its two edges where they are. Of more faces
/// no two need lie in one plane.
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
    one(normal(edges, rounding(at, &edges)))
}

fn smooth_limit<M: MeshQuery>(mesh: &M, v: M::Vertex, surface: Surface) -> LimitPoint {
    let at = mesh.position(v);
    let (mut neighbours, mut valence) = (Point::ZERO, 0_usize);
    mesh.vertex_vertices(v).for_each(|w| {
        neighbours += mesh.position(w);
        valence += 1;
    });
    if valence == 0 {
        // Isolated: every step leaves it where it is.
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
    let fan = Fan::around(mesh, v, surface);
    let normal = fan.and_then(|fan| normal(fan.tangents(surface), fan.rounding));
    LimitPoint::Defined {
        position,
        normal: one(normal),
    }
}

fn crease_normal<M: MeshQuery>(
    mesh: &M,
    v: M::Vertex,
    ends: [M::Vertex; 2],
    surface: Surface,
) -> LimitNormal {
    let Some(fan) = Fan::around(mesh, v, surface) else {
        return LimitNormal::Undefined;
    };
    let place = |end: M::Vertex| fan.names.iter().position(|&name| name == end);
    let (Some(first), Some(second)) = (place(ends[0]), place(ends[1])) else {
        return LimitNormal::Undefined;
    };
    let side = |from, to| normal(fan.sector(from, to).tangents(surface), fan.rounding);
    let last = fan.names.len() - 1;
    if [first.min(second), first.max(second)] == [0, last] && !fan.is_closed {
        return one(side(0, last));
    }
    match (side(first, second), side(second, first)) {
        (Some(a), Some(b)) if fan.is_closed => LimitNormal::TwoSides([a, b]),
        _ => LimitNormal::Undefined,
    }
}

fn one(normal: Option<Point>) -> LimitNormal {
    normal.map_or(LimitNormal::Undefined, LimitNormal::One)
}
