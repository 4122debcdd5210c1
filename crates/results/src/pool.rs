//! Results over all meshes of a collection.
//!
//! The means of two backends can be compared only if both means are over the same meshes. Every
//! mean is therefore over the meshes that all compared backends can hold.
//!
//! An estimated time is a lower bound. The means include lower bounds: without them, backends that are
//! too slow to measure would look fast. A mean with a lower bound is one itself, and is never ranked
//! before a measured mean. The ratios are to the fastest measured time.

mod cases;
mod means;
mod sentences;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::findings::study::Report;
use crate::operation::Purpose;
use means::pooled;
pub use means::{FEWEST_MESHES, mean_quotients, operations, overall};
use sentences::warnings;
pub use sentences::{leaders, next_best, next_row, not_ranked};

use crate::numbers::{grouped, rounded_down, times};

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
    /// are one case.
    pub cases: usize,
    /// The mean time of this backend divided by that of the fastest backend, which has the smallest mean without a lower
    /// bound: geometric means over meshes and operations of the time relative to the fastest of the case. Each range of mesh
    /// sizes (such as 100 to 999 faces or 1,000 to 9,999 faces) has the same weight in the mean.
    pub ratio_to_best: f64,
    /// Lower end of the confidence interval of `ratio_to_best`; `None` for the fastest and for lower bounds, on several
    /// meshes if they are fewer than six, and on one mesh if a time has none.
    pub ci_low: Option<f64>,
    /// Upper end of the confidence interval of `ratio_to_best`.
    pub ci_high: Option<f64>,
    /// The least and the largest of these ratios on a mesh; `None` on one mesh.
    #[serde(skip)]
    pub range: Option<[f64; 2]>,
    /// True if the mean includes estimated times. Estimates are lower bounds, so the mean is one too,
    /// and has no interval.
    pub bound: bool,
    /// Number of meshes on which this backend alone has the shortest mean time, by a clear difference
    /// (see [`leaders`]).
    pub best: usize,
    /// Number of meshes on which this backend is one of several without a clear difference from the
    /// shortest mean time.
    pub tied: usize,
    /// Number of meshes on which the fastest is not known: there are too few samples, or a lower bound
    /// is below the shortest measured time.
    pub undecided: usize,
    /// Whether no other backend is faster by a clear difference.
    #[serde(skip)]
    pub(crate) leads: bool,
}

/// The results of one operation on one backend, over several meshes.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Pooled {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The measured operation, such as `vertex_normal`.
    pub operation: String,
    /// Number of meshes in the means. This number is the same for all backends of an operation.
    pub meshes: usize,
    /// Number of meshes on which this backend alone is the fastest.
    pub best: usize,
    /// Number of meshes on which this backend is tied with the fastest.
    pub tied: usize,
    /// Number of meshes on which the time is an estimate, because a real run would exceed the time
    /// budget. If there are any, `ratio_to_best` and `ns_per_element` are lower bounds.
    pub estimated: usize,
    /// `ns_per_element` of this backend divided by that of the fastest backend, which has the smallest mean without a lower
    /// bound; both as they are shown, with three digits. Each range of mesh sizes has the same weight, as in [`Overall`].
    pub ratio_to_best: f64,
    /// Lower end of the confidence interval of `ratio_to_best`; `None` for the fastest, with fewer than six meshes, or if the
    /// mean is a lower bound.
    pub ci_low: Option<f64>,
    /// Upper end of the confidence interval of `ratio_to_best`.
    pub ci_high: Option<f64>,
    /// The least and the largest of these ratios on a mesh.
    #[serde(skip)]
    pub range: Option<[f64; 2]>,
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
        let holds = |study: &Report, name: &str| study.backend(name).is_some_and(|b| b.holds);
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
        pool.sentences = pool.describe(studies);
        pool
    }

    /// Returns the results over the meshes that all compared backends can hold.
    pub fn all(&self) -> &[Pooled] {
        self.groups.first().map_or(&[], |group| &group.pooled)
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

impl Purpose {
    /// Returns the rows of this purpose in `overall`, in which the rows of a purpose are side by side.
    pub fn rows(self, overall: &[Overall]) -> &[Overall] {
        let mut purposes = overall.chunk_by(|a, b| a.purpose == b.purpose);
        purposes.find(|rows| rows[0].purpose == self).unwrap_or(&[])
    }
}

impl Overall {
    /// Returns the ends that the mean is shown with: of its interval, or of its range if the meshes are too few for an
    /// interval.
    pub fn ends(&self) -> Option<[f64; 2]> {
        let interval = self.ci_low.zip(self.ci_high).map(Into::into);
        interval.or(self.range)
    }

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
