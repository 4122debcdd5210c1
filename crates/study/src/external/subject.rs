//! A program on the bench, beside the structures.

use sixfold::QueryCost;
use workload::{Clock, Job, Outcome, Run, Series, Subject, Time};

use super::program::{Answer, Program, Question};
use crate::tame::tame;

/// How much longer than our wait a program's own figure may be: two clocks.
const CLOCKS: f64 = 1.01;

/// A program that holds the mesh; without the program once it has failed.
pub(super) struct ExternalSubject<'a> {
    name: String,
    bytes: usize,
    program: Result<Program<'a>, String>,
}

impl<'a> ExternalSubject<'a> {
    pub(super) fn new(name: String, bytes: usize, program: Program<'a>) -> Self {
        Self {
            name,
            bytes,
            program: Ok(program),
        }
    }

    /// Asks, and does without the program from then on if that fails, or if its time cannot be; no time
    /// where it refuses.
    fn ask(
        &mut self,
        question: &Question,
        clock: &dyn Clock,
    ) -> Result<(Answer, Option<Time>), String> {
        let program = self.program.as_mut().map_err(|why| why.clone())?;
        let before = clock.now();
        let answered = program.ask(question).and_then(|answer| {
            let waited = clock.now().wall_ns - before.wall_ns;
            let time = match answer.refused {
                Some(_) => None,
                None => Some(time(&answer, waited, before.cpu_ns.is_some())?),
            };
            Ok((answer, time))
        });
        if let Err(why) = &answered {
            self.program = Err(format!("it had failed before: {why}"));
        }
        answered
    }
}

impl Subject for ExternalSubject<'_> {
    fn name(&self) -> &str {
        &self.name
    }

    fn is_external(&self) -> bool {
        true
    }

    /// Nobody knows; it is timed as a whole, whatever it does.
    fn costs(&self) -> [QueryCost; 9] {
        [QueryCost::Local; 9]
    }

    fn merged_vertices(&self) -> usize {
        0
    }

    fn bytes(&self) -> usize {
        self.bytes
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> Run {
        let clock = series.clock;
        let none = Time::none_like(clock.now());
        let refused = |refusal: String| Run {
            time: none,
            outcome: None,
            refusal: Some(refusal),
        };
        if job.sample.is_some() {
            return refused("it cannot be asked about a sample".into());
        }
        let question = |times: u32| Question {
            run: job.operation.name(),
            times,
        };
        if series.untimed > 0
            && let Err(why) = self.ask(&question(series.untimed), clock)
        {
            return refused(why);
        }
        series.begin();
        match self.ask(&question(series.runs), clock) {
            Ok((answer, Some(time))) => {
                let found = answer.checksum.zip(answer.elements);
                let outcome = found.map(|(checksum, elements)| Outcome { checksum, elements });
                Run::done(time.scaled(1.0 / f64::from(series.runs)), outcome)
            }
            Ok((answer, None)) => refused(tame(&answer.refused.unwrap_or_default())),
            Err(why) => refused(why),
        }
    }
}

/// The time that it tells, if that can be.
fn time(answer: &Answer, waited_ns: f64, cpu: bool) -> Result<Time, String> {
    let Some(wall_ns) = answer.wall_ns else {
        return Err("it answers without `wall_ns`, the time of the runs".into());
    };
    let times = [Some(wall_ns), answer.cpu_ns.filter(|_| cpu)];
    for ns in times.into_iter().flatten() {
        if !(0.0..=waited_ns * CLOCKS).contains(&ns) {
            return Err(format!(
                "it claims {ns} ns, and was waited for {waited_ns:.0} ns: times are nanoseconds of all runs together, on one thread"
            ));
        }
    }
    Ok(Time {
        cpu_ns: match cpu {
            true => Some(answer.cpu_ns.unwrap_or(wall_ns)),
            false => None,
        },
        wall_ns,
        faults: None,
    })
}
