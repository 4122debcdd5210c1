//! Studies of many meshes, and means over the meshes.
//!
//! Times differ more between meshes than between the rounds of one study. A mean over meshes is
//! therefore the geometric mean of one ratio per mesh: the time of a backend divided by the time of
//! the fastest backend on the same mesh. The confidence interval of the mean is computed by
//! resampling the meshes (bootstrap). [`Pool`] contains the means.

mod pool;

use std::io;

use serde::{Deserialize, Serialize};
use sixfold_workload::Operation;
use sixfold_workload::pages::Policy;

use crate::heap::CacheState;
use crate::labs::Labs;
use crate::read::{ReadError, Results, check_schema, parse_json};
use crate::report::{Report, SCHEMA, into_io_error, write_json};

pub use pool::{Group, Holding, Overall, Pool, Pooled, Purpose};

/// The studies of several meshes, measured with the same settings.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Collection {
    /// Version of the JSON schema.
    pub schema: u32,
    /// Names of all meshes. The lists `studies`, `failures` and `missing` are sorted in the order
    /// of this list.
    pub meshes: Vec<String>,
    /// The settings that all studies share.
    pub settings: SharedSettings,
    /// The finished studies.
    pub studies: Vec<Report>,
    /// The meshes that could not be studied.
    pub failures: Vec<Failed>,
    /// The names of the meshes that have neither a study nor a failure.
    pub missing: Vec<String>,
    /// Results of other measuring commands, such as `sixfold pick`.
    #[serde(default)]
    pub labs: Labs,
}

/// The settings of several studies. Two collections can be merged only if their settings are equal.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct SharedSettings {
    /// The names of the backends. An empty list means all backends.
    pub backends: Vec<String>,
    /// The names of the external programs.
    pub externals: Vec<String>,
    /// The operations. An empty list means all operations.
    pub operations: Vec<Operation>,
    /// Time budget of each study, in seconds.
    pub budget_s: f64,
    /// Seed of the random numbers of each study.
    pub seed: u64,
    /// What happens to freed memory pages. Results files of older versions of Sixfold, which used
    /// [`Policy::System`], do not contain this field.
    #[serde(default = "system_heap")]
    pub heap: Policy,
    /// State of the processor caches when a timed series of runs begins.
    #[serde(default)]
    pub caches: CacheState,
    /// True if faces with more than three corners were cut into triangles before the study.
    pub triangulate: bool,
    /// True if files with degenerate faces were refused.
    pub strict: bool,
}

fn system_heap() -> Policy {
    Policy::System
}

/// A mesh that could not be studied.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Failed {
    /// Name of the mesh.
    pub mesh: String,
    /// Why the mesh could not be studied.
    pub reason: String,
    /// The kind of the reason. Results files of older versions of Sixfold do not contain this
    /// field, which is then read as `NotMeasured`.
    #[serde(default)]
    pub kind: FailureKind,
}

/// The kind of reason why a mesh could not be studied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureKind {
    /// The mesh could not be loaded or measured.
    #[default]
    NotMeasured,
    /// The mesh is valid, but none of the selected backends can hold it.
    NoneHolds,
}

/// The error of [`Collection::add`] for a second study. The page of a report can show only one
/// study or collection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "is a second study, but a page can show only one study: to study several meshes, use \
     `sixfold study` with --report DIR"
)]
pub struct SecondStudy;

/// The reason why two collections cannot be merged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum MergeError {
    /// The two collections have different lists of meshes.
    #[error("the lists of meshes differ: {which}; merge only parts of one study")]
    OtherMeshes { which: String },
    /// The two collections have different settings.
    #[error(
        "the settings differ: {what} is {theirs}, expected {ours}; measure again with the same \
         settings"
    )]
    OtherSettings {
        what: &'static str,
        ours: String,
        theirs: String,
    },
}

