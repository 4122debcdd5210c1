//! The times that means are made of: of each task on each mesh, for all compared backends.

use std::cmp::Ordering;
use std::collections::HashMap;

use super::means::{confidence, half_width, mean_over_sizes, with_errors};
use super::{common, decade};
use crate::findings::pick::EQUAL_UP_TO;
use crate::findings::study::Report;
use crate::numbers::shown_ratio;
use crate::quotient::{Quotient, range};
use crate::rows::{Agreement, ResultRow, Standing};
use crate::statistics::geometric_mean;

/// A time in nanoseconds.
#[derive(Clone, Copy)]
pub(super) struct Known<'s> {
    pub(super) row: &'s ResultRow,
    pub(super) ns: f64,
    /// The time per element.
    pub(super) each: f64,
    /// Whether the time is an estimate: a lower bound.
    pub(super) bound: bool,
    /// The half-width of the interval of the logarithm of the ratio to the fastest backend; `None` without
    /// an interval.
    log_error: Option<f64>,
}

impl<'s> Known<'s> {
    /// Returns the time of a row: measured, or estimated. Returns `None` for other work.
    fn of(row: &'s ResultRow) -> Option<Self> {
        let ns = row.median_ns.or(row.estimated_ns)?;
        let bound = row.median_ns.is_none();
        let same_work = !matches!(row.agreement, Agreement::Mismatch | Agreement::OtherEdits);
        let interval = row.ratio_ci_low.zip(row.ratio_ci_high);
        let log_error = match interval {
            _ if bound || row.ratio_to_best == Some(1.0) => Some(0.0),
            Some((low, high)) => half_width(low, high),
            None => None,
        };
        let each = ns / row.elements.unwrap_or(1).max(1) as f64;
        (ns > 0.0 && same_work).then_some(Self {
            row,
            ns,
            each,
            bound,
            log_error,
        })
    }

    /// Orders measured times before estimates, because the real time may be longer than an estimate.
    fn measured_first(&self, other: &Self) -> Ordering {
        let by_time = self.ns.total_cmp(&other.ns);
        self.bound.cmp(&other.bound).then(by_time)
    }

    /// Returns the time of a task, which each of `rows` does by another method.
    fn of_task(rows: impl Iterator<Item = &'s ResultRow>) -> Option<Self> {
        let methods: Vec<Self> = rows.filter_map(Self::of).collect();
        let fastest = methods.iter().min_by(|a, b| a.measured_first(b))?;
        // Another method, of which only a lower bound is known, may be faster.
        let faster = methods
            .iter()
            .filter(|own| own.bound && own.ns < fastest.ns);
        let least = faster.min_by(|a, b| a.ns.total_cmp(&b.ns));
        least.or(Some(fastest)).copied()
    }
}

/// The rows of several studies, by study, operation and backend.
pub(super) struct Rows<'s>(Vec<HashMap<(&'s str, &'s str), &'s ResultRow>>);

impl<'s> Rows<'s> {
    /// Returns the rows of the operations that are wanted.
    pub(super) fn new(studies: &[&'s Report], is_wanted: impl Fn(&str) -> bool) -> Self {
        let of = |study: &&'s Report| {
            let rows = study.results.iter();
            let rows = rows.filter(|row| is_wanted(&row.operation));
            rows.map(|row| ((row.operation.as_str(), row.backend.as_str()), row))
                .collect()
        };
        Self(studies.iter().map(of).collect())
    }
}

/// One task on one mesh.
pub(super) struct Case<'s> {
    pub(super) mesh: usize,
    /// The number of the task.
    task: usize,
    /// The time of each compared backend.
    pub(super) times: Vec<Known<'s>>,
    /// The shortest measured time. A lower bound cannot be the shortest time.
    pub(super) least: Known<'s>,
}

impl<'s> Case<'s> {
    /// Returns `None` if no time is measured.
    fn new([mesh, task]: [usize; 2], times: Vec<Known<'s>>) -> Option<Self> {
        let measured = times.iter().filter(|time| !time.bound);
        let least = *measured.min_by(|a, b| a.ns.total_cmp(&b.ns))?;
        Some(Self {
            mesh,
            task,
            times,
            least,
        })
    }

    /// Returns whether the shortest time is known: no lower bound is below the shortest measured time.
    fn is_decided(&self) -> bool {
        let mut bounds = self.times.iter().filter(|time| time.bound);
        bounds.all(|bound| bound.ns >= self.least.ns)
    }
}

/// Tasks on meshes, and the backends that are compared: all have a time in each case.
pub(super) struct Cases<'a, 's> {
    studies: &'a [&'s Report],
    pub(super) backends: Vec<&'a str>,
    pub(super) cases: Vec<Case<'s>>,
    /// Whether all cases are of one task, so that means are times per element and not ratios.
    is_single: bool,
}

