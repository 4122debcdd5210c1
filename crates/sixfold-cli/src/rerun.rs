//! `sixfold rerun`: measures saved results again, and says which conclusions stand.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use sixfold_results::numbers::counted;
use sixfold_results::{
    Conclusion, Fate, Finding, MeshReport, Results, Run, conclusions, differences,
};
use sixfold_study::start_run;

use crate::arguments::Rerun;
use crate::failure::Failure;
use crate::load::{file_hash, read_results, results_path};
use crate::mesh_files::shown;
use crate::output::{Output, check_not_overwritten, check_outputs, is_stdout};
use crate::progress::INTERRUPTED;
use crate::text::{TextOutput, hanging_indent, sanitize};

/// The exit code if a conclusion is reversed, or if results differ between backends or are missing.
const REVERSED: u8 = 1;
/// Options with a value that are not repeated: those that name files to write, and those that are only for a report.
const LEFT_OUT: [&str; 10] = [
    "--json",
    "--csv",
    "--samples-csv",
    "--markdown",
    "--report",
    "--figures",
    "--save-baseline",
    "--baseline",
    "--labs",
    "--shard",
];
/// Options without a value that are not repeated.
const FLAGS: [&str; 1] = ["--resume"];

pub(crate) fn run(arguments: &Rerun) -> Result<ExitCode, Failure> {
    let place = results_path(&arguments.results);
    let outputs = [("--json", arguments.json.as_ref())];
    check_not_overwritten("the results", &place, &outputs)?;
    check_outputs(None, &outputs)?;
    let before = read_results(&arguments.results)?;
    let folders = folders(&place, arguments.meshes.as_deref());
    let commands = commands(&before, &folders)?;
    let json = Output::open_if(arguments.json.as_ref())?;
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    for command in &commands {
        print_environment(command.run, &mut text);
    }
    let mut after = Results::default();
    let mut is_unsound = false;
    for Repeated { words, .. } in &commands {
        let line = shlex::try_join(words.iter().map(String::as_str)).unwrap_or_default();
        text.print_line(&hanging_indent("running ", &sanitize(&line)));
        let (results, code) = measure(words)?;
        is_unsound |= code == REVERSED;
        results
            .findings
            .into_iter()
            .for_each(|finding| after.add(finding));
        after.add_notices(results.notices);
        if code == INTERRUPTED {
            break;
        }
    }
    let found = conclusions(&before, &after);
    print(&found, &mut text);
    let interrupted = after.is_interrupted();
    text.finish()?;
    if let Some(output) = json {
        output.finish(|writer| after.write_json(writer))?;
    }
    let reversed = found.iter().any(|c| matches!(c.fate, Fate::Reversed(_)));
    Ok(match () {
        () if reversed || is_unsound => ExitCode::from(REVERSED),
        () if interrupted => ExitCode::from(INTERRUPTED),
        () => ExitCode::SUCCESS,
    })
}

/// A command that is run again.
struct Repeated<'r> {
    run: &'r Run,
    /// The arguments, with the paths of the meshes as they are now.
    words: Vec<String>,
}

/// Returns the folders in which meshes are looked for: the present one, that of the results, and the given one.
fn folders(results: &Path, given: Option<&Path>) -> Vec<PathBuf> {
    let beside = results.parent().map(Path::to_owned);
    let all = [Some(PathBuf::new()), beside, given.map(Path::to_owned)];
    all.into_iter().flatten().collect()
}

/// Returns the commands that measured the results, each once.
fn commands<'r>(before: &'r Results, folders: &[PathBuf]) -> Result<Vec<Repeated<'r>>, Failure> {
    let mut known = BTreeSet::new();
    let mut commands: Vec<Repeated<'r>> = Vec::new();
    for finding in &before.findings {
        let run = finding.run();
        let Some(command) = &run.command else {
            return Err(Failure::usage(format!(
                "the results of a {} have no command, so they cannot be measured again",
                finding.kind()
            )));
        };
        if !known.insert(command) {
            continue;
        }
        let words = shlex::split(command).unwrap_or_default();
        let Some((_, words)) = words.split_first() else {
            return Err(Failure::usage(format!(
                "the command `{}` cannot be repeated",
                sanitize(command)
            )));
        };
        let of_command = before.findings.iter();
        let of_command = of_command.filter(|other| other.run().command == run.command);
        let meshes: Vec<&MeshReport> = of_command.flat_map(Finding::meshes).collect();
        let words = without_outputs(words)
            .into_iter()
            .map(|word| located(word, &meshes, folders));
        commands.push(Repeated {
            run,
            words: words.collect::<Result<Vec<String>, Failure>>()?,
        });
    }
    if commands.is_empty() {
        return Err(Failure::usage(
            "the file has no results, so there is nothing to measure again",
        ));
    }
    Ok(commands)
}

