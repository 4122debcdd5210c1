//! Lessons in the terminal, which wait for the answers of the reader.

use std::io::{self, BufRead, IsTerminal, Write};
use std::process::ExitCode;

use super::command::{Folder, trace_heading};
use super::paragraph_of;
use super::source::{Kind, Lesson, Part};
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::text::{TextOutput, hanging_indent, width};

/// Returns a command behind a prompt. A wide command continues before its options on more lines, as a
/// shell reads it.
fn prompt(command: &str, width: usize) -> String {
    let mut words = command.split(" --");
    let mut lines = vec![format!("$ {}", words.next().unwrap_or_default())];
    for option in words {
        let last = lines.len() - 1;
        // Room for the sign of a continued line.
        match lines[last].chars().count() + option.chars().count() + 5 <= width {
            true => lines[last] += &format!(" --{option}"),
            false => lines.push(format!("    --{option}")),
        }
    }
    lines.join(" \\\n")
}

/// Runs a lesson in the terminal.
pub(super) fn teach(lesson: &Lesson<'_>, waits: bool) -> Result<ExitCode, Failure> {
    let folder = Folder::new()?;
    let mut text = TextOutput::new(true);
    let mut waits = waits && io::stdin().is_terminal();
    text.print_line(&format!("{}\n", lesson.title.to_uppercase()));
    for part in &lesson.parts {
        match part {
            Part::Text(paragraph) => {
                text.print_line(&paragraph_of(&without_marks(paragraph), width()));
            }
            Part::Kept(block) => text.print_line(&kept(block)),
            Part::File { name, content } => {
                folder.write(name, content)?;
                text.print_line(&format!("The file {name}:\n\n{}", indented(content)));
            }
            Part::Command(command) => {
                text.print_line(&prompt(command.line, width()));
                if command.kind == Kind::Timed && !waits {
                    text.print_line("(measures time)");
                } else if command.kind == Kind::Hidden {
                    folder.run(*command, width())?;
                } else {
                    let printed = folder.run(*command, width())?;
                    text.print_line(&match (command.kind, trace_heading(*command, &printed)) {
                        (Kind::Folded, Some((_, counts))) => hanging_indent("", &counts),
                        (Kind::Folded, None) => "(long: run it to see the output)".to_owned(),
                        _ => printed.trim_end().to_owned(),
                    });
                }
            }
            Part::Picture { command, caption } => {
                text.print_line(&hanging_indent("Picture: ", caption));
                text.print_line(&prompt(command, width()));
            }
            Part::Question(question) => {
                text.print_line(&hanging_indent("? ", &question.text));
                if !waits {
                } else if question.asks.is_empty() {
                    waits = answer_to("Your answer, then Enter")?.is_some();
                } else {
                    for ask in &question.asks {
                        let asked = folder.asked(ask)?;
                        let Some(given) = answer_to(&asked.prompt())? else {
                            waits = false;
                            break;
                        };
                        text.print_line(&hanging_indent("  ", &asked.verdict(&given)));
                    }
                }
                text.print_line("");
                text.print_line(&hanging_indent("  ", &question.answer));
            }
        }
        text.print_line("");
    }
    text.finish().map(|()| ExitCode::SUCCESS)
}

/// Waits for an answer of the reader. Returns `None` at the end of the input.
fn answer_to(prompt: &str) -> Result<Option<String>, Failure> {
    print!("\n{prompt}: ");
    let failed = |cause| cannot_write("the terminal", &cause);
    io::stdout().flush().map_err(failed)?;
    let mut answer = String::new();
    let read = io::stdin().lock().read_line(&mut answer).map_err(failed)?;
    Ok((read > 0).then_some(answer))
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
    let plain = without_marks(block);
    match block.starts_with('|') {
        true => table(&plain),
        false => list(&plain),
    }
}

/// Returns the rows of a table, with its first column on the left and the other cells beside it.
fn table(block: &str) -> String {
    let rows = block.lines().filter(|line| !line.starts_with("|---"));
    let rows: Vec<Vec<&str>> = rows
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let widest = rows.iter().map(|row| row[0].chars().count()).max();
    let widest = widest.unwrap_or(0) + 2;
    let lines = rows.iter().map(|row| {
        let others: Vec<&str> = row[1..]
            .iter()
            .copied()
            .filter(|cell| !cell.is_empty())
            .collect();
        hanging_indent(&format!("{:<widest$}", row[0]), &others.join(" · "))
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the items of a list, broken into lines that are not too wide.
fn list(block: &str) -> String {
    let mut items: Vec<String> = Vec::new();
    for line in block.lines() {
        match items.last_mut() {
            Some(item) if line.starts_with(' ') => *item += &format!(" {}", line.trim_start()),
            _ => items.push(line.to_owned()),
        }
    }
    let items = items.iter().map(|item| match item.split_once(' ') {
        Some((mark, text)) => hanging_indent(&format!("{mark} "), text),
        None => item.clone(),
    });
    items.collect::<Vec<_>>().join("\n")
}

/// Returns the text without the targets of links, and without the marks of bold words.
fn without_marks(text: &str) -> String {
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
    (plain + rest).replace("**", "")
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
            kept("- the [lesson](lessons/flip.md),\n  next\n- last"),
            "- the lesson, next\n- last"
        );
        assert_eq!(
            kept("| a | b | c |\n|---|---|---|\n| long | d | e |"),
            "a     b · c\nlong  d · e"
        );
        assert_eq!(without_marks("[a](b) [0, 1] (c)"), "a [0, 1] (c)");
        assert_eq!(without_marks("**a** b"), "a b");
    }
}
