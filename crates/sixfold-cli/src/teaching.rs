//! The commands that show how structures work.

pub(crate) mod explore;
pub(crate) mod lessons;
pub(crate) mod tables;
pub(crate) mod trace;

use std::path::Path;

use sixfold::{PolygonMesh, shapes};
use sixfold_explain::{ExplainError, Refused, Structure};
use sixfold_study::StudyMesh;

use crate::arguments::Explained;
use crate::failure::Failure;
use crate::load;
use crate::text::{TextOutput, hanging_indent, width};
use crate::triangulate::triangulated;

/// Returns the name of the mesh, and the mesh: a cube if no mesh is named.
fn mesh(path: Option<&Path>, explained: &Explained) -> Result<(String, PolygonMesh), Failure> {
    let Some(path) = path else {
        let cube = StudyMesh::new("cube", shapes::cube());
        let cube = match explained.triangulate {
            true => triangulated(cube, None)?,
            false => cube,
        };
        return Ok((cube.name, cube.polygons));
    };
    let study_mesh = load::for_study(path, explained.read, false, explained.triangulate)?;
    Ok((study_mesh.name, study_mesh.polygons))
}

/// Explains each of the selected structures. Returns the explanations, and the structures that have
/// none; an error if no structure has one.
fn explain<T>(
    explained: &Explained,
    explanation: impl Fn(&Structure) -> Result<T, ExplainError>,
) -> Result<(Vec<T>, Vec<Refused>), Failure> {
    let is_selected =
        |one: &Structure| explained.all || explained.backend.iter().any(|name| name == one.name());
    let (mut shown, mut refused) = (Vec::new(), Vec::new());
    for structure in Structure::all().into_iter().filter(is_selected) {
        match explanation(&structure) {
            Ok(one) => shown.push(one),
            Err(
                error @ (ExplainError::Refused { .. }
                | ExplainError::RefusedEdit { .. }
                | ExplainError::NoSuchElement { .. }),
            ) => refused.push((structure.name(), error)),
            Err(error) => return Err(Failure::usage(error)),
        }
    }
    if shown.is_empty() {
        let mut errors = refused.iter().map(|(_, error)| error);
        let missing = errors.find(|error| matches!(error, ExplainError::NoSuchElement { .. }));
        if let Some(error) = missing {
            return Err(Failure::usage(error));
        }
        let reasons: Vec<String> = refused.iter().map(|(_, error)| error.to_string()).collect();
        return Err(Failure::unsupported(reasons.join("; ")));
    }
    let refused = refused.into_iter().map(|(structure, error)| Refused {
        structure,
        reason: error.to_string(),
    });
    Ok((shown, refused.collect()))
}

fn print_refused(refused: &[Refused], text: &mut TextOutput) {
    for one in refused {
        text.print_line("");
        text.print_line(&hanging_indent("! ", &one.reason));
    }
}

/// Puts blocks of lines beside one another while they fit, and the rest below.
fn side_by_side(blocks: &[String]) -> String {
    const GAP: usize = 4;
    let widest = |block: &str| {
        block
            .lines()
            .map(|line| line.chars().count())
            .max()
            .unwrap_or(0)
    };
    let mut bands: Vec<Vec<&str>> = Vec::new();
    let mut used = 0;
    for block in blocks {
        let needed = widest(block) + GAP;
        match bands.last_mut() {
            Some(band) if used + needed <= width() + GAP => {
                band.push(block);
                used += needed;
            }
            _ => {
                bands.push(vec![block]);
                used = needed;
            }
        }
    }
    let band = |band: &Vec<&str>| {
        let height = band.iter().map(|block| block.lines().count()).max();
        let line = |i: usize| {
            let cells = band.iter().map(|block| {
                let width = widest(block) + GAP;
                format!("{:<width$}", block.lines().nth(i).unwrap_or_default())
            });
            cells.collect::<String>().trim_end().to_owned()
        };
        (0..height.unwrap_or(0))
            .map(line)
            .collect::<Vec<_>>()
            .join("\n")
    };
    bands.iter().map(band).collect::<Vec<_>>().join("\n\n\n")
}
