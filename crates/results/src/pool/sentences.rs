//! The fastest backends of each kind of work, and the sentences of a pool.

use std::cmp::Reverse;

use super::{Holding, Overall, Pool};
use crate::findings::pick::EQUAL_UP_TO;
use crate::findings::study::Report;
use crate::numbers::{counted, list};

impl Pool {
    pub(super) fn describe(&self, studies: &[&Report]) -> Vec<String> {
        let Some((all, parts)) = self.groups.split_first() else {
            return Vec::new();
        };
        let mut sentences = vec![self.describe_meshes(all.meshes.len(), studies)];
        for rows in all.overall.chunk_by(|a, b| a.purpose == b.purpose) {
            sentences.extend(leader(rows, &all.name, self.compared.len()));
            for part in parts {
                let own = rows[0].purpose.rows(&part.overall);
                // Only where the answer is another one.
                let differs = own.first().zip(rows.first());
                if differs.is_some_and(|(own, all)| own.backend != all.backend) {
                    sentences.extend(leader(own, &part.name, self.compared.len()));
                }
            }
        }
        sentences
    }

    fn describe_meshes(&self, pooled: usize, studies: &[&Report]) -> String {
        let studied = studies.len();
        let holds_all = |holding: &&Holding| holding.meshes == studied;
        let (all, fewer): (Vec<&Holding>, Vec<&Holding>) = self.holding.iter().partition(holds_all);
        if fewer.is_empty() {
            return format!(
                "All backends can hold all {}.",
                counted(studied, "mesh", "meshes")
            );
        }
        let counts = fewer
            .iter()
            .map(|holding| format!("{} can hold {}", holding.backend, holding.meshes));
        let counts: Vec<String> = counts.collect();
        let others = match all.is_empty() {
            true => "",
            false => "; the other backends can hold all meshes",
        };
        let is_structure = |holding: &&Holding| {
            let mut backends = studies
                .iter()
                .filter_map(|study| study.backend(&holding.backend));
            backends.any(|backend| backend.external.is_none())
        };
        let repair = match fewer.iter().any(is_structure) {
            true => " `sixfold repair --for NAME` makes a mesh that the structure NAME can hold.",
            false => "",
        };
        format!(
            "The means are over the {} that all compared backends can hold. Of {studied} studied, \
             {}{others}.{repair}",
            counted(pooled, "mesh", "meshes"),
            counts.join(", ")
        )
    }
}

/// Returns the fastest backends of one purpose: those that are not slower by a clear difference than the fastest on one
/// mesh, or, on average over several meshes, than any other. A difference is clear if it is more than 5 %, and the
/// interval of the quotient is above 1. Without an interval, it is more than 5 % on each of several meshes, or more than
/// the error of the means of one mesh. A lower bound is never one of them. Empty if `rows` has only lower bounds.
pub fn leaders(rows: &[Overall]) -> Vec<&Overall> {
    rows.iter().filter(|row| row.leads).collect()
}

/// Returns the next backend after the [`leaders`]: the fastest measured one, or else one that has only a lower bound.
pub fn next_row(rows: &[Overall]) -> Option<&Overall> {
    rows.iter().find(|row| !row.leads)
}

/// Returns the next backends after the [`leaders`], with their time relative to the first: the
/// fastest measured one, or else those that have only lower bounds. `None` if there are no others.
pub fn next_best(rows: &[Overall]) -> Option<(String, String)> {
    let next = next_row(rows)?;
    // Lower bounds do not show which of the backends is the next.
    let bounds = rows.iter().filter(|row| row.bound).count();
    let name = match next.bound && bounds > 1 {
        true => "the others".to_owned(),
        false => next.backend.clone(),
    };
    let verb = if name == "the others" {
        "take"
    } else {
        "takes"
    };
    Some((format!("{name} {verb}"), next.times(&rows[0])))
}

/// Names the backends whose lower bound does not show that they are slower than the [`leaders`], as
/// an addition to a sentence.
pub fn not_ranked(rows: &[Overall]) -> Option<String> {
    let leaders = leaders(rows);
    let last = leaders.last()?;
    let open = rows
        .iter()
        .filter(|row| row.bound && row.ratio_to_best <= last.ratio_to_best);
    let open: Vec<String> = open
        .map(|row| format!("{} ({})", row.backend, row.times(&rows[0])))
        .collect();
    (!open.is_empty()).then(|| {
        format!(
            "not ranked, because a run would exceed the budget: {}",
            list(open)
        )
    })
}

