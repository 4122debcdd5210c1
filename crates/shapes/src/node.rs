//! The expression tree of a field.

use crate::arithmetic::exp_minus;
use crate::bounds::Bounds;
use crate::error::ShapeError;
use crate::implicit::Blob;
use crate::marching::Solid;

/// Minimum number of rounds that tighten the bounds. The rounds then continue while each round
/// shortens the longest side by more than a quarter.
const MIN_TIGHTENING_ROUNDS: u32 = 3;

/// A node of the expression tree of a field.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Node {
    Sphere {
        centre: [f64; 3],
        radius: f64,
    },
    Torus {
        centre: [f64; 3],
        /// A unit vector.
        axis: [f64; 3],
        ring: f64,
        tube: f64,
    },
    Cuboid {
        centre: [f64; 3],
        half: [f64; 3],
    },
    Blobs {
        blobs: Vec<Blob>,
        level: f64,
    },
    Union(Box<[Node; 2]>),
    Intersection(Box<[Node; 2]>),
    Difference(Box<[Node; 2]>),
    SmoothUnion {
        parts: Box<[Node; 2]>,
        alpha: f64,
    },
    Inflated {
        part: Box<Node>,
        by: f64,
    },
}

impl Node {
    /// Returns the value of the field at a point.
    pub(crate) fn at(&self, point: [f64; 3]) -> f64 {
        match self {
            Self::Sphere { centre, radius } => {
                length_squared(offset(*centre, point)).sqrt() - radius
            }
            Self::Torus {
                centre,
                axis,
                ring,
                tube,
            } => {
                let offset = offset(*centre, point);
                let along = offset[0] * axis[0] + offset[1] * axis[1] + offset[2] * axis[2];
                // Near the axis, rounding may make the difference negative.
                let radial = (length_squared(offset) - along * along).max(0.0).sqrt() - ring;
                (radial * radial + along * along).sqrt() - tube
            }
            Self::Cuboid { centre, half } => {
                let offset = offset(*centre, point);
                let over: [f64; 3] = std::array::from_fn(|axis| offset[axis].abs() - half[axis]);
                let inside = over[0].max(over[1]).max(over[2]).min(0.0);
                length_squared(over.map(|x| x.max(0.0))).sqrt() + inside
            }
            Self::Blobs { blobs, level } => {
                let bells = blobs.iter().map(|blob| {
                    let r2 = length_squared(offset(blob.centre, point));
                    blob.strength * exp_minus(blob.sharpness * r2)
                });
                level - bells.sum::<f64>()
            }
            Self::Union(parts) => parts[0].at(point).min(parts[1].at(point)),
            Self::Intersection(parts) => parts[0].at(point).max(parts[1].at(point)),
            Self::Difference(parts) => parts[0].at(point).max(-parts[1].at(point)),
            Self::SmoothUnion { parts, alpha } => {
                smooth_union(parts[0].at(point), parts[1].at(point), *alpha)
            }
            Self::Inflated { part, by } => part.at(point) - by,
        }
    }

    /// Returns a lower and an upper bound of the field over a ball.
    fn range(&self, centre: [f64; 3], radius: f64) -> [f64; 2] {
        let ranges = |parts: &[Self; 2]| [0, 1].map(|i| parts[i].range(centre, radius));
        match self {
            // A distance field changes at most as fast as the point moves.
            Self::Sphere { .. } | Self::Torus { .. } | Self::Cuboid { .. } => {
                let value = self.at(centre);
                [value - radius, value + radius]
            }
            Self::Blobs { blobs, level } => {
                let mut range = [*level; 2];
                for blob in blobs {
                    let distance = length_squared(offset(blob.centre, centre)).sqrt();
                    let [near, far] = [(distance - radius).max(0.0), distance + radius]
                        .map(|r| blob.strength * exp_minus(blob.sharpness * r * r));
                    range[0] -= near.max(far);
                    range[1] -= near.min(far);
                }
                range
            }
            // The other operations are monotonic.
            Self::Union(parts) => {
                let [f, g] = ranges(parts);
                [0, 1].map(|end| f[end].min(g[end]))
            }
            Self::Intersection(parts) => {
                let [f, g] = ranges(parts);
                [0, 1].map(|end| f[end].max(g[end]))
            }
            Self::Difference(parts) => {
                let [f, g] = ranges(parts);
                [0, 1].map(|end| f[end].max(-g[1 - end]))
            }
            Self::SmoothUnion { parts, alpha } => {
                let [f, g] = ranges(parts);
                [0, 1].map(|end| smooth_union(f[end], g[end], *alpha))
            }
            Self::Inflated { part, by } => part.range(centre, radius).map(|value| value - by),
        }
    }

