//! Tables for papers: ratios, times, memory and meshes, and their form in Markdown.

use std::fmt::Write as _;

use sixfold_results::numbers::{counted, duration, figure as shown, grouped, list, rounded_down};
use sixfold_results::{FEWEST_MESHES, OperationInfo, Pool, Report, ResultRow, Results, Standing};

use crate::figures::facts;
use crate::markdown::escape;
use crate::matrix::{self, Line, Matrix, ends_of_ratios};

/// The largest number of meshes that have a table of their own.
const MAX_MESH_TABLES: usize = 8;

/// A table with a column for each backend, or for each property of a mesh.
pub(super) struct PaperTable {
    /// Name of the table in references, such as `mesh-1`.
    pub(super) label: String,
    pub(super) caption: String,
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<PaperRow>,
}

/// One row of a table, with a cell for each column.
pub(super) struct PaperRow {
    /// The operation, the workload, the table of a structure, or the mesh.
    pub(super) name: String,
    /// Whether there are too few samples to name the fastest.
    pub(super) provisional: bool,
    /// `None` if there is nothing, for example because the backend was not measured.
    pub(super) cells: Vec<Option<Cell>>,
}

impl PaperRow {
    fn new(name: impl Into<String>, cells: Vec<Option<Cell>>) -> Self {
        Self {
            name: name.into(),
            provisional: false,
            cells,
        }
    }
}

/// A number in a table.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) text: String,
    /// The ends of the interval.
    pub(super) interval: Option<[String; 2]>,
    pub(super) kind: Kind,
}

/// What a number is among those of its row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// One of several.
    Plain,
    /// The fastest, or equal to the fastest.
    Best,
    /// Perhaps the fastest.
    Undecided,
    /// A lower bound.
    Bound,
}

impl Cell {
    fn plain(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            interval: None,
            kind: Kind::Plain,
        }
    }

    fn ratio(ratio: f64, interval: Option<[f64; 2]>, kind: Kind) -> Self {
        Self {
            text: shown(ratio),
            // The fastest backend is compared with itself.
            interval: interval
                .filter(|ends| *ends != [1.0; 2])
                .map(|ends| ends.map(shown)),
            kind,
        }
    }

    fn bound(ratio: f64) -> Self {
        Self {
            kind: Kind::Bound,
            ..Self::plain(shown(rounded_down(ratio)))
        }
    }
}

/// What bold, italic and other marks mean.
const MARKS: &str = "Bold: the fastest backend, and backends that are equal to it. Italic: undecided, perhaps the fastest. \
                     ≥: lower bound, because a run would exceed the budget. –: not measured.";

/// Returns what the mark of a provisional row means, if there is one.
fn provisional(rows: &[PaperRow]) -> &'static str {
    match rows.iter().any(|row| row.provisional) {
        true => " †: too few samples to name the fastest.",
        false => "",
    }
}

/// Returns what the captions of a mesh and of workloads state. `confidence` is that of the intervals.
fn reading(confidence: &str, rows: &[PaperRow]) -> String {
    format!(
        "Times relative to the fastest backend of the row, with {confidence} intervals in brackets. {MARKS}{}",
        provisional(rows)
    )
}

/// Returns the tables of the studies, and of the rankings for workloads. Several studies have a table of
/// means; if there are at most [`MAX_MESH_TABLES`] studies, each also has its own table.
pub(super) fn tables(results: &Results) -> Vec<PaperTable> {
    let studies: Vec<&Report> = results.studies().collect();
    let mut tables = Vec::new();
    if studies.len() > 1 {
        tables.push(means(&results.pool(), &studies));
    }
    if studies.len() <= MAX_MESH_TABLES {
        let numbered = studies.iter().enumerate();
        tables.extend(numbered.clone().map(|(i, study)| of_study(study, i + 1)));
        tables.extend(numbered.map(|(i, study)| times(study, i + 1)));
    }
    tables.push(memory(&studies));
    tables.push(meshes(&studies));
    tables.push(of_workloads(results));
    tables.retain(|table| !table.rows.is_empty());
    tables
}

