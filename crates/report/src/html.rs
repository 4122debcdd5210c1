//! The page as one HTML file.

mod tables;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use sixfold_results::numbers::counted;

use crate::colours::dark_rules;
use crate::figure::{Figure, TitledTable};
use crate::{HOW_TO_USE, ReportPage, Section};
use tables::{operations_table, plain_table, summary_table};

/// A line in the head of every page.
pub const GENERATOR: &str = "<meta name=\"generator\" content=\"Sixfold\">";

const STYLE: &str = include_str!("html/style.css");
/// The script of the table of operations.
const SCRIPT: &str = include_str!("html/script.js");

/// Tables with more backends are printed across.
const MOST_COLUMNS: usize = 8;

/// Number of sentences of a lab that are not folded.
const SHOWN: usize = 3;

impl ReportPage {
    /// Returns the page as HTML without external resources.
    pub fn html(&self) -> String {
        let dark = format!("@media (prefers-color-scheme:dark){{{}}}", dark_rules());
        let paper = match self.operations.backends.len() > MOST_COLUMNS {
            true => "landscape",
            false => "portrait",
        };
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width,initial-scale=1";
                    (PreEscaped(GENERATOR))
                    // Prevents browsers from requesting a favicon.
                    link rel="icon" href="data:,";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) (PreEscaped(dark)) (PreEscaped(format!("@page{{size:A4 {paper}}}"))) }
                }
                body data-paper=(paper) {
                    a.skip href="#answer" { "Skip to the answer" }
                    (self.contents())
                    main {
                        (self.first_screen())
                        @for table in &self.tables { (table_section(table, "h2")) }
                        @if !self.operations.lines.is_empty() {
                            section id="operations" {
                                (heading("h2", "All operations", "operations"))
                                (operations_table(&self.operations))
                            }
                        }
                        @for figure in &self.figures { (figure_section(figure, "h2", None)) }
                        @for figure in &self.folded { (folded_figure(figure)) }
                        @for table in &self.appendix { (table_section(table, "h2")) }
                        @for (place, lab) in self.labs.iter().enumerate() { (lab_section(place, lab)) }
                        @if !self.meshes.is_empty() {
                            section id="meshes" {
                                (heading("h2", "All meshes", "meshes"))
                                (plain_table(&self.overview, "The meshes; each name leads to the results of the mesh."))
                                @for section in &self.meshes { (mesh_section(section)) }
                            }
                        }
                        (self.method())
                    }
                    script { (PreEscaped(SCRIPT)) }
                }
            }
        };
        page.into_string()
    }

    /// Returns the links to all parts, which stay in view.
    fn contents(&self) -> Markup {
        let figures = self
            .figures
            .iter()
            .chain(&self.folded)
            .map(|figure| (figure.id.clone(), short(&figure.title)));
        let labs = self.labs.iter().enumerate();
        let labs = labs.map(|(place, lab)| (lab_id(place), short(&lab.title)));
        let link = |table: &TitledTable| (table_id(table), table.title.clone());
        let tables = self.tables.iter().map(link);
        let appendix = self.appendix.iter().map(link);
        html! {
            nav aria-label="Contents" {
                ul {
                    li { a href="#answer" { "Answer" } }
                    @for (id, title) in tables { li { a href={ "#" (id) } { (title) } } }
                    @if !self.operations.lines.is_empty() { li { a href="#operations" { "All operations" } } }
                    @for (id, title) in figures.chain(appendix).chain(labs) { li { a href={ "#" (id) } { (title) } } }
                    @if !self.meshes.is_empty() { li { a href="#meshes" { "All meshes" } } }
                    li { a href="#method" { "How it was measured" } }
                }
            }
        }
    }

    fn first_screen(&self) -> Markup {
        html! {
            header id="answer" {
                h1 { (self.title) }
                @if !self.facts.is_empty() { p.faint { (self.facts) } }
                @if !self.measured.is_empty() { p.faint { (self.measured) } }
                div.first {
                    @if let Some(picture) = &self.picture {
                        @let link = format!("data:image/png;base64,{}", picture.png);
                        figure.mesh {
                            img src=(link) alt={ "The mesh " (picture.label) } width="288" height="288";
                            figcaption { (picture.label) }
                        }
                    }
                    div.answer {
                        @for sentence in &self.answer { p { (lead(sentence)) } }
                        @if let Some(worst) = self.warnings.first() { p.warning { b { "⚠ " } (prose(worst)) } }
                    }
                }
                @if let Some(summary) = &self.summary { (summary_table(summary)) }
                @for sentence in &self.conditions { p { (lead(sentence)) } }
                (self.more_warnings())
                @if !self.failures.is_empty() {
                    h2 { "Not studied" }
                    ul {
                        @for (mesh, reason) in &self.failures { li { code { (mesh) } ": " (reason) } }
                    }
                }
                @if !self.missing.is_empty() {
                    h2 { "Meshes not studied yet" }
                    ul { @for mesh in &self.missing { li { code { (mesh) } } } }
                }
                @if !self.sentences.is_empty() {
                    details { summary { "More on the results" } (list(&self.sentences)) }
                }
            }
        }
    }

    /// Returns the warnings after the first, folded into one line.
    fn more_warnings(&self) -> Markup {
        let more = self.warnings.get(1..).unwrap_or_default();
        html! {
            @if !more.is_empty() {
                details.warnings {
                    summary { b { "⚠ " (counted(more.len(), "more warning", "more warnings")) } }
                    (list(more))
                }
            }
        }
    }

    fn method(&self) -> Markup {
        html! {
            section id="method" {
                (heading("h2", "How it was measured", "method"))
                pre { code { (self.command) } }
                @if let Some(data) = &self.data {
                    p { "All results, with every sample: " a href=(data) { (data) } }
                }
                @for machine in &self.machines { p { (machine) } }
                @if !self.methods.is_empty() {
                    details {
                        summary { "In words, as for a paper" }
                        @for paragraph in &self.methods { p { (paragraph) } }
                    }
                }
            }
        }
    }
}

