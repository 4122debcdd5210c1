//! Removing one face, all faces at a vertex, and isolated vertices.

use sixfold_core::{
    EditError, EditLog, FaceId, Few, HoleSet, Lookup, Probe, Refusal, Slot, VertexId, row,
};

use crate::edge::{Run, RunId};
use crate::mesh::EditableWingedEdgeMesh;
use crate::wings::Side;

/// A run along the outline of the removed faces. The outline of one face is all its sides; the
/// outline of the faces at a vertex is their sides that do not touch the vertex.
#[derive(Clone, Copy)]
struct Rim {
    run: RunId,
    origin: VertexId,
    target: VertexId,
    across: Across,
}

/// What is on the other side of a rim.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Across {
    /// A face that stays: the rim becomes a boundary.
    Stays,
    /// No face: the edge is removed.
    Blank,
    /// Another removed face: the edge is removed, and is on the outline twice.
    Goes,
}

/// A corner of the outline, and the runs there that lose their face but stay.
#[derive(Clone, Copy)]
struct Corner {
    v: VertexId,
    into: Option<RunId>,
    out: Option<RunId>,
}

impl<P: Probe> EditableWingedEdgeMesh<P> {
    pub(super) fn remove(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        let first = self.along(self.check_face(f)?, f);
        let mut gone = Few::new();
        gone.push(f);
        let mut outline = Few::new();
        let mut run = first;
        loop {
            outline.push(self.rim(run, &gone));
            run = self.run_after(run);
            if run == first {
                break;
            }
        }
        let corners = corners_of(outline.as_slice());
        self.check_corners(corners.clone(), &gone)?;
        self.take_out(outline.as_slice(), corners, log);
        self.delete_face(f, log);
        Ok(())
    }

    pub(super) fn remove_star(
        &mut self,
        v: VertexId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        self.check_vertex(v)?;
        if self.spoke(v).is_none() {
            self.delete_vertex(v, log);
            return Ok(());
        }
        let mut gone = Few::new();
        let mut spokes = Few::new();
        for (e, run) in self.runs_from(v) {
            spokes.push(e);
            if let Some(f) = run.face().get() {
                gone.push(f);
            }
        }
        gone.order();
        let mut outline = Few::new();
        for &e in spokes.as_slice() {
            let first = self.leaving(e, v);
            if self.run(first).face() == Slot::NONE {
                continue;
            }
            let mut run = self.run_after(first);
            while self.run(run).target() != v {
                outline.push(self.rim(run, &gone));
                run = self.run_after(run);
            }
        }
        let corners = corners_of(outline.as_slice());
        if outline.as_slice().len() == gone.as_slice().len() {
            self.check_corners(corners.clone(), &gone)?;
            self.take_out(outline.as_slice(), corners, log);
        } else {
            // With polygons, the outline may visit a vertex twice; with triangles only, it cannot.
            let merged = Self::merged(corners.collect())?;
            self.check_corners(merged.iter().copied(), &gone)?;
            self.take_out(outline.as_slice(), merged, log);
        }
        for &e in spokes.as_slice() {
            self.delete_edge(e, log);
        }
        for &f in gone.as_slice() {
            self.delete_face(f, log);
        }
        self.delete_vertex(v, log);
        Ok(())
    }

    pub(super) fn remove_isolated(&mut self, log: &mut impl EditLog<Self>) -> usize {
        let before = self.vertex_holes.len();
        for v in 0..self.spokes.len() {
            let isolated = *self.spokes.read(v) == Slot::NONE && !self.vertex_holes.has(v);
            if isolated {
                self.delete_vertex(VertexId::new(row(v)), log);
            }
        }
        self.vertex_holes.len() - before
    }

    fn rim(&self, id: RunId, gone: &Few<FaceId>) -> Rim {
        let run = self.run(id);
        let across = match run.across().get() {
            None => Across::Blank,
            Some(f) if gone.has(f) => Across::Goes,
            Some(_) => Across::Stays,
        };
        Rim {
            run: id,
            origin: run.origin(),
            target: run.target(),
            across,
        }
    }

