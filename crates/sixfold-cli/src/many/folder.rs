//! The folder of a report: each finished study a file of its own, and at the end all in one.
//!
//! ```text
//! DIR/studies/bunny-0e2a97c1.json  one mesh, written as soon as it is finished; what --resume goes by
//! DIR/labs/orders.json           what else was measured
//! DIR/results.json               all of it
//! DIR/results.csv                every sample
//! DIR/report.html                the page, which needs nothing else
//! DIR/report.md, DIR/figures     the same for a repository
//! ```

use std::fs;
use std::hash::Hasher;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use ::report::Page;
use ::study::{Asked, Collection, Report, Results};
use serde::{Deserialize, Serialize};

use super::meshes::Mesh;
use crate::failure::Failure;
use crate::output::{Output, cannot_write};
use crate::text::complain;
use ::study::numbers::counted;

/// A place for results.
pub(super) struct Folder {
    path: PathBuf,
}

/// The study of one mesh as it is kept, or why there is none.
#[derive(Debug, Deserialize, Serialize)]
pub(super) struct Piece {
    schema: u32,
    mesh: String,
    /// What the file of the mesh was like, so that another under its name is seen.
    content: Option<String>,
    settings: Asked,
    study: Option<Report>,
    failure: Option<String>,
}

impl Piece {
    pub(super) fn new(mesh: &Mesh, settings: &Asked, result: Result<Report, String>) -> Self {
        let (study, failure) = match result {
            Ok(study) => (Some(study), None),
            Err(reason) => (None, Some(reason)),
        };
        Self {
            schema: ::study::SCHEMA,
            mesh: mesh.name.clone(),
            content: mesh.path.as_deref().and_then(content),
            settings: settings.clone(),
            study,
            failure,
        }
    }

    /// Takes it into the results.
    pub(super) fn settle(self, collection: &mut Collection) {
        match self.study {
            Some(study) => collection.finish(study),
            None => collection.fail(&self.mesh, self.failure.unwrap_or_default()),
        }
    }
}

/// The bytes of a file, told in short; `None` if it cannot be read.
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
    /// Opens `path`, which is made if it is not there, and takes in what is finished in it if that is
    /// to be gone on with.
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
        let pieces = folder.pieces()?;
        if !resume {
            let foreign = folder.path.join("results.json");
            return match pieces.len() {
                0 if foreign.exists() => Err(Failure::usage(format!(
                    "{} is there already, and is of no study that is kept here: name another folder, or take --resume to write over it",
                    foreign.display()
                ))),
                0 => Ok(folder),
                finished => {
                    let finished = counted(finished, "study that is", "studies that are");
                    Err(Failure::usage(format!(
                        "{shown} has {finished} finished: go on with --resume, or name another folder"
                    )))
                }
            };
        }
        for (file, text) in pieces {
            let Ok(piece) = serde_json::from_str::<Piece>(&text) else {
                let file = file.display();
                complain(&format!(
                    "note: {file}: no study that this program wrote, so it is made again"
                ));
                continue;
            };
            if piece.settings != collection.settings {
                return Err(Failure::usage(format!(
                    "{} was made with other settings: name another folder, or ask for the same",
                    file.display()
                )));
            }
            let Some(mesh) = meshes.iter().find(|mesh| mesh.name == piece.mesh) else {
                continue; // no longer asked for
            };
            match mesh.path.as_deref().and_then(content) == piece.content {
                true => piece.settle(collection),
                false => complain(&format!(
                    "note: {}: another file than when it was studied, so it is studied again",
                    mesh.name
                )),
            }
        }
        Ok(folder)
    }

    /// The folder at `path`, for results that are complete.
    pub(super) fn made(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        fs::create_dir_all(path).map_err(|cause| cannot_write(&shown, &cause))?;
        Ok(Self { path: path.into() })
    }

    fn studies(&self) -> PathBuf {
        self.path.join("studies")
    }

    /// The files of finished studies, and what is in them.
    fn pieces(&self) -> Result<Vec<(PathBuf, String)>, Failure> {
        let failed = |path: &Path, cause: io::Error| {
            Failure::usage(format!("{}: cannot be read: {cause}", path.display()))
        };
        let studies = self.studies();
        let entries = fs::read_dir(&studies).map_err(|cause| failed(&studies, cause))?;
        let mut pieces = Vec::new();
        for entry in entries {
            let path = entry.map_err(|cause| failed(&studies, cause))?.path();
            if path.extension().is_some_and(|ending| ending == "json") {
                let text = fs::read_to_string(&path).map_err(|cause| failed(&path, cause))?;
                pieces.push((path, text));
            }
        }
        pieces.sort();
        Ok(pieces)
    }

    /// Keeps the study of a mesh: the file has its name when it is complete.
    pub(super) fn keep(&self, piece: &Piece) -> Result<(), Failure> {
        let stem = Path::new(&piece.mesh).file_stem().unwrap_or_default();
        let fine = |c: char| {
            if c.is_ascii_alphanumeric() || "._-".contains(c) {
                c
            } else {
                '_'
            }
        };
        let stem: String = stem.to_string_lossy().chars().map(fine).take(40).collect();
        // No two meshes have one file, whatever they are called and whichever were asked for before.
        let name = crc32fast::hash(piece.mesh.as_bytes());
        let path = self.studies().join(format!("{stem}-{name:08x}.json"));
        Output::open(&path)?.finish(|writer| {
            serde_json::to_writer(&mut *writer, piece)?;
            writeln!(writer)
        })
    }

    /// What was measured besides, and kept as `name`; `None` if there is nothing that can be read.
    pub(super) fn lab(&self, name: &str) -> Option<Results> {
        let text = fs::read_to_string(self.lab_path(name)).ok()?;
        Results::read_json(&text).ok()
    }

    /// Keeps it.
    pub(super) fn keep_lab(&self, name: &str, results: &Results) -> Result<(), Failure> {
        let path = self.lab_path(name);
        let folder = self.path.join("labs");
        fs::create_dir_all(&folder)
            .map_err(|cause| cannot_write(&folder.display().to_string(), &cause))?;
        Output::open(&path)?.finish(|writer| results.write_json(writer))
    }

    fn lab_path(&self, name: &str) -> PathBuf {
        self.path.join("labs").join(format!("{name}.json"))
    }

    /// Writes all of it in one, and draws it; `command` makes it again.
    pub(super) fn finish(&self, collection: &Collection, command: &str) -> Result<(), Failure> {
        let output = |name: &str| Output::open(&self.path.join(name));
        output("results.json")?.finish(|writer| collection.write_json(writer))?;
        output("results.csv")?.finish(|writer| collection.write_csv(writer))?;
        self.draw(collection, command)
    }

    /// The page alone.
    pub(super) fn draw(&self, collection: &Collection, command: &str) -> Result<(), Failure> {
        let output = |name: &str| Output::open(&self.path.join(name));
        let page = Page::of(collection, command);
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
