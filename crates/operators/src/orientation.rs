//! Orientation repair: turns faces over until adjacent faces agree.

use glam::DVec3;
use sixfold_core::{FaceId, FaceList, PolygonMesh, VertexId};

use crate::error::OrientationError;

/// The side that the faces of a component face in the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// As the majority did, so that the fewest faces are turned. In a tie, as the first face did.
    #[default]
    Majority,
    /// Outward if the component is closed and encloses a volume; otherwise as the majority did.
    Outward,
}

/// A mesh with consistent orientation, and the faces that were turned for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Oriented {
    /// The mesh. The vertices, the order of the faces and their first corners are unchanged.
    pub polygons: PolygonMesh,
    /// The faces that were turned over (their corners reversed), ascending.
    pub turned: Vec<FaceId>,
}

/// Turns faces over until no two faces run along an edge in the same direction.
///
/// ```text
///     ──→──              ──→──
///    ↑  0  ↓            ↑  0  ↓      both run along the middle edge to the left: face 1 is turned;
///     ──←──      ⇒       ──←──       this continues across every edge that two faces share, but
///    ↓  1  ↑             ──→──       not across an edge of three or more faces
///     ──→──             ↑  1  ↓
///                        ──←──
/// ```
///
/// Each component is oriented independently. With [`Facing::Outward`], the closed wall of a cavity
/// inside another component therefore also faces away from the cavity.
///
/// # Errors
///
/// Returns [`OrientationError::NotOrientable`] with an edge at which a component cannot agree.
///
/// # Complexity
///
/// O(n log n) for n corners, to sort the sides.
pub fn oriented(polygons: &PolygonMesh, facing: Facing) -> Result<Oriented, OrientationError> {
    let faces = polygons.faces();
    let mates = mates(faces);
    let mut turn: Vec<Option<bool>> = vec![None; faces.len()];
    let mut members = Vec::new();
    for (seed, _) in faces.iter() {
        if turn[seed.index()].is_some() {
            continue;
        }
        members.clear();
        flood(seed, faces, &mates, &mut turn, &mut members)?;
        let turned = members.iter().filter(|f| turn[f.index()] == Some(true));
        let majority = 2 * turned.count() > members.len();
        let other_way = match facing {
            Facing::Majority => majority,
            Facing::Outward => inward(polygons, &mates, &turn, &members).unwrap_or(majority),
        };
        if other_way {
            for f in &members {
                turn[f.index()] = turn[f.index()].map(|turned| !turned);
            }
        }
    }
    Ok(turned_over(polygons, &turn))
}

/// The face across a side, and whether both faces run along the edge in the same direction.
type Mate = Option<(FaceId, bool)>;

/// Returns, by corner, the mate across the side that starts there, if the edge has two faces.
fn mates(faces: &FaceList) -> Vec<Mate> {
    struct Side {
        ends: [VertexId; 2],
        face: FaceId,
        corner: usize,
        upward: bool,
    }
    let mut sides: Vec<Side> = Vec::with_capacity(faces.corners().len());
    for (face, corners) in faces.iter() {
        let next = corners.iter().cycle().skip(1);
        for (corner, (&a, &b)) in faces.range(face).zip(corners.iter().zip(next)) {
            let (ends, upward) = ([a.min(b), a.max(b)], a < b);
            sides.push(Side {
                ends,
                face,
                corner,
                upward,
            });
        }
    }
    sides.sort_unstable_by_key(|side| (side.ends, side.corner));
    let mut mates = vec![None; sides.len()];
    for edge in sides.chunk_by(|a, b| a.ends == b.ends) {
        if let [a, b] = edge {
            let same = a.upward == b.upward;
            mates[a.corner] = Some((b.face, same));
            mates[b.corner] = Some((a.face, same));
        }
    }
    mates
}

