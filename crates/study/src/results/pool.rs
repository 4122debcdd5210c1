//! Results over all meshes of a collection.
//!
//! The means of two backends can be compared only if both means are over the same meshes. Every
//! mean is therefore over the meshes that all compared backends can hold.
//!
//! An estimated time is a lower bound. The means include lower bounds: without them, backends that are
//! too slow to measure would look fast. A mean with a lower bound is one itself, and is never ranked
//! before a measured mean. The ratios are to the fastest measured time.

use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};

use serde::{Deserialize, Serialize};
use sixfold::structure_infos;
use sixfold::subdivision::Scheme;
use sixfold_workload::Operation;

use crate::engine::statistics::geometric_mean;
use crate::labs::pick::EQUAL_UP_TO;
use crate::labs::study::Report;
use crate::numbers::{counted, grouped, list, rounded_down, shown_ratio, times};
use crate::results::rows::{Agreement, ResultRow, Standing};

/// The results over all meshes of a collection.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Pool {
    /// The number of studied meshes that each backend can hold.
    pub holding: Vec<Holding>,
    /// The names of the compared backends. Each compared backend can hold all meshes of the first
    /// entry of `groups`.
    pub compared: Vec<String>,
    /// The results of groups of meshes. The first group contains the meshes that all compared
    /// backends can hold. The other groups are subsets of the first group, such as all closed
    /// meshes.
    pub groups: Vec<Group>,
    /// Sentences that describe the results.
    pub sentences: Vec<String>,
    /// The warnings of the studies. Warnings that differ only in their numbers are merged into one
    /// warning with the number of meshes.
    pub warnings: Vec<String>,
}

/// The number of meshes that a backend can hold.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Holding {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The number of studied meshes that the backend can hold.
    pub meshes: usize,
}

/// The results of a group of meshes.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Group {
    /// What the meshes have in common, such as `1,000 to 9,999 faces`.
    pub name: String,
    /// The names of the meshes.
    pub meshes: Vec<String>,
    /// The results for each purpose (such as queries) and each backend. The backends of a purpose
    /// are sorted from the fastest to the slowest; those with a lower bound come last.
    pub overall: Vec<Overall>,
    /// The results for each operation and each backend.
    pub pooled: Vec<Pooled>,
}

/// A kind of work to which several operations belong, such as editing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Purpose {
    /// Building the structure from an indexed face set.
    Build,
    /// Queries, and read-only passes over the mesh.
    Query,
    /// Edits that change the connectivity of the mesh.
    Edit,
    /// Subdivision, with the fastest method of each backend.
    Subdivide,
}

/// The mean time of one backend over all operations of one purpose, such as editing.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Overall {
    /// The purpose of the operations.
    pub purpose: Purpose,
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The number of meshes in the mean.
    pub meshes: usize,
    /// The number of cases in the mean: of operations on a mesh. The methods of a subdivision scheme
    /// are one case. 0 in documents of schema 2.
    #[serde(default)]
    pub cases: usize,
    /// The time of this backend divided by the time of the fastest measured backend, as the geometric
    /// mean over meshes and operations. Each range of mesh sizes (such as 100 to 999 faces or 1,000 to
    /// 9,999 faces) has the same weight in the mean.
    pub ratio_to_best: f64,
    /// Lower end of the 95 % confidence interval of `ratio_to_best`; `None` with fewer than three
    /// meshes.
    pub ci_low: Option<f64>,
    /// Upper end of the 95 % confidence interval of `ratio_to_best`.
    pub ci_high: Option<f64>,
    /// True if the mean includes estimated times. Estimates are lower bounds, so the mean is one too,
    /// and has no interval.
    #[serde(default)]
    pub bound: bool,
    /// Number of meshes on which this backend alone has the shortest mean time, by a clear difference
    /// (see [`leaders`]). 0 in documents of older versions.
    #[serde(default)]
    pub best: usize,
    /// Number of meshes on which this backend is one of several without a clear difference from the
    /// shortest mean time.
    #[serde(default)]
    pub tied: usize,
    /// Number of meshes on which the fastest is not known: there are too few samples, or a lower bound
    /// is below the shortest measured time.
    #[serde(default)]
    pub undecided: usize,
    /// The half-width of the 95 % interval of the logarithm of `ratio_to_best`, from the intervals of
    /// the times of one mesh; 0 if there are several meshes.
    #[serde(skip)]
    pub(crate) log_error: f64,
}

