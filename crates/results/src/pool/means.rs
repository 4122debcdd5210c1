//! The means over meshes: of each operation, and of each kind of work.

use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};

use super::{Overall, Pooled, common, decade, leaders, not_ranked};
use crate::confidence::Confidence;
use crate::findings::pick::EQUAL_UP_TO;
use crate::findings::study::Report;
use crate::numbers::shown_ratio;
use crate::operation::{OperationInfo, Purpose};
use crate::quotient::{Quotient, range};
use crate::rows::{Agreement, ResultRow, Standing};
use crate::statistics::geometric_mean;

/// A time in nanoseconds.
#[derive(Clone, Copy)]
struct Known<'r> {
    row: &'r ResultRow,
    ns: f64,
    /// The time per element.
    each: f64,
    /// Whether the time is an estimate: a lower bound.
    bound: bool,
    /// The half-width of the interval of the logarithm of the ratio to the fastest backend; `None` without
    /// an interval.
    log_error: Option<f64>,
}

impl<'r> Known<'r> {
    /// Returns the time of a row: measured, or estimated. Returns `None` for other work.
    fn of(row: &'r ResultRow) -> Option<Self> {
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
}

/// The rows of several studies, by study, operation and backend.
struct Rows<'s>(Vec<HashMap<(&'s str, &'s str), &'s ResultRow>>);

impl<'s> Rows<'s> {
    fn new(studies: &[&'s Report]) -> Self {
        let of = |study: &&'s Report| {
            let rows = study.results.iter();
            rows.map(|row| ((row.operation.as_str(), row.backend.as_str()), row))
                .collect()
        };
        Self(studies.iter().map(of).collect())
    }

    fn get(&self, study: usize, operation: &str, backend: &str) -> Option<&'s ResultRow> {
        self.0[study].get(&(operation, backend)).copied()
    }
}

/// Pools each operation over the meshes on which all its backends have a time.
pub(super) fn pooled(studies: &[&Report], backends: &[&str]) -> Vec<Pooled> {
    let mut pooled = Vec::new();
    let (all_rows, confidence) = (Rows::new(studies), confidence(studies));
    for OperationInfo {
        name: operation, ..
    } in operations(studies)
    {
        let value = |mesh: usize, backend: &str| {
            let row = all_rows.get(mesh, operation, backend)?;
            Some((row, Known::of(row)?.ns))
        };
        let has = |mesh: usize, backend: &str| value(mesh, backend).is_some();
        let some = |backend: &&&str| (0..studies.len()).any(|mesh| has(mesh, backend));
        let backends: Vec<&str> = backends.iter().filter(some).copied().collect();
        let (compared, mut meshes) = common(&backends, studies.len(), has);
        let least = |mesh: usize| {
            let rows = compared.iter().filter_map(|b| Some(value(mesh, b)?.0));
            Some(least_measured(rows.filter_map(Known::of))?.ns)
        };
        meshes.retain(|&mesh| least(mesh).is_some());
        keep_decided(&mut meshes, |mesh| {
            let rows = compared.iter().filter_map(move |b| Some(value(mesh, b)?.0));
            rows.filter_map(Known::of)
        });
        for backend in &compared {
            let ratios: Vec<(u32, f64)> = meshes
                .iter()
                .filter_map(|&mesh| {
                    let (row, time) = value(mesh, backend)?;
                    let shown = studies[mesh].shown_ratio(row);
                    let ratio = shown.unwrap_or(time / least(mesh)?);
                    Some((decade(studies[mesh]), ratio))
                })
                .collect();
            let rows = || meshes.iter().filter_map(|&mesh| value(mesh, backend));
            let each = meshes.iter().filter_map(|&mesh| {
                let (row, time) = value(mesh, backend)?;
                Some((decade(studies[mesh]), time / row.elements? as f64))
            });
            let each: Vec<(u32, f64)> = each.collect();
            let standing = |wanted: &[Standing]| {
                let standings = rows().filter_map(|(row, _)| row.standing);
                standings
                    .filter(|standing| wanted.contains(standing))
                    .count()
            };
            let Some((ratio_to_best, interval)) = mean_over_sizes(&ratios, confidence) else {
                continue;
            };
            let half_widths =
                rows().map(|(row, _)| half_width(row.ratio_ci_low?, row.ratio_ci_high?));
            let interval = with_errors(interval, ratio_to_best, half_widths);
            let interval = interval.map(|ends| above_best(ends, ratio_to_best));
            let estimated = rows().filter(|(row, _)| row.median_ns.is_none()).count();
            let interval = interval.filter(|_| estimated == 0);
            pooled.push(Pooled {
                backend: (*backend).to_owned(),
                operation: operation.clone(),
                meshes: meshes.len(),
                best: standing(&[Standing::Best, Standing::Alone]),
                tied: standing(&[Standing::Equal, Standing::Undecided]),
                estimated,
                ratio_to_best,
                ci_low: interval.map(|[low, _]| low),
                ci_high: interval.map(|[_, high]| high),
                ns_per_element: mean_over_sizes(&each, confidence).map(|(mean, _)| mean),
            });
        }
    }
    pooled
}

