//! Random polygons that touch themselves.

use std::collections::HashSet;

use proptest::prelude::*;
use proptest::{collection, sample::Index};

/// A polygon that touches itself but does not cross itself, on a grid, with its area.
///
/// The polygon goes around cells of a grid that hang together by their sides. Cells that meet in a
/// point make corners at the same position. Holes are joined to the outline by bridges along the
/// lines of the grid, and spikes run out and back along these lines.
#[derive(Clone, Debug)]
pub struct TouchingPolygon {
    /// The corners, counter-clockwise. Several can have the same coordinates.
    pub corners: Vec<[i32; 2]>,
    /// The area that the polygon encloses.
    pub area: i32,
}

const SIZE: i32 = 6;

/// The directions of the grid, counter-clockwise.
const STEPS: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

fn step([x, y]: [i32; 2], direction: usize) -> [i32; 2] {
    let [dx, dy] = STEPS[direction % 4];
    [x + dx, y + dy]
}

struct Cells(Vec<bool>);

impl Cells {
    fn has(&self, [x, y]: [i32; 2]) -> bool {
        let inside = (0..SIZE).contains(&x) && (0..SIZE).contains(&y);
        inside && self.0[(y * SIZE + x) as usize]
    }

    /// Returns the cell to the left of the side from `at` in a direction.
    fn left([x, y]: [i32; 2], direction: usize) -> [i32; 2] {
        match direction % 4 {
            0 => [x, y],
            1 => [x - 1, y],
            2 => [x - 1, y - 1],
            _ => [x, y - 1],
        }
    }

    /// Returns whether a side of the outline starts at `at` in a direction: it has a cell on its left
    /// and none on its right.
    fn is_side(&self, at: [i32; 2], direction: usize) -> bool {
        let right = Self::left(step(at, direction), direction + 2);
        self.has(Self::left(at, direction)) && !self.has(right)
    }

    /// Keeps only the cells that hang together with `start`.
    fn keep_component(&mut self, start: [i32; 2]) {
        let index = |[x, y]: [i32; 2]| (y * SIZE + x) as usize;
        let mut kept = vec![false; self.0.len()];
        let mut open = vec![start];
        while let Some(cell) = open.pop() {
            if self.has(cell) && !std::mem::replace(&mut kept[index(cell)], true) {
                open.extend((0..4).map(|direction| step(cell, direction)));
            }
        }
        self.0 = kept;
    }

    /// Returns the closed lines around the cells, each as a list of points, one for each unit. Where
    /// two cells meet in a point, a line turns left or right by `turns_left`.
    fn loops(&self, turns_left: bool) -> Vec<Vec<[i32; 2]>> {
        let mut sides = HashSet::new();
        for x in 0..=SIZE {
            for y in 0..=SIZE {
                for direction in 0..4 {
                    if self.is_side([x, y], direction) {
                        sides.insert(([x, y], direction));
                    }
                }
            }
        }
        let mut starts: Vec<_> = sides.iter().copied().collect();
        starts.sort_unstable();
        let mut loops = Vec::new();
        for start in starts {
            let (mut at, mut direction) = start;
            let mut points = Vec::new();
            while sides.remove(&(at, direction)) {
                points.push(at);
                at = step(at, direction);
                let turns = match turns_left {
                    true => [1, 0, 3],
                    false => [3, 0, 1],
                };
                let next = turns.into_iter().map(|turn| (direction + turn) % 4);
                let mut next = next.filter(|&d| sides.contains(&(at, d)));
                direction = next.next().unwrap_or(direction);
            }
            if !points.is_empty() {
                loops.push(points);
            }
        }
        loops
    }
}

