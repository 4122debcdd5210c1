//! What a command did to the shape of a surface.

use std::path::Path;
use std::process::ExitCode;

use sixfold::repair::{Measures, measures};
use sixfold::spatial::{
    Bvh, FaceTriangle, SearchHint, SpatialIndex, SurfacePoint, SurfaceQueries,
    closest_point_on_triangle, polygon_triangles,
};
use sixfold::{FaceId, PolygonMesh, VertexId, area_vector};
use sixfold_results::numbers::counted;

use crate::arguments::ShapeCheck;
use crate::text::{figure, print_notice};

/// The exit code if a result is empty, and with `--check` if the shape has changed.
const CHANGED: u8 = 1;

/// The part of the area, of the volume, of the diagonal or of a side of the box that may change without a
/// word.
const ALLOWED: f64 = 0.05;

/// The part of what the diagonal may change that a side of the box may change in any case.
const NOTICEABLE: f64 = 0.02;

/// Compares a mesh with the mesh `after` that a command made of it and wrote to `to`. Prints a warning
/// if the shape has changed by more than the stated part, if faces are turned over or flat, or if the
/// result has no faces.
pub(crate) fn check_shape(
    before: &PolygonMesh,
    after: &PolygonMesh,
    to: &Path,
    check: ShapeCheck,
) -> ExitCode {
    if after.face_count() == 0 {
        return check_faces(before.face_count(), after, to);
    }
    let changes = changes(before, after);
    if changes.is_empty() {
        return ExitCode::SUCCESS;
    }
    let changes = changes.join("; ");
    print_notice(&format!(
        "warning: {}: the shape has changed: {changes}",
        to.display()
    ));
    match check.check {
        true => ExitCode::from(CHANGED),
        false => ExitCode::SUCCESS,
    }
}

/// Prints a warning if the mesh `after`, which a command wrote to `to`, has no faces. `before` is the
/// number of faces of the mesh that the command read.
pub(crate) fn check_faces(before: usize, after: &PolygonMesh, to: &Path) -> ExitCode {
    if after.face_count() > 0 {
        return ExitCode::SUCCESS;
    }
    let but = match before {
        0 => ", as the mesh had none".to_owned(),
        _ => format!(", but the mesh had {}", counted(before, "face", "faces")),
    };
    print_notice(&format!(
        "warning: {}: the result has no faces{but}",
        to.display()
    ));
    ExitCode::from(CHANGED)
}

/// Describes each change that is larger than allowed.
fn changes(before: &PolygonMesh, after: &PolygonMesh) -> Vec<String> {
    let [old, new] = [before, after].map(measures);
    let mut changes = Vec::new();
    changes.extend(change("area", old.area, new.area));
    match (old.volume, new.volume) {
        (Some(old), Some(new)) => changes.extend(change("volume", old, new)),
        (Some(_), None) => changes.push("the surface is no longer closed".to_owned()),
        _ => {}
    }
    changes.extend(change_of_box(&old, &new));
    let turned = turned_faces(before, after);
    if turned.count > 0 {
        let faces = counted(turned.count, "face is turned over", "faces are turned over");
        changes.push(match turned.compared {
            compared if compared < after.face_count() => {
                format!("of {compared} faces that were compared, {faces}")
            }
            _ => faces,
        });
    }
    let [flat_before, flat] = [before, after].map(flat_faces);
    if flat > flat_before {
        changes.push(counted(flat, "face has no area", "faces have no area"));
    }
    changes
}

fn change(what: &str, old: f64, new: f64) -> Option<String> {
    let part = (new - old) / old.abs();
    // A comparison with NaN is false: without an area, there is nothing to compare.
    (part.abs() > ALLOWED).then(|| {
        format!(
            "the {what} is {} instead of {} ({:+.0} %)",
            figure(new),
            figure(old),
            100.0 * part
        )
    })
}

fn change_of_box(old: &Measures, new: &Measures) -> Option<String> {
    let diagonal = |size: [f64; 3]| size.iter().map(|x| x * x).sum::<f64>().sqrt();
    let limit = ALLOWED * diagonal(old.size());
    let ends = |measures: &Measures| measures.bounds.map(|ends| ends.concat());
    let moved = match (ends(old), ends(new)) {
        (Some(old), Some(new)) => old.iter().zip(new).any(|(a, b)| (a - b).abs() > limit),
        (old, new) => old.is_some() != new.is_some(),
    };
    // A thin plate that becomes thicker is as large a change as one in its length.
    let is_longer = |(old, new): ([f64; 3], [f64; 3])| {
        let mut sides = old.into_iter().zip(new);
        sides.any(|(old, new)| {
            let by = (new - old).abs();
            by > ALLOWED * old && by > NOTICEABLE * limit
        })
    };
    let moved = moved || is_longer((old.size(), new.size()));
    let size = |measures: &Measures| measures.size().map(figure).join(" × ");
    moved.then(|| format!("the box is {} instead of {}", size(new), size(old)))
}

