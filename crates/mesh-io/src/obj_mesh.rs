//! What a file holds, and the mesh it becomes.

use std::fmt;

use mesh_core::{Creases, FaceList, Facts, IteratorExt, Point, PolygonMesh, VertexId};

use crate::notice::Notice;
use crate::tags::{CornerTag, CreaseTag, LooseCrease, on_polygons};

/// The vertices and faces of a file, numbered as the file numbers them.
///
/// `VertexId` counts from 0, the file from 1: `v0` is what the file calls 1.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ObjMesh {
    /// Every vertex of the file, used or not.
    pub positions: Vec<Point>,
    /// Every face of three corners or more, those that name a vertex twice included.
    pub faces: FaceList,
    /// By face: its line, counted from 1.
    pub face_lines: Vec<u32>,
    /// Faces of fewer than three corners.
    pub short_faces: Vec<ShortFace>,
    /// The edges that `t crease` tags make sharp, in file order; all of them are sides of faces, which
    /// need not be polygons.
    pub crease_tags: Vec<CreaseTag>,
    /// The vertices that `t corner` tags make sharp, in file order.
    pub corner_tags: Vec<CornerTag>,
    /// What was passed over, in the order of the first of each kind.
    pub notices: Vec<Notice>,
}

/// A face of fewer than three corners.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShortFace {
    /// Its line, counted from 1.
    pub line: u32,
    /// Its vertices, two at most.
    pub corners: Vec<VertexId>,
}

/// A face that is no polygon; prints as `line 23: face 1 1 2 names vertex 1 twice`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Its line, counted from 1.
    pub line: u32,
    /// Its vertices as the file numbers them, from 1.
    pub vertices: Vec<u32>,
    /// Why it is left out.
    pub reason: LeftOutReason,
}

/// Why a face is no polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LeftOutReason {
    /// It has fewer than three corners.
    TooFewCorners,
    /// It names a vertex twice: this one, numbered from 1.
    RepeatedVertex(u32),
}

impl ObjMesh {
    /// The topology of the file, degenerate and short faces counted as such; O(corners) expected.
    ///
    /// # Panics
    ///
    /// If `faces` was changed and names a vertex that is not there.
    pub fn facts(&self) -> Facts {
        let facts = Facts::of_faces(self.positions.len(), &self.faces);
        let mut facts = facts.unwrap_or_else(|error| panic!("{error}"));
        facts.degenerate_faces += self.short_faces.len();
        facts
    }

    /// How sharp the tags make the edges and vertices of [`into_polygons`](Self::into_polygons), which
    /// keeps all vertices and their numbers; and the creases that have no edge there, because
    /// degenerate and short faces are left out. Of two tags for one element the later counts.
    ///
    /// O(corners · log tags), nothing where there are no tags.
    ///
    /// # Examples
    ///
    /// ```
    /// let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt crease 3/1/0 2 0 1 4.7\nt corner 1/1/0 1 inf\n";
    /// let obj = mesh_io::parse_obj("triangle.obj", text.as_bytes())?;
    /// let (creases, loose) = obj.creases();
    /// assert_eq!((creases.edges().len(), creases.corners().len(), loose.len()), (2, 1, 0));
    /// # Ok::<(), mesh_io::ObjError>(())
    /// ```
    pub fn creases(&self) -> (Creases, Vec<LooseCrease>) {
        on_polygons(&self.crease_tags, &self.corner_tags, &self.faces)
    }

    /// The mesh without its degenerate and short faces, and these by line; O(corners).
    ///
    /// # Panics
    ///
    /// If `faces` was changed and names a vertex that is not there, or `face_lines` is shorter.
    pub fn into_polygons(self) -> (PolygonMesh, Vec<LeftOut>) {
        let mut left_out: Vec<LeftOut> = Vec::new();
        for short in &self.short_faces {
            let reason = LeftOutReason::TooFewCorners;
            left_out.push(LeftOut::new(short.line, &short.corners, reason));
        }
        for (f, face) in self.faces.iter() {
            if let Some(vertex) = repeated(face) {
                let reason = LeftOutReason::RepeatedVertex(number(vertex));
                left_out.push(LeftOut::new(self.face_lines[f.index()], face, reason));
            }
        }
        left_out.sort_by_key(|left_out| left_out.line);
        let faces = if left_out.len() == self.short_faces.len() {
            self.faces
        } else {
            let mut kept = FaceList::with_capacity(self.faces.corners().len());
            for (_, face) in self
                .faces
                .iter()
                .filter(|(_, face)| repeated(face).is_none())
            {
                let face = face.iter().copied();
                kept.push(face).expect("fewer than there were");
            }
            kept
        };
        let polygons = PolygonMesh::from_faces(self.positions, faces);
        (polygons.unwrap_or_else(|error| panic!("{error}")), left_out)
    }
}

impl LeftOut {
    fn new(line: u32, corners: &[VertexId], reason: LeftOutReason) -> Self {
        let vertices = corners.iter().copied().map(number).collect();
        Self {
            line,
            vertices,
            reason,
        }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// How many corners a line of text can bear.
        const MOST: usize = 8;
        write!(f, "line {}: face", self.line)?;
        for vertex in self.vertices.iter().take(MOST) {
            write!(f, " {vertex}")?;
        }
        if self.vertices.len() > MOST {
            write!(f, " …")?;
        }
        match self.reason {
            LeftOutReason::TooFewCorners => write!(f, " has fewer than three corners"),
            LeftOutReason::RepeatedVertex(vertex) => write!(f, " names vertex {vertex} twice"),
        }
    }
}

/// What the file calls `vertex`.
fn number(vertex: VertexId) -> u32 {
    mesh_core::row(vertex.index() + 1)
}

/// The first vertex that `face` names for the second time; O(corners) expected.
pub(crate) fn repeated(face: &[VertexId]) -> Option<VertexId> {
    let mut distinct = face.iter().copied().distinct();
    face.iter().copied().find(|&v| distinct.next() != Some(v))
}
