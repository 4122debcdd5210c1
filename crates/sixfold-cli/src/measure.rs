//! The common steps of all commands that write results: open the files before the measurement,
//! print the text before the files are written, and derive the exit code from the results.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sixfold_report::ReportPage;
use sixfold_results::numbers::counted;
use sixfold_results::{Agreement, FailureKind, Policy, Report, ResultRow, Results};
use sixfold_study::StudyMesh;

use crate::arguments::ResultFiles;
use crate::baselines::Baselines;
use crate::failure::Failure;
use crate::launches::{self, Launch};
use crate::mesh_picture::with_picture;
use crate::output::{Output, check_outputs, uses_stdout};
use crate::progress::{INTERRUPTED, interrupt_flag};
use crate::text::{TextOutput, print_stderr, take_notices};
pub(crate) use sixfold_measure::command::run::{command_line, warn_of_debug_build, with_command};

/// The exit code if backends found different results for the same work, or if a part could not be measured.
const MISMATCH: u8 = 1;

/// A command that writes results, between the opening of its files and the writing of the results.
pub(crate) struct Session {
    /// Set by Ctrl-C.
    pub(crate) stop: Arc<AtomicBool>,
    /// Prints nothing if results are written to standard output.
    pub(crate) text: TextOutput,
    tags: Vec<(String, String)>,
    baselines: Baselines,
    files: OpenFiles,
}

/// The open files of [`ResultFiles`].
struct OpenFiles {
    json: Option<Output>,
    csv: Option<Output>,
    samples_csv: Option<Output>,
    markdown: Option<Output>,
}

impl Session {
    /// Opens the files. Returns an error if a file cannot be written or would overwrite one of
    /// `meshes`, or if two options name the same file.
    pub(crate) fn open<'p>(
        meshes: impl IntoIterator<Item = &'p Path>,
        files: &ResultFiles,
        heap: Policy,
    ) -> Result<Self, Failure> {
        check_outputs(None, &files.options())?;
        for mesh in meshes {
            check_outputs(Some(mesh), &files.options())?;
        }
        // Set the handler before the drafts are created, so that Ctrl-C always deletes the drafts.
        let stop = interrupt_flag(heap);
        if let Some(launch) = Launch::current() {
            launch.stop_with_parent(&stop);
            return Ok(Self {
                stop,
                text: TextOutput::new(false),
                tags: Vec::new(),
                baselines: Baselines::default(),
                files: OpenFiles {
                    json: Output::open_if(Some(&PathBuf::from("-")))?,
                    csv: None,
                    samples_csv: None,
                    markdown: None,
                },
            });
        }
        Ok(Self {
            stop,
            text: TextOutput::new(!uses_stdout(&files.options())),
            tags: files.tags.clone(),
            baselines: Baselines::open(files)?,
            files: OpenFiles {
                json: Output::open_if(files.json.as_ref())?,
                csv: Output::open_if(files.csv.as_ref())?,
                samples_csv: Output::open_if(files.samples_csv.as_ref())?,
                markdown: Output::open_if(files.markdown.as_ref())?,
            },
        })
    }

    /// Adds a picture to a mesh if the results are written as a document, which reports are drawn from.
    pub(crate) fn drawn(&self, study_mesh: StudyMesh) -> StudyMesh {
        match self.files.json {
            Some(_) if Launch::current().is_none() => with_picture(study_mesh),
            _ => study_mesh,
        }
    }

    /// Prints the remaining text, writes the files, and returns the exit code of the results.
    pub(crate) fn finish(
        self,
        mut results: Results,
        keep_going: bool,
    ) -> Result<ExitCode, Failure> {
        let interrupted = results.is_interrupted();
        let written = self.write(&mut results);
        measured_code(written, &results, interrupted, keep_going)
    }

    /// Prints the remaining text, adds the notices and the tags to the results, compares them with the baseline, and
    /// writes the files. If one file
    /// cannot be written, writes the others anyway, and returns the first error.
    pub(crate) fn write(mut self, results: &mut Results) -> Result<(), Failure> {
        results.add_notices(take_notices());
        for finding in &mut results.findings {
            finding.run_mut().tags.extend(self.tags.iter().cloned());
        }
        self.baselines.print_changes(results, &mut self.text);
        let OpenFiles {
            json,
            csv,
            samples_csv,
            markdown,
        } = self.files;
        let mut done = self.text.finish().and(self.baselines.save(results));
        if let Some(output) = json {
            done = done.and(output.finish(|writer| {
                launches::mark_document(writer)?;
                results.write_json(writer)
            }));
        }
        if let Some(output) = csv {
            done = done.and(output.finish(|writer| results.write_csv(writer)));
        }
        if let Some(output) = samples_csv {
            done = done.and(output.finish(|writer| results.write_samples_csv(writer)));
        }
        if let Some(output) = markdown {
            let tables = ReportPage::new(results, &command_line()).markdown_tables();
            done = done.and(output.finish(|writer| writer.write_all(tables.as_bytes())));
        }
        done
    }
}

