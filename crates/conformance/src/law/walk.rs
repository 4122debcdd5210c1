//! Laws about steps from side to side. A side is an edge as one face runs along it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use sixfold_core::{MeshEdit, OrientedWalk, PolygonMesh, Representation};

use super::elements::distant_strip;
use super::relations::is_rotation;
use super::scripts::{Executed, on_random_scripts};
use crate::catch_panic::catch_panic;
use crate::edit::{ModelTest, Step};
use crate::folds::check_walk_folds;
use crate::subject::Subject;

/// The face, the edge, the ends and the neighbours of every side agree with the lists of corners.
/// The sides of each edge and of each vertex are complete. Each walk yields the same sides by `next`
/// and by `fold`. For a side that does not exist, every
/// method panics or returns an element that does not exist.
pub fn oriented_walk<M: Representation + OrientedWalk>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let (oracle, handles) = (&subject.oracle, &subject.handles);
    let faces = oracle.faces().map(|f| {
        let corners = oracle.corners(f).iter().map(|&v| handles.vertex(v));
        (handles.face(f), corners.collect())
    });
    let expected = ExpectedWalk::new(&subject.mesh, M::NAME, faces.collect());
    expected.check();
    let larger = M::from_polygons(&distant_strip(polygons));
    let larger = larger.expect("an oriented manifold of triangles");
    let missing = larger.sides().max();
    expected.check_missing(missing.expect("the larger mesh has sides"));
}

/// Steps from side to side agree with the corners of the faces during random sequences of edits.
/// After a face is removed, its sides do not exist.
///
/// The environment variable `PROPTEST_CASES` sets the number of random edit sequences.
pub fn oriented_walk_after_edits<M: Representation + MeshEdit + OrientedWalk + Debug>() {
    on_random_scripts::<M>("walks wrongly after edits", run_script::<M>);
}

fn run_script<M: Representation + MeshEdit + OrientedWalk + Debug>(
    start: &PolygonMesh,
    steps: &[Step],
    executed: &Executed,
) {
    let Some(mut test) = ModelTest::<M>::from_polygons(start) else {
        return;
    };
    for (number, step) in steps.iter().enumerate() {
        if let Some(action) = step.action(&test.model, number) {
            let accepted = test.apply(&action);
            executed.borrow_mut().push((action, accepted));
        }
        if number % 8 == 7 {
            check_edited(&test.mesh);
        }
    }
    check_edited(&test.mesh);
}

/// Checks the walk. Then removes a face of a copy, and checks that the sides of this face do not
/// exist.
fn check_edited<M: Representation + MeshEdit + OrientedWalk>(mesh: &M) {
    ExpectedWalk::from_mesh(mesh).check();
    let mut without = mesh.clone();
    let Some(f) = mesh.faces().find(|&f| without.remove_face(f).is_ok()) else {
        return;
    };
    let expected = ExpectedWalk::from_mesh(&without);
    for s in mesh.face_sides(f) {
        expected.check_missing(s);
    }
}

/// The expected answers for a side.
struct ExpectedSide<M: OrientedWalk> {
    side: M::Side,
    next: M::Side,
    prev: M::Side,
    face: M::Face,
    ends: [M::Vertex; 2],
}

/// The expected answers for all sides of a mesh, from the corners of its faces.
struct ExpectedWalk<'a, M: OrientedWalk> {
    mesh: &'a M,
    name: &'a str,
    sides: Vec<ExpectedSide<M>>,
    /// By start and end: the sides.
    by_ends: BTreeMap<[M::Vertex; 2], Vec<M::Side>>,
}

impl<'a, M: Representation + OrientedWalk> ExpectedWalk<'a, M> {
    fn from_mesh(mesh: &'a M) -> Self {
        let faces = mesh.faces().map(|f| (f, mesh.face_vertices(f).collect()));
        Self::new(mesh, M::NAME, faces.collect())
    }
}

