//! The algorithms on a structure that is selected at run time.
//!
//! Every algorithm of Sixfold is generic over the structure, so a program that selects the structure
//! at run time compiles it six times, and so does every crate of this program. The functions of this
//! module are compiled here, once for each structure. The module exists with the feature `algorithms`,
//! which is off by default, because a program that uses one structure needs none of them.
//!
//! ```
//! use sixfold::algorithms::Algorithms;
//! use sixfold::{operators::Smoothing, shapes};
//!
//! let half_edge = Algorithms::find("half-edge").expect("one of the six");
//! let mut mesh = half_edge.build(&shapes::icosahedron())?;
//! mesh.smooth(&Smoothing::default())?;
//! assert_eq!(mesh.to_polygons().face_count(), 20);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::any::Any;
use std::ops::ControlFlow;

use sixfold_core::{
    BuildError, Creases, FaceId, MeshEdit, MeshQuery, MoveError, Point, PolygonMesh, Refine,
    Representation,
};
use sixfold_operators::{DualError, Smoothing, SmoothingError, dual, smoothed};
use sixfold_remeshing::{
    Decimated, Decimation, RemeshError, Remeshed, Remeshing, decimate, decimate_watched,
    remesh_watched,
};
use sixfold_subdivision::{
    LocalError, LocalMesh, Method, Selection, Step, Subdivision, SubdivisionError, build_level,
    subdivide_by, subdivide_native_watched,
};

/// A function that long algorithms call with their progress. `ControlFlow::Break` ends the algorithm.
pub type Watch<'w> = &'w mut dyn FnMut(usize) -> ControlFlow<()>;

/// A function that subdivisions call after each level, with the level and its number of faces.
/// `ControlFlow::Break` ends the subdivision.
pub type WatchLevels<'w> = &'w mut dyn FnMut(u32, usize) -> ControlFlow<()>;

/// A mesh in a structure that was selected at run time, with the algorithms that query the mesh.
pub trait AnyMesh: Send {
    /// Converts the mesh to polygons.
    fn to_polygons(&self) -> PolygonMesh;

    /// Returns the creases for the step `level` on this mesh, which was built from `step`; see
    /// [`Subdivision::level_creases`].
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme has no rules for creases, but there are creases.
    fn creases(
        &self,
        subdivision: &Subdivision,
        step: &Step,
        level: u32,
    ) -> Result<Creases, SubdivisionError>;

    /// Runs one step of a subdivision by gather or scatter; see [`Subdivision::step`].
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme cannot split the mesh or does not have the method.
    fn subdivide(
        &self,
        subdivision: &Subdivision,
        method: Method,
        creases: &Creases,
        level: u32,
    ) -> Result<Step, SubdivisionError>;

    /// Returns the selected faces; see [`Selection::faces`].
    ///
    /// # Errors
    ///
    /// Returns an error if the selection is invalid or a face is not a triangle.
    fn select(&self, selection: &Selection) -> Result<Vec<FaceId>, LocalError>;

    /// Refines the `chosen` faces of `local`, of which this mesh was built; see
    /// [`LocalMesh::refined`].
    ///
    /// # Errors
    ///
    /// Returns an error if a face cannot be refined.
    fn refine(&self, local: &LocalMesh, chosen: &[FaceId]) -> Result<LocalMesh, LocalError>;

    /// Smooths the mesh; see [`smoothed`].
    ///
    /// # Errors
    ///
    /// Returns an error if the options are invalid, or if the structure cannot hold the moved vertices.
    fn smooth(&mut self, smoothing: &Smoothing) -> Result<(), SmoothError>;

    /// Returns the dual of the mesh; see [`dual`].
    ///
    /// # Errors
    ///
    /// Returns an error if the mesh has no dual.
    fn dual(&self) -> Result<PolygonMesh, DualError>;
}