/// The results of one operation on one backend, over several meshes.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Pooled {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The measured operation, such as `vertex_normal`.
    pub operation: Operation,
    /// Number of meshes in the means. This number is the same for all backends of an operation.
    pub meshes: usize,
    /// Number of meshes on which this backend alone is the fastest.
    pub best: usize,
    /// Number of meshes on which this backend is tied with the fastest.
    pub tied: usize,
    /// Number of meshes on which the time is an estimate, because a real run would exceed the time
    /// budget. If there are any, `ratio_to_best` and `ns_per_element` are lower bounds.
    pub estimated: usize,
    /// The time of this backend divided by the time of the fastest measured backend, as the geometric
    /// mean over the meshes. Each range of mesh sizes has the same weight, as in [`Overall`].
    pub ratio_to_best: f64,
    /// Lower end of the 95 % confidence interval of `ratio_to_best`, at least 1; `None` with fewer
    /// than three meshes, or if the mean is a lower bound.
    pub ci_low: Option<f64>,
    /// Upper end of the 95 % confidence interval of `ratio_to_best`.
    pub ci_high: Option<f64>,
    /// The time per element in nanoseconds, as the geometric mean over the meshes.
    pub ns_per_element: Option<f64>,
}

#[cfg(test)]
thread_local! {
    /// The number of times that results were pooled in this thread.
    pub(crate) static POOLED: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

impl Pool {
    /// Computes the results over several studies. Each study must be of a different mesh.
    pub(crate) fn new(studies: &[&Report]) -> Self {
        #[cfg(test)]
        POOLED.with(|pooled| pooled.set(pooled.get() + 1));
        let holding = holding(studies);
        let compared: Vec<&str> = holding
            .iter()
            .filter(|holding| holding.meshes > 0)
            .map(|holding| holding.backend.as_str())
            .collect();
        let holds = |study: &Report, name: &str| {
            let mut backends = study.backends.iter().filter(|b| b.name == name);
            backends.any(|backend| backend.holds)
        };
        let (compared, common) = common(&compared, studies.len(), |mesh, name| {
            holds(studies[mesh], name)
        });
        let common: Vec<&Report> = common.into_iter().map(|mesh| studies[mesh]).collect();
        // The name of the group of the pooled meshes must not promise the other meshes.
        let all = match common.len() == studies.len() {
            true => "all meshes",
            false => "meshes that all compared backends can hold",
        };
        let groups: Vec<Group> = groups(&common, all)
            .into_iter()
            .map(|(name, studies)| Group {
                name,
                meshes: studies.iter().map(|s| s.mesh.name.clone()).collect(),
                overall: overall(&studies, &compared),
                pooled: pooled(&studies, &compared),
            })
            .collect();
        let compared = compared.into_iter().map(ToOwned::to_owned).collect();
        let mut pool = Self {
            holding,
            compared,
            groups,
            sentences: Vec::new(),
            warnings: warnings(studies),
        };
        pool.sentences = pool.describe(studies.len());
        pool
    }

    /// Returns the results over the meshes that all compared backends can hold.
    pub fn all(&self) -> &[Pooled] {
        self.groups.first().map_or(&[], |group| &group.pooled)
    }

    fn describe(&self, studied: usize) -> Vec<String> {
        let Some((all, parts)) = self.groups.split_first() else {
            return Vec::new();
        };
        let mut sentences = vec![self.describe_meshes(all.meshes.len(), studied)];
        for rows in all.overall.chunk_by(|a, b| a.purpose == b.purpose) {
            sentences.extend(leader(rows, &all.name, self.compared.len()));
            for part in parts {
                let own = rows[0].purpose.rows(&part.overall);
                // Only where the answer is another one.
                let differs = own.first().zip(rows.first());
                if differs.is_some_and(|(own, all)| own.backend != all.backend) {
                    sentences.extend(leader(own, &part.name, self.compared.len()));
                }
            }
        }
        sentences
    }

    fn describe_meshes(&self, pooled: usize, studied: usize) -> String {
        let holds_all = |holding: &&Holding| holding.meshes == studied;
        let (all, fewer): (Vec<&Holding>, Vec<&Holding>) = self.holding.iter().partition(holds_all);
        if fewer.is_empty() {
            return format!(
                "All backends can hold all {}.",
                counted(studied, "mesh", "meshes")
            );
        }
        let counts = fewer
            .iter()
            .map(|holding| format!("{} can hold {}", holding.backend, holding.meshes));
        let counts: Vec<String> = counts.collect();
        let others = match all.is_empty() {
            true => "",
            false => "; the other backends can hold all meshes",
        };
        let is_structure =
            |holding: &&Holding| structure_infos().iter().any(|s| s.name == holding.backend);
        let repair = match fewer.iter().any(is_structure) {
            true => " `sixfold repair --for NAME` makes a mesh that the structure NAME can hold.",
            false => "",
        };
        format!(
            "The means are over the {} that all compared backends can hold. Of {studied} studied, \
             {}{others}.{repair}",
            counted(pooled, "mesh", "meshes"),
            counts.join(", ")
        )
    }
}

/// Returns the number of meshes that each backend can hold, in the order of the studies.
fn holding(studies: &[&Report]) -> Vec<Holding> {
    let mut holding: Vec<Holding> = Vec::new();
    for backend in studies.iter().flat_map(|study| &study.backends) {
        let known = holding.iter().position(|h| h.backend == backend.name);
        let at = known.unwrap_or_else(|| {
            holding.push(Holding {
                backend: backend.name.clone(),
                meshes: 0,
            });
            holding.len() - 1
        });
        holding[at].meshes += usize::from(backend.holds);
    }
    holding
}

/// Returns the backends to compare and the meshes on which all of them have a value. As long as
/// there is no such mesh, the backend with the fewest values is left out.
fn common<'b>(
    backends: &[&'b str],
    meshes: usize,
    has: impl Fn(usize, &str) -> bool,
) -> (Vec<&'b str>, Vec<usize>) {
    let mut compared = backends.to_vec();
    loop {
        let all = |&mesh: &usize| compared.iter().all(|backend| has(mesh, backend));
        let shared: Vec<usize> = (0..meshes).filter(all).collect();
        let count = |backend: &str| (0..meshes).filter(|&mesh| has(mesh, backend)).count();
        let fewest = (0..compared.len()).min_by_key(|&b| count(compared[b]));
        match fewest {
            Some(fewest) if shared.is_empty() => compared.remove(fewest),
            _ => return (compared, shared),
        };
    }
}

/// Returns the groups of meshes with their names: all meshes under the name `all`, by the number of faces, and by kind. A
/// division into one group is left out.
fn groups<'s>(studies: &[&'s Report], all: &str) -> Vec<(String, Vec<&'s Report>)> {
    if studies.is_empty() {
        return Vec::new();
    }
    let mut groups = vec![(all.to_owned(), studies.to_vec())];
    let mut add = |by: &dyn Fn(&Report) -> (u32, String)| {
        let mut parts: BTreeMap<(u32, String), Vec<&Report>> = BTreeMap::new();
        for study in studies {
            parts.entry(by(study)).or_default().push(study);
        }
        if parts.len() > 1 {
            groups.extend(parts.into_iter().map(|((_, name), part)| (name, part)));
        }
    };
    add(&|study| {
        let from = 10_usize.pow(decade(study));
        let name = format!("{} to {} faces", grouped(from), grouped(10 * from - 1));
        (decade(study), name)
    });
    add(&|study| {
        let most = study.mesh.facts.face_degree.as_ref().map_or(0, |d| d.max);
        match most <= 3 {
            true => (0, "triangle meshes".into()),
            false => (1, "meshes with polygons".into()),
        }
    });
    add(&|study| match study.mesh.facts.closed {
        true => (0, "closed meshes".into()),
        false => (1, "meshes with boundary".into()),
    });
    groups
}

