//! Solids as fields: negative inside, zero on the surface, positive outside.
//!
//! Fields are built from balls, rings, boxes and blobs, put together as sets or blended, and made
//! into closed triangle meshes of any topology by [`Field::polygonised`].
//!
//! | | field |
//! |---|---|
//! | union | min(f, g) |
//! | intersection | max(f, g) |
//! | difference | max(f, −g) |
//! | smooth union | (f + g − √(f² + g² − 2αfg)) / (1 + α) |
//! | blobs | level − Σ a·exp(−b·\|p − c\|²) |
//!
//! The smooth union (Rvachev's R-function) is zero where the union is, and smooth everywhere else;
//! so its blend shows on the other levels: [inflate](Field::inflated) it a little.
//!
//! ```
//! use shapes::implicit::Field;
//!
//! let ball = Field::sphere([0.0; 3], 0.5)?;
//! let ring = Field::torus([0.0; 3], [0.0, 0.0, 1.0], 1.0, 0.2)?;
//! let mesh = ball.union(ring)?.polygonised(2_000)?;
//! assert!(mesh.face_count().abs_diff(2_000) <= 100);
//! # Ok::<(), shapes::ShapeError>(())
//! ```

use mesh_core::PolygonMesh;

use crate::error::{ShapeError, between, within};
use crate::fitting;
use crate::node::{Node, square};

/// The greatest coordinate, radius or level.
const GREATEST: f64 = 1e6;

/// The least radius or sharpness.
const LEAST: f64 = 1e-6;

/// The most fields within each other. A chain of unions is as deep as it is long; many parts want to
/// be joined in pairs, and the pairs in pairs.
const MAX_DEPTH: usize = 500;

/// One bell of a sum: `strength` · exp(−`sharpness` · |p − `centre`|²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob {
    /// Where it is highest.
    pub centre: [f64; 3],
    /// How high it is there; negative makes a dent.
    pub strength: f64,
    /// How fast it falls off.
    pub sharpness: f64,
}

/// A solid of bounded size, as a function that is negative inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    node: Node,
    /// How many fields lie within each other at most: evaluation recurses, and stacks end.
    depth: usize,
}

impl Field {
    /// The ball around `centre`; the field is the distance from its surface.
    ///
    /// # Errors
    ///
    /// A coordinate beyond ±10⁶, or a radius outside 10⁻⁶ to 10⁶.
    pub fn sphere(centre: [f64; 3], radius: f64) -> Result<Self, ShapeError> {
        check_point("centre", centre)?;
        between("radius", radius, LEAST, GREATEST)?;
        Ok(Self::simple(Node::Sphere { centre, radius }))
    }

    /// The tube of radius `tube` around a circle of radius `ring` about `axis`; a distance too.
    ///
    /// # Errors
    ///
    /// A coordinate beyond ±10⁶, an axis whose length, or a radius that is outside 10⁻⁶ to 10⁶.
    pub fn torus(
        centre: [f64; 3],
        axis: [f64; 3],
        ring: f64,
        tube: f64,
    ) -> Result<Self, ShapeError> {
        check_point("centre", centre)?;
        check_point("axis", axis)?;
        let length = square(axis).sqrt();
        between("axis length", length, LEAST, GREATEST)?;
        between("ring", ring, LEAST, GREATEST)?;
        between("tube", tube, LEAST, GREATEST)?;
        let axis = axis.map(|x| x / length);
        Ok(Self::simple(Node::Torus {
            centre,
            axis,
            ring,
            tube,
        }))
    }

    /// The box that reaches `half` either way from `centre` along each axis; a distance too.
    ///
    /// # Errors
    ///
    /// A coordinate beyond ±10⁶, or a half side outside 10⁻⁶ to 10⁶.
    pub fn cuboid(centre: [f64; 3], half: [f64; 3]) -> Result<Self, ShapeError> {
        check_point("centre", centre)?;
        for side in half {
            between("half", side, LEAST, GREATEST)?;
        }
        Ok(Self::simple(Node::Cuboid { centre, half }))
    }

