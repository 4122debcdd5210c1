//! The meshes and settings of a picture.

use glam::DVec3;
use sixfold_core::{Creases, FaceId, Point, PolygonMesh, VertexId};

use crate::error::RenderError;
use crate::limits::{MAX_PIXELS, MAX_SIDE, MIN_PANEL};

/// A mesh to draw, with its creases.
#[derive(Clone, Copy, Debug)]
pub struct RenderMesh<'a> {
    /// The mesh.
    pub mesh: &'a PolygonMesh,
    /// The sharp edges and corners, drawn in colour. Shading is not smooth across an edge with a
    /// sharpness of 1 or more.
    pub creases: &'a Creases,
    /// The faults to paint; `None` for no faults.
    pub faults: Option<&'a Faults>,
}

/// Faults of a mesh, which are painted in colours of their own.
///
/// Edges and vertices that the mesh does not have are not drawn. Faces that it does not have are
/// ignored.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Boundary edges, painted in orange.
    pub boundary_edges: Vec<[VertexId; 2]>,
    /// Edges with three or more faces, painted in magenta.
    pub non_manifold_edges: Vec<[VertexId; 2]>,
    /// Vertices whose faces form several fans, painted in magenta.
    pub non_manifold_vertices: Vec<VertexId>,
    /// Faces that are turned against their neighbours, painted in yellow.
    pub turned_faces: Vec<FaceId>,
}

/// The width and height of a picture in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// The width, from left to right.
    pub width: u32,
    /// The height, from top to bottom.
    pub height: u32,
}

impl Size {
    /// Returns the default size of a picture with `panels` meshes in a row.
    pub fn for_panels(panels: usize) -> Self {
        const PANEL: u32 = 480;
        let panels = u32::try_from(panels.max(1)).unwrap_or(u32::MAX);
        Self {
            width: panels.saturating_mul(PANEL).min(MAX_SIDE),
            height: PANEL,
        }
    }

    pub(crate) fn check(self, panels: usize) -> Result<(), RenderError> {
        let Self { width, height } = self;
        if width.max(height) > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS.into()
        {
            return Err(RenderError::TooLarge { width, height });
        }
        // Width and height are at most `MAX_SIDE` here.
        let needed = panels.saturating_mul(MIN_PANEL as usize);
        if height < MIN_PANEL || (width as usize) < needed {
            return Err(RenderError::TooSmall {
                width,
                height,
                panels,
            });
        }
        Ok(())
    }
}

sixfold_core::named! {
    /// The axis that points up.
    #[derive(Default)]
    pub enum Up: "upward axis" {
        /// The y axis, as in most OBJ files.
        #[default]
        Y = "y",
        /// The z axis, as in many scans and CAD models.
        Z = "z",
    }
}

/// The direction of view. The projection is parallel, without perspective.
///
/// ```text
///     up │  ╱ to the viewer            azimuth     around the upward axis, from the front to the right
///        │ ╱ elevation                 elevation   above the ground
///        │╱______ right
/// ```
///
/// The view from the front looks along −z if y is up, and along y if z is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The axes of the picture in the space of the mesh: right, up, and towards the viewer.
    axes: [DVec3; 3],
}

impl View {
    /// Azimuth and elevation of the isometric view, in degrees.
    pub const ISO: [f64; 2] = [45.0, 35.264_389_682_754_66];

    /// Creates the view with this azimuth and elevation, in degrees.
    ///
    /// # Errors
    ///
    /// Returns [`RenderError::View`] if an angle is not finite or the elevation is outside ±90°.
    pub fn new(azimuth: f64, elevation: f64, up: Up) -> Result<Self, RenderError> {
        if !azimuth.is_finite() || !(-90.0..=90.0).contains(&elevation) {
            return Err(RenderError::View { azimuth, elevation });
        }
        let (sin_a, cos_a) = (azimuth % 360.0).to_radians().sin_cos();
        let (sin_e, cos_e) = elevation.to_radians().sin_cos();
        let right = DVec3::new(cos_a, 0.0, -sin_a);
        let viewer = DVec3::new(cos_e * sin_a, sin_e, cos_e * cos_a);
        let axes = [right, viewer.cross(right), viewer];
        let axes = match up {
            Up::Y => axes,
            Up::Z => axes.map(|axis| DVec3::new(axis.x, -axis.z, axis.y)),
        };
        Ok(Self { axes })
    }

    /// Returns the coordinates of `p` in the picture: right, up, and towards the viewer.
    pub(crate) fn project(&self, p: Point) -> DVec3 {
        self.rotate(p.as_dvec3())
    }

    /// Returns `direction` in the axes of the picture.
    pub(crate) fn rotate(&self, direction: DVec3) -> DVec3 {
        let [right, up, viewer] = self.axes.map(|axis| axis.dot(direction));
        DVec3::new(right, up, viewer)
    }
}

sixfold_core::named! {
    /// The normals that the lighting uses.
    #[derive(Default)]
    pub enum Shading: "shading" {
        /// The lighting uses the normal of each face, so that every face looks flat.
        Flat = "flat",
        /// The lighting uses smooth normals. Two adjacent faces at an angle of at most 40° look
        /// like one smooth surface, except at a crease.
        #[default]
        Smooth = "smooth",
    }
}

/// How to draw a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The size of the whole picture.
    pub size: Size,
    /// The direction of view.
    pub view: View,
    /// The normals that the lighting uses.
    pub shading: Shading,
    /// True to draw all visible edges. If false, only the visible sharp edges are drawn.
    pub edges: bool,
    /// True to draw all edges, including hidden edges, and no faces.
    pub wireframe: bool,
    /// Whether to write the names of visible vertices (`v0`), edges (`e0`) and faces (`f0`). Edges are
    /// numbered by their lower end, then by their higher end.
    pub labels: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuth_and_elevation_turn_the_view() {
        let at = |azimuth, elevation, up, p: Point| {
            let view = View::new(azimuth, elevation, up).expect("a view");
            view.project(p).round().to_array()
        };
        // The views from the front, from the right and from above.
        let p = Point::new(1.0, 2.0, 3.0);
        assert_eq!(at(0.0, 0.0, Up::Y, p), [1.0, 2.0, 3.0]);
        assert_eq!(at(90.0, 0.0, Up::Y, p), [-3.0, 2.0, 1.0]);
        assert_eq!(at(0.0, 90.0, Up::Y, p), [1.0, -3.0, 2.0]);
        assert_eq!(at(0.0, 0.0, Up::Z, p), [1.0, 3.0, -2.0]);
        assert_eq!(at(-630.0, 0.0, Up::Z, p), [2.0, 3.0, 1.0]);
        let [azimuth, elevation] = View::ISO;
        let view = View::new(azimuth, elevation, Up::Z).expect("a view");
        for axis in [Point::X, Point::Y, Point::Z] {
            let length = view.project(axis).truncate().length();
            assert!((length - (2.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        }
    }

    #[test]
    fn the_default_size_grows_with_the_number_of_panels() {
        let of = |panels| {
            (
                Size::for_panels(panels).width,
                Size::for_panels(panels).height,
            )
        };
        assert_eq!([of(0), of(1), of(3)], [(480, 480), (480, 480), (1440, 480)]);
        assert_eq!(of(usize::MAX), (MAX_SIDE, 480));
    }
}