impl Collection {
    /// Creates a collection without results. `meshes` are the names of the meshes to study.
    pub fn new(meshes: Vec<String>, settings: SharedSettings) -> Self {
        Self {
            schema: SCHEMA,
            missing: meshes.clone(),
            meshes,
            settings,
            studies: Vec::new(),
            failures: Vec::new(),
            labs: Labs::default(),
        }
    }

    /// Creates a collection without meshes.
    pub fn empty() -> Self {
        Self::new(Vec::new(), SharedSettings::default())
    }

    /// Adds the results of one file: a study, a collection, or the results of another measuring
    /// command. To combine studies of several meshes, use [`merge`](Self::merge), which checks that
    /// the settings are equal.
    ///
    /// # Errors
    ///
    /// Returns [`SecondStudy`] if this collection already has meshes and `results` is a study or a
    /// collection.
    pub fn add(&mut self, results: Results) -> Result<(), SecondStudy> {
        let study = match results {
            Results::Study(study) => {
                let mut one = Self::new(vec![study.mesh.name.clone()], SharedSettings::default());
                one.add_study(*study);
                one
            }
            Results::Collection(collection) => *collection,
            lab => {
                self.labs.add(lab);
                return Ok(());
            }
        };
        if !self.meshes.is_empty() {
            return Err(SecondStudy);
        }
        let others = std::mem::replace(self, study).labs;
        self.labs.append(others);
        Ok(())
    }

    /// Adds the study of a mesh. Removes an earlier study or failure of the same mesh.
    pub fn add_study(&mut self, study: Report) {
        let mesh = study.mesh.name.clone();
        self.remove(&mesh);
        self.studies.push(study);
        self.sort();
    }

    /// Records that a mesh could not be studied. Removes an earlier study or failure of the same
    /// mesh.
    pub fn add_failure(&mut self, failed: Failed) {
        self.remove(&failed.mesh);
        self.failures.push(failed);
        self.sort();
    }

    fn remove(&mut self, mesh: &str) {
        self.studies.retain(|study| study.mesh.name != mesh);
        self.failures.retain(|failed| failed.mesh != mesh);
    }

    /// Adds the results of `other` for meshes without a study in this collection.
    ///
    /// # Errors
    ///
    /// Returns an error if the two collections have different lists of meshes or different
    /// settings.
    pub fn merge(&mut self, other: Self) -> Result<(), MergeError> {
        if other.meshes != self.meshes {
            let unknown = |mesh: &&String| !self.meshes.contains(mesh);
            let which = match other.meshes.iter().find(unknown) {
                Some(mesh) => format!("{mesh} is in only one list"),
                None => format!(
                    "{} meshes, expected {} in the same order",
                    other.meshes.len(),
                    self.meshes.len()
                ),
            };
            return Err(MergeError::OtherMeshes { which });
        }
        self.settings.check(&other.settings)?;
        self.check_memory(&other)?;
        for study in other.studies {
            // A finished study replaces a failure.
            let mesh = study.mesh.name.clone();
            let known = self.studies.iter().any(|study| study.mesh.name == mesh);
            if self.meshes.contains(&mesh) && !known {
                self.remove(&mesh);
                self.studies.push(study);
            }
        }
        self.sort();
        for failed in other.failures {
            if self.missing.contains(&failed.mesh) {
                self.failures.push(failed);
            }
        }
        self.sort();
        Ok(())
    }

    /// Returns an error if the studies of `other` used another heap policy or cache state. With
    /// little free memory, a study uses the system's heap instead of the policy in the settings.
    fn check_memory(&self, other: &Self) -> Result<(), MergeError> {
        let memory = |study: &Report| study.environment.memory_settings();
        let Some(ours) = self.studies.first().map(memory) else {
            return Ok(());
        };
        let differs = |theirs: &[&str; 2]| *theirs != ours;
        match other.studies.iter().map(memory).find(differs) {
            None => Ok(()),
            Some(theirs) => {
                let i = usize::from(ours[0] == theirs[0]);
                Err(MergeError::OtherSettings {
                    what: ["--heap", "--caches"][i],
                    ours: ours[i].into(),
                    theirs: theirs[i].into(),
                })
            }
        }
    }

