//! A complete search for more joined sides, in small groups of crowded edges.

use rustc_hash::FxHashMap;
use sixfold_core::{Partition, Slot};

use super::{Mates, Sides, TwoWay};
use crate::trace::CornerId;

/// The largest number of corners of a group that is searched.
const MAX_CORNERS: usize = 96;

/// The largest number of pairs that are tried in one group.
const GROUP_ATTEMPTS: usize = 50_000;

/// The largest number of pairs that are tried in all groups of a mesh.
const ALL_ATTEMPTS: usize = 5_000_000;

/// Replaces the mates in each group of crowded edges in which more sides can be joined.
///
/// A group contains the crowded edges that are connected by common ends, or by other edges between
/// their ends. Joining sides in one group does not change the fans that matter in another one. A
/// group whose mates are as many as possible without the condition on names is not searched; nor is
/// a group that is too large.
pub(super) fn improve(sides: &Sides, mates: &mut Mates) {
    let mut attempts = ALL_ATTEMPTS;
    for group in groups(sides) {
        let lost: usize = group
            .iter()
            .map(|&edge| most_pairs(sides, edge) - joined_pairs(sides, edge, mates))
            .sum();
        if lost == 0 {
            continue;
        }
        let limit = attempts.min(GROUP_ATTEMPTS);
        let Some(mut search) = Search::new(sides, &group, mates, limit) else {
            continue;
        };
        let found = (0..lost).find_map(|allowed| search.run(allowed));
        attempts -= limit - search.attempts_left;
        if let Some(pairs) = found {
            let all = group.iter().flat_map(|&edge| sides.up_and_down(edge));
            for side in all.flatten() {
                mates[side.index()] = Slot::NONE;
            }
            for [side, other] in pairs {
                mates[side.index()] = Slot::some(other);
                mates[other.index()] = Slot::some(side);
            }
        }
    }
}

/// Returns the number of pairs that an edge has at most.
fn most_pairs(sides: &Sides, edge: TwoWay) -> usize {
    let [up, down] = sides.up_and_down(edge);
    up.len().min(down.len())
}

fn joined_pairs(sides: &Sides, edge: TwoWay, mates: &Mates) -> usize {
    let [up, _] = sides.up_and_down(edge);
    let joined = up.iter().filter(|side| mates[side.index()].get().is_some());
    joined.count()
}

/// Returns the edges of each group: the crowded edges, and all other edges with sides in both
/// directions at their ends, first.
fn groups(sides: &Sides) -> Vec<Vec<TwoWay>> {
    let mut numbers = FxHashMap::default();
    for &edge in sides.crowded() {
        for v in sides.ends(edge) {
            let next = numbers.len();
            numbers.entry(v).or_insert(next);
        }
    }
    if numbers.is_empty() {
        return Vec::new();
    }
    let mut classes = Partition::new(numbers.len());
    for &edge in &sides.two_way {
        if let [Some(&a), Some(&b)] = sides.ends(edge).map(|v| numbers.get(&v)) {
            classes.join(a, b);
        }
    }
    let mut group_of = FxHashMap::default();
    let mut groups: Vec<Vec<TwoWay>> = Vec::new();
    for &edge in &sides.two_way {
        let ends = sides.ends(edge);
        if let Some(&at) = ends.iter().find_map(|v| numbers.get(v)) {
            let (class, _) = classes.root(at);
            let group = *group_of.entry(class).or_insert(groups.len());
            if group == groups.len() {
                groups.push(Vec::new());
            }
            groups[group].push(edge);
        }
    }
    groups
}

/// The search in one group.
struct Search<'a> {
    sides: &'a Sides,
    edges: &'a [TwoWay],
    /// The corners at the ends of crowded edges, numbered from 0.
    local: FxHashMap<CornerId, u8>,
    /// The sides of crowded edges, as the local corners where they start and end.
    watched: Vec<[u8; 2]>,
    /// The mates before the search.
    hints: &'a Mates,
    attempts_left: usize,
    pairs: Vec<[CornerId; 2]>,
}

/// By local corner: the number of its fan.
type Fans = [u8; MAX_CORNERS];

