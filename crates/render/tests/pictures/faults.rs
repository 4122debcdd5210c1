//! Tests that faults and labels are drawn.

use sixfold_core::{Creases, FaceId, VertexId};
use sixfold_render::{Faults, MAX_LABELS, Picture, RenderMesh, Settings, draw, draw_svg};

use crate::{cube, draw_mesh, settings, svg};

/// Returns the number of pixels of a colour: of pixels for which `is_colour` accepts red, green and
/// blue.
fn pixels(picture: &Picture, is_colour: fn([i32; 3]) -> bool) -> usize {
    let pixels = picture.bytes().chunks_exact(3);
    let colours = pixels.map(|pixel| [pixel[0], pixel[1], pixel[2]].map(i32::from));
    colours.filter(|&colour| is_colour(colour)).count()
}

#[test]
fn faults_are_painted() {
    let (mesh, creases) = (cube(1.0), Creases::default());
    let orange = |[r, g, b]: [i32; 3]| r > 230 && (110..190).contains(&g) && b < 90;
    let magenta = |[r, g, b]: [i32; 3]| r > 150 && b > 150 && g < 90;
    let yellow = |[r, g, b]: [i32; 3]| r > b + 90 && g > b + 80;
    let v = VertexId::new;
    let marked = Faults {
        boundary_edges: vec![[v(6), v(7)]],
        non_manifold_edges: vec![[v(3), v(7)]],
        non_manifold_vertices: vec![v(4)],
        turned_faces: vec![FaceId::new(1)],
    };
    let draw_faults = |faults| {
        let render_mesh = RenderMesh {
            mesh: &mesh,
            creases: &creases,
            faults,
        };
        draw(&[render_mesh], &settings()).unwrap_or_else(|error| panic!("{error}"))
    };
    let counts = |faults| {
        let picture = draw_faults(faults);
        [
            pixels(&picture, orange),
            pixels(&picture, magenta),
            pixels(&picture, yellow),
        ]
    };
    assert_eq!(counts(None), [0; 3]);
    let none = Faults::default();
    assert_eq!(draw_faults(Some(&none)), draw_faults(None));
    let [boundary, non_manifold, turned] = counts(Some(&marked));
    assert!(
        boundary > 30 && non_manifold > 30 && turned > 300,
        "{:?}",
        counts(Some(&marked))
    );
    // Hidden elements, and elements of another mesh, are not drawn.
    let hidden = Faults {
        boundary_edges: vec![[v(0), v(1)], [v(0), v(99)]],
        non_manifold_vertices: vec![v(0), v(99)],
        turned_faces: vec![FaceId::new(0), FaceId::new(99)],
        ..Faults::default()
    };
    assert_eq!(counts(Some(&hidden)), [0; 3]);
    let render_mesh = RenderMesh {
        mesh: &mesh,
        creases: &creases,
        faults: Some(&marked),
    };
    let svg = draw_svg(&[render_mesh], &settings()).expect("drawn");
    for colour in ["#f999", "#da00"] {
        assert!(svg.contains(colour), "{colour}: {svg}");
    }
}

#[test]
fn labels_name_the_visible_elements() {
    let (mesh, creases) = (cube(1.0), Creases::default());
    let labelled = Settings {
        labels: true,
        ..settings()
    };
    let text = svg(&mesh, &creases, &labelled);
    let names: Vec<&str> = text
        .split("</text>")
        .filter_map(|part| part.rsplit_once('>').map(|(_, name)| name))
        .filter(|name| name.starts_with(['v', 'e', 'f']))
        .collect();
    let count = |kind: char| names.iter().filter(|name| name.starts_with(kind)).count();
    // The view hides one corner of the cube.
    assert_eq!([count('v'), count('e'), count('f')], [7, 9, 3], "{names:?}");
    assert!(!names.contains(&"v0") && names.contains(&"v7"));
    assert!(!svg(&mesh, &creases, &settings()).contains("<text"));

    let plain = draw_mesh(&mesh, &creases, &settings());
    let picture = draw_mesh(&mesh, &creases, &labelled);
    let black = |colour: [i32; 3]| colour == [0; 3];
    assert_eq!(pixels(&plain, black), 0);
    // A v has 8 pixels, and a digit at least 7.
    let dark = pixels(&picture, black);
    assert!((60..200).contains(&dark), "{dark}");
    let wireframe = Settings {
        wireframe: true,
        ..labelled
    };
    assert!(svg(&mesh, &creases, &wireframe).contains(">v0<"));
}

#[test]
fn large_meshes_have_no_labels() {
    let mesh = sixfold_shapes::geodesic(10).expect("valid");
    let creases = Creases::default();
    let settings = Settings {
        labels: true,
        ..settings()
    };
    let render_mesh = RenderMesh {
        mesh: &mesh,
        creases: &creases,
        faults: None,
    };
    let error = draw(&[render_mesh], &settings).expect_err("too many");
    let labels = 1002 + 3000 + 2000;
    let message = format!(
        "mesh 1 of the row: {labels} labels are more than {MAX_LABELS}: draw a smaller mesh, or no \
         labels"
    );
    assert_eq!(error.to_string(), message);
    assert_eq!(draw_svg(&[render_mesh], &settings), Err(error));
}
