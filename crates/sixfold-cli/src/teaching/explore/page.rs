//! The page: its parts in one file.

use serde_json::{Value, json};
use sixfold::shapes::GENERATORS;
use sixfold::subdivision::Scheme;
use sixfold_report::structure_colours;

use super::Situation;

const PAGE: &str = include_str!("page.html");
/// The colours, light and dark, which the pages of a course have, too.
pub(crate) const COLOURS: &str = include_str!("colours.css");
const STYLE: &str = include_str!("style.css");
/// The lessons with the outputs of their commands, written by `sixfold lessons --json`.
pub(crate) const LESSONS_DATA: &str = include_str!("lessons.json");
/// The engine (crates/wasm), written by `tests/wasm/build`.
const ENGINE: &[u8] = include_bytes!("engine.wasm.gz");

/// The scripts, each after those that it imports from.
const SCRIPTS: [&str; 27] = [
    include_str!("dom.js"),
    include_str!("engine.js"),
    include_str!("mesh.js"),
    include_str!("raster.js"),
    include_str!("view.js"),
    include_str!("state.js"),
    include_str!("store.js"),
    include_str!("answer.js"),
    include_str!("timeline.js"),
    include_str!("edit-steps.js"),
    include_str!("cards.js"),
    include_str!("places.js"),
    include_str!("subdivide.js"),
    include_str!("marks.js"),
    include_str!("query.js"),
    include_str!("walk.js"),
    include_str!("edit.js"),
    include_str!("check.js"),
    include_str!("measure.js"),
    include_str!("panels.js"),
    include_str!("explorer.js"),
    include_str!("player.js"),
    include_str!("race.js"),
    include_str!("predict.js"),
    include_str!("lesson.js"),
    include_str!("dialogs.js"),
    include_str!("main.js"),
];

/// Returns the page, which shows `situation` at first.
pub(crate) fn page(situation: &Situation) -> String {
    use base64::Engine as _;
    let engine = base64::engine::general_purpose::STANDARD.encode(ENGINE);
    let parts = [
        ("style", format!("{COLOURS}{STYLE}{}", colour_rules())),
        ("script", script()),
        ("data", data(situation)),
        ("engine", engine),
    ];
    let mut page = String::new();
    let mut rest = PAGE;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, after) = after.split_once("}}").expect("a closed mark");
        let part = parts.iter().find(|(known, _)| *known == name);
        page += before;
        page += &part.expect("a known part").1;
        rest = after;
    }
    page + rest
}

/// Returns the scripts as one. A browser does not load modules from a disk, so their imports and exports are left
/// out, and all have one scope.
fn script() -> String {
    let lines = SCRIPTS.iter().flat_map(|script| script.lines());
    let lines = lines.filter(|line| !line.starts_with("import "));
    let mut script = String::new();
    for line in lines {
        script += line.strip_prefix("export ").unwrap_or(line);
        script.push('\n');
    }
    script
}

/// Returns the rules for the colours of the structures, which are those of the reports.
fn colour_rules() -> String {
    let rules = |colour: fn(&(&str, &str, &str)) -> String| {
        structure_colours()
            .iter()
            .map(colour)
            .collect::<Vec<_>>()
            .join(";")
    };
    let light = rules(|(name, light, _)| format!("--{name}:{light}"));
    let dark = rules(|(name, _, dark)| format!("--{name}:{dark}"));
    format!(
        ":root{{{light}}}@media(prefers-color-scheme:dark){{:root:not([data-theme=light]){{{dark}}}}}\
         :root[data-theme=dark]{{{dark}}}"
    )
}

/// Returns the data of the page as JSON without `<`, which could end the element around it.
fn data(situation: &Situation) -> String {
    let structures = structure_colours().into_iter();
    let structures: Vec<Value> = structures
        .map(|(name, ..)| json!({ "name": name }))
        .collect();
    let schemes = Scheme::ALL.map(|scheme| scheme.name());
    let shapes: Vec<Value> = GENERATORS
        .iter()
        .map(|shape| {
            let parameters = shape.parameters.iter().map(|parameter| {
                json!({
                    "name": parameter.name, "meaning": parameter.meaning, "default": parameter.default,
                    "min": parameter.min, "max": parameter.max, "is_integer": parameter.is_integer,
                })
            });
            json!({
                "name": shape.name, "summary": shape.summary, "parameters": parameters.collect::<Vec<_>>(),
            })
        })
        .collect();
    let mut data = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "structures": structures,
        "schemes": schemes,
        "shapes": shapes,
        "situation": situation,
    });
    let lessons: Value = serde_json::from_str(LESSONS_DATA).expect("lessons.json is JSON");
    data["lessons"] = lessons;
    data.to_string().replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    /// Returns the names that a script declares at its top level.
    fn declared(script: &str) -> impl Iterator<Item = &str> {
        let words = ["const ", "let ", "function ", "async function ", "class "];
        script.lines().filter_map(move |line| {
            let line = line.strip_prefix("export ").unwrap_or(line);
            let rest = words.iter().find_map(|word| line.strip_prefix(word))?;
            rest.split(|letter: char| !letter.is_alphanumeric() && letter != '_')
                .next()
        })
    }

    #[test]
    fn scripts_come_after_those_that_they_import_from_and_share_no_name() {
        let mut names = HashSet::new();
        for script in SCRIPTS {
            for line in script.lines().filter(|line| line.starts_with("import ")) {
                assert!(line.ends_with(".js\";"), "one line: {line}");
                let (imported, _) = line.split_once(" } from ").expect("names");
                for name in imported.trim_start_matches("import { ").split(", ") {
                    assert!(
                        script.matches(name).count() > 1,
                        "{name} is not used: {line}"
                    );
                }
            }
            for name in declared(script) {
                assert!(names.insert(name), "{name} is declared twice");
            }
        }
        assert!(names.contains("Explorer") && names.contains("areaOf"));
    }

    #[test]
    fn the_page_has_all_parts_and_names_no_other_file() {
        let page = page(&Situation::default());
        assert!(!page.contains("{{"), "an open mark");
        for forbidden in ["import ", "src=", "http://", "https://", "@import", "url("] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert_eq!(page.matches("</script>").count(), 3);
        assert!(page.len() < 3_000_000, "{} bytes", page.len());
    }
}
