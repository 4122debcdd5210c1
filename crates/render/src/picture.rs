//! Drawing of a picture as pixels.

use std::io::{self, Write};

use glam::DVec2;

use crate::edges::Edges;
use crate::error::{MeshFault, RenderError};
use crate::labels::{LabelPixels, check_labels};
use crate::layout::{Panel, layout};
use crate::light::{BACKGROUND, Colour};
use crate::normals::Normals;
use crate::samples::{Samples, allocate};
use crate::settings::{RenderMesh, Settings, Size};
use crate::strokes::{Stroke, Strokes};

/// A picture with three bytes per pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    size: Size,
    bytes: Vec<u8>,
}

impl Picture {
    /// Returns the size in pixels.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Returns the colours of the pixels, row by row from the top left. Each pixel has three bytes:
    /// red, green and blue (sRGB).
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Writes the picture as PNG.
    ///
    /// # Errors
    ///
    /// Returns the error of `out`.
    pub fn write_png(&self, out: impl Write) -> io::Result<()> {
        let Size { width, height } = self.size;
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_compression(png::Compression::High);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.bytes)?;
        writer.finish()?;
        Ok(())
    }
}

/// Draws the meshes in a row. Takes O(c log c + s) time, where c is the number of corners of all
/// faces, and s is the number of samples that faces cover.
///
/// A *sample* is a point of the depth buffer; a pixel has at most sixteen samples. The meshes are
/// drawn one after the other. During the drawing of a mesh, the function needs 14 bytes for each
/// sample of the part of the picture that shows this mesh.
///
/// # Errors
///
/// Returns a [`RenderError`] if the picture cannot be drawn.
///
/// # Examples
///
/// ```
/// use sixfold_core::{Creases, Point, PolygonMesh};
/// use sixfold_render::{Settings, Shading, Size, RenderMesh, Up, View};
///
/// let mesh = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
/// let creases = Creases::new(&mesh, [([0, 1], 2.0)], [])?;
/// let [azimuth, elevation] = View::ISO;
/// let settings = Settings {
///     size: Size { width: 64, height: 48 },
///     view: View::new(azimuth, elevation, Up::Y)?,
///     shading: Shading::Smooth,
///     edges: true,
///     wireframe: false,
///     labels: false,
/// };
/// let render_mesh = RenderMesh { mesh: &mesh, creases: &creases, faults: None };
/// let picture = sixfold_render::draw(&[render_mesh], &settings)?;
/// assert_eq!(picture.bytes().len(), 64 * 48 * 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(render_meshes: &[RenderMesh<'_>], settings: &Settings) -> Result<Picture, RenderError> {
    let panels = layout(render_meshes, settings)?;
    let Size { width, height } = settings.size;
    let mut bytes = allocate(width as usize * height as usize * 3, 0)?;
    for (mesh, (render_mesh, panel)) in render_meshes.iter().zip(&panels).enumerate() {
        let parts =
            VisibleParts::new(render_mesh, panel, settings).map_err(|error| error.of_mesh(mesh))?;
        let mut layers = Vec::new();
        for layer in &parts.strokes.layers {
            if layer.strokes.iter().any(|(strokes, _)| !strokes.is_empty()) {
                layers.push((LineCoverage::new(panel, &layer.strokes)?, layer.colour));
            }
        }
        let labels = LabelPixels::new(&parts.strokes.labels, panel);
        for row in 0..panel.height {
            for column in 0..panel.width {
                let surface = parts.samples.as_ref();
                let colour = surface.map_or(BACKGROUND, |s| s.pixel(column, row, BACKGROUND));
                let blend = |colour, (lines, over): &(LineCoverage, Colour)| {
                    lines.blend(colour, *over, column, row)
                };
                let colour = layers.iter().fold(colour, blend);
                let colour = labels.colour(column, row).unwrap_or(colour);
                let at = 3 * (row * width as usize + panel.left + column);
                bytes[at..at + 3].copy_from_slice(&colour.srgb_codes());
            }
        }
    }
    let size = settings.size;
    Ok(Picture { size, bytes })
}

/// The reason why the parts of one mesh cannot be drawn.
pub(crate) enum PartsError {
    Picture(RenderError),
    Mesh(MeshFault),
}

impl PartsError {
    /// Returns the error for mesh number `mesh` of the row.
    pub(crate) fn of_mesh(self, mesh: usize) -> RenderError {
        match self {
            Self::Picture(error) => error,
            Self::Mesh(fault) => RenderError::Mesh { mesh, fault },
        }
    }
}

