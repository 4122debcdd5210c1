//! Reads meshes and results from files.

use std::fs;
use std::path::{Path, PathBuf};

use sixfold::glam::DVec3;
use sixfold::io::{FileMesh, IgnoredKind, LeftOut, Narrowing, Notice, Place, PolygonPlaces};
use sixfold::repair::{Diagnosis, Measures, diagnose, examine, measures};
use sixfold::{Creases, FaceId, PolygonMesh};
use sixfold_results::Results;
use sixfold_study::StudyMesh;

pub(crate) use sixfold_measure::command::load::file_hash;
use sixfold_measure::command::load::{into_study_mesh, print_left_out};

use crate::arguments::{ReadFiles, ReadPolygons};
use crate::failure::Failure;
use crate::faults_text::SHOWN_PLACES;
use crate::mesh_files::{read_mesh, read_mesh_at, shown};
use crate::progress::Spinner;
use crate::text::print_places;
use crate::triangulate::{cut_polygons, triangulated};
use sixfold_results::numbers::counted;

/// A mesh for `sixfold inspect`, without its degenerate faces.
pub(crate) struct InspectedMesh {
    pub(crate) study_mesh: StudyMesh,
    pub(crate) measures: Measures,
    pub(crate) diagnosis: Diagnosis,
    /// The places of the vertices and faces; `None` if polygons were cut.
    pub(crate) places: Option<PolygonPlaces>,
    /// The degenerate faces of the file.
    pub(crate) left_out: Vec<LeftOut>,
    pub(crate) narrowing: Narrowing,
}

/// Reads a mesh without its degenerate faces, lists the degenerate faces, and diagnoses the mesh.
/// `triangulate` cuts polygons first.
pub(crate) fn for_inspection(
    path: &Path,
    files: ReadFiles,
    triangulate: bool,
) -> Result<InspectedMesh, Failure> {
    let mesh = read_mesh(path, files)?;
    let narrowing = mesh.narrowing;
    let origin = mesh.origin;
    // The box is that in the file, also if the mesh is moved.
    let placed = |mut measures: Measures| {
        let moved = |at: [f64; 3]| (DVec3::from(at) + DVec3::from(origin)).to_array();
        measures.bounds = measures.bounds.map(|ends| ends.map(moved));
        measures
    };
    if triangulate || mesh.has_degenerate_faces() {
        let (mut study_mesh, left_out, places) = into_study_mesh(path, mesh);
        print_left_out(path, &left_out);
        if triangulate {
            study_mesh = triangulated(study_mesh, Some(&places))?;
        }
        let spinner = Spinner::start(format!("inspecting {}", shown(path)));
        let diagnosis = diagnose(&study_mesh.polygons, SHOWN_PLACES);
        let measures = placed(measures(&study_mesh.polygons));
        spinner.clear();
        return Ok(InspectedMesh {
            study_mesh,
            measures,
            diagnosis,
            places: (!triangulate).then_some(places),
            left_out,
            narrowing,
        });
    }
    // The facts of the file are those of the polygons.
    let (polygons, _, places) = mesh.into_polygons_with_places();
    let spinner = Spinner::start(format!("inspecting {}", shown(path)));
    let (facts, measures, diagnosis) = examine(&polygons, SHOWN_PLACES);
    spinner.clear();
    let study_mesh = StudyMesh::with_facts(shown(path), polygons, facts);
    Ok(InspectedMesh {
        study_mesh,
        measures: placed(measures),
        diagnosis,
        places: Some(places),
        left_out: Vec::new(),
        narrowing,
    })
}

/// Reads a mesh without its degenerate faces. Also returns the creases in the file, and the place of
/// the origin in the file, which is zero without --recentre.
pub(crate) fn with_creases(
    path: &Path,
    chosen: ReadPolygons,
) -> Result<(PolygonMesh, Creases, [f64; 3]), Failure> {
    let ReadMesh {
        polygons,
        places,
        creases,
        origin,
        ..
    } = for_repair(path, chosen.files)?;
    let polygons = cut_if_chosen(path, polygons, &places, chosen)?;
    Ok((polygons, creases, origin))
}

