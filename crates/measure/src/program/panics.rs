//! Catches the panics of programs, with their places.

use std::any::Any;
use std::cell::RefCell;
use std::ffi::OsStr;
use std::panic::{self, AssertUnwindSafe, Location, PanicHookInfo};
use std::path::{Component, Path};
use std::sync::Once;

thread_local! {
    /// The place of the last panic of this thread; `None` outside of [`catch`].
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Calls `action`. If it panics, returns the message and the place of the panic.
///
/// A panic of this thread is not printed, except with a backtrace if the environment variable `RUST_BACKTRACE` is set.
pub(super) fn catch<T>(action: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let print = panic::take_hook();
        panic::set_hook(Box::new(move |info| note(info, &print)));
    });
    let outer = PLACE.replace(Some(String::new()));
    let outcome = panic::catch_unwind(AssertUnwindSafe(action));
    let place = PLACE.replace(outer).filter(|place| !place.is_empty());
    outcome.map_err(|payload| {
        let message = message(payload.as_ref());
        match place {
            Some(place) => format!("{message} (at {place})"),
            None => message,
        }
    })
}

/// Keeps the place of a panic in [`catch`]. Prints every other panic.
fn note(info: &PanicHookInfo<'_>, print: &dyn Fn(&PanicHookInfo<'_>)) {
    let is_caught = PLACE.with_borrow_mut(|place| match place {
        Some(place) => {
            *place = info.location().map_or(String::new(), short);
            true
        }
        None => false,
    });
    if is_printed(is_caught, std::env::var_os("RUST_BACKTRACE").as_deref()) {
        print(info);
    }
}

/// Returns whether a panic is printed: one that [`catch`] reports only if the variable `RUST_BACKTRACE` asks for more.
fn is_printed(is_caught: bool, backtrace: Option<&OsStr>) -> bool {
    !is_caught || backtrace.is_some_and(|value| value != "0")
}

/// Returns a place as `file:line:column`. Of an absolute path, only the folder of the package and what follows is left.
fn short(place: &Location<'_>) -> String {
    let (line, column) = (place.line(), place.column());
    format!("{}:{line}:{column}", in_package(place.file()))
}

fn in_package(file: &str) -> String {
    let path = Path::new(file);
    if !path.is_absolute() {
        return file.to_owned();
    }
    let names = path.components().filter_map(|part| match part {
        Component::Normal(name) => Some(name.to_string_lossy()),
        _ => None,
    });
    let names: Vec<_> = names.collect();
    let sources = names.iter().rposition(|name| name == "src");
    let first = sources.map_or(names.len() - 1, |at| at.saturating_sub(1));
    names[first..].join("/")
}

fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "without a message".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caught_panic_has_its_message_and_place() {
        assert_eq!(catch(|| 7), Ok(7));
        let caught = catch(|| {
            let inner = catch(|| panic!("inner")).map(|(): ()| ());
            assert!(inner.expect_err("a panic").starts_with("inner (at "));
            panic!("outer {}", 1)
        });
        let caught = caught.map(|(): ()| ()).expect_err("a panic");
        let place = caught.strip_prefix("outer 1 (at ").expect(&caught);
        assert!(place.contains("panics.rs:"), "{caught}");
    }

    #[test]
    fn a_caught_panic_is_printed_only_if_a_backtrace_is_asked_for() {
        assert!(is_printed(false, None));
        assert!(is_printed(false, Some(OsStr::new("0"))));
        assert!(!is_printed(true, None));
        assert!(!is_printed(true, Some(OsStr::new("0"))));
        assert!(is_printed(true, Some(OsStr::new("1"))));
    }

    #[test]
    #[cfg(unix)]
    fn a_place_does_not_name_the_folders_of_the_machine() {
        assert_eq!(in_package("src/main.rs"), "src/main.rs");
        let registry =
            "/home/me/.cargo/registry/src/index-1/sixfold-core-0.1.0/src/handles/handle.rs";
        assert_eq!(
            in_package(registry),
            "sixfold-core-0.1.0/src/handles/handle.rs"
        );
        assert_eq!(in_package("/tmp/program.rs"), "program.rs");
        assert_eq!(in_package("/src/main.rs"), "src/main.rs");
    }
}
