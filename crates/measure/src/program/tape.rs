//! Keeps the calls of a program while it runs on a recorded structure.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sixfold::{Handle, PolygonMesh, Relation, Representation};
use sixfold_core::ElementNames;

use super::recorded::Asked;
use crate::operation::ElementKind;
use crate::trace::{ALL, Call, NONE, Op, Trace, TracedEdit};

/// The greatest number of calls that are kept: 256 MB.
const MAX_CALLS: usize = 1 << 24;

/// The greatest number of results of a query that are compared with the positions read after it.
const MAX_RECENT: usize = 16;

/// The calls of a program, with the names of the elements. Copies share one tape.
pub(super) struct Tape<V: Handle, F: Handle> {
    state: Arc<Mutex<TapeState<V, F>>>,
    use_of_names: UseOfNames,
}

/// What the names of the elements are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UseOfNames {
    /// The calls are kept.
    Calls,
    /// All lists and results are in the order of the names; calls are not kept.
    CanonicalOrder,
}

pub(super) struct TapeState<V: Handle, F: Handle> {
    pub(super) names: ElementNames<V, F>,
    calls: Vec<Call>,
    edits: Vec<TracedEdit>,
    /// False after more calls than are kept.
    complete: bool,
    /// The relation that was queried last, if its results are vertices, with its last results.
    recent: Option<(Relation, Vec<V>)>,
    /// By relation: the number of positions read of results of its last query.
    positions_of: [u64; 9],
    /// By relation: the number of vertices that its queries yielded.
    yielded: [u64; 9],
    /// The places of the calls that read the position of a result of the last query.
    of_results: Vec<usize>,
    vertices: usize,
    faces: usize,
    keeps_calls: bool,
}

impl<V: Handle, F: Handle> Clone for Tape<V, F> {
    fn clone(&self) -> Self {
        Self {
            state: Arc::clone(&self.state),
            ..*self
        }
    }
}

impl<V: Handle, F: Handle> fmt::Debug for Tape<V, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tape").finish_non_exhaustive()
    }
}

/// The calls of one run of a program, and how the program reads positions.
#[derive(Clone, Debug)]
pub struct TapedRun {
    /// The calls, in order.
    pub trace: Trace,
    /// The number of calls of each kind.
    pub asked: Asked,
    /// By relation: the number of positions read of results of its last query.
    pub positions_of: [u64; 9],
    /// By relation: the number of vertices that its queries yielded.
    pub yielded: [u64; 9],
    /// The places of the calls that read the position of a result of the last query, ascending.
    pub of_results: Vec<usize>,
}

impl<V: Handle, F: Handle> Tape<V, F> {
    pub(super) fn new<M>(polygons: &PolygonMesh, use_of_names: UseOfNames) -> Self
    where
        M: Representation<Vertex = V, Face = F>,
    {
        let state = TapeState {
            names: ElementNames::new::<M>(polygons),
            calls: Vec::new(),
            edits: Vec::new(),
            complete: true,
            recent: None,
            positions_of: [0; 9],
            yielded: [0; 9],
            of_results: Vec::new(),
            vertices: polygons.vertex_count(),
            faces: polygons.face_count(),
            keeps_calls: use_of_names == UseOfNames::Calls,
        };
        Self {
            state: Arc::new(Mutex::new(state)),
            use_of_names,
        }
    }

    /// Returns whether all lists and results are in the order of the names.
    pub(super) fn is_canonical(&self) -> bool {
        self.use_of_names == UseOfNames::CanonicalOrder
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, TapeState<V, F>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the calls since the tape was made or last taken, of which there were `asked`; `None` if there were too many.
    pub(super) fn take(&self, program: &str, asked: Asked) -> Option<TapedRun> {
        let mut state = self.lock();
        let mut trace = Trace::new(program, state.vertices, state.faces);
        trace.calls = std::mem::take(&mut state.calls);
        trace.edits = std::mem::take(&mut state.edits);
        let run = TapedRun {
            trace,
            asked,
            positions_of: std::mem::take(&mut state.positions_of),
            yielded: std::mem::take(&mut state.yielded),
            of_results: std::mem::take(&mut state.of_results),
        };
        std::mem::replace(&mut state.complete, true).then_some(run)
    }
}

impl<V: Handle, F: Handle> TapeState<V, F> {
    fn push(&mut self, op: Op, name: [u32; 2]) -> usize {
        if !self.keeps_calls {
            return usize::MAX;
        }
        match self.calls.len() < MAX_CALLS {
            true => self.calls.push(Call {
                op,
                taken: ALL,
                name,
            }),
            false => self.complete = false,
        }
        self.calls.len() - 1
    }

    pub(super) fn vertex_name(&self, v: V) -> [u32; 2] {
        [self.names.vertex_number(v).unwrap_or(NONE), 0]
    }

    pub(super) fn edge_name(&self, ends: [V; 2]) -> [u32; 2] {
        self.names.edge_numbers(ends).unwrap_or([NONE; 2])
    }

    pub(super) fn face_name(&self, f: F) -> [u32; 2] {
        [self.names.face_number(f).unwrap_or(NONE), 0]
    }

    pub(super) fn query(&mut self, relation: Relation, name: [u32; 2]) -> usize {
        self.recent = None;
        if matches!(
            relation,
            Relation::VertexVertices | Relation::EdgeVertices | Relation::FaceVertices
        ) {
            self.recent = Some((relation, Vec::new()));
        }
        self.push(Op::Query(relation), name)
    }

