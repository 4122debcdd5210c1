//! Traces recorded on one structure run on the others.

use sixfold::{
    CornerTable, EditableHalfEdgeMesh, FaceVertexMesh, HalfEdgeMesh, MeshEdit, MeshQuery, Point,
    PolygonMesh, PolygonSoup, Representation, WingedEdgeMesh, shapes,
};

use super::*;
use crate::clock::MachineClock;
use crate::job::{Job, Outcome, Task};
use crate::program::{EditProgram, Program, Recorded};
use crate::series::Series;

/// Lists, nested queries, results that are not read, and positions.
struct Mixed;

impl Program for Mixed {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        "mixed"
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let mut sum = 0.0;
        for e in mesh.edges() {
            for v in mesh.edge_vertices(e) {
                sum += f64::from(mesh.position(v).x.abs());
            }
            sum += mesh.edge_faces(e).count() as f64;
        }
        for f in mesh.faces() {
            sum += mesh.face_faces(f).count() as f64;
            sum += mesh.face_vertices(f).take(2).count() as f64;
        }
        sum += mesh.vertices().take(3).count() as f64;
        for v in mesh.vertices() {
            let neighbours = mesh.vertex_vertices(v);
            sum += neighbours
                .map(|w| mesh.vertex_edges(w).count() as f64)
                .sum::<f64>();
        }
        Outcome::new(sum, 1)
    }
}

/// Cuts, flips and collapses edges, and pokes a face.
struct Editor;

impl EditProgram for Editor {
    type Scratch<M: MeshEdit> = ();

    fn name(&self) -> &str {
        "editor"
    }

    fn set_up<M: MeshEdit>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshEdit>(&self, mesh: &mut M, (): &mut ()) -> Outcome {
        let mut done = 0;
        let edges: Vec<M::Edge> = mesh.edges().step_by(5).collect();
        for e in edges {
            if !mesh.contains_edge(e) {
                continue;
            }
            let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
            let Ok(v) = mesh.bisect_edge(e, (a + b) / 2.0) else {
                continue;
            };
            done += 1;
            // The new faces take part in the next edits.
            let faces: Vec<M::Face> = mesh.vertex_faces(v).collect();
            if let Some(&f) = faces.last() {
                let corners = mesh.face_vertices(f).map(|v| mesh.position(v));
                let middle = corners.sum::<Point>() / 3.0;
                done += u64::from(mesh.poke_face(f, middle).is_ok());
            }
            let around: Vec<M::Edge> = mesh.vertex_edges(v).collect();
            if let Some(&e) = around.first() {
                done += u64::from(mesh.flip_edge(e).is_ok());
            }
            let Some(e) = mesh.vertex_edges(v).next() else {
                continue;
            };
            let at = mesh.position(v);
            let ends = mesh.edge_vertices(e);
            let other = mesh.vertices().find(|v| !ends.contains(v));
            if let Some(other) = other {
                assert!(mesh.collapse_edge(e, other, at).is_err());
            }
            done += u64::from(mesh.collapse_edge(e, v, at).is_ok());
        }
        Outcome::new(mesh.face_count() as f64, done)
    }
}

fn trace_of<M: Representation>(polygons: &PolygonMesh) -> Trace {
    let mut mesh = Recorded::<M>::from_polygons(polygons).expect("held");
    mesh.start_trace(polygons);
    Mixed.run(&mesh, &mut ());
    mesh.trace("mixed").expect("few calls")
}

fn edits_of<M: Representation + MeshEdit>(polygons: &PolygonMesh) -> (Trace, PolygonMesh) {
    let mut mesh = Recorded::<M>::from_polygons(polygons).expect("held");
    mesh.start_trace(polygons);
    Editor.run(&mut mesh, &mut ());
    (mesh.trace("editor").expect("few calls"), mesh.to_polygons())
}

