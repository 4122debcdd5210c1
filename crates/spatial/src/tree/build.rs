//! Building: a rule divides the items of a node, again and again.

use glam::DMat3;
use smallvec::SmallVec;

use super::frame::{self, FEW, Sizes};
use super::node::{LEAF_ITEMS, Node};
use crate::bounds::Bounds;
use crate::item::Item;
use sixfold_core::row;

/// Nodes with fewer items are built by one thread.
#[cfg(feature = "rayon")]
const PARALLEL_ITEMS: usize = 1 << 13;

/// An item while a tree is built: its box and its number.
#[derive(Clone, Copy, Debug)]
pub struct BoxedItem {
    pub(super) bounds: Bounds,
    pub(super) item: u32,
}

impl BoxedItem {
    /// Returns the middle of the box.
    #[inline]
    pub(super) fn centre(&self) -> glam::Vec3 {
        self.bounds.centre()
    }
}

/// The parts of a node: where each part ends, and the state of the rule for it.
pub(super) type Parts<S> = SmallVec<[(usize, S); 8]>;

/// A rule that divides the items of a node. The trait is sealed: its methods are not public.
pub trait SplitRule: sealed::Rule {
    /// The name of the tree.
    const NAME: &'static str;
}

pub(super) mod sealed {
    use super::{BoxedItem, Parts};

    pub trait Rule: Sized + Send + Sync {
        /// What a rule passes from a node to its children.
        type State: Copy + Send + Sync;

        /// Whether parts whose boxes overlap are divided again, also along other axes than those of the node
        /// above.
        const DIVIDES_AGAIN: bool = false;

        /// Returns the state for the root.
        fn start(items: &[BoxedItem]) -> Self::State;

        /// Reorders `items`, which do not fit a leaf, and returns 2 to `width` parts that are not
        /// empty.
        fn divide(items: &mut [BoxedItem], state: Self::State, width: usize) -> Parts<Self::State>;

        /// Divides items like [`divide`](Self::divide), with more work for parts that overlap less.
        fn divide_again(
            items: &mut [BoxedItem],
            state: Self::State,
            width: usize,
        ) -> Parts<Self::State> {
            Self::divide(items, state, width)
        }
    }
}

/// Nodes that are built, and the axes of their boxes.
#[derive(Default)]
pub(super) struct Built<const W: usize> {
    pub(super) nodes: Vec<Node<W>>,
    pub(super) axes: Vec<DMat3>,
}

/// Builds the nodes, and the items in the order of the leaves.
pub(super) fn build<I: Item, R: SplitRule, const W: usize>(items: Vec<I>) -> (Built<W>, Vec<I>) {
    let mut boxed: Vec<BoxedItem> = items
        .iter()
        .enumerate()
        .map(|(number, item)| BoxedItem {
            bounds: item.bounds(),
            item: row(number),
        })
        .collect();
    let mut built = Built::default();
    if !boxed.is_empty() {
        let state = R::start(&boxed);
        let whole = bounds_of(&boxed);
        let root = Part {
            items: &mut boxed,
            first: 0,
            bounds: whole,
            state,
        };
        push_node::<I, R, W>(root, &items, None, &mut built);
        built.nodes.shrink_to_fit();
    }
    let ordered = boxed.iter().map(|boxed| items[boxed.item as usize]);
    (built, ordered.collect())
}

/// A part of the items of a node.
struct Part<'a, S> {
    items: &'a mut [BoxedItem],
    /// The slot of its first item.
    first: usize,
    bounds: Bounds,
    state: S,
}

/// The parts of a node that is divided by the rule `R`.
type PartsOf<'a, R> = SmallVec<[Part<'a, <R as sealed::Rule>::State>; 8]>;

/// Appends the node of a part, whose boxes are along the axes with the number `axes`, and all nodes
/// below it.
fn push_node<I: Item, R: SplitRule, const W: usize>(
    part: Part<'_, R::State>,
    items: &[I],
    axes: Option<usize>,
    built: &mut Built<W>,
) {
    let (parts, turned) = parts_of::<I, R, W>(part, items);
    let axes = turned.map_or(axes, |turned| {
        built.axes.push(turned);
        Some(built.axes.len() - 1)
    });
    let at = built.nodes.len();
    built.nodes.push(Node::EMPTY);
    if let Some(axes) = axes {
        built.nodes[at].set_axes(axes);
    }
    #[cfg(feature = "rayon")]
    if parts.iter().map(|part| part.items.len()).sum::<usize>() >= PARALLEL_ITEMS
        && rayon::current_num_threads() > 1
    {
        return push_parts_in_parallel::<I, R, W>(parts, items, at, axes, built);
    }
    for part in parts {
        let count = part.items.len();
        if count <= LEAF_ITEMS {
            built.nodes[at].push(part.bounds, row(part.first), count);
        } else {
            let child = row(built.nodes.len());
            built.nodes[at].push(part.bounds, child, 0);
            push_node::<I, R, W>(part, items, axes, built);
        }
    }
}

