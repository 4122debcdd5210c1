//! Runs a trace on one structure.

use std::collections::HashMap;
use std::hint::black_box;
use std::marker::PhantomData;
use std::ops::Range;

use sixfold::{
    Edit, EditRecord, Handle, MeshEdit, MeshQuery, Point, PolygonMesh, QueryCost, Representation,
    VertexMap,
};
use sixfold_core::{EditOf, ElementNames};

use super::{ALL, Call, Op, Trace, TracedEdit};
use crate::handle_lists::HandleLists;
use crate::job::Outcome;
use crate::operation::ElementKind;
use crate::program::Form;
use crate::sink::Sink;

/// The greatest product of scanning calls and faces. A trace with more is not run on a structure
/// that scans: one run would take more than about a second.
const MAX_SCANNED: u64 = 200_000_000;

/// Calls of the same kind that follow each other.
struct Group {
    op: Op,
    taken: u32,
    /// Their places in the list of handles.
    range: Range<usize>,
}

/// A trace in the handles of one structure.
pub struct Replay<M: MeshQuery> {
    groups: Vec<Group>,
    handles: HandleLists<M>,
    edits: Vec<EditOf<M>>,
    /// The positions that [`Op::SetPositions`] writes: those of the mesh.
    positions: Option<VertexMap<M, Point>>,
    calls: u64,
}

/// The calls of a trace, translated so far. Structures with the same handles share this code.
struct Calls<V, E, F> {
    groups: Vec<Group>,
    vertices: Vec<V>,
    edges: Vec<E>,
    faces: Vec<F>,
    calls: u64,
}

/// The next position in a trace, for messages.
fn at(call: usize) -> String {
    format!("call {} of the trace", call + 1)
}

fn missing(call: usize, what: &str) -> String {
    format!("{}: the mesh has no {what}", at(call))
}

impl Trace {
    /// Checks that the trace belongs to `polygons`, and that `costs` allow to run it.
    fn check(&self, polygons: &PolygonMesh, costs: &[QueryCost; 9]) -> Result<(), String> {
        let [vertices, faces] = [polygons.vertex_count(), polygons.face_count()];
        if [self.vertices, self.faces] != [vertices, faces] {
            return Err(format!(
                "the trace was recorded on a mesh with {} vertices and {} faces, but this mesh has \
                 {vertices} vertices and {faces} faces",
                self.vertices, self.faces
            ));
        }
        let is_scan = |call: &&Call| match call.op {
            Op::Query(relation) => costs[relation as usize] == QueryCost::Scan,
            _ => false,
        };
        let scans = self.calls.iter().filter(is_scan).count() as u64;
        if scans.saturating_mul(faces as u64) > MAX_SCANNED {
            return Err(format!(
                "left out, because {scans} calls of the trace scan all {faces} faces each, which would take too long"
            ));
        }
        Ok(())
    }
}

impl<V: Handle, E: Handle, F: Handle> Calls<V, E, F> {
    fn new() -> Self {
        Self {
            groups: Vec::new(),
            vertices: Vec::new(),
            edges: Vec::new(),
            faces: Vec::new(),
            calls: 0,
        }
    }

    /// Adds a call. `place` is its place in the list of handles.
    fn push(&mut self, op: Op, taken: u32, place: usize) {
        self.calls += 1;
        if let Some(last) = self.groups.last_mut()
            && (last.op, last.taken, last.range.end) == (op, taken, place)
        {
            last.range.end += 1;
            return;
        }
        self.groups.push(Group {
            op,
            taken,
            range: place..place + 1,
        });
    }

    /// Adds a query or the reading of a position. `edge` finds the edge with the given ends.
    fn push_query(
        &mut self,
        nth: usize,
        call: Call,
        names: &ElementNames<V, F>,
        edge: &dyn Fn([u32; 2]) -> Option<E>,
    ) -> Result<(), String> {
        let [a, b] = call.name;
        let kind = match call.op {
            Op::Query(relation) => ElementKind::queried_by(relation),
            _ => ElementKind::Vertex,
        };
        let place = match kind {
            ElementKind::Vertex => {
                let v = names.vertex(a);
                self.vertices
                    .push(v.ok_or_else(|| missing(nth, &format!("vertex {a}")))?);
                self.vertices.len() - 1
            }
            ElementKind::Edge => {
                let e = edge(call.name);
                self.edges
                    .push(e.ok_or_else(|| missing(nth, &format!("edge {a}-{b}")))?);
                self.edges.len() - 1
            }
            ElementKind::Face => {
                let f = names.face(a);
                self.faces
                    .push(f.ok_or_else(|| missing(nth, &format!("face {a}")))?);
                self.faces.len() - 1
            }
        };
        self.push(call.op, call.taken, place);
        Ok(())
    }
}

