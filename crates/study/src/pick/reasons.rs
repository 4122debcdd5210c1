//! The answer and its reasons, as sentences.

use crate::numbers::{duration, grouped, times};
use crate::pick::answer::{Answer, PartCost, Ranked};

/// Returns the answer, its reasons, the break-even and the packages to add, in this order.
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

/// Returns warnings: noise, few rounds, a busy machine, backends with other results.
pub(crate) fn warnings(answer: &Answer) -> Vec<String> {
    let mut warnings = crate::warnings::of_machine(&answer.environment);
    if let Some(noise) = answer.noise.filter(|&noise| noise > 1.05) {
        warnings.push(format!(
            "Two measurements of one backend differ by {:.0} %: smaller differences between backends are not significant. Measure on a quieter machine, or with a longer --budget.",
            100.0 * (noise - 1.0)
        ));
    }
    let fewest = answer.ranking.iter().map(|ranked| ranked.samples).min();
    if let Some(fewest) = fewest.filter(|&fewest| fewest < 6) {
        warnings.push(format!(
            "Some figures are from {fewest} rounds, too few for a 95 % interval: use a longer --budget."
        ));
    }
    for backend in &answer.mismatches {
        warnings.push(format!(
            "{backend} has other results than the other backends: a fault in Sixfold; please report it."
        ));
    }
    warnings
}

/// Returns the name of a backend in a sentence.
fn name(ranked: &Ranked) -> String {
    match &ranked.over {
        Some(over) => format!("{} (made from {over})", ranked.backend),
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
            "; {} takes {} that time{sure}",
            name(next),
            times(next.ratio_to_best)
        )
    });
    match &tied[..] {
        [] => format!(
            "For {workload}, {} is fastest: {each} per operation{next}.",
            name(best)
        ),
        tied => format!(
            "For {workload}, {} and {} are tied: {each} per operation{next}.",
            tied.join(", "),
            name(best)
        ),
    }
}

/// Formats a ratio with three digits, to be compared with a close one: `1.04`, `12.3`, `123`.
fn precise(ratio: f64) -> String {
    match ratio {
        r if r < 10.0 => format!("{r:.2}"),
        r if r < 100.0 => format!("{r:.1}"),
        r => grouped(r.round() as usize),
    }
}

/// Describes which part of the mix takes most of the time.
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
        "{} takes {:.0} % of the time of the fastest backend ({each} each).",
        heaviest.operation,
        100.0 * heaviest.weighed() / total
    ))
}

/// Describes the part of the mix in which the first slower backend loses most time.
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
        "{} is slower mainly in {}: {}, compared with {}.",
        name(next),
        theirs.operation,
        duration(theirs.ns?),
        duration(ours.ns?)
    ))
}

/// Describes the time of relation tables; if they are the best, that of the fastest structure.
fn tables(answer: &Answer, best: &Ranked) -> Option<String> {
    let structure = answer.ranking.iter().find(|ranked| ranked.over.is_none())?;
    if best.over.is_some() {
        return Some(format!(
            "Without relation tables, {} is fastest: {} per operation.",
            structure.backend,
            duration(structure.ns_per_operation)
        ));
    }
    let tables = answer.ranking.iter().find(|ranked| ranked.over.is_some())?;
    Some(format!(
        "Tables of only the queried relations, made once from {}, take {} the time of the fastest.",
        tables.over.as_deref().unwrap_or_default(),
        times(tables.ratio_to_best)
    ))
}

/// Describes the fastest backend for one use of the mesh, building included.
fn over_one_use(answer: &Answer, best: &Ranked) -> Option<String> {
    let operations = answer.operations;
    let total = |ranked: &Ranked| {
        // A program has an indexed face set before it builds anything.
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
            "With building included, {} is still fastest for one use of {count} {used}: {cost} in total.",
            name(best)
        ),
        false => format!(
            "With building included, except for an indexed face set, one use of {count} {used} is fastest on {}: {cost} in total, compared with {} on {}.",
            name(least),
            duration(total(best)),
            name(best)
        ),
    })
}

/// Describes the command that adds the packages, and the types to use. Packages of Sixfold are
/// taken from a checkout.
fn to_add(best: &Ranked) -> String {
    let command = |package: &String| match package.strip_prefix("sixfold-") {
        Some(folder) => format!("`cargo add {package} --path CHECKOUT/crates/{folder}`"),
        None => format!("`cargo add {package}`"),
    };
    let commands: Vec<String> = best.crates.iter().map(command).collect();
    let types: Vec<String> = best.types.iter().map(|path| format!("`{path}`")).collect();
    format!(
        "To use {} in your package, run {}. CHECKOUT is the path of this repository.",
        types.join(" and "),
        commands.join(" and ")
    )
}
