//! Random scripts of edits whose steps select their elements from the current mesh.

use proptest::prelude::*;
use proptest::{collection, sample};
use sixfold_core::{Edit, Point};

use super::action::Action;
use super::model::Model;

/// Above this number of faces, an edit that adds faces is replaced by one that removes faces.
const MANY_FACES: usize = 48;

/// One step: the kind of edit, and numbers that select its elements.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Kind of the edit.
    pub edit: Edit,
    /// Numbers that select the elements.
    pub picks: [u16; 4],
}

/// Generates up to `max_steps` steps with kinds from `edits`. Removals and compaction are rarer,
/// because they leave few elements to edit; `AddVertex` and `SetPosition` are rarer too. The other
/// edits are equally likely.
pub fn script(edits: &[Edit], max_steps: usize) -> impl Strategy<Value = Vec<Step>> + use<> {
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
        0..=max_steps,
    )
}

impl Step {
    /// Returns the action of this step on `model`; `number` gives the position of a new vertex.
    /// `None` if `model` has no element for the action.
    pub fn action(&self, model: &Model, number: usize) -> Option<Action> {
        let [p, q, r, s] = self.picks.map(usize::from);
        let at = if s % 64 == 63 {
            // Sometimes the position of an existing vertex.
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
                // Polygons are preferred, because a triangle cannot be split.
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

    /// Returns corners of a new face that is often legal: any three vertices, a triangle at a
    /// boundary edge or between two successive boundary edges, or the whole boundary of a hole.
    fn new_face(&self, model: &Model) -> Option<Vec<usize>> {
        let [p, q, r, s] = self.picks.map(usize::from);
        let vertices: Vec<usize> = model.vertices().collect();
        // The sides of the boundary, in the direction of a face outside it.
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

fn pick<T: Copy>(items: &[T], number: usize) -> Option<T> {
    items.get(number.checked_rem(items.len())?).copied()
}
