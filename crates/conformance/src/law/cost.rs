//! Compares the reads and the memory of a structure with what it declares.

use sixfold_core::{Counts, Measured, MeshQuery, PolygonMesh, QueryCost, Relation, Traced};

use crate::gallery::double_cone;
use crate::oracle::Oracle;

/// `COSTS` are correct, measured in table reads.
///
/// - Constant: the number of reads per item is bounded, for any size of mesh and any valence.
/// - Local: the number of reads is bounded at a bounded valence, for any size of mesh.
/// - Scan: the number of reads grows with the mesh. Declaring a lower cost for a scan is wrong, and
///   declaring a scan for a cheaper query is wrong too.
///
/// The meshes are two tori of valence six, one nine times the size of the other, and two double
/// cones whose apexes have valence 24 and 240.
pub fn costs<M: Measured>() {
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
            "{}: {relation} is declared {cost:?}; its maximum reads are {few} on 72 faces and {many} on 648",
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

/// `memory()` equals `layout_bytes` within 2 %, for uniform and for mixed degrees.
pub fn memory<M: Measured>() {
    let mixed = sixfold_shapes::mixed_grid(40, 40).expect("a grid of this size can be built");
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
            "{}: memory() is {bytes} bytes, but layout_bytes is {layout}, for {counts:?}",
            M::NAME
        );
    }
    assert!(held >= 2, "{}: refuses a closed triangle mesh", M::NAME);
}

fn torus(side: usize) -> PolygonMesh {
    sixfold_shapes::triangle_torus(side, side).expect("a torus of this size can be built")
}

/// Maximum numbers of reads of one relation, over the elements tested.
#[derive(Clone, Copy, Default)]
struct Reads {
    most: usize,
    /// Reads per item, rounded up; finding the list counts as one more item.
    most_per_item: usize,
}

impl Reads {
    fn note(&mut self, items: usize, reads: usize) {
        self.most = self.most.max(reads);
        self.most_per_item = self.most_per_item.max(reads.div_ceil(items + 1));
    }
}

/// Counts the reads of all nine relations, in the order of [`Relation::ALL`].
fn reads<M: Measured>(polygons: &PolygonMesh) -> [Reads; 9] {
    let mesh = M::from_polygons(polygons);
    let mesh = mesh.unwrap_or_else(|e| panic!("{} refuses a closed triangle mesh: {e}", M::NAME));
    let probe = Traced::default();
    let watched = mesh.clone().probed(probe.clone());
    let mut worst = [Reads::default(); 9];
    let mut note = |relation: Relation, items: usize| {
        worst[relation as usize].note(items, probe.take().len());
    };
    // A few elements are enough, because the shapes are regular. The first and the last are among
    // them, because these are the apexes.
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

/// Returns about forty of `handles`, including the first and the last.
fn few<H: Copy>(handles: Vec<H>) -> Vec<H> {
    let step = handles.len().div_ceil(40).max(1);
    let last = handles.last().copied();
    handles.into_iter().step_by(step).chain(last).collect()
}
