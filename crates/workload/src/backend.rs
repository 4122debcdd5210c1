//! A representation in the form that a study measures.

use std::fmt;
use std::sync::atomic::AtomicBool;

use sixfold::{
    BackendInfo, BuildError, Counts, Measured, MemoryFootprint, PolygonMesh, Relation,
    for_each_representation,
};

use crate::candidate::{Candidate, Subject};
use crate::heap::{Heap, Weighed, weigh};
use crate::reads::{Counted, count};
use crate::sample::Draw;

/// A representation with its properties and the functions that build and measure it.
///
/// [`Backend::roster`] returns those of Sixfold. [`Backend::of`] makes a backend from any other
/// representation, which a study then also measures (`Settings::extra` there).
#[derive(Clone, Copy)]
pub struct Backend {
    /// Properties that are known without building it.
    pub info: BackendInfo,
    /// Computes the bytes of its layout, by formula, for a mesh with these counts.
    pub layout_bytes: fn(&Counts) -> usize,
    pub(crate) build: Build,
    pub(crate) weigh: fn(&PolygonMesh, &dyn Heap) -> Result<Weighed, BuildError>,
    count: Count,
}

/// Builds the structure and prepares it for measurement. Its memory is read before anything is run.
type Build = for<'a> fn(&'a PolygonMesh, Option<&'a Draw>) -> Result<OnTheBench<'a>, BuildError>;

/// Builds the structure and counts the table reads of relations.
type Count = fn(&PolygonMesh, &[Relation], &AtomicBool, &mut dyn Counted) -> Result<(), BuildError>;

/// A structure ready to be measured, and its memory footprint.
pub type OnTheBench<'a> = (Box<dyn Subject + 'a>, MemoryFootprint);

impl Backend {
    /// Makes a backend from `M`.
    pub fn of<M: Measured + 'static>() -> Self {
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

    /// Returns every representation of Sixfold, in the order in which tables show them.
    pub fn roster() -> Vec<Self> {
        let mut backends = Vec::new();
        for_each_representation!(M => { backends.push(Self::of::<M>()); });
        backends
    }

    /// Builds it from `polygons` and prepares it for measurement, with its handles of the elements
    /// of `draw`, if given. Also returns its memory footprint.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`.
    pub fn put_on_the_bench<'a>(
        &self,
        polygons: &'a PolygonMesh,
        draw: Option<&'a Draw>,
    ) -> Result<OnTheBench<'a>, BuildError> {
        (self.build)(polygons, draw)
    }

    /// Builds only the structure from `polygons`, and counts with `heap` the bytes that this
    /// allocates.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`.
    pub fn weigh(&self, polygons: &PolygonMesh, heap: &dyn Heap) -> Result<Weighed, BuildError> {
        (self.weigh)(polygons, heap)
    }

    /// Builds it from `polygons` and counts the table reads of `relations`, until `stop` is true.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`.
    pub fn count_reads(
        &self,
        polygons: &PolygonMesh,
        relations: &[Relation],
        stop: &AtomicBool,
        counted: &mut dyn Counted,
    ) -> Result<(), BuildError> {
        (self.count)(polygons, relations, stop, counted)
    }

    /// Returns its name, as users write it.
    pub fn name(&self) -> &'static str {
        self.info.name
    }
}

impl PartialEq for Backend {
    /// Returns whether both have the same name.
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl fmt::Debug for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
