//! Random sequences of edits (*scripts*). Each step of a script selects its elements from the
//! current mesh.

use proptest::prelude::*;
use proptest::{collection, sample};
use sixfold_core::{Edit, Point};

use super::action::Action;
use super::model::Model;

/// Maximum number of faces of a mesh to which scripts add faces.
const MANY_FACES: usize = 48;

/// One step of a random edit sequence: the kind of edit, and numbers that select the elements to
/// edit.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The kind of the edit.
    pub edit: Edit,
    /// The numbers that select the elements.
    pub picks: [u16; 4],
}

/// Generates a random sequence of up to `max_steps` edits of the kinds in `edits`. Removals,
/// `Compact`, `AddVertex` and `SetPosition` are less frequent than other edits.
pub fn script(edits: &[Edit], max_steps: usize) -> impl Strategy<Value = Vec<Step>> + use<> {
    let weight = |edit: &Edit| match edit {
        Edit::RemoveVertex | Edit::RemoveFaces | Edit::RemoveIsolatedVertices | Edit::Compact => 1,
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
    /// Returns the action that this step executes on `model`, or `None` if `model` has no element
    /// to which the edit can be applied. `number` determines the position of a new vertex.
    pub fn action(&self, model: &Model, number: usize) -> Option<Action> {
        let at = self.new_position(model, number)?;
        let vertex = || pick(&model.vertices().collect::<Vec<_>>(), self.pick(0));
        let face = || pick(&all_faces(model), self.pick(0));
        let ends = || self.edge(model);
        Some(match self.edit_on(model) {
            Edit::SetPosition => Action::SetPosition {
                v: vertex()?,
                to: at,
            },
            Edit::AddVertex => Action::AddVertex { at },
            Edit::AddFace => Action::AddFace {
                corners: self.new_face(model)?,
            },
            Edit::RemoveFace => Action::RemoveFace { f: face()? },
            Edit::RemoveFaces => Action::RemoveFaces {
                faces: self.several_faces(model)?,
            },
            Edit::RemoveVertex => Action::RemoveVertex { v: vertex()? },
            Edit::RemoveIsolatedVertices => Action::RemoveIsolatedVertices {},
            Edit::SplitEdge => Action::SplitEdge { e: ends()?, at },
            Edit::BisectEdge => Action::BisectEdge { e: ends()?, at },
            Edit::PokeFace => Action::PokeFace { f: face()?, at },
            Edit::SplitFace => self.face_split(model)?,
            Edit::DissolveEdge => Action::DissolveEdge { e: ends()? },
            Edit::FlipEdge => Action::FlipEdge { e: ends()? },
            Edit::CollapseEdge => self.collapse(model, at)?,
            Edit::SplitVertex => self.vertex_split(model, vertex()?, at),
            _ => Action::Compact {},
        })
    }

    fn pick(&self, i: usize) -> usize {
        self.picks[i].into()
    }

    /// Returns the edit of this step, or a collapse if the mesh has too many faces.
    fn edit_on(&self, model: &Model) -> Edit {
        let grows = matches!(
            self.edit,
            Edit::SplitEdge
                | Edit::BisectEdge
                | Edit::PokeFace
                | Edit::SplitFace
                | Edit::SplitVertex
        );
        if grows && model.faces().count() > MANY_FACES {
            Edit::CollapseEdge
        } else {
            self.edit
        }
    }

    /// Returns the position of a new vertex, sometimes the position of an existing vertex.
    fn new_position(&self, model: &Model, number: usize) -> Option<Point> {
        let [p, q, r, s] = self.picks.map(usize::from);
        if s % 64 == 63 {
            let vertices: Vec<usize> = model.vertices().collect();
            return model.position(pick(&vertices, r)?);
        }
        let x = 1000.0 + number as f32;
        Some(Point::new(x, (p % 97) as f32, (q % 89) as f32))
    }

    fn edge(&self, model: &Model) -> Option<[usize; 2]> {
        let all: Vec<[usize; 2]> = model.edges().into_keys().collect();
        let [a, b] = pick(&all, self.pick(0))?;
        Some(if self.pick(1).is_multiple_of(2) {
            [a, b]
        } else {
            [b, a]
        })
    }

    /// Returns the split of a face, if possible of a face with more than three corners.
    fn face_split(&self, model: &Model) -> Option<Action> {
        let [p, q, r, _] = self.picks.map(usize::from);
        let polygons = model.faces().filter(|(_, face)| face.len() > 3);
        let polygons: Vec<usize> = polygons.map(|(f, _)| f).collect();
        let f = pick(&polygons, p).or_else(|| pick(&all_faces(model), p))?;
        let face = model.face(f)?;
        let i = q % face.len();
        let j = (i + 2 + r % 3) % face.len();
        Some(Action::SplitFace {
            f,
            ends: [face[i], face[j]],
        })
    }

    fn collapse(&self, model: &Model, at: Point) -> Option<Action> {
        let ends = self.edge(model)?;
        let r = self.pick(2);
        let to = if r.is_multiple_of(4) {
            model.position(ends[r / 4 % 2])?
        } else {
            at
        };
        Some(Action::CollapseEdge {
            e: ends,
            keep: ends[0],
            to,
        })
    }

    fn vertex_split(&self, model: &Model, v: usize, at: Point) -> Action {
        let [_, q, r, s] = self.picks.map(usize::from);
        let around: Vec<usize> = model.neighbours(v).into_iter().collect();
        let side = |p: usize| pick(&around, p);
        let (left, right) = match s % 6 {
            0 => (None, side(q)),
            1 => (side(q), None),
            _ => (side(q), side(q + 1 + r % 5)),
        };
        Action::SplitVertex { v, left, right, at }
    }

    /// Returns neighbouring faces, faces at a vertex, or faces at random. One of them may be there twice.
    fn several_faces(&self, model: &Model) -> Option<Vec<usize>> {
        let [p, q, r, s] = self.picks.map(usize::from);
        let all = all_faces(model);
        let first = pick(&all, p)?;
        let corners = model.face(first)?;
        let shares = |f: &usize, count: usize| {
            let face = model.face(*f).unwrap_or_default();
            face.iter().filter(|v| corners.contains(v)).count() >= count
        };
        let mut faces: Vec<usize> = match s % 4 {
            0 => all.iter().copied().filter(|f| shares(f, 2)).collect(),
            1 => all.iter().copied().filter(|f| shares(f, 1)).collect(),
            2 => all
                .iter()
                .copied()
                .filter(|f| f % (2 + q % 3) == 0)
                .collect(),
            _ => vec![first, pick(&all, q)?, pick(&all, r)?],
        };
        faces.push(first);
        Some(faces)
    }

    /// Returns the corners of a new face, which is often legal.
    fn new_face(&self, model: &Model) -> Option<Vec<usize>> {
        let [p, q, r, s] = self.picks.map(usize::from);
        let vertices: Vec<usize> = model.vertices().collect();
        // The boundary edges, in the direction of a new face.
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

fn all_faces(model: &Model) -> Vec<usize> {
    model.faces().map(|(f, _)| f).collect()
}

fn pick<T: Copy>(items: &[T], number: usize) -> Option<T> {
    items.get(number.checked_rem(items.len())?).copied()
}
