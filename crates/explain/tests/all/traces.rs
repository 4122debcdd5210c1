//! The traces of all queries of all structures.

use std::collections::{BTreeMap, BTreeSet};

use sixfold::{HalfEdgeMesh, MeshQuery, PolygonMesh, Relation, Representation, shapes};
use sixfold_conformance::gallery;
use sixfold_core::{Described, Element, FaceId, Field, Line, Measured, RowName, Traced, VertexId};
use sixfold_explain::{ElementName, ExplainError, Read, Step, Structure, Trace};

/// Returns the names of all elements of one kind.
fn elements(polygons: &PolygonMesh, relation: Relation) -> Vec<ElementName> {
    let vertices = (0..polygons.vertex_count() as u32).map(ElementName::Vertex);
    let faces = (0..polygons.face_count() as u32).map(ElementName::Face);
    let name = relation.to_string();
    match name.split_once('_').expect("two kinds").0 {
        "vertex" => vertices.collect(),
        "face" => faces.collect(),
        _ => {
            let sides = polygons.faces().iter().flat_map(|(_, face)| {
                let next = face.iter().cycle().skip(1);
                face.iter()
                    .zip(next)
                    .map(|(&a, &b)| [a.index() as u32, b.index() as u32])
            });
            let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
            edges.sort_unstable();
            edges.dedup();
            edges.into_iter().map(ElementName::Edge).collect()
        }
    }
}

/// A structure, the element of a query, and what the query does without a trace.
struct Expected<M: Representation + Measured + Described> {
    mesh: M,
    element: Element<M>,
    /// The reads of the probe: the table and the row.
    reads: Vec<(&'static str, usize)>,
    results: Vec<String>,
}

impl<M: Representation + Measured + Described> Expected<M> {
    /// Returns `None` if the structure does not have the element.
    fn new(
        polygons: &PolygonMesh,
        mesh: &M,
        relation: Relation,
        name: ElementName,
    ) -> Option<Self> {
        let vertex = |v| M::vertex_handle(polygons, VertexId::new(v));
        let element = match name {
            ElementName::Vertex(v) => Element::Vertex(vertex(v)),
            ElementName::Edge([a, b]) => Element::Edge(mesh.edge_between(vertex(a), vertex(b))?),
            ElementName::Face(f) => Element::Face(M::face_handle(polygons, FaceId::new(f))),
        };
        if let Element::Vertex(v) = element
            && !mesh.contains_vertex(v)
        {
            return None;
        }
        let number = |v: M::Vertex| {
            let all = 0..polygons.vertex_count() as u32;
            all.into_iter()
                .find(|&n| vertex(n) == v)
                .expect("a vertex of the mesh")
        };
        let vertex_name = |v| format!("v{}", number(v));
        let edge_name = |e| {
            let mut ends = mesh.edge_vertices(e).map(number);
            ends.sort_unstable();
            format!("v{}-v{}", ends[0], ends[1])
        };
        let face_name = |f| {
            let all = 0..polygons.face_count() as u32;
            let mut all = all.into_iter();
            let found = all.find(|&n| M::face_handle(polygons, FaceId::new(n)) == f);
            format!("f{}", found.expect("a face of the mesh"))
        };
        let probe = Traced::default();
        let probed = mesh.clone().probed(probe.clone());
        probe.take();
        let results = match (relation, element) {
            (Relation::VertexVertices, Element::Vertex(v)) => {
                stepped(probed.vertex_vertices(v), vertex_name)
            }
            (Relation::VertexEdges, Element::Vertex(v)) => {
                stepped(probed.vertex_edges(v), edge_name)
            }
            (Relation::VertexFaces, Element::Vertex(v)) => {
                stepped(probed.vertex_faces(v), face_name)
            }
            (Relation::EdgeVertices, Element::Edge(e)) => {
                stepped(probed.edge_vertices(e).into_iter(), vertex_name)
            }
            (Relation::EdgeEdges, Element::Edge(e)) => stepped(probed.edge_edges(e), edge_name),
            (Relation::EdgeFaces, Element::Edge(e)) => stepped(probed.edge_faces(e), face_name),
            (Relation::FaceVertices, Element::Face(f)) => {
                stepped(probed.face_vertices(f), vertex_name)
            }
            (Relation::FaceEdges, Element::Face(f)) => stepped(probed.face_edges(f), edge_name),
            (Relation::FaceFaces, Element::Face(f)) => stepped(probed.face_faces(f), face_name),
            _ => unreachable!("the element has the kind of the relation"),
        };
        let reads = probe
            .take()
            .into_iter()
            .map(|access| (access.table, access.row));
        Some(Self {
            mesh: mesh.clone(),
            element,
            reads: reads.collect(),
            results,
        })
    }

