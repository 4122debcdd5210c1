//! The description of the methods: how the results were measured, as text for a paper. Each sentence is
//! written only if the results show that it is true.

use std::fmt::Write as _;

use sixfold_results::launches::{ALIKE, LASTING_IN_RATIOS, LASTING_IN_TIMES};
use sixfold_results::numbers::{bytes, counted, grouped};
use sixfold_results::ranking::FEWEST_OF_A_WINNER;
use sixfold_results::{
    CacheState, ClockKind, Environment, Figure as TimeRow, Finding, Policy, Report, Results, Run,
    Status,
};

use crate::data::dates;
use crate::figures::facts;
use crate::markdown::escape;

/// The largest number of meshes that the text describes one by one.
const MAX_LISTED_MESHES: usize = 12;

/// The sources of the statistical methods.
const REFERENCES: &str = "References: J. W. Tukey, Exploratory Data Analysis, 1977 (median polish). B. Schmeiser, Batch size \
                          effects in the analysis of simulation output, Operations Research 30, 1982. T. Kalibera and \
                          R. Jones, Rigorous benchmarking in reasonable time, ISMM 2013.";

/// Returns the description of the methods as Markdown.
pub(super) fn methods(results: &Results) -> String {
    let paragraphs = paragraphs(results);
    let mut text = "# Methods\n".to_owned();
    if paragraphs.is_empty() {
        text.push_str("\nThe results have no measurements.\n");
    }
    for paragraph in paragraphs {
        let _ = writeln!(text, "\n{}", escape(&paragraph));
    }
    text
}

/// Returns the description of the methods: a paragraph, and the references if it has any. Empty without
/// measurements.
pub(crate) fn paragraphs(results: &Results) -> Vec<String> {
    if results.findings.is_empty() {
        return Vec::new();
    }
    let rows: Vec<TimeRow<'_>> = results.findings.iter().flat_map(Finding::figures).collect();
    let mut sentences = subject(results, &rows);
    sentences.extend(machines(results));
    if rows.iter().any(is_timed) {
        sentences.extend(memory(results));
        sentences.extend(sampling(results, &rows));
        sentences.extend(statistics(results, &rows));
    }
    sentences.extend(left_out(results, &rows));
    let references = is_corrected(&rows).then(|| REFERENCES.to_owned());
    [sentences.join(" ")]
        .into_iter()
        .chain(references)
        .collect()
}

fn is_timed(row: &TimeRow<'_>) -> bool {
    matches!(row.status, Status::Measured | Status::Sampled)
}

