//! The amount of work after which building a structure has paid off.

use kuva::plot::LinePlot;
use kuva::render::plots::Plot;
use sixfold_study::numbers::{counted, duration};
use sixfold_study::{Answer, Operation, Report, ResultRow};

use crate::colours::of_column;
use crate::figure::{Figure, Table, drawn, laid_out};

/// Structure that the mesh is given in; it need not be built.
const GIVEN: &str = "indexed-face-set";

/// Draws the time to build once and then repeat one operation, over the number of runs.
pub(super) fn of_study(study: &Report, of: &str, command: &str) -> Option<Figure> {
    // The operation with the most queries among those measured.
    let asked = [
        Operation::AllQueries,
        Operation::VertexNormal,
        Operation::VvSmooth,
        Operation::Circulate,
    ];
    let many = |operation: &Operation| {
        study
            .rows(*operation)
            .filter(|row| row.median_ns.is_some())
            .count()
            > 1
    };
    let operation = asked.into_iter().find(many)?;
    let build = |row: &ResultRow| -> Option<f64> {
        if row.backend == GIVEN {
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
    let given = lines.iter().find(|(name, ..)| *name == GIVEN);
    let pays = |(name, build, run): (&str, f64, f64)| match given {
        _ if name == GIVEN => "given".into(),
        Some((_, _, slow)) if *slow > run => after(build / (slow - run), "run", "runs"),
        Some(_) => "never".into(),
        None => "–".into(),
    };
    let lines: Vec<Line<'_>> = { lines.iter() }
        .map(|&(name, build, run)| Line {
            name,
            build,
            run,
            pays: pays((name, build, run)),
        })
        .collect();
    let title = format!(
        "Building once, then repeating {operation}: {}",
        study.mesh.name
    );
    let caption = format!(
        "The mesh is given as an {GIVEN}. Every other structure is built first, on fresh pages; this has paid off where its line \
         falls below that of the {GIVEN}. `sixfold pick` measures this for the mix of a workload."
    );
    let curves = Curves {
        title,
        id: format!("{of}break-even"),
        caption,
        axis: &format!("runs of {operation}"),
        once: "one run",
        most: 1e4,
    };
    curves.drawn(&lines, command)
}

/// Draws the time to build once and then run the mix of a workload, over the number of operations.
pub(super) fn of_workload(answer: &Answer, id: &str, command: &str) -> Option<Figure> {
    let pays = |name: &str| {
        let row = answer.break_even.iter().find(|row| row.backend == name);
        match row.map(|row| row.operations) {
            _ if name == GIVEN => "given".into(),
            None => "–".into(),
            Some(None) => "never".into(),
            Some(Some(operations)) => after(operations, "operation", "operations"),
        }
    };
    let lines = answer.ranking.iter().map(|ranked| Line {
        name: &ranked.backend,
        build: match ranked.backend.as_str() {
            GIVEN => 0.0,
            _ => ranked.first_build_ns(),
        },
        run: ranked.ns_per_operation,
        pays: pays(&ranked.backend),
    });
    let lines: Vec<Line<'_>> = lines.collect();
    let name = &answer.workload.name;
    let title = format!("Building once, then running {name}");
    let caption = format!(
        "The mesh is given as an {GIVEN}. Every other structure is built first, on fresh pages; this has paid off where its line \
         falls below that of the {GIVEN}. One use of the mesh consists of {}.",
        counted(
            answer.operations.round() as usize,
            "operation",
            "operations"
        )
    );
    let curves = Curves {
        title,
        id: id.into(),
        caption,
        axis: "operations",
        once: "one operation",
        most: (100.0 * answer.operations).max(1e4),
    };
    curves.drawn(&lines, command)
}

/// The line of one structure, with times in nanoseconds.
struct Line<'a> {
    name: &'a str,
    build: f64,
    run: f64,
    pays: String,
}

fn after(count: f64, one: &str, many: &str) -> String {
    match count.ceil().max(1.0) {
        count if count < 1e15 => counted(count as usize, one, many),
        _ => "never".into(),
    }
}

/// Texts and range of a figure.
struct Curves<'a> {
    title: String,
    id: String,
    caption: String,
    axis: &'a str,
    /// Column title of the repeated work.
    once: &'a str,
    /// Largest number of repetitions.
    most: f64,
}

impl Curves<'_> {
    fn drawn(self, lines: &[Line<'_>], command: &str) -> Option<Figure> {
        if lines.len() < 2 {
            return None;
        }
        let mut table = Table::new(["", "to build", self.once, "pays after"]);
        let mut plots = Vec::new();
        let quarters = (4.0 * self.most.log10()).ceil() as i32;
        for Line {
            name,
            build,
            run,
            pays,
        } in lines
        {
            let counts = (0..=quarters).map(|quarter| 10_f64.powf(f64::from(quarter) / 4.0));
            let points = counts.map(|count| (count, (build + count * run) / 1e6));
            plots.push(Plot::Line(
                LinePlot::new()
                    .with_data(points.collect::<Vec<(f64, f64)>>())
                    .with_color(of_column(name))
                    .with_stroke_width(2.0)
                    .with_legend(*name),
            ));
            let cells = [
                (*name).into(),
                duration(*build),
                duration(*run),
                pays.clone(),
            ];
            table.row(cells.into());
        }
        let layout = laid_out(&plots, 820.0, 440.0)
            .with_log_scale()
            .with_x_label(self.axis)
            .with_y_label("total time, ms");
        Some(Figure {
            id: self.id,
            svg: drawn(&self.title, plots, layout),
            title: self.title,
            caption: self.caption,
            table,
            command: command.into(),
        })
    }
}
