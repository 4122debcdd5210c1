//! Orientation repair: reverses faces until adjacent faces agree.

use glam::DVec3;
use sixfold_core::{FaceId, FaceList, PolygonMesh, VertexId};

use crate::error::OrientationError;

/// The rule that chooses one of the two orientations of each component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// The orientation of the majority of faces. In a tie, the orientation of the first face.
    #[default]
    Majority,
    /// Outward if the component is closed and encloses a volume; otherwise as with
    /// [`Majority`](Self::Majority).
    Outward,
}

/// The components that [`oriented_components`] may reverse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Components {
    /// All orientable components.
    #[default]
    All,
    /// Components with two faces that disagree. A component that is consistent remains as it is,
    /// even if it faces inward.
    Inconsistent,
}

/// A mesh with consistent orientation, and the reversed faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Oriented {
    /// The mesh. The vertices, the order of the faces and the first corner of each face are
    /// unchanged.
    pub polygons: PolygonMesh,
    /// The reversed faces, ascending.
    pub reversed: Vec<FaceId>,
}

/// A mesh whose orientable components are consistent, the faces that were reversed for it, and the
/// components that are not orientable.
#[derive(Clone, Debug, PartialEq)]
pub struct OrientedComponents {
    /// The mesh. The vertices, the order of the faces and their first corners are unchanged.
    pub polygons: PolygonMesh,
    /// The faces whose corners were reversed, ascending.
    pub reversed: Vec<FaceId>,
    /// The components that are not orientable, in the order of their first faces. None of their
    /// faces is reversed.
    pub not_orientable: Vec<NotOrientable>,
}

/// A component whose faces cannot agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotOrientable {
    /// Its first face.
    pub face: FaceId,
    /// The number of its faces.
    pub faces: usize,
    /// The ends of an edge at which the faces cannot agree, the lower first.
    pub ends: [VertexId; 2],
}

/// Reverses faces until no two faces run along an edge in the same direction.
///
/// ```text
///     ──→──              ──→──
///    ↑  0  ↓            ↑  0  ↓      both run along the middle edge to the left: face 1 is reversed;
///     ──←──      ⇒       ──←──       this continues across every edge that two faces share, but
///    ↓  1  ↑             ──→──       not across an edge of three or more faces
///     ──→──             ↑  1  ↓
///                        ──←──
/// ```
///
/// Each component is oriented independently. With [`Facing::Outward`], the wall of a cavity inside
/// a solid therefore faces away from the cavity.
///
/// # Errors
///
/// Returns [`OrientationError::NotOrientable`] if the faces of a component cannot agree, with an
/// edge of the component. [`oriented_components`] leaves such components as they are.
///
/// # Complexity
///
/// O(n log n) for n corners.
pub fn oriented(polygons: &PolygonMesh, facing: Facing) -> Result<Oriented, OrientationError> {
    let OrientedComponents {
        polygons,
        reversed,
        not_orientable,
    } = oriented_components(polygons, facing, Components::All);
    match not_orientable.first() {
        Some(&NotOrientable { ends, .. }) => Err(OrientationError::NotOrientable { ends }),
        None => Ok(Oriented { polygons, reversed }),
    }
}

/// Orients the orientable components of the kind `which` like [`oriented`]; the components that are
/// not orientable remain unchanged and are named. O(n log n) for n corners.
pub fn oriented_components(
    polygons: &PolygonMesh,
    facing: Facing,
    which: Components,
) -> OrientedComponents {
    let faces = polygons.faces();
    let neighbours = side_neighbours(faces);
    let mut reverse: Vec<Option<bool>> = vec![None; faces.len()];
    let mut component = Vec::new();
    let mut not_orientable = Vec::new();
    for (seed, _) in faces.iter() {
        if reverse[seed.index()].is_some() {
            continue;
        }
        component.clear();
        let conflict = orient_component(seed, faces, &neighbours, &mut reverse, &mut component);
        if let Some(ends) = conflict {
            not_orientable.push(NotOrientable {
                face: seed,
                faces: component.len(),
                ends,
            });
            for f in &component {
                reverse[f.index()] = Some(false);
            }
            continue;
        }
        let reversed = component
            .iter()
            .filter(|f| reverse[f.index()] == Some(true))
            .count();
        let majority = 2 * reversed > component.len();
        let reverse_all = match facing {
            Facing::Outward if which == Components::All || reversed > 0 => {
                faces_inward(polygons, &neighbours, &reverse, &component).unwrap_or(majority)
            }
            _ => majority,
        };
        if reverse_all {
            for f in &component {
                reverse[f.index()] = reverse[f.index()].map(|reverse| !reverse);
            }
        }
    }
    let Oriented { polygons, reversed } = reverse_faces(polygons, &reverse);
    OrientedComponents {
        polygons,
        reversed,
        not_orientable,
    }
}

