//! The measurement on one mesh, and the ranking that results.

use std::collections::BTreeSet;

use crate::{Operation, Task, TimedBackend};
use sixfold::{Relation, StructureInfo};
use sixfold_core::Counts;
use sixfold_results::{
    Agreement, BreakEven, Confidence, Excluded, MeshReport, Ranked, Samples, Standing, Time,
    corrected_times,
};

use crate::engine::bench::{Bench, Columns, Trial, TrialResult};
use crate::engine::effort::Effort;
use crate::engine::measure::{Entry, Progress};
use crate::pick::break_even::{MeasuredMix, break_even};
use crate::pick::kinds::kinds;
use crate::pick::tasks::TaskPlan;
use crate::study_mesh::StudyMesh;
use crate::study_mesh::is_skewed;
use sixfold_results::launches::times_over_launches;
use sixfold_results::ranking::{NO_DIFFERENCE, rank, ratio};
use sixfold_results::statistics::Median;

/// The properties of a backend that the evaluation needs. Its index is that of the measured
/// subject.
pub struct Candidate {
    pub name: String,
    /// The properties of the structure; `None` for relation tables, and if only a program runs.
    pub info: Option<StructureInfo>,
    pub made_from: Option<&'static str>,
    /// The paths of the types that a program needs to use the backend.
    pub type_paths: Vec<&'static str>,
    /// The relations of relation tables.
    pub tabulated: Vec<Relation>,
    /// By part of the mix: whether one operation scans all faces.
    pub scans: Vec<bool>,
    pub bytes: usize,
}

impl Candidate {
    /// Returns whether some part scans all faces. If so, the parts are timed one by one: the part
    /// that scans dominates the others, and the state of the caches hardly matters.
    pub fn scans(&self) -> bool {
        self.scans.contains(&true)
    }
}

/// The properties of a backend, and the backend.
pub type MeasuredBackend<'b> = (Candidate, Box<dyn TimedBackend + 'b>);

/// The measurement of the backends of a pick on one mesh.
pub struct PickMeasurement<'c, 'm> {
    pub study_mesh: &'c StudyMesh,
    pub plan: &'c dyn TaskPlan,
    pub seed: u64,
    pub counts: Counts,
    pub effort: Effort,
    pub bench: &'c mut Bench<'m>,
    pub progress: &'c mut dyn FnMut(f64, &str),
}

pub struct MeshOutcome {
    pub mesh: MeshReport,
    pub ranking: Vec<Ranked>,
    pub excluded: Vec<Excluded>,
    pub break_even: Vec<BreakEven>,
    /// The time of the second measurement of one backend divided by the time of the first, in each launch.
    pub control_ratios: Vec<Option<f64>>,
    /// Backends whose results differ from the others.
    pub disagreeing: Vec<String>,
    pub operations: f64,
    /// The shortest timed sample, in nanoseconds.
    pub shortest_ns: Option<f64>,
    /// All samples, also those of the control.
    pub samples: Vec<Samples>,
}

impl MeshOutcome {
    /// Returns the longer time of the two measurements of one backend divided by the shorter time.
    pub fn noise(&self) -> Option<f64> {
        let [ratio] = times_over_launches(&[&self.control_ratios])[..] else {
            return None;
        };
        ratio.map(|ratio| ratio.max(ratio.recip()))
    }
}

