//! Boxes along any axes.

use glam::{DMat3, DVec3};

use crate::bounds::Bounds;
use crate::item::Item;

/// More than the rounding errors of a comparison, relative to the coordinates.
const ROUNDING: f64 = 1e-12;

/// A box around a part of a mesh, along the longest sides of the part: long thin parts have thin boxes in
/// all directions (Gottschalk, Lin & Manocha 1996).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedBox {
    /// The axes, as columns.
    axes: DMat3,
    centre: DVec3,
    /// Half of the lengths along the axes.
    half: DVec3,
}

impl TurnedBox {
    /// Returns the box around items; they must be finite.
    pub fn around<'i, I: Item + 'i>(items: impl Iterator<Item = &'i I> + Clone) -> Self {
        let axes = axes_along(|| items.clone().flat_map(Item::sides)).unwrap_or(DMat3::IDENTITY);
        let along = items.map(|item| item.bounds_along(&axes));
        let along = along.fold(Bounds::EMPTY, Bounds::union);
        let [low, high] = [along.low.as_dvec3(), along.high.as_dvec3()];
        let axes = axes.transpose();
        Self {
            axes,
            centre: axes * (0.5 * (low + high)),
            half: 0.5 * (high - low),
        }
    }

    /// Returns whether the boxes may have a common point; never false if they have one. Compares them along
    /// the axes of both and across each pair of axes.
    pub fn meets(&self, other: &Self) -> bool {
        let between = other.centre - self.centre;
        let size = between.abs().max_element() + self.half.max_element() + other.half.max_element();
        let separates = |axis: DVec3| {
            let reach = |turned: &Self| {
                let along = |i: usize| turned.half[i] * axis.dot(turned.axes.col(i)).abs();
                along(0) + along(1) + along(2)
            };
            axis.dot(between).abs() > reach(self) + reach(other) + ROUNDING * size
        };
        let axes = (0..3).flat_map(|i| [self.axes.col(i), other.axes.col(i)]);
        let across = (0..9).map(|i| self.axes.col(i / 3).cross(other.axes.col(i % 3)));
        !axes.chain(across).any(separates)
    }
}

/// Returns axes, as rows: along the longest of the sides, and along the side that is longest across it.
/// `None` if the sides are on one line.
pub(crate) fn axes_along<S: Iterator<Item = DVec3>>(sides: impl Fn() -> S) -> Option<DMat3> {
    let longest = |length: &dyn Fn(DVec3) -> f64| {
        sides().fold(DVec3::ZERO, |best, side| {
            match length(side) > length(best) {
                true => side,
                false => best,
            }
        })
    };
    let first = longest(&|side| side.length_squared()).try_normalize()?;
    let across = |side: DVec3| side - first * first.dot(side);
    let second = across(longest(&|side| across(side).length_squared())).try_normalize()?;
    Some(DMat3::from_cols(first, second, first.cross(second)).transpose())
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::item::FaceTriangle;

    fn triangles() -> impl Strategy<Value = Vec<FaceTriangle<u32>>> {
        let corner = || prop::array::uniform3(-3.0_f32..3.0).prop_map(Vec3::from_array);
        let corners = prop::array::uniform3(corner());
        let triangle = corners.prop_map(|corners| FaceTriangle { face: 0, corners });
        prop::collection::vec(triangle, 1..4)
    }

    proptest! {
        #[test]
        fn boxes_with_a_common_point_meet(
            one in triangles(),
            mut other in triangles(),
            weights in prop::array::uniform3(0.01..1.0_f32),
        ) {
            // Moves the others so that a point of a triangle of each is the same.
            let point = |triangle: &FaceTriangle<u32>| {
                let sum: f32 = weights.iter().sum();
                let parts = triangle.corners.iter().zip(weights);
                parts.map(|(&corner, weight)| corner * (weight / sum)).sum::<Vec3>()
            };
            let shift = point(&one[0]) - point(&other[0]);
            for triangle in &mut other {
                triangle.corners = triangle.corners.map(|corner| corner + shift);
            }
            let [a, b] = [&one, &other].map(|list| TurnedBox::around(list.iter()));
            // The common point is rounded.
            let near = TurnedBox { half: a.half + 1e-5, ..a };
            prop_assert!(near.meets(&b) && b.meets(&near));
        }
    }

    #[test]
    fn crossing_needles_that_do_not_touch_have_boxes_apart() {
        let needle = |from: [f32; 3], to: [f32; 3]| {
            let [from, to] = [from, to].map(Vec3::from_array);
            let corners = [from, to, from + Vec3::splat(0.01)];
            TurnedBox::around([FaceTriangle { face: 0, corners }].iter())
        };
        let one = needle([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]);
        let other = needle([-1.0, 1.0, 0.2], [1.0, -1.0, 0.2]);
        assert!(!one.meets(&other) && one.meets(&one));
        let through = needle([-1.0, 1.0, 0.0], [1.0, -1.0, 0.0]);
        assert!(one.meets(&through));
    }
}
