//! Counts the table reads that relations need. The counts are exact and equal in every run.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};
use sixfold::{MeshQuery, QueryCost, Relation};
use sixfold_core::Measured;

use crate::read_probe::{CountingProbe, LINE_BYTES, ReadCounts, Step};

/// Number of elements in a sample. The elements of a sample are evenly spaced.
pub const SCAN_SAMPLE: usize = 16;
/// Maximum number of table rows that a query may read, as a mean over all elements. If the queries
/// of a relation read more rows, only [`SCAN_SAMPLE`] elements are queried.
pub const MAX_READS: u64 = 256;

/// The table reads of one relation. The relation is queried at all elements in the order of the
/// structure, or at a sample of evenly spaced elements.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Reads {
    /// The queried relation.
    pub relation: Relation,
    /// Number of elements at which the relation can be queried.
    pub elements: u64,
    /// Number of elements at which the relation was queried.
    #[serde(rename = "asked")]
    pub queried: u64,
    /// True if only a sample of evenly spaced elements was queried. If true, values per query are
    /// means over the sample.
    pub sampled: bool,
    /// Mean number of results per query.
    pub answers: f64,
    /// Mean number of table rows that a query reads. A row that a query reads twice counts twice.
    pub reads: f64,
    /// Mean number of bytes that a query reads. A byte that a query reads twice counts once.
    pub bytes: f64,
    /// Mean number of cache lines that a query touches. A cache line that a query touches twice
    /// counts once.
    pub lines: f64,
    /// Number of table rows that are read to list the elements, divided by the number of elements.
    pub listing_reads: f64,
    /// Mean number of cache lines per element that a small simulated cache fetches from memory. The
    /// lines that are read to list the elements are included.
    pub fetched: f64,
    /// Mean number of jumps per element. A jump is the fetch of a cache line that is not near any
    /// line in the simulated cache.
    pub jumps: f64,
    /// Number of distinct cache lines that are touched while the elements are listed and queried.
    /// If only a sample of the elements is queried, the number does not include lines that only
    /// queries of other elements would touch.
    pub sweep_lines: u64,
    /// Estimate of the bytes per element that must be moved from memory. If all elements are
    /// queried, each touched cache line counts once for the whole mesh. If only a sample is
    /// queried, each cache line counts once for each query that touches the line.
    pub moved_bytes: f64,
    /// The number of rows that a query reads from each table.
    pub tables: Vec<TableReads>,
}

impl Reads {
    /// Returns the bytes of all distinct cache lines that are touched while the elements are
    /// queried.
    pub fn sweep_bytes(&self) -> usize {
        usize::try_from(self.sweep_lines).map_or(usize::MAX, |lines| lines * LINE_BYTES)
    }
}

/// The reads of one table by the queries of one relation.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct TableReads {
    /// The name of the table.
    pub table: String,
    /// Bytes of one row of the table.
    pub row_bytes: usize,
    /// Mean number of rows of the table that a query reads.
    pub reads: f64,
}

/// A receiver for the counts of table reads, one relation after the other.
pub trait ReadsObserver {
    /// Called before the reads of `relation` are counted.
    fn relation_started(&mut self, relation: Relation);
    /// Called with the counts of table reads of a relation after the relation was queried.
    fn relation_counted(&mut self, reads: Reads);
}

/// Queries `relations` of `mesh` and counts the reads, until `stop` is true.
///
/// The counting takes several times as long as the queries. It needs additional memory of a third
/// of the mesh.
pub(crate) fn count<M: Measured>(
    mesh: M,
    relations: &[Relation],
    stop: &AtomicBool,
    observer: &mut dyn ReadsObserver,
) {
    let probe = CountingProbe::new(&mesh.memory());
    let elements = [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()];
    let probed = mesh.probed(probe.clone());
    let counter = ReadCounter {
        mesh: &probed,
        probe: &probe,
        stop,
    };
    for &relation in relations {
        observer.relation_started(relation);
        let elements = elements[relation as usize / 3];
        let scans = M::cost(relation) == QueryCost::Scan && elements > SCAN_SAMPLE;
        let whole = if scans {
            None
        } else {
            counter.count(relation, elements, elements)
        };
        let found = whole.or_else(|| counter.count(relation, elements, SCAN_SAMPLE));
        if stop.load(Ordering::Relaxed) {
            return;
        }
        if let Some(reads) = found {
            observer.relation_counted(reads);
        }
    }
}