impl<'a, 's> Cases<'a, 's> {
    /// Returns the cases of `tasks`, the names of the operations that do the same work, in which all `backends` with any
    /// time have one. If they have no case in common, those with the fewest times are left out.
    pub(super) fn new(
        studies: &'a [&'s Report],
        rows: &Rows<'s>,
        backends: &[&'a str],
        tasks: &[Vec<&str>],
    ) -> Self {
        let on_mesh = |mesh: usize| (0..tasks.len()).map(move |task| [mesh, task]);
        let all: Vec<[usize; 2]> = (0..studies.len()).flat_map(on_mesh).collect();
        let time = |case: usize, backend: &str| {
            let [mesh, task] = all[case];
            let row = |operation: &&str| rows.0[mesh].get(&(*operation, backend)).copied();
            Known::of_task(tasks[task].iter().filter_map(row))
        };
        let has = |case: usize, backend: &str| time(case, backend).is_some();
        let some = |backend: &&&str| (0..all.len()).any(|case| has(case, backend));
        let backends: Vec<&str> = backends.iter().filter(some).copied().collect();
        let (backends, shared) = common(&backends, all.len(), has);
        let cases = shared.into_iter().filter_map(|case| {
            let times = backends.iter().map(|backend| time(case, backend));
            Case::new(all[case], times.collect::<Option<_>>()?)
        });
        let mut cases: Vec<Case<'s>> = cases.collect();
        // A mean with a case that is not decided would favour the backends that were measured. If no case is decided,
        // they stay, and the answer names what is not ranked.
        if cases.iter().any(Case::is_decided) {
            cases.retain(Case::is_decided);
        }
        let mut pairs = cases.windows(2);
        let is_single = pairs.all(|pair| pair[0].task == pair[1].task);
        Self {
            studies,
            backends,
            cases,
            is_single,
        }
    }

    /// Returns the meshes with at least one case.
    pub(super) fn meshes(&self) -> impl Iterator<Item = usize> {
        let by_mesh = self.cases.chunk_by(|a, b| a.mesh == b.mesh);
        by_mesh.map(|cases| cases[0].mesh)
    }

    /// Returns the place of the backend with the smallest mean; `None` if all have a lower bound.
    pub(super) fn first(&self) -> Option<usize> {
        let measured = (0..self.backends.len()).filter(|&place| !self.has_bound(place));
        let means = measured.filter_map(|place| Some((place, self.mean(place)?)));
        let first = means.min_by(|(_, a), (_, b)| a.total_cmp(b));
        first.map(|(place, _)| place)
    }

    /// Returns whether a time of the backend at `place` is a lower bound.
    pub(super) fn has_bound(&self, place: usize) -> bool {
        self.times(place).any(|time| time.bound)
    }

