//! Sentences on the memory of the backends.

use sixfold_results::numbers::{figure, grouped, list};
use sixfold_results::{Audit, BackendAudit};

/// Describes the memory of the backends that hold the mesh: the least memory, the peaks, and
/// whether the three counts agree.
pub(super) fn sentences(audit: &Audit) -> Vec<String> {
    let holding = audit.backends.iter().filter(|entry| entry.backend.holds);
    let holding: Vec<&BackendAudit> = holding.collect();
    if holding.is_empty() {
        return Vec::new();
    }
    let mut sentences = audit.faults();
    sentences.iter_mut().for_each(|fault| fault.push('.'));
    let agree = sentences.is_empty();
    sentences.extend(least(&holding));
    sentences.extend(peaks(&holding));
    if agree {
        sentences.push(
            "All three counts (formula, tables, allocator) agree to the byte: no table has spare \
             capacity, and no memory is outside the tables."
                .to_owned(),
        );
    }
    sentences
}

/// Names the backends with the fewest bytes, and compares the others with them.
fn least(holding: &[&BackendAudit]) -> Option<String> {
    let bytes = |entry: &&BackendAudit| entry.counted_bytes;
    let smallest = holding.iter().filter_map(bytes).min()?;
    let is_smallest = |entry: &&BackendAudit| entry.counted_bytes == Some(smallest);
    let (first, others): (Vec<&BackendAudit>, Vec<&BackendAudit>) =
        holding.iter().copied().partition(is_smallest);
    let per_vertex = first.first()?.counted_bytes_per_vertex;
    let per_vertex = per_vertex.map_or(String::new(), |n| format!(", {} per vertex", figure(n)));
    let names = list(first.iter().map(|entry| entry.backend.name.as_str()));
    let verb = if first.len() == 1 { "needs" } else { "need" };
    let smallest_text = grouped(smallest);
    if others.is_empty() {
        return Some(format!("{names} {verb} {smallest_text} bytes{per_vertex}."));
    }
    let mut others: Vec<_> = others.iter().filter_map(|e| Some((bytes(e)?, e))).collect();
    others.sort_by_key(|(bytes, _)| *bytes);
    let ratio = |bytes: usize| figure(bytes as f64 / smallest.max(1) as f64);
    let others = others
        .iter()
        .map(|(bytes, entry)| format!("{} {}", entry.backend.name, ratio(*bytes)));
    Some(format!(
        "{names} {verb} the least memory: {smallest_text} bytes{per_vertex}. Relative to this: {}.",
        list(others)
    ))
}

/// Names the backends with the smallest and the largest peak relative to their own bytes.
fn peaks(holding: &[&BackendAudit]) -> Option<String> {
    let ratio = |entry: &BackendAudit| entry.peak_to_counted;
    let ratios = || holding.iter().filter_map(|entry| ratio(entry));
    let lowest = figure(ratios().reduce(f64::min)?);
    let highest = figure(ratios().reduce(f64::max)?);
    let with = |text: &str| {
        let is_it = |entry: &&&BackendAudit| ratio(entry).is_some_and(|r| figure(r) == text);
        list(
            holding
                .iter()
                .filter(is_it)
                .map(|entry| entry.backend.name.as_str()),
        )
    };
    Some(match lowest == highest {
        true => format!("While a structure is built, it needs {highest} times its bytes."),
        false => format!(
            "While a structure is built, it needs up to {highest} times its bytes ({}); {} the \
             least, {lowest} times.",
            with(&highest),
            with(&lowest)
        ),
    })
}
