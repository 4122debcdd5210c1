//! The list of all structures.

use sixfold_core::{
    BuildError, Capabilities, Edit, MeshEdit, PolygonMesh, QueryCost, Refine, Representation, Split,
};

/// Calls a macro with the list of all structures: `structures!([callback] arguments…)`.
///
/// This macro is the only list of structures. To add a structure, add one line to the list. Each
/// line of the list starts with the type for queries. Three more types may follow: `edit` is the
/// type that can be edited, `refine` is the type that splits its own tables, and `walk` is the type
/// that has sides ([`OrientedWalk`](sixfold_core::OrientedWalk)). All types of a line have the same
/// name ([`Representation::NAME`](sixfold_core::Representation::NAME)).
///
/// The callback gets the arguments, followed by all lines of the list. If you need only one type of
/// each structure, use [`for_each_representation!`](crate::for_each_representation),
/// [`for_each_editable!`](crate::for_each_editable),
/// [`for_each_refinable!`](crate::for_each_refinable) or
/// [`for_each_walkable!`](crate::for_each_walkable) instead.
#[macro_export]
macro_rules! structures {
    ([$($callback:tt)+] $($arguments:tt)*) => {
        $($callback)+! { $($arguments)*
            { query: $crate::PolygonSoup, edit: $crate::EditablePolygonSoup }
            { query: $crate::IndexedFaceSet, edit: $crate::EditableIndexedFaceSet }
            { query: $crate::FaceVertexMesh, edit: $crate::EditableFaceVertexMesh, refine: $crate::FaceVertexMesh, walk: $crate::FaceVertexMesh }
            { query: $crate::WingedEdgeMesh, edit: $crate::EditableWingedEdgeMesh, refine: $crate::WingedEdgeMesh, walk: $crate::WingedEdgeMesh }
            { query: $crate::HalfEdgeMesh, edit: $crate::EditableHalfEdgeMesh, refine: $crate::HalfEdgeMesh, walk: $crate::HalfEdgeMesh }
            { query: $crate::CornerTable, edit: $crate::EditableCornerTable, refine: $crate::CornerTable, walk: $crate::CornerTable }
        }
    };
}

/// Repeats a body for each line that has the requested type.
#[doc(hidden)]
#[macro_export]
macro_rules! repeat_for_structures {
    (query $mesh:ident $body:block
        $({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? $(, walk: $walk:ty)? })+) => {
        $({
            type $mesh = $query;
            $body
        })+
    };
    (edit $mesh:ident $body:block
        $({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? $(, walk: $walk:ty)? })+) => {
        $($({
            type $mesh = $edit;
            $body
        })?)+
    };
    (refine $mesh:ident $body:block
        $({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? $(, walk: $walk:ty)? })+) => {
        $($({
            type $mesh = $refine;
            $body
        })?)+
    };
    (walk $mesh:ident $body:block
        $({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? $(, walk: $walk:ty)? })+) => {
        $($({
            type $mesh = $walk;
            $body
        })?)+
    };
}

/// Repeats a macro body for each structure: `for_each_representation!(M => { … })`.
///
/// The body is compiled once for each structure. In the body, `M` is an alias of the type of the
/// structure.
#[macro_export]
macro_rules! for_each_representation {
    ($mesh:ident => $body:block) => {
        $crate::structures! { [$crate::repeat_for_structures] query $mesh $body }
    };
}

/// Repeats a macro body for each structure that can be edited. In the body, `M` is an alias of the
/// [`Editable`](sixfold_core::Editable) type of the structure. The macro is called in the same way
/// as [`for_each_representation!`](crate::for_each_representation).
#[macro_export]
macro_rules! for_each_editable {
    ($mesh:ident => $body:block) => {
        $crate::structures! { [$crate::repeat_for_structures] edit $mesh $body }
    };
}

/// Repeats a macro body for each structure that can split its own tables. The macro is called in
/// the same way as [`for_each_representation!`](crate::for_each_representation).
#[macro_export]
macro_rules! for_each_refinable {
    ($mesh:ident => $body:block) => {
        $crate::structures! { [$crate::repeat_for_structures] refine $mesh $body }
    };
}

