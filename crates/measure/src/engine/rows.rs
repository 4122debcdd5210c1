//! Makes the rows of a finding from the measured entries, for all labs.

use crate::TimedBackend;
use sixfold_results::{Agreement, Confidence, ResultRow, Time};

use crate::engine::measure::Entry;
use sixfold_results::ranking::{rank, time};
use sixfold_results::statistics::{Median, median};

/// The measured entries of one task, which are compared with each other.
pub struct Group<'g> {
    pub entries: &'g [Entry],
    /// The corrected time of each entry.
    pub times: &'g [Option<f64>],
    pub agreements: &'g [Agreement],
    /// Ratios up to this value are not differences.
    pub noise: f64,
    /// The confidence of the intervals.
    pub confidence: Confidence,
    /// The number of elements of a whole run, if no run was measured.
    pub expected: Option<u64>,
}

impl Group<'_> {
    /// Returns a row for each entry with a time or an estimate. A backend that did other work than
    /// the others is not ranked.
    pub fn rows(&self, subjects: &[Box<dyn TimedBackend + '_>]) -> impl Iterator<Item = ResultRow> {
        let samples: Vec<Vec<(u32, Time)>> = self.entries.iter().map(Entry::times).collect();
        let compared = self.agreements.iter().zip(self.times);
        let compared = compared.map(|(agreement, &ns)| {
            ns.filter(|_| !matches!(agreement, Agreement::Mismatch | Agreement::OtherEdits))
        });
        let (compared, confidence) = (compared.collect::<Vec<_>>(), self.confidence);
        let ranks = rank(&samples, &compared, self.noise, confidence);
        // The largest count comes from a whole run, if any backend made a whole run.
        let counted = self
            .entries
            .iter()
            .filter(|e| e.job.sample.is_none() && subjects[e.subject].merged_vertices() == 0)
            .find_map(|e| e.outcome);
        let rows = self.entries.iter().zip(&samples).enumerate().zip(ranks);
        let rows = rows.filter_map(|((i, (entry, samples)), rank)| {
            if !entry.has_time() {
                return None; // refused, or the measurement was stopped before
            }
            let time = self.times[i].and_then(|ns| time(samples, ns));
            let wall = Median::from_samples(samples.iter().map(|(_, time)| time.wall_ns));
            let elements = match entry.job.sample {
                Some(_) => counted.or(entry.outcome),
                None => entry.outcome.or(counted),
            };
            let elements = elements.map(|outcome| outcome.elements);
            let elements = elements.or(entry.estimate.and(self.expected));
            let per_element = |ns: f64| Some(ns / elements.filter(|&n| n > 0)? as f64);
            let interval = time.and_then(|time| time.interval(confidence));
            let ratio = rank.and_then(|rank| rank.ratio.interval(confidence));
            Some(ResultRow {
                case: entry.case.into(),
                backend: subjects[entry.subject].name().into(),
                operation: entry.name.into(),
                median_ns: time.map(|time| time.value),
                uncorrected_ns: median(samples.iter().map(|(_, time)| time.ns()).collect()),
                min_ns: time.map(|time| time.least),
                ci_low_ns: interval.map(|[low, _]| low),
                ci_high_ns: interval.map(|[_, high]| high),
                elements,
                per: entry.per.into(),
                ns_per_element: time.and_then(|time| per_element(time.value)),
                wall_median_ns: wall.map(|wall| wall.value),
                wall_min_ns: wall.map(|wall| wall.least),
                sampled: entry.job.sample.is_some(),
                sample_size: entry.job.sample.map(|sample| sample.size),
                estimated_ns: entry.estimate.map(Time::ns),
                checksum: entry
                    .outcome
                    .map(|outcome| outcome.checksum)
                    .filter(|checksum| checksum.is_finite()),
                agreement: self.agreements[i],
                standing: rank.and_then(|rank| rank.standing),
                ratio_to_best: rank.map(|rank| rank.ratio.value),
                ratio_ci_low: ratio.map(|[low, _]| low),
                ratio_ci_high: ratio.map(|[_, high]| high),
                launch_ns: Vec::new(),
                samples: samples.len(),
                runs_per_sample: entry.runs,
                warm_up_only: entry.is_warm_up_only(),
                by_name_only: entry.by_name_only,
                faults: most_faults(entry.samples.iter().map(|(_, time)| time)),
                retaken: entry.retaken,
                disturbed: entry.samples.len().saturating_sub(samples.len()),
                first_ns: entry.first_ns(),
                first_samples: entry.first_times.len(),
                first_faults: most_faults(entry.first_times.iter().map(|[first, _]| first)),
            })
        });
        rows.collect::<Vec<_>>().into_iter()
    }
}

fn most_faults<'t>(samples: impl IntoIterator<Item = &'t Time>) -> Option<u64> {
    samples.into_iter().filter_map(|time| time.faults).max()
}
