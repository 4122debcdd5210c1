//! Local refinement: splits the chosen triangles and the other triangles that must be split to keep
//! the mesh conforming. In a conforming mesh, no vertex lies inside an edge.
//!
//! The algorithm is the red–green refinement of Bank, Sherman & Weiser (1983). A chosen face
//! becomes *red*, which means that the face is split in four. A face with two or three split sides
//! also becomes red, until no more faces change. A face with one split side becomes *green*, which
//! means that the face is split in two halves.
//!
//! ```text
//!    red             green            green that must be split again: its parent becomes red
//!
//!      c                c                       c                         c
//!     / \              /│\                     /│\                       / \
//!    q───p            / │ \                   / │ \          →          q───p
//!   / \ / \          /  │  \                 /  │  \                   / \ / \
//!  a───m───b        a───m───b               a─x─m───b                 a─x─m───b   (a, m, q) is green
//! ```
//!
//! Every face therefore has the shape of a face of the input mesh, or the shape of half of a face
//! of the input mesh. So the angles do not become smaller with each level. New vertices are
//! midpoints of edges; old vertices do not move.

use sixfold_core::{
    EdgeMap, FaceId, FaceList, MAX_ROWS, MeshQuery, Numbers, Point, PolygonError, PolygonMesh,
    Representation, VertexId,
};

use crate::error::LocalError;
use crate::mask::midpoint;
use crate::select::{Selection, triangle};

/// Runs `levels` steps of local refinement. A structure of type `M` is built for each step.
///
/// If the selection is a list of faces, the parts of these faces are chosen at the next level. A
/// box or an angle selects faces again at every level. Each level takes O(faces) time, plus the
/// costs of the queries FE, EF and FV.
///
/// # Errors
///
/// Returns an error in these cases:
///
/// - The selection is invalid.
/// - A face is not a triangle.
/// - An edge is too short to be halved.
/// - There are more faces than a 32-bit handle can number.
/// - `M` cannot hold the mesh.
///
/// # Examples
///
/// ```
/// use sixfold_indexed_face_set::IndexedFaceSet;
/// use sixfold_core::FaceId;
/// use sixfold_subdivision::{Selection, refine_locally};
///
/// // One face is split in four, and its three neighbours in two.
/// let one = Selection::Faces(vec![FaceId::new(0)]);
/// let refined = refine_locally::<IndexedFaceSet>(&sixfold_shapes::octahedron(), &one, 1)?;
/// assert_eq!(refined.polygons().face_count(), 4 + 3 * 2 + 4);
/// # Ok::<(), sixfold_subdivision::LocalError>(())
/// ```
pub fn refine_locally<M: Representation>(
    polygons: &PolygonMesh,
    selection: &Selection,
    levels: u32,
) -> Result<LocalMesh, LocalError> {
    selection.check(polygons.face_count())?;
    let mut local = LocalMesh::new(polygons.clone())?;
    for level in 0..levels {
        let mesh = M::from_polygons(&local.polygons).map_err(|refusal| LocalError::Build {
            structure: M::NAME,
            level,
            refusal,
        })?;
        let chosen = match selection {
            Selection::Faces(_) if level > 0 => local.chosen_parts(),
            _ => selection.faces(&mesh)?,
        };
        if chosen.is_empty() {
            break;
        }
        local = local.refined(&mesh, &chosen)?;
    }
    Ok(local)
}

/// A triangle mesh after local refinement. For each refined face, [`origins`](Self::origins)
/// returns the face of the unrefined mesh that contains the refined face.
///
/// # Invariants
///
/// - L1  Every face is a triangle.
/// - L2  Green faces are the two halves of a split face. The halves of a face (a, b, c) are the
///   consecutive faces (a, m, c) and (m, b, c).
#[derive(Clone, Debug, PartialEq)]
pub struct LocalMesh {
    polygons: PolygonMesh,
    records: Vec<FaceRecord>,
}

/// The origin of a face, and its part in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FaceRecord {
    /// The face of the first mesh that contains this face.
    origin: FaceId,
    half: Option<Half>,
    /// Whether this face is part of a face that was chosen in the last step.
    chosen: bool,
}

