//! Sentences on subdivision methods: which method is faster on which structure.

use sixfold::subdivision::Method;

use crate::report::{BackendReport, ResultRow};
use sixfold_workload::Operation;

/// Smaller ratios of two methods are not reported.
const ALIKE: f64 = 1.1;
/// Assumed error factor of a figure without an interval: an estimate, or one with few samples.
const UNSURE: f64 = 1.5;

/// A time in nanoseconds, with its interval.
#[derive(Clone, Copy)]
struct Took {
    low: f64,
    ns: f64,
    high: f64,
}

impl Took {
    fn of(row: &ResultRow) -> Option<Self> {
        let ns = row.median_ns.or(row.estimated_ns)?;
        Some(Self {
            low: row.ci_low_ns.unwrap_or(ns / UNSURE),
            ns,
            high: row.ci_high_ns.unwrap_or(ns * UNSURE),
        })
    }

    /// Returns the ratio of this time to `other`, if this is clearly longer.
    fn beyond(self, other: Self) -> Option<f64> {
        let ratio = self.ns / other.ns;
        (self.low > other.high && ratio > ALIKE).then_some(ratio)
    }
}

/// Returns one sentence per scheme: the structures on which scatter is faster than gather, those on
/// which it is slower, and those on which native steps are faster than both. `times` formats a
/// ratio.
pub(crate) fn methods(
    backends: &[BackendReport],
    results: &[ResultRow],
    times: fn(f64) -> String,
) -> Vec<String> {
    let took = |operation: Operation, backend: &BackendReport| {
        let mut rows = results.iter();
        let row = rows.find(|row| row.operation == operation && row.backend == backend.name);
        Took::of(row?)
    };
    let mut words = Vec::new();
    let catmull_clark: fn(Method) -> Operation = Operation::CatmullClark;
    for (name, by) in [("Catmull–Clark", catmull_clark), ("Loop", Operation::Loop)] {
        let (mut rescued, mut slowed, mut native) = (Vec::new(), Vec::new(), Vec::new());
        for backend in backends {
            let [gather, scatter, own] = Method::ALL.map(|method| took(by(method), backend));
            let said = |ratio: f64| (ratio, format!("{} {}", backend.name, times(ratio)));
            if let (Some(gather), Some(scatter)) = (gather, scatter) {
                rescued.extend(gather.beyond(scatter).map(said));
                slowed.extend(scatter.beyond(gather).map(said));
            }
            let rebuilt = [gather, scatter].into_iter().flatten();
            let rebuilt = rebuilt.min_by(|a, b| a.ns.total_cmp(&b.ns));
            if let (Some(rebuilt), Some(own)) = (rebuilt, own) {
                native.extend(rebuilt.beyond(own).map(said));
            }
        }
        let parts = [
            ("scatter is faster than gather on", rescued),
            ("slower on", slowed),
            ("native is faster than both on", native),
        ];
        let mut said = Vec::new();
        for (verb, mut list) in parts {
            list.sort_by(|(a, _), (b, _)| b.total_cmp(a));
            let list: Vec<String> = list.into_iter().map(|(_, said)| said).collect();
            if !list.is_empty() {
                let verb = match verb {
                    "slower on" if said.is_empty() => "scatter is slower than gather on",
                    verb => verb,
                };
                said.push(format!("{verb} {}", list.join(", ")));
            }
        }
        if !said.is_empty() {
            words.push(format!("{name}: {}.", said.join("; ")));
        }
    }
    words
}
