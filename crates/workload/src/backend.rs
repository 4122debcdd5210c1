//! A representation as a study takes it.

use std::fmt;
use std::sync::atomic::AtomicBool;

use sixfold::{
    BackendInfo, BuildError, Counts, MemoryFootprint, PolygonMesh, Relation, Representation,
    Visitor, visit_all,
};

use crate::candidate::{Candidate, Subject};
use crate::heap::{Heap, Weighed, weigh};
use crate::reads::{Counted, count};
use crate::sample::Draw;

/// A representation, with what is known of it and how it is built and put to the test.
///
/// [`Backend::roster`] has those of Sixfold; [`Backend::of`] makes one of any other, which a study
/// then measures beside them (`Settings::extra` there).
#[derive(Clone, Copy)]
pub struct Backend {
    /// What is known of it without building it.
    pub info: BackendInfo,
    /// Bytes that its layout takes in theory for a mesh with such counts.
    pub layout_bytes: fn(&Counts) -> usize,
    pub(crate) build: Build,
    pub(crate) weigh: fn(&PolygonMesh, &dyn Heap) -> Result<Weighed, BuildError>,
    count: Count,
}

/// Builds the structure and puts it on the bench; what it weighs is asked before anything is run.
type Build = for<'a> fn(&'a PolygonMesh, Option<&'a Draw>) -> Result<OnTheBench<'a>, BuildError>;

/// Builds the structure, and counts what relations read.
type Count = fn(&PolygonMesh, &[Relation], &AtomicBool, &mut dyn Counted) -> Result<(), BuildError>;

/// A structure ready to be measured, and what it weighs.
pub type OnTheBench<'a> = (Box<dyn Subject + 'a>, MemoryFootprint);

impl Backend {
    /// `M` as a backend.
    pub fn of<M: Representation + 'static>() -> Self {
        Self {
            info: BackendInfo::of::<M>(),
            layout_bytes: M::layout_bytes,
            build: |polygons, draw| {
                let mesh = M::from_polygons(polygons)?;
                let memory = mesh.memory();
                Ok((Box::new(Candidate::new(polygons, draw, mesh)), memory))
            },
            weigh: weigh::<M>,
            count: |polygons, relations, stop, counted| {
                count(M::from_polygons(polygons)?, relations, stop, counted);
                Ok(())
            },
        }
    }

    /// Every representation of Sixfold, in the order in which tables show them.
    pub fn roster() -> Vec<Self> {
        struct Row;

        impl Visitor for Row {
            type Output = Backend;

            fn visit<M: Representation + 'static>(&mut self) -> Backend {
                Backend::of::<M>()
            }
        }

        visit_all(&mut Row)
    }

    /// Builds it from `polygons` and puts it on the bench, with its names of what is drawn, if anything
    /// is; and what it weighs.
    ///
    /// # Errors
    ///
    /// Why it cannot hold them.
    pub fn put_on_the_bench<'a>(
        &self,
        polygons: &'a PolygonMesh,
        draw: Option<&'a Draw>,
    ) -> Result<OnTheBench<'a>, BuildError> {
        (self.build)(polygons, draw)
    }

    /// Builds it from `polygons` alone, with nothing beside it, and has `heap` count what that takes.
    ///
    /// # Errors
    ///
    /// Why it cannot hold them.
    pub fn weigh(&self, polygons: &PolygonMesh, heap: &dyn Heap) -> Result<Weighed, BuildError> {
        (self.weigh)(polygons, heap)
    }

    /// Builds it from `polygons` and counts what `relations` read, until told to stop.
    ///
    /// # Errors
    ///
    /// Why it cannot hold them.
    pub fn count_reads(
        &self,
        polygons: &PolygonMesh,
        relations: &[Relation],
        stop: &AtomicBool,
        counted: &mut dyn Counted,
    ) -> Result<(), BuildError> {
        (self.count)(polygons, relations, stop, counted)
    }

    /// What users call it.
    pub fn name(&self) -> &'static str {
        self.info.name
    }
}

impl PartialEq for Backend {
    /// Backends are told apart by name.
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl fmt::Debug for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
