//! Parses workload files (TOML).

use std::fmt;
use std::ops::Range;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use sixfold::UnknownName;
use toml::Spanned;

use crate::workload::{Access, Action, Amount, NumberOrText, Part, Workload};
use sixfold_measure::ElementKind;
use sixfold_results::OwnData;

/// An error in a workload file, with the number of the line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {message}")]
#[non_exhaustive]
pub struct WorkloadError {
    /// The name of the file.
    pub file: String,
    /// The line number, from 1.
    pub line: usize,
    /// The description of the error, with the allowed values.
    pub message: String,
}

/// The content of the file before the checks.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct WorkloadFile {
    summary: Option<String>,
    access: Option<Spanned<String>>,
    operations: Option<Spanned<NumberOrText>>,
    rebuilds: Option<Spanned<i64>>,
    own_ns: Option<Spanned<f64>>,
    own_data: Option<Spanned<OwnData>>,
    mix: Option<Spanned<Mix>>,
}

/// The table of the mix, in file order.
struct Mix(Vec<(Spanned<String>, Spanned<NumberOrText>)>);

impl<'de> Deserialize<'de> for Mix {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;

        impl<'de> Visitor<'de> for Entries {
            type Value = Mix;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table of operations and their weights")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Mix, A::Error> {
                let mut entries = Vec::new();
                while let Some(key) = map.next_key()? {
                    entries.push((key, map.next_value()?));
                }
                // The parser sorts keys by name. Restore the file order.
                entries.sort_by_key(|(key, _): &(Spanned<String>, _)| key.span().start);
                Ok(Mix(entries))
            }
        }

        deserializer.deserialize_map(Entries)
    }
}

impl Workload {
    /// Parses the file content `text` as the workload `name`. Errors contain the file name `file`.
    ///
    /// ```
    /// let text = "operations = '20 per vertex'\n[mix]\nvertex_faces = 1\nneighbour_positions = 0.5";
    /// let workload = sixfold_workload::Workload::parse("mine", "mine.toml", text)?;
    /// assert_eq!(workload.mix.len(), 2);
    /// # Ok::<(), sixfold_workload::WorkloadError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if the text is not TOML, if a key or name is unknown, or if a number is out
    /// of range.
    pub fn parse(name: &str, file: &str, text: &str) -> Result<Self, WorkloadError> {
        let at = |span: Range<usize>, message: String| WorkloadError {
            file: file.into(),
            line: 1 + text[..span.start.min(text.len())].matches('\n').count(),
            message,
        };
        let parsed: WorkloadFile = toml::from_str(text)
            .map_err(|error| at(error.span().unwrap_or(0..0), one_line(error.message())))?;

        // The mix comes first: a wrong name in it says more than another key that is missing.
        let mix = match &parsed.mix {
            Some(mix) => parse_mix(mix, &at)?,
            None => {
                let message =
                    "missing table `[mix]`: list operations with weights, as in `vertex_faces = 1`";
                return Err(at(0..0, message.into()));
            }
        };
        let access = match &parsed.access {
            None => Access::Sequential,
            Some(word) => (word.get_ref().parse())
                .map_err(|error: UnknownName| at(word.span(), error.to_string()))?,
        };
        let Some(operations) = &parsed.operations else {
            let message = "missing key `operations`: give the number of operations of the program, as in `operations = \"20 per face\"`";
            return Err(at(0..0, message.into()));
        };
        let span = operations.span();
        let operations =
            amount(operations.get_ref()).and_then(|amount| match is_positive(amount) {
                true => Ok(amount),
                false => Err(format!(
                    "operations must be more than 0 and at most {MAX_AMOUNT:e}, not {amount}"
                )),
            });
        let operations = operations.map_err(|message| at(span, message))?;
        let rebuilds = match &parsed.rebuilds {
            None => 0,
            Some(number) => u64::try_from(*number.get_ref()).map_err(|_| {
                let message = format!("rebuilds must be 0 or more, not {}", number.get_ref());
                at(number.span(), message)
            })?,
        };
        let own_ns = match &parsed.own_ns {
            None => 0.0,
            Some(number) if (0.0..=MAX_AMOUNT).contains(number.get_ref()) => *number.get_ref(),
            Some(number) => {
                let message = format!("own_ns must be 0 or greater, not {}", number.get_ref());
                return Err(at(number.span(), message));
            }
        };
        let own_data = match &parsed.own_data {
            None => OwnData::default(),
            Some(data) => checked_data(data, &at)?,
        };
        Ok(Self {
            own_ns,
            own_data,
            name: name.into(),
            summary: parsed.summary.unwrap_or_default(),
            access,
            operations,
            rebuilds,
            mix,
        })
    }
}

