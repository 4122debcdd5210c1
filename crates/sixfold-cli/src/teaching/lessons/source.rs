//! The text format of lessons and chapters, and its reader.
//!
//! The first line is the title, after `# `. Other lines begin with a mark:
//!
//! | mark | meaning |
//! |---|---|
//! | `$ ` | a command, and its output |
//! | `$! ` | a command that is refused, and its error |
//! | `$~ ` | a command that measures time: it runs only in a terminal |
//! | `$- ` | a command whose output is not shown |
//! | `$+ ` | a command whose output is folded |
//! | `$^ ` | a command that draws a picture; lines that begin with `^ ` describe the picture |
//! | `? ` and `! ` | a question, and its answer |
//! | `= ` | after a question: what a reader answers and the program checks ([`Ask`]) |
//! | `~ ` | after a question: a hint |
//! | `@ ` | the name of a part that several chapters share, and the options of its commands |
//! | `## `, `- `, `1. `, `\|` | headings, lists and tables of Markdown, which are kept as they are |
//!
//! A block that begins with `file` and a name after three backticks is a file, which the commands read. Other
//! blocks between backticks are kept. All other lines are paragraphs.

use std::iter::Peekable;
use std::str::Lines;

use super::PARTS;

/// One part of a lesson.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Part<'l> {
    Text(String),
    /// A heading, a list, a table, or a block between backticks.
    Kept(String),
    File {
        name: &'l str,
        content: String,
    },
    Command(Shown<'l>),
    Picture {
        command: &'l str,
        caption: String,
    },
    Question(Question<'l>),
}

/// A question, which a reader answers in own words, or by the values that are asked for.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Question<'l> {
    pub(super) text: String,
    pub(super) asks: Vec<Ask<'l>>,
    pub(super) hint: String,
    pub(super) answer: String,
}

/// One value that a question asks for: `= LABEL | ANSWER`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ask<'l> {
    pub(super) label: &'l str,
    pub(super) expected: Expected<'l>,
}

/// Where the right value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Expected<'l> {
    /// `sixfold COMMAND # PATH`: what the JSON of a command has at a path.
    Computed { line: &'l str, path: &'l str },
    /// `one / * two / three`: a choice; the right one has a star.
    Choice(&'l str),
}

impl<'l> Ask<'l> {
    fn read(text: &'l str) -> Option<Self> {
        let (label, answer) = text.split_once(" | ")?;
        let expected = match answer.split_once(" # ") {
            Some((line, path)) => Expected::Computed { line, path },
            None => Expected::Choice(answer),
        };
        Some(Self { label, expected })
    }
}

/// A command of a lesson.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shown<'l> {
    pub(super) line: &'l str,
    pub(super) kind: Kind,
}

/// What a lesson does with the output of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Shows what the command prints.
    Output,
    /// Shows the error: the command fails, which the lesson explains.
    Failure,
    /// Runs the command only in a terminal, because it measures time.
    Timed,
    /// Runs the command, and does not show what it prints.
    Hidden,
    /// Shows the first lines of what the command prints, and folds the rest on a page.
    Folded,
}

const KINDS: [(&str, Kind); 5] = [
    (" ", Kind::Output),
    ("! ", Kind::Failure),
    ("~ ", Kind::Timed),
    ("- ", Kind::Hidden),
    ("+ ", Kind::Folded),
];

/// A lesson that was read.
pub(super) struct Lesson<'l> {
    pub(super) title: &'l str,
    pub(super) parts: Vec<Part<'l>>,
}

/// Returns the source with the shared parts in the places of their names.
pub(super) fn with_parts(source: &str) -> String {
    let insert = |line: &str| {
        let (name, options) = line.strip_prefix("@ ")?.split_once(' ')?;
        let (_, part) = PARTS.iter().find(|(known, _)| *known == name)?;
        Some(part.replace("OPTIONS", options))
    };
    let lines = source.lines().map(|line| match insert(line) {
        Some(part) => part,
        None => format!("{line}\n"),
    });
    lines.collect()
}

