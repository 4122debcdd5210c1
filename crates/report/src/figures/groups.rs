//! The table of groups of meshes: the mean ratio to the fastest backend for each kind of work.

use sixfold_study::numbers::times;
use sixfold_study::{Pool, Purpose};

use super::marked;
use crate::figure::{Table, TitledTable};

/// Returns one table, or none if there are no groups besides the pooled meshes together.
pub(super) fn tables(pool: &Pool) -> Vec<TitledTable> {
    if pool.groups.len() < 2 {
        return Vec::new();
    }
    let header = ["", "meshes", "work"].into_iter();
    let mut table = Table::new(header.chain(pool.compared.iter().map(String::as_str)));
    for group in &pool.groups {
        for purpose in Purpose::ALL {
            let rows = group.overall.iter().filter(|row| row.purpose == purpose);
            let rows: Vec<_> = rows.collect();
            if rows.is_empty() {
                continue;
            }
            let meshes = rows.iter().map(|row| row.meshes).max().unwrap_or(0);
            let mut line = vec![
                group.name.clone(),
                meshes.to_string(),
                purpose.name().to_lowercase(),
            ];
            line.extend(pool.compared.iter().map(|backend| {
                let row = rows.iter().find(|row| row.backend == *backend);
                row.map_or_else(
                    || "–".into(),
                    |row| marked(times(row.ratio_to_best), row.bound),
                )
            }));
            table.row(line);
        }
    }
    vec![TitledTable {
        title: "Groups of meshes".into(),
        caption: "The mean time divided by the time of the fastest measured backend of each mesh and \
                  operation, for meshes of one size or one kind. ≥ marks lower bounds, which are not \
                  ranked. The first group has all pooled \
                  meshes, and each power of ten of the number of faces has equal weight."
            .into(),
        table,
    }]
}
