//! Tables of ratios for papers, and their form in Markdown.

use std::fmt::Write as _;

use sixfold_results::numbers::{counted, figure as shown, list, rounded_down};
use sixfold_results::{Confidence, OperationInfo, Pool, Pooled, Report, ResultRow, Results};

use crate::figures::facts;
use crate::markdown::escape;

/// The largest number of meshes that have a table of their own.
const MAX_MESH_TABLES: usize = 8;

/// A table of the times of backends relative to the fastest backend of each row.
pub(super) struct RatioTable {
    /// Name of the table in references, such as `mesh-1`.
    pub(super) label: String,
    pub(super) caption: String,
    /// The names of the backends.
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<RatioRow>,
}

/// One row of a table, with a cell for each column.
pub(super) struct RatioRow {
    /// The operation or the workload.
    pub(super) name: String,
    /// `None` if the backend was not measured.
    pub(super) cells: Vec<Option<Cell>>,
}

/// A ratio to the fastest backend.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) ratio: String,
    /// The ends of the interval.
    pub(super) interval: Option<[String; 2]>,
    /// Whether the ratio is a lower bound.
    pub(super) bound: bool,
    /// Whether the backend is the fastest, or shares the first place.
    pub(super) best: bool,
}

impl Cell {
    fn new(ratio: f64, interval: Option<[f64; 2]>, best: bool) -> Self {
        Self {
            ratio: shown(ratio),
            // The fastest backend is compared with itself.
            interval: interval
                .filter(|ends| *ends != [1.0; 2])
                .map(|ends| ends.map(shown)),
            bound: false,
            best,
        }
    }

    fn bound(ratio: f64) -> Self {
        Self {
            ratio: shown(rounded_down(ratio)),
            interval: None,
            bound: true,
            best: false,
        }
    }
}

/// Returns what the captions of a mesh and of workloads state. `confidence` is that of the intervals.
fn reading(confidence: &str) -> String {
    format!(
        "Times relative to the fastest backend of the row, with {confidence} intervals in brackets. Bold: the fastest \
         backend, and backends that are equal to it or undecided. ≥: lower bound, because a run would exceed the budget. \
         –: not measured."
    )
}

/// Returns the tables of the studies, and of the rankings for workloads. Several studies have a table of
/// means; if there are at most [`MAX_MESH_TABLES`] studies, each also has its own table.
pub(super) fn tables(results: &Results) -> Vec<RatioTable> {
    let studies: Vec<&Report> = results.studies().collect();
    let mut tables = Vec::new();
    if studies.len() > 1 {
        tables.push(means(&results.pool(), studies[0].run.settings.confidence));
    }
    if studies.len() <= MAX_MESH_TABLES {
        let numbered = studies.iter().enumerate();
        tables.extend(numbered.map(|(i, study)| of_study(study, i + 1)));
    }
    tables.push(of_workloads(results));
    tables.retain(|table| !table.rows.is_empty());
    tables
}

fn of_study(study: &Report, number: usize) -> RatioTable {
    let columns = study.backends.iter().filter(|backend| backend.holds);
    let columns: Vec<String> = columns.map(|backend| backend.name.clone()).collect();
    let row = |operation: &OperationInfo| RatioRow {
        name: operation.name.clone(),
        cells: columns
            .iter()
            .map(|column| cell(study, study.row(&operation.name, column)?))
            .collect(),
    };
    RatioTable {
        label: format!("mesh-{number}"),
        caption: format!(
            "{}: {} {}",
            study.mesh.name,
            facts(&study.mesh),
            reading(&study.run.settings.confidence.to_string())
        ),
        rows: with_cells(study.run.operations.iter().map(row)),
        columns,
    }
}

/// Returns the cell of a measured ratio, or of a lower bound.
fn cell(study: &Report, row: &ResultRow) -> Option<Cell> {
    if let Some(ratio) = study.shown_ratio(row) {
        let interval = row.ratio_ci_low.zip(row.ratio_ci_high);
        return Some(Cell::new(
            ratio,
            interval.map(|(a, b)| [a, b]),
            row.is_fastest(),
        ));
    }
    let bound = row.median_ns.is_none().then_some(row.estimated_ns?)?;
    let mut rows = study.rows(&row.operation);
    let best = rows.find(|row| row.ratio_to_best == Some(1.0))?.median_ns?;
    // A bound below the time of the fastest shows nothing.
    (bound > best).then(|| Cell::bound(bound / best))
}

