//! What the control mesh brings along: sharpness, and faces that only take part.

use mesh_core::{Creases, EdgeUse, Pair, PolygonMesh, Representation, SHARP_FOR_EVER, VertexId};

use crate::error::SubdivisionError;
use crate::options::Boundary;
use crate::subdivision::Subdivision;

impl Subdivision {
    /// The sharpness that the first step of `mesh`, which was built from `polygons`, starts from:
    /// that of `creases`, and what the rules make sharp for ever. By the numbers of
    /// `mesh.to_polygons()`. O(corners) expected.
    ///
    /// - With [`Boundary::EdgeAndCorner`], the vertices with exactly one face.
    /// - Edges whose two faces run along them the same way. (Boundary edges and edges of three or more
    ///   faces need not be said to be sharp: every step sees them.)
    /// - Vertices at such edges, at edges of three or more faces, or of several fans. But one inside
    ///   the spine of a book, with two such edges, no boundary edge and more faces than edges, moves
    ///   along the spine, as a crease.
    ///
    /// # Errors
    ///
    /// [`SubdivisionError::NoCreases`] where the scheme has no rules for `creases`.
    pub fn control<M: Representation>(
        &self,
        mesh: &M,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Result<Creases, SubdivisionError> {
        if !self.scheme.kind().creases {
            return if creases.is_empty() {
                Ok(Creases::default())
            } else {
                Err(SubdivisionError::NoCreases {
                    scheme: self.scheme,
                })
            };
        }
        if M::CAPABILITIES.coincident_vertices {
            return Ok(self.sharpened::<M>(polygons, creases));
        }
        let welded = mesh.to_polygons();
        let creases = renumbered(mesh, polygons, creases);
        Ok(self.sharpened::<M>(&welded, &creases))
    }

    /// `creases` and what the rules make sharp in `polygons`.
    fn sharpened<M: Representation>(&self, polygons: &PolygonMesh, creases: &Creases) -> Creases {
        let (mut edges, mut corners) = (creases.edges().to_vec(), creases.corners().to_vec());
        let for_ever = |v: VertexId| (v, f32::INFINITY);
        let mut around = vec![Around::default(); polygons.vertex_count()];
        for v in polygons.faces().corners() {
            around[v.index()].faces += 1;
        }
        let holds = M::CAPABILITIES;
        if holds.non_manifold_vertices || holds.non_manifold_edges || holds.inconsistent_orientation
        {
            let uses = polygons.edge_uses();
            for edge in &uses {
                if !edge.is_manifold() {
                    let [a, b] = edge.ends;
                    edges.push((Pair::new(a, b), f32::INFINITY));
                }
                for v in edge.ends {
                    around[v.index()].see(edge);
                }
            }
            let odd = |v: &VertexId| around[v.index()].odd_edges > 0;
            let several = polygons.vertices_of_several_fans();
            let non_manifold = polygons.vertices().filter(odd).chain(several);
            let kept = non_manifold.filter(|v| !around[v.index()].is_inside_a_spine());
            corners.extend(kept.map(for_ever));
        }
        if self.boundary == Boundary::EdgeAndCorner {
            let alone = polygons.vertices().filter(|v| around[v.index()].faces == 1);
            corners.extend(alone.map(for_ever));
        }
        Creases::sorted(edges, corners)
    }

    /// The faces of the control mesh that the boundary leaves out of the result: with
    /// [`Boundary::None`] those at a boundary vertex whose boundary edges are not all said to be
    /// sharp for ever. `None` where all stay. O(corners) expected.
    pub fn left_out(&self, polygons: &PolygonMesh, creases: &Creases) -> Option<Vec<bool>> {
        if self.boundary != Boundary::None || !self.scheme.kind().creases {
            return None;
        }
        let mut open = vec![false; polygons.vertex_count()];
        let uses = polygons.edge_uses();
        for [a, b] in uses
            .iter()
            .filter(|edge| edge.is_boundary())
            .map(|edge| edge.ends)
        {
            if creases.edge(a, b) < SHARP_FOR_EVER {
                open[a.index()] = true;
                open[b.index()] = true;
            }
        }
        let touches = |face: &[VertexId]| face.iter().any(|v| open[v.index()]);
        Some(
            polygons
                .faces()
                .iter()
                .map(|(_, face)| touches(face))
                .collect(),
        )
    }
}

/// What there is around a vertex.
#[derive(Clone, Copy, Debug, Default)]
struct Around {
    faces: usize,
    edges: usize,
    boundary_edges: usize,
    /// Edges of three or more faces, or of two that run the same way.
    odd_edges: usize,
}

impl Around {
    fn see(&mut self, edge: &EdgeUse) {
        self.edges += 1;
        self.boundary_edges += usize::from(edge.is_boundary());
        self.odd_edges += usize::from(!edge.is_manifold());
    }

    /// Whether the sheets that meet here meet along one curve that runs through.
    fn is_inside_a_spine(&self) -> bool {
        self.odd_edges == 2 && self.boundary_edges == 0 && self.faces > self.edges
    }
}

/// The creases of `polygons` as those of `mesh.to_polygons()`, where a vertex may be its coordinates.
/// Of two edges or vertices that have become one the sharper counts.
pub(crate) fn renumbered<M: Representation>(
    mesh: &M,
    polygons: &PolygonMesh,
    creases: &Creases,
) -> Creases {
    if M::CAPABILITIES.coincident_vertices || creases.is_empty() {
        return creases.clone();
    }
    let mut numbers = mesh.vertex_map(VertexId::new(0));
    for (number, v) in (0..).zip(mesh.vertices()) {
        numbers[v] = VertexId::new(number);
    }
    let number = |v: VertexId| numbers[M::vertex_name(polygons, v)];
    let mut edges: Vec<_> = creases.edges().to_vec();
    for (ends, _) in &mut edges {
        let [a, b] = ends.ends().map(number);
        *ends = Pair::new(a, b);
    }
    let mut corners: Vec<_> = creases.corners().to_vec();
    for (v, _) in &mut corners {
        *v = number(*v);
    }
    // Of those with one name the last stays.
    edges.sort_by(|a, b| a.1.total_cmp(&b.1));
    corners.sort_by(|a, b| a.1.total_cmp(&b.1));
    Creases::sorted(edges, corners)
}
