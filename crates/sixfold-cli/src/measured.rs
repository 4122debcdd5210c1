//! What all commands that measure say, and how they end.

use std::process::ExitCode;

use crate::failure::Failure;
use crate::progress::INTERRUPTED;
use crate::text::complain;
use ::study::numbers::counted;
use ::study::{Agreement, Report, ResultRow};

/// Backends found different results for the same work.
const MISMATCH: u8 = 1;

/// Says so where the program was built without optimisation.
pub(crate) fn tell_of_debug_build() {
    if cfg!(debug_assertions) {
        complain("note: this is a debug build, and its times mean nothing: build with --release");
    }
}

/// What was typed, as it can be typed again.
pub(crate) fn typed() -> String {
    let words = std::env::args_os().skip(1);
    let words = words.map(|word| word.to_string_lossy().into_owned());
    let words: Vec<String> = ["sixfold".to_owned()].into_iter().chain(words).collect();
    shlex::try_join(words.iter().map(String::as_str)).unwrap_or_else(|_| words.join(" "))
}

/// The end of a command whose text and files are `written`: a fault of ours comes before what could not
/// be written, and that before an interruption.
pub(crate) fn ended(
    written: Result<(), Failure>,
    mismatches: usize,
    interrupted: bool,
) -> Result<ExitCode, Failure> {
    if mismatches > 0 {
        let results = counted(mismatches, "result differs", "results differ");
        complain(&format!(
            "error: {results} from the others for the same work: a fault in Sixfold, please report it"
        ));
    }
    written?;
    if mismatches > 0 {
        return Ok(ExitCode::from(MISMATCH));
    }
    if interrupted {
        complain("interrupted: what was finished is kept");
        return Ok(ExitCode::from(INTERRUPTED));
    }
    Ok(ExitCode::SUCCESS)
}

/// The end of a command that made `studies`, and found so many `mismatches` besides: programs of others
/// that do another work are told of.
pub(crate) fn studies_ended<'r>(
    written: Result<(), Failure>,
    studies: impl IntoIterator<Item = &'r Report>,
    mut mismatches: usize,
    interrupted: bool,
) -> Result<ExitCode, Failure> {
    let mut others = 0;
    for study in studies {
        mismatches += study.mismatches().count();
        for row in study.other_work() {
            others += 1;
            tell_of_other_work(study, row);
        }
    }
    let code = ended(written, mismatches, interrupted)?;
    Ok(match others {
        0 => code,
        _ => ExitCode::from(MISMATCH),
    })
}

/// Says by how much a program of somebody else differs.
fn tell_of_other_work(study: &Report, row: &ResultRow) {
    let ours = study.rows(row.operation);
    let mut ours = ours.filter(|other| other.agreement == Agreement::Same);
    let ours = ours.find_map(|other| other.checksum);
    let [theirs, ours] = [row.checksum, ours].map(|checksum| match checksum {
        Some(checksum) => checksum.to_string(),
        None => "not a number".into(),
    });
    let (name, operation, mesh) = (&row.backend, row.operation, &study.mesh.name);
    complain(&format!(
        "error: {mesh}: {name}: {operation} comes to {theirs}, and to {ours} on our backends: other work, so its times compare nothing"
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_comes_before_an_interruption() {
        let code = |mismatches, interrupted| {
            let ended = ended(Ok(()), mismatches, interrupted).expect("all is written");
            format!("{ended:?}")
        };
        let known = |code: u8| format!("{:?}", ExitCode::from(code));
        assert_eq!(code(0, false), known(0));
        assert_eq!(code(0, true), known(INTERRUPTED));
        assert_eq!(code(2, true), known(MISMATCH));
        assert!(ended(Err(Failure::usage("full disk")), 1, true).is_err());
    }
}
