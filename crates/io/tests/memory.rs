//! The memory that reading takes, as a multiple of the mesh. This is a separate program with a single
//! test, because its allocator counts every byte.

use std::alloc::System;
use std::fs;

use peakmem_alloc::{INSTRUMENTED_SYSTEM, PeakMemAlloc, PeakMemAllocTrait};
use sixfold_io::{Format, ReadOptions, WriteOptions, read_with, write_to};
use sixfold_shapes as shapes;

#[global_allocator]
static HEAP: &PeakMemAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Buffers of a fixed size.
const FIXED: usize = 1_500_000;

#[test]
fn memory_is_below_a_multiple_of_the_mesh() {
    let mesh = shapes::geodesic(150).expect("small");
    // A position has 12 bytes, a corner 4.
    let size = 12 * mesh.vertex_count() + 4 * mesh.corner_count();
    let folder = tempfile::tempdir().expect("the temporary folder is writable");
    let mut table = Vec::new();
    for format in Format::ALL {
        let path = folder
            .path()
            .join(format!("{}.{}", format.name(), format.extension()));
        let mut bytes = Vec::new();
        write_to(&mesh, format, &WriteOptions::default(), &mut bytes)
            .expect("memory does not fail");
        fs::write(&path, &bytes).expect("writable");
        drop(bytes);
        let peak = |options: ReadOptions| {
            HEAP.reset_peak_memory();
            let read = read_with(&path, &options).unwrap_or_else(|error| panic!("{error}"));
            let peak = HEAP.get_peak_memory();
            assert_eq!(read.positions.len(), mesh.vertex_count(), "{format}");
            peak.saturating_sub(FIXED) as f64 / size as f64
        };
        let default = ReadOptions::default();
        let found = [default, default.recentred()].map(peak);
        println!("{format}: {:.2} and {:.2} × the mesh", found[0], found[1]);
        table.push((format, found));
    }
    for (format, found) in table {
        let limits = limits(format);
        for (found, limit) in found.into_iter().zip(limits) {
            assert!(
                found < limit,
                "{format}: {found:.2} × the mesh, limit {limit}"
            );
        }
    }
}

/// Returns the largest multiples for a mesh that stays in its place, and for one that is moved, whose
/// positions are kept in 64 bits.
///
/// The tables of OBJ and ASCII STL grow while the file is read, because the file does not begin with
/// the numbers of its elements; while a table moves to a larger place, it counts twice. The buffers of
/// glTF are in memory together with the mesh.
fn limits(format: Format) -> [f64; 2] {
    match format {
        Format::Stl | Format::Ply | Format::PlyBigEndian => [1.2, 1.6],
        Format::PlyAscii | Format::Off => [1.7, 2.3],
        Format::Obj | Format::StlAscii => [2.7, 2.8],
        Format::Gltf | Format::Glb => [2.9, 3.2],
        _ => panic!("{format} needs a limit"),
    }
}
