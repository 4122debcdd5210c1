//! The division of corners into faces, as structures store and edit it.

use std::ops::Range;

use crate::clone_by_field;
use crate::editing::{Compact, Editable, Editing, HoleSet};
use crate::holes::Holes;
use crate::memory::TableBytes;
use crate::probe::{Probe, Untraced};
use crate::row_id::{FaceId, Slot, row};
use crate::table::Table;

/// The division of a flat table of corners into faces: one degree for all faces, or a table.
///
/// Structures store the corners themselves, as vertices or points. A deleted face keeps its row and
/// its corners until the mesh is compacted; its corners are blank, so that scans skip them.
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
    /// The degrees of faces have been edited: faces lie anywhere, with blank corners between them.
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

    /// Copies into the existing tables if both are of one kind, and allocates nothing if they fit.
    fn clone_from(&mut self, source: &Self) {
        match (self, source) {
            (Self::Mixed(offsets), Self::Mixed(others)) => offsets.clone_from(others),
            (Self::Scattered(faces), Self::Scattered(others)) => faces.clone_from(others),
            (spans, _) => *spans = source.clone(),
        }
    }
}

/// Faces that lie anywhere in the table of corners.
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
    /// Returns the same faces, observed by `probe`.
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

    fn owner(&self, corner: usize) -> FaceId {
        let owner = self.owners.read(corner).get();
        owner.expect("scans skip the blank corners between faces")
    }

    /// Checks that each face owns its corners, three or more, and that no other corner has an
    /// owner.
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

/// The rows of the corners of one face, in a table where faces lie anywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    /// The first row.
    start: u32,
    /// The number of rows.
    len: u32,
}

impl Span {
    /// Returns all rows.
    #[inline]
    fn range(self) -> Range<usize> {
        let start = self.start as usize;
        start..start + self.len as usize
    }
}

impl<P: Probe, E: Editing> FaceSpans<P, E> {
    /// Returns the number of rows of faces, deleted ones included.
    #[inline]
    pub fn len(&self) -> usize {
        match self {
            Self::Uniform { faces, .. } => *faces as usize,
            Self::Mixed(offsets) => offsets.len() - 1,
            Self::Scattered(faces) => faces.as_ref().spans.len(),
        }
    }

    /// Returns whether there are no rows of faces.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the range of the corners of `face`; reads two offsets if degrees are mixed.
    ///
    /// # Panics
    ///
    /// Panics if there is no such face.
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

    /// Returns the face of a corner: by a division, by a binary search if degrees are mixed, or by
    /// a look-up once degrees have been edited. The result for a corner that does not exist is
    /// arbitrary.
    ///
    /// # Panics
    ///
    /// May panic if there are no faces, or if the corner is a blank between faces.
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

    /// Returns the face of a corner, and the corners before, at and after it in that face.
    ///
    /// # Panics
    ///
    /// Panics if there is no such corner.
    pub fn around(&self, corner: usize) -> (FaceId, [usize; 3]) {
        let face = self.face_of(corner);
        let range = self.range(face);
        let (first, last) = (range.start, range.end - 1);
        let before = if corner == first { last } else { corner - 1 };
        let after = if corner == last { first } else { corner + 1 };
        (face, [before, corner, after])
    }

    /// Checks that the spans divide `corners` corners into faces of three or more, deleted ones
    /// included.
    ///
    /// # Errors
    ///
    /// Describes the first face whose corners are missing or too few, or the corners that no face
    /// has.
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

    /// Returns the same spans, observed by `probe`.
    pub fn probed<Q: Probe>(self, probe: Q) -> FaceSpans<Q, E> {
        match self {
            Self::Uniform { degree, faces } => FaceSpans::Uniform { degree, faces },
            Self::Mixed(offsets) => FaceSpans::Mixed(offsets.probed(probe)),
            Self::Scattered(faces) => FaceSpans::Scattered(E::probed_faces(faces, probe)),
        }
    }

    /// Returns the bytes of the tables, if there are any.
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

/// Edits. `corners` is the table that these spans divide. The caller checks beforehand that handles
/// can name one more face or corner.
impl<P: Probe> FaceSpans<P, Editable> {
    /// Converts to the spans of a mesh that has no holes; `None` if faces are scattered.
    pub fn into_compact(self) -> Option<FaceSpans<P>> {
        match self {
            Self::Uniform { degree, faces } => Some(FaceSpans::Uniform { degree, faces }),
            Self::Mixed(offsets) => Some(FaceSpans::Mixed(offsets)),
            Self::Scattered(_) => None,
        }
    }

    /// Adds a face at the end of the table; O(degree) amortised. The first face of another degree
    /// adds a table of spans; O(corners), once.
    pub fn push<T: Copy>(&mut self, corners: &mut Table<T, P>, face: &[T]) -> FaceId {
        let id = FaceId::new(row(self.len()));
        if let Self::Uniform { degree, faces } = self {
            if *faces == 0 {
                *degree = row(face.len());
            }
            if *degree as usize == face.len() {
                *faces += 1;
                corners.extend(face.iter().copied());
                return id;
            }
            self.scatter(corners);
        }
        let start = corners.len();
        corners.extend(face.iter().copied());
        match self {
            Self::Uniform { .. } => unreachable!("scattered above"),
            Self::Mixed(offsets) => offsets.push(row(corners.len())),
            Self::Scattered(ScatteredFaces { spans, owners }) => {
                spans.push(Span {
                    start: row(start),
                    len: row(face.len()),
                });
                owners.extend(face.iter().map(|_| Slot::some(id)));
            }
        }
        id
    }

