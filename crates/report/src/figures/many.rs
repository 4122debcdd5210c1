//! The page of several meshes: the answer over all of them, how it spreads, and a section for each mesh.

mod distribution;
mod groups;
mod outliers;

use sixfold_results::numbers::{counted, grouped, list};
use sixfold_results::{Overall, Pool, Purpose, Report, Results, leaders, next_row};

use super::{facts, file_name, heat_map, labs, memory, ranking, recorded_command, slug};
use crate::data::rows;
use crate::figure::{Table, TitledTable};
use crate::matrix::Matrix;
use crate::summary::{self, Summary};
use crate::{Figure, ReportPage, Section};

/// The largest number of meshes with figures of their own. The sections of more meshes have tables only, so
/// that the page stays small.
const MAX_WITH_FIGURES: usize = 8;
/// The largest number of refused meshes that a cell names.
const NAMED: usize = 4;

/// One of the meshes, with the mean times on it.
struct Mesh<'r> {
    study: &'r Report,
    /// The shortest name that no other mesh has.
    name: String,
    /// The part of the page about the mesh.
    id: String,
    /// The mean times of the compared backends that hold the mesh, relative to the fastest of them.
    overall: Vec<Overall>,
    /// Whether all compared backends hold the mesh, so that it is part of the means.
    pooled: bool,
}

/// The mean time of one backend on a mesh, divided by that of another.
#[derive(Clone, Copy)]
struct Relative<'m> {
    backend: &'m str,
    ratio: f64,
    bound: bool,
}

/// Returns the backend that is the fastest over all pooled meshes in each kind of work.
fn leaders_of(pool: &Pool) -> Vec<(Purpose, &str)> {
    let rows = pool.groups.first().map_or(&[][..], |all| &all.overall);
    let leaders = rows
        .chunk_by(|a, b| a.purpose == b.purpose)
        .filter_map(|rows| {
            let first = rows.first().filter(|row| !row.bound)?;
            Some((first.purpose, first.backend.as_str()))
        });
    leaders.collect()
}

impl Mesh<'_> {
    /// Returns the mean times of the mesh for one kind of work, divided by the mean time of `leader`. Empty if
    /// `leader` has no measured time.
    fn relative_to(&self, leader: &str, purpose: Purpose) -> Vec<Relative<'_>> {
        let rows = purpose.rows(&self.overall);
        let is_base = |row: &&Overall| row.backend == leader && !row.bound;
        let Some(base) = rows.iter().find(is_base) else {
            return Vec::new();
        };
        let relative = rows.iter().map(|row| Relative {
            backend: &row.backend,
            ratio: row.ratio_to_best / base.ratio_to_best,
            bound: row.bound,
        });
        relative.collect()
    }
}

/// Returns the page of several meshes.
pub(super) fn page(studies: &[&Report], results: &Results, command: &str) -> ReportPage {
    let pool = results.pool();
    let meshes = meshes(studies, &pool);
    let matrix = Matrix::of_pool(&pool, studies);
    let all = pool.groups.first();
    let groups = groups::all(&pool, &meshes);
    let fastest = all.map(|all| summary::fastest_of_many(&all.overall));
    let meshes_of_means = all.map(|all| which_meshes(all.meshes.len(), studies.len()));
    let conditions = groups::differences(&pool, &groups);
    let tables = [
        groups::winners(&groups),
        holding(&pool, &meshes),
        outliers::table(&pool, &meshes),
    ];
    ReportPage {
        title: format!(
            "Mesh data structures on {}",
            counted(studies.len(), "mesh", "meshes")
        ),
        answer: fastest
            .into_iter()
            .flatten()
            .chain(meshes_of_means)
            .collect(),
        conditions: conditions.into_iter().collect(),
        summary: Summary::of_pool(&pool, studies),
        figures: figures(&pool, &meshes, &matrix, command),
        folded: rankings(&pool, &matrix, command).into_iter().collect(),
        tables: tables.into_iter().flatten().collect(),
        appendix: groups::means(&pool, &groups).into_iter().collect(),
        operations: matrix,
        overview: overview(&meshes),
        meshes: meshes
            .iter()
            .map(|mesh| section(mesh, results, meshes.len(), command))
            .collect(),
        labs: labs(results, command),
        warnings: pool.warnings,
        ..ReportPage::default()
    }
}

/// Says over which meshes the means are.
fn which_meshes(pooled: usize, studied: usize) -> String {
    match pooled == studied {
        true => format!(
            "Which meshes: the means are over all {studied}, which all compared structures can hold."
        ),
        false => format!(
            "Which meshes: the means are over the {} of {} that all compared structures can hold; the others have rows of their own \
             in the table “Fastest by size and kind of mesh”.",
            grouped(pooled),
            grouped(studied)
        ),
    }
}

fn meshes<'r>(studies: &[&'r Report], pool: &Pool) -> Vec<Mesh<'r>> {
    let compared: Vec<&str> = pool.compared.iter().map(String::as_str).collect();
    let all = pool.groups.first();
    let names: Vec<&str> = studies
        .iter()
        .map(|study| file_name(&study.mesh.name))
        .collect();
    let mesh = |(place, study): (usize, &&'r Report)| {
        let name = &study.mesh.name;
        let short = names[place];
        let unique = names.iter().filter(|other| **other == short).count() == 1;
        Mesh {
            study,
            name: if unique {
                short.to_owned()
            } else {
                name.clone()
            },
            id: format!("mesh-{}", place + 1),
            overall: study.overall_of(&compared),
            pooled: all.is_some_and(|all| all.meshes.contains(name)),
        }
    };
    studies.iter().enumerate().map(mesh).collect()
}

