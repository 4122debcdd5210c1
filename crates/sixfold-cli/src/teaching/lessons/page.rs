//! The guide: each lesson and chapter as a page of Markdown with the output of its commands.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::command::{Folder, trace_heading, write_file};
use super::source::{Ask, Expected, Kind, Lesson, Part, Question, Shown, read, with_parts};
use super::{CHAPTERS, CONTENTS, LESSONS, SHEETS, paragraph_of};
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::text::WIDTH;

/// Width of the text of a page.
const PAGE_WIDTH: usize = 128;

/// Where a value is written on a printed page.
pub(super) const BLANK: &str = "____";
/// Where a sentence is written on a printed page.
pub(super) const LINE: &str = "____________________";

/// Begins the walk of a command.
const WALK: &str = "--walk \"";

/// What a page shows of a lesson.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// All parts, with the outputs and the answers.
    Full,
    /// The tasks, with blanks for what is asked: no outputs and no answers.
    Sheet,
    /// As [`Full`](Self::Full), beside a sheet.
    Solutions,
}

/// Returns the names and the forms of the pages of a lesson. The first page is the one for readers.
pub(super) fn pages_of(name: &str) -> Vec<(String, Form)> {
    match SHEETS.contains(&name) {
        true => vec![
            (name.to_owned(), Form::Sheet),
            (format!("{name}-solutions"), Form::Solutions),
        ],
        false => vec![(name.to_owned(), Form::Full)],
    }
}

/// Returns the title of a page.
pub(super) fn title_of(lesson: &Lesson<'_>, form: Form) -> String {
    match form {
        Form::Solutions => format!("{}: solutions", lesson.title),
        Form::Full | Form::Sheet => lesson.title.to_owned(),
    }
}

/// Writes the contents, the chapters and the lessons.
pub(super) fn write_guide(folder: &Path) -> Result<(), Failure> {
    let lessons = folder.join("lessons");
    fs::create_dir_all(&lessons)
        .map_err(|cause| cannot_write(&lessons.display().to_string(), &cause))?;
    for (name, source) in std::iter::once(("README", CONTENTS)).chain(CHAPTERS) {
        write_page(folder, name, &read(&with_parts(source)), Form::Full)?;
    }
    let mut list = String::from(
        "# Lessons\n\nEach lesson has questions, and commands that work out the answers. `sixfold lessons NAME` \
         runs one in the\nterminal. These pages are written by `sixfold lessons --markdown`.\n\n",
    );
    for (name, source) in LESSONS {
        let lesson = read(source);
        list += &format!("- [{}]({name}.md)\n", lesson.title);
        for (page, form) in pages_of(name) {
            write_page(&lessons, &page, &lesson, form)?;
        }
    }
    write_file(&lessons, "README.md", &list)
}

/// Writes a page, and its pictures beside it.
fn write_page(target: &Path, name: &str, lesson: &Lesson<'_>, form: Form) -> Result<(), Failure> {
    let page = page(target, lesson, form, |_, _| None)?;
    write_file(target, &format!("{name}.md"), &page)
}

/// Returns a page, and writes its pictures to `target`. `link` returns, for the line of a command and the folder with
/// its files, a link to a page that shows the same as the command. The output is then folded.
pub(super) fn page(
    target: &Path,
    lesson: &Lesson<'_>,
    form: Form,
    mut link: impl FnMut(&str, &Path) -> Option<String>,
) -> Result<String, Failure> {
    let folder = Folder::new()?;
    let mut page = format!("# {}\n", title_of(lesson, form));
    for part in &lesson.parts {
        page.push('\n');
        page += &match part {
            Part::Text(text) => paragraph_of(text, PAGE_WIDTH) + "\n",
            Part::Kept(block) => format!("{block}\n"),
            Part::File { name, content } => {
                folder.write(name, content)?;
                format!("The file `{name}`:\n\n```text\n{content}```\n")
            }
            Part::Command(command) => {
                // A sheet has no output, but later commands read the files that this one writes.
                let printed = match command.kind {
                    Kind::Timed => String::new(),
                    _ => folder.run(*command, WIDTH)?,
                };
                let shown = match (form, command.kind) {
                    (Form::Sheet, _) => console(&without_walk(command.line), ""),
                    (_, Kind::Folded) => folded(*command, &printed),
                    _ => console(command.line, &printed),
                };
                match (link(command.line, folder.path()), form) {
                    (_, Form::Sheet) if command.line.contains(WALK) => shown,
                    (Some(link), Form::Sheet) => format!("{shown}\n{link}\n"),
                    (Some(link), _) => format!("{link}\n\n{}", folded(*command, &printed)),
                    (None, _) => shown,
                }
            }
            Part::Picture { command, caption } => {
                let file = draw(command, &folder, target)?;
                let alternative = caption.split(". ").next().unwrap_or(caption);
                let below = paragraph_of(&format!("{caption} (`{command}`)"), PAGE_WIDTH);
                format!("![{alternative}]({file})\n\n{below}\n")
            }
            Part::Question(question) => question_of(question, form, &folder)?,
        };
    }
    Ok(page)
}

/// Returns a command with a blank for its walk, which the reader of a sheet writes.
fn without_walk(line: &str) -> String {
    let parts = line.split_once(WALK).and_then(|(before, rest)| {
        let (_, after) = rest.split_once('"')?;
        Some(format!("{before}{WALK}{LINE}\"{after}"))
    });
    parts.unwrap_or_else(|| line.to_owned())
}

