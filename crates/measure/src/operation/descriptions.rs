//! What is known about each operation without running it.

use sixfold::subdivision::{Method, Scheme};
use sixfold::{FaceId, Point, PolygonMesh, Relation};
use sixfold_results::OperationGroup;

use super::{Checksum, Description, EditPass, ElementKind, Unit, Visits, noise_of_corners};

pub(super) const BUILD: Description = Description {
    name: "build",
    about: "builds the structure from a polygon mesh",
    unit: Unit::Element(ElementKind::Face),
    group: OperationGroup::Build,
    takes_samples: false,
    pauses_clock: true,
    allocates: true,
    ..Description::QUERIES
};

/// The description of each relation, in the order of [`Relation::ALL`].
pub(super) const RELATIONS: [Description; 9] = [
    describe_relation(
        Relation::VertexVertices,
        "the other ends of the edges at each vertex",
        &[(ElementKind::Vertex, &[Relation::VertexVertices])],
    ),
    describe_relation(
        Relation::VertexEdges,
        "the edges that end at each vertex",
        &[(ElementKind::Vertex, &[Relation::VertexEdges])],
    ),
    describe_relation(
        Relation::VertexFaces,
        "the faces around each vertex",
        &[(ElementKind::Vertex, &[Relation::VertexFaces])],
    ),
    describe_relation(
        Relation::EdgeVertices,
        "the two ends of each edge",
        &[(ElementKind::Edge, &[Relation::EdgeVertices])],
    ),
    describe_relation(
        Relation::EdgeEdges,
        "the edges that share an end with each edge",
        &[(ElementKind::Edge, &[Relation::EdgeEdges])],
    ),
    describe_relation(
        Relation::EdgeFaces,
        "the faces along each edge",
        &[(ElementKind::Edge, &[Relation::EdgeFaces])],
    ),
    describe_relation(
        Relation::FaceVertices,
        "the corners of each face",
        &[(ElementKind::Face, &[Relation::FaceVertices])],
    ),
    describe_relation(
        Relation::FaceEdges,
        "the sides of each face",
        &[(ElementKind::Face, &[Relation::FaceEdges])],
    ),
    describe_relation(
        Relation::FaceFaces,
        "the faces that share an edge with each face",
        &[(ElementKind::Face, &[Relation::FaceFaces])],
    ),
];

const fn describe_relation(relation: Relation, about: &'static str, visits: Visits) -> Description {
    Description {
        name: relation.name(),
        about,
        unit: Unit::Element(ElementKind::queried_by(relation)),
        visits,
        ..Description::QUERIES
    }
}

pub(super) const CIRCULATE: Description = Description {
    name: "circulate",
    about: "vertex_faces, then face_vertices",
    unit: Unit::Visit,
    visits: &[
        (ElementKind::Vertex, &[Relation::VertexFaces]),
        (ElementKind::Face, &[Relation::FaceVertices]),
    ],
    ..Description::QUERIES
};

pub(super) const FACE_BARYCENTER: Description = Description {
    name: "face_barycenter",
    about: "stores the mean of the corners of each face",
    unit: Unit::Element(ElementKind::Face),
    visits: &[(ElementKind::Face, &[Relation::FaceVertices])],
    checksum: Checksum::FaceValues,
    noise: noise_of_corners,
    ..Description::TRAVERSAL
};

pub(super) const VERTEX_NORMAL: Description = Description {
    name: "vertex_normal",
    about: "stores the normals of faces, then of vertices",
    unit: Unit::Element(ElementKind::Vertex),
    visits: &[
        (ElementKind::Face, &[Relation::FaceVertices]),
        (ElementKind::Vertex, &[Relation::VertexFaces]),
    ],
    checksum: Checksum::VertexValues,
    noise: |polygons| 12.0 * cancelled_normals(polygons) as f64,
    ..Description::TRAVERSAL
};

/// Counts the vertices whose face normals cancel. The direction of their sum is noise.
fn cancelled_normals(polygons: &PolygonMesh) -> usize {
    let mut sums = vec![(Point::ZERO, 0.0_f32); polygons.vertex_count()];
    for (_, face) in polygons.faces().iter() {
        let at = |corner: usize| polygons.position(face[corner]);
        let spokes = (1..face.len() - 1).map(|i| (at(i) - at(0)).cross(at(i + 1) - at(0)));
        let (mut normal, mut size) = (Point::ZERO, 0.0);
        for cross in spokes {
            normal += cross;
            size += cross.length();
        }
        for &v in face {
            let (sum, total) = &mut sums[v.index()];
            *sum += normal;
            *total += size;
        }
    }
    let cancels = |(sum, total): &&(Point, f32)| *total > 0.0 && sum.length() < 1e-3 * total;
    sums.iter().filter(cancels).count()
}

pub(super) const VV_SMOOTH: Description = Description {
    name: "vv_smooth",
    about: "moves each vertex to its neighbours' mean",
    unit: Unit::Element(ElementKind::Vertex),
    visits: &[(ElementKind::Vertex, &[Relation::VertexVertices])],
    checksum: Checksum::VertexValues,
    noise: noise_of_corners,
    pauses_clock: true,
    ..Description::TRAVERSAL
};

pub(super) const EDGE_LENGTH: Description = Description {
    name: "edge_length",
    about: "sums the lengths of all edges",
    unit: Unit::Element(ElementKind::Edge),
    visits: &[(ElementKind::Edge, &[Relation::EdgeVertices])],
    checksum: Checksum::Lengths,
    ..Description::TRAVERSAL
};

