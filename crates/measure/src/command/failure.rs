//! Errors that end a command without a result.

use std::fmt::Display;

/// An error message and an exit code.
#[derive(Debug)]
pub struct Failure {
    pub code: u8,
    /// The message, with advice.
    pub message: String,
}

impl Failure {
    const UNSUPPORTED: u8 = 3;

    /// Returns a failure for wrong usage or unusable input.
    pub fn usage(message: impl Display) -> Self {
        Self {
            code: 2,
            message: message.to_string(),
        }
    }

    /// Returns a failure for a backend that does not exist.
    pub fn no_backend(name: &str) -> Self {
        Self::usage(format!("no backend is called `{name}`"))
    }

    /// Returns a failure for a mesh that `structure` cannot hold.
    pub fn cannot_hold(structure: &str, refusal: impl Display) -> Self {
        Self::unsupported(format!(
            "{refusal}; `sixfold repair --for {structure}` makes a mesh that it can hold; or choose \
             another --backend: `sixfold inspect` shows which backends can hold the mesh"
        ))
    }

    /// Returns a failure for work that the selected backends do not support.
    pub fn unsupported(message: impl Display) -> Self {
        Self {
            code: Self::UNSUPPORTED,
            message: message.to_string(),
        }
    }

    /// Returns whether this is a failure for work that the selected backends do not support.
    pub const fn is_unsupported(&self) -> bool {
        self.code == Self::UNSUPPORTED
    }
}
