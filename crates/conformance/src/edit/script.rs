//! Random scripts of edits that find their elements in whatever mesh they meet.

use mesh_core::{Edit, Point};
use proptest::prelude::*;
use proptest::{collection, sample};

use super::action::Action;
use super::model::Model;

/// Above this many faces edits that add some are turned into those that take some away.
const MANY_FACES: usize = 48;

/// One step: which edit, and what to choose its elements by.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The edit.
    pub edit: Edit,
    /// What chooses the elements.
    pub picks: [u16; 4],
}

/// Up to `most` steps of edits among `edits`, each as likely as the others but for removals and
/// compaction, which are rarer: they leave little to work on.
pub fn script(edits: &[Edit], most: usize) -> impl Strategy<Value = Vec<Step>> + use<> {
    let weight = |edit: &Edit| match edit {
        Edit::RemoveVertex | Edit::RemoveIsolatedVertices | Edit::Compact => 1,
        Edit::RemoveFace | Edit::AddVertex | Edit::SetPosition => 2,
        _ => 4,
    };
    let edits: Vec<Edit> = edits
        .iter()
        .flat_map(|edit| std::iter::repeat_n(*edit, weight(edit)))
        .collect();
    let step = (sample::select(edits), any::<[u16; 4]>());
    collection::vec(
        step.prop_map(|(edit, picks)| Step { edit, picks }),
        0..=most,
    )
}

impl Step {
    /// The action that the step is on `model`; `number` makes the place of a new vertex. `None` where
    /// there is nothing to do it to.
    pub fn action(&self, model: &Model, number: usize) -> Option<Action> {
        let [p, q, r, s] = self.picks.map(usize::from);
        let at = if s % 64 == 63 {
            // Now and then where a vertex is already.
            model.position(pick(&model.vertices().collect::<Vec<_>>(), r)?)?
        } else {
            Point::new(1000.0 + number as f32, (p % 97) as f32, (q % 89) as f32)
        };
        let vertices: Vec<usize> = model.vertices().collect();
        let faces: Vec<usize> = model.faces().map(|(f, _)| f).collect();
        let edges = model.edges();
        let ends: Vec<[usize; 2]> = edges.keys().copied().collect();
        let edge = |p: usize| {
            let [a, b] = pick(&ends, p)?;
            Some(if q % 2 == 0 { [a, b] } else { [b, a] })
        };
        let grows = matches!(
            self.edit,
            Edit::SplitEdge
                | Edit::BisectEdge
                | Edit::PokeFace
                | Edit::SplitFace
                | Edit::SplitVertex
        );
        let edit = match self.edit {
            _ if grows && faces.len() > MANY_FACES => Edit::CollapseEdge,
            edit => edit,
        };
        let action = match edit {
            Edit::SetPosition => Action::SetPosition {
                v: pick(&vertices, p)?,
                to: at,
            },
            Edit::AddVertex => Action::AddVertex { at },
            Edit::AddFace => Action::AddFace {
                corners: self.new_face(model)?,
            },
            Edit::RemoveFace => Action::RemoveFace {
                f: pick(&faces, p)?,
            },
            Edit::RemoveVertex => Action::RemoveVertex {
                v: pick(&vertices, p)?,
            },
            Edit::RemoveIsolatedVertices => Action::RemoveIsolatedVertices,
            Edit::SplitEdge => Action::SplitEdge { ends: edge(p)?, at },
            Edit::BisectEdge => Action::BisectEdge { ends: edge(p)?, at },
            Edit::PokeFace => Action::PokeFace {
                f: pick(&faces, p)?,
                at,
            },
            Edit::SplitFace => {
                // Polygons first: a triangle has nothing to cut.
                let polygons = model.faces().filter(|(_, face)| face.len() > 3);
                let polygons: Vec<usize> = polygons.map(|(f, _)| f).collect();
                let f = pick(&polygons, p).or_else(|| pick(&faces, p))?;
                let face = model.face(f)?;
                let i = q % face.len();
                let j = (i + 2 + r % 3) % face.len();
                Action::SplitFace {
                    f,
                    ends: [face[i], face[j]],
                }
            }
            Edit::DissolveEdge => Action::DissolveEdge { ends: edge(p)? },
            Edit::FlipEdge => Action::FlipEdge { ends: edge(p)? },
            Edit::CollapseEdge => {
                let ends = edge(p)?;
                let to = if r % 4 == 0 {
                    model.position(ends[r / 4 % 2])?
                } else {
                    at
                };
                Action::CollapseEdge { ends, to }
            }
            Edit::SplitVertex => {
                let v = pick(&vertices, p)?;
                let around: Vec<usize> = model.neighbours(v).into_iter().collect();
                let side = |p: usize| pick(&around, p);
                let (left, right) = match s % 6 {
                    0 => (None, side(q)),
                    1 => (side(q), None),
                    _ => (side(q), side(q + 1 + r % 5)),
                };
                Action::SplitVertex { v, left, right, at }
            }
            _ => Action::Compact,
        };
        Some(action)
    }

    /// Corners of a face that may well be legal: any three, a triangle outside a boundary edge or in a
    /// boundary's corner, or a hole's whole boundary.
    fn new_face(&self, model: &Model) -> Option<Vec<usize>> {
        let [p, q, r, s] = self.picks.map(usize::from);
        let vertices: Vec<usize> = model.vertices().collect();
        // The boundary as it is run from outside.
        let boundary: Vec<[usize; 2]> = model
            .edges()
            .into_iter()
            .filter_map(|(ends, faces)| match *faces.as_slice() {
                [(_, upwards)] => Some(if upwards { [ends[1], ends[0]] } else { ends }),
                _ => None,
            })
            .collect();
        let after = |v: usize| {
            boundary
                .iter()
                .find(|side| side[0] == v)
                .map(|side| side[1])
        };
        let side = pick(&boundary, p);
        match (s % 8, side) {
            (0, _) | (_, None) => [p, q, r].map(|p| pick(&vertices, p)).into_iter().collect(),
            (1 | 2, Some([a, b])) => {
                let used = |v: &usize| model.faces().any(|(_, face)| face.contains(v));
                let isolated: Vec<usize> = vertices.iter().copied().filter(|v| !used(v)).collect();
                let c = pick(&isolated, q).or_else(|| pick(&vertices, q))?;
                Some(vec![a, b, c])
            }
            (3 | 4, Some([a, b])) => Some(vec![a, b, after(b)?]),
            (_, Some([a, b])) => {
                let mut hole = vec![a, b];
                while let Some(next) = after(*hole.last()?).filter(|&v| v != a) {
                    if hole.len() > 7 {
                        return Some(vec![a, b, after(b)?]);
                    }
                    hole.push(next);
                }
                Some(hole)
            }
        }
    }
}

fn pick<T: Copy>(items: &[T], by: usize) -> Option<T> {
    items.get(by.checked_rem(items.len())?).copied()
}