/// Returns the smallest measured time. A lower bound cannot be the smallest time.
fn least_measured<'r>(times: impl Iterator<Item = Known<'r>>) -> Option<Known<'r>> {
    let measured = times.filter(|time| !time.bound);
    measured.min_by(|a, b| a.ns.total_cmp(&b.ns))
}

/// Removes the cases in which the shortest time is not known, because a lower bound is below the shortest
/// measured time: a mean with such a case would favour the structures that were measured. If this is so in all
/// cases, they stay, and the answer names what is not ranked.
fn keep_decided<'r, I: Iterator<Item = Known<'r>>>(
    cases: &mut Vec<usize>,
    times: impl Fn(usize) -> I,
) {
    let is_decided = |case: &usize| {
        let least = least_measured(times(*case));
        least.is_some_and(|least| times(*case).all(|time| !time.bound || time.ns >= least.ns))
    };
    if cases.iter().any(is_decided) {
        cases.retain(is_decided);
    }
}

/// Returns the operations that the studies can measure, in the order of their lists.
pub fn operations<'s>(studies: &[&'s Report]) -> Vec<&'s OperationInfo> {
    let mut all: Vec<&OperationInfo> = Vec::new();
    for info in studies.iter().flat_map(|study| &study.run.operations) {
        if all.iter().all(|known| known.name != info.name) {
            all.push(info);
        }
    }
    all
}

/// Returns the names of the operations that do the same work: all methods of a subdivision scheme, or one
/// operation.
fn tasks<'s>(studies: &[&'s Report], purpose: Purpose) -> Vec<Vec<&'s str>> {
    let mut tasks: Vec<(&OperationInfo, Vec<&str>)> = Vec::new();
    let all = operations(studies).into_iter();
    for info in all.filter(|info| info.group.purpose() == purpose) {
        let same = |(task, _): &&mut (&OperationInfo, Vec<&str>)| {
            info.scheme.is_some() && task.scheme == info.scheme
        };
        match tasks.iter_mut().find(same) {
            Some((_, names)) => names.push(&info.name),
            None => tasks.push((info, vec![&info.name])),
        }
    }
    tasks.into_iter().map(|(_, names)| names).collect()
}

/// Returns the mean time of each of `backends` over `studies` and the operations of each purpose. The
/// backends of a purpose are sorted from the fastest to the slowest; those with a lower bound come last.
pub fn overall(studies: &[&Report], backends: &[&str]) -> Vec<Overall> {
    let (mut rows, parts) = means(studies, backends);
    for (mesh, study) in studies.iter().enumerate() {
        let (own, _) = means(&[study], backends);
        for own in own.chunk_by(|a, b| a.purpose == b.purpose) {
            let purpose = own[0].purpose;
            if parts.contains(&(purpose, mesh)) {
                count_mesh(&mut rows, own, study.is_decided(purpose));
            }
        }
    }
    rows
}

