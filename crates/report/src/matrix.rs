//! All operations on all backends: what tables, rankings and heat maps show.

use sixfold_results::numbers::{duration, figure, rounded_down};
use sixfold_results::{
    Confidence, FEWEST_MESHES, FIRST_TIME_SHOWN, OperationGroup, OperationInfo, Overall, Pool,
    Pooled, Purpose, Quotient, RefusalKind, Report, ResultRow, Samples, Standing, mean_quotients,
    operations,
};

use crate::figure::Table;

/// How a figure was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// All elements were measured.
    Measured,
    /// Some elements were measured, and the time was scaled up.
    Sampled,
    /// A lower bound, because a run would exceed the budget.
    Bound,
    /// The backend cannot do the operation, or did other work than the others.
    Impossible,
    /// The operation was not run.
    NotRun,
}

/// One operation on one backend.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) backend: String,
    pub(crate) source: Source,
    /// The time divided by that of the fastest backend; a lower bound if `source` is a bound.
    pub(crate) ratio: Option<f64>,
    /// The interval of `ratio`, or its range over the meshes if they are too few for an interval; `None` for the fastest,
    /// whose ratio is 1 by definition.
    pub(crate) interval: Option<[f64; 2]>,
    /// Time per element in nanoseconds.
    pub(crate) ns: Option<f64>,
    /// The interval of `ns`.
    pub(crate) ns_interval: Option<[f64; 2]>,
    /// Time per element of the first run, on fresh pages, if it differs clearly from `ns`.
    pub(crate) first_ns: Option<f64>,
    pub(crate) standing: Option<Standing>,
    /// Number of samples; 0 for a mean over meshes.
    pub(crate) samples: usize,
    /// True if each sample is the first run of a launch.
    pub(crate) first_runs: bool,
    /// Why there is no figure, or a remark on the figure.
    pub(crate) remark: Option<String>,
    /// The ratio on each mesh, if `ratio` is a mean over meshes.
    pub(crate) each: Vec<f64>,
    /// The times per element of all samples in nanoseconds, by launch, of which some have none; empty for a mean over
    /// meshes.
    pub(crate) launches: Vec<Vec<f64>>,
    /// The quotients of this time and that of each backend of the matrix, in its order.
    pub(crate) quotients: Vec<Option<Quotient>>,
}

/// One operation on all backends.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    /// The name of the operation.
    pub(crate) name: String,
    /// What the operation does.
    pub(crate) about: String,
    /// The kind of work.
    pub(crate) group: OperationGroup,
    /// The element that times are divided by.
    pub(crate) unit: String,
    /// Whether there are too few samples to name the fastest: on a mesh, or, if a mean has an interval over the meshes, on
    /// all of them.
    pub(crate) provisional: bool,
    /// One cell for each backend of the matrix, in its order.
    pub(crate) cells: Vec<Cell>,
}

/// All operations on all backends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Matrix {
    pub(crate) backends: Vec<String>,
    pub(crate) lines: Vec<Line>,
    /// The confidence of all intervals.
    pub(crate) confidence: Confidence,
    /// The number of meshes.
    pub(crate) meshes: usize,
}

/// An interval whose ends differ by more than this factor says that nothing is known, and is not shown.
pub(crate) const WIDEST: f64 = 1000.0;

/// Returns the words for the two ends that stand below a ratio over `meshes` meshes, such as `its 95 % interval …`.
pub(crate) fn ends_of_ratios(meshes: usize, confidence: Confidence) -> String {
    match meshes {
        0 | 1 => format!(
            "its {confidence} interval if there are enough samples and its ends differ by less than {WIDEST} times"
        ),
        count if count < FEWEST_MESHES => "the least and the largest on a mesh".into(),
        _ => format!(
            "the {confidence} interval of other meshes like these (with times on fewer than {FEWEST_MESHES}: the least and \
             the largest)"
        ),
    }
}

