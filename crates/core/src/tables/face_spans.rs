//! The range of corners of each face in a flat table, for structures that store and edit faces.

mod edit;
#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::clone_by_field;
use crate::handles::row_id::{FaceId, Slot, row};
use crate::tables::editing::{Compact, Editable, Editing};
use crate::tables::memory::TableBytes;
use crate::tables::probe::{Probe, Untraced};
use crate::tables::table::Table;

/// The range of the corners of each face in a flat table of corners. If all faces have the same
/// degree, only this degree is stored.
///
/// The table of corners is stored separately. A deleted face keeps its row and its range of corners
/// until the mesh is compacted. The corners of a deleted face are blank: they hold a value that no
/// vertex has, and scans skip them.
#[derive(Debug)]
pub enum FaceSpans<P: Probe = Untraced, E: Editing = Compact> {
    /// Every face has `degree` corners.
    Uniform {
        /// The number of corners of each face.
        degree: u32,
        /// The number of faces.
        faces: u32,
    },
    /// Face `f` has the corners `offsets[f]..offsets[f + 1]`.
    Mixed(Table<u32, P>),
    /// Each face has its own range of corners. An edit that changes the degree of a face converts
    /// the spans to this variant. Between the ranges, there may be blank corners that no face has.
    Scattered(E::Scattered<P>),
}

impl<P: Probe, E: Editing> Clone for FaceSpans<P, E> {
    fn clone(&self) -> Self {
        match self {
            &Self::Uniform { degree, faces } => Self::Uniform { degree, faces },
            Self::Mixed(offsets) => Self::Mixed(offsets.clone()),
            Self::Scattered(faces) => Self::Scattered(faces.clone()),
        }
    }

    /// Copies into the existing tables if both values are of the same variant. Allocates nothing if
    /// the rows fit.
    fn clone_from(&mut self, source: &Self) {
        match (self, source) {
            (Self::Mixed(offsets), Self::Mixed(others)) => offsets.clone_from(others),
            (Self::Scattered(faces), Self::Scattered(others)) => faces.clone_from(others),
            (spans, _) => *spans = source.clone(),
        }
    }
}

/// Faces whose corners can be anywhere in the table of corners.
#[derive(Debug)]
pub struct ScatteredFaces<P: Probe = Untraced> {
    /// By face: its corners.
    spans: Table<Span, P>,
    /// By corner: the face that has it, if any.
    owners: Table<Slot<FaceId>, P>,
}

clone_by_field!(ScatteredFaces<P: Probe> { spans, owners });

impl<P: Probe> AsRef<Self> for ScatteredFaces<P> {
    fn as_ref(&self) -> &Self {
        self
    }
}

impl<P: Probe> ScatteredFaces<P> {
    /// Returns the same faces in tables that report their reads and writes to `probe`.
    pub fn probed<Q: Probe>(self, probe: Q) -> ScatteredFaces<Q> {
        ScatteredFaces {
            spans: self.spans.probed(probe.clone()),
            owners: self.owners.probed(probe),
        }
    }

    #[inline]
    fn range(&self, face: FaceId) -> Range<usize> {
        if face.index() >= self.spans.len() {
            no_such_face(face, self.spans.len());
        }
        self.spans.read(face.index()).range()
    }

    /// Returns the number of corners, including blank corners.
    pub(crate) fn corner_count(&self) -> usize {
        self.owners.len()
    }

    /// Returns the face of a corner: `Some(None)` for a blank corner, `None` if there is no such
    /// corner.
    pub(crate) fn owner_of(&self, corner: usize) -> Option<Option<FaceId>> {
        Some(self.owners.rows().get(corner)?.get())
    }

    fn owner(&self, corner: usize) -> FaceId {
        let owner = self.owners.read(corner).get();
        owner.expect("scans skip the blank corners between faces")
    }

    /// Checks that each face has at least three corners and owns them, and that no other corner has
    /// an owner.
    fn check(&self, corners: usize) -> Result<(), String> {
        let owners = self.owners.rows();
        if owners.len() != corners {
            return Err(format!("{} owners for {corners} corners", owners.len()));
        }
        let mut owned = 0;
        for face in (0..row(self.spans.len())).map(FaceId::new) {
            let range = self.range(face);
            let own = owners.get(range.clone());
            let is_owner = own.is_some_and(|o| o.iter().all(|o| o.get() == Some(face)));
            if range.len() < 3 || !is_owner {
                return Err(format!("{face} has the corners {range:?} of {corners}"));
            }
            owned += range.len();
        }
        let with_owner = owners.iter().filter(|owner| owner.get().is_some()).count();
        if with_owner != owned {
            return Err(format!(
                "{with_owner} corners have an owner, but faces have {owned} corners"
            ));
        }
        Ok(())
    }
}

/// The rows of the corners of one face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    start: u32,
    len: u32,
}

impl Span {
    #[inline]
    fn range(self) -> Range<usize> {
        let start = self.start as usize;
        start..start + self.len as usize
    }
}

impl<P: Probe, E: Editing> FaceSpans<P, E> {
    /// Returns the number of faces, including deleted faces.
    #[inline]
    pub fn len(&self) -> usize {
        match self {
            Self::Uniform { faces, .. } => *faces as usize,
            Self::Mixed(offsets) => offsets.len() - 1,
            Self::Scattered(faces) => faces.as_ref().spans.len(),
        }
    }

