//! The tables of `sixfold why`: one per relation with a row per backend, or one with a row per relation if
//! there is only one backend.

use sixfold_results::numbers::{figure, grouped};
use sixfold_results::{BufferSpeed, Model, TableReads, Timed, Why, WhyRow};

use crate::column_table::{Column, column_table, short_figure};
use crate::text::hanging_indent;

/// Returns the table of the speed of memory.
pub(crate) fn memory_text(buffers: &[BufferSpeed]) -> String {
    let size = |buffer: &BufferSpeed| match buffer.bytes >> 10 {
        kib if kib < 1024 => format!("{kib} KiB"),
        kib => format!("{} MiB", kib >> 10),
    };
    let names = ["GB/s", "latency ns"].map(str::to_owned);
    let columns = buffers.iter().map(|buffer| {
        let figures = [buffer.gb_per_s, buffer.latency_ns].map(figure);
        Column::figures(&size(buffer), figures)
    });
    let columns: Vec<Column> = columns.collect();
    column_table(&Column::words("memory", names), &columns)
}

/// Returns the table of one relation, with a row per backend. If the rows have several relations of one
/// backend, each row is a relation. If `detailed` is set, a second table has the jumps, the moved bytes and
/// the reads of each table.
pub(crate) fn rows_text(rows: &[WhyRow], timed: bool, detailed: bool) -> String {
    let Some(first) = rows.first() else {
        return String::new();
    };
    let relation = |row: &WhyRow| row.reads.relation.name().to_owned();
    let backend = |row: &WhyRow| row.backend.clone();
    let is_one_relation = rows.iter().all(|row| relation(row) == relation(first));
    let (head, name): (String, &dyn Fn(&WhyRow) -> String) = match is_one_relation {
        true => (relation(first), &backend),
        false => (backend(first), &relation),
    };
    let names = rows.iter().map(|row| match row.reads.sampled {
        true => format!("{} ~", name(row)),
        false => name(row),
    });
    let names = Column::words(&head, names);
    let counts = |head: &str, count: &dyn Fn(&WhyRow) -> f64| {
        Column::figures(head, rows.iter().map(|row| short_figure(count(row))))
    };
    let mut columns = vec![
        counts("reads", &|row| row.reads.reads),
        counts("lines", &|row| row.reads.lines),
        counts("bytes", &|row| row.reads.bytes),
    ];
    let mut sweep = vec![
        counts("jumps", &|row| row.reads.jumps),
        counts("moved", &|row| row.reads.moved_bytes),
    ];
    if timed {
        columns.extend(time_columns(rows));
    } else {
        columns.append(&mut sweep);
    }
    let mut text = column_table(&names, &columns);
    if detailed {
        let by_table = rows.iter().map(|row| by_table(&row.reads.tables));
        sweep.push(Column::words("reads by table", by_table));
        text += "\n\n";
        text += &column_table(&names, &sweep);
    }
    text
}

/// Returns the columns of a table with times.
fn time_columns(rows: &[WhyRow]) -> [Column; 4] {
    let cells = |cell: &dyn Fn(&Timed) -> String| {
        let cells = rows.iter().map(|row| row.timed.as_ref());
        let cells = cells.map(|timed| timed.map_or("–".to_owned(), cell));
        cells.collect::<Vec<_>>()
    };
    let measured = |timed: &Timed| {
        let sign = if timed.sampled { "~" } else { "" };
        format!("{sign}{}", short_figure(timed.ns_per_element))
    };
    [
        Column::figures("floor", cells(&|timed| short_figure(timed.floor_ns))),
        Column::figures("waits", cells(&|timed| short_figure(timed.waits_ns))),
        Column::figures("measured", cells(&measured)),
        Column::words("bound by", cells(&|timed| timed.bound.name().to_owned())),
    ]
}

