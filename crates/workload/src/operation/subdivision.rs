//! One step of Catmull–Clark or Loop subdivision, on one thread.

use std::collections::BTreeSet;
use std::hint::black_box;
use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};
use sixfold::subdivision::{FaceKind, Method, Scheme, SubdivisionError};
use sixfold::{Creases, Point, PolygonMesh, Relation, VertexId};
use sixfold_results::OperationGroup;

use super::{Checksum, Description, ElementKind, Unit, noise_of_corners};
use crate::backend::Backend;
use crate::job::{ElementSample, Outcome, TimedRun};
use crate::series::Series;
use crate::subdivision_job::SubdivisionJob;

/// The description of one step by `scheme`, for each method.
pub(super) const CATMULL_CLARK: [Description; 3] = [
    describe(
        (Scheme::CatmullClark, Method::Gather),
        "catmull_clark_gather",
        "Catmull–Clark; new points query neighbours",
    ),
    describe(
        (Scheme::CatmullClark, Method::Scatter),
        "catmull_clark_scatter",
        "Catmull–Clark; one pass over the faces",
    ),
    describe(
        (Scheme::CatmullClark, Method::Native),
        "catmull_clark_native",
        "Catmull–Clark; splits the structure's tables",
    ),
];

pub(super) const LOOP: [Description; 3] = [
    describe(
        (Scheme::Loop, Method::Gather),
        "loop_gather",
        "Loop; new points query neighbours",
    ),
    describe(
        (Scheme::Loop, Method::Scatter),
        "loop_scatter",
        "Loop; one pass over the faces",
    ),
    describe(
        (Scheme::Loop, Method::Native),
        "loop_native",
        "Loop; splits the structure's tables",
    ),
];

const fn describe(step: (Scheme, Method), name: &'static str, about: &'static str) -> Description {
    const EDGES: &[Relation] = &[Relation::EdgeVertices, Relation::EdgeFaces];
    const FACES: &[Relation] = &[Relation::FaceVertices, Relation::FaceEdges];
    let (scheme, method) = step;
    Description {
        name,
        about,
        unit: Unit::NewFace,
        group: OperationGroup::Subdivision,
        visits: match (method, scheme) {
            (Method::Scatter, _) => &[(ElementKind::Face, FACES)],
            (_, Scheme::Loop) => &[
                (ElementKind::Vertex, &[Relation::VertexVertices]),
                (ElementKind::Edge, EDGES),
                (ElementKind::Face, FACES),
            ],
            _ => &[
                (
                    ElementKind::Vertex,
                    &[Relation::VertexVertices, Relation::VertexFaces],
                ),
                (ElementKind::Edge, EDGES),
                (ElementKind::Face, FACES),
            ],
        },
        checksum: Checksum::Positions,
        noise: noise_of_corners,
        takes_samples: false,
        allocates: true,
        grows_tables: matches!(method, Method::Native),
        elements: match scheme {
            Scheme::Loop => |polygons| polygons.face_count().saturating_mul(4),
            _ => PolygonMesh::corner_count,
        },
        subdivision: Some(step),
        ..Description::QUERIES
    }
}

/// Subdivides all faces, or a patch if there is a sample.
pub(crate) fn run(
    backend: &Backend,
    job: SubdivisionJob,
    polygons: &PolygonMesh,
    sample: Option<ElementSample>,
    series: &Series<'_>,
) -> TimedRun {
    let Some(ElementSample { size, .. }) = sample else {
        return subdivide(backend, job, polygons, series);
    };
    let patch = patch(polygons, size);
    let scale = polygons.face_count() as f64 / patch.face_count() as f64;
    let run = subdivide(backend, job, &patch, series);
    TimedRun {
        time: run.time.scaled(scale),
        ..run
    }
}

/// Returns the pool of the one thread that runs all subdivisions. The processor time of this thread
/// is the time of all the work. All structures share the heap of this thread.
fn one_thread_pool() -> Result<&'static ThreadPool, String> {
    static POOL: OnceLock<Result<ThreadPool, String>> = OnceLock::new();
    let start = || {
        let pool = ThreadPoolBuilder::new().num_threads(1).build();
        pool.map_err(|error| format!("cannot start a thread: {error}"))
    };
    POOL.get_or_init(start).as_ref().map_err(Clone::clone)
}

