//! Diagonals that are also sides of faces, or diagonals of other faces.

use crate::handles::handle::{HandleMap, HashHandleMap};
use crate::handles::pair::Pair;
use crate::handles::row_id::{FaceId, VertexId, row};
use crate::polygons::polygon_mesh::PolygonMesh;

/// Returns the faces of which a diagonal is also a side of a face, or a diagonal of a face before it;
/// ascending. `diagonals` are the diagonals of all faces, in the order of the faces.
///
/// A counting sort by the lower ends: O(corners), plus O(log n) for each side at a vertex with `n`
/// diagonals.
pub(super) fn faces(polygons: &PolygonMesh, diagonals: &[(Pair<VertexId>, FaceId)]) -> Vec<FaceId> {
    let mut conflicts = Vec::new();
    let sorted = ByLowerEnd::new(polygons.vertex_count(), diagonals);
    for low in polygons.vertices() {
        let same = sorted.at(low).windows(2);
        conflicts.extend(same.filter(|two| two[0].0 == two[1].0).map(|two| two[1].1));
    }
    for (_, face) in polygons.faces().iter() {
        for side in Pair::sides(face.len(), |i| face[i]) {
            let [low, high] = side.ends();
            let here = sorted.at(low);
            let from = here.partition_point(|&(end, _)| end < high);
            let same = here[from..].iter().take_while(|&&(end, _)| end == high);
            conflicts.extend(same.map(|&(_, f)| f));
        }
    }
    conflicts.sort_unstable();
    conflicts.dedup();
    conflicts
}

/// Returns the edges that the faces `again` must avoid: the sides of all faces and `diagonals`, of
/// which both ends are vertices of these faces.
pub(super) fn edges(
    polygons: &PolygonMesh,
    again: &[FaceId],
    diagonals: impl Iterator<Item = Pair<VertexId>>,
) -> HashHandleMap<Pair<VertexId>, bool> {
    let mut is_near = vec![false; polygons.vertex_count()];
    let corners = again.iter().flat_map(|&f| polygons.faces().face(f));
    corners.for_each(|v| is_near[v.index()] = true);
    let faces = polygons.faces().iter();
    let sides = faces.flat_map(|(_, face)| Pair::sides(face.len(), |i| face[i]));
    let mut edges = HashHandleMap::filled(0, false);
    for edge in sides.chain(diagonals) {
        if edge.ends().iter().all(|v| is_near[v.index()]) {
            edges[edge] = true;
        }
    }
    edges
}

/// Diagonals, sorted by their lower ends.
struct ByLowerEnd {
    /// By vertex: the end of its diagonals.
    ends: Vec<u32>,
    /// The higher end of each diagonal, and its face.
    sorted: Vec<(VertexId, FaceId)>,
}

impl ByLowerEnd {
    fn new(vertices: usize, diagonals: &[(Pair<VertexId>, FaceId)]) -> Self {
        // There are fewer diagonals than corners, so their number fits 32 bits.
        let mut ends = vec![0_u32; vertices];
        for (diagonal, _) in diagonals {
            ends[diagonal.ends()[0].index()] += 1;
        }
        let mut total = 0;
        for end in &mut ends {
            total += std::mem::replace(end, total);
        }
        let none = (VertexId::new(row(0)), FaceId::new(row(0)));
        let mut sorted = vec![none; diagonals.len()];
        for &(diagonal, f) in diagonals {
            let [low, high] = diagonal.ends();
            let at = &mut ends[low.index()];
            sorted[*at as usize] = (high, f);
            *at += 1;
        }
        let mut start = 0;
        for &end in &ends {
            sorted[start..end as usize].sort_unstable();
            start = end as usize;
        }
        Self { ends, sorted }
    }

    fn at(&self, low: VertexId) -> &[(VertexId, FaceId)] {
        let start = match low.index() {
            0 => 0,
            v => self.ends[v - 1] as usize,
        };
        &self.sorted[start..self.ends[low.index()] as usize]
    }
}
