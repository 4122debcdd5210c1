//! `sixfold lessons`: short lessons, whose answers the program works out.
//!
//! A lesson is a text file. Its first line is the title, after `# `. A line that begins with `$ ` is a
//! command, `$! ` a command that is refused, `$~ ` a command that measures time, and `$- ` a command whose
//! output is not shown. Lines that begin with `? `
//! ask a question, and lines that begin with `! ` answer it. A block that begins with `file` and a name after
//! three backticks is a file, which the commands read.

use std::fs;
use std::io::{self, BufRead, IsTerminal, Write};
use std::path::Path;
use std::process::{Command, ExitCode};

use sixfold_core::UnknownName;

use crate::arguments::Lessons;
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::text::{TextOutput, WIDTH, hanging_indent, width, wrap};

/// The lessons, in the order in which a course takes them.
const LESSONS: [(&str, &str); 20] = [
    ("six-tables", include_str!("lessons/six-tables.md")),
    ("memory", include_str!("lessons/memory.md")),
    ("relations", include_str!("lessons/relations.md")),
    (
        "around-a-vertex",
        include_str!("lessons/around-a-vertex.md"),
    ),
    ("boundary", include_str!("lessons/boundary.md")),
    ("three-faces", include_str!("lessons/three-faces.md")),
    ("orientation", include_str!("lessons/orientation.md")),
    ("find-the-fault", include_str!("lessons/find-the-fault.md")),
    ("flip", include_str!("lessons/flip.md")),
    ("collapse", include_str!("lessons/collapse.md")),
    ("names", include_str!("lessons/names.md")),
    ("euler", include_str!("lessons/euler.md")),
    ("dual", include_str!("lessons/dual.md")),
    ("masks", include_str!("lessons/masks.md")),
    ("creases", include_str!("lessons/creases.md")),
    ("order", include_str!("lessons/order.md")),
    ("growth", include_str!("lessons/growth.md")),
    ("criteria", include_str!("lessons/criteria.md")),
    ("choose", include_str!("lessons/choose.md")),
    ("exercises", include_str!("lessons/exercises.md")),
];

/// One part of a lesson.
#[derive(Debug, PartialEq, Eq)]
enum Part<'l> {
    Text(String),
    File { name: &'l str, content: String },
    Command(Shown<'l>),
    Question { question: String, answer: String },
}

/// A command of a lesson.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Shown<'l> {
    line: &'l str,
    kind: Kind,
}

/// What a lesson does with the output of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Shows what the command prints.
    Output,
    /// Shows the error: the command fails, which the lesson explains.
    Failure,
    /// Runs the command only in a terminal, because it measures time.
    Timed,
    /// Runs the command, and does not show what it prints.
    Hidden,
}

/// A lesson that was read.
struct Lesson<'l> {
    title: &'l str,
    parts: Vec<Part<'l>>,
}

pub(crate) fn run(arguments: &Lessons) -> Result<ExitCode, Failure> {
    if let Some(folder) = &arguments.markdown {
        write_chapters(folder)?;
        return Ok(ExitCode::SUCCESS);
    }
    let Some(name) = &arguments.name else {
        let mut text = TextOutput::new(true);
        for (name, source) in LESSONS {
            text.print_line(&format!("{name:<16}  {}", read(source).title));
        }
        text.print_line("\nsixfold lessons NAME runs one of them.");
        return text.finish().map(|()| ExitCode::SUCCESS);
    };
    let found = LESSONS.iter().find(|(known, _)| known == name);
    let names = LESSONS.iter().map(|(name, _)| *name);
    let unknown = || Failure::usage(UnknownName::new("lesson", name, names));
    let (_, source) = found.ok_or_else(unknown)?;
    teach(&read(source), !arguments.no_wait)
}

