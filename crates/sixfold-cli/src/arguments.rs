//! What can be asked for.

mod render;

use std::path::PathBuf;
use std::time::Duration;

use ::study::Operation;
use clap::{Args, Parser, Subcommand};
use sixfold::shapes::Order;
use sixfold::subdivision::{Boundary, Creasing, LoopWeights, Method, Scheme};

pub(crate) use render::Render;

const EXAMPLES: &str = "Examples:
  sixfold                                    study the built-in mesh
  sixfold study bunny.obj                    study your own
  sixfold inspect bunny.obj                  what it is, and which backends can hold it
  sixfold generate geodesic frequency=20 -o ball.obj

Exit codes: 0 done; 1 done, and the answer is no; 2 wrong usage or unusable input;
3 not supported by this backend or scheme; 4 interrupted, finished part kept.";

/// What help on `study` says before the names.
pub(crate) const STUDY_EXAMPLES: &str = "Examples:
  sixfold study bunny.obj
  sixfold study bunny.obj --backends half-edge,face-vertex --operations vv_smooth,build
  sixfold study quads.obj --triangulate --budget 2m
  sixfold study bunny.obj --json - --csv bunny.csv

How it measures: every round runs each operation on each backend, one after the other, in random
order, on the processor time of the thread; the table shows medians. The seed decides that order
and which elements are sampled; how many is decided by the clock. Ctrl-C ends it between two
samples and keeps what is finished. A second Ctrl-C ends it at once, with code 130.

Exit codes: 0 done; 1 backends found different results, a fault in Sixfold; 2 wrong usage or
unusable input; 3 no backend asked for can hold the mesh; 4 interrupted, finished part kept.";

const INSPECT_EXAMPLES: &str = "Examples:
  sixfold inspect bunny.obj
  sixfold inspect bunny.obj --json -         for machines

Exit codes: 0 done; 2 wrong usage or unusable input; 4 interrupted.";

const SUBDIVIDE_EXAMPLES: &str = "Examples:
  sixfold subdivide --scheme catmull-clark --levels 3 cage.obj -o smooth.obj
  sixfold subdivide --scheme loop --levels 2 --creases edges.txt part.obj -o part2.obj
  sixfold subdivide --scheme midpoint --select box:0,0,0,1,1,1 part.obj -o finer.obj
  sixfold subdivide --scheme loop --method scatter --backend polygon-soup in.obj -o out.obj

A crease file has lines `edge a b sharpness` and `corner v sharpness`: vertices from 0, sharpness a
number from 0 on, or inf; # begins a comment. From 10 on an edge is sharp for ever, below it gets
smoother by one a level. What an OBJ file says of creases (t crease, t corner) holds as well.
`sixfold schemes` lists what runs on which backend.

Exit codes: 0 done; 2 wrong usage or unusable input; 3 the scheme or the backend does not support
the mesh or the option; 4 interrupted, nothing written.";

/// Which mesh data structure fits this mesh and this workload? Measured, with evidence.
///
/// Builds every backend from the same mesh, runs the same operations on each and compares.
/// Without a command it studies a built-in mesh of about 20,000 triangles for about 20 seconds.
#[derive(Debug, Parser)]
#[command(name = "sixfold", version, after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Measure what each backend costs for a mesh
    Study(Study),
    /// Say what a mesh is, and which backends can hold it
    Inspect(Inspect),
    /// Write a built-in shape
    Generate(Generate),
    /// Say what subdivision schemes there are, and what runs on which backend
    Schemes(Schemes),
    /// Refine a mesh by a subdivision scheme
    Subdivide(Subdivide),
    /// Draw meshes with their edges and creases, as PNG or SVG
    Render(Render),
}

/// Measure what each backend costs for a mesh.
///
/// Prints the mesh in facts, who can hold it, and for each backend the time of every operation and
/// the bytes for each vertex.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Study {
    /// The mesh, an OBJ file; without it a built-in mesh of about 20,000 triangles
    #[arg(value_name = "FILE.obj")]
    pub(crate) mesh: Option<PathBuf>,
    /// Only these backends, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// Only these operations, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = operation)]
    pub(crate) operations: Vec<Operation>,
    /// How long to measure: 20s, 500ms, 2m
    #[arg(long, value_name = "TIME", default_value = "20s", value_parser = duration, allow_hyphen_values = true)]
    pub(crate) budget: Duration,
    /// What decides the order, and which elements are sampled
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Cut every polygon into a fan of triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Refuse a file with degenerate faces instead of leaving them out
    #[arg(long)]
    pub(crate) strict: bool,
    /// Write everything as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Write one line for each result as CSV (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
}

