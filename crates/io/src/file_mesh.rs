//! The contents of a mesh file, and their conversion to a mesh.

use std::fmt;

use sixfold_core::{Creases, FaceId, FaceList, Facts, Point, PolygonMesh, VertexId};

use crate::face_rules::repeated_vertex;
use crate::format::Format;
use crate::narrowing::Narrowing;
use crate::notice::Notice;
use crate::place::{FacePlaces, Gaps, Place, PolygonPlaces, VertexPlaces};
use crate::tags::{CornerTag, CreaseTag, UnusedCrease, creases_on_polygons};

/// The vertices and faces of a file.
///
/// A `VertexId` counts from 0. OBJ counts from 1: `v0` is vertex 1 of the file. PLY, OFF and glTF
/// count from 0. STL has no numbers: vertices are numbered by first use.
///
/// Normals, colours and texture coordinates are not kept; [`notices`](Self::notices) lists them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FileMesh {
    /// Format of the file.
    pub format: Format,
    /// Positions of all vertices of the file, including unused vertices.
    pub positions: Vec<Point>,
    /// All faces with three corners or more, including faces that use a vertex twice. A corner that
    /// repeats its neighbour was removed, if three different corners remain
    /// ([`IgnoredKind::RepeatedCorners`](crate::IgnoredKind::RepeatedCorners)). A polygon that used a
    /// vertex twice otherwise was cut into triangles
    /// ([`IgnoredKind::CutFaces`](crate::IgnoredKind::CutFaces)); it is unchanged if it crosses itself.
    pub faces: FaceList,
    /// Place of each face.
    pub(crate) face_places: FacePlaces,
    /// Places of the vertices.
    pub(crate) vertex_places: VertexPlaces,
    /// Faces with fewer than three corners.
    pub short_faces: Vec<ShortFace>,
    /// Sharp edges from `t crease` tags, in file order; empty in other formats than OBJ. Each edge
    /// is a side of a face; this face can be degenerate or short.
    pub crease_tags: Vec<CreaseTag>,
    /// Sharp vertices from `t corner` tags, in file order; empty in other formats than OBJ.
    pub corner_tags: Vec<CornerTag>,
    /// Ignored contents, one entry per kind, in the order of the first occurrences.
    pub notices: Vec<Notice>,
    /// Vertices of the file that became one vertex because their positions are equal: the number
    /// of vertices in the file minus the number of [`positions`](Self::positions).
    pub welded_vertices: usize,
    /// What rounding to 32 bits did to the coordinates.
    pub narrowing: Narrowing,
    /// Place of the origin in the coordinates of the file: add it to a position to get the position
    /// in the file. It is zero unless the mesh was moved
    /// ([`ReadOptions::recentred`](crate::ReadOptions::recentred)).
    pub origin: [f64; 3],
}

/// A face with fewer than three corners.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShortFace {
    /// Place of the face.
    pub place: Place,
    /// Vertices of the face, at most two.
    pub corners: Vec<VertexId>,
}

/// A face that is not a valid polygon, printed for example as `line 23: face 1 1 2 names vertex 1
/// twice`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LeftOut {
    /// Place of the face.
    pub place: Place,
    /// Vertices of the face, numbered as in the file.
    pub vertices: Vec<u32>,
    /// Reason why the face is left out.
    pub reason: LeftOutReason,
}

/// The reason why a face is not a valid polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LeftOutReason {
    /// The face has fewer than three corners.
    TooFewCorners,
    /// The face uses this vertex twice. The number is the number in the file.
    RepeatedVertex(u32),
}

impl FileMesh {
    /// Returns the topology of the mesh that [`into_polygons`](Self::into_polygons) returns, and in
    /// `degenerate_faces` the number of faces that it leaves out. O(corners) expected.
    ///
    /// # Panics
    ///
    /// Panics if `faces` was changed and uses a vertex that does not exist.
    pub fn facts(&self) -> Facts {
        let kept = self.kept_faces();
        let kept = kept.as_ref().unwrap_or(&self.faces);
        let facts = Facts::from_faces(self.positions.len(), kept);
        let facts = facts.unwrap_or_else(|error| panic!("{error}"));
        let left_out = self.faces.len() - kept.len() + self.short_faces.len();
        Facts {
            degenerate_faces: left_out,
            ..facts
        }
    }

    /// Returns the faces that are not left out; `None` if these are all `faces`. O(corners) expected.
    fn kept_faces(&self) -> Option<FaceList> {
        let is_kept = |face: &[VertexId]| repeated_vertex(face).is_none();
        if self.faces.iter().all(|(_, face)| is_kept(face)) {
            return None;
        }
        let mut kept = FaceList::with_capacity(self.faces.corners().len());
        for (_, face) in self.faces.iter().filter(|(_, face)| is_kept(face)) {
            let pushed = kept.push(face.iter().copied());
            pushed.expect("fewer faces than before");
        }
        Some(kept)
    }

    /// Returns whether [`into_polygons`](Self::into_polygons) leaves out faces. O(corners) expected.
    pub fn has_degenerate_faces(&self) -> bool {
        let mut faces = self.faces.iter();
        !self.short_faces.is_empty() || faces.any(|(_, face)| repeated_vertex(face).is_some())
    }

