//! Prints how fast mesh files are read, and the most memory that this took:
//! `reading FILE…`. On Linux only, because the memory comes from `/proc`.
//!
//! With `reading --json FILE` it prints seconds, bytes of memory, vertices and faces as a JSON list.
//!
//! With `reading --generate FREQUENCY FOLDER` it writes a sphere of 20 · FREQUENCY² triangles in
//! every format.

use std::error::Error;
use std::fs::{self, File};
use std::path::Path;
use std::time::Instant;

use sixfold_io::{FileMesh, Format, WriteOptions, write_to};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [option, frequency, folder] = arguments.as_slice()
        && option == "--generate"
    {
        let mesh = sixfold_shapes::geodesic(frequency.parse()?)?;
        for format in Format::ALL {
            let name = format!("{}.{}", format.name(), format.extension());
            let path = Path::new(folder).join(name);
            let start = Instant::now();
            let file = File::create(&path)?;
            write_to(&mesh, format, &WriteOptions::default(), file)?;
            println!(
                "{}: written in {:.2} s",
                path.display(),
                start.elapsed().as_secs_f64()
            );
        }
        return Ok(());
    }
    if let [option, file] = arguments.as_slice()
        && option == "--json"
    {
        let (mesh, seconds, peak) = measure(file)?;
        let (vertices, faces) = (mesh.positions.len(), mesh.faces.len());
        println!("[{seconds}, {peak}, {vertices}, {faces}]");
        return Ok(());
    }
    for file in &arguments {
        print(file)?;
    }
    Ok(())
}

/// Reads a file; also returns the seconds and the bytes of memory.
fn measure(file: &str) -> Result<(FileMesh, f64, f64), Box<dyn Error>> {
    // Resets the largest memory.
    fs::write("/proc/self/clear_refs", "5")?;
    let before = memory("VmRSS:")?;
    let start = Instant::now();
    let mesh = sixfold_io::read(file)?;
    let seconds = start.elapsed().as_secs_f64();
    let peak = memory("VmHWM:")? - before;
    Ok((mesh, seconds, peak))
}

/// Reads a file and prints time, speed and memory.
fn print(file: &str) -> Result<(), Box<dyn Error>> {
    let bytes = fs::metadata(file)?.len() as f64;
    let (mesh, seconds, peak) = measure(file)?;
    let mesh_bytes = 12 * mesh.positions.len() + 4 * mesh.faces.corners().len();
    println!(
        "{file}: {} vertices, {} faces, {seconds:.2} s, {:.0} MB/s, {:.0} MB at most = {:.2} × the mesh",
        mesh.positions.len(),
        mesh.faces.len(),
        bytes / 1e6 / seconds,
        peak / 1e6,
        peak / mesh_bytes as f64,
    );
    Ok(())
}

/// Returns a number of bytes from the status of this process.
fn memory(field: &str) -> Result<f64, Box<dyn Error>> {
    let status = fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find(|line| line.starts_with(field));
    let kib = line
        .and_then(|line| line.split_whitespace().nth(1))
        .ok_or("no such field")?;
    Ok(kib.parse::<f64>()? * 1024.0)
}
