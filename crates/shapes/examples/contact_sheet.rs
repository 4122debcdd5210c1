//! Draws every shape of [`sixfold_shapes::GENERATORS`], and the orders of one mesh, into one SVG
//! file.
//!
//! The projection is orthographic. Far faces are drawn first (painter's algorithm; Newell, Newell
//! and Sancha 1972). The picture is the same on every machine, because coordinates are rounded to a
//! tenth of a pixel and computed with + − × ÷ √ only.

use std::error::Error;
use std::fmt::Write as _;
use std::io::Write as _;

use sixfold_core::glam::DVec3;
use sixfold_core::{Facts, PolygonMesh, VertexId};
use sixfold_shapes::{GENERATORS, Generator, Order};

/// First line of the picture. An XML comment cannot contain two hyphens in a row, so this line is a
/// processing instruction.
const COMMAND: &str = "<?made-by cargo run --release -p sixfold-shapes --example contact_sheet > reports/shapes/contact-sheet.svg?>";

/// Parameters for shapes whose defaults are too dense for a cell or hide details.
const PARAMETERS: &[(&str, &[(&str, f64)])] = &[
    ("grid", &[("m", 8.0), ("n", 8.0)]),
    ("triangle-grid", &[("m", 8.0), ("n", 8.0)]),
    ("mixed-grid", &[("m", 8.0), ("n", 8.0)]),
    ("grid-with-hole", &[("m", 9.0), ("n", 9.0)]),
    ("grid-with-holes", &[("m", 13.0), ("n", 13.0)]),
    ("triangle-tiling", &[("m", 8.0), ("n", 8.0)]),
    ("hexagon-tiling", &[("m", 8.0), ("n", 8.0)]),
    ("torus", &[("m", 32.0), ("n", 14.0)]),
    ("triangle-torus", &[("m", 32.0), ("n", 14.0)]),
    ("uv-sphere", &[("m", 24.0), ("n", 12.0)]),
    ("bezier-patch", &[("m", 14.0), ("n", 14.0)]),
    ("b-spline-patch", &[("m", 18.0), ("n", 18.0)]),
    ("blobs", &[("faces", 1_500.0)]),
    ("csg", &[("faces", 1_500.0)]),
    ("smooth-union", &[("faces", 1_500.0)]),
];

/// Maximum number of faces of a mesh with drawn edges.
const MAX_FACES_WITH_EDGES: usize = 2_000;

const COLUMNS: usize = 6;
const CELL: [f64; 2] = [190.0, 226.0];
/// Side and centre of the square in a cell that contains the mesh.
const PICTURE: f64 = 158.0;
const CENTRE: [f64; 2] = [95.0, 94.0];
const GAP: f64 = 10.0;

/// Number of tones of each colour ramp.
const TONES: usize = 24;

fn main() -> Result<(), Box<dyn Error>> {
    if let Some((name, _)) = PARAMETERS
        .iter()
        .find(|(name, _)| sixfold_shapes::generator(name).is_none())
    {
        return Err(format!("unknown shape {name:?}").into());
    }
    let mut cells = Vec::new();
    for generator in GENERATORS {
        let given = PARAMETERS.iter().find(|(name, _)| *name == generator.name);
        let given = given.map_or(&[][..], |(_, parameters)| parameters);
        let mesh = generator.build(given)?;
        cells.push(cell(
            generator.name,
            &settings(generator, given, mesh.face_count()),
            &mesh,
            Colouring::Light,
        ));
    }
    let ordered = sixfold_shapes::triangle_torus(32, 14)?;
    for order in Order::ALL {
        let mesh = order.apply(&ordered, 1);
        cells.push(cell(
            "triangle-torus",
            &format!("order: {order}"),
            &mesh,
            Colouring::Order,
        ));
    }
    std::io::stdout().write_all(sheet(&cells)?.as_bytes())?;
    Ok(())
}

/// Returns the drawn parameters of a shape, or the summary if the shape has no parameters.
fn settings(generator: &Generator, given: &[(&str, f64)], faces: usize) -> String {
    if faces > MAX_FACES_WITH_EDGES {
        return "edges not drawn".to_owned();
    }
    if generator.parameters.is_empty() {
        return generator.summary.to_owned();
    }
    let shown = generator.parameters.iter().map(|parameter| {
        let given = given.iter().find(|(name, _)| *name == parameter.name);
        let value = given.map_or(parameter.default, |(_, value)| *value);
        format!("{} {value}", parameter.name)
    });
    shown.collect::<Vec<_>>().join(" · ")
}

