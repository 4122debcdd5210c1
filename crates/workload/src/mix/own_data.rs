//! The program's own data in a mix, which share the caches with the structure.

use std::cell::Cell;
use std::hint::black_box;
use std::ops::Range;

use sixfold::PolygonMesh;

use crate::mix::route::Route;
use sixfold_measure::ElementKind;
use sixfold_results::OwnData;

/// Bytes in a word. The data are read and written word by word.
const WORD: usize = 8;

/// The memory that holds the program's own data of all elements. It is the same for all backends.
pub(crate) struct OwnMemory([Option<Records>; 3]);

/// One record for each element of one kind, in the order of the mesh file.
struct Records {
    /// The elements in the order of the visits; empty if this is the order of the records.
    order: Vec<u32>,
    words: Vec<Cell<u64>>,
    /// The number of words of a record, and how many of them a visit reads and writes.
    stride: usize,
    read: usize,
    written: usize,
}

impl OwnMemory {
    /// Makes the memory for the visits along `route`. `edges` is the number of edges of `polygons`.
    pub(crate) fn new(data: &OwnData, route: &Route, polygons: &PolygonMesh, edges: usize) -> Self {
        if *data == OwnData::default() {
            return Self([const { None }; 3]);
        }
        let mut numbers = route.record_numbers();
        let counts = [polygons.vertex_count(), edges, polygons.face_count()];
        Self(ElementKind::ALL.map(|kind| {
            let bytes = kind.own_bytes(data);
            let [read, written] = [bytes.read, bytes.written].map(|b| (b as usize).div_ceil(WORD));
            let stride = read.max(written);
            (stride > 0).then(|| Records {
                order: std::mem::take(&mut numbers[kind.index()]),
                words: vec![Cell::new(0); stride * counts[kind.index()]],
                stride,
                read,
                written,
            })
        }))
    }

    /// **Timed**: reads and writes the records of the visits `range` to elements of one kind.
    #[inline]
    pub(crate) fn visit(&self, kind: Option<ElementKind>, range: Range<u64>) {
        if let Some(records) = kind.and_then(|kind| self.0[kind.index()].as_ref()) {
            records.visit(range);
        }
    }
}

impl Records {
    #[inline(never)]
    fn visit(&self, range: Range<u64>) {
        let count = self.words.len() / self.stride;
        let visits = match self.order.len() {
            0 => count,
            visits => visits,
        } as u64;
        if count == 0 {
            return;
        }
        let mut sum = range.start;
        for visit in range {
            let nth = (visit % visits) as usize;
            let element = self.order.get(nth).map_or(nth, |&element| element as usize);
            let record = &self.words[element * self.stride..][..self.stride];
            for word in &record[..self.read] {
                sum = sum.wrapping_add(word.get());
            }
            for word in &record[..self.written] {
                word.set(sum);
            }
        }
        black_box(sum);
    }
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;

    use super::*;
    use crate::workload::Access;
    use sixfold_results::OwnBytes;

    fn memory(access: Access, data: &OwnData) -> OwnMemory {
        let torus = shapes::triangle_torus(4, 3).expect("small");
        OwnMemory::new(data, &Route::new(access, &torus, 5), &torus, 36)
    }

    fn written(records: &Records) -> Vec<usize> {
        let records = records.words.chunks(records.stride).enumerate();
        let written = records.filter(|(_, record)| record.iter().any(|word| word.get() != 0));
        written.map(|(element, _)| element).collect()
    }

    #[test]
    fn a_visit_touches_the_record_of_its_element() {
        let bytes = OwnBytes {
            read: 8,
            written: 20,
        };
        let data = OwnData {
            face: bytes,
            ..OwnData::default()
        };
        for access in Access::ALL {
            let memory = memory(access, &data);
            memory.visit(Some(ElementKind::Vertex), 0..9);
            memory.visit(None, 0..9);
            let [None, None, Some(records)] = &memory.0 else {
                panic!("only faces have data");
            };
            assert_eq!((records.stride, records.read, records.written), (3, 1, 3));
            assert_eq!(records.words.len(), 3 * 24);
            assert!(written(records).is_empty(), "{access}");
            memory.visit(Some(ElementKind::Face), 5..8);
            let mut expected: Vec<usize> = match access {
                Access::Sequential => vec![5, 6, 7],
                _ => records.order[5..8].iter().map(|&f| f as usize).collect(),
            };
            expected.sort_unstable();
            expected.dedup();
            assert_eq!(written(records), expected, "{access}");
            // The visits start again after the last one.
            let visits = records.order.len().max(24) as u64;
            memory.visit(Some(ElementKind::Face), visits..2 * visits);
            assert_eq!(written(records).len(), 24, "{access}");
        }
    }

    #[test]
    fn edges_have_a_record_for_each_pair_of_ends() {
        let data = OwnData {
            edge: OwnBytes {
                read: 0,
                written: 8,
            },
            ..OwnData::default()
        };
        for access in [Access::ByFace, Access::Random, Access::Sequential] {
            let memory = memory(access, &data);
            memory.visit(Some(ElementKind::Edge), 1..73);
            let records = memory.0[1].as_ref().expect("edges have data");
            assert_eq!(written(records).len(), 36, "{access}");
        }
    }
}
