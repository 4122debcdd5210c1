//! Cutting into an oriented manifold.
//!
//! A *side* has the number of the corner at which it starts. Two sides of one edge that run in
//! opposite directions can be joined; then their corners at each end belong to one fan. A side is
//! joined with at most one other, so a fan is always a path or a cycle of corners: a manifold. What
//! can go wrong is only the naming: two edges of one fan at one end and one fan at the other end
//! would have the same two vertices. At an edge with at most one side in each direction, this cannot
//! happen. The other edges are *crowded*, and each join there is checked ([`joins`]).

mod angles;
mod joins;
mod search;

use sixfold_core::{
    Capabilities, FaceId, FaceList, Incidence, Partition, PolygonMesh, Slot, VertexId, row,
};

use crate::error::RepairError;
use crate::outcome::{Outcome, StepCounts};
use crate::trace::{CornerId, Rebuild, VertexTrace};
use angles::Angles;
use joins::Joins;

/// Cuts the mesh; O(n log n) for n corners, plus the search, whose number of attempts is limited.
pub(crate) fn cut(polygons: &PolygonMesh) -> Result<Outcome, RepairError> {
    if Capabilities::ORIENTED_MANIFOLDS.check(polygons).is_ok() {
        return Ok(Outcome::unchanged());
    }
    let sides = Sides::new(polygons);
    let mut joins = Joins::new(&sides);
    joins.join_all(&Angles::new(polygons, &sides));
    let mut mates = joins.into_mates();
    search::improve(&sides, &mut mates);
    separate(polygons, &sides, &mates)
}

/// The partner of each side; empty if the side is left open.
type Mates = Vec<Slot<CornerId>>;

/// The sides of a mesh, by edge.
struct Sides {
    /// By side, which is a corner: the vertex where it starts.
    vertex: Vec<VertexId>,
    /// By side: the corner where it ends.
    next: Vec<CornerId>,
    /// The sides of edges that have sides in both directions. First the edges with one side in each
    /// direction.
    two_way: Vec<TwoWay>,
    /// The number of edges in `two_way` with one side in each direction.
    simple: usize,
    /// The sides of the edges in `two_way`; [`TwoWay`] has the ranges.
    table: Vec<CornerId>,
    /// The sides of edges whose sides all run in one direction, by edge, without boundary edges.
    one_way: usize,
}

/// An edge with sides in both directions, as ranges of a table.
#[derive(Clone, Copy, Debug)]
struct TwoWay {
    start: u32,
    middle: u32,
    end: u32,
}

impl Sides {
    fn new(polygons: &PolygonMesh) -> Self {
        let faces = polygons.faces();
        let incidence = Incidence::new(polygons.vertex_count(), faces, |_| true);
        let (mut simple, mut crowded, mut table) = (Vec::new(), Vec::new(), Vec::new());
        let mut one_way = 0;
        for edge in incidence.edges() {
            let start = row(table.len());
            let of = |downward| edge.sides().filter(move |s| s.downward == downward);
            table.extend(of(false).map(|side| CornerId::new(side.corner)));
            let middle = row(table.len());
            table.extend(of(true).map(|side| CornerId::new(side.corner)));
            let end = row(table.len());
            if start == middle || middle == end {
                one_way += usize::from(edge.len() > 1);
                table.truncate(start as usize);
                continue;
            }
            let list = match edge.len() {
                2 => &mut simple,
                _ => &mut crowded,
            };
            list.push(TwoWay { start, middle, end });
        }
        let edges = simple.len();
        simple.append(&mut crowded);
        Self {
            vertex: faces.corners().to_vec(),
            next: next_corners(faces),
            two_way: simple,
            simple: edges,
            table,
            one_way,
        }
    }

    /// Returns the edges with one side in each direction.
    fn simple(&self) -> impl Iterator<Item = [CornerId; 2]> {
        let edges = self.two_way[..self.simple].iter();
        edges.map(move |edge| [edge.start, edge.start + 1].map(|i| self.table[i as usize]))
    }

    /// Returns the edges with three or more sides in both directions.
    fn crowded(&self) -> &[TwoWay] {
        &self.two_way[self.simple..]
    }