/// The position of a face in a green pair.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Half {
    First,
    Second,
}

impl LocalMesh {
    /// Returns `polygons` as a mesh that has not been refined yet.
    ///
    /// # Errors
    ///
    /// Returns [`LocalError::NotATriangle`] for the first face that is not a triangle.
    pub fn new(polygons: PolygonMesh) -> Result<Self, LocalError> {
        let faces = polygons.faces();
        if let Some((face, degree)) = polygons.first_polygon() {
            return Err(LocalError::NotATriangle { face, degree });
        }
        let record = |(origin, _)| FaceRecord {
            origin,
            half: None,
            chosen: false,
        };
        let records = faces.iter().map(record).collect();
        Ok(Self { polygons, records })
    }

    /// Returns the polygons of the refined mesh. The vertices of the mesh before the last step come
    /// first, then the midpoints. The faces that were made from one face are consecutive.
    pub fn polygons(&self) -> &PolygonMesh {
        &self.polygons
    }

    /// Returns, for each face of the refined mesh, the face of the unrefined mesh that contains the
    /// refined face.
    pub fn origins(&self) -> impl ExactSizeIterator<Item = FaceId> {
        self.records.iter().map(|record| record.origin)
    }

    /// Returns true if `f` is green, which means that `f` is half of a split face. A later step
    /// does not split `f`. Instead, the later step joins the two halves and splits the whole face
    /// in four.
    ///
    /// # Panics
    ///
    /// Panics if `f` does not exist.
    pub fn is_green(&self, f: FaceId) -> bool {
        self.records[f.index()].half.is_some()
    }

    /// Returns the faces that are parts of the faces chosen in the last step.
    pub fn chosen_parts(&self) -> Vec<FaceId> {
        let records = (0..).map(FaceId::new).zip(&self.records);
        let chosen = records.filter(|(_, record)| record.chosen);
        chosen.map(|(f, _)| f).collect()
    }

    /// Runs one step: splits the faces in `chosen`, and the other faces that must be split to keep
    /// the mesh conforming. `mesh` is any structure that was built from
    /// [`polygons`](Self::polygons). `chosen` contains face numbers: face i is item i of
    /// `mesh.faces()`, counted from 0. If an edge has more than two faces, the rules apply to all
    /// faces of the edge.
    ///
    /// # Errors
    ///
    /// Returns an error for a face that does not exist, for an edge that is too short to be halved,
    /// or if there are more faces than a 32-bit handle can number.
    ///
    /// # Panics
    ///
    /// Panics if `mesh` and `self` have different numbers of faces.
    pub fn refined<M: MeshQuery>(&self, mesh: &M, chosen: &[FaceId]) -> Result<Self, LocalError> {
        let faces = self.records.len();
        assert_eq!(mesh.face_count(), faces, "the mesh has other polygons");
        Selection::check_faces(chosen, faces)?;
        let mut step = Step::new(self, mesh)?;
        for f in chosen {
            step.chosen[f.index()] = true;
            step.queue.push(f.index());
        }
        step.propagate();
        step.finish()
    }
}

/// A step in progress.
struct Step<'a, M: MeshQuery> {
    before: &'a [FaceRecord],
    mesh: &'a M,
    numbers: Numbers<M::Face>,
    /// Each green face starts at the corner that its other half does not have: (a, m, c) and (b, c,
    /// m).
    faces: Vec<Triangle<M::Vertex, M::Edge>>,
    split: EdgeMap<M, bool>,
    /// For each face: the number of split sides, whether the face becomes red, and whether
    /// the face was chosen.
    split_sides: Vec<u8>,
    red: Vec<bool>,
    chosen: Vec<bool>,
    /// Faces that must become red.
    queue: Vec<usize>,
}

