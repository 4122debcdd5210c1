//! The signs of figures in tables: who is fastest, and how a figure was obtained.

use sixfold_results::numbers::{figure, rounded_down};
use sixfold_results::{Agreement, Confidence, ResultRow, Standing};

use crate::command::text::{hanging_indent, width};

/// The signs that occur in a table. The legend explains only these signs.
pub struct Signs {
    used: Vec<char>,
    /// Other parts of the legend.
    parts: Vec<String>,
    bold: bool,
    confidence: Confidence,
}

impl Signs {
    /// Creates an empty legend. If `bold` is set, the figures of the fastest backend are bold.
    pub fn new(bold: bool) -> Self {
        Self {
            used: Vec::new(),
            parts: Vec::new(),
            bold,
            confidence: Confidence::default(),
        }
    }

    /// Returns the legend for intervals of this confidence.
    pub fn with_confidence(self, confidence: Confidence) -> Self {
        Self { confidence, ..self }
    }

    /// Returns whether the figures of the best backend are bold.
    pub fn is_bold(&self) -> bool {
        self.bold
    }

    /// Notes that a sign occurs, and returns it.
    pub fn record(&mut self, sign: char) -> char {
        if !self.used.contains(&sign) {
            self.used.push(sign);
        }
        sign
    }

    /// Adds a part to the end of the legend, if it is new.
    pub fn explain(&mut self, part: &str) {
        if !self.parts.iter().any(|known| known == part) {
            self.parts.push(part.to_owned());
        }
    }

    /// Formats the time per element with its signs, such as `*13.7`, `=~50,400` or `≥42,000`.
    pub fn figure(&mut self, row: &ResultRow) -> String {
        let estimate = row.estimated_ns.zip(row.elements);
        let estimate = estimate.map(|(ns, elements)| ns / elements.max(1) as f64);
        let mut text = self.standing(row.standing);
        match (row.ns_per_element, estimate) {
            (Some(each), _) if row.sampled => {
                text += &format!("{}{}", self.record('~'), figure(each))
            }
            (Some(each), _) => text += &figure(each),
            (None, Some(each)) => {
                text += &format!("{}{}", self.record('≥'), figure(rounded_down(each)))
            }
            (None, None) => text.push('–'),
        }
        match row.agreement {
            Agreement::Mismatch => text.push(self.record('!')),
            Agreement::Merged => text.push(self.record('m')),
            Agreement::OtherEdits => text.push(self.record('e')),
            _ => {}
        }
        text
    }

    /// Returns the sign of a standing, or an empty text.
    pub fn standing(&mut self, standing: Option<Standing>) -> String {
        match standing {
            Some(Standing::Best) => self.record('*').into(),
            Some(Standing::Equal) => self.record('=').into(),
            Some(Standing::Undecided) => self.record('?').into(),
            _ => String::new(),
        }
    }

    /// Returns the lines of the legend. A line ends only between two signs.
    pub fn legend(&self) -> String {
        let interval = format!("{} interval", self.confidence);
        let meanings = [
            ('*', "clearly fastest"),
            ('=', "equal: within 5 % of the fastest"),
            ('?', "undecided: perhaps the fastest"),
            ('~', "measured on a sample of the elements"),
            ('≥', "lower bound: not run, so not ranked"),
            ('–', "no time: see the notes"),
            ('±', &*interval),
            ('m', "the backend merges vertices at one position"),
            (
                'e',
                "the backend refuses edits that others accept, so its times are not compared",
            ),
            (
                'h',
                "own heap: the allocator of this program does not keep freed pages",
            ),
            ('!', "WRONG: the result differs from the other backends"),
        ];
        let used = meanings.iter().filter(|(sign, _)| self.used.contains(sign));
        let used = used.map(|(sign, meaning)| format!("{sign} {meaning}"));
        let mut lines: Vec<String> = Vec::new();
        for part in used.chain(self.parts.iter().cloned()) {
            match lines.last_mut() {
                Some(line) if line.chars().count() + 2 + part.chars().count() <= width() => {
                    *line += "; ";
                    *line += &part;
                }
                _ => lines.push(part),
            }
        }
        // A part can be wider than a narrow terminal.
        let lines = lines.iter().map(|line| hanging_indent("", line));
        lines.collect::<Vec<_>>().join("\n")
    }
}

#[cfg(test)]
mod tests {
    use crate::Operation;

    use super::*;

    fn row(standing: Option<Standing>) -> ResultRow {
        ResultRow {
            median_ns: Some(123_456.0),
            elements: Some(10),
            ns_per_element: Some(12_345.6),
            standing,
            ..ResultRow::new(
                "half-edge",
                Operation::Build.name(),
                Operation::Build.unit(),
            )
        }
    }

    #[test]
    fn each_figure_has_its_signs_and_the_legend_explains_only_these() {
        let mut signs = Signs::new(true);
        assert_eq!(signs.figure(&row(Some(Standing::Slower))), "12,300");
        assert_eq!(signs.legend(), "");
        let best = signs.figure(&row(Some(Standing::Best)));
        assert_eq!(best, "*12,300");
        let sampled = ResultRow {
            sampled: true,
            agreement: Agreement::Merged,
            ..row(Some(Standing::Undecided))
        };
        assert_eq!(signs.figure(&sampled), "?~12,300m");
        let estimated = ResultRow {
            median_ns: None,
            ns_per_element: None,
            estimated_ns: Some(5000.0),
            ..row(None)
        };
        assert_eq!(signs.figure(&estimated), "≥500");
        let unknown = ResultRow {
            estimated_ns: None,
            ..estimated
        };
        assert_eq!(signs.figure(&unknown), "–");
        signs.explain("more");
        signs.explain("more");
        let legend = signs.legend().replace('\n', "; ");
        let expected = "* clearly fastest; ? undecided: perhaps the fastest; ~ measured on a sample of the elements; \
                        ≥ lower bound: not run, so not ranked; m the backend merges \
                        vertices at one position; more";
        assert_eq!(legend, expected);
    }
}
