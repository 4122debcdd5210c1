//! Cloning into memory that is there already.

/// Implements [`Clone`] field by field, `clone_from` included.
///
/// `#[derive(Clone)]` leaves `clone_from` to its default, which allocates a whole copy and drops the old
/// one. With this macro a copy that was changed is made equal to its source again without allocating,
/// if the tables of the source fit into those of the copy. The compiler reports a field that is missing.
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
