//! The tables of the page: the structures by kind of work, all operations, and plain tables.

use maud::{Markup, html};
use sixfold_results::Standing;
use sixfold_results::numbers::{counted, duration, figure, rounded_down};

use super::prose;
use crate::figure::Table;
use crate::matrix::{Cell, Line, Matrix, Source, ends_of_ratios};
use crate::summary::{Drawing, Rank, Summary, SummaryFigure};

/// Returns the table of the first screen.
pub(super) fn summary_table(summary: &Summary) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="Table: the structures by kind of work" {
            table.summary {
                caption {
                    span {
                        "Times, or their geometric means, are divided by the shortest of the column. A dot is a ratio on a logarithmic scale from 1 to 10, the line \
                         is " (summary.ends) "; an arrow is beyond. " b { "● best" } " · " b { "◐ shared" } ": equal to the best, \
                         or undecided · ≥: lower bound, not ranked. Memory: the bytes of all tables divided by the vertices, and by the triangles \
                         (or faces); multiply by the number of yours. Its bars begin at 0."
                    }
                }
                thead {
                    tr {
                        th scope="col" { "structure" }
                        @for column in &summary.columns {
                            th scope="col" title=(column.about) { (column.name) small { (column.over) } }
                        }
                    }
                }
                tbody {
                    @for row in &summary.rows {
                        tr {
                            th scope="row" { (row.backend) }
                            @if let Some(reason) = &row.refusal {
                                td.none.words colspan=(summary.columns.len()) { "cannot hold this mesh: " (reason) }
                            } @else {
                                @for figure in &row.figures { (summary_cell(figure.as_ref())) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn summary_cell(figure: Option<&SummaryFigure>) -> Markup {
    let Some(figure) = figure else {
        return html! { td.none { "–" } };
    };
    let (class, style) = match figure.drawing {
        Drawing::Bar(share) => ("bar", format!("--share:{share:.3}")),
        Drawing::Dot { ratio, interval } => {
            let class = match (figure.rank, ratio > END) {
                (_, true) => "dot over",
                (Rank::Bound, false) => "dot bound",
                _ => "dot",
            };
            (class, dot_places(ratio, interval))
        }
    };
    let interval = match figure.drawing {
        Drawing::Dot {
            interval: Some([low, high]),
            ..
        } if low < high => Some(format!("{} to {}", self::figure(low), self::figure(high))),
        _ => None,
    };
    html! {
        td class=(class) style=(style) title=[interval] {
            @match figure.rank {
                Rank::Best => { span.mark { "● " } b { (figure.text) } }
                Rank::Shared => { span.mark { "◐ " } b { (figure.text) } }
                _ => { (figure.text) }
            }
            @if let Some(detail) = &figure.detail { small { (detail) } }
        }
    }
}

/// The end of the scale of ratios.
const END: f64 = 10.0;

/// Returns where a dot and its line are, as parts of the scale from 1 to [`END`].
fn dot_places(ratio: f64, interval: Option<[f64; 2]>) -> String {
    let place = |ratio: f64| (ratio.ln() / END.ln()).clamp(0.0, 1.0);
    let line = interval.map_or(String::new(), |[low, high]| {
        format!(";--from:{:.3};--to:{:.3}", place(low), place(high))
    });
    format!("--at:{:.3}{line}", place(ratio))
}

/// Returns the table of all operations, with the controls that the script shows.
pub(super) fn operations_table(matrix: &Matrix) -> Markup {
    let mut groups: Vec<&str> = matrix.lines.iter().map(|line| line.group.name()).collect();
    groups.dedup();
    let has = |source| {
        let mut cells = matrix.lines.iter().flat_map(|line| &line.cells);
        cells.any(|cell| cell.source == source && cell.ratio.is_some())
    };
    let has_samples = matrix
        .lines
        .iter()
        .flat_map(|line| &line.cells)
        .any(has_samples_text);
    let is_mean = matrix.meshes > 1;
    let mut cells = matrix.lines.iter().flat_map(|line| &line.cells);
    let has_undecided = !is_mean && cells.any(|cell| cell.standing == Some(Standing::Undecided));
    let time = match is_mean {
        true => "Geometric mean over the meshes of the time",
        false => "Time",
    };
    let ends = ends_of_ratios(matrix.meshes, matrix.confidence);
    html! {
        @if has_samples {
            p.faint.hint hidden { "Choose an operation to see all its samples." }
        }
        div.controls hidden {
            label { "compared with"
                select name="baseline" {
                    option value="" { "the fastest" }
                    @for name in &matrix.backends { option value=(name) { (name) } }
                }
            }
            label { "figures"
                select name="figures" {
                    option value="ratios" { "ratios" }
                    option value="times" { "time per element" }
                }
            }
            label { "kind of work"
                select name="group" {
                    option value="" { "all" }
                    @for group in &groups { option value=(group) { (group) } }
                }
            }
            label { "find" input type="search" name="search" size="12"; }
            output.faint aria-live="polite" {}
        }
        div.scroll tabindex="0" role="region" aria-label="Table: all operations" {
            table.operations {
                caption {
                    span {
                        span.reading data-time=(time) data-ends=(ends) {
                            (time) " divided by that of the fastest" @if is_mean { " on average" } ", with " (ends) "."
                        }
                        " A measured ratio is the quotient of the two times with three digits, as they are shown."
                        " A dot is a ratio on a logarithmic scale "
                        span.scale { "from 1 to 10" }
                        ", the line is between these ends; an arrow is beyond."
                        @if has(Source::Bound) { " ≥, with a ring: a lower bound, because a run would exceed the budget." }
                        @if has_undecided { " Undecided: perhaps the fastest, because the interval contains 1, or two measurements of one backend differ by as much." }
                        @if has(Source::Sampled) { " ~: measured on some of the elements." }
                    }
                }
                thead {
                    tr {
                        th scope="col" { "operation" }
                        @for name in &matrix.backends { th scope="col" { (name) } }
                    }
                }
                tbody {
                    @for (place, line) in matrix.lines.iter().enumerate() {
                        @let starts = place > 0 && matrix.lines[place - 1].group != line.group;
                        tr.first-of-group[starts] data-operation=(line.name) data-group=(line.group.name()) {
                            th scope="row" { (line.name) small { (line.about) ", per " (line.unit) } }
                            @for cell in &line.cells { (operation_cell(line, cell)) }
                        }
                    }
                }
            }
        }
    }
}

fn operation_cell(line: &Line, cell: &Cell) -> Markup {
    let (class, sign) = match cell.source {
        Source::Measured => ("dot", None),
        Source::Sampled => ("dot", Some("~ ")),
        Source::Bound => ("dot bound", Some("≥ ")),
        Source::Impossible | Source::NotRun => ("none", None),
    };
    let samples = match cell.samples {
        0 => String::new(),
        count if cell.first_runs => counted(count, "first run", "first runs"),
        count => counted(count, "sample", "samples"),
    };
    let title = [
        cell.time_text() + " per " + &line.unit,
        samples,
        cell.note(),
    ];
    let title: Vec<String> = title.into_iter().filter(|part| !part.is_empty()).collect();
    let places = cell.ratio.map(|ratio| dot_places(ratio, cell.interval));
    let class = match cell.ratio > Some(END) {
        true => format!("{class} over"),
        false => class.to_owned(),
    };
    let time = cell.ns.map(|_| match cell.source {
        Source::Sampled => format!("~ {}", cell.time_text()),
        _ => cell.time_text(),
    });
    let ends = cell.ns_interval.map(|ends| ends.map(duration).join(" to "));
    html! {
        td class=(class) style=[places] title=(title.join("; "))
            data-sign=[sign] data-time=[time] data-ends=[ends] data-ns=[times_of_dot(cell)]
            data-ratio=[cell.ratio.map(|ratio| format!("{ratio:.4e}"))]
            data-to=[cell.ns.map(|_| quotients(line, cell))]
            data-samples=[has_samples_text(cell).then(|| samples_text(cell))]
        {
            @match cell.ratio {
                Some(_) => {
                    @let text = cell.times_text();
                    @if cell.is_best() { b { (text) } } @else { (text) }
                    @if cell.standing == Some(Standing::Equal) { " " span.mark { "equal" } }
                    @if cell.standing == Some(Standing::Undecided) { " " span.mark { "undecided" } }
                    @if let Some(interval) = cell.interval_text() { small { (interval) } }
                }
                None => {
                    @match cell.source {
                        Source::Impossible => "not possible",
                        Source::NotRun => "not run",
                        _ => "not compared",
                    }
                }
            }
        }
    }
}

fn has_samples_text(cell: &Cell) -> bool {
    cell.launches.iter().any(|launch| !launch.is_empty())
}

/// Returns the samples of a cell: the shortest time per element, and for each launch how many thousandths longer each
/// sample took, such as `5.56 0,12,7 - 3,4` with a launch without samples.
fn samples_text(cell: &Cell) -> String {
    let times = cell.launches.iter().flatten();
    let shortest = times.copied().fold(f64::INFINITY, f64::min);
    let launches = cell.launches.iter().map(|launch| {
        let longer = launch
            .iter()
            .map(|ns| (1e3 * (ns / shortest - 1.0)).round().to_string());
        match launch.is_empty() {
            true => "-".to_owned(),
            false => longer.collect::<Vec<_>>().join(","),
        }
    });
    let launches: Vec<String> = launches.collect();
    format!(
        "{shortest:.5e} {}",
        launches.join(" ").trim_end_matches(" -")
    )
}

/// Returns the time of a cell and the ends of its interval in nanoseconds, for the place of its dot.
fn times_of_dot(cell: &Cell) -> Option<String> {
    let times = [cell.ns?].into_iter();
    let times = times.chain(cell.ns_interval.into_iter().flatten());
    Some(
        times
            .map(|ns| format!("{ns:.4e}"))
            .collect::<Vec<_>>()
            .join(" "),
    )
}

/// Returns the quotients of the time of a cell and that of each backend of its line, with `|` between them. A quotient is
/// the ratio and the ends of its interval as they are shown, such as `1.31 1.28 1.34`. A backend without a time, or with
/// a lower bound, has no numbers.
fn quotients(line: &Line, cell: &Cell) -> String {
    let of_bound = |other: &Cell| {
        let (own, other) = cell.ratio.zip(other.ratio)?;
        Some(figure(rounded_down(own / other)))
    };
    let text = |(place, other): (usize, &Cell)| match cell.quotients.get(place).copied().flatten() {
        _ if other.is_bound() => String::new(),
        _ if other.backend == cell.backend => figure(1.0),
        // The time may have been measured on some of the meshes.
        _ if cell.is_bound() => of_bound(other).unwrap_or_default(),
        Some(quotient) => {
            let numbers = [quotient.ratio].into_iter();
            let numbers = numbers.chain(quotient.ends().into_iter().flatten());
            numbers.map(figure).collect::<Vec<_>>().join(" ")
        }
        None => String::new(),
    };
    let texts: Vec<String> = line.cells.iter().enumerate().map(text).collect();
    texts.join("|")
}

/// Returns a table without bars. `caption` says what the numbers are.
pub(super) fn plain_table(table: &Table, caption: &str) -> Markup {
    // Columns of words are aligned at the left, and their lines may break.
    let has_word = |cell: &String| {
        let mut parts = cell.split(|c: char| !c.is_alphabetic());
        parts.any(|part| part.chars().count() > 3)
    };
    let words = |column: usize| {
        let mut cells = table.rows.iter().filter_map(|row| row.get(column));
        cells.any(has_word)
    };
    let columns = table.header.iter().enumerate();
    let columns: Vec<(&String, bool)> = columns.map(|(i, name)| (name, words(i))).collect();
    html! {
        (scroll_box(caption, &html! {
            table {
                caption { span { (prose(caption)) } }
                thead { tr { @for (name, words) in &columns { th.words[*words] scope="col" { (name) } } } }
                tbody {
                    @for (place, row) in table.rows.iter().enumerate() {
                        tr {
                            @for (column, cell) in row.iter().enumerate() {
                                @if column > 0 { (plain_cell(cell, columns[column].1)) }
                                @else if let Some(part) = table.links.get(place) {
                                    th scope="row" { a href={ "#" (part) } { (cell) } }
                                }
                                @else { th scope="row" { (cell) } }
                            }
                        }
                    }
                }
            }
        }))
    }
}

/// Returns a cell, without a class if it has numbers.
fn plain_cell(cell: &str, has_words: bool) -> Markup {
    let cell = cell.replace(" ×", "\u{a0}×");
    match has_words {
        true => html! { td.words { (cell) } },
        false => html! { td { (cell) } },
    }
}

/// Returns a box that scrolls from side to side if its content is wider than the screen, with a name for screen readers.
fn scroll_box(name: &str, content: &Markup) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label={ "Table: " (name) } { (content) }
    }
}
