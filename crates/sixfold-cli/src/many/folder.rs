//! The folder of a report.
//!
//! ```text
//! DIR/studies/bunny-0e2a97c1.json  one mesh, written as soon as it is finished; used by --resume
//! DIR/labs/orders.json           another lab
//! DIR/results.json               all results
//! DIR/results.csv                every sample
//! DIR/report.html                the page, which needs no other file
//! DIR/report.md, DIR/figures     the same in Markdown
//! ```

use std::fs;
use std::hash::Hasher;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sixfold_report::ReportPage;
use sixfold_study::{Collection, Failed, Report, Results, SharedSettings};

use super::meshes::Mesh;
use crate::failure::Failure;
use crate::output::{Output, cannot_write};
use crate::text::print_stderr;
use sixfold_study::numbers::counted;

pub(super) struct Folder {
    path: PathBuf,
}

/// The saved study of one mesh, or the reason why the study failed.
#[derive(Debug, Deserialize, Serialize)]
pub(super) struct StudyRecord {
    schema: u32,
    mesh: String,
    /// Size and checksum of the mesh file. They show whether the file has changed.
    content: Option<String>,
    settings: SharedSettings,
    study: Option<Report>,
    failure: Option<Failed>,
}

impl StudyRecord {
    pub(super) fn new(
        mesh: &Mesh,
        settings: &SharedSettings,
        result: Result<Report, Failed>,
    ) -> Self {
        let (study, failure) = match result {
            Ok(study) => (Some(study), None),
            Err(failed) => (None, Some(failed)),
        };
        Self {
            schema: sixfold_study::SCHEMA,
            mesh: mesh.name.clone(),
            content: mesh.path.as_deref().and_then(content),
            settings: settings.clone(),
            study,
            failure,
        }
    }

    pub(super) fn add_to(self, collection: &mut Collection) {
        match (self.study, self.failure) {
            (Some(study), _) => collection.add_study(study),
            (None, Some(failed)) => collection.add_failure(failed),
            (None, None) => {} // still missing
        }
    }
}

/// Returns the size and checksum of a file. Returns `None` if the file cannot be read.
fn content(path: &Path) -> Option<String> {
    let mut file = fs::File::open(path).ok()?;
    let mut hasher = crc32fast::Hasher::new();
    let mut buffer = vec![0; 1 << 16];
    let mut bytes = 0_u64;
    loop {
        match file.read(&mut buffer).ok()? {
            0 => break,
            count => {
                hasher.write(&buffer[..count]);
                bytes += count as u64;
            }
        }
    }
    Some(format!("{bytes} bytes, crc32 {:08x}", hasher.finalize()))
}

impl Folder {
    /// Opens or creates `path`. If `resume` is set, adds the finished studies to `collection`.
    pub(super) fn open(
        path: &Path,
        resume: bool,
        collection: &mut Collection,
        meshes: &[Mesh],
    ) -> Result<Self, Failure> {
        let shown = path.display();
        let folder = Self { path: path.into() };
        let studies = folder.studies();
        fs::create_dir_all(&studies).map_err(|cause| cannot_write(&shown.to_string(), &cause))?;
        let files = folder.study_files()?;
        if !resume {
            let existing = folder.path.join("results.json");
            return match files.len() {
                0 if existing.exists() => Err(Failure::usage(format!(
                    "{} exists already, but does not belong to a study in this folder: name another folder, or use --resume to overwrite it",
                    existing.display()
                ))),
                0 => Ok(folder),
                finished => {
                    let finished = counted(finished, "finished study", "finished studies");
                    Err(Failure::usage(format!(
                        "{shown} has {finished}: continue with --resume, or name another folder"
                    )))
                }
            };
        }
        for (file, text) in files {
            let Ok(record) = serde_json::from_str::<StudyRecord>(&text) else {
                let file = file.display();
                print_stderr(&format!(
                    "note: {file}: not a study of this program, so the mesh is studied again"
                ));
                continue;
            };
            if record.settings != collection.settings {
                return Err(Failure::usage(format!(
                    "{} was made with other settings: name another folder, or use the same settings",
                    file.display()
                )));
            }
            let Some(mesh) = meshes.iter().find(|mesh| mesh.name == record.mesh) else {
                continue; // no longer selected
            };
            match mesh.path.as_deref().and_then(content) == record.content {
                true => record.add_to(collection),
                false => print_stderr(&format!(
                    "note: {}: the file has changed since it was studied, so it is studied again",
                    mesh.name
                )),
            }
        }
        Ok(folder)
    }

