//! Marching tetrahedra: triangulates the surface of a solid.

use crate::builder::MeshBuilder;

/// Minimum distance of a crossing from a lattice point, as a fraction of the lattice edge.
///
/// Without this limit, the crossings of all edges at a lattice point could coincide.
pub(crate) const MARGIN: f64 = 0.08;

/// Number of refinement steps after linear interpolation.
const REFINEMENTS: usize = 2;

/// Number of lattice points along a side of a block.
const BLOCK: usize = 8;

/// A solid as a function: negative inside, positive outside.
pub(crate) trait Solid {
    /// Returns the value at a point.
    fn at(&self, point: [f64; 3]) -> f64;

    /// Returns 1 or −1 if all values in a ball certainly have this sign.
    fn sign_over(&self, centre: [f64; 3], radius: f64) -> Option<f64>;
}

/// A lattice of cubes.
pub(crate) struct Lattice {
    /// Lattice point with the lowest coordinates.
    pub(crate) origin: [f64; 3],
    /// Side length of a cube.
    pub(crate) spacing: f64,
    /// Number of cubes along each axis.
    pub(crate) cells: [usize; 3],
}

impl Lattice {
    /// Returns the number of cubes.
    pub(crate) fn cubes(&self) -> f64 {
        self.cells.iter().map(|&count| count as f64).product()
    }

    fn point(&self, at: [usize; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.origin[axis] + self.spacing * at[axis] as f64)
    }

    fn is_outermost(&self, at: [usize; 3]) -> bool {
        (0..3).any(|axis| at[axis] == 0 || at[axis] == self.cells[axis])
    }
}

/// Six tetrahedra of a cube, as paths along edges from corner 000 to corner 111 (bits zyx). The
/// first three paths have positive orientation, the last three have negative orientation.
const PATHS: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 2, 6, 7],
    [0, 4, 5, 7],
    [0, 1, 5, 7],
    [0, 2, 3, 7],
    [0, 4, 6, 7],
];

/// Builds the surface between the lattice points inside `solid` and all others.
///
/// Every cube is divided into six tetrahedra around its diagonal (Kuhn). In each tetrahedron that
/// the surface crosses, the surface is one triangle or two (Doi and Koide 1991). Each lattice edge
/// with exactly one end inside has one vertex of the surface. Points at the border of the lattice
/// count as outside. So the surface is a closed, consistently oriented manifold for any values.
/// Time: O(lattice points).
pub(crate) fn polygonised<S: Solid>(solid: &S, lattice: &Lattice) -> MeshBuilder {
    let [nx, ny, nz] = lattice.cells;
    let mut sweep = Sweep {
        solid,
        lattice,
        signs: Vec::new(),
        builder: MeshBuilder::with_capacity(0, 0),
        values: [
            vec![1.0; (nx + 1) * (ny + 1)],
            vec![1.0; (nx + 1) * (ny + 1)],
        ],
        crossings: [
            vec![[None; 8]; (nx + 1) * (ny + 1)],
            vec![[None; 8]; (nx + 1) * (ny + 1)],
        ],
        touched: [Vec::new(), Vec::new()],
    };
    // All points of the lowest layer are outside, which is the initial value.
    for z in 0..nz {
        sweep.sample(z + 1);
        for y in 0..ny {
            for x in 0..nx {
                sweep.add_cube([x, y, z]);
            }
        }
        sweep.values.swap(0, 1);
        sweep.crossings.swap(0, 1);
        sweep.touched.swap(0, 1);
        for column in sweep.touched[1].drain(..) {
            sweep.crossings[1][column] = [None; 8];
        }
    }
    sweep.builder
}

/// Two layers of the lattice.
struct Sweep<'a, S> {
    solid: &'a S,
    lattice: &'a Lattice,
    builder: MeshBuilder,
    values: [Vec<f64>; 2],
    /// For each lattice point and direction (bits zyx): the vertex on that lattice edge.
    crossings: [Vec<[Option<u32>; 8]>; 2],
    /// Lattice points with crossings, once per crossing.
    touched: [Vec<usize>; 2],
    /// For each block of the upper layer's slab: the sign of all values, if certain.
    signs: Vec<Option<f64>>,
}

