//! A mesh data structure with functions that build, run and measure the structure.

use std::fmt;
use std::sync::atomic::AtomicBool;

use sixfold::algorithms::Algorithms;
use sixfold::{
    BuildError, MemoryFootprint, MeshEdit, PolygonMesh, Refine, Relation, Representation,
    StructureInfo,
};
use sixfold_core::{Counts, Measured};

use crate::draw::Draw;
use crate::heap::{Heap, MeasuredMemory, measure_memory};
use crate::mix::{
    MixBackend, MixInput, PreparedMix, Route, Schedule, prepare_edit_mix, prepare_query_mix,
    tabulate_structure,
};
use crate::operation::edit_pass::{PreparedEditor, decimated_counts, prepare_pass};
use crate::reads::{ReadsObserver, count};
use crate::single_edit::{SingleEdit, prepare_single};
use crate::timed_structure::TimedStructure;
use sixfold_measure::{EditPass, TimedBackend};

/// A mesh data structure with functions that build, run and measure the structure.
///
/// [`Backend::structures`] returns a backend for each structure of Sixfold. [`Backend::new`] makes
/// a backend from any other structure:
///
/// ```
/// use sixfold::{EditableHalfEdgeMesh, HalfEdgeMesh, shapes};
/// use sixfold_measure::EditPass;
/// use sixfold_workload::Backend;
///
/// // In place of the half-edge mesh: types that another crate defines.
/// let backend = Backend::new::<HalfEdgeMesh>()
///     .with_edits::<EditableHalfEdgeMesh>()
///     .with_refinement::<HalfEdgeMesh>();
/// let editor = backend.prepare_pass(EditPass::FlipAll, &shapes::icosahedron());
/// assert!(editor.is_some_and(|editor| editor.is_ok()));
/// ```
#[derive(Clone, Copy)]
pub struct Backend {
    /// The properties of the structure that do not depend on a mesh.
    pub info: StructureInfo,
    /// Computes the bytes of the structure's tables by a formula, from the element counts of a
    /// mesh.
    pub layout_bytes: fn(&Counts) -> usize,
    pub(crate) queries: QueryFunctions,
    pub(crate) edits: Option<EditFunctions>,
    /// Subdivision, which is compiled once for each structure, also for the commands.
    pub(crate) algorithms: Algorithms,
}

/// The functions that need only queries.
#[derive(Clone, Copy)]
pub(crate) struct QueryFunctions {
    build: Build,
    pub(crate) measure_memory: fn(&PolygonMesh, &dyn Heap) -> Result<MeasuredMemory, BuildError>,
    count: Count,
    pub(crate) prepare_mix: for<'a> fn(&MixInput<'a>) -> PreparedMix<'a>,
    pub(crate) tabulate: Tabulate,
}

/// The functions that need edits.
#[derive(Clone, Copy)]
pub(crate) struct EditFunctions {
    pub(crate) prepare_mix: for<'a> fn(&MixInput<'a>) -> PreparedMix<'a>,
    pub(crate) prepare_pass: fn(EditPass, &Algorithms, &PolygonMesh) -> PreparedEditor,
    pub(crate) prepare_single: fn(SingleEdit, &PolygonMesh) -> PreparedEditor,
    pub(crate) decimated_counts: fn(&Algorithms, &PolygonMesh, f64) -> Option<Counts>,
}

/// Builds the structure and prepares it for measurement.
type Build =
    for<'a> fn(&Backend, &'a PolygonMesh, Option<&'a Draw>) -> Result<Prepared<'a>, BuildError>;

type Count =
    fn(&PolygonMesh, &[Relation], &AtomicBool, &mut dyn ReadsObserver) -> Result<(), BuildError>;

type Tabulate =
    for<'a> fn(&'a PolygonMesh, &'a Schedule, &'a Route) -> Option<Box<dyn MixBackend + 'a>>;

