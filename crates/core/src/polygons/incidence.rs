//! The faces that run along each edge, for any list of faces.

use crate::handles::row_id::{FaceId, VertexId, row};
use crate::polygons::face_list::FaceList;

/// One side of one face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    /// The face that has the side.
    pub face: FaceId,
    /// The corner at which the side starts, numbered over all faces.
    pub corner: u32,
    /// Whether the side runs from the higher end to the lower end.
    pub downward: bool,
}

/// A side in the table of its lower end. The order is that of the edges, then of the faces.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct StoredSide {
    /// The higher end.
    high: VertexId,
    /// The corner at which the side starts, numbered over all faces.
    corner: u32,
}

/// An edge and the sides along it.
#[derive(Clone, Copy)]
pub struct EdgeSides<'a> {
    /// The two ends, the lower first.
    pub ends: [VertexId; 2],
    stored: &'a [StoredSide],
    incidence: &'a Incidence<'a>,
}

impl<'a> EdgeSides<'a> {
    /// Returns the number of sides; at least one.
    #[expect(clippy::len_without_is_empty, reason = "an edge has a side")]
    pub fn len(&self) -> usize {
        self.stored.len()
    }

    /// Returns the sides, in the order of the faces.
    pub fn sides(&self) -> impl ExactSizeIterator<Item = Side> + Clone + use<'a> {
        let incidence = self.incidence;
        self.stored.iter().map(|&side| incidence.side(side))
    }

    /// Returns the side of the first face.
    pub fn first(&self) -> Side {
        self.incidence.side(self.stored[0])
    }

    /// Returns the side if the edge has exactly one side.
    pub fn single(&self) -> Option<Side> {
        match *self.stored {
            [side] => Some(self.incidence.side(side)),
            _ => None,
        }
    }

    /// Returns the two sides if the edge has exactly two sides.
    pub fn pair(&self) -> Option<[Side; 2]> {
        match *self.stored {
            [first, second] => Some([first, second].map(|side| self.incidence.side(side))),
            _ => None,
        }
    }

    /// Returns the number of sides that run from the higher end to the lower end.
    pub fn downward(&self) -> usize {
        let stored = self.stored.iter();
        stored
            .filter(|side| self.incidence.is_downward(side.corner))
            .count()
    }
}

/// An edge, the number of its faces, and whether the faces run along the edge in opposite
/// directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeUse {
    /// The two ends, the lower first.
    pub ends: [VertexId; 2],
    /// The number of faces along the edge.
    pub faces: usize,
    /// True if at most one face runs along the edge in each of the two directions.
    pub opposed: bool,
}

impl EdgeUse {
    pub(crate) fn from_sides(edge: EdgeSides<'_>) -> Self {
        let (faces, down) = (edge.len(), edge.downward());
        Self {
            ends: edge.ends,
            faces,
            opposed: down <= 1 && faces - down <= 1,
        }
    }

    /// Returns whether the edge has exactly one face.
    pub fn is_boundary(&self) -> bool {
        self.faces == 1
    }

    /// Returns whether the edge has one face, or two faces that run along the edge in opposite
    /// directions.
    pub fn is_manifold(&self) -> bool {
        self.opposed
    }
}

/// The sides of all faces by edge.
///
/// The tables take 8 bytes and one bit per corner, and 4 bytes per vertex. If the degrees of the
/// faces differ, the tables take 4 more bytes per corner. Building takes O(corners + vertices)
/// time, plus O(n log n) time for each vertex that is the lower end of n sides.
pub struct Incidence<'a> {
    faces: &'a FaceList,
    /// The sides of the edges, by their lower ends.
    sides: Vec<StoredSide>,
    /// By vertex: the end of the sides that are stored under this vertex.
    ends: Vec<u32>,
    /// By corner, 64 to a word: whether the side that starts there runs from the higher end to the
    /// lower end.
    downward: Vec<u64>,
    face_of_corner: FaceOfCorner,
}

/// The face of each corner.
enum FaceOfCorner {
    Triangles,
    /// All faces have this degree.
    Uniform(u32),
    Mixed(Vec<FaceId>),
}

