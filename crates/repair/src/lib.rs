//! Diagnosis and repair of polygon meshes.
//!
//! Files contain vertices that are not shared, faces that occur twice or are turned the wrong way,
//! edges with three faces, and holes. [`diagnose`] finds all of these faults, and says which
//! structures refuse the mesh for them. [`repair`] runs chosen [`Step`]s. [`repair_for`] runs the
//! steps that a structure needs, given its capabilities as data.
//!
//! | step | what it does | time for n corners, O(…) | source |
//! |---|---|---|---|
//! | [`Step::Weld`] | merges vertices within a distance | n log n | |
//! | [`Step::RemoveDuplicateFaces`] | removes faces that occur twice | n | |
//! | [`Step::RemoveFlatFaces`] | removes faces without area | n log n | |
//! | [`Step::Orient`] | reverses faces until neighbours agree | n log n | |
//! | [`Step::Cut`] | cuts non-manifold edges and vertices | n log n | after Guéziec et al. 2001 |
//! | [`Step::FillHoles`] | triangulates holes | edges³ per hole | Barequet & Sharir 1995, Liepa 2003 |
//! | [`Step::RemoveIsolatedVertices`] | removes vertices without a face | n | |
//! | [`Step::RemoveSmallComponents`] | removes components with few faces | n | |
//! | [`Step::Triangulate`] | cuts polygons into triangles | at most degree² per face | Meisters 1975 |
//!
//! Repairs work on a [`PolygonMesh`], before a structure is built. They return a new mesh with a
//! report of each step and maps from old to new elements; the input is never changed. No step moves
//! a vertex, except for welding, which moves it by at most the tolerance. A step that finds nothing
//! to do changes nothing, not even the numbers of elements.
//!
//! ```
//! use sixfold_core::{MeshQuery, Representation};
//! use sixfold_half_edge::HalfEdgeMesh;
//! use sixfold_repair::{Step, diagnose, repair, repair_for};
//!
//! // A cube whose faces share no vertices, as some files have it.
//! let cube = sixfold_shapes::cube();
//! let corners = cube.faces().corners().iter().map(|&v| cube.position(v));
//! let quads = (0..6).map(|f| [4 * f, 4 * f + 1, 4 * f + 2, 4 * f + 3]);
//! let file = sixfold_core::PolygonMesh::new(corners, quads)?;
//!
//! let diagnosis = diagnose(&file, 3);
//! assert!(diagnosis.looks_unwelded());
//! assert_eq!([diagnosis.vertices, diagnosis.positions], [24, 8]);
//!
//! let welded = repair(&file, &[Step::Weld(Default::default())])?;
//! let repaired = repair_for(&welded.polygons, &HalfEdgeMesh::CAPABILITIES)?;
//! let mesh = HalfEdgeMesh::from_polygons(&repaired.polygons)?;
//! assert_eq!(mesh.edge_count(), 12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! No feature is on by default. `rayon`: a diagnosis runs on two threads. `serde`: diagnoses and
//! reports can be written.
//!
//! [`PolygonMesh`]: sixfold_core::PolygonMesh

mod carry;
mod cut;
mod diagnosis;
mod duplicates;
mod error;
mod flat;
mod holes;
mod measures;
mod orient;
mod orientation;
mod outcome;
mod plan;
mod remove;
mod report;
#[cfg(feature = "serde")]
mod serialize;
mod step;
mod trace;
mod triangulate;
mod weld;

pub use diagnosis::{Crack, Diagnosis, Fault, FaultKind, Place, diagnose, examine};
pub use duplicates::OppositeFaces;
pub use error::{OrientationError, RepairError};
pub use holes::{FillHoles, HoleFilling};
pub use measures::{Lengths, Measures, measures};
pub use orientation::{
    Components, Facing, NotOrientable, Oriented, OrientedComponents, Undecided, UndecidedReason,
    oriented, oriented_components,
};
pub use outcome::{Left, StepCounts};
pub use plan::repair_for;
pub use report::{Repaired, StepReport};
pub use step::{Step, repair};
pub use trace::ElementMap;
pub use weld::{Tolerance, Weld, WeldMethod};
