//! The operations that a study times, and what is known about them without running them. Their loops are in
//! `sixfold-workload`.

use sixfold::subdivision::{Method, Scheme};
use sixfold::{Counts, Point, PolygonMesh, QueryCost, Relation};
use sixfold_results::{OperationGroup, OperationInfo, OwnBytes, OwnData};

mod descriptions;

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

/// The unit of work by which the time of an operation is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unit {
    Element(ElementKind),
    /// One element that a query returns; in `flip_all`, one visit of an edge.
    Visit,
    /// A face of the refined mesh.
    NewFace,
}

impl Unit {
    /// Returns the kind of the elements that are counted; `None` if the unit is not an element of the
    /// mesh.
    pub(crate) const fn element(self) -> Option<ElementKind> {
        match self {
            Self::Element(kind) => Some(kind),
            Self::Visit | Self::NewFace => None,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Element(kind) => kind.name(),
            Self::Visit => "visit",
            Self::NewFace => "new face",
        }
    }
}

/// The number by which the results of an operation are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checksum {
    /// A count. The counts of all structures must be equal.
    Count,
    /// The sum of the lengths of edges.
    Lengths,
    /// The sum over the vectors that are stored for the faces ([`field_sum()`]).
    FaceValues,
    /// The same for the vertices.
    VertexValues,
    /// The same for the positions of the mesh that the operation makes.
    Positions,
}

/// The kinds of elements that an operation visits, in the order of the visits, each with the relations
/// that are queried at its elements.
type Visits = &'static [(ElementKind, &'static [Relation])];

/// What is known about an operation without running it.
pub(crate) struct Description {
    name: &'static str,
    /// What one run does, in at most 45 characters.
    about: &'static str,
    group: OperationGroup,
    pub(crate) unit: Unit,
    visits: Visits,
    checksum: Checksum,
    /// The maximum error of the checksum if terms cancel; O(corners).
    noise: fn(&PolygonMesh) -> f64,
    /// The operation can run on a sample of the elements; else it needs the whole mesh.
    takes_samples: bool,
    /// The clock stops between runs. While it is stopped, changes are undone or results are freed.
    pauses_clock: bool,
    /// The timed part of a run allocates memory.
    allocates: bool,
    /// A run enlarges tables that the next run reuses. The first run then takes longer.
    grows_tables: bool,
    /// The result depends on the order of the input: the operation starts at the first face, or edits
    /// the elements one after another.
    depends_on_order: bool,
    /// Estimates the number of visited elements.
    elements: fn(&PolygonMesh) -> usize,
    /// The bytes of the result, if the result is not a mesh.
    result_bytes: Option<fn(&Counts) -> usize>,
    subdivision: Option<(Scheme, Method)>,
}

impl Description {
    /// What most queries have in common.
    const QUERIES: Self = Self {
        name: "",
        about: "",
        group: OperationGroup::Queries,
        unit: Unit::Visit,
        visits: &[],
        checksum: Checksum::Count,
        noise: |_| 0.0,
        takes_samples: true,
        pauses_clock: false,
        allocates: false,
        grows_tables: false,
        depends_on_order: false,
        elements: PolygonMesh::face_count,
        result_bytes: None,
        subdivision: None,
    };

    /// What most traversals have in common.
    const TRAVERSAL: Self = Self {
        group: OperationGroup::Traversals,
        ..Self::QUERIES
    };
}

/// Returns a checksum of vectors: the sum of |x| + 2|y| + 3|z| over all vectors (x, y, z).
pub fn field_sum(points: impl Iterator<Item = Point>) -> f64 {
    let weighted_sum =
        |p: Point| f64::from(p.x).abs() + 2.0 * f64::from(p.y).abs() + 3.0 * f64::from(p.z).abs();
    points.map(weighted_sum).sum()
}

/// Returns the rounding error of a sum over positions that cancel each other.
fn noise_of_corners(polygons: &PolygonMesh) -> f64 {
    let corners = polygons.faces().corners().iter();
    1e-6 * field_sum(corners.map(|&v| polygons.position(v)))
}

/// An operation that a study times.
///
/// An operation visits the elements in the order in which the structure stores them. The
/// operation uses every handle that a query yields, so the compiler cannot omit the
/// computation of a handle.
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

