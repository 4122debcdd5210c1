//! Measures the time that the engine itself takes, on real structures.

use std::cell::Cell;
use std::rc::Rc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use sixfold::{Facts, QueryCost, shapes};
use sixfold_measure::{Clock, Job, MachineClock, Operation, Series, TimedBackend, TimedRun};
use sixfold_results::RunSettings;
use sixfold_workload::Backend;

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::effort::Effort;

/// The times of all backends of a trial, in nanoseconds of processor time of this thread. Elapsed
/// time would include the time of other programs.
#[derive(Default)]
struct Spent {
    /// The time in the backends: operations, untimed runs, copies and building.
    in_backends: Cell<f64>,
    /// The time of the timed runs.
    timed: Cell<f64>,
}

/// A backend that adds up the time of its calls.
struct Counting<'b> {
    backend: Box<dyn TimedBackend + 'b>,
    clock: &'b MachineClock,
    spent: Rc<Spent>,
}

impl Counting<'_> {
    fn count<T>(&mut self, call: impl FnOnce(&mut dyn TimedBackend) -> T) -> T {
        let start = self.clock.now();
        let value = call(self.backend.as_mut());
        let spent = &self.spent.in_backends;
        spent.set(spent.get() + (self.clock.now() - start).ns());
        value
    }
}

impl TimedBackend for Counting<'_> {
    fn name(&self) -> &str {
        self.backend.name()
    }
    fn costs(&self) -> [QueryCost; 9] {
        self.backend.costs()
    }
    fn merged_vertices(&self) -> usize {
        self.backend.merged_vertices()
    }
    fn bytes(&self) -> usize {
        self.backend.bytes()
    }
    fn rebuild(&mut self) {
        self.count(|backend| backend.rebuild());
    }
    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        let start = Instant::now();
        let run = self.count(|backend| backend.run(job, series));
        // The time of a run on some of the elements is scaled to the whole mesh, and a subdivision
        // runs on another thread. So the elapsed time is the limit.
        let ns = run.time.ns() * f64::from(series.runs);
        let timed = &self.spent.timed;
        timed.set(timed.get() + ns.min(start.elapsed().as_nanos() as f64));
        run
    }
}

/// Measures the operations on the four structures that do not scan, and prints the time that is not
/// spent in the backends, divided by the time of the timed runs. `benches/checks/engine_cost.py`
/// runs this test.
#[test]
#[ignore = "measures for 20 s: use benches/checks/engine_cost.py"]
fn engine_cost() {
    let polygons = shapes::geodesic(32).expect("a sphere");
    let counts = polygons.counts(Facts::from_polygons(&polygons).edges);
    let clock = MachineClock::start();
    let spent = Rc::new(Spent::default());
    let build = |name: &str| {
        let backend = Backend::find(name).expect("a structure");
        let (backend, _) = backend.prepare(&polygons, None).expect("a closed manifold");
        let (clock, spent) = (&clock, Rc::clone(&spent));
        Box::new(Counting {
            backend,
            clock,
            spent,
        }) as Box<dyn TimedBackend + '_>
    };
    let names = ["face-vertex", "winged-edge", "half-edge", "corner-table"];
    let columns = Columns::new(names.map(build).into(), Vec::new(), |first| {
        Some(build(names[first]))
    });
    let stop = AtomicBool::new(false);
    let effort = Effort::Budget(Duration::from_secs(20));
    let trial = Trial {
        polygons: &polygons,
        counts,
        skewed: false,
        entries: columns.entries(&Operation::ALL),
        columns,
        effort,
        named: false,
        forced: false,
        untimed: None,
        seed: 1,
    };
    let mut bench =
        Bench::start(&clock, RunSettings::default(), 0, &stop).expect("the same policy");
    let start = clock.now();
    let measured = bench.measure(trial, &mut |_| ());
    let total = (clock.now() - start).ns();
    assert!(measured.entries.iter().any(|entry| entry.outcome.is_some()));
    let own = total - spent.in_backends.get();
    let [timed, in_backends] = [spent.timed.get(), spent.in_backends.get()];
    let [cost, s] = [own / timed, 1e9];
    println!(
        "engine_cost {cost:.6} own {:.3} s timed {:.3} s in_backends {:.3} s total {:.3} s",
        own / s,
        timed / s,
        in_backends / s,
        total / s
    );
}
