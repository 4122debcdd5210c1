//! The line under a figure: how many samples, when, with which seed, on which machine.

use std::collections::BTreeSet;

use sixfold_results::numbers::{counted, grouped};
use sixfold_results::{Finding, Status};

use crate::data::date;

/// Describes the measurements of `findings`, which a figure shows.
pub(crate) fn line(findings: &[&Finding]) -> String {
    let parts = [
        samples(findings),
        one_or_count(findings, "durations", |finding| {
            let settings = &finding.run().settings;
            Some(match settings.rounds {
                Some(_) => settings.effort_text(),
                // A part of the --budget, if the command measures more.
                None if findings.len() > 1 => format!("at most {} each", settings.effort_text()),
                None => format!("at most {}", settings.effort_text()),
            })
        }),
        dates(findings),
        one_or_count(findings, "seeds", |finding| {
            Some(format!("seed {}", finding.run().settings.seed))
        }),
        one_or_count(findings, "machines", |finding| {
            finding.run().environment.cpu_model.clone()
        }),
        one_or_count(findings, "profiles", |finding| {
            Some(format!("{} build", finding.run().environment.profile))
        }),
        one_or_count(findings, "versions of Sixfold", |finding| {
            let environment = &finding.run().environment;
            Some(match &environment.commit {
                Some(commit) => format!("Sixfold {} ({commit})", environment.sixfold),
                None => format!("Sixfold {}", environment.sixfold),
            })
        }),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    parts.join(" · ")
}

/// Returns the numbers of samples, and how many times are not measured.
fn samples(findings: &[&Finding]) -> Option<String> {
    let figures: Vec<_> = findings
        .iter()
        .flat_map(|finding| finding.figures())
        .collect();
    let measured = figures
        .iter()
        .filter(|f| matches!(f.status, Status::Measured | Status::Sampled));
    // A document may be without the samples of the single operations of a mix.
    let counts = measured.map(|figure| figure.row.samples);
    let counts: BTreeSet<usize> = counts.filter(|&count| count > 0).collect();
    let range = match (counts.first(), counts.last()) {
        (Some(least), Some(most)) if least == most => Some(format!(
            "{} for each time",
            counted(*most, "sample", "samples")
        )),
        (Some(least), Some(most)) => Some(format!(
            "{} to {} samples for each time",
            grouped(*least),
            grouped(*most)
        )),
        _ => None,
    };
    let of = |status| {
        figures
            .iter()
            .filter(|figure| figure.status == status)
            .count()
    };
    let (bounds, parts) = (of(Status::Estimated), of(Status::Sampled));
    let times = bounds + parts + of(Status::Measured);
    let times = grouped(times);
    let bounds =
        (bounds > 0).then(|| format!("{} of {times} times are lower bounds", grouped(bounds)));
    let parts =
        (parts > 0).then(|| format!("{} of {times} from some of the elements", grouped(parts)));
    let all: Vec<String> = [range, bounds, parts].into_iter().flatten().collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// Returns the first and the last day of the measurements, as `2026-11-27`.
fn dates(findings: &[&Finding]) -> Option<String> {
    let times = findings.iter().map(|finding| finding.run().start.unix_time);
    let days: BTreeSet<String> = times
        // 0 stands for an unknown time.
        .filter(|time| *time > 0)
        .map(date)
        .collect();
    let (first, last) = (days.first()?, days.last()?);
    Some(match first == last {
        true => first.clone(),
        false => format!("{first} to {last}"),
    })
}

/// Returns the text that all findings have, or the number of different texts, called `many`.
fn one_or_count(
    findings: &[&Finding],
    many: &str,
    text: impl Fn(&Finding) -> Option<String>,
) -> Option<String> {
    let texts: BTreeSet<String> = findings
        .iter()
        .filter_map(|finding| text(finding))
        .collect();
    match texts.len() {
        0 => None,
        1 => texts.into_iter().next(),
        count => Some(format!("{count} {many}")),
    }
}
