//! The lines of a picture: the visible parts of edges, and sharp corners.

use std::ops::Range;

use glam::{DVec2, DVec3};
use sixfold_core::{Pair, VertexId};

use crate::edges::{Edges, Side};
use crate::labels::{Label, labels};
use crate::layout::Panel;
use crate::light::{BOUNDARY, CREASE, Colour, EDGE, NON_MANIFOLD};
use crate::samples::Samples;
use crate::settings::{Faults, RenderMesh, Settings};

/// Width of an edge, in units of the panel.
const EDGE_WIDTH: f64 = 1.1;
/// Width of a sharp edge, in units of the panel.
const CREASE_WIDTH: f64 = 3.0;
/// Width of a sharp corner, in units of the panel.
const CORNER_WIDTH: f64 = 8.0;
/// Maximum opacity of an edge.
const EDGE_OPACITY: f64 = 0.62;
/// Mean length of edges, in units of the panel, below which edges are paler.
const FULL_OPACITY_LENGTH: f64 = 14.0;

/// A straight line with round ends, in pixels of a panel. If both ends are equal, the line is a
/// dot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) ends: [DVec2; 2],
    pub(crate) opacity: f64,
}

/// Lines of one colour, and their width.
pub(crate) struct Layer {
    pub(crate) colour: Colour,
    /// Lines, and dots.
    pub(crate) strokes: [(Vec<Stroke>, f64); 2],
}

impl Layer {
    fn new(colour: Colour, widths: [f64; 2]) -> Self {
        let strokes = widths.map(|width| (Vec::new(), width));
        Self { colour, strokes }
    }
}

/// The lines of one panel.
pub(crate) struct Strokes {
    /// Layers from the lowest to the highest: edges, creases, boundary edges and non-manifold
    /// elements.
    pub(crate) layers: [Layer; 4],
    pub(crate) labels: Vec<Label>,
}

/// The numbers of the layers.
const EDGES: usize = 0;
const CREASES: usize = 1;
const BOUNDARIES: usize = 2;
const NON_MANIFOLD_ELEMENTS: usize = 3;

impl Strokes {
    /// Collects the visible parts of edges and corners. Without `samples`, all parts are visible.
    /// O(corners + pixels along edges).
    pub(crate) fn new(
        render_mesh: &RenderMesh<'_>,
        panel: &Panel,
        edges: &Edges,
        samples: Option<&Samples>,
        settings: &Settings,
    ) -> Self {
        let unit = panel.unit();
        let widths = [CREASE_WIDTH * unit, CORNER_WIDTH * unit];
        let mut strokes = Self {
            layers: [
                Layer::new(EDGE, [EDGE_WIDTH * unit, 0.0]),
                Layer::new(CREASE, widths),
                Layer::new(BOUNDARY, widths),
                Layer::new(NON_MANIFOLD, widths),
            ],
            labels: Vec::new(),
        };
        let visibility = VisibilityTest::new(panel, samples, render_mesh);
        let painted = PaintedEdges::new(render_mesh.faults);
        let (mut length, mut count) = (0.0, 0.0);
        for sides in edges.iter() {
            let edge = sides[0].edge;
            let [a, b] = edge.ends();
            let layer = match painted.layer(edge) {
                Some(layer) => layer,
                None if render_mesh.creases.edge(a, b) > 0.0 => CREASES,
                None if settings.edges || settings.wireframe => EDGES,
                None => continue,
            };
            let ends = [a, b].map(|v| panel.position(v));
            length += ends[0].truncate().distance(ends[1].truncate());
            count += 1.0;
            let into = &mut strokes.layers[layer].strokes[0].0;
            visibility.add_visible_parts(ends, sides, into);
        }
        let opacity = EDGE_OPACITY
            * (length / f64::max(count, 1.0) / (FULL_OPACITY_LENGTH * unit)).clamp(0.3, 1.0);
        for stroke in &mut strokes.layers[EDGES].strokes[0].0 {
            stroke.opacity *= opacity;
        }
        let corners = render_mesh.creases.corners().iter();
        let corners = corners.map(|&(v, _)| (v, CREASES));
        let several = render_mesh
            .faults
            .map_or(&[][..], |faults| &faults.non_manifold_vertices);
        let several = several.iter().map(|&v| (v, NON_MANIFOLD_ELEMENTS));
        for (v, layer) in corners.chain(several) {
            // A vertex without faces can have infinite coordinates.
            let position = panel
                .positions
                .get(v.index())
                .copied()
                .unwrap_or(DVec3::NAN);
            if position.is_finite() && visibility.is_corner_visible(position) {
                strokes.layers[layer].strokes[1].0.push(Stroke {
                    ends: [position.truncate(); 2],
                    opacity: visibility.opacity(position.z),
                });
            }
        }
        if settings.labels {
            strokes.labels = labels(render_mesh.mesh, panel, edges, &visibility);
        }
        strokes
    }
}

