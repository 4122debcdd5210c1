//! The elements of a mesh before and after steps: the trace of one step, and the maps of a repair.

use std::marker::PhantomData;
use std::ops::Range;

use sixfold_core::{
    FaceId, FaceList, Point, PolygonError, PolygonMesh, RowId, Slot, VertexId, row,
};

sixfold_core::row_id! {
    /// A corner of a face, numbered over all faces; printed as `c7`.
    pub(crate) struct CornerId, "c"
}

/// Where the elements of a changed mesh come from.
///
/// Corners are traced, not only vertices: if vertices are merged and then separated again, the
/// corners show which of the new vertices belongs to which of the old ones.
#[derive(Clone, Debug)]
pub(crate) struct Trace {
    /// By new face: the old face.
    pub(crate) faces: Vec<Slot<FaceId>>,
    /// By new corner: the old corner.
    pub(crate) corners: Vec<Slot<CornerId>>,
    /// The vertices, which need not have corners.
    pub(crate) vertices: VertexTrace,
}

/// Where the vertices of a changed mesh come from.
#[derive(Clone, Debug)]
pub(crate) struct VertexTrace {
    /// By old vertex: a vertex that has replaced it; empty if it was removed.
    pub(crate) replacements: Vec<Slot<VertexId>>,
    /// By new vertex: an old vertex that it has replaced.
    pub(crate) origins: Vec<Slot<VertexId>>,
}

impl VertexTrace {
    /// Returns the trace of a step that keeps all vertices.
    pub(crate) fn identity(polygons: &PolygonMesh) -> Self {
        let same: Vec<Slot<VertexId>> = polygons.vertices().map(Slot::some).collect();
        Self {
            replacements: same.clone(),
            origins: same,
        }
    }
}

impl Trace {
    /// Returns the trace of two steps, one after the other.
    pub(crate) fn then(&self, next: &Self) -> Self {
        Self {
            faces: composed(&next.faces, &self.faces),
            corners: composed(&next.corners, &self.corners),
            vertices: VertexTrace {
                replacements: composed(&self.vertices.replacements, &next.vertices.replacements),
                origins: composed(&next.vertices.origins, &self.vertices.origins),
            },
        }
    }
}

/// Returns `second[first[i]]` for each `i`.
fn composed<A: RowId, B: RowId>(first: &[Slot<A>], second: &[Slot<B>]) -> Vec<Slot<B>> {
    let target = |at: &Slot<A>| at.get().map(|at| second[at.row() as usize]);
    let targets = first.iter().map(target);
    targets.map(|slot| slot.unwrap_or(Slot::NONE)).collect()
}

/// Builds the faces of a changed mesh and their trace.
pub(crate) struct Rebuild<'a> {
    old: &'a PolygonMesh,
    faces: FaceList,
    origins: Vec<Slot<FaceId>>,
    corners: Vec<Slot<CornerId>>,
}

impl<'a> Rebuild<'a> {
    pub(crate) fn new(old: &'a PolygonMesh) -> Self {
        Self {
            old,
            faces: FaceList::with_capacity(old.corner_count()),
            origins: Vec::with_capacity(old.face_count()),
            corners: Vec::with_capacity(old.corner_count()),
        }
    }

    /// Adds a face. Each corner is a new vertex and the old corner that it comes from.
    pub(crate) fn push(
        &mut self,
        origin: Option<FaceId>,
        corners: impl Iterator<Item = (VertexId, Option<CornerId>)>,
    ) -> Result<(), PolygonError> {
        let traced = &mut self.corners;
        let vertices = corners.map(|(v, corner)| {
            traced.push(corner.into());
            v
        });
        self.faces.push(vertices)?;
        self.origins.push(origin.into());
        Ok(())
    }

    /// Adds face `f` of the old mesh; `number` returns the new vertex at an old corner.
    pub(crate) fn keep(
        &mut self,
        f: FaceId,
        number: impl Fn(VertexId, CornerId) -> VertexId,
    ) -> Result<(), PolygonError> {
        let corners = corners_of(self.old, f);
        self.push(Some(f), corners.map(|(v, c)| (number(v, c), Some(c))))
    }

    /// Returns the mesh with the vertices at `positions`.
    pub(crate) fn finish(
        self,
        positions: Vec<Point>,
        vertices: VertexTrace,
    ) -> Result<(PolygonMesh, Trace), PolygonError> {
        let trace = Trace {
            faces: self.origins,
            corners: self.corners,
            vertices,
        };
        Ok((PolygonMesh::from_faces(positions, self.faces)?, trace))
    }

    /// Returns the mesh with the vertices of the old one.
    pub(crate) fn finish_with_old_vertices(self) -> Result<(PolygonMesh, Trace), PolygonError> {
        let vertices = VertexTrace::identity(self.old);
        let positions = self.old.positions().to_vec();
        self.finish(positions, vertices)
    }
}

/// Returns the corners of `f` with their vertices, in order.
pub(crate) fn corners_of(
    polygons: &PolygonMesh,
    f: FaceId,
) -> impl Iterator<Item = (VertexId, CornerId)> + Clone {
    let faces = polygons.faces();
    let first = row(faces.range(f).start);
    let corners = (first..).map(CornerId::new);
    faces.face(f).iter().copied().zip(corners)
}

