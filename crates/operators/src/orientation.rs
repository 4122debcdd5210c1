//! Orientation repair: faces turned until neighbours agree.

use glam::DVec3;
use mesh_core::{FaceId, FaceList, PolygonMesh, VertexId};

use crate::error::OrientationError;

/// Which way the faces of a component face in the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// As most of them did: the fewest faces are turned. Of two halves, the one of its first face.
    #[default]
    Majority,
    /// Outward where a component is closed and encloses a volume; as most did elsewhere.
    Outward,
}

/// A mesh whose faces agree, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Oriented {
    /// The mesh: the vertices, and the order and the first corners of the faces, are as they were.
    pub polygons: PolygonMesh,
    /// The faces that were turned over, ascending.
    pub turned: Vec<FaceId>,
}

/// Turns faces over until no edge of two faces is run twice in the same direction.
///
/// ```text
///     ──→──              ──→──
///    ↑  0  ↓            ↑  0  ↓      both run the middle to the left: face 1 is turned, and so on
///     ──←──      ⇒       ──←──       from face to face, over every edge that two faces share;
///    ↓  1  ↑             ──→──       an edge of three or more faces leads nowhere
///     ──→──             ↑  1  ↓
///                        ──←──
/// ```
///
/// Components are oriented each for itself: the wall of a cavity, closed and inside of another
/// component, faces away from the cavity as well if faces are to face outward.
///
/// # Errors
///
/// [`OrientationError::NotOrientable`] with an edge at which a component turns back on itself.
///
/// # Complexity
///
/// O(n log n) in the corners, for sorting the sides.
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

/// The face across a side, and whether it runs the edge in the same direction.
type Mate = Option<(FaceId, bool)>;

/// By corner: what is across the side that starts there, if the edge has two faces.
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

/// Says of every face that `seed` reaches whether it is to be turned, if `seed` is not.
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

/// Whether the component, turned so, faces inward; `None` if it is open or encloses nothing.
///
/// The signed volume: a sum over triangles of det(a, b, c) / 6, seen from a vertex of the component.
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
    // What is left of a sum that cancels out says nothing.
    (volume.abs() > 1e-9 * size).then_some(volume < 0.0)
}

/// The mesh with the faces that are to be turned turned, each around its first corner.
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
        pushed.expect("as many corners as before");
    }
    let polygons = PolygonMesh::from_faces(polygons.positions().to_vec(), list)
        .expect("the same vertices in each face");
    Oriented { polygons, turned }
}

#[cfg(test)]
mod tests {
    use conformance::strategy::manifold_mesh;
    use mesh_core::Facts;
    use proptest::collection;
    use proptest::prelude::*;

    use super::*;

    /// The mesh with the faces that `turn` picks turned over.
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

        /// Faces of a mesh that agreed agree again, and no other way would have turned fewer.
        #[test]
        fn turned_faces_are_turned_back(
            polygons in manifold_mesh(),
            turn in collection::vec(any::<bool>(), 1..20),
        ) {
            let turn = |f: usize| turn[f % turn.len()];
            let mended = oriented(&with_turned(&polygons, turn), Facing::Majority).expect("orientable");
            prop_assert_eq!(Facts::of(&mended.polygons).inconsistent_edges, 0);
            prop_assert!(2 * mended.turned.len() <= polygons.face_count());
            // A face that is not as it was is of a component that is the other way round as a whole.
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

        /// Closed shapes of this project face outward, so they come back as they were.
        #[test]
        fn closed_shapes_come_to_face_outward(turn in collection::vec(any::<bool>(), 1..50)) {
            let torus = shapes::torus(6, 5).expect("small");
            for shape in [shapes::cube(), shapes::dodecahedron(), torus] {
                let mixed = with_turned(&shape, |f| turn[f % turn.len()]);
                let mended = oriented(&mixed, Facing::Outward).expect("orientable");
                prop_assert_eq!(mended.polygons, shape);
            }
        }
    }

    #[test]
    fn a_shape_inside_out_is_turned_only_if_asked_to() {
        let inside_out = with_turned(&shapes::cube(), |_| true);
        let majority = oriented(&inside_out, Facing::Majority).expect("orientable");
        assert!(majority.turned.is_empty());
        let outward = oriented(&inside_out, Facing::Outward).expect("orientable");
        assert_eq!(outward.turned, (0..6).map(face).collect::<Vec<_>>());
        assert_eq!(outward.polygons, shapes::cube());
    }

    #[test]
    fn what_encloses_nothing_goes_by_the_majority() {
        let grid = shapes::grid(3, 3).expect("small");
        let mixed = with_turned(&grid, |f| f == 4);
        let mended = oriented(&mixed, Facing::Outward).expect("orientable");
        assert_eq!(mended.turned, [face(4)]);
        // A pillow is closed, and flat.
        let corners = grid.positions()[..3].to_vec();
        let pillow = PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 2]]).expect("valid");
        let mended = oriented(&pillow, Facing::Outward).expect("orientable");
        assert_eq!(mended.turned, [face(1)]);
    }

    #[test]
    fn an_edge_of_three_faces_leads_nowhere() {
        let points = [0.0, 1.0, 2.0, 3.0, 4.0].map(mesh_core::Point::splat);
        let book = PolygonMesh::new(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]).expect("valid");
        let mended = oriented(&book, Facing::Majority).expect("nothing contradicts");
        assert_eq!((mended.polygons, mended.turned), (book, vec![]));
    }

    #[test]
    fn one_sided_surfaces_are_refused_at_an_edge_of_theirs() {
        let mut refused = 0;
        for specimen in conformance::gallery() {
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
            "Möbius strip, Klein bottle and projective plane"
        );
    }
}