fn holding(study: &Report) -> Vec<String> {
    let holding = study.backends.iter().filter(|backend| backend.holds);
    holding.map(|backend| backend.name.clone()).collect()
}

fn of_study(study: &Report, number: usize) -> PaperTable {
    let columns = holding(study);
    let row = |operation: &OperationInfo| {
        let cells = columns.iter();
        PaperRow {
            provisional: study.is_provisional(&operation.name),
            ..PaperRow::new(
                &operation.name,
                cells
                    .map(|column| cell(study, study.row(&operation.name, column)?))
                    .collect(),
            )
        }
    };
    let rows = with_cells(study.run.operations.iter().map(row));
    PaperTable {
        label: format!("mesh-{number}"),
        caption: format!(
            "{}: {} {}",
            study.mesh.name,
            facts(&study.mesh),
            reading(&study.run.settings.confidence.to_string(), &rows)
        ),
        rows,
        columns,
    }
}

/// Returns the cell of a measured ratio, or of a lower bound.
fn cell(study: &Report, row: &ResultRow) -> Option<Cell> {
    if let Some(ratio) = study.shown_ratio(row) {
        let interval = row.ratio_ci_low.zip(row.ratio_ci_high);
        let kind = match row.standing {
            Some(Standing::Undecided) => Kind::Undecided,
            _ if row.is_fastest() => Kind::Best,
            _ => Kind::Plain,
        };
        return Some(Cell::ratio(ratio, interval.map(|(a, b)| [a, b]), kind));
    }
    let bound = row.median_ns.is_none().then_some(row.estimated_ns?)?;
    let mut rows = study.rows(&row.operation);
    let best = rows.find(|row| row.ratio_to_best == Some(1.0))?.median_ns?;
    // A bound below the time of the fastest shows nothing.
    (bound > best).then(|| Cell::bound(bound / best))
}

/// The units of times in nanoseconds; a unit that ends like another one comes first.
const UNITS: [(&str, f64); 4] = [(" ns", 1.0), (" µs", 1e3), (" ms", 1e6), (" s", 1e9)];

/// Returns the table of the times per element of a study.
fn times(study: &Report, number: usize) -> PaperTable {
    let columns = holding(study);
    let row = |operation: &OperationInfo| {
        let cell = |column: &String| {
            let row = study.row(&operation.name, column)?;
            let each = |ns: f64| Some(ns / row.elements.filter(|&n| n > 0)? as f64);
            let Some(ns) = row.ns_per_element else {
                return Some(Cell {
                    kind: Kind::Bound,
                    ..Cell::plain(duration(rounded_down(each(row.estimated_ns?)?)))
                });
            };
            let ends = row.ci_low_ns.zip(row.ci_high_ns);
            let ends = ends.and_then(|(low, high)| Some([each(low)?, each(high)?]));
            let text = duration(ns);
            // In the unit of the time, which is written once.
            let size = UNITS.into_iter().find(|(unit, _)| text.ends_with(unit))?.1;
            Some(Cell {
                interval: ends.map(|ends| ends.map(|end| shown(end / size))),
                ..Cell::plain(text)
            })
        };
        let unit = study.rows(&operation.name).next().map(|row| &row.per);
        let name = unit.map_or_else(
            || operation.name.clone(),
            |unit| format!("{}, per {unit}", operation.name),
        );
        PaperRow::new(name, columns.iter().map(cell).collect())
    };
    PaperTable {
        label: format!("times-{number}"),
        caption: format!(
            "{}: times per element, with {} intervals in brackets, in the same unit. ≥: lower bound. –: not measured.",
            study.mesh.name, study.run.settings.confidence
        ),
        rows: with_cells(study.run.operations.iter().map(row)),
        columns,
    }
}

