//! The main function of test programs that count what their whole process does; the other tests are
//! in `main.rs`.

pub use libtest_mimic::{Arguments, Trial, run};

/// Defines `main`, which runs these test functions on one thread, because other threads would be
/// counted too. The program has the options of other test programs: it lists its tests, and runs
/// those that are named.
#[macro_export]
macro_rules! main_on_one_thread {
    ($($test:ident),+ $(,)?) => {
        fn main() {
            let arguments = $crate::Arguments {
                test_threads: Some(1),
                ..$crate::Arguments::from_args()
            };
            let tests = vec![$($crate::Trial::test(stringify!($test), || {
                $test();
                Ok(())
            })),+];
            $crate::run(&arguments, tests).exit();
        }
    };
}