/// Appends the nodes below node `at`, each part on a thread of its own. The nodes and their order
/// are the same as on one thread.
#[cfg(feature = "rayon")]
fn push_parts_in_parallel<I: Item, R: SplitRule, const W: usize>(
    parts: PartsOf<'_, R>,
    items: &[I],
    at: usize,
    axes: Option<usize>,
    built: &mut Built<W>,
) {
    use rayon::prelude::*;
    let own = axes.map(|axes| built.axes[axes]);
    let below: Vec<(Bounds, usize, usize, Built<W>)> = parts
        .into_vec()
        .into_par_iter()
        .map(|part| {
            let mut below = Built {
                nodes: Vec::new(),
                axes: own.into_iter().collect(),
            };
            let (bounds, first, count) = (part.bounds, part.first, part.items.len());
            if count > LEAF_ITEMS {
                push_node::<I, R, W>(part, items, own.map(|_| 0), &mut below);
            }
            (bounds, first, count, below)
        })
        .collect();
    for (bounds, first, count, mut below) in below {
        if below.nodes.is_empty() {
            built.nodes[at].push(bounds, row(first), count);
            continue;
        }
        let offset = row(built.nodes.len());
        let axes = built.axes.len();
        built.nodes[at].push(bounds, offset, 0);
        let nodes = below.nodes.iter_mut();
        nodes.for_each(|node| node.shift(offset, axes));
        built.nodes.append(&mut below.nodes);
        built.axes.append(&mut below.axes);
    }
}

/// Divides a part, which may also fit a leaf if it is the root. Returns other axes, if the boxes of the
/// parts are along these.
fn parts_of<'a, I: Item, R: SplitRule, const W: usize>(
    part: Part<'a, R::State>,
    items: &[I],
) -> (PartsOf<'a, R>, Option<DMat3>) {
    let Part {
        items: boxed,
        first,
        bounds: whole,
        state,
    } = part;
    if boxed.len() <= LEAF_ITEMS {
        return (
            SmallVec::from_iter([Part {
                items: boxed,
                first,
                bounds: whole,
                state,
            }]),
            None,
        );
    }
    let mut ends = R::divide(boxed, state, W);
    let mut bounds = bounds_of_parts(boxed, &ends);
    let mut axes = None;
    let sizes = Sizes::within(&whole);
    if R::DIVIDES_AGAIN && boxed.len() > FEW && sizes.overlap(&whole, &bounds) {
        let mut least = sizes.sum(&bounds);
        let mut before = boxed.to_vec();
        for turned in [None, frame::other_axes(boxed, items)] {
            if let Some(turned) = &turned {
                for boxed in boxed.iter_mut() {
                    boxed.bounds = items[boxed.item as usize].bounds_along(turned);
                }
            }
            let new_ends = R::divide_again(boxed, state, W);
            let new_bounds = bounds_of_parts(boxed, &new_ends);
            let sum = sizes.sum(&new_bounds);
            if frame::is_better(least, sum, turned.is_some()) {
                (least, ends, bounds, axes) = (sum, new_ends, new_bounds, turned);
                before.copy_from_slice(boxed);
            } else {
                boxed.copy_from_slice(&before);
            }
        }
    }
    let mut parts = SmallVec::new();
    let mut rest = boxed;
    let mut start = 0;
    for ((end, state), bounds) in ends.into_iter().zip(bounds) {
        let (part, after) = rest.split_at_mut(end - start);
        parts.push(Part {
            items: part,
            first: first + start,
            bounds,
            state,
        });
        (rest, start) = (after, end);
    }
    (parts, axes)
}

/// Returns the smallest box around the items of each part.
fn bounds_of_parts<S>(items: &[BoxedItem], ends: &Parts<S>) -> SmallVec<[Bounds; 8]> {
    let mut start = 0;
    let part = |&(end, _): &(usize, S)| bounds_of(&items[std::mem::replace(&mut start, end)..end]);
    ends.iter().map(part).collect()
}

/// Returns the smallest box around `items`.
pub(super) fn bounds_of(items: &[BoxedItem]) -> Bounds {
    items
        .iter()
        .fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds))
}

/// Returns the smallest box around the middles of `items`.
pub(super) fn bounds_of_centres(items: &[BoxedItem]) -> Bounds {
    Bounds::from_points(items.iter().map(BoxedItem::centre))
}

/// Moves the items for which `is_first` holds before the others, and returns their number.
pub(super) fn partition(
    items: &mut [BoxedItem],
    mut is_first: impl FnMut(&BoxedItem) -> bool,
) -> usize {
    let mut first = 0;
    for at in 0..items.len() {
        if is_first(&items[at]) {
            items.swap(first, at);
            first += 1;
        }
    }
    first
}

/// Divides `items` into two parts at a time, until there are `width` parts or all of them fit a leaf.
/// The part with the largest `weight` is divided next; `divide` returns the length of the first half.
pub(super) fn divide_by_halves<S: Copy>(
    items: &mut [BoxedItem],
    state: S,
    width: usize,
    weight: impl Fn(&[BoxedItem]) -> f64,
    divide: impl Fn(&mut [BoxedItem]) -> usize,
) -> Parts<S> {
    let mut parts = Parts::from_iter([(items.len(), state)]);
    let mut weights: SmallVec<[f64; 8]> = SmallVec::from_iter([f64::INFINITY]);
    let weight_of = |items: &[BoxedItem]| match items.len() {
        0..=LEAF_ITEMS => f64::NEG_INFINITY,
        _ => weight(items),
    };
    while parts.len() < width {
        let heaviest = (0..parts.len()).fold(0, |best, part| {
            if weights[part] > weights[best] {
                part
            } else {
                best
            }
        });
        if weights[heaviest] == f64::NEG_INFINITY {
            break;
        }
        let start = if heaviest == 0 {
            0
        } else {
            parts[heaviest - 1].0
        };
        let end = parts[heaviest].0;
        let middle = start + divide(&mut items[start..end]);
        parts.insert(heaviest, (middle, state));
        weights[heaviest] = weight_of(&items[start..middle]);
        weights.insert(heaviest + 1, weight_of(&items[middle..end]));
    }
    parts
}
