//! Orientation as a step: the algorithm is in `orientation.rs`.

use sixfold_core::{PolygonMesh, Slot};

use crate::orientation::{Components, Facing, OrientedComponents, oriented_components};
use crate::outcome::{Left, Outcome, StepCounts};
use crate::trace::{CornerId, Trace, VertexTrace, corners_of};

/// Orients the faces; O(n log n) for n corners.
pub(crate) fn orient(polygons: &PolygonMesh, facing: Facing, which: Components) -> Outcome {
    let OrientedComponents {
        polygons: oriented,
        reversed,
        not_orientable,
        undecided,
    } = oriented_components(polygons, facing, which);
    let left = not_orientable.iter().map(|component| Left::NotOrientable {
        face: component.face,
        faces: component.faces,
        ends: component.ends,
    });
    let left = left.chain(undecided.iter().map(|component| Left::Undecided {
        face: component.face,
        faces: component.faces,
        reason: component.reason,
    }));
    let left = left.collect();
    if reversed.is_empty() {
        return Outcome {
            left,
            ..Outcome::unchanged()
        };
    }
    let faces = polygons.faces();
    let all = faces.iter().flat_map(|(f, _)| corners_of(polygons, f));
    let mut corners: Vec<Slot<CornerId>> = all.map(|(_, c)| Slot::some(c)).collect();
    for &f in &reversed {
        // A reversed face keeps its first corner.
        corners[faces.range(f)][1..].reverse();
    }
    let trace = Trace {
        faces: faces.iter().map(|(f, _)| Slot::some(f)).collect(),
        corners,
        vertices: VertexTrace::identity(polygons),
    };
    let counts = StepCounts {
        faces_reversed: reversed.len(),
        ..StepCounts::default()
    };
    Outcome {
        left,
        ..Outcome::changed((oriented, trace), counts)
    }
}
