//! How much of its tables a structure reads to answer a relation: counted, so free of noise.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};
use sixfold::{MeshQuery, QueryCost, Relation, Representation};

use crate::ledger::{LINE_BYTES, Ledger, Step, Sum};

/// How many elements stand for all where a structure scans: evenly spaced, the first among them.
pub const SAMPLE: usize = 16;
/// Where elements read more rows than this on average, a sample stands for all, too: at a vertex of
/// very many faces a walk is as bad as a scan.
pub const MOST_READS: u64 = 256;

/// What one relation reads, asked of every element in the order of the structure, or of a sample.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Reads {
    /// The relation.
    pub relation: Relation,
    /// How many elements there are to ask.
    pub elements: u64,
    /// How many were asked.
    pub asked: u64,
    /// A sample was asked; the figures for a query are its means.
    pub sampled: bool,
    /// Answers to a query.
    pub answers: f64,
    /// Rows that a query reads, one as often as it is read.
    pub reads: f64,
    /// Bytes that a query reads, each once.
    pub bytes: f64,
    /// Cache lines that a query touches, each once.
    pub lines: f64,
    /// Rows read by listing the elements, for each of them.
    pub listing_reads: f64,
    /// Lines that a small cache has to fetch, listing included, for each element.
    pub fetched: f64,
    /// Those of them that lie near none it has.
    pub jumps: f64,
    /// Lines that the whole sweep touches, listing included, each once; of the sample if there is one.
    pub sweep_lines: u64,
    /// Bytes that have to move for each element: the lines of the sweep, each once; where a sample was
    /// asked, all the lines of a query, for each goes through them anew.
    pub moved_bytes: f64,
    /// By table: the rows that a query reads.
    pub tables: Vec<TableReads>,
}

impl Reads {
    /// The bytes of all lines that a sweep touches.
    pub fn sweep_bytes(&self) -> usize {
        usize::try_from(self.sweep_lines).map_or(usize::MAX, |lines| lines * LINE_BYTES)
    }
}

/// What a query reads of one table.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct TableReads {
    /// The table.
    pub table: String,
    /// Bytes of a row.
    pub row_bytes: usize,
    /// Rows that a query reads, one as often as it is read.
    pub reads: f64,
}

/// Where a count is kept as it goes: hears of each relation before, and of what was found after.
pub trait Counted {
    /// `relation` is asked now.
    fn begins(&mut self, relation: Relation);
    /// What it read.
    fn ends(&mut self, reads: Reads);
}

/// Asks `relations` of `mesh` and counts, until told to stop.
///
/// Time and memory: what the queries take several times over, and a third of the mesh beside it.
pub(crate) fn count<M: Representation>(
    mesh: M,
    relations: &[Relation],
    stop: &AtomicBool,
    counted: &mut dyn Counted,
) {
    let ledger = Ledger::of(&mesh.memory());
    let elements = [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()];
    let watched = mesh.probed(ledger.clone());
    let counting = Counting {
        mesh: &watched,
        ledger: &ledger,
        stop,
    };
    for &relation in relations {
        counted.begins(relation);
        let elements = elements[relation as usize / 3];
        let scans = M::COSTS[relation as usize] == QueryCost::Scan && elements > SAMPLE;
        let whole = if scans {
            None
        } else {
            counting.ask(relation, elements, elements)
        };
        let found = whole.or_else(|| counting.ask(relation, elements, SAMPLE));
        if stop.load(Ordering::Relaxed) {
            return;
        }
        if let Some(reads) = found {
            counted.ends(reads);
        }
    }
}

/// A watched mesh, and who watches.
struct Counting<'a, M> {
    mesh: &'a M,
    ledger: &'a Ledger,
    stop: &'a AtomicBool,
}

