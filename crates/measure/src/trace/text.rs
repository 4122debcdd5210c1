//! The text format of traces. `reports/SCHEMA.md` describes it.

use std::io::{self, BufRead, Write};

use sixfold::{Edit, Relation, UnknownName};
use sixfold_core::{EditByName, EditTextError};

use super::{ALL, Call, Measured, Op, Trace, TracedEdit};
use crate::operation::ElementKind;

/// The first line of a trace.
const FIRST_LINE: &str = "sixfold-trace 2";

/// The last word of an edit that the structure refused.
const REFUSED: &str = "refused";

/// The greatest number of lists that are open at once.
const MAX_DEPTH: usize = 64;

/// The greatest length of a line, in bytes.
const MAX_LINE: u64 = 1 << 20;

/// The number of elements on one line that is written.
const PER_LINE: usize = 16;

/// The reason why a trace cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TraceError {
    /// The file cannot be read.
    #[error("{file}: {error}")]
    Read {
        /// The name of the file.
        file: String,
        /// The reason.
        error: io::Error,
    },
    /// A line is wrong.
    #[error("{file}:{line}: {message}")]
    Line {
        /// The name of the file.
        file: String,
        /// The number of the line, from 1.
        line: usize,
        /// The description of the error.
        message: String,
    },
}

/// The words that start a line with calls.
fn words() -> Vec<&'static str> {
    let relations = Relation::ALL.map(Relation::name);
    let edits = Edit::ALL.map(Edit::name);
    let others = ["position", "set_positions", "list", "item", "end", "calls"];
    relations.into_iter().chain(edits).chain(others).collect()
}

impl Trace {
    /// Writes the trace as text; O(calls).
    ///
    /// # Errors
    ///
    /// Returns the error of `to`.
    pub fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        writeln!(to, "{FIRST_LINE}")?;
        writeln!(to, "program {}", self.program.replace(['\n', '\r'], " "))?;
        writeln!(to, "mesh {} {}", self.vertices, self.faces)?;
        if self.own_ns == 0.0 {
            writeln!(
                to,
                "# The program's own time is below what can be measured."
            )?;
        }
        writeln!(to, "own_ns {}", self.own_ns)?;
        if let Some(measured) = &self.measured {
            let Measured {
                structure,
                run_ns,
                replay_ns,
            } = measured;
            writeln!(to, "measured {structure} {run_ns} {replay_ns}")?;
        }
        let mut kinds = Vec::new();
        let mut on_line = 0;
        let mut last = None;
        for call in &self.calls {
            let continues = last == Some(call.op)
                && on_line < PER_LINE
                && matches!(call.op, Op::Query(_) | Op::Position | Op::Item);
            if !continues && last.is_some() {
                writeln!(to)?;
            }
            on_line = if continues { on_line + 1 } else { 1 };
            last = Some(call.op);
            match call.op {
                Op::Query(relation) => {
                    if !continues {
                        write!(to, "{}", relation.name())?;
                    }
                    write_name(to, ElementKind::queried_by(relation), call.name)?;
                }
                Op::Position => {
                    if !continues {
                        write!(to, "position")?;
                    }
                    write_name(to, ElementKind::Vertex, call.name)?;
                }
                Op::List(kind) => {
                    kinds.push(kind);
                    write!(to, "list {}", plural(kind))?;
                }
                Op::Item => {
                    if !continues {
                        write!(to, "item")?;
                    }
                    let kind = kinds.last().copied().unwrap_or(ElementKind::Vertex);
                    write_name(to, kind, call.name)?;
                }
                Op::End => {
                    kinds.pop();
                    write!(to, "end")?;
                }
                Op::Edit => write_edit(to, &self.edits[call.name[0] as usize])?,
                Op::SetPositions => write!(to, "set_positions")?,
            }
            if call.taken != ALL && !matches!(call.op, Op::End | Op::Item) {
                write!(to, "/{}", call.taken)?;
            }
        }
        if last.is_some() {
            writeln!(to)?;
        }
        writeln!(to, "calls {}", self.len())
    }

    /// Reads a trace. Errors contain the file name `file`. O(length of the text).
    ///
    /// ```
    /// let text = "sixfold-trace 2\nprogram mine\nmesh 4 4\nvertex_faces 0 1 2/1\ncalls 3\n";
    /// let trace = sixfold_measure::Trace::read("a.trace", text.as_bytes())?;
    /// assert_eq!((trace.program.as_str(), trace.len()), ("mine", 3));
    /// # Ok::<(), sixfold_measure::TraceError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if the text cannot be read, is not a trace, is cut off, or names an element
    /// that cannot exist.
    pub fn read(file: &str, text: impl BufRead) -> Result<Self, TraceError> {
        let mut reader = Reader {
            trace: Self::new("", 0, 0),
            vertices: 0,
            faces: 0,
            open: Vec::new(),
            calls: None,
        };
        let mut text = text;
        let mut line = String::new();
        let mut number = 0;
        loop {
            line.clear();
            number += 1;
            let mut limited = io::Read::take(&mut text, MAX_LINE);
            let read = limited.read_line(&mut line);
            let length = read.map_err(|error| TraceError::Read {
                file: file.into(),
                error,
            })?;
            if length == 0 {
                break;
            }
            let wrong = |message: String| TraceError::Line {
                file: file.into(),
                line: number,
                message,
            };
            if length as u64 == MAX_LINE && !line.ends_with('\n') {
                return Err(wrong(format!("the line has more than {MAX_LINE} bytes")));
            }
            let content = line.trim();
            if number == 1 {
                if content != FIRST_LINE {
                    return Err(wrong(format!(
                        "this is not a trace: its first line must be `{FIRST_LINE}`"
                    )));
                }
                continue;
            }
            reader.line(content).map_err(wrong)?;
        }
        reader.finish().map_err(|message| TraceError::Line {
            file: file.into(),
            line: number.saturating_sub(1).max(1),
            message,
        })
    }
}

