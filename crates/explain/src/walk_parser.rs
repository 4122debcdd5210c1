//! The language of walks: a few steps of textbooks, and one loop.
//!
//! ```text
//! walk      = statement { ";" statement } [ ";" ]
//! statement = name "=" value
//!           | "yield" value
//!           | "repeat" "{" walk "}"
//!           | "if" value ("=" | "!=") value "{" walk "}" [ "else" "{" walk "}" ]
//! value     = name | row | "none" | word "(" value ")"
//! ```
//!
//! A row is the name of a row, such as `v3`. A word is the name of a field, such as `twin`.

use std::iter::Peekable;
use std::vec::IntoIter;

use crate::error::ExplainError;

/// Maximum depth of nested values and blocks.
const MAX_DEPTH: usize = 50;

/// A statement, with its line in [`Program::lines`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Statement {
    pub(crate) line: usize,
    pub(crate) kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Assign(String, Value),
    Yield(Value),
    Repeat(Vec<Statement>),
    If {
        left: Value,
        is_equal: bool,
        right: Value,
        then: Vec<Statement>,
        otherwise: Vec<Statement>,
    },
}

/// A value: a variable, the name of a row, none, or a field of a value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// A variable or the name of a row: `h` and `h3` look alike.
    Name(String),
    None,
    Field(String, Box<Value>),
}

/// A walk that was read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Program {
    pub(crate) statements: Vec<Statement>,
    /// The walk, one line for each statement.
    pub(crate) lines: Vec<String>,
}

/// Reads a walk.
pub(crate) fn parse(text: &str) -> Result<Program, ExplainError> {
    let mut parser = Parser {
        tokens: tokens(text)?.into_iter().peekable(),
        lines: Vec::new(),
        in_loop: false,
        depth: 0,
    };
    let statements = parser.block(None)?;
    match statements.is_empty() {
        true => Err(wrong("the walk is empty")),
        false => Ok(Program {
            statements,
            lines: parser.lines,
        }),
    }
}

fn wrong(reason: impl Into<String>) -> ExplainError {
    let reason = reason.into();
    ExplainError::BadWalk { reason }
}

/// Cuts a text into words and signs.
fn tokens(text: &str) -> Result<Vec<String>, ExplainError> {
    let mut tokens: Vec<String> = Vec::new();
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            _ if letter.is_whitespace() => {}
            '!' if letters.next_if_eq(&'=').is_some() => tokens.push("!=".into()),
            ';' | '=' | '(' | ')' | '{' | '}' => tokens.push(letter.into()),
            _ if letter.is_ascii_alphanumeric() => {
                let mut word = String::from(letter);
                let is_part = |c: &char| c.is_ascii_alphanumeric() || *c == '_';
                while let Some(next) = letters.next_if(is_part) {
                    word.push(next);
                }
                tokens.push(word);
            }
            _ => return Err(wrong(format!("`{letter}` has no meaning in a walk"))),
        }
    }
    Ok(tokens)
}

struct Parser {
    tokens: Peekable<IntoIter<String>>,
    lines: Vec<String>,
    in_loop: bool,
    depth: usize,
}

impl Parser {
    /// Reads statements up to the sign `end`, or to the end of the text.
    fn block(&mut self, end: Option<&str>) -> Result<Vec<Statement>, ExplainError> {
        self.deeper()?;
        let mut statements = Vec::new();
        loop {
            while self.take(";") {}
            match (self.tokens.peek(), end) {
                (None, None) => break,
                (None, Some(end)) => return Err(wrong(format!("`{end}` is missing at the end"))),
                (Some(token), Some(end)) if token == end => {
                    self.tokens.next();
                    break;
                }
                _ => statements.push(self.statement()?),
            }
            let is_end = match self.tokens.peek() {
                None => true,
                Some(token) => token == ";" || Some(token.as_str()) == end,
            };
            let ends_itself = matches!(
                statements.last().map(|last| &last.kind),
                Some(Kind::Repeat(_) | Kind::If { .. })
            );
            if !is_end && !ends_itself {
                let token = self.tokens.peek().map_or("", String::as_str);
                return Err(wrong(format!("`;` is missing before `{token}`")));
            }
        }
        self.depth -= 1;
        Ok(statements)
    }

    fn deeper(&mut self) -> Result<(), ExplainError> {
        self.depth += 1;
        match self.depth > MAX_DEPTH {
            true => Err(wrong("values or blocks are nested too deeply")),
            false => Ok(()),
        }
    }

    fn statement(&mut self) -> Result<Statement, ExplainError> {
        let line = self.lines.len();
        self.lines.push(String::new());
        let first = self.word("a statement")?;
        let (text, kind) = match first.as_str() {
            "yield" => {
                let value = self.value()?;
                (format!("yield {}", text(&value)), Kind::Yield(value))
            }
            "repeat" => {
                if self.in_loop {
                    return Err(wrong("a walk has no loop within a loop"));
                }
                self.in_loop = true;
                self.expect("{")?;
                let body = self.block(Some("}"))?;
                self.in_loop = false;
                let variable = loop_variable(&body).ok_or_else(|| {
                    wrong("the loop never ends: no statement of it has the form h = next(h)")
                })?;
                self.indent(line + 1);
                self.lines
                    .push(format!("until {variable} is the first one again, or none"));
                ("repeat".into(), Kind::Repeat(body))
            }
            "if" => self.condition(line)?,
            name => {
                self.expect("=")?;
                let value = self.value()?;
                (
                    format!("{name} = {}", text(&value)),
                    Kind::Assign(name.to_owned(), value),
                )
            }
        };
        self.lines[line] = text;
        Ok(Statement { line, kind })
    }

