//! Orientation repair: reverses faces until adjacent faces run along their shared edges in opposite
//! directions.

use glam::DVec3;
use sixfold_core::{Classes, FaceId, FaceList, Incidence, PolygonMesh, VertexId, row};

use crate::error::OrientationError;

sixfold_core::named! {
    /// The rule that chooses one of the two possible orientations of each component (faces that are
    /// connected by edges with two faces).
    #[derive(Default)]
    pub enum Facing: "orientation rule" {
        /// The orientation that most faces of the component have. In a tie, the first face keeps
        /// its orientation.
        #[default]
        Majority = "majority",
        /// The faces of a closed component that encloses a volume face outward. For other
        /// components, the rule [`Majority`](Self::Majority) applies.
        Outward = "outward",
    }
}

/// The components that [`oriented_components`] may reverse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Components {
    /// All orientable components.
    #[default]
    All,
    /// Components in which two faces run along an edge in the same direction. All other components
    /// remain unchanged, even if they face inward.
    Inconsistent,
}

/// A mesh with consistent orientation, and the list of the reversed faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Oriented {
    /// The mesh after the faces were reversed. The vertices, the order of the faces and the first
    /// corner of each face are unchanged.
    pub polygons: PolygonMesh,
    /// The reversed faces, in ascending order.
    pub reversed: Vec<FaceId>,
}

/// A mesh in which the chosen components have a consistent orientation, the list of reversed faces,
/// and the list of components that are not orientable.
#[derive(Clone, Debug, PartialEq)]
pub struct OrientedComponents {
    /// The mesh after the faces were reversed. The vertices, the order of the faces and the first
    /// corner of each face are unchanged.
    pub polygons: PolygonMesh,
    /// The reversed faces, in ascending order.
    pub reversed: Vec<FaceId>,
    /// The components that are not orientable, in the order of their first faces. The faces of
    /// these components are not reversed.
    pub not_orientable: Vec<NotOrientable>,
}

/// A component whose faces cannot have a consistent orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotOrientable {
    /// The first face of the component.
    pub face: FaceId,
    /// The number of faces of the component.
    pub faces: usize,
    /// The ends of an edge whose two faces would need conflicting orientations, the lower end
    /// first.
    pub ends: [VertexId; 2],
}

/// Reverses faces until, at every edge with exactly two faces, the two faces run along the edge in
/// opposite directions.
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
/// Each component is oriented independently of the other components. Therefore, with
/// [`Facing::Outward`], the wall of a cavity inside a solid faces away from the cavity.
///
/// # Errors
///
/// Returns [`OrientationError::NotOrientable`] with an edge if the faces of a component cannot have
/// a consistent orientation. To leave these components unchanged instead, call
/// [`oriented_components`].
///
/// # Complexity
///
/// O(n log n) time for n corners.
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

/// Reverses faces like [`oriented`], but only in the orientable components that `which` selects.
/// Components that are not orientable remain unchanged, and the result lists them. O(n log n) time
/// for n corners.
pub fn oriented_components(
    polygons: &PolygonMesh,
    facing: Facing,
    which: Components,
) -> OrientedComponents {
    let incidence = Incidence::new(polygons.vertex_count(), polygons.faces(), |_| true);
    let Reversal {
        reversed,
        not_orientable,
    } = faces_to_reverse(polygons, &incidence, facing, which);
    OrientedComponents {
        polygons: reverse_faces(polygons, &reversed),
        reversed,
        not_orientable,
    }
}

/// The faces that [`oriented_components`] reverses, and the components that are not orientable.
#[doc(hidden)]
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reversal {
    /// The reversed faces, in ascending order.
    pub reversed: Vec<FaceId>,
    /// The components that are not orientable, in the order of their first faces.
    pub not_orientable: Vec<NotOrientable>,
}

