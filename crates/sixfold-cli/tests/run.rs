//! Runs the binary in a temporary folder.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

pub(crate) const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    pub(crate) fn from_output(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self {
            code: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }
}

/// The binary, with a temporary folder as the current folder.
pub(crate) struct Sixfold {
    folder: TempDir,
}

impl Sixfold {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a scratch folder");
        Self { folder }
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.folder.path().join(name);
        fs::write(&path, text).expect("a scratch file");
        path
    }

    /// Writes a grid of triangles to the file `name`, with `side` vertices per side.
    pub(crate) fn grid(&self, name: &str, side: usize) -> PathBuf {
        let mut text = String::new();
        for i in 0..side * side {
            let (x, y) = (i % side, i / side);
            text += &format!("v {x} {y} {}\n", (x * y) % 3);
        }
        for y in 0..side - 1 {
            for x in 0..side - 1 {
                let a = y * side + x + 1;
                let (b, c, d) = (a + 1, a + side + 1, a + side);
                text += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
            }
        }
        self.file(name, &text)
    }

    /// Returns the command that runs the binary with `arguments`.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sixfold"));
        command.args(arguments).current_dir(self.folder.path());
        // Without a terminal, text is 80 columns wide.
        command.env_remove("COLUMNS");
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Run {
        Run::from_output(self.command(arguments).output().expect("the binary runs"))
    }

    /// Runs the example `programs`, the command line of a user's programs.
    pub(crate) fn run_programs(&self, arguments: &[&str]) -> Run {
        self.run_example("programs", arguments)
    }

    /// Runs an example of the package `sixfold-measure`.
    pub(crate) fn run_example(&self, name: &str, arguments: &[&str]) -> Run {
        let mut command = self.example(name);
        command.args(arguments);
        Run::from_output(command.output().expect("the example runs"))
    }

    /// Returns the command of an example of the package `sixfold-measure`. Cargo builds it together with the tests of the
    /// workspace.
    pub(crate) fn example(&self, name: &str) -> Command {
        let folder = Path::new(env!("CARGO_BIN_EXE_sixfold")).parent();
        let example = folder.expect("a folder").join("examples").join(name);
        assert!(
            example.is_file(),
            "cargo build --examples --package sixfold-measure makes {}",
            example.display()
        );
        let mut command = Command::new(example);
        command.current_dir(self.folder.path());
        // With backtraces, the panics of programs are printed.
        command.env_remove("RUST_BACKTRACE");
        command
    }

    /// Starts the binary, with each step of its progress as a line on standard error.
    pub(crate) fn start(&self, arguments: &[&str]) -> Child {
        let mut command = self.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.env("SIXFOLD_PROGRESS", "lines");
        command.spawn().expect("the binary runs")
    }

    /// Starts the binary, and waits until it has created a file. An output file is created when a
    /// command begins.
    pub(crate) fn start_with_draft(&self, arguments: &[&str]) -> Child {
        let before = self.names().len();
        let child = self.start(arguments);
        wait_for(|| (self.names().len() > before).then_some(()));
        child
    }

    /// Runs the binary, and sends a signal when a step of its progress contains `step`.
    ///
    /// While the test does not read, the program cannot write more than the pipe holds. It can
    /// therefore not be much further when the signal arrives.
    pub(crate) fn run_interrupted(&self, arguments: &[&str], signal: &str, step: &str) -> Run {
        let run = interrupted(self.command(arguments), signal, step);
        assert!(run.stderr.contains("interrupted"), "{run:?}");
        run
    }

    /// Returns the sorted file names in the folder.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder");
        let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        let mut names: Vec<String> = entries.map(|e| name(e.expect("an entry"))).collect();
        names.sort();
        names
    }
}

/// Runs a command with its progress as lines, and sends a signal when a step contains `step`.
pub(crate) fn interrupted(mut command: Command, signal: &str, step: &str) -> Run {
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.env("SIXFOLD_PROGRESS", "lines");
    let mut child = command.spawn().expect("it starts");
    let errors = BufReader::new(child.stderr.take().expect("piped"));
    let mut lines = errors.lines().map(|line| line.expect("UTF-8"));
    let seen: Vec<String> = lines
        .by_ref()
        .take_while(|line| !line.contains(step))
        .collect();
    send(signal, &child);
    let rest: Vec<String> = lines
        .filter(|line| !line.starts_with("progress: "))
        .collect();
    let output = child.wait_with_output().expect("it ends");
    let run = Run {
        stderr: rest.join("\n"),
        ..Run::from_output(output)
    };
    assert_eq!(run.code, Some(4), "{run:?} after {:?}", seen.last());
    run
}

/// Waits until `event` returns a value. Fails after ten minutes, so that a fault does not hang.
pub(crate) fn wait_for<T>(mut event: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(value) = event() {
            return value;
        }
        assert!(start.elapsed() < Duration::from_secs(600), "it hangs");
        sleep(Duration::from_millis(5));
    }
}

/// Sends a signal to a program.
pub(crate) fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill")
        .args(["-s", signal, &child.id().to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
}

pub(crate) fn text(sixfold: &Sixfold, name: &str) -> String {
    fs::read_to_string(sixfold.folder().join(name)).expect("the file")
}

pub(crate) fn run_ok(sixfold: &Sixfold, arguments: &[&str]) -> Run {
    let run = sixfold.run(arguments);
    assert_eq!(run.code, Some(0), "{arguments:?}: {run:?}");
    run
}
