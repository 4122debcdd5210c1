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

    const DIVIDES_AGAIN: bool = true;

    fn start(_: &[BoxedItem]) -> u32 {
        0
    }

    fn divide(items: &mut [BoxedItem], depth: u32, width: usize) -> Parts<u32> {
        divide_by(items, depth, width, cheapest)
    }

    fn divide_again(items: &mut [BoxedItem], depth: u32, width: usize) -> Parts<u32> {
        divide_by(items, depth, width, cheapest_of_all)
    }
}

/// Divides items by the surfaces of the parts, above the depth at which the median bounds the time.
fn divide_by(
    items: &mut [BoxedItem],
    depth: u32,
    width: usize,
    divide: fn(&mut [BoxedItem]) -> usize,
) -> Parts<u32> {
    if depth >= DEEPEST {
        let length = |items: &[BoxedItem]| items.len() as f64;
        return divide_by_halves(items, depth + 1, width, length, median::halve);
    }
    let area = |items: &[BoxedItem]| bounds_of(items).half_area();
    divide_by_halves(items, depth + 1, width, area, divide)
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

/// A border between two bins along an axis.
#[derive(Clone, Copy)]
struct Border {
    cost: f64,
    axis: usize,
    low: f32,
    scale: f32,
    /// The number of bins before it.
    bins: usize,
}

impl Border {
    #[inline]
    fn bin(&self, item: &BoxedItem) -> usize {
        (((item.centre()[self.axis] - self.low) * self.scale) as usize).min(BINS - 1)
    }
}

/// Divides `items` at the cheapest border between two bins along the longest axis, and returns the length of
/// the first part.
fn cheapest(items: &mut [BoxedItem]) -> usize {
    let centres = bounds_of_centres(items);
    let (axis, _) = centres.longest_axis();
    divide_at(items, cheapest_border(items, &centres, axis))
}

/// Divides `items` at the cheapest border along any axis.
fn cheapest_of_all(items: &mut [BoxedItem]) -> usize {
    let centres = bounds_of_centres(items);
    let borders = (0..3).filter_map(|axis| cheapest_border(items, &centres, axis));
    let cheapest = borders.min_by(|a, b| a.cost.total_cmp(&b.cost));
    divide_at(items, cheapest)
}

fn divide_at(items: &mut [BoxedItem], border: Option<Border>) -> usize {
    let Some(border) = border else {
        return median::halve(items); // all middles are equal, or nearly so
    };
    match partition(items, |item| border.bin(item) < border.bins) {
        0 => median::halve(items), // no border separates them
        first => first,
    }
}

/// Returns the cheapest border along an axis; `None` if all middles are at the same place along it.
fn cheapest_border(items: &[BoxedItem], centres: &Bounds, axis: usize) -> Option<Border> {
    let scale = (BINS as f64 / centres.extent()[axis]) as f32;
    if !scale.is_finite() || scale <= 0.0 {
        return None;
    }
    let mut best = Border {
        cost: f64::INFINITY,
        axis,
        low: centres.low[axis],
        scale,
        bins: 0,
    };
    let mut bins = [Bin::EMPTY; BINS];
    for item in items {
        let bin = &mut bins[best.bin(item)];
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
    for border in 1..BINS {
        before = before.with(bins[border - 1]);
        let cost = before.cost() + after[border].cost();
        if before.items > 0 && after[border].items > 0 && cost < best.cost {
            (best.cost, best.bins) = (cost, border);
        }
    }
    Some(best)
}
