//! Walks that the user writes.

use std::path::Path;
use std::process::ExitCode;

use serde::Serialize;
use sixfold_explain::{BuiltMesh, Comparison, Query, Refused, Walk};

use super::{algorithm, begin, cost, steps};
use crate::arguments;
use crate::failure::Failure;
use crate::teaching::print_refused;
use crate::text::hanging_indent;

#[derive(Serialize)]
struct Document<'d> {
    mesh: &'d str,
    walks: &'d [Walk],
    refused: &'d [Refused],
}

pub(super) fn run(
    path: Option<&Path>,
    walk: &str,
    arguments: &arguments::Trace,
) -> Result<ExitCode, Failure> {
    let expected = arguments.expect.as_deref().map(expected).transpose()?;
    let mut begun = begin(path, arguments)?;
    let name = begun.name_after_edits();
    let walk = |mesh: &BuiltMesh| mesh.walk(walk, expected);
    let (walks, refused) = begun.explain(&arguments.explained, walk)?;
    let blocks: Vec<String> = walks.iter().map(|walk| block(&name, walk)).collect();
    begun.text.print_line(&blocks.join("\n\n\n"));
    print_refused(&refused, &mut begun.text);
    let document = Document {
        mesh: &name,
        walks: &walks,
        refused: &refused,
    };
    begun.text.finish_with_document(begun.json, &document)?;
    let is_right = |walk: &Walk| {
        walk.stopped.is_none() && walk.expected.as_ref().is_none_or(Comparison::is_right)
    };
    Ok(match walks.iter().all(is_right) {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    })
}

/// Parses `vertex_vertices v3`.
fn expected(text: &str) -> Result<Query, Failure> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let [relation, element] = words[..] else {
        return Err(Failure::usage(
            "--expect: name a relation and an element, such as \"vertex_vertices v3\"",
        ));
    };
    let relation = arguments::relation(relation).map_err(Failure::usage)?;
    let element = element.parse().map_err(Failure::usage)?;
    Ok((relation, element))
}

fn block(mesh: &str, walk: &Walk) -> String {
    let head = format!(
        "walk in {}, {mesh}: {}",
        walk.structure,
        cost(&walk.results, walk.cost)
    );
    let mut parts = vec![
        hanging_indent("", &head),
        algorithm(&walk.algorithm, None),
        steps(&walk.steps, &walk.moved),
    ];
    if let Some(reason) = &walk.stopped {
        parts.push(hanging_indent(
            "! ",
            &format!("the walk ends here: {reason}"),
        ));
    }
    if let Some(comparison) = &walk.expected {
        parts.push(hanging_indent("", &comparison.verdict));
    }
    parts.join("\n\n")
}
