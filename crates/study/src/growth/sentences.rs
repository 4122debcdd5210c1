//! Sentences about the results of one shape in several sizes.

use super::{CacheLimit, Fit, SizeReport};
use crate::numbers::{grouped, times};
use crate::report::{Agreement, Standing};
use crate::slope::Slope;
use sixfold_workload::{Cache, last_level_bytes};

pub(super) fn sentences(
    sizes: &[SizeReport],
    fits: &[Fit],
    caches: &[Cache],
    ends: &[CacheLimit],
) -> Vec<String> {
    let mut sentences = Vec::new();
    sentences.extend(exponents(fits, caches));
    sentences.extend(per_element_changes(sizes, fits));
    sentences.extend(fastest(sizes));
    sentences.extend(cache_limits(caches, ends));
    sentences.extend(noise(sizes));
    sentences.extend(uncertain_figures(sizes, fits));
    for size in sizes {
        for row in &size.results {
            if row.agreement == Agreement::Mismatch {
                let (backend, operation) = (&row.backend, row.operation);
                sentences.push(format!(
                    "{operation} on {backend} gives different results from the other backends at \
                     {} faces. This is a fault in Sixfold: please report it.",
                    grouped(size.faces)
                ));
            }
        }
    }
    sentences
}

pub(super) fn left_out(sizes: &[usize]) -> Option<String> {
    let names: Vec<String> = sizes.iter().map(|&faces| grouped(faces)).collect();
    (!names.is_empty()).then(|| {
        format!(
            "The budget was too short to measure sizes of about {} faces: use a longer --budget.",
            names.join(", ")
        )
    })
}

fn exponents(fits: &[Fit], caches: &[Cache]) -> Vec<String> {
    let range = |scans: bool, slope: &dyn Fn(&Fit) -> Option<Slope>| {
        let slopes = fits.iter().filter(|fit| fit.scans == scans);
        // A line through two points has no error estimate.
        let reliable = slopes.filter_map(|fit| slope(fit).filter(|s| s.standard_error.is_some()));
        let mut slopes: Vec<f64> = reliable.map(|slope| slope.exponent).collect();
        slopes.sort_by(f64::total_cmp);
        let (least, most) = (slopes.first()?, slopes.last()?);
        Some(format!("{least:.2} to {most:.2}"))
    };
    let mut sentences = Vec::new();
    if let Some(all) = range(false, &|fit| fit.all) {
        let parts = [
            range(false, &|fit| fit.in_cache)
                .map(|r| format!("{r} for sizes that fit into the last cache")),
            range(false, &|fit| fit.beyond).map(|r| format!("{r} for larger sizes")),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        let split = match parts.is_empty() {
            true => String::new(),
            false => format!(" ({})", parts.join(", ")),
        };
        sentences.push(format!(
            "On structures that do not scan all faces for each element, the total time grows with \
             the number of faces to the power {all}{split}."
        ));
    }
    if let Some(all) = range(true, &|fit| fit.all) {
        sentences.push(format!(
            "On structures that scan all faces for each element, the total time grows with the \
             number of faces to the power {all}."
        ));
    }
    let reliable = |fit: &Fit| {
        fit.beyond
            .is_some_and(|slope| slope.standard_error.is_some())
    };
    if last_level_bytes(caches).is_some() && !fits.iter().any(reliable) {
        sentences.push(
            "Fewer than three sizes are larger than the last cache, but a reliable line needs at \
             least three sizes: use a larger --to or more --steps."
                .into(),
        );
    }
    sentences
}

fn per_element_changes(sizes: &[SizeReport], fits: &[Fit]) -> Option<String> {
    let (small, large) = (sizes.first()?, sizes.last()?);
    let ns_per_element_at = |size: &SizeReport, fit: &Fit| {
        let mut rows = size.results.iter();
        let row = rows.find(|r| r.backend == fit.backend && r.operation == fit.operation);
        row?.ns_per_element
    };
    let local = fits.iter().filter(|fit| !fit.scans);
    let mut changes: Vec<(f64, &Fit)> = local
        .filter_map(|fit| {
            Some((
                ns_per_element_at(large, fit)? / ns_per_element_at(small, fit)?,
                fit,
            ))
        })
        .filter(|(ratio, _)| ratio.is_finite())
        .collect();
    changes.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let (least, first) = changes.first()?;
    let (most, last) = changes.last()?;
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

/// Lists the clearly fastest backend of each operation, and the range of sizes.
fn fastest(sizes: &[SizeReport]) -> Vec<String> {
    let mut sentences = Vec::new();
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
            let name = run[0].1.map_or_else(
                || "a tie for the fastest".to_owned(),
                |name| format!("{name} is fastest"),
            );
            match (run.first(), run.last()) {
                (Some((first, _)), Some((last, _))) if first < last => {
                    format!(
                        "{name} from {} to {} faces",
                        grouped(*first),
                        grouped(*last)
                    )
                }
                _ => format!("{name} at {} faces", grouped(run[0].0)),
            }
        });
        let runs: Vec<String> = runs.collect();
        sentences.push(match (&best[..], runs.len()) {
            ([(_, None), ..], 1) => format!("{operation}: a tie for the fastest at every size."),
            ([(_, Some(name)), ..], 1) => format!("{operation}: {name} is fastest at every size."),
            _ => format!("{operation}: {}.", runs.join("; ")),
        });
    }
    sentences
}

/// Lists the sizes at which structures outgrow the last cache.
fn cache_limits(caches: &[Cache], ends: &[CacheLimit]) -> Option<String> {
    let Some(bytes) = last_level_bytes(caches) else {
        return Some(
            "The cache sizes of this machine are unknown, so one line is fitted to all sizes."
                .into(),
        );
    };
    let last = ends.iter().map(|end| end.level).max()?;
    let last_ends = ends.iter().filter(|end| end.level == last);
    let parts: Vec<String> = last_ends
        .map(|end| format!("{} {}", end.backend, grouped(end.faces)))
        .collect();
    let kib = grouped(bytes as usize >> 10);
    Some(format!(
        "Number of faces from which each structure is larger than the last cache (L{last}, {kib} \
         KiB): {}.",
        parts.join(", ")
    ))
}

fn noise(sizes: &[SizeReport]) -> Option<String> {
    let controls = sizes.iter().filter_map(|size| size.control.as_ref());
    let controls: Vec<_> = controls.collect();
    let name = &controls.first()?.backend;
    let most = controls.iter().map(|c| c.typical).fold(1.0, f64::max);
    Some(format!(
        "Noise: {name} was measured twice at every size. At the noisiest size, the typical ratio \
         of the two times is {}.",
        times(most)
    ))
}

/// Lists the figures that are uncertain because the budget was too small.
fn uncertain_figures(sizes: &[SizeReport], fits: &[Fit]) -> Vec<String> {
    let mut sentences = Vec::new();
    let rows = sizes.iter().flat_map(|size| &size.results);
    let measured = rows.filter(|r| r.median_ns.is_some());
    if let Some(fewest) = measured.map(|r| r.samples).min().filter(|&n| n < 5) {
        let samples = if fewest == 1 { "sample" } else { "samples" };
        sentences.push(format!(
            "Some figures are from only {fewest} {samples}: use a longer --budget."
        ));
    }
    let estimated: usize = fits.iter().map(|fit| fit.estimated).sum();
    if estimated > 0 {
        sentences.push(format!(
            "{} of the fitted times are estimates, because real runs would exceed the budget.",
            grouped(estimated)
        ));
    }
    sentences
}
