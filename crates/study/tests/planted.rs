//! A structure with a planted slow relation loses exactly the programs that query this relation.

use std::hint::black_box;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::prelude::*;
use sixfold::{
    BuildError, Capabilities, FaceId, InvariantError, MemoryFootprint, MoveError, QueryCost,
    Relation, VertexId, shapes,
};
use sixfold_study::{
    Outcome, PickReport, Program, ProgramSettings, StudyMesh, Suite, pick_for_programs,
};

/// A face-vertex mesh whose query of the faces at a face takes much longer.
#[derive(Clone)]
struct SlowFaceFaces(FaceVertexMesh);

/// Passes the queries of relations on.
macro_rules! same {
    ($($name:ident($from:ident) -> $to:ident;)+) => {
        $(fn $name(&self, of: Self::$from) -> impl Iterator<Item = Self::$to> {
            self.0.$name(of)
        })+
    };
}

impl MeshQuery for SlowFaceFaces {
    type Vertex = <FaceVertexMesh as MeshQuery>::Vertex;
    type Edge = <FaceVertexMesh as MeshQuery>::Edge;
    type Face = <FaceVertexMesh as MeshQuery>::Face;

    const CAPABILITIES: Capabilities = FaceVertexMesh::CAPABILITIES;

    fn vertices(&self) -> impl Iterator<Item = Self::Vertex> {
        self.0.vertices()
    }
    fn edges(&self) -> impl Iterator<Item = Self::Edge> {
        self.0.edges()
    }
    fn faces(&self) -> impl Iterator<Item = Self::Face> {
        self.0.faces()
    }
    fn face_count(&self) -> usize {
        self.0.face_count()
    }
    fn position(&self, v: Self::Vertex) -> Point {
        self.0.position(v)
    }
    same! {
        vertex_vertices(Vertex) -> Vertex;
        vertex_edges(Vertex) -> Edge;
        vertex_faces(Vertex) -> Face;
        edge_edges(Edge) -> Edge;
        edge_faces(Edge) -> Face;
        face_vertices(Face) -> Vertex;
        face_edges(Face) -> Edge;
    }
    fn edge_vertices(&self, e: Self::Edge) -> [Self::Vertex; 2] {
        self.0.edge_vertices(e)
    }
    fn face_faces(&self, f: Self::Face) -> impl Iterator<Item = Self::Face> {
        let mut wasted = 0_u32;
        for i in 0..1000_u32 {
            wasted = black_box(wasted.wrapping_add(i));
        }
        self.0.face_faces(f)
    }
    fn vertex_rows(&self) -> usize {
        self.0.vertex_rows()
    }
    fn edge_rows(&self) -> usize {
        self.0.edge_rows()
    }
    fn face_rows(&self) -> usize {
        self.0.face_rows()
    }
}

impl Representation for SlowFaceFaces {
    const NAME: &'static str = "slow-face-faces";
    const COSTS: [QueryCost; 9] = FaceVertexMesh::COSTS;

    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        FaceVertexMesh::from_polygons(polygons).map(Self)
    }
    fn to_polygons(&self) -> PolygonMesh {
        self.0.to_polygons()
    }
    fn vertex_handle(polygons: &PolygonMesh, v: VertexId) -> Self::Vertex {
        FaceVertexMesh::vertex_handle(polygons, v)
    }
    fn face_handle(polygons: &PolygonMesh, f: FaceId) -> Self::Face {
        FaceVertexMesh::face_handle(polygons, f)
    }
    fn set_positions(&mut self, positions: &VertexMap<Self, Point>) -> Result<(), MoveError> {
        self.0.set_positions(positions)
    }
    fn memory(&self) -> MemoryFootprint {
        self.0.memory()
    }
    fn validate(&self) -> Result<(), InvariantError> {
        self.0.validate()
    }
}

/// Queries one relation of every element.
#[derive(Clone, Copy)]
struct Queries(Relation);

impl Program for Queries {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        self.0.name()
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let results: usize = match self.0 {
            Relation::VertexVertices => mesh
                .vertices()
                .map(|v| mesh.vertex_vertices(v).count())
                .sum(),
            Relation::FaceVertices => mesh.faces().map(|f| mesh.face_vertices(f).count()).sum(),
            Relation::FaceFaces => mesh.faces().map(|f| mesh.face_faces(f).count()).sum(),
            _ => mesh.edges().map(|e| mesh.edge_faces(e).count()).sum(),
        };
        Outcome::new(results as f64, results as u64)
    }
}

#[test]
fn a_planted_slow_relation_loses_the_programs_that_query_it() {
    let relations = [
        Relation::VertexVertices,
        Relation::FaceVertices,
        Relation::FaceFaces,
        Relation::EdgeFaces,
    ];
    let suite = relations.iter().fold(Suite::new(), |suite, &relation| {
        suite
            .program(Queries(relation))
            .on_structure::<_, SlowFaceFaces>(Queries(relation))
    });
    let torus = shapes::triangle_torus(40, 30).expect("small");
    let settings = ProgramSettings {
        backends: ["face-vertex", "slow-face-faces"]
            .map(str::to_owned)
            .to_vec(),
        budget: Duration::from_secs(2),
        ..ProgramSettings::default()
    };
    let meshes = [StudyMesh::new("torus", torus)];
    let stop = AtomicBool::new(false);
    let reports = pick_for_programs(
        &meshes,
        &suite,
        &settings,
        &stop,
        &mut |_, _| (),
        &mut |_| (),
    );
    let reports = reports.expect("a mesh with faces");
    assert_eq!(reports.len(), relations.len());
    let slow = |report: &PickReport| {
        let of = |name: &str| {
            let mut ranking = report.ranking.iter();
            let found = ranking.find(|ranked| ranked.backend == name);
            found.expect("measured").ns_per_operation
        };
        of("slow-face-faces") / of("face-vertex")
    };
    for (relation, report) in relations.into_iter().zip(&reports) {
        let ratio = slow(report);
        match relation {
            Relation::FaceFaces => {
                assert!(ratio > 3.0, "{relation:?}: {ratio}");
                assert_eq!(report.ranking[0].backend, "face-vertex");
                let choice = report.choice.as_ref().expect("a choice");
                assert_eq!(choice.backend, "face-vertex");
            }
            _ => assert!((0.6..1.6).contains(&ratio), "{relation:?}: {ratio}"),
        }
        assert_eq!(report.mismatches, Vec::<String>::new());
    }
}
