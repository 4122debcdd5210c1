//! The list of all shapes by name, with their parameters and descriptions, for the command line.

use sixfold_core::PolygonMesh;

use crate::error::{MAX_SEGMENTS, MAX_SIDE, ShapeError, check_value};
use crate::fitting::{MAX_FACES, MIN_FACES};
use crate::geodesic::MAX_FREQUENCY;
use crate::implicit::{Blob, Field};
use crate::patch::{MAX_CONTROL_POINTS, MAX_DEGREE};
use crate::{ControlNet, built_in_mesh, genus, geodesic, planar, platonic, solids, surfaces};
use crate::{b_spline_patch, bezier_patch};

/// A shape that can be selected by name.
#[derive(Clone, Copy, Debug)]
pub struct Generator {
    /// The name of the shape on the command line, for example `triangle-torus`.
    pub name: &'static str,
    /// The description of the shape, in one line.
    pub summary: &'static str,
    /// The parameters, in the order of the help text.
    pub parameters: &'static [Parameter],
    build: fn(&[f64]) -> Result<PolygonMesh, ShapeError>,
}

/// A numeric parameter of a generator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// The name of the parameter on the command line.
    pub name: &'static str,
    /// The description of the parameter, in a few words.
    pub meaning: &'static str,
    /// The default value.
    pub default: f64,
    /// The minimum value.
    pub min: f64,
    /// The maximum value. If other parameters of the shape are large, the shape may accept only
    /// smaller values.
    pub max: f64,
    /// True if the value must be an integer.
    pub is_integer: bool,
}

impl Parameter {
    const fn count(
        name: &'static str,
        meaning: &'static str,
        default: usize,
        min: usize,
        max: usize,
    ) -> Self {
        Self {
            name,
            meaning,
            default: default as f64,
            min: min as f64,
            max: max as f64,
            is_integer: true,
        }
    }

    fn check(&self, value: f64) -> Result<(), ShapeError> {
        let Self {
            name: parameter,
            min,
            max,
            ..
        } = *self;
        if self.is_integer && value.is_finite() && value.fract() != 0.0 {
            return Err(ShapeError::NotInteger {
                parameter,
                value,
                min,
                max,
            });
        }
        check_value(parameter, value, min, max)
    }
}

impl Generator {
    /// Builds the shape. Each item of `values` is the name of a parameter and its value. All other
    /// parameters have their default values.
    ///
    /// # Errors
    ///
    /// Fails in these cases:
    ///
    /// - A name is unknown or given twice.
    /// - A value is out of range, or is not an integer although the parameter requires an integer.
    /// - The function that makes the shape returns an error.
    pub fn build(&self, values: &[(&str, f64)]) -> Result<PolygonMesh, ShapeError> {
        let mut given: Vec<Option<f64>> = vec![None; self.parameters.len()];
        for &(name, value) in values {
            let found = self.parameters.iter().zip(&mut given);
            let (parameter, slot) = found
                .into_iter()
                .find(|(parameter, _)| parameter.name == name)
                .ok_or_else(|| self.unknown(name))?;
            parameter.check(value)?;
            if slot.replace(value).is_some() {
                return Err(ShapeError::RepeatedParameter {
                    shape: self.name,
                    parameter: parameter.name,
                });
            }
        }
        let values = given.into_iter().zip(self.parameters);
        let values: Vec<f64> = values
            .map(|(value, parameter)| value.unwrap_or(parameter.default))
            .collect();
        (self.build)(&values)
    }

    fn unknown(&self, given: &str) -> ShapeError {
        ShapeError::UnknownParameter {
            shape: self.name,
            given: given.to_owned(),
            parameters: self.parameters.iter().map(|p| p.name).collect(),
        }
    }
}

/// Returns the generator called `name`, or `None` if there is no such generator.
pub fn generator(name: &str) -> Option<&'static Generator> {
    GENERATORS.iter().find(|generator| generator.name == name)
}

const NONE: &[Parameter] = &[];

const SIDES: Parameter = Parameter::count("n", "sides of the polygon", 8, 3, MAX_SEGMENTS);

const GRID: &[Parameter] = &[
    Parameter::count("m", "cells from left to right", 20, 1, MAX_SIDE),
    Parameter::count("n", "cells from bottom to top", 20, 1, MAX_SIDE),
];

const TORUS: &[Parameter] = &[
    Parameter::count("m", "cells around the axis", 40, 3, MAX_SEGMENTS),
    Parameter::count("n", "cells around the tube", 20, 3, MAX_SEGMENTS),
];