fn normal(mesh: &PolygonMesh, face: &[VertexId]) -> sixfold::glam::DVec3 {
    area_vector(face.iter().map(|&v| mesh.position(v).as_dvec3()))
}

fn flat_faces(mesh: &PolygonMesh) -> usize {
    let faces = mesh.faces().iter();
    faces
        .filter(|(_, face)| normal(mesh, face).length() == 0.0)
        .count()
}

/// The faces that are turned over.
struct TurnedFaces {
    count: usize,
    /// The number of faces of which this is known.
    compared: usize,
}

/// The faces with which the time of a comparison is estimated.
const TRIAL: usize = 256;

/// The triangles of the surface with which a face is compared, on average, at most. Where one needs more,
/// as on long triangles that cross in one region, only some of the faces are compared.
const MOST_VISITS: u64 = 128;

/// Counts the faces of `after` that look to the other side than the surface `before`: than the same face
/// if the faces are the same ones, otherwise than all closest faces.
fn turned_faces(before: &PolygonMesh, after: &PolygonMesh) -> TurnedFaces {
    if before.faces() == after.faces() {
        let faces = after.faces().iter();
        let turned = faces.filter(|(_, face)| normal(before, face).dot(normal(after, face)) < 0.0);
        return TurnedFaces {
            count: turned.count(),
            compared: after.face_count(),
        };
    }
    let Ok(surface) = polygon_triangles(before).and_then(Bvh::build) else {
        return TurnedFaces {
            count: 0,
            compared: 0,
        };
    };
    let centre = |face: &[VertexId]| {
        let corners = face.iter().map(|&v| after.position(v).as_dvec3());
        corners.sum::<sixfold::glam::DVec3>() / face.len() as f64
    };
    let faces = after.faces();
    let trial = faces.iter().step_by(faces.len().div_ceil(TRIAL).max(1));
    let (mut visits, mut queries) = (0, 0);
    for (_, face) in trial {
        // Each search starts anew, so this is more than a search from face to face needs.
        let mut hint = SearchHint::default();
        surface.closest_point_from(centre(face), &mut hint);
        visits += hint.visits();
        queries += 1;
    }
    let step = (visits / (MOST_VISITS * queries).max(1)).max(1) as usize;
    let compared: Vec<&[VertexId]> = faces.iter().step_by(step).map(|(_, face)| face).collect();
    let centres: Vec<_> = compared.iter().map(|&face| centre(face)).collect();
    let closest = surface.closest_point_of_each(&centres);
    let turned = compared.iter().zip(closest).filter(|(face, closest)| {
        closest.is_some_and(|closest| {
            let own = normal(after, face);
            let agrees = |f| normal(before, before.faces().face(f)).dot(own) >= 0.0;
            !agrees(closest.face) && !faces_near(&surface, &closest).into_iter().any(agrees)
        })
    });
    TurnedFaces {
        count: turned.count(),
        compared: compared.len(),
    }
}

/// Returns the faces that are, up to rounding, as close as `closest` to where it was looked for: several
/// at an edge, and both sides of a wall between two solids.
fn faces_near(surface: &Bvh<FaceTriangle<FaceId>>, closest: &SurfacePoint<FaceId>) -> Vec<FaceId> {
    let mut faces = Vec::new();
    let limit = 1e-12 * (1.0 + closest.point.length_squared());
    surface.visit_near(closest.point, limit, |slot| {
        let triangle = &surface.items()[slot];
        let near = closest_point_on_triangle(closest.point, triangle.corners_f64());
        if near.distance_squared(closest.point) <= limit {
            faces.push(triangle.face);
        }
        limit
    });
    faces
}

#[cfg(test)]
mod tests {
    use sixfold::{Point, shapes};

    use super::*;

    fn moved(mesh: &PolygonMesh, by: impl Fn(Point) -> Point) -> PolygonMesh {
        let points = mesh.positions().iter().map(|&p| by(p)).collect();
        PolygonMesh::from_faces(points, mesh.faces().clone()).expect("valid")
    }

