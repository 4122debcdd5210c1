//! Counts the table reads that relations need. The counts are exact and equal in every run.

use std::sync::atomic::{AtomicBool, Ordering};

use sixfold::{MeshQuery, QueryCost, Relation};
use sixfold_core::Measured;

use crate::read_probe::{CountingProbe, ReadCounts, Step};
use sixfold_measure::LINE_BYTES;
use sixfold_results::{Reads, TableReads};

/// Number of elements in a sample. The elements of a sample are evenly spaced.
pub const SCAN_SAMPLE: usize = 16;
/// Maximum number of table rows that a query may read, as a mean over all elements. If the queries
/// of a relation read more rows, only [`SCAN_SAMPLE`] elements are queried.
pub const MAX_READS: u64 = 256;

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
            counter.count(&probed, relation, elements, elements)
        };
        let found = whole.or_else(|| counter.count(&probed, relation, elements, SCAN_SAMPLE));
        if stop.load(Ordering::Relaxed) {
            return;
        }
        if let Some(reads) = found {
            observer.relation_counted(reads);
        }
    }
}

struct ReadCounter<'a> {
    probe: &'a CountingProbe,
    stop: &'a AtomicBool,
}

impl ReadCounter<'_> {
    /// Queries `queried` of the `elements`. Returns `None` if `stop` is true. Also returns `None`
    /// if all elements are queried and a query reads too many rows on average.
    fn count<M: MeshQuery>(
        &self,
        mesh: &M,
        relation: Relation,
        elements: usize,
        queried: usize,
    ) -> Option<Reads> {
        // Making the list may read rows.
        self.probe.clear();
        self.probe.begin(Step::Listing);
        let sweep = Sweep {
            relation,
            elements,
            queried: queried.min(elements),
        };
        macro_rules! count_relation {
            ($query:ident $list:ident $from:ident $to:ident) => {
                self.count_sweep(sweep, &mut mesh.$list(), &mut |element| {
                    count_results(mesh.$query(element))
                })
            };
        }
        sixfold_core::match_relation!(relation, count_relation!)
    }

    /// Lists the elements one by one, as the timed sweep does, and queries the selected elements. Called
    /// by address, so that this is compiled once for each type of handles.
    fn count_sweep<E>(
        &self,
        sweep: Sweep,
        elements: &mut dyn Iterator<Item = E>,
        query: &mut dyn FnMut(E) -> u64,
    ) -> Option<Reads> {
        let probe = self.probe;
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
