//! Places in files: lines, bytes and numbered items.

use std::fmt;

use sixfold_core::{FaceId, FaceList, PolygonMesh, VertexId};

/// A place in a file; printed as `line 17`, `byte 134` or `accessor 3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Place {
    /// A line of a text file, counted from 1; for a continued statement, its first line.
    Line(u32),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
    /// An item of a numbered list, counted from 0.
    Item {
        /// What the list holds, in the singular.
        kind: &'static str,
        /// Number of the item, counted from 0.
        number: usize,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::Item { kind, number } => write!(f, "{kind} {number}"),
        }
    }
}

/// A place with the name of its file; printed as `bunny.obj:17` or `bunny.stl: byte 134`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Location {
    /// Name of the file, as given by the caller.
    pub file: String,
    /// Place in the file.
    pub place: Place,
}

impl Location {
    /// Returns the location of `place` in the file with this name.
    pub(crate) fn new(file: &str, place: Place) -> Self {
        let file = file.to_owned();
        Self { file, place }
    }

    /// Returns the location of a line, counted from 1.
    pub(crate) fn line(file: &str, line: u32) -> Self {
        Self::new(file, Place::Line(line))
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Place::Line(line) => write!(f, "{}:{line}", self.file),
            place => write!(f, "{}: {place}", self.file),
        }
    }
}

/// The place of each face in its file.
///
/// Text files need four bytes per face. In most binary files the place is computed: a record is a
/// fixed number of bytes, plus a fixed number per corner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FacePlaces {
    /// The line of each face.
    Lines(Vec<u32>),
    /// Records of a regular size.
    Records {
        /// Byte of the first face.
        first: u64,
        /// Bytes of a face without its corners.
        per_face: u64,
        /// Bytes of a corner.
        per_corner: u64,
    },
    /// The byte of each face.
    Bytes(Vec<u64>),
    /// Faces without a place of their own: their numbers.
    #[cfg_attr(not(feature = "gltf"), expect(dead_code))]
    Numbers,
}

impl FacePlaces {
    /// Returns the place of `face`, which is one of `faces`.
    pub(crate) fn place(&self, face: FaceId, faces: &FaceList) -> Place {
        self.place_of_number(face.index(), || faces.range(face).start)
    }

    /// Returns the place of face number `face` of the file. `corners` returns the number of corners
    /// before it.
    fn place_of_number(&self, face: usize, corners: impl FnOnce() -> usize) -> Place {
        match self {
            Self::Lines(lines) => Place::Line(lines[face]),
            Self::Bytes(bytes) => Place::Byte(bytes[face]),
            Self::Records { .. } => Place::Byte(self.predicted(face, corners())),
            Self::Numbers => Place::Item {
                kind: "face",
                number: face,
            },
        }
    }

    /// Records that face number `face`, with `corners` corners before it, is at `byte`. If the
    /// records are not regular, every byte is stored from now on.
    pub(crate) fn push_byte(&mut self, faces: &FaceList, byte: u64) {
        let (face, corners) = (faces.len(), faces.corners().len());
        if matches!(self, Self::Records { .. }) && self.predicted(face, corners) != byte {
            self.store(faces);
        }
        if let Self::Bytes(bytes) = self {
            bytes.push(byte);
        }
    }

    /// Stores the places of `faces`, if they are computed: then they no longer depend on the numbers
    /// of corners.
    pub(crate) fn store(&mut self, faces: &FaceList) {
        if matches!(self, Self::Records { .. }) {
            let places = faces
                .iter()
                .map(|(f, _)| self.predicted(f.index(), faces.range(f).start));
            *self = Self::Bytes(places.collect());
        }
    }

    /// Keeps the place of face `origins[i]` as that of face `i`, for all faces. Computed places must have
    /// been stored before.
    pub(crate) fn select(&mut self, origins: &[usize]) {
        match self {
            Self::Lines(lines) => *lines = origins.iter().map(|&f| lines[f]).collect(),
            Self::Bytes(bytes) => *bytes = origins.iter().map(|&f| bytes[f]).collect(),
            Self::Records { .. } | Self::Numbers => {}
        }
    }

