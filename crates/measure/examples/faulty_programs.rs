//! Programs with a fault on the half-edge structure only, and one with a result that depends on the structure. They show how the command line ends such
//! programs, with and without `--isolate`.
//!
//! ```sh
//! cargo run --release --example faulty_programs -- --programs endless --isolate
//! ```

use std::hint::black_box;
use std::process::ExitCode;

use sixfold::prelude::*;
use sixfold_measure::{Outcome, Program, Suite};

fn main() -> ExitCode {
    let suite = Suite::new()
        .program(Faulty {
            name: "sound",
            fault: |_| (),
        })
        .program(Faulty {
            name: "endless",
            fault: |_| never_end(),
        })
        .program(Faulty {
            name: "crashing",
            fault: |_| std::process::abort(),
        })
        .program(Faulty {
            name: "hoarding",
            fault: |_| {
                let mut hoard = Vec::new();
                loop {
                    hoard.push(vec![1_u8; 1 << 20]);
                    black_box(&hoard);
                }
            },
        })
        .program(Faulty {
            name: "panicking",
            fault: |_| panic!("half-edges are not welcome"),
        })
        .program(Faulty {
            name: "chatting",
            fault: |_| print!("half-edges!"),
        })
        .program(Faulty {
            name: "endless-once",
            fault: |_| {
                if is_second_launch() {
                    never_end();
                }
            },
        })
        .program(Faulty {
            name: "crashing-once",
            fault: |_| {
                if is_second_launch() {
                    std::process::abort();
                }
            },
        })
        .program(Faulty {
            name: "panicking-once",
            fault: |_| assert!(!is_second_launch(), "once is enough"),
        })
        .program(Faulty {
            name: "not-a-number",
            fault: |outcome| outcome.checksum = f64::NAN,
        })
        .program(Faulty {
            name: "skipping",
            fault: |outcome| outcome.elements -= 1,
        })
        .program(FirstNeighbours);
    sixfold_measure::main(suite)
}

fn never_end() {
    let mut turns = 0_u64;
    while black_box(true) {
        turns = black_box(turns.wrapping_add(1));
    }
}

/// Returns whether this process is the second launch of a command.
fn is_second_launch() -> bool {
    std::env::var("SIXFOLD_LAUNCH").is_ok_and(|launch| launch.contains("\"number\":1,"))
}

/// Adds up the distances from each vertex to the neighbour that is listed first. The order of neighbours is not
/// guaranteed, so the structures give different results.
struct FirstNeighbours;

impl Program for FirstNeighbours {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        "first-neighbours"
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let distance = |v| {
            let first = mesh.vertex_vertices(v).next()?;
            Some(f64::from(mesh.position(v).distance(mesh.position(first))))
        };
        let sum = mesh.vertices().filter_map(distance).sum();
        Outcome::new(sum, mesh.vertex_count() as u64)
    }
}

/// Adds up the lengths of all edges, with a fault on the half-edge structure.
struct Faulty {
    name: &'static str,
    fault: fn(&mut Outcome),
}

impl Program for Faulty {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        self.name
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let length = |e| {
            let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
            f64::from(a.distance(b))
        };
        let mut outcome = Outcome::new(mesh.edges().map(length).sum(), mesh.edge_count() as u64);
        if std::any::type_name::<M>().contains("HalfEdge") {
            (self.fault)(&mut outcome);
        }
        outcome
    }
}
