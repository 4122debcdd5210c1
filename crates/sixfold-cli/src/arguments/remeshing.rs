//! Arguments of `sixfold decimate`, `remesh` and `edits`.

use std::path::PathBuf;

use clap::Args;
use sixfold::remeshing::{Boundary, Target};

use super::backend;
use super::reshaping::iterations;
use super::subdivision::parse_name;

const DECIMATE_EXAMPLES: &str = "Examples:
  sixfold decimate --faces 5000 scan.obj -o small.obj
  sixfold decimate --ratio 0.1 scan.obj -o small.obj
  sixfold decimate --ratio 0.5 --boundary fixed terrain.obj -o half.obj

A collapse merges the two ends of an edge into one vertex, at the position with the least error in
the distances to the planes of the faces around it (Garland & Heckbert 1997). It removes two faces,
or one at a boundary, so the result may have one face fewer than the target. Collapses that flip a
face or change the topology are skipped. If only such collapses are left, the mesh is written as it
is, with a note. Triangles only: `sixfold triangulate` cuts polygons.

Exit codes: 0 success, even if the target was not reached; 2 wrong usage or unusable input; 3 the
mesh has polygons, or the backend cannot hold it; 4 interrupted, nothing written.";

/// Make a mesh coarser: collapse the edges with the least error first.
///
/// If the mesh is a manifold, the result is the same on every backend that can hold it, up to the
/// order of vertices and faces; on polygon-soup only if no two vertices move to the same position.
#[derive(Debug, Args)]
#[command(after_help = DECIMATE_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Decimate {
    /// The mesh, an OBJ file of triangles
    #[arg(value_name = "IN.obj")]
    pub(crate) mesh: PathBuf,
    /// The file to write (- for standard output)
    #[arg(short, long, value_name = "OUT.obj")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) goal: Goal,
    /// Boundary: follow (also simplified) or fixed
    #[arg(long, value_name = "RULE", default_value = "follow", value_parser = boundary)]
    pub(crate) boundary: Boundary,
    /// The structure to use
    #[arg(long, value_name = "NAME", default_value = "corner-table", value_parser = backend)]
    pub(crate) backend: String,
}

/// The target size, given in one of two ways.
#[derive(Clone, Copy, Debug, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct Goal {
    /// Target number of faces
    #[arg(long, value_name = "N", value_parser = faces, allow_hyphen_values = true)]
    faces: Option<usize>,
    /// Target as a fraction of the present faces: 0 to 1
    #[arg(long, value_name = "PART", value_parser = ratio, allow_hyphen_values = true)]
    ratio: Option<f64>,
}

impl Goal {
    /// Returns the number of faces as target, or the ratio if no number is given.
    pub(crate) fn target(self) -> Target {
        match self {
            Self {
                faces: Some(faces), ..
            } => Target::Faces(faces),
            Self { ratio, .. } => Target::Ratio(ratio.unwrap_or(1.0)),
        }
    }
}

const REMESH_EXAMPLES: &str = "Examples:
  sixfold remesh --edge-length 0.05 scan.obj -o even.obj
  sixfold remesh --edge-length 0.01 --iterations 5 --max-faces 2000000 scan.obj -o fine.obj

Each iteration splits edges longer than 4/3 of the length, collapses edges shorter than 4/5 of it,
flips edges if that brings valences nearer to six, and moves each vertex in its tangent plane to the
mean of its neighbours (Botsch & Kobbelt 2004). It ends early when almost nothing changes. Vertices
are not projected back to the original surface: the boundary keeps its shape, but sharp edges are
rounded and the mesh shrinks there. Choose a length well below the size of the details to keep. If
--max-faces stops the splitting, the mesh is written as it is, with a note. A length that needs more
faces, estimated from the area and from the edges to split, is refused before the work begins.
Triangles only: `sixfold triangulate` cuts polygons.

Exit codes: 0 success, even if --max-faces stopped it; 2 wrong usage or unusable input; 3 the mesh
has polygons, the backend cannot hold it, or the length needs too many faces; 4 interrupted, nothing
written.";

/// Remesh with edges of one length and nearly equilateral triangles.
///
/// If the mesh is a manifold, the result is the same on every backend that can hold it, up to the
/// order of vertices and faces; on polygon-soup only if no two vertices move to the same position.
#[derive(Debug, Args)]
#[command(after_help = REMESH_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Remesh {
    /// The mesh, an OBJ file of triangles
    #[arg(value_name = "IN.obj")]
    pub(crate) mesh: PathBuf,
    /// The file to write (- for standard output)
    #[arg(short, long, value_name = "OUT.obj")]
    pub(crate) output: PathBuf,
    /// Target edge length, in the units of the file
    #[arg(long, value_name = "LENGTH", value_parser = edge_length, allow_hyphen_values = true)]
    pub(crate) edge_length: f64,
    /// Maximum number of iterations
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = iterations, allow_hyphen_values = true)]
    pub(crate) iterations: usize,
    /// Maximum number of faces: stop splitting there
    #[arg(long, value_name = "N", default_value_t = 10_000_000, value_parser = faces, allow_hyphen_values = true)]
    pub(crate) max_faces: usize,
    /// The structure to use
    #[arg(long, value_name = "NAME", default_value = "corner-table", value_parser = backend)]
    pub(crate) backend: String,
}

const EDITS_EXAMPLES: &str = "Examples:
  sixfold edits
  sixfold edits --json -                     machine-readable

Exit codes: 0 success; 2 wrong usage.";

/// List the edits of each backend, and how much of the mesh they visit.
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

fn edge_length(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(length) if length.is_finite() && length > 0.0 => Ok(length),
        _ => Err("the edge length must be finite and above 0".to_owned()),
    }
}

fn boundary(text: &str) -> Result<Boundary, String> {
    let name = |boundary| match boundary {
        Boundary::Follow => "follow",
        Boundary::Fixed => "fixed",
    };
    parse_name(&[Boundary::Follow, Boundary::Fixed], name, text)
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
        let [count, part] = [(Some(9), None), (None, Some(0.5))]
            .map(|(faces, ratio)| Goal { faces, ratio }.target());
        assert_eq!([count, part], [Target::Faces(9), Target::Ratio(0.5)]);
    }
}
