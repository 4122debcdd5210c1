//! The one list of all representations.

use mesh_core::{
    BuildError, Capabilities, Edit, MeshEdit, PolygonMesh, QueryCost, Refine, Representation,
};

/// Work that is the same for every representation, chosen at run time.
///
/// One call picks the type; everything inside is static dispatch.
pub trait Visitor {
    /// What the work yields.
    type Output;

    /// Does the work on `M`.
    fn visit<M: Representation + 'static>(&mut self) -> Self::Output;
}

/// Calls a macro body once for each representation: `for_each_representation!(M => { … })`.
///
/// The body is compiled anew with `M` as each type in turn. A seventh structure is one line here.
#[macro_export]
macro_rules! for_each_representation {
    ($mesh:ident => $body:block) => {
        $crate::for_each_representation!(@each $mesh $body
            $crate::PolygonSoup,
            $crate::IndexedFaceSet,
            $crate::FaceVertexMesh,
            $crate::WingedEdgeMesh,
            $crate::HalfEdgeMesh,
            $crate::CornerTable,
        );
    };
    (@each $mesh:ident $body:block $($representation:ty,)+) => {
        $({
            type $mesh = $representation;
            $body
        })+
    };
}

/// Work that is the same for every structure that refines its own tables, chosen at run time.
pub trait RefineVisitor {
    /// What the work yields.
    type Output;

    /// Does the work on `M`.
    fn visit<M: Refine + 'static>(&mut self) -> Self::Output;
}

/// As [`for_each_representation!`](crate::for_each_representation), for those that refine their own tables.
#[macro_export]
macro_rules! for_each_refinable {
    ($mesh:ident => $body:block) => {
        $crate::for_each_representation!(@each $mesh $body
            $crate::FaceVertexMesh,
            $crate::WingedEdgeMesh,
            $crate::HalfEdgeMesh,
            $crate::CornerTable,
        );
    };
}

/// Work that is the same for every structure that can be edited, chosen at run time.
pub trait EditVisitor {
    /// What the work yields.
    type Output;

    /// Does the work on `M`.
    fn visit<M: Representation + MeshEdit + 'static>(&mut self) -> Self::Output;
}

/// As [`for_each_representation!`](crate::for_each_representation), for those that can be edited: all six,
/// as [`Editable`](mesh_core::Editable) meshes.
#[macro_export]
macro_rules! for_each_editable {
    ($mesh:ident => $body:block) => {
        $crate::for_each_representation!(@each $mesh $body
            $crate::EditablePolygonSoup,
            $crate::EditableIndexedFaceSet,
            $crate::EditableFaceVertexMesh,
            $crate::EditableWingedEdgeMesh,
            $crate::EditableHalfEdgeMesh,
            $crate::EditableCornerTable,
        );
    };
}

/// What the roster knows of one representation without building it.
#[derive(Clone, Copy, Debug)]
pub struct BackendInfo {
    /// What users call it.
    pub name: &'static str,
    /// What it can hold.
    pub capabilities: Capabilities,
    /// How much of the mesh each relation looks at.
    pub costs: [QueryCost; 9],
    /// How much of it each edit looks at, in the order of [`Edit::ALL`]; `None` where there is none.
    pub edits: [Option<QueryCost>; Edit::ALL.len()],
}

impl BackendInfo {
    /// The row of `M`, of whose edits nothing is known.
    pub const fn of<M: Representation>() -> Self {
        Self {
            name: M::NAME,
            capabilities: M::CAPABILITIES,
            costs: M::COSTS,
            edits: [None; Edit::ALL.len()],
        }
    }

    /// The row of `M`, which can be edited.
    pub const fn of_editable<M: Representation + MeshEdit>() -> Self {
        Self {
            edits: M::EDITS,
            ..Self::of::<M>()
        }
    }

    /// Whether the structure holds `polygons`, without building it.
    ///
    /// # Errors
    ///
    /// The refusal that building would give.
    pub fn verdict(&self, polygons: &PolygonMesh) -> Result<(), BuildError> {
        self.capabilities.check(polygons)
    }
}

/// What there is to know of every representation, in the order in which tables show them.
pub fn roster() -> Vec<BackendInfo> {
    let mut rows = Vec::new();
    for_each_editable!(M => { rows.push(BackendInfo::of_editable::<M>()); });
    rows
}

/// Does the work of `visitor` on every representation, in the order of [`roster`].
pub fn visit_all<V: Visitor>(visitor: &mut V) -> Vec<V::Output> {
    let mut outputs = Vec::new();
    for_each_representation!(M => { outputs.push(visitor.visit::<M>()); });
    outputs
}

/// Does the work of `visitor` on the representation called `name`; `None` if there is none.
pub fn visit<V: Visitor>(name: &str, visitor: &mut V) -> Option<V::Output> {
    for_each_representation!(M => {
        if name == M::NAME {
            return Some(visitor.visit::<M>());
        }
    });
    None
}

/// Does the work of `visitor` on the representation called `name`; `None` if there is none, or it
/// does not refine its own tables.
pub fn visit_refinable<V: RefineVisitor>(name: &str, visitor: &mut V) -> Option<V::Output> {
    for_each_refinable!(M => {
        if name == M::NAME {
            return Some(visitor.visit::<M>());
        }
    });
    None
}

/// Does the work of `visitor` on the representation called `name`; `None` if there is none, or it
/// cannot be edited.
pub fn visit_editable<V: EditVisitor>(name: &str, visitor: &mut V) -> Option<V::Output> {
    for_each_editable!(M => {
        if name == M::NAME {
            return Some(visitor.visit::<M>());
        }
    });
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Name;

    impl Visitor for Name {
        type Output = &'static str;

        fn visit<M: Representation + 'static>(&mut self) -> &'static str {
            M::NAME
        }
    }

    #[test]
    fn every_backend_is_found_by_its_name() {
        for backend in roster() {
            assert_eq!(visit(backend.name, &mut Name), Some(backend.name));
        }
        assert_eq!(visit("abacus", &mut Name), None);
    }
}
