//! A representation in the form that a study measures.

use std::fmt;
use std::sync::atomic::AtomicBool;

use sixfold::{
    BackendInfo, BuildError, MemoryFootprint, PolygonMesh, Relation, for_each_representation,
};
use sixfold_core::{Counts, Measured};

use crate::draw::Draw;
use crate::heap::{Heap, MeasuredMemory, measure_memory};
use crate::reads::{ReadsObserver, count};
use crate::timed_structure::{TimedBackend, TimedStructure};

/// A representation with its properties and the functions that build and measure it.
///
/// [`Backend::roster`] returns those of Sixfold. [`Backend::new`] makes a backend from any other
/// representation, which a study then also measures (`Settings::extra` there).
#[derive(Clone, Copy)]
pub struct Backend {
    /// Properties that are known without building it.
    pub info: BackendInfo,
    /// Computes the bytes of its layout, by formula, for a mesh with these counts.
    pub layout_bytes: fn(&Counts) -> usize,
    pub(crate) build: Build,
    pub(crate) measure_memory: fn(&PolygonMesh, &dyn Heap) -> Result<MeasuredMemory, BuildError>,
    count: Count,
}

/// Builds the structure and prepares it for measurement. Its memory is read before anything is run.
type Build = for<'a> fn(&'a PolygonMesh, Option<&'a Draw>) -> Result<Prepared<'a>, BuildError>;

/// Builds the structure and counts the table reads of relations.
type Count =
    fn(&PolygonMesh, &[Relation], &AtomicBool, &mut dyn ReadsObserver) -> Result<(), BuildError>;

/// A structure ready to be measured, and its memory footprint.
pub type Prepared<'a> = (Box<dyn TimedBackend + 'a>, MemoryFootprint);

impl Backend {
    /// Makes a backend from `M`.
    pub fn new<M: Measured + 'static>() -> Self {
        Self {
            info: BackendInfo::new::<M>(),
            layout_bytes: M::layout_bytes,
            build: |polygons, draw| {
                let mesh = M::from_polygons(polygons)?;
                let memory = mesh.memory();
                Ok((Box::new(TimedStructure::new(polygons, draw, mesh)), memory))
            },
            measure_memory: measure_memory::<M>,
            count: |polygons, relations, stop, observer| {
                count(M::from_polygons(polygons)?, relations, stop, observer);
                Ok(())
            },
        }
    }

    /// Returns every representation of Sixfold, in the order in which tables show them.
    pub fn roster() -> Vec<Self> {
        let mut backends = Vec::new();
        for_each_representation!(M => { backends.push(Self::new::<M>()); });
        backends
    }

    /// Builds it from `polygons` and prepares it for measurement, with its handles of the elements
    /// of `draw`, if given. Also returns its memory footprint.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`.
    pub fn prepare<'a>(
        &self,
        polygons: &'a PolygonMesh,
        draw: Option<&'a Draw>,
    ) -> Result<Prepared<'a>, BuildError> {
        (self.build)(polygons, draw)
    }

    /// Builds only the structure from `polygons`, and counts with `heap` the bytes that this
    /// allocates.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`.
    pub fn measure_memory(
        &self,
        polygons: &PolygonMesh,
        heap: &dyn Heap,
    ) -> Result<MeasuredMemory, BuildError> {
        (self.measure_memory)(polygons, heap)
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
        observer: &mut dyn ReadsObserver,
    ) -> Result<(), BuildError> {
        (self.count)(polygons, relations, stop, observer)
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
