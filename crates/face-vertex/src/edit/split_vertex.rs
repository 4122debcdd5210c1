//! Splitting a vertex, with a triangle on each side of the new edge.

use sixfold_core::{
    EditError, EditLog, Editable, FaceId, Pair, Point, Probe, ShortVec, VertexId, row, uses_reports,
};

use super::find::Refused;
use crate::circulate::neighbours_in;
use crate::mesh::FaceVertexMesh;

/// A face at a vertex, with the vertices after and before that vertex in the face.
#[derive(Clone, Copy)]
struct FanFace {
    after: VertexId,
    face: FaceId,
    before: VertexId,
}

/// The faces around a vertex, counter-clockwise. An open fan starts at the boundary.
struct OrderedFan {
    members: ShortVec<FanFace>,
    is_closed: bool,
}

impl OrderedFan {
    /// Returns the number of neighbours.
    fn len(&self) -> usize {
        self.members.len() + usize::from(!self.is_closed)
    }

    fn neighbour(&self, i: usize) -> VertexId {
        match self.members.get(i) {
            Some(member) => member.after,
            None => self.members[i - 1].before,
        }
    }

    fn faces_between(&self, from: usize, to: usize) -> ShortVec<FaceId> {
        let all = self.indices_between(from, to);
        let faces = all.filter_map(|i| self.members.get(i).map(|member| member.face));
        ShortVec::from_iter(faces)
    }

    /// Returns the indices of the neighbours from `from` up to but excluding `to`.
    fn indices_between(&self, from: usize, to: usize) -> impl Iterator<Item = usize> + use<> {
        let len = self.len();
        let steps = (to + len - from) % len;
        (from..from + steps).map(move |i| if i < len { i } else { i - len })
    }
}

impl<P: Probe> FaceVertexMesh<Editable, P> {
    /// Implements [`split_vertex`](sixfold_core::MeshEdit::split_vertex). `sides` has left, then
    /// right.
    pub(super) fn split_fan(
        &mut self,
        v: VertexId,
        sides: [Option<VertexId>; 2],
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refused> {
        self.fan_of(v)?;
        let fan = self.ordered_fan(v).ok_or(EditError::NoFan { vertex: v })?;
        let [to, from] = self.side_indices(v, &fan, sides)?;
        let moving = fan.faces_between(from, to);
        let mut staying = fan.faces_between(to, from);
        if from == to {
            // The part is the whole open fan, so no face moves.
            staying = ShortVec::from_iter(self.fan(v).iter().copied());
        }
        self.check_room(1, 2, 6 + moving.len())?;

        let n = VertexId::new(row(self.fans.len()));
        for &f in &*moving {
            self.replace_corner(f, v, n);
        }
        let mut moved = moving;
        let [left, right] = sides;
        let triangles = [
            left.map(|left| [v, n, left]),
            right.map(|right| [v, right, n]),
        ];
        for (triangle, side) in triangles.into_iter().zip(sides) {
            let (Some(triangle), Some(side)) = (triangle, side) else {
                continue;
            };
            let f = self.spans.push(&mut self.corners, &triangle);
            self.add_to_fan(side, f);
            moved.push(f);
            staying.push(f);
            log.created_face(f);
            log.created_edge(Pair::new(n, side));
        }
        self.set_fan(v, &staying);
        self.push_vertex(at, &moved);

        if uses_reports(log) {
            log.created_vertex(n);
            log.created_edge(Pair::new(v, n));
            // The neighbours between the sides. If a side is missing, also the neighbour on the
            // boundary.
            let passed = fan.indices_between(from, to).map(|i| fan.neighbour(i));
            let all = passed.chain([fan.neighbour(to)]);
            for other in all.filter(|&u| !sides.contains(&Some(u))) {
                log.renamed_edge(Pair::new(v, other), Pair::new(n, other));
            }
        }
        Ok(n)
    }

    /// Returns the indices of left and right among the neighbours of `v`. The part from right to
    /// left, counter-clockwise, moves.
    fn side_indices(
        &self,
        v: VertexId,
        fan: &OrderedFan,
        sides: [Option<VertexId>; 2],
    ) -> Result<[usize; 2], Refused> {
        let index = |side: VertexId| {
            let index = (0..fan.len()).find(|&i| fan.neighbour(i) == side);
            index.ok_or(EditError::NotANeighbour { vertex: v, side })
        };
        match sides {
            [Some(left), Some(right)] if left != right => Ok([index(left)?, index(right)?]),
            [Some(_), Some(_)] | [None, None] => Err(EditError::BadNeighbours { vertex: v }),
            _ if fan.is_closed => Err(EditError::NotOnBoundary { vertex: v }),
            [None, Some(right)] => Ok([fan.len() - 1, index(right)?]),
            [Some(left), None] => Ok([index(left)?, 0]),
        }
    }

    /// Returns the faces around `v` in order. Returns `None` if `v` is isolated or the faces are
    /// not one oriented fan. O(length · log length + corners of polygons).
    fn ordered_fan(&self, v: VertexId) -> Option<OrderedFan> {
        let members = self.fan(v).iter().map(|&face| {
            let [before, after] = neighbours_in(self.known_face(face), v);
            FanFace {
                after,
                face,
                before,
            }
        });
        let mut sorted = ShortVec::from_iter(members);
        sorted.sort_unstable_by_key(|member| member.after);
        if sorted.is_empty() || sorted.windows(2).any(|pair| pair[0].after == pair[1].after) {
            return None;
        }
        let next =
            |member: &FanFace| sorted.binary_search_by_key(&member.before, |other| other.after);
        // The first face of an open fan has no previous face.
        let mut has_previous = ShortVec::from_iter(sorted.iter().map(|_| false));
        for i in sorted.iter().filter_map(|member| next(member).ok()) {
            if std::mem::replace(&mut has_previous[i], true) {
                return None;
            }
        }
        let first = has_previous.iter().position(|&has| !has);
        let mut ordered = ShortVec::new();
        let mut at = Ok(first.unwrap_or(0));
        while let Ok(i) = at
            && ordered.len() < sorted.len()
        {
            ordered.push(sorted[i]);
            at = next(&sorted[i]);
            if at == Ok(first.unwrap_or(0)) {
                break;
            }
        }
        (ordered.len() == sorted.len()).then_some(OrderedFan {
            members: ordered,
            is_closed: first.is_none(),
        })
    }
}
