//! Tests that invalid settings and meshes are refused.

use sixfold_core::{Creases, Point, PolygonMesh, VertexId};
use sixfold_render::{
    MAX_PIXELS, MAX_SIDE, MeshFault, RenderError, RenderMesh, Settings, Size, Up, View, draw,
    draw_svg,
};

use crate::{cube, settings};

#[test]
fn invalid_sizes_views_and_meshes_are_refused() {
    let (mesh, creases) = (cube(1.0), Creases::default());
    let render_mesh = RenderMesh {
        mesh: &mesh,
        creases: &creases,
        faults: None,
    };
    let of_size = |width, height, panels| {
        let size = Size { width, height };
        let wanted = Settings { size, ..settings() };
        draw(&vec![render_mesh; panels], &wanted).expect_err("refused")
    };
    for (width, height) in [
        (MAX_SIDE + 1, 16),
        (16, u32::MAX),
        (4096, 4096),
        (u32::MAX, u32::MAX),
    ] {
        let error = of_size(width, height, 1);
        assert_eq!(error, RenderError::TooLarge { width, height });
        assert!(error.to_string().contains(&MAX_PIXELS.to_string()));
    }
    for (width, height, panels) in [(0, 0, 1), (15, 100, 1), (100, 15, 1), (100, 100, 7)] {
        let error = of_size(width, height, panels);
        assert_eq!(
            error,
            RenderError::TooSmall {
                width,
                height,
                panels
            }
        );
    }
    assert_eq!(draw(&[], &settings()), Err(RenderError::NoMesh));
    for (azimuth, elevation) in [
        (f64::NAN, 0.0),
        (0.0, 90.5),
        (f64::INFINITY, 0.0),
        (0.0, f64::NAN),
    ] {
        let error = View::new(azimuth, elevation, Up::Y).expect_err("no view");
        assert!(matches!(error, RenderError::View { .. }));
    }
    let fault = |positions: [Point; 3], faces: Vec<[u32; 3]>| {
        let mesh = PolygonMesh::new(positions, faces).expect("valid");
        let creases = Creases::default();
        let render_meshes = [
            render_mesh,
            RenderMesh {
                mesh: &mesh,
                creases: &creases,
                faults: None,
            },
        ];
        let error = draw(&render_meshes, &settings()).expect_err("refused");
        assert_eq!(draw_svg(&render_meshes, &settings()), Err(error.clone()));
        match error {
            RenderError::Mesh { mesh: 1, fault } => fault,
            other => panic!("{other}"),
        }
    };
    let triangle = [Point::ZERO, Point::X, Point::Y];
    assert_eq!(fault(triangle, vec![]), MeshFault::NoFaces);
    assert_eq!(fault([Point::ONE; 3], vec![[0, 1, 2]]), MeshFault::NoExtent);
    let infinite = [Point::ZERO, Point::X, Point::new(0.0, f32::INFINITY, 0.0)];
    let vertex = VertexId::new(2);
    assert_eq!(
        fault(infinite, vec![[0, 1, 2]]),
        MeshFault::NotFinite { vertex }
    );
}

#[test]
fn an_svg_with_too_many_faces_is_refused() {
    let (mesh, creases) = (
        sixfold_shapes::grid(300, 300).expect("valid"),
        Creases::default(),
    );
    let view = View::new(0.0, 0.0, Up::Y).expect("a view");
    let size = Size {
        width: 640,
        height: 640,
    };
    let settings = Settings {
        size,
        view,
        ..settings()
    };
    let render_mesh = RenderMesh {
        mesh: &mesh,
        creases: &creases,
        faults: None,
    };
    let error = draw_svg(&[render_mesh], &settings).expect_err("too many");
    let message = "mesh 1 of the row: 90000 faces are visible, but an SVG can have at most 50000: \
                   write a PNG";
    assert_eq!(error.to_string(), message);
}
