//! Counts how much of its tables a structure reads to answer a relation. Counts are free of noise.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};
use sixfold::{Measured, MeshQuery, QueryCost, Relation};

use crate::ledger::{LINE_BYTES, Ledger, Step, Sum};

/// Number of sampled elements if a structure scans: evenly spaced, including the first element.
pub const SAMPLE: usize = 16;
/// If a query reads more rows than this on average, a sample is used too: at a vertex with very
/// many faces, a walk is as slow as a scan.
pub const MOST_READS: u64 = 256;

/// The reads of one relation, queried of every element in the order of the structure, or of a
/// sample.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Reads {
    /// The relation.
    pub relation: Relation,
    /// Number of elements of the queried kind.
    pub elements: u64,
    /// Number of elements that were queried.
    pub asked: u64,
    /// Whether only a sample was queried; the values per query are then means over the sample.
    pub sampled: bool,
    /// Results per query.
    pub answers: f64,
    /// Row reads per query; a row counts each time it is read.
    pub reads: f64,
    /// Bytes read per query, each once.
    pub bytes: f64,
    /// Cache lines touched per query, each once.
    pub lines: f64,
    /// Row reads for listing the elements, per element.
    pub listing_reads: f64,
    /// Lines that a small cache has to fetch, per element, including listing.
    pub fetched: f64,
    /// Fetched lines that are not near a cached line, per element.
    pub jumps: f64,
    /// Lines that the whole sweep touches, each once, including listing. Of the sample if there is
    /// one.
    pub sweep_lines: u64,
    /// Bytes to move per element: the lines of the sweep, each once. If a sample was queried: all
    /// lines of a query, because each query reads them again.
    pub moved_bytes: f64,
    /// By table: the row reads per query.
    pub tables: Vec<TableReads>,
}

impl Reads {
    /// Returns the bytes of all lines that a sweep touches.
    pub fn sweep_bytes(&self) -> usize {
        usize::try_from(self.sweep_lines).map_or(usize::MAX, |lines| lines * LINE_BYTES)
    }
}

/// The reads of one table by a query.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct TableReads {
    /// The name of the table.
    pub table: String,
    /// Bytes of a row.
    pub row_bytes: usize,
    /// Row reads per query; a row counts each time it is read.
    pub reads: f64,
}

/// A receiver of the counts: called before and after each relation.
pub trait Counted {
    /// Called before `relation` is queried.
    fn begins(&mut self, relation: Relation);
    /// Called with the counts of a relation.
    fn ends(&mut self, reads: Reads);
}

/// Queries `relations` of `mesh` and counts the reads, until `stop` is true.
///
/// Takes several times the time of the queries, and a third of the memory of the mesh in addition.
pub(crate) fn count<M: Measured>(
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

/// A mesh with a probe, and the ledger of that probe.
struct Counting<'a, M> {
    mesh: &'a M,
    ledger: &'a Ledger,
    stop: &'a AtomicBool,
}

impl<M: MeshQuery> Counting<'_, M> {
    /// Queries `asked` of the `elements`. Returns `None` if `stop` is true, or if all elements are
    /// queried and read too much.
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

    /// Lists the elements one by one, as the timed sweep does, and queries the selected ones.
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

/// The relation to query, the number of elements, and the number of them to query.
#[derive(Clone, Copy)]
struct Sweep {
    relation: Relation,
    elements: usize,
    asked: usize,
}

impl Sweep {
    /// Returns the list index of the next element to query after `asked` queries.
    fn next(self, asked: usize) -> usize {
        // `u128` cannot overflow here.
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

/// Counts the results with `fold`, as the timed sweep does: calling `next` may read other rows.
fn number(answers: impl IntoIterator) -> u64 {
    answers.into_iter().fold(0, |number, _| number + 1)
}

#[cfg(test)]
mod tests;
