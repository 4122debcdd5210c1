//! A mesh together with data that every edit updates.

use std::fmt;
use std::marker::PhantomData;

use crate::Point;
use crate::edit::edit_kind::Edit;
use crate::edit::edit_log::{EditLog, EditRecord};
use crate::edit::follow_edits::{AcceptedEdit, FollowEdits, Source};
use crate::edit::mesh_edit::{MeshEdit, Refusal};
use crate::polygons::capability::Capabilities;
use crate::polygons::error::{InvariantError, MoveError};
use crate::traits::local_queries::{CostsAreLocal, LocalQueries};
use crate::traits::mesh_move::MeshMove;
use crate::traits::oriented_walk::{OrientedWalk, SideMap};
use crate::traits::query::{MeshQuery, VertexMap};
use crate::traits::representation::{QueryCost, Representation};

/// A mesh together with data by vertex, edge or face. Every edit of the mesh also updates the data.
///
/// This type implements [`MeshQuery`], [`OrientedWalk`], [`MeshMove`] and [`MeshEdit`] with the
/// handles of the mesh `M`, if `M` implements them. A `MeshWithData` can therefore be passed to every
/// algorithm that walks along, moves or edits meshes, such as decimation and remeshing. After each edit, the data `D` is updated through [`FollowEdits`]. `D` is usually
/// [`VertexData`](crate::VertexData), [`EdgeData`](crate::EdgeData), [`FaceData`](crate::FaceData),
/// or a tuple or vector of these types. The data `()` costs nothing.
///
/// The mesh can be changed only by the edits of `MeshWithData`.
///
/// ```
/// use sixfold_core::{EdgeData, FaceData, MeshEdit, MeshQuery, MeshWithData, Point, Refusal};
///
/// /// Splits an edge of a mesh with sharp edges and materials of faces.
/// fn example<M: MeshEdit>(mesh: M, e: M::Edge) -> Result<(), Refusal<M>> {
///     let sharpness = EdgeData::new(&mesh, 0.0_f32);
///     let material = FaceData::new(&mesh, 1_u8).with_rule(|material, new| {
///         new.parents.first().map_or(0, |&f| material[f])
///     });
///     let mut mesh = MeshWithData::new(mesh, (sharpness, material));
///     mesh.data_mut().0[e] = 2.5;
///
///     let middle = mesh.bisect_edge(e, Point::ZERO)?;
///     for f in mesh.vertex_faces(middle) {
///         assert_eq!(mesh.data().1[f], 1); // new faces have the material of the cut faces
///     }
///     let spoke = mesh.vertex_edges(middle).next().expect("it has at least two");
///     mesh.data_mut().0[spoke] = 1.0; // data of new elements can be changed after the edit
///
///     let (mesh, (sharpness, _)) = mesh.into_parts();
///     assert_eq!(sharpness[spoke], 1.0);
///     # let _ = mesh;
///     Ok(())
/// }
/// ```
pub struct MeshWithData<M: MeshQuery, D> {
    mesh: M,
    data: D,
    /// The changes by the last edit; kept so that the memory is reused.
    changes: EditRecord<M>,
}

impl<M: MeshQuery, D> MeshWithData<M, D> {
    /// Combines a mesh with data that describes its elements.
    pub fn new(mesh: M, data: D) -> Self {
        Self {
            mesh,
            data,
            changes: EditRecord::new(),
        }
    }

    /// Returns the mesh.
    #[inline]
    pub fn mesh(&self) -> &M {
        &self.mesh
    }

    /// Returns the data.
    #[inline]
    pub fn data(&self) -> &D {
        &self.data
    }

    /// Returns the data for writing.
    #[inline]
    pub fn data_mut(&mut self) -> &mut D {
        &mut self.data
    }

    /// Returns the mesh and the data.
    pub fn into_parts(self) -> (M, D) {
        (self.mesh, self.data)
    }
}

impl<M: Representation, D> MeshWithData<M, D> {
    /// Checks all numbered invariants of the structure; O(corners) expected.
    ///
    /// # Errors
    ///
    /// Fails like [`Representation::validate`].
    pub fn validate(&self) -> Result<(), InvariantError> {
        self.mesh.validate()
    }
}

