//! All faults of a mesh, with their numbers and first places.

mod cracks;
mod fault;

use std::collections::BTreeMap;

use crate::orientation::{Components, Facing, UndecidedReason, faces_to_reverse};
use rustc_hash::FxHashMap;
use sixfold_core::{
    Capabilities, FaceId, Facts, Fans, Incidence, Pair, PolygonMesh, VertexId, join,
};

use crate::duplicates::Copies;
use crate::flat::is_flat;
use crate::measures::{Measures, measures_with};
use crate::step::Step;
use crate::weld::{PlaceNumbers, Places, Weld};
pub use cracks::Crack;
pub use fault::{Fault, FaultKind, Place};

/// All faults of a mesh.
///
/// ```
/// use sixfold_core::{MeshQuery, PolygonMesh};
/// use sixfold_half_edge::HalfEdgeMesh;
/// use sixfold_repair::{FaultKind, diagnose};
///
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
/// let mesh = PolygonMesh::new(points, [[0, 1, 2], [1, 2, 3]])?; // both run 1→2
/// let diagnosis = diagnose(&mesh, 10);
/// let refusals: Vec<_> = diagnosis.refusals(&HalfEdgeMesh::CAPABILITIES).collect();
/// assert_eq!(refusals.len(), 1);
/// assert_eq!(refusals[0].kind, FaultKind::RepeatedSide);
/// assert_eq!(refusals[0].to_string(), "1 edge along which two faces run in the same direction: v1–v2");
/// # Ok::<(), sixfold_core::PolygonError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Diagnosis {
    /// The faults that occur, in the order of [`FaultKind::ALL`].
    pub faults: Vec<Fault>,
    /// The number of vertices.
    pub vertices: usize,
    /// The number of different positions of vertices.
    pub positions: usize,
    /// The number of boundary edges.
    pub boundary_edges: usize,
    /// The number of boundary edges whose two ends have the same positions as the ends of another
    /// boundary edge, which runs in the opposite direction.
    pub seam_edges: usize,
    /// Boundaries that nearly meet, if there are any. [`Step::Weld`] closes them, but this can harm
    /// other parts: see [`Crack::is_safe`].
    pub crack: Option<Crack>,
}

impl Diagnosis {
    /// Returns the fault of this kind, if it occurs.
    pub fn fault(&self, kind: FaultKind) -> Option<&Fault> {
        self.faults.iter().find(|fault| fault.kind == kind)
    }

    /// Returns the faults for which a structure with these capabilities refuses the mesh; none if
    /// the structure holds it.
    ///
    /// Sizes are not checked: a structure can also refuse a mesh for more elements than its handles
    /// can name.
    pub fn refusals(&self, capabilities: &Capabilities) -> impl Iterator<Item = &Fault> {
        let faults = self.faults.iter();
        faults.filter(|fault| fault.kind.is_refused_by(capabilities))
    }

    /// Returns the steps that repair the faults of one kind in this mesh, in order: those of
    /// [`FaultKind::repairs`], after the steps that make a mesh an oriented manifold if they need one.
    /// If most boundary edges are seams or cracks, the steps for boundary edges weld them. Without steps
    /// if most boundary edges are cracks that cannot be welded without harm.
    pub fn repairs(&self, kind: FaultKind) -> Vec<Step> {
        let mut steps = Vec::new();
        if kind == FaultKind::BoundaryEdge && self.looks_unwelded() {
            return vec![Step::Weld(Weld::default())];
        }
        if let (FaultKind::BoundaryEdge, Some(crack)) = (kind, self.most_edges_crack()) {
            let safe = Some(crack).filter(Crack::is_safe);
            return safe.iter().flat_map(Crack::repairs).collect();
        }
        if kind == FaultKind::BoundaryEdge {
            // The first kind needs the most steps.
            let before = [
                FaultKind::RepeatedSide,
                FaultKind::NonManifoldEdge,
                FaultKind::NonManifoldVertex,
            ];
            let mut present = before
                .into_iter()
                .filter(|&kind| self.fault(kind).is_some());
            steps = present.next().map(FaultKind::repairs).unwrap_or_default();
        }
        steps.extend(kind.repairs());
        steps
    }

