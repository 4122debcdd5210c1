//! The lessons as data: for the explorer, which shows what their commands show.

use serde::Serialize;

use super::LESSONS;
use super::command::Folder;
use super::source::{Kind, Part, read};
use crate::failure::Failure;
use crate::teaching::explore::Situation;
use crate::text::WIDTH;

/// A lesson.
#[derive(Serialize)]
pub(super) struct LessonData {
    name: &'static str,
    title: &'static str,
    parts: Vec<PartData>,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum PartData {
    Text(String),
    Kept(String),
    File {
        name: &'static str,
        content: String,
    },
    Command {
        line: &'static str,
        /// What the command prints; `None` if it measures time.
        output: Option<String>,
        /// What the explorer shows instead.
        #[serde(skip_serializing_if = "Option::is_none")]
        situation: Option<Situation>,
    },
    #[serde(untagged)]
    Question {
        question: String,
        answer: String,
    },
}

/// Returns the lessons, with the outputs of their commands.
pub(super) fn lessons() -> Result<Vec<LessonData>, Failure> {
    let lessons = LESSONS.iter();
    lessons.map(|(name, source)| lesson(name, source)).collect()
}

fn lesson(name: &'static str, source: &'static str) -> Result<LessonData, Failure> {
    let lesson = read(source);
    let folder = Folder::new()?;
    let mut parts = Vec::new();
    for part in lesson.parts {
        parts.push(match part {
            Part::Text(text) => PartData::Text(text),
            Part::Kept(text) => PartData::Kept(text),
            Part::File { name, content } => {
                folder.write(name, &content)?;
                PartData::File { name, content }
            }
            Part::Question { question, answer } => PartData::Question {
                question: question.trim().to_owned(),
                answer,
            },
            Part::Picture { caption, .. } => PartData::Text(caption),
            Part::Command(command) => {
                let output = match command.kind {
                    Kind::Timed => None,
                    _ => Some(folder.run(command, WIDTH)?),
                };
                let situation = Situation::of_command(command.line, folder.path());
                PartData::Command {
                    line: command.line,
                    output,
                    situation,
                }
            }
        });
    }
    Ok(LessonData {
        name,
        title: lesson.title,
        parts,
    })
}
