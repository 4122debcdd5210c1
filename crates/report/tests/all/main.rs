//! Tests of pages, figures and files for a paper.

mod changes;
mod pages;
mod paper;
