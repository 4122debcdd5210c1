//! Tests the content of pictures, and that the same input gives the same picture.

mod faults;
mod refusals;

use sixfold_core::{Creases, Point, PolygonMesh, RowId};
use sixfold_render::{Picture, RenderMesh, Settings, Shading, Size, Up, View, draw, draw_svg};

/// The faces of a cube from −1 to 1; bits 1, 2 and 4 of a vertex number are its x, y and z.
const CUBE: [[u32; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

fn cube(half: f32) -> PolygonMesh {
    let coordinate = |n: u32, bit: u32| if n & bit == 0 { -half } else { half };
    let position = |n| Point::new(coordinate(n, 1), coordinate(n, 2), coordinate(n, 4));
    PolygonMesh::new((0..8).map(position).collect::<Vec<_>>(), CUBE).expect("valid")
}

/// The view hides only vertex 0 and the edges and faces there.
fn settings() -> Settings {
    Settings {
        size: Size {
            width: 120,
            height: 100,
        },
        view: View::new(30.0, 25.0, Up::Y).expect("a view"),
        shading: Shading::Smooth,
        edges: false,
        wireframe: false,
        labels: false,
    }
}

fn edges(mesh: &PolygonMesh, edges: &[[u32; 2]]) -> Creases {
    Creases::new(mesh, edges.iter().map(|&ends| (ends, 2.0)), []).expect("edges")
}

fn draw_mesh(mesh: &PolygonMesh, creases: &Creases, settings: &Settings) -> Picture {
    draw(
        &[RenderMesh {
            mesh,
            creases,
            faults: None,
        }],
        settings,
    )
    .unwrap_or_else(|error| panic!("{error}"))
}

fn svg(mesh: &PolygonMesh, creases: &Creases, settings: &Settings) -> String {
    draw_svg(
        &[RenderMesh {
            mesh,
            creases,
            faults: None,
        }],
        settings,
    )
    .unwrap_or_else(|error| panic!("{error}"))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PixelContent {
    Background,
    Outside,
    Inside,
    Crease,
    Other,
}

fn classify(picture: &Picture) -> Vec<PixelContent> {
    let background = &picture.bytes()[..3];
    let pixels = picture.bytes().chunks_exact(3);
    pixels
        .map(|pixel| {
            let [r, g, b] = [pixel[0], pixel[1], pixel[2]].map(i32::from);
            match () {
                () if pixel == background => PixelContent::Background,
                () if r > g + 70 && r > b + 70 && g < 140 => PixelContent::Crease,
                () if b > r + 12 => PixelContent::Outside,
                () if r > b + 12 => PixelContent::Inside,
                () => PixelContent::Other,
            }
        })
        .collect()
}

fn count(picture: &Picture, what: PixelContent) -> usize {
    classify(picture)
        .iter()
        .filter(|&&shown| shown == what)
        .count()
}

/// Returns the coordinates of the ends of all lines in this colour.
fn lines<'a>(svg: &'a str, colour: &str) -> Vec<&'a str> {
    let stroke = format!("fill=\"none\" stroke=\"{colour}\"");
    let paths = svg.lines().filter(|line| line.contains(&stroke));
    paths
        .filter_map(|line| line.split('"').nth(1))
        .flat_map(|path| path.split('M').skip(1))
        .collect()
}

fn faces(svg: &str) -> Vec<&str> {
    svg.lines().filter(|line| line.contains("Z\"")).collect()
}

const EDGE: &str = "#243042";
const CREASE: &str = "#ef4d27";

#[test]
fn a_picture_has_its_size_a_margin_and_is_reproducible() {
    let (mesh, creases) = (cube(1.0), Creases::default());
    let picture = draw_mesh(&mesh, &creases, &settings());
    assert_eq!(picture.size(), settings().size);
    assert_eq!(picture.bytes().len(), 120 * 100 * 3);
    let shown = classify(&picture);
    let rim = |i: usize| i % 120 < 4 || i % 120 >= 116 || i / 120 < 4 || i / 120 >= 96;
    let outside = (0..shown.len()).filter(|&i| rim(i));
    assert!(outside.clone().count() > 500);
    assert!(
        outside
            .into_iter()
            .all(|i| shown[i] == PixelContent::Background)
    );
    assert_eq!(count(&picture, PixelContent::Inside), 0, "a cube is closed");
    let covered = count(&picture, PixelContent::Outside);
    assert!(covered > 3000, "only {covered} pixels");
    assert_eq!(picture, draw_mesh(&mesh, &creases, &settings()));
    assert_eq!(
        svg(&mesh, &creases, &settings()),
        svg(&mesh, &creases, &settings())
    );
    let png = || {
        let mut bytes = Vec::new();
        picture
            .write_png(&mut bytes)
            .expect("a Vec accepts all writes");
        bytes
    };
    assert_eq!(png(), png());
    let mut reader = png::Decoder::new(std::io::Cursor::new(png()))
        .read_info()
        .expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut bytes).expect("pixels");
    assert_eq!(bytes, picture.bytes());
}

