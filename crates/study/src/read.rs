//! Reads results from JSON. The JSON may come from another version of Sixfold or from another
//! program.

use std::io;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::error::Category;

use crate::collection::Collection;
use crate::growth::GrowthReport;
use crate::orders::OrdersReport;
use crate::pick::PickReport;
use crate::report::{Report, SCHEMA};
use crate::why::Why;

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
    /// The text is JSON, but Sixfold did not write it.
    #[error("is JSON, but has no `schema`: choose a file that sixfold wrote")]
    Foreign,
    /// The file has another version of the schema.
    #[error(
        "has schema {found}, expected {SCHEMA}: use the version of sixfold that wrote the file, \
         or measure again"
    )]
    OtherSchema { found: u64 },
    /// The results are from another command than expected.
    #[error("is {found}, expected {wanted}")]
    OtherKind {
        found: &'static str,
        wanted: &'static str,
    },
    /// A field of the JSON is missing or invalid.
    #[error("is not in the format that sixfold writes: {cause}")]
    Malformed { cause: String },
}

/// The results of a measuring command.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Results {
    /// The result of `sixfold study` for one mesh.
    Study(Box<Report>),
    /// The result of `sixfold study --report` or `sixfold merge`.
    Collection(Box<Collection>),
    /// The result of `sixfold orders`.
    Orders(Box<OrdersReport>),
    /// The result of `sixfold growth`.
    Growth(Box<GrowthReport>),
    /// The result of `sixfold why`.
    Why(Box<Why>),
    /// The result of `sixfold pick`.
    Pick(Box<PickReport>),
}

impl Results {
    /// Writes the results as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        match self {
            Self::Study(study) => study.write_json(writer),
            Self::Collection(collection) => collection.write_json(writer),
            Self::Orders(orders) => orders.write_json(writer),
            Self::Growth(growth) => growth.write_json(writer),
            Self::Why(why) => why.write_json(writer),
            Self::Pick(pick) => pick.write_json(writer),
        }
    }

    /// Reads the results of any measuring command.
    ///
    /// # Errors
    ///
    /// Returns an error if the text is truncated or is not JSON, if another program or command
    /// wrote the text, or if the schema has another version.
    pub fn read_json(text: &str) -> Result<Self, ReadError> {
        check_schema(text)?;
        Ok(match kind(text)? {
            Kind::Study => Self::Study(Report::read_json(text)?.into()),
            Kind::Collection => Self::Collection(Collection::read_json(text)?.into()),
            Kind::Orders => Self::Orders(parse_json(text)?),
            Kind::Growth => Self::Growth(parse_json(text)?),
            Kind::Why => Self::Why(parse_json(text)?),
            Kind::Pick => Self::Pick(parse_json(text)?),
            Kind::Other => {
                return Err(ReadError::OtherKind {
                    found: Kind::Other.description(),
                    wanted: "results that a report can show",
                });
            }
        })
    }
}

impl Report {
    /// Reads a report that [`write_json`](Self::write_json) wrote. A [`Collection`] with the study
    /// of only one mesh is also accepted.
    ///
    /// # Errors
    ///
    /// Returns an error if the text is truncated or is not JSON, if another program or command
    /// wrote the text, or if the schema has another version.
    pub fn read_json(text: &str) -> Result<Self, ReadError> {
        check_schema(text)?;
        let kind = kind(text)?;
        let other = || ReadError::OtherKind {
            found: kind.description(),
            wanted: "the result of `sixfold study` for one mesh",
        };
        match kind {
            Kind::Study => {
                let report: Self = parse_json(text)?;
                report.check()?;
                Ok(report)
            }
            Kind::Collection => {
                let studies = Collection::read_json(text)?.studies;
                let [study] = <[Self; 1]>::try_from(studies).map_err(|_| other())?;
                Ok(study)
            }
            _ => Err(other()),
        }
    }

    /// Returns an error for values that no study can produce.
    pub(crate) fn check(&self) -> Result<(), ReadError> {
        let wrong = |what: String| Err(ReadError::Malformed { cause: what });
        let time = |ns: &f64| *ns >= 0.0 && ns.is_finite();
        for raw in &self.raw {
            let of = format!("the samples of {} on {}", raw.operation, raw.backend);
            let cpu = raw.cpu_ns.as_ref().unwrap_or(&raw.wall_ns);
            let optional = [raw.slowdowns.len(), raw.faults.as_ref().map_or(0, Vec::len)];
            let fits = |len: usize| len == raw.rounds.len();
            let fit = fits(raw.wall_ns.len()) && fits(cpu.len());
            if !fit || !optional.into_iter().all(|len| len == 0 || fits(len)) {
                return wrong(format!("{of} have columns of different lengths"));
            }
            if !raw.wall_ns.iter().chain(cpu).all(time) {
                return wrong(format!(
                    "{of} include a time that is negative or not finite"
                ));
            }
        }
        for row in &self.results {
            if !row.median_ns.iter().all(time) || row.ratio_to_best.is_some_and(|r| r <= 0.0) {
                let (operation, backend) = (row.operation, &row.backend);
                return wrong(format!("invalid time or ratio of {operation} on {backend}"));
            }
        }
        let rows = self.control.iter().flat_map(|control| &control.operations);
        match rows.into_iter().find(|row| row.ratio <= 0.0) {
            Some(row) => wrong(format!(
                "the control of {} has a ratio that is not positive",
                row.operation
            )),
            None => Ok(()),
        }
    }
}

