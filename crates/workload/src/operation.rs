//! The operations of a study: what each is called, asks and counts.

use std::fmt;
use std::str::FromStr;

use serde_with::{DeserializeFromStr, SerializeDisplay};
use sixfold::subdivision::{Method, Scheme};
use sixfold::{PolygonMesh, QueryCost, Relation};

use crate::editing::Editing;
use crate::refining::{Refining, Way};
use crate::unknown::unknown;

/// One kind of element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Vertices.
    Vertex,
    /// Edges.
    Edge,
    /// Faces.
    Face,
}

impl Kind {
    /// All three, in the order in which [`Kind::index`] counts them.
    pub const ALL: [Self; 3] = [Self::Vertex, Self::Edge, Self::Face];

    /// Its place in [`Kind::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The kind of element that `relation` is asked of.
    pub const fn asked(relation: Relation) -> Self {
        Self::ALL[relation as usize / 3]
    }

    /// What one is called: `vertex`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Edge => "edge",
            Self::Face => "face",
        }
    }
}

/// Something that a study times.
///
/// Each visits its elements in the order of the structure, and every handle it comes upon goes into
/// a sink, so that no structure can count elements without naming them.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, DeserializeFromStr, SerializeDisplay,
)]
pub enum Operation {
    /// Flat arrays to the structure.
    Build,
    /// Every element of a kind asked one relation.
    Relation(Relation),
    /// The incident faces of every vertex and the vertices of every face.
    Circulate,
    /// The mean of each face's vertices, stored.
    FaceBarycenter,
    /// Face normals stored; then for each vertex the normalised sum over its faces, stored.
    VertexNormal,
    /// For each vertex the mean of its neighbours, stored and then swapped in.
    VvSmooth,
    /// The sum of all edge lengths.
    EdgeLength,
    /// The number of edges with one face.
    Boundary,
    /// Breadth-first over faces from face 0, then from the lowest unseen; the sum of the depths.
    FfBfs,
    /// Every element asked its three relations.
    AllQueries,
    /// One step of Catmull–Clark by one method; its scheme and way are [`Operation::refining`].
    CatmullClark(Method),
    /// One step of Loop by one method.
    Loop(Method),
    /// A workload that changes the mesh, on a fresh copy each time.
    Editing(Editing),
}

const RELATIONS: &[Relation; 9] = &Relation::ALL;
/// What a step of Catmull–Clark asks of a vertex, and any step of a face.
const AROUND_VERTEX: &[Relation] = &[Relation::VertexVertices, Relation::VertexFaces];
const AROUND_EDGE: &[Relation] = &[Relation::EdgeVertices, Relation::EdgeFaces];
const AROUND_FACE: &[Relation] = &[Relation::FaceVertices, Relation::FaceEdges];

impl Operation {
    /// All of them, in the order in which tables show them.
    pub const ALL: [Self; 28] = [
        Self::Build,
        Self::Relation(Relation::VertexVertices),
        Self::Relation(Relation::VertexEdges),
        Self::Relation(Relation::VertexFaces),
        Self::Relation(Relation::EdgeVertices),
        Self::Relation(Relation::EdgeEdges),
        Self::Relation(Relation::EdgeFaces),
        Self::Relation(Relation::FaceVertices),
        Self::Relation(Relation::FaceEdges),
        Self::Relation(Relation::FaceFaces),
        Self::Circulate,
        Self::FaceBarycenter,
        Self::VertexNormal,
        Self::VvSmooth,
        Self::EdgeLength,
        Self::Boundary,
        Self::FfBfs,
        Self::AllQueries,
        Self::CatmullClark(Method::Gather),
        Self::CatmullClark(Method::Scatter),
        Self::CatmullClark(Method::Native),
        Self::Loop(Method::Gather),
        Self::Loop(Method::Scatter),
        Self::Loop(Method::Native),
        Self::Editing(Editing::SplitCollapse),
        Self::Editing(Editing::FlipAll),
        Self::Editing(Editing::DecimateHalf),
        Self::Editing(Editing::DecimateTenth),
    ];

