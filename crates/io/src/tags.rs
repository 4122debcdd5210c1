//! Sharpness from the tags of an OBJ file.

use std::fmt;

use sixfold_core::{CreaseError, Creases, FaceList, MAX_ROWS, Pair, VertexId, row};

use crate::excerpt::shortened;
use crate::face_rules::repeated_vertex;
use crate::faults::TagFault;
use crate::file_mesh::ShortFace;
use crate::sharpness::sharpness;

/// One edge of a `t crease` tag. A tag can have several edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreaseTag {
    /// Line of the tag, counted from 1.
    pub line: u32,
    /// Ends of the edge, in the order of the tag. The numbers count from 0.
    pub ends: [VertexId; 2],
    /// Sharpness: 0 or greater, or infinity.
    pub sharpness: f32,
}

/// One vertex of a `t corner` tag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CornerTag {
    /// Line of the tag, counted from 1.
    pub line: u32,
    /// The sharp vertex. The number counts from 0.
    pub vertex: VertexId,
    /// Sharpness: 0 or greater, or infinity.
    pub sharpness: f32,
}

/// A crease whose edge belongs only to faces that are left out, printed for example as `line 40:
/// crease 3 7 is ignored, because all faces along it are left out`. Vertex numbers count from 0, as
/// in the tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnusedCrease {
    /// Line of the tag, counted from 1.
    pub line: u32,
    /// Ends of the edge.
    pub ends: [VertexId; 2],
}

impl fmt::Display for UnusedCrease {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = self.ends.map(VertexId::index);
        let line = self.line;
        write!(
            f,
            "line {line}: crease {a} {b} is ignored, because all faces along it are left out"
        )
    }
}

/// A kind of tag that sets sharpness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tag {
    /// Sharp edges.
    Crease,
    /// Sharp vertices.
    Corner,
}

impl Tag {
    /// Returns the tag with this name, or `None` for another name.
    pub(crate) fn from_name(name: &[u8]) -> Option<Self> {
        match name {
            b"crease" => Some(Self::Crease),
            b"corner" => Some(Self::Corner),
            _ => None,
        }
    }

    pub(crate) const fn example(self) -> &'static str {
        match self {
            Self::Crease => "2/1/0 0 1 2.5",
            Self::Corner => "1/1/0 0 2.5",
        }
    }

    pub(crate) const fn rule(self) -> &'static str {
        match self {
            Self::Crease => "n vertices in a row need 1 or n - 1 sharpness values",
            Self::Corner => "n vertices need 1 or n sharpness values",
        }
    }
}

impl fmt::Display for Tag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Crease => "crease",
            Self::Corner => "corner",
        })
    }
}

/// The sharpness tags of a file.
///
/// The format `t name counts values` comes from OpenSubdiv:
///
/// ```text
/// t crease 4/3/0 7 2 5 9 1 0.5 inf       7 ─1─ 2 ─0.5─ 5 ─inf─ 9
///          │ │ └ no words
///          │ └── one sharpness for all edges, or one for each
///          └──── vertices that follow each other, counted from 0
/// ```
#[derive(Default)]
pub(crate) struct Tags {
    pub(crate) creases: Vec<CreaseTag>,
    pub(crate) corners: Vec<CornerTag>,
}

impl Tags {
    pub(crate) fn len(&self) -> usize {
        self.creases.len() + self.corners.len()
    }

    /// Returns the line of each sharpness that a later one of the same edge or vertex replaces by another
    /// value, ascending. O(n log n).
    pub(crate) fn replaced(&self) -> Vec<u32> {
        let edges = self.creases.iter();
        let edges = edges.map(|tag| (Pair::new(tag.ends[0], tag.ends[1]), tag.sharpness, tag.line));
        let vertices = self.corners.iter();
        let vertices =
            vertices.map(|tag| (Pair::new(tag.vertex, tag.vertex), tag.sharpness, tag.line));
        // An edge has two ends, so none is equal to a vertex.
        let mut all: Vec<(Pair<VertexId>, f32, u32)> = edges.chain(vertices).collect();
        all.sort_by_key(|&(place, ..)| place);
        let replaced = all.windows(2).filter_map(|pair| match *pair {
            [(place, sharpness, line), (next, later, _)] => {
                (place == next && sharpness != later).then_some(line)
            }
            _ => None,
        });
        let mut lines: Vec<u32> = replaced.collect();
        lines.sort_unstable();
        lines
    }

