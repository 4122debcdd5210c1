//! Splitting a vertex, with a triangle on each side of the new edge.

use sixfold_core::{EditError, EditLog, FaceId, Few, Pair, Point, Probe, VertexId, row};

use super::find::Refused;
use super::listens;
use crate::circulate::beside;
use crate::mesh::EditableFaceVertexMesh;

/// A face at a vertex, with the vertices after and before that vertex in the face.
#[derive(Clone, Copy)]
struct Spoke {
    after: VertexId,
    face: FaceId,
    before: VertexId,
}

/// The faces around a vertex, counter-clockwise; from the boundary if the vertex is on one.
struct Umbrella {
    spokes: Few<Spoke>,
    is_closed: bool,
}

impl Umbrella {
    /// Returns the number of neighbours. Each has the face after it or, on a boundary, a gap.
    fn len(&self) -> usize {
        self.spokes.len() + usize::from(!self.is_closed)
    }

    /// Returns neighbour `i`.
    fn neighbour(&self, i: usize) -> VertexId {
        match self.spokes.get(i) {
            Some(spoke) => spoke.after,
            None => self.spokes[i - 1].before,
        }
    }

    /// Returns the faces from neighbour `from` up to neighbour `to`.
    fn faces(&self, from: usize, to: usize) -> Few<FaceId> {
        let all = self.between(from, to);
        let faces = all.filter_map(|i| self.spokes.get(i).map(|spoke| spoke.face));
        Few::from_iter(faces)
    }

    /// Returns the numbers of the neighbours from `from` up to but excluding `to`.
    fn between(&self, from: usize, to: usize) -> impl Iterator<Item = usize> + use<> {
        let len = self.len();
        let steps = (to + len - from) % len;
        (from..from + steps).map(move |i| if i < len { i } else { i - len })
    }
}

impl<P: Probe> EditableFaceVertexMesh<P> {
    /// Implements [`split_vertex`](sixfold_core::MeshEdit::split_vertex); `sides`: left, right.
    pub(super) fn split_fan(
        &mut self,
        v: VertexId,
        sides: [Option<VertexId>; 2],
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refused> {
        self.fan_of(v)?;
        let umbrella = self.umbrella(v).ok_or(EditError::NoFan { vertex: v })?;
        let [to, from] = self.places_of_sides(v, &umbrella, sides)?;
        let moving = umbrella.faces(from, to);
        let mut staying = umbrella.faces(to, from);
        if from == to {
            // From the boundary all the way around to the boundary: no face moves.
            staying = Few::from_iter(self.fan(v).iter().copied());
        }
        self.check_room(1, 2, 6 + moving.len())?;

        let n = VertexId::new(row(self.fans.len()));
        for &f in &*moving {
            self.retarget(f, v, n);
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
            self.join(side, f);
            moved.push(f);
            staying.push(f);
            log.created_face(f);
            log.created_edge(Pair::new(n, side));
        }
        self.refill(v, &staying);
        self.push_vertex(at, &moved);

        if listens(log) {
            log.created_vertex(n);
            log.created_edge(Pair::new(v, n));
            // The neighbours between the sides, and the one on the boundary if a side is missing.
            let passed = umbrella.between(from, to).map(|i| umbrella.neighbour(i));
            let all = passed.chain([umbrella.neighbour(to)]);
            for other in all.filter(|&u| !sides.contains(&Some(u))) {
                log.renamed_edge(Pair::new(v, other), Pair::new(n, other));
            }
        }
        Ok(n)
    }

    /// Returns the numbers of left and right among the neighbours of `v`. The part between them
    /// moves, counter-clockwise from right to left.
    fn places_of_sides(
        &self,
        v: VertexId,
        umbrella: &Umbrella,
        sides: [Option<VertexId>; 2],
    ) -> Result<[usize; 2], Refused> {
        let place = |side: VertexId| {
            let place = (0..umbrella.len()).find(|&i| umbrella.neighbour(i) == side);
            place.ok_or(EditError::NotANeighbour { vertex: v, side })
        };
        match sides {
            [Some(left), Some(right)] if left != right => Ok([place(left)?, place(right)?]),
            [Some(_), Some(_)] | [None, None] => Err(EditError::NoSides { vertex: v }),
            _ if umbrella.is_closed => Err(EditError::NotOnBoundary { vertex: v }),
            [None, Some(right)] => Ok([umbrella.len() - 1, place(right)?]),
            [Some(left), None] => Ok([place(left)?, 0]),
        }
    }

    /// Returns the faces around `v` in order, or `None` if they are not a single oriented fan or
    /// `v` is isolated. O(length · log length + corners of polygons).
    fn umbrella(&self, v: VertexId) -> Option<Umbrella> {
        let spokes = self.fan(v).iter().map(|&face| {
            let [before, after] = beside(self.known_face(face), v);
            Spoke {
                after,
                face,
                before,
            }
        });
        let mut sorted = Few::from_iter(spokes);
        sorted.sort_unstable_by_key(|spoke| spoke.after);
        if sorted.is_empty() || sorted.windows(2).any(|pair| pair[0].after == pair[1].after) {
            return None;
        }
        let next = |spoke: &Spoke| sorted.binary_search_by_key(&spoke.before, |other| other.after);
        // The first spoke of an open fan follows no other.
        let mut follow = Few::from_iter(sorted.iter().map(|_| false));
        for i in sorted.iter().filter_map(|spoke| next(spoke).ok()) {
            if std::mem::replace(&mut follow[i], true) {
                return None;
            }
        }
        let first = follow.iter().position(|&follows| !follows);
        let mut ordered = Few::new();
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
        (ordered.len() == sorted.len()).then_some(Umbrella {
            spokes: ordered,
            is_closed: first.is_none(),
        })
    }
}
