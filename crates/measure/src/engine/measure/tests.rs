//! Tests with structures of known cost, on a machine whose speed drifts.

use std::cell::Cell;
use std::rc::Rc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::subdivision::Method;
use sixfold::{PolygonMesh, QueryCost, Relation};

use super::*;
use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::control::control;
use crate::engine::plan::MIN_ELEMENTS;
use crate::engine::simulated_machine::SimulatedMachine;
use sixfold_core::Counts;
use sixfold_results::statistics::Median;
use sixfold_results::{CacheState, Confidence, RunSettings, noise};

struct Synthetic {
    machine: SimulatedMachine,
    ns_per_element: f64,
    elements: usize,
    costs: [QueryCost; 9],
    most_run: Rc<Cell<usize>>,
    placement: Placement,
    /// Time of each series outside its runs, in nanoseconds.
    outside_ns: f64,
    can_sample: bool,
}

impl Synthetic {
    /// A backend that stays in its place, on a mesh with 10,000 elements of each kind.
    fn new(machine: &SimulatedMachine, ns_per_element: f64, cost: QueryCost) -> Self {
        Self {
            machine: machine.clone(),
            ns_per_element,
            elements: 10_000,
            costs: [cost; 9],
            most_run: Rc::default(),
            placement: Placement::default(),
            outside_ns: 0.0,
            can_sample: true,
        }
    }

    fn boxed(
        machine: &SimulatedMachine,
        ns_per_element: f64,
        cost: QueryCost,
    ) -> Box<dyn TimedBackend> {
        Box::new(Self::new(machine, ns_per_element, cost))
    }
}

/// Slowdown of a run on fresh pages.
const FRESH: f64 = 3.0;

#[derive(Clone, Default)]
struct Placement {
    /// Time of a rebuild at another place, in nanoseconds.
    rebuild_ns: f64,
    /// Number of rebuilds.
    rebuilt: Rc<Cell<u32>>,
    /// Slowdown at each place. Rebuilds visit the places in turn.
    slowdowns: Vec<f64>,
}

impl Placement {
    fn slowdown(&self) -> f64 {
        let places = self.slowdowns.len().max(1);
        let current = self.slowdowns.get(self.rebuilt.get() as usize % places);
        current.copied().unwrap_or(1.0)
    }
}

impl TimedBackend for Synthetic {
    fn name(&self) -> &str {
        "synthetic"
    }
    fn costs(&self) -> [QueryCost; 9] {
        self.costs
    }
    fn can_sample(&self) -> bool {
        self.can_sample
    }
    fn merged_vertices(&self) -> usize {
        0
    }
    fn bytes(&self) -> usize {
        1
    }
    fn rebuild(&mut self) {
        self.machine.work(self.placement.rebuild_ns);
        self.placement.rebuilt.set(self.placement.rebuilt.get() + 1);
    }
    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        let Series { runs, clock, .. } = *series;
        let size = job
            .sample
            .map_or(self.elements, |s| s.size.min(self.elements));
        self.most_run.set(self.most_run.get().max(size));
        let fresh = match series.start {
            Start::FreshPages => FRESH,
            _ => 1.0,
        };
        let ns = self.ns_per_element * size as f64 * self.placement.slowdown() * fresh;
        if self.outside_ns > 0.0 {
            self.machine.work(self.outside_ns);
        }
        for _ in 0..series.untimed {
            self.machine.work(ns);
        }
        let start = clock.now();
        for _ in 0..runs {
            self.machine.work(ns);
        }
        let scale = self.elements as f64 / size as f64 / f64::from(runs);
        TimedRun::done((clock.now() - start).scaled(scale), None)
    }
}

const VV: Operation = Operation::Relation(Relation::VertexVertices);

fn measured(costs_ns: &[f64], scanning: bool, budget: Duration, stop: bool) -> Vec<Entry> {
    measure_all(costs_ns, scanning, budget, stop, false).0
}

fn measure_all(
    costs_ns: &[f64],
    scanning: bool,
    budget: Duration,
    stop: bool,
    skewed: bool,
) -> (Vec<Entry>, Duration) {
    let machine = SimulatedMachine::default();
    let cost = if scanning {
        QueryCost::Scan
    } else {
        QueryCost::Local
    };
    let subject = |&ns: &f64| Synthetic::boxed(&machine, ns, cost);
    let subjects: Vec<_> = costs_ns.iter().map(subject).collect();
    run(&machine, subjects, budget, stop, skewed)
}

