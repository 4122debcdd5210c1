//! Laplacian smoothing, by uniform and by cotangent weights.

use glam::DVec3;
use mesh_core::{MeshQuery, Point, VertexMap};

use crate::error::SmoothingError;
use crate::laplacian::{Laplacian, Pull};

/// How strongly each neighbour pulls a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weights {
    /// All alike (Field 1988): evens out the shapes of faces too.
    #[default]
    Uniform,
    /// By the two angles opposite to the edge (Pinkall & Polthier 1993): follows the surface alone,
    /// and leaves a plane as it is. Triangles only.
    Cotangent,
}

/// What becomes of vertices on boundary edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// They stay.
    #[default]
    Fixed,
    /// Each moves towards the mean of its two neighbours on the boundary, whatever is inside. One
    /// with more than two boundary edges stays.
    Curve,
}

/// How to smooth.
///
/// The default is ten iterations of half a step with uniform weights, the boundary fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing {
    /// How strongly each neighbour pulls.
    pub weights: Weights,
    /// What becomes of the boundary.
    pub boundary: Boundary,
    /// λ: how far each vertex goes towards the mean of its neighbours; from 0 to 1.
    pub step: f64,
    /// μ < −λ: a step away again after each step, which keeps the volume (Taubin 1995); his own
    /// numbers are λ = 0.33 and μ = −0.34.
    pub step_back: Option<f64>,
    /// How often.
    pub iterations: usize,
}

impl Default for Smoothing {
    fn default() -> Self {
        Self {
            weights: Weights::Uniform,
            boundary: Boundary::Fixed,
            step: 0.5,
            step_back: None,
            iterations: 10,
        }
    }
}

impl Smoothing {
    /// Whether the steps make a mesh smoother.
    fn check(&self) -> Result<(), SmoothingError> {
        let step = self.step;
        if !(0.0..=1.0).contains(&step) {
            return Err(SmoothingError::Step { step });
        }
        // What one iteration does to the roughest wave of all, for which L is twice the wave back.
        let roughest = |back: f64| (1.0 - 2.0 * step) * (1.0 - 2.0 * back);
        match self.step_back {
            Some(back) if !(back < -step && roughest(back).abs() <= 1.0) => {
                Err(SmoothingError::StepBack { step, back })
            }
            _ => Ok(()),
        }
    }
}

/// Where every vertex of `mesh` comes to when neighbours pull at each other.
///
/// ```text
///        p              p ← p + λ L(p)     L(p): from p to the mean of its neighbours,
///       ╱↓╲                                all vertices at once
///      ╱ p'╲
///     a ─── b           a step back        p ← p + μ L(p)
/// ```
///
/// Isolated vertices stay, and so do vertices of which no triangle is thick enough to tell its
/// angles. An edge with three faces pulls as any other, by all its angles. Cotangents are taken
/// anew at every step; with obtuse triangles a weight can be negative, and then steps above one half
/// can overshoot.
///
/// All iterations run on the map that is returned; the mesh and its names stay as they are. Where a
/// vertex is its coordinates, [`set_positions`] then renames it, welds vertices that have met, and
/// refuses to weld two corners of one face.
///
/// # Errors
///
/// [`SmoothingError::Step`] and [`SmoothingError::StepBack`] for steps that would not smooth;
/// [`SmoothingError::NotATriangle`] for the first polygon under cotangent weights.
///
/// # Complexity
///
/// O(corners) to read the mesh, then O(edges), or O(faces), for each iteration.
///
/// # Examples
///
/// ```
/// use indexed_face_set::IndexedFaceSet;
/// use mesh_core::{MeshQuery, Representation};
/// use operators::{Smoothing, smoothed};
///
/// // The neighbours of a vertex of the octahedron balance around the centre: half of the way.
/// let octahedron = IndexedFaceSet::from_polygons(&shapes::octahedron())?;
/// let once = Smoothing { iterations: 1, ..Smoothing::default() };
/// let moved = smoothed(&octahedron, &once)?;
/// assert!(octahedron.vertices().all(|v| moved[v] == octahedron.position(v) / 2.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// [`set_positions`]: mesh_core::Representation::set_positions
pub fn smoothed<M: MeshQuery>(
    mesh: &M,
    smoothing: &Smoothing,
) -> Result<VertexMap<M, Point>, SmoothingError> {
    smoothing.check()?;
    let laplacian = Laplacian::of(mesh, smoothing.weights, smoothing.boundary)?;
    let vertices: Vec<M::Vertex> = mesh.vertices().collect();
    let mut at = mesh.vertex_map(DVec3::ZERO);
    for &v in &vertices {
        at[v] = mesh.position(v).as_dvec3();
    }
    let mut pulls = mesh.vertex_map(Pull::default());
    for _ in 0..smoothing.iterations {
        for step in [Some(smoothing.step), smoothing.step_back]
            .into_iter()
            .flatten()
        {
            laplacian.pull(&at, &mut pulls);
            for &v in &vertices {
                at[v] += step * std::mem::take(&mut pulls[v]).way();
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