    /// Returns the place of `face` in the file: a line, a byte, or in glTF its number; O(1).
    ///
    /// # Panics
    ///
    /// Panics if there is no such face, or if `faces` was changed.
    pub fn face_place(&self, face: FaceId) -> Place {
        self.face_places.place(face, &self.faces)
    }

    /// Returns the sharpness of the edges and vertices of [`into_polygons`](Self::into_polygons),
    /// which keeps all vertices and their numbers. Also returns the creases whose edge is not in
    /// that mesh, because the mesh has no degenerate and no short faces. If several tags name one
    /// element, the last tag is used.
    ///
    /// O(corners · log tags), or O(1) without tags.
    ///
    /// # Examples
    ///
    /// ```
    /// let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt crease 3/1/0 2 0 1 4.7\nt corner 1/1/0 1 inf\n";
    /// let obj = sixfold_io::parse_obj("triangle.obj", text.as_bytes())?;
    /// let (creases, unused) = obj.creases();
    /// assert_eq!((creases.edges().len(), creases.corners().len(), unused.len()), (2, 1, 0));
    /// # Ok::<(), sixfold_io::ReadError>(())
    /// ```
    pub fn creases(&self) -> (Creases, Vec<UnusedCrease>) {
        creases_on_polygons(&self.crease_tags, &self.corner_tags, &self.faces)
    }

    /// Returns the mesh without its degenerate and short faces. Also returns these faces, sorted by
    /// place. O(corners).
    ///
    /// # Panics
    ///
    /// Panics if `faces` was changed.
    pub fn into_polygons(self) -> (PolygonMesh, Vec<LeftOut>) {
        let (polygons, left_out, _) = self.into_polygons_with_places();
        (polygons, left_out)
    }

    /// Returns the mesh and the faces that were left out like [`into_polygons`](Self::into_polygons),
    /// and the places of the vertices and faces of this mesh in the file. O(corners).
    ///
    /// # Panics
    ///
    /// Panics if `faces` was changed.
    ///
    /// # Examples
    ///
    /// ```
    /// use sixfold_core::{FaceId, VertexId};
    /// use sixfold_io::Place;
    ///
    /// let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\nf 1 2 3\n";
    /// let obj = sixfold_io::parse_obj("triangle.obj", text.as_bytes())?;
    /// let (polygons, left_out, places) = obj.into_polygons_with_places();
    /// assert_eq!((polygons.face_count(), left_out.len()), (1, 1));
    /// assert_eq!(places.place(FaceId::new(0), &polygons), Place::Line(5));
    /// assert_eq!(places.vertex_place(VertexId::new(2)), Some(Place::Line(3)));
    /// # Ok::<(), sixfold_io::ReadError>(())
    /// ```
    pub fn into_polygons_with_places(self) -> (PolygonMesh, Vec<LeftOut>, PolygonPlaces) {
        let first = self.format.first_vertex();
        let mut left_out: Vec<LeftOut> = Vec::new();
        for short in &self.short_faces {
            let reason = LeftOutReason::TooFewCorners;
            left_out.push(LeftOut::new(short.place, &short.corners, reason, first));
        }
        let mut gaps = Gaps::default();
        for (f, face) in self.faces.iter() {
            if let Some(vertex) = repeated_vertex(face) {
                let reason = LeftOutReason::RepeatedVertex(number(vertex, first));
                left_out.push(LeftOut::new(self.face_place(f), face, reason, first));
                gaps.push(f, face.len());
            }
        }
        left_out.sort_by_key(|left_out| left_out.place);
        let faces = match gaps.is_empty() {
            true => self.faces,
            false => self.kept_faces().unwrap_or_default(),
        };
        let polygons = PolygonMesh::from_faces(self.positions, faces);
        let polygons = polygons.unwrap_or_else(|error| panic!("{error}"));
        let places = PolygonPlaces::new(self.face_places, gaps, self.vertex_places);
        (polygons, left_out, places)
    }
}

impl LeftOut {
    fn new(place: Place, corners: &[VertexId], reason: LeftOutReason, first: usize) -> Self {
        let vertices = corners.iter().map(|&v| number(v, first)).collect();
        Self {
            place,
            vertices,
            reason,
        }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// Maximum number of corners that are printed.
        const MAX_CORNERS: usize = 8;
        write!(f, "{}: face", self.place)?;
        for vertex in self.vertices.iter().take(MAX_CORNERS) {
            write!(f, " {vertex}")?;
        }
        if self.vertices.len() > MAX_CORNERS {
            write!(f, " …")?;
        }
        match self.reason {
            LeftOutReason::TooFewCorners => write!(f, " has fewer than three corners"),
            LeftOutReason::RepeatedVertex(vertex) => write!(f, " names vertex {vertex} twice"),
        }
    }
}

/// Returns the number of `vertex` in a file that counts from `first`.
fn number(vertex: VertexId, first: usize) -> u32 {
    sixfold_core::row(vertex.index() + first)
}