/// Describes the fastest backends of one purpose. `compared` is the number of all compared backends.
fn leader(rows: &[Overall], group: &str, compared: usize) -> Option<String> {
    let best = leaders(rows);
    let first = *best.first()?;
    let next = match next_best(rows) {
        Some((next, ratio)) => format!("; {next} {ratio} the time"),
        // The means differ, but perhaps not on other meshes.
        None if best.iter().any(|row| row.range.is_some()) => String::new(),
        None => return None,
    };
    let is_equal = |row: &Overall| row.ratio_to_best <= first.ratio_to_best * EQUAL_UP_TO;
    let names = list(best.iter().map(|row| row.backend.clone()));
    let lead = match &best[..] {
        [_] => format!("{names} is fastest on average"),
        _ if best.iter().all(|row| is_equal(row)) => {
            format!("{names} are fastest on average, within 5 % of the first")
        }
        _ => format!("it is undecided which is fastest on average of {names}"),
    };
    let name = |row: &Overall| row.backend.clone();
    let only = match rows.len() < compared {
        true => format!(" Only {} have times.", list(rows.iter().map(name))),
        false => String::new(),
    };
    let open = not_ranked(rows).map_or(String::new(), |open| format!("; {open}"));
    Some(format!(
        "{}, {group}: {lead} (geometric mean over {}){next}{open}.{only}",
        first.purpose.title(),
        counted(first.meshes, "mesh", "meshes"),
    ))
}

/// The largest number of other meshes that a warning names.
const NAMED: usize = 3;

/// Returns the warnings of the studies, those of the most meshes first. Warnings of one kind are merged: that of the mesh
/// with the largest number or share is shown, with the names of the others.
pub(super) fn warnings(studies: &[&Report]) -> Vec<String> {
    let mut kinds: Vec<(String, Vec<(&str, &str)>)> = Vec::new();
    for study in studies {
        for warning in &study.warnings {
            // The sentences after the first one name operations and backends.
            let (first, _) = warning.split_once(". ").unwrap_or((warning, ""));
            let kind: String = first.chars().filter(|c| !c.is_ascii_digit()).collect();
            let own = (study.mesh.name.as_str(), warning.as_str());
            match kinds.iter_mut().find(|(known, _)| *known == kind) {
                Some((_, meshes)) => meshes.push(own),
                None => kinds.push((kind, vec![own])),
            }
        }
    }
    kinds.sort_by_key(|(_, meshes)| Reverse(meshes.len()));
    let text =
        |(_, meshes): (String, Vec<(&str, &str)>)| {
            let (mesh, warning) = meshes.iter().copied().reduce(|worst, own| {
                match extent(own.1) > extent(worst.1) {
                    true => own,
                    false => worst,
                }
            })?;
            let names = meshes.iter().map(|(name, _)| *name);
            let others: Vec<&str> = names.filter(|name| *name != mesh).collect();
            let named = others.iter().take(NAMED).map(ToString::to_string);
            let more = others.len().saturating_sub(NAMED);
            let more = (more > 0).then(|| counted(more, "other mesh", "other meshes"));
            let similar = list(named.chain(more));
            Some(match others.len() {
                0 => format!("{mesh}: {warning}"),
                _ => format!("{mesh}: {warning} Similar on {similar}."),
            })
        };
    kinds.into_iter().filter_map(text).collect()
}

/// Returns the first number of a warning, or the share if it is one, such as `130 of 147`.
fn extent(warning: &str) -> f64 {
    let words = warning
        .split(' ')
        .map(|word| word.trim_end_matches(['.', ',']));
    let mut numbers = words.filter_map(|word| word.parse::<f64>().ok());
    let (first, second) = (numbers.next(), numbers.next());
    let first = first.unwrap_or(0.0);
    match second.filter(|whole| warning.contains(&format!("{first} of {whole} "))) {
        Some(whole) => first / whole,
        None => first,
    }
}