/// Cuts polygons into triangles if `chosen` asks for it.
fn cut_if_chosen(
    path: &Path,
    polygons: PolygonMesh,
    places: &PolygonPlaces,
    chosen: ReadPolygons,
) -> Result<PolygonMesh, Failure> {
    if !chosen.triangulate || polygons.first_polygon().is_none() {
        return Ok(polygons);
    }
    let study_mesh = StudyMesh::new(shown(path), polygons);
    Ok(triangulated(study_mesh, Some(places))?.polygons)
}

/// A mesh whose faces the user names with their numbers in the file.
pub(crate) struct NumberedMesh {
    pub(crate) polygons: PolygonMesh,
    pub(crate) creases: Creases,
    pub(crate) origin: [f64; 3],
    pub(crate) numbers: FaceNumbers,
}

/// Which faces of a mesh are which ones of its file.
pub(crate) struct FaceNumbers {
    /// By face of the mesh: its number in the file, from 0. Ascending.
    numbers: Vec<usize>,
    /// The number of faces in the file.
    in_file: usize,
}

impl FaceNumbers {
    /// Returns the number of faces in the file.
    pub(crate) fn in_file(&self) -> usize {
        self.in_file
    }

    /// Returns the faces of the mesh that come from a face of the file: none if it was left out, several
    /// if it was cut.
    pub(crate) fn faces(&self, number: usize) -> impl Iterator<Item = FaceId> + use<> {
        let before = |f: usize| u32::try_from(f).expect("rows have 32 bits");
        let first = self.numbers.partition_point(|&other| other < number);
        let end = self.numbers.partition_point(|&other| other <= number);
        (before(first)..before(end)).map(FaceId::new)
    }

    /// Returns the numbers for the faces after a change that keeps their order; `old` returns the face before.
    pub(crate) fn after(&self, faces: usize, old: impl Fn(FaceId) -> FaceId) -> Self {
        let all = (0..).map(FaceId::new).take(faces);
        let numbers = all.map(|f| self.numbers[old(f).index()]);
        Self {
            numbers: numbers.collect(),
            in_file: self.in_file,
        }
    }
}

/// Reads a mesh like [`with_creases`], with the numbers that its faces have in the file.
pub(crate) fn with_face_numbers(
    path: &Path,
    chosen: ReadPolygons,
) -> Result<NumberedMesh, Failure> {
    let mesh = for_repair(path, chosen.files)?;
    // Reading cuts faces that name a vertex twice: of faces at one place, one was cut into the others.
    // Without such a face, those at one place, such as a line, are different ones.
    let mut ignored = mesh.ignored.iter();
    let was_cut = ignored.any(|notice| notice.kind == IgnoredKind::CutFaces);
    let mut left_out = mesh.left_out.iter().peekable();
    let (mut numbers, mut in_file, mut last) = (Vec::new(), 0, None);
    for (f, face) in mesh.polygons.faces().iter() {
        let place = mesh.places.place(f, &mesh.polygons);
        while left_out.next_if(|&&other| other < place).is_some() {
            in_file += 1;
        }
        if !(was_cut && last == Some(place)) {
            in_file += 1;
        }
        last = Some(place);
        let parts = if chosen.triangulate {
            face.len() - 2
        } else {
            1
        };
        numbers.extend(std::iter::repeat_n(in_file - 1, parts));
    }
    let in_file = in_file + left_out.count();
    let numbers = FaceNumbers { numbers, in_file };
    Ok(NumberedMesh {
        polygons: cut_if_chosen(path, mesh.polygons, &mesh.places, chosen)?,
        creases: mesh.creases,
        origin: mesh.origin,
        numbers,
    })
}

