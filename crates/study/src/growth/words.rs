//! Sentences on the results of a sweep over sizes.

use super::{CacheEnd, Fit, SizeReport};
use crate::numbers::{grouped, times};
use crate::report::{Agreement, Standing};
use crate::slope::Slope;
use sixfold_workload::{Cache, last_level};

/// Returns sentences on exponents, times per element, the fastest backends and the caches.
pub(super) fn words(
    sizes: &[SizeReport],
    fits: &[Fit],
    caches: &[Cache],
    ends: &[CacheEnd],
) -> Vec<String> {
    let mut words = Vec::new();
    words.extend(exponents(fits, caches));
    words.extend(prices(sizes, fits));
    words.extend(fastest(sizes));
    words.extend(cache_words(caches, ends));
    words.extend(noise(sizes));
    words.extend(doubts(sizes, fits));
    for size in sizes {
        for row in &size.results {
            if row.agreement == Agreement::Mismatch {
                let (backend, operation) = (&row.backend, row.operation);
                words.push(format!(
                    "{backend} has other results than the other backends for {operation} at {} faces: a fault in Sixfold; please report it.",
                    grouped(size.faces)
                ));
            }
        }
    }
    words
}

/// Lists the sizes that were left out for lack of time.
pub(super) fn left_out(sizes: &[usize]) -> Option<String> {
    let names: Vec<String> = sizes.iter().map(|&faces| grouped(faces)).collect();
    (!names.is_empty()).then(|| {
        format!(
            "Sizes of about {} faces are left out for lack of time: use a longer --budget.",
            names.join(", ")
        )
    })
}

