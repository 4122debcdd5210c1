//! Catches expected panics without printing them.

use std::any::Any;
use std::cell::RefCell;
use std::fmt;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CaughtPanic {
    pub(crate) message: String,
    location: String,
}

impl fmt::Display for CaughtPanic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n(at {})", self.message, self.location)
    }
}

thread_local! {
    /// File and line of the last panic of this thread; `None` outside [`catch_panic`].
    static LOCATION: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Calls `action`, and catches a panic without printing it.
///
/// Panics of other threads are printed as usual.
pub(crate) fn catch_panic<T>(action: impl FnOnce() -> T) -> Result<T, CaughtPanic> {
    let (mut action, mut result) = (Some(action), None);
    catch_call(&mut || result = action.take().map(|action| action()))?;
    Ok(result.expect("the action was called and has returned"))
}

/// A function of its own, which is compiled once and not for each action.
fn catch_call(action: &mut dyn FnMut()) -> Result<(), CaughtPanic> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let print = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            let captured = LOCATION.with_borrow_mut(|location| {
                let Some(location) = location.as_mut() else {
                    return false;
                };
                *location = panic
                    .location()
                    .map(ToString::to_string)
                    .unwrap_or_default();
                true
            });
            if !captured {
                print(panic);
            }
        }));
    });
    let outer = LOCATION.replace(Some(String::new()));
    let outcome = panic::catch_unwind(AssertUnwindSafe(action));
    let location = LOCATION.replace(outer).unwrap_or_default();
    outcome.map_err(|payload| CaughtPanic {
        message: message(payload.as_ref()),
        location,
    })
}

fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().cloned();
    let text = text.or_else(|| payload.downcast_ref::<&str>().map(ToString::to_string));
    text.unwrap_or_else(|| "a panic without a message".to_owned())
}

#[cfg(test)]
mod tests {
    use super::{CaughtPanic, catch_panic};

    #[test]
    fn a_caught_panic_has_its_message_and_location() {
        assert_eq!(catch_panic(|| 7), Ok(7));
        let caught: Result<(), CaughtPanic> = catch_panic(|| {
            let inner: Result<(), CaughtPanic> = catch_panic(|| panic!("inner"));
            let inner = inner.expect_err("it panics");
            assert_eq!(inner.message, "inner");
            panic!("outer {}", 1)
        });
        let caught = caught.expect_err("it panics").to_string();
        assert!(
            caught.starts_with("outer 1\n(at ") && caught.contains("catch_panic.rs:"),
            "{caught}"
        );
    }
}
