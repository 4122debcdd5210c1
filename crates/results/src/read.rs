//! Reads results from JSON. The JSON may come from another version of Sixfold or from another
//! program.

use std::io;

use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};
use serde_json::error::Category;

use crate::document::SCHEMA;
use crate::finding::KINDS;

/// The reason why a file cannot be read as results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum ReadError {
    /// The file cannot be read from the disk.
    #[error("cannot be read: {cause}")]
    Io { cause: io::Error },
    /// The text ends too early, or is not JSON.
    #[error("{what}, line {line}, column {column}: {cause}")]
    NoJson {
        what: &'static str,
        line: usize,
        column: usize,
        cause: String,
    },
    /// The text is JSON without `schema`, so Sixfold did not write it.
    #[error("is JSON, but has no `schema`: choose a file that sixfold wrote")]
    Foreign,
    /// The file has another version of the schema.
    #[error(
        "has schema {found}, but this version of sixfold reads schema {SCHEMA}: {}",
        remedy(*found)
    )]
    OtherSchema { found: u64 },
    /// The file contains no measurement. For example, `sixfold inspect` or `compare` wrote it.
    #[error("has no findings: choose a file that {} wrote", commands())]
    NoFindings,
    /// A field of the JSON is missing or has an impossible value.
    #[error("is not in the format that sixfold writes: {cause}")]
    Malformed { cause: String },
}

/// Returns the commands that write documents, as in `sixfold study, orders or pick`.
fn commands() -> String {
    let [first, between @ .., last] = KINDS;
    let between: String = between.iter().map(|kind| format!(", `{kind}`")).collect();
    format!("`sixfold {first}`{between} or `{last}`")
}

/// Returns an error if the text is not a document of a schema that can be read.
pub(crate) fn check_schema(text: &str) -> Result<(), ReadError> {
    #[derive(Deserialize)]
    struct Head {
        schema: Option<u64>,
        findings: Option<IgnoredAny>,
    }

    let head: Head = parse_json(text)?;
    match head.schema {
        None => Err(ReadError::Foreign),
        Some(found) if found != u64::from(SCHEMA) => Err(ReadError::OtherSchema { found }),
        Some(_) if head.findings.is_none() => Err(ReadError::NoFindings),
        Some(_) => Ok(()),
    }
}

/// Returns what to do with a file of another schema.
fn remedy(found: u64) -> &'static str {
    match found < u64::from(SCHEMA) {
        true => "measure again, or use the version of sixfold that wrote the file",
        false => "install the latest version",
    }
}

/// Parses JSON. The error distinguishes text that is cut off from text that is not JSON.
pub(crate) fn parse_json<T: DeserializeOwned>(text: &str) -> Result<T, ReadError> {
    serde_json::from_str(text).map_err(|error| {
        // The parser reports a syntax error if the text ends within a number or a word.
        let lines = text.lines().count();
        let last = text.lines().last().map_or(0, str::len);
        let at_the_end = error.line() >= lines && error.column() >= last;
        let what = match error.classify() {
            Category::Syntax if at_the_end && text.trim_start().starts_with('{') => {
                "ends too early, as if it was cut off"
            }
            Category::Eof => "ends too early, as if it was cut off",
            Category::Syntax => "is not JSON",
            Category::Data | Category::Io => {
                return ReadError::Malformed {
                    cause: error.to_string(),
                };
            }
        };
        let (line, column) = (error.line(), error.column());
        let cause = error.to_string();
        let place = format!(" at line {line} column {column}");
        ReadError::NoJson {
            what,
            line,
            column,
            cause: cause.strip_suffix(&place).unwrap_or(&cause).to_owned(),
        }
    })
}