/// Joins all lines to one: walks in a direction from the farthest point of a hole until another line
/// is met, and inserts the hole there. Returns `None` if the bridge would run along another one.
fn join_loops(mut loops: Vec<Vec<[i32; 2]>>, direction: usize) -> Option<Vec<[i32; 2]>> {
    let key = |&[x, y]: &[i32; 2]| {
        let [dx, dy] = STEPS[direction];
        (dx * x + dy * y, x, y)
    };
    let outer = loops.iter().position(|points| doubled_area(points) > 0)?;
    loops.swap(0, outer);
    loops[1..].sort_by_key(|points| points.iter().map(key).max());
    while loops.len() > 1 {
        let hole = loops.pop()?;
        let from = (0..hole.len()).max_by_key(|&i| key(&hole[i]))?;
        let mut bridge = vec![hole[from]];
        let met = |at| loops.iter().position(|points| points.contains(&at));
        let other = loop {
            let at = *bridge.last()?;
            match met(at) {
                Some(other) => break &mut loops[other],
                None => bridge.push(step(at, direction)),
            }
        };
        let to = corner_towards(other, *bridge.last()?, (direction + 2) % 4)?;
        let back = bridge.iter().rev().copied();
        let around = hole.iter().copied().cycle().skip(from + 1).take(hole.len());
        let out = bridge.iter().copied().skip(1);
        let inserted: Vec<[i32; 2]> = back.chain(around).chain(out).collect();
        other.splice(to..=to, inserted);
    }
    loops.pop()
}

/// Returns the corner at the place `at` from which a line in a direction runs into the polygon.
fn corner_towards(points: &[[i32; 2]], at: [i32; 2], direction: usize) -> Option<usize> {
    let n = points.len();
    let towards = |to| (0..4).find(|&d| step(at, d) == to);
    (0..n).filter(|&i| points[i] == at).find(|&i| {
        let [before, after] = [i + n - 1, i + 1].map(|j| towards(points[j % n]));
        let (Some(before), Some(after)) = (before, after) else {
            return false;
        };
        let inside = match (before + 4 - after) % 4 {
            0 => 4,
            turn => turn,
        };
        (1..inside).contains(&((direction + 4 - after) % 4))
    })
}

fn doubled_area(points: &[[i32; 2]]) -> i32 {
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .map(|(&[x, y], &[to_x, to_y])| x * to_y - to_x * y)
        .sum()
}

/// Generates polygons that touch themselves.
pub fn touching_polygon() -> impl Strategy<Value = TouchingPolygon> {
    let cells = collection::vec(prop::bool::weighted(0.75), (SIZE * SIZE) as usize);
    let spikes = collection::vec((any::<Index>(), 0..4_usize, 1..4_usize), 0..4);
    let choices = (any::<bool>(), 0..4_usize, any::<bool>(), any::<Index>());
    (cells, choices, spikes).prop_filter_map("no outline", |(cells, choices, spikes)| {
        let (turns_left, direction, keeps_flat, start) = choices;
        let mut cells = Cells(cells);
        let mut all = (0..SIZE * SIZE).map(|i| [i % SIZE, i / SIZE]);
        let first = all.find(|&cell| cells.has(cell))?;
        cells.keep_component(first);
        let area = cells.0.iter().filter(|&&cell| cell).count() as i32;
        let mut corners = join_loops(cells.loops(turns_left), direction)?;
        for (at, direction, length) in spikes {
            let at = at.index(corners.len());
            add_spike(&mut corners, at, direction, length);
        }
        if !keeps_flat {
            remove_flat(&mut corners);
        }
        let start = start.index(corners.len());
        corners.rotate_left(start);
        Some(TouchingPolygon { corners, area })
    })
}

/// Adds a spike at a corner that is the only one at its place. The spike ends before the outline.
fn add_spike(corners: &mut Vec<[i32; 2]>, at: usize, direction: usize, length: usize) {
    let from = corners[at];
    if corners.iter().filter(|&&p| p == from).count() > 1 {
        return;
    }
    let mut out = vec![from];
    for _ in 0..length {
        let next = step(out[out.len() - 1], direction);
        if corners.contains(&next) {
            break;
        }
        out.push(next);
    }
    let back: Vec<[i32; 2]> = out.iter().rev().skip(1).copied().collect();
    corners.splice(at..=at, out.into_iter().chain(back));
}

/// Removes corners between their neighbours on the same line.
fn remove_flat(corners: &mut Vec<[i32; 2]>) {
    let n = corners.len();
    let is_flat = |i: usize| {
        let [a, b, c] = [i + n - 1, i, i + 1].map(|j| corners[j % n]);
        [0, 1].map(|k| b[k] - a[k]) == [0, 1].map(|k| c[k] - b[k])
    };
    *corners = (0..n)
        .filter(|&i| !is_flat(i))
        .map(|i| corners[i])
        .collect();
}