/// Returns the words of a command without the options that write files.
fn without_outputs(words: &[String]) -> Vec<String> {
    let mut kept = Vec::new();
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let name = word.split_once('=').map_or(word.as_str(), |(name, _)| name);
        match () {
            () if FLAGS.contains(&name) => {}
            () if LEFT_OUT.contains(&name) && name != word => {}
            () if LEFT_OUT.contains(&name) => {
                words.next();
            }
            () => kept.push(word.clone()),
        }
    }
    kept
}

/// Returns the present path of the mesh that `word` names. Other words stay as they are.
fn located(word: String, meshes: &[&MeshReport], folders: &[PathBuf]) -> Result<String, Failure> {
    let path = Path::new(&word);
    let file_name = path.file_name();
    let named = meshes
        .iter()
        .find(|mesh| Path::new(&mesh.name).file_name() == file_name);
    let Some((mesh, hash)) = named.and_then(|mesh| Some((mesh, mesh.file_sha256.as_ref()?))) else {
        return Ok(word);
    };
    let candidates = folders.iter().flat_map(|folder| {
        let beside = file_name.map(|name| folder.join(name));
        [Some(folder.join(path)), beside].into_iter().flatten()
    });
    let candidates: Vec<PathBuf> = candidates.filter(|path| path.is_file()).collect();
    let same = candidates
        .iter()
        .find(|path| file_hash(path).as_ref() == Some(hash));
    match (same, candidates.first()) {
        (Some(path), _) => Ok(path.to_string_lossy().into_owned()),
        (None, Some(other)) => Err(Failure::usage(format!(
            "{}: is not the mesh {} of the results: its content differs",
            shown(other),
            sanitize(&mesh.name)
        ))),
        (None, None) => Err(Failure::usage(format!(
            "the mesh {} is missing: give its folder with --meshes",
            sanitize(&mesh.name)
        ))),
    }
}

/// Prints how this machine and program differ from those of the results.
fn print_environment(run: &Run, text: &mut TextOutput) {
    let now = Run {
        settings: run.settings.clone(),
        tags: run.tags.clone(),
        ..start_run(run.settings.clone())
    };
    for change in differences(run, &now) {
        let first = format!("{:<13}", change.what);
        let both = format!("{} → {}", change.before, change.after);
        text.print_line(&hanging_indent(&first, &sanitize(&both)));
    }
}

/// Runs a command of this program. Returns its document and its exit code.
fn measure(words: &[String]) -> Result<(Results, u8), Failure> {
    let cannot_run =
        |cause: std::io::Error| Failure::usage(format!("cannot run the command: {cause}"));
    let output = Command::new(std::env::current_exe().map_err(cannot_run)?)
        .args(words)
        .args(["--json", "-"])
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .map_err(cannot_run)?;
    let code = output
        .status
        .code()
        .and_then(|code| u8::try_from(code).ok());
    let results = Results::read_json(&String::from_utf8_lossy(&output.stdout));
    match (results, code) {
        (Ok(results), Some(code @ (0 | REVERSED | INTERRUPTED))) => Ok((results, code)),
        _ => Err(Failure {
            code: code.filter(|&code| code > REVERSED).unwrap_or(2),
            message: format!("the command ended with {}, without results", output.status),
        }),
    }
}

/// Prints the conclusions.
fn print(conclusions: &[Conclusion], text: &mut TextOutput) {
    text.print_line("");
    if conclusions.is_empty() {
        let none = "The results name no backend that is alone the fastest, so there is no conclusion to confirm.";
        text.print_list("- ", [none]);
        return;
    }
    let count = |is: &dyn Fn(&Fate) -> bool| {
        conclusions
            .iter()
            .filter(|conclusion| is(&conclusion.fate))
            .count()
    };
    let stand = count(&|fate| *fate == Fate::Stands);
    let open = count(&|fate| *fate == Fate::CannotTell);
    let reversed = conclusions.len() - stand - open;
    text.print_list(
        "- ",
        [format!(
            "Of {}, {stand} stand, {reversed} {} reversed, and {open} cannot be told.",
            counted(conclusions.len(), "conclusion", "conclusions"),
            if reversed == 1 { "is" } else { "are" },
        )],
    );
    for conclusion in conclusions {
        let Conclusion {
            of, winner, meshes, ..
        } = conclusion;
        let on = match &meshes[..] {
            [] => String::new(),
            meshes => format!(" on {}", meshes.join(", ")),
        };
        let line = match &conclusion.fate {
            Fate::Stands => continue,
            Fate::Reversed(now) => format!("{of}{on}: {winner} was the fastest, and now {now} is."),
            Fate::CannotTell => {
                format!("{of}{on}: {winner} was the fastest, and now none is alone.")
            }
        };
        text.print_list("- ", [sanitize(&line)]);
    }
}
