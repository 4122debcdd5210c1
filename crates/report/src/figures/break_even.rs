//! A figure that shows after how many operations a structure has saved more time than building it
//! took.

use sixfold_results::launches::difference_over_launches;
use sixfold_results::numbers::{approximate, counted, duration};
use sixfold_results::{BreakEven, Confidence, PickReport, Report, ResultRow};

use super::INPUT_BACKEND;
use crate::Picture;
use crate::axes::{Axes, LogScale, spread};
use crate::canvas::{Canvas, Style};
use crate::colours::{column_colour, column_shape};
use crate::data::own_columns;
use crate::data::rows::BreakEvenRow;
use crate::figure::{Figure, Table, count_tick, duration_tick};

/// The operation that visits each element by queries of all relations.
const ALL_QUERIES: &str = "all_queries";

/// The operation that is repeated in a study, with a line for each structure.
struct Repeated<'s> {
    operation: &'static str,
    lines: Vec<Line<'s>>,
    /// The largest number of repetitions.
    max_count: f64,
}

impl<'s> Repeated<'s> {
    /// Chooses the operation with the most queries.
    fn new(study: &'s Report) -> Option<Self> {
        let candidates = [ALL_QUERIES, "vertex_normal", "vv_smooth", "circulate"];
        let is_comparable = |operation: &&str| {
            let rows = study.rows(operation);
            rows.filter(|row| row.median_ns.is_some()).count() > 1
        };
        let operation = candidates.into_iter().find(is_comparable)?;
        let rows = study.rows(operation);
        let times = rows.filter_map(|row| Some((row, build(study, row)?, run(row)?)));
        let times: Vec<(&ResultRow, f64, f64)> = times.collect();
        let line = |&(row, build, run): &(&'s ResultRow, f64, f64)| {
            // A run may be a part of the time of the row.
            let part = run / row.median_ns.unwrap_or(run);
            let ends = row.ci_low_ns.zip(row.ci_high_ns);
            Line {
                name: row.backend.as_str(),
                build,
                run,
                interval: ends.map(|(low, high)| [part * low, part * high]),
                confidence: study.run.settings.confidence,
                launches: row.launch_ns.iter().map(|ns| Some(part * (*ns)?)).collect(),
                pays: Pays::Unknown,
            }
        };
        let mut lines: Vec<Line<'s>> = times.iter().map(line).collect();
        let given = lines.iter().position(|line| line.name == INPUT_BACKEND);
        if let Some(given) = given {
            let pays = lines.iter().map(|line| match lines[given].crossing(line) {
                _ if line.name == INPUT_BACKEND => Pays::Given,
                Some(crossing) => Pays::After(crossing),
                None => Pays::Never,
            });
            let pays: Vec<Pays> = pays.collect();
            for (line, pays) in lines.iter_mut().zip(pays) {
                line.pays = pays;
            }
        }
        let max_count = match operation {
            // A pass over the whole mesh.
            ALL_QUERIES => {
                let elements = times.iter().find_map(|(row, ..)| row.elements);
                elements.map_or(1e6, |elements| elements as f64).max(10.0)
            }
            _ => {
                let counts = lines.iter().filter_map(Line::pays_at);
                let last = counts.filter(|count| *count < 1e9).fold(10.0, f64::max);
                10_f64.powf((10.0 * last).log10().ceil())
            }
        };
        Some(Self {
            operation,
            lines,
            max_count,
        })
    }
}

/// Returns the time of a first build; 0 for the structure of the input.
fn build(study: &Report, row: &ResultRow) -> Option<f64> {
    if row.backend == INPUT_BACKEND {
        return Some(0.0);
    }
    let build = study.row("build", &row.backend)?;
    build.first_ns.or(build.median_ns)
}

/// Returns the time of one repetition. Building pays long before a pass over all queries, and each visit of
/// one is as good as any other, so one visit is a repetition of these.
fn run(row: &ResultRow) -> Option<f64> {
    match row.operation.as_str() {
        ALL_QUERIES => row.median_ns.and(row.ns_per_element),
        _ => row.median_ns,
    }
}

