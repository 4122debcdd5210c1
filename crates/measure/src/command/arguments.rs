//! The arguments of a command line that measures programs.

use std::ffi::OsString;
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use lexopt::prelude::*;
use sixfold::io::Scene;
use sixfold_results::{Confidence, Policy};

use crate::command::failure::Failure;
use crate::command::launches;
use crate::command::mesh_files::ReadFiles;
use crate::command::text::hanging_indent;
use crate::engine::effort::Effort;

/// The help text without the names of the programs.
const HELP: &str = "\
Measures programs on every mesh data structure, and ranks the structures.

Each program runs on each structure that can hold the mesh. The structures take
turns in rounds. The output names the fastest structure, and shows confidence
intervals, the memory, and the number of runs after which the time to build the
structure is saved.

Usage: PROGRAM [OPTIONS] [MESH|DIR]...

Arguments:
  [MESH|DIR]...  Meshes, or folders with meshes; without any, a built-in mesh of
                 20,000 triangles

Options:
  --programs NAME,…     Measure only these programs, by name
  --backends NAME,…     Use only these structures, by name
  --runs N              Number of runs of a program on one mesh, to weigh the
                        time to build a structure [default: 1]
  --max-memory BYTES    Memory limit for the structure, such as 2GiB or 500MB
  --budget TIME         Total time to measure, such as 20s, 500ms or 2m
                        [default: 20s]
  --rounds N            Measure exactly N rounds, without a time limit
  --launches N          Measure in N fresh processes [default: by the budget]
  --confidence LEVEL    Confidence of all intervals, such as 99% or 0.99
                        [default: 95%]
  --keep-going          Exit code 0 also if a part cannot be measured or a
                        program fails; a note names it
  --seed N              Seed of the random order of the measurements
                        [default: 1]
  --heap POLICY         Freed memory: kept (by the process) or system
                        [default: kept]
  --isolate             Run each structure in a process of its own: if the
                        program crashes, does not end or uses too much memory on
                        one structure, the others are still measured. One launch
  --time-limit TIME     Time limit for each sample [default, if each structure
                        has its own process: a quarter of the budget; otherwise
                        the command ends after three times the budget and 30 s]
  --memory-limit BYTES  Memory limit for each process, such as 4GiB [default:
                        nine tenths of the free memory]
  --record DIR          Write all calls of each program to DIR/PROGRAM.trace,
                        for `sixfold pick --trace` and `sixfold workloads
                        --trace`, and no other file
  --order canonical     Run each program once on each structure, in the
                        structure's own order and in one order of all elements
                        and results, and compare the results; measures nothing
  --json FILE           Write all results as JSON (- for standard output), for
                        `sixfold report`, `compare`, `merge` and `history`
  --tag KEY=VALUE       Keep KEY=VALUE in the results; may be repeated
  --triangulate         First cut every polygon into triangles
  --as-stored           Do not merge vertices at equal positions: neither those
                        of STL files nor those at seams
  --recentre            Move meshes to the origin before coordinates are rounded
                        to 32 bits
  --scene N|all         Scene of glTF files to read: its number, or all for
                        every node and mesh [default: the file's default scene]
  -h, --help            Print help
  -V, --version         Print version
";

/// What follows the help of the options, after the names of the programs.
const AFTER: &str = "\
Launches: Fresh processes of this command measure one after the other, each all
programs. What they print is not shown. If a program does not end or uses too
much memory, its launch is the last one. If a program crashes, its launch is
left out.

Exit codes: 0 success; 1 a program fails on a structure, or none qualifies for
it, results differ between structures, a launch is left out, or a mesh of
several cannot be read; 2 wrong usage or unusable input, or all launches are
left out; 4 interrupted, or a program did not end; finished results are kept.
";

/// The default budget.
const BUDGET: Duration = Duration::from_secs(20);

/// The arguments.
#[derive(Debug)]
pub struct Arguments {
    pub meshes: Vec<PathBuf>,
    pub programs: Vec<String>,
    pub backends: Vec<String>,
    pub runs: u64,
    pub max_memory: Option<u64>,
    pub effort: Effort,
    pub launches: Option<NonZeroU32>,
    pub confidence: Confidence,
    pub keep_going: bool,
    pub seed: u64,
    pub heap: Policy,
    pub isolate: bool,
    pub time_limit: Option<Duration>,
    pub memory_limit: Option<u64>,
    pub record: Option<PathBuf>,
    pub canonical_order: bool,
    pub json: Option<PathBuf>,
    pub tags: Vec<(String, String)>,
    pub triangulate: bool,
    pub read: ReadFiles,
    /// What a child process runs, as JSON.
    pub child: Option<String>,
}

/// What the arguments ask for.
#[derive(Debug)]
pub enum Asked {
    /// To measure.
    Measure(Box<Arguments>),
    /// To print the help.
    Help,
    /// To print the version.
    Version,
}

/// Returns the help of a command line with these programs.
pub fn help(names: &[&str]) -> String {
    let names = hanging_indent("Programs: ", &names.join(", "));
    format!("{HELP}\n{names}\n\n{AFTER}")
}

/// Parses the words after the name of the command.
///
/// # Errors
///
/// Returns an error that names the option.
pub fn parse(words: impl IntoIterator<Item = OsString>) -> Result<Asked, Failure> {
    let mut all = Arguments {
        meshes: Vec::new(),
        programs: Vec::new(),
        backends: Vec::new(),
        runs: 1,
        max_memory: None,
        effort: Effort::Budget(BUDGET),
        launches: None,
        confidence: Confidence::default(),
        keep_going: false,
        seed: 1,
        heap: Policy::Kept,
        isolate: false,
        time_limit: None,
        memory_limit: None,
        record: None,
        canonical_order: false,
        json: None,
        tags: Vec::new(),
        triangulate: false,
        read: ReadFiles::default(),
        child: None,
    };
    let (mut budget, mut rounds) = (None, None);
    let mut parser = lexopt::Parser::from_args(words);
    let wrong = |error: lexopt::Error| Failure::usage(format!("{error}: see --help"));
    while let Some(argument) = parser.next().map_err(wrong)? {
        let name = match argument {
            Value(mesh) => {
                all.meshes.push(mesh.into());
                continue;
            }
            Short('h') => return Ok(Asked::Help),
            Short('V') => return Ok(Asked::Version),
            Short(_) => return Err(wrong(argument.unexpected())),
            Long(name) => name.to_owned(),
        };
        let mut value = || parser.value().map_err(wrong);
        let mut text = || {
            let value = value()?;
            let not_text = |_| Failure::usage(format!("--{name}: the value is not UTF-8"));
            value.into_string().map_err(not_text)
        };
        match name.as_str() {
            "help" => return Ok(Asked::Help),
            "version" => return Ok(Asked::Version),
            "programs" => all.programs.extend(names(&text()?)),
            "backends" => all.backends.extend(names(&text()?)),
            "runs" => {
                let runs = number("a whole number of runs, at least 1");
                all.runs = parsed(&name, &text()?, runs).map(NonZeroU32::get)?.into();
            }
            "max-memory" => all.max_memory = Some(parsed(&name, &text()?, bytes)?),
            "budget" => budget = Some(parsed(&name, &text()?, duration)?),
            "rounds" => {
                let wanted = number("a whole number of rounds from 1 to 4294967295");
                rounds = Some(parsed(&name, &text()?, wanted)?);
            }
            "launches" => {
                let wanted = number("a whole number of launches, at least 1");
                all.launches = Some(parsed(&name, &text()?, wanted)?);
            }
            "confidence" => all.confidence = parsed(&name, &text()?, any)?,
            "keep-going" => all.keep_going = true,
            "seed" => {
                all.seed = parsed(
                    &name,
                    &text()?,
                    number("a whole number from 0 to 18446744073709551615"),
                )?;
            }
            "heap" => all.heap = parsed(&name, &text()?, any)?,
            "isolate" => all.isolate = true,
            "time-limit" => all.time_limit = Some(parsed(&name, &text()?, duration)?),
            "memory-limit" => all.memory_limit = Some(parsed(&name, &text()?, bytes)?),
            "record" => all.record = Some(value()?.into()),
            "order" => {
                let canonical = |text: &str| {
                    let only = || "the order can be canonical only".to_owned();
                    (text == "canonical").then_some(true).ok_or_else(only)
                };
                all.canonical_order = parsed(&name, &text()?, canonical)?;
            }
            "json" => all.json = Some(value()?.into()),
            "tag" => all.tags.push(parsed(&name, &text()?, tag)?),
            "triangulate" => all.triangulate = true,
            "as-stored" => all.read.as_stored = true,
            "recentre" => all.read.recentre = true,
            "scene" => all.read.scene = Some(parsed(&name, &text()?, scene)?),
            "child" => all.child = Some(text()?),
            _ => return Err(unknown(&name)),
        }
    }
    let conflicts = [
        ("--budget", budget.is_some(), "--rounds", rounds.is_some()),
        ("--isolate", all.isolate, "--record", all.record.is_some()),
        (
            "--isolate",
            all.isolate,
            "--launches",
            all.launches.is_some(),
        ),
        (
            "--record",
            all.record.is_some(),
            "--json",
            all.json.is_some(),
        ),
        (
            "--record",
            all.record.is_some(),
            "--launches",
            all.launches.is_some(),
        ),
        ("--order", all.canonical_order, "--json", all.json.is_some()),
        (
            "--order",
            all.canonical_order,
            "--record",
            all.record.is_some(),
        ),
    ];
    if let Some((a, _, b, _)) = conflicts.iter().find(|(_, a, _, b)| *a && *b) {
        return Err(Failure::usage(format!("{a} cannot be used with {b}")));
    }
    let whole = rounds.map_or(Effort::Budget(budget.unwrap_or(BUDGET)), Effort::Rounds);
    all.effort = launches::effort(whole);
    Ok(Asked::Measure(Box::new(all)))
}

/// Returns the error for an option that does not exist. It names the option that was perhaps meant.
fn unknown(name: &str) -> Failure {
    let lines = HELP
        .lines()
        .filter_map(|line| line.trim_start().split_once("--"));
    let lines = lines.filter(|(before, _)| before.is_empty() || before.ends_with(", "));
    let known = lines.filter_map(|(_, option)| option.split_whitespace().next());
    Failure::usage(sixfold::UnknownName::new("option", name, known))
}

/// Parses the value of the option called `name`.
fn parsed<T>(
    name: &str,
    text: &str,
    parse: impl Fn(&str) -> Result<T, String>,
) -> Result<T, Failure> {
    parse(text.trim()).map_err(|why| Failure::usage(format!("--{name} {text}: {why}")))
}

fn any<T: FromStr<Err: ToString>>(text: &str) -> Result<T, String> {
    text.parse().map_err(|error: T::Err| error.to_string())
}

/// Returns a function that parses a number. `what` describes it.
fn number<T: FromStr>(what: &'static str) -> impl Fn(&str) -> Result<T, String> {
    move |text| text.parse().map_err(|_| format!("write {what}"))
}

/// Splits a list of names.
fn names(text: &str) -> impl Iterator<Item = String> {
    text.split(',').map(|name| name.trim().to_owned())
}

/// Parses `20s`, `500ms` or `2m`: above 0 and at most a week.
///
/// # Errors
///
/// Returns what a time looks like.
pub fn duration(text: &str) -> Result<Duration, String> {
    const MAX_S: f64 = 7.0 * 24.0 * 3600.0;
    let units = [("ms", 1e-3), ("s", 1.0), ("m", 60.0)];
    let parsed = units.into_iter().find_map(|(unit, seconds)| {
        let number: f64 = text.strip_suffix(unit)?.parse().ok()?;
        Some(number * seconds)
    });
    match parsed {
        Some(seconds) if seconds > 0.0 && seconds <= MAX_S => Ok(Duration::from_secs_f64(seconds)),
        Some(_) => Err("a time must be above 0 and at most a week".into()),
        None => Err("write a time as 20s, 500ms or 2m".into()),
    }
}

/// Parses `2GiB`, `500MB` or `1000000`: at least 1 byte.
///
/// # Errors
///
/// Returns what an amount of memory looks like.
pub fn bytes(text: &str) -> Result<u64, String> {
    let units = [
        ("GiB", 1 << 30),
        ("MiB", 1 << 20),
        ("KiB", 1 << 10),
        ("GB", 1_000_000_000),
        ("MB", 1_000_000),
        ("kB", 1000),
        ("B", 1),
        ("", 1_u64),
    ];
    let wrong = || format!("write memory as 2GiB, 500MB or 1000000, not `{text}`");
    let (number, unit) = units
        .into_iter()
        .find_map(|(unit, bytes)| Some((text.trim().strip_suffix(unit)?, bytes)))
        .ok_or_else(wrong)?;
    let number: f64 = number.trim().parse().map_err(|_| wrong())?;
    let bytes = number * unit as f64;
    match bytes >= 1.0 && bytes <= u64::MAX as f64 {
        true => Ok(bytes as u64),
        false => Err(wrong()),
    }
}

/// Parses `--scene`.
///
/// # Errors
///
/// Returns what a scene looks like.
pub fn scene(text: &str) -> Result<Scene, String> {
    match (text, text.parse()) {
        ("all", _) => Ok(Scene::All),
        (_, Ok(number)) => Ok(Scene::Number(number)),
        _ => Err("expected the number of a scene, from 0, or all".to_owned()),
    }
}

/// Parses a tag such as `machine=laptop`.
///
/// # Errors
///
/// Returns what a tag looks like.
pub fn tag(text: &str) -> Result<(String, String), String> {
    let pair = text
        .split_once('=')
        .filter(|(key, _)| !key.trim().is_empty());
    let (key, value) = pair.ok_or("write KEY=VALUE, such as machine=laptop")?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(words: &[&str]) -> Result<Arguments, String> {
        match parse(words.iter().map(OsString::from)) {
            Ok(Asked::Measure(arguments)) => Ok(*arguments),
            Ok(other) => Err(format!("{other:?}")),
            Err(failure) => Err(failure.message),
        }
    }

    #[test]
    fn options_and_meshes_are_read_in_any_order() {
        let all = given(&[
            "a.obj",
            "--programs",
            "x,y",
            "--runs=5",
            "--budget",
            "2m",
            "b.obj",
            "--isolate",
            "--scene",
            "all",
            "--tag",
            "machine=here",
            "--memory-limit",
            "2GiB",
        ])
        .expect("fine");
        assert_eq!(all.meshes, [PathBuf::from("a.obj"), "b.obj".into()]);
        assert_eq!((all.programs.len(), all.runs, all.isolate), (2, 5, true));
        assert_eq!(all.effort, Effort::Budget(Duration::from_secs(120)));
        assert_eq!(all.read.scene, Some(Scene::All));
        assert_eq!(all.tags, [("machine".to_owned(), "here".to_owned())]);
        assert_eq!(all.memory_limit, Some(2 << 30));
        let counted = given(&["--rounds", "3", "--", "--odd.obj"]).expect("fine");
        assert_eq!(counted.meshes, [PathBuf::from("--odd.obj")]);
        assert!(matches!(counted.effort, Effort::Rounds(n) if n.get() == 3));
    }

    #[test]
    fn wrong_arguments_are_named() {
        for (words, expected) in [
            (&["--budgt", "3s"][..], "did you mean `budget`?"),
            (&["--budget", "3"], "--budget 3: write a time as 20s"),
            (&["--budget"], "missing argument for option '--budget'"),
            (&["--rounds", "0"], "a whole number of rounds"),
            (&["--runs", "0"], "at least 1"),
            (&["--seed", "-1"], "a whole number from 0"),
            (&["--heap", "keep"], "--heap keep"),
            (&["--confidence", "2"], "--confidence 2"),
            (
                &["--rounds", "2", "--budget", "1s"],
                "--budget cannot be used with --rounds",
            ),
            (
                &["--isolate", "--launches", "2"],
                "--isolate cannot be used with --launches",
            ),
            (&["--order", "own"], "the order can be canonical only"),
            (&["-x"], "invalid option '-x'"),
            (
                &["--isolate=yes"],
                "unexpected argument for option '--isolate'",
            ),
            (&["--tag", "=1"], "KEY=VALUE"),
        ] {
            let message = given(words).expect_err(expected);
            assert!(message.contains(expected), "{words:?}: {message}");
        }
    }

    #[test]
    fn the_help_has_80_columns_and_each_option_once() {
        let text = help(&["a", "b"]);
        let wide = text.lines().find(|line| line.chars().count() > 80);
        assert_eq!(wide, None);
        let message = unknown("x").message;
        assert_eq!(message.matches("isolate").count(), 1, "{message}");
        assert!(
            message.contains("choose from programs, backends, runs"),
            "{message}"
        );
    }

    #[test]
    fn every_option_is_in_the_help() {
        let source = include_str!("arguments.rs");
        let options = source.split("            \"").skip(1);
        let options = options.filter_map(|rest| rest.split_once("\" =>").map(|(name, _)| name));
        let named = options.filter(|name| *name != "child");
        let mut count = 0;
        for name in named.filter(|name| name.chars().all(|c| c.is_ascii_lowercase() || c == '-')) {
            assert!(HELP.contains(&format!("--{name} ")), "{name}");
            count += 1;
        }
        assert!(count > 20, "{count}");
    }
}