/// Returns the faces that [`oriented_components`] reverses, without building the mesh. `incidence`
/// must contain the sides of all faces of `polygons`. Takes O(n log n) time for n corners.
///
/// # Panics
///
/// May panic if `incidence` belongs to another mesh.
#[doc(hidden)]
pub fn faces_to_reverse(
    polygons: &PolygonMesh,
    incidence: &Incidence<'_>,
    facing: Facing,
    which: Components,
) -> Reversal {
    let faces = polygons.faces();
    let agreement = match is_consistent(incidence) {
        true => Agreement::of_consistent(faces, incidence),
        false => Agreement::new(faces, incidence),
    };
    let inward = match facing {
        Facing::Outward => agreement.faces_inward(polygons, incidence),
        Facing::Majority => vec![None; agreement.conflicts.len()],
    };
    // By component: the number of faces, and of reversed faces.
    let mut sizes = vec![[0_usize; 2]; agreement.conflicts.len()];
    let mut first = vec![None; agreement.conflicts.len()];
    for (f, component) in faces.iter().map(|(f, _)| (f, agreement.component(f))) {
        sizes[component][0] += 1;
        sizes[component][1] += usize::from(agreement.reverse[f.index()]);
        first[component].get_or_insert(f);
    }
    let reverse_all = sizes.iter().zip(inward).map(|(&[size, reversed], inward)| {
        let majority = 2 * reversed > size;
        match inward {
            Some(inward) if which == Components::All || reversed > 0 => inward,
            _ => majority,
        }
    });
    let reverse_all: Vec<bool> = reverse_all.collect();
    let is_reversed = |&f: &FaceId| {
        let component = agreement.component(f);
        let orientable = agreement.conflicts[component].is_none();
        orientable && agreement.reverse[f.index()] != reverse_all[component]
    };
    let conflicts = agreement.conflicts.iter().zip(first).zip(&sizes);
    Reversal {
        reversed: faces.iter().map(|(f, _)| f).filter(is_reversed).collect(),
        not_orientable: conflicts
            .filter_map(|((&ends, face), &[faces, _])| {
                let (ends, face) = (ends?, face?);
                Some(NotOrientable { face, faces, ends })
            })
            .collect(),
    }
}

/// Returns whether the two faces of each edge with two faces agree.
fn is_consistent(incidence: &Incidence<'_>) -> bool {
    let mut pairs = incidence.edges().filter(|edge| edge.len() == 2);
    pairs.all(|edge| edge.downward() == 1)
}

/// The components that are connected by edges with two faces, and the faces to reverse so that the
/// faces of each component agree with its first face.
struct Agreement {
    /// By face: its component. Components are in the order of their first faces.
    components: Vec<u32>,
    reverse: Vec<bool>,
    /// By component: the ends of an edge at which its faces cannot agree.
    conflicts: Vec<Option<[VertexId; 2]>>,
}

impl Agreement {
    /// Finds the components of a mesh whose faces agree.
    fn of_consistent(faces: &FaceList, incidence: &Incidence<'_>) -> Self {
        let mut classes = Classes::new(faces.len());
        for [a, b] in incidence.edges().filter_map(|edge| edge.pair()) {
            classes.join(a.face.index(), b.face.index());
        }
        let (components, count) = classes.into_numbers();
        Self {
            components,
            reverse: vec![false; faces.len()],
            conflicts: vec![None; count],
        }
    }

    /// Visits the faces of each component from its first face on, from neighbour to neighbour.
    fn new(faces: &FaceList, incidence: &Incidence<'_>) -> Self {
        let neighbours = side_neighbours(faces, incidence);
        let mut reverse: Vec<Option<bool>> = vec![None; faces.len()];
        let mut components = vec![0; faces.len()];
        let mut conflicts = Vec::new();
        let mut component = Vec::new();
        for (seed, _) in faces.iter() {
            if reverse[seed.index()].is_none() {
                component.clear();
                let conflict =
                    orient_component(seed, faces, &neighbours, &mut reverse, &mut component);
                for f in &component {
                    components[f.index()] = row(conflicts.len());
                }
                conflicts.push(conflict);
            }
        }
        Self {
            components,
            reverse: reverse
                .into_iter()
                .map(|reverse| reverse == Some(true))
                .collect(),
            conflicts,
        }
    }