/// Reads a lesson.
pub(super) fn read(source: &str) -> Lesson<'_> {
    let mut lines = source.lines().peekable();
    let title = lines.next().and_then(|line| line.strip_prefix("# "));
    let mut parts = Vec::new();
    while let Some(line) = lines.next() {
        if let Some(question) = line.strip_prefix("? ") {
            let text = joined(question, "? ", &mut lines);
            let mut asks = Vec::new();
            while let Some(line) = lines.next_if(|line| line.starts_with("= ")) {
                asks.extend(Ask::read(&line[2..]));
            }
            let hint = joined("", "~ ", &mut lines).trim().to_owned();
            let answer = joined("", "! ", &mut lines).trim().to_owned();
            parts.push(Part::Question(Question {
                text,
                asks,
                hint,
                answer,
            }));
        } else if let Some(name) = line.strip_prefix("```file ") {
            let mut content = String::new();
            for line in lines.by_ref().take_while(|line| *line != "```") {
                content += line;
                content.push('\n');
            }
            parts.push(Part::File { name, content });
        } else if let Some(command) = line.strip_prefix("$^ ") {
            let caption = joined("", "^ ", &mut lines).trim().to_owned();
            parts.push(Part::Picture { command, caption });
        } else if let Some(command) = line.strip_prefix('$') {
            let kind = KINDS.iter().find_map(|(mark, kind)| {
                let line = command.strip_prefix(mark)?;
                Some(Shown { line, kind: *kind })
            });
            parts.extend(kind.map(Part::Command));
        } else if line.starts_with("```") {
            let mut block = vec![line];
            block.extend(lines.by_ref().take_while(|line| *line != "```"));
            block.push("```");
            parts.push(Part::Kept(block.join("\n")));
        } else if is_kept(line) {
            let mut block = vec![line];
            while let Some(line) = lines.next_if(|line| !is_mark(line)) {
                block.push(line);
            }
            parts.push(Part::Kept(block.join("\n")));
        } else if !line.is_empty() {
            let mut text = line.to_owned();
            while let Some(line) = lines.next_if(|line| !is_mark(line)) {
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

/// Returns `first` and the following lines that begin with `mark`, as one line.
fn joined(first: &str, mark: &str, lines: &mut Peekable<Lines<'_>>) -> String {
    let mut text = first.to_owned();
    while let Some(line) = lines.next_if(|line| line.starts_with(mark)) {
        text = format!("{text} {}", &line[mark.len()..]);
    }
    text
}

/// Returns whether a paragraph or a list ends before this line.
fn is_mark(line: &str) -> bool {
    let marks = ["? ", "! ", "^ ", "@ ", "$", "```"];
    line.is_empty() || marks.iter().any(|mark| line.starts_with(mark))
}

/// Returns whether a line begins a heading, a list or a table.
fn is_kept(line: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.chars().all(|one| one.is_ascii_digit());
    let is_numbered = line
        .split_once(". ")
        .is_some_and(|(text, _)| is_number(text));
    is_numbered || ["#", "- ", "|"].iter().any(|mark| line.starts_with(mark))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_lesson_are_read_in_their_order() {
        let source = "# Title\n\nA text\nof two lines.\n\n```file m.obj\nv 0 0 0\n```\n$ sixfold a\n$! sixfold b\n\n\
                      ? Why\n? so?\n= a b | sixfold e # f.0\n= c | x / * y\n~ Look.\n! Thus\n! it is.\nMore.\n\n## Heading\n\n1. one\n   line\n2. two\n$+ sixfold c\n\
                      $^ sixfold d\n^ What\n^ it shows.\n```text\n$ kept\n```\n";
        let lesson = read(source);
        assert_eq!(lesson.title, "Title");
        let command = |line, kind| Part::Command(Shown { line, kind });
        let kept = |text: &str| Part::Kept(text.into());
        let expected = [
            Part::Text("A text of two lines.".into()),
            Part::File {
                name: "m.obj",
                content: "v 0 0 0\n".into(),
            },
            command("sixfold a", Kind::Output),
            command("sixfold b", Kind::Failure),
            Part::Question(Question {
                text: "Why so?".into(),
                asks: vec![
                    Ask {
                        label: "a b",
                        expected: Expected::Computed {
                            line: "sixfold e",
                            path: "f.0",
                        },
                    },
                    Ask {
                        label: "c",
                        expected: Expected::Choice("x / * y"),
                    },
                ],
                hint: "Look.".into(),
                answer: "Thus it is.".into(),
            }),
            Part::Text("More.".into()),
            kept("## Heading"),
            kept("1. one\n   line\n2. two"),
            command("sixfold c", Kind::Folded),
            Part::Picture {
                command: "sixfold d",
                caption: "What it shows.".into(),
            },
            kept("```text\n$ kept\n```"),
        ];
        assert_eq!(lesson.parts, expected);
    }

    #[test]
    fn shared_parts_get_their_options() {
        let inserted = with_parts("# Title\n\n@ queries --backend half-edge\nMore.\n");
        assert!(inserted.starts_with("# Title\n\n"), "{inserted}");
        assert!(inserted.ends_with("\nMore.\n"), "{inserted}");
        assert!(
            inserted.contains("vertex_faces v3 --backend half-edge\n"),
            "{inserted}"
        );
        assert!(
            !inserted.contains("OPTIONS") && !inserted.contains("\n@ "),
            "{inserted}"
        );
    }
}