impl<'a, M: MeshQuery> Step<'a, M> {
    fn new(before: &'a LocalMesh, mesh: &'a M) -> Result<Self, LocalError> {
        let count = before.records.len();
        let numbers = mesh.face_numbers();
        let mut faces = Vec::with_capacity(count);
        for (number, &f) in (0..).zip(numbers.handles()) {
            let corners = triangle(mesh, f, FaceId::new(number))?;
            let mut sides = mesh.face_edges(f);
            let sides = [(); 3].map(|()| sides.next().expect("as many sides as corners"));
            faces.push(Triangle { corners, sides });
        }
        for first in 0..count {
            if before.records[first].half == Some(Half::First) {
                let [f, g] = [first, first + 1].map(|half| faces[half]);
                faces[first] = f.rotated_to_apex(g);
                faces[first + 1] = g.rotated_to_apex(f);
            }
        }
        Ok(Self {
            before: &before.records,
            mesh,
            numbers,
            faces,
            split: mesh.edge_map(false),
            split_sides: vec![0; count],
            red: vec![false; count],
            chosen: vec![false; count],
            queue: Vec::new(),
        })
    }

    /// Makes faces red until no other face must be red.
    fn propagate(&mut self) {
        while let Some(f) = self.queue.pop() {
            if self.red[f] {
                continue;
            }
            self.red[f] = true;
            let sides = self.faces[f].sides;
            match self.before[f].half {
                None => sides.into_iter().for_each(|side| self.split(side)),
                // The side of the whole face that is not split: c–a of (a, m, c), b–c of (b, c, m).
                Some(Half::First) => {
                    self.split(sides[2]);
                    self.queue.push(f + 1);
                }
                Some(Half::Second) => {
                    self.split(sides[0]);
                    self.queue.push(f - 1);
                }
            }
        }
    }

    fn split(&mut self, side: M::Edge) {
        if std::mem::replace(&mut self.split[side], true) {
            return;
        }
        for f in self.mesh.edge_faces(side) {
            let f = self.numbers[f] as usize;
            self.split_sides[f] += 1;
            // A half is not split.
            if self.split_sides[f] > 1 || self.before[f].half.is_some() {
                self.queue.push(f);
            }
        }
    }

    fn finish(self) -> Result<LocalMesh, LocalError> {
        let (mesh, limit) = (self.mesh, MAX_ROWS);
        let parts = (0..self.faces.len()).map(|f| self.parts(f));
        if parts.sum::<usize>().saturating_mul(3) > limit {
            let elements = "corners";
            return Err(PolygonError::TooMany { elements, limit }.into());
        }
        let mut new_ids = mesh.vertex_map(VertexId::new(0));
        let mut points: Vec<Point> = Vec::with_capacity(mesh.vertex_count());
        for v in mesh.vertices() {
            new_ids[v] = VertexId::new(sixfold_core::row(points.len()));
            points.push(mesh.position(v));
        }
        let mut middles = mesh.edge_map(None);
        for e in mesh.edges().filter(|&e| self.split[e]) {
            let ends = mesh.edge_vertices(e);
            let [a, b] = ends.map(|v| mesh.position(v));
            let middle = midpoint([a, b]);
            if a != b && (middle == a || middle == b) {
                let ends = ends.map(|v| new_ids[v]);
                return Err(LocalError::TooShort { ends });
            }
            middles[e] = Some(VertexId::new(sixfold_core::row(points.len())));
            points.push(middle);
        }
        let mut parts = Parts::default();
        for (f, &Triangle { corners, sides }) in self.faces.iter().enumerate() {
            let corners = corners.map(|v| new_ids[v]);
            let middles_of = |sides: [M::Edge; 3]| sides.map(|side| middles[side]);
            let record = FaceRecord {
                half: None,
                chosen: self.chosen[f],
                ..self.before[f]
            };
            match self.before[f].half {
                None => parts.split(record, corners, middles_of(sides))?,
                Some(half) if !self.red[f] => {
                    let half = Some(half);
                    parts.push(FaceRecord { half, ..record }, corners)?;
                }
                Some(Half::First) => {
                    let record = FaceRecord {
                        chosen: record.chosen || self.chosen[f + 1],
                        ..record
                    };
                    let other = self.faces[f + 1];
                    let halves = [corners, other.corners.map(|v| new_ids[v])];
                    parts.split_pair(record, halves, [sides, other.sides].map(middles_of))?;
                }
                // Handled with the first half.
                Some(Half::Second) => {}
            }
        }
        let polygons = PolygonMesh::from_faces(points, parts.faces)?;
        let records = parts.records;
        Ok(LocalMesh { polygons, records })
    }