const fn plural(kind: ElementKind) -> &'static str {
    match kind {
        ElementKind::Vertex => "vertices",
        ElementKind::Edge => "edges",
        ElementKind::Face => "faces",
    }
}

fn write_name(to: &mut dyn Write, kind: ElementKind, [a, b]: [u32; 2]) -> io::Result<()> {
    match kind {
        ElementKind::Edge => write!(to, " {a}-{b}"),
        ElementKind::Vertex | ElementKind::Face => write!(to, " {a}"),
    }
}

fn write_edit(to: &mut dyn Write, edit: &TracedEdit) -> io::Result<()> {
    write!(to, "{}", edit.call)?;
    match edit.refused {
        true => write!(to, " {REFUSED}"),
        false => Ok(()),
    }
}

/// The state while a trace is read.
struct Reader {
    trace: Trace,
    /// The numbers of vertices and faces that can exist at this place of the trace.
    vertices: u64,
    faces: u64,
    /// The lists that have not ended.
    open: Vec<ElementKind>,
    /// The number of calls, from the last line.
    calls: Option<u64>,
}

impl Reader {
    fn line(&mut self, line: &str) -> Result<(), String> {
        let content = line.split('#').next().unwrap_or_default();
        let mut words = content.split_whitespace();
        let Some(word) = words.next() else {
            return Ok(());
        };
        if self.calls.is_some() {
            return Err("the line `calls` must be the last".into());
        }
        match word {
            "program" => {
                let name = line
                    .trim_start()
                    .strip_prefix("program")
                    .unwrap_or_default();
                name.trim().clone_into(&mut self.trace.program);
                return Ok(());
            }
            "mesh" => return self.mesh(words),
            "own_ns" => {
                self.trace.own_ns = one(words.next(), "a number of nanoseconds")?;
                if !(self.trace.own_ns >= 0.0 && self.trace.own_ns.is_finite()) {
                    return Err("own_ns must be a number that is 0 or greater".into());
                }
                return nothing_more(words);
            }
            "measured" => {
                let structure = words.next().ok_or("expected the name of a structure")?;
                let mut time = || {
                    let ns: f64 = one(words.next(), "a number of nanoseconds")?;
                    let fine = ns >= 0.0 && ns.is_finite();
                    fine.then_some(ns)
                        .ok_or_else(|| "a time must be a number that is 0 or greater".to_owned())
                };
                self.trace.measured = Some(Measured {
                    structure: structure.to_owned(),
                    run_ns: time()?,
                    replay_ns: time()?,
                });
                return nothing_more(words);
            }
            "calls" => {
                self.calls = Some(one(words.next(), "the number of calls")?);
                return nothing_more(words);
            }
            _ => {}
        }
        if self.vertices == 0 {
            return Err("the line `mesh VERTICES FACES` must come before the calls".into());
        }
        self.call(content, word, words)
    }

