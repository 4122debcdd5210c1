//! Changes of fans. A fan without room to grow moves to the end of the pool.
//!
//! ```text
//!            v's fan      behind it          v's fan
//! pool   … │ 4  7  9 │ 2  5 … │    →   … │ ·  ·  · │ 2  5 … │ 4  7  9  11  ·  · │    one face more
//!                                                              start, length      room
//! ```
//!
//! Pool entries outside all fans are blank, so the entry behind a fan shows whether the fan can
//! grow. A fan that moves gets room for twice its faces, at least eight (Cormen et al.,
//! Introduction to Algorithms, 17.4). So a new face costs O(1) amortised time and entries, after
//! each fan of the input has moved once.

use std::ops::Range;

use sixfold_core::{Editable, FaceId, Lookup, MAX_ROWS, Point, Probe, ShortVec, VertexId, row};

use super::find::mask;
use crate::mesh::{BLANK_PLACE, FaceVertexMesh, Fan};

/// Returns the place of `f` in a long fan. Compares chunks without branches, so with vector instructions:
/// the fan of a hub can have a hundred thousand faces.
fn find(fan: &[FaceId], f: FaceId) -> Option<usize> {
    const CHUNK: usize = 32;
    let has = |chunk: &[FaceId]| chunk.iter().fold(false, |has, &face| has | (face == f));
    let before = fan.chunks(CHUNK).position(has)? * CHUNK;
    let within = fan[before..].iter().position(|&face| face == f)?;
    Some(before + within)
}

impl<P: Probe> FaceVertexMesh<Editable, P> {
    /// Returns the blanks behind a fan that moves to the end of the pool. The fan has `len` faces,
    /// including the new face. Returns no blanks if places are short.
    fn spare_places(&self, len: u32) -> impl Iterator<Item = FaceId> + use<P> {
        let room = if self.pool.len() < MAX_ROWS / 2 {
            (2 * (len - 1)).max(8)
        } else {
            0
        };
        (len..room).map(|_| BLANK_PLACE)
    }

    /// Adds `f` to the fan of `v`; O(1) amortised.
    #[inline]
    pub(super) fn add_to_fan(&mut self, v: VertexId, f: FaceId) {
        let fan = *self.fans.read(v.index());
        let end = fan.range().end;
        if end == self.pool.len() {
            self.pool.push(f);
        } else if *self.pool.read(end) == BLANK_PLACE {
            *self.pool.write(end) = f;
        } else {
            self.move_and_add(v, fan, f);
            return;
        }
        self.fans.write(v.index()).len = fan.len + 1;
    }

    /// Moves the fan of `v` to the end of the pool, and adds `f`.
    #[inline(never)]
    fn move_and_add(&mut self, v: VertexId, fan: Fan, f: FaceId) {
        let moved = Fan {
            start: row(self.pool.len()),
            len: fan.len + 1,
        };
        for place in fan.range() {
            let face = std::mem::replace(self.pool.write(place), BLANK_PLACE);
            self.pool.push(face);
        }
        self.pool.push(f);
        self.pool.extend(self.spare_places(moved.len));
        *self.fans.write(v.index()) = moved;
    }

    /// Removes `f` from the fan of `v`; O(length).
    #[inline]
    pub(super) fn remove_from_fan(&mut self, v: VertexId, f: FaceId) {
        let fan = *self.fans.read(v.index());
        let (place, last) = (self.place_of(fan, f), fan.range().end - 1);
        let moved = std::mem::replace(self.pool.write(last), BLANK_PLACE);
        if place != last {
            *self.pool.write(place) = moved;
        }
        self.fans.write(v.index()).len = fan.len - 1;
    }

    /// Replaces `old` by `new` in the fan of `v`; O(length).
    #[inline]
    pub(super) fn replace_in_fan(&mut self, v: VertexId, old: FaceId, new: FaceId) {
        let place = self.place_of(*self.fans.read(v.index()), old);
        *self.pool.write(place) = new;
    }