impl<'a> Incidence<'a> {
    /// Collects the sides of the faces that `used` selects. These faces must name each vertex at
    /// most once.
    ///
    /// # Panics
    ///
    /// Panics if the lower end of a side is not below `vertices`.
    pub fn new(vertices: usize, faces: &'a FaceList, used: impl Fn(FaceId) -> bool) -> Self {
        let sides = || {
            let used = faces.iter().filter(|&(f, _)| used(f));
            used.flat_map(|(face, corners)| sides_of(corners, faces.range(face).start))
        };
        let mut ends = vec![0_u32; vertices];
        let mut downward = vec![0_u64; faces.corners().len().div_ceil(64)];
        for (low, side, is_downward) in sides() {
            ends[low.index()] += 1;
            downward[side.corner as usize / 64] |= u64::from(is_downward) << (side.corner % 64);
        }
        let mut total = 0;
        for end in &mut ends {
            total += std::mem::replace(end, total);
        }
        let blank = StoredSide {
            high: VertexId::new(0),
            corner: 0,
        };
        let mut sorted = vec![blank; total as usize];
        for (low, side, _) in sides() {
            let at = &mut ends[low.index()];
            sorted[*at as usize] = side;
            *at += 1;
        }
        sort_by_edge(&mut sorted, 0, &ends);
        Self {
            faces,
            sides: sorted,
            ends,
            downward,
            face_of_corner: FaceOfCorner::new(faces),
        }
    }

    /// Returns the list of faces from which the incidence was built.
    pub fn faces(&self) -> &'a FaceList {
        self.faces
    }

    /// Returns the number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.ends.len()
    }

    /// Returns every edge, ordered by the lower end, then by the higher end.
    pub fn edges(&self) -> impl Iterator<Item = EdgeSides<'_>> {
        let starts = std::iter::once(0).chain(self.ends.iter().map(|&end| end as usize));
        let buckets = starts.zip(&self.ends).zip(0..);
        buckets.flat_map(move |((start, &end), low)| {
            let by_high = self.sides[start..end as usize].chunk_by(|a, b| a.high == b.high);
            by_high.map(move |stored| EdgeSides {
                ends: [VertexId::new(low), stored[0].high],
                stored,
                incidence: self,
            })
        })
    }

    /// Returns the corners of a side: the corner at its lower end, then the corner at its higher
    /// end.
    pub(crate) fn corners_at_ends(&self, side: Side) -> [usize; 2] {
        let range = self.faces.range(side.face);
        let start = side.corner as usize;
        let end = if start + 1 == range.end {
            range.start
        } else {
            start + 1
        };
        if side.downward {
            [end, start]
        } else {
            [start, end]
        }
    }

    /// Returns the face of a corner.
    #[inline]
    pub(crate) fn face_of(&self, corner: u32) -> FaceId {
        match &self.face_of_corner {
            FaceOfCorner::Triangles => FaceId::new(corner / 3),
            FaceOfCorner::Uniform(degree) => FaceId::new(corner / degree),
            FaceOfCorner::Mixed(faces) => faces[corner as usize],
        }
    }

    #[inline]
    fn side(&self, StoredSide { corner, .. }: StoredSide) -> Side {
        Side {
            face: self.face_of(corner),
            corner,
            downward: self.is_downward(corner),
        }
    }

    #[inline]
    fn is_downward(&self, corner: u32) -> bool {
        self.downward[corner as usize / 64] >> (corner % 64) & 1 == 1
    }
}

impl FaceOfCorner {
    fn new(faces: &FaceList) -> Self {
        match faces.uniform_degree() {
            Some(3) => Self::Triangles,
            Some(degree) => Self::Uniform(row(degree)),
            None => {
                let by_corner = faces
                    .iter()
                    .flat_map(|(f, corners)| corners.iter().map(move |_| f));
                Self::Mixed(by_corner.collect())
            }
        }
    }
}

/// Minimum number of vertices whose sides are sorted on two threads.
#[cfg(feature = "rayon")]
const MIN_PARALLEL: usize = 1 << 14;

/// Sorts the sides of each vertex. `first` is the number of the first side, and `ends` has the end of
/// the sides of each vertex.
fn sort_by_edge(sides: &mut [StoredSide], first: u32, ends: &[u32]) {
    #[cfg(feature = "rayon")]
    if ends.len() >= MIN_PARALLEL {
        let (low, high) = ends.split_at(ends.len() / 2);
        let middle = low[low.len() - 1];
        let (left, right) = sides.split_at_mut((middle - first) as usize);
        rayon::join(
            || sort_by_edge(left, first, low),
            || sort_by_edge(right, middle, high),
        );
        return;
    }
    let mut start = 0;
    for &end in ends {
        let end = (end - first) as usize;
        sides[start..end].sort_unstable();
        start = end;
    }
}

/// Returns the sides of a face, each with its lower end and whether it runs down to this end.
fn sides_of(
    corners: &[VertexId],
    first: usize,
) -> impl Iterator<Item = (VertexId, StoredSide, bool)> {
    let next = corners.iter().cycle().skip(1);
    let corner_numbers = (row(first))..;
    let sides = corners.iter().zip(next).zip(corner_numbers);
    sides.map(move |((&a, &b), corner)| {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        (low, StoredSide { high, corner }, b < a)
    })
}