/// The limits of a trial on a mesh with 10,000 elements of each kind.
#[derive(Clone, Copy)]
struct Limits {
    effort: Effort,
    caches: CacheState,
    stop: bool,
    skewed: bool,
    named: bool,
    forced: bool,
}

impl Limits {
    fn of(effort: Effort) -> Self {
        Self {
            effort,
            caches: CacheState::Warm,
            stop: false,
            skewed: false,
            named: false,
            forced: false,
        }
    }
}

fn run_trial(
    machine: &SimulatedMachine,
    subjects: Vec<Box<dyn TimedBackend>>,
    operations: &[Operation],
    limits: Limits,
) -> Vec<Entry> {
    watch_trial(machine, subjects, operations, limits, &mut |_| ())
}

fn watch_trial(
    machine: &SimulatedMachine,
    subjects: Vec<Box<dyn TimedBackend>>,
    operations: &[Operation],
    limits: Limits,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Vec<Entry> {
    let columns = Columns::without_control(subjects);
    let trial = Trial {
        polygons: &PolygonMesh::default(),
        counts: Counts {
            vertices: 10_000,
            edges: 10_000,
            faces: 10_000,
            corners: 30_000,
            uniform: true,
        },
        skewed: limits.skewed,
        entries: columns.entries(operations),
        columns,
        effort: limits.effort,
        named: limits.named,
        forced: limits.forced,
        untimed: None,
        seed: 3,
    };
    let settings = RunSettings {
        caches: limits.caches,
        ..RunSettings::default()
    };
    let stop = AtomicBool::new(limits.stop);
    let mut bench = Bench::start(machine, settings, 0, &stop).expect("no heap policy");
    bench.measure(trial, progress).entries
}

fn run(
    machine: &SimulatedMachine,
    subjects: Vec<Box<dyn TimedBackend>>,
    budget: Duration,
    stop: bool,
    skewed: bool,
) -> (Vec<Entry>, Duration) {
    let operations = [VV, Operation::Circulate, Operation::FfBfs];
    let limits = Limits {
        stop,
        skewed,
        ..Limits::of(budget.into())
    };
    let entries = run_trial(machine, subjects, &operations, limits);
    (entries, Duration::from_nanos(machine.ns() as u64))
}

fn ratio(entries: &[Entry], a: usize, b: usize) -> Median {
    let pairs = entries[a].samples.iter().zip(&entries[b].samples);
    Median::from_samples(pairs.map(|((_, a), (_, b))| a.ns() / b.ns())).expect("samples")
}

#[test]
fn the_control_shows_a_difference_of_its_two_entries() {
    // The second column of the control takes 20 % longer at every place.
    let entries = measured(&[7.0, 10.0, 8.4], false, Duration::from_secs(2), false);
    let planted = control(&entries, 0, 2, "synthetic", Confidence::default()).expect("samples");
    for row in &planted.operations {
        assert!(row.is_unsteady(), "{row:?}");
        assert!(noise(Some(&planted), &row.operation) >= 1.19, "{row:?}");
    }
    let entries = measured(&[7.0, 10.0, 7.0], false, Duration::from_secs(2), false);
    let steady = control(&entries, 0, 2, "synthetic", Confidence::default()).expect("samples");
    assert!(steady.operations.iter().all(|row| !row.is_unsteady()));
}

#[test]
fn structures_are_built_again_between_rounds_within_a_small_part_of_the_budget() {
    let budget = Duration::from_secs(2);
    let placed = |machine: SimulatedMachine, rebuild_ns: f64| {
        let rebuilt: [Rc<Cell<u32>>; 2] = Default::default();
        let subject = |i: usize, slowdowns: [f64; 2]| {
            Box::new(Synthetic {
                placement: Placement {
                    rebuild_ns,
                    rebuilt: rebuilt[i].clone(),
                    slowdowns: slowdowns.to_vec(),
                },
                ..Synthetic::new(&machine, 7.0, QueryCost::Local)
            }) as Box<dyn TimedBackend>
        };
        let subjects = vec![subject(0, [1.0, 1.2]), subject(1, [1.2, 1.0])];
        let (entries, elapsed) = run(&machine, subjects, budget, false, false);
        (entries, elapsed, rebuilt[0].get())
    };
    let (entries, elapsed, rebuilt) = placed(SimulatedMachine::default(), 100_000.0);
    assert!(elapsed <= budget);
    assert!(
        rebuilt >= 15 && f64::from(rebuilt) * 200_000.0 <= 0.05 * 2e9,
        "{rebuilt}"
    );
    let pairs = entries[0].samples.iter().zip(&entries[1].samples);
    let slower = pairs
        .clone()
        .filter(|((_, a), (_, b))| a.ns() > b.ns())
        .count();
    let all = pairs.count();
    assert!(
        all > 15 && (2 * slower).abs_diff(all) <= all / 5,
        "{slower} of {all}"
    );
    // A long rebuild leaves no time for another rebuild.
    assert_eq!(placed(SimulatedMachine::default(), 1e8).2, 1);
    // The last round does not begin with a rebuild that would exceed the budget.
    for ms in 2..=20 {
        let (_, elapsed, _) = placed(SimulatedMachine::steady(), 1e6 * f64::from(ms));
        assert!(elapsed <= budget, "{ms} ms each: {elapsed:?}");
    }
    // The second rebuild may begin when both rebuilds take their share of the time until then. It
    // is left out if not even one round would fit after it.
    let second_at = |ms: f64| {
        let rebuild_ns = 1e6 * ms * REBUILDING_SHARE / 2.0;
        placed(SimulatedMachine::steady(), rebuild_ns / 2.0).2
    };
    // The third operation allocates.
    let for_rounds_ms = (1.0 - FIRST_TIMES_SHARE) * 2000.0;
    let last = (for_rounds_ms - 1.0) / (1.0 + REBUILDING_SHARE / 2.0);
    assert_eq!([0.9 * last, last].map(second_at), [2, 1]);
}

#[test]
fn progress_is_the_part_of_the_time_or_of_the_rounds() {
    let subjects = |machine: &SimulatedMachine| -> Vec<Box<dyn TimedBackend>> {
        vec![Box::new(Synthetic::new(machine, 7.0, QueryCost::Local))]
    };
    let machine = SimulatedMachine::steady();
    let limits = Limits::of(Duration::from_millis(400).into());
    let mut seen = Vec::new();
    let entries = watch_trial(&machine, subjects(&machine), &[VV], limits, &mut |p| {
        if p.stage == "measuring" {
            seen.push((p.done, machine.ns() / 400e6));
        }
    });
    assert!(
        entries[0].samples.len() < MAX_ROUNDS as usize,
        "ended by time"
    );
    let by_rounds = |round: usize| round as f64 / f64::from(MAX_ROUNDS);
    for (round, (done, by_time)) in seen.iter().enumerate() {
        let expected = by_time.max(by_rounds(round)).clamp(0.1, 1.0);
        assert!(
            (done - expected).abs() < 1e-9,
            "{done} in round {round}: {expected}"
        );
    }
    assert!(
        seen.last()
            .is_some_and(|(done, _)| (0.9..1.0).contains(done)),
        "{seen:?}"
    );

    let machine = SimulatedMachine::steady();
    let limits = Limits::of(Effort::of_rounds(20));
    let mut seen = Vec::new();
    watch_trial(&machine, subjects(&machine), &[VV], limits, &mut |p| {
        if p.stage == "measuring" {
            seen.push(p.done);
        }
    });
    let expected: Vec<f64> = (0..20)
        .map(|round| (f64::from(round) / 20.0).max(0.1))
        .collect();
    assert_eq!(seen, expected);
}

#[test]
fn first_times_take_a_part_of_the_budget_if_pages_can_be_new() {
    let budget = Duration::from_secs(2);
    let build = Operation::Build;
    let measured = |operation: Operation, caches: CacheState| {
        let machine = SimulatedMachine::steady();
        let subject = Synthetic::new(&machine, 7.0, QueryCost::Local);
        let limits = Limits {
            caches,
            ..Limits::of(budget.into())
        };
        // Several entries, so that the time ends before the rounds do.
        let operations = [operation; 4];
        let mut in_rounds = 0.0;
        let subjects: Vec<Box<dyn TimedBackend>> = vec![Box::new(subject)];
        let entries = watch_trial(&machine, subjects, &operations, limits, &mut |p| {
            if p.stage == "measuring" {
                in_rounds = machine.ns() / 2e9;
            }
        });
        let first_times = &entries[0].first_times;
        for [first, later] in first_times {
            assert_eq!(first.ns(), FRESH * later.ns());
        }
        (in_rounds, first_times.len())
    };
    let (whole, part) = (0.95..1.0, 0.85..0.9);
    let (in_rounds, first_times) = measured(VV, CacheState::Warm);
    assert!(
        whole.contains(&in_rounds) && first_times == 0,
        "{in_rounds}, {first_times}"
    );
    let (in_rounds, first_times) = measured(build, CacheState::Warm);
    assert!(
        part.contains(&in_rounds) && first_times > 0,
        "{in_rounds}, {first_times}"
    );
    let (_, first_times) = measured(build, CacheState::Cold);
    assert_eq!(first_times, 0);
}

#[test]
fn untimed_runs_last_as_long_as_a_sample_may_and_are_at_least_one() {
    assert_eq!(
        untimed_runs(Task::Operation(VV), 1_000.0, 2e6, false),
        2_000
    );
    assert_eq!(untimed_runs(Task::Operation(VV), 5e6, 2e6, false), 1);
    assert_eq!(untimed_runs(Task::Operation(VV), 11e6, 2e6, false), 0);
    assert_eq!(untimed_runs(Task::Operation(VV), 10e6, 2e6, false), 1);
    let grows: Operation = "flip_all".parse().expect("an operation");
    assert_eq!(untimed_runs(Task::Operation(grows), 11e6, 2e6, false), 1);
    assert_eq!(
        untimed_runs(Task::Operation(VV), 0.0, 1e12, false),
        10_000_000
    );
    assert_eq!(
        untimed_runs(Task::Operation(VV), 1e6, 2e6, true),
        4,
        "large"
    );
    assert_eq!(
        untimed_runs(Task::Operation(VV), 8e6, 2e6, true),
        2,
        "at most 20 ms"
    );
    assert_eq!(
        untimed_runs(Task::Operation(VV), 1e5, 2e6, true),
        20,
        "as a small one"
    );
}

#[test]
fn a_control_leaves_out_times_of_zero() {
    let mut entries = measured(&[7.0, 7.0], false, Duration::from_secs(1), false);
    for (_, time) in &mut entries[1].samples {
        *time = Time::from_wall_ns(0.0);
    }
    let control =
        control(&entries, 0, 1, "synthetic", Confidence::default()).expect("two operations");
    assert_eq!(control.operations.len(), 2);
    assert!(control.worst.is_finite());
}

#[test]
fn a_control_shows_the_noise_of_a_drifting_machine() {
    let entries = measured(&[7.0, 10.0, 7.0], false, Duration::from_secs(2), false);
    let control = control(&entries, 0, 2, "synthetic", Confidence::default()).expect("samples");
    assert_eq!(control.operations.len(), 3);
    assert!(control.typical < 1.02, "{control:?}");
    assert!(
        (control.typical..1.3).contains(&control.worst),
        "{control:?}"
    );
    for row in &control.operations {
        let noise = noise(Some(&control), &row.operation);
        assert!(noise >= row.difference() && noise >= 1.02);
    }
    assert_eq!(noise(None, VV.name()), 1.02);
}

#[test]
fn ratios_within_rounds_do_not_depend_on_drift() {
    let entries = measured(&[7.0, 10.0, 7.1], false, Duration::from_secs(2), false);
    assert!(entries.iter().all(|e| e.samples.len() >= 20), "20 rounds");
    for first in [0, 3, 6] {
        let slower = ratio(&entries, first + 1, first).value;
        assert!((slower / (10.0 / 7.0) - 1.0).abs() < 0.04, "{slower}");
        let alike = ratio(&entries, first + 2, first).value;
        assert!((alike - 1.0).abs() < 0.05, "{alike}");
    }
    // The drift between samples of one entry is larger than the difference between the two entries.
    let own =
        Median::from_samples(entries[0].samples.iter().map(|(_, t)| t.ns())).expect("samples");
    let most = entries[0]
        .samples
        .iter()
        .map(|(_, t)| t.ns())
        .fold(0.0, f64::max);
    assert!(most / own.least > 10.0 / 7.0, "{most} / {}", own.least);
}

#[test]
fn scans_are_sampled_or_estimated_to_fit_the_budget() {
    // A run takes 2 s: 10,000 elements of 200 µs.
    let entries = measured(&[200_000.0], true, Duration::from_secs(2), false);
    for entry in &entries[..2] {
        let sample = entry.job.sample.expect("a sample");
        assert!((MIN_ELEMENTS..2_000).contains(&sample.size), "{sample:?}");
        assert!(entry.samples.len() >= 5, "{} rounds", entry.samples.len());
        let ns = Median::from_samples(entry.samples.iter().map(|(_, t)| t.ns())).expect("samples");
        assert!((1e9..1e10).contains(&ns.value), "{ns:?}");
    }
    let estimate = entries[2]
        .estimate
        .expect("a search that scans takes too long");
    assert!((1e9..1e10).contains(&estimate.ns()), "{estimate:?}");
    assert!(entries[2].samples.is_empty() && entries[2].times().is_empty());
    // With enough time, no operation is sampled or left out.
    let entries = measured(&[40_000.0], true, Duration::from_secs(200), false);
    assert!(
        entries
            .iter()
            .all(|e| e.job.sample.is_none() && e.samples.len() >= 5)
    );
}

#[test]
fn long_runs_of_other_backends_leave_time_for_scans() {
    let machine = SimulatedMachine::default();
    // The three first runs of the local backend take almost half of the budget.
    let subjects = vec![
        Synthetic::boxed(&machine, 60_000.0, QueryCost::Local),
        Synthetic::boxed(&machine, 1_000.0, QueryCost::Scan),
    ];
    let (entries, _) = run(&machine, subjects, Duration::from_secs(4), false, false);
    assert!(entries.iter().all(|entry| entry.refusal.is_none()));
    assert!(
        entries
            .iter()
            .all(|entry| !entry.times().is_empty() || entry.estimate.is_some())
    );
}

#[test]
fn a_skewed_mesh_is_sampled_on_every_structure() {
    let costs = [200_000.0; 3];
    let budget = Duration::from_secs(2);
    let (entries, elapsed) = measure_all(&costs, false, budget, false, true);
    assert!(elapsed < budget * 3 / 2, "{elapsed:?}");
    for entry in &entries[..6] {
        assert!(entry.job.sample.is_some() && !entry.times().is_empty());
    }
    assert!(entries[6..].iter().all(|e| e.estimate.is_some()));
    // A backend that cannot sample runs in full.
    let machine = SimulatedMachine::steady();
    let subject = |can_sample| Synthetic {
        can_sample,
        ..Synthetic::new(&machine, 20_000.0, QueryCost::Local)
    };
    let subjects: [Box<dyn TimedBackend>; 2] = [true, false].map(|can| Box::new(subject(can)) as _);
    let (entries, _) = run(&machine, subjects.into(), budget, false, true);
    let is_sampled = |entry: &Entry| entry.job.sample.is_some();
    assert!(is_sampled(&entries[0]) && !is_sampled(&entries[1]));
    // Cheap operations run in full even on a skewed mesh.
    let (entries, _) = measure_all(&[7.0], false, budget, false, true);
    assert!(entries.iter().all(|e| e.job.sample.is_none()));
    assert!(entries.iter().all(|e| e.samples.len() >= 5));
    // On a mesh that is not skewed, no operation is sampled. Three runs of the first operation
    // exceed the budget, so the other operations are left out.
    let (entries, elapsed) = measure_all(&costs, false, budget, false, false);
    assert!(
        elapsed > budget * 5 / 2 && elapsed < budget * 4,
        "{elapsed:?}"
    );
    assert!(entries[..3].iter().all(|e| e.times().len() == 1));
    let left_out = |e: &Entry| e.refusal.is_some() && e.refusal_kind == RefusalKind::BudgetEnded;
    assert!(entries[3..].iter().all(left_out));
}

#[test]
fn a_search_that_fits_the_budget_once_is_run_once() {
    // A run takes 1 s. This is too long for rounds in a budget of 8 s, but short enough for one
    // run after the rounds.
    let (entries, elapsed) = measure_all(&[100_000.0], true, Duration::from_secs(8), false, false);
    let search = &entries[2];
    assert!(search.estimate.is_none() && search.samples.is_empty());
    assert_eq!(search.times().len(), 1);
    assert!(elapsed < Duration::from_secs(9), "{elapsed:?}");
    assert!(
        entries[0].samples.len() >= 5,
        "the others keep their rounds"
    );
    // In less time, the run would take more than what is left for such runs.
    let (entries, elapsed) = measure_all(&[100_000.0], true, Duration::from_secs(4), false, false);
    assert!(entries[2].estimate.is_some() && entries[2].times().is_empty());
    assert!(entries[0].samples.len() >= 5);
    assert!(elapsed < Duration::from_secs(5), "{elapsed:?}");
}

#[test]
fn a_stopped_study_has_no_times_and_a_tiny_budget_has_the_warm_up() {
    let entries = measured(&[7.0, 9.0], false, Duration::from_secs(1), true);
    assert!(entries.iter().all(|e| e.times().is_empty()));
    let entries = measured(&[7.0, 9.0], false, Duration::from_nanos(1), false);
    assert!(entries[..2].iter().all(|e| e.times().len() == 1));
    assert!(entries[2..].iter().all(|e| e.refusal.is_some()));
}

#[test]
fn a_long_subdivision_is_only_estimated_unless_requested_by_name() {
    let machine = SimulatedMachine::default();
    let planned = |ns_per_element: f64, cost: QueryCost, named: bool| {
        let most_run: Rc<Cell<usize>> = Rc::default();
        let subjects: Vec<Box<dyn TimedBackend>> = vec![Box::new(Synthetic {
            most_run: most_run.clone(),
            ..Synthetic::new(&machine, ns_per_element, cost)
        })];
        let operations = [Operation::CatmullClark(Method::Gather)];
        let limits = Limits {
            named,
            ..Limits::of(Duration::from_secs(4).into())
        };
        let entries = run_trial(&machine, subjects, &operations, limits);
        (entries[0].clone(), most_run.get())
    };
    // A run takes 1 ms, so it takes part in rounds.
    let (entry, _) = planned(100.0, QueryCost::Local, false);
    assert!(entry.samples.len() >= 5 && entry.estimate.is_none());
    // A run takes 0.3 s of a budget of 4 s, so it is estimated unless it is named.
    let (entry, most_run) = planned(30_000.0, QueryCost::Local, false);
    let estimate = entry.estimate.expect("long").ns();
    assert!((1e8..1e9).contains(&estimate) && entry.by_name_only);
    assert!(most_run < 10_000 && entry.times().is_empty());
    let (entry, most_run) = planned(30_000.0, QueryCost::Local, true);
    assert!(entry.estimate.is_none() && entry.times().len() == 1);
    assert_eq!(most_run, 10_000);
    // Six relations need searches of 0.1 s each.
    let (entry, _) = planned(10_000.0, QueryCost::Scan, false);
    let estimate = entry.estimate.expect("long").ns();
    assert!((3e8..2e9).contains(&estimate), "{estimate}");
    // A run exceeds the budget, so it is estimated even if it is named.
    for named in [false, true] {
        let (entry, _) = planned(1e6, QueryCost::Local, named);
        assert!(entry.estimate.is_some() && !entry.by_name_only);
    }
}

#[test]
fn the_cost_of_a_sample_includes_the_time_outside_its_runs() {
    for (ns_per_element, operation) in [(7.0, VV), (40.0, VV), (40.0, Operation::Build)] {
        let machine = SimulatedMachine::steady();
        let subject = Synthetic {
            outside_ns: 1e6,
            ..Synthetic::new(&machine, ns_per_element, QueryCost::Local)
        };
        let limits = Limits::of(Duration::from_secs(2).into());
        let entries = run_trial(&machine, vec![Box::new(subject)], &[operation], limits);
        let [entry] = &entries[..] else {
            panic!("{entries:?}");
        };
        let runs = f64::from(entry.untimed + entry.runs);
        let expected = 1e4 * ns_per_element * runs + 1e6;
        assert!((entry.cost_ns / expected - 1.0).abs() < 1e-9, "{entry:?}");
    }
}

#[test]
fn operations_without_scans_leave_a_quarter_of_the_time_to_scans() {
    let machine = SimulatedMachine::steady();
    // A run of the first backend takes 1.6 s of a budget of 4 s, so a third run would begin after
    // 3.2 s.
    let subjects = vec![
        Synthetic::boxed(&machine, 160_000.0, QueryCost::Local),
        Synthetic::boxed(&machine, 1_000.0, QueryCost::Scan),
    ];
    let (entries, _) = run(&machine, subjects, Duration::from_secs(4), false, false);
    let runs: Vec<usize> = entries.iter().step_by(2).map(|e| e.times().len()).collect();
    assert_eq!(runs, [1, 1, 0]);
    assert_eq!(entries[4].refusal_kind, RefusalKind::BudgetEnded);
    assert!(
        entries
            .iter()
            .skip(1)
            .step_by(2)
            .all(|e| !e.times().is_empty())
    );
}
