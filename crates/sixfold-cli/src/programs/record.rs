//! Records programs of a user as workloads and traces.

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use sixfold_results::numbers::{counted, duration};
use sixfold_study::{ProgramSettings, RecordedProgram, Suite, record_program};

use crate::arguments::Programs;
use crate::failure::Failure;
use crate::many::find_meshes;
use crate::measure::warn_of_debug_build;
use crate::output::Output;
use crate::pick;
use crate::progress::{Bar, INTERRUPTED, interrupt_flag};
use crate::text::{TextOutput, hanging_indent, print_notice, print_stderr, sanitize};

/// Records each program of `suite` on one mesh, and writes the files to `folder`.
pub(super) fn run(
    suite: &Suite,
    settings: &ProgramSettings,
    folder: &Path,
    arguments: &Programs,
) -> Result<ExitCode, Failure> {
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_notice(note))?;
    // A mesh that cannot be read must not make one of two meshes the single one.
    let study_meshes = match meshes.len() {
        1 => pick::study_meshes(&meshes, arguments.read, arguments.triangulate)?.0,
        _ => Vec::new(),
    };
    let [study_mesh] = &study_meshes[..] else {
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
    super::print_meshes(&study_meshes, &mut text);
    let stop = interrupt_flag(settings.heap);
    let bar = Bar::new();
    let each = ProgramSettings {
        effort: settings
            .effort
            .part(1.0 / suite.programs().len().max(1) as f64),
        ..settings.clone()
    };
    let mut failed = false;
    for (i, program) in suite.programs().iter().enumerate() {
        bar.set(i as f64 / suite.programs().len() as f64, program.name());
        let recorded = record_program(study_mesh, program, &each, &stop);
        if stop.load(Ordering::Relaxed) {
            return Ok(ExitCode::from(INTERRUPTED));
        }
        match recorded {
            Ok(recorded) => write(&recorded, folder, arguments.traces, &mut text)?,
            Err(reason) => {
                failed = true;
                print_stderr(&format!("error: {}", sanitize(&reason.to_string())));
            }
        }
    }
    bar.clear();
    text.finish()?;
    Ok(ExitCode::from(u8::from(failed)))
}

/// Writes the workload and the trace of a program.
fn write(
    recorded: &RecordedProgram,
    folder: &Path,
    traces: bool,
    text: &mut TextOutput,
) -> Result<(), Failure> {
    let recording = &recorded.recording;
    let name = file_name(&recording.trace.program);
    let path = folder.join(format!("{name}.toml"));
    let file = recording.workload_file();
    Output::open(&path)?.finish(|to| to.write_all(file.as_bytes()))?;
    let mut written = vec![path.display().to_string()];
    if traces {
        let path = folder.join(format!("{name}.trace"));
        Output::open(&path)?.finish(|to| recording.trace.write(to))?;
        written.push(path.display().to_string());
    }
    let line = format!(
        "{}: {} in {} on {}; {}",
        sanitize(&recording.trace.program),
        counted(recording.trace.len(), "call", "calls"),
        duration(recorded.run_ns),
        recorded.structure,
        written.join(", ")
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
