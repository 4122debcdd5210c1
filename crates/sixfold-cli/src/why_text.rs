//! The tables of `sixfold why`, one per relation, with a row per backend.

use comfy_table::{Cell, CellAlignment};
use sixfold::Relation;
use sixfold_study::{Bound, BufferSpeed, Model, TableReads, Timed, Why, WhyRow};

use crate::tables::table;
use crate::text::{hanging_indent, wrap};
use sixfold_study::numbers::{bytes, figure, grouped};

/// Width of the column `reads by table`, in characters.
const TABLES_WIDTH: usize = 36;
/// A space that does not allow a line break.
const NO_BREAK: char = '\u{a0}';

fn meaning(relation: Relation) -> &'static str {
    match relation {
        Relation::VertexVertices => "the other ends of the edges at a vertex",
        Relation::VertexEdges => "the edges that end at a vertex",
        Relation::VertexFaces => "the faces with a corner at a vertex",
        Relation::EdgeVertices => "the two ends of an edge",
        Relation::EdgeEdges => "the edges that share an end with an edge",
        Relation::EdgeFaces => "the faces along an edge",
        Relation::FaceVertices => "the corners of a face",
        Relation::FaceEdges => "the sides of a face",
        Relation::FaceFaces => "the faces that share an edge with a face",
    }
}

pub(crate) fn memory_text(buffers: &[BufferSpeed]) -> String {
    let line = |name: &str, what: &str, of: &dyn Fn(&BufferSpeed) -> String| {
        let figures: String = buffers
            .iter()
            .map(|buffer| format!("{:>9}", of(buffer)))
            .collect();
        format!("{name:<13}{what:<10}{figures}")
    };
    let size = |buffer: &BufferSpeed| match buffer.bytes >> 10 {
        kib if kib < 1024 => format!("{kib} KiB"),
        kib => format!("{} MiB", kib >> 10),
    };
    [
        line("memory", "buffer of", &size),
        line("", "GB/s", &|buffer| figure(buffer.gb_per_s)),
        line("", "latency ns", &|buffer| figure(buffer.latency_ns)),
    ]
    .join("\n")
}

