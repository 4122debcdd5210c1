//! Positions of the meshes in the picture.

use glam::DVec3;
use sixfold_core::{PolygonMesh, VertexId};

use crate::error::{MeshFault, RenderError};
use crate::settings::{RenderMesh, Settings, View};

/// The empty part of a panel at each side, as a fraction of the panel.
const MARGIN: f64 = 0.07;

/// The part of the picture for one mesh.
pub(crate) struct Panel {
    /// First column of the panel in the picture.
    pub(crate) left: usize,
    /// Width in pixels.
    pub(crate) width: usize,
    /// Height in pixels.
    pub(crate) height: usize,
    /// Coordinates of each vertex, in pixels: right and down from the upper left corner of the
    /// panel, and towards the viewer. Vertices without faces can have any coordinates.
    pub(crate) positions: Vec<DVec3>,
}

impl Panel {
    /// Returns the unit of line widths, in pixels.
    pub(crate) fn unit(&self) -> f64 {
        (self.width.min(self.height) as f64 / 480.0).max(0.5)
    }

    pub(crate) fn position(&self, v: VertexId) -> DVec3 {
        self.positions[v.index()]
    }
}

struct Bounds([DVec3; 2]);

impl Bounds {
    fn size(&self) -> DVec3 {
        self.0[1] - self.0[0]
    }

    fn new(mesh: &PolygonMesh, view: &View) -> Result<Self, MeshFault> {
        if mesh.face_count() == 0 {
            return Err(MeshFault::NoFaces);
        }
        let corners = mesh.faces().corners();
        if let Some(&vertex) = corners.iter().find(|v| !mesh.position(**v).is_finite()) {
            return Err(MeshFault::NotFinite { vertex });
        }
        let positions = corners.iter().map(|&v| view.project(mesh.position(v)));
        let infinity = DVec3::splat(f64::INFINITY);
        let bounds = positions.fold([infinity, -infinity], |[low, high], p| {
            [low.min(p), high.max(p)]
        });
        let bounds = Self(bounds);
        if bounds.size().max_element() == 0.0 {
            return Err(MeshFault::NoExtent);
        }
        Ok(bounds)
    }
}

/// Returns the panels from left to right, all at one scale; O(corners).
pub(crate) fn layout(
    render_meshes: &[RenderMesh<'_>],
    settings: &Settings,
) -> Result<Vec<Panel>, RenderError> {
    if render_meshes.is_empty() {
        return Err(RenderError::NoMesh);
    }
    settings.size.check(render_meshes.len())?;
    let (width, height) = (settings.size.width as usize, settings.size.height as usize);
    let column = |panel: usize| panel * width / render_meshes.len();
    let mesh_bounds = |(mesh, render_mesh): (usize, &RenderMesh<'_>)| {
        let bounds = Bounds::new(render_mesh.mesh, &settings.view);
        bounds.map_err(|fault| RenderError::Mesh { mesh, fault })
    };
    let bounds = render_meshes.iter().enumerate().map(mesh_bounds);
    let bounds = bounds.collect::<Result<Vec<Bounds>, RenderError>>()?;
    // The narrowest panel determines the scale. Rounding makes some panels one pixel wider.
    let usable = |side: usize| side as f64 * (1.0 - 2.0 * MARGIN);
    let scales = bounds.iter().map(|bounds| {
        let size = bounds.size();
        // The limit is for a mesh that is seen from its edge.
        let min_size = size.max_element() * 0.01;
        let horizontal = usable(width / render_meshes.len()) / size.x.max(min_size);
        horizontal.min(usable(height) / size.y.max(min_size))
    });
    let scale = scales.fold(f64::INFINITY, f64::min);
    let panels = render_meshes.iter().zip(&bounds).enumerate();
    let panels = panels.map(|(i, (render_mesh, Bounds([low, high])))| {
        let (left, width) = (column(i), column(i + 1) - column(i));
        let centre = (*low + *high) / 2.0;
        let positions = render_mesh.mesh.positions().iter().map(|&p| {
            let position = (settings.view.project(p) - centre) * scale;
            let (x, y) = (
                width as f64 / 2.0 + position.x,
                height as f64 / 2.0 - position.y,
            );
            DVec3::new(x, y, position.z)
        });
        Panel {
            left,
            width,
            height,
            positions: positions.collect(),
        }
    });
    Ok(panels.collect())
}
