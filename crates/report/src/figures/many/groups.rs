//! The answer by size and kind of mesh.

use sixfold_study::numbers::{counted, grouped, list};
use sixfold_study::{Group, Overall, Pool, Purpose, leaders};

use super::{names, ratio_text};
use crate::figure::{Table, TitledTable};

/// The largest number of groups that the sentence names.
const NAMED: usize = 4;

/// Returns the rows of one purpose, the fastest first.
fn rows(group: &Group, purpose: Purpose) -> Vec<Overall> {
    let rows = group.overall.iter().filter(|row| row.purpose == purpose);
    rows.cloned().collect()
}

/// Says for which sizes and kinds of meshes the answer is another one. `None` without groups.
pub(super) fn differences(pool: &Pool) -> Option<String> {
    let (all, parts) = pool.groups.split_first()?;
    if parts.is_empty() {
        return None;
    }
    let mut differences = Vec::new();
    for purpose in Purpose::ALL {
        let over_all = rows(all, purpose);
        let usual: Vec<&str> = leaders(&over_all)
            .iter()
            .map(|row| row.backend.as_str())
            .collect();
        for part in parts {
            let own = rows(part, purpose);
            let best = leaders(&own);
            // A different answer has no structure in common with the usual one.
            let differs = best
                .iter()
                .all(|row| !usual.contains(&row.backend.as_str()));
            if !best.is_empty() && !usual.is_empty() && differs {
                let meshes = counted(own[0].meshes, "mesh", "meshes");
                differences.push(format!(
                    "{} on {} ({}, {meshes})",
                    purpose.of_choice(),
                    part.name,
                    names(best)
                ));
            }
        }
    }
    if differences.is_empty() {
        return Some(
            "By size and kind: the same structures are the fastest for all sizes and kinds of meshes.".into(),
        );
    }
    let more = differences.split_off(differences.len().min(NAMED)).len();
    differences.extend((more > 0).then(|| format!("{} more in the table", grouped(more))));
    Some(format!(
        "By size and kind: the answer is another {}.",
        list(differences)
    ))
}

/// Returns the table of the fastest structures of each group, with the number of meshes on which they are
/// the fastest.
pub(super) fn winners(pool: &Pool) -> Option<TitledTable> {
    let all = pool.groups.first()?;
    let purposes = Purpose::ALL
        .into_iter()
        .filter(|&p| !rows(all, p).is_empty());
    let purposes: Vec<Purpose> = purposes.collect();
    let columns = purposes.iter().map(|purpose| purpose.of_choice());
    let mut table = Table::new(["meshes", "number"].into_iter().chain(columns));
    for group in &pool.groups {
        let cells = purposes
            .iter()
            .map(|&p| winner(&rows(group, p), group.meshes.len()));
        let number = grouped(group.meshes.len());
        table.row(
            [group.name.clone(), number]
                .into_iter()
                .chain(cells)
                .collect(),
        );
    }
    Some(TitledTable {
        title: "Fastest by size and kind of mesh".into(),
        caption: "The structures with the shortest mean time, the number of meshes on which each alone is the fastest or is tied \
                  with it, and the time of the next one. A mean in which fewer meshes take part says so. In the first row, each \
                  power of ten of the number of faces has equal weight."
            .into(),
        table,
    })
}

/// Describes the fastest of one group: `half-edge (7 of 9, tied on 1); next 1.39 ×`.
fn winner(rows: &[Overall], meshes: usize) -> String {
    let best = leaders(rows);
    let Some(first) = best.first() else {
        return "–".into();
    };
    let each = best.iter().map(|row| {
        let tied = match row.tied {
            0 => String::new(),
            tied => format!(", tied on {}", grouped(tied)),
        };
        format!(
            "{} ({} of {}{tied})",
            row.backend,
            grouped(row.best),
            grouped(row.meshes)
        )
    });
    let each: Vec<String> = each.collect();
    let next = rows
        .get(best.len())
        .map(|next| format!("; next {}", next.times(first)));
    let fewer = (first.meshes < meshes)
        .then(|| format!("; only {}", counted(first.meshes, "mesh", "meshes")));
    [
        each.join(" or "),
        next.unwrap_or_default(),
        fewer.unwrap_or_default(),
    ]
    .concat()
}

/// Returns the means of each group, or `None` if there are no groups besides the pooled meshes together.
pub(super) fn means(pool: &Pool) -> Option<TitledTable> {
    if pool.groups.len() < 2 {
        return None;
    }
    let header = ["", "meshes", "work"].into_iter();
    let mut table = Table::new(header.chain(pool.compared.iter().map(String::as_str)));
    for group in &pool.groups {
        for purpose in Purpose::ALL {
            let rows = rows(group, purpose);
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
                row.map_or_else(|| "–".into(), ratio_text)
            }));
            table.row(line);
        }
    }
    Some(TitledTable {
        title: "Means by size and kind of mesh".into(),
        caption: "The mean time divided by the time of the fastest measured backend of each mesh and operation, for meshes of one \
                  size or one kind. ≥ marks lower bounds, which are not ranked. In the first group, each power of ten of the \
                  number of faces has equal weight."
            .into(),
        table,
    })
}
