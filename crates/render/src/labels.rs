//! The names of vertices, edges and faces in a picture.

use glam::{DVec2, DVec3};
use sixfold_core::PolygonMesh;

use crate::edges::{Edges, Side};
use crate::error::MeshFault;
use crate::layout::Panel;
use crate::light::{BACKGROUND, Colour};
use crate::limits::MAX_LABELS;
use crate::strokes::VisibilityTest;

/// The name of an element, and the middle of the text in pixels of the panel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Label {
    pub(crate) text: String,
    pub(crate) at: DVec2,
}

impl Label {
    /// Returns the colour of the text, which depends on the kind of element.
    pub(crate) fn colour(&self) -> Colour {
        match self.text.as_bytes().first() {
            Some(b'v') => Colour(DVec3::new(0.0, 0.0, 0.0)),
            Some(b'e') => Colour(DVec3::new(0.0, 0.10, 0.45)),
            _ => Colour(DVec3::new(0.25, 0.05, 0.0)),
        }
    }
}

/// Checks that there are not too many labels.
pub(crate) fn check_labels(mesh: &PolygonMesh, edges: &Edges) -> Result<(), MeshFault> {
    let labels = mesh.vertex_count() + edges.iter().count() + mesh.face_count();
    match labels > MAX_LABELS {
        true => Err(MeshFault::TooManyLabels { labels }),
        false => Ok(()),
    }
}

/// Returns the labels of the visible elements: of vertices at their positions, of edges and faces at
/// their middles.
pub(crate) fn labels(
    mesh: &PolygonMesh,
    panel: &Panel,
    edges: &Edges,
    visibility: &VisibilityTest<'_>,
) -> Vec<Label> {
    let mut labels = Vec::new();
    let mut add = |text: String, at: DVec3, faces: &[u32]| {
        let is_own = |face| faces.contains(&face);
        if at.is_finite() && visibility.is_point_visible(at, is_own) {
            let at = at.truncate();
            labels.push(Label { text, at });
        }
    };
    for (f, face) in mesh.faces().iter() {
        let middle: DVec3 = face.iter().map(|&v| panel.position(v)).sum();
        let row = sixfold_core::row(f.index());
        add(format!("f{row}"), middle / face.len() as f64, &[row]);
    }
    for (number, sides) in numbered(edges).into_iter().enumerate() {
        let [a, b] = sides[0].edge.ends().map(|v| panel.position(v));
        let faces: Vec<u32> = sides.iter().map(|side| side.face).collect();
        add(format!("e{number}"), (a + b) / 2.0, &faces);
    }
    for v in mesh.vertices() {
        add(format!("v{}", v.index()), panel.position(v), &[]);
    }
    labels
}

/// Returns the edges in the order in which structures with rows for edges number them: by the lower end,
/// and then by the first side.
fn numbered(edges: &Edges) -> Vec<&[Side]> {
    let mut numbered: Vec<&[Side]> = edges.iter().collect();
    numbered.sort_by_key(|sides| {
        let first = sides.iter().map(|side| side.corners[0]).min();
        (sides[0].edge.ends()[0], first)
    });
    numbered
}

/// Width and height of a glyph, and the distance from one to the next.
const GLYPH: [usize; 2] = [5, 7];
const ADVANCE: usize = 6;