/// Returns what is counted: one and several of it.
fn units(operation: &str) -> [&'static str; 2] {
    match operation {
        ALL_QUERIES => ["visit", "visits"],
        _ => ["run", "runs"],
    }
}

/// Draws the time to build once and repeat one operation, over the number of repetitions.
pub(super) fn from_study(study: &Report, id_prefix: &str, command: &str) -> Option<Figure> {
    let Repeated {
        operation,
        lines,
        max_count,
    } = Repeated::new(study)?;
    let title = format!(
        "Time to build once and repeat {operation}: {}",
        super::file_name(&study.mesh.name)
    );
    let [one, many] = units(operation);
    let curves = Curves {
        title,
        id: format!("{id_prefix}break-even"),
        note: "`sixfold pick` measures this for a workload.".into(),
        axis: &match operation {
            ALL_QUERIES => "elements visited by queries of all nine relations".to_owned(),
            _ => format!("runs of {operation}"),
        },
        unit: &format!("one {one}"),
        units: many,
        subject: &study.mesh.name,
        repeated: operation,
        max_count,
    };
    curves.draw(&lines, command)
}

/// Returns the structures with the shortest total time of a study for fewer visited elements than a pass over
/// the mesh, with the largest number of visits for each, and the structure for more. `None` if the study has no
/// queries of all relations.
pub(crate) fn sequence(study: &Report) -> Option<(String, Vec<(String, String)>)> {
    let repeated = Repeated::new(study).filter(|one| one.operation == ALL_QUERIES)?;
    let (last, steps) = envelope(&repeated.lines, repeated.max_count)?;
    let steps = steps
        .into_iter()
        .map(|(line, most)| (line.name.to_owned(), most.text("visited elements")));
    Some((last.name.to_owned(), steps.collect()))
}

/// The lines with the shortest total time: the shortest for the most repetitions, and before it, the lines that
/// are the shortest up to a crossing with the next.
type Envelope<'l, 's> = (&'l Line<'s>, Vec<(&'l Line<'s>, Crossing)>);

/// Returns the lines with the shortest total time; `None` without lines.
fn envelope<'l, 's>(lines: &'l [Line<'s>], max_count: f64) -> Option<Envelope<'l, 's>> {
    let least = |count: f64| {
        let order = |a: &&Line<'_>, b: &&Line<'_>| {
            let by_total = a.at(count).total_cmp(&b.at(count));
            by_total.then(a.run.total_cmp(&b.run))
        };
        lines.iter().min_by(order)
    };
    let mut line = least(1.0)?;
    let mut count = 1.0;
    let mut steps = Vec::new();
    loop {
        // The first crossing with a line that is less steep.
        let crossings = lines.iter().filter_map(|other| line.crossing(other));
        let next = crossings
            .filter(|crossing| crossing.at > count)
            .min_by(|a, b| a.at.total_cmp(&b.at));
        let Some(next) = next.filter(|next| next.at < max_count) else {
            return Some((line, steps));
        };
        // Beyond the crossing, so that rounding does not choose the same line again.
        count = next.at * (1.0 + 1e-9);
        steps.push((line, next));
        line = least(count)?;
    }
}

/// Draws the time to build once and run the mix of a workload, over the number of operations.
pub(super) fn from_workload(report: &PickReport, id: &str, command: &str) -> Option<Figure> {
    let pays = |name: &str| {
        let row = report.break_even.iter().find(|row| row.backend == name);
        match row.map(Crossing::of) {
            _ if name == INPUT_BACKEND => Pays::Given,
            None => Pays::Unknown,
            Some(None) => Pays::Never,
            Some(Some(crossing)) => Pays::After(crossing),
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
        interval: ranked
            .ns_ci_low
            .zip(ranked.ns_ci_high)
            .map(|(low, high)| [low, high]),
        confidence: report.run.settings.confidence,
        launches: ranked.launch_ns.clone(),
        pays: pays(&ranked.backend),
    });
    let lines: Vec<Line<'_>> = lines.collect();
    let name = &report.workload.name;
    let title = format!("Time to build once and run {name}");
    let curves = Curves {
        title,
        id: id.into(),
        note: format!(
            "One use of the mesh consists of {}.",
            counted(
                report.operations.round() as usize,
                "operation",
                "operations"
            )
        ),
        axis: "operations",
        unit: "one operation",
        units: "operations",
        subject: name,
        repeated: "one operation of the workload",
        max_count: (100.0 * report.operations).max(1e4),
    };
    curves.draw(&lines, command)
}

