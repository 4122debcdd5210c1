//! Queries and edits of structures that scan all corners.

pub(crate) mod scan;
pub(crate) mod scan_edit;
pub(crate) mod scanned;
