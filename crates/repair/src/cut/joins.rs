//! Joining sides one pair after the other, as long as no two edges get the same two ends.

use std::collections::VecDeque;

use rustc_hash::FxHashMap;
use sixfold_core::{Partition, RowId, Slot};

use super::angles::{Angles, Preference, opposite_order, preferences};
use super::{Mates, Sides};
use crate::trace::CornerId;

/// An edge with at most this many possible pairs tries all of them. At other edges, sides are paired
/// by their order around the edge.
const MAX_PAIRS: usize = 1024;

/// The fans so far, as classes of corners; a class has the number of its root.
type Fan = u32;

/// The joined sides and the fans that follow from them.
///
/// A fan is a path of corners. It begins with a side that leaves the vertex and is not joined, and
/// ends with a side that arrives there and is not joined; or it is a cycle.
pub(super) struct Joins<'a> {
    sides: &'a Sides,
    mates: Mates,
    fans: Partition,
    /// By root: the open side that leaves, and the open side that arrives; of no meaning for cycles.
    open: Vec<[CornerId; 2]>,
    /// By root: the sides of crowded edges that start or end in the fan.
    watched: FxHashMap<Fan, Vec<CornerId>>,
    /// The fans at the two ends of every watched side. No two have the same.
    names: FxHashMap<[Fan; 2], CornerId>,
    /// Pairs that close a fan.
    closing: VecDeque<[CornerId; 2]>,
}

impl<'a> Joins<'a> {
    /// Joins the sides of all edges with one side in each direction.
    pub(super) fn new(sides: &'a Sides) -> Self {
        let corners = sides.next.len();
        let mut open = vec![[CornerId::new(0); 2]; corners];
        for (corner, next) in (0..).map(CornerId::new).zip(&sides.next) {
            open[corner.index()][0] = corner;
            open[next.index()][1] = corner;
        }
        let mut joins = Self {
            sides,
            mates: vec![Slot::NONE; corners],
            fans: Partition::new(corners),
            open,
            watched: FxHashMap::default(),
            names: FxHashMap::default(),
            closing: VecDeque::new(),
        };
        for [side, other] in sides.simple() {
            joins.join_fans(side, other);
            joins.set_mates(side, other);
        }
        joins.watch_crowded();
        joins
    }

    pub(super) fn into_mates(self) -> Mates {
        self.mates
    }

    /// Joins sides of crowded edges: always the pairs that close a fan first, then the preferred
    /// ones.
    pub(super) fn join_all(&mut self, angles: &Angles<'_>) {
        let mut pairs: Vec<(Preference, [CornerId; 2])> = Vec::new();
        let mut bundles = Vec::new();
        for &edge in self.sides.crowded() {
            let [up, down] = self.sides.up_and_down(edge);
            let around = angles.around(edge);
            if up.len().saturating_mul(down.len()) > MAX_PAIRS {
                bundles.push(opposite_order([up, down], &around));
                continue;
            }
            let preferred = preferences(&around).into_iter();
            pairs.extend(preferred.map(|(preference, [i, j])| (preference, [up[i], down[j]])));
        }
        self.join_closing();
        pairs.sort_unstable_by_key(|&(preference, pair)| (preference, pair.map(RowId::row)));
        for (_, pair) in pairs {
            if self.try_join(pair) {
                self.join_closing();
            }
        }
        for [up, down] in bundles {
            self.join_bundle(&up, &down);
        }
    }

    /// Joins open sides at equal places of two lists.
    fn join_bundle(&mut self, up: &[CornerId], down: &[CornerId]) {
        let is_open = |side: &&CornerId| self.mates[side.index()].get().is_none();
        let up: Vec<CornerId> = up.iter().filter(is_open).copied().collect();
        let down: Vec<CornerId> = down.iter().filter(is_open).copied().collect();
        for (&side, &other) in up.iter().zip(&down) {
            if self.try_join([side, other]) {
                self.join_closing();
            }
        }
    }

    /// Joins all pairs that close a fan, including pairs that result from these joins.
    fn join_closing(&mut self) {
        while let Some(pair) = self.closing.pop_front() {
            self.try_join(pair);
        }
    }