/// The line of one structure. Times are in nanoseconds.
struct Line<'a> {
    name: &'a str,
    build: f64,
    run: f64,
    /// The interval of `run`.
    interval: Option<[f64; 2]>,
    /// The confidence of `interval`.
    confidence: Confidence,
    /// The time of a run in each launch.
    launches: Vec<Option<f64>>,
    pays: Pays,
}

/// From which number of repetitions a line is below that of the input mesh.
enum Pays {
    /// It is the line of the input mesh.
    Given,
    After(Crossing),
    Never,
    /// The input mesh has no line.
    Unknown,
}

/// The number of repetitions from which one line is below another.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Crossing {
    at: f64,
    /// The interval. The upper end is infinite if the lines may never cross.
    range: Option<[f64; 2]>,
}

impl Crossing {
    /// Returns the break-even of a workload; `None` if building never pays.
    fn of(row: &BreakEven) -> Option<Self> {
        Some(Self {
            at: row.operations?,
            range: row
                .ci_low
                .map(|low| [low, row.ci_high.unwrap_or(f64::INFINITY)]),
        })
    }

    /// Formats the number: `1,200 runs (1,100 to 1,400)`, or `1,200 runs (from 980, or never)`.
    fn text(&self, units: &str) -> String {
        let range = match self.range {
            None => String::new(),
            Some([low, high]) if approximate(low) == approximate(high) => String::new(),
            Some([low, high]) if high < MOST_RUNS => {
                format!(" ({} to {})", approximate(low), approximate(high))
            }
            Some([low, _]) => format!(" (from {}, or never)", approximate(low)),
        };
        let number = approximate(self.at);
        let units = match number == "1" {
            true => units.trim_end_matches('s'),
            false => units,
        };
        format!("{number} {units}{range}")
    }
}

/// From this number of repetitions on, building never pays.
const MOST_RUNS: f64 = 1e15;

impl Line<'_> {
    /// Returns the total time for `count` repetitions.
    fn at(&self, count: f64) -> f64 {
        self.build + count * self.run
    }

    /// Returns where a line that is less steep crosses this one. The time saved by a repetition is formed within launches.
    fn crossing(&self, other: &Self) -> Option<Crossing> {
        let saved = self.run - other.run;
        let after = |saved: f64| match saved > 0.0 {
            true => ((other.build - self.build) / saved).max(1.0),
            false => f64::INFINITY,
        };
        let in_launches = || {
            let launches = [&*self.launches, &*other.launches];
            difference_over_launches([self.run, other.run], launches, self.confidence)?.1
        };
        let of_both = || {
            let half = |line: &Self| line.interval.map(|[low, high]| (high - low) / 2.0);
            let half = half(self)?.hypot(half(other)?);
            Some([saved - half, saved + half])
        };
        let interval = in_launches().or_else(of_both);
        (saved > 0.0 && after(saved) < MOST_RUNS).then(|| Crossing {
            at: after(saved),
            range: interval.map(|[least, most]| [after(most), after(least)]),
        })
    }

    fn pays_at(&self) -> Option<f64> {
        match self.pays {
            Pays::After(crossing) => Some(crossing.at),
            _ => None,
        }
    }

    fn pays_range(&self) -> Option<[f64; 2]> {
        match self.pays {
            Pays::After(crossing) => crossing.range,
            _ => None,
        }
    }

    /// Says after how many `units` building pays off.
    fn pays_after(&self, units: &str) -> String {
        match self.pays {
            Pays::Given => "given".into(),
            Pays::After(crossing) => crossing.text(units),
            Pays::Never => "never".into(),
            Pays::Unknown => "–".into(),
        }
    }

    /// Returns the number of repetitions from which building pays off, if it is between the ends of the axis.
    fn point(&self, [first, last]: [f64; 2]) -> Option<f64> {
        self.pays_at()
            .filter(|&count| first < count && count <= last)
    }
}

