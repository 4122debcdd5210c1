//! Tables for LaTeX, with the rules of the package `booktabs`.

use std::fmt::Write as _;

use super::tables::{Cell, Kind, PaperRow, PaperTable};

/// The comment at the top of the file.
const HEAD: &str = "% Tables of times, memory and meshes, made by `sixfold` from the results.
% In the preamble: \\usepackage{booktabs,longtable}. In the text: \\input{results.tex}.
% Names of meshes in scripts other than Latin need XeLaTeX or LuaLaTeX.
";

/// Returns the tables as a file for `\input`.
pub(super) fn document(tables: &[PaperTable]) -> String {
    let mut text = HEAD.to_owned();
    if tables.is_empty() {
        text.push_str("% The results have no times that are compared.\n");
    }
    for table in tables {
        for part in parts(table) {
            write_table(&mut text, &part);
        }
    }
    text
}

/// A table with more columns is wider than a page.
const MOST_COLUMNS: usize = 6;

/// Divides a wide table into tables with equally many columns.
fn parts(table: &PaperTable) -> Vec<PaperTable> {
    let columns = table.columns.len();
    let count = columns.div_ceil(MOST_COLUMNS).max(1);
    let each = columns.div_ceil(count).max(1);
    let part = |number: usize| {
        let of = number * each..columns.min((number + 1) * each);
        let rows = table.rows.iter().map(|row| PaperRow {
            name: row.name.clone(),
            provisional: row.provisional,
            cells: row.cells[of.clone()].to_vec(),
        });
        let (label, caption) = match count {
            1 => (table.label.clone(), table.caption.clone()),
            _ => (
                format!("{}-part-{}", table.label, number + 1),
                format!("Part {} of {count}. {}", number + 1, table.caption),
            ),
        };
        PaperTable {
            label,
            caption,
            rows: rows.collect(),
            columns: table.columns[of.clone()].to_vec(),
        }
    };
    (0..count).map(part).collect()
}

/// A table with more rows can be longer than a page.
const MOST_ROWS: usize = 15;

fn write_table(text: &mut String, table: &PaperTable) {
    let heads: Vec<String> = table.columns.iter().map(|name| column_head(name)).collect();
    let (head, caption) = (heads.join(" & "), escape(&table.caption));
    let columns = format!("@{{}}l{}@{{}}", "r".repeat(table.columns.len()));
    let (start, end) = match table.rows.len() > MOST_ROWS {
        true => (
            format!(
                "{{\\footnotesize\\setlength{{\\tabcolsep}}{{3pt}}\n\\begin{{longtable}}{{{columns}}}\n\
                 \\caption{{{caption}}}\\label{{tab:sixfold-{}}}\\\\\n\\toprule\n & {head} \\\\\n\\midrule\n\\endfirsthead\n\
                 \\toprule\n & {head} \\\\\n\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n",
                table.label
            ),
            "\\end{longtable}}\n",
        ),
        false => (
            format!(
                "\\begin{{table}}\n\\centering\\footnotesize\\setlength{{\\tabcolsep}}{{3pt}}\n\
                 \\setlength{{\\belowcaptionskip}}{{4pt}}\n\\caption{{{caption}}}\n\\label{{tab:sixfold-{}}}\n\
                 \\begin{{tabular}}{{{columns}}}\n\\toprule\n & {head} \\\\\n\\midrule\n",
                table.label
            ),
            "\\bottomrule\n\\end{tabular}\n\\end{table}\n",
        ),
    };
    let _ = write!(text, "\n{start}");
    for row in &table.rows {
        write_row(text, row);
    }
    text.push_str(end);
}

/// Writes a line of numbers, and below it a line of intervals if there are any.
fn write_row(text: &mut String, row: &PaperRow) {
    let numbers: Vec<String> = row.cells.iter().map(number).collect();
    let mark = if row.provisional {
        "\\,$^\\dagger$"
    } else {
        ""
    };
    let intervals = row
        .cells
        .iter()
        .map(|cell| cell.as_ref()?.interval.as_ref());
    let has_intervals = intervals.clone().any(|interval| interval.is_some());
    // The two lines stay on one page.
    let end = if has_intervals { "\\\\*" } else { "\\\\" };
    let name = escape(&row.name);
    let _ = writeln!(text, "{name}{mark} & {} {end}", numbers.join(" & "));
    if !has_intervals {
        return;
    }
    let intervals = intervals.map(|interval| match interval {
        Some(ends) => {
            let [low, high] = ends.each_ref().map(|end| escape(end));
            format!("{{\\scriptsize [{low}--{high}]}}")
        }
        None => String::new(),
    });
    let intervals: Vec<String> = intervals.collect();
    let _ = writeln!(text, " & {} \\\\", intervals.join(" & "));
}

fn number(cell: &Option<Cell>) -> String {
    let Some(cell) = cell else {
        return "--".into();
    };
    let text = escape(&cell.text);
    match cell.kind {
        Kind::Bound => format!("$\\ge$ {text}"),
        Kind::Best => format!("\\textbf{{{text}}}"),
        Kind::Undecided => format!("\\textit{{{text}}}"),
        Kind::Plain => text,
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
            '†' => plain.push_str("$^\\dagger$"),
            'µ' => plain.push_str("$\\mu$"),
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
