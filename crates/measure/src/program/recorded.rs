//! A structure that counts what a program asks.

use std::cmp::Reverse;
use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::tape::{Ordered, Tape, TapeState, TapedRun, UseOfNames, Watched, order_of};
use sixfold_results::AskedCount;

use crate::operation::ElementKind;
use crate::trace::{Trace, TracedEdit};
use sixfold::{
    BuildError, Capabilities, Edit, EditLog, EditRecord, FaceId, Handle, InvariantError,
    MemoryFootprint, MeshEdit, MeshMove, MeshQuery, MoveError, OrientedWalk, Point, PolygonMesh,
    QueryCost, Refusal, Relation, Representation, VertexId, VertexMap,
};
use sixfold_core::{EditCall, EditOf};

/// How often a program asks each relation, reads positions and edits, in one run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Asked {
    /// The number of queries of each relation, in the order of [`Relation::ALL`].
    pub relations: [u64; 9],
    /// The number of positions read.
    pub positions: u64,
    /// The number of steps along sides: next, previous and twin side.
    pub steps: u64,
    /// The number of edits of each kind, in the order of [`Edit::ALL`]. Refused edits count.
    pub edits: [u64; Edit::ALL.len()],
}

impl Asked {
    /// Returns the names and the counts of what was asked at least once, the most frequent first.
    pub fn counts(&self) -> Vec<AskedCount> {
        let relations = Relation::ALL
            .map(Relation::name)
            .into_iter()
            .zip(self.relations);
        let edits = Edit::ALL.map(Edit::name).into_iter().zip(self.edits);
        let others = [("position", self.positions), ("side_step", self.steps)];
        let mut counts: Vec<(&str, u64)> = relations.chain(others).chain(edits).collect();
        counts.retain(|&(_, count)| count > 0);
        counts.sort_by_key(|&(_, count)| Reverse(count));
        let counts = counts.into_iter().map(|(operation, count)| AskedCount {
            operation: operation.into(),
            count,
        });
        counts.collect()
    }
}

/// The counters of a [`Recorded`] structure. Copies of the structure share them.
#[derive(Debug, Default)]
struct Counters {
    relations: [AtomicU64; 9],
    positions: AtomicU64,
    steps: AtomicU64,
    edits: [AtomicU64; Edit::ALL.len()],
}

/// A structure that answers as `M` does, and counts the queries.
///
/// A query that `M` derives from others, such as the boundary loops, is computed from the nine
/// relations, which are counted.
#[derive(Clone, Debug)]
pub struct Recorded<M: MeshQuery> {
    mesh: M,
    counters: Arc<Counters>,
    /// `None` if the calls are only counted.
    tape: Option<Tape<M::Vertex, M::Face>>,
}

impl<M: MeshQuery> Recorded<M> {
    /// Returns the counts since the structure was built, or since the last call.
    pub fn take(&self) -> Asked {
        let take = |counter: &AtomicU64| counter.swap(0, Ordering::Relaxed);
        Asked {
            relations: std::array::from_fn(|i| take(&self.counters.relations[i])),
            positions: take(&self.counters.positions),
            steps: take(&self.counters.steps),
            edits: std::array::from_fn(|i| take(&self.counters.edits[i])),
        }
    }

    /// Takes the calls since [`start_trace`](Self::start_trace), and the counts since the structure was built or since
    /// they were taken last; `None` if there were too many calls, or no tape.
    pub fn take_tape(&self, program: &str) -> Option<TapedRun> {
        self.tape.as_ref()?.take(program, self.take())
    }

    fn asks(&self, relation: Relation) -> &M {
        self.counters.relations[relation as usize].fetch_add(1, Ordering::Relaxed);
        &self.mesh
    }

    fn steps(&self) -> &M {
        self.counters.steps.fetch_add(1, Ordering::Relaxed);
        &self.mesh
    }

