//! The means over meshes: of each operation, and of each kind of work.

use std::collections::BTreeMap;

use super::cases::{Cases, Rows};
use super::{Overall, Pooled, leaders, not_ranked};
use crate::confidence::Confidence;
use crate::findings::study::Report;
use crate::operation::{OperationInfo, Purpose};
use crate::quotient::Quotient;
use crate::rows::Standing;
use crate::statistics::geometric_mean;

/// Pools each operation over the meshes on which all its backends have a time.
pub(super) fn pooled(studies: &[&Report], backends: &[&str]) -> Vec<Pooled> {
    let rows = Rows::new(studies, |_| true);
    let of_operation = |info: &OperationInfo| {
        let cases = Cases::new(studies, &rows, backends, &[vec![&info.name]]);
        let first = cases.first();
        let places = 0..cases.backends.len();
        let pooled = places.filter_map(|place| pool(&cases, place, first, &info.name));
        pooled.collect::<Vec<_>>()
    };
    operations(studies)
        .into_iter()
        .flat_map(of_operation)
        .collect()
}

/// Pools one operation on the backend at `place`; `first` is the place of the fastest on average.
fn pool(
    cases: &Cases<'_, '_>,
    place: usize,
    first: Option<usize>,
    operation: &str,
) -> Option<Pooled> {
    let ns = cases.mean(place)?;
    let to_first = first.filter(|&first| first != place && !cases.has_bound(place));
    let to_first = to_first.and_then(|first| cases.quotient_of_times(place, first));
    let ratio_to_best = match to_first {
        Some(quotient) => quotient.ratio,
        None => ns / cases.base()?,
    };
    let interval = to_first.and_then(|quotient| quotient.interval);
    let range = to_first.and_then(|quotient| quotient.range);
    let standing = |wanted: &[Standing]| {
        let standings = cases.times(place).filter_map(|time| time.row.standing);
        standings.filter(|own| wanted.contains(own)).count()
    };
    Some(Pooled {
        backend: cases.backends[place].to_owned(),
        operation: operation.to_owned(),
        meshes: cases.cases.len(),
        best: standing(&[Standing::Best, Standing::Alone]),
        tied: standing(&[Standing::Equal, Standing::Undecided]),
        estimated: cases.times(place).filter(|time| time.bound).count(),
        ratio_to_best,
        ci_low: interval.map(|[low, _]| low),
        ci_high: interval.map(|[_, high]| high),
        range,
        ns_per_element: Some(ns),
    })
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

/// Returns, for each backend and each other backend, the quotient of their mean times of an operation over the meshes on
/// which [`Pool`](super::Pool) pools it, and both were measured; `None` if there is no such mesh. Each power of ten of the
/// number of faces has the same weight.
pub fn mean_quotients(
    studies: &[&Report],
    operation: &str,
    backends: &[String],
) -> Vec<Vec<Option<Quotient>>> {
    let rows = Rows::new(studies, |name| name == operation);
    let names: Vec<&str> = backends.iter().map(String::as_str).collect();
    let cases = Cases::new(studies, &rows, &names, &[vec![operation]]);
    let place = |name: &String| cases.backends.iter().position(|own| own == name);
    let quotient = |own, other| cases.quotient_of_times(place(own)?, place(other)?);
    let row = |own| backends.iter().map(|other| quotient(own, other)).collect();
    backends.iter().map(row).collect()
}

/// Computes what [`overall`] returns, without the counts of meshes on which a backend is the fastest. Also
/// returns which meshes take part in the means of which purpose.
fn means(studies: &[&Report], backends: &[&str]) -> (Vec<Overall>, Vec<(Purpose, usize)>) {
    let (mut overall, mut parts) = (Vec::new(), Vec::new());
    let rows = Rows::new(studies, |_| true);
    for purpose in Purpose::ALL {
        let cases = Cases::new(studies, &rows, backends, &tasks(studies, purpose));
        overall.extend(means_of(studies, &cases, purpose));
        parts.extend(cases.meshes().map(|mesh| (purpose, mesh)));
    }
    (overall, parts)
}

/// Returns the means of the backends of `cases` from the fastest to the slowest; those with a lower bound come last.
fn means_of(studies: &[&Report], cases: &Cases<'_, '_>, purpose: Purpose) -> Vec<Overall> {
    let place_with_mean = |place: usize| Some((cases.has_bound(place), cases.mean(place)?, place));
    let mut order: Vec<(bool, f64, usize)> = (0..cases.backends.len())
        .filter_map(place_with_mean)
        .collect();
    order.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let measured: Vec<usize> = order.iter().filter(|row| !row.0).map(|row| row.2).collect();
    let base = cases.base().unwrap_or(1.0);
    let row = |(rank, &(bound, mean, place)): (usize, &(bool, f64, usize))| {
        let faster = measured.get(..rank).unwrap_or(&[]);
        let to_first = faster.first().filter(|_| !bound);
        let to_first = to_first.map(|&first| cases.quotient(place, first));
        // As the times of one operation are compared: on one mesh with the fastest, means over meshes with all.
        let others = match studies {
            [_] => &faster[..faster.len().min(1)],
            _ => faster,
        };
        let interval = to_first.and_then(|quotient| quotient.interval);
        Overall {
            purpose,
            backend: cases.backends[place].to_owned(),
            meshes: cases.meshes().count(),
            cases: cases.cases.len(),
            ratio_to_best: to_first.map_or(mean / base, |quotient| quotient.ratio),
            ci_low: interval.map(|[low, _]| low),
            ci_high: interval.map(|[_, high]| high),
            range: to_first.and_then(|quotient| quotient.range),
            bound,
            best: 0,
            tied: 0,
            undecided: 0,
            leads: !bound && !others.iter().any(|&other| cases.is_slower(place, other)),
        }
    };
    order.iter().enumerate().map(row).collect()
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
