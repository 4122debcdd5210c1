//! The cases to compare with OpenSubdiv: random meshes with random creases, and meshes for special
//! rules.

use std::f32::consts::TAU;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use sixfold::subdivision::{BoundaryRule, Creasing, Scheme, Subdivision};
use sixfold::{Creases, Point, PolygonMesh, shapes};
use sixfold_conformance::strategy::{any_mesh, manifold_mesh};

use super::reference::Case;
use crate::subdivision::{creases_on, sharpness};

/// Maximum number of corners of the finest mesh.
const MAX_CORNERS: usize = 12_000;

/// Generates manifolds with and without boundary, with faces of different degrees.
pub(crate) fn manifold() -> impl Strategy<Value = Case> {
    cases_on(manifold_mesh())
}

/// Generates meshes with non-manifold edges, vertices with several fans, or flipped faces.
pub(crate) fn non_manifold() -> impl Strategy<Value = Case> {
    let meshes = prop_oneof![
        (3..6_u32, 2..4_u32).prop_map(|(pages, length)| book(pages, length)),
        (2..5_u32, 3..6_u32).prop_map(|(fans, degree)| bow_tie(fans, degree)),
        (3..6_u32).prop_map(two_cones),
        (0..12_usize).prop_map(with_fin),
    ];
    let parts = (meshes, vec(any::<Index>(), 0..2), vec(any::<Index>(), 0..3));
    let damaged = parts.prop_map(|(mesh, removed, reversed)| damaged(&mesh, &removed, &reversed));
    let arbitrary = any_mesh().prop_filter("no faces", |mesh| mesh.face_count() > 0);
    cases_on(prop_oneof![2 => damaged, 1 => arbitrary])
}

fn cases_on(mesh: impl Strategy<Value = PolygonMesh>) -> impl Strategy<Value = Case> {
    let scheme = prop::sample::select(vec![Scheme::CatmullClark, Scheme::Loop]);
    let boundary = prop::sample::select(BoundaryRule::ALL.to_vec());
    let creasing = prop::sample::select(Creasing::ALL.to_vec());
    let options = (scheme, boundary, creasing, 1..4_u32);
    let creases = (sharpness(), sharpness()).prop_map(|(first, second)| [first, second].concat());
    let parts = (options, mesh, creases);
    parts.prop_map(
        |((scheme, boundary, creasing, levels), polygons, choices)| {
            let polygons = for_scheme(scheme, polygons);
            let creases = creases_on(&polygons, &choices);
            let corners = polygons.corner_count();
            let fits = |&levels: &u32| corners << (2 * levels) <= MAX_CORNERS;
            Case {
                subdivision: Subdivision {
                    boundary,
                    creasing,
                    ..Subdivision::new(scheme)
                },
                levels: (1..=levels).rev().find(fits).unwrap_or(1),
                polygons,
                creases,
            }
        },
    )
}

fn for_scheme(scheme: Scheme, polygons: PolygonMesh) -> PolygonMesh {
    match scheme {
        Scheme::Loop => polygons.triangulated().expect("few corners").polygons,
        _ => polygons,
    }
}

/// Returns cases with different creases at the hub of a wheel, and cases with inner vertices of two
/// faces. Each case has three levels.
pub(crate) fn fixed() -> Vec<Case> {
    let inf = f32::INFINITY;
    let hubs: [(f32, &[f32]); 12] = [
        (0.0, &[0.3]),
        (0.0, &[0.3, 1.5]),
        (0.0, &[0.3, 0.5, inf]),
        (0.0, &[2.4, 1.7, 0.9, 0.2]),
        (0.0, &[0.3, inf, inf]),
        (0.0, &[1.0, 1.0, 1.0, 1.0, 1.0]),
        (0.4, &[]),
        (0.4, &[0.8, 0.8]),
        (2.5, &[0.5, 3.0]),
        (0.4, &[3.0, inf, inf, 0.6]),
        (9.99, &[9.99, 10.0]),
        (inf, &[0.7]),
    ];
    let mut cases = Vec::new();
    for (number, &(own, spokes)) in hubs.iter().enumerate() {
        let spare = 1 + number as u32 % 3;
        let sectors = (spokes.len() as u32).max(2) + spare;
        for is_closed in [true, false] {
            let mesh = wheel(sectors, is_closed);
            let edges = spokes.iter().zip(1..).map(|(&s, rim)| ([0, rim], s));
            for (scheme, boundary, creasing) in all_options() {
                let polygons = mesh.clone();
                let creases = Creases::new(&polygons, edges.clone(), [(0, own)]);
                cases.push(Case {
                    subdivision: Subdivision {
                        boundary,
                        creasing,
                        ..Subdivision::new(scheme)
                    },
                    creases: creases.expect("spokes of the wheel"),
                    polygons,
                    levels: 3,
                });
            }
        }
    }
    // Every vertex has two faces.
    for s in [0.0, 0.5, 1.5] {
        let corners = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.3), Point::Y];
        let polygons = PolygonMesh::new(corners, [[0, 1, 2, 3], [3, 2, 1, 0]]).expect("two quads");
        let creases = Creases::new(&polygons, [([0, 1], s), ([1, 2], s)], []);
        cases.push(Case {
            subdivision: Subdivision::new(Scheme::CatmullClark),
            creases: creases.expect("edges of the quads"),
            polygons,
            levels: 3,
        });
    }
    cases
}

