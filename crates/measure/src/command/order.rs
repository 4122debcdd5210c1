//! Runs programs in one order of elements, to find out why their results differ between structures.

use std::collections::BTreeSet;
use std::process::ExitCode;

use sixfold::UnknownName;
use sixfold_results::numbers::{grouped, list};

use crate::command::arguments::Arguments;
use crate::command::column_table::{Column, column_table};
use crate::command::failure::Failure;
use crate::command::load::study_meshes;
use crate::command::meshes::find_meshes;
use crate::command::programs::print_meshes;
use crate::command::text::{TextOutput, hanging_indent, print_notice, sanitize};
use crate::engine::agreement::is_same_result;
use crate::pick::programs::is_local;
use crate::{Contestant, Outcome, ProgramRefusal, StudyMesh, Suite, SuiteProgram};

/// The exit code if results differ or a program fails.
const DIFFERENT: u8 = 1;

/// Runs each program of `suite` once on each structure, in the structure's own order and in one order, and prints the
/// results.
pub(super) fn run(suite: &Suite, arguments: &Arguments) -> Result<ExitCode, Failure> {
    let contestants = suite.programs().iter().flat_map(SuiteProgram::contestants);
    let known: BTreeSet<&str> = contestants.map(Contestant::name).collect();
    UnknownName::check("backend", &arguments.backends, known).map_err(Failure::usage)?;
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_notice(note))?;
    let (study_meshes, failed) = study_meshes(&meshes, arguments.read, arguments.triangulate)?;
    let mut text = TextOutput::new(true);
    let mut all_agree = true;
    for study_mesh in &study_meshes {
        print_meshes(std::slice::from_ref(study_mesh), &mut text);
        for program in suite.programs() {
            text.print_line("");
            text.print_line(&hanging_indent("Program:  ", &sanitize(program.name())));
            text.print_line("");
            all_agree &= print_program(program, study_mesh, arguments, &mut text);
        }
    }
    text.finish()?;
    Ok(match all_agree && failed.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(DIFFERENT),
    })
}

/// Prints the results of a program. Returns whether it runs on all structures, and all results agree.
fn print_program(
    program: &SuiteProgram,
    study_mesh: &StudyMesh,
    arguments: &Arguments,
    text: &mut TextOutput,
) -> bool {
    if !program.can_be_recorded() {
        text.print_line(&hanging_indent(
            "- ",
            &format!(
                "A program that {} the mesh runs only in the orders of the structures.",
                program.kind()
            ),
        ));
        return true;
    }
    let is_chosen = |contestant: &&Contestant| {
        let names = &arguments.backends;
        names.is_empty() || names.iter().any(|name| name == contestant.name())
    };
    let contestants = program.contestants().iter().filter(is_chosen);
    let runs = contestants.filter_map(|contestant| {
        let own = contestant.run_once(&study_mesh.polygons, false)?;
        let canonical = contestant.run_once(&study_mesh.polygons, true)?;
        Some((contestant.name().to_owned(), [own, canonical]))
    });
    let runs: Vec<_> = runs.collect();
    let result = |order: usize| {
        let shown = runs.iter().map(move |(_, results)| match &results[order] {
            Ok(outcome) => format!("{:?}", outcome.checksum),
            Err(_) => "–".to_owned(),
        });
        shown.collect::<Vec<_>>()
    };
    let elements = |order: usize| {
        let shown = runs.iter().map(move |(_, results)| match &results[order] {
            Ok(outcome) => grouped(outcome.elements as usize),
            Err(_) => "–".to_owned(),
        });
        shown.collect::<Vec<_>>()
    };
    let names = Column::words("", runs.iter().map(|(name, _)| name.clone()));
    let mut columns = vec![
        Column::figures("own order", result(0)),
        Column::figures("canonical order", result(1)),
    ];
    if elements(0)
        .iter()
        .chain(&elements(1))
        .any(|n| *n != elements(0)[0])
    {
        columns.insert(1, Column::figures("elements", elements(0)));
        columns.push(Column::figures("elements", elements(1)));
    }
    text.print_line(&column_table(&names, &columns));
    text.print_line("");
    let mut fails = false;
    for (name, results) in &runs {
        if let Some(Err(reason)) = results.iter().find(|result| result.is_err()) {
            fails |= !matches!(
                reason,
                ProgramRefusal::Build(_) | ProgramRefusal::Refused(_)
            );
            let reason = sanitize(&reason.to_string());
            text.print_list("- ", [format!("{name}: {reason}.")]);
        }
    }
    let scanning = program.contestants().iter().filter(is_chosen);
    let scanning = scanning.filter(|contestant| !is_local(contestant));
    let scanning: Vec<&str> = scanning.map(Contestant::name).collect();
    if !scanning.is_empty() {
        text.print_list(
            "- ",
            [format!(
                "Not run here, because their queries scan the mesh: {}.",
                list(scanning)
            )],
        );
    }
    let found = |order: usize| runs.iter().map(move |(_, results)| results[order].as_ref());
    let agree = [0, 1].map(|order| {
        let found: Vec<&Outcome> = found(order).flatten().collect();
        let mut pairs = found.windows(2);
        pairs.all(|pair| is_same_result(pair[0], pair[1]))
    });
    match found(0).flatten().count().min(found(1).flatten().count()) {
        0 | 1 => text.print_list("- ", ["There is nothing to compare."]),
        _ => text.print_list("- ", [verdict(agree)]),
    }
    agree == [true, true] && !fails
}

/// Says what it means if the results agree in the structures' own orders, and in one order.
fn verdict(agree: [bool; 2]) -> &'static str {
    match agree {
        [true, true] => "These results agree, up to rounding.",
        [false, true] => {
            "The results agree in the canonical order only: the program depends on the order of elements or of the \
             results of a query, for example because it takes the first of equals."
        }
        [true, false] => {
            "The results agree in the structures' own orders only. The program depends on the order, and the structures \
             happen to have the same one."
        }
        [false, false] => {
            "The results differ in the canonical order, too, so the order is not the only reason: count the refused edits \
             in the result, because structures of manifolds refuse some edits that others accept; do not keep handles \
             that an edit renames; add up in `f64`."
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_combination_has_its_verdict() {
        let all = [[true, true], [false, true], [true, false], [false, false]].map(verdict);
        for (i, text) in all.iter().enumerate() {
            assert!(!all[..i].contains(text), "{text}");
        }
        assert!(verdict([false, true]).contains("depends on the order"));
    }
}
