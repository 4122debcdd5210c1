//! The rules that split every face of a mesh.

use std::fmt;

use crate::polygons::counts::Counts;

/// A rule that splits every face of a mesh at once. The rule defines the connectivity of the
/// refined mesh, but not the positions of its vertices.
///
/// ```text
///   Quads                    Triangles                Sqrt3
///   d────m────c              c                        c───────d       c───────d
///   │    │    │              │╲                       │╲   f2╱        │╲     ╱│
///   m────f────m              m──m                     │  ╲ ╱          │ f1──f2│
///   │    │    │              │╲ │╲                    │f1 ╱╲          │╱     ╲│
///   a────m────b              a──m──b                  a───────b       a───────b
/// ```
///
/// The vertices of the refined mesh have a fixed order:
///
/// 1. the old vertices, in their order;
/// 2. for [`Quads`](Self::Quads) and [`Sqrt3`](Self::Sqrt3), one face point for each face, in the
///    order of `faces()`;
/// 3. for [`Quads`](Self::Quads) and [`Triangles`](Self::Triangles), one edge point for each edge,
///    in the order of `edges()`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "snake_case")
)]
pub enum Split {
    /// Splits every face of degree n into n quads, with a face point and edge points (Catmull &
    /// Clark 1978).
    Quads,
    /// Splits every triangle into four, with edge points (Loop 1987).
    Triangles,
    /// Splits every triangle into three at a face point, then flips every old inner edge (Kobbelt
    /// 2000). If `trisect` is true, every boundary edge is cut into three edges; if `trisect` is
    /// false, boundary edges are unchanged. The new vertices on boundary edges come last, in the
    /// order of `edges()`: two for each boundary edge, in the direction of its face.
    Sqrt3 {
        /// True if boundary edges are cut into three edges.
        trisect: bool,
    },
}

impl Split {
    /// Returns the name for users: `quads`, `triangles` or `sqrt3`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Quads => "quads",
            Self::Triangles => "triangles",
            Self::Sqrt3 { .. } => "sqrt3",
        }
    }

    /// Returns whether the split requires a mesh in which all faces are triangles.
    pub const fn needs_triangles(self) -> bool {
        !matches!(self, Self::Quads)
    }

    /// Returns the sizes of the refined mesh, computed by formula. `boundary` is the number of
    /// edges with one face; only the split [`Sqrt3`](Self::Sqrt3) with `trisect` uses this number.
    /// A size that does not fit in `usize` is replaced by `usize::MAX`.
    ///
    /// For [`Quads`](Self::Quads) and [`Triangles`](Self::Triangles), the sizes are correct even if
    /// edges have three or more faces.
    pub const fn refined_counts(self, counts: &Counts, boundary: usize) -> Counts {
        let &Counts {
            vertices: v,
            edges: e,
            faces: f,
            corners,
            uniform: _,
        } = counts;
        let (vertices, edges, faces, degree) = match self {
            Self::Quads => (
                v.saturating_add(f).saturating_add(e),
                e.saturating_mul(2).saturating_add(corners),
                corners,
                4,
            ),
            Self::Triangles => (
                v.saturating_add(e),
                e.saturating_mul(2).saturating_add(f.saturating_mul(3)),
                f.saturating_mul(4),
                3,
            ),
            Self::Sqrt3 { trisect } => {
                let cut = if trisect { boundary } else { 0 };
                let more = cut.saturating_mul(2);
                (
                    v.saturating_add(f).saturating_add(more),
                    e.saturating_add(f.saturating_mul(3))
                        .saturating_add(more.saturating_mul(2)),
                    f.saturating_mul(3).saturating_add(more),
                    3,
                )
            }
        };
        Counts {
            vertices,
            edges,
            faces,
            corners: faces.saturating_mul(degree),
            uniform: true,
        }
    }
}

impl fmt::Display for Split {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: Counts = Counts {
        vertices: 8,
        edges: 12,
        faces: 6,
        corners: 24,
        uniform: true,
    };

    const TRIANGLE: Counts = Counts {
        vertices: 3,
        edges: 3,
        faces: 1,
        corners: 3,
        uniform: true,
    };

    #[test]
    fn counts_grow_in_closed_form() {
        let sizes = |c: Counts| [c.vertices, c.edges, c.faces, c.corners];
        assert_eq!(
            sizes(Split::Quads.refined_counts(&CUBE, 0)),
            [26, 48, 24, 96]
        );
        assert_eq!(
            sizes(Split::Triangles.refined_counts(&TRIANGLE, 3)),
            [6, 9, 4, 12]
        );
        let sqrt3 = |trisect| sizes(Split::Sqrt3 { trisect }.refined_counts(&TRIANGLE, 3));
        assert_eq!(sqrt3(false), [4, 6, 3, 9]);
        assert_eq!(sqrt3(true), [10, 18, 9, 27]);
        let huge = Counts {
            faces: usize::MAX / 2,
            ..TRIANGLE
        };
        assert_eq!(Split::Triangles.refined_counts(&huge, 0).faces, usize::MAX);
    }
}
