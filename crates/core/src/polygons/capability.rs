//! Capabilities: the kinds of meshes that a structure can hold, and the check of a mesh.

use rustc_hash::FxHashMap;

use crate::Point;
use crate::handles::limits::{self, MAX_CORNERS, MAX_EDGES};
use crate::handles::row_id::MAX_ROWS;
use crate::polygons::error::BuildError;
use crate::polygons::facts::Facts;
use crate::polygons::fans::Fans;
use crate::polygons::incidence::Incidence;
use crate::polygons::polygon_mesh::PolygonMesh;

/// The kinds of meshes that a structure can hold. Every structure can hold oriented triangle
/// manifolds, with or without a boundary. A field is true if the structure can also hold meshes
/// with the property that the field names.
///
/// A constructor that refuses a mesh returns the error of [`check`](Self::check).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
pub struct Capabilities {
    /// True if faces can have any degree; false if every face must be a triangle.
    pub polygons: bool,
    /// True if edges can have three or more faces.
    pub non_manifold_edges: bool,
    /// True if the faces at a vertex can form several fans (chains of faces that share edges).
    pub non_manifold_vertices: bool,
    /// True if two faces can run along an edge in the same direction.
    pub inconsistent_orientation: bool,
    /// True if vertices without a face are allowed.
    pub isolated_vertices: bool,
    /// True if vertices with equal coordinates stay separate. If false, vertices with equal
    /// coordinates become one vertex, and a face with two corners at the same position is refused.
    /// Coordinates are compared without a tolerance.
    pub coincident_vertices: bool,
}

impl Capabilities {
    /// The capabilities of a structure that can hold every polygon mesh.
    pub const ALL: Self = Self {
        polygons: true,
        non_manifold_edges: true,
        non_manifold_vertices: true,
        inconsistent_orientation: true,
        isolated_vertices: true,
        coincident_vertices: true,
    };

    /// The capabilities of a structure that can hold oriented polygon manifolds and isolated
    /// vertices.
    pub const ORIENTED_MANIFOLDS: Self = Self {
        non_manifold_edges: false,
        non_manifold_vertices: false,
        inconsistent_orientation: false,
        ..Self::ALL
    };

    /// Checks whether a structure with these capabilities can hold `polygons`; O(n log n) expected
    /// for n corners.
    ///
    /// # Errors
    ///
    /// Returns the first fault. [`BuildError`] defines the order of the checks.
    pub fn check(&self, polygons: &PolygonMesh) -> Result<(), BuildError> {
        if !self.polygons {
            check_triangles(polygons)?;
        }
        if self.pairs_sides() {
            let [most_edges, limit] = self.edge_and_corner_limits();
            if polygons.corner_count() > limit {
                let elements = "corners";
                return Err(BuildError::TooMany { elements, limit });
            }
            let faces = polygons.faces();
            let incidence = Incidence::new(polygons.vertex_count(), faces, |_| true);
            if incidence.edges().nth(most_edges).is_some() {
                let (elements, limit) = ("edges", most_edges);
                return Err(BuildError::TooMany { elements, limit });
            }
            if !self.non_manifold_edges {
                check_edges(&incidence)?;
            }
            if !self.inconsistent_orientation {
                check_orientation(&incidence)?;
            }
            if !self.non_manifold_vertices {
                check_vertices(&incidence)?;
            }
        }
        if !self.isolated_vertices {
            check_isolated(polygons)?;
        }
        if !self.coincident_vertices {
            check_coincident_corners(polygons)?;
        }
        Ok(())
    }

    /// Returns true if the facts of a mesh prove that [`check`](Self::check) finds no fault; O(1).
    /// If the result is false, only `check` can decide. The result is always false if the mesh has
    /// degenerate faces or non-manifold edges, or if `coincident_vertices` is false.
    pub fn is_satisfied_by(&self, facts: &Facts) -> bool {
        let most_corners = facts.face_degree.as_ref().map_or(0, |degree| degree.max);
        self.can_name_edges(facts.edges)
            && facts.degenerate_faces == 0
            && facts.non_manifold_edges == 0
            && (self.polygons || most_corners <= 3)
            && (self.non_manifold_vertices || facts.non_manifold_vertices == 0)
            && (self.inconsistent_orientation || facts.inconsistent_edges == 0)
            && (self.isolated_vertices || facts.isolated_vertices == 0)
            && self.coincident_vertices
    }

