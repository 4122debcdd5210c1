//! Final messages and exit codes of the commands that measure.

use std::process::ExitCode;

use crate::failure::Failure;
use crate::progress::INTERRUPTED;
use crate::text::print_stderr;
use sixfold_study::numbers::counted;
use sixfold_study::{Agreement, Report, ResultRow};

/// The exit code if backends found different results for the same work.
const MISMATCH: u8 = 1;

/// Prints a note if the program was built without optimisation.
pub(crate) fn warn_of_debug_build() {
    if cfg!(debug_assertions) {
        print_stderr("note: the times of a debug build are not meaningful: build with --release");
    }
}

/// Returns the command line with quotes, so that a shell can run it again.
pub(crate) fn command_line() -> String {
    let words = std::env::args_os().skip(1);
    let words = words.map(|word| word.to_string_lossy().into_owned());
    let words: Vec<String> = ["sixfold".to_owned()].into_iter().chain(words).collect();
    shlex::try_join(words.iter().map(String::as_str)).unwrap_or_else(|_| words.join(" "))
}

/// Prints the final messages of a command and returns its exit code. Different results come first,
/// then errors of writing (`written`), then an interruption.
pub(crate) fn exit_code(
    written: Result<(), Failure>,
    mismatches: usize,
    interrupted: bool,
) -> Result<ExitCode, Failure> {
    if mismatches > 0 {
        let results = counted(mismatches, "result differs", "results differ");
        print_stderr(&format!(
            "error: {results} from the results of other backends for the same work. This is a \
             fault in Sixfold: please report it"
        ));
    }
    written?;
    if mismatches > 0 {
        return Ok(ExitCode::from(MISMATCH));
    }
    if interrupted {
        print_stderr("interrupted: finished results are kept");
        return Ok(ExitCode::from(INTERRUPTED));
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints the final messages of a command and returns its exit code, as [`exit_code`] does. Adds
/// the mismatches in `studies` to `mismatches`. Also reports external programs with different
/// results.
pub(crate) fn studies_exit_code<'r>(
    written: Result<(), Failure>,
    studies: impl IntoIterator<Item = &'r Report>,
    mut mismatches: usize,
    interrupted: bool,
) -> Result<ExitCode, Failure> {
    let mut others = 0;
    for study in studies {
        mismatches += study.mismatches().count();
        for row in study.external_mismatches() {
            others += 1;
            print_different_work(study, row);
        }
    }
    let code = exit_code(written, mismatches, interrupted)?;
    Ok(match others {
        0 => code,
        _ => ExitCode::from(MISMATCH),
    })
}

/// Reports the different result of an external program.
fn print_different_work(study: &Report, row: &ResultRow) {
    let ours = study.rows(row.operation);
    let mut ours = ours.filter(|other| other.agreement == Agreement::Same);
    let ours = ours.find_map(|other| other.checksum);
    let [theirs, ours] = [row.checksum, ours].map(|checksum| match checksum {
        Some(checksum) => checksum.to_string(),
        None => "not a number".into(),
    });
    let (name, operation, mesh) = (&row.backend, row.operation, &study.mesh.name);
    print_stderr(&format!(
        "error: {mesh}: {name}: the checksum of {operation} is {theirs}, but {ours} on the \
         built-in backends. The results differ, so the times of the program are not comparable: \
         correct the program"
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mismatches_take_precedence_over_an_interruption() {
        let code = |mismatches, interrupted| {
            let result = exit_code(Ok(()), mismatches, interrupted).expect("all is written");
            format!("{result:?}")
        };
        let known = |code: u8| format!("{:?}", ExitCode::from(code));
        assert_eq!(code(0, false), known(0));
        assert_eq!(code(0, true), known(INTERRUPTED));
        assert_eq!(code(2, true), known(MISMATCH));
        assert!(exit_code(Err(Failure::usage("full disk")), 1, true).is_err());
    }
}
