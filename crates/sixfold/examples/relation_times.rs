//! Times the nine relations on the structures whose queries are local, as a program of a user would:
//! `relation_times MESH [PASSES]`.
//!
//! Each line has a structure, a relation, and the shortest time of a pass in nanoseconds per element.
//! `benches/checks/plain_program.py` compares these times with those of a study.

use std::error::Error;
use std::hash::{Hash, Hasher};
use std::hint::black_box;
use std::time::Instant;

use sixfold::{
    CornerTable, FaceVertexMesh, HalfEdgeMesh, MeshQuery, Representation, WingedEdgeMesh, io,
};

/// Adds the words of a handle.
struct Words(u64);

impl Hasher for Words {
    #[inline(always)]
    fn write_u32(&mut self, word: u32) {
        self.0 = self.0.rotate_left(8).wrapping_add(u64::from(word));
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u32(u32::from(byte));
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

#[inline(always)]
fn token(handle: impl Hash) -> u64 {
    let mut words = Words(0);
    handle.hash(&mut words);
    words.finish()
}

macro_rules! sweeps {
    ($($relation:ident at $elements:ident),+ $(,)?) => {
        $(#[inline(never)]
        fn $relation<M: MeshQuery>(mesh: &M) -> (u64, u64) {
            // The number of results, and the sum of their tokens.
            mesh.$elements().fold((0, 0), |sums: (u64, u64), element| {
                let found = mesh.$relation(element).into_iter();
                found.fold(sums, |(count, sum), handle| (count + 1, sum.wrapping_add(token(handle))))
            })
        })+

        fn print_times<M: Representation>(mesh: &M, passes: u32) {
            $({
                let mut shortest = f64::INFINITY;
                for _ in 0..passes {
                    let start = Instant::now();
                    black_box($relation(black_box(mesh)));
                    shortest = shortest.min(start.elapsed().as_nanos() as f64);
                }
                let each = shortest / mesh.$elements().count() as f64;
                println!("{} {} {each:.3}", M::NAME, stringify!($relation));
            })+
        }
    };
}

sweeps! {
    vertex_vertices at vertices, vertex_edges at vertices, vertex_faces at vertices,
    edge_vertices at edges, edge_edges at edges, edge_faces at edges,
    face_vertices at faces, face_edges at faces, face_faces at faces,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments
        .next()
        .ok_or("usage: relation_times MESH [PASSES]")?;
    let passes = arguments.next().map_or(Ok(100), |passes| passes.parse())?;
    let (polygons, _) = io::read(&path)?.into_polygons();
    print_times(&FaceVertexMesh::from_polygons(&polygons)?, passes);
    print_times(&WingedEdgeMesh::from_polygons(&polygons)?, passes);
    print_times(&HalfEdgeMesh::from_polygons(&polygons)?, passes);
    print_times(&CornerTable::from_polygons(&polygons)?, passes);
    Ok(())
}
