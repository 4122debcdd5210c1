//! Runs the program `refine`, which reads a case and prints the levels and limits of OpenSubdiv.

use std::env;
use std::fmt::{self, Write as _};
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::str::{FromStr, SplitWhitespace};

use sixfold::subdivision::{Creasing, Subdivision};
use sixfold::{Creases, Point, PolygonMesh, SHARPNESS_INFINITE};

#[derive(Clone)]
pub(crate) struct Case {
    pub(crate) subdivision: Subdivision,
    pub(crate) polygons: PolygonMesh,
    pub(crate) creases: Creases,
    pub(crate) levels: u32,
}

/// Writes the input of `refine`.
impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "scheme {}", self.subdivision.scheme)?;
        writeln!(f, "boundary {}", self.subdivision.boundary.name())?;
        writeln!(f, "creasing {}", self.subdivision.creasing.name())?;
        writeln!(f, "levels {}", self.levels)?;
        writeln!(f, "limit")?;
        for p in self.polygons.positions() {
            writeln!(f, "v {} {} {}", p.x, p.y, p.z)?;
        }
        for (_, face) in self.polygons.faces().iter() {
            let corners: Vec<String> = face.iter().map(|v| v.index().to_string()).collect();
            writeln!(f, "f {}", corners.join(" "))?;
        }
        for &(ends, sharpness) in self.creases.edges() {
            let [a, b] = ends.ends().map(|v| v.index());
            writeln!(f, "edge {a} {b} {sharpness}")?;
        }
        for &(v, sharpness) in self.creases.corners() {
            writeln!(f, "corner {} {sharpness}", v.index())?;
        }
        Ok(())
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_char('\n')?;
        fmt::Display::fmt(self, f)
    }
}

/// The result of OpenSubdiv for a case, with the numbering of OpenSubdiv.
pub(crate) struct Answer {
    /// The levels, starting with the control mesh.
    pub(crate) levels: Vec<Level>,
    /// The limit position and two tangents of each vertex of the last level.
    pub(crate) limits: Vec<[Point; 3]>,
}

/// A mesh with its sharp edges and vertices.
#[derive(Default)]
pub(crate) struct Level {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) faces: Vec<Face>,
    /// Sharp edges, including boundary edges. The maximum sharpness is [`SHARPNESS_INFINITE`].
    pub(crate) edges: Vec<([usize; 2], f32)>,
    pub(crate) corners: Vec<(usize, f32)>,
}

pub(crate) struct Vertex {
    pub(crate) at: Point,
    /// `smooth`, `dart`, `crease` or `corner`.
    pub(crate) rule: String,
    pub(crate) origin: Origin,
}

/// The element of the previous level from which a vertex comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    Given(usize),
    Vertex(usize),
    Edge([usize; 2]),
    Face(usize),
}

pub(crate) struct Face {
    pub(crate) is_hole: bool,
    pub(crate) corners: Vec<usize>,
}

pub(crate) struct Reference(PathBuf);

impl Reference {
    /// Returns the program from the variable `SIXFOLD_OPENSUBDIV`, or `None` if the variable is not
    /// set.
    pub(crate) fn from_env() -> Option<Self> {
        let program = env::var_os("SIXFOLD_OPENSUBDIV").map(|program| Self(program.into()));
        if program.is_none() {
            eprintln!("not compared with OpenSubdiv: SIXFOLD_OPENSUBDIV is not set");
        }
        program
    }

