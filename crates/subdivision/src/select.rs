//! Selection of the faces to refine.

use sixfold_core::{FaceId, MeshQuery, Point};

use crate::error::LocalError;

/// A selection of faces of a triangle mesh, for [`refine_locally`](crate::refine_locally).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Selection {
    /// The faces with these numbers. At later levels, the parts of these faces are selected.
    Faces(Vec<FaceId>),
    /// The faces that share at least one point with a box. The surface of the box belongs to the
    /// box. A box that meets only the inner part of a face also selects the face. The bounds may be
    /// infinite. At each level, the faces of this level are selected.
    Box {
        /// The minimum coordinates of the box.
        min: Point,
        /// The maximum coordinates of the box.
        max: Point,
    },
    /// The faces at folds. A fold is a pair of adjacent faces whose normals form an angle greater
    /// than the given value in degrees, which must be from 0 to 180. Faces at an edge with three or
    /// more faces are also selected. Two adjacent faces are not a fold if one of them has no area.
    /// At each level, the faces of this level along the same folds are selected, because new points
    /// lie on the old faces.
    Angle(f32),
}

impl Selection {
    /// Checks that this selection is valid for a mesh with `faces` faces.
    ///
    /// # Errors
    ///
    /// Returns an error for a face that does not exist, for a box with a NaN bound or with a lower
    /// bound above the upper bound, and for an angle outside 0 to 180 degrees.
    pub fn check(&self, faces: usize) -> Result<(), LocalError> {
        match self {
            Self::Faces(list) => Self::check_faces(list, faces),
            // This test is false for NaN.
            Self::Box { min, max } if min.cmple(*max).all() => Ok(()),
            &Self::Box { min, max } => Err(LocalError::BadBox { min, max }),
            Self::Angle(degrees) if (0.0..=180.0).contains(degrees) => Ok(()),
            &Self::Angle(degrees) => Err(LocalError::BadAngle { degrees }),
        }
    }

    pub(crate) fn check_faces(list: &[FaceId], faces: usize) -> Result<(), LocalError> {
        match list.iter().find(|f| f.index() >= faces) {
            Some(&face) => Err(LocalError::MissingFace { face, faces }),
            None => Ok(()),
        }
    }

    /// Returns the numbers of the selected faces. A list of faces is returned unchanged; the faces
    /// at a box or at folds are in the order of [`MeshQuery::faces`]. Takes O(faces) time, or
    /// O(edges) time for an angle, plus the costs of the queries FV and EF.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`check`](Self::check). For a box or an angle, also returns an error
    /// for the first face that is not a triangle.
    pub fn faces<M: MeshQuery>(&self, mesh: &M) -> Result<Vec<FaceId>, LocalError> {
        self.check(mesh.face_count())?;
        match self {
            Self::Faces(list) => Ok(list.clone()),
            &Self::Box { min, max } => {
                let mut chosen = Vec::new();
                for (number, f) in (0..).zip(mesh.faces()) {
                    let face = FaceId::new(number);
                    let corners = triangle(mesh, f, face)?.map(|v| mesh.position(v));
                    if intersects_box(corners, min, max) {
                        chosen.push(face);
                    }
                }
                Ok(chosen)
            }
            &Self::Angle(degrees) => faces_along_folds(mesh, degrees),
        }
    }
}

/// Returns the corners of face number `face`, or an error if the face is not a triangle.
pub(crate) fn triangle<M: MeshQuery>(
    mesh: &M,
    f: M::Face,
    face: FaceId,
) -> Result<[M::Vertex; 3], LocalError> {
    let mut corners = mesh.face_vertices(f);
    let three = [corners.next(), corners.next(), corners.next()];
    match (three, corners.next()) {
        ([Some(a), Some(b), Some(c)], None) => Ok([a, b, c]),
        _ => Err(LocalError::NotATriangle {
            face,
            degree: mesh.face_vertices(f).count(),
        }),
    }
}

