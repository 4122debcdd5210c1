//! `sixfold lessons --export` and `--markdown`: the course as files. `tests/browser/check_site.py` tests the pages in a
//! browser.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::run::{Sixfold, run_ok};

/// Returns the texts of all files below `folder` with this extension, by path.
fn texts(folder: &Path, extension: &str) -> BTreeMap<PathBuf, String> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(texts(&path, extension));
        } else if path.extension().is_some_and(|known| known == extension) {
            let text = fs::read_to_string(&path).expect("a text");
            found.insert(path, text);
        }
    }
    found
}

/// Returns the values of an attribute in a page.
fn values<'p>(page: &'p str, attribute: &str) -> impl Iterator<Item = &'p str> {
    let mark = format!(" {attribute}=\"");
    let parts: Vec<&str> = page.split(mark.as_str()).skip(1).collect();
    parts.into_iter().filter_map(|part| part.split('"').next())
}

/// Returns the path without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

/// Checks that every link of the site leads to a file and an anchor of the site.
fn check_links(folder: &Path) {
    let pages = texts(folder, "html");
    let own = pages
        .iter()
        .filter(|(path, _)| !path.ends_with("explorer.html"));
    let mut checked = 0;
    for (page, text) in own {
        for link in values(text, "href").chain(values(text, "src")) {
            if link.contains("://") || link == "data:," {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = match file {
                "" => page.clone(),
                file => plain(&page.with_file_name("").join(file)),
            };
            let shown = format!("{}: {link}", page.display());
            assert!(target.starts_with(folder) && target.is_file(), "{shown}");
            if !anchor.is_empty() && !target.ends_with("explorer.html") {
                let mut anchors = values(&pages[&target], "id");
                assert!(anchors.any(|id| id == anchor), "{shown}");
            }
            checked += 1;
        }
    }
    assert!(checked > 200, "{checked} links");
}

#[test]
fn a_course_has_a_sheet_without_answers_and_links_that_lead_somewhere() {
    let sixfold = Sixfold::new();
    let run = run_ok(&sixfold, &["lessons", "--export", "course"]);
    assert_eq!(run.stdout.replace('\\', "/"), "course/index.html\n");
    let course = sixfold.folder().join("course");
    check_links(&course);
    let read = |name: &str| fs::read_to_string(course.join(name)).expect("a page");
    let sheet = read("lessons/lab.html");
    assert!(
        sheet.contains("class=\"blank\"") && sheet.contains("sixfold trace vertex_vertices v3")
    );
    let solutions = read("lessons/lab-solutions.html");
    for answer in [
        "One row of v3, and one for each",
        "<li>rows: 4</li>",
        "Answer</summary>",
    ] {
        assert!(solutions.contains(answer), "{answer}");
        assert!(!sheet.contains(answer), "{answer}");
    }
    for list in ["index.html", "lessons/index.html"] {
        assert!(!read(list).contains("lab-solutions"), "{list}");
    }
    assert!(read("index.html").contains("href=\"lessons/lab.html\""));
    let teachers = read("teachers.html");
    for page in ["lessons/lab.html", "lessons/lab-solutions.html"] {
        assert!(teachers.contains(&format!("href=\"{page}\"")), "{page}");
    }
    let lesson = read("lessons/flip.html");
    assert!(lesson.contains("<iframe") && lesson.contains("../explorer.html#show=flip/2"));
    assert!(read("LICENSE-MIT.txt").starts_with("MIT License"));
    assert!(read("LICENSE-APACHE.txt").contains("Apache License"));
}