/// Returns the power of ten of the number of faces.
pub(crate) fn decade(study: &Report) -> u32 {
    study.mesh.facts.faces.checked_ilog10().unwrap_or(0)
}

/// A time in nanoseconds.
#[derive(Clone, Copy)]
struct Known {
    ns: f64,
    /// The time per element.
    each: f64,
    /// Whether the time is an estimate: a lower bound.
    bound: bool,
    /// The half-width of the 95 % interval of the logarithm of the ratio to the fastest backend.
    log_error: f64,
}

impl Known {
    /// Returns the time of a row: measured, or estimated. Returns `None` for other work.
    fn of(row: &ResultRow) -> Option<Self> {
        let ns = row.median_ns.or(row.estimated_ns)?;
        let bound = row.median_ns.is_none();
        let same_work = !matches!(row.agreement, Agreement::Mismatch | Agreement::OtherEdits);
        let interval = row.ratio_ci_low.zip(row.ratio_ci_high);
        let log_error = match interval {
            _ if bound || row.ratio_to_best == Some(1.0) => 0.0,
            Some((low, high)) => (high / low).ln() / 2.0,
            // Without an interval, a difference is clear from a ratio of 2.
            None => 2_f64.ln(),
        };
        let each = ns / row.elements.unwrap_or(1).max(1) as f64;
        (ns > 0.0 && same_work).then_some(Self {
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
struct Rows<'s>(Vec<HashMap<(Operation, &'s str), &'s ResultRow>>);

impl<'s> Rows<'s> {
    fn new(studies: &[&'s Report]) -> Self {
        let of = |study: &&'s Report| {
            let rows = study.results.iter();
            rows.map(|row| ((row.operation, row.backend.as_str()), row))
                .collect()
        };
        Self(studies.iter().map(of).collect())
    }

    fn get(&self, study: usize, operation: Operation, backend: &str) -> Option<&'s ResultRow> {
        self.0[study].get(&(operation, backend)).copied()
    }
}

/// Pools each operation over the meshes on which all its backends have a time.
fn pooled(studies: &[&Report], backends: &[&str]) -> Vec<Pooled> {
    let mut pooled = Vec::new();
    let all_rows = Rows::new(studies);
    for operation in Operation::ALL {
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
                    let ratio = row.ratio_to_best.unwrap_or(time / least(mesh)?);
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
            let Some((ratio_to_best, interval)) = mean_over_sizes(&ratios) else {
                continue;
            };
            let interval = interval.map(|ends| above_best(ends, ratio_to_best));
            let estimated = rows().filter(|(row, _)| row.median_ns.is_none()).count();
            let interval = interval.filter(|_| estimated == 0);
            pooled.push(Pooled {
                backend: (*backend).to_owned(),
                operation,
                meshes: meshes.len(),
                best: standing(&[Standing::Best, Standing::Alone]),
                tied: standing(&[Standing::Tied]),
                estimated,
                ratio_to_best,
                ci_low: interval.map(|[low, _]| low),
                ci_high: interval.map(|[_, high]| high),
                ns_per_element: mean_over_sizes(&each).map(|(mean, _)| mean),
            });
        }
    }
    pooled
}

/// Returns the smallest measured time. A lower bound cannot be the smallest time.
fn least_measured(times: impl Iterator<Item = Known>) -> Option<Known> {
    let measured = times.filter(|time| !time.bound);
    measured.min_by(|a, b| a.ns.total_cmp(&b.ns))
}

/// Removes the cases in which the shortest time is not known, because a lower bound is below the shortest
/// measured time: a mean with such a case would favour the structures that were measured. If this is so in all
/// cases, they stay, and the answer names what is not ranked.
fn keep_decided<I: Iterator<Item = Known>>(cases: &mut Vec<usize>, times: impl Fn(usize) -> I) {
    let is_decided = |case: &usize| {
        let least = least_measured(times(*case));
        least.is_some_and(|least| times(*case).all(|time| !time.bound || time.ns >= least.ns))
    };
    if cases.iter().any(is_decided) {
        cases.retain(is_decided);
    }
}

/// The operations that do the same work: all methods of a subdivision scheme, or one operation.
fn tasks(purpose: Purpose) -> Vec<Vec<Operation>> {
    let of_scheme = |scheme: Scheme| {
        let same = |o: &Operation| o.scheme() == Some(scheme);
        Operation::ALL.into_iter().filter(same).collect::<Vec<_>>()
    };
    let schemes = Scheme::ALL.into_iter().map(of_scheme);
    let single = Operation::ALL.into_iter().filter(|o| o.scheme().is_none());
    let tasks = single.map(|operation| vec![operation]).chain(schemes);
    let tasks = tasks.filter(|task| task.first().is_some_and(|o| Purpose::of(*o) == purpose));
    tasks.collect()
}

impl Purpose {
    /// All kinds of work.
    pub const ALL: [Self; 4] = [Self::Build, Self::Query, Self::Edit, Self::Subdivide];

