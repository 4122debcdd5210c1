use std::collections::HashSet;

use sixfold::shapes::{self, Order};
use sixfold::{
    CornerTable, FaceVertexMesh, HalfEdgeMesh, Handle, IndexedFaceSet, MeshQuery, Point,
    PolygonMesh, Relation, Representation, for_each_representation,
};
use sixfold_core::{Measured, Traced};

use super::*;
use sixfold_measure::LINE_BYTES;

#[derive(Default)]
struct Collected(Vec<Reads>);

impl ReadsObserver for Collected {
    fn relation_started(&mut self, _: Relation) {}

    fn relation_counted(&mut self, reads: Reads) {
        self.0.push(reads);
    }
}

fn reads_of<M: Measured>(polygons: &PolygonMesh, relation: Relation) -> Reads {
    let mesh = M::from_polygons(polygons).expect("the structure holds it");
    let mut collected = Collected::default();
    count(mesh, &[relation], &AtomicBool::new(false), &mut collected);
    let reads = collected.0.pop().expect("not stopped");
    assert!(collected.0.is_empty());
    reads
}

fn polygons(vertices: usize, faces: &[&[u32]]) -> PolygonMesh {
    let at = (0..vertices).map(|i| Point::new(i as f32, (i * i) as f32, 0.0));
    PolygonMesh::new(at.collect::<Vec<_>>(), faces).expect("valid")
}

fn tables(reads: &Reads) -> Vec<(&str, usize, f64)> {
    let tables = reads.tables.iter();
    tables
        .map(|t| (t.table.as_str(), t.row_bytes, t.reads))
        .collect()
}

#[test]
fn corners_of_a_triangle_are_twelve_bytes_in_one_or_two_lines() {
    // Face f has the corner bytes 12 f to 12 f + 11. Faces 5 and 10 cross the end of a line.
    let strip: Vec<[u32; 3]> = (0..16).map(|f| [f, f + 1, f + 2]).collect();
    let strip: Vec<&[u32]> = strip.iter().map(|face| &face[..]).collect();
    let reads = reads_of::<IndexedFaceSet>(&polygons(18, &strip), Relation::FaceVertices);
    assert_eq!(
        (reads.elements, reads.queried, reads.sampled),
        (16, 16, false)
    );
    assert_eq!((reads.answers, reads.reads, reads.bytes), (3.0, 3.0, 12.0));
    assert_eq!(reads.lines, 18.0 / 16.0);
    assert_eq!(
        (reads.sweep_lines, reads.sweep_bytes(LINE_BYTES)),
        (3, 192),
        "16 × 12"
    );
    assert_eq!(reads.moved_bytes, 12.0);
    assert_eq!(reads.fetched, 3.0 / 16.0, "each line once");
    assert_eq!(reads.jumps, 1.0 / 16.0, "the first line of the stream");
    assert_eq!(tables(&reads), [("corners", 4, 3.0)]);
}

#[test]
fn both_ends_of_an_edge_are_in_its_two_halves() {
    // Edge e has the bytes 24 e to 24 e + 23. Edge 2 crosses the end of a line.
    let square = polygons(4, &[&[0, 1, 2], &[0, 2, 3]]);
    let reads = reads_of::<HalfEdgeMesh>(&square, Relation::EdgeVertices);
    assert_eq!((reads.elements, reads.answers), (5, 2.0));
    assert_eq!((reads.reads, reads.bytes), (2.0, 24.0));
    assert_eq!((reads.lines, reads.sweep_lines), (6.0 / 5.0, 2));
    assert_eq!(reads.moved_bytes, 128.0 / 5.0);
    assert_eq!(reads.listing_reads, 0.0);
    assert_eq!(tables(&reads), [("halves", 12, 2.0)]);
}

#[test]
fn mixed_degrees_read_the_offsets_of_a_face() {
    let mixed = polygons(5, &[&[0, 1, 2], &[0, 2, 3, 4]]);
    let reads = reads_of::<IndexedFaceSet>(&mixed, Relation::FaceVertices);
    assert_eq!((reads.answers, reads.reads), (3.5, 2.0 + 3.5));
    assert_eq!(
        (reads.lines, reads.bytes),
        (2.0, 22.0),
        "a line of each table"
    );
    let mut tables = tables(&reads);
    tables.sort_by(|a, b| a.0.cmp(b.0));
    assert_eq!(tables, [("corners", 4, 3.5), ("offsets", 4, 2.0)]);
}

