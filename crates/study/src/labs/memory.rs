//! The memory audit: counts the bytes of each structure in three ways.
//!
//! The three counts are made independently and must be equal. The layout formula uses only the
//! numbers of elements of the mesh. The sum over the tables uses the capacity of each table. The
//! allocator counts the bytes that it hands out. If the counts differ, Sixfold has a fault: a wrong
//! formula, spare capacity, or memory that no table reports.

mod sentences;

use sixfold::{BuildError, PolygonMesh};
use sixfold_core::Counts;
use sixfold_measure::{Operation, StudyMesh};
use sixfold_workload::{
    AllocationCounter, Backend, Heap, MAX_SCANNED_FACES, MeasuredMemory, NotCounted,
};

use crate::engine::run::start_run;
use crate::inspect::{per_vertex, unbuilt};
use crate::labs::study::StudyError;
use crate::refusal::BuildInput;
use sixfold_results::{Audit, BackendAudit, BackendReport, OperationBytes, RunSettings};

/// Bytes of a word: an index or a coordinate.
const WORD: f64 = 4.0;

/// Maximum number of counts per backend. Counting ends earlier if two counts in a row are equal.
const MAX_COUNTS: usize = 8;

/// Builds each of `backends` from the mesh, one backend at a time, and counts the bytes with
/// `heap`.
///
/// Each backend is counted until two counts in a row are equal, but at most eight times, because
/// other threads may allocate at the same time. The closure `counting` is called before each
/// backend is counted.
pub fn audit(
    study_mesh: &StudyMesh,
    backends: &[Backend],
    heap: &dyn Heap,
    counting: &mut dyn FnMut(&Backend),
) -> Audit {
    let input = BuildInput::from_study_mesh(study_mesh);
    let names = backends.iter().map(|b| b.name().to_owned()).collect();
    let backends = backends.iter().map(|backend| {
        counting(backend);
        let measured = count_bytes(backend, input.polygons, heap);
        backend_audit(backend, &input, measured)
    });
    let mut audit = Audit {
        run: start_run(RunSettings {
            backends: names,
            ..RunSettings::default()
        }),
        mesh: study_mesh.report(),
        backends: backends.collect(),
        sentences: Vec::new(),
        warnings: Vec::new(),
        interrupted: false,
    };
    audit.sentences = sentences::sentences(&audit);
    audit
}

/// The reason why an operation is not run on a mesh of which some elements have very many neighbours.
pub const CROWDED: &str = "it visits all neighbours of elements, and some elements have very many";

/// Counts the bytes that operations allocate, and adds the counts to `audit`. Every operation that
/// allocates is run on every backend that holds the mesh. An operation that scans all faces for
/// each element is not run on a large mesh, and no operation but the build on a mesh of which some elements
/// have very many neighbours. `audit` must be the result of [`audit()`] for
/// `backends` and `study_mesh`.
///
/// A run is repeated until two runs allocate the same smallest number of bytes, but at most eight
/// times, because other threads may allocate at the same time.
pub fn count_allocations(
    audit: &mut Audit,
    study_mesh: &StudyMesh,
    backends: &[Backend],
    counter: &dyn AllocationCounter,
    counting: &mut dyn FnMut(&Backend, Operation),
) {
    let (polygons, edges) = (&study_mesh.polygons, study_mesh.facts.edges);
    for (audited, backend) in audit.backends.iter_mut().zip(backends) {
        if !audited.backend.holds {
            continue;
        }
        let operations = Operation::ALL.into_iter().filter(|job| job.allocates());
        let operations = operations.map(|operation| {
            counting(backend, operation);
            let count = || backend.allocated(operation, polygons, edges, counter);
            let mut least = count();
            for _ in 1..MAX_COUNTS {
                let again = match &least {
                    Ok(_) => count(),
                    Err(_) => break,
                };
                match (&least, &again) {
                    (Ok(before), Ok(now)) if now.bytes < before.bytes => least = again,
                    (Ok(before), Ok(now)) if now.bytes > before.bytes => {}
                    _ => break,
                }
            }
            operation_bytes(operation, least)
        });
        audited.operations = operations.collect();
    }
}

fn operation_bytes(
    operation: Operation,
    counted: Result<sixfold_workload::Allocated, NotCounted>,
) -> OperationBytes {
    let scans = counted == Err(NotCounted::Scans);
    let counted = counted.map_err(|not_counted| match not_counted {
        NotCounted::Refused(reason) => reason,
        NotCounted::Scans => format!(
            "it scans all faces for each element, and the mesh has more than \
             {MAX_SCANNED_FACES} faces or {} corners",
            4 * MAX_SCANNED_FACES
        ),
        NotCounted::Crowded => CROWDED.to_owned(),
    });
    let figures = counted.as_ref().ok();
    OperationBytes {
        operation: operation.name().into(),
        allocated_bytes: figures.map(|figures| figures.bytes),
        result_bytes: figures.map(|figures| figures.result_bytes),
        allocated_to_result: figures
            .filter(|figures| figures.result_bytes > 0)
            .map(|figures| figures.bytes as f64 / figures.result_bytes as f64),
        reason: counted.err(),
        scans,
    }
}

