//! The depth buffer: the nearest surface at each sample.

use glam::DVec3;
use sixfold_core::{FaceId, RowId, Slot};

use crate::error::RenderError;
use crate::fill::{Corner, Filler, Sample};
use crate::layout::Panel;
use crate::light::{Colour, lit};
use crate::normals::Normals;
use crate::settings::Subject;

/// The samples of one panel: `fine` × `fine` for each pixel.
///
/// # Invariants
///
/// The vectors are one table of `columns` × `rows`, row by row.
pub(crate) struct Samples {
    pub(crate) fine: usize,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// The depth of the nearest surface towards the viewer, in samples; −∞ if there is no surface.
    depths: Vec<f32>,
    /// The face of this surface.
    faces: Vec<Slot<FaceId>>,
    /// The colour of this surface, in shares of [`FULL`].
    lights: Vec<[u16; 3]>,
}

/// The code of full light. Brighter highlights are clamped, as on a screen.
const FULL: f64 = 65535.0;

impl Samples {
    /// Draws the faces of `subject`; O(corners + samples covered).
    ///
    /// # Errors
    ///
    /// Returns [`RenderError::Memory`] if there is not enough memory.
    pub(crate) fn of(
        subject: &Subject<'_>,
        panel: &Panel,
        normals: &Normals,
    ) -> Result<Self, RenderError> {
        let mut samples = Self::empty(panel)?;
        let mut filler = Filler::new(samples.columns, samples.rows);
        let fine = samples.fine as f64;
        let mut corners = Vec::new();
        for (f, face) in subject.mesh.faces().iter() {
            let of_corners = &normals.corners[subject.mesh.faces().range(f)];
            let inside = normals.faces[f.index()].z < 0.0;
            corners.clear();
            corners.extend(face.iter().zip(of_corners).map(|(&v, &normal)| Corner {
                place: panel.place(v) * fine,
                normal,
            }));
            filler.fill(&corners, |sample| samples.put(f, &sample, inside));
        }
        Ok(samples)
    }

    fn empty(panel: &Panel) -> Result<Self, RenderError> {
        // More samples per pixel for small pictures, which are viewed closely.
        let fine = match panel.width * panel.height {
            ..=1_000_000 => 4,
            1_000_001..=3_000_000 => 3,
            _ => 2,
        };
        let (columns, rows) = (panel.width * fine, panel.height * fine);
        let count = columns * rows;
        Ok(Self {
            fine,
            columns,
            rows,
            depths: table(count, f32::NEG_INFINITY)?,
            faces: table(count, Slot::NONE)?,
            lights: table(count, [0; 3])?,
        })
    }

    fn put(&mut self, face: FaceId, sample: &Sample, inside: bool) {
        let at = sample.row * self.columns + sample.column;
        let depth = sample.depth as f32;
        if depth > self.depths[at] {
            self.depths[at] = depth;
            self.faces[at] = Slot::some(face);
            let light = lit(sample.normal, inside).0.to_array();
            self.lights[at] = light.map(|light| (light * FULL).round() as u16);
        }
    }

    /// Returns whether, at one of the nine samples around `place`, there is no surface, or `near`
    /// is true for the depth and the face row of the nearest surface.
    pub(crate) fn any_around(&self, place: DVec3, near: impl Fn(f32, u32) -> bool) -> bool {
        let around = |at: f64, count: usize| {
            let at = (at.max(0.0) as usize).min(count - 1);
            at.saturating_sub(1)..(at + 2).min(count)
        };
        around(place.y, self.rows).any(|row| {
            around(place.x, self.columns).any(|column| {
                let at = row * self.columns + column;
                let face = self.faces[at].get();
                face.is_none_or(|face| near(self.depths[at], face.row()))
            })
        })
    }

    /// Returns for each face whether it is the nearest at any sample.
    pub(crate) fn visible(&self, faces: usize) -> Vec<bool> {
        let mut visible = vec![false; faces];
        for face in self.faces.iter().filter_map(|face| face.get()) {
            visible[face.index()] = true;
        }
        visible
    }

    /// Returns the mean colour of the samples of a pixel, with `background` for empty samples.
    pub(crate) fn pixel(&self, column: usize, row: usize, background: Colour) -> Colour {
        let mut sum = DVec3::ZERO;
        for row in row * self.fine..(row + 1) * self.fine {
            let start = row * self.columns + column * self.fine;
            for at in start..start + self.fine {
                sum += match self.faces[at].get() {
                    Some(_) => DVec3::from_array(self.lights[at].map(f64::from)) / FULL,
                    None => background.0,
                };
            }
        }
        Colour(sum / (self.fine * self.fine) as f64)
    }
}

/// Returns a table of `count` cells, or an error if there is not enough memory.
pub(crate) fn table<T: Clone>(count: usize, cell: T) -> Result<Vec<T>, RenderError> {
    let mut table = Vec::new();
    let bytes = count.saturating_mul(size_of::<T>());
    let memory = |_| RenderError::Memory { bytes };
    table.try_reserve_exact(count).map_err(memory)?;
    table.resize(count, cell);
    Ok(table)
}
