//! Lines fitted to the times, and the sizes at which structures become larger than caches.

use sixfold_core::Counts;

use super::settings::scaled;
use sixfold_measure::Operation;
use sixfold_results::{Cache, CacheLimit, Fit, SizeReport, Slope};
use sixfold_workload::Backend;

pub(super) fn fits(
    sizes: &[SizeReport],
    backends: &[&Backend],
    operations: &[Operation],
    last_level_bytes: Option<u64>,
) -> Vec<Fit> {
    let mut fits = Vec::new();
    for &operation in operations {
        for backend in backends {
            let mut points: Vec<(f64, f64, bool)> = Vec::new();
            let mut estimated = 0;
            for size in sizes {
                let row = size.results.iter();
                let mut row =
                    row.filter(|r| r.operation == operation.name() && r.backend == backend.name());
                let memory = size
                    .backend_bytes
                    .iter()
                    .find(|w| w.backend == backend.name());
                let Some((row, memory)) = row.next().zip(memory) else {
                    continue;
                };
                let Some(ns) = row.median_ns else {
                    estimated += usize::from(row.estimated_ns.is_some());
                    continue;
                };
                let fits = last_level_bytes.is_some_and(|bytes| memory.bytes as u64 <= bytes);
                points.push((size.faces as f64, ns, fits));
            }
            if points.is_empty() && estimated == 0 {
                continue;
            }
            let slope = |takes_part: &dyn Fn(bool) -> bool| {
                let part = points.iter().filter(|(.., fits)| takes_part(*fits));
                Slope::fit(part.map(|&(faces, ns, _)| (faces, ns)))
            };
            let known = last_level_bytes.is_some();
            fits.push(Fit {
                backend: backend.name().into(),
                operation: operation.name().into(),
                scans: operation.scans(&backend.info.costs).contains(&true),
                all: slope(&|_| true),
                in_cache: slope(&|fits| known && fits),
                beyond: slope(&|fits| known && !fits),
                estimated,
            });
        }
    }
    fits
}

/// Finds the sizes at which layouts outgrow the data caches. `counts` are the counts of a large
/// mesh.
pub(super) fn cache_limits(
    backends: &[&Backend],
    counts: &Counts,
    caches: &[Cache],
) -> Vec<CacheLimit> {
    let mut ends = Vec::new();
    for cache in caches.iter().filter(|cache| cache.holds_data()) {
        for backend in backends {
            let beyond = |faces: usize| {
                let counts = scaled(counts, faces as f64 / counts.faces as f64);
                (backend.layout_bytes)(&counts) as u64 > cache.bytes
            };
            // Every layout takes at least one byte per face.
            let (mut fits, mut too_large) = (0, cache.bytes as usize + 1);
            while too_large - fits > 1 {
                let middle = usize::midpoint(fits, too_large);
                match beyond(middle) {
                    true => too_large = middle,
                    false => fits = middle,
                }
            }
            ends.push(CacheLimit {
                backend: backend.name().into(),
                level: cache.level,
                cache_bytes: cache.bytes,
                faces: too_large,
            });
        }
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labs::growth::BackendBytes;
    use sixfold::{Facts, shapes};
    use sixfold_results::ResultRow;

    fn size(faces: usize, bytes: usize, ns: f64, estimated: bool) -> SizeReport {
        let operation = Operation::Boundary;
        let row = ResultRow {
            median_ns: (!estimated).then_some(ns),
            estimated_ns: estimated.then_some(ns),
            ..ResultRow::new("half-edge", operation.name(), operation.unit())
        };
        SizeReport {
            vertices: 0,
            edges: 0,
            faces,
            backend_bytes: vec![BackendBytes {
                backend: "half-edge".into(),
                bytes,
                fits_in: None,
            }],
            results: vec![row],
            samples: Vec::new(),
            refusals: Vec::new(),
            control: None,
        }
    }

    #[test]
    fn sizes_inside_and_beyond_the_last_cache_have_separate_lines() {
        // The time is linear up to 10⁵ faces, which fill the cache. Then it grows with the power
        // 1.5.
        let time = |n: f64| {
            if n <= 1e5 {
                n
            } else {
                1e5 * (n / 1e5).powf(1.5)
            }
        };
        let measured =
            [1e3, 1e4, 1e5, 1e6, 1e8].map(|n| size(n as usize, 10 * n as usize, time(n), false));
        // An estimate is on no line.
        let estimate = size(10_000_000, 100_000_000, 1.0, true);
        let sizes: Vec<SizeReport> = measured.into_iter().chain([estimate]).collect();
        let backends = Backend::structures();
        let backends: Vec<&Backend> = backends.iter().collect();
        let fit =
            |last_level_bytes| fits(&sizes, &backends, &[Operation::Boundary], last_level_bytes);
        let found = fit(Some(1_000_000));
        let [only_fit] = &found[..] else {
            panic!("one backend has times: {found:?}")
        };
        assert_eq!((only_fit.estimated, only_fit.scans), (1, false));
        let [small, large, all] = [only_fit.in_cache, only_fit.beyond, only_fit.all];
        let (small, large) = (small.expect("three"), large.expect("two"));
        assert!((small.exponent - 1.0).abs() < 1e-9 && small.sizes == 3);
        assert!((large.exponent - 1.5).abs() < 1e-9 && large.sizes == 2);
        assert!(all.is_some_and(|all| all.sizes == 5));
        let unknown = &fit(None)[0];
        assert_eq!((unknown.in_cache, unknown.beyond), (None, None));
        assert_eq!(unknown.all, only_fit.all);
    }

    #[test]
    fn a_cache_ends_at_the_first_layout_larger_than_it() {
        let mesh = shapes::triangle_torus(20, 10).expect("small");
        let counts = mesh.counts(Facts::from_polygons(&mesh).edges);
        let cache = |kind: &str| Cache {
            level: 2,
            kind: kind.into(),
            bytes: 512 << 10,
            shared_by: None,
        };
        let structures = Backend::structures();
        let backends: Vec<&Backend> = structures.iter().collect();
        let ends = cache_limits(
            &backends,
            &counts,
            &[cache("instruction"), cache("unified")],
        );
        assert_eq!(ends.len(), backends.len(), "instruction caches skipped");
        for (end, backend) in ends.iter().zip(&backends) {
            let bytes = |faces: usize| {
                let counts = scaled(&counts, faces as f64 / counts.faces as f64);
                (backend.layout_bytes)(&counts)
            };
            assert!(bytes(end.faces) > 512 << 10, "{end:?}");
            assert!(bytes(end.faces - 1) <= 512 << 10, "{end:?}");
        }
        // 24 words per vertex and two faces per vertex give 48 bytes per face.
        let half_edge = ends
            .iter()
            .find(|end| end.backend == "half-edge")
            .expect("one of six");
        assert!(
            half_edge.faces.abs_diff((512 << 10) / 48) < 20,
            "{half_edge:?}"
        );
    }
}