    /// Returns bounds of the solid, or `None` if the solid is certainly empty.
    pub(crate) fn bounds(&self) -> Result<Option<Bounds>, ShapeError> {
        let Some(mut bounds) = self.sublevel_bounds(0.0)? else {
            return Ok(None);
        };
        // The bounds of a chain of smooth unions can be much larger than the solid.
        for round in 0.. {
            let empty = |centre, radius| self.range(centre, radius)[0] > 0.0;
            let Some(tighter) = bounds.tightened(empty) else {
                return Ok(None);
            };
            if round >= MIN_TIGHTENING_ROUNDS
                && tighter.longest_side() >= 0.75 * bounds.longest_side()
            {
                break;
            }
            bounds = tighter;
        }
        Ok(Some(bounds))
    }

    /// Returns bounds of the points where the field is at most `level`, or `None` if there are no
    /// such points.
    fn sublevel_bounds(&self, level: f64) -> Result<Option<Bounds>, ShapeError> {
        Ok(match self {
            Self::Sphere { centre, radius } => Bounds::from_centre(*centre, [radius + level; 3]),
            Self::Torus {
                centre, ring, tube, ..
            } => {
                // The bounds of a ball are sufficient for any direction of the axis.
                let thickness = tube + level;
                (thickness >= 0.0)
                    .then(|| Bounds::from_centre(*centre, [ring + thickness; 3]))
                    .flatten()
            }
            Self::Cuboid { centre, half } => Bounds::from_centre(*centre, half.map(|x| x + level)),
            Self::Blobs { blobs, level: sum } => blob_bounds(blobs, sum - level)?,
            Self::Union(parts) => Bounds::union(
                parts[0].sublevel_bounds(level)?,
                parts[1].sublevel_bounds(level)?,
            ),
            Self::Intersection(parts) => Bounds::intersection(
                parts[0].sublevel_bounds(level)?,
                parts[1].sublevel_bounds(level)?,
            ),
            Self::Difference(parts) => parts[0].sublevel_bounds(level)?,
            Self::SmoothUnion { parts, alpha } => {
                // If min(f, g) is given, the smooth union is smallest for f = g.
                let share = (2.0 - (2.0 - 2.0 * alpha).sqrt()) / (1.0 + alpha);
                let level = level.max(0.0) / share;
                Bounds::union(
                    parts[0].sublevel_bounds(level)?,
                    parts[1].sublevel_bounds(level)?,
                )
            }
            Self::Inflated { part, by } => part.sublevel_bounds(level + by)?,
        })
    }
}

impl Solid for Node {
    fn at(&self, point: [f64; 3]) -> f64 {
        self.at(point)
    }

    fn sign_over(&self, centre: [f64; 3], radius: f64) -> Option<f64> {
        match self.range(centre, radius) {
            [least, _] if least > 0.0 => Some(1.0),
            [_, greatest] if greatest < 0.0 => Some(-1.0),
            _ => None,
        }
    }
}

/// Returns Rvachev's smooth union, which increases with `f` and with `g`.
fn smooth_union(f: f64, g: f64, alpha: f64) -> f64 {
    let radicand = f * f + g * g - 2.0 * alpha * f * g;
    (f + g - radicand.max(0.0).sqrt()) / (1.0 + alpha)
}

