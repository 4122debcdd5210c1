//! Arguments of `sixfold decimate`, `remesh` and `edits`.

use std::path::PathBuf;

use clap::Args;
use sixfold::remeshing::{DecimationBoundary, Target};

use super::reshaping::iterations;
use super::{MeshInOut, ReadPolygons, ShapeCheck, backend};

const DECIMATE_EXAMPLES: &str = "Examples:
  sixfold decimate --faces 5000 scan.obj -o small.obj
  sixfold decimate --ratio 0.1 scan.obj -o small.obj
  sixfold decimate --ratio 0.5 --boundary fixed terrain.obj -o half.obj
  sixfold decimate --max-error 0.01 scan.obj -o close.obj

A collapse merges the two ends of an edge into one vertex. The new vertex has the position with the
least error. The error is the sum of the squared distances to the planes of the faces around the
edge (Garland & Heckbert 1997). A collapse removes two faces, or one face at a boundary. The result
may therefore have one face fewer than the target. Collapses that flip a face or change the topology
are skipped. If only such collapses are left, decimation ends above the target, and a note says so.
Edges with three or more faces are collapsed along their curve, on backends that hold such meshes.

With --max-error, collapses are skipped if a vertex, the middle of an edge or the centroid of a face
of the mesh would be farther than the distance from the result, or one of the result farther from the
mesh. Then 100,000 other points of each are measured, as by `sixfold distance`; if one is farther,
the decimation is repeated with a smaller distance. Without --faces and --ratio, all collapses that
the distance allows are done.
All faces must be triangles; `sixfold triangulate` cuts polygons into triangles.

Exit codes: 0 success, even if the target was not reached; 1 with --check, the shape has changed;
2 wrong usage or unusable input; 3 the mesh has faces that are not triangles, or the backend cannot
hold the mesh; 4 interrupted, nothing written.";

/// Make a mesh coarser: collapse the edges with the least error first.
///
/// If the mesh is a manifold, all backends that can hold the mesh give the same result, up to the
/// order of vertices and faces. The result of polygon-soup differs if two vertices move to the same
/// position.
#[derive(Debug, Args)]
#[command(
    after_help = DECIMATE_EXAMPLES,
    verbatim_doc_comment,
    override_usage = "sixfold decimate [OPTIONS] -o <OUT> <GOAL> <MESH>",
    mut_arg("mesh", |arg| arg.help("The mesh, with triangles only (- for standard input)"))
)]
pub(crate) struct Decimate {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    #[command(flatten)]
    pub(crate) goal: Goal,
    /// Boundary: follow (simplify the boundary too) or fixed
    #[arg(long, value_name = "RULE", default_value = "follow")]
    pub(crate) boundary: DecimationBoundary,
    #[command(flatten)]
    pub(crate) check: ShapeCheck,
    /// The structure to use
    #[arg(long, value_name = "NAME", default_value = "corner-table", value_parser = backend)]
    pub(crate) backend: String,
    #[command(flatten)]
    pub(crate) read: ReadPolygons,
}

/// The heading of the options of a [`Goal`] in the help.
const GOAL: &str = "Goal (one or more)";

/// The target size, given in one of two ways, and the largest distance.
#[derive(Clone, Copy, Debug, Args)]
#[group(required = true, multiple = true)]
pub(crate) struct Goal {
    /// Target number of faces
    #[arg(
        long,
        value_name = "N",
        value_parser = faces,
        allow_hyphen_values = true,
        conflicts_with = "ratio",
        help_heading = GOAL
    )]
    faces: Option<usize>,
    /// Target as a fraction of the present faces: 0 to 1
    #[arg(
        long,
        value_name = "PART",
        value_parser = ratio,
        allow_hyphen_values = true,
        help_heading = GOAL
    )]
    ratio: Option<f64>,
    /// Largest distance between the mesh and the result, in units of the coordinates
    #[arg(
        long,
        value_name = "DISTANCE",
        value_parser = max_error,
        allow_hyphen_values = true,
        help_heading = GOAL
    )]
    pub(crate) max_error: Option<f64>,
}

impl Goal {
    /// Returns the number of faces or the ratio as target; no faces if only a distance is given.
    pub(crate) fn target(self) -> Target {
        match self {
            Self {
                faces: Some(faces), ..
            } => Target::Faces(faces),
            Self {
                ratio: Some(ratio), ..
            } => Target::Ratio(ratio),
            _ => Target::Faces(0),
        }
    }
}

const REMESH_EXAMPLES: &str = "Examples:
  sixfold remesh scan.obj -o even.obj
  sixfold remesh --edge-length 0.05 scan.obj -o even.obj
  sixfold remesh --edge-length 0.01 --iterations 5 --max-faces 2000000 scan.obj -o fine.obj