impl<M: MeshQuery> Replay<M> {
    fn new(
        calls: Calls<M::Vertex, M::Edge, M::Face>,
        edits: Vec<EditOf<M>>,
        positions: Option<VertexMap<M, Point>>,
    ) -> Self {
        Self {
            groups: calls.groups,
            handles: HandleLists {
                vertices: calls.vertices,
                edges: calls.edges,
                faces: calls.faces,
            },
            edits,
            positions,
            calls: calls.calls,
        }
    }

    /// **Timed**: runs all calls. `edit` does an edit; `set_positions` writes positions.
    #[inline(always)]
    fn run(
        &self,
        mesh: &mut M,
        mut edit: impl FnMut(&mut M, &EditOf<M>),
        mut set_positions: impl FnMut(&mut M, &VertexMap<M, Point>),
    ) -> Outcome {
        let mut sink = Sink::default();
        let mut sum = Point::ZERO;
        let mut positions = 0;
        for group in &self.groups {
            let taken = group.taken as usize;
            match group.op {
                Op::Query(relation) => {
                    let range = group.range.clone();
                    sink = match group.taken {
                        ALL => self.handles.query(mesh, relation, range, sink),
                        _ => self.handles.query_first(mesh, relation, range, taken, sink),
                    };
                }
                Op::Position => {
                    for &v in &self.handles.vertices[group.range.clone()] {
                        sum += mesh.position(v);
                    }
                    positions += group.range.len() as u64;
                }
                Op::List(ElementKind::Vertex) => sink = sink.with(mesh.vertices().take(taken)),
                Op::List(ElementKind::Edge) => sink = sink.with(mesh.edges().take(taken)),
                Op::List(ElementKind::Face) => sink = sink.with(mesh.faces().take(taken)),
                Op::Edit => {
                    for call in &self.edits[group.range.clone()] {
                        edit(mesh, call);
                    }
                }
                Op::SetPositions => {
                    if let Some(positions) = &self.positions {
                        set_positions(mesh, positions);
                    }
                }
                Op::Item | Op::End => {}
            }
        }
        black_box(sum);
        Outcome::new((sink.count() + positions) as f64, self.calls)
    }
}

/// Translates a trace without edits. Each structure visits the elements of a list in its own order,
/// as a program does.
fn translate<M: Representation>(
    trace: &Trace,
    mesh: &M,
    polygons: &PolygonMesh,
) -> Result<Replay<M>, String> {
    trace.check(polygons, &M::COSTS)?;
    let names = &ElementNames::new::<M>(polygons);
    let is_edge = |call: &Call| match call.op {
        Op::Query(relation) => ElementKind::queried_by(relation) == ElementKind::Edge,
        Op::List(kind) => kind == ElementKind::Edge,
        _ => false,
    };
    let names_edges = trace.calls.iter().any(is_edge);
    let edges = mesh.edges().filter(|_| names_edges);
    let named = |e| Some((names.edge_numbers(mesh.edge_vertices(e))?, e));
    let translation = Translation {
        trace,
        names,
        edges: edges.filter_map(named).collect(),
        in_order: &|kind| match kind {
            ElementKind::Vertex => {
                let numbers = mesh.vertices().map(|v| Some([names.vertex_number(v)?, 0]));
                numbers.collect()
            }
            ElementKind::Edge => {
                let ends = mesh.edges().map(|e| mesh.edge_vertices(e));
                ends.map(|ends| names.edge_numbers(ends)).collect()
            }
            ElementKind::Face => {
                let numbers = mesh.faces().map(|f| Some([names.face_number(f)?, 0]));
                numbers.collect()
            }
        },
        ends: ends_of_lists(&trace.calls),
    };
    let mut calls = Calls::new();
    translation.add(&mut calls, 0..trace.calls.len())?;
    let moves = trace.calls.iter().any(|call| call.op == Op::SetPositions);
    let positions = moves.then(|| {
        let mut positions = mesh.vertex_map(Point::ZERO);
        for v in mesh.vertices() {
            positions[v] = mesh.position(v);
        }
        positions
    });
    Ok(Replay::new(calls, Vec::new(), positions))
}

