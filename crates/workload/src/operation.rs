//! The operations that a study times, with names, queried relations and visited elements.

use sixfold::subdivision::{Method, Scheme};
use sixfold::{PolygonMesh, QueryCost, Relation};
use sixfold_results::{OperationGroup, OperationInfo, OwnBytes, OwnData};

use crate::edit_pass::EditPass;
use crate::subdivision_job::{SubdivisionJob, Way};

sixfold_core::named! {
    /// One kind of element.
    pub enum ElementKind: "kind of element" {
        /// Vertices.
        Vertex = "vertex",
        /// Edges.
        Edge = "edge",
        /// Faces.
        Face = "face",
    }
}

impl ElementKind {
    /// Returns the index of the kind in [`ElementKind::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Returns the data of a program for the elements of this kind.
    pub const fn own_bytes(self, data: &OwnData) -> OwnBytes {
        match self {
            Self::Vertex => data.vertex,
            Self::Edge => data.edge,
            Self::Face => data.face,
        }
    }

    /// Returns the kind of the elements at which `relation` is queried.
    pub const fn queried_by(relation: Relation) -> Self {
        Self::ALL[relation as usize / 3]
    }
}

/// An operation that a study times.
///
/// An operation visits the elements in the order in which the structure stores them. The operation
/// uses every handle that a query yields, so the compiler cannot omit the computation of a handle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Operation {
    /// Builds the structure from a polygon mesh.
    #[default]
    Build,
    /// Queries one relation at every element of one kind.
    Relation(Relation),
    /// Queries the faces of every vertex and the vertices of every face.
    Circulate,
    /// Stores for each face the mean of its vertex positions.
    FaceBarycenter,
    /// Stores the normal of each face, and then for each vertex the normalised sum of the normals
    /// of its faces.
    VertexNormal,
    /// Moves each vertex to the mean position of its neighbours, after the means of all vertices
    /// are computed.
    VvSmooth,
    /// Sums the lengths of all edges.
    EdgeLength,
    /// Counts the edges with one face.
    Boundary,
    /// Traverses all faces breadth first and adds the depths of the faces.
    FfBfs,
    /// Queries all nine relations: three at every vertex, three at every edge, three at every face.
    AllQueries,
    /// Runs one step of Catmull–Clark subdivision by the given method.
    CatmullClark(Method),
    /// Runs one step of Loop subdivision by the given method.
    Loop(Method),
    /// Runs a pass of edits on a copy of the mesh.
    EditPass(EditPass),
}

const RELATIONS: &[Relation; 9] = &Relation::ALL;
/// Relations that a step of Catmull–Clark queries at each vertex.
const VERTEX_RELATIONS: &[Relation] = &[Relation::VertexVertices, Relation::VertexFaces];
/// Relations that a gathering or native step queries at each edge.
const EDGE_RELATIONS: &[Relation] = &[Relation::EdgeVertices, Relation::EdgeFaces];
/// Relations that every step queries at each face.
const FACE_RELATIONS: &[Relation] = &[Relation::FaceVertices, Relation::FaceEdges];