    /// Returns the first fault of a trace.
    fn fault(&self, trace: &Trace, lines: &[Line]) -> Option<String> {
        let results: Vec<&str> = (trace.results.iter())
            .map(|result| result.rsplit(' ').next().expect("a word"))
            .collect();
        if results != self.results {
            return Some(format!("results {results:?}, expected {:?}", self.results));
        }
        let reads = trace.steps.iter().filter_map(|step| match step {
            Step::Read(read) => Some(read),
            _ => None,
        });
        let row = |read: &Read| read.row[1..].parse::<usize>().expect("a number");
        let rows: Vec<(&str, usize)> = reads
            .clone()
            .flat_map(|read| (row(read)..row(read) + read.rows).map(|row| (read.table, row)))
            .collect();
        if rows != self.reads || trace.cost.reads != rows.len() {
            return Some(format!("reads {rows:?}, expected {:?}", self.reads));
        }
        let sizes = reads.clone().flat_map(|read| {
            let rows = row(read)..row(read) + read.rows;
            rows.map(|row| ((read.table, row), read.bytes))
        });
        let bytes: usize = sizes.collect::<BTreeMap<_, _>>().values().sum();
        if bytes != trace.cost.bytes {
            return Some(format!(
                "{bytes} bytes of rows, expected {}",
                trace.cost.bytes
            ));
        }
        let tables = self.mesh.tables();
        // The names that are known, and those of them whose derived fields are not yet known.
        let (mut known, mut new) = (BTreeSet::new(), Vec::new());
        let learn = |known: &mut BTreeSet<RowName>, new: &mut Vec<RowName>, name, is_read| {
            let mut add = |name| {
                if known.insert(name) {
                    new.push(name);
                }
            };
            add(name);
            for table in tables.iter().filter(|table| table.letter == name.letter) {
                let fields = self.mesh.record(table.name, name.row as usize, true);
                let fields = table.columns.iter().zip(fields.unwrap_or_default());
                let named = fields.filter_map(|(column, field)| match field {
                    Field::Row(to) if is_read || column.is_derived => Some(to),
                    _ => None,
                });
                named.for_each(&mut add);
            }
        };
        for name in self.mesh.rows_of(self.element) {
            learn(&mut known, &mut new, name, false);
        }
        for read in reads {
            let Some(line) = read.line else {
                return Some(format!("{read:?} is on no line"));
            };
            let way = read.reason.way;
            if !lines[line].reads.contains(&(read.table, way)) {
                return Some(format!("{read:?} is on line {line}: {:?}", lines[line]));
            }
            let letter = tables
                .iter()
                .find(|table| table.name == read.table)
                .expect("a table")
                .letter;
            let name = RowName {
                letter,
                row: row(read) as u32,
            };
            if let Some(of) = &read.reason.of {
                let is_named = |name: &&RowName| {
                    let row = of.strip_prefix(name.letter);
                    row.is_some_and(|row| row.parse() == Ok(name.row))
                };
                let Some(&of) = known.iter().find(is_named) else {
                    return Some(format!("{read:?}: {of} is not known"));
                };
                if way != Line::NEXT_ROW && way != Line::ASKED && !self.is_field(of, way, name) {
                    return Some(format!("{read:?}: {of} does not name it"));
                }
            }
            for row in row(read)..row(read) + read.rows {
                let name = RowName {
                    letter,
                    row: row as u32,
                };
                learn(&mut known, &mut new, name, true);
                for name in std::mem::take(&mut new) {
                    learn(&mut known, &mut new, name, false);
                }
            }
        }
        None
    }