/// Repeats a macro body for each structure that implements
/// [`OrientedWalk`](sixfold_core::OrientedWalk). The macro is called in the same way as
/// [`for_each_representation!`](crate::for_each_representation).
#[macro_export]
macro_rules! for_each_walkable {
    ($mesh:ident => $body:block) => {
        $crate::structures! { [$crate::repeat_for_structures] walk $mesh $body }
    };
}

/// A generic function that is called with a structure selected at run time.
///
/// The structure is selected once per call. The code of the function uses static dispatch. For
/// structures that can be edited or refined, compare the name with `M::NAME` in
/// [`for_each_editable!`](crate::for_each_editable) or
/// [`for_each_refinable!`](crate::for_each_refinable).
pub trait Visitor {
    /// The type that `visit` returns.
    type Output;

    /// Calls the function for the structure `M`.
    fn visit<M: Representation + 'static>(&mut self) -> Self::Output;
}

/// Properties of one structure that do not depend on a mesh.
#[derive(Clone, Copy, Debug)]
pub struct StructureInfo {
    /// The name of the structure.
    pub name: &'static str,
    /// The meshes that the structure can hold.
    pub capabilities: Capabilities,
    /// How much of the mesh a query of each relation reads.
    pub costs: [QueryCost; 9],
    /// For each edit in the order of [`Edit::ALL`], how much of the mesh the edit reads. `None` if
    /// the structure does not support the edit.
    pub edits: [Option<QueryCost>; Edit::ALL.len()],
    /// The splits that the structure can apply to its own tables ([`Refine::SPLITS`]).
    pub splits: &'static [Split],
}

impl StructureInfo {
    /// Returns the properties of `M` without its edits and its splits.
    pub const fn new<M: Representation>() -> Self {
        Self {
            name: M::NAME,
            capabilities: M::CAPABILITIES,
            costs: M::COSTS,
            edits: [None; Edit::ALL.len()],
            splits: &[],
        }
    }

    /// Adds the edits of `M`, the editable type of the same structure.
    #[must_use]
    pub const fn with_edits<M: MeshEdit>(self) -> Self {
        Self {
            edits: M::EDITS,
            ..self
        }
    }

    /// Adds the splits of `M`, the type of the same structure that can split its own tables.
    #[must_use]
    pub const fn with_refinement<M: Refine>(self) -> Self {
        Self {
            splits: M::SPLITS,
            ..self
        }
    }

    /// Returns true if the structure supports at least one edit.
    pub fn is_editable(&self) -> bool {
        self.edits.iter().any(Option::is_some)
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

macro_rules! infos {
    ($({ query: $query:ty $(, edit: $edit:ty)? $(, refine: $refine:ty)? $(, walk: $walk:ty)? })+) => {
        vec![$(
            StructureInfo::new::<$query>()
                $(.with_edits::<$edit>())?
                $(.with_refinement::<$refine>())?
        ),+]
    };
}

/// Returns the properties of all structures, in the order of [`structures!`](crate::structures).
pub fn structure_infos() -> Vec<StructureInfo> {
    structures!([infos])
}

/// Calls `visitor` for the structure called `name`. Returns `None` if there is no such structure.
pub fn visit<V: Visitor>(name: &str, visitor: &mut V) -> Option<V::Output> {
    for_each_representation!(M => {
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
    fn every_structure_is_found_by_its_name() {
        let infos = structure_infos();
        let names: Vec<_> = infos.iter().map(|info| info.name).collect();
        let (mut all, mut editable, mut refinable) = (Vec::new(), Vec::new(), Vec::new());
        for_each_representation!(M => { all.push(M::NAME); });
        for_each_editable!(M => { editable.push(M::NAME); });
        for_each_refinable!(M => { refinable.push(M::NAME); });
        assert_eq!(all, names);
        for info in infos {
            let name = info.name;
            assert_eq!(visit(name, &mut Name), Some(name));
            assert_eq!(editable.contains(&name), info.is_editable(), "{name}");
            assert_eq!(refinable.contains(&name), !info.splits.is_empty(), "{name}");
        }
        assert_eq!(visit("abacus", &mut Name), None);
    }
}
