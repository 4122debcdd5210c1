//! The faces that run along each edge, for any list of faces.

use crate::face_list::FaceList;
use crate::partition::Partition;
use crate::row_id::{FaceId, VertexId, row};

/// One side of one face, stored under its lower end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The higher end.
    pub high: VertexId,
    /// The face that has the side.
    pub face: FaceId,
    /// The corner at which the side starts, numbered over all faces.
    pub corner: u32,
    /// Whether the side runs from the higher end to the lower end.
    pub downward: bool,
}

/// An edge and the sides along it, in the order of the faces.
#[derive(Clone, Copy, Debug)]
pub struct EdgeSides<'a> {
    /// The two ends, the lower first.
    pub ends: [VertexId; 2],
    /// The sides along the edge; at least one.
    pub sides: &'a [Side],
}

/// An edge, the number of its faces, and whether the faces run along the edge in different
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
        let faces = edge.sides.len();
        let down = edge.sides.iter().filter(|side| side.downward).count();
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

/// The sides of all faces by edge; built in O(corners), plus O(n log n) for the n sides of each
/// vertex.
pub struct Incidence {
    sides: Vec<Side>,
    /// By vertex: the end of the sides that are stored under this vertex.
    ends: Vec<u32>,
}

impl Incidence {
    /// Collects the sides of the faces that `used` selects. These faces must name each vertex at
    /// most once.
    ///
    /// # Panics
    ///
    /// Panics if such a face names a vertex that is not below `vertices`.
    pub fn new(vertices: usize, faces: &FaceList, used: impl Fn(FaceId) -> bool) -> Self {
        let sides = || {
            let used = faces.iter().filter(|&(f, _)| used(f));
            used.flat_map(|(face, corners)| sides_of(face, corners, faces.range(face).start))
        };
        let mut ends = vec![0_u32; vertices];
        for (low, _) in sides() {
            ends[low.index()] += 1;
        }
        let mut total = 0;
        for end in &mut ends {
            total += std::mem::replace(end, total);
        }
        let blank = Side {
            high: VertexId::new(0),
            face: FaceId::new(0),
            corner: 0,
            downward: false,
        };
        let mut sorted = vec![blank; total as usize];
        for (low, side) in sides() {
            let at = &mut ends[low.index()];
            sorted[*at as usize] = side;
            *at += 1;
        }
        let mut start = 0;
        for &end in &ends {
            sorted[start..end as usize].sort_unstable();
            start = end as usize;
        }
        Self {
            sides: sorted,
            ends,
        }
    }

    /// Returns every edge, ordered by the lower end, then by the higher end.
    pub fn edges(&self) -> impl Iterator<Item = EdgeSides<'_>> {
        let starts = std::iter::once(0).chain(self.ends.iter().map(|&end| end as usize));
        let buckets = starts.zip(&self.ends).zip(0..);
        buckets.flat_map(|((start, &end), low)| {
            let by_high = self.sides[start..end as usize].chunk_by(|a, b| a.high == b.high);
            by_high.map(move |sides| EdgeSides {
                ends: [VertexId::new(low), sides[0].high],
                sides,
            })
        })
    }

    /// Returns the fans of all vertices as classes of corners. Two corners of a vertex are in the
    /// same fan if their faces share an edge at the vertex.
    pub(crate) fn fans(&self, faces: &FaceList) -> Partition {
        let mut fans = Partition::new(faces.corners().len());
        for edge in self.edges() {
            let (first, others) = edge.sides.split_first().expect("an edge has a side");
            let first = corners_at_ends(first, faces);
            for side in others {
                let corners = corners_at_ends(side, faces);
                fans.join(first[0], corners[0]);
                fans.join(first[1], corners[1]);
            }
        }
        fans
    }

    /// Returns the vertices whose faces form more than one fan. Each vertex has two faces: the
    /// first face of its first fan, and the first face of another fan. The vertices are in the
    /// order of the second faces.
    pub fn several_fans(&self, faces: &FaceList) -> Vec<(VertexId, [FaceId; 2])> {
        let mut fans = self.fans(faces);
        // By vertex: its first face, the fan of that face, and whether another fan was found.
        let mut first: Vec<Option<(FaceId, usize, bool)>> = vec![None; self.ends.len()];
        let mut found = Vec::new();
        for (f, face) in faces.iter() {
            for (corner, &v) in faces.range(f).zip(face) {
                let (fan, _) = fans.root(corner);
                let known = first[v.index()].get_or_insert((f, fan, false));
                if known.1 != fan && !known.2 {
                    known.2 = true;
                    found.push((v, [known.0, f]));
                }
            }
        }
        found
    }
}

/// Returns the corners of a side: the corner at its lower end, then the corner at its higher end.
pub(crate) fn corners_at_ends(side: &Side, faces: &FaceList) -> [usize; 2] {
    let range = faces.range(side.face);
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

fn sides_of(
    face: FaceId,
    corners: &[VertexId],
    first: usize,
) -> impl Iterator<Item = (VertexId, Side)> {
    let next = corners.iter().cycle().skip(1);
    let corner_numbers = (row(first))..;
    corners
        .iter()
        .zip(next)
        .zip(corner_numbers)
        .map(move |((&a, &b), corner)| {
            let (low, high, downward) = if a < b { (a, b, false) } else { (b, a, true) };
            (
                low,
                Side {
                    high,
                    face,
                    corner,
                    downward,
                },
            )
        })
}
