//! `sixfold generate`: writes built-in shapes.

use std::process::ExitCode;

use sixfold::io::WriteOptions;
use sixfold::shapes::{GENERATORS, Generator, Parameter};

use crate::arguments::Generate;
use crate::failure::Failure;
use crate::mesh_files::MeshOutput;
use crate::output::is_stdout;
use crate::progress::exit_on_interrupt;
use crate::text::{TextOutput, hanging_indent, sanitize};
use sixfold_results::numbers::counted;

pub(crate) fn run(arguments: &Generate) -> Result<ExitCode, Failure> {
    exit_on_interrupt();
    let settings = arguments.settings.iter();
    let settings: Vec<(&str, f64)> = settings
        .map(|(name, value)| (name.as_str(), *value))
        .collect();
    let made = arguments.shape.build(&settings).map_err(Failure::usage)?;
    let mesh = arguments.order.apply(&made, arguments.seed);
    let output = MeshOutput::open(&arguments.output, arguments.write, [0.0; 3])?;
    output.write(&mesh, &WriteOptions::default())?;
    let vertices = counted(mesh.vertex_count(), "vertex", "vertices");
    let faces = counted(mesh.face_count(), "face", "faces");
    let place = sanitize(&arguments.output.display().to_string());
    let mut text = TextOutput::new(!is_stdout(&arguments.output));
    text.print_list(
        "",
        [format!(
            "{place}: {}, {vertices}, {faces}",
            arguments.shape.name
        )],
    );
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the help text after the options.
pub(crate) fn help() -> String {
    let mut lines: Vec<String> = vec![
        "Examples:".into(),
        "  sixfold generate icosahedron -o ico.obj".into(),
        "  sixfold generate geodesic frequency=20 -o ball.obj".into(),
        "  sixfold generate torus m=256 n=128 --order shuffled --seed 7 -o - | head".into(),
        String::new(),
        "Exit codes: 0 success; 2 wrong usage; 4 interrupted, nothing written.".into(),
        String::new(),
        "Shapes:".into(),
    ];
    let width = GENERATORS
        .iter()
        .map(|generator| generator.name.len())
        .max();
    for generator in GENERATORS {
        lines.extend(described(generator, width.unwrap_or(0)));
    }
    lines.join("\n")
}

/// Describes a shape in one line, and each of its parameters in another line.
fn described(generator: &Generator, width: usize) -> Vec<String> {
    let Generator { name, summary, .. } = generator;
    let mut lines = vec![hanging_indent(&format!("  {name:<width$}  "), summary)];
    for parameter in generator.parameters {
        let Parameter {
            name,
            meaning,
            default,
            min,
            max,
            ..
        } = parameter;
        let text = format!("{name}={default}: {meaning}, {min} to {max}");
        lines.push(hanging_indent(&format!("  {:width$}    ", ""), &text));
    }
    lines
}
