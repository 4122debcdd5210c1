//! Structures whose queries never scan the mesh.

use crate::traits::query::MeshQuery;
use crate::traits::representation::{QueryCost, Representation};

/// A structure whose queries never scan all faces: none of its [`COSTS`](Representation::COSTS) is
/// [`QueryCost::Scan`].
///
/// An algorithm that queries each of n elements takes O(n) time on a structure with local queries,
/// and O(n²) time on a structure that scans. With the bound `LocalQueries`, the compiler refuses
/// structures that scan. At run time, [`Representation::is_local`] and [`Representation::cost`]
/// show whether queries scan. A [`MeshWithData`](crate::MeshWithData) has local queries if its mesh
/// has.
///
/// ```
/// use sixfold_core::LocalQueries;
///
/// /// Returns the largest number of edges at a vertex.
/// fn largest_valence<M: LocalQueries>(mesh: &M) -> usize {
///     mesh.vertices().map(|v| mesh.valence(v)).max().unwrap_or(0)
/// }
/// ```
///
/// Implement this trait with [`local_queries!`](crate::local_queries), which checks the costs. The
/// test `costs` of the conformance suite compares the declared costs with the observed reads.
#[diagnostic::on_unimplemented(
    message = "queries of `{Self}` may scan all faces of the mesh",
    label = "this structure does not implement `LocalQueries`",
    note = "use a structure that implements `LocalQueries`: none of its queries scans"
)]
pub trait LocalQueries: MeshQuery {
    /// Proof that the costs were checked; only [`local_queries!`](crate::local_queries) creates it.
    #[doc(hidden)]
    const COSTS_ARE_LOCAL: CostsAreLocal;
}

/// Proof that none of the costs of a structure is a scan.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct CostsAreLocal(());

impl CostsAreLocal {
    /// Checks that none of the costs of `M` is a scan.
    ///
    /// # Panics
    ///
    /// Panics if one of the costs is a scan. In a constant, the panic is a build error.
    pub const fn check<M: Representation>() -> Self {
        assert!(
            QueryCost::are_local(&M::COSTS),
            "a structure with QueryCost::Scan in its COSTS cannot implement LocalQueries"
        );
        Self(())
    }
}

/// Implements [`LocalQueries`] for structures: `local_queries!(HalfEdgeMesh, EditableHalfEdgeMesh);`
///
/// The build fails if the costs of a structure contain [`QueryCost::Scan`], because the check is
/// evaluated at compile time. This example does not compile, because the costs contain a scan:
///
/// ```compile_fail,E0080
/// use sixfold_core::QueryCost;
/// const _: () = assert!(QueryCost::are_local(&[QueryCost::Scan; 9]));
/// ```
#[macro_export]
macro_rules! local_queries {
    ($($mesh:ty),+ $(,)?) => {$(
        // The compiler evaluates this constant even if nothing uses it, unlike the constant of the
        // trait.
        const _: $crate::CostsAreLocal = $crate::CostsAreLocal::check::<$mesh>();

        impl $crate::LocalQueries for $mesh {
            const COSTS_ARE_LOCAL: $crate::CostsAreLocal =
                $crate::CostsAreLocal::check::<Self>();
        }
    )+};
}
