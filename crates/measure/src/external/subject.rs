//! An external program as a backend of the measurement.

use crate::{Clock, Job, Outcome, Series, TimedBackend, TimedRun};
use sixfold::QueryCost;
use sixfold_results::{Time, sanitize};

use super::program::{Program, Request, Response};

/// Maximum ratio of the time that a program reports to the time that Sixfold waited.
const CLOCK_TOLERANCE: f64 = 1.01;

/// An external program that holds the mesh. After a failure, it holds the error instead of the
/// program.
pub struct ExternalSubject<'a> {
    name: String,
    bytes: usize,
    program: Result<Program<'a>, String>,
}

impl<'a> ExternalSubject<'a> {
    pub fn new(name: String, bytes: usize, program: Program<'a>) -> Self {
        Self {
            name,
            bytes,
            program: Ok(program),
        }
    }

    /// Sends a request that is not timed. After an error, the program is not used again.
    pub fn request(&mut self, run: &'static str, times: u32) -> Result<Response, String> {
        let answer = self.running()?.ask(&Request { run, times });
        self.keep_failure(answer)
    }

    /// Sends `request` and checks the reported time. The time is `None` if the program refuses.
    /// After an error or an impossible time, the program is not used again.
    fn ask(
        &mut self,
        request: &Request,
        clock: &dyn Clock,
    ) -> Result<(Response, Option<Time>), String> {
        let program = self.running()?;
        let before = clock.now();
        let answer = program.ask(request).and_then(|response| {
            let waited = clock.now().wall_ns - before.wall_ns;
            let time = match response.refused {
                Some(_) => None,
                None => Some(time(&response, waited, before.cpu_ns.is_some())?),
            };
            Ok((response, time))
        });
        self.keep_failure(answer)
    }

    /// Returns the program if it has not failed.
    fn running(&mut self) -> Result<&mut Program<'a>, String> {
        let failed = |why: &mut String| format!("it failed earlier: {why}");
        self.program.as_mut().map_err(failed)
    }

    fn keep_failure<T>(&mut self, answer: Result<T, String>) -> Result<T, String> {
        if let Err(why) = &answer {
            self.program = Err(why.clone());
        }
        answer
    }

    /// Runs what the program calls `name`, as `series` describes.
    pub fn run_named(&mut self, name: &'static str, series: &Series<'_>) -> TimedRun {
        let clock = series.clock;
        let refused = |refusal: String| TimedRun::refused(refusal, series);
        let request = |times: u32| Request { run: name, times };
        if series.untimed > 0
            && let Err(why) = self.ask(&request(series.untimed), clock)
        {
            return refused(why);
        }
        series.begin();
        match self.ask(&request(series.runs), clock) {
            Ok((response, Some(time))) => {
                let found = response.checksum.zip(response.elements);
                let outcome = found.map(|(checksum, elements)| Outcome {
                    checksum,
                    elements,
                    refused: 0,
                });
                TimedRun::done(time.scaled(1.0 / f64::from(series.runs)), outcome)
            }
            Ok((response, None)) => refused(sanitize(&response.refused.unwrap_or_default())),
            Err(why) => refused(why),
        }
    }
}

impl TimedBackend for ExternalSubject<'_> {
    fn name(&self) -> &str {
        &self.name
    }

    fn is_external(&self) -> bool {
        true
    }

    fn failure(&self) -> Option<&str> {
        self.program.as_ref().err().map(String::as_str)
    }

    fn can_sample(&self) -> bool {
        false
    }

    /// Returns placeholders, because the costs are unknown.
    fn costs(&self) -> [QueryCost; 9] {
        [QueryCost::Local; 9]
    }

    fn merged_vertices(&self) -> usize {
        0
    }

    fn bytes(&self) -> usize {
        self.bytes
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        if job.sample.is_some() {
            let reason = "an external program cannot time a sample of the elements";
            return TimedRun::refused(reason.into(), series);
        }
        match job.task.operation() {
            Some(operation) => self.run_named(operation.name(), series),
            None => TimedRun::refused("it cannot run workloads".into(), series),
        }
    }
}

/// Returns the reported time. Returns an error if the time is missing or impossible.
fn time(response: &Response, waited_ns: f64, cpu: bool) -> Result<Time, String> {
    let Some(wall_ns) = response.wall_ns else {
        return Err("its answer has no `wall_ns` (the time of the runs)".into());
    };
    let times = [Some(wall_ns), response.cpu_ns.filter(|_| cpu)];
    for ns in times.into_iter().flatten() {
        if !(0.0..=waited_ns * CLOCK_TOLERANCE).contains(&ns) {
            return Err(format!(
                "it reports {ns} ns, but its answer took {waited_ns:.0} ns: report the total time \
                 of all runs on one thread, in nanoseconds"
            ));
        }
    }
    Ok(Time {
        cpu_ns: match cpu {
            true => Some(response.cpu_ns.unwrap_or(wall_ns)),
            false => None,
        },
        wall_ns,
        faults: None,
    })
}
