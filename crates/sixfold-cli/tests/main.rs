//! Tests of the command line that run the real binary.

mod bad_input;
mod changes;
mod comparing;
mod distance;
mod external;
mod formats;
mod golden;
mod help_texts;
mod interrupt;
mod json_csv;
mod many;
mod memory;
mod neighbours;
mod obj;
mod outputs;
mod picking;
mod programs;
mod remeshing;
mod render;
mod repair;
mod reports;
mod run;
mod schema;
mod subdivision;
mod user_files;
mod why;
