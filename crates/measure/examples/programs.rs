//! Eight programs as a command line that measures them on every structure. Six programs are the
//! examples of the crate `sixfold`. The other two compute vertex normals, in two ways.
//!
//! ```sh
//! cargo run --release --example programs -- mesh.obj --programs geodesics,regions --budget 10s
//! ```

#![allow(
    clippy::duplicate_mod,
    reason = "two of the included examples have the same module of helpers"
)]

use std::process::ExitCode;

use sixfold::operators::face_normals;
use sixfold::prelude::*;
use sixfold_measure::{EditProgram, MovingProgram, Outcome, Program, Suite};

/// Includes an example of the crate `sixfold`. Its function `main` is not used here.
macro_rules! example {
    ($name:ident, $path:literal) => {
        #[allow(
            dead_code,
            unreachable_pub,
            reason = "the example is a program of its own"
        )]
        #[path = $path]
        mod $name;
    };
}

example!(dijkstra, "../../sixfold/examples/dijkstra.rs");
example!(feature_lines, "../../sixfold/examples/feature_lines.rs");
example!(laplacian, "../../sixfold/examples/laplacian.rs");
example!(regions, "../../sixfold/examples/regions.rs");
example!(remesh, "../../sixfold/examples/remesh.rs");
example!(taubin, "../../sixfold/examples/taubin.rs");

fn main() -> ExitCode {
    let suite = Suite::new()
        .program(Geodesics)
        .program(FeatureLines)
        .program(Laplacian)
        .program(Regions)
        .edit_program(Remesh)
        .moving_program(Taubin)
        .program(GatheredNormals)
        .program(ScatteredNormals);
    sixfold_measure::main(suite)
}

/// Computes the distances from the first vertex along edges.
struct Geodesics;

impl Program for Geodesics {
    type Scratch<M: MeshQuery> = M::Vertex;

    fn name(&self) -> &str {
        "geodesics"
    }

    fn set_up<M: MeshQuery>(&self, mesh: &M) -> Result<M::Vertex, String> {
        mesh.vertices()
            .next()
            .ok_or_else(|| "the mesh has no vertex".into())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, source: &mut M::Vertex) -> Outcome {
        let distances = dijkstra::distances(mesh, *source);
        let mut reached = 0;
        let mut sum = 0.0;
        for v in mesh.vertices() {
            if distances[v].is_finite() {
                reached += 1;
                sum += distances[v];
            }
        }
        Outcome::new(sum, reached)
    }
}

/// Chains the feature edges into polylines.
struct FeatureLines;

impl Program for FeatureLines {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        "feature-lines"
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let lines = feature_lines::feature_lines(mesh, 30.0);
        let edges: usize = lines.iter().map(|line| line.len() - 1).sum();
        Outcome::new((edges + lines.len()) as f64, mesh.face_count() as u64)
    }
}

/// Computes the cotangent Laplacian, and multiplies it with the heights of the vertices.
struct Laplacian;

impl Program for Laplacian {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        "laplacian"
    }

    fn set_up<M: MeshQuery>(&self, mesh: &M) -> Result<(), String> {
        match mesh.faces().find(|&f| mesh.degree(f) != 3) {
            None => Ok(()),
            Some(f) => Err(format!("face {f:?} is not a triangle")),
        }
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        // The set-up accepts only triangles.
        let Ok(laplacian) = laplacian::laplacian(mesh) else {
            return Outcome::new(f64::NAN, 0);
        };
        let handles = laplacian.numbers.handles().iter();
        let heights: Vec<f64> = handles.map(|&v| mesh.position(v).z.into()).collect();
        let product = laplacian::multiply(&laplacian.triplets, &heights);
        let energy: f64 = product.iter().zip(&heights).map(|(l, z)| -l * z).sum();
        Outcome::new(energy, laplacian.triplets.len() as u64)
    }
}

/// Groups faces with similar normals.
struct Regions;

