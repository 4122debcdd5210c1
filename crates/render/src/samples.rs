//! The depth buffer, which stores the nearest surface at each sample (a point within a pixel).

use glam::DVec3;
use sixfold_core::{FaceId, RowId, Slot};

use crate::error::RenderError;
use crate::layout::Panel;
use crate::light::{Colour, shade};
use crate::normals::Normals;
use crate::rasterise::{Corner, Rasteriser, Span};
use crate::settings::RenderMesh;
use crate::tiles::Tiles;

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
    /// Draws the faces of `render_mesh`; O(corners + samples covered). Faces that cover many samples are
    /// drawn from the front to the back, and without the parts behind others.
    ///
    /// # Errors
    ///
    /// Returns [`RenderError::Memory`] if there is not enough memory.
    pub(crate) fn new(
        render_mesh: &RenderMesh<'_>,
        panel: &Panel,
        normals: &Normals,
    ) -> Result<Self, RenderError> {
        /// Samples of the box around a large face: four tiles.
        const LARGE: f64 = 4096.0;
        let mut samples = Self::empty(panel)?;
        let mut tiles = Tiles::new(samples.columns, samples.rows)?;
        let mut rasteriser = Rasteriser::new(samples.columns, samples.rows);
        let per_side = samples.per_side as f64;
        let position = |v| panel.position(v) * per_side;
        let faces = render_mesh.mesh.faces();
        let mut corners = Vec::new();
        let mut draw = |f, samples: &mut Self, tiles: &mut Tiles| {
            let of_corners = faces.face(f).iter().zip(&normals.corners[faces.range(f)]);
            corners.clear();
            corners.extend(of_corners.map(|(&v, &normal)| Corner {
                position: position(v),
                normal,
            }));
            rasteriser.rasterise(&corners, |span| samples.draw(span, f, normals, tiles));
        };
        let mut large = Vec::new();
        for (f, face) in faces.iter() {
            let corners = || face.iter().map(|&v| position(v));
            let low = corners().fold(DVec3::INFINITY, DVec3::min);
            let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
            if (high - low).truncate().element_product() < LARGE {
                draw(f, &mut samples, &mut tiles);
            } else {
                large.push((f, low, high, nearest(high.z)));
            }
        }
        large.sort_by(|one, other| other.3.total_cmp(&one.3));
        for (f, low, high, nearest) in large {
            if tiles.update(low.truncate(), high.truncate(), nearest, &samples.depths) {
                draw(f, &mut samples, &mut tiles);
            }
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

    /// Draws a row of a face where it is nearer than what was drawn before; of two faces at the same depth,
    /// the first one is seen.
    fn draw(&mut self, span: &Span, face: FaceId, normals: &Normals, tiles: &mut Tiles) {
        for columns in Tiles::parts(span.columns.clone()) {
            let first = [span.row, columns.start];
            let depths = || [columns.start, columns.end - 1].map(|column| span.depth(column));
            let nearest = || nearest(depths()[0].max(depths()[1]));
            if tiles.hides(first, nearest) {
                continue;
            }
            let mut is_drawn = false;
            for column in columns.clone() {
                let at = span.row * self.columns + column;
                let depth = span.depth(column) as f32;
                let is_first = || self.faces[at].get().is_none_or(|other| face < other);
                if depth > self.depths[at] || depth == self.depths[at] && is_first() {
                    is_drawn = true;
                    self.depths[at] = depth;
                    self.faces[at] = Slot::some(face);
                    let light = shade(span.normal(column), normals.seen(face)).0.to_array();
                    self.lights[at] = light.map(|light| (light * FULL_LIGHT).round() as u16);
                }
            }
            if is_drawn {
                tiles.mark_drawn(first);
            }
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

/// Returns a depth that no interpolated depth up to `depth` exceeds through rounding.
fn nearest(depth: f64) -> f32 {
    (depth as f32).next_up()
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
