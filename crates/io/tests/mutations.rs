//! Reads thousands of damaged files: cut off, with changed bits, and with counts that lie.
//!
//! Each gives a mesh or an error. Neither may need more memory than a few times the file. This is a
//! separate program with a single test, because its allocator counts every byte.

use std::alloc::System;
use std::fs;
use std::path::{Path, PathBuf};

use peakmem_alloc::{INSTRUMENTED_SYSTEM, PeakMemAlloc, PeakMemAllocTrait};
use sixfold_io::{Format, ReadOptions, Welding, WriteOptions, read_from, write_to};
use sixfold_shapes as shapes;

#[global_allocator]
static HEAP: &PeakMemAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Damaged copies of each small file; larger files get fewer.
const VARIANTS: usize = 1500;
const BYTES_PER_FILE: usize = 3_000_000;

/// Memory that reading a small file may take: buffers of a fixed size, and the smallest tables.
const FIXED: usize = 2_000_000;

/// Memory that reading may take per byte of the file. A byte of text can become a face of one
/// corner, which is kept with its place.
const PER_BYTE: usize = 80;

/// A generator of random numbers (SplitMix64; Guy Steele, Doug Lea, Christine Flood, 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// Returns a number below `limit`, which must not be 0.
    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }
}

/// Numbers that a header may contain to mislead a reader.
const LIES: [&str; 12] = [
    "0",
    "-1",
    "1",
    "255",
    "65536",
    "2147483647",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "1e300",
    "nan",
    "",
];

/// Returns the places of the numbers in the text at the start of a file.
fn numbers(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len().min(2000) {
        let is_digit = |byte: &&u8| byte.is_ascii_digit();
        let length = bytes[at..].iter().take_while(is_digit).count();
        if length > 0 {
            found.push(at..at + length);
        }
        at += length.max(1);
    }
    found
}

/// Returns a damaged copy of a file.
fn damaged(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut copy = bytes.to_vec();
    for _ in 0..1 + random.below(3) {
        if copy.is_empty() {
            break;
        }
        let at = random.below(copy.len());
        // Headers are small, but decide most.
        let at = if random.below(2) == 0 { at } else { at % 600 }.min(copy.len() - 1);
        match random.below(7) {
            0 => copy.truncate(at),
            1 | 2 => copy[at] ^= 1 << random.below(8),
            3 => copy[at] = [0, 0xFF, b'\n', b' ', b'-', b'9'][random.below(6)],
            4 => {
                let numbers = numbers(&copy);
                if !numbers.is_empty() {
                    let range = numbers[random.below(numbers.len())].clone();
                    let lie = LIES[random.below(LIES.len())];
                    copy.splice(range, lie.bytes());
                }
            }
            5 => {
                let value = [0, 1, 255, 1 << 16, u32::MAX >> 1, u32::MAX][random.below(6)];
                let end = (at + 4).min(copy.len());
                copy[at..end].copy_from_slice(&value.to_le_bytes()[..end - at]);
            }
            _ => {
                let end = (at + 1 + random.below(100)).min(copy.len());
                let part = copy[at..end].to_vec();
                let to = random.below(copy.len());
                copy.splice(to..to, part);
            }
        }
    }
    copy
}

/// Reads `bytes`; checks the result and the memory.
fn check(name: &str, bytes: &[u8], options: &ReadOptions) -> bool {
    HEAP.reset_peak_memory();
    let read = read_from(name, bytes, options);
    let peak = HEAP.get_peak_memory();
    let limit = FIXED + PER_BYTE * bytes.len();
    assert!(
        peak <= limit,
        "{name}: {peak} bytes of memory for {} bytes",
        bytes.len()
    );
    match read {
        Ok(mesh) => {
            assert!(mesh.positions.iter().all(|p| p.is_finite()), "{name}");
            let all = mesh.faces.len() + mesh.short_faces.len();
            let places = mesh.faces.iter().map(|(f, _)| mesh.face_place(f));
            assert_eq!(places.count(), mesh.faces.len());
            let (polygons, left_out) = mesh.into_polygons();
            assert_eq!(polygons.face_count() + left_out.len(), all, "{name}");
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with(name), "{message}");
            assert!(message.len() < 500, "{message}");
            false
        }
    }
}

/// Returns files of every format that this crate writes.
fn written_files() -> Vec<(String, Vec<u8>)> {
    let mixed = shapes::mixed_grid(4, 3).expect("small");
    let closed = shapes::geodesic(2).expect("small");
    let mut files = Vec::new();
    for mesh in [&mixed, &closed] {
        for format in Format::ALL {
            let mut bytes = Vec::new();
            write_to(mesh, format, &WriteOptions::default(), &mut bytes)
                .expect("memory does not fail");
            files.push((format!("{format}.{}", format.extension()), bytes));
        }
    }
    files
}

/// Returns the real meshes, if the variable `SIXFOLD_MESHES` has the path of their folder.
fn real_files() -> Vec<(String, Vec<u8>)> {
    let Some(folder) = std::env::var_os("SIXFOLD_MESHES").map(PathBuf::from) else {
        return Vec::new();
    };
    let mut files = Vec::new();
    for sub in ["tiny", "fetched", "derived"] {
        for entry in fs::read_dir(folder.join(sub)).expect("a folder of meshes") {
            let path = entry.expect("readable").path();
            if Format::from_path(&path).is_some() {
                let name = Path::new(path.file_name().expect("a file"))
                    .display()
                    .to_string();
                files.push((name, fs::read(&path).expect("readable")));
            }
        }
    }
    files.sort();
    files
}

#[test]
fn damaged_files_give_a_mesh_or_an_error() {
    let options = [
        ReadOptions::default(),
        ReadOptions::default().with_welding(Welding::All),
        ReadOptions::default()
            .with_welding(Welding::Nothing)
            .recentred(),
    ];
    let mut files = written_files();
    files.extend(real_files());
    let (mut valid, mut refused) = (0, 0);
    for (number, (name, bytes)) in files.iter().enumerate() {
        let mut random = Random(number as u64);
        for length in 0..bytes.len().min(1000) {
            check(name, &bytes[..length], &options[length % options.len()]);
        }
        let variants = VARIANTS.min(BYTES_PER_FILE / bytes.len()).max(4);
        for variant in 0..variants {
            let damaged = damaged(bytes, &mut random);
            match check(name, &damaged, &options[variant % options.len()]) {
                true => valid += 1,
                false => refused += 1,
            }
        }
    }
    println!(
        "{} files: {valid} damaged copies were valid, {refused} refused",
        files.len()
    );
    assert!(
        valid > 1000 && refused > 1000,
        "{valid} valid, {refused} refused"
    );
}
