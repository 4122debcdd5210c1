//! Conversions between structures and polygon meshes by the traits `From` and `TryFrom`.

use crate::polygons::polygon_mesh::PolygonMesh;
use crate::traits::representation::Representation;

/// Converts the mesh like [`to_polygons`](Representation::to_polygons).
impl<M: Representation> From<&M> for PolygonMesh {
    fn from(mesh: &M) -> Self {
        mesh.to_polygons()
    }
}

/// Implements `TryFrom<PolygonMesh>`, `TryFrom<&PolygonMesh>` and `Default` for a structure with
/// two type parameters: `E: Editing`, and a probe that has a default.
///
/// A blanket implementation in this crate is not possible: it would overlap with the implementation
/// in the standard library for types that implement `Into`.
#[doc(hidden)]
#[macro_export]
macro_rules! polygon_conversions {
    ($mesh:ident) => {
        /// Builds the structure as [`from_polygons`](sixfold_core::Representation::from_polygons) does.
        impl<E: $crate::Editing> TryFrom<&$crate::PolygonMesh> for $mesh<E> {
            type Error = $crate::BuildError;

            fn try_from(polygons: &$crate::PolygonMesh) -> Result<Self, Self::Error> {
                $crate::Representation::from_polygons(polygons)
            }
        }

        /// Builds the structure as [`from_polygons`](sixfold_core::Representation::from_polygons) does.
        impl<E: $crate::Editing> TryFrom<$crate::PolygonMesh> for $mesh<E> {
            type Error = $crate::BuildError;

            fn try_from(polygons: $crate::PolygonMesh) -> Result<Self, Self::Error> {
                $crate::Representation::from_polygons(&polygons)
            }
        }

        /// Returns a mesh without elements.
        impl<E: $crate::Editing> Default for $mesh<E> {
            fn default() -> Self {
                $crate::Representation::from_polygons(&$crate::PolygonMesh::default())
                    .expect("a mesh without elements has no fault")
            }
        }
    };
}