impl Operation {
    /// All operations, in the order in which tables list them.
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
        Self::EditPass(EditPass::SplitCollapse),
        Self::EditPass(EditPass::FlipAll),
        Self::EditPass(EditPass::DecimateHalf),
        Self::EditPass(EditPass::DecimateTenth),
    ];

    /// Returns the name that users write for the operation, such as `vv_smooth`.
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
            Self::EditPass(pass) => pass.name(),
        }
    }

    /// Returns the subdivision job; `None` if the operation is not a subdivision.
    pub fn subdivision_job(self) -> Option<SubdivisionJob> {
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
        Some(SubdivisionJob::new(scheme, way, 1))
    }

    /// Returns true if the operation is a subdivision.
    pub const fn subdivides(self) -> bool {
        matches!(self, Self::CatmullClark(_) | Self::Loop(_))
    }

    /// Returns true if the operation makes another mesh, by subdivision or by edits.
    pub const fn creates_mesh(self) -> bool {
        self.subdivides() || matches!(self, Self::EditPass(_))
    }

    /// Returns true if a run enlarges tables that the next run reuses. The first run then takes
    /// longer than the following runs.
    pub const fn grows_tables(self) -> bool {
        matches!(
            self,
            Self::CatmullClark(Method::Native)
                | Self::Loop(Method::Native)
                | Self::EditPass(EditPass::SplitCollapse | EditPass::FlipAll)
        )
    }

    /// Returns true if the clock stops between runs. While the clock is stopped, changes are undone
    /// or results are freed.
    pub const fn pauses_clock(self) -> bool {
        matches!(self, Self::Build | Self::VvSmooth | Self::EditPass(_))
    }

    /// Returns true if the timed part of the operation allocates memory.
    pub const fn allocates(self) -> bool {
        matches!(self, Self::Build | Self::FfBfs) || self.creates_mesh()
    }

    /// Estimates the number of elements that the operation visits on `polygons`. Callers need the
    /// estimate if no run has counted the elements.
    pub fn estimated_elements(self, polygons: &PolygonMesh) -> usize {
        match self {
            Self::CatmullClark(_) => polygons.corner_count(),
            Self::Loop(_) => polygons.face_count().saturating_mul(4),
            _ => polygons.face_count(),
        }
    }

    /// Returns the subdivision scheme; `None` if the operation is not a subdivision.
    pub const fn scheme(self) -> Option<Scheme> {
        match self {
            Self::CatmullClark(_) => Some(Scheme::CatmullClark),
            Self::Loop(_) => Some(Scheme::Loop),
            _ => None,
        }
    }

    /// Returns the group of the operation in lists.
    pub const fn group(self) -> OperationGroup {
        match self {
            Self::Build => OperationGroup::Build,
            Self::Relation(_) | Self::Circulate | Self::AllQueries => OperationGroup::Queries,
            Self::FaceBarycenter
            | Self::VertexNormal
            | Self::VvSmooth
            | Self::EdgeLength
            | Self::Boundary
            | Self::FfBfs => OperationGroup::Traversals,
            Self::EditPass(_) => OperationGroup::Edits,
            Self::CatmullClark(_) | Self::Loop(_) => OperationGroup::Subdivision,
        }
    }

    /// Returns what results say about the operation.
    pub fn info(self) -> OperationInfo {
        let (scheme, method) = match self {
            Self::CatmullClark(method) => (Some("Catmull–Clark"), Some(method)),
            Self::Loop(method) => (Some("Loop"), Some(method)),
            _ => (None, None),
        };
        OperationInfo {
            name: self.name().into(),
            group: self.group(),
            about: self.about().into(),
            unit: self.unit().into(),
            scheme: scheme.map(Into::into),
            method: method.map(|method| method.name().into()),
        }
    }

    /// Returns what one run of the operation does, in at most 45 characters, for lists.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Build => "builds the structure from a polygon mesh",
            Self::Relation(relation) => match relation {
                Relation::VertexVertices => "the other ends of the edges at each vertex",
                Relation::VertexEdges => "the edges that end at each vertex",
                Relation::VertexFaces => "the faces around each vertex",
                Relation::EdgeVertices => "the two ends of each edge",
                Relation::EdgeEdges => "the edges that share an end with each edge",
                Relation::EdgeFaces => "the faces along each edge",
                Relation::FaceVertices => "the corners of each face",
                Relation::FaceEdges => "the sides of each face",
                Relation::FaceFaces => "the faces that share an edge with each face",
            },
            Self::Circulate => "vertex_faces, then face_vertices",
            Self::AllQueries => "all nine relations",
            Self::FaceBarycenter => "stores the mean of the corners of each face",
            Self::VertexNormal => "stores the normals of faces, then of vertices",
            Self::VvSmooth => "moves each vertex to its neighbours' mean",
            Self::EdgeLength => "sums the lengths of all edges",
            Self::Boundary => "counts the edges with one face",
            Self::FfBfs => "visits the faces breadth first",
            Self::CatmullClark(method) => match method {
                Method::Gather => "Catmull–Clark; new points query neighbours",
                Method::Scatter => "Catmull–Clark; one pass over the faces",
                Method::Native => "Catmull–Clark; splits the structure's tables",
            },
            Self::Loop(method) => match method {
                Method::Gather => "Loop; new points query neighbours",
                Method::Scatter => "Loop; one pass over the faces",
                Method::Native => "Loop; splits the structure's tables",
            },
            Self::EditPass(pass) => match pass {
                EditPass::SplitCollapse => "adds a vertex to each face, then collapses it",
                EditPass::FlipAll => "flips each edge that can be flipped, twice",
                EditPass::DecimateHalf => "collapses edges until half the faces are left",
                EditPass::DecimateTenth => "collapses edges until a tenth is left",
            },
        }
    }

    /// The units that are not elements of the mesh, and their meaning for users.
    pub const UNITS: [(&'static str, &'static str); 2] = [
        (
            "visit",
            "one element that a query returns; in flip_all, one visit of an edge",
        ),
        ("new face", "a face of the refined mesh"),
    ];

    /// Returns the unit of work by which the time of the operation is divided: `vertex`, `edge`,
    /// `face`, or one of [`UNITS`](Self::UNITS).
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Relation(relation) => ElementKind::queried_by(relation).name(),
            Self::VertexNormal | Self::VvSmooth => ElementKind::Vertex.name(),
            Self::EdgeLength | Self::Boundary => ElementKind::Edge.name(),
            Self::Build | Self::FaceBarycenter | Self::FfBfs => ElementKind::Face.name(),
            Self::Circulate | Self::AllQueries => "visit",
            Self::CatmullClark(_) | Self::Loop(_) => "new face",
            Self::EditPass(EditPass::FlipAll) => "visit",
            Self::EditPass(_) => ElementKind::Face.name(),
        }
    }

    /// Returns the kinds of elements that the operation visits, in the order of the visits.
    pub const fn kinds(self) -> &'static [ElementKind] {
        const V: &[ElementKind] = &[ElementKind::Vertex];
        const E: &[ElementKind] = &[ElementKind::Edge];
        const F: &[ElementKind] = &[ElementKind::Face];
        match self {
            Self::Build => &[],
            Self::Relation(relation) => match ElementKind::queried_by(relation) {
                ElementKind::Vertex => V,
                ElementKind::Edge => E,
                ElementKind::Face => F,
            },
            Self::Circulate => &[ElementKind::Vertex, ElementKind::Face],
            Self::CatmullClark(Method::Scatter) | Self::Loop(Method::Scatter) => F,
            Self::CatmullClark(_) | Self::Loop(_) => &ElementKind::ALL,
            Self::EditPass(EditPass::FlipAll) => E,
            Self::EditPass(_) => V,
            Self::FaceBarycenter | Self::FfBfs => F,
            Self::VertexNormal => &[ElementKind::Face, ElementKind::Vertex],
            Self::VvSmooth => V,
            Self::EdgeLength | Self::Boundary => E,
            Self::AllQueries => &ElementKind::ALL,
        }
    }

    /// Returns the relations that the operation queries at elements of `kind`.
    pub fn relations(self, kind: ElementKind) -> &'static [Relation] {
        let one = |relation: Relation| std::slice::from_ref(&RELATIONS[relation as usize]);
        match (self, kind) {
            (Self::Relation(relation), _) if ElementKind::queried_by(relation) == kind => {
                one(relation)
            }
            (Self::Circulate | Self::VertexNormal, ElementKind::Vertex) => {
                one(Relation::VertexFaces)
            }
            (Self::Circulate | Self::VertexNormal | Self::FaceBarycenter, ElementKind::Face) => {
                one(Relation::FaceVertices)
            }
            (Self::VvSmooth, ElementKind::Vertex) => one(Relation::VertexVertices),
            (Self::EdgeLength, ElementKind::Edge) => one(Relation::EdgeVertices),
            (Self::Boundary, ElementKind::Edge) => one(Relation::EdgeFaces),
            (Self::FfBfs, ElementKind::Face) => one(Relation::FaceFaces),
            (Self::CatmullClark(_) | Self::Loop(_), ElementKind::Face) => FACE_RELATIONS,
            (Self::CatmullClark(Method::Scatter) | Self::Loop(Method::Scatter), _) => &[],
            (Self::CatmullClark(_), ElementKind::Vertex) => VERTEX_RELATIONS,
            (Self::Loop(_), ElementKind::Vertex) => one(Relation::VertexVertices),
            (Self::CatmullClark(_) | Self::Loop(_), ElementKind::Edge) => EDGE_RELATIONS,
            // An edit queries at least these relations.
            (Self::EditPass(EditPass::FlipAll), ElementKind::Edge) => one(Relation::EdgeFaces),
            (Self::EditPass(EditPass::FlipAll), _) => &[],
            (Self::EditPass(_), ElementKind::Vertex) => one(Relation::VertexFaces),
            (Self::AllQueries, _) => &RELATIONS[3 * kind.index()..][..3],
            _ => &[],
        }
    }

    /// Returns one value for each kind of element. The value is true if a structure with the query
    /// costs `costs` scans all faces for each element of this kind.
    pub fn scans(self, costs: &[QueryCost; 9]) -> [bool; 3] {
        ElementKind::ALL.map(|kind| {
            let relations = self.relations(kind);
            relations
                .iter()
                .any(|&r| costs[r as usize] == QueryCost::Scan)
        })
    }

    /// Returns one value for each kind of element. The value is true if the time of a query can
    /// grow with the square of a valence or of a face degree.
    ///
    /// The value is true if the operation queries a relation other than `edge_vertices` and
    /// `face_vertices`. Queries of all relations except `edge_vertices` and `face_vertices` may
    /// visit a vertex of valence n once for each of its n edges, or may search a face with n sides
    /// n times.
    pub fn grows_with_valence(self) -> [bool; 3] {
        let corners = [Relation::EdgeVertices, Relation::FaceVertices];
        ElementKind::ALL.map(|kind| self.relations(kind).iter().any(|r| !corners.contains(r)))
    }

    /// Returns true if the operation can run on a sample of the elements instead of all elements.
    /// Building, `ff_bfs`, subdivisions and edit passes need whole meshes.
    pub const fn can_be_sampled(self) -> bool {
        !matches!(self, Self::Build | Self::FfBfs) && !self.creates_mesh()
    }

    /// Returns true if the checksum of the operation is a count. The counts of all structures must
    /// be exactly equal.
    pub const fn has_exact_checksum(self) -> bool {
        !matches!(
            self,
            Self::FaceBarycenter
                | Self::VertexNormal
                | Self::VvSmooth
                | Self::EdgeLength
                | Self::CatmullClark(_)
                | Self::Loop(_)
                | Self::EditPass(_)
        )
    }
}

