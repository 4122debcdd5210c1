//! Compact and editable meshes as different types, so that only editable meshes have the cost
//! of editing.

use std::fmt::Debug;

use crate::tables::face_spans::{FaceSpans, ScatteredFaces};
use crate::tables::holes::{HoleSet, Holes, NoHoles};
use crate::tables::probe::Probe;

/// The type parameter that states whether elements of a mesh can be deleted: [`Editable`] if they
/// can, [`Compact`] if they cannot. The trait is sealed, so only [`Editable`] and [`Compact`]
/// implement the trait.
///
/// Queries of an editable mesh check whether each visited element was deleted; queries of a compact
/// mesh need no such check. In measurements, the check for deleted elements added some 10 % to the
/// time of sweeps over a half-edge mesh, and up to 100 % if the work per element was very small.
pub trait Editing: sealed::Sealed + Clone + Copy + Debug + Send + Sync + 'static {
    /// True if elements can be deleted, so that tables can have holes (rows of deleted elements).
    const CAN_DELETE: bool;

    /// The type of the set of holes of a table. A hole is the row of a deleted element.
    type Holes<P: Probe>: HoleSet<P>;

    /// The type that stores the faces of a mesh after an edit has changed the degree of a face.
    type Scattered<P: Probe>: AsRef<ScatteredFaces<P>> + Clone + Debug + Send + Sync;

    /// Converts the corner ranges of the faces of a compact mesh to the form for a mesh with this
    /// parameter.
    fn spans<P: Probe>(spans: FaceSpans<P>) -> FaceSpans<P, Self>;

    /// Returns an empty set of holes. In an editable mesh, `name` is the name of the table that
    /// stores the set.
    fn no_holes<P: Probe>(name: &'static str, probe: P) -> Self::Holes<P>;

    /// Returns the same set of holes in a table that reports its reads and writes to `probe`.
    fn probed_holes<P: Probe, Q: Probe>(holes: Self::Holes<P>, probe: Q) -> Self::Holes<Q>;

    /// Returns the same faces in tables that report their reads and writes to `probe`.
    fn probed_faces<P: Probe, Q: Probe>(faces: Self::Scattered<P>, probe: Q) -> Self::Scattered<Q>;
}

/// The parameter of meshes whose elements cannot be deleted: every row of a table belongs to an
/// element.
#[derive(Clone, Copy, Debug)]
pub struct Compact;

/// The parameter of meshes whose elements can be deleted. A row of a table can be a hole (the row
/// of a deleted element), and the corners of a face can be anywhere in the table of corners.
#[derive(Clone, Copy, Debug)]
pub struct Editable;

mod sealed {
    /// A trait that other crates cannot implement, because they cannot name it.
    pub trait Sealed {}
}

impl sealed::Sealed for Compact {}
impl sealed::Sealed for Editable {}

impl Editing for Compact {
    const CAN_DELETE: bool = false;

    type Holes<P: Probe> = NoHoles;
    type Scattered<P: Probe> = NoScatteredFaces;

    fn spans<P: Probe>(spans: FaceSpans<P>) -> FaceSpans<P> {
        spans
    }

    #[inline]
    fn no_holes<P: Probe>(_: &'static str, _: P) -> NoHoles {
        NoHoles
    }

    #[inline]
    fn probed_holes<P: Probe, Q: Probe>(NoHoles: NoHoles, _: Q) -> NoHoles {
        NoHoles
    }

    fn probed_faces<P: Probe, Q: Probe>(faces: NoScatteredFaces, _: Q) -> NoScatteredFaces {
        faces
    }
}

impl Editing for Editable {
    const CAN_DELETE: bool = true;

    type Holes<P: Probe> = Holes<P>;
    type Scattered<P: Probe> = ScatteredFaces<P>;

    fn spans<P: Probe>(spans: FaceSpans<P>) -> FaceSpans<P, Self> {
        spans.into()
    }

    fn no_holes<P: Probe>(name: &'static str, probe: P) -> Holes<P> {
        Holes::new(name).probed(probe)
    }

    fn probed_holes<P: Probe, Q: Probe>(holes: Holes<P>, probe: Q) -> Holes<Q> {
        holes.probed(probe)
    }

    fn probed_faces<P: Probe, Q: Probe>(faces: ScatteredFaces<P>, probe: Q) -> ScatteredFaces<Q> {
        faces.probed(probe)
    }
}

/// The type of [`Compact`] meshes in place of `ScatteredFaces`. This type has no values.
#[derive(Clone, Copy, Debug)]
pub enum NoScatteredFaces {}

impl<P: Probe> AsRef<ScatteredFaces<P>> for NoScatteredFaces {
    fn as_ref(&self) -> &ScatteredFaces<P> {
        match *self {}
    }
}
