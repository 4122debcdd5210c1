//! Writes the first inputs of each target: small shapes in every format, and random bytes for the
//! repair. `seeds FOLDER` makes a folder for each target.

use std::error::Error;
use std::fs::{self, File};
use std::path::PathBuf;

use sixfold::io::{Format, WriteOptions, write_to};
use sixfold::shapes;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: seeds FOLDER")?);
    let meshes = [
        ("cube", shapes::cube()),
        ("tetrahedron", shapes::tetrahedron()),
        ("icosahedron", shapes::icosahedron()),
    ];
    for format in Format::ALL {
        // Binary glTF is an input of the target `gltf`, too.
        let target = if format == Format::Glb {
            "gltf"
        } else {
            format.extension()
        };
        fs::create_dir_all(folder.join(target))?;
        for (name, mesh) in &meshes {
            let file = folder
                .join(target)
                .join(format!("{name}.{}", format.name()));
            write_to(mesh, format, &WriteOptions::default(), File::create(file)?)?;
        }
    }
    fs::create_dir_all(folder.join("creases"))?;
    let entries = "edge 0 1 2.5\ncorner 7 inf # sharp\n";
    fs::write(folder.join("creases/two"), entries)?;
    fs::create_dir_all(folder.join("repair"))?;
    for seed in 0..16_u32 {
        // A multiplicative generator modulo 2³¹ − 1 (Park & Miller 1988).
        let mut state = u64::from(seed) + 1;
        let bytes: Vec<u8> = (0..96)
            .map(|_| {
                state = state * 48_271 % 0x7FFF_FFFF;
                (state >> 8) as u8
            })
            .collect();
        fs::write(folder.join(format!("repair/{seed}")), bytes)?;
    }
    Ok(())
}