/// Adds a mesh with the means `own` of one purpose to the counts of `rows`. `decided` tells whether the study
/// has enough samples.
fn count_mesh(rows: &mut [Overall], own: &[Overall], decided: bool) {
    let leaders = leaders(own);
    let decided = decided && !leaders.is_empty() && not_ranked(own).is_none();
    let alone = leaders.len() == 1;
    let same = |row: &&mut Overall| row.purpose == own[0].purpose;
    for row in rows.iter_mut().filter(same) {
        let leads = leaders.iter().any(|leader| leader.backend == row.backend);
        match (decided, leads) {
            (false, _) => row.undecided += 1,
            (true, true) if alone => row.best += 1,
            (true, true) => row.tied += 1,
            (true, false) => {}
        }
    }
}

/// Computes what [`overall`] returns, without the counts of meshes on which a backend is the fastest. Also
/// returns which meshes take part in the means of which purpose.
fn means(studies: &[&Report], backends: &[&str]) -> (Vec<Overall>, Vec<(Purpose, usize)>) {
    let mut overall = Vec::new();
    let mut parts = Vec::new();
    let (all_rows, confidence) = (Rows::new(studies), confidence(studies));
    for purpose in Purpose::ALL {
        let tasks = tasks(studies, purpose);
        // A case is a task on a mesh.
        let cases: Vec<(usize, &[&str])> = (0..studies.len())
            .flat_map(|mesh| tasks.iter().map(move |task| (mesh, task.as_slice())))
            .collect();
        let value = |case: usize, backend: &str| {
            let (mesh, task) = cases[case];
            let rows = task.iter().filter_map(|o| all_rows.get(mesh, o, backend));
            let rows: Vec<Known> = rows.filter_map(Known::of).collect();
            let fastest = rows.iter().min_by(|a, b| a.measured_first(b))?;
            // Another method, of which only a lower bound is known, may be faster.
            let faster = rows.iter().filter(|row| row.bound && row.ns < fastest.ns);
            let least = faster.min_by(|a, b| a.ns.total_cmp(&b.ns));
            least.or(Some(fastest)).copied()
        };
        let has = |case: usize, backend: &str| value(case, backend).is_some();
        let some = |backend: &&&str| (0..cases.len()).any(|case| has(case, backend));
        let backends: Vec<&str> = backends.iter().filter(some).copied().collect();
        let (compared, mut shared) = common(&backends, cases.len(), has);
        let least = |case: usize| least_measured(compared.iter().filter_map(|b| value(case, b)));
        shared.retain(|&case| least(case).is_some());
        keep_decided(&mut shared, |case| {
            compared.iter().filter_map(move |b| value(case, b))
        });
        let ratio = |case: usize, backend: &str| {
            let (own, least) = (value(case, backend)?, least(case)?);
            // The times of each mesh are shown. A reader who divides two of them gets the ratio.
            Some(shown_ratio(own.each, least.each))
        };
        let is_bound = |backend: &str| {
            let mut times = shared.iter().filter_map(|&case| value(case, backend));
            times.any(|time| time.bound)
        };
        // The errors of different operations and meshes are independent.
        let log_error = |backend: &str| {
            let known = shared.iter().filter_map(|&case| value(case, backend));
            // Without an interval, a difference on one mesh is clear from a ratio of 2.
            let unknown = if studies.len() == 1 { 2_f64.ln() } else { 0.0 };
            let errors = known.map(|known| known.log_error.unwrap_or(unknown));
            let squares: f64 = errors.map(|error| error.powi(2)).sum();
            squares.sqrt() / shared.len().max(1) as f64
        };
        // The interval of the quotient of two means on one mesh, from those of the quotients of the times, whose errors
        // are independent. Two methods of a subdivision scheme may have no launch in common.
        let interval_on_mesh = |study: &Report, own: &str, other: &str| -> Option<[f64; 2]> {
            let (mut log, mut squares) = (0.0, 0.0);
            for &case in &shared {
                let (own, other) = (value(case, own)?.row, value(case, other)?.row);
                let quotient = study.quotient_of_rows(own, other)?;
                let apart = |row: &ResultRow| half_width(row.ci_low_ns?, row.ci_high_ns?);
                let (centre, error) = match quotient.interval {
                    Some([low, high]) => (f64::sqrt(low * high), half_width(low, high)?),
                    None => (quotient.ratio, apart(own)?.hypot(apart(other)?)),
                };
                log += centre.ln();
                squares += error.powi(2);
            }
            let count = shared.len() as f64;
            let (centre, error) = ((log / count).exp(), squares.sqrt() / count);
            Some([centre * (-error).exp(), centre * error.exp()])
        };
        // The mean of the ratios on each mesh, with the size of the mesh.
        let by_mesh = |backend: &str| -> Vec<(u32, f64)> {
            let means = (0..studies.len()).filter_map(|mesh| {
                let own = shared.iter().filter(|&&case| cases[case].0 == mesh);
                let ratios: Vec<f64> = own.filter_map(|&case| ratio(case, backend)).collect();
                Some((
                    decade(studies[mesh]),
                    geometric_mean(&ratios, confidence)?.0,
                ))
            });
            means.collect()
        };
        let mut rows: Vec<Overall> = compared
            .iter()
            .filter_map(|backend| {
                let by_mesh = by_mesh(backend);
                let bound = is_bound(backend);
                mean_over_sizes(&by_mesh, confidence).map(|(mean, interval)| {
                    let interval = interval.filter(|_| !bound);
                    let within = [Some(log_error(backend))].into_iter();
                    let interval = with_errors(interval, mean, within);
                    let interval = interval.map(|ends| above_best(ends, mean));
                    Overall {
                        purpose,
                        backend: (*backend).to_owned(),
                        meshes: by_mesh.len(),
                        cases: shared.len(),
                        ratio_to_best: mean,
                        ci_low: interval.map(|[low, _]| low),
                        ci_high: interval.map(|[_, high]| high),
                        bound,
                        best: 0,
                        tied: 0,
                        undecided: 0,
                        log_error: log_error(backend),
                        leads: false,
                        to_first: None,
                        range_to_first: None,
                    }
                })
            })
            .collect();
        rows.sort_by(|a, b| {
            let by_ratio = a.ratio_to_best.total_cmp(&b.ratio_to_best);
            a.bound.cmp(&b.bound).then(by_ratio)
        });
        let quotient = |own: &Overall, other: &Overall| -> Quotient {
            let on_meshes = by_mesh(&own.backend)
                .into_iter()
                .zip(by_mesh(&other.backend));
            let on_meshes = on_meshes.map(|((size, own), (_, other))| (size, own / other));
            let on_meshes: Vec<(u32, f64)> = on_meshes.collect();
            let interval = match studies {
                [study] => interval_on_mesh(study, &own.backend, &other.backend),
                _ => mean_over_sizes(&on_meshes, confidence).and_then(|(mean, ends)| {
                    let error = own.log_error.hypot(other.log_error);
                    with_errors(ends, mean, [Some(error)].into_iter())
                }),
            };
            Quotient {
                ratio: own.ratio_to_best / other.ratio_to_best,
                interval,
                range: range(on_meshes.iter().map(|(_, ratio)| *ratio)),
                meshes: on_meshes.len(),
            }
        };
        let is_slower = |own: &Overall, other: &Overall| {
            let quotient = quotient(own, other);
            match quotient.standing() {
                Some(standing) => standing == Standing::Slower,
                None => {
                    let error = own.log_error.hypot(other.log_error);
                    quotient.ratio > error.exp().max(EQUAL_UP_TO)
                }
            }
        };
        let measured = rows.iter().take_while(|row| !row.bound).count();
        for place in 0..measured {
            let (faster, own) = (&rows[..place], &rows[place]);
            let ends = faster.first().map(|first| quotient(own, first));
            // As the times of one operation are compared: on one mesh with the fastest, means over meshes with all.
            let others = match studies {
                [_] => &faster[..faster.len().min(1)],
                _ => faster,
            };
            let leads = !others.iter().any(|other| is_slower(own, other));
            let row = &mut rows[place];
            row.leads = leads;
            row.to_first = ends.and_then(|ends| ends.interval);
            row.range_to_first = ends.and_then(|ends| ends.range);
        }
        overall.extend(rows);
        let mut meshes: Vec<usize> = shared.iter().map(|&case| cases[case].0).collect();
        meshes.dedup();
        parts.extend(meshes.into_iter().map(|mesh| (purpose, mesh)));
    }
    (overall, parts)
}