    fn edits(&mut self, edit: Edit) -> &mut M {
        self.counters.edits[edit as usize].fetch_add(1, Ordering::Relaxed);
        &mut self.mesh
    }
}

impl<M: MeshQuery> Recorded<M> {
    /// Returns the results of a query in the order of `key`, if the tape asks for it.
    fn in_order<I: Iterator<Item: Copy>>(
        &self,
        items: I,
        key: impl Fn(&TapeState<M::Vertex, M::Face>, I::Item) -> [u32; 2],
    ) -> Ordered<I> {
        let Some(tape) = self.tape.as_ref().filter(|tape| tape.is_canonical()) else {
            return Ordered::Own(items);
        };
        let items: Vec<I::Item> = items.collect();
        let state = tape.lock();
        let keys = items.iter().map(|&item| key(&state, item)).collect();
        let order = order_of(keys).into_iter();
        Ordered::Other(
            order
                .map(|place| items[place])
                .collect::<Vec<_>>()
                .into_iter(),
        )
    }

    /// Returns the corners or the sides of a face from the corner with the least number, if the tape asks for it.
    fn starting_at_least_corner<I: Iterator>(&self, items: I, f: M::Face) -> Ordered<I> {
        let Some(tape) = self.tape.as_ref().filter(|tape| tape.is_canonical()) else {
            return Ordered::Own(items);
        };
        let mut items: Vec<I::Item> = items.collect();
        let state = tape.lock();
        let corners = self.mesh.face_vertices(f).enumerate();
        let least = corners.min_by_key(|&(_, v)| state.vertex_name(v));
        let place = least.map_or(0, |(place, _)| place).min(items.len());
        items.rotate_left(place);
        Ordered::Other(items.into_iter())
    }
}

impl<M: Representation> Recorded<M> {
    /// Starts to keep the calls for [`trace`](Self::trace). `polygons` is the mesh from which the
    /// structure was built. Each call then takes about 50 ns more.
    pub fn start_trace(&mut self, polygons: &PolygonMesh) {
        self.tape = Some(Tape::new::<M>(polygons, UseOfNames::Calls));
    }

    /// Puts all lists of elements and all results of queries in one order, which is the same on every structure: that of
    /// the numbers of the vertices and faces in `polygons`, from which the structure was built, and of the numbers of the
    /// two ends of an edge. The corners and the sides of a face begin at the corner with the least number. New elements
    /// get the next numbers. Queries then allocate memory, and steps along sides keep their order.
    pub fn start_canonical_order(&mut self, polygons: &PolygonMesh) {
        self.tape = Some(Tape::new::<M>(polygons, UseOfNames::CanonicalOrder));
    }

    /// Returns the calls since [`start_trace`](Self::start_trace) as the trace of `program`.
    /// Returns `None` if there were more than 16 million calls, or if no trace was started.
    pub fn trace(&self, program: &str) -> Option<Trace> {
        Some(self.take_tape(program)?.trace)
    }
}

