//! Edits of the division of corners into faces.

use super::{FaceSpans, ScatteredFaces, Span};
use crate::handles::row_id::{FaceId, Slot, row};
use crate::tables::editing::Editable;
use crate::tables::holes::HoleSet;
use crate::tables::holes::Holes;
use crate::tables::probe::Probe;
use crate::tables::table::Table;

/// In these methods, `corners` is the table of corners that is divided into faces. The caller must
/// check beforehand that the numbers of faces and corners stay within their limits.
impl<P: Probe> FaceSpans<P, Editable> {
    /// Adds a face at the end of the table; O(degree) amortised. The first face of a different
    /// degree adds a table with the range of each face, which takes O(corners) time once.
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

    /// Replaces the corners of `f`; O(degree) amortised. If the face gets more corners than before,
    /// all its corners move to the end of the table. The first change of a degree adds a table with
    /// the range of each face, which takes O(corners) time once.
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

    /// Overwrites all corners of the deleted face `f` with `blank`; O(degree).
    pub fn blank<T: Copy>(&self, corners: &mut Table<T, P>, f: FaceId, blank: T) {
        for corner in self.range(f) {
            *corners.write(corner) = blank;
        }
    }

    /// Removes the corners of deleted faces from `corners`; O(corners). The probe does not record
    /// the change. A table that uses less than half of its memory frees the unused part.
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

    /// Changes the spans to scattered faces; O(corners).
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