/// Returns the confidence of intervals over `studies`. Documents are merged only if all studies have the same.
pub(crate) fn confidence(studies: &[&Report]) -> Confidence {
    let first = studies.first();
    first.map_or_else(Confidence::default, |first| first.run.settings.confidence)
}

/// The interval of a mean over fewer meshes would say little: for three, Student's distribution gives 4.3 standard
/// errors.
pub const FEWEST_MESHES: usize = 6;

/// Returns the geometric mean in which each power of ten has equal weight, and the interval of the
/// mean over all values, moved to this mean; no interval with fewer than six values.
pub(crate) fn mean_over_sizes(
    values: &[(u32, f64)],
    confidence: Confidence,
) -> Option<(f64, Option<[f64; 2]>)> {
    let mut by_size: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
    for &(size, value) in values {
        by_size.entry(size).or_default().push(value);
    }
    let means: Vec<f64> = by_size
        .values()
        .filter_map(|values| Some(geometric_mean(values, confidence)?.0))
        .collect();
    let (mean, _) = geometric_mean(&means, confidence)?;
    let all: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
    let (centre, interval) = geometric_mean(&all, confidence)?;
    let interval = interval.filter(|_| all.len() >= FEWEST_MESHES);
    let interval = interval.map(|ends| ends.map(|end| end * mean / centre));
    Some((mean, interval))
}

