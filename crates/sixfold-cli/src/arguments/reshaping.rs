//! Arguments of `sixfold smooth`, `dual` and `triangulate`.

use clap::Args;
use sixfold::operators::{SmoothingBoundary, Weights};
use sixfold::repair::Facing;

use super::{MeshInOut, ReadFiles, ReadPolygons, ShapeCheck, backend};

const SMOOTH_EXAMPLES: &str = "Examples:
  sixfold smooth scan.obj -o smooth.obj
  sixfold smooth scan.obj --weights cotangent --iterations 50 -o smooth.obj
  sixfold smooth scan.obj --step 0.33 --step-back=-0.34 -o smooth.obj    keeps the volume

Exit codes: 0 success; 1 the result has no faces, or with --check, the shape has changed; 2 wrong usage or unusable input;
3 the weights or the backend do not support the mesh; 4 interrupted, nothing written.";

/// Move vertices towards their neighbours.
///
/// The connectivity does not change.
#[derive(Debug, Args)]
#[command(after_help = SMOOTH_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Smooth {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    /// Weights of the neighbours: uniform or cotangent
    #[arg(long, value_name = "WHICH", default_value = "uniform")]
    pub(crate) weights: Weights,
    /// Boundary: fixed, or curve (smoothed as a curve)
    #[arg(long, value_name = "RULE", default_value = "fixed")]
    pub(crate) boundary: SmoothingBoundary,
    /// Number of iterations
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = iterations, allow_hyphen_values = true)]
    pub(crate) iterations: usize,
    /// Fraction of the way to the mean of the neighbours: 0 to 1
    #[arg(
        long,
        value_name = "PART",
        default_value_t = 0.5,
        allow_hyphen_values = true
    )]
    pub(crate) step: f64,
    /// Second step to keep the volume: negative, and larger in size than --step
    #[arg(long, value_name = "PART", allow_hyphen_values = true)]
    pub(crate) step_back: Option<f64>,
    #[command(flatten)]
    pub(crate) check: ShapeCheck,
    /// The structure to use
    #[arg(long, value_name = "NAME", default_value = "half-edge", value_parser = backend)]
    pub(crate) backend: String,
    #[command(flatten)]
    pub(crate) read: ReadPolygons,
}

const DUAL_EXAMPLES: &str = "Examples:
  sixfold dual icosahedron.obj -o dodecahedron.obj

Exit codes: 0 success; 1 the result has no faces; 2 wrong usage or unusable input; 3 the mesh has no
dual, or the backend cannot hold it; 4 interrupted, nothing written.";

/// Turn each face into a vertex, and each vertex into a face.
///
/// The mesh must be a closed, oriented manifold.
#[derive(Debug, Args)]
#[command(after_help = DUAL_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Dual {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    /// The structure to use
    #[arg(long, value_name = "NAME", default_value = "half-edge", value_parser = backend)]
    pub(crate) backend: String,
    #[command(flatten)]
    pub(crate) read: ReadPolygons,
}

const TRIANGULATE_EXAMPLES: &str = "Examples:
  sixfold triangulate plan.obj -o triangles.obj
  sixfold triangulate scan.obj --orient outward -o consistent.obj

Exit codes: 0 success; 1 the result has no faces; 2 wrong usage or unusable input; 4 interrupted,
nothing written.";

/// Cut polygons into triangles.
///
/// The mesh keeps its vertices. Triangles have the orientation of their polygons.
#[derive(Debug, Args)]
#[command(after_help = TRIANGULATE_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Triangulate {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    /// Flip faces to one orientation: majority (of the faces) or outward
    #[arg(long, value_name = "RULE")]
    pub(crate) orient: Option<Facing>,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

pub(super) fn iterations(text: &str) -> Result<usize, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| format!("the number of iterations must be from 0 to {}", usize::MAX))
}
