//! The spread over the meshes: a panel for each kind of work, and in it a dot for each mesh and structure.

use serde::Serialize;
use sixfold_results::numbers::{counted, grouped, rounded_down, times};
use sixfold_results::{Group, Overall, Pool, Purpose, leaders};

use super::{Mesh, leaders_of};
use crate::Picture;
use crate::axes::{LogScale, scatter};
use crate::canvas::{Canvas, Style};
use crate::colours::{FAINT_COLOUR, TEXT_COLOUR, column_colour};
use crate::data::own_columns;
use crate::figure::{Figure, Table};

/// Dots with a longer ratio stand at the end of the scale, as triangles.
const LONGEST: f64 = 1000.0;
/// Size of a panel, and the places of its parts.
const WIDTH: f64 = 540.0;
const HEAD: f64 = 52.0;
const ROW: f64 = 26.0;
const DOTS: [f64; 2] = [126.0, 360.0];
/// The dots of one structure are moved up and down by at most this, so that they do not hide each other.
const SCATTER: f64 = 8.0;

/// One dot.
struct Dot<'m> {
    mesh: &'m str,
    ratio: f64,
    bound: bool,
    pooled: bool,
}

/// The dots of one structure, with the mean.
struct Line<'m> {
    mean: &'m Overall,
    /// The mean divided by that of the fastest on average, and as text.
    ratio: f64,
    text: String,
    lead: bool,
    dots: Vec<Dot<'m>>,
}

/// One kind of work.
struct Panel<'m> {
    purpose: Purpose,
    /// The fastest on average, with which all others are compared.
    leader: &'m str,
    /// Number of meshes in the means.
    meshes: usize,
    lines: Vec<Line<'m>>,
}

/// Row of the data of the figure.
#[derive(Serialize)]
struct DotRow<'m> {
    work: String,
    backend: &'m str,
    mesh: &'m str,
    compared_with: &'m str,
    ratio: f64,
    lower_bound: bool,
    part_of_the_mean: bool,
}

pub(super) fn figure(pool: &Pool, meshes: &[Mesh<'_>], command: &str) -> Option<Figure> {
    let all = pool.groups.first()?;
    let panels = leaders_of(pool).into_iter();
    let panels = panels.map(|(purpose, leader)| panel(all, meshes, purpose, leader));
    let panels: Vec<Panel<'_>> = panels.filter(|panel| panel.lines.len() > 1).collect();
    let lines = || panels.iter().flat_map(|panel| &panel.lines);
    let ratios =
        || lines().flat_map(|line| line.dots.iter().map(|dot| dot.ratio).chain([line.ratio]));
    let longest = ratios().fold(2.0, f64::max);
    let shortest = ratios().fold(1.0, f64::min);
    let scale = LogScale {
        values: [shortest.max(LONGEST.recip()), longest.min(LONGEST)],
        pixels: DOTS,
    };
    let most = panels.iter().map(|panel| panel.lines.len()).max()?;
    let scenes: Vec<Canvas> = panels
        .iter()
        .map(|panel| scene(panel, scale, most))
        .collect();
    let title = format!(
        "Mesh by mesh: a dot for each of {}",
        counted(meshes.len(), "mesh", "meshes")
    );
    let mut notes = vec![
        "A dot is the mean time of a structure on one mesh, divided by that of the structure that is the fastest on average, on a \
         logarithmic scale that is the same in all panels: on the left of 1 × is faster, on the right slower. The upright line and \
         the number are the mean over the meshes, and after it is the number of meshes on which the structure alone is the fastest. \
         Bold: the fastest on average, without a clear difference."
            .to_owned(),
    ];
    let dots = || lines().flat_map(|line| &line.dots);
    if dots().any(|dot| !dot.pooled) {
        notes.push(
            "Rings are meshes that not all structures can hold, which are not part of the mean."
                .into(),
        );
    }
    if dots().any(|dot| dot.bound) {
        notes.push("Squares are lower bounds.".into());
    }
    if longest > LONGEST {
        notes.push(format!(
            "Triangles at the end are beyond {}.",
            times(LONGEST)
        ));
    }
    Some(Figure {
        id: "distribution".into(),
        picture: Picture::grid(&title, 2, scenes),
        title,
        caption: notes.join(" "),
        table: table(&panels),
        csv: csv(&panels),
        source: String::new(),
        command: command.into(),
    })
}

fn panel<'m>(
    all: &'m Group,
    meshes: &'m [Mesh<'_>],
    purpose: Purpose,
    leader: &'m str,
) -> Panel<'m> {
    let means = purpose.rows(&all.overall);
    let leaders = leaders(means);
    let leads = |mean: &Overall| leaders.iter().any(|row| row.backend == mean.backend);
    let dots = |backend: &str| {
        let dots = meshes.iter().filter_map(|mesh| {
            let mut rows = mesh.relative_to(leader, purpose).into_iter();
            let row = rows.find(|row| row.backend == backend)?;
            Some(Dot {
                mesh: &mesh.name,
                ratio: row.ratio,
                bound: row.bound,
                pooled: mesh.pooled,
            })
        });
        dots.collect()
    };
    let line = |mean: &'m Overall| Line {
        text: mean.times(&means[0]),
        mean,
        ratio: mean.ratio_to_best / means[0].ratio_to_best,
        lead: leads(mean),
        dots: dots(&mean.backend),
    };
    Panel {
        purpose,
        leader,
        meshes: means.first().map_or(0, |mean| mean.meshes),
        lines: means.iter().map(line).collect(),
    }
}