impl<'a, M: OrientedWalk> ExpectedWalk<'a, M> {
    /// Computes the answers from `faces`. Only the handles of the sides come from `mesh`.
    fn new(mesh: &'a M, name: &'a str, faces: Vec<(M::Face, Vec<M::Vertex>)>) -> Self {
        let mut sides = Vec::new();
        let mut by_ends: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for (face, expected) in faces {
            let corners: Vec<M::Vertex> = mesh.face_vertices(face).collect();
            assert!(
                is_rotation(&corners, &expected),
                "{name}: face_vertices of {face:?} is {corners:?}, expected {expected:?}"
            );
            let around: Vec<M::Side> = mesh.face_sides(face).collect();
            let degree = corners.len();
            assert_eq!(around.len(), degree, "{name}: sides of {face:?}");
            for i in 0..degree {
                let [after, before] = [(i + 1) % degree, (i + degree - 1) % degree];
                let ends = [corners[i], corners[after]];
                by_ends.entry(ends).or_default().push(around[i]);
                sides.push(ExpectedSide {
                    side: around[i],
                    next: around[after],
                    prev: around[before],
                    face,
                    ends,
                });
            }
        }
        Self {
            mesh,
            name,
            sides,
            by_ends,
        }
    }

    fn check(&self) {
        check_walk_folds(self.mesh, self.name);
        self.check_lists();
        for expected in &self.sides {
            self.check_side(expected);
            self.check_twin(expected);
        }
        for expected in &self.sides {
            self.check_turns(expected);
        }
        self.check_sets();
        self.check_map();
    }

    fn check_lists(&self) {
        let (mesh, name) = (self.mesh, self.name);
        let expected: Vec<M::Side> = self.sides.iter().map(|s| s.side).collect();
        let distinct: BTreeSet<M::Side> = expected.iter().copied().collect();
        assert_eq!(
            distinct.len(),
            expected.len(),
            "{name}: two sides are equal"
        );
        assert!(mesh.sides().eq(expected), "{name}: sides()");
        assert_eq!(mesh.side_count(), self.sides.len(), "{name}: side_count()");
    }

    fn check_side(&self, expected: &ExpectedSide<M>) {
        let (mesh, name, s) = (self.mesh, self.name, expected.side);
        let [origin, target] = expected.ends;
        assert_eq!(mesh.side_origin(s), origin, "{name}: side_origin of {s:?}");
        assert_eq!(mesh.side_target(s), target, "{name}: side_target of {s:?}");
        let face = mesh.side_face(s);
        assert_eq!(face, expected.face, "{name}: side_face of {s:?}");
        let edge = Some(mesh.side_edge(s));
        let between = mesh.edge_between(origin, target);
        assert_eq!(edge, between, "{name}: side_edge of {s:?}");
        let next = mesh.next_side(s);
        assert_eq!(next, expected.next, "{name}: next_side of {s:?}");
        let prev = mesh.prev_side(s);
        assert_eq!(prev, expected.prev, "{name}: prev_side of {s:?}");
    }

    fn check_twin(&self, expected: &ExpectedSide<M>) {
        let (mesh, name, s) = (self.mesh, self.name, expected.side);
        let twin = self.twin(expected.ends);
        assert_eq!(mesh.twin_side(s), twin, "{name}: twin_side of {s:?}");
        let back = twin.and_then(|twin| mesh.twin_side(twin));
        assert_eq!(back, twin.map(|_| s), "{name}: twin of the twin of {s:?}");
    }

