//! The main function of test programs that count events of their whole process. The other tests are
//! in `main.rs`.

pub use libtest_mimic::{Arguments, Trial, run};

/// Defines `main`, which runs these test functions on one thread. Events of other threads would
/// also be counted. The program has the usual options of test programs, for example to list tests
/// or to run named tests.
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
