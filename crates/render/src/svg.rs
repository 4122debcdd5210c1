//! Drawing of lines and polygons as SVG.

use std::fmt::Write;

use glam::{DVec2, DVec3};

use crate::error::{MeshFault, RenderError};
use crate::layout::{Panel, layout};
use crate::light::{BACKGROUND, CREASE, EDGE, lit};
use crate::order::back_to_front;
use crate::picture::Drawn;
use crate::settings::{Settings, Size, Subject};
use crate::strokes::Stroke;

/// Maximum number of visible faces per mesh: viewers fail with more, and a PNG is smaller.
pub const MAX_SVG_FACES: usize = 50_000;

/// Draws the subjects in a row, as the text of an SVG file; same cost as [`draw`](crate::draw).
///
/// Visible faces are polygons, each in one colour, painted from back to front. Lines are the
/// visible parts of edges, hidden as in [`draw`](crate::draw). Faces that intersect each other
/// cannot be painted correctly: one of them appears in front of the other.
///
/// # Errors
///
/// Returns the errors of [`draw`](crate::draw), and [`MeshFault::TooManyFaces`].
pub fn draw_svg(subjects: &[Subject<'_>], settings: &Settings) -> Result<String, RenderError> {
    let panels = layout(subjects, settings)?;
    let Size { width, height } = settings.size;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        BACKGROUND.web()
    );
    for (mesh, (subject, panel)) in subjects.iter().zip(&panels).enumerate() {
        let drawn = Drawn::of(subject, panel, settings)?;
        svg += &format!(
            "<g transform=\"translate({})\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n",
            panel.left
        );
        paint(subject, panel, &drawn, &mut svg)
            .map_err(|fault| RenderError::Mesh { mesh, fault })?;
        let strokes = &drawn.strokes;
        for (strokes, width, colour) in [
            (&strokes.edges, strokes.edge_width, EDGE),
            (&strokes.creases, strokes.crease_width, CREASE),
            (&strokes.corners, strokes.corner_width, CREASE),
        ] {
            draw_lines(strokes, width, &colour.web(), &mut svg);
        }
        svg += "</g>\n";
    }
    svg += "</svg>\n";
    Ok(svg)
}

/// Adds the visible faces.
fn paint(
    subject: &Subject<'_>,
    panel: &Panel,
    drawn: &Drawn,
    svg: &mut String,
) -> Result<(), MeshFault> {
    let Some(samples) = &drawn.samples else {
        return Ok(());
    };
    let mesh = subject.mesh;
    let visible = samples.visible(mesh.face_count());
    let faces = visible.iter().filter(|&&visible| visible).count();
    if faces > MAX_SVG_FACES {
        return Err(MeshFault::TooManyFaces { faces });
    }
    let mut shapes = vec![String::new(); mesh.face_count()];
    for (f, face) in mesh.faces().iter() {
        let corners = &drawn.normals.corners[mesh.faces().range(f)];
        if !visible[f.index()] {
            continue;
        }
        let inside = drawn.normals.faces[f.index()].z < 0.0;
        let colour = lit(corners.iter().sum::<DVec3>(), inside).web();
        let places = face.iter().map(|&v| panel.place(v).truncate());
        let outline = path(places);
        shapes[f.index()] =
            format!("<path d=\"{outline}Z\" fill=\"{colour}\" stroke=\"{colour}\"/>\n");
    }
    // A thin line of the same colour closes the seam to the next face.
    *svg += "<g stroke-width=\"0.6\" fill-rule=\"evenodd\">\n";
    for face in back_to_front(mesh, panel, &visible) {
        *svg += &shapes[face.index()];
    }
    *svg += "</g>\n";
    Ok(())
}

/// Adds lines of one colour. Lines of the same share are one path, so that joints are invisible.
fn draw_lines(strokes: &[Stroke], width: f64, colour: &str, svg: &mut String) {
    let mut strokes = strokes.to_vec();
    // Rounds the shares of a wireframe, because each share is a separate path.
    let step = |stroke: &Stroke| (stroke.share * 50.0).round();
    strokes.sort_by(|a, b| step(a).total_cmp(&step(b)));
    for same in strokes.chunk_by(|a, b| step(a) == step(b)) {
        let lines: String = same.iter().map(|stroke| path(stroke.ends)).collect();
        let share = Number(step(&same[0]) / 50.0);
        let width = Number(width);
        *svg += &format!(
            "<path d=\"{lines}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-opacity=\"{share}\"/>\n"
        );
    }
}

/// Returns `M1 2L3 4`, or `M1 2L1 2` for equal points, which round line ends make a dot.
fn path(places: impl IntoIterator<Item = DVec2>) -> String {
    let mut text = String::new();
    for (i, place) in places.into_iter().enumerate() {
        let letter = if i == 0 { 'M' } else { 'L' };
        let (x, y) = (Number(place.x), Number(place.y));
        write!(text, "{letter}{x} {y}").expect("a String accepts all writes");
    }
    text
}

/// A number with at most two decimals, and without trailing zeros.
struct Number(f64);

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // + 0.0 removes the sign of −0.
        write!(f, "{}", (self.0 * 100.0).round() / 100.0 + 0.0)
    }
}
