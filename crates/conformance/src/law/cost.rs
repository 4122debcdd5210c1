//! What a structure reads and weighs, against what it declares.

use mesh_core::{Counts, MeshQuery, PolygonMesh, QueryCost, Relation, Representation, Traced};

use crate::gallery::double_cone;
use crate::oracle::Oracle;

/// `COSTS` hold, in table reads.
///
/// - Constant: a bounded number of reads for each item, however large the mesh or the neighbourhood.
/// - Local: a bounded number of reads at a bounded valence, however large the mesh.
/// - Scan: a number of reads that grows with the mesh; to declare less than a scan is wrong, and
///   to declare a scan where there is none sells the structure short.
///
/// Two tori of valence six, one nine times the other, and two double cones, whose apexes have
/// valence 24 and 240.
pub fn costs<M: Representation>() {
    let small = reads::<M>(&torus(6));
    let large = reads::<M>(&torus(18));
    let low = reads::<M>(&double_cone(24));
    let high = reads::<M>(&double_cone(240));
    for (i, relation) in Relation::ALL.into_iter().enumerate() {
        let (few, many) = (small[i].most, large[i].most);
        let grows = many > 4 * few;
        let bounded = 2 * many <= 3 * few;
        let cost = M::COSTS[i];
        assert!(
            if cost == QueryCost::Scan {
                grows
            } else {
                bounded
            },
            "{}: {relation} is declared {cost:?}; its most reads are {few} on 72 faces and {many} on 648",
            M::NAME
        );
        let (few, many) = (low[i].most_per_item, high[i].most_per_item);
        assert!(
            cost != QueryCost::Constant || many <= few + 2,
            "{}: {relation} is declared {cost:?}; its reads per item are {few} at valence 24 and {many} at 240",
            M::NAME
        );
    }
}

/// `memory()` is what `layout_bytes` says within 2 %, on uniform and on mixed degrees.
pub fn memory<M: Representation>() {
    let mixed = shapes::mixed_grid(40, 40).expect("a grid has this size");
    let mut held = 0;
    for polygons in [torus(40), double_cone(1500), mixed] {
        let Ok(mesh) = M::from_polygons(&polygons) else {
            continue;
        };
        held += 1;
        let counts = Counts {
            vertices: polygons.vertex_count(),
            edges: Oracle::of(&polygons).edges().count(),
            faces: polygons.face_count(),
            corners: polygons.corner_count(),
            uniform: polygons.faces().uniform_degree().is_some(),
        };
        let (bytes, layout) = (mesh.memory().total(), M::layout_bytes(&counts));
        assert!(
            bytes.abs_diff(layout) <= layout / 50,
            "{}: holds {bytes} bytes, and its layout says {layout}, for {counts:?}",
            M::NAME
        );
    }
    assert!(held >= 2, "{}: refuses closed triangle meshes", M::NAME);
}

fn torus(side: usize) -> PolygonMesh {
    shapes::triangle_torus(side, side).expect("a torus has this size")
}

/// What one relation reads, at worst over all elements.
#[derive(Clone, Copy, Default)]
struct Reads {
    most: usize,
    /// Reads for each item, and one item more for finding the list, rounded up.
    most_per_item: usize,
}

impl Reads {
    fn note(&mut self, items: usize, reads: usize) {
        self.most = self.most.max(reads);
        self.most_per_item = self.most_per_item.max(reads.div_ceil(items + 1));
    }
}

/// The reads of all nine relations, in the order of [`Relation::ALL`].
fn reads<M: Representation>(polygons: &PolygonMesh) -> [Reads; 9] {
    let mesh = M::from_polygons(polygons);
    let mesh = mesh.unwrap_or_else(|e| panic!("{} refuses a closed triangle mesh: {e}", M::NAME));
    let probe = Traced::default();
    let watched = mesh.clone().probed(probe.clone());
    let mut worst = [Reads::default(); 9];
    let mut note = |relation: Relation, items: usize| {
        worst[relation as usize].note(items, probe.take().len());
    };
    // A few elements stand for all: the shapes are as regular as can be. The first and the last are
    // among them, for these are the apexes.
    probe.take();
    for v in few(mesh.vertices().collect()) {
        note(Relation::VertexVertices, watched.vertex_vertices(v).count());
        note(Relation::VertexEdges, watched.vertex_edges(v).count());
        note(Relation::VertexFaces, watched.vertex_faces(v).count());
    }
    for e in few(mesh.edges().collect()) {
        note(Relation::EdgeVertices, watched.edge_vertices(e).len());
        note(Relation::EdgeEdges, watched.edge_edges(e).count());
        note(Relation::EdgeFaces, watched.edge_faces(e).count());
    }
    for f in few(mesh.faces().collect()) {
        note(Relation::FaceVertices, watched.face_vertices(f).count());
        note(Relation::FaceEdges, watched.face_edges(f).count());
        note(Relation::FaceFaces, watched.face_faces(f).count());
    }
    worst
}

/// Some forty of `handles`, the first and the last among them.
fn few<H: Copy>(handles: Vec<H>) -> Vec<H> {
    let step = handles.len().div_ceil(40).max(1);
    let last = handles.last().copied();
    handles.into_iter().step_by(step).chain(last).collect()
}
