//! Turns a recorded run of a program into a workload.

use std::collections::HashSet;

use sixfold::{Edit, PolygonMesh, Relation};

use crate::mix::Route;
use crate::workload::{Access, Action, Amount, Part, Workload};
use sixfold_measure::{Asked, ElementKind, Op, TapedRun, Trace};
use sixfold_results::OwnData;

/// The number of elements of a cache line in the model of a cache: each element has 16 bytes.
const PER_LINE: u32 = 4;
/// The number of sets of the model of a cache, and of lines in each set: 32 KB.
const SETS: usize = 64;
const WAYS: usize = 8;

/// The greatest number of visits from which the order of access is found.
const MAX_VISITS: usize = 1 << 20;

/// What one run of a program asks.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The number of calls of each kind.
    pub asked: Asked,
    /// The program as a workload. Its weights are the numbers of calls in one run.
    pub workload: Workload,
    /// The order in which the program visits vertices, edges and faces.
    pub visits: [Visits; 3],
    /// The calls, in order.
    pub trace: Trace,
}

/// The order in which a program visits the elements of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Visits {
    /// The number of visits, at most 1,048,576.
    pub count: usize,
    /// The number of different elements visited: the working set.
    pub elements: usize,
    /// The median distance between the numbers of successive elements. The number of an edge is
    /// that of its first end.
    pub jump: u32,
    /// The share of visits that miss a cache of 32 KB, if each element has 16 bytes.
    pub misses: f64,
}

impl Recording {
    /// Turns `run`, a run on `polygons`, into a workload. O(calls log calls).
    pub fn new(run: TapedRun, polygons: &PolygonMesh) -> Self {
        let asked = run.asked;
        let actions = actions(&run, &asked, polygons);
        let operations: f64 = actions.iter().map(|(_, count)| count).sum();
        let sequences = sequences(&run);
        let visits = sequences.each_ref().map(|sequence| Visits::of(sequence));
        let name = run.trace.program.clone();
        let parts = actions.iter().map(|&(action, count)| Part {
            action,
            weight: Amount::Number(count.round()),
        });
        let workload = Workload {
            summary: format!("One run of the program {name}, recorded."),
            name,
            access: access(&visits, polygons),
            operations: Amount::Per(
                operations / polygons.face_count().max(1) as f64,
                ElementKind::Face,
            ),
            rebuilds: 0,
            own_ns: 0.0,
            own_data: OwnData::default(),
            mix: parts.filter(|part| part.weight.number() > 0.0).collect(),
        };
        Self {
            asked,
            workload,
            visits,
            trace: run.trace,
        }
    }

    /// Returns the workload as a file for `sixfold pick --workload`.
    pub fn workload_file(&self) -> String {
        let workload = &self.workload;
        let mut lines = vec![
            format!(
                "summary = \"{}\"",
                workload.summary.replace(is_special, "'")
            ),
            format!("access = \"{}\"", workload.access),
            format!("operations = \"{}\"", workload.operations),
            match workload.own_ns {
                0.0 => "own_ns = 0.0 # below what can be measured".to_owned(),
                own_ns => format!("own_ns = {own_ns:?}"),
            },
            String::new(),
        ];
        for (kind, visits) in ElementKind::ALL.into_iter().zip(&self.visits) {
            if visits.count > 0 {
                lines.push(format!(
                    "# {}: {} visits to {} elements; median jump {}; {:.0} % miss 32 KB",
                    kind.name(),
                    visits.count,
                    visits.elements,
                    visits.jump,
                    100.0 * visits.misses
                ));
            }
        }
        lines.push("[mix]".into());
        for part in &workload.mix {
            lines.push(format!("{} = {}", part.action, part.weight.number()));
        }
        lines.join("\n") + "\n"
    }
}

/// Returns whether a text in quotes must not contain `c`.
fn is_special(c: char) -> bool {
    c.is_control() || matches!(c, '"' | '\\')
}