/// Runs a trace on all structures. Returns for each structure its result, or why it refuses.
fn outcomes(trace: &Trace, polygons: &PolygonMesh) -> Vec<(&'static str, Result<Outcome, String>)> {
    let suite = crate::suite_of_trace!(trace.clone());
    let [program] = suite.programs() else {
        panic!("one program");
    };
    let clock = MachineClock::start();
    let contestants = program.contestants().iter();
    let run = |contestant: &crate::Contestant| {
        let mut backend = contestant.prepare(polygons).map_err(|r| r.to_string())?;
        let series = Series {
            check: true,
            ..Series::once(&clock)
        };
        let run = backend.run(&Job::new(Task::Program), &series);
        match run.refusal {
            Some(refusal) => Err(refusal),
            None => run.outcome.ok_or_else(|| "no result".to_owned()),
        }
    };
    contestants.map(|c| (c.name(), run(c))).collect()
}

fn written(trace: &Trace) -> String {
    let mut text = Vec::new();
    trace.write(&mut text).expect("memory");
    String::from_utf8(text).expect("UTF-8")
}

#[test]
fn traces_of_queries_do_the_same_on_all_structures() {
    let torus = shapes::triangle_torus(7, 5).expect("small");
    let traces = [
        trace_of::<FaceVertexMesh>(&torus),
        trace_of::<HalfEdgeMesh>(&torus),
        trace_of::<CornerTable>(&torus),
        trace_of::<WingedEdgeMesh>(&torus),
        trace_of::<PolygonSoup>(&torus),
    ];
    for trace in &traces {
        // 35 vertices, 105 edges, 70 faces. Lists: 105 + 70 + 3 + 35; results of queries:
        // 2 · 105 ends, 2 · 105 faces of edges, 3 · 70 faces, 2 · 70 corners, 6 · 35 neighbours with
        // 6 edges each; positions: 2 · 105.
        let expected = 213 + 210 + 210 + 210 + 140 + 210 + 1260 + 210;
        for (name, outcome) in outcomes(trace, &torus) {
            let outcome = outcome.unwrap_or_else(|reason| panic!("{name}: {reason}"));
            assert_eq!(outcome.checksum, f64::from(expected), "{name}");
            assert_eq!(outcome.elements, trace.len() as u64, "{name}");
        }
        assert_eq!(trace.len(), 4 + 105 * 4 + 70 * 2 + 35 + 210);
    }
}

#[test]
fn lists_are_visited_in_the_order_of_each_structure() {
    let torus = shapes::triangle_torus(7, 5).expect("small");
    let trace = trace_of::<WingedEdgeMesh>(&torus);
    let mesh = CornerTable::from_polygons(&torus).expect("triangles");
    let [vertices, edges, _] = replay::handles(&trace, &mesh, &torus).expect("the same mesh");
    let listed = mesh.edges().map(|e| format!("{e:?}"));
    assert!(
        edges
            .iter()
            .step_by(2)
            .take(105)
            .eq(&listed.collect::<Vec<_>>())
    );
    let ends = mesh.edges().flat_map(|e| mesh.edge_vertices(e)).take(4);
    let mut read: Vec<String> = vertices[..4].to_vec();
    let mut ends: Vec<String> = ends.map(|v| format!("{v:?}")).collect();
    // The ends of an edge have no order.
    for pair in read.chunks_mut(2).chain(ends.chunks_mut(2)) {
        pair.sort();
    }
    assert_eq!(read, ends);
}

