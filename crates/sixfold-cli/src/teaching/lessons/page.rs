//! The guide: each lesson and chapter as a page of Markdown with the output of its commands.

use std::fs;
use std::path::Path;

use super::command::{Folder, trace_heading, write_file};
use super::source::{Kind, Lesson, Part, Question, Shown, read, with_parts};
use super::{CHAPTERS, CONTENTS, LESSONS, paragraph_of};
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::text::WIDTH;

/// Width of the text of a page.
const PAGE_WIDTH: usize = 128;

/// Writes the contents, the chapters and the lessons.
pub(super) fn write_guide(folder: &Path) -> Result<(), Failure> {
    let lessons = folder.join("lessons");
    fs::create_dir_all(&lessons)
        .map_err(|cause| cannot_write(&lessons.display().to_string(), &cause))?;
    for (name, source) in std::iter::once(("README", CONTENTS)).chain(CHAPTERS) {
        write_page(folder, name, &read(&with_parts(source)))?;
    }
    let mut list = String::from(
        "# Lessons\n\nEach lesson has questions, and commands that work out the answers. `sixfold lessons NAME` \
         runs one in the\nterminal. These pages are written by `sixfold lessons --markdown`.\n\n",
    );
    for (name, source) in LESSONS {
        let lesson = read(source);
        list += &format!("- [{}]({name}.md)\n", lesson.title);
        write_page(&lessons, name, &lesson)?;
    }
    write_file(&lessons, "README.md", &list)
}

/// Writes a page, and its pictures beside it.
fn write_page(target: &Path, name: &str, lesson: &Lesson<'_>) -> Result<(), Failure> {
    let page = page(target, lesson, |_, _| None)?;
    write_file(target, &format!("{name}.md"), &page)
}

/// Returns a page, and writes its pictures to `target`. `link` returns, for the line of a command and the folder with
/// its files, a link to a page that shows the same as the command. The output is then folded.
pub(super) fn page(
    target: &Path,
    lesson: &Lesson<'_>,
    mut link: impl FnMut(&str, &Path) -> Option<String>,
) -> Result<String, Failure> {
    let folder = Folder::new()?;
    let mut page = format!("# {}\n", lesson.title);
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
                let printed = match command.kind {
                    Kind::Timed => String::new(),
                    _ => folder.run(*command, WIDTH)?,
                };
                match (link(command.line, folder.path()), command.kind) {
                    (Some(link), _) => format!("{link}\n\n{}", folded(*command, &printed)),
                    (None, Kind::Folded) => folded(*command, &printed),
                    (None, _) => console(command.line, &printed),
                }
            }
            Part::Picture { command, caption } => {
                let file = draw(command, &folder, target)?;
                let alternative = caption.split(". ").next().unwrap_or(caption);
                let below = paragraph_of(&format!("{caption} (`{command}`)"), PAGE_WIDTH);
                format!("![{alternative}]({file})\n\n{below}\n")
            }
            Part::Question(Question {
                text, asks, answer, ..
            }) => {
                let asks = asks.iter().map(|ask| format!("- {}: ____\n", ask.label));
                let asks: String = asks.collect();
                format!(
                    "**{}**\n\n{asks}{}<details><summary>Answer</summary>\n\n{}\n\n</details>\n",
                    paragraph_of(text, PAGE_WIDTH - 4),
                    if asks.is_empty() { "" } else { "\n" },
                    paragraph_of(answer, PAGE_WIDTH)
                )
            }
        };
    }
    Ok(page)
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