impl From<RenderError> for PartsError {
    fn from(error: RenderError) -> Self {
        Self::Picture(error)
    }
}

impl From<MeshFault> for PartsError {
    fn from(fault: MeshFault) -> Self {
        Self::Mesh(fault)
    }
}

pub(crate) struct VisibleParts {
    pub(crate) normals: Normals,
    /// `None` in a wireframe.
    pub(crate) samples: Option<Samples>,
    pub(crate) strokes: Strokes,
}

impl VisibleParts {
    pub(crate) fn new(
        render_mesh: &RenderMesh<'_>,
        panel: &Panel,
        settings: &Settings,
    ) -> Result<Self, PartsError> {
        let &RenderMesh {
            mesh,
            creases,
            faults,
        } = render_mesh;
        let edges = Edges::new(mesh);
        if settings.labels {
            check_labels(mesh, &edges)?;
        }
        let mut normals = Normals::new(mesh, creases, &edges, settings.shading, &settings.view);
        normals.paint_turned(faults.map_or(&[], |faults| &faults.turned_faces));
        let samples = match settings.wireframe {
            true => None,
            false => Some(Samples::new(render_mesh, panel, &normals)?),
        };
        let strokes = Strokes::new(render_mesh, panel, &edges, samples.as_ref(), settings);
        Ok(Self {
            normals,
            samples,
            strokes,
        })
    }
}

/// For each pixel of a panel, the share that lines of one colour cover. If several lines cover a
/// pixel, the largest share counts.
struct LineCoverage {
    width: usize,
    shares: Vec<u8>,
}

impl LineCoverage {
    fn new(panel: &Panel, strokes: &[(Vec<Stroke>, f64)]) -> Result<Self, RenderError> {
        let Panel { width, height, .. } = *panel;
        let shares = allocate(width * height, 0)?;
        let mut coverage = Self { width, shares };
        for (strokes, width) in strokes {
            for stroke in strokes {
                coverage.draw(stroke, width / 2.0, height);
            }
        }
        Ok(coverage)
    }

    fn draw(&mut self, stroke: &Stroke, radius: f64, height: usize) {
        let [a, b] = stroke.ends;
        let along = b - a;
        let margin = DVec2::splat(radius + 1.0);
        let (low, high) = (a.min(b) - margin, a.max(b) + margin);
        // The cast turns negative values into 0.
        let pixels = |low: f64, high: f64, count| low as usize..(high.ceil() as usize).min(count);
        // A line thinner than a pixel is paler.
        let max_cover = (2.0 * radius).min(1.0);
        for row in pixels(low.y, high.y, height) {
            for column in
                self.columns_near_line(row, [a, b], margin.x, pixels(low.x, high.x, self.width))
            {
                let centre = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let t = (centre - a).dot(along) / along.length_squared();
                // `t` is NaN for a dot, because a dot has no direction.
                let t = if t.is_finite() {
                    t.clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let distance = centre.distance(a + along * t);
                let cover = (radius.max(0.5) + 0.5 - distance).clamp(0.0, 1.0) * max_cover;
                let share = &mut self.shares[row * self.width + column];
                *share = (*share).max((cover * stroke.opacity * 255.0).round() as u8);
            }
        }
    }

    /// Returns the columns of `row` that a sloping line can reach.
    fn columns_near_line(
        &self,
        row: usize,
        [a, b]: [DVec2; 2],
        margin: f64,
        columns: std::ops::Range<usize>,
    ) -> std::ops::Range<usize> {
        let height = b.y - a.y;
        if height.abs() < 1.0 {
            return columns;
        }
        let x_at = |y: f64| a.x + (b.x - a.x) * ((y - a.y) / height).clamp(0.0, 1.0);
        let (above, below) = (x_at(row as f64 - margin), x_at(row as f64 + 1.0 + margin));
        let first = (above.min(below) - margin).max(0.0) as usize;
        let end = (above.max(below) + margin).ceil().max(0.0) as usize;
        first.max(columns.start)..end.min(columns.end)
    }

    /// Returns the colour `below`, covered by lines in `colour`.
    fn blend(&self, below: Colour, colour: Colour, column: usize, row: usize) -> Colour {
        let share = self.shares[row * self.width + column];
        below.mix(colour, f64::from(share) / 255.0)
    }
}
