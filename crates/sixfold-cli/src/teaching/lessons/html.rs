//! Pages of Markdown as HTML: their links lead to the pages of the site.

use std::collections::BTreeSet;

use maud::{Markup, PreEscaped};
use pulldown_cmark::{CowStr, Event, LinkType, Options, Parser, Tag, TagEnd};

use super::page::{BLANK, LINE, pages_of};
use super::{CHAPTERS, LESSONS};

/// Returns the names of all pages of Markdown, as links have them after the last `/`.
pub(super) fn pages() -> BTreeSet<String> {
    let lessons = LESSONS.iter().flat_map(|(name, _)| pages_of(name));
    let chapters = CHAPTERS.iter().map(|(name, _)| (*name).to_owned());
    let names = lessons.map(|(name, _)| name).chain(chapters);
    names
        .chain(["README".to_owned()])
        .map(|name| format!("{name}.md"))
        .collect()
}

pub(super) fn file_of(name: &str) -> String {
    match name {
        "README" => "index.html".to_owned(),
        _ => format!("{name}.html"),
    }
}

/// Turns Markdown into HTML. A link to a page that the site does not have becomes plain text.
pub(super) fn to_html(markdown: &str, pages: &BTreeSet<String>) -> Markup {
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
    let marked = content
        .replace(LINE, "<span class=\"blank line\"></span>")
        .replace(BLANK, "<span class=\"blank\"></span>")
        .replace(
            "<details><summary>Answer",
            "<details class=\"answer\"><summary>Answer",
        );
    PreEscaped(marked)
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
    let is_picture = link.ends_with(".svg") && !link.contains('/');
    if link.starts_with('#') || link.contains("://") || is_picture {
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
            ("cube.svg", Some("cube.svg")),
            ("../reports/plot.svg", None),
            (
                "lessons/lab-solutions.md",
                Some("lessons/lab-solutions.html"),
            ),
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

    #[test]
    fn blanks_and_answers_have_classes() {
        let markdown = format!(
            "- a: {BLANK}\n- b: {LINE}\n\n<details><summary>Answer</summary>\n\nc\n\n</details>\n"
        );
        let html = to_html(&markdown, &pages()).into_string();
        for part in [
            "a: <span class=\"blank\"></span>",
            "b: <span class=\"blank line\"></span>",
            "<details class=\"answer\">",
        ] {
            assert!(html.contains(part), "{html}");
        }
    }
}