fn figures(pool: &Pool, meshes: &[Mesh<'_>], matrix: &Matrix, command: &str) -> Vec<Figure> {
    let count = pool.groups.first().map_or(0, |all| all.meshes.len());
    let title = format!(
        "Every operation on every structure: geometric mean over {}",
        counted(count, "mesh", "meshes")
    );
    let map = heat_map::figure(title, matrix, "", command);
    let map = map.map(|figure| figure.with_csv(rows::pooled(pool)));
    let spread = distribution::figure(pool, meshes, command);
    spread.into_iter().chain(map).collect()
}

/// Returns the rankings of all operations.
fn rankings(pool: &Pool, matrix: &Matrix, command: &str) -> Option<Figure> {
    let note = "A ratio is the quotient of two means: geometric means of the times on the meshes.";
    let figure = ranking::from_matrix(matrix, note, command)?;
    Some(figure.with_csv(rows::pooled(pool)))
}

/// Returns a table of the number of meshes that each backend can hold, with the others by name. `None` if
/// all can hold all meshes.
fn holding(pool: &Pool, meshes: &[Mesh<'_>]) -> Option<TitledTable> {
    if pool.holding.iter().all(|row| row.meshes == meshes.len()) {
        return None;
    }
    let mut table = Table::new(["structure", "can hold", "cannot hold"]);
    for row in &pool.holding {
        let refused = meshes.iter().filter(|mesh| {
            let mut backends = mesh.study.backends.iter();
            !backends.any(|backend| backend.name == row.backend && backend.holds)
        });
        let mut names: Vec<&str> = refused.map(|mesh| mesh.name.as_str()).collect();
        let more = names.split_off(names.len().min(NAMED)).len();
        let more = (more > 0).then(|| format!("{} more", grouped(more)));
        let names = names.into_iter().map(str::to_owned).chain(more);
        table.row(vec![
            row.backend.clone(),
            format!("{} of {}", grouped(row.meshes), grouped(meshes.len())),
            list(names),
        ]);
    }
    Some(TitledTable {
        title: "Who can hold the meshes".into(),
        caption: "The means are over the meshes that all compared structures can hold. The section of a mesh says why a \
                  structure cannot hold it, and `sixfold repair --for NAME` makes a mesh that the structure NAME can hold."
            .into(),
        table,
    })
}

/// Returns the table of the meshes: their size, and the fastest structures.
fn overview(meshes: &[Mesh<'_>]) -> Table {
    let purposes = Purpose::ALL.into_iter().filter(|&purpose| {
        let mut rows = meshes.iter().flat_map(|mesh| &mesh.overall);
        rows.any(|row| row.purpose == purpose)
    });
    let purposes: Vec<Purpose> = purposes.collect();
    let columns = purposes
        .iter()
        .map(|purpose| format!("fastest {}", purpose.of_choice()));
    let header = ["mesh", "faces", "kind"].map(str::to_owned);
    let mut table = Table::new(header.into_iter().chain(columns));
    for mesh in meshes {
        let facts = &mesh.study.mesh.facts;
        let mut cells = vec![mesh.name.clone(), grouped(facts.faces), kind(mesh.study)];
        for purpose in &purposes {
            let rows = purpose.rows(&mesh.overall);
            let best = leaders(rows);
            if !rows.is_empty() && !mesh.study.is_decided(*purpose) {
                cells.push("too few samples".into());
                continue;
            }
            let next = next_row(rows).map(|next| next.times(&rows[0]));
            cells.push(match (best.len(), next) {
                (0, _) => "–".into(),
                (_, None) => names(&best),
                (_, Some(next)) => format!("{} (next {next})", names(&best)),
            });
        }
        table.linked_row(cells, mesh.id.clone());
    }
    table
}

/// Returns the kind of a mesh, such as `triangles, closed`.
fn kind(study: &Report) -> String {
    let facts = &study.mesh.facts;
    let most = facts.face_degree.as_ref().map_or(0, |degree| degree.max);
    let faces = if most <= 3 { "triangles" } else { "polygons" };
    let ends = if facts.closed { "closed" } else { "boundary" };
    match facts.non_manifold_edges + facts.non_manifold_vertices {
        0 => format!("{faces}, {ends}"),
        _ => format!("{faces}, {ends}, not manifold"),
    }
}

fn names(rows: &[&Overall]) -> String {
    let names: Vec<&str> = rows.iter().map(|row| row.backend.as_str()).collect();
    names.join(" or ")
}

fn section(mesh: &Mesh<'_>, results: &Results, count: usize, command: &str) -> Section {
    let study = mesh.study;
    let matrix = Matrix::of_study(study);
    let command = recorded_command(&study.run, command);
    let prefix = format!("{}-{}-", mesh.id, slug(&study.mesh.name));
    let figures = match count <= MAX_WITH_FIGURES {
        true => vec![
            super::heat_map_of(study, &matrix, &prefix, command),
            memory::from_study(study, &prefix, command),
        ],
        false => Vec::new(),
    };
    let tables = match count <= MAX_WITH_FIGURES || matrix.lines.is_empty() {
        true => Vec::new(),
        false => vec![TitledTable {
            title: "All operations".into(),
            caption: "Time divided by that of the fastest structure of the row. ≥: lower bound."
                .into(),
            table: matrix.ratios(),
        }],
    };
    let mut sentences = summary::fastest_of_study(study);
    sentences.extend(summary::how_sure(study));
    sentences.extend(summary::turning_points(study, results));
    Section {
        id: mesh.id.clone(),
        title: mesh.name.clone(),
        facts: facts(&study.mesh),
        summary: Some(Summary::of_study(study, results)),
        code: Vec::new(),
        sentences,
        figures: figures.into_iter().flatten().collect(),
        tables,
    }
}
