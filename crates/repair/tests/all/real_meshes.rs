//! Repairs of real meshes: the folder that the variable `SIXFOLD_MESHES` names, with its subfolders.
//!
//! If the variable is not set, these tests do nothing; `laws.rs` tests everything without files.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use sixfold_core::{Facts, PolygonMesh, Representation};
use sixfold_corner_table::CornerTable;
use sixfold_half_edge::HalfEdgeMesh;
use sixfold_polygon_soup::PolygonSoup;
use sixfold_repair::{FaultKind, Step, Tolerance, Weld, WeldMethod, diagnose, repair, repair_for};

/// Returns the OBJ files below `folder`, sorted.
fn obj_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a readable folder");
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            files.extend(obj_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "obj") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Calls `test` with the name and the mesh of every file.
fn for_each_mesh(test: impl Fn(&str, &PolygonMesh)) {
    let Some(folder) = env::var_os("SIXFOLD_MESHES").map(PathBuf::from) else {
        return;
    };
    let files = obj_files(&folder);
    assert!(!files.is_empty(), "no OBJ file below {}", folder.display());
    for file in files {
        let obj = sixfold_io::read(&file).expect("a valid file");
        let (polygons, _) = obj.into_polygons();
        test(&file.display().to_string(), &polygons);
    }
}

/// Repairs the mesh for `M` and returns what was done.
fn assert_repaired_for<M: Representation>(name: &str, polygons: &PolygonMesh) -> String {
    let repaired = repair_for(polygons, &M::CAPABILITIES).expect(name);
    let mesh = M::from_polygons(&repaired.polygons);
    let mesh = mesh.unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(mesh.validate(), Ok(()), "{name}");
    if M::from_polygons(polygons).is_ok() {
        assert_eq!(&repaired.polygons, polygons, "{name}");
    }
    let steps = repaired.steps.iter().map(|report| {
        let counts = report.counts;
        format!(
            "{}: vertices +{} −{}, edges cut {}, faces +{} −{}, reversed {}",
            report.step,
            counts.vertices_added,
            counts.vertices_merged + counts.vertices_removed,
            counts.edges_cut,
            counts.faces_added,
            counts.faces_removed,
            counts.faces_reversed
        )
    });
    steps.collect::<Vec<_>>().join("; ")
}

#[test]
fn structures_hold_the_meshes_that_are_repaired_for_them() {
    for_each_mesh(|name, polygons| {
        for fault in diagnose(polygons, 3).faults {
            println!("{name}: {fault}");
        }
        for (structure, done) in [
            (
                "half-edge",
                assert_repaired_for::<HalfEdgeMesh>(name, polygons),
            ),
            (
                "corner-table",
                assert_repaired_for::<CornerTable>(name, polygons),
            ),
            (
                "polygon-soup",
                assert_repaired_for::<PolygonSoup>(name, polygons),
            ),
        ] {
            if !done.is_empty() {
                println!("{name}: for {structure}: {done}");
            }
        }
    });
}

#[test]
fn both_methods_weld_real_meshes_equally() {
    for_each_mesh(|name, polygons| {
        for tolerance in [
            Tolerance::Exact,
            Tolerance::Relative(1e-4),
            Tolerance::Relative(0.02),
        ] {
            let welded = [WeldMethod::Grid, WeldMethod::KdTree].map(|method| {
                let step = Step::Weld(Weld { tolerance, method });
                repair(polygons, &[step]).expect(name)
            });
            assert_eq!(welded[0].polygons, welded[1].polygons, "{name}");
            assert_eq!(
                welded[0].steps[0].counts, welded[1].steps[0].counts,
                "{name}"
            );
        }
    });
}

#[test]
fn a_welded_seam_closes_the_torus() {
    for_each_mesh(|name, polygons| {
        if name.ends_with("seam_torus.obj") {
            let tolerance = Tolerance::Relative(1e-6);
            let weld = Step::Weld(Weld {
                tolerance,
                ..Weld::default()
            });
            let welded = repair(polygons, &[weld]).expect(name).polygons;
            let facts = Facts::from_polygons(&welded);
            assert_eq!(
                (facts.vertices, facts.closed, facts.genus),
                (96, true, Some(1))
            );
            assert_eq!(diagnose(&welded, 1).fault(FaultKind::BoundaryEdge), None);
        }
    });
}