#[test]
fn a_boundary_walk_reads_one_half_more_than_faces_and_an_isolated_vertex_reads_no_half() {
    // A corner of the triangle reads `leaving` and the twins of two spokes. The isolated vertex
    // reads only `leaving`.
    let triangle = polygons(4, &[&[0, 1, 2]]);
    let reads = reads_of::<HalfEdgeMesh>(&triangle, Relation::VertexFaces);
    assert_eq!((reads.elements, reads.answers), (4, 3.0 / 4.0));
    assert_eq!(reads.reads, (3.0 * 3.0 + 1.0) / 4.0);
    assert_eq!(
        tables(&reads),
        [("leaving", 4, 1.0), ("halves", 12, 6.0 / 4.0)]
    );
    assert_eq!(reads.bytes, 4.0 + 12.0 * 6.0 / 4.0);
}

#[test]
fn listing_edges_by_a_table_counts_as_listing_reads() {
    let tetrahedron = polygons(4, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]);
    let reads = reads_of::<CornerTable>(&tetrahedron, Relation::EdgeVertices);
    assert_eq!(
        reads.listing_reads,
        12.0 / 6.0,
        "all corners, for six edges"
    );
    let queries: f64 = reads.tables.iter().map(|table| table.reads).sum();
    assert_eq!(queries, reads.reads, "listing reads are not query reads");
}

#[test]
fn a_scan_is_sampled_and_reads_every_corner() {
    let grid = shapes::triangle_grid(9, 9).expect("a grid");
    let corners = grid.corner_count();
    let reads = reads_of::<IndexedFaceSet>(&grid, Relation::VertexFaces);
    assert!(reads.sampled && reads.queried == SCAN_SAMPLE as u64);
    assert_eq!(reads.reads, corners as f64);
    assert_eq!(reads.lines, (4 * corners).div_ceil(LINE_BYTES) as f64);
    assert_eq!(
        reads.moved_bytes,
        reads.lines * 64.0,
        "all of them, each time"
    );
    let few = polygons(4, &[&[0, 1, 2], &[0, 2, 3]]);
    let reads = reads_of::<IndexedFaceSet>(&few, Relation::VertexFaces);
    assert!(!reads.sampled, "no more elements than the sample size");
    assert_eq!((reads.answers, reads.reads), (6.0 / 4.0, 6.0));
}

#[test]
fn a_sample_is_evenly_spaced() {
    let sweep = |elements, queried| Sweep {
        relation: Relation::VertexFaces,
        elements,
        queried,
    };
    let indices = |sweep: Sweep| {
        (0..sweep.queried)
            .map(|i| sweep.nth_index(i))
            .collect::<Vec<_>>()
    };
    assert_eq!(indices(sweep(10, 4)), [0, 2, 5, 7]);
    assert_eq!(indices(sweep(3, 3)), [0, 1, 2]);
    let last = sweep(u32::MAX as usize, SCAN_SAMPLE).nth_index(SCAN_SAMPLE - 1);
    assert!(last < u32::MAX as usize && last > u32::MAX as usize / 16 * 14);
}

#[test]
fn walks_around_very_many_faces_are_sampled_too() {
    let rim = 2000_u32;
    let fan: Vec<[u32; 3]> = (0..rim).map(|i| [rim, i, (i + 1) % rim]).collect();
    let fan: Vec<&[u32]> = fan.iter().map(|face| &face[..]).collect();
    let fan = polygons(rim as usize + 1, &fan);
    for relation in [Relation::EdgeEdges, Relation::VertexVertices] {
        let reads = reads_of::<FaceVertexMesh>(&fan, relation);
        let walks = relation == Relation::EdgeEdges;
        assert_eq!(reads.sampled, walks, "{relation}");
        assert_eq!(reads.queried, if walks { 16 } else { 2001 }, "{relation}");
    }
}

#[test]
fn the_order_of_a_mesh_changes_jumps_but_not_reads() {
    let given = shapes::triangle_grid(200, 200).expect("a grid");
    let shuffled = Order::Shuffled.apply(&given, 3);
    let [given, shuffled] =
        [&given, &shuffled].map(|mesh| reads_of::<FaceVertexMesh>(mesh, Relation::VertexVertices));
    assert_eq!(given.reads, shuffled.reads);
    assert_eq!(given.sweep_lines, shuffled.sweep_lines);
    assert!(given.lines < shuffled.lines, "faces are far apart");
    assert!(
        100.0 * given.jumps < shuffled.jumps,
        "{given:?} {shuffled:?}"
    );
}

