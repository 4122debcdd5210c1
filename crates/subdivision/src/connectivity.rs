//! A mesh as tables of numbers: the corners of the faces, and the sides of each edge (a side is an
//! edge as one face runs along it).
//!
//! Schemes that make new faces across old edges use these tables.
//!
//! ```text
//!          b
//!        ╱ │ ╲       A side is named by the corner it starts at. Side c runs a → b, and d runs
//!       ╱ c│  ╲      b → a: twin(c) = d, twin(d) = c.
//!       ╲  │d ╱
//!        ╲ │ ╱       next(c) is the next corner of the same face, here at b.
//!          a
//! ```

use std::iter::successors;

use sixfold_core::{MeshQuery, VertexId, VertexMap};

use crate::error::SubdivisionError;
use crate::scheme::Scheme;

pub(crate) struct Connectivity {
    /// The vertex at each corner.
    pub(crate) corners: Vec<u32>,
    /// The next corner of the same face.
    next: Vec<u32>,
    sides: Vec<u32>,
    edges: Vec<EdgeSides>,
}

#[derive(Clone, Copy)]
pub(crate) struct EdgeSides {
    /// The side of the first face.
    pub(crate) first: u32,
    /// The side of the second face; `None` at a boundary.
    pub(crate) second: Option<u32>,
}

const UNNUMBERED: u32 = u32::MAX;

impl Connectivity {
    /// Builds the tables of `mesh` with queries for the faces of each edge. The edges have the
    /// order of `edges()`. Queries FV, EV and EF. Takes O(sum of the squares of the degrees) plus
    /// the cost of the queries.
    ///
    /// # Errors
    ///
    /// Returns an error for an edge with three faces, or an edge along which two faces run in the
    /// same direction.
    pub(crate) fn gathered<M: MeshQuery>(
        mesh: &M,
        scheme: Scheme,
    ) -> Result<Self, SubdivisionError> {
        let numbers = vertex_numbers(mesh);
        let mut connectivity = Self::with_capacity_for(mesh);
        let mut first_corners = mesh.face_map(0_u32);
        mesh.faces().for_each(|f| {
            let first = connectivity.corners.len();
            first_corners[f] = first as u32;
            let corners = mesh.face_vertices(f).map(|v| numbers[v]);
            corners.for_each(|corner| connectivity.corners.push(corner));
            connectivity.link_face(first);
        });
        connectivity.sides = vec![UNNUMBERED; connectivity.corners.len()];
        for e in mesh.edges() {
            let ends = mesh.edge_vertices(e).map(|v| numbers[v]);
            let (mut along, mut faces, mut twice) = ([None; 2], 0, false);
            mesh.edge_faces(e).for_each(|f| {
                let (direction, side) = connectivity.side_between(first_corners[f], ends);
                twice |= along[direction].replace(side).is_some();
                faces += 1;
            });
            let [one, other] = along;
            let (Some(first), false) = (one.or(other), twice) else {
                return Err(non_manifold_edge(scheme, ends, faces));
            };
            let second = one.and(other);
            let number = connectivity.edges.len() as u32;
            for side in [Some(first), second].into_iter().flatten() {
                connectivity.sides[side as usize] = number;
            }
            connectivity.edges.push(EdgeSides { first, second });
        }
        Ok(connectivity)
    }

    /// Builds the tables from one pass over the faces, with FV and FE only. The edges have the
    /// order in which the faces list them. O(corners) expected.
    ///
    /// # Errors
    ///
    /// Returns an error for an edge with three faces, or an edge along which two faces run in the
    /// same direction.
    pub(crate) fn scattered<M: MeshQuery>(
        mesh: &M,
        scheme: Scheme,
    ) -> Result<Self, SubdivisionError> {
        let numbers = vertex_numbers(mesh);
        let mut connectivity = Self::with_capacity_for(mesh);
        let mut edge_numbers = mesh.edge_map(UNNUMBERED);
        let mut faulty_edge: Option<u32> = None;
        mesh.faces().for_each(|f| {
            let first = connectivity.corners.len();
            let corners = mesh.face_vertices(f).map(|v| numbers[v]);
            corners.for_each(|corner| connectivity.corners.push(corner));
            connectivity.link_face(first);
            let mut side = first as u32;
            mesh.face_edges(f).for_each(|e| {
                let number = &mut edge_numbers[e];
                if *number == UNNUMBERED {
                    *number = connectivity.edges.len() as u32;
                    connectivity.edges.push(EdgeSides {
                        first: side,
                        second: None,
                    });
                } else {
                    let edge = &mut connectivity.edges[*number as usize];
                    let same_direction = connectivity.corners[edge.first as usize]
                        == connectivity.corners[side as usize];
                    if edge.second.replace(side).is_some() || same_direction {
                        faulty_edge =
                            Some(faulty_edge.map_or(*number, |lowest| lowest.min(*number)));
                    }
                }
                connectivity.sides.push(*number);
                side += 1;
            });
        });
        if let Some(edge) = faulty_edge {
            let ends = connectivity.ends(connectivity.edges[edge as usize].first);
            let faces = connectivity
                .sides
                .iter()
                .filter(|&&side| side == edge)
                .count();
            return Err(non_manifold_edge(scheme, ends, faces));
        }
        Ok(connectivity)
    }

