//! Enums whose values have names: in options, files and messages.

use strsim::jaro_winkler;

/// Minimum Jaro–Winkler similarity of a suggested name to the unknown name.
const MIN_SIMILARITY: f64 = 0.8;

/// The error for a name that is not one of the known names.
///
/// The message lists the known names. If one of them is similar to the given name, the message
/// suggests this name.
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

    /// Returns the question after the name, such as ` (did you mean `smooth`?)`, or no text if no
    /// known name is similar.
    fn suggestion(&self) -> String {
        let alike = |known: &&String| jaro_winkler(&self.given, known);
        let nearest = (self.known.iter()).max_by(|a, b| alike(a).total_cmp(&alike(b)));
        match nearest.filter(|known| alike(known) > MIN_SIMILARITY) {
            Some(known) => format!(" (did you mean `{known}`?)"),
            None => String::new(),
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
    fn names_are_read_back() {
        for relation in Relation::ALL {
            assert_eq!(format!(" {relation}\n").parse(), Ok(relation));
            assert_eq!(format!("{relation:>16}").len(), 16);
        }
        let error = "vertex_face".parse::<Relation>().expect_err("no such name");
        assert_eq!((error.kind, error.known.len()), ("relation", 9));
    }
}
