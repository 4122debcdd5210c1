//! The depth buffer, which stores the nearest surface at each sample (a point within a pixel).

use glam::DVec3;
use sixfold_core::{FaceId, RowId, Slot};

use crate::error::RenderError;
use crate::layout::Panel;
use crate::light::{Colour, Seen, shade};
use crate::normals::Normals;
use crate::rasterise::{Corner, Rasteriser, Sample};
use crate::settings::RenderMesh;

/// The samples of one panel. Each pixel has `per_side` × `per_side` samples.
///
/// # Invariants
///
/// The vectors are one table of `columns` × `rows`, row by row.
pub(crate) struct Samples {
    pub(crate) per_side: usize,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// The depth of the nearest surface: its coordinate towards the viewer, in samples. −∞ if there
    /// is no surface.
    depths: Vec<f32>,
    /// The face of the nearest surface.
    faces: Vec<Slot<FaceId>>,
    /// The colour of the nearest surface, as fractions of [`FULL_LIGHT`].
    lights: Vec<[u16; 3]>,
}

/// The code of full light. Brighter light is clamped.
const FULL_LIGHT: f64 = 65535.0;

impl Samples {
    /// Draws the faces of `render_mesh`; O(corners + samples covered).
    ///
    /// # Errors
    ///
    /// Returns [`RenderError::Memory`] if there is not enough memory.
    pub(crate) fn new(
        render_mesh: &RenderMesh<'_>,
        panel: &Panel,
        normals: &Normals,
    ) -> Result<Self, RenderError> {
        let mut samples = Self::empty(panel)?;
        let mut rasteriser = Rasteriser::new(samples.columns, samples.rows);
        let per_side = samples.per_side as f64;
        let mut corners = Vec::new();
        for (f, face) in render_mesh.mesh.faces().iter() {
            let of_corners = &normals.corners[render_mesh.mesh.faces().range(f)];
            let seen = normals.seen(f);
            corners.clear();
            corners.extend(face.iter().zip(of_corners).map(|(&v, &normal)| Corner {
                position: panel.position(v) * per_side,
                normal,
            }));
            rasteriser.rasterise(&corners, |sample| samples.store_if_nearer(f, &sample, seen));
        }
        Ok(samples)
    }

    fn empty(panel: &Panel) -> Result<Self, RenderError> {
        // Small pictures are viewed closely, so they have more samples per pixel.
        let per_side = match panel.width * panel.height {
            ..=1_000_000 => 4,
            1_000_001..=3_000_000 => 3,
            _ => 2,
        };
        let (columns, rows) = (panel.width * per_side, panel.height * per_side);
        let count = columns * rows;
        Ok(Self {
            per_side,
            columns,
            rows,
            depths: allocate(count, f32::NEG_INFINITY)?,
            faces: allocate(count, Slot::NONE)?,
            lights: allocate(count, [0; 3])?,
        })
    }

    fn store_if_nearer(&mut self, face: FaceId, sample: &Sample, seen: Seen) {
        let at = sample.row * self.columns + sample.column;
        let depth = sample.depth as f32;
        if depth > self.depths[at] {
            self.depths[at] = depth;
            self.faces[at] = Slot::some(face);
            let light = shade(sample.normal, seen).0.to_array();
            self.lights[at] = light.map(|light| (light * FULL_LIGHT).round() as u16);
        }
    }

    /// Returns whether one of the nine samples around `position` is empty or fulfils `predicate`.
    /// The arguments of `predicate` are the depth and the face row of the nearest surface.
    pub(crate) fn any_around(&self, position: DVec3, predicate: impl Fn(f32, u32) -> bool) -> bool {
        let neighbours = |at: f64, count: usize| {
            let at = (at.max(0.0) as usize).min(count - 1);
            at.saturating_sub(1)..(at + 2).min(count)
        };
        neighbours(position.y, self.rows).any(|row| {
            neighbours(position.x, self.columns).any(|column| {
                let at = row * self.columns + column;
                let face = self.faces[at].get();
                face.is_none_or(|face| predicate(self.depths[at], face.row()))
            })
        })
    }

    /// For each face, returns whether the face is the nearest surface at a sample.
    pub(crate) fn visible_faces(&self, faces: usize) -> Vec<bool> {
        let mut visible = vec![false; faces];
        for face in self.faces.iter().filter_map(|face| face.get()) {
            visible[face.index()] = true;
        }
        visible
    }

    /// Returns the mean colour of the samples of a pixel. Empty samples have the colour
    /// `background`.
    pub(crate) fn pixel(&self, column: usize, row: usize, background: Colour) -> Colour {
        let mut sum = DVec3::ZERO;
        for row in row * self.per_side..(row + 1) * self.per_side {
            let start = row * self.columns + column * self.per_side;
            for at in start..start + self.per_side {
                sum += match self.faces[at].get() {
                    Some(_) => DVec3::from_array(self.lights[at].map(f64::from)) / FULL_LIGHT,
                    None => background.0,
                };
            }
        }
        Colour(sum / (self.per_side * self.per_side) as f64)
    }
}

/// Allocates a table of `count` cells. Returns an error if there is not enough memory.
pub(crate) fn allocate<T: Clone>(count: usize, cell: T) -> Result<Vec<T>, RenderError> {
    let mut table = Vec::new();
    let bytes = count.saturating_mul(size_of::<T>());
    let memory = |_| RenderError::Memory { bytes };
    table.try_reserve_exact(count).map_err(memory)?;
    table.resize(count, cell);
    Ok(table)
}