/// Describes the exponents, separately for backends that scan and those that do not.
fn exponents(fits: &[Fit], caches: &[Cache]) -> Vec<String> {
    let range = |scans: bool, slope: &dyn Fn(&Fit) -> Option<Slope>| {
        let slopes = fits.iter().filter(|fit| fit.scans == scans);
        // A line through two points has no error estimate.
        let sure = slopes.filter_map(|fit| slope(fit).filter(|s| s.standard_error.is_some()));
        let mut slopes: Vec<f64> = sure.map(|slope| slope.exponent).collect();
        slopes.sort_by(f64::total_cmp);
        let (least, most) = (slopes.first()?, slopes.last()?);
        Some(format!("{least:.2} to {most:.2}"))
    };
    let mut words = Vec::new();
    if let Some(all) = range(false, &|fit| fit.all) {
        let parts = [
            range(false, &|fit| fit.in_cache).map(|r| format!("{r} within the last cache")),
            range(false, &|fit| fit.beyond).map(|r| format!("{r} beyond it")),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        let split = match parts.is_empty() {
            true => String::new(),
            false => format!(" ({})", parts.join(", ")),
        };
        words.push(format!(
            "If a structure does not scan, the time of a whole pass grows with the number of faces to the power {all}{split}."
        ));
    }
    if let Some(all) = range(true, &|fit| fit.all) {
        words.push(format!(
            "If a structure scans all faces for each element, the time grows with the number of faces to the power {all}."
        ));
    }
    let sure = |fit: &Fit| {
        fit.beyond
            .is_some_and(|slope| slope.standard_error.is_some())
    };
    if last_level(caches).is_some() && !fits.iter().any(sure) {
        words.push(
            "Fewer than three sizes exceed the last cache, too few for a reliable line: use a larger --to or more --steps.".into(),
        );
    }
    words
}

/// Describes the change of the time per element from the smallest to the largest size.
fn prices(sizes: &[SizeReport], fits: &[Fit]) -> Option<String> {
    let (small, large) = (sizes.first()?, sizes.last()?);
    let price = |size: &SizeReport, fit: &Fit| {
        let mut rows = size.results.iter();
        let row = rows.find(|r| r.backend == fit.backend && r.operation == fit.operation);
        row?.ns_per_element
    };
    let local = fits.iter().filter(|fit| !fit.scans);
    let mut dearer: Vec<(f64, &Fit)> = local
        .filter_map(|fit| Some((price(large, fit)? / price(small, fit)?, fit)))
        .filter(|(ratio, _)| ratio.is_finite())
        .collect();
    dearer.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let (least, first) = dearer.first()?;
    let (most, last) = dearer.last()?;
    (small.faces < large.faces).then(|| {
        format!(
            "From {} to {} faces, the time per element changes by a factor between {least:.2} ({} on {}) and {most:.2} ({} on {}).",
            grouped(small.faces),
            grouped(large.faces),
            first.operation,
            first.backend,
            last.operation,
            last.backend,
        )
    })
}

/// Lists for each operation the backend that is fastest beyond the noise, with its range of sizes.
fn fastest(sizes: &[SizeReport]) -> Vec<String> {
    let mut words = Vec::new();
    let operations = sizes.first().map_or(&[][..], |size| &size.results);
    for row in operations.chunk_by(|a, b| a.operation == b.operation) {
        let operation = row[0].operation;
        let best = sizes.iter().map(|size| {
            let mut rows = size.results.iter();
            let best =
                rows.find(|r| r.operation == operation && r.standing == Some(Standing::Best));
            (size.faces, best.map(|r| r.backend.as_str()))
        });
        let best: Vec<(usize, Option<&str>)> = best.collect();
        let runs = best.chunk_by(|(_, a), (_, b)| a == b).map(|run| {
            let who = run[0].1.unwrap_or("a tie");
            match (run.first(), run.last()) {
                (Some((first, _)), Some((last, _))) if first < last => {
                    format!("{who} from {} to {}", grouped(*first), grouped(*last))
                }
                _ => format!("{who} at {}", grouped(run[0].0)),
            }
        });
        let runs: Vec<String> = runs.collect();
        words.push(match (&best[..], runs.len()) {
            ([(_, None), ..], 1) => format!("{operation}: a tie at every size."),
            ([(_, Some(who)), ..], 1) => format!("{operation}: {who} is fastest at every size."),
            _ => format!("{operation}: fastest is {}.", runs.join(", ")),
        });
    }
    words
}

/// Lists the sizes at which structures outgrow the last cache, or states that the caches are
/// unknown.
fn cache_words(caches: &[Cache], ends: &[CacheEnd]) -> Option<String> {
    let Some(bytes) = last_level(caches) else {
        return Some(
            "The cache sizes of this machine are unknown, so one line is fitted to all sizes."
                .into(),
        );
    };
    let last = ends.iter().map(|end| end.level).max()?;
    let of_it = ends.iter().filter(|end| end.level == last);
    let parts: Vec<String> = of_it
        .map(|end| format!("{} {}", end.backend, grouped(end.faces)))
        .collect();
    let kib = grouped(bytes as usize >> 10);
    Some(format!(
        "Faces at which each structure outgrows the last cache (L{last}, {kib} KiB): {}.",
        parts.join(", ")
    ))
}

/// Describes the noise that the controls of all sizes show.
fn noise(sizes: &[SizeReport]) -> Option<String> {
    let controls = sizes.iter().filter_map(|size| size.control.as_ref());
    let controls: Vec<_> = controls.collect();
    let name = &controls.first()?.backend;
    let most = controls.iter().map(|c| c.typical).fold(1.0, f64::max);
    Some(format!(
        "Noise: {name} was entered twice at every size; its two columns typically differ by at most {}.",
        times(most)
    ))
}

/// Describes figures that are uncertain because the budget was too small.
fn doubts(sizes: &[SizeReport], fits: &[Fit]) -> Vec<String> {
    let mut words = Vec::new();
    let rows = sizes.iter().flat_map(|size| &size.results);
    let measured = rows.filter(|r| r.median_ns.is_some());
    if let Some(fewest) = measured.map(|r| r.samples).min().filter(|&n| n < 5) {
        let samples = if fewest == 1 { "sample" } else { "samples" };
        words.push(format!(
            "Some figures rest on only {fewest} {samples}: use a longer --budget."
        ));
    }
    let estimated: usize = fits.iter().map(|fit| fit.estimated).sum();
    if estimated > 0 {
        words.push(format!(
            "{} of the fitted times are estimates, because the runs are too long for the budget.",
            grouped(estimated)
        ));
    }
    words
}