/// The error of [`AnyMesh::smooth`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SmoothError {
    /// The positions were not computed.
    #[error(transparent)]
    Smoothing(#[from] SmoothingError),
    /// The structure refused the new positions.
    #[error(transparent)]
    Move(#[from] MoveError),
}

impl<M: Representation> AnyMesh for M {
    fn to_polygons(&self) -> PolygonMesh {
        Representation::to_polygons(self)
    }

    fn creases(
        &self,
        subdivision: &Subdivision,
        step: &Step,
        level: u32,
    ) -> Result<Creases, SubdivisionError> {
        subdivision.level_creases(self, step, level)
    }

    fn subdivide(
        &self,
        subdivision: &Subdivision,
        method: Method,
        creases: &Creases,
        level: u32,
    ) -> Result<Step, SubdivisionError> {
        subdivision.step(method, self, creases, level)
    }

    fn select(&self, selection: &Selection) -> Result<Vec<FaceId>, LocalError> {
        selection.faces(self)
    }

    fn refine(&self, local: &LocalMesh, chosen: &[FaceId]) -> Result<LocalMesh, LocalError> {
        local.refined(self, chosen)
    }

    fn smooth(&mut self, smoothing: &Smoothing) -> Result<(), SmoothError> {
        let positions = smoothed(self, smoothing)?;
        Ok(self.set_positions(&positions)?)
    }

    fn dual(&self) -> Result<PolygonMesh, DualError> {
        dual(self)
    }
}

/// A mesh in the editable form of a structure that was selected at run time, with the algorithms that
/// edit the mesh.
pub trait AnyEditableMesh {
    /// Returns the number of faces.
    fn face_count(&self) -> usize;

    /// Converts the mesh to polygons.
    fn to_polygons(&self) -> PolygonMesh;

    /// Decimates the mesh; see [`decimate_watched`].
    ///
    /// # Errors
    ///
    /// Returns an error if the options are invalid or a face is not a triangle.
    fn decimate(
        &mut self,
        decimation: &Decimation,
        watch: Watch<'_>,
    ) -> Result<Decimated, RemeshError>;

    /// Remeshes the mesh; see [`remesh_watched`].
    ///
    /// # Errors
    ///
    /// Returns an error if the options are invalid or a face is not a triangle.
    fn remesh(&mut self, remeshing: &Remeshing, watch: Watch<'_>) -> Result<Remeshed, RemeshError>;
}

impl<M: Representation + MeshEdit> AnyEditableMesh for M {
    fn face_count(&self) -> usize {
        MeshQuery::face_count(self)
    }

    fn to_polygons(&self) -> PolygonMesh {
        Representation::to_polygons(self)
    }

    fn decimate(
        &mut self,
        decimation: &Decimation,
        watch: Watch<'_>,
    ) -> Result<Decimated, RemeshError> {
        decimate_watched(self, decimation, watch)
    }

    fn remesh(&mut self, remeshing: &Remeshing, watch: Watch<'_>) -> Result<Remeshed, RemeshError> {
        remesh_watched(self, remeshing, watch)
    }
}

/// The levels of a native subdivision, in meshes that the next run reuses.
pub trait NativeLevels: Send {
    /// Computes `levels` levels; `reuse` keeps the meshes of the last run, whose tables are then
    /// overwritten.
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme or the structure refuses a level.
    fn run(
        &mut self,
        subdivision: &Subdivision,
        levels: u32,
        reuse: bool,
    ) -> Result<(), SubdivisionError>;

    /// Returns the number of faces of the last level.
    fn face_count(&self) -> usize;

    /// Returns the positions of the last level.
    fn positions(&self) -> &[Point];
}

/// A native subdivision that is ready to run, or the reason why it cannot run.
pub type PreparedLevels = Result<Box<dyn NativeLevels>, SubdivisionError>;

struct Levels<M: Refine> {
    mesh: M,
    creases: Creases,
    levels: Vec<M>,
    numbers: M::EdgeNumbers,
}

impl<M: Refine> Levels<M> {
    fn last(&self) -> &M {
        self.levels.last().unwrap_or(&self.mesh)
    }
}

impl<M: Refine> NativeLevels for Levels<M> {
    fn run(
        &mut self,
        subdivision: &Subdivision,
        levels: u32,
        reuse: bool,
    ) -> Result<(), SubdivisionError> {
        if !reuse {
            self.levels.clear();
            self.numbers = M::EdgeNumbers::default();
        }
        self.levels.resize_with(levels as usize, M::empty);
        let mut creases = self.creases.clone();
        let mut parent = &self.mesh;
        for (level, child) in (0..).zip(&mut self.levels) {
            creases = subdivision.refine_into(parent, &creases, level, &mut self.numbers, child)?;
            parent = child;
        }
        Ok(())
    }

    fn face_count(&self) -> usize {
        self.last().face_count()
    }

    fn positions(&self) -> &[Point] {
        self.last().position_rows()
    }
}

type Build = fn(&PolygonMesh) -> Result<Box<dyn AnyMesh>, BuildError>;

/// The functions for edits.
#[derive(Clone, Copy)]
struct Editing {
    build: fn(&PolygonMesh) -> Result<Box<dyn AnyEditableMesh>, BuildError>,
    decimate: fn(&mut dyn Any, &Decimation) -> Option<Result<Decimated, RemeshError>>,
}

/// The functions for native subdivision.
#[derive(Clone, Copy)]
struct Native {
    subdivide: fn(
        &Subdivision,
        &PolygonMesh,
        &Creases,
        u32,
        WatchLevels<'_>,
    ) -> Result<Step, SubdivisionError>,
    prepare: fn(&Subdivision, &PolygonMesh, &Creases) -> PreparedLevels,
}

/// The algorithms on one structure, as functions without type parameters.
///
/// [`Algorithms::find`] returns those of a structure of Sixfold, and [`Algorithms::new`] makes them for
/// any other structure.
#[derive(Clone, Copy)]
pub struct Algorithms {
    structure: &'static str,
    build: Build,
    editing: Option<Editing>,
    native: Option<Native>,
}

impl Algorithms {
    /// Makes the algorithms on the structure `M`, without those that edit and without native
    /// subdivision.
    pub const fn new<M: Representation + 'static>() -> Self {
        Self {
            structure: M::NAME,
            build: |polygons| Ok(Box::new(M::from_polygons(polygons)?)),
            editing: None,
            native: None,
        }
    }

    /// Adds the algorithms that edit `M`, the editable form of the structure.
    #[must_use]
    pub const fn with_edits<M: Representation + MeshEdit + 'static>(self) -> Self {
        let editing = Editing {
            build: |polygons| Ok(Box::new(M::from_polygons(polygons)?)),
            decimate: |mesh, decimation| Some(decimate(mesh.downcast_mut::<M>()?, decimation)),
        };
        Self {
            editing: Some(editing),
            ..self
        }
    }

    /// Adds native subdivision by `M`, the form of the structure that splits its own tables.
    #[must_use]
    pub const fn with_refinement<M: Refine + 'static>(self) -> Self {
        let native = Native {
            subdivide: subdivide_native_watched::<M>,
            prepare: |subdivision, polygons, creases| {
                let mesh = build_level::<M>(polygons, 0)?;
                let creases = subdivision.control_creases(&mesh, polygons, creases)?;
                Ok(Box::new(Levels {
                    mesh,
                    creases,
                    levels: Vec::new(),
                    numbers: M::EdgeNumbers::default(),
                }))
            },
        };
        Self {
            native: Some(native),
            ..self
        }
    }

    /// Returns the algorithms on all structures, in the order of [`structures!`](crate::structures).
    pub const ALL: &'static [Self] = {
        macro_rules! all {
            ($({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? $(, walk: $walk:ty)? })+) => {
                &[$(
                    Algorithms::new::<$query>()
                        $(.with_edits::<$edit>())?
                        $(.with_refinement::<$refine>())?
                ),+]
            };
        }
        crate::structures!([all])
    };

    /// Returns the algorithms on the structure called `name`; `None` if there is no such structure.
    pub fn find(name: &str) -> Option<Self> {
        let mut all = Self::ALL.iter();
        all.find(|algorithms| algorithms.structure == name).copied()
    }

    /// Returns the name of the structure.
    pub const fn structure(&self) -> &'static str {
        self.structure
    }

    /// Builds the structure.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`.
    pub fn build(&self, polygons: &PolygonMesh) -> Result<Box<dyn AnyMesh>, BuildError> {
        (self.build)(polygons)
    }

    /// Builds the editable form of the structure; `None` if it has none.
    pub fn build_editable(
        &self,
        polygons: &PolygonMesh,
    ) -> Option<Result<Box<dyn AnyEditableMesh>, BuildError>> {
        Some((self.editing?.build)(polygons))
    }

    /// Decimates `mesh`, whose type is known to the caller. The compiled code is in the crate that made
    /// these algorithms, so a generic caller does not compile the decimation again. Returns `None` if the
    /// type of `mesh` is not the editable form of the structure.
    ///
    /// # Errors
    ///
    /// Returns an error if the options are invalid or a face is not a triangle.
    pub fn decimate(
        &self,
        mesh: &mut dyn Any,
        decimation: &Decimation,
    ) -> Option<Result<Decimated, RemeshError>> {
        (self.editing?.decimate)(mesh, decimation)
    }

    /// Builds the structure from the polygons of the level before the step `level`.
    ///
    /// # Errors
    ///
    /// Returns [`SubdivisionError::Build`] if the structure cannot hold the polygons.
    pub fn build_level(
        &self,
        polygons: &PolygonMesh,
        level: u32,
    ) -> Result<Box<dyn AnyMesh>, SubdivisionError> {
        self.build(polygons)
            .map_err(|refusal| SubdivisionError::Build {
                structure: self.structure,
                level,
                refusal,
            })
    }

    /// Runs `levels` steps of a subdivision. Methods other than native build the structure for each
    /// step; see [`subdivide_watched`](sixfold_subdivision::subdivide_watched) and
    /// [`subdivide_native_watched`].
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme cannot split the mesh, if the structure cannot hold a level or
    /// does not have the method, and if `watch` ends the subdivision.
    pub fn subdivide(
        &self,
        subdivision: &Subdivision,
        method: Method,
        polygons: &PolygonMesh,
        creases: &Creases,
        levels: u32,
        watch: WatchLevels<'_>,
    ) -> Result<Step, SubdivisionError> {
        match (method, self.native) {
            (Method::Native, Some(native)) => {
                (native.subdivide)(subdivision, polygons, creases, levels, watch)
            }
            _ => subdivide_by(
                subdivision,
                polygons,
                creases,
                levels,
                watch,
                &mut |step, level| {
                    let mesh = self.build_level(&step.polygons, level)?;
                    let creases = mesh.creases(subdivision, step, level)?;
                    mesh.subdivide(subdivision, method, &creases, level)
                },
            ),
        }
    }

    /// Prepares a native subdivision that runs repeatedly; `None` if the structure has no such method.
    ///
    /// # Errors
    ///
    /// Returns an error if the structure cannot hold `polygons` or the scheme refuses `creases`.
    pub fn prepare_native(
        &self,
        subdivision: &Subdivision,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Option<PreparedLevels> {
        Some((self.native?.prepare)(subdivision, polygons, creases))
    }
}