/// Reads a lesson.
fn read(source: &str) -> Lesson<'_> {
    let mut lines = source.lines().peekable();
    let title = lines.next().and_then(|line| line.strip_prefix("# "));
    let mut parts = Vec::new();
    while let Some(line) = lines.next() {
        let mut following = |first: &str, mark: &str| {
            let mut text = first.to_owned();
            while let Some(line) = lines.next_if(|line| line.strip_prefix(mark).is_some()) {
                text = format!("{text} {}", line.strip_prefix(mark).unwrap_or_default());
            }
            text
        };
        if let Some(question) = line.strip_prefix("? ") {
            let question = following(question, "? ");
            let answer = following("", "! ").trim().to_owned();
            parts.push(Part::Question { question, answer });
        } else if let Some(name) = line.strip_prefix("```file ") {
            let mut content = String::new();
            for line in lines.by_ref().take_while(|line| *line != "```") {
                content += line;
                content.push('\n');
            }
            parts.push(Part::File { name, content });
        } else if let Some(command) = line.strip_prefix('$') {
            let kinds = [
                (" ", Kind::Output),
                ("! ", Kind::Failure),
                ("~ ", Kind::Timed),
                ("- ", Kind::Hidden),
            ];
            let kind = kinds.into_iter().find_map(|(mark, kind)| {
                let line = command.strip_prefix(mark)?;
                Some(Shown { line, kind })
            });
            parts.extend(kind.map(Part::Command));
        } else if !line.is_empty() {
            let mut text = line.to_owned();
            let is_text = |line: &&str| {
                !line.is_empty()
                    && !["? ", "! ", "$", "```"]
                        .iter()
                        .any(|mark| line.starts_with(mark))
            };
            while let Some(line) = lines.next_if(is_text) {
                text = format!("{text} {line}");
            }
            parts.push(Part::Text(text));
        }
    }
    Lesson {
        title: title.unwrap_or_default(),
        parts,
    }
}

/// Runs a lesson in the terminal.
fn teach(lesson: &Lesson<'_>, waits: bool) -> Result<ExitCode, Failure> {
    let folder = tempfile::tempdir().map_err(|cause| cannot_write("a folder", &cause))?;
    let mut text = TextOutput::new(true);
    let mut waits = waits && io::stdin().is_terminal();
    text.print_line(&format!("{}\n", lesson.title.to_uppercase()));
    for part in &lesson.parts {
        match part {
            Part::Text(paragraph) => text.print_line(&paragraph_of(paragraph, width())),
            Part::File { name, content } => {
                write_file(folder.path(), name, content)?;
                text.print_line(&format!("The file {name}:\n\n{}", indented(content)));
            }
            Part::Command(command) => {
                text.print_line(&format!("$ {}", command.line));
                if command.kind == Kind::Timed && !waits {
                    text.print_line("(measures time)");
                } else {
                    text.print_line(output(*command, folder.path(), width())?.trim_end());
                }
            }
            Part::Question { question, answer } => {
                text.print_line(&hanging_indent("? ", question));
                if waits {
                    waits = wait_for_answer()?;
                }
                text.print_line("");
                text.print_line(&hanging_indent("  ", answer));
            }
        }
        text.print_line("");
    }
    text.finish().map(|()| ExitCode::SUCCESS)
}

/// Waits for the answer of the reader. Returns false at the end of the input.
fn wait_for_answer() -> Result<bool, Failure> {
    print!("\nYour answer, then Enter: ");
    let failed = |cause| cannot_write("the terminal", &cause);
    io::stdout().flush().map_err(failed)?;
    let mut answer = String::new();
    let read = io::stdin().lock().read_line(&mut answer).map_err(failed)?;
    Ok(read > 0)
}

fn write_file(folder: &Path, name: &str, content: &str) -> Result<(), Failure> {
    let path = folder.join(name);
    fs::write(&path, content).map_err(|cause| cannot_write(&path.display().to_string(), &cause))
}

/// Runs a command in `folder`, and returns what it prints.
fn output(command: Shown<'_>, folder: &Path, width: usize) -> Result<String, Failure> {
    let words = shlex::split(command.line).unwrap_or_default();
    let program = std::env::current_exe().map_err(|cause| cannot_write("a lesson", &cause))?;
    let run = Command::new(program)
        .args(words.iter().skip(1))
        .current_dir(folder)
        .env("COLUMNS", width.to_string())
        .output()
        .map_err(|cause| cannot_write("a lesson", &cause))?;
    // Progress and times are on standard error.
    let printed = match (run.status.success(), command.kind) {
        (true, Kind::Hidden) => Vec::new(),
        (true, _) => run.stdout,
        (false, _) => run.stderr,
    };
    let printed = String::from_utf8_lossy(&printed).into_owned();
    match run.status.success() == (command.kind == Kind::Failure) {
        true => Err(Failure::usage(format!("{}: {printed}", command.line))),
        false => Ok(printed),
    }
}

