//! A mesh data structure with functions that build, run and measure the structure.

use std::fmt;
use std::sync::atomic::AtomicBool;

use sixfold::subdivision::Method;
use sixfold::{
    BuildError, Creases, MemoryFootprint, MeshEdit, PolygonMesh, Refine, Relation, Representation,
    StructureInfo,
};
use sixfold_core::{Counts, Measured};

use crate::allocation::decimated_counts;
use crate::draw::Draw;
use crate::edit_pass::{EditPass, PreparedEditor, prepare_pass};
use crate::heap::{Heap, MeasuredMemory, measure_memory};
use crate::job::TimedBackend;
use crate::mix::{
    MixBackend, MixInput, PreparedMix, Route, Schedule, prepare_edit_mix, prepare_query_mix,
    tabulate_structure,
};
use crate::reads::{ReadsObserver, count};
use crate::single_edit::{SingleEdit, prepare_single};
use crate::subdivision_job::{PreparedRefiner, SubdivisionJob, prepare_native, prepare_rebuilt};
use crate::timed_structure::TimedStructure;

/// A mesh data structure with functions that build, run and measure the structure.
///
/// [`Backend::structures`] returns a backend for each structure of Sixfold. [`Backend::new`] makes
/// a backend from any other structure:
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
    /// The properties of the structure that do not depend on a mesh.
    pub info: StructureInfo,
    /// Computes the bytes of the structure's tables by a formula, from the element counts of a
    /// mesh.
    pub layout_bytes: fn(&Counts) -> usize,
    pub(crate) queries: QueryFunctions,
    pub(crate) edits: Option<EditFunctions>,
    /// Sets up a subdivision that refines the structure's own tables.
    prepare_native: Option<PrepareRefiner>,
}

/// The functions that need only queries.
#[derive(Clone, Copy)]
pub(crate) struct QueryFunctions {
    build: Build,
    pub(crate) measure_memory: fn(&PolygonMesh, &dyn Heap) -> Result<MeasuredMemory, BuildError>,
    count: Count,
    pub(crate) prepare_mix: for<'a> fn(&MixInput<'a>) -> PreparedMix<'a>,
    pub(crate) tabulate: Tabulate,
    /// Sets up a subdivision that rebuilds the structure from each level.
    prepare_rebuilt: PrepareRefiner,
}

/// The functions that need edits.
#[derive(Clone, Copy)]
pub(crate) struct EditFunctions {
    pub(crate) prepare_mix: for<'a> fn(&MixInput<'a>) -> PreparedMix<'a>,
    pub(crate) prepare_pass: fn(EditPass, &PolygonMesh) -> PreparedEditor,
    pub(crate) prepare_single: fn(SingleEdit, &PolygonMesh) -> PreparedEditor,
    pub(crate) decimated_counts: fn(&PolygonMesh, f64) -> Option<Counts>,
    /// Sets up a subdivision that rebuilds the editable type from each level.
    prepare_rebuilt: PrepareRefiner,
}

/// The functions with which a study runs operations that make a mesh, for one type of a structure:
/// the type that only answers queries, or the editable type.
#[derive(Clone, Copy)]
pub(crate) struct TypeFunctions {
    prepare_rebuilt: PrepareRefiner,
    prepare_native: Option<PrepareRefiner>,
    /// Whether the read-only form of the structure has a native method, but this type, the editable
    /// form, has none.
    pub(crate) only_read_only_is_native: bool,
    /// Sets up a pass of edits; `None` if the structure cannot be edited.
    pub(crate) prepare_pass: Option<fn(EditPass, &PolygonMesh) -> PreparedEditor>,
}

impl TypeFunctions {
    /// Sets up a subdivision; `None` if the type does not support this way.
    pub(crate) fn prepare_refiner(
        &self,
        job: SubdivisionJob,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Option<PreparedRefiner> {
        let prepare = match job.way.method() {
            Method::Native => self.prepare_native?,
            Method::Gather | Method::Scatter => self.prepare_rebuilt,
        };
        Some(prepare(job, polygons, creases))
    }
}

/// Builds the structure and prepares it for measurement.
type Build =
    for<'a> fn(&Backend, &'a PolygonMesh, Option<&'a Draw>) -> Result<Prepared<'a>, BuildError>;

type Count =
    fn(&PolygonMesh, &[Relation], &AtomicBool, &mut dyn ReadsObserver) -> Result<(), BuildError>;

type Tabulate =
    for<'a> fn(&'a PolygonMesh, &'a Schedule, &'a Route) -> Option<Box<dyn MixBackend + 'a>>;

type PrepareRefiner = fn(SubdivisionJob, &PolygonMesh, &Creases) -> PreparedRefiner;

/// A structure that is ready to be measured, with the bytes of its tables.
pub type Prepared<'a> = (Box<dyn TimedBackend + 'a>, MemoryFootprint);

impl Backend {
    /// Makes a backend for the structure `M`, without edits and without native subdivision.
    pub fn new<M: Measured + 'static>() -> Self {
        Self {
            info: StructureInfo::new::<M>(),
            layout_bytes: M::layout_bytes,
            queries: QueryFunctions {
                build: |backend, polygons, draw| {
                    let mesh = M::from_polygons(polygons)?;
                    let memory = mesh.memory();
                    let functions = backend.query_functions();
                    let timed =
                        TimedStructure::new(backend.name(), functions, polygons, draw, mesh);
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

    /// Adds edits to the backend. `M` is the editable type of the structure.
    #[must_use]
    pub fn with_edits<M: Representation + MeshEdit + 'static>(self) -> Self {
        let edits = EditFunctions {
            prepare_mix: prepare_edit_mix::<M>,
            prepare_pass: prepare_pass::<M>,
            prepare_single: prepare_single::<M>,
            decimated_counts: decimated_counts::<M>,
            prepare_rebuilt: prepare_rebuilt::<M>,
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
            prepare_native: Some(prepare_native::<M>),
            ..self
        }
    }

    /// Returns one backend for each structure of Sixfold, in the fixed order that all reports use.
    #[cfg(not(test))] // Compiling all structures again for the unit tests would take minutes.
    pub fn structures() -> Vec<Self> {
        macro_rules! backends {
            ($({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? $(, walk: $walk:ty)? })+) => {
                vec![$(
                    Backend::new::<$query>()
                        $(.with_edits::<$edit>())?
                        $(.with_refinement::<$refine>())?
                ),+]
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

    /// Returns the functions of the type that only answers queries. Its edits run on the editable
    /// type.
    pub(crate) fn query_functions(&self) -> TypeFunctions {
        TypeFunctions {
            prepare_rebuilt: self.queries.prepare_rebuilt,
            prepare_native: self.prepare_native,
            only_read_only_is_native: false,
            prepare_pass: self.edits.map(|edits| edits.prepare_pass),
        }
    }

    /// Returns the functions of the editable type; `None` if the structure cannot be edited. This
    /// type cannot refine its own tables.
    pub(crate) fn edit_functions(&self) -> Option<TypeFunctions> {
        let edits = self.edits?;
        Some(TypeFunctions {
            prepare_rebuilt: edits.prepare_rebuilt,
            prepare_native: None,
            only_read_only_is_native: self.prepare_native.is_some(),
            prepare_pass: Some(edits.prepare_pass),
        })
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
