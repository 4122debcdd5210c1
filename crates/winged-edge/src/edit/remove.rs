//! Removing one face, all faces at a vertex, and isolated vertices.

use sixfold_core::{
    EditError, EditLog, Editable, FaceId, Lookup, Probe, Refusal, ShortVec, Slot, VertexId,
};

use crate::edge::{Run, RunId};
use crate::mesh::WingedEdgeMesh;
use crate::wings::Side;

/// A run along the outline of the removed faces. The outline of one face is all its sides. The
/// outline of the faces at a vertex is all sides without that vertex.
#[derive(Clone, Copy)]
struct OutlineRun {
    run: RunId,
    origin: VertexId,
    target: VertexId,
    across: Across,
}

/// The element across a run of the outline.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Across {
    /// A face that is kept. The run becomes a boundary.
    Kept,
    /// No face. The edge is removed.
    NoFace,
    /// Another removed face. The edge is twice on the outline and is removed.
    Removed,
}

/// A corner of the outline, and the runs there that lose their face.
#[derive(Clone, Copy)]
struct Corner {
    v: VertexId,
    into: Option<RunId>,
    out: Option<RunId>,
}

impl<P: Probe> WingedEdgeMesh<Editable, P> {
    pub(super) fn remove(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        let first = self.along(self.check_face(f)?, f);
        let mut gone = ShortVec::new();
        gone.push(f);
        let mut outline = ShortVec::new();
        let mut run = first;
        loop {
            outline.push(self.outline_run(run, &gone));
            run = self.run_after(run);
            if run == first {
                break;
            }
        }
        let corners = corners_of(outline.as_slice());
        self.check_corners(corners.clone(), &gone)?;
        self.make_boundary(outline.as_slice(), corners, log);
        self.delete_face(f, log);
        Ok(())
    }

    /// Removes `f` and the edges without another face; O(degree). While several faces are removed, a vertex
    /// may have several fans: `next` and `prev` of the runs without a face lead across each gap.
    pub(super) fn unlink_face(&mut self, f: FaceId, log: &mut impl EditLog<Self>) {
        let first = self.along(*self.sides.read(f.index()), f);
        let mut runs = ShortVec::new();
        let mut run = first;
        loop {
            runs.push((run, self.run(run).across() != Slot::NONE));
            run = self.run_after(run);
            if run == first {
                break;
            }
        }
        let mut arriving = runs.as_slice()[runs.as_slice().len() - 1];
        for &leaving in runs.as_slice() {
            let v = self.run(leaving.0).origin();
            let into = match arriving {
                (run, true) => run,
                (run, false) => self.run_before(run.twin()),
            };
            let out = match leaving {
                (run, true) => run,
                (run, false) => self.run_after(run.twin()),
            };
            if out == arriving.0.twin() {
                *self.spokes.write(v.index()) = Slot::NONE;
            } else {
                self.link(into, out);
                self.set_spoke(v, into.edge);
            }
            arriving = leaving;
        }
        for &(run, has_other_face) in runs.as_slice() {
            match has_other_face {
                true => self.set_face(run, Slot::NONE),
                false => self.delete_edge(run.edge, log),
            }
        }
        self.delete_face(f, log);
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
        let mut gone = ShortVec::new();
        let mut spokes = ShortVec::new();
        for (e, run) in self.runs_from(v) {
            spokes.push(e);
            if let Some(f) = run.face().get() {
                gone.push(f);
            }
        }
        gone.sort_for_lookup();
        let mut outline = ShortVec::new();
        for &e in spokes.as_slice() {
            let first = self.leaving(e, v);
            if self.run(first).face() == Slot::NONE {
                continue;
            }
            let mut run = self.run_after(first);
            while self.run(run).target() != v {
                outline.push(self.outline_run(run, &gone));
                run = self.run_after(run);
            }
        }
        let corners = corners_of(outline.as_slice());
        if outline.as_slice().len() == gone.as_slice().len() {
            self.check_corners(corners.clone(), &gone)?;
            self.make_boundary(outline.as_slice(), corners, log);
        } else {
            // With triangles only, the outline visits each vertex at most once.
            let merged = Self::merge_corners(corners.collect())?;
            self.check_corners(merged.iter().copied(), &gone)?;
            self.make_boundary(outline.as_slice(), merged, log);
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

    fn outline_run(&self, id: RunId, gone: &ShortVec<FaceId>) -> OutlineRun {
        let run = self.run(id);
        let across = match run.across().get() {
            None => Across::NoFace,
            Some(f) if gone.has(f) => Across::Removed,
            Some(_) => Across::Kept,
        };
        OutlineRun {
            run: id,
            origin: run.origin(),
            target: run.target(),
            across,
        }
    }

    /// Merges the corners of each vertex. Refuses two fans at one vertex.
    fn merge_corners(mut corners: Vec<Corner>) -> Result<Vec<Corner>, Refusal<Self>> {
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

    /// Checks that one fan remains at each corner. A fan begins at a corner if the face across
    /// the arriving outline is kept. Then no other fan may begin at the old boundary there.
    fn check_corners(
        &self,
        corners: impl IntoIterator<Item = Corner>,
        gone: &ShortVec<FaceId>,
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

    /// Makes the outline a boundary, and removes the edges without a face.
    fn make_boundary(
        &mut self,
        outline: &[OutlineRun],
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
        for side in outline {
            match (side.across, side.run.side) {
                (Across::Kept, _) => self.set_face(side.run, Slot::NONE),
                (Across::Removed, Side::RIGHT) => {}
                _ => self.delete_edge(side.run.edge, log),
            }
        }
    }

    /// Returns the run of the old boundary that arrives at `v`.
    fn old_boundary_into(&self, v: VertexId) -> RunId {
        let into = self.boundary_into(v);
        into.expect("a fan that does not end at the outline ends at the boundary")
    }
}

/// Iterates over the corners between consecutive runs, and over the corners at the ends of chains.
fn corners_of(outline: &[OutlineRun]) -> impl Iterator<Item = Corner> + Clone {
    let kept = |side: &OutlineRun| (side.across == Across::Kept).then_some(side.run);
    let before = outline.iter().cycle().skip(outline.len() - 1);
    before.zip(outline).flat_map(move |(before, side)| {
        let joined = before.target == side.origin;
        let end = Corner {
            v: before.target,
            into: kept(before),
            out: kept(side).filter(|_| joined),
        };
        let start = Corner {
            v: side.origin,
            into: None,
            out: kept(side),
        };
        [Some(end), (!joined).then_some(start)]
            .into_iter()
            .flatten()
    })
}