    /// Replaces the corners of `f`; O(degree) amortised. The new corners are written in place
    /// unless there are more of them; otherwise at the end of the table. The first change of a
    /// degree adds a table of spans; O(corners), once.
    pub fn rewrite<T: Copy>(&mut self, corners: &mut Table<T, P>, f: FaceId, face: &[T], blank: T) {
        let old = self.range(f);
        if face.len() != old.len() {
            self.scatter(corners);
        }
        let range = if face.len() <= old.len() {
            old.start..old.start + face.len()
        } else {
            corners.len()..corners.len() + face.len()
        };
        if let Self::Scattered(ScatteredFaces { spans, owners }) = self
            && range != old
        {
            *spans.write(f.index()) = Span {
                start: row(range.start),
                len: row(range.len()),
            };
            for corner in old.filter(|corner| !range.contains(corner)) {
                *owners.write(corner) = Slot::NONE;
                *corners.write(corner) = blank;
            }
            owners.extend((owners.len()..range.end).map(|_| Slot::some(f)));
        }
        for (corner, &at) in range.zip(face) {
            if corner < corners.len() {
                *corners.write(corner) = at;
            } else {
                corners.push(at);
            }
        }
    }

    /// Makes the corners of a deleted face blank; O(degree).
    pub fn blank<T: Copy>(&self, corners: &mut Table<T, P>, f: FaceId, blank: T) {
        for corner in self.range(f) {
            *corners.write(corner) = blank;
        }
    }

    /// Closes the gaps of deleted faces in `corners`; O(corners), not observed. A table that is
    /// less than half used frees its spare memory.
    pub fn compact<T: Copy>(&mut self, corners: &mut Table<T, P>, holes: &Holes<P>) {
        match self {
            Self::Uniform { degree, faces } => {
                let degree = *degree as usize;
                let mut to = 0;
                let rows = corners.rows_mut();
                for f in holes.rows(*faces as usize) {
                    let from = f as usize * degree;
                    rows.copy_within(from..from + degree, to);
                    to += degree;
                }
                *faces = row(*faces as usize - holes.len());
                corners.truncate(to);
                corners.shrink_if_half_empty();
            }
            Self::Mixed(_) if holes.is_empty() => {}
            Self::Mixed(_) | Self::Scattered(_) => {
                let mut list = Vec::with_capacity(corners.len());
                let mut offsets = vec![0];
                let mut degrees = [usize::MAX, 0];
                for f in holes.handles(self.len()) {
                    let range = self.range(f);
                    degrees = [degrees[0].min(range.len()), degrees[1].max(range.len())];
                    list.extend_from_slice(&corners.rows()[range]);
                    offsets.push(row(list.len()));
                }
                let faces = row(offsets.len() - 1);
                *self = if degrees[0] >= degrees[1] {
                    let degree = if faces == 0 { 3 } else { row(degrees[1]) };
                    Self::Uniform { degree, faces }
                } else {
                    Self::Mixed(corners.new_like("offsets", "face", offsets))
                };
                list.shrink_to_fit();
                corners.replace(list);
            }
        }
    }

