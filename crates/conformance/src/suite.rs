//! The macros and functions that run the laws on a structure.

use proptest::strategy::{Strategy, Union};
use proptest::test_runner::{Config, TestCaseError, TestError, TestRunner};
use sixfold_core::{PolygonMesh, Representation};

use crate::catch_panic::catch_panic;
use crate::gallery::gallery;
use crate::print::one_line;
use crate::shrink::shrink;
use crate::strategy::{any_mesh, faulty_mesh, manifold_mesh};

/// Makes one `#[test]` from each law. Example:
/// `sixfold_conformance::suite!(half_edge::HalfEdgeMesh);`
///
/// A law is a requirement that every structure must satisfy. A law about a mesh runs on all
/// hand-made meshes of the gallery and on random meshes. A failing random mesh is shrunk and
/// printed on one line. The environment variable `PROPTEST_CASES` sets the number of random meshes
/// per law.
#[macro_export]
macro_rules! suite {
    ($mesh:ty) => {
        $crate::for_each_law!(suite_of_laws! { $mesh });
    };
}

/// The callback that makes the tests of [`suite!`].
#[doc(hidden)]
#[macro_export]
macro_rules! suite_of_laws {
    ([$($law:ident)+] [$($structural:ident)+] $mesh:ty) => {
        $(
            #[test]
            fn $law() {
                $crate::check_law::<$mesh>(stringify!($law), $crate::law::$law::<$mesh>);
            }
        )+
        $(
            #[test]
            fn $structural() {
                $crate::law::$structural::<$mesh>();
            }
        )+
    };
}

/// Makes the tests for a structure that refines its own tables:
/// `sixfold_conformance::refine_suite!(half_edge::HalfEdgeMesh);`
#[macro_export]
macro_rules! refine_suite {
    ($mesh:ty) => {
        #[test]
        fn refine() {
            $crate::check_law::<$mesh>("refine", $crate::law::refine::<$mesh>);
        }

        #[test]
        fn refine_in_parallel() {
            $crate::law::refine_in_parallel::<$mesh>();
        }
    };
}

/// Makes the tests for a structure that can be edited:
/// `sixfold_conformance::edit_suite!(half_edge::EditableHalfEdgeMesh);`
#[macro_export]
macro_rules! edit_suite {
    ($mesh:ty) => {
        #[test]
        fn edits() {
            $crate::law::edits::<$mesh>();
        }

        #[test]
        fn edit_limits() {
            $crate::law::edit_limits::<$mesh>();
        }

        #[test]
        fn inverse_edits() {
            $crate::law::inverse_edits::<$mesh>();
        }

        #[test]
        fn data_follows_edits() {
            $crate::law::data_follows_edits::<$mesh>();
        }

        #[test]
        fn names_follow_edits() {
            $crate::law::names_follow_edits::<$mesh>();
        }

        #[test]
        fn edit_costs() {
            $crate::law::edit_costs::<$mesh>();
        }
    };
}

/// Makes the tests for a structure that implements `OrientedWalk`:
/// `sixfold_conformance::walk_suite!(half_edge::HalfEdgeMesh, half_edge::EditableHalfEdgeMesh);`
///
/// The second type is the editable form of the structure. Without the second type, the macro leaves
/// out two tests: the test after edits, and the test that steps are local.
#[macro_export]
macro_rules! walk_suite {
    ($mesh:ty) => {
        #[test]
        fn oriented_walk() {
            $crate::check_law::<$mesh>("oriented_walk", $crate::law::oriented_walk::<$mesh>);
        }
    };
    ($mesh:ty, $editable:ty) => {
        $crate::walk_suite!($mesh);

        #[test]
        fn oriented_walk_after_edits() {
            $crate::law::oriented_walk_after_edits::<$editable>();
        }

        #[test]
        fn oriented_walk_costs() {
            $crate::law::oriented_walk_costs::<$mesh>();
        }
    };
}

/// Number of random meshes per law if `PROPTEST_CASES` is not set.
const CASES: u32 = 192;

/// Calls `law` with every mesh of the gallery, and with random manifold, faulty and arbitrary
/// meshes.
///
/// # Panics
///
/// Panics if the structure `M` breaks the law. The message shows the mesh. A random mesh is shrunk
/// before it is shown.
pub fn check_law<M: Representation>(name: &str, law: impl Fn(&PolygonMesh)) {
    check_named_law(&format!("{}: {name}", M::NAME), &law);
}

/// A function of its own, which is compiled once and not for each law and structure.
fn check_named_law(name: &str, law: &dyn Fn(&PolygonMesh)) {
    for entry in gallery() {
        if let Err(fault) = catch_panic(|| law(&entry.polygons)) {
            let mesh = one_line(&entry.polygons);
            panic!("{name} fails on “{}” ({mesh})\n{fault}", entry.name);
        }
    }
    let mut config = Config {
        failure_persistence: None,
        ..Config::default()
    };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = CASES;
    }
    let outcome = TestRunner::new(config).run(&random_mesh(), |OneLineDebug(polygons)| {
        catch_panic(|| law(&polygons)).map_err(|fault| TestCaseError::fail(fault.to_string()))
    });
    match outcome {
        Ok(()) => {}
        Err(TestError::Fail(fault, OneLineDebug(mesh))) => {
            let fails = |mesh: &PolygonMesh| catch_panic(|| law(mesh)).err();
            let mesh = shrink(mesh, |mesh| fails(mesh).is_some());
            let fault = fails(&mesh).map_or(fault.to_string(), |fault| fault.to_string());
            panic!("{name} fails on {}\n{fault}", one_line(&mesh))
        }
        Err(TestError::Abort(reason)) => panic!("{name}: the test was aborted: {reason}"),
    }
}

fn random_mesh() -> impl Strategy<Value = OneLineDebug> {
    let faulty = faulty_mesh().prop_map(|faulty| faulty.polygons);
    Union::new_weighted(vec![
        (2, manifold_mesh().boxed()),
        (1, faulty.boxed()),
        (1, any_mesh().boxed()),
    ])
    .prop_map(OneLineDebug)
}

/// A mesh whose debug output is one line.
struct OneLineDebug(PolygonMesh);

impl std::fmt::Debug for OneLineDebug {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&one_line(&self.0))
    }
}
