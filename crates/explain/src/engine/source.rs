//! The mesh of a request.

use std::collections::BTreeMap;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Deserialize;
use sixfold::io::{FileMesh, ReadOptions, read_from};
use sixfold::shapes::{GENERATORS, generator};
use sixfold::{Creases, PolygonMesh, UnknownName};

use super::Error;

/// Maximum number of corners of a mesh.
pub(super) const MOST_CORNERS: usize = 400_000;

/// Maximum number of faces that a note lists.
pub(super) const SHOWN: usize = 5;

/// Where the mesh comes from.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum MeshSource {
    /// The mesh that the engine keeps.
    Last,
    Shape {
        name: String,
        #[serde(default)]
        parameters: BTreeMap<String, f64>,
    },
    File {
        name: String,
        #[serde(default)]
        text: Option<String>,
        #[serde(default)]
        base64: Option<String>,
    },
    /// Numbers without an element are null, as in [`Geometry`](crate::Geometry).
    Polygons {
        positions: Vec<Option<[f64; 3]>>,
        faces: Vec<Option<Vec<u32>>>,
    },
}

/// A mesh that was read.
pub(super) struct Sourced {
    pub(super) polygons: PolygonMesh,
    pub(super) creases: Creases,
    /// What reading the file left out or changed.
    pub(super) notes: Vec<String>,
}

impl MeshSource {
    /// Reads the mesh; `None` if it is the one that the engine keeps.
    pub(super) fn read(&self) -> Result<Option<Sourced>, Error> {
        let sourced = match self {
            Self::Last => return Ok(None),
            Self::Shape { name, parameters } => Sourced::plain(shape(name, parameters)?),
            Self::Polygons { positions, faces } => from_polygons(positions, faces)?,
            Self::File { name, text, base64 } => {
                let decoded;
                let content = match (text, base64) {
                    (Some(text), None) => text.as_bytes(),
                    (None, Some(base64)) => {
                        decoded = (STANDARD.decode(base64))
                            .map_err(|error| format!("base64 of {name}: {error}"))?;
                        &decoded
                    }
                    _ => return Err("a file has either a text or base64".into()),
                };
                Sourced::from_file(read_from(name, content, &ReadOptions::default())?)
            }
        };
        check_size(sourced.polygons.corner_count())?;
        check_positions(&sourced.polygons, "the mesh")?;
        Ok(Some(sourced))
    }
}

/// Returns an error for a mesh with too many corners.
pub(super) fn check_size(corners: usize) -> Result<(), Error> {
    match corners <= MOST_CORNERS {
        true => Ok(()),
        false => Err(format!(
            "the mesh has {corners} corners, and a request at most {MOST_CORNERS}: make it smaller with `sixfold \
             decimate`, or use the commands `sixfold tables` and `sixfold trace`"
        )
        .into()),
    }
}

/// Returns an error for a vertex whose coordinates are not finite in 32 bits.
pub(super) fn check_positions(polygons: &PolygonMesh, mesh: &str) -> Result<(), Error> {
    let mut positions = polygons.positions().iter();
    match positions.position(|position| !position.is_finite()) {
        None => Ok(()),
        Some(v) => Err(format!(
            "v{v} of {mesh} has a coordinate that is too large for 32 bits: scale the mesh"
        )
        .into()),
    }
}

/// Returns a mesh without the numbers that have no element.
fn from_polygons(
    positions: &[Option<[f64; 3]>],
    faces: &[Option<Vec<u32>>],
) -> Result<Sourced, Error> {
    let mut held = 0;
    let numbers: Vec<Option<u32>> = (positions.iter())
        .map(|position| {
            held += u32::from(position.is_some());
            position.map(|_| held - 1)
        })
        .collect();
    let number = |f: usize, corner: u32| match numbers.get(corner as usize) {
        Some(Some(number)) => Ok(*number),
        _ => Err(format!(
            "face f{f} has the corner v{corner}, which has no position"
        )),
    };
    let held_faces = (faces.iter().enumerate()).filter_map(|(f, face)| Some((f, face.as_ref()?)));
    let corners = held_faces.map(|(f, face)| {
        let corners = face.iter().map(|&corner| number(f, corner));
        corners.collect::<Result<Vec<u32>, _>>()
    });
    let positions = positions.iter().flatten();
    let polygons = PolygonMesh::new(
        positions.map(|position| position.map(|coordinate| coordinate as f32)),
        corners.collect::<Result<Vec<_>, _>>()?,
    )?;
    let mut sourced = Sourced::plain(polygons);
    let left = |all: usize, kept: usize, element: &str| match all - kept {
        0 => None,
        gaps => Some(format!(
            "{gaps} numbers of {element} have no element: the elements after them have lower numbers here"
        )),
    };
    let notes = [
        left(numbers.len(), sourced.polygons.vertex_count(), "vertices"),
        left(faces.len(), sourced.polygons.face_count(), "faces"),
    ];
    sourced.notes.extend(notes.into_iter().flatten());
    Ok(sourced)
}

fn shape(name: &str, parameters: &BTreeMap<String, f64>) -> Result<PolygonMesh, Error> {
    let known = GENERATORS.iter().map(|generator| generator.name);
    let generator = generator(name).ok_or_else(|| UnknownName::new("shape", name, known))?;
    let values: Vec<(&str, f64)> = (parameters.iter())
        .map(|(name, &value)| (name.as_str(), value))
        .collect();
    Ok(generator.build(&values)?)
}

impl Sourced {
    fn plain(polygons: PolygonMesh) -> Self {
        Self {
            polygons,
            creases: Creases::default(),
            notes: Vec::new(),
        }
    }

    fn from_file(mesh: FileMesh) -> Self {
        let mut notes: Vec<String> = mesh.notices.iter().map(ToString::to_string).collect();
        if mesh.welded_vertices > 0 {
            let corners = mesh.welded_vertices + mesh.positions.len();
            let vertices = mesh.positions.len();
            notes.push(format!(
                "joined {corners} corners at equal positions to {vertices} vertices"
            ));
        }
        if mesh.narrowing.merged_vertices > 0 {
            notes.push(mesh.narrowing.to_string());
        }
        let (creases, unused) = mesh.creases();
        notes.extend(unused.iter().map(ToString::to_string));
        let (polygons, left_out) = mesh.into_polygons();
        let listed = left_out.iter().take(SHOWN);
        notes.extend(listed.map(|face| format!("left out {face}")));
        if left_out.len() > SHOWN {
            notes.push(format!("left out {} more faces", left_out.len() - SHOWN));
        }
        Self {
            polygons,
            creases,
            notes,
        }
    }
}