Each iteration has four steps (Botsch & Kobbelt 2004):
  - Split the edges that are longer than 4/3 of the target edge length.
  - Collapse the edges that are shorter than 4/5 of the target edge length.
  - Flip edges if the flip brings valences nearer to six.
  - Move each vertex in its tangent plane to the mean of its neighbours.
The command stops early when almost nothing changes.

Vertices are not projected back to the original surface. The boundary keeps its shape, but sharp
edges become rounded, and the mesh shrinks there. Choose an edge length well below the size of the
details that you want to keep.

Before the work begins, the command estimates the number of faces from the area of the mesh and from
the edges to split. If the estimate is above --max-faces, the edge length is refused. If the number
of faces reaches --max-faces later, splitting stops; the mesh is written, and a note is printed. All
faces must be triangles; `sixfold triangulate` cuts polygons into triangles.

Exit codes: 0 success, even if --max-faces stopped the splitting; 1 with --check, the shape has
changed; 2 wrong usage or unusable input; 3 the mesh has faces that are not triangles, the backend cannot hold the mesh, or the edge length
needs too many faces; 4 interrupted, nothing written.";

/// Replace the triangles of a mesh by nearly equilateral triangles of one size.
///
/// If the mesh is a manifold, all backends that can hold the mesh give the same result, up to the
/// order of vertices and faces. The result of polygon-soup differs if two vertices move to the same
/// position.
#[derive(Debug, Args)]
#[command(
    after_help = REMESH_EXAMPLES,
    verbatim_doc_comment,
    mut_arg("mesh", |arg| arg.help("The mesh, with triangles only (- for standard input)"))
)]
pub(crate) struct Remesh {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    /// Target edge length, in the units of the file [default: the mean of the mesh]
    #[arg(long, value_name = "LENGTH", value_parser = edge_length, allow_hyphen_values = true)]
    pub(crate) edge_length: Option<f64>,
    /// Maximum number of iterations
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = iterations, allow_hyphen_values = true)]
    pub(crate) iterations: usize,
    /// Stop splitting at this number of faces
    #[arg(long, value_name = "N", default_value_t = 10_000_000, value_parser = faces, allow_hyphen_values = true)]
    pub(crate) max_faces: usize,
    #[command(flatten)]
    pub(crate) check: ShapeCheck,
    /// The structure to use
    #[arg(long, value_name = "NAME", default_value = "corner-table", value_parser = backend)]
    pub(crate) backend: String,
    #[command(flatten)]
    pub(crate) read: ReadPolygons,
}

const EDITS_EXAMPLES: &str = "Examples:
  sixfold edits
  sixfold edits --json -                     machine-readable

Exit codes: 0 success; 2 wrong usage.";

/// List the edits of each data structure, and how much of the mesh each edit visits.
#[derive(Debug, Args)]
#[command(after_help = EDITS_EXAMPLES)]
pub(crate) struct Edits {
    /// Write the table as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

fn faces(text: &str) -> Result<usize, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| format!("the number of faces must be from 0 to {}", usize::MAX))
}

fn ratio(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(ratio) if (0.0..=1.0).contains(&ratio) => Ok(ratio),
        _ => Err("the ratio must be from 0 to 1: the fraction of faces to keep".to_owned()),
    }
}

fn max_error(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(distance) if distance.is_finite() && distance >= 0.0 => Ok(distance),
        _ => Err("the distance must be finite and at least 0".to_owned()),
    }
}

fn edge_length(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(length) if length.is_finite() && length > 0.0 => Ok(length),
        _ => Err("the edge length must be finite and above 0".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_numbers_are_refused() {
        for text in ["", "-0.1", "1.0001", "nan", "inf", "half", "10%"] {
            assert!(ratio(text).is_err(), "{text}");
        }
        for text in ["", "0", "-0", "-1", "nan", "inf", "-inf", "1e999", "1,5"] {
            assert!(edge_length(text).is_err(), "{text}");
        }
        for text in ["", "-1", "1.5", "1e3", "99999999999999999999"] {
            assert!(faces(text).is_err(), "{text}");
        }
        assert_eq!(["0", "1", " 0.25 "].map(ratio), [0.0, 1.0, 0.25].map(Ok));
        assert_eq!(["1e-30", "1e30"].map(edge_length), [1e-30, 1e30].map(Ok));
        assert_eq!(["0", "5000"].map(faces), [0, 5000].map(Ok));
    }

    #[test]
    fn a_goal_is_a_number_or_a_ratio() {
        let goals = [(Some(9), None), (None, Some(0.5)), (None, None)];
        let targets = goals.map(|(faces, ratio)| {
            let max_error = Some(0.1);
            Goal {
                faces,
                ratio,
                max_error,
            }
            .target()
        });
        let expected = [Target::Faces(9), Target::Ratio(0.5), Target::Faces(0)];
        assert_eq!(targets, expected);
    }
}
