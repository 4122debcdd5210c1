//! `sixfold workloads`: lists the built-in workloads and the operations of a mix.

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use serde_json::json;
use sixfold::UnknownName;
use sixfold_study::{
    Action, Effort, ProgramSettings, Trace, Workload, built_in, built_ins, workload_of_trace,
};

use crate::arguments::Workloads;
use crate::failure::Failure;
use crate::load;
use crate::output::{Output, is_stdout};
use crate::progress::{INTERRUPTED, interrupt_flag};
use crate::text::{TextOutput, hanging_indent};

/// Maximum size of a workload file in bytes.
const MAX_FILE_BYTES: u64 = 1 << 20;

pub(crate) fn run(arguments: &Workloads) -> Result<ExitCode, Failure> {
    if let Some(name) = &arguments.show {
        let file = built_ins().find(|(known, _)| known == name);
        let (_, file) = file.ok_or_else(|| unknown(name))?;
        let mut text = TextOutput::new(true);
        text.print_line(file.trim_end());
        text.finish()?;
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(path) = &arguments.trace {
        return print_trace(path, arguments);
    }
    let json = Output::open_if(arguments.json.as_ref())?;
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    text.print_line(&match arguments.operations {
        true => operations(),
        false => list(),
    });
    let all: Vec<Workload> = built_ins().filter_map(|(name, _)| built_in(name)).collect();
    text.finish_with_json(json, &json!(all))
}

/// Prints the calls of a trace as a workload file.
fn print_trace(path: &Path, arguments: &Workloads) -> Result<ExitCode, Failure> {
    let trace = read_trace(path)?;
    let mesh = arguments.mesh.as_deref();
    let mesh = load::mesh_or_built_in(mesh, arguments.read, false, arguments.triangulate)?;
    let settings = ProgramSettings {
        effort: Effort::Budget(arguments.budget),
        ..ProgramSettings::default()
    };
    let stop = interrupt_flag(settings.heap);
    let recording = workload_of_trace(&mesh, &trace, &settings, &stop);
    let recording = recording.map_err(Failure::usage)?;
    if stop.load(Ordering::Relaxed) {
        return Ok(ExitCode::from(INTERRUPTED));
    }
    let mut text = TextOutput::new(true);
    text.print_line(recording.workload_file().trim_end());
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Reads a trace. Without a name of the program in the file, it has the name of the file.
pub(crate) fn read_trace(path: &Path) -> Result<Trace, Failure> {
    let shown = path.display().to_string();
    let cannot_read = |error: std::io::Error| Failure::usage(format!("{shown}: {error}"));
    let file = std::fs::File::open(path).map_err(cannot_read)?;
    let trace = Trace::read(&shown, std::io::BufReader::new(file));
    let mut trace = trace.map_err(Failure::usage)?;
    if trace.program.is_empty() {
        let stem = path.file_stem().unwrap_or(path.as_os_str());
        trace.program = stem.to_string_lossy().into_owned();
    }
    Ok(trace)
}

/// Returns the built-in workload with the name `word`. If no built-in workload has this name, reads
/// the workload file `word`.
pub(crate) fn workload(word: &str) -> Result<Workload, Failure> {
    let path = Path::new(word);
    let is_file = path.extension().is_some_and(|ending| ending == "toml");
    if !is_file {
        return built_in(word).ok_or_else(|| unknown(word));
    }
    let cannot_read = |error: std::io::Error| {
        Failure::usage(format!(
            "{word}: {error}: name a workload file, or a workload from `sixfold workloads`"
        ))
    };
    let length = std::fs::metadata(path).map_err(cannot_read)?.len();
    if length > MAX_FILE_BYTES {
        return Err(Failure::usage(format!(
            "{word}: the file has {length} bytes, but a workload file has only a few lines: for an \
             example, see `sixfold workloads --show smoothing`"
        )));
    }
    let text = std::fs::read_to_string(path).map_err(cannot_read)?;
    let name = path.file_stem().map(|stem| stem.to_string_lossy());
    Workload::parse(&name.unwrap_or_default(), word, &text).map_err(Failure::usage)
}

fn unknown(name: &str) -> Failure {
    let error = UnknownName::new("workload", name, built_ins().map(|(name, _)| name));
    Failure::usage(format!("{error}, or name a file that ends in .toml"))
}

fn list() -> String {
    let mut lines = Vec::new();
    for (name, _) in built_ins() {
        let Some(workload) = built_in(name) else {
            continue;
        };
        lines.push(name.to_owned());
        lines.push(hanging_indent("  ", &workload.summary));
        let mix = workload
            .mix
            .iter()
            .map(|part| format!("{} {}", part.weight, part.action));
        let mix = mix.collect::<Vec<_>>().join(", ");
        let rebuilt = match workload.rebuilds {
            0 => String::new(),
            1 => ", rebuilt once".into(),
            times => format!(", rebuilt {times} times"),
        };
        let access = workload.access;
        let operations = workload.operations;
        lines.push(hanging_indent(
            "  ",
            &format!("access: {access}; operations: {operations}{rebuilt}; mix: {mix}"),
        ));
    }
    lines.join("\n")
}

fn operations() -> String {
    let names = |of: fn(&Action) -> bool| {
        let all = Action::all().into_iter().filter(of);
        all.map(Action::name).collect::<Vec<_>>().join(", ")
    };
    let on_elements = names(|action| action.kind().is_some());
    let edits = names(|action| matches!(action, Action::Edit(_)));
    let passes = names(|action| action.is_pass());
    [
        hanging_indent("One element:  ", &on_elements),
        hanging_indent("One edit:     ", &edits),
        hanging_indent("Whole passes: ", &passes),
        String::new(),
        hanging_indent(
            "",
            "A weight is a number, or a text such as \"2 per face\". `access` is sequential, random, patches, front, by_face or by_edge.",
        ),
    ]
    .join("\n")
}
