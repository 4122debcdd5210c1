//! One subdivision run for a study: set up, run by one thread, and looked at.

use std::collections::BTreeSet;
use std::hint::black_box;

use rayon::{ThreadPool, ThreadPoolBuilder};
use sixfold::subdivision::{Method, SubdivisionError};
use sixfold::{Creases, Point, PolygonMesh, Representation, VertexId};

use crate::candidate::{Outcome, Run};
use crate::clock::{Clock, timed};
use crate::refining::Refining;

/// One thread, so that processor time is that of all the work and every structure has as much.
#[derive(Default)]
pub(crate) struct OneThread(Option<ThreadPool>);

impl OneThread {
    /// The thread, started when it is first asked for.
    fn pool(&mut self) -> Result<&ThreadPool, String> {
        if self.0.is_none() {
            let pool = ThreadPoolBuilder::new().num_threads(1).build();
            let pool = pool.map_err(|error| format!("no thread could be started: {error}"))?;
            self.0 = Some(pool);
        }
        self.0.as_ref().ok_or_else(|| "no thread".into())
    }

    /// Sets `job` up on a structure of type `M` built from `polygons`, and runs it `runs` times.
    ///
    /// Setting up is outside the timing, and so is a first run of a native one, which makes the
    /// tables that all later runs use again. What the others build anew they build inside.
    pub(crate) fn run<M: Representation + 'static>(
        &mut self,
        job: Refining,
        polygons: &PolygonMesh,
        runs: u32,
        clock: &dyn Clock,
        check: bool,
    ) -> Run {
        let done = self.pool().and_then(|pool| {
            pool.install(|| set_up_and_run::<M>(job, polygons, runs, clock, check))
        });
        done.unwrap_or_else(|refusal| Run {
            time: clock.now().scaled(0.0),
            outcome: None,
            refusal: Some(refusal),
        })
    }
}

fn set_up_and_run<M: Representation + 'static>(
    job: Refining,
    polygons: &PolygonMesh,
    runs: u32,
    clock: &dyn Clock,
    check: bool,
) -> Result<Run, String> {
    check_degrees(job, polygons).map_err(|error| error.to_string())?;
    let refiner = job.of::<M>(polygons, &Creases::default());
    let refiner = refiner.ok_or("it has no native method: it cannot split its own tables")?;
    let mut refiner = refiner.map_err(|error| error.to_string())?;
    let mut done = Ok(());
    if job.way.method() == Method::Native {
        done = refiner.run();
    }
    let time = timed(clock, || {
        for _ in 0..runs {
            if done.is_err() {
                break;
            }
            done = black_box(&mut refiner).run();
        }
    });
    done.map_err(|error| error.to_string())?;
    let outcome = check.then(|| {
        let (faces, checksum) = refiner.result();
        Outcome {
            checksum,
            elements: faces as u64,
        }
    });
    Ok(Run {
        time,
        outcome,
        refusal: None,
    })
}

/// That the scheme takes the faces: asked here, so that the answer is the same for all structures and
/// names a face of the whole mesh; O(faces) at most.
fn check_degrees(job: Refining, polygons: &PolygonMesh) -> Result<(), SubdivisionError> {
    let scheme = job.subdivision.scheme;
    if scheme.kind().takes != "triangles" {
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

/// About the first `size` faces of `polygons`, as a mesh that is held by whatever holds `polygons`:
/// without those that touch others in a mere point. O(size · log size), a few times.
pub(crate) fn patch(polygons: &PolygonMesh, size: usize) -> PolygonMesh {
    let faces = polygons.faces().iter().take(size.max(1));
    let mut faces: Vec<&[VertexId]> = faces.map(|(_, corners)| corners).collect();
    loop {
        let mesh = of_faces(polygons, &faces);
        let mut taken: BTreeSet<VertexId> = BTreeSet::new();
        let touching: BTreeSet<VertexId> = mesh.vertices_of_several_fans().into_iter().collect();
        if touching.is_empty() {
            return mesh;
        }
        // Of the faces at such a vertex the first stays. Fewer each time, and one face touches none.
        let corners = mesh.faces().iter().map(|(_, corners)| corners);
        let keep: Vec<bool> = corners
            .map(|corners| {
                let at = corners.iter().filter(|v| touching.contains(v));
                let at: Vec<VertexId> = at.copied().collect();
                let free = at.iter().all(|v| !taken.contains(v));
                taken.extend(at);
                free
            })
            .collect();
        let mut keep = keep.into_iter();
        faces.retain(|_| keep.next().unwrap_or(false));
    }
}

/// The mesh of some faces of `polygons`, and of their vertices alone.
fn of_faces(polygons: &PolygonMesh, faces: &[&[VertexId]]) -> PolygonMesh {
    let mut used: Vec<VertexId> = faces.iter().copied().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let number = |v: &VertexId| used.partition_point(|u| u < v) as u32;
    let renamed = faces.iter().map(|face| face.iter().map(number).collect());
    let renamed: Vec<Vec<u32>> = renamed.collect();
    let positions: Vec<Point> = used.iter().map(|&v| polygons.position(v)).collect();
    PolygonMesh::new(positions, renamed).expect("faces of a mesh, with their own vertices")
}

#[cfg(test)]
mod tests {
    use sixfold::{HalfEdgeMesh, shapes};

    use super::*;

    #[test]
    fn a_patch_is_held_by_whatever_holds_the_mesh() {
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
                "all of it, and in its order"
            );
        }
    }
}