    /// Returns the crack if at least half of the boundary edges belong to it, and welding it does no
    /// harm ([`Crack::is_safe`]).
    pub fn wide_crack(&self) -> Option<Crack> {
        self.most_edges_crack().filter(Crack::is_safe)
    }

    fn most_edges_crack(&self) -> Option<Crack> {
        self.crack
            .filter(|crack| 2 * crack.edges >= self.boundary_edges)
    }

    /// Returns whether faces have vertices of their own where they should share them, as in files
    /// without shared vertices: at least half of the boundary edges are seams. [`Step::Weld`]
    /// repairs this.
    pub fn looks_unwelded(&self) -> bool {
        self.seam_edges > 0 && 2 * self.seam_edges >= self.boundary_edges
    }
}

/// Finds all faults of a mesh. For each kind of fault, the first `places` places are listed.
///
/// O(n log n) for n corners, plus the time to cut the polygons. With the feature `rayon`, runs on two
/// threads.
pub fn diagnose(polygons: &PolygonMesh, places: usize) -> Diagnosis {
    let (positions, incidence) = prepare(polygons);
    let fans = Fans::new(&incidence);
    let (crossing, found) = join(
        || polygons.crossing_faces(),
        || find(polygons, &fans, &positions, places),
    );
    found.diagnosis(polygons, &fans, &positions, &crossing)
}

/// Returns the facts of a mesh, its measures and its diagnosis, as [`Facts::from_polygons`],
/// [`measures`](crate::measures) and [`diagnose`] return them, in less time and memory than these
/// calls.
///
/// O(n log n) for n corners, plus the time to cut the polygons. With the feature `rayon`, runs on two
/// threads.
pub fn examine(polygons: &PolygonMesh, places: usize) -> (Facts, Measures, Diagnosis) {
    let (positions, incidence) = prepare(polygons);
    let fans = Fans::new(&incidence);
    let ((facts, (measures, crossing)), found) = join(
        || {
            let measures = measures_with(polygons, fans.incidence());
            (Facts::from_fans(&fans), measures)
        },
        || find(polygons, &fans, &positions, places),
    );
    let diagnosis = found.diagnosis(polygons, &fans, &positions, &crossing);
    (facts, measures, diagnosis)
}

fn prepare(polygons: &PolygonMesh) -> (PlaceNumbers, Incidence<'_>) {
    join(
        || Places::new(polygons.positions()).into_numbers(),
        || Incidence::new(polygons.vertex_count(), polygons.faces(), |_| true),
    )
}

/// Finds the faults, except the faces that cross themselves.
fn find(polygons: &PolygonMesh, fans: &Fans<'_>, positions: &PlaceNumbers, places: usize) -> Found {
    let incidence = fans.incidence();
    let (mut found, in_faces) = join(
        || {
            let mut found = Found::new(places);
            find_edges(incidence, &mut found);
            find_turned(polygons, incidence, &mut found);
            found
        },
        || {
            let mut found = Found::new(places);
            find_vertices(polygons, fans, positions, &mut found);
            find_faces(polygons, positions, &mut found);
            found
        },
    );
    found.faults.extend(in_faces.faults);
    found
}

/// The faults while they are counted.
struct Found {
    limit: usize,
    faults: BTreeMap<FaultKind, Fault>,
}

impl Found {
    fn new(limit: usize) -> Self {
        Self {
            limit,
            faults: BTreeMap::new(),
        }
    }

    fn add(&mut self, kind: FaultKind, place: Place) {
        let fault = self.faults.entry(kind).or_insert_with(|| Fault::none(kind));
        fault.count += 1;
        if fault.places.len() < self.limit {
            fault.places.push(place);
        }
    }

    /// Returns the diagnosis; `crossing` are the faces that cross themselves.
    fn diagnosis(
        mut self,
        polygons: &PolygonMesh,
        fans: &Fans<'_>,
        positions: &PlaceNumbers,
        crossing: &[FaceId],
    ) -> Diagnosis {
        for &f in crossing {
            self.add(FaultKind::CrossingFace, Place::Face(f));
        }
        let incidence = fans.incidence();
        let boundary = self.faults.get(&FaultKind::BoundaryEdge);
        let boundary_edges = boundary.map_or(0, |fault| fault.count);
        let in_order = FaultKind::ALL.iter();
        Diagnosis {
            faults: in_order
                .filter_map(|kind| self.faults.remove(kind))
                .collect(),
            vertices: polygons.vertex_count(),
            positions: positions.len(),
            boundary_edges,
            seam_edges: match boundary_edges {
                0 => 0,
                _ => seam_edges(incidence, positions),
            },
            crack: match boundary_edges {
                0 => None,
                _ => cracks::crack(polygons, incidence),
            },
        }
    }
}

