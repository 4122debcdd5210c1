//! Moves each vertex to the mean position of its neighbours, after the means of all vertices are computed.

use std::hint::black_box;

use sixfold::{MeshQuery, Point, Representation, VertexMap};
use sixfold_results::Time;

use crate::sweeps::{All, Elements, Outputs, SweepResult, count_each};
use crate::timed_structure::{fill_caches, fill_caches_with_outputs};
use sixfold_measure::{ElementKind, Outcome, ReusedCopies, Series, TimedRun, field_sum};

#[inline]
pub(super) fn sweep<M: MeshQuery, E: Elements<M>>(
    _: ElementKind,
    mesh: &M,
    elements: &E,
    outputs: &mut Outputs<M>,
) -> SweepResult {
    neighbour_means(mesh, elements, &mut outputs.vertices)
}

/// Computes the mean of the neighbours of each vertex. An isolated vertex keeps its position.
#[inline(never)]
fn neighbour_means<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    means: &mut VertexMap<M, Point>,
) -> SweepResult {
    count_each(elements.vertices(mesh), |v| {
        let (mut sum, mut valence) = (Point::ZERO, 0_u32);
        mesh.vertex_vertices(v).for_each(|neighbour| {
            sum += mesh.position(neighbour);
            valence += 1;
        });
        means[v] = if valence > 0 {
            sum * (1.0 / valence as f32)
        } else {
            mesh.position(v)
        };
    })
}

/// Smooths a copy of the mesh in each run. Each copy starts with the original positions.
pub(crate) fn run<M: Representation>(
    mesh: &M,
    outputs: &mut Outputs<M>,
    series: &Series<'_>,
) -> TimedRun {
    let mut copies = ReusedCopies::default();
    let mut result = SweepResult::default();
    let mut moved = Ok(());
    fill_caches_with_outputs(mesh, outputs, series);
    let time = copies.time(
        series,
        mesh.memory().total(),
        || {
            let copy = mesh.clone();
            fill_caches(&copy, series);
            copy
        },
        |copy| {
            copy.clone_from(mesh);
            fill_caches(copy, series);
        },
        |copy| {
            result = sweep(ElementKind::Vertex, copy, &All, outputs);
            moved = copy.set_positions(&outputs.vertices);
        },
    );
    let outcome = copies.used_copy().filter(|_| series.check).map(|smoothed| {
        let after = smoothed.vertices().map(|v| smoothed.position(v));
        let means = mesh.vertices().map(|v| outputs.vertices[v]);
        // Smoothing can move two vertices to one position. A structure that identifies vertices
        // by position then merges them, or refuses the mesh. The checksum then uses the
        // computed means.
        let apart = smoothed.vertex_count() == mesh.vertex_count();
        let checksum = match moved.is_ok() && apart {
            true => field_sum(after),
            false => field_sum(means),
        };
        Outcome {
            checksum,
            elements: result.elements,
            refused: 0,
        }
    });
    TimedRun::done(time, outcome)
}

/// Returns the time in which a copy of `mesh` takes the means of the neighbours as its positions.
pub(crate) fn time_moving<M: Representation>(
    mesh: &M,
    means: &VertexMap<M, Point>,
    series: &Series<'_>,
) -> Time {
    let mut copy = mesh.clone();
    series.timed(|| {
        let moved = copy.set_positions(means);
        black_box((&mut copy, moved.is_ok()));
    })
}