/// The face across a side, and whether both faces run along the edge in the same direction.
type Neighbour = Option<(FaceId, bool)>;

/// Returns the neighbour across each side, if the edge has two faces.
fn side_neighbours(faces: &FaceList) -> Vec<Neighbour> {
    struct Side {
        ends: [VertexId; 2],
        face: FaceId,
        corner: usize,
        is_ascending: bool,
    }
    let mut sides: Vec<Side> = Vec::with_capacity(faces.corners().len());
    for (face, corners) in faces.iter() {
        let next = corners.iter().cycle().skip(1);
        for (corner, (&a, &b)) in faces.range(face).zip(corners.iter().zip(next)) {
            let (ends, is_ascending) = ([a.min(b), a.max(b)], a < b);
            sides.push(Side {
                ends,
                face,
                corner,
                is_ascending,
            });
        }
    }
    sides.sort_unstable_by_key(|side| (side.ends, side.corner));
    let mut neighbours = vec![None; sides.len()];
    for edge in sides.chunk_by(|a, b| a.ends == b.ends) {
        if let [a, b] = edge {
            let same = a.is_ascending == b.is_ascending;
            neighbours[a.corner] = Some((b.face, same));
            neighbours[b.corner] = Some((a.face, same));
        }
    }
    neighbours
}

/// Collects the component of `seed`. Decides for each face whether to reverse it, with `seed`
/// unchanged. Returns the ends of the first edge at which faces cannot agree.
fn orient_component(
    seed: FaceId,
    faces: &FaceList,
    neighbours: &[Neighbour],
    reverse: &mut [Option<bool>],
    component: &mut Vec<FaceId>,
) -> Option<[VertexId; 2]> {
    reverse[seed.index()] = Some(false);
    component.push(seed);
    let mut conflict = None;
    let mut head = 0;
    while let Some(&f) = component.get(head) {
        head += 1;
        let reverse_f = reverse[f.index()] == Some(true);
        for (i, corner) in faces.range(f).enumerate() {
            let Some((g, same)) = neighbours[corner] else {
                continue;
            };
            let reverse_g = reverse_f ^ same;
            let decided = *reverse[g.index()].get_or_insert_with(|| {
                component.push(g);
                reverse_g
            });
            if decided != reverse_g && conflict.is_none() {
                let face = faces.face(f);
                let (a, b) = (face[i], face[(i + 1) % face.len()]);
                conflict = Some([a.min(b), a.max(b)]);
            }
        }
    }
    conflict
}