fn means(pool: &Pool, confidence: Confidence) -> RatioTable {
    let columns = pool.compared.clone();
    let row = |rows: &[Pooled]| {
        let measured = rows.iter().filter(|row| row.estimated == 0);
        let smallest = measured
            .map(|row| row.ratio_to_best)
            .fold(f64::INFINITY, f64::min);
        let cell = |column: &String| {
            let row = rows.iter().find(|row| row.backend == *column)?;
            let interval = row.ci_low.zip(row.ci_high).map(|(a, b)| [a, b]);
            Some(match row.estimated {
                0 => Cell::new(row.ratio_to_best, interval, row.ratio_to_best == smallest),
                _ => Cell::bound(row.ratio_to_best),
            })
        };
        RatioRow {
            name: rows[0].operation.clone(),
            cells: columns.iter().map(cell).collect(),
        }
    };
    let meshes = pool.groups.first().map_or(0, |all| all.meshes.len());
    RatioTable {
        label: "means".into(),
        caption: format!(
            "Means over {}. Geometric means over the meshes of the time relative to the fastest backend of the mesh, with \
             {confidence} intervals in brackets. Bold: the smallest mean. ≥: lower bound, because a run on a mesh would \
             exceed the budget. –: not measured.",
            counted(meshes, "mesh", "meshes")
        ),
        rows: with_cells(
            pool.all()
                .chunk_by(|a, b| a.operation == b.operation)
                .map(row),
        ),
        columns,
    }
}

/// Returns a table with a row for each ranking of a workload.
fn of_workloads(results: &Results) -> RatioTable {
    let mut columns: Vec<String> = Vec::new();
    for ranked in results.picks().flat_map(|pick| &pick.ranking) {
        if !columns.contains(&ranked.backend) {
            columns.push(ranked.backend.clone());
        }
    }
    let rows = results.picks().map(|pick| {
        let meshes: Vec<&str> = pick.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
        let cell = |column: &String| {
            let ranked = pick
                .ranking
                .iter()
                .find(|ranked| ranked.backend == *column)?;
            let interval = ranked.ci_low.zip(ranked.ci_high).map(|(a, b)| [a, b]);
            let best = ranked.ratio_to_best == 1.0 || ranked.tied_with_best;
            Some(match ranked.estimated {
                true => Cell::bound(ranked.ratio_to_best),
                false => Cell::new(ranked.ratio_to_best, interval, best),
            })
        };
        RatioRow {
            name: format!("{} on {}", pick.workload.name, meshes.join(", ")),
            cells: columns.iter().map(cell).collect(),
        }
    });
    let mut confidences: Vec<String> = Vec::new();
    for pick in results.picks() {
        let confidence = pick.run.settings.confidence.to_string();
        if !confidences.contains(&confidence) {
            confidences.push(confidence);
        }
    }
    RatioTable {
        label: "workloads".into(),
        caption: format!("Workloads. {}", reading(&list(confidences))),
        rows: with_cells(rows),
        columns: columns.clone(),
    }
}

/// Returns the rows with at least one cell.
fn with_cells(rows: impl Iterator<Item = RatioRow>) -> Vec<RatioRow> {
    rows.filter(|row| row.cells.iter().any(Option::is_some))
        .collect()
}

/// Returns the tables as Markdown.
pub(super) fn markdown(tables: &[RatioTable]) -> String {
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
            let _ = writeln!(text, "| {} | {} |", escape(&row.name), cells.join(" | "));
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
    match (cell.bound, cell.best) {
        (true, _) => format!("≥ {}", cell.ratio),
        (false, true) => format!("**{}**{interval}", cell.ratio),
        (false, false) => format!("{}{interval}", cell.ratio),
    }
}