/// Formats reads as `halves 6.00, leaving 1.00`. The table with the most reads comes first.
fn by_table(tables: &[TableReads]) -> String {
    if tables.is_empty() {
        return "none: the handle is the answer".into();
    }
    let mut tables: Vec<&TableReads> = tables.iter().collect();
    tables.sort_by(|a, b| b.reads.total_cmp(&a.reads));
    let reads = |table: &&TableReads| format!("{} {}", table.table, short_figure(table.reads));
    tables.iter().map(reads).collect::<Vec<_>>().join(", ")
}

/// Returns the meanings of the columns and signs that the tables have.
pub(crate) fn legend(why: &Why, detailed: bool) -> String {
    let Model {
        line_bytes,
        cache_lines,
        reach,
        sample,
        ..
    } = why.model;
    let timed = why.memory.is_some();
    let has_sweep = !timed || detailed;
    let jump = format!(
        "a cache line that a prefetcher cannot predict: none of the last {} lines that the sweep \
         fetched is within {reach} lines of it",
        grouped(cache_lines as usize)
    );
    let mut lines = vec![
        (
            "reads",
            "table rows that a query reads, each as often as it is read (a mean, like all figures)"
                .to_owned(),
        ),
        (
            "lines",
            format!("cache lines of {line_bytes} bytes that a query touches"),
        ),
        (
            "bytes",
            "bytes that a query reads; each byte counts once".to_owned(),
        ),
    ];
    if has_sweep {
        lines.push((
            "jumps",
            format!("jumps per element in a sweep over all elements in order. A jump is {jump}."),
        ));
        lines.push((
            "moved",
            "bytes per element that a sweep moves from memory at least: each line counts once"
                .to_owned(),
        ));
    }
    if detailed {
        lines.push(("by table", "reads of a query in each table".to_owned()));
    }
    if timed {
        let waits = match has_sweep {
            true => "ns per element if each jump waits for the previous jump".to_owned(),
            false => {
                format!("ns per element if each jump waits for the previous one; a jump is {jump}")
            }
        };
        let measured = match why.run.settings.launches {
            None => "median time of the sweep".to_owned(),
            Some(launches) => format!("time of the sweep, the mean over {launches} launches,"),
        };
        lines.extend([
            (
                "floor",
                "ns per element to move the lines of a sweep over all elements from memory, each \
                 line once; the speed is that of the largest buffer that is not larger than these \
                 lines together"
                    .to_owned(),
            ),
            ("waits", waits),
            (
                "measured",
                format!("{measured} in ns per element; ~ if measured on a sample"),
            ),
            (
                "bound by",
                "bandwidth: floor is at least half of the measured time; latency: waits is, but \
                 not floor; work: neither, so most of the time is spent on nearby data"
                    .to_owned(),
            ),
        ]);
    }
    if why.rows.iter().any(|row| row.reads.sampled) {
        lines.push((
            "~",
            format!(
                "only {sample} evenly spaced elements are queried; the lines of each query are \
                 counted separately"
            ),
        ));
    }
    let lines = lines
        .into_iter()
        .map(|(name, meaning)| hanging_indent(&format!("{name:<10}"), &meaning));
    let mut lines: Vec<String> = lines.collect();
    let listing = match timed {
        true => {
            "Sweeps include the iteration over the elements. If a structure has no table of edges, \
             a list of edges is prepared first; only the measured time includes this. `sixfold \
             operations` describes the relations."
        }
        false => {
            "Sweeps include the iteration over the elements. `sixfold operations` describes the \
             relations."
        }
    };
    lines.push(hanging_indent("", listing));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_read_table_comes_first() {
        let read = |table: &str, reads| TableReads {
            table: table.into(),
            row_bytes: 4,
            reads,
        };
        let text = by_table(&[read("leaving", 1.0), read("halves", 6.0)]);
        assert_eq!(text, "halves 6.00, leaving 1.00");
        assert_eq!(by_table(&[]), "none: the handle is the answer");
    }
}
