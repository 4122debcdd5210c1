//! What each structure holds, table by table, stacked.

use kuva::plot::BarPlot;
use kuva::render::plots::Plot;
use study::Report;
use study::numbers::grouped;

use crate::colours::of_table;
use crate::figure::{Figure, Table, drawn, laid_out};

/// The table that all have, but for who has points in the place of vertices.
const POSITIONS: &str = "positions";

/// Bytes for each vertex, by table.
pub(super) fn of_study(study: &Report, of: &str, command: &str) -> Option<Figure> {
    let columns = study
        .backends
        .iter()
        .filter(|column| !column.tables.is_empty());
    let columns: Vec<_> = columns.collect();
    let vertices = study.mesh.facts.vertices;
    if columns.is_empty() || vertices == 0 {
        return None;
    }
    let mut table = Table::new(["", "table", "rows", "bytes", "bytes a vertex"]);
    let mut plot = BarPlot::new();
    let mut titles = Vec::new();
    for column in &columns {
        let mut parts = Vec::new();
        // Positions at the bottom, in one colour everywhere; the others as the structure has them.
        let mut tables: Vec<_> = column.tables.iter().collect();
        tables.sort_by_key(|part| part.table != POSITIONS);
        let first = usize::from(tables.first().is_none_or(|part| part.table != POSITIONS));
        for (number, part) in tables.iter().enumerate() {
            let each = part.bytes as f64 / vertices as f64;
            parts.push((each, of_table(first + number)));
            titles.push(format!(
                "{}, {}: {each:.1} bytes a vertex",
                column.name, part.table
            ));
            let [rows, bytes] = [part.rows, part.bytes].map(grouped);
            let name = part.table.to_string();
            table.row(vec![
                column.name.clone(),
                name,
                rows,
                bytes,
                format!("{each:.1}"),
            ]);
        }
        plot = plot.with_group(column.name.clone(), parts);
    }
    // Without the first, the groups of the marks would stay open.
    let plot = plot.with_tooltips().with_tooltip_labels(titles);
    let plot = plot.with_stacked();
    let plots = vec![Plot::Bar(plot)];
    let title = format!("Bytes for each vertex, table by table: {}", study.mesh.name);
    let layout = laid_out(&plots, 820.0, 420.0)
        .with_y_label("bytes a vertex")
        .with_clamp_y_axis();
    Some(Figure {
        id: format!("{of}memory"),
        svg: drawn(&title, plots, layout),
        title,
        caption: "What is really held, spare room included: positions at the bottom, in one colour everywhere, and the \
             other tables of each structure above; pointing at one names it."
            .into(),
        table,
        command: command.into(),
    })
}
