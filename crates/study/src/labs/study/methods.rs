//! Sentences about subdivision methods.

use sixfold::subdivision::Method;

use sixfold_measure::Operation;
use sixfold_results::numbers::{rounded_down, shown_ratio, times};
use sixfold_results::{BackendReport, ResultRow};

/// Minimum ratio of two methods that is reported.
const MIN_RATIO: f64 = 1.1;
/// Assumed error factor of a time without an interval.
const ASSUMED_ERROR: f64 = 1.5;

#[derive(Clone, Copy)]
struct MeasuredTime {
    low: f64,
    ns: f64,
    /// The time per element, which the table shows.
    each_ns: f64,
    high: f64,
    /// Whether the time is an estimate: a lower bound.
    bound: bool,
}

impl MeasuredTime {
    fn from_row(row: &ResultRow) -> Option<Self> {
        let ns = row.median_ns.or(row.estimated_ns)?;
        Some(Self {
            low: row.ci_low_ns.unwrap_or(ns / ASSUMED_ERROR),
            ns,
            each_ns: ns / row.elements.filter(|&n| n > 0)? as f64,
            high: row.ci_high_ns.unwrap_or(ns * ASSUMED_ERROR),
            bound: row.median_ns.is_none(),
        })
    }

    /// Returns the ratio of this time to `other`, and its text, if this time is clearly longer.
    fn ratio_if_longer(self, other: Self) -> Option<(f64, String)> {
        let ratio = shown_ratio(self.each_ns, other.each_ns);
        let longer = self.low > other.high && !other.bound && ratio > MIN_RATIO;
        let text = match self.bound {
            true => format!("≥ {}", times(rounded_down(ratio))),
            false => times(ratio),
        };
        longer.then_some((ratio, text))
    }
}

/// Returns one sentence per scheme about the fastest method on each structure.
pub(crate) fn methods(backends: &[BackendReport], results: &[ResultRow]) -> Vec<String> {
    let time_of = |operation: Operation, backend: &BackendReport| {
        let mut rows = results.iter();
        let row = rows.find(|row| row.operation == operation.name() && row.backend == backend.name);
        MeasuredTime::from_row(row?)
    };
    let mut sentences = Vec::new();
    let catmull_clark: fn(Method) -> Operation = Operation::CatmullClark;
    for (name, by) in [("Catmull–Clark", catmull_clark), ("Loop", Operation::Loop)] {
        let (mut scatter_faster, mut scatter_slower, mut native) =
            (Vec::new(), Vec::new(), Vec::new());
        for backend in backends {
            let [gather, scatter, own] = Method::ALL.map(|method| time_of(by(method), backend));
            let phrase = |(ratio, text)| (ratio, format!("{} ({text})", backend.name));
            if let (Some(gather), Some(scatter)) = (gather, scatter) {
                scatter_faster.extend(gather.ratio_if_longer(scatter).map(phrase));
                scatter_slower.extend(scatter.ratio_if_longer(gather).map(phrase));
            }
            let rebuilt = [gather, scatter].into_iter().flatten();
            let rebuilt = rebuilt.min_by(|a, b| a.ns.total_cmp(&b.ns));
            if let (Some(rebuilt), Some(own)) = (rebuilt, own) {
                native.extend(rebuilt.ratio_if_longer(own).map(phrase));
            }
        }
        let parts = [
            ("scatter is faster than gather on", scatter_faster),
            ("scatter is slower than gather on", scatter_slower),
            ("native is faster than gather and scatter on", native),
        ];
        let mut phrases = Vec::new();
        for (verb, mut list) in parts {
            list.sort_by(|(a, _), (b, _)| b.total_cmp(a));
            let list: Vec<String> = list.into_iter().map(|(_, phrase)| phrase).collect();
            if !list.is_empty() {
                phrases.push(format!("{verb} {}", list.join(", ")));
            }
        }
        if !phrases.is_empty() {
            sentences.push(format!("{name}: {}.", phrases.join("; ")));
        }
    }
    sentences
}
