//! Warnings about possible faults of the measurement, each with a remedy.

use sixfold_results::launches::FEWEST_LAUNCHES;
use sixfold_results::ranking::FEWEST_OF_A_WINNER;
use sixfold_results::statistics::{DISTURBED, median};
use sixfold_results::{
    ClockKind, Control, Environment, Policy, ResultRow, Run, RunSettings, Samples, Timer,
};

/// Maximum share of disturbed samples on a quiet machine.
const FEW_DISTURBED: f64 = 0.1;
/// Maximum ratio of wall time to processor time on an unshared processor.
const INTERRUPTED: f64 = 1.05;
/// A page fault takes about this time at most: the kernel finds a page and fills it with zeros.
const FAULT_NS: f64 = 1000.0;
/// Maximum share of page faults in the time of a sample that does not matter.
const FAULTS_SEEN: f64 = 0.01;
/// Maximum half-width of a narrow interval, as a part of the time.
const WIDE: f64 = 0.1;
/// Maximum acceptable error of the clock, as a part of the shortest sample.
const COARSE: f64 = 0.01;
/// Maximum acceptable typical ratio between the two columns of a control.
const NOISY: f64 = 1.05;

/// Returns the warnings, the most serious first.
pub fn warnings(
    run: &Run,
    timer: &Timer,
    results: &[&ResultRow],
    samples: &[&Samples],
    control: Option<&Control>,
) -> Vec<String> {
    let environment = &run.environment;
    let all = [
        nothing_measured(results),
        pages_not_kept(environment),
        page_faults(environment, results),
        disturbed(samples),
        interrupted(samples),
        noisy(&run.settings, control, results),
        coarse(timer),
        wall_time_only(environment),
        few(&run.settings, results),
        wide(&run.settings, results),
        powersave(environment),
    ];
    all.into_iter().flatten().collect()
}

/// Returns the warnings that do not depend on the results.
pub fn machine_warnings(run: &Run, samples: &[&Samples]) -> Vec<String> {
    let environment = &run.environment;
    let all = [
        pages_not_kept(environment),
        disturbed(samples),
        interrupted(samples),
        wall_time_only(environment),
        powersave(environment),
    ];
    all.into_iter().flatten().collect()
}

fn nothing_measured(results: &[&ResultRow]) -> Option<String> {
    let mut measured = results.iter().filter(|row| row.median_ns.is_some());
    let nothing = measured.clone().next().is_some() && measured.all(|row| row.warm_up_only);
    nothing.then(|| {
        "The budget was too small for repeated runs: each time is from a single run. Use a longer \
         --budget or fewer --operations."
            .to_owned()
    })
}

/// Warns if pages are not kept although the settings request it, or if page faults are not counted.
fn pages_not_kept(environment: &Environment) -> Option<String> {
    let heap = environment.heap.as_ref()?;
    match &heap.reason {
        Some(reason) => Some(format!(
            "The system's heap was used: {reason}. The times of operations that allocate memory \
             include page faults and depend on earlier operations. Compare these times only with \
             results of --heap system."
        )),
        None if !heap.counts_faults => Some(
            "This platform does not count page faults, so samples with page faults cannot be \
             found. If the two times of the backend that is measured twice differ in an operation \
             that allocates memory, page faults may be the reason."
                .into(),
        ),
        None => None,
    }
}

/// Warns about samples in which page faults can take more than [`FAULTS_SEEN`] of the time, if pages are kept.
fn page_faults(environment: &Environment, results: &[&ResultRow]) -> Option<String> {
    let heap = environment.heap.as_ref()?;
    let has_faults = |row: &&&ResultRow| {
        let sample_ns = row.median_ns.unwrap_or(0.0) * f64::from(row.runs_per_sample);
        row.faults
            .is_some_and(|faults| FAULT_NS * faults as f64 > FAULTS_SEEN * sample_ns)
    };
    let rows = results.iter().filter(has_faults);
    let worst = rows.clone().max_by_key(|row| row.faults)?;
    let (count, faults) = (rows.count(), worst.faults.unwrap_or(0));
    let ResultRow {
        operation, backend, ..
    } = worst;
    (heap.policy == Policy::Kept).then(|| {
        format!(
            "{count} of {} figures include samples with page faults. The sample with the most \
             page faults has {faults} ({operation} on {backend}). Measure again with more free \
             memory.",
            results.len()
        )
    })
}