    fn check_turns(&self, expected: &ExpectedSide<M>) {
        let (mesh, name, s) = (self.mesh, self.name, expected.side);
        let cw = self.twin(expected.ends).map(|twin| mesh.next_side(twin));
        assert_eq!(mesh.cw_side(s), cw, "{name}: cw_side of {s:?}");
        let ccw = mesh.twin_side(expected.prev);
        assert_eq!(mesh.ccw_side(s), ccw, "{name}: ccw_side of {s:?}");
        // The next side along a boundary starts at the end of the side, and leads back.
        let is_boundary = |ends| self.twin(ends).is_none();
        let [next, prev] = [mesh.next_boundary_side(s), mesh.prev_boundary_side(s)];
        let context = format!("{name}: {s:?} along a boundary, from {prev:?} to {next:?}");
        if !is_boundary(expected.ends) {
            assert_eq!([next, prev], [None; 2], "{context}");
            return;
        }
        for (found, back, [arriving, leaving]) in [
            (
                next.and_then(|next| mesh.prev_boundary_side(next)),
                next,
                [Some(s), next],
            ),
            (
                prev.and_then(|prev| mesh.next_boundary_side(prev)),
                prev,
                [prev, Some(s)],
            ),
        ] {
            assert_eq!(found, Some(s), "{context}");
            assert!(
                back.is_some_and(|side| mesh.twin_side(side).is_none()),
                "{context}"
            );
            let ends = arriving.map(|side| mesh.side_target(side));
            assert_eq!(
                ends,
                leaving.map(|side| mesh.side_origin(side)),
                "{context}"
            );
        }
    }

    /// Returns the side in the opposite direction, if there is exactly one side in each direction.
    fn twin(&self, [from, to]: [M::Vertex; 2]) -> Option<M::Side> {
        match (self.between([from, to]), self.between([to, from])) {
            ([_], [twin]) => Some(*twin),
            _ => None,
        }
    }

    fn between(&self, ends: [M::Vertex; 2]) -> &[M::Side] {
        self.by_ends.get(&ends).map_or(&[], Vec::as_slice)
    }

    fn check_sets(&self) {
        let (mesh, name) = (self.mesh, self.name);
        for e in mesh.edges() {
            let [a, b] = mesh.edge_vertices(e);
            let expected = [self.between([a, b]), self.between([b, a])].concat();
            let got = mesh.edge_sides(e).collect();
            assert_eq!(
                sorted(got),
                sorted(expected),
                "{name}: edge_sides of {a:?}–{b:?}"
            );
        }
        for v in mesh.vertices() {
            let outgoing = self.sides.iter().filter(|s| s.ends[0] == v);
            let expected = outgoing.map(|s| s.side).collect();
            let got = mesh.outgoing_sides(v).collect();
            assert_eq!(
                sorted(got),
                sorted(expected),
                "{name}: outgoing_sides of {v:?}"
            );
        }
    }

    fn check_map(&self) {
        let mut map = self.mesh.side_map(usize::MAX);
        for s in &self.sides {
            assert_eq!(map[s.side], usize::MAX, "{}: a new side_map", self.name);
        }
        for (i, s) in self.sides.iter().enumerate() {
            map[s.side] = i;
        }
        for (i, s) in self.sides.iter().enumerate() {
            assert_eq!(map[s.side], i, "{}: side_map at {:?}", self.name, s.side);
        }
    }

    /// Checks a side that does not exist: its methods panic or return elements that do not exist.
    fn check_missing(&self, s: M::Side) {
        let mesh = self.mesh;
        let has = |s: M::Side| self.sides.iter().any(|known| known.side == s);
        assert!(!has(s), "{}: {s:?} exists", self.name);
        let existing = [
            ("next_side", exists(|| has(mesh.next_side(s)))),
            ("prev_side", exists(|| has(mesh.prev_side(s)))),
            ("twin_side", exists(|| mesh.twin_side(s).is_some_and(has))),
            (
                "side_origin",
                exists(|| mesh.contains_vertex(mesh.side_origin(s))),
            ),
            (
                "side_target",
                exists(|| mesh.contains_vertex(mesh.side_target(s))),
            ),
            (
                "side_face",
                exists(|| mesh.contains_face(mesh.side_face(s))),
            ),
            (
                "side_edge",
                exists(|| mesh.contains_edge(mesh.side_edge(s))),
            ),
        ];
        for (method, exists) in existing {
            let name = self.name;
            assert!(!exists, "{name}: {method} of the missing {s:?} exists");
        }
    }
}

fn exists(element: impl FnOnce() -> bool) -> bool {
    catch_panic(element).unwrap_or(false)
}

fn sorted<T: Ord>(mut items: Vec<T>) -> Vec<T> {
    items.sort_unstable();
    items
}
