//! The findings of all labs. A lab is one kind of measurement, with its own command.

pub(crate) mod growth;
pub(crate) mod memory;
pub(crate) mod neighbours;
pub(crate) mod orders;
pub(crate) mod pick;
pub(crate) mod slope;
pub(crate) mod spatial_task;
pub(crate) mod study;
pub(crate) mod why;
