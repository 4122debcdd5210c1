//! The course as a site of static files: the guide as HTML, with the explorer beside each lesson.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::Value;

use super::command::write_file;
use super::html::{file_of, pages, to_html};
use super::page::{Form, page, pages_of, title_of};
use super::source::{read, with_parts};
use super::{CHAPTERS, CONTENTS, LESSONS, SHEETS};
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::teaching::explore::{self, COLOURS, LESSONS_DATA, Situation};

const STYLE: &str = include_str!("site.css");
/// Shows the progress that the explorer keeps in the local storage, and opens the explorer on narrow screens.
const SCRIPT: &str = include_str!("site.js");

/// The texts of the licences, as files of the site.
const LICENCES: [(&str, &str); 2] = [
    ("LICENSE-MIT.txt", include_str!("../../../LICENSE-MIT")),
    (
        "LICENSE-APACHE.txt",
        include_str!("../../../LICENSE-APACHE"),
    ),
];

/// Where a page is on the site.
#[derive(Clone, Copy)]
enum Place {
    Guide,
    Lessons,
}

/// A page of the site.
struct Document<'d> {
    title: &'d str,
    place: Place,
    /// The part of the address of the explorer after `#`, if the explorer is beside the page.
    explorer: Option<String>,
    content: Markup,
}

/// Writes the site to `folder`: `index.html`, the chapters, the lessons and the explorer.
pub(super) fn write(folder: &Path) -> Result<(), Failure> {
    let lessons = folder.join("lessons");
    fs::create_dir_all(&lessons)
        .map_err(|cause| cannot_write(&lessons.display().to_string(), &cause))?;
    write_file(
        folder,
        "explorer.html",
        &explore::page(&Situation::default()),
    )?;
    for (name, text) in LICENCES {
        write_file(folder, name, text)?;
    }
    let pages = pages();
    for (name, source) in std::iter::once(("README", CONTENTS)).chain(CHAPTERS) {
        let source = with_parts(source);
        let chapter = read(&source);
        let markdown = page(folder, &chapter, Form::Full, |_, _| None)?;
        let document = Document {
            title: chapter.title,
            place: Place::Guide,
            explorer: None,
            content: to_html(&markdown, &pages),
        };
        write_file(folder, &file_of(name), &document.to_html())?;
    }
    let document = Document {
        title: "Lessons",
        place: Place::Lessons,
        explorer: None,
        content: list_of_lessons(),
    };
    write_file(&lessons, "index.html", &document.to_html())?;
    for (i, (name, source)) in LESSONS.iter().enumerate() {
        for (file, form) in pages_of(name) {
            write_lesson(&lessons, &file, form, i, source, &pages)?;
        }
    }
    Ok(())
}

/// Returns the list of the lessons. A sheet is in the list, and its solutions are not.
fn list_of_lessons() -> Markup {
    html! {
        h1 { "Lessons" }
        p {
            "In the order of a course; each takes 10 to 20 minutes. The explorer beside a lesson shows what its commands print, and checks \
             your answers."
        }
        ol class="lessons" {
            @for (name, source) in LESSONS {
                li {
                    a href=(file_of(name)) { (read(source).title) }
                    @if SHEETS.contains(&name) { " (a sheet to print)" }
                    " " (progress(name))
                }
            }
        }
    }
}

/// Returns the place where the script shows how many questions of a lesson are answered.
fn progress(lesson: &str) -> Markup {
    let lessons: Vec<Value> = serde_json::from_str(LESSONS_DATA).expect("lessons.json is JSON");
    let found = lessons.iter().find(|one| one["name"] == lesson);
    let parts = found.and_then(|one| one["parts"].as_array());
    let questions = parts.into_iter().flatten();
    let ids: Vec<&str> = questions.filter_map(|part| part["id"].as_str()).collect();
    html! { span class="progress" data-questions=(ids.join(" ")) {} }
}

