//! The incidence lists under repair: each fan lies in the pool where there is room for it.
//!
//! ```text
//!            v's fan      behind it          v's fan
//! pool   … │ 4  7  9 │ 2  5 … │    →   … │ ·  ·  · │ 2  5 … │ 4  7  9  11  ·  · │    one face more
//!                                                              start, length      room
//! ```
//!
//! A place that no fan has is blank, so that the one behind a fan tells by itself whether it is free: no
//! table of capacities is needed. A fan that moves takes room for twice its faces, and eight at least
//! (doubling: Cormen et al., Introduction to Algorithms, 17.4). So each face that joins costs O(1)
//! time and places, amortised, once each fan of the input has moved.

use std::ops::Range;

use mesh_core::{FaceId, Few, Lookup, MAX_ROWS, Point, Probe, VertexId, row};

use super::find::mask;
use crate::mesh::{BLANK_PLACE, EditableFaceVertexMesh, Fan};

impl<P: Probe> EditableFaceVertexMesh<P> {
    /// How many blanks follow a fan of `len` faces, one of them new, that has moved to the end of the
    /// pool: none where places run short, so that what [`check_room`](Self::check_room) finds is enough.
    fn spare(&self, len: u32) -> impl Iterator<Item = FaceId> + use<P> {
        let room = if self.pool.len() < MAX_ROWS / 2 {
            (2 * (len - 1)).max(8)
        } else {
            0
        };
        (len..room).map(|_| BLANK_PLACE)
    }

    /// Puts `f` into the fan of `v`; O(1) amortised.
    #[inline]
    pub(super) fn join(&mut self, v: VertexId, f: FaceId) {
        let fan = *self.fans.read(v.index());
        let end = fan.range().end;
        if end == self.pool.len() {
            self.pool.push(f);
        } else if *self.pool.read(end) == BLANK_PLACE {
            *self.pool.write(end) = f;
        } else {
            self.move_and_join(v, fan, f);
            return;
        }
        self.fans.write(v.index()).len = fan.len + 1;
    }

    /// Moves the fan of `v` to the end of the pool, with `f` at its end and room for more.
    #[inline(never)]
    fn move_and_join(&mut self, v: VertexId, fan: Fan, f: FaceId) {
        let moved = Fan {
            start: row(self.pool.len()),
            len: fan.len + 1,
        };
        for place in fan.range() {
            let face = std::mem::replace(self.pool.write(place), BLANK_PLACE);
            self.pool.push(face);
        }
        self.pool.push(f);
        self.pool.extend(self.spare(moved.len));
        *self.fans.write(v.index()) = moved;
    }

    /// Takes `f` out of the fan of `v`; O(length).
    #[inline]
    pub(super) fn leave(&mut self, v: VertexId, f: FaceId) {
        let fan = *self.fans.read(v.index());
        let (place, last) = (self.place_of(fan, f), fan.range().end - 1);
        let moved = std::mem::replace(self.pool.write(last), BLANK_PLACE);
        if place != last {
            *self.pool.write(place) = moved;
        }
        self.fans.write(v.index()).len = fan.len - 1;
    }

    /// Puts `new` into the fan of `v` in the place of `old`; O(length).
    #[inline]
    pub(super) fn swap(&mut self, v: VertexId, old: FaceId, new: FaceId) {
        let place = self.place_of(*self.fans.read(v.index()), old);
        *self.pool.write(place) = new;
    }

    /// Where `f` is in `fan`, which has it.
    #[inline]
    fn place_of(&self, fan: Fan, f: FaceId) -> usize {
        let start = fan.range().start;
        // Without a branch, for where it is follows no pattern. Another fan may have it behind.
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
        let faces = self.pool.read_range(fan.range());
        let place = faces.iter().position(|&face| face == f);
        start + place.expect("I3: the fan of a corner names its face")
    }

    /// Takes the faces `old` out of the fan of `v`, sorted if they are many, and puts `new` in.
    pub(super) fn exchange(&mut self, v: VertexId, old: &[FaceId], new: &[FaceId]) {
        const FEW: usize = 4;
        if old.len() > FEW {
            let kept = self.fan(v).iter().copied().filter(|f| !old.has(*f));
            let kept = Few::from_iter(kept.chain(new.iter().copied()));
            self.refill(v, &kept);
            return;
        }
        let mut new = new.iter();
        for &f in old {
            match new.next() {
                Some(&g) => self.swap(v, f, g),
                None => self.leave(v, f),
            }
        }
        new.for_each(|&g| self.join(v, g));
    }

    /// Gives `v` the fan `faces`; O(faces + length) amortised.
    pub(super) fn refill(&mut self, v: VertexId, faces: &[FaceId]) {
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
            self.pool.extend(self.spare(len));
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

    /// Makes these places free.
    pub(super) fn clear_places(&mut self, places: Range<usize>) {
        for place in places {
            *self.pool.write(place) = BLANK_PLACE;
        }
    }

    /// Adds a vertex at `at` whose fan is `faces`; O(faces) amortised.
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
}
