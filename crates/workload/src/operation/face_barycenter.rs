//! Stores for each face the mean of its vertex positions.

use sixfold::{FaceMap, MeshQuery, Point};

use crate::sweeps::{Elements, Outputs, SweepResult, count_each};
use sixfold_measure::ElementKind;

#[inline]
pub(super) fn sweep<M: MeshQuery, E: Elements<M>>(
    _: ElementKind,
    mesh: &M,
    elements: &E,
    outputs: &mut Outputs<M>,
) -> SweepResult {
    face_barycenters(mesh, elements, &mut outputs.faces)
}

#[inline(never)]
fn face_barycenters<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    barycenters: &mut FaceMap<M, Point>,
) -> SweepResult {
    count_each(elements.faces(mesh), |f| {
        let (mut sum, mut corners) = (Point::ZERO, 0_u32);
        mesh.face_vertices(f).for_each(|v| {
            sum += mesh.position(v);
            corners += 1;
        });
        barycenters[f] = sum * (1.0 / corners as f32);
    })
}