sixfold_core::named!(impl Operation: "operation" in Operation::ALL);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_parse_to_their_operations() {
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
    fn every_operation_and_unit_is_described() {
        let mut groups = Vec::from(Operation::ALL.map(Operation::group));
        groups.sort_unstable();
        groups.dedup();
        assert_eq!(groups, OperationGroup::ALL);
        for operation in Operation::ALL {
            let about = operation.about();
            let same = |other: &&Operation| other.about() == about;
            assert_eq!(Operation::ALL.iter().filter(same).count(), 1, "{about}");
            assert!(about.chars().count() <= 45, "{about}");
            let unit = operation.unit();
            let is_element = ElementKind::ALL.iter().any(|kind| kind.name() == unit);
            let is_described = Operation::UNITS.iter().any(|(name, _)| *name == unit);
            assert!(is_element != is_described, "{operation}: {unit}");
        }
    }

    #[test]
    fn relations_start_at_their_own_kind() {
        for operation in Operation::ALL {
            for kind in ElementKind::ALL {
                let relations = operation.relations(kind);
                assert!(
                    relations
                        .iter()
                        .all(|&r| ElementKind::queried_by(r) == kind)
                );
                assert_eq!(
                    relations.is_empty(),
                    !operation.kinds().contains(&kind),
                    "{operation} of {kind:?}"
                );
            }
        }
        let all = ElementKind::ALL.map(|kind| Operation::AllQueries.relations(kind));
        assert_eq!(all.concat(), Relation::ALL);
    }

    #[test]
    fn scans_are_reported_for_the_kinds_that_scan() {
        let mut costs = [QueryCost::Local; 9];
        costs[Relation::VertexFaces as usize] = QueryCost::Scan;
        assert_eq!(Operation::VertexNormal.scans(&costs), [true, false, false]);
        assert_eq!(Operation::FaceBarycenter.scans(&costs), [false; 3]);
        assert_eq!(
            Operation::VertexNormal.grows_with_valence(),
            [true, false, false]
        );
        assert_eq!(Operation::EdgeLength.grows_with_valence(), [false; 3]);
        assert_eq!(Operation::AllQueries.grows_with_valence(), [true; 3]);
        // Subdivisions scan if they query the faces of vertices. Loop does not query these faces.
        let scans = |operation: Operation| operation.scans(&costs)[0];
        assert!(scans(Operation::CatmullClark(Method::Gather)));
        assert!(!scans(Operation::CatmullClark(Method::Scatter)));
        assert!(!scans(Operation::Loop(Method::Gather)));
    }

    #[test]
    fn subdivisions_are_named_by_scheme_and_way() {
        for operation in Operation::ALL {
            let named = operation.subdivision_job().map(|job| {
                let scheme = job.subdivision.scheme.name().replace('-', "_");
                format!("{scheme}_{}", job.way)
            });
            assert_eq!(named.is_some(), operation.subdivides());
            assert_eq!(
                named.as_deref().unwrap_or(operation.name()),
                operation.name()
            );
        }
    }
}
