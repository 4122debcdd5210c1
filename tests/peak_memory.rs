//! Checks that a native step allocates almost no memory in addition to the mesh and its child.
//!
//! This is a separate program, because its allocator counts every byte.

use std::alloc::System;

use peakmem_alloc::{INSTRUMENTED_SYSTEM, PeakMemAlloc, PeakMemAllocTrait};
use sixfold::subdivision::{Scheme, Subdivision};
use sixfold::{Creases, PolygonMesh, Refine, Representation, for_each_refinable, shapes};

#[global_allocator]
static HEAP: &PeakMemAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Returns the peak memory of one step divided by the memory of the mesh and its child.
fn peak_of_a_step<M: Refine>(scheme: Scheme, polygons: &PolygonMesh) -> Option<f64> {
    let subdivision = Subdivision::new(scheme);
    let split = subdivision.split(0)?;
    if !M::SPLITS.iter().any(|known| known.name() == split.name()) {
        return None;
    }
    let mesh = M::from_polygons(polygons).ok()?;
    let creases = subdivision.control_creases(&mesh, polygons, &Creases::default());
    let creases = creases.expect("no creases");
    HEAP.reset_peak_memory();
    let (mut numbers, mut child) = (M::EdgeNumbers::default(), M::empty());
    let done = subdivision.refine_into(&mesh, &creases, 0, &mut numbers, &mut child);
    done.expect("the structure supports the split");
    let peak = HEAP.get_peak_memory();
    let [parent, child] = [&mesh, &child].map(|mesh| mesh.memory().total());
    Some((parent + peak) as f64 / (parent + child) as f64)
}

fn a_native_step_needs_little_more_than_its_result() {
    let closed = shapes::geodesic(60).expect("72,000 triangles");
    let open = shapes::triangle_grid(150, 150).expect("45,000 triangles");
    let quads = shapes::torus(200, 200).expect("40,000 quads");
    let mixed = shapes::mixed_grid(150, 150).expect("mixed degrees");
    // Each thread would allocate its own stack and queues.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let mut steps = 0;
    pool.expect("a thread").install(|| {
        for scheme in [Scheme::CatmullClark, Scheme::Loop, Scheme::Sqrt3] {
            for (name, polygons) in [
                ("closed", &closed),
                ("open", &open),
                ("quads", &quads),
                ("mixed", &mixed),
            ] {
                let triangles = polygons.faces().uniform_degree() == Some(3);
                if !triangles && scheme != Scheme::CatmullClark {
                    continue;
                }
                for_each_refinable!(M => {
                    if let Some(peak) = peak_of_a_step::<M>(scheme, polygons) {
                        println!("{scheme} on {}, {name}: {peak:.3}", M::NAME);
                        assert!(peak <= 1.1, "{scheme} on {}, {name}: {peak:.3}", M::NAME);
                        steps += 1;
                    }
                });
            }
        }
    });
    assert!(steps >= 20, "only {steps} steps were checked");
}

sixfold_tests::main_on_one_thread!(a_native_step_needs_little_more_than_its_result);
