//! A structure with the functions that studies need to measure it.

use std::fmt;
use std::sync::atomic::AtomicBool;

use sixfold::{
    BuildError, Creases, MemoryFootprint, MeshEdit, PolygonMesh, Refine, Relation, Representation,
    StructureInfo, structures,
};
use sixfold_core::{Counts, Measured};

use crate::allocation::decimated_counts;
use crate::draw::Draw;
use crate::edit_pass::{EditPass, PreparedEditor, prepare_pass};
use crate::heap::{Heap, MeasuredMemory, measure_memory};
use crate::mix::{
    MixBackend, MixInput, PreparedMix, Route, Schedule, prepare_edit_mix, prepare_query_mix,
    tabulate_structure,
};
use crate::reads::{ReadsObserver, count};
use crate::single_edit::{SingleEdit, prepare_single};
use crate::subdivision_job::{PreparedRefiner, SubdivisionJob, prepare_native, prepare_rebuilt};
use crate::timed_structure::{TimedBackend, TimedStructure};

/// Makes a vector of [`Backend`] from the lines of [`structures!`].
macro_rules! backends {
    ($({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? })+) => {
        vec![$(
            Backend::new::<$query>()
                $(.with_edits::<$edit>())?
                $(.with_refinement::<$refine>())?
        ),+]
    };
}

/// A structure and the functions that build, run and measure it.
///
/// [`Backend::structures`] returns the backends of Sixfold. [`Backend::new`] makes a backend from
/// any other structure:
///
/// ```
/// use sixfold::{EditableHalfEdgeMesh, HalfEdgeMesh, shapes};
/// use sixfold_workload::{Backend, EditPass};
///
/// // In place of the half-edge mesh: types that another crate defines.
/// let backend = Backend::new::<HalfEdgeMesh>()
///     .with_edits::<EditableHalfEdgeMesh>()
///     .with_refinement::<HalfEdgeMesh>();
/// let editor = EditPass::FlipAll.prepare(&backend, &shapes::icosahedron());
/// assert!(editor.is_some_and(|editor| editor.is_ok()));
/// ```
#[derive(Clone, Copy)]
pub struct Backend {
    /// Properties that are known before the structure is built.
    pub info: StructureInfo,
    /// Computes the bytes of the layout for a mesh with the given counts.
    pub layout_bytes: fn(&Counts) -> usize,
    pub(crate) queries: QueryFunctions,
    pub(crate) edits: Option<EditFunctions>,
    /// Sets up a subdivision that refines the tables of the structure.
    pub(crate) prepare_native: Option<PrepareRefiner>,
}

/// The functions that need only queries.
#[derive(Clone, Copy)]
pub(crate) struct QueryFunctions {
    build: Build,
    pub(crate) measure_memory: fn(&PolygonMesh, &dyn Heap) -> Result<MeasuredMemory, BuildError>,
    count: Count,
    pub(crate) prepare_mix: for<'a> fn(&MixInput<'a>) -> PreparedMix<'a>,
    pub(crate) tabulate: Tabulate,
    /// Sets up a subdivision that rebuilds the structure for each level.
    pub(crate) prepare_rebuilt: PrepareRefiner,
}

/// The functions that need edits.
#[derive(Clone, Copy)]
pub(crate) struct EditFunctions {
    pub(crate) prepare_mix: for<'a> fn(&MixInput<'a>) -> PreparedMix<'a>,
    pub(crate) prepare_pass: fn(EditPass, &PolygonMesh) -> PreparedEditor,
    pub(crate) prepare_single: fn(SingleEdit, &PolygonMesh) -> PreparedEditor,
    pub(crate) decimated_counts: fn(&PolygonMesh, f64) -> Option<Counts>,
}

/// Builds the structure and prepares it for measurement.
type Build =
    for<'a> fn(&Backend, &'a PolygonMesh, Option<&'a Draw>) -> Result<Prepared<'a>, BuildError>;

