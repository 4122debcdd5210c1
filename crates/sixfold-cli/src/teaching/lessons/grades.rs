//! `sixfold lessons --check`: grades files of answers that students exported from the page of the explorer.

use std::collections::HashMap;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use comfy_table::Cell;
use serde::Deserialize;
use serde_json::Value;

use super::answers::{Asked, digest, shown};
use crate::failure::Failure;
use crate::output::{Output, is_stdout};
use crate::tables;
use crate::teaching::explore::LESSONS_DATA;
use crate::text::{TextOutput, print_notice, sanitize};

/// The version of the format.
const VERSION: u32 = 1;

/// Larger files are not read.
const MOST_BYTES: u64 = 10_000_000;

/// A file of answers, which the page writes. Its first line has `sixfold_answers` and `digest`, the hash of all lines after
/// it.
#[derive(Debug, Deserialize)]
struct Exported {
    sixfold_answers: u32,
    digest: String,
    #[serde(default)]
    name: String,
    answers: Vec<Answer>,
}

/// The last answer to a question before it was right, or before the solution was shown.
#[derive(Debug, Deserialize)]
struct Answer {
    lesson: String,
    /// Names the question: see the data of the lessons.
    id: String,
    /// For each value that is asked for, what was given. For a question in own words, the text.
    given: Vec<Value>,
    /// How often the answer was checked.
    tries: u32,
    /// Whether the hint was read.
    #[serde(default)]
    hint: bool,
    /// Whether the solution was shown before the answer was right.
    #[serde(default)]
    shown: bool,
}

/// A lesson, as the page has it.
#[derive(Deserialize)]
struct Lesson {
    name: String,
    parts: Vec<Part>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Part {
    Question(Question),
    Other(serde::de::IgnoredAny),
}

#[derive(Deserialize)]
struct Question {
    id: String,
    question: String,
    #[serde(default)]
    asks: Vec<Asked>,
}

/// The questions of all lessons by their names: the lesson, the number in the lesson, and the question.
type Questions<'l> = HashMap<&'l str, (&'l str, usize, &'l Question)>;

/// A graded answer.
struct Graded<'f> {
    student: &'f str,
    lesson: &'f str,
    number: usize,
    question: &'f Question,
    answer: &'f Answer,
}

impl Graded<'_> {
    /// Returns whether the answer is right; `None` for an answer in own words.
    fn is_right(&self) -> Option<bool> {
        let Question { asks, .. } = self.question;
        let Answer { given, shown, .. } = self.answer;
        let mut both = asks.iter().zip(given);
        let mut all = || both.all(|(asked, given)| asked.is_right(given));
        (!asks.is_empty()).then(|| !shown && asks.len() == given.len() && all())
    }
}

pub(super) fn run(files: &[PathBuf], csv: Option<&Path>) -> Result<ExitCode, Failure> {
    let lessons: Vec<Lesson> = serde_json::from_str(LESSONS_DATA).expect("lessons.json is JSON");
    let questions = questions(&lessons);
    let csv_output = csv.map(Output::open).transpose()?;
    let mut exported = Vec::new();
    let mut is_complete = true;
    for file in files {
        match read(file) {
            Ok(read) => exported.push((file, student(file, &read), read)),
            Err(message) => {
                is_complete = false;
                print_notice(&message);
            }
        }
    }
    if exported.is_empty() {
        return Err(Failure::usage(
            "no file of answers could be read: students export theirs in the explorer, Lessons, Save my answers",
        ));
    }
    let mut graded = Vec::new();
    for (file, student, read) in &exported {
        for answer in &read.answers {
            match questions.get(answer.id.as_str()) {
                Some(&(lesson, number, question)) if lesson == answer.lesson => {
                    graded.push(Graded {
                        student,
                        lesson,
                        number,
                        question,
                        answer,
                    });
                }
                found => {
                    is_complete = false;
                    print_notice(&foreign(file, answer, found.map(|(lesson, ..)| *lesson)));
                }
            }
        }
    }
    let mut text = TextOutput::new(!csv.is_some_and(is_stdout));
    print(&lessons, &exported, &graded, &mut text);
    let mut done = text.finish();
    if let Some(output) = csv_output {
        done = done.and(output.finish(|writer| write_csv(&graded, writer)));
    }
    done.map(|()| match is_complete {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(1),
    })
}

fn questions(lessons: &[Lesson]) -> Questions<'_> {
    let mut questions = Questions::new();
    for lesson in lessons {
        for (i, question) in of_lesson(lesson).enumerate() {
            questions.insert(&question.id, (&lesson.name, i + 1, question));
        }
    }
    questions
}

fn of_lesson(lesson: &Lesson) -> impl Iterator<Item = &Question> {
    lesson.parts.iter().filter_map(|part| match part {
        Part::Question(question) => Some(question),
        Part::Other(_) => None,
    })
}

