//! One declaration of the tables of a structure.

/// Implements everything that treats the tables of a structure field by field, from one list of
/// the fields: [`Clone`], the conversions between compact and editable meshes, and what memory
/// reports and measurements need.
///
/// ```text
/// sixfold_core::mesh_tables!(FaceVertexMesh {
///     tables: positions, corners, fans, pool;
///     faces: spans;
///     holes: vertex_holes, face_holes;
/// });
/// ```
///
/// The structure has the type parameters `E: Editing` and `P: Probe`. The groups can be in any
/// order; memory reports list the tables in the order of this declaration. The first field must
/// have the method `probe`. The compiler reports a missing field.
///
/// - `tables`: fields of type [`Table`](crate::Table).
/// - `faces`: fields whose type has `E` as a parameter, such as [`FaceSpans`](crate::FaceSpans),
///   with the methods `bytes`, `probed`, and `into_compact` in editable meshes.
/// - `holes`: fields of type `E::Holes<P>`, called `vertex_holes`, `edge_holes` or `face_holes`.
///
/// The macro implements [`Clone`] (see `clone_by_field!`), `From` the compact mesh for the editable
/// mesh, and three methods that the traits of the structure call: `table_bytes`, `with_probe`, and
/// `into_compact_tables`, which requires a mesh that was compacted.
#[macro_export]
macro_rules! mesh_tables {
    (@probe $mesh:ident $first:ident $($field:ident)*) => { $mesh.$first.probe() };

    (@hole_table vertex_holes) => { $crate::VERTEX_HOLES };
    (@hole_table edge_holes) => { $crate::EDGE_HOLES };
    (@hole_table face_holes) => { $crate::FACE_HOLES };

    (@editable tables $field:ident $value:expr, $probe:ident) => { $value };
    (@editable faces $field:ident $value:expr, $probe:ident) => { $value.into() };
    (@editable holes $field:ident $value:expr, $probe:ident) => {
        <$crate::Editable as $crate::Editing>::no_holes(
            $crate::mesh_tables!(@hole_table $field),
            $probe.clone(),
        )
    };

    (@compact tables $value:expr) => { $value };
    (@compact faces $value:expr) => { $value.into_compact().expect("compacted") };
    (@compact holes $value:expr) => { $crate::NoHoles };

    (@probed tables $value:expr, $probe:ident) => { $value.probed($probe.clone()) };
    (@probed faces $value:expr, $probe:ident) => { $value.probed($probe.clone()) };
    (@probed holes $value:expr, $probe:ident) => { E::probed_holes($value, $probe.clone()) };

    (@bytes tables $value:expr, $to:ident) => { $to.push($value.bytes()) };
    (@bytes faces $value:expr, $to:ident) => { $to.extend($value.bytes()) };
    (@bytes holes $value:expr, $to:ident) => {
        if let Some(bytes) = $crate::HoleSet::bytes(&$value) {
            $to.push(bytes);
        }
    };

    ($mesh:ident { $($kind:ident: $($field:ident),+;)+ }) => {
        $crate::clone_by_field!(
            $mesh<E: $crate::Editing, P: $crate::Probe> { $($($field),+),+ }
        );

        impl<P: $crate::Probe> From<$mesh<$crate::Compact, P>> for $mesh<$crate::Editable, P> {
            fn from(mesh: $mesh<$crate::Compact, P>) -> Self {
                let probe = $crate::mesh_tables!(@probe mesh $($($field)+)+);
                Self {
                    $($($field: $crate::mesh_tables!(@editable $kind $field mesh.$field, probe),)+)+
                }
            }
        }

        impl<P: $crate::Probe> $mesh<$crate::Editable, P> {
            /// Converts a mesh that was compacted.
            pub(crate) fn into_compact_tables(self) -> $mesh<$crate::Compact, P> {
                $mesh { $($($field: $crate::mesh_tables!(@compact $kind self.$field),)+)+ }
            }
        }

        impl<E: $crate::Editing, P: $crate::Probe> $mesh<E, P> {
            /// Returns the bytes of each table.
            pub(crate) fn table_bytes(&self) -> $crate::MemoryFootprint {
                let mut tables = Vec::with_capacity([$($(stringify!($field)),+),+].len());
                $($($crate::mesh_tables!(@bytes $kind self.$field, tables);)+)+
                $crate::MemoryFootprint { tables }
            }

            /// Returns the same mesh in tables that report their reads and writes to `probe`.
            pub(crate) fn with_probe<Q: $crate::Probe>(self, probe: Q) -> $mesh<E, Q> {
                $mesh { $($($field: $crate::mesh_tables!(@probed $kind self.$field, probe),)+)+ }
            }
        }
    };
}

/// Implements the items of [`MeshEdit`](crate::MeshEdit) that convert between an editable and a
/// compact mesh, for a structure with [`mesh_tables!`](crate::mesh_tables). Call it in the `impl` of the trait.
#[macro_export]
macro_rules! compact_conversions {
    ($mesh:ident) => {
        type Compact = $mesh<$crate::Compact, P>;

        fn into_compact(mut self) -> Self::Compact {
            $crate::MeshEdit::compact(&mut self);
            self.into_compact_tables()
        }

        fn from_compact(compact: Self::Compact) -> Self {
            compact.into()
        }
    };
}
