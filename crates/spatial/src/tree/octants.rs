//! The rule of the octree: eight cubes of half the size.

use glam::Vec3;

use super::build::{BoxedItem, Parts, SplitRule, bounds_of_centres, partition, sealed::Rule};
use super::median;

/// Divides a cube into its eight octants; the rule of [`Octree`](super::Octree).
#[derive(Clone, Copy, Debug)]
pub struct SplitByOctants;

/// The cube of a node.
#[derive(Clone, Copy, Debug)]
pub struct Cube {
    middle: Vec3,
    /// Half of the length of a side.
    half: f32,
}

impl Cube {
    /// Returns the cube around the middles of `items`, or `None` if all of them are equal.
    fn around(items: &[BoxedItem]) -> Option<Self> {
        let bounds = bounds_of_centres(items);
        let (_, length) = bounds.longest_axis();
        (length > 0.0).then(|| Self {
            middle: bounds.centre(),
            half: (0.5 * length) as f32,
        })
    }

    /// Returns the cube of `octant`: bit 0 is set in the upper half along x, bit 1 along y, bit 2
    /// along z.
    fn child(&self, octant: usize) -> Self {
        let half = 0.5 * self.half;
        let step = [0, 1, 2].map(|axis| {
            if (octant >> axis) & 1 == 1 {
                half
            } else {
                -half
            }
        });
        Self {
            middle: self.middle + Vec3::from(step),
            half,
        }
    }
}

impl SplitRule for SplitByOctants {
    const NAME: &'static str = "octree";
}

impl Rule for SplitByOctants {
    /// `None` if all items of the node have the same middle.
    type State = Option<Cube>;

    fn start(items: &[BoxedItem]) -> Option<Cube> {
        Cube::around(items)
    }

    fn divide(items: &mut [BoxedItem], cube: Option<Cube>, _: usize) -> Parts<Option<Cube>> {
        if let Some(cube) = cube {
            let parts = octants(items, cube);
            if parts.len() > 1 {
                return parts;
            }
        }
        // All items are in one octant: the cube shrinks to their box. Its middle separates the lowest
        // item from the highest, unless these differ by one step of single precision.
        match Cube::around(items).map(|cube| octants(items, cube)) {
            Some(parts) if parts.len() > 1 => parts,
            _ => {
                let half = median::halve(items);
                let state = |items: &[BoxedItem]| Cube::around(items);
                let (first, second) = items.split_at(half);
                Parts::from_iter([(half, state(first)), (items.len(), state(second))])
            }
        }
    }
}

/// Sorts `items` by octant, and returns the octants that are not empty.
fn octants(items: &mut [BoxedItem], cube: Cube) -> Parts<Option<Cube>> {
    // Octant `i` has the items from border `i` to border `i + 1`: first divided along z, then both
    // halves along y, then the quarters along x.
    let mut borders = [0; 9];
    borders[8] = items.len();
    for axis in [2, 1, 0] {
        let half = 1 << axis;
        for first in (0..8).step_by(2 * half) {
            let (start, end) = (borders[first], borders[first + 2 * half]);
            let is_low = |item: &BoxedItem| item.centre()[axis] <= cube.middle[axis];
            borders[first + half] = start + partition(&mut items[start..end], is_low);
        }
    }
    let mut parts = Parts::new();
    for octant in 0..8 {
        if borders[octant + 1] > borders[octant] {
            parts.push((borders[octant + 1], Some(cube.child(octant))));
        }
    }
    parts
}
