//! A figure that shows after how many operations a structure has saved more time than building it
//! took.

use kuva::plot::LinePlot;
use kuva::render::plots::Plot;
use sixfold_study::numbers::{counted, duration};
use sixfold_study::{Operation, PickReport, Report, ResultRow, Run};

use crate::colours::column_colour;
use crate::data::FigureData;
use crate::data::rows::BreakEvenRow;
use crate::figure::{Figure, Table, base_layout, picture};

/// The structure of the input mesh. It need not be built.
const INPUT_BACKEND: &str = "indexed-face-set";

/// Draws the time to build once and repeat one operation, over the number of repetitions.
pub(super) fn from_study(study: &Report, id_prefix: &str, command: &str) -> Option<Figure> {
    // Prefer the operation with the most queries.
    let candidates = [
        Operation::AllQueries,
        Operation::VertexNormal,
        Operation::VvSmooth,
        Operation::Circulate,
    ];
    let is_comparable = |operation: &Operation| {
        study
            .rows(*operation)
            .filter(|row| row.median_ns.is_some())
            .count()
            > 1
    };
    let operation = candidates.into_iter().find(is_comparable)?;
    let build = |row: &ResultRow| -> Option<f64> {
        if row.backend == INPUT_BACKEND {
            return Some(0.0);
        }
        let mut builds = study.rows(Operation::Build);
        let build = builds.find(|build| build.backend == row.backend)?;
        build.first_ns.or(build.median_ns)
    };
    let rows = study.rows(operation);
    let lines: Vec<(&str, f64, f64)> = rows
        .filter_map(|row| Some((row.backend.as_str(), build(row)?, row.median_ns?)))
        .collect();
    let input = lines.iter().find(|(name, ..)| *name == INPUT_BACKEND);
    let pays_after_runs = |(name, build, run): (&str, f64, f64)| match input {
        _ if name == INPUT_BACKEND => Some(0.0),
        Some((_, _, slow)) if *slow > run => Some(build / (slow - run)),
        _ => None,
    };
    let pays_after = |(name, build, run): (&str, f64, f64)| match input {
        _ if name == INPUT_BACKEND => "given".into(),
        Some((_, _, slow)) if *slow > run => break_even_text(build / (slow - run), "run", "runs"),
        Some(_) => "never".into(),
        None => "–".into(),
    };
    let lines: Vec<Line<'_>> = lines
        .iter()
        .map(|&(name, build, run)| Line {
            name,
            build,
            run,
            pays_after: pays_after((name, build, run)),
            pays_after_runs: pays_after_runs((name, build, run)),
        })
        .collect();
    let title = format!(
        "Time to build once and repeat {operation}: {}",
        study.mesh.name
    );
    let caption = format!(
        "The mesh is given as an {INPUT_BACKEND}. Every other structure is built first, on fresh \
         pages. Building pays off as soon as the line of the structure is below the line of the \
         {INPUT_BACKEND}. `sixfold pick` measures this for a workload."
    );
    let curves = Curves {
        title,
        id: format!("{id_prefix}break-even"),
        caption,
        axis: &format!("runs of {operation}"),
        unit: "one run",
        subject: &study.mesh.name,
        repeated: operation.name(),
        measured: &study.run,
        max_count: 1e4,
    };
    curves.draw(&lines, command)
}