impl Cell {
    pub(crate) fn new(backend: &str, source: Source) -> Self {
        Self {
            backend: backend.to_owned(),
            source,
            ratio: None,
            interval: None,
            ns: None,
            ns_interval: None,
            first_ns: None,
            standing: None,
            samples: 0,
            first_runs: false,
            remark: None,
            each: Vec::new(),
            launches: Vec::new(),
            quotients: Vec::new(),
        }
    }

    pub(crate) fn is_bound(&self) -> bool {
        self.source == Source::Bound
    }

    /// Returns the ratio as text: `1.31`, `≥ 341` or `–`.
    pub(crate) fn ratio_text(&self) -> String {
        match self.ratio {
            Some(ratio) if self.is_bound() => format!("≥ {}", figure(rounded_down(ratio))),
            Some(ratio) => figure(ratio),
            None => "–".into(),
        }
    }

    /// Returns the ratio with its signs: `1.31 ×`, `~ 1.31 ×` from a sample, `≥ 341 ×` or `–`.
    pub(crate) fn times_text(&self) -> String {
        match (self.ratio, self.source) {
            (None, _) => "–".into(),
            (Some(_), Source::Sampled) => format!("~ {} ×", self.ratio_text()),
            (Some(_), _) => format!("{} ×", self.ratio_text()),
        }
    }

    /// Returns the interval as text: `1.28 to 1.34`.
    pub(crate) fn interval_text(&self) -> Option<String> {
        let [low, high] = self.interval?.map(figure);
        // The fastest on every mesh has no interval.
        (low != high).then(|| format!("{low} to {high}"))
    }

    /// Returns the time as text: `5.56 ns`, `≥ 12.3 µs` or `–`.
    pub(crate) fn time_text(&self) -> String {
        match self.ns {
            Some(ns) if self.is_bound() => format!("≥ {}", duration(rounded_down(ns))),
            Some(ns) => duration(ns),
            None => "–".into(),
        }
    }

    pub(crate) fn is_best(&self) -> bool {
        matches!(self.standing, Some(Standing::Best | Standing::Alone))
    }

    /// Returns whether the backend shares the first place.
    pub(crate) fn shares_first(&self) -> bool {
        self.standing.is_some_and(Standing::shares_first)
    }

    /// Returns the remark for tables, such as `best`.
    pub(crate) fn note(&self) -> String {
        let mut notes = Vec::new();
        match self.standing {
            Some(Standing::Best) => notes.push("best"),
            Some(Standing::Equal) => notes.push("equal to the best"),
            Some(Standing::Undecided) => match self.interval {
                Some([low, _]) if low > 1.0 && self.samples > 0 => notes.push(
                    "undecided, perhaps the best: two measurements of one backend differ by as much",
                ),
                _ => notes.push("undecided, perhaps the best"),
            },
            _ => {}
        }
        match self.source {
            Source::Sampled => notes.push("from a sample of the elements"),
            Source::Bound => {
                notes.push("lower bound, not ranked: a full run would exceed the budget")
            }
            _ => {}
        }
        notes.extend(self.remark.as_deref());
        notes.join("; ")
    }

    fn of_study(study: &Report, operation: &str, backend: &str) -> Self {
        let Some(row) = study.row(operation, backend) else {
            let mut refusals = study.refusals.iter();
            let refusal = refusals.find(|r| r.operation == operation && r.backend == backend);
            let source = match refusal.map(|refusal| refusal.kind) {
                Some(RefusalKind::Impossible) => Source::Impossible,
                _ => Source::NotRun,
            };
            return Self {
                remark: refusal.map(|refusal| refusal.reason.clone()),
                ..Self::new(backend, source)
            };
        };
        match row.median_ns {
            Some(_) => Self::measured(study, row),
            None => Self::bound(study, row),
        }
    }

