//! Communication with an external program. The program may crash, hang or write invalid lines.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use sixfold_results::{AskedCount, Policy, sanitize};

use crate::launches::LAUNCH_VARIABLE;

/// Version of the protocol.
pub const PROTOCOL: u32 = 1;
/// Maximum length of a line in bytes.
const LONGEST_LINE: u64 = 1 << 16;
/// Number of bytes of standard error that are kept.
const STDERR_TAIL_BYTES: usize = 400;
/// Interval between two checks of the stop flag.
const POLL_INTERVAL: Duration = Duration::from_millis(20);
/// Why a program has no answer after the measurement was stopped.
pub const STOPPED: &str = "the study was stopped";
/// Time limit for a program to end after its input is closed.
const EXIT_TIMEOUT: Duration = Duration::from_secs(1);

/// The first line that a program writes.
#[derive(Debug, Deserialize)]
pub struct Handshake {
    protocol: u32,
    /// Whether the program holds the mesh.
    pub holds: bool,
    /// Why the program does not hold the mesh.
    pub reason: Option<String>,
    /// Whether the reason is a fault of a program of a user.
    #[serde(default)]
    pub failed: bool,
    /// Bytes of the structure, if known.
    pub bytes: Option<usize>,
    /// The measured library and its version.
    pub library: Option<String>,
    /// The allocator, if an environment variable can make it keep pages. The only value is `glibc`.
    #[serde(default)]
    pub heap: Option<String>,
    /// The number of input vertices that were merged with other vertices.
    #[serde(default)]
    pub merged_vertices: usize,
}

/// An environment variable that makes the GNU C library keep freed pages, and its value.
const TUNABLES: [&str; 2] = [
    "GLIBC_TUNABLES",
    "glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=9223372036854775807:glibc.malloc.top_pad=1048576:glibc.malloc.arena_max=1",
];

impl Handshake {
    pub fn from_refusal(reason: String) -> Self {
        Self {
            protocol: PROTOCOL,
            holds: false,
            reason: Some(reason),
            failed: false,
            bytes: None,
            library: None,
            heap: None,
            merged_vertices: 0,
        }
    }

    /// Returns whether the allocator keeps pages if the program is started with [`TUNABLES`].
    pub fn keeps_pages_if_tuned(&self) -> bool {
        self.heap.as_deref() == Some("glibc")
    }
}

#[derive(Debug, Serialize)]
pub struct Request {
    /// Name of the operation.
    pub run: &'static str,
    /// Number of consecutive runs.
    pub times: u32,
}

/// The answer to a request.
#[derive(Debug, Deserialize)]
pub struct Response {
    /// Why the program refuses the operation.
    pub refused: Option<String>,
    /// Processor time of all runs together, in nanoseconds.
    pub cpu_ns: Option<f64>,
    /// Wall time of all runs together, in nanoseconds.
    pub wall_ns: Option<f64>,
    /// The checksum of one run.
    pub checksum: Option<f64>,
    /// Number of elements that one run visits.
    pub elements: Option<u64>,
    /// What a program of a user asks in one run.
    #[serde(default)]
    pub asked: Option<Vec<AskedCount>>,
}

pub struct Program<'a> {
    child: Child,
    input: Option<ChildStdin>,
    lines: Receiver<Line>,
    stderr_tail: Arc<Mutex<Vec<u8>>>,
    timeout: Duration,
    stop: &'a AtomicBool,
}

enum Line {
    Text(String),
    TooLong,
    End,
}

impl<'a> Program<'a> {
    /// Starts the program `arguments[0]` with the other arguments. The error is the reason.
    pub fn start(
        arguments: &[OsString],
        heap: Policy,
        timeout: Duration,
        stop: &'a AtomicBool,
    ) -> Result<Self, String> {
        let mut command = Command::new(&arguments[0]);
        command.args(&arguments[1..]);
        if Self::sets_tunables(heap) {
            let [tunables, kept] = TUNABLES;
            command.env(tunables, kept);
        }
        // The last line of standard error must be the reason of a crash, not the end of a backtrace.
        command.env("RUST_BACKTRACE", "0");
        command.env_remove(LAUNCH_VARIABLE);
        command.stdin(Stdio::piped());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C must reach only Sixfold. The program ends when its input is closed.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let child = command.spawn();
        let mut child = child.map_err(|cause| {
            format!(
                "{} cannot be started: {cause}",
                arguments[0].to_string_lossy()
            )
        })?;
        let (sender, lines) = sync_channel(4);
        let output = child.stdout.take();
        thread::spawn(move || {
            let mut output = BufReader::new(output?);
            loop {
                let line = read_line(&mut output);
                let last = !matches!(line, Line::Text(_));
                if sender.send(line).is_err() || last {
                    return Some(());
                }
            }
        });
        let stderr_tail = Arc::new(Mutex::new(Vec::new()));
        let (kept, errors) = (Arc::clone(&stderr_tail), child.stderr.take());
        thread::spawn(move || keep_tail(errors?, &kept));
        Ok(Self {
            input: child.stdin.take(),
            child,
            lines,
            stderr_tail,
            timeout,
            stop,
        })
    }

    /// Returns whether programs are started with [`TUNABLES`]. If the user has set the variable, it
    /// is not changed.
    pub fn sets_tunables(heap: Policy) -> bool {
        heap == Policy::Kept && std::env::var_os(TUNABLES[0]).is_none()
    }