    /// Returns whether the field `way` of the row `of` names `name`, or, for a part of an element, the
    /// field `way` of `name` names `of`.
    fn is_field(&self, of: RowName, way: &str, name: RowName) -> bool {
        let names = |from: RowName, to: RowName| {
            let tables = self.mesh.tables();
            tables
                .iter()
                .filter(|table| table.letter == from.letter)
                .any(|table| {
                    let fields = self
                        .mesh
                        .record(table.name, from.row as usize, true)
                        .unwrap_or_default();
                    let mut fields = table.columns.iter().zip(fields);
                    fields.any(|(column, field)| column.name == way && field == Field::Row(to))
                })
        };
        names(of, name) || names(name, of)
    }
}

/// Asks for the results one after the other, as a trace does.
fn stepped<T>(mut results: impl Iterator<Item = T>, name: impl Fn(T) -> String) -> Vec<String> {
    std::iter::from_fn(|| results.next()).map(name).collect()
}

/// Checks the traces of all queries of a structure on a mesh. Returns the number of traces.
fn check<M>(polygons: &PolygonMesh, mesh_name: &str) -> usize
where
    M: Representation + Measured + Described,
    M::Probed<Traced>: Described + 'static,
{
    let Ok(mesh) = M::from_polygons(polygons) else {
        return 0;
    };
    let shown = Structure::new::<M>().build(polygons).expect("held");
    let mut traces = 0;
    for relation in Relation::ALL {
        for name in elements(polygons, relation) {
            let context = format!("{} of {mesh_name}: {relation} of {name}", M::NAME);
            let Some(expected) = Expected::new(polygons, &mesh, relation, name) else {
                let error = shown.trace(relation, name).expect_err(&context);
                assert!(
                    matches!(error, ExplainError::NoSuchElement { .. }),
                    "{error}"
                );
                continue;
            };
            let trace = shown.trace(relation, name).expect(&context);
            if let Some(fault) = expected.fault(&trace, M::algorithm(relation)) {
                panic!("{context}: {fault}");
            }
            traces += 1;
        }
    }
    traces
}

#[test]
fn every_read_has_a_reason_on_a_line_of_the_algorithm() {
    let mut traces = 0;
    let meshes = gallery()
        .into_iter()
        .filter(|mesh| mesh.polygons.face_count() < 30);
    for mesh in meshes {
        sixfold::for_each_representation!(M => {
            traces += check::<M>(&mesh.polygons, mesh.name);
        });
    }
    assert!(traces > 10_000, "{traces}");
}

/// `Structure::all` shows the editable forms of the structures.
#[test]
fn both_forms_of_a_structure_have_the_same_rows_and_traces() {
    let open = shapes::triangle_grid(3, 2).expect("a small size");
    let mixed = shapes::mixed_grid(2, 2).expect("a small size");
    for polygons in [shapes::octahedron(), open, mixed] {
        sixfold::for_each_representation!(M => {
            let editable = Structure::find(M::NAME).expect("one of six");
            let forms = [Structure::new::<M>(), editable].map(|form| form.build(&polygons));
            if let [Ok(fixed), Ok(editable)] = forms {
                assert_eq!(fixed.records(0..100), editable.records(0..100), "{}", M::NAME);
                for relation in Relation::ALL {
                    for name in elements(&polygons, relation) {
                        let [fixed, editable] = [&fixed, &editable].map(|form| form.trace(relation, name));
                        assert_eq!(fixed, editable, "{}: {relation} of {name}", M::NAME);
                    }
                }
            }
        });
    }
}

#[test]
fn traces_after_edits_are_those_of_the_edited_mesh() {
    let edits = [
        "poke_face f0",
        "flip_edge v1-v2",
        "collapse_edge v3-v4 v3",
        "remove_face f6",
        "compact",
        "poke_face f9",
    ];
    for structure in Structure::all() {
        let built = structure.build(&shapes::octahedron());
        let mut mesh = built.expect("a closed mesh of triangles");
        for edit in edits {
            mesh.apply(&edit.parse().expect(edit)).expect(edit);
            let faces: Vec<Vec<u32>> = mesh.geometry().faces.into_iter().flatten().collect();
            for (v, _) in mesh.geometry().vertices.iter().enumerate() {
                let context = format!("{} after {edit}: v{v}", structure.name());
                let sides = faces.iter().flat_map(|face| {
                    let next = face.iter().cycle().skip(1);
                    face.iter().zip(next).flat_map(|(&a, &b)| [(a, b), (b, a)])
                });
                let adjacent: BTreeSet<String> = sides
                    .filter(|&(a, _)| a as usize == v)
                    .map(|(_, b)| format!("v{b}"))
                    .collect();
                let trace = mesh.trace(Relation::VertexVertices, ElementName::Vertex(v as u32));
                let trace = match trace {
                    Ok(trace) => trace,
                    Err(ExplainError::NoSuchElement { .. }) => {
                        assert!(adjacent.is_empty(), "{context}");
                        continue;
                    }
                    Err(error) => panic!("{context}: {error}"),
                };
                assert_eq!(trace.results.len(), adjacent.len(), "{context}: {trace:?}");
                assert_eq!(BTreeSet::from_iter(trace.results), adjacent, "{context}");
                for step in trace.steps {
                    if let Step::Read(read) = step {
                        let is_known = read.line.is_some() && read.reason.way != "unknown";
                        assert!(is_known, "{context}: {read:?}");
                    }
                }
            }
        }
    }
}

/// Returns the fault that the check finds in a trace of VV on an octahedron, after `plant`.
fn fault_after(plant: impl FnOnce(&mut Trace)) -> Option<String> {
    let polygons = shapes::octahedron();
    let mesh = HalfEdgeMesh::from_polygons(&polygons).expect("a manifold");
    let (relation, name) = (Relation::VertexVertices, ElementName::Vertex(2));
    let expected = Expected::new(&polygons, &mesh, relation, name).expect("a vertex");
    let shown = Structure::new::<HalfEdgeMesh>().build(&polygons);
    let shown = shown.expect("a manifold");
    let mut trace = shown.trace(relation, name).expect("a vertex");
    plant(&mut trace);
    expected.fault(&trace, HalfEdgeMesh::algorithm(relation))
}

/// Returns the second read of a trace.
fn second(trace: &mut Trace) -> &mut Read {
    let reads = trace.steps.iter_mut().filter_map(|step| match step {
        Step::Read(read) => Some(read),
        _ => None,
    });
    reads.into_iter().nth(1).expect("two reads")
}

#[test]
fn a_planted_fault_is_found() {
    assert_eq!(fault_after(|_| ()), None);
    let found = |plant: fn(&mut Trace)| fault_after(plant).expect("a fault");
    let other_row = found(|trace| second(trace).reason.of = Some("h0".into()));
    assert!(other_row.contains("h0 is not known") || other_row.contains("does not name it"));
    let other_way = found(|trace| second(trace).reason.way = "next");
    assert!(other_way.contains("is on line"), "{other_way}");
    let no_line = found(|trace| second(trace).line = None);
    assert!(no_line.contains("is on no line"), "{no_line}");
    let other_line = found(|trace| second(trace).line = Some(0));
    assert!(other_line.contains("is on line 0"), "{other_line}");
    let no_read = found(|trace| drop(trace.steps.remove(0)));
    assert!(no_read.contains("reads"), "{no_read}");
    let other_result = found(|trace| trace.results.swap(0, 1));
    assert!(other_result.contains("results"), "{other_result}");
}

/// A query at a polygon of many corners reads them all: after many steps, those in order are one step.
#[test]
fn long_traces_have_few_steps() {
    let prism = shapes::prism(20_000).expect("a prism");
    let query = "v0".parse().expect("a name");
    let mut longest = 0;
    for structure in Structure::all() {
        let Ok(mesh) = structure.build(&prism) else {
            continue;
        };
        let trace = mesh.trace(Relation::VertexVertices, query).expect("v0");
        let rows = trace.steps.iter().map(|step| match step {
            Step::Read(read) => {
                assert_eq!(read.fields.is_empty(), read.rows > 1, "{read:?}");
                read.rows
            }
            Step::Yield { .. } => 0,
        });
        assert_eq!(
            rows.sum::<usize>(),
            trace.cost.reads,
            "{}",
            structure.name()
        );
        assert!(
            trace.steps.len() < 10_050,
            "{}: {} steps",
            structure.name(),
            trace.steps.len()
        );
        longest = longest.max(trace.steps.len());
        assert_eq!(trace.results.len(), 3);
    }
    assert!(longest > 10_000);
}