    /// Returns the index in `pool` of the entry `f` of `fan`. The fan must contain `f`.
    #[inline]
    fn place_of(&self, fan: Fan, f: FaceId) -> usize {
        let start = fan.range().start;
        // No branch, because the place of `f` is unpredictable. The places behind this fan may also
        // contain `f`.
        let hits = if let Some(faces) = self.lanes::<8>(fan) {
            mask(faces.map(|face| u32::from(face == f)))
        } else if let Some(faces) = self.lanes::<16>(fan) {
            mask(faces.map(|face| u32::from(face == f)))
        } else {
            0
        };
        if hits != 0 {
            return start + hits.trailing_zeros() as usize;
        }
        let place = find(self.pool.read_range(fan.range()), f);
        start + place.expect("I3: the fan of a corner contains its face")
    }

    /// Replaces the faces `old` in the fan of `v` by `new`. More than four faces in `old` must be
    /// sorted.
    pub(super) fn replace_faces(&mut self, v: VertexId, old: &[FaceId], new: &[FaceId]) {
        const FEW: usize = 4;
        if old.len() > FEW {
            let kept = self.fan(v).iter().copied().filter(|f| !old.has(*f));
            let kept = ShortVec::from_iter(kept.chain(new.iter().copied()));
            self.set_fan(v, &kept);
            return;
        }
        let mut new = new.iter();
        for &f in old {
            match new.next() {
                Some(&g) => self.replace_in_fan(v, f, g),
                None => self.remove_from_fan(v, f),
            }
        }
        new.for_each(|&g| self.add_to_fan(v, g));
    }

    /// Sets the fan of `v` to `faces`; O(faces + length) amortised.
    pub(super) fn set_fan(&mut self, v: VertexId, faces: &[FaceId]) {
        let old = self.fans.read(v.index()).range();
        let end = old.start + faces.len();
        let is_free =
            |place: usize| place >= self.pool.len() || *self.pool.read(place) == BLANK_PLACE;
        let len = row(faces.len());
        if !(old.end..end).all(is_free) {
            self.clear_places(old);
            *self.fans.write(v.index()) = Fan {
                start: row(self.pool.len()),
                len,
            };
            self.pool.extend(faces.iter().copied());
            self.pool.extend(self.spare_places(len));
            return;
        }
        for (place, &f) in (old.start..).zip(faces) {
            if place < self.pool.len() {
                *self.pool.write(place) = f;
            } else {
                self.pool.push(f);
            }
        }
        self.clear_places(end..old.end.max(end));
        self.fans.write(v.index()).len = len;
    }

    pub(super) fn clear_places(&mut self, places: Range<usize>) {
        for place in places {
            *self.pool.write(place) = BLANK_PLACE;
        }
    }

    /// Adds a vertex at `at` with the fan `faces`; O(faces) amortised.
    pub(super) fn push_vertex(&mut self, at: Point, faces: &[FaceId]) -> VertexId {
        let v = VertexId::new(row(self.fans.len()));
        self.positions.push(at);
        self.fans.push(Fan {
            start: row(self.pool.len()),
            len: row(faces.len()),
        });
        self.pool.extend(faces.iter().copied());
        v
    }

    /// Marks `v` as deleted. `v` must have no faces.
    pub(super) fn delete_vertex(&mut self, v: VertexId) {
        let fan = std::mem::replace(self.fans.write(v.index()), Fan::DELETED);
        self.clear_places(fan.range());
        self.vertex_holes.insert(v.index());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_is_found_anywhere_in_a_long_fan() {
        let fan: Vec<FaceId> = (0..100).rev().map(FaceId::new).collect();
        for (place, &face) in fan.iter().enumerate() {
            assert_eq!(find(&fan, face), Some(place));
        }
        assert_eq!(find(&fan, FaceId::new(100)), None);
        assert_eq!(find(&[], FaceId::new(0)), None);
    }
}
