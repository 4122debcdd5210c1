//! Building: a rule divides the items of a node, again and again.

use smallvec::SmallVec;

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

        /// Returns the state for the root.
        fn start(items: &[BoxedItem]) -> Self::State;

        /// Reorders `items`, which do not fit a leaf, and returns 2 to `width` parts that are not
        /// empty.
        fn divide(items: &mut [BoxedItem], state: Self::State, width: usize) -> Parts<Self::State>;
    }
}

/// Builds the nodes, and the items in the order of the leaves.
pub(super) fn build<I: Item, R: SplitRule, const W: usize>(
    items: Vec<I>,
) -> (Vec<Node<W>>, Vec<I>) {
    let mut boxed: Vec<BoxedItem> = items
        .iter()
        .enumerate()
        .map(|(number, item)| BoxedItem {
            bounds: item.bounds(),
            item: row(number),
        })
        .collect();
    let mut nodes = Vec::new();
    if !boxed.is_empty() {
        let state = R::start(&boxed);
        push_node::<R, W>(&mut boxed, 0, state, &mut nodes);
        nodes.shrink_to_fit();
    }
    let ordered = boxed.iter().map(|boxed| items[boxed.item as usize]);
    (nodes, ordered.collect())
}

/// A part of the items of a node.
struct Part<'a, S> {
    items: &'a mut [BoxedItem],
    /// The slot of its first item.
    first: usize,
    bounds: Bounds,
    state: S,
}

/// Appends the node of `items`, whose first slot is `first`, and all nodes below it.
fn push_node<R: SplitRule, const W: usize>(
    items: &mut [BoxedItem],
    first: usize,
    state: R::State,
    nodes: &mut Vec<Node<W>>,
) {
    let parts = parts_of::<R, W>(items, first, state);
    let at = nodes.len();
    nodes.push(Node::EMPTY);
    #[cfg(feature = "rayon")]
    if parts.iter().map(|part| part.items.len()).sum::<usize>() >= PARALLEL_ITEMS
        && rayon::current_num_threads() > 1
    {
        return push_parts_in_parallel::<R, W>(parts, at, nodes);
    }
    for part in parts {
        let count = part.items.len();
        if count <= LEAF_ITEMS {
            nodes[at].push(part.bounds, row(part.first), count);
        } else {
            let child = row(nodes.len());
            nodes[at].push(part.bounds, child, 0);
            push_node::<R, W>(part.items, part.first, part.state, nodes);
        }
    }
}

/// Appends the nodes below node `at`, each part on a thread of its own. The nodes and their order
/// are the same as on one thread.
#[cfg(feature = "rayon")]
fn push_parts_in_parallel<R: SplitRule, const W: usize>(
    parts: SmallVec<[Part<'_, R::State>; 8]>,
    at: usize,
    nodes: &mut Vec<Node<W>>,
) {
    use rayon::prelude::*;
    let built: Vec<(Bounds, usize, usize, Vec<Node<W>>)> = parts
        .into_vec()
        .into_par_iter()
        .map(|part| {
            let mut below = Vec::new();
            let count = part.items.len();
            if count > LEAF_ITEMS {
                push_node::<R, W>(part.items, part.first, part.state, &mut below);
            }
            (part.bounds, part.first, count, below)
        })
        .collect();
    for (bounds, first, count, mut below) in built {
        if below.is_empty() {
            nodes[at].push(bounds, row(first), count);
            continue;
        }
        let offset = row(nodes.len());
        nodes[at].push(bounds, offset, 0);
        below.iter_mut().for_each(|node| node.shift_nodes(offset));
        nodes.append(&mut below);
    }
}

/// Divides the items of a node, which may also fit a leaf if the node is the root.
fn parts_of<R: SplitRule, const W: usize>(
    items: &mut [BoxedItem],
    first: usize,
    state: R::State,
) -> SmallVec<[Part<'_, R::State>; 8]> {
    let ends = if items.len() <= LEAF_ITEMS {
        Parts::from_iter([(items.len(), state)])
    } else {
        R::divide(items, state, W)
    };
    let mut parts = SmallVec::new();
    let mut rest = items;
    let mut start = 0;
    for (end, state) in ends {
        let (part, after) = rest.split_at_mut(end - start);
        parts.push(Part {
            bounds: bounds_of(part),
            items: part,
            first: first + start,
            state,
        });
        (rest, start) = (after, end);
    }
    parts
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