#[test]
fn traces_of_edits_do_the_same_on_all_structures() {
    let torus = shapes::triangle_torus(7, 5).expect("small");
    let (trace, edited) = edits_of::<EditableHalfEdgeMesh>(&torus);
    assert!(trace.edits.iter().any(|call| call.refused));
    assert!(trace.edits.iter().filter(|call| !call.refused).count() > 40);
    let results = outcomes(&trace, &torus);
    let mut same = 0;
    let done = results
        .iter()
        .find_map(|(_, outcome)| outcome.as_ref().ok());
    for (name, outcome) in &results {
        match outcome {
            Ok(outcome) => {
                same += 1;
                assert_eq!(Some(outcome), done, "{name}");
            }
            // A structure that allows non-manifold meshes does edits that others refuse.
            Err(reason) => assert!(reason.contains("refused"), "{name}: {reason}"),
        }
    }
    assert!(same >= 3, "{results:?}");
    assert!(edited.face_count() > torus.face_count());
}

#[test]
fn traces_are_the_same_after_writing_and_reading() {
    let torus = shapes::triangle_torus(7, 5).expect("small");
    let mut queries = trace_of::<HalfEdgeMesh>(&torus);
    queries.own_ns = 1.5;
    let (edits, _) = edits_of::<EditableHalfEdgeMesh>(&torus);
    for trace in [queries, edits] {
        let text = written(&trace);
        let back = Trace::read("a.trace", text.as_bytes()).expect(&text);
        assert_eq!(back, trace);
    }
}

#[test]
fn every_call_is_written_and_read() {
    let text = "sixfold-trace 2\n\
        program all calls\n\
        mesh 8 12\n\
        own_ns 12.5\n\
        # a comment\n\
        list faces/2\n\
        item 3 4\n\
        end\n\
        list edges\n\
        item 0-7\n\
        edge_edges 1-2/3 4-5\n\
        end\n\
        position 0 1\n\
        set_positions\n\
        set_position v3 1,2,3\n\
        add_vertex 0,0.5,-1e-3\n\
        add_face v1 v2 v8\n\
        remove_face f12\n\
        remove_vertex v4\n\
        remove_isolated_vertices\n\
        split_edge v1-v2 0,0,0\n\
        bisect_edge v1-v2 0,0,0 refused\n\
        poke_face f3 0,0,0\n\
        split_face f3 v1 v2\n\
        dissolve_edge v1-v2\n\
        flip_edge v2-v1\n\
        collapse_edge v1-v2 v2\n\
        split_vertex v3 none v4 0,0,0\n\
        compact\n\
        calls 22\n";
    let trace = Trace::read("a.trace", text.as_bytes()).expect("all calls");
    assert_eq!(trace.program, "all calls");
    let back = written(&trace);
    assert_eq!(Trace::read("b.trace", back.as_bytes()).expect(&back), trace);
    assert_eq!(trace.edits.len(), 15);
    let queries = trace
        .calls
        .iter()
        .filter(|c| c.op == Op::Query(Relation::EdgeEdges));
    let queries: Vec<_> = queries.map(|c| (c.name, c.taken)).collect();
    assert_eq!(queries, [([1, 2], 3), ([4, 5], ALL)]);
}