    /// Reads the first line of the program and checks the protocol version.
    pub fn handshake(&mut self) -> Result<Handshake, String> {
        let handshake: Handshake = self.read_answer("at the start")?;
        if handshake.protocol != PROTOCOL {
            let other = handshake.protocol;
            return Err(format!(
                "it uses version {other} of the protocol, expected version {PROTOCOL}"
            ));
        }
        Ok(handshake)
    }

    /// Sends `request` and waits for the answer.
    pub fn ask(&mut self, request: &Request) -> Result<Response, String> {
        // A line that arrives before the request cannot be its answer.
        if let Ok(Line::Text(line)) = self.lines.try_recv() {
            self.kill();
            let excerpt = excerpt(&line);
            return Err(format!("it wrote `{excerpt}` without a request"));
        }
        let mut line = serde_json::to_string(request).map_err(|error| error.to_string())?;
        line.push('\n');
        let sent = self.input.as_mut().map(|input| {
            input.write_all(line.as_bytes())?;
            input.flush()
        });
        match sent {
            Some(Ok(())) => self.read_answer(&format!("to {}", request.run)),
            // The program closed its input. Report its status and its last error line.
            _ => Err(self.describe_exit()),
        }
    }

    /// Waits for the next line and parses it. `to` names the request in errors.
    fn read_answer<T: DeserializeOwned>(&mut self, to: &str) -> Result<T, String> {
        let start = Instant::now();
        let line = loop {
            match self.lines.recv_timeout(POLL_INTERVAL) {
                Ok(Line::Text(line)) => break line,
                Ok(Line::TooLong) => {
                    self.kill();
                    return Err(format!(
                        "its answer {to} is longer than {LONGEST_LINE} bytes"
                    ));
                }
                Ok(Line::End) | Err(RecvTimeoutError::Disconnected) => {
                    return Err(self.describe_exit());
                }
                Err(RecvTimeoutError::Timeout) if self.stop.load(Ordering::Relaxed) => {
                    self.kill();
                    return Err(STOPPED.into());
                }
                Err(RecvTimeoutError::Timeout) if start.elapsed() > self.timeout => {
                    self.kill();
                    let seconds = self.timeout.as_secs_f64();
                    return Err(format!(
                        "it was killed because it gave no answer {to} within {seconds} s"
                    ));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        };
        serde_json::from_str(&line).map_err(|error| {
            self.kill();
            let excerpt = excerpt(&line);
            format!("its answer {to} does not follow the protocol ({error}): `{excerpt}`")
        })
    }

    /// Ends the program. Describes its exit status and its last error line.
    fn describe_exit(&mut self) -> String {
        let status = self.wait(EXIT_TIMEOUT);
        let how = match status {
            Some(status) => format!("it ended ({status})"),
            None => "it closed its output".into(),
        };
        self.kill();
        let tail = self
            .stderr_tail
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let tail = String::from_utf8_lossy(&tail);
        // Rust programs end with a note on backtraces.
        let mut lines = tail.trim().lines().rev();
        let message = lines.find(|line| !line.starts_with("note: "));
        match message.map(sanitize) {
            Some(message) => format!("{how}: {message}"),
            None => how,
        }
    }

    /// Waits up to `timeout` for the program to end. Returns `None` if the program is still
    /// running.
    fn wait(&mut self, timeout: Duration) -> Option<ExitStatus> {
        let start = Instant::now();
        loop {
            match self.child.try_wait() {
                Ok(None) if start.elapsed() < timeout => thread::sleep(POLL_INTERVAL / 4),
                Ok(status) => return status,
                Err(_) => return None,
            }
        }
    }

    /// Kills the program. On Unix, also kills the processes that the program has started.
    fn kill(&mut self) {
        self.input = None;
        #[cfg(unix)]
        {
            use nix::sys::signal::{Signal, killpg};
            use nix::unistd::Pid;
            if let Ok(id) = i32::try_from(self.child.id()) {
                let _ = killpg(Pid::from_raw(id), Signal::SIGKILL);
            }
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        self.input = None;
        if self.wait(EXIT_TIMEOUT).is_none() {
            self.kill();
        }
    }
}

/// Returns the first 80 characters of a line, without control characters.
fn excerpt(line: &str) -> String {
    sanitize(line).chars().take(80).collect()
}

fn read_line(output: &mut impl BufRead) -> Line {
    let mut bytes = Vec::new();
    let read = output.take(LONGEST_LINE).read_until(b'\n', &mut bytes);
    match read {
        Ok(0) | Err(_) => Line::End,
        Ok(_) if bytes.len() as u64 == LONGEST_LINE && !bytes.ends_with(b"\n") => Line::TooLong,
        Ok(_) => Line::Text(String::from_utf8_lossy(&bytes).trim().to_owned()),
    }
}

/// Reads `errors` to the end. Keeps the last [`STDERR_TAIL_BYTES`] bytes.
fn keep_tail(mut errors: impl Read, kept: &Mutex<Vec<u8>>) -> Option<()> {
    let mut buffer = [0; STDERR_TAIL_BYTES];
    loop {
        let count = errors.read(&mut buffer).ok().filter(|&count| count > 0)?;
        let mut kept = kept.lock().ok()?;
        kept.extend_from_slice(&buffer[..count]);
        let spare = kept.len().saturating_sub(STDERR_TAIL_BYTES);
        kept.drain(..spare);
    }
}