/// Widens the interval of a mean over meshes if the errors of the single meshes give a wider one. The variation
/// from mesh to mesh includes these errors, but meshes may agree by chance. `half_widths` are those of the
/// intervals on the meshes, on the scale of logarithms.
pub(crate) fn with_errors(
    interval: Option<[f64; 2]>,
    mean: f64,
    half_widths: impl Iterator<Item = Option<f64>>,
) -> Option<[f64; 2]> {
    let [low, high] = interval?;
    let (squares, count) = half_widths.fold((0.0, 0.0), |(squares, count), half: Option<f64>| {
        (squares + half.unwrap_or(0.0).powi(2), count + 1.0)
    });
    let within = f64::sqrt(squares) / f64::max(count, 1.0);
    match half_width(low, high) {
        Some(between) if between < within => Some([mean * (-within).exp(), mean * within.exp()]),
        _ => Some([low, high]),
    }
}

/// Returns half the width of an interval on the scale of logarithms; `None` if it is not finite.
pub(crate) fn half_width(low: f64, high: f64) -> Option<f64> {
    let half = (high / low).ln() / 2.0;
    half.is_finite().then_some(half)
}

/// Moves the lower end of the interval of a mean ratio to 1 if it is below 1, because no backend is
/// faster than the best on average. The interval still contains `mean`.
fn above_best([low, high]: [f64; 2], mean: f64) -> [f64; 2] {
    [low.max(mean.min(1.0)), high]
}