    fn measured(study: &Report, row: &ResultRow) -> Self {
        let each = |ns: f64| Some(ns / row.elements.filter(|&n| n > 0)? as f64);
        let ends = row.ci_low_ns.zip(row.ci_high_ns);
        let ratio = study.shown_ratio(row);
        Self {
            ratio,
            interval: (row.ratio_ci_low.zip(row.ratio_ci_high))
                .filter(|_| row.samples >= FEWEST_FOR_INTERVAL)
                .filter(|_| ratio.is_some_and(|ratio| ratio != 1.0))
                .map(Into::into)
                .filter(is_known),
            ns: row.ns_per_element,
            ns_interval: ends.and_then(|(low, high)| Some([each(low)?, each(high)?])),
            first_ns: first_time(row),
            standing: row.standing,
            samples: row.samples,
            first_runs: row.warm_up_only,
            launches: launches(study, row),
            remark: ratio
                .is_none()
                .then(|| "other work than the others, not compared".into()),
            ..Self::new(
                &row.backend,
                match row.sampled {
                    true => Source::Sampled,
                    false => Source::Measured,
                },
            )
        }
    }

    fn bound(study: &Report, row: &ResultRow) -> Self {
        let each = |row: &ResultRow, ns: f64| Some(ns / row.elements.filter(|&n| n > 0)? as f64);
        let ns = row.estimated_ns.and_then(|ns| each(row, ns));
        let mut rows = study.rows(&row.operation);
        let best = rows.find(|row| row.ratio_to_best == Some(1.0));
        let best = best.and_then(|best| best.ns_per_element);
        Self {
            ratio: ns.zip(best).map(|(ns, best)| ns / best),
            ns,
            ..Self::new(&row.backend, Source::Bound)
        }
    }

    /// Returns the cell of a mean over meshes. `each` has the ratio on each mesh.
    fn of_pool(row: &Pooled, each: Vec<f64>) -> Self {
        let source = match row.estimated {
            0 => Source::Measured,
            _ => Source::Bound,
        };
        let interval = row.ci_low.zip(row.ci_high).map(Into::into);
        Self {
            ratio: Some(row.ratio_to_best),
            interval: interval.or(row.range),
            each,
            ns: row.ns_per_element,
            remark: Some(format!(
                "mean over {} meshes: single fastest on {}, shared first place on {}, not run on {}",
                row.meshes, row.best, row.tied, row.estimated
            )),
            ..Self::new(&row.backend, source)
        }
    }
}

/// Returns whether the ends of an interval are near enough to each other to be shown.
pub(crate) fn is_known([low, high]: &[f64; 2]) -> bool {
    *high <= WIDEST * low
}

fn known(quotient: Quotient) -> Quotient {
    Quotient {
        interval: quotient.interval.filter(is_known),
        ..quotient
    }
}

/// Returns the times per element of the samples of a row by launch, also of those that other programs disturbed. A launch
/// that had only time for the first run has the time of this run.
fn launches(study: &Report, row: &ResultRow) -> Vec<Vec<f64>> {
    let Some(elements) = row.elements.filter(|&n| n > 0) else {
        return Vec::new();
    };
    let mut samples = study.samples.iter();
    let samples = samples.find(|samples| {
        !samples.control && samples.operation == row.operation && samples.backend == row.backend
    });
    let times = samples.map(|samples| samples.cpu_ns.as_ref().unwrap_or(&samples.wall_ns));
    let launch_of = |samples: &Samples, place| samples.launches.get(place).copied().unwrap_or(0);
    let of_launch = |launch: usize| {
        let all = samples.zip(times).into_iter().flat_map(|(samples, times)| {
            let times = times.iter().enumerate();
            times.filter(move |(place, _)| launch_of(samples, *place) as usize == launch)
        });
        let all: Vec<f64> = all.map(|(_, ns)| *ns).collect();
        match (all.is_empty(), row.launch_ns.get(launch)) {
            (true, Some(ns)) => ns.iter().copied().collect(),
            _ => all,
        }
    };
    let launches = (0..row.launch_ns.len().max(1)).map(of_launch);
    let each = |ns: f64| ns / elements as f64;
    launches
        .map(|launch| launch.into_iter().map(each).collect())
        .collect()
}

/// Fewer samples give no interval.
const FEWEST_FOR_INTERVAL: usize = 3;

/// Returns the time per element of a first run, if it differs from the time of later runs.
fn first_time(row: &ResultRow) -> Option<f64> {
    let ratio = row.first_ratio()?;
    let each = row.first_ns? / row.elements.filter(|&n| n > 0)? as f64;
    (ratio.max(ratio.recip()) > FIRST_TIME_SHOWN).then_some(each)
}

