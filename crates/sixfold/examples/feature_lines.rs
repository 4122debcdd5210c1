//! Feature edges, chained into polylines. Feature edges are sharp edges and boundary edges. A
//! polyline ends at a vertex that does not have exactly two feature edges.
//!
//! ```sh
//! cargo run --example feature_lines -- mesh.obj
//! ```

use std::error::Error;

use sixfold::operators::face_normals;
use sixfold::prelude::*;

mod common;

/// Returns the polylines of all feature edges, as lists of vertices. A closed polyline ends with
/// its first vertex. An edge is a feature edge if it does not have exactly two faces, or if the
/// angle between the normals of its two faces is above `degrees`.
pub fn feature_lines<M: MeshQuery>(mesh: &M, degrees: f32) -> Vec<Vec<M::Vertex>> {
    let features = feature_edges(mesh, degrees);
    let mut lines = Lines {
        mesh,
        features_at: mesh.vertex_map(Vec::new()),
        is_used: mesh.edge_map(false),
    };
    for &e in &features {
        for v in mesh.edge_vertices(e) {
            lines.features_at[v].push(e);
        }
    }
    let ends = mesh.vertices().filter(|&v| lines.features_at[v].len() != 2);
    let ends: Vec<_> = ends.collect();
    let from_ends = ends.into_iter().flat_map(|v| lines.lines_from(v));
    let mut found: Vec<_> = from_ends.collect();
    // The remaining edges form closed lines without branches.
    for e in features {
        let [start, _] = mesh.edge_vertices(e);
        found.extend(lines.line_from(start, e));
    }
    found
}

fn feature_edges<M: MeshQuery>(mesh: &M, degrees: f32) -> Vec<M::Edge> {
    let normals = face_normals(mesh);
    let least_cosine = degrees.to_radians().cos();
    let is_feature = |&e: &M::Edge| {
        let faces: Vec<_> = mesh.edge_faces(e).collect();
        match faces[..] {
            [f, g] => normals[f].dot(normals[g]) < least_cosine,
            _ => true,
        }
    };
    mesh.edges().filter(is_feature).collect()
}

/// The feature edges at each vertex, and the edges that are already part of a polyline.
struct Lines<'m, M: MeshQuery> {
    mesh: &'m M,
    features_at: VertexMap<M, Vec<M::Edge>>,
    is_used: EdgeMap<M, bool>,
}

impl<M: MeshQuery> Lines<'_, M> {
    /// Returns the new polylines that start at `v`.
    fn lines_from(&mut self, v: M::Vertex) -> Vec<Vec<M::Vertex>> {
        let edges = self.features_at[v].clone();
        let lines = edges.into_iter().filter_map(|e| self.line_from(v, e));
        lines.collect()
    }

    /// Returns the polyline that starts at `start` with edge `first`, or `None` if the edge is
    /// already used.
    fn line_from(&mut self, start: M::Vertex, first: M::Edge) -> Option<Vec<M::Vertex>> {
        let mut line = vec![start];
        let mut at = start;
        let mut next = Some(first).filter(|&e| !self.is_used[e]);
        while let Some(e) = next {
            self.is_used[e] = true;
            let [a, b] = self.mesh.edge_vertices(e);
            at = if at == a { b } else { a };
            line.push(at);
            let features = &self.features_at[at];
            let onwards = features.iter().find(|&&other| !self.is_used[other]);
            next = onwards.copied().filter(|_| features.len() == 2);
        }
        (line.len() > 1).then_some(line)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let polygons = common::mesh_argument(sixfold::shapes::cube())?;
    let mesh = HalfEdgeMesh::from_polygons(&polygons)?;
    let lines = feature_lines(&mesh, 30.0);
    let closed = lines.iter().filter(|line| line.first() == line.last());
    println!(
        "{} feature lines, {} of them closed",
        lines.len(),
        closed.count()
    );
    Ok(())
}
