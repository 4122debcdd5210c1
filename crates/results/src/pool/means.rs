//! The means over meshes: of each operation, and of each kind of work.

use std::collections::BTreeMap;

use super::cases::{Cases, Rows};
use super::{Overall, Pooled, decade, leaders, not_ranked};
use crate::confidence::Confidence;
use crate::findings::study::Report;
use crate::operation::{OperationInfo, Purpose};
use crate::rows::Standing;
use crate::statistics::geometric_mean;

/// Pools each operation over the meshes on which all its backends have a time.
pub(super) fn pooled(studies: &[&Report], backends: &[&str]) -> Vec<Pooled> {
    let rows = Rows::new(studies);
    let of_operation = |info: &OperationInfo| {
        let cases = Cases::new(studies, &rows, backends, &[vec![&info.name]]);
        let places = 0..cases.backends.len();
        let pooled = places.filter_map(|place| pool(studies, &cases, place, &info.name));
        pooled.collect::<Vec<_>>()
    };
    operations(studies)
        .into_iter()
        .flat_map(of_operation)
        .collect()
}

/// Pools one operation on the backend at `place`.
fn pool(
    studies: &[&Report],
    cases: &Cases<'_, '_>,
    place: usize,
    operation: &str,
) -> Option<Pooled> {
    let confidence = confidence(studies);
    let ratios = cases.cases.iter().map(|case| {
        let own = case.times[place];
        let shown = studies[case.mesh].shown_ratio(own.row);
        let ratio = shown.unwrap_or(own.ns / case.least.ns);
        (decade(studies[case.mesh]), ratio)
    });
    let ratios: Vec<(u32, f64)> = ratios.collect();
    let each = cases.cases.iter().filter_map(|case| {
        let own = case.times[place];
        own.row.elements?;
        Some((decade(studies[case.mesh]), own.each))
    });
    let each: Vec<(u32, f64)> = each.collect();
    let rows = || cases.times(place).map(|time| time.row);
    let standing = |wanted: &[Standing]| {
        let standings = rows().filter_map(|row| row.standing);
        standings.filter(|own| wanted.contains(own)).count()
    };
    let (ratio_to_best, interval) = mean_over_sizes(&ratios, confidence)?;
    let half_widths = rows().map(|row| half_width(row.ratio_ci_low?, row.ratio_ci_high?));
    let interval = with_errors(interval, ratio_to_best, half_widths);
    let interval = interval.map(|ends| above_best(ends, ratio_to_best));
    let estimated = cases.times(place).filter(|time| time.bound).count();
    let interval = interval.filter(|_| estimated == 0);
    Some(Pooled {
        backend: cases.backends[place].to_owned(),
        operation: operation.to_owned(),
        meshes: cases.cases.len(),
        best: standing(&[Standing::Best, Standing::Alone]),
        tied: standing(&[Standing::Equal, Standing::Undecided]),
        estimated,
        ratio_to_best,
        ci_low: interval.map(|[low, _]| low),
        ci_high: interval.map(|[_, high]| high),
        ns_per_element: mean_over_sizes(&each, confidence).map(|(mean, _)| mean),
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

/// Computes what [`overall`] returns, without the counts of meshes on which a backend is the fastest. Also
/// returns which meshes take part in the means of which purpose.
fn means(studies: &[&Report], backends: &[&str]) -> (Vec<Overall>, Vec<(Purpose, usize)>) {
    let (mut overall, mut parts) = (Vec::new(), Vec::new());
    let rows = Rows::new(studies);
    for purpose in Purpose::ALL {
        let cases = Cases::new(studies, &rows, backends, &tasks(studies, purpose));
        overall.extend(means_of(studies, &cases, purpose));
        parts.extend(cases.meshes().map(|mesh| (purpose, mesh)));
    }
    (overall, parts)
}

/// Returns the means of the backends of `cases` from the fastest to the slowest; those with a lower bound come last.
fn means_of(studies: &[&Report], cases: &Cases<'_, '_>, purpose: Purpose) -> Vec<Overall> {
    let mean = |place: usize| {
        let by_mesh = cases.by_mesh(place);
        let (mean, interval) = mean_over_sizes(&by_mesh, confidence(studies))?;
        let bound = cases.times(place).any(|time| time.bound);
        let interval = interval.filter(|_| !bound);
        let within = [Some(cases.log_error(place))].into_iter();
        let interval = with_errors(interval, mean, within);
        let interval = interval.map(|ends| above_best(ends, mean));
        let row = Overall {
            purpose,
            backend: cases.backends[place].to_owned(),
            meshes: by_mesh.len(),
            cases: cases.cases.len(),
            ratio_to_best: mean,
            ci_low: interval.map(|[low, _]| low),
            ci_high: interval.map(|[_, high]| high),
            bound,
            best: 0,
            tied: 0,
            undecided: 0,
            leads: false,
            to_first: None,
        };
        Some((place, row))
    };
    let mut rows: Vec<(usize, Overall)> = (0..cases.backends.len()).filter_map(mean).collect();
    rows.sort_by(|(_, a), (_, b)| {
        let by_ratio = a.ratio_to_best.total_cmp(&b.ratio_to_best);
        a.bound.cmp(&b.bound).then(by_ratio)
    });
    let measured = rows.iter().filter(|(_, row)| !row.bound);
    let places: Vec<usize> = measured.map(|(place, _)| *place).collect();
    for (rank, (own, row)) in rows.iter_mut().enumerate().take(places.len()) {
        let faster = &places[..rank];
        // As the times of one operation are compared: on one mesh with the fastest, means over meshes with all.
        let others = match studies {
            [_] => &faster[..rank.min(1)],
            _ => faster,
        };
        row.leads = !others.iter().any(|&other| cases.is_slower(*own, other));
        row.to_first = faster.first().map(|&first| cases.quotient(*own, first));
    }
    rows.into_iter().map(|(_, row)| row).collect()
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
