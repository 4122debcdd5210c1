//! Which part of a mix has its turn when.

use std::ops::Range;

use sixfold::Counts;

use crate::workload::{Action, Part, Workload};

/// So many operations on elements make a turn: what chooses between the parts is lost in them.
const TURN: f64 = 256.0;
/// So many where there are edits: a turn has to find places for all of its own, and they are long.
const EDITING_TURN: f64 = 64.0;

/// The mix of a workload on a mesh, unrolled.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// The mix.
    pub parts: Vec<Part>,
    /// By part: its share of all operations.
    pub shares: Vec<f64>,
    /// What part of all operations are done to elements; the rest are passes.
    pub on_elements: f64,
    /// So many operations on elements make a turn.
    pub turn_operations: f64,
    /// Whether a mesh that can be edited is needed, if only for what the mix does not tell.
    pub editable: bool,
}

impl Script {
    /// The script of `workload` on a mesh with such counts.
    pub fn of(workload: &Workload, counts: &Counts) -> Self {
        let shares = workload.shares(counts);
        let on_elements = shares.iter().zip(&workload.mix);
        let on_elements = on_elements.filter(|(_, part)| !part.action.is_a_pass());
        Self {
            on_elements: on_elements.map(|(share, _)| share).sum(),
            turn_operations: match workload.mix.iter().any(|part| is_edit(part.action)) {
                true => EDITING_TURN,
                false => TURN,
            },
            editable: workload.mix.iter().any(|part| writes(part.action)),
            parts: workload.mix.clone(),
            shares,
        }
    }

    /// Which operations of `part` turn `turn` does, counted from the first of all.
    pub fn turn(&self, part: usize, turn: u64) -> Range<u64> {
        if self.parts[part].action.is_a_pass() {
            return 0..0;
        }
        // So that what is owed is neither lost nor paid twice: one in a thousand has every fourth turn.
        let each = self.turn_operations * self.shares[part] / self.on_elements;
        let done = |turns: u64| (each * turns as f64) as u64;
        done(turn)..done(turn + 1)
    }

    /// How many operations of `part` so many turns do, from the first on.
    pub fn within(&self, part: usize, turns: u64) -> u64 {
        match turns {
            0 => 0,
            turns => self.turn(part, turns - 1).end,
        }
    }

    /// The parts that are edits.
    pub fn edits(&self) -> impl Iterator<Item = usize> + Clone {
        (0..self.parts.len()).filter(|&part| is_edit(self.parts[part].action))
    }

    /// The parts that are passes.
    pub fn passes(&self) -> impl Iterator<Item = usize> {
        (0..self.parts.len()).filter(|&part| self.parts[part].action.is_a_pass())
    }

    /// The parts that are done to elements.
    pub fn elements(&self) -> impl Iterator<Item = usize> {
        (0..self.parts.len()).filter(|&part| !self.parts[part].action.is_a_pass())
    }
}

fn is_edit(action: Action) -> bool {
    matches!(action, Action::Edit(_))
}

/// Whether an action on elements changes the mesh.
fn writes(action: Action) -> bool {
    is_edit(action) || action == Action::SetPosition
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
        let script = Script::of(&workload, &counts);
        let turns = 100_000;
        let all: u64 = (0..3).map(|part| script.within(part, turns)).sum();
        assert!(all.abs_diff(256 * turns) <= 2, "{all}");
        for part in 0..3 {
            let summed: u64 = (0..1000).map(|t| script.turn(part, t).count() as u64).sum();
            assert_eq!(summed, script.within(part, 1000), "part {part}");
        }
        assert_eq!(script.within(1, turns), 8530); // 25.6 million by 3001
        assert_eq!(script.within(2, turns), 0);
        assert!((script.on_elements - 3.001 / 4.001).abs() < 1e-12);
    }
}
