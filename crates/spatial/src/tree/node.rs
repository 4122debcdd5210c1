//! Nodes: the boxes of all children, by axis, so that one test compares all of them.

use std::ops::Range;

use glam::{DMat3, DVec3};
use sixfold_core::row;

use crate::bounds::Bounds;
use crate::ray::{Ray, SlabRay, larger, padded, rounded_outwards, smaller};

/// The most items of a leaf; they fit four bits of [`Child`].
pub(super) const LEAF_ITEMS: usize = 8;

/// A node: boxes and children by lane. Lanes beyond the number of children are never read.
#[derive(Clone, Debug)]
pub(super) struct Node<const W: usize> {
    low: [[f32; W]; 3],
    high: [[f32; W]; 3],
    child: [u32; W],
    /// By lane, four bits: the number of items if the child is a leaf, 0 if it is a node.
    leaves: u32,
    /// The number of children in the four lowest bits. Above them, 0 if the boxes are along the coordinate
    /// axes, and else the number of their axes plus 1.
    children: u32,
}

/// The bits of [`Node::children`] for the number of children.
const COUNT_BITS: u32 = 4;

/// A child: a node, or the items of a leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Child {
    first: u32,
    items: u32,
}

/// A query point in single precision, rounded so that the distances of boxes are lower bounds.
pub(super) struct NodeQuery {
    below: [f32; 3],
    above: [f32; 3],
}

impl NodeQuery {
    #[inline]
    pub(super) fn new(query: DVec3) -> Self {
        let (below, above) = rounded_outwards(query);
        Self {
            below: below.to_array(),
            above: above.to_array(),
        }
    }
}

impl Child {
    /// The root of a tree.
    pub(super) const ROOT: Self = Self { first: 0, items: 0 };

    /// Returns the slots of a leaf, or `None` for a node.
    #[inline(always)]
    pub(super) fn slots(self) -> Option<Range<usize>> {
        let first = self.first as usize;
        (self.items > 0).then(|| first..first + self.items as usize)
    }

    /// Returns the number of the node.
    #[inline(always)]
    pub(super) fn node(self) -> usize {
        self.first as usize
    }
}

impl<const W: usize> Node<W> {
    /// A node without children.
    pub(super) const EMPTY: Self = Self {
        low: [[0.0; W]; 3],
        high: [[0.0; W]; 3],
        child: [0; W],
        leaves: 0,
        children: 0,
    };

    /// Returns the number of children.
    #[inline(always)]
    pub(super) fn children(&self) -> usize {
        (self.children & ((1 << COUNT_BITS) - 1)) as usize
    }

    /// Returns the number of the axes of the boxes; `None` for the coordinate axes.
    #[inline(always)]
    pub(super) fn axes(&self) -> Option<usize> {
        ((self.children >> COUNT_BITS) as usize).checked_sub(1)
    }

    /// Stores the number of the axes of the boxes.
    pub(super) fn set_axes(&mut self, axes: usize) {
        let count = self.children() as u32;
        self.children = (row(axes + 1) << COUNT_BITS) | count;
    }

    /// Returns the child in `lane`.
    #[inline(always)]
    pub(super) fn child(&self, lane: usize) -> Child {
        Child {
            first: self.child[lane],
            items: (self.leaves >> (4 * lane)) & 15,
        }
    }

    /// Returns the box of the child in `lane`.
    pub(super) fn bounds(&self, lane: usize) -> Bounds {
        let corner = |table: &[[f32; W]; 3]| [0, 1, 2].map(|axis| table[axis][lane]).into();
        Bounds {
            low: corner(&self.low),
            high: corner(&self.high),
        }
    }

    /// Adds a leaf with `items` items from slot `first`, or a node `first` if `items` is 0.
    pub(super) fn push(&mut self, bounds: Bounds, first: u32, items: usize) {
        debug_assert!(items <= LEAF_ITEMS, "a leaf of {items} items");
        let lane = self.children();
        for axis in 0..3 {
            self.low[axis][lane] = bounds.low[axis];
            self.high[axis][lane] = bounds.high[axis];
        }
        self.child[lane] = first;
        self.leaves |= (items as u32) << (4 * lane);
        self.children += 1;
    }

