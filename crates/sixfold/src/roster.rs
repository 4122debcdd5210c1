//! The list of all structures.

use sixfold_core::{
    BuildError, Capabilities, Edit, MeshEdit, PolygonMesh, QueryCost, Refine, Representation,
};

/// A generic function for any structure that is selected at run time.
///
/// One call selects the type; everything inside uses static dispatch.
pub trait Visitor {
    /// Result of a visit.
    type Output;

    /// Visits the structure `M`.
    fn visit<M: Representation + 'static>(&mut self) -> Self::Output;
}

/// Repeats a macro body for each structure: `for_each_representation!(M => { … })`.
///
/// The body is compiled once for each structure, with `M` as an alias of its type. A seventh
/// structure is added with one line here.
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

/// A generic function for any structure that refines its own tables and is selected at run time.
pub trait RefineVisitor {
    /// Result of a visit.
    type Output;

    /// Visits the structure `M`.
    fn visit<M: Refine + 'static>(&mut self) -> Self::Output;
}

/// Repeats a macro body for each structure that refines its own tables, like
/// [`for_each_representation!`](crate::for_each_representation).
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

/// A generic function for any structure that can be edited and is selected at run time.
pub trait EditVisitor {
    /// Result of a visit.
    type Output;

    /// Visits the structure `M`.
    fn visit<M: Representation + MeshEdit + 'static>(&mut self) -> Self::Output;
}

/// Repeats a macro body for each structure that can be edited, like
/// [`for_each_representation!`](crate::for_each_representation). These are all six structures, as
/// [`Editable`](sixfold_core::Editable) meshes.
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

/// Properties of one structure that do not depend on a mesh.
#[derive(Clone, Copy, Debug)]
pub struct BackendInfo {
    /// Name for users.
    pub name: &'static str,
    /// The meshes that it can hold.
    pub capabilities: Capabilities,
    /// How much of the mesh each relation reads.
    pub costs: [QueryCost; 9],
    /// How much of the mesh each edit reads, in the order of [`Edit::ALL`]; `None` if the edit is
    /// not available.
    pub edits: [Option<QueryCost>; Edit::ALL.len()],
}

impl BackendInfo {
    /// Returns the properties of `M`, without edits.
    pub const fn new<M: Representation>() -> Self {
        Self {
            name: M::NAME,
            capabilities: M::CAPABILITIES,
            costs: M::COSTS,
            edits: [None; Edit::ALL.len()],
        }
    }

    /// Returns the properties of `M`, including its edits.
    pub const fn with_edits<M: Representation + MeshEdit>() -> Self {
        Self {
            edits: M::EDITS,
            ..Self::new::<M>()
        }
    }

    /// Checks whether the structure can hold `polygons`, without building it.
    ///
    /// # Errors
    ///
    /// Returns the error that building the structure would return.
    pub fn check(&self, polygons: &PolygonMesh) -> Result<(), BuildError> {
        self.capabilities.check(polygons)
    }
}

/// Returns the properties of all structures, in the order in which tables show them.
pub fn roster() -> Vec<BackendInfo> {
    let mut rows = Vec::new();
    for_each_editable!(M => { rows.push(BackendInfo::with_edits::<M>()); });
    rows
}

/// Calls `visitor` for every structure, in the order of [`roster`].
pub fn visit_all<V: Visitor>(visitor: &mut V) -> Vec<V::Output> {
    let mut outputs = Vec::new();
    for_each_representation!(M => { outputs.push(visitor.visit::<M>()); });
    outputs
}

/// Calls `visitor` for the structure called `name`; `None` if the name is unknown.
pub fn visit<V: Visitor>(name: &str, visitor: &mut V) -> Option<V::Output> {
    for_each_representation!(M => {
        if name == M::NAME {
            return Some(visitor.visit::<M>());
        }
    });
    None
}

/// Calls `visitor` for the structure called `name`; `None` if the name is unknown or the structure
/// does not refine its own tables.
pub fn visit_refinable<V: RefineVisitor>(name: &str, visitor: &mut V) -> Option<V::Output> {
    for_each_refinable!(M => {
        if name == M::NAME {
            return Some(visitor.visit::<M>());
        }
    });
    None
}

/// Calls `visitor` for the structure called `name`; `None` if the name is unknown or the structure
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