impl Default for Study {
    fn default() -> Self {
        let settings = ::study::Settings::default();
        Self {
            mesh: None,
            backends: Vec::new(),
            operations: Vec::new(),
            budget: settings.budget,
            seed: settings.seed,
            triangulate: false,
            strict: false,
            json: None,
            csv: None,
        }
    }
}

/// Say what a mesh is, and which backends can hold it.
///
/// Measures nothing. Faces that name a vertex twice, or have fewer than three corners, are counted.
#[derive(Debug, Args)]
#[command(after_help = INSPECT_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Inspect {
    /// The mesh, an OBJ file
    #[arg(value_name = "FILE.obj")]
    pub(crate) mesh: PathBuf,
    /// Write the facts and verdicts as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

/// Write a built-in shape.
#[derive(Debug, Args)]
pub(crate) struct Generate {
    /// The shape: see the list below
    #[arg(value_name = "SHAPE")]
    pub(crate) shape: String,
    /// Its parameters
    #[arg(value_name = "name=value", value_parser = setting)]
    pub(crate) settings: Vec<(String, f64)>,
    /// Its order: given, shuffled, morton, breadth-first
    #[arg(long, value_name = "ORDER", default_value = "given")]
    pub(crate) order: Order,
    /// What decides the order `shuffled`
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Where to write it (- for standard output)
    #[arg(short, long, value_name = "FILE.obj")]
    pub(crate) output: PathBuf,
}

/// Say what subdivision schemes there are, and what runs on which backend.
#[derive(Debug, Args)]
pub(crate) struct Schemes {
    /// Write both tables as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

/// Refine a mesh by a subdivision scheme.
///
/// Says beforehand how large the result is and what memory it takes, and refuses what the machine
/// does not have.
#[derive(Debug, Args)]
#[command(after_help = SUBDIVIDE_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Subdivide {
    /// The mesh, an OBJ file
    #[arg(value_name = "IN.obj")]
    pub(crate) mesh: PathBuf,
    /// Where to write the result (- for standard output)
    #[arg(short, long, value_name = "OUT.obj")]
    pub(crate) output: PathBuf,
    /// catmull-clark, loop, sqrt3, butterfly, doo-sabin, midpoint or bilinear
    #[arg(long, value_name = "NAME", default_value = "catmull-clark", value_parser = scheme)]
    pub(crate) scheme: Scheme,
    /// How many steps to take
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) levels: u32,
    /// Refine only some triangles, and their neighbours as far as it takes to leave no gaps:
    /// faces:FILE (numbers from 0), box:X0,Y0,Z0,X1,Y1,Z1 or angle:DEGREES
    #[arg(long, value_name = "WHAT", value_parser = select, allow_hyphen_values = true)]
    pub(crate) select: Option<Select>,
    /// The structure to do it with
    #[arg(long, value_name = "NAME", default_value = "half-edge", value_parser = backend)]
    pub(crate) backend: String,
    /// gather, scatter or native; without it the last of these that the backend has
    #[arg(long, value_name = "NAME", value_parser = method)]
    pub(crate) method: Option<Method>,
    /// Threads of a native step; 0 for as many as there are processors
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = threads)]
    pub(crate) threads: usize,
    /// Sharp edges and vertices, beside those that the mesh file tells
    #[arg(long, value_name = "FILE")]
    pub(crate) creases: Option<PathBuf>,
    /// edge-and-corner, edge-only or none
    #[arg(long, value_name = "RULE", value_parser = boundary)]
    pub(crate) boundary: Option<Boundary>,
    /// uniform or chaikin
    #[arg(long, value_name = "RULE", value_parser = creasing)]
    pub(crate) creasing: Option<Creasing>,
    /// loop or warren
    #[arg(long, value_name = "WHOSE", value_parser = loop_weights)]
    pub(crate) loop_weights: Option<LoopWeights>,
    /// Write the result at its limit positions, with limit normals, here as well
    #[arg(long, value_name = "LIMIT.obj")]
    pub(crate) limit: Option<PathBuf>,
    /// Write the sharpness that is left, as a crease file
    #[arg(long, value_name = "FILE")]
    pub(crate) creases_left: Option<PathBuf>,
    /// Go on where the result is larger than the memory that is free
    #[arg(long)]
    pub(crate) force: bool,
}

/// Which faces to refine.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Select {
    /// Those that a file lists.
    Faces(PathBuf),
    /// Those that touch a box: its lower and its upper corner.
    Box([f32; 3], [f32; 3]),
    /// Those at an edge that bends by more than so many degrees.
    Angle(f32),
}

