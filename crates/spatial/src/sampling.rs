//! Sample points that are spread evenly over a surface.

use std::ops::Range;

use glam::DVec3;
use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};

use crate::item::FaceTriangle;

/// How a surface is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// The number of sample points on each surface.
    pub samples: usize,
    /// The start of the random numbers. The same seed gives the same samples on every machine.
    pub seed: u64,
}

/// 100,000 samples, seed 0.
impl Default for Sampling {
    fn default() -> Self {
        Self {
            samples: 100_000,
            seed: 0,
        }
    }
}

/// Points on triangles, in the order of the triangles, in proportion to their areas.
///
/// The total area is divided into equal parts, one for each sample, and each part is sampled at the
/// same place: a triangle gets as many samples as its share of the area, rounded up or down. So the
/// estimate of a mean has less variance than with independent samples. Inside a triangle the points
/// are random.
pub(crate) struct AreaSamples<'a, F> {
    triangles: &'a [FaceTriangle<F>],
    /// The area up to and including each triangle.
    areas: Vec<f64>,
    samples: usize,
    /// The place in each part, from 0 to 1.
    offset: f64,
}

impl<'a, F> AreaSamples<'a, F> {
    /// Prepares the samples of `triangles`; none if they have no area. O(triangles).
    pub(crate) fn new(triangles: &'a [FaceTriangle<F>], sampling: Sampling) -> Self {
        let areas = triangles.iter().scan(0.0, |sum, triangle| {
            *sum += triangle.area();
            Some(*sum)
        });
        let areas: Vec<f64> = areas.collect();
        let has_area = areas.last().is_some_and(|&total| total > 0.0);
        // The last stream; blocks of samples use the streams from 0.
        let mut random = ChaCha8Rng::seed_from_u64(sampling.seed);
        random.set_stream(u64::MAX);
        Self {
            triangles,
            areas,
            samples: if has_area { sampling.samples } else { 0 },
            offset: unit(&mut random),
        }
    }

    /// Returns the number of samples.
    pub(crate) fn len(&self) -> usize {
        self.samples
    }

    /// Passes the samples with the numbers in `range` to `visit`.
    pub(crate) fn for_each(
        &self,
        range: Range<usize>,
        random: &mut impl Rng,
        visit: &mut dyn FnMut(DVec3),
    ) {
        let total = self.areas.last().copied().unwrap_or(0.0);
        let place = |sample: usize| (sample as f64 + self.offset) / self.samples as f64 * total;
        let last = self.areas.partition_point(|&area| area < total);
        let mut triangle = self
            .areas
            .partition_point(|&area| area <= place(range.start));
        for sample in range {
            // The last triangle with area, should the last place round up to the total.
            while self
                .areas
                .get(triangle)
                .is_some_and(|&area| area <= place(sample))
            {
                triangle += 1;
            }
            visit(random_point(&self.triangles[triangle.min(last)], random));
        }
    }
}

/// Returns a point of the triangle; each has the same probability (Turk 1990).
fn random_point<F>(triangle: &FaceTriangle<F>, random: &mut impl Rng) -> DVec3 {
    let [a, b, c] = triangle.corners_f64();
    let along = unit(random).sqrt();
    let across = unit(random);
    a + (b - a) * (along * (1.0 - across)) + (c - a) * (along * across)
}

/// Returns a random number from 0 to 1, without 1.
fn unit(random: &mut impl Rng) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
    (random.next_u64() >> 11) as f64 * STEP
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn strip(areas: &[f32]) -> Vec<FaceTriangle<usize>> {
        let triangle = |(face, &area): (usize, &f32)| {
            let at = Vec3::X * face as f32 * 10.0;
            let corners = [at, at + Vec3::X * 2.0, at + Vec3::Y * area];
            FaceTriangle { face, corners }
        };
        areas.iter().enumerate().map(triangle).collect()
    }

    fn counts(areas: &[f32], samples: usize, blocks: usize) -> Vec<usize> {
        let triangles = strip(areas);
        let sampling = Sampling { samples, seed: 3 };
        let all = AreaSamples::new(&triangles, sampling);
        let mut counts = vec![0; areas.len()];
        for block in 0..blocks {
            let range = samples * block / blocks..samples * (block + 1) / blocks;
            let mut random = ChaCha8Rng::seed_from_u64(1);
            all.for_each(range, &mut random, &mut |point| {
                let face = (point.x / 10.0) as usize;
                assert!(point.y <= f64::from(areas[face]) + 1e-6 && point.y >= 0.0);
                counts[face] += 1;
            });
        }
        counts
    }

    #[test]
    fn triangles_get_samples_in_proportion_to_their_areas() {
        assert_eq!(counts(&[1.0, 2.0, 0.0, 5.0], 80, 1), [10, 20, 0, 50]);
        assert_eq!(counts(&[1.0, 2.0, 0.0, 5.0], 80, 7), [10, 20, 0, 50]);
        let few = counts(&[1.0, 1.0, 1.0, 0.0], 1, 1);
        assert_eq!((few.iter().sum::<usize>(), few[3]), (1, 0));
    }

    #[test]
    fn points_are_spread_evenly_in_a_triangle() {
        let triangles = strip(&[2.0]);
        let sampling = Sampling {
            samples: 20_000,
            seed: 1,
        };
        let samples = AreaSamples::new(&triangles, sampling);
        let mut sum = DVec3::ZERO;
        let mut random = ChaCha8Rng::seed_from_u64(1);
        samples.for_each(0..samples.len(), &mut random, &mut |point| sum += point);
        let mean = sum / samples.len() as f64;
        // The standard deviation of a coordinate is √(2/9) ≈ 0.47, of the mean 0.0033.
        assert!(
            mean.distance(DVec3::new(2.0 / 3.0, 2.0 / 3.0, 0.0)) < 0.02,
            "{mean}"
        );
    }

    #[test]
    fn a_surface_without_area_has_no_samples() {
        let flat = strip(&[0.0, 0.0]);
        assert_eq!(AreaSamples::new(&flat, Sampling::default()).len(), 0);
    }
}
