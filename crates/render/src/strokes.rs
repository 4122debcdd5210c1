//! The lines of a picture: the visible parts of edges, and sharp corners.

use std::ops::Range;

use glam::{DVec2, DVec3};

use crate::edges::{Edges, Side};
use crate::layout::Panel;
use crate::samples::Samples;
use crate::settings::{Settings, Subject};

/// Width of an edge, in units of the panel.
const EDGE_WIDTH: f64 = 1.1;
/// Width of a sharp edge, in units of the panel.
const CREASE_WIDTH: f64 = 3.0;
/// Width of a sharp corner, in units of the panel.
const CORNER_WIDTH: f64 = 8.0;
/// Maximum share of the colour of an edge.
const EDGE_SHARE: f64 = 0.62;
/// Below this mean length, in units of the panel, edges are drawn paler, to keep faces visible.
const LONG: f64 = 14.0;

/// A straight line with round ends, in pixels of a panel; a dot if both ends are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) ends: [DVec2; 2],
    /// The share of its colour: lower for distant strokes in a wireframe.
    pub(crate) share: f64,
}

/// The lines of one panel.
pub(crate) struct Strokes {
    pub(crate) edges: Vec<Stroke>,
    pub(crate) edge_width: f64,
    pub(crate) creases: Vec<Stroke>,
    pub(crate) crease_width: f64,
    pub(crate) corners: Vec<Stroke>,
    pub(crate) corner_width: f64,
}

impl Strokes {
    /// Collects the visible parts of edges and corners; all of them without `samples`, as in a
    /// wireframe. O(corners + pixels along edges).
    pub(crate) fn of(
        subject: &Subject<'_>,
        panel: &Panel,
        edges: &Edges,
        samples: Option<&Samples>,
        settings: &Settings,
    ) -> Self {
        let unit = panel.unit();
        let mut strokes = Self {
            edges: Vec::new(),
            edge_width: EDGE_WIDTH * unit,
            creases: Vec::new(),
            crease_width: CREASE_WIDTH * unit,
            corners: Vec::new(),
            corner_width: CORNER_WIDTH * unit,
        };
        let eye = Eye::of(panel, samples, subject);
        let (mut length, mut count) = (0.0, 0.0);
        for sides in edges.iter() {
            let [a, b] = sides[0].edge.ends();
            let sharp = subject.creases.edge(a, b) > 0.0;
            if !(sharp || settings.edges || settings.wireframe) {
                continue;
            }
            let ends = [a, b].map(|v| panel.place(v));
            length += ends[0].truncate().distance(ends[1].truncate());
            count += 1.0;
            let into = if sharp {
                &mut strokes.creases
            } else {
                &mut strokes.edges
            };
            eye.see(ends, sides, into);
        }
        let dark = EDGE_SHARE * (length / f64::max(count, 1.0) / (LONG * unit)).clamp(0.3, 1.0);
        for stroke in &mut strokes.edges {
            stroke.share *= dark;
        }
        for &(v, _) in subject.creases.corners() {
            // It may be a corner of no face, and then have any coordinates.
            let place = panel.place(v);
            if place.is_finite() && eye.sees_corner(place) {
                strokes.corners.push(Stroke {
                    ends: [place.truncate(); 2],
                    share: eye.share(place.z),
                });
            }
        }
        strokes
    }
}

/// The visibility test for edges.
struct Eye<'a> {
    samples: Option<&'a Samples>,
    /// The depths of the farthest and the nearest vertex.
    depths: Range<f64>,
}

impl<'a> Eye<'a> {
    fn of(panel: &Panel, samples: Option<&'a Samples>, subject: &Subject<'_>) -> Self {
        let corners = subject.mesh.faces().corners().iter();
        let depths = corners.map(|&v| panel.place(v).z);
        let depths = depths.fold(f64::INFINITY..f64::NEG_INFINITY, |range, z| {
            range.start.min(z)..range.end.max(z)
        });
        Self { samples, depths }
    }

    /// Adds the visible parts of the line between `ends`, an edge with these sides.
    ///
    /// The line is tested along its middle, in steps of at most half a pixel. A point is visible if
    /// one of the samples around it has no surface, a surface behind it, or a face at this edge.
    fn see(&self, ends: [DVec3; 2], sides: &[Side], into: &mut Vec<Stroke>) {
        let at = |t: f64| ends[0].lerp(ends[1], t);
        let mut add = |from: f64, to: f64| {
            let stroke = [from, to].map(|t| at(t).truncate());
            into.push(Stroke {
                ends: stroke,
                share: self.share(at((from + to) / 2.0).z),
            });
        };
        let Some(samples) = self.samples else {
            return add(0.0, 1.0);
        };
        /// Maximum length in pixels of visible or hidden parts that are ignored as sampling errors.
        const LEAST: f64 = 1.0;
        let pixels = ends[0].truncate().distance(ends[1].truncate());
        let steps = (pixels * samples.fine as f64).ceil().max(1.0);
        let own = |face| sides.iter().any(|side| side.face == face);
        let seen = |step: usize| nearest(samples, at((step as f64 + 0.5) / steps), own);
        let mut runs: Vec<Range<usize>> = Vec::new();
        for step in (0..steps as usize).filter(|&step| seen(step)) {
            match runs.last_mut() {
                Some(run) if (step - run.end) as f64 * pixels / steps <= LEAST => {
                    run.end = step + 1;
                }
                _ => runs.push(step..step + 1),
            }
        }
        for run in runs {
            let whole = run.len() as f64 >= steps;
            if whole || run.len() as f64 * pixels / steps > LEAST {
                add(run.start as f64 / steps, run.end as f64 / steps);
            }
        }
    }

    fn sees_corner(&self, place: DVec3) -> bool {
        let samples = self.samples;
        samples.is_none_or(|samples| nearest(samples, place, |_| false))
    }

    /// Returns the share of a stroke: lower for distant strokes in a wireframe.
    fn share(&self, depth: f64) -> f64 {
        let Range { start, end } = self.depths;
        if self.samples.is_some() || start >= end {
            return 1.0;
        }
        0.3 + 0.7 * (depth - start) / (end - start)
    }
}

/// Returns whether no face except its `own` faces hides `place`, which is in pixels.
fn nearest(samples: &Samples, place: DVec3, own: impl Fn(u32) -> bool) -> bool {
    /// Minimum distance, in pixels, by which a face must be nearer to hide an edge. A smaller
    /// distance can come from the slope of the face.
    const BEFORE: f64 = 1.0;
    let fine = samples.fine as f64;
    let hides = ((place.z + BEFORE) * fine) as f32;
    samples.any_around(place * fine, |depth, face| depth <= hides || own(face))
}
