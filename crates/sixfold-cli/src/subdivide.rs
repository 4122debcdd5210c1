//! `sixfold subdivide`: refines a mesh with a subdivision scheme.

mod forecast;
mod limit;
mod local;

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use rayon::ThreadPoolBuilder;
use sixfold::algorithms::Algorithms;
use sixfold::io::{WriteOptions, read_creases, write_creases};
use sixfold::subdivision::{BoundaryRule, Method, Scheme, Step, Subdivision, SubdivisionError};
use sixfold::{Creases, PolygonMesh, support};

use crate::arguments::Subdivide;
use crate::failure::Failure;
use crate::load;
use crate::mesh_files::{MeshOutput, shown};
use crate::output::{Output, check_not_overwritten, check_outputs, is_stdout};
use crate::progress::{FaceBar, exit_on_interrupt};
use crate::seams::without_seams;
use crate::shape_check::check_faces;
use crate::text::{TextOutput, print_notice, sanitize};
use forecast::Forecast;
use limit::Limits;
use sixfold_results::numbers::{counted, duration, figure, grouped};

pub(crate) fn run(arguments: &Subdivide) -> Result<ExitCode, Failure> {
    exit_on_interrupt();
    let places = [
        ("--output", Some(&arguments.files.output)),
        ("--limit", arguments.limit.as_ref()),
        ("--creases-left", arguments.creases_left.as_ref()),
    ];
    check_outputs(Some(&arguments.files.mesh), &places)?;
    if let Some(creases) = &arguments.creases {
        check_not_overwritten("the crease file", creases, &places)?;
    }
    let data = places.iter().filter_map(|&(_, path)| path);
    let mut text = TextOutput::new(!data.into_iter().any(|path| is_stdout(path)));
    let subdivision = options(arguments)?;
    if let Some(select) = &arguments.select {
        return local::run(arguments, select);
    }
    let method = method(arguments)?;
    let mesh = &arguments.files.mesh;
    let (polygons, mut creases, origin) = load::with_creases(mesh, arguments.read)?;
    check_tags(arguments, &creases)?;
    if let Some(path) = &arguments.creases {
        // The numbers of the list are those of the file, so vertices are joined after it is read.
        let listed = read_creases(path, &polygons).map_err(Failure::usage)?;
        creases = creases.updated_with(&listed);
    }
    let (polygons, creases) = without_seams(mesh, polygons, creases, arguments.read.files);
    let forecast = Forecast::new(
        &subdivision,
        method,
        &arguments.backend,
        &polygons,
        arguments.levels,
        arguments.limit.is_some(),
    )?;
    forecast.check(arguments.force)?;
    // Open the output before the work, so that an unusable path gives an error at once.
    let open = |path: &PathBuf| MeshOutput::open(path, arguments.files.write, origin);
    let output = open(&arguments.files.output)?;
    let limit = arguments.limit.as_ref().map(open).transpose()?;
    let left = Output::open_if(arguments.creases_left.as_ref())?;
    text.print_line(&forecast.describe());
    let bar = FaceBar::new(forecast.new_faces());
    let (step, finished) = refine(arguments, &subdivision, method, &polygons, &creases, &bar)?;
    for level in &finished {
        text.print_line(&level.describe());
    }
    // Compute the limits before writing, so that either all files are written or none.
    let limits = match limit {
        Some(output) => Some((output, Limits::new(&subdivision, &step, arguments.levels)?)),
        None => None,
    };
    let isolated = forecast.isolated_vertices;
    if subdivision.scheme == Scheme::DooSabin && arguments.levels > 0 && isolated > 0 {
        let are = ["vertex without faces is", "vertices without faces are"];
        let vertices = counted(isolated, are[0], are[1]);
        print_notice(&format!("note: {}: {vertices} left out", shown(mesh)));
    }
    // Sharpness that remains belongs to the result, so that a further level continues. Without any in
    // the mesh, only the rule for the boundary makes some, and makes it again.
    let options = match creases.is_empty() {
        true => WriteOptions::default(),
        false => WriteOptions::default().with_creases(&step.creases),
    };
    output.write(&step.polygons, &options)?;
    if let Some(left) = left {
        left.finish(|writer| write_creases(&step.creases, writer))?;
    }
    if let (Some((output, limits)), Some(path)) = (limits, &arguments.limit) {
        limits.write(output)?;
        limits
            .describe(path)
            .iter()
            .for_each(|line| text.print_line(line));
    }
    let place = sanitize(&arguments.files.output.display().to_string());
    let vertices = counted(step.polygons.vertex_count(), "vertex", "vertices");
    let faces = counted(step.polygons.face_count(), "face", "faces");
    let (scheme, backend) = (subdivision.scheme, &arguments.backend);
    text.print_list(
        "",
        [format!(
            "{place}: {vertices}, {faces}; {scheme} by {method} on {backend}"
        )],
    );
    text.finish()?;
    Ok(check_faces(
        polygons.face_count(),
        &step.polygons,
        &arguments.files.output,
    ))
}