pub(super) const BOUNDARY: Description = Description {
    name: "boundary",
    about: "counts the edges with one face",
    unit: Unit::Element(ElementKind::Edge),
    visits: &[(ElementKind::Edge, &[Relation::EdgeFaces])],
    ..Description::TRAVERSAL
};

pub(super) const FF_BFS: Description = Description {
    name: "ff_bfs",
    about: "visits the faces breadth first",
    unit: Unit::Element(ElementKind::Face),
    visits: &[(ElementKind::Face, &[Relation::FaceFaces])],
    takes_samples: false,
    allocates: true,
    depends_on_order: true,
    result_bytes: Some(|counts| size_of::<FaceId>() * counts.faces),
    ..Description::TRAVERSAL
};

pub(super) const ALL_QUERIES: Description = Description {
    name: "all_queries",
    about: "all nine relations",
    unit: Unit::Visit,
    visits: &[
        (
            ElementKind::Vertex,
            &[
                Relation::VertexVertices,
                Relation::VertexEdges,
                Relation::VertexFaces,
            ],
        ),
        (
            ElementKind::Edge,
            &[
                Relation::EdgeVertices,
                Relation::EdgeEdges,
                Relation::EdgeFaces,
            ],
        ),
        (
            ElementKind::Face,
            &[
                Relation::FaceVertices,
                Relation::FaceEdges,
                Relation::FaceFaces,
            ],
        ),
    ],
    ..Description::QUERIES
};

/// The description of one step by `scheme`, for each method.
pub(super) const CATMULL_CLARK: [Description; 3] = [
    describe_step(
        (Scheme::CatmullClark, Method::Gather),
        "catmull_clark_gather",
        "Catmull–Clark; new points query neighbours",
    ),
    describe_step(
        (Scheme::CatmullClark, Method::Scatter),
        "catmull_clark_scatter",
        "Catmull–Clark; one pass over the faces",
    ),
    describe_step(
        (Scheme::CatmullClark, Method::Native),
        "catmull_clark_native",
        "Catmull–Clark; splits the structure's tables",
    ),
];

pub(super) const LOOP: [Description; 3] = [
    describe_step(
        (Scheme::Loop, Method::Gather),
        "loop_gather",
        "Loop; new points query neighbours",
    ),
    describe_step(
        (Scheme::Loop, Method::Scatter),
        "loop_scatter",
        "Loop; one pass over the faces",
    ),
    describe_step(
        (Scheme::Loop, Method::Native),
        "loop_native",
        "Loop; splits the structure's tables",
    ),
];

const fn describe_step(
    step: (Scheme, Method),
    name: &'static str,
    about: &'static str,
) -> Description {
    const EDGES: &[Relation] = &[Relation::EdgeVertices, Relation::EdgeFaces];
    const FACES: &[Relation] = &[Relation::FaceVertices, Relation::FaceEdges];
    let (scheme, method) = step;
    Description {
        name,
        about,
        unit: Unit::NewFace,
        group: OperationGroup::Subdivision,
        visits: match (method, scheme) {
            (Method::Scatter, _) => &[(ElementKind::Face, FACES)],
            (_, Scheme::Loop) => &[
                (ElementKind::Vertex, &[Relation::VertexVertices]),
                (ElementKind::Edge, EDGES),
                (ElementKind::Face, FACES),
            ],
            _ => &[
                (
                    ElementKind::Vertex,
                    &[Relation::VertexVertices, Relation::VertexFaces],
                ),
                (ElementKind::Edge, EDGES),
                (ElementKind::Face, FACES),
            ],
        },
        checksum: Checksum::Positions,
        noise: noise_of_corners,
        takes_samples: false,
        allocates: true,
        grows_tables: matches!(method, Method::Native),
        elements: match scheme {
            Scheme::Loop => |polygons| polygons.face_count().saturating_mul(4),
            _ => PolygonMesh::corner_count,
        },
        subdivision: Some(step),
        ..Description::QUERIES
    }
}

/// The description of each pass, in the order of [`EditPass::ALL`].
pub(super) const EDIT_PASSES: [Description; 4] = [
    Description {
        grows_tables: true,
        ..describe_pass(
            EditPass::SplitCollapse,
            "adds a vertex to each face, then collapses it",
        )
    },
    Description {
        unit: Unit::Visit,
        visits: &[(ElementKind::Edge, &[Relation::EdgeFaces])],
        grows_tables: true,
        ..describe_pass(
            EditPass::FlipAll,
            "flips each edge that can be flipped, twice",
        )
    },
    describe_pass(
        EditPass::DecimateHalf,
        "collapses edges until half the faces are left",
    ),
    describe_pass(
        EditPass::DecimateTenth,
        "collapses edges until a tenth is left",
    ),
];

const fn describe_pass(pass: EditPass, about: &'static str) -> Description {
    Description {
        name: pass.name(),
        about,
        unit: Unit::Element(ElementKind::Face),
        group: OperationGroup::Edits,
        // An edit queries at least these relations.
        visits: &[(ElementKind::Vertex, &[Relation::VertexFaces])],
        checksum: Checksum::Lengths,
        takes_samples: false,
        pauses_clock: true,
        allocates: true,
        depends_on_order: true,
        ..Description::QUERIES
    }
}