    /// What users call it: `vv_smooth`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Build => "build",
            Self::Relation(relation) => relation.name(),
            Self::Circulate => "circulate",
            Self::FaceBarycenter => "face_barycenter",
            Self::VertexNormal => "vertex_normal",
            Self::VvSmooth => "vv_smooth",
            Self::EdgeLength => "edge_length",
            Self::Boundary => "boundary",
            Self::FfBfs => "ff_bfs",
            Self::AllQueries => "all_queries",
            Self::CatmullClark(Method::Gather) => "catmull_clark_gather",
            Self::CatmullClark(Method::Scatter) => "catmull_clark_scatter",
            Self::CatmullClark(Method::Native) => "catmull_clark_native",
            Self::Loop(Method::Gather) => "loop_gather",
            Self::Loop(Method::Scatter) => "loop_scatter",
            Self::Loop(Method::Native) => "loop_native",
            Self::Editing(editing) => editing.name(),
        }
    }

    /// The subdivision that it is, if it is one: a single step.
    pub fn refining(self) -> Option<Refining> {
        let (scheme, method) = match self {
            Self::CatmullClark(method) => (Scheme::CatmullClark, method),
            Self::Loop(method) => (Scheme::Loop, method),
            _ => return None,
        };
        let way = match method {
            Method::Gather => Way::Gather,
            Method::Scatter => Way::Scatter,
            Method::Native => Way::Native,
        };
        Some(Refining::new(scheme, way, 1))
    }

    /// Whether it is a subdivision.
    pub const fn subdivides(self) -> bool {
        matches!(self, Self::CatmullClark(_) | Self::Loop(_))
    }

    /// Whether it makes another mesh, by subdivision or by edits, rather than ask one: it is long, and
    /// a patch of the mesh tells what it takes.
    pub const fn makes_a_mesh(self) -> bool {
        self.subdivides() || matches!(self, Self::Editing(_))
    }

    /// Whether a run makes tables larger that the next run uses again: its first run takes longer.
    pub const fn grows_tables(self) -> bool {
        matches!(
            self,
            Self::CatmullClark(Method::Native)
                | Self::Loop(Method::Native)
                | Self::Editing(Editing::SplitCollapse | Editing::FlipAll)
        )
    }

    /// Whether the clock stops between its runs: what they changed is put back, or what they made dropped.
    pub const fn stops_the_clock(self) -> bool {
        matches!(self, Self::Build | Self::VvSmooth | Self::Editing(_))
    }

    /// Whether it allocates while the clock runs: what it takes depends on where the pages come from.
    pub const fn allocates(self) -> bool {
        matches!(self, Self::Build | Self::FfBfs) || self.makes_a_mesh()
    }

    /// How many elements it visits on `polygons` where no run has told: the faces, or the new ones.
    pub fn expected(self, polygons: &PolygonMesh) -> usize {
        match self {
            Self::CatmullClark(_) => polygons.corner_count(),
            Self::Loop(_) => polygons.face_count().saturating_mul(4),
            _ => polygons.face_count(),
        }
    }

    /// What one element of its count is: `vertex`, `visit` where neighbours are counted, or `new face`.
    pub const fn per(self) -> &'static str {
        match self {
            Self::Relation(relation) => Kind::asked(relation).name(),
            Self::VertexNormal | Self::VvSmooth => Kind::Vertex.name(),
            Self::EdgeLength | Self::Boundary => Kind::Edge.name(),
            Self::Build | Self::FaceBarycenter | Self::FfBfs => Kind::Face.name(),
            Self::Circulate | Self::AllQueries => "visit",
            Self::CatmullClark(_) | Self::Loop(_) => "new face",
            Self::Editing(Editing::FlipAll) => "visit",
            Self::Editing(_) => Kind::Face.name(),
        }
    }

    /// The kinds of elements that it goes through, in the order of running.
    pub const fn kinds(self) -> &'static [Kind] {
        const V: &[Kind] = &[Kind::Vertex];
        const E: &[Kind] = &[Kind::Edge];
        const F: &[Kind] = &[Kind::Face];
        match self {
            Self::Build => &[],
            Self::Relation(relation) => match Kind::asked(relation) {
                Kind::Vertex => V,
                Kind::Edge => E,
                Kind::Face => F,
            },
            Self::Circulate => &[Kind::Vertex, Kind::Face],
            Self::CatmullClark(Method::Scatter) | Self::Loop(Method::Scatter) => F,
            Self::CatmullClark(_) | Self::Loop(_) => &Kind::ALL,
            Self::Editing(Editing::FlipAll) => E,
            Self::Editing(_) => V,
            Self::FaceBarycenter | Self::FfBfs => F,
            Self::VertexNormal => &[Kind::Face, Kind::Vertex],
            Self::VvSmooth => V,
            Self::EdgeLength | Self::Boundary => E,
            Self::AllQueries => &Kind::ALL,
        }
    }

    /// The relations that it asks of elements of `kind`.
    pub fn relations(self, kind: Kind) -> &'static [Relation] {
        let one = |relation: Relation| std::slice::from_ref(&RELATIONS[relation as usize]);
        match (self, kind) {
            (Self::Relation(relation), _) if Kind::asked(relation) == kind => one(relation),
            (Self::Circulate | Self::VertexNormal, Kind::Vertex) => one(Relation::VertexFaces),
            (Self::Circulate | Self::VertexNormal | Self::FaceBarycenter, Kind::Face) => {
                one(Relation::FaceVertices)
            }
            (Self::VvSmooth, Kind::Vertex) => one(Relation::VertexVertices),
            (Self::EdgeLength, Kind::Edge) => one(Relation::EdgeVertices),
            (Self::Boundary, Kind::Edge) => one(Relation::EdgeFaces),
            (Self::FfBfs, Kind::Face) => one(Relation::FaceFaces),
            (Self::CatmullClark(_) | Self::Loop(_), Kind::Face) => AROUND_FACE,
            (Self::CatmullClark(Method::Scatter) | Self::Loop(Method::Scatter), _) => &[],
            (Self::CatmullClark(_), Kind::Vertex) => AROUND_VERTEX,
            (Self::Loop(_), Kind::Vertex) => one(Relation::VertexVertices),
            (Self::CatmullClark(_) | Self::Loop(_), Kind::Edge) => AROUND_EDGE,
            // What an edit has to find, at the least.
            (Self::Editing(Editing::FlipAll), Kind::Edge) => one(Relation::EdgeFaces),
            (Self::Editing(Editing::FlipAll), _) => &[],
            (Self::Editing(_), Kind::Vertex) => one(Relation::VertexFaces),
            (Self::AllQueries, _) => &RELATIONS[3 * kind.index()..][..3],
            _ => &[],
        }
    }

    /// By kind: whether a structure with these costs scans all faces for each element of it.
    pub fn scans(self, costs: &[QueryCost; 9]) -> [bool; 3] {
        Kind::ALL.map(|kind| {
            let relations = self.relations(kind);
            relations
                .iter()
                .any(|&r| costs[r as usize] == QueryCost::Scan)
        })
    }

    /// By kind: whether its cost grows with the square of the valences or degrees on some structure.
    ///
    /// All relations but the two that yield the corners of an element: an edge has two, and the
    /// faces have together no more than the mesh stores. The others meet a vertex of valence n from
    /// each of its n edges, or look for a side in a face of n sides n times.
    pub fn walks_around(self) -> [bool; 3] {
        let corners = [Relation::EdgeVertices, Relation::FaceVertices];
        Kind::ALL.map(|kind| self.relations(kind).iter().any(|r| !corners.contains(r)))
    }

    /// Whether some of its elements can stand for all.
    pub const fn can_be_sampled(self) -> bool {
        !matches!(self, Self::Build | Self::FfBfs) && !self.makes_a_mesh()
    }

    /// Whether its checksum is a count, equal to the last digit for all structures.
    pub const fn counts(self) -> bool {
        !matches!(
            self,
            Self::FaceBarycenter
                | Self::VertexNormal
                | Self::VvSmooth
                | Self::EdgeLength
                | Self::CatmullClark(_)
                | Self::Loop(_)
                | Self::Editing(_)
        )
    }
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that no operation has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", unknown("operation", .name, &Operation::ALL.map(Operation::name)))]
pub struct UnknownOperation {
    /// The name.
    pub name: String,
}