#[test]
fn three_faces_and_nine_edges_of_a_cube_are_visible() {
    let mesh = cube(1.0);
    let all = Settings {
        edges: true,
        ..settings()
    };
    let text = svg(&mesh, &Creases::default(), &all);
    assert_eq!(faces(&text).len(), 3, "{text}");
    assert_eq!(lines(&text, EDGE).len(), 9, "{text}");
    let wireframe = Settings {
        wireframe: true,
        ..settings()
    };
    let text = svg(&mesh, &Creases::default(), &wireframe);
    assert_eq!(
        (faces(&text).len(), lines(&text, EDGE).len()),
        (0, 12),
        "{text}"
    );
    let none = svg(&mesh, &Creases::default(), &settings());
    assert_eq!(lines(&none, EDGE), [""; 0]);
    let picture = draw_mesh(&mesh, &Creases::default(), &wireframe);
    let background = count(&picture, PixelContent::Background);
    assert!((5000..11_500).contains(&background), "{background}");
}

#[test]
fn visible_creases_are_red() {
    let mesh = cube(1.0);
    let seen = edges(&mesh, &[[7, 5], [7, 6], [7, 3]]);
    let hidden = edges(&mesh, &[[0, 1], [0, 2], [0, 4]]);
    assert!(count(&draw_mesh(&mesh, &seen, &settings()), PixelContent::Crease) > 60);
    assert_eq!(
        count(
            &draw_mesh(&mesh, &hidden, &settings()),
            PixelContent::Crease
        ),
        0
    );
    assert_eq!(lines(&svg(&mesh, &seen, &settings()), CREASE).len(), 3);
    assert_eq!(lines(&svg(&mesh, &hidden, &settings()), CREASE).len(), 0);
    let corner = |v| Creases::new(&mesh, [], [(v, 1.0)]).expect("a vertex");
    let of_corner = |v| {
        count(
            &draw_mesh(&mesh, &corner(v), &settings()),
            PixelContent::Crease,
        )
    };
    assert!(of_corner(7) > 0);
    assert_eq!(of_corner(0), 0);
}

#[test]
fn a_line_ends_where_a_face_hides_it() {
    // In the view from the front, the small square hides the middle third of the diagonal of the
    // large square.
    let positions = [
        [-3.0, -3.0, 0.0],
        [3.0, -3.0, 0.0],
        [3.0, 3.0, 0.0],
        [-3.0, 3.0, 0.0],
        [-1.0, -1.0, 2.0],
        [1.0, -1.0, 2.0],
        [1.0, 1.0, 2.0],
        [-1.0, 1.0, 2.0],
    ];
    let faces: [&[u32]; 3] = [&[0, 1, 2], &[0, 2, 3], &[4, 5, 6, 7]];
    let mesh = PolygonMesh::new(positions.map(Point::from_array), faces).expect("valid");
    let front = Settings {
        view: View::new(0.0, 0.0, Up::Y).expect("a view"),
        size: Size {
            width: 200,
            height: 200,
        },
        ..settings()
    };
    let diagonal = edges(&mesh, &[[0, 2]]);
    let text = svg(&mesh, &diagonal, &front);
    let lines = lines(&text, CREASE);
    assert_eq!(lines.len(), 2, "{text}");
    // Scale: 200 · 0.86 / 6. A visible part starts at the margin of 14 and is 172 / 3 long.
    let numbers = |line: &str| -> Vec<f64> {
        let numbers = line.split(['L', ' ']);
        numbers
            .map(|number| number.parse().expect("a number"))
            .collect()
    };
    let mut ends: Vec<f64> = lines.iter().flat_map(|line| numbers(line)).collect();
    ends.sort_by(f64::total_cmp);
    let third = 172.0 / 3.0;
    let expected = [14.0, 14.0 + third, 186.0 - third, 186.0];
    for (pair, expected) in ends.chunks(2).zip(expected) {
        for end in pair {
            assert!((end - expected).abs() < 1.0, "{ends:?}");
        }
    }
}

#[test]
fn a_surface_has_two_sides() {
    let corners = [Point::ZERO, Point::X, Point::Y];
    let triangle = PolygonMesh::new(corners, [[0, 1, 2]]).expect("valid");
    let from = |azimuth| {
        let view = View::new(azimuth, 0.0, Up::Y).expect("a view");
        draw_mesh(
            &triangle,
            &Creases::default(),
            &Settings { view, ..settings() },
        )
    };
    let (front, back) = (from(0.0), from(180.0));
    assert!(count(&front, PixelContent::Outside) > 1000);
    assert_eq!(count(&front, PixelContent::Inside), 0);
    assert!(count(&back, PixelContent::Inside) > 1000);
    assert_eq!(count(&back, PixelContent::Outside), 0);
}

