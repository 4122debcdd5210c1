//! The control: one backend that is measured twice, to find the noise.

use crate::engine::measure::Entry;
use sixfold_results::ranking::ratio;
use sixfold_results::statistics::Median;
use sixfold_results::{Confidence, Control, ControlRow};

/// Compares the two columns of `backend`: the subjects `first` and `second`.
pub fn control(
    entries: &[Entry],
    first: usize,
    second: usize,
    backend: &str,
    confidence: Confidence,
) -> Option<Control> {
    let mut operations = Vec::new();
    for again in entries.iter().filter(|e| e.subject == second) {
        let same = |e: &&Entry| e.subject == first && e.job.task == again.job.task;
        let Some(once) = entries.iter().find(same) else {
            continue;
        };
        // A coarse clock may measure zero, which has no ratio.
        let ratio = ratio(&again.times(), &once.times());
        let known = |ratio: &Median| ratio.value.is_finite() && ratio.value > 0.0;
        if let Some(ratio) = ratio.filter(known) {
            operations.push(ControlRow::new(again.name, ratio, confidence, Vec::new()));
        }
    }
    Control::new(backend, operations)
}