    fn with_capacity_for<M: MeshQuery>(mesh: &M) -> Self {
        let corners = 3 * mesh.face_count();
        Self {
            corners: Vec::with_capacity(corners),
            next: Vec::with_capacity(corners),
            sides: Vec::with_capacity(corners),
            edges: Vec::with_capacity(corners / 2),
        }
    }

    /// Links the corners from index `first` to the end into a face.
    fn link_face(&mut self, first: usize) {
        let next = first as u32 + 1..self.corners.len() as u32;
        self.next.extend(next.chain([first as u32]));
    }

    /// Returns the side of a face between `ends`, and its direction. Direction 0 runs from the
    /// first end to the second end; direction 1 runs back.
    fn side_between(&self, corner_of_face: u32, ends: [u32; 2]) -> (usize, u32) {
        let mut side = corner_of_face;
        loop {
            match self.ends(side) {
                [a, b] if [a, b] == ends => return (0, side),
                [a, b] if [b, a] == ends => return (1, side),
                _ => side = self.next(side),
            }
            assert!(side != corner_of_face, "EF and FV disagree about a face");
        }
    }

    #[inline]
    pub(crate) fn next(&self, corner: u32) -> u32 {
        self.next[corner as usize]
    }

    /// Returns the vertices at which a side starts and ends.
    #[inline]
    pub(crate) fn ends(&self, side: u32) -> [u32; 2] {
        [side, self.next(side)].map(|corner| self.corners[corner as usize])
    }

    /// Returns the edge of a side.
    #[inline]
    pub(crate) fn edge_of(&self, side: u32) -> usize {
        self.sides[side as usize] as usize
    }

    /// Returns the side that runs along the same edge in the opposite direction; `None` at a
    /// boundary.
    #[inline]
    pub(crate) fn twin(&self, side: u32) -> Option<u32> {
        let edge = self.edges[self.edge_of(side)];
        if edge.first == side {
            edge.second
        } else {
            Some(edge.first)
        }
    }

    pub(crate) fn edges(&self) -> &[EdgeSides] {
        &self.edges
    }

    /// Calls `fan` for each inner vertex with the corners around the vertex, counter-clockwise.
    /// O(corners).
    ///
    /// ```text
    ///      f  w  g      c is the corner of v in f, whose side runs v → w; its twin is the side w → v
    ///         │         of g. The next corner of g is at v again: d = next(twin(c)), the next one
    ///       c │ d       clockwise
    ///         v
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error for a vertex whose faces are several fans, and any error of `fan`.
    pub(crate) fn for_each_inner_fan(
        &self,
        vertices: usize,
        scheme: Scheme,
        mut fan: impl FnMut(&[u32]) -> Result<(), SubdivisionError>,
    ) -> Result<(), SubdivisionError> {
        // For each vertex: one corner, whether the fan begins at this corner, and the number of
        // corners.
        let mut starts = vec![(None, false); vertices];
        let mut counts = vec![0_usize; vertices];
        for (corner, &v) in (0..).zip(&self.corners) {
            starts[v as usize].0 = Some(corner);
            counts[v as usize] += 1;
        }
        let mut twice: Option<u32> = None;
        for edge in self.edges().iter().filter(|edge| edge.second.is_none()) {
            let corner = self.next(edge.first);
            let v = self.corners[corner as usize];
            let start = &mut starts[v as usize];
            if start.1 {
                twice = Some(twice.map_or(v, |lowest| lowest.min(v)));
            }
            *start = (Some(corner), true);
        }
        if let Some(v) = twice {
            return Err(non_manifold_vertex(scheme, v));
        }
        let mut around = Vec::new();
        for (v, (&(start, is_open), &count)) in (0..).zip(starts.iter().zip(&counts)) {
            let next_clockwise = |&corner: &u32| self.twin(corner).map(|twin| self.next(twin));
            let walk = successors(start, |corner| {
                next_clockwise(corner).filter(|&c| Some(c) != start)
            });
            around.clear();
            around.extend(walk);
            if around.len() != count {
                return Err(non_manifold_vertex(scheme, v));
            }
            if !is_open {
                around.reverse();
                fan(&around)?;
            }
        }
        Ok(())
    }
}

/// Returns the index of each vertex in `vertices()`.
pub(crate) fn vertex_numbers<M: MeshQuery>(mesh: &M) -> VertexMap<M, u32> {
    let mut numbers = mesh.vertex_map(0_u32);
    let mut number = 0;
    mesh.vertices().for_each(|v| {
        numbers[v] = number;
        number += 1;
    });
    numbers
}

pub(crate) fn non_manifold_edge(scheme: Scheme, ends: [u32; 2], faces: usize) -> SubdivisionError {
    SubdivisionError::NonManifoldEdge {
        scheme,
        ends: ends.map(VertexId::new),
        faces,
    }
}

pub(crate) fn non_manifold_vertex(scheme: Scheme, v: u32) -> SubdivisionError {
    let vertex = VertexId::new(v);
    SubdivisionError::NonManifoldVertex { scheme, vertex }
}