/// A structure that is ready to be measured, with the bytes of its tables.
pub type Prepared<'a> = (Box<dyn TimedBackend + 'a>, MemoryFootprint);

impl Backend {
    /// Makes a backend for the structure `M`, without edits and without native subdivision.
    pub fn new<M: Measured + 'static>() -> Self {
        Self::with_algorithms::<M>(Algorithms::new::<M>())
    }

    /// Makes a backend for the structure `M` with compiled algorithms.
    fn with_algorithms<M: Measured + 'static>(algorithms: Algorithms) -> Self {
        Self {
            info: StructureInfo::new::<M>(),
            layout_bytes: M::layout_bytes,
            queries: QueryFunctions {
                build: |backend, polygons, draw| {
                    let mesh = M::from_polygons(polygons)?;
                    let memory = mesh.memory();
                    let timed = TimedStructure::new(*backend, polygons, draw, mesh);
                    Ok((Box::new(timed), memory))
                },
                measure_memory: measure_memory::<M>,
                count: |polygons, relations, stop, observer| {
                    count(M::from_polygons(polygons)?, relations, stop, observer);
                    Ok(())
                },
                prepare_mix: prepare_query_mix::<M>,
                tabulate: tabulate_structure::<M>,
            },
            edits: None,
            algorithms,
        }
    }

    /// Adds edits to the backend. `M` is the editable type of the structure.
    #[must_use]
    pub fn with_edits<M: Representation + MeshEdit + 'static>(self) -> Self {
        Self {
            algorithms: self.algorithms.with_edits::<M>(),
            ..self.with_measured_edits::<M>()
        }
    }

    /// Adds the edits of `M`, without compiling its algorithms.
    fn with_measured_edits<M: Representation + MeshEdit + 'static>(self) -> Self {
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

    /// Adds native subdivision to the backend. `M` is the type of the structure that can refine its
    /// own tables.
    #[must_use]
    pub fn with_refinement<M: Refine + 'static>(self) -> Self {
        Self {
            info: self.info.with_refinement::<M>(),
            algorithms: self.algorithms.with_refinement::<M>(),
            ..self
        }
    }

    /// Returns one backend for each structure of Sixfold, in the fixed order that all reports use.
    #[cfg(not(test))] // Compiling all structures again for the unit tests would take minutes.
    pub fn structures() -> Vec<Self> {
        macro_rules! backends {
            ($({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? $(, walk: $walk:ty)? })+) => {
                vec![$({
                    let algorithms = Algorithms::find(<$query as Representation>::NAME);
                    let algorithms = algorithms.expect("the list of algorithms has every structure");
                    let backend = Backend::with_algorithms::<$query>(algorithms);
                    $(let backend = backend.with_measured_edits::<$edit>();)?
                    $(let backend = Backend {
                        info: backend.info.with_refinement::<$refine>(),
                        ..backend
                    };)?
                    backend
                }),+]
            };
        }
        sixfold::structures!([backends])
    }

    /// Returns the backend of the structure called `name`; `None` if the name is unknown.
    #[cfg(not(test))]
    pub fn find(name: &str) -> Option<Self> {
        let mut all = Self::structures().into_iter();
        all.find(|backend| backend.name() == name)
    }

    /// Builds the structure from `polygons` and prepares it for measurement. With `draw` (the
    /// elements in random order), operations can also run on a random sample of the elements.
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

    /// Prepares a pass of edits. Returns `None` if the structure has no edits.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons` or if a face is not a triangle.
    pub fn prepare_pass(&self, pass: EditPass, polygons: &PolygonMesh) -> Option<PreparedEditor> {
        Some((self.edits?.prepare_pass)(pass, &self.algorithms, polygons))
    }

    /// Builds the structure from `polygons` and measures the allocated bytes with the counters of
    /// `heap`.
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

    /// Builds the structure from `polygons`, and counts the table reads of each relation in
    /// `relations`. Stops early if `stop` becomes true.
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
