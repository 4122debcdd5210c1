//! Faults that are added to a mesh on purpose.

use super::draft::Draft;

/// A fault of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// One face is oriented against the adjacent faces.
    TurnedFace,
    /// An edge has three faces or more.
    ThirdFace,
    /// The faces at a vertex form two fans.
    BowTie,
    /// A face occurs twice.
    DuplicateFace,
    /// A vertex has no face.
    IsolatedVertex,
    /// Two vertices share a position.
    CoincidentVertices,
}

impl Fault {
    /// All faults, in the order in which they can be added to one mesh.
    pub const ALL: [Self; 6] = [
        Self::TurnedFace,
        Self::ThirdFace,
        Self::BowTie,
        Self::DuplicateFace,
        Self::IsolatedVertex,
        Self::CoincidentVertices,
    ];

    /// Adds the fault to `draft`; `at` selects the place.
    pub(super) fn put_into(self, draft: &mut Draft, at: usize) {
        let sides = draft.sides();
        let (a, b, f) = sides[at % sides.len()];
        match self {
            Self::TurnedFace => {
                // The fault needs an adjacent face across that side.
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

/// Merges `v` with a vertex that has no adjacent vertex in common with it, or attaches a triangle
/// to `v`.
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

/// Returns the vertices that have no face in common with `v`.
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
