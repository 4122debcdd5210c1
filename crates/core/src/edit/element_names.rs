//! The vertices and faces that names stand for, while edits change the mesh.

use std::collections::hash_map::Entry;

use rustc_hash::FxHashMap;
use smallvec::SmallVec;

use crate::edit::edit_call::EditOf;
use crate::edit::edit_log::{Changes, EditRecord};
use crate::edit::element_name::ElementName;
use crate::handles::handle::Handle;
use crate::handles::row_id::{FaceId, VertexId, row};
use crate::polygons::capability::coordinates;
use crate::polygons::polygon_mesh::PolygonMesh;
use crate::traits::query::MeshQuery;
use crate::traits::representation::Representation;

/// The vertices and faces of a mesh by number. A number means the same element on every structure
/// that accepts the same edits.
///
/// The elements of the mesh file have their numbers in the file, and elements that edits make have
/// the next numbers. An edge is named by the numbers of its ends ([`ElementName::Edge`]).
///
/// # Faces that an edit cuts or merges
///
/// Structures differ in the part of a cut face that keeps the handle. Names do not depend on
/// handles: the parts are sorted by the sorted numbers of their corners. The first part of a face
/// keeps the name of the face, and the other parts get new names. A face that replaces several
/// faces gets the lowest of their names. An edit that only changes corners, such as `split_edge` or
/// `flip_edge`, renames no face.
///
/// # Merged vertices
///
/// Vertices that a structure merges have one handle and several names. The first name counts as the
/// number of the vertex. When parts are sorted, every structure uses the first number at a position
/// of the mesh file, also if it does not merge vertices.
///
/// ```
/// use sixfold_core::{EditOf, EditRecord, ElementName, ElementNames, MeshEdit, Refusal};
///
/// /// Runs an edit, and returns the names of the new elements.
/// fn edit<M: MeshEdit>(
///     mesh: &mut M,
///     names: &mut ElementNames<M::Vertex, M::Face>,
///     edit: &EditOf<M>,
/// ) -> Result<Vec<ElementName>, Refusal<M>> {
///     let before = names.faces_before(mesh, edit);
///     let mut record = EditRecord::new();
///     edit.apply(mesh, &mut record)?;
///     Ok(names.follow(mesh, &record, &before).created)
/// }
/// ```
#[derive(Clone, Debug)]
pub struct ElementNames<V, F> {
    vertices: Numbered<V>,
    faces: Numbered<F>,
    /// By vertex of the mesh file: the first vertex at its position.
    first_here: Vec<u32>,
}

impl<V: Handle, F: Handle> ElementNames<V, F> {
    /// Names the elements of the structure `M` that was built from `polygons`. O(corners).
    pub fn new<M>(polygons: &PolygonMesh) -> Self
    where
        M: Representation<Vertex = V, Face = F>,
    {
        let (vertex, face) = (M::vertex_handle, M::face_handle);
        Self::from_handles(polygons, |v| vertex(polygons, v), |f| face(polygons, f))
    }

    /// Names the elements of `polygons` whose handles are given by functions.
    #[doc(hidden)]
    pub fn from_handles(
        polygons: &PolygonMesh,
        vertex: impl Fn(VertexId) -> V,
        face: impl Fn(FaceId) -> F,
    ) -> Self {
        let mut first_at: FxHashMap<[u32; 3], u32> = FxHashMap::default();
        let positions = polygons.positions().iter().zip(0..);
        let first_here = positions.map(|(&position, number)| {
            let first = first_at.entry(coordinates(position));
            *first.or_insert(number)
        });
        Self {
            first_here: first_here.collect(),
            vertices: Numbered::new(polygons.vertices().map(vertex)),
            faces: Numbered::new(polygons.faces().iter().map(|(f, _)| face(f))),
        }
    }

    /// Returns the vertex with a number; `None` if it never existed or was removed.
    pub fn vertex(&self, number: u32) -> Option<V> {
        self.vertices.handle(number)
    }

    /// Returns the face with a number; `None` if it never existed or was removed.
    pub fn face(&self, number: u32) -> Option<F> {
        self.faces.handle(number)
    }

    /// Returns the vertices by number; `None` for a removed one.
    pub fn vertices(&self) -> &[Option<V>] {
        &self.vertices.handles
    }

    /// Returns the faces by number; `None` for a removed one.
    pub fn faces(&self) -> &[Option<F>] {
        &self.faces.handles
    }

    /// Returns the number of a vertex, the lowest if it has several; `None` if it has no name.
    pub fn vertex_number(&self, v: V) -> Option<u32> {
        self.vertices.number(v)
    }

    /// Returns the number of a face; `None` if it has no name.
    pub fn face_number(&self, f: F) -> Option<u32> {
        self.faces.number(f)
    }

    /// Returns the numbers of the ends of an edge, the lower first; `None` if an end has no name.
    pub fn edge_numbers(&self, ends: [V; 2]) -> Option<[u32; 2]> {
        let [a, b] = ends.map(|v| self.vertex_number(v));
        let (a, b) = (a?, b?);
        Some([a.min(b), a.max(b)])
    }