    /// Returns the purpose that an operation serves.
    pub const fn of(operation: Operation) -> Self {
        match operation {
            Operation::Build => Self::Build,
            Operation::EditPass(_) => Self::Edit,
            Operation::CatmullClark(_) | Operation::Loop(_) => Self::Subdivide,
            _ => Self::Query,
        }
    }

    /// Returns the rows of this purpose in `overall`, in which the rows of a purpose are side by side.
    pub fn rows(self, overall: &[Overall]) -> &[Overall] {
        let mut purposes = overall.chunk_by(|a, b| a.purpose == b.purpose);
        purposes.find(|rows| rows[0].purpose == self).unwrap_or(&[])
    }

    /// Returns the purpose of a choice, such as `for queries`.
    pub const fn of_choice(self) -> &'static str {
        match self {
            Self::Build => "to build",
            Self::Query => "for queries",
            Self::Edit => "for edits",
            Self::Subdivide => "for subdivision",
        }
    }

    /// Returns the name of the purpose in sentences, such as `queries`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Build => "Building",
            Self::Query => "Queries",
            Self::Edit => "Edits",
            Self::Subdivide => "Subdivision",
        }
    }
}

impl Overall {
    /// Formats the mean time relative to the mean time of `other`: `1.31 ×`, or `≥ 900 ×` for a
    /// lower bound.
    pub fn times(&self, other: &Self) -> String {
        let ratio = self.ratio_to_best / other.ratio_to_best;
        match self.bound {
            true => format!("≥ {}", times(rounded_down(ratio))),
            false => times(ratio),
        }
    }
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
    let all_rows = Rows::new(studies);
    for purpose in Purpose::ALL {
        let tasks = tasks(purpose);
        // A case is a task on a mesh.
        let cases: Vec<(usize, &[Operation])> = (0..studies.len())
            .flat_map(|mesh| tasks.iter().map(move |task| (mesh, task.as_slice())))
            .collect();
        let value = |case: usize, backend: &str| {
            let (mesh, task) = cases[case];
            let rows = task.iter().filter_map(|&o| all_rows.get(mesh, o, backend));
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
            Some(match studies {
                // The times of one mesh are shown. A reader who divides two of them gets the ratio.
                [_] => shown_ratio(own.each, least.each),
                _ => own.ns / least.ns,
            })
        };
        let is_bound = |backend: &str| {
            let mut times = shared.iter().filter_map(|&case| value(case, backend));
            times.any(|time| time.bound)
        };
        // The errors of different operations are independent.
        let log_error = |backend: &str| match studies {
            [_] => {
                let known = shared.iter().filter_map(|&case| value(case, backend));
                let squares: f64 = known.map(|known| known.log_error.powi(2)).sum();
                squares.sqrt() / shared.len().max(1) as f64
            }
            _ => 0.0,
        };
        let mut rows: Vec<Overall> = compared
            .iter()
            .filter_map(|backend| {
                // Mean over the tasks of each mesh, with the size of the mesh.
                let by_mesh: Vec<(u32, f64)> = (0..studies.len())
                    .filter_map(|mesh| {
                        let own = shared.iter().filter(|&&case| cases[case].0 == mesh);
                        let ratios: Vec<f64> =
                            own.filter_map(|&case| ratio(case, backend)).collect();
                        Some((decade(studies[mesh]), geometric_mean(&ratios)?.0))
                    })
                    .collect();
                let bound = is_bound(backend);
                mean_over_sizes(&by_mesh).map(|(mean, interval)| {
                    let interval = interval.filter(|_| !bound);
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
                    }
                })
            })
            .collect();
        rows.sort_by(|a, b| {
            let by_ratio = a.ratio_to_best.total_cmp(&b.ratio_to_best);
            a.bound.cmp(&b.bound).then(by_ratio)
        });
        overall.extend(rows);
        let mut meshes: Vec<usize> = shared.iter().map(|&case| cases[case].0).collect();
        meshes.dedup();
        parts.extend(meshes.into_iter().map(|mesh| (purpose, mesh)));
    }
    (overall, parts)
}

