//! Processes that answer requests: programs of users in child processes, and external programs.

pub mod isolated;
pub mod program;
pub mod subject;
