//! The items of an index: vertices with their positions, and the triangles of faces.

use glam::{BVec3, DMat3, DVec3, Vec3};
use sixfold_core::{FaceId, MAX_ROWS, MeshQuery, PolygonCutter, PolygonMesh, VertexId, row};

use crate::bounds::Bounds;
use crate::contact::meets_box;
use crate::error::SpatialError;

/// An element that an index stores: it has a bounding box.
pub trait Item: Copy + Send + Sync {
    /// Returns the smallest box around the item.
    fn bounds(&self) -> Bounds;

    /// Returns the smallest box around the item along other axes, which are the rows of `axes`.
    fn bounds_along(&self, axes: &DMat3) -> Bounds;

    /// Returns whether the item may have a point in a box along the rows of `axes`; without `axes`, along
    /// the coordinate axes. Never false if it has one.
    fn may_meet(&self, axes: Option<&DMat3>, bounds: &Bounds) -> bool {
        let own = axes.map_or_else(|| self.bounds(), |axes| self.bounds_along(axes));
        own.meets(bounds)
    }

    /// Returns the vectors along the sides of the item; a point has none.
    fn sides(&self) -> impl Iterator<Item = DVec3>;

    /// Returns whether all coordinates are finite.
    fn is_finite(&self) -> bool;
}

/// A vertex and its position. `V` is any name with an order, usually the handle of a structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexPoint<V> {
    /// The name of the vertex.
    pub vertex: V,
    /// Its position.
    pub position: Vec3,
}

impl<V: Copy + Send + Sync> Item for VertexPoint<V> {
    #[inline]
    fn bounds(&self) -> Bounds {
        Bounds {
            low: self.position,
            high: self.position,
        }
    }

    fn bounds_along(&self, axes: &DMat3) -> Bounds {
        Bounds::from_points_along(axes, [self.position])
    }

    fn sides(&self) -> impl Iterator<Item = DVec3> {
        std::iter::empty()
    }

    #[inline]
    fn is_finite(&self) -> bool {
        self.position.is_finite()
    }
}

/// A triangle of a face. A polygon has several. `F` is any name with an order, usually the handle of a
/// structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceTriangle<F> {
    /// The name of the face.
    pub face: F,
    /// The corners, in the order of the face.
    pub corners: [Vec3; 3],
}

impl<F> FaceTriangle<F> {
    /// Returns the corners in double precision.
    #[inline]
    pub fn corners_f64(&self) -> [DVec3; 3] {
        self.corners.map(|corner| corner.as_dvec3())
    }

    /// Returns the normal, to the side from which the corners run counter-clockwise. Its length is
    /// twice the area.
    #[inline]
    pub fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners_f64();
        (b - a).cross(c - a)
    }

    /// Returns the area.
    #[inline]
    pub fn area(&self) -> f64 {
        0.5 * self.normal().length()
    }
}

impl<F: Copy + Send + Sync> Item for FaceTriangle<F> {
    #[inline]
    fn bounds(&self) -> Bounds {
        let [a, b, c] = self.corners;
        Bounds {
            low: a.min(b).min(c),
            high: a.max(b).max(c),
        }
    }

    fn bounds_along(&self, axes: &DMat3) -> Bounds {
        Bounds::from_points_along(axes, self.corners)
    }

    fn may_meet(&self, axes: Option<&DMat3>, bounds: &Bounds) -> bool {
        let own = axes.map_or_else(|| self.bounds(), |axes| self.bounds_along(axes));
        let turned = |corner| axes.map_or(corner, |&axes| axes * corner);
        own.meets(bounds) && meets_box(self.corners_f64().map(turned), bounds)
    }

    fn sides(&self) -> impl Iterator<Item = DVec3> {
        let [a, b, c] = self.corners_f64();
        [b - a, c - b, a - c].into_iter()
    }

    #[inline]
    fn is_finite(&self) -> bool {
        self.corners.iter().all(|corner| corner.is_finite())
    }
}

/// A box, such as that of a part of a mesh. `N` is any name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedBox<N> {
    /// The name of what is in the box.
    pub name: N,
    /// The box.
    pub bounds: Bounds,
}

impl<N: Copy + Send + Sync> Item for NamedBox<N> {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn bounds_along(&self, axes: &DMat3) -> Bounds {
        let Bounds { low, high } = self.bounds;
        let corner = |i: u32| Vec3::select(BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low);
        Bounds::from_points_along(axes, (0..8).map(corner))
    }

    /// Its sides are along the coordinate axes already.
    fn sides(&self) -> impl Iterator<Item = DVec3> {
        std::iter::empty()
    }

    fn is_finite(&self) -> bool {
        self.bounds.low.is_finite() && self.bounds.high.is_finite()
    }
}

/// Returns the vertices of `mesh`, isolated vertices included, in the order of `vertices()`;
/// O(vertices).
///
/// # Errors
///
/// [`SpatialError::PositionNotFinite`] for the first vertex without a finite position.
pub fn vertex_points<M: MeshQuery>(mesh: &M) -> Result<Vec<VertexPoint<M::Vertex>>, SpatialError> {
    let points = mesh.vertices().map(|vertex| VertexPoint {
        vertex,
        position: mesh.position(vertex),
    });
    finite_points(points)
}