impl<M: MeshQuery, D: FollowEdits<M>> MeshWithData<M, D> {
    /// Does an edit, passes its changes to `log`, and then updates the data.
    #[inline]
    fn edit<L: EditLog<Self>, T>(
        &mut self,
        source: impl FnOnce(&M) -> Source<M>,
        log: &mut L,
        edit: impl FnOnce(&mut M, &mut Reports<'_, M, D, L>) -> T,
    ) -> T {
        let source = if self.data.uses_parents() {
            source(&self.mesh)
        } else {
            Source::Nothing
        };
        if D::USES_CHANGES {
            self.changes.clear();
        }
        let mut reports = Reports {
            changes: &mut self.changes,
            log,
            data: PhantomData,
        };
        let outcome = edit(&mut self.mesh, &mut reports);
        // A refused edit reports nothing.
        if D::USES_CHANGES && !self.changes.is_empty() {
            self.data.follow(&AcceptedEdit {
                mesh: &self.mesh,
                changes: &self.changes,
                source,
            });
        }
        outcome
    }
}

impl<M: MeshQuery + Clone, D: Clone> Clone for MeshWithData<M, D> {
    fn clone(&self) -> Self {
        Self::new(self.mesh.clone(), self.data.clone())
    }
}

impl<M: MeshQuery + fmt::Debug, D: fmt::Debug> fmt::Debug for MeshWithData<M, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MeshWithData")
            .field("mesh", &self.mesh)
            .field("data", &self.data)
            .finish()
    }
}

/// A log that passes reports to `log`, and also to `changes` if the data uses the changes.
struct Reports<'a, M: MeshQuery, D, L> {
    changes: &'a mut EditRecord<M>,
    log: &'a mut L,
    data: PhantomData<D>,
}

impl<M, D, L> EditLog<M> for Reports<'_, M, D, L>
where
    M: MeshQuery,
    D: FollowEdits<M>,
    L: EditLog<MeshWithData<M, D>>,
{
    const USES_REPORTS: bool = D::USES_CHANGES || L::USES_REPORTS;

    crate::pass_reports_on!(changes if D::USES_CHANGES, log);
}

/// Forwards each query or step to the mesh.
macro_rules! queries {
    ($($query:ident($($argument:ident: $kind:ty),*) -> $answer:ty;)+) => {$(
        #[inline]
        fn $query(&self $(, $argument: $kind)*) -> $answer {
            self.mesh.$query($($argument),*)
        }
    )+};
}

impl<M: MeshQuery, D> MeshQuery for MeshWithData<M, D> {
    type Vertex = M::Vertex;
    type Edge = M::Edge;
    type Face = M::Face;

    const CAPABILITIES: Capabilities = M::CAPABILITIES;

    queries! {
        vertices() -> impl Iterator<Item = M::Vertex>;
        edges() -> impl Iterator<Item = M::Edge>;
        faces() -> impl Iterator<Item = M::Face>;
        vertex_count() -> usize;
        edge_count() -> usize;
        face_count() -> usize;
        position(v: M::Vertex) -> Point;
        vertex_vertices(v: M::Vertex) -> impl Iterator<Item = M::Vertex>;
        vertex_edges(v: M::Vertex) -> impl Iterator<Item = M::Edge>;
        vertex_faces(v: M::Vertex) -> impl Iterator<Item = M::Face>;
        edge_vertices(e: M::Edge) -> [M::Vertex; 2];
        edge_edges(e: M::Edge) -> impl Iterator<Item = M::Edge>;
        edge_faces(e: M::Edge) -> impl Iterator<Item = M::Face>;
        face_vertices(f: M::Face) -> impl Iterator<Item = M::Vertex>;
        face_edges(f: M::Face) -> impl Iterator<Item = M::Edge>;
        face_faces(f: M::Face) -> impl Iterator<Item = M::Face>;
        edge_between(a: M::Vertex, b: M::Vertex) -> Option<M::Edge>;
        common_face(a: M::Vertex, b: M::Vertex) -> Option<M::Face>;
        opposite_vertex(f: M::Face, e: M::Edge) -> Option<M::Vertex>;
        valence(v: M::Vertex) -> usize;
        degree(f: M::Face) -> usize;
        is_boundary_edge(e: M::Edge) -> bool;
        is_boundary_vertex(v: M::Vertex) -> bool;
        contains_vertex(v: M::Vertex) -> bool;
        contains_edge(e: M::Edge) -> bool;
        contains_face(f: M::Face) -> bool;
        vertex_rows() -> usize;
        edge_rows() -> usize;
        face_rows() -> usize;
        one_ring(v: M::Vertex) -> Option<impl Iterator<Item = M::Vertex>>;
    }
}

impl<M: LocalQueries, D> LocalQueries for MeshWithData<M, D> {
    const COSTS_ARE_LOCAL: CostsAreLocal = M::COSTS_ARE_LOCAL;
}