#[test]
fn wrong_traces_are_refused_with_their_line() {
    let head = "sixfold-trace 2\nmesh 4 4\n";
    let cases = [
        ("", 1, "cut off"),
        ("ply\n", 1, "this is not a trace"),
        ("sixfold-trace 2\nposition 0\n", 2, "must come before"),
        ("sixfold-trace 2\nmesh 0 4\n", 2, "must have vertices"),
        (
            "sixfold-trace 2\nmesh 4\n",
            2,
            "missing the number of faces",
        ),
        (
            "sixfold-trace 2\nmesh 99999999999 4\n",
            2,
            "is not the number",
        ),
        ("+mesh 4 4\n", 3, "one line `mesh`"),
        ("+position 4\ncalls 1\n", 3, "at most 4 vertices"),
        ("+face_vertices 4\ncalls 1\n", 3, "at most 4 faces"),
        ("+edge_faces 3\ncalls 1\n", 3, "two vertices"),
        ("+edge_faces 3-3\ncalls 1\n", 3, "ends of an edge differ"),
        ("+position\ncalls 1\n", 3, "names no vertex"),
        ("+position 1/x\n", 3, "is not a number of results"),
        ("+vertex_face 1\n", 3, "vertex_faces"),
        ("+item 1\n", 3, "outside a list"),
        ("+end\n", 3, "without a list"),
        ("+list corners\n", 3, "vertices, edges or faces"),
        ("+own_ns inf\n", 3, "0 or greater"),
        ("+own_ns -2004376\n", 3, "0 or greater"),
        ("+add_vertex 0,0\n", 3, "is not a position"),
        ("+add_vertex 0,0,nan\n", 3, "is not a position"),
        ("+flip_edge\n", 3, "write `flip_edge v0-v1`"),
        ("+flip_edge v1-v2 v3\n", 3, "write `flip_edge v0-v1`"),
        ("+flip_edge v1-v4\n", 3, "at most 4 vertices"),
        ("+flip_edge v1-v1\n", 3, "ends of an edge differ"),
        ("+poke_face f4\n", 3, "at most 4 faces"),
        ("+position 0\n", 3, "cut off"),
        ("+position 0\ncalls 2\n", 4, "has 1 calls"),
        ("+calls 0\n", 3, "no calls"),
        ("+calls 0\nposition 0\n", 4, "must be the last"),
    ];
    for (text, line, expected) in cases {
        let text = text.replace('+', head);
        let error = Trace::read("a.trace", text.as_bytes()).expect_err(&text);
        let message = error.to_string();
        assert!(message.contains(expected), "{text}: {message}");
        assert!(
            message.starts_with(&format!("a.trace:{line}: ")),
            "{text}: {message}"
        );
    }
    let nested = format!("{head}{}", "list vertices\n".repeat(65));
    let error = Trace::read("a.trace", nested.as_bytes()).expect_err("too deep");
    assert!(error.to_string().contains("64 lists"), "{error}");
    let long = format!("{head}position{}", " 0".repeat(1 << 19));
    let error = Trace::read("a.trace", long.as_bytes()).expect_err("too long");
    assert!(error.to_string().contains("bytes"), "{error}");
}

#[test]
fn traces_of_another_mesh_and_scans_are_refused() {
    let torus = shapes::triangle_torus(7, 5).expect("small");
    let trace = trace_of::<HalfEdgeMesh>(&torus);
    let other = shapes::triangle_torus(8, 5).expect("small");
    for (name, outcome) in outcomes(&trace, &other) {
        let reason = outcome.expect_err(name);
        assert!(reason.contains("35 vertices and 70 faces"), "{reason}");
    }
    let text = "sixfold-trace 2\nmesh 35 70\nedge_faces 0-20\ncalls 1\n";
    let trace = Trace::read("a.trace", text.as_bytes()).expect("such vertices exist");
    for (name, outcome) in outcomes(&trace, &torus) {
        let reason = outcome.expect_err(name);
        assert!(
            reason.contains("call 1 of the trace: the mesh has no edge 0-20"),
            "{reason}"
        );
    }
    let large = shapes::triangle_torus(100, 100).expect("small");
    let mut text = String::from("sixfold-trace 2\nmesh 10000 20000\n");
    for _ in 0..1100 {
        text += "vertex_faces 0 1 2 3 4 5 6 7 8 9\n";
    }
    text += "calls 11000\n";
    let trace = Trace::read("a.trace", text.as_bytes()).expect("fine");
    let refused: Vec<_> = outcomes(&trace, &large)
        .into_iter()
        .filter(|(_, outcome)| outcome.is_err())
        .map(|(name, _)| name)
        .collect();
    assert_eq!(refused, ["polygon-soup", "indexed-face-set"]);
}

#[test]
fn too_many_calls_give_no_trace() {
    let torus = shapes::triangle_torus(7, 5).expect("small");
    let mesh = Recorded::<HalfEdgeMesh>::from_polygons(&torus).expect("held");
    assert!(mesh.trace("mixed").is_none(), "no trace was started");
}