/// Returns the operations of a mix that do what the run asked, with their numbers.
///
/// If the program reads the positions of the results of a query, the query and the positions are one
/// operation, such as `corner_positions`.
fn actions(run: &TapedRun, asked: &Asked, polygons: &PolygonMesh) -> Vec<(Action, f64)> {
    let mut actions = Vec::new();
    let mut positions = asked.positions as f64;
    for relation in Relation::ALL {
        let place = relation as usize;
        let queries = asked.relations[place] as f64;
        let together = match relation {
            Relation::VertexVertices => Some(Action::NeighbourPositions),
            Relation::EdgeVertices => Some(Action::EndPositions),
            Relation::FaceVertices => Some(Action::CornerPositions),
            _ => None,
        };
        let mut alone = queries;
        if let Some(action) = together
            && run.yielded[place] > 0
        {
            let per_query = run.yielded[place] as f64 / queries;
            let read = run.positions_of[place] as f64;
            let count = (read / per_query).min(queries);
            actions.push((action, count));
            alone -= count;
            positions -= count * per_query;
        }
        actions.push((Action::Relation(relation), alone));
    }
    actions.push((Action::Position, positions.max(0.0)));
    let calls = run.trace.calls.iter();
    let moves = calls.filter(|call| call.op == Op::SetPositions).count();
    let moved = moves * polygons.vertex_count();
    for edit in Edit::ALL {
        let count = asked.edits[edit as usize] as f64;
        match edit {
            Edit::SetPosition => actions.push((Action::SetPosition, count + moved as f64)),
            edit => {
                let action = edit.name().parse::<Action>();
                actions.extend(action.ok().map(|action| (action, count)));
            }
        }
    }
    actions.retain(|&(_, count)| count.round() > 0.0);
    actions.sort_by(|a, b| b.1.total_cmp(&a.1));
    actions
}

/// Returns the numbers of the elements that the program visits, by kind. Leaves out positions of the
/// results of the last query, and visits to the element that was visited last.
fn sequences(run: &TapedRun) -> [Vec<u32>; 3] {
    let mut sequences: [Vec<u32>; 3] = Default::default();
    let mut of_results = run.of_results.iter().peekable();
    for (nth, call) in run.trace.calls.iter().enumerate() {
        let is_of_result = of_results.next_if_eq(&&nth).is_some();
        let kind = match call.op {
            Op::Query(relation) => ElementKind::queried_by(relation),
            Op::Position if !is_of_result => ElementKind::Vertex,
            _ => continue,
        };
        let sequence = &mut sequences[kind.index()];
        if sequence.len() < MAX_VISITS && sequence.last() != Some(&call.name[0]) {
            sequence.push(call.name[0]);
        }
    }
    sequences
}

impl Visits {
    fn of(sequence: &[u32]) -> Self {
        let mut jumps: Vec<u32> = sequence.windows(2).map(|w| w[0].abs_diff(w[1])).collect();
        jumps.sort_unstable();
        Self {
            count: sequence.len(),
            elements: sequence.iter().collect::<HashSet<_>>().len(),
            jump: jumps.get(jumps.len() / 2).copied().unwrap_or(0),
            misses: misses(sequence),
        }
    }
}

/// Returns the share of visits that miss a small cache with sets of lines, of which the one used
/// least recently is replaced.
fn misses(sequence: &[u32]) -> f64 {
    let mut sets = vec![[u32::MAX; WAYS]; SETS];
    let mut missed = 0_usize;
    for &element in sequence {
        let line = element / PER_LINE;
        let set = &mut sets[line as usize % SETS];
        let place = set.iter().position(|&cached| cached == line);
        missed += usize::from(place.is_none());
        set[..=place.unwrap_or(WAYS - 1)].rotate_right(1);
        set[0] = line;
    }
    missed as f64 / sequence.len().max(1) as f64
}

