//! A figure with one stacked bar for each structure. The parts of a bar are the bytes of the tables
//! of the structure.

use kuva::plot::BarPlot;
use kuva::render::plots::Plot;
use sixfold_study::Report;
use sixfold_study::numbers::grouped;

use crate::colours::table_colour;
use crate::data::rows as data;
use crate::figure::{Figure, Table, base_layout, picture};

/// Name of the table of positions. A structure with points instead of vertices has no such table.
const POSITIONS: &str = "positions";

pub(super) fn from_study(study: &Report, id_prefix: &str, command: &str) -> Option<Figure> {
    let columns = study
        .backends
        .iter()
        .filter(|column| !column.tables.is_empty());
    let columns: Vec<_> = columns.collect();
    let vertices = study.mesh.facts.vertices;
    if columns.is_empty() || vertices == 0 {
        return None;
    }
    let mut table = Table::new(["", "table", "rows", "bytes", "bytes per vertex"]);
    let mut plot = BarPlot::new();
    let mut titles = Vec::new();
    for column in &columns {
        let mut parts = Vec::new();
        // Positions come first, in the same colour for all structures.
        let mut tables: Vec<_> = column.tables.iter().collect();
        tables.sort_by_key(|part| part.table != POSITIONS);
        let first = usize::from(tables.first().is_none_or(|part| part.table != POSITIONS));
        for (number, part) in tables.iter().enumerate() {
            let each = part.bytes as f64 / vertices as f64;
            parts.push((each, table_colour(first + number)));
            titles.push(format!(
                "{}, {}: {each:.1} bytes per vertex",
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
    // Without `with_tooltips`, the SVG groups of the marks are not closed.
    let plot = plot.with_tooltips().with_tooltip_labels(titles);
    let plot = plot.with_stacked();
    let plots = vec![Plot::Bar(plot)];
    let title = format!("Bytes per vertex of each table: {}", study.mesh.name);
    let layout = base_layout(&plots, 820.0, 420.0)
        .with_y_label("bytes per vertex")
        .with_clamp_y_axis();
    Some(Figure {
        id: format!("{id_prefix}memory"),
        picture: picture(&title, plots, layout),
        title,
        caption: "Bytes held, including spare capacity. Positions are at the bottom, in one colour for all structures; \
             the other tables of each structure are above. Point at a part to see its name."
            .into(),
        table,
        data: data::memory(study),
        command: command.into(),
    })
}
