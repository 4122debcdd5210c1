//! `sixfold operations`: lists what each operation of a study does.

use std::process::ExitCode;

use serde_json::{Value, json};
use sixfold_study::Operation;

use crate::arguments::Operations;
use crate::failure::Failure;
use crate::output::{Output, is_stdout};
use crate::text::{TextOutput, hanging_indent};
use sixfold_results::OperationGroup;

/// The groups, in the order of the list. Each group has a text on its operations.
const GROUPS: [(OperationGroup, &str); 5] = [
    (OperationGroup::Build, "each run builds a new structure"),
    (
        OperationGroup::Queries,
        "each run queries every element once",
    ),
    (
        OperationGroup::Traversals,
        "passes over all elements, as in programs",
    ),
    (
        OperationGroup::Edits,
        "each run changes a copy of a mesh of triangles",
    ),
    (
        OperationGroup::Subdivision,
        "each run refines the mesh by one step",
    ),
];

pub(crate) fn run(arguments: &Operations) -> Result<ExitCode, Failure> {
    let json = Output::open_if(arguments.json.as_ref())?;
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    for (group, about) in GROUPS {
        text.print_line(&format!("{group}: {about}"));
        for operation in Operation::ALL {
            if operation.group() == group {
                text.print_line(&line(operation));
            }
        }
        text.print_line("");
    }
    let units = "The second column is the unit: a study divides the time of a run by the number \
                 of these units.";
    text.print_list("", [units]);
    for (unit, about) in Operation::UNITS {
        text.print_line(&hanging_indent(&format!("{unit}: "), about));
    }
    text.finish_with_json(json, &Operation::ALL.map(row))
}

/// Returns the line of an operation: its name, its unit and what it does.
fn line(operation: Operation) -> String {
    let names = Operation::ALL.map(|operation| operation.name().len());
    let units = Operation::ALL.map(|operation| operation.unit().len());
    let [name_width, unit_width] = [names, units].map(|widths| widths.into_iter().max());
    let (name, unit) = (operation.name(), operation.unit());
    let (name_width, unit_width) = (name_width.unwrap_or(0), unit_width.unwrap_or(0));
    let first = format!("  {name:<name_width$}  {unit:<unit_width$}  ");
    hanging_indent(&first, operation.about())
}

fn row(operation: Operation) -> Value {
    json!({
        "operation": operation.name(),
        "group": operation.group(),
        "per": operation.unit(),
        "about": operation.about(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_operation_is_in_a_group_of_the_list() {
        let listed = |operation: &Operation| GROUPS.iter().any(|g| g.0 == operation.group());
        assert!(Operation::ALL.iter().all(listed));
    }
}
