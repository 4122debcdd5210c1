//! `sixfold render`: draws pictures of meshes.

use std::path::Path;
use std::process::ExitCode;

use sixfold::io::read_creases;
use sixfold::repair::{FaultKind, Place, diagnose};
use sixfold::{Creases, PolygonMesh};
use sixfold_render::{
    Faults, MeshFault, Picture, RenderError, RenderMesh, Settings, Size, View, draw, draw_svg,
};

use crate::arguments::Render;
use crate::failure::Failure;
use crate::load;
use crate::mesh_files::shown;
use crate::output::{Output, check_not_overwritten, is_stdout};
use crate::progress::{Spinner, exit_on_interrupt};
use crate::text::{TextOutput, sanitize};
use crate::triangulate::print_crossing;
use sixfold_results::numbers::counted;

pub(crate) fn run(arguments: &Render) -> Result<ExitCode, Failure> {
    exit_on_interrupt();
    let format = Format::from_path(&arguments.output)?;
    let outputs = [("--output", Some(&arguments.output))];
    for mesh in &arguments.meshes {
        check_not_overwritten("the mesh", mesh, &outputs)?;
    }
    for creases in &arguments.creases {
        check_not_overwritten("the crease file", creases, &outputs)?;
    }
    let settings = settings(arguments)?;
    let loaded = load_meshes(arguments)?;
    let faults: Vec<Option<Faults>> = loaded
        .iter()
        .map(|(mesh, _)| arguments.faults.then(|| faults(mesh)))
        .collect();
    let render_meshes = loaded.iter().zip(&faults);
    let render_meshes = render_meshes.map(|((mesh, creases), faults)| RenderMesh {
        mesh,
        creases,
        faults: faults.as_ref(),
    });
    let render_meshes: Vec<RenderMesh<'_>> = render_meshes.collect();
    // Open the output before the work, so that an unusable path gives an error at once.
    let output = Output::open(&arguments.output)?;
    let faces: usize = loaded.iter().map(|(mesh, _)| mesh.face_count()).sum();
    let spinner = Spinner::start(format!("drawing {}", counted(faces, "face", "faces")));
    let drawn = match format {
        Format::Png => draw(&render_meshes, &settings).map(Drawn::Pixels),
        Format::Svg => draw_svg(&render_meshes, &settings).map(Drawn::Lines),
    };
    spinner.clear();
    let drawn = drawn.map_err(|error| failure(arguments, &error))?;
    output.finish(|writer| match &drawn {
        Drawn::Pixels(picture) => picture.write_png(writer),
        Drawn::Lines(svg) => writer.write_all(svg.as_bytes()),
    })?;
    let mut text = TextOutput::new(true);
    let place = sanitize(&arguments.output.display().to_string());
    let meshes = counted(loaded.len(), "mesh", "meshes");
    let faces = counted(faces, "face", "faces");
    let Size { width, height } = settings.size;
    text.print_line(&format!(
        "{place}: {meshes}, {faces}, {width} × {height} pixels"
    ));
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

enum Format {
    Png,
    Svg,
}

enum Drawn {
    Pixels(Picture),
    Lines(String),
}

impl Format {
    /// Returns the format for the extension of `path`.
    fn from_path(path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("png") => Ok(Self::Png),
            Some("svg") => Ok(Self::Svg),
            _ => Err(Failure::usage(format!(
                "--output {}: name the picture OUT.png or OUT.svg",
                path.display()
            ))),
        }
    }
}

fn settings(arguments: &Render) -> Result<Settings, Failure> {
    let [azimuth, elevation] = arguments.view;
    let view = View::new(azimuth, elevation, arguments.up).map_err(Failure::usage)?;
    let panels = arguments.meshes.len();
    Ok(Settings {
        size: arguments.size.unwrap_or_else(|| Size::for_panels(panels)),
        view,
        shading: arguments.shade,
        edges: arguments.edges,
        wireframe: arguments.wireframe,
        labels: arguments.labels,
    })
}

/// Returns the faults to paint.
pub(crate) fn faults(mesh: &PolygonMesh) -> Faults {
    let mut faults = Faults::default();
    for fault in diagnose(mesh, usize::MAX).faults {
        for place in fault.places {
            match (fault.kind, place) {
                (FaultKind::BoundaryEdge, Place::Edge(ends)) => faults.boundary_edges.push(ends),
                (FaultKind::NonManifoldEdge, Place::Edge(ends)) => {
                    faults.non_manifold_edges.push(ends);
                }
                (FaultKind::NonManifoldVertex, Place::Vertex(v)) => {
                    faults.non_manifold_vertices.push(v);
                }
                (FaultKind::TurnedFace, Place::Face(f)) => faults.turned_faces.push(f),
                _ => {}
            }
        }
    }
    faults
}

/// Loads the meshes with the creases in their files and in their crease files.
fn load_meshes(arguments: &Render) -> Result<Vec<(PolygonMesh, Creases)>, Failure> {
    let (meshes, files) = (&arguments.meshes, &arguments.creases);
    if files.len() > meshes.len() {
        let files = counted(files.len(), "crease file", "crease files");
        let meshes = counted(meshes.len(), "mesh", "meshes");
        return Err(Failure::usage(format!(
            "{files} for {meshes}: give at most one --creases per mesh, in the order of the meshes"
        )));
    }
    if meshes.iter().filter(|path| is_stdout(path)).count() > 1 {
        return Err(Failure::usage(
            "several meshes are standard input, which can be read only once: name files for the others",
        ));
    }
    let mut loaded = Vec::with_capacity(meshes.len());
    for (i, path) in meshes.iter().enumerate() {
        let (polygons, mut creases, _) = load::with_creases(path, arguments.read)?;
        if let Some(file) = files.get(i) {
            let listed = read_creases(file, &polygons).map_err(Failure::usage)?;
            creases = creases.updated_with(&listed);
        }
        print_crossing(&shown(path), &polygons.crossing_faces(), |face| {
            format!("face {face}")
        });
        loaded.push((polygons, creases));
    }
    Ok(loaded)
}

/// Converts an error. The message contains the file name of the mesh.
fn failure(arguments: &Render, error: &RenderError) -> Failure {
    match error {
        RenderError::Mesh { mesh, fault } => {
            let file = shown(&arguments.meshes[*mesh]);
            let message = format!("{file}: {fault}");
            match fault {
                MeshFault::TooManyFaces { .. } | MeshFault::TooManyLabels { .. } => {
                    Failure::unsupported(message)
                }
                _ => Failure::usage(message),
            }
        }
        _ => Failure::usage(error),
    }
}