    /// Joins two sides if both are open and no two edges get the same ends; returns whether they
    /// were joined.
    fn try_join(&mut self, [side, other]: [CornerId; 2]) -> bool {
        let is_open = |side: CornerId| self.mates[side.index()].get().is_none();
        if !is_open(side) || !is_open(other) {
            return false;
        }
        let ends = self.sides.joined_corners(side, other);
        let merges = ends.map(|pair| self.merge_of(pair));
        if !self.stay_distinct(merges) {
            return false;
        }
        let lists = merges.map(|merge| {
            let list = merge.and_then(|merge| self.watched.remove(&merge.loser));
            list.unwrap_or_default()
        });
        for &watched in lists.iter().flatten() {
            let name = self.name(watched);
            self.names.remove(&name);
        }
        self.join_fans(side, other);
        self.set_mates(side, other);
        for &watched in lists.iter().flatten() {
            let name = self.name(watched);
            self.names.insert(name, watched);
        }
        for (merge, list) in merges.into_iter().zip(lists) {
            if let Some(Merge { winner, .. }) = merge {
                self.watched.entry(winner).or_default().extend(list);
                self.add_closing(winner);
            }
        }
        true
    }

    /// Merges the fans at both ends of two sides.
    fn join_fans(&mut self, side: CornerId, other: CornerId) {
        for pair in self.sides.joined_corners(side, other) {
            // A path that is joined with itself becomes a cycle.
            if let Some(Merge { winner, .. }) = self.merge_of(pair) {
                let [left, reached] = pair.map(|corner| self.fan(corner) as usize);
                let open = [self.open[reached][0], self.open[left][1]];
                self.fans.join(pair[0].index(), pair[1].index());
                self.open[winner as usize] = open;
            }
        }
    }

    fn set_mates(&mut self, side: CornerId, other: CornerId) {
        self.mates[side.index()] = Slot::some(other);
        self.mates[other.index()] = Slot::some(side);
    }

    /// Starts to watch the sides of crowded edges. Until now, only edges with one side in each
    /// direction are joined, so at most one side that leaves a fan is open, and no two sides of an
    /// edge start in one fan.
    fn watch_crowded(&mut self) {
        for &edge in self.sides.crowded() {
            for &side in self.sides.up_and_down(edge).into_iter().flatten() {
                let name = self.name(side);
                self.names.insert(name, side);
                for fan in name {
                    self.watched.entry(fan).or_default().push(side);
                }
                self.add_closing(name[0]);
            }
        }
    }

    /// Remembers the two open sides of a fan if they are sides of one edge.
    fn add_closing(&mut self, fan: Fan) {
        let [leaving, arriving] = self.open[fan as usize];
        let end = self.sides.next[leaving.index()];
        if self.sides.vertex[end.index()] == self.sides.vertex[arriving.index()] {
            self.closing.push_back([leaving, arriving]);
        }
    }

    /// Returns whether every watched side keeps a name of its own if these fans are merged.
    fn stay_distinct(&mut self, merges: [Option<Merge>; 2]) -> bool {
        let before = |fan: Fan| {
            let merge = merges.into_iter().flatten().find(|merge| merge.names(fan));
            merge.map_or([fan; 2], |merge| [merge.winner, merge.loser])
        };
        for merge in merges.into_iter().flatten() {
            // Of two sides that would get the same name, one is watched at the loser of a merge.
            let moved = self.watched.get(&merge.loser).cloned().unwrap_or_default();
            for side in moved {
                let [starts, ends] = self.name(side).map(before);
                let taken = |start, end| {
                    let other = self.names.get(&[start, end]);
                    other.is_some_and(|&other| other != side)
                };
                if starts
                    .iter()
                    .any(|&start| ends.iter().any(|&end| taken(start, end)))
                {
                    return false;
                }
            }
        }
        true
    }

    /// Returns the fan of a corner.
    fn fan(&mut self, corner: CornerId) -> Fan {
        self.fans.root(corner.index()).0 as Fan
    }

    /// Returns the fans in which a side starts and ends.
    fn name(&mut self, side: CornerId) -> [Fan; 2] {
        [side, self.sides.next[side.index()]].map(|corner| self.fan(corner))
    }

    /// Returns which of the fans of two corners keeps its number if they are merged; `None` if they
    /// are one fan.
    fn merge_of(&mut self, pair: [CornerId; 2]) -> Option<Merge> {
        let [a, b] = pair.map(|corner| self.fan(corner));
        let [size_a, size_b] = [a, b].map(|fan| self.fans.class_size(fan as usize));
        let (winner, loser) = if size_a < size_b { (b, a) } else { (a, b) };
        (a != b).then_some(Merge { winner, loser })
    }
}

/// Two fans that become one, with the number of the winner.
#[derive(Clone, Copy, Debug)]
struct Merge {
    winner: Fan,
    loser: Fan,
}

impl Merge {
    fn names(self, fan: Fan) -> bool {
        fan == self.winner || fan == self.loser
    }
}