/// Returns the handles of a trace without edits, by kind, as text.
#[cfg(test)]
pub(super) fn handles<M: Representation>(
    trace: &Trace,
    mesh: &M,
    polygons: &PolygonMesh,
) -> Result<[Vec<String>; 3], String> {
    fn text<H: std::fmt::Debug>(handles: &[H]) -> Vec<String> {
        handles.iter().map(|h| format!("{h:?}")).collect()
    }
    let replay = translate(trace, mesh, polygons)?;
    Ok([
        text(&replay.handles.vertices),
        text(&replay.handles.edges),
        text(&replay.handles.faces),
    ])
}

/// What the translation of a trace without edits reads.
struct Translation<'t, V, E, F> {
    trace: &'t Trace,
    names: &'t ElementNames<V, F>,
    /// The edges by the numbers of their ends; empty if the trace names no edge.
    edges: HashMap<[u32; 2], E>,
    /// Returns the names of all elements of a kind, in the order of the structure.
    in_order: &'t dyn Fn(ElementKind) -> Vec<Option<[u32; 2]>>,
    /// For each call that starts a list, the call that ends it.
    ends: HashMap<usize, usize>,
}

impl<V: Handle, E: Handle, F: Handle> Translation<'_, V, E, F> {
    /// Adds the calls `range`.
    fn add(&self, calls: &mut Calls<V, E, F>, range: Range<usize>) -> Result<(), String> {
        let mut nth = range.start;
        while nth < range.end {
            let call = self.trace.calls[nth];
            match call.op {
                Op::List(kind) => {
                    calls.push(call.op, call.taken, 0);
                    if call.taken == ALL {
                        self.add_items(calls, kind, nth)?;
                        nth = self.ends[&nth];
                    }
                }
                Op::Item | Op::End | Op::Edit => {}
                Op::SetPositions => calls.push(call.op, ALL, 0),
                Op::Query(_) | Op::Position => {
                    let edge = |ends| self.edges.get(&ends).copied();
                    calls.push_query(nth, call, self.names, &edge)?;
                }
            }
            nth += 1;
        }
        Ok(())
    }

    /// Adds the calls of all items of the list that call `list` starts, in the order of the
    /// structure.
    fn add_items(
        &self,
        calls: &mut Calls<V, E, F>,
        kind: ElementKind,
        list: usize,
    ) -> Result<(), String> {
        let end = self.ends[&list];
        let mut items: HashMap<[u32; 2], Range<usize>> = HashMap::new();
        let mut nth = list + 1;
        let mut current = None;
        while nth < end {
            let call = self.trace.calls[nth];
            match call.op {
                Op::Item => {
                    current = Some(call.name);
                    items.insert(call.name, nth + 1..nth + 1);
                }
                Op::List(_) => nth = self.ends[&nth],
                _ => {}
            }
            nth += 1;
            if let Some(name) = current
                && let Some(range) = items.get_mut(&name)
            {
                range.end = nth;
            }
        }
        items.retain(|_, range| range.start < range.end);
        if items.is_empty() {
            return Ok(());
        }
        for name in (self.in_order)(kind).into_iter().flatten() {
            if let Some(range) = items.remove(&name) {
                self.add(calls, range)?;
            }
        }
        match items
            .into_iter()
            .map(|(name, range)| (range.start, name))
            .min()
        {
            // A structure that merges vertices lists fewer of them.
            Some((start, name)) if kind == ElementKind::Face => {
                Err(missing(start - 1, &format!("face {}", name[0])))
            }
            _ => Ok(()),
        }
    }
}

/// Returns for each call that starts a list the call that ends it. A list that never ends, ends with
/// the trace.
fn ends_of_lists(calls: &[Call]) -> HashMap<usize, usize> {
    let mut open = Vec::new();
    let mut ends = HashMap::new();
    for (nth, call) in calls.iter().enumerate() {
        match call.op {
            Op::List(_) => open.push(nth),
            Op::End => {
                ends.extend(open.pop().map(|list| (list, nth)));
            }
            _ => {}
        }
    }
    ends.extend(open.into_iter().map(|list| (list, calls.len())));
    ends
}

