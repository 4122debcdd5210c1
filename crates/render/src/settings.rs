//! What is drawn, and how.

use glam::DVec3;
use mesh_core::{Creases, Point, PolygonMesh};

use crate::error::RenderError;

/// The longest side of a picture, in pixels.
pub const MAX_SIDE: u32 = 8192;

/// The most pixels of a picture: a little more than 3840 × 2160.
pub const MAX_PIXELS: u32 = 1 << 23;

/// The shortest side of the panel of one mesh, in pixels.
pub const MIN_PANEL: u32 = 16;

/// A mesh to draw, and what is sharp in it.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The mesh.
    pub mesh: &'a PolygonMesh,
    /// Its own sharp edges and corners, drawn in colour; where shading is smooth it breaks at those of
    /// sharpness 1 and more.
    pub creases: &'a Creases,
}

/// The width and height of a picture in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// From left to right.
    pub width: u32,
    /// From top to bottom.
    pub height: u32,
}

impl Size {
    /// The size of a picture of so many panels, if nothing else is asked for.
    pub fn of_row(panels: usize) -> Self {
        const PANEL: u32 = 480;
        let panels = u32::try_from(panels.max(1)).unwrap_or(u32::MAX);
        Self {
            width: panels.saturating_mul(PANEL).min(MAX_SIDE),
            height: PANEL,
        }
    }

    /// Whether `panels` can stand in a row.
    pub(crate) fn check(self, panels: usize) -> Result<(), RenderError> {
        let Self { width, height } = self;
        if width.max(height) > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS.into()
        {
            return Err(RenderError::TooLarge { width, height });
        }
        // The sides are short by now.
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

/// Which axis points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// As most OBJ files have it.
    #[default]
    Y,
    /// As scans and CAD models often have it.
    Z,
}

/// Where we look from: parallel projection, no perspective.
///
/// ```text
///     up │  ╱ to the viewer            azimuth     around the upward axis, from the front to the right
///        │ ╱ elevation                 elevation   above the ground
///        │╱______ right
/// ```
///
/// From the front means along −z where y is up, and along y where z is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The axes of the picture in the space of the mesh: right, up, and towards the viewer.
    axes: [DVec3; 3],
}

impl View {
    /// All three axes equally foreshortened.
    pub const ISO: [f64; 2] = [45.0, 35.264_389_682_754_66];

    /// The view from these angles, in degrees.
    ///
    /// # Errors
    ///
    /// [`RenderError::View`] for an angle that is not finite, and an elevation beyond 90° or −90°.
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

    /// Where `p` is in the picture: to the right, upwards, and towards the viewer.
    pub(crate) fn place(&self, p: Point) -> DVec3 {
        self.turned(p.as_dvec3())
    }

    /// A direction likewise.
    pub(crate) fn turned(&self, direction: DVec3) -> DVec3 {
        let [right, up, viewer] = self.axes.map(|axis| axis.dot(direction));
        DVec3::new(right, up, viewer)
    }
}

/// What light falls on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Each face is flat.
    Flat,
    /// Faces that meet at less than 40° are one smooth surface, unless a crease parts them.
    #[default]
    Smooth,
}

/// How to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The size of the whole picture.
    pub size: Size,
    /// Where we look from.
    pub view: View,
    /// What light falls on.
    pub shading: Shading,
    /// Whether to draw the edges that are not sharp; sharp ones are drawn always.
    pub edges: bool,
    /// Whether to draw all edges, also the hidden ones, and no faces.
    pub wireframe: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_turns_to_the_right_and_rises() {
        let at = |azimuth, elevation, up, p: Point| {
            let view = View::new(azimuth, elevation, up).expect("a view");
            view.place(p).round().to_array()
        };
        // From the front; from the right side; from above, the front below.
        let p = Point::new(1.0, 2.0, 3.0);
        assert_eq!(at(0.0, 0.0, Up::Y, p), [1.0, 2.0, 3.0]);
        assert_eq!(at(90.0, 0.0, Up::Y, p), [-3.0, 2.0, 1.0]);
        assert_eq!(at(0.0, 90.0, Up::Y, p), [1.0, -3.0, 2.0]);
        assert_eq!(at(0.0, 0.0, Up::Z, p), [1.0, 3.0, -2.0]);
        assert_eq!(at(-630.0, 0.0, Up::Z, p), [2.0, 3.0, 1.0]);
        // All axes are equally long in an isometric view.
        let [azimuth, elevation] = View::ISO;
        let view = View::new(azimuth, elevation, Up::Z).expect("a view");
        for axis in [Point::X, Point::Y, Point::Z] {
            let length = view.place(axis).truncate().length();
            assert!((length - (2.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        }
    }

    #[test]
    fn a_row_has_room_for_each() {
        let of = |panels| (Size::of_row(panels).width, Size::of_row(panels).height);
        assert_eq!([of(0), of(1), of(3)], [(480, 480), (480, 480), (1440, 480)]);
        assert_eq!(of(usize::MAX), (MAX_SIDE, 480));
    }
}
