//! The structures that can be explained.

use std::ops::Range;

use sixfold::{BuildError, PolygonMesh, Representation};
use sixfold_core::Described;

use crate::records::{Records, records};

/// A structure whose tables can be shown.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    name: &'static str,
    records: fn(&PolygonMesh, &Range<usize>) -> Result<Vec<Records>, BuildError>,
}

/// The reason why a structure cannot be explained on a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum ExplainError {
    /// The structure cannot hold the mesh.
    #[error("{structure} cannot hold the mesh: {refusal}")]
    Refused {
        structure: &'static str,
        refusal: BuildError,
    },
}

impl Structure {
    /// Returns the structure `M`, which need not be part of Sixfold.
    pub fn new<M: Representation + Described>() -> Self {
        Self {
            name: M::NAME,
            records: |polygons, rows| Ok(records(&M::from_polygons(polygons)?, rows)),
        }
    }

    /// Returns the six structures of Sixfold.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        sixfold::for_each_representation!(M => { all.push(Self::new::<M>()); });
        all
    }

    /// Returns the structure of Sixfold with this name, or `None` if no structure has it.
    pub fn find(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|one| one.name == name)
    }

    /// Returns the name of the structure, such as `half-edge`.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Builds the structure from `polygons`, and returns its records in the rows `rows`, for each kind
    /// of element. O(corners of the mesh).
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::Refused`] if the structure cannot hold the mesh.
    pub fn records(
        &self,
        polygons: &PolygonMesh,
        rows: Range<usize>,
    ) -> Result<Vec<Records>, ExplainError> {
        (self.records)(polygons, &rows).map_err(|refusal| ExplainError::Refused {
            structure: self.name,
            refusal,
        })
    }
}