/// Returns the geometric mean in which each power of ten has equal weight, and the interval of the
/// mean over all values, moved to this mean.
pub(crate) fn mean_over_sizes(values: &[(u32, f64)]) -> Option<(f64, Option<[f64; 2]>)> {
    let mut by_size: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
    for &(size, value) in values {
        by_size.entry(size).or_default().push(value);
    }
    let means: Vec<f64> = by_size
        .values()
        .filter_map(|values| Some(geometric_mean(values)?.0))
        .collect();
    let (mean, _) = geometric_mean(&means)?;
    let all: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
    let (centre, interval) = geometric_mean(&all)?;
    let interval = interval.map(|ends| ends.map(|end| end * mean / centre));
    Some((mean, interval))
}

/// Moves the lower end of the interval of a mean ratio to 1 if it is below 1, because no backend is
/// faster than the best on average. The interval still contains `mean`.
fn above_best([low, high]: [f64; 2], mean: f64) -> [f64; 2] {
    [low.max(mean.min(1.0)), high]
}

/// Returns the fastest backends of one purpose: the first of `rows`, and those that are at most 5 %
/// slower, or by less than the error of the means of one mesh. A lower bound is never one of them.
/// Empty if `rows` has only lower bounds.
pub fn leaders(rows: &[Overall]) -> &[Overall] {
    let equal = |row: &&Overall| {
        let error = row.log_error.hypot(rows[0].log_error);
        let most = rows[0].ratio_to_best * error.exp().max(EQUAL_UP_TO);
        !row.bound && row.ratio_to_best <= most
    };
    &rows[..rows.iter().take_while(equal).count()]
}