    fn mesh<'w>(&mut self, mut words: impl Iterator<Item = &'w str>) -> Result<(), String> {
        if self.vertices > 0 {
            return Err("a trace has one line `mesh`".into());
        }
        let vertices: u32 = one(words.next(), "the number of vertices")?;
        let faces: u32 = one(words.next(), "the number of faces")?;
        if vertices == 0 || faces == 0 {
            return Err("the mesh of a trace must have vertices and faces".into());
        }
        (self.trace.vertices, self.trace.faces) = (vertices as usize, faces as usize);
        (self.vertices, self.faces) = (vertices.into(), faces.into());
        nothing_more(words)
    }

    fn call<'w>(
        &mut self,
        line: &str,
        word: &str,
        mut words: impl Iterator<Item = &'w str>,
    ) -> Result<(), String> {
        match word {
            "list" => {
                let (name, taken) = with_taken(words.next().unwrap_or_default())?;
                let mut kinds = ElementKind::ALL.into_iter();
                let kind = kinds.find(|&kind| plural(kind) == name).ok_or_else(|| {
                    format!("`list {name}`: a list is of vertices, edges or faces")
                })?;
                if self.open.len() >= MAX_DEPTH {
                    return Err(format!("more than {MAX_DEPTH} lists are open"));
                }
                self.open.push(kind);
                self.push(Op::List(kind), taken, [0; 2]);
                nothing_more(words)
            }
            "item" => {
                let Some(&kind) = self.open.last() else {
                    return Err("`item` outside a list: start with `list vertices`".into());
                };
                self.elements(Op::Item, kind, words)
            }
            "end" => {
                if self.open.pop().is_none() {
                    return Err("`end` without a list".into());
                }
                self.push(Op::End, ALL, [0; 2]);
                nothing_more(words)
            }
            "position" => self.elements(Op::Position, ElementKind::Vertex, words),
            "set_positions" => {
                self.push(Op::SetPositions, ALL, [0; 2]);
                nothing_more(words)
            }
            _ => {
                if let Ok(relation) = word.parse::<Relation>() {
                    let kind = ElementKind::queried_by(relation);
                    return self.elements(Op::Query(relation), kind, words);
                }
                self.edit(line)
            }
        }
    }

    fn push(&mut self, op: Op, taken: u32, name: [u32; 2]) {
        self.trace.calls.push(Call { op, taken, name });
    }

    /// Adds one call for each element of a line.
    fn elements<'w>(
        &mut self,
        op: Op,
        kind: ElementKind,
        words: impl Iterator<Item = &'w str>,
    ) -> Result<(), String> {
        let before = self.trace.calls.len();
        for word in words {
            let (name, taken) = with_taken(word)?;
            let name = match kind {
                ElementKind::Vertex => [self.vertex(name)?, 0],
                ElementKind::Face => [self.face(name)?, 0],
                ElementKind::Edge => self.edge(name)?,
            };
            self.push(op, taken, name);
        }
        match self.trace.calls.len() > before {
            true => Ok(()),
            false => Err(format!("the line names no {}", kind.name())),
        }
    }

    fn vertex(&self, word: &str) -> Result<u32, String> {
        self.known_vertex(one(Some(word), "the number of a vertex")?)
    }

    fn known_vertex(&self, number: u32) -> Result<u32, String> {
        match u64::from(number) < self.vertices {
            true => Ok(number),
            false => Err(format!(
                "vertex {number}: here the mesh has at most {} vertices, numbered from 0",
                self.vertices
            )),
        }
    }

    fn face(&self, word: &str) -> Result<u32, String> {
        self.known_face(one(Some(word), "the number of a face")?)
    }

    fn known_face(&self, number: u32) -> Result<u32, String> {
        match u64::from(number) < self.faces {
            true => Ok(number),
            false => Err(format!(
                "face {number}: here the mesh has at most {} faces, numbered from 0",
                self.faces
            )),
        }
    }

    fn edge(&self, word: &str) -> Result<[u32; 2], String> {
        let ends = word.split_once('-');
        let (a, b) = ends.ok_or_else(|| format!("`{word}`: an edge is two vertices, as in 3-7"))?;
        self.known_edge([self.vertex(a)?, self.vertex(b)?])
    }

    fn known_edge(&self, ends: [u32; 2]) -> Result<[u32; 2], String> {
        let [a, b] = [self.known_vertex(ends[0])?, self.known_vertex(ends[1])?];
        match a == b {
            true => Err(format!("`{a}-{b}`: the ends of an edge differ")),
            false => Ok([a.min(b), a.max(b)]),
        }
    }

    fn edit(&mut self, line: &str) -> Result<(), String> {
        let (text, refused) = match line.trim_end().strip_suffix(REFUSED) {
            Some(text) => (text.trim_end(), true),
            None => (line.trim_end(), false),
        };
        let call: EditByName = text.parse().map_err(|error| match error {
            EditTextError::UnknownEdit(error) => {
                UnknownName::new("call", &error.given, words()).to_string()
            }
            error => error.to_string(),
        })?;
        let call = call.try_map(
            |&v| self.known_vertex(v),
            |&ends| self.known_edge(ends),
            |&f| self.known_face(f),
        )?;
        if !refused {
            // An edit makes at most one vertex. The structure checks the number of faces.
            self.vertices += 1;
            self.faces = u32::MAX.into();
        }
        self.push(Op::Edit, ALL, [self.trace.edits.len() as u32, 0]);
        self.trace.edits.push(TracedEdit { call, refused });
        Ok(())
    }

    fn finish(self) -> Result<Trace, String> {
        let mut trace = self.trace;
        let Some(calls) = self.calls else {
            return Err("the trace is cut off: its last line must be `calls NUMBER`".into());
        };
        if calls != trace.len() as u64 {
            return Err(format!(
                "the trace has {} calls, but its last line says {calls}",
                trace.len()
            ));
        }
        if trace.is_empty() {
            return Err("the trace has no calls".into());
        }
        for _ in self.open {
            trace.calls.push(Call {
                op: Op::End,
                taken: ALL,
                name: [0; 2],
            });
        }
        Ok(trace)
    }
}

/// Splits `7/2` into the name and the number of results that the program reads.
fn with_taken(word: &str) -> Result<(&str, u32), String> {
    match word.split_once('/') {
        None => Ok((word, ALL)),
        Some((name, taken)) => Ok((name, one(Some(taken), "a number of results")?)),
    }
}

fn one<T: std::str::FromStr>(word: Option<&str>, what: &str) -> Result<T, String> {
    let word = word.ok_or_else(|| format!("missing {what}"))?;
    word.parse().map_err(|_| format!("`{word}` is not {what}"))
}

fn nothing_more<'w>(mut words: impl Iterator<Item = &'w str>) -> Result<(), String> {
    match words.next() {
        None => Ok(()),
        Some(word) => Err(format!("`{word}` is one word too many on this line")),
    }
}
