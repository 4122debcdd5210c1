//! The flaws of construction, conversion, costs, memory and measuring.

use std::marker::PhantomData;

use sixfold_core::{
    BuildError, Capabilities, Counts, EditLog, FaceId, InvariantError, MAX_ROWS, Measured,
    MemoryFootprint, MeshMove, MeshQuery, MoveError, Point, PolygonMesh, Probe, QueryCost,
    Relation, Representation, VertexId, VertexMap, with_lower_limits,
};

use super::{Flaw, FlawKind, Flawed};
use crate::face_and_edge_lists::FaceAndEdgeLists;

impl<F: Flaw> Representation for Flawed<F> {
    const NAME: &'static str = "flawed";

    const COSTS: [QueryCost; 9] = match F::KIND {
        FlawKind::AllConstant => [QueryCost::Constant; 9],
        FlawKind::AllLocal => [QueryCost::Local; 9],
        FlawKind::AllScan => [QueryCost::Scan; 9],
        _ => FaceAndEdgeLists::COSTS,
    };

    fn cost(relation: Relation) -> QueryCost {
        match F::KIND {
            FlawKind::CostOfAnotherRelation => Self::COSTS[8 - relation as usize],
            _ => Self::COSTS[relation as usize],
        }
    }

    fn is_local() -> bool {
        F::KIND == FlawKind::LocalByName || QueryCost::are_local(&Self::COSTS)
    }

    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        match F::KIND {
            FlawKind::AcceptsEverything => {}
            FlawKind::LimitsIgnored => {
                with_lower_limits(MAX_ROWS, || Self::CAPABILITIES.check(polygons))?;
            }
            FlawKind::RejectsIsolated => {
                let strict = Capabilities {
                    isolated_vertices: false,
                    ..Capabilities::ALL
                };
                strict.check(polygons)?;
            }
            FlawKind::WrongError => {
                let vertices = Capabilities {
                    non_manifold_vertices: false,
                    ..Capabilities::ALL
                };
                vertices.check(polygons)?;
                Self::CAPABILITIES.check(polygons)?;
            }
            _ => Self::CAPABILITIES.check(polygons)?,
        }
        Ok(Self {
            inner: FaceAndEdgeLists::from_polygons(polygons)?,
            is_probed: false,
            moves: 0,
            flaw: PhantomData,
        })
    }

    fn to_polygons(&self) -> PolygonMesh {
        let polygons = self.inner.to_polygons();
        if !self.is(FlawKind::FaceReversedOnExport) {
            return polygons;
        }
        let mut faces: Vec<Vec<u32>> = Vec::new();
        for (_, corners) in polygons.faces().iter() {
            faces.push(corners.iter().map(|v| v.index() as u32).collect());
        }
        if let Some(face) = faces.last_mut() {
            face.reverse();
        }
        PolygonMesh::new(polygons.positions().iter().copied(), faces)
            .expect("the corners are the same")
    }

    fn vertex_handle(polygons: &PolygonMesh, v: VertexId) -> VertexId {
        let last = polygons.vertex_count() as u32 - 1;
        match F::KIND {
            FlawKind::VertexNameOff => VertexId::new(last - v.index() as u32),
            _ => v,
        }
    }

    fn face_handle(polygons: &PolygonMesh, f: FaceId) -> FaceId {
        let last = polygons.face_count() as u32 - 1;
        match F::KIND {
            FlawKind::FaceNameOff => FaceId::new(last - f.index() as u32),
            _ => f,
        }
    }

    fn memory(&self) -> MemoryFootprint {
        let mut memory = self.inner.memory();
        if self.is(FlawKind::MemoryTooLarge) {
            memory.tables[0].bytes += memory.tables[0].bytes / 4;
        }
        memory
    }

    fn validate(&self) -> Result<(), InvariantError> {
        if self.is(FlawKind::ValidateFails) {
            return Err(InvariantError::new("I9", "always fails"));
        }
        self.inner.validate()
    }
}

impl<F: Flaw> MeshMove for Flawed<F> {
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError> {
        if let Some(first) = self.inner.vertices().next()
            && self.is(FlawKind::MoveReportsRemoval)
        {
            log.removed_vertex(first);
        }
        self.moves += 1;
        let mut positions = positions.clone();
        if self.is(FlawKind::SecondMoveIgnored) && self.moves > 1 {
            return Ok(());
        }
        if let Some(last) = self.inner.vertices().last()
            && self.is(FlawKind::LastVertexNotMoved)
        {
            positions[last] = self.inner.position(last);
        }
        self.inner.set_positions(&positions)
    }
}

impl<F: Flaw> Measured for Flawed<F> {
    type Probed<P: Probe> = Flawed<F, P>;

    fn layout_bytes(counts: &Counts) -> usize {
        FaceAndEdgeLists::layout_bytes(counts)
    }

    fn probed<P: Probe>(self, probe: P) -> Flawed<F, P> {
        Flawed {
            inner: self.inner.probed(probe),
            is_probed: true,
            moves: self.moves,
            flaw: PhantomData,
        }
    }
}
