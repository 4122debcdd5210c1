//! Checks which elements an operation on a sample visits.

use sixfold::shapes;
use sixfold_measure::{ElementSample, Job, MachineClock, Operation, Outcome, Series, Task};
use sixfold_workload::{Backend, Draw};

/// Runs `operation` on every structure. Of the kinds in `scanned`, only `size` elements are visited.
fn outcomes(operation: Operation, scanned: [bool; 3], size: usize) -> Vec<Outcome> {
    let polygons = shapes::geodesic(4).expect("a small frequency");
    let draw = Draw::new(&polygons, 3);
    let job = Job {
        sample: Some(ElementSample { scanned, size }),
        ..Job::new(Task::Operation(operation))
    };
    let clock = MachineClock::start();
    let series = Series::once(&clock).with_result();
    let run = |backend: Backend| {
        let (mut timed, _) = backend.prepare(&polygons, Some(&draw)).expect("closed");
        timed.run(&job, &series).outcome.expect("requested")
    };
    Backend::structures().into_iter().map(run).collect()
}

#[test]
fn only_the_scanned_kinds_are_sampled_and_the_counts_are_those_of_the_whole_mesh() {
    // Each with the kind whose values are the result.
    let operations = [
        (Operation::FaceBarycenter, 2),
        (Operation::VertexNormal, 0),
        (Operation::VvSmooth, 0),
    ];
    for (operation, kind) in operations {
        let whole = outcomes(operation, [false; 3], 1);
        let mut others = [true; 3];
        others[kind] = false;
        // A vertex normal is a sum of face normals: with a sample of the faces, it is another.
        if operation != Operation::VertexNormal {
            assert_eq!(outcomes(operation, others, 5), whole, "{operation}");
        }
        let sampled = outcomes(operation, [0, 1, 2].map(|k| k == kind), 5);
        for (part, all) in sampled.iter().zip(&whole) {
            assert_eq!(part.elements, all.elements, "{operation}");
            let share = part.checksum / all.checksum;
            assert!((0.001..0.2).contains(&share), "{operation}: {share}");
        }
    }
}

#[test]
fn a_sampled_relation_is_queried_at_as_many_elements_as_asked() {
    let faces = |size| {
        outcomes(
            Operation::Relation(sixfold::Relation::FaceVertices),
            [false, false, true],
            size,
        )
    };
    for outcome in faces(5) {
        assert_eq!((outcome.checksum, outcome.elements), (15.0, 320));
    }
    for outcome in faces(10_000) {
        assert_eq!((outcome.checksum, outcome.elements), (960.0, 320));
    }
}