    /// Returns the faces that `edit` may cut or merge: those at its edge, or its face. Call this
    /// before the edit.
    pub fn faces_before<M>(&self, mesh: &M, edit: &EditOf<M>) -> FacesBefore
    where
        M: MeshQuery<Vertex = V, Face = F>,
    {
        let at_edge = edit.edge().into_iter().flat_map(|&e| mesh.edge_faces(e));
        let faces = at_edge.chain(edit.face().copied());
        self.faces_before_by(faces, |f| mesh.face_vertices(f).collect())
    }

    /// Does the same as [`faces_before`](Self::faces_before). `corners` returns the corners of a
    /// face.
    #[doc(hidden)]
    pub fn faces_before_by(
        &self,
        faces: impl Iterator<Item = F>,
        corners: impl Fn(F) -> Vec<V>,
    ) -> FacesBefore {
        let faces = faces.filter_map(|f| {
            // A refused edit may name a face that does not exist.
            let number = self.face_number(f)?;
            let corners = corners(f).into_iter().filter_map(|v| self.place(v));
            Some((number, sorted(corners)))
        });
        FacesBefore(faces.collect())
    }

    /// Follows one accepted edit: `mesh` is the mesh after the edit, `record` has its changes, and
    /// `before` is the result of [`faces_before`](Self::faces_before). Returns the names that
    /// changed.
    pub fn follow<M>(
        &mut self,
        mesh: &M,
        record: &EditRecord<M>,
        before: &FacesBefore,
    ) -> NameChanges<V, F>
    where
        M: MeshQuery<Vertex = V, Face = F>,
    {
        let corners = |f| mesh.face_vertices(f).collect();
        self.follow_by(&record.vertices, &record.faces, before, corners)
    }

    /// Does the same as [`follow`](Self::follow). `corners` returns the corners of a face after the
    /// edit.
    #[doc(hidden)]
    pub fn follow_by(
        &mut self,
        vertices: &Changes<V>,
        faces: &Changes<F>,
        before: &FacesBefore,
        corners: impl Fn(F) -> Vec<V>,
    ) -> NameChanges<V, F> {
        let first_new = row(self.vertices.handles.len());
        let mut old_vertices = self.vertices.apply(vertices);
        for &new in &vertices.created {
            old_vertices.push((self.vertices.push(new), None));
        }
        let cut = before.0.iter().map(|&(f, _)| (f, self.face(f)));
        let mut old_faces: Vec<_> = cut.collect();
        old_faces.extend(self.faces.apply(faces));
        if !(faces.created.is_empty() && faces.removed.is_empty()) {
            let rest = before.0.iter().filter_map(|&(f, _)| self.face(f));
            let parts = rest.chain(faces.created.iter().copied());
            let mut parts: Vec<Part<F>> = parts
                .map(|face| {
                    let cycle: Vec<u32> = (corners(face).into_iter())
                        .filter_map(|v| self.place(v))
                        .collect();
                    Part {
                        corners: sorted(cycle.iter().copied()),
                        cycle: from_lowest(cycle),
                        face,
                    }
                })
                .collect();
            parts.sort_unstable();
            old_faces.extend(self.name_parts(&parts, before, first_new));
        }
        let mut changes = NameChanges::default();
        let (vertex, face) = (ElementName::Vertex, ElementName::Face);
        changes.moved_vertices = changes.add(old_vertices, &self.vertices.handles, vertex);
        changes.moved_faces = changes.add(old_faces, &self.faces.handles, face);
        changes
    }

    /// Returns the number by which corners are compared.
    fn place(&self, v: V) -> Option<u32> {
        let number = self.vertex_number(v)?;
        let first = self.first_here.get(number as usize);
        Some(first.copied().unwrap_or(number))
    }

    /// Gives the sorted `parts` their numbers. Returns the new numbers.
    fn name_parts(
        &mut self,
        parts: &[Part<F>],
        before: &FacesBefore,
        first_new: u32,
    ) -> Vec<(u32, Option<F>)> {
        for &(number, _) in &before.0 {
            self.faces.forget(number);
        }
        let mut free = before.0.clone();
        free.sort_unstable_by_key(|(number, corners)| (corners.len(), *number));
        let mut new = Vec::new();
        for part in parts {
            // Whether the part was cut from a face with these corners.
            let is_of = |corners: &[u32]| {
                let mut old = part.corners.iter().take_while(|&&v| v < first_new);
                old.all(|v| corners.binary_search(v).is_ok())
            };
            // A face that replaces several is part of none, and takes the lowest name.
            let is_merged = !before.0.iter().any(|(_, corners)| is_of(corners));
            let place = match is_merged {
                true => (0..free.len()).min_by_key(|&i| free[i].0),
                false => free.iter().position(|(_, corners)| is_of(corners)),
            };
            match place {
                Some(place) => self.faces.set(free.remove(place).0, part.face),
                None => new.push((self.faces.push(part.face), None)),
            }
        }
        new
    }
}

