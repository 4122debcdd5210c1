//! What `sixfold decimate`, `remesh` and `edits` can be asked for.

use std::path::PathBuf;

use clap::Args;
use sixfold::remeshing::{Boundary, Target};

use super::backend;
use super::reshaping::iterations;
use super::subdivision::named;

const DECIMATE_EXAMPLES: &str = "Examples:
  sixfold decimate --faces 5000 scan.obj -o small.obj
  sixfold decimate --ratio 0.1 scan.obj -o small.obj
  sixfold decimate --ratio 0.5 --boundary fixed terrain.obj -o half.obj

A collapse makes one vertex of the two ends of an edge, where the distances to the planes of the
faces around are least (Garland & Heckbert 1997), and takes two faces away, or one at a boundary: so
there may be one face fewer than asked for. None is done that turns a face over or changes what is
connected; if nothing else is left, the mesh is written as it is then, and a note says so.
Triangles only: `sixfold triangulate` cuts polygons.

Exit codes: 0 done, as far as it goes; 2 wrong usage or unusable input; 3 the mesh has polygons, or
the backend does not hold it; 4 interrupted, nothing written.";

/// Make a mesh coarser: collapse edges, the least harmful first.
///
/// The result is the same on every backend that holds the mesh, if it is a manifold, up to the order of
/// vertices and faces; on polygon-soup only where no two vertices come to one place.
#[derive(Debug, Args)]
#[command(after_help = DECIMATE_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Decimate {
    /// The mesh, an OBJ file of triangles
    #[arg(value_name = "IN.obj")]
    pub(crate) mesh: PathBuf,
    /// Where to write the result (- for standard output)
    #[arg(short, long, value_name = "OUT.obj")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) goal: Goal,
    /// The boundary: follow, simplified as well, or fixed
    #[arg(long, value_name = "RULE", default_value = "follow", value_parser = boundary)]
    pub(crate) boundary: Boundary,
    /// The structure to do it with
    #[arg(long, value_name = "NAME", default_value = "corner-table", value_parser = backend)]
    pub(crate) backend: String,
}

/// How far to go, in one of two ways.
#[derive(Clone, Copy, Debug, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct Goal {
    /// Down to so many faces
    #[arg(long, value_name = "N", value_parser = faces, allow_hyphen_values = true)]
    faces: Option<usize>,
    /// Down to this part of the faces there are: 0 to 1
    #[arg(long, value_name = "PART", value_parser = ratio, allow_hyphen_values = true)]
    ratio: Option<f64>,
}

impl Goal {
    /// As the operator takes it; a ratio where no number of faces is given.
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

Each iteration splits edges longer than 4/3 of the length, collapses those shorter than 4/5 of it,
flips edges where that brings valences nearer to six, and moves vertices in their tangent planes to
the middle of their neighbours (Botsch & Kobbelt 2004), until next to nothing changes. There is no
projection back to the original: the boundary keeps its shape, but sharp edges are rounded and the
mesh shrinks there, so choose a length well below what is to stay. Where splitting reaches
--max-faces for good, the mesh is written as it is then, and a note says so; a length that would
take more by the area, or by the edges to be split, is refused at once.
Triangles only: `sixfold triangulate` cuts polygons.

Exit codes: 0 done, as far as it goes; 2 wrong usage or unusable input; 3 the mesh has polygons, the
backend does not hold it, or the length takes too many faces; 4 interrupted, nothing written.";

/// Make all edges about as long as asked, and all triangles about regular.
///
/// The result is the same on every backend that holds the mesh, if it is a manifold, up to the order of
/// vertices and faces; on polygon-soup only where no two vertices come to one place.
#[derive(Debug, Args)]
#[command(after_help = REMESH_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Remesh {
    /// The mesh, an OBJ file of triangles
    #[arg(value_name = "IN.obj")]
    pub(crate) mesh: PathBuf,
    /// Where to write the result (- for standard output)
    #[arg(short, long, value_name = "OUT.obj")]
    pub(crate) output: PathBuf,
    /// How long edges should be, in the units of the file
    #[arg(long, value_name = "LENGTH", value_parser = edge_length, allow_hyphen_values = true)]
    pub(crate) edge_length: f64,
    /// How often to split, collapse, flip and smooth, at most
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = iterations, allow_hyphen_values = true)]
    pub(crate) iterations: usize,
    /// Split no further than to so many faces
    #[arg(long, value_name = "N", default_value_t = 10_000_000, value_parser = faces, allow_hyphen_values = true)]
    pub(crate) max_faces: usize,
    /// The structure to do it with
    #[arg(long, value_name = "NAME", default_value = "corner-table", value_parser = backend)]
    pub(crate) backend: String,
}

const EDITS_EXAMPLES: &str = "Examples:
  sixfold edits
  sixfold edits --json -                     for machines

Exit codes: 0 done; 2 wrong usage.";

/// Say what edits each backend offers, and how much of the mesh they look at.
#[derive(Debug, Args)]
#[command(after_help = EDITS_EXAMPLES)]
pub(crate) struct Edits {
    /// Write the table as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

fn faces(text: &str) -> Result<usize, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| format!("a number of faces is from 0 to {}", usize::MAX))
}

fn ratio(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(ratio) if (0.0..=1.0).contains(&ratio) => Ok(ratio),
        _ => Err("a ratio is from 0 to 1: the part of the faces to keep".to_owned()),
    }
}

fn edge_length(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(length) if length.is_finite() && length > 0.0 => Ok(length),
        _ => Err("an edge length is a number above 0, and finite".to_owned()),
    }
}

fn boundary(text: &str) -> Result<Boundary, String> {
    let name = |boundary| match boundary {
        Boundary::Follow => "follow",
        Boundary::Fixed => "fixed",
    };
    named(&[Boundary::Follow, Boundary::Fixed], name, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_mean_nothing_are_refused() {
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
    fn a_goal_is_one_of_two() {
        let [count, part] = [(Some(9), None), (None, Some(0.5))]
            .map(|(faces, ratio)| Goal { faces, ratio }.target());
        assert_eq!([count, part], [Target::Faces(9), Target::Ratio(0.5)]);
    }
}