fn scene(panel: &Panel<'_>, scale: LogScale, rows: usize) -> Canvas {
    let mut canvas = Canvas::new(WIDTH, HEAD + ROW * rows as f64 + 4.0);
    canvas.text(
        [0.0, 14.0],
        panel.purpose.title(),
        Style::new(14).bold(true),
    );
    let meshes = counted(panel.meshes, "mesh", "meshes");
    let meshes = format!(
        "time divided by that of {}; means over {meshes}",
        panel.leader
    );
    canvas.text([0.0, 31.0], &meshes, Style::new(12).colour(FAINT_COLOUR));
    let bottom = HEAD + ROW * panel.lines.len() as f64;
    let label = |tick: f64| format!("{tick} ×");
    let ends = [HEAD - 4.0, bottom];
    scale.draw_ticks(&mut canvas, ends, HEAD - 8.0, FAINT_COLOUR, &label);
    for (number, line) in panel.lines.iter().enumerate() {
        draw_line(&mut canvas, line, scale, HEAD + ROW * (number as f64 + 0.5));
    }
    canvas
}

/// Draws the dots of one structure about the height `y`.
fn draw_line(canvas: &mut Canvas, line: &Line<'_>, scale: LogScale, y: f64) {
    let (mean, colour) = (line.mean, column_colour(&line.mean.backend));
    let label = Style::new(12).bold(line.lead);
    canvas.text([DOTS[0] - 8.0, y + 4.0], &mean.backend, label.end());
    for (number, dot) in line.dots.iter().enumerate() {
        draw_dot(
            canvas,
            dot,
            &mean.backend,
            [scale.place(dot.ratio), y + SCATTER * scatter(number)],
            scale,
            colour,
        );
    }
    let x = scale.place(line.ratio);
    canvas.line([x, y - 9.0], [x, y + 9.0], TEXT_COLOUR, 2.0);
    let text = match mean.best {
        0 => line.text.clone(),
        best => format!("{} · fastest on {}", line.text, grouped(best)),
    };
    canvas.text([DOTS[1] + 12.0, y + 4.0], &text, label);
}

/// Returns the ratio of a mesh as text, with the sign of a lower bound.
fn ratio_text(dot: &Dot<'_>) -> String {
    match dot.bound {
        true => format!("≥ {}", times(rounded_down(dot.ratio))),
        false => times(dot.ratio),
    }
}

fn draw_dot(
    canvas: &mut Canvas,
    dot: &Dot<'_>,
    backend: &str,
    [x, y]: [f64; 2],
    scale: LogScale,
    colour: &'static str,
) {
    let ratio = ratio_text(dot);
    canvas.mark(format!("{}, {backend}: {ratio}", dot.mesh), |canvas| {
        if dot.ratio > 1.001 * scale.values[1] {
            canvas.filled(
                &[[x - 3.0, y - 3.5], [x + 4.0, y], [x - 3.0, y + 3.5]],
                colour,
            );
        } else if dot.bound {
            canvas.frame([x - 2.5, y - 2.5], [5.0, 5.0], colour);
        } else if dot.pooled {
            canvas.circle([x, y], 2.5, colour);
        } else {
            canvas.ring([x, y], 2.5, colour);
        }
    });
}

fn table(panels: &[Panel<'_>]) -> Table {
    let mut table = Table::new([
        "",
        "structure",
        "mean",
        "compared with",
        "fastest on",
        "shared on",
        "of decided",
        "least",
        "most",
        "meshes",
    ]);
    for panel in panels {
        for line in &panel.lines {
            let mean = line.mean;
            let end = |sign: f64| {
                let dots = line.dots.iter().filter(|dot| dot.pooled);
                let end = dots.min_by(|a, b| (sign * a.ratio).total_cmp(&(sign * b.ratio)));
                end.map_or_else(|| "–".into(), ratio_text)
            };
            table.row(vec![
                panel.purpose.title().to_lowercase(),
                mean.backend.clone(),
                line.text.clone(),
                panel.leader.to_owned(),
                grouped(mean.best),
                grouped(mean.tied),
                grouped(mean.meshes - mean.undecided),
                end(1.0),
                end(-1.0),
                grouped(mean.meshes),
            ]);
        }
    }
    table
}

fn csv(panels: &[Panel<'_>]) -> String {
    let rows = panels.iter().flat_map(|panel| {
        let work = panel.purpose.title().to_lowercase();
        panel.lines.iter().flat_map(move |line| {
            let work = work.clone();
            line.dots.iter().map(move |dot| DotRow {
                work: work.clone(),
                backend: &line.mean.backend,
                mesh: dot.mesh,
                compared_with: panel.leader,
                ratio: dot.ratio,
                lower_bound: dot.bound,
                part_of_the_mean: dot.pooled,
            })
        })
    });
    own_columns(rows)
}