impl<'a> Search<'a> {
    /// Prepares the search; `None` if the group is too large.
    fn new(
        sides: &'a Sides,
        edges: &'a [TwoWay],
        hints: &'a Mates,
        attempts: usize,
    ) -> Option<Self> {
        let mut search = Self {
            sides,
            edges,
            local: FxHashMap::default(),
            watched: Vec::new(),
            hints,
            attempts_left: attempts,
            pairs: Vec::new(),
        };
        for &edge in edges {
            let all = sides.up_and_down(edge);
            if all[0].len() + all[1].len() > MAX_CORNERS {
                return None;
            }
            for &side in all.into_iter().flatten() {
                let ends = [side, sides.next[side.index()]].map(|corner| {
                    let next = search.local.len();
                    *search.local.entry(corner).or_insert(next.min(255) as u8)
                });
                if search.local.len() > MAX_CORNERS {
                    return None;
                }
                if all[0].len() + all[1].len() > 2 {
                    search.watched.push(ends);
                }
            }
        }
        Some(search)
    }

    /// Searches for a set of joined pairs that has `allowed` pairs fewer than the largest possible
    /// number. Returns `None` if no such set exists, or if the attempts are used up.
    fn run(&mut self, allowed: usize) -> Option<Vec<[CornerId; 2]>> {
        self.pairs.clear();
        let mut fans = [0; MAX_CORNERS];
        for (fan, i) in fans.iter_mut().zip(0..) {
            *fan = i;
        }
        let found = self.edge(0, &fans, allowed);
        found.then(|| self.pairs.clone())
    }

    /// Joins sides of the edges from number `at` on; at most `allowed` pairs may be missing.
    fn edge(&mut self, at: usize, fans: &Fans, allowed: usize) -> bool {
        let Some(&edge) = self.edges.get(at) else {
            return true;
        };
        let sides = self.sides.up_and_down(edge);
        let [up, down] = sides.map(<[_]>::len);
        let state = EdgeState {
            at,
            sides,
            // As many sides remain open in any case.
            skips: up - up.min(down) + allowed,
            used: vec![false; down],
        };
        self.side(state, 0, fans)
    }

    /// Joins the sides of an edge that run up, from number `i` on, and then the further edges.
    fn side(&mut self, mut state: EdgeState<'a>, i: usize, fans: &Fans) -> bool {
        let [up, down] = state.sides;
        let Some(&side) = up.get(i) else {
            return self.edge(state.at + 1, fans, state.skips);
        };
        // The mate so far comes first.
        let hint = down
            .iter()
            .position(|&other| Some(other) == self.hints[side.index()].get());
        let others = (0..down.len()).filter(|&j| Some(j) != hint);
        for j in hint
            .into_iter()
            .chain(others)
            .filter(|&j| !state.used[j])
            .collect::<Vec<_>>()
        {
            if self.attempts_left == 0 {
                return false;
            }
            self.attempts_left -= 1;
            if let Some(merged) = self.joined(fans, side, down[j]) {
                state.used[j] = true;
                self.pairs.push([side, down[j]]);
                if self.side(state.clone(), i + 1, &merged) {
                    return true;
                }
                self.pairs.pop();
                state.used[j] = false;
            }
        }
        if state.skips == 0 {
            return false;
        }
        state.skips -= 1;
        self.side(state, i + 1, fans)
    }

    /// Returns the fans after two sides are joined; `None` if two watched sides would start in one
    /// fan and end in one fan.
    fn joined(&self, fans: &Fans, side: CornerId, other: CornerId) -> Option<Fans> {
        let mut merged = *fans;
        for pair in self.sides.joined_corners(side, other) {
            let [to, from] = pair.map(|corner| merged[usize::from(self.local[&corner])]);
            for fan in &mut merged {
                if *fan == from {
                    *fan = to;
                }
            }
        }
        let mut ends_of = [0_u128; MAX_CORNERS];
        for name in &self.watched {
            let [start, end] = name.map(|corner| merged[usize::from(corner)]);
            let bit = 1 << end;
            if ends_of[usize::from(start)] & bit != 0 {
                return None;
            }
            ends_of[usize::from(start)] |= bit;
        }
        Some(merged)
    }
}

/// An edge whose sides are being joined.
#[derive(Clone)]
struct EdgeState<'a> {
    /// The number of the edge.
    at: usize,
    /// Its sides that run up, and those that run down.
    sides: [&'a [CornerId]; 2],
    /// How many further sides that run up may remain open.
    skips: usize,
    /// By side that runs down: whether it is joined.
    used: Vec<bool>,
}