fn all_options() -> impl Iterator<Item = (Scheme, BoundaryRule, Creasing)> {
    let schemes = [Scheme::CatmullClark, Scheme::Loop].into_iter();
    let boundaries =
        schemes.flat_map(|scheme| BoundaryRule::ALL.map(|boundary| (scheme, boundary)));
    boundaries
        .flat_map(|(scheme, boundary)| Creasing::ALL.map(|creasing| (scheme, boundary, creasing)))
}

fn on_circle(i: u32, n: u32, z: f32) -> Point {
    let (sin, cos) = (TAU * i as f32 / n as f32).sin_cos();
    Point::new(cos, sin, z)
}

/// Builds triangles around vertex 0. If `is_closed` is false, one triangle is missing.
fn wheel(n: u32, is_closed: bool) -> PolygonMesh {
    let rim = (0..n).map(|i| on_circle(i, n, (i % 3) as f32 * 0.25));
    let points: Vec<Point> = std::iter::once(Point::Z).chain(rim).collect();
    let sectors = if is_closed { n } else { n - 1 };
    let faces: Vec<[u32; 3]> = (0..sectors).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect();
    PolygonMesh::new(points, faces).expect("a wheel")
}

/// Builds strips of quads ("pages") that share one chain of edges ("spine").
///
/// ```text
///    2 ─── ·      the spine is 0, 1, 2 …; each page goes from the spine to its own rim;
///    │     │      vertex 1 is an inner vertex of the spine
///    1 ─── ·
///    │     │
///    0 ─── ·
/// ```
fn book(pages: u32, length: u32) -> PolygonMesh {
    let spine = (0..=length).map(|k| Point::Z * k as f32);
    let rims =
        (0..pages).flat_map(|page| (0..=length).map(move |k| on_circle(page, pages, k as f32)));
    let points: Vec<Point> = spine.chain(rims).collect();
    let quads = (1..=pages).flat_map(|page| {
        let rim = page * (length + 1);
        (0..length).map(move |k| [k, rim + k, rim + k + 1, k + 1])
    });
    PolygonMesh::new(points, quads.collect::<Vec<_>>()).expect("a book")
}

/// Builds polygons that share only vertex 0. All polygons have the same degree.
fn bow_tie(fans: u32, degree: u32) -> PolygonMesh {
    let rim = fans * (degree - 1);
    let points = (0..rim).map(|i| on_circle(i, rim, (i % 2) as f32 * 0.5));
    let points: Vec<Point> = std::iter::once(Point::ZERO).chain(points).collect();
    let faces = (0..fans).map(|fan| {
        let own = (1..degree).map(|k| fan * (degree - 1) + k);
        std::iter::once(0).chain(own).collect::<Vec<u32>>()
    });
    PolygonMesh::new(points, faces.collect::<Vec<_>>()).expect("a bow-tie")
}

fn two_cones(n: u32) -> PolygonMesh {
    let rings = (0..2 * n).map(|i| on_circle(i, n, if i < n { 1.0 } else { -1.0 }));
    let points: Vec<Point> = std::iter::once(Point::ZERO).chain(rings).collect();
    let mut faces = Vec::new();
    for first in [1, 1 + n] {
        for i in 0..n {
            faces.push(vec![0, first + i, first + (i + 1) % n]);
        }
        faces.push((first..first + n).rev().collect());
    }
    PolygonMesh::new(points, faces).expect("two cones")
}

/// Builds a grid with an additional quad on an inner edge.
fn with_fin(edge: usize) -> PolygonMesh {
    let grid = shapes::grid(3, 3).expect("a small grid");
    let uses = grid.edge_uses();
    let inner: Vec<_> = uses.iter().filter(|edge| !edge.is_boundary()).collect();
    let [a, b] = inner[edge % inner.len()].ends;
    let apexes = [b, a].map(|v| grid.position(v) + Point::Z);
    let first = grid.vertex_count() as u32;
    let points = [grid.positions(), &apexes].concat();
    let mut faces = face_rows(&grid);
    faces.push(vec![a.index() as u32, b.index() as u32, first, first + 1]);
    PolygonMesh::new(points, faces).expect("a grid with a fin")
}

/// Removes some faces of the mesh, but not all, and flips some other faces.
fn damaged(mesh: &PolygonMesh, removed: &[Index], reversed: &[Index]) -> PolygonMesh {
    let mut faces = face_rows(mesh);
    for index in removed {
        if faces.len() > 1 {
            faces.remove(index.index(faces.len()));
        }
    }
    for index in reversed {
        let face = index.index(faces.len());
        faces[face].reverse();
    }
    PolygonMesh::new(mesh.positions().iter().copied(), faces).expect("faces of a mesh")
}

fn face_rows(mesh: &PolygonMesh) -> Vec<Vec<u32>> {
    let faces = mesh.faces().iter();
    let numbers = faces.map(|(_, face)| face.iter().map(|v| v.index() as u32).collect());
    numbers.collect()
}
