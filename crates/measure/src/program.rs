//! Programs of users, which run on every structure.
//!
//! A program is an algorithm that is generic over the mesh type. There are five kinds of programs,
//! one trait each. They differ in what they need from a structure:
//!
//! | trait | needs | structures of Sixfold |
//! |---|---|---|
//! | [`Program`] | queries | all six, and relation tables |
//! | [`MovingProgram`] | queries, new positions | all six |
//! | [`EditProgram`] | queries, edits | all six |
//! | [`WalkProgram`] | queries, sides ([`OrientedWalk`]) | those with walks along sides |
//! | [`RefineProgram`] | queries, splits of all faces ([`Refine`]) | those that refine their own tables |
//!
//! All kinds have the same three methods. `name` is the name in tables and files. `set_up` makes
//! the scratch data outside the timing, such as a map with a value for each vertex. `run` is timed.

mod forms;
mod on_tables;
mod panics;
mod recorded;
mod subject;
mod suite;
mod tape;

use sixfold::{MeshEdit, MeshQuery, OrientedWalk, Refine, Representation};

use crate::job::Outcome;

pub use forms::Form;
pub use recorded::{Asked, Recorded};
pub use subject::{ProgramRefusal, record_edit_trace, record_trace};
pub use suite::{Contestant, ProgramKind, Suite, SuiteProgram};
pub use tape::TapedRun;

/// Declares the trait of one kind of program.
macro_rules! program_kind {
    ($(#[$doc:meta])* $name:ident, $bound:path, $($mesh:tt)+) => {
        $(#[$doc])*
        pub trait $name {
            /// The scratch data of the program, such as maps with a value for each vertex. `()` if
            /// there are none.
            type Scratch<M: $bound>;

            /// Returns the name of the program in tables and files, such as `geodesics`.
            fn name(&self) -> &str;

            /// Makes the scratch data for `mesh`. This work is not timed.
            ///
            /// # Errors
            ///
            /// Returns the reason why the program cannot run on this mesh, such as "face 7 is not a
            /// triangle". A program that refuses a mesh must refuse it on each structure.
            fn set_up<M: $bound>(&self, mesh: &M) -> Result<Self::Scratch<M>, String>;

            /// Runs the program once. This work is timed. Every run has the same result, up to rounding.
            fn run<M: $bound>(
                &self,
                mesh: $($mesh)+ M,
                scratch: &mut Self::Scratch<M>,
            ) -> Outcome;
        }
    };
}

program_kind! {
    /// A program that only queries a mesh.
    ///
    /// The scratch data are kept between runs. If a run needs empty scratch data, the run itself
    /// must clear them, and this work is timed.
    ///
    /// ```
    /// use sixfold::MeshQuery;
    /// use sixfold_measure::{Outcome, Program};
    ///
    /// /// Adds up the lengths of all edges.
    /// struct TotalLength;
    ///
    /// impl Program for TotalLength {
    ///     type Scratch<M: MeshQuery> = ();
    ///
    ///     fn name(&self) -> &str {
    ///         "total-length"
    ///     }
    ///
    ///     fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
    ///         Ok(())
    ///     }
    ///
    ///     fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
    ///         let mut edges = 0;
    ///         let lengths = mesh.edges().map(|e| {
    ///             edges += 1;
    ///             let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
    ///             f64::from(a.distance(b))
    ///         });
    ///         Outcome::new(lengths.sum(), edges)
    ///     }
    /// }
    /// ```
    Program, MeshQuery, &
}

program_kind! {
    /// A program that queries a mesh and walks along the sides of faces, such as half-edges.
    ///
    /// The scratch data are kept between runs, as for [`Program`].
    WalkProgram, OrientedWalk, &
}

program_kind! {
    /// A program that moves the vertices of a mesh with
    /// [`set_positions`](sixfold::MeshMove::set_positions).
    ///
    /// Each run gets a fresh copy of the mesh and of the scratch data. Copying is not timed.
    MovingProgram, Representation, &mut
}

program_kind! {
    /// A program that edits a mesh.
    ///
    /// Each run gets a fresh copy of the mesh and of the scratch data. Copying is not timed.
    ///
    /// The result must be the same on every structure: see [Editing while iterating](MeshEdit#editing-while-iterating).
    /// `sixfold new --edits` writes such a program. Handles in the scratch data are those at the start: an edit can rename
    /// some, and on polygon soup, whose vertices are their positions, a vertex has another handle after it was moved. A map
    /// that was made before then has no value of this vertex.
    ///
    /// ```
    /// use sixfold::{MeshEdit, Point};
    /// use sixfold_measure::{EditProgram, Outcome, Suite};
    ///
    /// /// Puts a vertex into the middle of every face.
    /// struct PokeAll;
    ///
    /// impl EditProgram for PokeAll {
    ///     type Scratch<M: MeshEdit> = ();
    ///
    ///     fn name(&self) -> &str {
    ///         "poke-all"
    ///     }
    ///
    ///     fn set_up<M: MeshEdit>(&self, _: &M) -> Result<(), String> {
    ///         Ok(())
    ///     }
    ///
    ///     fn run<M: MeshEdit>(&self, mesh: &mut M, (): &mut ()) -> Outcome {
    ///         let faces: Vec<M::Face> = mesh.faces().collect();
    ///         let mut refused = 0;
    ///         for &f in &faces {
    ///             let corners: Vec<_> = mesh.face_vertices(f).map(|v| mesh.position(v)).collect();
    ///             let middle = corners.iter().sum::<Point>() / corners.len() as f32;
    ///             refused += u64::from(mesh.poke_face(f, middle).is_err());
    ///         }
    ///         Outcome::new((mesh.face_count() as u64 + refused) as f64, faces.len() as u64)
    ///     }
    /// }
    ///
    /// let suite = Suite::new().edit_program(PokeAll);
    /// # assert_eq!(suite.programs().len(), 1);
    /// ```
    EditProgram, MeshEdit, &mut
}

program_kind! {
    /// A program that splits all faces of a mesh, as subdivision does.
    ///
    /// The scratch data are kept between runs, as for [`Program`]. They usually hold the refined
    /// mesh.
    RefineProgram, Refine, &
}
