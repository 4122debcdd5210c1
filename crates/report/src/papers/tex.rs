//! Tables for LaTeX, with the rules of the package `booktabs`.

use std::fmt::Write as _;

use super::tables::{Cell, RatioRow, RatioTable};

/// The comment at the top of the file.
const HEAD: &str =
    "% Tables of times relative to the fastest backend, made by `sixfold` from the results.
% In the preamble: \\usepackage{booktabs}. In the text: \\input{results.tex}.
% Names of meshes in scripts other than Latin need XeLaTeX or LuaLaTeX.
";

/// Returns the tables as a file for `\input`.
pub(super) fn document(tables: &[RatioTable]) -> String {
    let mut text = HEAD.to_owned();
    if tables.is_empty() {
        text.push_str("% The results have no times that are compared.\n");
    }
    for table in tables {
        write_table(&mut text, table);
    }
    text
}

fn write_table(text: &mut String, table: &RatioTable) {
    let heads: Vec<String> = table.columns.iter().map(|name| column_head(name)).collect();
    let _ = write!(
        text,
        "\n\\begin{{table}}\n\\centering\\footnotesize\\setlength{{\\tabcolsep}}{{3pt}}\n\
         \\setlength{{\\belowcaptionskip}}{{4pt}}\n\
         \\caption{{{}}}\n\\label{{tab:sixfold-{}}}\n\
         \\begin{{tabular}}{{@{{}}l{}@{{}}}}\n\\toprule\n & {} \\\\\n\\midrule\n",
        escape(&table.caption),
        table.label,
        "r".repeat(table.columns.len()),
        heads.join(" & "),
    );
    for row in &table.rows {
        write_row(text, row);
    }
    text.push_str("\\bottomrule\n\\end{tabular}\n\\end{table}\n");
}

/// Writes a line of ratios, and below it a line of intervals if there are any.
fn write_row(text: &mut String, row: &RatioRow) {
    let ratios: Vec<String> = row.cells.iter().map(ratio).collect();
    let _ = writeln!(text, "{} & {} \\\\", escape(&row.name), ratios.join(" & "));
    let interval = |cell: &Option<Cell>| cell.as_ref()?.interval.clone();
    let intervals = row.cells.iter().map(interval);
    if intervals.clone().all(|interval| interval.is_none()) {
        return;
    }
    let intervals = intervals.map(|interval| match interval {
        Some([low, high]) => format!("{{\\tiny [{low}, {high}]}}"),
        None => String::new(),
    });
    let intervals: Vec<String> = intervals.collect();
    let _ = writeln!(text, " & {} \\\\", intervals.join(" & "));
}

fn ratio(cell: &Option<Cell>) -> String {
    match cell {
        None => "--".into(),
        Some(cell) if cell.bound => format!("$\\ge$ {}", cell.ratio),
        Some(cell) if cell.best => format!("\\textbf{{{}}}", cell.ratio),
        Some(cell) => cell.ratio.clone(),
    }
}

/// Returns a name with a line for each part, because the names are longer than the numbers.
fn column_head(name: &str) -> String {
    let lines: Vec<String> = name.split_inclusive('-').map(escape).collect();
    format!("\\shortstack[r]{{{}}}", lines.join("\\\\"))
}

/// Escapes the special characters of TeX, and writes the special characters of our texts as commands.
/// Replaces control characters by spaces.
pub(super) fn escape(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '_' | '&' | '%' | '#' | '$' | '{' | '}' => {
                plain.push('\\');
                plain.push(c);
            }
            '~' => plain.push_str("\\textasciitilde{}"),
            '^' => plain.push_str("\\textasciicircum{}"),
            '\\' => plain.push_str("\\textbackslash{}"),
            '<' => plain.push_str("\\textless{}"),
            '>' => plain.push_str("\\textgreater{}"),
            '|' => plain.push_str("\\textbar{}"),
            '"' => plain.push_str("''"),
            // At the beginning of a row, these would be read as options of `\\\\`.
            '[' => plain.push_str("{[}"),
            '*' => plain.push_str("{*}"),
            '≥' => plain.push_str("$\\ge$"),
            '×' => plain.push_str("$\\times$"),
            '–' => plain.push_str("--"),
            '\u{a0}' | '\u{202f}' => plain.push('~'),
            c if c.is_control() => plain.push(' '),
            c => plain.push(c),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn special_characters_are_escaped() {
        assert_eq!(escape("a_&%#$b{}.obj"), "a\\_\\&\\%\\#\\$b\\{\\}.obj");
        assert_eq!(
            escape("~^\\"),
            "\\textasciitilde{}\\textasciicircum{}\\textbackslash{}"
        );
        assert_eq!(escape("a\nb\u{0}"), "a b ");
    }
}