    /// Parses the text after the name of a tag.
    pub(crate) fn read(&mut self, tag: Tag, values: &str, line: u32) -> Result<(), TagFault> {
        let mut words = values.split_whitespace();
        let counts = words.next().unwrap_or("");
        let of_counts = || TagFault::Counts {
            tag,
            text: shortened(counts),
        };
        let [vertices, sharpnesses, other] = parse_counts(counts).ok_or_else(of_counts)?;
        let required = vertices
            .checked_add(sharpnesses)
            .and_then(|sum| sum.checked_add(other))
            .ok_or_else(of_counts)?;
        let words: Vec<&str> = words.collect();
        if words.len() != required {
            let found = words.len();
            return Err(TagFault::Length {
                tag,
                required,
                found,
            });
        }
        let count = match tag {
            Tag::Crease => vertices.saturating_sub(1),
            Tag::Corner => vertices,
        };
        if other > 0 || count == 0 || (sharpnesses != 1 && sharpnesses != count) {
            let counts = shortened(counts);
            return Err(TagFault::Shape { tag, counts });
        }
        let (vertices, values) = words.split_at(vertices);
        let vertices = vertices.iter().map(|word| parse_vertex(tag, word));
        let vertices = vertices.collect::<Result<Vec<VertexId>, TagFault>>()?;
        let values = values.iter().map(|word| {
            sharpness(word).ok_or_else(|| TagFault::Sharpness {
                tag,
                text: shortened(word),
            })
        });
        let values = values.collect::<Result<Vec<f32>, TagFault>>()?;
        let values = values.into_iter().cycle();
        match tag {
            Tag::Crease => {
                let edges = vertices.windows(2).zip(values);
                self.creases
                    .extend(edges.map(|(ends, sharpness)| CreaseTag {
                        line,
                        ends: [ends[0], ends[1]],
                        sharpness,
                    }));
            }
            Tag::Corner => {
                let corners = vertices.into_iter().zip(values);
                self.corners
                    .extend(corners.map(|(vertex, sharpness)| CornerTag {
                        line,
                        vertex,
                        sharpness,
                    }));
            }
        }
        Ok(())
    }

    /// Returns the first tag with a missing vertex or edge, and the line of the tag. O(corners ·
    /// log tags), or O(1) without tags.
    pub(crate) fn check(
        &self,
        vertices: usize,
        faces: &FaceList,
        short_faces: &[ShortFace],
    ) -> Result<(), (u32, TagFault)> {
        let missing = |entry, v: VertexId| {
            (v.index() >= vertices).then(|| CreaseError::MissingVertex {
                entry,
                vertex: row(v.index()),
                vertices,
            })
        };
        let all_faces = faces.iter().map(|(_, face)| face);
        let all_faces = all_faces.chain(short_faces.iter().map(|face| face.corners.as_slice()));
        let are_sides = are_sides(&self.creases, all_faces);
        let edges = self.creases.iter().zip(are_sides).enumerate();
        let mut edges = edges.filter_map(|(entry, (tag, is_side))| {
            let ends = tag.ends;
            let no_edge = || (!is_side).then_some(CreaseError::NotAnEdge { entry, ends });
            let cause = missing(entry, ends[0]).or_else(|| missing(entry, ends[1]));
            Some((tag.line, Tag::Crease, cause.or_else(no_edge)?))
        });
        let corners = self.corners.iter().enumerate();
        let mut corners = corners
            .filter_map(|(entry, tag)| Some((tag.line, Tag::Corner, missing(entry, tag.vertex)?)));
        let faults = edges.next().into_iter().chain(corners.next());
        match faults.min_by_key(|&(line, ..)| line) {
            Some((line, tag, cause)) => Err((line, TagFault::Mesh { tag, cause })),
            None => Ok(()),
        }
    }
}

/// Returns the creases on faces that are valid polygons, and the creases that are only on other
/// faces.
pub(crate) fn creases_on_polygons(
    creases: &[CreaseTag],
    corners: &[CornerTag],
    faces: &FaceList,
) -> (Creases, Vec<UnusedCrease>) {
    let polygons = faces.iter().map(|(_, face)| face);
    let kept = are_sides(
        creases,
        polygons.filter(|face| repeated_vertex(face).is_none()),
    );
    let mut edges = Vec::new();
    let mut unused = Vec::new();
    for (tag, kept) in creases.iter().zip(kept) {
        let CreaseTag { line, ends, .. } = *tag;
        if kept {
            edges.push((Pair::new(ends[0], ends[1]), tag.sharpness));
        } else {
            unused.push(UnusedCrease { line, ends });
        }
    }
    let corners = corners.iter().map(|tag| (tag.vertex, tag.sharpness));
    (Creases::from_entries(edges, corners.collect()), unused)
}

/// Returns for each tag whether its edge is a side of one of `faces`. O(corners · log tags).
fn are_sides<'a>(tags: &[CreaseTag], faces: impl Iterator<Item = &'a [VertexId]>) -> Vec<bool> {
    let pair = |tag: &CreaseTag| Pair::new(tag.ends[0], tag.ends[1]);
    let mut edges: Vec<Pair<VertexId>> = tags.iter().map(pair).collect();
    // If a face has the same vertex twice in a row, the side between them is not an edge.
    edges.retain(|pair| pair.ends()[0] != pair.ends()[1]);
    edges.sort_unstable();
    edges.dedup();
    let mut found = vec![false; edges.len()];
    if !edges.is_empty() {
        for face in faces {
            for side in Pair::sides(face.len(), |i| face[i]) {
                if let Ok(at) = edges.binary_search(&side) {
                    found[at] = true;
                }
            }
        }
    }
    let index = |tag| edges.binary_search(&pair(tag));
    tags.iter()
        .map(|tag| index(tag).is_ok_and(|at| found[at]))
        .collect()
}

/// Parses three counts such as `2/1/0`.
fn parse_counts(counts: &str) -> Option<[usize; 3]> {
    let mut numbers = counts.split('/').map(|number| number.parse().ok());
    let counts = [numbers.next()??, numbers.next()??, numbers.next()??];
    numbers.next().is_none().then_some(counts)
}

fn parse_vertex(tag: Tag, word: &str) -> Result<VertexId, TagFault> {
    let number = word.parse().ok();
    let number = number.filter(|&number: &u32| (number as usize) < MAX_ROWS);
    number.map(VertexId::new).ok_or_else(|| TagFault::Vertex {
        tag,
        text: shortened(word),
    })
}
