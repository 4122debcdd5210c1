//! The folder of a report.
//!
//! ```text
//! DIR/studies/bunny-0e2a97c1.json  one mesh, written as soon as it is finished; used by --resume
//! DIR/labs/orders.json           another lab
//! DIR/results.json               all results
//! DIR/results.csv                every time
//! DIR/samples.csv                every sample
//! DIR/report.html                the page, which needs no other file
//! DIR/report.md, DIR/figures     the same in Markdown
//! ```

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sixfold_report::{GENERATOR, ReportPage};
use sixfold_results::{Finding, Results, RunSettings};
use sixfold_study::{Settings, sha256_of};

use super::Mesh;
use crate::arguments::Study;
use crate::failure::Failure;
use crate::listed_folder::remove;
use crate::load::file_hash;
use crate::output::{Output, cannot_write};
use crate::text::print_notice;
use sixfold_results::numbers::counted;

pub(super) struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Opens or creates the folder of `arguments`. With `--resume`, adds the finished studies to
    /// `results`.
    pub(super) fn open(
        path: &Path,
        arguments: &Study,
        settings: &Settings,
        meshes: &[Mesh],
        results: &mut Results,
    ) -> Result<Self, Failure> {
        let shown = path.display();
        let folder = Self { path: path.into() };
        folder.check_page(arguments.force)?;
        let studies = folder.studies();
        fs::create_dir_all(&studies).map_err(|cause| cannot_write(&shown.to_string(), &cause))?;
        let files = folder.study_files()?;
        if !arguments.resume {
            let existing = folder.path.join("results.json");
            return match files.len() {
                0 if existing.exists() => Err(Failure::usage(format!(
                    "{} exists already, but does not belong to a study in this folder: name another folder. With --resume, a new study starts in this folder and replaces the file",
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
        let wanted = RunSettings {
            triangulate: arguments.triangulate,
            strict: arguments.strict,
            reading: arguments.read.given(),
            ..settings.run_settings()
        };
        for (file, text) in files {
            let Ok(saved) = Results::read_json(&text) else {
                let file = file.display();
                print_notice(&format!(
                    "note: {file}: not a study of this program, so the mesh is studied again"
                ));
                continue;
            };
            for study in saved.findings {
                if add_saved(study, &file, &wanted, meshes, results)? {
                    results.add_notices(saved.notices.clone());
                }
            }
        }
        Ok(folder)
    }

    /// Opens or creates the folder for complete results. With `force`, a page of another program is replaced.
    pub(super) fn create(path: &Path, force: bool) -> Result<Self, Failure> {
        let folder = Self { path: path.into() };
        folder.check_page(force)?;
        let shown = path.display().to_string();
        fs::create_dir_all(path).map_err(|cause| cannot_write(&shown, &cause))?;
        Ok(folder)
    }

    /// Refuses to replace a page that is not a report of Sixfold.
    fn check_page(&self, force: bool) -> Result<(), Failure> {
        let page = self.path.join("report.html");
        match fs::read(&page) {
            Ok(old) if !force && !is_report(&old) => Err(Failure::usage(format!(
                "{} exists already and is not a report of Sixfold: name another folder, or replace it with --force",
                page.display()
            ))),
            _ => Ok(()),
        }
    }

    /// Removes the folder if this program wrote nothing into it.
    pub(super) fn remove_if_empty(&self) {
        // Only empty folders are removed.
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
    pub(super) fn save_study(&self, mesh: &str, study: &Results) -> Result<(), Failure> {
        let stem = Path::new(mesh).file_stem().unwrap_or_default();
        let safe = |c: char| {
            if c.is_ascii_alphanumeric() || "._-".contains(c) {
                c
            } else {
                '_'
            }
        };
        let stem: String = stem.to_string_lossy().chars().map(safe).take(40).collect();
        // The hash of the full name distinguishes meshes with the same stem.
        let hash = sha256_of(mesh.as_bytes()).map_err(|cause| cannot_write(mesh, &cause))?;
        let path = self.studies().join(format!("{stem}-{}.json", &hash[..8]));
        Output::open(&path)?.finish(|writer| study.write_json(writer))
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

    /// Writes all results and the page. `command` reproduces them. If one file cannot be written,
    /// writes the others anyway, and returns the first error.
    pub(super) fn write_report(&self, results: &Results, command: &str) -> Result<(), Failure> {
        let results = &*results.without_folders();
        let output = |name: &str| Output::open(&self.path.join(name));
        let json = output("results.json").and_then(|o| o.finish(|w| results.write_json(w)));
        let csv = output("results.csv").and_then(|o| o.finish(|w| results.write_csv(w)));
        let samples = output("samples.csv");
        let samples = samples.and_then(|o| o.finish(|w| results.write_samples_csv(w)));
        let mut page = ReportPage::new(results, command);
        page.data = Some("results.json".into());
        let page = self.write(&page);
        json.and(csv).and(samples).and(page)
    }

    /// Writes only the page and the figures.
    pub(super) fn write_page(&self, results: &Results, command: &str) -> Result<(), Failure> {
        self.write(&ReportPage::new(&results.without_folders(), command))
    }

    fn write(&self, page: &ReportPage) -> Result<(), Failure> {
        let output = |name: &str| Output::open(&self.path.join(name));
        let old_figures = self.linked_figures();
        let figures = self.path.join("figures");
        fs::create_dir_all(&figures)
            .map_err(|cause| cannot_write(&figures.display().to_string(), &cause))?;
        for file in page.files() {
            output(&file.name)?.finish(|writer| writer.write_all(&file.bytes))?;
        }
        let drawn = self.linked_figures();
        for stale in old_figures.difference(&drawn) {
            remove(&figures.join(format!("{stale}.svg")))?;
        }
        Ok(())
    }

    /// Returns the ids of the figures to which report.md links. These files belong to the report, so
    /// they can be removed; other files in the folder of figures stay.
    fn linked_figures(&self) -> BTreeSet<String> {
        let page = fs::read_to_string(self.path.join("report.md")).unwrap_or_default();
        let links = page.split("](figures/").skip(1);
        let ids = links.filter_map(|link| link.split_once(".svg)").map(|(id, _)| id));
        let is_id = |id: &&str| id.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
        ids.filter(is_id).map(str::to_owned).collect()
    }
}

/// Returns whether a page is a report of Sixfold, also of a version whose pages did not say so.
fn is_report(page: &[u8]) -> bool {
    let start = String::from_utf8_lossy(&page[..page.len().min(4096)]);
    start.contains(GENERATOR) || start.contains("<title>Mesh data structures")
}

/// Adds a saved study to `results` if its mesh is selected and its file has not changed.
fn add_saved(
    saved: Finding,
    file: &Path,
    wanted: &RunSettings,
    meshes: &[Mesh],
    results: &mut Results,
) -> Result<bool, Failure> {
    let Finding::Study(study) = saved else {
        return Ok(false);
    };
    // Not every study need have as many launches.
    let wanted = RunSettings {
        launches: study.run.settings.launches,
        ..wanted.clone()
    };
    if let Some((option, saved, given)) = study.run.settings.difference(&wanted) {
        return Err(Failure::usage(format!(
            "{} was made with other settings ({option} was {saved}, and is {given} now): name another folder, or use the same settings",
            file.display()
        )));
    }
    let Some(mesh) = meshes.iter().find(|mesh| mesh.name == study.mesh.name) else {
        return Ok(false); // no longer selected
    };
    let is_same = mesh.path.as_deref().and_then(file_hash) == study.mesh.file_sha256;
    match is_same {
        true => results.add(Finding::Study(study)),
        false => print_notice(&format!(
            "note: {}: the file has changed since it was studied, so it is studied again",
            mesh.name
        )),
    }
    Ok(is_same)
}