/// Passes the queries of relations on, and counts them.
macro_rules! counted {
    ($($method:ident($from:ident $name:ident) -> $item:ident $result:ident, $relation:ident;)+) => {
        $(fn $method(&self, of: Self::$from) -> impl Iterator<Item = Self::$item> {
            let relation = Relation::$relation;
            let results = self.asks(relation).$method(of);
            let results = counted!(order $item $relation self, results, of);
            let name = counted!(name $name self, of);
            let call = move |tape: &mut TapeState<_, _>| {
                let name = name(tape);
                tape.query(relation, name)
            };
            Watched::results(results, self.tape.as_ref(), call)
                .noting(counted!(note $result relation))
        })+
    };
    (order Vertex FaceVertices $mesh:ident, $results:ident, $f:ident) => {
        $mesh.starting_at_least_corner($results, $f)
    };
    (order Edge FaceEdges $mesh:ident, $results:ident, $f:ident) => {
        $mesh.starting_at_least_corner($results, $f)
    };
    (order Vertex $relation:ident $mesh:ident, $results:ident, $of:ident) => {
        $mesh.in_order($results, |tape, v| tape.vertex_name(v))
    };
    (order Edge $relation:ident $mesh:ident, $results:ident, $of:ident) => {
        $mesh.in_order($results, |tape, e| tape.edge_name($mesh.mesh.edge_vertices(e)))
    };
    (order Face $relation:ident $mesh:ident, $results:ident, $of:ident) => {
        $mesh.in_order($results, |tape, f| tape.face_name(f))
    };
    (name vertex $mesh:ident, $of:ident) => {
        |tape: &mut TapeState<M::Vertex, M::Face>| tape.vertex_name($of)
    };
    (name face $mesh:ident, $of:ident) => {
        |tape: &mut TapeState<M::Vertex, M::Face>| tape.face_name($of)
    };
    (name edge $mesh:ident, $of:ident) => {
        |tape: &mut TapeState<M::Vertex, M::Face>| {
            tape.edge_name($mesh.mesh.edge_vertices($of))
        }
    };
    (note vertex $relation:ident) => {
        move |tape: &mut TapeState<M::Vertex, M::Face>, &v: &M::Vertex| tape.yielded($relation, v)
    };
    (note other $relation:ident) => {
        |_: &mut TapeState<M::Vertex, M::Face>, _: &_| ()
    };
}

impl<M: MeshQuery> MeshQuery for Recorded<M> {
    type Vertex = M::Vertex;
    type Edge = M::Edge;
    type Face = M::Face;

    const CAPABILITIES: Capabilities = M::CAPABILITIES;

    fn vertices(&self) -> impl Iterator<Item = M::Vertex> {
        let vertices = self.mesh.vertices();
        let vertices = self.in_order(vertices, |tape, v| tape.vertex_name(v));
        Watched::list(vertices, self.tape.as_ref(), ElementKind::Vertex)
            .noting(|tape, &v| tape.item(tape.vertex_name(v)))
    }

    fn edges(&self) -> impl Iterator<Item = M::Edge> {
        let edges = self.mesh.edges();
        let edges = self.in_order(edges, |tape, e| tape.edge_name(self.mesh.edge_vertices(e)));
        Watched::list(edges, self.tape.as_ref(), ElementKind::Edge).noting(|tape, &e| {
            let name = tape.edge_name(self.mesh.edge_vertices(e));
            tape.item(name);
        })
    }

    fn faces(&self) -> impl Iterator<Item = M::Face> {
        let faces = self.mesh.faces();
        let faces = self.in_order(faces, |tape, f| tape.face_name(f));
        Watched::list(faces, self.tape.as_ref(), ElementKind::Face)
            .noting(|tape, &f| tape.item(tape.face_name(f)))
    }

    fn vertex_count(&self) -> usize {
        self.mesh.vertex_count()
    }

    fn edge_count(&self) -> usize {
        self.mesh.edge_count()
    }

    fn face_count(&self) -> usize {
        self.mesh.face_count()
    }

    fn position(&self, v: M::Vertex) -> Point {
        self.counters.positions.fetch_add(1, Ordering::Relaxed);
        if let Some(tape) = &self.tape {
            tape.lock().position(v);
        }
        self.mesh.position(v)
    }

    counted! {
        vertex_vertices(Vertex vertex) -> Vertex vertex, VertexVertices;
        vertex_edges(Vertex vertex) -> Edge other, VertexEdges;
        vertex_faces(Vertex vertex) -> Face other, VertexFaces;
        edge_edges(Edge edge) -> Edge other, EdgeEdges;
        edge_faces(Edge edge) -> Face other, EdgeFaces;
        face_vertices(Face face) -> Vertex vertex, FaceVertices;
        face_edges(Face face) -> Edge other, FaceEdges;
        face_faces(Face face) -> Face other, FaceFaces;
    }

