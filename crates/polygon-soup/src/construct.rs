//! Building from polygons, and conversion to polygons.

use rustc_hash::{FxHashMap, FxHashSet};
use sixfold_core::{
    BuildError, Counts, EditLog, Editing, FaceId, FaceList, Handle, InvariantError, IteratorExt,
    Measured, MemoryFootprint, MeshMove, MeshQuery, MoveError, Pair, Point, PolygonMesh, Probe,
    QueryCost, Representation, ShortVec, VertexId, VertexMap, row, uses_reports,
};
use sixfold_scanning::{ScannedFaces, ScannedVertex};

use crate::mesh::PolygonSoup;
use crate::vertex::SoupVertex;

impl<E: Editing> Representation for PolygonSoup<E> {
    const NAME: &'static str = "polygon-soup";

    const COSTS: [QueryCost; 9] = {
        use QueryCost::{Constant, Scan};
        [
            Scan, Scan, Scan, Constant, Scan, Scan, Constant, Constant, Scan,
        ]
    };

    sixfold_core::type_path!(PolygonSoup);

    /// Copies the position of every corner; O(corners).
    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        let (positions, faces) = (polygons.positions(), polygons.faces());
        let corners = faces.corners().iter();
        let corners = corners.map(|v| canonical(positions[v.index()])).collect();
        let mesh = Self {
            faces: ScannedFaces::new(corners, faces.spans()),
        };
        if polygons.has_faces().contains(&false)
            || mesh
                .faces()
                .any(|f| has_coincident_corners(mesh.face_positions(f)))
        {
            Self::CAPABILITIES.check(polygons)?;
        }
        Ok(mesh)
    }

    /// Numbers the vertices in the order of `vertices()`. Takes O(corners) expected time.
    fn to_polygons(&self) -> PolygonMesh {
        let mut names: FxHashMap<SoupVertex, VertexId> = FxHashMap::default();
        let mut positions = Vec::new();
        let mut faces = FaceList::with_capacity(self.corners().len());
        for f in self.faces() {
            let corners = self.face_vertices(f).map(|v| {
                *names.entry(v).or_insert_with(|| {
                    positions.push(v.position());
                    VertexId::new(row(positions.len() - 1))
                })
            });
            faces
                .push(corners)
                .expect("no more corners than in the table");
        }
        PolygonMesh::from_faces(positions, faces)
            .expect("I1 and I3: the corners of a face are distinct")
    }

    fn vertex_handle(polygons: &PolygonMesh, v: VertexId) -> SoupVertex {
        SoupVertex::at(polygons.position(v))
    }

    fn face_handle(_: &PolygonMesh, f: FaceId) -> FaceId {
        f
    }

    fn memory(&self) -> MemoryFootprint {
        self.table_bytes()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        self.check_invariants()
    }
}

impl<E: Editing, P: Probe> MeshMove for PolygonSoup<E, P> {
    /// Moves every corner to the position that the map has for its vertex. Takes O(corners)
    /// expected time.
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError> {
        let corners = self.corners().iter();
        let moved = corners.map(|corner| {
            // A corner of no face stays blank.
            if SoupVertex::BLANK.is_at(corner) {
                return *corner;
            }
            canonical(positions[SoupVertex::from_corner(*corner)])
        });
        let moved: Vec<Point> = moved.collect();
        for face in self.faces() {
            if has_coincident_corners(&moved[self.spans().range(face)]) {
                return Err(MoveError::CoincidentCorners { face });
            }
        }
        if uses_reports::<Self, _>(log) {
            self.report_moves(&moved, log);
        }
        self.faces.corners.rows_mut().copy_from_slice(&moved);
        Ok(())
    }
}

impl<E: Editing, P: Probe> PolygonSoup<E, P> {
    /// Reports the new handles of vertices and edges when the corners move to `moved`; O(corners)
    /// expected.
    fn report_moves(&self, moved: &[Point], log: &mut impl EditLog<Self>) {
        let (mut vertices, mut edges) = (Renamings::default(), Renamings::default());
        for face in self.faces() {
            let range = self.spans().range(face);
            let old = self.corners()[range.clone()].iter();
            let new = moved[range].iter();
            let corner = |(&old, &new)| [old, new].map(SoupVertex::from_corner);
            let corners: ShortVec<[SoupVertex; 2]> = old.zip(new).map(corner).collect();
            for (i, &[old, new]) in corners.iter().enumerate() {
                match vertices.of(old, new) {
                    Some(Renaming::Renamed) => log.renamed_vertex(old, new),
                    Some(Renaming::Merged) => log.removed_vertex(old),
                    None => {}
                }
                let [next_old, next_new] = corners[(i + 1) % corners.len()];
                let (old, new) = (Pair::new(old, next_old), Pair::new(new, next_new));
                match edges.of(old, new) {
                    Some(Renaming::Renamed) => log.renamed_edge(old, new),
                    Some(Renaming::Merged) => log.removed_edge(old),
                    None => {}
                }
            }
        }
    }
}

/// The old and new handles seen so far.
struct Renamings<H> {
    old: FxHashSet<H>,
    new: FxHashSet<H>,
}

enum Renaming {
    Renamed,
    /// Another element already has the new handle.
    Merged,
}

impl<H> Default for Renamings<H> {
    fn default() -> Self {
        Self {
            old: FxHashSet::default(),
            new: FxHashSet::default(),
        }
    }
}

