//! Sharpness of edges and vertices under subdivision.

use rustc_hash::FxHashSet;

use crate::handles::pair::Pair;
use crate::handles::row_id::VertexId;
use crate::polygons::error::CreaseError;
use crate::polygons::polygon_mesh::PolygonMesh;

/// The smallest sharpness that counts as infinite. Unlike a finite sharpness, an infinite sharpness
/// does not decrease from one subdivision level to the next.
pub const SHARPNESS_INFINITE: f32 = 10.0;

/// The sharpness of edges and vertices of a [`PolygonMesh`]. An edge or vertex without an entry has
/// sharpness 0.
///
/// Sharpness is the number of subdivision levels for which an edge or a vertex stays sharp. The
/// number may be fractional. If the sharpness is [`SHARPNESS_INFINITE`] or more, the edge or vertex
/// stays sharp at every level (DeRose, Kass & Truong 1998).
///
/// # Invariants
///
/// Edges (lower end first) and vertices are sorted, and each occurs at most once. Every sharpness
/// is above 0 and not NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Creases {
    edges: Vec<(Pair<VertexId>, f32)>,
    corners: Vec<(VertexId, f32)>,
}

impl Creases {
    /// Builds the creases of `polygons` from sharp edges and sharp vertices; O(corners) expected.
    /// An edge is given by its two ends in either order. A later entry replaces an earlier entry of
    /// the same edge or vertex; sharpness 0 removes the entry.
    ///
    /// # Errors
    ///
    /// Returns an error for the first entry that is not a vertex or an edge of `polygons`, or whose
    /// sharpness is negative or NaN. Edges are checked before vertices.
    pub fn new(
        polygons: &PolygonMesh,
        edges: impl IntoIterator<Item = ([u32; 2], f32)>,
        corners: impl IntoIterator<Item = (u32, f32)>,
    ) -> Result<Self, CreaseError> {
        let vertices = polygons.vertex_count();
        let check = |entry, vertex: u32, sharpness: f32| {
            if vertex as usize >= vertices {
                return Err(CreaseError::MissingVertex {
                    entry,
                    vertex,
                    vertices,
                });
            }
            if sharpness.is_nan() || sharpness < 0.0 {
                return Err(CreaseError::BadSharpness { entry, sharpness });
            }
            Ok(VertexId::new(vertex))
        };
        let mut known: Option<FxHashSet<Pair<VertexId>>> = None;
        let mut creases = Self::default();
        for (entry, ([a, b], sharpness)) in edges.into_iter().enumerate() {
            let (a, b) = (check(entry, a, sharpness)?, check(entry, b, sharpness)?);
            let known = known.get_or_insert_with(|| all_edges(polygons));
            if !known.contains(&Pair::new(a, b)) {
                return Err(CreaseError::NotAnEdge {
                    entry,
                    ends: [a, b],
                });
            }
            creases.edges.push((Pair::new(a, b), sharpness));
        }
        for (entry, (vertex, sharpness)) in corners.into_iter().enumerate() {
            let vertex = check(entry, vertex, sharpness)?;
            creases.corners.push((vertex, sharpness));
        }
        Ok(Self::from_entries(creases.edges, creases.corners))
    }

    /// Builds creases from entries in any order. The edges and vertices must exist in the mesh to
    /// which the creases are applied; this function does not check them. If an edge or vertex has several entries, the last entry counts. Entries of sharpness 0 are
    /// dropped.
    pub fn from_entries(
        mut edges: Vec<(Pair<VertexId>, f32)>,
        mut corners: Vec<(VertexId, f32)>,
    ) -> Self {
        last_of_each(&mut edges);
        last_of_each(&mut corners);
        Self { edges, corners }
    }

    /// Returns `self` combined with `later`. An entry of `later` replaces the entry of the same
    /// edge or vertex.
    pub fn updated_with(&self, later: &Self) -> Self {
        let edges = [&self.edges[..], &later.edges].concat();
        Self::from_entries(edges, [&self.corners[..], &later.corners].concat())
    }

