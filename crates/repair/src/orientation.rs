//! Orientation repair: reverses faces until adjacent faces run along their shared edges in opposite
//! directions.

mod outward;

use std::fmt;

use sixfold_core::{Classes, FaceId, FaceList, Incidence, PolygonMesh, VertexId, row};

use self::outward::outward;
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
        /// Closed components face outward, or inward if they are the wall of a cavity: if an odd
        /// number of closed components is around them. Open components face the side to which they
        /// bulge. For components that are [`Undecided`], the rule [`Majority`](Self::Majority)
        /// applies.
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
    /// With [`Facing::Outward`] and [`Components::All`], the components of which the outside is not
    /// known, in the order of their first faces.
    pub undecided: Vec<Undecided>,
}

/// A component of which the outside is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Undecided {
    /// The first face of the component.
    pub face: FaceId,
    /// The number of faces of the component.
    pub faces: usize,
    /// The reason.
    pub reason: UndecidedReason,
}

/// The reason why the outside of a component is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum UndecidedReason {
    /// The component is closed, and touches or crosses another closed component, whose first face is
    /// this one. Or it is inside such a component.
    Touches(#[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))] FaceId),
    /// The component is closed, but encloses no volume.
    NoVolume,
    /// The component is open, and does not clearly bulge to one side.
    Flat,
    /// The component lies in an open component, whose first face is this one and which hides the outside
    /// from it in some directions only.
    PartlyInside(
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))] FaceId,
    ),
    /// Very many faces of open components are around the component. Those that hide the outside from it
    /// were not all counted.
    ManyAround,
}

impl fmt::Display for UndecidedReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Touches(face) => {
                write!(f, "touches or crosses that of face {face}, or is inside it")
            }
            Self::NoVolume => f.write_str("encloses no volume"),
            Self::Flat => f.write_str("is open and nearly flat"),
            Self::PartlyInside(face) => {
                write!(f, "is partly inside the open one of face {face}")
            }
            Self::ManyAround => f.write_str("has very many faces of open ones around it"),
        }
    }
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
/// With [`Facing::Outward`], a closed component is outside if an even number of closed components is
/// around it. So the wall of a cavity faces the cavity, and a solid inside the cavity faces outward
/// again. The volume of an open component is that of the component and of a cone from its boundary to
/// the centre of its boundary; the component faces outward if this volume is at least half as large
/// as the volumes of its parts without their signs.
///
/// # Errors
///
/// Returns [`OrientationError::NotOrientable`] with an edge if the faces of a component cannot have
/// a consistent orientation. To leave these components unchanged instead, call
/// [`oriented_components`].
///
/// # Complexity
///
/// O(n log n) time for n corners; for closed components whose bounding boxes overlap, expected.
pub fn oriented(polygons: &PolygonMesh, facing: Facing) -> Result<Oriented, OrientationError> {
    let OrientedComponents {
        polygons,
        reversed,
        not_orientable,
        ..
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
        undecided,
    } = faces_to_reverse(polygons, &incidence, facing, which);
    OrientedComponents {
        polygons: reverse_faces(polygons, &reversed),
        reversed,
        not_orientable,
        undecided,
    }
}

/// The faces that [`oriented_components`] reverses, and the components that are not orientable.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Reversal {
    pub(crate) reversed: Vec<FaceId>,
    pub(crate) not_orientable: Vec<NotOrientable>,
    pub(crate) undecided: Vec<Undecided>,
}

/// Returns the faces that [`oriented_components`] reverses, without building the mesh. `incidence`
/// must contain the sides of all faces of `polygons`.
pub(crate) fn faces_to_reverse(
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
    let count = agreement.conflicts.len();
    // By component: the number of faces, and of reversed faces.
    let mut sizes = vec![[0_usize; 2]; count];
    let mut first = vec![FaceId::new(0); count];
    for f in faces.iter().map(|(f, _)| f) {
        let component = agreement.component(f);
        if sizes[component][0] == 0 {
            first[component] = f;
        }
        sizes[component][0] += 1;
        sizes[component][1] += usize::from(agreement.reverse[f.index()]);
    }
    let is_chosen = |component: usize| match which {
        Components::All => true,
        Components::Inconsistent => sizes[component][1] > 0,
    };
    let sides = match facing {
        Facing::Outward if (0..count).any(is_chosen) => {
            Some(outward(polygons, incidence, &agreement, &first))
        }
        _ => None,
    };
    let side = |component: usize| sides.as_ref().map(|sides| sides[component]);
    let reverse_all: Vec<bool> = (0..count)
        .map(|component| {
            let [size, reversed] = sizes[component];
            match side(component) {
                Some(Ok(reverse)) if is_chosen(component) => reverse,
                _ => 2 * reversed > size,
            }
        })
        .collect();
    let is_reversed = |&f: &FaceId| {
        let component = agreement.component(f);
        let orientable = agreement.conflicts[component].is_none();
        orientable && agreement.reverse[f.index()] != reverse_all[component]
    };
    let components =
        || (0..count).map(|component| (component, first[component], sizes[component][0]));
    let not_orientable = components().filter_map(|(component, face, faces)| {
        let ends = agreement.conflicts[component]?;
        Some(NotOrientable { face, faces, ends })
    });
    let undecided = components().filter_map(|(component, face, faces)| {
        let reason = side(component)?.err()?;
        let is_named = which == Components::All && agreement.conflicts[component].is_none();
        is_named.then_some(Undecided {
            face,
            faces,
            reason,
        })
    });
    Reversal {
        reversed: faces.iter().map(|(f, _)| f).filter(is_reversed).collect(),
        not_orientable: not_orientable.collect(),
        undecided: undecided.collect(),
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
pub(crate) mod tests;
