//! Makes `reports/subdivision`: the time of subdivision on each structure, by each method.
//!
//! ```text
//! cargo run --release -p sixfold-report --example subdivision_report -- reports/subdivision
//! ```
//!
//! The optional last argument is the number of launches (5 without it), or `--draw`: this only writes the
//! text and the figure again, from the data in the folder.
//!
//! Every launch runs each scheme, method and structure at each level three times, on one thread. The table
//! and the figure show medians of thread-CPU time over the launches.

mod common;

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use common::{Data, Row};
use serde::{Deserialize, Serialize};
use sixfold::subdivision::{Scheme, SubdivisionError};
use sixfold::{Creases, PolygonMesh, shapes};
use sixfold_report::{Panel, panels};
use sixfold_study::{Backend, Clock, MachineClock, Refiner, SubdivisionJob, Way};

/// The schemes of the report. Both accept triangles.
const SCHEMES: [Scheme; 2] = [Scheme::CatmullClark, Scheme::Loop];

/// Name of the file with all samples.
const DATA: &str = "subdivision.json";

/// Number of rounds of a launch.
const ROUNDS: usize = 3;

/// Largest level.
const LEVELS: u32 = 4;

/// Maximum time of a run before the next level is left out, in nanoseconds.
const MAX_RUN_NS: f64 = 4e8;

/// Conclusions that hold on every machine.
const CONCLUSIONS: &str = "
## What it shows

The method `gather` queries the relations EF (faces of an edge) and VV (neighbours of a vertex) for every new point. A
polygon soup and an indexed face set must search all faces for the answers, so their time per new face grows with the
size of the mesh. The method `scatter` avoids the searches, because `scatter` uses only relations that every structure
stores. Both methods build the structure again. The indexed face set is the fastest structure with `scatter`. The
methods `native_fresh` and `native` do not build the structure again. For half-edge, winged-edge and corner table, both
are faster than `gather` and `scatter` at every level.
";

/// A scheme, a method and a structure, at one level.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
struct Line {
    scheme: String,
    way: String,
    backend: String,
    level: u32,
    /// The number of faces of the level.
    faces: usize,
}

impl Line {
    fn is(&self, scheme: Scheme, way: Way, backend: &str) -> bool {
        (&*self.scheme, &*self.way, &*self.backend) == (scheme.name(), way.name(), backend)
    }
}

/// Returns the median time per face in nanoseconds.
fn ns_per_face(row: &Row<Line>) -> f64 {
    row.ns() / row.what.faces as f64
}

/// Times of the rounds in nanoseconds.
type Samples = BTreeMap<Line, Vec<f64>>;

fn main() -> Result<(), Box<dyn Error>> {
    let measure_all = || {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        let polygons = shapes::geodesic(16)?;
        Ok(pool.install(|| measure(&polygons))?)
    };
    common::run(DATA, ROUNDS, measure_all, draw)
}

fn measure(polygons: &PolygonMesh) -> Result<Samples, SubdivisionError> {
    let mut samples = Samples::new();
    let mut jobs: Vec<(Line, Box<dyn Refiner>)> = Vec::new();
    let clock = MachineClock::start();
    for scheme in SCHEMES {
        for way in Way::ALL {
            for backend in Backend::structures() {
                for level in 1..=LEVELS {
                    let job = SubdivisionJob::new(scheme, way, level);
                    let ready = job.prepare(&backend, polygons, &Creases::default());
                    let Some(Ok(mut refiner)) = ready else { break };
                    let start = clock.now();
                    if refiner.run().is_err() {
                        break;
                    }
                    let time = (clock.now() - start).ns();
                    let line = Line {
                        scheme: scheme.name().into(),
                        way: way.name().into(),
                        backend: backend.name().into(),
                        level,
                        faces: refiner.result().0,
                    };
                    jobs.push((line, refiner));
                    if time > MAX_RUN_NS {
                        break;
                    }
                }
            }
        }
    }
    for _ in 0..ROUNDS {
        for (line, refiner) in &mut jobs {
            let start = clock.now();
            refiner.run()?;
            let time = clock.now() - start;
            samples.entry(line.clone()).or_default().push(time.ns());
        }
    }
    Ok(samples)
}

fn text(data: &Data<Line>) -> Result<String, std::fmt::Error> {
    let mut text = String::from("# Cost of subdivision on each structure\n\n");
    text += &data.introduction("subdivision_report", "reports/subdivision");
    let rows = &data.results;
    text += " The control mesh is a geodesic sphere of 5,120 triangles. A time is for all levels up to the level in the head of the column, in nanoseconds per face of this level.\n\n";
    text += "`gather` queries the neighbourhood of each new point, and `scatter` makes one pass over the faces. After `gather` and `scatter`, the structure is built again from polygons. `native_fresh` and `native` split the structure's own tables: `native_fresh` writes the result into newly allocated tables, and `native` writes the result into the tables of the previous run. The sign – means that the level was not measured: the previous level took more than 0.4 s, or the structure cannot hold quads.\n\n![Nanoseconds per new face, by size](growth.svg)\n";
    for scheme in SCHEMES {
        writeln!(text, "\n## {scheme}\n")?;
        let mut head = String::from("| | structure |");
        let mut rule = String::from("|---|---|");
        for level in 1..=LEVELS {
            write!(head, " level {level} |")?;
            rule += "---:|";
        }
        writeln!(text, "{head}\n{rule}")?;
        for way in Way::ALL {
            for backend in Backend::structures() {
                let is = |row: &&Row<Line>, level| {
                    row.what.level == level && row.what.is(scheme, way, backend.name())
                };
                let at = |level| rows.iter().find(|row| is(row, level)).map(ns_per_face);
                if at(1).is_none() {
                    continue;
                }
                write!(text, "| {way} | {} |", backend.name())?;
                for level in 1..=LEVELS {
                    match at(level) {
                        Some(ns) if ns >= 1000.0 => write!(text, " {ns:.0} |")?,
                        Some(ns) => write!(text, " {ns:.1} |")?,
                        None => text += " – |",
                    }
                }
                text.push('\n');
            }
        }
    }
    text += CONCLUSIONS;
    Ok(text)
}

/// Writes the text, and draws the time per new face over the number of faces.
fn draw(folder: &Path, data: &Data<Line>) -> Result<(), Box<dyn Error>> {
    fs::write(folder.join("README.md"), text(data)?)?;
    let ways = [Way::Gather, Way::Scatter, Way::Native];
    let line = |scheme: Scheme, way: Way, backend: &'static str| {
        let rows = data.results.iter();
        let rows = rows.filter(|row| row.what.is(scheme, way, backend));
        let points = rows.map(|row| (row.what.faces as f64, ns_per_face(row)));
        (backend, points.collect())
    };
    let panel = |(scheme, way): (Scheme, Way)| Panel {
        title: format!("{scheme}, {way}"),
        x_label: "faces of the last level".into(),
        y_label: "ns per face".into(),
        lines: Backend::structures()
            .into_iter()
            .map(|backend| line(scheme, way, backend.name()))
            .collect(),
    };
    let all = SCHEMES.into_iter().flat_map(|s| ways.map(|w| (s, w)));
    let all: Vec<Panel> = all.map(panel).collect();
    let svg = panels(
        "Nanoseconds per new face, by size",
        "Each panel is a scheme and a method; a line is a structure.",
        ways.len(),
        &all,
    );
    fs::write(folder.join("growth.svg"), svg)?;
    Ok(())
}
