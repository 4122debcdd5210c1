//! Checks that every real mesh loads, and that its facts agree with `truth.json`.
//!
//! The variable `SIXFOLD_MESHES` contains the path of the folder. If the variable is not set, these
//! tests check nothing. If the variable is set, a missing file is a failure.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use sixfold_core::{Distribution, FaceList, Facts, PolygonMesh};
use sixfold_io::{
    FileMesh, Format, IgnoredKind, ReadOptions, Welding, WriteOptions, read_from, read_with,
    write_to,
};

const FOLDERS: [&str; 3] = ["tiny", "fetched", "derived"];

fn folder() -> Option<PathBuf> {
    env::var_os("SIXFOLD_MESHES").map(PathBuf::from)
}

/// Returns the mesh files in `folder`, with the names that `truth.json` uses.
fn files(folder: &Path) -> BTreeSet<String> {
    let mut files = BTreeSet::new();
    for sub in FOLDERS {
        for entry in fs::read_dir(folder.join(sub)).expect("a folder of meshes") {
            let name = entry.expect("readable").file_name();
            let name = name.to_str().expect("a name in UTF-8");
            if Format::from_path(name).is_some() {
                files.insert(format!("{sub}/{name}"));
            }
        }
    }
    files
}

fn load(folder: &Path, name: &str) -> FileMesh {
    load_as(folder, name, Welding::StlOnly)
}

fn load_as(folder: &Path, name: &str, welding: Welding) -> FileMesh {
    let options = ReadOptions::default().with_welding(welding);
    read_with(folder.join(name), &options).unwrap_or_else(|error| panic!("{error}"))
}

fn spread(spread: &Option<Distribution>) -> Value {
    let Some(spread) = spread else {
        return Value::Null;
    };
    let Distribution { min, max, mean, .. } = *spread;
    let hist = spread.hist.as_ref().map(histogram);
    json!({"min": min, "max": max, "mean": mean, "hist": hist})
}

fn histogram(hist: &std::collections::BTreeMap<usize, usize>) -> Value {
    hist.iter()
        .map(|(value, times)| (value.to_string(), json!(times)))
        .collect()
}

/// The faces of the truth file include those that are left out.
fn truth_fields(facts: &Facts) -> [(&'static str, Value); 18] {
    [
        ("V", json!(facts.vertices)),
        ("E", json!(facts.edges)),
        ("F", json!(facts.faces + facts.degenerate_faces)),
        ("euler", json!(facts.euler_characteristic)),
        ("components_edge", json!(facts.components)),
        ("boundary_edges", json!(facts.boundary_edges)),
        ("boundary_loops", json!(facts.boundary_loops)),
        ("nonmanifold_edges", json!(facts.non_manifold_edges)),
        ("nonmanifold_vertices", json!(facts.non_manifold_vertices)),
        ("inconsistent_edges", json!(facts.inconsistent_edges)),
        ("consistently_oriented", json!(facts.consistently_oriented)),
        ("orientable", json!(facts.orientable)),
        ("closed", json!(facts.closed)),
        ("genus", json!(facts.genus)),
        ("V_unreferenced", json!(facts.isolated_vertices)),
        ("duplicate_faces", json!(facts.duplicate_faces)),
        ("F_repeated_index", json!(facts.degenerate_faces)),
        ("valence", spread(&facts.valence)),
    ]
}

/// Returns the name that `truth.json` has for a format.
fn truth_format(format: Format) -> &'static str {
    match format {
        Format::Stl => "stl-binary",
        Format::Ply => "ply-le",
        Format::PlyBigEndian => "ply-be",
        other => other.name(),
    }
}

/// Returns the fields of `theirs` that differ from `facts`.
fn differences(name: &str, theirs: &Value, facts: &Facts) -> Vec<String> {
    let fields = truth_fields(facts).into_iter();
    let wrong = fields.filter(|&(field, ref ours)| theirs.get(field).expect(field) != ours);
    wrong
        .map(|(field, ours)| format!("{name}: {field} is {}, found {ours}", theirs[field]))
        .collect()
}

