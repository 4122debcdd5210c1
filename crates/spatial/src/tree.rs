//! Trees of boxes: octree, kd-tree and bounding volume hierarchy.

mod area;
mod build;
mod frame;
mod median;
mod node;
mod octants;

use std::marker::PhantomData;
use std::ops::{ControlFlow, Range};

use glam::{DMat3, DVec3};
use smallvec::SmallVec;

use crate::error::SpatialError;
use crate::index::{SpatialIndex, can_search};
use crate::item::{Item, check_items};
use crate::ray::Ray;
use node::{Child, Node, NodeQuery};

pub use area::SplitByArea;
pub use build::SplitRule;
pub use median::SplitByMedian;
pub use octants::SplitByOctants;

/// A tree that divides a cube into eight equal cubes, again and again, where it has many items
/// (Meagher 1982).
///
/// A node has up to eight children, one for each octant with items. An item belongs to the octant of
/// the middle of its box. If all items of a node lie in one octant, the cube first shrinks to their
/// box, so the depth depends on the number of items and not on their distances. O(n · depth) to
/// build; the depth is O(log n) for items that are spread evenly.
pub type Octree<I> = Tree<I, SplitByOctants, 8>;

/// A tree that divides its items at the median along the axis on which they extend farthest
/// (Bentley 1975; buckets and choice of the axis: Friedman, Bentley & Finkel 1977).
///
/// A node is divided twice, so it has four children, and all leaves have the same depth or one
/// more or less. O(n log n) to build, for any items.
pub type KdTree<I> = Tree<I, SplitByMedian, 4>;

/// A bounding volume hierarchy: a tree that divides its items so that the boxes of the parts have
/// small surfaces.
///
/// A ray that hits a box also hits a box inside with a probability proportional to its surface. The
/// division has the least expected number of tests (the surface area heuristic of MacDonald & Booth
/// 1990), chosen from 16 bins along the longest axis (Wald 2007). The part with the largest surface is
/// divided again until a node has four children. O(n log n) to build: below a certain depth, nodes
/// are divided at their median.
pub type Bvh<I> = Tree<I, SplitByArea, 4>;

/// A tree whose nodes store the boxes of up to `W` children. `R` divides the items of a node.
///
/// ```text
///   node:  low  x: ▯▯▯▯  y: ▯▯▯▯  z: ▯▯▯▯       one distance or ray test compares the query with
///          high x: ▯▯▯▯  y: ▯▯▯▯  z: ▯▯▯▯       all W boxes at once, lane by lane
///          child:  ▯▯▯▯                         a node, or 1 to 8 items that follow each other
/// ```
///
/// The three rules share layout and search, so a comparison shows what the division of space is
/// worth. An item is stored once, in the part with the middle of its box; the boxes of parts with
/// triangles may therefore overlap. Boxes fit their items exactly.
///
/// # Invariants
///
/// - T1  The items of a leaf follow each other; all leaves together have each slot once.
/// - T2  The box of a child is the smallest box around its items; along other axes, a little larger than
///   the smallest.
/// - T3  A leaf has 1 to 8 items; an inner node has at least two children.
///
/// # Memory
///
/// `W` · 28 + 8 bytes per node, 72 for axes of its own, and the items: about 22 bytes per vertex and 60
/// per triangle. While a
/// tree is built, 32 bytes per item more, and the items twice.
///
/// # Complexity
///
/// Searches among n items that are spread evenly over a surface take O(log n) expected, plus the
/// items found. In the worst case (all items at the same distance) O(n). Coordinates above 10¹⁸ or
/// below 10⁻¹⁸ make searches slower, because squared distances of boxes are in single precision;
/// the answers stay exact.
#[derive(Clone, Debug)]
pub struct Tree<I, R, const W: usize> {
    nodes: Vec<Node<W>>,
    /// The axes of nodes whose boxes are not along the coordinate axes.
    axes: Vec<DMat3>,
    items: Vec<I>,
    rule: PhantomData<R>,
}

/// A child that a search still has to visit, with a lower bound of its squared distance or of the
/// parameter of the ray.
#[derive(Clone, Copy)]
struct Pending {
    bound: f32,
    child: Child,
}

/// The children still to visit, the nearest last.
type Stack = SmallVec<[Pending; 64]>;

impl<I: Item, R: SplitRule, const W: usize> Tree<I, R, W> {
    /// Visits items of nodes in the order of their bounds. `bounds_of` computes the bounds of the
    /// children of a node; `threshold` converts the limit to one for bounds.
    #[inline(always)]
    fn search(
        &self,
        limit: f64,
        threshold: impl Fn(f64) -> f32,
        bounds_of: impl Fn(&Node<W>) -> [f32; W],
        mut visit: impl FnMut(usize) -> f64,
    ) {
        let mut highest = threshold(limit);
        let mut stack = Stack::new();
        if !self.nodes.is_empty() {
            stack.push(Pending {
                bound: 0.0,
                child: Child::ROOT,
            });
        }
        while let Some(next) = stack.pop() {
            if next.bound > highest {
                continue;
            }
            if let Some(slots) = next.child.slots() {
                let limit = slots.fold(limit, |_, slot| visit(slot));
                highest = threshold(limit);
                continue;
            }
            let node = &self.nodes[next.child.node()];
            let bounds = bounds_of(node);
            let first = stack.len();
            for (lane, &bound) in bounds.iter().enumerate().take(node.children()) {
                // False for a bound that is infinite or NaN only if the limit is finite.
                if bound <= highest {
                    push_in_order(&mut stack, first, bound, node.child(lane));
                }
            }
        }
    }
}