fn count_bytes(
    backend: &Backend,
    polygons: &PolygonMesh,
    heap: &dyn Heap,
) -> Result<MeasuredMemory, BuildError> {
    let mut last = backend.measure_memory(polygons, heap)?;
    for _ in 1..MAX_COUNTS {
        let again = backend.measure_memory(polygons, heap)?;
        if again == last {
            break;
        }
        last = again;
    }
    Ok(last)
}

/// Returns the error for a mesh that no backend can hold; `None` if some backend can hold the mesh.
pub fn none_holds(audit: &Audit) -> Option<StudyError> {
    let refusal = |BackendAudit { backend, .. }: &BackendAudit| backend.refusal();
    let refusals: Option<Vec<_>> = audit.backends.iter().map(refusal).collect();
    refusals.map(StudyError::none_holds)
}

fn backend_audit(
    backend: &Backend,
    input: &BuildInput<'_>,
    measured: Result<MeasuredMemory, BuildError>,
) -> BackendAudit {
    let counts = &input.counts;
    let closed_triangles = closed_triangles_words(backend);
    let (report, measured) = match measured {
        Err(refusal) => (unbuilt(backend, input, Err(refusal)), None),
        Ok(measured) => {
            let bytes = measured.memory.total();
            let report = BackendReport {
                bytes: Some(bytes),
                bytes_per_vertex: per_vertex(bytes, counts),
                tables: measured.memory.tables,
                merged_vertices: Some(measured.merged_vertices),
                ..unbuilt(backend, input, Ok(()))
            };
            (report, Some((measured.counted, measured.peak)))
        }
    };
    let [layout, tables] = [report.layout_bytes, report.bytes];
    let (counted, peak) = measured.unzip();
    BackendAudit {
        layout_words_per_vertex: report.layout_bytes_per_vertex.map(|bytes| bytes / WORD),
        closed_triangles_words_per_vertex: closed_triangles,
        counted_bytes: counted,
        counted_bytes_per_vertex: counted.and_then(|bytes| per_vertex(bytes, counts)),
        peak_bytes: peak,
        peak_to_counted: peak
            .zip(counted.filter(|&bytes| bytes > 0))
            .map(|(peak, counted)| peak as f64 / counted as f64),
        agrees: counted.map(|_| layout == tables && tables == counted),
        operations: Vec::new(),
        backend: report,
    }
}

