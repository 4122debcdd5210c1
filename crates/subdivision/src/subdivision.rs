//! A scheme with its options, one step at a time.

use mesh_core::{Creases, FaceId, MAX_ROWS, MeshQuery, PolygonError, Refine, Split};

use crate::bilinear::Bilinear;
use crate::catmull_clark::CatmullClark;
use crate::error::SubdivisionError;
use crate::loop_scheme::Loop;
use crate::midpoint::Midpoint;
use crate::options::{Boundary, Creasing, LoopWeights};
use crate::scheme::{Method, Scheme};
use crate::step::Step;
use crate::{butterfly, doo_sabin, gather, native, scatter, sqrt3};

/// A step by the mask of the scheme, for those that are no more than a mask; then the other schemes.
macro_rules! by_mask {
    ($self:ident, $mask:ident => $step:expr, { $($others:tt)* }) => {
        match $self.scheme {
            Scheme::CatmullClark => { let $mask = CatmullClark; $step }
            Scheme::Loop => { let $mask = Loop::new($self.loop_weights); $step }
            Scheme::Midpoint => { let $mask = Midpoint; $step }
            Scheme::Bilinear => { let $mask = Bilinear; $step }
            $($others)*
        }
    };
}

/// A scheme and its options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subdivision {
    /// What rules there are.
    pub scheme: Scheme,
    /// What the rim does; of Catmull–Clark and Loop.
    pub boundary: Boundary,
    /// How sharpness passes on; of Catmull–Clark and Loop.
    pub creasing: Creasing,
    /// Whose weights; of Loop.
    pub loop_weights: LoopWeights,
}

impl Subdivision {
    /// `scheme` with the options that are usual.
    pub fn new(scheme: Scheme) -> Self {
        Self {
            scheme,
            boundary: Boundary::default(),
            creasing: Creasing::default(),
            loop_weights: LoopWeights::default(),
        }
    }

    /// One step, by queries for each new point.
    ///
    /// `creases` are those of `mesh.to_polygons()`, from [`control`](Self::control) or the step
    /// before; `level` counts the steps before this one.
    ///
    /// # Errors
    ///
    /// What the scheme cannot split.
    pub fn gather<M: MeshQuery>(
        &self,
        mesh: &M,
        creases: &Creases,
        level: u32,
    ) -> Result<Step, SubdivisionError> {
        let corners = self.check(mesh)?;
        by_mask!(self, mask => gather::step(mesh, mask, creases, self.creasing, corners), {
            Scheme::Sqrt3 => sqrt3::gather(mesh, is_second(level)),
            Scheme::Butterfly => butterfly::gather(mesh),
            Scheme::DooSabin => doo_sabin::gather(mesh),
        })
    }

    /// One step, by a pass over the faces. As [`gather`](Self::gather), but for the order of edge
    /// points, which come as the faces name them.
    ///
    /// # Errors
    ///
    /// What the scheme cannot split, or that it is no pass over faces.
    pub fn scatter<M: MeshQuery>(
        &self,
        mesh: &M,
        creases: &Creases,
        level: u32,
    ) -> Result<Step, SubdivisionError> {
        let corners = self.check(mesh)?;
        by_mask!(self, mask => scatter::step(mesh, mask, creases, self.creasing, corners), {
            Scheme::Sqrt3 => sqrt3::scatter(mesh, is_second(level)),
            Scheme::Butterfly => Err(self.no_method(Method::Scatter, "gather or native")),
            Scheme::DooSabin => doo_sabin::scatter(mesh),
        })
    }

    /// One step in the structure's own tables, into `child`, whose tables are used again where they
    /// are large enough; yields the creases of the child. Runs on the threads of the current rayon
    /// pool, with the same bytes on any number.
    ///
    /// `numbers` are filled for `mesh`, and may be used again for other meshes.
    ///
    /// # Errors
    ///
    /// What the scheme cannot split, or the structure cannot do in its own tables; `child` is as it
    /// was then.
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
            Scheme::Sqrt3 => sqrt3::native(mesh, numbers, is_second(level), child),
            Scheme::Butterfly => butterfly::native(mesh, numbers, child),
            Scheme::DooSabin => Err(self.not_by_polygons()),
        })
    }

    /// How step `level`, counted from 0, splits faces; `None` if it does not.
    pub fn split(&self, level: u32) -> Option<Split> {
        match self.scheme.kind().split? {
            Split::Sqrt3 { .. } => Some(Split::Sqrt3 {
                trisect: is_second(level),
            }),
            split => Some(split),
        }
    }

    /// How many parts a face of `degree` corners is split into.
    pub(crate) fn parts_of(&self, degree: usize) -> usize {
        match self.scheme.kind().split {
            Some(Split::Triangles) => 4,
            _ => degree,
        }
    }

    /// That native steps take no polygons.
    pub(crate) fn not_by_polygons(&self) -> SubdivisionError {
        self.no_method(Method::Native, "gather or scatter")
    }

    fn no_method(&self, method: Method, choice: &'static str) -> SubdivisionError {
        SubdivisionError::NoMethod {
            scheme: self.scheme,
            method,
            choice,
        }
    }

    /// Checks that the scheme can split the faces of `mesh`, and that the result has names for all;
    /// O(faces). Returns how many corners the faces have together.
    fn check<M: MeshQuery>(&self, mesh: &M) -> Result<usize, SubdivisionError> {
        let kind = self.scheme.kind();
        let (mut corners, mut odd) = (0, None);
        for (number, f) in (0..).zip(mesh.faces()) {
            let degree = mesh.face_vertices(f).count();
            corners += degree;
            if degree != 3 && kind.takes == "triangles" && odd.is_none() {
                odd = Some((FaceId::new(number), degree));
            }
        }
        if let Some((face, degree)) = odd {
            let scheme = self.scheme;
            return Err(SubdivisionError::NotATriangle {
                scheme,
                face,
                degree,
            });
        }
        // No step makes more than four corners of one, and no more edges than corners; but for √3 where
        // boundaries are cut, which counts them.
        let limit = MAX_ROWS;
        if corners.saturating_mul(4) > limit {
            let elements = "corners";
            return Err(PolygonError::TooMany { elements, limit }.into());
        }
        Ok(corners)
    }
}

/// Whether step `level`, counted from 0, is one of those in which √3 cuts the edges of boundaries.
fn is_second(level: u32) -> bool {
    level % 2 == 1
}
