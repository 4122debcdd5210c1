//! Runs the same random edits on all structures. Checks that the structures accept the same edits
//! and always contain the same mesh.

use std::fmt::{Debug, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};

use proptest::prelude::*;
use proptest::test_runner::{Config, TestCaseError, TestRunner};
use sixfold::for_each_editable;
use sixfold_conformance::edit::{Action, Model, ModelTest, Rules, Step, script};
use sixfold_conformance::strategy::{any_mesh, manifold_mesh};
use sixfold_core::{Capabilities, Edit, MeshEdit, MeshQuery, PolygonMesh, Representation};

/// Number of scripts for each kind of initial mesh.
const SCRIPTS: u32 = 40;
/// Number of steps of a script.
const STEPS: usize = 240;

trait AnyTest {
    fn name(&self) -> &'static str;
    fn rules(&self) -> Rules;
    fn model(&self) -> &Model;
    fn is_legal(&self, action: &Action) -> bool;
    /// Runs the checks of the action on a copy.
    fn apply_to_copy(&self, action: &Action) -> bool;
    fn apply(&mut self, action: &Action) -> bool;
    fn check_all(&mut self);
}

struct Wrapped<M: MeshEdit>(ModelTest<M>);

impl<M: Representation + MeshEdit + Debug> AnyTest for Wrapped<M> {
    fn name(&self) -> &'static str {
        M::NAME
    }
    fn rules(&self) -> Rules {
        Rules::new::<M>()
    }
    fn model(&self) -> &Model {
        &self.0.model
    }
    fn is_legal(&self, action: &Action) -> bool {
        self.0.is_legal(action)
    }
    fn apply_to_copy(&self, action: &Action) -> bool {
        self.0.clone().apply(action)
    }
    fn apply(&mut self, action: &Action) -> bool {
        self.0.apply(action)
    }
    fn check_all(&mut self) {
        self.0.check_all();
    }
}

/// Returns the structures that can hold `start`. The soup is included only if no vertex is
/// isolated, because a soup does not store isolated vertices.
fn tests(start: &PolygonMesh) -> Vec<Box<dyn AnyTest>> {
    let mut tests: Vec<Box<dyn AnyTest>> = Vec::new();
    for_each_editable!(M => {
        if let Some(test) = ModelTest::<M>::from_polygons(start) {
            tests.push(Box::new(Wrapped(test)));
        }
    });
    tests
}

/// Returns the number of editable structures for which `holds` is true.
fn structures(holds: impl Fn(&Capabilities) -> bool) -> usize {
    let mut structures = 0;
    for_each_editable!(M => { structures += usize::from(holds(&M::CAPABILITIES)); });
    structures
}

#[derive(Default)]
struct Counts {
    /// For each edit: the number of steps that all structures accepted, and the number of other
    /// steps.
    steps: [[usize; 2]; Edit::ALL.len()],
    /// For each script: the number of structures.
    tests: Vec<usize>,
}

/// Runs a script on all structures that can hold `start`. If a structure refuses a step, the other
/// structures apply the step only to copies. So all structures continue with the same mesh.
fn run_script(start: &PolygonMesh, steps: &[Step], counts: &mut Counts) -> Result<(), String> {
    let mut tests = tests(start);
    counts.tests.push(tests.len());
    let mut history = String::new();
    for (number, step) in steps.iter().enumerate() {
        let Some(first) = tests.first() else {
            return Ok(());
        };
        let Some(action) = step.action(first.model(), number) else {
            continue;
        };
        let legality: Vec<bool> = tests.iter().map(|test| test.is_legal(&action)).collect();
        check_legality(&tests, &legality, &action)?;
        let all = legality.iter().all(|&legal| legal);
        counts.steps[action.edit() as usize][usize::from(!all)] += 1;
        for test in &mut tests {
            let name = test.name();
            let result = catch_unwind(AssertUnwindSafe(|| match all {
                true => test.apply(&action),
                false => test.apply_to_copy(&action),
            }));
            result.map_err(|fault| {
                let fault = fault.downcast_ref::<String>().cloned().unwrap_or_default();
                format!("{name} fails at {action:?} after{history}\n{fault}")
            })?;
        }
        let mark = if all { "" } else { "(not by all) " };
        let _ = write!(history, "\n  {mark}{action:?}");
        if number % 40 == 39 {
            tests.iter_mut().for_each(|test| test.check_all());
        }
    }
    tests.iter_mut().for_each(|test| test.check_all());
    Ok(())
}