    fn edge_vertices(&self, e: M::Edge) -> [M::Vertex; 2] {
        let relation = Relation::EdgeVertices;
        let mut ends = self.asks(relation).edge_vertices(e);
        if let Some(tape) = &self.tape {
            let is_canonical = tape.is_canonical();
            let mut tape = tape.lock();
            if is_canonical {
                let [first, second] = ends.map(|v| tape.vertex_name(v));
                if first > second {
                    ends.reverse();
                }
            }
            let name = tape.edge_name(ends);
            tape.query(relation, name);
            for v in ends {
                tape.yielded(relation, v);
            }
        }
        ends
    }

    fn contains_vertex(&self, v: M::Vertex) -> bool {
        self.mesh.contains_vertex(v)
    }

    fn contains_edge(&self, e: M::Edge) -> bool {
        self.mesh.contains_edge(e)
    }

    fn contains_face(&self, f: M::Face) -> bool {
        self.mesh.contains_face(f)
    }

    fn vertex_rows(&self) -> usize {
        self.mesh.vertex_rows()
    }

    fn edge_rows(&self) -> usize {
        self.mesh.edge_rows()
    }

    fn face_rows(&self) -> usize {
        self.mesh.face_rows()
    }
}

impl<M: Representation> Representation for Recorded<M> {
    const NAME: &'static str = M::NAME;
    const COSTS: [QueryCost; 9] = M::COSTS;

    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        Ok(Self {
            mesh: M::from_polygons(polygons)?,
            counters: Arc::default(),
            tape: None,
        })
    }

    fn to_polygons(&self) -> PolygonMesh {
        self.mesh.to_polygons()
    }

    fn vertex_handle(polygons: &PolygonMesh, v: VertexId) -> M::Vertex {
        M::vertex_handle(polygons, v)
    }

    fn face_handle(polygons: &PolygonMesh, f: FaceId) -> M::Face {
        M::face_handle(polygons, f)
    }

    fn memory(&self) -> MemoryFootprint {
        self.mesh.memory()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        self.mesh.validate()
    }
}

impl<M: MeshMove> MeshMove for Recorded<M> {
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError> {
        if let Some(tape) = &self.tape {
            tape.lock().set_positions();
        }
        self.mesh
            .set_positions_logged(positions, &mut PassedOn(log))
    }
}

impl<M: OrientedWalk> OrientedWalk for Recorded<M> {
    type Side = M::Side;

    fn face_sides(&self, f: M::Face) -> impl Iterator<Item = M::Side> {
        self.asks(Relation::FaceEdges).face_sides(f)
    }

    fn edge_sides(&self, e: M::Edge) -> impl Iterator<Item = M::Side> {
        self.asks(Relation::EdgeFaces).edge_sides(e)
    }

    fn outgoing_sides(&self, v: M::Vertex) -> impl Iterator<Item = M::Side> {
        self.asks(Relation::VertexFaces).outgoing_sides(v)
    }

    fn next_side(&self, s: M::Side) -> M::Side {
        self.steps().next_side(s)
    }

    fn prev_side(&self, s: M::Side) -> M::Side {
        self.steps().prev_side(s)
    }

    fn twin_side(&self, s: M::Side) -> Option<M::Side> {
        self.steps().twin_side(s)
    }

    fn side_origin(&self, s: M::Side) -> M::Vertex {
        self.mesh.side_origin(s)
    }

    fn side_face(&self, s: M::Side) -> M::Face {
        self.mesh.side_face(s)
    }

    fn side_edge(&self, s: M::Side) -> M::Edge {
        self.mesh.side_edge(s)
    }

    fn side_map<T: Clone>(&self, value: T) -> <M::Side as Handle>::Map<T> {
        self.mesh.side_map(value)
    }
}

/// Passes reports of the structure on to the log of the program.
struct PassedOn<'l, L>(&'l mut L);

impl<M: MeshQuery, L: EditLog<Recorded<M>>> EditLog<M> for PassedOn<'_, L> {
    const USES_REPORTS: bool = L::USES_REPORTS;

    sixfold_core::pass_reports_on!(0);
}

