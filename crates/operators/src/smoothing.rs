//! Laplacian smoothing, with uniform or cotangent weights.

use glam::DVec3;
use sixfold_core::{MeshQuery, Point, VertexMap};

use crate::error::SmoothingError;
use crate::laplacian::{Laplacian, WeightedSum};

sixfold_core::named! {
    /// The weights of the neighbours of a vertex.
    #[derive(Default)]
    pub enum Weights: "set of weights" {
        /// Equal weights for all neighbours (Field 1988). Uniform weights also make the shapes of
        /// the faces more even.
        #[default]
        Uniform = "uniform",
        /// Weights from the two angles opposite to the edge (Pinkall & Polthier 1993). With
        /// cotangent weights, the inner vertices of a flat mesh do not move. All faces must be
        /// triangles.
        Cotangent = "cotangent",
    }
}

sixfold_core::named! {
    /// The treatment of vertices on boundary edges.
    #[derive(Default)]
    pub enum SmoothingBoundary: "boundary rule" {
        /// Boundary vertices do not move.
        #[default]
        Fixed = "fixed",
        /// A boundary vertex with exactly two boundary edges moves towards the mean of its two
        /// neighbours on the boundary. A vertex with another number of boundary edges does not
        /// move.
        Curve = "curve",
    }
}

/// The options of [`smoothed`].
///
/// The default is ten iterations with step 0.5, uniform weights and a fixed boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing {
    /// The weights of the neighbours.
    pub weights: Weights,
    /// The treatment of vertices on boundary edges.
    pub boundary: SmoothingBoundary,
    /// The step λ, from 0 to 1. A vertex moves towards the mean of its neighbours, by the fraction
    /// λ of the distance.
    pub step: f64,
    /// The step back μ, with μ < −λ; `None` for no step back. After each step, a vertex moves away
    /// from the mean of its neighbours, by the fraction −μ of the distance. The product (1 − 2λ)(1
    /// − 2μ) must be between −1 and 1. The step back keeps the volume of the mesh nearly constant
    /// (Taubin 1995). Taubin's values are λ = 0.33 and μ = −0.34.
    pub step_back: Option<f64>,
    /// The number of iterations.
    pub iterations: usize,
}

impl Default for Smoothing {
    fn default() -> Self {
        Self {
            weights: Weights::Uniform,
            boundary: SmoothingBoundary::Fixed,
            step: 0.5,
            step_back: None,
            iterations: 10,
        }
    }
}

impl Smoothing {
    /// Returns an error if the steps do not make a mesh smoother.
    fn check(&self) -> Result<(), SmoothingError> {
        let step = self.step;
        if !(0.0..=1.0).contains(&step) {
            return Err(SmoothingError::Step { step });
        }
        // The factor of one iteration for the roughest wave, where L(p) = −2p.
        let roughest = |back: f64| (1.0 - 2.0 * step) * (1.0 - 2.0 * back);
        match self.step_back {
            Some(back) if !(back < -step && roughest(back).abs() <= 1.0) => {
                Err(SmoothingError::StepBack { step, back })
            }
            _ => Ok(()),
        }
    }
}

/// Returns the positions of all vertices after `smoothing.iterations` iterations. Each iteration
/// moves every vertex towards the mean of its neighbours.
///
/// ```text
///        p              p ← p + λ L(p)     L(p): from p to the mean of its neighbours,
///       ╱↓╲                                all vertices at once
///      ╱ p'╲
///     a ─── b           a step back        p ← p + μ L(p)
/// ```
///
/// Isolated vertices do not move. With cotangent weights, a vertex does not move if all its
/// triangles are too flat to have reliable angles. The cotangents are computed again at every step.
/// A weight can be negative if triangles are obtuse, and a step above 0.5 can then move a vertex
/// too far.
///
/// The mesh and its handles do not change. If a structure identifies a vertex by its coordinates, a
/// later call of [`set_positions`] changes the handles, and vertices with the same new position
/// become one vertex. [`set_positions`] returns an error if two corners of one face have the same
/// new position.
///
/// # Errors
///
/// Returns [`SmoothingError::Step`] or [`SmoothingError::StepBack`] if the steps would not make the
/// mesh smoother. With cotangent weights, returns [`SmoothingError::NotATriangle`] for the first
/// face that is not a triangle.
///
/// # Complexity
///
/// Reading the mesh takes O(corners) time. Each iteration takes O(vertices + edges) time with
/// uniform weights and O(vertices + faces) time with cotangent weights.
///
/// # Examples
///
/// ```
/// use sixfold_indexed_face_set::IndexedFaceSet;
/// use sixfold_core::{MeshQuery, Representation};
/// use sixfold_operators::{Smoothing, smoothed};
///
/// // The mean of the neighbours of each vertex is the centre; step 0.5 moves it half of the way.
/// let octahedron = IndexedFaceSet::from_polygons(&sixfold_shapes::octahedron())?;
/// let once = Smoothing { iterations: 1, ..Smoothing::default() };
/// let moved = smoothed(&octahedron, &once)?;
/// assert!(octahedron.vertices().all(|v| moved[v] == octahedron.position(v) / 2.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// [`set_positions`]: sixfold_core::MeshMove::set_positions
pub fn smoothed<M: MeshQuery>(
    mesh: &M,
    smoothing: &Smoothing,
) -> Result<VertexMap<M, Point>, SmoothingError> {
    smoothing.check()?;
    let laplacian = Laplacian::new(mesh, smoothing.weights, smoothing.boundary)?;
    let vertices: Vec<M::Vertex> = mesh.vertices().collect();
    let mut at = mesh.vertex_map(DVec3::ZERO);
    for &v in &vertices {
        at[v] = mesh.position(v).as_dvec3();
    }
    let mut sums = mesh.vertex_map(WeightedSum::default());
    for _ in 0..smoothing.iterations {
        for step in [Some(smoothing.step), smoothing.step_back]
            .into_iter()
            .flatten()
        {
            laplacian.apply(&at, &mut sums);
            for &v in &vertices {
                at[v] += step * std::mem::take(&mut sums[v]).mean();
            }
        }
    }
    let mut moved = mesh.vertex_map(Point::ZERO);
    for &v in &vertices {
        moved[v] = at[v].as_vec3();
    }
    Ok(moved)
}

#[cfg(test)]
mod tests;
