//! A scheme with its options, run one step at a time.

use sixfold_core::{Creases, FaceId, MAX_ROWS, MeshQuery, PolygonError, Refine, Split};

use crate::catmull_clark::CatmullClark;
use crate::error::SubdivisionError;
use crate::linear::Linear;
use crate::loop_scheme::Loop;
use crate::options::{BoundaryRule, Creasing, LoopWeights};
use crate::scheme::{FaceKind, Method, Scheme};
use crate::step::Step;
use crate::{butterfly, doo_sabin, gather, native, scatter, sqrt3};

/// Runs a step with the mask of the scheme. The call lists the other schemes, which have no mask.
macro_rules! by_mask {
    ($self:ident, $mask:ident => $step:expr, { $($others:tt)* }) => {
        match $self.scheme {
            Scheme::CatmullClark => { let $mask = CatmullClark; $step }
            Scheme::Loop => { let $mask = Loop::new($self.loop_weights); $step }
            Scheme::Midpoint => { let $mask = Linear(Split::Triangles); $step }
            Scheme::Bilinear => { let $mask = Linear(Split::Quads); $step }
            $($others)*
        }
    };
}

/// A scheme and its options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subdivision {
    /// The scheme.
    pub scheme: Scheme,
    /// The boundary rule. Only Catmull–Clark and Loop use this option.
    pub boundary: BoundaryRule,
    /// The rule for the sharpness of the two halves of an edge. Only Catmull–Clark and Loop use
    /// this option.
    pub creasing: Creasing,
    /// The weights of extraordinary vertices. Only Loop uses this option.
    pub loop_weights: LoopWeights,
}

impl Subdivision {
    /// Returns `scheme` with the default options.
    pub fn new(scheme: Scheme) -> Self {
        Self {
            scheme,
            boundary: BoundaryRule::default(),
            creasing: Creasing::default(),
            loop_weights: LoopWeights::default(),
        }
    }

    /// Runs one step with the method gather: computes each new point with queries.
    ///
    /// `creases` are the creases of `mesh.to_polygons()`, from
    /// [`control_creases`](Self::control_creases) or from the previous step. `level` is the number
    /// of previous steps.
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme cannot split the mesh.
    pub fn gather<M: MeshQuery>(
        &self,
        mesh: &M,
        creases: &Creases,
        level: u32,
    ) -> Result<Step, SubdivisionError> {
        let corners = self.check(mesh)?;
        by_mask!(self, mask => gather::step(mesh, mask, creases, self.creasing, corners), {
            Scheme::Sqrt3 => sqrt3::gather(mesh, trisects(level)),
            Scheme::Butterfly => butterfly::gather(mesh),
            Scheme::DooSabin => doo_sabin::gather(mesh),
        })
    }

    /// Runs one step with the method scatter: one pass over the faces. `creases` and `level` have
    /// the same meaning as in [`gather`](Self::gather). The result also equals the result of
    /// [`gather`](Self::gather), except for the order of the edge points: the edge points have the
    /// order in which the faces list the edges.
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme cannot split the mesh, or cannot run as one pass over the
    /// faces.
    pub fn scatter<M: MeshQuery>(
        &self,
        mesh: &M,
        creases: &Creases,
        level: u32,
    ) -> Result<Step, SubdivisionError> {
        let corners = self.check(mesh)?;
        by_mask!(self, mask => scatter::step(mesh, mask, creases, self.creasing, corners), {
            Scheme::Sqrt3 => sqrt3::scatter(mesh, trisects(level)),
            Scheme::Butterfly => Err(self.method_error(Method::Scatter, "gather or native")),
            Scheme::DooSabin => doo_sabin::scatter(mesh),
        })
    }

