//! The lessons as data: for the explorer, which shows what their commands show.

use serde::Serialize;

use super::LESSONS;
use super::answers::{Asked, digest};
use super::command::Folder;
use super::source::{Kind, Part, Question, read};
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
        /// Names the question in a file of answers.
        id: String,
        question: String,
        #[serde(skip_serializing_if = "Vec::is_empty")]
        asks: Vec<Asked>,
        #[serde(skip_serializing_if = "String::is_empty")]
        hint: String,
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
            Part::Question(question) => {
                let asks = question.asks.iter().map(|ask| folder.asked(ask));
                let asks = asks.collect::<Result<Vec<Asked>, Failure>>()?;
                PartData::Question {
                    id: id_of(name, &question),
                    question: question.text.trim().to_owned(),
                    asks,
                    hint: question.hint,
                    answer: question.answer,
                }
            }
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

/// Returns the name of a question in files of answers: it is another one if what is asked is something else.
fn id_of(lesson: &str, question: &Question<'_>) -> String {
    let labels = question.asks.iter().map(|ask| ask.label);
    let parts = [lesson, question.text.trim()].into_iter().chain(labels);
    digest(&parts.collect::<Vec<_>>().join("\n"))
}
