//! Why a command ends without its result.

use std::fmt::Display;

/// What to say, and with which code to exit.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The exit code.
    pub(crate) code: u8,
    /// One clear message that says what to do next.
    pub(crate) message: String,
}

impl Failure {
    /// Wrong usage, or unusable input.
    pub(crate) fn usage(message: impl Display) -> Self {
        Self {
            code: 2,
            message: message.to_string(),
        }
    }

    /// A mesh that the backend asked for does not hold, where another may.
    pub(crate) fn not_held(refusal: impl Display) -> Self {
        Self::unsupported(format!(
            "{refusal}; or take another --backend: `sixfold inspect` says which hold the mesh"
        ))
    }

    /// Not supported by the backends asked for.
    pub(crate) fn unsupported(message: impl Display) -> Self {
        Self {
            code: 3,
            message: message.to_string(),
        }
    }
}
