//! Laws about the reads and the memory of a structure.

use std::hint::black_box;

use sixfold_core::{
    Counts, Measured, MeshQuery, OrientedWalk, PolygonMesh, QueryCost, Relation, Traced,
};

use crate::gallery::double_cone;
use crate::oracle::Oracle;

/// The declared costs `COSTS` agree with the measured reads of tables. `cost` and `is_local` agree
/// with `COSTS`.
///
/// - Constant: the number of reads per item is bounded, for any size of mesh and any valence.
/// - Local: if the valence is bounded, the number of reads is bounded for any size of mesh.
/// - Scan: the number of reads grows with the mesh. The law fails if a cheaper query is declared as
///   a scan.
///
/// The meshes are two tori of valence six and two double cones. The large torus has nine times as
/// many faces as the small torus. The two apexes of a double cone have valence 24 in the first
/// double cone and valence 240 in the second.
pub fn costs<M: Measured>() {
    let scans = M::COSTS.contains(&QueryCost::Scan);
    assert_eq!(M::is_local(), !scans, "{}: is_local", M::NAME);
    let small = reads::<M>(&torus(6));
    let large = reads::<M>(&torus(18));
    let low = reads::<M>(&double_cone(24));
    let high = reads::<M>(&double_cone(240));
    for (i, relation) in Relation::ALL.into_iter().enumerate() {
        let (few, many) = (small[i].max, large[i].max);
        let grows = many > 4 * few;
        let bounded = 2 * many <= 3 * few;
        let cost = M::COSTS[i];
        assert_eq!(M::cost(relation), cost, "{}: cost of {relation}", M::NAME);
        assert!(
            if cost == QueryCost::Scan {
                grows
            } else {
                bounded
            },
            "{}: {relation} is declared {cost:?}; its maximum reads are {few} on 72 faces and {many} on 648",
            M::NAME
        );
        let (few, many) = (low[i].max_per_item, high[i].max_per_item);
        assert!(
            cost != QueryCost::Constant || many <= few + 2,
            "{}: {relation} is declared {cost:?}; its reads per item are {few} at valence 24 and {many} at 240",
            M::NAME
        );
    }
}

/// The methods of [`OrientedWalk`]. The first six methods need only the face of the side.
const WALK_METHODS: [&str; 11] = [
    "next_side",
    "prev_side",
    "side_origin",
    "side_target",
    "side_face",
    "side_edge",
    "twin_side",
    "cw_side",
    "ccw_side",
    "edge_sides",
    "outgoing_sides",
];

/// The number of [`WALK_METHODS`] that need only the face of the side.
const WITHIN_A_FACE: usize = 6;

/// No step of a walk scans the mesh. The cost of a step within a face does not depend on the
/// valence of the corners of the face. The law counts reads of tables on the meshes of [`costs`].
pub fn oriented_walk_costs<M>()
where
    M: Measured + OrientedWalk,
    M::Probed<Traced>: OrientedWalk<Side = M::Side>,
{
    let [small, large] = [6, 18].map(|side| walk_reads::<M>(&torus(side)));
    let [low, high] = [24, 240].map(|valence| walk_reads::<M>(&double_cone(valence)));
    for (i, method) in WALK_METHODS.into_iter().enumerate() {
        let (few, many) = (small[i], large[i]);
        assert!(
            2 * many <= 3 * few,
            "{}: {method} scans; its maximum reads are {few} on 72 faces and {many} on 648",
            M::NAME
        );
        let (few, many) = (low[i], high[i]);
        assert!(
            i >= WITHIN_A_FACE || many <= few,
            "{}: {method} depends on the valence; its maximum reads are {few} at valence 24 and {many} at 240",
            M::NAME
        );
    }
}