fn find_edges(incidence: &Incidence<'_>, found: &mut Found) {
    incidence.edges().for_each(|edge| {
        let place = Place::Edge(edge.ends);
        let down = edge.downward();
        if edge.len() == 1 {
            found.add(FaultKind::BoundaryEdge, place);
        }
        if edge.len() > 2 {
            found.add(FaultKind::NonManifoldEdge, place);
        }
        if edge.len() == 2 && down != 1 {
            found.add(FaultKind::RepeatedSide, place);
        }
    });
}

fn find_vertices(
    polygons: &PolygonMesh,
    fans: &Fans<'_>,
    positions: &PlaceNumbers,
    found: &mut Found,
) {
    let several = fans.several();
    let mut several: Vec<VertexId> = several.into_iter().map(|(v, _)| v).collect();
    several.sort_unstable();
    for v in several {
        found.add(FaultKind::NonManifoldVertex, Place::Vertex(v));
    }
    let has_faces = polygons.has_faces();
    let mut is_first = vec![true; positions.len()];
    for v in polygons.vertices() {
        if !has_faces[v.index()] {
            found.add(FaultKind::IsolatedVertex, Place::Vertex(v));
        }
        if !polygons.position(v).is_finite() {
            found.add(FaultKind::NotFiniteVertex, Place::Vertex(v));
        }
        if !std::mem::replace(&mut is_first[positions.place(v) as usize], false) {
            found.add(FaultKind::CoincidentVertex, Place::Vertex(v));
        }
    }
}

fn find_faces(polygons: &PolygonMesh, positions: &PlaceNumbers, found: &mut Found) {
    let copies = Copies::new(polygons);
    let mut at = Vec::new();
    for (f, face) in polygons.faces().iter() {
        let place = Place::Face(f);
        if face.len() > 3 {
            found.add(FaultKind::Polygon, place);
        }
        at.clear();
        at.extend(face.iter().map(|&v| positions.place(v)));
        at.sort_unstable();
        if at.windows(2).any(|pair| pair[0] == pair[1]) {
            found.add(FaultKind::CoincidentCorners, place);
        }
        if is_flat(polygons, f) {
            found.add(FaultKind::FlatFace, place);
        }
        let (first, opposite) = copies.first_copies(f);
        if first != f {
            found.add(FaultKind::DuplicateFace, place);
        }
        if opposite.is_some() {
            found.add(FaultKind::OppositeFace, place);
        }
    }
}

fn find_turned(polygons: &PolygonMesh, incidence: &Incidence<'_>, found: &mut Found) {
    let turned = faces_to_reverse(polygons, incidence, Facing::Outward, Components::All);
    for f in turned.reversed {
        found.add(FaultKind::TurnedFace, Place::Face(f));
    }
    for component in turned.undecided {
        if let UndecidedReason::Touches(_) = component.reason {
            found.add(FaultKind::TouchingComponent, Place::Face(component.face));
        }
    }
    for component in turned.not_orientable {
        found.add(FaultKind::NotOrientable, Place::Edge(component.ends));
    }
}

/// Returns the number of boundary edges that lie on another boundary edge and run against it.
fn seam_edges(incidence: &Incidence<'_>, positions: &PlaceNumbers) -> usize {
    // By pair of places: the boundary edges that run from the lower place to the higher, and the
    // others.
    let mut at: FxHashMap<Pair<VertexId>, [usize; 2]> = FxHashMap::default();
    for edge in incidence.edges() {
        if let Some(side) = edge.single() {
            let [low, high] = edge.ends.map(|v| VertexId::new(positions.place(v)));
            if low != high {
                let direction = usize::from(side.downward ^ (low > high));
                at.entry(Pair::new(low, high)).or_default()[direction] += 1;
            }
        }
    }
    // The order of the pairs does not change a sum.
    at.into_values().map(|[up, down]| 2 * up.min(down)).sum()
}

#[cfg(test)]
mod tests;