struct ReadCounter<'a, M> {
    mesh: &'a M,
    probe: &'a CountingProbe,
    stop: &'a AtomicBool,
}

impl<M: MeshQuery> ReadCounter<'_, M> {
    /// Queries `queried` of the `elements`. Returns `None` if `stop` is true. Also returns `None`
    /// if all elements are queried and a query reads too many rows on average.
    fn count(&self, relation: Relation, elements: usize, queried: usize) -> Option<Reads> {
        let mesh = self.mesh;
        let sweep = Sweep {
            relation,
            elements,
            queried: queried.min(elements),
        };
        macro_rules! count_relation {
            ($query:ident $list:ident $from:ident $to:ident) => {
                self.count_sweep(
                    sweep,
                    || mesh.$list(),
                    |element| count_results(mesh.$query(element)),
                )
            };
        }
        sixfold_core::match_relation!(relation, count_relation!)
    }

    /// Lists the elements one by one, as the timed sweep does, and queries the selected elements.
    fn count_sweep<I: Iterator>(
        &self,
        sweep: Sweep,
        list: impl FnOnce() -> I,
        mut query: impl FnMut(I::Item) -> u64,
    ) -> Option<Reads> {
        let probe = self.probe;
        probe.clear();
        probe.begin(Step::Listing);
        let mut elements = list();
        let (mut answers, mut queried) = (0, 0);
        for i in 0.. {
            probe.begin(Step::Listing);
            let Some(element) = elements.next() else {
                break;
            };
            if i == sweep.nth_index(queried) {
                probe.begin(Step::Querying);
                answers += query(element);
                queried += 1;
            }
            if self.stop.load(Ordering::Relaxed) || sweep.reads_too_much(probe) {
                return None;
            }
        }
        Some(sweep.reads(queried, answers, probe))
    }
}

#[derive(Clone, Copy)]
struct Sweep {
    relation: Relation,
    elements: usize,
    queried: usize,
}

impl Sweep {
    /// Returns the list index of the next element after `queried` queries.
    fn nth_index(self, queried: usize) -> usize {
        (queried as u128 * self.elements as u128 / self.queried.max(1) as u128) as usize
    }

    fn is_sampled(self) -> bool {
        self.queried < self.elements
    }

    fn reads_too_much(self, probe: &CountingProbe) -> bool {
        let limit = MAX_READS.saturating_mul(self.elements as u64);
        !self.is_sampled()
            && self.elements > SCAN_SAMPLE
            && probe.counts(Step::Querying).reads > limit
    }

    fn reads(self, queried: usize, answers: u64, probe: &CountingProbe) -> Reads {
        let (listing, querying) = (probe.counts(Step::Listing), probe.counts(Step::Querying));
        let per_query = |number: u64| number as f64 / queried.max(1) as f64;
        let per_element = |number: u64| number as f64 / self.elements.max(1) as f64;
        let both = |number: fn(ReadCounts) -> u64| {
            per_element(number(listing)) + per_query(number(querying))
        };
        let moved_lines = match self.is_sampled() {
            true => per_query(querying.lines),
            false => per_element(probe.touched()),
        };
        let tables = probe.tables().map(|(table, row_bytes, reads)| TableReads {
            table: table.into(),
            row_bytes,
            reads: per_query(reads),
        });
        Reads {
            relation: self.relation,
            elements: self.elements as u64,
            queried: queried as u64,
            sampled: self.is_sampled(),
            answers: per_query(answers),
            reads: per_query(querying.reads),
            bytes: per_query(querying.bytes),
            lines: per_query(querying.lines),
            listing_reads: per_element(listing.reads),
            fetched: both(|sum| sum.fetched),
            jumps: both(|sum| sum.jumps),
            sweep_lines: probe.touched(),
            moved_bytes: moved_lines * LINE_BYTES as f64,
            tables: tables.collect(),
        }
    }
}

/// Counts the results with `fold`, as the timed sweep does. `next` may read other rows.
fn count_results(answers: impl IntoIterator) -> u64 {
    answers.into_iter().fold(0, |number, _| number + 1)
}

#[cfg(test)]
mod tests;
