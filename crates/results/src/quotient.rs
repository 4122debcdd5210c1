//! Ratios of the times of two backends: each backend can be the baseline of the others.

use crate::findings::pick::EQUAL_UP_TO;
use crate::findings::study::Report;
use crate::launches::ratio_over_launches;
use crate::numbers::shown_ratio;
use crate::ranking::ratio;
use crate::rows::{Agreement, ResultRow, Samples, Standing};
use crate::statistics::undisturbed;
use crate::time::Time;

/// The time of one backend divided by the time of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quotient {
    /// The quotient of the times; over several meshes, the geometric mean.
    pub ratio: f64,
    /// The interval of `ratio`: on one mesh, of the ratios within launches, or within the rounds of the only
    /// launch; else of the mean over the meshes. `None` with fewer than two launches, three samples or six meshes.
    pub interval: Option<[f64; 2]>,
    /// The least and the largest ratio on a mesh, if there are several meshes.
    pub range: Option<[f64; 2]>,
    /// The number of meshes.
    pub meshes: usize,
}

impl Quotient {
    /// Returns the ends that a mean over meshes is shown with: of its interval, or of its range if the meshes are too few
    /// for an interval.
    pub fn ends(&self) -> Option<[f64; 2]> {
        self.interval.or(self.range)
    }

    /// Returns how the first of two times compares with the second one: slower, equal up to 5 %, or undecided. It is
    /// undecided if the interval contains 1, or, if the meshes are too few for an interval, if it is at most 5 % longer on one
    /// of them. `None` without an interval and a range.
    pub fn standing(&self) -> Option<Standing> {
        let [_, most] = self.ends()?;
        let is_open = match (self.interval, self.range) {
            (Some([low, _]), _) => low <= 1.0,
            (None, range) => range?[0] <= EQUAL_UP_TO,
        };
        Some(match () {
            () if most <= EQUAL_UP_TO => Standing::Equal,
            () if is_open || self.ratio <= EQUAL_UP_TO => Standing::Undecided,
            () => Standing::Slower,
        })
    }
}

/// Returns the least and the largest of the values of several meshes; `None` for one mesh.
pub(crate) fn range(values: impl Iterator<Item = f64> + Clone) -> Option<[f64; 2]> {
    let several = values.clone().nth(1).is_some();
    several.then(|| {
        values.fold([f64::INFINITY, 0.0], |[least, most], value| {
            [value.min(least), value.max(most)]
        })
    })
}

impl Report {
    /// Returns the time of `backend` divided by the time of `other`, as the quotient of the shown times per
    /// element. `None` if one of the times was not measured, or if one of the backends did other work.
    pub fn quotient(&self, operation: &str, backend: &str, other: &str) -> Option<Quotient> {
        let [own, other] = [backend, other].map(|name| measured(self, operation, name));
        self.quotient_of_rows(own?, other?)
    }

    /// Returns the quotient of the times of two measured rows, which may be of two methods of one task.
    pub(crate) fn quotient_of_rows(&self, own: &ResultRow, other: &ResultRow) -> Option<Quotient> {
        let (ns, other_ns) = (own.ns_per_element?, other.ns_per_element?);
        let samples = |row: &ResultRow| {
            let mut samples = self.samples.iter();
            samples.find(|s| !s.control && s.backend == row.backend && s.operation == row.operation)
        };
        let found = match own.launch_ns.is_empty() {
            true => samples(own)
                .zip(samples(other))
                .and_then(|(own, other)| ratio(&counted(own), &counted(other))),
            false => own.median_ns.zip(other.median_ns).and_then(|times| {
                ratio_over_launches(times.into(), [&own.launch_ns, &other.launch_ns])
            }),
        };
        let confidence = self.run.settings.confidence;
        Some(Quotient {
            ratio: shown_ratio(ns, other_ns),
            interval: found.and_then(|found| found.moved_to(ns / other_ns).interval(confidence)),
            range: None,
            meshes: 1,
        })
    }
}

/// Returns the row of a measured time that can be compared with others.
fn measured<'r>(report: &'r Report, operation: &str, backend: &str) -> Option<&'r ResultRow> {
    let row = report.row(operation, backend)?;
    let same_work = !matches!(row.agreement, Agreement::Mismatch | Agreement::OtherEdits);
    (row.median_ns.is_some() && same_work).then_some(row)
}

