//! Makes `reports/subdivision`: what a subdivision costs on each structure, by each method.
//!
//! `cargo run --release -p report --example subdivision_report -- reports/subdivision [ROUNDS]`
//!
//! Every round runs each scheme, way and structure once at each level, one after the other, on one
//! thread; the table has the medians of thread-CPU time over the rounds, and its figure shows them.

mod opening;

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use report::{Panel, panels};
use serde_json::json;
use sixfold::subdivision::{Scheme, SubdivisionError};
use sixfold::{Creases, PolygonMesh, roster, shapes};
use study::{Clock, Environment, MachineClock, Policy, Refiner, Refining, Way, pages};

/// The schemes of the report; both take the control mesh, of triangles.
const SCHEMES: [Scheme; 2] = [Scheme::CatmullClark, Scheme::Loop];

/// The most levels.
const LEVELS: u32 = 4;

/// A run that takes longer than this, at the level before, is not taken a level further.
const TOO_LONG_NS: f64 = 4e8;

/// What the figures say wherever they were made.
const READING: &str = "
## What it shows

Gathering asks EF and VV at every point: what a soup and an indexed face set have to search for, so that their lines
rise with the size of the mesh. Scattering rescues both: it asks only for what they store, and the face set, which
has next to nothing to build, is then the quickest of all that go by polygons. Of the structures that know their
neighbours, only those on which a walk is dear gain by it. Native steps take the rebuilding away, and with it most of
the time; what is refined into the tables of the run before saves the first touch of new memory as well.
";

/// One line of the figure: a scheme run one way on one structure.
type Line = (&'static str, &'static str, &'static str);

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let folder = words
        .next()
        .ok_or("usage: subdivision_report FOLDER [ROUNDS]")?;
    let rounds = words.next().map_or(Ok(5), |word| word.parse())?;
    let machine = Environment {
        heap: Some(pages::put_in_force(Policy::Kept)),
        ..Environment::here(0, 0.0)
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let polygons = shapes::geodesic(16)?;
    let samples = pool.install(|| measured(&polygons, rounds))?;
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    fs::write(folder.join("README.md"), text(&machine, rounds, &samples)?)?;
    figure(&folder.join("growth.svg"), &samples)?;
    let rows: Vec<_> = samples
        .iter()
        .map(|(&((scheme, way, backend), level), sample)| {
            json!({"scheme": scheme, "way": way, "backend": backend, "level": level,
                   "faces": sample.faces, "cpu_ns": sample.ns})
        })
        .collect();
    let data = json!({"environment": machine, "rounds": rounds, "results": rows});
    let data = serde_json::to_string_pretty(&data)? + "\n";
    fs::write(folder.join("subdivision.json"), data)?;
    Ok(())
}

/// The times of one line at one level.
#[derive(Default)]
struct Sample {
    faces: usize,
    ns: Vec<f64>,
}

impl Sample {
    /// Nanoseconds for each face of the last level: the median.
    fn ns_per_face(&self) -> f64 {
        opening::median(&self.ns) / self.faces as f64
    }
}

type Samples = BTreeMap<(Line, u32), Sample>;

fn measured(polygons: &PolygonMesh, rounds: usize) -> Result<Samples, SubdivisionError> {
    let mut samples = Samples::new();
    let mut jobs: Vec<(Line, u32, Box<dyn Refiner>)> = Vec::new();
    let clock = MachineClock::start();
    for scheme in SCHEMES {
        for way in Way::ALL {
            for backend in roster() {
                let line = (scheme.name(), way.name(), backend.name);
                for level in 1..=LEVELS {
                    let job = Refining::new(scheme, way, level);
                    let ready = job.on(backend.name, polygons, &Creases::default());
                    let Some(Ok(mut refiner)) = ready else { break };
                    let began = clock.now();
                    if refiner.run().is_err() {
                        break;
                    }
                    let time = (clock.now() - began).ns();
                    jobs.push((line, level, refiner));
                    if time > TOO_LONG_NS {
                        break;
                    }
                }
            }
        }
    }
    for _ in 0..rounds {
        for (line, level, refiner) in &mut jobs {
            let began = clock.now();
            refiner.run()?;
            let time = clock.now() - began;
            let sample = samples.entry((*line, *level)).or_default();
            sample.faces = refiner.result().0;
            sample.ns.push(time.ns());
        }
    }
    Ok(samples)
}

fn text(
    machine: &Environment,
    rounds: usize,
    samples: &Samples,
) -> Result<String, std::fmt::Error> {
    let mut text = String::from("# What subdivision costs on each structure\n\n");
    text += &opening::opening(machine, "subdivision_report", "reports/subdivision", rounds);
    text += " Control mesh: a geodesic sphere of 5,120 triangles. Nanoseconds for each face of the last level, all levels made.\n\n";
    text += "`gather` asks for the neighbourhood of each new point, `scatter` makes one pass over the faces; after both the structure is built anew from polygons. `native_fresh` splits the structure's own tables into tables that are allocated for it, `native` into those of the run before.\n\n![Nanoseconds for each new face, by size](growth.svg)\n";
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
            for backend in roster() {
                let line = (scheme.name(), way.name(), backend.name);
                let at = |level| samples.get(&(line, level)).map(Sample::ns_per_face);
                if at(1).is_none() {
                    continue;
                }
                write!(text, "| {way} | {} |", backend.name)?;
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
    text += READING;
    text += "\n–: left out, since the level before took more than 0.4 s, or the structure does not hold the quads.\n";
    Ok(text)
}

/// Time for each new face against the faces of the last level, both logarithmic.
fn figure(path: &Path, samples: &Samples) -> std::io::Result<()> {
    let ways = [Way::Gather, Way::Scatter, Way::Native];
    let line = |scheme: Scheme, way: Way, backend: &'static str| {
        let levels = (1..=LEVELS).filter_map(|level| {
            let name = (scheme.name(), way.name(), backend);
            samples.get(&(name, level))
        });
        let points = levels.map(|sample| (sample.faces as f64, sample.ns_per_face()));
        (backend, points.collect())
    };
    let panel = |(scheme, way): (Scheme, Way)| Panel {
        title: format!("{scheme}, {way}"),
        x_label: "faces of the last level".into(),
        y_label: "ns a face".into(),
        lines: { roster().into_iter() }
            .map(|backend| line(scheme, way, backend.name))
            .collect(),
    };
    let all = SCHEMES.into_iter().flat_map(|s| ways.map(|w| (s, w)));
    let all: Vec<Panel> = all.map(panel).collect();
    let panels = panels("Nanoseconds for each new face, by size", ways.len(), &all);
    fs::write(path, panels)
}