/// Maximum number of bytes of the program's own data of one element.
const MAX_OWN_BYTES: u32 = 4096;

/// Checks the size of the program's own data.
fn checked_data(
    data: &Spanned<OwnData>,
    at: &dyn Fn(Range<usize>, String) -> WorkloadError,
) -> Result<OwnData, WorkloadError> {
    let own_data = *data.get_ref();
    for kind in ElementKind::ALL {
        let bytes = kind.own_bytes(&own_data);
        let most = bytes.read.max(bytes.written);
        if most > MAX_OWN_BYTES {
            let kind = kind.name();
            let message =
                format!("own_data: at most {MAX_OWN_BYTES} bytes for each {kind}, not {most}");
            return Err(at(data.span(), message));
        }
    }
    Ok(own_data)
}

/// Maximum amount. It is small enough for exact `f64` arithmetic.
const MAX_AMOUNT: f64 = 1e15;

/// Parses the parts with a weight, in file order.
fn parse_mix(
    mix: &Spanned<Mix>,
    at: &dyn Fn(Range<usize>, String) -> WorkloadError,
) -> Result<Vec<Part>, WorkloadError> {
    let mut parts = Vec::new();
    for (key, value) in &mix.get_ref().0 {
        let action: Result<Action, _> = key.get_ref().parse();
        let action = action.map_err(|error| at(key.span(), error.to_string()))?;
        let weight = amount(value.get_ref()).and_then(|weight| {
            let fine = weight.number() == 0.0 || is_positive(weight);
            let wrong = || format!("a weight must be from 0 to {MAX_AMOUNT:e}, not {weight}");
            fine.then_some(weight).ok_or_else(wrong)
        });
        let weight = weight.map_err(|message| at(value.span(), message))?;
        if weight.number() > 0.0 {
            parts.push(Part { action, weight });
        }
    }
    if parts.is_empty() {
        let message = "the mix has no operation with a weight above 0: add one, such as \
                       `vertex_faces = 1`";
        return Err(at(mix.span(), message.into()));
    }
    Ok(parts)
}

/// Returns whether an amount is more than 0 and at most the maximum.
fn is_positive(amount: Amount) -> bool {
    amount.number() > 0.0 && amount.number() <= MAX_AMOUNT
}

fn amount(loose: &NumberOrText) -> Result<Amount, String> {
    loose.amount().map_err(|error| error.to_string())
}