/// Returns the vertices of `polygons`, isolated vertices included, in their order; O(vertices).
///
/// # Errors
///
/// [`SpatialError::PositionNotFinite`] for the first vertex without a finite position.
pub fn polygon_points(polygons: &PolygonMesh) -> Result<Vec<VertexPoint<VertexId>>, SpatialError> {
    let points = polygons.vertices().map(|vertex| VertexPoint {
        vertex,
        position: polygons.position(vertex),
    });
    finite_points(points)
}

fn finite_points<V: Copy + Send + Sync>(
    points: impl Iterator<Item = VertexPoint<V>>,
) -> Result<Vec<VertexPoint<V>>, SpatialError> {
    let points: Vec<VertexPoint<V>> = points.collect();
    match points.iter().position(|point| !point.is_finite()) {
        Some(index) => Err(position_not_finite(index, points[index].position)),
        None => Ok(points),
    }
}

fn position_not_finite(vertex: usize, position: Vec3) -> SpatialError {
    SpatialError::PositionNotFinite {
        vertex: VertexId::new(row(vertex)),
        position: position.to_array(),
    }
}

/// Returns the triangles of the faces of `mesh`, in the order of `faces()`; O(corners) for faces of
/// bounded degree.
///
/// A polygon is cut by a [`PolygonCutter`], whose documentation says which polygons have triangles
/// that do not overlap, and how long this takes. The triangles of a polygon that crosses itself
/// overlap.
///
/// # Errors
///
/// [`SpatialError::PositionNotFinite`] for the first vertex without a finite position, if it is a
/// corner of a face.
pub fn face_triangles<M: MeshQuery>(mesh: &M) -> Result<Vec<FaceTriangle<M::Face>>, SpatialError> {
    let mut triangles = Triangles::new(mesh.face_count());
    mesh.faces().for_each(|face| {
        let corners = mesh.face_vertices(face).map(|v| mesh.position(v));
        triangles.push_face(face, corners);
    });
    let positions = || mesh.vertices().map(|v| mesh.position(v));
    finite_triangles(triangles.list, positions)
}

/// Returns the triangles of the faces of `polygons`, in their order, as [`face_triangles`] does.
///
/// # Errors
///
/// [`SpatialError::PositionNotFinite`] for the first vertex without a finite position, if it is a
/// corner of a face.
pub fn polygon_triangles(
    polygons: &PolygonMesh,
) -> Result<Vec<FaceTriangle<FaceId>>, SpatialError> {
    let mut triangles = Triangles::new(polygons.face_count());
    for (face, corners) in polygons.faces().iter() {
        let corners = corners.iter().map(|&v| polygons.position(v));
        triangles.push_face(face, corners);
    }
    finite_triangles(triangles.list, || polygons.positions().iter().copied())
}

/// The triangles of the faces so far.
struct Triangles<F> {
    list: Vec<FaceTriangle<F>>,
    cutter: PolygonCutter,
    corners: Vec<Vec3>,
}

impl<F: Copy> Triangles<F> {
    fn new(faces: usize) -> Self {
        Self {
            list: Vec::with_capacity(faces),
            cutter: PolygonCutter::default(),
            corners: Vec::new(),
        }
    }

    /// Appends the triangles of a face.
    #[inline]
    fn push_face(&mut self, face: F, corners: impl Iterator<Item = Vec3>) {
        let Self {
            list,
            cutter,
            corners: points,
        } = self;
        points.clear();
        points.extend(corners);
        if let &[a, b, c] = points.as_slice() {
            let corners = [a, b, c];
            list.push(FaceTriangle { face, corners });
            return;
        }
        let cut = cutter.cut(points.iter().map(|p| p.as_dvec3()), |_, _| false);
        list.extend(cut.triangles.iter().map(|triangle| FaceTriangle {
            face,
            corners: triangle.map(|i| points[i]),
        }));
    }
}

fn finite_triangles<F: Copy + Send + Sync, P: Iterator<Item = Vec3>>(
    triangles: Vec<FaceTriangle<F>>,
    positions: impl Fn() -> P,
) -> Result<Vec<FaceTriangle<F>>, SpatialError> {
    if let Some(item) = triangles.iter().position(|t| !t.is_finite()) {
        let vertex = positions().enumerate().find(|(_, p)| !p.is_finite());
        return Err(match vertex {
            Some((vertex, position)) => position_not_finite(vertex, position),
            None => SpatialError::ItemNotFinite { item },
        });
    }
    Ok(triangles)
}

/// Checks that `items` can be numbered, and that all of them are finite.
pub(crate) fn check_items<I: Item>(items: &[I]) -> Result<(), SpatialError> {
    if items.len() > MAX_ROWS {
        return Err(SpatialError::TooManyItems {
            items: items.len(),
            limit: MAX_ROWS,
        });
    }
    match items.iter().position(|item| !item.is_finite()) {
        Some(item) => Err(SpatialError::ItemNotFinite { item }),
        None => Ok(()),
    }
}
