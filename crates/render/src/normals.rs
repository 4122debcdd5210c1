//! Normals for the lighting.

use glam::DVec3;
use sixfold_core::{Creases, PolygonMesh, VertexId, row};

use crate::edges::Edges;
use crate::settings::{Shading, View};

/// The cosine of 40°: faces at a larger angle are not one smooth surface.
const SMOOTH: f64 = 0.766_044_443_118_978;

/// The least sharpness that breaks smooth shading: a lower one is rounded off in the next level.
const BREAKS: f32 = 1.0;

/// Unit normals in the axes of the picture; zero for a face without area.
pub(crate) struct Normals {
    /// By face.
    pub(crate) faces: Vec<DVec3>,
    /// By corner, in the order of the corners of all faces: the normals for the lighting.
    pub(crate) corners: Vec<DVec3>,
}

impl Normals {
    /// Computes the normals of `mesh`; O(corners · α), with the inverse Ackermann function α.
    ///
    /// Corners joined by smooth edges are one surface, whose normal is the mean of its face
    /// normals, weighted by area.
    pub(crate) fn of(
        mesh: &PolygonMesh,
        creases: &Creases,
        edges: &Edges,
        shading: Shading,
        view: &View,
    ) -> Self {
        let faces = mesh.faces().iter();
        let areas: Vec<DVec3> = faces
            .map(|(_, face)| view.turned(area(mesh, face)))
            .collect();
        let units: Vec<DVec3> = areas.iter().map(|n| n.normalize_or_zero()).collect();
        let by_corner = |of_face: &[DVec3]| -> Vec<DVec3> {
            let faces = mesh.faces().iter().zip(of_face);
            faces
                .flat_map(|((_, face), &n)| std::iter::repeat_n(n, face.len()))
                .collect()
        };
        if shading == Shading::Flat {
            let corners = by_corner(&units);
            return Self {
                faces: units,
                corners,
            };
        }
        let mut surfaces = Surfaces::apart(mesh.corner_count());
        let all = mesh.faces().corners();
        for sides in edges.iter() {
            let &[one, other] = sides else { continue };
            let [n, m] = [one, other].map(|side| units[side.face as usize]);
            let agree = all[one.corners[0] as usize] == all[other.corners[1] as usize];
            let [a, b] = one.edge.ends();
            if agree && n.dot(m) >= SMOOTH && creases.edge(a, b) < BREAKS {
                surfaces.join(one.corners[0], other.corners[1]);
                surfaces.join(one.corners[1], other.corners[0]);
            }
        }
        let mut sums = vec![DVec3::ZERO; all.len()];
        let areas = by_corner(&areas);
        for (corner, &area) in (0..).zip(&areas) {
            sums[surfaces.of(corner) as usize] += area;
        }
        let corner = |corner| sums[surfaces.of(corner) as usize].normalize_or_zero();
        Self {
            faces: units,
            corners: (0..row(all.len())).map(corner).collect(),
        }
    }
}

/// Returns the normal of a face, with twice its area as length (Newell's method).
///
/// Products of the 32-bit coordinates do not overflow 64-bit floats.
fn area(mesh: &PolygonMesh, face: &[VertexId]) -> DVec3 {
    let place = |v: VertexId| mesh.position(v).as_dvec3();
    let origin = place(face[0]);
    let sides = face[1..].windows(2);
    sides
        .map(|pair| (place(pair[0]) - origin).cross(place(pair[1]) - origin))
        .sum()
}

/// The smooth surface of each corner: disjoint sets after Tarjan (1975), with path halving.
struct Surfaces(Vec<u32>);

impl Surfaces {
    fn apart(corners: usize) -> Self {
        Self((0..row(corners)).collect())
    }

    fn of(&mut self, corner: u32) -> u32 {
        let mut at = corner;
        while self.0[at as usize] != at {
            let parent = self.0[at as usize];
            self.0[at as usize] = self.0[parent as usize];
            at = self.0[at as usize];
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let [a, b] = [self.of(a), self.of(b)];
        // The lowest corner represents the set, in whichever order sets are joined.
        self.0[a.max(b) as usize] = a.min(b);
    }
}
