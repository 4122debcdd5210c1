//! A library as a column of `sixfold study`: an adapter says how the library answers, and this crate
//! speaks the protocol and runs the operations. `../README.md` has both.

mod input;
mod operations;

use std::any::Any;
use std::error::Error;
use std::io::{self, BufRead, Write};
use std::panic;

use serde::{Deserialize, Serialize};

pub use input::Input;

/// A structure of a library, holding one mesh. Sinks are called for each neighbour.
pub trait Column: Sized {
    /// A vertex.
    type Vertex: Copy + PartialEq;
    /// An edge.
    type Edge: Copy + PartialEq;
    /// A face.
    type Face: Copy;

    /// The library and its version.
    const LIBRARY: &'static str;

    /// From flat arrays, or why not.
    fn build(input: &Input) -> Result<Self, String>;

    /// All vertices.
    fn vertices(&self) -> impl Iterator<Item = Self::Vertex>;
    /// All edges.
    fn edges(&self) -> impl Iterator<Item = Self::Edge>;
    /// All faces, in the order of the input.
    fn faces(&self) -> impl Iterator<Item = Self::Face>;

    /// The number of a vertex, below that of all.
    fn vertex_index(&self, v: Self::Vertex) -> usize;
    /// Some number of an edge.
    fn edge_index(&self, e: Self::Edge) -> usize;
    /// The number of a face, in the order of the input.
    fn face_index(&self, f: Self::Face) -> usize;

    /// The vertices beside `v`.
    fn vertex_vertices(&self, v: Self::Vertex, sink: impl FnMut(Self::Vertex));
    /// The edges that end in `v`.
    fn vertex_edges(&self, v: Self::Vertex, sink: impl FnMut(Self::Edge));
    /// The faces that have `v`.
    fn vertex_faces(&self, v: Self::Vertex, sink: impl FnMut(Self::Face));
    /// The ends of `e`.
    fn edge_vertices(&self, e: Self::Edge) -> [Self::Vertex; 2];
    /// The faces along `e`.
    fn edge_faces(&self, e: Self::Edge, sink: impl FnMut(Self::Face));
    /// The corners of `f`, in order.
    fn face_vertices(&self, f: Self::Face, sink: impl FnMut(Self::Vertex));
    /// The edges of `f`.
    fn face_edges(&self, f: Self::Face, sink: impl FnMut(Self::Edge));
    /// The faces across the edges of `f`.
    fn face_faces(&self, f: Self::Face, sink: impl FnMut(Self::Face));
    /// The edges that share a vertex with `e`.
    fn edge_edges(&self, e: Self::Edge, mut sink: impl FnMut(Self::Edge)) {
        for v in self.edge_vertices(e) {
            self.vertex_edges(v, |other| {
                if other != e {
                    sink(other);
                }
            });
        }
    }

    /// Where `v` is.
    fn position(&self, v: Self::Vertex) -> [f32; 3];
    /// Moves all vertices, by their numbers.
    fn set_positions(&mut self, positions: &[[f32; 3]]);
}

#[derive(Serialize)]
struct Greeting<'a> {
    protocol: u32,
    holds: bool,
    library: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    /// The allocator, where Sixfold's environment can tell it to keep pages.
    #[serde(skip_serializing_if = "Option::is_none")]
    heap: Option<&'static str>,
}

#[derive(Deserialize)]
struct Question {
    run: String,
    times: u64,
}

#[derive(Serialize)]
struct Answer {
    wall_ns: u128,
    cpu_ns: u128,
    checksum: f64,
    elements: u64,
}

#[derive(Serialize)]
struct Refused<'a> {
    refused: &'a str,
}

/// The whole program: reads the mesh that it is called with, and answers until its input ends.
///
/// # Errors
///
/// No mesh, one that cannot be read, or a question that is none.
pub fn serve<C: Column>() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("say which mesh")?;
    let input = Input::read(&path)?;
    // Some libraries panic at what they cannot hold.
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| ()));
    let built = panic::catch_unwind(|| operations::Running::new(input.clone(), C::build(&input)?));
    panic::set_hook(hook);
    let built = built.unwrap_or_else(|payload| Err(words(payload.as_ref())));
    say(&Greeting {
        protocol: 1,
        holds: built.is_ok(),
        library: C::LIBRARY,
        reason: built.as_ref().err().cloned(),
        heap: cfg!(all(target_os = "linux", target_env = "gnu")).then_some("glibc"),
    })?;
    let Ok(mut running) = built else {
        return Ok(());
    };
    for line in io::stdin().lock().lines() {
        let question: Question = serde_json::from_str(&line?)?;
        match running.run(&question.run, question.times) {
            Some(answer) => say(&answer)?,
            None => say(&Refused {
                refused: "the adapter does not do it",
            })?,
        }
    }
    Ok(())
}

/// What a panic said.
fn words(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(ToString::to_string);
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "it panicked".into())
}

fn say(what: &impl Serialize) -> io::Result<()> {
    let mut out = io::stdout().lock();
    serde_json::to_writer(&mut out, what)?;
    writeln!(out)?;
    out.flush()
}