#[test]
fn meshes_in_a_row_have_the_same_scale() {
    let (small, large, creases) = (cube(1.0), cube(2.0), Creases::default());
    let render_mesh = |mesh| RenderMesh {
        mesh,
        creases: &creases,
        faults: None,
    };
    let row = Settings {
        size: Size {
            width: 300,
            height: 100,
        },
        ..settings()
    };
    let render_meshes = [
        render_mesh(&small),
        render_mesh(&large),
        render_mesh(&small),
    ];
    let picture = draw(&render_meshes, &row).expect("a picture");
    let shown = classify(&picture);
    let height = |columns: std::ops::Range<usize>| {
        let filled = |row: &usize| {
            let mut columns = columns.clone();
            columns.any(|column| shown[row * 300 + column] != PixelContent::Background)
        };
        (0..100).filter(filled).count()
    };
    let [first, second, third] = [0..100, 100..200, 200..300].map(height);
    assert_eq!(first, third);
    assert!(second.abs_diff(2 * first) <= 2, "{first} {second}");
    assert!(second > 75, "the largest fills its panel: {second}");
}

#[test]
fn shading_is_smooth_unless_an_angle_or_a_crease_breaks_it() {
    // A roof of two slopes that meet at 30°.
    let slope = 15_f32.to_radians().tan();
    let positions = [
        [-1.0, 0.0, -slope],
        [0.0, 0.0, 0.0],
        [1.0, 0.0, -slope],
        [-1.0, 1.0, -slope],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, -slope],
    ];
    let positions = positions.map(Point::from_array);
    let roof = PolygonMesh::new(positions, [[0, 1, 4, 3], [1, 2, 5, 4]]).expect("valid");
    let front = Settings {
        view: View::new(0.0, 0.0, Up::Y).expect("a view"),
        ..settings()
    };
    let flat = Settings {
        shading: Shading::Flat,
        ..front
    };
    // Returns the number of runs of one colour along the middle row.
    let colours = |creases: &Creases, settings: &Settings| {
        let picture = draw_mesh(&roof, creases, settings);
        let mut colours: Vec<&[u8]> = (0..120)
            .map(|column| &picture.bytes()[3 * (60 * 120 + column)..][..3])
            .collect();
        colours.dedup();
        colours.len()
    };
    let none = Creases::default();
    let weak = Creases::new(&roof, [([1, 4], 0.5)], []).expect("an edge");
    assert!(colours(&none, &front) > 12);
    assert!(colours(&none, &flat) <= 7);
    let paths = |creases, settings| {
        let text = svg(&roof, creases, settings);
        let faces = faces(&text).into_iter().map(|face| face.split('"').nth(3));
        faces
            .map(|colour| colour.expect("a colour").to_owned())
            .collect::<Vec<_>>()
    };
    let sharp = edges(&roof, &[[1, 4]]);
    assert_eq!(paths(&sharp, &front), paths(&none, &flat));
    assert_ne!(paths(&none, &front), paths(&none, &flat));
    assert_eq!(paths(&weak, &front), paths(&none, &front));
    let cube = cube(1.0);
    let flat = Settings {
        shading: Shading::Flat,
        ..settings()
    };
    assert_eq!(svg(&cube, &none, &settings()), svg(&cube, &none, &flat));
}

#[test]
fn polygons_are_painted_from_back_to_front() {
    // A long strip away from the viewer, and a small square just in front of its far end. By mean
    // depth, the strip is nearer.
    let positions = [
        [0.0, -0.5, 10.0],
        [1.0, -0.5, 10.0],
        [1.0, 1.0, -10.0],
        [0.0, 1.0, -10.0],
        [0.3, 0.6, -3.0],
        [0.6, 0.6, -3.0],
        [0.6, 0.8, -3.0],
        [0.3, 0.8, -3.0],
    ];
    let positions = positions.map(Point::from_array);
    let front = Settings {
        view: View::new(0.0, 0.0, Up::Y).expect("a view"),
        shading: Shading::Flat,
        ..settings()
    };
    for faces_of in [[[0, 1, 2, 3], [4, 5, 6, 7]], [[4, 5, 6, 7], [0, 1, 2, 3]]] {
        let mesh = PolygonMesh::new(positions, faces_of).expect("valid");
        let text = svg(&mesh, &Creases::default(), &front);
        let widths = faces(&text).into_iter().map(|face| {
            let path = face
                .split('"')
                .nth(1)
                .expect("a path")
                .trim_end_matches('Z');
            let columns = path.trim_start_matches('M').split('L');
            let columns = columns.map(|point| point.split(' ').next().map(str::parse::<f64>));
            let columns: Vec<f64> = columns.map(|x| x.expect("x").expect("a number")).collect();
            columns
                .iter()
                .fold(0.0, |max, x| f64::max(max, x - columns[0]))
        });
        let widths: Vec<f64> = widths.collect();
        assert_eq!(widths.len(), 2, "{text}");
        assert!(widths[0] > widths[1], "expected the strip first: {text}");
    }
}