    fn sort(&mut self) {
        let index = |mesh: &str| self.meshes.iter().position(|other| other == mesh);
        self.studies.sort_by_key(|study| index(&study.mesh.name));
        self.failures.sort_by_key(|failed| index(&failed.mesh));
        let done = |mesh: &&String| {
            self.studies.iter().any(|study| study.mesh.name == **mesh)
                || self.failures.iter().any(|failed| failed.mesh == **mesh)
        };
        let missing = self.meshes.iter().filter(|mesh| !done(mesh));
        self.missing = missing.cloned().collect();
    }

    /// Computes the results over all meshes, such as mean times.
    pub fn pool(&self) -> Pool {
        Pool::new(&self.studies)
    }

    /// Writes the collection and the results over all meshes ([`Pool`]) as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        #[derive(Serialize)]
        struct WithPool<'a> {
            #[serde(flatten)]
            collection: &'a Collection,
            #[serde(flatten)]
            pool: Pool,
        }

        let pool = self.pool();
        let collection = self;
        write_json(&WithPool { collection, pool }, writer)
    }

    /// Writes a header line and one CSV line per sample (timed series of runs). The columns are
    /// `mesh`, `backend`, `operation`, `control`, `round`, `cpu_ns` and `wall_ns`.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_csv(&self, writer: impl io::Write) -> io::Result<()> {
        let mut lines = csv::Writer::from_writer(writer);
        let names = [
            "mesh",
            "backend",
            "operation",
            "control",
            "round",
            "cpu_ns",
            "wall_ns",
        ];
        lines.write_record(names).map_err(into_io_error)?;
        for study in &self.studies {
            for raw in &study.raw {
                for (i, (round, wall_ns)) in raw.rounds.iter().zip(&raw.wall_ns).enumerate() {
                    let cpu_ns = raw.cpu_ns.as_ref().and_then(|column| column.get(i));
                    let start = (&study.mesh.name, &raw.backend, raw.operation, raw.control);
                    let line = (start, round, cpu_ns, wall_ns);
                    lines.serialize(line).map_err(into_io_error)?;
                }
            }
        }
        lines.flush()
    }

    /// Reads the JSON that [`write_json`](Self::write_json) wrote.
    ///
    /// # Errors
    ///
    /// Returns an error if the text is truncated or is not JSON, if another program or command
    /// wrote the text, or if the schema has another version.
    pub fn read_json(text: &str) -> Result<Self, ReadError> {
        check_schema(text)?;
        let collection: Self = parse_json(text)?;
        for study in &collection.studies {
            study.check()?;
        }
        Ok(collection)
    }
}

impl SharedSettings {
    fn check(&self, other: &Self) -> Result<(), MergeError> {
        let names = |operations: &[Operation]| {
            let names: Vec<&str> = operations.iter().map(|o| o.name()).collect();
            names.join(",")
        };
        let options = |settings: &Self| -> [(&'static str, String); 9] {
            [
                ("--backends", settings.backends.join(",")),
                ("--external", settings.externals.join(",")),
                ("--operations", names(&settings.operations)),
                ("--budget", format!("{} s", settings.budget_s)),
                ("--seed", settings.seed.to_string()),
                ("--heap", settings.heap.to_string()),
                ("--caches", settings.caches.name().into()),
                ("--triangulate", settings.triangulate.to_string()),
                ("--strict", settings.strict.to_string()),
            ]
        };
        for ((what, ours), (_, theirs)) in options(self).into_iter().zip(options(other)) {
            if ours != theirs {
                let [ours, theirs] = [ours, theirs].map(|text| match text.is_empty() {
                    true => "all".into(),
                    false => text,
                });
                return Err(MergeError::OtherSettings { what, ours, theirs });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