/// Returns the samples that count, with their rounds.
fn counted(samples: &Samples) -> Vec<(u32, Time)> {
    let times = samples.cpu_ns.as_ref().unwrap_or(&samples.wall_ns);
    let time = |(&round, &ns): (&u32, &f64)| {
        let time = Time {
            cpu_ns: Some(ns),
            wall_ns: ns,
            faults: None,
        };
        (round, time)
    };
    let all: Vec<(u32, Time)> = samples.rounds.iter().zip(times).map(time).collect();
    undisturbed(&all, &samples.slowdowns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pool::mean_quotients;
    use crate::rows::Standing;

    const BOUNDARY: &str = "boundary";

    fn row(backend: &str, ratio: f64, standing: Standing) -> ResultRow {
        ResultRow {
            median_ns: Some(100.0 * ratio),
            elements: Some(1),
            ns_per_element: Some(100.0 * ratio),
            agreement: Agreement::Same,
            standing: Some(standing),
            ratio_to_best: Some(ratio),
            samples: 9,
            ..ResultRow::new(backend, BOUNDARY, "edge")
        }
    }

    fn samples(backend: &str, times: &[f64]) -> Samples {
        Samples {
            backend: backend.into(),
            operation: BOUNDARY.into(),
            rounds: (0..).take(times.len()).collect(),
            cpu_ns: Some(times.to_vec()),
            wall_ns: times.to_vec(),
            ..Samples::default()
        }
    }

    fn report(slow: f64) -> Report {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let times = |factor: f64| drift.map(|t| 100.0 * factor * t);
        Report {
            results: vec![
                row("half-edge", 1.0, Standing::Best),
                row("corner-table", slow, Standing::Slower),
            ],
            samples: vec![
                samples(
                    "face-vertex",
                    &[500.0, 700.0, 400.0, 900.0, 300.0, 800.0, 600.0],
                ),
                samples("half-edge", &times(1.0)),
                samples("corner-table", &times(slow)),
            ],
            ..Report::default()
        }
    }

    /// The drift of the machine is in both times of a round, so the interval is narrow.
    #[test]
    fn every_backend_can_be_the_baseline() {
        let report = report(1.5);
        let there = report
            .quotient(BOUNDARY, "corner-table", "half-edge")
            .expect("both measured");
        let back = report
            .quotient(BOUNDARY, "half-edge", "corner-table")
            .expect("both measured");
        assert!((there.ratio - 1.5).abs() < 1e-9, "{there:?}");
        assert!((back.ratio * there.ratio - 1.0).abs() < 1e-9, "{back:?}");
        for Quotient {
            ratio, interval, ..
        } in [there, back]
        {
            let [low, high] = interval.expect("seven rounds");
            assert!(
                low < ratio && ratio < high && high / low < 1.1,
                "{low} to {high}"
            );
        }
        assert_eq!(report.quotient(BOUNDARY, "half-edge", "gone"), None);
    }

    /// The samples have another ratio than the launches, and more variation.
    #[test]
    fn intervals_come_from_the_launches_if_there_are_several() {
        let mut report = report(1.5);
        for row in &mut report.results {
            let factor = row.median_ns.expect("measured");
            row.launch_ns = [1.0, 3.0, 2.0].map(|speed| Some(speed * factor)).into();
        }
        let quotient = report.quotient(BOUNDARY, "corner-table", "half-edge");
        let quotient = quotient.expect("both measured");
        let [low, high] = quotient.interval.expect("three launches");
        assert!(high / low < 1.0 + 1e-9, "no variation: {low} to {high}");
        report.results[0].launch_ns[1..].fill(None);
        let quotient = report.quotient(BOUNDARY, "corner-table", "half-edge");
        assert_eq!(quotient.expect("both measured").interval, None);
    }

    #[test]
    fn other_work_has_no_quotient_and_few_samples_no_interval() {
        let mut few = report(1.5);
        for samples in &mut few.samples {
            samples.rounds.truncate(2);
        }
        let quotient = few.quotient(BOUNDARY, "corner-table", "half-edge");
        assert_eq!(quotient.expect("both measured").interval, None);
        few.results[1].agreement = Agreement::Mismatch;
        assert_eq!(few.quotient(BOUNDARY, "corner-table", "half-edge"), None);
    }

    #[test]
    fn a_mean_is_over_the_meshes_that_have_both_times() {
        let mut reports = [2.0, 8.0, 4.0, 4.0, 4.0, 4.0].map(report);
        let mean = |reports: &[Report; 6]| {
            let studies: Vec<&Report> = reports.iter().collect();
            let names = ["corner-table", "half-edge"].map(str::to_owned);
            mean_quotients(&studies, BOUNDARY, &names)[0][1]
        };
        let all = mean(&reports).expect("measured");
        assert!((all.ratio - 4.0).abs() < 1e-9 && all.meshes == 6, "{all:?}");
        assert_eq!(all.ends(), all.interval);
        assert!(
            all.interval
                .is_some_and(|[low, high]| low > 2.0 && high < 8.0)
        );
        reports[1].results[1].median_ns = None;
        let five = mean(&reports).expect("measured");
        // 2 · 2^0.8 with three digits, as the times are shown.
        assert!((five.ratio - 3.48).abs() < 1e-9, "{five:?}");
        assert_eq!((five.meshes, five.interval), (5, None));
        assert_eq!(five.ends(), Some([2.0, 4.0]));
    }

    #[test]
    fn a_mean_is_undecided_if_times_are_equal_on_a_mesh_or_the_interval_contains_1() {
        let mean = |ratios: &[f64]| {
            let reports: Vec<Report> = ratios.iter().copied().map(report).collect();
            let studies: Vec<&Report> = reports.iter().collect();
            let names = ["corner-table", "half-edge"].map(str::to_owned);
            let mean = mean_quotients(&studies, BOUNDARY, &names)[0][1].expect("measured");
            mean.standing()
        };
        let [slower, undecided, equal] =
            [Standing::Slower, Standing::Undecided, Standing::Equal].map(Some);
        // A mean over one mesh has the interval of its samples.
        assert_eq!(mean(&[3.0]), slower);
        assert_eq!(mean(&[3.0, 1.2]), slower);
        assert_eq!(mean(&[3.0, 1.05]), undecided);
        assert_eq!(mean(&[3.0, 0.9]), undecided);
        assert_eq!(mean(&[1.02, 1.05]), equal);
        // On one of many meshes, the other may be faster.
        assert_eq!(mean(&[2.0, 2.0, 2.1, 1.9, 2.0, 2.0, 0.9]), slower);
        assert_eq!(mean(&[2.0, 0.5, 2.0, 0.5, 2.0, 0.9]), undecided);
        assert_eq!(mean(&[1.04, 1.03, 1.03, 1.03, 1.03, 1.03]), equal);
        assert_eq!(mean(&[1.08, 1.03, 1.03, 1.03, 1.03, 1.06]), undecided);
    }

    /// The meshes agree, but the launches on each do not.
    #[test]
    fn a_mean_over_meshes_is_no_surer_than_the_times_on_the_meshes() {
        let launches = [[1.0, 1.0, 1.0], [1.0, 1.4, 0.8]];
        let with_launches = |slow: f64| {
            let mut report = report(slow);
            for (row, launches) in report.results.iter_mut().zip(launches) {
                let ns = row.median_ns.expect("measured");
                row.launch_ns = launches.map(|factor| Some(ns * factor)).into();
            }
            report
        };
        let half_width = |slow: [f64; 6]| {
            let reports = slow.map(with_launches);
            let studies: Vec<&Report> = reports.iter().collect();
            let names = ["corner-table", "half-edge"].map(str::to_owned);
            let mean = mean_quotients(&studies, BOUNDARY, &names)[0][1].expect("measured");
            let [low, high] = mean.interval.expect("six meshes");
            (high / low).ln() / 2.0
        };
        let on_mesh = with_launches(2.0).quotient(BOUNDARY, "corner-table", "half-edge");
        let [low, high] = on_mesh.and_then(|on| on.interval).expect("three launches");
        let expected = (high / low).ln() / 2.0 / 6_f64.sqrt();
        assert!((half_width([2.0; 6]) / expected - 1.0).abs() < 1e-9);
        // Meshes that differ have a wider interval.
        assert!(half_width([2.0, 20.0, 0.2, 2.0, 20.0, 0.2]) > 2.0 * expected);
    }
}