impl<I: Item, R: SplitRule, const W: usize> Tree<I, R, W> {
    /// Calls `visit` with the slots of items until it breaks, among them each that has a point within `reach`
    /// of a point of `shape` along all coordinate axes.
    ///
    /// Visits O(log n) nodes, and the items found, for items that are spread evenly.
    pub fn visit_meeting(
        &self,
        shape: &impl Item,
        reach: f32,
        visit: impl FnMut(usize) -> ControlFlow<()>,
    ) {
        self.visit_meeting_where(shape, reach, |_| true, visit);
    }

    /// Visits items like [`visit_meeting`](Self::visit_meeting), without the nodes whose slots are a range that
    /// `accepts` does not accept.
    pub fn visit_meeting_where(
        &self,
        shape: &impl Item,
        reach: f32,
        accepts: impl Fn(Range<usize>) -> bool,
        mut visit: impl FnMut(usize) -> ControlFlow<()>,
    ) {
        // Along other axes, points are at most this far apart.
        let turned_reach = reach * 3_f32.sqrt().next_up();
        // A child, and the slot after its last.
        let mut stack: SmallVec<[(Child, usize); 64]> = SmallVec::new();
        if !self.nodes.is_empty() {
            stack.push((Child::ROOT, self.items.len()));
        }
        while let Some((child, mut end)) = stack.pop() {
            if let Some(mut slots) = child.slots() {
                if slots.try_for_each(&mut visit).is_break() {
                    return;
                }
                continue;
            }
            let node = &self.nodes[child.node()];
            let axes = node.axes().map(|axes| &self.axes[axes]);
            let reach = if axes.is_some() { turned_reach } else { reach };
            for lane in (0..node.children()).rev() {
                let child = node.child(lane);
                let slots = self.first_slot(child)..end;
                end = slots.start;
                let is_near = shape.may_meet(axes, &node.bounds(lane).widened(reach));
                if is_near && accepts(slots.clone()) {
                    stack.push((child, slots.end));
                }
            }
        }
    }

    /// Returns the first slot below a child.
    fn first_slot(&self, mut child: Child) -> usize {
        loop {
            match child.slots() {
                Some(slots) => return slots.start,
                None => child = self.nodes[child.node()].child(0),
            }
        }
    }
}

/// Adds a child after those with larger bounds, in the part of `stack` from `first`.
#[inline(always)]
fn push_in_order(stack: &mut Stack, first: usize, bound: f32, child: Child) {
    let mut at = stack.len();
    stack.push(Pending { bound, child });
    while at > first && stack[at - 1].bound < bound {
        stack.swap(at - 1, at);
        at -= 1;
    }
}

impl<I: Item, R: SplitRule, const W: usize> SpatialIndex<I> for Tree<I, R, W> {
    const NAME: &'static str = R::NAME;

    fn build(items: Vec<I>) -> Result<Self, SpatialError> {
        check_items(&items)?;
        let (built, items) = build::build::<I, R, W>(items);
        Ok(Self {
            nodes: built.nodes,
            axes: built.axes,
            items,
            rule: PhantomData,
        })
    }

    #[inline]
    fn items(&self) -> &[I] {
        &self.items
    }

    #[inline]
    fn visit_near(&self, query: DVec3, limit: f64, visit: impl FnMut(usize) -> f64) {
        if !can_search(query) {
            return;
        }
        let boxed = NodeQuery::new(query);
        let distances = |node: &Node<W>| match node.axes() {
            None => node.distances(&boxed),
            Some(axes) => node.distances_along(&self.axes[axes], query),
        };
        self.search(limit, node::largest_bound, distances, visit);
    }

    #[inline]
    fn visit_along(&self, ray: &Ray, limit: f64, visit: impl FnMut(usize) -> f64) {
        let slab = ray.slab();
        let threshold = |limit: f64| rounded_up(limit).min(f32::MAX);
        let entries = |node: &Node<W>| match node.axes() {
            None => node.entries(slab),
            Some(axes) => node.entries_along(&self.axes[axes], ray),
        };
        self.search(limit, threshold, entries, visit);
    }

    fn memory_bytes(&self) -> usize {
        let axes = size_of_val(self.axes.as_slice());
        size_of_val(self.nodes.as_slice()) + axes + size_of_val(self.items.as_slice())
    }
}

/// Returns the lowest value in single precision that is not below `limit`.
#[inline]
fn rounded_up(limit: f64) -> f32 {
    let rounded = limit as f32;
    if f64::from(rounded) < limit {
        rounded.next_up()
    } else {
        rounded
    }
}

#[cfg(test)]
mod tests;