/// Translates a trace with edits: runs it once on a copy of the mesh, because new elements get
/// handles only then.
fn translate_edits<M: Representation + MeshEdit>(
    trace: &Trace,
    mesh: &M,
    polygons: &PolygonMesh,
) -> Result<Replay<M>, String> {
    trace.check(polygons, &M::COSTS)?;
    let scans = trace.edits.iter().filter(|edit| {
        let edit = edit.call.edit();
        M::EDITS[edit as usize] == Some(QueryCost::Scan) && edit != Edit::Compact
    });
    if scans.count() as u64 * polygons.face_count() as u64 > MAX_SCANNED {
        return Err(
            "left out, because the edits of the trace scan all faces each, which would take too long"
                .into(),
        );
    }
    let mut mesh = mesh.clone();
    let mut names = ElementNames::new::<M>(polygons);
    let mut calls = Calls::new();
    let mut edits = Vec::new();
    for (nth, &call) in trace.calls.iter().enumerate() {
        match call.op {
            Op::List(_) => calls.push(call.op, call.taken, 0),
            Op::Item | Op::End | Op::SetPositions => {}
            Op::Query(_) | Op::Position => {
                let [a, b] = call.name.map(|number| names.vertex(number));
                let edge = |_| mesh.edge_between(a?, b?);
                calls.push_query(nth, call, &names, &edge)?;
            }
            Op::Edit => {
                let TracedEdit {
                    call: named,
                    refused,
                } = &trace.edits[call.name[0] as usize];
                let edit = named.find(&mesh, &names);
                let edit = edit.map_err(|name| missing(nth, &format!("{} {name}", name.kind())))?;
                let cut = names.faces_before(&mesh, &edit);
                let mut record = EditRecord::new();
                let refusal = edit.apply(&mut mesh, &mut record).err();
                if refusal.is_some() != *refused {
                    let done = |refused| if refused { "refused" } else { "done" };
                    let because = refusal.map_or_else(String::new, |reason| format!(" ({reason})"));
                    return Err(format!(
                        "{}: {} was {} in the recorded run, but is {} here{because}",
                        at(nth),
                        edit.edit(),
                        done(*refused),
                        done(!*refused)
                    ));
                }
                if !refused {
                    names.follow(&mesh, &record, &cut);
                }
                edits.push(edit);
                calls.push(Op::Edit, ALL, edits.len() - 1);
            }
        }
    }
    Ok(Replay::new(calls, edits, None))
}

/// Runs a trace without edits on the structure `M`.
pub struct PlainReplay<M>(PhantomData<M>);

impl<M: Representation> Form for PlainReplay<M> {
    type Program = Trace;
    type Mesh = M;
    type Scratch = Replay<M>;

    fn changes_mesh(replay: &Replay<M>) -> bool {
        replay.positions.is_some()
    }

    fn set_up(trace: &Trace, mesh: &M, polygons: &PolygonMesh) -> Result<Replay<M>, String> {
        translate(trace, mesh, polygons)
    }

    fn run(_: &Trace, mesh: &mut M, replay: &mut Replay<M>) -> Outcome {
        replay.run(
            mesh,
            |_, _| (),
            |mesh, positions| _ = black_box(mesh.set_positions(positions).is_ok()),
        )
    }
}

/// Runs a trace with edits on the structure `M`.
pub struct EditReplay<M>(PhantomData<M>);

impl<M: Representation + MeshEdit> Form for EditReplay<M> {
    const EDITS: bool = true;

    type Program = Trace;
    type Mesh = M;
    type Scratch = Replay<M>;

    fn changes_mesh(_: &Replay<M>) -> bool {
        true
    }

    fn set_up(trace: &Trace, mesh: &M, polygons: &PolygonMesh) -> Result<Replay<M>, String> {
        translate_edits(trace, mesh, polygons)
    }

    fn run(_: &Trace, mesh: &mut M, replay: &mut Replay<M>) -> Outcome {
        replay.run(
            mesh,
            |mesh, call| _ = black_box(call.apply(mesh, &mut ()).is_ok()),
            |_, _| (),
        )
    }
}
