//! The names of the elements of a mesh in a trace, while edits change the mesh.

use std::collections::HashMap;

use sixfold::{Changes, EditRecord, Handle, MeshQuery, PolygonMesh, Representation};

use super::NONE;

/// The numbers of the vertices and faces of one mesh. New elements get the next numbers.
pub(crate) struct Names<V: Handle, F: Handle> {
    /// Not handle maps, because these cannot be shared by threads.
    vertex_numbers: HashMap<V, u32>,
    face_numbers: HashMap<F, u32>,
    /// By number. `None` for a removed element.
    vertices: Vec<Option<V>>,
    faces: Vec<Option<F>>,
}

impl<V: Handle, F: Handle> Names<V, F> {
    /// Numbers the elements of a mesh that was built from `polygons`. Vertices that the structure
    /// merges share a handle, and the number of the first one.
    pub(crate) fn new<M>(polygons: &PolygonMesh) -> Self
    where
        M: Representation<Vertex = V, Face = F>,
    {
        let vertices: Vec<Option<V>> = polygons
            .vertices()
            .map(|v| Some(M::vertex_handle(polygons, v)))
            .collect();
        let faces: Vec<Option<F>> = (polygons.faces().iter())
            .map(|(f, _)| Some(M::face_handle(polygons, f)))
            .collect();
        // In reverse: of vertices that are merged, the first one remains.
        let numbered = |(number, v): (usize, &Option<V>)| Some(((*v)?, number as u32));
        let vertex_numbers = vertices.iter().enumerate().rev().filter_map(numbered);
        let numbered = |(number, f): (usize, &Option<F>)| Some(((*f)?, number as u32));
        let face_numbers = faces.iter().enumerate().filter_map(numbered);
        Self {
            vertex_numbers: vertex_numbers.collect(),
            face_numbers: face_numbers.collect(),
            vertices,
            faces,
        }
    }

    pub(crate) fn vertex_number(&self, v: V) -> u32 {
        self.vertex_numbers.get(&v).copied().unwrap_or(NONE)
    }

    pub(crate) fn face_number(&self, f: F) -> u32 {
        self.face_numbers.get(&f).copied().unwrap_or(NONE)
    }

    /// Returns the numbers of the ends of an edge, the smaller first.
    pub(crate) fn edge_name(&self, ends: [V; 2]) -> [u32; 2] {
        let [a, b] = ends.map(|v| self.vertex_number(v));
        [a.min(b), a.max(b)]
    }

    /// Returns the vertex with a number; `None` if it never existed or was removed.
    pub(crate) fn vertex(&self, number: u32) -> Option<V> {
        self.vertices.get(number as usize).copied().flatten()
    }

    /// Returns the face with a number; `None` if it never existed or was removed.
    pub(crate) fn face(&self, number: u32) -> Option<F> {
        self.faces.get(number as usize).copied().flatten()
    }

    /// Follows one edit. `mesh` is the mesh after the edit, and `record` has its changes. `affected`
    /// has the numbers of the faces that the edit cuts or merges.
    ///
    /// The faces that replace the affected faces are numbered by their corners, because structures
    /// differ in the face that keeps its handle: the list of the corner numbers of each face is
    /// sorted, then these lists are sorted. In this order, the faces get the numbers of the affected
    /// faces, the smallest first, and then new numbers.
    pub(crate) fn follow<M>(&mut self, mesh: &M, record: &EditRecord<M>, affected: &[u32])
    where
        M: MeshQuery<Vertex = V, Face = F>,
    {
        apply(
            &record.vertices,
            &mut self.vertex_numbers,
            &mut self.vertices,
        );
        for &new in &record.vertices.created {
            self.vertex_numbers.insert(new, self.vertices.len() as u32);
            self.vertices.push(Some(new));
        }
        apply(&record.faces, &mut self.face_numbers, &mut self.faces);
        let mut numbers = affected.to_vec();
        numbers.sort_unstable();
        let kept = numbers.iter().filter_map(|&number| self.face(number));
        let created = record.faces.created.iter().copied();
        let mut pieces: Vec<(Vec<u32>, F)> = kept
            .chain(created)
            .map(|f| {
                let corners = mesh.face_vertices(f).map(|v| self.vertex_number(v));
                let mut corners: Vec<u32> = corners.collect();
                corners.sort_unstable();
                (corners, f)
            })
            .collect();
        pieces.sort_unstable();
        for &number in &numbers {
            self.faces[number as usize] = None;
        }
        let mut numbers = numbers.into_iter();
        for (_, f) in pieces {
            let number = numbers.next().unwrap_or_else(|| {
                self.faces.push(None);
                (self.faces.len() - 1) as u32
            });
            self.faces[number as usize] = Some(f);
            self.face_numbers.insert(f, number);
        }
    }
}

/// Applies removals and new handles to the numbers of one kind of element.
fn apply<H: Handle>(
    changes: &Changes<H>,
    numbers: &mut HashMap<H, u32>,
    handles: &mut [Option<H>],
) {
    for old in &changes.removed {
        if let Some(number) = numbers.remove(old) {
            handles[number as usize] = None;
        }
    }
    // All at once, because elements may exchange handles.
    let renamed = changes.renamed.iter();
    let moved: Vec<(H, u32)> = renamed
        .filter_map(|[old, new]| Some((*new, numbers.remove(old)?)))
        .collect();
    for (new, number) in moved {
        numbers.insert(new, number);
        handles[number as usize] = Some(new);
    }
}
