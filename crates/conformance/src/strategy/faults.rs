//! What can be wrong with a mesh, put there on purpose.

use super::draft::Draft;

/// A fault of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// One face runs against its neighbours.
    TurnedFace,
    /// An edge has three faces or more.
    ThirdFace,
    /// The faces at a vertex are two fans.
    BowTie,
    /// A face is there twice.
    DuplicateFace,
    /// A vertex is in no face.
    IsolatedVertex,
    /// Two vertices are at one place.
    CoincidentVertices,
}

impl Fault {
    /// All of them, in the order in which they can be put into one mesh.
    pub const ALL: [Self; 6] = [
        Self::TurnedFace,
        Self::ThirdFace,
        Self::BowTie,
        Self::DuplicateFace,
        Self::IsolatedVertex,
        Self::CoincidentVertices,
    ];

    /// Puts the fault at some place that `at` picks.
    pub(super) fn put_into(self, draft: &mut Draft, at: usize) {
        let sides = draft.sides();
        let (a, b, f) = sides[at % sides.len()];
        match self {
            Self::TurnedFace => {
                // With a neighbour across that side, there is something to run against.
                if !sides.iter().any(|side| (side.0, side.1) == (b, a)) {
                    let tip = draft.vertex();
                    draft.faces.push(vec![b, a, tip]);
                }
                draft.faces[f].reverse();
            }
            Self::ThirdFace => {
                let along = sides
                    .iter()
                    .filter(|s| (s.0, s.1) == (a, b) || (s.0, s.1) == (b, a));
                for _ in along.count()..3 {
                    let tip = draft.vertex();
                    draft.faces.push(vec![a, b, tip]);
                }
            }
            Self::BowTie => bow_tie(draft, a),
            Self::DuplicateFace => draft.faces.push(draft.faces[f].clone()),
            Self::IsolatedVertex => draft.isolated += 1,
            Self::CoincidentVertices => {
                draft.coincident = Some([a, stranger(draft, a).unwrap_or(b)])
            }
        }
    }
}

/// Merges `v` with a vertex that has no neighbour in common with it, or hangs a triangle onto it.
fn bow_tie(draft: &mut Draft, v: u32) {
    let ring = draft.ring(v);
    let apart = |&u: &u32| draft.ring(u).is_disjoint(&ring);
    match strangers(draft, v).into_iter().find(apart) {
        Some(u) => {
            for corner in draft
                .faces
                .iter_mut()
                .flatten()
                .filter(|corner| **corner == u)
            {
                *corner = v;
            }
        }
        None => {
            let tips = [draft.vertex(), draft.vertex()];
            draft.faces.push(vec![v, tips[0], tips[1]]);
        }
    }
}

/// The vertices with no face in common with `v`.
fn strangers(draft: &Draft, v: u32) -> Vec<u32> {
    let meet = |u: u32| {
        draft
            .faces
            .iter()
            .any(|face| face.contains(&u) && face.contains(&v))
    };
    draft.used().into_iter().filter(|&u| !meet(u)).collect()
}

fn stranger(draft: &Draft, v: u32) -> Option<u32> {
    strangers(draft, v).first().copied()
}