    /// Returns the times of the backend at `place`.
    pub(super) fn times(&self, place: usize) -> impl Iterator<Item = &Known<'s>> {
        self.cases.iter().map(move |case| &case.times[place])
    }

    /// Returns the means of `value` on each mesh, with the size of the mesh. `value` gets a case, and returns one of its
    /// times.
    fn means(&self, value: impl Fn(&Case<'s>) -> Known<'s>) -> Vec<(u32, f64)> {
        let by_mesh = self.cases.chunk_by(|a, b| a.mesh == b.mesh);
        let means = by_mesh.filter_map(|cases| {
            let part = |case: &Case<'s>| match self.is_single {
                true => value(case).each,
                // The times of each mesh are shown. A reader who divides two of them gets the ratio.
                false => shown_ratio(value(case).each, case.least.each),
            };
            let parts: Vec<f64> = cases.iter().map(part).collect();
            let (mean, _) = geometric_mean(&parts, confidence(self.studies))?;
            Some((decade(self.studies[cases[0].mesh]), mean))
        });
        means.collect()
    }

    /// Returns the mean of the backend at `place`: of its times per element if all cases are of one task, else of the
    /// ratios to the shortest time of each case.
    pub(super) fn mean(&self, place: usize) -> Option<f64> {
        let means = self.means(|case| case.times[place]);
        Some(mean_over_sizes(&means, confidence(self.studies))?.0)
    }

    /// Returns the mean that the others are divided by: of the first backend, or, if all have a lower bound, of the shortest
    /// times.
    pub(super) fn base(&self) -> Option<f64> {
        match self.first() {
            Some(first) => self.mean(first),
            None => {
                let means = self.means(|case| case.least);
                Some(mean_over_sizes(&means, confidence(self.studies))?.0)
            }
        }
    }

    /// Returns the half-width of the interval of the logarithm of the mean of the backend at `place`, from the intervals
    /// of the single times. The errors of different operations and meshes are independent.
    pub(super) fn log_error(&self, place: usize) -> f64 {
        // Without an interval, a difference on one mesh is clear from a ratio of 2.
        let unknown = match self.studies {
            [_] => 2_f64.ln(),
            _ => 0.0,
        };
        let errors = self.times(place).map(|t| t.log_error.unwrap_or(unknown));
        let squares: f64 = errors.map(|error| error.powi(2)).sum();
        squares.sqrt() / self.cases.len().max(1) as f64
    }

    /// Returns the quotient of the means of two backends.
    pub(super) fn quotient(&self, own: usize, other: usize) -> Quotient {
        // As the same times are compared in the table of all operations.
        if self.is_single
            && let Some(quotient) = self.quotient_of_times(own, other)
        {
            return quotient;
        }
        let [owns, others] = [own, other].map(|place| self.means(|case| case.times[place]));
        let both = owns.into_iter().zip(others);
        let quotient = |own: f64, other: f64| match self.is_single {
            true => shown_ratio(own, other),
            false => own / other,
        };
        let on_meshes = both.map(|((size, own), (_, other))| (size, quotient(own, other)));
        let on_meshes: Vec<(u32, f64)> = on_meshes.collect();
        let confidence = confidence(self.studies);
        let means = self.mean(own).zip(self.mean(other));
        let ratio = means.map(|(own, other)| quotient(own, other));
        let interval = match self.studies {
            [study] => self.interval_on_mesh(study, own, other),
            _ => mean_over_sizes(&on_meshes, confidence).and_then(|(mean, ends)| {
                let error = self.log_error(own).hypot(self.log_error(other));
                with_errors(ends, mean, [Some(error)].into_iter())
            }),
        };
        Quotient {
            ratio: ratio.unwrap_or(f64::NAN),
            interval,
            range: range(on_meshes.iter().map(|(_, ratio)| *ratio)),
            meshes: on_meshes.len(),
        }
    }

    /// Returns the quotient of the mean times of two backends, on the meshes on which both were measured; for cases of one
    /// task. A reader who divides the means of the times gets the ratio.
    pub(super) fn quotient_of_times(&self, own: usize, other: usize) -> Option<Quotient> {
        let confidence = confidence(self.studies);
        let measured = self.cases.iter().filter_map(|case| {
            let times = [own, other].map(|place| case.times[place]);
            let study = self.studies[case.mesh];
            let quotient = study.quotient_of_rows(times[0].row, times[1].row)?;
            let is_known = quotient.ratio.is_finite();
            is_known.then_some((decade(study), quotient, times))
        });
        let measured: Vec<(u32, Quotient, [Known<'s>; 2])> = measured.collect();
        let mean_time = |place: usize| {
            let times = measured.iter().map(|mesh| (mesh.0, mesh.2[place].each));
            Some(mean_over_sizes(&times.collect::<Vec<_>>(), confidence)?.0)
        };
        let ratios = measured.iter().map(|mesh| (mesh.0, mesh.1.ratio));
        let (mean_ratio, interval) = mean_over_sizes(&ratios.collect::<Vec<_>>(), confidence)?;
        let half_widths = measured.iter().map(|(_, quotient, _)| {
            let [low, high] = quotient.interval?;
            half_width(low, high)
        });
        let interval = match &measured[..] {
            [(_, quotient, [own, other])] => interval_of_rows(quotient, own.row, other.row),
            _ => with_errors(interval, mean_ratio, half_widths),
        };
        let ratio = shown_ratio(mean_time(0)?, mean_time(1)?);
        let ratios = measured.iter().map(|(_, quotient, _)| quotient.ratio);
        Some(Quotient {
            ratio,
            interval: interval.map(|ends| ends.map(|end| end * ratio / mean_ratio)),
            // The mean of rounded ratios is not exactly the quotient of the means.
            range: range(ratios).map(|[least, most]| [least.min(ratio), most.max(ratio)]),
            meshes: measured.len(),
        })
    }

    /// Returns the interval of the quotient of two means on one mesh, from those of the quotients of the times, whose
    /// errors are independent.
    fn interval_on_mesh(&self, study: &Report, own: usize, other: usize) -> Option<[f64; 2]> {
        let (mut log, mut squares) = (0.0, 0.0);
        for case in &self.cases {
            let (own, other) = (case.times[own].row, case.times[other].row);
            let quotient = study.quotient_of_rows(own, other)?;
            let [low, high] = interval_of_rows(&quotient, own, other)?;
            log += (low * high).sqrt().ln();
            squares += half_width(low, high)?.powi(2);
        }
        let count = self.cases.len() as f64;
        let (centre, error) = ((log / count).exp(), squares.sqrt() / count);
        Some([centre * (-error).exp(), centre * error.exp()])
    }

    /// Returns whether the first of two backends is slower by a clear difference.
    pub(super) fn is_slower(&self, own: usize, other: usize) -> bool {
        let quotient = self.quotient(own, other);
        match quotient.standing() {
            Some(standing) => standing == Standing::Slower,
            None => {
                let error = self.log_error(own).hypot(self.log_error(other));
                quotient.ratio > error.exp().max(EQUAL_UP_TO)
            }
        }
    }
}

/// Returns the interval of the quotient of two rows of one study. Two methods of a subdivision scheme may have no launch in
/// common; then it is from the intervals of the two times.
fn interval_of_rows(quotient: &Quotient, own: &ResultRow, other: &ResultRow) -> Option<[f64; 2]> {
    let apart = |row: &ResultRow| half_width(row.ci_low_ns?, row.ci_high_ns?);
    quotient.interval.or_else(|| {
        let factor = apart(own)?.hypot(apart(other)?).exp();
        Some([quotient.ratio / factor, quotient.ratio * factor])
    })
}
