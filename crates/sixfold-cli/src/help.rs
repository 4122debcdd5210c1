//! The list of commands in groups, completions for shells, and manual pages.

use std::fs;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::builder::StyledStr;
use clap::{Arg, Command as Definition, CommandFactory};
use sixfold::did_you_mean;

use crate::arguments::{Arguments, Completions, Manual};
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::text::{hanging_indent, ignore_closed_pipe, reflow, sanitize, width};
use crate::{generate, growth, orders, study};

/// The commands of each group, in the order of the list.
const GROUPS: [(&str, &[&str]); 6] = [
    (
        "Choose a structure",
        &["pick", "new", "workloads", "study", "operations", "inspect"],
    ),
    (
        "Explain the costs",
        &[
            "why",
            "memory",
            "orders",
            "growth",
            "neighbours",
            "edits",
            "schemes",
        ],
    ),
    (
        "See how structures work",
        &["explore", "tables", "trace", "lessons"],
    ),
    (
        "Saved results",
        &["report", "compare", "history", "rerun", "merge"],
    ),
    (
        "Meshes",
        &[
            "generate",
            "convert",
            "distance",
            "subdivide",
            "smooth",
            "dual",
            "triangulate",
            "decimate",
            "remesh",
            "repair",
            "render",
        ],
    ),
    ("Help", &["help", "completions", "manual"]),
];

/// Returns the definition of all arguments, with the help texts that list names.
pub(crate) fn definition() -> Definition {
    let definition = Arguments::command()
        .mut_subcommand("study", |study| study.after_help(study::help()))
        .mut_subcommand("orders", |orders| orders.after_help(orders::help()))
        .mut_subcommand("growth", |growth| growth.after_help(growth::help()))
        .mut_subcommand("generate", |generate| generate.after_help(generate::help()))
        .mut_subcommands(fit_to_width);
    let definition = fit_to_width(definition);
    let template = format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{}\n\nOptions:\n{{options}}\
         {{after-help}}",
        grouped_commands(&definition)
    );
    definition.help_template(template)
}

/// Breaks the help of a command at the width of the terminal.
pub(crate) fn fit_to_width(command: Definition) -> Definition {
    let fitted = |text: Option<&StyledStr>| text.map(|text| reflow(&text.to_string(), width()));
    let about = fitted(command.get_long_about());
    let after = fitted(command.get_after_help());
    let mut command = command.term_width(width());
    if let Some(about) = about {
        command = command.long_about(about);
    }
    match after {
        Some(after) => command.after_help(after),
        None => command,
    }
}

/// Returns the failure for a word that is not a command.
pub(crate) fn unknown_command(word: &str) -> Failure {
    let names = GROUPS.iter().flat_map(|(_, names)| names.iter());
    Failure::usage(format!(
        "no command is called `{}`{}: `sixfold --help` lists the commands",
        sanitize(word),
        did_you_mean(word, names)
    ))
}

/// Returns the failure for an option that the command of `words` does not have, but others have; `None` if
/// no command has it.
pub(crate) fn option_of_others(option: &str, words: &[String]) -> Option<Failure> {
    let definition = definition();
    let command = words
        .iter()
        .find(|word| definition.find_subcommand(word).is_some())?;
    let long = option.strip_prefix("--")?;
    let has = |command: &&Definition| {
        let mut options = command.get_arguments().filter_map(Arg::get_long);
        options.any(|name| name == long)
    };
    let others: Vec<String> = definition
        .get_subcommands()
        .filter(has)
        .map(|other| format!("`sixfold {}`", other.get_name()))
        .collect();
    (!others.is_empty()).then(|| {
        Failure::usage(format!(
            "`sixfold {}` has no option {option}, but {}: `sixfold {} --help` lists its options",
            sanitize(command),
            match &others[..] {
                [one] => format!("{one} has it"),
                several => format!("{} have it", several.join(", ")),
            },
            sanitize(command),
        ))
    })
}

/// Returns the commands with their summaries, one group after the other.
fn grouped_commands(definition: &Definition) -> String {
    let names = || GROUPS.iter().flat_map(|(_, names)| names.iter());
    let longest = names().map(|name| name.len()).max().unwrap_or(0);
    let line = |name: &&str| {
        let about = match definition.find_subcommand(name) {
            Some(command) => command.get_about().map(ToString::to_string),
            None => Some("Print this text, or the help of a command".into()),
        };
        hanging_indent(&format!("  {name:<longest$}  "), &about.unwrap_or_default())
    };
    let groups = GROUPS.map(|(title, names)| {
        let lines: Vec<String> = names.iter().map(line).collect();
        format!("{title}:\n{}", lines.join("\n"))
    });
    groups.join("\n\n")
}

/// Prints the completions for a shell.
pub(crate) fn completions(arguments: &Completions) -> Result<ExitCode, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut definition(), "sixfold", &mut script);
    let mut stdout = io::stdout().lock();
    ignore_closed_pipe(stdout.write_all(&script).and_then(|()| stdout.flush()))?;
    Ok(ExitCode::SUCCESS)
}

/// Prints the manual page of `sixfold`, or writes the pages of all commands to a folder.
pub(crate) fn manual(arguments: &Manual) -> Result<ExitCode, Failure> {
    if let Some(folder) = &arguments.to {
        let written = fs::create_dir_all(folder);
        written
            .and_then(|()| clap_mangen::generate_to(definition(), folder))
            .map_err(|cause| cannot_write(&folder.display().to_string(), &cause))?;
        return Ok(ExitCode::SUCCESS);
    }
    let printed = clap_mangen::Man::new(definition()).render(&mut io::stdout().lock());
    ignore_closed_pipe(printed)?;
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn each_command_is_in_exactly_one_group() {
        let definition = definition();
        let defined = definition
            .get_subcommands()
            .map(|c| c.get_name().to_owned());
        let mut defined: BTreeSet<String> = defined.collect();
        defined.insert("help".into());
        let listed: Vec<&str> = GROUPS
            .iter()
            .flat_map(|(_, names)| *names)
            .copied()
            .collect();
        let unique: BTreeSet<String> = listed.iter().map(|&name| name.to_owned()).collect();
        assert_eq!(listed.len(), unique.len());
        assert_eq!(unique, defined);
    }
}
