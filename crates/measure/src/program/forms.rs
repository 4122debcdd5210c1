//! How the kinds of programs run on one structure.

use std::marker::PhantomData;

use sixfold::{MeshEdit, OrientedWalk, PolygonMesh, Refine, Representation};

use super::{EditProgram, MovingProgram, Program, RefineProgram, WalkProgram};
use crate::job::Outcome;

/// A kind of program on the structure `Mesh`.
pub trait Form {
    /// The program.
    type Program;
    /// The structure.
    type Mesh: Representation;
    /// The scratch data.
    type Scratch;
    /// Whether a run can edit the mesh.
    const EDITS: bool = false;

    /// Returns whether a run changes the mesh, so that each run needs a fresh copy. O(1).
    fn changes_mesh(scratch: &Self::Scratch) -> bool;

    /// Makes the scratch data. `polygons` is the mesh from which `mesh` was built.
    ///
    /// # Errors
    ///
    /// Returns the reason why the program refuses the mesh.
    fn set_up(
        program: &Self::Program,
        mesh: &Self::Mesh,
        polygons: &PolygonMesh,
    ) -> Result<Self::Scratch, String>;

    /// **Timed**: runs the program once.
    fn run(program: &Self::Program, mesh: &mut Self::Mesh, scratch: &mut Self::Scratch) -> Outcome;
}

/// Says that a program refuses the mesh.
pub(super) fn refuses(reason: &str) -> String {
    format!("the program refuses the mesh: {reason}")
}

/// Defines a kind of program as a type that implements [`Form`].
macro_rules! form {
    ($name:ident: $program:ident on $($bound:path),+; changes mesh: $changes:expr) => {
        #[doc = concat!("A [`", stringify!($program), "`] on the structure `M`.")]
        pub(super) struct $name<P, M>(PhantomData<(P, M)>);

        impl<P: $program, M: $($bound +)+> Form for $name<P, M> {
            type Program = P;
            type Mesh = M;
            type Scratch = P::Scratch<M>;

            fn changes_mesh(_: &P::Scratch<M>) -> bool {
                $changes
            }

            fn set_up(
                program: &P,
                mesh: &M,
                _: &PolygonMesh,
            ) -> Result<P::Scratch<M>, String> {
                program.set_up(mesh).map_err(|reason| refuses(&reason))
            }

            fn run(program: &P, mesh: &mut M, scratch: &mut P::Scratch<M>) -> Outcome {
                program.run(mesh, scratch)
            }
        }
    };
}

form!(Queries: Program on Representation; changes mesh: false);
form!(Walks: WalkProgram on Representation, OrientedWalk; changes mesh: false);
form!(Moves: MovingProgram on Representation; changes mesh: true);
form!(Edits: EditProgram on Representation, MeshEdit; changes mesh: true);
form!(Refinements: RefineProgram on Refine; changes mesh: false);