/// Returns the next backends after the [`leaders`], with their time relative to the first: the
/// fastest measured one, or else those that have only lower bounds. `None` if there are no others.
pub(crate) fn next_best(rows: &[Overall]) -> Option<(String, String)> {
    let others = &rows[leaders(rows).len()..];
    let next = others.first()?;
    // Lower bounds do not show which of the backends is the next.
    let name = match next.bound && others.len() > 1 {
        true => "the others".to_owned(),
        false => next.backend.clone(),
    };
    let verb = if name == "the others" {
        "take"
    } else {
        "takes"
    };
    Some((format!("{name} {verb}"), next.times(&rows[0])))
}

/// Names the backends whose lower bound does not show that they are slower than the [`leaders`], as
/// an addition to a sentence.
pub(crate) fn not_ranked(rows: &[Overall]) -> Option<String> {
    let last = leaders(rows).last()?;
    let open = rows
        .iter()
        .filter(|row| row.bound && row.ratio_to_best <= last.ratio_to_best);
    let open: Vec<String> = open
        .map(|row| format!("{} ({})", row.backend, row.times(&rows[0])))
        .collect();
    (!open.is_empty()).then(|| {
        format!(
            "not ranked, because a run would exceed the budget: {}",
            list(open)
        )
    })
}

/// Describes the fastest backends of one purpose. `compared` is the number of all compared backends.
fn leader(rows: &[Overall], group: &str, compared: usize) -> Option<String> {
    let best = leaders(rows);
    let first = best.first()?;
    let (next, ratio) = next_best(rows)?;
    let lead = match best.len() {
        1 => "is fastest on average",
        _ => "are fastest on average, within 5 % of each other",
    };
    let name = |row: &Overall| row.backend.clone();
    let only = match rows.len() < compared {
        true => format!(" Only {} have times.", list(rows.iter().map(name))),
        false => String::new(),
    };
    let open = not_ranked(rows).map_or(String::new(), |open| format!("; {open}"));
    Some(format!(
        "{}, {group}: {} {lead} (geometric mean over {}); {next} {ratio} the time{open}.{only}",
        first.purpose.name(),
        list(best.iter().map(name)),
        counted(first.meshes, "mesh", "meshes"),
    ))
}

/// Returns the warnings of the studies. Warnings that differ only in numbers are merged.
fn warnings(studies: &[&Report]) -> Vec<String> {
    let mut merged: Vec<(String, &str, Vec<&str>)> = Vec::new();
    for study in studies {
        for warning in &study.warnings {
            let pattern: String = warning.chars().filter(|c| !c.is_ascii_digit()).collect();
            let mesh = study.mesh.name.as_str();
            match merged.iter_mut().find(|(known, ..)| *known == pattern) {
                Some((.., meshes)) => meshes.push(mesh),
                None => merged.push((pattern, warning, vec![mesh])),
            }
        }
    }
    let text = |(_, warning, meshes): (String, &str, Vec<&str>)| match &meshes[..] {
        [mesh] => format!("{mesh}: {warning}"),
        [first, others @ ..] => format!(
            "{first}: {warning} {} similar warnings.",
            match others.len() {
                1 => "Another mesh has".to_owned(),
                n => format!("{n} other meshes have"),
            }
        ),
        [] => warning.to_owned(),
    };
    merged.into_iter().map(text).collect()
}

#[cfg(test)]
mod tests;
