//! The answer and its reasons, in plain words.

use crate::numbers::{duration, grouped, times};
use crate::pick::answer::{Answer, PartCost, Ranked};

/// The answer first, then why, from when on, and what to depend on.
pub(crate) fn words(answer: &Answer) -> Vec<String> {
    let Some(best) = answer.ranking.first() else {
        return vec!["No backend qualifies.".into()];
    };
    let mut words = vec![verdict(answer, best)];
    words.extend(dominating(answer, best));
    words.extend(runner_up(answer, best));
    words.extend(tables(answer, best));
    words.extend(over_one_use(answer, best));
    words.push(to_add(best));
    words
}

/// Doubts: noise, few rounds, a busy machine, backends that found something else.
pub(crate) fn warnings(answer: &Answer) -> Vec<String> {
    let mut warnings = crate::warnings::of_machine(&answer.environment);
    if let Some(noise) = answer.noise.filter(|&noise| noise > 1.05) {
        warnings.push(format!(
            "One backend differs from itself by {:.0} %: smaller differences say nothing. Measure on a quieter machine, or with a longer --budget.",
            100.0 * (noise - 1.0)
        ));
    }
    let fewest = answer.ranking.iter().map(|ranked| ranked.samples).min();
    if let Some(fewest) = fewest.filter(|&fewest| fewest < 6) {
        warnings.push(format!(
            "Some figures rest on {fewest} rounds, too few for a 95 % interval: a longer --budget makes them surer."
        ));
    }
    for backend in &answer.mismatches {
        warnings.push(format!(
            "{backend} finds something else than the others: a fault in Sixfold; please report it."
        ));
    }
    warnings
}

/// What a backend is called in a sentence.
fn name(ranked: &Ranked) -> String {
    match &ranked.over {
        Some(over) => format!("{} (over {over})", ranked.backend),
        None => ranked.backend.clone(),
    }
}

fn verdict(answer: &Answer, best: &Ranked) -> String {
    let tied: Vec<String> = { answer.ranking[1..].iter() }
        .filter(|ranked| ranked.tied_with_best)
        .map(name)
        .collect();
    let each = duration(best.ns_per_operation);
    let workload = &answer.workload.name;
    let next = answer.ranking[1..]
        .iter()
        .find(|ranked| !ranked.tied_with_best);
    let next = next.map_or(String::new(), |next| {
        let sure = next
            .ci_low
            .zip(next.ci_high)
            .map_or(String::new(), |(low, high)| {
                format!(" (95 %: {} to {})", precise(low), precise(high))
            });
        format!(
            "; {} takes {} as long{sure}",
            name(next),
            times(next.ratio_to_best)
        )
    });
    match &tied[..] {
        [] => format!(
            "For {workload}, {} is fastest: {each} an operation{next}.",
            name(best)
        ),
        tied => format!(
            "For {workload}, {} and {} tie: {each} an operation{next}.",
            tied.join(", "),
            name(best)
        ),
    }
}

/// `1.04`, `12.3`, `123`: a ratio beside another that may be close.
fn precise(ratio: f64) -> String {
    match ratio {
        r if r < 10.0 => format!("{r:.2}"),
        r if r < 100.0 => format!("{r:.1}"),
        r => grouped(r.round() as usize),
    }
}

/// Which part of the mix takes most of the time.
fn dominating(answer: &Answer, best: &Ranked) -> Option<String> {
    let total: f64 = best.parts.iter().map(PartCost::weighed).sum();
    let heaviest = best
        .parts
        .iter()
        .max_by(|a, b| a.weighed().total_cmp(&b.weighed()))?;
    let each = duration(heaviest.ns?);
    if answer.workload.mix.len() == 1 {
        return None;
    }
    Some(format!(
        "There {} takes {:.0} % of the time ({each} each).",
        heaviest.operation,
        100.0 * heaviest.weighed() / total
    ))
}

/// Where the first that is slower loses what it loses.
fn runner_up(answer: &Answer, best: &Ranked) -> Option<String> {
    let next = answer
        .ranking
        .iter()
        .find(|ranked| !ranked.tied_with_best)?;
    let lost = |(a, b): (&PartCost, &PartCost)| a.weighed() - b.weighed();
    let pairs = || next.parts.iter().zip(&best.parts);
    let (theirs, ours) = pairs().max_by(|&a, &b| lost(a).total_cmp(&lost(b)))?;
    if lost((theirs, ours)) <= 0.0 || answer.workload.mix.len() == 1 {
        return None;
    }
    Some(format!(
        "{} loses most in {}: {} against {}.",
        name(next),
        theirs.operation,
        duration(theirs.ns?),
        duration(ours.ns?)
    ))
}

/// What tables would bring, where they are not the answer, or what the best structure is without them.
fn tables(answer: &Answer, best: &Ranked) -> Option<String> {
    let structure = answer.ranking.iter().find(|ranked| ranked.over.is_none())?;
    if best.over.is_some() {
        return Some(format!(
            "Of the structures themselves {} is fastest: {} an operation.",
            structure.backend,
            duration(structure.ns_per_operation)
        ));
    }
    let tables = answer.ranking.iter().find(|ranked| ranked.over.is_some())?;
    Some(format!(
        "Tables of just the relations that are asked, made once over {}, take {} as long.",
        tables.over.as_deref().unwrap_or_default(),
        times(tables.ratio_to_best)
    ))
}

/// Who is cheapest if building counts, over as many operations as one use has.
fn over_one_use(answer: &Answer, best: &Ranked) -> Option<String> {
    let operations = answer.operations;
    let total = |ranked: &Ranked| {
        // An indexed face set is what there is before anything is built.
        let build = match ranked.backend.as_str() {
            "indexed-face-set" => 0.0,
            _ => ranked.first_build_ns(),
        };
        build + operations * ranked.ns_per_operation
    };
    let least = { answer.ranking.iter() }.min_by(|a, b| total(a).total_cmp(&total(b)))?;
    let count = grouped(operations.round() as usize);
    let used = if operations.round() == 1.0 {
        "operation"
    } else {
        "operations"
    };
    let cost = duration(total(least));
    Some(match least.backend == best.backend {
        true => format!(
            "With its building counted it is still the least for one use of {count} {used}: {cost} in all."
        ),
        false => format!(
            "With building counted, and an indexed face set there already, one use of {count} {used} is cheapest on {}: {cost} in all, against {} on {}.",
            name(least),
            duration(total(best)),
            name(best)
        ),
    })
}

fn to_add(best: &Ranked) -> String {
    let crates: Vec<String> = best.crates.iter().map(|name| format!("`{name}`")).collect();
    format!("To use it, depend on {}.", crates.join(" and "))
}