fn select(text: &str) -> Result<Select, String> {
    let wrong = || "write faces:FILE, box:X0,Y0,Z0,X1,Y1,Z1 or angle:DEGREES".to_owned();
    let (kind, rest) = text.split_once(':').ok_or_else(wrong)?;
    let numbers = || {
        let parsed: Result<Vec<f32>, _> = rest.split(',').map(|x| x.trim().parse()).collect();
        let numbers = parsed.map_err(|_| wrong())?;
        match numbers.iter().all(|x| x.is_finite()) {
            true => Ok(numbers),
            false => Err("numbers must be finite".to_owned()),
        }
    };
    match kind {
        "faces" if !rest.is_empty() => Ok(Select::Faces(rest.into())),
        "box" => match numbers()?[..] {
            [x0, y0, z0, x1, y1, z1] if x0 <= x1 && y0 <= y1 && z0 <= z1 => {
                Ok(Select::Box([x0, y0, z0], [x1, y1, z1]))
            }
            [_, _, _, _, _, _] => Err("the lower corner of a box comes first".to_owned()),
            _ => Err(wrong()),
        },
        "angle" => match numbers()?[..] {
            [degrees] if (0.0..=180.0).contains(&degrees) => Ok(Select::Angle(degrees)),
            [_] => Err("an angle is from 0 to 180 degrees".to_owned()),
            _ => Err(wrong()),
        },
        _ => Err(wrong()),
    }
}

/// The item of `all` that is called `text`.
fn named<T: Copy>(all: &[T], name: impl Fn(T) -> &'static str, text: &str) -> Result<T, String> {
    let found = all.iter().find(|&&item| name(item) == text.trim());
    let names = || all.iter().map(|&item| name(item)).collect::<Vec<_>>();
    found.copied().ok_or_else(|| format!("choose from {}", names().join(", ")))
}

fn scheme(text: &str) -> Result<Scheme, String> {
    named(&Scheme::ALL, Scheme::name, text)
}

fn method(text: &str) -> Result<Method, String> {
    named(&Method::ALL, Method::name, text)
}

fn boundary(text: &str) -> Result<Boundary, String> {
    named(&Boundary::ALL, Boundary::name, text)
}

fn creasing(text: &str) -> Result<Creasing, String> {
    named(&Creasing::ALL, Creasing::name, text)
}

fn loop_weights(text: &str) -> Result<LoopWeights, String> {
    named(&LoopWeights::ALL, LoopWeights::name, text)
}

/// No more threads than any machine has use for.
fn threads(text: &str) -> Result<usize, String> {
    let parsed: Result<usize, _> = text.trim().parse();
    match parsed {
        Ok(threads) if threads <= 1024 => Ok(threads),
        _ => Err("a number of threads is from 0 to 1024".to_owned()),
    }
}

fn backend(name: &str) -> Result<String, String> {
    let settings = ::study::Settings {
        backends: vec![name.trim().into()],
        ..Default::default()
    };
    match settings.chosen_backends() {
        Ok(_) => Ok(name.trim().into()),
        Err(error) => Err(error.to_string()),
    }
}

fn operation(name: &str) -> Result<Operation, String> {
    let parsed: Result<Operation, _> = name.trim().parse();
    parsed.map_err(|error| error.to_string())
}

/// `20s`, `500ms`, `2m`: more than nothing, and at most a week.
fn duration(text: &str) -> Result<Duration, String> {
    const LONGEST_S: f64 = 7.0 * 24.0 * 3600.0;
    let units = [("ms", 1e-3), ("s", 1.0), ("m", 60.0)];
    let parsed = units.into_iter().find_map(|(unit, seconds)| {
        let number: f64 = text.strip_suffix(unit)?.parse().ok()?;
        Some(number * seconds)
    });
    match parsed {
        Some(seconds) if seconds > 0.0 && seconds <= LONGEST_S => {
            Ok(Duration::from_secs_f64(seconds))
        }
        Some(_) => Err("a budget is more than nothing and at most a week".into()),
        None => Err("write a budget as 20s, 500ms or 2m".into()),
    }
}

fn seed(text: &str) -> Result<u64, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| format!("a seed is a whole number from 0 to {}", u64::MAX))
}

fn setting(text: &str) -> Result<(String, f64), String> {
    let wrong = || format!("write a parameter as name=number, not `{text}`");
    let (name, value) = text.split_once('=').ok_or_else(wrong)?;
    let value = value.trim().parse().map_err(|_| wrong())?;
    Ok((name.trim().into(), value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn budgets_have_a_unit_and_are_more_than_nothing() {
        for (text, milliseconds) in [
            ("20s", 20_000),
            ("500ms", 500),
            ("2m", 120_000),
            ("1.5s", 1500),
        ] {
            assert_eq!(duration(text), Ok(Duration::from_millis(milliseconds)));
        }
        for text in [
            "",
            "20",
            "s",
            "-1s",
            "0s",
            "nans",
            "infs",
            "1e300m",
            "20 minutes",
        ] {
            assert!(duration(text).is_err(), "{text}");
        }
    }
}
