//! Tests of pages, figures and files for a paper.

mod changes;
mod committed;
mod pages;
mod paper;
