//! What the programs that make reports share: the opening lines, and a log–log chart of all structures.

use std::error::Error;
use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;
use sixfold::roster;
use study::Environment;

/// A colour for each structure, in the order of the roster.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0xd6, 0x27, 0x28),
    RGBColor(0xff, 0x7f, 0x0e),
    RGBColor(0x2c, 0xa0, 0x2c),
    RGBColor(0x94, 0x67, 0xbd),
    RGBColor(0x1f, 0x77, 0xb4),
    RGBColor(0x8c, 0x56, 0x4b),
];

/// The command that makes the report, as a block, and the machine it was made on.
pub(crate) fn opening(machine: &Environment, example: &str, folder: &str, rounds: usize) -> String {
    let cpu = machine.cpu_model.as_deref().unwrap_or("unknown processor");
    let load = machine.load_average.unwrap_or(f64::NAN);
    let flags = match machine.rustflags.as_str() {
        "" => String::new(),
        flags => format!("RUSTFLAGS=\"{flags}\" "),
    };
    format!(
        "```sh\n{flags}cargo run --release -p study --example {example} -- {folder} {rounds}\n```\n\n\
         {cpu}, {} cores, load {load:.1} at the start; {} {} {}; one thread, thread-CPU time, medians of \
         {rounds} rounds in which all take turns.",
        machine.cores.unwrap_or(0),
        machine.rustc,
        machine.profile,
        machine.rustflags,
    )
}

/// The middle of `samples`.
pub(crate) fn median(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    f64::midpoint(sorted[(sorted.len() - 1) / 2], sorted[sorted.len() / 2])
}

/// What a chart shows, and from where to where.
pub(crate) struct Chart<'a> {
    pub(crate) caption: String,
    pub(crate) x: (&'a str, Range<f64>),
    pub(crate) y: (&'a str, Range<f64>),
    pub(crate) legend: SeriesLabelPosition,
}

impl Chart<'_> {
    /// Draws a line for each structure for which `points` has some, both axes logarithmic.
    pub(crate) fn draw(
        self,
        panel: &DrawingArea<SVGBackend<'_>, Shift>,
        points: impl Fn(&str) -> Vec<(f64, f64)>,
    ) -> Result<(), Box<dyn Error>> {
        let mut chart = ChartBuilder::on(panel)
            .caption(self.caption, ("sans-serif", 17))
            .margin(8)
            .x_label_area_size(34)
            .y_label_area_size(46)
            .build_cartesian_2d(self.x.1.log_scale(), self.y.1.log_scale())?;
        chart
            .configure_mesh()
            .x_desc(self.x.0)
            .y_desc(self.y.0)
            .x_label_formatter(&|x| format!("{x:.0e}"))
            .y_label_formatter(&|y| match y {
                y if *y >= 1e4 => format!("{y:.0e}"),
                y => format!("{y}"),
            })
            .light_line_style(WHITE)
            .draw()?;
        for (backend, colour) in roster().iter().zip(COLOURS) {
            let points = points(backend.name);
            if points.is_empty() {
                continue;
            }
            let dots = points.iter().map(|&at| Circle::new(at, 3, colour.filled()));
            chart.draw_series(dots)?;
            chart
                .draw_series(LineSeries::new(points, colour.stroke_width(2)))?
                .label(backend.name)
                .legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + 14, y)], colour.stroke_width(2))
                });
        }
        chart
            .configure_series_labels()
            .position(self.legend)
            .background_style(WHITE.mix(0.85))
            .label_font(("sans-serif", 12))
            .draw()?;
        Ok(())
    }
}