    /// Returns the number of new faces in the area of face `f`.
    fn parts(&self, f: usize) -> usize {
        let is_red = self.red[f];
        match self.before[f].half {
            Some(_) if is_red => 1 + usize::from(self.split_sides[f]),
            Some(_) => 1,
            None if is_red => 4,
            None => 1 + usize::from(self.split_sides[f]),
        }
    }
}

/// A face: its corners, and the sides that start at these corners.
#[derive(Clone, Copy)]
struct Triangle<V, E> {
    corners: [V; 3],
    sides: [E; 3],
}

impl<V: Copy + Eq, E: Copy> Triangle<V, E> {
    /// Returns the same face, starting at the corner that `other` does not have.
    fn rotated_to_apex(self, other: Self) -> Self {
        let is_apex = |v: &V| !other.corners.contains(v);
        let from = self.corners.iter().position(is_apex);
        let from = from.expect("L2: the halves of a face share two corners");
        let turn = |i: usize| (from + i) % 3;
        Self {
            corners: [0, 1, 2].map(|i| self.corners[turn(i)]),
            sides: [0, 1, 2].map(|i| self.sides[turn(i)]),
        }
    }
}

/// The new faces.
#[derive(Default)]
struct Parts {
    faces: FaceList,
    records: Vec<FaceRecord>,
}

impl Parts {
    fn push(&mut self, record: FaceRecord, corners: [VertexId; 3]) -> Result<(), PolygonError> {
        self.records.push(record);
        self.faces.push(corners)
    }

    /// Adds the parts of a face. `middles` contains the middles of the split sides. No side, one
    /// side or all three sides are split.
    fn split(
        &mut self,
        record: FaceRecord,
        corners: [VertexId; 3],
        middles: [Option<VertexId>; 3],
    ) -> Result<(), PolygonError> {
        let [a, b, c] = corners;
        match middles {
            [Some(m), Some(p), Some(q)] => {
                for part in [[a, m, q], [m, b, p], [q, p, c], [m, p, q]] {
                    self.push(record, part)?;
                }
                Ok(())
            }
            [Some(m), None, None] => self.halve(record, [a, b, c], m),
            [None, Some(m), None] => self.halve(record, [b, c, a], m),
            [None, None, Some(m)] => self.halve(record, [c, a, b], m),
            _ => {
                debug_assert_eq!(middles, [None; 3], "two split sides make a face red");
                self.push(record, corners)
            }
        }
    }

    /// Adds the two halves of a face whose first side has the middle `m`.
    fn halve(
        &mut self,
        record: FaceRecord,
        [a, b, c]: [VertexId; 3],
        m: VertexId,
    ) -> Result<(), PolygonError> {
        let half = |half| FaceRecord {
            half: Some(half),
            ..record
        };
        self.push(half(Half::First), [a, m, c])?;
        self.push(half(Half::Second), [m, b, c])
    }

    /// Joins the two halves (a, m, c) and (b, c, m), and splits the whole face in four. The part at
    /// a is halved if a–m is split. The part at b is halved if m–b is split.
    fn split_pair(
        &mut self,
        record: FaceRecord,
        [[a, m, c], [b, ..]]: [[VertexId; 3]; 2],
        [[near, _, q], [p, _, far]]: [[Option<VertexId>; 3]; 2],
    ) -> Result<(), PolygonError> {
        let (Some(p), Some(q)) = (p, q) else {
            unreachable!("a red face has all its sides split");
        };
        self.split(record, [a, m, q], [near, None, None])?;
        self.split(record, [m, b, p], [far, None, None])?;
        self.push(record, [q, p, c])?;
        self.push(record, [m, p, q])
    }
}
