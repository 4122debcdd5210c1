//! The results of all labs, in one document.

pub(crate) mod compare;
pub(crate) mod csv;
pub(crate) mod document;
pub(crate) mod environment;
pub(crate) mod figure;
pub(crate) mod finding;
pub(crate) mod json;
pub(crate) mod merge;
pub(crate) mod pool;
pub(crate) mod quotient;
pub(crate) mod read;
pub(crate) mod rows;
pub(crate) mod run;
