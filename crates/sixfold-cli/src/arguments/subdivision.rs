//! Arguments of `sixfold schemes` and `sixfold subdivide`.

use std::path::PathBuf;

use clap::Args;
use sixfold::subdivision::{BoundaryRule, Creasing, LoopWeights, Method, Scheme};

use super::{MeshInOut, ReadPolygons, backend};

const EXAMPLES: &str = "Examples:
  sixfold subdivide --scheme catmull-clark --levels 3 cage.obj -o smooth.obj
  sixfold subdivide --scheme loop --levels 2 --creases edges.txt part.obj -o part2.obj
  sixfold subdivide --scheme midpoint --select box:0,0,0,1,1,1 part.obj -o finer.obj
  sixfold subdivide --scheme loop --method scatter --backend polygon-soup in.obj -o out.obj

Schemes: catmull-clark, loop, sqrt3, butterfly, doo-sabin, midpoint, bilinear.

A crease file has lines `edge a b sharpness` and `corner v sharpness`. Vertices are numbered from 0.
A sharpness is inf or a number that is at least 0. The sign # begins a comment. A sharpness below 10
decreases by one per level. A sharpness of 10 or more never decreases. Creases in the OBJ file
(`t crease`, `t corner`) are also used. `sixfold schemes` lists the methods of each backend.

--select refines only some faces, and requires --scheme midpoint:
  faces:FILE              the faces that a file lists, by their numbers in the
                          mesh file, from 0
  box:X0,Y0,Z0,X1,Y1,Z1   the faces that touch a box, in coordinates of the file
  angle:DEGREES           the faces at an edge that bends by more than an angle
Faces next to the refined faces are cut in half, so that the mesh has no gaps.

Exit codes: 0 success; 1 the result has no faces; 2 wrong usage or unusable input; 3 the scheme or
the backend does not support the mesh or an option, or the result is too large; 4 interrupted,
nothing written.";

const SCHEMES_EXAMPLES: &str = "Examples:
  sixfold schemes
  sixfold schemes --json -                   machine-readable

Exit codes: 0 success; 2 wrong usage.";

/// List the subdivision schemes, and the data structures that support each scheme.
#[derive(Debug, Args)]
#[command(after_help = SCHEMES_EXAMPLES)]
pub(crate) struct Schemes {
    /// Write the schemes and the supported methods as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

/// Refine a mesh with a subdivision scheme.
///
/// First prints the size of the result and the memory that the result takes. Stops before the
/// refinement if there is too little free memory.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Subdivide {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    /// The scheme, from the list below
    #[arg(long, value_name = "NAME", default_value = "catmull-clark")]
    pub(crate) scheme: Scheme,
    /// Number of levels
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = levels, allow_hyphen_values = true)]
    pub(crate) levels: u32,
    /// Refine only faces:FILE, box:X0,Y0,Z0,X1,Y1,Z1 or angle:DEGREES
    #[arg(long, value_name = "WHAT", value_parser = select, allow_hyphen_values = true)]
    pub(crate) select: Option<Select>,
    /// The structure to use
    #[arg(long, value_name = "NAME", default_value = "half-edge", value_parser = backend)]
    pub(crate) backend: String,
    /// gather, scatter or native [default: the last supported method]
    #[arg(long, value_name = "NAME")]
    pub(crate) method: Option<Method>,
    /// Number of threads of a native step; 0: one per processor
    #[arg(long, value_name = "N", value_parser = threads, allow_hyphen_values = true)]
    pub(crate) threads: Option<usize>,
    /// Sharp edges and vertices, in addition to those in the mesh file
    #[arg(long, value_name = "FILE")]
    pub(crate) creases: Option<PathBuf>,
    /// Rule for the boundary: edge-and-corner, edge-only or none
    #[arg(long, value_name = "RULE")]
    pub(crate) boundary: Option<BoundaryRule>,
    /// How sharpness decreases: uniform or chaikin
    #[arg(long, value_name = "RULE")]
    pub(crate) creasing: Option<Creasing>,
    /// Weights of the Loop scheme: loop or warren
    #[arg(long, value_name = "WHOSE")]
    pub(crate) loop_weights: Option<LoopWeights>,
    /// Also write limit positions and normals to this file
    #[arg(long, value_name = "LIMIT")]
    pub(crate) limit: Option<PathBuf>,
    /// Also write the remaining sharpness, as a crease file
    #[arg(long, value_name = "FILE")]
    pub(crate) creases_left: Option<PathBuf>,
    /// Continue even if the result takes more than the free memory
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) read: ReadPolygons,
}

/// The faces to refine.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Select {
    /// The faces that a file lists.
    Faces(PathBuf),
    /// The faces that touch a box, given by its lower and its upper corner in the file.
    Box([f64; 3], [f64; 3]),
    /// The faces at an edge that bends by more than this number of degrees.
    Angle(f64),
}

fn select(text: &str) -> Result<Select, String> {
    let wrong = || "write faces:FILE, box:X0,Y0,Z0,X1,Y1,Z1 or angle:DEGREES".to_owned();
    let (kind, rest) = text.split_once(':').ok_or_else(wrong)?;
    let numbers = || {
        let parsed: Result<Vec<f64>, _> = rest.split(',').map(|x| x.trim().parse()).collect();
        let numbers = parsed.map_err(|_| wrong())?;
        match numbers.iter().all(|x| x.is_finite()) {
            true => Ok(numbers),
            false => Err("write only finite numbers".to_owned()),
        }
    };
    match kind {
        "faces" if !rest.is_empty() => Ok(Select::Faces(rest.into())),
        "box" => match numbers()?[..] {
            [x0, y0, z0, x1, y1, z1] if x0 <= x1 && y0 <= y1 && z0 <= z1 => {
                Ok(Select::Box([x0, y0, z0], [x1, y1, z1]))
            }
            [_, _, _, _, _, _] => Err("write the lower corner of the box first".to_owned()),
            _ => Err(wrong()),
        },
        "angle" => match numbers()?[..] {
            [degrees] if (0.0..=180.0).contains(&degrees) => Ok(Select::Angle(degrees)),
            [_] => Err("the angle must be from 0 to 180 degrees".to_owned()),
            _ => Err(wrong()),
        },
        _ => Err(wrong()),
    }
}

/// Parses a number of levels. The limit is larger than the number of times that a 32-bit coordinate
/// can be halved.
fn levels(text: &str) -> Result<u32, String> {
    const MAX_LEVELS: u32 = 1000;
    match text.trim().parse() {
        Ok(levels) if levels <= MAX_LEVELS => Ok(levels),
        _ => Err(format!(
            "the number of levels must be from 0 to {MAX_LEVELS}"
        )),
    }
}

/// Parses a number of threads. The limit exceeds what any machine can use.
fn threads(text: &str) -> Result<usize, String> {
    let parsed: Result<usize, _> = text.trim().parse();
    match parsed {
        Ok(threads) if threads <= 1024 => Ok(threads),
        _ => Err("the number of threads must be from 0 to 1024".to_owned()),
    }
}