    /// Returns the sides of `edge` that run from the lower end to the higher one, and the others.
    fn up_and_down(&self, edge: TwoWay) -> [&[CornerId]; 2] {
        let (start, middle) = (edge.start as usize, edge.middle as usize);
        [
            &self.table[start..middle],
            &self.table[middle..edge.end as usize],
        ]
    }

    /// Returns the two vertices of an edge.
    fn ends(&self, edge: TwoWay) -> [VertexId; 2] {
        let side = self.table[edge.start as usize];
        [side, self.next[side.index()]].map(|corner| self.vertex[corner.index()])
    }

    /// Returns the pairs of corners that become one vertex if `side` and `other` are joined. In each
    /// pair, one of the two sides leaves the first corner, and the other arrives at the second.
    fn joined_corners(&self, side: CornerId, other: CornerId) -> [[CornerId; 2]; 2] {
        let (end, other_end) = (self.next[side.index()], self.next[other.index()]);
        [[side, other_end], [other, end]]
    }
}

/// Returns the corner after each corner along its face.
fn next_corners(faces: &FaceList) -> Vec<CornerId> {
    let mut next = Vec::with_capacity(faces.corners().len());
    for (f, _) in faces.iter() {
        let range = faces.range(f);
        let (first, end) = (row(range.start), row(range.end));
        next.extend((first..end).map(|c| CornerId::new(if c + 1 == end { first } else { c + 1 })));
    }
    next
}

/// Builds the mesh in which joined sides are one edge. The first fan of each vertex keeps the
/// vertex, and every other fan gets a new one.
fn separate(polygons: &PolygonMesh, sides: &Sides, mates: &Mates) -> Result<Outcome, RepairError> {
    let mut fans = Partition::new(mates.len());
    for (side, mate) in (0..).map(CornerId::new).zip(mates) {
        if let Some(mate) = mate.get() {
            for [a, b] in sides.joined_corners(side, mate) {
                fans.join(a.index(), b.index());
            }
        }
    }
    let mut positions = polygons.positions().to_vec();
    let mut vertices = VertexTrace::identity(polygons);
    let mut is_taken = vec![false; positions.len()];
    let mut numbers: Vec<Slot<VertexId>> = vec![Slot::NONE; mates.len()];
    for (corner, &v) in sides.vertex.iter().enumerate() {
        let (fan, _) = fans.root(corner);
        if numbers[fan].get().is_some() {
            continue;
        }
        numbers[fan] = if std::mem::replace(&mut is_taken[v.index()], true) {
            positions.push(polygons.position(v));
            vertices.origins.push(Slot::some(v));
            Slot::some(VertexId::new(row(positions.len() - 1)))
        } else {
            Slot::some(v)
        };
    }
    let number_of: Vec<VertexId> = (0..mates.len())
        .map(|corner| {
            numbers[fans.root(corner).0]
                .get()
                .expect("every fan has one")
        })
        .collect();
    let counts = StepCounts {
        vertices_added: positions.len() - polygons.vertex_count(),
        edges_cut: cut_edges(sides, mates),
        ..StepCounts::default()
    };
    let mut rebuild = Rebuild::new(polygons);
    for (f, _) in polygons.faces().iter() {
        rebuild.keep(f, |_, corner| number_of[corner.index()])?;
    }
    let changed = rebuild.finish(positions, vertices)?;
    Ok(Outcome::changed(changed, counts))
}

/// Returns the number of edges that become two edges or more.
fn cut_edges(sides: &Sides, mates: &Mates) -> usize {
    let is_cut = |edge: &&TwoWay| {
        let [up, down] = sides.up_and_down(**edge);
        let joined = up.iter().filter(|side| mates[side.index()].get().is_some());
        up.len() + down.len() - joined.count() > 1
    };
    sides.one_way + sides.two_way.iter().filter(is_cut).count()
}

/// Returns the face of each corner.
fn faces_of_corners(faces: &FaceList) -> Vec<FaceId> {
    let of = faces
        .iter()
        .flat_map(|(f, face)| std::iter::repeat_n(f, face.len()));
    of.collect()
}

#[cfg(test)]
mod tests;