/// Returns whether the component faces inward after the faces in `reverse` are reversed. Returns
/// `None` if the component is open or encloses no volume.
///
/// The sum of det(a, b, c) / 6 over all triangles is the signed volume. The coordinates are
/// relative to a vertex of the component.
fn faces_inward(
    polygons: &PolygonMesh,
    neighbours: &[Neighbour],
    reverse: &[Option<bool>],
    component: &[FaceId],
) -> Option<bool> {
    let faces = polygons.faces();
    let from = polygons
        .position(faces.face(*component.first()?)[0])
        .as_dvec3();
    let (mut volume, mut size) = (0.0, 0.0);
    for &f in component {
        if neighbours[faces.range(f)].contains(&None) {
            return None;
        }
        let sign = if reverse[f.index()] == Some(true) {
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
    // If the terms cancel, the sum is only a rounding error.
    (volume.abs() > 1e-9 * size).then_some(volume < 0.0)
}

/// Builds the mesh with the faces in `reverse` reversed. Each face keeps its first corner.
fn reverse_faces(polygons: &PolygonMesh, reverse: &[Option<bool>]) -> Oriented {
    let faces = polygons.faces();
    let mut list = FaceList::with_capacity(faces.corners().len());
    let mut reversed = Vec::new();
    for (f, face) in faces.iter() {
        let pushed = if reverse[f.index()] == Some(true) {
            reversed.push(f);
            list.push(face[..1].iter().chain(face[1..].iter().rev()).copied())
        } else {
            list.push(face.iter().copied())
        };
        pushed.expect("the same number of corners as before");
    }
    let polygons = PolygonMesh::from_faces(polygons.positions().to_vec(), list)
        .expect("each face has the same vertices as before");
    Oriented { polygons, reversed }
}

#[cfg(test)]
mod tests {
    use proptest::collection;
    use proptest::prelude::*;
    use sixfold_conformance::strategy::manifold_mesh;
    use sixfold_core::Facts;

    use super::*;

    fn with_reversed(polygons: &PolygonMesh, reverse: impl Fn(usize) -> bool) -> PolygonMesh {
        let faces = polygons
            .faces()
            .iter()
            .map(|(f, _)| Some(reverse(f.index())));
        let faces: Vec<Option<bool>> = faces.collect();
        reverse_faces(polygons, &faces).polygons
    }

    fn face(row: u32) -> FaceId {
        FaceId::new(row)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// The repair makes all faces agree with the fewest reversals.
        #[test]
        fn reversed_faces_are_reversed_back(
            polygons in manifold_mesh(),
            reverse in collection::vec(any::<bool>(), 1..20),
        ) {
            let reverse = |f: usize| reverse[f % reverse.len()];
            let repaired = oriented(&with_reversed(&polygons, reverse), Facing::Majority).expect("orientable");
            prop_assert_eq!(Facts::from_polygons(&repaired.polygons).inconsistent_edges, 0);
            prop_assert!(2 * repaired.reversed.len() <= polygons.face_count());
            // A face differs from the original only if its whole component is reversed.
            let unchanged = |f: FaceId| polygons.faces().face(f) == repaired.polygons.faces().face(f);
            let neighbours = side_neighbours(polygons.faces());
            for (f, _) in polygons.faces().iter() {
                prop_assert_eq!(unchanged(f), reverse(f.index()) == repaired.reversed.contains(&f));
                for corner in polygons.faces().range(f) {
                    if let Some((g, _)) = neighbours[corner] {
                        prop_assert_eq!(unchanged(f), unchanged(g));
                    }
                }
            }
            let again = oriented(&repaired.polygons, Facing::Majority).expect("orientable");
            prop_assert!(again.reversed.is_empty());
        }

        /// The closed shapes of this project face outward.
        #[test]
        fn closed_shapes_face_outward_again(reverse in collection::vec(any::<bool>(), 1..50)) {
            let torus = sixfold_shapes::torus(6, 5).expect("small");
            for shape in [sixfold_shapes::cube(), sixfold_shapes::dodecahedron(), torus] {
                let mixed = with_reversed(&shape, |f| reverse[f % reverse.len()]);
                let repaired = oriented(&mixed, Facing::Outward).expect("orientable");
                prop_assert_eq!(repaired.polygons, shape);
            }
        }
    }

    #[test]
    fn an_inside_out_shape_is_reversed_only_by_outward() {
        let inside_out = with_reversed(&sixfold_shapes::cube(), |_| true);
        let majority = oriented(&inside_out, Facing::Majority).expect("orientable");
        assert!(majority.reversed.is_empty());
        let outward = oriented(&inside_out, Facing::Outward).expect("orientable");
        assert_eq!(outward.reversed, (0..6).map(face).collect::<Vec<_>>());
        assert_eq!(outward.polygons, sixfold_shapes::cube());
    }

    #[test]
    fn components_without_volume_follow_the_majority() {
        let grid = sixfold_shapes::grid(3, 3).expect("small");
        let mixed = with_reversed(&grid, |f| f == 4);
        let repaired = oriented(&mixed, Facing::Outward).expect("orientable");
        assert_eq!(repaired.reversed, [face(4)]);
        // A pillow is closed, but flat.
        let corners = grid.positions()[..3].to_vec();
        let pillow = PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 2]]).expect("valid");
        let repaired = oriented(&pillow, Facing::Outward).expect("orientable");
        assert_eq!(repaired.reversed, [face(1)]);
    }

    #[test]
    fn an_edge_of_three_faces_is_not_crossed() {
        let points = [0.0, 1.0, 2.0, 3.0, 4.0].map(sixfold_core::Point::splat);
        let book = PolygonMesh::new(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]).expect("valid");
        let repaired = oriented(&book, Facing::Majority).expect("no faces disagree");
        assert_eq!((repaired.polygons, repaired.reversed), (book, vec![]));
    }

    #[test]
    fn non_orientable_surfaces_are_rejected_with_an_edge() {
        let mut rejected = 0;
        for specimen in sixfold_conformance::gallery() {
            let facts = Facts::from_polygons(&specimen.polygons);
            match oriented(&specimen.polygons, Facing::Majority) {
                Ok(_) => assert_ne!(facts.orientable, Some(false), "{}", specimen.name),
                Err(OrientationError::NotOrientable { ends: [a, b] }) => {
                    assert_eq!(facts.orientable, Some(false), "{}", specimen.name);
                    let faces = specimen.polygons.faces().iter();
                    let along = faces.filter(|(_, f)| f.contains(&a) && f.contains(&b));
                    assert!(a < b && along.count() >= 2, "{}", specimen.name);
                    rejected += 1;
                }
            }
        }
        assert!(
            rejected >= 3,
            "expected at least the Möbius strip, the Klein bottle and the projective plane"
        );
    }
}