/// A map between the elements of a mesh before and after a repair, in both directions.
///
/// One old element can have several new ones (a vertex that was cut into fans, a polygon that was
/// cut into triangles), and one new element several old ones (welded vertices).
///
/// ```
/// use sixfold_core::{FaceId, PolygonMesh};
/// use sixfold_repair::{Step, repair};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let twice = PolygonMesh::new(corners, [[0, 1, 2], [1, 2, 0]])?;
/// let repaired = repair(&twice, &[Step::RemoveDuplicateFaces(Default::default())])?;
/// assert_eq!(repaired.faces.new_elements(FaceId::new(0)), [FaceId::new(0)]);
/// assert!(repaired.faces.new_elements(FaceId::new(1)).is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ElementMap<H> {
    new_of_old: Lists<H>,
    old_of_new: Lists<H>,
}

impl<H: RowId> ElementMap<H> {
    /// Builds a map from pairs of an old and a new element; O(n log n).
    fn from_pairs(old: usize, new: usize, mut pairs: Vec<[H; 2]>) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        let new_of_old = Lists::from_sorted(old, &pairs);
        for pair in &mut pairs {
            pair.reverse();
        }
        pairs.sort_unstable();
        let old_of_new = Lists::from_sorted(new, &pairs);
        Self {
            new_of_old,
            old_of_new,
        }
    }

    fn identity(elements: usize) -> Self {
        let same = Lists::Identity(elements, PhantomData);
        Self {
            new_of_old: same.clone(),
            old_of_new: same,
        }
    }

    /// Returns whether every element is unchanged.
    pub fn is_identity(&self) -> bool {
        matches!(self.new_of_old, Lists::Identity(..))
    }

    /// Returns the number of elements before the repair.
    pub fn old_count(&self) -> usize {
        self.new_of_old.len()
    }

    /// Returns the number of elements after the repair.
    pub fn new_count(&self) -> usize {
        self.old_of_new.len()
    }

    /// Returns the elements that `old` has become, ascending; none if it was removed.
    ///
    /// # Panics
    ///
    /// Panics if the old mesh has no such element.
    pub fn new_elements(&self, old: H) -> Vec<H> {
        self.new_of_old.list(old)
    }

    /// Returns the elements from which `new` was made, ascending; none if it was added.
    ///
    /// # Panics
    ///
    /// Panics if the new mesh has no such element.
    pub fn old_elements(&self, new: H) -> Vec<H> {
        self.old_of_new.list(new)
    }
}

/// One list of elements for each element.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Lists<H> {
    /// Each list contains only the element itself.
    Identity(usize, PhantomData<H>),
    /// `items[starts[i]..starts[i + 1]]` is the list of element `i`.
    Table { starts: Vec<u32>, items: Vec<H> },
}

impl<H: RowId> Lists<H> {
    /// Builds the lists from pairs that are sorted by their first element.
    fn from_sorted(elements: usize, pairs: &[[H; 2]]) -> Self {
        let mut starts = vec![0_u32; elements + 1];
        for [from, _] in pairs {
            starts[from.row() as usize + 1] += 1;
        }
        for i in 0..elements {
            starts[i + 1] += starts[i];
        }
        let items = pairs.iter().map(|&[_, to]| to).collect();
        Self::Table { starts, items }
    }

    fn len(&self) -> usize {
        match self {
            Self::Identity(elements, _) => *elements,
            Self::Table { starts, .. } => starts.len() - 1,
        }
    }

    fn list(&self, of: H) -> Vec<H> {
        let i = of.row() as usize;
        assert!(
            i < self.len(),
            "no element {of:?}: there are {}",
            self.len()
        );
        match self {
            Self::Identity(..) => vec![of],
            Self::Table { starts, items } => {
                let range: Range<usize> = starts[i] as usize..starts[i + 1] as usize;
                items[range].to_vec()
            }
        }
    }
}

/// Returns the maps of vertices and of faces from `old` to `new`; `None` as a trace means that the
/// mesh is unchanged.
pub(crate) fn element_maps(
    old: &PolygonMesh,
    new: &PolygonMesh,
    trace: Option<&Trace>,
) -> (ElementMap<VertexId>, ElementMap<FaceId>) {
    let Some(trace) = trace else {
        let vertices = ElementMap::identity(old.vertex_count());
        return (vertices, ElementMap::identity(old.face_count()));
    };
    let (before, after) = (old.faces().corners(), new.faces().corners());
    let mut has_new = vec![false; old.vertex_count()];
    let mut has_old = vec![false; new.vertex_count()];
    let mut pairs = Vec::with_capacity(after.len());
    for (&to, origin) in after.iter().zip(&trace.corners) {
        if let Some(corner) = origin.get() {
            let from = before[corner.index()];
            has_new[from.index()] = true;
            has_old[to.index()] = true;
            pairs.push([from, to]);
        }
    }
    // Vertices without a corner, before or after.
    for (from, to) in old.vertices().zip(&trace.vertices.replacements) {
        let to = to.get().filter(|_| !has_new[from.index()]);
        pairs.extend(to.map(|to| [from, to]));
    }
    for (to, from) in new.vertices().zip(&trace.vertices.origins) {
        let from = from.get().filter(|_| !has_old[to.index()]);
        pairs.extend(from.map(|from| [from, to]));
    }
    let vertices = ElementMap::from_pairs(old.vertex_count(), new.vertex_count(), pairs);
    let origins = (0..).map(FaceId::new).zip(&trace.faces);
    let pairs = origins.filter_map(|(to, from)| from.get().map(|from| [from, to]));
    let faces = ElementMap::from_pairs(old.face_count(), new.face_count(), pairs.collect());
    (vertices, faces)
}
