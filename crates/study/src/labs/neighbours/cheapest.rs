//! Which index costs the least time for a number of queries, building included.

use sixfold_results::Cheapest;
/// The time to build an index and the time of one query, in nanoseconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cost<'n> {
    pub(crate) index: &'n str,
    pub(crate) build_ns: f64,
    pub(crate) query_ns: f64,
    /// Whether the query is the fastest, or has no clear difference to the fastest.
    pub(crate) is_fastest: bool,
}

/// Returns the cheapest index for each number of queries, as ranges in ascending order. The time
/// for n queries is the building time plus n times the time of a query, so the result is the lower
/// envelope of straight lines. Of two equal times, the earlier entry of `costs` counts as the
/// smaller.
///
/// A range ends only for an index with clearly faster queries: their times differ by more than
/// `noise`, a ratio of at least 1, and not both are among the fastest. The total time of the index
/// of a range is at most `noise` times the least total time if only one index is fastest.
///
/// Takes O(k²) time for k indices.
pub(crate) fn cheapest(costs: &[Cost<'_>], noise: f64) -> Vec<Cheapest> {
    let mut ranges: Vec<Cheapest> = Vec::new();
    let mut from = 1_u64;
    let total = |cost: &Cost<'_>, queries: u64| cost.build_ns + queries as f64 * cost.query_ns;
    let at_start = costs
        .iter()
        .min_by(|a, b| total(a, from).total_cmp(&total(b, from)));
    let Some(mut now) = at_start else {
        return ranges;
    };
    loop {
        ranges.push(Cheapest {
            from,
            index: now.index.to_owned(),
        });
        // The next index is the one with faster queries whose line is crossed first.
        let faster = costs.iter().filter(|cost| {
            let equal = cost.is_fastest && now.is_fastest;
            !equal && cost.query_ns < now.query_ns / noise
        });
        let crossing = faster.map(|cost| {
            let saved = now.query_ns - cost.query_ns;
            let queries = (cost.build_ns - now.build_ns) / saved;
            // At `queries` the times are equal. The faster queries pay off from the next number on.
            (queries.floor().max(from as f64) as u64 + 1, cost)
        });
        let next = crossing.min_by(|&(a, one), &(b, other)| {
            let times = total(one, a).total_cmp(&total(other, b));
            a.cmp(&b).then(times)
        });
        match next {
            Some((queries, cost)) if queries < u64::MAX => (from, now) = (queries, cost),
            _ => return ranges,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LIST: Cost<'_> = Cost {
        index: "list",
        build_ns: 0.0,
        query_ns: 1000.0,
        is_fastest: false,
    };

    #[test]
    fn an_index_is_cheapest_after_its_building_time_is_saved() {
        let tree = Cost {
            index: "tree",
            build_ns: 9_000.0,
            query_ns: 100.0,
            is_fastest: false,
        };
        let slow = Cost {
            index: "slow to build",
            build_ns: 1e6,
            query_ns: 99.0,
            is_fastest: true,
        };
        let never = Cost {
            index: "never",
            build_ns: 20_000.0,
            query_ns: 500.0,
            is_fastest: false,
        };
        let found = |costs: &[Cost<'_>], noise| {
            let ranges = cheapest(costs, noise).into_iter();
            ranges
                .map(|range| (range.from, range.index))
                .collect::<Vec<_>>()
        };
        let costs = [LIST, tree, slow, never];
        let named = |ranges: &[(u64, &str)]| {
            let ranges = ranges.iter().map(|&(from, index)| (from, index.to_owned()));
            ranges.collect::<Vec<_>>()
        };
        // 10 queries take 10,000 ns with either: the earlier one is named.
        let expected = [(1, "list"), (11, "tree"), (991_001, "slow to build")];
        assert_eq!(found(&costs, 1.0), named(&expected));
        // Queries that differ by 1 % are equal, so building more never pays.
        assert_eq!(found(&costs, 1.02), named(&expected[..2]));
        let both_fastest = [
            LIST,
            Cost {
                is_fastest: true,
                ..tree
            },
            slow,
        ];
        assert_eq!(found(&both_fastest, 1.0), named(&expected[..2]));
        assert_eq!(found(&[], 1.0), []);
    }

    proptest! {
        #[test]
        fn no_other_index_is_cheaper(
            costs in prop::collection::vec((0_u32..100_000, 1_u32..1_000), 1..6),
            queries in 1_u64..100_000,
            noise in prop_oneof![Just(1.0), 1.0..1.5],
        ) {
            let names = ["a", "b", "c", "d", "e"];
            let costs: Vec<Cost<'_>> = costs
                .iter()
                .zip(names)
                .map(|(&(build, query), index)| Cost {
                    index,
                    build_ns: build.into(),
                    query_ns: query.into(),
                    is_fastest: false,
                })
                .collect();
            let total = |cost: &Cost<'_>| cost.build_ns + queries as f64 * cost.query_ns;
            let ranges = cheapest(&costs, noise);
            prop_assert!(ranges.windows(2).all(|pair| pair[0].from < pair[1].from));
            let named = ranges.iter().rfind(|range| range.from <= queries).unwrap();
            let named = costs.iter().find(|cost| cost.index == named.index).unwrap();
            let least = costs.iter().map(total).fold(f64::INFINITY, f64::min);
            prop_assert!(total(named) <= least * noise * (1.0 + 1e-12));
        }
    }
}