impl FromStr for Operation {
    type Err = UnknownOperation;

    fn from_str(name: &str) -> Result<Self, UnknownOperation> {
        let mut all = Self::ALL.into_iter();
        all.find(|operation| operation.name() == name)
            .ok_or_else(|| UnknownOperation { name: name.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_again() {
        for operation in Operation::ALL {
            assert_eq!(operation.name().parse(), Ok(operation));
        }
        let error = "vv_smoth".parse::<Operation>().unwrap_err().to_string();
        assert!(
            error.contains("vv_smoth") && error.contains("vv_smooth"),
            "{error}"
        );
    }

    #[test]
    fn relations_are_asked_of_their_own_kind() {
        for operation in Operation::ALL {
            for kind in Kind::ALL {
                let relations = operation.relations(kind);
                assert!(relations.iter().all(|&r| Kind::asked(r) == kind));
                assert_eq!(
                    relations.is_empty(),
                    !operation.kinds().contains(&kind),
                    "{operation} of {kind:?}"
                );
            }
        }
        let all = Kind::ALL.map(|kind| Operation::AllQueries.relations(kind));
        assert_eq!(all.concat(), Relation::ALL);
    }

    #[test]
    fn a_scan_is_seen_where_it_happens() {
        let mut costs = [QueryCost::Local; 9];
        costs[Relation::VertexFaces as usize] = QueryCost::Scan;
        assert_eq!(Operation::VertexNormal.scans(&costs), [true, false, false]);
        assert_eq!(Operation::FaceBarycenter.scans(&costs), [false; 3]);
        assert_eq!(Operation::VertexNormal.walks_around(), [true, false, false]);
        assert_eq!(Operation::EdgeLength.walks_around(), [false; 3]);
        assert_eq!(Operation::AllQueries.walks_around(), [true; 3]);
        // Of the subdivisions those that ask around vertices; Loop's rules do without their faces.
        let scans = |operation: Operation| operation.scans(&costs)[0];
        assert!(scans(Operation::CatmullClark(Method::Gather)));
        assert!(!scans(Operation::CatmullClark(Method::Scatter)));
        assert!(!scans(Operation::Loop(Method::Gather)));
    }

    #[test]
    fn subdivisions_are_named_by_scheme_and_way() {
        for operation in Operation::ALL {
            let named = operation.refining().map(|refining| {
                let scheme = refining.subdivision.scheme.name().replace('-', "_");
                format!("{scheme}_{}", refining.way)
            });
            assert_eq!(named.is_some(), operation.subdivides());
            assert_eq!(
                named.as_deref().unwrap_or(operation.name()),
                operation.name()
            );
        }
    }
}