/// The faces that an edit may cut or merge: their numbers, and the sorted numbers of their corners.
#[derive(Clone, Debug, Default)]
pub struct FacesBefore(Vec<(u32, Vec<u32>)>);

/// The names that one edit changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameChanges<V, F> {
    /// The names of new elements: vertices, then faces.
    pub created: Vec<ElementName>,
    /// The names of removed elements: vertices, then faces.
    pub removed: Vec<ElementName>,
    /// The numbers of vertices that have another handle, with the old and the new handle.
    pub moved_vertices: Vec<(u32, [V; 2])>,
    /// The numbers of faces that have another handle, with the old and the new handle.
    pub moved_faces: Vec<(u32, [F; 2])>,
}

impl<V, F> Default for NameChanges<V, F> {
    fn default() -> Self {
        Self {
            created: Vec::new(),
            removed: Vec::new(),
            moved_vertices: Vec::new(),
            moved_faces: Vec::new(),
        }
    }
}

impl<V, F> NameChanges<V, F> {
    /// Adds the numbers of one kind of element, with the handles that they had before the edit.
    /// Returns those that now have another handle.
    fn add<H: Handle>(
        &mut self,
        mut old: Vec<(u32, Option<H>)>,
        handles: &[Option<H>],
        name: fn(u32) -> ElementName,
    ) -> Vec<(u32, [H; 2])> {
        // The first entry of a number has its handle before the edit.
        old.sort_by_key(|&(number, _)| number);
        old.dedup_by_key(|(number, _)| *number);
        let mut moved = Vec::new();
        for (number, before) in old {
            match (before, handles[number as usize]) {
                (None, Some(_)) => self.created.push(name(number)),
                (Some(_), None) => self.removed.push(name(number)),
                (Some(before), Some(after)) if before != after => {
                    moved.push((number, [before, after]));
                }
                _ => {}
            }
        }
        moved
    }
}

/// A face after an edit, in the order in which faces are named.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Part<F> {
    corners: Vec<u32>,
    /// The corners around the face, from the lowest.
    cycle: Vec<u32>,
    face: F,
}

/// The elements of one kind by number.
#[derive(Clone, Debug)]
struct Numbered<H> {
    /// `None` for a removed element.
    handles: Vec<Option<H>>,
    /// The numbers of a handle, ascending. Not a handle map, because threads cannot share these.
    numbers: FxHashMap<H, SmallVec<[u32; 1]>>,
}

impl<H: Handle> Numbered<H> {
    fn new(handles: impl Iterator<Item = H>) -> Self {
        let mut numbered = Self {
            handles: Vec::new(),
            numbers: FxHashMap::default(),
        };
        for handle in handles {
            numbered.push(handle);
        }
        numbered
    }

    fn handle(&self, number: u32) -> Option<H> {
        self.handles.get(number as usize).copied().flatten()
    }

    fn number(&self, handle: H) -> Option<u32> {
        self.numbers.get(&handle)?.first().copied()
    }

    /// Gives an element the next number, and returns this number.
    fn push(&mut self, handle: H) -> u32 {
        let number = row(self.handles.len());
        self.handles.push(None);
        self.set(number, handle);
        number
    }

    /// Gives a number without an element to an element.
    fn set(&mut self, number: u32, handle: H) {
        self.handles[number as usize] = Some(handle);
        let numbers = self.numbers.entry(handle).or_default();
        let place = numbers.partition_point(|&known| known < number);
        numbers.insert(place, number);
    }

    /// Takes a number from its element, if it has one.
    fn forget(&mut self, number: u32) {
        let Some(handle) = self.handles[number as usize].take() else {
            return;
        };
        if let Entry::Occupied(mut numbers) = self.numbers.entry(handle) {
            numbers.get_mut().retain(|known| *known != number);
            if numbers.get().is_empty() {
                numbers.remove();
            }
        }
    }

    /// Applies removals and new handles. Returns the numbers of these elements, with their handles
    /// before.
    fn apply(&mut self, changes: &Changes<H>) -> Vec<(u32, Option<H>)> {
        let mut before = Vec::new();
        let mut take = |old: H| {
            let numbers = self.numbers.remove(&old).unwrap_or_default();
            for &number in &numbers {
                before.push((number, self.handles[number as usize].take()));
            }
            numbers
        };
        for &old in &changes.removed {
            take(old);
        }
        // All at once, because elements may exchange handles.
        let renamed = changes.renamed.iter().map(|&[old, new]| (new, take(old)));
        let renamed: Vec<_> = renamed.collect();
        for (new, numbers) in renamed {
            for number in numbers {
                self.set(number, new);
            }
        }
        before
    }
}

fn sorted(numbers: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut numbers: Vec<u32> = numbers.collect();
    numbers.sort_unstable();
    numbers
}

/// Rotates the corners of a face, so that the lowest is the first.
fn from_lowest(mut corners: Vec<u32>) -> Vec<u32> {
    let lowest = (0..corners.len()).min_by_key(|&i| corners[i]);
    corners.rotate_left(lowest.unwrap_or(0));
    corners
}