/// The edges that are painted as faults, each with its layer.
struct PaintedEdges(Vec<(Pair<VertexId>, usize)>);

impl PaintedEdges {
    fn new(faults: Option<&Faults>) -> Self {
        let Some(faults) = faults else {
            return Self(Vec::new());
        };
        let layer = |edges: &[[VertexId; 2]], layer| {
            let pairs = edges.iter().map(move |&[a, b]| (Pair::new(a, b), layer));
            pairs.collect::<Vec<_>>()
        };
        let mut painted = layer(&faults.boundary_edges, BOUNDARIES);
        painted.extend(layer(&faults.non_manifold_edges, NON_MANIFOLD_ELEMENTS));
        painted.sort_unstable();
        Self(painted)
    }

    fn layer(&self, edge: Pair<VertexId>) -> Option<usize> {
        let found = self.0.binary_search_by_key(&edge, |&(edge, _)| edge);
        found.ok().map(|at| self.0[at].1)
    }
}

/// A test whether elements are hidden by surfaces.
pub(crate) struct VisibilityTest<'a> {
    samples: Option<&'a Samples>,
    /// The depths of the farthest and the nearest vertex.
    depths: Range<f64>,
}

impl<'a> VisibilityTest<'a> {
    fn new(panel: &Panel, samples: Option<&'a Samples>, render_mesh: &RenderMesh<'_>) -> Self {
        let corners = render_mesh.mesh.faces().corners().iter();
        let depths = corners.map(|&v| panel.position(v).z);
        let depths = depths.fold(f64::INFINITY..f64::NEG_INFINITY, |range, z| {
            range.start.min(z)..range.end.max(z)
        });
        Self { samples, depths }
    }

    /// Adds the visible parts of the edge between `ends`. `sides` are the sides of this edge.
    ///
    /// The test takes points along the line, in steps of at most half a pixel. A point is visible
    /// if one of the samples around the point has no surface, a surface behind the point, or a face
    /// at this edge.
    fn add_visible_parts(&self, ends: [DVec3; 2], sides: &[Side], into: &mut Vec<Stroke>) {
        let at = |t: f64| ends[0].lerp(ends[1], t);
        let mut add = |from: f64, to: f64| {
            let stroke = [from, to].map(|t| at(t).truncate());
            into.push(Stroke {
                ends: stroke,
                opacity: self.opacity(at((from + to) / 2.0).z),
            });
        };
        let Some(samples) = self.samples else {
            return add(0.0, 1.0);
        };
        /// Maximum length, in pixels, of a visible or hidden part that is ignored.
        const MIN_LENGTH: f64 = 1.0;
        let pixels = ends[0].truncate().distance(ends[1].truncate());
        let steps = (pixels * samples.per_side as f64).ceil().max(1.0);
        let is_own = |face| sides.iter().any(|side| side.face == face);
        let is_step_visible =
            |step: usize| is_visible(samples, at((step as f64 + 0.5) / steps), is_own);
        let mut runs: Vec<Range<usize>> = Vec::new();
        for step in (0..steps as usize).filter(|&step| is_step_visible(step)) {
            match runs.last_mut() {
                Some(run) if (step - run.end) as f64 * pixels / steps <= MIN_LENGTH => {
                    run.end = step + 1;
                }
                _ => runs.push(step..step + 1),
            }
        }
        for run in runs {
            let is_whole = run.len() as f64 >= steps;
            if is_whole || run.len() as f64 * pixels / steps > MIN_LENGTH {
                add(run.start as f64 / steps, run.end as f64 / steps);
            }
        }
    }

    fn is_corner_visible(&self, position: DVec3) -> bool {
        self.is_point_visible(position, |_| false)
    }

    /// Returns whether `position` is visible. Faces with `is_own` do not hide it.
    pub(crate) fn is_point_visible(&self, position: DVec3, is_own: impl Fn(u32) -> bool) -> bool {
        let samples = self.samples;
        samples.is_none_or(|samples| is_visible(samples, position, is_own))
    }

    /// Returns the opacity of a stroke. In a wireframe, distant strokes have a lower opacity.
    fn opacity(&self, depth: f64) -> f64 {
        let Range { start, end } = self.depths;
        if self.samples.is_some() || start >= end {
            return 1.0;
        }
        0.3 + 0.7 * (depth - start) / (end - start)
    }
}

/// Returns whether `position`, in pixels, is visible. Faces with `is_own` do not hide the position.
fn is_visible(samples: &Samples, position: DVec3, is_own: impl Fn(u32) -> bool) -> bool {
    /// Minimum distance, in pixels, at which a nearer face hides an edge. The slope of a face can
    /// cause smaller distances.
    const DEPTH_TOLERANCE: f64 = 1.0;
    let scale = samples.per_side as f64;
    let hiding_depth = ((position.z + DEPTH_TOLERANCE) * scale) as f32;
    samples.any_around(position * scale, |depth, face| {
        depth <= hiding_depth || is_own(face)
    })
}
