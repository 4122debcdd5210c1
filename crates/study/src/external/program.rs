//! A program on the other end of two pipes, which may crash, hang or talk rubbish.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use workload::pages::Policy;

use crate::tame::tame;

/// The version of the protocol.
const PROTOCOL: u32 = 1;
/// No line is longer, or it is none of the protocol: nothing grows with what a program writes.
const LONGEST_LINE: u64 = 1 << 16;
/// So much of what it says on standard error is kept, the last of it.
const LAST_WORDS: usize = 400;
/// How often a wait looks whether the study was told to stop.
const LOOK: Duration = Duration::from_millis(20);
/// How long a program may take to end when nothing is asked any more.
const FAREWELL: Duration = Duration::from_secs(1);

/// What a program says first.
#[derive(Debug, Deserialize)]
pub(super) struct Greeting {
    protocol: u32,
    /// It holds the mesh, and can be asked.
    pub(super) holds: bool,
    /// Why not.
    pub(super) reason: Option<String>,
    /// The bytes that its structure holds, if it knows.
    pub(super) bytes: Option<usize>,
    /// What it measures: a library and its version.
    pub(super) library: Option<String>,
    /// Its allocator, if that can be told by the environment to keep pages: `glibc`.
    #[serde(default)]
    pub(super) heap: Option<String>,
}

/// What tells the GNU C library to keep freed pages, as this program tells its own.
const TUNABLES: [&str; 2] = [
    "GLIBC_TUNABLES",
    "glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=9223372036854775807:glibc.malloc.top_pad=1048576:glibc.malloc.arena_max=1",
];

impl Greeting {
    pub(super) fn refusing(reason: String) -> Self {
        Self {
            protocol: PROTOCOL,
            holds: false,
            reason: Some(reason),
            bytes: None,
            library: None,
            heap: None,
        }
    }

    /// Whether its allocator obeys the environment that it was started with.
    pub(super) fn keeps_pages_if_told(&self) -> bool {
        self.heap.as_deref() == Some("glibc")
    }
}

/// What is asked.
#[derive(Debug, Serialize)]
pub(super) struct Question {
    /// The operation.
    pub(super) run: &'static str,
    /// How often in a row.
    pub(super) times: u32,
}

/// What it answers.
#[derive(Debug, Deserialize)]
pub(super) struct Answer {
    /// Why it does not do that.
    pub(super) refused: Option<String>,
    /// Processor time of all runs together.
    pub(super) cpu_ns: Option<f64>,
    /// Wall time of all runs together.
    pub(super) wall_ns: Option<f64>,
    /// A number that depends on all results of one run.
    pub(super) checksum: Option<f64>,
    /// How many elements one run visits.
    pub(super) elements: Option<u64>,
}

/// A program that was started.
pub(super) struct Program<'a> {
    child: Child,
    input: Option<ChildStdin>,
    lines: Receiver<Line>,
    last_words: Arc<Mutex<Vec<u8>>>,
    patience: Duration,
    stop: &'a AtomicBool,
}

enum Line {
    Text(String),
    TooLong,
    End,
}

impl<'a> Program<'a> {
    /// Starts `words`; `Err` says why that did not work.
    pub(super) fn start(
        words: &[String],
        heap: Policy,
        patience: Duration,
        stop: &'a AtomicBool,
    ) -> Result<Self, String> {
        let mut command = Command::new(&words[0]);
        command.args(&words[1..]);
        if Self::is_told(heap) {
            let [tunables, kept] = TUNABLES;
            command.env(tunables, kept);
        }
        command.stdin(Stdio::piped());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C is for us: what we started is told by the end of its input.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let child = command.spawn();
        let mut child =
            child.map_err(|cause| format!("{} cannot be started: {cause}", words[0]))?;
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
        let last_words = Arc::new(Mutex::new(Vec::new()));
        let (kept, errors) = (Arc::clone(&last_words), child.stderr.take());
        thread::spawn(move || keep_the_end(errors?, &kept));
        Ok(Self {
            input: child.stdin.take(),
            child,
            lines,
            last_words,
            patience,
            stop,
        })
    }

    /// Whether programs are told to keep pages: not if the user has set the variable for that.
    pub(super) fn is_told(heap: Policy) -> bool {
        heap == Policy::Kept && std::env::var_os(TUNABLES[0]).is_none()
    }