impl Matrix {
    /// Returns the operations of `study` for which at least one backend has a figure, on the backends
    /// that can hold the mesh.
    pub(crate) fn of_study(study: &Report) -> Self {
        let holding = study.backends.iter().filter(|backend| backend.holds);
        let mut backends: Vec<String> = holding.map(|backend| backend.name.clone()).collect();
        likely_first(&mut backends, &study.overall(), |name| name);
        let lines = by_group(&[study]).filter_map(|info| {
            let operation = info.name.as_str();
            let unit = study.rows(operation).next()?.per.clone();
            let cells = backends.iter().map(|name| Cell {
                quotients: backends
                    .iter()
                    .map(|other| study.quotient(operation, name, other))
                    .map(|quotient| quotient.map(known))
                    .collect(),
                ..Cell::of_study(study, operation, name)
            });
            let provisional = study.is_provisional(operation);
            Some(Line::new(info, unit, provisional, cells.collect()))
        });
        Self {
            lines: lines.collect(),
            backends,
            confidence: study.run.settings.confidence,
            meshes: 1,
        }
    }

    /// Returns the means over the meshes of `pool`, of which `studies` may have more.
    pub(crate) fn of_pool(pool: &Pool, studies: &[&Report]) -> Self {
        let meshes = pool.groups.first().map_or(&[][..], |all| &all.meshes);
        let studies = studies.iter().filter(|s| meshes.contains(&s.mesh.name));
        let studies = &studies.copied().collect::<Vec<&Report>>()[..];
        let mut backends: Vec<String> = Vec::new();
        for row in pool.all() {
            if !backends.contains(&row.backend) {
                backends.push(row.backend.clone());
            }
        }
        let overall = pool.groups.first().map_or(&[][..], |all| &all.overall);
        likely_first(&mut backends, overall, |name| name);
        let lines = by_group(studies).filter_map(|info| {
            let operation = info.name.as_str();
            let rows = pool.all().iter().filter(|row| row.operation == operation);
            let rows: Vec<&Pooled> = rows.collect();
            rows.first()?;
            let quotients = mean_quotients(studies, operation, &backends);
            let first = rows.iter().filter(|row| row.estimated == 0);
            let first = first.min_by(|a, b| a.ratio_to_best.total_cmp(&b.ratio_to_best));
            let first = first.map_or("", |row| &row.backend);
            let cell = |(name, quotients): (&String, _)| match rows
                .iter()
                .find(|row| row.backend == *name)
            {
                Some(row) => Cell {
                    quotients,
                    ..Cell::of_pool(row, ratios(studies, operation, [name, first]))
                },
                None => Cell::new(name, without_time(studies, operation, name)),
            };
            let mut cells: Vec<Cell> = backends.iter().zip(quotients).map(cell).collect();
            let measured = studies
                .iter()
                .filter(|study| study.rows(operation).next().is_some());
            let mut open = measured.map(|study| study.is_provisional(operation));
            let provisional = match meshes.len() < FEWEST_MESHES {
                true => open.any(|open| open),
                false => open.all(|open| open),
            };
            if !provisional {
                set_standings(&mut cells);
            }
            Some(Line::new(info, info.unit.clone(), provisional, cells))
        });
        Self {
            lines: lines.collect(),
            backends,
            confidence: studies
                .first()
                .map_or_else(Confidence::default, |study| study.run.settings.confidence),
            meshes: meshes.len(),
        }
    }
}

/// Returns why a backend has no time of an operation on any mesh.
fn without_time(studies: &[&Report], operation: &str, backend: &str) -> Source {
    let refusals = studies.iter().flat_map(|study| &study.refusals);
    let own = refusals.filter(|r| r.operation == operation && r.backend == backend);
    let kinds: Vec<RefusalKind> = own.map(|refusal| refusal.kind).collect();
    match kinds.first() {
        Some(RefusalKind::Impossible) if kinds.iter().all(|&kind| kind == kinds[0]) => {
            Source::Impossible
        }
        _ => Source::NotRun,
    }
}