impl Program for Regions {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        "regions"
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let (_, count) = regions::regions(mesh, 20.0);
        Outcome::new(count as f64, mesh.face_count() as u64)
    }
}

/// Cuts long edges and collapses short edges.
struct Remesh;

impl EditProgram for Remesh {
    /// The wanted length of an edge.
    type Scratch<M: MeshEdit> = f32;

    fn name(&self) -> &str {
        "remesh"
    }

    fn set_up<M: MeshEdit>(&self, mesh: &M) -> Result<f32, String> {
        let length = |e| {
            let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
            f64::from(a.distance(b))
        };
        let mut edges = 0.0_f64;
        let sum: f64 = mesh.edges().inspect(|_| edges += 1.0).map(length).sum();
        Ok((0.7 * sum / edges) as f32)
    }

    fn run<M: MeshEdit>(&self, mesh: &mut M, length: &mut f32) -> Outcome {
        let edges_before = mesh.edge_count();
        remesh::remesh(mesh, *length);
        // Which and how many edges are cut depends on the order of the edges, which differs between
        // structures. All edits keep the Euler characteristic.
        let [vertices, edges, faces] =
            [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()].map(|n| n as f64);
        Outcome::new(vertices - edges + faces, edges_before as u64)
    }
}

/// Smooths in ten steps.
struct Taubin;

impl MovingProgram for Taubin {
    type Scratch<M: Representation> = ();

    fn name(&self) -> &str {
        "taubin"
    }

    fn set_up<M: Representation>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: Representation>(&self, mesh: &mut M, (): &mut ()) -> Outcome {
        if let Err(refusal) = taubin::smooth(mesh, 5) {
            panic!("{refusal}");
        }
        let sizes = mesh
            .vertices()
            .map(|v| f64::from(mesh.position(v).length()));
        Outcome::new(sizes.sum(), mesh.vertex_count() as u64)
    }
}

/// Computes the normals of the vertices: each vertex adds up the normals of its faces.
struct GatheredNormals;

impl Program for GatheredNormals {
    type Scratch<M: MeshQuery> = VertexMap<M, Point>;

    fn name(&self) -> &str {
        "gathered-normals"
    }

    fn set_up<M: MeshQuery>(&self, mesh: &M) -> Result<VertexMap<M, Point>, String> {
        Ok(mesh.vertex_map(Point::ZERO))
    }

    fn run<M: MeshQuery>(&self, mesh: &M, normals: &mut VertexMap<M, Point>) -> Outcome {
        let of_faces = face_normals(mesh);
        let mut vertices = 0;
        for v in mesh.vertices() {
            normals[v] = mesh.vertex_faces(v).map(|f| of_faces[f]).sum();
            vertices += 1;
        }
        Outcome::new(total_length::<M>(mesh, normals), vertices)
    }
}

/// Computes the normals of the vertices: each face adds its normal to its vertices.
struct ScatteredNormals;

impl Program for ScatteredNormals {
    type Scratch<M: MeshQuery> = VertexMap<M, Point>;

    fn name(&self) -> &str {
        "scattered-normals"
    }

    fn set_up<M: MeshQuery>(&self, mesh: &M) -> Result<VertexMap<M, Point>, String> {
        Ok(mesh.vertex_map(Point::ZERO))
    }

    fn run<M: MeshQuery>(&self, mesh: &M, normals: &mut VertexMap<M, Point>) -> Outcome {
        let mut vertices = 0;
        for v in mesh.vertices() {
            normals[v] = Point::ZERO;
            vertices += 1;
        }
        let of_faces = face_normals(mesh);
        for f in mesh.faces() {
            for v in mesh.face_vertices(f) {
                normals[v] += of_faces[f];
            }
        }
        Outcome::new(total_length::<M>(mesh, normals), vertices)
    }
}

fn total_length<M: MeshQuery>(mesh: &M, vectors: &VertexMap<M, Point>) -> f64 {
    mesh.vertices()
        .map(|v| f64::from(vectors[v].length()))
        .sum()
}
