//! What each structure holds, table by table, stacked.

use kuva::plot::BarPlot;
use kuva::render::plots::Plot;
use study::Report;
use study::numbers::grouped;

use crate::colours::of_table;
use crate::figure::{Figure, Table, drawn, laid_out};

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
    // By name, for the tables of one name have one colour; most have few in common.
    let mut names: Vec<&str> = Vec::new();
    for table in columns.iter().flat_map(|column| &column.tables) {
        if table.bytes > 0 && !names.contains(&&*table.table) {
            names.push(&table.table);
        }
    }
    let mut table = Table::new(["", "table", "rows", "bytes", "bytes a vertex"]);
    let mut plot = BarPlot::new();
    let mut titles = Vec::new();
    for column in &columns {
        let mut parts = Vec::new();
        for (number, name) in names.iter().enumerate() {
            let part = column.tables.iter().find(|part| part.table == *name);
            let bytes = part.map_or(0, |part| part.bytes);
            let each = bytes as f64 / vertices as f64;
            parts.push((each, of_table(number)));
            titles.push(format!("{}, {name}: {each:.1} bytes a vertex", column.name));
            if let Some(part) = part.filter(|part| part.bytes > 0) {
                let [rows, bytes] = [part.rows, part.bytes].map(grouped);
                table.row(vec![
                    column.name.clone(),
                    (*name).into(),
                    rows,
                    bytes,
                    format!("{each:.1}"),
                ]);
            }
        }
        plot = plot.with_group(column.name.clone(), parts);
    }
    let plot = plot
        .with_stacked()
        .with_legend(names)
        .with_tooltip_labels(titles);
    let plots = vec![Plot::Bar(plot)];
    let title = format!("Bytes for each vertex, table by table: {}", study.mesh.name);
    let layout = laid_out(&plots, 820.0, 420.0)
        .with_y_label("bytes a vertex")
        .with_clamp_y_axis();
    Some(Figure {
        id: format!("{of}memory"),
        svg: drawn(&title, plots, layout),
        title,
        caption: "What is really held, positions and spare room included.".into(),
        table,
        command: command.into(),
    })
}
