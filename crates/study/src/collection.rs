//! Studies of many meshes: one by one, and pooled.
//!
//! Results differ more between meshes than between rounds. A pooled figure is the geometric mean of
//! one ratio per mesh. The ratio compares a backend with the fastest backend on the same mesh. The
//! interval is found by resampling the meshes (bootstrap).

use std::io;

use serde::{Deserialize, Serialize};
use sixfold_workload::Operation;
use sixfold_workload::pages::Policy;

use crate::heap::CacheState;
use crate::labs::Labs;
use crate::read::{ReadError, Results, check_schema, parse_json};
use crate::report::{Agreement, Report, SCHEMA, Standing, into_io_error, write_json};
use crate::statistics::geometric_mean;

/// Studies of several meshes, with the same settings.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Collection {
    /// Version of the JSON schema.
    pub schema: u32,
    /// Names of all meshes. `studies`, `failures` and `missing` have the same order.
    pub meshes: Vec<String>,
    /// The settings that all studies share.
    pub settings: SharedSettings,
    /// The finished studies.
    pub studies: Vec<Report>,
    /// The meshes that could not be studied.
    pub failures: Vec<Failed>,
    /// The meshes without a result so far.
    pub missing: Vec<String>,
    /// Figures over all meshes, by operation, then by backend.
    pub pooled: Vec<Pooled>,
    /// Sentences about the pooled figures.
    #[serde(rename = "words")]
    pub sentences: Vec<String>,
    /// Results of the other labs.
    #[serde(default)]
    pub labs: Labs,
}

/// Settings that must be equal for studies to be merged.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct SharedSettings {
    /// The backends; an empty list means all backends.
    pub backends: Vec<String>,
    /// External programs, by the names of their columns.
    pub externals: Vec<String>,
    /// The operations; an empty list means all operations.
    pub operations: Vec<Operation>,
    /// Time budget of each study, in seconds.
    pub budget_s: f64,
    /// Seed of the random samples and orders.
    pub seed: u64,
    /// The policy for freed pages. Files of older versions have no policy; they used the system's
    /// policy.
    #[serde(default = "system_heap")]
    pub heap: Policy,
    /// State of the caches at the start of a sample.
    #[serde(default)]
    pub caches: CacheState,
    /// Whether polygons were cut into triangles first.
    pub triangulate: bool,
    /// Whether files with degenerate faces were refused.
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
    /// Why it could not be studied.
    pub reason: String,
    /// The kind of reason. Files of older versions do not have this field.
    #[serde(default)]
    pub kind: FailureKind,
}

/// The kind of reason why a mesh could not be studied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureKind {
    /// The mesh could not be loaded, or measuring it failed.
    #[default]
    NotMeasured,
    /// The mesh is valid, but none of the selected backends can hold it.
    NoneHolds,
}

/// The pooled results of one operation on one backend.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Pooled {
    /// The backend.
    pub backend: String,
    /// The operation.
    pub operation: Operation,
    /// Number of meshes with a measurement.
    pub meshes: usize,
    /// Number of meshes on which only this backend is the fastest.
    pub best: usize,
    /// Number of meshes on which this backend is tied with the fastest.
    pub tied: usize,
    /// Geometric mean of the ratios to the fastest backend on each mesh.
    pub ratio_to_best: f64,
    /// Lower end of the 95 % bootstrap interval of that mean; `None` with fewer than three meshes.
    pub ci_low: Option<f64>,
    /// Upper end of the 95 % bootstrap interval of that mean.
    pub ci_high: Option<f64>,
    /// Geometric mean of the time per element, in nanoseconds.
    pub ns_per_element: Option<f64>,
}