    /// Lets faces lie anywhere from now on; O(corners), or O(1) if they already do.
    fn scatter<T>(&mut self, corners: &Table<T, P>) {
        if let Self::Scattered(_) = self {
            return;
        }
        let mut spans = Vec::with_capacity(self.len());
        let mut owners = Vec::with_capacity(corners.len());
        for f in (0..row(self.len())).map(FaceId::new) {
            let range = self.range(f);
            spans.push(Span {
                start: row(range.start),
                len: row(range.len()),
            });
            owners.extend(range.map(|_| Slot::some(f)));
        }
        *self = Self::Scattered(ScatteredFaces {
            spans: corners.new_like("spans", "face", spans),
            owners: corners.new_like("owners", "corner", owners),
        });
    }
}

#[cold]
#[inline(never)]
fn no_such_face(face: FaceId, faces: usize) -> ! {
    panic!("no face {face}: there are {faces}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::face_list::FaceList;
    use crate::row_id::VertexId;

    fn list(degrees: &[u32]) -> FaceList {
        let mut faces = FaceList::default();
        for &degree in degrees {
            faces.push((0..degree).map(VertexId::new)).expect("small");
        }
        faces
    }

    #[test]
    #[should_panic(expected = "no face f2: there are 2")]
    fn a_missing_face_panics_with_its_handle() {
        list(&[3, 3]).spans().range(FaceId::new(2));
    }

    #[test]
    #[should_panic(expected = "no face f2: there are 2")]
    fn a_missing_face_panics_with_its_handle_if_degrees_are_mixed() {
        list(&[3, 4]).spans().range(FaceId::new(2));
    }

    #[test]
    fn around_returns_the_face_and_the_corners_before_and_after() {
        for degrees in [&[3, 3, 3][..], &[4, 3, 5], &[3, 3, 4, 3, 6, 3]] {
            let spans = list(degrees).spans();
            let faces = (0..row(degrees.len())).map(FaceId::new);
            for (face, corners) in faces.map(|f| (f, spans.range(f))) {
                let (first, last) = (corners.start, corners.end - 1);
                assert_eq!(spans.around(first), (face, [last, first, first + 1]));
                assert_eq!(spans.around(last), (face, [last - 1, last, first]));
                for corner in first + 1..last {
                    let around = [corner - 1, corner, corner + 1];
                    assert_eq!(spans.around(corner), (face, around));
                    assert_eq!(spans.face_of(corner), face);
                }
            }
        }
    }

    #[test]
    fn spans_must_divide_the_corners() {
        assert_eq!(list(&[3, 4]).spans().check(7), Ok(()));
        assert!(list(&[3, 4]).spans().check(8).is_err());
        assert!(list(&[3, 4]).spans().check(6).is_err());
        assert!(list(&[3, 3]).spans().check(5).is_err());
        assert!(list(&[3, 2]).spans().check(5).is_err());
    }

    const BLANK: u32 = 99;

    /// Returns the faces that are not holes, after checking that spans and corners agree.
    fn faces(
        spans: &FaceSpans<Untraced, Editable>,
        corners: &Table<u32>,
        holes: &Holes,
    ) -> Vec<Vec<u32>> {
        assert_eq!(spans.check(corners.len()), Ok(()));
        let live = holes.handles(spans.len());
        let live = live.map(|f| corners.rows()[spans.range(f)].to_vec());
        live.collect()
    }

    #[test]
    fn faces_are_added_rewritten_deleted_and_compacted() {
        for degrees in [&[][..], &[3, 3, 3], &[4, 3, 5], &[4, 4]] {
            let mut spans = FaceSpans::from(list(degrees).spans());
            let all: Vec<Vec<u32>> = degrees.iter().map(|&d| (10..10 + d).collect()).collect();
            let mut corners = Table::new("corners", "corner", all.concat());
            let mut holes = Holes::new("face holes");
            let mut expected = all.clone();
            for new in [&[1, 2, 3][..], &[4, 5, 6], &[1, 2, 3, 4, 5], &[7, 8, 9]] {
                let f = spans.push(&mut corners, new);
                expected.push(new.to_vec());
                assert_eq!(f.index() + 1, expected.len());
                assert_eq!(faces(&spans, &corners, &holes), expected);
            }
            for (f, new) in [
                (0, &[1, 2, 3][..]),
                (1, &[1, 2, 3, 4, 5, 6, 7]),
                (2, &[3, 2, 1]),
                (1, &[5, 6, 7, 8]),
                (1, &[1, 2, 3, 4, 5, 6, 7, 8, 9]),
            ] {
                spans.rewrite(&mut corners, FaceId::new(f), new, BLANK);
                expected[f as usize] = new.to_vec();
                assert_eq!(faces(&spans, &corners, &holes), expected);
                for corner in (0..corners.len()).filter(|&c| corners.rows()[c] != BLANK) {
                    let f = spans.face_of(corner);
                    assert!(spans.range(f).contains(&corner));
                }
            }
            for f in [1, 0, 3] {
                spans.blank(&mut corners, FaceId::new(f), BLANK);
                holes.insert(f as usize);
            }
            expected = [&expected[2..3], &expected[4..]].concat();
            assert_eq!(faces(&spans, &corners, &holes), expected);
            spans.compact(&mut corners, &holes);
            holes.clear();
            assert_eq!(faces(&spans, &corners, &holes), expected);
            assert!(corners.rows().iter().all(|&c| c != BLANK));
            assert!(!matches!(spans, FaceSpans::Scattered(_)));
            let is_uniform = expected.iter().all(|f| f.len() == expected[0].len());
            assert_eq!(matches!(spans, FaceSpans::Uniform { .. }), is_uniform);
        }
    }

    #[test]
    fn a_uniform_degree_stays_uniform() {
        let mut spans = FaceSpans::from(list(&[3, 3, 3]).spans());
        let mut corners = Table::new("corners", "corner", (0..9).collect());
        let mut holes = Holes::new("face holes");
        spans.rewrite(&mut corners, FaceId::new(1), &[7, 7, 7], BLANK);
        spans.push(&mut corners, &[1, 2, 3]);
        spans.blank(&mut corners, FaceId::new(0), BLANK);
        holes.insert(0);
        spans.compact(&mut corners, &holes);
        holes.clear();
        assert!(matches!(
            spans,
            FaceSpans::Uniform {
                degree: 3,
                faces: 3
            }
        ));
        assert_eq!(
            faces(&spans, &corners, &holes),
            [[7, 7, 7], [6, 7, 8], [1, 2, 3]]
        );
    }
}
