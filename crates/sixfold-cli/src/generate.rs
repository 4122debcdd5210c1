//! `sixfold generate`: writes built-in shapes.

use std::process::ExitCode;

use sixfold::io::write_obj;
use sixfold::shapes::{Parameter, RECIPES, Recipe, recipe};

use crate::arguments::Generate;
use crate::failure::Failure;
use crate::output::{Output, is_stdout};
use crate::progress::end_on_interrupt;
use crate::text::{Text, hanging, tame};
use sixfold_study::numbers::counted;
use sixfold_study::unknown;

/// Writes the selected shape.
pub(crate) fn run(arguments: &Generate) -> Result<ExitCode, Failure> {
    end_on_interrupt();
    let shape = &arguments.shape;
    let recipe = recipe(shape).ok_or_else(|| {
        let names: Vec<&str> = RECIPES.iter().map(|recipe| recipe.name).collect();
        Failure::usage(unknown("shape", shape, &names))
    })?;
    let settings = arguments.settings.iter();
    let settings: Vec<(&str, f64)> = settings
        .map(|(name, value)| (name.as_str(), *value))
        .collect();
    let made = recipe.make(&settings).map_err(Failure::usage)?;
    let mesh = arguments.order.of(&made, arguments.seed);
    let output = Output::open(&arguments.output)?;
    output.finish(|writer| write_obj(&mesh, writer))?;
    let vertices = counted(mesh.vertex_count(), "vertex", "vertices");
    let faces = counted(mesh.face_count(), "face", "faces");
    let place = tame(&arguments.output.display().to_string());
    let mut text = Text::shown(!is_stdout(&arguments.output));
    text.say(&format!("{place}: {shape}, {vertices}, {faces}"));
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the help text after the options: examples and the list of shapes.
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
    let width = RECIPES.iter().map(|recipe| recipe.name.len()).max();
    for recipe in RECIPES {
        lines.extend(described(recipe, width.unwrap_or(0)));
    }
    lines.join("\n")
}

/// Describes a shape in a line, and each of its parameters in another.
fn described(recipe: &Recipe, width: usize) -> Vec<String> {
    let Recipe { name, summary, .. } = recipe;
    let mut lines = vec![hanging(&format!("  {name:<width$}  "), summary)];
    for parameter in recipe.parameters {
        let Parameter {
            name,
            meaning,
            default,
            least,
            greatest,
            ..
        } = parameter;
        let text = format!("{name}={default}: {meaning}, {least} to {greatest}");
        lines.push(hanging(&format!("  {:width$}    ", ""), &text));
    }
    lines
}
