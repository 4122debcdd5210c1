//! Drawing of a picture as lines and polygons in SVG.

use std::fmt::Write;

use glam::{DVec2, DVec3};

use crate::depth_order::back_to_front;
use crate::error::{MeshFault, RenderError};
use crate::labels::Label;
use crate::layout::{Panel, layout};
use crate::light::{BACKGROUND, shade};
use crate::limits::MAX_SVG_FACES;
use crate::picture::VisibleParts;
use crate::settings::{RenderMesh, Settings, Size};
use crate::strokes::Stroke;

/// Draws the meshes in a row, and returns the text of an SVG file. Time and memory are as for
/// [`draw`](crate::draw).
///
/// Visible faces are polygons, each in one colour, painted from back to front. The visible parts of
/// edges are lines. [`draw`](crate::draw) uses the same visibility test. If two faces intersect,
/// one of them wrongly appears in front of the other.
///
/// # Errors
///
/// Returns the errors of [`draw`](crate::draw), and [`MeshFault::TooManyFaces`].
pub fn draw_svg(
    render_meshes: &[RenderMesh<'_>],
    settings: &Settings,
) -> Result<String, RenderError> {
    let panels = layout(render_meshes, settings)?;
    let Size { width, height } = settings.size;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        BACKGROUND.to_hex()
    );
    for (mesh, (render_mesh, panel)) in render_meshes.iter().zip(&panels).enumerate() {
        let parts =
            VisibleParts::new(render_mesh, panel, settings).map_err(|error| error.of_mesh(mesh))?;
        svg += &format!(
            "<g transform=\"translate({})\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n",
            panel.left
        );
        draw_faces(render_mesh, panel, &parts, &mut svg)
            .map_err(|fault| RenderError::Mesh { mesh, fault })?;
        for layer in &parts.strokes.layers {
            for (strokes, width) in &layer.strokes {
                draw_lines(strokes, *width, &layer.colour.to_hex(), &mut svg);
            }
        }
        draw_labels(&parts.strokes.labels, panel.unit(), &mut svg);
        svg += "</g>\n";
    }
    svg += "</svg>\n";
    Ok(svg)
}

fn draw_faces(
    render_mesh: &RenderMesh<'_>,
    panel: &Panel,
    parts: &VisibleParts,
    svg: &mut String,
) -> Result<(), MeshFault> {
    let Some(samples) = &parts.samples else {
        return Ok(());
    };
    let mesh = render_mesh.mesh;
    let visible = samples.visible_faces(mesh.face_count());
    let faces = visible.iter().filter(|&&visible| visible).count();
    if faces > MAX_SVG_FACES {
        return Err(MeshFault::TooManyFaces { faces });
    }
    let mut shapes = vec![String::new(); mesh.face_count()];
    for (f, face) in mesh.faces().iter() {
        let corners = &parts.normals.corners[mesh.faces().range(f)];
        if !visible[f.index()] {
            continue;
        }
        let colour = shade(corners.iter().sum::<DVec3>(), parts.normals.seen(f)).to_hex();
        let points = face.iter().map(|&v| panel.position(v).truncate());
        let outline = path(points);
        shapes[f.index()] =
            format!("<path d=\"{outline}Z\" fill=\"{colour}\" stroke=\"{colour}\"/>\n");
    }
    // A thin line in the colour of the face closes the seam to the next face.
    *svg += "<g stroke-width=\"0.6\" fill-rule=\"evenodd\">\n";
    for face in back_to_front(mesh, panel, &visible) {
        *svg += &shapes[face.index()];
    }
    *svg += "</g>\n";
    Ok(())
}

/// Adds lines of one colour. Lines of equal opacity are one path, so that joints are invisible.
fn draw_lines(strokes: &[Stroke], width: f64, colour: &str, svg: &mut String) {
    let mut strokes = strokes.to_vec();
    // Each opacity is a separate path, so the opacities of a wireframe are rounded.
    let step = |stroke: &Stroke| (stroke.opacity * 50.0).round();
    strokes.sort_by(|a, b| step(a).total_cmp(&step(b)));
    for group in strokes.chunk_by(|a, b| step(a) == step(b)) {
        let lines: String = group.iter().map(|stroke| path(stroke.ends)).collect();
        let opacity = Number(step(&group[0]) / 50.0);
        let width = Number(width);
        *svg += &format!(
            "<path d=\"{lines}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-opacity=\"{opacity}\"/>\n"
        );
    }
}

/// Adds labels, with an outline in the colour of the background.
fn draw_labels(labels: &[Label], unit: f64, svg: &mut String) {
    if labels.is_empty() {
        return;
    }
    *svg += &format!(
        "<g font-family=\"sans-serif\" font-size=\"{}\" text-anchor=\"middle\" \
         dominant-baseline=\"central\" paint-order=\"stroke\" stroke=\"{}\" stroke-width=\"{}\">\n",
        Number(11.0 * unit),
        BACKGROUND.to_hex(),
        Number(2.5 * unit)
    );
    for label in labels {
        let (x, y, colour) = (
            Number(label.at.x),
            Number(label.at.y),
            label.colour().to_hex(),
        );
        let text = &label.text;
        *svg += &format!("<text x=\"{x}\" y=\"{y}\" fill=\"{colour}\">{text}</text>\n");
    }
    *svg += "</g>\n";
}

/// Returns a path. Example: `M1 2L3 4`. A path between equal points, such as `M1 2L1 2`, is a dot.
fn path(points: impl IntoIterator<Item = DVec2>) -> String {
    let mut text = String::new();
    for (i, point) in points.into_iter().enumerate() {
        let letter = if i == 0 { 'M' } else { 'L' };
        let (x, y) = (Number(point.x), Number(point.y));
        write!(text, "{letter}{x} {y}").expect("a String accepts all writes");
    }
    text
}

/// A number with at most two decimals and without trailing zeros.
struct Number(f64);

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // + 0.0 removes the sign of −0.
        write!(f, "{}", (self.0 * 100.0).round() / 100.0 + 0.0)
    }
}
