//! A subdivision that can be timed: a scheme, a way to run the scheme, and a number of levels.

use sixfold::subdivision::{
    Method, Scheme, Subdivision, SubdivisionError, build_level, renumbered,
};
use sixfold::{Creases, Point, PolygonMesh, Refine, Representation};

use crate::backend::Backend;

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
        let functions = backend.query_functions();
        functions.prepare_refiner(self, polygons, creases)
    }

    fn control_mesh<M: Representation>(
        &self,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Result<(M, Creases), SubdivisionError> {
        let mesh = build_level::<M>(polygons, 0)?;
        let creases = self.subdivision.control_creases(&mesh, polygons, creases)?;
        Ok((mesh, creases))
    }
}

/// A subdivision that is ready to run, or the reason why the subdivision cannot run.
pub type PreparedRefiner = Result<Box<dyn Refiner>, SubdivisionError>;

/// Sets up `job` on `M`. The structure is rebuilt for each level.
pub(crate) fn prepare_rebuilt<M: Representation + 'static>(
    job: SubdivisionJob,
    polygons: &PolygonMesh,
    creases: &Creases,
) -> PreparedRefiner {
    let (mesh, creases) = job.control_mesh::<M>(polygons, creases)?;
    Ok(Box::new(Rebuilt {
        job,
        mesh,
        creases,
        last: PolygonMesh::default(),
    }))
}

/// Sets up `job` on `M`. The tables of the structure are refined.
pub(crate) fn prepare_native<M: Refine + 'static>(
    job: SubdivisionJob,
    polygons: &PolygonMesh,
    creases: &Creases,
) -> PreparedRefiner {
    let (mesh, creases) = job.control_mesh::<M>(polygons, creases)?;
    Ok(Box::new(InPlace {
        job,
        mesh,
        creases,
        levels: Vec::new(),
        numbers: M::EdgeNumbers::default(),
    }))
}

/// Computes each level as polygons and builds the structure from the polygons.
struct Rebuilt<M> {
    job: SubdivisionJob,
    mesh: M,
    creases: Creases,
    /// The polygons of the last level. The structure may have merged vertices.
    last: PolygonMesh,
}

impl<M: Representation + 'static> Refiner for Rebuilt<M> {
    fn run(&mut self) -> Result<(), SubdivisionError> {
        let subdivision = &self.job.subdivision;
        let mut creases = self.creases.clone();
        // Drop the previous result, so that all runs do the same work.
        self.last = PolygonMesh::default();
        let mut finest: Option<M> = None;
        for level in 0..self.job.levels {
            let mesh = finest.as_ref().unwrap_or(&self.mesh);
            let step = match self.job.way {
                Way::Gather => subdivision.gather(mesh, &creases, level)?,
                _ => subdivision.scatter(mesh, &creases, level)?,
            };
            let next = build_level::<M>(&step.polygons, level + 1)?;
            creases = renumbered(&next, &step.polygons, &step.creases);
            self.last = step.polygons;
            finest = Some(next);
        }
        Ok(())
    }

    fn result(&self) -> (usize, f64) {
        let points = self.last.positions().iter().copied();
        (self.last.face_count(), checksum(points))
    }
}

/// Refines the tables of the structure, with one mesh for each level.
struct InPlace<M: Refine> {
    job: SubdivisionJob,
    mesh: M,
    creases: Creases,
    levels: Vec<M>,
    numbers: M::EdgeNumbers,
}

impl<M: Refine + 'static> Refiner for InPlace<M> {
    fn run(&mut self) -> Result<(), SubdivisionError> {
        if self.job.way == Way::NativeFresh {
            self.levels.clear();
            self.numbers = M::EdgeNumbers::default();
        }
        self.levels.resize_with(self.job.levels as usize, M::empty);
        let mut creases = self.creases.clone();
        let mut parent = &self.mesh;
        for (level, child) in (0..).zip(&mut self.levels) {
            let subdivision = &self.job.subdivision;
            creases = subdivision.refine_into(parent, &creases, level, &mut self.numbers, child)?;
            parent = child;
        }
        Ok(())
    }

    fn result(&self) -> (usize, f64) {
        let mesh = self.levels.last().unwrap_or(&self.mesh);
        (
            mesh.face_count(),
            checksum(mesh.position_rows().iter().copied()),
        )
    }
}

fn checksum(points: impl Iterator<Item = Point>) -> f64 {
    let each = points.map(|p| {
        let [x, y, z] = p.to_array().map(|x| f64::from(x).abs());
        x + 2.0 * y + 3.0 * z
    });
    each.sum()
}