    /// A query yielded a vertex.
    pub(super) fn yielded(&mut self, relation: Relation, v: V) {
        self.yielded[relation as usize] += 1;
        if let Some((last, vertices)) = &mut self.recent
            && *last == relation
        {
            if vertices.len() == MAX_RECENT {
                vertices.remove(0);
            }
            vertices.push(v);
        }
    }

    pub(super) fn position(&mut self, v: V) {
        if let Some((relation, vertices)) = &self.recent
            && vertices.contains(&v)
        {
            self.positions_of[*relation as usize] += 1;
            if self.keeps_calls {
                self.of_results.push(self.calls.len());
            }
        }
        let name = self.vertex_name(v);
        self.push(Op::Position, name);
    }

    pub(super) fn set_positions(&mut self) {
        self.push(Op::SetPositions, [0; 2]);
    }

    pub(super) fn edit(&mut self, edit: TracedEdit) {
        self.push(Op::Edit, [self.edits.len() as u32, 0]);
        if self.keeps_calls {
            self.edits.push(edit);
        }
    }
}

/// Returns the places of `keys` in ascending order. It is not generic, so that it is compiled once.
pub(super) fn order_of(keys: Vec<[u32; 2]>) -> Vec<usize> {
    let mut places: Vec<usize> = (0..keys.len()).collect();
    places.sort_by_key(|&place| keys[place]);
    places
}

/// The results of a query, in the order of the structure or in another one.
pub(super) enum Ordered<I: Iterator> {
    /// As the structure yields them.
    Own(I),
    /// In another order.
    Other(std::vec::IntoIter<I::Item>),
}

impl<I: Iterator> Iterator for Ordered<I> {
    type Item = I::Item;

    fn next(&mut self) -> Option<I::Item> {
        match self {
            Self::Own(items) => items.next(),
            Self::Other(items) => items.next(),
        }
    }
}

/// The results of a query, or the elements of a list. Keeps how many of them the program reads.
pub(super) struct Watched<'t, I, V: Handle, F: Handle> {
    items: I,
    tape: Option<&'t Tape<V, F>>,
    /// The place of the call.
    call: usize,
    taken: u32,
    finished: bool,
    is_list: bool,
}

impl<'t, I, V: Handle, F: Handle> Watched<'t, I, V, F> {
    /// Watches the results of a query. `call` puts the query on the tape, and returns its place.
    pub(super) fn results(
        items: I,
        tape: Option<&'t Tape<V, F>>,
        call: impl FnOnce(&mut TapeState<V, F>) -> usize,
    ) -> Self {
        Self::new(items, tape, call, false)
    }

    /// Watches a list of all elements of one kind.
    pub(super) fn list(items: I, tape: Option<&'t Tape<V, F>>, kind: ElementKind) -> Self {
        Self::new(
            items,
            tape,
            |state| state.push(Op::List(kind), [0; 2]),
            true,
        )
    }

    fn new(
        items: I,
        tape: Option<&'t Tape<V, F>>,
        call: impl FnOnce(&mut TapeState<V, F>) -> usize,
        is_list: bool,
    ) -> Self {
        Self {
            items,
            tape,
            call: tape.map_or(0, |tape| call(&mut tape.lock())),
            taken: 0,
            finished: tape.is_none(),
            is_list,
        }
    }

    /// Returns the next element, which `note` puts on the tape.
    fn next_noted<T>(&mut self, note: impl FnOnce(&mut TapeState<V, F>, &T)) -> Option<T>
    where
        I: Iterator<Item = T>,
    {
        let next = self.items.next();
        let Some(tape) = self.tape.filter(|_| !self.finished) else {
            return next;
        };
        let mut state = tape.lock();
        match &next {
            Some(item) => {
                self.taken = self.taken.saturating_add(1);
                note(&mut state, item);
            }
            None => {
                self.finished = true;
                if self.is_list {
                    state.push(Op::End, [0; 2]);
                }
            }
        }
        next
    }

    /// Turns the watched items into an iterator. `note` puts an item on the tape.
    pub(super) fn noting<N>(self, note: N) -> Noted<'t, I, V, F, N>
    where
        I: Iterator,
        N: Fn(&mut TapeState<V, F>, &I::Item),
    {
        Noted {
            watched: self,
            note,
        }
    }
}

impl<I, V: Handle, F: Handle> Drop for Watched<'_, I, V, F> {
    fn drop(&mut self) {
        let Some(tape) = self.tape.filter(|_| !self.finished) else {
            return;
        };
        let mut state = tape.lock();
        if let Some(call) = state.calls.get_mut(self.call) {
            call.taken = self.taken;
        }
        if self.is_list {
            state.push(Op::End, [0; 2]);
        }
    }
}

/// An iterator over watched items.
pub(super) struct Noted<'t, I, V: Handle, F: Handle, N> {
    watched: Watched<'t, I, V, F>,
    note: N,
}

impl<I, V, F, N> Iterator for Noted<'_, I, V, F, N>
where
    I: Iterator,
    V: Handle,
    F: Handle,
    N: Fn(&mut TapeState<V, F>, &I::Item),
{
    type Item = I::Item;

    fn next(&mut self) -> Option<I::Item> {
        self.watched.next_noted(&self.note)
    }
}

impl<V: Handle, F: Handle> TapeState<V, F> {
    pub(super) fn item(&mut self, name: [u32; 2]) {
        self.push(Op::Item, name);
    }
}