impl PickMeasurement<'_, '_> {
    /// Measures `backends` and ranks them. `control` is a second copy of one of them.
    pub fn run<'b>(
        self,
        backends: Vec<MeasuredBackend<'b>>,
        control: Option<MeasuredBackend<'b>>,
        mut excluded: Vec<Excluded>,
    ) -> MeshOutcome
    where
        Self: 'b,
    {
        let polygons = &self.study_mesh.polygons;
        let plan = self.plan;
        let ranked = backends.len();
        let (candidates, mut subjects): (Vec<Candidate>, Vec<Box<dyn TimedBackend + 'b>>) =
            backends.into_iter().chain(control).unzip();
        let again = subjects.pop_if(|_| candidates.len() > ranked);
        let progress = self.progress;
        let trial = Trial {
            polygons,
            counts: self.counts,
            skewed: is_skewed(&self.study_mesh.facts),
            columns: Columns::new(subjects, Vec::new(), |_| again),
            entries: plan.entries(&candidates),
            effort: self.effort,
            named: true,
            forced: false,
            untimed: None,
            seed: self.seed,
        };
        let measured = self.bench.measure(trial, &mut |at: Progress<'_>| {
            let Progress {
                stage,
                task,
                backend,
                ..
            } = at;
            progress(0.1 + 0.9 * at.done, &format!("{stage} {task} on {backend}"));
        });
        let (samples, shortest_ns) = (measured.samples(), measured.shortest_ns());
        let TrialResult {
            entries,
            second,
            agreements,
            ..
        } = measured;
        let evaluate = |column: usize| {
            let candidate = &candidates[column];
            let own: Vec<&Entry> = entries
                .iter()
                .chain(&second)
                .filter(|e| e.subject == column)
                .collect();
            let samples = plan.mix_times(candidate, &own);
            samples.map(|samples| MeasuredMix {
                candidate,
                entries: own,
                samples,
            })
        };
        let mut measured = Vec::new();
        for column in 0..ranked {
            match evaluate(column) {
                Ok(one) => measured.push(one),
                Err(refused) => excluded.push(refused),
            }
        }
        let control = (ranked..candidates.len()).find_map(|column| evaluate(column).ok());
        let evaluation = Evaluation {
            plan,
            counts: &self.counts,
            measured: &measured,
            confidence: self.bench.confidence(),
        };
        let repeated = control.and_then(|control| evaluation.control_ratio(&control));
        let noise = repeated.map_or(1.0, |ratio| ratio.max(ratio.recip()));
        let ranking = evaluation.ranking(noise.max(NO_DIFFERENCE));
        let operations = plan.operations();
        let wrong = entries.iter().zip(agreements);
        let wrong = wrong.filter(|(_, agreement)| *agreement == Agreement::Mismatch);
        let wrong: BTreeSet<usize> = wrong.map(|(entry, _)| entry.subject).collect();
        let mut wrong: Vec<String> = wrong
            .into_iter()
            .map(|subject| candidates[subject].name.clone())
            .collect();
        // Of a program, each backend is compared with one other, which may be the odd one.
        let kinds = kinds(&ranking);
        if let [most, next, ..] = &kinds[..]
            && most.len() > next.len()
        {
            wrong.retain(|name| most.iter().all(|ranked| ranked.backend != *name));
        }
        MeshOutcome {
            mesh: self.study_mesh.report(),
            samples,
            break_even: break_even(&measured, &ranking, operations, evaluation.confidence),
            ranking,
            excluded,
            control_ratios: repeated.map(Some).into_iter().collect(),
            disagreeing: wrong,
            operations,
            shortest_ns,
        }
    }
}

/// The evaluation of what was measured.
pub struct Evaluation<'e> {
    /// What the backends run.
    pub plan: &'e dyn TaskPlan,
    /// The numbers of elements of the mesh.
    pub counts: &'e Counts,
    /// The measured backends.
    pub measured: &'e [MeasuredMix<'e>],
    /// The confidence of the intervals.
    pub confidence: Confidence,
}

