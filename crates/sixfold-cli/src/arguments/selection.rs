//! The option that selects operations by names, patterns and groups.

use clap::Args;
use sixfold_results::OperationGroup;
use sixfold_study::Operation;

// What to measure.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct OperationArgs {
    /// Run only these operations: names, patterns such as 'vertex_*', or groups such as edits
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = selection)]
    operations: Vec<Selection>,
}

/// The operations that one word selects.
#[derive(Clone, Debug)]
struct Selection(Vec<Operation>);

impl OperationArgs {
    /// Returns the selected operations, each once; empty for the default of the command.
    pub(crate) fn selected(&self) -> Vec<Operation> {
        let mut selected = Vec::new();
        for operation in self.operations.iter().flat_map(|selection| &selection.0) {
            if !selected.contains(operation) {
                selected.push(*operation);
            }
        }
        selected
    }
}

/// Parses the name of an operation, a pattern with `*`, or the name of a group.
fn selection(text: &str) -> Result<Selection, String> {
    let text = text.trim();
    let matching = |is_selected: &dyn Fn(Operation) -> bool| {
        let all = Operation::ALL.into_iter().filter(|o| is_selected(*o));
        Selection(all.collect())
    };
    let found = match (text.parse::<Operation>(), text.parse::<OperationGroup>()) {
        (Ok(operation), _) => return Ok(Selection(vec![operation])),
        (Err(_), Ok(group)) => matching(&|operation| operation.group() == group),
        (Err(unknown), Err(_)) if !text.contains('*') => return Err(unknown.to_string()),
        (Err(_), Err(_)) => matching(&|operation| matches(operation.name(), text)),
    };
    match found.0.is_empty() {
        true => Err(format!(
            "no operation matches `{text}`: `sixfold operations` lists them"
        )),
        false => Ok(found),
    }
}

/// Returns whether a name matches a pattern, in which `*` stands for any letters.
fn matches(name: &str, pattern: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else {
        return name == pattern;
    };
    let Some(name) = name.strip_prefix(start) else {
        return false;
    };
    let mut ends = name.char_indices().map(|(at, _)| at).chain([name.len()]);
    ends.any(|at| matches(&name[at..], rest))
}
