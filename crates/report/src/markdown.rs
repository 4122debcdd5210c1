//! The page as Markdown.

use std::fmt::Write as _;

use crate::figure::{Figure, Table, TitledTable};
use crate::{HOW_TO_USE, ReportPage};

impl ReportPage {
    /// Returns the page as Markdown. The page links to each figure as `figures/ID.svg`, where ID is
    /// the `id` of the figure.
    pub fn markdown(&self) -> String {
        self.written(true)
    }

    /// Returns the page as Markdown without pictures, so that it needs no other file: the answer, and all tables.
    pub fn markdown_tables(&self) -> String {
        let mut text = self.written(false);
        text.push_str(SIGNS);
        text
    }

    fn written(&self, with_pictures: bool) -> String {
        let mut text = format!(
            "# {}\n\n```sh\n{}\n```\n\n",
            escape(&self.title),
            self.command
        );
        for machine in &self.machines {
            let _ = writeln!(text, "{}\n", escape(machine));
        }
        if !self.facts.is_empty() {
            let _ = writeln!(text, "{}\n", escape(&self.facts));
        }
        if !self.measured.is_empty() {
            let _ = writeln!(text, "{}\n", escape(&self.measured));
        }
        write_list(&mut text, &self.answer);
        if let Some(summary) = &self.summary {
            write_table(&mut text, &summary.table());
        }
        write_list(&mut text, &self.conditions);
        write_list(&mut text, &self.sentences);
        for warning in &self.warnings {
            let _ = writeln!(text, "> {}\n", escape(warning));
        }
        if !self.failures.is_empty() {
            text.push_str("## Not studied\n\n");
            for (mesh, reason) in &self.failures {
                let _ = writeln!(text, "- {}: {}", escape(mesh), escape(reason));
            }
            text.push('\n');
        }
        if !self.missing.is_empty() {
            text.push_str("## Meshes not studied yet\n\n");
            write_list(&mut text, &self.missing);
        }
        for table in &self.tables {
            write_titled_table(&mut text, table, "##");
        }
        for figure in self.figures.iter().chain(&self.folded) {
            write_figure(&mut text, figure, "##", with_pictures);
        }
        for table in &self.appendix {
            write_titled_table(&mut text, table, "##");
        }
        if !self.overview.rows.is_empty() {
            text.push_str("## All meshes\n\n");
            write_table(&mut text, &self.overview);
        }
        for section in self.labs.iter().chain(&self.meshes) {
            let _ = writeln!(
                text,
                "## {}\n\n{}\n",
                escape(&section.title),
                escape(&section.facts)
            );
            write_list(&mut text, &section.sentences);
            if !section.code.is_empty() {
                let code = section.code.join("\n");
                let _ = writeln!(text, "{HOW_TO_USE}\n\n```text\n{code}\n```\n");
            }
            if let Some(summary) = &section.summary {
                write_table(&mut text, &summary.table());
            }
            for figure in &section.figures {
                write_figure(&mut text, figure, "###", with_pictures);
            }
            for table in &section.tables {
                write_titled_table(&mut text, table, "###");
            }
        }
        text
    }
}

fn write_list(text: &mut String, sentences: &[String]) {
    for sentence in sentences {
        let _ = writeln!(text, "- {}", escape(sentence));
    }
    if !sentences.is_empty() {
        text.push('\n');
    }
}

/// What the signs in tables mean. With pictures, their captions say it.
const SIGNS: &str = "●: the fastest; ◐: shares the first place; ≥: lower bound; \\~: measured on some of the elements; \
                     –: not measured.\n";

/// Writes a figure: its picture with its caption, if asked for, and its table.
fn write_figure(text: &mut String, figure: &Figure, heading: &str, with_picture: bool) {
    let (title, id) = (escape(&figure.title), &figure.id);
    let _ = writeln!(text, "{heading} {title}\n");
    if with_picture {
        let _ = writeln!(text, "![{title}](figures/{id}.svg)\n");
        let _ = writeln!(text, "{}\n", escape(&figure.caption));
    }
    if !figure.source.is_empty() {
        let _ = writeln!(text, "{}\n", escape(&figure.source));
    }
    write_table(text, &figure.table);
    if !with_picture {
        return;
    }
    let _ = writeln!(text, "```sh\n{}\n```\n", figure.command);
}

fn write_titled_table(text: &mut String, table: &TitledTable, heading: &str) {
    let (title, caption) = (escape(&table.title), escape(&table.caption));
    let _ = writeln!(text, "{heading} {title}\n\n{caption}\n");
    write_table(text, &table.table);
}

fn write_table(text: &mut String, table: &Table) {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| escape(cell)).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    text.push_str(&line(&table.header));
    let rules: Vec<&str> = table
        .header
        .iter()
        .enumerate()
        .map(|(i, _)| if i == 0 { "---" } else { "---:" })
        .collect();
    let _ = writeln!(text, "|{}|", rules.join("|"));
    for row in &table.rows {
        text.push_str(&line(row));
    }
    text.push('\n');
}

/// Escapes the special characters of Markdown on GitHub. Replaces line breaks by spaces. A `~` before a space or a
/// sign strikes nothing out.
pub(crate) fn escape(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut letters = text.chars().peekable();
    while let Some(c) = letters.next() {
        let is_special = match c {
            '\n' | '\r' => {
                plain.push(' ');
                continue;
            }
            '~' => letters
                .peek()
                .is_some_and(|&next| next == '~' || next.is_alphanumeric()),
            c => "\\`*_[]<>|#&$".contains(c),
        };
        if is_special {
            plain.push('\\');
        }
        plain.push(c);
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_are_escaped() {
        assert_eq!(escape("a|b_[c](d).obj"), "a\\|b\\_\\[c\\](d).obj");
        assert_eq!(escape("a\nb"), "a b");
        assert_eq!(escape("~~a~1~ & $b$"), "\\~\\~a\\~1~ \\& \\$b\\$");
        assert_eq!(escape("~ 1.31 ×"), "~ 1.31 ×");
    }

    #[test]
    fn a_table_has_a_rule_and_as_many_lines_as_rows() {
        let mut table = Table::new(["", "x"]);
        table.row(vec!["a".into(), "1".into()]);
        let mut text = String::new();
        write_table(&mut text, &table);
        assert_eq!(text, "|  | x |\n|---|---:|\n| a | 1 |\n\n");
    }
}
