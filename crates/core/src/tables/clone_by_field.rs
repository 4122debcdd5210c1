//! Cloning into memory that is already allocated.

/// Implements [`Clone`] field by field, including `clone_from`.
///
/// `#[derive(Clone)]` keeps the default `clone_from`, which allocates a new copy and drops the old
/// one. The `clone_from` of this macro copies into the existing tables, and allocates nothing if
/// the source fits into them. The compiler reports a missing field.
#[doc(hidden)]
#[macro_export]
macro_rules! clone_by_field {
    ($name:ident<$($parameter:ident: $bound:path),+> { $($field:ident),+ }) => {
        impl<$($parameter: $bound),+> Clone for $name<$($parameter),+> {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone()),+ }
            }

            fn clone_from(&mut self, source: &Self) {
                let Self { $($field),+ } = source;
                $(self.$field.clone_from($field);)+
            }
        }
    };
}