    fn predicted(&self, face: usize, corners: usize) -> u64 {
        match *self {
            Self::Records {
                first,
                per_face,
                per_corner,
            } => first + face as u64 * per_face + corners as u64 * per_corner,
            _ => 0,
        }
    }
}

/// The lines or bytes of vertices in their file, as runs of vertices at equal distances.
///
/// A file with all vertices one after the other is one run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct VertexPlaces {
    runs: Vec<VertexRun>,
    /// Number of vertices.
    vertices: usize,
    /// Place of the next vertex, if the last run continues.
    expected: u64,
    /// Whether places are bytes, and not lines.
    are_bytes: bool,
}

/// Vertices at equal distances in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct VertexRun {
    /// Number of the first vertex.
    first: usize,
    /// Line or byte of the first vertex.
    start: u64,
    /// Distance from one vertex to the next; 0 if there is only one vertex.
    step: u64,
}

impl VertexPlaces {
    /// Adds the place of the next vertex. Numbered items have no places of their own: they are not
    /// added.
    #[inline]
    pub(crate) fn push(&mut self, place: Place) {
        let at = match place {
            Place::Line(line) => u64::from(line),
            Place::Byte(byte) => byte,
            Place::Item { .. } => return,
        };
        self.are_bytes = matches!(place, Place::Byte(_));
        match self.runs.last_mut() {
            Some(run) if at == self.expected => self.expected += run.step,
            Some(run) if run.step == 0 && at > run.start => {
                run.step = at - run.start;
                self.expected = at + run.step;
            }
            _ => {
                self.runs.push(VertexRun {
                    first: self.vertices,
                    start: at,
                    step: 0,
                });
                self.expected = u64::MAX; // the step is not known yet
            }
        }
        self.vertices += 1;
    }

    /// Returns the place of `vertex`, if it is known; O(log n) for n runs.
    pub(crate) fn place(&self, vertex: VertexId) -> Option<Place> {
        let number = vertex.index();
        if number >= self.vertices {
            return None;
        }
        let run = self.runs.partition_point(|run| run.first <= number) - 1;
        let VertexRun { first, start, step } = self.runs[run];
        let at = start + (number - first) as u64 * step;
        Some(match self.are_bytes {
            true => Place::Byte(at),
            false => Place::Line(u32::try_from(at).ok()?),
        })
    }
}

/// Where the vertices and faces of a mesh are in the file from which the mesh was read.
///
/// [`FileMesh::into_polygons_with_places`](crate::FileMesh::into_polygons_with_places) returns it.
/// It takes four or eight bytes per face, or none if the places can be computed. Vertices take
/// memory only where their distances in the file change.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PolygonPlaces {
    faces: FacePlaces,
    gaps: Gaps,
    vertices: VertexPlaces,
}

impl PolygonPlaces {
    pub(crate) fn new(faces: FacePlaces, gaps: Gaps, vertices: VertexPlaces) -> Self {
        Self {
            faces,
            gaps,
            vertices,
        }
    }

    /// Returns the place of `vertex`: a line or a byte. Returns `None` if the vertex has no place of
    /// its own, as in STL and glTF. O(log n) for n changes of the distance between vertices.
    pub fn vertex_place(&self, vertex: VertexId) -> Option<Place> {
        self.vertices.place(vertex)
    }

    /// Returns the place of `face`, one of the faces of the mesh `polygons`; O(log n) for n faces
    /// that were left out.
    ///
    /// # Panics
    ///
    /// Panics if the mesh has no such face. If `polygons` is another mesh, the place may be wrong.
    pub fn place(&self, face: FaceId, polygons: &PolygonMesh) -> Place {
        let corners_before = polygons.faces().range(face).start;
        let gap = self.gaps.before(face);
        self.faces
            .place_of_number(face.index() + gap.faces, || corners_before + gap.corners)
    }
}

/// The faces that were left out of a mesh, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Gaps(Vec<Gap>);

/// A face that was left out, together with those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Gap {
    /// Number of remaining faces before this face.
    kept: usize,
    /// Number of faces that were left out up to this face.
    faces: usize,
    /// Number of their corners.
    corners: usize,
}