/// Returns a question with a blank for each value that is asked for, and its answer in a block that is closed at first.
fn question_of(question: &Question<'_>, form: Form, folder: &Folder) -> Result<String, Failure> {
    let asks = question
        .asks
        .iter()
        .map(|ask| format!("- {}: {BLANK}\n", label_of(ask)));
    let asks: String = asks.collect();
    let text = paragraph_of(&question.text, PAGE_WIDTH - 4);
    let mut parts = vec![format!("**{text}**\n")];
    if !asks.is_empty() {
        parts.push(asks);
    } else if form == Form::Sheet {
        parts.push(format!("Your answer: {LINE}\n"));
    }
    if form != Form::Sheet {
        let values = question.asks.iter().map(|ask| {
            let value = value_of(ask, folder)?;
            Ok(format!("- {}: {value}\n", ask.label))
        });
        let mut values = values.collect::<Result<String, Failure>>()?;
        if !values.is_empty() {
            values.push('\n');
        }
        let answer = paragraph_of(&question.answer, PAGE_WIDTH);
        parts.push(format!(
            "<details><summary>Answer</summary>\n\n{values}{answer}\n\n</details>\n"
        ));
    }
    Ok(parts.join("\n"))
}

/// Returns the label of a value, with the options if it is a choice.
fn label_of(ask: &Ask<'_>) -> String {
    match ask.expected {
        Expected::Computed { .. } => ask.label.to_owned(),
        Expected::Choice(options) => {
            let options = options.split(" / ").map(str::trim);
            let plain = options.map(|option| option.strip_prefix("* ").unwrap_or(option));
            format!("{} ({})", ask.label, plain.collect::<Vec<_>>().join(" / "))
        }
    }
}

/// Works out the right value as text.
fn value_of(ask: &Ask<'_>, folder: &Folder) -> Result<String, Failure> {
    let asked = serde_json::to_value(folder.asked(ask)?).unwrap_or_default();
    Ok(match &asked["truth"] {
        Value::String(text) => text.clone(),
        Value::Array(names) if names.is_empty() => "none".to_owned(),
        Value::Array(names) => {
            let names = names.iter().filter_map(Value::as_str);
            names.collect::<Vec<_>>().join(", ")
        }
        number => number.to_string(),
    })
}

fn console(command: &str, printed: &str) -> String {
    format!("```console\n$ {command}\n{}\n```\n", printed.trim_end())
        .replace("\n\n```\n", "\n```\n")
}

/// Returns a command and its output in a block that is closed at first.
fn folded(command: Shown<'_>, printed: &str) -> String {
    let heading = match trace_heading(command, printed) {
        Some((what, counts)) => format!("<code>{what}</code>: {counts}"),
        None => format!("<code>{}</code>", command.line),
    };
    format!(
        "<details><summary>{heading}</summary>\n\n{}\n</details>\n",
        console(command.line, printed)
    )
}

/// Runs a command that draws a picture, and copies the picture to `target`. Returns its name.
fn draw(line: &str, folder: &Folder, target: &Path) -> Result<String, Failure> {
    let kind = Kind::Hidden;
    folder.run(Shown { line, kind }, WIDTH)?;
    let words = shlex::split(line).unwrap_or_default();
    let mut words = words.into_iter().skip_while(|word| word != "-o");
    let file = words.nth(1).unwrap_or_default();
    fs::copy(folder.path().join(&file), target.join(&file))
        .map_err(|cause| cannot_write(&file, &cause))?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LESSON: &str = "# Lab\n\n? How many faces?\n= faces | one / * six\n~ Count.\n! It has six.\n\n? Why?\n! Because.\n";

    fn written(form: Form) -> String {
        let target = tempfile::tempdir().expect("a folder");
        page(target.path(), &read(LESSON), form, |_, _| None).expect("a page")
    }

    #[test]
    fn a_sheet_has_blanks_and_no_answers() {
        let expected = "# Lab\n\n**How many faces?**\n\n- faces (one / six): ____\n\n**Why?**\n\nYour answer: ____________________\n";
        assert_eq!(written(Form::Sheet), expected);
    }

    #[test]
    fn a_walk_is_a_blank_on_a_sheet() {
        let line = "sixfold trace --walk \"yield v0\" --expect \"VV v3\"";
        let expected = format!("sixfold trace --walk \"{LINE}\" --expect \"VV v3\"");
        assert_eq!(without_walk(line), expected);
        assert_eq!(without_walk("sixfold tables"), "sixfold tables");
    }

    #[test]
    fn the_solutions_have_the_values_and_the_answers() {
        let page = written(Form::Solutions);
        assert!(page.starts_with("# Lab: solutions\n"), "{page}");
        let answer =
            "<details><summary>Answer</summary>\n\n- faces: six\n\nIt has six.\n\n</details>\n";
        assert!(page.contains(answer), "{page}");
        assert!(page.ends_with("Because.\n\n</details>\n"), "{page}");
    }

    #[test]
    fn only_lessons_that_are_handed_out_have_two_pages() {
        assert_eq!(pages_of("flip"), [("flip".to_owned(), Form::Full)]);
        for name in SHEETS {
            assert!(LESSONS.iter().any(|(known, _)| *known == name), "{name}");
            let names: Vec<_> = pages_of(name).into_iter().map(|(name, _)| name).collect();
            assert_eq!(names, [name.to_owned(), format!("{name}-solutions")]);
        }
    }
}