/// Builds the SVG. The background follows the colour theme of the reader.
fn sheet(cells: &[String]) -> Result<String, std::fmt::Error> {
    let rows = cells.len().div_ceil(COLUMNS);
    let width = COLUMNS as f64 * (CELL[0] + GAP) + GAP;
    let height = rows as f64 * (CELL[1] + GAP) + GAP + 24.0;
    let mut svg = String::new();
    writeln!(svg, "{COMMAND}")?;
    writeln!(
        svg,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" aria-label="All shapes of Sixfold">"#
    )?;
    svg.push_str(&style()?);
    writeln!(svg, r#"<rect class="ground" width="100%" height="100%"/>"#)?;
    for (i, cell) in cells.iter().enumerate() {
        let x = GAP + (i % COLUMNS) as f64 * (CELL[0] + GAP);
        let y = GAP + (i / COLUMNS) as f64 * (CELL[1] + GAP);
        writeln!(svg, r#"<g transform="translate({x} {y})">"#)?;
        svg.push_str(cell);
        svg.push_str("</g>\n");
    }
    writeln!(
        svg,
        r#"<text class="note" x="{}" y="{}">blue: the front of a face · ochre: its back · the last four: faces coloured by their row in the list, from pale to dark</text>"#,
        GAP + 2.0,
        height - 14.0
    )?;
    svg.push_str("</svg>\n");
    Ok(svg)
}

#[derive(Clone, Copy, PartialEq)]
enum Colouring {
    /// By brightness, from one light.
    Light,
    /// By their row in the face list.
    Order,
}

/// The colour ramps: letter, darkest colour and lightest colour.
const RAMPS: [(char, [f64; 3], [f64; 3]); 3] = [
    ('a', [44.0, 66.0, 92.0], [190.0, 212.0, 232.0]),
    ('b', [112.0, 72.0, 34.0], [238.0, 208.0, 160.0]),
    ('c', [62.0, 26.0, 84.0], [246.0, 226.0, 170.0]),
];

/// Returns the style sheet for the tones, the background and the text.
fn style() -> Result<String, std::fmt::Error> {
    let mut css = String::from(
        "<style>
.ground{fill:#eceae5}.card{fill:#fbfaf8}.name{fill:#1f2429;font-weight:600;font-size:13px}.note{fill:#5d666f;font-size:10.5px}
@media(prefers-color-scheme:dark){.ground{fill:#15181b}.card{fill:#22272c}.name{fill:#eceff1}.note{fill:#a3adb6}}
text{font-family:system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif}
path{stroke-linejoin:round}.fine{stroke-width:3}.bold{stroke-width:6}
",
    );
    for (letter, dark, light) in RAMPS {
        for tone in 0..TONES {
            let t = tone as f64 / (TONES - 1) as f64;
            let fill = std::array::from_fn(|i| dark[i] + t * (light[i] - dark[i]));
            let line = fill.map(|channel: f64| 0.62 * channel);
            // This stroke only closes the hairlines between faces.
            writeln!(
                css,
                ".{letter}{tone}{{fill:{fill};stroke:{line}}}.plain .{letter}{tone}{{stroke:{fill}}}",
                fill = hex(fill),
                line = hex(line)
            )?;
        }
    }
    css.push_str("</style>\n");
    Ok(css)
}

fn hex(colour: [f64; 3]) -> String {
    let [r, g, b] = colour.map(|channel| channel.round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The view: the directions right, up, and towards the viewer.
struct View([DVec3; 3]);

impl View {
    /// Flat meshes are seen from above, other meshes from a corner and above.
    fn new(mesh: &PolygonMesh) -> Self {
        let mut heights = mesh.positions().iter().map(|p| p.z);
        let flat = heights
            .next()
            .is_none_or(|first| heights.all(|z| z == first));
        if flat {
            return Self(DVec3::AXES);
        }
        // Pythagorean triples give rational cosines and sines: an azimuth of about 62° and an
        // elevation of about 37°.
        let [ca, sa] = [8.0 / 17.0, 15.0 / 17.0];
        let [ce, se] = [4.0 / 5.0, 3.0 / 5.0];
        let towards = DVec3::new(ce * ca, ce * sa, se);
        let right = DVec3::new(-sa, ca, 0.0);
        Self([right, towards.cross(right), towards])
    }

    fn project(&self, p: DVec3) -> DVec3 {
        DVec3::from(self.0.map(|axis| axis.dot(p)))
    }
}

struct ProjectedFace {
    corners: Vec<[i64; 2]>,
    depth: f64,
    ramp: char,
    tone: usize,
}

fn cell(name: &str, settings: &str, mesh: &PolygonMesh, colouring: Colouring) -> String {
    let facts = Facts::from_polygons(mesh);
    let weight = match mesh.face_count() {
        0..=100 => "bold",
        101..=MAX_FACES_WITH_EDGES => "fine",
        _ => "fine plain",
    };
    let mut svg = format!(
        "<rect class=\"card\" width=\"{}\" height=\"{}\" rx=\"6\"/>\n<g class=\"{weight}\" transform=\"translate({} {}) scale(.1)\">\n",
        CELL[0], CELL[1], CENTRE[0], CENTRE[1]
    );
    for face in project_faces(mesh, facts.closed, colouring) {
        svg.push_str(&path(&face));
        svg.push('\n');
    }
    let counts = format!(
        "V {} · E {} · F {}",
        facts.vertices, facts.edges, facts.faces
    );
    svg.push_str("</g>\n");
    for (class, y, text) in [
        ("name", 188.0, name),
        ("note", 203.0, settings),
        ("note", 217.0, &counts),
    ] {
        svg.push_str(&format!(
            "<text class=\"{class}\" x=\"12\" y=\"{y}\">{text}</text>\n"
        ));
    }
    svg
}

/// Projects the faces and sorts them from far to near. Leaves out the faces of a closed mesh that
/// face away.
fn project_faces(mesh: &PolygonMesh, closed: bool, colouring: Colouring) -> Vec<ProjectedFace> {
    let view = View::new(mesh);
    let points = mesh.positions().iter().map(|p| view.project(p.as_dvec3()));
    let points: Vec<DVec3> = points.collect();
    let (middle, scale) = fit(&points);
    let light = unit(DVec3::new(-0.45, 0.6, 0.75));
    let mut faces = Vec::new();
    for (f, face) in mesh.faces().iter() {
        let corner = |v: &VertexId| points[v.index()];
        let normal = unit(area(face.iter().map(corner)));
        let front = normal.z >= 0.0;
        if closed && normal.z <= 0.0 {
            continue;
        }
        let towards_viewer = if front { normal } else { -normal };
        let (ramp, brightness) = match colouring {
            Colouring::Light => {
                let lit = towards_viewer.dot(light).max(0.0);
                (if front { 'a' } else { 'b' }, 0.15 + 0.85 * lit)
            }
            Colouring::Order => ('c', 1.0 - f.index() as f64 / mesh.face_count() as f64),
        };
        let depth: f64 = face.iter().map(|v| corner(v).z).sum();
        faces.push(ProjectedFace {
            corners: face
                .iter()
                .map(|v| {
                    let [x, y, _] = corner(v).to_array();
                    let tenths = |x: f64| (10.0 * scale * x).round() as i64;
                    [tenths(x - middle[0]), tenths(middle[1] - y)]
                })
                .collect(),
            depth: depth / face.len() as f64,
            ramp,
            tone: ((TONES - 1) as f64 * brightness.clamp(0.0, 1.0)).round() as usize,
        });
    }
    faces.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    faces
}

/// Returns the centre of the points, and the scale that fills the picture.
fn fit(points: &[DVec3]) -> ([f64; 2], f64) {
    let side = |i: usize| {
        let low = points.iter().map(|p| p[i]).fold(f64::INFINITY, f64::min);
        let high = points
            .iter()
            .map(|p| p[i])
            .fold(f64::NEG_INFINITY, f64::max);
        (low.midpoint(high), high - low)
    };
    let [(x, width), (y, high)] = [side(0), side(1)];
    ([x, y], PICTURE / width.max(high))
}

/// Returns the vector in the direction of `a` with the length 1, or 0 for the vector 0.
fn unit(a: DVec3) -> DVec3 {
    match a.length() {
        length if length > 0.0 => a / length,
        _ => a,
    }
}

/// Returns the Newell vector of a polygon, whose length is twice the area.
fn area(mut corners: impl Iterator<Item = DVec3>) -> DVec3 {
    let first = corners.next().unwrap_or_default();
    let spokes: Vec<DVec3> = corners.map(|p| p - first).collect();
    let triangles = spokes.windows(2).map(|pair| pair[0].cross(pair[1]));
    triangles.sum()
}

/// Formats a face as a path in tenths of a pixel, with relative coordinates.
fn path(face: &ProjectedFace) -> String {
    let mut path = format!("<path class=\"{}{}\" d=\"M", face.ramp, face.tone);
    let mut last = [0, 0];
    for (i, corner) in face.corners.iter().enumerate() {
        let step = [corner[0] - last[0], corner[1] - last[1]];
        let before = match i {
            0 => "",
            1 => "l",
            _ if step[0] >= 0 => " ",
            _ => "",
        };
        let between = if step[1] >= 0 { " " } else { "" };
        path.push_str(&format!("{before}{}{between}{}", step[0], step[1]));
        last = *corner;
    }
    path.push_str("z\"/>");
    path
}