/// Returns the table of the bytes per vertex of each backend on each mesh.
fn memory(studies: &[&Report]) -> PaperTable {
    let mut columns: Vec<String> = Vec::new();
    for backend in studies.iter().flat_map(|study| &study.backends) {
        if backend.bytes_per_vertex.is_some() && !columns.contains(&backend.name) {
            columns.push(backend.name.clone());
        }
    }
    let row = |study: &&Report| {
        let bytes = |column: &String| {
            let backend = study
                .backends
                .iter()
                .find(|backend| backend.name == *column)?;
            Some(Cell::plain(shown(backend.bytes_per_vertex?)))
        };
        PaperRow::new(&study.mesh.name, columns.iter().map(bytes).collect())
    };
    PaperTable {
        label: "memory".into(),
        caption: "Bytes of all tables of each backend, with spare capacity, divided by the number of vertices. –: the \
                  backend cannot hold the mesh, or its size is not known."
            .into(),
        rows: with_cells(studies.iter().map(row)),
        columns,
    }
}

/// Returns the table of the meshes.
fn meshes(studies: &[&Report]) -> PaperTable {
    let row = |study: &&Report| {
        let facts = &study.mesh.facts;
        let edges = facts.edges;
        let numbers = [facts.vertices, edges, facts.faces].map(|n| Some(Cell::plain(grouped(n))));
        let closed = if facts.closed { "closed" } else { "boundary" };
        let hash = study.mesh.sha256.get(..8).unwrap_or_default();
        let words = [closed, hash].map(|word| Some(Cell::plain(word)));
        PaperRow::new(&study.mesh.name, numbers.into_iter().chain(words).collect())
    };
    PaperTable {
        label: "meshes".into(),
        caption: "The meshes: their elements, whether they have a boundary, and the first digits of the SHA-256 of their \
                  positions and faces."
            .into(),
        columns: ["vertices", "edges", "faces", "kind", "SHA-256"]
            .map(str::to_owned)
            .to_vec(),
        rows: studies.iter().map(row).collect(),
    }
}

/// Returns the table of the means over the meshes, whose marks are those of the page.
fn means(pool: &Pool, studies: &[&Report]) -> PaperTable {
    let columns = pool.compared.clone();
    let matrix = Matrix::of_pool(pool, studies);
    let row = |line: &Line| {
        let cell = |column: &String| mean(line.cells.iter().find(|cell| cell.backend == *column)?);
        PaperRow {
            provisional: line.provisional,
            ..PaperRow::new(&line.name, columns.iter().map(cell).collect())
        }
    };
    // In the order of the tables of the meshes.
    let operations = pool.all().chunk_by(|a, b| a.operation == b.operation);
    let line_of = |operation: &str| matrix.lines.iter().find(|line| line.name == operation);
    let lines = operations.filter_map(|rows| line_of(&rows[0].operation));
    let rows = with_cells(lines.map(row));
    let meshes = pool.groups.first().map_or(0, |all| all.meshes.len());
    let decided = match meshes < FEWEST_MESHES {
        true => "on every mesh, by more than 5 %".to_owned(),
        false => format!(
            "beyond chance: the {} interval of the mean quotient of both times is above 1",
            matrix.confidence
        ),
    };
    PaperTable {
        label: "means".into(),
        caption: format!(
            "Means over {}. Geometric means over the meshes of the time, relative to the smallest mean of the row; in \
             brackets {}. Each power of ten of the number of faces has the same weight. Bold: the \
             smallest mean, if every other backend is slower {decided}. Italic: undecided, perhaps the smallest mean. ≥: lower bound, because a run on a mesh would exceed the budget. \
             –: not measured.{}",
            counted(meshes, "mesh", "meshes"),
            ends_of_ratios(meshes, matrix.confidence),
            provisional(&rows),
        ),
        rows,
        columns,
    }
}