    /// Adds `offset` to the numbers of all nodes that are children, and `axes` to that of its axes.
    #[cfg(feature = "rayon")]
    pub(super) fn shift(&mut self, offset: u32, axes: usize) {
        if let Some(own) = self.axes() {
            self.set_axes(own + axes);
        }
        for lane in 0..self.children() {
            if self.child(lane).items == 0 {
                self.child[lane] += offset;
            }
        }
    }

    /// Returns the squared distance of each box to `query`.
    #[inline(always)]
    pub(super) fn distances(&self, query: &NodeQuery) -> [f32; W] {
        let mut squared = [0.0; W];
        for axis in 0..3 {
            let (below, above) = (query.below[axis], query.above[axis]);
            let sides = self.low[axis].iter().zip(&self.high[axis]);
            for (squared, (low, high)) in squared.iter_mut().zip(sides) {
                let gap = larger(0.0, larger(low - above, below - high));
                *squared += gap * gap;
            }
        }
        squared
    }

    /// Returns the parameter at which `ray` enters each box, or infinity if it misses the box.
    #[inline(always)]
    pub(super) fn entries(&self, ray: &SlabRay) -> [f32; W] {
        let mut near = [0.0; W];
        let mut far = [f32::INFINITY; W];
        for axis in 0..3 {
            let (low, high) = (&self.low[axis], &self.high[axis]);
            let (first, last) = if ray.descends[axis] {
                (high, low)
            } else {
                (low, high)
            };
            for (near, &first) in near.iter_mut().zip(first) {
                *near = larger(*near, ray.enter(axis, first));
            }
            for (far, &last) in far.iter_mut().zip(last) {
                *far = smaller(*far, ray.leave(axis, last));
            }
        }
        for (near, far) in near.iter_mut().zip(far) {
            let (first, last) = padded(*near, far);
            *near = if first <= last { first } else { f32::INFINITY };
        }
        near
    }
}

/// The part by which bounds along rotated axes are lower than computed.
const ROTATED: f64 = 1e-6;

impl<const W: usize> Node<W> {
    /// Returns the squared distance of each box along `axes` to `query`.
    #[cold]
    #[inline(never)]
    pub(super) fn distances_along(&self, axes: &DMat3, query: DVec3) -> [f32; W] {
        let query = *axes * query;
        std::array::from_fn(|lane| {
            let (low, high) = self.box_f64(lane);
            let gap = (low - query).max(query - high).max(DVec3::ZERO);
            (gap.length_squared() * (1.0 - ROTATED)) as f32
        })
    }

    /// Returns the parameter at which `ray` enters each box along `axes`, or infinity if it misses the
    /// box.
    #[cold]
    #[inline(never)]
    pub(super) fn entries_along(&self, axes: &DMat3, ray: &Ray) -> [f32; W] {
        let origin = *axes * ray.origin();
        let direction = *axes * ray.scaled_direction();
        std::array::from_fn(|lane| {
            let (low, high) = self.box_f64(lane);
            let (mut near, mut far) = (0.0_f64, f64::INFINITY);
            for axis in 0..3 {
                let sides =
                    [low[axis], high[axis]].map(|side| (side - origin[axis]) / direction[axis]);
                // Both are NaN for a ray inside a plane of the box; such an axis does not restrict it.
                near = near.max(sides[0].min(sides[1]));
                far = far.min(sides[0].max(sides[1]));
            }
            let (near, far) = (near * (1.0 - ROTATED), far * (1.0 + ROTATED));
            match near <= far {
                true => (near as f32).next_down().max(0.0),
                false => f32::INFINITY,
            }
        })
    }

    fn box_f64(&self, lane: usize) -> (DVec3, DVec3) {
        let corner = |table: &[[f32; W]; 3]| {
            DVec3::from_array([0, 1, 2].map(|axis| f64::from(table[axis][lane])))
        };
        (corner(&self.low), corner(&self.high))
    }
}

/// Returns a bound for the squared distances of boxes: above it, no point in the box is within the
/// squared distance `limit`.
///
/// [`Node::distances`] has five rounding errors of 2⁻²⁴, and below 2⁻¹²⁶ an absolute error.
#[inline]
pub(super) fn largest_bound(limit: f64) -> f32 {
    (limit * (1.0 + 1e-6) + 2.0 * f64::from(f32::MIN_POSITIVE)) as f32
}
