//! Errors of subdivision.

use sixfold_core::{BuildError, FaceId, Point, PolygonError, RefineError, VertexId};

use crate::scheme::{Method, Scheme};

/// The reason why a subdivision failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum SubdivisionError {
    /// A face has more than three corners, but the scheme splits only triangles.
    #[error(
        "face {face} has {degree} corners, and {scheme} splits only triangles: triangulate the mesh, or choose catmull-clark, doo-sabin or bilinear"
    )]
    NotATriangle {
        scheme: Scheme,
        face: FaceId,
        degree: usize,
    },
    /// There are creases, but the scheme has no rule for creases.
    #[error(
        "{scheme} has no rule for creases: remove the creases, or choose catmull-clark or loop"
    )]
    NoCreases { scheme: Scheme },
    /// The crate has no limit masks for this scheme.
    #[error("{scheme} has no limit masks: choose catmull-clark or loop, or use more levels")]
    NoLimit { scheme: Scheme },
    /// The scheme does not have this method.
    #[error("{scheme} has no {method} method: choose {choice}")]
    NoMethod {
        scheme: Scheme,
        method: Method,
        choice: &'static str,
    },
    /// The scheme has no rule for this edge.
    #[error("edge {0}–{1} has {faces} faces, but {scheme} needs one face, or two faces that run \
             along the edge in opposite directions: split the edge, or choose catmull-clark or \
             loop", .ends[0], .ends[1])]
    NonManifoldEdge {
        scheme: Scheme,
        ends: [VertexId; 2],
        faces: usize,
    },
    /// The scheme has no rule for this vertex.
    #[error(
        "the faces at vertex {vertex} are not one fan, but {scheme} needs one fan: duplicate the \
         vertex, or choose catmull-clark or loop"
    )]
    NonManifoldVertex { scheme: Scheme, vertex: VertexId },
    /// The structure cannot split its own tables for this mesh.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// There are more elements than 32-bit handles can number.
    #[error(transparent)]
    Polygons(#[from] PolygonError),
    /// The caller stopped the subdivision after this level.
    #[error("stopped after level {level}")]
    Stopped { level: u32 },
    /// The structure cannot hold the mesh of this level (level 0 is the input mesh).
    #[error("{}", cannot_hold(structure, *level, refusal))]
    Build {
        structure: &'static str,
        level: u32,
        refusal: BuildError,
    },
}

/// Says why `structure` cannot hold a level. The refusal of a level above 0 names faces that the
/// scheme made, so the remedy of the refusal, which is for the input, would not help.
fn cannot_hold(structure: &str, level: u32, refusal: &BuildError) -> String {
    match refusal {
        BuildError::NotATriangle { degree, .. } if level > 0 => format!(
            "{structure} holds only triangles, but level {level} has faces with {degree} corners: \
             choose another structure, or a scheme that makes triangles"
        ),
        _ => format!("{structure} cannot hold level {level}: {refusal}"),
    }
}

/// The reason why the given points do not define a curve or a patch.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum CurveError {
    /// A curve, or a row or column of a patch, has too few points.
    #[error(
        "{given} points are too few, because this treatment of the ends needs at least {least} \
         points: add points, or keep the ends"
    )]
    TooFewPoints { given: usize, least: usize },
    /// The result would have more points than 32-bit handles can number.
    #[error(
        "{levels} levels make too many points from {given} points, because 32-bit handles allow at \
         most {limit} points: refine fewer levels"
    )]
    TooManyPoints {
        given: usize,
        levels: u32,
        limit: usize,
    },
    /// The last row of the grid is incomplete.
    #[error("{given} points do not fill rows of {columns} points: add or remove points")]
    RaggedGrid { given: usize, columns: usize },
}

/// The reason why a mesh cannot be refined locally.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum LocalError {
    /// A face has more than three corners, but local refinement needs triangles.
    #[error(
        "face {face} has {degree} corners, and local refinement needs triangles: triangulate the mesh"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// A chosen face does not exist.
    #[error("face {face} does not exist: the mesh has {faces} faces, counted from 0")]
    MissingFace { face: FaceId, faces: usize },
    /// A bound of the box is NaN, or the lower bound is above the upper bound.
    #[error("{min} to {max} is not a box: give the lower coordinates first")]
    BadBox { min: Point, max: Point },
    /// An angle is outside 0 to 180 degrees.
    #[error("{degrees} is not an angle between two faces: give degrees from 0 to 180")]
    BadAngle { degrees: f32 },
    /// An edge is so short that its midpoint, rounded to `f32`, is one of its ends.
    #[error("edge {0}–{1} is too short to be halved with 32-bit coordinates: refine fewer levels", .ends[0], .ends[1])]
    TooShort { ends: [VertexId; 2] },
    /// There are more elements than 32-bit handles can number.
    #[error(transparent)]
    Polygons(#[from] PolygonError),
    /// The caller stopped the subdivision after this level.
    #[error("stopped after level {level}")]
    Stopped { level: u32 },
    /// The structure cannot hold the mesh of this level (level 0 is the input mesh).
    #[error("{}", cannot_hold(structure, *level, refusal))]
    Build {
        structure: &'static str,
        level: u32,
        refusal: BuildError,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_structure_for_triangles_is_not_told_to_triangulate_what_the_scheme_made() {
        let message = |level| {
            let error = SubdivisionError::Build {
                structure: "corner-table",
                level,
                refusal: BuildError::NotATriangle {
                    face: FaceId::new(0),
                    degree: 4,
                },
            };
            error.to_string()
        };
        assert_eq!(
            message(1),
            "corner-table holds only triangles, but level 1 has faces with 4 corners: choose another \
             structure, or a scheme that makes triangles"
        );
        assert_eq!(
            message(0),
            "corner-table cannot hold level 0: face f0 has 4 corners, and only triangles fit: \
             triangulate the mesh"
        );
    }
}
