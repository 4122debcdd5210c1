//! Catches expected panics without printing them.

use std::any::Any;
use std::cell::RefCell;
use std::fmt;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

/// A panic that was caught.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Caught {
    /// Message of the panic.
    pub(crate) message: String,
    /// File and line of the panic.
    place: String,
}

impl fmt::Display for Caught {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n(at {})", self.message, self.place)
    }
}

thread_local! {
    /// Place of the last panic of this thread; `None` outside [`caught`].
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Calls `action`, and catches a panic without printing it.
///
/// While a mesh shrinks, a law fails a hundred times, and a hundred backtraces would hide the
/// relevant message. Panics of other threads are printed as usual.
pub(crate) fn caught<T>(action: impl FnOnce() -> T) -> Result<T, Caught> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let print = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            let heard = PLACE.with_borrow_mut(|place| {
                let listening = place.as_mut();
                let Some(place) = listening else { return false };
                *place = panic
                    .location()
                    .map(ToString::to_string)
                    .unwrap_or_default();
                true
            });
            if !heard {
                print(panic);
            }
        }));
    });
    let outer = PLACE.replace(Some(String::new()));
    let outcome = panic::catch_unwind(AssertUnwindSafe(action));
    let place = PLACE.replace(outer).unwrap_or_default();
    outcome.map_err(|payload| Caught {
        message: message(payload.as_ref()),
        place,
    })
}

/// Returns the message of a panic.
fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().cloned();
    let text = text.or_else(|| payload.downcast_ref::<&str>().map(ToString::to_string));
    text.unwrap_or_else(|| "a panic without a message".to_owned())
}

#[cfg(test)]
mod tests {
    use super::{Caught, caught};

    #[test]
    fn a_caught_panic_has_its_message_and_place() {
        assert_eq!(caught(|| 7), Ok(7));
        let told: Result<(), Caught> = caught(|| {
            let inner: Result<(), Caught> = caught(|| panic!("inner"));
            let inner = inner.expect_err("it panics");
            assert_eq!(inner.message, "inner");
            panic!("outer {}", 1)
        });
        let told = told.expect_err("it panics").to_string();
        assert!(
            told.starts_with("outer 1\n(at ") && told.contains("caught.rs:"),
            "{told}"
        );
    }
}