/// Returns the layout words per vertex of a very large closed triangle mesh.
fn closed_triangles_words(backend: &Backend) -> f64 {
    const VERTICES: usize = 1 << 20;
    let counts = Counts {
        vertices: VERTICES,
        edges: 3 * VERTICES,
        faces: 2 * VERTICES,
        corners: 6 * VERTICES,
        uniform: true,
    };
    (backend.layout_bytes)(&counts) as f64 / WORD / VERTICES as f64
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use sixfold::{HalfEdgeMesh, IndexedFaceSet, shapes};
    use sixfold_core::Measured;

    use sixfold_results::Counted;

    use super::*;

    struct Scripted {
        counts: Vec<[usize; 2]>,
        calls: Cell<usize>,
    }

    impl Scripted {
        fn new(counts: impl IntoIterator<Item = [usize; 2]>) -> Self {
            Self {
                counts: counts.into_iter().collect(),
                calls: Cell::new(0),
            }
        }

        fn now(&self) -> [usize; 2] {
            let last = self.counts.len() - 1;
            self.counts[(self.calls.get() / 2).min(last)]
        }
    }

    impl Heap for Scripted {
        /// One count reads `live` twice: before and after building.
        fn live(&self) -> usize {
            let [live, _] = self.now();
            let calls = self.calls.replace(self.calls.get() + 1);
            1000 + (calls % 2) * live
        }

        fn restart_peak(&self) {}

        fn peak(&self) -> usize {
            self.counts[((self.calls.get() - 1) / 2).min(self.counts.len() - 1)][1]
        }
    }

    fn audited(backend: Backend, heap: &Scripted) -> Audit {
        let torus = shapes::triangle_torus(4, 3).expect("a small torus");
        audit(
            &StudyMesh::new("torus", torus),
            &[backend],
            heap,
            &mut |_| (),
        )
    }

    /// Bytes of the half-edge structure: 36 · 24 + 12 · 16 + 24 · 4.
    const BYTES: usize = 1152;

    #[test]
    fn equal_numbers_give_no_fault() {
        let audit = audited(
            Backend::new::<HalfEdgeMesh>(),
            &Scripted::new([[BYTES, 2 * BYTES]]),
        );
        let mut with_operation = audit.clone();
        with_operation.backends[0].operations = vec![OperationBytes {
            operation: Operation::Build.name().into(),
            allocated_bytes: Some(3 * BYTES),
            result_bytes: Some(BYTES),
            allocated_to_result: Some(3.0),
            reason: None,
            scans: false,
        }];
        let figures = with_operation.figures();
        let (structure, operations) = figures.split_first().expect("the structure comes first");
        let size = Counted {
            layout_bytes: Some(BYTES),
            counted_bytes: Some(BYTES),
            peak_bytes: Some(2 * BYTES),
            ..Counted::default()
        };
        assert_eq!(
            (structure.counted, structure.backend_bytes),
            (size, Some(BYTES))
        );
        let allocated = operations
            .iter()
            .map(|figure| figure.counted.allocated_bytes);
        assert!(allocated.eq([Some(3 * BYTES)]));
        assert_eq!(audit.faults(), Vec::<String>::new());
        let one = &audit.backends[0];
        assert_eq!(one.agrees, Some(true));
        assert_eq!(one.peak_to_counted, Some(2.0));
        assert_eq!(one.layout_words_per_vertex, Some(24.0));
        assert_eq!(one.counted_bytes_per_vertex, Some(96.0));
        assert_eq!(none_holds(&audit), None);
    }

    #[test]
    fn a_difference_is_reported_with_its_bytes() {
        let right = Backend::new::<HalfEdgeMesh>();
        let spare = audited(right, &Scripted::new([[BYTES + 40, BYTES]]));
        let expected = "half-edge: the allocator counted 1192 bytes, 40 bytes more than its tables hold (1152 bytes)";
        assert_eq!(spare.faults(), [expected]);
        assert_eq!(spare.backends[0].agrees, Some(false));

        let mut wrong = right;
        wrong.layout_bytes = |counts| HalfEdgeMesh::layout_bytes(counts) + 8;
        let formula = audited(wrong, &Scripted::new([[BYTES, BYTES]]));
        let expected = "half-edge: its tables hold 1152 bytes, 8 bytes fewer than its layout formula gives (1160 bytes)";
        assert_eq!(formula.faults(), [expected]);

        assert_eq!(formula.sentences[0], format!("{expected}."));
        assert!(!formula.sentences.iter().any(|text| text.contains("agree")));

        let both = audited(wrong, &Scripted::new([[0, 0]]));
        assert_eq!(both.faults().len(), 2);
        assert_eq!(both.backends[0].peak_to_counted, None);
    }

    #[test]
    fn the_least_memory_and_the_peaks_are_compared() {
        let torus = shapes::triangle_torus(4, 3).expect("a small torus");
        let backends = [
            Backend::new::<HalfEdgeMesh>(),
            Backend::new::<IndexedFaceSet>(),
        ];
        let (all, few) = ([BYTES, 2 * BYTES], [432, 432]);
        let audit = audit(
            &StudyMesh::new("torus", torus),
            &backends,
            &Scripted::new([all, all, few]),
            &mut |_| (),
        );
        let expected = [
            "indexed-face-set needs the least memory: 432 bytes, 36.0 per vertex. Relative to this: \
             half-edge 2.67.",
            "While a structure is built, it needs up to 2.00 times its bytes (half-edge); \
             indexed-face-set the least, 1.00 times.",
            "All three counts (formula, tables, allocator) agree to the byte: no table has spare \
             capacity, and no memory is outside the tables.",
        ];
        assert_eq!(audit.sentences, expected);
    }

    #[test]
    fn allocations_of_another_thread_give_no_fault() {
        let right = [BYTES, 2 * BYTES];
        let disturbed = [[BYTES + 7, 2 * BYTES], [BYTES, 3 * BYTES], right, right];
        let audit = audited(Backend::new::<HalfEdgeMesh>(), &Scripted::new(disturbed));
        assert_eq!(audit.faults(), Vec::<String>::new());
        assert_eq!(audit.backends[0].peak_bytes, Some(2 * BYTES));
        // No two counts agree here, so the audit ends with the last count.
        let changing = (0..100).map(|i| [BYTES + i, BYTES]);
        let audit = audited(Backend::new::<HalfEdgeMesh>(), &Scripted::new(changing));
        assert_eq!(audit.faults().len(), 1);
    }

    #[test]
    fn a_refusal_has_a_reason_and_no_bytes() {
        let quads = StudyMesh::new("cube", shapes::cube());
        let [face_set, table] = [
            Backend::new::<IndexedFaceSet>(),
            Backend::new::<sixfold::CornerTable>(),
        ];
        let bytes = 8 * 12 + 24 * 4;
        let heap = Scripted::new([[bytes, bytes]]);
        let mut counted = Vec::new();
        let audit = audit(&quads, &[face_set, table], &heap, &mut |backend| {
            counted.push(backend.name());
        });
        assert_eq!(counted, ["indexed-face-set", "corner-table"]);
        assert_eq!((none_holds(&audit), audit.faults().len()), (None, 0));
        let least = "indexed-face-set needs 192 bytes, 24.0 per vertex.";
        assert_eq!(audit.sentences[0], least);
        let refused = &audit.backends[1];
        assert!(refused.backend.reason.is_some() && !refused.backend.holds);
        assert_eq!((refused.agrees, refused.counted_bytes), (None, None));
        assert_eq!(refused.closed_triangles_words_per_vertex, 16.0);

        let none = none_holds(&self::audit(&quads, &[table], &heap, &mut |_| ()));
        let none = none.expect("the only one refuses").to_string();
        assert!(none.contains("corner-table: "), "{none}");
    }
}
