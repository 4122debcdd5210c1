//! All faults of a mesh, with their numbers and first places.

mod fault;

use rustc_hash::FxHashMap;
use sixfold_core::{Capabilities, Incidence, Pair, PolygonMesh, VertexId};
use sixfold_operators::{Components, Facing, faces_to_reverse};

use crate::duplicates::Copies;
use crate::flat::is_flat;
use crate::step::Step;
use crate::weld::Places;
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
    pub fn repairs(&self, kind: FaultKind) -> Vec<Step> {
        let mut steps = Vec::new();
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

    /// Returns whether faces have vertices of their own where they should share them, as in files
    /// without shared vertices: at least half of the boundary edges are seams. [`Step::Weld`]
    /// repairs this.
    pub fn looks_unwelded(&self) -> bool {
        self.seam_edges > 0 && 2 * self.seam_edges >= self.boundary_edges
    }
}

/// Finds all faults of a mesh. For each kind of fault, the first `places` places are listed.
///
/// O(n log n) for n corners.
pub fn diagnose(polygons: &PolygonMesh, places: usize) -> Diagnosis {
    let mut found = Found {
        limit: places,
        faults: FaultKind::ALL.map(Fault::none),
    };
    let positions = Places::new(polygons.positions());
    let incidence = Incidence::new(polygons.vertex_count(), polygons.faces(), |_| true);
    find_edges(&incidence, &mut found);
    find_vertices(polygons, &incidence, &positions, &mut found);
    find_faces(polygons, &positions, &mut found);
    find_turned(polygons, &incidence, &mut found);
    let boundary_edges = found.faults[FaultKind::BoundaryEdge as usize].count;
    let present = found.faults.into_iter().filter(|fault| fault.count > 0);
    Diagnosis {
        faults: present.collect(),
        vertices: polygons.vertex_count(),
        positions: positions.len(),
        boundary_edges,
        seam_edges: seam_edges(&incidence, &positions),
    }
}

/// The faults while they are counted, in the order of [`FaultKind::ALL`].
struct Found {
    limit: usize,
    faults: [Fault; FaultKind::ALL.len()],
}

impl Found {
    fn add(&mut self, kind: FaultKind, place: Place) {
        let fault = &mut self.faults[kind as usize];
        fault.count += 1;
        if fault.places.len() < self.limit {
            fault.places.push(place);
        }
    }
}

fn find_edges(incidence: &Incidence, found: &mut Found) {
    for edge in incidence.edges() {
        let place = Place::Edge(edge.ends);
        let down = edge.sides.iter().filter(|side| side.downward).count();
        if edge.sides.len() == 1 {
            found.add(FaultKind::BoundaryEdge, place);
        }
        if edge.sides.len() > 2 {
            found.add(FaultKind::NonManifoldEdge, place);
        }
        if down > 1 || edge.sides.len() - down > 1 {
            found.add(FaultKind::RepeatedSide, place);
        }
    }
}

fn find_vertices(
    polygons: &PolygonMesh,
    incidence: &Incidence,
    positions: &Places,
    found: &mut Found,
) {
    let several = incidence.several_fans(polygons.faces());
    let mut several: Vec<VertexId> = several.into_iter().map(|(v, _)| v).collect();
    several.sort_unstable();
    for v in several {
        found.add(FaultKind::NonManifoldVertex, Place::Vertex(v));
    }
    let mut is_used = vec![false; polygons.vertex_count()];
    for v in polygons.faces().corners() {
        is_used[v.index()] = true;
    }
    let mut is_first = vec![true; positions.len()];
    for v in polygons.vertices() {
        if !is_used[v.index()] {
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

fn find_faces(polygons: &PolygonMesh, positions: &Places, found: &mut Found) {
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

fn find_turned(polygons: &PolygonMesh, incidence: &Incidence, found: &mut Found) {
    let turned = faces_to_reverse(polygons, incidence, Facing::Outward, Components::All);
    for f in turned.reversed {
        found.add(FaultKind::TurnedFace, Place::Face(f));
    }
    for component in turned.not_orientable {
        found.add(FaultKind::NotOrientable, Place::Edge(component.ends));
    }
}

/// Returns the number of boundary edges that lie on another boundary edge and run against it.
fn seam_edges(incidence: &Incidence, positions: &Places) -> usize {
    // By pair of places: the boundary edges that run from the lower place to the higher, and the
    // others.
    let mut at: FxHashMap<Pair<VertexId>, [usize; 2]> = FxHashMap::default();
    for edge in incidence.edges() {
        if let [side] = edge.sides {
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
