//! The steps of a repair, and their execution one after the other.

use std::fmt;

use sixfold_core::PolygonMesh;

use crate::duplicates::OppositeFaces;
use crate::error::RepairError;
use crate::holes::FillHoles;
use crate::orientation::{Components, Facing};
use crate::outcome::Outcome;
use crate::report::{Repaired, StepReport};
use crate::trace::{Trace, element_maps};
use crate::weld::Weld;
use crate::{cut, duplicates, flat, holes, orient, remove, triangulate, weld};

/// One step of a repair, with its options.
///
/// Every step can be run by itself. A step that finds nothing to do leaves the mesh unchanged, and
/// a second run of a step changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Step {
    /// Merges vertices within a distance. [`Weld`] describes the rule.
    ///
    /// A face that would name a vertex twice in a row loses the repeated corner. A face that would
    /// name a vertex twice elsewhere is cut into triangles first, so that its area stays. Faces with
    /// fewer than three corners are removed. The report counts all of them.
    Weld(Weld),
    /// Removes faces that name the same vertices in the same cyclic order as an earlier face.
    RemoveDuplicateFaces(OppositeFaces),
    /// Removes faces whose area is exactly zero in double precision, and adds neither boundary edges
    /// nor non-manifold edges.
    ///
    /// A triangle with two corners at one position is removed by merging their vertices. If one corner
    /// of a triangle lies between the others, the other face on the longest edge gets this corner, and
    /// becomes two triangles if it is a triangle (the edge is flipped). Polygons without area are cut
    /// into triangles first. Faces that cannot be removed in these ways are named in the report. The
    /// areas of other faces together do not change.
    RemoveFlatFaces,
    /// Reverses faces until adjacent faces agree. A component that is not orientable remains
    /// unchanged and is named in the report.
    Orient {
        /// The rule that chooses one of the two orientations of a component.
        facing: Facing,
        /// The components that may be reversed.
        which: Components,
    },
    /// Cuts the mesh into an oriented manifold, at edges with three or more faces, at edges along
    /// which two faces run in the same direction, and at vertices with several fans. [`repair`]
    /// describes how.
    ///
    /// [`repair`]: crate::repair#cutting
    Cut,
    /// Fills holes with triangles. The faces must agree, and no edge may have more than two; several
    /// fans at a vertex are allowed.
    FillHoles(FillHoles),
    /// Removes vertices without a face.
    RemoveIsolatedVertices,
    /// Removes components with fewer faces than this. Faces that share an edge are in one component.
    RemoveSmallComponents {
        /// The smallest number of faces of a component that remains.
        min_faces: usize,
    },
    /// Cuts every polygon into triangles.
    Triangulate,
}

impl Step {
    /// Runs the step.
    fn run(&self, polygons: &PolygonMesh) -> Result<Outcome, RepairError> {
        match *self {
            Self::Weld(options) => weld::weld(polygons, &options),
            Self::RemoveDuplicateFaces(opposite) => duplicates::remove(polygons, opposite),
            Self::RemoveFlatFaces => flat::remove(polygons),
            Self::Orient { facing, which } => Ok(orient::orient(polygons, facing, which)),
            Self::Cut => cut::cut(polygons),
            Self::FillHoles(options) => holes::fill(polygons, &options),
            Self::RemoveIsolatedVertices => remove::isolated_vertices(polygons),
            Self::RemoveSmallComponents { min_faces } => {
                remove::small_components(polygons, min_faces)
            }
            Self::Triangulate => triangulate::triangulate(polygons),
        }
    }

    /// Returns what the step does, for reports: `weld vertices`.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Weld(_) => "weld vertices",
            Self::RemoveDuplicateFaces(_) => "remove duplicate faces",
            Self::RemoveFlatFaces => "remove faces without area",
            Self::Orient { .. } => "orient faces",
            Self::Cut => "cut into manifolds",
            Self::FillHoles(_) => "fill holes",
            Self::RemoveIsolatedVertices => "remove isolated vertices",
            Self::RemoveSmallComponents { .. } => "remove small components",
            Self::Triangulate => "triangulate",
        }
    }
}

/// Writes the title.
#[cfg(feature = "serde")]
impl serde::Serialize for Step {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.title())
    }
}

