//! A subdivision that can be timed: a scheme, a way to run the scheme, and a number of levels.

use sixfold::algorithms::{Algorithms, AnyMesh, NativeLevels};
use sixfold::subdivision::{Method, Scheme, Step, Subdivision, SubdivisionError};
use sixfold::{Creases, PolygonMesh};

use crate::backend::Backend;
use sixfold_measure::{Operation, field_sum};

sixfold_core::named! {
    /// A way to compute and store the levels of a subdivision.
    pub enum Way: "way to subdivide" {
        /// Queries the mesh for the points around each new point, and rebuilds the structure for
        /// each level.
        Gather = "gather",
        /// Adds the contributions of each face to the new points in one pass over the faces, and
        /// rebuilds the structure for each level.
        Scatter = "scatter",
        /// Splits the tables of the structure, and stores each level in a newly allocated mesh.
        NativeFresh = "native_fresh",
        /// Splits the tables of the structure, and stores each level in the mesh of the previous
        /// run.
        Native = "native",
    }
}

impl Way {
    /// Returns the subdivision method of this way.
    pub const fn method(self) -> Method {
        match self {
            Self::Gather => Method::Gather,
            Self::Scatter => Method::Scatter,
            Self::NativeFresh | Self::Native => Method::Native,
        }
    }
}

/// A subdivision to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SubdivisionJob {
    /// The scheme with its options.
    pub subdivision: Subdivision,
    /// How the levels are computed and stored.
    pub way: Way,
    /// The number of levels; at least 1.
    pub levels: u32,
}

/// A subdivision that is ready to run repeatedly.
pub trait Refiner: Send {
    /// Computes all levels.
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme or the structure refuses a level.
    fn run(&mut self) -> Result<(), SubdivisionError>;

    /// Returns the number of faces of the last level, and a checksum of the vertex positions of
    /// this level. The checksum is the sum of |x| + 2|y| + 3|z| over all positions (x, y, z).
    fn result(&self) -> (usize, f64);
}

impl SubdivisionJob {
    /// Makes a subdivision by `scheme` with the default options of the scheme.
    pub fn new(scheme: Scheme, way: Way, levels: u32) -> Self {
        Self {
            subdivision: Subdivision::new(scheme),
            way,
            levels,
        }
    }

    /// Returns the subdivision that `operation` runs: one level; `None` if the operation is not a subdivision.
    pub fn of(operation: Operation) -> Option<Self> {
        let (scheme, method) = operation.subdivision()?;
        let way = match method {
            Method::Gather => Way::Gather,
            Method::Scatter => Way::Scatter,
            Method::Native => Way::Native,
        };
        Some(Self::new(scheme, way, 1))
    }

    /// Prepares the subdivision for the structure of `backend`. Returns `None` if the structure
    /// does not support this way to subdivide.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons` or if the scheme refuses
    /// `creases`.
    pub fn prepare(
        self,
        backend: &Backend,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Option<PreparedRefiner> {
        prepare(self, &backend.algorithms, polygons, creases)
    }
}

/// A subdivision that is ready to run, or the reason why the subdivision cannot run.
pub type PreparedRefiner = Result<Box<dyn Refiner>, SubdivisionError>;

/// Sets up `job` on a structure; `None` if the structure does not support this way to subdivide.
pub(crate) fn prepare(
    job: SubdivisionJob,
    algorithms: &Algorithms,
    polygons: &PolygonMesh,
    creases: &Creases,
) -> Option<PreparedRefiner> {
    if job.way.method() == Method::Native {
        let levels = algorithms.prepare_native(&job.subdivision, polygons, creases)?;
        return Some(levels.map(|levels| Box::new(InPlace { job, levels }) as Box<dyn Refiner>));
    }
    let rebuilt = Rebuilt::new(job, *algorithms, polygons, creases);
    Some(rebuilt.map(|rebuilt| Box::new(rebuilt) as Box<dyn Refiner>))
}

/// Computes each level as polygons and builds the structure from the polygons.
struct Rebuilt {
    job: SubdivisionJob,
    algorithms: Algorithms,
    mesh: Box<dyn AnyMesh>,
    creases: Creases,
    /// The polygons of the last level. The structure may have merged vertices.
    last: Step,
}

impl Rebuilt {
    fn new(
        job: SubdivisionJob,
        algorithms: Algorithms,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Result<Self, SubdivisionError> {
        let mesh = algorithms.build_level(polygons, 0)?;
        let control = Step {
            polygons: polygons.clone(),
            creases: creases.clone(),
        };
        Ok(Self {
            creases: mesh.creases(&job.subdivision, &control, 0)?,
            mesh,
            job,
            algorithms,
            last: Step::default(),
        })
    }
}

impl Refiner for Rebuilt {
    fn run(&mut self) -> Result<(), SubdivisionError> {
        let SubdivisionJob {
            subdivision,
            way,
            levels,
        } = self.job;
        let mut creases = self.creases.clone();
        // Drop the previous result, so that all runs do the same work.
        self.last = Step::default();
        let mut finest: Option<Box<dyn AnyMesh>> = None;
        for level in 0..levels {
            let mesh = finest.as_ref().unwrap_or(&self.mesh);
            let step = mesh.subdivide(&subdivision, way.method(), &creases, level)?;
            let next = self.algorithms.build_level(&step.polygons, level + 1)?;
            creases = next.creases(&subdivision, &step, level + 1)?;
            self.last = step;
            finest = Some(next);
        }
        Ok(())
    }

    fn result(&self) -> (usize, f64) {
        let polygons = &self.last.polygons;
        (
            polygons.face_count(),
            field_sum(polygons.positions().iter().copied()),
        )
    }
}

/// Refines the tables of the structure, with one mesh for each level.
struct InPlace {
    job: SubdivisionJob,
    levels: Box<dyn NativeLevels>,
}

impl Refiner for InPlace {
    fn run(&mut self) -> Result<(), SubdivisionError> {
        let job = &self.job;
        let reuse = job.way != Way::NativeFresh;
        self.levels.run(&job.subdivision, job.levels, reuse)
    }

    fn result(&self) -> (usize, f64) {
        (
            self.levels.face_count(),
            field_sum(self.levels.positions().iter().copied()),
        )
    }
}