/// Warns if the machine was slower than usual in many of the samples.
fn disturbed(samples: &[&Samples]) -> Option<String> {
    let slowdowns = || samples.iter().flat_map(|samples| &samples.slowdowns);
    let slowed = slowdowns().filter(|&&slowdown| slowdown > DISTURBED);
    let share = slowed.count() as f64 / slowdowns().count().max(1) as f64;
    (share > FEW_DISTURBED).then(|| {
        format!(
            "Other programs disturbed {:.0} % of the samples. The ratios in this result are more \
             reliable than the times. Stop other programs and measure again.",
            100.0 * share
        )
    })
}

/// Warns if the wall time was much longer than the processor time in most of the samples.
fn interrupted(samples: &[&Samples]) -> Option<String> {
    let ratios = samples.iter().flat_map(|samples| {
        let cpu = samples.cpu_ns.iter().flatten();
        cpu.zip(&samples.wall_ns).map(|(cpu, wall)| wall / cpu)
    });
    let ratio = median(ratios.collect())?;
    (ratio > INTERRUPTED).then(|| {
        format!(
            "Other programs used the processor for {:.0} % of the time and disturbed the caches. \
             Stop the other programs, or pin the study to its own core.",
            100.0 * (1.0 - 1.0 / ratio)
        )
    })
}

fn noisy(
    settings: &RunSettings,
    control: Option<&Control>,
    results: &[&ResultRow],
) -> Option<String> {
    let control = control.filter(|control| control.typical > NOISY)?;
    // With fewer samples, there is no interval, and `few` warns of this.
    results.iter().find(|row| row.ci_low_ns.is_some())?;
    Some(format!(
        "Two measurements of one backend typically differ by {:.0} %: smaller differences between backends are not significant. Measure on a quieter machine, or with {}.",
        100.0 * (control.typical - 1.0),
        settings.more_samples()
    ))
}

fn coarse(timer: &Timer) -> Option<String> {
    let share = timer.largest_share?;
    (share > COARSE).then(|| {
        format!(
            "The clock is too coarse: its error is up to {:.1} % of the shortest sample. Study a larger mesh.",
            100.0 * share
        )
    })
}

fn wall_time_only(environment: &Environment) -> Option<String> {
    (environment.clock == ClockKind::Wall).then(|| {
        "This platform does not report the processor time of a thread, so the figures are wall \
         time. Other programs make wall time longer: keep the machine quiet."
            .to_owned()
    })
}

fn few(settings: &RunSettings, results: &[&ResultRow]) -> Option<String> {
    // A long scan is run once, because it is far from the fastest.
    let in_rounds = |row: &&&ResultRow| row.median_ns.is_some() && !row.warm_up_only;
    let measured = results.iter().filter(in_rounds);
    let all = measured.clone().count();
    let few = measured.filter(|row| !row.has_enough_samples()).count();
    let once = results.iter().all(|row| row.warm_up_only); // `nothing_measured` warns of this
    (few > 0 && !once).then(|| {
        format!(
            "{few} of {all} times are from fewer than {}, so they cannot be compared with the fastest. Use {}{}.",
            match settings.launches {
                None => format!("{FEWEST_OF_A_WINNER} samples"),
                Some(_) => format!("{FEWEST_LAUNCHES} launches"),
            },
            settings.more_samples(),
            match settings.rounds {
                None => " or fewer --operations",
                Some(_) => "",
            }
        )
    })
}

