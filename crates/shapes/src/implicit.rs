//! Solids as scalar fields: negative inside, zero on the surface, positive outside.
//!
//! The basic fields are balls, tori, boxes and blobs. Set operations and blends combine them.
//! [`Field::polygonised`] turns a field into a closed triangle mesh of any topology.
//!
//! | | field |
//! |---|---|
//! | union | min(f, g) |
//! | intersection | max(f, g) |
//! | difference | max(f, −g) |
//! | smooth union | (f + g − √(f² + g² − 2αfg)) / (1 + α) |
//! | blobs | level − Σ a·exp(−b·\|p − c\|²) |
//!
//! In the table, f and g are the fields of two solids, and α is a number from 0 to 1. A blob has
//! strength a, sharpness b and centre c; p is the point at which the field is evaluated. The smooth
//! union is Rvachev's R-function. The smooth union and the union are zero at the same points, so
//! the blend is visible only at other levels of the field. To see the blend,
//! [inflate](Field::inflated) the field a little.
//!
//! ```
//! use sixfold_shapes::implicit::Field;
//!
//! let ball = Field::sphere([0.0; 3], 0.5)?;
//! let ring = Field::torus([0.0; 3], [0.0, 0.0, 1.0], 1.0, 0.2)?;
//! let mesh = ball.union(ring)?.polygonised(2_000)?;
//! assert!(mesh.face_count().abs_diff(2_000) <= 100);
//! # Ok::<(), sixfold_shapes::ShapeError>(())
//! ```

use sixfold_core::PolygonMesh;

use crate::error::{ShapeError, check_count, check_value};
use crate::fitting;
use crate::node::{Node, length_squared};

/// Maximum radius, level and absolute value of a coordinate.
const MAX_VALUE: f64 = 1e6;

/// Minimum radius, level and sharpness.
const MIN_VALUE: f64 = 1e-6;

/// Maximum nesting depth of fields. A chain of n unions has depth n. To join many parts, join them
/// in pairs, then join the pairs in pairs.
const MAX_DEPTH: usize = 500;

/// A Gaussian bell. At the point p, the bell has the value `strength` · exp(−`sharpness` · |p −
/// `centre`|²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob {
    /// The centre of the bell.
    pub centre: [f64; 3],
    /// The value at the centre. A negative value makes a dent in the solid.
    pub strength: f64,
    /// The factor of the squared distance from the centre. A large factor makes a narrow bell.
    pub sharpness: f64,
}

/// A solid, given by a function of the position that is negative inside the solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    node: Node,
    /// Nesting depth. The limit protects the stack, because evaluation is recursive.
    depth: usize,
}

impl Field {
    /// Builds the ball of radius `radius` around `centre`. The field is the signed distance from
    /// the surface.
    ///
    /// # Errors
    ///
    /// Fails if a coordinate is beyond ±10⁶ or the radius is outside 10⁻⁶ to 10⁶.
    pub fn sphere(centre: [f64; 3], radius: f64) -> Result<Self, ShapeError> {
        check_point("centre", centre)?;
        check_value("radius", radius, MIN_VALUE, MAX_VALUE)?;
        Ok(Self::simple(Node::Sphere { centre, radius }))
    }

    /// Builds a torus around `centre`: a tube of radius `tube` around a circle of radius `ring`.
    /// The plane of the circle is perpendicular to `axis`. The field is the signed distance from
    /// the surface.
    ///
    /// # Errors
    ///
    /// Fails if a coordinate is beyond ±10⁶, or if a radius or the length of the axis is outside
    /// 10⁻⁶ to 10⁶.
    pub fn torus(
        centre: [f64; 3],
        axis: [f64; 3],
        ring: f64,
        tube: f64,
    ) -> Result<Self, ShapeError> {
        check_point("centre", centre)?;
        check_point("axis", axis)?;
        let length = length_squared(axis).sqrt();
        check_value("axis length", length, MIN_VALUE, MAX_VALUE)?;
        check_value("ring", ring, MIN_VALUE, MAX_VALUE)?;
        check_value("tube", tube, MIN_VALUE, MAX_VALUE)?;
        let axis = axis.map(|x| x / length);
        Ok(Self::simple(Node::Torus {
            centre,
            axis,
            ring,
            tube,
        }))
    }

    /// Builds the box from `centre` − `half` to `centre` + `half`. The field is the signed distance
    /// from the surface.
    ///
    /// # Errors
    ///
    /// Fails if a coordinate is beyond ±10⁶ or a value of `half` is outside 10⁻⁶ to 10⁶.
    pub fn cuboid(centre: [f64; 3], half: [f64; 3]) -> Result<Self, ShapeError> {
        check_point("centre", centre)?;
        for side in half {
            check_value("half", side, MIN_VALUE, MAX_VALUE)?;
        }
        Ok(Self::simple(Node::Cuboid { centre, half }))
    }

