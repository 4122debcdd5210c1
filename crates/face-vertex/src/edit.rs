//! Edits in place: they rewrite corners and repair the fans at these corners.
//!
//! The structure holds every polygon mesh, so an edit is refused only if the edit itself is not
//! possible (for example the flip of a boundary edge), if a handle is not valid, or if the tables
//! are full. An edge can have any number of faces, and a vertex any number of fans. After a
//! collapse, an edge may have many faces, and several faces may have the same corners.
//! [`EditableFaceVertexMesh`] documents the cost of each edit.

mod collapse;
mod compact;
mod corners;
mod fans;
mod find;
mod split_vertex;
#[cfg(test)]
mod tests;

use sixfold_core::{
    Edit, EditError, EditLog, Editable, FaceId, HoleSet, MeshEdit, Pair, Point, Probe, QueryCost,
    Refusal, ShortVec, VertexId, check_corners, check_cut, faces_once, row, uses_reports,
};

use self::corners::{corners_from, sides, third_corner};
use crate::mesh::{BLANK_CORNER, FaceVertexMesh};

type Edge = Pair<VertexId>;

impl<P: Probe> MeshEdit for FaceVertexMesh<Editable, P> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = Edit::LOCAL_COSTS;

    sixfold_core::compact_conversions!(FaceVertexMesh);

    #[inline]
    fn set_position_logged(
        &mut self,
        v: VertexId,
        to: Point,
        _: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.fan_of(v)?;
        *self.positions.write(v.index()) = to;
        Ok(v)
    }

    fn add_vertex_logged(
        &mut self,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.check_room(1, 0, 0)?;
        let v = self.push_vertex(at, &[]);
        log.created_vertex(v);
        Ok(v)
    }

    fn add_face_logged(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        check_corners(corners, |v| self.fan_of(v).and(Ok(())))?;
        self.check_room(0, 1, corners.len())?;
        if uses_reports(log) {
            let new = sides(corners).filter(|&e| !self.has_edge(e));
            new.for_each(|e| log.created_edge(e));
        }
        let f = self.spans.push(&mut self.corners, corners);
        for &v in corners {
            self.add_to_fan(v, f);
        }
        log.created_face(f);
        Ok(f)
    }

    fn remove_face_logged(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        let face = ShortVec::from_iter(self.corners_of_face(f)?.iter().copied());
        for &v in &*face {
            self.remove_from_fan(v, f);
        }
        self.delete_face(f);
        if uses_reports(log) {
            log.removed_face(f);
            self.report_removed(sides(&face), log);
        }
        Ok(())
    }

    fn remove_faces_logged(
        &mut self,
        faces: &[FaceId],
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        let gone = faces_once(faces, |f| self.corners_of_face(f).map(drop))?;
        gone.into_iter()
            .try_for_each(|f| self.remove_face_logged(f, log))
    }

    fn remove_vertex_logged(
        &mut self,
        v: VertexId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        self.fan_of(v)?;
        let faces = ShortVec::from_iter(self.fan(v).iter().copied());
        let mut along = Vec::new();
        for &f in &*faces {
            let face = ShortVec::from_iter(self.known_face(f).iter().copied());
            for &u in face.iter().filter(|&&u| u != v) {
                self.remove_from_fan(u, f);
            }
            self.delete_face(f);
            if uses_reports(log) {
                log.removed_face(f);
                along.extend(sides(&face));
            }
        }
        self.delete_vertex(v);
        log.removed_vertex(v);
        along.sort_unstable();
        along.dedup();
        self.report_removed(along, log);
        Ok(())
    }

    fn remove_isolated_vertices_logged(&mut self, log: &mut impl EditLog<Self>) -> usize {
        let before = self.vertex_holes.len();
        for v in (0..row(self.fans.len())).map(VertexId::new) {
            if self.fans.read(v.index()).len == 0 {
                self.delete_vertex(v);
                log.removed_vertex(v);
            }
        }
        self.vertex_holes.len() - before
    }

    fn split_edge_logged(
        &mut self,
        e: Edge,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        let along = self.faces_of_edge(e)?;
        let degrees = along.iter().map(|&f| self.known_face(f).len() + 1);
        self.check_room(1, 0, degrees.sum())?;
        let m = self.push_vertex(at, &along);
        for &f in &*along {
            let mut face = ShortVec::new();
            let old = self.known_face(f);
            for (&corner, side) in old.iter().zip(sides(old)) {
                face.push(corner);
                if side == e {
                    face.push(m);
                }
            }
            self.spans
                .rewrite(&mut self.corners, f, &face, BLANK_CORNER);
        }
        report_split(e, m, log);
        Ok(m)
    }

    fn bisect_edge_logged(
        &mut self,
        e: Edge,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        let mut faces = self.faces_of_edge(e)?;
        for &f in &*faces {
            self.triangle(f)?;
        }
        let along = faces.len();
        self.check_room(1, along, 4 * along)?;
        let m = VertexId::new(row(self.fans.len()));
        let mut apexes = Vec::new();
        for i in 0..along {
            let f = faces[i];
            let (b, c) = third_corner(self.triangle(f)?, e);
            self.replace_corner(f, b, m);
            let g = self.spans.push(&mut self.corners, &[m, b, c]);
            self.replace_in_fan(b, f, g);
            self.add_to_fan(c, g);
            faces.push(g);
            if uses_reports(log) {
                log.created_face(g);
                apexes.push(c);
            }
        }
        apexes.sort_unstable();
        apexes.dedup();
        let spokes = apexes.iter().map(|&c| Pair::new(m, c));
        spokes.for_each(|spoke| log.created_edge(spoke));
        self.push_vertex(at, &faces);
        report_split(e, m, log);
        Ok(m)
    }

    fn poke_face_logged(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        let face = ShortVec::from_iter(self.corners_of_face(f)?.iter().copied());
        self.check_room(1, face.len() - 1, 3 * face.len())?;
        let n = VertexId::new(row(self.fans.len()));
        let mut parts = ShortVec::new();
        parts.push(f);
        self.spans
            .rewrite(&mut self.corners, f, &[face[0], face[1], n], BLANK_CORNER);
        for (i, &a) in face.iter().enumerate().skip(1) {
            let b = face[if i + 1 == face.len() { 0 } else { i + 1 }];
            let part = self.spans.push(&mut self.corners, &[a, b, n]);
            // Face `f` is this part or the part before.
            if i > 1 {
                self.replace_in_fan(a, f, part);
                self.add_to_fan(a, parts[i - 1]);
            } else {
                self.add_to_fan(a, part);
            }
            parts.push(part);
        }
        self.add_to_fan(face[0], parts[parts.len() - 1]);
        self.push_vertex(at, &parts);
        if uses_reports(log) {
            log.created_vertex(n);
            face.iter().for_each(|&a| log.created_edge(Pair::new(a, n)));
            parts[1..].iter().for_each(|&part| log.created_face(part));
        }
        Ok(n)
    }

    /// Face `f` keeps the corners between the two ends, in the corner order of `f`.
    fn split_face_logged(
        &mut self,
        f: FaceId,
        ends: [VertexId; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<Edge, Refusal<Self>> {
        let face = self.corners_of_face(f)?;
        let [i, j] = check_cut(f, face, ends, |v, &corner| v == corner)?;
        let kept = ShortVec::from_iter(face[i..=j].iter().copied());
        let new = face[j..].iter().chain(&face[..=i]);
        let new = ShortVec::from_iter(new.copied());
        self.check_room(0, 1, new.len())?;
        let e = Pair::new(ends[0], ends[1]);
        if uses_reports(log) && !self.has_edge(e) {
            log.created_edge(e);
        }
        let g = self.spans.push(&mut self.corners, &new);
        self.spans
            .rewrite(&mut self.corners, f, &kept, BLANK_CORNER);
        for &v in &new[1..new.len() - 1] {
            self.replace_in_fan(v, f, g);
        }
        for v in ends {
            self.add_to_fan(v, g);
        }
        log.created_face(g);
        Ok(e)
    }

    /// Keeps the face that runs along `e` from the lower end of `e`.
    fn dissolve_edge_logged(
        &mut self,
        e: Edge,
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        let [f, g] = self.two_faces(e)?;
        let [low, high] = e.ends();
        // First the corners of f from the higher end to the lower end, then the corners of g.
        let kept = corners_from(self.known_face(f), high);
        let gained = corners_from(self.known_face(g), low).skip(1);
        let gained = gained.filter(|&v| v != high);
        let gained = ShortVec::from_iter(gained);
        let merged = ShortVec::from_iter(kept.chain(gained.iter().copied()));
        if let Some(&vertex) = gained.iter().find(|&&v| self.fan(v).contains(&f)) {
            return Err(EditError::RepeatedVertex { vertex });
        }
        self.check_room(0, 0, merged.len())?;
        for &v in &*gained {
            self.replace_in_fan(v, g, f);
        }
        self.remove_from_fan(low, g);
        self.remove_from_fan(high, g);
        self.spans
            .rewrite(&mut self.corners, f, &merged, BLANK_CORNER);
        self.delete_face(g);
        log.removed_edge(e);
        log.removed_face(g);
        Ok(f)
    }

    fn flip_edge_logged(
        &mut self,
        e: Edge,
        log: &mut impl EditLog<Self>,
    ) -> Result<Edge, Refusal<Self>> {
        let [f, g] = self.two_faces(e)?;
        let [low, high] = e.ends();
        let (_, c) = third_corner(self.triangle(f)?, e);
        let (_, d) = third_corner(self.triangle(g)?, e);
        if c == d {
            return Err(EditError::SameApex { edge: e, vertex: c });
        }
        let turned = Pair::new(c, d);
        if self.has_edge(turned) {
            return Err(EditError::EdgeExists { ends: [c, d] });
        }
        for vertex in [low, high] {
            if self.fans.read(vertex.index()).len == 3 && self.valence(vertex) == 3 {
                return Err(EditError::LowValence { vertex });
            }
        }
        self.check_room(0, 0, 2)?;
        self.replace_corner(f, high, d);
        self.replace_corner(g, low, c);
        self.remove_from_fan(high, f);
        self.remove_from_fan(low, g);
        self.add_to_fan(d, f);
        self.add_to_fan(c, g);
        log.renamed_edge(e, turned);
        Ok(turned)
    }

    fn collapse_edge_logged(
        &mut self,
        e: Edge,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.collapse(e, keep, to, log)
    }

    fn split_vertex_logged(
        &mut self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.split_fan(v, [left, right], at, log)
    }

    /// Stores the fans in the order of the vertices, and the faces of each fan in ascending order.
    fn compact_logged(&mut self, log: &mut impl EditLog<Self>) {
        self.compact_tables(log);
    }
}

impl<P: Probe> FaceVertexMesh<Editable, P> {
    /// Reports the `sides` that were edges and are not edges any more.
    fn report_removed(&self, sides: impl IntoIterator<Item = Edge>, log: &mut impl EditLog<Self>) {
        for e in sides.into_iter().filter(|&e| !self.has_edge(e)) {
            log.removed_edge(e);
        }
    }
}

/// Reports the split of `e` at `m`: the lower half is the renamed `e`, and the upper half is new.
fn report_split<P: Probe>(
    e: Edge,
    m: VertexId,
    log: &mut impl EditLog<FaceVertexMesh<Editable, P>>,
) {
    let [low, high] = e.ends();
    log.created_vertex(m);
    log.renamed_edge(e, Pair::new(low, m));
    log.created_edge(Pair::new(m, high));
}
