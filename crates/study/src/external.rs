//! External programs that take part in a study beside the structures. Every program that follows
//! the line protocol below can take part.
//!
//! ```text
//! sixfold                                     the program, started with the path of the mesh
//!    │                                           │
//!    │ ◀── {"protocol":1,"holds":true, …} ────── │   whether it holds the mesh
//!    │ ─── {"run":"vertex_normal","times":3} ──▶ │
//!    │ ◀── {"wall_ns":…,"checksum":…, …} ─────── │   time of all three runs; result of one
//!    │ ─── end of input ───────────────────────▶ │   it ends
//! ```
//!
//! The program reads one JSON object per line, and answers each object with one line. The program
//! measures the time of its own runs, so the times do not include the communication with Sixfold.
//! `benches/external/README.md` describes the protocol.

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::PolygonMesh;
use sixfold::io::{Format, WriteOptions, write_to};
use sixfold_core::Counts;
use tempfile::TempDir;

use sixfold_measure::TimedBackend;
use sixfold_measure::external::program::{Handshake, Program};
use sixfold_measure::external::subject::ExternalSubject;
use sixfold_results::{BackendReport, ExternalReport, HeapReport, Policy, sanitize};

/// Placeholder for the path of the mesh.
const MESH: &str = "{mesh}";

/// Default time limit for one answer of an external program.
pub const EXTERNAL_TIMEOUT: Duration = Duration::from_secs(60);

/// An external program that is measured beside the structures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct External {
    /// The name of the program in the results.
    pub name: String,
    /// The program and its arguments; `{mesh}` stands for the path of an OBJ file.
    pub command: Vec<String>,
}

/// The reason why a text does not describe an external program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum ExternalError {
    /// The text has no equals sign between the name and the command.
    #[error("`{given}` has no name: write NAME='COMMAND {{mesh}}'")]
    NoName { given: String },
    /// The name is empty, is too long, or contains a character that is not allowed.
    #[error(
        "`{name}` is not a program name: use up to 32 letters, digits, dots, hyphens and \
         underscores"
    )]
    BadName { name: String },
    /// The command contains a quote that is not closed.
    #[error("the command of {name} has an unclosed quote: close the quote in {command}")]
    OpenQuote { name: String, command: String },
    /// The command is empty, or no argument contains `{mesh}`.
    #[error(
        "the command of {name} has no {{mesh}}: write {{mesh}} where the path of the mesh \
         belongs: {command}"
    )]
    NoMesh { name: String, command: String },
}

impl FromStr for External {
    type Err = ExternalError;

    /// Parses `NAME=COMMAND`. Splits the command into words as a shell does.
    fn from_str(given: &str) -> Result<Self, ExternalError> {
        let no_name = || ExternalError::NoName {
            given: given.into(),
        };
        let (name, command) = given.split_once('=').ok_or_else(no_name)?;
        let (name, command) = (name.trim().to_owned(), command.trim().to_owned());
        let is_allowed = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
        if name.is_empty() || name.len() > 32 || !name.chars().all(is_allowed) {
            return Err(ExternalError::BadName { name });
        }
        let Some(words) = shlex::split(&command) else {
            return Err(ExternalError::OpenQuote { name, command });
        };
        if !words.iter().skip(1).any(|word| word.contains(MESH)) {
            return Err(ExternalError::NoMesh { name, command });
        }
        Ok(Self {
            name,
            command: words,
        })
    }
}

impl External {
    fn arguments(&self, path: &Path) -> Vec<OsString> {
        let path = path.to_string_lossy();
        let word = |word: &String| word.replace(MESH, &path).into();
        self.command.iter().map(word).collect()
    }
}

/// The mesh of a study in a file for external programs. The file is deleted on drop.
pub(crate) struct MeshFile {
    folder: TempDir,
}

impl MeshFile {
    /// Writes `polygons` with exact coordinates.
    pub(crate) fn write(polygons: &PolygonMesh) -> io::Result<Self> {
        let folder = tempfile::tempdir()?;
        let file = Self { folder };
        let out = File::create(file.path())?;
        write_to(polygons, Format::Obj, &WriteOptions::default(), out)?;
        Ok(file)
    }

    pub(crate) fn path(&self) -> PathBuf {
        self.folder.path().join("mesh.obj")
    }
}

/// Starts `external` on the mesh and reads its first line.
pub(crate) fn prepare<'a>(
    external: &External,
    mesh: &MeshFile,
    counts: &Counts,
    heap: &HeapReport,
    timeout: Duration,
    stop: &'a AtomicBool,
) -> (BackendReport, Option<Box<dyn TimedBackend + 'a>>) {
    let started = Program::start(
        &external.arguments(&mesh.path()),
        heap.policy,
        timeout,
        stop,
    );
    let result = started.and_then(|mut program| Ok((program.handshake()?, program)));
    let (handshake, program, failed) = match result {
        Ok((handshake, program)) => (handshake, Some(program), None),
        Err(reason) => (Handshake::from_refusal(reason.clone()), None, Some(reason)),
    };
    let tuned = Program::sets_tunables(heap.policy);
    let own_heap = heap.policy == Policy::Kept && !(tuned && handshake.keeps_pages_if_tuned());
    let refusal = match handshake.holds {
        true => None,
        false => Some(
            handshake
                .reason
                .map(|reason| sanitize(&reason))
                .unwrap_or_else(|| "it gives no reason".into()),
        ),
    };
    let bytes = handshake.bytes.filter(|_| refusal.is_none());
    let per_vertex = |bytes: usize| bytes as f64 / counts.vertices as f64;
    let report = BackendReport {
        name: external.name.clone(),
        holds: refusal.is_none(),
        reason: refusal,
        bytes,
        bytes_per_vertex: bytes.filter(|_| counts.vertices > 0).map(per_vertex),
        layout_bytes: None,
        layout_bytes_per_vertex: None,
        tables: Vec::new(),
        merged_vertices: None,
        capabilities: None,
        external: Some(ExternalReport {
            command: external.command.clone(),
            library: handshake.library.map(|library| sanitize(&library)),
            own_heap,
            failed,
        }),
    };
    let program = program.filter(|_| report.holds);
    let name = external.name.clone();
    let subject = program.map(|program| ExternalSubject::new(name, bytes.unwrap_or(0), program));
    (
        report,
        subject.map(|s| Box::new(s) as Box<dyn TimedBackend>),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_split_into_words_and_contains_the_mesh() {
        let external: External = "lox=run 'a b' --mesh={mesh}".parse().expect("a command");
        assert_eq!(external.name, "lox");
        let arguments = external.arguments(Path::new("/tmp/a c.obj"));
        assert_eq!(arguments, ["run", "a b", "--mesh=/tmp/a c.obj"]);
        for (given, expected) in [
            ("run {mesh}", "has no name"),
            ("a b=run {mesh}", "not a program name"),
            ("=run {mesh}", "not a program name"),
            ("a=run 'x {mesh}", "unclosed quote"),
            ("a=run", "has no {mesh}"),
            ("a={mesh}", "has no {mesh}"),
            ("a=", "has no {mesh}"),
        ] {
            let error = given.parse::<External>().expect_err(given).to_string();
            assert!(error.contains(expected), "{given}: {error}");
        }
    }
}