impl<H: Handle> Renamings<H> {
    /// Returns what happens to the element `old`, whose new handle is `new`; `None` if its handle
    /// stays, or if the element was seen before.
    fn of(&mut self, old: H, new: H) -> Option<Renaming> {
        if !self.old.insert(old) {
            return None;
        }
        match self.new.insert(new) {
            true => (old != new).then_some(Renaming::Renamed),
            false => Some(Renaming::Merged),
        }
    }
}

impl<E: Editing> Measured for PolygonSoup<E> {
    type Probed<P: Probe> = PolygonSoup<E, P>;

    fn layout_bytes(counts: &Counts) -> usize {
        size_of::<Point>() * counts.corners + counts.offset_bytes()
    }

    fn probed<P: Probe>(self, probe: P) -> PolygonSoup<E, P> {
        self.with_probe(probe)
    }
}

/// Returns `point` with 0 instead of −0 (I2).
#[inline]
fn canonical(point: Point) -> Point {
    SoupVertex::at(point).position()
}

/// Returns whether two corners of a face are at the same position. The coordinates must not be −0.
#[inline]
fn has_coincident_corners(face: &[Point]) -> bool {
    match *face {
        [a, b, c] => {
            let [a, b, c] = [a, b, c].map(SoupVertex::from_corner);
            a == b || b == c || c == a
        }
        _ => has_repeated_corners(face),
    }
}

/// Does the same for a face of any degree.
fn has_repeated_corners(face: &[Point]) -> bool {
    let corners = face.iter().map(|&p| SoupVertex::from_corner(p));
    corners.distinct().count() < face.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PolygonSoup;

    fn build(positions: &[Point], faces: &[&[u32]]) -> Result<PolygonSoup, BuildError> {
        PolygonSoup::from_polygons(
            &PolygonMesh::new(positions.iter().copied(), faces).expect("valid"),
        )
    }

    #[test]
    fn vertices_with_equal_coordinates_become_one() {
        let [a, b, c, d] = [Point::ZERO, Point::X, Point::ONE, Point::Y];
        let positions = [a, b, c, Point::new(0.0, -0.0, 0.0), c, d];
        let soup = build(&positions, &[&[0, 1, 2], &[3, 4, 5]]).expect("no face has both");
        assert_eq!(
            soup.vertices()
                .map(SoupVertex::position)
                .collect::<Vec<_>>(),
            [a, b, c, d]
        );
        let welded = PolygonMesh::new([a, b, c, d], [[0, 1, 2], [0, 2, 3]]).expect("valid");
        assert_eq!(soup.to_polygons(), welded);
    }

    #[test]
    fn isolated_and_coincident_vertices_are_refused() {
        let [a, b, c, d] = [Point::ZERO, Point::X, Point::ONE, Point::Y];
        let isolated = build(&[a, b, c, d], &[&[0, 1, 3]]);
        let vertex = VertexId::new(2);
        assert_eq!(
            isolated.unwrap_err(),
            BuildError::IsolatedVertex { vertex, count: 1 }
        );
        for face in [
            &[0, 1, 2][..],
            &[1, 0, 2],
            &[0, 2, 1],
            &[0, 1, 2, 3],
            &[3, 0, 1, 2],
        ] {
            let coincident = build(&[a, b, -a, d], &[face, &[1, 2, 3]]).unwrap_err();
            let BuildError::CoincidentCorners { face, mut vertices } = coincident else {
                panic!("{coincident}");
            };
            vertices.sort_unstable();
            assert_eq!((face.index(), vertices.map(VertexId::index)), (0, [0, 2]));
        }
    }

    #[test]
    fn moving_a_vertex_moves_all_its_corners() {
        let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
        let mut soup = build(&square, &[&[0, 1, 2], &[0, 2, 3]]).expect("valid");
        let mut moved = soup.vertex_map(Point::ZERO);
        for v in soup.vertices() {
            moved[v] = v.position() - Point::X;
        }
        soup.set_positions(&moved).expect("no vertices coincide");
        assert_eq!(soup.validate(), Ok(()), "1 − 1 and −0 are stored as 0");
        let expected = square.map(|p| SoupVertex::at(p - Point::X));
        assert!(soup.vertices().eq(expected));
    }

    #[test]
    fn a_move_that_makes_corners_coincide_is_refused() {
        let mut soup = build(&[Point::ZERO, Point::X, Point::Y], &[&[0, 1, 2]]).expect("valid");
        let before = soup.corners().to_vec();
        let mut moved = soup.vertex_map(Point::X);
        moved[SoupVertex::at(Point::Y)] = Point::Y;
        let refusal = soup.set_positions(&moved).unwrap_err();
        assert_eq!(
            refusal,
            MoveError::CoincidentCorners {
                face: FaceId::new(0)
            }
        );
        assert_eq!(soup.corners(), before, "nothing has moved");
    }

    #[test]
    fn memory_equals_the_layout_formula() {
        let [a, b, c, d] = [Point::ZERO, Point::X, Point::Y, Point::Z];
        let faces: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
        let tetrahedron = build(&[a, b, c, d], &faces).expect("valid");
        assert_eq!(tetrahedron.memory().total(), 4 * 3 * 12);
        let pyramid: [&[u32]; 2] = [&[0, 1, 2, 3], &[1, 0, 3]];
        let mixed = build(&[a, b, c, d], &pyramid).expect("valid");
        let counts = Counts {
            vertices: 4,
            edges: 5,
            faces: 2,
            corners: 7,
            uniform: false,
        };
        assert_eq!(mixed.memory().total(), 7 * 12 + 3 * 4);
        assert_eq!(PolygonSoup::layout_bytes(&counts), 7 * 12 + 3 * 4);
    }
}