fn wide(settings: &RunSettings, results: &[&ResultRow]) -> Option<String> {
    let half_width = |row: &ResultRow| {
        let (low, high) = row.ci_low_ns.zip(row.ci_high_ns)?;
        let median = row.median_ns?;
        Some((median - low).max(high - median) / median)
    };
    let known: Vec<(f64, &ResultRow)> = results
        .iter()
        .copied()
        .filter(|row| row.has_enough_samples())
        .filter_map(|row| Some((half_width(row)?, row)))
        .collect();
    let wide = known.iter().filter(|(half_width, _)| *half_width > WIDE);
    let (count, all) = (wide.clone().count(), known.len());
    if 2 * count <= all {
        return None;
    }
    let (worst, row) = wide.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let widest = match *worst < 10.0 {
        true => format!("{:.0} %", 100.0 * worst),
        false => format!(
            "to {} times its time",
            sixfold_results::numbers::figure(1.0 + worst)
        ),
    };
    Some(format!(
        "{count} of {all} intervals extend more than {:.0} % from their time. The widest \
         interval extends {widest} ({} on {}). Use {} or a quieter machine.",
        100.0 * WIDE,
        row.operation,
        row.backend,
        settings.more_samples()
    ))
}

fn powersave(environment: &Environment) -> Option<String> {
    let governor = environment
        .governor
        .as_ref()
        .filter(|name| *name == "powersave")?;
    Some(format!(
        "The frequency governor of the processor is {governor}, so the frequency changes with the \
         load. To keep the frequency constant, run `cpupower frequency-set --governor performance`."
    ))
}

#[cfg(test)]
mod tests {
    use crate::Operation;

    use super::*;
    use sixfold_results::{Agreement, ControlRow, HeapReport, Standing};

    fn quiet() -> Run {
        let mut run = Run::default();
        run.start.load_average = Some(0.1);
        run.settings.budget_s = Some(20.0);
        run.environment = Environment {
            cores: Some(2),
            governor: Some("performance".into()),
            clock: ClockKind::ThreadCpu,
            ..Environment::default()
        };
        run
    }

    #[test]
    fn the_advice_names_the_option_that_was_used() {
        let mut run = quiet();
        let few = ResultRow {
            samples: 2,
            ..fine()
        };
        let advice = |run: &Run| warnings(run, &TIMER, &[&few], &[], None).join(" ");
        assert!(advice(&run).contains("Use a longer --budget or fewer --operations."));
        (run.settings.budget_s, run.settings.rounds) = (None, std::num::NonZeroU32::new(2));
        let advice = advice(&run);
        assert!(advice.contains("Use more --rounds."), "{advice}");
        assert!(!advice.contains("--budget"), "{advice}");
    }

    /// Returns the quiet run with another environment.
    fn with(change: impl FnOnce(&mut Environment)) -> Run {
        let mut run = quiet();
        change(&mut run.environment);
        run
    }

    /// Two page faults take about 2 µs.
    #[test]
    fn page_faults_are_named_if_they_can_take_a_part_of_the_time() {
        let heap = HeapReport {
            policy: Policy::Kept,
            reason: None,
            allocator: "glibc 2.36".into(),
            page_bytes: Some(4096),
            transparent_huge_pages: None,
            counts_faults: true,
        };
        let kept = with(|environment| environment.heap = Some(heap));
        let messages = |median_ns: f64, runs_per_sample: u32| {
            let row = ResultRow {
                median_ns: Some(median_ns),
                ci_low_ns: Some(median_ns),
                ci_high_ns: Some(median_ns),
                runs_per_sample,
                faults: Some(2),
                ..fine()
            };
            warnings(&kept, &TIMER, &[&row, &fine()], &[], None).join(" ")
        };
        let seen = messages(190_000.0, 1);
        assert!(
            seen.contains("1 of 2 figures include samples with page faults"),
            "{seen}"
        );
        for (median_ns, runs) in [(210_000.0, 1), (105_000.0, 2)] {
            let unseen = messages(median_ns, runs);
            assert!(!unseen.contains("page faults"), "{unseen}");
        }
    }

    /// Returns six samples without disturbances.
    fn undisturbed() -> Samples {
        Samples {
            backend: "half-edge".into(),
            operation: "build".into(),
            control: false,
            rounds: (0..6).collect(),
            cpu_ns: Some(vec![100.0; 6]),
            wall_ns: vec![104.0; 6],
            faults: None,
            slowdowns: vec![1.2; 6],
            ..Samples::default()
        }
    }

