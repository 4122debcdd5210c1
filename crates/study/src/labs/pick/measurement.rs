//! The measurement on one mesh, and the ranking that results.

use std::collections::BTreeSet;

use sixfold_core::Counts;
use sixfold_results::{
    Agreement, BreakEven, Confidence, Excluded, MeshReport, Ranked, Samples, Standing, Time,
    corrected_times,
};
use sixfold_workload::{Operation, Task, TimedBackend};

use crate::engine::bench::{Bench, Columns, Trial, TrialResult};
use crate::engine::effort::Effort;
use crate::engine::measure::{Entry, Progress};
use crate::inspect::StudyMesh;
use crate::labs::pick::backend::Candidate;
use crate::labs::pick::break_even::{MeasuredMix, break_even};
use crate::labs::pick::tasks::TaskPlan;
use crate::labs::study::is_skewed;
use sixfold_results::launches::times_over_launches;
use sixfold_results::ranking::{NO_DIFFERENCE, rank, ratio};
use sixfold_results::statistics::Median;

/// The properties of a backend, and the backend.
pub(crate) type Contestant<'b> = (Candidate, Box<dyn TimedBackend + 'b>);

/// The measurement of the backends of a pick on one mesh.
pub(crate) struct PickMeasurement<'c, 'm> {
    pub(crate) study_mesh: &'c StudyMesh,
    pub(crate) plan: &'c dyn TaskPlan,
    pub(crate) seed: u64,
    pub(crate) counts: Counts,
    pub(crate) effort: Effort,
    pub(crate) bench: &'c mut Bench<'m>,
    pub(crate) progress: &'c mut dyn FnMut(f64, &str),
}

pub(crate) struct MeshOutcome {
    pub(crate) mesh: MeshReport,
    pub(crate) ranking: Vec<Ranked>,
    pub(crate) excluded: Vec<Excluded>,
    pub(crate) break_even: Vec<BreakEven>,
    /// The time of the second measurement of one backend divided by the time of the first, in each launch.
    pub(crate) control_ratios: Vec<Option<f64>>,
    /// Backends whose results differ from the others.
    pub(crate) disagreeing: Vec<String>,
    pub(crate) operations: f64,
    /// The shortest timed sample, in nanoseconds.
    pub(crate) shortest_ns: Option<f64>,
    /// All samples, also those of the control.
    pub(crate) samples: Vec<Samples>,
}

impl MeshOutcome {
    /// Returns the longer time of the two measurements of one backend divided by the shorter time.
    pub(crate) fn noise(&self) -> Option<f64> {
        let [ratio] = times_over_launches(&[&self.control_ratios])[..] else {
            return None;
        };
        ratio.map(|ratio| ratio.max(ratio.recip()))
    }
}

impl PickMeasurement<'_, '_> {
    /// Measures `backends` and ranks them. `control` is a second copy of one of them.
    pub(crate) fn run<'b>(
        self,
        backends: Vec<Contestant<'b>>,
        control: Option<Contestant<'b>>,
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
            samples
                .map(|samples| MeasuredMix {
                    candidate,
                    entries: own,
                    samples,
                })
                .map_err(|reason| Excluded::new(&candidate.name, reason))
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
        let wrong = wrong
            .into_iter()
            .map(|subject| candidates[subject].name.clone());
        MeshOutcome {
            mesh: self.study_mesh.report(),
            samples,
            break_even: break_even(&measured, &ranking, operations, evaluation.confidence),
            ranking,
            excluded,
            control_ratios: repeated.map(Some).into_iter().collect(),
            disagreeing: wrong.collect(),
            operations,
            shortest_ns,
        }
    }
}

/// The evaluation of what was measured.
struct Evaluation<'e> {
    plan: &'e dyn TaskPlan,
    counts: &'e Counts,
    measured: &'e [MeasuredMix<'e>],
    confidence: Confidence,
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
    fn ranking(&self, noise: f64) -> Vec<Ranked> {
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
            result: m
                .entry(Task::Program)
                .and_then(|run| run.outcome)
                .map(|outcome| outcome.checksum),
            types: type_paths.iter().map(|&path| path.to_owned()).collect(),
            tabulated: tabulated.iter().map(ToString::to_string).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;
    use sixfold_workload::{Schedule, built_in};

    use super::*;
    use crate::labs::pick::tasks::Tasks;

    /// A mix of 9 ns of which the time is only estimated, and mixes of 10 and 20 ns.
    #[test]
    fn estimates_are_compared_with_the_fastest_measured_time_and_come_last() {
        let polygons = shapes::octahedron();
        let counts = polygons.counts(12);
        let workload = built_in("geodesic-dijkstra").expect("a built-in workload");
        let schedule = Schedule::new(&workload, &counts);
        let plan = Tasks::new(&workload, &schedule, &polygons, &counts);
        let times = |ns: f64| {
            (0..5)
                .map(|round| (round, Time::from_wall_ns(ns)))
                .collect()
        };
        let candidate = |name: &str| Candidate {
            name: name.into(),
            structure: None,
            made_from: None,
            type_paths: Vec::new(),
            tabulated: Vec::new(),
            scans: vec![false; schedule.parts.len()],
            bytes: 1,
        };
        let [soup, fast, slow] = ["polygon-soup", "half-edge", "face-vertex"].map(candidate);
        let build = Entry {
            samples: times(1000.0),
            ..Entry::new(0, Operation::Build)
        };
        let estimate = Entry {
            estimate: Some(Time::from_wall_ns(9.0)),
            ..Entry::of_task(0, Task::Mix, "mix")
        };
        let mix = |candidate, ns, estimated: bool| MeasuredMix {
            candidate,
            entries: [&build, &estimate][..1 + usize::from(estimated)].to_vec(),
            samples: times(ns),
        };
        let ranking = |measured: &[MeasuredMix<'_>]| {
            let evaluation = Evaluation {
                plan: &plan,
                counts: &counts,
                measured,
                confidence: Confidence::default(),
            };
            evaluation.ranking(NO_DIFFERENCE)
        };
        let rows = ranking(&[
            mix(&soup, 9.0, true),
            mix(&slow, 20.0, false),
            mix(&fast, 10.0, false),
        ]);
        let row = |r: &Ranked| {
            (
                r.backend.clone(),
                (1e6 * r.ratio_to_best).round() / 1e6,
                r.tied_with_best,
                r.estimated,
            )
        };
        let expected = [
            ("half-edge".to_owned(), 1.0, true, false),
            ("face-vertex".to_owned(), 2.0, false, false),
            ("polygon-soup".to_owned(), 0.9, false, true),
        ];
        assert_eq!(rows.iter().map(row).collect::<Vec<_>>(), expected);
        let only = ranking(&[mix(&soup, 9.0, true)]);
        assert!(only[0].estimated && only[0].ratio_to_best == 1.0);
    }
}
