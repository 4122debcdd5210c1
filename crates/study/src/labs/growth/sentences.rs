//! Sentences about the results of one shape in several sizes.

use super::{CacheLimit, Fit};
use sixfold_measure::Operation;
use sixfold_results::numbers::{figure, grouped, list, shown_ratio, times};
use sixfold_results::{Agreement, Cache, ResultRow, SizeReport, Slope, Standing, last_level_bytes};

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
    sentences.extend(estimates(fits));
    for size in sizes {
        for row in &size.results {
            if row.agreement == Agreement::Mismatch {
                let (backend, operation) = (&row.backend, &row.operation);
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
            "Fewer than three sizes, or none, are larger than the last cache, but a reliable line \
             needs at least three sizes: use a larger --to or more --steps."
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
            let [large, small] = [large, small].map(|size| ns_per_element_at(size, fit));
            Some((shown_ratio(large?, small?), fit))
        })
        .filter(|(ratio, _)| ratio.is_finite())
        .collect();
    changes.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let (least, first) = changes.first()?;
    let (most, last) = changes.last()?;
    (small.faces < large.faces).then(|| {
        format!(
            "On structures that do not scan all faces for each element, the time per element changes from {} to {} faces by a factor between {} ({} on {}) and {} ({} on {}).",
            grouped(small.faces),
            grouped(large.faces),
            figure(*least),
            first.operation,
            first.backend,
            figure(*most),
            last.operation,
            last.backend,
        )
    })
}

/// The answer to the question which backend is fastest at one operation and one size.
#[derive(Clone, Debug, PartialEq)]
enum Leader<'s> {
    /// One backend is fastest.
    Best(&'s str),
    /// Several backends share the first place.
    Several,
    /// Only these backends have times, but other backends have times at other sizes.
    Only(Vec<&'s str>),
    /// No backend has a time.
    NotMeasured,
}

impl Leader<'_> {
    fn describe(&self) -> String {
        match self {
            Self::Best(name) => format!("{name} is fastest"),
            Self::Several => "no sole winner".into(),
            Self::Only(names) if names.len() == 1 => format!("only {} has times", names[0]),
            Self::Only(names) => format!("only {} have times", list(names)),
            Self::NotMeasured => "no times".into(),
        }
    }
}

