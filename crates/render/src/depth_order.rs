//! The order in which polygons are painted.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use sixfold_core::{FaceId, PolygonMesh, row};

use crate::layout::Panel;
use crate::rasterise::{Corner, Rasteriser};

/// Maximum number of samples. Mean depths order all further faces.
const MAX_SAMPLES: usize = 1 << 24;

/// Minimum difference in depth, in pixels, at which the nearer face must come later.
const MIN_DEPTH_DIFFERENCE: f32 = 0.25;

/// The surface of a face at a pixel.
struct Layer {
    pixel: u32,
    depth: f32,
    face: u32,
}

/// Returns the faces marked `visible`, from back to front; O(samples · log samples).
///
/// One depth per face would be wrong for long faces next to short faces. Instead, faces are
/// compared at each common pixel: the farther face must come first. The algorithm of Kahn (1962)
/// finds an order for these rules. If several faces can come next, the farthest face comes next. If
/// intersecting faces make a valid order impossible, the farthest remaining face comes next.
pub(crate) fn back_to_front(mesh: &PolygonMesh, panel: &Panel, visible: &[bool]) -> Vec<FaceId> {
    let mut layers: Vec<Layer> = Vec::new();
    let mut rasteriser = Rasteriser::new(panel.width, panel.height);
    // The faces by mean depth.
    let mut ranked: Vec<(f64, FaceId)> = Vec::new();
    for (f, face) in mesh.faces().iter().filter(|(f, _)| visible[f.index()]) {
        let depths = face.iter().map(|&v| panel.position(v).z);
        ranked.push((depths.sum::<f64>() / face.len() as f64, f));
    }
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut corners = Vec::new();
    for (rank, &(_, f)) in ranked.iter().enumerate() {
        if layers.len() > MAX_SAMPLES {
            break;
        }
        corners.clear();
        corners.extend(mesh.faces().face(f).iter().map(|&v| Corner {
            position: panel.position(v),
            normal: glam::DVec3::Z,
        }));
        rasteriser.rasterise(&corners, |span| {
            layers.extend(span.columns.clone().map(|column| Layer {
                pixel: row(span.row * panel.width + column),
                depth: span.depth(column) as f32,
                face: row(rank),
            }));
        });
    }
    layers.sort_by(|a, b| {
        let by_depth = || a.depth.total_cmp(&b.depth);
        a.pixel.cmp(&b.pixel).then_with(by_depth)
    });
    let rules = layers.windows(2).filter_map(|pair| {
        let [far, near] = [&pair[0], &pair[1]];
        let rule = far.pixel == near.pixel && near.depth - far.depth > MIN_DEPTH_DIFFERENCE;
        (rule && far.face != near.face).then_some((far.face, near.face))
    });
    let order = topological_order(ranked.len(), rules.collect());
    order.into_iter().map(|rank| ranked[rank].1).collect()
}

/// Orders the numbers below `count`. The first number of each rule comes before the second number.
/// If several numbers can come next, the lowest number comes next.
fn topological_order(count: usize, mut rules: Vec<(u32, u32)>) -> Vec<usize> {
    rules.sort_unstable();
    rules.dedup();
    let mut predecessors = vec![0_usize; count];
    for &(_, later) in &rules {
        predecessors[later as usize] += 1;
    }
    let mut ready: BinaryHeap<Reverse<usize>> = BinaryHeap::new();
    ready.extend((0..count).filter(|&n| predecessors[n] == 0).map(Reverse));
    let mut placed = vec![false; count];
    let mut order = Vec::with_capacity(count);
    let mut lowest = 0;
    while order.len() < count {
        let next = ready.pop().map(|Reverse(next)| next);
        let next = next.unwrap_or_else(|| {
            // All remaining numbers wait for each other.
            while placed[lowest] {
                lowest += 1;
            }
            lowest
        });
        placed[next] = true;
        order.push(next);
        let start = rules.partition_point(|&(first, _)| (first as usize) < next);
        let of_next = rules[start..].iter();
        for &(_, later) in of_next.take_while(|&&(first, _)| first as usize == next) {
            let later = later as usize;
            predecessors[later] = predecessors[later].saturating_sub(1);
            if predecessors[later] == 0 && !placed[later] {
                ready.push(Reverse(later));
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_followed_and_cycles_are_broken() {
        assert_eq!(topological_order(3, vec![]), [0, 1, 2]);
        assert_eq!(topological_order(4, vec![(3, 0), (0, 1)]), [2, 3, 0, 1]);
        assert_eq!(
            topological_order(3, vec![(2, 1), (2, 1), (1, 0)]),
            [2, 1, 0]
        );
        // Numbers 1 and 2 wait for each other, and number 0 waits for number 2.
        assert_eq!(
            topological_order(3, vec![(1, 2), (2, 1), (2, 0)]),
            [0, 1, 2]
        );
    }
}
