//! What a format cannot keep.

use std::fmt;

use sixfold_core::{FaceId, Point, PolygonMesh};

use super::{Placed, WriteOptions};
use crate::format::Format;
use crate::narrowing::{Narrowing, rounded};
use crate::welder::for_each_equal;

/// Something of a mesh that a format cannot keep; printed as `1 polygon is cut into triangles`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Loss {
    /// This many vertices that have the position of another vertex, in STL. A reader joins equal
    /// positions, and makes one vertex of them.
    EqualPositions(usize),
    /// This many faces with more than three corners, which are cut into triangles.
    Polygons(usize),
    /// Faces that cross themselves, and overlap after they are cut into triangles.
    CrossingPolygons {
        /// How many there are.
        count: usize,
        /// The first of them.
        first: FaceId,
    },
    /// This many vertices without a face.
    IsolatedVertices(usize),
    /// Positions that are rounded to 32 bits, because the mesh is moved
    /// ([`WriteOptions::with_origin`]).
    Precision {
        /// How many vertices have such a position.
        count: usize,
        /// What rounding does to them.
        narrowing: Narrowing,
    },
    /// The normals of this many vertices.
    Normals(usize),
    /// The sharpness of this many edges and vertices.
    Creases(usize),
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EqualPositions(1) => {
                f.write_str("1 vertex has the position of another one, and readers join them")
            }
            Self::EqualPositions(count) => {
                write!(
                    f,
                    "{count} vertices have positions of others, and readers join them"
                )
            }
            Self::Polygons(1) => f.write_str("1 polygon is cut into triangles"),
            Self::Polygons(count) => write!(f, "{count} polygons are cut into triangles"),
            Self::CrossingPolygons { count: 1, first } => {
                write!(f, "face {first} crosses itself, so its triangles overlap")
            }
            Self::CrossingPolygons { count, first } => {
                write!(
                    f,
                    "{count} faces cross themselves, so their triangles overlap; the first is {first}"
                )
            }
            Self::IsolatedVertices(1) => f.write_str("1 vertex without a face is left out"),
            Self::IsolatedVertices(count) => {
                write!(f, "{count} vertices without a face are left out")
            }
            Self::Precision { narrowing, .. } => narrowing.fmt(f),
            Self::Normals(1) => f.write_str("1 normal is left out"),
            Self::Normals(count) => write!(f, "{count} normals are left out"),
            Self::Creases(1) => f.write_str("the sharpness of 1 edge or vertex is left out"),
            Self::Creases(count) => {
                write!(f, "the sharpness of {count} edges and vertices is left out")
            }
        }
    }
}

impl Loss {
    /// Returns what is lost, in the plural: `polygons`.
    pub const fn title(self) -> &'static str {
        match self {
            Self::EqualPositions(_) => "vertices at positions of other vertices",
            Self::Polygons(_) => "polygons",
            Self::CrossingPolygons { .. } => "polygons that cross themselves",
            Self::IsolatedVertices(_) => "vertices without a face",
            Self::Precision { .. } => "positions in 64 bits",
            Self::Normals(_) => "normals",
            Self::Creases(_) => "sharp edges and vertices",
        }
    }

    /// Returns how many are lost.
    pub const fn count(self) -> usize {
        match self {
            Self::EqualPositions(count)
            | Self::Polygons(count)
            | Self::CrossingPolygons { count, .. }
            | Self::IsolatedVertices(count)
            | Self::Precision { count, .. }
            | Self::Normals(count)
            | Self::Creases(count) => count,
        }
    }
}

/// Returns what `format` cannot keep of `polygons` and of the data in `options`; O(corners) expected.
/// `crossing` are the polygons that crossed themselves when they were cut.
///
/// STL has no vertex numbers. A reader joins the corners with equal positions, and numbers the
/// vertices in the order in which the faces list them. This is not a loss: if the list is empty, the
/// mesh that is read has the same vertices and faces, up to the numbers of its vertices.
pub(super) fn losses(
    polygons: &PolygonMesh,
    format: Format,
    options: &WriteOptions<'_>,
    crossing: &[FaceId],
) -> Vec<Loss> {
    let mut losses = Vec::new();
    let is_stl = format.is_stl();
    let mut used = Vec::new();
    if is_stl {
        used = polygons.has_faces();
        losses.push(Loss::EqualPositions(repeated_positions(polygons, &used)));
    }
    if !format.holds_polygons() {
        let faces = polygons.faces().iter();
        losses.push(Loss::Polygons(
            faces.filter(|(_, face)| face.len() > 3).count(),
        ));
    }
    losses.extend(crossing.first().map(|&first| Loss::CrossingPolygons {
        count: crossing.len(),
        first,
    }));
    if is_stl {
        losses.push(Loss::IsolatedVertices(
            used.iter().filter(|used| !**used).count(),
        ));
    }
    if format == Format::Stl {
        let is_rounded = |&&p: &&Point| match options.placed(p) {
            Placed::Wide(p) => p.as_vec3().as_dvec3() != p,
            Placed::Narrow(_) => false,
        };
        let count = polygons.positions().iter().filter(is_rounded).count();
        let placed = |&p: &Point| match options.placed(p) {
            Placed::Wide(p) => p.to_array(),
            Placed::Narrow(p) => p.as_dvec3().to_array(),
        };
        let narrowing = match count {
            0 => Narrowing::default(),
            _ => rounded(polygons.positions().iter().map(placed)).1,
        };
        losses.push(Loss::Precision { count, narrowing });
    }
    let normals = options.normals.iter().flatten().count();
    let keeps_normals = match format {
        Format::Obj => true,
        Format::Stl | Format::StlAscii | Format::Off => false,
        _ => normals == options.normals.len(),
    };
    if !keeps_normals {
        losses.push(Loss::Normals(normals));
    }
    if let (false, Some(creases)) = (format == Format::Obj, options.creases) {
        let count = creases.edges().len() + creases.corners().len();
        losses.push(Loss::Creases(count));
    }
    losses.retain(|loss| loss.count() > 0);
    losses
}

/// Returns the number of `used` vertices minus the number of their different positions.
fn repeated_positions(polygons: &PolygonMesh, used: &[bool]) -> usize {
    let positions = polygons.positions().iter().zip(used);
    let positions: Vec<Point> = positions
        .filter_map(|(&position, &used)| used.then_some(position))
        .collect();
    let mut repeated = 0;
    for_each_equal(&positions, |_, _| repeated += 1);
    repeated
}