/// Words before a colon that are longer are no heading.
const LONGEST_LEAD: usize = 110;

/// Returns a sentence with the words before its first colon in bold, without their remark in brackets.
fn lead(sentence: &str) -> Markup {
    // A number and its sign stay on one line.
    let sentence = sentence.replace(" ×", "\u{a0}×");
    match sentence.split_once(": ") {
        Some((lead, rest)) if lead.chars().count() < LONGEST_LEAD => {
            let (words, remark) = lead.split_at(lead.find(" (").unwrap_or(lead.len()));
            html! { strong { (words) } (remark) ": " (prose(rest)) }
        }
        _ => prose(&sentence),
    }
}

/// Returns a sentence in which the commands between backticks are code.
fn prose(sentence: &str) -> Markup {
    html! {
        @for (place, part) in sentence.split('`').enumerate() {
            @if place % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

/// Returns a title for the contents: without the name of the mesh.
fn short(title: &str) -> String {
    let title = title.split(": ").next().unwrap_or(title);
    title.to_owned()
}

fn lab_id(place: usize) -> String {
    format!("lab-{}", place + 1)
}

/// Returns a heading with its permanent link.
fn heading(level: &str, title: &str, id: &str) -> Markup {
    let link = html! {
        (title)
        a.permalink href={ "#" (id) } aria-label={ "Link to “" (title) "”" } { "#" }
    };
    match level {
        "h2" => html! { h2 { (link) } },
        _ => html! { h3 { (link) } },
    }
}

fn list(sentences: &[String]) -> Markup {
    html! {
        @if !sentences.is_empty() {
            ul { @for sentence in sentences { li { (prose(sentence)) } } }
        }
    }
}

fn lab_section(place: usize, lab: &Section) -> Markup {
    let id = lab_id(place);
    html! {
        section id=(id) {
            (heading("h2", &lab.title, &id))
            p.faint { (lab.facts) }
            @let (first, more) = lab.sentences.split_at(lab.sentences.len().min(SHOWN));
            (list(first))
            @if !more.is_empty() { details { summary { "More on the results" } (list(more)) } }
            @if !lab.code.is_empty() { p { (HOW_TO_USE) } pre { (lab.code.join("\n")) } }
            @for figure in &lab.figures { (figure_section(figure, "h3", None)) }
            @for table in &lab.tables { (table_section(table, "h3")) }
        }
    }
}

/// Returns the section of one mesh. It is collapsed at first, so that large pages open fast.
fn mesh_section(section: &Section) -> Markup {
    html! {
        details {
            summary { (section.title) " – " (section.facts) }
            // Inside of the element, so that a link opens it.
            div.mesh-section id=(section.id) {
                (heading("h3", &section.title, &section.id))
                @for sentence in &section.sentences { p { (lead(sentence)) } }
                @if let Some(summary) = &section.summary { (summary_table(summary)) }
                @for figure in &section.figures { (figure_section(figure, "h3", Some(&section.title))) }
                @for table in &section.tables {
                    h4 { (table.title) }
                    (plain_table(&table.table, &table.caption))
                }
            }
        }
    }
}

/// Returns a figure under a heading. `mesh` is the name of the mesh if the page has several meshes.
fn figure_section(figure: &Figure, level: &str, mesh: Option<&str>) -> Markup {
    html! {
        section id=(figure.id) {
            (heading(level, &figure.title, &figure.id))
            (figure_with_numbers(figure, mesh))
        }
    }
}

/// Returns a figure under a heading that is folded at first, and on paper.
fn folded_figure(figure: &Figure) -> Markup {
    html! {
        section id=(figure.id) {
            (heading("h2", &figure.title, &figure.id))
            details.folded {
                summary { "Show the figure: the numbers of the table of all operations, each operation in a panel" }
                (figure_and_caption(figure, None))
            }
        }
    }
}

/// Returns a figure, its numbers and its command. `mesh` is the name of the mesh if the page has several meshes.
fn figure_with_numbers(figure: &Figure, mesh: Option<&str>) -> Markup {
    html! {
        (figure_and_caption(figure, mesh))
        details {
            summary { "Numbers, measurement and command" }
            @if !figure.source.is_empty() { p.faint { (figure.source) } }
            (plain_table(&figure.table, &format!("The numbers of the figure “{}”.", figure.title)))
            pre { code { (figure.command) } }
        }
    }
}

fn figure_and_caption(figure: &Figure, mesh: Option<&str>) -> Markup {
    let class = match figure.picture.panel_count() {
        1 => "scroll wide",
        _ => "scroll wide panels",
    };
    let name = format!("Figure: {}", figure.title);
    html! {
        figure data-figure=(figure.id) data-mesh=[mesh] {
            div class=(class) tabindex="0" role="region" aria-label=(name) style={ "--panel:" (figure.picture.width()) "px" } {
                (figure.picture.markup(&figure.caption))
            }
            figcaption {
                (prose(&figure.caption))
            }
        }
    }
}

/// Number of rows of a table that are not folded.
const UNFOLDED: usize = 16;

/// Returns a table under a heading. A long table is folded.
fn table_section(table: &TitledTable, level: &str) -> Markup {
    let id = table_id(table);
    html! {
        section id=(id) {
            (heading(level, &table.title, &id))
            @if table.table.rows.len() > UNFOLDED {
                details { summary { "Show the table" } (plain_table(&table.table, &table.caption)) }
            } @else {
                (plain_table(&table.table, &table.caption))
            }
        }
    }
}

/// Returns the name of a table in links: `table-outliers`.
fn table_id(table: &TitledTable) -> String {
    let safe = |c: char| if c.is_alphanumeric() { c } else { '-' };
    let title: String = table.title.to_lowercase().chars().map(safe).collect();
    format!("table-{title}")
}