/// Returns the table of one relation, with times or with the tables that are read.
pub(crate) fn relation_text(rows: &[WhyRow], timed: bool) -> String {
    let Some(first) = rows.first() else {
        return String::new();
    };
    let relation = first.reads.relation;
    let heads = ["answers", "reads", "lines", "bytes", "jumps", "moved"];
    let more: &[&str] = match timed {
        true => &["floor", "waits", "measured", "bound by"],
        false => &["reads by table"],
    };
    let heads = ["per query:"].iter().chain(&heads).chain(more);
    let mut block = table(heads.map(Cell::new).collect());
    for row in rows {
        block.add_row(cells(row, timed));
    }
    let columns = 1 + 6 + more.len();
    for column in 0..columns {
        let Some(column_of) = block.column_mut(column) else {
            continue;
        };
        let is_word = column == 0 || column + 1 == columns;
        column_of.set_padding(if column == 0 { (0, 0) } else { (1, 0) });
        if !is_word {
            column_of.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines = block.trim_fmt();
    format!("{relation}: {}\n{lines}", meaning(relation))
}

fn cells(row: &WhyRow, timed: bool) -> Vec<Cell> {
    let reads = &row.reads;
    let sign = if reads.sampled { " ~" } else { "" };
    let mut cells = vec![format!("{}{sign}", row.backend)];
    let counts = [
        reads.answers,
        reads.reads,
        reads.lines,
        reads.bytes,
        reads.jumps,
        reads.moved_bytes,
    ];
    cells.extend(counts.map(short_figure));
    match (timed, &row.timed) {
        (false, _) => cells.push(by_table(&reads.tables)),
        (true, None) => cells.extend(["–"; 4].map(str::to_owned)),
        (true, Some(timed)) => cells.extend([
            short_figure(timed.floor_ns),
            short_figure(timed.waits_ns),
            format!(
                "{}{}",
                if timed.sampled { "~" } else { "" },
                short_figure(timed.ns_per_element)
            ),
            timed.bound.name().to_owned(),
        ]),
    }
    cells.into_iter().map(Cell::new).collect()
}

/// Formats reads as `halves 6.00, leaving 1.00`. The table with the most reads comes first.
fn by_table(tables: &[TableReads]) -> String {
    if tables.is_empty() {
        return "none: the handle is the answer".into();
    }
    let mut tables: Vec<&TableReads> = tables.iter().collect();
    tables.sort_by(|a, b| b.reads.total_cmp(&a.reads));
    let tables = tables
        .iter()
        .map(|table| format!("{}{NO_BREAK}{}", table.table, short_figure(table.reads)));
    let tables = tables.collect::<Vec<_>>().join(", ");
    let lines = wrap(&tables, TABLES_WIDTH).join("\n");
    lines.replace(NO_BREAK, " ")
}

/// Formats a number in at most five characters: `0`, `<.001`, `0.052`, `7.00`, `60.5k`, `3.63M`.
fn short_figure(number: f64) -> String {
    match number {
        0.0 => "0".into(),
        n if n < 0.000_5 => "<.001".into(),
        n if n < 999.5 => figure(n),
        n if n < 999.5e3 => format!("{}k", figure(n / 1e3)),
        n if n < 999.5e6 => format!("{}M", figure(n / 1e6)),
        n => format!("{}G", figure(n / 1e9)),
    }
}

pub(crate) fn sentence(row: &WhyRow) -> String {
    let WhyRow {
        backend,
        per,
        reads,
        timed,
    } = row;
    let mut text = format!("{backend}: ");
    text += &match reads.reads {
        0.0 => "a query reads nothing".into(),
        number => format!(
            "a query makes {} reads in {} cache lines, and reads {} bytes",
            short_figure(number),
            short_figure(reads.lines),
            short_figure(reads.bytes)
        ),
    };
    if reads.sampled {
        text += &format!(" (mean of {} queries)", reads.queried);
    }
    let swept = bytes(reads.sweep_bytes());
    text += &match reads.moved_bytes {
        0.0 => ". A sweep over all elements also reads nothing.".into(),
        moved => format!(
            ". A sweep over all elements touches {swept} and moves {} bytes per {per}.",
            short_figure(moved)
        ),
    };
    match timed {
        None => text,
        Some(timed) => text + &describe_times(timed),
    }
}

/// Describes the measured time and its limiting factor.
fn describe_times(timed: &Timed) -> String {
    let Timed {
        ns_per_element,
        speed,
        floor_ns,
        waits_ns,
        bound,
        ..
    } = timed;
    let (measured, floor, waits) = (
        short_figure(*ns_per_element),
        short_figure(*floor_ns),
        short_figure(*waits_ns),
    );
    let speed = short_figure(speed.gb_per_s);
    let verdict = match bound {
        Bound::Bandwidth => "bound by memory bandwidth",
        Bound::Latency => "bound by the latency of lines that cannot be prefetched",
        Bound::Work => "bound by the work of the query itself, not by memory",
    };
    format!(
        " At {speed} GB/s, moving the bytes of one element takes {floor} ns. Waiting for its jumps \
         takes {waits} ns. The measured time is {measured} ns and is {verdict}."
    )
}

/// The columns of a table with times, and their meaning.
const TIMED: [(&str, &str); 4] = [
    (
        "floor",
        "ns per element to read the bytes of `moved` sequentially. The speed is that of the \
         largest measured buffer that is not larger than the memory that the sweep touches.",
    ),
    (
        "waits",
        "ns per element for the jumps, if each jump waits for the previous jump. The latency \
         is that of the buffer that is used for `floor`.",
    ),
    (
        "measured",
        "time of the sweep in ns per element, median; ~ if measured on a sample",
    ),
    (
        "bound by",
        "bandwidth: `floor` is at least half of the measured time. latency: `floor` is less, \
         but `waits` is at least half of the measured time. work: `floor` and `waits` are both \
         less than half; most of the time is spent on reading nearby data, comparing and \
         branching.",
    ),
];

pub(crate) fn legend(why: &Why) -> String {
    let Model {
        line_bytes,
        cache_lines,
        reach,
        sample,
        ..
    } = why.model;
    let first = [
        (
            "answers",
            "number of elements that a query returns; all figures are means over all queries",
        ),
        (
            "reads",
            "number of table rows that a query reads; a row that is read twice counts twice",
        ),
        (
            "lines",
            &format!(
                "number of cache lines of {line_bytes} bytes that a query touches; each line \
                 counts once"
            ),
        ),
        (
            "bytes",
            "number of bytes that a query reads; each byte counts once",
        ),
        (
            "jumps",
            &format!(
                "number of lines per element that a prefetcher cannot predict, in a sweep over all \
                 elements in order. A fetched line is a jump if none of the last {} fetched lines \
                 is within {reach} lines of this line.",
                grouped(cache_lines as usize)
            ),
        ),
        (
            "moved",
            "minimum number of bytes per element that a sweep moves from memory: each line of the \
             sweep counts once. In a row with ~, the lines of each query are counted separately.",
        ),
    ];
    let counted = [("by table", "number of reads of a query in each table")];
    let listing = match why.memory.is_some() {
        true => {
            "The figures `jumps`, `moved` and `measured` include the iteration over the elements. \
             If a structure has no table of edges, a list of edges is prepared first. Only \
             `measured` includes this preparation."
        }
        false => "The figures `jumps` and `moved` include the iteration over the elements.",
    };
    let last = [
        (
            "~",
            &*format!("only {sample} evenly spaced elements are queried, not all elements"),
        ),
        ("", listing),
    ];
    let second: &[(&str, &str)] = if why.memory.is_some() {
        &TIMED
    } else {
        &counted
    };
    let lines = first.iter().chain(second).chain(&last);
    let lines = lines.map(|(name, meaning)| hanging_indent(&format!("{name:<10}"), meaning));
    lines.collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_five_characters() {
        let numbers = [
            0.0, 0.0004, 0.0521, 7.0, 999.4, 999.6, 60_480.0, 999_600.0, 3.63e6, 2e9,
        ];
        let expected = [
            "0", "<.001", "0.052", "7.00", "999", "1.00k", "60.5k", "1.00M", "3.63M", "2.00G",
        ];
        assert_eq!(numbers.map(short_figure), expected);
        assert!(numbers.map(short_figure).iter().all(|text| text.len() <= 5));
    }

    #[test]
    fn the_most_read_table_comes_first() {
        let read = |table: &str, reads| TableReads {
            table: table.into(),
            row_bytes: 4,
            reads,
        };
        let text = by_table(&[read("leaving", 1.0), read("halves", 6.0)]);
        assert_eq!(text, "halves 6.00, leaving 1.00");
        // No line ends between a table name and its figure.
        let many = ["vertex", "opposite", "corner"].map(|table| read(table, 1.0));
        let text = by_table(&many);
        assert_eq!(text, "vertex 1.00, opposite 1.00,\ncorner 1.00");
        assert_eq!(by_table(&[]), "none: the handle is the answer");
    }
}
