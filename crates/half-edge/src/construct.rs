//! Building from polygons, and conversion to polygons.

use sixfold_core::{
    BuildError, Counts, Editing, FaceId, FaceList, InvariantError, LinkFaces, Measured,
    MemoryFootprint, MeshQuery, NewRows, PolygonMesh, Probe, QueryCost, Representation, RowId,
    SideRows, Slot, TwinPairs, VertexId, row,
};

use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

impl<E: Editing> Representation for HalfEdgeMesh<E> {
    const NAME: &'static str = "half-edge";

    const COSTS: [QueryCost; 9] = [QueryCost::Constant; 9];

    sixfold_core::type_path!(HalfEdgeMesh);

    /// Pairs the sides, links the half-edges of each face, then links the boundary loops.
    /// O(corners + vertices).
    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        let error = || Self::CAPABILITIES.build_error(polygons);
        let faces = polygons.faces();
        let mut halves = vec![BLANK; faces.corners().len()];
        let mut unlinked = Unlinked(&mut halves);
        let pairs = TwinPairs::with_rows(polygons.vertex_count(), faces, &mut unlinked);
        let pairs = pairs.ok_or_else(error)?;
        let mut builder = Builder::from_faces(polygons.vertex_count(), faces, halves, &pairs);
        let closed = faces.corners().len() == 2 * pairs.edge_count;
        if (!closed && !builder.close_boundary_loops()) || !builder.every_vertex_is_one_fan() {
            return Err(error());
        }
        let positions = polygons.positions().to_vec();
        Ok(Self::from_tables(
            positions,
            builder.leaving,
            builder.halves,
            builder.first,
        ))
    }

    fn to_polygons(&self) -> PolygonMesh {
        let rows = NewRows::from_holes(&self.vertex_holes, self.vertex_rows());
        rows.polygons(self, self.positions(), self.half_edge_count())
    }

    sixfold_core::row_handles!();

    fn memory(&self) -> MemoryFootprint {
        self.table_bytes()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        crate::validate::validate(self)
    }
}

sixfold_core::moving_positions!(HalfEdgeMesh);
sixfold_core::local_queries!(crate::HalfEdgeMesh, crate::EditableHalfEdgeMesh);

impl<E: Editing> Measured for HalfEdgeMesh<E> {
    type Probed<P: Probe> = HalfEdgeMesh<E, P>;

    fn layout_bytes(counts: &Counts) -> usize {
        size_of::<Half>() * 2 * counts.edges + 16 * counts.vertices + 4 * counts.faces
    }

    fn probed<P: Probe>(self, probe: P) -> HalfEdgeMesh<E, P> {
        self.with_probe(probe)
    }
}

/// A half-edge that is not linked yet and has no face.
const BLANK: Half = Half {
    next: HalfEdgeId::new(0),
    origin: VertexId::new(0),
    face: Slot::NONE,
};

/// Half-edges that are not linked yet. The pairing uses their rows as scratch memory: `origin` and
/// `next` hold one side.
struct Unlinked<'a>(&'a mut [Half]);

impl SideRows for Unlinked<'_> {
    #[inline(always)]
    fn write(&mut self, at: usize, high: VertexId, tag: u32) {
        self.0[at] = Half {
            next: HalfEdgeId::new(tag),
            origin: high,
            face: Slot::NONE,
        };
    }

    #[inline(always)]
    fn read(&self, at: usize) -> (VertexId, u32) {
        let half = &self.0[at];
        (half.origin, half.next.row())
    }
}

struct Builder {
    leaving: Vec<Slot<HalfEdgeId>>,
    halves: Vec<Half>,
    first: Vec<HalfEdgeId>,
}

impl LinkFaces for Builder {
    #[inline(always)]
    fn link_face(&mut self, f: FaceId, corners: &[VertexId], halves: &[u32]) {
        self.first.push(HalfEdgeId::new(halves[0]));
        for i in 0..corners.len() {
            let next = if i + 1 == halves.len() { 0 } else { i + 1 };
            self.halves[halves[i] as usize] = Half {
                next: HalfEdgeId::new(halves[next]),
                origin: corners[i],
                face: Slot::some(f),
            };
            self.leaving[corners[i].index()] = Slot::some(HalfEdgeId::new(halves[i]));
        }
    }
}

impl Builder {
    /// Writes the half-edge of every corner into its row. Boundary half-edges keep an empty face.
    fn from_faces(vertices: usize, faces: &FaceList, halves: Vec<Half>, pairs: &TwinPairs) -> Self {
        let mut builder = Self {
            leaving: vec![Slot::NONE; vertices],
            halves,
            first: Vec::with_capacity(faces.len()),
        };
        let half_count = 2 * pairs.edge_count;
        if half_count > builder.halves.len() {
            // Some half-edges have no corner, so there are more rows. The old rows are freed before
            // the new rows are allocated, so that the table is in memory only once.
            builder.halves = Vec::new();
            builder.halves = vec![BLANK; half_count];
        }
        pairs.link_faces(faces, &mut builder);
        builder
    }

    /// Links the blank half-edges into loops. Returns false if two blank half-edges leave one
    /// vertex.
    fn close_boundary_loops(&mut self) -> bool {
        let blank = |halves: &[Half], h: usize| halves[h].face.get().is_none();
        for h in 0..self.halves.len() {
            if blank(&self.halves, h) {
                let origin = self.halves[self.halves[h ^ 1].next.index()].origin;
                let leaving = &mut self.leaving[origin.index()];
                if leaving
                    .get()
                    .is_some_and(|other| blank(&self.halves, other.index()))
                {
                    return false;
                }
                *leaving = Slot::some(HalfEdgeId::new(row(h)));
                self.halves[h].origin = origin;
            }
        }
        for h in 0..self.halves.len() {
            if blank(&self.halves, h) {
                let target = self.halves[h ^ 1].origin;
                // At each vertex, as many boundary half-edges arrive as leave. So one boundary
                // half-edge leaves this vertex.
                let next = self.leaving[target.index()]
                    .get()
                    .expect("a half-edge leaves every target");
                self.halves[h].next = next;
            }
        }
        true
    }

    /// Returns whether the walks around all vertices visit every half-edge.
    fn every_vertex_is_one_fan(&self) -> bool {
        let mut visited = 0;
        for first in self.leaving.iter().filter_map(|leaving| leaving.get()) {
            let mut h = first;
            loop {
                visited += 1;
                h = self.halves[h.twin().index()].next;
                if h == first {
                    break;
                }
            }
        }
        visited == self.halves.len()
    }
}
