//! The page as one HTML file.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::colours::dark_rules;
use crate::figure::{Figure, Table, TitledTable};
use crate::{ReportPage, Section};

/// Style sheet: fonts, light and dark mode, printing, small screens.
const STYLE: &str = "\
:root{color-scheme:light dark;--text:#17181a;--background:#fdfdfc;--faint:#66686c;--line:#dcdcda;--link:#1f6fb0}\
@media (prefers-color-scheme:dark){:root{--text:#e4e4e2;--background:#17181a;--faint:#a0a2a6;--line:#3a3b3e;--link:#5ba4e6}}\
body{margin:0 auto;max-width:60rem;padding:1rem;background:var(--background);color:var(--text);\
font:16px/1.5 system-ui,sans-serif}\
h1{font-size:1.6rem;line-height:1.2}h2{font-size:1.25rem;margin-top:2.5rem;overflow-wrap:anywhere}\
h3{font-size:1.05rem}a{color:var(--link)}code,pre{font:.9em/1.4 ui-monospace,monospace}\
pre{overflow-x:auto;padding:.5rem .75rem;border:1px solid var(--line);border-radius:4px}\
figure{margin:1.5rem 0;break-inside:avoid}figcaption{color:var(--faint);font-size:.9rem}\
figure svg{display:block;max-width:100%;min-width:34rem;height:auto}figure svg g:hover>*{opacity:.75}\
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.85rem;font-variant-numeric:tabular-nums}\
td,th{padding:.15rem .6rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}\
td:first-child,th:first-child{text-align:left}summary{cursor:pointer;color:var(--faint);font-size:.9rem}\
.warning::before{content:'! ';font-weight:bold}\
@media print{body{max-width:none}details::details-content{content-visibility:visible}.scroll{overflow:visible}}";

impl ReportPage {
    /// Returns the page as HTML without external resources.
    pub fn html(&self) -> String {
        let dark = format!("@media (prefers-color-scheme:dark){{{}}}", dark_rules());
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width,initial-scale=1";
                    // Prevents browsers from requesting a favicon.
                    link rel="icon" href="data:,";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) (PreEscaped(dark)) }
                }
                body {
                    h1 { (self.title) }
                    pre { code { (self.command) } }
                    @for machine in &self.machines { p { (machine) } }
                    (list(&self.sentences))
                    @for warning in &self.warnings { p.warning { (warning) } }
                    @if !self.failures.is_empty() {
                        h2 { "Not studied" }
                        ul {
                            @for (mesh, reason) in &self.failures {
                                li { code { (mesh) } ": " (reason) }
                            }
                        }
                    }
                    @if !self.missing.is_empty() {
                        h2 { "Meshes not studied yet" }
                        ul { @for mesh in &self.missing { li { code { (mesh) } } } }
                    }
                    @for figure in &self.figures { (figure_section(figure, "h2", None)) }
                    @for table in &self.tables { h2 { (table.title) } (table_section(table)) }
                    @for lab in &self.labs {
                        h2 { (lab.title) }
                        p { (lab.facts) }
                        (list(&lab.sentences))
                        @for figure in &lab.figures { (figure_section(figure, "h3", None)) }
                        @for table in &lab.tables { h3 { (table.title) } (table_section(table)) }
                    }
                    @if !self.meshes.is_empty() {
                        h2 { "Mesh by mesh" }
                        @for section in &self.meshes { (mesh_section(section)) }
                    }
                }
            }
        };
        page.into_string()
    }
}

fn list(sentences: &[String]) -> Markup {
    html! {
        @if !sentences.is_empty() {
            ul { @for sentence in sentences { li { (sentence) } } }
        }
    }
}

/// Returns the section of one mesh. It is collapsed at first, so that large pages open fast.
fn mesh_section(section: &Section) -> Markup {
    html! {
        details {
            summary { (section.title) " – " (section.facts) }
            (list(&section.sentences))
            @for figure in &section.figures { (figure_section(figure, "h3", Some(&section.title))) }
        }
    }
}

/// Returns a figure under a heading. `mesh` is the name of the mesh if the page has several meshes.
fn figure_section(figure: &Figure, heading: &str, mesh: Option<&str>) -> Markup {
    html! {
        section id=(figure.id) {
            @if heading == "h2" { h2 { (figure.title) } } @else { h3 { (figure.title) } }
            figure data-figure=(figure.id) data-mesh=[mesh] {
                // Wide figures scroll on small screens.
                div.scroll { (figure.picture.markup()) }
                figcaption { (figure.caption) }
            }
            details {
                summary { "Numbers and command" }
                (table_markup(&figure.table))
                pre { code { (figure.command) } }
            }
        }
    }
}

fn table_section(table: &TitledTable) -> Markup {
    html! {
        p { (table.caption) }
        (table_markup(&table.table))
    }
}

fn table_markup(table: &Table) -> Markup {
    html! {
        div.scroll {
            table {
                thead { tr { @for name in &table.header { th { (name) } } } }
                tbody {
                    @for row in &table.rows {
                        tr { @for cell in row { td { (cell) } } }
                    }
                }
            }
        }
    }
}
