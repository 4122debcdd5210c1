//! `sixfold schemes`: lists the subdivision schemes, and the backends that support them.

use std::process::ExitCode;

use comfy_table::Cell;
use serde_json::json;
use sixfold::subdivision::{Method, Primitive, Scheme, SchemeProperties};
use sixfold::{Support, support};

use crate::arguments::Schemes;
use crate::failure::Failure;
use crate::output::{Output, is_stdout};
use crate::tables::{table, table_of_backends};
use crate::text::{TextOutput, hanging_indent};

pub(crate) fn run(arguments: &Schemes) -> Result<ExitCode, Failure> {
    let json = Output::open_if(arguments.json.as_ref())?;
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    text.print_line(&classification());
    text.print_line("");
    text.print_line(&matrix());
    let rows = Scheme::ALL.map(|scheme| {
        json!({ "scheme": scheme, "kind": scheme.properties(), "backends": support(scheme) })
    });
    text.finish_with_json(json, &rows)
}

/// Returns the tables that classify the schemes, with a row per scheme.
fn classification() -> String {
    let heads = [
        "scheme",
        "splits",
        "faces",
        "old vertices",
        "growth",
        "limit",
    ];
    let mut kinds = table(heads.map(Cell::new).to_vec());
    let mut notes = Vec::new();
    for scheme in Scheme::ALL {
        let SchemeProperties {
            primitive,
            takes,
            makes,
            interpolating,
            continuity,
            growth,
            boundary,
            source,
            ..
        } = scheme.properties();
        let primitive = match primitive {
            Primitive::FaceSplit => "faces",
            Primitive::VertexSplit => "vertices",
        };
        let faces = match takes == makes {
            true => takes.to_string(),
            false => format!("{takes} to {makes}"),
        };
        let stay = match interpolating {
            true => "stay",
            false => "move",
        };
        let row = [
            scheme.name(),
            primitive,
            &faces,
            stay,
            &format!("× {growth}"),
            continuity,
        ];
        kinds.add_row(row.map(Cell::new).to_vec());
        notes.push((scheme.name(), boundary, source));
    }
    let heads = ["scheme", "boundary", "source"];
    let mut sources = table(heads.map(Cell::new).to_vec());
    for (name, boundary, source) in notes {
        sources.add_row([name, boundary, source].map(Cell::new).to_vec());
    }
    format!("{}\n\n{}", kinds.trim_fmt(), sources.trim_fmt())
}

/// Returns the table of methods, with a row per scheme and a column per backend.
fn matrix() -> String {
    let mut methods = table_of_backends("methods");
    let mut once = false;
    for scheme in Scheme::ALL {
        let mut row = vec![Cell::new(scheme.name())];
        for support in support(scheme) {
            once |= !support.holds_result;
            row.push(Cell::new(letters(&support)));
        }
        methods.add_row(row);
    }
    let legend = [
        "G gather: each new point queries its neighbours. S scatter: one pass over the faces.",
        "N native: the structure refines its own tables, on all threads. G and S build the \
         structure again.",
        "1  only one step is possible, because the structure cannot hold the result.",
    ];
    let mut text = methods.trim_fmt() + "\n";
    for line in &legend[..if once { 3 } else { 2 }] {
        text += "\n";
        text += &hanging_indent("", line);
    }
    text
}

fn letters(support: &Support) -> String {
    let letter = |method: &Method| match method {
        Method::Gather => "G",
        Method::Scatter => "S",
        Method::Native => "N",
    };
    let letters: Vec<&str> = support.methods.iter().map(letter).collect();
    let once = if support.holds_result { "" } else { " 1" };
    letters.join(" ") + once
}