/// Returns the message of the parser on one line.
fn one_line(message: &str) -> String {
    message.lines().collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use sixfold::{Edit, Relation};
    use sixfold_core::Counts;

    use super::*;
    use crate::built_in::{built_in, built_ins};
    use sixfold_results::OwnBytes;

    fn parse(text: &str) -> Result<Workload, WorkloadError> {
        Workload::parse("mine", "mine.toml", text)
    }

    #[test]
    fn a_file_with_all_keys_is_parsed() {
        let text = "summary = 'who'\naccess = 'patches'\noperations = '20 per face'\nrebuilds = 3\nown_ns = 2.5\n\
            own_data = { face = { read = 4, written = 12 }, vertex.read = 8 }\n\
            [mix]\nflip_edge = 1\nvertex_faces = '2 per edge'\nboundary = 0.5\nposition = 0";
        let workload = parse(text).expect("fine");
        let part = |action, weight| Part { action, weight };
        let expected = Workload {
            name: "mine".into(),
            summary: "who".into(),
            access: Access::Patches,
            operations: Amount::Per(20.0, ElementKind::Face),
            rebuilds: 3,
            own_ns: 2.5,
            own_data: OwnData {
                vertex: OwnBytes {
                    read: 8,
                    written: 0,
                },
                edge: OwnBytes::default(),
                face: OwnBytes {
                    read: 4,
                    written: 12,
                },
            },
            mix: vec![
                part(Action::Edit(Edit::FlipEdge), Amount::Number(1.0)),
                part(
                    Action::Relation(Relation::VertexFaces),
                    Amount::Per(2.0, ElementKind::Edge),
                ),
                part(
                    Action::Pass(sixfold_measure::Operation::Boundary),
                    Amount::Number(0.5),
                ),
            ],
        };
        assert_eq!(workload, expected);
        let counts = Counts {
            vertices: 4,
            edges: 6,
            faces: 4,
            corners: 12,
            uniform: true,
        };
        assert_eq!(workload.operations_on(&counts), 80.0);
        assert_eq!(
            workload.shares(&counts),
            [1.0 / 13.5, 12.0 / 13.5, 0.5 / 13.5]
        );
        assert!(!workload.is_read_only());
    }

    #[test]
    fn errors_have_their_line_and_the_allowed_values() {
        let cases = [
            (
                "operations = 5\n[mix]\nvertex_face = 1",
                3,
                "choose from vertex_vertices, ",
            ),
            (
                "operations = 5\naccess = 'zigzag'\n[mix]\nposition = 1",
                2,
                "sequential, random, patches, front, by_face, by_edge",
            ),
            (
                "operations = 5\nown_ns = nan\n[mix]\nposition = 1",
                2,
                "own_ns must be 0 or greater",
            ),
            (
                "operations = 5\nown_ns = -1.5\n[mix]\nposition = 1",
                2,
                "own_ns must be 0 or greater, not -1.5",
            ),
            (
                "operations = 5\nown_data = { edge.written = 4097 }\n[mix]\nposition = 1",
                2,
                "at most 4096 bytes for each edge, not 4097",
            ),
            (
                "operations = 5\nown_data = { halfedge.written = 4 }\n[mix]\nposition = 1",
                2,
                "unknown field `halfedge`",
            ),
            (
                "operations = 5\nown_data = { edge.read = -1 }\n[mix]\nposition = 1",
                2,
                "u32",
            ),
            ("operations = 0\n[mix]\nposition = 1", 1, "more than 0"),
            ("operations = 'nan'\n[mix]\nposition = 1", 1, "more than 0"),
            (
                "operations = '5 per cow'\n[mix]\nposition = 1",
                1,
                "vertex, edge or face",
            ),
            (
                "operations = true\n[mix]\nposition = 1",
                1,
                "expected a number such as `20`, or a text such as `\"2 per face\"`",
            ),
            (
                "operations = 5\n[mix]\nposition = [1]",
                3,
                "expected a number such as `20`, or a text",
            ),
            (
                "operations = 5\nrebuilds = -1\n[mix]\nposition = 1",
                2,
                "0 or more",
            ),
            (
                "operations = 5\n\n[mix]\nposition = 1\nedge_faces = -1",
                5,
                "a weight must be from 0",
            ),
            (
                "operations = 5\n\n[mix]\nposition = inf",
                4,
                "a weight must be from 0",
            ),
            ("operations = 5\n[mix]\nposition = 0", 2, "weight above 0"),
            (
                "operations = 5\n[mix]\nposition = 1\nposition = 2",
                4,
                "duplicate key",
            ),
            (
                "operations = 5\nspeed = 3\n[mix]\nposition = 1",
                2,
                "unknown field `speed`, expected one of",
            ),
            ("operations = 5\nmix = 3", 2, "a table of operations"),
            ("operations = 5", 1, "missing table `[mix]`"),
            ("[mix]\nposition = 1", 1, "missing key `operations`"),
            (
                "\n[mix]\nvertex_face = 1",
                3,
                "choose from vertex_vertices, ",
            ),
            ("operations = \n[mix]\nposition = 1", 1, ""),
        ];
        for (text, line, expected) in cases {
            let error = parse(text).expect_err(text);
            assert_eq!(error.line, line, "{text}: {error}");
            assert!(error.to_string().contains(expected), "{text}: {error}");
            assert!(error.to_string().starts_with("mine.toml:"), "{error}");
        }
    }

    #[test]
    fn built_in_files_are_parsed_and_have_a_summary() {
        assert!(built_ins().count() >= 12);
        for (name, _) in built_ins() {
            let workload = built_in(name).expect("it is built in");
            assert!(workload.summary.ends_with('.'), "{name}");
            assert!(workload.summary.len() > 40, "{name}");
        }
        assert_eq!(built_in("abacus"), None);
    }

    #[test]
    fn every_name_parses_to_its_action() {
        for each in Action::all() {
            assert_eq!(each.name().parse(), Ok(each));
        }
    }
}
