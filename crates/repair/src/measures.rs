//! The size of a mesh: its box, the lengths of its edges, its area and its volume.

use glam::DVec3;
use sixfold_core::{FaceId, Incidence, PolygonCutter, PolygonMesh, VertexId};

/// The size of a mesh, in units of its coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Measures {
    /// The smallest and the largest coordinates of the vertices of faces; `None` without faces.
    pub bounds: Option<[[f64; 3]; 2]>,
    /// The lengths of the edges; `None` without edges.
    pub edge_lengths: Option<Lengths>,
    /// The sum of the areas of the faces.
    pub area: f64,
    /// The volume that the faces enclose, negative if they face inward; `None` if an edge does not
    /// have two faces that run along it in opposite directions. Cavities count if they face the cavity.
    pub volume: Option<f64>,
}

/// Lengths of edges.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Lengths {
    /// The shortest.
    pub least: f64,
    /// The mean.
    pub mean: f64,
    /// The longest.
    pub largest: f64,
}

impl Measures {
    /// Returns the sides of the box; zeros without faces.
    pub fn size(&self) -> [f64; 3] {
        let [low, high] = self.bounds.unwrap_or_default();
        [0, 1, 2].map(|axis| high[axis] - low[axis])
    }
}

/// Measures a mesh; O(n log n) for n corners, plus the time to cut the polygons. The area and the volume
/// are those of the triangles that [`PolygonCutter::cut`] makes, so that a mesh keeps them when it is
/// triangulated. A polygon that is not planar has more area than its projection, and the triangles of
/// one that crosses itself overlap.
///
/// ```
/// use sixfold_repair::measures;
///
/// let cube = measures(&sixfold_shapes::cube()); // corners at ±1
/// assert_eq!((cube.size(), cube.area, cube.volume), ([2.0; 3], 24.0, Some(8.0)));
/// assert_eq!(cube.edge_lengths.map(|lengths| lengths.mean), Some(2.0));
/// ```
pub fn measures(polygons: &PolygonMesh) -> Measures {
    let incidence = Incidence::new(polygons.vertex_count(), polygons.faces(), |_| true);
    measures_with(polygons, &incidence).0
}

/// Measures a mesh, and returns the faces that cross themselves, ascending. `incidence` has the sides of all
/// its faces.
pub(crate) fn measures_with(
    polygons: &PolygonMesh,
    incidence: &Incidence<'_>,
) -> (Measures, Vec<FaceId>) {
    let at = |v: VertexId| polygons.position(v).as_dvec3();
    let mut is_closed = polygons.face_count() > 0;
    let (mut least, mut largest, mut sum, mut edges) = (f64::INFINITY, 0.0_f64, 0.0, 0_usize);
    incidence.edges().for_each(|edge| {
        is_closed &= edge.len() == 2 && edge.downward() == 1;
        let [a, b] = edge.ends.map(at);
        let length = a.distance(b);
        least = least.min(length);
        largest = largest.max(length);
        sum += length;
        edges += 1;
    });
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (mut area, mut six_volumes) = (0.0, 0.0);
    let mut cutter = PolygonCutter::default();
    let origin = polygons.faces().corners().first().map(|&v| at(v));
    let mut crossing = Vec::new();
    for (f, face) in polygons.faces().iter() {
        let corners = face.iter().map(|&v| at(v));
        for p in corners.clone() {
            low = low.min(p);
            high = high.max(p);
        }
        let cut = cutter.cut(corners, |_, _| false);
        if cut.is_crossing {
            crossing.push(f);
        }
        for [a, b, c] in cut.triangles {
            let [a, b, c] = [a, b, c].map(|&i| at(face[i]));
            let vector = (b - a).cross(c - a);
            area += vector.length() / 2.0;
            // The cone from the origin to the triangle; relative, to stay accurate far from zero.
            six_volumes += (a - origin.unwrap_or_default()).dot(vector);
        }
    }
    let measures = Measures {
        bounds: origin.map(|_| [low.to_array(), high.to_array()]),
        edge_lengths: (edges > 0).then(|| Lengths {
            least,
            mean: sum / edges as f64,
            largest,
        }),
        area,
        volume: is_closed.then_some(six_volumes / 6.0),
    };
    (measures, crossing)
}

#[cfg(test)]
mod tests {
    use sixfold_core::Point;

    use super::*;

    #[test]
    fn open_turned_and_inward_meshes_have_their_volume_or_none() {
        let cube = sixfold_shapes::cube();
        let faces: Vec<Vec<u32>> = cube
            .faces()
            .iter()
            .map(|(_, face)| face.iter().map(|v| v.index() as u32).collect())
            .collect();
        let with = |faces: Vec<Vec<u32>>| {
            measures(&PolygonMesh::new(cube.positions().iter().copied(), faces).expect("valid"))
        };
        let inward = faces
            .iter()
            .map(|face| face.iter().rev().copied().collect());
        assert_eq!(with(inward.collect()).volume, Some(-8.0));
        assert_eq!(with(faces[1..].to_vec()).volume, None);
        assert_eq!(with(faces[1..].to_vec()).area, 20.0);
        let mut turned = faces;
        turned[2].reverse();
        assert_eq!(with(turned).volume, None);
        let none = with(Vec::new());
        assert_eq!(
            (none.bounds, none.edge_lengths, none.area),
            (None, None, 0.0)
        );
        assert_eq!((none.volume, none.size()), (None, [0.0; 3]));
    }

    #[test]
    fn lengths_boxes_and_volumes_far_from_the_origin() {
        let far = Point::splat(4096.0);
        let corners = [Point::ZERO, 3.0 * Point::X, 4.0 * Point::Y, Point::Z].map(|p| p + far);
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let mut points = corners.to_vec();
        points.push(Point::splat(-9.0)); // not a corner of a face
        let found = measures(&PolygonMesh::new(points, faces).expect("valid"));
        assert_eq!(found.bounds, Some([[4096.0; 3], [4099.0, 4100.0, 4097.0]]));
        assert_eq!(found.volume, Some(2.0));
        let lengths = found.edge_lengths.expect("six edges");
        let mean = (3.0 + 4.0 + 1.0 + 5.0 + 10_f64.sqrt() + 17_f64.sqrt()) / 6.0;
        assert_eq!([lengths.least, lengths.largest], [1.0, 5.0]);
        assert!((lengths.mean - mean).abs() < 1e-12);
    }
}
