//! `sixfold lessons`: short lessons, and the chapters of the guide. The program works out all answers and outputs.
//!
//! Lessons and chapters are text files of one format (`source.rs`). They are printed in the terminal
//! (`terminal.rs`), or written as pages of Markdown (`page.rs`), as a site (`site.rs`) and as data for the explorer
//! (`data.rs`).

mod answers;
mod command;
mod data;
mod grades;
mod html;
mod page;
mod site;
mod source;
mod terminal;

use std::process::ExitCode;

use sixfold_core::UnknownName;

use crate::arguments::Lessons;
use crate::failure::Failure;
use crate::output::Output;
use crate::text::{TextOutput, sanitize, wrap};

/// The lessons, in the order in which a course takes them.
pub(crate) const LESSONS: [(&str, &str); 21] = [
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
    ("lab", include_str!("lessons/lab.md")),
];

/// The lessons that are handed out: one page is the sheet without answers, another has the solutions.
const SHEETS: [&str; 1] = ["lab"];

/// The first page of the guide.
const CONTENTS: &str = include_str!("guide/README.md");

/// The chapters of the guide.
const CHAPTERS: [(&str, &str); 8] = [
    ("polygon-soup", include_str!("guide/polygon-soup.md")),
    (
        "indexed-face-set",
        include_str!("guide/indexed-face-set.md"),
    ),
    ("face-vertex", include_str!("guide/face-vertex.md")),
    ("winged-edge", include_str!("guide/winged-edge.md")),
    ("half-edge", include_str!("guide/half-edge.md")),
    ("corner-table", include_str!("guide/corner-table.md")),
    ("study", include_str!("guide/study.md")),
    ("teachers", include_str!("guide/teachers.md")),
];

/// Parts that several chapters have. `OPTIONS` stands for the options that select the structure.
const PARTS: [(&str, &str); 3] = [
    ("queries", include_str!("guide/parts/queries.md")),
    ("edits", include_str!("guide/parts/edits.md")),
    (
        "polygon-edits",
        include_str!("guide/parts/polygon-edits.md"),
    ),
];

pub(crate) fn run(arguments: &Lessons) -> Result<ExitCode, Failure> {
    if let Some(folder) = &arguments.markdown {
        page::write_guide(folder)?;
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(folder) = &arguments.export {
        site::write(folder)?;
        let mut text = TextOutput::new(true);
        let first = folder.join("index.html");
        text.print_line(&sanitize(&first.display().to_string()));
        return text.finish().map(|()| ExitCode::SUCCESS);
    }
    if let Some(file) = &arguments.json {
        Output::open(file)?.write_json(&data::lessons()?)?;
        return Ok(ExitCode::SUCCESS);
    }
    if !arguments.check.is_empty() {
        return grades::run(&arguments.check, arguments.csv.as_deref());
    }
    let Some(name) = &arguments.name else {
        return list();
    };
    let all = || LESSONS.iter().chain(&CHAPTERS);
    let found = all().find(|(known, _)| known == name);
    let unknown = || {
        Failure::usage(UnknownName::new(
            "lesson",
            name,
            all().map(|(name, _)| *name),
        ))
    };
    let (_, source) = found.ok_or_else(unknown)?;
    let source = source::with_parts(source);
    terminal::teach(&source::read(&source), !arguments.no_wait)
}

fn list() -> Result<ExitCode, Failure> {
    let mut text = TextOutput::new(true);
    let mut print = |listed: &[(&str, &str)]| {
        for (name, source) in listed {
            text.print_line(&format!("{name:<16}  {}", source::read(source).title));
        }
        text.print_line("");
    };
    print(&LESSONS);
    print(&CHAPTERS);
    text.print_line("sixfold lessons NAME runs one of the lessons, or prints one of the chapters.");
    text.finish().map(|()| ExitCode::SUCCESS)
}

fn paragraph_of(text: &str, width: usize) -> String {
    wrap(text, width).join("\n")
}

#[cfg(test)]
mod tests {
    use super::source::{Part, read, with_parts};
    use super::*;

    /// Checks the commands and the files of a lesson, and that no command of the source is lost.
    fn check(name: &str, source: &str) {
        let lesson = read(source);
        assert!(!lesson.title.is_empty(), "{name}");
        let mut commands = 0;
        for part in &lesson.parts {
            match part {
                Part::Question(question) => {
                    assert!(!question.answer.is_empty(), "{name}: {part:?}");
                }
                Part::Command(command) => {
                    commands += 1;
                    assert!(command.line.starts_with("sixfold "), "{name}: {part:?}");
                }
                Part::Picture { command, caption } => {
                    commands += 1;
                    assert!(command.starts_with("sixfold render "), "{name}: {part:?}");
                    assert!(!caption.is_empty(), "{name}: {part:?}");
                }
                Part::Text(text) => assert!(!text.contains("```"), "{name}: {part:?}"),
                Part::File { content, .. } => assert!(content.ends_with('\n'), "{name}"),
                Part::Kept(_) => {}
            }
        }
        let lines = |mark: &str| source.lines().filter(|line| line.starts_with(mark)).count();
        assert_eq!(commands, lines("$"), "{name}");
        let asks = lesson.parts.iter().map(|part| match part {
            Part::Question(question) => question.asks.len(),
            _ => 0,
        });
        assert_eq!(asks.sum::<usize>(), lines("= "), "{name}");
    }

    #[test]
    fn every_lesson_has_a_title_commands_and_questions_with_answers() {
        for (name, source) in LESSONS {
            check(name, source);
            let lesson = read(source);
            let count = |is_kind: fn(&Part<'_>) -> bool| {
                lesson.parts.iter().filter(|part| is_kind(part)).count()
            };
            assert!(count(|part| matches!(part, Part::Command(_))) > 0, "{name}");
            assert!(
                count(|part| matches!(part, Part::Question(_))) > 1,
                "{name}"
            );
        }
    }

    #[test]
    fn every_chapter_is_read_and_in_the_contents() {
        for (name, source) in CHAPTERS {
            let source = with_parts(source);
            check(name, &source);
            assert!(!source.contains("\n@ "), "{name}: an unknown part");
            assert!(CONTENTS.contains(&format!("({name}.md)")), "{name}");
        }
    }

    #[test]
    fn each_structure_has_a_chapter() {
        for structure in sixfold_explain::Structure::all() {
            let is_it = |(name, _): &(&str, &str)| *name == structure.name();
            assert!(CHAPTERS.iter().any(is_it), "{}", structure.name());
        }
    }
}
