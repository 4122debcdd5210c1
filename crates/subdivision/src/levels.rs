//! Runs several subdivision steps. The input and the result are polygon meshes.

use std::ops::ControlFlow;

use sixfold_core::{Creases, FaceId, FaceList, PolygonMesh, Refine, Representation, VertexId};

use crate::error::SubdivisionError;
use crate::scheme::Method;
use crate::step::Step;
use crate::subdivision::Subdivision;

/// Runs `levels` steps of a scheme. A structure of type `M` is built for each step. The faces that the boundary rule [`BoundaryRule::None`](crate::BoundaryRule::None)
/// removes are removed after the last step. If `levels` is 0, returns the input mesh.
///
/// # Errors
///
/// Returns an error if the scheme cannot split the mesh, or if `M` cannot hold the mesh. Returns
/// [`SubdivisionError::NoMethod`] for [`Method::Native`]; [`subdivide_native`] runs this method.
pub fn subdivide<M: Representation>(
    subdivision: &Subdivision,
    method: Method,
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
) -> Result<Step, SubdivisionError> {
    let mut go_on = |_, _| ControlFlow::Continue(());
    subdivide_watched::<M>(subdivision, method, polygons, creases, levels, &mut go_on)
}

/// Subdivides like [`subdivide`]. After each step, calls `watch` with the level and the number of
/// faces of the refined mesh; the level after the first step is 1.
///
/// # Errors
///
/// Fails like [`subdivide`]. Returns [`SubdivisionError::Stopped`] if `watch` returns
/// `ControlFlow::Break`.
pub fn subdivide_watched<M: Representation>(
    subdivision: &Subdivision,
    method: Method,
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
    watch: &mut dyn FnMut(u32, usize) -> ControlFlow<()>,
) -> Result<Step, SubdivisionError> {
    subdivide_by(
        subdivision,
        polygons,
        creases,
        levels,
        watch,
        &mut |step, level| {
            let mesh = build_level::<M>(&step.polygons, level)?;
            let creases = subdivision.level_creases(&mesh, step, level)?;
            subdivision.step(method, &mesh, &creases, level)
        },
    )
}

/// Subdivides like [`subdivide_watched`], by steps of the caller. `step` gets the mesh before a step
/// and the level of the step, from 0, and returns the mesh after the step.
///
/// # Errors
///
/// Returns the first error of `step`, and [`SubdivisionError::Stopped`] if `watch` returns
/// `ControlFlow::Break`.
pub fn subdivide_by(
    subdivision: &Subdivision,
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
    watch: &mut dyn FnMut(u32, usize) -> ControlFlow<()>,
    step: &mut dyn FnMut(&Step, u32) -> Result<Step, SubdivisionError>,
) -> Result<Step, SubdivisionError> {
    let mut last = Step {
        polygons: polygons.clone(),
        creases: creases.clone(),
    };
    if levels == 0 {
        return Ok(last);
    }
    let mut left_out = subdivision.left_out(polygons, creases);
    for level in 0..levels {
        let next = step(&last, level)?;
        // The parts of one face are consecutive.
        left_out = left_out.map(|left_out| {
            let degrees = last.polygons.faces().iter().map(|(_, face)| face.len());
            let parts = degrees.map(|degree| subdivision.parts_of(degree));
            let each = left_out.into_iter().zip(parts);
            each.flat_map(|(out, parts)| std::iter::repeat_n(out, parts))
                .collect()
        });
        last = next;
        report_level(watch, level + 1, last.polygons.face_count())?;
    }
    Ok(without_faces(last, left_out))
}

/// Builds a structure of type `M` once, and runs `levels` steps that split the tables of the
/// structure. With the feature `rayon`, steps use the threads of the current rayon pool. The result
/// equals the result of [`subdivide`], but faces and edge points are in the order of the tables of
/// the structure.
///
/// # Errors
///
/// Returns an error in these cases:
///
/// - The scheme cannot split the mesh.
/// - `M` cannot hold the mesh.
/// - `M` cannot split its own tables.
pub fn subdivide_native<M: Refine>(
    subdivision: &Subdivision,
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
) -> Result<Step, SubdivisionError> {
    let mut go_on = |_, _| ControlFlow::Continue(());
    subdivide_native_watched::<M>(subdivision, polygons, creases, levels, &mut go_on)
}

