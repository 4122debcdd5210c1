//! The operations as Sixfold defines them, written once for all libraries.

use std::collections::{HashSet, VecDeque};
use std::hint::black_box;
use std::time::{Duration, Instant};

use cpu_time::ThreadTime;

use crate::{Column, Input, Response};

type Vector = [f32; 3];

/// A structure and the results of operations.
pub(crate) struct Runner<C> {
    input: Input,
    structure: C,
    face_values: Vec<Vector>,
    vertex_values: Vec<Vector>,
}

/// The checksum of one run, and the number of visited elements.
type RunResult = (f64, u64);

/// Counts results and adds their numbers, so that the compiler cannot omit a result.
#[derive(Default)]
struct Sink {
    count: u64,
    sum: usize,
}

impl Sink {
    fn add(&mut self, index: usize) {
        self.count += 1;
        self.sum = self.sum.wrapping_add(index);
    }

    fn count(self) -> u64 {
        black_box(self.sum);
        self.count
    }
}

/// Queries one relation of each element.
macro_rules! query_all {
    ($structure:expr, $elements:ident, $relation:ident, $index:ident) => {{
        let (mut sink, mut elements) = (Sink::default(), 0);
        for element in $structure.$elements() {
            elements += 1;
            $structure.$relation(element, |other| sink.add($structure.$index(other)));
        }
        (sink.count(), elements)
    }};
}

impl<C: Column> Runner<C> {
    /// Makes a runner. Returns an error if the structure does not represent the mesh correctly.
    pub(crate) fn new(input: Input, structure: C) -> Result<Self, String> {
        let runner = Self {
            face_values: vec![[0.0; 3]; input.starts.len() - 1],
            vertex_values: input.positions.clone(),
            input,
            structure,
        };
        runner.check()?;
        Ok(runner)
    }

    fn check(&self) -> Result<(), String> {
        let mut sides = HashSet::new();
        for face in self.input.faces() {
            let nexts = face.iter().cycle().skip(1);
            sides.extend(face.iter().zip(nexts).map(|(a, b)| (a.min(b), a.max(b))));
        }
        let [vertices, faces] = [self.input.positions.len(), self.face_values.len()];
        let [corners, edges] = [self.input.corners.len(), sides.len()];
        for (relation, answers, elements) in [
            ("vertex_vertices", 2 * edges, vertices),
            ("vertex_edges", 2 * edges, vertices),
            ("vertex_faces", corners, vertices),
            ("edge_faces", corners, edges),
            ("face_vertices", corners, faces),
            ("face_edges", corners, faces),
        ] {
            let found = self
                .query_relation(relation)
                .ok_or("a relation is missing")?;
            if found != (answers as u64, elements as u64) {
                let (wrong, of) = found;
                return Err(format!(
                    "it accepted the mesh, but {relation} has {wrong} results for {of} elements, expected {answers} for {elements}"
                ));
            }
        }
        for f in self.structure.faces() {
            let (mut distinct, mut count) = (HashSet::new(), 0);
            self.structure.face_faces(f, |g| {
                distinct.insert(self.structure.face_index(g));
                count += 1;
            });
            if distinct.len() != count {
                return Err("it returns a face twice if two faces share more than one edge".into());
            }
        }
        Ok(())
    }

    /// Runs `operation` as often as `times` requests. Returns `None` if the operation is unknown.
    pub(crate) fn run(&mut self, operation: &str, times: u64) -> Option<Response> {
        let (mut wall, mut cpu) = (Duration::ZERO, Duration::ZERO);
        let mut found = None;
        // An operation that moves positions is timed in single runs, with an untimed reset between
        // runs. All runs of another operation are timed together, because reading the clocks takes
        // as
        // long as a run on a small mesh.
        let moves = operation == "vv_smooth";
        let (batches, runs) = if moves { (times, 1) } else { (1, times) };
        for _ in 0..batches {
            let start = (Instant::now(), ThreadTime::now());
            for _ in 0..runs {
                found = Some(self.run_once(operation)?);
            }
            cpu += start.1.elapsed();
            wall += start.0.elapsed();
            if moves {
                self.structure.set_positions(&self.input.positions);
            }
        }
        let (checksum, elements) = found?;
        Some(Response {
            wall_ns: wall.as_nanos(),
            cpu_ns: cpu.as_nanos(),
            checksum,
            elements,
        })
    }

    fn run_once(&mut self, operation: &str) -> Option<RunResult> {
        Some(match operation {
            "build" => {
                let built = C::build(&self.input).ok()?;
                let faces = built.faces().count() as u64;
                let all = built.vertices().count() as u64 + faces;
                black_box(built);
                (all as f64, faces)
            }
            "circulate" => {
                let (faces, _) = self.query_relation("vertex_faces")?;
                let (corners, _) = self.query_relation("face_vertices")?;
                ((faces + corners) as f64, faces + corners)
            }
            "all_queries" => {
                const ALL: [&str; 9] = [
                    "vertex_vertices",
                    "vertex_edges",
                    "vertex_faces",
                    "edge_vertices",
                    "edge_edges",
                    "edge_faces",
                    "face_vertices",
                    "face_edges",
                    "face_faces",
                ];
                let mut all = 0;
                for relation in ALL {
                    all += self.query_relation(relation)?.0;
                }
                (all as f64, all)
            }
            "face_barycenter" => self.face_barycenter(),
            "vertex_normal" => self.vertex_normal(),
            "vv_smooth" => self.vv_smooth(),
            "edge_length" => self.edge_length(),
            "boundary" => self.boundary(),
            "ff_bfs" => self.ff_bfs(),
            relation => {
                let (count, elements) = self.query_relation(relation)?;
                (count as f64, elements)
            }
        })
    }