/// Passes reports on to the log of the program, and keeps them in a record.
struct BothLogs<'l, L, M: MeshQuery>(&'l mut L, &'l mut EditRecord<M>);

impl<M: MeshQuery, L: EditLog<Recorded<M>>> EditLog<M> for BothLogs<'_, L, M> {
    sixfold_core::pass_reports_on!(0, 1);
}

impl<M: MeshEdit> Recorded<M> {
    /// Counts an edit, does it by `run`, and puts it on the tape. `is_refused` reads the result.
    fn record_edit<L: EditLog<Self>, T>(
        &mut self,
        edit: &EditOf<M>,
        tape: &Tape<M::Vertex, M::Face>,
        log: &mut L,
        run: impl FnOnce(&mut M, &mut BothLogs<'_, L, M>) -> T,
        is_refused: impl FnOnce(&T) -> bool,
    ) -> T {
        let state = tape.lock();
        let vertex = |&v: &M::Vertex| Ok::<_, Infallible>(state.vertex_name(v)[0]);
        let edge = |&e: &M::Edge| Ok(state.edge_name(self.mesh.edge_vertices(e)));
        let Ok(call) = edit.try_map(vertex, edge, |&f| Ok(state.face_name(f)[0]));
        let cut = state.names.faces_before(&self.mesh, edit);
        drop(state);
        let mut record = EditRecord::new();
        let done = run(self.edits(edit.edit()), &mut BothLogs(log, &mut record));
        let refused = is_refused(&done);
        let mut state = tape.lock();
        if !refused {
            state.names.follow(&self.mesh, &record, &cut);
        }
        let call = call.map_position(Some);
        state.edit(TracedEdit { call, refused });
        done
    }
}

/// The parts of a method of `MeshEdit`, by the kinds of its arguments and of its result.
macro_rules! edit_method {
    (type vertex) => { M::Vertex };
    (type vertex_if_any) => { Option<M::Vertex> };
    (type vertices) => { &[M::Vertex] };
    (type faces) => { &[M::Face] };
    (type corners) => { [M::Vertex; 2] };
    (type edge) => { M::Edge };
    (type face) => { M::Face };
    (type position) => { Point };
    (type new_position) => { Point };
    (owned vertices $a:ident) => { $a.to_vec() };
    (owned faces $a:ident) => { $a.to_vec() };
    (owned $kind:ident $a:ident) => { $a };
    (result vertex) => { Result<M::Vertex, Refusal<Self>> };
    (result edge) => { Result<M::Edge, Refusal<Self>> };
    (result face) => { Result<M::Face, Refusal<Self>> };
    (result nothing) => { Result<(), Refusal<Self>> };
    (result count) => { usize };
    (result unit) => { () };
    (refused count) => { |_| false };
    (refused unit) => { |_| false };
    (refused $result:ident) => { Result::is_err };
}

/// Passes edits on, and counts them.
macro_rules! counted_edits {
    ($($edit:ident $name:literal $method:ident($($a:ident: $kind:ident $type:ty),*) -> $result:ident;)+) => {
        $(fn $method(
            &mut self,
            $($a: edit_method!(type $kind),)*
            log: &mut impl EditLog<Self>,
        ) -> edit_method!(result $result) {
            let Some(tape) = self.tape.clone() else {
                return self.edits(Edit::$edit).$method($($a,)* &mut PassedOn(log));
            };
            let edit = EditCall::$edit { $($a: edit_method!(owned $kind $a)),* };
            let run = |mesh: &mut M, log: &mut BothLogs<'_, _, M>| mesh.$method($($a,)* log);
            self.record_edit(&edit, &tape, log, run, edit_method!(refused $result))
        })+
    };
}

impl<M: MeshEdit> MeshEdit for Recorded<M> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = M::EDITS;

    type Compact = Recorded<M::Compact>;