    /// Opens or creates the folder for complete results.
    pub(super) fn create(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        fs::create_dir_all(path).map_err(|cause| cannot_write(&shown, &cause))?;
        Ok(Self { path: path.into() })
    }

    /// Removes the records of failures, and the folder if it is empty then. Leaves everything that
    /// this program did not write.
    pub(super) fn remove_failures(&self) {
        for (file, text) in self.study_files().unwrap_or_default() {
            let record = serde_json::from_str::<StudyRecord>(&text);
            if record.is_ok_and(|record| record.study.is_none()) {
                fs::remove_file(file).ok();
            }
        }
        // Only folders that are empty now are removed.
        fs::remove_dir(self.studies()).ok();
        fs::remove_dir(&self.path).ok();
    }

    fn studies(&self) -> PathBuf {
        self.path.join("studies")
    }

    /// Returns the paths and texts of the finished studies.
    fn study_files(&self) -> Result<Vec<(PathBuf, String)>, Failure> {
        let failed = |path: &Path, cause: io::Error| {
            Failure::usage(format!(
                "{}: cannot be read ({cause}): check the permissions, or name another folder",
                path.display()
            ))
        };
        let studies = self.studies();
        let entries = fs::read_dir(&studies).map_err(|cause| failed(&studies, cause))?;
        let mut files = Vec::new();
        for entry in entries {
            let path = entry.map_err(|cause| failed(&studies, cause))?.path();
            if path.extension().is_some_and(|ending| ending == "json") {
                let text = fs::read_to_string(&path).map_err(|cause| failed(&path, cause))?;
                files.push((path, text));
            }
        }
        files.sort();
        Ok(files)
    }

    /// Saves the study of a mesh. The file gets its name when it is complete.
    pub(super) fn save_study(&self, record: &StudyRecord) -> Result<(), Failure> {
        let stem = Path::new(&record.mesh).file_stem().unwrap_or_default();
        let safe = |c: char| {
            if c.is_ascii_alphanumeric() || "._-".contains(c) {
                c
            } else {
                '_'
            }
        };
        let stem: String = stem.to_string_lossy().chars().map(safe).take(40).collect();
        // The checksum of the full name distinguishes meshes with the same stem.
        let name = crc32fast::hash(record.mesh.as_bytes());
        let path = self.studies().join(format!("{stem}-{name:08x}.json"));
        Output::open(&path)?.finish(|writer| {
            serde_json::to_writer(&mut *writer, record)?;
            writeln!(writer)
        })
    }

    /// Reads the saved lab `name`. Returns `None` if the lab cannot be read.
    pub(super) fn load_lab(&self, name: &str) -> Option<Results> {
        let text = fs::read_to_string(self.lab_path(name)).ok()?;
        Results::read_json(&text).ok()
    }

    pub(super) fn save_lab(&self, name: &str, results: &Results) -> Result<(), Failure> {
        let path = self.lab_path(name);
        let folder = self.path.join("labs");
        fs::create_dir_all(&folder)
            .map_err(|cause| cannot_write(&folder.display().to_string(), &cause))?;
        Output::open(&path)?.finish(|writer| results.write_json(writer))
    }

    fn lab_path(&self, name: &str) -> PathBuf {
        self.path.join("labs").join(format!("{name}.json"))
    }

    /// Writes all results and the page. `command` reproduces them.
    pub(super) fn write_report(
        &self,
        collection: &Collection,
        command: &str,
    ) -> Result<(), Failure> {
        let output = |name: &str| Output::open(&self.path.join(name));
        output("results.json")?.finish(|writer| collection.write_json(writer))?;
        output("results.csv")?.finish(|writer| collection.write_csv(writer))?;
        self.write_page(collection, command)
    }

    /// Writes only the page and the figures.
    pub(super) fn write_page(&self, collection: &Collection, command: &str) -> Result<(), Failure> {
        let output = |name: &str| Output::open(&self.path.join(name));
        let page = ReportPage::new(collection, command);
        output("report.html")?.finish(|writer| writer.write_all(page.html().as_bytes()))?;
        output("report.md")?.finish(|writer| writer.write_all(page.markdown().as_bytes()))?;
        let figures = self.path.join("figures");
        fs::create_dir_all(&figures)
            .map_err(|cause| cannot_write(&figures.display().to_string(), &cause))?;
        for figure in page.all_figures() {
            let output = Output::open(&figures.join(format!("{}.svg", figure.id)))?;
            output.finish(|writer| writer.write_all(figure.svg.as_bytes()))?;
        }
        Ok(())
    }
}
