//! Building from polygons, and conversion to polygons.

use sixfold_core::{
    BuildError, Counts, Editing, FACE_HOLES, FaceList, HoleSet, InvariantError, Measured,
    MemoryFootprint, MeshQuery, PolygonMesh, Probe, QueryCost, Representation, RowId, Slot, Table,
    Untraced, VERTEX_HOLES, VertexId, pair_triangle_sides,
};

use crate::mesh::{CornerId, CornerTable};

impl<E: Editing> Representation for CornerTable<E> {
    const NAME: &'static str = "corner-table";

    const COSTS: [QueryCost; 9] = [QueryCost::Constant; 9];

    sixfold_core::type_path!(CornerTable);

    /// Pairs the sides, links the corners that face a pair, then sets `corner` of each vertex;
    /// O(corners + vertices).
    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        let refusal = || Self::CAPABILITIES.build_error(polygons);
        let (vertices, faces) = (polygons.vertex_count(), polygons.faces());
        if !faces.is_empty() && faces.uniform_degree() != Some(3) {
            return Err(refusal());
        }
        // First the scratch memory of the pairing, later the table of vertices.
        let mut vertex = vec![VertexId::new(0); faces.corners().len()];
        let links = Links::from_faces(vertices, faces, &mut vertex).ok_or_else(refusal)?;
        vertex.copy_from_slice(faces.corners());
        let corner = links.first_corners(vertices, &vertex);
        if !links.every_vertex_is_one_fan(&corner) {
            return Err(refusal());
        }
        Ok(Self {
            positions: Table::new("positions", "vertex", polygons.positions().to_vec()),
            corner: Table::new("corner", "vertex", corner),
            vertex: Table::new("vertex", "corner", vertex),
            opposite: Table::new("opposite", "corner", links.opposite),
            vertex_holes: E::no_holes(VERTEX_HOLES, Untraced),
            face_holes: E::no_holes(FACE_HOLES, Untraced),
        })
    }

    fn to_polygons(&self) -> PolygonMesh {
        let (positions, corners) = if self.vertex_holes.is_empty() && self.face_holes.is_empty() {
            (self.positions().to_vec(), self.corner_vertices().to_vec())
        } else {
            let new = self.vertex_holes.new_rows(self.positions.len());
            let corners = self.faces().flat_map(|t| self.vertices_of(t));
            let corners = corners.map(|v| VertexId::new(new[v.index()]));
            let positions = self.vertices().map(|v| self.position(v));
            (positions.collect(), corners.collect())
        };
        let faces = FaceList::uniform(3, corners).expect("I1");
        PolygonMesh::from_faces(positions, faces).expect("I1")
    }

    sixfold_core::row_handles!();

    fn memory(&self) -> MemoryFootprint {
        self.table_bytes()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        crate::validate::validate(self)
    }
}

sixfold_core::moving_positions!(CornerTable);
sixfold_core::local_queries!(crate::CornerTable, crate::EditableCornerTable);

impl<E: Editing> Measured for CornerTable<E> {
    type Probed<P: Probe> = CornerTable<E, P>;

    fn layout_bytes(counts: &Counts) -> usize {
        16 * counts.vertices + 8 * counts.corners
    }

    fn probed<P: Probe>(self, probe: P) -> CornerTable<E, P> {
        self.with_probe(probe)
    }
}

struct Links {
    /// The corner that faces the same edge from the other side.
    opposite: Vec<Slot<CornerId>>,
    /// The row of the next corner around the vertex; `u32::MAX` at the end of an open fan.
    swing: Vec<u32>,
    /// Whether the mesh has no boundary.
    closed: bool,
}

impl Links {
    /// Finds the opposite of each corner; O(corners + vertices). Returns `None` if the sides cannot
    /// be paired. `scratch` has one row per corner.
    fn from_faces(vertices: usize, faces: &FaceList, scratch: &mut [VertexId]) -> Option<Self> {
        let mut opposite = vec![Slot::some(CornerId::new(0)); faces.corners().len()];
        let (mut swing, edges) = pair_triangle_sides(vertices, faces, scratch, |own, across| {
            let [own, across] = [own, across].map(CornerId::new);
            opposite[own.index()] = Slot::some(across);
            opposite[across.index()] = Slot::some(own);
        })?;
        let closed = opposite.len() == 2 * edges;
        let mut first = 0;
        let triangles = opposite.as_chunks_mut::<3>().0.iter_mut();
        // The scratch memory of the pairing now stores the swings. With stored swings, the walks
        // around all vertices take half the time.
        for (triangle, swing) in triangles.zip(swing.as_chunks_mut::<3>().0) {
            if !closed {
                // If a corner faces a boundary edge, the pairing has paired the corner with itself.
                for (corner, across) in (first..).zip(&mut *triangle) {
                    if *across == Slot::some(CornerId::new(corner)) {
                        *across = Slot::NONE;
                    }
                }
            }
            let [a, b, c] = *triangle;
            *swing = [b, c, a].map(|right: Slot<CornerId>| match right.get() {
                Some(right) => right.next().row(),
                None => u32::MAX,
            });
            first += 3;
        }
        Some(Self {
            opposite,
            swing,
            closed,
        })
    }

    /// Returns a corner for each vertex. On a boundary, this is the first corner of the fan.
    fn first_corners(&self, vertices: usize, vertex: &[VertexId]) -> Vec<Slot<CornerId>> {
        let mut first = vec![Slot::NONE; vertices];
        for (c, v) in (0..).zip(vertex) {
            first[v.index()] = Slot::some(CornerId::new(c));
        }
        if self.closed {
            return first;
        }
        for (c, across) in (0..).zip(&self.opposite) {
            if across.get().is_none() {
                // The `unswing` of the next corner would cross the edge that c faces.
                let start = CornerId::new(c).next();
                first[vertex[start.index()].index()] = Slot::some(start);
            }
        }
        first
    }

    /// Returns whether the walks from the corners in `first` visit every corner.
    fn every_vertex_is_one_fan(&self, first: &[Slot<CornerId>]) -> bool {
        let mut visited = 0;
        for first in first.iter().filter_map(|first| first.get()) {
            let mut at = first.row();
            while let Some(&next) = self.swing.get(at as usize) {
                visited += 1;
                at = next;
                if at == first.row() {
                    break;
                }
            }
        }
        visited == self.swing.len()
    }
}
