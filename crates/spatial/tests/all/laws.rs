//! All indices give the answers of a search without an index, on any input.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use sixfold_spatial::{
    Bvh, FaceTriangle, ItemList, KdTree, Neighbour, Octree, PointQueries, Ray, RayHit, SearchHint,
    SpatialIndex, SurfacePoint, SurfaceQueries, UniformGrid, VertexPoint,
};

/// Where coordinates come from; one for each axis of a mesh, so that meshes are also flat.
#[derive(Clone, Copy, Debug)]
enum Spread {
    Constant,
    Integers,
    Even,
    Far,
    Huge,
    Tiny,
    AllScales,
}

fn spread() -> impl Strategy<Value = Spread> {
    prop_oneof![
        1 => Just(Spread::Constant),
        3 => Just(Spread::Integers),
        4 => Just(Spread::Even),
        1 => Just(Spread::Far),
        1 => Just(Spread::Huge),
        1 => Just(Spread::Tiny),
        1 => Just(Spread::AllScales),
    ]
}

impl Spread {
    /// Maps a random number to a coordinate.
    fn coordinate(self, random: u32) -> f32 {
        let unit = random as f32 / u32::MAX as f32 - 0.5;
        match self {
            Self::Constant => 0.75,
            Self::Integers => (random % 4) as f32,
            Self::Even => unit,
            Self::Far => 4096.0 + unit,
            Self::Huge => unit * 2.0 * f32::MAX,
            Self::Tiny => unit * 1e-38,
            Self::AllScales => unit.signum() * 2_f32.powi((random % 250) as i32 - 125),
        }
    }
}

/// Places, with the same three spreads for all of them.
#[derive(Clone, Debug)]
struct Input {
    places: Vec<Vec3>,
    queries: Vec<DVec3>,
}

fn input(most: usize) -> impl Strategy<Value = Input> {
    let numbers = |most: usize| prop::collection::vec(any::<[u32; 3]>(), 0..most);
    let queries = prop::collection::vec((any::<[u32; 3]>(), 0..4_u8, spread()), 1..12);
    let spreads = prop::array::uniform3(spread());
    (spreads, numbers(most), queries, prop::bool::weighted(0.3)).prop_map(
        |(spreads, places, queries, has_needles)| {
            let place = |numbers: [u32; 3]| {
                Vec3::from([0, 1, 2].map(|axis| spreads[axis].coordinate(numbers[axis])))
            };
            let mut places: Vec<Vec3> = places.into_iter().map(place).collect();
            if has_needles {
                // Each second place is near one point, so triangles are long, and their boxes overlap.
                let near = places.iter_mut().step_by(2);
                near.for_each(|place| *place *= 1e-3);
            }
            let query = |(numbers, kind, other): ([u32; 3], u8, Spread)| {
                let near = place(numbers).as_dvec3();
                match kind {
                    0 => near,
                    1 if !places.is_empty() => {
                        places[numbers[0] as usize % places.len()].as_dvec3()
                    }
                    // Not a single-precision number.
                    2 => near * 0.9 + DVec3::splat(1e-9),
                    _ => Vec3::from(numbers.map(|number| other.coordinate(number))).as_dvec3(),
                }
            };
            let queries = queries.into_iter().map(query).collect();
            Input { places, queries }
        },
    )
}

fn points(input: &Input) -> Vec<VertexPoint<u32>> {
    // Names that do not ascend with the items.
    let names = (0..input.places.len() as u32).map(|i| i ^ 5);
    let named = names.zip(&input.places);
    named
        .map(|(vertex, &position)| VertexPoint { vertex, position })
        .collect()
}

/// Triangles of neighbouring places: some share corners, some have no area, two share a face.
fn triangles(input: &Input) -> Vec<FaceTriangle<u32>> {
    let corners = input.places.windows(3).enumerate();
    corners
        .map(|(i, corners)| FaceTriangle {
            face: (i as u32 / 2) ^ 3,
            corners: [corners[0], corners[1], corners[2]],
        })
        .collect()
}

fn radii(input: &Input, query: DVec3) -> [f64; 4] {
    let first = input
        .places
        .first()
        .map_or(1.0, |p| p.as_dvec3().distance(query));
    [0.0, first, 0.5 * first, f64::INFINITY]
}