    fn into_compact(self) -> Self::Compact {
        Recorded {
            mesh: self.mesh.into_compact(),
            counters: self.counters,
            tape: self.tape,
        }
    }

    fn from_compact(compact: Self::Compact) -> Self {
        Self {
            mesh: M::from_compact(compact.mesh),
            counters: compact.counters,
            tape: compact.tape,
        }
    }

    sixfold_core::for_each_edit!(counted_edits! {});
}

#[cfg(test)]
mod tests {
    use sixfold::{
        CornerTable, EditRecord, EditableHalfEdgeMesh, FaceVertexMesh, HalfEdgeMesh,
        WingedEdgeMesh, shapes,
    };

    use super::*;

    sixfold_conformance::walk_suite!(Recorded<HalfEdgeMesh>);

    fn recorded<M: Representation>() -> Recorded<M> {
        Recorded::from_polygons(&shapes::icosahedron()).expect("a closed manifold")
    }

    /// Returns the names and the counts.
    fn counts(asked: &Asked) -> Vec<(String, u64)> {
        let counts = asked.counts().into_iter();
        counts.map(|asked| (asked.operation, asked.count)).collect()
    }

    #[test]
    fn each_relation_is_counted_once() {
        let mesh = recorded::<HalfEdgeMesh>();
        let v = mesh.vertices().next().expect("a vertex");
        let e = mesh.edges().next().expect("an edge");
        let f = mesh.faces().next().expect("a face");
        let answers = [
            mesh.vertex_vertices(v).count(),
            mesh.vertex_edges(v).count(),
            mesh.vertex_faces(v).count(),
            mesh.edge_vertices(e).len(),
            mesh.edge_edges(e).count(),
            mesh.edge_faces(e).count(),
            mesh.face_vertices(f).count(),
            mesh.face_edges(f).count(),
            mesh.face_faces(f).count(),
        ];
        assert_eq!(answers, [5, 5, 5, 2, 8, 2, 3, 3, 3]);
        assert_eq!(mesh.position(v), mesh.mesh.position(v));
        let asked = mesh.take();
        assert_eq!(asked.relations, [1; 9]);
        assert_eq!(asked.positions, 1);
        assert_eq!(mesh.take(), Asked::default(), "counts are taken once");
    }

    #[test]
    fn steps_along_sides_are_counted() {
        let mesh = recorded::<HalfEdgeMesh>();
        let f = mesh.faces().next().expect("a face");
        let s = mesh.face_sides(f).next().expect("a side");
        assert_eq!(mesh.prev_side(mesh.next_side(s)), s);
        let twin = mesh.twin_side(s).expect("a closed mesh");
        assert_ne!(mesh.side_face(twin), f);
        assert_eq!(mesh.edge_sides(mesh.side_edge(s)).count(), 2);
        assert_eq!(mesh.outgoing_sides(mesh.side_origin(s)).count(), 5);
        let asked = mesh.take();
        let expected = [
            ("side_step", 3),
            ("vertex_faces", 1),
            ("edge_faces", 1),
            ("face_edges", 1),
        ]
        .map(|(name, count)| (name.to_owned(), count));
        assert_eq!(counts(&asked), expected);
    }

    #[test]
    fn edits_are_counted_and_reported_as_on_the_structure() {
        let mut mesh = recorded::<EditableHalfEdgeMesh>();
        let mut plain = mesh.mesh.clone();
        let e = mesh.edges().next().expect("an edge");
        let mut record = EditRecord::new();
        let mut record_of_plain = EditRecord::new();
        let middle = mesh.split_edge_logged(e, Point::ZERO, &mut record);
        let middle_of_plain = plain.split_edge_logged(e, Point::ZERO, &mut record_of_plain);
        assert_eq!(middle.ok(), middle_of_plain.ok());
        mesh.compact_logged(&mut record);
        plain.compact_logged(&mut record_of_plain);
        assert_eq!(mesh.to_polygons(), plain.to_polygons());
        let mut numbers = mesh.vertex_map(0);
        record.vertices.apply_to(&mut numbers, &1);
        let new = mesh.vertices().filter(|&v| numbers[v] == 1);
        assert_eq!(new.count(), 1);
        let asked = mesh.take();
        let expected = [Edit::SplitEdge, Edit::Compact].map(|edit| (edit.name().to_owned(), 1));
        assert_eq!(counts(&asked), expected);
        assert_eq!(mesh.memory(), mesh.mesh.memory());
        assert!(mesh.validate().is_ok());
    }