    /// Builds the solid where the sum of the blobs is above `level` (Blinn 1982).
    ///
    /// # Errors
    ///
    /// Fails if a coordinate or strength is beyond ±10⁶, if a sharpness or the level is outside
    /// 10⁻⁶ to 10⁶, or if there are more than 10⁶ blobs.
    pub fn blobs(blobs: &[Blob], level: f64) -> Result<Self, ShapeError> {
        check_value("blobs", blobs.len() as f64, 0.0, MAX_VALUE)?;
        for blob in blobs {
            check_point("centre", blob.centre)?;
            check_value("strength", blob.strength, -MAX_VALUE, MAX_VALUE)?;
            check_value("sharpness", blob.sharpness, MIN_VALUE, MAX_VALUE)?;
        }
        check_value("level", level, MIN_VALUE, MAX_VALUE)?;
        let blobs = blobs.to_vec();
        Ok(Self::simple(Node::Blobs { blobs, level }))
    }

    /// Returns the union: the points that are in at least one of the two solids.
    ///
    /// # Errors
    ///
    /// Fails if the nesting depth exceeds 500.
    pub fn union(self, other: Self) -> Result<Self, ShapeError> {
        self.combined(other, Node::Union)
    }

    /// Returns the intersection: the points that are in both solids.
    ///
    /// # Errors
    ///
    /// Fails if the nesting depth exceeds 500.
    pub fn intersection(self, other: Self) -> Result<Self, ShapeError> {
        self.combined(other, Node::Intersection)
    }

    /// Returns the difference: the points that are in this solid and not in `other`.
    ///
    /// # Errors
    ///
    /// Fails if the nesting depth exceeds 500.
    pub fn difference(self, other: Self) -> Result<Self, ShapeError> {
        self.combined(other, Node::Difference)
    }

    /// Returns the union of the two solids with a smooth blend. The blend is smoothest if `alpha`
    /// is 0. If `alpha` is 1, there is no blend.
    ///
    /// # Errors
    ///
    /// Fails if `alpha` is outside 0 to 1 or the nesting depth exceeds 500.
    pub fn smooth_union(self, other: Self, alpha: f64) -> Result<Self, ShapeError> {
        check_value("alpha", alpha, 0.0, 1.0)?;
        self.combined(other, |parts| Node::SmoothUnion { parts, alpha })
    }

    /// Returns the solid whose surface is at the points where the field has the value `by`. The
    /// solid grows if `by` is positive, and shrinks if `by` is negative.
    ///
    /// # Errors
    ///
    /// Fails if `by` is beyond ±10⁶ or the nesting depth exceeds 500.
    pub fn inflated(self, by: f64) -> Result<Self, ShapeError> {
        check_value("by", by, -MAX_VALUE, MAX_VALUE)?;
        let part = Box::new(self.node);
        Self::nested(Node::Inflated { part, by }, self.depth)
    }

    fn combined(
        self,
        other: Self,
        join: impl FnOnce(Box<[Node; 2]>) -> Node,
    ) -> Result<Self, ShapeError> {
        let depth = self.depth.max(other.depth);
        Self::nested(join(Box::new([self.node, other.node])), depth)
    }

    fn nested(node: Node, depth: usize) -> Result<Self, ShapeError> {
        check_count("depth", depth + 1, 1, MAX_DEPTH)?;
        let depth = depth + 1;
        Ok(Self { node, depth })
    }

    fn simple(node: Node) -> Self {
        Self { node, depth: 1 }
    }

    /// Returns the value of the field at a point: negative inside, positive outside.
    pub fn at(&self, point: [f64; 3]) -> f64 {
        self.node.at(point)
    }

    /// Builds the surface of the solid from about `faces` triangles. The mesh is closed, manifold
    /// and oriented outward.
    ///
    /// The number of triangles differs from `faces` by at most 5 % or 20 triangles, whichever is
    /// more. The mesh comes from marching tetrahedra (Doi and Koide 1991) on a lattice of cubes.
    /// Parts and gaps that are thinner than a cube of the lattice may be lost. No two vertices have
    /// the same position. The field is evaluated near the surface only.
    ///
    /// # Errors
    ///
    /// Fails in these cases:
    ///
    /// - `faces` is outside 100 to 4,000,000.
    /// - The solid is unbounded, or contains no lattice point.
    /// - No lattice gives the requested number of faces.
    /// - The lattice is too fine for memory, or for `f32` at these coordinates.
    pub fn polygonised(&self, faces: usize) -> Result<PolygonMesh, ShapeError> {
        fitting::check_faces(faces)?;
        let bounds = self.node.bounds()?.ok_or(ShapeError::Empty)?;
        fitting::polygonised(&self.node, bounds, faces)
    }

    pub(crate) fn polygonised_at(&self, spacing: f64) -> Result<PolygonMesh, ShapeError> {
        let bounds = self.node.bounds()?.ok_or(ShapeError::Empty)?;
        let lattice = bounds.lattice(spacing, [0.0; 3])?;
        Ok(crate::marching::polygonised(&self.node, &lattice).build())
    }
}

fn check_point(parameter: &'static str, point: [f64; 3]) -> Result<(), ShapeError> {
    for coordinate in point {
        check_value(parameter, coordinate, -MAX_VALUE, MAX_VALUE)?;
    }
    Ok(())
}