/// The error for adding a second study to a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "is a second study, but a page can show only one: to study several meshes, use `sixfold \
     study` with --report DIR"
)]
pub struct SecondStudy;

/// The reason why two collections cannot be merged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum MergeError {
    /// The lists of meshes differ.
    #[error("the lists of meshes differ: {which}; use results of one study")]
    OtherMeshes { which: String },
    /// The settings differ.
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
    /// Creates a collection of `meshes` without results.
    pub fn new(meshes: Vec<String>, settings: SharedSettings) -> Self {
        Self {
            schema: SCHEMA,
            missing: meshes.clone(),
            meshes,
            settings,
            studies: Vec::new(),
            failures: Vec::new(),
            pooled: Vec::new(),
            sentences: Vec::new(),
            labs: Labs::default(),
        }
    }

    /// Creates a collection without meshes.
    pub fn empty() -> Self {
        Self::new(Vec::new(), SharedSettings::default())
    }

    /// Adds the results of one file: a study, a collection or a lab. For studies of several meshes,
    /// use [`merge`](Self::merge), which compares the settings.
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

    /// Adds the study of a mesh. Replaces an older study of the same mesh.
    pub fn add_study(&mut self, study: Report) {
        let mesh = study.mesh.name.clone();
        self.remove(&mesh);
        self.studies.push(study);
        self.sort_and_pool();
    }

    /// Records that a mesh could not be studied.
    pub fn add_failure(&mut self, failed: Failed) {
        self.remove(&failed.mesh);
        self.failures.push(failed);
        self.sort_and_pool();
    }

    fn remove(&mut self, mesh: &str) {
        self.studies.retain(|study| study.mesh.name != mesh);
        self.failures.retain(|failed| failed.mesh != mesh);
    }

    /// Adds the results of `other` for meshes without a study in this collection.
    ///
    /// # Errors
    ///
    /// Returns an error if the lists of meshes or the settings differ.
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
        self.sort_and_pool();
        for failed in other.failures {
            if self.missing.contains(&failed.mesh) {
                self.failures.push(failed);
            }
        }
        self.sort_and_pool();
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

    fn sort_and_pool(&mut self) {
        let index = |mesh: &str| self.meshes.iter().position(|other| other == mesh);
        self.studies.sort_by_key(|study| index(&study.mesh.name));
        self.failures.sort_by_key(|failed| index(&failed.mesh));
        let done = |mesh: &&String| {
            self.studies.iter().any(|study| study.mesh.name == **mesh)
                || self.failures.iter().any(|failed| failed.mesh == **mesh)
        };
        let missing = self.meshes.iter().filter(|mesh| !done(mesh));
        self.missing = missing.cloned().collect();
        self.pooled = pooled(&self.studies);
        self.sentences = sentences(&self.pooled);
    }

    /// Writes the collection as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }

    /// Writes one CSV line per sample, after a header line: `mesh`, `backend`, `operation`,
    /// `control`, `round`, `cpu_ns`, `wall_ns`.
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
    /// Returns an error if the text is truncated, is not JSON, or comes from another program,
    /// schema or command.
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

/// Pools each operation on each backend over the meshes with a measurement.
fn pooled(studies: &[Report]) -> Vec<Pooled> {
    let mut backends: Vec<&str> = Vec::new();
    for study in studies {
        for backend in &study.backends {
            if !backends.contains(&backend.name.as_str()) {
                backends.push(&backend.name);
            }
        }
    }
    let mut pooled = Vec::new();
    for operation in Operation::ALL {
        for &backend in &backends {
            let rows = studies.iter().filter_map(|study| {
                let mut rows = study.rows(operation);
                rows.find(|row| row.backend == backend && row.agreement != Agreement::Mismatch)
            });
            let (mut best, mut tied) = (0, 0);
            let (mut ratios, mut times) = (Vec::new(), Vec::new());
            for row in rows {
                let Some(ratio) = row.ratio_to_best else {
                    continue;
                };
                ratios.push(ratio);
                times.extend(row.ns_per_element);
                let alone = matches!(row.standing, Some(Standing::Best | Standing::Alone));
                best += usize::from(alone);
                tied += usize::from(row.standing == Some(Standing::Tied));
            }
            let Some((ratio_to_best, interval)) = geometric_mean(&ratios) else {
                continue;
            };
            pooled.push(Pooled {
                backend: backend.into(),
                operation,
                meshes: ratios.len(),
                best,
                tied,
                ratio_to_best,
                ci_low: interval.map(|[low, _]| low),
                ci_high: interval.map(|[_, high]| high),
                ns_per_element: geometric_mean(&times).map(|(mean, _)| mean),
            });
        }
    }
    pooled
}

fn sentences(pooled: &[Pooled]) -> Vec<String> {
    let mut sentences = Vec::new();
    for rows in pooled.chunk_by(|a, b| a.operation == b.operation) {
        let most = rows.iter().map(|row| row.meshes).max().unwrap_or(0);
        let leader = rows
            .iter()
            .filter(|row| row.meshes == most)
            .min_by(|a, b| a.ratio_to_best.total_cmp(&b.ratio_to_best));
        let Some(leader) = leader.filter(|_| rows.len() > 1) else {
            continue;
        };
        let Pooled {
            backend,
            operation,
            meshes,
            best,
            tied,
            ratio_to_best,
            ..
        } = leader;
        let better = rows
            .iter()
            .filter(|row| row.meshes < most && row.ratio_to_best < *ratio_to_best);
        let better = better.map(|row| {
            let (name, ratio) = (&row.backend, row.ratio_to_best);
            format!("{name} {ratio:.2} × on {}", row.meshes)
        });
        let better: Vec<String> = better.collect();
        let elsewhere = match better.is_empty() {
            true => String::new(),
            false => format!(
                ". Some backends have a lower ratio, but on fewer meshes: {}",
                better.join(", ")
            ),
        };
        let ties = match tied {
            0 => String::new(),
            _ => format!(" and tied for the fastest on {tied}"),
        };
        sentences.push(format!(
            "{operation}: {backend} leads the backends measured on all {meshes} meshes. On \
             average, {backend} takes {ratio_to_best:.2} × the time of the fastest. {backend} is \
             the single fastest on {best}{ties}{elsewhere}."
        ));
    }
    sentences
}

#[cfg(test)]
mod tests;
