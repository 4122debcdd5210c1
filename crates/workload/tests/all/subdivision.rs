//! Every way to subdivide does the same work on every structure.

use sixfold::subdivision::Scheme;
use sixfold::{Creases, shapes};
use sixfold_workload::{Backend, SubdivisionJob, Way};

#[test]
fn every_way_does_the_same_work() {
    let polygons = shapes::geodesic(3).expect("small");
    let none = Creases::default();
    for (scheme, levels) in [(Scheme::Loop, 2), (Scheme::CatmullClark, 1)] {
        let mut results = Vec::new();
        for way in Way::ALL {
            for backend in Backend::structures() {
                let job = SubdivisionJob::new(scheme, way, levels);
                let Some(Ok(mut refiner)) = job.prepare(&backend, &polygons, &none) else {
                    continue;
                };
                match refiner.run() {
                    Ok(()) => results.push(refiner.result()),
                    Err(_) => assert_eq!(backend.name(), "corner-table"),
                }
                if refiner.run().is_ok() {
                    assert_eq!(results.last(), Some(&refiner.result()), "a second run");
                }
            }
        }
        let (faces, sum) = results[0];
        assert_eq!(
            faces,
            polygons.face_count() * if levels == 2 { 16 } else { 3 }
        );
        for &(others, other) in &results {
            assert_eq!(others, faces);
            assert!((other - sum).abs() < 1e-5 * sum, "{other} and {sum}");
        }
        assert!(results.len() > 15, "most ways on most structures");
    }
}