/// The answers about vertices, sorted where the order depends on the index.
fn point_answers<T: SpatialIndex<VertexPoint<u32>>>(input: &Input) -> Vec<Vec<Neighbour<u32>>> {
    let index = T::build(points(input)).expect("finite");
    let mut answers = Vec::new();
    let mut buffer = Vec::new();
    for &query in &input.queries {
        answers.push(index.nearest(query).into_iter().collect());
        answers.push(
            index
                .nearest_where(query, f64::INFINITY, |v| v % 3 == 0)
                .into_iter()
                .collect(),
        );
        for radius in radii(input, query) {
            let mut within = Vec::new();
            index.for_each_within(query, radius, |found| within.push(found));
            within.sort_unstable();
            answers.push(within);
        }
        for k in [0, 1, 5, usize::MAX] {
            index.nearest_k_into(query, k, &mut buffer);
            answers.push(buffer.clone());
        }
    }
    let each = index.nearest_of_each(&input.queries);
    answers.extend(each.into_iter().map(|found| found.into_iter().collect()));
    answers
}

/// The answers by sorting all vertices, without the crate.
fn expected_points(input: &Input) -> Vec<Vec<Neighbour<u32>>> {
    let mut answers = Vec::new();
    let sorted = |query: DVec3| {
        let mut all: Vec<(f64, u32)> = points(input)
            .iter()
            .map(|p| ((p.position.as_dvec3() - query).length_squared(), p.vertex))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let neighbour = |(distance_squared, vertex)| Neighbour {
            vertex,
            distance_squared,
        };
        all.into_iter().map(neighbour).collect::<Vec<_>>()
    };
    for &query in &input.queries {
        let all = sorted(query);
        answers.push(all.iter().take(1).copied().collect());
        answers.push(
            all.iter()
                .filter(|n| n.vertex % 3 == 0)
                .take(1)
                .copied()
                .collect(),
        );
        for radius in radii(input, query) {
            let within = all.iter().filter(|n| n.distance_squared <= radius * radius);
            answers.push(within.copied().collect());
        }
        for k in [0, 1, 5, usize::MAX] {
            answers.push(all.iter().take(k).copied().collect());
        }
    }
    answers.extend(
        input
            .queries
            .iter()
            .map(|&q| sorted(q).into_iter().take(1).collect()),
    );
    answers
}

/// The answers about surfaces.
#[derive(Debug, PartialEq)]
struct SurfaceAnswers {
    closest: Vec<Option<SurfacePoint<u32>>>,
    hits: Vec<Vec<RayHit<u32>>>,
}

fn surface_answers<T: SpatialIndex<FaceTriangle<u32>>>(input: &Input) -> SurfaceAnswers {
    let index = T::build(triangles(input)).expect("finite");
    let (mut closest, mut hits) = (Vec::new(), Vec::new());
    let mut hint = SearchHint::default();
    for (&query, &target) in input.queries.iter().zip(input.queries.iter().rev()) {
        let free = index.closest_point(query);
        assert_eq!(
            index.closest_point_from(query, &mut hint),
            free,
            "a hint changes the answer"
        );
        let squared = free.map(|closest| closest.distance_squared);
        assert_eq!(index.distance_squared_from(query, &mut hint), squared);
        closest.push(free);
        closest.push(index.closest_point_facing(query, target, 0.25, &mut hint));
        for radius in radii(input, query) {
            let odd = |t: &FaceTriangle<u32>| t.face % 2 == 1;
            closest.push(index.closest_point_where(query, radius, &mut hint, odd));
            let is_within = free.is_some_and(|closest| closest.distance() <= radius);
            assert_eq!(index.is_within(query, radius), is_within, "{radius}");
        }
        let Ok(ray) = Ray::new(query, target - query) else {
            continue;
        };
        for limit in [0.0, 0.5, 1.0, f64::INFINITY] {
            hits.push(index.first_hit(&ray, limit).into_iter().collect());
            let mut all = Vec::new();
            index.for_each_hit(&ray, limit, |hit| all.push(hit));
            all.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
            hits.push(all);
        }
        hits.push(
            index.first_hit_of_each(&[ray, ray])[1]
                .into_iter()
                .collect(),
        );
    }
    closest.extend(index.closest_point_of_each(&input.queries));
    SurfaceAnswers { closest, hits }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn vertices_are_those_of_a_sorted_list(input in input(120)) {
        let expected = expected_points(&input);
        prop_assert_eq!(point_answers::<ItemList<_>>(&input), expected.clone(), "list");
        prop_assert_eq!(point_answers::<UniformGrid<_>>(&input), expected.clone(), "grid");
        prop_assert_eq!(point_answers::<Octree<_>>(&input), expected.clone(), "octree");
        prop_assert_eq!(point_answers::<KdTree<_>>(&input), expected.clone(), "kd-tree");
        prop_assert_eq!(point_answers::<Bvh<_>>(&input), expected, "hierarchy");
    }

    #[test]
    fn surface_points_and_hits_are_those_of_all_triangles(input in input(120)) {
        let expected = surface_answers::<ItemList<_>>(&input);
        prop_assert_eq!(&surface_answers::<UniformGrid<_>>(&input), &expected, "grid");
        prop_assert_eq!(&surface_answers::<Octree<_>>(&input), &expected, "octree");
        prop_assert_eq!(&surface_answers::<KdTree<_>>(&input), &expected, "kd-tree");
        prop_assert_eq!(&surface_answers::<Bvh<_>>(&input), &expected, "hierarchy");
    }
}

