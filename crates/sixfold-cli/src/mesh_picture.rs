//! The picture of a measured mesh, which documents keep for reports.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sixfold::Creases;
use sixfold_render::{RenderMesh, Settings, Shading, Size, Up, View, draw};
use sixfold_study::StudyMesh;

use crate::render::faults;

/// Small, because a document can have hundreds of meshes.
const SIZE: Size = Size {
    width: 288,
    height: 288,
};

/// Adds a picture to `study_mesh`: the mesh from above, from the front and from the right, with its
/// faults. Adds nothing if the mesh cannot be drawn, for example because it has no area.
pub(crate) fn with_picture(study_mesh: StudyMesh) -> StudyMesh {
    let picture = png(&study_mesh);
    StudyMesh {
        picture: picture.map(|bytes| STANDARD.encode(bytes)),
        ..study_mesh
    }
}

fn png(study_mesh: &StudyMesh) -> Option<Vec<u8>> {
    let mesh = &study_mesh.polygons;
    let [azimuth, elevation] = View::ISO;
    let settings = Settings {
        size: SIZE,
        view: View::new(azimuth, elevation, Up::Y).ok()?,
        shading: Shading::Smooth,
        edges: false,
        wireframe: false,
        labels: false,
    };
    let facts = &study_mesh.facts;
    let has_faults = facts.boundary_edges > 0
        || facts.non_manifold_edges + facts.non_manifold_vertices > 0
        || facts.inconsistent_edges > 0;
    // The search takes longer than the drawing.
    let faults = has_faults.then(|| faults(mesh));
    let render_mesh = RenderMesh {
        mesh,
        creases: &Creases::default(),
        faults: faults.as_ref(),
    };
    let picture = draw(&[render_mesh], &settings).ok()?;
    let mut bytes = Vec::new();
    picture.write_png(&mut bytes).ok()?;
    Some(bytes)
}