const STEPS_M: Parameter = Parameter::count("m", "cells from left to right", 20, 1, MAX_SEGMENTS);
const STEPS_N: Parameter = Parameter::count("n", "cells from bottom to top", 20, 1, MAX_SEGMENTS);
/// The number of triangles. With fewer than `min` triangles, thin parts of the shape would be lost.
const fn faces(default: usize, min: usize) -> Parameter {
    let meaning = "number of triangles, to within 5 % or 20 triangles";
    Parameter::count("faces", meaning, default, min, MAX_FACES)
}

/// All shapes, in the order of the help text.
pub const GENERATORS: &[Generator] = &[
    Generator {
        name: "tetrahedron",
        summary: "four triangles",
        parameters: NONE,
        build: |_| Ok(platonic::tetrahedron()),
    },
    Generator {
        name: "cube",
        summary: "six squares",
        parameters: NONE,
        build: |_| Ok(platonic::cube()),
    },
    Generator {
        name: "octahedron",
        summary: "eight triangles",
        parameters: NONE,
        build: |_| Ok(platonic::octahedron()),
    },
    Generator {
        name: "dodecahedron",
        summary: "twelve pentagons",
        parameters: NONE,
        build: |_| Ok(platonic::dodecahedron()),
    },
    Generator {
        name: "icosahedron",
        summary: "twenty triangles",
        parameters: NONE,
        build: |_| Ok(platonic::icosahedron()),
    },
    Generator {
        name: "prism",
        summary: "two polygons joined by quads",
        parameters: &[SIDES],
        build: |v| solids::prism(count(v[0])),
    },
    Generator {
        name: "antiprism",
        summary: "two polygons joined by triangles",
        parameters: &[SIDES],
        build: |v| solids::antiprism(count(v[0])),
    },
    Generator {
        name: "grid",
        summary: "unit squares, the tiling {4, 4}",
        parameters: GRID,
        build: |v| planar::grid(count(v[0]), count(v[1])),
    },
    Generator {
        name: "triangle-grid",
        summary: "unit squares, each cut into two triangles",
        parameters: GRID,
        build: |v| planar::triangle_grid(count(v[0]), count(v[1])),
    },
    Generator {
        name: "mixed-grid",
        summary: "unit squares; every second square is cut into two triangles",
        parameters: GRID,
        build: |v| planar::mixed_grid(count(v[0]), count(v[1])),
    },
    Generator {
        name: "grid-with-hole",
        summary: "unit squares with one hole in the middle, a third as wide and as high",
        parameters: &[
            Parameter::count("m", "cells from left to right", 20, 3, MAX_SIDE),
            Parameter::count("n", "cells from bottom to top", 20, 3, MAX_SIDE),
        ],
        build: |v| planar::grid_with_hole(count(v[0]), count(v[1])),
    },
    Generator {
        name: "grid-with-holes",
        summary: "unit squares with missing squares that do not touch each other",
        parameters: &[
            GRID[0],
            GRID[1],
            Parameter::count("holes", "number of holes", 12, 0, 1 << 27),
        ],
        build: |v| planar::grid_with_holes(count(v[0]), count(v[1]), count(v[2])),
    },
    Generator {
        name: "triangle-tiling",
        summary: "equilateral triangles, the tiling {3, 6}",
        parameters: GRID,
        build: |v| planar::triangle_tiling(count(v[0]), count(v[1])),
    },
    Generator {
        name: "hexagon-tiling",
        summary: "regular hexagons, the tiling {6, 3}",
        parameters: GRID,
        build: |v| planar::hexagon_tiling(count(v[0]), count(v[1])),
    },
    Generator {
        name: "torus",
        summary: "a torus of quads",
        parameters: TORUS,
        build: |v| surfaces::torus(count(v[0]), count(v[1])),
    },
    Generator {
        name: "triangle-torus",
        summary: "a torus of triangles; every vertex has valence 6",
        parameters: TORUS,
        build: |v| surfaces::triangle_torus(count(v[0]), count(v[1])),
    },
    Generator {
        name: "moebius",
        summary: "a strip of quads with half a twist: one side, one boundary loop",
        parameters: &[Parameter::count(
            "n",
            "cells along the strip",
            40,
            3,
            MAX_SEGMENTS,
        )],
        build: |v| surfaces::moebius(count(v[0])),
    },
    Generator {
        name: "uv-sphere",
        summary: "a sphere of meridians and parallels",
        parameters: &[
            Parameter::count("m", "number of meridians", 32, 3, MAX_SEGMENTS),
            Parameter::count("n", "bands between the poles", 16, 2, MAX_SEGMENTS),
        ],
        build: |v| solids::uv_sphere(count(v[0]), count(v[1])),
    },
    Generator {
        name: "geodesic",
        summary: "an icosahedron with divided edges, projected to a sphere",
        parameters: &[Parameter::count(
            "frequency",
            "number of parts of each edge",
            6,
            1,
            MAX_FREQUENCY,
        )],
        build: |v| geodesic::geodesic(count(v[0])),
    },
    Generator {
        name: "genus",
        summary: "a closed bar of quads with holes through it",
        parameters: &[Parameter::count("g", "number of holes", 2, 0, MAX_SIDE)],
        build: |v| genus::genus(count(v[0])),
    },
    Generator {
        name: "bezier-patch",
        summary: "a Bézier patch over a saddle of control points",
        parameters: &[
            Parameter::count("degree", "degree in both directions", 3, 1, MAX_DEGREE),
            STEPS_M,
            STEPS_N,
        ],
        build: |v| {
            let points = count(v[0]) + 1;
            bezier_patch(
                &ControlNet::saddle(points, points)?,
                count(v[1]),
                count(v[2]),
            )
        },
    },
    Generator {
        name: "b-spline-patch",
        summary: "a uniform B-spline patch over waves of control points",
        parameters: &[
            Parameter::count("degree", "degree in both directions", 3, 1, MAX_DEGREE),
            Parameter::count(
                "points",
                "control points in both directions, more than the degree",
                9,
                2,
                MAX_CONTROL_POINTS,
            ),
            STEPS_M,
            STEPS_N,
        ],
        build: |v| {
            let points = count(v[1]);
            let net = ControlNet::waves(points, points)?;
            b_spline_patch(&net, count(v[0]), count(v[2]), count(v[3]))
        },
    },
    Generator {
        name: "blobs",
        summary: "a sum of Gaussian bells, triangulated by marching tetrahedra",
        parameters: &[faces(5_000, MIN_FACES)],
        build: |v| blobs()?.polygonised(count(v[0])),
    },
    Generator {
        name: "csg",
        summary: "the intersection of a cube and a ball minus three bars: genus 5",
        parameters: &[faces(5_000, 1_000)],
        build: |v| csg()?.polygonised(count(v[0])),
    },
    Generator {
        name: "smooth-union",
        summary: "two linked rings that blend where they meet",
        parameters: &[
            faces(5_000, 1_500),
            Parameter {
                name: "alpha",
                meaning: "sharpness of the blend",
                default: 0.0,
                min: 0.0,
                max: 1.0,
                is_integer: false,
            },
        ],
        build: |v| smooth_union(v[1])?.polygonised(count(v[0])),
    },
    Generator {
        name: "built-in-mesh",
        summary: "the irregular mesh that a study uses if no file is given",
        parameters: &[faces(built_in_mesh::FACES, 6_000)],
        build: |v| built_in_mesh::with_faces(count(v[0])),
    },
];