    pub(crate) fn answer(&self, case: &Case) -> Answer {
        let child = Command::new(&self.0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let mut child = child.unwrap_or_else(|error| panic!("{}: {error}", self.0.display()));
        // `drop` closes the pipe. The program reads all input before it prints.
        let text = case.to_string();
        let mut input = child.stdin.take().expect("a pipe");
        input.write_all(text.as_bytes()).expect("the program reads");
        drop(input);
        let output = child.wait_with_output().expect("the program ends");
        assert!(output.status.success(), "{}", output.status);
        let text = String::from_utf8(output.stdout).expect("plain text");
        let mut answer = Answer {
            levels: Vec::new(),
            limits: Vec::new(),
        };
        for line in text.lines() {
            answer.read(line);
        }
        assert_eq!(answer.levels.len(), case.levels as usize + 1, "{text}");
        answer
    }
}

impl Answer {
    fn read(&mut self, line: &str) {
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        match keyword {
            "level" => self.levels.push(Level::default()),
            "limit" => {}
            "p" => self.limits.push([0, 1, 2].map(|_| point(&mut words))),
            _ => {
                let level = self.levels.last_mut();
                let level = level.unwrap_or_else(|| panic!("line before the first level: {line}"));
                level.read(keyword, &mut words);
            }
        }
    }
}

impl Level {
    fn read(&mut self, keyword: &str, words: &mut SplitWhitespace<'_>) {
        match keyword {
            "v" => {
                let (at, rule) = (point(words), next(words));
                let origin = match next::<String>(words).as_str() {
                    "given" => Origin::Given(next(words)),
                    "vertex" => Origin::Vertex(next(words)),
                    "edge" => Origin::Edge([next(words), next(words)]),
                    "face" => Origin::Face(next(words)),
                    other => panic!("unknown origin {other}"),
                };
                self.vertices.push(Vertex { at, rule, origin });
            }
            "f" | "hole" => self.faces.push(Face {
                is_hole: keyword == "hole",
                corners: words.map(|word| word.parse().expect("a vertex")).collect(),
            }),
            "edge" => {
                let ends = [next(words), next(words)];
                self.edges.push((ends, next(words)));
            }
            "corner" => self.corners.push((next(words), next(words))),
            other => panic!("unknown line keyword {other}"),
        }
    }

    /// Returns whether the next step with Chaikin creases cannot be compared with OpenSubdiv:
    ///
    /// - An edge has sharpness above 1, and one of its halves is not sharp. OpenSubdiv then
    ///   extrapolates beyond the midpoint. The masks of OpenSubdiv and Sixfold make a full crease.
    /// - The sharpness of a half is close to zero. Then rounding determines whether the half is
    ///   sharp, because the programs add numbers in different orders.
    pub(crate) fn is_incomparable(&self, creasing: Creasing) -> bool {
        creasing == Creasing::Chaikin
            && self.semi_sharp().any(|(ends, s)| {
                let halves = ends.map(|v| self.half(v, ends, s));
                let near_zero = |&half: &f64| half != 0.0 && half.abs() < 1e-6;
                halves.iter().any(near_zero) || s > 1.0 && halves.iter().any(|&half| half <= 0.0)
            })
    }

    fn semi_sharp(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        let edges = self.edges.iter().filter(|&&(_, s)| s < SHARPNESS_INFINITE);
        edges.map(|&(ends, s)| (ends, f64::from(s)))
    }

    /// Returns the sharpness of the half of an edge at `v`, before negative values are set to zero.
    fn half(&self, v: usize, edge: [usize; 2], sharpness: f64) -> f64 {
        let at = self.semi_sharp().filter(|(ends, _)| ends.contains(&v));
        let others: Vec<f64> = at
            .filter(|&(ends, _)| ends != edge)
            .map(|(_, s)| s)
            .collect();
        if others.is_empty() {
            return sharpness - 1.0;
        }
        let mean = others.iter().sum::<f64>() / others.len() as f64;
        0.75 * sharpness + 0.25 * mean - 1.0
    }
}

fn next<T: FromStr>(words: &mut SplitWhitespace<'_>) -> T {
    let word = words.next().unwrap_or_default();
    word.parse()
        .unwrap_or_else(|_| panic!("{word:?} does not follow the format in README.md"))
}

fn point(words: &mut SplitWhitespace<'_>) -> Point {
    let [x, y, z] = [0, 1, 2].map(|_| next(words));
    Point::new(x, y, z)
}