impl Evaluation<'_> {
    /// Returns the ratio of the two times of a backend that was measured twice.
    fn control_ratio(&self, control: &MeasuredMix<'_>) -> Option<f64> {
        let same = |m: &&MeasuredMix<'_>| m.candidate.name == control.candidate.name;
        let original = self.measured.iter().find(same)?;
        Some(ratio(&control.samples, &original.samples)?.value)
    }

    /// Ranks the backends that have samples; the fastest first. Differences up to `noise` are ties. A
    /// backend of which only a lower bound is known is not compared, and comes last.
    pub fn ranking(&self, noise: f64) -> Vec<Ranked> {
        let measured = |m: &MeasuredMix<'_>| match m.is_bound() {
            true => Vec::new(),
            false => m.samples.clone(),
        };
        let times: Vec<Vec<(u32, Time)>> = self.measured.iter().map(measured).collect();
        let ranks = rank(&times, &corrected_times(&times), noise, self.confidence);
        let best = ranks.iter().flatten().map(|rank| rank.time.value);
        let best = best.min_by(f64::total_cmp);
        let rows = self.measured.iter().zip(ranks);
        let rows = rows.filter_map(|(m, rank)| {
            let row = self.unranked(m)?;
            let interval = |of: Median| of.interval(self.confidence);
            Some(match rank {
                Some(rank) => Ranked {
                    ns_per_operation: rank.time.value,
                    ns_ci_low: interval(rank.time).map(|[low, _]| low),
                    ns_ci_high: interval(rank.time).map(|[_, high]| high),
                    ratio_to_best: rank.ratio.value,
                    ci_low: interval(rank.ratio).map(|[low, _]| low),
                    ci_high: interval(rank.ratio).map(|[_, high]| high),
                    tied_with_best: rank.standing != Some(Standing::Slower),
                    ..row
                },
                None => Ranked {
                    ratio_to_best: row.ns_per_operation / best.unwrap_or(row.ns_per_operation),
                    ..row
                },
            })
        });
        let mut ranking: Vec<Ranked> = rows.collect();
        ranking.sort_by(Ranked::measured_first);
        ranking
    }

    /// Returns the row of a backend that is not compared with the others; `None` without a time.
    fn unranked(&self, m: &MeasuredMix<'_>) -> Option<Ranked> {
        let median = |times: &[(u32, Time)]| {
            let times = times.iter().map(|(_, time)| time.ns());
            Some(Median::from_samples(times)?.value)
        };
        let build = m.entry(Task::Operation(Operation::Build))?;
        let outcome = m.entry(Task::Program).and_then(|run| run.outcome);
        let Candidate {
            name,
            made_from,
            type_paths,
            tabulated,
            bytes,
            ..
        } = m.candidate;
        Some(Ranked {
            backend: name.clone(),
            made_from: made_from.map(str::to_owned),
            ns_per_operation: median(&m.samples)?,
            launch_ns: Vec::new(),
            ns_ci_low: None,
            ns_ci_high: None,
            ratio_to_best: 1.0,
            ci_low: None,
            ci_high: None,
            tied_with_best: false,
            build_ns: median(&build.times())?,
            build_launch_ns: Vec::new(),
            first_build_ns: build.first_ns(),
            bytes: *bytes,
            bytes_per_vertex: *bytes as f64 / self.counts.vertices.max(1) as f64,
            sampled: m.candidate.scans() || m.entries.iter().any(|e| e.job.sample.is_some()),
            estimated: m.is_bound(),
            parts: self.plan.parts(m),
            samples: m.samples.len(),
            warm_up_only: m.is_warm_up_only(),
            faults: m.most_faults(),
            result: outcome.map(|outcome| outcome.checksum),
            elements: outcome.map(|outcome| outcome.elements),
            types: type_paths.iter().map(|&path| path.to_owned()).collect(),
            tabulated: tabulated.iter().map(ToString::to_string).collect(),
        })
    }
}

/// Returns why a backend of `bytes` bytes is excluded; `None` if it may take so many.
pub fn over_memory_limit(bytes: u64, most: Option<u64>) -> Option<String> {
    let most = most.filter(|&most| bytes > most)?;
    let [bytes, most] =
        [bytes, most].map(|bytes| sixfold_results::numbers::grouped(bytes as usize));
    Some(format!(
        "it takes {bytes} bytes, but --max-memory allows only {most}"
    ))
}