    fn component(&self, f: FaceId) -> usize {
        self.components[f.index()] as usize
    }

    /// Returns for each component whether it faces inward after its faces in `reverse` are
    /// reversed; `None` if the component is open or encloses no volume.
    ///
    /// The sum of det(a, b, c) / 6 over all triangles is the signed volume. The coordinates are
    /// relative to a vertex of the component.
    fn faces_inward(&self, polygons: &PolygonMesh, incidence: &Incidence<'_>) -> Vec<Option<bool>> {
        let mut is_closed = vec![true; self.conflicts.len()];
        for edge in incidence.edges().filter(|edge| edge.len() != 2) {
            for side in edge.sides() {
                is_closed[self.component(side.face)] = false;
            }
        }
        let mut from: Vec<Option<DVec3>> = vec![None; self.conflicts.len()];
        let mut sums = vec![[0.0; 2]; self.conflicts.len()];
        for (f, face) in polygons.faces().iter() {
            let component = self.component(f);
            if !is_closed[component] {
                continue;
            }
            let at = |v: VertexId| polygons.position(v).as_dvec3();
            let from = *from[component].get_or_insert_with(|| at(face[0]));
            let sign = if self.reverse[f.index()] { -1.0 } else { 1.0 };
            let [volume, size] = &mut sums[component];
            let at = |v| at(v) - from;
            for pair in face[1..].windows(2) {
                let part = at(face[0]).dot(at(pair[0]).cross(at(pair[1])));
                *volume += sign * part;
                *size += part.abs();
            }
        }
        let inward = sums
            .iter()
            .zip(is_closed)
            .map(|(&[volume, size], is_closed)| {
                // If the terms cancel, the sum is only a rounding error.
                (is_closed && volume.abs() > 1e-9 * size).then_some(volume < 0.0)
            });
        inward.collect()
    }
}

/// The face across a side, and whether both faces run along the edge in the same direction.
type Neighbour = Option<(FaceId, bool)>;

/// Returns the neighbour across each side, if the edge has two faces.
fn side_neighbours(faces: &FaceList, incidence: &Incidence<'_>) -> Vec<Neighbour> {
    let mut neighbours = vec![None; faces.corners().len()];
    for [a, b] in incidence.edges().filter_map(|edge| edge.pair()) {
        let same = a.downward == b.downward;
        neighbours[a.corner as usize] = Some((b.face, same));
        neighbours[b.corner as usize] = Some((a.face, same));
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

/// Builds the mesh with these faces reversed. The faces are ascending. Each face keeps its first
/// corner.
fn reverse_faces(polygons: &PolygonMesh, reversed: &[FaceId]) -> PolygonMesh {
    let faces = polygons.faces();
    let mut list = FaceList::with_capacity(faces.corners().len());
    let mut next = reversed.iter().peekable();
    for (f, face) in faces.iter() {
        let pushed = if next.next_if(|&&reversed| reversed == f).is_some() {
            list.push(face[..1].iter().chain(face[1..].iter().rev()).copied())
        } else {
            list.push(face.iter().copied())
        };
        pushed.expect("the same number of corners as before");
    }
    PolygonMesh::from_faces(polygons.positions().to_vec(), list)
        .expect("each face has the same vertices as before")
}

#[cfg(test)]
mod tests {
    use proptest::collection;
    use proptest::prelude::*;
    use sixfold_conformance::strategy::manifold_mesh;
    use sixfold_core::Facts;

    use super::*;

    fn with_reversed(polygons: &PolygonMesh, reverse: impl Fn(usize) -> bool) -> PolygonMesh {
        let faces = polygons.faces().iter().map(|(f, _)| f);
        let reversed: Vec<FaceId> = faces.filter(|f| reverse(f.index())).collect();
        reverse_faces(polygons, &reversed)
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
            let faces = polygons.faces();
            let incidence = Incidence::new(polygons.vertex_count(), faces, |_| true);
            let neighbours = side_neighbours(faces, &incidence);
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
