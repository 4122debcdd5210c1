//! The heat map: all structures and operations in one figure.

use std::sync::Arc;

use kuva::plot::{ColorMap, Heatmap};
use kuva::render::plots::Plot;
use sixfold_study::numbers::{counted, times};
use sixfold_study::{Operation, Pool, Report, Run};

use super::marked;
use crate::colours::GRID_COLOUR;
use crate::data::{FigureData, rows as data};
use crate::figure::{Figure, Table, base_layout, picture, ratio_ticks};

/// Maximum ratio with its own colour. Larger ratios have the colour of this ratio.
const MAX_RATIO: f64 = 1000.0;

pub(super) fn from_study(study: &Report, id_prefix: &str, command: &str) -> Option<Figure> {
    let columns = study.backends.iter().filter(|column| column.holds);
    let columns: Vec<&str> = columns.map(|column| column.name.as_str()).collect();
    let ratio = |operation: Operation, column: &str| {
        let mut rows = study.rows(operation);
        let ratio = study.shown_ratio(rows.find(|row| row.backend == column)?)?;
        Some((ratio, false))
    };
    let title = format!("Every operation on every structure: {}", study.mesh.name);
    let figure = figure(&title, &columns, &ratio, id_prefix, command)?;
    Some(figure.with_data(data::heat_map(study)))
}

pub(super) fn pooled(pool: &Pool, runs: &[&Run], command: &str) -> Option<Figure> {
    let mut columns: Vec<&str> = Vec::new();
    for row in pool.all() {
        if !columns.contains(&row.backend.as_str()) {
            columns.push(&row.backend);
        }
    }
    let ratio = |operation: Operation, column: &str| {
        let mut rows = pool.all().iter();
        let row = rows.find(|row| row.operation == operation && row.backend == column);
        row.map(|row| (row.ratio_to_best, row.estimated > 0))
    };
    let title = format!(
        "Every operation on every structure: geometric mean over {}",
        counted(
            pool.groups.first().map_or(0, |all| all.meshes.len()),
            "mesh",
            "meshes"
        )
    );
    let figure = figure(&title, &columns, &ratio, "", command)?;
    Some(figure.with_data(data::pooled(pool, runs.iter().copied(), |_| true)))
}

/// A ratio to the fastest, and whether it is a lower bound.
type Ratio = (f64, bool);

fn figure(
    title: &str,
    columns: &[&str],
    ratio: &dyn Fn(Operation, &str) -> Option<Ratio>,
    id_prefix: &str,
    command: &str,
) -> Option<Figure> {
    let measured = |operation: &Operation| columns.iter().any(|c| ratio(*operation, c).is_some());
    let operations: Vec<Operation> = Operation::ALL.into_iter().filter(measured).collect();
    if operations.is_empty() {
        return None;
    }
    let mut table = Table::new([""].into_iter().chain(columns.iter().copied()));
    let (mut cells, mut titles) = (Vec::new(), Vec::new());
    for &operation in &operations {
        let mut line = vec![operation.name().to_owned()];
        line.extend(
            columns
                .iter()
                .map(|column| ratio(operation, column).map_or_else(|| "–".into(), shown)),
        );
        table.row(line);
    }
    // The plot draws rows upwards, but the first operation belongs at the top.
    for &operation in operations.iter().rev() {
        let mut line = Vec::new();
        for column in columns {
            let value = ratio(operation, column);
            // NaN means "not measured" and has its own colour. The colour of a lower bound would
            // rank it.
            let measured = value.filter(|(_, bound)| !bound);
            let colour = measured.map(|(ratio, _)| ratio.clamp(1.0, MAX_RATIO).log10());
            line.push(colour.unwrap_or(f64::NAN));
            let shown = value.map_or_else(|| "not measured".into(), shown);
            titles.push(format!("{operation} on {column}: {shown}"));
        }
        cells.push(line);
    }
    let height = 90.0 + 20.0 * operations.len() as f64;
    let width = 240.0 + 118.0 * columns.len() as f64;
    let plot = Heatmap::new()
        .with_data(cells)
        .with_color_map(ColorMap::Custom(Arc::new(colour)))
        .with_tooltip_labels(titles);
    let plots = vec![Plot::Heatmap(plot)];
    let names = operations
        .iter()
        .rev()
        .map(|operation| operation.name().to_owned());
    let layout = base_layout(&plots, width, height)
        .with_x_categories(columns.iter().map(|&name| name.to_owned()).collect())
        .with_y_categories(names.collect())
        .with_colorbar_tick_format(ratio_ticks(MAX_RATIO.log10()));
    Some(Figure {
        id: format!("{id_prefix}heat-map"),
        title: title.to_owned(),
        picture: picture(title, plots, layout),
        caption: format!(
            "Each cell shows the time relative to the fastest structure of the row. Dark cells \
             are fast. All ratios of {} or more have the same colour. Grey cells were not \
             measured, because the operation is not possible or would take too long; ≥ marks lower \
             bounds.",
            times(MAX_RATIO)
        ),
        table,
        data: FigureData::default(),
        command: command.into(),
    })
}

fn shown((ratio, bound): Ratio) -> String {
    marked(times(ratio), bound)
}

/// Returns a colour from dark to light. NaN is grey.
fn colour(value: f64) -> String {
    match value.is_nan() {
        true => GRID_COLOUR.into(),
        false => ColorMap::Viridis.map(value),
    }
}
