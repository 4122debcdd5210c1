//! The rule of the kd-tree: halves with equal numbers of items.

use super::build::{
    BoxedItem, Parts, SplitRule, bounds_of_centres, divide_by_halves, sealed::Rule,
};

/// Divides items at the median of their middles along the axis on which these extend farthest; the
/// rule of [`KdTree`](super::KdTree).
#[derive(Clone, Copy, Debug)]
pub struct SplitByMedian;

impl SplitRule for SplitByMedian {
    const NAME: &'static str = "kd-tree";
}

impl Rule for SplitByMedian {
    type State = ();

    fn start(_: &[BoxedItem]) {}

    fn divide(items: &mut [BoxedItem], (): (), width: usize) -> Parts<()> {
        divide_by_halves(items, (), width, |items| items.len() as f64, halve)
    }
}

/// Divides `items` into halves along their longest axis, and returns the length of the first. Items
/// with the same middle are divided by their numbers.
pub(super) fn halve(items: &mut [BoxedItem]) -> usize {
    let (axis, _) = bounds_of_centres(items).longest_axis();
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        let by_place = a.centre()[axis].total_cmp(&b.centre()[axis]);
        by_place.then(a.item.cmp(&b.item))
    });
    half
}