#[test]
fn facts_equal_the_truth_file() {
    let Some(folder) = folder() else { return };
    let truth = fs::read_to_string(folder.join("truth.json")).expect("truth.json");
    let truth: Value = serde_json::from_str(&truth).expect("JSON");
    let known = truth.as_object().expect("a map of files").keys();
    let known: BTreeSet<String> = known.cloned().collect();
    assert_eq!(files(&folder), known);
    assert!(known.len() > 70, "{known:?}");

    let mut wrong = Vec::new();
    for name in &known {
        let truth = &truth[name];
        assert_eq!(truth["status"], "ok", "{name}");
        let mesh = load_as(&folder, name, Welding::Nothing);
        assert_eq!(truth["format"], truth_format(mesh.format), "{name}");
        let facts = mesh.facts();
        // The truth file has no rule for repeated corners; `repeated_corners.rs` has one.
        let mut kinds = mesh.notices.iter().map(|notice| notice.kind);
        if kinds.any(|kind| kind == IgnoredKind::RepeatedCorners) {
            assert_eq!(name, "tiny/degenerate_faces.obj");
            assert_eq!((facts.faces, facts.degenerate_faces), (14, 2));
            continue;
        }
        wrong.extend(differences(
            &format!("{name} (file)"),
            &truth["file"],
            &facts,
        ));
        let hist = facts.face_degree.and_then(|degrees| degrees.hist);
        let sizes = histogram(&hist.unwrap_or_default());
        if truth["face_sizes"] != sizes {
            let theirs = &truth["face_sizes"];
            wrong.push(format!("{name}: face_sizes are {theirs}, found {sizes}"));
        }
        assert_eq!(truth["V_merged"], truth["V_merged_f32"], "{name}");
        let merged = load_as(&folder, name, Welding::All);
        let theirs = match truth["merged"].is_object() {
            true => &truth["merged"],
            false => &truth["file"],
        };
        wrong.extend(differences(
            &format!("{name} (merged)"),
            theirs,
            &merged.facts(),
        ));
        assert_eq!(mesh.narrowing.merged_vertices, 0, "{name}");
        assert_eq!(
            merged.positions.len() + merged.welded_vertices,
            mesh.positions.len(),
            "{name}"
        );
        let by_default = load(&folder, name);
        let expected = match mesh.format {
            Format::Stl | Format::StlAscii => &merged,
            _ => &mesh,
        };
        assert_eq!(by_default.faces, expected.faces, "{name}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_mesh_survives_every_format() {
    let Some(folder) = folder() else { return };
    for name in files(&folder) {
        let (mesh, _) = load(&folder, &name).into_polygons();
        for format in Format::ALL {
            let is_stl = matches!(format, Format::Stl | Format::StlAscii);
            if is_stl && mesh.face_count() == 0 {
                continue;
            }
            let mut bytes = Vec::new();
            write_to(&mesh, format, &WriteOptions::default(), &mut bytes)
                .expect("memory does not fail");
            let again = read_from(&name, bytes.as_slice(), &ReadOptions::default());
            let again = again.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(again.format, format, "{name}");
            let expected = match format {
                Format::Stl | Format::StlAscii | Format::Gltf | Format::Glb => {
                    mesh.triangulated().expect("few corners").polygons
                }
                _ => mesh.clone(),
            };
            if is_stl {
                let corners = corner_positions(again.positions, &again.faces);
                let expected = corner_positions(expected.positions().to_vec(), expected.faces());
                assert!(corners == expected, "{name} as {format}");
            } else {
                let polygons = PolygonMesh::from_faces(again.positions, again.faces);
                assert!(polygons.expect("valid") == expected, "{name} as {format}");
            }
        }
    }
}

fn corner_positions(positions: Vec<sixfold_core::Point>, faces: &FaceList) -> Vec<[f32; 3]> {
    let corners = faces.corners().iter();
    corners.map(|v| positions[v.index()].to_array()).collect()
}

#[test]
fn exactly_the_degenerate_faces_are_left_out() {
    let Some(folder) = folder() else { return };
    for name in files(&folder) {
        let obj = load(&folder, &name);
        let (before, faces) = (obj.facts(), obj.faces.len());
        let (polygons, left_out) = obj.into_polygons();
        assert_eq!(left_out.len(), before.degenerate_faces, "{name}");
        assert_eq!(polygons.face_count(), faces - left_out.len(), "{name}");
        let after = Facts {
            degenerate_faces: left_out.len(),
            ..Facts::from_polygons(&polygons)
        };
        assert_eq!(after, before, "{name}");
    }
}

/// `tobj` may number the vertices in another order.
#[test]
fn tobj_alone_agrees_on_files_that_it_reads_correctly() {
    let Some(folder) = folder() else { return };
    let options = tobj::LoadOptions::default();
    let mut agreed = 0;
    for name in files(&folder) {
        if !name.ends_with(".obj") {
            continue;
        }
        let Ok((models, _)) = tobj::load_obj(folder.join(&name), &options) else {
            continue;
        };
        let ours = load(&folder, &name);
        // `tobj` has not read the file correctly if there are several objects or missing vertices.
        let [model] = models.as_slice() else { continue };
        let used = ours.positions.len() - ours.facts().isolated_vertices;
        let ignores = |kind| ours.notices.iter().any(|notice| notice.kind == kind);
        if model.mesh.positions.len() != 3 * used
            || ignores(IgnoredKind::Lines)
            || ignores(IgnoredKind::RepeatedCorners)
        {
            continue;
        }
        agreed += 1;
        let mut numbers = vec![None; ours.positions.len()];
        let mut positions = Vec::new();
        let mut indices = Vec::new();
        for v in ours.faces.corners() {
            let next = positions.len() as u32 / 3;
            indices.push(*numbers[v.index()].get_or_insert_with(|| {
                positions.extend(ours.positions[v.index()].to_array());
                next
            }));
        }
        assert_eq!(model.mesh.indices, indices, "{name}");
        assert_eq!(model.mesh.positions, positions, "{name}");
        let degrees = ours.faces.iter().map(|(_, face)| face.len() as u32);
        let arities = &model.mesh.face_arities;
        assert!(
            arities.iter().copied().eq(degrees.clone())
                || arities.is_empty() && degrees.clone().all(|degree| degree == 3),
            "{name}"
        );
    }
    assert!(agreed > 50, "only {agreed} files to compare");
}

#[test]
fn notices_list_what_is_ignored() {
    let Some(folder) = folder() else { return };
    let notices = |name| {
        let notices = load(&folder, name).notices;
        notices.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let pizza = notices("fetched/pizza.obj");
    assert_eq!(pizza.len(), 1, "{pizza:?}");
    assert!(pizza[0].starts_with("ignored 48612 texture coordinates (first at line "));
    assert_eq!(
        notices("tiny/format_negative_groups.obj"),
        [
            "ignored 3 material statements (first at line 2)",
            "ignored 2 object names (first at line 3)",
            "ignored 2 groups (first at line 4)",
            "ignored 4 texture coordinates (first at line 13)",
            "ignored 6 normals (first at line 17)",
            "ignored 2 smoothing groups (first at line 24)",
            "ignored 8 vertex weights or colours (first at line 35)",
        ]
    );
    assert_eq!(
        notices("tiny/format_lines_points.obj"),
        [
            "ignored 1 line (line 9)",
            "ignored 1 point statement (line 10)",
            "ignored 1 free-form statement (line 14)",
        ]
    );
    assert_eq!(
        notices("tiny/degenerate_faces.obj"),
        ["ignored 1 repeated corner of a face (line 27)"]
    );
    let left_out = load(&folder, "tiny/degenerate_faces.obj").into_polygons().1;
    let left_out: Vec<String> = left_out.iter().map(ToString::to_string).collect();
    assert_eq!(
        left_out,
        [
            "line 24: face 1 1 2 names vertex 1 twice",
            "line 26: face 4 4 4 names vertex 4 twice",
        ]
    );
}
