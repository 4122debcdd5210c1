//! The schedule of a mix: how many operations of each kind run in each turn (a group of
//! operations).

use std::ops::Range;

use sixfold_core::Counts;

use crate::workload::{Action, Part, Workload};
use sixfold_results::OwnData;

/// Number of element operations in a turn.
const TURN_OPERATIONS: f64 = 256.0;
/// Number of element operations in a turn if there are edits. Each edit needs its own place.
const EDIT_TURN_OPERATIONS: f64 = 64.0;

/// The schedule of a mix on a mesh: the kinds of operations, and how often each kind runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    /// The parts of the mix. A part is one kind of operation with its weight.
    pub parts: Vec<Part>,
    /// The share of each part in all operations, from 0 to 1.
    pub shares: Vec<f64>,
    /// The share of the operations on single elements, from 0 to 1. All other operations are passes
    /// over the whole mesh.
    pub on_elements: f64,
    /// The number of operations on single elements in one turn.
    pub turn_operations: f64,
    /// True if the mix edits the mesh, in single edits or passes, or sets positions. The mix then needs
    /// an editable mesh.
    pub editable: bool,
    /// The program's own data that the visits read and write.
    pub own_data: OwnData,
    /// The number of edges of the mesh.
    pub(crate) edges: usize,
}

impl Schedule {
    /// Builds the schedule of `workload` for a mesh with the given numbers of elements.
    pub fn new(workload: &Workload, counts: &Counts) -> Self {
        let shares = workload.shares(counts);
        let on_elements = shares.iter().zip(&workload.mix);
        let on_elements = on_elements.filter(|(_, part)| !part.action.is_pass());
        Self {
            on_elements: on_elements.map(|(share, _)| share).sum(),
            turn_operations: match workload.mix.iter().any(|part| is_edit(part.action)) {
                true => EDIT_TURN_OPERATIONS,
                false => TURN_OPERATIONS,
            },
            editable: workload
                .mix
                .iter()
                .any(|part| part.action.needs_editable_mesh()),
            parts: workload.mix.clone(),
            shares,
            own_data: workload.own_data,
            edges: counts.edges,
        }
    }

    /// Returns the numbers of the operations of the part `part` that belong to the turn with the number
    /// `turn`. A turn is a group of 256 operations (64 if the mix has edits). The range is empty if the
    /// part is a pass over the whole mesh. The operations of each part are numbered from 0, starting in turn 0.
    pub fn turn_range(&self, part: usize, turn: u64) -> Range<u64> {
        if self.parts[part].action.is_pass() {
            return 0..0;
        }
        // Round the running total, so that no operation is lost or repeated.
        let each = self.turn_operations * self.shares[part] / self.on_elements;
        let done = |turns: u64| (each * turns as f64) as u64;
        done(turn)..done(turn + 1)
    }

    /// Returns the number of operations that the part with index `part` runs in the first `turns`
    /// turns.
    pub fn operations_within(&self, part: usize, turns: u64) -> u64 {
        match turns {
            0 => 0,
            turns => self.turn_range(part, turns - 1).end,
        }
    }

    /// Returns the indices of the parts that are edits.
    pub fn edits(&self) -> impl Iterator<Item = usize> + Clone {
        (0..self.parts.len()).filter(|&part| is_edit(self.parts[part].action))
    }

    /// Returns the indices of the parts that are passes over the whole mesh.
    pub fn passes(&self) -> impl Iterator<Item = usize> {
        (0..self.parts.len()).filter(|&part| self.parts[part].action.is_pass())
    }

    /// Returns the indices of the parts that query or move single elements.
    pub fn elements(&self) -> impl Iterator<Item = usize> {
        (0..self.parts.len()).filter(|&part| !self.parts[part].action.is_pass())
    }
}

fn is_edit(action: Action) -> bool {
    matches!(action, Action::Edit(_))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_gets_its_share() {
        let text = "operations = 5\n[mix]\nvertex_faces = 3\nedge_faces = 0.001\nboundary = 1";
        let workload = Workload::parse("test", "test", text).expect("fine");
        let counts = Counts {
            vertices: 4,
            edges: 6,
            faces: 4,
            corners: 12,
            uniform: true,
        };
        let schedule = Schedule::new(&workload, &counts);
        let turns = 100_000;
        let all: u64 = (0..3)
            .map(|part| schedule.operations_within(part, turns))
            .sum();
        assert!(all.abs_diff(256 * turns) <= 2, "{all}");
        for part in 0..3 {
            let summed: u64 = (0..1000)
                .map(|t| schedule.turn_range(part, t).count() as u64)
                .sum();
            assert_eq!(
                summed,
                schedule.operations_within(part, 1000),
                "part {part}"
            );
        }
        assert_eq!(schedule.operations_within(1, turns), 8530); // 25.6 million by 3001
        assert_eq!(schedule.operations_within(2, turns), 0);
        assert!((schedule.on_elements - 3.001 / 4.001).abs() < 1e-12);
    }
}
