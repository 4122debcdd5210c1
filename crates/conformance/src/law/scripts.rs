//! Runs laws on random sequences of edits (*scripts*).

use std::cell::RefCell;
use std::fmt::{Debug, Write};

use proptest::prelude::*;
use proptest::test_runner::{Config, TestCaseError, TestError, TestRunner};
use sixfold_core::{Capabilities, Edit, PolygonMesh, Representation};

use crate::catch_panic::catch_panic;
use crate::edit::{Action, Step, script};
use crate::print::one_line;
use crate::strategy::{any_mesh, manifold_mesh};

/// Number of scripts if `PROPTEST_CASES` is not set.
const SCRIPTS: u32 = 64;
const MAX_STEPS: usize = 160;

/// The executed actions of a script, and whether each action was accepted.
pub(super) type Executed = RefCell<Vec<(Action, bool)>>;

/// Calls `run` with random start meshes and random scripts. If `run` panics, shrinks the script and
/// panics with the smallest script that fails. The message begins with the name of the structure
/// and `fault`.
pub(super) fn on_random_scripts<M: Representation>(
    fault: &str,
    run: impl Fn(&PolygonMesh, &[Step], &Executed),
) {
    run_scripts(M::NAME, &M::CAPABILITIES, fault, &run);
}

/// A function of its own, which is compiled once and not for each law and structure.
fn run_scripts(
    name: &str,
    capabilities: &Capabilities,
    fault: &str,
    run: &dyn Fn(&PolygonMesh, &[Step], &Executed),
) {
    let mut config = Config {
        failure_persistence: None,
        max_shrink_iters: 4000,
        ..Config::default()
    };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = SCRIPTS;
    }
    let start = if capabilities.non_manifold_edges {
        prop_oneof![manifold_mesh(), any_mesh()].boxed()
    } else {
        manifold_mesh().boxed()
    };
    let polygons_allowed = capabilities.polygons;
    let start = start.prop_map(move |polygons| {
        if polygons_allowed {
            polygons
        } else {
            polygons.triangulated().expect("small").polygons
        }
    });
    let cases =
        (start, script(&Edit::ALL, MAX_STEPS)).prop_map(|(start, steps)| Case { start, steps });
    let outcome = TestRunner::new(config).run(&cases, |Case { start, steps }| {
        catch_panic(|| run(&start, &steps, &Executed::default()))
            .map_err(|panic| TestCaseError::fail(panic.to_string()))
    });
    match outcome {
        Ok(()) => {}
        Err(TestError::Fail(_, Case { start, steps })) => {
            let executed = Executed::default();
            let panic = catch_panic(|| run(&start, &steps, &executed)).err();
            let mut script = String::new();
            for (action, accepted) in executed.take() {
                let _ = write!(
                    script,
                    "\n  {}{action:?}",
                    if accepted { "" } else { "(refused) " }
                );
            }
            let panic = panic.map_or_else(String::new, |panic| panic.to_string());
            panic!("{name} {fault} on {}{script}\n{panic}", one_line(&start))
        }
        Err(TestError::Abort(reason)) => panic!("{name}: the test was aborted: {reason}"),
    }
}

/// A start mesh and a script, with a short debug output.
struct Case {
    start: PolygonMesh,
    steps: Vec<Step>,
}

impl Debug for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} and {} steps",
            one_line(&self.start),
            self.steps.len()
        )
    }
}
