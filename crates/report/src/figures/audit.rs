//! The tables of `sixfold memory`: the bytes of each structure, and the bytes that operations
//! allocate.

use sixfold_results::numbers::grouped;
use sixfold_results::{Audit, BackendAudit, OperationBytes};

use crate::figure::{Table, TitledTable};

pub(super) fn tables(audit: &Audit) -> Vec<TitledTable> {
    let holding = audit.backends.iter().filter(|entry| entry.backend.holds);
    let holding: Vec<&BackendAudit> = holding.collect();
    let agree = holding.iter().all(|entry| entry.agrees == Some(true));
    let counts = match agree {
        true => "The formula, the tables and the allocator give the same bytes.",
        false => {
            "The formula computes the bytes from the numbers of elements. Tables: the bytes of all \
             tables, including spare capacity. Counted: the bytes that the allocator handed out."
        }
    };
    let mut tables = vec![TitledTable {
        title: "Bytes of each structure".into(),
        caption: format!(
            "{counts} Peak: the largest number of bytes in use while the structure is built, without \
             the input."
        ),
        table: bytes(&holding, agree),
    }];
    if holding.iter().any(|entry| !entry.operations.is_empty()) {
        tables.push(TitledTable {
            title: "Allocated bytes per byte of the result".into(),
            caption: "All bytes that one run of the operation requests from the allocator, \
                      divided by the bytes of its result. scans: not run, because the structure \
                      scans all faces for each element. –: the structure cannot do the operation."
                .into(),
            table: allocations(&holding),
        });
    }
    tables
}

/// Returns the table of bytes, with one column for the three counts if they `agree`.
fn bytes(holding: &[&BackendAudit], agree: bool) -> Table {
    let counts: &[&str] = match agree {
        true => &["bytes"],
        false => &["formula", "tables", "counted"],
    };
    let others = [
        "per vertex",
        "peak",
        match agree {
            true => "peak / bytes",
            false => "peak / counted",
        },
    ];
    let mut table = Table::new([""].iter().chain(counts).chain(&others).copied());
    let cell = |bytes: Option<usize>| bytes.map_or_else(|| "–".into(), grouped);
    for entry in holding {
        let ratio = entry.peak_to_counted.map(|ratio| format!("{ratio:.2}"));
        let each = entry.counted_bytes_per_vertex;
        let each = each.map(|each| format!("{each:.1}"));
        let mut line = vec![entry.backend.name.clone()];
        if !agree {
            line.extend([entry.backend.layout_bytes, entry.backend.bytes].map(cell));
        }
        line.extend([
            cell(entry.counted_bytes),
            each.unwrap_or_else(|| "–".into()),
            cell(entry.peak_bytes),
            ratio.unwrap_or_else(|| "–".into()),
        ]);
        table.row(line);
    }
    table
}

fn allocations(holding: &[&BackendAudit]) -> Table {
    let names = holding.iter().map(|entry| entry.backend.name.as_str());
    let mut table = Table::new([""].into_iter().chain(names));
    let cell = |counted: Option<&OperationBytes>| match counted {
        Some(counted) if counted.scans => "scans".to_owned(),
        Some(OperationBytes {
            allocated_to_result: Some(ratio),
            ..
        }) => format!("{ratio:.2}"),
        _ => "–".to_owned(),
    };
    let operations = holding.iter().flat_map(|entry| &entry.operations);
    let mut seen = Vec::new();
    for OperationBytes { operation, .. } in operations {
        if seen.contains(&operation) {
            continue;
        }
        seen.push(operation);
        let of = |entry: &&BackendAudit| {
            let mut counts = entry.operations.iter();
            cell(counts.find(|counted| counted.operation == *operation))
        };
        let mut line = vec![operation.clone()];
        line.extend(holding.iter().map(of));
        if line[1..].iter().any(|cell| cell != "–") {
            table.row(line);
        }
    }
    table
}
