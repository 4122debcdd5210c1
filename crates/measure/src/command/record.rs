//! Records programs of a user as traces.

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use sixfold_results::numbers::{counted, duration};

use crate::command::arguments::Arguments;
use crate::command::failure::Failure;
use crate::command::load::study_meshes;
use crate::command::meshes::find_meshes;
use crate::command::output::Output;
use crate::command::programs::print_meshes;
use crate::command::progress::{INTERRUPTED, Line, interrupt_flag};
use crate::command::run::warn_of_debug_build;
use crate::command::text::{TextOutput, hanging_indent, print_notice, print_stderr, sanitize};
use crate::{ProgramSettings, RecordedProgram, Suite, record_program};

/// Records each program of `suite` on one mesh, and writes the files to `folder`.
pub(super) fn run(
    suite: &Suite,
    settings: &ProgramSettings,
    folder: &Path,
    arguments: &Arguments,
) -> Result<ExitCode, Failure> {
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_notice(note))?;
    // A mesh that cannot be read must not make one of two meshes the single one.
    let loaded = match meshes.len() {
        1 => study_meshes(&meshes, arguments.read, arguments.triangulate)?.0,
        _ => Vec::new(),
    };
    let [study_mesh] = &loaded[..] else {
        return Err(Failure::usage(
            "--record needs a single mesh: name one file",
        ));
    };
    if study_mesh.polygons.face_count() == 0 {
        return Err(Failure::usage(format!(
            "{}: the mesh has no face",
            study_mesh.name
        )));
    }
    warn_of_debug_build();
    let cannot_write = |error: std::io::Error| {
        Failure::usage(format!("{}: cannot be made: {error}", folder.display()))
    };
    fs::create_dir_all(folder).map_err(cannot_write)?;
    let mut text = TextOutput::new(true);
    print_meshes(&loaded, &mut text);
    let stop = interrupt_flag(settings.heap);
    let line = Line::new();
    let each = ProgramSettings {
        effort: settings
            .effort
            .part(1.0 / suite.programs().len().max(1) as f64),
        ..settings.clone()
    };
    let mut failed = false;
    for (i, program) in suite.programs().iter().enumerate() {
        line.set(i as f64 / suite.programs().len() as f64, program.name());
        let recorded = record_program(study_mesh, program, &each, &stop);
        if stop.load(Ordering::Relaxed) {
            return Ok(ExitCode::from(INTERRUPTED));
        }
        match recorded {
            Ok(recorded) => write(&recorded, folder, &mut text)?,
            Err(reason) => {
                failed = true;
                print_stderr(&format!("error: {}", sanitize(&reason.to_string())));
            }
        }
    }
    line.clear();
    text.finish()?;
    Ok(ExitCode::from(u8::from(failed)))
}

/// Writes the trace of a program.
fn write(recorded: &RecordedProgram, folder: &Path, text: &mut TextOutput) -> Result<(), Failure> {
    let trace = &recorded.run.trace;
    let path = folder.join(format!("{}.trace", file_name(&trace.program)));
    Output::open(&path)?.finish(|to| trace.write(to))?;
    let line = format!(
        "{}: {} in {} on {}; {}",
        sanitize(&trace.program),
        counted(trace.len(), "call", "calls"),
        duration(recorded.run_ns),
        recorded.structure,
        path.display()
    );
    text.print_line(&hanging_indent("Recorded: ", &line));
    Ok(())
}

/// Returns a file name for a program: letters, digits, `-` and `_` of its name.
fn file_name(program: &str) -> String {
    let kept = |c: char| match c.is_alphanumeric() || matches!(c, '-' | '_') {
        true => c,
        false => '-',
    };
    match program.is_empty() {
        true => "program".into(),
        false => program.chars().map(kept).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_programs_become_names_of_files() {
        assert_eq!(file_name("geodesics"), "geodesics");
        assert_eq!(file_name("../a b"), "---a-b");
        assert_eq!(file_name(""), "program");
    }
}