#[test]
fn a_stopped_count_returns_nothing() {
    let mesh = HalfEdgeMesh::from_polygons(&polygons(3, &[&[0, 1, 2]])).expect("held");
    let mut collected = Collected::default();
    count(mesh, &Relation::ALL, &AtomicBool::new(true), &mut collected);
    assert_eq!(collected.0, []);
}

/// Computes reads, bytes and lines per query from a log of all accesses.
struct AccessLog<'a>(&'a PolygonMesh);

impl AccessLog<'_> {
    fn query_all<H: Handle, I: IntoIterator>(
        probe: &Traced,
        handles: Vec<H>,
        query: impl Fn(H) -> I,
    ) -> [f64; 3] {
        let mut sums = [0, 0, 0];
        let queried = handles.len() as f64;
        for handle in handles {
            probe.take();
            count_results(query(handle));
            let log = probe.take();
            let mut bytes = HashSet::new();
            for access in &log {
                let start = access.row * access.bytes;
                bytes.extend((start..start + access.bytes).map(|byte| (access.table, byte)));
            }
            let lines: HashSet<_> = bytes.iter().map(|&(t, byte)| (t, byte / 64)).collect();
            sums[0] += log.len();
            sums[1] += bytes.len();
            sums[2] += lines.len();
        }
        sums.map(|sum| sum as f64 / queried)
    }
}

impl AccessLog<'_> {
    fn all(&self) -> Vec<bool> {
        let mut agree = Vec::new();
        for_each_representation!(M => { agree.push(self.visit::<M>()); });
        agree
    }

    /// Returns whether the structure holds the mesh. If it does, checks all nine relations.
    fn visit<M: Measured>(&self) -> bool {
        let Ok(mesh) = M::from_polygons(self.0) else {
            return false;
        };
        let probe = Traced::default();
        let probed = mesh.clone().probed(probe.clone());
        let mut collected = Collected::default();
        let (vertices, edges, faces): (Vec<_>, Vec<_>, Vec<_>) = (
            mesh.vertices().collect(),
            mesh.edges().collect(),
            mesh.faces().collect(),
        );
        count(
            mesh,
            &Relation::ALL,
            &AtomicBool::new(false),
            &mut collected,
        );
        let (v, e, f) = (|| vertices.clone(), || edges.clone(), || faces.clone());
        let mesh = &probed;
        let expected = [
            Self::query_all(&probe, v(), |v| mesh.vertex_vertices(v)),
            Self::query_all(&probe, v(), |v| mesh.vertex_edges(v)),
            Self::query_all(&probe, v(), |v| mesh.vertex_faces(v)),
            Self::query_all(&probe, e(), |e| mesh.edge_vertices(e)),
            Self::query_all(&probe, e(), |e| mesh.edge_edges(e)),
            Self::query_all(&probe, e(), |e| mesh.edge_faces(e)),
            Self::query_all(&probe, f(), |f| mesh.face_vertices(f)),
            Self::query_all(&probe, f(), |f| mesh.face_edges(f)),
            Self::query_all(&probe, f(), |f| mesh.face_faces(f)),
        ];
        for (reads, expected) in collected.0.iter().zip(expected) {
            let found = [reads.reads, reads.bytes, reads.lines];
            assert!(!reads.sampled);
            assert_eq!(found, expected, "{} on {}", reads.relation, M::NAME);
            let named: f64 = reads.tables.iter().map(|table| table.reads).sum();
            let close = (named - reads.reads).abs() < 1e-9;
            assert!(close, "{}: a table is missing in memory()", M::NAME);
        }
        assert_eq!(collected.0.len(), 9);
        true
    }
}

#[test]
fn counts_of_all_six_structures_equal_their_logs() {
    // These meshes are so small that no structure is sampled.
    let open = polygons(6, &[&[0, 1, 2], &[0, 2, 3], &[3, 2, 4], &[4, 2, 5]]);
    let mixed = polygons(7, &[&[0, 1, 2], &[0, 2, 3, 4], &[4, 3, 5], &[0, 4, 6, 1]]);
    let isolated = polygons(8, &[&[0, 1, 2], &[2, 1, 3], &[2, 3, 4, 5, 6]]);
    assert_eq!(AccessLog(&open).all(), [true; 6]);
    // Some structures refuse polygons or isolated vertices.
    let held = |mesh: &PolygonMesh| AccessLog(mesh).all().into_iter().filter(|&h| h).count();
    assert_eq!((held(&mixed), held(&isolated)), (5, 4));
}