/// A closed surface: each ray from the inside hits it, also through corners and edges.
#[test]
fn no_ray_slips_out_of_a_closed_surface() {
    fn check<T: SpatialIndex<FaceTriangle<sixfold_core::FaceId>>>() {
        let ball = sixfold_shapes::geodesic(5).expect("a small frequency");
        let surface =
            T::build(sixfold_spatial::polygon_triangles(&ball).expect("finite")).expect("finite");
        let inside = DVec3::new(0.01, 0.02, -0.03);
        let corners: Vec<DVec3> = ball.positions().iter().map(|p| p.as_dvec3()).collect();
        let edges = ball.edge_uses();
        let middles = edges.iter().map(|edge| {
            let [a, b] = edge.ends.map(|v| ball.position(v).as_dvec3());
            (a + b) * 0.5
        });
        for target in corners.iter().copied().chain(middles) {
            let ray = Ray::new(inside, target - inside).expect("a direction");
            let hit = surface
                .first_hit(&ray, f64::INFINITY)
                .expect("a closed surface");
            assert!(
                (hit.t - 1.0).abs() < 1e-12,
                "{} at {target}: {}",
                T::NAME,
                hit.t
            );
        }
    }
    check::<ItemList<_>>();
    check::<UniformGrid<_>>();
    check::<Octree<_>>();
    check::<KdTree<_>>();
    check::<Bvh<_>>();
}

#[test]
fn items_and_queries_that_are_not_finite_find_nothing() {
    fn check<T: SpatialIndex<VertexPoint<u32>>>() {
        let point = |vertex, x| VertexPoint {
            vertex,
            position: Vec3::new(x, 0.0, 0.0),
        };
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let error = T::build(vec![point(0, 1.0), point(1, bad)])
                .err()
                .expect("refused");
            assert_eq!(
                error,
                sixfold_spatial::SpatialError::ItemNotFinite { item: 1 }
            );
        }
        let index = T::build(vec![point(0, 1.0)]).expect("finite");
        for bad in [f64::NAN, f64::INFINITY, 1e39] {
            assert_eq!(index.nearest([0.0, bad, 0.0]), None, "{}", T::NAME);
        }
        let mut count = 0;
        index.for_each_within(DVec3::ZERO, f64::NAN, |_| count += 1);
        index.for_each_within(DVec3::ZERO, -1.0, |_| count += 1);
        assert_eq!(count, 0);
        let empty = T::build(Vec::new()).expect("nothing to refuse");
        assert_eq!(empty.nearest(DVec3::ZERO), None);
        let ray = Ray::new([0.0; 3], [1.0, 0.0, 0.0]).expect("a ray");
        empty.visit_along(&ray, f64::INFINITY, |_| unreachable!("there are no items"));
    }
    check::<ItemList<_>>();
    check::<UniformGrid<_>>();
    check::<Octree<_>>();
    check::<KdTree<_>>();
    check::<Bvh<_>>();
}
