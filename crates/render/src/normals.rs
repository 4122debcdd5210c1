//! Normals for the lighting.

use glam::DVec3;
use sixfold_core::{Creases, FaceId, PolygonMesh, VertexId, row};

use crate::edges::Edges;
use crate::light::Seen;
use crate::settings::{Shading, View};

/// The cosine of 40°, the maximum angle between the faces of a smooth surface.
const MIN_SMOOTH_COSINE: f64 = 0.766_044_443_118_978;

/// Minimum sharpness of an edge across which shading is not smooth.
const MIN_CREASE_SHARPNESS: f32 = 1.0;

/// Unit normals in the axes of the picture. A face without area has the normal zero.
pub(crate) struct Normals {
    /// By face.
    pub(crate) faces: Vec<DVec3>,
    /// For each corner, the normal for the lighting.
    pub(crate) corners: Vec<DVec3>,
    /// By face: whether it is painted as turned. Empty if no face is.
    turned: Vec<bool>,
}

impl Normals {
    /// Paints these faces as turned.
    pub(crate) fn paint_turned(&mut self, faces: &[FaceId]) {
        self.turned = vec![
            false;
            if faces.is_empty() {
                0
            } else {
                self.faces.len()
            }
        ];
        for f in faces {
            if let Some(turned) = self.turned.get_mut(f.index()) {
                *turned = true;
            }
        }
    }

    /// Returns the side of `face` that is seen.
    pub(crate) fn seen(&self, face: FaceId) -> Seen {
        let inside = self.faces[face.index()].z < 0.0;
        match (self.turned.get(face.index()), inside) {
            (Some(true), inside) => Seen::Turned(inside),
            (_, true) => Seen::Inside,
            (_, false) => Seen::Outside,
        }
    }

    /// Computes the normals of `mesh`; O(corners · α), with the inverse Ackermann function α.
    ///
    /// Corners joined by smooth edges are one surface. The normal of a surface is the mean of its
    /// face normals, weighted by area.
    pub(crate) fn new(
        mesh: &PolygonMesh,
        creases: &Creases,
        edges: &Edges,
        shading: Shading,
        view: &View,
    ) -> Self {
        let faces = mesh.faces().iter();
        let areas: Vec<DVec3> = faces
            .map(|(_, face)| view.rotate(area_vector(mesh, face)))
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
                turned: Vec::new(),
            };
        }
        let mut surfaces = Surfaces::new(mesh.corner_count());
        let all = mesh.faces().corners();
        for sides in edges.iter() {
            let &[first, second] = sides else { continue };
            let [n, m] = [first, second].map(|side| units[side.face as usize]);
            let is_oriented = all[first.corners[0] as usize] == all[second.corners[1] as usize];
            let [a, b] = first.edge.ends();
            if is_oriented
                && n.dot(m) >= MIN_SMOOTH_COSINE
                && creases.edge(a, b) < MIN_CREASE_SHARPNESS
            {
                surfaces.union(first.corners[0], second.corners[1]);
                surfaces.union(first.corners[1], second.corners[0]);
            }
        }
        let mut sums = vec![DVec3::ZERO; all.len()];
        let areas = by_corner(&areas);
        for (corner, &area) in (0..).zip(&areas) {
            sums[surfaces.find(corner) as usize] += area;
        }
        let corner = |corner| sums[surfaces.find(corner) as usize].normalize_or_zero();
        Self {
            faces: units,
            corners: (0..row(all.len())).map(corner).collect(),
            turned: Vec::new(),
        }
    }
}

/// Returns the Newell normal of a face, whose length is twice the area.
///
/// Products of 32-bit coordinates do not overflow 64-bit floats.
fn area_vector(mesh: &PolygonMesh, face: &[VertexId]) -> DVec3 {
    let position = |v: VertexId| mesh.position(v).as_dvec3();
    let origin = position(face[0]);
    let sides = face[1..].windows(2);
    sides
        .map(|pair| (position(pair[0]) - origin).cross(position(pair[1]) - origin))
        .sum()
}

/// The smooth surface of each corner, as disjoint sets (Tarjan 1975) with path halving.
struct Surfaces(Vec<u32>);

impl Surfaces {
    fn new(corners: usize) -> Self {
        Self((0..row(corners)).collect())
    }

    fn find(&mut self, corner: u32) -> u32 {
        let mut root = corner;
        while self.0[root as usize] != root {
            let parent = self.0[root as usize];
            self.0[root as usize] = self.0[parent as usize];
            root = self.0[root as usize];
        }
        root
    }

    fn union(&mut self, a: u32, b: u32) {
        let [a, b] = [self.find(a), self.find(b)];
        // With the lowest corner as representative, the order of the joins has no effect.
        self.0[a.max(b) as usize] = a.min(b);
    }
}