    /// What a mesh yields, by names: lists, results of all relations, and the ends of edges.
    fn answers<M: Representation>(polygons: &PolygonMesh) -> Vec<Vec<[u32; 2]>> {
        let mut mesh = Recorded::<M>::from_polygons(polygons).expect("a torus");
        mesh.start_canonical_order(polygons);
        let numbers = sixfold_core::ElementNames::new::<M>(polygons);
        let vertex = |v| [numbers.vertex_number(v).expect("named"), 0];
        let face = |f| [numbers.face_number(f).expect("named"), 0];
        let edge = |e| {
            let ends = mesh.mesh.edge_vertices(e);
            numbers.edge_numbers(ends).expect("named")
        };
        let mut all = vec![
            mesh.vertices().map(vertex).collect(),
            mesh.edges().map(edge).collect(),
            mesh.faces().map(face).collect(),
        ];
        for v in mesh.vertices() {
            all.push(mesh.vertex_vertices(v).map(vertex).collect());
            all.push(mesh.vertex_edges(v).map(edge).collect());
            all.push(mesh.vertex_faces(v).map(face).collect());
        }
        for e in mesh.edges() {
            all.push(mesh.edge_vertices(e).map(vertex).into());
            all.push(mesh.edge_edges(e).map(edge).collect());
            all.push(mesh.edge_faces(e).map(face).collect());
        }
        for f in mesh.faces() {
            all.push(mesh.face_vertices(f).map(vertex).collect());
            all.push(mesh.face_edges(f).map(edge).collect());
            all.push(mesh.face_faces(f).map(face).collect());
        }
        all
    }

    #[test]
    fn the_canonical_order_is_the_same_on_every_structure() {
        let torus = shapes::triangle_torus(7, 5).expect("a torus");
        let torus = shapes::shuffled(&torus, 3);
        let expected = answers::<HalfEdgeMesh>(&torus);
        assert!(expected[0].is_sorted() && expected[1].is_sorted() && expected[2].is_sorted());
        assert_eq!(answers::<FaceVertexMesh>(&torus), expected);
        assert_eq!(answers::<WingedEdgeMesh>(&torus), expected);
        assert_eq!(answers::<CornerTable>(&torus), expected);
        let mut mesh = Recorded::<HalfEdgeMesh>::from_polygons(&torus).expect("a torus");
        mesh.start_canonical_order(&torus);
        for f in mesh.faces() {
            let corners: Vec<_> = mesh.face_vertices(f).collect();
            let next = |i: usize| corners[(i + 1) % corners.len()];
            for (i, e) in mesh.face_edges(f).enumerate() {
                let mut ends = mesh.edge_vertices(e);
                let mut side = [corners[i], next(i)];
                ends.sort_unstable();
                side.sort_unstable();
                assert_eq!(ends, side, "a side begins at its corner");
            }
        }
        let calls = mesh.take_tape("order").expect("no calls");
        assert!(calls.trace.is_empty(), "calls are not kept");
    }

    #[test]
    fn the_compact_form_shares_the_counters() {
        let compact = recorded::<EditableHalfEdgeMesh>().into_compact();
        let v = compact.vertices().next().expect("a vertex");
        assert!(compact.position(v).is_finite());
        let editable = Recorded::<EditableHalfEdgeMesh>::from_compact(compact);
        assert_eq!(editable.take().positions, 1);
    }
}
