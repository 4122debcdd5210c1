//! `sixfold edits`: lists the edits of each structure and the cost of each edit.

use std::process::ExitCode;

use comfy_table::Cell;
use serde_json::{Value, json};
use sixfold::{Edit, QueryCost, structure_infos};

use crate::arguments::Edits;
use crate::failure::Failure;
use crate::output::{Output, is_stdout};
use crate::tables::table_of_backends;
use crate::text::{TextOutput, hanging_indent};

pub(crate) fn run(arguments: &Edits) -> Result<ExitCode, Failure> {
    let json = Output::open_if(arguments.json.as_ref())?;
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    text.print_line(&matrix());
    text.print_line("");
    text.print_line(&legend());
    text.finish_with_json(json, &Edit::ALL.map(row))
}

/// Returns the table with a row per edit and a column per backend.
fn matrix() -> String {
    let backends = structure_infos();
    let mut costs = table_of_backends("visits");
    for edit in Edit::ALL {
        let offered = backends.iter().map(|backend| backend.edits[edit as usize]);
        let words = offered.map(|cost| Cell::new(cost.map_or("–", QueryCost::name)));
        let name = Cell::new(edit.name());
        costs.add_row([name].into_iter().chain(words).collect::<Vec<_>>());
    }
    costs.trim_fmt()
}

/// Explains the words in the table, and lists the structures that hold only oriented manifolds.
fn legend() -> String {
    let backends = structure_infos();
    let manifold = backends
        .iter()
        .filter(|backend| !backend.capabilities.non_manifold_edges);
    let manifold: Vec<&str> = manifold.map(|backend| backend.name).collect();
    let lines = [
        "constant: an edit visits a few rows, for any size of mesh. local: an edit visits the \
         faces around the edited element. scan: an edit visits all faces."
            .to_owned(),
        "–: the structure does not support the edit.".to_owned(),
        format!(
            "{} hold only oriented manifolds. They refuse an edit if the result is not an oriented \
             manifold. The other structures have no such limit.",
            manifold.join(", ")
        ),
    ];
    lines.map(|line| hanging_indent("", &line)).join("\n")
}

fn row(edit: Edit) -> Value {
    let backends = structure_infos().into_iter().map(|backend| {
        let cost = backend.edits[edit as usize];
        json!({ "backend": backend.name, "cost": cost })
    });
    json!({ "edit": edit, "backends": backends.collect::<Vec<_>>() })
}
