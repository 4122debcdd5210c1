//! Compact and editable meshes as different types, so that only editable meshes have the cost
//! of editing.

use std::fmt::Debug;

use crate::face_spans::{FaceSpans, ScatteredFaces};
use crate::holes::Holes;
use crate::iterator_ext::IteratorExt;
use crate::memory::TableBytes;
use crate::probe::Probe;
use crate::row_id::{RowId, row};

/// The type parameter that states whether elements of a mesh can be deleted: [`Editable`] if they
/// can, otherwise [`Compact`]. The trait is sealed: there are no other implementations.
///
/// Queries of an editable mesh check whether each visited element was deleted; queries of a compact
/// mesh do not check this. In measurements, this check added some 10 % to the time of sweeps over a
/// half-edge mesh, and up to 100 % if the work per element was very small.
pub trait Editing: sealed::Sealed + Clone + Copy + Debug + Send + Sync + 'static {
    /// Whether there can be holes.
    const CAN_DELETE: bool;

    /// The set of rows that are holes.
    type Holes<P: Probe>: HoleSet<P>;

    /// The faces whose degrees have been edited.
    type Scattered<P: Probe>: AsRef<ScatteredFaces<P>> + Clone + Debug + Send + Sync;

    /// Converts the spans of a compact mesh.
    fn spans<P: Probe>(spans: FaceSpans<P>) -> FaceSpans<P, Self>;

    /// Returns an empty set of holes; `name` is the name of its table in an editable mesh.
    fn no_holes<P: Probe>(name: &'static str, probe: P) -> Self::Holes<P>;

    /// Returns the same holes, observed by `probe`.
    fn probed_holes<P: Probe, Q: Probe>(holes: Self::Holes<P>, probe: Q) -> Self::Holes<Q>;

    /// Returns the same faces, observed by `probe`.
    fn probed_faces<P: Probe, Q: Probe>(faces: Self::Scattered<P>, probe: Q) -> Self::Scattered<Q>;
}

/// Meshes in which every row of the tables is an element.
#[derive(Clone, Copy, Debug)]
pub struct Compact;

/// Meshes in which rows may be holes, and faces may lie anywhere in the table of corners.
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

/// The name of the table with the bits of deleted vertices.
pub const VERTEX_HOLES: &str = "vertex holes";
/// The name of the table with the bits of deleted edges.
pub const EDGE_HOLES: &str = "edge holes";
/// The name of the table with the bits of deleted faces.
pub const FACE_HOLES: &str = "face holes";

/// A set of rows that are holes.
pub trait HoleSet<P: Probe>: Clone + Debug + Send + Sync {
    /// Returns the number of holes; O(1).
    fn len(&self) -> usize;

    /// Returns whether there are no holes; O(1).
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns whether `row` is a hole; O(1).
    fn has(&self, row: usize) -> bool;

    /// Returns whether `handle` is an element: its row is below `end` and is not a hole; O(1).
    #[inline]
    fn contains<H: RowId>(&self, handle: H, end: usize) -> bool {
        let row = handle.row() as usize;
        row < end && !self.has(row)
    }

    /// Returns the handles of the rows below `end` that are not holes, ascending; O(end).
    fn handles<H: RowId>(&self, end: usize) -> impl Iterator<Item = H> + Clone;

    /// Returns, for each row below `end`, its row after all holes are closed: the number of rows
    /// before it that are not holes. O(end).
    fn new_rows(&self, end: usize) -> Vec<u32> {
        let mut new = 0;
        let mut rows = Vec::with_capacity(end);
        for row in 0..end {
            rows.push(new);
            new += u32::from(!self.has(row));
        }
        rows
    }

    /// Returns the name and the bytes of the table of bits, if there is one.
    fn bytes(&self) -> Option<TableBytes>;

    /// Checks that the number of holes is right, and that all holes are rows below `end`.
    ///
    /// # Errors
    ///
    /// Returns a description of the fault.
    fn check(&self, end: usize) -> Result<(), String>;
}

/// The holes of a [`Compact`] mesh: an empty set, known at compile time.
#[derive(Clone, Copy, Debug)]
pub struct NoHoles;

impl<P: Probe> HoleSet<P> for NoHoles {
    #[inline]
    fn len(&self) -> usize {
        0
    }

    #[inline]
    fn has(&self, _: usize) -> bool {
        false
    }

    #[inline]
    fn handles<H: RowId>(&self, end: usize) -> impl Iterator<Item = H> + Clone {
        (0..row(end)).map_inline(H::from_row)
    }

    fn bytes(&self) -> Option<TableBytes> {
        None
    }

    fn check(&self, _: usize) -> Result<(), String> {
        Ok(())
    }
}

/// The scattered faces of a [`Compact`] mesh. A compact mesh has no scattered faces, so no value of
/// this type exists.
#[derive(Clone, Copy, Debug)]
pub enum NoScatteredFaces {}

impl<P: Probe> AsRef<ScatteredFaces<P>> for NoScatteredFaces {
    fn as_ref(&self) -> &ScatteredFaces<P> {
        match *self {}
    }
}