#[test]
fn extreme_meshes_can_be_drawn() {
    let triangle = |scale: f32| {
        let corners = [Point::ZERO, Point::X, Point::Y].map(|p| p * scale);
        PolygonMesh::new(corners, [[0, 1, 2]]).expect("valid")
    };
    for scale in [1e-44, 1e-20, 1.0, 3e38] {
        let mesh = triangle(scale);
        let all = Settings {
            edges: true,
            ..settings()
        };
        let picture = draw_mesh(&mesh, &edges(&mesh, &[[0, 1]]), &all);
        assert!(count(&picture, PixelContent::Crease) > 20, "{scale}");
        assert!(count(&picture, PixelContent::Outside) > 500, "{scale}");
    }
    let line = [Point::ZERO, Point::X, Point::X * 2.0];
    let line = PolygonMesh::new(line, [[0, 1, 2]]).expect("valid");
    for mesh in [triangle(1.0), line] {
        for (azimuth, elevation) in [(0.0, 90.0), (90.0, 0.0), (0.0, 0.0), (270.0, -90.0)] {
            let view = View::new(azimuth, elevation, Up::Z).expect("a view");
            let all = Settings {
                edges: true,
                view,
                ..settings()
            };
            let picture = draw_mesh(&mesh, &Creases::default(), &all);
            assert!(
                count(&picture, PixelContent::Background) < 120 * 100,
                "{azimuth} {elevation}"
            );
            svg(&mesh, &Creases::default(), &all);
        }
    }
    let corners = [Point::ZERO, Point::X, Point::Y, Point::NAN, Point::MAX];
    let mesh = PolygonMesh::new(corners, [[0, 1, 2]]).expect("valid");
    let creases = Creases::new(&mesh, [], [(3, 1.0), (4, 1.0)]).expect("vertices");
    let picture = draw_mesh(&mesh, &creases, &settings());
    assert_eq!(count(&picture, PixelContent::Crease), 0);
    let svg = svg(&mesh, &creases, &settings());
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
}

/// Large faces are drawn from the front to the back, without what is hidden. The picture is that of all
/// faces, in whatever order they are stored.
#[test]
fn what_is_hidden_and_the_order_of_faces_change_nothing() {
    let sizes = [1.0, 0.9, 0.3, 0.99, 0.6];
    let mut points = Vec::new();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for half in sizes {
        let cube = cube(half);
        let first = points.len() as u32;
        points.extend(cube.positions().iter().copied());
        let of_cube = cube.faces().iter();
        faces.extend(of_cube.map(|(_, face)| face.iter().map(|v| first + v.row()).collect()));
    }
    let draw = |faces: &[Vec<u32>]| {
        let mesh = PolygonMesh::new(points.iter().copied(), faces).expect("valid");
        draw_mesh(&mesh, &Creases::default(), &settings())
    };
    let nested = draw(&faces);
    assert_eq!(nested, draw(&faces[..6]), "the outer cube hides the others");
    faces.reverse();
    assert_eq!(draw(&faces), nested);
    // Through a missing face of the outer cube, the others are seen, again in any order.
    let seen = (0..6).filter(|f| {
        let mut open = faces.clone();
        open.remove(faces.len() - 1 - f);
        let picture = draw(&open);
        open.rotate_left(7);
        assert_eq!(draw(&open), picture);
        picture != nested
    });
    assert_eq!(seen.count(), 3);
}

/// Of two large faces at one place, the first one is seen: outside or inside.
#[test]
fn of_faces_at_one_place_the_first_one_is_seen() {
    let points = [
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
    ];
    let draw = |faces: &[[u32; 4]]| {
        let mesh = PolygonMesh::new(points, faces.iter().copied()).expect("valid");
        draw_mesh(&mesh, &Creases::default(), &settings())
    };
    let (front, back) = ([0, 1, 2, 3], [3, 2, 1, 0]);
    let [one, other] = [draw(&[front]), draw(&[back])];
    assert_ne!(one, other);
    assert_eq!(draw(&[front, back]), one);
    assert_eq!(draw(&[back, front]), other);
}