    /// Runs one step with the method gather or scatter. `creases` and `level` have the same meaning as
    /// in [`gather`](Self::gather).
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme cannot split the mesh, if it does not have the method, and for
    /// [`Method::Native`], which [`refine_into`](Self::refine_into) runs.
    pub fn step<M: MeshQuery>(
        &self,
        method: Method,
        mesh: &M,
        creases: &Creases,
        level: u32,
    ) -> Result<Step, SubdivisionError> {
        match method {
            Method::Gather => self.gather(mesh, creases, level),
            Method::Scatter => self.scatter(mesh, creases, level),
            Method::Native => Err(self.native_error()),
        }
    }

    /// Runs one step with the method native: splits the tables of the structure, and stores the
    /// result in `child`. Returns the creases of `child`. The tables of `child` are reused if the
    /// tables are large enough. With the feature `rayon`, the step runs on the threads of the
    /// current rayon pool. The result has the same bytes for any number of threads.
    ///
    /// `creases` and `level` have the same meaning as in [`gather`](Self::gather). The step
    /// overwrites `numbers`, so `numbers` may come from another mesh.
    ///
    /// # Errors
    ///
    /// Returns an error if the scheme cannot split the mesh, or if the structure cannot split its
    /// own tables. After an error, `child` is unchanged.
    pub fn refine_into<M: Refine>(
        &self,
        mesh: &M,
        creases: &Creases,
        level: u32,
        numbers: &mut M::EdgeNumbers,
        child: &mut M,
    ) -> Result<Creases, SubdivisionError> {
        mesh.number_edges(numbers);
        by_mask!(self, mask => native::step(mesh, mask, creases, self.creasing, numbers, child), {
            Scheme::Sqrt3 => sqrt3::native(mesh, numbers, trisects(level), child),
            Scheme::Butterfly => butterfly::native(mesh, numbers, child),
            Scheme::DooSabin => Err(self.native_error()),
        })
    }

    /// Returns the split that step `level` applies to the faces, or `None` if the step does not
    /// split faces. The first step has level 0.
    pub fn split(&self, level: u32) -> Option<Split> {
        match self.scheme.properties().split? {
            Split::Sqrt3 { .. } => Some(Split::Sqrt3 {
                trisect: trisects(level),
            }),
            split => Some(split),
        }
    }

    /// Returns the number of parts of a face with `degree` corners.
    pub(crate) fn parts_of(&self, degree: usize) -> usize {
        match self.scheme.properties().split {
            Some(Split::Triangles) => 4,
            _ => degree,
        }
    }

    /// Returns the error for a native step that is not possible.
    pub(crate) fn native_error(&self) -> SubdivisionError {
        self.method_error(Method::Native, "gather or scatter")
    }

    fn method_error(&self, method: Method, choice: &'static str) -> SubdivisionError {
        SubdivisionError::NoMethod {
            scheme: self.scheme,
            method,
            choice,
        }
    }

    /// Checks that the scheme can split the faces of `mesh`, and that 32-bit handles can number the
    /// result. Returns the total number of corners of the faces. O(faces).
    fn check<M: MeshQuery>(&self, mesh: &M) -> Result<usize, SubdivisionError> {
        let properties = self.scheme.properties();
        let (mut corners, mut non_triangle) = (0, None);
        for (number, f) in (0..).zip(mesh.faces()) {
            let degree = mesh.face_vertices(f).count();
            corners += degree;
            if degree != 3 && properties.takes == FaceKind::Triangles && non_triangle.is_none() {
                non_triangle = Some((FaceId::new(number), degree));
            }
        }
        if let Some((face, degree)) = non_triangle {
            let scheme = self.scheme;
            return Err(SubdivisionError::NotATriangle {
                scheme,
                face,
                degree,
            });
        }
        // A step makes at most four corners from one corner, and at most as many edges as corners.
        // The only exception is √3 at boundaries; that step checks its own size.
        let limit = MAX_ROWS;
        if corners.saturating_mul(4) > limit {
            let elements = "corners";
            return Err(PolygonError::TooMany { elements, limit }.into());
        }
        Ok(corners)
    }
}

/// Returns whether √3 cuts boundary edges in step `level`. The first step has level 0.
fn trisects(level: u32) -> bool {
    level % 2 == 1
}