impl<S: Solid> Sweep<'_, S> {
    fn sample(&mut self, z: usize) {
        let [nx, ny, _] = self.lattice.cells;
        if z == 1 || z.is_multiple_of(BLOCK) {
            self.sign_blocks(z / BLOCK);
        }
        for y in 0..=ny {
            for x in 0..=nx {
                let at = [x, y, z];
                let sign = self.signs[y / BLOCK * (nx / BLOCK + 1) + x / BLOCK];
                self.values[1][y * (nx + 1) + x] = match sign {
                    _ if self.lattice.is_outermost(at) => 1.0,
                    Some(sign) => sign,
                    None => self.solid.at(self.lattice.point(at)),
                };
            }
        }
    }

    /// Tests the sign of each block of slab `z`, including the points next to the block. If all
    /// values have one sign, no surface crosses the block, and the values are not needed.
    fn sign_blocks(&mut self, z: usize) {
        let [nx, ny, _] = self.lattice.cells;
        let spacing = self.lattice.spacing;
        let half = (BLOCK + 1) as f64 / 2.0;
        let radius = half * spacing * 3.0_f64.sqrt();
        self.signs.clear();
        for y in 0..=ny / BLOCK {
            for x in 0..=nx / BLOCK {
                let first = self.lattice.point([x, y, z].map(|block| block * BLOCK));
                let centre = first.map(|low| low + (half - 1.0) * spacing);
                self.signs.push(self.solid.sign_over(centre, radius));
            }
        }
    }

    fn add_cube(&mut self, cube: [usize; 3]) {
        let corner = |bits: usize| self.values[bits >> 2][self.column(cube, bits)] < 0.0;
        let inside: [bool; 8] = std::array::from_fn(corner);
        if inside == [inside[0]; 8] {
            return;
        }
        for (i, path) in PATHS.into_iter().enumerate() {
            self.add_tetrahedron(cube, path, &inside, i < 3);
        }
    }

    fn column(&self, [x, y, _]: [usize; 3], bits: usize) -> usize {
        (y + (bits >> 1 & 1)) * (self.lattice.cells[0] + 1) + x + (bits & 1)
    }

    fn add_tetrahedron(
        &mut self,
        cube: [usize; 3],
        path: [usize; 4],
        inside: &[bool; 8],
        is_positive: bool,
    ) {
        let mut corners = path;
        let mut is_even = is_positive;
        for end in (1..4).rev() {
            for i in 0..end {
                if !inside[corners[i]] && inside[corners[i + 1]] {
                    corners.swap(i, i + 1);
                    is_even = !is_even;
                }
            }
        }
        if !is_even {
            // Swaps two corners on the same side of the surface.
            if inside[corners[2]] {
                corners.swap(0, 1);
            } else {
                corners.swap(2, 3);
            }
        }
        let [a, b, c, d] = corners;
        match corners.map(|corner| inside[corner]) {
            [true, false, ..] => {
                let triangle =
                    [(a, b), (a, c), (a, d)].map(|edge| self.crossing_vertex(cube, edge));
                self.builder.add_face(triangle);
            }
            [true, true, false, _] => {
                let quad = [(a, c), (a, d), (b, d), (b, c)];
                let quad = quad.map(|edge| self.crossing_vertex(cube, edge));
                self.add_quad(quad);
            }
            [true, true, true, false] => {
                let triangle =
                    [(a, d), (b, d), (c, d)].map(|edge| self.crossing_vertex(cube, edge));
                self.builder.add_face(triangle);
            }
            _ => {}
        }
    }

    /// Cuts the quad along the diagonal from the vertex with the lowest number.
    ///
    /// So the faces depend only on which lattice points are inside.
    fn add_quad(&mut self, [a, b, c, d]: [u32; 4]) {
        if a.min(c) < b.min(d) {
            self.builder.add_face([a, b, c]);
            self.builder.add_face([a, c, d]);
        } else {
            self.builder.add_face([a, b, d]);
            self.builder.add_face([b, c, d]);
        }
    }

    fn crossing_vertex(&mut self, cube: [usize; 3], (p, q): (usize, usize)) -> u32 {
        // Along a path, bits are only added. So the lower end has a subset of the bits of the other
        // end.
        let (low, high) = (p & q, p | q);
        let (layer, column) = (low >> 2, self.column(cube, low));
        if let Some(vertex) = self.crossings[layer][column][high ^ low] {
            return vertex;
        }
        let values = [
            self.values[layer][column],
            self.values[high >> 2][self.column(cube, high)],
        ];
        let ends = [low, high].map(|bits| self.lattice.point(corner_index(cube, bits)));
        let vertex = self.builder.add_vertex(self.root(ends, values));
        self.crossings[layer][column][high ^ low] = Some(vertex);
        self.touched[layer].push(column);
        vertex
    }

    /// Finds a zero of the field between two points on opposite sides of the surface.
    fn root(&self, ends: [[f64; 3]; 2], [mut start, mut end]: [f64; 2]) -> [f64; 3] {
        let (mut low, mut high) = (0.0, 1.0);
        let crossing = |low: f64, high: f64, start: f64, end: f64| {
            let part = start / (start - end);
            let part = if part.is_finite() { part } else { 0.5 };
            low + part * (high - low)
        };
        let mut part = crossing(low, high, start, end);
        for _ in 0..REFINEMENTS {
            let value = self.solid.at(interpolate(ends, part));
            if (value < 0.0) == (start < 0.0) {
                (low, start) = (part, value);
            } else {
                (high, end) = (part, value);
            }
            part = crossing(low, high, start, end);
        }
        interpolate(ends, part.clamp(MARGIN, 1.0 - MARGIN))
    }
}

