//! Enums whose values have names: in options, files and messages.

use strsim::jaro_winkler;

/// Minimum similarity of a suggested name to the unknown name.
const MIN_SIMILARITY: f64 = 0.8;
/// Minimum length of a part of a name that suggests the name.
const MIN_PART: usize = 3;

/// Returns the question after an unknown name, such as ` (did you mean `smooth`?)`, or no text if none
/// of the known names is similar.
///
/// Similar names differ in few letters, in case or in separators, or the given name is the beginning, a
/// word or the initials of the known name.
///
/// # Examples
///
/// ```
/// use sixfold_core::did_you_mean;
///
/// let names = ["vertex_faces", "vertex_edges", "boundary"];
/// assert_eq!(did_you_mean("VF", names), " (did you mean `vertex_faces`?)");
/// assert_eq!(did_you_mean("bound", names), " (did you mean `boundary`?)");
/// assert_eq!(did_you_mean("zebra", names), "");
/// ```
pub fn did_you_mean<N: AsRef<str>>(given: &str, known: impl IntoIterator<Item = N>) -> String {
    let known = known
        .into_iter()
        .map(|name| (similarity(given, name.as_ref()), name));
    let nearest = known.max_by(|(a, _), (b, _)| a.total_cmp(b));
    match nearest.filter(|(similarity, _)| *similarity > MIN_SIMILARITY) {
        Some((_, known)) => format!(" (did you mean `{}`?)", known.as_ref()),
        None => String::new(),
    }
}

/// Returns the similarity of a given name to a known name, from 0 to 1.
fn similarity(given: &str, known: &str) -> f64 {
    let is_separator = |c: char| !c.is_alphanumeric();
    let plain = |name: &str| name.replace(is_separator, "").to_lowercase();
    let [name, full] = [given, known].map(plain);
    let words: Vec<String> = known.split(is_separator).map(plain).collect();
    let initials: String = words
        .iter()
        .filter_map(|word| word.chars().next())
        .collect();
    let is_part = name.len().min(full.len()) >= MIN_PART;
    let is_initials = words.len() > 1 && name == initials;
    match () {
        () if name == full || is_initials => 1.0,
        () if is_part && full.starts_with(&name) => 0.98,
        () if is_part && words.contains(&name) => 0.97,
        () if is_part && name.starts_with(&full) => 0.96,
        () => {
            let long = words.iter().filter(|word| word.len() > MIN_PART);
            let of_words = long.map(|word| 0.9 * jaro_winkler(&name, word));
            of_words.fold(jaro_winkler(given, known), f64::max)
        }
    }
}

/// The error for a name that is not one of the known names.
///
/// The message lists the known names. If one of them is similar to the given name, the message
/// suggests this name ([`did_you_mean`]).
///
/// # Examples
///
/// ```
/// use sixfold_core::UnknownName;
///
/// let error = UnknownName::new("rule", "smoth", ["smooth", "flat"]);
/// assert_eq!(
///     error.to_string(),
///     "no rule is called `smoth` (did you mean `smooth`?): choose from smooth, flat"
/// );
/// ```
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no {kind} is called `{given}`{}: choose from {}", self.suggestion(), .known.join(", "))]
#[non_exhaustive]
pub struct UnknownName {
    /// What the name should name, in the singular, such as `operation`.
    pub kind: &'static str,
    /// The unknown name.
    pub given: String,
    /// The known names.
    pub known: Vec<String>,
    /// What each known name means; empty if this is not known.
    pub meanings: Vec<String>,
}

impl UnknownName {
    /// Makes the error for the name `given` of a `kind` of things whose names are `known`.
    pub fn new<N: Into<String>>(
        kind: &'static str,
        given: &str,
        known: impl IntoIterator<Item = N>,
    ) -> Self {
        Self {
            kind,
            given: given.to_owned(),
            known: known.into_iter().map(Into::into).collect(),
            meanings: Vec::new(),
        }
    }

    /// Adds what each known name means. If no name is similar to the given one, the first name whose
    /// meaning contains the given word is suggested.
    #[must_use]
    pub fn with_meanings<M: Into<String>>(self, meanings: impl IntoIterator<Item = M>) -> Self {
        let meanings = meanings.into_iter().map(Into::into).collect();
        Self { meanings, ..self }
    }

    /// Returns the question after the name, or no text.
    fn suggestion(&self) -> String {
        let similar = did_you_mean(&self.given, &self.known);
        let is_word = |meaning: &str| {
            let mut words = meaning.split(|c: char| !c.is_alphanumeric());
            words.any(|word| word.eq_ignore_ascii_case(&self.given))
        };
        let mut pairs = self.known.iter().zip(&self.meanings);
        match pairs.find(|(_, meaning)| is_word(meaning)) {
            Some((known, _)) if similar.is_empty() => format!(" (did you mean `{known}`?)"),
            _ => similar,
        }
    }

    /// Checks that each of the `given` names is one of the `known` names.
    ///
    /// # Errors
    ///
    /// Returns the error for the first name that is not known.
    pub fn check<'k>(
        kind: &'static str,
        given: &[String],
        known: impl IntoIterator<Item = &'k str>,
    ) -> Result<(), Self> {
        let known: Vec<&str> = known.into_iter().collect();
        let is_unknown = |name: &&String| !known.contains(&name.as_str());
        match given.iter().find(is_unknown) {
            Some(name) => Err(Self::new(kind, name, known)),
            None => Ok(()),
        }
    }
}