/// Decides for every face connected to `seed` whether it is turned, if `seed` is not turned.
fn flood(
    seed: FaceId,
    faces: &FaceList,
    mates: &[Mate],
    turn: &mut [Option<bool>],
    members: &mut Vec<FaceId>,
) -> Result<(), OrientationError> {
    turn[seed.index()] = Some(false);
    members.push(seed);
    let mut head = 0;
    while let Some(&f) = members.get(head) {
        head += 1;
        let here = turn[f.index()] == Some(true);
        for (i, corner) in faces.range(f).enumerate() {
            let Some((g, same)) = mates[corner] else {
                continue;
            };
            let there = here ^ same;
            let known = *turn[g.index()].get_or_insert_with(|| {
                members.push(g);
                there
            });
            if known != there {
                let face = faces.face(f);
                let (a, b) = (face[i], face[(i + 1) % face.len()]);
                let ends = [a.min(b), a.max(b)];
                return Err(OrientationError::NotOrientable { ends });
            }
        }
    }
    Ok(())
}

/// Returns whether the component, after the turns, faces inward; `None` if it is open or encloses
/// no volume.
///
/// Uses the signed volume: the sum of det(a, b, c) / 6 over triangles, relative to a vertex of the
/// component.
fn inward(
    polygons: &PolygonMesh,
    mates: &[Mate],
    turn: &[Option<bool>],
    members: &[FaceId],
) -> Option<bool> {
    let faces = polygons.faces();
    let from = polygons
        .position(faces.face(*members.first()?)[0])
        .as_dvec3();
    let (mut volume, mut size) = (0.0, 0.0);
    for &f in members {
        if mates[faces.range(f)].contains(&None) {
            return None;
        }
        let sign = if turn[f.index()] == Some(true) {
            -1.0
        } else {
            1.0
        };
        let at = |v: VertexId| -> DVec3 { polygons.position(v).as_dvec3() - from };
        let face = faces.face(f);
        for pair in face[1..].windows(2) {
            let part = at(face[0]).dot(at(pair[0]).cross(at(pair[1])));
            volume += sign * part;
            size += part.abs();
        }
    }
    // If the terms cancel, the rest is only rounding error.
    (volume.abs() > 1e-9 * size).then_some(volume < 0.0)
}

/// Builds the mesh with the faces in `turn` reversed; each keeps its first corner.
fn turned_over(polygons: &PolygonMesh, turn: &[Option<bool>]) -> Oriented {
    let faces = polygons.faces();
    let mut list = FaceList::with_capacity(faces.corners().len());
    let mut turned = Vec::new();
    for (f, face) in faces.iter() {
        let pushed = if turn[f.index()] == Some(true) {
            turned.push(f);
            list.push(face[..1].iter().chain(face[1..].iter().rev()).copied())
        } else {
            list.push(face.iter().copied())
        };
        pushed.expect("the same number of corners as before");
    }
    let polygons = PolygonMesh::from_faces(polygons.positions().to_vec(), list)
        .expect("each face has the same vertices as before");
    Oriented { polygons, turned }
}

#[cfg(test)]
mod tests {
    use proptest::collection;
    use proptest::prelude::*;
    use sixfold_conformance::strategy::manifold_mesh;
    use sixfold_core::Facts;

    use super::*;

    /// Builds the mesh with the faces that `turn` selects turned over.
    fn with_turned(polygons: &PolygonMesh, turn: impl Fn(usize) -> bool) -> PolygonMesh {
        let faces = polygons.faces().iter().map(|(f, _)| Some(turn(f.index())));
        let faces: Vec<Option<bool>> = faces.collect();
        turned_over(polygons, &faces).polygons
    }