/// Returns whether a triangle and a box have a point in common. Tests the projections on thirteen
/// lines (Akenine-Möller 2001).
fn intersects_box(corners: [Point; 3], min: Point, max: Point) -> bool {
    let [a, b, c] = corners;
    // Cuts the box to the bounds of the triangle, which tests the three lines along the axes.
    let (min, max) = (min.max(a.min(b).min(c)), max.min(a.max(b).max(c)));
    if !min.cmple(max).all() {
        return false;
    }
    let corners = corners.map(Point::as_dvec3);
    let [min, max] = [min, max].map(Point::as_dvec3);
    let sides = [0, 1, 2].map(|i| corners[(i + 1) % 3] - corners[i]);
    let axes = [Point::X, Point::Y, Point::Z].map(Point::as_dvec3);
    let edge_products = sides
        .iter()
        .flat_map(|side| axes.map(|axis| side.cross(axis)));
    let mut lines = edge_products.chain([sides[0].cross(sides[1])]);
    lines.all(|line| {
        let projections = corners.map(|corner| line.dot(corner));
        let (low, high) = (line * min, line * max);
        let least = low.min(high).element_sum();
        let most = low.max(high).element_sum();
        // Allows for rounding errors, so that no contact is missed.
        let tolerance = 1e-12 * line.abs().dot(min.abs().max(max.abs()));
        projections.iter().any(|&at| at >= least - tolerance)
            && projections.iter().any(|&at| at <= most + tolerance)
    })
}

/// Returns the faces at edges where adjacent faces form an angle above `degrees`.
fn faces_along_folds<M: MeshQuery>(mesh: &M, degrees: f32) -> Result<Vec<FaceId>, LocalError> {
    let numbers = mesh.face_numbers();
    let mut chosen = vec![false; numbers.len()];
    for (number, &f) in (0..).zip(numbers.handles()) {
        triangle(mesh, f, FaceId::new(number))?;
    }
    // The normal of a face, and whether the face runs from `a` to `b`.
    let normal_and_direction = |f: M::Face, a: M::Vertex, b: M::Vertex| {
        let corners: Vec<M::Vertex> = mesh.face_vertices(f).collect();
        let forward = (0..3).any(|i| corners[i] == a && corners[(i + 1) % 3] == b);
        let at = |i: usize| mesh.position(corners[i]).as_dvec3();
        ((at(1) - at(0)).cross(at(2) - at(0)), forward)
    };
    for e in mesh.edges() {
        let [a, b] = mesh.edge_vertices(e);
        let faces: Vec<M::Face> = mesh.edge_faces(e).collect();
        let is_bent = match faces[..] {
            [f, g] => {
                let (m, along) = normal_and_direction(f, a, b);
                let (n, other) = normal_and_direction(g, a, b);
                // If both faces run in the same direction, one normal points to the wrong side.
                let n = if along == other { -n } else { n };
                let angle = m.cross(n).length().atan2(m.dot(n));
                angle.to_degrees() > f64::from(degrees)
            }
            [_] | [] => false,
            _ => true,
        };
        if is_bent {
            for f in faces {
                chosen[numbers[f] as usize] = true;
            }
        }
    }
    let numbers = (0..).map(FaceId::new).zip(chosen);
    Ok(numbers
        .filter(|&(_, chosen)| chosen)
        .map(|(f, _)| f)
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_selects_the_triangles_it_touches() {
        let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 4.0]].map(Point::from);
        let near = |min: [f32; 3], max: [f32; 3]| intersects_box(corners, min.into(), max.into());
        assert!(
            near([1.0, 1.0, 1.0], [1.0, 1.0, 1.0]),
            "a point in the plane"
        );
        assert!(near([-1.0; 3], [0.0; 3]), "a corner");
        assert!(near([1.9, 1.9, 0.0], [9.0, 9.0, 9.0]), "across a side");
        assert!(
            near([f32::NEG_INFINITY; 3], [f32::INFINITY; 3]),
            "everything"
        );
        assert!(
            near([0.5, 0.1, -1.0], [0.6, 0.2, 9.0]),
            "a needle through it"
        );
        assert!(!near([1.0, 1.0, 1.1], [1.0, 1.0, 2.0]), "above the plane");
        assert!(
            !near([2.2, 2.2, 0.0], [9.0, 9.0, 9.0]),
            "past a side, within the bounds"
        );
        assert!(!near([5.0, 0.0, 0.0], [9.0, 9.0, 9.0]), "outside");
        let side = [[0.0, 0.0, 0.0], [2.0, 2.0, 0.1], [4.0, 4.0, 0.0]].map(Point::from);
        let upright = |min: [f32; 3], max: [f32; 3]| intersects_box(side, min.into(), max.into());
        assert!(upright([0.9, 0.9, 0.0], [1.0, 1.0, 9.0]));
        assert!(!upright([0.9, 1.1, 0.0], [1.0, 1.2, 9.0]));
    }
}
