//! The course as a site of static files: the guide as HTML, with the explorer beside each lesson.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use pulldown_cmark::{CowStr, Event, LinkType, Options, Parser, Tag, TagEnd};

use super::command::write_file;
use super::page::page;
use super::source::{read, with_parts};
use super::{CHAPTERS, CONTENTS, LESSONS};
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::teaching::explore::{self, Situation};

const STYLE: &str = "\
:root{color-scheme:light dark;--line:#8885}body{margin:0;font:16px/1.5 system-ui,sans-serif}\
main{max-width:62rem;margin:auto;padding:0 1rem 3rem}body.lesson{display:flex;height:100vh}\
body.lesson main{flex:0 1 34rem;overflow:auto;margin:0}body.lesson iframe{flex:1;border:0;border-left:1px solid var(--line)}\
pre{overflow-x:auto;padding:.5rem;border:1px solid var(--line);font-size:.82rem}table{border-collapse:collapse}\
td,th{padding:.15rem .7rem;border-bottom:1px solid var(--line);text-align:left}img{max-width:100%;background:#fff}\
@media(max-width:60rem){body.lesson{display:block;height:auto}body.lesson iframe{display:none}}";

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
    let pages = pages();
    for (name, source) in std::iter::once(("README", CONTENTS)).chain(CHAPTERS) {
        let source = with_parts(source);
        let chapter = read(&source);
        let markdown = page(folder, &chapter, |_, _| None)?;
        let content = to_html(&markdown, &pages);
        let page = document(
            chapter.title,
            None,
            html! {
                @if name != "README" { p { a href="index.html" { "The guide" } } }
                (content)
                @if name == "README" { p { a href="explorer.html" { "The explorer" } } }
            },
        );
        write_file(folder, &file_of(name), &page)?;
    }
    let list = html! {
        p { a href="../index.html" { "The guide" } }
        h1 { "Lessons" }
        ol {
            @for (name, source) in LESSONS {
                li { a href=(file_of(name)) { (read(source).title) } }
            }
        }
    };
    write_file(&lessons, "index.html", &document("Lessons", None, list))?;
    for (i, (name, source)) in LESSONS.iter().enumerate() {
        write_lesson(
            &lessons,
            name,
            source,
            LESSONS.get(i + 1).map(|(next, _)| *next),
            &pages,
        )?;
    }
    Ok(())
}

/// Writes a lesson with the explorer, which shows what the commands of the lesson show.
fn write_lesson(
    folder: &Path,
    name: &str,
    source: &str,
    next: Option<&str>,
    pages: &BTreeSet<String>,
) -> Result<(), Failure> {
    let lesson = read(source);
    let mut shown = 0;
    let markdown = page(folder, &lesson, |line, files| {
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
    let content = html! {
        p { a href="index.html" { "All lessons" } }
        (to_html(&markdown, pages))
        @if let Some(next) = next { p { a href=(file_of(next)) { "The next lesson" } } }
    };
    let page = document(
        lesson.title,
        Some(&format!("../explorer.html{first}")),
        content,
    );
    write_file(folder, &file_of(name), &page)
}

/// Returns the page of a chapter or lesson. `explorer` is the address of the explorer beside it.
fn document(title: &str, explorer: Option<&str>, content: Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width,initial-scale=1";
                link rel="icon" href="data:,";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body class=[explorer.map(|_| "lesson")] {
                main { (content) }
                @if let Some(address) = explorer {
                    iframe name="explorer" title="Sixfold explorer" src=(address) {}
                }
            }
        }
    };
    page.into_string()
}

/// Returns the names of all pages of Markdown, as links have them after the last `/`.
fn pages() -> BTreeSet<String> {
    let names = CHAPTERS.iter().chain(&LESSONS).map(|(name, _)| *name);
    names
        .chain(["README"])
        .map(|name| format!("{name}.md"))
        .collect()
}

fn file_of(name: &str) -> String {
    match name {
        "README" => "index.html".to_owned(),
        _ => format!("{name}.html"),
    }
}