/// Returns the scheme with its options. Refuses options that the scheme does not have.
fn options(arguments: &Subdivide) -> Result<Subdivision, Failure> {
    let scheme = arguments.scheme;
    let properties = scheme.properties();
    let unsupported_option = |option: &str, schemes: &str| {
        Failure::unsupported(format!(
            "{scheme} has no option {option}: remove the option, or choose {schemes}"
        ))
    };
    let creases = "catmull-clark or loop";
    if arguments.boundary.is_some() && !properties.creases {
        return Err(unsupported_option("--boundary", creases));
    }
    if arguments.creasing.is_some() && !properties.creases {
        return Err(unsupported_option("--creasing", creases));
    }
    if arguments.creases.is_some() && !properties.creases {
        return Err(unsupported_option("--creases", creases));
    }
    if arguments.loop_weights.is_some() && scheme != Scheme::Loop {
        return Err(unsupported_option("--loop-weights", "loop"));
    }
    if arguments.limit.is_some() && !properties.creases {
        return Err(unsupported_option("--limit", creases));
    }
    if arguments.limit.is_some() && arguments.boundary == Some(BoundaryRule::None) {
        return Err(Failure::unsupported(
            "--limit needs the faces that --boundary none leaves out: remove one of the two options",
        ));
    }
    let defaults = Subdivision::new(scheme);
    Ok(Subdivision {
        boundary: arguments.boundary.unwrap_or(defaults.boundary),
        creasing: arguments.creasing.unwrap_or(defaults.creasing),
        loop_weights: arguments.loop_weights.unwrap_or(defaults.loop_weights),
        ..defaults
    })
}

/// Refuses creases in the mesh file if the scheme has no rules for creases.
fn check_tags(arguments: &Subdivide, creases: &Creases) -> Result<(), Failure> {
    let scheme = arguments.scheme;
    if creases.is_empty() || scheme.properties().creases {
        return Ok(());
    }
    Err(Failure::unsupported(format!(
        "{}: the file has sharp edges or vertices, but {scheme} has no rule for sharpness: remove \
         the lines `t crease` and `t corner`, or choose catmull-clark or loop",
        shown(&arguments.files.mesh)
    )))
}

/// Returns the selected method, or the best method that the backend supports for the scheme.
fn method(arguments: &Subdivide) -> Result<Method, Failure> {
    let Subdivide {
        scheme, backend, ..
    } = arguments;
    let rows = support(*scheme);
    let row = rows.iter().find(|row| row.backend == backend);
    let row = row.ok_or_else(|| Failure::no_backend(backend))?;
    let names: Vec<&str> = row.methods.iter().map(|method| method.name()).collect();
    let names = names.join(" or ");
    if arguments.levels > 1 && !row.holds_result {
        let makes = scheme.properties().makes;
        return Err(Failure::unsupported(format!(
            "{scheme} makes {makes}, but {backend} holds only triangles: choose another backend for level 2"
        )));
    }
    let best = row.default_method();
    let best = best.ok_or_else(|| {
        Failure::unsupported(format!(
            "{scheme} does not run on {backend}: `sixfold schemes` lists other backends"
        ))
    })?;
    match arguments.method.unwrap_or(best) {
        method if row.methods.contains(&method) => match arguments.threads {
            Some(2..) if method != Method::Native => Err(Failure::unsupported(format!(
                "{scheme} by {method} on {backend} runs on one thread: remove --threads, or choose \
                 a native method from `sixfold schemes`"
            ))),
            _ => Ok(method),
        },
        method => Err(Failure::unsupported(format!(
            "{scheme} has no method {method} on {backend}: choose {names}, or see `sixfold schemes`"
        ))),
    }
}

struct FinishedLevel {
    level: u32,
    faces: usize,
    time: Duration,
}

impl FinishedLevel {
    fn describe(&self) -> String {
        let Self { level, faces, time } = self;
        let ns = time.as_nanos() as f64;
        let each = figure(ns / *faces as f64);
        let (faces, time) = (grouped(*faces), duration(ns));
        format!("level {level:<3} {faces:>14} faces  {time:>9}  {each:>6} ns per face")
    }
}

/// Runs the subdivision. Returns the result, and the time of each level.
fn refine(
    arguments: &Subdivide,
    subdivision: &Subdivision,
    method: Method,
    polygons: &PolygonMesh,
    creases: &Creases,
    bar: &FaceBar,
) -> Result<(Step, Vec<FinishedLevel>), Failure> {
    let (backend, threads) = (&arguments.backend, arguments.threads.unwrap_or(0));
    let algorithms = Algorithms::find(backend).ok_or_else(|| Failure::no_backend(backend))?;
    let mut finished = Vec::new();
    let mut start = Instant::now();
    let mut watch = |level, faces| {
        let time = start.elapsed();
        bar.add_level(level, faces);
        finished.push(FinishedLevel { level, faces, time });
        start = Instant::now();
        ControlFlow::Continue(())
    };
    let mut run = || {
        let levels = arguments.levels;
        algorithms.subdivide(subdivision, method, polygons, creases, levels, &mut watch)
    };
    let done = match method {
        Method::Native => {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.map_err(|error| {
                Failure::usage(format!(
                    "{threads} threads cannot be started ({error}): choose fewer --threads"
                ))
            })?;
            pool.install(run)
        }
        _ => run(),
    };
    bar.clear();
    match done {
        Ok(step) => Ok((step, finished)),
        Err(refusal @ SubdivisionError::Build { structure, .. }) => {
            Err(Failure::cannot_hold(structure, refusal))
        }
        Err(refusal) => Err(Failure::unsupported(refusal)),
    }
}
