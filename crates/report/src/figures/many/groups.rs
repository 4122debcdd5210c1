//! The answer by size and kind of mesh.

use sixfold_results::numbers::{counted, grouped, list};
use sixfold_results::{Overall, Pool, Purpose, Report, leaders, next_row, overall};

use super::{Mesh, names};
use crate::figure::{Table, TitledTable};
use crate::summary;

/// The largest number of groups that the sentence names.
const NAMED: usize = 4;

/// The largest number of structures that the name of a group lists.
const LISTED: usize = 3;

/// Meshes with something in common, with the mean times on them.
pub(super) struct Means {
    name: String,
    meshes: usize,
    overall: Vec<Overall>,
}

/// Returns the groups of the pool, and then those of the other meshes by the structures that can hold them.
pub(super) fn all(pool: &Pool, meshes: &[Mesh<'_>]) -> Vec<Means> {
    let pooled = pool.groups.iter().map(|group| Means {
        name: group.name.clone(),
        meshes: group.meshes.len(),
        overall: group.overall.clone(),
    });
    let mut others: Vec<(Vec<&str>, Vec<&Report>)> = Vec::new();
    for mesh in meshes.iter().filter(|mesh| !mesh.pooled) {
        let holding = mesh.study.backends.iter().filter(|backend| backend.holds);
        let holding: Vec<&str> = holding.map(|backend| backend.name.as_str()).collect();
        match others.iter_mut().find(|(known, _)| *known == holding) {
            Some((_, studies)) => studies.push(mesh.study),
            None => others.push((holding, vec![mesh.study])),
        }
    }
    let others = others.into_iter().map(|(holding, studies)| {
        let refusing = pool.compared.iter().map(String::as_str);
        let refusing: Vec<&str> = refusing.filter(|name| !holding.contains(name)).collect();
        Means {
            name: match refusing.len() <= LISTED {
                true => format!("not held by {}", list(refusing)),
                false => format!("held only by {}", list(holding.iter().copied())),
            },
            meshes: studies.len(),
            overall: overall(&studies, &holding),
        }
    });
    pooled.chain(others).collect()
}

/// Says for which sizes and kinds of meshes the answer is another one. `None` without groups.
pub(super) fn differences(pool: &Pool, groups: &[Means]) -> Option<String> {
    let (all, parts) = groups.split_first()?;
    let pooled = pool.groups.len() - 1;
    if parts.is_empty() {
        return None;
    }
    let mut differences = Vec::new();
    for (place, part) in parts.iter().enumerate() {
        let purposes = Purpose::ALL.into_iter();
        let others: Vec<String> = purposes
            .filter_map(|purpose| other_answer(all, part, purpose))
            .collect();
        if !others.is_empty() {
            let group = match place < pooled {
                true => part.name.clone(),
                false => format!("meshes {}", part.name),
            };
            let meshes = counted(part.meshes, "mesh", "meshes");
            differences.push(format!("on {group} ({meshes}) {}", list(others)));
        }
    }
    if differences.is_empty() {
        let answers = |means: &Means| -> Vec<String> {
            let purposes = Purpose::ALL.into_iter();
            let leaders = purposes.map(|purpose| leaders(purpose.rows(&means.overall)));
            leaders.map(|leaders| names(&leaders)).collect()
        };
        let is_same = parts.iter().all(|part| answers(part) == answers(all));
        return Some(match is_same {
            true => "By size and kind: the same structures are the fastest for all sizes and kinds of meshes.".into(),
            false => {
                "By size and kind: the structure with the shortest mean time of each kind of work is the fastest, or shares \
                 the first place, for all sizes and kinds in the table “Fastest by size and kind of mesh”."
                    .into()
            }
        });
    }
    let more = differences.split_off(differences.len().min(NAMED)).len();
    differences.extend((more > 0).then(|| format!("{} more in the table", grouped(more))));
    Some(format!(
        "By size and kind: the answer differs {}.",
        differences.join("; ")
    ))
}

/// Returns the answer on the meshes `part`, such as `for queries (face-vertex)`, if it is without the structure with the
/// shortest mean time on `all`. `None` if no mesh has a single fastest structure.
fn other_answer(all: &Means, part: &Means, purpose: Purpose) -> Option<String> {
    let [usual, best] = [all, part].map(|means| leaders(purpose.rows(&means.overall)));
    let first = usual.first()?;
    let decided = best.iter().any(|row| row.best > 0);
    let differs = decided && best.iter().all(|row| row.backend != first.backend);
    differs.then(|| format!("{} ({})", purpose.of_choice(), names(&best)))
}

/// Returns the table of the fastest structures of each group, with the number of meshes on which they are
/// the fastest.
pub(super) fn winners(groups: &[Means]) -> Option<TitledTable> {
    let all = groups.first()?;
    let purposes = Purpose::ALL
        .into_iter()
        .filter(|p| !p.rows(&all.overall).is_empty());
    let purposes: Vec<Purpose> = purposes.collect();
    let columns = purposes.iter().map(|purpose| purpose.of_choice());
    let mut table = Table::new(["meshes", "number"].into_iter().chain(columns));
    for group in groups {
        let cells = purposes
            .iter()
            .map(|p| winner(p.rows(&group.overall), group.meshes));
        let number = grouped(group.meshes);
        table.row(
            [group.name.clone(), number]
                .into_iter()
                .chain(cells)
                .collect(),
        );
    }
    Some(TitledTable {
        title: "Fastest by size and kind of mesh".into(),
        caption: "The structures with the shortest mean time; in brackets, on how many meshes each alone is the fastest, of those with \
                  enough samples; then the time of the next one. A mean in which fewer meshes take part says so. Sizes and kinds are parts of the meshes that all compared structures can hold. In the first row, \
                  each power of ten of the number of faces has equal weight."
            .into(),
        table,
    })
}

/// Describes the fastest of one group: `half-edge (7 of 9, shared on 1); next 1.39 ×`.
fn winner(rows: &[Overall], meshes: usize) -> String {
    let best = leaders(rows);
    let Some(first) = best.first() else {
        return "–".into();
    };
    let each: Vec<String> = best.iter().map(|row| summary::wins(row)).collect();
    let next = next_row(rows).map(|next| format!("; next {}", next.times(first)));
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
pub(super) fn means(pool: &Pool, groups: &[Means]) -> Option<TitledTable> {
    if groups.len() < 2 {
        return None;
    }
    let header = ["", "meshes", "work"].into_iter();
    let mut table = Table::new(header.chain(pool.compared.iter().map(String::as_str)));
    for group in groups {
        for purpose in Purpose::ALL {
            let rows = purpose.rows(&group.overall);
            let Some(first) = rows.first() else {
                continue;
            };
            let mut line = vec![
                group.name.clone(),
                grouped(first.meshes),
                purpose.title().to_lowercase(),
            ];
            line.extend(pool.compared.iter().map(|backend| {
                let row = rows.iter().find(|row| row.backend == *backend);
                row.map_or_else(|| "–".into(), |row| row.times(first))
            }));
            table.row(line);
        }
    }
    Some(TitledTable {
        title: "Means by size and kind of mesh".into(),
        caption: "The mean time of each structure, divided by that of the fastest on average, for meshes of one size or one kind. ≥ \
                  marks lower bounds, which are not ranked. In the first group, each power of ten of the number of faces has equal \
                  weight."
            .into(),
        table,
    })
}