    /// Returns true if no edge and no vertex is sharp.
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty() && self.corners.is_empty()
    }

    /// Returns the sharp edges with their sharpness, sorted by their ends.
    pub fn edges(&self) -> &[(Pair<VertexId>, f32)] {
        &self.edges
    }

    /// Returns the sharp vertices with their sharpness, sorted by vertex.
    pub fn corners(&self) -> &[(VertexId, f32)] {
        &self.corners
    }

    /// Returns the sharpness of the edge between `a` and `b`; O(log n) for n sharp edges.
    pub fn edge(&self, a: VertexId, b: VertexId) -> f32 {
        let pair = Pair::new(a, b);
        let found = self.edges.binary_search_by_key(&pair, |&(edge, _)| edge);
        found.map_or(0.0, |at| self.edges[at].1)
    }

    /// Returns the sharpness of vertex `v`; O(log n) for n sharp vertices.
    pub fn corner(&self, v: VertexId) -> f32 {
        let found = self.corners.binary_search_by_key(&v, |&(vertex, _)| vertex);
        found.map_or(0.0, |at| self.corners[at].1)
    }
}

fn all_edges(polygons: &PolygonMesh) -> FxHashSet<Pair<VertexId>> {
    let faces = polygons.faces().iter();
    faces
        .flat_map(|(_, face)| Pair::sides(face.len(), |i| face[i]))
        .collect()
}

/// Sorts entries by key, keeps the last entry of each key, and drops entries of sharpness 0.
fn last_of_each<K: Ord + Copy>(entries: &mut Vec<(K, f32)>) {
    // After the reversal and a stable sort, the last entry of each key comes first.
    entries.reverse();
    entries.sort_by_key(|&(key, _)| key);
    entries.dedup_by_key(|&mut (key, _)| key);
    entries.retain(|&(_, sharpness)| sharpness > 0.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Point;

    fn square() -> PolygonMesh {
        let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y];
        PolygonMesh::new(corners, [[0, 1, 2, 3]]).expect("valid")
    }

    #[test]
    fn a_later_entry_replaces_an_earlier_one_and_zero_removes_it() {
        let edges = [
            ([1, 0], 2.0),
            ([2, 3], 1.0),
            ([0, 1], 3.0),
            ([1, 2], f32::INFINITY),
            ([3, 2], 0.0),
        ];
        let creases = Creases::new(&square(), edges, [(3, 0.5), (0, 0.0)]).expect("valid");
        let [a, b, c, d] = [0, 1, 2, 3].map(VertexId::new);
        assert_eq!(creases.edge(a, b), 3.0);
        assert_eq!(creases.edge(c, b), f32::INFINITY);
        assert_eq!(creases.edge(c, d), 0.0);
        assert_eq!(creases.edges().len(), 2);
        assert_eq!(creases.corners(), [(d, 0.5)]);
        assert_eq!(creases.corner(a), 0.0);
    }

    #[test]
    fn each_fault_has_its_error() {
        let error_of = |edges: Vec<([u32; 2], f32)>, corners: Vec<(u32, f32)>| {
            Creases::new(&square(), edges, corners).unwrap_err()
        };
        let sharp = ([0, 1], 1.0);
        assert_eq!(
            error_of(vec![sharp, ([0, 2], 1.0)], vec![]),
            CreaseError::NotAnEdge {
                entry: 1,
                ends: [0, 2].map(VertexId::new)
            }
        );
        assert_eq!(
            error_of(vec![([0, 4], 1.0)], vec![]),
            CreaseError::MissingVertex {
                entry: 0,
                vertex: 4,
                vertices: 4
            }
        );
        assert!(matches!(
            error_of(vec![sharp], vec![(0, 1.0), (1, -0.5)]),
            CreaseError::BadSharpness { entry: 1, .. }
        ));
        assert!(matches!(
            error_of(vec![([0, 1], f32::NAN)], vec![]),
            CreaseError::BadSharpness { entry: 0, .. }
        ));
        assert!(matches!(
            error_of(vec![([1, 1], 1.0)], vec![]),
            CreaseError::NotAnEdge { .. }
        ));
    }
}