    /// Merges the corners of each vertex. Refuses if two fans would remain at one.
    fn merged(mut corners: Vec<Corner>) -> Result<Vec<Corner>, Refusal<Self>> {
        corners.sort_unstable_by_key(|corner| corner.v);
        let mut two_fans = None;
        corners.dedup_by(|later, corner| {
            if later.v != corner.v {
                return false;
            }
            let twice = |one: Option<RunId>, other: Option<RunId>| one.is_some() && other.is_some();
            if twice(corner.into, later.into) || twice(corner.out, later.out) {
                two_fans.get_or_insert(corner.v);
            }
            corner.into = corner.into.or(later.into);
            corner.out = corner.out.or(later.out);
            true
        });
        match two_fans {
            Some(vertex) => Err(EditError::SeveralFans { vertex }),
            None => Ok(corners),
        }
    }

    /// Checks that one fan remains at each corner. A fan begins where the outline arrives and the
    /// face across it stays. No other fan may then begin at the boundary that was there before.
    fn check_corners(
        &self,
        corners: impl IntoIterator<Item = Corner>,
        gone: &Few<FaceId>,
    ) -> Result<(), Refusal<Self>> {
        let corners = corners.into_iter();
        for corner in corners.filter(|corner| corner.into.is_some()) {
            let vertex = corner.v;
            let Some(spoke) = self.spokes.read(vertex.index()).get() else {
                continue;
            };
            let first = Run::from(self.record(spoke), vertex);
            let begins = first.face().get().is_some_and(|f| !gone.has(f));
            if first.across() == Slot::NONE && begins {
                return Err(EditError::SeveralFans { vertex });
            }
        }
        Ok(())
    }

    /// Makes the outline a boundary, and removes the edges that no longer have a face.
    fn take_out(
        &mut self,
        outline: &[Rim],
        corners: impl IntoIterator<Item = Corner>,
        log: &mut impl EditLog<Self>,
    ) {
        for Corner { v, into, out } in corners {
            match (into, out) {
                (Some(into), Some(out)) => {
                    self.link(into, out);
                    self.set_spoke(v, into.edge);
                }
                (Some(into), None) => {
                    let out = self.run_after(self.old_boundary_into(v));
                    self.link(into, out);
                    self.set_spoke(v, into.edge);
                }
                (None, Some(out)) => {
                    let into = self.old_boundary_into(v);
                    self.link(into, out);
                }
                (None, None) => *self.spokes.write(v.index()) = Slot::NONE,
            }
        }
        for rim in outline {
            match (rim.across, rim.run.side) {
                (Across::Stays, _) => self.set_face(rim.run, Slot::NONE),
                (Across::Goes, Side::RIGHT) => {}
                _ => self.delete_edge(rim.run.edge, log),
            }
        }
    }

    /// Returns the run without a face that arrives at `v`, where the outline meets the old
    /// boundary.
    fn old_boundary_into(&self, v: VertexId) -> RunId {
        let into = self.boundary_into(v);
        into.expect("a fan that does not end at a rim ends at the boundary")
    }
}

/// Iterates over the corners between consecutive rims, and those where a chain of rims begins or
/// ends.
fn corners_of(outline: &[Rim]) -> impl Iterator<Item = Corner> + Clone {
    let kept = |rim: &Rim| (rim.across == Across::Stays).then_some(rim.run);
    let before = outline.iter().cycle().skip(outline.len() - 1);
    before.zip(outline).flat_map(move |(before, rim)| {
        let joined = before.target == rim.origin;
        let end = Corner {
            v: before.target,
            into: kept(before),
            out: kept(rim).filter(|_| joined),
        };
        let start = Corner {
            v: rim.origin,
            into: None,
            out: kept(rim),
        };
        [Some(end), (!joined).then_some(start)]
            .into_iter()
            .flatten()
    })
}
