//! The rule of the bounding volume hierarchy: the surface area heuristic.

use super::build::{
    BoxedItem, Parts, SplitRule, bounds_of, bounds_of_centres, divide_by_halves, partition,
    sealed::Rule,
};
use super::median;
use crate::bounds::Bounds;

/// Places at which a part may be divided, plus one.
const BINS: usize = 16;

/// Nodes below this depth are divided at their median. A surface has about log₄ n + 4 levels; this
/// bounds the time for items that can only be cut off one by one.
const DEEPEST: u32 = 32;

/// Divides items so that the expected number of tests is least; the rule of [`Bvh`](super::Bvh).
#[derive(Clone, Copy, Debug)]
pub struct SplitByArea;

impl SplitRule for SplitByArea {
    const NAME: &'static str = "bounding volume hierarchy";
}

impl Rule for SplitByArea {
    /// The depth of the node.
    type State = u32;

    const CAN_TURN: bool = true;

    fn start(_: &[BoxedItem]) -> u32 {
        0
    }

    fn divide(items: &mut [BoxedItem], depth: u32, width: usize) -> Parts<u32> {
        if depth >= DEEPEST {
            let length = |items: &[BoxedItem]| items.len() as f64;
            return divide_by_halves(items, depth + 1, width, length, median::halve);
        }
        let area = |items: &[BoxedItem]| bounds_of(items).half_area();
        divide_by_halves(items, depth + 1, width, area, cheapest)
    }
}

/// The items whose middle is in one bin.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    items: usize,
}

impl Bin {
    const EMPTY: Self = Self {
        bounds: Bounds::EMPTY,
        items: 0,
    };

    fn with(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            items: self.items + other.items,
        }
    }

    /// The expected number of tests, up to a factor.
    fn cost(&self) -> f64 {
        self.bounds.half_area() * self.items as f64
    }
}

/// Divides `items` at the cheapest border between two bins, and returns the length of the first part.
fn cheapest(items: &mut [BoxedItem]) -> usize {
    let centres = bounds_of_centres(items);
    let (axis, length) = centres.longest_axis();
    let scale = (BINS as f64 / length) as f32;
    if !scale.is_finite() || scale <= 0.0 {
        return median::halve(items); // all middles are equal, or nearly so
    }
    let low = centres.low[axis];
    let bin = |item: &BoxedItem| (((item.centre()[axis] - low) * scale) as usize).min(BINS - 1);
    let mut bins = [Bin::EMPTY; BINS];
    for item in &*items {
        let bin = &mut bins[bin(item)];
        bin.bounds = bin.bounds.union(item.bounds);
        bin.items += 1;
    }
    // Costs of the bins after each border, from the last border to the first.
    let mut after = [Bin::EMPTY; BINS];
    for border in (1..BINS).rev() {
        let next = if border + 1 < BINS {
            after[border + 1]
        } else {
            Bin::EMPTY
        };
        after[border] = next.with(bins[border]);
    }
    let mut before = Bin::EMPTY;
    let mut best = (f64::INFINITY, 0);
    for border in 1..BINS {
        before = before.with(bins[border - 1]);
        let cost = before.cost() + after[border].cost();
        if before.items > 0 && after[border].items > 0 && cost < best.0 {
            best = (cost, border);
        }
    }
    match partition(items, |item| bin(item) < best.1) {
        0 => median::halve(items), // no border separates them
        first => first,
    }
}