fn count(value: f64) -> usize {
    value as usize
}

fn blobs() -> Result<Field, ShapeError> {
    let blob = |centre, strength, sharpness| Blob {
        centre,
        strength,
        sharpness,
    };
    let blobs = [
        blob([0.0, 0.0, 0.0], 1.0, 2.0),
        blob([1.0, 0.2, 0.1], 0.9, 3.0),
        blob([-0.5, 0.9, -0.2], 0.8, 2.5),
        blob([-0.6, -0.7, 0.5], 1.1, 4.0),
        blob([0.2, 0.1, 1.0], 0.7, 3.5),
        blob([0.3, -0.4, -0.8], 0.8, 3.0),
    ];
    Field::blobs(&blobs, 0.4)
}

fn csg() -> Result<Field, ShapeError> {
    let cube = Field::cuboid([0.0; 3], [1.0; 3])?;
    let mut solid = cube.intersection(Field::sphere([0.0; 3], 1.35)?)?;
    for axis in 0..3 {
        let mut half = [0.5; 3];
        half[axis] = 2.0;
        solid = solid.difference(Field::cuboid([0.0; 3], half)?)?;
    }
    Ok(solid)
}

fn smooth_union(alpha: f64) -> Result<Field, ShapeError> {
    let flat = Field::torus([-0.5, 0.0, 0.0], [0.0, 0.0, 1.0], 1.0, 0.25)?;
    let upright = Field::torus([0.9, 0.0, 0.0], [0.0, 1.0, 0.0], 1.0, 0.25)?;
    flat.smooth_union(upright, alpha)?.inflated(0.1)
}