impl<M: MeshQuery> Counting<'_, M> {
    /// Asks `asked` of the `elements`; `None` if told to stop, or if that is all of them and they
    /// read too much.
    fn ask(&self, relation: Relation, elements: usize, asked: usize) -> Option<Reads> {
        let mesh = self.mesh;
        let sweep = Sweep {
            relation,
            elements,
            asked: asked.min(elements),
        };
        let (v, e, f) = (|| mesh.vertices(), || mesh.edges(), || mesh.faces());
        match relation {
            Relation::VertexVertices => self.go(sweep, v, |v| number(mesh.vertex_vertices(v))),
            Relation::VertexEdges => self.go(sweep, v, |v| number(mesh.vertex_edges(v))),
            Relation::VertexFaces => self.go(sweep, v, |v| number(mesh.vertex_faces(v))),
            Relation::EdgeVertices => self.go(sweep, e, |e| number(mesh.edge_vertices(e))),
            Relation::EdgeEdges => self.go(sweep, e, |e| number(mesh.edge_edges(e))),
            Relation::EdgeFaces => self.go(sweep, e, |e| number(mesh.edge_faces(e))),
            Relation::FaceVertices => self.go(sweep, f, |f| number(mesh.face_vertices(f))),
            Relation::FaceEdges => self.go(sweep, f, |f| number(mesh.face_edges(f))),
            Relation::FaceFaces => self.go(sweep, f, |f| number(mesh.face_faces(f))),
        }
    }

    /// Lists the elements one by one, as the timed sweep does, and asks those that are to be asked.
    fn go<I: Iterator>(
        &self,
        sweep: Sweep,
        list: impl FnOnce() -> I,
        mut ask: impl FnMut(I::Item) -> u64,
    ) -> Option<Reads> {
        let ledger = self.ledger;
        ledger.clear();
        ledger.begin(Step::Listing);
        let mut elements = list();
        let (mut answers, mut asked) = (0, 0);
        for i in 0.. {
            ledger.begin(Step::Listing);
            let Some(element) = elements.next() else {
                break;
            };
            if i == sweep.next(asked) {
                ledger.begin(Step::Asking);
                answers += ask(element);
                asked += 1;
            }
            if self.stop.load(Ordering::Relaxed) || sweep.reads_too_much(ledger) {
                return None;
            }
        }
        Some(sweep.reads(asked, answers, ledger))
    }
}

/// How many of how many elements are asked what.
#[derive(Clone, Copy)]
struct Sweep {
    relation: Relation,
    elements: usize,
    asked: usize,
}

impl Sweep {
    /// The place in the list of the next to ask, when so many have been asked.
    fn next(self, asked: usize) -> usize {
        // Wide enough for any number of elements.
        (asked as u128 * self.elements as u128 / self.asked.max(1) as u128) as usize
    }

    fn sampled(self) -> bool {
        self.asked < self.elements
    }

    fn reads_too_much(self, ledger: &Ledger) -> bool {
        let most = MOST_READS.saturating_mul(self.elements as u64);
        !self.sampled() && self.elements > SAMPLE && ledger.sum(Step::Asking).reads > most
    }

    fn reads(self, asked: usize, answers: u64, ledger: &Ledger) -> Reads {
        let (listing, asking) = (ledger.sum(Step::Listing), ledger.sum(Step::Asking));
        let a_query = |number: u64| number as f64 / asked.max(1) as f64;
        let an_element = |number: u64| number as f64 / self.elements.max(1) as f64;
        let both = |of: fn(Sum) -> u64| an_element(of(listing)) + a_query(of(asking));
        let moved_lines = match self.sampled() {
            true => a_query(asking.lines),
            false => an_element(ledger.touched()),
        };
        let tables = ledger.tables().map(|(table, row_bytes, reads)| TableReads {
            table: table.into(),
            row_bytes,
            reads: a_query(reads),
        });
        Reads {
            relation: self.relation,
            elements: self.elements as u64,
            asked: asked as u64,
            sampled: self.sampled(),
            answers: a_query(answers),
            reads: a_query(asking.reads),
            bytes: a_query(asking.bytes),
            lines: a_query(asking.lines),
            listing_reads: an_element(listing.reads),
            fetched: both(|sum| sum.fetched),
            jumps: both(|sum| sum.jumps),
            sweep_lines: ledger.touched(),
            moved_bytes: moved_lines * LINE_BYTES as f64,
            tables: tables.collect(),
        }
    }
}

/// How many answers there are. Folded, as the timed sweep does: a walk may read otherwise step by step.
fn number(answers: impl IntoIterator) -> u64 {
    answers.into_iter().fold(0, |number, _| number + 1)
}

#[cfg(test)]
mod tests;
