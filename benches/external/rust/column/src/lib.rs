//! Runs a library as a column of `sixfold study`. An adapter implements the queries; this crate
//! implements the protocol and the operations. Both are described in `benches/external/README.md`.

mod input;
mod operations;

use std::any::Any;
use std::error::Error;
use std::io::{self, BufRead, Write};
use std::panic;

use serde::{Deserialize, Serialize};

pub use input::Input;

/// A structure of a library that holds one mesh. Queries call `sink` for each result.
pub trait Column: Sized {
    /// A vertex.
    type Vertex: Copy + PartialEq;
    /// An edge.
    type Edge: Copy + PartialEq;
    /// A face.
    type Face: Copy;

    /// The name and the version of the library.
    const LIBRARY: &'static str;

    /// Builds the structure from flat arrays. If this is not possible, returns the reason.
    fn build(input: &Input) -> Result<Self, String>;

    /// Lists all vertices.
    fn vertices(&self) -> impl Iterator<Item = Self::Vertex>;
    /// Lists all edges.
    fn edges(&self) -> impl Iterator<Item = Self::Edge>;
    /// Lists all faces, in input order.
    fn faces(&self) -> impl Iterator<Item = Self::Face>;

    /// Returns the number of a vertex. Numbers count from 0 without gaps.
    fn vertex_index(&self, v: Self::Vertex) -> usize;
    /// Returns a number that identifies the edge.
    fn edge_index(&self, e: Self::Edge) -> usize;
    /// Returns the number of a face, in input order.
    fn face_index(&self, f: Self::Face) -> usize;

    /// Queries the vertices adjacent to `v`.
    fn vertex_vertices(&self, v: Self::Vertex, sink: impl FnMut(Self::Vertex));
    /// Queries the edges that end at `v`.
    fn vertex_edges(&self, v: Self::Vertex, sink: impl FnMut(Self::Edge));
    /// Queries the faces with a corner at `v`.
    fn vertex_faces(&self, v: Self::Vertex, sink: impl FnMut(Self::Face));
    /// Returns the ends of `e`.
    fn edge_vertices(&self, e: Self::Edge) -> [Self::Vertex; 2];
    /// Queries the faces on `e`.
    fn edge_faces(&self, e: Self::Edge, sink: impl FnMut(Self::Face));
    /// Queries the corners of `f`, in order.
    fn face_vertices(&self, f: Self::Face, sink: impl FnMut(Self::Vertex));
    /// Queries the edges of `f`.
    fn face_edges(&self, f: Self::Face, sink: impl FnMut(Self::Edge));
    /// Queries the faces across the edges of `f`.
    fn face_faces(&self, f: Self::Face, sink: impl FnMut(Self::Face));
    /// Queries the edges that share a vertex with `e`.
    fn edge_edges(&self, e: Self::Edge, mut sink: impl FnMut(Self::Edge)) {
        for v in self.edge_vertices(e) {
            self.vertex_edges(v, |other| {
                if other != e {
                    sink(other);
                }
            });
        }
    }

    /// Returns the position of `v`.
    fn position(&self, v: Self::Vertex) -> [f32; 3];
    /// Sets the positions of all vertices, by vertex number.
    fn set_positions(&mut self, positions: &[[f32; 3]]);
}

#[derive(Serialize)]
struct Header<'a> {
    protocol: u32,
    holds: bool,
    /// The name and the version of the library, the compiler and its flags.
    library: &'a str,
    /// The bytes that the library allocated for the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    bytes: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    /// The allocator, if an environment variable can make this allocator keep its pages.
    #[serde(skip_serializing_if = "Option::is_none")]
    heap: Option<&'static str>,
}

#[derive(Deserialize)]
struct Request {
    run: String,
    times: u64,
}

#[derive(Serialize)]
struct Response {
    wall_ns: u128,
    cpu_ns: u128,
    checksum: f64,
    elements: u64,
}

#[derive(Serialize)]
struct Refused<'a> {
    refused: &'a str,
}

/// Reads the mesh at the path in the first argument, and answers requests until standard input
/// ends.
///
/// # Errors
///
/// Returns an error if the argument is missing, the mesh cannot be read, or a request is not valid.
pub fn serve<C: Column>() -> Result<(), Box<dyn Error>> {
    let path = std::env::args()
        .nth(1)
        .ok_or("the path of a mesh is missing")?;
    let input = Input::read(&path)?;
    // Some libraries panic if they cannot hold the mesh.
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| ()));
    let built = panic::catch_unwind(|| {
        let before = allocated();
        let structure = C::build(&input)?;
        let bytes = allocated().zip(before).map(|(now, before)| now - before);
        Ok((operations::Runner::new(input.clone(), structure)?, bytes))
    });
    panic::set_hook(hook);
    let built = built.unwrap_or_else(|payload| Err(panic_message(payload.as_ref())));
    write_line(&Header {
        protocol: 1,
        holds: built.is_ok(),
        library: &format!("{} ({})", C::LIBRARY, env!("COMPILER")),
        bytes: built.as_ref().ok().and_then(|(_, bytes)| *bytes),
        reason: built.as_ref().err().cloned(),
        heap: cfg!(all(target_os = "linux", target_env = "gnu")).then_some("glibc"),
    })?;
    let Ok((mut runner, _)) = built else {
        return Ok(());
    };
    for line in io::stdin().lock().lines() {
        let request: Request = serde_json::from_str(&line?)?;
        match runner.run(&request.run, request.times) {
            Some(response) => write_line(&response)?,
            None => write_line(&Refused {
                refused: "the adapter does not support the operation",
            })?,
        }
    }
    Ok(())
}

/// Returns the bytes that the program has allocated, if the allocator says it.
fn allocated() -> Option<usize> {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        // SAFETY: the function has no arguments and only reads the counters of the allocator, which it locks.
        let now = unsafe { libc::mallinfo2() };
        Some(now.uordblks + now.hblkhd)
    }
    #[cfg(not(all(target_os = "linux", target_env = "gnu")))]
    None
}

fn panic_message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(ToString::to_string);
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "it panicked".into())
}

fn write_line(what: &impl Serialize) -> io::Result<()> {
    let mut out = io::stdout().lock();
    serde_json::to_writer(&mut out, what)?;
    writeln!(out)?;
    out.flush()
}
