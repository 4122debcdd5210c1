//! One mesh in every order, with the same sampled elements in each order.

use sixfold::PolygonMesh;
use sixfold::shapes::{Order, Reordered};

use sixfold_workload::{Draw, Side};

/// The mesh in every order. Each mesh has the handles of the same drawn elements.
pub(super) struct OrderedMeshes(Vec<(Order, PolygonMesh, Option<Draw>)>);

impl OrderedMeshes {
    pub(super) fn new(polygons: &PolygonMesh, seed: u64, needs_draw: bool) -> Self {
        // The seed differs from the seed of the shuffle, so that the draw has another order.
        let draw = needs_draw.then(|| Draw::new(polygons, !seed));
        let meshes = Order::ALL.map(|order| {
            let reordered = order.apply_with_handles(polygons, seed);
            let draw = draw.as_ref().map(|draw| with_new_handles(draw, &reordered));
            (order, reordered.mesh, draw)
        });
        Self(meshes.into())
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (Order, &PolygonMesh, Option<&Draw>)> {
        self.0
            .iter()
            .map(|(order, mesh, draw)| (*order, mesh, draw.as_ref()))
    }
}

/// Converts the handles of a draw to the handles after reordering.
fn with_new_handles(draw: &Draw, to: &Reordered) -> Draw {
    let side = |side: &Side| {
        let mut ends = side.ends.map(|v| to.vertices[v.index()]);
        ends.sort_unstable();
        Side {
            face: to.faces[side.face.index()],
            ends,
        }
    };
    Draw {
        vertices: draw
            .vertices
            .iter()
            .map(|v| to.vertices[v.index()])
            .collect(),
        edges: draw.edges.iter().map(side).collect(),
        faces: draw.faces.iter().map(|f| to.faces[f.index()]).collect(),
    }
}
