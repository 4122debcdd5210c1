//! Shapes of any size: the parameters for an approximate number of faces.

use sixfold::PolygonMesh;
use sixfold::shapes::{ShapeError, recipe};

/// A shape that can be made with approximately any number of faces.
#[derive(Clone, Copy, Debug)]
pub struct Growing {
    /// Name, the same as in `generate`.
    pub name: &'static str,
    /// Description in one line.
    pub summary: &'static str,
    takes: fn(f64) -> Vec<(&'static str, f64)>,
}

impl Growing {
    /// Returns the shape called `name`.
    pub fn named(name: &str) -> Option<&'static Self> {
        GROWING.iter().find(|shape| shape.name == name)
    }

    /// Returns the parameters of its recipe for approximately `faces` faces.
    pub(super) fn parameters(&self, faces: usize) -> Vec<(&'static str, f64)> {
        (self.takes)(faces as f64)
    }

    /// Builds the shape with approximately `faces` faces.
    ///
    /// # Errors
    ///
    /// The shape does not allow this number of faces.
    ///
    /// # Panics
    ///
    /// Panics if `name` is not the name of a recipe. A test checks this for all of [`GROWING`].
    pub fn make(&self, faces: usize) -> Result<PolygonMesh, ShapeError> {
        let recipe = recipe(self.name).expect("a recipe");
        recipe.make(&self.parameters(faces))
    }
}

/// All shapes for sweeps; the first is the default.
pub const GROWING: &[Growing] = &[
    Growing {
        name: "geodesic",
        summary: "triangles on a sphere, closed",
        takes: |faces| vec![("frequency", (faces / 20.0).sqrt().round().max(1.0))],
    },
    Growing {
        name: "triangle-torus",
        summary: "triangles around a ring, closed, every vertex of valence 6",
        takes: |faces| cells(faces / 2.0, 2.0),
    },
    Growing {
        name: "torus",
        summary: "quads around a ring, closed",
        takes: |faces| cells(faces, 2.0),
    },
    Growing {
        name: "triangle-grid",
        summary: "triangles in the plane, with a boundary",
        takes: |faces| cells(faces / 2.0, 1.0),
    },
    Growing {
        name: "grid",
        summary: "squares in the plane, with a boundary",
        takes: |faces| cells(faces, 1.0),
    },
    Growing {
        name: "mixed-grid",
        summary: "squares and triangles in the plane, with a boundary",
        takes: |faces| cells(faces / 1.5, 1.0),
    },
    Growing {
        name: "hexagon-tiling",
        summary: "hexagons in the plane, with a boundary",
        takes: |faces| cells(faces, 1.0),
    },
    Growing {
        name: "blobs",
        summary: "irregular triangles of marching tetrahedra, closed",
        takes: |faces| vec![("faces", faces.round())],
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
        for shape in GROWING {
            let summary = recipe(shape.name).map(|recipe| recipe.summary);
            assert!(summary.is_some(), "{}", shape.name);
            for faces in [1000, 5000, 20_000] {
                let made = shape.make(faces).expect("of that size").face_count();
                let off = made.abs_diff(faces) as f64 / faces as f64;
                assert!(off < 0.1, "{}: {made} for {faces}", shape.name);
            }
        }
        assert!(Growing::named("teapot").is_none());
    }

    #[test]
    fn too_many_faces_are_refused() {
        assert!(GROWING[1].make(1 << 40).is_err());
    }
}