impl<M: OrientedWalk, D> OrientedWalk for MeshWithData<M, D> {
    type Side = M::Side;

    queries! {
        face_sides(f: M::Face) -> impl Iterator<Item = M::Side>;
        edge_sides(e: M::Edge) -> impl Iterator<Item = M::Side>;
        outgoing_sides(v: M::Vertex) -> impl Iterator<Item = M::Side>;
        next_side(s: M::Side) -> M::Side;
        prev_side(s: M::Side) -> M::Side;
        twin_side(s: M::Side) -> Option<M::Side>;
        side_origin(s: M::Side) -> M::Vertex;
        side_target(s: M::Side) -> M::Vertex;
        side_face(s: M::Side) -> M::Face;
        side_edge(s: M::Side) -> M::Edge;
        ccw_side(s: M::Side) -> Option<M::Side>;
        cw_side(s: M::Side) -> Option<M::Side>;
        sides() -> impl Iterator<Item = M::Side>;
        side_count() -> usize;
    }

    #[inline]
    fn side_map<T: Clone>(&self, value: T) -> SideMap<Self, T> {
        self.mesh.side_map(value)
    }
}

impl<M: MeshMove, D: FollowEdits<M>> MeshMove for MeshWithData<M, D> {
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError> {
        self.edit(
            |_| Source::Nothing,
            log,
            |mesh, log| mesh.set_positions_logged(positions, log),
        )
    }
}

/// Forwards each edit to the mesh. `splits` names the kind of the element that the edit splits, and
/// its argument.
macro_rules! edits {
    ($($edit:ident($($argument:ident: $kind:ty),*) -> $outcome:ty, splits $split:ident($($element:ident)?);)+) => {$(
        #[inline]
        fn $edit(&mut self, $($argument: $kind,)* log: &mut impl EditLog<Self>) -> $outcome {
            self.edit(
                |mesh| Source::$split(mesh $(, $element)?),
                log,
                |mesh, log| mesh.$edit($($argument,)* log),
            )
        }
    )+};
}

impl<M: MeshEdit, D: FollowEdits<M>> MeshEdit for MeshWithData<M, D> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = M::EDITS;

    type Compact = MeshWithData<M::Compact, D>;

    /// Removes the rows of deleted elements (holes), updates the data, and converts to a mesh that
    /// cannot have holes.
    fn into_compact(mut self) -> Self::Compact {
        self.compact();
        MeshWithData::new(self.mesh.into_compact(), self.data)
    }

    fn from_compact(compact: Self::Compact) -> Self {
        Self::new(M::from_compact(compact.mesh), compact.data)
    }

    edits! {
        set_position_logged(v: M::Vertex, to: Point) -> Result<M::Vertex, Refusal<M>>, splits nothing();
        add_vertex_logged(at: Point) -> Result<M::Vertex, Refusal<M>>, splits nothing();
        add_face_logged(corners: &[M::Vertex]) -> Result<M::Face, Refusal<M>>, splits nothing();
        remove_face_logged(f: M::Face) -> Result<(), Refusal<M>>, splits nothing();
        remove_faces_logged(faces: &[M::Face]) -> Result<(), Refusal<M>>, splits nothing();
        remove_vertex_logged(v: M::Vertex) -> Result<(), Refusal<M>>, splits nothing();
        remove_isolated_vertices_logged() -> usize, splits nothing();
        split_edge_logged(e: M::Edge, at: Point) -> Result<M::Vertex, Refusal<M>>, splits edge(e);
        bisect_edge_logged(e: M::Edge, at: Point) -> Result<M::Vertex, Refusal<M>>, splits edge(e);
        poke_face_logged(f: M::Face, at: Point) -> Result<M::Vertex, Refusal<M>>, splits face(f);
        split_face_logged(f: M::Face, ends: [M::Vertex; 2]) -> Result<M::Edge, Refusal<M>>, splits face(f);
        dissolve_edge_logged(e: M::Edge) -> Result<M::Face, Refusal<M>>, splits nothing();
        flip_edge_logged(e: M::Edge) -> Result<M::Edge, Refusal<M>>, splits nothing();
        collapse_edge_logged(e: M::Edge, keep: M::Vertex, to: Point) -> Result<M::Vertex, Refusal<M>>, splits nothing();
        split_vertex_logged(v: M::Vertex, left: Option<M::Vertex>, right: Option<M::Vertex>, at: Point) -> Result<M::Vertex, Refusal<M>>, splits vertex(v);
        compact_logged() -> (), splits nothing();
    }
}