    fn fine() -> ResultRow {
        ResultRow {
            wall_median_ns: Some(100.0),
            ci_low_ns: Some(99.0),
            ci_high_ns: Some(101.0),
            samples: 20,
            median_ns: Some(100.0),
            elements: Some(1),
            ns_per_element: Some(100.0),
            agreement: Agreement::Same,
            standing: Some(Standing::Best),
            ratio_to_best: Some(1.0),
            ..ResultRow::new(
                "half-edge",
                Operation::Build.name(),
                Operation::Build.unit(),
            )
        }
    }

    const TIMER: Timer = Timer {
        resolution_ns: 20.0,
        overhead_ns: 600.0,
        uncertainty_ns: 100.0,
        largest_share: Some(0.0005),
        shortest_ns: Some(200_000.0),
    };

    #[test]
    fn a_good_run_has_no_warnings() {
        let messages = warnings(&quiet(), &TIMER, &[&fine()], &[&undisturbed()], None);
        assert_eq!(messages, [""; 0]);
    }

    #[test]
    fn each_fault_has_a_warning_with_a_remedy() {
        let good = quiet();
        let control = Control {
            backend: "half-edge".into(),
            operations: vec![ControlRow {
                operation: Operation::Build.name().into(),
                ratio: 1.2,
                ci_low: None,
                ci_high: None,
                launches: Vec::new(),
            }],
            typical: 1.2,
            worst: 1.2,
        };
        let coarse = Timer {
            largest_share: Some(0.05),
            shortest_ns: Some(2000.0),
            ..TIMER
        };
        let wall = with(|environment| environment.clock = ClockKind::Wall);
        let powersave = with(|environment| environment.governor = Some("powersave".into()));
        let mut busy = undisturbed();
        busy.slowdowns = [1.0, 1.4, 1.3, 1.0, 1.0, 1.0].into();
        let mut shared = undisturbed();
        shared.wall_ns = [100.0, 125.0, 125.0, 125.0, 500.0, 100.0].into();
        let wide = ResultRow {
            ci_high_ns: Some(134.0),
            ..fine()
        };
        let few = ResultRow {
            samples: 3,
            ..fine()
        };
        let once = ResultRow {
            samples: 1,
            warm_up_only: true,
            ci_low_ns: None,
            ci_high_ns: None,
            ..fine()
        };
        let cases = [
            (
                warnings(&good, &TIMER, &[&fine()], &[&busy], None),
                "disturbed 17 % of the samples",
                "Stop other programs",
            ),
            (
                warnings(&wall, &TIMER, &[&fine()], &[], None),
                "wall time",
                "quiet",
            ),
            (
                warnings(&powersave, &TIMER, &[&fine()], &[], None),
                "powersave",
                "cpupower",
            ),
            (
                warnings(&good, &coarse, &[&fine()], &[], None),
                "5.0 % of the shortest",
                "larger mesh",
            ),
            (
                warnings(&good, &TIMER, &[&fine()], &[], Some(&control)),
                "by 20 %",
                "--budget",
            ),
            (
                warnings(&good, &TIMER, &[&fine()], &[&shared], None),
                "for 20 % of the time",
                "pin",
            ),
            (
                warnings(&good, &TIMER, &[&fine(), &wide, &wide], &[], None),
                "2 of 3 intervals",
                "--budget",
            ),
            (
                warnings(&good, &TIMER, &[&fine(), &few], &[], None),
                "1 of 2 times",
                "--budget",
            ),
            (
                warnings(&good, &TIMER, &[&once], &[], None),
                "each time is from a single run",
                "--operations",
            ),
        ];
        let half = warnings(&good, &TIMER, &[&fine(), &wide], &[], None);
        assert_eq!(half, [""; 0], "most intervals are narrow");
        for (messages, fault, remedy) in cases {
            let [message] = &messages[..] else {
                panic!("{fault}: {messages:?}");
            };
            assert!(
                message.contains(fault) && message.contains(remedy),
                "{message}"
            );
        }
    }
}
