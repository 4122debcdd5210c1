//! The labs. A lab is one kind of measurement: it says which backends and operations to measure, and
//! what follows from the times.

pub(crate) mod growth;
pub(crate) mod memory;
pub(crate) mod neighbours;
pub(crate) mod orders;
pub(crate) mod pick;
pub(crate) mod study;
pub(crate) mod why;