/// Sets up `job` on the structure of `backend` and runs it as `series` describes.
///
/// Set-up is not timed. In native subdivisions, the untimed runs make the tables that later runs
/// reuse. The other methods build their structures within the timing.
fn subdivide(
    backend: &Backend,
    job: SubdivisionJob,
    polygons: &PolygonMesh,
    series: &Series<'_>,
) -> TimedRun {
    // Clock, caches and page faults then belong to the thread of the pool.
    let on_thread =
        |pool: &ThreadPool| pool.install(|| set_up_and_run(backend, job, polygons, series));
    one_thread_pool()
        .and_then(on_thread)
        .unwrap_or_else(|refusal| TimedRun::refused(refusal, series))
}

fn set_up_and_run(
    backend: &Backend,
    job: SubdivisionJob,
    polygons: &PolygonMesh,
    series: &Series<'_>,
) -> Result<TimedRun, String> {
    check_degrees(job, polygons).map_err(|error| error.to_string())?;
    let refiner = job.prepare(backend, polygons, &Creases::default());
    let refiner = refiner.ok_or("it has no native method: it cannot split its own tables")?;
    let mut refiner = refiner.map_err(|error| error.to_string())?;
    let mut done = Ok(());
    let time = series.time_together(|| {
        if done.is_ok() {
            done = black_box(&mut refiner).run();
        }
    });
    done.map_err(|error| error.to_string())?;
    let outcome = series.check.then(|| {
        let (faces, checksum) = refiner.result();
        Outcome {
            checksum,
            elements: faces as u64,
            refused: 0,
        }
    });
    Ok(TimedRun::done(time, outcome))
}

/// Checks that the scheme accepts the degrees of the faces. The error is then the same for all
/// structures. O(faces) at most.
fn check_degrees(job: SubdivisionJob, polygons: &PolygonMesh) -> Result<(), SubdivisionError> {
    let scheme = job.subdivision.scheme;
    if scheme.properties().takes != FaceKind::Triangles {
        return Ok(());
    }
    match polygons.first_polygon() {
        Some((face, degree)) => Err(SubdivisionError::NotATriangle {
            scheme,
            face,
            degree,
        }),
        None => Ok(()),
    }
}

/// Returns a mesh of about the first `size` faces of `polygons`. Faces that touch other faces only
/// at a vertex are left out, so that every structure that holds `polygons` also holds the patch.
/// O(size · log size) for each of a few passes.
pub fn patch(polygons: &PolygonMesh, size: usize) -> PolygonMesh {
    let faces = polygons.faces().iter().take(size.max(1));
    let mut faces: Vec<&[VertexId]> = faces.map(|(_, corners)| corners).collect();
    loop {
        let mesh = submesh(polygons, &faces);
        let mut taken: BTreeSet<VertexId> = BTreeSet::new();
        let singular: BTreeSet<VertexId> = mesh.vertices_of_several_fans().into_iter().collect();
        if singular.is_empty() {
            return mesh;
        }
        // Keep the first face at each such vertex. Each pass removes faces, so the loop ends.
        let corners = mesh.faces().iter().map(|(_, corners)| corners);
        let is_kept: Vec<bool> = corners
            .map(|corners| {
                let at = corners.iter().filter(|v| singular.contains(v));
                let at: Vec<VertexId> = at.copied().collect();
                let free = at.iter().all(|v| !taken.contains(v));
                taken.extend(at);
                free
            })
            .collect();
        let mut is_kept = is_kept.into_iter();
        faces.retain(|_| is_kept.next().unwrap_or(false));
    }
}

/// Builds the mesh of some faces of `polygons`.
fn submesh(polygons: &PolygonMesh, faces: &[&[VertexId]]) -> PolygonMesh {
    let mut used: Vec<VertexId> = faces.iter().copied().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let number = |v: &VertexId| used.partition_point(|u| u < v) as u32;
    let renumbered = faces.iter().map(|face| face.iter().map(number).collect());
    let renumbered: Vec<Vec<u32>> = renumbered.collect();
    let positions: Vec<Point> = used.iter().map(|&v| polygons.position(v)).collect();
    PolygonMesh::new(positions, renumbered).expect("faces of a mesh, with their own vertices")
}

#[cfg(test)]
mod tests {
    use sixfold::{HalfEdgeMesh, Representation, shapes};

    use super::*;

    #[test]
    fn a_structure_that_holds_the_mesh_holds_a_patch() {
        let ordered = shapes::geodesic(12).expect("small");
        for mesh in [shapes::shuffled(&ordered, 3), ordered] {
            for size in [1, 7, 100, 900] {
                let patch = patch(&mesh, size);
                assert!((size.div_ceil(20)..=size).contains(&patch.face_count()));
                assert!(HalfEdgeMesh::from_polygons(&patch).is_ok(), "{size}");
            }
            assert_eq!(
                patch(&mesh, usize::MAX),
                mesh,
                "the whole mesh, in its order"
            );
        }
    }
}
