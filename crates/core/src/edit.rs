//! Edits in place, their reports, and data that follows them.

pub(crate) mod edit_at_face;
pub(crate) mod edit_call;
pub(crate) mod edit_check;
pub(crate) mod edit_error;
pub(crate) mod edit_kind;
pub(crate) mod edit_log;
pub(crate) mod element_data;
pub(crate) mod element_name;
pub(crate) mod element_names;
pub(crate) mod follow_edits;
pub(crate) mod mesh_edit;
pub(crate) mod mesh_with_data;
pub(crate) mod new_rows;
pub(crate) mod side_data;