/// Checks which structures accept an action.
/// - The three manifold structures must give the same answer. The corner table is exempt if it does
///   not support the action, or if the action makes a polygon.
/// - If the manifold structures accept the action, every other structure must accept it.
///   Structures that do not support the action, or that merge vertices, are exempt.
fn check_legality(
    tests: &[Box<dyn AnyTest>],
    legality: &[bool],
    action: &Action,
) -> Result<(), String> {
    let answers = tests.iter().zip(legality);
    let manifold = answers
        .clone()
        .filter(|(p, _)| !p.rules().capabilities.non_manifold_edges);
    let mut accepted_by_manifold = None;
    for (test, &legal) in manifold {
        let rules = test.rules();
        let is_comparable = rules.capabilities.polygons || is_offered_to_triangles(action, &rules);
        match accepted_by_manifold {
            Some(others) if others != legal && is_comparable => {
                return Err(format!(
                    "{} gives another answer for {action:?} than the other manifold structures",
                    test.name()
                ));
            }
            None if is_comparable => accepted_by_manifold = Some(legal),
            _ => {}
        }
    }
    for (test, &legal) in answers {
        let rules = test.rules();
        let is_exempt = !rules.supported[action.edit() as usize]
            || !rules.capabilities.coincident_vertices
            || !rules.capabilities.polygons;
        if accepted_by_manifold == Some(true) && !legal && !is_exempt {
            return Err(format!(
                "{} refuses {action:?}, which a manifold structure accepts",
                test.name()
            ));
        }
    }
    Ok(())
}

/// Returns whether the structure supports the action, and the action makes only triangles from
/// triangles.
fn is_offered_to_triangles(action: &Action, rules: &Rules) -> bool {
    let makes_polygons = matches!(action, Action::AddFace { corners } if corners.len() > 3);
    rules.supported[action.edit() as usize] && !makes_polygons
}

/// Runs random scripts on meshes from `starts`. Checks that more than a fifth of the scripts run on
/// exactly `structures` structures. Checks for each edit that all structures accept more than one
/// step in `steps_per_accepted`.
fn run_scripts(
    starts: impl Strategy<Value = PolygonMesh>,
    edits: &[Edit],
    structures: usize,
    steps_per_accepted: usize,
) {
    let mut config = Config {
        failure_persistence: None,
        max_shrink_iters: 2000,
        ..Config::default()
    };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = SCRIPTS;
    }
    let counts = std::cell::RefCell::new(Counts::default());
    let cases = (starts, script(edits, STEPS));
    let cases = cases.prop_map(|(start, steps)| (OneLineDebug(start), ShortDebug(steps)));
    let outcome = TestRunner::new(config).run(&cases, |(start, steps)| {
        run_script(&start.0, &steps.0, &mut counts.borrow_mut()).map_err(TestCaseError::fail)
    });
    if let Err(error) = outcome {
        panic!("{error}");
    }
    let Counts { steps, tests } = counts.into_inner();
    let complete = tests.iter().filter(|&&count| count == structures).count();
    assert!(
        5 * complete > tests.len(),
        "{structures} take part in {complete} of {} scripts",
        tests.len()
    );
    for (edit, [accepted, others]) in Edit::ALL.into_iter().zip(steps) {
        println!(
            "{edit}: {accepted} of {} accepted by all",
            accepted + others
        );
        if edits.contains(&edit) && accepted + others > 100 {
            assert!(
                accepted * steps_per_accepted > accepted + others,
                "{edit}: {accepted} accepted by all, {others} not"
            );
        }
    }
}

struct OneLineDebug(PolygonMesh);

impl Debug for OneLineDebug {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&sixfold_conformance::one_line(&self.0))
    }
}

struct ShortDebug(Vec<Step>);

impl Debug for ShortDebug {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} steps", self.0.len())
    }
}

/// Edits that make triangles from triangles and that every structure supports.
const TRIANGLE_EDITS: [Edit; 11] = [
    Edit::SetPosition,
    Edit::AddFace,
    Edit::RemoveFace,
    Edit::RemoveVertex,
    Edit::RemoveIsolatedVertices,
    Edit::BisectEdge,
    Edit::PokeFace,
    Edit::FlipEdge,
    Edit::CollapseEdge,
    Edit::SplitVertex,
    Edit::Compact,
];

fn without_isolated(polygons: &PolygonMesh) -> PolygonMesh {
    sixfold_conformance::welded(polygons).expect("a manifold has distinct positions")
}

#[test]
fn all_agree_on_triangles() {
    // The soup numbers vertices by their first use, also after polygons were cut.
    let starts =
        manifold_mesh().prop_map(|m| without_isolated(&m.triangulated().expect("small").polygons));
    run_scripts(starts, &TRIANGLE_EDITS, structures(|_| true), 8);
}

#[test]
fn those_for_polygons_agree_on_polygons() {
    // A corner table cannot hold quads.
    let starts = manifold_mesh().prop_filter_map("only triangles", |mesh| {
        let mesh = without_isolated(&mesh);
        let polygons = mesh.faces().iter().any(|(_, face)| face.len() > 3);
        polygons.then_some(mesh)
    });
    let edits: Vec<Edit> = Edit::ALL
        .into_iter()
        .filter(|&e| e != Edit::AddVertex)
        .collect();
    run_scripts(starts, &edits, structures(|can| can.polygons), 12);
}

#[test]
fn those_for_non_manifolds_agree_on_them() {
    let starts = any_mesh().prop_filter_map("two corners at one point", |mesh| {
        sixfold_conformance::welded(&mesh).ok()
    });
    let edits: Vec<Edit> = Edit::ALL
        .into_iter()
        .filter(|&e| e != Edit::AddVertex)
        .collect();
    let holders = structures(|can| can.non_manifold_edges && can.non_manifold_vertices);
    run_scripts(starts, &edits, holders, 20);
}