fn interpolate([a, b]: [[f64; 3]; 2], part: f64) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + part * (b[axis] - a[axis]))
}

fn corner_index([x, y, z]: [usize; 3], bits: usize) -> [usize; 3] {
    [x + (bits & 1), y + (bits >> 1 & 1), z + (bits >> 2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use sixfold_core::Facts;

    impl<F: Fn([f64; 3]) -> f64> Solid for F {
        fn at(&self, point: [f64; 3]) -> f64 {
            self(point)
        }

        fn sign_over(&self, _: [f64; 3], _: f64) -> Option<f64> {
            None
        }
    }

    #[test]
    fn any_field_gives_a_closed_oriented_manifold() {
        let lattice = Lattice {
            origin: [-3.0, 0.5, 9.0],
            spacing: 0.7,
            cells: [9, 7, 8],
        };
        for seed in 0..100_u64 {
            // A hash of the position, between −1 and 1.
            let noise = |point: [f64; 3]| {
                let bits = point.iter().fold(seed, |hash, x| {
                    (hash ^ x.to_bits())
                        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
                        .rotate_left(29)
                });
                (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
            };
            let mesh = polygonised(&noise, &lattice).build();
            let facts = Facts::from_polygons(&mesh);
            assert!(facts.closed && facts.faces > 1000, "seed {seed}");
            assert_eq!(facts.consistently_oriented, Some(true), "seed {seed}");
            let none = [
                facts.non_manifold_edges,
                facts.non_manifold_vertices,
                facts.isolated_vertices,
                facts.duplicate_faces,
            ];
            assert_eq!(none, [0; 4], "seed {seed}");
        }
    }

    #[test]
    fn one_inside_point_gives_a_closed_surface_around_it() {
        let lattice = Lattice {
            origin: [-1.0; 3],
            spacing: 1.0,
            cells: [2; 3],
        };
        let inside = |point: [f64; 3]| if point == [0.0; 3] { -1.0 } else { 1.0 };
        let mesh = polygonised(&inside, &lattice).build();
        // The link of a lattice point has one vertex on each of 14 edges and one triangle in each
        // of 24 tetrahedra.
        assert_eq!((mesh.vertex_count(), mesh.face_count()), (14, 24));
        for (f, face) in mesh.faces().iter() {
            let [a, b, c] = [0, 1, 2].map(|i| mesh.position(face[i]));
            assert!((b - a).cross(c - a).dot(a) > 0.0, "{f} is oriented inward");
        }
    }

    #[test]
    fn nan_and_infinite_values_give_a_closed_finite_mesh() {
        let lattice = Lattice {
            origin: [0.0; 3],
            spacing: 1.0,
            cells: [5; 3],
        };
        for special in [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::MAX,
            f64::MIN,
        ] {
            let field = |[x, y, z]: [f64; 3]| match (x + y + z) as u32 % 3 {
                0 => special,
                1 => -1.0,
                _ => 1.0,
            };
            let builder = polygonised(&field, &lattice);
            let mesh = builder.build();
            assert!(mesh.positions().iter().all(|p| p.is_finite()), "{special}");
            assert!(Facts::from_polygons(&mesh).closed, "{special}");
        }
    }
}
