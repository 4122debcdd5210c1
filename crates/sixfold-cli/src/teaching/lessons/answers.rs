//! What questions ask for: the right values, and whether a reader's answer is right.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A value that a question asks for. The page of the explorer decides by the same rules (`answer.js`).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Asked {
    pub(super) label: String,
    /// A number, names, or one of the options.
    truth: Value,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    options: Vec<String>,
}

impl Asked {
    /// Reads `one / * two / three`: the right one has a star.
    pub(super) fn choice(label: String, options: &str) -> Self {
        let options = options.split(" / ").map(str::trim);
        let right = options.clone().find_map(|option| option.strip_prefix("* "));
        let plain = options.map(|option| option.strip_prefix("* ").unwrap_or(option).to_owned());
        Self {
            label,
            truth: right.unwrap_or_default().into(),
            options: plain.collect(),
        }
    }

    /// Takes the value at a path of a document ([`values_at`]): a number, or names if the values are names; with `.count`
    /// at the end, the number of members of a list. `None` if it has none of these.
    pub(super) fn computed(label: String, document: &Value, path: &str) -> Option<Self> {
        if let Some(list) = path.strip_suffix(".count") {
            let [Value::Array(members)] = values_at(document, list)[..] else {
                return None;
            };
            let truth = members.len().into();
            return Some(Self {
                label,
                truth,
                options: Vec::new(),
            });
        }
        let values = values_at(document, path);
        let truth = match values[..] {
            [number @ Value::Number(_)] => number.clone(),
            _ if values.iter().all(|value| value.is_string()) && !path.is_empty() => {
                Value::Array(values.into_iter().cloned().collect())
            }
            _ => return None,
        };
        Some(Self {
            label,
            truth,
            options: Vec::new(),
        })
    }

    /// Returns whether an answer is right. Numbers agree if they differ by at most half a percent, integers exactly; names
    /// in any order.
    pub(super) fn is_right(&self, given: &Value) -> bool {
        match (&self.truth, given) {
            (Value::Number(truth), Value::Number(given)) => {
                let (Some(truth), Some(given)) = (truth.as_f64(), given.as_f64()) else {
                    return false;
                };
                let tolerance = match truth.fract() == 0.0 {
                    true => 0.0,
                    false => 0.005 * truth.abs(),
                };
                (truth - given).abs() <= tolerance
            }
            (Value::Array(truth), Value::Array(given)) => {
                let has = |list: &[Value], all: &[Value]| all.iter().all(|one| list.contains(one));
                has(truth, given) && has(given, truth)
            }
            (truth, given) => truth == given,
        }
    }

    /// Returns the question for the terminal.
    pub(super) fn prompt(&self) -> String {
        match (&self.truth, &self.options[..]) {
            (Value::Array(_), _) => format!("{} (names, or none)", self.label),
            (_, []) => self.label.clone(),
            (_, options) => format!("{} ({})", self.label, options.join(" / ")),
        }
    }

    /// Says whether what was typed in the terminal is right.
    pub(super) fn verdict(&self, typed: &str) -> String {
        match self.is_right(&self.read(typed)) {
            true => "Right.".to_owned(),
            false => format!("No: {}.", shown(&self.truth)),
        }
    }

    fn read(&self, typed: &str) -> Value {
        let typed = typed.trim();
        match &self.truth {
            Value::Number(_) => number(typed).map_or(Value::Null, Value::from),
            Value::Array(_) => typed
                .split([',', ' '])
                .filter(|name| !name.is_empty() && *name != "none")
                .collect(),
            _ => typed.into(),
        }
    }
}

/// Returns a number or a fraction, such as `5/8`.
fn number(typed: &str) -> Option<f64> {
    match typed.split_once('/') {
        Some((above, below)) => {
            Some(above.trim().parse::<f64>().ok()? / below.trim().parse::<f64>().ok()?)
        }
        None => typed.parse().ok(),
    }
}