/// Returns the cell of a mean.
fn mean(cell: &matrix::Cell) -> Option<Cell> {
    let ratio = cell.ratio?;
    let kind = match cell.standing {
        Some(Standing::Undecided) => Kind::Undecided,
        _ if cell.is_best() => Kind::Best,
        _ => Kind::Plain,
    };
    Some(match cell.is_bound() {
        true => Cell::bound(ratio),
        false => Cell::ratio(ratio, cell.interval, kind),
    })
}

/// Returns a table with a row for each ranking of a workload.
fn of_workloads(results: &Results) -> PaperTable {
    let mut columns: Vec<String> = Vec::new();
    for ranked in results.picks().flat_map(|pick| &pick.ranking) {
        if !columns.contains(&ranked.backend) {
            columns.push(ranked.backend.clone());
        }
    }
    let rows = results.picks().map(|pick| {
        let meshes: Vec<&str> = pick.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
        let tied = pick.ranking.iter().filter(|ranked| ranked.tied_with_best);
        let tied = tied.count();
        let cell = |column: &String| {
            let ranked = pick
                .ranking
                .iter()
                .find(|ranked| ranked.backend == *column)?;
            let interval = ranked.ci_low.zip(ranked.ci_high).map(|(a, b)| [a, b]);
            let kind = match ranked.tied_with_best {
                _ if pick.preliminary => Kind::Plain,
                // The fastest is tied with itself.
                true if tied > 1 => Kind::Undecided,
                true => Kind::Best,
                false => Kind::Plain,
            };
            Some(match ranked.estimated {
                true => Cell::bound(ranked.ratio_to_best),
                false => Cell::ratio(ranked.ratio_to_best, interval, kind),
            })
        };
        PaperRow {
            provisional: pick.preliminary,
            ..PaperRow::new(
                format!("{} on {}", pick.workload.name, meshes.join(", ")),
                columns.iter().map(cell).collect(),
            )
        }
    });
    let rows = with_cells(rows);
    let mut confidences: Vec<String> = Vec::new();
    for pick in results.picks() {
        let confidence = pick.run.settings.confidence.to_string();
        if !confidences.contains(&confidence) {
            confidences.push(confidence);
        }
    }
    PaperTable {
        label: "workloads".into(),
        caption: format!("Workloads. {}", reading(&list(confidences), &rows)),
        rows,
        columns: columns.clone(),
    }
}

/// Returns the rows with at least one cell.
fn with_cells(rows: impl Iterator<Item = PaperRow>) -> Vec<PaperRow> {
    rows.filter(|row| row.cells.iter().any(Option::is_some))
        .collect()
}

/// Returns the tables as Markdown.
pub(super) fn markdown(tables: &[PaperTable]) -> String {
    let mut text = "# Results\n".to_owned();
    if tables.is_empty() {
        text.push_str("\nThe results have no times that are compared.\n");
    }
    for table in tables {
        let _ = writeln!(text, "\n{}\n", escape(&table.caption));
        let names: Vec<String> = table.columns.iter().map(|name| escape(name)).collect();
        let _ = writeln!(text, "|  | {} |", names.join(" | "));
        let _ = writeln!(text, "|---|{}", "---:|".repeat(names.len()));
        for row in &table.rows {
            let cells: Vec<String> = row.cells.iter().map(markdown_cell).collect();
            let mark = if row.provisional { " †" } else { "" };
            let _ = writeln!(
                text,
                "| {}{mark} | {} |",
                escape(&row.name),
                cells.join(" | ")
            );
        }
    }
    text
}

fn markdown_cell(cell: &Option<Cell>) -> String {
    let Some(cell) = cell else {
        return "–".into();
    };
    let interval = cell.interval.as_ref();
    let interval = interval.map_or_else(String::new, |[low, high]| format!(" [{low}, {high}]"));
    let text = &cell.text;
    match cell.kind {
        Kind::Bound => format!("≥ {text}"),
        Kind::Best => format!("**{text}**{interval}"),
        Kind::Undecided => format!("*{text}*{interval}"),
        Kind::Plain => format!("{text}{interval}"),
    }
}