/// Sets how the means compare, by their [quotients](Quotient::standing): those that are not slower than another one share
/// the first place. Without intervals and ranges, nothing is set.
fn set_standings(cells: &mut [Cell]) {
    let ratio = |place: usize| cells[place].ratio.filter(|_| !cells[place].is_bound());
    let measured = (0..cells.len()).filter_map(|place| Some((place, ratio(place)?)));
    let measured: Vec<(usize, f64)> = measured.collect();
    let first = measured.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let Some(&(first, _)) = first.filter(|_| measured.len() > 1) else {
        return;
    };
    let against = |own: usize, other: usize| -> Option<Standing> {
        cells[own].quotients.get(other)?.as_ref()?.standing()
    };
    let standing = |own: usize| -> Option<Standing> {
        let mut others = measured.iter().map(|(other, _)| *other);
        match others.any(|other| other != own && against(own, other) == Some(Standing::Slower)) {
            true => Some(Standing::Slower),
            false => against(own, first),
        }
    };
    let others = measured.iter().map(|(place, _)| *place);
    let others = others.filter(|&place| place != first);
    let others: Option<Vec<(usize, Standing)>> = others
        .map(|place| Some((place, standing(place)?)))
        .collect();
    let Some(others) = others else { return };
    let has = |standing| others.iter().any(|&(_, other)| other == standing);
    let of_first = match () {
        () if has(Standing::Undecided) => Standing::Undecided,
        () if has(Standing::Equal) => Standing::Equal,
        () => Standing::Best,
    };
    cells[first].standing = Some(of_first);
    for (place, standing) in others {
        cells[place].standing = Some(standing);
    }
}

/// Sorts backends, which `name` names: the fastest in queries first, or in the first other kind of work if no queries were
/// measured. On a narrow screen, a table begins with those that are likely chosen.
pub(crate) fn likely_first<T>(backends: &mut [T], overall: &[Overall], name: impl Fn(&T) -> &str) {
    let mut works = [Purpose::Query].into_iter().chain(Purpose::ALL);
    let rows = works.find_map(|purpose| {
        let rows = purpose.rows(overall);
        (!rows.is_empty()).then_some(rows)
    });
    let rows = rows.unwrap_or_default();
    backends.sort_by_key(|backend| {
        let place = rows.iter().position(|row| row.backend == name(backend));
        place.unwrap_or(rows.len())
    });
}

/// Returns the measured ratios of one backend to another one on each mesh.
fn ratios(studies: &[&Report], operation: &str, [own, other]: [&str; 2]) -> Vec<f64> {
    let quotient = |study: &&Report| study.quotient(operation, own, other);
    let quotients = studies.iter().filter_map(quotient);
    quotients.map(|quotient| quotient.ratio).collect()
}

/// Returns the operations, those of a group one after the other.
fn by_group<'s>(studies: &[&'s Report]) -> impl Iterator<Item = &'s OperationInfo> + use<'s> {
    let mut operations = operations(studies);
    operations.sort_by_key(|operation| operation.group);
    operations.into_iter()
}

impl Matrix {
    /// Returns the ratios as a table of texts. ● marks the fastest, and ◐ those that share the first place.
    pub(crate) fn ratios(&self) -> Table {
        let names = self.backends.iter().map(String::as_str);
        let mut table = Table::new(["operation"].into_iter().chain(names));
        for line in &self.lines {
            let cell = |cell: &Cell| match cell.times_text() {
                text if cell.is_best() => format!("● {text}"),
                text if cell.shares_first() => format!("◐ {text}"),
                text => text,
            };
            let cells = line.cells.iter().map(cell);
            table.row([line.name.clone()].into_iter().chain(cells).collect());
        }
        table
    }
}

impl Line {
    fn new(operation: &OperationInfo, unit: String, provisional: bool, cells: Vec<Cell>) -> Self {
        Self {
            provisional,
            name: operation.name.clone(),
            about: operation.about.clone(),
            group: operation.group,
            unit,
            cells,
        }
    }
}