/// Returns bounds of the points where the sum of the blobs is at least `sum`.
fn blob_bounds(blobs: &[Blob], sum: f64) -> Result<Option<Bounds>, ShapeError> {
    if sum <= 0.0 {
        return Err(ShapeError::Unbounded);
    }
    // If the sum of the blobs is at least `sum`, at least one blob has at least this share.
    let share = sum / blobs.len() as f64;
    let bounds = blobs.iter().map(|blob| {
        let ratio = blob.strength / share;
        if ratio < 1.0 {
            return None;
        }
        // exp(−x) ≤ (1 + x/8)⁻⁸, and square roots solve this bound for x.
        let x = 8.0 * (ratio.sqrt().sqrt().sqrt() - 1.0);
        Bounds::from_centre(blob.centre, [(x / blob.sharpness).sqrt(); 3])
    });
    Ok(bounds.fold(None, Bounds::union))
}

fn offset(centre: [f64; 3], point: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| point[axis] - centre[axis])
}

pub(crate) fn length_squared([x, y, z]: [f64; 3]) -> f64 {
    x * x + y * y + z * z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::marching::polygonised;

    #[test]
    fn ranges_and_bounds_contain_every_value() {
        let ball = |x, radius| {
            Box::new(Node::Sphere {
                centre: [x, 0.1, 0.0],
                radius,
            })
        };
        let axis = [0.6, 0.0, 0.8];
        let ring = Node::Torus {
            centre: [0.2; 3],
            axis,
            ring: 1.0,
            tube: 0.3,
        };
        let cuboid = Node::Cuboid {
            centre: [0.0, 0.3, 0.0],
            half: [0.5, 0.9, 0.2],
        };
        let blob = |x, strength, sharpness| Blob {
            centre: [x, 0.0, 0.2],
            strength,
            sharpness,
        };
        let blobs = vec![
            blob(0.0, 1.0, 1.5),
            blob(0.8, -0.6, 3.0),
            blob(-0.9, 0.9, 4.0),
        ];
        let blobs = Node::Blobs { blobs, level: 0.35 };
        let pair = |f: &Node, g: &Node| Box::new([f.clone(), g.clone()]);
        let smooth = |alpha| Node::SmoothUnion {
            parts: pair(&ring, &cuboid),
            alpha,
        };
        let inflated = |part: &Node, by| Node::Inflated {
            part: Box::new(part.clone()),
            by,
        };
        let nodes = [
            *ball(0.0, 0.7),
            ring.clone(),
            cuboid.clone(),
            blobs.clone(),
            Node::Union(pair(&ring, &blobs)),
            Node::Intersection(pair(&ring, &cuboid)),
            Node::Difference(pair(&blobs, &ring)),
            smooth(0.0),
            smooth(0.7),
            smooth(1.0),
            inflated(&smooth(0.0), 0.3),
            inflated(&smooth(0.4), -0.1),
            inflated(&blobs, 0.1),
        ];
        let coordinate = |i: usize, n: usize| 4.0 * i as f64 / n as f64 - 2.0;
        let lattice = |n: usize| {
            let index =
                move |i: usize| [i % n, i / n % n, i / (n * n)].map(|i| coordinate(i, n - 1));
            (0..n * n * n).map(index)
        };
        for node in nodes {
            let bounds = node.bounds().expect("bounded").expect("not empty");
            let mut inside = 0;
            for point in lattice(41) {
                if node.at(point) <= 0.0 {
                    assert!(bounds.contains(point), "{node:?} at {point:?}");
                    inside += 1;
                }
            }
            assert!(inside > 0, "{node:?}");
            let fine = bounds.lattice(0.08, [0.3; 3]).expect("a coarse lattice");
            let all = polygonised(&|point: [f64; 3]| node.at(point), &fine).build();
            let some = polygonised(&node, &fine).build();
            assert!(all == some, "{node:?}");
            for centre in lattice(5) {
                for radius in [0.1, 0.5, 1.5] {
                    let [least, greatest] = node.range(centre, radius);
                    for point in lattice(13) {
                        let distance = length_squared(offset(centre, point)).sqrt();
                        let scale = if distance > 0.0 {
                            radius / distance
                        } else {
                            0.0
                        };
                        let sample: [f64; 3] =
                            std::array::from_fn(|i| centre[i] + scale * (point[i] - centre[i]));
                        let value = node.at(sample);
                        let within = least - 1e-12 <= value && value <= greatest + 1e-12;
                        assert!(
                            within,
                            "{node:?} at {sample:?}: {value} of {least} to {greatest}"
                        );
                    }
                }
            }
        }
    }
}