    /// Where the sum of the blobs is above `level` (Blinn 1982).
    ///
    /// # Errors
    ///
    /// A coordinate or strength beyond ±10⁶, a sharpness or level outside 10⁻⁶ to 10⁶, or more than
    /// 10⁶ blobs.
    pub fn blobs(blobs: &[Blob], level: f64) -> Result<Self, ShapeError> {
        between("blobs", blobs.len() as f64, 0.0, GREATEST)?;
        for blob in blobs {
            check_point("centre", blob.centre)?;
            between("strength", blob.strength, -GREATEST, GREATEST)?;
            between("sharpness", blob.sharpness, LEAST, GREATEST)?;
        }
        between("level", level, LEAST, GREATEST)?;
        let blobs = blobs.to_vec();
        Ok(Self::simple(Node::Blobs { blobs, level }))
    }

    /// What is in either.
    ///
    /// # Errors
    ///
    /// More than 500 fields within each other.
    pub fn union(self, other: Self) -> Result<Self, ShapeError> {
        self.with(other, Node::Union)
    }

    /// What is in both.
    ///
    /// # Errors
    ///
    /// More than 500 fields within each other.
    pub fn intersection(self, other: Self) -> Result<Self, ShapeError> {
        self.with(other, Node::Intersection)
    }

    /// What is in this one and not in the other.
    ///
    /// # Errors
    ///
    /// More than 500 fields within each other.
    pub fn difference(self, other: Self) -> Result<Self, ShapeError> {
        self.with(other, Node::Difference)
    }

    /// What is in either, with smooth levels around it: the most for `alpha` = 0, none for 1.
    ///
    /// # Errors
    ///
    /// `alpha` outside 0 to 1, or more than 500 fields within each other.
    pub fn smooth_union(self, other: Self, alpha: f64) -> Result<Self, ShapeError> {
        between("alpha", alpha, 0.0, 1.0)?;
        self.with(other, |parts| Node::SmoothUnion { parts, alpha })
    }

    /// The level `by` instead of zero: larger, or smaller where it is negative.
    ///
    /// # Errors
    ///
    /// `by` beyond ±10⁶, or more than 500 fields within each other.
    pub fn inflated(self, by: f64) -> Result<Self, ShapeError> {
        between("by", by, -GREATEST, GREATEST)?;
        let part = Box::new(self.node);
        Self::nested(Node::Inflated { part, by }, self.depth)
    }

    fn with(
        self,
        other: Self,
        join: impl FnOnce(Box<[Node; 2]>) -> Node,
    ) -> Result<Self, ShapeError> {
        let depth = self.depth.max(other.depth);
        Self::nested(join(Box::new([self.node, other.node])), depth)
    }

    /// A field of parts that are at most `depth` deep.
    fn nested(node: Node, depth: usize) -> Result<Self, ShapeError> {
        within("depth", depth + 1, 1, MAX_DEPTH)?;
        let depth = depth + 1;
        Ok(Self { node, depth })
    }

    fn simple(node: Node) -> Self {
        Self { node, depth: 1 }
    }

    /// The field at a point: negative inside, positive outside.
    pub fn at(&self, point: [f64; 3]) -> f64 {
        self.node.at(point)
    }

    /// The surface as about `faces` triangles: closed, consistently oriented outward, manifold.
    ///
    /// The count is met within 5 %, or within 20 faces where that is more. The lattice of marching
    /// tetrahedra (Doi and Koide 1991) is as fine as that needs; parts thinner than it may be
    /// missed, and gaps closed. No two vertices share a place. The field is evaluated near the
    /// surface only.
    ///
    /// # Errors
    ///
    /// `faces` outside 100 to 4,000,000; a solid without bounds, or in which no lattice point lies;
    /// a count that no lattice meets; a lattice too fine for `f32` at that place.
    pub fn polygonised(&self, faces: usize) -> Result<PolygonMesh, ShapeError> {
        fitting::check_faces(faces)?;
        let bounds = self.node.bounds()?.ok_or(ShapeError::Nothing)?;
        fitting::polygonised(&self.node, bounds, faces)
    }

    /// The surface on a lattice of the given spacing.
    pub(crate) fn polygonised_at(&self, spacing: f64) -> Result<PolygonMesh, ShapeError> {
        let bounds = self.node.bounds()?.ok_or(ShapeError::Nothing)?;
        let lattice = bounds.lattice(spacing, [0.0; 3])?;
        Ok(crate::marching::polygonised(&self.node, &lattice).finish())
    }
}

fn check_point(parameter: &'static str, point: [f64; 3]) -> Result<(), ShapeError> {
    for coordinate in point {
        between(parameter, coordinate, -GREATEST, GREATEST)?;
    }
    Ok(())
}
