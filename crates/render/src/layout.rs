//! Positions of the meshes in the picture.

use glam::DVec3;
use sixfold_core::{PolygonMesh, VertexId};

use crate::error::{MeshFault, RenderError};
use crate::settings::{Settings, Subject, View};

/// The empty part of a panel at each side, as a fraction of the panel.
const MARGIN: f64 = 0.07;

/// The part of the picture for one mesh.
pub(crate) struct Panel {
    /// The first column of the panel in the picture.
    pub(crate) left: usize,
    /// In pixels.
    pub(crate) width: usize,
    /// In pixels.
    pub(crate) height: usize,
    /// Coordinates by vertex, in pixels: to the right and down from the upper left corner of the
    /// panel, and towards the viewer. Vertices without faces can have any coordinates.
    pub(crate) places: Vec<DVec3>,
}

impl Panel {
    /// Returns the unit of line widths in pixels, which grows with the panel.
    pub(crate) fn unit(&self) -> f64 {
        (self.width.min(self.height) as f64 / 480.0).max(0.5)
    }

    /// Returns the coordinates of `v` in the panel.
    pub(crate) fn place(&self, v: VertexId) -> DVec3 {
        self.places[v.index()]
    }
}

/// The least and the greatest coordinates of a mesh, in the axes of the picture.
struct Bounds([DVec3; 2]);

impl Bounds {
    fn size(&self) -> DVec3 {
        self.0[1] - self.0[0]
    }

    fn of(mesh: &PolygonMesh, view: &View) -> Result<Self, MeshFault> {
        if mesh.face_count() == 0 {
            return Err(MeshFault::NoFaces);
        }
        let corners = mesh.faces().corners();
        if let Some(&vertex) = corners.iter().find(|v| !mesh.position(**v).is_finite()) {
            return Err(MeshFault::NotFinite { vertex });
        }
        let places = corners.iter().map(|&v| view.place(mesh.position(v)));
        let least = DVec3::splat(f64::INFINITY);
        let bounds = places.fold([least, -least], |[low, high], p| [low.min(p), high.max(p)]);
        let bounds = Self(bounds);
        if bounds.size().max_element() == 0.0 {
            return Err(MeshFault::NoExtent);
        }
        Ok(bounds)
    }
}

/// Returns the panels from left to right, each with a centred mesh, all at one scale; O(corners).
pub(crate) fn layout(
    subjects: &[Subject<'_>],
    settings: &Settings,
) -> Result<Vec<Panel>, RenderError> {
    if subjects.is_empty() {
        return Err(RenderError::NoMesh);
    }
    settings.size.check(subjects.len())?;
    let (width, height) = (settings.size.width as usize, settings.size.height as usize);
    let column = |panel: usize| panel * width / subjects.len();
    let of_mesh = |(mesh, subject): (usize, &Subject<'_>)| {
        let bounds = Bounds::of(subject.mesh, &settings.view);
        bounds.map_err(|fault| RenderError::Mesh { mesh, fault })
    };
    let bounds = subjects.iter().enumerate().map(of_mesh);
    let bounds = bounds.collect::<Result<Vec<Bounds>, RenderError>>()?;
    // All panels count as wide as the narrowest; rounding makes a difference of one pixel.
    let free = |side: usize| side as f64 * (1.0 - 2.0 * MARGIN);
    let scales = bounds.iter().map(|bounds| {
        let size = bounds.size();
        // Limits the scale of a mesh that is seen from its edge.
        let least = size.max_element() * 0.01;
        let across = free(width / subjects.len()) / size.x.max(least);
        across.min(free(height) / size.y.max(least))
    });
    let scale = scales.fold(f64::INFINITY, f64::min);
    let panels = subjects.iter().zip(&bounds).enumerate();
    let panels = panels.map(|(i, (subject, Bounds([low, high])))| {
        let (left, width) = (column(i), column(i + 1) - column(i));
        let middle = (*low + *high) / 2.0;
        let places = subject.mesh.positions().iter().map(|&p| {
            let place = (settings.view.place(p) - middle) * scale;
            let (x, y) = (width as f64 / 2.0 + place.x, height as f64 / 2.0 - place.y);
            DVec3::new(x, y, place.z)
        });
        Panel {
            left,
            width,
            height,
            places: places.collect(),
        }
    });
    Ok(panels.collect())
}