type Count =
    fn(&PolygonMesh, &[Relation], &AtomicBool, &mut dyn ReadsObserver) -> Result<(), BuildError>;

type Tabulate =
    for<'a> fn(&'a PolygonMesh, &'a Schedule, &'a Route) -> Option<Box<dyn MixBackend + 'a>>;

type PrepareRefiner = fn(SubdivisionJob, &PolygonMesh, &Creases) -> PreparedRefiner;

/// A structure that is ready to be measured, and its memory footprint.
pub type Prepared<'a> = (Box<dyn TimedBackend + 'a>, MemoryFootprint);

impl Backend {
    /// Makes a backend for `M` without edits and native subdivision.
    pub fn new<M: Measured + 'static>() -> Self {
        Self {
            info: StructureInfo::new::<M>(),
            layout_bytes: M::layout_bytes,
            queries: QueryFunctions {
                build: |backend, polygons, draw| {
                    let mesh = M::from_polygons(polygons)?;
                    let memory = mesh.memory();
                    let timed = TimedStructure::new(backend, polygons, draw, mesh);
                    Ok((Box::new(timed), memory))
                },
                measure_memory: measure_memory::<M>,
                count: |polygons, relations, stop, observer| {
                    count(M::from_polygons(polygons)?, relations, stop, observer);
                    Ok(())
                },
                prepare_mix: prepare_query_mix::<M>,
                tabulate: tabulate_structure::<M>,
                prepare_rebuilt: prepare_rebuilt::<M>,
            },
            edits: None,
            prepare_native: None,
        }
    }

    /// Adds the edits of `M`, the editable type of the structure.
    #[must_use]
    pub fn with_edits<M: Representation + MeshEdit + 'static>(self) -> Self {
        let edits = EditFunctions {
            prepare_mix: prepare_edit_mix::<M>,
            prepare_pass: prepare_pass::<M>,
            prepare_single: prepare_single::<M>,
            decimated_counts: decimated_counts::<M>,
        };
        Self {
            info: self.info.with_edits::<M>(),
            edits: Some(edits),
            ..self
        }
    }

    /// Adds the native subdivision of `M`, the type of the structure that can refine its tables.
    #[must_use]
    pub fn with_refinement<M: Refine + 'static>(self) -> Self {
        Self {
            info: self.info.with_refinement::<M>(),
            prepare_native: Some(prepare_native::<M>),
            ..self
        }
    }

    /// Returns a backend for each structure of Sixfold, in the order of tables.
    pub fn structures() -> Vec<Self> {
        structures!([backends])
    }

    /// Returns the backend of Sixfold called `name`; `None` if the name is unknown.
    pub fn find(name: &str) -> Option<Self> {
        let mut all = Self::structures().into_iter();
        all.find(|backend| backend.name() == name)
    }

    /// Builds the structure from `polygons` and prepares it for measurement. With `draw`, it can
    /// also run samples of the drawn elements. Also returns the memory footprint.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`.
    pub fn prepare<'a>(
        &self,
        polygons: &'a PolygonMesh,
        draw: Option<&'a Draw>,
    ) -> Result<Prepared<'a>, BuildError> {
        (self.queries.build)(self, polygons, draw)
    }

    /// Builds the structure from `polygons` and counts the allocated bytes with `heap`.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`.
    pub fn measure_memory(
        &self,
        polygons: &PolygonMesh,
        heap: &dyn Heap,
    ) -> Result<MeasuredMemory, BuildError> {
        (self.queries.measure_memory)(polygons, heap)
    }

    /// Builds the structure from `polygons` and counts the reads of `relations`, until `stop` is
    /// true.
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
        (self.queries.count)(polygons, relations, stop, observer)
    }

    /// Returns the name of the structure.
    pub fn name(&self) -> &'static str {
        self.info.name
    }
}

impl PartialEq for Backend {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl fmt::Debug for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
