//! Lessons in the terminal, which wait for the answers of the reader.

use std::io::{self, BufRead, IsTerminal, Write};
use std::process::ExitCode;

use super::command::{Folder, summary};
use super::paragraph_of;
use super::source::{Kind, Lesson, Part};
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::text::{TextOutput, hanging_indent, width};

/// Runs a lesson in the terminal.
pub(super) fn teach(lesson: &Lesson<'_>, waits: bool) -> Result<ExitCode, Failure> {
    let folder = Folder::new()?;
    let mut text = TextOutput::new(true);
    let mut waits = waits && io::stdin().is_terminal();
    text.print_line(&format!("{}\n", lesson.title.to_uppercase()));
    for part in &lesson.parts {
        match part {
            Part::Text(paragraph) => {
                text.print_line(&paragraph_of(&without_links(paragraph), width()));
            }
            Part::Kept(block) => text.print_line(&kept(block)),
            Part::File { name, content } => {
                folder.write(name, content)?;
                text.print_line(&format!("The file {name}:\n\n{}", indented(content)));
            }
            Part::Command(command) => {
                text.print_line(&format!("$ {}", command.line));
                if command.kind == Kind::Timed && !waits {
                    text.print_line("(measures time)");
                } else {
                    let printed = folder.run(*command, width())?;
                    text.print_line(match command.kind {
                        Kind::Folded => summary(&printed),
                        _ => printed.trim_end(),
                    });
                }
            }
            Part::Picture { command, caption } => {
                text.print_line(&hanging_indent("Picture: ", caption));
                text.print_line(&format!("$ {command}"));
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

/// Returns a block of Markdown for the terminal: without the marks of headings, drawings and links.
fn kept(block: &str) -> String {
    if let Some(drawing) = block.strip_prefix("```") {
        let lines = drawing.lines().skip(1).take_while(|line| *line != "```");
        return lines.collect::<Vec<_>>().join("\n");
    }
    if block.starts_with('#') {
        return block.trim_start_matches('#').trim_start().to_uppercase();
    }
    without_links(block)
}

/// Returns the text of links without their targets.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once('[') {
        plain += before;
        rest = link;
        let is_link = link
            .split_once("](")
            .and_then(|(label, after)| Some((label, after.split_once(')')?.1)));
        match is_link {
            Some((label, after)) if !label.contains('[') => {
                plain += label;
                rest = after;
            }
            _ => plain.push('['),
        }
    }
    plain + rest
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
    fn marks_of_markdown_are_not_printed() {
        assert_eq!(kept("## Its tables"), "ITS TABLES");
        assert_eq!(kept("```text\na ── b\n```"), "a ── b");
        assert_eq!(
            kept("- the [lesson](lessons/flip.md), next"),
            "- the lesson, next"
        );
        assert_eq!(without_links("[a](b) [0, 1] (c)"), "a [0, 1] (c)");
    }
}
