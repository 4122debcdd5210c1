//! Merging of documents, for example of the shards of a study of many meshes.

use std::collections::HashMap;

use crate::document::Results;
use crate::finding::Finding;
use crate::findings::pick::PickReport;
use crate::findings::study::Report;
use crate::rows::Samples;

/// The reason why two documents cannot be merged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum MergeError {
    /// The studies have different settings, so their times cannot be pooled.
    #[error(
        "the settings differ: {what} is {theirs}, expected {ours}; measure again with the same \
         settings"
    )]
    OtherSettings {
        what: &'static str,
        ours: String,
        theirs: String,
    },
    /// Both documents have a study of the mesh, but the two meshes are different.
    #[error(
        "this file and an earlier one both have a study of {mesh}, but of different meshes: rename \
         one of the two mesh files and measure it again"
    )]
    OtherMesh { mesh: String },
    /// The documents have two different studies of the same mesh.
    #[error(
        "this file and an earlier one both have a study of {mesh}: pool them with --repeat if they repeat one \
         measurement, compare them with `sixfold compare`, or leave one out"
    )]
    SecondStudy { mesh: String },
    /// Two picks have different workloads or needs of the same name.
    #[error(
        "this file and an earlier one have different workloads called {name}, or picks with other needs: measure \
         again with the same workload and --needs"
    )]
    OtherWorkload { name: String },
    /// Two documents have the same samples, which do not count twice.
    #[error("this file and an earlier one have the same samples of {mesh}: leave one out")]
    Copy { mesh: String },
}

impl MergeError {
    /// Returns the error for two different heap policies or cache states.
    pub(crate) fn other_memory(ours: [&str; 2], theirs: [&str; 2]) -> Self {
        let i = usize::from(ours[0] == theirs[0]);
        Self::OtherSettings {
            what: ["--heap", "--caches"][i],
            ours: ours[i].into(),
            theirs: theirs[i].into(),
        }
    }
}

impl Results {
    /// Adds the findings, failures and notices of `other`. A study replaces a failure of the same mesh.
    /// A copy of a finding or notice of `self` is not added.
    ///
    /// # Errors
    ///
    /// Returns an error if the studies of the two documents have different settings, if they are of
    /// different meshes with the same name, or if there are two different studies of one mesh.
    /// `self` is then unchanged.
    pub fn merge(&mut self, other: Self) -> Result<(), MergeError> {
        if let (Some(ours), Some(theirs)) = (self.studies().next(), other.studies().next()) {
            ours.run.settings.check_equal(&theirs.run.settings)?;
        }
        self.check_memory(&other)?;
        let known: HashMap<&str, &Report> = self
            .studies()
            .map(|study| (study.mesh.name.as_str(), study))
            .collect();
        for study in other.studies() {
            let Some(known) = known.get(study.mesh.name.as_str()) else {
                continue;
            };
            let mesh = study.mesh.name.clone();
            if known.mesh.sha256 != study.mesh.sha256 {
                return Err(MergeError::OtherMesh { mesh });
            }
            if known.run != study.run {
                return Err(MergeError::SecondStudy { mesh });
            }
        }
        let is_new = |finding: &Finding| match finding {
            Finding::Study(study) => !known.contains_key(study.mesh.name.as_str()),
            finding => !self.findings.iter().any(|known| is_copy(known, finding)),
        };
        let new: Vec<Finding> = other.findings.into_iter().filter(is_new).collect();
        self.plan(other.planned);
        self.extend(new);
        self.add_failures(other.failures);
        self.add_notices(other.notices);
        Ok(())
    }

    /// Returns an error if a finding of `other` does not repeat that of the same command and meshes in `self`: it has
    /// other settings than the seed and the budget, is of another mesh with the same name, or is a copy.
    ///
    /// # Errors
    ///
    /// Returns [`MergeError`] in these cases.
    pub fn check_repeats(&self, other: &Self) -> Result<(), MergeError> {
        for theirs in &other.findings {
            let mut ours = self.findings.iter();
            let Some(ours) = ours.find(|ours| ours.repeats(theirs)) else {
                continue;
            };
            let names: Vec<&str> = ours.meshes().iter().map(|mesh| &*mesh.name).collect();
            let mesh = names.join(", ");
            let mut meshes = ours.meshes().iter().zip(theirs.meshes());
            if meshes.any(|(ours, theirs)| ours.sha256 != theirs.sha256) {
                return Err(MergeError::OtherMesh { mesh });
            }
            ours.run().check_repeats(theirs.run())?;
            if let (Finding::Pick(ours), Finding::Pick(theirs)) = (ours, theirs)
                && (&ours.workload, &ours.needs) != (&theirs.workload, &theirs.needs)
            {
                return Err(MergeError::OtherWorkload {
                    name: ours.workload.name.clone(),
                });
            }
            let own = samples(ours);
            if own.iter().any(Option::is_some) && own == samples(theirs) {
                return Err(MergeError::Copy { mesh });
            }
        }
        Ok(())
    }

    /// Adds the notices that `self` does not have.
    pub fn add_notices(&mut self, notices: Vec<String>) {
        for notice in notices {
            if !self.notices.contains(&notice) {
                self.notices.push(notice);
            }
        }
    }

    /// Returns an error if the studies of `other` used another heap policy or cache state. With
    /// little free memory, a study uses the policy `system` instead of the policy in the settings,
    /// so comparing the settings is not enough.
    fn check_memory(&self, other: &Self) -> Result<(), MergeError> {
        let memory = |study: &Report| study.run.environment.memory_settings();
        let Some(ours) = self.studies().next().map(memory) else {
            return Ok(());
        };
        match other.studies().map(memory).find(|theirs| *theirs != ours) {
            None => Ok(()),
            Some(theirs) => Err(MergeError::other_memory(ours, theirs)),
        }
    }
}

fn samples(finding: &Finding) -> Vec<Option<&Samples>> {
    let figures = finding.figures().into_iter();
    figures.map(|figure| figure.samples).collect()
}

impl Finding {
    /// Returns whether this finding and `other` measured the same, so that they can be pooled as launches: studies
    /// of one mesh, its orders, searches in it or times of its queries, the growth of one shape, or picks for one
    /// workload on the same meshes, by their names.
    pub fn repeats(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Study(a), Self::Study(b)) => a.mesh.name == b.mesh.name,
            (Self::Orders(a), Self::Orders(b)) => a.mesh.name == b.mesh.name,
            // Counts of reads are the same in each process, so there is nothing to pool.
            (Self::Why(a), Self::Why(b)) => {
                a.mesh.name == b.mesh.name && a.memory.is_some() && b.memory.is_some()
            }
            (Self::Neighbours(a), Self::Neighbours(b)) => {
                (&a.mesh.name, a.points) == (&b.mesh.name, b.points)
            }
            (Self::Growth(a), Self::Growth(b)) => (&a.shape, &a.order) == (&b.shape, &b.order),
            (Self::Pick(a), Self::Pick(b)) => {
                let names = |pick: &PickReport| -> Vec<String> {
                    pick.meshes.iter().map(|mesh| mesh.name.clone()).collect()
                };
                a.workload.name == b.workload.name && names(a) == names(b)
            }
            _ => false,
        }
    }
}

/// Returns whether two findings are copies of the same measurement.
fn is_copy(a: &Finding, b: &Finding) -> bool {
    a.kind() == b.kind()
        && a.meshes() == b.meshes()
        && a.run() == b.run()
        && a.sentences() == b.sentences()
}