/// Returns an answer as text.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(names) if names.is_empty() => "none".to_owned(),
        Value::Array(names) => names.iter().map(shown).collect::<Vec<_>>().join(", "),
        Value::Null => String::new(),
        value => value.to_string(),
    }
}

/// Returns the values at a path such as `backends[holds=true].name` or `edits.0.changed`: in brackets, a field that the
/// members of a list must have with this value.
fn values_at<'v>(document: &'v Value, path: &str) -> Vec<&'v Value> {
    let mut values = vec![document];
    for part in path.split('.').filter(|part| !part.is_empty()) {
        let (name, condition) = match part.split_once('[') {
            Some((name, rest)) => (name, rest.trim_end_matches(']').split_once('=')),
            None => (part, None),
        };
        let of_list = |value: &'v Value| name.parse::<usize>().ok().and_then(|at| value.get(at));
        let inner = values
            .iter()
            .filter_map(|value| value.get(name).or_else(|| of_list(value)));
        values = inner.collect();
        if let Some((field, wanted)) = condition {
            let members = values.iter().filter_map(|value| value.as_array()).flatten();
            let is_wanted = |member: &&Value| shown(&member[field]) == wanted;
            values = members.filter(is_wanted).collect();
        }
    }
    values
}

/// Returns a hash of 64 bits of a text (FNV-1a; Fowler, Noll and Vo, 1991) in hexadecimal digits, which the page
/// computes, too. It finds what was changed by hand, and is no protection against someone who computes it.
pub(super) fn digest(text: &str) -> String {
    let step = |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325, step);
    format!("{hash:016x}")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_path_leads_to_values() {
        let document = json!({
            "backends": [{"name": "a", "holds": true}, {"name": "b", "holds": false}, {"name": "c", "holds": true}],
            "edits": [[{"changed": 7}]],
        });
        let of = |path| Asked::computed("x".into(), &document, path).map(|asked| asked.truth);
        assert_eq!(of("backends[holds=true].name"), Some(json!(["a", "c"])));
        assert_eq!(of("backends[name=b].name"), Some(json!(["b"])));
        assert_eq!(of("edits.0.0.changed"), Some(json!(7)));
        assert_eq!(of("edits.0.1.changed"), Some(json!([])));
        assert_eq!(of("backends.count"), Some(json!(3)));
        assert_eq!(of("edits.count.count"), None);
        assert_eq!(of("backends"), None);
        assert_eq!(of(""), None);
    }

    #[test]
    fn numbers_names_and_choices_are_compared() {
        let computed = |value: Value| Asked {
            label: String::new(),
            truth: value,
            options: Vec::new(),
        };
        let right = |truth: Value, typed| {
            let asked = computed(truth);
            asked.is_right(&asked.read(typed))
        };
        assert!(right(json!(7), " 7\n") && !right(json!(7), "7.01") && !right(json!(7), "seven"));
        assert!(right(json!(0.625), "5/8") && right(json!(0.625), "0.623"));
        assert!(!right(json!(0.625), "0.62") && !right(json!(0.625), "5/0"));
        assert!(right(json!(["a", "b"]), "b, a") && !right(json!(["a", "b"]), "a"));
        assert!(!right(json!(["a"]), "a b") && right(json!([]), "none"));
        let choice = Asked::choice("c".into(), "one / * two / three");
        assert_eq!(choice.options, ["one", "two", "three"]);
        assert_eq!(choice.verdict("two\n"), "Right.");
        assert_eq!(choice.verdict("one"), "No: two.");
        assert_eq!(choice.prompt(), "c (one / two / three)");
        assert_eq!(computed(json!([])).verdict("a"), "No: none.");
    }

    #[test]
    fn the_hash_is_fnv() {
        // From the test vectors of the authors.
        assert_eq!(digest(""), "cbf29ce484222325");
        assert_eq!(digest("a"), "af63dc4c8601ec8c");
        assert_eq!(digest("foobar"), "85944171f73967e8");
    }
}