impl Gaps {
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds `face`, which has this number of corners. Faces are added in the order of the file.
    pub(crate) fn push(&mut self, face: FaceId, corners: usize) {
        let last = self.0.last().copied().unwrap_or_default();
        self.0.push(Gap {
            kept: face.index() - last.faces,
            faces: last.faces + 1,
            corners: last.corners + corners,
        });
    }

    /// Returns the last gap before the remaining face `face`. Without such a gap, all numbers are 0.
    fn before(&self, face: FaceId) -> Gap {
        let gaps = self.0.partition_point(|gap| gap.kept <= face.index());
        match gaps {
            0 => Gap::default(),
            gaps => self.0[gaps - 1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use sixfold_core::Point;

    #[test]
    fn regular_records_are_computed_and_others_are_stored() {
        let mut faces = FaceList::default();
        let mut places = FacePlaces::Records {
            first: 100,
            per_face: 1,
            per_corner: 4,
        };
        let mut bytes = Vec::new();
        for (byte, degree) in [(100, 3), (113, 4), (130, 3), (150, 3)] {
            places.push_byte(&faces, byte);
            faces.push((0..degree).map(VertexId::new)).expect("few");
            bytes.push(byte);
            let found = faces.iter().map(|(f, _)| places.place(f, &faces));
            assert!(found.eq(bytes.iter().map(|&byte| Place::Byte(byte))));
            assert_eq!(matches!(places, FacePlaces::Bytes(_)), byte == 150);
        }
    }

    #[test]
    fn vertices_at_equal_distances_are_one_run() {
        let mut places = VertexPlaces::default();
        for line in [3, 4, 5, 6, 10, 12, 14, 14, 2] {
            places.push(Place::Line(line));
        }
        places.push(Place::Item {
            kind: "accessor",
            number: 0,
        });
        assert_eq!(places.runs.len(), 4);
        assert_eq!(places.place(VertexId::new(9)), None);
    }

    proptest! {
        #[test]
        fn places_of_vertices_are_kept(steps in vec((0..3_u64, 1..5_usize), 0..10)) {
            let mut at = 0;
            let mut bytes = Vec::new();
            for (step, count) in steps {
                for _ in 0..count {
                    at += step;
                    bytes.push(at);
                }
            }
            let mut places = VertexPlaces::default();
            for &byte in &bytes {
                places.push(Place::Byte(byte));
            }
            for (v, &byte) in (0..).map(VertexId::new).zip(&bytes) {
                prop_assert_eq!(places.place(v), Some(Place::Byte(byte)));
            }
        }

        #[test]
        fn places_of_remaining_faces_are_those_of_the_file(
            degrees in vec((3..6_u32, any::<bool>()), 0..20),
        ) {
            let (mut all, mut kept) = (FaceList::default(), FaceList::default());
            let mut gaps = Gaps::default();
            let mut remaining = Vec::new();
            for (f, &(degree, is_kept)) in (0..).map(FaceId::new).zip(&degrees) {
                let corners = || (0..degree).map(VertexId::new);
                all.push(corners()).expect("few");
                if is_kept {
                    kept.push(corners()).expect("few");
                    remaining.push(f);
                } else {
                    gaps.push(f, degree as usize);
                }
            }
            let polygons = PolygonMesh::from_faces(vec![Point::ZERO; 6], kept).expect("valid");
            let numbers = 0..u32::try_from(degrees.len()).expect("few");
            for places in [
                FacePlaces::Lines(numbers.clone().map(|n| 7 * n).collect()),
                FacePlaces::Bytes(numbers.map(|n| 9 * u64::from(n)).collect()),
                FacePlaces::Records { first: 100, per_face: 2, per_corner: 5 },
                FacePlaces::Numbers,
            ] {
                let expected = remaining.iter().map(|&f| places.place(f, &all));
                let vertices = VertexPlaces::default();
                let found = PolygonPlaces::new(places.clone(), gaps.clone(), vertices);
                let found = polygons.faces().iter().map(|(f, _)| found.place(f, &polygons));
                prop_assert!(found.eq(expected), "{:?}", places);
            }
        }
    }
}
