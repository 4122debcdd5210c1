//! The option `--select`: refines only some triangles.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use sixfold::algorithms::Algorithms;
use sixfold::glam::DVec3;
use sixfold::io::WriteOptions;
use sixfold::subdivision::{LocalError, LocalMesh, Scheme, Selection};
use sixfold::{FaceId, PolygonMesh};

use crate::arguments::{Select, Subdivide};
use crate::failure::Failure;
use crate::load::{self, FaceNumbers, NumberedMesh};
use crate::mesh_files::{MeshOutput, shown};
use crate::output::{check_not_overwritten, is_stdout};
use crate::progress::Spinner;
use crate::seams::joined;
use crate::shape_check::check_faces;
use crate::text::{TextOutput, print_notice, print_places, sanitize};
use sixfold_results::numbers::{counted, grouped};

use super::check_tags;
use super::forecast::check_memory;

pub(super) fn run(arguments: &Subdivide, select: &Select) -> Result<ExitCode, Failure> {
    check_options(arguments)?;
    if let Select::Faces(path) = select {
        let outputs = [("--output", Some(&arguments.files.output))];
        check_not_overwritten("the list of faces", path, &outputs)?;
    }
    let mesh = &arguments.files.mesh;
    let NumberedMesh {
        mut polygons,
        creases,
        origin,
        mut numbers,
    } = load::with_face_numbers(mesh, arguments.read)?;
    check_tags(arguments, &creases)?;
    if let Some(joined) = joined(mesh, &polygons, arguments.read.files) {
        let old = |f| joined.faces.old_elements(f)[0];
        numbers = numbers.after(joined.polygons.face_count(), old);
        polygons = joined.polygons;
    }
    let selection = selection(select, &numbers, origin)?;
    selection
        .check(polygons.face_count())
        .map_err(Failure::usage)?;
    let output = MeshOutput::open(&arguments.files.output, arguments.files.write, origin)?;
    let spinner = Spinner::start(format!("refining {}", shown(&arguments.files.mesh)));
    let refined = refine(arguments, &polygons, &selection);
    spinner.clear();
    let refined = refined?;
    let mesh = refined.polygons();
    if arguments.levels > 0 && mesh.face_count() == polygons.face_count() {
        print_notice(&format!(
            "note: {}: no face is selected, so the mesh is unchanged",
            shown(&arguments.files.mesh)
        ));
    }
    output.write(mesh, &WriteOptions::default())?;
    let mut text = TextOutput::new(!is_stdout(&arguments.files.output));
    let place = sanitize(&arguments.files.output.display().to_string());
    let vertices = counted(mesh.vertex_count(), "vertex", "vertices");
    let faces = counted(mesh.face_count(), "face", "faces");
    let all = mesh.faces().iter();
    let green = all.filter(|&(f, _)| refined.is_green(f)).count();
    let made = format!(
        "{place}: {vertices}, {faces} ({} made by halving); refined on {}",
        grouped(green),
        arguments.backend
    );
    text.print_list("", [made]);
    text.finish()?;
    let to = &arguments.files.output;
    Ok(check_faces(polygons.face_count(), mesh, to))
}

/// Refuses schemes other than midpoint, and options that midpoint does not use.
fn check_options(arguments: &Subdivide) -> Result<(), Failure> {
    let Subdivide { scheme, .. } = arguments;
    if *scheme != Scheme::Midpoint {
        return Err(Failure::unsupported(format!(
            "{scheme} has no rule for a part of a mesh: choose --scheme midpoint with --select"
        )));
    }
    let others = [
        ("--method", arguments.method.is_some()),
        (
            "--threads",
            arguments.threads.is_some_and(|threads| threads > 1),
        ),
        ("--creases", arguments.creases.is_some()),
        ("--boundary", arguments.boundary.is_some()),
        ("--creasing", arguments.creasing.is_some()),
        ("--limit", arguments.limit.is_some()),
        ("--creases-left", arguments.creases_left.is_some()),
    ];
    match others.into_iter().find(|&(_, given)| given) {
        Some((option, _)) => Err(Failure::unsupported(format!(
            "{option} has no effect with --select: remove {option}"
        ))),
        None => Ok(()),
    }
}