/// Returns an error if this version of Sixfold cannot have written the text.
pub(crate) fn check_schema(text: &str) -> Result<(), ReadError> {
    #[derive(Deserialize)]
    struct Head {
        schema: Option<u64>,
    }

    let head: Head = parse_json(text)?;
    match head.schema {
        None => Err(ReadError::Foreign),
        Some(found) if found != u64::from(SCHEMA) => Err(ReadError::OtherSchema { found }),
        Some(_) => Ok(()),
    }
}

/// The command that wrote a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Study,
    Collection,
    Orders,
    Growth,
    Why,
    Pick,
    Other,
}

impl Kind {
    const fn description(self) -> &'static str {
        match self {
            Self::Study => "the result of `sixfold study`",
            Self::Collection => "a collection of several meshes",
            Self::Orders => "the result of `sixfold orders`",
            Self::Growth => "the result of `sixfold growth`",
            Self::Why => "the result of `sixfold why`",
            Self::Pick => "the result of `sixfold pick`",
            Self::Other => "the result of another command",
        }
    }
}

/// Returns the kind of the results. Each kind has a field that no other kind has.
fn kind(text: &str) -> Result<Kind, ReadError> {
    #[derive(Deserialize)]
    struct Fields {
        ranking: Option<serde::de::IgnoredAny>,
        sizes: Option<serde::de::IgnoredAny>,
        comparisons: Option<serde::de::IgnoredAny>,
        rows: Option<serde::de::IgnoredAny>,
        studies: Option<serde::de::IgnoredAny>,
        results: Option<serde::de::IgnoredAny>,
        drift: Option<serde::de::IgnoredAny>,
    }

    let fields: Fields = parse_json(text)?;
    let found = [
        // A comparison also has the field `rows`.
        (fields.drift.is_some(), Kind::Other),
        (fields.ranking.is_some(), Kind::Pick),
        (fields.sizes.is_some(), Kind::Growth),
        (fields.comparisons.is_some(), Kind::Orders),
        (fields.rows.is_some(), Kind::Why),
        (fields.studies.is_some(), Kind::Collection),
        (fields.results.is_some(), Kind::Study),
    ];
    let found = found.into_iter().find(|(present, _)| *present);
    Ok(found.map_or(Kind::Other, |(_, kind)| kind))
}

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
        ReadError::NoJson {
            what,
            line: error.line(),
            column: error.column(),
            cause: error.to_string(),
        }
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;
    use std::time::Duration;

    use sixfold::shapes;

    use super::*;
    use crate::{Settings, StudyMesh, study};
    use sixfold_workload::Operation;

    fn written() -> String {
        let study_mesh = StudyMesh::new("ball", shapes::icosahedron());
        let settings = Settings {
            operations: vec![Operation::Boundary, Operation::EdgeLength],
            budget: Duration::from_millis(30),
            ..Settings::default()
        };
        let report = study(&study_mesh, &settings, &AtomicBool::new(false), &mut |_| ());
        let mut text = Vec::new();
        let report = report.expect("a study");
        report.write_json(&mut text).expect("memory");
        String::from_utf8(text).expect("UTF-8")
    }

    #[test]
    fn written_results_are_read_back_exactly() {
        let text = written();
        let report = Report::read_json(&text).expect("as written");
        let mut again = Vec::new();
        report.write_json(&mut again).expect("memory");
        assert_eq!(String::from_utf8_lossy(&again), text);
        assert_eq!(report.backends[4].name, "half-edge");
    }

    #[test]
    fn text_of_other_programs_is_refused() {
        let text = written();
        let half = &text[..text.len() / 2];
        for (given, expected) in [
            ("", "ends too early"),
            (half, "ends too early"),
            ("{\"schema\": 1.", "ends too early"),
            ("{\"schema\": -", "ends too early"),
            ("{\"schema\": tr", "ends too early"),
            ("no JSON", "is not JSON, line 1, column 2"),
            ("{}", "no `schema`"),
            ("{\"schema\": \"three\"}", "is not in the format"),
            ("[1]", "is not in the format"),
            ("{\"schema\": 99}", "schema 99"),
            ("{\"schema\": 1, \"ranking\": []}", "`sixfold pick`"),
            ("{\"schema\": 1, \"sizes\": []}", "`sixfold growth`"),
            ("{\"schema\": 1}", "another command"),
            ("{\"schema\": 1, \"results\": []}", "missing field"),
        ] {
            let error = Report::read_json(given).expect_err(expected).to_string();
            assert!(error.contains(expected), "{given:.40}: {error}");
        }
    }
}