/// Writes each lesson as a chapter of the guide.
fn write_chapters(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder)
        .map_err(|cause| cannot_write(&folder.display().to_string(), &cause))?;
    let mut list = String::from(
        "# Lessons\n\nEach lesson has questions, and commands that work out the answers. `sixfold lessons NAME` \
         runs one in the\nterminal. These pages are written by `sixfold lessons --markdown`.\n\n",
    );
    for (name, source) in LESSONS {
        let lesson = read(source);
        list += &format!("- [{}]({name}.md)\n", lesson.title);
        write_file(folder, &format!("{name}.md"), &chapter(&lesson)?)?;
    }
    write_file(folder, "README.md", &list)
}

/// Returns a lesson as a page with the output of its commands.
fn chapter(lesson: &Lesson<'_>) -> Result<String, Failure> {
    let folder = tempfile::tempdir().map_err(|cause| cannot_write("a folder", &cause))?;
    let mut page = format!("# {}\n", lesson.title);
    for part in &lesson.parts {
        page.push('\n');
        page += &match part {
            Part::Text(text) => paragraph_of(text, PAGE_WIDTH) + "\n",
            Part::File { name, content } => {
                write_file(folder.path(), name, content)?;
                format!("The file `{name}`:\n\n```text\n{content}```\n")
            }
            Part::Command(command) => {
                let printed = match command.kind {
                    Kind::Timed => String::new(),
                    _ => output(*command, folder.path(), WIDTH)?,
                };
                format!(
                    "```console\n$ {}\n{}\n```\n",
                    command.line,
                    printed.trim_end()
                )
                .replace("\n\n```\n", "\n```\n")
            }
            Part::Question { question, answer } => format!(
                "**{}**\n\n<details><summary>Answer</summary>\n\n{}\n\n</details>\n",
                paragraph_of(question, PAGE_WIDTH - 4),
                paragraph_of(answer, PAGE_WIDTH)
            ),
        };
    }
    Ok(page)
}

/// Width of the text of a page.
const PAGE_WIDTH: usize = 128;

fn paragraph_of(text: &str, width: usize) -> String {
    wrap(text, width).join("\n")
}

fn indented(text: &str) -> String {
    text.lines()
        .map(|line| format!("    {line}"))
        .collect::<Vec<_>>()
        .join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lesson_has_a_title_commands_and_questions_with_answers() {
        for (name, source) in LESSONS {
            let lesson = read(source);
            assert!(!lesson.title.is_empty(), "{name}");
            let count = |is_kind: fn(&Part<'_>) -> bool| {
                lesson.parts.iter().filter(|part| is_kind(part)).count()
            };
            assert!(count(|part| matches!(part, Part::Command(_))) > 0, "{name}");
            assert!(
                count(|part| matches!(part, Part::Question { .. })) > 1,
                "{name}"
            );
            for part in &lesson.parts {
                match part {
                    Part::Question { answer, .. } => {
                        assert!(!answer.is_empty(), "{name}: {part:?}")
                    }
                    Part::Command(command) => {
                        assert!(command.line.starts_with("sixfold "), "{name}: {part:?}")
                    }
                    Part::Text(text) => assert!(!text.contains("```"), "{name}: {part:?}"),
                    Part::File { content, .. } => assert!(content.ends_with('\n'), "{name}"),
                }
            }
            // No line of the file is lost.
            let lines = source.lines().filter(|line| line.starts_with('$')).count();
            assert_eq!(
                count(|part| matches!(part, Part::Command(_))),
                lines,
                "{name}"
            );
        }
    }

    #[test]
    fn the_parts_of_a_lesson_are_read_in_their_order() {
        let source = "# Title\n\nA text\nof two lines.\n\n```file m.obj\nv 0 0 0\n```\n$ sixfold a\n$! sixfold b\n\n\
                      ? Why\n? so?\n! Thus\n! it is.\nMore.\n";
        let lesson = read(source);
        assert_eq!(lesson.title, "Title");
        let command = |line, kind| Part::Command(Shown { line, kind });
        let expected = [
            Part::Text("A text of two lines.".into()),
            Part::File {
                name: "m.obj",
                content: "v 0 0 0\n".into(),
            },
            command("sixfold a", Kind::Output),
            command("sixfold b", Kind::Failure),
            Part::Question {
                question: "Why so?".into(),
                answer: "Thus it is.".into(),
            },
            Part::Text("More.".into()),
        ];
        assert_eq!(lesson.parts, expected);
    }
}