    /// Returns whether a structure with these capabilities has enough handles for `edges` edges and
    /// their sides; O(1). Each edge must have at most two faces.
    pub fn can_name_edges(&self, edges: usize) -> bool {
        let [most_edges, most_corners] = self.edge_and_corner_limits();
        !self.pairs_sides() || (edges <= most_edges && 2 * edges <= most_corners)
    }

    /// Returns the maximum numbers of edges and of corners.
    pub(crate) fn edge_and_corner_limits(&self) -> [usize; 2] {
        let limits = if self.pairs_sides() {
            [MAX_EDGES, MAX_CORNERS]
        } else {
            [MAX_ROWS; 2]
        };
        limits.map(limits::current)
    }

    /// Returns whether a structure with these capabilities stores which two sides share an edge.
    fn pairs_sides(&self) -> bool {
        !(self.inconsistent_orientation && self.non_manifold_edges && self.non_manifold_vertices)
    }

    /// Returns the error for a constructor that has found a fault in `polygons`.
    ///
    /// Constructors call this method, so that constructors and [`check`](Self::check) always return
    /// the same error.
    ///
    /// # Panics
    ///
    /// Panics if [`check`](Self::check) finds no fault, which means that the constructor or `check`
    /// has a bug.
    pub fn build_error(&self, polygons: &PolygonMesh) -> BuildError {
        match self.check(polygons) {
            Err(fault) => fault,
            Ok(()) => panic!("construction found a fault in a mesh that `check` accepts"),
        }
    }
}

fn check_triangles(polygons: &PolygonMesh) -> Result<(), BuildError> {
    match polygons.first_polygon() {
        Some((face, degree)) => Err(BuildError::NotATriangle { face, degree }),
        None => Ok(()),
    }
}

fn check_edges(incidence: &Incidence<'_>) -> Result<(), BuildError> {
    match incidence.edges().find(|edge| edge.len() > 2) {
        Some(edge) => Err(BuildError::NonManifoldEdge {
            vertices: edge.ends,
            faces: edge.sides().map(|side| side.face).collect(),
        }),
        None => Ok(()),
    }
}

fn check_orientation(incidence: &Incidence<'_>) -> Result<(), BuildError> {
    for edge in incidence.edges() {
        for (i, later) in edge.sides().enumerate() {
            let mut earlier = edge.sides().take(i);
            let earlier = earlier.find(|s| s.downward == later.downward);
            if let Some(earlier) = earlier {
                let [low, high] = edge.ends;
                let (from, to) = if later.downward {
                    (high, low)
                } else {
                    (low, high)
                };
                let (first, second) = (earlier.face, later.face);
                return Err(BuildError::RepeatedSide {
                    from,
                    to,
                    first,
                    second,
                });
            }
        }
    }
    Ok(())
}

fn check_vertices(incidence: &Incidence<'_>) -> Result<(), BuildError> {
    let faults = Fans::new(incidence).several();
    match faults.into_iter().min_by_key(|&(vertex, _)| vertex) {
        Some((vertex, [first, second])) => Err(BuildError::NonManifoldVertex {
            vertex,
            first,
            second,
        }),
        None => Ok(()),
    }
}

fn check_isolated(polygons: &PolygonMesh) -> Result<(), BuildError> {
    let mut used = vec![false; polygons.vertex_count()];
    for v in polygons.faces().corners() {
        used[v.index()] = true;
    }
    let mut isolated = polygons.vertices().filter(|v| !used[v.index()]);
    match isolated.next() {
        Some(vertex) => Err(BuildError::IsolatedVertex {
            vertex,
            count: 1 + isolated.count(),
        }),
        None => Ok(()),
    }
}

fn check_coincident_corners(polygons: &PolygonMesh) -> Result<(), BuildError> {
    let mut at = FxHashMap::default();
    for (face, corners) in polygons.faces().iter() {
        at.clear();
        for &v in corners {
            if let Some(first) = at.insert(coordinates(polygons.position(v)), v) {
                return Err(BuildError::CoincidentCorners {
                    face,
                    vertices: [first, v],
                });
            }
        }
    }
    Ok(())
}

/// Returns the bits of the coordinates, with −0 replaced by 0.
pub(crate) fn coordinates(point: Point) -> [u32; 3] {
    point.to_array().map(|x| (x + 0.0).to_bits())
}
