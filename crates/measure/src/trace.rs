//! Traces: the calls of one run of a program, in order. A trace runs again on every structure.
//!
//! A trace names vertices and faces by their numbers in the mesh file, and edges by their two ends.
//! Before the timing, each structure translates the names to its own handles.

mod replay;
#[cfg(test)]
mod tests;
mod text;

use sixfold::Relation;
use sixfold_core::EditByName;

use crate::operation::ElementKind;
use crate::program::ProgramKind;

pub use replay::{EditReplay, PlainReplay};
pub use text::TraceError;

/// The calls of one run of a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// The name of the program.
    pub program: String,
    /// The number of vertices of the mesh on which the trace was recorded.
    pub vertices: usize,
    /// The number of faces of this mesh.
    pub faces: usize,
    /// The time of one run outside the calls, in nanoseconds; 0 if it is too short to be measured. It is
    /// added to the time of every structure.
    pub own_ns: f64,
    /// What was measured when the trace was recorded; `None` if the trace was not made from a program.
    pub measured: Option<Measured>,
    /// The calls, in order.
    pub calls: Vec<Call>,
    /// The edits, in order.
    pub edits: Vec<TracedEdit>,
}

/// The times that were measured when a trace was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The name of the structure.
    pub structure: String,
    /// The time of a run of the program in nanoseconds.
    pub run_ns: f64,
    /// The time of a run of its trace in nanoseconds, measured in turn with the program.
    pub replay_ns: f64,
}

/// One call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Call {
    /// What is called.
    pub op: Op,
    /// The number of results that the program reads; `u32::MAX` if it reads all.
    pub taken: u32,
    /// A vertex and 0, a face and 0, the two ends of an edge, or the place of an edit and 0.
    pub name: [u32; 2],
}

/// The number of results if a program reads all of them.
pub(crate) const ALL: u32 = u32::MAX;

/// The name of an element that does not exist.
pub(crate) const NONE: u32 = u32::MAX;

/// What a call does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op {
    /// Queries a relation of an element.
    Query(Relation),
    /// Reads the position of a vertex.
    Position,
    /// Starts to list all elements of one kind.
    List(ElementKind),
    /// Takes the next element of the innermost list. The calls that follow belong to it.
    Item,
    /// Ends the innermost list.
    End,
    /// Does the edit at the place `name[0]` of the list of edits.
    Edit,
    /// Writes the positions of all vertices.
    SetPositions,
}

/// One edit.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedEdit {
    /// The edit, with the names of its elements.
    pub call: EditByName,
    /// Whether the structure refused the edit.
    pub refused: bool,
}

impl Trace {
    /// Makes a trace without calls, of a mesh with the given numbers of elements.
    pub fn new(program: &str, vertices: usize, faces: usize) -> Self {
        Self {
            program: program.to_owned(),
            vertices,
            faces,
            own_ns: 0.0,
            measured: None,
            calls: Vec::new(),
            edits: Vec::new(),
        }
    }

    /// Returns the number of calls. The lists of elements count once, however many elements they
    /// have.
    pub fn len(&self) -> usize {
        let calls = self.calls.iter();
        calls
            .filter(|c| !matches!(c.op, Op::Item | Op::End))
            .count()
    }

    /// Returns whether the trace has no calls.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns what the trace needs of a structure. O(calls).
    pub fn kind(&self) -> ProgramKind {
        if !self.edits.is_empty() {
            return ProgramKind::Edits;
        }
        match self.calls.iter().any(|c| c.op == Op::SetPositions) {
            true => ProgramKind::Moves,
            false => ProgramKind::Queries,
        }
    }
}