/// Subdivides like [`subdivide_native`], and calls `watch` like [`subdivide_watched`].
///
/// # Errors
///
/// Fails like [`subdivide_native`]. Returns [`SubdivisionError::Stopped`] if `watch` returns
/// `ControlFlow::Break`.
pub fn subdivide_native_watched<M: Refine>(
    subdivision: &Subdivision,
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
    watch: &mut dyn FnMut(u32, usize) -> ControlFlow<()>,
) -> Result<Step, SubdivisionError> {
    if levels == 0 {
        return Ok(Step {
            polygons: polygons.clone(),
            creases: creases.clone(),
        });
    }
    let mut left_out = subdivision.left_out(polygons, creases);
    let mut mesh = build_level::<M>(polygons, 0)?;
    let mut creases = subdivision.control_creases(&mesh, polygons, creases)?;
    let mut numbers = M::EdgeNumbers::default();
    for level in 0..levels {
        let mut child = M::empty();
        creases = subdivision.refine_into(&mesh, &creases, level, &mut numbers, &mut child)?;
        left_out = left_out
            .zip(subdivision.split(level))
            .map(|(left_out, split)| {
                let parents = child.faces().map(|f| mesh.parent(&numbers, split, f));
                parents.map(|f| left_out[f.index()]).collect()
            });
        mesh = child;
        report_level(watch, level + 1, mesh.face_count())?;
    }
    let polygons = mesh.to_polygons();
    Ok(without_faces(Step { polygons, creases }, left_out))
}

fn report_level(
    watch: &mut dyn FnMut(u32, usize) -> ControlFlow<()>,
    level: u32,
    faces: usize,
) -> Result<(), SubdivisionError> {
    match watch(level, faces) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(SubdivisionError::Stopped { level }),
    }
}

/// Builds a structure of type `M` from the polygons of a level.
///
/// # Errors
///
/// Returns [`SubdivisionError::Build`] with the level, and with the reason why `M` cannot hold the
/// mesh. The control mesh has level 0.
pub fn build_level<M: Representation>(
    polygons: &PolygonMesh,
    level: u32,
) -> Result<M, SubdivisionError> {
    M::from_polygons(polygons).map_err(|refusal| SubdivisionError::Build {
        structure: M::NAME,
        level,
        refusal,
    })
}

/// Returns the mesh without the faces that are left out, and without the vertices that belong only
/// to these faces.
fn without_faces(step: Step, left_out: Option<Vec<bool>>) -> Step {
    let Some(left_out) = left_out.filter(|left_out| left_out.contains(&true)) else {
        return step;
    };
    let Step { polygons, creases } = step;
    let is_kept = |f: FaceId| !left_out[f.index()];
    let faces = || polygons.faces().iter();
    let mut on_kept = vec![false; polygons.vertex_count()];
    let mut on_removed = on_kept.clone();
    for (f, face) in faces() {
        let marks = if is_kept(f) {
            &mut on_kept
        } else {
            &mut on_removed
        };
        for v in face {
            marks[v.index()] = true;
        }
    }
    let mut positions = Vec::new();
    let mut new_ids = vec![None; polygons.vertex_count()];
    for v in polygons.vertices() {
        // Vertices that were isolated before are kept.
        if on_kept[v.index()] || !on_removed[v.index()] {
            new_ids[v.index()] = Some(VertexId::new(positions.len() as u32));
            positions.push(polygons.position(v));
        }
    }
    let mut kept = FaceList::default();
    for (_, face) in faces().filter(|&(f, _)| is_kept(f)) {
        let new_face = face.iter().filter_map(|v| new_ids[v.index()]);
        kept.push(new_face).expect("fewer faces than before");
    }
    let edges = creases.edges().iter().filter_map(|&(ends, sharpness)| {
        let [a, b] = ends.ends().map(|v| new_ids[v.index()]);
        Some((sixfold_core::Pair::new(a?, b?), sharpness))
    });
    let corners = creases.corners().iter();
    let corners = corners.filter_map(|&(v, sharpness)| Some((new_ids[v.index()]?, sharpness)));
    let creases = Creases::from_entries(edges.collect(), corners.collect());
    let polygons = PolygonMesh::from_faces(positions, kept).expect("faces of a mesh");
    Step { polygons, creases }
}

#[cfg(test)]
mod tests {
    use sixfold_half_edge::HalfEdgeMesh;

    use super::*;
    use crate::scheme::Scheme;

    #[test]
    fn a_watch_sees_every_level_and_can_stop() {
        let (cube, none) = (sixfold_shapes::cube(), Creases::default());
        let scheme = Subdivision::new(Scheme::CatmullClark);
        for last in 1..=3 {
            for native in [false, true] {
                let mut seen = Vec::new();
                let mut watch = |level, faces| {
                    seen.push((level, faces));
                    match level < last {
                        true => ControlFlow::Continue(()),
                        false => ControlFlow::Break(()),
                    }
                };
                let stopped = match native {
                    true => subdivide_native_watched::<HalfEdgeMesh>(
                        &scheme, &cube, &none, 4, &mut watch,
                    ),
                    false => subdivide_watched::<HalfEdgeMesh>(
                        &scheme,
                        Method::Gather,
                        &cube,
                        &none,
                        4,
                        &mut watch,
                    ),
                };
                let error = stopped.expect_err("the watch stops it");
                assert_eq!(error, SubdivisionError::Stopped { level: last });
                let expected = [(1, 24), (2, 96), (3, 384)];
                assert_eq!(seen, expected[..last as usize]);
            }
        }
    }
}