/// Writes a page of the lesson of a number, with the explorer, which shows what the commands of the lesson show.
fn write_lesson(
    folder: &Path,
    file: &str,
    form: Form,
    number: usize,
    source: &str,
    pages: &BTreeSet<String>,
) -> Result<(), Failure> {
    let lesson = read(source);
    let name = LESSONS[number].0;
    let mut shown = 0;
    let markdown = page(folder, &lesson, form, |line, files| {
        Situation::of_command(line, files)?;
        shown += 1;
        Some(format!(
            "<a target=\"explorer\" href=\"../explorer.html#show={name}/{shown}\">Show this in the explorer</a>"
        ))
    })?;
    let first = match shown {
        0 => String::new(),
        _ => format!("#show={name}/1"),
    };
    let next = LESSONS.get(number + 1);
    let content = html! {
        p class="where" {
            "Lesson " (number + 1) " of " (LESSONS.len()) " " (progress(name)) " "
            a href={ "../explorer.html#lesson=" (name) } { "Answer the questions in the explorer" }
        }
        (to_html(&markdown, pages))
        @if let Some((next, source)) = next {
            p class="next" { "Next: " a href=(file_of(next)) { (read(source).title) } }
        }
    };
    let title = title_of(&lesson, form);
    let document = Document {
        title: &title,
        place: Place::Lessons,
        explorer: Some(first),
        content,
    };
    write_file(folder, &file_of(file), &document.to_html())
}

impl Document<'_> {
    fn to_html(&self) -> String {
        let root = match self.place {
            Place::Guide => "",
            Place::Lessons => "../",
        };
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width,initial-scale=1";
                    link rel="icon" href="data:,";
                    title { (self.title) " · Sixfold" }
                    style { (PreEscaped(COLOURS)) (PreEscaped(STYLE)) }
                }
                body class=[self.explorer.as_ref().map(|_| "lesson")] {
                    (self.header(root))
                    main {
                        (self.content)
                        (footer(root))
                    }
                    @if let Some(shown) = &self.explorer {
                        section id="explorer" aria-label="Explorer" {
                            button type="button" { "Open the explorer here" }
                            iframe name="explorer" title="Sixfold explorer" loading="lazy"
                                src={ (root) "explorer.html" (shown) } {}
                        }
                    }
                    script { (PreEscaped(SCRIPT)) }
                }
            }
        };
        page.into_string()
    }

    /// Returns the links at the top of a page. `root` leads from the page to the folder of the site.
    fn header(&self, root: &str) -> Markup {
        let is_guide = matches!(self.place, Place::Guide);
        let current = |is_here: bool| is_here.then_some("true");
        html! {
            header {
                b { "Sixfold" }
                nav aria-label="Site" {
                    a href={ (root) "index.html" } aria-current=[current(is_guide)] { "Guide" }
                    a href={ (root) "lessons/index.html" } aria-current=[current(!is_guide)] { "Lessons" }
                    a href={ (root) "explorer.html" } { "Explorer" }
                }
            }
        }
    }
}

fn footer(root: &str) -> Markup {
    html! {
        footer {
            "Sixfold " (env!("CARGO_PKG_VERSION")) " · licence: "
            a href={ (root) "LICENSE-MIT.txt" } { "MIT" } " or "
            a href={ (root) "LICENSE-APACHE.txt" } { "Apache 2.0" }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_of_lessons_has_sheets_and_no_solutions() {
        let list = list_of_lessons().into_string();
        assert!(list.contains("<a href=\"lab.html\">"), "{list}");
        assert!(!list.contains("solutions"), "{list}");
    }

    #[test]
    fn each_lesson_names_its_questions() {
        for (name, source) in LESSONS {
            let count = source.lines().filter(|line| line.starts_with("! ")).count();
            let html = progress(name).into_string();
            let (_, ids) = html.split_once("data-questions=\"").expect("questions");
            let ids = ids.split('"').next().unwrap_or_default();
            assert!(
                !ids.is_empty() && ids.split(' ').count() <= count,
                "{name}: {html}"
            );
        }
    }

    #[test]
    fn the_script_reads_what_the_explorer_keeps() {
        let store = include_str!("../explore/store.js");
        assert!(store.contains("const KEY = \"sixfold-explorer\";"));
        assert!(SCRIPT.contains("localStorage.getItem(\"sixfold-explorer\")"));
    }
}