    /// Queries one relation of every element. Returns the numbers of results and of elements.
    fn query_relation(&self, relation: &str) -> Option<(u64, u64)> {
        let structure = &self.structure;
        Some(match relation {
            "vertex_vertices" => query_all!(structure, vertices, vertex_vertices, vertex_index),
            "vertex_edges" => query_all!(structure, vertices, vertex_edges, edge_index),
            "vertex_faces" => query_all!(structure, vertices, vertex_faces, face_index),
            "edge_vertices" => {
                let (mut sink, mut elements) = (Sink::default(), 0);
                for edge in structure.edges() {
                    elements += 1;
                    for v in structure.edge_vertices(edge) {
                        sink.add(structure.vertex_index(v));
                    }
                }
                (sink.count(), elements)
            }
            "edge_edges" => query_all!(structure, edges, edge_edges, edge_index),
            "edge_faces" => query_all!(structure, edges, edge_faces, face_index),
            "face_vertices" => query_all!(structure, faces, face_vertices, vertex_index),
            "face_edges" => query_all!(structure, faces, face_edges, edge_index),
            "face_faces" => query_all!(structure, faces, face_faces, face_index),
            _ => return None,
        })
    }

    fn face_barycenter(&mut self) -> RunResult {
        let structure = &self.structure;
        for f in structure.faces() {
            let (mut sum, mut corners) = ([0.0; 3], 0_u32);
            structure.face_vertices(f, |v| {
                sum = plus(sum, structure.position(v));
                corners += 1;
            });
            self.face_values[structure.face_index(f)] = sum.map(|x| x * (1.0 / corners as f32));
        }
        (field_sum(&self.face_values), self.face_values.len() as u64)
    }

    fn vertex_normal(&mut self) -> RunResult {
        let structure = &self.structure;
        for f in structure.faces() {
            let [mut first, mut last, mut normal] = [[0.0; 3]; 3];
            let mut seen = 0;
            structure.face_vertices(f, |v| {
                let position = structure.position(v);
                match seen {
                    0 => first = position,
                    1 => {}
                    _ => {
                        let sides = [last, position].map(|corner| minus(corner, first));
                        normal = plus(normal, cross(sides[0], sides[1]));
                    }
                }
                last = position;
                seen += 1;
            });
            self.face_values[structure.face_index(f)] = normal;
        }
        for v in structure.vertices() {
            let mut sum = [0.0; 3];
            structure.vertex_faces(v, |f| {
                sum = plus(sum, self.face_values[structure.face_index(f)])
            });
            let length = sum.map(|x| x * x).iter().sum::<f32>().sqrt();
            let by = if length > 0.0 { 1.0 / length } else { 1.0 };
            self.vertex_values[structure.vertex_index(v)] = sum.map(|x| x * by);
        }
        (
            field_sum(&self.vertex_values),
            self.vertex_values.len() as u64,
        )
    }

    fn vv_smooth(&mut self) -> RunResult {
        let structure = &self.structure;
        for v in structure.vertices() {
            let (mut sum, mut valence) = ([0.0; 3], 0_u32);
            structure.vertex_vertices(v, |w| {
                sum = plus(sum, structure.position(w));
                valence += 1;
            });
            self.vertex_values[structure.vertex_index(v)] = match valence {
                0 => structure.position(v),
                _ => sum.map(|x| x * (1.0 / valence as f32)),
            };
        }
        self.structure.set_positions(&self.vertex_values);
        (
            field_sum(&self.vertex_values),
            self.vertex_values.len() as u64,
        )
    }

    fn edge_length(&self) -> RunResult {
        let structure = &self.structure;
        let (mut sum, mut edges) = (0.0, 0);
        for e in structure.edges() {
            let [a, b] = structure.edge_vertices(e).map(|v| structure.position(v));
            let squares = minus(a, b).map(|x| x * x);
            sum += f64::from(squares.iter().sum::<f32>().sqrt());
            edges += 1;
        }
        (sum, edges)
    }

    fn boundary(&self) -> RunResult {
        let structure = &self.structure;
        let (mut boundary, mut edges) = (0_u64, 0);
        for e in structure.edges() {
            let mut faces = 0;
            structure.edge_faces(e, |_| faces += 1);
            boundary += u64::from(faces == 1);
            edges += 1;
        }
        (boundary as f64, edges)
    }

    /// Traverses the faces breadth first. Each traversal starts at the lowest unvisited face.
    fn ff_bfs(&self) -> RunResult {
        let structure = &self.structure;
        let faces: Vec<C::Face> = structure.faces().collect();
        let mut depths = vec![u32::MAX; faces.len()];
        let mut queue = VecDeque::new();
        let mut sum = 0;
        for &seed in &faces {
            if depths[structure.face_index(seed)] != u32::MAX {
                continue;
            }
            depths[structure.face_index(seed)] = 0;
            queue.push_back(seed);
            while let Some(f) = queue.pop_front() {
                let depth = depths[structure.face_index(f)];
                sum += u64::from(depth);
                structure.face_faces(f, |g| {
                    let entry = &mut depths[structure.face_index(g)];
                    if *entry == u32::MAX {
                        *entry = depth + 1;
                        queue.push_back(g);
                    }
                });
            }
        }
        (sum as f64, faces.len() as u64)
    }
}

fn field_sum(points: &[Vector]) -> f64 {
    let weighted_norm = |[x, y, z]: &Vector| {
        f64::from(x.abs()) + 2.0 * f64::from(y.abs()) + 3.0 * f64::from(z.abs())
    };
    points.iter().map(weighted_norm).sum()
}

fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