struct Curves<'a> {
    title: String,
    id: String,
    /// The end of the caption.
    note: String,
    axis: &'a str,
    /// Column title of the repeated work.
    unit: &'a str,
    /// What is counted, such as `runs`.
    units: &'a str,
    /// The mesh or the workload.
    subject: &'a str,
    /// What one run is.
    repeated: &'a str,
    /// The largest number of repetitions.
    max_count: f64,
}

impl Curves<'_> {
    fn draw(self, lines: &[Line<'_>], command: &str) -> Option<Figure> {
        if lines.len() < 2 {
            return None;
        }
        let mut table = Table::new(["", "to build", self.unit, "pays after"]);
        for line in lines {
            table.row(vec![
                line.name.into(),
                duration(line.build),
                duration(line.run),
                line.pays_after(self.units),
            ]);
        }
        let rows = lines.iter().map(|line| BreakEvenRow {
            subject: self.subject,
            run: self.repeated,
            backend: line.name,
            build_ns: line.build,
            run_ns: line.run,
            pays_after_runs: match line.name {
                INPUT_BACKEND => Some(0.0),
                _ => line.pays_at(),
            },
            pays_after_low: line.pays_range().map(|[low, _]| low),
            pays_after_high: line
                .pays_range()
                .map(|[_, high]| high)
                .filter(|high| high.is_finite()),
        });
        let csv = own_columns(rows);
        let ends = lines
            .iter()
            .flat_map(|line| [line.at(1.0), line.at(self.max_count)]);
        let [least, most] = ends.fold([f64::INFINITY, 0.0], |[least, most], ns| {
            [f64::min(least, ns), f64::max(most, ns)]
        });
        let axes = Axes {
            x: LogScale {
                values: [1.0, self.max_count],
                pixels: [70.0, 590.0],
            },
            y: LogScale {
                values: [least.max(1.0), most.max(10.0)],
                pixels: [380.0, 30.0],
            },
            x_label: self.axis,
            y_label: "total time, with the time to build",
            x_format: &count_tick,
            y_format: &duration_tick,
        };
        let mut canvas = Canvas::new(860.0, 424.0);
        axes.draw(&mut canvas);
        draw_lines(&mut canvas, &axes, lines, self.units);
        Some(Figure {
            caption: self.caption(lines),
            id: self.id,
            picture: Picture::single(&self.title, canvas),
            title: self.title,
            table,
            csv,
            source: String::new(),
            command: command.into(),
        })
    }
}

