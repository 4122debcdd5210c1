//! What is shown of edits: the rows before and after, on all structures.

use std::collections::{BTreeMap, HashMap};

use sixfold::{Edit, HalfEdgeMesh, PolygonMesh, Relation, shapes};
use sixfold_explain::{BuiltMesh, EditByName, EditTrace, ExplainError, Records, Step, Structure};

/// The stored fields of all rows, by the names of the table and of the row; `None` if records do not show
/// the row, because the element was deleted.
type Rows = BTreeMap<(&'static str, String), Option<Vec<String>>>;

fn stored(records: &[Records]) -> Rows {
    let mut rows = Rows::new();
    for records in records {
        for record in &records.rows {
            for (i, column) in records
                .columns
                .iter()
                .enumerate()
                .filter(|(_, c)| !c.derived)
            {
                let row = rows.entry((column.table, record.name.clone()));
                match record.fields.get(i) {
                    None => *row.or_default() = None,
                    Some(field) => {
                        row.or_insert(Some(Vec::new()))
                            .as_mut()
                            .expect("shown")
                            .push(field.clone());
                    }
                }
            }
        }
    }
    rows
}

/// Returns whether two rows are equal; a row that is not shown equals every row.
fn are_equal(shown: Option<&Option<Vec<String>>>, row: Option<&Vec<String>>) -> bool {
    match shown {
        Some(None) => true,
        Some(Some(shown)) => row == Some(shown),
        None => row.is_none(),
    }
}

/// Returns all edits of small meshes: each kind, with all elements that it can take.
fn commands(polygons: &PolygonMesh) -> Vec<EditByName> {
    let mut texts = vec![
        "set_position v0 0.25,0.5,4".to_owned(),
        "add_vertex 5,5,5".into(),
        "remove_isolated_vertices".into(),
        "compact".into(),
    ];
    for v in 0..polygons.vertex_count() {
        texts.push(format!("remove_vertex v{v}"));
        let [left, right] = [1, 2].map(|step| (v + step) % polygons.vertex_count());
        texts.push(format!("split_vertex v{v} v{left} v{right}"));
        texts.push(format!("split_vertex v{v} none v{right}"));
    }
    for (f, face) in polygons.faces().iter() {
        let f = f.index();
        texts.push(format!("remove_face f{f}"));
        texts.push(format!("remove_faces f{f}"));
        let next = (f + 1) % polygons.face_count();
        texts.push(format!("remove_faces f{next} f{f}"));
        texts.push(format!("poke_face f{f}"));
        let [a, c] = [face[0].index(), face[2].index()];
        texts.push(format!("split_face f{f} v{a} v{c}"));
        let sides = face.iter().zip(face.iter().cycle().skip(1));
        for [a, b] in sides.map(|(a, b)| [a.index(), b.index()]) {
            texts.extend(
                ["flip_edge", "dissolve_edge", "split_edge", "bisect_edge"]
                    .map(|edit| format!("{edit} v{a}-v{b}")),
            );
            texts.push(format!("collapse_edge v{a}-v{b} v{a}"));
            texts.push(format!(
                "add_face v{b} v{a} v{}",
                (a + b) % polygons.vertex_count()
            ));
        }
    }
    texts.iter().map(|text| text.parse().expect(text)).collect()
}

/// Returns the structure after edits.
fn edited(structure: &Structure, polygons: &PolygonMesh, edits: &[EditByName]) -> BuiltMesh {
    let mut mesh = structure.build(polygons).expect("held");
    for edit in edits {
        mesh.apply(edit).expect("elements of the mesh");
    }
    mesh
}

/// Runs edits, and returns what each of them does.
fn run(structure: &Structure, polygons: &PolygonMesh, edits: &[&str]) -> Vec<EditTrace> {
    let mut mesh = edited(structure, polygons, &[]);
    let edits = edits.iter().map(|edit| edit.parse().expect(edit));
    edits
        .map(|edit| mesh.edit(&edit).expect("elements of the mesh"))
        .collect()
}

/// Checks one edit after the edits `before`. Returns what it did, if its elements exist.
fn check(
    structure: &Structure,
    polygons: &PolygonMesh,
    before: &[EditByName],
    command: &EditByName,
) -> Option<EditTrace> {
    let mut edits = before.to_vec();
    edits.push(command.clone());
    let context = format!("{} {edits:?}", structure.name());
    let mut mesh = edited(structure, polygons, before);
    let records = mesh.records(0..usize::MAX);
    let trace = match mesh.edit(command) {
        Ok(trace) => trace,
        Err(ExplainError::NoSuchElement { .. }) => return None,
        Err(error) => panic!("{context}: {error}"),
    };
    // An edit that is left out is undone.
    let again = edited(structure, polygons, before);
    assert_eq!(again.records(0..usize::MAX), records, "{context}");
    let mut rows = stored(&records);
    for change in &trace.rows {
        let place = (change.table, change.row.clone());
        let is_touched = change.is_written || change.is_changed();
        assert!(is_touched, "{context}: {change:?}");
        for fields in [&change.before, &change.after].into_iter().flatten() {
            assert_eq!(fields.len(), change.columns.len(), "{context}: {change:?}");
        }
        let is_shown = are_equal(rows.get(&place), change.before.as_ref());
        assert!(is_shown, "{context}: {change:?}");
        if let (Some(_), Some(_), true) = (&change.before, &change.after, change.is_changed()) {
            assert!(
                change.is_written || command.edit() == Edit::Compact,
                "{context}: {change:?}"
            );
        }
        rows.insert(place, change.after.clone());
    }
    for (place, after) in stored(&mesh.records(0..usize::MAX)) {
        let row = rows.remove(&place).flatten();
        let is_shown = are_equal(Some(&after), row.as_ref());
        assert!(is_shown, "{context}: {place:?} {row:?}, is {after:?}");
    }
    rows.retain(|_, row| row.is_some());
    assert!(
        rows.is_empty(),
        "{context}: rows that do not exist: {rows:?}"
    );
    // Several tables can have a row, and a row can be read several times.
    let only_read: usize = trace.only_read.iter().map(|read| read.rows).sum();
    let read = trace.rows.iter().filter(|row| row.is_read).count() + only_read;
    assert!(read <= trace.reads, "{context}: {trace:?}");
    if command.edit() != Edit::Compact {
        assert_eq!(read > 0, trace.reads > 0, "{context}: {trace:?}");
    }
    if trace.refusal.is_some() {
        assert!(
            !trace.rows.iter().any(|row| row.is_changed()),
            "{context}: {trace:?}"
        );
        let named = [&trace.created, &trace.removed].map(Vec::len);
        assert_eq!((named, trace.renamed.len()), ([0, 0], 0), "{context}");
    }
    Some(trace)
}

#[test]
fn the_rows_before_and_the_shown_changes_are_the_rows_after() {
    let open = shapes::triangle_grid(2, 1).expect("a small size");
    let mixed = shapes::mixed_grid(2, 2).expect("a small size");
    let mut accepted: BTreeMap<(&str, Edit), usize> = BTreeMap::new();
    for polygons in [shapes::octahedron(), open, mixed] {
        let commands = commands(&polygons);
        for structure in Structure::all() {
            if structure.build(&polygons).is_err() {
                continue;
            }
            // Each edit alone, and after an edit that leaves holes.
            let holes: EditByName = "remove_face f0".parse().expect("an edit");
            for before in [&[][..], &[holes]] {
                for command in &commands {
                    let trace = check(&structure, &polygons, before, command);
                    if trace.is_some_and(|trace| trace.refusal.is_none()) {
                        *accepted
                            .entry((structure.name(), command.edit()))
                            .or_default() += 1;
                    }
                }
            }
        }
    }
    // The soup has no vertices without a face, and a corner table no polygons.
    let unsupported = [
        ("polygon-soup", Edit::AddVertex),
        ("corner-table", Edit::SplitEdge),
        ("corner-table", Edit::SplitFace),
        ("corner-table", Edit::DissolveEdge),
    ];
    for structure in Structure::all() {
        for edit in Edit::ALL {
            let place = (structure.name(), edit);
            let is_accepted = accepted.contains_key(&place);
            assert_eq!(is_accepted, !unsupported.contains(&place), "{place:?}");
        }
    }
}

#[test]
fn a_flip_shows_what_it_rewrites_and_a_refusal_shows_its_rule() {
    let half_edge = Structure::find("half-edge").expect("one of six");
    let quad = shapes::triangle_grid(1, 1).expect("a small size");
    let (a, b) = (0, 3);
    let trace = &run(&half_edge, &quad, &[&format!("flip_edge v{a}-v{b}")])[0];
    assert_eq!(trace.refusal, None);
    assert!(trace.reads > 0 && trace.writes > 0);
    let changed: Vec<&str> = (trace.rows.iter())
        .filter(|row| row.is_changed() && row.table == "halves")
        .map(|row| row.row.as_str())
        .collect();
    // The diagonal has two half-edges, and each triangle two more.
    assert_eq!(changed.len(), 6, "{changed:?}");
    let tetrahedron = shapes::tetrahedron();
    for trace in run(&half_edge, &tetrahedron, &["flip_edge v0-v2"; 2]) {
        let refusal = trace.refusal.expect("an end has three edges");
        assert!(
            refusal.starts_with("vertex v0 has only three edges"),
            "{refusal}"
        );
    }
    let read_only = Structure::new::<HalfEdgeMesh>();
    let mut fixed = read_only.build(&tetrahedron).expect("a manifold");
    let compact = "compact".parse().expect("an edit");
    let errors = [fixed.edit(&compact).err(), fixed.apply(&compact).err()];
    for error in errors {
        let message = error.expect("not editable").to_string();
        assert_eq!(message, "half-edge has no edits");
    }
}

#[test]
fn a_refusal_names_the_same_elements_on_every_structure() {
    let octahedron = shapes::octahedron();
    let bisect: EditByName = "bisect_edge v0-v2".parse().expect("an edit");
    let mut commands = commands(&octahedron);
    let more = [
        "split_face f8 v2 v6",
        "split_face f9 v2 v6",
        "collapse_edge v2-v6 v0",
        "flip_edge v4-v6",
    ];
    commands.extend(more.map(|text| text.parse().expect(text)));
    let mut named = 0;
    // A new face can lie at other elements.
    for edit in commands
        .iter()
        .filter(|edit| !edit.to_string().starts_with("add_face"))
    {
        for structure in Structure::all() {
            let mut mesh = edited(&structure, &octahedron, std::slice::from_ref(&bisect));
            let Ok(Some(text)) = mesh.apply(edit) else {
                continue;
            };
            // Structures may find different faults first, but only in elements that the edit names.
            let edit = edit.to_string();
            let words = text.split([' ', ',', ':', ';']);
            let names = words.filter(|word| word.ends_with(|c: char| c.is_ascii_digit()));
            for name in names.filter(|name| name.starts_with(['f', 'e']) || name.contains('-')) {
                let (name_of, text) = (structure.name(), &text);
                assert!(
                    edit.split(' ').any(|word| word == name),
                    "{name_of}: {edit}: {text}"
                );
                named += 1;
            }
        }
    }
    assert!(named > 50, "{named}");
}

#[test]
fn rows_that_are_only_read_are_listed_in_runs() {
    let winged_edge = Structure::find("winged-edge").expect("one of six");
    let flip = &run(&winged_edge, &shapes::octahedron(), &["flip_edge v0-v2"])[0];
    let runs = flip.only_read.iter();
    let runs: Vec<_> = runs
        .map(|run| (run.table, run.row.as_str(), run.rows))
        .collect();
    let spokes = [("spokes", "v0", 1), ("spokes", "v2", 1)];
    let edges = [("edges", "e5", 1), ("edges", "e7", 1), ("edges", "e10", 2)];
    assert_eq!(runs, [&spokes[..], &edges].concat());
    // These rows are written, and have the values that they had.
    let same = flip.rows.iter().filter(|row| !row.is_changed());
    let same: Vec<_> = same.map(|row| (row.row.as_str(), row.is_written)).collect();
    assert_eq!(same, [("f0", true), ("f4", true)]);
}

#[test]
fn new_elements_get_the_next_numbers_and_compaction_keeps_the_names() {
    let edits = [
        "poke_face f0",
        "remove_face f1",
        "compact",
        "remove_vertex v6",
    ];
    for structure in Structure::all() {
        let traces = run(&structure, &shapes::octahedron(), &edits);
        assert_eq!(
            traces[0].created,
            ["v6", "f8", "f9"],
            "{}",
            structure.name()
        );
        assert_eq!(traces[1].removed, ["f1"], "{}", structure.name());
        assert!(!traces[2].renamed.is_empty(), "{}", structure.name());
        assert!(
            traces[3].removed.contains(&"v6".to_owned()),
            "{}",
            structure.name()
        );
    }
}

/// The positions of vertices and of the corners of faces, by name.
type Named = (Vec<Option<[u32; 3]>>, Vec<Option<Vec<[u32; 3]>>>);

/// Returns the elements of the structure after edits, or `None` if it refuses one.
fn named(structure: &Structure, polygons: &PolygonMesh, edits: &[EditByName]) -> Option<Named> {
    let geometry = structure.build_after(polygons, edits).ok()?.geometry();
    let key = |position: [f32; 3]| position.map(|x| (x + 0.0).to_bits());
    let vertices: Vec<_> = (geometry.vertices.iter()).map(|v| v.map(key)).collect();
    let corners = |face: &Vec<u32>| {
        let corners = face
            .iter()
            .map(|&v| vertices[v as usize].expect("a corner"));
        let mut corners: Vec<_> = corners.collect();
        let lowest = (0..corners.len()).min_by_key(|&i| corners[i]);
        corners.rotate_left(lowest.unwrap_or(0));
        corners
    };
    let faces = geometry.faces.iter().map(|f| f.as_ref().map(corners));
    Some((vertices.clone(), faces.collect()))
}

/// Checks that all structures that accept the edits have the same elements by name. Returns the
/// number of these structures.
fn check_names(polygons: &PolygonMesh, edits: &[EditByName]) -> usize {
    let mut first: Option<Named> = None;
    let mut count = 0;
    for structure in Structure::all() {
        let Some(found) = named(&structure, polygons, edits) else {
            continue;
        };
        count += 1;
        let (vertices, faces) = first.get_or_insert_with(|| found.clone());
        let context = format!("{} {edits:?}", structure.name());
        assert_eq!(found.1, *faces, "{context}");
        assert_eq!(found.0.len(), vertices.len(), "{context}");
        // A soup does not keep a vertex that loses its last face.
        let mut pairs = found.0.iter().zip(&*vertices);
        let are_same = pairs.all(|(v, first)| v == first || v.is_none() || first.is_none());
        assert!(are_same, "{context}: {:?} {vertices:?}", found.0);
    }
    count
}

#[test]
fn a_name_means_the_same_element_on_every_structure() {
    let open = shapes::triangle_grid(2, 1).expect("a small size");
    let mixed = shapes::mixed_grid(2, 1).expect("a small size");
    let last = [
        "remove_face f1",
        "poke_face f2",
        "bisect_edge v0-v2",
        "compact",
    ];
    let last = last.map(|edit| edit.parse::<EditByName>().expect("an edit"));
    let mut most = 0;
    for polygons in [shapes::octahedron(), open, mixed] {
        for first in commands(&polygons) {
            for last in &last {
                most = most.max(check_names(&polygons, &[first.clone(), last.clone()]));
            }
        }
    }
    assert_eq!(most, Structure::all().len());
}

#[test]
fn names_are_the_same_on_a_structure_that_merges_vertices() {
    // v5 is at the position of v0.
    let at = |x: u8, y: u8| sixfold::Point::new(x.into(), y.into(), 0.0);
    let positions = vec![at(0, 0), at(1, 2), at(2, 1), at(0, 4), at(4, 0), at(0, 0)];
    let touching = PolygonMesh::new(positions, [vec![0, 2, 1], vec![5, 3, 4]]);
    let touching = touching.expect("two triangles");
    let edits = ["poke_face f1", "poke_face f2", "bisect_edge v3-v6"];
    let edits = edits.map(|edit| edit.parse().expect("an edit"));
    for count in 1..=3 {
        assert_eq!(check_names(&touching, &edits[..count]), 6);
    }
}

#[test]
fn the_parts_of_a_face_have_the_same_names_on_every_structure() {
    let edits = ["bisect_edge v0-v2".parse().expect("an edit")];
    for structure in Structure::all() {
        let name = structure.name();
        let mesh = edited(&structure, &shapes::octahedron(), &edits);
        let corners = |f: &str| {
            let trace = mesh.trace(Relation::FaceVertices, f.parse().expect("a name"));
            let mut corners = trace.expect("a face").results;
            corners.sort();
            corners.join(" ")
        };
        // v6 is on the edge of f0 (v0 v2 v4) and f4 (v2 v0 v5).
        let parts = ["f0", "f4", "f8", "f9"].map(corners);
        let expected = ["v0 v4 v6", "v0 v5 v6", "v2 v4 v6", "v2 v5 v6"];
        assert_eq!(parts, expected, "{name}");
    }
}

#[test]
fn a_brief_edit_has_the_counts_of_all_rows() {
    let compact: EditByName = "compact".parse().expect("an edit");
    let removal = ["remove_vertex v0".parse().expect("an edit")];
    for structure in Structure::all() {
        let name = structure.name();
        let whole = edited(&structure, &shapes::octahedron(), &removal).edit(&compact);
        let whole = whole.expect("an edit");
        let changed = whole.rows.iter().filter(|row| row.is_changed()).count();
        assert_eq!(whole.changed, changed, "{name}");
        assert!(changed > 2, "{name}");
        let brief = edited(&structure, &shapes::octahedron(), &removal).edit_briefly(&compact, 2);
        let brief = brief.expect("an edit");
        assert_eq!((brief.changed, brief.rows.len()), (changed, 2), "{name}");
        assert_eq!(brief.rows, whole.rows[..2], "{name}");
        assert_eq!(
            brief.only_read.len(),
            whole.only_read.len().min(2),
            "{name}"
        );
        assert_eq!(brief.renamed.len(), whole.renamed.len().min(2), "{name}");
        assert_eq!(
            (brief.reads, brief.after),
            (whole.reads, whole.after),
            "{name}"
        );
    }
}

#[test]
fn the_counts_of_a_query_after_a_deletion_are_those_of_its_steps() {
    let edits = ["remove_face f0".parse().expect("an edit")];
    let queries = [
        (Relation::FaceVertices, "f1"),
        (Relation::FaceFaces, "f2"),
        (Relation::VertexFaces, "v1"),
        (Relation::EdgeFaces, "v1-v4"),
    ];
    for structure in Structure::all() {
        let mesh = edited(&structure, &shapes::octahedron(), &edits);
        for (relation, element) in queries {
            let trace = mesh.trace(relation, element.parse().expect("a name"));
            let trace = trace.expect("a trace");
            let rows = trace.steps.iter().map(|step| match step {
                Step::Read(read) => read.rows,
                Step::Yield { .. } => 0,
            });
            assert_eq!(
                rows.sum::<usize>(),
                trace.cost.reads,
                "{} {relation}",
                structure.name()
            );
        }
    }
}

#[test]
fn rows_that_an_edit_moved_have_the_names_of_their_elements() {
    let edits = ["remove_vertex v0", "poke_face f1", "compact"];
    let edits = edits.map(|edit| edit.parse().expect("an edit"));
    for structure in Structure::all() {
        let name = structure.name();
        let before = edited(&structure, &shapes::octahedron(), &edits[..2]);
        let mut moved = before.moved_rows().into_iter();
        // Structures differ in the part of f1 that keeps its row.
        assert!(moved.all(|[row, _]| row.starts_with('f')), "{name}");
        let mesh = edited(&structure, &shapes::octahedron(), &edits);
        let moved: HashMap<String, String> =
            mesh.moved_rows().into_iter().map(<[_; 2]>::into).collect();
        let geometry = mesh.geometry();
        let records = mesh.records(0..20);
        for table in records.iter().filter(|table| table.element == "vertex") {
            assert!(!moved.is_empty(), "{name}");
            for row in &table.rows {
                let element = moved.get(&row.name).unwrap_or(&row.name);
                let number: usize = element[1..].parse().expect("a number");
                let [x, y, z] = geometry.vertices[number].expect("a vertex");
                assert_eq!(
                    row.fields[0],
                    format!("({x}, {y}, {z})"),
                    "{name} {}",
                    row.name
                );
            }
        }
    }
}

#[test]
fn an_edit_without_its_elements_is_an_error() {
    let half_edge = Structure::find("half-edge").expect("one of six");
    for edit in Edit::ALL {
        let text = format!("{edit} none none");
        let error = text.parse::<EditByName>().expect_err(&text).to_string();
        assert!(error.contains(": write "), "{text}: {error}");
    }
    let command = "poke_face f8".parse().expect("an edit");
    let error = edited(&half_edge, &shapes::octahedron(), &[]).edit(&command);
    let error = error.expect_err("the octahedron has 8 faces").to_string();
    assert_eq!(error, "half-edge has no face f8 in this mesh");
}

#[test]
fn an_edit_with_very_many_accesses_is_not_shown() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let coincident = PolygonMesh::new(corners, vec![[0, 1, 2]; 3_000]).expect("valid");
    let structure = Structure::find("face-vertex").expect("one of six");
    let removal: EditByName = "remove_vertex v0".parse().expect("an edit");
    let mut mesh = edited(&structure, &coincident, &[]);
    let error = mesh.edit(&removal).expect_err("3,000 × 3,000 reads");
    assert_eq!(
        error.to_string(),
        "face-vertex makes more than 8000000 reads and writes for remove_vertex v0: choose a smaller mesh, \
         or an element with fewer faces"
    );
    assert_eq!(mesh.edit(&removal), Err(error), "the mesh is unchanged");
    assert_eq!(mesh.apply(&removal), Ok(None));
}