    /// What it says of the mesh.
    pub(super) fn greeting(&mut self) -> Result<Greeting, String> {
        let greeting: Greeting = self.answer("at the start")?;
        if greeting.protocol != PROTOCOL {
            let other = greeting.protocol;
            return Err(format!(
                "it speaks version {other} of the protocol, and this is version {PROTOCOL}"
            ));
        }
        Ok(greeting)
    }

    /// Asks it, and waits for the answer.
    pub(super) fn ask(&mut self, question: &Question) -> Result<Answer, String> {
        // What is there already answers nothing, and would be taken for the answer to this.
        if let Ok(Line::Text(line)) = self.lines.try_recv() {
            self.kill();
            let shown = shown(&line);
            return Err(format!("it writes `{shown}` without being asked"));
        }
        let mut line = serde_json::to_string(question).map_err(|error| error.to_string())?;
        line.push('\n');
        let asked = self.input.as_mut().map(|input| {
            input.write_all(line.as_bytes())?;
            input.flush()
        });
        match asked {
            Some(Ok(())) => self.answer(&format!("to {}", question.run)),
            // It has closed its end: what it said last says why.
            _ => Err(self.ended()),
        }
    }

    fn answer<T: DeserializeOwned>(&mut self, to: &str) -> Result<T, String> {
        let start = Instant::now();
        let line = loop {
            match self.lines.recv_timeout(LOOK) {
                Ok(Line::Text(line)) => break line,
                Ok(Line::TooLong) => {
                    self.kill();
                    return Err(format!("it answers {to} with a line without end"));
                }
                Ok(Line::End) | Err(RecvTimeoutError::Disconnected) => return Err(self.ended()),
                Err(RecvTimeoutError::Timeout) if self.stop.load(Ordering::Relaxed) => {
                    self.kill();
                    return Err("the study was told to stop".into());
                }
                Err(RecvTimeoutError::Timeout) if start.elapsed() > self.patience => {
                    self.kill();
                    let seconds = self.patience.as_secs_f64();
                    return Err(format!(
                        "no answer {to} within {seconds} s, so it was ended"
                    ));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        };
        serde_json::from_str(&line).map_err(|error| {
            self.kill();
            let shown = shown(&line);
            format!("it answers {to} with `{shown}`, which is none of the protocol: {error}")
        })
    }

    /// That it has ended, how, and what it said last.
    fn ended(&mut self) -> String {
        let status = self.wait(FAREWELL);
        let how = match status {
            Some(status) => format!("it ended ({status})"),
            None => "it closed its output".into(),
        };
        self.kill();
        let words = self
            .last_words
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let words = String::from_utf8_lossy(&words);
        match words.trim().lines().last().map(tame) {
            Some(words) => format!("{how}: {words}"),
            None => how,
        }
    }

    /// Waits so long for its end.
    fn wait(&mut self, patience: Duration) -> Option<ExitStatus> {
        let start = Instant::now();
        loop {
            match self.child.try_wait() {
                Ok(None) if start.elapsed() < patience => thread::sleep(LOOK / 4),
                Ok(status) => return status,
                Err(_) => return None,
            }
        }
    }

    /// Ends it, and what it has started.
    fn kill(&mut self) {
        self.input = None;
        #[cfg(unix)]
        {
            use rustix::process::{Pid, Signal, kill_process_group};
            let _ = kill_process_group(Pid::from_child(&self.child), Signal::KILL);
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Program<'_> {
    /// No program outlives the study.
    fn drop(&mut self) {
        self.input = None;
        if self.wait(FAREWELL).is_none() {
            self.kill();
        }
    }
}

/// The beginning of a line that makes no sense.
fn shown(line: &str) -> String {
    tame(line).chars().take(80).collect()
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

/// Reads to the end, and keeps the last of it.
fn keep_the_end(mut errors: impl Read, kept: &Mutex<Vec<u8>>) -> Option<()> {
    let mut buffer = [0; LAST_WORDS];
    loop {
        let count = errors.read(&mut buffer).ok().filter(|&count| count > 0)?;
        let mut kept = kept.lock().ok()?;
        kept.extend_from_slice(&buffer[..count]);
        let spare = kept.len().saturating_sub(LAST_WORDS);
        kept.drain(..spare);
    }
}