impl Curves<'_> {
    fn caption(&self, lines: &[Line<'_>]) -> String {
        let mut parts = vec![format!(
            "The mesh is given as an {INPUT_BACKEND}. Every other structure is built first; the time to build is that of the \
             first build on fresh pages, where one was measured."
        )];
        let is_drawn = |line: &Line<'_>| line.point([1.0, self.max_count]).is_some();
        if let Some(line) = lines.iter().find(|line| is_drawn(line)) {
            parts.push(format!(
                "Points and numbers show after how many {} building pays off: the line of the structure is then below that of \
                 the {INPUT_BACKEND}. Ranges in brackets follow from the {} intervals of the repeated work.",
                self.units, line.confidence
            ));
        }
        parts.extend(self.least_total(lines));
        parts.push(self.note.clone());
        parts.join(" ")
    }

    /// Says which structure has the shortest total time for how many repetitions.
    fn least_total(&self, lines: &[Line<'_>]) -> Option<String> {
        let (last, steps) = envelope(lines, self.max_count)?;
        let parts = steps.iter();
        let parts =
            parts.map(|(line, most)| format!("{} up to {}", line.name, most.text(self.units)));
        let parts: Vec<String> = parts.collect();
        Some(match parts.is_empty() {
            true => format!("{} has the shortest total time everywhere.", last.name),
            false => format!(
                "The shortest total time: {}, {} beyond.",
                parts.join(", "),
                last.name
            ),
        })
    }
}

/// Draws the lines with their names at the right, and the points from which building pays off.
fn draw_lines(canvas: &mut Canvas, axes: &Axes<'_>, lines: &[Line<'_>], units: &str) {
    let [min_count, max_count] = axes.x.values;
    let steps = (8.0 * (max_count / min_count).log10()).ceil() as i32;
    for line in lines {
        let count = |step: i32| min_count * 10_f64.powf(f64::from(step) / 8.0);
        let counts = (0..=steps).map(|step| count(step).min(max_count));
        let points = counts.map(|count| axes.place([count, line.at(count)]));
        let points: Vec<[f64; 2]> = points.collect();
        canvas.polyline(&points, column_colour(line.name), 2.0);
    }
    let points = lines.iter().filter_map(|line| {
        let count = line.point(axes.x.values)?;
        Some((line, count, axes.place([count, line.at(count)])))
    });
    let points: Vec<(&Line<'_>, f64, [f64; 2])> = points.collect();
    let mut labelled: Vec<[f64; 2]> = Vec::new();
    for (line, count, [x, y]) in points {
        let title = format!("{} pays after {}", line.name, line.pays_after(units));
        let (colour, shape) = (column_colour(line.name), column_shape(line.name));
        canvas.mark(title, |canvas| canvas.point(shape, [x, y], 4.5, colour));
        // Where points are close to each other, the labels at the right say the numbers.
        let is_near = |[other_x, other_y]: &[f64; 2]| {
            (other_x - x).abs() < 60.0 && (other_y - y).abs() < 16.0
        };
        if !labelled.iter().any(is_near) {
            let style = Style::new(12).end().bold(true);
            canvas.text([x - 7.0, y - 7.0], &approximate(count), style);
            labelled.push([x, y]);
        }
    }
    let places: Vec<f64> = lines
        .iter()
        .map(|line| axes.y.place(line.at(max_count)))
        .collect();
    let labels = spread(&places, 15.0, [30.0, 380.0]);
    for ((line, place), label) in lines.iter().zip(places).zip(labels) {
        let right = axes.x.pixels[1];
        let colour = column_colour(line.name);
        canvas.line([right + 2.0, place], [right + 11.0, label], colour, 1.0);
        canvas.point(column_shape(line.name), [right + 14.0, label], 3.5, colour);
        let text = match line.pays {
            Pays::Given => format!("{}: given", line.name),
            Pays::Never => format!("{}: never pays", line.name),
            Pays::Unknown => line.name.to_owned(),
            Pays::After(Crossing { at, .. }) => {
                format!("{}: pays after {}", line.name, approximate(at))
            }
        };
        canvas.text([right + 21.0, label + 4.0], &text, Style::new(12));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::{Paint, Shape};

    /// In grey, the shape says which line a point and a name belong to.
    #[test]
    fn the_point_and_the_name_of_a_line_have_the_shape_of_its_column() {
        let scale = |pixels| LogScale {
            values: [1.0, 1e4],
            pixels,
        };
        let axes = Axes {
            x: scale([0.0, 400.0]),
            y: scale([400.0, 0.0]),
            x_label: "",
            y_label: "",
            x_format: &count_tick,
            y_format: &duration_tick,
        };
        let line = |name, at| Line {
            name,
            build: 100.0,
            run: 1.0,
            interval: None,
            confidence: Confidence::default(),
            launches: Vec::new(),
            pays: Pays::After(Crossing { at, range: None }),
        };
        let names = ["half-edge", "relation-tables"];
        let mut canvas = Canvas::new(700.0, 400.0);
        let lines = [line(names[0], 30.0), line(names[1], 1000.0)];
        draw_lines(&mut canvas, &axes, &lines, "runs");
        let shapes = canvas.shapes.iter().flat_map(|shape| match shape {
            Shape::Mark { shapes, .. } => &shapes[..],
            shape => std::slice::from_ref(shape),
        });
        let corners = shapes.filter_map(|shape| match shape {
            Shape::Path {
                parts,
                paint: Paint::Fill(colour),
            } => Some((*colour, parts[0].len())),
            _ => None,
        });
        let mut corners: Vec<(&str, usize)> = corners.collect();
        corners.sort_by_key(|(_, count)| *count);
        // Triangles and crosses.
        let expected = [(names[0], 3), (names[0], 3), (names[1], 12), (names[1], 12)];
        assert_eq!(
            corners,
            expected.map(|(name, count)| (column_colour(name), count))
        );
    }
}