/// Prints the final messages of a command and returns its exit code. An error of writing
/// (`written`) takes precedence over different results, and different results take precedence over
/// an interruption.
pub(crate) fn exit_code(
    written: Result<(), Failure>,
    results: &Results,
    interrupted: bool,
) -> Result<ExitCode, Failure> {
    let mut others = 0;
    for study in results.studies() {
        for row in study.external_mismatches() {
            others += 1;
            print_different_work(study, row);
        }
    }
    let of_programs = results.picks().any(|pick| pick.program.is_some());
    let cause = match of_programs {
        true => {
            "The result of a program must not depend on the order in which a query lists the neighbours"
        }
        false => "This is a fault in Sixfold: please report it",
    };
    let end = match interrupted || launches::has_ended_early() {
        true => INTERRUPTED,
        false => 0,
    };
    let code = code_of(written, results.mismatches(), cause, end)?;
    if interrupted {
        print_stderr(match results.findings.is_empty() {
            true => "interrupted: no result was finished",
            false => "interrupted: finished results are kept",
        });
    }
    Ok(match others > 0 {
        true => ExitCode::from(MISMATCH),
        false => code,
    })
}

/// Prints the final messages of a command that measured, as [`exit_code`] does, and returns its exit code. If a
/// part could not be measured, the results lack it: this is an error, or a note if `keep_going` is set.
pub(crate) fn measured_code(
    written: Result<(), Failure>,
    results: &Results,
    interrupted: bool,
    keep_going: bool,
) -> Result<ExitCode, Failure> {
    let code = exit_code(written, results, interrupted)?;
    let lacking = lacking(results);
    if interrupted || lacking.is_empty() {
        return Ok(code);
    }
    for (what, remedy) in lacking {
        print_stderr(&match keep_going {
            true => format!("note: {what}"),
            false => format!(
                "error: {what}: {remedy}. The other results are complete; with --keep-going, this is no error"
            ),
        });
    }
    Ok(match keep_going {
        true => code,
        false => ExitCode::from(MISMATCH),
    })
}

/// Maximum number of meshes that a message names.
const NAMED: usize = 5;

/// Returns what could not be measured, each with its remedy.
fn lacking(results: &Results) -> Vec<(String, String)> {
    let mut lacking = Vec::new();
    let failed = results.failures.iter();
    let failed = failed.filter(|failed| failed.kind == FailureKind::NotMeasured);
    let failed: Vec<&str> = failed.map(|failed| failed.mesh.as_str()).collect();
    if !failed.is_empty() {
        let mut names = failed[..failed.len().min(NAMED)].join(", ");
        if failed.len() > NAMED {
            names += &format!(" and {} more", failed.len() - NAMED);
        }
        lacking.push((
            format!("not measured: {names}"),
            "repair the files, for the reasons in the notes above, or leave them out".into(),
        ));
    }
    for study in results.studies() {
        let programs = study.backends.iter().filter_map(|backend| {
            let failed = backend.external.as_ref()?.failed.as_ref()?;
            Some((&backend.name, failed))
        });
        lacking.extend(programs.map(|(name, why)| {
            let what = format!("{}: results of {name} are missing: {why}", study.mesh.name);
            (
                what,
                format!("correct the program, or leave out --external {name}"),
            )
        }));
    }
    if launches::has_died() {
        let what = "a launch is missing, for the reason in the note above";
        lacking.push((what.into(), "measure again".into()));
    }
    lacking
}

/// Returns the exit code without regard to external programs, and prints the message about different
/// results. `end` is the exit code if no results differ.
fn code_of(
    written: Result<(), Failure>,
    mismatches: usize,
    cause: &str,
    end: u8,
) -> Result<ExitCode, Failure> {
    if mismatches > 0 {
        let results = counted(mismatches, "result differs", "results differ");
        print_stderr(&format!(
            "error: {results} from the results of other backends for the same work. {cause}"
        ));
    }
    written?;
    Ok(ExitCode::from(if mismatches > 0 { MISMATCH } else { end }))
}

/// Prints an error about a result of an external program that differs from the results of Sixfold.
fn print_different_work(study: &Report, row: &ResultRow) {
    let ours = study.rows(&row.operation);
    let mut ours = ours.filter(|other| other.agreement == Agreement::Same);
    let ours = ours.find_map(|other| other.checksum);
    let [theirs, ours] = [row.checksum, ours].map(|checksum| match checksum {
        Some(checksum) => checksum.to_string(),
        None => "not a number".into(),
    });
    let (name, operation, mesh) = (&row.backend, &row.operation, &study.mesh.name);
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
        let code = |mismatches, end| {
            let result = code_of(Ok(()), mismatches, "", end).expect("all is written");
            format!("{result:?}")
        };
        let known = |code: u8| format!("{:?}", ExitCode::from(code));
        assert_eq!(code(0, 0), known(0));
        assert_eq!(code(0, INTERRUPTED), known(INTERRUPTED));
        assert_eq!(code(2, INTERRUPTED), known(MISMATCH));
        assert!(code_of(Err(Failure::usage("full disk")), 1, "", INTERRUPTED).is_err());
    }
}