/// Reads a file of answers. An error names the file.
fn read(file: &Path) -> Result<Exported, String> {
    let name = sanitize(&file.display().to_string());
    let mut text = String::new();
    let opened = fs::File::open(file).map_err(|cause| format!("{name}: {cause}"))?;
    let read = opened.take(MOST_BYTES + 1).read_to_string(&mut text);
    read.map_err(|cause| format!("{name}: {cause}"))?;
    if text.len() as u64 > MOST_BYTES {
        return Err(format!(
            "{name}: larger than {} MB, which no file of answers is",
            MOST_BYTES / 1_000_000
        ));
    }
    let document: Value = serde_json::from_str(&text)
        .map_err(|cause| format!("{name}: not a file of answers: {cause}"))?;
    let version = document.get("sixfold_answers");
    match version.and_then(Value::as_u64) {
        None => {
            let other = match document.get("sixfold") {
                Some(_) => {
                    ", but a state of the explorer: export the answers with Lessons, Save my answers"
                }
                None => ": it has no field `sixfold_answers`",
            };
            return Err(format!("{name}: not a file of answers{other}"));
        }
        Some(version) if version != u64::from(VERSION) => {
            return Err(format!(
                "{name}: the answers have version {version}, and this program reads version {VERSION}"
            ));
        }
        Some(_) => {}
    }
    let exported: Exported = serde_json::from_value(document)
        .map_err(|cause| format!("{name}: not a file of answers: {cause}"))?;
    let (_, signed) = text.split_once('\n').unwrap_or_default();
    if digest(signed) != exported.digest {
        return Err(format!(
            "{name}: was changed after the export, and is not graded: ask for a new export"
        ));
    }
    debug_assert_eq!(exported.sixfold_answers, VERSION);
    Ok(exported)
}

/// Returns the name that the student gave, or that of the file.
fn student(file: &Path, exported: &Exported) -> String {
    let name = exported.name.trim();
    match name.is_empty() {
        true => sanitize(&file.file_stem().unwrap_or_default().to_string_lossy()),
        false => sanitize(name),
    }
}

/// Says that an answer is to no question of its lesson. `found` is the lesson that has the question.
fn foreign(file: &Path, answer: &Answer, found: Option<&str>) -> String {
    let file = sanitize(&file.display().to_string());
    let lesson = sanitize(&answer.lesson);
    match found {
        Some(found) => format!(
            "{file}: an answer of the lesson {lesson} belongs to the lesson {found}, and is not graded"
        ),
        None => format!(
            "{file}: the lesson {lesson} of this version does not have the question of an answer, which is not graded: \
             grade it with the version that made the page"
        ),
    }
}

/// Prints a row for each student and lesson.
fn print(
    lessons: &[Lesson],
    exported: &[(&PathBuf, String, Exported)],
    graded: &[Graded<'_>],
    text: &mut TextOutput,
) {
    let heads = [
        "student",
        "lesson",
        "right",
        "tries",
        "hints",
        "shown",
        "own words",
    ];
    let mut table = tables::table(heads.map(Cell::new).to_vec());
    for (_, student, _) in exported {
        for lesson in lessons {
            let own = graded.iter();
            let own = own.filter(|one| {
                std::ptr::eq(one.student, student.as_str()) && one.lesson == lesson.name
            });
            let own: Vec<&Graded<'_>> = own.collect();
            if own.is_empty() {
                continue;
            }
            let count =
                |is_it: &dyn Fn(&Graded<'_>) -> bool| own.iter().filter(|one| is_it(one)).count();
            let asked = of_lesson(lesson)
                .filter(|question| !question.asks.is_empty())
                .count();
            let right = count(&|one| one.is_right() == Some(true));
            table.add_row([
                student.clone(),
                lesson.name.clone(),
                format!("{right} of {asked}"),
                own.iter()
                    .map(|one| u64::from(one.answer.tries))
                    .sum::<u64>()
                    .to_string(),
                count(&|one| one.answer.hint).to_string(),
                count(&|one| one.answer.shown).to_string(),
                count(&|one| one.is_right().is_none()).to_string(),
            ]);
        }
    }
    text.print_line(&table.to_string());
    text.print_line(
        "\nright: of the questions that the program can check. shown: the solution was read first.\n\
         --csv FILE has each answer, also those in own words.",
    );
}

/// Writes a line for each value that was asked for.
fn write_csv(graded: &[Graded<'_>], writer: impl io::Write) -> io::Result<()> {
    let mut lines = csv::Writer::from_writer(writer);
    let written = |lines: &mut csv::Writer<_>| -> csv::Result<()> {
        lines.write_record([
            "student", "lesson", "question", "text", "asked", "given", "right", "tries", "hint",
            "shown",
        ])?;
        for one in graded {
            let (question, answer) = (one.question, one.answer);
            for (i, given) in answer.given.iter().enumerate() {
                let asked = question.asks.get(i);
                let right = asked.map(|asked| !answer.shown && asked.is_right(given));
                lines.write_record([
                    as_text(one.student),
                    one.lesson.to_owned(),
                    one.number.to_string(),
                    question.question.clone(),
                    asked.map_or_else(String::new, |asked| asked.label.clone()),
                    as_text(&shown(given)),
                    right.map_or_else(String::new, |right| right.to_string()),
                    answer.tries.to_string(),
                    answer.hint.to_string(),
                    answer.shown.to_string(),
                ])?;
            }
        }
        Ok(())
    };
    written(&mut lines).map_err(io::Error::other)?;
    lines.flush()
}

/// Returns text of a student so that a spreadsheet does not take it for a formula.
fn as_text(text: &str) -> String {
    match text.starts_with(['=', '+', '-', '@', '\t', '\r']) && text.parse::<f64>().is_err() {
        true => format!("'{text}"),
        false => text.to_owned(),
    }
}
