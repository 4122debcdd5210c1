//! The invariants of trees, for each rule.

use glam::Vec3;
use proptest::prelude::*;

use super::node::LEAF_ITEMS;
use super::*;
use crate::bounds::Bounds;
use crate::item::FaceTriangle;

type Triangle = FaceTriangle<u32>;

/// Triangles with few different coordinates: many have the same box, or no extent.
fn triangles() -> impl Strategy<Value = Vec<Triangle>> {
    let coordinate = prop_oneof![
        Just(0.0_f32),
        (0..4_u8).prop_map(f32::from),
        -1.0_f32..1.0,
        Just(1e30),
        Just(1e-40),
    ];
    let corner = proptest::array::uniform3(coordinate).prop_map(Vec3::from);
    let corners = prop::collection::vec(proptest::array::uniform3(corner), 0..150);
    corners.prop_map(|list| {
        let faces = (0..).zip(list);
        faces
            .map(|(face, corners)| FaceTriangle { face, corners })
            .collect()
    })
}

/// Checks T1 to T3 below `child`, and returns its slots.
fn check<R: SplitRule, const W: usize>(
    tree: &Tree<Triangle, R, W>,
    child: Child,
    seen: &mut [bool],
) -> Vec<usize> {
    if let Some(slots) = child.slots() {
        assert!(slots.len() <= LEAF_ITEMS, "T3");
        for slot in slots.clone() {
            let was_seen = std::mem::replace(&mut seen[slot], true);
            assert!(!was_seen, "T1: slot {slot} is in two leaves");
        }
        return slots.collect();
    }
    let node = &tree.nodes[child.node()];
    let is_root = child == Child::ROOT;
    assert!(
        node.children() >= 2 || is_root && tree.items.len() <= LEAF_ITEMS,
        "T3"
    );
    let mut all = Vec::new();
    for lane in 0..node.children() {
        let below = check(tree, node.child(lane), seen);
        let items = below.iter().map(|&slot| &tree.items[slot]);
        let bounds = items.fold(Bounds::EMPTY, |bounds, item| {
            bounds.union(match node.axes() {
                None => item.bounds(),
                Some(axes) => item.bounds_along(&tree.axes[axes]),
            })
        });
        assert_eq!(bounds, node.bounds(lane), "T2");
        all.extend(below);
    }
    all
}

fn check_tree<R: SplitRule, const W: usize>(items: &[Triangle]) {
    let tree = Tree::<Triangle, R, W>::build(items.to_vec()).expect("finite");
    let mut seen = vec![false; items.len()];
    if !items.is_empty() {
        check(&tree, Child::ROOT, &mut seen);
    }
    assert!(seen.into_iter().all(|seen| seen), "T1");
    let mut faces: Vec<u32> = tree.items.iter().map(|item| item.face).collect();
    faces.sort_unstable();
    assert!(
        faces.into_iter().eq(0..items.len() as u32),
        "the items are those that were passed"
    );
}

proptest! {
    #[test]
    fn trees_keep_their_invariants(items in triangles()) {
        check_tree::<SplitByOctants, 8>(&items);
        check_tree::<SplitByMedian, 4>(&items);
        check_tree::<SplitByArea, 4>(&items);
        check_tree::<SplitByArea, 8>(&items);
        check_tree::<SplitByMedian, 2>(&items);
    }
}

/// Returns a bundle of `n` parallel needles, whose boxes all overlap.
fn needles(n: u32) -> Vec<Triangle> {
    let at = |face: u32| Vec3::new((face % 32) as f32, (face / 32) as f32, 0.0);
    let corners = |face| {
        let at = at(face);
        [at, at + Vec3::new(100.0, 90.0, 80.0), at + Vec3::X * 0.1]
    };
    let needle = |face| FaceTriangle {
        face,
        corners: corners(face),
    };
    (0..n).map(needle).collect()
}

#[test]
fn needles_are_boxed_along_their_length() {
    let items = needles(1024);
    check_tree::<SplitByArea, 4>(&items);
    let tree = Bvh::build(items).expect("finite");
    assert!(!tree.axes.is_empty());
    // A search in the middle of the bundle visits few of them.
    let query = DVec3::new(66.0, 60.0, 40.0);
    let mut visited = 0;
    tree.visit_near(query, 0.01, |_| {
        visited += 1;
        0.01
    });
    assert!((1..100).contains(&visited), "{visited}");
    // Other rules, and surfaces, need no axes.
    assert!(
        KdTree::build(needles(1024))
            .expect("finite")
            .axes
            .is_empty()
    );
    let sphere = sixfold_shapes::geodesic(16).expect("a small sphere");
    let sphere = crate::polygon_triangles(&sphere).expect("finite");
    assert!(Bvh::build(sphere).expect("finite").axes.is_empty());
}

/// Each item is half as far from the origin as the one before.
#[test]
fn a_series_that_halves_has_a_tree_of_bounded_depth() {
    fn depth<R: SplitRule, const W: usize>(tree: &Tree<Triangle, R, W>, child: Child) -> usize {
        if child.slots().is_some() {
            return 0;
        }
        let node = &tree.nodes[child.node()];
        let below = (0..node.children()).map(|lane| depth(tree, node.child(lane)));
        1 + below.max().unwrap_or(0)
    }
    let at = |face: u32| Vec3::splat(1e38 * 0.5_f32.powi(face as i32));
    let items: Vec<Triangle> = (0..250)
        .map(|face| FaceTriangle {
            face,
            corners: [at(face); 3],
        })
        .collect();
    let octree = Octree::build(items.clone()).expect("finite");
    assert!(depth(&octree, Child::ROOT) <= 250);
    let median = KdTree::build(items.clone()).expect("finite");
    assert_eq!(depth(&median, Child::ROOT), 3);
    check_tree::<SplitByOctants, 8>(&items);
    check_tree::<SplitByArea, 4>(&items);
}