/// Defines an enum whose values have names.
///
/// The enum gets the constant `ALL`, the function `name`, `Display`, `FromStr` with the error
/// [`UnknownName`], and, with the feature `serde`, serialisation as the name. The literal after the
/// name of the enum says what a value is, for the message of the error. With `shown by function`,
/// `Display` writes the result of another function than `name`.
///
/// The second form, `named!(impl Type: "kind" in all)`, implements the traits for a type that has a
/// function `name`; `all` is an iterable of all its values.
///
/// # Examples
///
/// ```
/// sixfold_core::named! {
///     /// How a surface is shaded.
///     pub enum Shading: "shading" {
///         /// Each face has one colour.
///         Flat = "flat",
///         /// Colours change gradually.
///         Smooth = "smooth",
///     }
/// }
///
/// assert_eq!(Shading::ALL.map(Shading::name), ["flat", "smooth"]);
/// assert_eq!("smooth".parse(), Ok(Shading::Smooth));
/// assert_eq!(Shading::Flat.to_string(), "flat");
/// ```
#[macro_export]
macro_rules! named {
    (
        $(#[$attribute:meta])*
        $vis:vis enum $name:ident: $kind:literal $(, shown by $shown:ident)? {
            $($(#[$about:meta])* $variant:ident = $text:literal,)+
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        $vis enum $name {
            $($(#[$about])* $variant,)+
        }

        impl $name {
            /// All values, in the order of the definition.
            $vis const ALL: [Self; [$($text),+].len()] = [$(Self::$variant),+];

            /// Returns the name in options, files and messages.
            $vis const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)+
                }
            }
        }

        $crate::named!(impl $name: $kind in $name::ALL $(, shown by $shown)?);
    };
    (impl $name:ty: $kind:literal in $all:expr) => {
        $crate::named!(impl $name: $kind in $all, shown by name);
    };
    (impl $name:ty: $kind:literal in $all:expr, shown by $shown:ident) => {
        impl ::std::fmt::Display for $name {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                f.pad(self.$shown())
            }
        }

        impl ::std::str::FromStr for $name {
            type Err = $crate::UnknownName;

            /// Parses the name. White space around the name is ignored.
            fn from_str(given: &str) -> ::std::result::Result<Self, $crate::UnknownName> {
                let given = given.trim();
                let found = ::std::iter::IntoIterator::into_iter($all)
                    .find(|value| value.name() == given);
                found.ok_or_else(|| {
                    let known = ::std::iter::IntoIterator::into_iter($all);
                    $crate::UnknownName::new($kind, given, known.map(|value| value.name()))
                })
            }
        }

        $crate::serialize_as_name!($name);
    };
}

/// Serialises a type with a function `name` and `FromStr` as its name.
#[cfg(feature = "serde")]
#[doc(hidden)]
#[macro_export]
macro_rules! serialize_as_name {
    ($name:ty) => {
        impl $crate::serde::Serialize for $name {
            fn serialize<S: $crate::serde::Serializer>(
                &self,
                serializer: S,
            ) -> ::std::result::Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> $crate::serde::Deserialize<'de> for $name {
            fn deserialize<D: $crate::serde::Deserializer<'de>>(
                deserializer: D,
            ) -> ::std::result::Result<Self, D::Error> {
                let name = <::std::string::String as $crate::serde::Deserialize>::deserialize(
                    deserializer,
                )?;
                name.parse().map_err($crate::serde::de::Error::custom)
            }
        }
    };
}

/// Without the feature `serde`, no code.
#[cfg(not(feature = "serde"))]
#[doc(hidden)]
#[macro_export]
macro_rules! serialize_as_name {
    ($name:ty) => {};
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Relation;

    #[test]
    fn similar_names_are_suggested_and_other_names_are_not() {
        let known = ["vertex_faces", "boundary", "build"];
        let message = |name: &str| UnknownName::new("operation", name, known).to_string();
        assert_eq!(
            message("boundry"),
            "no operation is called `boundry` (did you mean `boundary`?): choose from \
             vertex_faces, boundary, build"
        );
        assert!(message("vertex-faces").contains("did you mean `vertex_faces`?"));
        assert!(message("zebra").starts_with("no operation is called `zebra`: choose from"));
    }

    #[test]
    fn beginnings_words_and_initials_suggest_the_whole_name() {
        let known = [
            "vertex_vertices",
            "vv_smooth",
            "frequency",
            "uv-sphere",
            "half-edge",
            "n",
        ];
        for (given, expected) in [
            ("VV", "vertex_vertices"),
            ("freq", "frequency"),
            ("sphere", "uv-sphere"),
            ("HalfEdge", "half-edge"),
            ("smoth", "vv_smooth"),
            ("half-edges", "half-edge"),
        ] {
            let question = format!(" (did you mean `{expected}`?)");
            assert_eq!(did_you_mean(given, known), question, "{given}");
        }
        let shapes = UnknownName::new("shape", "Sphere", ["torus", "geodesic"]);
        let shapes = shapes.with_meanings(["a ring", "triangles on a sphere, closed"]);
        let message = shapes.to_string();
        assert!(message.contains("(did you mean `geodesic`?)"), "{message}");
        for given in ["", "v", "m", "xyz", "corner", "e"] {
            assert_eq!(did_you_mean(given, known), "", "{given}");
        }
    }

    #[test]
    fn names_are_read_back() {
        for relation in Relation::ALL {
            assert_eq!(format!(" {relation}\n").parse(), Ok(relation));
            assert_eq!(format!("{relation:>16}").len(), 16);
        }
        let error = "vertex_face".parse::<Relation>().expect_err("no such name");
        assert_eq!((error.kind, error.known.len()), ("relation", 9));
    }
}
