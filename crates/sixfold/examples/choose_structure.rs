//! Chooses the structure at run time: `visit` calls a generic function for the structure with the
//! given name.
//!
//! ```sh
//! cargo run --example choose_structure -- corner-table mesh.obj
//! ```

use std::error::Error;

use sixfold::prelude::*;
use sixfold::{Visitor, visit};

/// Computes the mean valence of the vertices of a mesh.
pub struct MeanValence<'a> {
    /// The mesh as polygons.
    pub polygons: &'a PolygonMesh,
}

impl Visitor for MeanValence<'_> {
    type Output = Result<f64, BuildError>;

    fn visit<M: Representation + 'static>(&mut self) -> Self::Output {
        let mesh = M::from_polygons(self.polygons)?;
        let sum: usize = mesh.vertices().map(|v| mesh.valence(v)).sum();
        Ok(sum as f64 / mesh.vertex_count().max(1) as f64)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "half-edge".into());
    let polygons = match arguments.next() {
        Some(path) => sixfold::io::read(&path)?.into_polygons().0,
        None => sixfold::shapes::geodesic(8)?,
    };
    let mut task = MeanValence {
        polygons: &polygons,
    };
    let valence =
        visit(&name, &mut task).ok_or_else(|| format!("no structure is called {name}"))??;
    println!("{name}: the mean valence is {valence:.3}");
    Ok(())
}
