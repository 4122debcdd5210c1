//! The table of the reads of queries, without times.

use sixfold_results::Why;
use sixfold_results::numbers::figure;

use crate::figure::{Table, TitledTable};

pub(super) fn table(why: &Why) -> TitledTable {
    let mut table = Table::new([
        "",
        "structure",
        "results",
        "reads",
        "bytes",
        "lines",
        "fetched",
        "jumps",
        "moved bytes",
    ]);
    for row in &why.rows {
        let reads = &row.reads;
        let sampled = if reads.sampled { "~" } else { "" };
        let means = [
            reads.answers,
            reads.reads,
            reads.bytes,
            reads.lines,
            reads.fetched,
            reads.jumps,
            reads.moved_bytes,
        ];
        let mut line = vec![reads.relation.to_string(), row.backend.clone()];
        line.extend(means.map(|mean| format!("{sampled}{}", figure(mean))));
        table.row(line);
    }
    TitledTable {
        title: "Reads of each query".into(),
        caption: "Means per queried element: results, table rows read, bytes read, cache lines \
                  touched, cache lines fetched by a small simulated cache, jumps to distant cache \
                  lines, and bytes of the lines that the whole pass touches. ~: only a sample of the elements \
                  was queried."
            .into(),
        table,
    }
}