/// Draws the time to build once and run the mix of a workload, over the number of operations.
pub(super) fn from_workload(report: &PickReport, id: &str, command: &str) -> Option<Figure> {
    let pays_after = |name: &str| {
        let row = report.break_even.iter().find(|row| row.backend == name);
        match row.map(|row| row.operations) {
            _ if name == INPUT_BACKEND => "given".into(),
            None => "–".into(),
            Some(None) => "never".into(),
            Some(Some(operations)) => break_even_text(operations, "operation", "operations"),
        }
    };
    let pays_after_runs = |name: &str| {
        let row = report.break_even.iter().find(|row| row.backend == name);
        match name {
            INPUT_BACKEND => Some(0.0),
            _ => row?.operations,
        }
    };
    let measured = report.ranking.iter().filter(|ranked| !ranked.estimated);
    let lines = measured.map(|ranked| Line {
        name: &ranked.backend,
        build: match ranked.backend.as_str() {
            INPUT_BACKEND => 0.0,
            _ => ranked.first_build_ns(),
        },
        run: ranked.ns_per_operation,
        pays_after: pays_after(&ranked.backend),
        pays_after_runs: pays_after_runs(&ranked.backend),
    });
    let lines: Vec<Line<'_>> = lines.collect();
    let name = &report.workload.name;
    let title = format!("Time to build once and run {name}");
    let caption = format!(
        "The mesh is given as an {INPUT_BACKEND}. Every other structure is built first, on fresh \
         pages. Building pays off as soon as the line of the structure is below the line of the \
         {INPUT_BACKEND}. One use of the mesh consists of {}.",
        counted(
            report.operations.round() as usize,
            "operation",
            "operations"
        )
    );
    let curves = Curves {
        title,
        id: id.into(),
        caption,
        axis: "operations",
        unit: "one operation",
        subject: name,
        repeated: "one operation of the workload",
        measured: &report.run,
        max_count: (100.0 * report.operations).max(1e4),
    };
    curves.draw(&lines, command)
}

/// The line of one structure. Times are in nanoseconds.
struct Line<'a> {
    name: &'a str,
    build: f64,
    run: f64,
    pays_after: String,
    /// 0 for the input. `None` if building never pays off, or if this is unknown.
    pays_after_runs: Option<f64>,
}

fn break_even_text(count: f64, singular: &str, plural: &str) -> String {
    match count.ceil().max(1.0) {
        count if count < 1e15 => counted(count as usize, singular, plural),
        _ => "never".into(),
    }
}

struct Curves<'a> {
    title: String,
    id: String,
    caption: String,
    axis: &'a str,
    /// Column title of the repeated work.
    unit: &'a str,
    /// The mesh or the workload.
    subject: &'a str,
    /// What one run is.
    repeated: &'a str,
    /// How the times were measured.
    measured: &'a Run,
    /// Maximum number of repetitions.
    max_count: f64,
}

impl Curves<'_> {
    fn draw(self, lines: &[Line<'_>], command: &str) -> Option<Figure> {
        if lines.len() < 2 {
            return None;
        }
        let mut table = Table::new(["", "to build", self.unit, "pays after"]);
        let mut plots = Vec::new();
        let quarters = (4.0 * self.max_count.log10()).ceil() as i32;
        for Line {
            name,
            build,
            run,
            pays_after,
            ..
        } in lines
        {
            let counts = (0..=quarters).map(|quarter| 10_f64.powf(f64::from(quarter) / 4.0));
            let points = counts.map(|count| (count, (build + count * run) / 1e6));
            plots.push(Plot::Line(
                LinePlot::new()
                    .with_data(points.collect::<Vec<(f64, f64)>>())
                    .with_color(column_colour(name))
                    .with_stroke_width(2.0)
                    .with_legend(*name),
            ));
            let cells = [
                (*name).into(),
                duration(*build),
                duration(*run),
                pays_after.clone(),
            ];
            table.row(cells.into());
        }
        let rows = lines.iter().map(|line| BreakEvenRow {
            subject: self.subject,
            run: self.repeated,
            backend: line.name,
            build_ns: line.build,
            run_ns: line.run,
            pays_after_runs: line.pays_after_runs,
        });
        let data = FigureData::from_rows([self.measured], [], rows);
        let layout = base_layout(&plots, 820.0, 440.0)
            .with_log_scale()
            .with_x_label(self.axis)
            .with_y_label("total time, ms");
        Some(Figure {
            id: self.id,
            picture: picture(&self.title, plots, layout),
            title: self.title,
            caption: self.caption,
            table,
            data,
            command: command.into(),
        })
    }
}
