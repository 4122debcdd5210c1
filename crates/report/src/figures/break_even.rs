//! From how much work on a structure pays for being built.

use kuva::plot::LinePlot;
use kuva::render::plots::Plot;
use study::numbers::{counted, duration};
use study::{Answer, Operation, Report, ResultRow};

use crate::colours::of_column;
use crate::figure::{Figure, Table, drawn, laid_out};

/// What is there already: who has nothing else begins with this.
const GIVEN: &str = "indexed-face-set";

/// Time of building and then running one operation again and again, against how often.
pub(super) fn of_study(study: &Report, of: &str, command: &str) -> Option<Figure> {
    // The operation that asks most, of those that were measured.
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
        _ if name == GIVEN => "is there".into(),
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
        "Building, and then {operation} again and again: {}",
        study.mesh.name
    );
    let caption = format!(
        "An {GIVEN} is there already; another structure is built first, on fresh pages, and where its line goes below, it has paid \
         for that. `sixfold pick` measures this for the mix of a program."
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

/// Time of building and then running the mix of a workload, against how many operations of it.
pub(super) fn of_workload(answer: &Answer, id: &str, command: &str) -> Option<Figure> {
    let pays = |name: &str| {
        let row = answer.break_even.iter().find(|row| row.backend == name);
        match row.map(|row| row.operations) {
            _ if name == GIVEN => "is there".into(),
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
    let title = format!("Building, and then {name}");
    let caption = format!(
        "An {GIVEN} is there already; another structure is built first, on fresh pages, and where its line goes below, it has paid \
         for that. One use of the mesh comes to {}.",
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
        once: "an operation",
        most: (100.0 * answer.operations).max(1e4),
    };
    curves.drawn(&lines, command)
}

/// One structure.
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

/// What a figure says of its lines.
struct Curves<'a> {
    title: String,
    id: String,
    caption: String,
    axis: &'a str,
    /// What is done again and again.
    once: &'a str,
    /// How often at most.
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
            .with_y_label("milliseconds in all");
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
