//! Faults that are added to a mesh on purpose.

use super::builder::MeshBuilder;

/// A fault of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// One face has the opposite orientation of its adjacent faces.
    TurnedFace,
    /// An edge has three or more faces.
    ThirdFace,
    /// The faces at a vertex form two fans.
    BowTie,
    /// A face occurs twice.
    DuplicateFace,
    /// A vertex has no face.
    IsolatedVertex,
    /// Two vertices have the same position.
    CoincidentVertices,
}

impl Fault {
    /// All kinds of faults, in the order in which they are added to a mesh.
    pub const ALL: [Self; 6] = [
        Self::TurnedFace,
        Self::ThirdFace,
        Self::BowTie,
        Self::DuplicateFace,
        Self::IsolatedVertex,
        Self::CoincidentVertices,
    ];

    /// Adds the fault to `builder`; `at` selects the place.
    pub(super) fn add_to(self, builder: &mut MeshBuilder, at: usize) {
        let sides = builder.sides();
        let (a, b, f) = sides[at % sides.len()];
        match self {
            Self::TurnedFace => {
                // Turning a face is a fault only if the face has an adjacent face.
                if !sides.iter().any(|side| (side.0, side.1) == (b, a)) {
                    let apex = builder.add_vertex();
                    builder.faces.push(vec![b, a, apex]);
                }
                builder.faces[f].reverse();
            }
            Self::ThirdFace => {
                let along = sides
                    .iter()
                    .filter(|s| (s.0, s.1) == (a, b) || (s.0, s.1) == (b, a));
                for _ in along.count()..3 {
                    let apex = builder.add_vertex();
                    builder.faces.push(vec![a, b, apex]);
                }
            }
            Self::BowTie => bow_tie(builder, a),
            Self::DuplicateFace => builder.faces.push(builder.faces[f].clone()),
            Self::IsolatedVertex => builder.isolated += 1,
            Self::CoincidentVertices => {
                builder.coincident = Some([a, first_without_common_face(builder, a).unwrap_or(b)])
            }
        }
    }
}

/// Merges `v` with another vertex that has no common face and no common adjacent vertex. If there
/// is no such vertex, attaches a triangle to `v`.
fn bow_tie(builder: &mut MeshBuilder, v: u32) {
    let neighbours = builder.neighbours(v);
    let is_separate = |&u: &u32| builder.neighbours(u).is_disjoint(&neighbours);
    match without_common_face(builder, v)
        .into_iter()
        .find(is_separate)
    {
        Some(u) => {
            for corner in builder
                .faces
                .iter_mut()
                .flatten()
                .filter(|corner| **corner == u)
            {
                *corner = v;
            }
        }
        None => {
            let apexes = [builder.add_vertex(), builder.add_vertex()];
            builder.faces.push(vec![v, apexes[0], apexes[1]]);
        }
    }
}

fn without_common_face(builder: &MeshBuilder, v: u32) -> Vec<u32> {
    let share_face = |u: u32| {
        builder
            .faces
            .iter()
            .any(|face| face.contains(&u) && face.contains(&v))
    };
    builder
        .used_vertices()
        .into_iter()
        .filter(|&u| !share_face(u))
        .collect()
}

fn first_without_common_face(builder: &MeshBuilder, v: u32) -> Option<u32> {
    without_common_face(builder, v).first().copied()
}