/// Returns whether the times are corrected for the drift of the machine. Older documents have no
/// corrected times.
fn is_corrected(rows: &[TimeRow<'_>]) -> bool {
    rows.iter().any(|row| row.row.uncorrected_ns.is_some())
}

/// Returns the values of all findings, each once with the names of the commands that have it:
/// `20 s`, or `20 s (study), 5 s (orders, growth)`. `None` if no finding has a value.
fn by_command(results: &Results, value: impl Fn(&Finding) -> Option<String>) -> Option<String> {
    let mut values: Vec<(String, Vec<&str>)> = Vec::new();
    for finding in &results.findings {
        let Some(value) = value(finding) else {
            continue;
        };
        let kind = finding.kind();
        match values.iter_mut().find(|(known, _)| *known == value) {
            Some((_, kinds)) if kinds.contains(&kind) => {}
            Some((_, kinds)) => kinds.push(kind),
            None => values.push((value, vec![kind])),
        }
    }
    match &values[..] {
        [] => None,
        [(value, _)] => Some(value.clone()),
        several => {
            let named = several
                .iter()
                .map(|(value, kinds)| format!("{value} ({})", kinds.join(", ")));
            Some(named.collect::<Vec<_>>().join("; "))
        }
    }
}

fn by_run(results: &Results, value: impl Fn(&Run) -> Option<String>) -> Option<String> {
    by_command(results, |finding| value(finding.run()))
}

/// What was measured: the program, the backends, and the meshes.
fn subject(results: &Results, rows: &[TimeRow<'_>]) -> Vec<String> {
    let mut sentences = Vec::new();
    let version = by_run(results, |run| {
        let Environment {
            sixfold, commit, ..
        } = &run.environment;
        Some(match commit {
            Some(commit) => format!("{sixfold} at commit {commit}"),
            None => format!("{sixfold}, commit unknown"),
        })
    });
    let mut kinds: Vec<&str> = Vec::new();
    for finding in &results.findings {
        if !kinds.contains(&finding.kind()) {
            kinds.push(finding.kind());
        }
    }
    let commands: Vec<String> = kinds.iter().map(|kind| format!("sixfold {kind}")).collect();
    let times = results.findings.iter().map(|f| f.run().start.unix_time);
    let times = times.filter(|&time| time > 0);
    let (first, last) = (times.clone().min(), times.max());
    let on = first.zip(last);
    let on = on.map_or_else(String::new, |(first, last)| {
        format!(" on {}", dates(first, last))
    });
    sentences.push(format!(
        "The measurements were made with Sixfold {} by {}{on}.",
        version.unwrap_or_default(),
        commands.join(", ")
    ));
    let mut backends: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| row.is_measured()) {
        if !backends.contains(&row.row.backend.as_str()) {
            backends.push(&row.row.backend);
        }
    }
    if !backends.is_empty() {
        let count = counted(backends.len(), "backend was", "backends were");
        sentences.push(format!("{count} measured: {}.", backends.join(", ")));
    }
    sentences.extend(externals(results));
    sentences.extend(meshes(results));
    sentences
}

/// The external programs.
fn externals(results: &Results) -> Option<String> {
    let mut programs: Vec<&str> = Vec::new();
    for backend in results.studies().flat_map(|study| &study.backends) {
        if backend.external.is_some() && !programs.contains(&backend.name.as_str()) {
            programs.push(&backend.name);
        }
    }
    (!programs.is_empty()).then(|| {
        format!(
            "External programs, which run as processes of their own: {}.",
            programs.join(", ")
        )
    })
}

/// The facts of the meshes: one by one, or as ranges.
fn meshes(results: &Results) -> Vec<String> {
    let sizes = results.growth().map(|growth| {
        let ends = growth.sizes.first().zip(growth.sizes.last());
        let ends = ends.map_or_else(String::new, |(first, last)| {
            let [first, last] = [first.faces, last.faces].map(grouped);
            format!(" from {first} to {last} faces")
        });
        let sizes = counted(growth.sizes.len(), "size", "sizes");
        let (shape, order) = (&growth.shape, &growth.order);
        format!("The growth with the mesh size was measured on the shape {shape} in {sizes}{ends}, in the order {order}.")
    });
    let sizes: Vec<String> = sizes.collect();
    [described_meshes(results), sizes].concat()
}

/// The facts of all meshes that were not made for a growth.
fn described_meshes(results: &Results) -> Vec<String> {
    let mut meshes = Vec::new();
    let given = results.findings.iter();
    let given = given.filter(|finding| !matches!(finding, Finding::Growth(_)));
    for mesh in given.flat_map(Finding::meshes) {
        if !meshes.contains(&mesh) {
            meshes.push(mesh);
        }
    }
    let faces = meshes.iter().map(|mesh| mesh.facts.faces);
    let Some((fewest, most)) = faces.clone().min().zip(faces.max()) else {
        return Vec::new();
    };
    if meshes.len() <= MAX_LISTED_MESHES {
        let described = meshes.iter().map(|mesh| {
            let hash = mesh.sha256.get(..12).unwrap_or(&mesh.sha256);
            let facts = facts(mesh);
            let facts = facts.trim_end_matches('.');
            format!("{} ({facts}; SHA-256 {hash}…)", mesh.name)
        });
        let described: Vec<String> = described.collect();
        let noun = if described.len() == 1 {
            "mesh"
        } else {
            "meshes"
        };
        return vec![format!("The {noun}: {}.", described.join(", "))];
    }
    vec![format!(
        "There were {} with {} to {} faces.",
        counted(meshes.len(), "mesh", "meshes"),
        grouped(fewest),
        grouped(most)
    )]
}

/// The machines and the builds.
fn machines(results: &Results) -> Vec<String> {
    let machine = by_run(results, |run| Some(hardware(&run.environment)));
    let build = by_run(results, |run| Some(build(&run.environment)));
    let mut sentences = Vec::new();
    if let Some(machine) = machine {
        let count = distinct(results, |run| hardware(&run.environment));
        sentences.push(match count {
            0 | 1 => format!("The machine: {machine}."),
            _ => format!("The results come from {count} machines: {machine}."),
        });
    }
    if let Some(build) = build {
        sentences.push(format!("The program was compiled with {build}."));
    }
    let loads = results.findings.iter();
    let loads = loads.filter_map(|finding| finding.run().start.load_average);
    let load = loads.fold(None, |most: Option<f64>, load| {
        Some(most.map_or(load, |most| most.max(load)))
    });
    if let Some(load) = load {
        sentences.push(format!(
            "In the minute before a measurement, at most {load:.1} threads were runnable on average."
        ));
    }
    sentences
}

fn distinct(results: &Results, value: impl Fn(&Run) -> String) -> usize {
    let mut values: Vec<String> = results.findings.iter().map(|f| value(f.run())).collect();
    values.sort_unstable();
    values.dedup();
    values.len()
}

fn hardware(environment: &Environment) -> String {
    let Environment {
        os,
        kernel,
        arch,
        cpu_model,
        cores,
        caches,
        memory_bytes,
        governor,
        boost,
        ..
    } = environment;
    let mut parts = vec![cpu_model.as_ref().unwrap_or(arch).clone()];
    parts.extend(cores.map(|cores| counted(cores, "hardware thread", "hardware threads")));
    let data = caches.iter().filter(|cache| cache.holds_data());
    let data: Vec<String> = data
        .map(|cache| format!("L{} {}", cache.level, bytes(size(cache.bytes))))
        .collect();
    if !data.is_empty() {
        parts.push(format!("data caches {}", data.join(", ")));
    }
    parts.extend(memory_bytes.map(|total| format!("{} of memory", bytes(size(total)))));
    parts.push(match kernel {
        Some(kernel) => format!("{os} {kernel}"),
        None => os.clone(),
    });
    parts.extend(
        governor
            .as_ref()
            .map(|governor| format!("frequency governor {governor}")),
    );
    parts.extend(boost.map(|boost| match boost {
        true => "boost on".into(),
        false => "boost off".into(),
    }));
    parts.join(", ")
}

fn size(bytes: u64) -> usize {
    usize::try_from(bytes).unwrap_or(usize::MAX)
}

fn build(environment: &Environment) -> String {
    let Environment {
        rustc,
        profile,
        opt_level,
        rustflags,
        target,
        ..
    } = environment;
    let rustc = rustc.split(" (").next().unwrap_or_default();
    let flags = match rustflags.trim() {
        "" => "no additional flags".into(),
        flags => format!("the flags {flags}"),
    };
    format!("{rustc} for {target} (profile {profile}, optimisation level {opt_level}, {flags})")
}

/// The clock, the heap and the caches.
fn memory(results: &Results) -> Vec<String> {
    let clock = by_run(results, |run| {
        Some(match run.environment.clock {
            ClockKind::ThreadCpu => "the processor time of the measuring thread".into(),
            ClockKind::Wall => "the wall time".into(),
        })
    });
    let heap = by_run(results, |run| {
        let heap = run.environment.heap.as_ref()?;
        let allocator = &heap.allocator;
        Some(match heap.policy {
            Policy::Kept => {
                format!("the process kept freed memory pages for later runs ({allocator})")
            }
            Policy::System => {
                format!("the allocator decided which freed pages it kept ({allocator})")
            }
        })
    });
    let caches = by_run(results, |run| {
        let caches = run.environment.cache_state.as_ref()?;
        Some(match caches.state {
            CacheState::Warm => "the processor caches were warm".into(),
            CacheState::Cold => format!(
                "the processor caches were cold: each sample is one run, and before each run {} of other \
                 data were written",
                bytes(caches.written_bytes)
            ),
        })
    });
    let mut sentences = vec![format!("The clock measured {}.", clock.unwrap_or_default())];
    let rest: Vec<String> = heap.into_iter().chain(caches).collect();
    if !rest.is_empty() {
        sentences.push(format!("Memory: {}.", rest.join("; ")));
    }
    sentences
}

/// The rounds, the budget, the seed, and the samples.
fn sampling(results: &Results, rows: &[TimeRow<'_>]) -> Vec<String> {
    let mut sentences = Vec::new();
    let rounds = by_run(results, |run| {
        let rounds = run.settings.rounds?.get();
        Some(counted(rounds as usize, "round", "rounds"))
    });
    let budget = by_run(results, |run| match run.settings.rounds {
        Some(_) => None,
        None => run.settings.budget_s.map(|_| run.settings.effort_text()),
    });
    sentences.push(
        "Times were measured in rounds: in each round, the backends run a task one after the other, in a new random \
         order."
            .into(),
    );
    sentences.extend(rounds.map(|rounds| {
        format!("The number of rounds was given in advance, without a time limit: {rounds}.")
    }));
    sentences.extend(budget.map(|budget| {
        format!(
            "As many rounds were run as fit into a time budget for each measurement: {budget}. Slow tasks take part \
             in fewer rounds."
        )
    }));
    let seed = by_run(results, |run| Some(run.settings.seed.to_string()));
    sentences.extend(seed.map(|seed| format!("The seed of the random numbers was {seed}.")));
    let samples = rows.iter().filter(|row| is_timed(row));
    let samples = samples.map(|row| row.row.samples).filter(|&n| n > 0);
    if let (Some(fewest), Some(most)) = (samples.clone().min(), samples.max()) {
        let count = match fewest == most {
            true => counted(most, "sample", "samples"),
            false => format!("{fewest} to {}", counted(most, "sample", "samples")),
        };
        sentences.push(format!(
            "A sample is the mean time of one or more consecutive runs; each time has {count}."
        ));
    }
    let disturbed: usize = rows.iter().map(|row| row.row.disturbed).sum();
    let retaken: usize = rows.iter().map(|row| row.row.retaken as usize).sum();
    if retaken > 0 {
        let retaken = counted(retaken, "sample was", "samples were");
        sentences.push(format!(
            "{retaken} measured again because of page faults or other programs."
        ));
    }
    if disturbed > 0 {
        let disturbed = counted(disturbed, "sample does", "samples do");
        sentences.push(format!(
            "{disturbed} not count because other programs slowed the machine down."
        ));
    }
    sentences
}

/// How times and intervals are computed from samples.
fn statistics(results: &Results, rows: &[TimeRow<'_>]) -> Vec<String> {
    let timed = || rows.iter().filter(|row| is_timed(row));
    let several = timed().any(|row| !row.row.launch_ns.is_empty());
    let one = timed().any(|row| row.row.launch_ns.is_empty());
    let mut sentences = vec![match is_corrected(rows) {
        true if several => "Each command ran in several launches, which are fresh processes. A time in a launch is the median of its \
                 samples, corrected for the drift of the machine from round to round: the model ln time = round + backend \
                 + residual is fitted by median polish (Tukey 1977). A time is the geometric mean over the launches."
            .into(),
        true => "A time is the median of the samples, corrected for the drift of the machine from round to round: the \
                 model ln time = round + backend + residual is fitted by median polish (Tukey 1977)."
            .into(),
        false => "A time is the median of the samples.".to_owned(),
    }];
    let has_interval = |row: &TimeRow<'_>| row.row.ci_low_ns.is_some();
    let confidence = by_command(results, |finding| {
        let confidence = finding.run().settings.confidence;
        (finding.figures().iter().any(is_timed)).then(|| confidence.to_string())
    });
    let confidence = confidence.unwrap_or_default();
    if several {
        sentences.push(
            format!(
                "Intervals of results with several launches are {confidence} confidence intervals of the mean of the logarithms over the \
                 launches, by Student's distribution; a ratio is formed within each launch (Kalibera and Jones 2013, 2020), and \
                 its mean leaves out the largest and the smallest fifth (Tukey and McLaughlin 1963). The variance of a mean is \
                 {ALIKE} times that of independent launches. For what differs from study to study, the intervals of ratios also \
                 include {LASTING_IN_RATIOS} of the variance from launch to launch, and those of times {LASTING_IN_TIMES}."
            ),
        );
    }
    if one && is_corrected(rows) && rows.iter().any(has_interval) {
        sentences.push(format!(
            "Intervals of results with one launch are {confidence} confidence intervals from batch means with six batches (Schmeiser 1982) by Student's \
             distribution, widened for a drift from study to study with a standard deviation of 1 % (Kalibera and \
             Jones 2013)."
        ));
    }
    if rows.iter().any(|row| row.row.standing.is_some()) {
        sentences.push(format!(
            "A backend is equal to the fastest if the whole {confidence} interval of its ratio lies within 5 % of 1. It is undecided \
             whether it is slower if the interval contains 1 and is wider, or if the ratio is at most the noise (the \
             difference between the two measurements of the control, and at least 2 %). A backend with a time in only one of \
             several launches, or with fewer than {FEWEST_OF_A_WINNER} samples of the only launch, is not ranked."
        ));
    }
    let controls = results.studies().filter_map(|study| study.control.as_ref());
    let controls: Vec<_> = controls.collect();
    if !controls.is_empty() {
        let worst = controls
            .iter()
            .map(|control| control.worst)
            .fold(1.0, f64::max);
        sentences.push(format!(
            "In each study, one backend was measured twice as a control; the two times differ by at most {:.1} %.",
            100.0 * (worst - 1.0)
        ));
    }
    if results.studies().count() > 1 {
        sentences.push(
            "Means over the meshes are geometric means, and their ratios are relative to the smallest mean; each \
             power of ten of the number of faces has equal weight. Their intervals come from the variation of the logarithms from \
             mesh to mesh by Student's distribution, for six or more meshes; where the intervals of the single meshes give a \
             wider one, it is used. With fewer meshes, the least and the largest ratio of a mesh are given, and a mean is the \
             smallest if every other one is larger on each mesh, by more than 5 %."
                .into(),
        );
    }
    sentences
}

/// What was sampled, estimated or left out.
fn left_out(results: &Results, rows: &[TimeRow<'_>]) -> Vec<String> {
    let count = |status: Status| rows.iter().filter(|row| row.status == status).count();
    let mut sentences = Vec::new();
    for (status, singular, plural, text) in [
        (
            Status::Sampled,
            "time was",
            "times were",
            "measured on randomly chosen elements and scaled to the whole mesh",
        ),
        (
            Status::Estimated,
            "time is",
            "times are",
            "only estimated as a lower bound, because a run would exceed the budget; lower bounds are not ranked",
        ),
        (
            Status::Refused,
            "combination of an operation and a backend is",
            "combinations of an operation and a backend are",
            "not possible on the mesh",
        ),
        (
            Status::NotRun,
            "time is missing",
            "times are missing",
            "because the budget ended",
        ),
    ] {
        let number = count(status);
        if number > 0 {
            sentences.push(format!("{} {text}.", counted(number, singular, plural)));
        }
    }
    sentences.extend(results.studies().filter_map(refusing_backends));
    for failed in &results.failures {
        let reason = failed.reason.trim_end_matches('.');
        sentences.push(format!(
            "The mesh {} was not studied: {reason}.",
            failed.mesh
        ));
    }
    let missing: Vec<&str> = results.missing().collect();
    if !missing.is_empty() {
        sentences.push(format!("Not studied yet: {}.", missing.join(", ")));
    }
    if results.is_interrupted() {
        sentences.push("The measurement was interrupted, so the results are incomplete.".into());
    }
    sentences
}

/// The backends that cannot hold the mesh of a study.
fn refusing_backends(study: &Report) -> Option<String> {
    let refusing = study.backends.iter().filter(|backend| !backend.holds);
    let refusing: Vec<&str> = refusing.map(|backend| backend.name.as_str()).collect();
    (!refusing.is_empty()).then(|| {
        format!(
            "Backends that cannot hold {}: {}.",
            study.mesh.name,
            refusing.join(", ")
        )
    })
}