    #[test]
    fn small_changes_are_silent_and_large_ones_have_figures() {
        let cube = shapes::cube();
        assert!(changes(&cube, &cube).is_empty());
        assert!(changes(&cube, &moved(&cube, |p| 0.99 * p)).is_empty());
        let half = changes(&cube, &moved(&cube, |p| Point::new(p.x, p.y, 0.5 * p.z)));
        assert_eq!(
            half,
            [
                "the area is 16 instead of 24 (-33 %)",
                "the volume is 4 instead of 8 (-50 %)",
                "the box is 2 × 2 × 1 instead of 2 × 2 × 2"
            ]
        );
        let mirrored = changes(&cube, &moved(&cube, |p| Point::new(p.x, p.y, -p.z)));
        assert_eq!(
            mirrored,
            [
                "the volume is -8 instead of 8 (-200 %)",
                "4 faces are turned over"
            ]
        );
        let flat = changes(&cube, &moved(&cube, |p| Point::new(p.x, p.y, 0.0)));
        assert_eq!(
            flat.last().map(String::as_str),
            Some("4 faces have no area")
        );
    }

    #[test]
    fn sides_of_thin_plates_and_walls_between_solids_are_compared() {
        let cube = shapes::cube();
        let plate = moved(&cube, |p| Point::new(p.x, p.y, 0.001 * p.z));
        let thicker = moved(&cube, |p| Point::new(p.x, p.y, 0.006 * p.z));
        let found = changes(&plate, &thicker);
        assert!(
            found.iter().any(|change| change.starts_with("the box")),
            "{found:?}"
        );
        // Two cubes whose walls touch, against the same in triangles: no face is turned over.
        let two = |mesh: &PolygonMesh| {
            let beside = mesh.positions().iter().map(|&p| p + 2.0 * Point::X);
            let points = mesh.positions().iter().copied().chain(beside);
            let count = mesh.vertex_count() as u32;
            let faces = [0, count].into_iter().flat_map(|first| {
                let faces = mesh.faces().iter();
                faces.map(move |(_, f)| f.iter().map(|v| first + v.index() as u32).collect())
            });
            PolygonMesh::new(points, faces.collect::<Vec<Vec<u32>>>()).expect("valid")
        };
        let triangles = cube.triangulated().expect("small").polygons;
        assert!(changes(&two(&cube), &two(&triangles)).is_empty());
    }

    #[test]
    fn faces_of_other_meshes_are_compared_with_the_closest() {
        let cube = shapes::cube();
        let triangles = cube.triangulated().expect("small").polygons;
        assert!(changes(&cube, &triangles).is_empty());
        let mut faces: Vec<Vec<u32>> = triangles
            .faces()
            .iter()
            .map(|(_, face)| face.iter().map(|v| v.index() as u32).collect())
            .collect();
        faces[5].reverse();
        let turned = PolygonMesh::new(triangles.positions().iter().copied(), faces);
        let found = changes(&cube, &turned.expect("valid"));
        assert_eq!(
            found,
            ["the surface is no longer closed", "1 face is turned over"]
        );
    }

    /// Where each comparison visits many faces, only some are compared.
    #[test]
    fn of_long_triangles_that_cross_some_are_compared() {
        let count = 2000;
        let mut points = Vec::new();
        for i in 0..count {
            let angle =
                |x: u32| std::f32::consts::TAU * (f64::from(x * i) * 0.618_034).fract() as f32;
            let (sin, cos) = angle(1).sin_cos();
            let (height, radius) = angle(7).sin_cos();
            let end = Point::new(radius * cos, radius * sin, height);
            points.extend([end, -end, end + Point::new(0.0, 0.001, 0.001)]);
        }
        let mesh = |faces: Vec<Vec<u32>>| PolygonMesh::new(points.clone(), faces).expect("valid");
        let before = mesh(
            (0..count)
                .map(|i| vec![3 * i, 3 * i + 1, 3 * i + 2])
                .collect(),
        );
        let after = mesh(
            (0..count)
                .map(|i| vec![3 * i, 3 * i + 2, 3 * i + 1])
                .collect(),
        );
        let turned = turned_faces(&before, &after);
        assert!((20..1000).contains(&turned.compared), "{}", turned.compared);
        assert_eq!(turned.count, turned.compared);
        let whole = turned_faces(
            &shapes::torus(9, 9).expect("small"),
            &shapes::torus(9, 8).expect("small"),
        );
        assert_eq!((whole.count, whole.compared), (0, 72));
    }
}
