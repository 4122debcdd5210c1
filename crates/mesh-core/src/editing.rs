//! Whole meshes and editable ones, told apart by type: what only editing needs, only editing pays.

use std::fmt::Debug;

use crate::face_spans::{FaceSpans, ScatteredFaces};
use crate::holes::Holes;
use crate::memory::TableBytes;
use crate::probe::Probe;
use crate::row_id::{RowId, row};

/// Whether elements of a mesh can be deleted: [`Whole`], or [`Editable`].
///
/// A query that must find out whether its handle was deleted costs a comparison for each element it
/// passes, and registers in the loops around it: measured, some 10 % on the sweeps of a half-edge
/// mesh, and up to twice the time where nearly nothing is done for each element. So the structures
/// have the answer as a type parameter, and of a whole mesh nobody asks.
pub trait Editing: Clone + Copy + Debug + Send + Sync + 'static {
    /// Whether there may be holes.
    const DELETES: bool;

    /// Which rows of a table are holes.
    type Holes<P: Probe>: HoleSet<P>;

    /// Where faces are whose degrees have been edited.
    type Scattered<P: Probe>: AsRef<ScatteredFaces<P>> + Clone + Debug + Send + Sync;

    /// The same faces, none of them scattered.
    fn spans<P: Probe>(spans: FaceSpans<P>) -> FaceSpans<P, Self>;

    /// No holes; `name` is what the table of them is called, if there can be one.
    fn no_holes<P: Probe>(name: &'static str, probe: P) -> Self::Holes<P>;

    /// The same holes watched by `probe`.
    fn probed_holes<P: Probe, Q: Probe>(holes: Self::Holes<P>, probe: Q) -> Self::Holes<Q>;

    /// The same faces watched by `probe`.
    fn probed_faces<P: Probe, Q: Probe>(faces: Self::Scattered<P>, probe: Q) -> Self::Scattered<Q>;
}

/// Every row of the tables is an element.
#[derive(Clone, Copy, Debug)]
pub struct Whole;

/// Rows may be holes, and faces may lie anywhere among the corners.
#[derive(Clone, Copy, Debug)]
pub struct Editable;

impl Editing for Whole {
    const DELETES: bool = false;

    type Holes<P: Probe> = NoHoles;
    type Scattered<P: Probe> = NoFaces;

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

    fn probed_faces<P: Probe, Q: Probe>(faces: NoFaces, _: Q) -> NoFaces {
        faces
    }
}

impl Editing for Editable {
    const DELETES: bool = true;

    type Holes<P: Probe> = Holes<P>;
    type Scattered<P: Probe> = ScatteredFaces<P>;

    fn spans<P: Probe>(spans: FaceSpans<P>) -> FaceSpans<P, Self> {
        spans.into()
    }

    fn no_holes<P: Probe>(name: &'static str, probe: P) -> Holes<P> {
        Holes::none(name).probed(probe)
    }

    fn probed_holes<P: Probe, Q: Probe>(holes: Holes<P>, probe: Q) -> Holes<Q> {
        holes.probed(probe)
    }

    fn probed_faces<P: Probe, Q: Probe>(faces: ScatteredFaces<P>, probe: Q) -> ScatteredFaces<Q> {
        faces.probed(probe)
    }
}

/// What the table of the bits of deleted vertices is called.
pub const VERTEX_HOLES: &str = "vertex holes";
/// What the table of the bits of deleted edges is called.
pub const EDGE_HOLES: &str = "edge holes";
/// What the table of the bits of deleted faces is called.
pub const FACE_HOLES: &str = "face holes";

/// Which rows are holes, as queries ask.
pub trait HoleSet<P: Probe>: Clone + Debug + Send + Sync {
    /// How many holes there are; O(1).
    fn len(&self) -> usize;

    /// Whether there is no hole; O(1).
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether `row` is a hole; O(1).
    fn has(&self, row: usize) -> bool;

    /// The handles of the rows below `end` that are no holes, ascending; O(end).
    fn handles<H: RowId>(&self, end: usize) -> impl Iterator<Item = H> + Clone;

    /// For each row below `end` the row it has once all holes are closed up: as many as there are
    /// rows before it that are no holes. O(end).
    fn new_rows(&self, end: usize) -> Vec<u32> {
        let mut new = 0;
        let mut rows = Vec::with_capacity(end);
        for row in 0..end {
            rows.push(new);
            new += u32::from(!self.has(row));
        }
        rows
    }

    /// The name and the bytes of the bits, if there are any.
    fn bytes(&self) -> Option<TableBytes>;

    /// Whether the holes that are counted are there, all of them rows below `end`: what is wrong if not.
    ///
    /// # Errors
    ///
    /// A sentence.
    fn check(&self, end: usize) -> Result<(), String>;
}

/// The holes of a [`Whole`] mesh: none, which the compiler knows.
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
        (0..row(end)).map(H::from_row)
    }

    fn bytes(&self) -> Option<TableBytes> {
        None
    }

    fn check(&self, _: usize) -> Result<(), String> {
        Ok(())
    }
}

/// The scattered faces of a [`Whole`] mesh: there cannot be any.
#[derive(Clone, Copy, Debug)]
pub enum NoFaces {}

impl<P: Probe> AsRef<ScatteredFaces<P>> for NoFaces {
    fn as_ref(&self) -> &ScatteredFaces<P> {
        match *self {}
    }
}