    fn face(row: u32) -> FaceId {
        FaceId::new(row)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// After some faces of a consistent mesh are turned, all faces agree again with the fewest
        /// turns.
        #[test]
        fn turned_faces_are_turned_back(
            polygons in manifold_mesh(),
            turn in collection::vec(any::<bool>(), 1..20),
        ) {
            let turn = |f: usize| turn[f % turn.len()];
            let mended = oriented(&with_turned(&polygons, turn), Facing::Majority).expect("orientable");
            prop_assert_eq!(Facts::of(&mended.polygons).inconsistent_edges, 0);
            prop_assert!(2 * mended.turned.len() <= polygons.face_count());
            // A face differs from the original only if its whole component is turned over.
            let as_was = |f: FaceId| polygons.faces().face(f) == mended.polygons.faces().face(f);
            let mates = mates(polygons.faces());
            for (f, _) in polygons.faces().iter() {
                prop_assert_eq!(as_was(f), turn(f.index()) == mended.turned.contains(&f));
                for corner in polygons.faces().range(f) {
                    if let Some((g, _)) = mates[corner] {
                        prop_assert_eq!(as_was(f), as_was(g));
                    }
                }
            }
            let again = oriented(&mended.polygons, Facing::Majority).expect("orientable");
            prop_assert!(again.turned.is_empty());
        }

        /// The closed shapes of this project face outward, so the result is the original shape.
        #[test]
        fn closed_shapes_face_outward_again(turn in collection::vec(any::<bool>(), 1..50)) {
            let torus = sixfold_shapes::torus(6, 5).expect("small");
            for shape in [sixfold_shapes::cube(), sixfold_shapes::dodecahedron(), torus] {
                let mixed = with_turned(&shape, |f| turn[f % turn.len()]);
                let mended = oriented(&mixed, Facing::Outward).expect("orientable");
                prop_assert_eq!(mended.polygons, shape);
            }
        }
    }

    #[test]
    fn an_inside_out_shape_is_turned_only_by_outward() {
        let inside_out = with_turned(&sixfold_shapes::cube(), |_| true);
        let majority = oriented(&inside_out, Facing::Majority).expect("orientable");
        assert!(majority.turned.is_empty());
        let outward = oriented(&inside_out, Facing::Outward).expect("orientable");
        assert_eq!(outward.turned, (0..6).map(face).collect::<Vec<_>>());
        assert_eq!(outward.polygons, sixfold_shapes::cube());
    }

    #[test]
    fn components_without_volume_follow_the_majority() {
        let grid = sixfold_shapes::grid(3, 3).expect("small");
        let mixed = with_turned(&grid, |f| f == 4);
        let mended = oriented(&mixed, Facing::Outward).expect("orientable");
        assert_eq!(mended.turned, [face(4)]);
        // A pillow is closed, but it is flat.
        let corners = grid.positions()[..3].to_vec();
        let pillow = PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 2]]).expect("valid");
        let mended = oriented(&pillow, Facing::Outward).expect("orientable");
        assert_eq!(mended.turned, [face(1)]);
    }

    #[test]
    fn an_edge_of_three_faces_is_not_crossed() {
        let points = [0.0, 1.0, 2.0, 3.0, 4.0].map(sixfold_core::Point::splat);
        let book = PolygonMesh::new(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]).expect("valid");
        let mended = oriented(&book, Facing::Majority).expect("no faces disagree");
        assert_eq!((mended.polygons, mended.turned), (book, vec![]));
    }

    #[test]
    fn non_orientable_surfaces_are_rejected_with_an_edge() {
        let mut refused = 0;
        for specimen in sixfold_conformance::gallery() {
            let facts = Facts::of(&specimen.polygons);
            match oriented(&specimen.polygons, Facing::Majority) {
                Ok(_) => assert_ne!(facts.orientable, Some(false), "{}", specimen.name),
                Err(OrientationError::NotOrientable { ends: [a, b] }) => {
                    assert_eq!(facts.orientable, Some(false), "{}", specimen.name);
                    let faces = specimen.polygons.faces().iter();
                    let along = faces.filter(|(_, f)| f.contains(&a) && f.contains(&b));
                    assert!(a < b && along.count() >= 2, "{}", specimen.name);
                    refused += 1;
                }
            }
        }
        assert!(
            refused >= 3,
            "expected at least the Möbius strip, the Klein bottle and the projective plane"
        );
    }
}