    /// Returns whether there are no faces, not even deleted faces.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the range of the corners of `face`; O(1).
    ///
    /// # Panics
    ///
    /// Panics if `face` does not exist.
    #[inline]
    pub fn range(&self, face: FaceId) -> Range<usize> {
        let f = face.index();
        match self {
            Self::Uniform { degree, faces } => {
                if face.index() >= *faces as usize {
                    no_such_face(face, *faces as usize);
                }
                let degree = *degree as usize;
                f * degree..(f + 1) * degree
            }
            Self::Mixed(offsets) => {
                if f + 1 >= offsets.len() {
                    no_such_face(face, offsets.len() - 1);
                }
                *offsets.read(f) as usize..*offsets.read(f + 1) as usize
            }
            Self::Scattered(faces) => faces.as_ref().range(face),
        }
    }

    /// Returns the face of a corner; O(1), or O(log faces) for [`Mixed`](Self::Mixed). If the
    /// corner does not exist, the result is arbitrary, or the method panics.
    ///
    /// # Panics
    ///
    /// May panic if there are no faces, or if no face has the corner.
    pub fn face_of(&self, corner: usize) -> FaceId {
        let face = match self {
            Self::Uniform { degree, .. } => corner / *degree as usize,
            Self::Mixed(offsets) => {
                let (mut low, mut high) = (0, offsets.len() - 1);
                while high - low > 1 {
                    let middle = low.midpoint(high);
                    if *offsets.read(middle) as usize <= corner {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                low
            }
            Self::Scattered(faces) => return faces.as_ref().owner(corner),
        };
        FaceId::new(row(face))
    }

    /// Returns the face of `corner`, and three corners of the face in order: the corner before
    /// `corner`, `corner` itself, and the corner after `corner`.
    ///
    /// # Panics
    ///
    /// Panics if `corner` does not exist.
    pub fn around(&self, corner: usize) -> (FaceId, [usize; 3]) {
        let face = self.face_of(corner);
        let range = self.range(face);
        let (first, last) = (range.start, range.end - 1);
        let before = if corner == first { last } else { corner - 1 };
        let after = if corner == last { first } else { corner + 1 };
        (face, [before, corner, after])
    }

    /// Checks that the ranges divide a table of `corners` corners into faces, and that each face
    /// has at least three corners. Deleted faces are checked, too.
    ///
    /// # Errors
    ///
    /// Returns a description of the fault.
    pub fn check(&self, corners: usize) -> Result<(), String> {
        if let Self::Mixed(offsets) = self
            && offsets.is_empty()
        {
            return Err("the table of offsets is empty".to_owned());
        }
        if let Self::Scattered(faces) = self {
            return faces.as_ref().check(corners);
        }
        let mut end = 0;
        for face in (0..row(self.len())).map(FaceId::new) {
            let range = self.range(face);
            if range.start != end || range.end < range.start + 3 || range.end > corners {
                return Err(format!("{face} has the corners {range:?} of {corners}"));
            }
            end = range.end;
        }
        if end != corners {
            return Err(format!("corners {end}..{corners} belong to no face"));
        }
        Ok(())
    }

    /// Returns the same ranges of corners, in tables that report their reads and writes to `probe`.
    pub fn probed<Q: Probe>(self, probe: Q) -> FaceSpans<Q, E> {
        match self {
            Self::Uniform { degree, faces } => FaceSpans::Uniform { degree, faces },
            Self::Mixed(offsets) => FaceSpans::Mixed(offsets.probed(probe)),
            Self::Scattered(faces) => FaceSpans::Scattered(E::probed_faces(faces, probe)),
        }
    }

    /// Yields the name and the bytes of each table. Yields nothing if all faces have the same
    /// degree and no table is stored.
    pub fn bytes(&self) -> impl Iterator<Item = TableBytes> {
        let [first, second] = match self {
            Self::Uniform { .. } => [None, None],
            Self::Mixed(offsets) => [Some(offsets.bytes()), None],
            Self::Scattered(faces) => {
                let ScatteredFaces { spans, owners } = faces.as_ref();
                [Some(spans.bytes()), Some(owners.bytes())]
            }
        };
        first.into_iter().chain(second)
    }
}

impl<P: Probe> From<FaceSpans<P>> for FaceSpans<P, Editable> {
    fn from(spans: FaceSpans<P>) -> Self {
        match spans {
            FaceSpans::Uniform { degree, faces } => Self::Uniform { degree, faces },
            FaceSpans::Mixed(offsets) => Self::Mixed(offsets),
        }
    }
}

impl<P: Probe> FaceSpans<P, Editable> {
    /// Converts to the form for a compact mesh. Returns `None` for [`Scattered`](Self::Scattered).
    pub fn into_compact(self) -> Option<FaceSpans<P>> {
        match self {
            Self::Uniform { degree, faces } => Some(FaceSpans::Uniform { degree, faces }),
            Self::Mixed(offsets) => Some(FaceSpans::Mixed(offsets)),
            Self::Scattered(_) => None,
        }
    }
}

#[cold]
#[inline(never)]
fn no_such_face(face: FaceId, faces: usize) -> ! {
    panic!("no face {face}: every face has a row below {faces}")
}
