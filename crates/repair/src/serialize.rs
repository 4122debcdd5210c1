//! Handles as numbers in JSON.

use serde::{Serialize, Serializer};
use sixfold_core::RowId;

/// Writes a handle as its row.
pub(crate) fn row<H: RowId, S: Serializer>(handle: &H, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_u32(handle.row())
}

/// Writes two handles as their rows.
pub(crate) fn rows<H: RowId, S: Serializer>(
    handles: &[H; 2],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    handles.map(RowId::row).serialize(serializer)
}