/// A mesh without its degenerate faces, and what reading changed.
pub(crate) struct ReadMesh {
    pub(crate) polygons: PolygonMesh,
    pub(crate) creases: Creases,
    /// The place of the origin in the file; zero without --recentre.
    pub(crate) origin: [f64; 3],
    /// The places of the vertices and faces in the file.
    pub(crate) places: PolygonPlaces,
    /// The places of the degenerate faces that were left out.
    pub(crate) left_out: Vec<Place>,
    /// Number of vertices that were joined to others at equal positions.
    pub(crate) joined: usize,
    /// The contents that were ignored.
    pub(crate) ignored: Vec<Notice>,
}

/// Reads a mesh without its degenerate faces, and returns what reading changed.
pub(crate) fn for_repair(path: &Path, files: ReadFiles) -> Result<ReadMesh, Failure> {
    let mut mesh = read_mesh(path, files)?;
    let (joined, ignored) = (mesh.welded_vertices, std::mem::take(&mut mesh.notices));
    let origin = mesh.origin;
    let (creases, unused) = mesh.creases();
    let creases_left_out = counted(unused.len(), "crease", "creases");
    print_places(
        &format!("{}: left out {creases_left_out}", shown(path)),
        unused.iter().map(ToString::to_string),
    );
    let (polygons, left_out, places) = mesh.into_polygons_with_places();
    print_left_out(path, &left_out);
    Ok(ReadMesh {
        polygons,
        creases,
        origin,
        places,
        left_out: left_out.iter().map(|face| face.place).collect(),
        joined,
        ignored,
    })
}

/// Reads two meshes without their degenerate faces, and cuts polygons into triangles. If the option
/// --recentre is set, both are moved by the centre of the first one, so that their distance stays. Also
/// returns the place of the origin.
pub(crate) fn pair(
    first: &Path,
    second: &Path,
    chosen: ReadPolygons,
) -> Result<([PolygonMesh; 2], [f64; 3]), Failure> {
    let triangles_of = |path: &Path, mesh: FileMesh| {
        let (polygons, left_out, places) = mesh.into_polygons_with_places();
        print_left_out(path, &left_out);
        cut_polygons(&shown(path), &polygons, Some(&places)).map(|cut| cut.polygons)
    };
    let mesh = read_mesh(first, chosen.files)?;
    let origin = mesh.origin;
    let first = triangles_of(first, mesh)?;
    let mesh = read_mesh_at(second, chosen.files, Some(origin))?;
    Ok(([first, triangles_of(second, mesh)?], origin))
}

/// Returns the file of results. If `place` is a folder, this is the file `results.json` in the
/// folder.
pub(crate) fn results_path(place: &Path) -> PathBuf {
    match place.is_dir() {
        true => place.join("results.json"),
        false => place.to_owned(),
    }
}

/// Reads results from a file or from the folder of a report.
pub(crate) fn read_results(place: &Path) -> Result<Results, Failure> {
    let path = results_path(place);
    let file = shown(&path);
    let text = fs::read_to_string(&path).map_err(|cause| {
        Failure::usage(format!(
            "{file}: cannot be read ({cause}): name a file from --json, or a folder from --report"
        ))
    })?;
    Results::read_json(&text).map_err(|error| Failure::usage(format!("{file}: {error}")))
}

/// Reads a mesh for a study. `strict` refuses degenerate faces. `triangulate` cuts polygons.
pub(crate) fn for_study(
    path: &Path,
    files: ReadFiles,
    strict: bool,
    triangulate: bool,
) -> Result<StudyMesh, Failure> {
    sixfold_measure::command::load::for_study(path, files.into(), strict, triangulate)
}

/// Reads a mesh for a study as [`for_study`] does. Without a path, returns the built-in mesh.
pub(crate) fn mesh_or_built_in(
    path: Option<&Path>,
    files: ReadFiles,
    strict: bool,
    triangulate: bool,
) -> Result<StudyMesh, Failure> {
    sixfold_measure::command::load::mesh_or_built_in(path, files.into(), strict, triangulate)
}
