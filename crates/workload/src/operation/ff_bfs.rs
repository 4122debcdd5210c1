//! Traverses all faces breadth first and adds the depths of the faces.

use sixfold::MeshQuery;

use crate::sweeps::{Elements, Outputs, SweepResult};
use sixfold_measure::ElementKind;

#[inline]
pub(super) fn sweep<M: MeshQuery, E: Elements<M>>(
    _: ElementKind,
    mesh: &M,
    _: &E,
    _: &mut Outputs<M>,
) -> SweepResult {
    breadth_first(mesh)
}

/// Returns the sum of all depths.
///
/// Every neighbour is written to the end of the queue, but the queue grows only if the neighbour is
/// new. This avoids a branch that a processor cannot predict.
#[inline(never)]
fn breadth_first<M: MeshQuery>(mesh: &M) -> SweepResult {
    const UNVISITED: u32 = u32::MAX;
    let Some(first) = mesh.faces().next() else {
        return SweepResult::default();
    };
    let mut depths = mesh.face_map(UNVISITED);
    let mut queue = vec![first; mesh.face_count() + 1];
    let (mut head, mut tail, mut sum) = (0, 0, 0_u64);
    for seed in mesh.faces() {
        if depths[seed] != UNVISITED {
            continue;
        }
        depths[seed] = 0;
        queue[tail] = seed;
        tail += 1;
        while head < tail {
            let face = queue[head];
            head += 1;
            let depth = depths[face];
            sum += u64::from(depth);
            mesh.face_faces(face).for_each(|neighbour| {
                let seen = &mut depths[neighbour];
                let new = *seen == UNVISITED;
                *seen = if new { depth + 1 } else { *seen };
                queue[tail] = neighbour;
                tail += usize::from(new);
            });
        }
    }
    SweepResult {
        elements: tail as u64,
        count: sum,
        sum: 0.0,
    }
}