    fn condition(&mut self, line: usize) -> Result<(String, Kind), ExplainError> {
        let left = self.value()?;
        let is_equal = match self.take("!=") {
            true => false,
            false => {
                self.expect("=")?;
                true
            }
        };
        let right = self.value()?;
        self.expect("{")?;
        let then = self.block(Some("}"))?;
        self.indent(line + 1);
        let mut otherwise = Vec::new();
        if self.take("else") {
            self.expect("{")?;
            let line = self.lines.len();
            self.lines.push("else".into());
            otherwise = self.block(Some("}"))?;
            self.indent(line + 1);
        }
        let sign = if is_equal { "=" } else { "!=" };
        let condition = format!("if {} {sign} {}", text(&left), text(&right));
        let kind = Kind::If {
            left,
            is_equal,
            right,
            then,
            otherwise,
        };
        Ok((condition, kind))
    }

    /// Indents the lines from `first` on.
    fn indent(&mut self, first: usize) {
        for line in &mut self.lines[first..] {
            line.insert_str(0, "  ");
        }
    }

    fn value(&mut self) -> Result<Value, ExplainError> {
        self.deeper()?;
        let word = self.word("a value")?;
        let value = match self.take("(") {
            true => {
                let argument = self.value()?;
                self.expect(")")?;
                Value::Field(word, Box::new(argument))
            }
            false if word == "none" => Value::None,
            false => Value::Name(word),
        };
        self.depth -= 1;
        Ok(value)
    }

    /// Returns the next word.
    fn word(&mut self, wanted: &str) -> Result<String, ExplainError> {
        match self.tokens.next() {
            Some(token) if token.starts_with(|c: char| c.is_ascii_alphanumeric()) => Ok(token),
            Some(token) => Err(wrong(format!(
                "`{token}` stands where {wanted} is expected"
            ))),
            None => Err(wrong(format!("the walk ends where {wanted} is expected"))),
        }
    }

    fn take(&mut self, sign: &str) -> bool {
        self.tokens.next_if(|token| token == sign).is_some()
    }

    fn expect(&mut self, sign: &str) -> Result<(), ExplainError> {
        match self.tokens.next() {
            Some(token) if token == sign => Ok(()),
            Some(token) => Err(wrong(format!("`{sign}` is expected before `{token}`"))),
            None => Err(wrong(format!("`{sign}` is missing at the end"))),
        }
    }
}

/// Returns the variable that the last assignment of a loop changes. The assignment may be in both
/// branches of an `if`.
pub(crate) fn loop_variable(body: &[Statement]) -> Option<&str> {
    body.iter()
        .rev()
        .find_map(|statement| match &statement.kind {
            Kind::Assign(name, _) => Some(name.as_str()),
            Kind::If {
                then, otherwise, ..
            } => loop_variable(otherwise).or_else(|| loop_variable(then)),
            _ => None,
        })
}

/// Returns a value as text.
pub(crate) fn text(value: &Value) -> String {
    match value {
        Value::Name(name) => name.clone(),
        Value::None => "none".into(),
        Value::Field(word, argument) => format!("{word}({})", text(argument)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_has_a_line_for_each_statement() {
        let walk = "e = edge(v3); repeat { yield e; if start(e) = v3 { e = left_prev(e) } else { \
                    e = right_prev(e); } };";
        let program = parse(walk).expect("a walk");
        let lines = [
            "e = edge(v3)",
            "repeat",
            "  yield e",
            "  if start(e) = v3",
            "    e = left_prev(e)",
            "  else",
            "    e = right_prev(e)",
            "  until e is the first one again, or none",
        ];
        assert_eq!(
            program.lines,
            lines.map(|line| line.replace("  until", "until"))
        );
        assert_eq!(program.statements.len(), 2);
        assert_eq!(program.statements[1].line, 1);
    }

    #[test]
    fn each_wrong_walk_says_what_is_wrong() {
        for (walk, message) in [
            ("", "the walk is empty"),
            (";;", "the walk is empty"),
            ("h", "`=` is missing at the end"),
            ("h = ", "the walk ends where a value is expected"),
            ("h = next(", "the walk ends where a value is expected"),
            ("h = next(h", "`)` is missing at the end"),
            ("h = next(h))", "`;` is missing before `)`"),
            ("h = a b", "`;` is missing before `b`"),
            ("repeat { yield v1 }", "the loop never ends"),
            ("repeat { h = next(h)", "`}` is missing at the end"),
            ("repeat { repeat { h = next(h) } }", "no loop within a loop"),
            ("yield }", "`}` stands where a value is expected"),
            ("if h { }", "`=` is expected before `{`"),
            ("h = next(h) + 1", "`+` has no meaning in a walk"),
            ("h ! k", "`!` has no meaning in a walk"),
        ] {
            let error = parse(walk).expect_err(walk).to_string();
            assert!(error.contains(message), "{walk}: {error}");
        }
        let deep = format!("h = {}h{}", "next(".repeat(1000), ")".repeat(1000));
        assert!(
            parse(&deep)
                .expect_err("deep")
                .to_string()
                .contains("too deeply")
        );
    }
}
