//! Handles of elements, maps from handles to values, and short lists of handles.

pub(crate) mod distinct;
pub(crate) mod handle;
pub(crate) mod iterator_ext;
pub(crate) mod limits;
pub(crate) mod numbering;
pub(crate) mod pair;
pub(crate) mod row_id;
pub(crate) mod short_vec;