/// Returns the selection in a mesh whose origin is at `origin` in the file. Boxes and the numbers of faces
/// are those of the file.
fn selection(
    select: &Select,
    numbers: &FaceNumbers,
    origin: [f64; 3],
) -> Result<Selection, Failure> {
    let moved = |corner: &[f64; 3]| (DVec3::from(*corner) - DVec3::from(origin)).as_vec3();
    Ok(match select {
        Select::Faces(path) => Selection::Faces(read_face_list(path, numbers)?),
        Select::Box(min, max) => Selection::Box {
            min: moved(min),
            max: moved(max),
        },
        Select::Angle(degrees) => Selection::Angle(*degrees as f32),
    })
}

/// Reads a list of face numbers, which are separated by spaces. `#` begins a comment; a byte order mark is
/// skipped.
fn read_face_list(path: &Path, numbers: &FaceNumbers) -> Result<Vec<FaceId>, Failure> {
    let shown = path.display();
    let text = fs::read_to_string(path).map_err(|cause| {
        Failure::usage(format!(
            "{shown}: cannot be read ({cause}): name a text file with face numbers"
        ))
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let in_file = numbers.in_file();
    let mut faces = Vec::new();
    let mut left_out = Vec::new();
    for (line_number, line) in (1..).zip(text.lines()) {
        let at = format_args!("{shown}:{line_number}");
        let content = line.split('#').next().unwrap_or_default();
        for word in content.split_whitespace() {
            let number: usize = word.parse().map_err(|_| {
                Failure::usage(format!(
                    "{at}: `{word}` is not a face: write numbers from 0, one or more per line"
                ))
            })?;
            if number >= in_file {
                let has = counted(in_file, "face", "faces");
                return Err(Failure::usage(format!(
                    "{at}: face {number} does not exist: the file has {has}, counted from 0"
                )));
            }
            let before = faces.len();
            faces.extend(numbers.faces(number));
            if faces.len() == before {
                left_out.push(format!("line {line_number}: face {number}"));
            }
        }
    }
    let they_were = match left_out.len() {
        1 => "1 face is not selected, because it was".to_owned(),
        n => format!("{} faces are not selected, because they were", grouped(n)),
    };
    let heading = format!("{shown}: {they_were} left out of the mesh");
    print_places(&heading, left_out.into_iter());
    Ok(faces)
}

/// Returns an upper bound of the bytes of a level. The mesh has `faces` faces, and `chosen` of them
/// are selected. Each selected face becomes four faces and splits some neighbours.
fn max_bytes(faces: usize, chosen: usize) -> usize {
    /// Bytes of polygons, structure and scratch data per face.
    const BYTES: usize = 200;
    let new_faces = faces.saturating_add(chosen.saturating_mul(12));
    new_faces.min(faces.saturating_mul(4)).saturating_mul(BYTES)
}

/// Refines as `refine_locally` does, but checks the free memory before each level.
fn refine(
    arguments: &Subdivide,
    polygons: &PolygonMesh,
    selection: &Selection,
) -> Result<LocalMesh, Failure> {
    let algorithms = Algorithms::find(&arguments.backend);
    let algorithms = algorithms.ok_or_else(|| Failure::no_backend(&arguments.backend))?;
    let mut local = LocalMesh::new(polygons.clone()).map_err(Failure::unsupported)?;
    for level in 0..arguments.levels {
        let mesh = algorithms.build(local.polygons()).map_err(|refusal| {
            let structure = algorithms.structure();
            let refusal = LocalError::Build {
                structure,
                level,
                refusal,
            };
            Failure::cannot_hold(structure, refusal)
        })?;
        let chosen = match selection {
            Selection::Faces(_) if level > 0 => local.chosen_parts(),
            _ => mesh.select(selection).map_err(Failure::unsupported)?,
        };
        if chosen.is_empty() {
            break;
        }
        let peak = max_bytes(local.polygons().face_count(), chosen.len());
        check_memory(&format!("level {}", level + 1), peak, arguments.force)?;
        local = mesh.refine(&local, &chosen).map_err(Failure::unsupported)?;
    }
    Ok(local)
}