/// Returns the access order that misses the small cache most nearly as often as the program does.
fn access(visits: &[Visits; 3], polygons: &PolygonMesh) -> Access {
    let distance = |access: &Access| {
        let route = Route::new(*access, polygons, 1);
        let numbers = route.numbers(polygons);
        let of_kind = |kind: usize| {
            if visits[kind].count == 0 {
                return 0.0;
            }
            let sequence = &numbers[kind][..numbers[kind].len().min(MAX_VISITS)];
            let both = [misses(sequence), visits[kind].misses].map(|m| (m + 0.01).ln());
            visits[kind].count as f64 * (both[0] - both[1]).abs()
        };
        (0..3).map(of_kind).sum::<f64>()
    };
    let distances = Access::ALL.map(|access| (access, distance(&access)));
    let nearest = distances.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map_or(Access::Sequential, |(access, _)| access)
}

#[cfg(test)]
mod tests {
    use sixfold::{FaceVertexMesh, MeshMove, MeshQuery, Representation, shapes};

    use super::*;
    use sixfold_measure::Recorded;

    fn recording(polygons: &PolygonMesh, run: impl Fn(&Recorded<FaceVertexMesh>)) -> Recording {
        let mut mesh = Recorded::<FaceVertexMesh>::from_polygons(polygons).expect("held");
        mesh.start_trace(polygons);
        run(&mesh);
        let taped = mesh.take_tape("test").expect("few calls");
        Recording::new(taped, polygons)
    }

    fn mix(recording: &Recording) -> Vec<(String, f64)> {
        let parts = recording.workload.mix.iter();
        parts
            .map(|part| (part.action.to_string(), part.weight.number()))
            .collect()
    }

    #[test]
    fn positions_of_results_are_part_of_the_query() {
        let torus = shapes::triangle_torus(40, 30).expect("small");
        let recording = recording(&torus, |mesh| {
            for f in mesh.faces() {
                for v in mesh.face_vertices(f) {
                    mesh.position(v);
                }
            }
            for v in mesh.vertices() {
                mesh.vertex_faces(v).count();
                mesh.position(v);
            }
        });
        let expected = [
            ("corner_positions", 2400.0),
            ("vertex_faces", 1200.0),
            ("position", 1200.0),
        ];
        assert_eq!(
            mix(&recording),
            expected.map(|(name, count)| (name.to_owned(), count))
        );
        assert_eq!(
            recording.workload.operations,
            Amount::Per(2.0, ElementKind::Face)
        );
        assert_eq!(recording.workload.access, Access::Sequential);
        let faces = recording.visits[2];
        assert_eq!((faces.count, faces.elements, faces.jump), (2400, 2400, 1));
        assert_eq!(faces.misses, 0.25, "four elements share a line");
        let file = recording.workload_file();
        let mut back = Workload::parse("test", "test.toml", &file).expect(&file);
        assert_eq!(back.operations.to_string(), "2 per face");
        back.operations = recording.workload.operations;
        assert_eq!(back, recording.workload);
    }

    #[test]
    fn the_access_order_is_found() {
        let torus = shapes::triangle_torus(200, 150).expect("small");
        let walk = |access: Access| {
            let route = Route::new(access, &torus, 7);
            recording(&torus, |mesh| {
                for &v in &route.vertices {
                    mesh.vertex_vertices(v).count();
                }
                for &f in &route.faces {
                    mesh.face_faces(f).count();
                }
            })
        };
        for expected in [
            Access::Random,
            Access::Front,
            Access::ByFace,
            Access::Patches,
        ] {
            assert_eq!(walk(expected).workload.access, expected);
        }
    }

    #[test]
    fn moves_and_edits_are_counted() {
        let torus = shapes::triangle_torus(40, 30).expect("small");
        let mut mesh = Recorded::<FaceVertexMesh>::from_polygons(&torus).expect("held");
        mesh.start_trace(&torus);
        let mut positions = mesh.vertex_map(sixfold::Point::ZERO);
        for v in mesh.vertices() {
            positions[v] = mesh.position(v);
        }
        mesh.set_positions(&positions)
            .expect("as many positions as vertices");
        let taped = mesh.take_tape("test").expect("few calls");
        let recording = Recording::new(taped, &torus);
        let expected = [("position", 1200.0), ("set_position", 1200.0)];
        assert_eq!(
            mix(&recording),
            expected.map(|(name, count)| (name.to_owned(), count))
        );
    }
}