sixfold_core::named! {
    /// A series of edits over a whole triangle mesh.
    pub enum EditPass: "edit pass" {
        /// Inserts a vertex into the centre of every face, then collapses each new vertex into a
        /// neighbour. Removes the deleted elements from the tables. The resulting mesh has the
        /// original faces.
        SplitCollapse = "split_collapse",
        /// Flips every edge whose flip is legal, then flips the same edges again on the changed
        /// mesh. The edges are flipped in the order of their first occurrence in the faces.
        FlipAll = "flip_all",
        /// Repeatedly collapses the edge with the least quadric error, until half of the faces are
        /// left.
        DecimateHalf = "decimate_half",
        /// Repeatedly collapses the edge with the least quadric error, until a tenth of the faces
        /// is left.
        DecimateTenth = "decimate_tenth",
    }
}

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

    const fn description(self) -> &'static Description {
        match self {
            Self::Build => &descriptions::BUILD,
            Self::Relation(relation) => &descriptions::RELATIONS[relation as usize],
            Self::Circulate => &descriptions::CIRCULATE,
            Self::FaceBarycenter => &descriptions::FACE_BARYCENTER,
            Self::VertexNormal => &descriptions::VERTEX_NORMAL,
            Self::VvSmooth => &descriptions::VV_SMOOTH,
            Self::EdgeLength => &descriptions::EDGE_LENGTH,
            Self::Boundary => &descriptions::BOUNDARY,
            Self::FfBfs => &descriptions::FF_BFS,
            Self::AllQueries => &descriptions::ALL_QUERIES,
            Self::CatmullClark(method) => &descriptions::CATMULL_CLARK[method as usize],
            Self::Loop(method) => &descriptions::LOOP[method as usize],
            Self::EditPass(pass) => &descriptions::EDIT_PASSES[pass as usize],
        }
    }

    /// The units that are not elements of the mesh, and their meaning for users.
    pub const UNITS: [(&'static str, &'static str); 2] = [
        (
            Unit::Visit.name(),
            "one element that a query returns; in flip_all, one visit of an edge",
        ),
        (Unit::NewFace.name(), "a face of the refined mesh"),
    ];

    /// Returns the name that users write for the operation, such as `vv_smooth`.
    pub const fn name(self) -> &'static str {
        self.description().name
    }

    /// Returns what one run of the operation does, in at most 45 characters, for lists.
    pub const fn about(self) -> &'static str {
        self.description().about
    }

    /// Returns the group of the operation in lists.
    pub const fn group(self) -> OperationGroup {
        self.description().group
    }

    /// Returns the unit of work by which the time of the operation is divided: `vertex`, `edge`,
    /// `face`, or one of [`UNITS`](Self::UNITS).
    pub const fn unit(self) -> &'static str {
        self.description().unit.name()
    }

    /// Returns the kind of the elements by whose number the time of the operation is divided; `None` if the unit is
    /// not an element of the mesh.
    pub const fn unit_element(self) -> Option<ElementKind> {
        self.description().unit.element()
    }

    /// Returns what results say about the operation.
    pub fn info(self) -> OperationInfo {
        let step = self.description().subdivision;
        let title = |scheme| match scheme {
            Scheme::Loop => "Loop",
            _ => "Catmull–Clark",
        };
        OperationInfo {
            name: self.name().into(),
            group: self.group(),
            about: self.about().into(),
            unit: self.unit().into(),
            scheme: step.map(|(scheme, _)| title(scheme).into()),
            method: step.map(|(_, method)| method.name().into()),
        }
    }

    /// Returns the scheme and the method; `None` if the operation is not a subdivision.
    pub const fn subdivision(self) -> Option<(Scheme, Method)> {
        self.description().subdivision
    }

    /// Returns the subdivision scheme; `None` if the operation is not a subdivision.
    pub fn scheme(self) -> Option<Scheme> {
        self.description().subdivision.map(|(scheme, _)| scheme)
    }

    /// Returns true if the operation is a subdivision.
    pub const fn subdivides(self) -> bool {
        self.description().subdivision.is_some()
    }

    /// Returns true if the operation makes another mesh, by subdivision or by edits.
    pub const fn creates_mesh(self) -> bool {
        self.subdivides() || matches!(self, Self::EditPass(_))
    }

    /// Returns true if a run enlarges tables that the next run reuses. The first run then takes
    /// longer than the following runs.
    pub const fn grows_tables(self) -> bool {
        self.description().grows_tables
    }

    /// Returns true if the clock stops between runs. While the clock is stopped, changes are undone
    /// or results are freed.
    pub const fn pauses_clock(self) -> bool {
        self.description().pauses_clock
    }

    /// Returns true if the timed part of the operation allocates memory.
    pub const fn allocates(self) -> bool {
        self.description().allocates
    }

    /// Returns true if the result depends on the order of the input: the operation starts at the
    /// first face, or edits the elements one after another.
    pub const fn depends_on_order(self) -> bool {
        self.description().depends_on_order
    }

    /// Returns true if the operation can run on a sample of the elements instead of all elements.
    /// Building, `ff_bfs`, subdivisions and edit passes need whole meshes.
    pub const fn can_be_sampled(self) -> bool {
        self.description().takes_samples
    }

    /// Returns true if the checksum of the operation is a count. The counts of all structures must
    /// be exactly equal.
    pub const fn has_exact_checksum(self) -> bool {
        matches!(self.description().checksum, Checksum::Count)
    }

    /// Returns the maximum error of the checksum on `polygons` if terms cancel; O(corners).
    pub fn noise(self, polygons: &PolygonMesh) -> f64 {
        (self.description().noise)(polygons)
    }

    /// Estimates the number of elements that the operation visits on `polygons`. Callers need the
    /// estimate if no run has counted the elements.
    pub fn estimated_elements(self, polygons: &PolygonMesh) -> usize {
        (self.description().elements)(polygons)
    }

    /// Returns the bytes of the result on a mesh with `counts`; `None` if the result is a mesh.
    pub fn result_bytes(self, counts: &Counts) -> Option<usize> {
        self.description().result_bytes.map(|bytes| bytes(counts))
    }

    /// Returns the kinds of elements that the operation visits, in the order of the visits.
    pub fn kinds(self) -> impl Iterator<Item = ElementKind> {
        self.description().visits.iter().map(|&(kind, _)| kind)
    }

    /// Returns the relations that the operation queries at elements of `kind`.
    pub fn relations(self, kind: ElementKind) -> &'static [Relation] {
        let mut visits = self.description().visits.iter();
        visits
            .find(|&&(visited, _)| visited == kind)
            .map_or(&[], |&(_, relations)| relations)
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

    /// Returns the number by which the results of the operation are compared.
    pub const fn checksum(self) -> Checksum {
        self.description().checksum
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
    fn descriptions_are_in_the_order_of_what_they_describe() {
        for relation in Relation::ALL {
            let operation = Operation::Relation(relation);
            assert_eq!(operation.name(), relation.name());
            let kind = ElementKind::queried_by(relation);
            assert_eq!(operation.relations(kind), [relation]);
        }
        for pass in EditPass::ALL {
            assert_eq!(Operation::EditPass(pass).name(), pass.name());
        }
        for method in Method::ALL {
            let steps = [
                (Operation::CatmullClark(method), Scheme::CatmullClark),
                (Operation::Loop(method), Scheme::Loop),
            ];
            for (operation, scheme) in steps {
                let name = format!("{}_{method}", scheme.name().replace('-', "_"));
                assert_eq!(operation.name(), name);
                assert_eq!(operation.scheme(), Some(scheme));
                assert_eq!(operation.subdivision(), Some((scheme, method)));
                let of_mask = operation.relations(ElementKind::Vertex);
                let queries_faces = of_mask.contains(&Relation::VertexFaces);
                let gathers = method != Method::Scatter;
                assert_eq!(queries_faces, gathers && scheme == Scheme::CatmullClark);
            }
        }
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
                    !operation.kinds().any(|visited| visited == kind),
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
            let named = operation
                .subdivision()
                .map(|(scheme, method)| format!("{}_{method}", scheme.name().replace('-', "_")));
            assert_eq!(named.is_some(), operation.subdivides());
            assert_eq!(
                named.as_deref().unwrap_or(operation.name()),
                operation.name()
            );
        }
    }
}
