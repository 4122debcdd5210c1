//! Carries the sharpness of edges and vertices from the mesh before a repair to the mesh after it.

use sixfold_core::{Creases, Pair, VertexId};

use crate::report::Repaired;

/// An end of a sharp edge in the new mesh, with the other end in the old mesh.
struct End {
    new: VertexId,
    other: VertexId,
    /// Number of the sharp edge in the old mesh.
    entry: usize,
}

impl Repaired {
    /// Returns the creases of the repaired mesh, and how many sharp edges and vertices of `old` are
    /// lost, because the repaired mesh has no part of them. `old` must be the creases of the mesh
    /// before the repair.
    ///
    /// All copies of an edge or vertex get its sharpness. If several elements became one, it gets
    /// the greatest sharpness of these.
    ///
    /// # Panics
    ///
    /// Panics if the mesh before the repair has no such vertex.
    ///
    /// # Complexity
    ///
    /// O(n log n) for n corners and copies of sharp edges, if only a bounded number of sharp edges
    /// meets at a vertex.
    ///
    /// # Examples
    ///
    /// ```
    /// use sixfold_core::{Creases, PolygonMesh};
    /// use sixfold_repair::{Step, repair};
    ///
    /// // Two triangles with four corners at two places.
    /// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    /// let points = points.map(|[x, y]| [x, y, 0.0]);
    /// let unwelded = PolygonMesh::new(points, [[0, 1, 2], [3, 4, 5]])?;
    /// let old = Creases::new(&unwelded, [([1, 2], 1.0), ([3, 5], 2.0)], [])?;
    /// let repaired = repair(&unwelded, &[Step::Weld(Default::default())])?;
    /// let (creases, lost) = repaired.carried_creases(&old);
    /// assert_eq!((creases.edges().len(), lost), (1, 0));
    /// assert_eq!(creases.edges()[0].1, 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn carried_creases(&self, old: &Creases) -> (Creases, usize) {
        let mut lost = 0;
        let mut corners = Vec::new();
        for &(vertex, sharpness) in old.corners() {
            let new = self.vertices.new_elements(vertex);
            lost += usize::from(new.is_empty());
            corners.extend(new.into_iter().map(|v| (v, sharpness)));
        }
        let mut is_kept = vec![false; old.edges().len()];
        let mut edges = Vec::new();
        for (edge, entry) in self.sharp_sides(old) {
            is_kept[entry] = true;
            edges.push((edge, old.edges()[entry].1));
        }
        lost += is_kept.iter().filter(|kept| !**kept).count();
        // The last entry of an element counts, so it has to be the greatest one.
        edges.sort_by(|a, b| a.1.total_cmp(&b.1));
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        (Creases::from_entries(edges, corners), lost)
    }

    /// Returns the sides of new faces that come from sharp edges, with the number of the sharp edge.
    fn sharp_sides(&self, old: &Creases) -> Vec<(Pair<VertexId>, usize)> {
        let mut ends = Vec::new();
        for (entry, &(edge, _)) in old.edges().iter().enumerate() {
            let [a, b] = edge.ends();
            for (from, other) in [(a, b), (b, a)] {
                let copies = self.vertices.new_elements(from).into_iter();
                ends.extend(copies.map(|new| End { new, other, entry }));
            }
        }
        ends.sort_by_key(|end| end.new);
        let mut sides = Vec::new();
        if ends.is_empty() {
            return sides;
        }
        for (_, face) in self.polygons.faces().iter() {
            for (i, &from) in face.iter().enumerate() {
                let to = face[(i + 1) % face.len()];
                let first = ends.partition_point(|end| end.new < from);
                let at_vertex = ends[first..].iter().take_while(|end| end.new == from);
                for end in at_vertex {
                    if self.vertices.new_elements(end.other).contains(&to) {
                        sides.push((Pair::new(from, to), end.entry));
                    }
                }
            }
        }
        sides
    }
}
