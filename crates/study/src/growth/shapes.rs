//! Shapes that can be built with approximately any number of faces.

use sixfold::PolygonMesh;
use sixfold::shapes::{ShapeError, generator};

/// A shape that can be made with approximately any number of faces.
#[derive(Clone, Copy, Debug)]
pub struct ScalableShape {
    /// Name of the shape, as in the command `sixfold generate`.
    pub name: &'static str,
    /// Description of the shape in one line.
    pub summary: &'static str,
    parameters_for: fn(f64) -> Vec<(&'static str, f64)>,
}

impl ScalableShape {
    /// Returns the shape called `name`; `None` if the name is unknown.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        SCALABLE_SHAPES.iter().find(|shape| shape.name == name)
    }

    /// Returns the parameters of its generator for approximately `faces` faces.
    pub(super) fn parameters(&self, faces: usize) -> Vec<(&'static str, f64)> {
        (self.parameters_for)(faces as f64)
    }

    /// Builds the shape with approximately `faces` faces.
    ///
    /// # Errors
    ///
    /// Returns an error if the shape does not allow this number of faces.
    ///
    /// # Panics
    ///
    /// Panics if the field `name` is not the name of a shape generator. The names in
    /// [`SCALABLE_SHAPES`] are all valid.
    pub fn make(&self, faces: usize) -> Result<PolygonMesh, ShapeError> {
        let generator = generator(self.name).expect("a generator");
        generator.build(&self.parameters(faces))
    }
}

/// All shapes that can be built with approximately any number of faces. The first shape is the
/// default.
pub const SCALABLE_SHAPES: &[ScalableShape] = &[
    ScalableShape {
        name: "geodesic",
        summary: "triangles on a sphere, closed",
        parameters_for: |faces| vec![("frequency", (faces / 20.0).sqrt().round().max(1.0))],
    },
    ScalableShape {
        name: "triangle-torus",
        summary: "triangles around a ring, closed, every vertex of valence 6",
        parameters_for: |faces| cells(faces / 2.0, 2.0),
    },
    ScalableShape {
        name: "torus",
        summary: "quads around a ring, closed",
        parameters_for: |faces| cells(faces, 2.0),
    },
    ScalableShape {
        name: "triangle-grid",
        summary: "triangles in the plane, with a boundary",
        parameters_for: |faces| cells(faces / 2.0, 1.0),
    },
    ScalableShape {
        name: "grid",
        summary: "squares in the plane, with a boundary",
        parameters_for: |faces| cells(faces, 1.0),
    },
    ScalableShape {
        name: "mixed-grid",
        summary: "squares and triangles in the plane, with a boundary",
        parameters_for: |faces| cells(faces / 1.5, 1.0),
    },
    ScalableShape {
        name: "hexagon-tiling",
        summary: "hexagons in the plane, with a boundary",
        parameters_for: |faces| cells(faces, 1.0),
    },
    ScalableShape {
        name: "blobs",
        summary: "irregular triangles of marching tetrahedra, closed",
        parameters_for: |faces| vec![("faces", faces.round())],
    },
];

/// Returns parameters `m` and `n` with m · n ≈ `cells` and m / n ≈ `aspect`.
fn cells(cells: f64, aspect: f64) -> Vec<(&'static str, f64)> {
    let n = (cells / aspect).sqrt().round().max(3.0);
    vec![("m", (cells / n).round().max(3.0)), ("n", n)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shape_has_within_ten_percent_of_the_requested_faces() {
        for shape in SCALABLE_SHAPES {
            let summary = generator(shape.name).map(|generator| generator.summary);
            assert!(summary.is_some(), "{}", shape.name);
            for faces in [1000, 5000, 20_000] {
                let made = shape.make(faces).expect("of that size").face_count();
                let off = made.abs_diff(faces) as f64 / faces as f64;
                assert!(off < 0.1, "{}: {made} for {faces}", shape.name);
            }
        }
        assert!(ScalableShape::from_name("teapot").is_none());
    }

    #[test]
    fn too_many_faces_are_refused() {
        assert!(SCALABLE_SHAPES[1].make(1 << 40).is_err());
    }
}