/// Prints the title.
impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.title())
    }
}

/// Runs steps one after the other on a mesh that is not copied before it changes.
pub(crate) struct Run<'a> {
    old: &'a PolygonMesh,
    changed: Option<(PolygonMesh, Trace)>,
    steps: Vec<StepReport>,
}

impl<'a> Run<'a> {
    pub(crate) fn new(old: &'a PolygonMesh) -> Self {
        Self {
            old,
            changed: None,
            steps: Vec::new(),
        }
    }

    /// Returns the reports of the steps so far.
    pub(crate) fn steps(&self) -> &[StepReport] {
        &self.steps
    }

    /// Returns the mesh after the steps so far.
    pub(crate) fn polygons(&self) -> &PolygonMesh {
        self.changed.as_ref().map_or(self.old, |(mesh, _)| mesh)
    }

    /// Runs one step and adds its report.
    pub(crate) fn step(&mut self, step: Step) -> Result<(), RepairError> {
        let Outcome {
            changed,
            counts,
            left,
        } = step.run(self.polygons())?;
        if let Some((mesh, trace)) = changed {
            let trace = match &self.changed {
                Some((_, before)) => before.then(&trace),
                None => trace,
            };
            self.changed = Some((mesh, trace));
        }
        self.steps.push(StepReport { step, counts, left });
        Ok(())
    }

    pub(crate) fn finish(self) -> Repaired {
        let trace = self.changed.as_ref().map(|(_, trace)| trace);
        let (vertices, faces) = element_maps(self.old, self.polygons(), trace);
        let polygons = match self.changed {
            Some((mesh, _)) => mesh,
            None => self.old.clone(),
        };
        Repaired {
            polygons,
            vertices,
            faces,
            steps: self.steps,
        }
    }
}

/// Runs `steps` in this order.
///
/// # Cutting
///
/// ```text
///      \   | 2            \    |          Three faces on one edge (a book): two sides that run
///     1 \  |               \   |          in opposite directions are joined, the third side
///        \ |        ⇒       \  | |        gets copies of the vertices. Which two: those that
///         \|______           \ | |____    continue each other most straight.
///              3
/// ```
///
/// [`Step::Cut`] first separates all faces, and then joins pairs of sides that run along an edge in
/// opposite directions. Corners that joined sides connect around a vertex are one fan, and each fan
/// becomes one vertex. (The idea is the cutting of Guéziec, Taubin, Lazarus & Horn 2001, who join
/// the pairs by locality or by distance.) The number of joined pairs is as large as possible, with
/// one condition: no two edges may have the same two ends afterwards, and no edge more than two
/// faces. If the largest number is not found at once, groups of up to 96 corners around non-manifold
/// edges are searched completely, up to a fixed number of attempts; in larger groups, pairs that
/// would violate the condition are left open.
///
/// Pairs are preferred in this order: pairs that close a fan at one of their ends; then pairs that
/// bound the same solid, if only solids meet at the edge; then pairs whose faces continue each other
/// most straight (to a thousandth of a radian); then pairs with the smaller angle behind the faces,
/// where a solid has its inside. So two solids that touch along an edge or share a wall are
/// separated, and two sheets that cross each other are two sheets again.
///
/// # Errors
///
/// Returns the error of the first step that fails. `polygons` itself is never changed.
///
/// # Examples
///
/// ```
/// use sixfold_core::PolygonMesh;
/// use sixfold_repair::{Step, repair};
///
/// // Two triangles with four corners at two places.
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let points = points.map(|[x, y]| [x, y, 0.0]);
/// let unwelded = PolygonMesh::new(points, [[0, 1, 2], [3, 4, 5]])?;
/// let repaired = repair(&unwelded, &[Step::Weld(Default::default())])?;
/// assert_eq!(repaired.polygons.vertex_count(), 4);
/// assert_eq!(repaired.steps[0].counts.vertices_merged, 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn repair(polygons: &PolygonMesh, steps: &[Step]) -> Result<Repaired, RepairError> {
    let mut run = Run::new(polygons);
    for &step in steps {
        run.step(step)?;
    }
    Ok(run.finish())
}