/// Returns the maximum number of reads of each of [`WALK_METHODS`].
fn walk_reads<M>(polygons: &PolygonMesh) -> [usize; WALK_METHODS.len()]
where
    M: Measured + OrientedWalk,
    M::Probed<Traced>: OrientedWalk<Side = M::Side>,
{
    let mesh = M::from_polygons(polygons);
    let mesh = mesh.unwrap_or_else(|e| panic!("{} refuses a closed triangle mesh: {e}", M::NAME));
    let probe = Traced::default();
    let probed = mesh.clone().probed(probe.clone());
    let mut maxima = [0; WALK_METHODS.len()];
    let mut record = |method: usize| maxima[method] = probe.take().len().max(maxima[method]);
    let steps: [&dyn Fn(M::Side); 9] = [
        &|s| _ = black_box(probed.next_side(s)),
        &|s| _ = black_box(probed.prev_side(s)),
        &|s| _ = black_box(probed.side_origin(s)),
        &|s| _ = black_box(probed.side_target(s)),
        &|s| _ = black_box(probed.side_face(s)),
        &|s| _ = black_box(probed.side_edge(s)),
        &|s| _ = black_box(probed.twin_side(s)),
        &|s| _ = black_box(probed.cw_side(s)),
        &|s| _ = black_box(probed.ccw_side(s)),
    ];
    probe.take();
    for s in sample(mesh.sides().collect()) {
        for (method, step) in steps.iter().enumerate() {
            step(s);
            record(method);
        }
    }
    for e in sample(mesh.edges().collect()) {
        assert_eq!(probed.edge_sides(e).count(), 2, "{}: edge_sides", M::NAME);
        record(steps.len());
    }
    for v in sample(mesh.vertices().collect()) {
        black_box(probed.outgoing_sides(v).count());
        record(steps.len() + 1);
    }
    maxima
}

/// `memory()` equals `layout_bytes` within 2 %, on triangle meshes and on meshes with faces of
/// different degrees.
pub fn memory<M: Measured>() {
    let mixed = sixfold_shapes::mixed_grid(40, 40).expect("a grid of this size can be built");
    let mut measured = 0;
    for polygons in [torus(40), double_cone(1500), mixed] {
        let Ok(mesh) = M::from_polygons(&polygons) else {
            continue;
        };
        measured += 1;
        let counts = Counts {
            vertices: polygons.vertex_count(),
            edges: Oracle::new(&polygons).edges().count(),
            faces: polygons.face_count(),
            corners: polygons.corner_count(),
            uniform: polygons.faces().uniform_degree().is_some(),
        };
        let (bytes, layout) = (mesh.memory().total(), M::layout_bytes(&counts));
        assert!(
            bytes.abs_diff(layout) <= layout / 50,
            "{}: memory() is {bytes} bytes, but layout_bytes is {layout}, for {counts:?}",
            M::NAME
        );
    }
    assert!(measured >= 2, "{}: refuses a closed triangle mesh", M::NAME);
}

fn torus(side: usize) -> PolygonMesh {
    sixfold_shapes::triangle_torus(side, side).expect("a torus of this size can be built")
}

/// Maximum numbers of reads of one relation.
#[derive(Clone, Copy, Default)]
struct Reads {
    max: usize,
    max_per_item: usize,
}

impl Reads {
    fn record(&mut self, items: usize, reads: usize) {
        self.max = self.max.max(reads);
        self.max_per_item = self.max_per_item.max(reads.div_ceil(items + 1));
    }
}

/// Counts the reads of each relation, in the order of [`Relation::ALL`].
fn reads<M: Measured>(polygons: &PolygonMesh) -> [Reads; 9] {
    let mesh = M::from_polygons(polygons);
    let mesh = mesh.unwrap_or_else(|e| panic!("{} refuses a closed triangle mesh: {e}", M::NAME));
    let probe = Traced::default();
    let probed = mesh.clone().probed(probe.clone());
    let mut maxima = [Reads::default(); 9];
    let mut record = |relation: Relation, items: usize| {
        maxima[relation as usize].record(items, probe.take().len());
    };
    // The sample includes the first and the last vertex, because these are the apexes.
    probe.take();
    for v in sample(mesh.vertices().collect()) {
        record(Relation::VertexVertices, probed.vertex_vertices(v).count());
        record(Relation::VertexEdges, probed.vertex_edges(v).count());
        record(Relation::VertexFaces, probed.vertex_faces(v).count());
    }
    for e in sample(mesh.edges().collect()) {
        record(Relation::EdgeVertices, probed.edge_vertices(e).len());
        record(Relation::EdgeEdges, probed.edge_edges(e).count());
        record(Relation::EdgeFaces, probed.edge_faces(e).count());
    }
    for f in sample(mesh.faces().collect()) {
        record(Relation::FaceVertices, probed.face_vertices(f).count());
        record(Relation::FaceEdges, probed.face_edges(f).count());
        record(Relation::FaceFaces, probed.face_faces(f).count());
    }
    maxima
}

/// Returns about forty of `handles`, including the first handle and the last handle.
fn sample<H: Copy>(handles: Vec<H>) -> Vec<H> {
    let step = handles.len().div_ceil(40).max(1);
    let last = handles.last().copied();
    handles.into_iter().step_by(step).chain(last).collect()
}