/// Lists the clearly fastest backend of each operation, and the range of sizes. At a size at which
/// some backends have no time, no backend is called the fastest. A lower bound counts as a time only
/// if it is longer than the fastest measured time.
fn fastest(sizes: &[SizeReport]) -> Vec<String> {
    let mut sentences = Vec::new();
    for operation in Operation::ALL.map(Operation::name) {
        let rows = |size| {
            let measured = rows_of(size, operation).filter_map(|row| row.median_ns);
            let least = measured.min_by(f64::total_cmp).unwrap_or(f64::INFINITY);
            let is_slower = move |bound| bound > least;
            rows_of(size, operation).filter(move |row| {
                row.median_ns.is_some() || row.estimated_ns.is_some_and(is_slower)
            })
        };
        if sizes.iter().flat_map(rows).next().is_none() {
            continue;
        }
        let mut all: Vec<&str> = Vec::new();
        for row in sizes.iter().flat_map(|size| rows_of(size, operation)) {
            if !all.contains(&row.backend.as_str()) {
                all.push(&row.backend);
            }
        }
        let leader = |size| {
            let names: Vec<&str> = rows(size).map(|row| row.backend.as_str()).collect();
            let mut best = rows(size).filter(|row| row.standing == Some(Standing::Best));
            match best.next() {
                _ if names.is_empty() => Leader::NotMeasured,
                _ if names.len() < all.len() || all.len() == 1 => Leader::Only(names),
                Some(best) => Leader::Best(&best.backend),
                None => Leader::Several,
            }
        };
        let leaders: Vec<(usize, Leader<'_>)> = sizes
            .iter()
            .map(|size| (size.faces, leader(size)))
            .collect();
        let runs = leaders.chunk_by(|(_, a), (_, b)| a == b).map(|run| {
            let what = run[0].1.describe();
            let [first, last] = [run[0].0, run[run.len() - 1].0];
            match run.len() {
                _ if run.len() == leaders.len() => format!("{what} at every size"),
                1 => format!("{what} at {} faces", grouped(first)),
                _ => format!("{what} from {} to {} faces", grouped(first), grouped(last)),
            }
        });
        let runs: Vec<String> = runs.collect();
        sentences.push(format!("{operation}: {}.", runs.join("; ")));
    }
    sentences
}

fn rows_of<'s>(size: &'s SizeReport, operation: &str) -> impl Iterator<Item = &'s ResultRow> {
    let rows = size.results.iter();
    rows.filter(move |row| row.operation == operation)
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
    let mib = grouped(bytes as usize >> 20);
    Some(format!(
        "Number of faces from which each structure is larger than the last cache (L{last}, {mib} \
         MiB): {}.",
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

/// Counts the estimates, which are not on the fitted lines.
fn estimates(fits: &[Fit]) -> Option<String> {
    let estimated: usize = fits.iter().map(|fit| fit.estimated).sum();
    (estimated > 0).then(|| {
        format!(
            "{} of the times are estimates, because real runs would exceed the budget. No line is \
             fitted to them.",
            grouped(estimated)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each backend has a time if it is in `timed`; the first one is the best if `best` is set.
    fn size(faces: usize, timed: &[&str], best: bool) -> SizeReport {
        let row = |(i, backend): (usize, &&str)| ResultRow {
            median_ns: Some(1.0),
            standing: Some(match (i, best) {
                (0, true) => Standing::Best,
                (_, true) => Standing::Slower,
                (_, false) => Standing::Undecided,
            }),
            ..ResultRow::new(
                backend,
                Operation::Boundary.name(),
                Operation::Boundary.unit(),
            )
        };
        SizeReport {
            vertices: faces,
            edges: faces,
            faces,
            backend_bytes: Vec::new(),
            results: timed.iter().enumerate().map(row).collect(),
            samples: Vec::new(),
            refusals: Vec::new(),
            control: None,
        }
    }

    #[test]
    fn no_backend_is_fastest_at_a_size_without_the_other_backends() {
        let both = ["half-edge", "indexed-face-set"];
        let sizes = [
            size(100, &both, true),
            size(1000, &both, true),
            size(3380, &["indexed-face-set"], true),
            size(10_000, &both, false),
            size(317_520, &[], false),
        ];
        assert_eq!(
            fastest(&sizes),
            [
                "boundary: half-edge is fastest from 100 to 1,000 faces; only indexed-face-set has \
                 times at 3,380 faces; no sole winner at 10,000 faces; no times at 317,520 \
                 faces."
            ]
        );
        assert_eq!(
            fastest(&sizes[..2]),
            ["boundary: half-edge is fastest at every size."]
        );
        assert_eq!(
            fastest(&[size(10, &both[..1], false)]),
            ["boundary: only half-edge has times at every size."]
        );
        assert!(fastest(&sizes[4..]).is_empty());
    }

    #[test]
    fn a_lower_bound_counts_only_if_it_is_longer_than_the_fastest_time() {
        let with_bound = |ns| {
            let mut size = size(100, &["half-edge", "face-vertex", "polygon-soup"], true);
            let soup = size.results.last_mut().expect("three rows");
            (soup.median_ns, soup.estimated_ns, soup.standing) = (None, Some(ns), None);
            size
        };
        let slower = "boundary: half-edge is fastest at every size.";
        assert_eq!(fastest(&[with_bound(1.5)]), [slower]);
        let open = "boundary: only half-edge and face-vertex have times at 100 faces; half-edge is \
                    fastest at 100 faces.";
        assert_eq!(fastest(&[with_bound(0.5), with_bound(1.5)]), [open]);
        let never = "boundary: only half-edge and face-vertex have times at every size.";
        assert_eq!(fastest(&[with_bound(0.5)]), [never]);
    }

    #[test]
    fn estimates_are_counted_over_all_lines() {
        let fit = |estimated| Fit {
            backend: "polygon-soup".into(),
            operation: Operation::Boundary.name().into(),
            scans: true,
            all: None,
            in_cache: None,
            beyond: None,
            estimated,
        };
        let sentence = estimates(&[fit(2), fit(0), fit(3)]);
        let sentence = sentence.expect("five estimates");
        assert!(sentence.starts_with("5 of the times"), "{sentence}");
        assert_eq!(estimates(&[fit(0)]), None);
    }
}