/// The pixels of the digits 0 to 9 and the letters v, e and f: one number per row, the highest of
/// five bits on the left.
const GLYPHS: [(u8, [u8; 7]); 13] = [
    (b'0', [0x0E, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0E]),
    (b'1', [0x04, 0x0C, 0x04, 0x04, 0x04, 0x04, 0x0E]),
    (b'2', [0x0E, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1F]),
    (b'3', [0x1F, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0E]),
    (b'4', [0x02, 0x06, 0x0A, 0x12, 0x1F, 0x02, 0x02]),
    (b'5', [0x1F, 0x10, 0x1E, 0x01, 0x01, 0x11, 0x0E]),
    (b'6', [0x06, 0x08, 0x10, 0x1E, 0x11, 0x11, 0x0E]),
    (b'7', [0x1F, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08]),
    (b'8', [0x0E, 0x11, 0x11, 0x0E, 0x11, 0x11, 0x0E]),
    (b'9', [0x0E, 0x11, 0x11, 0x0F, 0x01, 0x02, 0x0C]),
    (b'v', [0x00, 0x00, 0x11, 0x11, 0x11, 0x0A, 0x04]),
    (b'e', [0x00, 0x00, 0x0E, 0x11, 0x1F, 0x10, 0x0E]),
    (b'f', [0x06, 0x09, 0x08, 0x1C, 0x08, 0x08, 0x08]),
];

/// The pixels of the labels of a panel.
pub(crate) struct LabelPixels {
    width: usize,
    /// By pixel; empty if there are no labels.
    colours: Vec<Option<Colour>>,
}

impl LabelPixels {
    /// Draws the labels, each with an outline in the colour of the background.
    pub(crate) fn new(labels: &[Label], panel: &Panel) -> Self {
        let pixels = match labels {
            [] => 0,
            _ => panel.width * panel.height,
        };
        let mut drawn = Self {
            width: panel.width,
            colours: vec![None; pixels],
        };
        for label in labels {
            let neighbours = (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y]));
            for shift in neighbours {
                drawn.draw(label, panel, shift, BACKGROUND);
            }
            drawn.draw(label, panel, [0, 0], label.colour());
        }
        drawn
    }

    /// Draws the pixels of a text, moved by `shift`.
    fn draw(&mut self, label: &Label, panel: &Panel, shift: [i64; 2], colour: Colour) {
        let scale = (panel.unit().round() as usize).max(1);
        let size = [label.text.len() * ADVANCE - 1, GLYPH[1]].map(|side| (side * scale) as f64);
        let corner = label.at - DVec2::from_array(size) / 2.0;
        let [left, top] = corner.to_array().map(|at| at.round() as i64);
        for (i, letter) in label.text.bytes().enumerate() {
            let rows = GLYPHS.iter().find(|(other, _)| *other == letter);
            let rows = rows.map_or([0; 7], |(_, rows)| *rows);
            for y in 0..GLYPH[1] * scale {
                for x in 0..GLYPH[0] * scale {
                    let is_set = rows[y / scale] >> (GLYPH[0] - 1 - x / scale) & 1 == 1;
                    let column = left + (i * ADVANCE * scale + x) as i64 + shift[0];
                    let row = top + y as i64 + shift[1];
                    let inside = (0..panel.width as i64).contains(&column)
                        && (0..panel.height as i64).contains(&row);
                    if is_set && inside {
                        self.colours[row as usize * self.width + column as usize] = Some(colour);
                    }
                }
            }
        }
    }

    /// Returns the colour of a pixel, if a label covers it.
    pub(crate) fn colour(&self, column: usize, row: usize) -> Option<Colour> {
        self.colours
            .get(row * self.width + column)
            .copied()
            .flatten()
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::TwinPairs;
    use sixfold_shapes as shapes;

    use super::*;

    #[test]
    fn edges_have_the_numbers_of_structures_with_rows_for_edges() {
        let grid = shapes::mixed_grid(4, 3).expect("a small size");
        for mesh in [shapes::cube(), shapes::icosahedron(), grid] {
            let edges = Edges::new(&mesh);
            let pairs = TwinPairs::new(mesh.vertex_count(), mesh.faces()).expect("a manifold");
            let numbered = numbered(&edges);
            assert_eq!(numbered.len(), pairs.edge_count);
            for (number, sides) in numbered.into_iter().enumerate() {
                for side in sides {
                    let half = pairs.half_of_corner[side.corners[0] as usize];
                    assert_eq!(half as usize / 2, number);
                }
            }
        }
    }
}