/// Turns Markdown into HTML. A link to a page that the site does not have becomes plain text.
fn to_html(markdown: &str, pages: &BTreeSet<String>) -> Markup {
    let mut is_left_out = false;
    let events: Vec<Event<'_>> = Parser::new_ext(markdown, Options::ENABLE_TABLES).collect();
    let shown = events
        .iter()
        .enumerate()
        .filter_map(|(i, event)| match event {
            Event::Start(Tag::Heading { level, .. }) => Some(Event::Start(Tag::Heading {
                level: *level,
                id: Some(anchor(&events[i + 1..]).into()),
                classes: Vec::new(),
                attrs: Vec::new(),
            })),
            Event::Start(Tag::Link { dest_url, .. }) => {
                let address = target(dest_url, pages);
                is_left_out = address.is_none();
                Some(Event::Start(Tag::Link {
                    link_type: LinkType::Inline,
                    dest_url: CowStr::from(address?),
                    title: CowStr::from(""),
                    id: CowStr::from(""),
                }))
            }
            Event::End(TagEnd::Link) if is_left_out => None,
            event => Some(event.clone()),
        });
    let mut content = String::new();
    pulldown_cmark::html::push_html(&mut content, shown);
    PreEscaped(content)
}

/// Returns the anchor of the heading whose content `events` begin with, as repositories on the web make it.
fn anchor(events: &[Event<'_>]) -> String {
    let content = events
        .iter()
        .take_while(|event| !matches!(event, Event::End(TagEnd::Heading(_))));
    let text = content.filter_map(|event| match event {
        Event::Text(text) | Event::Code(text) => Some(text.to_lowercase()),
        _ => None,
    });
    let kept = |letter: &char| letter.is_alphanumeric() || [' ', '-', '_'].contains(letter);
    let text: String = text.collect();
    text.chars()
        .filter(kept)
        .collect::<String>()
        .replace(' ', "-")
}

/// Returns the address on the site of a page of Markdown, or `None` if the site does not have the page.
fn target(link: &str, pages: &BTreeSet<String>) -> Option<String> {
    if link.starts_with('#') || link.contains("://") {
        return Some(link.to_owned());
    }
    let (path, anchor) = link
        .split_once('#')
        .map_or((link, None), |(path, anchor)| (path, Some(anchor)));
    let (folder, file) = path
        .rsplit_once('/')
        .map_or(("", path), |(folder, file)| (folder, file));
    let is_near = ["", "lessons", ".."].contains(&folder);
    if !pages.contains(file) || !is_near || (folder, file) == ("..", "README.md") {
        return None;
    }
    let mut address = String::new();
    if !folder.is_empty() {
        address = format!("{folder}/");
    }
    address += &file_of(file.trim_end_matches(".md"));
    if let Some(anchor) = anchor {
        address = format!("{address}#{anchor}");
    }
    Some(address)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_pages_of_the_site_only() {
        let pages = pages();
        let expected = [
            (
                "half-edge.md#the-tables-of-a-cube",
                Some("half-edge.html#the-tables-of-a-cube"),
            ),
            ("lessons/README.md", Some("lessons/index.html")),
            ("../study.md", Some("../study.html")),
            ("your-own-program.md", None),
            ("../README.md", None),
            ("../editing/README.md", None),
            ("../../README.md#install", None),
            ("#here", Some("#here")),
        ];
        for (link, address) in expected {
            assert_eq!(target(link, &pages).as_deref(), address, "{link}");
        }
        let html = to_html(
            "[a](b.md) and [c](study.md)\n\n| x |\n|---|\n| <y> |\n",
            &pages,
        )
        .into_string();
        assert!(
            html.starts_with("<p>a and <a href=\"study.html\">c</a></p>"),
            "{html}"
        );
        assert!(html.contains("<table>"), "{html}");
        let html = to_html("## The tables of `v`, twice\n", &pages).into_string();
        assert!(
            html.starts_with("<h2 id=\"the-tables-of-v-twice\">"),
            "{html}"
        );
    }
}
